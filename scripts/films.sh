#!/usr/bin/env bash
# The films of the book (docs/images/*.gif), from runs of a few seconds.
set -euo pipefail
cd "$(dirname "$0")/.."

cargo build --locked --release --package peristalsis
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
peristalsis() { target/release/peristalsis "$@" --quiet; }

# The tube on which most claims of the source hold.
peristalsis run --preset frictionless-source --set drive.width=2.4 --set tube.waves=4 \
    --set run.periods=16 --trajectory gsd --trajectory-every 0.1 --out "$scratch/jamming"
peristalsis render "$scratch/jamming" --film --width 440 --window 0:6 --fps 15 --out docs/images/jamming.gif

peristalsis run --preset frictional --set run.periods=14 \
    --trajectory gsd --trajectory-every 0.05 --trajectory-window 12:14 --out "$scratch/back-flow"
peristalsis render "$scratch/back-flow" --film --width 420 --window 12:13.96 --fps 15 --out docs/images/back-flow.gif
