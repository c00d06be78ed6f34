#!/usr/bin/env bash
# What CI checks, and what a person runs before a commit: `just check`.
set -euo pipefail
cd "$(dirname "$0")/.."

step() { printf '\n== %s\n' "$*"; }

step "formatting"
cargo fmt --all -- --check

step "clippy"
cargo clippy --workspace --all-targets --locked -- -D warnings

step "tests (the README's command)"
cargo test --workspace --locked

step "documentation"
RUSTDOCFLAGS="-D warnings" cargo doc --workspace --no-deps --locked

step "a run, as the README starts it"
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cargo run --locked -- run --preset frictionless --out "$scratch/run" --csv
ls "$scratch/run"

if python3 -c 'import venv' 2>/dev/null; then
    step "tables, as pyarrow reads them"
    python3 -m venv "$scratch/venv"
    "$scratch/venv/bin/pip" install --quiet pyarrow
    "$scratch/venv/bin/python" tests/python/read_tables.py "$scratch/run"
fi

step "all checks passed"
