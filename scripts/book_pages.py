"""mdBook's preprocessor for this book: formulas as MathML, which browsers draw by themselves, and links that hold.

Pages include files of the repository, whose links are relative to where they stand there: those to files that are pages
of the book lead to the page, pictures to the book's copy.
"""

import json
import re
import sys

import latex2mathml.converter

#: Files of the repository that are pages of the book.
PAGES = {
    "CONVENTIONS.md": "conventions.md",
    "VALIDATION.md": "validation.md",
    "docs/verification.md": "verification.md",
    "BENCHMARKS.md": "benchmarks.md",
    "ARCHITECTURE.md": "developers.md",
    "docs/design.md": "developers.md",
    "docs/pictures.md": "pictures.md",
    "docs/python/collapse.md": "collapse.md",
    "crates/python/README.md": "python.md",
}
#: Code, in which a dollar is a dollar and a bracket is a bracket; formulas; links.
CODE = re.compile(r"(^```.*?^```$|`[^`\n]+`)", re.MULTILINE | re.DOTALL)
FORMULA = re.compile(r"\$\$(.+?)\$\$|\$([^$\n]+?)\$", re.DOTALL)
LINK = re.compile(r"(?<=\]\()(?!https?:|#)(?:\.\./|\./)*([^)\s#]+)(#[^)\s]*)?(?=\))")


def formula(match: re.Match[str]) -> str:
    block, inline = match.groups()
    mathml = latex2mathml.converter.convert(block or inline, display="block" if block else "inline")
    # Browsers know bold letters by themselves only.
    mathml = re.sub(r'<mi mathvariant="bold">([a-z])</mi>', lambda letter: f"<mi>{chr(ord(letter[1]) + 0x1D3B9)}</mi>", mathml)
    # A line break would end the formula as a piece of HTML, and signs of Markdown stand for themselves.
    text = " ".join(mathml.split())
    return re.sub(r"(?<=>)([*_\\`\[\]])(?=<)", lambda sign: f"&#{ord(sign[1])};", text)


def link(match: re.Match[str], pages: set[str]) -> str:
    target, anchor = match[1], match[2] or ""
    if target in pages:
        return match[0]
    if target in PAGES:
        return PAGES[target] + anchor
    if "images/" in target:
        return "images/" + target.partition("images/")[2]
    sys.exit(f"a link leads to {target}, which is no page of the book")


def prepared(text: str, pages: set[str]) -> str:
    pieces = CODE.split(text)
    for number in range(0, len(pieces), 2):
        # A mean, no element of HTML.
        piece = re.sub(r"<([a-z])>(?!.*</\1>)", r"&lt;\1&gt;", pieces[number])
        piece = FORMULA.sub(formula, piece)
        pieces[number] = LINK.sub(lambda match: link(match, pages), piece)
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
        chapter["content"] = prepared(chapter["content"], pages)
    json.dump(book, sys.stdout)


if __name__ == "__main__":
    main()
