"""Frames of a simulation in files, and what is done at certain steps of it."""

from __future__ import annotations

import math
import os
import threading
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, TypeAlias

from . import _core
from ._given import whole

if TYPE_CHECKING:
    from ._simulation import Simulation

    _Callback: TypeAlias = Callable[[Simulation], object]
    _Callbacks: TypeAlias = _Callback | Iterable[_Callback | tuple[_Callback, int]]


class Trigger:
    """Something that is done at certain steps."""

    __slots__ = ("_due", "act", "every")

    def __init__(self, act: Callable[[Simulation], object], now: int, every: int) -> None:
        self.act: Callable[[Simulation], object] = act
        self.every: int = every
        # At the multiples of `every`, and so at samples: in however many pieces a simulation is run.
        self._due: int | None = now + every - now % every

    def _fire(self, simulation: Simulation) -> None:
        """Does it, and waits for the next step."""
        self.act(simulation)
        self._due = (self._due or 0) + self.every


def triggers(callback: _Callbacks | None, every: int, now: int) -> list[Trigger]:
    """Those of one callback, or of several, each with steps of its own where it has any."""
    if callback is None:
        return []
    if callable(callback):
        return [Trigger(callback, now, every)]
    found = []
    for item in callback if isinstance(callback, Iterable) else [callback]:
        function, *steps = item if isinstance(item, tuple) else (item,)
        if not callable(function) or len(steps) > 1:
            raise TypeError(f"callback is a function, or a list of functions and of pairs (function, every), not {callback!r}")
        found.append(Trigger(function, now, whole("every", steps[0] if steps else every, 1)))
    return found


#: The writers that write now, by their files.
_HELD: dict[Path, Writer] = {}
_LOCK = threading.Lock()


@contextmanager
def held(writers: Iterable[Writer]) -> Iterator[None]:
    """Holds the files of writers: nobody else writes to them meanwhile."""
    mine: list[Path] = []
    try:
        with _LOCK:
            for writer in writers:
                path = writer.path.resolve()
                if _HELD.get(path, writer) is not writer:
                    raise ValueError(f"{writer.path} gets the frames of another writer already: take another name")
                if path not in _HELD:
                    _HELD[path] = writer
                    mine.append(path)
        yield
    finally:
        for path in mine:
            del _HELD[path]


def listed(writers: Iterable[Writer]) -> list[Writer]:
    """The writers given, each once."""
    found = [writers] if isinstance(writers, Writer) or not isinstance(writers, Iterable) else list(writers)
    if wrong := [it for it in found if not isinstance(it, Writer)]:
        raise TypeError(f"writers is a list of peristalsis.Writer, such as [Writer('run.gsd', every=0.5)], not of {wrong[0]!r}")
    return list(dict.fromkeys(found))


class Writer:
    """Frames of a simulation in a file, written while it runs.

    After each frame the file is whole: it can be opened while the run goes on, after Ctrl-C and after a crash.

    Parameters
    ----------
    path : path
        The file, in the format that its ending names: ``.gsd`` (OVITO, freud, MDAnalysis), ``.lammpstrj`` (LAMMPS text:
        OVITO, VMD, MDAnalysis); ``.vtp``, a folder with ``trajectory.pvd`` and ``contacts.pvd`` for ParaView and
        PyVista; ``.parquet``, a folder with a table of the grains for each frame, which pandas, polars and DuckDB read as
        one.
    every : float or str, optional
        From one frame to the next, the first at once: in wavelengths that the wave runs, also where its speed changes, or as
        text in time, ``"2.5t"``. A tenth of a wavelength unless `every` or `at` is given. While the wave
        stands still for good no frame follows.
    at : float, str, or sequence of them, optional
        Instants of single frames, counted from the start of the simulation, in the same units, as the drive is scheduled
        when writing begins.
    overwrite : bool
        Whether an older file of that name may be lost; otherwise it is an error.

    Raises
    ------
    ValueError
        For an unknown ending, spans or instants that cannot be read, or, when the first frame is due, an interval
        shorter than a step, or a file that another writer writes to.
    FileExistsError
        Where there is such a file already, when the first frame is due.

    Examples
    --------
    >>> import tempfile
    >>> from pathlib import Path
    >>> import peristalsis
    >>> sim = peristalsis.Simulation.preset("frictionless-fine", waves=2, strain_rate=0.05, seed=1)
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     writer = peristalsis.Writer(Path(folder) / "run.gsd", every=0.5)
    ...     sim.run(periods=2, writers=[writer])
    ...     writer.frames
    5
    """

    def __init__(
        self,
        path: str | os.PathLike[str],
        every: float | str | None = None,
        at: float | str | Sequence[float | str] | None = None,
        *,
        overwrite: bool = False,
    ) -> None:
        if not isinstance(path, (str, os.PathLike)):
            raise TypeError(f"path is the name of a file, not {path!r}")
        self.path: Path = Path(path)
        _core.check_frame_format(self.path)
        self._every = 0.1 if every is None and at is None else every
        self._at = [] if at is None else [at] if isinstance(at, str) or not isinstance(at, Iterable) else list(at)
        if self._every is not None and not span("every", self._every)[0]:
            raise ValueError(f"every = {every!r} is no time from one frame to the next")
        if self._every is None and not self._at:
            raise ValueError("at is empty: it names no instant of a frame")
        for instant in self._at:
            span("at", instant)
        self._overwrite = overwrite
        self._simulation: Simulation | None = None
        self._frames: _core.Frames | None = None
        # Of `every`, the clock at the next frame, in periods or in t, and its step as the wave is driven now.
        self._goal = 0.0
        self._next: int | None = None
        self._instants: list[int] = []

    @property
    def frames(self) -> int:
        """Frames written so far.

        Examples
        --------
        >>> import peristalsis
        >>> peristalsis.Writer("run.gsd", every=0.5).frames
        0
        """
        return 0 if self._frames is None else self._frames.number

    @property
    def _due(self) -> int | None:
        """Step of the next frame; `None` where no more are to come."""
        if self._simulation is None:
            return None
        now = self._simulation.steps
        self._next = self._coming(self._simulation)
        return min((step for step in [*self._instants, self._next] if step is not None and step > now), default=None)

    def _begin(self, simulation: Simulation) -> None:
        """Make ready for a simulation that is about to run; writes the present state where it is one of the frames."""
        if self._simulation is simulation:
            return
        if self._simulation is not None:
            raise ValueError(f"{self.path} holds frames of another simulation already")
        now = simulation.steps
        interval = None if self._every is None else steps_to(simulation, "every", self._every)
        instants = [now + steps_to(simulation, "at", instant, since_start=True) for instant in self._at]
        if interval is not None and interval < 1:
            raise ValueError(f"every = {self._every!r} is shorter than a step of {simulation.configuration.time_step:.4g} t")
        over = [at for at, instant in zip(self._at, instants) if instant < now]
        if over:
            raise ValueError(f"at = {over[0]!r} is over: the simulation stands at step {now}")
        if self.path.exists() and not self._overwrite:
            raise FileExistsError(f"{self.path} is there already: take another name, or overwrite=True")
        self._frames = _core.Frames(simulation._run, self.path)
        self._simulation = simulation
        self._instants = instants
        if interval or now in instants:
            self._goal = self._clock(simulation)
            self._next = now
            self._fire(simulation)

    def _fire(self, simulation: Simulation) -> None:
        """Write the present state as a frame."""
        if self._frames is not None:
            self._frames.append(simulation._run)
        if self._every is not None and self._next == simulation.steps:
            self._goal += span("every", self._every)[0]

    def _clock(self, simulation: Simulation) -> float:
        """The present time that `every` counts in."""
        is_time = self._every is not None and span("every", self._every)[1]
        return simulation.steps * simulation.configuration.time_step if is_time else simulation.period

    def _coming(self, simulation: Simulation) -> int | None:
        """Step of the next frame of `every`, as the wave is driven now; `None` where it never gets so far."""
        if self._every is None:
            return None
        every, is_time = span("every", self._every)
        now = self._clock(simulation)
        if self._goal <= now + 1e-9:
            # It has run without this writer, or has become so fast that frames are less than a step apart.
            self._goal = now + every
        ahead = self._goal - now
        time = ahead if is_time else simulation._run.time_of_periods(ahead)
        # Halves go up from wherever one looks, so that pieces of a run make the same frames.
        return None if time is None else simulation.steps + max(1, math.floor(time / simulation.configuration.time_step + 0.5 + 1e-6))

    def _synchronize(self) -> None:
        """Bring all frames to the disk."""
        if self._frames is not None:
            self._frames.synchronize()

    def __repr__(self) -> str:
        return f"<peristalsis.Writer: {self.path}, {self.frames} frame{'' if self.frames == 1 else 's'}>"


def span(name: str, given: float | str) -> tuple[float, bool]:
    """A span of time as a number, and whether it is in time; otherwise it is in periods."""
    try:
        is_time = isinstance(given, str) and given.strip().endswith("t")
        number = float(given.strip().removesuffix("t") if isinstance(given, str) else given)
    except (TypeError, ValueError):
        number = math.nan
    if not 0 <= number < math.inf:
        raise ValueError(f'{name} = {given!r} is no span of time: a number of periods, such as 0.1, or "2.5t" in time')
    return number, is_time


def steps_to(simulation: Simulation, name: str, given: float | str, *, since_start: bool = False) -> int:
    """The steps from now to the end of a span: of wavelengths that the wave runs, or as text with a ``t`` of time. Below 0
    where it is over."""
    number, is_time = span(name, given)
    if is_time:
        steps = round(number / simulation.configuration.time_step)
        return steps - simulation.steps if since_start else steps
    # Up to rounding it may be now.
    ahead = round(number - simulation.period, 9) if since_start else number
    if ahead < 0:
        return -1
    time = simulation._run.time_of_periods(ahead)
    if time is None:
        raise ValueError(f'{name} = {given!r}: the wave stands still before it has run so far; give a time, such as "2.5t"')
    return round(time / simulation.configuration.time_step)
