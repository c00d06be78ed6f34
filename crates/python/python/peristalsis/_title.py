"""The parameters of a run as the titles of the command line's figures have them, and the units of its law of contact."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from ._simulation import Simulation

#: Units of tables by what they are made of: for linear contacts (m, d, k) and for Hertz contacts (m*, d*, Y).
_UNITS = {
    "linear": {
        "t": "(m/k)^{1/2}",
        "1/t": "(k/m)^{1/2}",
        "d/t": r"d\,(k/m)^{1/2}",
        "d/t^2": "kd/m",
        "m d/t^2": "kd",
        "m d^2/t^2": "kd^2",
        "m/t^2": "k",
        "m/t^3": "k^{3/2}/m^{1/2}",
        "m/(d t^2)": "k/d",
    },
    "hertz": {
        "t": r"t^{\ast}",
        "1/t": r"t^{\ast-1}",
        "d/t": r"d/t^{\ast}",
        "d/t^2": r"d/t^{\ast2}",
        "m d/t^2": "Yd^2",
        "m d^2/t^2": "Yd^3",
        "m/t^2": "Yd",
        "m/t^3": r"Yd/t^{\ast}",
        "m/(d t^2)": "Y",
    },
}
#: What stands between two settings.
SEPARATOR = ",  "


def unit(simulation: Simulation, name: str) -> str:
    """A unit of a table in symbols of the law of contact, as mathematical text without its dollars; others as they are."""
    return _UNITS[simulation.configuration["contact.law"]].get(name, name.replace(" ", r"\,"))


def is_prescribed(simulation: Simulation) -> bool:
    """Whether the wall moves as prescribed; otherwise it is elastic."""
    return bool(simulation.configuration["drive.control"] == "strain")


def title(simulation: Simulation) -> str:
    """The parameters of a run: the drive, the density, the grains, and the settings that few runs have."""
    configuration = simulation.configuration
    tube = configuration["tube"]
    parts = []
    if is_prescribed(simulation):
        parts += [f"$w$ = {_driven(simulation, 'width')} $d$"]
        density = rf"$\rho$ = {configuration.volume_fraction:.3f}"
    else:
        amplitude = _driven(simulation, "force_amplitude")
        parts += [rf"$f^{{\mathrm{{P}}}}$ = {amplitude} ${unit(simulation, 'm d/t^2')}$"]
        spheres = configuration.grains * configuration["grains.diameter_max"] ** 3
        density = f"$n$ = {spheres / (math.pi * tube['radius'] ** 2 * configuration.length):.3f} $d^{{-3}}$"
    parts += [rf"$\dot{{\varepsilon}}$ = {_driven(simulation, 'strain_rate')} ${unit(simulation, '1/t')}$"]
    # Not all grains are in an open tube.
    if tube.get("ends") != "open" or not is_prescribed(simulation):
        parts += [density]
    waits = configuration.get("inlet.waiting", 0) > 0
    parts += [f"$N$ = {configuration.grains}{' with those that wait' if waits else ''}", *_particular(simulation)]
    return SEPARATOR.join(parts)


def _particular(simulation: Simulation) -> list[str]:
    """The settings that few runs have."""
    configuration = simulation.configuration
    usual = [
        ("wave", "drive.waveform", "sine"),
        ("direction", "drive.direction", "forward"),
        ("start", "initial.state", "rest"),
        ("wall", "tube.arrangement", "staggered"),
    ]
    found = [(name, configuration.get(key, value), value) for name, key, value in usual]
    parts = [f"{name}: {value}" for name, value, expected in found if value != expected]
    friction = configuration.get("contact.static_friction", 0.0)
    if friction != (0.0 if is_prescribed(simulation) else 0.5):
        parts += [rf"$\mu_{{\mathrm{{s}}}}$ = {short(friction)}"]
    x, y, z = configuration.get("body.gravity", (0.0, 0.0, 0.0))
    push = configuration.get("drive.body_force", 0.0)
    if any((x, y, z, push)):
        along = push + simulation.heading * z
        # Along the wave if it has no other part, else the vector whose z component it is.
        force = short(along) if x == y == 0.0 else f"({', '.join(map(short, (x, y, simulation.heading * along)))})"
        parts += [f"$g$ = {force} ${unit(simulation, 'd/t^2')}$"]
    return parts


def _driven(simulation: Simulation, name: str) -> str:
    """A parameter of the drive: its value, or the first and the last until now, or the least and the largest beyond these."""
    drive = simulation.configuration["drive"]
    schedules = [] if isinstance(drive["schedule"], str) else drive["schedule"]
    course = next((schedule for schedule in schedules if schedule["parameter"] == name), None)
    if course is None:
        return short(drive[name])
    now = simulation.time * drive["strain_rate"]
    if course["form"] == "ramp":
        knots = [(course["start"], course["from"]), (course["end"], course["to"])]
        first = course["from"]
    else:
        knots = list(zip(course["at"], course["values"], strict=True))
        is_course = course["form"] == "course"
        first = knots[0][1] if is_course or knots[0][0] <= 0.0 else drive[name]
    last = getattr(simulation, name)
    values = [first, *(value for time, value in knots if 0.0 < time < now), last]
    if {first, last} != {min(values), max(values)}:
        first, last = min(values), max(values)
    return short(first) if first == last else f"{short(first)} to {short(last)}"


def short(value: float) -> str:
    """A number as it was given, with up to six digits; what SI has made of one, with three."""
    digits = 6 if float(f"{value:.5e}") == value else 3
    text = np.format_float_positional(float(f"{value:.{digits - 1}e}"), trim="-")
    return ("0" if value == 0.0 else text).replace("-", "\u2212")
