"""How a simulation is made, copied and kept."""

from __future__ import annotations

import os
import threading
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any
from weakref import WeakSet

import numpy as np
import numpy.typing as npt

from . import _core
from ._core import Configuration, ConfigurationError
from ._given import numbers, of_kind, text_of
from ._keywords import overrides as joined
from ._output import Output
from ._warnings import kind, tell

if TYPE_CHECKING:
    from typing_extensions import Self, Unpack

    from ._types import Keywords, _Preset


class Made(Output):
    """How a simulation is made, copied and kept; `Simulation` is the public class."""

    __slots__ = ("_running", "_told", "__weakref__")

    _running: threading.Lock
    #: Doubts that have been told.
    _told: set[str]

    def __init__(self, configuration: Configuration) -> None:
        of_kind("configuration", configuration, Configuration, "a peristalsis.Configuration (presets: Simulation.preset)")
        self._begin(_core.Run(configuration))
        tell(self.warnings, self._told)

    def _begin(self, run: _core.Run) -> None:
        self._run = run
        self._running = threading.Lock()
        self._told = set()
        self._writers = []
        self._views = WeakSet()

    @classmethod
    def _of(cls, run: _core.Run) -> Self:
        simulation = cls.__new__(cls)
        simulation._begin(run)
        return simulation

    @classmethod
    def _going_on(cls, run: _core.Run) -> Self:
        """Of which nothing is told that the one that it goes on from has told."""
        simulation = cls._of(run)
        simulation._told.update(map(kind, simulation.warnings))
        return simulation

    @classmethod
    def preset(
        cls, name: _Preset | str, overrides: Mapping[str, Any] | None = None, **keywords: Unpack[Keywords]
    ) -> Self:
        """A preset with some of its values replaced.

        Parameters
        ----------
        name : str
            One of `peristalsis.presets()`.
        overrides : mapping, optional
            Values of dotted keys, such as ``{"contact.static_friction": 0.5}``.
        **keywords
            Values of keys by their last word.

        Returns
        -------
        Simulation
            At its first step, the grains packed.

        Raises
        ------
        ConfigurationError
            Where a key is unknown or a value not allowed: in the words of the command line.
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
    def from_toml(cls, text: str, overrides: Mapping[str, Any] | None = None, **keywords: Unpack[Keywords]) -> Self:
        """A configuration in TOML, as in a file of the command line.

        Parameters
        ----------
        text : str
            The configuration; ``preset = "..."`` in it names the preset below it.
        overrides : mapping, optional
            Values of dotted keys, over the text.
        **keywords
            Values of keys by their last word, over the text.

        Returns
        -------
        Simulation
            At its first step.

        Raises
        ------
        ConfigurationError, DoesNotFitError
            As of `preset`; errors name the line.

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
        cls, path: str | os.PathLike[str], overrides: Mapping[str, Any] | None = None, **keywords: Unpack[Keywords]
    ) -> Self:
        """A configuration file, or the ``config.toml`` that a run left.

        Parameters
        ----------
        path : path
            A file in TOML.
        overrides : mapping, optional
            Values of dotted keys, over the file.
        **keywords
            Values of keys by their last word, over the file.

        Returns
        -------
        Simulation
            At its first step: `load` goes on from where a run has come to.

        Raises
        ------
        OSError
            Where the file cannot be read.
        ConfigurationError, DoesNotFitError
            As of `preset`; errors name the file and the line.

        Examples
        --------
        >>> import tempfile
        >>> from pathlib import Path
        >>> import peristalsis
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     file = Path(folder) / "tube.toml"
        ...     _ = file.write_text("preset = 'frictionless-fine'\\ntube.waves = 2")
        ...     sim = peristalsis.Simulation.from_file(file, strain_rate=0.05)
        >>> sim.length, sim.strain_rate
        (20.0, 0.05)
        """
        settings = joined(overrides, keywords)
        return cls(Configuration(text=text_of(path), name=os.fspath(path), overrides=settings))

    @classmethod
    def from_positions(
        cls,
        configuration: Configuration,
        positions: npt.ArrayLike,
        velocities: npt.ArrayLike | None = None,
        diameters: npt.ArrayLike | None = None,
    ) -> Self:
        """Grains put where the caller wants them, in this order.

        Parameters
        ----------
        configuration : Configuration
            All else. The number of grains and their diameters become those of the arrays.
        positions : array_like
            Centres [d], shape (N, 3), the axis of the tube along z; z is taken into [0, L).
        velocities : array_like, optional
            Velocities in the frame of the tube [d/t], shape (N, 3); at rest by default.
        diameters : array_like, optional
            Diameters [d], shape (N,), or one for all; the diameter of the configuration by default.

        Returns
        -------
        Simulation
            At its first step, the grains as they were put.

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
        of_kind("configuration", configuration, Configuration, "a peristalsis.Configuration")
        places = numbers("positions", positions)
        speeds = np.zeros_like(places) if velocities is None else numbers("velocities", velocities)
        if places.ndim != 2 or places.shape[1] != 3 or speeds.shape != places.shape:
            raise ConfigurationError(
                f"positions and velocities are arrays of shape (N, 3), not {places.shape} and {speeds.shape}"
            )
        least, most = configuration["grains.diameter_min"], configuration["grains.diameter_max"]
        if diameters is None and least != most:
            raise ConfigurationError(f"grains of diameters from {least} to {most}: give diameters, one for each grain")
        sizes = numbers("diameters", least if diameters is None else diameters)
        if sizes.shape not in ((), (len(places),)):
            raise ConfigurationError(f"diameters is one number, or an array of shape ({len(places)},), not {sizes.shape}")
        sizes = np.array(np.broadcast_to(sizes, len(places)))
        if (wrong := np.flatnonzero(~((sizes > 0) & np.isfinite(sizes)))).size:
            raise ConfigurationError(f"diameters[{wrong[0]}] = {sizes[wrong[0]]} is no diameter: each is a number above 0")
        keys: dict[str, Any] = {"grains.number": len(places), "initial.state": "placed"}
        found, counts = np.unique(sizes, return_counts=True)
        if len(found) == 1:
            keys |= {"grains.sizes": "uniform", "grains.diameter_min": found[0], "grains.diameter_max": found[0]}
        elif len(found):
            # Averages over the grains are then those of these.
            keys |= {"grains.sizes": "table", "grains.diameters": found, "grains.fractions": counts}
        simulation = cls._of(_core.Run.placed(configuration.replace(keys), places, speeds, sizes))
        tell(simulation.warnings, simulation._told)
        return simulation

    # Snapshots

    def to_bytes(self) -> bytes:
        """A snapshot: configuration, state and what was measured; `from_bytes` goes on with the same bits.

        Returns
        -------
        bytes
            What `save` writes to a file. That a simulation has diverged is not kept.

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
    def from_bytes(cls, snapshot: bytes) -> Self:
        """Go on from a snapshot.

        Parameters
        ----------
        snapshot : bytes
            The result of `to_bytes`, or the content of a file of `save` or of the command line.

        Returns
        -------
        Simulation
            At the step of the snapshot.

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
        of_kind("snapshot", snapshot, (bytes, bytearray, memoryview), "the bytes of a snapshot")
        return cls._going_on(_core.Run.from_bytes(bytes(snapshot)))

    @classmethod
    def load(cls, path: str | os.PathLike[str]) -> Self:
        """Go on from what `save` or the command line left, with the same bits.

        Parameters
        ----------
        path : path
            A file of `save`, the ``state.checkpoint`` of a run, or the folder of a run.

        Returns
        -------
        Simulation
            At the step of the file. Warnings about it are given again.

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

    def copy(self) -> Self:
        """A simulation that goes on by itself from here, with the same bits.

        Returns
        -------
        Simulation
            With configuration, state, all that was measured, and how it diverged where it has. Not with the writers of
            `add_writer`: two simulations cannot share a file, so give the copy its own. The same holds for a pickle.

        Examples
        --------
        >>> import peristalsis
        >>> sim = peristalsis.Simulation.preset("frictionless-fine", waves=2, strain_rate=0.05, seed=1)
        >>> other = sim.copy()
        >>> other.step(3)
        >>> sim.steps, other.steps
        (0, 3)
        """
        return self._going_on(self._run.copy())

    def __copy__(self) -> Self:
        return self.copy()

    def __deepcopy__(self, memo: dict[int, Any]) -> Self:
        return self.copy()

    @classmethod
    def _unpickled(cls, snapshot: bytes, divergence: str | None) -> Self:
        return cls._going_on(_core.Run.from_bytes(snapshot, divergence))

    def __reduce__(self) -> tuple[Callable[[bytes, str | None], Self], tuple[bytes, str | None]]:
        return self._unpickled, (self.to_bytes(), self._run.divergence)


# Python's own messages about arguments name the class that users know.
Made.__init__.__qualname__ = "Simulation.__init__"
