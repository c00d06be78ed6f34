//! The text of a claim: a Markdown file beside its code, with named sections and placeholders for numbers.
//!
//! ```text
//! # Title
//!
//! Source: talk
//!
//! The statement of the source, in our words.
//!
//! ## summary
//!
//! The flow jumps at *w*_{c} = {width}.
//!
//! ## table: jumps
//!
//! Where the flow jumps.
//!
//! | *ε̇* | *w*_{c} |
//!
//! ## quantity: width
//!
//! critical width, {lattice} lattice
//!
//! - symbol: *w*_{c}
//! - unit: d
//! - method: bracket of two widths
//!
//! ## figure: jumps-against-width
//!
//! The flow against the width.
//!
//! - description: Flow against width at several strain rates.
//! ```
//!
//! Markup is that of figures. A placeholder is a word in braces that follows neither `_` nor `^`, which begin subscripts and
//! superscripts. Each section names what the code asks for; a test holds the two together.

use std::fmt::Display;

use peristalsis_analysis::Uncertain;
use peristalsis_figures::Drawing;
use peristalsis_figures::chart::ChartFigure;

use crate::error::Result;
use crate::finding::{Finding, Quantity, ReportFigure, ReportTable, Statistics};

/// Values for placeholders by name.
pub(crate) type Values<'a> = [(&'a str, &'a dyn Display)];

/// [`Values`] from variables of the same names, or from expressions: `values!(rate, width = line.width)`.
macro_rules! values {
    (of $name:ident) => { (stringify!($name), &$name as &dyn std::fmt::Display) };
    (of $name:ident = $value:expr) => { (stringify!($name), &$value as &dyn std::fmt::Display) };
    ($($name:ident $(= $value:expr)?),+) => { &[$(values!(of $name $(= $value)?)),+] };
}
pub(crate) use values;

/// The text of a claim.
#[derive(Clone, Copy, Debug)]
pub struct Prose {
    markdown: &'static str,
}

impl Prose {
    /// The text of a Markdown file.
    pub const fn new(markdown: &'static str) -> Self {
        Self { markdown }
    }

    /// What the claim is about, a few words.
    pub fn title(&self) -> &'static str {
        let line = self.markdown.lines().next().unwrap_or_default();
        line.trim_start_matches("# ")
    }

    /// Where the source says it.
    pub fn source(&self) -> &'static str {
        self.opening()
            .lines()
            .find_map(|line| line.strip_prefix("Source: "))
            .unwrap_or_default()
    }

    /// What the source says, in our words; or the question.
    pub fn statement(&self) -> String {
        let lines = self.opening().lines().skip(1);
        joined(lines.filter(|line| !line.starts_with("Source: ")))
    }

    /// The paragraphs of a section that asks for no value; none of another.
    pub(crate) fn plain(&self, name: &str) -> Vec<String> {
        match self.find(name) {
            Some(text) if placeholders(text).is_empty() => self.paragraphs(name, &[]),
            _ => Vec::new(),
        }
    }

    /// A finding that says no more than the section `nothing`.
    pub(crate) fn nothing(&self, statistics: Statistics) -> Finding {
        Finding {
            summary: self.text("nothing", &[]),
            statistics,
            ..Finding::default()
        }
    }

    /// A finding that holds the section `method` and nothing else yet.
    pub(crate) fn described(&self, values: &Values<'_>) -> Finding {
        Finding {
            paragraphs: self.paragraphs("method", values),
            ..Finding::default()
        }
    }

    /// A section as one paragraph.
    pub(crate) fn text(&self, section: &str, values: &Values<'_>) -> String {
        filled(&joined(self.section(section).lines()), values)
    }

    /// The paragraphs of a section.
    pub(crate) fn paragraphs(&self, section: &str, values: &Values<'_>) -> Vec<String> {
        let text = filled(self.section(section), values);
        text.split("\n\n")
            .map(|paragraph| joined(paragraph.lines()))
            .collect()
    }

    /// The table of a section `table: name`: its caption and the heads of its columns are written there.
    pub(crate) fn table(
        &self,
        name: &str,
        values: &Values<'_>,
        rows: impl IntoIterator<Item = Vec<String>>,
    ) -> ReportTable {
        let section = self.section(&format!("table: {name}"));
        let is_head = |line: &&str| line.starts_with('|');
        let head = section.lines().find(is_head).unwrap_or_default();
        ReportTable {
            caption: filled(
                &joined(section.lines().filter(|line| !is_head(line))),
                values,
            ),
            head: head
                .trim_matches('|')
                .split('|')
                .map(|cell| cell.trim().to_owned())
                .collect(),
            rows: rows.into_iter().collect(),
        }
    }

    /// The figure of a section `figure: name`, with its caption.
    pub(crate) fn figure(&self, name: &str, values: &Values<'_>, drawing: Drawing) -> ReportFigure {
        ReportFigure {
            name: name.to_owned(),
            caption: self.text(&format!("figure: {name}"), values),
            drawing,
        }
    }

    /// The chart of a section `figure: name`, with its caption, and its description for those who cannot see it.
    pub(crate) fn chart(
        &self,
        name: &str,
        values: &Values<'_>,
        chart: ChartFigure,
    ) -> Result<ReportFigure> {
        let section = filled(self.section(&format!("figure: {name}")), values);
        let (caption, description) = section
            .split_once("- description: ")
            .unwrap_or((&section, ""));
        let drawing = chart.description(&joined(description.lines())).draw()?;
        Ok(ReportFigure {
            name: name.to_owned(),
            caption: joined(caption.lines()),
            drawing,
        })
    }

    /// The names of all figures that the text knows.
    pub(crate) fn figures(&self) -> impl Iterator<Item = &'static str> {
        let sections = self.markdown.split("\n## ").skip(1);
        sections.filter_map(|section| section.lines().next()?.strip_prefix("figure: "))
    }

    /// The number of a section `quantity: name`, of which the source gives none: its name, symbol, unit and method are written
    /// there.
    pub(crate) fn quantity(
        &self,
        name: &str,
        values: &Values<'_>,
        ours: impl Into<Option<Uncertain>>,
    ) -> Quantity {
        let section = filled(self.section(&format!("quantity: {name}")), values);
        let item = |key: &str| {
            let item = section.lines().find_map(|line| line.strip_prefix(key));
            item.unwrap_or_default().to_owned()
        };
        Quantity {
            name: joined(section.lines().filter(|line| !line.starts_with("- "))),
            symbol: item("- symbol: "),
            unit: item("- unit: "),
            source: None,
            ours: ours.into(),
            method: item("- method: "),
        }
    }

    /// Title, source and statement.
    fn opening(&self) -> &'static str {
        let end = self.markdown.find("\n## ").unwrap_or(self.markdown.len());
        &self.markdown[..end]
    }

    /// What stands below a heading, if it is there.
    fn find(&self, name: &str) -> Option<&'static str> {
        let sections = self.markdown.split("\n## ").skip(1);
        let mut parts = sections.filter_map(|section| section.split_once('\n'));
        let (_, text) = parts.find(|(heading, _)| *heading == name)?;
        Some(text.trim())
    }

    /// What stands below a heading.
    fn section(&self, name: &str) -> &'static str {
        let found = self.find(name);
        debug_assert!(found.is_some(), "no section {name:?} in {:?}", self.title());
        found.unwrap_or_default()
    }
}

/// Lines as one paragraph.
fn joined<'a>(lines: impl Iterator<Item = &'a str>) -> String {
    let lines: Vec<&str> = lines
        .map(str::trim)
        .filter(|line| !line.is_empty())
        .collect();
    lines.join(" ")
}

/// The placeholders of a text: where each begins and ends, braces included, and its name.
fn placeholders(text: &str) -> Vec<(usize, usize, &str)> {
    let is_script = |at: usize| text[..at].ends_with(['_', '^']);
    let is_name =
        |name: &str| !name.is_empty() && name.bytes().all(|c| c.is_ascii_lowercase() || c == b'_');
    text.match_indices('{')
        .filter(|(begin, _)| !is_script(*begin))
        .filter_map(|(begin, _)| {
            let end = begin + text[begin..].find('}')?;
            let name = &text[begin + 1..end];
            is_name(name).then_some((begin, end + 1, name))
        })
        .collect()
}

/// A text with its placeholders filled; a missing or superfluous value is a bug of ours.
pub(crate) fn filled(text: &str, values: &Values<'_>) -> String {
    let found = placeholders(text);
    for (name, _) in values {
        debug_assert!(
            found.iter().any(|placeholder| placeholder.2 == *name),
            "no {{{name}}} in {text:?}"
        );
    }
    let mut filled = String::new();
    let mut rest = 0;
    for (begin, end, name) in found {
        let value = values.iter().find(|(known, _)| *known == name);
        debug_assert!(value.is_some(), "no value for {{{name}}} in {text:?}");
        filled.push_str(&text[rest..begin]);
        filled.extend(value.map(|(_, value)| value.to_string()));
        rest = end;
    }
    filled + &text[rest..]
}

#[cfg(test)]
mod tests {
    use std::fs;
    use std::path::{Path, PathBuf};

    use super::*;
    use crate::claims::CLAIMS;

    const TEXT: Prose = Prose::new(
        "# A title\n\nSource: talk\n\nOne\nline of *w*_{c}.\n\n## summary\n\nIt is {width} at\n*w*_{c}^{−{power}}.\n\n\
         ## table: widths\n\nAll\nof {what}.\n\n| *w* | *J* |\n\n## quantity: width\n\nwidth, {what}\n\n- symbol: *w*\n- unit: d\n",
    );

    #[test]
    fn sections_are_found_and_filled() {
        assert_eq!((TEXT.title(), TEXT.source()), ("A title", "talk"));
        assert_eq!(TEXT.statement(), "One line of *w*_{c}.");
        let summary = TEXT.text("summary", &[("width", &2.5), ("power", &"*b*")]);
        assert_eq!(summary, "It is 2.5 at *w*_{c}^{−*b*}.");
        let table = TEXT.table("widths", &[("what", &"it")], Vec::new());
        assert_eq!(
            (&*table.caption, table.head),
            ("All of it.", vec!["*w*".to_owned(), "*J*".to_owned()])
        );
        let quantity = TEXT.quantity("width", &[("what", &"fine")], Uncertain::normal(1.0, 0.1));
        assert_eq!(
            (&*quantity.name, &*quantity.unit, &*quantity.method),
            ("width, fine", "d", "")
        );
    }

    /// The source of a claim's code: its file, and those of its folder.
    fn code(id: &str) -> String {
        let claims = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/claims");
        let folder = fs::read_dir(claims.join(id)).into_iter().flatten();
        let mut files: Vec<PathBuf> = folder.map(|entry| entry.unwrap().path()).collect();
        files.push(claims.join(format!("{id}.rs")));
        let read = |file: &PathBuf| fs::read_to_string(file).unwrap();
        files.iter().map(read).collect()
    }

    /// The names of the values in the code of a call, from its opening bracket on.
    fn values(call: &str) -> Vec<&str> {
        let mut depth = 0;
        let mut closes = |c| {
            depth += i32::from(c == '(') - i32::from(c == ')');
            depth == 0
        };
        let call = &call[..call.find(&mut closes).unwrap_or(call.len())];
        let (_, values) = call.split_once("values!(").unwrap_or_default();
        let (mut depth, mut is_text, mut begin) = (0, false, 0);
        let mut names = Vec::new();
        for (at, c) in values.char_indices() {
            is_text ^= c == '"';
            match c {
                '(' | '[' => depth += 1,
                ')' | ']' if depth > 0 => depth -= 1,
                ',' | ')' if depth == 0 && !is_text => {
                    names.extend(values[begin..at].split('=').next().map(str::trim));
                    begin = at + 1;
                    if c == ')' {
                        break;
                    }
                }
                _ => {}
            }
        }
        names
    }

    /// Every section of every claim is asked for by its code with just its placeholders, and no other is.
    #[test]
    fn text_and_code_of_each_claim_belong_together() {
        for claim in CLAIMS {
            let code = code(&claim.id.to_lowercase()).replace("draft.", "PROSE.");
            // These are asked for by a draft and by `nothing`.
            let mut asked = vec!["nothing".to_owned()];
            for section in ["method", "weaknesses"] {
                if !claim.prose.plain(section).is_empty() {
                    asked.push(section.to_owned());
                }
            }
            for (method, kind) in [
                ("text", ""),
                ("paragraphs", ""),
                ("paragraph", ""),
                ("weakness", ""),
                ("table", "table: "),
                ("figure", "figure: "),
                ("chart", "figure: "),
                ("quantity", "quantity: "),
                ("compared", "quantity: "),
            ] {
                for (at, _) in code.match_indices(&format!("PROSE.{method}(")) {
                    let call = code[at..]
                        .split_once('(')
                        .map_or("", |_| &code[at + 6 + method.len()..]);
                    let name = call.split('"').nth(1).unwrap_or_default();
                    let section = format!("{kind}{name}");
                    let text = claim.prose.section(&section);
                    let mut wanted: Vec<&str> =
                        placeholders(text).iter().map(|one| one.2).collect();
                    let mut given = values(call);
                    for names in [&mut wanted, &mut given] {
                        names.sort_unstable();
                        names.dedup();
                    }
                    assert_eq!(wanted, given, "{}: {section}", claim.id);
                    asked.push(section);
                }
            }
            assert!(claim.prose.find("nothing").is_some(), "{}", claim.id);
            for section in claim.prose.markdown.split("\n## ").skip(1) {
                let name = section.lines().next().unwrap_or_default();
                assert!(asked.iter().any(|one| one == name), "{}: {name}", claim.id);
            }
        }
    }
}
