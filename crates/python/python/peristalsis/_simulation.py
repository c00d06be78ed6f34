"""The simulation of one tube."""

from __future__ import annotations

import html
import warnings
from collections.abc import Iterable
from typing import TYPE_CHECKING

import numpy as np

from ._core import ConfigurationError
from ._drive import CHANGEABLE
from ._given import number, positive, whole
from ._loop import Loop, ramp
from ._made import Made
from ._progress import Progress, Shown
from ._tables import facts_to_html
from ._warnings import PeristalsisWarning, Telling, outside
from ._writers import Trigger, Writer, held, listed, triggers

if TYPE_CHECKING:
    from ._loop import _Parameter
    from ._writers import _Callbacks

#: Seconds from one look of the interpreter at a running simulation to the next: how long Ctrl-C may take.
_PATIENCE = 0.05
#: Steps that a run has at most.
_MOST_STEPS = 1e12


class Simulation(Made):
    """Grains in a peristaltic tube, advanced in time.

    Made of a configuration, by `preset`, `from_toml`, `from_file`, `from_positions`, or from a snapshot by `load` and
    `from_bytes`. Keyword arguments name keys of the configuration by their last word (``width`` is ``drive.width``), or
    whole with ``_`` for the dots (``initial_state`` is ``initial.state``); `overrides` is a dictionary of dotted keys. The
    same configuration and seed give the same bits as the command line ``peristalsis run``.

    A simulation may be read by other threads while one runs it: they see whole steps. It can be copied and pickled, but
    for its writers, which each simulation needs of its own.

    Parameters
    ----------
    configuration : Configuration
        What to run.

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

    __slots__ = ()

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
        """Advance until the wave has run so many wavelengths; without a length, to the end that the configuration names.

        The interpreter is free meanwhile: other threads go on, and Ctrl-C stops between two steps, with everything that
        was computed kept; `run` goes on from there with the same bits.

        Parameters
        ----------
        periods : float, optional
            Wavelengths that the wave is to run, as `period` counts them, also where a schedule changes its speed. Each takes
            T = 1/strain_rate where that is constant.
        duration : float, optional
            Time [t] instead of periods; both are rounded to the nearest step.
        progress : bool or "logging"
            Show how far it is: by tqdm where that is installed, otherwise on standard error; or tell the logger
            ``peristalsis`` every ten seconds.
        callback : callable, or iterable of callables and (callable, every) pairs, optional
            Called with this simulation where the steps since its start are a multiple of `every`, in this order. It may
            read everything and change the drive; it cannot advance. What it raises ends the run.
        every : int, optional
            Steps from one call to the next; by default those from sample to sample.
        writers : iterable of Writer, optional
            Files that get frames during this run; those of `add_writer` get theirs as well.
        threads : int, optional
            Threads of the engine, 1024 at most; as many as pay for the number of moving spheres unless given. They change no
            bit.

        Raises
        ------
        DivergedError
            Where a grain moves too far in one step; the state is the state after that step, and the simulation goes no
            further.
        ConfigurationError
            For a length shorter than half a step, or of more steps than any run can have; for periods that the wave, as it
            is scheduled, never runs.
        ValueError
            For a length that is not above 0.

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
            duration = self._run.time_of_periods(positive("periods", periods))
            if duration is None:
                raise ConfigurationError(f"the wave stands still before it has run {periods:g} periods: give run a duration")
        if duration is None:
            if self.steps >= configuration.steps:
                told = "the run is complete, and nothing was done: give run periods or duration to go on"
                warnings.warn(told, PeristalsisWarning, stacklevel=outside())
            return max(0, configuration.steps - self.steps)
        length = positive("duration", duration) / configuration.time_step
        if length > _MOST_STEPS:
            raise ConfigurationError(f"a run of {length:.3g} steps is beyond reach: at most {_MOST_STEPS:.0e}")
        steps = round(length)
        if steps == 0:
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

        Parameters
        ----------
        steps : int
            Steps, from 0 to 10^12.
        progress, callback, every, writers, threads
            As of `run`.

        Raises
        ------
        DivergedError
            As of `run`.

        Examples
        --------
        >>> import peristalsis
        >>> sim = peristalsis.Simulation.preset("frictionless", waves=2, strain_rate=0.03)
        >>> sim.step(3)
        >>> sim.steps
        3
        """
        with Telling(self):
            self._step(steps, progress, callback, every, writers, threads)

    def _step(
        self,
        steps: int,
        progress: Shown = False,
        callback: _Callbacks | None = None,
        every: int | None = None,
        writers: Iterable[Writer] = (),
        threads: int | None = None,
    ) -> None:
        """As `step`, but tells no doubts."""
        steps = whole("steps", steps, 0, int(_MOST_STEPS))
        each = self._run.steps_per_sample if every is None else whole("every", every, 1)
        if not self._running.acquire(blocking=False):
            raise RuntimeError("this simulation is running already")
        try:
            self._run.compute_with(None if threads is None else whole("threads", threads, 1, 1024))
            files = list(dict.fromkeys([*self._writers, *listed(writers)]))
            called: list[Trigger | Writer] = [*triggers(callback, each, self.steps), *files]
            with held(files):
                for writer in files:
                    writer._begin(self)
                with Progress(self, steps, progress) as display:
                    try:
                        self._advance(steps, called, display)
                    finally:
                        for writer in files:
                            writer._synchronize()
                        for view in tuple(self._views):
                            view._show()
        finally:
            self._running.release()

    def _advance(self, steps: int, called: list[Trigger | Writer], display: Progress) -> None:
        first = now = self.steps
        while now < first + steps:
            coming = [(it, due) for it in called if (due := it._due) is not None]
            end = min([first + steps, *(due for _, due in coming)])
            try:
                self._run.advance(end - now, _PATIENCE)
            finally:
                # Ctrl-C may come just after the steps: what is due then is done all the same.
                now = self.steps
                for it, due in coming if self._run.divergence is None else []:
                    if due == now:
                        it._fire(self)
            display.update(now - first)
            for view in tuple(self._views):
                view._seen()

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
        threads: int | None = None,
    ) -> Loop:
        """Lead a parameter of the drive from one value to another level by level, and back, and measure J/Jmax at each.

        Parameters
        ----------
        parameter : {"width", "force_amplitude", "strain_rate"}
            The parameter to change.
        start, stop : float
            First and last level, in the unit of the parameter; it jumps to `start` at once.
        periods : float
            Periods of one way, shared equally by its levels, each of which ends with a sample; of the wave as it is driven
            at each. At least two a level.
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
        threads : int, optional
            As in `run`.

        Returns
        -------
        Loop
            Both branches with standard errors, their `Loop.table` and `Loop.thresholds`; `peristalsis.plot.hysteresis`
            draws it.

        Notes
        -----
        `configuration` has the whole course, so that it repeats the ramp. Where the flow changes its kind by chance, the
        place of the jump depends on how fast the ramp is and on the seed: ramp several replicates.

        Examples
        --------
        >>> import peristalsis
        >>> sim = peristalsis.Simulation.preset("frictionless-fine", waves=2, strain_rate=0.05, seed=1)
        >>> loop = sim.ramp("width", 2.4, 2.8, periods=4, levels=2, back=False)
        >>> loop.flow_rate_ratio.shape, loop.thresholds.back
        ((2,), None)
        """
        if parameter not in CHANGEABLE:
            raise ConfigurationError(f"{parameter} cannot be led; {', '.join(CHANGEABLE)} can")
        self._drive(parameter)
        levels = whole("levels", levels, 1)
        named = {"start": start, "stop": stop, "periods": periods, "settle": settle, "threshold": threshold}
        start, stop, periods, settle, threshold = (number(name, value) for name, value in named.items())
        if levels == 1 and start != stop:
            raise ValueError(f"one level cannot lead from {start} to {stop}: levels is 2 at least")
        if not 0 <= settle < 1:
            raise ValueError(f"settle = {settle} is no part of a level: from 0 to below 1")
        if not periods >= 2 * levels:
            raise ValueError(f"{periods} periods are fewer than two for each of {levels} levels")
        values = np.linspace(start, stop, levels)
        if not np.isfinite(values).all() or (parameter == "strain_rate" and not (values > 0).all()):
            raise ValueError(f"{parameter} cannot be led from {start} to {stop}")
        # Before anything is computed.
        for value in values:
            self._run.check_drive(parameter, value)
        return ramp(self, parameter, values, periods / levels, settle, threshold, back, progress, threads)

    # In words

    def _facts(self) -> dict[str, str]:
        configuration = self.configuration
        drive = [f"{name} {value:g}" for name in CHANGEABLE if (value := self._run.driven(name)) is not None]
        transition = self.transition_time
        facts = {
            "grains": f"{configuration.grains} in {configuration.waves} waves, volume fraction {configuration.volume_fraction:.3g}",
            "drive": ", ".join(drive),
            "time": f"{self.time:.6g} ({self.period:.4g} periods, {self.steps} steps)",
            "J/Jmax": f"{self.flow_rate_ratio + 0.0:.4g}",
            "transition": "none yet" if transition is None else f"at {transition:.5g}",
            "seed": str(configuration.seed),
            "escaped": str(self.escaped),
            "largest overlap": f"{self.largest_overlap:.3g} d",
        }
        if self._run.divergence is not None:
            facts["status"] = self._run.divergence.splitlines()[0]
        return facts

    def __repr__(self) -> str:
        facts = "; ".join(f"{name} {fact}" for name, fact in self._facts().items())
        doubts = "".join(f"\n  warning: {warning}" for warning in self.warnings)
        return f"<peristalsis.Simulation: {facts}>{doubts}"

    def _repr_html_(self) -> str:
        doubts = "".join(f"<p>warning: {html.escape(str(warning))}</p>" for warning in self.warnings)
        return facts_to_html("peristalsis.Simulation", self._facts().items()) + doubts
