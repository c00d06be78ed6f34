"""Our engine, by the example `placed_grains` of the crate `run`."""

from __future__ import annotations

import subprocess
import tempfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from tubes import COLUMNS, Course, Grains, Tube


class PeerError(Exception):
    """A program failed, or is missing."""


@dataclass(frozen=True)
class OwnTube:
    """The compiled example."""

    program: Path

    def run(self, tube: Tube, grains: Grains, frames: int, steps: int) -> Course:
        """So many frames after the first, so many steps apart, from grains as they are placed."""
        with tempfile.TemporaryDirectory() as scratch:
            start = Path(scratch) / "start.txt"
            # Python writes numbers so that reading them gives the same bits.
            lines = (" ".join(map(repr, [*map(float, grain), 1.0])) for grain in grains.values)
            start.write_text("\n".join(lines), encoding="utf-8")
            return self._run(tube, frames, steps, {"grains.number": grains.number}, ["--from", str(start)])

    def pack(self, tube: Tube, volume_fraction: float, state: str, seed: int) -> Grains:
        """Grains as the program packs them."""
        settings = {"grains.volume_fraction": volume_fraction, "initial.state": state, "run.seed": seed}
        return Grains(self._run(tube, 0, 1, settings, []).frames[0])

    def _run(self, tube: Tube, frames: int, steps: int, settings: dict[str, object], words: list[str]) -> Course:
        lattice = tube.lattice
        settings = settings | tube.law.settings() | {
            "tube.radius": lattice.radius,
            "tube.wavelength": lattice.wavelength,
            "tube.waves": lattice.waves,
            "tube.spheres_per_ring": lattice.spheres_per_ring,
            "tube.rings_per_wave": lattice.rings_per_wave,
            "drive.width": tube.width,
            "drive.strain_rate": tube.strain_rate,
            "run.time_step": tube.time_step,
            "body.gravity": list(tube.gravity),
            # A static tube is sampled 200 times in a run, and a step must fit into that.
            "run.duration": 200 * max(1, frames) * steps * tube.time_step,
        }
        command = [str(self.program), "frictionless", str(frames), str(steps), *words]
        command += [f"{key}={value}" for key, value in settings.items()]
        outcome = subprocess.run(command, capture_output=True)
        if outcome.returncode != 0:
            raise PeerError(f"{' '.join(command)}\n{outcome.stderr.decode()}")
        values = np.frombuffer(outcome.stdout, "<f8").reshape(frames + 1, -1, COLUMNS)
        return Course(tube, steps * tube.time_step, values)
