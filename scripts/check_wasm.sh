#!/usr/bin/env bash
# The kernels as WebAssembly (SIMD128): every operation against plain code, and the bits of runs of all presets against
# those on record, in Node.js. Needs node, and rustup or a toolchain that has the target.
set -euo pipefail
cd "$(dirname "$0")/.."
target=wasm32-wasip1
if ! command -v node >/dev/null; then
    echo "skipped: this check needs node"
    exit 0
fi
[ -d "$(rustc --print sysroot)/lib/rustlib/$target" ] || rustup target add "$target"
export CARGO_INCREMENTAL=0 CARGO_PROFILE_DEV_DEBUG=none
export CARGO_TARGET_WASM32_WASIP1_RUSTFLAGS="-C target-feature=+simd128"
export CARGO_TARGET_WASM32_WASIP1_RUNNER="node --no-warnings $PWD/scripts/wasi.mjs"
cargo test --locked --target "$target" -p peristalsis-engine --lib fast::machine
cargo test --locked --target "$target" -p peristalsis-run --test golden
echo "SIMD128 gives the bits on record"
