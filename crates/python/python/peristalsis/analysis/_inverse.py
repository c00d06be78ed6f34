"""Times that diverge with an exponent of 1: their inverse against the width."""

from __future__ import annotations


from .. import _core
from ._columns import Numbers, columns, result
from ._results import InverseFit


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
    return result(InverseFit, _core.fit_inverse_line(*columns(("value", "error"), width=width, value=value, error=error)))


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
    return result(InverseFit, _core.fit_inverse_parabola(*columns(("value", "error"), width=width, value=value, error=error)))
