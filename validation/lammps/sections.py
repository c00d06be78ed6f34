"""Results to sections: tables, what they mean in a line, and what does not agree."""

from __future__ import annotations

import math

import chaos
import collisions
import definitions
import stationary
from chaos import Growth
from collisions import Found, Outcome
from report import Cell, Section, chance, power, table, with_error
from stationary import OURS, THEIRS, Comparison, Point

# A deviation beyond so many errors, or a chi squared as rare as this, is a fault.
LARGEST_DEVIATION, LEAST_CHANCE = 4.5, 1e-3
Rows = list[list[Cell]]
Samples = dict[str, dict[str, list[dict[str, float]]]]


def of_definitions(found: dict[str, dict[str, float]]) -> Section:
    names = list(next(iter(found.values())))
    rows = [[f"`{preset}`", *(power(differences[name]) for name in names)] for preset, differences in found.items()]
    faults = [
        f"{name} of {preset} differs from our program's column by {difference:.1e}"
        for preset, differences in found.items()
        for name, difference in differences.items()
        if not difference < definitions.TOLERANCE
    ]
    csv_rows: Rows = [[preset, name, value] for preset, values in found.items() for name, value in values.items()]
    markdown = table(["preset", *(f"`{name}`" for name in names)], rows)
    return Section(definitions.NAME, markdown, faults, ("preset", "column", "largest_difference"), csv_rows)


def of_collisions(found: dict[str, Found]) -> Section:
    outcomes = [Outcome.of(case, found[case.name]) for case in collisions.CASES if case.name in found]
    rows = [
        [
            outcome.case.title,
            f"{outcome.rebound:.6f}",
            power(outcome.between),
            power(outcome.ours),
            power(outcome.theirs),
            power(outcome.readings),
        ]
        for outcome in outcomes
    ]
    header = ["collision", "rebound", "between the programs", "ours, exact", "LAMMPS, exact", "by the reading of the law"]
    faults = [f"{outcome.case.name}: the programs differ" for outcome in outcomes if not outcome.agrees]
    csv_rows: Rows = [
        [case.name, program, step, grain, *values]
        for case in collisions.CASES
        if case.name in found
        for program, by_step in found[case.name].items()
        for step, grains in by_step.items()
        for grain, values in enumerate(grains)
    ]
    columns = ("case", "program", "time_step_or_reading", "grain", "v_x", "v_y", "v_z", "omega_x", "omega_y", "omega_z")
    return Section(collisions.NAME, table(header, rows), faults, columns, csv_rows)


def growths(found: dict[str, list[dict[str, list[float]]]]) -> dict[tuple[str, str], Growth]:
    """By case and pair, where it can be told of two seeds or more."""
    rates: dict[tuple[str, str], Growth] = {}
    for case in chaos.CASES:
        for pair in chaos.PAIRS:
            each = [chaos.growth_rate(case.times, chaos.as_array(run[pair])) for run in found.get(case.name, [])]
            known = [rate for rate in each if rate is not None]
            if len(known) > 1:
                rates[case.name, pair] = Growth.of(known)
    return rates


def of_chaos(found: dict[str, list[dict[str, list[float]]]]) -> Section:
    rates = growths(found)
    rows: list[list[str]] = []
    csv_rows: Rows = []
    faults: list[str] = []
    for case in chaos.CASES:
        if case.name not in found:
            continue
        runs = found[case.name]
        first = chaos.typical([run["between"] for run in runs], chaos.EARLY)
        row = [case.title, power(first)]
        for pair in chaos.PAIRS:
            growth = rates.get((case.name, pair))
            row.append("–" if growth is None else with_error(growth.mean, growth.error))
            if growth is not None:
                csv_rows.append([case.name, pair, growth.mean, growth.error, growth.seeds])
        growth = rates.get((case.name, "ours"))
        row.append("–" if growth is None else f"{1 / growth.mean:.2f}")
        row.append(f"{chaos.parting_time(case, [run['between'] for run in runs]):.0f}")
        rows.append(row)
        ours = rates.get((case.name, "ours"))
        for pair in ("between", "theirs"):
            other = rates.get((case.name, pair))
            if ours is not None and other is not None:
                apart = abs(ours.mean - other.mean) / math.hypot(ours.error, other.error)
                if apart > LARGEST_DEVIATION:
                    faults.append(f"{case.name}: differences grow at another rate ({pair})")
    header = [
        "tube",
        f"distance at t = {chaos.EARLY:g}",
        "rate, between the programs",
        "rate, ours moved",
        "rate, LAMMPS moved",
        "Lyapunov time",
        f"apart by {chaos.APART:g} d at t",
    ]
    return Section(chaos.NAME, table(header, rows), faults, ("case", "pair", "rate", "error", "seeds"), csv_rows)


def comparisons(found: Samples, points: list[Point], compared: dict[str, str]) -> list[Comparison]:
    return [
        stationary.compare(
            point, observable, *([sample[observable] for sample in found[point.name][program]] for program in (OURS, THEIRS))
        )
        for point in points
        if point.name in found
        for observable in compared
    ]


def of_statistics(name: str, found: Samples, points: list[Point], compared: dict[str, str], apart: str = "") -> Section:
    """Every observable at every point, and chi squared over all but the one that the programs read differently."""
    rows = []
    agreeing: list[Comparison] = []
    for point in points:
        if point.name not in found:
            continue
        row = [point.title]
        for result in comparisons(found, [point], compared):
            row += [with_error(result.ours, result.our_error), with_error(result.theirs, result.their_error)]
            row.append(f"{result.deviation:+z.1f}")
            if result.observable != apart:
                agreeing.append(result)
        rows.append(row)
    header = ["lattice or law, strain rate, width, start, periods"]
    for title in compared.values():
        header += [f"{title}, ours", "LAMMPS", "difference/error"]
    chi_squared = sum(result.deviation**2 for result in agreeing)
    probability = chance(chi_squared, len(agreeing))
    words = (
        f"\n{_numbers(found, OURS)} runs of ours and {_numbers(found, THEIRS)} of LAMMPS at each point. Chi squared over the "
        f"{len(agreeing)} differences of {_listed([compared[key] for key in compared if key != apart])}: {chi_squared:.1f}; "
        f"by chance it is larger in {100 * probability:.0f} % of cases.\n"
    )
    faults = [
        f"{result.point.name}: {result.observable} differs by {result.deviation:.1f} errors"
        for result in agreeing
        if abs(result.deviation) > LARGEST_DEVIATION
    ]
    if probability < LEAST_CHANCE:
        faults.append(f"{name}: chi squared {chi_squared:.1f} of {len(agreeing)}")
    columns = ("point", "program", "run", *compared, "escaped")
    csv_rows: Rows = [
        [point, program, run, *(sample[column] for column in columns[3:])]
        for point, by_program in found.items()
        for program, samples in by_program.items()
        for run, sample in enumerate(samples)
    ]
    return Section(name, table(header, rows) + words, faults, columns, csv_rows)


def _numbers(found: Samples, program: str) -> str:
    """Of runs at a point, from the least to the largest."""
    numbers = sorted({len(samples[program]) for samples in found.values()})
    return " or ".join(map(str, numbers))


def _listed(words: list[str]) -> str:
    return f"{', '.join(words[:-1])} and {words[-1]}"
