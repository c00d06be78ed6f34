//! The JSON schema of a configuration, made from the keys and tidied for TOML.

use std::iter::once;
use std::sync::LazyLock;

use peristalsis_physics::contact::Normal;
use schemars::JsonSchema;
use schemars::generate::SchemaSettings;
use serde_json::{Map, Value, json};

use crate::configuration::Control;
use crate::keys::{Keys, exclusive_groups};
use crate::materials::MATERIALS;
use crate::presets::preset_names;

/// Whether a key of the configuration takes whole numbers only.
pub fn takes_whole_numbers(key: &str) -> bool {
    let place = format!("/properties/{}", key.replace('.', "/properties/"));
    let found = SCHEMA.pointer(&place);
    found.is_some_and(|found| found["type"] == "integer")
}

/// JSON schema (draft 2020-12) of a configuration file.
///
/// Every key has a description with its unit, its default, its range or its names; no other key is allowed. It says
/// what a file may hold; what values must be together is the reader's to check.
pub fn schema() -> Value {
    SCHEMA.clone()
}

pub(crate) static SCHEMA: LazyLock<Value> = LazyLock::new(build);

/// The schema of a type as schemars has it.
pub(crate) fn of<T: JsonSchema>() -> Value {
    let mut settings = SchemaSettings::draft2020_12();
    settings.inline_subschemas = true;
    let generator = settings.into_generator();
    generator.into_root_schema_for::<T>().to_value()
}

/// The JSON schema of the keys of a document of another kind, tidied for TOML.
pub fn schema_of<T: JsonSchema>() -> Value {
    let mut schema = of::<T>();
    tidy(&mut schema);
    schema
}

/// A key whose value decides which other keys of its table have a meaning.
pub(crate) struct Choice {
    pub(crate) table: &'static str,
    pub(crate) key: String,
    pub(crate) values: Vec<ChosenValue>,
    description: Value,
}

/// One value of a choice.
#[derive(Default)]
pub(crate) struct ChosenValue {
    pub(crate) name: String,
    /// The keys that go with it, each with its schema.
    pub(crate) keys: Map<String, Value>,
    /// Those of them without a default.
    pub(crate) required: Vec<String>,
    description: Value,
}

/// The choices of the vocabulary: the law of contact, and what of the wall is prescribed.
pub(crate) static CHOICES: LazyLock<[Choice; 2]> = LazyLock::new(|| {
    [
        choice("contact", &of::<Normal>()),
        choice("drive", &of::<Control>()),
    ]
});

/// The normal law of a name with its defaults; `None` for a name that no law has.
pub(crate) fn law_of(name: &str) -> Option<Normal> {
    let law = toml::Table::from_iter([("law".to_owned(), name.into())]);
    law.try_into().ok()
}

/// Every normal law with its defaults.
pub(crate) fn laws() -> impl Iterator<Item = Normal> {
    let [laws, _] = &*CHOICES;
    let of = |value: &ChosenValue| law_of(&value.name);
    laws.values
        .iter()
        .map(move |value| of(value).expect("every parameter of a law has a default"))
}

/// A choice from the schema of an enum with a tag.
fn choice(table: &'static str, schema: &Value) -> Choice {
    let mut key = String::new();
    let branches = schema["oneOf"].as_array().into_iter().flatten();
    let values = branches.map(|branch| {
        let mut value = ChosenValue {
            description: branch["description"].clone(),
            ..ChosenValue::default()
        };
        for (name, property) in branch["properties"].as_object().into_iter().flatten() {
            match property["const"].as_str() {
                Some(tag) => (key, value.name) = (name.clone(), tag.to_owned()),
                None => drop(value.keys.insert(name.clone(), property.clone())),
            }
        }
        let required = texts(&branch["required"]).filter(|name| *name != key);
        value.required = required.map(str::to_owned).collect();
        value
    });
    let values = values.collect();
    Choice {
        table,
        key,
        values,
        description: schema["description"].clone(),
    }
}

/// The texts in a list.
pub(crate) fn texts(list: &Value) -> impl Iterator<Item = &str> {
    let list = list.as_array().into_iter().flatten();
    list.filter_map(Value::as_str)
}

/// Full names of the keys that stand in every configuration, whatever is chosen.
pub(crate) static REQUIRED: LazyLock<Vec<String>> = LazyLock::new(|| required_of(&of::<Keys>()));

fn required_of(keys: &Value) -> Vec<String> {
    let mut required = Vec::new();
    for table in texts(&keys["required"]) {
        let chosen = CHOICES.iter().find(|choice| choice.table == table);
        required.extend(chosen.map(|choice| format!("{table}.{}", choice.key)));
        let plain = texts(&keys["properties"][table]["required"]);
        required.extend(plain.map(|key| format!("{table}.{key}")));
    }
    required
}

fn build() -> Value {
    let mut schema = of::<Keys>();
    for choice in &*CHOICES {
        lay_out(&mut schema["properties"][choice.table], choice);
    }
    tidy(&mut schema);
    complete(&mut schema);
    schema["title"] = json!("peristalsis configuration");
    let names = preset_names();
    schema["properties"]["preset"] = json!({
        "type": "string",
        "enum": names,
        "description": "Preset that this file builds on; the file's own keys replace the preset's.",
    });
    let materials = MATERIALS
        .iter()
        .map(|it| json!({"const": it.name, "description": it.description(), "type": "string"}));
    let materials: Vec<Value> = materials.collect();
    let material = &mut schema["properties"]["units"]["properties"]["material"];
    *material = json!({"description": material["description"], "oneOf": materials});
    schema["properties"]["resolved"] = json!({
        "type": "object",
        "description": "Values derived from the keys, as a run's record states them. Read and ignored.",
    });
    for group in exclusive_groups() {
        exclude_one_another(&mut schema, group);
    }
    schema
}

/// Puts the keys of all values of a choice side by side into their table, and the choice itself.
fn lay_out(table: &mut Value, choice: &Choice) {
    if let Some(table) = table.as_object_mut() {
        table.remove("oneOf");
    }
    let values = choice.values.iter();
    let values =
        values.map(|it| json!({"const": it.name, "description": it.description, "type": "string"}));
    let one_of: Vec<Value> = values.collect();
    let keys = &mut table["properties"];
    keys[&choice.key] = json!({"description": choice.description, "oneOf": one_of});
    for (name, key) in choice.values.iter().flat_map(|value| &value.keys) {
        keys[name] = key.clone();
    }
}

/// A layer may leave out any key of a table, for another layer gives it; but it may have no other.
fn complete(table: &mut Value) {
    let Some(object) = table.as_object_mut() else {
        return;
    };
    object.remove("required");
    object.insert("additionalProperties".into(), json!(false));
    let inner = object.get_mut("properties").and_then(Value::as_object_mut);
    for (_, key) in inner.into_iter().flatten() {
        if key.get("properties").is_some() {
            complete(key);
        }
    }
}

/// Makes what schemars writes fit TOML: no null, text without line breaks, units in the description.
fn tidy(schema: &mut Value) {
    match schema {
        Value::Array(items) => items.iter_mut().for_each(tidy),
        Value::Object(object) => {
            remove_null(object);
            object.remove("format");
            let unit = match object.get("x-unit").and_then(Value::as_str) {
                None => String::new(),
                Some("1") => " (A pure number.)".to_owned(),
                Some(unit) => format!(" (Unit: {unit}.)"),
            };
            if let Some(Value::String(description)) = object.get_mut("description") {
                *description = description.replace('\n', " ") + &unit;
            }
            // The default of a whole table follows from its keys; a key may have none.
            if matches!(object.get("default"), Some(Value::Object(_) | Value::Null)) {
                object.remove("default");
            }
            object.values_mut().for_each(tidy);
        }
        _ => {}
    }
}

/// Removes the alternative null of an optional key: TOML has none.
fn remove_null(object: &mut Map<String, Value>) {
    if let Some(Value::Array(types)) = object.get_mut("type") {
        types.retain(|kind| kind != "null");
        if let [kind] = types.as_slice() {
            let kind = kind.clone();
            object.insert("type".into(), kind);
        }
    }
    if let Some(Value::Array(names)) = object.get_mut("enum") {
        names.retain(|name| !name.is_null());
    }
    let Some(Value::Array(mut branches)) = object.remove("anyOf") else {
        return;
    };
    branches.retain(|branch| branch.get("type").is_none_or(|kind| kind != "null"));
    if let [Value::Object(_)] = branches.as_slice() {
        let Some(Value::Object(only)) = branches.pop() else {
            return;
        };
        for (key, value) in only {
            // The key's own description is nearer to the reader than its type's.
            object.entry(key).or_insert(value);
        }
        // The branch may itself be a choice with a null in it.
        remove_null(object);
    } else {
        object.insert("anyOf".into(), Value::Array(branches));
    }
}

/// Of two alternatives only one: said in their table, or for two tables in the document.
fn exclude_one_another(schema: &mut Value, group: &[&str]) {
    for (index, one) in group.iter().enumerate() {
        for other in &group[index + 1..] {
            let [(table, one), (other_table, other)] = [split(one), split(other)];
            if table == other_table {
                let refused = json!({"not": {"required": [one, other]}});
                refuse(&mut schema["properties"][table], refused);
            } else {
                let both = json!({
                    "required": [table, other_table],
                    "properties": { table: {"required": [one]}, other_table: {"required": [other]} },
                });
                refuse(schema, json!({ "not": both }));
            }
        }
    }
}

fn refuse(object: &mut Value, refused: Value) {
    match object.get_mut("allOf") {
        Some(Value::Array(all)) => all.push(refused),
        _ => object["allOf"] = json!([refused]),
    }
}

/// Table and name of a key.
fn split(key: &str) -> (&str, &str) {
    key.split_once('.').unwrap_or(("", key))
}

/// Full names of all keys and tables, from the schema.
pub(crate) static KNOWN_KEYS: LazyLock<Vec<String>> = LazyLock::new(|| keys_of(&SCHEMA));

/// Full names of all keys and tables of a schema.
pub(crate) fn keys_of(schema: &Value) -> Vec<String> {
    let mut keys = Vec::new();
    collect_keys(schema, "", &mut keys);
    keys
}

fn collect_keys(schema: &Value, path: &str, keys: &mut Vec<String>) {
    for (name, inner) in schema["properties"].as_object().into_iter().flatten() {
        let full = joined(path, name);
        collect_keys(inner, &full, keys);
        keys.push(full);
    }
    for inner in parts(schema) {
        collect_keys(inner, path, keys);
    }
}

/// The schemas of the items of a schema and of its alternatives, whose keys are its own.
fn parts(schema: &Value) -> impl Iterator<Item = &Value> {
    let alternatives = schema["anyOf"].as_array().into_iter().flatten();
    schema.get("items").into_iter().chain(alternatives)
}

/// Unit of a key; `None` of words, and of what has the unit of another key.
///
/// ```
/// use peristalsis_configuration::unit_of;
///
/// assert_eq!(unit_of("drive.width"), Some("d"));
/// assert_eq!(unit_of("drive.schedule.from"), None);
/// ```
pub fn unit_of(key: &str) -> Option<&'static str> {
    let mut inner = vec![&*SCHEMA];
    for name in key.split('.') {
        inner = inner
            .into_iter()
            .flat_map(|schema| once(schema).chain(parts(schema)))
            .filter_map(|schema| schema["properties"].get(name))
            .collect();
    }
    let unit = inner.first()?.get("x-unit")?.as_str()?;
    (!unit.starts_with("that of")).then_some(unit)
}

/// Full name of a key in a table, which has no name if it is the document.
pub(crate) fn joined(table: &str, key: &str) -> String {
    match table {
        "" => key.to_owned(),
        table => format!("{table}.{key}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every leaf of the schema with its full name.
    fn leaves(schema: &Value, path: &str, found: &mut Vec<(String, Value)>) {
        let Some(Value::Object(properties)) = schema.get("properties") else {
            return found.push((path.to_owned(), schema.clone()));
        };
        for (name, inner) in properties {
            leaves(inner, &format!("{path}.{name}"), found);
        }
    }

    #[test]
    fn every_key_is_described_and_every_number_has_a_unit_and_a_range() {
        let mut found = Vec::new();
        leaves(&SCHEMA, "", &mut found);
        assert!(found.len() > 50, "{} keys", found.len());
        for (path, leaf) in found {
            let description = leaf["description"].as_str().unwrap_or_default();
            assert!(description.len() > 10, "{path}: {leaf}");
            if leaf["type"] == "number" || leaf["type"] == "integer" {
                assert!(leaf["x-unit"].is_string(), "{path}: {leaf}");
                let bounded = leaf.get("minimum").or(leaf.get("exclusiveMinimum"));
                assert!(bounded.is_some(), "{path}: {leaf}");
            }
        }
    }

    #[test]
    fn nothing_is_nullable_and_no_table_is_open() {
        let text = SCHEMA.to_string();
        assert!(!text.contains("null"), "{text}");
        let schema = &*SCHEMA;
        assert_eq!(schema["additionalProperties"], json!(false));
        for table in [
            "grains", "contact", "tube", "drive", "wall", "initial", "run", "observe", "units",
        ] {
            let is_open = &schema["properties"][table]["additionalProperties"];
            assert_eq!(*is_open, json!(false), "{table}");
        }
    }

    #[test]
    fn names_defaults_and_known_keys() {
        let schema = &*SCHEMA;
        let sliding = &schema["properties"]["contact"]["properties"]["sliding"];
        let names = sliding["oneOf"].as_array().unwrap().iter();
        let names: Vec<&Value> = names.map(|one| &one["const"]).collect();
        assert_eq!(names, ["spring", "balance", "literal"]);
        assert_eq!(sliding["default"], "spring");
        let step = &schema["properties"]["run"]["properties"]["time_step"];
        assert_eq!(step["default"], json!(0.05));
        let description = step["description"].as_str().unwrap();
        assert!(description.ends_with("(Unit: t.)"));
        let keys = [
            "drive.width",
            "wall.keep.net_force",
            "drive.schedule.form",
            "preset",
        ];
        for key in keys {
            assert!(KNOWN_KEYS.iter().any(|known| known == key), "{key}");
        }
    }
}
