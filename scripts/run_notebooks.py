"""Executes notebooks from their first cell to the last; what a cell raises ends it, and so does a figure that is missing or a
text that is not the one stored.

The metadata of a notebook say how many figures it shows: `"peristalsis": {"figures": 5}`. The files stay as they are;
with --write they keep what their cells showed.

    run_notebooks.py [--write] NOTEBOOK ...
"""

import sys
import time
from pathlib import Path
from typing import Any

import nbclient
import nbformat


def figures(notebook: Any) -> int:
    """Pictures among the outputs."""
    outputs = (output for cell in notebook.cells if cell.cell_type == "code" for output in cell.outputs)
    return sum("image/png" in output.get("data", {}) for output in outputs)


def said(notebook: Any) -> list[str]:
    """What each cell prints, warnings included."""
    cells = (cell.outputs for cell in notebook.cells if cell.cell_type == "code")
    return ["".join(output.text for output in outputs if output.output_type == "stream") for outputs in cells]


def main(arguments: list[str]) -> None:
    keep = "--write" in arguments
    for path in (Path(argument) for argument in arguments if argument != "--write"):
        begin = time.monotonic()
        notebook = nbformat.read(path, as_version=4)
        client = nbclient.NotebookClient(
            notebook, timeout=600, record_timing=False, resources={"metadata": {"path": str(path.parent)}}
        )
        client.execute()
        shown, expected = figures(notebook), notebook.metadata["peristalsis"]["figures"]
        if shown != expected:
            sys.exit(f"{path.name} shows {shown} figures, not {expected}")
        if not keep and (new := said(notebook)) != (old := said(nbformat.read(path, as_version=4))):
            differing = [f"was {one!r}, is {other!r}" for one, other in zip(old, new) if one != other]
            sys.exit(f"{path.name} says other than what is stored:\n" + "\n".join(differing))
        if keep:
            notebook.metadata.pop("language_info", None)
            nbformat.write(notebook, path)
        print(f"{path.name}: {len(notebook.cells)} cells, {shown} figures in {time.monotonic() - begin:.0f} s")


if __name__ == "__main__":
    main(sys.argv[1:])
