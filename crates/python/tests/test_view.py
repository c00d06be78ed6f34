"""The page of the viewer as a widget: traits both ways, frames, and what it says where anywidget is not installed."""

import json
import struct
import subprocess
import sys
from typing import Any

import pytest

from peristalsis import ConfigurationError, Simulation
from peristalsis._view import Widget


@pytest.fixture
def sim() -> Simulation:
    return Simulation.preset("frictionless-fine", waves=2, strain_rate=0.05, width=2.6, seed=1)


class Page:
    """The other half of a widget: what it was told, and what it says."""

    def __init__(self, view: Widget) -> None:
        self._view = view
        self.texts: list[dict[str, Any]] = []
        self.frames: list[dict[str, Any]] = []
        view.send = self._take  # type: ignore[method-assign]

    def _take(self, content: dict[str, str], buffers: list[bytes] | None = None) -> None:
        if "text" in content:
            self.texts.append(json.loads(content["text"]))
        for frame in buffers or []:
            (length,) = struct.unpack_from("<I", frame)
            self.frames.append(json.loads(frame[4 : 4 + length]))

    def says(self, message: object) -> None:
        self._view._handle_custom_msg(message, [])

    def moves(self, **traits: float | bool | None) -> None:
        """As the front end sets traits."""
        self._view.set_state(traits)


def test_a_slider_moves_the_simulation(sim: Simulation) -> None:
    page = Page(view := sim.view())
    page.moves(width=2.4)
    assert (sim.width, view.width) == (2.4, 2.4)
    page.moves(width=2.5)
    sim.run(periods=1)
    assert (sim.width, view.width) == (2.5, 2.5)
    assert page.frames[-1]["driven"]["width"] == 2.5
    # The configuration repeats the course.
    again = Simulation(sim.configuration)
    again.step(sim.steps)
    assert (again.positions == sim.positions).all()


def test_the_simulation_moves_the_sliders(sim: Simulation) -> None:
    page = Page(view := sim.view())
    seen: list[float] = []
    view.observe(lambda change: seen.append(change.new), "width")
    sim.width = 2.7
    assert (view.width, seen) == (2.7, [2.7])
    assert page.frames[-1]["aims"]["width"] == 2.7
    view.strain_rate = 0.04
    sim.run(periods=1)
    assert sim.strain_rate == pytest.approx(0.04)


def test_the_page_is_welcomed_and_sees_the_steps(sim: Simulation) -> None:
    sim.run(periods=1)
    page = Page(sim.view())
    page.says("ready")
    (welcome,) = page.texts
    assert (welcome["type"], welcome["grains"], len(welcome["rows"])) == ("welcome", 41, 20)
    assert welcome["ranges"]["friction"] is None and welcome["ranges"]["width"] is not None
    sim.run(periods=1)
    assert page.frames[-1]["step"] == sim.steps
    # Rows come once each, after those of the welcome.
    assert [row["number"] for frame in page.frames for row in frame["rows"]] == list(range(20, 40))
    page.says({"type": "contacts", "shown": True})
    assert page.frames[-1]["contacts"] > 0


def test_play_advances_the_simulation(sim: Simulation) -> None:
    page = Page(view := sim.view())
    page.says("next")
    assert (sim.steps, page.frames) == (0, []), "it goes on by itself"
    page.says({"type": "step"})
    assert sim.steps == sim._run.steps_per_sample
    page.moves(speed=None)
    page.moves(playing=True)
    before = sim.steps
    for _ in range(5):
        page.says("next")
    assert sim.steps > before and page.frames[-1]["step"] == sim.steps and page.frames[-1]["playing"]
    view.playing = False
    before = sim.steps
    page.says("next")
    assert sim.steps == before


def test_writers_get_what_the_play_button_computes(sim: Simulation, tmp_path: Any) -> None:
    writer = sim.add_writer(tmp_path / "run.lammpstrj", every="1t")
    page = Page(sim.view())
    for _ in range(3):
        page.says({"type": "step"})
    assert writer.frames == 1 + sim.steps // 20 == 4


def test_what_cannot_be_is_refused_and_the_slider_goes_back(sim: Simulation) -> None:
    view = sim.view()
    with pytest.raises(ConfigurationError, match="width"):
        view.width = 99.0
    assert view.width == 2.6
    with pytest.raises(ConfigurationError, match="force_amplitude"):
        view.force_amplitude = 1.0
    assert view.force_amplitude is None
    for speed in (-1.0, float("nan"), float("inf")):
        with pytest.raises(ValueError, match="speed is"):
            view.speed = speed
    assert view.speed == 1.0
    view.speed = None


def test_a_simulation_forgets_a_page_that_is_gone_and_copies_have_none(sim: Simulation) -> None:
    view = sim.view()
    assert len(sim._views) == 1 and len(sim.copy()._views) == 0
    view.close()
    sim.width = 2.5
    sim.run(periods=0.1)


def test_without_anywidget_the_error_says_what_to_install() -> None:
    program = (
        "import sys; sys.modules['anywidget'] = None\n"
        "import peristalsis\n"
        "sim = peristalsis.Simulation.preset('frictionless-fine', waves=2, strain_rate=0.05)\n"
        "try: sim.view()\n"
        "except ImportError as error: print(error)\n"
    )
    said = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True).stdout
    assert said == "view() needs anywidget: pip install 'peristalsis[widget]'\n"
