//! The page of the book that lists all columns, from the tables of quantities.
//!
//! `GOLDEN=write cargo test -p peristalsis-study --test study quantities` writes it anew.

use std::path::Path;

use peristalsis_observe::{COLUMNS, PROFILE, Quantity, WAVES};

const PAGE: &str = "docs/book/src/reference/quantities.md";

fn rows<'a, Of: 'static>(quantities: impl IntoIterator<Item = &'a Quantity<Of>>) -> String {
    let headings = quantities.into_iter().flat_map(|quantity| {
        let headings = quantity.headings().into_iter();
        headings.map(|(name, text)| row(&name, quantity.unit, text))
    });
    headings.collect()
}

fn row(name: &str, unit: &str, text: &str) -> String {
    format!("| `{name}` | {unit} | {} |\n", text.replace('|', "\\|"))
}

fn page() -> String {
    let head = "| column | unit | meaning |\n|---|---|---|\n";
    let outcome: String = peristalsis_run::row_columns()
        .iter()
        .map(|column| row(&column.name, column.unit, column.text))
        .collect();
    format!(
        "# Reference: columns and numbers\n\n\
         Units are d, m and t; `1` is a pure number. \"Late\" is the last part of a run. A missing number is `null`.\n\n\
         ## The outcome of a run\n\n\
         The rows of a study have these columns, besides `identity`, `replicate` and one for each \
         axis, named by its key. `summary.json` has the measured ones as keys, some in objects of their own: `throat_density` \
         is `density` in `throat`, `pumping_efficiency` is `efficiency` in `pumping`. The times at other thresholds are its \
         list `transition_times`. What describes the tube (`width` to `rings_per_wave`, `initial_state`) stands in \
         `config.toml`.\n\n{head}{outcome}\n\
         ## The time series\n\n\
         Columns of friction, of rolling resistance, of cohesion, of an elastic wall, of a body force, of an open tube, of mixing (periodic tubes) and of segregation (several sizes) are there in runs that have these.\n\n{head}{}\n\
         ## The profile in the wave frame\n\n{head}{}\n\
         ## The flow wave by wave\n\n{head}{}",
        rows(COLUMNS.iter().map(|column| &column.quantity)),
        rows(PROFILE),
        rows(WAVES)
    )
}

#[test]
fn the_page_of_quantities_is_that_of_the_tables() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../..")
        .join(PAGE);
    if std::env::var_os("GOLDEN").is_some_and(|value| value == "write") {
        std::fs::write(&path, page()).unwrap();
    }
    assert!(std::fs::read_to_string(&path).unwrap() == page(), "{PAGE}");
}
