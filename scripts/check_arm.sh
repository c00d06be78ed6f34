#!/usr/bin/env bash
# The kernels on 64-bit ARM (NEON): every operation against plain code, and the bits of runs of all presets against those
# on record, under qemu. Needs Debian's gcc-aarch64-linux-gnu and qemu-user-static, and rustup or a toolchain that has the
# target.
set -euo pipefail
cd "$(dirname "$0")/.."
target=aarch64-unknown-linux-gnu
missing=$(for tool in aarch64-linux-gnu-gcc qemu-aarch64-static; do command -v "$tool" >/dev/null || echo "$tool"; done)
if [ -n "$missing" ]; then
    echo "skipped: this check needs" $missing
    exit 0
fi
[ -d "$(rustc --print sysroot)/lib/rustlib/$target" ] || rustup target add "$target"
export CARGO_INCREMENTAL=0 CARGO_PROFILE_DEV_DEBUG=none
export CARGO_TARGET_AARCH64_UNKNOWN_LINUX_GNU_LINKER=aarch64-linux-gnu-gcc
export CARGO_TARGET_AARCH64_UNKNOWN_LINUX_GNU_RUNNER="qemu-aarch64-static -L /usr/aarch64-linux-gnu"
cargo test --locked --target "$target" -p peristalsis-engine --lib fast::machine
cargo test --locked --target "$target" -p peristalsis-engine --test kernels all_instructions
cargo test --locked --target "$target" -p peristalsis-run --test golden
echo "NEON gives the bits on record"
