//! The reference of keys, made from their schema, for people.

use std::fmt::Write as _;

use serde_json::{Map, Value};

use crate::presets::PRESETS;

/// All keys of a [schema](crate::schema) as Markdown: a section a table, a row a key, with what it means, what is
/// allowed, and its default.
///
/// `leave_out` names tables that are described elsewhere. Rows are in the order of their names.
#[must_use]
pub fn reference(schema: &Value, leave_out: &[&str]) -> String {
    let mut pages = String::new();
    section(&mut pages, "", schema, leave_out);
    pages
}

/// The keys of one table, then the tables in it.
fn section(pages: &mut String, path: &str, table: &Value, leave_out: &[&str]) {
    let Some(properties) = table["properties"].as_object() else {
        return;
    };
    let (tables, keys): (Vec<_>, Vec<_>) = properties
        .iter()
        .filter(|(name, _)| !leave_out.contains(&name.as_str()))
        .partition(|(_, key)| key.get("properties").is_some());
    if !path.is_empty() {
        line(pages, &format!("## [{path}]\n"));
    }
    line(pages, &format!("{}\n", description(table)));
    if !keys.is_empty() {
        line(pages, "| key | meaning | allowed | default |");
        line(pages, "|---|---|---|---|");
        for (name, key) in &keys {
            row(pages, path, name, key);
        }
        line(pages, "");
    }
    for (name, key) in &keys {
        for inner in inner_tables(key) {
            line(pages, &format!("### Tables of {}\n", dotted(path, name)));
            section(pages, "", inner, &[]);
        }
    }
    for (name, inner) in tables {
        section(pages, &dotted(path, name), inner, &[]);
    }
}

fn row(pages: &mut String, path: &str, name: &str, key: &Value) {
    let mut meaning = description(key);
    for choice in choices(key) {
        if let (Some(word), Some(text)) = (choice["const"].as_str(), choice["description"].as_str())
        {
            let _ = write!(meaning, "<br>`{word}`: {text}");
        }
    }
    let cells = [
        format!("`{name}`"),
        meaning,
        allowed(key),
        default(&dotted(path, name), key),
    ];
    let cells = cells.map(|cell| cell.replace('|', "\\|"));
    line(pages, &format!("| {} |", cells.join(" | ")));
}

/// Tables that a key may hold, alone or in lists.
fn inner_tables(key: &Value) -> Vec<&Value> {
    let lists = [&key["items"]];
    let branches = alternatives(key).into_iter();
    branches
        .chain(lists)
        .filter(|branch| branch.get("properties").is_some())
        .collect()
}

fn alternatives(key: &Value) -> Vec<&Value> {
    ["anyOf", "oneOf"]
        .iter()
        .filter_map(|name| key.get(name)?.as_array())
        .flatten()
        .collect()
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
    let words: Vec<Value> = choices(key)
        .iter()
        .map(|choice| choice["const"].clone())
        .collect();
    let tables = if inner_tables(key).is_empty() {
        None
    } else {
        Some("tables as below".to_owned())
    };
    if !words.is_empty() {
        return [Some(list(&words)), tables]
            .into_iter()
            .flatten()
            .collect::<Vec<_>>()
            .join(", or ");
    }
    if let Some(tables) = tables {
        return tables;
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
fn default(path: &str, key: &Value) -> String {
    if let Some(value) = key.get("default") {
        return format!("`{}`", number(value));
    }
    let given: Vec<String> = PRESETS
        .iter()
        .filter_map(|preset| {
            let table: toml::Table = toml::from_str(preset.text).ok()?;
            let value = path
                .split('.')
                .try_fold(&toml::Value::Table(table), |place, name| place.get(name))
                .cloned()?;
            Some(format!("{}: `{value}`", preset.name))
        })
        .collect();
    given.join("<br>")
}

fn list(words: &[Value]) -> String {
    let words: Vec<String> = words.iter().map(|word| format!("`{word}`")).collect();
    words.join(", ")
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
    let object: Option<&Map<String, Value>> = value.as_object();
    let text = object.and_then(|object| object.get("description")?.as_str());
    text.unwrap_or_default()
        .replace('\n', " ")
        .replace('<', "&lt;")
}

fn dotted(path: &str, name: &str) -> String {
    if path.is_empty() {
        name.to_owned()
    } else {
        format!("{path}.{name}")
    }
}

fn line(pages: &mut String, text: &str) {
    pages.push_str(text);
    pages.push('\n');
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_key_of_the_schema_has_a_row() {
        let schema = crate::schema();
        let pages = reference(&schema, &["resolved"]);
        fn keys(table: &Value, found: &mut Vec<String>) {
            for (name, key) in table["properties"].as_object().into_iter().flatten() {
                match key.get("properties") {
                    Some(_) => keys(key, found),
                    None => found.push(name.clone()),
                }
            }
        }
        let mut found = Vec::new();
        keys(&schema, &mut found);
        assert!(found.len() > 60);
        for key in found.iter().filter(|key| *key != "resolved") {
            assert!(pages.contains(&format!("| `{key}` |")), "{key}");
        }
        for line in [
            "## [wall.keep]",
            "| `radius` | Mean radius a, to the centres of the wall spheres.",
            "frictional: `3.5`",
            "`printed`: As the talk prints it",
            "whole number from 1 to 1e6 | `20`",
            "### Tables of drive.schedule",
        ] {
            assert!(pages.contains(line), "{line}\n{pages}");
        }
    }
}
