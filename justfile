# What CI runs.
check:
    bash scripts/check.sh

# The README's test command.
test:
    cargo test --workspace

# The checks and the long validation runs (about half an hour on two cores).
full-check: check
    cargo test --workspace --release --tests -- --ignored
    cargo bench --workspace --no-run

# Speed of the kernels (see BENCHMARKS.md).
bench:
    cargo bench -p peristalsis-engine

# The same work for this program and for LAMMPS, in turn (see benchmarks/peers/README.md): --quick, --runs N, --cases NAME ...
bench-peers *options:
    cargo build --release -p peristalsis
    python3 benchmarks/peers/bench_peers.py {{options}}
