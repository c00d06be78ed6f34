//! Names of figures and contents of tables as files.

use std::collections::HashSet;

use crate::{Examination, Quantity, ReportFigure, ReportTable};
use peristalsis_analysis::Interval;
use peristalsis_formats::{Column, FormatError, Table, Values};

use crate::report::Report;
use crate::report::markup::plain_text;

/// The figures of all claims, each with the name of its files.
pub(crate) struct FigureFiles<'a> {
    files: Vec<(String, &'a ReportFigure)>,
    /// For each claim, the place in `files` of each of its figures.
    places: Vec<Vec<usize>>,
}

impl<'a> FigureFiles<'a> {
    pub(crate) fn is_empty(&self) -> bool {
        self.files.is_empty()
    }

    /// Each file once.
    pub(crate) fn files(&self) -> impl Iterator<Item = (&str, &'a ReportFigure)> {
        self.files.iter().map(|(name, figure)| (&**name, *figure))
    }

    /// Names of the files of a claim's figures, in their order.
    pub(crate) fn names_of(&self, claim: usize) -> impl Iterator<Item = &str> {
        self.places[claim]
            .iter()
            .map(|place| &*self.files[*place].0)
    }
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
                let mut number = 1;
                loop {
                    match files.iter().position(|(other, _)| *other == numbered) {
                        Some(place) if files[place].1.drawing == figure.drawing => return place,
                        Some(_) => {
                            number += 1;
                            numbered = format!("{name}-{number}");
                        }
                        None => {
                            files.push((numbered, figure));
                            return files.len() - 1;
                        }
                    }
                }
            })
            .collect()
    });
    let places = places.collect();
    FigureFiles { files, places }
}

/// A name that is a file's name everywhere: letters, digits and hyphens.
pub(crate) fn plain_name(name: &str) -> String {
    let plain: String = name
        .chars()
        .map(|letter| {
            if letter.is_ascii_alphanumeric() {
                letter.to_ascii_lowercase()
            } else {
                '-'
            }
        })
        .collect();
    if plain.is_empty() {
        "figure".to_owned()
    } else {
        plain
    }
}

/// Every table of the report with the name of its file: the quantities of all claims, then the tables of each.
pub(crate) fn table_files(report: &Report) -> Result<Vec<(String, Table)>, FormatError> {
    let mut files = Vec::new();
    if report
        .examinations
        .iter()
        .any(|examination| !examination.finding.quantities.is_empty())
    {
        files.push((
            "quantities.csv".to_owned(),
            quantities(&report.examinations)?,
        ));
    }
    for examination in &report.examinations {
        let tables = examination.finding.tables.iter();
        for (number, table) in tables.filter(|table| !table.head.is_empty()).enumerate() {
            let claim = plain_name(examination.claim.id);
            files.push((format!("{claim}-{}.csv", number + 1), plain_table(table)?));
        }
    }
    Ok(files)
}

/// Names of the files of a claim's tables, in their order; none for a table without columns.
pub(crate) fn table_names(examination: &Examination) -> Vec<Option<String>> {
    let claim = plain_name(examination.claim.id);
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

fn quantities(examinations: &[Examination]) -> Result<Table, FormatError> {
    let rows: Vec<(&str, &Quantity)> = examinations
        .iter()
        .flat_map(|examination| {
            let id = examination.claim.id;
            examination
                .finding
                .quantities
                .iter()
                .map(move |quantity| (id, quantity))
        })
        .collect();
    let texts =
        |of: &dyn Fn(&(&str, &Quantity)) -> String| Values::Text(rows.iter().map(of).collect());
    // Open ends of intervals are missing values, as in the JSON file.
    let finite = |value: f64| if value.is_finite() { value } else { f64::NAN };
    let reals = |of: &dyn Fn(&Quantity) -> Option<f64>| {
        let values = rows
            .iter()
            .map(|(_, quantity)| of(quantity).map_or(f64::NAN, finite));
        Values::Real(values.collect())
    };
    let ours = |of: fn(&peristalsis_analysis::Uncertain) -> f64| {
        reals(&move |quantity: &Quantity| quantity.ours.as_ref().map(of))
    };
    let narrow = |of: fn(&Interval) -> f64| {
        reals(&move |quantity: &Quantity| quantity.ours.as_ref().map(|ours| of(&ours.interval_68)))
    };
    let wide = |of: fn(&Interval) -> f64| {
        reals(&move |quantity: &Quantity| quantity.ours.as_ref().map(|ours| of(&ours.interval_95)))
    };
    let columns = [
        ("claim", texts(&|(id, _)| (*id).to_owned())),
        (
            "quantity",
            texts(&|(_, quantity)| plain_cell(&quantity.name)),
        ),
        (
            "symbol",
            texts(&|(_, quantity)| plain_cell(&quantity.symbol)),
        ),
        ("unit", texts(&|(_, quantity)| plain_cell(&quantity.unit))),
        ("source", reals(&|quantity| quantity.source)),
        ("value", ours(|ours| ours.value)),
        ("error", ours(|ours| ours.error)),
        ("lower_68", narrow(|interval| interval.lower)),
        ("upper_68", narrow(|interval| interval.upper)),
        ("lower_95", wide(|interval| interval.lower)),
        ("upper_95", wide(|interval| interval.upper)),
        (
            "method",
            texts(&|(_, quantity)| plain_cell(&quantity.method)),
        ),
    ];
    Table::builder()
        .columns(columns.map(|(name, values)| column(name, values)))
        .build()
}

/// A table of the report with texts for cells.
fn plain_table(table: &ReportTable) -> Result<Table, FormatError> {
    let mut taken = HashSet::new();
    let columns = table.head.iter().enumerate().map(|(place, head)| {
        let name = plain_cell(head);
        let mut name = if name.is_empty() {
            format!("column {}", place + 1)
        } else {
            name
        };
        while !taken.insert(name.clone()) {
            name.push('\'');
        }
        let cells = table.rows.iter().map(|row| {
            row.get(place)
                .map_or_else(String::new, |cell| plain_cell(cell))
        });
        column(name, Values::Text(cells.collect()))
    });
    Table::builder().columns(columns).build()
}

/// A column that says all in its name.
fn column(name: impl Into<String>, values: Values) -> Column {
    Column {
        name: name.into(),
        unit: String::new(),
        description: String::new(),
        values,
    }
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
