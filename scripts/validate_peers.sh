#!/usr/bin/env bash
# Our engine beside LAMMPS (see validation/lammps/README.md): --quick, --only NAME ..., --fresh. All below target/;
# what was computed before is not computed again.
set -euo pipefail
cd "$(dirname "$0")/.."

folder=target/validation-lammps
requirements=validation/lammps/requirements.txt
mkdir -p "$folder"
if ! cmp --silent "$requirements" "$folder/installed-requirements.txt"; then
    python3 -m venv --clear "$folder/venv"
    "$folder/venv/bin/pip" install --quiet --requirement "$requirements"
    cp "$requirements" "$folder/installed-requirements.txt"
fi

cargo build --release --locked --package peristalsis
cargo build --release --locked --package peristalsis-run --example placed_grains

# Start files and lattice are those of the benchmark.
PYTHONPATH=benchmarks/peers OMP_NUM_THREADS=1 exec "$folder/venv/bin/python" validation/lammps/validate_peers.py "$@"
