#!/usr/bin/env python3
"""Compares our engine with LAMMPS, and writes what came out into VALIDATION.md."""

from __future__ import annotations

import argparse
import shutil
import sys
from pathlib import Path

import stationary
from own_tube import OwnTube
from store import Store

ROOT = Path(__file__).resolve().parents[2]


def main() -> None:
    folder = ROOT / "target" / "validation-lammps"
    own = OwnTube(folder / "placed_grains")
    store = Store(folder / "results")
    stationary.measure(stationary.POINTS, stationary.ROUNDS, own, store)


main()
