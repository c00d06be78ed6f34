"""Inputs of any kind are what they say, or are refused: none is taken for something else."""

import copy
import pickle
from pathlib import Path

import numpy as np
import pytest

import peristalsis
from peristalsis import AnalysisError, Configuration, ConfigurationError, Simulation, analysis, newtonian

WIDTHS = [2.4, 2.5, 2.6, 2.7]
STUDY = {"name": "inputs", "preset": "frictionless-fine"}


def test_the_names_of_the_columns_of_a_frame_are_no_replicates() -> None:
    """A frame is iterated over by its names, which pandas makes 0, 1, 2: each was taken for a replicate of one value."""
    import pandas
    import polars

    table = np.arange(12.0).reshape(3, 4)
    for frame in (pandas.DataFrame(table.T), pandas.DataFrame(table.T, columns=["0", "1", "2"])):
        for moments in (analysis.second_moment, analysis.ensemble_moments):
            with pytest.raises((ValueError, TypeError), match="a column has one dimension, not 0|an array of numbers is wanted"):
                moments(frame)
    columns = pandas.DataFrame(table.T)
    means = [[it.mean for it in analysis.second_moment(rows)] for rows in (table, polars.DataFrame(table.T), columns.to_numpy().T)]
    assert means == [[4.0, 5.0, 6.0, 7.0]] * 3
    with pytest.raises(ValueError, match="one dimension, not 0"):
        analysis.fit_line(WIDTHS, WIDTHS, 0.1)


@pytest.mark.parametrize(
    "values",
    [
        np.arange(16) + 1j,
        np.arange(16).astype("M8[s]"),
        np.arange(16).astype("m8[s]"),
        [str(value) for value in range(16)],
    ],
)
def test_complex_numbers_times_and_texts_are_no_numbers(values: object) -> None:
    """The imaginary part was dropped, and a time counted in its unit, whichever that was."""
    sim = Simulation.preset("frictionless-fine", waves=2, strain_rate=0.05)
    for refuse in (
        lambda: analysis.mean_with_error(values),
        lambda: analysis.Survival([1.0, 2.0]).at(values),
        lambda: newtonian.flow_rate_ratio(values),
        lambda: newtonian.field(newtonian.Newtonian(0.5), values, 0.0),
        lambda: sim.wall_radius(values),
    ):
        with pytest.raises(TypeError, match="array of numbers"):
            refuse()


def test_what_was_given_is_kept_as_it_was() -> None:
    """An array that its owner filled anew changed the median of runs, but not their curve, and the curves of a collapse."""
    time, observed = np.array([1.0, 2.0, 3.0]), np.array([True, True, False])
    x = np.linspace(-0.5, 0.5, 21)
    y, error = 1 / (1 + np.exp(4 * x)), np.full(21, 0.01)
    survival = analysis.Survival(time, observed)
    collapse = analysis.Collapse([(4.0, x, y, error), (8.0, 0.5 * x, y, error)], "finite_size")
    before = survival.median, collapse.quality([0.0, 1.0, 0.0])
    for array in (time, observed, x, y, error):
        array[:] = 1
    assert (survival.median, collapse.quality([0.0, 1.0, 0.0])) == before


def test_the_missing_outcome_is_named() -> None:
    import pandas

    with pytest.raises(AnalysisError, match="value 1 is <NA>"):
        analysis.Survival([1.0, 2.0, 3.0], pandas.Series([True, None, False], dtype="boolean"))


def test_survival_at_no_time_is_not_known() -> None:
    """It was 0, as after the last transition."""
    found = analysis.Survival([1.0, 2.0]).at([0.0, np.nan, 1.0])
    np.testing.assert_array_equal(found, [1.0, np.nan, 0.5])
    assert analysis.Survival([1.0, 2.0]).at(1.0).shape == ()


def test_a_known_width_has_no_error_below_0() -> None:
    """Such an error was passed on, and the interval went from its upper end to its lower."""
    values, errors = [1.0, 2.0, 4.0, 9.0], [0.1] * 4
    branch = (WIDTHS, values, errors)
    for refuse in (
        lambda: analysis.fit_law("power", *branch, critical_width=(2.8, -0.1)),
        lambda: analysis.fit_law_to_nearest("power", *branch, critical_width=(2.8, -0.1)),
        lambda: analysis.jump_height(branch, branch, (2.8, -0.1)),
    ):
        with pytest.raises(AnalysisError, match="must not be negative"):
            refuse()


def test_whole_numbers_are_not_cut() -> None:
    sample, runs = np.sin(np.arange(16.0)), [[1.0, 2.0], [2.0, 3.0], [3.0]]
    for refuse in (
        lambda: analysis.dip_test(sample, resamples=20.7),  # type: ignore[arg-type]
        lambda: analysis.dip_test(sample, seed=1.5),  # type: ignore[arg-type]
        lambda: analysis.second_moment(runs, held=1.5),  # type: ignore[arg-type]
        lambda: analysis.second_moment_peak(runs, resamples="30"),  # type: ignore[arg-type]
    ):
        with pytest.raises(TypeError, match="is a whole number"):
            refuse()
    for refuse in (
        lambda: analysis.dip_test(sample, seed=-1),
        lambda: analysis.dip_test(sample, resamples=-1),
        lambda: analysis.second_moment(runs, held=0),
    ):
        with pytest.raises(ValueError, match="or more, not"):
            refuse()


def test_a_collapse_wants_numbers_that_are_some() -> None:
    x = np.linspace(-0.5, 0.5, 21)
    curves = [(size, x, size**-0.5 / (1 + np.exp(x * size)), np.full(21, 0.003)) for size in (4.0, 8.0, 16.0)]
    collapse = analysis.Collapse(curves, "finite_size")
    start, steps = [0.4, 0.9, 0.0], [0.1, 0.1, 0.02]
    for power in (np.nan, np.inf):
        with pytest.raises(AnalysisError, match="not a finite number"):
            collapse.fit(start, steps, starts=1, correction=power)
    with pytest.raises(TypeError, match="starts is a whole number"):
        collapse.fit(start, steps, starts=1.5)  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="seed is 0 or more"):
        collapse.fit(start, steps, seed=-1)
    found = collapse.fit(start, steps, starts=2, leave_one_out=True)
    with pytest.raises(AnalysisError, match="claimed has 1 values of 3 parameters"):
        collapse.joint_test(found, [0.5], steps)
    with pytest.raises(ValueError, match="claimed is a finite number"):
        collapse.joint_test(found, [0.5, np.nan, None], steps)
    # Results with arrays are compared as those without.
    assert pickle.loads(pickle.dumps(found)) == found
    assert collapse.fit(start, steps, starts=2) != found != 3


def test_loops_are_compared() -> None:
    sim = Simulation.preset("frictionless-fine", waves=2, strain_rate=0.05, seed=1)
    loop = sim.ramp("width", 2.4, 2.8, periods=4, levels=2, back=False)
    assert pickle.loads(pickle.dumps(loop)) == loop
    assert sim.ramp("width", 2.4, 2.8, periods=4, levels=2) != loop


def test_a_newtonian_flow_is_pickled_and_copied() -> None:
    flow = newtonian.Newtonian.from_flow_rate(0.3, 0.1)
    for protocol in range(pickle.HIGHEST_PROTOCOL + 1):
        assert pickle.loads(pickle.dumps(flow, protocol)) == flow
    assert copy.copy(flow) == copy.deepcopy(flow) == flow
    with pytest.raises(ValueError, match="3 radii, but 2 positions"):
        flow.field(np.zeros(3), np.zeros(2))
    for pressure in (np.nan, np.inf):
        with pytest.raises(ValueError, match="the pressure is finite"):
            newtonian.trapping_threshold(pressure)


def test_a_study_takes_what_a_configuration_takes() -> None:
    import polars

    def configuration(base: dict[object, object]) -> Configuration:
        return peristalsis.study({**STUDY, "base": base}).plan()[0].configuration

    # An array of no dimension was cut to a whole number.
    assert configuration({"drive.width": np.array(2.6)})["drive.width"] == 2.6
    assert configuration({"tube.waves": np.array(2)})["tube.waves"] == 2
    assert configuration({"drive": {"width": 2.6}, "drive.strain_rate": 0.1})["drive.width"] == 2.6
    for values in (polars.Series(WIDTHS), {width: 1 for width in WIDTHS}.keys(), (width for width in WIDTHS)):
        plan = peristalsis.study({**STUDY, "axes": [{"key": "drive.width", "values": values}]}).plan()
        assert [run.settings["drive.width"] for run in plan] == WIDTHS
    # A truth value of NumPy was the number 1.0.
    for value in (False, np.bool_(False)):
        study = peristalsis.study({"name": "truth", "preset": "frictional", "base": {"wall.keep.balance": value}})
        assert study.plan()[0].configuration["wall.keep.balance"] is False
    with pytest.raises(TypeError, match="title: None is no number, text"):
        peristalsis.study({**STUDY, "title": None})
    with pytest.raises(TypeError, match="a key is text, not 3"):
        configuration({3: 1})


def test_what_a_configuration_cannot_take_is_named() -> None:
    with pytest.raises(ConfigurationError, match="tube.waves = 18446744073709551615 is beyond reach"):
        Configuration("frictionless", waves=np.uint64(2**64 - 1))  # type: ignore[arg-type]
    with pytest.raises(TypeError, match="overrides is a mapping of dotted keys, not"):
        Configuration("frictionless", [("drive.width", 2.6)])  # type: ignore[arg-type]
    with pytest.raises(TypeError, match="a key is text, not 3"):
        Configuration("frictionless", {3: 1})  # type: ignore[dict-item]
    with pytest.raises(ConfigurationError, match="Simulation.preset name it first") as refused:
        Configuration("frictionless").replace({"preset": "frictional"})
    assert "--" not in str(refused.value)


def test_a_file_that_is_no_text_is_named(tmp_path: Path) -> None:
    """A `UnicodeDecodeError` does not say which file it was."""
    file = tmp_path / "tube.toml"
    file.write_bytes(b"preset = 'frictionless'\n# 1 \xb5m\n")
    for read in (Simulation.from_file, peristalsis.study):
        with pytest.raises(ConfigurationError, match="tube.toml: line 2 is not text in UTF-8"):
            read(file)


def test_a_section_is_at_one_place() -> None:
    sim = Simulation.preset("frictionless-fine", waves=2, strain_rate=0.05)
    with pytest.raises(ValueError, match="at place or at position, not at both"):
        sim.render(view="section", place=1.0, position=0.5)
    for name in ("place", "position"):
        with pytest.raises(ValueError, match=f"{name} is a finite number"):
            sim.render(view="section", **{name: np.inf})  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="width is 0 or more, not -5"):
        sim.render(width=-5)


def test_a_study_keeps_the_tables_that_it_names(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The store's copy of the file named a table beside the file, so that nobody could read the store."""
    (tmp_path / "of" / "them").mkdir(parents=True)
    turns = 2.3999632 * np.arange(560)
    for name, shift in (("a", 0.0), ("b", 0.01)):
        rows = (f"{angle:.6f},{place:.6f}\n" for angle, place in zip(turns, shift + np.arange(560) / 28))
        (tmp_path / "of" / f"{name}.csv").write_text("angle,place\n" + "".join(rows))
    (tmp_path / "of" / "sizes.csv").write_text("diameter,fraction\n0.9,0.5\n1.1,0.5\n")
    (tmp_path / "of" / "them" / "tube.toml").write_text(
        "preset = 'frictionless'\nrun.periods = 0.1\n[tube]\nwaves = 2\narrangement = 'file'\nfile = '../a.csv'\n"
    )
    (tmp_path / "of" / "study.toml").write_text(
        "name = 'tables'\nfile = 'them/tube.toml'\n[base.grains]\nsizes = 'table'\nfile = 'sizes.csv' # of them\n"
        "[[axes]]\nkey = 'tube.file'\nvalues = ['a.csv', 'b.csv']\n"
    )
    monkeypatch.chdir(tmp_path / "of")
    study = peristalsis.study("study.toml", store=tmp_path / "store")
    plan = study.plan()
    assert study.run(workers=1) == "complete"
    for name in ("a", "b", "sizes"):
        (tmp_path / "of" / f"{name}.csv").unlink()
    monkeypatch.chdir(tmp_path)
    again = peristalsis.Study.open("store")
    assert [run.identity for run in again.plan()] == [run.identity for run in plan]
    assert again.run(workers=1) == "complete" and again.counts() == {"done": 2}
    assert len(again.rows()) == 2 and again.export("tables")
    assert len(list((tmp_path / "store" / "tables").iterdir())) == 3
    assert "# of them" in (tmp_path / "store" / "study.toml").read_text()


def test_what_is_unpickled_elsewhere_has_the_same_store(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "sizes.csv").write_text("diameter,fraction\n0.9,0.5\n1.1,0.5\n")
    monkeypatch.chdir(tmp_path)
    base = {"run.periods": 0.1, "tube.waves": 2, "grains.sizes": "table", "grains.file": Path("sizes.csv")}
    study = peristalsis.study({"name": "elsewhere", "preset": "frictionless-fine", "base": base})
    study.run(workers=1)
    pickles = [pickle.dumps(it) for it in (study, peristalsis.Study.open("stores/elsewhere"))]
    (tmp_path / "else").mkdir()
    monkeypatch.chdir(tmp_path / "else")
    for it in pickles:
        again = pickle.loads(it)
        assert again.store == tmp_path / "stores" / "elsewhere" and again.counts() == {"done": 1}
    assert study.store == Path("stores", "elsewhere")


def test_complex_scalars_are_no_numbers() -> None:
    sim = Simulation.preset("frictionless-fine", waves=2, strain_rate=0.05)
    for value in (np.complex128(2.5 + 1j), np.complex64(2.5)):
        with pytest.raises(TypeError, match="is no number"):
            Configuration("frictionless", width=value)  # type: ignore[arg-type]
        with pytest.raises(TypeError, match="width is a number"):
            sim.width = value  # type: ignore[assignment]
