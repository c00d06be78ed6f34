#!/usr/bin/env python3
"""Compares our engine with LAMMPS from the same initial states, and writes what came out into docs/verification.md."""

from __future__ import annotations

import argparse
import shutil
import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import chaos
import collisions
import definitions
import sections
import stationary
from definitions import Program
from own_tube import OwnTube, PeerError
from report import Section
from sections import Samples
from stationary import Point
from store import Store

ROOT = Path(__file__).resolve().parents[2]
TABLES = Path(__file__).resolve().parent / "tables"
NAMES = (
    definitions.NAME,
    collisions.NAME,
    chaos.NAME,
    stationary.NAME,
    stationary.FRICTIONAL_NAME,
    stationary.GRAVITY_NAME,
    stationary.ROLLING_NAME,
    stationary.COHESION_NAME,
    stationary.JKR_NAME,
)


@dataclass(frozen=True)
class Work:
    """What the comparisons need."""

    own: OwnTube
    program: Program
    store: Store
    quick: bool
    # Of statistics.
    rounds: int
    # Where pictures go; none are made in a quick run.
    pictures: Path | None

    def picture(self, name: str, draw: Callable[[Path], None]) -> None:
        if self.pictures is not None:
            draw(self.pictures / f"lammps-{name}.png")

    def section(self, name: str) -> Section:
        """One comparison, computed as far as its results are not there yet."""
        makers: dict[str, Callable[[], Section]] = {
            definitions.NAME: lambda: sections.of_definitions(definitions.measure(self.own, self.program, self.store)),
            collisions.NAME: self._collisions,
            chaos.NAME: self._chaos,
            stationary.NAME: self._stationary,
            stationary.FRICTIONAL_NAME: self._friction,
            stationary.GRAVITY_NAME: self._gravity,
            stationary.ROLLING_NAME: self._rolling,
            stationary.COHESION_NAME: self._cohesion,
            stationary.JKR_NAME: self._jkr,
        }
        return makers[name]()

    def _collisions(self) -> Section:
        from figures import draw_collisions

        least = collisions.QUICK_LEAST_STEP if self.quick else min(collisions.STEPS)
        found = collisions.measure(collisions.CASES, least, self.own, self.store)
        self.picture(collisions.NAME, lambda path: draw_collisions(found, path))
        return sections.of_collisions(found)

    def _chaos(self) -> Section:
        from figures import draw_chaos

        cases = [case for case in chaos.CASES if not self.quick or case.name in chaos.QUICK_CASES]
        found = chaos.measure(cases, chaos.QUICK_SEEDS if self.quick else chaos.SEEDS, self.own, self.store)
        self.picture(chaos.NAME, lambda path: draw_chaos(found, path))
        return sections.of_chaos(found)

    def _stationary(self) -> Section:
        from figures import draw_stationary

        points, found = self._statistics(stationary.POINTS, stationary.QUICK_POINTS)
        self.picture(stationary.NAME, lambda path: draw_stationary(found, path))
        return sections.of_statistics(stationary.NAME, found, points, stationary.COMPARED)

    def _friction(self) -> Section:
        points, found = self._statistics(stationary.FRICTIONAL_POINTS, stationary.QUICK_FRICTIONAL_POINTS)
        compared, apart = stationary.COMPARED_WITH_FRICTION, stationary.READ_DIFFERENTLY
        return sections.of_statistics(stationary.FRICTIONAL_NAME, found, points, compared, apart)

    def _gravity(self) -> Section:
        points, found = self._statistics(stationary.GRAVITY_POINTS, stationary.QUICK_GRAVITY_POINTS)
        return sections.of_statistics(stationary.GRAVITY_NAME, found, points, stationary.COMPARED_IN_GRAVITY)

    def _rolling(self) -> Section:
        points, found = self._statistics(stationary.ROLLING_POINTS, (stationary.ROLLING_POINTS[0].name,))
        compared, apart = stationary.COMPARED_WITH_FRICTION, stationary.READ_DIFFERENTLY
        return sections.of_statistics(stationary.ROLLING_NAME, found, points, compared, apart)

    def _cohesion(self) -> Section:
        points, found = self._statistics(stationary.COHESION_POINTS, (stationary.COHESION_POINTS[0].name,))
        return sections.of_statistics(stationary.COHESION_NAME, found, points, stationary.COMPARED)

    def _jkr(self) -> Section:
        points, found = self._statistics(stationary.JKR_POINTS, (stationary.JKR_POINTS[0].name,))
        return sections.of_statistics(stationary.JKR_NAME, found, points, stationary.COMPARED)

    def _statistics(self, points: list[Point], quick: tuple[str, ...]) -> tuple[list[Point], Samples]:
        """The points of this call, and their runs."""
        points = [point for point in points if not self.quick or point.name in quick]
        return points, stationary.measure(points, self.rounds, self.own, self.store)


def arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--quick", action="store_true", help="a few minutes: fewer seeds, longer steps; no document")
    parser.add_argument("--only", nargs="+", choices=NAMES, default=NAMES, metavar="NAME", help=", ".join(NAMES))
    parser.add_argument("--rounds", type=int, help="of statistics: one run of LAMMPS and four of ours at each point")
    parser.add_argument("--fresh", action="store_true", help="forget the results that are there")
    parser.add_argument("--folder", type=Path, default=ROOT / "target" / "validation-lammps", help="for results")
    release = ROOT / "target" / "release"
    parser.add_argument("--program", type=Path, default=release / "peristalsis", help="the command line")
    parser.add_argument("--example", type=Path, default=release / "examples" / "placed_grains")
    parser.add_argument("--document", type=Path, default=ROOT / "docs" / "verification.md", help="where tables go")
    parser.add_argument("--pictures", type=Path, default=ROOT / "docs" / "images" / "validation")
    options = parser.parse_args()
    if options.rounds is None:
        options.rounds = stationary.QUICK_ROUNDS if options.quick else stationary.ROUNDS
    if options.rounds < 1:
        parser.error("--rounds must be at least 1")
    return options


def main() -> None:
    options = arguments()
    for program in (options.program, options.example):
        if not program.is_file():
            raise PeerError(f"{program} is missing: scripts/validate_peers.sh builds it")
    results = options.folder / "results"
    if options.fresh:
        shutil.rmtree(results, ignore_errors=True)
    pictures = None if options.quick else options.pictures
    own, program = OwnTube(options.example), Program(options.program)
    work = Work(own, program, Store(results), options.quick, options.rounds, pictures)
    faults: list[str] = []
    for name in options.only:
        section = work.section(name)
        print(f"## {name}\n\n{section.markdown}", flush=True)
        faults += section.faults
        if not options.quick:
            section.write(options.document)
            section.write_rows(TABLES)
    if faults:
        raise PeerError("the programs disagree:\n" + "\n".join(faults))


if __name__ == "__main__":
    try:
        main()
    except PeerError as error:
        sys.exit(f"error: {error}")
    except KeyboardInterrupt:
        sys.exit(130)
