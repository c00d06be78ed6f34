#!/usr/bin/env bash
# The documentation book: references made from the schemas and from Python's docstrings, pages by mdBook (target/book) that
# need no network, every block executed, every test that the theory names looked for, every link followed.
set -euo pipefail
cd "$(dirname "$0")/.."

step() { printf '\n== %s\n' "$*"; }

step "references from the schemas"
cargo build --release --locked --package peristalsis
mkdir -p target/book-reference
target/release/peristalsis schema --markdown > target/book-reference/configuration.md
target/release/peristalsis study schema --markdown > target/book-reference/study.md
python3 scripts/book_api.py > target/book-reference/api.md

step "tests that the theory names"
names=$(grep -oE '`[a-z0-9_]{12,}`' docs/book/src/theory.md | tr -d '`' | grep _ | grep -v '^energy_residual$' | sort -u)
for name in $names; do
    grep -rqE "fn $name\(" crates --include='*.rs' || { echo "there is no test $name"; exit 1; }
done
echo "$(wc -w <<< "$names") tests"

step "the blocks of the book, executed"
python3 scripts/run_snippets.py --only sh --together docs/book/src/tutorial.md docs/book/src/how-to.md \
    docs/book/src/installation.md docs/book/src/troubleshooting.md

step "pages"
if ! mdbook=$(command -v mdbook); then
    mdbook=$PWD/target/mdbook/bin/mdbook
    [ -x "$mdbook" ] || cargo install --quiet --locked mdbook --root target/mdbook
fi
[ -x target/book-python/bin/python ] || python3 -m venv target/book-python
target/book-python/bin/pip install --quiet latex2mathml
MDBOOK_PREPROCESSOR__PAGES__COMMAND="$PWD/target/book-python/bin/python $PWD/scripts/book_pages.py" "$mdbook" build docs/book
cp -r docs/images target/book/
grep -q "wall.keep" target/book/configuration.html
grep -q "<math" target/book/theory.html

step "links and pictures"
python3 scripts/check_links.py target/book
echo "target/book/index.html"
