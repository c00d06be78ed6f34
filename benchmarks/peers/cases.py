"""The work that is timed."""

from __future__ import annotations

from dataclasses import dataclass, replace


@dataclass(frozen=True)
class Case:
    """A stretch of flow, as both programs are asked for it.

    What is not said here (lattice, forces, time step) LAMMPS is given from the configuration that our program resolves.
    """

    name: str
    title: str
    preset: str
    # Over the preset, for our program; LAMMPS starts from rest always.
    settings: dict[str, str | float]
    # The state changes, and ends, with time: both programs are timed over the same periods from rest, as many seeds as
    # fill the time. Without a number the state is steady, and one long run is timed.
    periods: float | None = None
    quick_periods: float | None = None
    # Periods that LAMMPS runs before it is timed, its growing wave aside.
    warm_up_periods: int = 0
    # LAMMPS starts from so many copies of a shorter tube.
    copies: int = 1
    pair_styles: tuple[str, ...] = ("gran/hooke",)
    # Skin of the neighbour list that LAMMPS is fastest with; it is looked at every fifth step.
    skin: float = 1.2
    # Whether there are grains enough to share out to several cores.
    shared_out: bool = False

    def description(self, quick: bool) -> str:
        """The title, and over which periods."""
        periods = self.quick_periods if quick else self.periods
        if periods is None:
            return self.title
        return f"{self.title}, from rest to period {periods:g}"


COARSE_DENSE: dict[str, str | float] = {
    "grains.volume_fraction": 0.3,
    "drive.width": 2.6,
    "drive.strain_rate": 0.05,
    "initial.state": "jammed",
}

FRICTIONAL = Case(
    name="frictional",
    title="frictional grains, elastic wall 22 x 23, n 0.71, f^P 0.005, strain rate 0.00401, L = 120",
    preset="frictional",
    settings={"drive.force_amplitude": 0.005, "tube.waves": 6, "initial.state": "rest"},
    periods=1,
    quick_periods=0.25,
    pair_styles=("granular", "gran/hertz/history"),
    skin=0.4,
    shared_out=True,
)

CASES = (
    Case(
        name="fine-unjammed",
        title="fine lattice 24 x 26, rho 0.15, w 2.64, strain rate 0.1, L = 100",
        preset="frictionless-fine",
        settings={"drive.width": 2.64, "drive.strain_rate": 0.1},
        periods=20,
        quick_periods=10,
    ),
    Case(
        name="fine-jammed",
        title="fine lattice, rho 0.15, w 2.64, strain rate 0.1, L = 100, jammed",
        preset="frictionless-fine",
        settings={"drive.width": 2.64, "drive.strain_rate": 0.1, "initial.state": "jammed"},
        warm_up_periods=150,
    ),
    Case(
        name="coarse-unjammed",
        title="coarse lattice 12 x 14, rho 0.15, w 2.8, strain rate 0.05, L = 100",
        preset="frictionless",
        settings={"drive.width": 2.8, "drive.strain_rate": 0.05},
        periods=20,
        quick_periods=10,
    ),
    Case(
        name="coarse-dense",
        title="coarse lattice, rho 0.3, w 2.6, strain rate 0.05, L = 100, jammed",
        preset="frictionless",
        settings=COARSE_DENSE,
        warm_up_periods=60,
        skin=0.9,
    ),
    Case(
        name="coarse-long",
        title="coarse lattice, rho 0.3, w 2.6, strain rate 0.05, L = 10,000, jammed",
        preset="frictionless",
        settings=COARSE_DENSE | {"tube.waves": 1000},
        warm_up_periods=60,
        copies=100,
        skin=0.9,
        shared_out=True,
    ),
    FRICTIONAL,
    replace(
        FRICTIONAL,
        name="frictional-long",
        title="the same, L = 1,440",
        settings=FRICTIONAL.settings | {"tube.waves": 72},
        periods=0.2,
        quick_periods=0.05,
        pair_styles=("granular",),
    ),
)
