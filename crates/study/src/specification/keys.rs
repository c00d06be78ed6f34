//! The keys of a study file as they are written; the JSON schema follows from them, and the reader enforces it.

use std::sync::OnceLock;

use peristalsis_configuration::{InitialState, preset_names, schema_of};
use schemars::JsonSchema;
use serde::Deserialize;
use serde_json::{Value, json};

use crate::identity::Record;

/// An ensemble of simulations over a grid of parameters.
#[derive(Deserialize, JsonSchema)]
pub(super) struct Keys {
    /// Short name of the study, of the letters a to z and A to Z, digits, - and _: exported files are called by it.
    pub(super) name: String,
    /// What the study is about, in one line.
    pub(super) title: Option<String>,
    /// Preset that every run builds on; the keys of `base` and the axes go over it.
    #[schemars(extend("enum" = preset_names()))]
    pub(super) preset: Option<String>,
    /// Configuration file that every run builds on, relative to the folder of the study file; its seed is ignored. Instead
    /// of `preset`.
    pub(super) file: Option<String>,
    /// Initial states that every point is run from. Default: the initial state of the base configuration.
    #[schemars(extend("minItems" = 1, "items" = {"type": "string", "enum": ["rest", "settled", "jammed"]}))]
    pub(super) states: Option<Vec<InitialState>>,
    /// Runs of each point, which differ in their random numbers alone.
    #[serde(default = "one")]
    #[schemars(extend("minimum" = 1, "maximum" = 100_000))]
    pub(super) replicates: u32,
    pub(super) refine: Option<RefineKeys>,
    pub(super) stop: Option<StopKeys>,
    #[serde(default)]
    pub(super) record: Record,
}

fn one() -> u32 {
    1
}

/// Adds points where the flow changes its kind: for each combination of the other axes, bisection between the values where
/// all runs had a transition and where none had; where runs differ up to the last value, where the majority changes.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct RefineKeys {
    /// Key of the axis to refine, such as drive.width; an axis of one key with numbers.
    pub(super) key: String,
    /// Distance of neighbouring values at which bisection ends, in the unit of the key.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub(super) tolerance: f64,
}

/// When a run may end before run.periods. A run without a transition never does.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct StopKeys {
    /// Wave periods to go on from the one in which the transition happened; late means are then taken over the second half
    /// of them.
    #[schemars(extend("minimum" = 3, "maximum" = 1_000_000))]
    pub(super) settled_periods: u32,
}

/// One key with `values`, or with `from`, `to` and one of `step` and `count`; or several `keys` that vary together in
/// `rows`.
#[derive(JsonSchema)]
#[serde(deny_unknown_fields)]
#[expect(dead_code, reason = "an axis is read with the places of its values")]
struct AxisKeys {
    /// Key of the configuration, such as drive.width.
    key: Option<String>,
    /// The values of `key`.
    #[schemars(extend("minItems" = 1))]
    values: Option<Vec<AxisValue>>,
    /// First value of a range.
    from: Option<f64>,
    /// Last value of a range, included.
    to: Option<f64>,
    /// Distance of two values of a range; it divides the range into whole steps.
    #[schemars(extend("exclusiveMinimum" = 0))]
    step: Option<f64>,
    /// Number of values of a range, both ends included.
    #[schemars(extend("minimum" = 2, "maximum" = 100_000))]
    count: Option<u32>,
    /// Keys that vary together.
    #[schemars(extend("minItems" = 1))]
    keys: Option<Vec<String>>,
    /// The values of `keys`, a row each.
    #[schemars(extend("minItems" = 1))]
    rows: Option<Vec<AxisRow>>,
}

/// One value for each of `keys`.
#[derive(JsonSchema)]
#[schemars(extend("minItems" = 1))]
#[expect(dead_code, reason = "as of an axis")]
struct AxisRow(Vec<AxisValue>);

/// A value of the key; a list of numbers is one value, such as of body.gravity.
#[derive(JsonSchema)]
#[serde(untagged)]
#[expect(dead_code, reason = "as of an axis")]
enum AxisValue {
    Number(f64),
    Text(String),
    Boolean(bool),
    Numbers(Vec<f64>),
}

/// JSON schema (draft 2020-12) of a study file.
///
/// Every key has a description and its range or its names; no other key is allowed. The table `base` is a
/// configuration. The reader checks which keys go together, and every configuration that follows.
pub fn schema() -> Value {
    cached().clone()
}

pub(super) fn cached() -> &'static Value {
    static SCHEMA: OnceLock<Value> = OnceLock::new();
    SCHEMA.get_or_init(build)
}

fn build() -> Value {
    let mut base = peristalsis_configuration::schema()["properties"].take();
    if let Some(keys) = base.as_object_mut() {
        keys.remove("preset");
        keys.remove("resolved");
    }
    let mut schema = schema_of::<Keys>();
    schema["title"] = json!("peristalsis study");
    schema["additionalProperties"] = json!(false);
    schema["properties"]["base"] = json!({
        "type": "object",
        "additionalProperties": false,
        "properties": base,
        "description": "Keys of the configuration that all runs share; they go over preset or file.",
    });
    let mut axis = schema_of::<AxisKeys>();
    if let Some(axis) = axis.as_object_mut() {
        axis.retain(|word, _| !["$schema", "title"].contains(&word.as_str()));
    }
    schema["properties"]["axes"] = json!({
        "type": "array",
        "items": axis,
        "description": "What is varied. Several axes multiply: every value of one with every value of the others.",
    });
    schema
}
