"""Observables against values found by hand, and against all pairs."""

from dataclasses import replace

import numpy as np
import pytest
from laws import Linear
from observables import Observed, contact_number, flow_rate_ratio, granular_temperature, inside, rotational_energy
from tubes import COARSE, COLUMNS, Array, Course, Tube

TUBE = Tube(replace(COARSE, waves=2), 2.75, 0.05, Linear(0.0))


def course(places: list[Array]) -> Course:
    frames = np.zeros((len(places), len(places[0]), 9))
    frames[:, :, 0:3] = places
    return Course(TUBE, 1.0, frames)


def test_grains_that_move_with_the_wave_are_jmax() -> None:
    before = np.array([[0.0, 0.0, 0.2], [0.5, 0.0, 7.0]])
    # The wave runs towards -z by 0.5 in a unit of time; the first grain passes the seam.
    after = before - [0, 0, 0.5]
    after[:, 2] %= TUBE.lattice.length
    assert flow_rate_ratio(course([before, after]), 1) == pytest.approx(1.0)
    assert flow_rate_ratio(course([after, before]), 1) == pytest.approx(-1.0)


def test_the_escaped_and_the_lost_do_not_count() -> None:
    before = np.array([[0.0, 0.0, 5.0], [3.0, 0.0, 5.0], [0.0, 0.0, 9.0]])
    after = before - [0, 0, 0.25]
    after[2] = np.nan
    assert list(inside(TUBE, after, 1.0)) == [True, False, False]
    assert flow_rate_ratio(course([before, after]), 1) == pytest.approx(0.5)
    assert Observed.of(course([before, after]), 0).escaped == 2


def test_a_grain_escapes_half_a_diameter_beyond_the_wall() -> None:
    # Where the wave is 0, R = a.
    assert list(inside(TUBE, np.array([[1.999, 0.0, 0.0], [2.001, 0.0, 0.0]]), 0.0)) == [True, False]


def test_temperature_and_rotation() -> None:
    assert granular_temperature(np.array([[1.0, 0, 0], [-1.0, 0, 0]])) == pytest.approx(1 / 3)
    assert rotational_energy(np.array([[2.0, 0, 0], [0, 0, 0]])) == pytest.approx(0.1)


def test_contacts_against_all_pairs() -> None:
    generator = np.random.default_rng(3)
    places = np.c_[generator.uniform(-1, 1, (60, 2)), generator.uniform(0, 20, 60)]
    wall, _ = TUBE.wall(0.7)

    def touching(some: Array, others: Array) -> int:
        apart = some[:, None] - others[None]
        apart[:, :, 2] -= 20 * np.round(apart[:, :, 2] / 20)
        return int(np.sum(np.sum(apart**2, axis=2) < 1))

    expected = (touching(places, places) - 60 + touching(places, wall)) / 60
    assert expected > 3
    assert contact_number(TUBE, places, 0.7) == pytest.approx(expected)


def test_the_wall_stands_on_its_wave_and_moves_with_it() -> None:
    places, velocities = TUBE.wall(0.3)
    distance = np.hypot(places[:, 0], places[:, 1])
    assert distance == pytest.approx(TUBE.radius(places[:, 2], 0.3))
    later, _ = TUBE.wall(0.3 + 1e-6)
    assert (later - places) / 1e-6 == pytest.approx(velocities, abs=1e-7)
    assert distance.min() == pytest.approx(TUBE.width / 2, abs=1e-2)


def test_a_grain_that_left_the_box_is_forgotten_from_then_on() -> None:
    frames = np.zeros((3, 2, COLUMNS))
    tube = Tube(COARSE, 2.75, 0.02)
    frames[1, 1, 0] = 1.01 * tube.half_box
    kept = Course(tube, 1.0, frames).in_box()
    assert not np.isnan(kept.frames[:, 0]).any() and not np.isnan(kept.frames[0]).any()
    assert np.isnan(kept.frames[1:, 1]).all()
    assert not np.isnan(frames).any()
