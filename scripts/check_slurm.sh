#!/usr/bin/env bash
# `peristalsis study submit --slurm` against a real Slurm on this machine's loopback: munged, slurmctld and slurmd of
# Debian (packages slurmctld, slurmd, slurm-client, munge), started here with a configuration of their own and ended
# again. Needs root. Two array tasks share one store; one of them is cancelled and submitted again.
set -euo pipefail
cd "$(dirname "$0")/.."

missing=$(for tool in slurmctld slurmd sbatch munged; do PATH=$PATH:/usr/sbin command -v "$tool" >/dev/null || echo "$tool"; done)
if [ -n "$missing" ] || [ "$(id -u)" != 0 ]; then
    echo "skipped: this check needs root and" ${missing:-nothing else}
    exit 0
fi
export PATH=$PATH:/usr/sbin
cargo build --locked --package peristalsis
program=$PWD/target/debug/peristalsis

scratch=$(mktemp -d)
chmod 755 "$scratch"
host=$(hostname -s)
processes=()
finish() {
    for process in "${processes[@]}"; do kill "$process" 2>/dev/null || true; done
    wait 2>/dev/null || true
    rm -rf "$scratch"
}
trap finish EXIT

install -d -m 700 "$scratch/munge"
dd if=/dev/urandom of="$scratch/munge/key" bs=1024 count=1 status=none
chmod 400 "$scratch/munge/key"
munged --foreground --force --key-file="$scratch/munge/key" --socket="$scratch/munge.socket" \
    --pid-file="$scratch/munge/pid" --log-file="$scratch/munge/log" --seed-file="$scratch/munge/seed" &
processes+=($!)

mkdir "$scratch/state" "$scratch/spool"
processors=$(nproc)
cat > "$scratch/slurm.conf" <<END
ClusterName=loopback
SlurmctldHost=$host(127.0.0.1)
SlurmUser=root
SlurmctldPort=26817
SlurmdPort=26818
AuthType=auth/munge
AuthInfo=socket=$scratch/munge.socket
StateSaveLocation=$scratch/state
SlurmdSpoolDir=$scratch/spool
SlurmctldPidFile=$scratch/slurmctld.pid
SlurmdPidFile=$scratch/slurmd.pid
SlurmctldLogFile=$scratch/slurmctld.log
SlurmdLogFile=$scratch/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
ReturnToService=2
MpiDefault=none
NodeName=$host NodeAddr=127.0.0.1 CPUs=$processors State=UNKNOWN
PartitionName=all Nodes=$host Default=YES MaxTime=INFINITE State=UP
END
export SLURM_CONF=$scratch/slurm.conf
slurmctld -D & processes+=($!)
slurmd -D & processes+=($!)
for _ in $(seq 100); do
    sinfo --noheader --format=%t 2>/dev/null | grep -q idle && break
    sleep 0.2
done
sinfo

cd "$scratch"
cat > study.toml <<END
name = "array"
title = "An array of tasks on one store"
preset = "frictionless"
replicates = 4

[base]
tube.waves = 2
run.periods = 20

[[axes]]
key = "drive.width"
values = [2.5, 2.9]
END
sed 's/run.periods = 20/run.periods = 100000/' study.toml | sed 's/"array"/"endless"/' > endless.toml

wait_for() { # until squeue knows no more of the job
    for _ in $(seq 600); do
        [ -z "$(squeue --noheader --job "$1" 2>/dev/null)" ] && return
        sleep 0.5
    done
    echo "job $1 does not end"; cat ./*.log; exit 1
}

"$program" study submit study.toml --slurm --tasks 2 --time 10m
sbatch --test-only array.sbatch
job=$(sbatch --parsable array.sbatch)
wait_for "$job"
cat array-*.log
"$program" study status stores/array | tee status.txt
grep -q "8 done" status.txt
# Each run by one task, the same bits as at home.
"$program" study run study.toml --store home --quiet >/dev/null
for store in stores/array home; do "$program" study export "$store" --out "tables-$(basename "$store")" >/dev/null; done
cmp tables-array/array.csv tables-home/array.csv

"$program" study submit endless.toml --slurm --tasks 2 --time 10m
job=$(sbatch --parsable endless.sbatch)
for _ in $(seq 300); do
    [ "$(squeue --noheader --states=running --job "$job" | wc -l)" -ge 1 ] && [ -s "endless-$job-1.log" ] && break
    sleep 0.2
done
sleep 2
scancel --batch --signal=USR1 "$job"
wait_for "$job"
cat endless-*.log
"$program" study status stores/endless | tee status.txt
grep -q "checkpointed" status.txt && ! grep -q "leased" status.txt
echo "Slurm's tasks share a store, and a signal of Slurm's loses nothing"
