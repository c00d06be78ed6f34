"""The reference of the Python package in Markdown, on standard output: every public name with its docstring, as written."""

import ast
import inspect
import re
import sys
from pathlib import Path

PACKAGE = Path(__file__).resolve().parent.parent / "crates" / "python" / "python" / "peristalsis"
RUST = PACKAGE.parent.parent / "src"
METHODS = re.compile(r"^#\[pymethods\]\nimpl (\w+) \{\n(.*?)^\}", re.MULTILINE | re.DOTALL)
#: Modules with public names, by the name under which they are imported.
MODULES = ("", "analysis", "newtonian", "plot")
Named = ast.FunctionDef | ast.ClassDef


def definitions(paths: list[Path]) -> dict[str, Named]:
    """Functions and classes of files, by name; where one is in several, the first that says what it is for."""
    found: dict[str, Named] = {}
    for path in paths:
        for node in ast.parse(path.read_text(encoding="utf-8")).body:
            if isinstance(node, Named) and (node.name not in found or not ast.get_docstring(found[node.name])):
                found[node.name] = node
    return found


def words_of_rust() -> dict[str, str]:
    """Docstrings of what is written in Rust, by dotted name; the stubs have names and types only."""
    found: dict[str, str] = {}
    for path in sorted(RUST.glob("*.rs")):
        text = path.read_text(encoding="utf-8")
        blocks = [("", "", text), *((f"{name}.", " {4}", body) for name, body in METHODS.findall(text))]
        for prefix, indent, body in blocks:
            pattern = rf"^((?:{indent}///.*\n)+)((?:{indent}[#) ].*\n)*){indent}(?:pub\(crate\) )?(?:fn|struct) (\w+)"
            for words, attributes, name in re.findall(pattern, body, re.MULTILINE):
                renamed = re.search(r'name = "(\w+)"', attributes)
                found[prefix + (renamed.group(1) if renamed else name)] = re.sub(r"^ */// ?", "", words, flags=re.MULTILINE)
    return found


WORDS_OF_RUST = words_of_rust()


def words(node: Named, prefix: str) -> str:
    """The docstring of a definition; of a stub, which has a line at most, that of Rust."""
    found = (ast.get_docstring(node) or "", WORDS_OF_RUST.get(f"{prefix}{node.name}", ""))
    return inspect.cleandoc(max(found, key=len)).replace("``", "`")


def public(module: Path) -> list[str]:
    """What `__all__` of a module says."""
    for node in ast.parse(module.read_text(encoding="utf-8")).body:
        if isinstance(node, ast.Assign) and any(isinstance(it, ast.Name) and it.id == "__all__" for it in node.targets):
            return sorted(ast.literal_eval(node.value))
    raise SystemExit(f"{module} has no __all__")


def heading(node: Named, prefix: str = "") -> str:
    if isinstance(node, ast.ClassDef):
        return f"{prefix}{node.name}"
    arguments = ast.unparse(node.args).replace("self, ", "").replace("cls, ", "")
    is_property = any(isinstance(it, ast.Name) and it.id == "property" for it in node.decorator_list)
    answer = f" -> {ast.unparse(node.returns)}" if node.returns else ""
    return f"{prefix}{node.name}" + ("" if is_property else f"({'' if arguments in ('self', 'cls') else arguments})") + answer


def members(node: ast.ClassDef, known: dict[str, Named]) -> dict[str, ast.FunctionDef]:
    """What a class defines, and what it inherits from classes of the package, by name."""
    found: dict[str, ast.FunctionDef] = {}
    for part in node.body:
        if isinstance(part, ast.FunctionDef) and not part.name.startswith("_") and words(part, f"{node.name}."):
            found[part.name] = part
    for base in node.bases:
        above = known.get(ast.unparse(base))
        if isinstance(above, ast.ClassDef):
            found = members(above, known) | found
    return found


def entry(node: Named, known: dict[str, Named], prefix: str = "") -> str:
    said = words(node, prefix)
    text = f"```text\n{heading(node, prefix)}\n\n{said}\n```\n" if said else f"```text\n{heading(node, prefix)}\n```\n"
    if isinstance(node, ast.ClassDef):
        for part in members(node, known).values():
            text += "\n" + entry(part, known, f"{node.name}.")
    return text


def main() -> None:
    for module in MODULES:
        name = f"peristalsis.{module}".rstrip(".")
        file = PACKAGE / (f"{module}.py" if module else "__init__.py")
        file = file if file.exists() else PACKAGE / module / "__init__.py"
        # What a module takes from elsewhere stands in its own folder, or at the top.
        known = definitions([file, *(sorted(PACKAGE.glob("*.py*")) if file.parent == PACKAGE else sorted(file.parent.glob("*.py")))])
        print(f"\n## {name}\n")
        print(inspect.cleandoc(ast.get_docstring(ast.parse(file.read_text(encoding="utf-8"))) or "").split("\n\n")[0] + "\n")
        for each in public(file):
            if each in known:
                print(f"### {each}\n\n{entry(known[each], known)}")


if __name__ == "__main__":
    sys.exit(main())
