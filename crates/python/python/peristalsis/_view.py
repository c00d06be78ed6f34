"""The page of the viewer as a widget of a notebook."""

from __future__ import annotations

import json
import time as clock
from typing import TYPE_CHECKING, Any

import anywidget
import traitlets

from . import _core
from ._core import ConfigurationError, DivergedError
from ._drive import CHANGEABLE
from ._given import number

if TYPE_CHECKING:
    from ._simulation import Simulation

#: Seconds of computing for a frame; and, at least, from frame to frame while the interpreter computes and hears nothing.
_FRAME, _APART = 0.033, 0.1
#: Seconds that a frame may have come late and still be made up for.
_LATE = 0.15
_HTML, _STYLE, _SCRIPT, _WIDGET = _core.page()


class Widget(anywidget.AnyWidget):
    """The page of the viewer, which shows a simulation and steers it; `Simulation.view` makes one.

    Its traits, the sliders of the page and the drive of the simulation are one: whichever is changed, the others follow.
    As where ``sim.width`` is set, the wall is there with the next step.

    Parameters
    ----------
    simulation : Simulation
        What is shown.
    height : int
        Height in the notebook in pixels.

    Attributes
    ----------
    width, force_amplitude, strain_rate : float or None
        The drive, as on the sliders [d, m d t^-2, 1/t]; None where it has no such parameter.
    playing : bool
        Whether the simulation goes on by itself, while no cell runs.
    speed : float or None
        How fast, in periods per second at most; None is as fast as it can.

    Examples
    --------
    >>> import peristalsis
    >>> sim = peristalsis.Simulation.preset("frictionless-fine", waves=2, strain_rate=0.05, width=2.6, seed=1)
    >>> view = sim.view()
    >>> view.width = 2.5
    >>> sim.width
    2.5
    """

    _esm = _WIDGET
    _page = traitlets.List(traitlets.Unicode(), [_HTML, _STYLE, _SCRIPT]).tag(sync=True)
    height = traitlets.Int(680).tag(sync=True)
    width = traitlets.Float(None, allow_none=True).tag(sync=True)
    force_amplitude = traitlets.Float(None, allow_none=True).tag(sync=True)
    strain_rate = traitlets.Float(None, allow_none=True).tag(sync=True)
    playing = traitlets.Bool(False).tag(sync=True)
    speed = traitlets.Float(1.0, allow_none=True).tag(sync=True)

    def __init__(self, simulation: Simulation, height: int = 680) -> None:
        self._simulation = simulation
        self._onlooker = _core.Onlooker()
        #: Whether traits are being set to what the simulation does, rather than by somebody.
        self._telling = True
        self._shown = self._went = 0.0
        #: Steps left over from earlier frames, and seconds of a step.
        self._due, self._step_seconds = 0.0, 0.0
        #: Steps of a period of the drive's own strain rate; a static wave has no period, and its time is counted in t.
        configuration = simulation.configuration
        self._steps_per_period = 1.0 / (configuration["drive.strain_rate"] or 1.0) / configuration.time_step
        super().__init__(height=height, **self._driven())
        self._telling = False
        self.on_msg(self._hear)
        simulation._views.add(self)

    def _driven(self) -> dict[str, float | None]:
        return {name: self._simulation._run.driven(name) for name in CHANGEABLE}

    @traitlets.validate("speed")
    def _possible(self, proposal: Any) -> float | None:
        if proposal.value is None:
            return None
        speed = number("speed", proposal.value)
        if speed < 0:
            raise ValueError(f"speed is 0 or more, not {speed:g}")
        return speed

    @traitlets.observe(*CHANGEABLE)
    def _steer(self, change: Any) -> None:
        if self._telling:
            return
        try:
            setattr(self._simulation, change.name, change.new)
        except BaseException:
            # The slider goes back to where the simulation is.
            self._show()
            raise

    @traitlets.observe("playing", "speed")
    def _play(self, change: Any) -> None:
        self._went, self._due = clock.monotonic(), 0.0
        self._show()

    def _hear(self, _: object, message: Any, buffers: object) -> None:
        """A message of the page that is no trait; what the page cannot ask of a simulation changes nothing."""
        kind = message.get("type") if isinstance(message, dict) else message
        if kind == "ready":
            self.send({"text": self._onlooker.welcome(self._simulation._run, "simulation")})
        elif kind == "next" and not self.playing:
            return
        elif kind == "next":
            self._go_on()
        elif kind == "step":
            self.playing = False
            each = self._simulation._run.steps_per_sample
            self._advance(each - self._simulation.steps % each)
        elif kind == "contacts":
            self._onlooker.show_contacts(bool(message["shown"]))
        self._show()

    def _go_on(self) -> None:
        """Advances by what is due since the last frame, as far as it can be computed in time."""
        now = clock.monotonic()
        passed, self._went = min(now - self._went, _LATE), now
        most = max(1, int(_FRAME / self._step_seconds)) if self._step_seconds else 1
        steps = most
        if self.speed is not None:
            self._due += self.speed * passed * self._steps_per_period
            steps = min(most, int(self._due))
            self._due = min(self._due - steps, most)
        if steps:
            self._advance(steps)
            self._step_seconds = (clock.monotonic() - now) / steps

    def _advance(self, steps: int) -> None:
        simulation = self._simulation
        if simulation._running.locked():
            # Another thread runs it, and frames come from there.
            return
        try:
            simulation._step(steps)
        except (DivergedError, ConfigurationError) as error:
            self.playing = False
            self.send({"text": json.dumps({"type": "problem", "message": str(error)})})

    def _seen(self) -> None:
        """The simulation has gone on: a frame, where the last one is old enough."""
        if clock.monotonic() - self._shown >= _APART:
            self._show()

    def _show(self) -> None:
        self._shown = clock.monotonic()
        run = self._simulation._run
        self.send({}, buffers=[self._onlooker.frame(run, self.playing, self.speed)])
        self._telling = True
        try:
            for name, value in self._driven().items():
                self.set_trait(name, value)
        finally:
            self._telling = False
