"""The simulation from Python: the same bits, arrays that stay, drives that change, threads, Ctrl-C."""

import copy
import json
import os
import pickle
import signal
import subprocess
import threading
import time
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import pyarrow.parquet
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import peristalsis
from peristalsis import ConfigurationError, DoesNotFitError, Simulation, SnapshotError, Writer


def same(one: Simulation, other: Simulation) -> bool:
    return (
        np.array_equal(one.positions, other.positions)
        and np.array_equal(one.velocities, other.velocities)
        and one.energy_ledger == other.energy_ledger
    )


def test_shapes_and_values_of_the_arrays(small: Simulation) -> None:
    small.run(periods=3)
    grains = small.configuration.grains
    for array in (small.positions, small.velocities, small.angular_velocities):
        assert array.shape == (grains, 3) and array.dtype == np.float64
    assert np.array_equal(small.diameters, np.ones(grains))
    assert small.wall_positions.shape == (12 * 14 * 2, 3)
    radius = np.hypot(*small.wall_positions[:, :2].T)
    assert radius.min() == pytest.approx(1.3, abs=0.03) and radius.max() == pytest.approx(1.7, abs=0.03)
    assert small.period == pytest.approx(3.0) and small.time == pytest.approx(30.0)
    assert (small.positions[:, 2] >= 0).all() and (small.positions[:, 2] < small.length).all()
    ledger = small.energy_ledger
    assert ledger["kinetic_energy"] == pytest.approx(0.5 * np.sum(small.velocities**2))
    gained = ledger["energy"] - ledger["initial_energy"]
    assert gained == pytest.approx(ledger["wall_work"] - ledger["normal_dissipated"], abs=1e-2 * ledger["gross_work"])


def test_arrays_cannot_be_written_to_and_outlive_their_simulation(small: Simulation) -> None:
    before = small.positions
    kept = before.copy()
    small.run(periods=1)
    assert np.array_equal(before, kept) and not np.array_equal(before, small.positions)
    for array in (before, small.diameters, small.turns, small.wall_positions):
        with pytest.raises(ValueError, match="read-only"):
            array[...] = 0
    column, table = before[:, 2], small.timeseries()
    taken = pyarrow.table(table)["time"]
    del small, before, table
    assert np.array_equal(column, kept[:, 2])
    assert taken.to_pylist() == sorted(taken.to_pylist()) and len(taken) == 20


@settings(max_examples=8, deadline=None)
@given(
    seed=st.integers(0, 2**32),
    width=st.floats(2.3, 2.9),
    cuts=st.lists(st.integers(1, 150), min_size=1, max_size=5),
)
def test_however_it_is_cut_it_is_the_same_run(seed: int, width: float, cuts: list[int]) -> None:
    whole = Simulation.preset("frictionless", width=width, seed=seed, waves=2)
    parts = whole.copy()
    whole.step(sum(cuts))
    for steps in cuts:
        parts.step(steps)
        parts = pickle.loads(pickle.dumps(parts))
    assert same(whole, parts)
    assert pyarrow.table(whole.timeseries()).equals(pyarrow.table(parts.timeseries()))


def test_same_seed_same_bits_as_the_command_line(tmp_path: Path) -> None:
    program = os.environ.get("PERISTALSIS_PROGRAM")
    if program is None:
        pytest.skip("PERISTALSIS_PROGRAM names no program")
    out = tmp_path / "run"
    values = {"drive.width": 2.65, "run.seed": 7, "tube.waves": 2, "run.periods": 4}
    arguments = [word for key, value in values.items() for word in ("--set", f"{key}={value}")]
    subprocess.run(
        [program, "run", "--quiet", "--preset", "frictionless", "--out", out, *arguments], check=True, capture_output=True
    )
    sim = Simulation.preset("frictionless", width=2.65, seed=7, waves=2, periods=4)
    sim.run()
    ours, theirs = pyarrow.table(sim.timeseries()), pyarrow.parquet.read_table(out / "timeseries.parquet")
    assert ours.column_names == theirs.column_names
    for name in ours.column_names:
        assert ours[name].to_pylist() == theirs[name].to_pylist(), name
    # Of the machine and the build, not of the run.
    others = {"seconds", "grain_steps_per_second", "revision"}
    summary = json.loads((out / "summary.json").read_text())
    for name, value in sim.summary().items():
        if name not in others:
            assert value == summary[name] or value != value and summary[name] is None, name
    again = Simulation.from_file(out / "config.toml")
    again.run()
    assert same(sim, again)


def test_a_ramp_in_width_is_a_loop(small: Simulation) -> None:
    plain = small.copy()
    for width in np.linspace(2.6, 2.8, 3):
        small.width = width
        small.run(periods=1)
    assert small.width == 2.8 and plain.width == 2.6
    ledger = small.energy_ledger
    assert ledger["energy_residual"] < 0.02
    # The configuration says how to repeat it.
    again = Simulation.from_toml(small.configuration.to_toml())
    again.run(periods=3)
    assert same(small, again)
    plain.run(periods=3)
    assert not same(small, plain)


def test_a_ramp_that_cannot_end_does_not_begin(small: Simulation) -> None:
    for stop, reason in ((3.5, "is above 3"), (-0.2, "from 0 on")):
        with pytest.raises(ConfigurationError, match=reason):
            small.ramp("width", 2.8, stop, periods=8, levels=4)
    assert small.steps == 0 and small.width == 2.6


@pytest.mark.skipif(os.name != "posix", reason="signals")
def test_signals_are_heard_while_grains_are_packed() -> None:
    heard: list[int] = []

    def hear(number: int, _: object) -> None:
        heard.append(number)
        # Signals that come while nobody listens are heard as one.
        if len(heard) == 3:
            raise KeyboardInterrupt

    before = signal.signal(signal.SIGALRM, hear)
    signal.setitimer(signal.ITIMER_REAL, 0.1, 0.1)
    try:
        with pytest.raises(KeyboardInterrupt):
            Simulation.preset("frictional", waves=1000)
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)


def test_what_cannot_change_says_so(small: Simulation) -> None:
    with pytest.raises(AttributeError, match="drive.force_amplitude is no parameter"):
        _ = small.force_amplitude
    with pytest.raises(ConfigurationError, match="width = 3.5 is above 3"):
        small.width = 3.5
    with pytest.raises(AttributeError):
        small.colour = 1  # type: ignore[attr-defined]
    assert small.width == 2.6


def test_keywords_and_dotted_keys_mean_the_same() -> None:
    one = Simulation.preset("frictionless", width=2.7, waves=2, initial_state="jammed", volume_fraction=0.1)
    other = Simulation.preset(
        "frictionless",
        {"drive.width": np.float64(2.7), "tube": {"waves": np.int64(2)}, "initial.state": "jammed"},
        volume_fraction=0.1,
    )
    assert one.configuration == other.configuration
    assert one.configuration.volume_fraction == pytest.approx(0.1, abs=0.01)


def test_errors_are_those_of_the_command_line() -> None:
    with pytest.raises(ConfigurationError, match="drive.width") as refused:
        Simulation.preset("frictionless", width=-1)
    assert isinstance(refused.value, ValueError)
    with pytest.raises(ConfigurationError, match="frictionles"):
        Simulation.preset("frictionles")
    with pytest.raises(ConfigurationError, match="widht"):
        Simulation.preset("frictionless", widht=2.6)
    with pytest.raises(DoesNotFitError, match="do not fit"):
        Simulation.preset("frictionless", number=20_000)
    with pytest.raises(TypeError, match="drive.width"):
        Simulation.preset("frictionless", width=object())


def test_snapshots_go_on_with_the_same_bits(small: Simulation, tmp_path: Path) -> None:
    small.run(periods=2)
    small.save(tmp_path / "here.snapshot")
    copies = [
        Simulation.load(tmp_path / "here.snapshot"),
        Simulation.from_bytes(small.to_bytes()),
        small.copy(),
        copy.copy(small),
        copy.deepcopy(small),
        pickle.loads(pickle.dumps(small)),
    ]
    small.run(periods=2)
    for other in copies:
        other.run(periods=2)
        assert same(small, other)
    assert [path.name for path in tmp_path.iterdir()] == ["here.snapshot"]
    damaged = bytearray(small.to_bytes())
    damaged[len(damaged) // 2] ^= 1
    for bytes_ in (bytes(damaged), b"", b"nothing of ours"):
        with pytest.raises(SnapshotError):
            Simulation.from_bytes(bytes_)


def test_frictional_grains_in_an_elastic_tube() -> None:
    sim = Simulation.preset("frictional", waves=2, grains_number=100, force_amplitude=0.003)
    sim.step(40)
    sim.force_amplitude = 0.004
    other = pickle.loads(pickle.dumps(sim))
    for each in (sim, other):
        each.step(40)
    assert same(sim, other) and sim.wall_positions.shape == (1012, 3)
    assert np.abs(sim.angular_velocities).max() > 0
    assert sim.heading == 1.0
    with pytest.raises(AttributeError, match="drive.width"):
        _ = sim.width


def test_callbacks_see_every_so_many_steps_and_cannot_advance(small: Simulation) -> None:
    seen: list[tuple[int, float]] = []

    def look(sim: Simulation) -> None:
        seen.append((sim.steps, float(sim.positions[0, 2])))
        with pytest.raises(RuntimeError, match="running already"):
            sim.step()
        with pytest.raises(ValueError, match="read-only"):
            sim.velocities[0] = 0

    plain = small.copy()
    small.step(100, callback=look, every=30)
    assert [steps for steps, _ in seen] == [30, 60, 90]
    plain.step(60)
    assert seen[1][1] == plain.positions[0, 2]
    plain.step(40)
    assert same(small, plain)


def test_periods_are_wavelengths_that_the_wave_runs_under_a_schedule_too(tmp_path: Path) -> None:
    ramp = {"form": "ramp", "parameter": "strain_rate", "from": 0.0, "to": 0.05, "end": 2}
    sim = Simulation.preset("frictionless", {"drive.schedule": ramp}, waves=2, seed=2)
    writer = Writer(tmp_path / "run.gsd", every=0.25, at=[0.6, "1t"])
    sim.run(periods=1, writers=[writer])
    # It is half as fast on average, and one wavelength has passed in two nominal periods.
    assert sim.period == pytest.approx(1, abs=0.002) and sim.time == pytest.approx(40, abs=0.1)
    assert writer.frames == 1 + 4 + 2
    sim.run(periods=2)
    assert sim.time == pytest.approx(80, abs=0.1)
    pause = {"form": "steps", "parameter": "strain_rate", "at": [1], "values": [0.0]}
    sim = Simulation.preset("frictionless", {"drive.schedule": pause}, waves=2, seed=2)
    with pytest.raises(ConfigurationError, match=r"stands still before it has run 1\.5 periods"):
        sim.run(periods=1.5)
    assert sim.steps == 0


def test_flow_rates_of_an_open_tube_are_over_the_length_between_its_ends() -> None:
    sim = Simulation.preset("silo", seed=1)
    sim.step(sim._run.steps_per_sample)
    series = sim.timeseries()
    inside = sim.positions[:, 2] if sim.heading > 0 else sim.configuration.length - sim.positions[:, 2]
    present = (inside >= 0) & (inside <= sim.length) & (np.hypot(*sim.positions[:, :2].T) < 2 * sim.wall_radius().max())
    flow = sim.heading * sim.velocities[present, 2].sum() / sim.length
    assert series["flow_rate_instantaneous"][-1] == pytest.approx(flow)
    assert sim.length == pytest.approx(sim.configuration.length - 4 * sim.diameters.max())


def test_a_path_is_text_and_endings_are_of_either_case(tmp_path: Path) -> None:
    Writer(tmp_path / "RUN.GSD")
    path = tmp_path / "grains.csv"
    path.write_text("diameter,fraction\n0.9,0.5\n1.1,0.5\n")
    sizes = {"grains.sizes": "table", "grains.file": path}
    assert peristalsis.Configuration("frictionless", sizes) == peristalsis.Configuration("frictionless", {**sizes, "grains.file": str(path)})


def test_callbacks_see_samples_in_however_many_pieces_a_simulation_is_run() -> None:
    sim = Simulation.preset("frictionless", waves=2, seed=1)
    seen: list[int] = []
    for _ in range(30):
        sim.step(3, callback=lambda it: seen.append(it.steps))
    each = sim._run.steps_per_sample
    assert seen == list(range(each, 91, each)) and len(seen) == len(sim.timeseries()["time"])


def test_what_a_callback_raises_ends_the_run_and_keeps_it(small: Simulation) -> None:
    plain = small.copy()

    def stop(sim: Simulation) -> None:
        if sim.steps >= 50:
            raise StopIteration

    with pytest.raises(StopIteration):
        small.step(1000, callback=stop, every=25)
    assert small.steps == 50
    small.step(50)
    plain.step(100)
    assert same(small, plain)


def test_threads_see_whole_steps_and_the_interpreter_is_free() -> None:
    sim = Simulation.preset("frictionless", seed=2)
    plain, times, busy = sim.copy(), [], threading.Event()

    def look() -> None:
        while not busy.is_set():
            times.append(sim.time)
            # Positions of one instant: the kinetic energy of a torn state would be anything.
            assert np.isfinite(sim.velocities).all()

    readers = [threading.Thread(target=look) for _ in range(3)]
    for reader in readers:
        reader.start()
    sim.step(60_000)  # many of the slices after which readers get their turn
    busy.set()
    for reader in readers:
        reader.join()
    plain.step(60_000)
    assert same(sim, plain)
    assert len(set(times)) > 2


def test_two_threads_cannot_run_one_simulation() -> None:
    sim = Simulation.preset("frictionless")
    started = threading.Event()
    outcome: list[BaseException] = []

    def second() -> None:
        started.wait()
        try:
            sim.step(1)
        except RuntimeError as error:
            outcome.append(error)

    thread = threading.Thread(target=second)
    thread.start()

    def tell(_: Simulation) -> None:
        started.set()
        thread.join(timeout=10)

    sim.step(10, callback=tell, every=10)
    assert "running already" in str(outcome[0])


@contextmanager
def stopped_soon() -> Iterator[None]:
    """Ctrl-C after 0.3 s ends what is done here within 3 s."""
    threading.Timer(0.3, os.kill, (os.getpid(), signal.SIGINT)).start()
    begin = time.monotonic()
    with pytest.raises(KeyboardInterrupt):
        yield
    assert time.monotonic() - begin < 3.0


@pytest.mark.skipif(os.name != "posix", reason="signals")
def test_ctrl_c_stops_soon_and_keeps_what_there_is(small: Simulation) -> None:
    plain = small.copy()
    with stopped_soon():
        small.run(periods=1e7)
    plain.step(small.steps)
    assert same(small, plain)
    small.step(10)


def test_tables_are_arrow(small: Simulation) -> None:
    import pandas
    import polars

    small.run(periods=4)
    table = small.timeseries()
    arrow, frame, other = pyarrow.table(table), polars.DataFrame(table), pandas.DataFrame.from_arrow(table)
    ratio = table["flow_rate_ratio"]
    assert len(table) == 80 and "time" in table and "nothing" not in table
    assert arrow["flow_rate_ratio"].to_pylist() == frame["flow_rate_ratio"].to_list() == list(other["flow_rate_ratio"]) == list(ratio)
    assert table.units["time"] == "t" and arrow.schema.field("time").metadata[b"unit"] == b"t"
    assert "peristalsis.configuration" in table.metadata
    # Whoever takes the table takes the same memory.
    addresses = [pyarrow.table(table)["time"].chunk(0).buffers()[1].address for _ in range(2)]
    assert addresses[0] == addresses[1] == arrow["time"].chunk(0).buffers()[1].address
    with pytest.raises(KeyError, match="there are time"):
        table["nothing"]
    assert {"density", "radius"} <= set(small.profile().column_names)
    assert len(small.waves()) == 8


def test_in_words(small: Simulation, capsys: pytest.CaptureFixture[str]) -> None:
    small.run(periods=1, progress=True)
    assert "100%" in capsys.readouterr().err
    assert "41 in 2 waves" in repr(small) and "width 2.6" in repr(small)
    assert small._repr_html_().startswith("<table>")
    assert "frictionless" in peristalsis.presets()


def test_a_run_as_a_function_goes_through_a_pool() -> None:
    from concurrent.futures import ProcessPoolExecutor
    from multiprocessing import get_context

    configs = [{"preset": "frictionless", "waves": 2, "run.periods": 2, "seed": seed} for seed in range(3)]
    with ProcessPoolExecutor(2, mp_context=get_context("spawn")) as pool:
        summaries = list(pool.map(peristalsis.run, configs))
    for config, summary in zip(configs, summaries, strict=True):
        here = peristalsis.run(config)
        assert summary["config"] == config and summary["flow_rate_ratio"] == here["flow_rate_ratio"]
    with pytest.raises(TypeError, match="preset or a file"):
        peristalsis.run({"width": 2.6})


def test_nonsense_lengths_are_refused(small: Simulation) -> None:
    for wrong in ({"periods": -1}, {"periods": float("nan")}, {"duration": float("inf")}):
        with pytest.raises(ValueError, match="above 0|finite number"):
            small.run(**wrong)
    with pytest.raises(TypeError):
        small.run(periods=1, duration=1)
    with pytest.raises(ValueError):
        small.step(-1)
    assert small.steps == 0


@pytest.mark.skipif(os.name != "posix", reason="signals")
def test_ctrl_c_is_heard_while_a_picture_is_drawn(small: Simulation) -> None:
    with stopped_soon():
        small.render(width=16_000)


@pytest.mark.skipif(not hasattr(os, "fork"), reason="forks")
@pytest.mark.filterwarnings("ignore:.*fork:DeprecationWarning")
@pytest.mark.parametrize("preset", ["frictionless-fine", "frictional"])
def test_a_fork_goes_on_with_threads_of_its_own(preset: str) -> None:
    from multiprocessing import get_context

    base = Simulation.preset(preset, waves=20)
    base.run(duration=0.5, threads=2)
    base.render(width=64)
    plain = base.copy()
    plain.run(duration=0.5, threads=2)

    def go_on() -> None:
        assert base.render(width=64).png == base.render(width=64).png
        for sim in (base.copy(), base):
            sim.profile()
            sim.run(duration=0.25, threads=2)
            sim.copy().run(duration=0.25, threads=2)
            sim.run(duration=0.25, threads=2)
            assert same(sim, plain)

    child = get_context("fork").Process(target=go_on)
    child.start()
    child.join(120)
    if child.is_alive():
        child.kill()
    assert child.exitcode == 0
    base.run(duration=0.5, threads=2)
    assert same(base, plain)


def test_a_file_takes_the_frames_of_one_writer(small: Simulation, tmp_path: Path) -> None:
    path = tmp_path / "same.gsd"
    (tmp_path / "other").symlink_to(tmp_path)
    two = [Writer(path, every=0.1, overwrite=True), Writer(tmp_path / "other/same.gsd", every=0.2, overwrite=True)]
    with pytest.raises(ValueError, match="another writer"):
        small.run(periods=1, writers=two)
    assert small.steps == 0 and not path.exists()
    small.add_writer(path, every=0.5)
    with pytest.raises(ValueError, match="another writer"):
        small.add_writer(path, every=0.5, overwrite=True)
    with pytest.raises(ValueError, match="another writer"):
        small.run(periods=1, writers=two[:1])
    other = small.copy()
    seen: list[str] = []

    def meanwhile(_: Simulation) -> None:
        with pytest.raises(ValueError, match="another writer"):
            other.run(periods=1, writers=two[:1])
        seen.append("refused")

    small.step(10, callback=meanwhile, every=10)
    assert seen == ["refused"]
    # Once nothing runs, an older file may be lost as before.
    other.run(periods=1, writers=two[:1])
    assert two[0].frames == 11


def test_doubts_are_told_of_a_run_that_fails() -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        fails, stops = (
            Simulation.preset("frictionless", waves=2, width=1.2, strain_rate=0.2, time_step=step) for step in (0.3, 0.05)
        )

    def stop(_: Simulation) -> None:
        raise LookupError

    for sim, error, callback in ((fails, peristalsis.DivergedError, None), (stops, LookupError, stop)):
        sim._told.clear()
        with pytest.raises(error), pytest.warns(peristalsis.PeristalsisWarning) as caught:
            sim.run(periods=10, callback=callback)
        assert {str(it.message) for it in caught} == {str(it) for it in sim.warnings}
        assert all(it.filename == __file__ for it in caught)
    # It goes no further, whatever is asked of it.
    with pytest.raises(peristalsis.DivergedError):
        fails.width = 2.6
    stops._told.clear()
    with warnings.catch_warnings(), pytest.raises(LookupError):
        warnings.simplefilter("error")
        stops.run(periods=1, callback=stop)


def test_mappings_are_asked_for_what_is_no_name(small: Simulation) -> None:
    configuration, table = small.configuration, small.timeseries()
    assert configuration.get(3) is None and configuration.get(None, 1) == 1 and 3 not in configuration and 3 not in table
    with pytest.raises(KeyError, match="no key 3"):
        configuration[3]
    with pytest.raises(KeyError, match="no column 0; there are time"):
        table[0]
    assert table.to_pandas().shape == (0, len(table.keys()))


def test_steps_beyond_reach_are_refused(small: Simulation) -> None:
    with pytest.raises(ValueError, match="steps is 1000000000000 or less"):
        small.step(10**30)


def test_a_key_that_is_given_twice_is_refused() -> None:
    def named(*words: str) -> str:
        return "(?s)" + ".*".join(words)

    with pytest.raises(ConfigurationError, match=named("drive_width", "width", "drive.width", "one of them")):
        Simulation.preset("frictionless-fine", drive_width=2.5, width=2.6)
    with pytest.raises(ConfigurationError, match=named(r"drive\['width'\]", "drive.width")):
        peristalsis.run({"preset": "frictionless-fine", "drive": {"width": 2.9}, "drive.width": 2.8})
    with pytest.raises(ConfigurationError, match=named("drive.width", "width")):
        peristalsis.Configuration("frictionless-fine").replace({"drive.width": 2.5}, width=2.5)


def test_a_study_is_no_configuration_of_one_run(tmp_path: Path) -> None:
    file = tmp_path / "study.toml"
    file.write_text("name = 'many'\npreset = 'frictionless'\n\n[base]\nrun.periods = 1\n")
    with pytest.raises(ConfigurationError, match="is a study, not the configuration of one run(?s:.*)study run"):
        Simulation.from_file(file)


def test_frames_stay_as_far_apart_where_the_speed_of_the_wave_is_set(tmp_path: Path) -> None:
    sim = Simulation.preset("frictionless-fine", waves=1, number=10, strain_rate=0.05, seed=1)
    writer = sim.add_writer(tmp_path / "run.parquet", every=0.5)
    seen: list[float] = []
    fire = writer._fire
    writer._fire = lambda it: (seen.append(it.period), fire(it))  # type: ignore[method-assign]
    sim.run(periods=1.2)
    sim.strain_rate = 0.1
    sim.run(periods=1.8)
    sim.strain_rate = 0.02
    sim.run(periods=0.25)
    sim.run(periods=0.8)
    assert seen == pytest.approx([0.5, 1, 1.5, 2, 2.5, 3, 3.5, 4], abs=0.01)


def test_a_folder_of_tables_that_is_begun_anew_holds_no_older_frames(tmp_path: Path) -> None:
    path = tmp_path / "run.parquet"
    for seed, every in ((1, 0.5), (2, 1.0)):
        sim = Simulation.preset("frictionless-fine", waves=1, number=10, strain_rate=0.05, seed=seed)
        sim.run(periods=1, writers=[Writer(path, every=every, overwrite=True)])
        if seed == 1:
            (path / "notes.txt").touch()
    assert len(list(path.iterdir())) == 2 + 1


def test_averages_over_grains_that_were_placed_are_those_of_these() -> None:
    tube = peristalsis.Configuration("frictionless-fine", {"drive.body_force": -0.002}, waves=2, strain_rate=0.05, width=2.6)
    places = np.c_[np.zeros((15, 2)), np.arange(15) * 1.3 + 0.2]
    for diameters in (np.r_[0.4, np.ones(14)], np.full(15, 0.7)):
        sim = Simulation.from_positions(tube, places, diameters=diameters)
        expected = (diameters**3).sum() / (6 * tube["tube.radius"] ** 2 * tube.length)
        assert sim.configuration.volume_fraction == pytest.approx(expected)
        # The pressure rise -N m g lambda/(L pi a^2), m = d^3 averaged over these.
        rise = 0.002 * (diameters**3).sum() / (2 * np.pi * tube["tube.radius"] ** 2)
        sim.run(periods=1)
        assert sim.summary()["pumping"]["pressure_rise"] == pytest.approx(rise)
        again = Simulation.from_bytes(sim.to_bytes())
        assert again.configuration == sim.configuration
