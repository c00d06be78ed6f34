//! `VALIDATION.md` says what the rows in `validation/results` say.
//!
//! `UPDATE_EXPECT=1 cargo test -p peristalsis-reproduce --test validation` writes it anew, with the first figure of each claim:
//! right where rows, claims or their words have changed.

#![allow(
    clippy::unwrap_used,
    reason = "a test fails where what it needs is missing"
)]

use std::fs;
use std::path::Path;

use expect_test::expect_file;
use peristalsis_reproduce::report::Report;
use peristalsis_reproduce::{CLAIMS, Reproduction, STUDIES, Size};

/// Folder of the figures, as the document sees it.
const FIGURES: &str = "docs/images/claims";
/// Words that the document has at most.
const MOST_WORDS: usize = 11_400;
/// Characters that fill two lines of a cell.
const TWO_LINES: usize = 120;

/// What the published rows say, nothing computed beside them.
fn published(root: &Path) -> Report {
    let folder = tempfile::tempdir().unwrap();
    let reproduction = Reproduction::prepare(folder.path(), Size::Full, CLAIMS, STUDIES).unwrap();
    reproduction
        .import(&[root.join("validation/results")])
        .unwrap();
    let outcome = reproduction.examine(&mut |_| {});
    Report::of(Size::Full, outcome)
}

/// A cell as it is seen: without elements and the addresses of links.
fn seen(cell: &str) -> String {
    let pieces = cell
        .split('<')
        .map(|piece| piece.split_once('>').map_or(piece, |(_, text)| text));
    let text: String = pieces.collect();
    text.split("](")
        .map(|piece| piece.split_once(')').map_or(piece, |(_, rest)| rest))
        .collect()
}

#[test]
fn the_document_says_what_the_rows_say() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let report = published(&root);
    let text = report.markdown(FIGURES);
    expect_file![root.join("VALIDATION.md")].assert_eq(&text);
    let folder = root.join(FIGURES);
    let mut drawn = Vec::new();
    for (name, drawing) in report.main_figures() {
        let path = folder.join(name).with_extension("svg");
        expect_file![&path].assert_eq(&drawing.svg());
        drawn.push(path);
    }
    for entry in fs::read_dir(&folder).unwrap() {
        let path = entry.unwrap().path();
        assert!(drawn.contains(&path), "of no claim: {}", path.display());
    }
    // Bars and rules of tables are no words.
    let words = text
        .split_whitespace()
        .filter(|word| !word.starts_with('|'));
    let words = words.count();
    assert!(words < MOST_WORDS, "{words} words");
    for line in text.lines().filter(|line| line.starts_with('|')) {
        for cell in line.replace("\\|", "").split('|') {
            let seen = seen(cell);
            assert!(
                seen.chars().count() <= TWO_LINES,
                "a cell of more than two lines: {seen}"
            );
        }
    }
}
