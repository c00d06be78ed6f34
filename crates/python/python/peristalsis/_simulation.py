"""The simulation of one tube."""

from __future__ import annotations

import html
import os
import sys
import threading
import time as clock
from collections.abc import Callable, Mapping
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from . import _core
from ._core import Configuration, ConfigurationError, Table
from ._keywords import overrides as joined

if TYPE_CHECKING:
    from typing_extensions import Unpack

    from ._types import Keywords, Summary, _Preset

#: Seconds from one look of the interpreter at a running simulation to the next: how long Ctrl-C may take.
_PATIENCE = 0.05

_CHANGEABLE = ("width", "force_amplitude", "strain_rate")

Array = npt.NDArray[np.float64]
Callback = Callable[["Simulation"], object]


class Simulation:
    """Grains in a peristaltic tube, advanced in time.

    Made by `preset`, `from_toml`, `from_file`, `from_configuration`, or from a snapshot. Keyword arguments name keys of
    the configuration by their last word (``width`` is ``drive.width``), or whole with ``_`` for the dots
    (``initial_state`` is ``initial.state``); `overrides` is a dictionary of dotted keys. The same configuration and seed
    give the same bits as the command line ``peristalsis run``.

    A simulation may be read by other threads while one runs it: they see whole steps.

    Attributes
    ----------
    width, force_amplitude, strain_rate : float
        Parameters of the drive. Setting one between two calls of `run` changes it from the next step on, and adds the
        change to the configuration's schedule, so that `configuration` always says how to repeat the run from its start.
        A ramp of w is a loop::

            for width in np.linspace(2.9, 2.5, 9):
                sim.width = width
                sim.run(periods=20)

    Examples
    --------
    >>> sim = Simulation.preset("frictionless", width=2.6, strain_rate=0.1, seed=1, waves=2)
    >>> sim.run(periods=2)
    >>> sim.positions.shape
    (41, 3)
    """

    __slots__ = ("_run", "_running", "__weakref__")

    def __init__(self, configuration: Configuration) -> None:
        self._begin(_core.Run(configuration))

    def _begin(self, run: _core.Run) -> None:
        self._run = run
        self._running = threading.Lock()

    @classmethod
    def _of(cls, run: _core.Run) -> Simulation:
        simulation = cls.__new__(cls)
        simulation._begin(run)
        return simulation

    @classmethod
    def preset(
        cls, name: _Preset | str, overrides: Mapping[str, Any] | None = None, **keywords: Unpack[Keywords]
    ) -> Simulation:
        """A preset with some of its values replaced.

        Parameters
        ----------
        name : str
            One of `peristalsis.presets()`.
        overrides : mapping, optional
            Values of dotted keys, such as ``{"contact.static_friction": 0.5}``.
        **keywords
            Values of keys by their last word.

        Raises
        ------
        ConfigurationError
            Where a key or value cannot be: in the words of the command line.
        DoesNotFitError
            Where the tube does not hold the grains.
        """
        return cls(Configuration(preset=name, overrides=joined(overrides, keywords)))

    @classmethod
    def from_toml(
        cls, text: str, overrides: Mapping[str, Any] | None = None, **keywords: Unpack[Keywords]
    ) -> Simulation:
        """A configuration in TOML, as in a file of the command line."""
        return cls(Configuration(text=text, overrides=joined(overrides, keywords)))

    @classmethod
    def from_file(
        cls,
        path: str | os.PathLike[str],
        overrides: Mapping[str, Any] | None = None,
        **keywords: Unpack[Keywords],
    ) -> Simulation:
        """A configuration file, or the ``config.toml`` that a run left."""
        text = Path(path).read_text(encoding="utf-8")
        settings = joined(overrides, keywords)
        return cls(Configuration(text=text, name=os.fspath(path), overrides=settings))

    @classmethod
    def from_configuration(cls, configuration: Configuration) -> Simulation:
        """A configuration that has been resolved."""
        return cls(configuration)

    # Advancing

    def run(
        self,
        periods: float | None = None,
        *,
        duration: float | None = None,
        progress: bool = False,
        callback: Callback | None = None,
        every: int | None = None,
        threads: int | None = None,
    ) -> None:
        """Advance by so many periods of the wave; without a length, to the end that the configuration names.

        The interpreter is free meanwhile: other threads go on, and Ctrl-C stops between two steps, with everything that
        was computed kept; `run` goes on from there with the same bits.

        Parameters
        ----------
        periods : float, optional
            Periods of the wave as it is driven now, T = 1/strain_rate.
        duration : float, optional
            Time [t] instead of periods.
        progress : bool
            Show how far it is, on standard error.
        callback : callable, optional
            Called with this simulation every `every` steps. It may read everything and change the drive; it cannot
            advance. What it raises ends the run.
        every : int, optional
            Steps from one call to the next; by default those from sample to sample.
        threads : int, optional
            Threads of the engine from now on; they change no bit.

        Raises
        ------
        DivergedError
            Where a grain moves too far in one step; the state is that of the step that failed.
        """
        self.step(self._steps_of(periods, duration), progress=progress, callback=callback, every=every, threads=threads)

    def _steps_of(self, periods: float | None, duration: float | None) -> int:
        configuration = self._run.configuration
        if periods is not None and duration is not None:
            raise TypeError("run takes periods or duration, not both")
        if periods is not None:
            if not self.strain_rate:
                raise ConfigurationError("a static wave has no period: give run a duration")
            duration = periods / self.strain_rate
        if duration is None:
            return max(0, configuration.steps - self.steps)
        if not 0 <= duration < float("inf"):
            raise ValueError("a simulation advances by a time from 0 on")
        return round(duration / configuration.time_step)

    def step(
        self,
        steps: int = 1,
        *,
        progress: bool = False,
        callback: Callback | None = None,
        every: int | None = None,
        threads: int | None = None,
    ) -> None:
        """Advance by so many steps; the rest is as in `run`."""
        steps = int(steps)
        if steps < 0:
            raise ValueError("a simulation cannot go back: steps is 0 or more")
        if every is not None and every < 1:
            raise ValueError("every is 1 or more steps")
        if not self._running.acquire(blocking=False):
            raise RuntimeError("this simulation is running already")
        try:
            if threads is not None:
                self._run.compute_with(int(threads))
            with _Progress(self, steps, progress) as display:
                self._advance(steps, callback, every or self._run.steps_per_sample, display)
        finally:
            self._running.release()

    def _advance(
        self, steps: int, callback: Callback | None, every: int, display: _Progress
    ) -> None:
        left, due = steps, every
        while left > 0:
            done = self._run.advance(left if callback is None else min(left, due), _PATIENCE)
            left, due = left - done, due - done
            if callback is not None and due == 0:
                callback(self)
                due = every
            display.update(steps - left)

    # The drive

    def _drive(self, name: str) -> float:
        value = self._run.driven(name)
        if value is None:
            raise AttributeError(f"drive.{name} is no parameter of this drive")
        return value

    @property
    def width(self) -> float:
        """w = 2 (a - b) [d], the bottleneck between centres of wall spheres; strain control."""
        return self._drive("width")

    @width.setter
    def width(self, value: float) -> None:
        self._run.drive_to("width", float(value), 0.0)

    @property
    def force_amplitude(self) -> float:
        """f^P [m d t^-2], the amplitude of the force on a wall sphere; stress control."""
        return self._drive("force_amplitude")

    @force_amplitude.setter
    def force_amplitude(self, value: float) -> None:
        self._run.drive_to("force_amplitude", float(value), 0.0)

    @property
    def strain_rate(self) -> float:
        """c/lambda [1/t]. Samples keep their distance in time when it changes."""
        return self._drive("strain_rate")

    @strain_rate.setter
    def strain_rate(self, value: float) -> None:
        self._run.drive_to("strain_rate", float(value), 0.0)

    # The state

    @property
    def configuration(self) -> Configuration:
        """Every resolved value, changes of the drive included."""
        return self._run.configuration

    @property
    def positions(self) -> Array:
        """Centres of the grains [d], shape (N, 3), z in [0, L).

        As all arrays of a simulation: a copy of this instant, which later steps do not touch and which outlives the
        simulation. It cannot be written to, for that would not move a grain; ``.copy()`` gives one that can.
        """
        return self._run.positions

    @property
    def velocities(self) -> Array:
        """Velocities of the grains [d/t], shape (N, 3); a copy, as `positions`."""
        return self._run.velocities

    @property
    def angular_velocities(self) -> Array:
        """Angular velocities of the grains [1/t], shape (N, 3), 0 without friction; a copy, as `positions`."""
        return self._run.angular_velocities

    @property
    def diameters(self) -> Array:
        """Diameters of the grains [d], shape (N,); a copy, as `positions`."""
        return self._run.diameters

    @property
    def turns(self) -> npt.NDArray[np.int32]:
        """How often each grain went round the tube towards +z, shape (N,): z + turns L is unfolded."""
        return self._run.turns

    @property
    def wall_positions(self) -> Array:
        """Centres of the wall's spheres [d], shape (M, 3); a copy, as `positions`."""
        return self._run.wall_positions

    @property
    def steps(self) -> int:
        """Steps done since the start."""
        return self._run.steps

    @property
    def time(self) -> float:
        """Time since the start [t]."""
        return self._run.time

    @property
    def period(self) -> float:
        """Wavelengths that the wave has run since the start."""
        return self._run.period

    @property
    def length(self) -> float:
        """L [d], length of the tube."""
        return self._run.configuration.length

    @property
    def heading(self) -> float:
        """+1 where the wave runs towards +z, -1 where towards -z."""
        return self._run.heading

    @property
    def flow_rate_ratio(self) -> float:
        """J/Jmax over the last whole period, or of the last sample before there is one; NaN before that."""
        return self._run.flow_rate_ratio

    @property
    def transition_time(self) -> float | None:
        """tau [t], where the flow has changed its kind."""
        return self._run.transition_time

    @property
    def energy_ledger(self) -> dict[str, float]:
        """Where energy is, where it came from and where it went since the start [m d^2/t^2].

        energy = initial_energy + wall_work + drive_work + keep_work + body_work - normal_dissipated -
        tangential_dissipated - sliding_dissipated - drag_dissipated - network_dissipated - history_reset, up to
        `energy_residual` of what entered.
        """
        return self._run.energy_ledger

    def timeseries(self) -> Table:
        """What was measured so far, one row a sample.

        ``t["flow_rate_ratio"]`` is a column as an array; `Table.to_pandas`, `Table.to_polars` and `Table.to_xarray` are
        frames with units, and ``pyarrow.table(t)`` takes it without a copy.
        """
        return self._run.timeseries()

    def profile(self) -> Table:
        """Profile in the wave's frame over the late part of what was measured, one row a bin."""
        return self._run.profile()

    def waves(self) -> Table:
        """Flow of each wave over each whole period."""
        return self._run.waves()

    def summary(self) -> Summary:
        """The outcome so far, as ``summary.json`` of the command line has it."""
        return self._run.summary()

    # Snapshots

    def to_bytes(self) -> bytes:
        """A snapshot: configuration, state and what was measured; `from_bytes` goes on with the same bits."""
        return self._run.to_bytes()

    @classmethod
    def from_bytes(cls, snapshot: bytes) -> Simulation:
        """Go on from a snapshot.

        Raises
        ------
        SnapshotError
            Where it is damaged, or no snapshot of this version.
        """
        return cls._of(_core.Run.from_bytes(bytes(snapshot)))

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write a snapshot to a file, whole or not at all."""
        path = Path(path)
        unfinished = path.with_name(f"{path.name}.{os.getpid()}-{threading.get_ident()}.tmp")
        try:
            with unfinished.open("wb") as file:
                file.write(self.to_bytes())
                file.flush()
                os.fsync(file.fileno())
            unfinished.replace(path)
        finally:
            unfinished.unlink(missing_ok=True)

    @classmethod
    def load(cls, path: str | os.PathLike[str]) -> Simulation:
        """Go on from a file that `save` wrote."""
        return cls.from_bytes(Path(path).read_bytes())

    def copy(self) -> Simulation:
        """A simulation that goes on by itself from here."""
        return type(self)._of(self._run.copy())

    def __copy__(self) -> Simulation:
        return self.copy()

    def __deepcopy__(self, memo: dict[int, Any]) -> Simulation:
        return self.copy()

    def __reduce__(self) -> tuple[Callable[[bytes], Simulation], tuple[bytes]]:
        return type(self).from_bytes, (self.to_bytes(),)

    # In words

    def _facts(self) -> dict[str, str]:
        configuration = self.configuration
        drive = [
            f"{name} {value:g}"
            for name in _CHANGEABLE
            if (value := self._run.driven(name)) is not None
        ]
        transition = self.transition_time
        return {
            "grains": f"{configuration.grains} in {configuration.waves} waves, volume fraction {configuration.volume_fraction:.3g}",
            "drive": ", ".join(drive),
            "time": f"{self.time:.6g} ({self.period:.4g} periods, {self.steps} steps)",
            "J/Jmax": f"{self.flow_rate_ratio:.4g}",
            "transition": "none yet" if transition is None else f"at {transition:.5g}",
            "seed": str(configuration.seed),
        }

    def __repr__(self) -> str:
        facts = "; ".join(f"{name} {fact}" for name, fact in self._facts().items())
        return f"<peristalsis.Simulation: {facts}>"

    def _repr_html_(self) -> str:
        rows = "".join(
            f"<tr><th style='text-align:left'>{html.escape(name)}</th>"
            f"<td style='text-align:left'>{html.escape(fact)}</td></tr>"
            for name, fact in self._facts().items()
        )
        return f"<table><caption>peristalsis.Simulation</caption>{rows}</table>"


class _Progress:
    """One line on standard error, or nothing."""

    def __init__(self, simulation: Simulation, steps: int, shown: bool) -> None:
        self._simulation = simulation
        self._steps = steps
        self._shown = shown
        self._begin = self._last = clock.monotonic()

    def __enter__(self) -> _Progress:
        return self

    def update(self, done: int) -> None:
        now = clock.monotonic()
        if not self._shown or now - self._last < 0.2 and done < self._steps:
            return
        self._last = now
        left = (now - self._begin) * (self._steps - done) / max(done, 1)
        print(
            f"\r{done / max(self._steps, 1):4.0%}  period {self._simulation.period:.1f}  "
            f"J/Jmax {self._simulation.flow_rate_ratio:.3f}  {left:.0f} s left   ",
            end="",
            file=sys.stderr,
            flush=True,
        )

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        if self._shown:
            print(file=sys.stderr)
