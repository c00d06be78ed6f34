#!/usr/bin/env bash
# The viewer in Chromium: the bundle is that of the sources, and the page does what it should. Needs npm and chromium.
set -euo pipefail
cd "$(dirname "$0")/.."
bundles=(crates/viewer/assets/{viewer,study,widget}.js)
committed=$(sha256sum "${bundles[@]}")
bash scripts/viewer_bundle.sh
if [ "$committed" != "$(sha256sum "${bundles[@]}")" ]; then
    echo "error: ${bundles[*]} are not what viewer/ gives; commit what 'just viewer-bundle' made" >&2
    exit 1
fi
# The page that computes by itself, where this toolchain can make it.
if [ -d "$(rustc --print sysroot)/lib/rustlib/wasm32-unknown-unknown" ]; then
    bash scripts/web.sh
fi
cargo build --release -p peristalsis
cd viewer
node check.mjs "${CARGO_TARGET_DIR:-../target}/release/peristalsis" "$@"
