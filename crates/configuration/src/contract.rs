//! The schema as the reader's contract: unknown keys, types, names and ranges, each with its place.

use serde_json::{Map, Value};

use crate::document::{Item, Node, Table};
use crate::error::{Problem, ProblemKind, Problems};
use crate::schema::{self, joined, texts};
use crate::source::Origin;
use crate::suggestion;

/// Checks a layer against the schema; all problems in one go.
pub(crate) fn check(table: &Table, problems: &mut Problems) {
    Contract {
        known: &schema::KNOWN_KEYS,
        problems,
    }
    .table(table, None, &schema::SCHEMA, "");
}

/// Checks a document of another kind against its own JSON schema: unknown keys, types, names and ranges, with the messages
/// of a configuration. It understands the words of JSON Schema that [`schema`](crate::schema()) uses.
pub fn check_against(schema: &Value, table: &Table, problems: &mut Problems) {
    Contract {
        known: &schema::keys_of(schema),
        problems,
    }
    .table(table, None, schema, "");
}

/// Unknown keys for which the nearest known one is looked up.
const MOST_SUGGESTIONS: usize = 100;

/// Whole numbers up to this one are exact as f64.
const MOST_EXACT: f64 = (1_u64 << 53) as f64;

/// What a check needs besides the value and its schema.
struct Contract<'a> {
    /// Full names of all keys, to guess from.
    known: &'a [String],
    problems: &'a mut Problems,
}

impl Contract<'_> {
    /// `origin`: where the table stands, of one that is written as a value.
    fn table(&mut self, table: &Table, origin: Option<&Origin>, schema: &Value, path: &str) {
        // An object without properties (the record's derived values) is open.
        let Some(properties) = schema["properties"].as_object() else {
            return;
        };
        for (name, entry) in table {
            let full = joined(path, name);
            if let Some(inner) = properties.get(name) {
                self.item(&entry.item, inner, &full);
                continue;
            }
            let known = self.known.iter().map(String::as_str);
            let is_to_be_shown = self.problems.number() < MOST_SUGGESTIONS;
            let nearest = is_to_be_shown.then(|| suggestion::nearest(&full, known));
            let help = match nearest.flatten() {
                Some(near) if near == full => {
                    format!("a dot in quotation marks is part of a name: write {name} without them")
                }
                Some(near) => format!("did you mean {near}?"),
                None => format!("known here: {}", names_of(properties)),
            };
            let message = format!("there is no key {full}");
            let place = (&entry.key, "unknown key");
            self.refuse(ProblemKind::UnknownKey, &full, place, message, help);
        }
        let required = texts(&schema["required"]);
        for name in required.filter(|name| !table.contains_key(*name)) {
            let full = joined(path, name);
            let message = match path {
                "" => format!("{full} is missing"),
                _ => format!("{full} is missing in this table"),
            };
            let help = allowed(&schema["properties"][name]);
            let mut problem = Problem::new(ProblemKind::Missing, message)
                .key(full)
                .help(help);
            let first = table.values().next().map(|entry| &entry.key);
            if let Some(origin) = first.or(origin) {
                problem = problem.at(origin, "in this table");
            }
            self.problems.push(problem);
        }
    }

    fn item(&mut self, item: &Item, schema: &Value, path: &str) {
        if let Some(branches) = schema["anyOf"].as_array() {
            match branches.iter().find(|branch| takes(branch, &item.node)) {
                Some(branch) => self.item(item, &with_description(branch, schema), path),
                None => self.wrong_type(item, schema, path),
            }
            return;
        }
        if !takes(schema, &item.node) {
            return match item.node {
                Node::Float(number) if schema["type"] == "integer" && number.fract() == 0.0 => {
                    self.whole_as_real(item, number, schema, path);
                }
                _ => self.wrong_type(item, schema, path),
            };
        }
        match &item.node {
            Node::Table(table) => self.table(table, Some(&item.origin), schema, path),
            Node::Array(items) => self.array(item, items, schema, path),
            Node::Text(text) => self.name(item, text, schema, path),
            Node::Integer(integer) => self.range(item, *integer as f64, schema, path),
            Node::Float(number) => self.range(item, *number, schema, path),
            Node::Boolean(_) | Node::Other(_) => {}
        }
    }

    /// Refuses a whole number that is written like another, such as 1e3.
    fn whole_as_real(&mut self, item: &Item, number: f64, schema: &Value, path: &str) {
        let whole = in_digits(number);
        let beyond_integers = (number >= i64::MAX as f64).then_some("is too large");
        if let Some(complaint) = complaint(number, schema).or(beyond_integers) {
            let message = format!("{path} = {whole} {complaint}");
            let place = (&item.origin, complaint);
            return self.refuse(
                ProblemKind::OutOfRange,
                path,
                place,
                message,
                allowed(schema),
            );
        }
        let message = format!("{path} = {number:?} is not a whole number as it is written");
        let place = (&item.origin, &*format!("write {whole}"));
        let kind = ProblemKind::WrongType;
        self.refuse(kind, path, place, message, allowed(schema));
    }

    fn wrong_type(&mut self, item: &Item, schema: &Value, path: &str) {
        let found = item.node.description();
        let place = (&item.origin, &*format!("this is {found}"));
        let message = match (kind_alone(schema), &item.node) {
            // A number of an axis may stand nowhere in the text.
            (Some(wanted), Node::Float(number)) => format!("{path} = {number:?} is not {wanted}"),
            (Some(wanted), Node::Integer(_) | Node::Boolean(_)) => {
                format!("{path} = {} is not {wanted}", item.origin.text())
            }
            (Some(wanted), _) => format!("{path} is {found}, not {wanted}"),
            (None, _) => format!("{path} cannot be {found}"),
        };
        let kind = ProblemKind::WrongType;
        self.refuse(kind, path, place, message, allowed(schema));
    }

    fn array(&mut self, item: &Item, items: &[Item], schema: &Value, path: &str) {
        let (number, bound) = (items.len() as u64, |name: &str| schema[name].as_u64());
        let wrong = match (bound("minItems"), bound("maxItems")) {
            (Some(least), _) if number < least => Some(("short", "at least", least)),
            (_, Some(most)) if number > most => Some(("long", "at most", most)),
            _ => None,
        };
        if let Some((length, relation, bound)) = wrong {
            let message =
                format!("the list {path} is too {length}: it has {relation} {bound} values");
            let (kind, place) = (ProblemKind::OutOfRange, (&item.origin, "this list"));
            self.refuse(kind, path, place, message, allowed(schema));
        }
        if let Some(inner) = schema.get("items") {
            for (index, element) in items.iter().enumerate() {
                self.item(element, inner, &format!("{path}[{index}]"));
            }
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
        let place = (&item.origin, "unknown name");
        let message = format!("{path} cannot be {text:?}");
        self.refuse(ProblemKind::WrongType, path, place, message, help);
    }

    fn range(&mut self, item: &Item, number: f64, schema: &Value, path: &str) {
        let Some(complaint) = complaint(number, schema) else {
            return;
        };
        let message = format!("{path} = {} {complaint}", item.origin.text());
        let (kind, place) = (ProblemKind::OutOfRange, (&item.origin, complaint));
        self.refuse(kind, path, place, message, allowed(schema));
    }

    /// Notes a problem with a key at one place of the text.
    fn refuse(
        &mut self,
        kind: ProblemKind,
        key: &str,
        (origin, label): (&Origin, &str),
        message: String,
        help: String,
    ) {
        let problem = Problem::new(kind, message).key(key).help(help);
        self.problems.push(problem.at(origin, label));
    }
}

/// What is wrong with the size of a number, if anything is.
fn complaint(number: f64, schema: &Value) -> Option<&'static str> {
    let bound = |name: &str| schema[name].as_f64();
    if !number.is_finite() {
        Some("is not a finite number")
    } else if bound("minimum").is_some_and(|least| number < least)
        || bound("exclusiveMinimum").is_some_and(|least| number <= least)
    {
        Some("is too small")
    } else if bound("maximum").is_some_and(|most| number > most)
        || bound("exclusiveMaximum").is_some_and(|most| number >= most)
    {
        Some("is too large")
    } else {
        None
    }
}

/// A whole number without a point, as long as it can be read.
fn in_digits(number: f64) -> String {
    match number.abs() < 1e15 {
        true => format!("{number:.0}"),
        false => format!("{number:e}"),
    }
}

fn names_of(properties: &Map<String, Value>) -> String {
    let names: Vec<&str> = properties.keys().map(String::as_str).collect();
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
    let kind = schema["type"].as_str();
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
    let by_const = schema["oneOf"].as_array().into_iter().flatten();
    let by_const = by_const.filter_map(|one| one["const"].as_str());
    texts(&schema["enum"]).chain(by_const).collect()
}

/// The allowed values of a key, in words, with its description.
pub(crate) fn allowed(schema: &Value) -> String {
    let kind = match kind_in_words(schema) {
        kind if kind.is_empty() => kind,
        kind => format!("allowed: {kind}"),
    };
    let description = schema["description"].as_str().unwrap_or_default();
    let parts = [&*kind, description]
        .into_iter()
        .filter(|part| !part.is_empty());
    parts.collect::<Vec<_>>().join(". ")
}

fn kind_in_words(schema: &Value) -> String {
    let names = names(schema);
    if !names.is_empty() {
        let quoted: Vec<String> = names.iter().map(|name| format!("\"{name}\"")).collect();
        return quoted.join(", ");
    }
    if let Some(branches) = schema["anyOf"].as_array() {
        let kinds: Vec<String> = branches.iter().map(kind_in_words).collect();
        return kinds.join(", or ");
    }
    match schema["type"].as_str() {
        Some("number") => format!("a number{}", range_in_words(schema)),
        Some("integer") => format!("a whole number{}", range_in_words(schema)),
        Some("boolean") => "true or false".into(),
        Some("string") => "a text".into(),
        Some("array") => {
            let items = kind_in_words(&schema["items"]);
            match (schema["minItems"].as_u64(), schema["maxItems"].as_u64()) {
                (Some(least), Some(most)) if least == most => {
                    format!("a list of {most}, each {items}")
                }
                _ => format!("a list of {items}"),
            }
        }
        Some("object") => match schema["properties"].as_object() {
            Some(properties) => format!("a table of {}", names_of(properties)),
            None => "a table".into(),
        },
        _ => String::new(),
    }
}

/// The one kind of value that a key takes; `None` where there are several.
fn kind_alone(schema: &Value) -> Option<&'static str> {
    match schema["type"].as_str() {
        _ if !names(schema).is_empty() => Some("one of its names"),
        Some("number") => Some("a number"),
        Some("integer") => Some("a whole number"),
        Some("boolean") => Some("true or false"),
        Some("string") => Some("a text"),
        Some("array") => Some("a list"),
        Some("object") => Some("a table"),
        _ => None,
    }
}

fn range_in_words(schema: &Value) -> String {
    let bound = |name: &str, before: &str, after: &str| match schema[name].as_f64() {
        Some(bound) if bound.abs() < 1e6 => format!("{before}{bound}{after}"),
        // The largest seed is no number of 53 bits.
        Some(bound) if bound > MOST_EXACT => format!("{before}{}{after}", schema[name]),
        Some(bound) => format!("{before}{bound:e}{after}"),
        None => String::new(),
    };
    let least = match schema.get("minimum") {
        Some(_) => bound("minimum", ", ", " or more"),
        None => bound("exclusiveMinimum", " above ", ""),
    };
    least + &bound("maximum", ", at most ", "") + &bound("exclusiveMaximum", ", below ", "")
}
