"""Parameters of the drive, which may change during a run."""

from __future__ import annotations

from typing import Protocol
from weakref import WeakSet

from ._given import number
from ._state import State

#: Parameters of the drive, which may change during a run: words, symbol and unit.
PARAMETERS = {
    "width": ("width of the bottleneck", "w", "d"),
    "force_amplitude": ("force amplitude", r"f^{\mathrm{P}}", "m d/t^2"),
    "strain_rate": ("strain rate", r"\dot{\varepsilon}", "1/t"),
}
CHANGEABLE = tuple(PARAMETERS)


class View(Protocol):
    """A widget of a notebook that shows a simulation and steers it, as its user sees it; `Simulation.view` makes one."""

    #: The drive, as on the sliders [d, m d t^-2, 1/t]; None where it has no such parameter.
    width: float | None
    force_amplitude: float | None
    strain_rate: float | None
    #: Whether the simulation goes on by itself, while no cell runs.
    playing: bool
    #: How fast, in periods a second at most; None is as fast as it can.
    speed: float | None

    def _show(self) -> None: ...

    def _seen(self) -> None: ...


class Drive(State):
    """Parameters of the drive, which may change during a run; `Simulation` is the public class."""

    __slots__ = ("_views",)

    #: Widgets that show it.
    _views: WeakSet[View]

    def _lead(self, name: str, value: float) -> None:
        self._run.drive_to(name, number(name, value), 0.0)
        for view in tuple(self._views):
            view._show()

    def _drive(self, name: str) -> float:
        value = self._run.driven(name)
        if value is None:
            other = "force_amplitude" if name == "width" else "width"
            raise AttributeError(f"drive.{name} is no parameter of this drive, whose drive.control has {other}")
        return value

    @property
    def width(self) -> float:
        """w = 2 (a - b) [d], the bottleneck between centres of wall spheres; strain control.

        Examples
        --------
        >>> import peristalsis
        >>> sim = peristalsis.Simulation.preset("frictionless-fine", waves=2, strain_rate=0.05, seed=1)
        >>> sim.width = 2.7
        >>> sim.width
        2.7
        """
        return self._drive("width")

    @width.setter
    def width(self, value: float) -> None:
        self._lead("width", value)

    @property
    def force_amplitude(self) -> float:
        """f^P [m d t^-2], the amplitude of the force on a wall sphere; stress control.

        Examples
        --------
        >>> import peristalsis
        >>> sim = peristalsis.Simulation.preset("frictional", waves=2)
        >>> sim.force_amplitude == sim.configuration["drive.force_amplitude"]
        True
        """
        return self._drive("force_amplitude")

    @force_amplitude.setter
    def force_amplitude(self, value: float) -> None:
        self._lead("force_amplitude", value)

    @property
    def strain_rate(self) -> float:
        """c/lambda [1/t], under a schedule that of the middle of the next step. Samples keep their distance in time when it
        changes, and `configuration` counts its periods (``run.periods``, ``drive.schedule``) in those of the first rate;
        `period` counts wavelengths.

        Examples
        --------
        >>> import peristalsis
        >>> sim = peristalsis.Simulation.preset("frictionless-fine", waves=2, strain_rate=0.05, seed=1)
        >>> sim.strain_rate
        0.05
        """
        return self._drive("strain_rate")

    @strain_rate.setter
    def strain_rate(self, value: float) -> None:
        self._lead("strain_rate", value)
