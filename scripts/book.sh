#!/usr/bin/env bash
# The documentation book, target/book: references made from the program, from Python's docstrings and by rustdoc; every block
# executed; every test that an explanation names looked for; pages by mdBook that need no network; every link followed.
# What is built already can be named: PROGRAM (the program), PYTHON (an interpreter that has the package with Matplotlib),
# RUSTDOC (a folder that `cargo doc` filled).
set -euo pipefail
cd "$(dirname "$0")/.."
source=docs/book/src
targets=${CARGO_TARGET_DIR:-$PWD/target}

step() { printf '\n== %s\n' "$*"; }

step "references from the program"
if [ -z "${PROGRAM:-}" ]; then
    cargo build --release --locked --package peristalsis
    PROGRAM=$targets/release/peristalsis
fi
mkdir -p target/book-reference
"$PROGRAM" schema --markdown > target/book-reference/configuration.md
"$PROGRAM" study schema --markdown > target/book-reference/study.md
python3 scripts/book_commands.py "$PROGRAM" > target/book-reference/commands.md
python3 scripts/book_api.py > target/book-reference/api.md

step "tests that the explanations name"
names=$(grep -hE '^Tests?:|: `' $source/explanations/*.md | grep -oE '`[a-z0-9_]{12,}`' | tr -d '`' | grep _ | grep -v '^energy_residual$' | sort -u)
for name in $names; do
    grep -rqE "fn $name\(" crates --include='*.rs' || { echo "there is no test $name"; exit 1; }
done
echo "$(wc -w <<< "$names") tests"

step "the blocks of the book, executed"
# In the order of the book, in one folder: a page may use what a page before it made.
pages=$(grep -oE '\(([a-z/-]+\.md)\)' $source/SUMMARY.md | tr -d '()' | sed "s#^#$source/#")
python3 scripts/run_snippets.py --only sh --together --programs "$(dirname "$PROGRAM")" $(grep -lE '^```sh' $pages)

environment=target/book-python
[ -x $environment/bin/python ] || python3 -m venv $environment
if [ -z "${PYTHON:-}" ]; then
    $environment/bin/pip install --quiet '.[plot]'
    PYTHON=$PWD/$environment/bin/python
fi
"$PYTHON" scripts/run_snippets.py --only python $(grep -lE '^```python' $pages)

step "pages"
if ! mdbook=$(command -v mdbook); then
    mdbook=$PWD/target/mdbook/bin/mdbook
    [ -x "$mdbook" ] || cargo install --quiet --locked mdbook --root target/mdbook
fi
$environment/bin/pip install --quiet latex2mathml
MDBOOK_PREPROCESSOR__PAGES__COMMAND="$PWD/$environment/bin/python $PWD/scripts/book_pages.py" "$mdbook" build docs/book
cp -r docs/images target/book/
if [ -z "${RUSTDOC:-}" ]; then
    cargo doc --workspace --no-deps --locked
    RUSTDOC=$targets/doc
fi
cp -r "$RUSTDOC" target/book/rust
grep -q "wall.keep" target/book/reference/configuration.html
grep -q "<math" target/book/explanations/contact-laws.html
# What a reader looks for is found.
for word in bistable bottleneck "drive.width" transition_time; do
    grep -q "$word" target/book/searchindex-*.js || { echo "the search finds no $word"; exit 1; }
done

step "links and pictures"
python3 scripts/check_links.py target/book
echo "target/book/index.html"
