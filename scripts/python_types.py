"""Writes the types of the Python package's keywords and summaries, crates/python/python/peristalsis/_types.py.

They are made of the schema of configurations and of the table of a run's quantities, as the installed package knows them:
`python scripts/python_types.py`. A test says whether the file is up to date.
"""

import json
import sys
import textwrap
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from peristalsis import _core, _keywords

OUT = Path(__file__).parent.parent / "crates/python/python/peristalsis/_types.py"

HEAD = '''"""Types of keywords and of summaries. Made by scripts/python_types.py from the schema and the table of quantities."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, Literal, TypedDict

'''

KINDS = {"real": "float", "integer": "int", "text": "str", "boolean": "bool"}

KEYWORDS_EXAMPLE = '''
    Examples
    --------
    >>> import peristalsis
    >>> keywords: peristalsis.Keywords = {"width": 2.6, "initial_state": "jammed"}
    >>> peristalsis.Configuration("frictionless", **keywords)["initial.state"]
    'jammed'
    """

'''

SUMMARY_EXAMPLE = '''
    Examples
    --------
    >>> import peristalsis
    >>> summary: peristalsis.Summary = peristalsis.Simulation.preset("frictionless", waves=2).summary()
    >>> summary["grains"], summary["packing"]["inserted"]
    (41, 25)
    """

'''

#: What a summary holds besides the quantities.
REST = '''
class ThresholdTime(TypedDict):
    """The transition as another threshold sees it."""

    threshold: float
    """J/Jmax whose crossing counts."""
    time: float | None
    """tau [t]; `None` where there was no transition."""


class Packing(TypedDict):
    """How the grains were placed."""

    inserted: int
    """Grains that random insertion placed without overlap; the others were grown into place."""
    iterations: int
    """Iterations of the relaxation; 0 where insertion placed all."""
    mean_overlap: float
    """Mean overlap of the contacts left [d]."""
    largest_overlap: float
    """Largest overlap [d]."""
    stored_energy: float
    """Elastic energy stored [m d^2/t^2]."""


class WarningEntry(TypedDict):
    """A doubt about the run."""

    key: str
    """The key to look at."""
    message: str
    """The consequence to expect."""
'''

END = '''    pumping: PumpingSummary | None
    """Pumping against a body force; `None` without one."""
    open: OpenSummary | None
    """What passes through an open tube; `None` of a periodic one."""
    throat: ThroatSummary
    """About a fifth of the wavelength, where the tube is narrowest."""
    belly: BellySummary
    """About a fifth of the wavelength, where it is widest."""
    si: SiSummary | None
    """Quantities in SI; `None` without the table ``units``."""
    transition_times: list[ThresholdTime]
    """The transition as other thresholds see it."""
    packing: Packing
    """How the grains were placed."""
    message: str | None
    """Why the run diverged, where it did."""
    wall_diagnosis: list[str]
    """Faults of an elastic wall: when, where, and the likely cause."""
    warnings: list[WarningEntry]
    """What looks doubtful."""


class RunSummary(Summary):
    """A summary with the configuration that was given to `peristalsis.run`.

    Examples
    --------
    >>> import peristalsis
    >>> summary: peristalsis.RunSummary = peristalsis.run({"preset": "frictionless", "waves": 2, "periods": 1})
    >>> summary["config"]["periods"]
    1
    """

    config: dict[str, Any]
    """The configuration as it was given."""
'''


def kind_of(schema: Mapping[str, Any]) -> str:
    """The type of a value that a schema allows."""
    forms = schema.get("anyOf") or schema.get("oneOf")
    if forms:
        names = [json.dumps(form["const"]) for form in forms if "const" in form]
        kinds = [f"Literal[{', '.join(names)}]"] if names else []
        return " | ".join(dict.fromkeys(kinds + [kind_of(form) for form in forms if "const" not in form]))
    match schema.get("type"):
        case "array":
            return f"Sequence[{kind_of(schema['items'])}]"
        case "object":
            return "Mapping[str, Any]"
        case name:
            return {"number": "float", "integer": "int", "boolean": "bool", "string": "str"}[str(name)]


def at(schema: Mapping[str, Any], key: str) -> Mapping[str, Any]:
    """The schema of a dotted key."""
    for word in key.split("."):
        schema = schema["properties"][word]
    return schema


def field(name: str, kind: str, meaning: str) -> str:
    """A field with its meaning."""
    if not meaning:
        return f"    {name}: {kind}\n"
    text = "\n    ".join(textwrap.wrap(f'"""{meaning.replace(chr(92), chr(92) * 2)}"""', 112))
    return f"    {name}: {kind}\n    {text}\n"


def keywords() -> Iterator[str]:
    """The lines of the keywords."""
    schema = json.loads(_core.schema())
    names = ", ".join(json.dumps(name) for name in _core.presets())
    yield f"if TYPE_CHECKING:\n    #: Names of the presets.\n    _Preset = Literal[{names}]\n"
    yield '\n\nclass Keywords(TypedDict, total=False):\n    """Keywords of a configuration: the last word of a key, or the whole of it with ``_`` for its dots.\n'
    yield KEYWORDS_EXAMPLE
    for keyword, keys in sorted(_keywords.keywords().items()):
        if len(keys) == 1:
            of_key = at(schema, keys[0])
            is_short = keyword == keys[0].rpartition(".")[2]
            has_short = len(_keywords.keywords()[keys[0].rpartition(".")[2]]) == 1
            meaning = f"{keys[0]}. {of_key['description']}" if is_short or not has_short else ""
            yield field(keyword, kind_of(of_key), meaning)


def summary() -> Iterator[str]:
    """The lines of a summary."""
    groups: dict[str, list[str]] = {}
    for key, unit, text, kind, is_optional in _core.summary_keys():
        group, _, name = key.rpartition(".")
        shown = f"{text} [{unit}]" if unit not in ("", "1") else text
        kind = 'Literal["complete", "settled", "running", "diverged"]' if key == "status" else KINDS[kind]
        line = field(name, f"{kind} | None" if is_optional else kind, shown)
        groups.setdefault(group, []).append(line)
    whole = groups.pop("")
    for group, lines in groups.items():
        yield f'\n\nclass {group.capitalize()}Summary(TypedDict):\n    """What a summary says under ``{group}``."""\n\n'
        yield from lines
    yield '\n\nclass Summary(TypedDict):\n    """The outcome of a run, as ``summary.json`` has it. Numbers that are not known are NaN.\n'
    yield SUMMARY_EXAMPLE
    yield from whole
    yield END


def text() -> str:
    """The whole file."""
    return HEAD + "".join([*keywords(), "\n", REST, *summary()])


if __name__ == "__main__":
    OUT.write_text(text(), encoding="utf-8")
    print(OUT, file=sys.stderr)
