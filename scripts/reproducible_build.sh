#!/usr/bin/env bash
# Builds the release program twice, in two folders of different names and with different build folders, and compares the
# bytes. Paths of the sources and of cargo's home are mapped to names that are the same everywhere; the compiler is the
# one of this machine, and the same compiler is what makes the same code.
#
# What is compared is what is committed: the builds are made from `git archive`.
set -euo pipefail
cd "$(dirname "$0")/.."

profile=${1:-release}
revision=$(git rev-parse --short=12 HEAD)
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cargo_home=${CARGO_HOME:-$HOME/.cargo}
toolchain=$(rustc --print sysroot)

build() {
    local folder=$1
    mkdir -p "$folder/source"
    git archive HEAD | tar -x -C "$folder/source"
    # C code (SQLite) is told the same.
    (
        cd "$folder/source"
        export CARGO_TARGET_DIR="$folder/build"
        export PERISTALSIS_REVISION="$revision"
        export RUSTFLAGS="--remap-path-prefix=$folder/source=/peristalsis --remap-path-prefix=$folder/build=/build"
        RUSTFLAGS+=" --remap-path-prefix=$cargo_home=/cargo --remap-path-prefix=$toolchain=/rust"
        export CFLAGS="-ffile-prefix-map=$folder/build=/build -ffile-prefix-map=$cargo_home=/cargo"
        export SOURCE_DATE_EPOCH=0
        cargo build --locked --quiet --profile "$profile" -p peristalsis
    )
    sha256sum "$folder/build/$profile/peristalsis" | cut -d' ' -f1
}

first=$(build "$scratch/one")
second=$(build "$scratch/another-place/with-a-longer-name")
printf '%s\n%s\n' "$first" "$second"
rustc --version
if [ "$first" != "$second" ]; then
    cmp "$scratch/one/build/$profile/peristalsis" \
        "$scratch/another-place/with-a-longer-name/build/$profile/peristalsis" || true
    echo "error: the two builds differ" >&2
    exit 1
fi
for place in "$scratch" "$cargo_home"; do
    if grep -qa "$place" "$scratch/one/build/$profile/peristalsis"; then
        echo "error: the program names $place" >&2
        exit 1
    fi
done
echo "the same bytes from both builds, and no path of this machine in them"
