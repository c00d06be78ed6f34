"""Two grains by themselves, integrated to rounding by a method of order 4: what both programs must come to.

Independent of both: it knows the laws of `laws.py` only. What LAMMPS does otherwise with friction can be chosen, so that a
difference between the programs can be traced to it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from laws import REDUCED_RADIUS, Hertz, Law
from tubes import Array, Grains

# Position, velocity and angular velocity of both, and the tangential spring.
SPRING = 18
INERTIA = 0.1


@dataclass(frozen=True)
class Reading:
    """How friction is read."""

    # Slip velocities from spins times the radius, as LAMMPS has it, instead of times the distance to the plane of contact.
    slip_at_radius: bool = False
    # A contact that pulls has friction too, up to mu |f_n|.
    pulling_friction: bool = False


OURS = Reading()
LAMMPS = Reading(slip_at_radius=True, pulling_friction=True)


def collide(grains: Grains, law: Law, step: float, reading: Reading = OURS) -> Grains:
    """The two as they part; they must touch, or nearly, and approach.

    Extrapolated from a step and half of it, for friction that begins to slide within a step leaves an error of order 1.
    """
    coarse, fine = (_parted(grains, law, length, reading).values for length in (step, 0.5 * step))
    return Grains(2 * fine - coarse)


def _parted(grains: Grains, law: Law, step: float, reading: Reading) -> Grains:
    state = np.concatenate([grains.values.ravel(), np.zeros(3)])
    state = _advance(state, law, step, reading)
    while _distance(after := _advance(state, law, step, reading)) < 1.0:
        state = after
    # The step in which they part ends where they do.
    low, high = 0.0, step
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if _distance(_advance(state, law, middle, reading)) < 1.0 else (low, middle)
    return Grains(_advance(state, law, high, reading)[:SPRING].reshape(2, 9))


def _distance(state: Array) -> float:
    return float(np.linalg.norm(state[0:3] - state[9:12]))


def _advance(state: Array, law: Law, step: float, reading: Reading) -> Array:
    """A step of Runge and Kutta; then a spring longer than friction can hold slides."""
    one, _ = _rate(state, law, reading)
    two, _ = _rate(state + 0.5 * step * one, law, reading)
    three, _ = _rate(state + 0.5 * step * two, law, reading)
    four, _ = _rate(state + step * three, law, reading)
    after = state + step / 6 * (one + 2 * two + 2 * three + four)
    _, longest = _rate(after, law, reading)
    length = np.linalg.norm(after[SPRING:])
    if length > longest:
        after[SPRING:] *= longest / length
    return after


def _rate(state: Array, law: Law, reading: Reading) -> tuple[Array, float]:
    """Time derivative of the state, and how long the tangential spring may be."""
    grains = state[:SPRING].reshape(2, 9)
    apart = grains[0, 0:3] - grains[1, 0:3]
    distance = np.linalg.norm(apart)
    normal = apart / distance
    overlap = 1.0 - distance
    velocity = grains[0, 3:6] - grains[1, 3:6]
    normal_velocity = float(velocity @ normal)
    pressing = _normal_force(law, float(overlap), normal_velocity)
    rate = np.zeros_like(state)
    rates = rate[:SPRING].reshape(2, 9)
    rates[:, 0:3] = grains[:, 3:6]
    force, longest = pressing * normal, 0.0
    if law.friction is not None:
        lever = 0.5 * (1.0 - overlap)
        slip_lever = 0.5 if reading.slip_at_radius else lever
        lateral = velocity - normal_velocity * normal
        slip = lateral + np.cross(normal, slip_lever * (grains[0, 6:9] + grains[1, 6:9]))
        spring = state[SPRING:]
        rate[SPRING:] = slip - (spring @ lateral) / distance * normal
        bound = law.friction.coefficient * (abs(pressing) if reading.pulling_friction else max(pressing, 0.0))
        longest = bound / law.friction.stiffness
        length = float(np.linalg.norm(spring))
        cut = min(1.0, longest / length) if length > 0.0 else 0.0
        held = -law.friction.stiffness * cut * spring
        force = force + held
        rates[:, 6:9] = -lever * np.cross(normal, held) / INERTIA
    rates[0, 3:6], rates[1, 3:6] = force, -force
    return rate, longest


def _normal_force(law: Law, overlap: float, normal_velocity: float) -> float:
    """While they touch, and as a smooth continuation a step beyond."""
    if isinstance(law, Hertz):
        root = law.modulus * np.sqrt(REDUCED_RADIUS * max(overlap, 0.0))
        return max(float(root * (overlap - law.relaxation_time * normal_velocity)), 0.0)
    return overlap - law.damping * normal_velocity
