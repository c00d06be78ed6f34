"""Start files for LAMMPS: a lattice of wall spheres, and grains anywhere inside it."""

from __future__ import annotations

import math
import random
from dataclasses import dataclass
from pathlib import Path

GRAIN, WALL = 1, 2
# LAMMPS takes densities: a sphere of diameter 1 and mass 1.
UNIT_DENSITY = 6 / math.pi
# The box is not periodic across the tube; nothing gets this far from its axis.
HALF_BOX = 10.0


@dataclass(frozen=True)
class Lattice:
    """Staggered rings of wall spheres, as the program places them."""

    radius: float
    wavelength: float
    waves: int
    spheres_per_ring: int
    rings_per_wave: int

    @property
    def rings(self) -> int:
        return self.waves * self.rings_per_wave

    @property
    def length(self) -> float:
        return self.waves * self.wavelength

    @property
    def spacing(self) -> float:
        return self.wavelength / self.rings_per_wave

    def places(self) -> list[tuple[float, float, float]]:
        """Sphere i of ring k stands at the angle (2 i + k mod 2) pi/M, at z = k s."""
        places = []
        for ring in range(self.rings):
            for sphere in range(self.spheres_per_ring):
                angle = (2 * sphere + ring % 2) * math.pi / self.spheres_per_ring
                places.append((self.radius * math.cos(angle), self.radius * math.sin(angle), ring * self.spacing))
        return places

    def neighbours(self) -> tuple[list[tuple[int, int]], list[tuple[int, int]]]:
        """Pairs of numbers of spheres next to each other: on a ring, and from a ring to the next."""

        def number(ring: int, sphere: int) -> int:
            return ring % self.rings * self.spheres_per_ring + sphere % self.spheres_per_ring

        along, across = [], []
        for ring in range(self.rings):
            for sphere in range(self.spheres_per_ring):
                here = number(ring, sphere)
                along.append((here, number(ring, sphere + 1)))
                # The next ring is turned by half a spacing: forward from an even ring, backward from an odd one.
                ahead = sphere + ring % 2
                across.append((here, number(ring + 1, ahead)))
                across.append((here, number(ring + 1, ahead - 1)))
        return along, across


def write_strain_start(path: Path, lattice: Lattice, grains: int, seed: int) -> None:
    """A straight tube of wall spheres with grains of diameter 1 at random inside: they overlap."""
    with path.open("w", encoding="utf-8") as file:
        _write_head(file, lattice, len(lattice.places()) + grains, "2 atom types\n")
        file.write("Atoms # sphere\n\n")
        for number, place in enumerate(lattice.places(), 1):
            file.write(f"{number} {WALL} 1 {UNIT_DENSITY!r} {_words(place)}\n")
        for number, place in enumerate(
            _random_places(lattice, grains, lattice.radius - 0.85, random.Random(seed)), lattice_size(lattice) + 1
        ):
            file.write(f"{number} {GRAIN} 1 {UNIT_DENSITY!r} {_words(place)}\n")


def write_stress_start(path: Path, lattice: Lattice, grains: int, sphere_mass: float, seed: int) -> None:
    """A straight tube of bonded wall spheres with grains of diameters from 0.8 to 1 at random inside: they overlap."""
    along, across = lattice.neighbours()
    bonds = [(1, pair) for pair in along] + [(2, pair) for pair in across]
    generator = random.Random(seed)
    with path.open("w", encoding="utf-8") as file:
        _write_head(
            file,
            lattice,
            lattice_size(lattice) + grains,
            f"2 atom types\n{len(bonds)} bonds\n2 bond types\n6 extra bond per atom\n18 extra special per atom\n",
        )
        file.write("Atoms # hybrid\n\n")
        for number, place in enumerate(lattice.places(), 1):
            file.write(f"{number} {WALL} {_words(place)} 1 {sphere_mass * UNIT_DENSITY!r} 1\n")
        places = _random_places(lattice, grains, lattice.radius - 0.95, generator)
        for number, place in enumerate(places, lattice_size(lattice) + 1):
            diameter = generator.uniform(0.8, 1.0)
            file.write(f"{number} {GRAIN} {_words(place)} {diameter!r} {UNIT_DENSITY!r} 0\n")
        file.write("\nBonds\n\n")
        for number, (kind, (one, other)) in enumerate(bonds, 1):
            file.write(f"{number} {kind} {one + 1} {other + 1}\n")


def repeat_along_axis(source: Path, target: Path, copies: int, seed: int) -> None:
    """Copies of a tube one behind the other, velocities scattered by a hundredth so that the copies part."""
    generator = random.Random(seed)
    sections = _sections(source)
    low, high = next(
        (float(line.split()[0]), float(line.split()[1])) for line in sections[""] if line.endswith("zlo zhi")
    )
    atoms = [line.split() for line in sections["Atoms"]]
    velocities = {line.split()[0]: line.split()[1:4] for line in sections["Velocities"]}
    with target.open("w", encoding="utf-8") as file:
        file.write("copies of a tube\n\n")
        file.write(f"{copies * len(atoms)} atoms\n2 atom types\n\n")
        file.write(f"{-HALF_BOX} {HALF_BOX} xlo xhi\n{-HALF_BOX} {HALF_BOX} ylo yhi\n")
        file.write(f"{low} {low + copies * (high - low)!r} zlo zhi\n\nAtoms # sphere\n\n")
        for copy in range(copies):
            for number, (_, kind, diameter, density, x, y, z, *_) in enumerate(atoms, copy * len(atoms) + 1):
                file.write(f"{number} {kind} {diameter} {density} {x} {y} {float(z) + copy * (high - low)!r}\n")
        file.write("\nVelocities\n\n")
        for copy in range(copies):
            for number, atom in enumerate(atoms, copy * len(atoms) + 1):
                scattered = (float(component) * generator.gauss(1, 0.01) for component in velocities[atom[0]])
                file.write(f"{number} {_words(scattered)} 0 0 0\n")


def lattice_size(lattice: Lattice) -> int:
    """Number of wall spheres."""
    return lattice.rings * lattice.spheres_per_ring


def _random_places(lattice: Lattice, number: int, radius: float, generator: random.Random):
    for _ in range(number):
        distance = radius * math.sqrt(generator.random())
        angle = 2 * math.pi * generator.random()
        yield distance * math.cos(angle), distance * math.sin(angle), lattice.length * generator.random()


def _write_head(file, lattice: Lattice, atoms: int, counts: str) -> None:
    file.write(f"{lattice.waves} waves\n\n{atoms} atoms\n{counts}\n")
    file.write(f"{-HALF_BOX} {HALF_BOX} xlo xhi\n{-HALF_BOX} {HALF_BOX} ylo yhi\n0 {lattice.length!r} zlo zhi\n\n")


def _words(numbers) -> str:
    return " ".join(repr(number) for number in numbers)


def _sections(path: Path) -> dict[str, list[str]]:
    """The lines of a data file by section; the head is that without a name."""
    names = ("Atoms", "Velocities", "Masses", "Bonds", "place")
    sections: dict[str, list[str]] = {"": []}
    name = ""
    for line in path.read_text(encoding="utf-8").splitlines()[1:]:
        text = line.split("#")[0].strip()
        if text in names:
            name = text
            sections[name] = []
        elif text:
            sections[name].append(text)
    return sections
