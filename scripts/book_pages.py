"""mdBook's preprocessor for this book: formulas as MathML, which browsers draw by themselves, and links that hold.

Pages include files of the repository, whose links are relative to where they stand there. Links to files that are pages of
the book lead to the page, pictures to the book's copy.
"""

import json
import posixpath
import re
import sys

import latex2mathml.converter

#: Files of the repository that are pages of the book, beside those in its own folder.
PAGES = {
    "README.md": "introduction.md",
    "SUMMARY.md": "introduction.md",
    "VALIDATION.md": "results/claims.md",
    "docs/verification.md": "results/verification.md",
    "BENCHMARKS.md": "results/benchmarks.md",
    "benchmarks/HISTORY.md": "results/history.md",
    "ARCHITECTURE.md": "developers/architecture.md",
    "CHANGELOG.md": "developers/changelog.md",
    "CONTRIBUTING.md": "developers/contributing.md",
    "CODE_OF_CONDUCT.md": "developers/contributing.md",
    "SECURITY.md": "developers/contributing.md",
    "crates/python/README.md": "guides/python.md",
}
#: Code, in which a dollar is a dollar and a bracket is a bracket; formulas; links.
CODE = re.compile(r"(^```.*?^```$|`[^`\n]+`)", re.MULTILINE | re.DOTALL)
FORMULA = re.compile(r"\$\$(.+?)\$\$|\$([^$\n]+?)\$", re.DOTALL)
LINK = re.compile(r"(?<=\]\()(?!https?:|mailto:|#)([^)\s#]+)(#[^)\s]*)?(?=\))")


def formula(match: re.Match[str]) -> str:
    block, inline = match.groups()
    mathml = latex2mathml.converter.convert(block or inline, display="block" if block else "inline")
    # Browsers know bold letters by themselves only.
    mathml = re.sub(r'<mi mathvariant="bold">([a-z])</mi>', lambda letter: f"<mi>{chr(ord(letter[1]) + 0x1D3B9)}</mi>", mathml)
    # A line break would end the formula as a piece of HTML, and signs of Markdown stand for themselves.
    text = " ".join(mathml.split())
    return re.sub(r"(?<=>)([*_\\`\[\]])(?=<)", lambda sign: f"&#{ord(sign[1])};", text)


def link(match: re.Match[str], folder: str, pages: set[str]) -> str:
    """The link of a page in `folder`, itself or of a file that the page includes."""
    target, anchor = match[1], match[2] or ""
    if posixpath.normpath(posixpath.join(folder, target)) in pages:
        return match[0]
    bare = re.sub(r"^(\.\.?/)*((docs/)?book/src/)?", "", target)
    if "images/" in bare:
        found = "images/" + bare.partition("images/")[2]
    elif bare in pages:
        found = bare
    elif bare in PAGES and PAGES[bare] in pages:
        found = PAGES[bare]
    elif bare.startswith("rust/"):
        found = bare
    else:
        sys.exit(f"a link in {folder or 'the book'} leads to {target}, which is no page of the book")
    return posixpath.relpath(found, folder or ".") + anchor


def prepared(text: str, folder: str, pages: set[str]) -> str:
    pieces = CODE.split(text)
    for number in range(0, len(pieces), 2):
        # A mean, no element of HTML.
        piece = re.sub(r"<([a-z])>(?!.*</\1>)", r"&lt;\1&gt;", pieces[number])
        piece = FORMULA.sub(formula, piece)
        pieces[number] = LINK.sub(lambda match: link(match, folder, pages), piece)
    return "".join(pieces)


def chapters(items: list) -> list[dict]:
    found = [item["Chapter"] for item in items if isinstance(item, dict) and "Chapter" in item]
    return found + [chapter for one in found for chapter in chapters(one["sub_items"])]


def main() -> None:
    if sys.argv[1:2] == ["supports"]:
        return
    _, book = json.load(sys.stdin)
    all_chapters = chapters(book.get("items") or book["sections"])
    pages = {chapter["path"] for chapter in all_chapters if chapter["path"]}
    for chapter in all_chapters:
        chapter["content"] = prepared(chapter["content"], posixpath.dirname(chapter["path"] or ""), pages)
    json.dump(book, sys.stdout)


if __name__ == "__main__":
    main()
