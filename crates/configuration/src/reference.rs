//! The reference of keys, made from their schema, for people.

use serde_json::Value;

use crate::presets::Preset;
use crate::schema::joined;

/// All keys of a [schema](crate::schema) as Markdown: one section per table, one row per key, with its meaning, the
/// allowed values and the default, or else what `presets` give.
///
/// `leave_out` names tables that are described elsewhere. Rows are in the order of their names.
pub fn reference(schema: &Value, leave_out: &[&str], presets: &[Preset]) -> String {
    let mut pages = String::new();
    section(&mut pages, "", schema, leave_out, presets);
    pages
}

/// The keys of one table, then the tables in it.
fn section(pages: &mut String, path: &str, table: &Value, leave_out: &[&str], presets: &[Preset]) {
    let Some(properties) = table["properties"].as_object() else {
        return;
    };
    let (tables, keys): (Vec<_>, Vec<_>) = properties
        .iter()
        .filter(|(name, _)| !leave_out.contains(&name.as_str()))
        .partition(|(_, key)| key.get("properties").is_some());
    if !path.is_empty() {
        *pages += &format!("## [{path}]\n\n");
    }
    *pages += &format!("{}\n\n", description(table));
    if !keys.is_empty() {
        *pages += "| key | meaning | allowed | default |\n|---|---|---|---|\n";
        keys.iter()
            .for_each(|(name, key)| *pages += &row(path, name, key, presets));
        *pages += "\n";
    }
    for (name, key) in &keys {
        for inner in inner_tables(key) {
            *pages += &format!("### Tables of {}\n\n", joined(path, name));
            section(pages, "", inner, &[], presets);
        }
    }
    for (name, inner) in tables {
        section(pages, &joined(path, name), inner, &[], presets);
    }
}

fn row(path: &str, name: &str, key: &Value, presets: &[Preset]) -> String {
    let mut meaning = description(key);
    for choice in choices(key) {
        if let (Some(word), Some(text)) = (choice["const"].as_str(), choice["description"].as_str())
        {
            meaning += &format!("<br>`{word}`: {text}");
        }
    }
    let (name, default) = (
        format!("`{name}`"),
        default(&joined(path, name), key, presets),
    );
    let cells = [name, meaning, allowed(key), default].map(|cell| cell.replace('|', "\\|"));
    format!("| {} |\n", cells.join(" | "))
}

/// Tables that a key may hold, alone or in lists.
fn inner_tables(key: &Value) -> Vec<&Value> {
    let mut tables = alternatives(key);
    tables.push(&key["items"]);
    tables.retain(|branch| branch.get("properties").is_some());
    tables
}

fn alternatives(key: &Value) -> Vec<&Value> {
    let lists = ["anyOf", "oneOf"].into_iter();
    let lists = lists.filter_map(|name| key.get(name)?.as_array());
    lists.flatten().collect()
}

/// The words that a key takes, each with its meaning.
fn choices(key: &Value) -> Vec<&Value> {
    let mut found = Vec::new();
    for branch in alternatives(key) {
        if branch.get("const").is_some() {
            found.push(branch);
        } else {
            found.extend(choices(branch));
        }
    }
    found
}

/// Kind and range of a key in words.
fn allowed(key: &Value) -> String {
    if let Some(names) = key["enum"].as_array() {
        return list(names);
    }
    let words = choices(key).into_iter().map(|choice| &choice["const"]);
    let words = list(words);
    match (words.as_str(), inner_tables(key).is_empty()) {
        ("", true) => {}
        ("", false) => return "tables as below".to_owned(),
        (_, true) => return words,
        (_, false) => return format!("{words}, or tables as below"),
    }
    let kinds: Vec<String> = alternatives(key).into_iter().map(allowed).collect();
    if !kinds.is_empty() {
        return kinds.join(", ");
    }
    let kind = match key["type"].as_str() {
        Some("boolean") => return "`true`, `false`".to_owned(),
        Some("array") => return format!("a list: {}", allowed(&key["items"])),
        Some("integer") => "whole number",
        Some("number") => "number",
        Some("string") => "text",
        _ => "",
    };
    let bounds = [
        ("exclusiveMinimum", "above"),
        ("minimum", "from"),
        ("exclusiveMaximum", "below"),
        ("maximum", "to"),
    ];
    let bounds = bounds
        .iter()
        .filter_map(|(name, word)| Some(format!(" {word} {}", number(key.get(name)?))));
    kind.to_owned() + &bounds.collect::<String>()
}

/// The default, else what the presets give.
fn default(path: &str, key: &Value, presets: &[Preset]) -> String {
    if let Some(value) = key.get("default") {
        return format!("`{}`", number(value));
    }
    let given = presets.iter().filter_map(|preset| {
        let table: toml::Value = toml::from_str(preset.text).ok()?;
        let value = path
            .split('.')
            .try_fold(&table, |table, name| table.get(name))?;
        Some(format!("{}: `{value}`", preset.name))
    });
    given.collect::<Vec<_>>().join("<br>")
}

fn list<'a>(words: impl IntoIterator<Item = &'a Value>) -> String {
    let words = words.into_iter().map(|word| format!("`{word}`"));
    words.collect::<Vec<_>>().join(", ")
}

/// A value as TOML has it, large numbers in powers of ten.
fn number(value: &Value) -> String {
    match value.as_f64() {
        Some(number) if number.abs() >= 1e5 => format!("{number:e}"),
        Some(number) => format!("{number}"),
        None => value.to_string(),
    }
}

fn description(value: &Value) -> String {
    let text = value["description"].as_str().unwrap_or_default();
    text.replace('\n', " ").replace('<', "&lt;")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_key_of_the_schema_has_a_row() {
        let schema = crate::schema();
        let pages = reference(&schema, &["resolved"], crate::PRESETS);
        let known = &*crate::schema::KNOWN_KEYS;
        assert!(known.len() > 60);
        for path in known.iter().filter(|path| *path != "resolved") {
            let name = path.rsplit('.').next().unwrap();
            let has_row = pages.contains(&format!("| `{name}` |"));
            assert!(has_row || pages.contains(&format!("## [{path}]")), "{path}");
        }
        for line in [
            "## [wall.keep]",
            "| `radius` | Radius a of the tube, to the centres of the wall spheres",
            "frictional: `3.5`",
            "`printed`: As the talk prints it",
            "whole number from 1 to 1e6 | `20`",
            "### Tables of drive.schedule",
        ] {
            assert!(pages.contains(line), "{line}\n{pages}");
        }
    }
}
