#!/usr/bin/env bash
# Runs every fuzz target in turn for so many seconds each (600). Needs cargo-fuzz, a nightly compiler and a C++ compiler.
set -euo pipefail
cd "$(dirname "$0")/.."

seconds=${1:-600}
cargo +nightly fuzz build
for target in $(cargo +nightly fuzz list); do
    printf '\n== %s, %s s\n' "$target" "$seconds"
    seeds=("fuzz/corpus/$target" "fuzz/seeds/$target")
    mkdir -p "${seeds[@]}"
    [ "$target" = configuration ] && seeds+=(crates/configuration/presets)
    cargo +nightly fuzz run "$target" "${seeds[@]}" -- \
        -max_total_time="$seconds" -max_len=8192 -rss_limit_mb=4096 -timeout=60 -print_final_stats=1
done
