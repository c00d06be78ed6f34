"""Figures as strangers met them."""

from __future__ import annotations

import warnings
from collections.abc import Iterator
from pathlib import Path

import matplotlib
import matplotlib.pyplot as plt
import numpy as np
import pytest
from matplotlib.font_manager import FontProperties, findfont
from matplotlib.image import imread

from peristalsis import Simulation, _style, analysis, plot

nbformat = pytest.importorskip("nbformat")
nbclient = pytest.importorskip("nbclient")

#: One cell a figure: ours, the reader's own, ours into the reader's axes, ours again.
CELLS = (
    """\
import matplotlib, matplotlib.pyplot as plt
from peristalsis import Simulation, analysis, plot
sim = Simulation.preset("frictionless", width=2.6, strain_rate=0.1, seed=1, waves=2)
sim.run(periods=2)
plot.flow(sim);""",
    "plt.plot([1, 2], [3, 4]);",
    "plot.snapshot(sim);",
    "figure, ax = plt.subplots()\nplot.profile(sim, ax=ax);",
    "assert matplotlib.is_interactive()\nplot.profile(sim);",
    "plt.ioff()\nplot.flow(sim)\nplt.show()",
)


@pytest.fixture(autouse=True)
def nothing_is_left_open() -> Iterator[None]:
    yield
    plt.close("all")


@pytest.fixture
def run(small: Simulation) -> Simulation:
    small.run(periods=5)
    return small


@pytest.mark.filterwarnings("ignore")
def test_every_figure_of_a_notebook_is_shown() -> None:
    notebook = nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell(text) for text in CELLS])
    nbclient.NotebookClient(notebook, timeout=120).execute()
    pictures = [sum("image/png" in output.get("data", {}) for output in cell.outputs) for cell in notebook.cells]
    assert pictures == [1] * len(CELLS)


def test_settings_outside_stay_as_they_are(run: Simulation) -> None:
    before = dict(matplotlib.rcParams)
    plot.flow(run)
    plot.snapshot(run)
    assert dict(matplotlib.rcParams) == before


def test_a_saved_figure_has_the_dots_per_inch_of_the_style(run: Simulation, tmp_path: Path) -> None:
    plot.flow(run).figure.savefig(tmp_path / "flow.png")
    assert imread(tmp_path / "flow.png").shape[1] == int(86 / 25.4 * 300)


def test_the_font_is_that_of_the_command_line(run: Simulation, tmp_path: Path) -> None:
    assert "Arimo" in findfont(FontProperties(family=plot.STYLE["font.family"][:1]), fallback_to_default=False)
    plot.flow(run).figure.savefig(tmp_path / "flow.svg")
    text = (tmp_path / "flow.svg").read_text()
    assert "Arimo" in text and "DejaVu Sans'" not in text.replace("'Arimo', 'DejaVu Sans'", "")


def test_a_package_without_its_fonts_says_so(tmp_path: Path) -> None:
    with pytest.warns(RuntimeWarning, match="Arimo-Regular-subset.ttf.*install it anew"):
        assert not _style._add_fonts(tmp_path)
    assert _style._add_fonts(_style._FONTS) and _style._HAS_FONT


def test_symbols_are_italic(run: Simulation) -> None:
    assert plot.flow(run).get_xlabel() == "time, $t/T$"
    assert plot.profile(run, "axial_velocity").get_ylabel() == "axial velocity, $v_z/c$"
    assert plot.profile(run, "granular_temperature").get_ylabel().endswith(r"$T_{\mathrm{g}}/(m\,c^2)$")


def test_the_newtonian_fluid_stands_once_in_a_legend(run: Simulation) -> None:
    wider = Simulation.preset("frictionless", width=2.9, strain_rate=0.1, waves=2)
    wider.run(periods=2)
    both = plot.flow(wider, plot.flow(run, label="narrow"), label="wide")
    points = plot.stationary_flow([2.4, 2.6], [0.9, 0.4], label="one")
    plot.stationary_flow([2.8, 2.9], [0.1, 0.0], ax=points, label="other")
    for axes, names in ((both, {"narrow", "wide"}), (points, {"one", "other"})):
        legend = axes.get_legend()
        assert legend is not None
        texts = [text.get_text() for text in legend.get_texts()]
        assert texts.count("Newtonian fluid") == 1 and names <= set(texts)
        assert len(texts) == len(set(texts))


def test_a_long_tube_is_shown_in_parts_that_can_be_read() -> None:
    sim = Simulation.preset("frictionless", seed=1)
    axes = plot.snapshot(sim)
    assert axes.get_xlim() == (0.0, 40.0) and "4 of 10 waves" in axes.get_xlabel()
    assert plot.snapshot(sim, waves=5, first=5).get_xlim() == (50.0, 100.0)
    with pytest.raises(ValueError, match="first is 9 or less, not 10"):
        plot.snapshot(sim, first=10)


def test_a_snapshot_has_the_wall_and_counts_grains_that_escaped() -> None:
    sim = Simulation.preset("frictionless", width=2.6, strain_rate=0.1, seed=1)
    assert "escaped" not in plot.snapshot(sim).get_title()
    sim.run(periods=40)
    escaped = sim.summary()["escaped"]
    assert escaped > 0
    axes = plot.snapshot(sim)
    assert f"{escaped} of 203 grains escaped" in axes.get_title()
    upper, lower = (line.get_ydata() for line in axes.lines[:2])
    assert np.allclose(upper, -np.asarray(lower))
    assert np.min(upper) == pytest.approx(1.3, abs=0.02) and np.max(upper) == pytest.approx(1.7, abs=0.02)


def test_nothing_measured_is_said(small: Simulation) -> None:
    with pytest.raises(ValueError, match="run the simulation first"):
        plot.flow(small)


class Loop:
    """A ramp as `Simulation.ramp` returns it."""

    parameter = "width"
    law = "linear"

    def table(self) -> dict[str, object]:
        width = np.linspace(2.4, 3.0, 5)
        return {
            "branch": ["there"] * 5 + ["back"] * 5,
            "value": np.r_[width, width[::-1]],
            "flow_rate_ratio": np.r_[0.9, 0.85, 0.8, 0.75, 0.1, 0.1, 0.1, 0.2, 0.3, 0.9],
            "flow_rate_ratio_error": np.full(10, 0.02),
        }


def test_a_loop_is_drawn_with_both_ways_and_their_errors() -> None:
    """Wanted: plot.hysteresis."""
    axes = plot.hysteresis(Loop(), radius=1.5)
    assert axes.get_xlabel() == "width of the bottleneck, $w/d$"
    pressed = Loop()
    pressed.parameter = "force_amplitude"
    assert plot.hysteresis(pressed).get_xlabel().endswith("/[kd]$")
    pressed.law = "hertz"
    assert plot.hysteresis(pressed).get_xlabel().endswith("/[Yd^2]$")
    legend = axes.get_legend()
    assert legend is not None
    assert {text.get_text() for text in legend.get_texts()} == {"there, upwards", "back, downwards", "Newtonian fluid"}


def test_survival_curves_of_different_lengths_are_all_shown() -> None:
    axes = plot.survival(analysis.Survival([100.0, 200.0]), label="short")
    plot.survival(analysis.Survival([100.0, 800.0]), axes, label="long")
    assert axes.get_xlim() == pytest.approx((0.0, 1.03 * 800.0))


def test_a_ramp_is_drawn_as_it_is() -> None:
    """Wanted: sim.ramp, plot.hysteresis."""
    sim = Simulation.preset("frictionless-fine", width=2.9, strain_rate=0.05, waves=2, seed=1)
    axes = plot.hysteresis(sim.ramp("width", 2.9, 2.5, periods=12, levels=3))
    assert {text.get_text() for text in axes.legend_.get_texts()} == {"there, downwards", "back, upwards"}


def test_a_rate_that_changed_and_a_part_of_a_period_are_drawn_by_one_clock() -> None:
    sim = Simulation.preset("frictionless-fine", width=2.7, strain_rate=0.02, waves=2, seed=1)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        sim.run(periods=0.6)
        assert [line.get_label() for line in plot.flow(sim).lines if len(line.get_xdata()) == 0] == ["_child1"]
        sim.run(periods=4.4)
        sim.strain_rate = 0.05
        sim.run(periods=10)
    axes = plot.flow(sim)
    means, late = axes.lines[1], axes.lines[-2]
    assert axes.get_xlim() == (0.0, 9.0) and means.get_xdata().tolist() == pytest.approx(np.arange(9) + 0.5)
    assert sim.summary()["late_periods"] == pytest.approx(np.ptp(late.get_xdata())) and late.get_xdata()[1] == pytest.approx(9.0)


def test_spheres_of_an_elastic_wall_are_drawn_in_their_size() -> None:
    sim = Simulation.preset("frictional", waves=2, seed=1, sphere_diameter=0.4)
    wall = plot.snapshot(sim).collections[0]
    assert wall.get_widths()[0] == 0.4  # type: ignore[attr-defined]
