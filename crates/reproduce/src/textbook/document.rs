//! Findings as Markdown, and places for them in a document.

use crate::textbook::finding::{Check, Convergence};
use crate::textbook::validation::Examination;

/// The block of a case; `figures` is the folder of its pictures as the document sees it.
#[must_use]
pub fn text_of(examination: &Examination, figures: &str) -> String {
    let case = &examination.case;
    let finding = &examination.finding;
    let mut text = format!(
        "**{}** – {}. `peristalsis validate --only {}`: {}.\n",
        case.title,
        case.source,
        case.name,
        verdict(examination)
    );
    if let Some(failure) = &examination.failure {
        text.push_str(&format!("\nIt could not be examined: {failure}.\n"));
    }
    for paragraph in &finding.paragraphs {
        text.push_str(&format!("\n{paragraph}\n"));
    }
    if !finding.checks.is_empty() {
        text.push_str(
            "\n| quantity | experiment | reference | expected | found | deviation | allowed | |\n",
        );
        text.push_str("|---|---|---|---|---|---|---|---|\n");
        for check in &finding.checks {
            text.push_str(&check_row(check));
        }
    }
    // Steps may differ from experiment to experiment: each kind has its own head.
    for group in finding
        .convergences
        .chunk_by(|one, other| one.unit == other.unit && one.steps == other.steps)
    {
        text.push_str(&convergence_table(group));
    }
    for figure in &finding.figures {
        text.push_str(&format!(
            "\n![{}]({figures}/{}.svg)\n",
            figure
                .caption
                .split_whitespace()
                .collect::<Vec<_>>()
                .join(" "),
            figure.name
        ));
    }
    text
}

/// All cases, a row each.
pub(crate) fn summary(examinations: &[Examination]) -> String {
    let mut text = "| case | checks | largest deviation over what is allowed | orders | |\n|---|---|---|---|---|\n".to_owned();
    for examination in examinations {
        let checks = &examination.finding.checks;
        let worst = checks.iter().fold(0.0_f64, |worst, check| {
            worst.max(check.deviation / check.tolerance)
        });
        let orders = examination
            .finding
            .convergences
            .iter()
            .filter_map(|c| c.order);
        let (least, largest) = orders.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), order| {
            (a.min(order), b.max(order))
        });
        let orders = if least > largest {
            "–".to_owned()
        } else {
            format!("{least:.2} – {largest:.2}")
        };
        text.push_str(&format!(
            "| {} | {} | {worst:.2} | {orders} | {} |\n",
            examination.case.name,
            checks.len(),
            verdict(examination)
        ));
    }
    text
}

fn verdict(examination: &Examination) -> &'static str {
    word(examination.passed())
}

fn word(passed: bool) -> &'static str {
    if passed { "passed" } else { "**failed**" }
}

fn check_row(check: &Check) -> String {
    let found = match check.standard_error {
        Some(error) => format!("{} ± {}", number(check.found), brief(error)),
        None => number(check.found),
    };
    format!(
        "| {} | {} | {} | {} | {found} | {} | {} | {} |\n",
        check.quantity,
        check.setting,
        check.reference,
        number(check.expected),
        brief(check.deviation),
        brief(check.tolerance),
        word(check.passed)
    )
}

fn convergence_table(group: &[Convergence]) -> String {
    let mut text = String::from("\n| relative error of | experiment |");
    for step in &group[0].steps {
        text.push_str(&format!(" h = {step} {} |", group[0].unit));
    }
    text.push_str(" order | allowed | |\n|---|---|");
    text.push_str(&"---|".repeat(group[0].steps.len() + 3));
    text.push('\n');
    for convergence in group {
        text.push_str(&format!(
            "| {} | {} |",
            convergence.quantity, convergence.setting
        ));
        for error in &convergence.errors {
            text.push_str(&format!(" {} |", brief(*error)));
        }
        let order = convergence
            .order
            .map_or_else(|| "rounding".to_owned(), |order| format!("{order:.2}"));
        let [least, largest] = convergence.expected_order;
        text.push_str(&format!(
            " {order} | {least} – {largest} | {} |\n",
            word(convergence.passed)
        ));
    }
    text
}

/// Six digits that count.
fn number(value: f64) -> String {
    digits(value, 6)
}

/// Two digits that count.
fn brief(value: f64) -> String {
    digits(value, 2)
}

fn digits(value: f64, count: i32) -> String {
    if value == 0.0 {
        return "0".to_owned();
    }
    if !value.is_finite() {
        return "–".to_owned();
    }
    let exponent = libm::floor(libm::log10(value.abs())) as i32;
    if !(-3..6).contains(&exponent) {
        let places = (count - 1) as usize;
        return format!("{value:.places$e}");
    }
    let places = (count - 1 - exponent).max(0) as usize;
    format!("{value:.places$}")
}

/// The document with the block `name` in place of what stands between its markers.
///
/// # Errors
/// Name of the block and the line that is missing: its first marker, or the next end of a block.
pub fn replaced(text: &str, name: &str, block: &str) -> Result<String, (String, String)> {
    let (first, last) = (format!("<!-- validate {name} -->"), "<!-- /validate -->");
    let missing = |line: &str| (name.to_owned(), line.to_owned());
    let start = text.find(&first).ok_or_else(|| missing(&first))? + first.len();
    let rest = &text[start..];
    let end = rest.find(last).ok_or_else(|| missing(last))?;
    // The end of another block would swallow what stands before it.
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
        let text = "a\n<!-- validate x -->\nold\n<!-- /validate -->\nb\n<!-- validate y -->\n<!-- /validate -->\n";
        let found = replaced(text, "x", "new\n").unwrap();
        assert_eq!(
            found,
            "a\n<!-- validate x -->\nnew\n<!-- /validate -->\nb\n<!-- validate y -->\n<!-- /validate -->\n"
        );
        assert_eq!(replaced(&found, "x", "new\n").unwrap(), found);
    }

    #[test]
    fn missing_markers_are_named() {
        assert_eq!(
            replaced("text", "x", "").unwrap_err().1,
            "<!-- validate x -->"
        );
        let open = "<!-- validate x -->\n<!-- validate y -->\n<!-- /validate -->\n";
        assert_eq!(replaced(open, "x", "").unwrap_err().1, "<!-- /validate -->");
    }

    #[test]
    fn numbers_have_the_digits_that_count() {
        assert_eq!(number(0.714_285_714), "0.714286");
        assert_eq!(number(12.0), "12.0000");
        assert_eq!(number(1_234_567.0), "1.23457e6");
        assert_eq!(brief(0.000_123), "1.2e-4");
        assert_eq!(brief(f64::NAN), "–");
        assert_eq!(brief(0.0), "0");
    }
}
