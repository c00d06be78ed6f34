"""Scaling collapse of any curves."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

from .. import _core
from .._arrays import Array
from ._columns import Interval, Numbers, Uncertain, columns, result

#: ``x, y, error`` scaled, from ``(parameters, p, x, y, error)``.
Scaling = Callable[[list[float], float, float, float, float], tuple[float, float, float]]


@dataclass(frozen=True)
class CollapseQuality:
    """How well scaled curves lie on a common one.

    Attributes
    ----------
    quality : float
        Mean squared distance S from the master curve in units of the errors: about 1 for a perfect collapse, the
        larger the worse. Meaningless without the overlap.
    overlap : float
        Fraction of all points that lie within the range of another curve, and so are compared at all. Points that the
        scaling sends to infinity, such as those beyond the critical width, count among all.
    compared : int
        Points compared.
    is_connected : bool
        Whether the curves hang together: each is compared with another, and no group stands apart from the rest.

    Examples
    --------
    >>> import numpy as np
    >>> from peristalsis import analysis
    >>> x = np.linspace(-0.5, 0.5, 21)
    >>> curves = [(size, x, size**-0.5 / (1 + np.exp(x * size)), np.full(21, 0.003)) for size in (4.0, 8.0, 16.0)]
    >>> collapse = analysis.Collapse(curves, "finite_size")
    >>> found = collapse.quality([0.5, 1.0, 0.0])
    >>> found.quality < 0.1, found.is_connected, found.compared
    (True, True, 51)
    """

    quality: float
    overlap: float
    compared: int
    is_connected: bool


@dataclass(frozen=True)
class CollapseFit:
    """Best parameters of a scaling.

    Attributes
    ----------
    parameters : tuple[float, ...]
        Parameters, in the order of the scaling.
    quality : CollapseQuality
        Quality and overlap of the collapse.
    agreeing : int
        Starts whose search ended at this minimum to within 1 per cent of S, of all starts: few say that there are
        others.
    starts : int
        Searches made.
    converged : bool
        Whether the best search converged.

    Examples
    --------
    >>> import numpy as np
    >>> from peristalsis import analysis
    >>> x = np.linspace(-0.5, 0.5, 21)
    >>> curves = [(size, x, size**-0.5 / (1 + np.exp(x * size)), np.full(21, 0.003)) for size in (4.0, 8.0, 16.0)]
    >>> collapse = analysis.Collapse(curves, "finite_size")
    >>> fit = collapse.fit([0.4, 0.9, 0.0], [0.1, 0.1, 0.02], starts=2, resamples=0).fit
    >>> [round(value, 1) for value in fit.parameters], fit.starts
    ([0.5, 1.0, 0.0], 2)
    """

    parameters: tuple[float, ...]
    quality: CollapseQuality
    agreeing: int
    starts: int
    converged: bool


@dataclass(frozen=True)
class Resampled:
    """Estimates from resampled data.

    Attributes
    ----------
    estimates : tuple[Uncertain, ...]
        The estimates with their bootstrap errors and percentile intervals.
    succeeded : int
        Resamples that gave estimates.
    failed : int
        Resamples that did not, such as those left without a transition. Where these are more than a few, the
        intervals are too short.

    Examples
    --------
    >>> import numpy as np
    >>> from peristalsis import analysis
    >>> x = np.linspace(-0.5, 0.5, 21)
    >>> curves = [(size, x, size**-0.5 / (1 + np.exp(x * size)), np.full(21, 0.003)) for size in (4.0, 8.0, 16.0)]
    >>> collapse = analysis.Collapse(curves, "finite_size")
    >>> resampled = collapse.fit([0.4, 0.9, 0.0], [0.1, 0.1, 0.02], starts=1, resamples=20).resampled
    >>> len(resampled.estimates), resampled.succeeded + resampled.failed
    (3, 20)
    """

    estimates: tuple[Uncertain, ...]
    succeeded: int
    failed: int


@dataclass(frozen=True)
class CollapseResult:
    """Best parameters of a scaling, with their errors and what to judge them by.

    Attributes
    ----------
    parameters : tuple of float
        The best.
    errors : tuple of float
        Standard errors from resampled ordinates; NaN where none were resampled. Right where `quality` is near 1.
    quality : float
        S: mean squared deviation from the common curve over its variance; near 1 where the curves agree.
    overlap : float
        Part of the points that were compared with other curves.
    contour : tuple of Interval
        Range of each parameter in which S stays within 1 of its minimum, the others free: a safe outer bound.
    leave_one_out : ndarray
        Parameters with each curve left out in turn, shape (curves, parameters); empty unless asked for. Exponents that
        hang on one curve move.
    fit : CollapseFit
        The whole of what the search answered.
    resampled : Resampled or None
        The whole of what the resampling answered.

    Examples
    --------
    >>> import numpy as np
    >>> from peristalsis import analysis
    >>> x = np.linspace(-0.5, 0.5, 21)
    >>> curves = [(size, x, size**-0.5 / (1 + np.exp(x * size)), np.full(21, 0.003)) for size in (4.0, 8.0, 16.0)]
    >>> collapse = analysis.Collapse(curves, "finite_size")
    >>> found = collapse.fit([0.4, 0.9, 0.0], [0.1, 0.1, 0.02], starts=2, resamples=20)
    >>> [round(value, 1) for value in found.parameters], found.overlap > 0.5
    ([0.5, 1.0, 0.0], True)
    """

    parameters: tuple[float, ...]
    errors: tuple[float, ...]
    quality: float
    overlap: float
    contour: tuple[Interval, ...]
    leave_one_out: Array
    fit: CollapseFit
    resampled: Resampled | None


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

    Examples
    --------
    y = p x collapses as y/p^a at a = 1:

    >>> import numpy as np
    >>> from peristalsis.analysis import Collapse
    >>> x = np.arange(9.0)
    >>> curves = [(p, x, p * x, np.full(9, 0.1)) for p in (1.0, 2.0)]
    >>> collapse = Collapse(curves, lambda a, p, x, y, e: (x, y * p ** -a[0], e))
    >>> round(collapse.fit([0.5], [0.2], starts=1, resamples=0).parameters[0], 2)
    1.0
    """

    def __init__(
        self,
        curves: Iterable[tuple[float, Numbers, Numbers, Numbers]],
        scaling: Literal["finite_size", "critical_line", "critical_each"] | Mapping[str, Any] | Scaling,
        *,
        least_overlap: float = 0.5,
    ) -> None:
        self.curves: list[tuple[float, Array, Array, Array]] = []
        for parameter, *given in curves:
            x, y, error = columns(*given)
            self.curves.append((float(parameter), x, y, error))
        self.scaling: Any = dict(scaling) if isinstance(scaling, Mapping) else scaling
        self.least_overlap: float = float(least_overlap)

    def fit(
        self,
        start: Sequence[float],
        steps: Sequence[float],
        *,
        starts: int = 8,
        seed: int = 0,
        resamples: int = 100,
        leave_one_out: bool = False,
    ) -> CollapseResult:
        """Search for the best parameters.

        Parameters
        ----------
        start, steps : sequence of float
            Where to begin, and how far to look about in each parameter.
        starts : int
            Searches, the others from random places within two steps of `start`.
        seed : int
            Of these and of the resamples.
        resamples : int
            Resampled sets of ordinates for the errors, 20 at least; 0 for none.
        leave_one_out : bool
            Whether to repeat the search without each curve in turn.

        Returns
        -------
        CollapseResult
            Parameters with errors, and what to judge them by.

        Raises
        ------
        AnalysisError
            Where the scaling has another number of parameters, no start finds enough overlap, or the data are not
            finite.

        Examples
        --------
        >>> import numpy as np
        >>> from peristalsis import analysis
        >>> x = np.linspace(-0.5, 0.5, 21)
        >>> curves = [(size, x, size**-0.5 / (1 + np.exp(x * size)), np.full(21, 0.003)) for size in (4.0, 8.0, 16.0)]
        >>> collapse = analysis.Collapse(curves, "finite_size")
        >>> found = collapse.fit([0.4, 0.9, 0.0], [0.1, 0.1, 0.02], starts=2, resamples=0)
        >>> [round(value, 1) for value in found.parameters]
        [0.5, 1.0, 0.0]
        """
        search = {
            "start": [float(value) for value in start],
            "steps": [float(value) for value in steps],
            "starts": int(starts),
            "seed": int(seed),
            "least_overlap": self.least_overlap,
            "resamples": int(resamples),
            "leave_one_out": bool(leave_one_out),
        }
        found, scatter, contour, left_out = _core.fit_collapse(self.curves, self.scaling, search)
        fit = result(CollapseFit, found)
        resampled = None if scatter is None else result(Resampled, scatter)
        errors = (
            (float("nan"),) * len(fit.parameters)
            if resampled is None
            else tuple(estimate.error for estimate in resampled.estimates)
        )
        return CollapseResult(
            parameters=fit.parameters,
            errors=errors,
            quality=fit.quality.quality,
            overlap=fit.quality.overlap,
            contour=tuple(result(Interval, interval) for interval in contour),
            leave_one_out=np.array([other["parameters"] for other in left_out], dtype=np.float64),
            fit=fit,
            resampled=resampled,
        )

    def quality(self, parameters: Sequence[float]) -> CollapseQuality:
        """How well the curves collapse at given parameters.

        Parameters
        ----------
        parameters : sequence of float
            Those of the scaling, in its order.

        Returns
        -------
        CollapseQuality
            S and overlap.

        Raises
        ------
        AnalysisError
            Where the scaling has another number of parameters, or the data are not finite.

        Examples
        --------
        >>> import numpy as np
        >>> from peristalsis import analysis
        >>> x = np.linspace(-0.5, 0.5, 21)
        >>> curves = [(size, x, size**-0.5 / (1 + np.exp(x * size)), np.full(21, 0.003)) for size in (4.0, 8.0, 16.0)]
        >>> collapse = analysis.Collapse(curves, "finite_size")
        >>> collapse.quality([0.5, 1.0, 0.0]).overlap > 0.5
        True
        """
        quality, _ = _core.apply_collapse(self.curves, self.scaling, [float(p) for p in parameters])
        return result(CollapseQuality, quality)

    def scaled(self, parameters: Sequence[float]) -> list[tuple[float, Array, Array, Array]]:
        """The scaled curves.

        Parameters
        ----------
        parameters : sequence of float
            Those of the scaling, in its order.

        Returns
        -------
        list of (p, x, y, error)
            One entry a curve, its columns of the shapes given.

        Raises
        ------
        AnalysisError
            Where the scaling has another number of parameters, or the data are not finite.

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
        _, scaled = _core.apply_collapse(self.curves, self.scaling, [float(p) for p in parameters])

        def column(points: list[dict[str, float]], name: str) -> Array:
            return np.array([point[name] for point in points], dtype=np.float64)

        return [
            (curve[0], column(points, "x"), column(points, "y"), column(points, "error"))
            for curve, points in zip(self.curves, scaled, strict=True)
        ]
