"""Columns of numbers as the estimators take them, and their answers as objects."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import fields
from typing import TYPE_CHECKING, Any, Literal, TypedDict, TypeVar, get_args, get_type_hints

import numpy as np
import numpy.typing as npt

from .._arrays import Array, Runs, RunTable
from .._core import AnalysisError
from .._given import numeric, unmasked, whole
from ._results import Uncertain

Numbers = npt.ArrayLike
Result = TypeVar("Result")


class BarrierPower(TypedDict):
    """Power p of the barrier."""

    power: float


class Barrier(TypedDict):
    """The law y = A exp(B/(w_c - w)^p)."""

    barrier: BarrierPower


if TYPE_CHECKING:
    #: ``"power"``, ``"exponential"``, or ``{"barrier": {"power": 2.0}}``.
    _Law = Literal["power", "exponential"] | Barrier
    #: A distribution of transition times.
    _Family = Literal["exponential", "gamma", "weibull"]


def reals(name: str, values: Numbers) -> Array:
    """A column of finite numbers, which what the caller does with theirs does not touch."""
    numeric(name, values, AnalysisError)
    array = np.array(values, dtype=np.float64, order="C")
    if array.ndim != 1:
        raise ValueError(f"{name}: a column has one dimension, not {array.ndim}")
    refuse(name, array, ~np.isfinite(array), "which is not a finite number")
    return array


def refuse(name: str, column: Array, is_wrong: npt.NDArray[np.bool_], reason: str) -> None:
    """Refuses a column in which a value is wrong."""
    if is_wrong.any():
        place = int(np.argmax(is_wrong))
        raise AnalysisError(f"{name}: value {place} is {column[place]:g}, {reason}")


def columns(positive: Iterable[str] = (), /, **given: Numbers) -> list[Array]:
    """Columns of equal length by the names of their arguments, some of which hold numbers above 0."""
    arrays = {name: reals(name, column) for name, column in given.items()}
    same_length(**arrays)
    for name in positive:
        refuse(name, arrays[name], arrays[name] <= 0.0, "but must be positive")
    return list(arrays.values())


def same_length(**arrays: npt.NDArray[Any]) -> None:
    """Refuses columns of unequal length."""
    if len({len(array) for array in arrays.values()}) > 1:
        raise ValueError(f"columns of unequal length: {', '.join(f'{name} {len(array)}' for name, array in arrays.items())}")


def _number(value: Any) -> float:
    """A value as a number, NaN where it is none."""
    try:
        return float(value)
    except (TypeError, ValueError):
        return np.nan


def truths(name: str, values: npt.ArrayLike) -> npt.NDArray[np.bool_]:
    """A column of truth values, none of them missing; a copy, as of `reals`."""
    unmasked(name, values, AnalysisError)
    array = np.asarray(values)
    if array.ndim != 1:
        raise ValueError(f"{name}: a column has one dimension, not {array.ndim}")
    if array.dtype != bool:
        for index, value in enumerate(array):
            if _number(value) not in (0.0, 1.0):
                reason = "true or false (1 or 0) is wanted, and none may be missing"
                raise AnalysisError(f"{name}: value {index} is {value}: {reason}")
        array = array.astype(np.float64) == 1.0
    return np.array(array, order="C")


def outcomes(name: str, values: Numbers, name_of_truths: str, has: npt.ArrayLike) -> Runs:
    """A number of each run, and whether it has what is asked of it."""
    numbers, truth = reals(name, values), truths(name_of_truths, has)
    same_length(**{name: numbers, name_of_truths: truth})
    return numbers, truth


def runs(time: Numbers, observed: npt.ArrayLike | None, *, at_once: bool = False) -> Runs:
    """Outcomes of runs: times, and whether there was a transition; whether there may be one at 0."""
    if observed is None:
        times = reals("time", time)
        seen = np.ones(len(times), dtype=bool)
    else:
        times, seen = outcomes("time", time, "observed", observed)
    refuse("time", times, times < 0.0, "but must not be negative")
    if not at_once:
        refuse("time", times, seen & (times == 0.0), "but a transition comes after 0")
    return times, seen


def run_table(width: Numbers, time: Numbers, observed: npt.ArrayLike | None) -> RunTable:
    """Widths with the outcomes of runs."""
    times, seen = runs(time, observed)
    widths, times = columns(width=width, time=times)
    return widths, (times, seen)


def resampling(resamples: int, seed: int) -> tuple[int, int]:
    """Number of resamples, and the seed of them."""
    return whole("resamples", resamples, 0), whole("seed", seed, 0, 2**64 - 1)


def pair(name: str, value: Uncertain | float | tuple[float, float]) -> tuple[float, float]:
    """A number and its standard error, 0 where it has none."""
    given = (value.value, value.error) if isinstance(value, Uncertain) else value
    parts = given if isinstance(given, tuple) else (given, 0.0)
    if len(parts) != 2 or not np.isfinite([_number(part) for part in parts]).all():
        raise AnalysisError(f"{name} is a finite number, or a pair of it and its error, not {value!r}")
    found, error = float(parts[0]), float(parts[1])
    if error < 0.0:
        raise AnalysisError(f"{name} has an error of {error:g}, which must not be negative")
    return found, error


def law_of(law: str | Mapping[str, Any]) -> str | dict[str, Any]:
    """A law as the core takes it."""
    if isinstance(law, str):
        return law
    if isinstance(law, Mapping):
        return dict(law)
    raise TypeError(f'law is "power", "exponential" or {{"barrier": {{"power": p}}}}, not {law!r}')


def result(kind: type[Result], answer: Any) -> Result:
    """A dictionary as the result class of the same fields."""
    hints = get_type_hints(kind)
    values = {field.name: _value(hints[field.name], answer[field.name]) for field in fields(kind)}  # type: ignore[arg-type]
    return kind(**values)


def _value(hint: Any, value: Any) -> Any:
    kinds = [kind for kind in get_args(hint) or (hint,) if hasattr(kind, "__dataclass_fields__")]
    if value is None or not kinds:
        return tuple(value) if isinstance(value, list) else value
    if isinstance(value, list):
        return tuple(result(kinds[0], item) for item in value)
    return result(kinds[0], value)
