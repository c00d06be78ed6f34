"""Estimators refuse what they can say nothing about, and are documented with examples that are run."""

import numpy as np
import pytest

from peristalsis import AnalysisError, analysis

TIMES = [1.0, 2.0, 3.0]


@pytest.mark.parametrize("observed", [[1, np.nan, 1], [1.0, 0.5, 0.0], [True, None, True], ["yes", "no", "yes"]])
def test_a_missing_outcome_is_no_transition(observed: list[object]) -> None:
    for refuse in (
        lambda: analysis.Survival(TIMES, observed),
        lambda: analysis.fit_lifetime(TIMES, observed),
        lambda: analysis.fit_law_to_runs("power", TIMES, TIMES, observed),
        lambda: analysis.fraction_crossing(TIMES, observed),
    ):
        with pytest.raises(AnalysisError, match="value [01] is .*none may be missing"):
            refuse()


@pytest.mark.parametrize("observed", [[1, 0, 1], [1.0, 0.0, 1.0], [True, False, True], np.array([1, 0, 1], dtype=np.int8)])
def test_ones_and_noughts_are_outcomes(observed: object) -> None:
    assert analysis.Survival(TIMES, observed).observed == 2


def test_outcomes_of_a_frame_are_outcomes() -> None:
    """Columns of pandas and polars, missing values among them."""
    import pandas
    import polars

    for column in (pandas.Series([True, False, True]), polars.Series([True, False, True])):
        assert analysis.Survival(TIMES, column).observed == 2
    for column in (pandas.Series([True, None, True], dtype="boolean"), polars.Series([True, None, True])):
        with pytest.raises(AnalysisError, match="missing"):
            analysis.Survival(TIMES, column)


def test_a_scaling_wants_all_its_parameters() -> None:
    x = np.linspace(-1, 1, 9)
    curves = [(p, x, np.exp(x * p), np.full(9, 0.1)) for p in (1.0, 2.0)]
    collapse = analysis.Collapse(curves, "finite_size")
    for refuse in (
        lambda: collapse.fit([0.1, 1.0], [0.1, 0.1]),
        lambda: collapse.quality([0.1, 1.0]),
        lambda: collapse.scaled([0.1, 1.0]),
    ):
        with pytest.raises(AnalysisError, match=r"3 parameters \(a, b, x_c\), not 2"):
            refuse()
    with pytest.raises(AnalysisError, match="not 1"):
        collapse.fit([0.1, 1.0, 0.0], [0.1])
    with pytest.raises(AnalysisError, match="w_c of curve 2"):
        analysis.Collapse(curves, "critical_each").quality([0.1, 1.0])
    with pytest.raises(AnalysisError, match="3 places for 2 curves"):
        analysis.Collapse(curves, {"critical_known": [1.0, 2.0, 3.0]}).quality([0.1, 1.0])


@pytest.mark.parametrize(("a", "b"), [(0.0, 0.05), (2.4, 1.6)])
def test_a_critical_line_that_is_left_open_is_not_trusted(a: float, b: float) -> None:
    """Three starts on a pure power law gave three answers with small errors, the caveat nowhere in Python."""
    randomness, gap = np.random.default_rng(4), np.geomspace(0.02, 0.4, 6)
    # y = (x_c - x)^-1.5 says of a and b that a = 1.5 b, and no more.
    time = 5 * gap**-1.5
    curves = [(p, 3 - 2 * p - gap, time * (1 + 0.03 * randomness.normal(size=6)), 0.03 * time) for p in (0.05, 0.1, 0.2)]
    fit = analysis.Collapse(curves, "critical_line").fit([a, b, -2.0, 3.0], [0.1, 0.1, 0.1, 0.02], starts=1, correction=None)
    assert not fit.trusted and any("leave parameter 2 open" in doubt for doubt in fit.doubts)
    assert not np.isfinite([fit.intervals[1].lower, fit.intervals[1].upper]).all()
    assert fit.parameters[0] / fit.parameters[1] == pytest.approx(1.5, abs=0.1)
    assert "fix only a combination of a and b" in (analysis.Collapse.__doc__ or "")


def test_results_are_pickled_and_say_their_fields() -> None:
    import pickle

    fit = analysis.fit_line([0, 1, 2], [1, 3, 5], [0.1, 0.1, 0.1])
    assert pickle.loads(pickle.dumps(fit)) == fit
    assert "slope : Uncertain" in (analysis.LineFit.__doc__ or "")
