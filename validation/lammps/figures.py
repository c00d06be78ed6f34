"""Pictures in the style of the program's figures (`peristalsis.plot`): for print, and for colour-blind readers."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import chaos
import collisions
import matplotlib
import numpy as np
import stationary
from chaos import Case
from collisions import Found
from matplotlib import pyplot as plt
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from sections import Samples, comparisons, growths
from stationary import Comparison

matplotlib.use("Agg")
# Millimetres of an inch, and of two columns of a journal.
INCH, WIDTH = 25.4, 178.0
BLUE, VERMILLION, GREEN, GREY = "#0072B2", "#D55E00", "#009E73", "#808080"
STYLE: Any = {
    "font.family": "sans-serif",
    "font.sans-serif": ["Arimo", "Arial", "Liberation Sans", "Helvetica", "DejaVu Sans"],
    "font.size": 7.0,
    "axes.titlesize": 7.5,
    "axes.labelsize": 8.0,
    "xtick.labelsize": 7.0,
    "ytick.labelsize": 7.0,
    "legend.fontsize": 6.8,
    "legend.frameon": False,
    "axes.linewidth": 0.55,
    "xtick.direction": "in",
    "ytick.direction": "in",
    "xtick.top": True,
    "ytick.right": True,
    "xtick.major.width": 0.55,
    "ytick.major.width": 0.55,
    "xtick.minor.width": 0.55,
    "ytick.minor.width": 0.55,
    "lines.linewidth": 1.0,
    "lines.markersize": 3.5,
    "errorbar.capsize": 1.5,
    "savefig.dpi": 220,
}
LABELS = {"ours": "peristalsis", "theirs": "LAMMPS"}
MARKS = {"ours": (BLUE, "o", BLUE), "theirs": (VERMILLION, "s", "none")}


def _figure(columns: int, height: float, rows: int = 1, **more: Any) -> tuple[Figure, Any]:
    return plt.subplots(rows, columns, figsize=(WIDTH / INCH, height / INCH), layout="constrained", **more)


def _save(figure: Figure, path: Path) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path, metadata={"Software": None})
    plt.close(figure)


def draw_collisions(found: dict[str, Found], path: Path) -> None:
    """The difference from the exact collision against the length of a step."""
    shown = [case for case in collisions.CASES if case.name in ("head-on-2", "hertz-oblique", "stick-large") and case.name in found]
    with matplotlib.rc_context(STYLE):
        figure, grid = _figure(len(shown), 56.0, sharey=True, squeeze=False)
        for axes, case in zip(grid[0], shown, strict=True):
            for program, (colour, mark, face) in MARKS.items():
                steps, errors = collisions.errors(case, found[case.name], program)
                axes.loglog(steps, errors, mark, color=colour, mfc=face, label=LABELS[program], ls="-", lw=0.6)
            for order, style in ((1, "--"), (2, ":")):
                steps = np.array([1e-3, 5e-2])
                axes.loglog(steps, 0.3 * 0.05 * (steps / 5e-2) ** order, style, color=GREY, lw=0.7, label=f"order {order}")
            axes.set_title(case.title)
            axes.set_xlabel("time step [t]")
            axes.axhline(collisions.TOLERANCE, color=GREY, lw=0.4)
        grid[0, 0].set_ylabel("difference from the exact\nvelocity and spin after / speed")
        grid[0, 0].set_ylim(1e-9, 0.2)
        grid[0, -1].legend(loc="upper left")
        _save(figure, path)


# Colour, width and style of a line: LAMMPS moved lies upon ours moved.
PAIR_LINES: dict[str, tuple[str, float, Any]] = {
    "ours": ("#56B4E9", 1.3, "-"),
    "theirs": (VERMILLION, 0.5, (0, (5, 2))),
    "between": ("black", 0.5, "-"),
}
PAIR_LABELS = {
    "ours": "peristalsis, moved by $10^{-12}$ d",
    "theirs": "LAMMPS, moved by $10^{-12}$ d",
    "between": "between the two programs",
}


def draw_chaos(found: dict[str, list[dict[str, list[float]]]], path: Path) -> None:
    """The distance of two runs against time."""
    cases = [case for case in chaos.CASES if case.name in found]
    rates = growths(found)
    with matplotlib.rc_context(STYLE):
        figure, grid = _figure(2, 104.0, rows=2, sharey=True, squeeze=False)
        for axes, case in zip(grid.ravel(), cases, strict=False):
            _draw_parting(axes, case, found[case.name])
            growth = rates.get((case.name, "ours"))
            if growth is not None:
                words = f"growth rate {growth.mean:.3f} ± {growth.error:.3f}, Lyapunov time {1 / growth.mean:.1f}"
                axes.text(0.97, 0.05, words, transform=axes.transAxes, ha="right")
        for axes in grid.ravel()[len(cases) :]:
            axes.set_visible(False)
        figure.legend(*grid[0, 0].get_legend_handles_labels(), loc="outside upper center", ncols=len(PAIR_LABELS))
        for axes in grid[:, 0]:
            axes.set_ylabel("distance of two runs [d]")
        for axes in grid[-1]:
            axes.set_xlabel("time [t]")
        _save(figure, path)


def _draw_parting(axes: Axes, case: Case, runs: list[dict[str, list[float]]]) -> None:
    for pair, (colour, width, style) in PAIR_LINES.items():
        for number, run in enumerate(runs):
            distances = np.array(run[pair])
            shown = distances > 0
            label = PAIR_LABELS[pair] if number == 0 else None
            axes.semilogy(case.times[shown], distances[shown], color=colour, ls=style, lw=width, label=label)
    axes.axhspan(chaos.LEAST, chaos.LARGEST, color="0.94", zorder=0)
    axes.set_title(case.title)
    axes.set_xlim(0, case.duration)
    axes.set_ylim(1e-16, 40)


def draw_stationary(found: Samples, path: Path) -> None:
    """Means against the width, and below them the differences over their errors."""
    groups = [group for group in ("coarse", "fine") if any(point.group == group for point in stationary.POINTS if point.name in found)]
    observables = list(stationary.COMPARED)
    titles = {"coarse": "coarse lattice, strain rate 0.05", "fine": "fine lattice, strain rate 0.1"}
    with matplotlib.rc_context(STYLE):
        heights = [1.0, 0.45] * len(groups)
        figure, grid = _figure(
            len(observables), 70.0 * len(groups), rows=2 * len(groups), squeeze=False, gridspec_kw={"height_ratios": heights}
        )
        for row, group in enumerate(groups):
            points = [point for point in stationary.POINTS if point.group == group]
            results = comparisons(found, points, stationary.COMPARED)
            for column, observable in enumerate(observables):
                above, below = grid[2 * row, column], grid[2 * row + 1, column]
                chosen = [result for result in results if result.observable == observable]
                _draw_means(above, chosen)
                _draw_deviations(below, chosen)
                above.set_ylabel(stationary.COMPARED[observable].replace("J/Jmax", r"$J/J_\mathrm{max}$"))
                above.set_title(titles[group])
                below.set_xlabel("bottleneck w [d]")
                widths = [point.width for point in points]
                for axes in (above, below):
                    axes.set_xlim(min(widths) - 0.02, max(widths) + 0.02)
                if observable == "granular_temperature":
                    above.set_yscale("log")
        grid[0, 0].legend(loc="lower left")
        for row in range(1, 2 * len(groups), 2):
            grid[row, 0].set_ylabel("difference\n/ error")
        figure.align_ylabels()
        _save(figure, path)


def _draw_means(axes: Axes, results: list[Comparison]) -> None:
    widths = np.array([result.point.width for result in results])
    # Side by side, for they would cover each other.
    apart = 0.012 * (widths.max() - widths.min())
    values = {
        "ours": (widths - apart, [r.ours for r in results], [r.our_error for r in results]),
        "theirs": (widths + apart, [r.theirs for r in results], [r.their_error for r in results]),
    }
    for program, (places, means, errors) in values.items():
        colour, mark, face = MARKS[program]
        axes.errorbar(places, means, errors, fmt=mark, color=colour, mfc=face, label=LABELS[program], lw=0.7)
    axes.tick_params(labelbottom=False)


def _draw_deviations(axes: Axes, results: list[Comparison]) -> None:
    axes.axhspan(-2, 2, color="0.92", zorder=0)
    axes.axhline(0, color=GREY, lw=0.5)
    axes.plot([r.point.width for r in results], [r.deviation for r in results], "d", color=GREEN)
    axes.set_ylim(-4.5, 4.5)
    axes.set_yticks([-4, -2, 0, 2, 4])
