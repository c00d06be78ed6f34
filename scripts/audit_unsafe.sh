#!/usr/bin/env bash
# Looks for undefined behaviour in the one module with unsafe code, crates/engine/src/fast/machine, with what this
# machine has: Miri and AddressSanitizer (a nightly toolchain), memcheck (valgrind). Says at the end what was not run.
#
# Miri interprets the plain and the AVX2 operations; of AVX-512 it knows too little. AddressSanitizer runs all tests of
# the engine on the widest instructions of this machine. Memcheck also sees what is read before it is written.
set -euo pipefail
cd "$(dirname "$0")/.."

# Apart from ordinary builds, which would be thrown away.
export CARGO_TARGET_DIR="${CARGO_TARGET_DIR:-target}/audit"
module=crates/engine/src/fast/machine
tests=fast::machine
ran=()
not_run=()

step() { printf '\n== %s\n' "$*"; }

has_instructions() { grep -qsw "$1" /proc/cpuinfo; }

has_nightly() { cargo +nightly --version >/dev/null 2>&1; }

has_miri() {
    has_nightly || return 1
    cargo +nightly miri --version >/dev/null 2>&1 && return 0
    rustup +nightly component add miri rust-src >/dev/null 2>&1 && cargo +nightly miri --version >/dev/null 2>&1
}

# With isolation, the property tests could not look for earlier failures.
miri() {
    RUSTFLAGS="$1" MIRIFLAGS=-Zmiri-disable-isolation PROPTEST_CASES=16 \
        cargo +nightly miri test --locked -p peristalsis-engine --lib "$tests"
}

# The names of functions that JavaScript calls are `unsafe` to choose; there is no other unsafe code beside them.
exports=crates/viewer/browser/exports.rs
step "unsafe code only in $module"
elsewhere=$(grep -rlzE --include='*.rs' 'allow\([^)]*unsafe_code' crates | grep -vE "^($module/mod.rs|$exports)$" || true)
if grep -qE 'unsafe *\{|unsafe (fn|impl)' "$exports"; then elsewhere="$elsewhere $exports"; fi
if [ -n "$elsewhere" ]; then
    printf 'error: unsafe code is allowed in %s too\n' "$elsewhere" >&2
    exit 1
fi

if has_miri; then
    step "Miri, plain code"
    miri ""
    ran+=("Miri, plain code")
    if [ "$(uname -m)" = x86_64 ]; then
        step "Miri, AVX2"
        miri "-Ctarget-feature=+avx2"
        ran+=("Miri, AVX2")
    fi
else
    not_run+=("Miri (no nightly toolchain with the components miri and rust-src)")
fi

if has_nightly && [ "$(uname -sm)" = "Linux x86_64" ]; then
    step "AddressSanitizer"
    RUSTFLAGS="-Zsanitizer=address" cargo +nightly test --locked --target x86_64-unknown-linux-gnu \
        -p peristalsis-engine --lib --tests
    # The property test of the module compares all the sets of instructions that there are.
    widest="plain code"
    if has_instructions avx2; then widest="AVX2"; fi
    if has_instructions avx512dq; then widest="AVX-512, AVX2"; fi
    ran+=("AddressSanitizer, $widest")
    if ! has_instructions avx512dq; then
        not_run+=("AddressSanitizer, AVX-512 (this machine has none)")
    fi
else
    not_run+=("AddressSanitizer (no nightly toolchain for x86-64 Linux)")
fi

if command -v valgrind >/dev/null; then
    step "memcheck"
    # The programs that cargo has built, one a line.
    programs=$(cargo test --locked --no-run --message-format=json-render-diagnostics -p peristalsis-engine --lib --test sorted |
        sed -n 's/.*"executable":"\([^"]*\)".*/\1/p')
    for program in $programs; do
        filter=$tests
        case "$program" in */sorted-*) filter= ;; esac
        # One thread: memcheck runs no more at a time.
        PROPTEST_CASES=64 valgrind --quiet --error-exitcode=1 "$program" --test-threads=1 $filter
    done
    ran+=("memcheck, without AVX-512, which valgrind does not know")
else
    not_run+=("memcheck (no valgrind)")
fi

step "audited"
if [ ${#ran[@]} -eq 0 ]; then echo "nothing"; fi
for what in "${ran[@]}"; do printf '%s\n' "$what"; done
for what in "${not_run[@]}"; do printf 'not run: %s\n' "$what"; done
