//! Configurations from presets, texts and Python values.

use peristalsis_configuration::{PRESETS, ScheduledParameter, SourceFile, Sources};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict, PyFloat, PyInt, PyString};

use crate::error::of_configuration;

/// A configuration that has passed every check; it does not change.
#[pyclass(frozen, eq, module = "peristalsis._core")]
#[derive(PartialEq)]
pub(crate) struct Configuration {
    pub(crate) inner: peristalsis_configuration::Configuration,
}

#[pymethods]
impl Configuration {
    /// Reads a preset, a text in TOML, and values of dotted keys that lie over both.
    #[new]
    #[pyo3(signature = (preset=None, text=None, name="text", overrides=None))]
    fn new(
        preset: Option<&str>,
        text: Option<&str>,
        name: &str,
        overrides: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<Self> {
        let overrides = overrides.map_or_else(|| Ok(Vec::new()), settings)?;
        let sources = Sources {
            file: text.map(|text| SourceFile { name, text }),
            preset,
            overrides: &overrides,
        };
        let inner = peristalsis_configuration::Configuration::from_sources(&sources);
        let inner = inner.map_err(of_configuration)?;
        Ok(Self { inner })
    }

    /// Every resolved value as TOML, which gives the same configuration again.
    fn to_toml(&self) -> String {
        self.inner.to_toml()
    }

    /// Number of grains.
    #[getter]
    fn grains(&self) -> u64 {
        self.inner.grains.number
    }

    /// Waves in the tube.
    #[getter]
    fn waves(&self) -> u32 {
        self.inner.tube.waves
    }

    /// Seed of the random numbers.
    #[getter]
    fn seed(&self) -> u64 {
        self.inner.run.seed
    }

    /// Volume fraction of a straight tube.
    #[getter]
    fn volume_fraction(&self) -> f64 {
        self.inner.volume_fraction()
    }

    /// Steps of the configured run.
    #[getter]
    fn steps(&self) -> u64 {
        self.inner.run.steps()
    }

    /// Length of a step.
    #[getter]
    fn time_step(&self) -> f64 {
        self.inner.run.time_step
    }

    /// Length of the tube.
    #[getter]
    fn length(&self) -> f64 {
        self.inner.tube.length()
    }

    /// What looks doubtful, as (key, message).
    fn warnings(&self) -> Vec<(&'static str, String)> {
        let warnings = peristalsis_run::warnings(&self.inner).into_iter();
        warnings.map(|it| (it.key, it.message)).collect()
    }
}

/// `key=value` texts of a dictionary of dotted keys.
fn settings(overrides: &Bound<'_, PyDict>) -> PyResult<Vec<String>> {
    let setting = |(key, value): (Bound<'_, PyAny>, Bound<'_, PyAny>)| {
        let key: String = key.extract()?;
        let value = value_of(&value).map_err(|error| {
            PyTypeError::new_err(format!("{key}: {}", error.value(overrides.py())))
        })?;
        Ok(format!("{key}={value}"))
    };
    overrides.iter().map(setting).collect()
}

/// A Python value as one of TOML.
fn value_of(value: &Bound<'_, PyAny>) -> PyResult<toml::Value> {
    if value.is_instance_of::<PyBool>() {
        return Ok(toml::Value::Boolean(value.extract()?));
    }
    if value.is_instance_of::<PyInt>() {
        return Ok(toml::Value::Integer(value.extract()?));
    }
    if value.is_instance_of::<PyFloat>() {
        return Ok(toml::Value::Float(value.extract()?));
    }
    if value.is_instance_of::<PyString>() {
        return Ok(toml::Value::String(value.extract()?));
    }
    if let Ok(table) = value.cast::<PyDict>() {
        let entries = table
            .iter()
            .map(|(key, value)| Ok((key.extract::<String>()?, value_of(&value)?)));
        return Ok(toml::Value::Table(entries.collect::<PyResult<_>>()?));
    }
    // NumPy's scalars: whole numbers say so by `__index__`.
    if value.hasattr("__index__")? && !value.hasattr("__len__")? {
        let number = value.call_method0("__index__")?.extract()?;
        return Ok(toml::Value::Integer(number));
    }
    if let Ok(number) = value.extract::<f64>() {
        return Ok(toml::Value::Float(number));
    }
    let values = value.try_iter().map_err(|_| {
        let reason = format!("{value} is no number, text, truth value, list or dictionary");
        PyTypeError::new_err(reason)
    })?;
    let values: PyResult<Vec<_>> = values.map(|item| value_of(&item?)).collect();
    Ok(toml::Value::Array(values?))
}

/// A parameter of the drive by its name.
pub(crate) fn scheduled(name: &str) -> PyResult<ScheduledParameter> {
    match name {
        "width" => Ok(ScheduledParameter::Width),
        "force_amplitude" => Ok(ScheduledParameter::ForceAmplitude),
        "strain_rate" => Ok(ScheduledParameter::StrainRate),
        _ => Err(crate::error::ConfigurationError::new_err(format!(
            "{name} cannot change during a run; width, force_amplitude and strain_rate can"
        ))),
    }
}

/// The JSON schema of all keys.
#[pyfunction]
pub(crate) fn schema() -> String {
    peristalsis_configuration::schema().to_string()
}

/// Names of the presets.
#[pyfunction]
pub(crate) fn presets() -> Vec<&'static str> {
    PRESETS.iter().map(|preset| preset.name).collect()
}
