"""What the tests share."""

import matplotlib
import pytest

import peristalsis

matplotlib.use("Agg")


@pytest.fixture
def small() -> peristalsis.Simulation:
    """A tube of two waves, a millisecond a period."""
    return peristalsis.Simulation.preset("frictionless", width=2.6, strain_rate=0.1, seed=1, waves=2)
