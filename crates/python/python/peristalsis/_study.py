"""Studies: many runs over parameters, kept in a store."""

from __future__ import annotations

import operator
import os
import sys
import warnings
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from . import _core
from ._core import Configuration, Table
from ._given import positive, text_of, whole
from ._keywords import flat
from ._warnings import PeristalsisWarning, outside


class PlannedRun(NamedTuple):
    """One run of a study.

    Attributes
    ----------
    identity : str
        Name of the run, which follows from what it computes.
    replicate : int
        Number of the replicate at its point, from 0.
    settings : dict
        Values of the study's axes at its point, by their dotted keys.
    configuration : Configuration
        Every resolved value.

    Examples
    --------
    >>> import peristalsis
    >>> content = {"name": "widths", "preset": "frictionless", "axes": [{"key": "drive.width", "values": [2.6, 2.8]}]}
    >>> [run.settings for run in peristalsis.study(content).plan()]
    [{'drive.width': 2.6}, {'drive.width': 2.8}]
    """

    identity: str
    replicate: int
    settings: dict[str, float | str]
    configuration: Configuration


def study(
    source: str | os.PathLike[str] | Mapping[str, Any], store: str | os.PathLike[str] | None = None
) -> Study:
    """A study from its file, or from a dictionary of the same shape.

    Parameters
    ----------
    source : path or mapping
        A study file (``peristalsis study schema`` says what it may hold), or its content::

            {"name": "widths", "preset": "frictionless", "replicates": 4,
             "base": {"tube.waves": 2},
             "axes": [{"key": "drive.width", "from": 2.6, "to": 2.9, "step": 0.1}]}

    store : path, optional
        Folder that keeps the runs; ``stores/NAME`` by default. The command line works on the same store.

    Returns
    -------
    Study
        Planned and checked; nothing is computed yet.

    Raises
    ------
    ConfigurationError, StudyFailure
        Where a key is unknown or a value not allowed.

    Examples
    --------
    >>> import peristalsis
    >>> content = {"name": "example", "preset": "frictionless", "replicates": 2, "base": {"tube.waves": 2, "run.periods": 1}}
    >>> peristalsis.study(content).name
    'example'
    """
    if isinstance(source, Mapping):
        name, text = "study", _toml(source)
    else:
        name, text = os.fspath(source), text_of(source)
    return _of_text(name, text, store)


def _of_text(name: str, text: str, store: str | os.PathLike[str] | None) -> Study:
    """The study of a file's name and text."""
    read = _core.Study(name, text)
    folder = Path("stores", read.name) if store is None else Path(store)
    # Files that it names are beside it, wherever the process runs that unpickles it.
    return Study(read, folder, (_of_text, (os.path.abspath(name), text)))


class Study:
    """A study with the store that keeps its runs.

    Work on it as often as you like, in several processes at once: what is done is not done again, and the rows come out
    the same bit for bit. Made by `study` and `Study.open`. It can be pickled: what is unpickled has the same store.

    Attributes
    ----------
    store : pathlib.Path
        Folder that keeps the runs.

    Examples
    --------
    >>> import peristalsis
    >>> content = {"name": "example", "preset": "frictionless", "replicates": 2, "base": {"tube.waves": 2, "run.periods": 1}}
    >>> import tempfile
    >>> folder = tempfile.mkdtemp()
    >>> study = peristalsis.study(content, store=f"{folder}/store")
    >>> study.run(workers=1)
    'complete'
    >>> study.rows().to_pandas()["seed"].nunique()
    2
    """

    def __init__(
        self, study: _core.Study, store: Path, made: tuple[Callable[..., Study], tuple[Any, ...]]
    ) -> None:
        self._study = study
        self._made = made
        self.store: Path = store

    def __reduce__(self) -> tuple[Callable[..., Study], tuple[Any, ...]]:
        function, arguments = self._made
        return function, (*arguments, self.store.absolute())

    @classmethod
    def open(cls, store: str | os.PathLike[str]) -> Study:
        """The study of a store that there is.

        Parameters
        ----------
        store : path
            Folder of the store.

        Returns
        -------
        Study
            That which ran on the store last.

        Raises
        ------
        StudyFailure, OSError
            Where there is no store.

        Examples
        --------
        >>> import peristalsis
        >>> content = {"name": "example", "preset": "frictionless", "replicates": 2, "base": {"tube.waves": 2, "run.periods": 1}}
        >>> import tempfile
        >>> folder = tempfile.mkdtemp()
        >>> peristalsis.study(content, store=f"{folder}/store").run(workers=1)
        'complete'
        >>> peristalsis.Study.open(f"{folder}/store").counts()
        {'done': 2}
        """
        return cls(_core.Study.of_store(os.fspath(store)), Path(store), (cls.open, ()))

    @property
    def name(self) -> str:
        """Short name.

        Examples
        --------
        >>> import peristalsis
        >>> content = {"name": "example", "preset": "frictionless", "title": "An example", "replicates": 2}
        >>> peristalsis.study(content).name
        'example'
        """
        return self._study.name

    @property
    def title(self) -> str:
        """What it is about.

        Examples
        --------
        >>> import peristalsis
        >>> content = {"name": "example", "preset": "frictionless", "title": "An example", "replicates": 2}
        >>> peristalsis.study(content).title
        'An example'
        """
        return self._study.title

    def plan(self) -> list[PlannedRun]:
        """The runs, in the order of the axes; those that refinement will add are not among them.

        Returns
        -------
        list of PlannedRun
            Each with its identity, its settings and its configuration.

        Examples
        --------
        >>> import peristalsis
        >>> content = {"name": "example", "preset": "frictionless", "replicates": 2, "base": {"tube.waves": 2, "run.periods": 1}}
        >>> len(peristalsis.study(content).plan())
        2
        """
        return [PlannedRun(*run) for run in self._study.plan()]

    def run(
        self,
        workers: int | None = None,
        *,
        limit: float | None = None,
        progress: bool = False,
    ) -> str:
        """Compute what is missing.

        Parameters
        ----------
        workers : int, optional
            Runs at a time; one for each processor by default.
        limit : float, optional
            Seconds after which to stop, every run in progress saved.
        progress : bool
            Show how far it is, on standard error.

        Returns
        -------
        {"complete", "time_up"}
            ``"complete"`` once no run is left, though some may have failed. Ctrl-C raises `KeyboardInterrupt` once every run
            is saved; call again to go on.

        Warns
        -----
        PeristalsisWarning
            Where runs of the study have failed, in this call or before: how many, and how to see why. `counts` has their
            number too, and what they would give is missing from `rows`.

        Raises
        ------
        StudyFailure
            Where the store belongs to another study, or cannot be written.

        Examples
        --------
        >>> import peristalsis
        >>> content = {"name": "example", "preset": "frictionless", "replicates": 2, "base": {"tube.waves": 2, "run.periods": 1}}
        >>> import tempfile
        >>> folder = tempfile.mkdtemp()
        >>> peristalsis.study(content, store=f"{folder}/store").run(workers=1)
        'complete'
        """

        def watch(done: int, failed: int, total: int, part: float, left: float | None) -> None:
            rest = "" if left is None else f"  {left:.0f} s left"
            print(f"\r{part:4.0%}  {done} of {total} runs, {failed} failed{rest}   ", end="", file=sys.stderr)

        self.store.parent.mkdir(parents=True, exist_ok=True)
        number = (os.cpu_count() or 1) if workers is None else whole("workers", workers, 1, 1024)
        seconds = None if limit is None else positive("limit", limit)
        ending = self._study.work(os.fspath(self.store), number, seconds, watch if progress else None)
        if progress:
            print(file=sys.stderr)
        counts = self.counts()
        if failed := counts.get("failed", 0):
            runs = sum(counts.values())
            reasons = f"{self.name}-failed.csv, which Study.export writes, has the reasons"
            text = f"{failed} of {runs} run{'s' * (runs > 1)} failed: {reasons}; or see: peristalsis study why {self.store} RUN"
            warnings.warn(text, PeristalsisWarning, stacklevel=outside())
        return ending

    def rows(self) -> Table:
        """The finished runs of this study, one a row, with the units of the columns.

        Runs of the store that are not in :meth:`plan`, nor added by ``refine``, are left out.

        Returns
        -------
        Table
            `Table.to_pandas`, `Table.to_polars` and `Table.to_xarray` give frames; pyarrow takes it as it is.

        Raises
        ------
        StudyFailure, OSError
            Where there is no store yet, or that of a study of another name.

        Examples
        --------
        >>> import peristalsis
        >>> content = {"name": "example", "preset": "frictionless", "replicates": 2, "base": {"tube.waves": 2, "run.periods": 1}}
        >>> import tempfile
        >>> folder = tempfile.mkdtemp()
        >>> study = peristalsis.study(content, store=f"{folder}/store")
        >>> study.run(workers=1)
        'complete'
        >>> rows = study.rows()
        >>> len(rows), rows.units["strain_rate"]
        (2, '1/t')
        """
        return self._study.rows(os.fspath(self.store))

    def counts(self) -> dict[str, int]:
        """How many runs of this study are in which state.

        Returns
        -------
        dict of str to int
            States such as ``done`` and ``failed``.

        Examples
        --------
        >>> import peristalsis
        >>> content = {"name": "example", "preset": "frictionless", "replicates": 2, "base": {"tube.waves": 2, "run.periods": 1}}
        >>> import tempfile
        >>> folder = tempfile.mkdtemp()
        >>> study = peristalsis.study(content, store=f"{folder}/store")
        >>> study.run(workers=1)
        'complete'
        >>> study.counts()
        {'done': 2}
        """
        return self._study.counts(os.fspath(self.store))

    def export(self, folder: str | os.PathLike[str], series: bool = False) -> list[str]:
        """Write the tables of this study as Parquet and CSV.

        Parameters
        ----------
        folder : path
            Where to write them.
        series : bool
            Also the time series of all runs.

        Returns
        -------
        list of str
            The files; where runs failed, one of them has the reasons, ``NAME-failed.csv``.

        Raises
        ------
        FileNotFoundError
            Where there is no store yet.

        Examples
        --------
        >>> import peristalsis
        >>> content = {"name": "example", "preset": "frictionless", "replicates": 2, "base": {"tube.waves": 2, "run.periods": 1}}
        >>> import tempfile
        >>> folder = tempfile.mkdtemp()
        >>> study = peristalsis.study(content, store=f"{folder}/store")
        >>> study.run(workers=1)
        'complete'
        >>> any(file.endswith(".csv") for file in study.export(f"{folder}/tables"))
        True
        """
        files = self._study.export(os.fspath(self.store), os.fspath(folder), series)
        return [os.fspath(file) for file in files]

    def __repr__(self) -> str:
        return f"<peristalsis.Study: {self.name}, {len(self._study.plan())} runs planned, store {self.store}>"


def _toml(content: Mapping[str, Any]) -> str:
    """A study's content as TOML."""
    return "".join(f"{_key(key)} = {_value(key, value)}\n" for key, _, value in flat(content))


def _key(key: str) -> str:
    return ".".join(_text(part) for part in key.split("."))


def _text(text: str) -> str:
    escaped = text.replace("\\", "\\\\").replace('"', '\\"')
    return '"' + "".join(c if c >= " " and c != "\x7f" else f"\\u{ord(c):04x}" for c in escaped) + '"'


def _value(name: str, value: Any) -> str:
    """A value as TOML; `name` is its key."""
    if isinstance(value, Mapping):
        return "{" + ", ".join(f"{_key(key)} = {_value(f'{name}.{key}', item)}" for key, _, item in flat(value)) + "}"
    if isinstance(value, (str, os.PathLike)):
        return _text(os.fspath(value))
    if isinstance(value, (bool, np.bool_)):
        return "true" if value else "false"
    # NumPy's arrays of no dimension are single numbers.
    if isinstance(value, Iterable) and getattr(value, "ndim", None) != 0:
        return "[" + ", ".join(_value(name, item) for item in value) + "]"
    try:
        return str(operator.index(value))
    except TypeError:
        pass
    try:
        return repr(float(value))
    except (TypeError, ValueError):
        raise TypeError(f"{name}: {value!r} is no number, text, truth value, list or dictionary") from None
