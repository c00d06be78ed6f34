//! Python values as those of a configuration.

use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict, PyFloat, PyInt, PyString};

/// `key=value` texts of a dictionary of dotted keys.
pub(crate) fn settings(overrides: &Bound<'_, PyDict>) -> PyResult<Vec<String>> {
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
    // Paths are text in a configuration.
    if value.hasattr("__fspath__")? {
        return value_of(&value.call_method0("__fspath__")?);
    }
    if let Ok(table) = value.cast::<PyDict>() {
        let entries = table
            .iter()
            .map(|(key, value)| Ok((key.extract::<String>()?, value_of(&value)?)));
        return Ok(toml::Value::Table(entries.collect::<PyResult<_>>()?));
    }
    // NumPy's scalars: truth values say so by their kind, and complex numbers, of which only a part would be left.
    if let Ok(kind) = value.getattr("dtype").and_then(|it| it.getattr("kind"))
        && !value.hasattr("__len__")?
    {
        if kind.eq("b")? {
            return Ok(toml::Value::Boolean(value.is_truthy()?));
        }
        if kind.eq("c")? {
            return Err(no_value(value));
        }
    }
    // Whole numbers say so by `__index__`.
    if value.hasattr("__index__")? && !value.hasattr("__len__")? {
        let number = value.call_method0("__index__")?.extract()?;
        return Ok(toml::Value::Integer(number));
    }
    if let Ok(number) = value.extract::<f64>() {
        return Ok(toml::Value::Float(number));
    }
    let values = value.try_iter().map_err(|_| no_value(value))?;
    let values: PyResult<Vec<_>> = values.map(|item| value_of(&item?)).collect();
    Ok(toml::Value::Array(values?))
}

fn no_value(value: &Bound<'_, PyAny>) -> PyErr {
    let reason = format!("{value} is no number, text, truth value, list or dictionary");
    PyTypeError::new_err(reason)
}
