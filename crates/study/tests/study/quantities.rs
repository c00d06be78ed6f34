//! The page of the book that lists all columns, from the tables of quantities.
//!
//! `UPDATE_EXPECT=1 cargo test -p peristalsis-study --test study quantities` writes it anew.

use expect_test::expect_file;
use peristalsis_observe::{COLUMNS, PROFILE, Quantity, WAVES};

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

/// The keys that are no columns, and those that are but have another name there.
fn keys_of_a_summary() -> String {
    let columns = peristalsis_run::row_columns();
    let is_column = |key: &str| columns.iter().any(|column| column.name == key);
    let keys = peristalsis_run::summary_keys();
    let others = keys.iter().filter(|it| !is_column(&it.key));
    others
        .map(|it| row(&it.key, it.column.unit, it.column.text))
        .collect()
}

/// What is no single number.
fn parts_of_a_summary() -> String {
    let schema = peristalsis_run::summary_schema();
    let parts = schema.get("properties").and_then(|it| it.as_object());
    let described = parts.into_iter().flatten();
    described
        .map(|(key, part)| row(key, "", part["description"].as_str().unwrap_or_default()))
        .collect()
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
         list `transition_times`. What describes the tube (`width` to `rings_per_wave`, but for `grains`) and `initial_state` \
         stand in `config.toml`.\n\n{head}{outcome}\n\
         ## Other keys of `summary.json`\n\n\
         Some of them are columns under another name.\n\n| key | unit | meaning |\n|---|---|---|\n{}{}\n\
         ## The time series\n\n\
         Columns of friction, of rolling resistance, of cohesion, of an elastic wall, of a body force, of an open tube, of mixing (periodic tubes) and of segregation (several sizes) are there in runs that have these.\n\n{head}{}\n\
         ## The profile in the wave frame\n\n{head}{}\n\
         ## The flow wave by wave\n\n{head}{}",
        keys_of_a_summary(),
        parts_of_a_summary(),
        rows(COLUMNS.iter().map(|column| &column.quantity)),
        rows(PROFILE),
        rows(WAVES)
    )
}

#[test]
fn the_page_of_quantities_is_that_of_the_tables() {
    expect_file!["../../../../docs/book/src/reference/quantities.md"].assert_eq(&page());
}
