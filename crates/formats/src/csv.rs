//! CSV: the values of a [`Table`] as text, for eyes, spreadsheets and other programs.
//!
//! One header row of names, then one row a record, separated by commas and line feeds, as RFC 4180 has it. Reals are
//! written with the fewest digits that read back to the same bits and always with a point, an exponent, `inf` or `NaN`;
//! text is always quoted. A field thus tells its kind, and the values come back as they were. Units, descriptions and
//! metadata are not in the file.

use std::borrow::Cow;
use std::fs;
use std::path::Path;

use crate::atomic;
use crate::error::FormatError;
use crate::table::{Column, Table, Values};

/// The values of a table as CSV text.
pub fn encode(table: &Table) -> String {
    let mut text = String::new();
    let mut push_row = |field: &dyn Fn(&Column) -> String| {
        let fields: Vec<String> = table.columns().iter().map(field).collect();
        text.push_str(&fields.join(","));
        text.push('\n');
    };
    push_row(&|column| {
        let is_plain = |letter: char| letter.is_ascii_alphanumeric() || letter == '_';
        match column.name.chars().all(is_plain) {
            true => column.name.clone(),
            false => quoted(&column.name),
        }
    });
    // Most readers skip an empty line, so a lone missing value cannot be an empty field.
    let missing = match table.columns().len() {
        1 => "NaN",
        _ => "",
    };
    for row in 0..table.rows() {
        push_row(&|column| match &column.values {
            Values::Real(values) if values[row].is_nan() => missing.to_owned(),
            Values::Real(values) => format!("{:?}", values[row]),
            Values::Integer(values) => values[row].to_string(),
            Values::Boolean(values) => values[row].to_string(),
            Values::Text(values) => quoted(&values[row]),
        });
    }
    text
}

/// The table in CSV text, with empty units, descriptions and metadata.
///
/// A column is text if any of its fields is quoted or none of the following fits: integers if every field is one,
/// booleans if every field is `true` or `false` (or as Python writes them, `True` or `False`), reals if every field is a number or empty. A column without rows, or
/// with empty fields only, is taken for reals.
///
/// # Errors
/// [`FormatError::Csv`] with the line, [`FormatError::DuplicateColumn`], [`FormatError::UnnamedColumn`].
pub fn decode(text: &str) -> Result<Table, FormatError> {
    let mut scanner = Scanner {
        rest: text.strip_prefix('\u{feff}').unwrap_or(text),
        line: 1,
    };
    let names = scanner.record()?.ok_or(FormatError::Csv {
        line: 1,
        reason: "there is no header row".into(),
    })?;
    let mut columns: Vec<Vec<Field<'_>>> = names.iter().map(|_| Vec::new()).collect();
    let mut line = scanner.line;
    while let Some(record) = scanner.record()? {
        if record.len() != columns.len() {
            let (found, named) = (record.len(), columns.len());
            let reason = format!("{found} fields under {named} column names");
            return Err(FormatError::Csv { line, reason });
        }
        for (column, field) in columns.iter_mut().zip(record) {
            column.push(field);
        }
        line = scanner.line;
    }
    let mut builder = Table::builder();
    for (name, fields) in names.into_iter().zip(columns) {
        builder = builder.column(name.text, "", "", values_of(fields));
    }
    builder.build()
}

/// Writes the values of a table to a CSV file, whole or not at all.
///
/// # Errors
/// As [`atomic::write`](fn@atomic::write).
pub fn write(path: &Path, table: &Table) -> Result<(), FormatError> {
    atomic::write(path, encode(table).as_bytes())
}

/// Reads a table from a CSV file; see [`decode`].
///
/// # Errors
/// As [`decode`], and [`FormatError::Io`], with [`std::io::ErrorKind::InvalidData`] where the file is not UTF-8.
pub fn read(path: &Path) -> Result<Table, FormatError> {
    decode(&fs::read_to_string(path).map_err(FormatError::io("read", path))?)
}

fn quoted(value: &str) -> String {
    format!("\"{}\"", value.replace('"', "\"\""))
}

fn values_of(fields: Vec<Field<'_>>) -> Values {
    if fields.is_empty() {
        return Values::Real(Vec::new());
    }
    let real = |text: &str| match text {
        "" => Some(f64::NAN),
        text => text.parse().ok(),
    };
    let is_text = fields.iter().any(|field| field.quoted);
    let found = (!is_text).then(|| {
        (parsed(&fields, |text| text.parse().ok()).map(Values::Integer))
            .or_else(|| parsed(&fields, boolean).map(Values::Boolean))
            .or_else(|| parsed(&fields, real).map(Values::Real))
    });
    found.flatten().unwrap_or_else(|| {
        let texts = fields.into_iter().map(|field| field.text.into_owned());
        Values::Text(texts.collect())
    })
}

/// As this program writes it, or Python.
fn boolean(text: &str) -> Option<bool> {
    match text {
        "true" | "True" => Some(true),
        "false" | "False" => Some(false),
        _ => None,
    }
}

/// The values of all fields, if every one of them has one.
fn parsed<T>(fields: &[Field<'_>], value: impl Fn(&str) -> Option<T>) -> Option<Vec<T>> {
    fields.iter().map(|field| value(&field.text)).collect()
}

struct Field<'text> {
    text: Cow<'text, str>,
    quoted: bool,
}

struct Scanner<'text> {
    rest: &'text str,
    /// Line on which `rest` begins, counted from 1.
    line: usize,
}

impl<'text> Scanner<'text> {
    /// The fields of the next record; none at the end of the text.
    fn record(&mut self) -> Result<Option<Vec<Field<'text>>>, FormatError> {
        if self.rest.is_empty() {
            return Ok(None);
        }
        let mut fields = Vec::new();
        loop {
            let quoted = self.rest.starts_with('"');
            let text = match quoted {
                true => self.quoted()?,
                false => self.plain()?.into(),
            };
            let is_last = self.separator()?;
            self.line += text.matches('\n').count() + usize::from(is_last);
            fields.push(Field { text, quoted });
            if is_last {
                return Ok(Some(fields));
            }
        }
    }

    fn plain(&mut self) -> Result<&'text str, FormatError> {
        let length = self.rest.find([',', '\n']).unwrap_or(self.rest.len());
        let (text, rest) = self.rest.split_at(length);
        if text.contains('"') {
            return Err(self.error("a quotation mark inside a field that is not quoted"));
        }
        self.rest = rest;
        Ok(match rest.starts_with(',') {
            true => text,
            false => text.strip_suffix('\r').unwrap_or(text),
        })
    }

    fn quoted(&mut self) -> Result<Cow<'text, str>, FormatError> {
        let mut text = Cow::Borrowed("");
        let mut rest = &self.rest[1..];
        loop {
            let end = rest.find('"');
            let length = end.ok_or_else(|| self.error("a quoted field is not closed"))?;
            text += &rest[..length];
            rest = &rest[length + 1..];
            match rest.strip_prefix('"') {
                Some(after) => {
                    text += "\"";
                    rest = after;
                }
                None => {
                    self.rest = rest;
                    return Ok(text);
                }
            }
        }
    }

    /// Passes over what stands behind a field; answers whether the record ends there.
    fn separator(&mut self) -> Result<bool, FormatError> {
        if let Some(rest) = self.rest.strip_prefix(',') {
            self.rest = rest;
            return Ok(false);
        }
        let rest = self.rest.strip_prefix('\r').unwrap_or(self.rest);
        match rest.strip_prefix('\n') {
            Some(rest) => self.rest = rest,
            None if self.rest.is_empty() => {}
            None => return Err(self.error("text follows the closing quotation mark")),
        }
        Ok(true)
    }

    fn error(&self, reason: &str) -> FormatError {
        FormatError::Csv {
            line: self.line,
            reason: reason.into(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn strings(values: &[&str]) -> Values {
        Values::Text(values.iter().map(ToString::to_string).collect())
    }

    fn table(columns: &[(&str, Values)]) -> Table {
        columns
            .iter()
            .fold(Table::builder(), |builder, (name, values)| {
                builder.column(*name, "", "", values.clone())
            })
            .build()
            .unwrap()
    }

    #[test]
    fn the_text_is_what_a_spreadsheet_expects() {
        let table = Table::builder()
            .column("time", "t", "Time.", Values::Real(vec![0.0, 0.1, 1e-300]))
            .column(
                "a, \"b\"",
                "",
                "Text.",
                strings(&["x", "1,2\n3", "say \"so\""]),
            )
            .column(
                "contacts",
                "",
                "Count.",
                Values::Integer(vec![-3, 0, i64::MAX]),
            )
            .column(
                "flow_rate",
                "t^-1",
                "Flow.",
                Values::Real(vec![f64::NAN, f64::NEG_INFINITY, -0.0]),
            )
            .column(
                "censored",
                "",
                "Flag.",
                Values::Boolean(vec![true, false, true]),
            )
            .build()
            .unwrap();
        let expected = "time,\"a, \"\"b\"\"\",contacts,flow_rate,censored\n\
                        0.0,\"x\",-3,,true\n\
                        0.1,\"1,2\n3\",0,-inf,false\n\
                        1e-300,\"say \"\"so\"\"\",9223372036854775807,-0.0,true\n";
        assert_eq!(encode(&table), expected);
        let back = decode(expected).unwrap();
        for (written, read) in table.columns().iter().zip(back.columns()) {
            assert_eq!((&written.name, &written.values), (&read.name, &read.values));
        }
    }

    #[test]
    fn a_lone_missing_value_is_not_an_empty_line() {
        let lone = table(&[("a", Values::Real(vec![1.0, f64::NAN]))]);
        assert_eq!(encode(&lone), "a\n1.0\nNaN\n");
        assert_eq!(decode(&encode(&lone)).unwrap(), lone);
        let lone = table(&[("a", strings(&["", "x"]))]);
        assert_eq!(decode(&encode(&lone)).unwrap(), lone);
    }

    #[test]
    fn foreign_habits_are_read() {
        let expected = table(&[
            ("a", Values::Integer(vec![1, 2])),
            ("b c", strings(&["x", "7"])),
            ("d", Values::Real(vec![0.5, 3.0])),
            ("e", Values::Real(vec![f64::NAN, f64::NAN])),
        ]);
        assert_eq!(
            decode("\u{feff}a,b c,d,e\r\n1,\"x\",.5,\r\n2,7,3,").unwrap(),
            expected
        );
        assert_eq!(
            decode("a,b\n").unwrap(),
            table(&[("a", Values::Real(vec![])), ("b", Values::Real(vec![]))])
        );
    }

    #[test]
    fn malformed_text_is_refused_with_its_line() {
        for (text, expected_line) in [
            ("", 1),
            ("a,b\n1,2\n3\n", 3),
            ("a,b\n\"x\ny\",2\n3\n", 4),
            ("a\nx\"y\n", 2),
            ("a,b\n1,\"open\n", 2),
            ("a\n\"x\"y\n", 2),
        ] {
            match decode(text) {
                Err(FormatError::Csv { line, .. }) => assert_eq!(line, expected_line, "{text:?}"),
                other => panic!("{text:?}: {other:?}"),
            }
        }
        assert_refused!(decode("a,a\n1,2\n") => DuplicateColumn { .. });
        assert_refused!(decode("a,\n1,2\n") => UnnamedColumn(1));
    }

    #[test]
    fn a_file_is_written_and_read() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("table.csv");
        let table = table(&[("a", Values::Real(vec![0.1])), ("b", strings(&["ü"]))]);
        write(&path, &table).unwrap();
        assert_eq!(read(&path).unwrap(), table);
        std::fs::write(&path, b"a\n\xff\n").unwrap();
        assert!(matches!(
            read(&path),
            Err(FormatError::Io { source, .. }) if source.kind() == std::io::ErrorKind::InvalidData
        ));
    }
}
