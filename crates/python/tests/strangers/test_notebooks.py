"""Notebooks worth teaching with: what is stored in them. `scripts/run_notebooks.py` executes them and counts again."""

from __future__ import annotations

import base64
import json
from pathlib import Path
from typing import Any

import pytest

FOLDER = Path(__file__).parents[4] / "examples" / "notebooks"
NOTEBOOKS = sorted(FOLDER.glob("*.ipynb"))
#: No picture is larger [bytes].
LARGEST = 400_000


@pytest.fixture(params=NOTEBOOKS, ids=lambda path: path.stem)
def notebook(request: pytest.FixtureRequest) -> Any:
    return json.loads(request.param.read_text(encoding="utf-8"))


def test_there_are_four() -> None:
    assert [path.stem for path in NOTEBOOKS] == ["back-flow", "collapse", "study", "transition"]


def test_every_figure_is_stored(notebook: Any) -> None:
    outputs = [output for cell in notebook["cells"] for output in cell.get("outputs", ())]
    assert not any(output["output_type"] == "error" for output in outputs)
    pictures = [output["data"]["image/png"] for output in outputs if "image/png" in output.get("data", {})]
    assert len(pictures) == notebook["metadata"]["peristalsis"]["figures"] >= 4
    assert max(len(base64.b64decode(picture)) for picture in pictures) < LARGEST


def test_a_lesson_asks_expects_and_has_exercises_with_answers(notebook: Any) -> None:
    words = "".join("".join(cell["source"]) for cell in notebook["cells"] if cell["cell_type"] == "markdown")
    for part in ("**The question.**", "**The model", "**What to expect.**", "## Exercises", "## Answers"):
        assert part in words
    answers = [cell for cell in notebook["cells"] if "answer" in cell["metadata"].get("tags", ())]
    assert len(answers) == 3 and all(cell["outputs"] for cell in answers)


def test_the_lesson_on_censoring_has_runs_that_are_censored() -> None:
    notebook = json.loads((FOLDER / "study.ipynb").read_text(encoding="utf-8"))
    outputs = [output for cell in notebook["cells"] for output in cell.get("outputs", ())]
    said = "".join("".join(output.get("text", "")) for output in outputs)
    assert "3 of 8 jammed" in said and "0 of 8 jammed" in said


def test_nothing_that_is_stored_is_a_warning(notebook: Any) -> None:
    """A lesson says in words what is doubtful."""
    assert not any(output.get("name") == "stderr" for cell in notebook["cells"] for output in cell.get("outputs", ()))


def test_no_legend_is_put_wherever_it_falls(notebook: Any) -> None:
    assert not any("legend()" in "".join(cell["source"]) for cell in notebook["cells"])
