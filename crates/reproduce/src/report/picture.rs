//! Drawings inside a page.

use maud::{Escaper, PreEscaped};
use peristalsis_figures::Drawing;
use std::fmt::Write as _;

/// A drawing as an element of a page: its names prefixed, so that several drawings do not share any, and a label for those
/// who do not see it.
pub(crate) fn embedded(drawing: &Drawing, prefix: &str, label: &str) -> PreEscaped<String> {
    let mut escaped = String::new();
    Escaper::new(&mut escaped)
        .write_str(label)
        .expect("writing to a string cannot fail");
    let svg = drawing.svg_with_prefix(prefix);
    PreEscaped(svg.replacen("<svg", &format!("<svg aria-label=\"{escaped}\""), 1))
}
