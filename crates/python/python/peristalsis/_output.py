"""What a simulation writes and draws."""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, cast

from . import _core
from ._drive import Drive, View
from ._given import number, whole
from ._picture import Picture
from ._writers import Writer, held

if TYPE_CHECKING:
    from ._simulation import Simulation


class Output(Drive):
    """What a simulation writes and draws; `Simulation` is the public class."""

    __slots__ = ("_writers",)

    _writers: list[Writer]

    def add_writer(
        self,
        path: str | os.PathLike[str] | Writer,
        every: float | str | None = None,
        at: float | str | Sequence[float | str] | None = None,
        *,
        overwrite: bool = False,
    ) -> Writer:
        """Write frames to a file in all runs from now on, the first at once where it is due; as `Writer`.

        Parameters
        ----------
        path, every, at, overwrite
            As of `Writer`; or a `Writer` alone, instead of all of them.

        Returns
        -------
        Writer
            Which `remove_writer` takes away again. A copy or a pickle of the simulation is without it.

        Raises
        ------
        ValueError, FileExistsError
            As of `Writer`.

        Examples
        --------
        >>> import tempfile
        >>> from pathlib import Path
        >>> import peristalsis
        >>> sim = peristalsis.Simulation.preset("frictionless-fine", waves=2, strain_rate=0.05, seed=1)
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     writer = sim.add_writer(Path(folder) / "run.lammpstrj", at=[0, 1, "30t"])
        ...     for _ in range(2):
        ...         sim.run(periods=1)
        ...     writer.frames
        3
        """
        if isinstance(path, Writer) and (every, at, overwrite) != (None, None, False):
            raise TypeError("add_writer takes a Writer, or what one is made of, not both")
        writer = path if isinstance(path, Writer) else Writer(path, every, at, overwrite=overwrite)
        with held([*self._writers, writer]):
            writer._begin(cast("Simulation", self))
        self._writers.append(writer)
        return writer

    def remove_writer(self, writer: Writer) -> None:
        """Write no more frames to a file of `add_writer`; what is in it stays.

        Parameters
        ----------
        writer : Writer
            The result of `add_writer`.

        Raises
        ------
        ValueError
            Where it does not belong to this simulation.

        Examples
        --------
        >>> import tempfile
        >>> from pathlib import Path
        >>> import peristalsis
        >>> sim = peristalsis.Simulation.preset("frictionless-fine", waves=2, strain_rate=0.05, seed=1)
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     writer = sim.add_writer(Path(folder) / "run.gsd", every=0.5)
        ...     sim.run(periods=1)
        ...     sim.remove_writer(writer)
        ...     sim.run(periods=1)
        ...     writer.frames
        3
        """
        if writer not in self._writers:
            raise ValueError(f"{writer!r} is no writer of this simulation's add_writer")
        self._writers.remove(writer)

    def write(self, path: str | os.PathLike[str]) -> None:
        """Write the spheres as they stand to a file, whole or not at all, over an older one.

        Parameters
        ----------
        path : path
            ``.gsd``, ``.vtp``, ``.lammpstrj`` as of `Writer`, or ``.parquet``, a table of the grains.

        Raises
        ------
        ValueError
            For another ending.

        Examples
        --------
        >>> import tempfile
        >>> from pathlib import Path
        >>> import peristalsis
        >>> sim = peristalsis.Simulation.preset("frictionless", waves=2)
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     sim.write(Path(folder) / "now.vtp")
        ...     (Path(folder) / "now.vtp").exists()
        True
        """
        _core.write_frame(self._run, Path(path))

    def render(
        self,
        path: str | os.PathLike[str] | None = None,
        *,
        view: str = "side",
        colour: str = "axial-velocity",
        range: tuple[float, float] | None = None,
        wall: str = "cut",
        place: float | None = None,
        position: float | None = None,
        waves: float = 2.0,
        width: int | None = None,
        paper: str = "light",
        bare: bool = False,
    ) -> Picture:
        """A picture of the tube as it stands, as ``peristalsis render`` makes it.

        Parameters
        ----------
        path : path, optional
            Write it to a file as well: ``.png``, or ``.svg`` with its writing as vectors.
        view : {"side", "section", "space-time"}
            From the side; cut across; or the flow rate of each wave against time.
        colour : str
            What colours the grains: ``"axial-velocity"``, ``"speed"``, ``"diameter"``, ``"axial-displacement"``,
            ``"angular-velocity"``, ``"position"``, ``"coordination"``, ``"pressure"``.
        range : (float, float), optional
            Values of the first and the last colour.
        wall : {"cut", "glass", "none"}
            How the wall looks from the side.
        place, position : float, optional
            Where a section is: z [d], or (z - c t)/lambda; the middle of the tube by default.
        waves : float
            Wavelengths that a side view shows at most.
        width : int, optional
            Pixels across, 16 to 16384: 2400, and 1200 for a section, by default.
        paper : {"light", "dark"}
            The page.
        bare : bool
            No writing around the picture.

        Returns
        -------
        Picture
            A notebook shows it.

        Raises
        ------
        ValueError
            For an option that is not possible, and where there is nothing to show.

        Examples
        --------
        >>> import peristalsis
        >>> sim = peristalsis.Simulation.preset("frictionless", waves=2)
        >>> sim.render(view="section", colour="diameter", width=300, bare=True)
        <peristalsis.Picture: 300 x 300 pixels>
        """
        endings = (".png", ".svg")
        if path is not None and Path(path).suffix.lower() not in endings:
            raise ValueError(f"{path}: a picture is {' or '.join(endings)}")
        if place is not None and position is not None:
            raise ValueError("a section is at place or at position, not at both")
        places = {"place": place, "position": position}
        places = {name: None if value is None else number(name, value) for name, value in places.items()}
        width = None if width is None else whole("width", width, 0, 2**32 - 1)
        ends = None if range is None else tuple(number("range", end) for end in range)
        options: dict[str, Any] = {
            "view": view, "colour": colour, "range": ends, "wall": wall, **places,
            "waves": number("waves", waves), "width": width, "paper": paper, "bare": bare,
        }
        picture = Picture(_core.render(self._run, **options, vector=False))
        if path is not None and Path(path).suffix.lower() == ".svg":
            Path(path).write_bytes(_core.render(self._run, **options, vector=True))
        elif path is not None:
            picture.save(path)
        return picture

    def view(self, height: int = 680) -> View:
        """The page of the viewer as a widget of a notebook, which shows this simulation as it goes on and steers it.

        Whatever advances the simulation is seen on the page. Its sliders set the drive of the simulation, and its
        play button advances it while no cell runs. Nothing is asked of any server. What only a viewer of its own can do is
        not there: to go back in time, and links.

        Parameters
        ----------
        height : int
            Height in the notebook in pixels.

        Returns
        -------
        View
            A widget with the traits ``width``, ``force_amplitude``, ``strain_rate``, ``playing`` and ``speed``.

        Raises
        ------
        ImportError
            Where anywidget is not installed: ``pip install 'peristalsis[widget]'``.

        Examples
        --------
        >>> import peristalsis
        >>> sim = peristalsis.Simulation.preset("frictionless-fine", waves=2, strain_rate=0.05, width=2.6, seed=1)
        >>> view = sim.view()
        >>> view.width
        2.6
        """
        try:
            from ._view import Widget
        except ImportError as error:
            if error.name not in ("anywidget", "ipywidgets", "traitlets"):
                raise
            raise ImportError("view() needs anywidget: pip install 'peristalsis[widget]'", name=error.name) from error
        return Widget(cast("Simulation", self), height)

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write a snapshot to a file, whole or not at all, over an older one; `Simulation.load` goes on from it, and so does
        ``peristalsis run --resume FILE``. That a simulation has diverged is not kept.

        Parameters
        ----------
        path : path
            The file, in the format of the ``state.checkpoint`` of a run.

        Raises
        ------
        OSError
            Where it cannot be written, or is the state of a run that another program works on; an older file stays.

        Examples
        --------
        >>> import tempfile
        >>> from pathlib import Path
        >>> import peristalsis
        >>> sim = peristalsis.Simulation.preset("frictionless", waves=2, strain_rate=0.03)
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     sim.save(Path(folder) / "now.checkpoint")
        ...     peristalsis.Simulation.load(Path(folder) / "now.checkpoint").steps
        0
        """
        self._run.save(Path(path))
