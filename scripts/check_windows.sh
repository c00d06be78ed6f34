#!/usr/bin/env bash
# The command line as a program for Windows, under wine: the same bytes as here, a run that is killed and gone on with, a
# study of two workers, and a viewer that answers. Ctrl-C cannot be tried: the `signal` of Debian's wine takes the question
# for the present handler (SIG_GET) for a handler. Then, whether the Rust of the program compiles for macOS: its C, and the
# linking, need tools of Apple's. Needs Debian's gcc-mingw-w64-x86-64 and wine64, and rustup or a toolchain that has the
# targets.
set -euo pipefail
cd "$(dirname "$0")/.."
target=x86_64-pc-windows-gnu
mac=aarch64-apple-darwin
missing=$(for tool in x86_64-w64-mingw32-gcc wine curl; do command -v "$tool" >/dev/null || echo "$tool"; done)
if [ -n "$missing" ]; then
    echo "skipped: this check needs" $missing
    exit 0
fi
libraries=$(rustc --print sysroot)/lib/rustlib
for each in $target $mac; do [ -d "$libraries/$each" ] || rustup target add "$each"; done
step() { printf '\n== %s\n' "$*"; }

export CARGO_INCREMENTAL=0 CARGO_PROFILE_DEV_DEBUG=none
here=${CARGO_TARGET_DIR:-target}
step "programs"
cargo build --locked -p peristalsis
cargo build --locked -p peristalsis --target $target

scratch=$(mktemp -d)
export WINEPREFIX=$scratch/wine WINEDEBUG=-all
finish() {
    wineserver -k 2>/dev/null || true
    rm -rf "$scratch"
}
trap finish EXIT
cp "$here/$target/debug/peristalsis.exe" "$scratch"
# wine before version 9 lacks this library, of which Rust's standard library calls one function.
echo 'int __stdcall SystemFunction036(void *, unsigned);
__declspec(dllexport) int __stdcall ProcessPrng(void *to, unsigned long long bytes) {
    return SystemFunction036(to, (unsigned)bytes) != 0;
}' >"$scratch/bcryptprimitives.c"
x86_64-w64-mingw32-gcc -shared -O2 -o "$scratch/bcryptprimitives.dll" "$scratch/bcryptprimitives.c" -ladvapi32
linux=$(realpath "$here/debug/peristalsis")
windows=("wine" "$scratch/peristalsis.exe")
cd "$scratch"
wineboot --init >/dev/null 2>&1 || true

step "a run: the same bytes"
run=(run --quiet --preset frictionless --set run.periods=6 --csv --out)
"$linux" "${run[@]}" linux
"${windows[@]}" "${run[@]}" windows
for file in timeseries.csv profile.parquet waves.parquet; do cmp "linux/$file" "windows/$file"; done

step "killed, and gone on with: the same bytes"
longer=(run --quiet --preset frictionless --set run.periods=600 --csv --checkpoint-every 1s --out)
"$linux" "${longer[@]}" long
"${windows[@]}" "${longer[@]}" killed &
process=$!
until [ -s killed/state.checkpoint ]; do sleep 0.2; done
sleep 1
kill -9 $process
wineserver -k
wait $process 2>/dev/null || true
"${windows[@]}" run --quiet --csv --resume killed
cmp long/timeseries.csv killed/timeseries.csv

step "a study of two workers: the same rows"
cat >study.toml <<'END'
name = "tubes"
preset = "frictionless"
replicates = 2
[base]
run.periods = 2
[[axes]]
key = "drive.width"
values = [2.6, 2.9]
END
"$linux" study run study.toml --store stores/linux --quiet
"${windows[@]}" study run study.toml --store stores/windows --workers 2 --quiet
"$linux" study export stores/linux --out rows-linux
"${windows[@]}" study export stores/windows --out rows-windows
cmp rows-linux/tubes.csv rows-windows/tubes.csv

step "a viewer that answers"
"${windows[@]}" view frictionless >address &
process=$!
until grep -q http address; do sleep 0.2; done
curl --silent --show-error --fail --output page "$(tr -d '\r' <address | grep -o 'http[^ ]*')"
grep -q "<title>" page
kill $process

step "macOS: whether it compiles, without its C and without linking"
cd - >/dev/null
CC_aarch64_apple_darwin=true AR_aarch64_apple_darwin=true SDKROOT=/ cargo check --locked --target $mac -p peristalsis

step "Windows: the bytes of Linux; macOS: it compiles"
