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
    let svg = with_prefix(&drawing.svg(), prefix);
    PreEscaped(svg.replacen("<svg", &format!("<svg aria-label=\"{escaped}\""), 1))
}

/// An SVG document with a prefix before every name that it defines or refers to.
///
/// Quotation marks within texts are escaped, so that what is replaced can only be attributes.
fn with_prefix(svg: &str, prefix: &str) -> String {
    svg.replace(" id=\"", &format!(" id=\"{prefix}"))
        .replace(" href=\"#", &format!(" href=\"#{prefix}"))
        .replace("=\"url(#", &format!("=\"url(#{prefix}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_and_references_are_prefixed_and_texts_are_not() {
        let svg = "<svg id=\"a\"><title>the id=&quot;x&quot; of url(#x)</title><use href=\"#a\"/>\
                   <circle fill=\"url(#b)\"/><image href=\"data:image/png;base64,AA\"/></svg>";
        assert_eq!(
            with_prefix(svg, "f3-"),
            "<svg id=\"f3-a\"><title>the id=&quot;x&quot; of url(#x)</title><use href=\"#f3-a\"/>\
             <circle fill=\"url(#f3-b)\"/><image href=\"data:image/png;base64,AA\"/></svg>"
        );
    }
}
