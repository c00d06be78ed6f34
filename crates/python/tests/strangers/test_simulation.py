"""What strangers missed of a simulation: warnings, one checkpoint, contacts and stress, loops, callbacks, placed grains."""

import logging
import pickle
import signal
import subprocess
import sys
import threading
import time
import warnings
from pathlib import Path

import numpy as np
import pytest

import peristalsis
from peristalsis import Configuration, ConfigurationError, DivergedError, PeristalsisWarning, Simulation, SnapshotError

#: A tube that does not leak.
TIGHT = {"waves": 2, "strain_rate": 0.05, "width": 2.6, "seed": 1}

#: One so slow that overlaps stay small.
CALM = TIGHT | {"strain_rate": 0.005}


@pytest.fixture
def tight() -> Simulation:
    """A tube without a doubt."""
    return Simulation.preset("frictionless-fine", **TIGHT)


def summed(sim: Simulation) -> np.ndarray:
    """Of each grain the sum of the forces of its contacts."""
    contacts = sim.contacts()
    force = np.stack([contacts[f"force_{axis}"] for axis in "xyz"], axis=1)
    total = np.zeros_like(sim.positions)
    np.add.at(total, contacts["i"], force)
    inner = ~contacts["wall"]
    np.add.at(total, contacts["j"][inner], -force[inner])
    return total


def test_a_leaking_tube_is_warned_of_where_it_is_made() -> None:
    with pytest.warns(PeristalsisWarning, match="tube.rings_per_wave: .*grains escape") as caught:
        sim = Simulation.preset("frictionless", width=2.6, strain_rate=0.1, seed=1)
    assert [Path(it.filename).name for it in caught] == [Path(__file__).name]
    assert [it.key for it in sim.warnings] == ["tube.rings_per_wave"] and "grains escape" in sim.warnings[0].message
    with warnings.catch_warnings():
        # Once is enough; what a run sees is another doubt.
        warnings.simplefilter("error")
        sim.step(0)
        sim.copy().step(0)


def test_what_a_run_has_seen_is_told_once_and_stands_in_the_repr() -> None:
    with warnings.catch_warnings(record=True):
        warnings.simplefilter("always")
        sim = Simulation.preset("frictionless", width=2.6, strain_rate=0.1, seed=1)
        sim.run(periods=50)
        sim.width = 2.9
        sim.run(periods=10)
    assert sim.escaped > 0 and sim.largest_overlap > 0.5
    assert f"escaped {sim.escaped}" in repr(sim) and "largest overlap 0." in repr(sim) and "warning: " in repr(sim)
    assert sim.summary()["escaped"] == sim.escaped
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        sim.step(1)


def test_a_simulation_without_doubts_says_nothing() -> None:
    tight = Simulation.preset("frictionless-fine", **CALM)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        tight.run(periods=5)
    assert tight.warnings == () and tight.escaped == 0


def test_a_ramp_gets_no_warning_of_its_schedule_and_can_be_repeated() -> None:
    sim = Simulation.preset("frictionless-fine", **CALM, periods=2)
    for width in (2.5, 2.7, 2.8):
        sim.width = width
        sim.run(periods=1.5)
        assert all(it.key != "drive.schedule" for it in sim.warnings)
    assert sim.configuration.steps == sim.steps and sim.configuration["run.periods"] == 4.5
    again = Simulation.from_toml(sim.configuration.to_toml())
    again.run()
    assert np.array_equal(sim.positions, again.positions)


def test_a_ramp_tells_doubts_of_the_whole_and_not_of_its_levels() -> None:
    """Half way up the flow has not crossed the threshold yet."""
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        sim = Simulation.preset("frictionless-fine", width=2.95, strain_rate=0.01, waves=2, seed=1)
        loop = sim.ramp("width", 2.95, 2.8, periods=40, levels=4, back=False)
    assert loop.thresholds.there is not None and sim.warnings == ()
    with pytest.warns(PeristalsisWarning, match="drive.strain_rate"):
        Simulation.preset("frictionless-fine", **TIGHT).ramp("width", 2.6, 2.5, periods=4, levels=2, back=False)


def test_a_loop_has_both_branches_with_errors_and_thresholds() -> None:
    sim = Simulation.preset("frictionless-fine", **TIGHT)
    loop = sim.ramp("width", 2.4, 2.9, periods=24, levels=6)
    table = loop.table()
    assert table["branch"] == ["there"] * 6 + ["back"] * 6 and loop.parameter == "width"
    assert table["value"] == pytest.approx([2.4, 2.5, 2.6, 2.7, 2.8, 2.9, 2.9, 2.8, 2.7, 2.6, 2.5, 2.4])
    assert np.isfinite(table["flow_rate_ratio_error"]).all() and (table["flow_rate_ratio_error"] > 0).all()
    ratio = table["flow_rate_ratio"]
    for place, threshold in zip((0, 6), loop.thresholds):
        branch, values = ratio[place : place + 6], table["value"][place : place + 6]
        crosses = np.flatnonzero(np.diff(np.sign(branch - 0.5)))
        assert (threshold is None) == (len(crosses) == 0)
        if threshold is not None:
            assert {threshold.lower, threshold.upper} == {values[crosses[0]], values[crosses[0] + 1]}
    assert sim.period == pytest.approx(48)
    one_way = Simulation.preset("frictionless-fine", **TIGHT).ramp("strain_rate", 0.04, 0.05, periods=6, levels=3, back=False)
    assert one_way.thresholds.back is None and one_way.branch == ("there",) * 3
    with pytest.raises(ValueError, match="fewer than two"):
        sim.ramp("width", 2.4, 2.9, periods=5, levels=6)
    with pytest.raises(AttributeError, match="force_amplitude is no parameter"):
        sim.ramp("force_amplitude", 0.1, 0.2, periods=60)


def test_the_force_of_an_elastic_wall_is_ramped() -> None:
    sim = Simulation.preset("frictional", waves=2, spheres_per_ring=10, rings_per_wave=10, number=10)
    force = sim.force_amplitude
    loop = sim.ramp("force_amplitude", 1.02 * force, 1.02 * force, periods=2, levels=1, back=False)
    assert np.isfinite(loop.flow_rate_ratio).all() and loop.table().units["value"] == "m d/t^2"


@pytest.mark.parametrize("preset", ["frictionless-fine", "frictional"])
def test_forces_are_the_sums_of_the_contacts(preset: str) -> None:
    sim = Simulation.preset(preset, waves=2, seed=2)
    sim.run(periods=0.1 if preset == "frictional" else 1)
    contacts = sim.contacts()
    assert len(contacts) > 10 and contacts["wall"].any() and not contacts["wall"].all()
    assert np.abs(summed(sim) - sim.forces).max() <= 1e-12
    # Grains and spheres of the wall by their numbers; the point lies between them.
    grains, length = len(sim.positions), sim.length
    centres = np.concatenate([sim.positions, sim.wall_positions])
    sizes = np.concatenate([sim.diameters, np.full(len(sim.wall_positions), sim.configuration["wall.sphere_diameter"])])
    i, j = contacts["i"], contacts["j"]
    assert np.array_equal(contacts["wall"], j >= grains) and (i < grains).all()
    separation = centres[i] - centres[j]
    separation[:, 2] -= length * np.round(separation[:, 2] / length)
    distance = np.linalg.norm(separation, axis=1)
    assert contacts["overlap"] == pytest.approx(0.5 * (sizes[i] + sizes[j]) - distance, abs=1e-12)
    normal = separation / distance[:, None]
    force = np.stack([contacts[f"force_{axis}"] for axis in "xyz"], axis=1)
    tangential = np.stack([contacts[f"tangential_{axis}"] for axis in "xyz"], axis=1)
    assert np.abs(force - contacts["normal_force"][:, None] * normal - tangential).max() < 1e-12
    assert np.linalg.norm(tangential, axis=1) == pytest.approx(contacts["tangential_force"], abs=1e-12)
    point = np.stack([contacts[axis] for axis in "xyz"], axis=1)
    arm = 0.5 * (sizes[i] - contacts["overlap"])
    assert np.abs(centres[i] - arm[:, None] * normal - point).max() < 1e-12
    torque = np.cross(point - centres[i], force)
    if preset == "frictional":
        only = np.setdiff1d(i, j[~contacts["wall"]])
        expected = np.zeros_like(sim.torques)
        np.add.at(expected, i, torque)
        assert np.abs(expected - sim.torques)[only].max() <= 1e-12 and np.abs(sim.torques).max() > 0
    else:
        assert not sim.torques.any() and not contacts["sliding"].any()


def test_forces_move_the_grains(tight: Simulation) -> None:
    """f = m dv/dt."""
    tight.run(periods=2)
    before, force, step = tight.velocities, tight.forces, tight.configuration.time_step
    tight.step(1)
    mass = tight.diameters[:, None] ** 3
    change = mass * (tight.velocities - before) / step
    mean = 0.5 * (force + tight.forces)
    assert np.abs(change - mean).max() < 0.02 * np.abs(force).max()


def test_stress_and_contacts_of_two_grains_by_hand() -> None:
    tube = Configuration("frictionless-fine", waves=2, strain_rate=0.05)
    sim = Simulation.from_positions(tube, [[0, 0, 5.0], [0.1, 0, 5.9]])
    stiffness = tube["contact.normal_stiffness"]
    distance = np.hypot(0.1, 0.9)
    force = stiffness * (1 - distance) * np.array([-0.1, 0, -0.9]) / distance
    contacts = sim.contacts()
    assert len(contacts) == 1 and contacts["overlap"][0] == pytest.approx(1 - distance)
    assert np.allclose(sim.forces, [force, -force], atol=1e-14)
    assert contacts["normal_force"][0] == pytest.approx(stiffness * (1 - distance)) and contacts["tangential_force"][0] < 1e-14
    assert [contacts[axis][0] for axis in "xyz"] == pytest.approx([0.05, 0, 5.45])
    branch = np.array([-0.1, 0, -0.9])
    assert np.allclose(sim.stress_tensor, np.outer(branch, force) / sim.volume, atol=1e-15)


def test_the_stress_of_grains_at_rest_is_the_pressure_on_the_wall() -> None:
    sim = Simulation.preset(
        "frictionless-fine", width=3.0, waves=2, strain_rate=0, duration=400, volume_fraction=0.35, contact_normal_damping=0.5
    )
    sim.run()
    contacts = sim.contacts()
    wall = contacts["wall"]
    x, y = contacts["x"][wall], contacts["y"][wall]
    inwards = -(contacts["force_x"][wall] * x + contacts["force_y"][wall] * y)
    stress = sim.stress_tensor
    # The virial theorem, exact in equilibrium; and the pressure on the area of the clear bore.
    assert (stress[0, 0] + stress[1, 1]) * sim.volume == pytest.approx(inwards.sum(), rel=1e-2)
    pressure = (inwards / np.hypot(x, y)).sum() / (2 * np.pi * (1.5 - 0.5) * sim.length)
    assert 0.5 * (stress[0, 0] + stress[1, 1]) == pytest.approx(pressure, rel=0.1)


def test_the_radius_of_the_wall_is_a_function_of_place(tight: Simulation) -> None:
    rings = tight.wall_positions
    assert tight.wall_radius(rings[:, 2]) == pytest.approx(np.hypot(rings[:, 0], rings[:, 1]), abs=1e-9)
    assert tight.wall_radius([[0.0, tight.length]]).shape == (1, 2)
    assert 2 * tight.wall_radius().min() == pytest.approx(tight.width, abs=1e-3)


@pytest.mark.parametrize("status", ["running", "complete"])
def test_the_status_of_a_run_is_in_words_of_python(status: str) -> None:
    sim = Simulation.preset("frictionless-fine", **TIGHT, periods=2)
    sim.run(periods=2 if status == "complete" else 1)
    assert sim.summary()["status"] == status


def test_a_simulation_that_diverged_says_so_and_goes_no_further() -> None:
    sim = Simulation.preset("frictionless", width=1.2, waves=2, seed=1, time_step=0.3, strain_rate=0.2)
    with pytest.raises(DivergedError, match="(?s)diverged at step .*help: take a shorter run.time_step"):
        sim.run(periods=50)
    steps = sim.steps
    for one in (sim, sim.copy(), pickle.loads(pickle.dumps(sim))):
        with pytest.raises(DivergedError, match=f"diverged at step {steps} "):
            one.step(1)
        summary = one.summary()
        assert one.steps == steps and summary["status"] == "diverged"
        assert f"diverged at step {steps} " in (summary["message"] or "") and f"status diverged at step {steps} " in repr(one)


def test_copies_and_pickles_carry_all_but_the_writers(tight: Simulation, tmp_path: Path) -> None:
    """PYTHON: what a copy carries is said and tested."""
    writer = tight.add_writer(tmp_path / "run.gsd", every=0.5)
    tight.width = 2.5
    tight.run(periods=1)
    for other in (tight.copy(), pickle.loads(pickle.dumps(tight))):
        assert other.configuration == tight.configuration and other.timeseries() == tight.timeseries()
        other.run(periods=1)
        assert other.width == 2.5 and writer.frames == 3
        with pytest.raises(ValueError, match="no writer of this simulation"):
            other.remove_writer(writer)
    assert "writers" in (Simulation.copy.__doc__ or "")


def test_steps_and_seeds_that_cannot_be(tight: Simulation) -> None:
    with pytest.raises(TypeError, match="steps is a whole number, not 1.5"):
        tight.step(1.5)  # type: ignore[arg-type]
    with pytest.raises(ConfigurationError, match=r"run.seed = 18446744073709551616 is no seed"):
        Simulation.preset("frictionless", seed=2**64)
    with pytest.raises(ConfigurationError, match="shorter than half a step"):
        Simulation.preset("frictionless", strain_rate=0.03, waves=2).run(duration=1e-9)
    with pytest.raises(ConfigurationError, match="a run of 0.0002 t is shorter than half a step"):
        tight.run(periods=1e-5)
    tight.step(np.int64(2))
    assert tight.steps == 2


def test_a_generator_of_numpy_is_a_seed_that_is_written_down() -> None:
    one, other = (Simulation.preset("frictionless-fine", waves=2, strain_rate=0.05, seed=np.random.default_rng(5)) for _ in range(2))
    assert one.configuration == other.configuration and one.configuration["run.seed"] > 1000
    assert np.array_equal(Simulation(one.configuration).positions, other.positions)


def test_several_callbacks_each_with_its_steps(tight: Simulation) -> None:
    seen: list[tuple[str, int]] = []

    def note(name: str) -> object:
        return lambda sim: seen.append((name, sim.steps))

    tight.step(12, callback=[note("often"), (note("seldom"), 5)], every=3)
    assert seen == [("often", 3), ("seldom", 5), ("often", 6), ("often", 9), ("seldom", 10), ("often", 12)]
    with pytest.raises(TypeError, match="callback is a function"):
        tight.step(1, callback=[(5, note("wrong"))])  # type: ignore[list-item]


def test_progress_goes_to_a_log(tight: Simulation, caplog: pytest.LogCaptureFixture, capsys: pytest.CaptureFixture[str]) -> None:
    with caplog.at_level(logging.INFO, logger="peristalsis"):
        tight.run(periods=1, progress="logging")
    assert "100%, period 1.0, J/Jmax" in caplog.text and capsys.readouterr().err == ""
    tight.run(periods=1, progress=True)
    assert "100%" in capsys.readouterr().err
    with pytest.raises(ValueError, match="progress is True, False"):
        tight.run(periods=1, progress="loud")  # type: ignore[arg-type]


def test_grains_settle_under_gravity_on_the_wall() -> None:
    sim = Simulation.preset("frictionless", waves=2, width=1.6, gravity=[0, -0.002, 0], state="settled")
    assert sim.time == 0 and not sim.velocities.any()
    contacts = sim.contacts()
    borne = contacts["force_y"][contacts["wall"]].sum()
    weight = 0.002 * sim.configuration["grains.number"]
    # The wall already moves, and its damping is in the force.
    assert abs(borne / weight - 1) < 0.1
    sim.run(periods=1)
    assert sim.summary()["energy_residual"] < 1e-3
    with pytest.raises(ConfigurationError, match="needs gravity"):
        Simulation.preset("frictionless", state="settled")
    with pytest.raises(ConfigurationError, match="too short"):
        Simulation.preset("frictionless", gravity=[0, -1])


def test_placed_grains_stay_in_order_and_say_that_no_file_repeats_them(tmp_path: Path) -> None:
    tube = Configuration("frictionless-fine", waves=2, strain_rate=0.05, seed=9)
    places = np.array([[0, 0, 12.0], [0.2, 0, 3.0], [0, -0.3, 25.0]])
    speeds = np.array([[0, 0, 0.1], [0, 0, 0], [0.1, 0, 0]])
    sim = Simulation.from_positions(tube, places, speeds, diameters=[1.0, 0.8, 0.9])
    assert np.allclose(sim.positions, [[0, 0, 12], [0.2, 0, 3], [0, -0.3, 5]]) and np.array_equal(sim.velocities, speeds)
    assert sim.diameters.tolist() == [1.0, 0.8, 0.9] and sim.configuration["grains.number"] == 3
    assert sim.configuration["initial.state"] == "placed"
    with pytest.raises(ConfigurationError, match="go on from a checkpoint"):
        Simulation(sim.configuration)
    sim.run(periods=1)
    sim.save(tmp_path / "placed")
    again = Simulation.load(tmp_path / "placed")
    for one in (sim, again, pickle.loads(pickle.dumps(sim))):
        one.run(periods=1)
    assert np.array_equal(sim.positions, again.positions)


@pytest.mark.parametrize(
    ("places", "others", "words"),
    [
        ([[0, 0, 1], [0, 0, 1.2]], {}, "grain 0 and grain 1 overlap by 0.8000 d"),
        ([[2.0, 0, 1]], {}, "grain 0 at .* is outside the tube"),
        ([[0, 0, np.nan]], {}, "grain 0 has position"),
        ([[0, 0]], {}, r"shape \(N, 3\)"),
        ([[0, 0, 1]], {"velocities": [[0, 0]]}, r"shape \(N, 3\)"),
        ([[0, 0, 1]], {"diameters": [1.0, 1.0]}, r"an array of shape \(1,\)"),
        ([[0, 0, 1]], {"diameters": -1.0}, r"diameters\[0\] = -1.0 is no diameter"),
    ],
)
def test_grains_that_cannot_stand_so_are_refused(places: list[list[float]], others: dict[str, object], words: str) -> None:
    tube = Configuration("frictionless-fine", waves=2, strain_rate=0.05)
    with pytest.raises(ConfigurationError, match=words):
        Simulation.from_positions(tube, places, **others)  # type: ignore[arg-type]


def command(*words: object, **options: object) -> "subprocess.CompletedProcess[str]":
    """The command line as the package brings it."""
    line = [sys.executable, "-m", "peristalsis", *map(str, words)]
    return subprocess.run(line, capture_output=True, text=True, check=False, **options)  # type: ignore[call-overload, no-any-return]


def test_python_and_the_command_line_go_on_from_each_other(tmp_path: Path) -> None:
    out = tmp_path / "run"
    settings = [word for key in ("tube.waves=2", "run.periods=2", "run.seed=3") for word in ("--set", key)]
    made = command("run", "--preset", "frictionless-fine", *settings, "--out", out, "--quiet")
    assert made.returncode == 0, made.stderr
    expected = Simulation.preset("frictionless-fine", waves=2, periods=2, seed=3)
    expected.run(periods=3)
    for place in (out, out / "state.checkpoint"):
        sim = Simulation.load(place)
        assert sim.period == pytest.approx(2)
        sim.run(periods=1)
        assert np.array_equal(sim.positions, expected.positions)
    with pytest.raises(FileNotFoundError):
        Simulation.load(tmp_path / "nothing")
    with pytest.raises((SnapshotError, FileNotFoundError)):
        Simulation.load(tmp_path)
    (tmp_path / "words").write_text("no snapshot")
    with pytest.raises(SnapshotError, match="words"):
        Simulation.load(tmp_path / "words")


def test_the_command_answers_exit_codes_and_stops_on_request(tmp_path: Path) -> None:
    assert "frictionless-fine" in command("presets").stdout
    assert command("run", "--no-such-option").returncode == 2
    assert command("check", "--preset", "frictionless", "--set", "drive.width=-1").returncode == 2
    out = tmp_path / "run"
    line = [sys.executable, "-m", "peristalsis", "run", "--preset", "frictionless-fine", "--set", "run.periods=1e6", "--out", str(out)]
    process = subprocess.Popen(line, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    deadline = time.monotonic() + 60
    while not (out / "state.checkpoint").exists() and time.monotonic() < deadline:
        time.sleep(0.05)
    time.sleep(0.5)
    process.send_signal(signal.SIGINT)
    process.communicate(timeout=60)
    assert process.returncode == 130 and (out / "state.checkpoint").exists()
    assert Simulation.load(out).summary()["status"] == "running"


def test_pictures_are_shown_by_notebooks_and_written(tight: Simulation, tmp_path: Path) -> None:
    tight.run(periods=2)
    for view in ("side", "section", "space-time"):
        picture = tight.render(tmp_path / f"{view}.png", view=view, width=200 if view != "space-time" else None)
        assert (tmp_path / f"{view}.png").read_bytes() == picture.png == picture._repr_png_() == bytes(picture)
    assert tight.render(width=200, colour="pressure", wall="glass", paper="dark", bare=True).png.startswith(b"\x89PNG")
    tight.render(tmp_path / "tube.svg", width=200)
    assert "<svg" in (tmp_path / "tube.svg").read_text()
    for options, words in [
        ({"colour": "red"}, "colour = \"red\" is not possible; there are axial-velocity"),
        ({"view": "top"}, "view = \"top\""),
        ({"place": 1.0}, "those of view"),
        ({"width": 3}, "16 to 16384"),
    ]:
        with pytest.raises(ValueError, match=words):
            tight.render(**options)  # type: ignore[arg-type]
    with pytest.raises(ValueError, match=".png or .svg"):
        tight.render(tmp_path / "tube.jpg")


def test_everything_is_read_while_it_runs(tight: Simulation) -> None:
    """Threads see whole steps of contacts and forces, too."""
    worst: list[float] = []
    thread = threading.Thread(target=lambda: tight.run(periods=4))
    thread.start()
    while thread.is_alive():
        worst.append(float(np.abs(tight.stress_tensor).max()))
        tight.contacts()
    thread.join()
    assert np.isfinite(worst).all()


def test_run_takes_a_configuration_sections_and_keywords() -> None:
    made = peristalsis.Configuration("frictionless", waves=2, periods=1)
    sections = {"preset": "frictionless", "tube": {"waves": 2}, "periods": 1}
    keywords = {"preset": "frictionless", "waves": 2, "run.periods": 1}
    ratios = {peristalsis.run(config)["flow_rate_ratio"] for config in (made, sections, keywords)}
    assert len(ratios) == 1


def test_one_level_leads_nowhere() -> None:
    sim = peristalsis.Simulation.preset("frictionless-fine", waves=2)
    with pytest.raises(ValueError, match="levels is 2 at least"):
        sim.ramp("width", 2.4, 2.6, periods=8, levels=1)
