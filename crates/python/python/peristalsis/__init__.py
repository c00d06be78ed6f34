"""Grains in a peristaltic tube: simulation, studies, analysis and figures.

>>> import peristalsis
>>> sim = peristalsis.Simulation.preset("frictionless", width=2.6, strain_rate=0.1, seed=1)
>>> sim.run(periods=50)                                             # doctest: +SKIP
>>> sim.flow_rate_ratio                                             # doctest: +SKIP

Units are those of the model: mass m, length d, time t. Every flow rate and axial velocity in a table is positive along
the wave; vectors (`Simulation.positions`, `Simulation.velocities`) are in the frame of the tube, and
`Simulation.heading` says which way the wave runs in it.
"""

from collections.abc import Mapping

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
from ._run import run
from ._simulation import Simulation
from ._study import PlannedRun, Study, study
from ._warnings import KeyedWarning

Mapping.register(Configuration)

__all__ = [
    "AnalysisError",
    "Configuration",
    "ConfigurationError",
    "DivergedError",
    "DoesNotFitError",
    "KeyedWarning",
    "PlannedRun",
    "Simulation",
    "SnapshotError",
    "Study",
    "StudyFailure",
    "Table",
    "__version__",
    "analysis",
    "newtonian",
    "presets",
    "run",
    "study",
]
