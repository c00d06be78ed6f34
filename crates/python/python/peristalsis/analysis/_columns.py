"""Columns of numbers as the estimators take them, and their answers as objects."""

from __future__ import annotations

from collections.abc import Mapping
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


def reals(values: Numbers) -> Array:
    """A column of numbers, which what the caller does with theirs does not touch."""
    numeric(values, AnalysisError)
    array = np.array(values, dtype=np.float64, order="C")
    if array.ndim != 1:
        raise ValueError(f"a column has one dimension, not {array.ndim}")
    return array


def columns(*given: Numbers) -> list[Array]:
    """Columns of equal length."""
    arrays = [reals(column) for column in given]
    if len({len(array) for array in arrays}) > 1:
        raise ValueError(f"columns of unequal length: {', '.join(str(len(array)) for array in arrays)}")
    return arrays


def _number(value: Any) -> float:
    """A value as a number, NaN where it is none."""
    try:
        return float(value)
    except (TypeError, ValueError):
        return np.nan


def truths(values: npt.ArrayLike) -> npt.NDArray[np.bool_]:
    """A column of truth values, none of them missing; a copy, as of `reals`."""
    unmasked(values, AnalysisError)
    array = np.asarray(values)
    if array.dtype != bool:
        for index, value in enumerate(array.flat):
            if _number(value) not in (0.0, 1.0):
                reason = "true or false (1 or 0) is wanted, and none may be missing"
                raise AnalysisError(f"value {index} is {value!r}: {reason}")
        array = array.astype(np.float64) == 1.0
    return np.array(array, order="C")


def runs(time: Numbers, observed: npt.ArrayLike | None) -> Runs:
    """Outcomes of runs: times, and whether there was a transition."""
    times = reals(time)
    if observed is None:
        return times, np.ones(len(times), dtype=bool)
    outcomes = truths(observed)
    if outcomes.shape != times.shape:
        raise ValueError(f"{len(times)} times, but {outcomes.size} observed")
    return times, outcomes


def run_table(width: Numbers, time: Numbers, observed: npt.ArrayLike | None) -> RunTable:
    """Widths with the outcomes of runs."""
    times, outcomes = runs(time, observed)
    widths, times = columns(width, times)
    return widths, (times, outcomes)


def resampling(resamples: int, seed: int) -> tuple[int, int]:
    """Number of resamples, and the seed of them."""
    return whole("resamples", resamples, 0), whole("seed", seed, 0, 2**64 - 1)


def pair(value: Uncertain | float | tuple[float, float]) -> tuple[float, float]:
    """A number and its standard error, 0 where it has none."""
    if isinstance(value, Uncertain):
        return value.value, value.error
    if isinstance(value, tuple):
        return value
    return float(value), 0.0


def law_of(law: str | Mapping[str, Any]) -> str | dict[str, Any]:
    """A law as the core takes it."""
    return law if isinstance(law, str) else dict(law)


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
