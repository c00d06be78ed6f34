#!/usr/bin/env python3
"""Long work in bounded memory: a run of 10^6 periods, a study of many runs, a viewer at its fastest for ten minutes, a
loop of 10^5 calls in Python.

    python3 scripts/check_memory.py                    all of it, half an hour
    python3 scripts/check_memory.py --only run study   some of it
    python3 scripts/check_memory.py --program PATH     another program than target/release/peristalsis

Prints the resident memory after a minute and at most, and ends with 1 where that is above 250 MB. A run of a million
periods would take 8 GB if it kept every sample. The loop takes the Python that runs this script, with the package
installed.
"""

from __future__ import annotations

import argparse
import base64
import json
import os
import re
import signal
import socket
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parent.parent
# Resident memory that is allowed [MB].
CAP = 250
WORK = ("run", "study", "viewer", "python")
MINUTE = 60
VIEWED = 10 * MINUTE
TUBE = """preset = "frictionless"
tube = { waves = 1, wavelength = 10, radius = 2, spheres_per_ring = 8, rings_per_wave = 8 }
grains.number = 10
drive = { width = 3.6, strain_rate = 0.1 }
"""
STUDY = """name = "many"
preset = "frictionless"
replicates = 1000
base.tube = { waves = 1, wavelength = 10, radius = 2, spheres_per_ring = 8, rings_per_wave = 8 }
base.grains.number = 10
base.drive.strain_rate = 0.1
base.run.periods = 1
[[axes]]
key = "drive.width"
from = 3
to = 4
count = 100
"""
LOOP = """
import sys
from peristalsis import Simulation
simulation = Simulation.from_file(sys.argv[1])
for _ in range(100_000):
    simulation.run(periods=1)
"""


def resident(process: int) -> float:
    """Resident memory [MB]; 0 where the process has ended."""
    try:
        lines = Path(f"/proc/{process}/status").read_text().splitlines()
    except (FileNotFoundError, ProcessLookupError):
        return 0.0
    return next((int(line.split()[1]) / 1000 for line in lines if line.startswith("VmRSS")), 0.0)


def look_on(viewer: subprocess.Popen[bytes]) -> None:
    """Has a viewer's tube run as fast as it can, and takes every frame, as a page does; then ends the viewer."""
    try:
        assert viewer.stdout is not None
        address = re.match(rb"http://([^:/]+):(\d+)(/.*/)", viewer.stdout.readline())
        assert address is not None, "no address"
        host, port, path = (part.decode() for part in address.groups())
        with socket.create_connection((host, int(port))) as page:
            key = base64.b64encode(os.urandom(16)).decode()
            lines = (
                f"GET {path}live HTTP/1.1",
                f"Host: {host}:{port}",
                "Connection: Upgrade",
                "Upgrade: websocket",
                "Sec-WebSocket-Version: 13",
                f"Sec-WebSocket-Key: {key}",
            )
            page.sendall("".join(f"{line}\r\n" for line in (*lines, "")).encode())
            for command in ({"type": "speed", "periods_per_second": None}, {"type": "play", "playing": True}):
                text = json.dumps(command).encode()
                # A text, masked with zeros.
                page.sendall(bytes((0x81, 0x80 | len(text), 0, 0, 0, 0)) + text)
            # A tube that has stopped sends nothing: an error.
            page.settimeout(MINUTE)
            begun, received = time.monotonic(), 0
            while time.monotonic() - begun < VIEWED:
                more = page.recv(1 << 16)
                assert more, "the viewer has hung up"
                received += len(more)
            print(f"  {received / 1e6:.0f} MB of frames", flush=True)
    finally:
        viewer.send_signal(signal.SIGINT)


def watch(name: str, command: list[str], beside: Callable[[subprocess.Popen[bytes]], None] | None = None) -> bool:
    """Runs a command to its end, and something beside it; whether it ended well within the cap."""
    begun = time.monotonic()
    output = subprocess.PIPE if beside else subprocess.DEVNULL
    process = subprocess.Popen(command, stdout=output, stderr=subprocess.PIPE)
    with ThreadPoolExecutor() as pool:
        onlooker = pool.submit(beside, process) if beside else None
        minute = most = 0.0
        while process.poll() is None:
            most = max(most, resident(process.pid))
            if time.monotonic() - begun < MINUTE:
                minute = most
            time.sleep(0.2)
    assert process.stderr is not None
    said = process.stderr.read().decode()
    seconds = time.monotonic() - begun
    print(f"{name}: {minute:.0f} MB in the first minute, {most:.0f} MB at most, {seconds:.0f} s", flush=True)
    if process.returncode != 0:
        print(said)
    if onlooker:
        onlooker.result()
    return process.returncode == 0 and most < CAP


def main() -> int:
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("--only", nargs="+", choices=WORK, default=WORK)
    options.add_argument("--program", default=str(REPOSITORY / "target/release/peristalsis"))
    arguments = options.parse_args()
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch)
        tube, study = folder / "tube.toml", folder / "study.toml"
        tube.write_text(TUBE + "run.periods = 1_000_000\n")
        study.write_text(STUDY)
        program = arguments.program
        commands = {
            "run": [program, "run", str(tube), "--out", str(folder / "run"), "--quiet", "--threads", "1"],
            "study": [program, "study", "run", str(study), "--store", str(folder / "store"), "--quiet", "--for", "5m"],
            # So long that it does not come to the most samples that a viewer keeps, where it would stop.
            "viewer": [program, "view", "frictionless", "--set", "tube.waves=300", "--saves", str(folder / "saves")],
            "python": [sys.executable, "-c", LOOP, str(tube)],
        }
        beside = {"viewer": look_on}
        outcomes = [watch(name, commands[name], beside.get(name)) for name in arguments.only]
    return 0 if all(outcomes) else 1


if __name__ == "__main__":
    sys.exit(main())
