"""Times that diverge with an exponent of 1: their inverse against the width."""

from __future__ import annotations

from dataclasses import dataclass

from .. import _core
from ._columns import Numbers, Uncertain, columns, result


@dataclass(frozen=True)
class InverseFit:
    """1/y = B (w_c - w) + C (w_c - w)^2 fitted to values with errors: a divergence with an exponent of 1 exactly.

    Attributes
    ----------
    critical_width : Uncertain
        w_c, where 1/y falls through 0; intervals by the profile of chi^2, infinite where the points leave them open.
    linear : Uncertain
        B, positive; normal intervals.
    quadratic : Uncertain or None
        C; `None` for a line.
    chi_squared : float
        Sum of the squared deviations of 1/y in units of their errors.
    degrees_of_freedom : int
        Points less free parameters.
    probability : float
        Probability of a chi^2 at least as large if the law and the errors are right; 1 without degrees of freedom.
    explained : float
        R^2: the part of the weighted scatter of 1/y that the law accounts for.

    Examples
    --------
    >>> from peristalsis import analysis
    >>> fit = analysis.fit_inverse_line([2, 2.5, 2.75], [2, 4, 8], [0.1, 0.2, 0.4])     # tau = 2/(3 - w)
    >>> round(fit.critical_width.value, 6), round(fit.linear.value, 6), fit.quadratic, fit.degrees_of_freedom
    (3.0, 0.5, None, 1)
    """

    critical_width: Uncertain
    linear: Uncertain
    quadratic: Uncertain | None
    chi_squared: float
    degrees_of_freedom: int
    probability: float
    explained: float


def fit_inverse_line(width: Numbers, value: Numbers, error: Numbers) -> InverseFit:
    """The straight line 1/y = B (w_c - w), w_c free, by weighted least squares: what reads an exponent of 1 off a figure.

    The error of 1/y is error/y^2; above some 20 per cent of y it is no longer normal.

    Parameters
    ----------
    width, value, error : array_like
        w, y and its standard error, shape (n,).

    Returns
    -------
    InverseFit
        Critical width in the unit of `width`, with Fieller's interval, and goodness of fit. `fit_law` leaves the exponent
        free.

    Raises
    ------
    AnalysisError
        Below 2 distinct widths, for a value or error that is not positive, or where 1/y does not fall to 0 as the width
        grows.
    ValueError
        For columns of unequal length.

    Notes
    -----
    Fieller, J. R. Stat. Soc. B 16, 175 (1954).

    Examples
    --------
    >>> from peristalsis import analysis
    >>> fit = analysis.fit_inverse_line([2, 2.5, 2.75], [2, 4, 8], [0.1, 0.2, 0.4])     # tau = 2/(3 - w)
    >>> round(fit.critical_width.value, 6), round(fit.linear.value, 6), fit.quadratic, fit.degrees_of_freedom
    (3.0, 0.5, None, 1)
    """
    return result(InverseFit, _core.fit_inverse_line(*columns(width, value, error)))


def fit_inverse_parabola(width: Numbers, value: Numbers, error: Numbers) -> InverseFit:
    """The parabola 1/y = B (w_c - w) + C (w_c - w)^2, w_c free: an exponent of 1 with a first correction.

    It has as many parameters as the free power of `fit_law`, so that chi^2 of the two can be compared as they are.

    Parameters
    ----------
    width, value, error : array_like
        w, y and its standard error, shape (n,).

    Returns
    -------
    InverseFit
        As of `fit_inverse_line`.

    Raises
    ------
    AnalysisError
        Below 3 distinct widths, else as of `fit_inverse_line`.
    ValueError
        For columns of unequal length.

    Examples
    --------
    >>> import numpy as np
    >>> from peristalsis import analysis
    >>> d = np.array([1, 0.5, 0.25, 0.125])
    >>> fit = analysis.fit_inverse_parabola(3 - d, 1 / (d + d**2), 0.01 / (d + d**2))
    >>> round(fit.critical_width.value, 6), round(fit.linear.value, 6), round(fit.quadratic.value, 6)
    (3.0, 1.0, 1.0)
    """
    return result(InverseFit, _core.fit_inverse_parabola(*columns(width, value, error)))
