"""Our program: the whole of it, observables and all, without a trajectory."""

from __future__ import annotations

import csv
import json
import tempfile
import tomllib
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from cases import Case
from measurement import Cores, Measurement, Stretch

# Of a summary.
KEPT = ("version", "revision", "seed", "steps", "seconds", "grain_steps_per_second", "escaped", "largest_overlap")


@dataclass(frozen=True)
class OwnProgram:
    """The binary, and the cores that it may use."""

    binary: Path
    cores: Cores

    def measure(self, case: Case, stretch: Stretch) -> Measurement:
        """Seconds are those of engine and observables: packing, tables and figures are not counted."""
        parts = [self._run(case, stretch.periods, seed) for seed in range(1, stretch.seeds + 1)]
        total = Measurement("peristalsis", parts[0][0]["grains"])
        for summary, ratio, _ in parts:
            total.steps += summary["steps"]
            total.seconds += summary["seconds"]
            total.flow_rate_ratios.append(ratio)
            total.details.append({key: summary[key] for key in KEPT})
        return total

    def resolved(self, case: Case) -> dict[str, Any]:
        """Every key of the configuration, of the tube that is copied where there are copies, from the record of a short run."""
        short = {"tube.waves": int(case.settings["tube.waves"]) // case.copies} if case.copies > 1 else {}
        _, _, configuration = self._run(case, 0.05, 1, short)
        return configuration

    def _run(
        self, case: Case, periods: float, seed: int, settings: dict[str, str | float] | None = None
    ) -> tuple[dict[str, Any], float, dict[str, Any]]:
        """Summary, mean J/Jmax over the whole run, and resolved configuration."""
        with tempfile.TemporaryDirectory() as scratch:
            folder = Path(scratch) / "run"
            command = [str(self.binary), "run", "--preset", case.preset, "--json", "--csv", "--quiet", "--out", str(folder)]
            command += ["--threads", str(self.cores.number)]
            values = case.settings | (settings or {}) | {"run.periods": periods, "run.seed": seed}
            for key, value in values.items():
                command += ["--set", f"{key}={value}"]
            summary = json.loads(self.cores.run(command))
            with (folder / "timeseries.csv").open(encoding="utf-8", newline="") as table:
                ratios = [float(row["flow_rate_ratio"]) for row in csv.DictReader(table)]
            configuration = tomllib.loads((folder / "config.toml").read_text(encoding="utf-8"))
        return summary, sum(ratios) / len(ratios), configuration
