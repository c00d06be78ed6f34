"""Estimators from Python: known answers, any data, and errors that say why."""

import os
import signal
import threading
import time

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from peristalsis import AnalysisError, analysis, newtonian, plot


def ising_like(sizes: list[float], seed: int = 1) -> list[tuple[float, np.ndarray, np.ndarray, np.ndarray]]:
    """y = L^-1/8 f((x - 2.27) L) with noise of one per cent: not our data."""
    randomness = np.random.default_rng(seed)
    curves = []
    for size in sizes:
        x = np.linspace(2.27 - 3 / size, 2.27 + 3 / size, 25)
        clean = size**-0.125 / (1 + np.exp((x - 2.27) * size))
        error = np.full_like(x, 0.01 * size**-0.125)
        curves.append((size, x, clean + error * randomness.normal(size=len(x)), error))
    return curves


def test_collapse_of_data_that_are_not_ours() -> None:
    collapse = analysis.Collapse(ising_like([8, 16, 32, 64]), "finite_size")
    fit = collapse.fit([0.2, 0.8, 2.3], [0.1, 0.2, 0.05], correction=None, leave_one_out=True)
    for found, error, true in zip(fit.parameters, fit.errors, (0.125, 1.0, 2.27), strict=True):
        assert abs(found - true) < 4 * error and 0 < error < 0.1
    assert 0.5 < fit.quality < 2.0 and fit.overlap > 0.5
    assert fit.leave_one_out.shape == (4, 3)
    assert all(interval.lower <= found <= interval.upper for interval, found in zip(fit.intervals, fit.parameters, strict=True))
    assert fit.trusted == (not fit.doubts)
    assert collapse.quality([0.125, 2.0, 2.27]).quality > 10 * fit.quality
    axes = plot.collapse(collapse, fit)
    assert axes.get_title().startswith("$S$ = ")


def test_a_function_of_python_gives_what_ours_gives() -> None:
    curves = ising_like([8, 16, 32])

    def scaling(parameters: list[float], size: float, x: float, y: float, error: float) -> tuple[float, float, float]:
        a, b, critical = parameters
        return (x - critical) * size**b, y * size**a, error * size**a

    ours, theirs = analysis.Collapse(curves, "finite_size"), analysis.Collapse(curves, scaling)
    at = [0.13, 0.9, 2.26]
    assert ours.quality(at).quality == pytest.approx(theirs.quality(at).quality, rel=1e-9)
    fits = [each.fit([0.2, 0.8, 2.3], [0.1, 0.2, 0.05], starts=2) for each in (ours, theirs)]
    assert fits[0].parameters == pytest.approx(fits[1].parameters, abs=1e-4)
    assert fits[0].errors == pytest.approx(fits[1].errors, rel=0.05)

    def broken(*_: object) -> tuple[float, float, float]:
        raise LookupError("mine")

    with pytest.raises(LookupError, match="mine"):
        analysis.Collapse(curves, broken).quality(at)


@pytest.mark.parametrize("bad", [np.nan, np.inf, 0.0, -1.0])
def test_a_collapse_refuses_a_number_that_it_cannot_take_and_says_where_it_is(bad: float) -> None:
    for column, name in enumerate(("x", "y", "error"), 1):
        curves = ising_like([8, 16, 32])
        curves[1][column][4] = bad
        for scaling in ("finite_size", "critical_line", lambda a, p, x, y, error: (x, y, error)):
            # The critical scalings take logarithms of y.
            if np.isfinite(bad) and (name == "x" or (name == "y" and scaling != "critical_line")):
                analysis.Collapse(curves, scaling)
                continue
            with pytest.raises(AnalysisError, match=f"curve 1: {name}: value 4 is {bad:g}, "):
                analysis.Collapse(curves, scaling)
    with pytest.raises(AnalysisError, match=f"curve 0: its p is {bad:g}, "):
        analysis.Collapse([(bad, *curve[1:]) for curve in ising_like([8, 16])], "finite_size")


def test_a_search_says_which_of_its_arguments_is_wrong() -> None:
    curves = ising_like([8, 16])
    collapse, start, steps = analysis.Collapse(curves, "finite_size"), [0.2, 0.8, 2.3], [0.1, 0.2, 0.05]
    for call, reason in (
        (lambda: analysis.Collapse(curves[:1], "finite_size"), "compares 2 curves or more, not 1"),
        (lambda: analysis.Collapse([*curves, (32.0, [], [], [])], "finite_size"), "curve 2 has no points"),
        (lambda: collapse.fit(start, [0.1, 0.0, 0.1]), "steps: value 1 is 0, but must be positive"),
        (lambda: collapse.fit([np.nan, 0.8, 2.3], steps), "start: value 0 is nan"),
        (lambda: collapse.fit(start, steps[:2]), "steps has a value for each of 3 parameters, not 2"),
        (lambda: collapse.fit(start, steps, known=[None, 1.0]), r"known\[1\] counts as a point, and needs an error"),
        (lambda: collapse.fit(start, steps, leave_one_out=True), "needs 3 curves or more, not 2"),
        (lambda: collapse.quality([0.2, np.inf, 2.3]), "parameters: value 1 is inf"),
    ):
        with pytest.raises(AnalysisError, match=reason):
            call()


def test_errors_name_the_argument() -> None:
    x, y, error = [1.0, 2.0, 4.0], [1.0, 2.0, 3.0], [0.1, 0.1, 0.1]
    for call, reason in (
        (lambda: analysis.fraction_crossing([2.5, 2.6], [True]), "unequal length: width 2, jammed 1"),
        (lambda: analysis.hysteresis(x, [1, 1, 0], x, [1, 2, 0]), "jammed_jammed: value 1 is 2"),
        (lambda: analysis.fit_line(x, y, [0.1, 0.0, 0.1]), "error: value 1 is 0, but must be positive"),
        (lambda: analysis.fit_line(x, [1.0, np.nan, 2.0], error), "y: value 1 is nan, which is not a finite number"),
        (lambda: analysis.fit_law("power", x, y, error, critical_width=(2.8, -1.0)), "critical_width has an error of -1"),
        (lambda: analysis.jump_height((x, y, error), (x, y, [0.1, 0.1, -1.0]), 2.8), "lower errors: value 2 is -1"),
        (lambda: analysis.fit_lifetime([1.0, 0.0, 2.0]), "time: value 1 is 0, but a transition comes after 0"),
        (lambda: analysis.Survival([1.0, 2.0], [[True, False]]), "observed: a column has one dimension, not 2"),
        (lambda: analysis.ensemble_moments([x, [1.0, 2.0, np.inf], y]), "replicate 1: value 2 is inf"),
    ):
        with pytest.raises(ValueError, match=reason):
            call()


def test_a_law_of_divergence_by_hand() -> None:
    width = np.linspace(2.4, 2.7, 8)
    time = 3.0 * (2.8 - width) ** -1.5
    fit = analysis.fit_law("power", width, time, 0.01 * time)
    assert fit.critical_width is not None
    assert fit.critical_width.value == pytest.approx(2.8, abs=1e-3)
    assert fit.exponent.value == pytest.approx(1.5, abs=1e-2)
    assert fit.exponent.interval_95.lower < 1.5 < fit.exponent.interval_95.upper
    known = analysis.fit_law("power", width, time, 0.01 * time, critical_width=(2.8, 0.0))
    assert known.exponent.value == pytest.approx(1.5, abs=1e-6)
    assert str(known.exponent).startswith("1.5")
    with pytest.raises(AnalysisError):
        analysis.fit_law("power", width[:2], time[:2], time[:2])
    with pytest.raises(AnalysisError, match="unknown variant"):
        analysis.fit_law("parabolic", width, time, time)
    with pytest.raises(ValueError, match="unequal length: x 8, y 7, error 8"):
        analysis.fit_line(width, time[1:], time)


def test_laws_from_runs_with_censored_ones() -> None:
    randomness = np.random.default_rng(5)
    width = np.repeat(np.linspace(2.4, 2.7, 6), 30)
    time = randomness.exponential(2.0 / (2.8 - width))
    observed = time < 60.0
    fit = analysis.fit_law_to_runs("power", width, np.minimum(time, 60.0), observed, family="exponential")
    assert fit.observed == observed.sum() and fit.censored == (~observed).sum() > 0
    assert fit.exponent.interval_95.lower < 1.0 < fit.exponent.interval_95.upper
    evidence = analysis.compare_laws(["power", "exponential"], width, np.minimum(time, 60.0), observed, family="exponential")
    assert sum(each.weight for each in evidence) == pytest.approx(1.0)


def test_mean_and_variance_of_transition_times_near_their_divergence() -> None:
    randomness = np.random.default_rng(11)
    width = np.repeat(np.linspace(2.4, 2.75, 8), 60)
    distance = 2.8 - width
    # alpha = 1 and q = 1: shape (w_c - w)/C
    shape = distance / 0.02
    time = randomness.gamma(shape, 3.0 / distance / shape)
    observed = time < 150.0
    time = np.minimum(time, 150.0)
    fit = analysis.fit_law_with_scatter(width, time, observed)
    for found, true in ((fit.critical_width, 2.8), (fit.exponent, 1.0), (fit.scatter_exponent, 1.0)):
        assert abs(found.value - true) < 4 * found.error < 1.0
    assert fit.chance_probability < 1e-6
    ensembles = analysis.ensembles_by_width(width, time, observed)
    assert [each.width for each in ensembles] == sorted(set(width)) and ensembles[0].observed == 60
    first = ensembles[0].fit
    assert first is not None and first.variance.value == pytest.approx(3.0**2 * 0.02 / 0.4**3, rel=0.5)
    windows = analysis.fit_law_to_runs_in_windows("power", width, time, observed)
    assert len(windows) > 3 and (windows[0].least, windows[0].largest) == (2.4, 2.75)


def test_second_moment_of_runs_that_end() -> None:
    runs = [[0.0, 1.0], [0.0, 0.5, 1.0], [0.0, 0.0, 0.4]]
    held = analysis.second_moment(runs, held=1)
    assert (held[1].variance, held[2].mean, held[2].variance) == pytest.approx((0.25, 0.8, 0.12))
    assert len(analysis.second_moment(runs)) == 2
    peak = analysis.second_moment_peak(runs * 4, held=1, resamples=50)
    assert peak.index.value == 1.0 and peak.value.value == pytest.approx(0.25 * 8 / 11)


def test_survival_by_hand() -> None:
    curve = analysis.Survival([1.0, 2.0, 3.0, 4.0], [True, False, True, True])
    # 3/4, then 1 of 2 at risk, then 0.
    assert list(curve.at([0.5, 1.0, 2.5, 3.0, 4.0])) == pytest.approx([1.0, 0.75, 0.75, 0.375, 0.0])
    assert (curve.runs, curve.observed, curve.watched) == (4, 3, 4.0)
    # 1 up to 1, 3/4 up to 3, 3/8 up to 4
    assert curve.restricted_moments(4.0).mean.value == pytest.approx(1 + 1.5 + 0.375)
    assert plot.survival(curve).get_ylabel() == "runs without a transition, $S(t)$"
    with pytest.raises(ValueError, match="unequal length: time 4, observed 3"):
        analysis.Survival([1.0, 2.0, 3.0, 4.0], [True, False, True])


@settings(max_examples=50, deadline=None)
@given(st.lists(st.tuples(st.floats(0.1, 100.0), st.booleans()), min_size=3, max_size=40))
def test_survival_never_rises(runs: list[tuple[float, bool]]) -> None:
    time, observed = (list(column) for column in zip(*runs, strict=True))
    try:
        curve = analysis.Survival(time, observed)
    except AnalysisError:
        assert not any(observed)
        return
    levels = curve.at(np.linspace(0, 101, 50))
    assert (np.diff(levels) <= 0).all() and levels[0] == 1.0 and (levels >= 0).all()


def test_order_of_the_transition() -> None:
    width = np.repeat(np.linspace(2.5, 2.9, 9), 4)
    found = analysis.hysteresis(width, width < 2.66, width, width < 2.81)
    assert found.loop_width.value == pytest.approx(0.15, abs=0.03) and found.probability < 0.01
    randomness = np.random.default_rng(2)
    one, two = randomness.normal(size=200), np.append(randomness.normal(size=100), 8 + randomness.normal(size=100))
    assert analysis.dip_test(one, resamples=200).probability > 0.05 > analysis.dip_test(two, resamples=200).probability
    peaks = analysis.two_peaks(two)
    assert peaks.upper.mean - peaks.lower.mean == pytest.approx(8.0, abs=0.5)
    jump = analysis.jump_height(([2.6, 2.7], [1.0, 0.9], [0.01, 0.01]), ([2.9], [0.2], [0.03]), 2.8)
    assert jump.height.value == pytest.approx(0.6)


def test_series() -> None:
    randomness = np.random.default_rng(3)
    noise = randomness.normal(size=4096)
    estimate = analysis.mean_with_error(noise)
    assert estimate.error == pytest.approx(1 / 64, rel=0.3) and estimate.mean == pytest.approx(noise.mean())
    assert analysis.autocorrelation_time(noise).time == pytest.approx(0.5, abs=0.2)
    found = analysis.transition_time([0.1, 0.1, 0.9, 0.9, 0.9, 0.9], period_duration=10.0)
    assert found.observed and found.time == pytest.approx(20.0)
    assert not analysis.transition_time([0.1] * 6).observed
    with pytest.raises(AnalysisError):
        analysis.mean_with_error([1.0, np.nan, 2.0, 3.0])


@given(st.floats(0.0, 0.95), st.floats(-3.0, 3.0))
def test_newtonian_flow_and_pressure_invert_each_other(ratio: float, pressure: float) -> None:
    flow = newtonian.Newtonian(ratio, pressure)
    back = newtonian.Newtonian.from_flow_rate(ratio, flow.flow_rate)
    assert back.pressure == pytest.approx(pressure, abs=1e-9 * (1 - ratio**2) ** -4)


def test_newtonian_by_hand() -> None:
    phi = 0.5
    assert newtonian.Newtonian(phi).flow_rate == pytest.approx(phi**2 * (16 - phi**2) / (2 * (2 + 3 * phi**2)))
    assert newtonian.flow_rate_ratio([[0.0, 3.0]]) == pytest.approx(np.array([[1.0, 0.0]]))
    assert newtonian.trapping_threshold() == pytest.approx(4 - 14**0.5)
    flow = newtonian.Newtonian(phi)
    axial, _, _ = newtonian.field(flow, [[0.0], [0.5]], [0.25, 0.75])
    assert axial.shape == (2, 2) and axial[0, 0] > axial[1, 0]
    with pytest.raises(ValueError, match="from 0 to 1"):
        newtonian.Newtonian(1.5)


@pytest.mark.skipif(os.name != "posix", reason="signals")
def test_ctrl_c_is_heard_during_a_search() -> None:
    randomness = np.random.default_rng(5)
    width = np.repeat(np.linspace(2.4, 2.75, 20), 40)
    time_to = randomness.gamma(3.0, 1.0 / (2.8 - width))
    collapse = analysis.Collapse(ising_like([8, 16, 32, 64]), "finite_size")
    for search in (
        lambda: collapse.fit([0.2, 0.8, 2.3], [0.1, 0.2, 0.05], starts=300, leave_one_out=True),
        lambda: analysis.fit_law_to_runs_in_windows("power", width, time_to),
    ):
        timer = threading.Timer(0.2, os.kill, (os.getpid(), signal.SIGINT))
        timer.start()
        begin = time.monotonic()
        with pytest.raises(KeyboardInterrupt):
            search()
        assert time.monotonic() - begin < 2.0


def test_masked_entries_are_refused() -> None:
    masked = np.ma.array(np.arange(32.0), mask=[index == 3 for index in range(32)])
    for call in (
        lambda: analysis.mean_with_error(masked),
        lambda: analysis.ensemble_moments([masked] * 3),
        lambda: analysis.Survival(np.arange(1.0, 33.0), masked > 2),
        lambda: analysis.Survival([1.0, 2.0, 3.0]).at(masked),
        lambda: newtonian.field(newtonian.Newtonian(0.5), masked, 0.0),
        lambda: newtonian.flow_rate_ratio(masked),
    ):
        with pytest.raises(ValueError, match="value 3 is masked"):
            call()
    assert analysis.mean_with_error(np.ma.array(np.sin(np.arange(64.0)))).mean < 1


def test_newtonian_flow_ends_at_the_wall() -> None:
    flow = newtonian.Newtonian(0.5, 0.1)
    x = np.linspace(0, 1, 100)
    for quantity in newtonian.field(flow, np.outer([0.0, 0.5, 1.0], flow.wall_radius(x)), x):
        assert np.isfinite(quantity).all()
    for quantity in newtonian.field(flow, [1.001 * flow.wall_radius(x)], x):
        assert np.isnan(quantity).all()
    assert repr(flow) == "Newtonian(amplitude_ratio=0.5, pressure=0.1)"
    assert flow.wall_radius([[0.25, 0.75]]).tolist() == [[1.5, 0.5]] and flow.wall_radius(0.25) == 1.5
    assert flow.pressure_along_wave(np.array([0, 1], dtype=np.float32)).round(6).tolist() == [0.0, 0.1]
