"""What came out: tables for a document between its marks, and the numbers behind them as CSV."""

from __future__ import annotations

import csv
import math
import re
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

Cell = str | int | float


@dataclass
class Section:
    """What one comparison has to say, and whether the programs agree."""

    name: str
    markdown: str
    faults: list[str]
    columns: Sequence[str] = ()
    rows: Sequence[Sequence[Cell]] = field(default_factory=list)

    def write(self, document: Path) -> None:
        """Between the marks of its name, which must be there."""
        text = document.read_text(encoding="utf-8")
        marks = re.compile(rf"(<!-- lammps {self.name} -->\n).*?(<!-- /lammps -->)", re.DOTALL)
        if marks.search(text) is None:
            raise ValueError(f"{document} has no <!-- lammps {self.name} --> ... <!-- /lammps -->")
        document.write_text(marks.sub(lambda found: found[1] + self.markdown + found[2], text), encoding="utf-8")

    def write_rows(self, folder: Path) -> None:
        folder.mkdir(parents=True, exist_ok=True)
        with (folder / f"{self.name}.csv").open("w", encoding="utf-8", newline="") as file:
            table = csv.writer(file, lineterminator="\n")
            table.writerow(self.columns)
            table.writerows(self.rows)


def table(header: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    """A table in Markdown."""
    lines = [header, ["---"] * len(header), *rows]
    return "".join(f"| {' | '.join(line)} |\n" for line in lines)


def with_error(value: float, error: float) -> str:
    """Both with two digits of the error."""
    if not (math.isfinite(error) and error > 0):
        return f"{value:.4g}"
    digits = max(0, 1 - math.floor(math.log10(error)))
    if digits > 4 and 0 < abs(value) < 0.01:
        exponent = math.floor(math.log10(abs(value)))
        scale = 10.0**-exponent
        return f"({with_error(value * scale, error * scale)}) x 1e{exponent}"
    return f"{value:z.{digits}f} ± {error:.{digits}f}"


def power(value: float | None) -> str:
    """A small number by its size."""
    if value is None:
        return "–"
    return "0" if value == 0 else f"{value:.0e}".replace("e-0", "e-")


def chance(chi_squared: float, degrees: int) -> float:
    """How often chi squared is larger by chance (Wilson & Hilferty 1931)."""
    spread = 2 / (9 * degrees)
    score = ((chi_squared / degrees) ** (1 / 3) - (1 - spread)) / math.sqrt(spread)
    return 0.5 * math.erfc(score / math.sqrt(2))
