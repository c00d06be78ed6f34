"""Matplotlib axes in the style of the command line's figures.

Every function draws into `ax`, or into a new figure as wide as a journal's column, and answers the axes. New figures have
the fonts, symbols and sizes of `STYLE`; axes of yours keep your settings. Colours are those of Okabe and Ito, which stay
apart for colour-blind readers; red moves along the wave, blue against it. Beyond six curves marks or dashes tell apart what
has the same colour. A legend that would hide something stands below the axes, for which a new figure
grows; in a figure of yours it does so where that has a layout engine.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np
import numpy.typing as npt

from . import newtonian
from ._arrays import Array
from ._drive import PARAMETERS
from ._given import of_kind
from ._simulation import Simulation
from ._snapshot import snapshot
from ._core import flow_in_time, with_error
from ._fit import set_legend, set_title
from ._style import ALONG, COLOURS, DOUBLE_COLUMN, GREY, SINGLE_COLUMN, STYLE, axes, drawing
from ._title import SEPARATOR, title, unit, unit_of
from .analysis import Collapse, CollapseResult, Survival

from matplotlib.container import ErrorbarContainer

if TYPE_CHECKING:
    from matplotlib.axes import Axes

__all__ = [
    "COLOURS",
    "DOUBLE_COLUMN",
    "SINGLE_COLUMN",
    "STYLE",
    "axes",
    "collapse",
    "flow",
    "hysteresis",
    "profile",
    "snapshot",
    "stationary_flow",
    "survival",
]


def __dir__() -> list[str]:
    return sorted(__all__)

BLUE, VERMILLION, GREEN, ORANGE, PURPLE, SKY = COLOURS
_RATIO = r"flow rate, $J/J_{\mathrm{max}}$"
_PHASE = r"position in the wave frame, $(z - ct)/\lambda$"
_WIDTH = r"width of the bottleneck, $w/d$"
#: Words and symbol of a column of the profile, its colour, and what it is drawn in where that is not its unit.
_COLUMNS = {
    "density": ("grains per length", "n_1", BLUE),
    "axial_velocity": ("axial velocity", "v_z", ALONG),
    "granular_temperature": ("granular temperature", r"T_{\mathrm{g}}", PURPLE),
    "radius": ("wall radius", "R", BLUE),
    "wall_pressure": ("pressure on the wall", "p", ORANGE),
    "wall_shear": ("shear on the wall", r"\sigma", GREEN),
    "wall_axial_velocity": ("axial velocity of the wall", "v_z", ALONG),
}
#: Marks and dashes of curves, so that those of one colour differ.
_MARKS, _DASHES = "osD^v<>", ("-", "--", "-.", ":")
#: Height of the axes of `flow` with their names, without the legend [mm], and periods up to which each mean has its mark.
_FLOW_HEIGHT, _MARKED = 50.0, 60
#: Name that marks what is drawn once in axes, however often a function is called.
_REFERENCE, _CURVE = "peristalsis: reference", "peristalsis: curve"


class Loop(Protocol):
    """A parameter that was driven there and back, as `Simulation.ramp` returns it."""

    @property
    def parameter(self) -> str: ...
    @property
    def law(self) -> str: ...
    def table(self) -> Any: ...


def flow(simulation: Simulation, ax: Axes | None = None, *, label: str | None = None, **line: Any) -> Axes:
    """J/Jmax against time: samples faint, the mean over each period over them, the Newtonian fluid for reference.

    Parameters
    ----------
    simulation : Simulation
        A simulation that has measured something.
    ax : matplotlib.axes.Axes, optional
        Where to draw; a second simulation in the same axes takes the next colour.
    label : str, optional
        Its name in the legend, where several are compared.
    **line
        Keywords of ``Axes.plot`` for the mean over each period.

    Returns
    -------
    matplotlib.axes.Axes

    Raises
    ------
    ValueError
        Where nothing has been measured, or the wave is at rest and has no Jmax.

    Examples
    --------
    >>> from peristalsis import Simulation, plot
    >>> sim = Simulation.preset("frictionless", width=2.6, strain_rate=0.1, seed=1, waves=2)
    >>> sim.run(periods=3)
    >>> plot.flow(sim).get_xlabel()
    'time, $t/T$'
    """
    of_kind("simulation", simulation, Simulation, "a peristalsis.Simulation")
    (time, ratio), (middle, mean) = flow_in_time(simulation._run)
    summary, strain_rate = simulation.summary(), simulation.configuration["drive.strain_rate"]
    last = summary["time"] * strain_rate
    if not np.isfinite(ratio).any():
        raise ValueError("there is no flow rate to draw: run the simulation first, with a wave that moves")
    is_alone = ax is None and label is None
    with drawing(ax, height=_FLOW_HEIGHT) as new:
        known = [np.max(drawn.get_xdata(), initial=0.0) for drawn in new.lines if drawn.get_gid() == _CURVE]
        colour = line.pop("color", COLOURS[len(known) % len(COLOURS)])
        faint = {"color": SKY, "label": "samples"} if is_alone else {"color": colour, "alpha": 0.4}
        new.plot(time, ratio, linewidth=0.6, **faint)
        style: dict[str, Any] = {"linewidth": 1.1, "markersize": 3.0, "markeredgewidth": 0.0}
        if len(mean) <= _MARKED or len(known) >= len(COLOURS):
            style |= {"marker": _mark(len(known)), "markevery": max(1, len(mean) // _MARKED * 4)}
        name = label or ("mean over a period" if is_alone and len(mean) else None)
        # Without a whole period its name alone tells whose the samples are.
        new.plot(middle, mean, **{**style, **line}, color=colour, label=name, gid=_CURVE)
        _flow_references(new, summary, {"color": GREEN} if is_alone else {"color": colour, "alpha": 0.7})
        if is_alone:
            _late_mean(new, summary, last)
            if summary["transition_time"] is not None:
                place = summary["transition_time"] * strain_rate
                words = rf"$\tau$ = {summary['transition_time']:.4g} ${unit(simulation, 't')}$ = {place:.1f} $T$"
                new.axvline(place, color=VERMILLION, linewidth=0.9, label=words)
            set_title(new, title(simulation), SEPARATOR)
        new.set(xlabel="time, $t/T$", ylabel=_RATIO, xlim=(0.0, math.ceil(max([last - 1e-6, *known]))))
        handles = sorted(new.get_legend_handles_labels()[0], key=lambda drawn: drawn.get_gid() != _CURVE)
        set_legend(new, handles, inside=False)
    return new


def _mark(number: int) -> str:
    """Mark of a curve by its number; with its colour it comes again after 42."""
    return _MARKS[number % len(_MARKS)]


def _once(ax: Axes, name: str) -> bool:
    """Whether a reference is new to these axes."""
    return all(line.get_gid() != f"{_REFERENCE} {name}" for line in ax.lines)


def _level(ax: Axes, value: float, name: str | None, **line: Any) -> None:
    """A level from side to side, once; a second value of the same name stays out of the legend."""
    if _once(ax, f"{name} {value!r}"):
        names = [drawn.get_label() for drawn in ax.lines]
        ax.axhline(value, **line, gid=f"{_REFERENCE} {name} {value!r}", label=None if name in names else name)


def _flow_references(ax: Axes, summary: Mapping[str, Any], fluid: Mapping[str, Any]) -> None:
    for value in (0.0, 1.0):
        _level(ax, value, None, color=GREY, linewidth=0.4, zorder=0.5)
    _level(ax, summary["transition_threshold"], "threshold", color=ax.xaxis.label.get_color(), linestyle=":", linewidth=0.8)
    for key, name, dashes in (
        ("newtonian_flow_rate_ratio", "Newtonian fluid", "--"),
        ("newtonian_flow_rate_ratio_clear_bore", "the same, clear bore", "-."),
    ):
        if summary[key] is not None:
            _level(ax, summary[key], name, linestyle=dashes, linewidth=0.9, **fluid)


def _late_mean(ax: Axes, summary: Mapping[str, Any], last: float) -> None:
    mean, error, late = (summary[key] for key in ("flow_rate_ratio", "flow_rate_ratio_error", "late_periods"))
    if None not in (mean, error, late) and np.isfinite([mean, error, late]).all():
        span = np.array([last - late, last])
        ax.fill_between(span, mean - error, mean + error, color=ORANGE, alpha=0.25, linewidth=0)
        ax.plot(span, [mean, mean], color=ORANGE, label=f"late mean {with_error(mean, error)}")


def profile(simulation: Simulation, column: str = "density", ax: Axes | None = None, *, label: str | None = None, **line: Any) -> Axes:
    """A column of the late profile against the position in the wave frame, with the band of its error where it has one.

    Velocities are drawn in units of the wave's speed c, temperatures of m c^2, all else in the unit of its column.

    Parameters
    ----------
    simulation : Simulation
        A simulation that has measured something.
    column : str
        A column of `Simulation.profile`: ``density``, ``axial_velocity``, ``granular_temperature``, ``radius``, ...
    ax : matplotlib.axes.Axes, optional
        Where to draw.
    label : str, optional
        Its name in a legend.
    **line
        Keywords of ``Axes.plot``.

    Returns
    -------
    matplotlib.axes.Axes

    Raises
    ------
    ValueError
        Where there is no such column, or nothing was measured of it.

    Examples
    --------
    >>> from peristalsis import Simulation, plot
    >>> sim = Simulation.preset("frictionless", width=2.6, strain_rate=0.1, seed=1, waves=2)
    >>> sim.run(periods=3)
    >>> plot.profile(sim, "axial_velocity").get_ylabel()
    'axial velocity, $v_z/c$'
    """
    of_kind("simulation", simulation, Simulation, "a peristalsis.Simulation")
    table = simulation.profile()
    if column not in table:
        raise ValueError(f"the profile has no column {column!r}; it has {', '.join(table.column_names)}")
    if not np.isfinite(table[column]).any():
        long = "some periods in its late part" if column.endswith("_error") else "a period at least"
        raise ValueError(f"there is no {column} to draw yet: run the simulation longer, for {long}")
    words, symbol, colour = _COLUMNS.get(column, (column.replace("_", " "), "", BLUE))
    speed = simulation.strain_rate * simulation.configuration["tube.wavelength"]
    of_wave = {"d/t": (1.0 / speed, "c"), "m d^2/t^2": (1.0 / speed**2, r"m\,c^2")} if speed else {}
    scale, name = of_wave.get(table.units[column], (1.0, unit(simulation, table.units[column])))
    place = np.concatenate([table["position"][-1:] - 1.0, table["position"], table["position"][:1] + 1.0])

    def closed(name: str) -> Array:
        values: Array = scale * table[name]
        return np.concatenate([values[-1:], values, values[:1]])

    with drawing(ax) as new:
        known = sum(drawn.get_gid() == _CURVE for drawn in new.lines)
        colour = line.pop("color", colour if not known else COLOURS[known % len(COLOURS)])
        new.plot(place, closed(column), color=colour, label=label, gid=_CURVE, **_dashes(known, line))
        if f"{column}_error" in table:
            error = np.nan_to_num(closed(f"{column}_error"))
            new.fill_between(place, closed(column) - error, closed(column) + error, color=colour, alpha=0.25, linewidth=0)
        if column not in ("radius", "least_radius", "largest_radius"):
            _level(new, 0.0, None, color=GREY, linewidth=0.4, zorder=0.5)
        new.set(xlabel=_PHASE, ylabel=_quantity(words, symbol, name), xlim=(0.0, 1.0))
        if label is not None:
            set_legend(new)
    return new


def _dashes(number: int, line: Mapping[str, Any]) -> dict[str, Any]:
    """Keywords of a line, with dashes by its number that tell it from one of the same colour."""
    dashes = _DASHES[number // len(COLOURS) % len(_DASHES)]
    return dict(line) if {"linestyle", "ls"} & line.keys() else {**line, "linestyle": dashes}


def _quantity(words: str, symbol: str, unit: str) -> str:
    """Label of an axis that bears plain numbers: words, and the symbol over its unit."""
    if not symbol:
        return words if unit == "1" else f"{words} [${unit}$]"
    if unit == "1":
        return f"{words}, ${symbol}$"
    if unit.startswith("1/"):
        return rf"{words}, ${symbol}\,{unit[2:]}$"
    if unit == "k/d":
        return rf"{words}, ${symbol}\,d/k$"
    return f"{words}, ${symbol}/{unit if re.fullmatch(r'[A-Za-z]+', unit) else f'({unit})'}$"


def stationary_flow(
    width: npt.ArrayLike,
    ratio: npt.ArrayLike,
    error: npt.ArrayLike | None = None,
    ax: Axes | None = None,
    *,
    radius: float | None = 1.5,
    label: str | None = None,
    **points: Any,
) -> Axes:
    """Stationary J/Jmax against the width, beside the Newtonian fluid.

    Parameters
    ----------
    width, ratio : array_like
        w [d] and J/Jmax.
    error : array_like, optional
        Standard errors of J/Jmax.
    ax : matplotlib.axes.Axes, optional
        Where to draw.
    radius : float or None
        Mean radius of the tube [d], for the fluid; None: without it.
    label : str, optional
        Name of these points in the legend.
    **points
        Keywords of ``Axes.errorbar``.

    Returns
    -------
    matplotlib.axes.Axes

    Raises
    ------
    ValueError
        Where no point has a width and a ratio.

    Examples
    --------
    >>> from peristalsis import plot
    >>> plot.stationary_flow([2.4, 2.6], [0.9, 0.4], [0.01, 0.02]).get_xlabel()
    'width of the bottleneck, $w/d$'
    """
    places, values = (np.asarray(np.ma.array(column, float).filled(np.nan), float) for column in (width, ratio))
    if places.shape != values.shape:
        raise ValueError(f"each point has a width and a ratio: there are {places.size} widths, but {values.size} ratios")
    if not (np.isfinite(places) & np.isfinite(values)).any():
        raise ValueError("there are no points to draw: give the width and J/Jmax of one run at least")
    with drawing(ax) as new:
        known = sum(isinstance(drawn, ErrorbarContainer) for drawn in new.containers)
        new.errorbar(width, ratio, yerr=error, label=label, **{"fmt": _mark(known), **points})
        if radius is not None:
            _newtonian_curve(new, radius)
        new.set(xlabel=_WIDTH, ylabel=_RATIO)
        if new.get_legend_handles_labels()[0]:
            set_legend(new)
    return new


def _newtonian_curve(ax: Axes, radius: float) -> None:
    """The fluid over all widths of the axes, drawn anew where points have widened them."""
    name = f"{_REFERENCE} {radius!r}"
    for line in [line for line in ax.lines if line.get_gid() == name]:
        line.remove()
    widths = np.linspace(*ax.get_xlim(), 200)
    widths = widths[(widths >= 0) & (widths <= 2 * radius)]
    if len(widths):
        ratio = newtonian.flow_rate_ratio(widths, radius)
        ax.plot(widths, ratio, color=GREEN, linestyle="--", linewidth=0.9, label="Newtonian fluid", gid=name)


def hysteresis(loop: Loop, ax: Axes | None = None, *, radius: float | None = None) -> Axes:
    """J/Jmax as a parameter of the drive is ramped there and back, with errors: a loop where the way matters.

    A dotted line stands where a branch crosses the loop's threshold.

    Parameters
    ----------
    loop
        What `Simulation.ramp` returns.
    ax : matplotlib.axes.Axes, optional
        Where to draw.
    radius : float, optional
        Mean radius of the tube [d]: draws the Newtonian fluid too, where the parameter is the width.

    Returns
    -------
    matplotlib.axes.Axes

    Examples
    --------
    >>> import peristalsis
    >>> sim = peristalsis.Simulation.preset("frictionless-fine", waves=2, strain_rate=0.05, seed=1)
    >>> len(peristalsis.plot.hysteresis(sim.ramp("width", 2.4, 2.8, periods=6, levels=3)).containers)
    2
    """
    if not (hasattr(loop, "parameter") and callable(getattr(loop, "table", None))):
        raise TypeError(f"loop is what Simulation.ramp answered, not {loop!r}")
    table = loop.table()
    branch = np.asarray(table["branch"])
    value, ratio, error = (np.asarray(table[name], float) for name in ("value", "flow_rate_ratio", "flow_rate_ratio_error"))
    with drawing(ax) as new:
        for name, colour, mark, face in (("there", BLUE, "o", BLUE), ("back", VERMILLION, "s", "white")):
            here = branch == name
            if here.any():
                x, y = value[here], ratio[here]
                way = f"{name}, {'upwards' if x[-1] >= x[0] else 'downwards'}"
                new.errorbar(x, y, yerr=error[here], color=colour, marker=mark, markerfacecolor=face, label=way)
                _arrow(new, x, y, colour)
            if (crossing := getattr(getattr(loop, "thresholds", None), name, None)) is not None:
                new.axvline(crossing.value, color=colour, linestyle=":", linewidth=0.8)
        if radius is not None and loop.parameter == "width":
            _newtonian_curve(new, radius)
        new.set(xlabel=_parameter(loop), ylabel=_RATIO)
        set_legend(new)
    return new


def _parameter(loop: Loop) -> str:
    """Words and symbol of what a loop goes along, in the units of its law of contact."""
    if loop.parameter == "width":
        return _WIDTH
    words, symbol, per = PARAMETERS[loop.parameter]
    return f"{words}, ${symbol}/[{unit_of(loop.law, per)}]$"


def _arrow(ax: Axes, x: Array, y: Array, colour: str) -> None:
    """The way of a branch, at the middle of its longest rise or fall."""
    if len(x) > 1:
        at = int(np.argmax(np.abs(np.diff(y))))
        middle = 0.5 * (x[at] + x[at + 1]), 0.5 * (y[at] + y[at + 1])
        ax.annotate("", xy=middle, xytext=(x[at], y[at]), arrowprops={"arrowstyle": "-|>", "color": colour, "linewidth": 0.8})


def survival(curve: Survival, ax: Axes | None = None, *, label: str | None = None, **line: Any) -> Axes:
    """Part of the runs without a transition, as a step function with its interval of 68 per cent.

    Parameters
    ----------
    curve : analysis.Survival
        The Kaplan-Meier estimate. Times are in the unit that it was given.
    ax : matplotlib.axes.Axes, optional
        Where to draw.
    label : str, optional
        Its name in the legend.
    **line
        Keywords of ``Axes.step``.

    Returns
    -------
    matplotlib.axes.Axes

    Examples
    --------
    >>> from peristalsis import analysis, plot
    >>> float(plot.survival(analysis.Survival([120.0, 340.0, 800.0], [True, True, False])).get_ylim()[0])
    0.0
    """
    of_kind("curve", curve, Survival, "a peristalsis.analysis.Survival")
    time = np.array([0.0, *(step.time for step in curve.steps), curve.watched])
    levels = [step.survival for step in curve.steps]
    value = np.array([1.0, *(level.value for level in levels)])
    lower = np.array([1.0, *(level.interval_68.lower for level in levels)])
    upper = np.array([1.0, *(level.interval_68.upper for level in levels)])
    with drawing(ax) as new:
        known = sum(drawn.get_gid() == _CURVE for drawn in new.lines)
        latest = max([time[-1], *(np.asarray(drawn.get_xdata())[-1] for drawn in new.lines if drawn.get_gid() == _CURVE)])
        (drawn,) = new.step(time, np.append(value, value[-1]), where="post", label=label, gid=_CURVE, **_dashes(known, line))
        bounds = np.append(lower, lower[-1]), np.append(upper, upper[-1])
        new.fill_between(time, *bounds, step="post", color=drawn.get_color(), alpha=0.25, linewidth=0)
        new.set(xlabel="time, $t$", ylabel="runs without a transition, $S(t)$", ylim=(0.0, 1.05))
        # A last step down is inside of the frame.
        new.set_xlim(0.0, 1.03 * latest)
        if label is not None:
            set_legend(new)
    return new


def collapse(
    what: Collapse,
    parameters: CollapseResult | Sequence[float],
    ax: Axes | None = None,
    *,
    names: Iterable[str] | None = None,
) -> Axes:
    """The scaled curves, one colour and mark each, with the quality of the collapse in the title.

    Parameters
    ----------
    what : analysis.Collapse
        The curves and their scaling.
    parameters : CollapseResult or sequence of float
        A result of ``what.fit``, or parameters of the scaling.
    ax : matplotlib.axes.Axes, optional
        Where to draw.
    names : iterable of str, optional
        Names of the curves; by default their sizes.

    Returns
    -------
    matplotlib.axes.Axes

    Examples
    --------
    >>> import numpy as np
    >>> from peristalsis import analysis, plot
    >>> x = np.linspace(-0.5, 0.5, 21)
    >>> curves = [(size, x, size**-0.5 / (1 + np.exp(x * size)), np.full(21, 0.003)) for size in (4.0, 8.0)]
    >>> len(plot.collapse(analysis.Collapse(curves, "finite_size"), [0.5, 1.0, 0.0]).containers)
    2
    """
    of_kind("what", what, Collapse, "a peristalsis.analysis.Collapse")
    chosen = parameters.parameters if isinstance(parameters, CollapseResult) else parameters
    labels = list(names) if names is not None else [f"{curve[0]:g}" for curve in what.curves]
    if len(labels) != len(what.curves):
        raise ValueError(f"names has {len(labels)} names for {len(what.curves)} curves")
    quality = what.quality(chosen)
    with drawing(ax) as new:
        for place, ((_, x, y, error), label) in enumerate(zip(what.scaled(chosen), labels, strict=True)):
            colour = COLOURS[place % len(COLOURS)]
            new.errorbar(x, y, yerr=error, fmt=_mark(place), color=colour, label=label)
        new.set_title(f"$S$ = {quality.quality:.2f}, overlap {quality.overlap:.0%}")
        new.set(xlabel="scaled abscissa", ylabel="scaled ordinate")
        set_legend(new)
    return new
