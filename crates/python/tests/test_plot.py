"""Axes that hold what was asked for."""

from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import pytest

from peristalsis import Simulation, plot


def test_every_picture_of_a_run(small: Simulation, tmp_path: Path) -> None:
    small.run(periods=5)
    flow = plot.flow(small)
    assert len(flow.lines[1].get_xdata()) == 5
    assert np.mean(flow.lines[1].get_ydata()) == pytest.approx(small.timeseries()["flow_rate_ratio"].mean())
    snapshot = plot.snapshot(small)
    assert snapshot.get_xlim() == (0.0, small.length)
    profile = plot.profile(small, "axial_velocity")
    assert profile.get_ylabel() == "axial velocity, $v_z/c$"
    points = plot.stationary_flow([2.4, 2.6], [0.9, 0.4], [0.01, 0.02])
    assert points.get_legend() is not None
    for number, axes in enumerate((flow, snapshot, profile, points)):
        path = tmp_path / f"{number}.png"
        axes.figure.savefig(path)
        assert path.stat().st_size > 5000
        plt.close(axes.figure)


def test_into_axes_that_there_are(small: Simulation) -> None:
    small.run(periods=1)
    own = plot.axes()
    assert plot.flow(small, own) is own
    plt.close(own.figure)


@pytest.fixture(autouse=True)
def nothing_is_left_open() -> object:
    yield
    plt.close("all")


def test_an_open_tube_with_a_wave_that_stands_is_drawn_as_it_is() -> None:
    silo = Simulation.preset("silo", seed=1)
    silo.run(duration=20)
    axes = plot.snapshot(silo)
    assert "t$ = 20.0" in axes.get_title() and "escaped" not in axes.get_title()
    plt.close(axes.figure)
