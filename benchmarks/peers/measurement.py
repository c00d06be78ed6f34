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


@dataclass(frozen=True)
class Cores:
    """How many cores a program has, and which, where the system can pin it."""

    number: int
    pinned: tuple[int, ...] | None

    def run(
        self, command: list[str], folder: Path | None = None, environment: dict[str, str] | None = None
    ) -> str:
        """Standard output of a command; each of its processes has one thread unless it asks for more itself."""
        pin = [] if self.pinned is None else ["taskset", "--cpu-list", ",".join(map(str, self.pinned))]
        one_thread = {"OMP_NUM_THREADS": "1"}
        outcome = subprocess.run(
            pin + command, cwd=folder, env=os.environ | one_thread | (environment or {}), capture_output=True, text=True
        )
        if outcome.returncode != 0:
            last_words = "\n".join((outcome.stdout + outcome.stderr).splitlines()[-15:])
            raise BenchmarkError(f"{' '.join(command)}\nended with {outcome.returncode}:\n{last_words}")
        return outcome.stdout


def one_core(wanted: int) -> Cores:
    """The core, pinned where the system has `taskset`."""
    if shutil.which("taskset") is None:
        return Cores(1, None)
    allowed = os.sched_getaffinity(0)
    if wanted not in allowed:
        raise BenchmarkError(f"core {wanted} is not among those allowed here: {sorted(allowed)}")
    return Cores(1, (wanted,))


def all_cores() -> Cores:
    """All that this process may use."""
    if shutil.which("taskset") is None:
        return Cores(os.cpu_count() or 1, None)
    allowed = tuple(sorted(os.sched_getaffinity(0)))
    return Cores(len(allowed), allowed)
