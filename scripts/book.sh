#!/usr/bin/env bash
# The documentation book: references made from the schemas, pages by mdBook (target/book), every block executed, every
# test that the theory names looked for.
set -euo pipefail
cd "$(dirname "$0")/.."

step() { printf '\n== %s\n' "$*"; }

step "references from the schemas"
cargo build --release --locked --package peristalsis
mkdir -p target/book-reference
target/release/peristalsis schema --markdown > target/book-reference/configuration.md
target/release/peristalsis study schema --markdown > target/book-reference/study.md

step "tests that the theory names"
names=$(grep -oE '`[a-z0-9_]{12,}`' docs/book/src/theory.md | tr -d '`' | grep _ | grep -v '^energy_residual$' | sort -u)
for name in $names; do
    grep -rqE "fn $name\(" crates --include='*.rs' || { echo "there is no test $name"; exit 1; }
done
echo "$(wc -w <<< "$names") tests"

step "the blocks of the book, executed"
python3 scripts/run_snippets.py --only sh --together docs/book/src/tutorial.md docs/book/src/how-to.md

step "pages"
if ! mdbook=$(command -v mdbook); then
    mdbook=$PWD/target/mdbook/bin/mdbook
    [ -x "$mdbook" ] || cargo install --quiet --locked mdbook --root target/mdbook
fi
"$mdbook" build docs/book
grep -q "wall.keep" target/book/configuration.html
echo "target/book/index.html"
