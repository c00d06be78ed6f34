"""Single collisions, in both programs with shorter and shorter steps, and by a method of order 4."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import partial

import lammps_tube
import numpy as np
import two_grains
from laws import Friction, Hertz, Law, Linear, Rolling
from own_tube import OwnTube
from store import Store
from tubes import COARSE, EMPTY, Array, Grains, Tube

NAME = "collisions"
TOLERANCE = 1e-6
STEPS = (0.05, 0.02, 0.01, 1e-3, 1e-4, 1e-5, 2e-6)
# No axis of the collision is one of the coordinates.
TURN = np.linalg.qr(np.array([[1.0, 2.0, 0.5], [-0.3, 1.0, 1.7], [0.8, -0.6, 1.0]]))[0]
# Speeds, and so overlaps, at which the place where slip velocities are taken makes no difference.
TINY = 3e-7
STICKY, SLIPPERY = Friction(0.3, 5.0), Friction(0.3, 0.1)


@dataclass(frozen=True)
class Case:
    """Two grains, or one and the wall; `speed` is what differences are relative to."""

    name: str
    title: str
    tube: Tube
    grains: Grains
    speed: float
    duration: float
    least_step: float = 2e-6

    @property
    def with_wall(self) -> bool:
        return self.tube.lattice is not EMPTY

    @property
    def has_reference(self) -> bool:
        """Whether the method of order 4 knows what comes of it."""
        return not self.with_wall and self.tube.law.is_plain

    @property
    def steps(self) -> list[float]:
        return [step for step in STEPS if step >= self.least_step]

    def reference(self, reading: two_grains.Reading, quick: bool) -> Array:
        """Velocities and spins as the grains part, of two by themselves."""
        step = 4e-3 if quick else 1e-3 if isinstance(self.tube.law, Hertz) else 5e-4
        return two_grains.collide(self.grains, self.tube.law, step, reading).values[:, 3:]


def _pair(
    name: str, title: str, law: Law, offset: float, speed: float, spin: Array | float = 0.0, **more: float
) -> Case:
    """Two grains that touch, with velocities against each other, their lines `offset` apart."""
    second = np.array([offset, 0.0, np.sqrt(1 - offset**2)])
    velocity = np.array([0.0, 0.0, speed])
    axis = np.array([0.2, -1.0, 0.3])
    # Near the origin, where rounding of places is small beside the overlaps.
    positions = np.array([-second / 2, second / 2]) @ TURN + [0, 0, 1]
    spins = np.array([spin * axis, 0.4 * spin * axis]) @ TURN
    grains = Grains.of(positions, np.array([velocity, -velocity]) @ TURN, spins)
    tube = Tube(EMPTY, 2 * EMPTY.radius, 0.0, law)
    soft = isinstance(law, Hertz)
    settings: dict[str, float] = {"duration": 12.0 if soft else 4.0, "least_step": 1e-5 if soft else 2e-6} | more
    return Case(name, title, tube, grains, speed, **settings)


def _wall(name: str, title: str, strain_rate: float, law: Law, duration: float) -> Case:
    """A grain that flies into the wall."""
    tube = Tube(replace(COARSE, waves=2), 2.75, strain_rate, law)
    speed = 0.1
    grains = Grains.of([[0.45, 0.1, 3.3]], [[0.08, 0.04, 0.0447]])
    return Case(name, title, tube, grains, speed, duration, least_step=1e-5)


CASES = [
    _pair("head-on-0", "head-on, no damping", Linear(0.0), 0.0, 0.1),
    _pair("head-on-1", "head-on, eta 0.00548", Linear(5.48e-3), 0.0, 0.1),
    _pair("head-on-2", "head-on, eta 0.1", Linear(0.1), 0.0, 0.1),
    _pair("head-on-3", "head-on, eta 0.5", Linear(0.5), 0.0, 0.1),
    _pair("oblique", "oblique at 30 degrees, eta 0.1", Linear(0.1), 0.5, 0.1),
    _wall("wall-static", "on the wall at rest, eta 0.1", 0.0, Linear(0.1), 12.0),
    _wall("wall-moving", "on the moving wall, twice, eta 0.00548", 0.05, Linear(5.48e-3), 20.0),
    _pair("hertz", "Hertz, head-on, B 0.15", Hertz(0.15), 0.0, 0.05),
    _pair("hertz-oblique", "Hertz, oblique, B 0.15", Hertz(0.15), 0.5, 0.05),
    _pair("stick", "friction, sticks, tiny overlap", Linear(0.0, STICKY), 0.5, TINY, TINY),
    _pair("slip", "friction, slides, tiny overlap", Linear(0.0, SLIPPERY), 0.5, TINY, TINY),
    _pair("stick-large", "friction, sticks, overlap 0.06", Linear(0.0, STICKY), 0.5, 0.1, 0.1),
    _pair("slip-damped", "friction, slides, tiny overlap, eta 0.1", Linear(0.1, SLIPPERY), 0.5, TINY, TINY),
    _pair("hertz-friction", "Hertz with friction, B 0.15, k_t 1, mu 0.5", Hertz(0.15, Friction(1.0, 0.5)), 0.5, 0.02, 0.05),
    _pair("rolling", "friction and rolling resistance, tiny overlap", Linear(0.0, STICKY, Rolling(0.2, 0.05)), 0.5, TINY, TINY),
    _pair("pull", "Hertz with a constant pull (DMT), oblique", Hertz(0.0, cohesion_force=1e-3), 0.5, 0.05, duration=24.0),
    _pair("jkr", "JKR, oblique, sticks", Hertz(0.0, surface_energy=1e-3), 0.5, 0.001, duration=24.0),
    _pair("jkr-parts", "JKR, oblique, parts", Hertz(0.0, surface_energy=1e-3), 0.5, 0.1, duration=24.0),
]
QUICK_LEAST_STEP, QUICK_TOLERANCE = 1e-4, 5e-5


# Values of a case: velocities and spins afterwards, by program (or the method of order 4, as read by it) and step.
Found = dict[str, dict[str, list[list[float]]]]
READINGS = {"ours": two_grains.OURS, "theirs": two_grains.LAMMPS}
REFERENCE = "reference"


def collide(case: Case, least_step: float, own: OwnTube) -> Found:
    """One case, step by step."""
    found: Found = {"ours": {}, "theirs": {}}
    for step in case.steps:
        if step < least_step:
            continue
        tube = replace(case.tube, time_step=step)
        number = round(case.duration / step)
        ours = own.run(tube, case.grains, 1, number).frames[1, :, 3:]
        theirs = lammps_tube.run(tube, case.grains, 1, number, case.with_wall).frames[1, :, 3:]
        found["ours"][repr(step)] = ours.tolist()
        found["theirs"][repr(step)] = theirs.tolist()
    if case.has_reference:
        quick = least_step >= QUICK_LEAST_STEP
        found[REFERENCE] = {program: case.reference(reading, quick).tolist() for program, reading in READINGS.items()}
    return found


def measure(cases: list[Case], least_step: float, own: OwnTube, store: Store) -> dict[str, Found]:
    """By case."""
    return {
        case.name: store.get(NAME, f"{case.name}-{least_step:g}", partial(collide, case, least_step, own))
        for case in cases
    }


@dataclass(frozen=True)
class Outcome:
    """Differences of a case relative to its speed, at the shortest step."""

    case: Case
    step: float
    # Relative velocity afterwards over that before.
    rebound: float
    between: float
    # From the method of order 4 with the law as each program reads it, and between the two readings; of two grains.
    ours: float | None = None
    theirs: float | None = None
    readings: float | None = None

    @property
    def agrees(self) -> bool:
        """With each other, or, where they read the law differently, each with its own."""
        same = self.readings is None or self.readings < TOLERANCE
        differences = [self.between] if same else [self.ours or 0.0, self.theirs or 0.0]
        return max(differences) < (TOLERANCE if self.step < QUICK_LEAST_STEP else QUICK_TOLERANCE)

    @classmethod
    def of(cls, case: Case, found: Found) -> Outcome:
        step = min(found["ours"], key=float)
        ours, theirs = (np.array(found[program][step]) for program in ("ours", "theirs"))

        def apart(some: Array, others: Array) -> float:
            return float(np.max(np.abs(some - others)) / case.speed)

        outcome = cls(case, float(step), _relative(ours) / _relative(case.grains.values[:, 3:]), apart(ours, theirs))
        if not case.has_reference:
            return outcome
        as_ours, as_theirs = (np.array(found[REFERENCE][program]) for program in READINGS)
        return replace(
            outcome, ours=apart(ours, as_ours), theirs=apart(theirs, as_theirs), readings=apart(as_ours, as_theirs)
        )


def _relative(values: Array) -> float:
    """Speed of the grains against each other, or of one grain."""
    return float(np.linalg.norm(values[-1, 0:3] - (values[0, 0:3] if len(values) > 1 else 0.0)))


def errors(case: Case, found: Found, program: str) -> tuple[Array, Array]:
    """Steps, and the relative differences from the method of order 4 with the law as the program reads it."""
    reference = np.array(found[REFERENCE][program])
    steps = sorted(found[program], key=float)
    differences = [np.max(np.abs(np.array(found[program][step]) - reference)) / case.speed for step in steps]
    return np.array([float(step) for step in steps]), np.array(differences)
