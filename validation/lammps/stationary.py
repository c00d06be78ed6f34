"""Statistics of the flow: J/Jmax, granular temperature and contacts, from independent packings in each program."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import asdict, dataclass
from functools import partial

import lammps_tube
import numpy as np
from laws import Friction, Hertz, Law, Linear, Rolling
from observables import Observed
from own_tube import OwnTube
from start_files import Lattice
from store import Store
from tubes import COARSE, FINE, Course, Tube

NAME, FRICTIONAL_NAME, GRAVITY_NAME = "stationary", "friction", "gravity"
ROLLING_NAME, COHESION_NAME, JKR_NAME = "rolling", "cohesion", "jkr"
SAMPLES_PER_PERIOD = 20
OURS, THEIRS = "peristalsis", "LAMMPS"
# No packing is used twice: the programs' samples are independent.
FIRST_SEED = {OURS: 1, THEIRS: 1001}
SMOOTH = Linear(5.48e-3)
FRICTIONAL = Linear(0.0, Friction(0.3, 0.5))
ROLLING = Linear(0.0, Friction(0.3, 0.5), Rolling(0.3, 0.1))
# A constant pull, the cohesion that both programs have alike to the end of a contact.
COHESIVE = Hertz(0.0, cohesion_force=1e-3)
ADHESIVE = Hertz(0.0, surface_energy=1e-3)
ADHESIVE_FRICTIONAL = Hertz(0.0, Friction(1.0, 0.5), surface_energy=1e-3)
FRICTIONAL_HERTZ = Hertz(0.15, Friction(1.0, 0.5))
VOLUME_FRACTION = 0.15
# A round is one run of LAMMPS and four of ours at each point. Slow ones take two rounds, some minutes each.
ROUNDS, SLOW_ROUNDS, QUICK_ROUNDS = 6, 2, 2
# Rounds of cohesion by a constant pull.
PULL_ROUNDS = 8
RUNS_OF_A_ROUND = {OURS: 4, THEIRS: 1}


@dataclass(frozen=True)
class Point:
    """Where, from what state, and over which periods the means are taken."""

    group: str
    lattice: Lattice
    strain_rate: float
    width: float
    start: str
    first_period: int
    last_period: int
    law: Law
    # At most so many rounds of runs.
    most_rounds: int
    gravity: tuple[float, float, float] = (0.0, 0.0, 0.0)

    @property
    def name(self) -> str:
        return f"{self.group}-{self.strain_rate:g}-{self.width:g}-{self.start}"

    @property
    def title(self) -> str:
        where = f"{self.group}, {self.strain_rate:g}, w {self.width:g}"
        return f"{where}, {self.start}, {self.first_period} – {self.last_period}"

    @property
    def tube(self) -> Tube:
        return Tube(self.lattice, self.width, self.strain_rate, self.law, gravity=self.gravity)


def _line(
    group: str,
    lattice: Lattice,
    law: Law,
    strain_rate: float,
    periods: tuple[int, int],
    starts: dict[str, tuple[float, ...]],
    most_rounds: int = ROUNDS,
) -> list[Point]:
    """Points of one lattice, law and strain rate, by the state that they start from."""
    return [
        Point(group, lattice, strain_rate, width, start, *periods, law, most_rounds)
        for start, widths in starts.items()
        for width in widths
    ]


# On both sides of the transition. From rest the jams of w = 2.8 take up to 60 periods to form; those of the fine lattice
# at 2.7 and 2.75 take longer than these runs, and start jammed.
POINTS = [
    *_line("coarse", COARSE, SMOOTH, 0.05, (40, 80), {"rest": (2.6, 2.7, 2.75)}),
    *_line("coarse", COARSE, SMOOTH, 0.05, (120, 160), {"rest": (2.8,)}),
    *_line("coarse", COARSE, SMOOTH, 0.05, (40, 80), {"rest": (2.85, 2.9)}),
    *_line("fine", FINE, SMOOTH, 0.1, (40, 100), {"rest": (2.5, 2.6), "jammed": (2.7, 2.75)}),
    *_line("fine", FINE, SMOOTH, 0.1, (40, 100), {"rest": (2.85, 2.95)}),
]
# The same in a coarse tube with friction between all spheres.
FRICTIONAL_POINTS = [
    *_line("linear", COARSE, FRICTIONAL, 0.02, (6, 20), {"jammed": (2.0,), "rest": (2.75,)}),
    *_line("linear", COARSE, FRICTIONAL, 0.002, (3, 8), {"jammed": (2.0,), "rest": (2.75,)}, SLOW_ROUNDS),
    *_line("hertz", COARSE, FRICTIONAL_HERTZ, 0.005, (4, 10), {"jammed": (2.2,), "rest": (2.75,)}),
]
# y points upwards, and the wave runs towards -z. Tubes that grains leave would tell of how long these are followed.
GRAVITY_POINTS = [
    Point("lying-frictionless", FINE, 0.1, 2.6, "rest", 40, 100, SMOOTH, ROUNDS, (0.0, -0.01, 0.0)),
    Point("uphill-frictionless", FINE, 0.1, 2.6, "rest", 40, 100, SMOOTH, ROUNDS, (0.0, 0.0, 0.002)),
    Point("lying-frictional", COARSE, 0.02, 2.75, "rest", 6, 20, FRICTIONAL, ROUNDS, (0.0, -0.004, 0.0)),
    Point("oblique-frictional", COARSE, 0.02, 2.75, "rest", 6, 20, FRICTIONAL, ROUNDS, (0.002, -0.003, 0.001)),
]
ROLLING_POINTS = [
    Point("rolling", COARSE, 0.02, 2.75, "rest", 6, 20, ROLLING, ROUNDS),
    Point("rolling", COARSE, 0.05, 2.6, "jammed", 6, 20, ROLLING, ROUNDS),
]
COHESION_POINTS = [
    Point("pull", COARSE, 0.02, 2.75, "rest", 6, 20, COHESIVE, PULL_ROUNDS),
    Point("pull", COARSE, 0.05, 2.6, "jammed", 6, 20, COHESIVE, PULL_ROUNDS),
]
JKR_POINTS = [
    Point("frictionless", COARSE, 0.02, 2.75, "rest", 6, 20, ADHESIVE, ROUNDS),
    Point("frictionless", COARSE, 0.05, 2.6, "jammed", 6, 20, ADHESIVE, ROUNDS),
    Point("frictional", COARSE, 0.02, 2.75, "rest", 6, 20, ADHESIVE_FRICTIONAL, ROUNDS),
]
QUICK_POINTS = ("coarse-0.05-2.75-rest", "coarse-0.05-2.85-rest")
QUICK_FRICTIONAL_POINTS = ("linear-0.02-2.75-rest",)
QUICK_GRAVITY_POINTS = ("lying-frictional-0.02-2.75-rest",)
COMPARED = {
    "flow_rate_ratio": "J/Jmax",
    "granular_temperature": "granular temperature",
    "contacts": "contacts",
}
# What the slip velocity decides, which LAMMPS reads differently.
READ_DIFFERENTLY = "rotational_energy"
COMPARED_WITH_FRICTION = COMPARED | {"rotational_energy": "rotational energy"}
COMPARED_IN_GRAVITY = COMPARED | {"height": "mean height y"}


def observe(point: Point, program: str, seed: int, own: OwnTube) -> dict[str, float]:
    """One run of one program."""
    steps = round(1 / (point.strain_rate * SAMPLES_PER_PERIOD * point.tube.time_step))
    frames = point.last_period * SAMPLES_PER_PERIOD
    grains = own.pack(point.tube, VOLUME_FRACTION, point.start, seed)
    run: Callable[..., Course] = own.run if program == OURS else lammps_tube.run
    course = run(point.tube, grains, frames, steps).in_box()
    return asdict(Observed.of(course, point.first_period * SAMPLES_PER_PERIOD))


def measure(points: list[Point], rounds: int, own: OwnTube, store: Store) -> dict[str, dict[str, list[dict[str, float]]]]:
    """All runs by point and program, round by round, so that every point has some early."""
    found: dict[str, dict[str, list[dict[str, float]]]] = {point.name: {OURS: [], THEIRS: []} for point in points}
    for turn in range(rounds):
        for point in points:
            if turn >= point.most_rounds:
                continue
            for program, runs in RUNS_OF_A_ROUND.items():
                for run in range(runs):
                    seed = FIRST_SEED[program] + turn * runs + run
                    name = f"{point.name}-{program}-{seed}"
                    result = store.get(NAME, name, partial(observe, point, program, seed, own))
                    found[point.name][program].append(result)
    return found


@dataclass(frozen=True)
class Comparison:
    """One observable at one point: means with standard errors, and their difference over its error.

    The errors are those of one scatter from seed to seed, of both programs together: that both have the same is what is
    asked.
    """

    point: Point
    observable: str
    ours: float
    our_error: float
    theirs: float
    their_error: float

    @property
    def deviation(self) -> float:
        return (self.ours - self.theirs) / math.hypot(self.our_error, self.their_error)


def compare(point: Point, observable: str, ours: list[float], theirs: list[float]) -> Comparison:
    """Of the values of each seed."""
    squares = sum(float(np.sum((np.array(values) - np.mean(values)) ** 2)) for values in (ours, theirs))
    scatter = math.sqrt(squares / (len(ours) + len(theirs) - 2))
    return Comparison(
        point,
        observable,
        float(np.mean(ours)),
        scatter / math.sqrt(len(ours)),
        float(np.mean(theirs)),
        scatter / math.sqrt(len(theirs)),
    )
