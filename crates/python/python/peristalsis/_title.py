"""The parameters of a run as the titles of the command line's figures have them, and the units of its law of contact."""

from __future__ import annotations

from typing import TYPE_CHECKING

from . import _core

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
    return unit_of(simulation.configuration["contact.law"], name)


def unit_of(law: str, name: str) -> str:
    """The same by the name of the law."""
    return _UNITS[law].get(name, name.replace(" ", r"\,"))


def is_prescribed(simulation: Simulation) -> bool:
    """Whether the wall moves as prescribed; otherwise it is elastic."""
    return bool(simulation.configuration["drive.control"] == "strain")


def title(simulation: Simulation) -> str:
    """The parameters of a run: the drive, the density, the grains, and the settings that few runs have."""
    return _core.title(simulation._run)
