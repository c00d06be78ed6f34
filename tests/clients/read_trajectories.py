"""Opens the trajectories of runs with the programs that they are meant for, and compares every number.

    python tests/clients/read_trajectories.py RUN [RUN ...]

Each RUN is a folder that `peristalsis run --csv --trajectory gsd,vtp,lammps` has written. Readers: Python's gsd, PyVista
(VTK), OVITO. Asserted: the same frames, steps and times everywhere; positions, velocities, diameters, types, spins and
orientations alike (VTP and LAMMPS text to the bit, GSD to 32 bits); logged flow rates as in timeseries.csv; forces of
contacts that obey the contact law and add up to what the run says of its contacts; a trajectory cut off in the middle of
a frame opens up to the frame before.
"""

import csv
import json
import math
import shutil
import sys
import tempfile
import tomllib
from pathlib import Path

import gsd.hoomd
import numpy as np
import pyvista
from ovito.io import import_file

SINGLE = np.finfo(np.float32).eps


def read_lammps(path: Path) -> list[dict]:
    """The frames as text, by the columns that they name."""
    frames = []
    for text in path.read_text().split("ITEM: TIMESTEP\n")[1:]:
        lines = text.splitlines()
        columns = lines[7].split()[2:]
        numbers = np.array([line.split() for line in lines[8:]], dtype=float)
        assert len(numbers) == int(lines[2])
        frame = {name: numbers[:, index] for index, name in enumerate(columns)}
        frame["step"] = int(lines[0])
        frames.append(frame)
    return frames


def vectors(frame: dict, *names: str) -> np.ndarray:
    return np.stack([frame[name] for name in names], axis=1)


def close(found, expected, what: str) -> float:
    """Asserts agreement to 32 bits and answers the largest difference."""
    found, expected = np.asarray(found, dtype=float), np.asarray(expected, dtype=float)
    assert found.shape == expected.shape, f"{what}: {found.shape}, not {expected.shape}"
    scale = np.abs(expected).max(initial=1e-30)
    difference = np.abs(found - expected).max(initial=0.0)
    assert difference <= SINGLE * scale, f"{what} differs by {difference}"
    return difference


def compare_gsd(run: Path, frames: list[dict], grains: int) -> float:
    most = 0.0
    with gsd.hoomd.open(run / "trajectory.gsd") as trajectory:
        assert len(trajectory) == len(frames)
        for found, frame in zip(trajectory, frames):
            particles = found.particles
            assert found.configuration.step == frame["step"]
            frame["time"] = found.log["time"][0]
            assert particles.types == ["grain", "wall"]
            assert particles.N == len(frame["id"])
            np.testing.assert_array_equal(particles.typeid + 1, frame["type"])
            assert np.count_nonzero(particles.typeid == 0) == grains
            width, _, length = found.configuration.box[:3]
            position = vectors(frame, "x", "y", "z") - [0, 0, 0.5 * length]
            most = max(most, close(particles.position, position, "position"))
            close(particles.velocity, vectors(frame, "vx", "vy", "vz"), "velocity")
            close(particles.diameter, frame["diameter"], "diameter")
            half = 0.5 * np.array([width, width, length])
            assert (np.abs(particles.position) <= half * (1 + SINGLE)).all()
            if "omegax" in frame:
                spin = vectors(frame, "omegax", "omegay", "omegaz")
                close(found.log["particles/angular_velocity"], spin, "angular velocity")
                norm = np.linalg.norm(particles.orientation, axis=1)
                assert np.abs(norm - 1).max() < 4 * SINGLE
        if "omegax" in frames[0]:
            last = trajectory[-1].particles.orientation[:grains]
            assert (last[:, 0] < 0.9999).any(), "some grain has turned"
    return most


def compare_log(run: Path) -> int:
    """What is logged against the rows of the time series; answers the frames that stand at a sample."""
    with (run / "timeseries.csv").open() as file:
        rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
    times = np.array([float(row["time"]) for row in rows])
    compared = 0
    with gsd.hoomd.open(run / "trajectory.gsd") as trajectory:
        for frame in trajectory:
            time = frame.log["time"][0]
            passed = np.searchsorted(times, time * (1 + 1e-12), side="right")
            for name in ("flow_rate", "flow_rate_ratio"):
                logged = frame.log[name][0]
                if passed == 0:
                    assert math.isnan(logged)
                else:
                    assert logged == float(rows[passed - 1][name]), name
            if passed and math.isclose(times[passed - 1], time, rel_tol=1e-12):
                row = rows[passed - 1]
                assert math.isclose(frame.log["period"][0], float(row["period"]), rel_tol=1e-12)
                particles = frame.particles
                velocity = particles.velocity[particles.typeid == 0, 2]
                flow = frame.log["heading"][0] * velocity.astype(float).sum() / frame.configuration.box[2]
                if float(row["escaped"]) == 0:
                    instantaneous = frame.log["flow_rate_instantaneous"][0]
                    assert math.isclose(flow, instantaneous, rel_tol=1e-4, abs_tol=1e-6)
                compared += 1
    assert compared > 2
    return compared


def compare_vtp(run: Path, frames: list[dict]) -> None:
    reader = pyvista.get_reader(run / "trajectory.pvd")
    assert reader.time_values == [frame["time"] for frame in frames]
    for index, frame in enumerate(frames):
        reader.set_active_time_point(index)
        mesh = reader.read()[0]
        np.testing.assert_array_equal(mesh.points, vectors(frame, "x", "y", "z"))
        np.testing.assert_array_equal(mesh["velocity"], vectors(frame, "vx", "vy", "vz"))
        np.testing.assert_array_equal(mesh["diameter"], frame["diameter"])
        np.testing.assert_array_equal(mesh["type"] + 1, frame["type"])
        assert mesh.n_verts == mesh.n_points
        assert mesh.field_data["step"][0] == frame["step"]
        if "omegax" in frame:
            spin = vectors(frame, "omegax", "omegay", "omegaz")
            np.testing.assert_array_equal(mesh["angular_velocity"], spin)


def compare_contacts(run: Path, frames: list[dict], grains: int) -> int:
    """Contacts against the spheres of the same frame and the contact law; answers how many there were."""
    configuration = tomllib.loads((run / "config.toml").read_text())
    contact, length = configuration["contact"], configuration["tube"]["wavelength"] * configuration["tube"]["waves"]
    reader = pyvista.get_reader(run / "contacts.pvd")
    assert reader.time_values == [frame["time"] for frame in frames]
    total = 0
    for index, frame in enumerate(frames):
        reader.set_active_time_point(index)
        mesh = reader.read()[0]
        if mesh.n_cells == 0:
            continue
        total += mesh.n_cells
        ends = mesh.points.reshape(-1, 2, 3)
        first, second = mesh["first"], mesh["second"]
        position, diameter = vectors(frame, "x", "y", "z"), frame["diameter"]
        np.testing.assert_array_equal(ends[:, 0], position[first])
        away = ends[:, 1] - position[second]
        away[:, 2] -= length * np.round(away[:, 2] / length)
        assert np.abs(away).max() < 1e-12
        line = ends[:, 0] - ends[:, 1]
        distance = np.linalg.norm(line, axis=1)
        reach = 0.5 * (diameter[first] + diameter[second])
        assert np.abs(reach - distance - mesh["overlap"]).max() < 1e-12
        assert (mesh["overlap"] > 0).all()
        velocity = vectors(frame, "vx", "vy", "vz")
        parting = ((velocity[first] - velocity[second]) * line).sum(axis=1) / distance
        if contact["law"] == "linear":
            force = contact["normal_stiffness"] * mesh["overlap"] - contact["normal_damping"] * parting
        else:
            radius = diameter[first] * diameter[second] / (2 * (diameter[first] + diameter[second]))
            stiffness = 2 * contact["young_modulus"] * np.sqrt(radius) / (3 * (1 - contact["poisson_ratio"] ** 2))
            damping = contact["dissipation_time"] * (1.5 if contact["dissipation_form"] == "viscoelastic" else 1.0)
            root = np.sqrt(mesh["overlap"])
            force = np.maximum(stiffness * (root**3 - damping * root * parting), 0)
        np.testing.assert_allclose(mesh["normal_force"], force, rtol=1e-9, atol=1e-14)
        limit = contact.get("static_friction", 0.0) * np.maximum(mesh["normal_force"], 0)
        assert (mesh["tangential_force"] <= limit * (1 + 1e-9) + 1e-14).all()
    assert total > 100
    return total


def compare_ovito(run: Path, frames: list[dict], grains: int) -> None:
    for name, exact in (("trajectory.lammpstrj", True), ("trajectory.gsd", False)):
        pipeline = import_file(str(run / name))
        assert pipeline.num_frames == len(frames), f"{name}: {pipeline.num_frames} frames"
        for index in {0, 1, len(frames) // 2, len(frames) - 1}:
            frame, data = frames[index], pipeline.compute(index)
            particles = data.particles
            assert particles.count == len(frame["id"])
            assert data.attributes["Timestep"] == frame["step"]
            position = vectors(frame, "x", "y", "z")
            origin = 0.0 if exact else 0.5 * data.cell[2, 2]
            shift = np.array(particles.positions) - (position - [0, 0, origin])
            shift[:, 2] -= data.cell[2, 2] * np.round(shift[:, 2] / data.cell[2, 2])
            # OVITO's own reader of numbers rounds the last bit otherwise.
            tolerance = 1e-14 if exact else SINGLE
            assert np.abs(shift).max() <= tolerance * np.abs(position).max(), f"{name}: {np.abs(shift).max()}"
            close(particles["Velocity"], vectors(frame, "vx", "vy", "vz"), "velocity")
            close(2 * np.array(particles["Radius"]), frame["diameter"], "diameter")
            kinds = np.array(particles.particle_types)
            assert np.count_nonzero(kinds == kinds[0]) == grains
            assert tuple(data.cell.pbc)[2]


def compare_cut(run: Path, frames: list[dict]) -> None:
    """What a kill can leave: the last bytes of the last frame are missing."""
    with tempfile.TemporaryDirectory() as place:
        path = Path(place) / "trajectory.lammpstrj"
        shutil.copy(run / path.name, path)
        with path.open("r+b") as file:
            file.truncate(path.stat().st_size - 1000)
        data = import_file(str(path)).compute(len(frames) - 2)
        assert data.attributes["Timestep"] == frames[-2]["step"]
        path = Path(place) / "trajectory.gsd"
        shutil.copy(run / path.name, path)
        with path.open("ab") as file:
            file.write(b"\x5a" * 5000)
        with gsd.hoomd.open(path) as trajectory:
            assert len(trajectory) == len(frames)
            assert trajectory[-1].configuration.step == frames[-1]["step"]


def main() -> None:
    for run in map(Path, sys.argv[1:]):
        summary = json.loads((run / "summary.json").read_text())
        grains = summary["grains"]
        frames = read_lammps(run / "trajectory.lammpstrj")
        assert len(frames) == summary["trajectory"]["frames"]
        difference = compare_gsd(run, frames, grains)
        samples = compare_log(run)
        compare_vtp(run, frames)
        contacts = compare_contacts(run, frames, grains)
        compare_ovito(run, frames, grains)
        compare_cut(run, frames)
        print(
            f"{run.name}: {len(frames)} frames of {len(frames[0]['id'])} spheres alike in gsd, VTK and OVITO; GSD rounds "
            f"positions by {difference:.1e} at most; {samples} frames match rows of the time series, {contacts} contacts "
            "obey their law"
        )


main()
