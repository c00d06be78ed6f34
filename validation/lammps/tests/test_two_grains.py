"""The method of order 4 against what is known in closed form."""

import math

import numpy as np
import pytest
from laws import Friction, Hertz, Law, Linear
from tubes import Grains
from two_grains import LAMMPS, OURS, collide

STEP = 5e-3


def touching(offset: float, speed: float, spin: float = 0.0) -> Grains:
    second = [offset, 0.0, math.sqrt(1 - offset**2)]
    spins = [[0, spin, 0.2 * spin], [0, -0.3 * spin, 0]]
    return Grains.of([[0, 0, 0], second], [[0, 0, speed], [0, 0, -speed]], spins)


@pytest.mark.parametrize("damping", [0.0, 5.48e-3, 0.1, 0.5])
def test_restitution_of_the_linear_law(damping: float) -> None:
    after = collide(touching(0.0, 0.1), Linear(damping), STEP)
    expected = math.exp(-math.pi * damping / math.sqrt(2 - damping**2))
    assert -after.values[0, 5] / 0.1 == pytest.approx(expected, abs=1e-9)


def test_the_printed_viscoelastic_law_at_a_tenth() -> None:
    """docs/verification.md, section 3: 0.90256 at v = 0.1 with 3/2 A = 0.15."""
    after = collide(touching(0.0, 0.05), Hertz(0.15), STEP)
    assert -after.values[0, 5] / 0.05 == pytest.approx(0.90256, abs=5e-6)


@pytest.mark.parametrize("law", [Linear(0.0, Friction(0.3, 0.3)), Hertz(0.15, Friction(1.0, 0.5))])
def test_momentum_and_angular_momentum_stay(law: Law) -> None:
    before = touching(0.5, 0.05, 0.05)
    after = collide(before, law, STEP)

    def momenta(grains: Grains) -> np.ndarray:
        places, velocities, spins = np.split(grains.values, 3, axis=1)
        return np.array([velocities.sum(axis=0), (np.cross(places, velocities) + 0.1 * spins).sum(axis=0)])

    assert momenta(after) == pytest.approx(momenta(before), abs=1e-9)
    assert np.abs(after.values[:, 6:] - before.values[:, 6:]).max() > 1e-2


def test_readings_of_friction_differ_by_the_overlap() -> None:
    law = Linear(0.0, Friction(0.3, 0.3))

    def difference(speed: float) -> float:
        before = touching(0.5, speed, speed)
        ours, theirs = (collide(before, law, STEP, reading).values[:, 3:] for reading in (OURS, LAMMPS))
        return float(np.abs(ours - theirs).max() / speed)

    large, small = difference(0.02), difference(0.002)
    assert large > 1e-3
    assert 8 < large / small < 12
