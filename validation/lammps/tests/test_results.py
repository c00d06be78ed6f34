"""Growth rates, joint errors, tables and the store."""

from pathlib import Path

import numpy as np
import pytest
from chaos import Growth, growth_rate
from report import Section, chance, table, with_error
from stationary import POINTS, compare
from store import Store


def test_growth_is_that_of_an_exponential() -> None:
    times = np.arange(0, 200, 0.5)
    distances = np.minimum(1e-12 * np.exp(0.25 * times), 2.0)
    assert growth_rate(times, distances) == pytest.approx(0.25)
    # One that begins too late says nothing.
    assert growth_rate(times, np.maximum(distances, 1e-5)) is None
    assert Growth.of([1.0, 3.0]) == Growth(2.0, 1.0, 2)


def test_deviations_are_in_joint_errors() -> None:
    result = compare(POINTS[0], "contacts", [1.0, 3.0, 1.0, 3.0], [4.0, 6.0])
    # Squares 4 and 2 over 4 degrees of freedom.
    scatter = (6 / 4) ** 0.5
    assert result.our_error == pytest.approx(scatter / 2)
    assert result.their_error == pytest.approx(scatter / 2**0.5)
    assert result.deviation == pytest.approx(-3 / (scatter * (1 / 4 + 1 / 2) ** 0.5))


def test_independent_samples_of_one_distribution_deviate_by_one() -> None:
    generator = np.random.default_rng(5)
    deviations = [
        compare(POINTS[0], "contacts", list(generator.normal(size=24)), list(generator.normal(size=6))).deviation
        for _ in range(2000)
    ]
    assert np.std(deviations) == pytest.approx(1.04, abs=0.05)


def test_chance_of_chi_squared() -> None:
    # Tabulated upper points of 5 %.
    assert chance(18.307, 10) == pytest.approx(0.05, abs=1e-3)
    assert chance(50.998, 36) == pytest.approx(0.05, abs=1e-3)


def test_numbers_with_errors() -> None:
    assert with_error(0.98765, 0.0012) == "0.9877 ± 0.0012"
    assert with_error(-0.00001, 0.01) == "0.000 ± 0.010"
    assert with_error(1.234e-5, 1.2e-7) == "(1.234 ± 0.012) x 1e-5"


def test_a_section_is_written_between_its_marks(tmp_path: Path) -> None:
    document = tmp_path / "page.md"
    document.write_text("a\n<!-- lammps one -->\nold\n<!-- /lammps -->\nb\n<!-- lammps two -->\nkept\n<!-- /lammps -->\n")
    Section("one", table(["x"], [["1"]]), []).write(document)
    assert document.read_text() == (
        "a\n<!-- lammps one -->\n| x |\n| --- |\n| 1 |\n<!-- /lammps -->\nb\n<!-- lammps two -->\nkept\n<!-- /lammps -->\n"
    )
    with pytest.raises(ValueError, match="three"):
        Section("three", "", []).write(document)


def test_what_is_stored_is_not_computed_again(tmp_path: Path) -> None:
    store = Store(tmp_path)
    assert store.get("kind", "name", lambda: {"x": 0.1}) == {"x": 0.1}
    assert store.get("kind", "name", lambda: pytest.fail("computed again")) == {"x": 0.1}
