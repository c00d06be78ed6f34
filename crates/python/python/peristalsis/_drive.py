"""Parameters of the drive, which may change during a run."""

from __future__ import annotations

from ._given import number
from ._state import State


class Drive(State):
    """Parameters of the drive, which may change during a run; `Simulation` is the public class."""

    __slots__ = ()

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
        self._run.drive_to("width", number("width", value), 0.0)

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
        self._run.drive_to("force_amplitude", number("force_amplitude", value), 0.0)

    @property
    def strain_rate(self) -> float:
        """c/lambda [1/t]. Samples keep their distance in time when it changes, and `configuration` counts its periods
        (``run.periods``, ``drive.schedule``) in those of the first rate; `period` counts wavelengths.

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
        self._run.drive_to("strain_rate", number("strain_rate", value), 0.0)
