#!/usr/bin/env bash
# The page that computes the tube in the visitor's own browser, as files for any static server: target/web. Needs npm, and
# rustup or a toolchain that has the target wasm32-unknown-unknown.
set -euo pipefail
cd "$(dirname "$0")/.."
target=wasm32-unknown-unknown
if ! [ -d "$(rustc --print sysroot)/lib/rustlib/$target" ]; then
    rustup target add "$target"
fi
# Every browser has had these instructions for years; none of them rounds otherwise.
export CARGO_TARGET_WASM32_UNKNOWN_UNKNOWN_RUSTFLAGS="-C target-feature=+simd128"
cargo build --locked --profile browser --target "$target" -p peristalsis-viewer --no-default-features --features page --example browser
rm -rf target/web
mkdir -p target/web
install -m 644 "${CARGO_TARGET_DIR:-target}/$target/browser/examples/browser.wasm" target/web/engine.wasm
cd viewer
[ -d node_modules ] || npm ci --ignore-scripts --no-audit --no-fund
npm run check
npm run web
cd ..
assets=crates/viewer/assets
cp "$assets/viewer.css" "$assets/icon.svg" README.md VALIDATION.md CITATION.cff LICENSE-MIT THIRD-PARTY.txt docs/images/space-time.png target/web/
cp crates/python/README.md target/web/python.md
cp docs/images/viewer.jpg target/web/share.jpg
# For browsers without JavaScript.
cp docs/images/jamming.gif target/web/film.gif
if [ -d target/book ]; then cp -r target/book target/web/book; fi
# The address of the source is not known here: SOURCE=https://… just web. Without one the page brings the source along.
if [ -z "${SOURCE:-}" ] && git rev-parse --git-dir >/dev/null 2>&1; then
    SOURCE=source.tar.gz
    git archive --format=tar.gz --prefix=peristalsis/ -o "target/web/$SOURCE" HEAD ':!validation/results' ':!docs/images'
fi
node viewer/web.mjs ${SOURCE:+"$SOURCE"}
echo "target/web: open it with any static server, such as: python3 -m http.server --directory target/web --bind 127.0.0.1"
