"""Observables as docs/book/src/reference/conventions.md defines them, from places and velocities alone: the same function for both programs."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from tubes import Array, Course, Tube

# Grains have mass and diameter 1, and I = m d^2/10.
INERTIA = 0.1
# Contacts are counted in a frame of so many.
EVERY = 5


@dataclass(frozen=True)
class Observed:
    """Means over a stretch of a run."""

    flow_rate_ratio: float
    granular_temperature: float
    contacts: float
    rotational_energy: float
    # Mean y of the grains.
    height: float
    # The largest number seen.
    escaped: float

    @classmethod
    def of(cls, course: Course, first: int) -> Observed:
        """From frame `first` to the last."""
        later = range(first + 1, len(course.frames))
        contacts = [contact_number(course.tube, course.positions[frame], course.time(frame)) for frame in later[::EVERY]]
        return cls(
            float(np.mean([flow_rate_ratio(course, frame) for frame in later])),
            float(np.mean([granular_temperature(course.velocities[frame]) for frame in later])),
            float(np.mean(contacts)),
            float(np.mean([rotational_energy(course.spins[frame]) for frame in later])),
            float(np.mean([np.nanmean(course.positions[frame][:, 1]) for frame in later])),
            float(max(np.sum(~inside(course.tube, course.positions[frame], course.time(frame))) for frame in later)),
        )


def inside(tube: Tube, positions: Array, time: float) -> npt.NDArray[np.bool_]:
    """Grains whose centre is not beyond R + d/2; a lost grain is outside."""
    distance = np.hypot(positions[:, 0], positions[:, 1])
    return distance <= tube.radius(positions[:, 2], time) + 0.5


def flow_rate_ratio(course: Course, frame: int) -> float:
    """J/Jmax in the interval that ends with a frame: sum of dz/dt over the grains inside at its end, along the wave, over
    N c. A grain moves by less than half the tube in an interval."""
    here = inside(course.tube, course.positions[frame], course.time(frame))
    moved = course.positions[frame, here, 2] - course.positions[frame - 1, here, 2]
    length = course.tube.lattice.length
    moved -= length * np.round(moved / length)
    return float(-np.mean(moved) / (course.tube.wave_speed * course.interval))


def granular_temperature(velocities: Array) -> float:
    """sum |v - <v>|^2/(3 N) of all grains."""
    velocities = velocities[~np.isnan(velocities).any(axis=1)]
    return float(np.sum((velocities - velocities.mean(axis=0)) ** 2) / (3 * len(velocities)))


def rotational_energy(spins: Array) -> float:
    """Mean I omega^2/2 of a grain."""
    return float(np.nanmean(np.sum(spins**2, axis=1)) * INERTIA / 2)


def contact_number(tube: Tube, positions: Array, time: float) -> float:
    """Contacts of a grain, wall included; a contact of two grains counts for both."""
    positions = positions[~np.isnan(positions).any(axis=1)]
    wall, _ = tube.wall(time)
    among_grains = len(_touching(positions, positions, tube.lattice.length)) - len(positions)
    with_wall = len(_touching(positions, wall, tube.lattice.length))
    return (among_grains + with_wall) / len(positions)


def _touching(some: Array, others: Array, length: float) -> Array:
    """Pairs of numbers of spheres nearer than a diameter, z periodic; `others` may be `some`, each then touches itself."""
    order = np.argsort(others[:, 2] % length)
    others = others[order]
    z = others[:, 2] % length
    # Once more beyond both ends, so that a window of z never wraps.
    padded = np.concatenate([z - length, z, z + length])
    low = np.searchsorted(padded, some[:, 2] % length - 1.0)
    high = np.searchsorted(padded, some[:, 2] % length + 1.0)
    one = np.repeat(np.arange(len(some)), high - low)
    other = np.concatenate([np.arange(*pair) for pair in zip(low, high, strict=True)]) % len(z)
    apart = some[one] - others[other]
    apart[:, 2] -= length * np.round(apart[:, 2] / length)
    near = np.sum(apart**2, axis=1) < 1.0
    return np.stack([one[near], order[other[near]]], axis=1)
