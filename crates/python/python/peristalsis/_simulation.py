"""The simulation of one tube."""

from __future__ import annotations

import os
import threading
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from . import _core
from ._core import Configuration, ConfigurationError
from ._keywords import overrides as joined
from ._loop import Loop, ramp
from ._output import Output
from ._progress import Progress, Shown
from ._warnings import kind, tell
from ._writers import Trigger, Writer, triggers, whole

if TYPE_CHECKING:
    from typing_extensions import Unpack

    from ._loop import _Parameter
    from ._types import Keywords, _Preset
    from ._writers import _Callbacks

#: Seconds from one look of the interpreter at a running simulation to the next: how long Ctrl-C may take.
_PATIENCE = 0.05



class Simulation(Output):
    """Grains in a peristaltic tube, advanced in time.

    Made by `preset`, `from_toml`, `from_file`, `from_configuration`, `from_positions`, or from a snapshot. Keyword arguments name keys of
    the configuration by their last word (``width`` is ``drive.width``), or whole with ``_`` for the dots
    (``initial_state`` is ``initial.state``); `overrides` is a dictionary of dotted keys. The same configuration and seed
    give the same bits as the command line ``peristalsis run``.

    A simulation may be read by other threads while one runs it: they see whole steps. It can be copied and pickled, but
    for its writers.

    Attributes
    ----------
    width, force_amplitude, strain_rate : float
        Parameters of the drive. Setting one between two calls of `run` changes it from the next step on, and adds the
        change to the configuration's schedule, so that `configuration` always says how to repeat the run from its start.
        `ramp` leads one there and back.

    Examples
    --------
    >>> from peristalsis import Simulation
    >>> sim = Simulation.preset("frictionless-fine", width=2.6, strain_rate=0.05, seed=1, waves=2)
    >>> sim.run(periods=2)
    >>> sim.positions.shape
    (41, 3)
    """

    __slots__ = ("_running", "_told", "__weakref__")

    def __init__(self, configuration: Configuration) -> None:
        self._begin(_core.Run(configuration))
        tell(self.warnings, self._told)

    def _begin(self, run: _core.Run) -> None:
        self._run = run
        self._running = threading.Lock()
        self._told: set[str] = set()
        self._writers: list[Writer] = []

    @classmethod
    def _of(cls, run: _core.Run) -> Simulation:
        simulation = cls.__new__(cls)
        simulation._begin(run)
        return simulation

    @classmethod
    def _going_on(cls, run: _core.Run) -> Simulation:
        """Of which nothing is told that the one that it goes on from has told."""
        simulation = cls._of(run)
        simulation._told.update(map(kind, simulation.warnings))
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

        Examples
        --------
        >>> import peristalsis
        >>> sim = peristalsis.Simulation.preset("frictionless-fine", waves=2, strain_rate=0.05)
        >>> sim.length
        20.0
        """
        return cls(Configuration(preset=name, overrides=joined(overrides, keywords)))

    @classmethod
    def from_toml(
        cls, text: str, overrides: Mapping[str, Any] | None = None, **keywords: Unpack[Keywords]
    ) -> Simulation:
        """A configuration in TOML, as in a file of the command line.

        Examples
        --------
        >>> import peristalsis
        >>> text = "preset = 'frictionless-fine'\\n[drive]\\nstrain_rate = 0.05"
        >>> peristalsis.Simulation.from_toml(text, waves=2).strain_rate
        0.05
        """
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
        """A configuration that has been resolved.

        Examples
        --------
        >>> import peristalsis
        >>> tube = peristalsis.Configuration("frictionless-fine", waves=2, strain_rate=0.05)
        >>> peristalsis.Simulation.from_configuration(tube).steps
        0
        """
        return cls(configuration)

    @classmethod
    def from_positions(
        cls,
        configuration: Configuration,
        positions: npt.ArrayLike,
        velocities: npt.ArrayLike | None = None,
        diameters: npt.ArrayLike | None = None,
    ) -> Simulation:
        """Grains put where the caller wants them, in this order.

        Parameters
        ----------
        configuration : Configuration
            All else. Its number of grains and their least and largest diameter become those of the arrays.
        positions : array_like
            Centres [d], shape (N, 3), the axis of the tube along z; z is taken into [0, L).
        velocities : array_like, optional
            Velocities in the frame of the tube [d/t], shape (N, 3); at rest by default.
        diameters : array_like, optional
            Diameters [d], shape (N,), or one for all; that of the configuration by default.

        Raises
        ------
        ConfigurationError
            For a grain outside the tube, two grains or a grain and the wall that overlap by more than half a diameter,
            and arrays of other shapes.

        Notes
        -----
        No file can repeat such a run from its start: `configuration` says ``initial.state = "placed"``, which only a
        snapshot goes on from.

        Examples
        --------
        >>> from peristalsis import Configuration, Simulation
        >>> tube = Configuration("frictionless-fine", waves=2, strain_rate=0.05)
        >>> sim = Simulation.from_positions(tube, [[0, 0, 5.0], [0, 0, 5.9]])
        >>> contacts = sim.contacts()
        >>> contacts["i"].tolist(), contacts["j"].tolist(), contacts["overlap"].round(6).tolist()
        ([0], [1], [0.1])
        """
        places = np.array(positions, dtype=float)
        speeds = np.zeros_like(places) if velocities is None else np.array(velocities, dtype=float)
        if places.ndim != 2 or places.shape[1] != 3 or speeds.shape != places.shape:
            raise ConfigurationError(
                f"positions and velocities are arrays of shape (N, 3), not {places.shape} and {speeds.shape}"
            )
        least, most = configuration["grains.diameter_min"], configuration["grains.diameter_max"]
        if diameters is None and least != most:
            raise ConfigurationError(f"grains of diameters from {least} to {most}: give diameters, one for each grain")
        sizes = np.asarray(least if diameters is None else diameters, dtype=float)
        if sizes.shape not in ((), (len(places),)):
            raise ConfigurationError(f"diameters is one number, or an array of shape ({len(places)},), not {sizes.shape}")
        sizes = np.array(np.broadcast_to(sizes, len(places)))
        keys: dict[str, Any] = {"grains.number": len(places), "initial.state": "placed"}
        if len(sizes):
            keys |= {"grains.diameter_min": float(sizes.min()), "grains.diameter_max": float(sizes.max())}
        simulation = cls._of(_core.Run.placed(configuration.replace(keys), places, speeds, sizes))
        tell(simulation.warnings, simulation._told)
        return simulation

    # Advancing

    def run(
        self,
        periods: float | None = None,
        *,
        duration: float | None = None,
        progress: Shown = False,
        callback: _Callbacks | None = None,
        every: int | None = None,
        writers: Iterable[Writer] = (),
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
        progress : bool or "logging"
            Show how far it is: by tqdm where that is installed, otherwise on standard error; or tell the logger
            ``peristalsis`` every ten seconds.
        callback : callable, or iterable of callables and (callable, every) pairs, optional
            Called with this simulation every `every` steps, in this order. It may read everything and change the drive;
            it cannot advance. What it raises ends the run.
        every : int, optional
            Steps from one call to the next; by default those from sample to sample.
        writers : iterable of Writer, optional
            Files that get frames during this run; those of `add_writer` get theirs as well.
        threads : int, optional
            Threads of the engine from now on; they change no bit.

        Raises
        ------
        DivergedError
            Where a grain moves too far in one step; the state is that of the step that failed.
        ConfigurationError
            For a length shorter than half a step.

        Examples
        --------
        >>> import peristalsis
        >>> sim = peristalsis.Simulation.preset("frictionless-fine", waves=2, strain_rate=0.05, seed=1)
        >>> seen = []
        >>> sim.run(periods=2, callback=[lambda sim: seen.append(sim.period)])
        >>> len(seen)
        40
        """
        steps = self._steps_of(periods, duration)
        self.step(steps, progress=progress, callback=callback, every=every, writers=writers, threads=threads)

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
        steps = round(duration / configuration.time_step)
        if duration > 0 and steps == 0:
            raise ConfigurationError(
                f"a run of {duration:.4g} t is shorter than half a step of {configuration.time_step:.4g} t\n"
                "  help: take a shorter run.time_step, or a longer run"
            )
        return steps

    def step(
        self,
        steps: int = 1,
        *,
        progress: Shown = False,
        callback: _Callbacks | None = None,
        every: int | None = None,
        writers: Iterable[Writer] = (),
        threads: int | None = None,
    ) -> None:
        """Advance by so many steps; the rest is as in `run`.

        Examples
        --------
        >>> import peristalsis
        >>> sim = peristalsis.Simulation.preset("frictionless", waves=2, strain_rate=0.03)
        >>> sim.step(3)
        >>> sim.steps
        3
        """
        steps = whole("steps", steps, 0)
        each = self._run.steps_per_sample if every is None else whole("every", every, 1)
        if not self._running.acquire(blocking=False):
            raise RuntimeError("this simulation is running already")
        try:
            if threads is not None:
                self._run.compute_with(int(threads))
            files = list(dict.fromkeys([*self._writers, *writers]))
            called: list[Trigger | Writer] = [*triggers(callback, each, self.steps), *files]
            for writer in files:
                writer._begin(self)
            with Progress(self, steps, progress) as display:
                try:
                    self._advance(steps, called, display)
                finally:
                    for writer in files:
                        writer._synchronize()
        finally:
            self._running.release()
        tell(self.warnings, self._told)

    def _advance(self, steps: int, called: list[Trigger | Writer], display: Progress) -> None:
        first = now = self.steps
        while now < first + steps:
            coming = [(it, due) for it in called if (due := it._due) is not None]
            end = min([first + steps, *(due for _, due in coming)])
            now += self._run.advance(end - now, _PATIENCE)
            for it, due in coming:
                if due == now:
                    it._fire(self)
            display.update(now - first)

    def ramp(
        self,
        parameter: _Parameter,
        start: float,
        stop: float,
        periods: float,
        *,
        levels: int = 13,
        back: bool = True,
        settle: float = 0.5,
        threshold: float = 0.5,
        progress: Shown = False,
    ) -> Loop:
        """Lead a parameter of the drive from one value to another level by level, and back, and measure J/Jmax at each.

        Parameters
        ----------
        parameter : {"width", "force_amplitude", "strain_rate"}
            What is led.
        start, stop : float
            First and last level, in the unit of the parameter; it jumps to `start` at once.
        periods : float
            Periods of one way, shared equally by its levels; of the wave as it is driven at each. At least two a level.
        levels : int
            Values from `start` to `stop`, both included, evenly spaced.
        back : bool
            Whether it is led back over the same levels.
        settle : float
            Part of each level, from 0 to below 1, that is not measured.
        threshold : float
            J/Jmax whose crossing counts as a transition.
        progress : bool or "logging"
            As in `run`, level by level.

        Returns
        -------
        Loop
            Both branches with standard errors, their `Loop.table` and `Loop.thresholds`; `peristalsis.plot.hysteresis`
            draws it.

        Notes
        -----
        `configuration` has the whole course, so that it repeats the ramp. Where the flow changes its kind by chance, the
        place of the jump depends on how fast the ramp is and on the seed: ramp several replicas.

        Examples
        --------
        >>> import peristalsis
        >>> sim = peristalsis.Simulation.preset("frictionless-fine", waves=2, strain_rate=0.05, seed=1)
        >>> loop = sim.ramp("width", 2.4, 2.8, periods=4, levels=2, back=False)
        >>> loop.flow_rate_ratio.shape, loop.thresholds.back
        ((2,), None)
        """
        if parameter not in ("width", "force_amplitude", "strain_rate"):
            raise ConfigurationError(f"{parameter} cannot be led; width, force_amplitude and strain_rate can")
        self._drive(parameter)
        levels = whole("levels", levels, 1)
        if not 0 <= settle < 1:
            raise ValueError(f"settle = {settle} is no part of a level: from 0 to below 1")
        if not periods >= 2 * levels:
            raise ValueError(f"{periods} periods are fewer than two for each of {levels} levels")
        values = np.linspace(start, stop, levels)
        if not np.isfinite(values).all() or (parameter == "strain_rate" and not (values > 0).all()):
            raise ValueError(f"{parameter} cannot be led from {start} to {stop}")
        return ramp(self, parameter, values, periods / levels, settle, threshold, back, progress)

    # Snapshots

    def to_bytes(self) -> bytes:
        """A snapshot: configuration, state and what was measured; `from_bytes` goes on with the same bits.

        Examples
        --------
        >>> import peristalsis
        >>> sim = peristalsis.Simulation.preset("frictionless-fine", waves=2, strain_rate=0.05, seed=1)
        >>> again = peristalsis.Simulation.from_bytes(sim.to_bytes())
        >>> bool((sim.positions == again.positions).all())
        True
        """
        return self._run.to_bytes()

    @classmethod
    def from_bytes(cls, snapshot: bytes) -> Simulation:
        """Go on from a snapshot.

        Raises
        ------
        SnapshotError
            Where it is damaged, or no snapshot of this version.

        Examples
        --------
        >>> import peristalsis
        >>> sim = peristalsis.Simulation.preset("frictionless-fine", waves=2, strain_rate=0.05, seed=1)
        >>> peristalsis.Simulation.from_bytes(sim.to_bytes()).steps
        0
        """
        return cls._going_on(_core.Run.from_bytes(bytes(snapshot)))

    @classmethod
    def load(cls, path: str | os.PathLike[str]) -> Simulation:
        """Go on from what `save` or the command line left, with the same bits.

        Parameters
        ----------
        path : path
            A file of `save`, the ``state.checkpoint`` of a run, or the folder of a run.

        Raises
        ------
        FileNotFoundError
            Where there is no such file.
        SnapshotError
            Where it is damaged, or no snapshot of this version.

        Examples
        --------
        >>> import tempfile
        >>> from pathlib import Path
        >>> import peristalsis
        >>> sim = peristalsis.Simulation.preset("frictionless", waves=2, strain_rate=0.03)
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     sim.save(Path(folder) / "now.checkpoint")
        ...     again = peristalsis.Simulation.load(Path(folder) / "now.checkpoint")
        >>> bool((sim.positions == again.positions).all())
        True
        """
        simulation = cls._of(_core.Run.open(Path(path)))
        tell(simulation.warnings, simulation._told)
        return simulation

    def copy(self) -> Simulation:
        """A simulation that goes on by itself from here.

        Examples
        --------
        >>> import peristalsis
        >>> sim = peristalsis.Simulation.preset("frictionless-fine", waves=2, strain_rate=0.05, seed=1)
        >>> other = sim.copy()
        >>> other.step(3)
        >>> sim.steps, other.steps
        (0, 3)
        """
        return type(self)._going_on(self._run.copy())

    def __copy__(self) -> Simulation:
        return self.copy()

    def __deepcopy__(self, memo: dict[int, Any]) -> Simulation:
        return self.copy()

    def __reduce__(self) -> tuple[Callable[[bytes], Simulation], tuple[bytes]]:
        return type(self).from_bytes, (self.to_bytes(),)
