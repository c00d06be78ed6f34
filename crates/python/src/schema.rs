//! Schemas of what goes in and of what comes out, which Python's types are made of (scripts/python_types.py and
//! scripts/python_results.py).

use peristalsis_analysis::{
    AutocorrelationTime, CollapseEstimate, CurveFit, DipTest, Hysteresis, InverseFit, JointTest,
    Jump, LawEvidence, MomentPeak, Moments, NearestFit, ScatterLawFit, ScatteredLine, SecondMoment,
    ShiftedExponentialFit, StationaryMean, SurvivalStep, TwoPeaks, WidthEnsemble, WindowRunsFit,
};
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

/// The JSON schemas of what estimators answer, and of what is in it, by name.
#[pyfunction]
pub(crate) fn results_schema() -> String {
    let answers = [
        SchemaGenerator::subschema_for::<AutocorrelationTime>,
        SchemaGenerator::subschema_for::<CollapseEstimate>,
        SchemaGenerator::subschema_for::<CurveFit>,
        SchemaGenerator::subschema_for::<DipTest>,
        SchemaGenerator::subschema_for::<Hysteresis>,
        SchemaGenerator::subschema_for::<InverseFit>,
        SchemaGenerator::subschema_for::<JointTest>,
        SchemaGenerator::subschema_for::<Jump>,
        SchemaGenerator::subschema_for::<LawEvidence>,
        SchemaGenerator::subschema_for::<MomentPeak>,
        SchemaGenerator::subschema_for::<Moments>,
        SchemaGenerator::subschema_for::<NearestFit>,
        SchemaGenerator::subschema_for::<ScatterLawFit>,
        SchemaGenerator::subschema_for::<ScatteredLine>,
        SchemaGenerator::subschema_for::<SecondMoment>,
        SchemaGenerator::subschema_for::<ShiftedExponentialFit>,
        SchemaGenerator::subschema_for::<StationaryMean>,
        SchemaGenerator::subschema_for::<SurvivalStep>,
        SchemaGenerator::subschema_for::<TwoPeaks>,
        SchemaGenerator::subschema_for::<WidthEnsemble>,
        SchemaGenerator::subschema_for::<WindowRunsFit>,
    ];
    let mut generator = generator();
    for describe in answers {
        describe(&mut generator);
    }
    serde_json::Value::from(generator.take_definitions(true)).to_string()
}
