"""What one timed run gave, and what all programs run with."""

from __future__ import annotations

import os
import shutil
import subprocess
from dataclasses import dataclass, field
from pathlib import Path


class BenchmarkError(Exception):
    """Something is missing, or a program failed."""


@dataclass(frozen=True)
class Stretch:
    """How much is timed: so many periods, from each of so many seeds."""

    periods: float
    seeds: int = 1


@dataclass
class Measurement:
    """Grain-steps and seconds, summed over the seeds."""

    program: str
    grains: int
    steps: int = 0
    seconds: float = 0.0
    # J/Jmax, the mean over each seed's stretch.
    flow_rate_ratios: list[float] = field(default_factory=list)
    # What the program says of itself, seed by seed.
    details: list[dict[str, float | int | str]] = field(default_factory=list)

    @property
    def speed(self) -> float:
        """Million grain-steps a second."""
        return self.grains * self.steps / self.seconds / 1e6

    @property
    def flow_rate_ratio(self) -> float:
        return sum(self.flow_rate_ratios) / len(self.flow_rate_ratios)

    def as_record(self) -> dict[str, object]:
        return {
            "program": self.program,
            "grains": self.grains,
            "steps": self.steps,
            "seconds": self.seconds,
            "million_grain_steps_per_second": self.speed,
            "flow_rate_ratio": self.flow_rate_ratio,
            "flow_rate_ratio_by_seed": self.flow_rate_ratios,
            "details": self.details,
        }


def run_on_one_core(
    command: list[str], core: int | None, folder: Path | None = None, environment: dict[str, str] | None = None
) -> str:
    """Standard output of a command that has one thread, on the given core where the system can pin it."""
    pinned = command if core is None else ["taskset", "--cpu-list", str(core), *command]
    one_thread = {"OMP_NUM_THREADS": "1", "RAYON_NUM_THREADS": "1"}
    outcome = subprocess.run(
        pinned, cwd=folder, env=os.environ | one_thread | (environment or {}), capture_output=True, text=True
    )
    if outcome.returncode != 0:
        last_words = "\n".join((outcome.stdout + outcome.stderr).splitlines()[-15:])
        raise BenchmarkError(f"{' '.join(command)}\nended with {outcome.returncode}:\n{last_words}")
    return outcome.stdout


def core_to_pin(wanted: int) -> int | None:
    """The core, or none where the system has no `taskset`."""
    if shutil.which("taskset") is None:
        return None
    allowed = os.sched_getaffinity(0)
    if wanted not in allowed:
        raise BenchmarkError(f"core {wanted} is not among those allowed here: {sorted(allowed)}")
    return wanted
