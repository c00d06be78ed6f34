"""The observables of `observables.py` beside the columns that our program writes, sample by sample."""

from __future__ import annotations

import csv
import subprocess
import tempfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from observables import contact_number, flow_rate_ratio, granular_temperature, inside
from own_tube import OwnTube, PeerError
from start_files import Lattice
from stationary import SAMPLES_PER_PERIOD, SMOOTH, VOLUME_FRACTION
from store import Store
from tubes import COARSE, FINE, Tube

NAME = "definitions"
PERIODS, SEED = 12, 1
# The columns are written with all digits; sums are taken in another order.
TOLERANCE = 1e-9
LATTICES: dict[str, tuple[Lattice, float, float]] = {
    "frictionless": (COARSE, 2.6, 0.05),
    "frictionless-fine": (FINE, 2.5, 0.1),
}


@dataclass(frozen=True)
class Program:
    """The binary of the command line."""

    path: Path

    def columns(self, preset: str, tube: Tube) -> dict[str, list[float]]:
        """The time series of a run."""
        with tempfile.TemporaryDirectory() as scratch:
            folder = Path(scratch) / "run"
            command = [str(self.path), "run", "--preset", preset, "--csv", "--quiet", "--out", str(folder)]
            settings = {
                "drive.width": tube.width,
                "drive.strain_rate": tube.strain_rate,
                "run.periods": PERIODS,
                "run.seed": SEED,
            }
            for key, value in settings.items():
                command += ["--set", f"{key}={value}"]
            outcome = subprocess.run(command, capture_output=True, text=True)
            if outcome.returncode != 0:
                raise PeerError(f"{' '.join(command)}\n{outcome.stderr}")
            with (folder / "timeseries.csv").open(encoding="utf-8", newline="") as table:
                rows = list(csv.DictReader(table))
        return {name: [float(row[name]) for row in rows] for name in rows[0]}


def differences(preset: str, own: OwnTube, program: Program) -> dict[str, float]:
    """Largest difference of a column in any sample."""
    lattice, width, strain_rate = LATTICES[preset]
    tube = Tube(lattice, width, strain_rate, SMOOTH)
    columns = program.columns(preset, tube)
    steps = round(1 / (strain_rate * SAMPLES_PER_PERIOD * tube.time_step))
    course = own.run(tube, own.pack(tube, VOLUME_FRACTION, "rest", SEED), PERIODS * SAMPLES_PER_PERIOD, steps)
    frames = range(1, len(course.frames))
    values = {
        "flow_rate_ratio": [flow_rate_ratio(course, frame) for frame in frames],
        "granular_temperature": [granular_temperature(course.velocities[frame]) for frame in frames],
        "contacts": [contact_number(tube, course.positions[frame], course.time(frame)) for frame in frames],
        "escaped": [float(np.sum(~inside(tube, course.positions[frame], course.time(frame)))) for frame in frames],
    }
    return {name: float(np.max(np.abs(np.array(series) - columns[name]))) for name, series in values.items()}


def measure(own: OwnTube, program: Program, store: Store) -> dict[str, dict[str, float]]:
    """By preset and column."""
    return {preset: store.get(NAME, preset, lambda: differences(preset, own, program)) for preset in LATTICES}
