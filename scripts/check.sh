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

if command -v python3 >/dev/null; then
    step "instructions of the kernels"
    python3 scripts/instruction_counts.py
else
    step "skipped: instructions of the kernels (there is no python3)"
fi

step "documentation"
RUSTDOCFLAGS="-D warnings" cargo doc --workspace --no-deps --locked

step "the run that the README begins with"
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
# As the tests have built it: `cargo run` would build it again, with the features of one crate.
program=target/debug/peristalsis
"$program" run --preset frictionless --out "$scratch/run" --csv
ls "$scratch/run"

if command -v python3 >/dev/null; then
    step "the README's commands, their output and their picture"
    python3 scripts/run_snippets.py --only sh --programs target/debug README.md
else
    step "skipped: the README's commands (there is no python3)"
fi

if command -v python3 >/dev/null; then
    step "notices of what is shipped from others"
    python3 scripts/third_party.py --check
fi

if python3 -m venv "$scratch/venv" >"$scratch/venv.log" 2>&1; then
    step "spelling"
    "$scratch/venv/bin/pip" install --quiet --no-cache-dir 'typos>=1.52,<2'
    "$scratch/venv/bin/typos"

    step "tables, as pyarrow reads them"
    "$program" run --quiet --preset frictional --set grains.number=100 --set run.periods=0.2 \
        --out "$scratch/elastic" --csv
    "$program" run --quiet --preset frictionless --set drive.strain_rate=0 --set run.duration=20 \
        --out "$scratch/static" --csv
    "$scratch/venv/bin/pip" install --quiet --no-cache-dir numpy pyarrow
    "$scratch/venv/bin/python" tests/python/read_tables.py "$scratch/run" "$scratch/elastic" "$scratch/static"

    step "the Python package's page, its output"
    # With the tests named too, features are those of the tests above: only the Python module is new.
    cargo build --workspace --locked --lib --tests
    cp -rL crates/python/python "$scratch/python"
    cp target/debug/lib_core.so "$scratch/python/peristalsis/_core.abi3.so"
    PYTHONPATH=$scratch/python "$scratch/venv/bin/python" scripts/run_snippets.py --only python README.md crates/python/README.md
else
    step "skipped: spelling, tables, as pyarrow reads them, and the Python package's page (python3 makes no virtual environment here)"
fi

step "all checks passed"
