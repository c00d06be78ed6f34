//! Findings as Markdown, and their places in a document.

use std::path::Path;

use crate::{Check, Convergence, Finding, ReportTable, ReproduceError};

/// A finding: its paragraphs, checks, errors and figures; `figures` is the folder of the pictures as the document sees it.
pub(crate) fn finding(finding: &Finding, figures: &str) -> String {
    let mut text = String::new();
    for paragraph in &finding.paragraphs {
        text.push_str(&format!("\n{paragraph}\n"));
    }
    if !finding.checks.is_empty() {
        text.push_str(&format!("\n{}", table(&Check::table(&finding.checks))));
    }
    for errors in Convergence::tables(&finding.convergences) {
        text.push_str(&format!("\n{}", table(&errors)));
    }
    for figure in &finding.figures {
        let (caption, name) = (&figure.caption, &figure.name);
        text.push_str(&format!("\n![{caption}]({figures}/{name}.svg)\n"));
    }
    text
}

/// A table without its caption.
pub(crate) fn table(table: &ReportTable) -> String {
    let row = |cells: &[String]| {
        let cells = cells.iter().map(|cell| match cell.as_str() {
            "" => " |".to_owned(),
            cell => format!(" {cell} |"),
        });
        format!("|{}\n", cells.collect::<String>())
    };
    let rule = format!("|{}\n", "---|".repeat(table.head.len()));
    let rows: String = table.rows.iter().map(|cells| row(cells)).collect();
    row(&table.head) + &rule + &rows
}

/// The text of the document `path` with the block `name` in place of the text between its markers.
///
/// # Errors
/// [`ReproduceError::NoPlace`] with the line that is missing: its first marker, or the next end of a block.
pub(crate) fn replaced(
    path: &Path,
    text: &str,
    name: &str,
    block: &str,
) -> Result<String, ReproduceError> {
    let (first, last) = (format!("<!-- validate {name} -->"), "<!-- /validate -->");
    let missing = |line: &str| ReproduceError::NoPlace {
        path: path.to_owned(),
        block: name.to_owned(),
        line: line.to_owned(),
    };
    let start = text.find(&first).ok_or_else(|| missing(&first))? + first.len();
    let rest = &text[start..];
    let end = rest.find(last).ok_or_else(|| missing(last))?;
    // The end of another block would swallow the text before it.
    if rest[..end].contains("<!-- validate ") {
        return Err(missing(last));
    }
    Ok(format!("{}\n{block}{}", &text[..start], &rest[end..]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_block_is_replaced_and_nothing_else() {
        let text = |block: &str| {
            let other = "<!-- validate y -->\n<!-- /validate -->\n";
            format!("a\n<!-- validate x -->\n{block}<!-- /validate -->\nb\n{other}")
        };
        for before in ["old\n", "new\n"] {
            let found = replaced(Path::new(""), &text(before), "x", "new\n");
            assert_eq!(found.unwrap(), text("new\n"));
        }
    }

    #[test]
    fn missing_markers_are_named() {
        let open = "<!-- validate x -->\n<!-- validate y -->\n<!-- /validate -->\n";
        for (text, line) in [
            ("text", "<!-- validate x -->"),
            (open, "<!-- /validate -->"),
        ] {
            let error = replaced(Path::new("a.md"), text, "x", "").unwrap_err();
            let expected = format!("a.md has no place for \"x\": the line {line:?} is missing");
            assert_eq!(error.to_string(), expected);
        }
    }
}
