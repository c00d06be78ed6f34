# What CI runs.
check:
    bash scripts/check.sh

# The README's test command.
test:
    cargo test --workspace

# The checks, the long validation runs, the audit of unsafe code and the clients of trajectories (about three quarters of
# an hour on two cores).
full-check: check audit clients
    cargo test --workspace --release --tests -- --ignored
    cargo bench --workspace --no-run

# Miri, AddressSanitizer and memcheck over the module with unsafe code, as far as this machine has them.
audit:
    bash scripts/audit_unsafe.sh

# Trajectories as gsd, PyVista and OVITO from PyPI read them.
clients:
    bash scripts/check_clients.sh

# The films of the README, docs/images/*.gif.
films:
    bash scripts/films.sh

# The fast kernels' instructions against those on record (see benchmarks/instructions/README.md); --record
count-instructions *options:
    python3 scripts/instruction_counts.py {{options}}

# Speed of the kernels (see BENCHMARKS.md).
bench:
    cargo bench -p peristalsis-engine

# The same work for this program and for LAMMPS, in turn (see benchmarks/peers/README.md): --quick, --runs N, --cases NAME ...
bench-peers *options:
    cargo build --release -p peristalsis
    python3 benchmarks/peers/bench_peers.py {{options}}

# Speed against cores, grains and width of the tube (--quick, --runs N, --only NAME ...).
bench-scaling *options:
    cargo build --release -p peristalsis
    python3 benchmarks/scaling/bench_scaling.py {{options}}
