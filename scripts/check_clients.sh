#!/usr/bin/env bash
# Trajectories as the programs that they are meant for read them: gsd, PyVista and OVITO from PyPI, in an environment of
# their own below target/.
set -euo pipefail
cd "$(dirname "$0")/.."

clients=target/clients
[ -x "$clients/bin/python" ] || python3 -m venv "$clients"
"$clients/bin/pip" install --quiet --requirement tests/clients/requirements.txt

scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cargo build --locked --package peristalsis
write() {
    target/debug/peristalsis run --quiet --csv --trajectory gsd,vtp,lammps --out "$scratch/$1" "${@:2}" >/dev/null
}
write frictionless --preset frictionless --set tube.waves=2 --set run.periods=6
write frictional --preset frictional --set grains.number=300 --set run.periods=0.5 --trajectory-every 0.025
write prescribed --preset frictionless --set tube.waves=2 --set run.periods=2 --set contact.static_friction=0.5 \
    --set contact.kinetic_friction=0.4 --set grains.diameter_min=0.8 --set grains.diameter_max=1
"$clients/bin/python" tests/clients/read_trajectories.py "$scratch"/*
