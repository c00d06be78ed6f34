"""Scaling collapse of any curves."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import Any, Literal

import numpy as np

from .. import _core
from .._arrays import Array
from .._core import AnalysisError
from .._given import alike, number, of_kind, whole
from ._columns import Numbers, columns, pair, reals, refuse, result
from ._results import CollapseEstimate, CollapseQuality, Interval, JointTest, Uncertain

#: Scalings by name.
_SCALINGS = ("finite_size", "critical_line", "critical_each")
#: Parameters of a scaling in its order: `None` for one that is free.
Places = Sequence["Uncertain | float | tuple[float, float] | None"]
#: ``x, y, error`` scaled, from ``(parameters, p, x, y, error)``.
Scaling = Callable[[list[float], float, float, float, float], tuple[float, float, float]]


@dataclass(frozen=True, eq=False)
class CollapseResult:
    """Best parameters of a scaling, with their errors and what to judge them by.

    Attributes
    ----------
    parameters : tuple of float
        The best.
    errors : tuple of float
        Standard errors: half the intervals of 68 per cent; infinite where the points leave a parameter open.
    intervals : tuple of Interval
        Intervals that, where `trusted`, cover the truth in 95 per cent of repetitions.
    trusted : bool
        Whether parameters and errors can be trusted.
    doubts : tuple of str
        If not, why.
    quality : float
        S: mean squared deviation from the common curve over its variance; near 1 where the curves agree.
    overlap : float
        Part of the points that were compared with other curves.
    leave_one_out : ndarray
        Parameters with each curve left out in turn, shape (curves, parameters); empty unless asked for. Exponents that
        hang on one curve move.
    estimate : CollapseEstimate
        The whole of what was found.

    Examples
    --------
    >>> import numpy as np
    >>> from peristalsis import analysis
    >>> x = np.linspace(-0.5, 0.5, 21)
    >>> curves = [(size, x, size**-0.5 / (1 + np.exp(x * size)), np.full(21, 0.003)) for size in (4.0, 8.0, 16.0)]
    >>> collapse = analysis.Collapse(curves, "finite_size")
    >>> found = collapse.fit([0.4, 0.9, 0.0], [0.1, 0.1, 0.02], starts=2)
    >>> [round(value, 1) for value in found.parameters], found.overlap > 0.5
    ([0.5, 1.0, 0.0], True)
    """

    parameters: tuple[float, ...]
    errors: tuple[float, ...]
    intervals: tuple[Interval, ...]
    trusted: bool
    doubts: tuple[str, ...]
    quality: float
    overlap: float
    leave_one_out: Array
    estimate: CollapseEstimate

    def __eq__(self, other: object) -> bool:
        return isinstance(other, CollapseResult) and all(map(alike, vars(self).values(), vars(other).values()))


class Collapse:
    """Curves of several parameters and a scaling in which they may fall on one another.

    Parameters
    ----------
    curves : iterable of (p, x, y, error)
        One entry a curve: its own parameter, and columns.
    scaling : str, mapping or callable
        ``"finite_size"``: y = p^-a f((x - x_c) p^b), parameters (a, b, x_c).
        ``"critical_line"``: y = p^-a f((x_c - x)/p^b) with x_c = slope p + x_max, parameters (a, b, slope, x_max), in
        logarithms. ``"critical_each"``: x_c of its own for each curve, parameters (a, b, x_c...).
        ``{"critical_known": [...]}``: known x_c, parameters (a, b).
        A function ``(parameters, p, x, y, error) -> (x, y, error)`` of numbers: anything else.
        Where f is a pure power over the whole range, the critical scalings fix only a combination of a and b.
    least_overlap : float
        Least part of the points that must be compared. At 0 a search may win by pulling the curves apart.

    Raises
    ------
    AnalysisError
        Below 2 curves, for a curve without points, a number that is not finite, an error that is not positive, and under a
        scaling by name a p that is not; under the critical scalings also for a y that is not positive.
    ValueError
        For columns of unequal length, or another scaling.

    Examples
    --------
    y = p x collapses as y/p^a at a = 1:

    >>> import numpy as np
    >>> from peristalsis.analysis import Collapse
    >>> x = np.arange(9.0)
    >>> curves = [(p, x, p * x, np.full(9, 0.1)) for p in (1.0, 2.0, 4.0)]
    >>> collapse = Collapse(curves, lambda a, p, x, y, e: (x, y * p ** -a[0], e))
    >>> round(collapse.fit([0.5], [0.2], starts=1).parameters[0], 2)
    1.0
    """

    def __init__(
        self,
        curves: Iterable[tuple[float, Numbers, Numbers, Numbers]],
        scaling: Literal["finite_size", "critical_line", "critical_each"] | Mapping[str, Any] | Scaling,
        *,
        least_overlap: float = 0.5,
    ) -> None:
        self.scaling: Any = dict(scaling) if isinstance(scaling, Mapping) else scaling
        is_known = list(scaling) == ["critical_known"] if isinstance(scaling, Mapping) else scaling in _SCALINGS
        if not (callable(scaling) or is_known):
            names = ", ".join(f'"{name}"' for name in _SCALINGS)
            raise ValueError(f'scaling is {names}, {{"critical_known": [x_c, ...]}} or a function, not {scaling!r}')
        self.least_overlap: float = number("least_overlap", least_overlap)
        if not 0.0 <= self.least_overlap <= 1.0:
            raise ValueError(f"least_overlap is a part of the points, from 0 to 1, not {self.least_overlap:g}")
        if isinstance(scaling, Mapping):
            reals("critical_known", scaling["critical_known"])
        self.curves: list[tuple[float, Array, Array, Array]] = [
            self._curve(f"curve {place}", curve) for place, curve in enumerate(curves)
        ]
        if len(self.curves) < 2:
            raise AnalysisError(f"a collapse compares 2 curves or more, not {len(self.curves)}")

    def _curve(self, name: str, given: Sequence[Any]) -> tuple[float, Array, Array, Array]:
        """A curve whose numbers the scaling can take."""
        if len(given) != 4:
            raise ValueError(f"{name} is (p, x, y, error), not {len(given)} entries")
        p = float(given[0])
        has_power = not callable(self.scaling)
        if not np.isfinite(p) or (has_power and p <= 0.0):
            raise AnalysisError(f"{name}: its p is {p:g}, but must be {'positive and ' if has_power else ''}finite")
        has_logarithm = has_power and self.scaling != "finite_size"
        try:
            x, y, error = columns(("y", "error") if has_logarithm else ("error",), x=given[1], y=given[2], error=given[3])
        except (TypeError, ValueError) as reason:
            raise type(reason)(f"{name}: {reason}") from None
        if not len(x):
            raise AnalysisError(f"{name} has no points")
        return p, x, y, error

    def fit(
        self,
        start: Sequence[float],
        steps: Sequence[float],
        *,
        starts: int = 8,
        seed: int = 0,
        correction: float | Literal["usual"] | None = "usual",
        leave_one_out: bool = False,
        known: Places = (),
    ) -> CollapseResult:
        """Parameters under which all points lie best on one smooth curve, with intervals that cover.

        Y = f(X) + p^c g(X) + noise for the scaled points (X, Y): f and g are any smooth curves, integrated out, so that
        what the common curve does between the points is part of the error. Intervals are those of the profile of the
        likelihood; errors that are smaller than the scatter of the points are stretched.

        Parameters
        ----------
        start, steps : sequence of float
            Where to begin, and how far to look about in each parameter.
        starts : int
            Searches, the others from random places within two steps of `start`.
        seed : int
            Of these places.
        correction : float, "usual" or None
            Power c of p in the correction to scaling p^c g(X) that is allowed for: -1 for sizes, 1 for strain rates is
            usual (``"finite_size"`` and functions, the critical scalings). None says that there is none: errors are then
            several times smaller, and wrong if there is one. The result is not trusted where the points leave room for
            one that takes a parameter out of its interval.
        leave_one_out : bool
            Whether to repeat the search without each curve in turn.
        known : sequence, optional
            Parameters known from elsewhere, in the order of the scaling: a pair of value and error or an `Uncertain`, which
            count as points beside the others, or None. Serves the x_c of ``"critical_each"`` that were found before: the
            error of one moves all points of its curve together.

        Returns
        -------
        CollapseResult
            Parameters with errors, what to judge them by, and whether to trust them.

        Raises
        ------
        AnalysisError
            Where the scaling has another number of parameters, no start finds enough overlap, or a number given is not
            finite; for a step or the error of a known parameter that is not positive, and where a correction meets a p that
            is not.

        Examples
        --------
        >>> import numpy as np
        >>> from peristalsis import analysis
        >>> x = np.linspace(-0.5, 0.5, 21)
        >>> curves = [(size, x, size**-0.5 / (1 + np.exp(x * size)), np.full(21, 0.003)) for size in (4.0, 8.0, 16.0)]
        >>> collapse = analysis.Collapse(curves, "finite_size")
        >>> found = collapse.fit([0.4, 0.9, 0.0], [0.1, 0.1, 0.02], starts=2)
        >>> [round(value, 1) for value in found.parameters]
        [0.5, 1.0, 0.0]
        """
        if correction == "usual":
            correction = -1.0 if callable(self.scaling) or self.scaling == "finite_size" else 1.0
        if leave_one_out and len(known):
            raise ValueError("leave_one_out repeats the search without what is known: ask for one of the two")
        if leave_one_out and len(self.curves) < 3:
            raise AnalysisError(f"leave_one_out needs 3 curves or more, not {len(self.curves)}")
        if correction is not None:
            correction = float(correction)
            if not np.isfinite(correction):
                raise AnalysisError(f"correction is {correction:g}, which is not a finite number")
            for place, (p, *_) in enumerate(self.curves):
                if p <= 0.0:
                    reason = "but must be positive for p^c: correction=None leaves the correction out"
                    raise AnalysisError(f"curve {place}: its p is {p:g}, {reason}")
        search = self._search(start, steps, known) | {
            "starts": whole("starts", starts, 1),
            "seed": whole("seed", seed, 0, 2**64 - 1),
            "correction": correction,
            "leave_one_out": bool(leave_one_out),
        }
        found, left_out = _core.fit_collapse(self.curves, self.scaling, search)
        estimate = result(CollapseEstimate, found)
        return CollapseResult(
            parameters=tuple(parameter.value for parameter in estimate.parameters),
            errors=tuple(parameter.error for parameter in estimate.parameters),
            intervals=tuple(parameter.interval_95 for parameter in estimate.parameters),
            trusted=estimate.trusted,
            doubts=estimate.doubts,
            quality=estimate.quality.quality,
            overlap=estimate.quality.overlap,
            leave_one_out=np.array(left_out, dtype=np.float64),
            estimate=estimate,
        )

    def _search(self, start: Sequence[float], steps: Sequence[float], known: Places) -> dict[str, Any]:
        begin, reach = reals("start", start), reals("steps", steps)
        refuse("steps", reach, reach <= 0.0, "but must be positive")
        if len(reach) != len(begin):
            raise AnalysisError(f"steps has a value for each of {len(begin)} parameters, not {len(reach)}")
        if len(known) > len(begin):
            raise AnalysisError(f"known has values for {len(begin)} parameters, not {len(known)}")
        given = {place: pair(f"known[{place}]", value) for place, value in enumerate(known) if value is not None}
        for place, (_, error) in given.items():
            if error == 0.0:
                raise AnalysisError(f"known[{place}] counts as a point, and needs an error above 0: (value, error)")
        return {
            "start": begin.tolist(),
            "steps": reach.tolist(),
            "starts": 1,
            "seed": 0,
            "least_overlap": self.least_overlap,
            "correction": None,
            "leave_one_out": False,
            "known": [(place, *values) for place, values in given.items()],
        }

    def joint_test(
        self, found: CollapseResult, claimed: Sequence[float | None], steps: Sequence[float], *, known: Places = ()
    ) -> JointTest:
        """Whether the parameters that were found are those claimed, all at once.

        Exponents of a collapse are correlated: values that each lie within the error of theirs may together be far from the
        valley in which the curves collapse. The ratio of the likelihoods at the best and with the claimed values held is
        compared with chi^2.

        Parameters
        ----------
        found : CollapseResult
            The result of `fit` for these curves.
        claimed : sequence of float or None
            Values claimed, in the order of the scaling; None leaves a parameter free.
        steps, known
            As of `fit`.

        Returns
        -------
        JointTest
            With as many degrees of freedom as values.

        Raises
        ------
        AnalysisError
            For steps or values that do not belong to the scaling, or where the curves do not overlap at the values claimed.

        Examples
        --------
        >>> import numpy as np
        >>> from peristalsis import analysis
        >>> x = np.linspace(-0.5, 0.5, 21)
        >>> curves = [(size, x, size**-0.5 / (1 + np.exp(x * size)), np.full(21, 0.003)) for size in (4.0, 8.0, 16.0)]
        >>> collapse, steps = analysis.Collapse(curves, "finite_size"), [0.1, 0.1, 0.02]
        >>> found = collapse.fit([0.4, 0.9, 0.0], steps, starts=2)
        >>> right, wrong = (collapse.joint_test(found, values, steps) for values in ([0.5, 1.0, None], [0.7, 1.0, None]))
        >>> right.probability > 0.5, wrong.probability < 0.001, right.degrees_of_freedom
        (True, True, 2)
        """
        of_kind("found", found, CollapseResult, "what Collapse.fit answered")
        if len(claimed) != len(found.parameters):
            raise AnalysisError(f"claimed has {len(claimed)} values of {len(found.parameters)} parameters")
        values = [(place, number("claimed", value)) for place, value in enumerate(claimed) if value is not None]
        search = self._search(found.parameters, steps, known)
        return result(JointTest, _core.test_collapse(self.curves, self.scaling, search, asdict(found.estimate), values))

    def quality(self, parameters: Sequence[float]) -> CollapseQuality:
        """How well the curves collapse at given parameters.

        Parameters
        ----------
        parameters : sequence of float
            Parameters of the scaling, in its order.

        Returns
        -------
        CollapseQuality
            S and overlap.

        Raises
        ------
        AnalysisError
            Where the scaling has another number of parameters, one is not finite, or no curves overlap.

        Examples
        --------
        >>> import numpy as np
        >>> from peristalsis import analysis
        >>> x = np.linspace(-0.5, 0.5, 21)
        >>> curves = [(size, x, size**-0.5 / (1 + np.exp(x * size)), np.full(21, 0.003)) for size in (4.0, 8.0, 16.0)]
        >>> collapse = analysis.Collapse(curves, "finite_size")
        >>> found = collapse.quality([0.5, 1.0, 0.0])
        >>> found.quality < 0.1, found.is_connected, found.compared, found.overlap > 0.5
        (True, True, 51, True)
        """
        quality, _ = _core.apply_collapse(self.curves, self.scaling, reals("parameters", parameters).tolist())
        return result(CollapseQuality, quality)

    def scaled(self, parameters: Sequence[float]) -> list[tuple[float, Array, Array, Array]]:
        """The scaled curves.

        Parameters
        ----------
        parameters : sequence of float
            Parameters of the scaling, in its order.

        Returns
        -------
        list of (p, x, y, error)
            One entry a curve, its columns of the shapes given.

        Raises
        ------
        AnalysisError
            Where the scaling has another number of parameters, one is not finite, or no curves overlap.

        Examples
        --------
        >>> import numpy as np
        >>> from peristalsis import analysis
        >>> x = np.linspace(-0.5, 0.5, 21)
        >>> curves = [(size, x, size**-0.5 / (1 + np.exp(x * size)), np.full(21, 0.003)) for size in (4.0, 8.0, 16.0)]
        >>> collapse = analysis.Collapse(curves, "finite_size")
        >>> p, x, y, error = collapse.scaled([0.5, 1.0, 0.0])[0]
        >>> round(float(x[-1]), 2), round(float(y[10]), 2)
        (2.0, 0.5)
        """
        _, scaled = _core.apply_collapse(self.curves, self.scaling, reals("parameters", parameters).tolist())

        def column(points: list[dict[str, float]], name: str) -> Array:
            return np.array([point[name] for point in points], dtype=np.float64)

        return [
            (curve[0], column(points, "x"), column(points, "y"), column(points, "error"))
            for curve, points in zip(self.curves, scaled, strict=True)
        ]
