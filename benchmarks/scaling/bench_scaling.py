#!/usr/bin/env python3
"""How the program scales: with cores, with the number of grains, with the width of the tube.

Each figure is the median of ratios of runs made in turn, so that a busy machine slows both sides. Speeds are those that
`peristalsis run --json` reports (engine and observables); memory is the peak of the whole process.
"""

import argparse
import json
import os
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
STUDY = """
name = "ensemble"
title = "Small runs"
preset = "frictionless"
replicates = {replicates}

[base]
drive.width = 2.8
run.periods = 150
"""


def options():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--program", default=ROOT / "target/release/peristalsis", type=Path)
    parser.add_argument("--runs", default=5, type=int, help="repetitions of each comparison")
    parser.add_argument("--quick", action="store_true", help="smaller tubes, for a first look")
    parser.add_argument(
        "--only",
        nargs="+",
        choices=["ensemble", "threads", "size", "wide"],
        default=["ensemble", "threads", "size", "wide"],
    )
    return parser.parse_args()


class Program:
    def __init__(self, path):
        self.path = path

    def start(self, arguments):
        folder = tempfile.TemporaryDirectory()
        command = [self.path, "run", "--quiet", "--json", "--out", Path(folder.name) / "run", *arguments]
        process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        return process, folder

    def finish(self, started):
        """Summary, and the largest memory of the process [bytes]."""
        process, folder = started
        answer = process.stdout.read()
        complaint = process.stderr.read()
        _, status, usage = os.wait4(process.pid, 0)
        folder.cleanup()
        if status != 0:
            sys.exit(f"{' '.join(map(str, process.args))}\n{complaint}")
        return json.loads(answer), usage.ru_maxrss * 1024

    def run(self, arguments, threads=1):
        return self.finish(self.start([*arguments, "--threads", str(threads)]))


def speed(summary):
    return summary["grain_steps_per_second"]


def tube(waves, periods, *more):
    settings = [f"tube.waves={waves}", f"run.periods={periods}", "observe.samples_per_period=4", *more]
    return ["--preset", "frictionless", *(word for setting in settings for word in ("--set", setting))]


def rough(waves, periods):
    """The frictional tube, n 0.71."""
    settings = [f"tube.waves={waves}", f"run.periods={periods}", "drive.force_amplitude=0.005"]
    return ["--preset", "frictional", *(word for setting in settings for word in ("--set", setting))]


def report(name, ratios, more=""):
    spread = f"{min(ratios):.2f} to {max(ratios):.2f}" if len(ratios) > 1 else "one run"
    print(f"| {name} | {statistics.median(ratios):.2f} ({spread}) | {more} |", flush=True)


def ensemble(program, runs, quick):
    """A study of small runs with one worker and with two, each into a store of its own."""
    study = STUDY.format(replicates=4 if quick else 16)

    def wall_clock(workers):
        with tempfile.TemporaryDirectory() as folder:
            (file := Path(folder) / "ensemble.toml").write_text(study, encoding="utf-8")
            command = [program.path, "study", "run", file, "--store", Path(folder) / "store", "--quiet"]
            begin = time.perf_counter()
            answer = subprocess.run([*command, "--workers", str(workers)], capture_output=True, text=True)
            took = time.perf_counter() - begin
        if answer.returncode != 0:
            sys.exit(answer.stderr)
        return took

    ratios = [wall_clock(1) / wall_clock(2) for _ in range(runs)]
    report("a study of small runs, two workers against one", ratios, "whole processes, every run sealed")


def threads(program, runs, quick):
    """Runs of frictionless grains, and of frictional ones in an elastic tube, few and many."""
    waves, periods = (500, 1) if quick else (5000, 3)
    for name, arguments in [
        ("smooth", tube(waves, periods, "drive.width=2.7")),
        ("frictional", rough(6, 0.05 if quick else 0.5)),
        ("frictional", rough(18 if quick else 184, 0.005 if quick else 0.02)),
    ]:
        ratios, speeds, grains = [], [], 0
        for _ in range(runs):
            one, _ = program.run(arguments)
            two, _ = program.run(arguments, threads=2)
            grains = one["grains"]
            ratios.append(speed(two) / speed(one))
            speeds.append(speed(one) / 1e6)
        one = f"one: {statistics.median(speeds):.1f} M/s"
        report(f"{grains} {name} grains, two threads against one", ratios, one)


def size(program, runs, quick):
    """Cost per grain-step and memory of a long tube against a short one."""
    waves = 5000 if quick else 49383
    ratios, memory, grains = [], [], 0
    for _ in range(1 if not quick else runs):
        small, _ = program.run(tube(494, 0.25, "drive.width=2.7"))
        large, bytes_used = program.run(tube(waves, 0.25, "drive.width=2.7"))
        grains = large["grains"]
        ratios.append(speed(small) / speed(large))
        memory.append(bytes_used / grains)
    report(
        f"cost per grain-step, {grains} grains against 10,004",
        ratios,
        f"{statistics.median(memory):.0f} bytes a grain at the peak, whole process",
    )


def wide(program, runs, quick):
    """A tube of radius 10 against narrow ones with as many contacts a grain."""
    waves = 12 if quick else 55
    wide_tube = tube(
        waves, 2, "tube.radius=10", "tube.spheres_per_ring=84", "drive.width=18.5", "grains.volume_fraction=0.3"
    )
    ratios, contacts, grains = [], (0, 0), 0
    for _ in range(runs):
        broad, _ = program.run(wide_tube)
        narrow, _ = program.run(tube(4938, 0.5, "drive.width=2.85"))
        grains = broad["grains"]
        contacts = (broad["contacts"], narrow["contacts"])
        ratios.append(speed(narrow) / speed(broad))
    report(
        f"cost per grain-step, a = 10 with {grains} grains against a = 1.5",
        ratios,
        f"contacts a grain {contacts[0]:.2f} and {contacts[1]:.2f}",
    )


def main():
    asked = options()
    program = Program(asked.program)
    print("| comparison | ratio: median (range) | |\n|---|---|---|")
    for name in asked.only:
        {"ensemble": ensemble, "threads": threads, "size": size, "wide": wide}[name](program, asked.runs, asked.quick)


main()
