"""Matplotlib axes in the style of the program's figures.

Every function draws into `axes`, or into a new figure of one column's width, and answers the axes. Colours are those of
Okabe and Ito, which stay apart for colour-blind readers; red moves along the wave, blue against it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from functools import wraps
from typing import TYPE_CHECKING, Any, ParamSpec

import numpy as np
import numpy.typing as npt

from . import newtonian
from ._simulation import Simulation
from .analysis import Collapse, CollapseResult, Survival

try:
    import matplotlib
    import matplotlib.pyplot as plt
    from cycler import cycler
    from matplotlib.collections import EllipseCollection
    from matplotlib.colors import Normalize
except ImportError as error:
    raise ImportError("peristalsis.plot needs Matplotlib: pip install 'peristalsis[plot]'") from error

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Parameters = ParamSpec("Parameters")

__all__ = ["STYLE", "axes", "collapse", "flow", "profile", "snapshot", "stationary_flow", "survival"]

#: Millimetres in an inch.
_INCH = 25.4
#: One column of a journal, and two [mm].
SINGLE_COLUMN, DOUBLE_COLUMN = 86.0, 178.0
#: Blue, vermillion, bluish green, orange, reddish purple, sky blue (Okabe & Ito).
COLOURS = ("#0072B2", "#D55E00", "#009E73", "#E69F00", "#CC79A7", "#56B4E9")
ALONG, AGAINST, GREY = "#B2182B", "#2166AC", "#808080"

#: Matplotlib settings of the program's figures: ``with matplotlib.rc_context(STYLE): ...``.
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
    "axes.prop_cycle": cycler(color=COLOURS),
    "xtick.direction": "in",
    "ytick.direction": "in",
    "xtick.top": True,
    "ytick.right": True,
    "xtick.major.size": 3.0,
    "ytick.major.size": 3.0,
    "xtick.minor.size": 1.6,
    "ytick.minor.size": 1.6,
    "xtick.major.width": 0.55,
    "ytick.major.width": 0.55,
    "xtick.minor.width": 0.55,
    "ytick.minor.width": 0.55,
    "xtick.minor.visible": True,
    "ytick.minor.visible": True,
    "lines.linewidth": 1.0,
    "lines.markersize": 3.5,
    "errorbar.capsize": 1.5,
    "svg.fonttype": "none",
    "pdf.fonttype": 42,
    "savefig.dpi": 300,
}


def _styled(draw: Callable[Parameters, Axes]) -> Callable[Parameters, Axes]:
    """The same function with the settings of `STYLE`."""

    @wraps(draw)
    def styled(*arguments: Parameters.args, **keywords: Parameters.kwargs) -> Axes:
        with matplotlib.rc_context(STYLE):
            return draw(*arguments, **keywords)

    return styled


def axes(width: float = SINGLE_COLUMN, height: float = 60.0) -> Axes:
    """New axes in the style, in a figure of `width` by `height` millimetres."""
    with matplotlib.rc_context(STYLE):
        figure, new = plt.subplots(figsize=(width / _INCH, height / _INCH), layout="constrained")
        # Ticks are made lazily, by the settings of that moment.
        new.xaxis.get_major_ticks(), new.yaxis.get_major_ticks()
        new.xaxis.get_minor_ticks(), new.yaxis.get_minor_ticks()
    return new


@_styled
def flow(simulation: Simulation, into: Axes | None = None, **line: Any) -> Axes:
    """J/Jmax against time: samples faint, period averages over them, the Newtonian fluid for reference."""
    new = axes() if into is None else into
    series, summary = simulation.timeseries(), simulation.summary()
    time, ratio = series["time"], series["flow_rate_ratio"]
    each = _samples_per_period(simulation)
    (drawn,) = new.plot(time, ratio, **{"alpha": 0.4, "linewidth": 0.5, "color": COLOURS[0], **line})
    if each and len(time) >= each:
        whole = len(time) // each * each
        middle = time[:whole].reshape(-1, each).mean(axis=1)
        new.plot(middle, ratio[:whole].reshape(-1, each).mean(axis=1), color=drawn.get_color())
    if (fluid := summary["newtonian_flow_rate_ratio"]) is not None:
        new.axhline(fluid, color=GREY, linestyle="--", linewidth=0.7, label="Newtonian fluid")
    if (transition := simulation.transition_time) is not None:
        new.axvline(transition, color=GREY, linestyle=":", linewidth=0.7, label=r"$\tau$")
    new.set(xlabel=r"time $t$ [$t$]", ylabel=r"flow rate $J/J_{\mathrm{max}}$")
    if new.get_legend_handles_labels()[0]:
        new.legend()
    return new


def _samples_per_period(simulation: Simulation) -> int:
    """Samples in a period of the wave as it is driven now; 0 for a static wave."""
    interval = simulation.configuration.time_step * simulation._run.steps_per_sample
    return round(1.0 / (simulation.strain_rate * interval)) if simulation.strain_rate else 0


@_styled
def snapshot(simulation: Simulation, into: Axes | None = None) -> Axes:
    """Grains from the side, the wave to the right, coloured by axial velocity along it in units of its speed."""
    new = axes(DOUBLE_COLUMN, 45.0) if into is None else into
    length, heading = simulation.length, simulation.heading

    def along(z: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
        return z if heading > 0 else length - z

    wall, grains, diameters = simulation.wall_positions, simulation.positions, simulation.diameters
    speed = simulation.strain_rate * length / simulation.configuration.waves
    velocity = heading * simulation.velocities[:, 2] / (speed or 1.0)
    order = np.argsort(grains[:, 0])
    new.scatter(along(wall[:, 2]), wall[:, 1], s=1.0, color=GREY, linewidths=0, alpha=0.4)
    drawn = EllipseCollection(
        diameters[order],
        diameters[order],
        np.zeros(len(order)),
        units="xy",
        offsets=np.column_stack([along(grains[order, 2]), grains[order, 1]]),
        offset_transform=new.transData,
        array=velocity[order],
        cmap="RdBu_r",
        norm=Normalize(-1.0, 1.0),
        edgecolors="black",
        linewidths=0.2,
    )
    new.add_collection(drawn)
    # Grains that escaped are far away, and not shown.
    outermost = 1.1 * float(np.hypot(wall[:, 0], wall[:, 1]).max())
    new.set(xlabel=r"$z$ [$d$]", ylabel=r"$y$ [$d$]", aspect="equal", xlim=(0.0, length), ylim=(-outermost, outermost))
    new.figure.colorbar(drawn, ax=new, label=r"$v_z/c$", shrink=0.8)
    return new


@_styled
def profile(simulation: Simulation, column: str = "density", into: Axes | None = None, **line: Any) -> Axes:
    """A column of the late profile against the position in the wave's frame, with its error where it has one."""
    new = axes() if into is None else into
    table = simulation.profile()
    values, errors = table[column], None
    if f"{column}_error" in table:
        errors = table[f"{column}_error"]
    (drawn,) = new.plot(table["position"], values, **line)
    if errors is not None:
        new.fill_between(table["position"], values - errors, values + errors, color=drawn.get_color(), alpha=0.25, linewidth=0)
    unit = table.units[column]
    name = column.replace("_", " ")
    new.set(xlabel=r"$(z - ct)/\lambda$", ylabel=name if unit == "1" else f"{name} [{unit}]", xlim=(0.0, 1.0))
    return new


@_styled
def stationary_flow(
    width: npt.ArrayLike,
    ratio: npt.ArrayLike,
    error: npt.ArrayLike | None = None,
    into: Axes | None = None,
    *,
    radius: float | None = 1.5,
    **points: Any,
) -> Axes:
    """Stationary J/Jmax against the width, with the Newtonian fluid in a tube of mean radius `radius`; None: without."""
    new = axes() if into is None else into
    new.errorbar(width, ratio, yerr=error, **{"fmt": "o", **points})
    if radius is not None:
        widths = np.linspace(*new.get_xlim(), 200)
        widths = widths[(widths >= 0) & (widths <= 2 * radius)]
        new.plot(widths, newtonian.flow_rate_ratio(widths, radius), color=GREY, linestyle="--", linewidth=0.7, label="Newtonian fluid")
        new.legend()
    new.set(xlabel=r"width $w$ [$d$]", ylabel=r"flow rate $J/J_{\mathrm{max}}$")
    return new


@_styled
def survival(curve: Survival, into: Axes | None = None, **line: Any) -> Axes:
    """Part of the runs without a transition, as a step function with its interval of 68 per cent."""
    new = axes() if into is None else into
    time = np.array([0.0, *(step.time for step in curve.steps), curve.watched])
    levels = [step.survival for step in curve.steps]
    value = np.array([1.0, *(level.value for level in levels)])
    lower = np.array([1.0, *(level.interval_68.lower for level in levels)])
    upper = np.array([1.0, *(level.interval_68.upper for level in levels)])
    (drawn,) = new.step(time, np.append(value, value[-1]), where="post", **line)
    new.fill_between(
        time, np.append(lower, lower[-1]), np.append(upper, upper[-1]), step="post", color=drawn.get_color(), alpha=0.25, linewidth=0
    )
    new.set(xlabel=r"time $t$ [$t$]", ylabel="runs without a transition", ylim=(0.0, 1.05))
    return new


@_styled
def collapse(
    what: Collapse,
    parameters: CollapseResult | Sequence[float],
    into: Axes | None = None,
    *,
    names: Iterable[str] | None = None,
) -> Axes:
    """The scaled curves, one colour each, with the quality of the collapse in the title."""
    new = axes() if into is None else into
    chosen = parameters.parameters if isinstance(parameters, CollapseResult) else parameters
    labels = list(names) if names is not None else [f"{curve[0]:g}" for curve in what.curves]
    for place, ((_, x, y, error), label) in enumerate(zip(what.scaled(chosen), labels, strict=True)):
        new.errorbar(x, y, yerr=error, fmt="osD^v<>"[place % 7], color=COLOURS[place % len(COLOURS)], label=label)
    quality = what.quality(chosen)
    new.set_title(f"S = {quality.quality:.2f}, overlap {quality.overlap:.0%}")
    new.set(xlabel="scaled abscissa", ylabel="scaled ordinate")
    new.legend()
    return new
