#!/usr/bin/env bash
# Trajectories and stores of studies as the programs that they are meant for read them: gsd, PyVista, OVITO and signac from
# PyPI, in an environment of their own below target/; row, where it is installed.
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

cat > "$scratch/study.toml" <<'END'
name = "clients"
preset = "frictionless"
replicates = 2
[base.run]
periods = 1
[base.tube]
waves = 2
[[axes]]
key = "drive.width"
values = [2.6, 2.8, 2.9]
END
target/debug/peristalsis study run --quiet "$scratch/study.toml" --store "$scratch/store" >/dev/null
target/debug/peristalsis study export "$scratch/store" --out "$scratch/export" >/dev/null
mkdir "$scratch/signac"
"$clients/bin/python" tests/clients/read_store.py "$scratch/store" "$scratch/export/clients.csv" "$scratch/signac"

if command -v row >/dev/null; then
    cat > "$scratch/workflow.toml" <<'END'
[workspace]
path = "store/runs"
value_file = "signac_statepoint.json"
[[action]]
name = "look"
command = "ls {directory}"
[[action.group.include]]
condition = ["/drive/width", "<", 2.7]
END
    narrow=$(cd "$scratch" && row show directories --action look --no-header --value /drive/width | grep -c .)
    [ "$narrow" -eq 2 ] || { echo "row sees $narrow of the two runs at w = 2.6"; exit 1; }
    echo "row: 2 directories below w = 2.7"
else
    echo "row is not installed here: not tried"
fi
