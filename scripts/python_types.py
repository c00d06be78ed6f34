"""Writes the types of the Python package's keywords and summaries, crates/python/python/peristalsis/_types.py.

They are made of the schemas of configurations and of summaries and of the table of a run's quantities, as the installed
package knows them: `python scripts/python_types.py`. A test says whether the file is up to date.
"""

import json
import re
import sys
import textwrap
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from peristalsis import _core, _keywords

OUT = Path(__file__).parent.parent / "crates/python/python/peristalsis/_types.py"

HEAD = '''"""Types of keywords and of summaries. Made by scripts/python_types.py from schemas and the table of quantities."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, Literal, SupportsIndex, TypedDict

import numpy as np
import numpy.typing as npt

'''

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

END = '''

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


#: Types by their names in a schema, and in the table of quantities.
KINDS = {"number": "float", "integer": "int", "boolean": "bool", "string": "str", "null": "None"}
KINDS |= {"real": "float", "text": "str"}


def kind_of(schema: Mapping[str, Any], several: str = "Sequence[{}]", table: str = "Mapping[str, Any]") -> str:
    """The type of a value that a schema allows; that of an array as `several`, of an object without a name as `table`."""
    if "$ref" in schema:
        return str(schema["$ref"]).rpartition("/")[2]
    forms = schema.get("anyOf") or schema.get("oneOf")
    if forms:
        names = [json.dumps(form["const"]) for form in forms if "const" in form]
        kinds = [f"Literal[{', '.join(names)}]"] if names else []
        kinds += [kind_of(form, several, table) for form in forms if "const" not in form]
        return " | ".join(dict.fromkeys(kinds))
    match schema["type"]:
        case "array":
            return several.format(kind_of(schema["items"], several, table))
        case "object":
            return table
        case [*kinds]:
            return " | ".join(kind_of({**schema, "type": kind}, several, table) for kind in kinds)
        case kind:
            return KINDS[kind]


def parts(schema: Mapping[str, Any]) -> list[tuple[str, Mapping[str, Any], bool]]:
    """The properties of a schema in their order, those that may be absent last: (name, schema, whether it may)."""
    required = schema.get("required", [])
    names = [*required, *(name for name in schema["properties"] if name not in required)]
    return [(name, schema["properties"][name], name not in required) for name in names]


def plain(words: str) -> str:
    """The documentation of Rust without links and line breaks."""
    words = re.sub(r"\[(`[^`]+`)\](\([^)]*\))?", r"\1", words)
    return "\n\n".join(" ".join(part.split()) for part in re.sub(r"\\([\[\]])", r"\1", words).split("\n\n"))


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


def given(key: str, kind: str) -> str:
    """The type of what may be given for a key: whole numbers and lists of numbers also as numpy has them."""
    kind = re.sub(r"Sequence\[(?:int|float)\]", r"\g<0> | npt.NDArray[Any]", kind)
    kind = re.sub(r"\bint\b(?!\])", "SupportsIndex", kind)
    return f"{kind} | np.random.Generator" if key == "run.seed" else kind


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
            yield field(keyword, given(keys[0], kind_of(of_key)), meaning)


def dictionary(name: str, schema: Mapping[str, Any]) -> Iterator[str]:
    """The lines of a dictionary in a summary."""
    yield f'\n\nclass {name}(TypedDict):\n    """{plain(schema["description"])}"""\n\n'
    for key, of_key, _ in parts(schema):
        yield field(key, kind_of(of_key, "list[{}]"), plain(of_key["description"]))


def summary() -> Iterator[str]:
    """The lines of a summary."""
    schema = json.loads(_core.summary_schema())
    for name, of_name in schema["$defs"].items():
        yield from dictionary(name, of_name)
    groups: dict[str, list[str]] = {}
    for key, unit, meaning, kind, is_optional in _core.summary_keys():
        group, _, name = key.rpartition(".")
        shown = f"{meaning} [{unit}]" if unit not in ("", "1") else meaning
        # What a word may be is said by the schema.
        of_key = schema["properties"].pop(key, {"type": kind})
        groups.setdefault(group, []).append(field(name, kind_of(of_key) + (" | None" if is_optional else ""), shown))
    whole, rare = groups.pop(""), []
    for group, lines in groups.items():
        yield f'\n\nclass {group.capitalize()}Summary(TypedDict):\n    """What a summary says under ``{group}``."""\n\n'
        yield from lines
    for name, of_name, is_rare in parts(schema):
        kind = kind_of(of_name, "list[{}]", f"{name.capitalize()}Summary")
        (rare if is_rare else whole).append(field(name, kind, plain(of_name["description"])))
    yield '\n\nclass _Rare(TypedDict, total=False):\n    """What not every summary has."""\n\n'
    yield from rare
    yield '\n\nclass Summary(_Rare):\n    """The outcome of a run, as ``summary.json`` has it. Numbers that are not known are NaN.\n'
    yield SUMMARY_EXAMPLE
    yield from whole
    yield END


def text() -> str:
    """The whole file."""
    return HEAD + "".join([*keywords(), *summary()])


if __name__ == "__main__":
    OUT.write_text(text(), encoding="utf-8")
    print(OUT, file=sys.stderr)
