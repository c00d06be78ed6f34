"""Every public name has a docstring of numpydoc's sections, with an example that is run."""

import doctest
import inspect
import re
import subprocess
import sys
import types
from collections.abc import Iterator
from pathlib import Path

import pytest

import peristalsis
from peristalsis import analysis, newtonian, plot

PLACES: list[types.ModuleType] = [peristalsis, analysis, newtonian, plot]


def fields(found: type) -> set[str]:
    """Those of a data class, a named tuple or slots: the class itself documents them."""
    slots = {name for name, value in vars(found).items() if isinstance(value, types.MemberDescriptorType)}
    return {*getattr(found, "__dataclass_fields__", ()), *getattr(found, "_fields", ()), *slots}


def public() -> Iterator[tuple[str, object]]:
    """Full names with the objects: functions and classes, and what these define or inherit from classes of the package."""
    for module in PLACES:
        for name in module.__all__:
            found = getattr(module, name)
            if isinstance(found, types.ModuleType) or not callable(found):
                continue
            yield f"{module.__name__}.{name}", found
            if not inspect.isclass(found):
                continue
            for base in found.__mro__:
                if base.__module__.startswith("peristalsis"):
                    for member, value in vars(base).items():
                        if not member.startswith("_") and member not in fields(found):
                            yield f"{module.__name__}.{name}.{member}", value


NAMES = dict(public())


def test_the_book_has_every_name_with_its_words() -> None:
    program = Path(__file__).parents[4] / "scripts" / "book_api.py"
    reference = subprocess.check_output([sys.executable, program], text=True)
    said = {
        f"{module}.{name}": words
        for module, part in re.findall(r"^## (peristalsis[.\w]*)\n(.*?)(?=^## |\Z)", reference, re.MULTILINE | re.DOTALL)
        for name, words in re.findall(r"^```text\n([\w.]+).*\n\n(.*)\n", part, re.MULTILINE)
    }
    first = {name: (inspect.getdoc(getattr(found, "__func__", found)) or "").splitlines()[0].replace("``", "`") for name, found in NAMES.items()}
    assert {name: said.get(name) for name in NAMES} == first


def section(text: str, title: str) -> str | None:
    """A section of a docstring."""
    found = re.search(rf"^{title}\n-+\n(.*?)(?=^\w+\n-+\n|\Z)", text, re.MULTILINE | re.DOTALL)
    return found and found.group(1)


def unsaid(names: list[str], described: str | None) -> list[str]:
    """Those of which a section says nothing."""
    return [it for it in names if not re.search(rf"^[\w*, ]*\b{it}\b.*(:|$)", described or "", re.MULTILINE)]


def test_inherited_names_are_among_them() -> None:
    for name in ("positions", "contacts", "width", "add_writer", "save", "load", "preset", "run", "warnings"):
        assert f"peristalsis.Simulation.{name}" in NAMES
    assert {"peristalsis.Configuration.check", "peristalsis.Table.to_pandas", "peristalsis.plot.flow"} <= set(NAMES)


@pytest.mark.parametrize("name", NAMES)
def test_a_public_name_is_documented_with_an_example_that_runs(name: str) -> None:
    found = NAMES[name]
    function = getattr(found, "__func__", found)
    text = inspect.getdoc(function) or ""
    assert section(text, "Examples") and ">>>" in text, f"{name} has no example"
    if inspect.isroutine(function):
        parameters = [it for it in inspect.signature(function).parameters if it not in ("self", "cls")]
        assert not unsaid(parameters, section(text, "Parameters")), f"{name} does not say what it takes"
        returns = inspect.signature(function).return_annotation
        if returns not in (None, "None", inspect.Signature.empty):
            assert section(text, "Returns"), f"{name} does not say what it answers"
    if inspect.isclass(found):
        said = f"{section(text, 'Parameters') or ''}\n{section(text, 'Attributes') or ''}"
        own = [it for it in sorted(fields(found)) if not it.startswith("_")]
        assert not unsaid(own, said), f"{name} does not say what it has"
    example = doctest.DocTestParser().get_doctest(text, {}, name, None, None)
    printed: list[str] = []
    runner = doctest.DocTestRunner(optionflags=doctest.NORMALIZE_WHITESPACE | doctest.ELLIPSIS)
    assert runner.run(example, out=printed.append).failed == 0, "".join(printed)
