"""A parameter of the drive changed there and back."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal, NamedTuple, TypeAlias

import numpy as np

from . import _core
from ._arrays import Array
from ._core import AnalysisError, Table
from ._drive import PARAMETERS
from ._given import alike
from ._progress import Progress, Shown
from ._warnings import Telling

if TYPE_CHECKING:
    from ._simulation import Simulation

    #: Parameters of the drive that a ramp can lead.
    _Parameter: TypeAlias = Literal["width", "force_amplitude", "strain_rate"]


class Threshold(NamedTuple):
    """Where J/Jmax crosses on a branch.

    Attributes
    ----------
    value : float
        Value of the parameter, interpolated between the two levels around it.
    lower, upper : float
        Those levels: what is certain of it.

    Examples
    --------
    >>> import peristalsis
    >>> peristalsis.Threshold(2.75, 2.7, 2.8).upper
    2.8
    """

    value: float
    lower: float
    upper: float


class Thresholds(NamedTuple):
    """The thresholds of both branches of a `Loop`; `None` where a branch crosses nowhere, or was not run.

    Attributes
    ----------
    there, back : Threshold or None
        The threshold on the way there, and on the way back.

    Examples
    --------
    >>> import peristalsis
    >>> peristalsis.Thresholds(None, None).back is None
    True
    """

    there: Threshold | None
    back: Threshold | None


@dataclass(frozen=True, eq=False)
class Loop:
    """J/Jmax while a parameter of the drive changes there and back; the result of `Simulation.ramp`.

    Attributes
    ----------
    parameter : str
        ``"width"``, ``"force_amplitude"`` or ``"strain_rate"``.
    branch : tuple of str
        Of each level ``"there"`` or ``"back"``, in the order of time.
    value : ndarray
        The parameter at each level, shape (levels,).
    flow_rate_ratio, flow_rate_ratio_error : ndarray
        Mean of J/Jmax over the late part of each level, and its standard error, which knows of correlations; NaN where
        the level is too short for one.
    threshold : float
        J/Jmax whose crossing counts as a transition.
    law : str
        Law of contact, ``"linear"`` or ``"hertz"``: figures name its units.

    Examples
    --------
    >>> import peristalsis
    >>> sim = peristalsis.Simulation.preset("frictionless-fine", waves=2, strain_rate=0.05, seed=1)
    >>> loop = sim.ramp("width", 2.4, 2.8, periods=6, levels=3)
    >>> loop.branch
    ('there', 'there', 'there', 'back', 'back', 'back')
    >>> loop.value.round(6).tolist()
    [2.4, 2.6, 2.8, 2.8, 2.6, 2.4]
    """

    parameter: _Parameter
    branch: tuple[str, ...]
    value: Array
    flow_rate_ratio: Array
    flow_rate_ratio_error: Array
    threshold: float
    law: Literal["linear", "hertz"] = "linear"

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Loop) and all(map(alike, vars(self).values(), vars(other).values()))

    @property
    def thresholds(self) -> Thresholds:
        """Where J/Jmax first crosses `threshold` on each branch.

        Examples
        --------
        >>> import numpy as np
        >>> import peristalsis
        >>> ratio = np.array([0.9, 0.1])
        >>> peristalsis.Loop("width", ("there", "there"), np.array([2.6, 2.8]), ratio, ratio, 0.5).thresholds.there.lower
        2.6
        """
        return Thresholds(self._crossing("there"), self._crossing("back"))

    def _crossing(self, branch: str) -> Threshold | None:
        here = np.array([name == branch for name in self.branch], dtype=bool)
        x, y = self.value[here], self.flow_rate_ratio[here] - self.threshold
        known = np.flatnonzero(np.isfinite(y))
        sides = [place for place in known if y[place] != 0]
        for one, other in zip(sides, sides[1:]):
            if y[one] * y[other] < 0:
                on_it = [x[place] for place in known if one < place < other]
                crossing = on_it[0] if on_it else x[one] + (x[other] - x[one]) * y[one] / (y[one] - y[other])
                return Threshold(float(crossing), float(min(x[one], x[other])), float(max(x[one], x[other])))
        return None

    def table(self) -> Table:
        """The loop as a table, one row a level: ``branch``, ``value``, ``flow_rate_ratio``, ``flow_rate_ratio_error``.

        Returns
        -------
        Table

        Examples
        --------
        >>> import numpy as np
        >>> import peristalsis
        >>> ratio = np.array([0.9, 0.1])
        >>> loop = peristalsis.Loop("width", ("there", "there"), np.array([2.6, 2.8]), ratio, ratio, 0.5)
        >>> loop.table().units["value"]
        'd'
        """
        return Table(
            [
                ("branch", "", "there or back", list(self.branch)),
                ("value", PARAMETERS[self.parameter][2], self.parameter, self.value),
                ("flow_rate_ratio", "1", "late mean of J/Jmax at this level", self.flow_rate_ratio),
                ("flow_rate_ratio_error", "1", "its standard error", self.flow_rate_ratio_error),
            ]
        )


def ramp(
    simulation: Simulation,
    parameter: _Parameter,
    values: Array,
    periods: float,
    settle: float,
    threshold: float,
    back: bool,
    shown: Shown,
    threads: int | None,
) -> Loop:
    """As `Simulation.ramp`, over given levels of so many periods each."""
    course = [("there", float(value)) for value in values]
    if back:
        course += [("back", float(value)) for value in values[::-1]]
    found: list[tuple[float, float]] = []
    with Telling(simulation), Progress(simulation, len(course), shown, "levels") as display:
        for number, (_, value) in enumerate(course):
            setattr(simulation, parameter, value)
            # A doubt of one level may be none of the whole, such as a threshold that is crossed later.
            steps = simulation._steps_of(periods, None)
            # To the end of a sample, with which the configuration of the whole course ends, too.
            steps += -(simulation.steps + steps) % simulation._run.steps_per_sample
            simulation._step(steps, threads=threads)
            found.append(_late(simulation, periods, settle))
            display.update(number + 1)
    means, errors = (np.array(column) for column in zip(*found))
    names = tuple(name for name, _ in course)
    return Loop(parameter, names, np.array([value for _, value in course]), means, errors, threshold, simulation.configuration["contact.law"])


def _late(simulation: Simulation, periods: float, settle: float) -> tuple[float, float]:
    """Mean and error of J/Jmax over the whole periods that a level has after `settle` of it, at least one."""
    series = simulation.timeseries()
    period, ratio = series["period"], series["flow_rate_ratio"]
    end = period[-1] if len(period) else np.nan
    whole = max(1, int((1 - settle) * periods + 1e-9))
    late = ratio[period > end - whole + 1e-6]
    late = late[np.isfinite(late)]
    if not len(late):
        return np.nan, np.nan
    try:
        answer = _core.mean_with_error(late)
        return answer["mean"], answer["error"]
    except AnalysisError:
        return float(late.mean()), np.nan
