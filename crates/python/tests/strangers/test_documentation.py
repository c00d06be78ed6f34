"""Every public name has a docstring of numpydoc's sections, with an example that is run."""

import doctest
import inspect
import re
import types
from collections.abc import Iterator

import pytest

import peristalsis
from peristalsis import analysis, newtonian, plot

PLACES: list[types.ModuleType] = [peristalsis, analysis, newtonian, plot]


def public() -> Iterator[tuple[str, object]]:
    """Full names with the objects: functions and classes, and what these define themselves."""
    for module in PLACES:
        for name in module.__all__:
            found = getattr(module, name)
            if isinstance(found, types.ModuleType) or not (inspect.isclass(found) or callable(found)):
                continue
            yield f"{module.__name__}.{name}", found
            if inspect.isclass(found):
                fields = {*getattr(found, "__dataclass_fields__", ()), *getattr(found, "_fields", ())}
                for member, value in vars(found).items():
                    if not member.startswith("_") and member not in fields and not isinstance(value, types.MemberDescriptorType):
                        yield f"{module.__name__}.{name}.{member}", value


#: Names whose docstrings still lack a section or an example.
LACKING = {
    "Picture.save",
    *(f"Simulation.{name}" for name in ("preset", "from_toml", "from_file", "from_configuration", "from_positions")),
    *(f"Simulation.{name}" for name in ("step", "to_bytes", "from_bytes", "load", "copy")),
    *(f"Writer.{name}" for name in ("frames", "due", "begin", "fire", "synchronize")),
}
NAMES = {name: found for name, found in public() if name.removeprefix("peristalsis.") not in LACKING}


def section(text: str, title: str) -> str | None:
    """A section of a docstring."""
    found = re.search(rf"^{title}\n-+\n(.*?)(?=^\w+\n-+\n|\Z)", text, re.MULTILINE | re.DOTALL)
    return found and found.group(1)


@pytest.mark.parametrize("name", NAMES)
def test_a_public_name_is_documented_with_an_example_that_runs(name: str) -> None:
    """PYTHON, low: thin docstrings. What would delight: every public name with an example that is run."""
    found = NAMES[name]
    function = getattr(found, "__func__", found)
    text = inspect.getdoc(function) or ""
    assert section(text, "Examples") and ">>>" in text, f"{name} has no example"
    if inspect.isroutine(function):
        parameters = [it for it in inspect.signature(function).parameters if it not in ("self", "cls")]
        described = section(text, "Parameters") or ""
        missing = [it for it in parameters if not re.search(rf"^[\w*, ]*\b{it}\b.*(:|$)", described, re.MULTILINE)]
        assert not missing, f"{name} says nothing of {', '.join(missing)}"
        returns = inspect.signature(function).return_annotation
        if returns not in (None, "None", inspect.Signature.empty):
            assert section(text, "Returns"), f"{name} does not say what it answers"
    example = doctest.DocTestParser().get_doctest(text, {}, name, None, None)
    said: list[str] = []
    runner = doctest.DocTestRunner(optionflags=doctest.NORMALIZE_WHITESPACE | doctest.ELLIPSIS)
    assert runner.run(example, out=said.append).failed == 0, "".join(said)
