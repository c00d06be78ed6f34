# What CI runs.
check:
    bash scripts/check.sh

# The README's test command.
test:
    cargo test --workspace

# The checks, the long validation runs, the audit of unsafe code, the clients of trajectories and the Python package (about an hour
# on two cores).
full-check: check deny audit check-arm check-wasm check-windows clients check-viewer python slurm book check-memory
    cargo test --workspace --release --tests -- --ignored
    cargo bench --workspace --no-run

# Miri, AddressSanitizer and memcheck over the module with unsafe code, as far as this machine has them.
audit:
    bash scripts/audit_unsafe.sh

# The bits on record on 64-bit ARM (NEON), under qemu.
check-arm:
    bash scripts/check_arm.sh

# The bits on record as WebAssembly (SIMD128), in Node.js.
check-wasm:
    bash scripts/check_wasm.sh

# The program for Windows under wine, and what of macOS can be checked elsewhere.
check-windows:
    bash scripts/check_windows.sh

# A run of a million periods, a study of many runs, a viewer at its fastest and a loop of calls in Python, each in bounded
# memory (half an hour).
check-memory *options:
    cargo build --release -p peristalsis
    target/python/bin/python scripts/check_memory.py {{options}}

# Licences, duplicates and sources of every crate against deny.toml, where cargo-deny is installed.
deny:
    bash scripts/deny.sh

# The release program built twice in different folders: the same bytes, and no path of this machine in them (some minutes).
reproducible-build *profile:
    bash scripts/reproducible_build.sh {{profile}}

# Every fuzz target in turn for so many seconds, with cargo-fuzz and a nightly compiler (see fuzz/README.md).
fuzz seconds="600":
    bash scripts/fuzz.sh {{seconds}}

# Random configurations and damaged files given to the release program: no panic, no loss (see scripts/abuse.py).
abuse *options:
    cargo build --release -p peristalsis
    python3 scripts/abuse.py {{options}}

# Trajectories as gsd, PyVista and OVITO from PyPI read them.
clients:
    bash scripts/check_clients.sh

# The documentation book, its blocks executed; pages in target/book.
book:
    bash scripts/book.sh

# Studies as arrays of tasks of a real Slurm on loopback, where it is installed.
slurm:
    bash scripts/check_slurm.sh

# The viewer in Debian's headless Chromium; --pictures DIR leaves a picture of every state.
check-viewer *options:
    bash scripts/check_viewer.sh {{options}}

# The page as a widget in a real JupyterLab: just check-notebook PYTHON, which has jupyterlab and this package.
check-notebook python='python3':
    cd viewer && node check-notebook.mjs {{python}}

# The viewer's page made anew from viewer/ (TypeScript, three.js).
viewer-bundle:
    bash scripts/viewer_bundle.sh

# The Python package as a wheel, below target/wheels: for this machine, or `just wheel --zig --compatibility manylinux_2_17`
# for any Linux of the last ten years.
wheel *options:
    [ -x target/python/bin/python ] || python3 -m venv target/python
    target/python/bin/pip install --quiet 'maturin[zig]'
    rm -f target/wheels/peristalsis-*.whl
    target/python/bin/maturin build --release --locked --out target/wheels {{options}}

# Tests, types and wheel of the Python package, in environments below target/.
python:
    bash scripts/check_python.sh

# The page that computes the tube in the browser itself, target/web; needs the target wasm32-unknown-unknown.
web:
    bash scripts/web.sh

# The films of the book, docs/images/*.gif.
films:
    bash scripts/films.sh

# The fast kernels' instructions against those on record (see benchmarks/instructions/README.md); --record
count-instructions *options:
    python3 scripts/instruction_counts.py {{options}}

# Speed of the kernels (see BENCHMARKS.md).
bench:
    cargo bench -p peristalsis-engine

# Speed as WebAssembly against native on one core, in turn.
bench-wasm *options:
    python3 scripts/bench_wasm.py {{options}}

# The same work for this program and for LAMMPS, in turn (see benchmarks/peers/README.md): --quick, --runs N, --cases NAME ...
bench-peers *options:
    cargo build --release -p peristalsis
    python3 benchmarks/peers/bench_peers.py {{options}}

# The same physics in LAMMPS, from the same initial states (see validation/lammps/README.md): --quick, --only NAME ...,
# --fresh.
validate-peers *options:
    bash scripts/validate_peers.sh {{options}}

# Speed against cores, grains and width of the tube (--quick, --runs N, --only NAME ...).
bench-scaling *options:
    cargo build --release -p peristalsis
    python3 benchmarks/scaling/bench_scaling.py {{options}}

# Textbook experiments beside their analytic solutions, and other codes where they are installed, into docs/verification.md.
validate:
    cargo run --release -- validate --write docs/verification.md
    bash scripts/validate_peers.sh
