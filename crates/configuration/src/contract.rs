//! The schema as the reader's contract: unknown keys, types, names and ranges, each with its place.

use serde_json::Value;

use crate::document::{Item, Node, Table};
use crate::error::{Problem, ProblemKind, Problems};
use crate::schema;
use crate::suggestion;

/// Checks a layer against the schema; all problems in one go.
pub(crate) fn check(table: &Table, problems: &mut Problems) {
    Contract {
        known: schema::known_keys(),
        problems,
    }
    .table(table, schema::cached(), "");
}

/// Checks a document of another kind against its own JSON schema: unknown keys, types, names and ranges, with the same
/// messages as those of a configuration. Of the schema's words those are understood that [`schema`](crate::schema())
/// itself uses.
pub fn check_against(schema: &Value, table: &Table, problems: &mut Problems) {
    Contract {
        known: &schema::keys_of(schema),
        problems,
    }
    .table(table, schema, "");
}

/// What a check needs besides the value and its schema.
struct Contract<'a> {
    /// Full names of all keys, to guess from.
    known: &'a [String],
    problems: &'a mut Problems,
}

impl Contract<'_> {
    fn table(&mut self, table: &Table, schema: &Value, path: &str) {
        // An object without properties (the record's derived values) is open.
        let Some(properties) = schema.get("properties") else {
            return;
        };
        for (name, entry) in table {
            let full = joined(path, name);
            if let Some(inner) = properties.get(name) {
                self.item(&entry.item, inner, &full);
                continue;
            }
            let mut problem =
                Problem::new(ProblemKind::UnknownKey, format!("there is no key {full}"))
                    .key(&full)
                    .at(&entry.key, "unknown key");
            problem = match suggestion::nearest_key(&full, self.known) {
                Some(near) => problem.help(format!("did you mean {near}?")),
                None => problem.help(format!("known here: {}", names_of(properties))),
            };
            self.problems.push(Some(&entry.key), problem);
        }
        self.required(table, schema, path);
    }

    fn required(&mut self, table: &Table, schema: &Value, path: &str) {
        let required = schema.get("required").and_then(Value::as_array);
        for name in required.into_iter().flatten().filter_map(Value::as_str) {
            if table.contains_key(name) {
                continue;
            }
            let place = table.values().next().map(|entry| &entry.key);
            let mut problem = Problem::new(
                ProblemKind::Missing,
                format!("{} is missing in this table", joined(path, name)),
            )
            .key(joined(path, name))
            .help(allowed(&schema["properties"][name]));
            if let Some(place) = place {
                problem = problem.at(place, "in this table");
            }
            self.problems.push(place, problem);
        }
    }

    fn item(&mut self, item: &Item, schema: &Value, path: &str) {
        if let Some(branches) = schema.get("anyOf").and_then(Value::as_array) {
            match branches.iter().find(|branch| takes(branch, &item.node)) {
                Some(branch) => self.item(item, &with_description(branch, schema), path),
                None => self.wrong_type(item, schema, path),
            }
            return;
        }
        if !takes(schema, &item.node) {
            return self.wrong_type(item, schema, path);
        }
        match &item.node {
            Node::Table(table) => self.table(table, schema, path),
            Node::Array(items) => self.array(item, items, schema, path),
            Node::Text(text) => self.name(item, text, schema, path),
            Node::Integer(integer) => self.range(item, *integer as f64, schema, path),
            Node::Float(number) => self.range(item, *number, schema, path),
            Node::Boolean(_) | Node::Other(_) => {}
        }
    }

    fn wrong_type(&mut self, item: &Item, schema: &Value, path: &str) {
        let message = format!("{path} is {}, which it cannot be", item.node.description());
        let problem = Problem::new(ProblemKind::WrongType, message)
            .key(path)
            .at(&item.origin, format!("this is {}", item.node.description()))
            .help(allowed(schema));
        self.problems.push(Some(&item.origin), problem);
    }

    fn array(&mut self, item: &Item, items: &[Item], schema: &Value, path: &str) {
        let least = schema.get("minItems").and_then(Value::as_u64).unwrap_or(0);
        if (items.len() as u64) < least {
            let problem = Problem::new(
                ProblemKind::OutOfRange,
                format!("the list {path} is too short"),
            )
            .key(path)
            .at(&item.origin, "this list")
            .help(allowed(schema));
            self.problems.push(Some(&item.origin), problem);
        }
        let Some(inner) = schema.get("items") else {
            return;
        };
        for (index, element) in items.iter().enumerate() {
            self.item(element, inner, &format!("{path}[{index}]"));
        }
    }

    fn name(&mut self, item: &Item, text: &str, schema: &Value, path: &str) {
        let names = names(schema);
        if names.is_empty() || names.contains(&text) {
            return;
        }
        let help = match suggestion::nearest(text, names.iter().copied()) {
            Some(near) => format!("did you mean \"{near}\"? {}", allowed(schema)),
            None => allowed(schema),
        };
        let problem = Problem::new(ProblemKind::WrongType, format!("{path} cannot be {text:?}"))
            .key(path)
            .at(&item.origin, "unknown name")
            .help(help);
        self.problems.push(Some(&item.origin), problem);
    }

    fn range(&mut self, item: &Item, number: f64, schema: &Value, path: &str) {
        let bound = |name: &str| schema.get(name).and_then(Value::as_f64);
        let complaint = if !number.is_finite() {
            Some("is not a finite number")
        } else if bound("minimum").is_some_and(|least| number < least)
            || bound("exclusiveMinimum").is_some_and(|least| number <= least)
        {
            Some("is too small")
        } else if bound("maximum").is_some_and(|most| number > most) {
            Some("is too large")
        } else {
            None
        };
        let Some(complaint) = complaint else { return };
        let message = format!("{path} = {} {complaint}", item.origin.text());
        let problem = Problem::new(ProblemKind::OutOfRange, message)
            .key(path)
            .at(&item.origin, complaint)
            .help(allowed(schema));
        self.problems.push(Some(&item.origin), problem);
    }
}

fn joined(path: &str, name: &str) -> String {
    if path.is_empty() {
        name.to_owned()
    } else {
        format!("{path}.{name}")
    }
}

fn names_of(properties: &Value) -> String {
    let names: Vec<&str> = properties
        .as_object()
        .into_iter()
        .flat_map(|map| map.keys())
        .map(String::as_str)
        .collect();
    names.join(", ")
}

/// The branch with the description of the whole, for help.
fn with_description(branch: &Value, whole: &Value) -> Value {
    let mut branch = branch.clone();
    if let (Some(object), Some(description)) = (branch.as_object_mut(), whole.get("description")) {
        object.insert("description".into(), description.clone());
    }
    branch
}

/// Whether the value has the schema's type.
fn takes(schema: &Value, node: &Node) -> bool {
    let kind = schema.get("type").and_then(Value::as_str);
    match node {
        Node::Table(_) => kind == Some("object"),
        Node::Array(_) => kind == Some("array"),
        Node::Text(_) => kind == Some("string") || !names(schema).is_empty(),
        Node::Integer(_) => matches!(kind, Some("integer" | "number")),
        Node::Float(_) => kind == Some("number"),
        Node::Boolean(_) => kind == Some("boolean"),
        Node::Other(_) => false,
    }
}

/// The names that a schema allows.
fn names(schema: &Value) -> Vec<&str> {
    let by_enum = schema
        .get("enum")
        .and_then(Value::as_array)
        .into_iter()
        .flatten();
    let by_const = schema
        .get("oneOf")
        .and_then(Value::as_array)
        .into_iter()
        .flatten();
    by_enum
        .filter_map(Value::as_str)
        .chain(by_const.filter_map(|one| one.get("const").and_then(Value::as_str)))
        .collect()
}

/// What a key allows, in words, with its description.
pub(crate) fn allowed(schema: &Value) -> String {
    let mut text = match kind_in_words(schema) {
        kind if kind.is_empty() => String::new(),
        kind => format!("allowed: {kind}"),
    };
    if let Some(description) = schema.get("description").and_then(Value::as_str) {
        if !text.is_empty() {
            text.push_str(". ");
        }
        text.push_str(description);
    }
    text
}

fn kind_in_words(schema: &Value) -> String {
    let names = names(schema);
    if !names.is_empty() {
        let quoted: Vec<String> = names.iter().map(|name| format!("\"{name}\"")).collect();
        return quoted.join(", ");
    }
    if let Some(branches) = schema.get("anyOf").and_then(Value::as_array) {
        let kinds: Vec<String> = branches.iter().map(kind_in_words).collect();
        return kinds.join(", or ");
    }
    match schema.get("type").and_then(Value::as_str) {
        Some("number") => format!("a number{}", range_in_words(schema)),
        Some("integer") => format!("a whole number{}", range_in_words(schema)),
        Some("boolean") => "true or false".into(),
        Some("string") => "a text".into(),
        Some("array") => {
            format!(
                "a list of {}",
                schema.get("items").map(kind_in_words).unwrap_or_default()
            )
        }
        Some("object") => match schema.get("properties") {
            Some(properties) => format!("a table of {}", names_of(properties)),
            None => "a table".into(),
        },
        _ => String::new(),
    }
}

fn range_in_words(schema: &Value) -> String {
    let bound = |name: &str| schema.get(name).and_then(Value::as_f64).map(short);
    let least = match (bound("minimum"), bound("exclusiveMinimum")) {
        (Some(least), _) => format!(", {least} or more"),
        (None, Some(least)) => format!(" above {least}"),
        (None, None) => String::new(),
    };
    let most = bound("maximum")
        .map(|most| format!(", at most {most}"))
        .unwrap_or_default();
    least + &most
}

/// A limit in few characters.
fn short(limit: f64) -> String {
    if limit.abs() < 1e6 {
        limit.to_string()
    } else {
        format!("{limit:e}")
    }
}
