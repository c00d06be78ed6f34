"""Frames in files that other programs open, written once or while a simulation runs."""

import _thread
import threading
from pathlib import Path

import gsd.hoomd
import MDAnalysis
import numpy as np
import pandas
import polars
import pytest

from peristalsis import Simulation, Writer

TIGHT = {"waves": 2, "strain_rate": 0.05, "seed": 1}

#: What MDAnalysis warns of: it has to guess masses.
pytestmark = pytest.mark.filterwarnings("ignore:::MDAnalysis")


@pytest.fixture
def tight() -> Simulation:
    """A tube without a doubt."""
    return Simulation.preset("frictionless-fine", **TIGHT)


def frames(path: Path) -> int:
    """Frames in a file, by a reader of others."""
    match path.suffix:
        case ".gsd":
            with gsd.hoomd.open(path) as trajectory:
                return len(trajectory)
        case ".lammpstrj":
            return len(MDAnalysis.Universe(path, format="LAMMPSDUMP", topology_format="LAMMPSDUMP").trajectory)
        case ".parquet":
            return len(pandas.read_parquet(path).groupby("step"))
    return (path / "trajectory.pvd").read_text().count("<DataSet")


@pytest.mark.parametrize("ending", ["gsd", "vtp", "lammpstrj", "parquet"])
def test_frames_come_when_they_are_due(tight: Simulation, tmp_path: Path, ending: str) -> None:
    plain = tight.copy()
    path = tmp_path / f"run.{ending}"
    writer = Writer(path, every=0.5)
    tight.run(periods=1, writers=[writer])
    assert writer.frames == frames(path) == 3
    tight.run(periods=1.75, writers=[writer])
    assert writer.frames == frames(path) == 6
    plain.run(periods=2.75)
    assert np.array_equal(plain.positions, tight.positions)
    with pytest.raises(FileExistsError, match="overwrite=True"):
        plain.run(periods=1, writers=[Writer(path)])
    if ending != "vtp":
        tight.write(tmp_path / f"now.{ending}")
    else:
        tight.write(tmp_path / "now.vtp")
        assert b"<PolyData>" in (tmp_path / "now.vtp").read_bytes()


def test_frames_hold_the_grains(tight: Simulation, tmp_path: Path) -> None:
    tight.run(periods=1)
    grains = len(tight.positions)
    for ending in ("gsd", "lammpstrj", "parquet"):
        tight.write(tmp_path / f"now.{ending}")
    with gsd.hoomd.open(tmp_path / "now.gsd") as trajectory:
        found = trajectory[0].particles.position[:grains]
        assert np.abs(found - tight.positions + [0, 0, 0.5 * tight.length]).max() < 1e-5
    table = polars.read_parquet(tmp_path / "now.parquet")
    assert np.array_equal(table.select("x", "y", "z").to_numpy(), tight.positions)
    assert table["time"].unique().to_list() == [tight.time]
    with pytest.raises(ValueError, match="endings: .gsd, .vtp, .lammpstrj, .parquet"):
        tight.write(tmp_path / "now.xyz")


def test_mdanalysis_reads_the_text_of_lammps(tight: Simulation, tmp_path: Path) -> None:
    writer = tight.add_writer(tmp_path / "run.lammpsdump", every=0.25)
    tight.run(periods=1)
    universe = MDAnalysis.Universe(tmp_path / "run.lammpsdump", dt=tight.configuration.time_step)
    grains, spheres = len(tight.positions), len(tight.positions) + len(tight.wall_positions)
    assert len(universe.atoms) == spheres and len(universe.trajectory) == writer.frames == 5
    last = universe.trajectory[-1]
    assert last.time == pytest.approx(tight.time) and (universe.atoms.types[:grains] == "1").all()
    # The box of MDAnalysis begins at 0.
    half = 0.5 * last.dimensions[0]
    assert np.abs(last.positions[:grains] - tight.positions - [half, half, 0]).max() < 1e-5


def test_instants_and_times(tight: Simulation, tmp_path: Path) -> None:
    writer = tight.add_writer(tmp_path / "at.parquet", at=[0, 0.5, "30t"])
    tight.run(periods=2)
    times = pandas.read_parquet(writer.path)["time"].unique()
    assert np.sort(times) == pytest.approx([0, 10, 30])
    tight.remove_writer(writer)
    with pytest.raises(ValueError, match="is over"):
        tight.add_writer(tmp_path / "late.gsd", at=1)
    for wrong, words in [({"every": 1e-9}, "shorter than a step"), ({"every": "soon"}, "no span of time")]:
        with pytest.raises(ValueError, match=words):
            tight.add_writer(tmp_path / "wrong.gsd", **wrong)  # type: ignore[arg-type]


@pytest.mark.parametrize("ending", ["gsd", "vtp", "lammpstrj", "parquet"])
def test_files_are_whole_after_ctrl_c(tight: Simulation, tmp_path: Path, ending: str) -> None:
    writer = tight.add_writer(tmp_path / f"run.{ending}", every=0.1)
    timer = threading.Timer(0.5, _thread.interrupt_main)
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        tight.run(periods=1_000_000)
    timer.join()
    assert writer.frames == frames(writer.path) > 0
    tight.run(periods=0.2)
    assert writer.frames == frames(writer.path)
