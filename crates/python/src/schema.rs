//! Schemas of what goes in and of what comes out, which Python's types are made of (scripts/python_types.py).

use pyo3::prelude::*;
use schemars::SchemaGenerator;
use schemars::generate::SchemaSettings;

use crate::run::Standing;

fn generator() -> SchemaGenerator {
    SchemaSettings::draft2020_12()
        .for_serialize()
        .into_generator()
}

/// The JSON schema of all keys.
#[pyfunction]
pub(crate) fn schema() -> String {
    peristalsis_configuration::schema().to_string()
}

/// Quantities of a summary: (key, unit, meaning, kind, whether it may be missing), which the types of Python are made of.
#[pyfunction]
pub(crate) fn summary_keys() -> Vec<(String, &'static str, &'static str, String, bool)> {
    let keys = peristalsis_run::summary_keys().into_iter();
    keys.map(|it| {
        let kind = format!("{:?}", it.column.kind).to_lowercase();
        (it.key, it.column.unit, it.column.text, kind, it.is_optional)
    })
    .collect()
}

/// The JSON schema of what a summary holds besides these, and of its status.
#[pyfunction]
pub(crate) fn summary_schema() -> String {
    let mut summary = peristalsis_run::summary_schema();
    let status = generator().into_root_schema_for::<Standing>();
    if let Some(properties) = summary.pointer_mut("/properties") {
        properties["status"] = status.to_value();
    }
    summary.as_value().to_string()
}
