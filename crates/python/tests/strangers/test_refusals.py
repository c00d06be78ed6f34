"""What cannot be is refused at once, in the words of the caller."""

import fcntl
import os
import re
import warnings
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

import peristalsis
from peristalsis import Configuration, ConfigurationError, PeristalsisWarning, Simulation, Writer, analysis, newtonian, plot

Act = Callable[[Simulation], object]


@pytest.fixture
def tight() -> Simulation:
    return Simulation.preset("frictionless-fine", waves=2, strain_rate=0.05, seed=1)


@pytest.mark.parametrize(
    ("act", "kind", "words"),
    [
        (lambda sim: sim.run(periods=1, writers="x"), TypeError, "writers is a list of peristalsis.Writer"),
        (lambda sim: sim.run(periods=1, writers=3), TypeError, "writers is a list of peristalsis.Writer"),
        (lambda sim: sim.run(periods=1, writers=["x.gsd"]), TypeError, "not of 'x.gsd'"),
        (lambda sim: sim.add_writer(3), TypeError, "path is the name of a file, not 3"),
        (lambda sim: sim.add_writer(Writer("a.gsd"), 0.5), TypeError, "add_writer takes a Writer, or"),
        (lambda sim: sim.run(periods=1, callback=3), TypeError, "callback is a function, or a list of functions"),
        (lambda sim: sim.run(periods=1, callback=[(print, 1, 2)]), TypeError, "pairs (function, every)"),
        (lambda sim: sim.run(periods=1, callback=print, every=0.5), TypeError, "every is a whole number, not 0.5"),
        (lambda sim: sim.run(periods="a"), TypeError, "periods is a number, not 'a'"),
        (lambda sim: sim.run(duration=[1, 2]), TypeError, "duration is a number, not [1, 2]"),
        (lambda sim: sim.run(periods=1e300), ConfigurationError, "beyond reach"),
        (lambda sim: sim.run(periods=0), ValueError, "periods is a number above 0, not 0"),
        (lambda sim: sim.run(periods=-1), ValueError, "periods is a number above 0, not -1"),
        (lambda sim: sim.run(periods=np.nan), ValueError, "periods is a finite number, not nan"),
        (lambda sim: sim.run(periods=1, threads=0), ValueError, "threads is 1 or more"),
        (lambda sim: sim.ramp("width", "a", 3, periods=4, levels=2), TypeError, "start is a number, not 'a'"),
        (lambda sim: setattr(sim, "width", "a"), TypeError, "width is a number, not 'a'"),
        (lambda sim: setattr(sim, "strain_rate", None), TypeError, "strain_rate is a number, not None"),
        (lambda sim: Writer("x.gsd", every=-1), ValueError, "every = -1 is no span"),
        (lambda sim: Writer("x.gsd", every=0), ValueError, "every = 0 is no time"),
        (lambda sim: Writer("x.gsd", every="often"), ValueError, "every = 'often' is no span"),
        (lambda sim: Writer("x.gsd", at=[1, "x"]), ValueError, "at = 'x' is no span"),
        (lambda sim: Writer("x.gsd", at=[]), ValueError, "at is empty"),
        (lambda sim: plot.hysteresis(3), TypeError, "loop is what Simulation.ramp answered, not 3"),
        (lambda sim: plot.flow(3), TypeError, "simulation is a peristalsis.Simulation, not 3"),
        (lambda sim: plot.snapshot("x"), TypeError, "simulation is a peristalsis.Simulation, not 'x'"),
        (lambda sim: plot.survival([1.0]), TypeError, "curve is a peristalsis.analysis.Survival"),
        (lambda sim: plot.collapse(3, [1.0]), TypeError, "what is a peristalsis.analysis.Collapse"),
        (lambda sim: plot.profile(sim), ValueError, "run the simulation longer"),
        (lambda sim: Simulation("frictionless"), TypeError, "configuration is a peristalsis.Configuration"),
        (lambda sim: analysis.Collapse([], "finite"), ValueError, 'scaling is "finite_size", "critical_line"'),
        (lambda sim: analysis.Collapse([], {"known": [1]}), ValueError, '{"critical_known": [x_c, ...]}'),
        (lambda sim: Simulation.from_positions(sim.configuration, [[0, 0, "a"]]), TypeError, "positions is an array of numbers"),
    ],
)  # fmt: skip
def test_what_cannot_be_is_refused_in_the_words_of_the_caller(act: Act, kind: type, words: str, tight: Simulation) -> None:
    with pytest.raises(kind, match=re.escape(words)):
        act(tight)
    assert tight.steps == 0


def test_one_writer_a_pair_and_a_writer_of_ones_own_are_taken(tight: Simulation, tmp_path: Path) -> None:
    seen: list[int] = []
    tight.add_writer(own := Writer(tmp_path / "own.gsd", every=0.5))
    tight.run(periods=1, writers=(one := Writer(tmp_path / "one.gsd", at=1)), callback=[(lambda sim: seen.append(sim.steps), 100)])
    assert (own.frames, one.frames, seen[0]) == (3, 1, 100)


def test_diameters_are_named_by_their_place(tight: Simulation) -> None:
    with pytest.raises(ConfigurationError, match=r"diameters\[1\] = -2.0 is no diameter"):
        Simulation.from_positions(tight.configuration, [[0, 0, 1], [0, 0, 5]], diameters=[1, -2])


@pytest.mark.parametrize("seed", ["a", 1.5, -1, None, True, 2**64, [1, 2]])
def test_a_seed_that_is_none_names_the_generator(seed: object) -> None:
    with pytest.raises(ConfigurationError, match=r"run.seed = .*\n.*0 to 2\*\*63 - 1, or a numpy.random.Generator"):
        Configuration("frictionless", seed=seed)  # type: ignore[arg-type]
    assert Configuration("frictionless", seed=np.int64(3)).seed == 3


def test_a_complete_run_that_is_run_again_says_so() -> None:
    sim = Simulation.preset("frictionless-fine", waves=2, strain_rate=0.05, seed=1, periods=1)
    sim.run()
    with pytest.warns(PeristalsisWarning, match="the run is complete.*periods or duration"):
        sim.run()


def test_public_modules_list_public_names_alone() -> None:
    assert dir(peristalsis) == sorted([*peristalsis.__all__, "plot"])
    for module in (analysis, newtonian, plot):
        assert dir(module) == sorted(module.__all__)


def test_a_scaling_may_answer_an_array_and_says_what_else_it_answered() -> None:
    x = np.linspace(-0.5, 0.5, 21)
    curves = [(size, x, size**-0.5 / (1 + np.exp(x * size)), np.full(21, 0.003)) for size in (4.0, 8.0)]

    def scaled(answer: Callable[..., object]) -> analysis.CollapseQuality:
        return analysis.Collapse(curves, lambda a, p, x, y, e: answer(x * p ** a[1], y * p ** a[0], e * p ** a[0])).quality([0.5, 1])

    assert scaled(lambda *three: np.array(three)) == scaled(lambda *three: three)
    for wrong in (lambda *three: np.ones(5), lambda *three: 3, lambda *three: ("a", "b", "c")):
        with pytest.raises(TypeError, match="three numbers"):
            scaled(wrong)


def test_what_is_known_of_a_collapse_counts_as_points() -> None:
    x = np.linspace(-0.5, 0.5, 21)
    curves = [(size, x, size**-0.5 / (1 + np.exp(x * size)), np.full(21, 0.003)) for size in (4.0, 8.0, 16.0)]
    collapse, start, steps = analysis.Collapse(curves, "finite_size"), [0.4, 0.9, 0.0], [0.1, 0.1, 0.02]
    free = collapse.fit(start, steps, starts=1)
    held = collapse.fit(start, steps, starts=1, known=[None, (1.0, 1e-4), None])
    assert held.errors[1] < 1e-3 < free.errors[1] and held.errors[0] < free.errors[0]
    with pytest.raises(ValueError, match="one of the two"):
        collapse.fit(start, steps, known=[(0.5, 0.1)], leave_one_out=True)


@pytest.mark.parametrize(("parameter", "first", "last"), [("width", 2.4, 2.8), ("strain_rate", 0.05, 0.13)])
def test_the_configuration_of_a_ramp_ends_where_the_ramp_did(parameter: str, first: float, last: float) -> None:
    sim = Simulation.preset("frictionless-fine", waves=2, strain_rate=0.05, seed=1, periods=0.5)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        sim.ramp(parameter, first, last, periods=6.37, levels=3, back=False)  # type: ignore[arg-type]
        again = Simulation(sim.configuration)
        again.run()
    assert sim.configuration.steps == sim.steps == again.steps
    assert np.array_equal(again.positions, sim.positions)


def test_the_state_of_a_run_at_work_is_not_written_over(tmp_path: Path) -> None:
    sim = Simulation.preset("frictionless-fine", waves=2, strain_rate=0.05, seed=1)
    state = tmp_path / "state.checkpoint"
    (tmp_path / "config.toml").write_text(sim.configuration.to_toml())
    sim.save(state)
    before = state.read_bytes()
    sim.step()
    at_work = os.open(tmp_path, os.O_RDONLY)
    try:
        fcntl.flock(at_work, fcntl.LOCK_EX)
        with pytest.raises(OSError, match="being worked on by another program"):
            sim.save(state)
        assert state.read_bytes() == before
        sim.save(tmp_path / "other.checkpoint")
    finally:
        os.close(at_work)
    sim.save(state)
    assert Simulation.load(tmp_path).steps == 1
    with pytest.raises(OSError, match="none"):
        sim.save(tmp_path / "none" / "a.checkpoint")


def test_keys_and_parameters_that_are_not_there_name_those_that_are(tight: Simulation) -> None:
    """What one mistypes is answered with what one meant."""
    with pytest.raises(KeyError, match="did you mean 'drive.width'"):
        tight.configuration["widht"]
    with pytest.raises(AttributeError, match="whose drive.control has width"):
        _ = tight.force_amplitude
    for wrong in (3, "frictionless"):
        with pytest.raises(TypeError, match="config is a mapping with preset or file"):
            peristalsis.run(wrong)  # type: ignore[arg-type]
    with pytest.raises(TypeError, match="z is an array of numbers, not 'a'"):
        tight.wall_radius("a")
