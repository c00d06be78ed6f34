"""Studies from Python: planned, worked on, stopped, gone on with, read."""

import os
import pickle
import signal
import threading
from pathlib import Path

import polars
import pytest

import peristalsis

WIDTHS = {
    "name": "widths",
    "preset": "frictionless",
    "replicates": 2,
    "base": {"tube.waves": 2, "run.periods": 3},
    "axes": [{"key": "drive.width", "values": [2.6, 2.8]}],
}


def test_a_study_from_its_plan_to_its_rows(tmp_path: Path) -> None:
    study = peristalsis.study(WIDTHS, store=tmp_path / "store")
    plan = study.plan()
    assert [run.settings["drive.width"] for run in plan] == [2.6, 2.6, 2.8, 2.8]
    assert study.run(workers=2) == "complete" and study.counts() == {"done": 4}
    rows = polars.DataFrame(study.rows())
    assert len(rows) == 4
    # A run of the study is the run of its configuration.
    simulation = peristalsis.Simulation(plan[0].configuration)
    simulation.run()
    row = dict(zip(rows.columns, rows.rows()[0], strict=True))
    assert row["flow_rate_ratio"] == simulation.summary()["flow_rate_ratio"]
    assert study.run(workers=1) == "complete"
    again = peristalsis.Study.open(tmp_path / "store")
    assert again.name == "widths" and polars.DataFrame(again.rows()).equals(rows, null_equal=True)
    for known in (study, again):
        unpickled = pickle.loads(pickle.dumps(known))
        assert unpickled.store == study.store and unpickled.counts() == {"done": 4}
        assert [run.identity for run in unpickled.plan()] == [run.identity for run in plan]
    files = study.export(tmp_path / "tables")
    assert files and all(Path(file).exists() for file in files)
    assert "4 runs planned" in repr(study)


def test_runs_that_fail_are_told(tmp_path: Path) -> None:
    crowded = {**WIDTHS, "base": {"tube.waves": 2, "run.periods": 1}, "axes": [{"key": "grains.number", "values": [20, 20_000]}]}
    study = peristalsis.study(crowded, store=tmp_path / "store")
    for _ in range(2):
        with pytest.warns(peristalsis.PeristalsisWarning, match="2 of 4 runs failed: widths-failed.csv") as told:
            assert study.run(workers=1) == "complete"
        assert told[0].filename == __file__ and str(tmp_path / "store") in str(told[0].message)
    reasons = next(Path(file) for file in study.export(tmp_path / "tables") if file.endswith("widths-failed.csv"))
    assert "20000 grains do not fit" in reasons.read_text()


def test_an_edited_study_has_its_own_runs_alone(tmp_path: Path) -> None:
    study = peristalsis.study(WIDTHS, store=tmp_path / "store")
    study.run(workers=2)
    edited = peristalsis.study({**WIDTHS, "axes": [{"key": "drive.width", "values": [2.8, 2.9]}]}, store=tmp_path / "store")
    assert edited.counts() == {"done": 2, "pending": 2} and set(edited.rows()["drive.width"]) == {2.8}
    assert peristalsis.Study.open(tmp_path / "store").counts() == {"done": 4}
    edited.run(workers=2)
    assert set(study.rows()["drive.width"]) == {2.6, 2.8} and study.counts() == {"done": 4}
    stranger = peristalsis.study({**WIDTHS, "name": "others"}, store=tmp_path / "store")
    for ask in (stranger.counts, stranger.rows, stranger.run, lambda: stranger.export(tmp_path / "tables")):
        with pytest.raises(peristalsis.StudyFailure, match="holds the study `widths`, not `others`"):
            ask()


def test_from_a_file(tmp_path: Path) -> None:
    path = tmp_path / "study.toml"
    path.write_text('name = "one"\npreset = "frictionless"\nreplicates = 3\n')
    assert len(peristalsis.study(path).plan()) == 3
    assert peristalsis.study(path).store == Path("stores", "one")


def test_what_is_wrong_is_said_with_its_key(tmp_path: Path) -> None:
    with pytest.raises(peristalsis.ConfigurationError, match="drive.widht"):
        peristalsis.study({**WIDTHS, "axes": [{"key": "drive.widht", "values": [2.6]}]}).plan()
    with pytest.raises(peristalsis.StudyFailure):
        peristalsis.Study.open(tmp_path)


@pytest.mark.skipif(os.name != "posix", reason="signals")
def test_ctrl_c_saves_every_run_and_the_next_call_goes_on(tmp_path: Path) -> None:
    long = {**WIDTHS, "base": {"tube.waves": 2, "run.periods": 3000}}
    study = peristalsis.study(long, store=tmp_path / "store")
    timer = threading.Timer(1.0, os.kill, (os.getpid(), signal.SIGINT))
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        study.run(workers=2)
    assert study.run(workers=2, limit=0.5) == "time_up"


def test_workers_and_limits_that_there_are_not(tmp_path: Path) -> None:
    study = peristalsis.study(WIDTHS, store=tmp_path / "store")
    for workers in (0, -1, 50_000):
        with pytest.raises(ValueError, match="workers is 1"):
            study.run(workers=workers)
    for limit in (float("nan"), 0.0):
        with pytest.raises(ValueError, match="limit is a"):
            study.run(limit=limit)
