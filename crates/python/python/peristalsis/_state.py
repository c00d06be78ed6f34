"""What can be read off a simulation."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from . import _core
from ._arrays import Array
from ._core import Configuration, Table
from ._given import numbers
from ._warnings import KeyedWarning

if TYPE_CHECKING:
    from ._types import Summary

#: Places a wave at which `State.wall_radius` answers where none are named.
_PLACES = 64


class State:
    """What can be read off a simulation; `Simulation` is the public class."""

    __slots__ = ("_run",)

    _run: _core.Run

    @property
    def configuration(self) -> Configuration:
        """Every resolved value, changes of the drive included.

        Examples
        --------
        >>> import peristalsis
        >>> sim = peristalsis.Simulation.preset("frictionless-fine", waves=2, strain_rate=0.05, seed=1)
        >>> sim.configuration["drive.strain_rate"]
        0.05
        """
        return self._run.configuration

    @property
    def positions(self) -> Array:
        """Centres of the grains [d], shape (N, 3), z in [0, L).

        As all arrays of a simulation: a copy of this instant, which later steps do not touch and which outlives the
        simulation. It cannot be written to, for that would not move a grain; ``.copy()`` gives one that can.

        Examples
        --------
        >>> import peristalsis
        >>> sim = peristalsis.Simulation.preset("frictionless-fine", waves=2, strain_rate=0.05, seed=1)
        >>> sim.positions.shape
        (41, 3)
        """
        return self._run.positions

    @property
    def velocities(self) -> Array:
        """Velocities of the grains [d/t], shape (N, 3); a copy, as `positions`.

        Examples
        --------
        >>> import peristalsis
        >>> sim = peristalsis.Simulation.preset("frictionless-fine", waves=2, strain_rate=0.05, seed=1)
        >>> sim.velocities.shape
        (41, 3)
        """
        return self._run.velocities

    @property
    def angular_velocities(self) -> Array:
        """Angular velocities of the grains [1/t], shape (N, 3), 0 without friction; a copy, as `positions`.

        Examples
        --------
        >>> import peristalsis
        >>> sim = peristalsis.Simulation.preset("frictionless-fine", waves=2, strain_rate=0.05, seed=1)
        >>> float(abs(sim.angular_velocities).max())
        0.0
        """
        return self._run.angular_velocities

    @property
    def diameters(self) -> Array:
        """Diameters of the grains [d], shape (N,); a copy, as `positions`.

        Examples
        --------
        >>> import peristalsis
        >>> sim = peristalsis.Simulation.preset("frictionless-fine", waves=2, strain_rate=0.05, seed=1)
        >>> float(sim.diameters.mean())
        1.0
        """
        return self._run.diameters

    @property
    def turns(self) -> npt.NDArray[np.int32]:
        """How often each grain went round the tube towards +z, shape (N,): z + turns L is unfolded.

        Examples
        --------
        >>> import peristalsis
        >>> sim = peristalsis.Simulation.preset("frictionless-fine", waves=2, strain_rate=0.05, seed=1)
        >>> int(sim.turns.sum())
        0
        """
        return self._run.turns

    @property
    def wall_positions(self) -> Array:
        """Centres of the wall's spheres [d], shape (M, 3); a copy, as `positions`.

        Examples
        --------
        >>> import peristalsis
        >>> sim = peristalsis.Simulation.preset("frictionless-fine", waves=2, strain_rate=0.05, seed=1)
        >>> sim.wall_positions.shape
        (1248, 3)
        """
        return self._run.wall_positions

    @property
    def steps(self) -> int:
        """Steps done since the start.

        Examples
        --------
        >>> import peristalsis
        >>> sim = peristalsis.Simulation.preset("frictionless-fine", waves=2, strain_rate=0.05, seed=1)
        >>> sim.run(periods=1)
        >>> sim.steps
        400
        """
        return self._run.steps

    @property
    def time(self) -> float:
        """Time since the start [t].

        Examples
        --------
        >>> import peristalsis
        >>> sim = peristalsis.Simulation.preset("frictionless-fine", waves=2, strain_rate=0.05, seed=1)
        >>> sim.run(periods=1)
        >>> round(sim.time, 9)
        20.0
        """
        return self._run.time

    @property
    def period(self) -> float:
        """Wavelengths that the wave has run since the start.

        Examples
        --------
        >>> import peristalsis
        >>> sim = peristalsis.Simulation.preset("frictionless-fine", waves=2, strain_rate=0.05, seed=1)
        >>> sim.run(periods=1)
        >>> round(sim.period, 9)
        1.0
        """
        return self._run.period

    @property
    def length(self) -> float:
        """L [d], length of the tube over which J is taken: waves times lambda, of an open tube less, between its ends.

        Examples
        --------
        >>> import peristalsis
        >>> sim = peristalsis.Simulation.preset("frictionless-fine", waves=2, strain_rate=0.05, seed=1)
        >>> sim.length
        20.0
        """
        return self._run.length

    @property
    def heading(self) -> float:
        """+1 where the wave runs towards +z, -1 where towards -z.

        Examples
        --------
        >>> import peristalsis
        >>> sim = peristalsis.Simulation.preset("frictionless-fine", waves=2, strain_rate=0.05, seed=1)
        >>> sim.heading
        -1.0
        """
        return self._run.heading

    @property
    def flow_rate_ratio(self) -> float:
        """J/Jmax over the last whole period, or of the last sample before there is one; NaN before that.

        Examples
        --------
        >>> import peristalsis
        >>> sim = peristalsis.Simulation.preset("frictionless-fine", waves=2, strain_rate=0.05, seed=1)
        >>> sim.run(periods=1)
        >>> bool(sim.flow_rate_ratio < 0.5)
        True
        """
        return self._run.flow_rate_ratio

    @property
    def transition_time(self) -> float | None:
        """tau [t], where the flow has changed its kind.

        Examples
        --------
        >>> import peristalsis
        >>> sim = peristalsis.Simulation.preset("frictionless-fine", waves=2, strain_rate=0.05, seed=1)
        >>> sim.run(periods=1)
        >>> sim.transition_time is None
        True
        """
        return self._run.transition_time

    @property
    def energy_ledger(self) -> dict[str, float]:
        """The energy now, the work done and the energy lost since the start [m d^2/t^2].

        energy = initial_energy + wall_work + drive_work + keep_work + body_work + exchanged - normal_dissipated -
        tangential_dissipated - sliding_dissipated - rolling_dissipated - cohesion_dissipated - drag_dissipated -
        network_dissipated - history_reset, up to the part `energy_residual` of the energy that entered. `exchanged` is the
        energy that grains brought into an open tube, less what others took out. `gross_work` is what went in and out, each
        piece of work by its size; `largest_overlap` is a length [d].

        Examples
        --------
        >>> import peristalsis
        >>> sim = peristalsis.Simulation.preset("frictionless-fine", waves=2, strain_rate=0.05, seed=1)
        >>> sim.energy_ledger["initial_energy"] >= 0
        True
        """
        return self._run.energy_ledger

    # Contacts, forces and stress

    def contacts(self) -> Table:
        """The contacts of the grains as they stand, one a row.

        Returns
        -------
        Table
            ``i`` is a grain, numbered from 0 as in `positions`. Its partner ``j`` is a grain above i or, where ``wall`` is
            true, a sphere of the wall: j - N is its row in `wall_positions`. A smooth wall has no spheres; there j - N is 0
            on the nearer side of the axis and 1 on the other, or, where a side is touched more than once, 2 and 3, 4 and 5
            and so on in the order of z. ``overlap`` [d]; ``normal_force``, positive
            where it repels, and ``tangential_force``, a size [m d/t^2]; ``force_x``, ``_y``, ``_z``, the whole force on
            grain i, that on j being its opposite; ``tangential_x``, ``_y``, ``_z``, its part in the plane of contact;
            ``x``, ``y``, ``z``, where they touch, on the line of centres [d]; ``sliding``, whether friction slides.

        Notes
        -----
        Forces are those at the present positions and velocities. Their sum over the contacts of a grain, with the body force, is `forces`.

        Examples
        --------
        >>> import peristalsis
        >>> sim = peristalsis.Simulation.preset("frictionless-fine", waves=2, seed=1)
        >>> sim.run(periods=1)
        >>> contacts = sim.contacts()
        >>> bool((contacts["overlap"] > 0).all())
        True
        >>> bool((contacts["i"] < contacts["j"]).all())
        True
        """
        return _core.contacts(self._run)

    @property
    def forces(self) -> Array:
        """Force on each grain [m d/t^2], shape (N, 3): the sum over its `contacts`, and the body force where there is one;
        0 of a grain that waits outside an open tube.

        In the frame of the tube, at the present positions and velocities; the force of the last step differs from it by
        what the integrator has corrected of the velocities since. A copy, as `positions`.

        Examples
        --------
        >>> import peristalsis
        >>> sim = peristalsis.Simulation.preset("frictionless-fine", waves=2, seed=1)
        >>> sim.run(periods=1)
        >>> sim.forces.shape == sim.positions.shape
        True
        """
        return _core.load(self._run)[0]

    @property
    def torques(self) -> Array:
        """Torque of the contacts on each grain [m d^2/t^2], shape (N, 3), 0 without friction; a copy, as `positions`.

        Examples
        --------
        >>> import peristalsis
        >>> sim = peristalsis.Simulation.preset("frictionless-fine", waves=2)
        >>> float(abs(sim.torques).max())
        0.0
        """
        return _core.load(self._run)[1]

    @property
    def stress_tensor(self) -> Array:
        """Mean stress of the grains [m/(d t^2)], shape (3, 3), positive in compression.

        sigma[a, b] = (sum over contacts of l_a f_b + sum over grains of m dv_a dv_b) / V

        l is the branch vector, from the partner's centre to the grain's or, of a contact with the wall, from where they
        touch to the grain's centre; f is the force on the grain, dv its velocity less that of the centre of mass, and V the
        `volume` that the wall leaves clear. Grains that wait outside an open tube do not count. A third of the trace is the
        pressure. In a straight tube at rest (sigma[0, 0] + sigma[1, 1])/2 is the pressure on the area 2 pi (R - d_w/2) L of
        the clear bore. ``wall_pressure`` of `profile` and `summary` is that on the area 2 pi R L through the centres of the
        wall's spheres, smaller by the factor 1 - d_w/(2 R).

        ``granular_temperature`` of `timeseries` is about the mean of the velocities, which differs from that of the centre
        of mass where sizes differ.

        Examples
        --------
        >>> import numpy as np
        >>> import peristalsis
        >>> sim = peristalsis.Simulation.preset("frictionless-fine", waves=2, seed=1)
        >>> sim.run(periods=1)
        >>> bool(np.trace(sim.stress_tensor) > 0)
        True
        """
        return _core.load(self._run)[2]

    @property
    def volume(self) -> float:
        """Volume that the wall's spheres leave clear [d^3]: the integral of pi (R - d_w/2)^2 over the tube's length,
        between the ends of an open one.

        Examples
        --------
        >>> import peristalsis
        >>> straight = peristalsis.Simulation.preset("frictionless", waves=2, width=3.0)
        >>> round(straight.volume / straight.length, 6)         # pi (1.5 - 0.5)^2
        3.141593
        """
        return _core.volume(self._run)

    def wall_radius(self, z: npt.ArrayLike | None = None) -> Array:
        """Radius of the tube, to the centres of the wall's spheres [d].

        Parameters
        ----------
        z : array_like, optional
            Places along the tube [d], taken round it where they lie beyond its ends; by default 64 a wave, evenly from 0:
            ``np.arange(64 * waves) * wavelength / 64``.

        Returns
        -------
        ndarray
            R(z), of the shape of `z`; of an elastic wall the mean over a slice as thick as a ring.

        Examples
        --------
        >>> import peristalsis
        >>> sim = peristalsis.Simulation.preset("frictionless", waves=2, width=2.6)
        >>> radius = sim.wall_radius()
        >>> radius.shape, round(2 * float(radius.min()), 6)
        ((128,), 2.6)
        """
        if z is None:
            number = _PLACES * self._run.configuration.waves
            z = np.arange(number) * (self._run.configuration.length / number)
        places = numbers("z", z)
        if not np.isfinite(places).all():
            raise ValueError("z is a place along the tube: a finite number")
        return _core.wall_radius(self._run, places.ravel()).reshape(places.shape)

    # Doubts

    @property
    def warnings(self) -> tuple[KeyedWarning, ...]:
        """What looks doubtful: about the configuration, and of what was seen so far, such as leaks and large overlaps.

        Each has a ``key``, the one to change, and a ``message``. The same list stands in ``summary.json`` and is printed by
        ``peristalsis check``. `PeristalsisWarning` is raised by Python's `warnings` for each of them once, when the
        simulation is made and after the run that has seen it.

        Examples
        --------
        >>> import peristalsis
        >>> peristalsis.Simulation.preset("frictionless-fine", waves=2, strain_rate=0.05).warnings
        ()
        """
        return tuple(KeyedWarning(*warning) for warning in self._run.warnings())

    @property
    def escaped(self) -> int:
        """Grains outside the tube now: their centre is farther from the axis than R + d/2.

        Examples
        --------
        >>> import peristalsis
        >>> peristalsis.Simulation.preset("frictionless-fine", waves=2).escaped
        0
        """
        return self._run.escaped

    @property
    def largest_overlap(self) -> float:
        """Largest overlap of a grain's contact at any step so far [d].

        Examples
        --------
        >>> import peristalsis
        >>> peristalsis.Simulation.preset("frictionless-fine", waves=2).largest_overlap
        0.0
        """
        return self._run.largest_overlap

    # Tables

    def timeseries(self) -> Table:
        """What was measured so far, one row per sample.

        ``t["flow_rate_ratio"]`` is a column as an array; `Table.to_pandas`, `Table.to_polars` and `Table.to_xarray` are
        frames with units, and ``pyarrow.table(t)`` takes it without a copy.

        Returns
        -------
        Table
            `Table.units` and `Table.descriptions` say what each column is.

        Examples
        --------
        >>> import peristalsis
        >>> sim = peristalsis.Simulation.preset("frictionless-fine", waves=2, strain_rate=0.05, seed=1)
        >>> sim.run(periods=1)
        >>> sim.timeseries()["period"].shape
        (20,)
        """
        return self._run.timeseries()

    def profile(self) -> Table:
        """Profile in the wave frame over the late part of what was measured, one row per bin: over whole periods, at least one.

        Returns
        -------
        Table
            ``position`` in the wave, and there density, velocity, temperature, radius of the tube, and forces and pressure on the
            wall, with their errors.

        Examples
        --------
        >>> import peristalsis
        >>> sim = peristalsis.Simulation.preset("frictionless-fine", waves=2, strain_rate=0.05, seed=1)
        >>> sim.run(periods=1)
        >>> "wall_pressure" in sim.profile()
        True
        """
        return self._run.profile()

    def waves(self) -> Table:
        """Flow of each wave over each whole period.

        Returns
        -------
        Table
            One row per wave and period.

        Examples
        --------
        >>> import peristalsis
        >>> sim = peristalsis.Simulation.preset("frictionless-fine", waves=2, strain_rate=0.05, seed=1)
        >>> sim.run(periods=1)
        >>> len(sim.waves())
        2
        """
        return self._run.waves()

    def summary(self) -> Summary:
        """The outcome so far, as ``summary.json`` of the command line has it.

        Where that has null a number is NaN if it is not known yet, and `None` if there is none in this run, or none so far:
        no transition, no friction, an open tube.

        Returns
        -------
        Summary
            A dictionary. ``status`` is ``"running"`` until the configured end, then ``"complete"``, or ``"diverged"`` with
            the reason as ``message``.

        Examples
        --------
        >>> import peristalsis
        >>> sim = peristalsis.Simulation.preset("frictionless-fine", waves=2, strain_rate=0.05, seed=1)
        >>> sim.run(periods=1)
        >>> sim.summary()["status"]
        'running'
        """
        return self._run.summary()
