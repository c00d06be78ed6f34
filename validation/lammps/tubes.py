"""A tube, and grains in it at one instant, as both programs are given them."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import cache

import numpy as np
import numpy.typing as npt
from laws import Law, Linear
from start_files import Lattice

Array = npt.NDArray[np.float64]
# Numbers of a grain in a frame: position, velocity, angular velocity.
COLUMNS = 9
# Grains that get so far beyond the wall are lost.
MARGIN = 8.0

COARSE = Lattice(radius=1.5, wavelength=10.0, waves=10, spheres_per_ring=12, rings_per_wave=14)
FINE = Lattice(radius=1.5, wavelength=10.0, waves=10, spheres_per_ring=24, rings_per_wave=26)
# So wide that two grains on its axis never meet it.
EMPTY = Lattice(radius=20.0, wavelength=40.0, waves=1, spheres_per_ring=12, rings_per_wave=2)


@dataclass(frozen=True)
class Grains:
    """Grains of mass and diameter 1 at one instant: nine numbers each, position, velocity and angular velocity."""

    values: Array

    @classmethod
    def of(cls, positions: object, velocities: object, spins: object = 0.0) -> Grains:
        positions = np.asarray(positions, float)
        whole = np.broadcast_arrays(positions, np.asarray(velocities, float), np.asarray(spins, float))
        return cls(np.concatenate(whole, axis=1))

    @property
    def number(self) -> int:
        return len(self.values)


@dataclass(frozen=True)
class Tube:
    """A prescribed tube R(z, t) = a + b sin(2 pi (z/lambda + epsdot t)): its wave runs towards -z."""

    lattice: Lattice
    width: float
    strain_rate: float
    law: Law = field(default_factory=lambda: Linear(5.48e-3))
    time_step: float = 0.05
    # The acceleration of every grain by its weight, m d/t^2 a grain.
    gravity: tuple[float, float, float] = (0.0, 0.0, 0.0)

    @property
    def half_box(self) -> float:
        """Half the width of the box that LAMMPS has around the tube."""
        return self.lattice.radius + MARGIN

    @property
    def amplitude(self) -> float:
        return self.lattice.radius - self.width / 2

    @property
    def wave_speed(self) -> float:
        return self.strain_rate * self.lattice.wavelength

    @property
    def frequency(self) -> float:
        return 2 * math.pi * self.strain_rate

    def radius(self, z: Array, time: float) -> Array:
        """Mean radius of the wall at z, to the centres of its spheres."""
        return self.lattice.radius + self.amplitude * np.sin(2 * np.pi * z / self.lattice.wavelength + self.frequency * time)

    def wall(self, time: float) -> tuple[Array, Array]:
        """Places and velocities of the wall's spheres."""
        places = _places(self.lattice)
        phase = 2 * np.pi * places[:, 2] / self.lattice.wavelength + self.frequency * time
        direction = places * [1, 1, 0] / self.lattice.radius
        radius = self.lattice.radius + self.amplitude * np.sin(phase)
        rate = self.amplitude * self.frequency * np.cos(phase)
        return direction * radius[:, None] + places * [0, 0, 1], direction * rate[:, None]


@cache
def _places(lattice: Lattice) -> Array:
    """Of the spheres in the straight tube."""
    return np.array(lattice.places())


@dataclass(frozen=True)
class Course:
    """Frames of a run, equally far apart in time; grains that left the box are NaN."""

    tube: Tube
    interval: float
    frames: Array

    def time(self, frame: int) -> float:
        return frame * self.interval

    def in_box(self) -> Course:
        """Without the grains that have left the box, from then on: LAMMPS loses them, and ours fly on without contacts."""
        left = (np.abs(self.positions[:, :, 0:2]) > self.tube.half_box).any(axis=2)
        frames = self.frames.copy()
        frames[np.logical_or.accumulate(left, axis=0)] = np.nan
        return Course(self.tube, self.interval, frames)

    @property
    def positions(self) -> Array:
        return self.frames[:, :, 0:3]

    @property
    def velocities(self) -> Array:
        return self.frames[:, :, 3:6]

    @property
    def spins(self) -> Array:
        return self.frames[:, :, 6:9]
