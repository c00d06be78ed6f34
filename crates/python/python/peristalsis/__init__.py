"""Grains in a peristaltic tube: simulation, studies, analysis and figures.

>>> import peristalsis
>>> sim = peristalsis.Simulation.preset("frictionless-fine", width=2.6, strain_rate=0.05, seed=1)
>>> sim.run(periods=50)                                             # doctest: +SKIP
>>> sim.flow_rate_ratio                                             # doctest: +SKIP

Units are those of the model: mass m, length d, time t. Every flow rate and axial velocity in a table is positive along
the wave; vectors (`Simulation.positions`, `Simulation.velocities`) are in the frame of the tube, and
`Simulation.heading` says which way the wave runs in it.
"""

from collections.abc import Mapping
from importlib import import_module
from types import ModuleType

from . import analysis, newtonian
from ._core import (
    AnalysisError,
    Configuration,
    ConfigurationError,
    DivergedError,
    DoesNotFitError,
    SnapshotError,
    StudyFailure,
    Table,
    __version__,
    presets,
)
from ._loop import Loop, Threshold, Thresholds
from ._picture import Picture
from ._run import run
from ._simulation import Simulation
from ._study import PlannedRun, Study, study
from ._types import Keywords, RunSummary, Summary
from ._warnings import KeyedWarning, PeristalsisWarning
from ._writers import Writer

Mapping.register(Configuration)


def __getattr__(name: str) -> ModuleType:
    """`plot`, which needs Matplotlib, once it is asked for."""
    if name == "plot":
        return import_module("peristalsis.plot")
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted([*__all__, "plot"])


__all__ = [
    "AnalysisError",
    "Configuration",
    "ConfigurationError",
    "DivergedError",
    "DoesNotFitError",
    "KeyedWarning",
    "Keywords",
    "Loop",
    "PeristalsisWarning",
    "Picture",
    "PlannedRun",
    "RunSummary",
    "Simulation",
    "SnapshotError",
    "Study",
    "StudyFailure",
    "Summary",
    "Table",
    "Threshold",
    "Thresholds",
    "Writer",
    "__version__",
    "analysis",
    "newtonian",
    "presets",
    "run",
    "study",
]
