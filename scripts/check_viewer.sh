#!/usr/bin/env bash
# The viewer in Chromium: the bundle is that of the sources, and the page does what it should. Needs npm and chromium.
set -euo pipefail
cd "$(dirname "$0")/.."
committed=$(sha256sum crates/viewer/assets/viewer.js)
bash scripts/viewer_bundle.sh
if [ "$committed" != "$(sha256sum crates/viewer/assets/viewer.js)" ]; then
    echo "error: crates/viewer/assets/viewer.js is not what viewer/ gives; commit what 'just viewer-bundle' made" >&2
    exit 1
fi
cargo build --release -p peristalsis
cd viewer
node check.mjs "${CARGO_TARGET_DIR:-../target}/release/peristalsis" "$@"
