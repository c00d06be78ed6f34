//! The JSON schema of a study file: its keys typed once, for the reader, for editors and for help.

use std::sync::OnceLock;

use peristalsis_configuration::PRESETS;
use peristalsis_observe::COLUMNS;
use serde_json::{Value, json};

/// Most replicates of a point.
pub(super) const MOST_REPLICATES: u64 = 100_000;

/// JSON schema (draft 2020-12) of a study file.
///
/// Every key has a description and its range or its names; no other key is allowed. The table `base` is a
/// configuration. The reader checks which keys go together, and every configuration that follows.
#[must_use]
pub fn schema() -> Value {
    cached().clone()
}

pub(super) fn cached() -> &'static Value {
    static SCHEMA: OnceLock<Value> = OnceLock::new();
    SCHEMA.get_or_init(build)
}

fn build() -> Value {
    let mut configuration = peristalsis_configuration::schema();
    let mut base = configuration["properties"].take();
    if let Some(keys) = base.as_object_mut() {
        keys.remove("preset");
        keys.remove("resolved");
    }
    let presets: Vec<&str> = PRESETS.iter().map(|preset| preset.name).collect();
    let columns: Vec<&str> = COLUMNS.iter().map(|column| column.quantity.name).collect();
    json!({
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "peristalsis study",
        "description": "An ensemble of simulations over a grid of parameters.",
        "type": "object",
        "additionalProperties": false,
        "required": ["name"],
        "properties": {
            "name": {
                "type": "string",
                "description": "Short name of the study, of letters, digits, - and _: exported files are called by it.",
            },
            "title": {
                "type": "string",
                "description": "What the study is about, in one line.",
            },
            "preset": {
                "type": "string",
                "enum": presets,
                "description": "Preset that every run builds on; the keys of `base` and the axes go over it.",
            },
            "file": {
                "type": "string",
                "description": "Configuration file that every run builds on, relative to the folder of the study file; \
                                its seed is ignored. Instead of `preset`.",
            },
            "base": {
                "type": "object",
                "additionalProperties": false,
                "properties": base,
                "description": "Keys of the configuration that all runs share; they go over preset or file.",
            },
            "axes": {
                "type": "array",
                "items": axis(),
                "description": "What is varied. Several axes multiply: every value of one with every value of the others.",
            },
            "states": {
                "type": "array",
                "minItems": 1,
                "items": { "type": "string", "enum": ["rest", "jammed"] },
                "description": "Initial states that every point is run from. Missing: that of the base configuration.",
            },
            "replicates": {
                "type": "integer",
                "minimum": 1,
                "maximum": MOST_REPLICATES,
                "default": 1,
                "description": "Runs of each point, which differ in their random numbers alone.",
            },
            "refine": refine(),
            "stop": stop(),
            "record": record(&columns),
        },
    })
}

/// The table of refinement.
fn refine() -> Value {
    json!({
        "type": "object",
        "additionalProperties": false,
        "required": ["key", "tolerance"],
        "description": "Adds points where the flow changes its kind: for each combination of the other axes, \
                        bisection between the values where all runs had a transition and where none had.",
        "properties": {
            "key": {
                "type": "string",
                "description": "Key of the axis to refine, such as drive.width; an axis of one key with numbers.",
            },
            "tolerance": {
                "type": "number",
                "exclusiveMinimum": 0,
                "description": "Distance of neighbouring values at which bisection ends, in the unit of the key.",
            },
        },
    })
}

/// The table of the stopping rule.
fn stop() -> Value {
    json!({
        "type": "object",
        "additionalProperties": false,
        "required": ["settled_periods"],
        "description": "When a run may end before run.periods. A run without a transition never does.",
        "properties": {
            "settled_periods": {
                "type": "integer",
                "minimum": 3,
                "maximum": 1_000_000,
                "description": "Wave periods to go on from the one in which the transition happened; late means \
                                are then taken over the second half of them.",
            },
        },
    })
}

/// The table of the kept files.
fn record(columns: &[&str]) -> Value {
    json!({
        "type": "object",
        "additionalProperties": false,
        "description": "What is kept of each run besides its row of numbers. How often it is sampled is \
                        base.observe.samples_per_period.",
        "properties": {
            "columns": {
                "type": "array",
                "minItems": 1,
                "items": { "type": "string", "enum": columns },
                "description": "Columns of the time series. Missing: all.",
            },
            "profile": {
                "type": "boolean",
                "default": true,
                "description": "Whether the profile in the wave's frame is kept.",
            },
            "waves": {
                "type": "boolean",
                "default": false,
                "description": "Whether the flow of each wave over each period is kept, waves.parquet: J/Jmax and \
                                number of the grains between two throats, a row for each wave of each period.",
            },
            "snapshot": {
                "type": "boolean",
                "default": false,
                "description": "Whether the spheres as they stand at the end are kept, snapshot.parquet: places along \
                                the wave and across it, diameters, axial velocities, a row a sphere.",
            },
        },
    })
}

fn axis() -> Value {
    let value = json!({
        "anyOf": [{ "type": "number" }, { "type": "string" }, { "type": "boolean" }],
        "description": "A value of the key.",
    });
    json!({
        "type": "object",
        "additionalProperties": false,
        "description": "One key with `values`, or with `from`, `to` and one of `step` and `count`; or several `keys` that \
                        vary together in `rows`.",
        "properties": {
            "key": {
                "type": "string",
                "description": "Key of the configuration, such as drive.width.",
            },
            "values": {
                "type": "array",
                "minItems": 1,
                "items": value,
                "description": "The values of `key`.",
            },
            "from": { "type": "number", "description": "First value of a range." },
            "to": { "type": "number", "description": "Last value of a range, included." },
            "step": {
                "type": "number",
                "exclusiveMinimum": 0,
                "description": "Distance of two values of a range; it divides the range into whole steps.",
            },
            "count": {
                "type": "integer",
                "minimum": 2,
                "maximum": 100_000,
                "description": "Number of values of a range, both ends included.",
            },
            "keys": {
                "type": "array",
                "minItems": 1,
                "items": { "type": "string" },
                "description": "Keys that vary together.",
            },
            "rows": {
                "type": "array",
                "minItems": 1,
                "items": {
                    "type": "array",
                    "minItems": 1,
                    "items": value,
                    "description": "One value for each of `keys`.",
                },
                "description": "The values of `keys`, a row each.",
            },
        },
    })
}
