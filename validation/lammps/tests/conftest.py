"""The modules under test, and those of the benchmark that they use."""

import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
sys.path[:0] = [str(ROOT / "validation" / "lammps"), str(ROOT / "benchmarks" / "peers")]
