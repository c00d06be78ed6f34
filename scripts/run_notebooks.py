"""Executes notebooks from their first cell to the last; what a cell raises ends it. The files stay as they are."""

import sys
import time
from pathlib import Path

import nbclient
import nbformat

for path in map(Path, sys.argv[1:]):
    begin = time.monotonic()
    notebook = nbformat.read(path, as_version=4)
    nbclient.NotebookClient(notebook, timeout=600, resources={"metadata": {"path": str(path.parent)}}).execute()
    print(f"{path.name}: {len(notebook.cells)} cells in {time.monotonic() - begin:.0f} s")
