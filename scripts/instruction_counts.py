#!/usr/bin/env python3
"""Instructions a grain-step of the fast kernels, counted by callgrind, against those on record.

    python3 scripts/instruction_counts.py             compare; exit status 1 where a kernel needs more than it may
    python3 scripts/instruction_counts.py --record    write down the counts of now

Only the advance is counted, not what leads to it. Time is never looked at. See benchmarks/instructions/README.md.
"""

from __future__ import annotations

import argparse
import json
import os
import platform
import re
import shutil
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parent.parent
RECORD = REPOSITORY / "benchmarks" / "instructions" / "counts.json"
EXAMPLE = "instruction_counts"
RECORD_COMMAND = "python3 scripts/instruction_counts.py --record"

# Sets of instructions that callgrind knows; it has no AVX-512.
PATHS = ("avx2", "plain")
# Exit status of the example where the machine (as callgrind shows it) lacks the instructions.
LACKING = 3

# How much more a kernel may need. The same compiler repeats a count to the digit; changes elsewhere in the crate move it
# a little by inlining, and less is not worth a stop. Another compiler may choose other instructions: from rustc 1.95 to
# 1.97 counts moved by 1.2 % at most.
TOLERANCE = 0.05
TOLERANCE_OF_ANOTHER_COMPILER = 0.10

Counts = dict[str, dict[str, float]]


def compiler() -> str:
    """The version of the compiler, without date and hash."""
    answer = subprocess.run(["rustc", "--version"], check=True, capture_output=True, text=True, cwd=REPOSITORY)
    return answer.stdout.split()[1]


def build() -> str:
    """Builds the counted program as it is released; its path."""
    command = ["cargo", "build", "--release", "--locked", "-p", "peristalsis-engine"]
    command += ["--example", EXAMPLE, "--message-format=json-render-diagnostics"]
    # Incremental compilation inlines less, and flags of the day are not what is on record.
    environment = {key: value for key, value in os.environ.items() if "RUSTFLAGS" not in key}
    environment["CARGO_INCREMENTAL"] = "0"
    answer = subprocess.run(
        command, check=True, stdout=subprocess.PIPE, text=True, cwd=REPOSITORY, env=environment
    )
    messages = map(json.loads, answer.stdout.splitlines())
    return next(
        message["executable"]
        for message in messages
        if message.get("reason") == "compiler-artifact" and message["target"]["name"] == EXAMPLE
    )


def under_callgrind(program: str, *arguments: str) -> subprocess.CompletedProcess[str]:
    command = ["valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null"]
    command += ["--toggle-collect=*counted_advance*", program, *arguments]
    return subprocess.run(command, capture_output=True, text=True, cwd=REPOSITORY)


def count(program: str, workload: str, path: str) -> float | None:
    """Instructions a grain-step, or None where the machine lacks such instructions."""
    answer = under_callgrind(program, workload, path)
    if answer.returncode == LACKING:
        return None
    collected = re.search(r"Collected : (\d+)", answer.stderr)
    if answer.returncode != 0 or collected is None:
        sys.exit(f"{workload}, {path}: counting failed\n{answer.stderr}")
    instructions = int(collected.group(1))
    if instructions == 0:
        sys.exit(f"{workload}, {path}: no instruction counted; was counted_advance inlined?")
    return instructions / int(answer.stdout)


def count_all(program: str, workloads: list[str]) -> Counts:
    """Instructions a grain-step by path and workload."""
    work = [(path, workload) for path in PATHS for workload in workloads]
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        found = pool.map(lambda job: count(program, job[1], job[0]), work)
    counts: Counts = {}
    for (path, workload), number in zip(work, found):
        if number is not None:
            counts.setdefault(path, {})[workload] = round(number, 1)
    return counts


def record(counts: Counts) -> None:
    """Writes the counts down."""
    if missing := [path for path in PATHS if path not in counts]:
        sys.exit(f"nothing recorded: this machine has no {', '.join(missing)}")
    RECORD.parent.mkdir(parents=True, exist_ok=True)
    content = {"compiler": compiler(), "instructions_per_grain_step": counts}
    RECORD.write_text(json.dumps(content, indent=2) + "\n")
    print(f"recorded in {RECORD.relative_to(REPOSITORY)}")


def compare(counts: Counts) -> bool:
    """Prints recorded and found counts; whether all are within the tolerance."""
    recorded = json.loads(RECORD.read_text())
    tolerance, here = TOLERANCE, compiler()
    if here != recorded["compiler"]:
        tolerance = TOLERANCE_OF_ANOTHER_COMPILER
        print(
            f"warning: recorded with rustc {recorded['compiler']}, this is {here}:"
            f" {tolerance:.0%} more are let pass instead of {TOLERANCE:.0%}"
        )
    failures, fewer = [], False
    print(f"{'instructions a grain-step':32}{'recorded':>10}{'now':>10}{'change':>10}")
    for path, found in counts.items():
        before = recorded["instructions_per_grain_step"][path]
        for workload in sorted(set(found) ^ set(before)):
            failures.append(f"{workload}, {path}: either not recorded or not there any more")
        for workload in [name for name in before if name in found]:
            old, new = before[workload], found[workload]
            change = new / old - 1.0
            print(f"{workload + ', ' + path:32}{old:10.1f}{new:10.1f}{change:+10.1%}")
            fewer = fewer or change < -tolerance
            if change > tolerance:
                failures.append(
                    f"{workload}, {path}: {new:.1f} instructions a grain-step, recorded are {old:.1f}"
                    f" ({change:+.1%}, allowed +{tolerance:.0%})"
                )
    for path in recorded["instructions_per_grain_step"].keys() - counts.keys():
        print(f"not counted: {path}, which this machine lacks")
    if fewer:
        print(f"fewer than recorded; keep the gain: {RECORD_COMMAND}")
    for failure in failures:
        print(f"error: {failure}", file=sys.stderr)
    if failures:
        print(f"If this is meant to be: {RECORD_COMMAND}", file=sys.stderr)
    return not failures


def skip(why: str, recording: bool) -> None:
    """Nothing is compared, which is no failure; that nothing is recorded is one."""
    if recording:
        sys.exit(f"nothing recorded: {why}")
    print(f"skipped: {why}")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--record", action="store_true", help="write down the counts of now")
    options = parser.parse_args()
    if (platform.system(), platform.machine()) != ("Linux", "x86_64"):
        return skip("the record is for x86-64 Linux", options.record)
    if shutil.which("valgrind") is None:
        return skip("there is no valgrind", options.record)
    program = build()
    listed = under_callgrind(program, "--list")
    if listed.returncode != 0:
        return skip(f"valgrind runs no programs here: {listed.stderr.strip()[-200:]!r}", options.record)
    counts = count_all(program, listed.stdout.split())
    if options.record:
        record(counts)
    elif not compare(counts):
        sys.exit(1)


if __name__ == "__main__":
    main()
