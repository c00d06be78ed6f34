#!/usr/bin/env bash
# What the program is made of, against deny.toml: licences, bans, duplicates and sources of every crate; security
# advisories where the database of RustSec can be had. Says what was not checked.
set -euo pipefail
cd "$(dirname "$0")/.."

if ! cargo deny --version >/dev/null 2>&1; then
    echo "skipped: there is no cargo-deny (cargo install --locked cargo-deny)"
    exit 0
fi
cargo deny --all-features check bans licenses sources
if ! cargo deny --all-features check advisories; then
    if cargo deny fetch db >/dev/null 2>&1; then
        echo "error: an advisory stands against a crate of Cargo.lock" >&2
        exit 1
    fi
    echo "not checked: advisories (their database cannot be fetched here)"
fi
