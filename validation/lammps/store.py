"""Finished results, a JSON file each: what is there is not computed again."""

from __future__ import annotations

import json
import os
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any


@dataclass(frozen=True)
class Store:
    """A folder of results by comparison and name."""

    folder: Path

    def get(self, comparison: str, name: str, compute: Callable[[], Any]) -> Any:
        """The result, computed if it is not there yet; a file is whole or not there."""
        path = self.folder / comparison / f"{name}.json"
        if path.is_file():
            return json.loads(path.read_text(encoding="utf-8"))
        result = compute()
        path.parent.mkdir(parents=True, exist_ok=True)
        unfinished = path.with_suffix(f".{os.getpid()}.tmp")
        unfinished.write_text(json.dumps(result) + "\n", encoding="utf-8")
        unfinished.replace(path)
        return result
