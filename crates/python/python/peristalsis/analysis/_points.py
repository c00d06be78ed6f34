"""Laws, straight lines and parabolas through points with errors."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from .. import _core
from ._columns import Numbers, Uncertain, columns, law_of, pair, result

if TYPE_CHECKING:
    from ._columns import _Law


@dataclass(frozen=True)
class LawFit:
    """A law fitted to values with errors at several widths.

    Attributes
    ----------
    law : str | dict[str, Any]
        The law.
    critical_width : Uncertain | None
        Critical width w_c, with intervals by the profile of chi^2; `None` for a law without one. An upper end of
        infinity says that the points do not tell the law from an exponential.
    exponent : Uncertain
        Exponent, or coefficient of the barrier, B, with intervals by the profile of chi^2.
    ln_amplitude : Uncertain
        ln A, in the normal approximation.
    chi_squared : float
        Sum of the squared deviations of ln y in units of their errors, that of a known w_c included.
    degrees_of_freedom : int
        Points less free parameters.
    probability : float
        Probability of a chi^2 at least as large if the law and the errors are right.

    Examples
    --------
    >>> import numpy as np
    >>> from peristalsis import analysis
    >>> width = np.linspace(2.4, 2.7, 8)
    >>> time = 3.0 * (2.8 - width) ** -1.5
    >>> fit = analysis.fit_law("power", width, time, 0.01 * time)
    >>> round(fit.critical_width.value, 3), round(fit.exponent.value, 3), fit.degrees_of_freedom
    (2.8, 1.5, 5)
    """

    law: str | dict[str, Any]
    critical_width: Uncertain | None
    exponent: Uncertain
    ln_amplitude: Uncertain
    chi_squared: float
    degrees_of_freedom: int
    probability: float


@dataclass(frozen=True)
class LineFit:
    """A straight line through points with errors.

    Attributes
    ----------
    intercept : Uncertain
        Value at x = 0.
    slope : Uncertain
        Slope.
    covariance : float
        Covariance of intercept and slope.
    chi_squared : float
        Sum of the squared deviations in units of their errors.
    degrees_of_freedom : int
        Points less parameters.
    probability : float
        Probability of a chi^2 at least as large if the line and the errors are right; 1 without degrees of freedom.

    Examples
    --------
    >>> from peristalsis import analysis
    >>> fit = analysis.fit_line([0, 1, 2], [1, 3, 5], [0.1, 0.1, 0.1])
    >>> round(fit.intercept.value, 6), round(fit.slope.value, 6), fit.degrees_of_freedom
    (1.0, 2.0, 1)
    """

    intercept: Uncertain
    slope: Uncertain
    covariance: float
    chi_squared: float
    degrees_of_freedom: int
    probability: float


@dataclass(frozen=True)
class CurveFit:
    """A parabola through points with errors, beside the straight line.

    Attributes
    ----------
    constant : Uncertain
        Value of the parabola at x = 0.
    linear : Uncertain
        Its slope at x = 0.
    quadratic : Uncertain
        Coefficient of x^2.
    chi_squared : float
        chi^2 of the parabola.
    degrees_of_freedom : int
        Points less parameters.
    probability : float
        Probability of a chi^2 at least as large if the parabola and the errors are right.
    line : LineFit
        The straight line through the same points.
    linearity : float
        Probability of a quadratic term at least as large, of either sign, if the points lie on a line.

    Examples
    --------
    >>> from peristalsis import analysis
    >>> fit = analysis.fit_parabola([0, 1, 2, 3], [1, 2, 5, 10], [0.1] * 4)
    >>> round(fit.quadratic.value, 6), fit.linearity < 0.01
    (1.0, True)
    """

    constant: Uncertain
    linear: Uncertain
    quadratic: Uncertain
    chi_squared: float
    degrees_of_freedom: int
    probability: float
    line: LineFit
    linearity: float


def fit_law(
    law: _Law,
    width: Numbers,
    value: Numbers,
    error: Numbers,
    *,
    critical_width: Uncertain | float | tuple[float, float] | None = None,
) -> LawFit:
    """A law of divergence through values with errors at several widths.

    The least sum of (ln y_i - ln A - B x(w_i))^2 y_i^2/error_i^2 over ln A, B and w_c.

    Parameters
    ----------
    law : str or mapping
        ``"power"``: y = A (w_c - w)^-B; ``"exponential"``: y = A exp(B w);
        ``{"barrier": {"power": p}}``: y = A exp(B/(w_c - w)^p).
    width, value, error : array_like
        w, y and its standard error, shape (n,).
    critical_width : optional
        w_c where it is known: a number, with its error as a pair or an `Uncertain`.

    Returns
    -------
    LawFit
        Critical width in the unit of `width`, exponent and amplitude.

    Raises
    ------
    AnalysisError
        Where there are fewer points than parameters, or a value or error is not positive.
    ValueError
        For columns of unequal length.

    Notes
    -----
    Errors of some 20 per cent or more bias ln y: prefer `fit_law_to_runs` where the runs are at hand. Seber & Wild,
    Nonlinear Regression (1989), sections 5.4 and 14.7.

    Examples
    --------
    >>> import numpy as np
    >>> from peristalsis import analysis
    >>> width = np.linspace(2.4, 2.7, 8)
    >>> time = 3.0 * (2.8 - width) ** -1.5
    >>> fit = analysis.fit_law("power", width, time, 0.01 * time)
    >>> round(fit.critical_width.value, 3), round(fit.exponent.value, 3), fit.degrees_of_freedom
    (2.8, 1.5, 5)
    """
    known = None if critical_width is None else pair(critical_width)
    widths, values, errors = columns(width, value, error)
    return result(LawFit, _core.fit_law(law_of(law), widths, values, errors, known))


def fit_line(x: Numbers, y: Numbers, error: Numbers) -> LineFit:
    """A straight line through points with errors: the least sum of (y - a - b x)^2/error^2.

    Parameters
    ----------
    x, y, error : array_like
        Abscissae, ordinates and their standard errors, shape (n,).

    Returns
    -------
    LineFit
        Intercept and slope, in the units of y and of y/x.

    Raises
    ------
    AnalysisError
        Below 2 points, or for an error that is not positive.
    ValueError
        For columns of unequal length.

    Examples
    --------
    >>> from peristalsis import analysis
    >>> fit = analysis.fit_line([0, 1, 2], [1, 3, 5], [0.1, 0.1, 0.1])
    >>> round(fit.intercept.value, 6), round(fit.slope.value, 6), fit.degrees_of_freedom
    (1.0, 2.0, 1)
    """
    return result(LineFit, _core.fit_line(*columns(x, y, error)))


def fit_parabola(x: Numbers, y: Numbers, error: Numbers) -> CurveFit:
    """A parabola through points with errors, beside the straight line.

    Parameters
    ----------
    x, y, error : array_like
        Abscissae, ordinates and their standard errors, shape (n,).

    Returns
    -------
    CurveFit
        Its coefficients, and the probability of its bend if the points lie on a line.

    Raises
    ------
    AnalysisError
        Below 3 points, or for an error that is not positive.
    ValueError
        For columns of unequal length.

    Examples
    --------
    >>> from peristalsis import analysis
    >>> fit = analysis.fit_parabola([0, 1, 2, 3], [1, 2, 5, 10], [0.1] * 4)
    >>> round(fit.quadratic.value, 6), fit.linearity < 0.01
    (1.0, True)
    """
    return result(CurveFit, _core.fit_parabola(*columns(x, y, error)))


def power_exponent(x: Numbers, y: Numbers, error: Numbers) -> LineFit:
    """A power law y = A x^B through positive points with errors: the line through their logarithms, its slope B.

    Parameters
    ----------
    x, y, error : array_like
        Abscissae, ordinates and their standard errors, shape (n,).

    Returns
    -------
    LineFit
        Intercept ln A and slope B.

    Raises
    ------
    AnalysisError
        Below 2 points, or for an abscissa, ordinate or error that is not positive.
    ValueError
        For columns of unequal length.

    Examples
    --------
    >>> from peristalsis import analysis
    >>> round(analysis.power_exponent([1, 2, 4], [1, 8, 64], [0.1, 0.8, 6.4]).slope.value, 6)
    3.0
    """
    return result(LineFit, _core.power_exponent(*columns(x, y, error)))
