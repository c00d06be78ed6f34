"""Keywords for the dotted keys of a configuration: ``width`` for ``drive.width``, ``initial_state`` for ``initial.state``."""

from __future__ import annotations

import json
import operator
from collections.abc import Iterable, Iterator, Mapping
from difflib import get_close_matches
from types import NoneType
from typing import Any

import numpy as np

from . import _core
from ._core import ConfigurationError

#: Largest whole number in a configuration.
_MOST = 2**63 - 1


#: What `keywords` answers, once it has been asked.
_KEYWORDS: dict[str, tuple[str, ...]] = {}


def _leaves(schema: Mapping[str, Any], root: Mapping[str, Any], path: str = "") -> Iterator[str]:
    """Full names of the keys below a part of the schema."""
    forms = [schema, *schema.get("anyOf", []), *schema.get("oneOf", []), *schema.get("allOf", [])]
    for form in forms:
        name = form.get("$ref", "").rpartition("/")[2]
        definition = root.get("$defs", {}).get(name, {}) if name else form
        properties = definition.get("properties", {})
        if path == "drive.schedule":
            continue
        for key, below in properties.items():
            full = f"{path}.{key}" if path else key
            yield full
            yield from _leaves(below, root, full)


def keywords() -> dict[str, tuple[str, ...]]:
    """The keys that each keyword may mean: the last word of a key, or the whole of it with ``_`` for its dots."""
    if not _KEYWORDS:
        _KEYWORDS.update(_read())
    return _KEYWORDS


def _read() -> dict[str, tuple[str, ...]]:
    root = json.loads(_core.schema())
    found: dict[str, set[str]] = {}
    every = set(_leaves(root, root)) - {"preset", "resolved"}
    for key in every:
        if any(other.startswith(key + ".") for other in every):
            continue
        for keyword in {key.rpartition(".")[2], key.replace(".", "_")}:
            found.setdefault(keyword, set()).add(key)
    return {keyword: tuple(sorted(keys)) for keyword, keys in found.items()}


def overrides(settings: Mapping[str, Any] | None, given: Mapping[str, Any]) -> dict[str, Any]:
    """One dictionary of dotted keys: those of `settings`, tables in it flattened, and the keywords given.

    Raises
    ------
    ConfigurationError
        For a keyword that there is not, or that could mean several keys; for a key that is given twice.
    """
    if not isinstance(settings, (Mapping, NoneType)):
        raise TypeError(f"overrides is a mapping of dotted keys, not {settings!r}")
    joined: dict[str, Any] = {}
    names: dict[str, str] = {}

    def give(key: str, name: str, value: Any) -> None:
        if key == "preset":
            raise ConfigurationError("a preset is not among the overrides\n  help: Configuration and Simulation.preset name it first")
        if key in joined:
            raise ConfigurationError(f"{names[key]} and {name} both are {key}\n  help: give one of them")
        joined[key], names[key] = value, name

    for key, name, value in flat(settings or {}):
        give(key, name, value)
    for keyword, value in given.items():
        keys = keywords().get(keyword)
        if keys is None:
            raise ConfigurationError(f"there is no keyword {keyword}{_meant(keyword, keywords())}")
        if len(keys) > 1:
            raise ConfigurationError(
                f"{keyword} could mean {' or '.join(keys)}\n"
                f"  help: write {' or '.join(key.replace('.', '_') for key in keys)}"
            )
        give(keys[0], keyword, value)
    return {key: _plain(key, value) for key, value in joined.items()}


def _plain(key: str, value: Any) -> Any:
    """A value that TOML can hold: of NumPy's random numbers a seed that is drawn, so that the configuration has it."""
    if key == "run.seed":
        if isinstance(value, np.random.Generator):
            return int(value.integers(_MOST, endpoint=True))
        if isinstance(value, bool) or not hasattr(value, "__index__") or not 0 <= operator.index(value) <= _MOST:
            raise ConfigurationError(
                f"run.seed = {value!r} is no seed\n"
                "  help: a whole number from 0 to 2**63 - 1, or a numpy.random.Generator, of which one is drawn"
            )
    if isinstance(value, (int, np.integer)) and not isinstance(value, bool) and not -_MOST <= value <= _MOST:
        raise ConfigurationError(f"{key} = {value} is beyond reach\n  help: whole numbers go up to 2**63 - 1 = {_MOST}")
    return value


def missing(key: object, keys: Iterable[str]) -> str:
    """What to say of a dotted key that a configuration does not have."""
    last = {other.rpartition(".")[2]: other for other in keys}
    near = get_close_matches(str(key).rpartition(".")[2], last, 1)
    meant = f"; did you mean {last[near[0]]!r}?" if near else ""
    return f"there is no key {key!r} in this configuration{meant}"


def _meant(word: str, known: Iterable[str]) -> str:
    # A word within others is no misspelling of another one.
    within = [other for other in known if word in other.split("_")]
    within = [one for one in within if not any(one.endswith(f"_{other}") for other in within)]
    near = within if 0 < len(within) < 4 else get_close_matches(word, known, 1, 0.75)
    return f"; did you mean {' or '.join(map(repr, near))}?" if near else ""


def flat(settings: Mapping[str, Any], path: str = "", name: str = "") -> Iterator[tuple[str, str, Any]]:
    """Dotted keys, how they were given, and their values."""
    for key, value in settings.items():
        if not isinstance(key, str):
            raise TypeError(f"a key is text, not {key!r}")
        full, given = (f"{path}.{key}", f"{name}[{key!r}]") if path else (key, key)
        if isinstance(value, Mapping) and full != "drive.schedule":
            yield from flat(value, full, given)
        else:
            yield full, given, value
