"""Laws of the transition time compared by what the runs say for each."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

import numpy.typing as npt

from .. import _core
from ._columns import Numbers, law_of, result, run_table
from ._results import LawEvidence

if TYPE_CHECKING:
    from ._columns import _Family, _Law


def compare_laws(
    laws: Iterable[_Law],
    width: Numbers,
    time: Numbers,
    observed: npt.ArrayLike | None = None,
    *,
    family: _Family = "gamma",
) -> list[LawEvidence]:
    """What the runs say for each of several laws, by Akaike's criterion.

    Parameters
    ----------
    laws : iterable of str or mapping
        Laws as of `fit_law_to_runs`.
    width : array_like
        w of each run, shape (runs,).
    time : array_like
        Its transition time; without one, the time up to which it was watched (column `watched`).
    observed : array_like of bool, optional
        Whether there was a transition; all, by default.
    family : {"gamma", "exponential", "weibull"}
        Distribution of the times about their mean.

    Returns
    -------
    list of LawEvidence
        In the order of the laws; the best has excess 0.

    Raises
    ------
    AnalysisError
        Where fewer widths saw a transition than the law has parameters, or the likelihood has no maximum.
    ValueError
        For columns of unequal length.

    Notes
    -----
    Burnham & Anderson, Model Selection and Multimodel Inference (2002), sections 2.6 and 2.9.

    Examples
    --------
    >>> import numpy as np
    >>> from peristalsis import analysis
    >>> width = np.repeat([2.4, 2.5, 2.6, 2.7], 30)
    >>> time = np.random.default_rng(1).exponential(2.0 / (2.8 - width))
    >>> evidence = analysis.compare_laws(["power", "exponential"], width, time, family="exponential")
    >>> round(sum(law.weight for law in evidence), 6)
    1.0
    """
    table = run_table(width, time, observed)
    answers = _core.compare_laws([law_of(law) for law in laws], family, table)
    return [result(LawEvidence, answer) for answer in answers]


def compare_laws_with_scatter(
    laws: Iterable[_Law], width: Numbers, time: Numbers, observed: npt.ArrayLike | None = None
) -> list[LawEvidence]:
    """As `compare_laws`, with a scatter of the times that changes toward the critical width, as that of jams does.

    Gamma distributions about the mean, whose relative variance goes as (w_c - w)^-q, or as exp(-q w) in a law without w_c,
    q free. With one scatter for all widths the runs near w_c count too much, and may choose the wrong law.

    Parameters
    ----------
    laws : iterable of str or mapping
        Laws as of `fit_law_to_runs`.
    width : array_like
        w of each run, shape (runs,).
    time : array_like
        Its transition time; without one, the time up to which it was watched (column `watched`).
    observed : array_like of bool, optional
        Whether there was a transition; all, by default.

    Returns
    -------
    list of LawEvidence
        In the order of the laws; the best has excess 0.

    Raises
    ------
    AnalysisError
        As of `compare_laws`.
    ValueError
        For columns of unequal length.

    Examples
    --------
    Two runs each of 5, 10, 15, 20 and 40 per cent about 1/(3 - w):

    >>> from peristalsis import analysis
    >>> width = [2, 2, 2.5, 2.5, 2.75, 2.75, 2.875, 2.875, 2.9375, 2.9375]
    >>> time = [0.95, 1.05, 1.8, 2.2, 3.4, 4.6, 6.4, 9.6, 9.6, 22.4]
    >>> power, exponential = analysis.compare_laws_with_scatter(["power", "exponential"], width, time)
    >>> power.excess, exponential.excess > 10
    (0.0, True)
    """
    table = run_table(width, time, observed)
    answers = _core.compare_laws_with_scatter([law_of(law) for law in laws], table)
    return [result(LawEvidence, answer) for answer in answers]
