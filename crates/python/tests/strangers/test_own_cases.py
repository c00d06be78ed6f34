"""What a newcomer's own cases met."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from peristalsis import AnalysisError, ConfigurationError, Loop, Simulation, Table, analysis, newtonian


class Interrupted:
    """A run that Ctrl-C interrupts just after its steps, as the interpreter does when they return."""

    def __init__(self, run: Any) -> None:
        self.run = run

    def advance(self, steps: int, seconds: float) -> int:
        self.run.advance(steps, seconds)
        raise KeyboardInterrupt

    def __getattr__(self, name: str) -> Any:
        return getattr(self.run, name)


def test_an_interrupt_loses_no_call() -> None:
    sim = Simulation.preset("frictionless-fine", waves=2, strain_rate=0.05, width=2.9, seed=1)
    calls: list[int] = []
    run = sim._run
    sim._run = Interrupted(run)  # type: ignore[assignment]
    with pytest.raises(KeyboardInterrupt):
        sim.step(9, callback=lambda it: calls.append(it.steps), every=3)
    sim._run = run
    sim.step(3, callback=lambda it: calls.append(it.steps), every=3)
    assert calls == [3, 6]


def test_rows_with_the_names_of_keys_are_objects_too() -> None:
    table = Table([("drive.width", "d", "", np.array([1.0, 2.0])), ("state", "", "", ["rest", "jammed"])])
    first, second = np.asarray(table)
    assert getattr(first, "drive.width") == 1.0 and second.state == "jammed"


@pytest.mark.parametrize(
    ("columns", "error", "words"),
    [
        ([("a", "1", "", np.ma.array([1.0, 2.0], mask=[False, True]))], ValueError, "column a: value 1 is masked"),
        ([("a", "1", "", [1, 2.5])], TypeError, "column a must be an array"),
        ([], ValueError, "one column"),
    ],
)
def test_what_is_no_table_is_said_by_its_column(columns: list[tuple[str, str, str, object]], error: type[Exception], words: str) -> None:
    with pytest.raises(error, match=words):
        Table(columns)  # type: ignore[arg-type]


def test_truth_values_are_no_numbers() -> None:
    sim = Simulation.preset("frictionless-fine", waves=2, seed=1)
    with pytest.raises(TypeError, match="width is a number, not True"):
        sim.width = True
    with pytest.raises(TypeError, match="periods is a number, not True"):
        sim.run(periods=True)


@pytest.mark.parametrize(
    ("ratio", "found"),
    [([0.9, np.nan, 0.1], (2.7, 2.6, 2.8)), ([0.9, 0.5, 0.4], (2.7, 2.6, 2.8)), ([0.9, 0.5, 0.9], None), ([0.9, 0.7, 0.3], (2.75, 2.7, 2.8))],
)
def test_a_threshold_is_crossed_from_one_side_to_the_other(ratio: list[float], found: tuple[float, ...] | None) -> None:
    loop = Loop("width", ("there",) * 3, np.array([2.6, 2.7, 2.8]), np.array(ratio), np.zeros(3), 0.5)
    there = loop.thresholds.there
    assert there is None if found is None else tuple(there or ()) == pytest.approx(found)


def test_errors_name_the_argument() -> None:
    with pytest.raises(AnalysisError, match="direction is"):
        analysis.transition_time([0.0, 1.0, 1.0, 1.0], direction="up")  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="the radius is a finite number above 0, not 0"):
        newtonian.flow_rate_ratio(2.0, radius=0.0)
    with pytest.raises(ConfigurationError, match="did you mean .*'static_friction'"):
        Simulation.preset("frictionless-fine", friction=0.3)


def test_contacts_have_one_dimension_however_many_there_are() -> None:
    xarray = pytest.importorskip("xarray")
    table = Table([("i", "1", "", np.array([1, 2])), ("j", "1", "", np.array([3, 4]))])
    assert isinstance(table.to_xarray(), xarray.Dataset) and table.to_xarray().sizes == {"row": 2}
