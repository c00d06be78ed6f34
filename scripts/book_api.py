"""The reference of the Python package in Markdown, on standard output: every public name with its docstring, as written."""

import ast
import inspect
import sys
from pathlib import Path

PACKAGE = Path(__file__).resolve().parent.parent / "crates" / "python" / "python" / "peristalsis"
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
        if isinstance(part, ast.FunctionDef) and not part.name.startswith("_") and ast.get_docstring(part):
            found[part.name] = part
    for base in node.bases:
        above = known.get(ast.unparse(base))
        if isinstance(above, ast.ClassDef):
            found = members(above, known) | found
    return found


def entry(node: Named, known: dict[str, Named], prefix: str = "") -> str:
    words = inspect.cleandoc(ast.get_docstring(node) or "")
    text = f"```text\n{heading(node, prefix)}\n\n{words}\n```\n" if words else f"```text\n{heading(node, prefix)}\n```\n"
    if isinstance(node, ast.ClassDef):
        for part in members(node, known).values():
            text += "\n" + entry(part, known, f"{node.name}.")
    return text


def main() -> None:
    for module in MODULES:
        name = f"peristalsis.{module}".rstrip(".")
        file = PACKAGE / (f"{module}.py" if module else "__init__.py")
        file = file if file.exists() else PACKAGE / module / "__init__.py"
        around = [*sorted(PACKAGE.glob("*.py*")), *sorted((PACKAGE / "analysis").glob("*.py"))]
        known = definitions([file, *around])
        print(f"\n## {name}\n")
        print(inspect.cleandoc(ast.get_docstring(ast.parse(file.read_text(encoding="utf-8"))) or "").split("\n\n")[0] + "\n")
        for each in public(file):
            if each in known:
                print(f"### {each}\n\n{entry(known[each], known)}")


if __name__ == "__main__":
    sys.exit(main())
