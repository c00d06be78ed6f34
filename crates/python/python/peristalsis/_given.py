"""What a caller gives: numbers and objects of a kind, or an error that says what they should be."""

from __future__ import annotations

import math
import operator
import os
from pathlib import Path
from typing import Any

import numpy as np

from ._arrays import Array
from ._core import ConfigurationError


def whole(name: str, value: Any, least: int, most: int | None = None) -> int:
    """A whole number from `least` on, to `most` if there is one."""
    try:
        number = operator.index(value)
    except TypeError:
        raise TypeError(f"{name} is a whole number, not {value!r}") from None
    if number < least:
        raise ValueError(f"{name} is {least} or more, not {number}")
    if most is not None and number > most:
        raise ValueError(f"{name} is {most} or less, not {number}")
    return number


def number(name: str, value: Any) -> float:
    """A finite number."""
    try:
        if isinstance(value, (str, bytes, bool, np.bool_)) or np.iscomplexobj(value):
            raise TypeError
        found = float(value)
    except (TypeError, ValueError):
        raise TypeError(f"{name} is a number, not {value!r}") from None
    if not math.isfinite(found):
        raise ValueError(f"{name} is a finite number, not {found}")
    return found


def positive(name: str, value: Any) -> float:
    """A number above 0."""
    found = number(name, value)
    if found <= 0:
        raise ValueError(f"{name} is a number above 0, not {found:g}")
    return found


def numeric(name: str, value: Any, error: type[ValueError] = ValueError) -> None:
    """Refuses what NumPy makes numbers of that are not those meant: texts, times, complex numbers, which lose a part, and
    masked entries, which become what stands below the mask."""
    if (kind := np.asarray(value).dtype).kind in "cmMSTU":
        raise TypeError(f"{name}: an array of numbers is wanted, not one of {kind}")
    unmasked(name, value, error)


def unmasked(name: str, value: Any, error: type[ValueError] = ValueError) -> None:
    """Refuses masked entries."""
    if isinstance(value, np.ma.MaskedArray) and (places := np.flatnonzero(np.ma.getmaskarray(value))).size:
        raise error(f"{name}: value {places[0]} is masked: leave it out, as with .compressed()")


def numbers(name: str, value: Any) -> Array:
    """A new array of numbers."""
    unmasked(name, value)
    try:
        numeric(name, value)
        return np.array(value, dtype=float)
    except (TypeError, ValueError):
        raise TypeError(f"{name} is an array of numbers, not {value!r}") from None


def of_kind(name: str, value: Any, kind: type | tuple[type, ...], origin: str) -> None:
    """Refuses what is no object of a kind; `origin` says what makes one."""
    if not isinstance(value, kind):
        raise TypeError(f"{name} is {origin}, not {value!r}")


def text_of(path: str | os.PathLike[str]) -> str:
    """The text of a file."""
    try:
        return Path(path).read_text(encoding="utf-8")
    except UnicodeDecodeError as error:
        line = error.object[: error.start].count(b"\n") + 1
        raise ConfigurationError(f"cannot read {os.fspath(path)}: line {line} is not text in UTF-8") from None


def alike(one: Any, other: Any) -> bool:
    """Whether two values are equal; of arrays all entries, NaN where the other has NaN."""
    if isinstance(one, np.ndarray) and isinstance(other, np.ndarray):
        return np.array_equal(one, other, equal_nan=True)
    return bool(one == other)
