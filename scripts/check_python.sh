#!/usr/bin/env bash
# The Python package: its tests, its types, and its wheel in an environment with nothing else, all below target/.
set -euo pipefail
cd "$(dirname "$0")/.."

step() { printf '\n== %s\n' "$*"; }

environment=$PWD/target/python
[ -x "$environment/bin/python" ] || python3 -m venv "$environment"
"$environment/bin/pip" install --quiet maturin --requirement crates/python/tests/requirements.txt

step "the wheel"
wheels=target/wheels
rm -f "$wheels"/peristalsis-*.whl
"$environment/bin/maturin" build --release --locked --out "$wheels"
wheel=$(ls "$wheels"/peristalsis-*.whl)
for notice in LICENSE-MIT LICENSE-APACHE THIRD-PARTY.txt; do
    python3 -m zipfile --list "$wheel" | grep "$notice" > /dev/null || { echo "the wheel lacks $notice"; exit 1; }
done
"$environment/bin/pip" install --quiet --force-reinstall --no-deps "$wheel"

step "the source"
"$environment/bin/maturin" sdist --out target/sdist
# What the program holds from outside of its crates.
for file in studies/quick.toml studies/length.toml THIRD-PARTY.txt; do
    tar -tzf target/sdist/peristalsis-*.tar.gz | grep "/$file$" > /dev/null || { echo "the source lacks $file"; exit 1; }
done

step "tests"
cargo build --locked --package peristalsis
PERISTALSIS_PROGRAM=$PWD/target/debug/peristalsis "$environment/bin/python" -m pytest crates/python
"$environment/bin/python" -m pytest -c crates/python/pytest.ini --doctest-modules --pyargs peristalsis

step "the same replicates through four pools"
for pool in futures joblib dask ray; do
    "$environment/bin/python" "examples/python/with_$pool.py" | grep "J/Jmax" | sed "s/^/$pool: /"
done | tee target/python-pools.txt
[ "$(cut -d: -f2- target/python-pools.txt | sort -u | wc -l)" -eq 1 ] || { echo "the pools disagree"; exit 1; }
[ "$(wc -l < target/python-pools.txt)" -eq 4 ] || { echo "a pool said nothing"; exit 1; }

step "the notebooks"
"$environment/bin/python" scripts/run_notebooks.py examples/notebooks/*.ipynb

step "types"
"$environment/bin/mypy"
# The types of the widget's libraries do not say of which metaclass it is.
"$environment/bin/stubtest" peristalsis --mypy-config-file pyproject.toml --allowlist <(echo 'peristalsis\._view\.Widget')
PATH="$environment/bin:$PATH" pyright --verifytypes peristalsis --ignoreexternal

step "the wheel in an environment of its own, with the snippets of its page and the book"
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
python3 -m venv "$scratch/venv"
"$scratch/venv/bin/pip" install --quiet "$wheel[plot]"
"$scratch/venv/bin/python" scripts/run_snippets.py --only python README.md crates/python/README.md docs/book/src/guides/collapse.md docs/book/src/guides/python.md

step "the Python package is well"
