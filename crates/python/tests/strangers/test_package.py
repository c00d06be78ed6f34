"""The package as a whole: its types, its documentation, what it brings."""

import importlib
import subprocess
import sys
from importlib.metadata import entry_points, metadata
from pathlib import Path
from types import ModuleType
from typing import SupportsIndex, get_args, get_type_hints

import pytest

import peristalsis
from peristalsis import _keywords, _types, analysis

ROOT = Path(__file__).parents[4]


@pytest.mark.parametrize(("script", "made"), [("python_types", _types), ("python_results", analysis._results)])
def test_what_is_made_of_schemas_is_up_to_date(script: str, made: ModuleType, monkeypatch: pytest.MonkeyPatch) -> None:
    """What would delight: generated keyword stubs, typed summaries. `python scripts/SCRIPT.py` writes them anew."""
    monkeypatch.syspath_prepend(ROOT / "scripts")
    assert Path(made.__file__ or "").read_text(encoding="utf-8") == importlib.import_module(script).text()


def test_keywords_are_typed() -> None:
    hints = get_type_hints(_types.Keywords)
    assert hints["width"] is float and hints["waves"] is SupportsIndex
    assert get_args(hints["initial_state"]) == get_args(hints["state"]) == ("rest", "settled", "jammed", "placed")
    assert set(get_args(hints["law"])) == {"linear", "hertz"} and set(get_args(hints["control"])) == {"strain", "stress"}
    unique = {keyword for keyword, keys in _keywords.keywords().items() if len(keys) == 1}
    assert set(hints) == unique


def test_the_status_of_a_summary_is_typed_as_python_says_it() -> None:
    assert set(get_args(get_type_hints(_types.Summary)["status"])) == {"running", "complete", "settled", "diverged"}


@pytest.mark.parametrize("settings", [{}, {"body_force": -0.001}])
def test_a_summary_has_the_keys_of_its_type(settings: dict[str, float]) -> None:
    simulation = peristalsis.Simulation.preset("frictionless", waves=2, **settings)
    simulation.run(periods=2)

    def check(found: object, kind: object) -> None:
        if isinstance(found, dict) and (kinds := [it for it in (kind, *get_args(kind)) if hasattr(it, "__required_keys__")]):
            hints = get_type_hints(kinds[0])
            assert kinds[0].__required_keys__ <= set(found) <= set(hints)
            for key, value in found.items():
                check(value, hints[key])
        elif isinstance(found, float | int | str):
            kinds = [type(value) if isinstance(value, str) else value for value in get_args(kind)] or [kind]
            assert type(found) in kinds, (found, kind)

    check(simulation.summary(), peristalsis.Summary)


def test_the_package_says_whose_it_is_and_brings_the_command() -> None:
    (script,) = entry_points(group="console_scripts", name="peristalsis")
    assert callable(script.load())
    about = metadata("peristalsis")
    assert about["Author"] and about["Project-URL"] and about["License-Expression"] == "MIT OR Apache-2.0"
    assert {"LICENSE-MIT", "LICENSE-APACHE", "THIRD-PARTY.txt"} <= set(about.get_all("License-File") or ())


def test_the_book_has_its_pages() -> None:
    summary = (ROOT / "docs" / "book" / "src" / "SUMMARY.md").read_text(encoding="utf-8")
    for page in ("start/installation", "guides/python", "reference/api", "reference/quantities", "guides/viewer", "guides/troubleshooting"):
        assert f"({page}.md)" in summary


def test_plot_is_there_without_being_imported() -> None:
    program = "import peristalsis; print(callable(peristalsis.plot.flow), 'plot' in dir(peristalsis))"
    assert subprocess.check_output([sys.executable, "-c", program], text=True).split() == ["True", "True"]


def test_without_matplotlib_plot_says_what_to_install() -> None:
    program = "import sys; sys.modules['matplotlib'] = None; import peristalsis; peristalsis.plot"
    answer = subprocess.run([sys.executable, "-c", program], text=True, capture_output=True)
    assert "ImportError" in answer.stderr and "pip install 'peristalsis[plot]'" in answer.stderr
    with pytest.raises(AttributeError, match="'plots'"):
        _ = peristalsis.plots  # type: ignore[attr-defined]
