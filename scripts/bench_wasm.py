#!/usr/bin/env python3
"""Speed of the kernels as WebAssembly (SIMD128, in Node.js) and native on one core, in turn.

    python3 scripts/bench_wasm.py [--rounds N] [WORKLOAD ...]

The same program is built for both (crates/engine/examples/instruction_counts.rs). Each round times one after the other, in
seconds of the processor, as the difference between a long run and a short one: what comes before the steps (packing,
compiling) cancels. Printed are the best speeds of either and the median over the rounds of the ratio of the times. Later
versions of Node.js compile better: take one whose V8 is that of the browsers you mean.
"""

from __future__ import annotations

import argparse
import json
import os
import resource
import subprocess
from pathlib import Path
from statistics import median

REPOSITORY = Path(__file__).resolve().parent.parent
TARGET = Path(os.environ.get("CARGO_TARGET_DIR", REPOSITORY / "target"))
EXAMPLE = "instruction_counts"
WASM = "wasm32-wasip1"
# Every function is compiled by the optimising compiler at once: else the first second or two run slower code.
OPTIONS = ["--no-warnings", "--no-liftoff", "--no-wasm-lazy-compilation"]
RUN_WASM = ["node", *OPTIONS, str(REPOSITORY / "scripts" / "wasi.mjs")]


def build(*target: str) -> None:
    environment = os.environ | {
        "CARGO_INCREMENTAL": "0",
        "CARGO_TARGET_WASM32_WASIP1_RUSTFLAGS": "-C target-feature=+simd128",
    }
    command = ["cargo", "build", "--release", "--locked", "-p", "peristalsis-engine", "--example", EXAMPLE, *target]
    subprocess.run(command, check=True, cwd=REPOSITORY, env=environment)


def answer(command: list[str], *arguments: object) -> str:
    return subprocess.run([*command, *map(str, arguments)], check=True, capture_output=True, text=True).stdout


def widest(native: list[str]) -> str:
    """The widest instructions that the native program has on this machine."""
    workload = answer(native, "--list").split()[0]
    for instructions in ("avx512", "avx2", "neon"):
        if subprocess.run([*native, workload, instructions], capture_output=True).returncode == 0:
            return instructions
    return "plain"


def processor_time(command: list[str], *arguments: object) -> float:
    """Seconds of the processor that a program takes."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    answer(command, *arguments)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def seconds_of_steps(command: list[str], workload: str, instructions: str, times: int) -> float:
    """Of `times` stretches of the workload."""
    first = max(times // 4, 1)
    long, short = (processor_time(command, workload, instructions, n) for n in (first + times, first))
    return long - short


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--rounds", type=int, default=5, help="how often each is timed (default 5)")
    parser.add_argument("--seconds", type=float, default=1.0, help="for at least so long (default 1)")
    parser.add_argument("--native", help="instructions of the native program (default: the widest of this machine)")
    parser.add_argument("workloads", nargs="*", help="those to be timed (default: all)")
    arguments = parser.parse_args()
    build("--target", WASM)
    build()
    native = [str(TARGET / "release" / "examples" / EXAMPLE)]
    wasm = [*RUN_WASM, str(TARGET / WASM / "release" / "examples" / f"{EXAMPLE}.wasm")]
    instructions = arguments.native or widest(native)
    versions = json.loads(answer(["node", "-p", "JSON.stringify(process.versions)"]))
    print(f"Node.js {versions['node']}, V8 {versions['v8']}")
    print(f"{'10^6 grain-steps a second':26}{instructions:>10}{'simd128':>10}{'ratio':>8}")
    for workload in arguments.workloads or answer(native, "--list").split():
        times = 1
        while seconds_of_steps(native, workload, instructions, times) < arguments.seconds:
            times *= 2
        pairs = [
            (
                seconds_of_steps(native, workload, instructions, times),
                seconds_of_steps(wasm, workload, "simd128", times),
            )
            for _ in range(arguments.rounds)
        ]
        work = times * int(answer(native, workload, instructions)) / 1e6
        here, there = (work / min(seconds) for seconds in zip(*pairs))
        ratio = median(wasm / native for native, wasm in pairs)
        print(f"{workload:26}{here:10.1f}{there:10.1f}{ratio:8.2f}", flush=True)


if __name__ == "__main__":
    main()
