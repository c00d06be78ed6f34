//! Names of figures and contents of tables as files.

use std::collections::HashSet;

use crate::{Examination, Quantity, ReportFigure, ReportTable};
use peristalsis_analysis::Uncertain;
use peristalsis_formats::{FormatError, Table};

use crate::columns::Columns;
use crate::report::Report;
use crate::report::markup::plain_text;

/// The figures of all claims, each with the name of its files.
pub(crate) struct FigureFiles<'a> {
    /// Each file once.
    pub(crate) files: Vec<(String, &'a ReportFigure)>,
    /// For each claim, the place in `files` of each of its figures.
    pub(crate) places: Vec<Vec<usize>>,
}

/// Names every figure after itself; one that two claims show is one file, and of two with the same name the second gets a
/// number.
pub(crate) fn figure_files(examinations: &[Examination]) -> FigureFiles<'_> {
    let mut files: Vec<(String, &ReportFigure)> = Vec::new();
    let places = examinations.iter().map(|examination| {
        let figures = examination.finding.figures.iter();
        figures
            .map(|figure| {
                let name = plain_name(&figure.name);
                let mut numbered = name.clone();
                for number in 2.. {
                    match files.iter().position(|(other, _)| *other == numbered) {
                        Some(place) if files[place].1.drawing == figure.drawing => return place,
                        Some(_) => numbered = format!("{name}-{number}"),
                        None => break,
                    }
                }
                files.push((numbered, figure));
                files.len() - 1
            })
            .collect()
    });
    let places = places.collect();
    FigureFiles { files, places }
}

/// A name that is a file's name everywhere: letters, digits and hyphens.
pub(crate) fn plain_name(name: &str) -> String {
    let plain = name.to_ascii_lowercase();
    let plain = plain.replace(|letter: char| !letter.is_ascii_alphanumeric(), "-");
    if plain.is_empty() {
        "figure".to_owned()
    } else {
        plain
    }
}

/// Every table of the report with the name of its file: the quantities of all claims, then the tables of each.
pub(crate) fn table_files(report: &Report) -> Result<Vec<(String, Table)>, FormatError> {
    let mut files = Vec::new();
    let quantities = quantities(&report.examinations);
    if !quantities.is_empty() {
        files.push(("quantities.csv".to_owned(), quantity_table(&quantities)?));
    }
    for examination in &report.examinations {
        let names = table_names(examination).into_iter();
        for (name, table) in names.zip(&examination.finding.tables) {
            if let Some(name) = name {
                files.push((name, plain_table(table)?));
            }
        }
    }
    Ok(files)
}

/// Names of the files of a claim's tables, in their order; none for a table without columns.
pub(crate) fn table_names(examination: &Examination) -> Vec<Option<String>> {
    let claim = plain_name(examination.experiment.id);
    let mut number = 0;
    let tables = examination.finding.tables.iter();
    tables
        .map(|table| {
            (!table.head.is_empty()).then(|| {
                number += 1;
                format!("{claim}-{number}.csv")
            })
        })
        .collect()
}

/// A quantity with the name of its claim.
type ClaimQuantity<'a> = (&'a str, &'a Quantity);

fn quantities(examinations: &[Examination]) -> Vec<ClaimQuantity<'_>> {
    let mut all = Vec::new();
    for one in examinations {
        let id = one.experiment.id;
        all.extend(one.finding.quantities.iter().map(|quantity| (id, quantity)));
    }
    all
}

fn quantity_table(quantities: &[ClaimQuantity<'_>]) -> Result<Table, FormatError> {
    // Open ends of intervals are missing values, as in the JSON file.
    let finite = |value: f64| if value.is_finite() { value } else { f64::NAN };
    let ours = |of: fn(&Uncertain) -> f64| {
        move |(_, quantity): &ClaimQuantity<'_>| finite(quantity.ours.as_ref().map_or(f64::NAN, of))
    };
    let text = |of: fn(&Quantity) -> &String| {
        move |(_, quantity): &ClaimQuantity<'_>| plain_cell(of(quantity))
    };
    let source = |(_, quantity): &ClaimQuantity<'_>| finite(quantity.source.unwrap_or(f64::NAN));
    Columns::of(quantities)
        .word("claim", "", |(claim, _)| (*claim).to_owned())
        .word("quantity", "", text(|quantity| &quantity.name))
        .word("symbol", "", text(|quantity| &quantity.symbol))
        .word("unit", "", text(|quantity| &quantity.unit))
        .number("source", "", "", source)
        .number("value", "", "", ours(|ours| ours.value))
        .number("error", "", "", ours(|ours| ours.error))
        .number("lower_68", "", "", ours(|ours| ours.interval_68.lower))
        .number("upper_68", "", "", ours(|ours| ours.interval_68.upper))
        .number("lower_95", "", "", ours(|ours| ours.interval_95.lower))
        .number("upper_95", "", "", ours(|ours| ours.interval_95.upper))
        .word("method", "", text(|quantity| &quantity.method))
        .table()
}

/// A table of the report with texts for cells.
fn plain_table(table: &ReportTable) -> Result<Table, FormatError> {
    let mut taken = HashSet::new();
    let mut columns = Columns::of(&table.rows);
    for (place, head) in table.head.iter().enumerate() {
        let mut name = plain_cell(head);
        if name.is_empty() {
            name = format!("column {}", place + 1);
        }
        while !taken.insert(name.clone()) {
            name.push('\'');
        }
        columns = columns.word(&name, "", |row| {
            let cell = row.get(place);
            cell.map_or_else(String::new, |cell| plain_cell(cell))
        });
    }
    columns.table()
}

/// A cell without markup, its minus signs as programs read them.
fn plain_cell(markup: &str) -> String {
    plain_text(markup).replace('−', "-")
}

#[cfg(test)]
mod tests {
    use super::*;
    use peristalsis_formats::csv;

    #[test]
    fn tables_are_plain_text_with_a_name_for_every_column() {
        let table = ReportTable {
            caption: String::new(),
            head: ["*w*_c", "", "*w*_{c}"].map(str::to_owned).to_vec(),
            rows: vec![
                ["−2.5", "a, \"b\"", "*x*"].map(str::to_owned).to_vec(),
                vec!["short".to_owned()],
            ],
        };
        assert_eq!(
            csv::encode(&plain_table(&table).unwrap()),
            "w_c,\"column 2\",\"w_c'\"\n\"-2.5\",\"a, \"\"b\"\"\",\"x\"\n\"short\",\"\",\"\"\n"
        );
    }

    #[test]
    fn names_of_files_lead_nowhere_else() {
        assert_eq!(plain_name("../F3 collapse"), "---f3-collapse");
        assert_eq!(plain_name(""), "figure");
    }
}
