"""Axes that hold what was asked for."""

from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import pytest
from matplotlib.axes import Axes

from peristalsis import Simulation, _core, _fit, _title, plot


def test_every_picture_of_a_run(small: Simulation, tmp_path: Path) -> None:
    small.run(periods=5)
    flow = plot.flow(small)
    assert len(flow.lines[1].get_xdata()) == 5
    assert np.mean(flow.lines[1].get_ydata()) == pytest.approx(small.timeseries()["flow_rate_ratio"].mean())
    snapshot = plot.snapshot(small)
    assert snapshot.get_xlim() == (0.0, small.length)
    with pytest.raises(TypeError, match="waves is a whole number, not 'a'"):
        plot.snapshot(small, waves="a")  # type: ignore[arg-type]
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


def test_a_wall_without_spheres_is_drawn() -> None:
    smooth = Simulation.preset("frictionless", waves=2, width=2.6, overrides={"tube.arrangement": "smooth"})
    axes = plot.snapshot(smooth)
    wall = [np.abs(line.get_ydata()) for line in axes.lines]
    assert [round(float(2 * radius.min()), 3) for radius in wall] == [2.6, 2.6]
    plt.close(axes.figure)


@pytest.mark.parametrize(
    ("preset", "settings", "title"),
    [
        ("frictionless", {}, r"$w$ = 2.75 $d$,  $\dot{ε}$ = 0.05 ($k$/$m$)$^{\mathrm{1/2}}$,  $ρ$ = 0.152,  $N$ = 41"),
        (
            "sand-pump",
            {"initial_state": "jammed", "body_force": 0.0005},
            r"$w$ = 5 $d$,  $\dot{ε}$ = 0.000962 ($k$/$m$)$^{\mathrm{1/2}}$,  $ρ$ = 0.150,  $N$ = 1122,  start: jammed,  "
            r"$μ_{\mathrm{s}}$ = 0.5,  $g$ = (0, −0.000181, −0.0005) $kd$/$m$",
        ),
        (
            "frictional",
            {"static_friction": 0.4},
            r"$f^{\mathrm{P}}$ = 0.004 $Yd^{\mathrm{2}}$,  $\dot{ε}$ = 0.00401 $t^{\mathrm{{*}{−}1}}$,  $n$ = 0.710,  $N$ = 1093,  "
            r"start: jammed,  $μ_{\mathrm{s}}$ = 0.4",
        ),
        (
            "frictionless",
            {"waveform": "bolus", "direction": "backward", "arrangement": "smooth", "gravity": [0, 0, -0.002], "body_force": 5e-4},
            r"$w$ = 2.75 $d$,  $\dot{ε}$ = 0.05 ($k$/$m$)$^{\mathrm{1/2}}$,  $ρ$ = 0.152,  $N$ = 41,  wave: bolus,  "
            "direction: backward,  wall: smooth,  $g$ = −0.0015 $kd$/$m$",
        ),
    ],
)
def test_a_title_has_the_units_and_the_settings_of_the_command_line(preset: str, settings: dict[str, object], title: str) -> None:
    assert _title.title(Simulation.preset(preset, seed=1, waves=2, **settings)) == title


def test_a_title_has_what_was_driven_and_breaks_between_its_parts() -> None:
    small = Simulation.preset("frictionless", width=2.6, strain_rate=0.1, seed=1, waves=2, waveform="bolus", static_friction=0.3)
    small.run(periods=1)
    small.width = 2.8
    small.strain_rate = 0.05
    small.run(periods=1)
    small.width = 2.7
    axes = plot.flow(small)
    first, second = axes.get_title().split("\n")
    assert first.startswith(r"$w$ = 2.6 to 2.8 $d$,  $\dot{ε}$ = 0.1 to 0.05 ($k$/$m$)$^{\mathrm{1/2}}$,") and not first.endswith(",")
    assert second == r"wave: bolus,  $μ_{\mathrm{s}}$ = 0.3"
    assert plot.profile(small, "wall_pressure").get_ylabel() == r"pressure on the wall, $p\,d/k$"


def stationary(label: str, ax: Axes | None) -> Axes:
    width = np.linspace(2.3, 2.9, 7)
    return plot.stationary_flow(width, 1 / (1 + np.exp((width - 2.6) * 25)), np.full(7, 0.02), ax, label=label)


def test_curves_of_one_colour_differ_in_their_marks(small: Simulation) -> None:
    small.run(periods=1)
    for draw in (stationary, lambda label, ax: plot.flow(small, ax, label=label)):
        axes = None
        for number in range(12):
            axes = draw(f"run {number}", axes)
        handles, labels = axes.get_legend_handles_labels()
        runs = [handle for handle, label in zip(handles, labels, strict=True) if label.startswith("run")]
        lines = [getattr(run, "lines", [run])[0] for run in runs]
        assert len({(line.get_color(), line.get_marker()) for line in lines}) == 12


@pytest.mark.parametrize(("number", "length"), [(9, 5), (2, 50), (1, 60), (2, 200)])
def test_what_is_around_the_axes_fits_the_figure(small: Simulation, number: int, length: int) -> None:
    small.run(periods=1)
    for draw in (stationary, lambda label, ax: plot.flow(small, ax, label=label)):
        axes = None
        for place in range(number):
            axes = draw(f"run {place} ".ljust(length, "x"), axes)
        figure = axes.figure
        figure.draw_without_rendering()
        for text in (axes.xaxis.label, axes.yaxis.label, *axes.get_legend().get_texts()):
            extent = text.get_window_extent()
            assert extent.x0 >= 0 and extent.y0 >= 0 and extent.x1 <= figure.bbox.x1 and extent.y1 <= figure.bbox.y1
        assert axes.bbox.width > 0.75 * figure.bbox.width and axes.bbox.height > 30 / 25.4 * figure.dpi
        assert not _fit._hides(axes, axes.get_legend())


def test_points_that_there_are_not_are_asked_for() -> None:
    for width, ratio in (([], []), ([2.6], [np.nan])):
        with pytest.raises(ValueError, match="there are no points to draw: give the width"):
            plot.stationary_flow(width, ratio)
    with pytest.raises(ValueError, match="2 widths, but 1 ratios"):
        plot.stationary_flow([2.5, 2.6], [0.4])
    assert not plt.get_fignums()


@pytest.mark.parametrize(
    ("value", "error", "text"),
    [(0.9, 0.012, "0.900 ± 0.012"), (0.9, 0.03, "0.90 ± 0.03"), (1234.0, 56.0, "1230 ± 60"), (-0.01, 0.3, "0.0 ± 0.3")],
)
def test_a_value_with_its_error_has_the_digits_of_the_command_line(value: float, error: float, text: str) -> None:
    assert _core.with_error(value, error) == text
