"""A simulation from the side, as a Matplotlib picture."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal

import numpy as np
import numpy.typing as npt

from ._arrays import Array
from ._given import of_kind, whole
from ._simulation import Simulation
from ._fit import set_title
from ._style import DOUBLE_COLUMN, GREY, drawing
from ._title import SEPARATOR, is_prescribed, title, unit

from matplotlib.cm import ScalarMappable
from matplotlib.collections import EllipseCollection
from matplotlib.colors import LinearSegmentedColormap, Normalize
from matplotlib.layout_engine import ConstrainedLayoutEngine

if TYPE_CHECKING:
    from matplotlib.axes import Axes

#: Blue against the wave, white at rest, red along it (after ColorBrewer's RdBu), as in the figures of the command line.
DIVERGING = LinearSegmentedColormap.from_list(
    "peristalsis", ["#0c4282", "#2870b2", "#62a4cf", "#acd2e5", "#fafafa", "#fbcdb4", "#ec8e70", "#cc4042", "#860824"], 49
)
#: A sphere lit from the upper left: parts of its diameter, and how far the colour is moved towards white or black there.
_SHADES = ((1.0, -0.22), (0.9, -0.1), (0.74, 0.0), (0.5, 0.17), (0.3, 0.33), (0.14, 0.5))
#: How far from the axis a snapshot shows grains, in radii of the tube.
_REACH = 2.5
#: Height of the label and the numbers of an axis, in points.
_BELOW_AXIS = 36.0


def snapshot(simulation: Simulation, ax: Axes | None = None, *, waves: int = 4, first: int = 0) -> Axes:
    """Grains from the side, the wave to the right, coloured by axial velocity along it in units of its speed.

    A grain that has left the tube (its centre beyond R + d/2) has an orange rim; a line above the picture counts all of
    them, those too far away for the picture too.

    Parameters
    ----------
    simulation : Simulation
        The simulation as it stands.
    ax : matplotlib.axes.Axes, optional
        Where to draw.
    waves : int
        Wavelengths shown, at most.
    first : int
        The wavelength with which the picture begins, counted from 0: with it a long tube is drawn in several rows.

    Returns
    -------
    matplotlib.axes.Axes

    Examples
    --------
    >>> from peristalsis import Simulation, plot
    >>> sim = Simulation.preset("frictionless", seed=1)
    >>> plot.snapshot(sim, waves=2).get_xlim() == (0.0, 20.0)
    True
    """
    of_kind("simulation", simulation, Simulation, "a peristalsis.Simulation")
    all_waves = simulation.configuration.waves
    waves, first = whole("waves", waves, 1), whole("first", first, 0, all_waves - 1)
    length, heading = simulation.configuration.length, simulation.heading
    wavelength = length / all_waves
    begin, end = first * wavelength, min(first + waves, all_waves) * wavelength

    def along(z: Array) -> Array:
        return z if heading > 0 else length - z

    grains, diameters, wall = simulation.positions, simulation.diameters, simulation.wall_positions
    from_axis = np.hypot(grains[:, 0], grains[:, 1])
    radii, sphere = simulation.wall_radius(), simulation.configuration["wall.sphere_diameter"]
    # An open tube has no images beyond its ends.
    is_open = simulation.configuration["tube"].get("ends") == "open"
    repeats = np.inf if is_open else length
    escaped = from_axis > simulation.wall_radius(grains[:, 2]) + 0.5 * diameters
    reach = 1.06 * (radii.max() + (0.0 if is_prescribed(simulation) else 0.5 * sphere))
    shown = from_axis < _REACH * radii.mean()
    if (escaped & shown).any():
        reach = max(reach, float((np.abs(grains[:, 1]) + 0.6 * diameters)[escaped & shown].max()))
    velocity = heading * simulation.velocities[:, 2]
    # Where the wave stands still, the fastest grain that is shown takes its place.
    speed = simulation.strain_rate * wavelength
    fastest = float(f"{np.abs(velocity[shown]).max(initial=0.0):.1e}")
    velocity = velocity / (speed or fastest or 1.0)
    with drawing(ax, DOUBLE_COLUMN, 165.0 * 2 * reach / (end - begin) + 30.0) as new:
        if is_prescribed(simulation):
            place = np.linspace(begin, end, 400)
            outline = simulation.wall_radius(along(place))
            # The surface of the wall lies half a wall sphere inside of its radius.
            surface = np.maximum(outline - 0.5 * sphere, 0.0)
            for side in (1.0, -1.0):
                new.fill_between(place, side * surface, side * outline, color=GREY, alpha=0.22, linewidth=0.0)
                new.plot(place, side * outline, color=GREY, linewidth=1.0)
        else:
            # Half a diameter would leave gaps where the wall is stretched.
            cut = wall[np.abs(wall[:, 0]) < 0.75 * sphere]
            _discs(new, along(cut[:, 2]), cut[:, 1], np.full(len(cut), sphere), repeats, facecolors="#80808028", edgecolors="#80808080")
        order = np.flatnonzero(shown)
        order = order[np.argsort(grains[order, 0])]
        _spheres(new, along(grains[order, 2]), grains[order, 1], diameters[order], velocity[order], escaped[order], repeats)
        if is_open and begin <= simulation.length <= end:
            new.axvline(simulation.length, color="black", linestyle=":", linewidth=1.0)
            new.annotate("outlet", (simulation.length, reach), (-2, -3), textcoords="offset points", rotation=90, ha="right", va="top")
        part = "" if end - begin >= length * (1 - 1e-9) else f"  ({min(waves, all_waves - first)} of {all_waves} waves shown)"
        name = "$z/d$" if heading > 0 else "$(L - z)/d$"
        new.set(xlabel=name + part, ylabel="$y/d$", aspect="equal", xlim=(begin, end), ylim=(-reach, reach))
        clock = simulation.time * simulation.configuration["drive"]["strain_rate"]
        now = f"$t/T$ = {clock:.2f}" if speed else f"$t$ = {simulation.time:.1f} ${unit(simulation, 't')}$"
        lost = f",  {simulation.escaped} of {len(grains)} grains escaped" if simulation.escaped else ""
        if ax is None:
            set_title(new, f"{title(simulation)},  {now}{lost}", SEPARATOR)
        elif lost:
            new.set_title(lost.lstrip(", "))
        unit_of_speed = f"({fastest:g} $d/{unit(simulation, 't')}$)"
        label = "axial velocity along the wave, $v_z/c$" if speed else f"axial velocity along the tube, $v_z$/{unit_of_speed}"
        scale = ScalarMappable(Normalize(-1.0, 1.0), DIVERGING)
        within = {-1: velocity.min(initial=0.0) >= -1, 1: velocity.max(initial=0.0) <= 1}
        extend: Literal["neither", "min", "max", "both"] = (
            "neither" if all(within.values()) else "max" if within[-1] else "min" if within[1] else "both"
        )
        # Below the label of the axis, however low the axes are; a constrained layout makes room for the label itself.
        engine = new.figure.get_layout_engine()
        if isinstance(engine, ConstrainedLayoutEngine):
            pad = engine.get()["h_pad"]
        else:
            height = new.get_window_extent().height * 72 / new.figure.dpi
            pad = min(0.5, max(0.15, _BELOW_AXIS / height))
        new.figure.colorbar(
            scale, ax=new, label=label, location="bottom", shrink=0.3, aspect=25, extend=extend, pad=pad
        )
    return new


def _discs(ax: Axes, x: Array, y: Array, diameter: Array, length: float, **look: Any) -> None:
    """Discs in units of the axes, with their images beyond the ends of the tube."""
    for shift in (0.0, length, -length):
        ends = (x + shift > -2.0) & (x + shift < length + 2.0)
        kept = {key: value[ends] if isinstance(value, np.ndarray) else value for key, value in look.items()}
        if ends.any():
            ax.add_collection(
                EllipseCollection(
                    diameter[ends], diameter[ends], np.zeros(ends.sum()), units="xy", offsets=np.column_stack([x + shift, y])[ends],
                    offset_transform=ax.transData, linewidths=kept.pop("linewidths", 0.35), **kept,
                )
            )  # fmt: skip


def _spheres(ax: Axes, x: Array, y: Array, diameter: Array, velocity: Array, escaped: npt.NDArray[np.bool_], length: float) -> None:
    """Spheres that are lit from the upper left, each as a few discs, the farthest first."""
    base = DIVERGING(Normalize(-1.0, 1.0, clip=True)(velocity))
    parts: list[list[Array]] = [[], [], [], [], []]
    for number, (part, tone) in enumerate(_SHADES):
        face = base.copy()
        face[:, :3] += max(tone, 0.0) * (1.0 - face[:, :3]) + min(tone, 0.0) * face[:, :3]
        edge = np.where(escaped[:, None], [0.90, 0.62, 0.0, 1.0], [0.1, 0.1, 0.1, 1.0]) if number == 0 else face
        weight = np.where(escaped, 1.4, 0.3) if number == 0 else np.zeros(len(x))
        shift = 0.14 * (1.0 - part) * diameter
        for layers, layer in zip(parts, (x - shift, y + shift, part * diameter, face, np.column_stack([edge, weight])), strict=True):
            layers.append(layer)
    # Disc after disc of one sphere before the next sphere.
    together = [np.stack(layers, axis=1).reshape(len(x) * len(_SHADES), *layers[0].shape[1:]) for layers in parts]
    places_x, places_y, sizes, faces, edges = together
    _discs(ax, places_x, places_y, sizes, length, facecolors=faces, edgecolors=edges[:, :4], linewidths=edges[:, 4])
