"""One run as a function: what pools of workers and clusters take."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, cast

from ._core import Configuration
from ._given import of_kind
from ._simulation import Simulation

if TYPE_CHECKING:
    from ._types import RunSummary


def run(config: Mapping[str, Any], threads: int | None = None) -> RunSummary:
    """Run a configuration to its end and answer its summary.

    Function, argument and answer can be pickled, so that replicates go through `concurrent.futures`, joblib, Dask or Ray
    as they are.

    Parameters
    ----------
    config : mapping
        ``preset`` (a name) or ``file`` (a path), and keywords, dotted keys or sections as of `Simulation.preset`; or a
        `Configuration`.
    threads : int, optional
        Threads of the engine, as of `Simulation.run`: 1 where each core has a process of its own.

    Returns
    -------
    RunSummary
        A dictionary: the summary, with the given `config` under its own name.

    Raises
    ------
    TypeError
        Where it names neither a preset nor a file, or both.
    ConfigurationError
        Where a key is unknown or a value not allowed.

    Examples
    --------
    >>> from peristalsis import run
    >>> summary = run({"preset": "frictionless", "waves": 2, "periods": 2, "seed": 3})
    >>> summary["seed"], summary["config"]["waves"]
    (3, 2)
    """
    if isinstance(config, Configuration):
        simulation = Simulation(config)
        simulation.run(threads=threads)
        return cast("RunSummary", {"config": config.to_dict(), **simulation.summary()})
    of_kind("config", config, Mapping, "a mapping with preset or file, or a peristalsis.Configuration")
    settings = dict(config)
    preset, file = settings.pop("preset", None), settings.pop("file", None)
    if (preset is None) == (file is None):
        raise TypeError("a configuration to run names a preset or a file")
    sections = {key for key, value in settings.items() if isinstance(value, Mapping) and key != "schedule"}
    dotted = {key: settings.pop(key) for key in list(settings) if "." in key or key in sections}
    if file is None:
        simulation = Simulation.preset(preset, dotted, **settings)
    else:
        simulation = Simulation.from_file(file, dotted, **settings)
    simulation.run(threads=threads)
    return cast("RunSummary", {"config": dict(config), **simulation.summary()})
