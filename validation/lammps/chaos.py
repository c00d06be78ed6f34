"""How two runs of one initial state part: the programs from each other, and each from itself a little moved."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial

import lammps_tube
import numpy as np
from laws import Law, Linear
from own_tube import OwnTube
from store import Store
from tubes import COARSE, FINE, Array, Grains, Tube

NAME = "chaos"
# Size of a grain's first displacement, of each component.
NUDGE = 1e-12
# A difference grows as exp(growth t) between these sizes [d].
LEAST, LARGEST = 1e-10, 1e-3
# When the first difference is looked at [t], and the distance at which two runs have parted [d].
EARLY, APART = 8.0, 0.1
# Between frames [t].
INTERVAL = 0.4
PAIRS = {
    "between": "peristalsis and LAMMPS",
    "ours": "peristalsis, moved by 1e-12",
    "theirs": "LAMMPS, moved by 1e-12",
}


@dataclass(frozen=True)
class Case:
    """From rest, 203 grains."""

    name: str
    title: str
    tube: Tube
    duration: float

    @property
    def frames(self) -> int:
        return round(self.duration / INTERVAL)

    @property
    def steps(self) -> int:
        return round(INTERVAL / self.tube.time_step)

    @property
    def times(self) -> Array:
        return np.arange(self.frames + 1, dtype=float) * INTERVAL


    @classmethod
    def coarse(cls, name: str, title: str, law: Law, duration: float, time_step: float = 0.05) -> Case:
        return cls(name, title, Tube(COARSE, 2.75, 0.05, law, time_step), duration)

    @classmethod
    def fine(cls, name: str, title: str, law: Law, duration: float) -> Case:
        return cls(name, title, Tube(FINE, 2.7, 0.1, law), duration)


UNDAMPED, DAMPED = Linear(0.0), Linear(5.48e-3)
CASES = [
    Case.coarse("coarse-undamped", "coarse, no damping", UNDAMPED, 160.0),
    Case.fine("fine-undamped", "fine, no damping", UNDAMPED, 120.0),
    Case.coarse("coarse-damped", "coarse, damped", DAMPED, 160.0),
    Case.coarse("coarse-damped-short", "coarse, damped, step 0.005", DAMPED, 120.0, 0.005),
]
QUICK_CASES = ("coarse-undamped",)
SEEDS, QUICK_SEEDS = 10, 3
VOLUME_FRACTION = 0.15


def part(case: Case, seed: int, own: OwnTube) -> dict[str, list[float]]:
    """Root mean square distance of the grains of two runs against time, by pair."""
    grains = own.pack(case.tube, VOLUME_FRACTION, "rest", seed)
    nudges = NUDGE * np.random.default_rng(seed).standard_normal((grains.number, 3))
    values = grains.values.copy()
    values[:, 0:3] += nudges
    moved = Grains(values)
    length = case.tube.lattice.length
    ours = own.run(case.tube, grains, case.frames, case.steps).positions
    ours_moved = own.run(case.tube, moved, case.frames, case.steps).positions
    theirs = lammps_tube.run(case.tube, grains, case.frames, case.steps).positions
    theirs_moved = lammps_tube.run(case.tube, moved, case.frames, case.steps).positions
    return {
        "between": _distance(ours, theirs, length),
        "ours": _distance(ours, ours_moved, length),
        "theirs": _distance(theirs, theirs_moved, length),
    }


def measure(cases: list[Case], seeds: int, own: OwnTube, store: Store) -> dict[str, list[dict[str, list[float]]]]:
    """By case and seed."""
    return {
        case.name: [
            store.get(NAME, f"{case.name}-{seed}", partial(part, case, seed, own)) for seed in range(1, seeds + 1)
        ]
        for case in cases
    }


def _distance(some: Array, others: Array, length: float) -> list[float]:
    apart = some - others
    apart[:, :, 2] -= length * np.round(apart[:, :, 2] / length)
    return [float(value) for value in np.sqrt(np.nanmean(np.sum(apart**2, axis=2), axis=1))]


def growth_rate(times: Array, distances: Array) -> float | None:
    """Slope of the straight line through the logarithms of a distance while it is between `LEAST` and `LARGEST`, for the
    last time below the one to the first time above the other; none where it begins far above the one."""
    above = np.flatnonzero(distances > LARGEST)
    last = above[0] if len(above) else len(distances)
    below = np.flatnonzero(distances[:last] < LEAST)
    first = below[-1] + 1 if len(below) else 0
    if last - first < 10 or distances[first] > 10 * LEAST:
        return None
    return float(np.polyfit(times[first:last], np.log(distances[first:last]), 1)[0])


def as_array(distances: list[float]) -> Array:
    return np.array(distances)


def typical(runs: list[list[float]], time: float) -> float:
    """Geometric mean of the distance at a time."""
    frame = round(time / INTERVAL)
    return float(np.exp(np.mean([np.log(run[frame]) for run in runs])))


def parting_time(case: Case, runs: list[list[float]]) -> float:
    """Mean of the first times at which two runs are `APART` apart."""
    return float(np.mean([case.times[np.argmax(np.array(run) > APART)] for run in runs]))


@dataclass(frozen=True)
class Growth:
    """Mean growth rate over the seeds, its standard error, and how many seeds there are."""

    mean: float
    error: float
    seeds: int

    @classmethod
    def of(cls, rates: list[float]) -> Growth:
        return cls(float(np.mean(rates)), float(np.std(rates, ddof=1) / np.sqrt(len(rates))), len(rates))
