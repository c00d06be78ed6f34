//! Configurations from presets, texts and Python values.

use std::hash::{Hash, Hasher};

use peristalsis_command::not_of_one_run;
use peristalsis_configuration::{SourceFile, Sources, preset_names};
use pyo3::exceptions::PyKeyError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyIterator, PyTuple};
use pythonize::pythonize;

use crate::error::{ConfigurationError, of_configuration, of_run};
use crate::heard::heard;
use crate::helped;
use crate::value::settings;

/// A configuration that has passed every check; it does not change.
///
/// A mapping from dotted keys to resolved values: ``configuration["drive.width"]``; the name of a table gives the table,
/// ``configuration["drive"]``. It can be hashed, compared, copied and pickled. ``str(configuration)`` is TOML.
///
/// Parameters
/// ----------
/// preset : str, optional
///     One of `peristalsis.presets()`.
/// overrides : mapping, optional
///     Values of dotted keys, over preset and text.
/// text : str, optional
///     A configuration in TOML, over the preset.
/// name : str
///     What errors call the text: the name of its file.
/// **keywords
///     Values of keys by their last word, as of `Simulation.preset`.
///
/// Its items are the dotted keys, each with a value. The tables that hold them (``"drive"``) can be asked for, too, and are
/// dictionaries.
///
/// Raises
/// ------
/// ConfigurationError
///     Where a key is unknown or a value not allowed: the key, where it was given, and what is allowed.
///
/// Examples
/// --------
/// >>> import peristalsis
/// >>> configuration = peristalsis.Configuration("frictionless", width=2.6, waves=2)
/// >>> configuration["drive.width"], configuration["tube"]["waves"], "contact.law" in configuration
/// (2.6, 2, True)
/// >>> configuration.replace(width=2.5)["drive.width"]
/// 2.5
#[pyclass(frozen, eq, hash, module = "peristalsis._core")]
pub(crate) struct Configuration {
    pub(crate) inner: peristalsis_configuration::Configuration,
}

// By the bits of every value, as the hash that names runs of studies.
impl PartialEq for Configuration {
    fn eq(&self, other: &Self) -> bool {
        self.inner.run_hash() == other.inner.run_hash()
    }
}

impl Hash for Configuration {
    fn hash<H: Hasher>(&self, state: &mut H) {
        self.inner.run_hash().hash(state);
    }
}

impl Configuration {
    /// The keys with their resolved values, table by table, read from the canonical text.
    fn tables(&self) -> toml::Table {
        let text = self.inner.to_toml();
        let mut tables: toml::Table = text.parse().expect("our own text is TOML");
        // Derived from the others.
        tables.remove("resolved");
        tables
    }

    /// Dotted keys with their values.
    fn entries(&self) -> Vec<(String, toml::Value)> {
        let mut entries = Vec::new();
        for (name, value) in self.tables() {
            flatten(name, value, &mut entries);
        }
        entries
    }

    /// The value of a dotted key, or the table of that name; none of what is no text.
    fn value_of(&self, key: &Bound<'_, PyAny>) -> Option<toml::Value> {
        let key: String = key.extract().ok()?;
        let mut value = toml::Value::Table(self.tables());
        for word in key.split('.') {
            value = value.as_table_mut()?.remove(word)?;
        }
        Some(value)
    }
}

fn flatten(key: String, value: toml::Value, entries: &mut Vec<(String, toml::Value)>) {
    match value {
        toml::Value::Table(table) => {
            for (word, value) in table {
                flatten(format!("{key}.{word}"), value, entries);
            }
        }
        value => entries.push((key, value)),
    }
}

/// Dotted keys and keywords as one dictionary.
fn joined<'py>(
    py: Python<'py>,
    overrides: Option<&Bound<'py, PyAny>>,
    keywords: Option<&Bound<'py, PyDict>>,
) -> PyResult<Bound<'py, PyDict>> {
    let keywords = keywords.cloned().unwrap_or_else(|| PyDict::new(py));
    let module = py.import("peristalsis._keywords")?;
    let joined = module.call_method1("overrides", (overrides, keywords))?;
    Ok(joined.cast_into()?)
}

#[pymethods]
impl Configuration {
    #[new]
    #[pyo3(signature = (preset=None, overrides=None, text=None, name="text", **keywords))]
    fn new(
        py: Python<'_>,
        preset: Option<&str>,
        overrides: Option<&Bound<'_, PyAny>>,
        text: Option<&str>,
        name: &str,
        keywords: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<Self> {
        let overrides = settings(&joined(py, overrides, keywords)?)?;
        if let Some((reason, help)) = text.and_then(|text| not_of_one_run(name, text)) {
            return Err(ConfigurationError::new_err(format!(
                "{reason}\n  help: {help}"
            )));
        }
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
    ///
    /// Returns
    /// -------
    /// str
    ///     The text of a configuration file: ``peristalsis run`` gives the same bits with it.
    ///
    /// Examples
    /// --------
    /// >>> import peristalsis
    /// >>> configuration = peristalsis.Configuration("frictionless")
    /// >>> peristalsis.Configuration(text=configuration.to_toml()) == configuration
    /// True
    fn to_toml(&self) -> String {
        self.inner.to_toml()
    }

    /// Every resolved value, table by table.
    ///
    /// Returns
    /// -------
    /// dict
    ///     Nested as the tables of the file are.
    ///
    /// Examples
    /// --------
    /// >>> import peristalsis
    /// >>> peristalsis.Configuration("frictionless").to_dict()["contact"]["law"]
    /// 'linear'
    fn to_dict<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        Ok(pythonize(py, &self.tables())?)
    }

    /// The same configuration with some values replaced.
    ///
    /// Parameters
    /// ----------
    /// overrides : mapping, optional
    ///     Values of dotted keys.
    /// **keywords
    ///     Values of keys by their last word.
    ///
    /// Returns
    /// -------
    /// Configuration
    ///     All other values stay as they were resolved: the number of grains too, so give ``volume_fraction`` again
    ///     where the tube changes and the fraction should not. With ``[units]`` all numbers stay as they are in d, m and t:
    ///     where a unit changes (``units.stiffness`` does), give gravity and ``units.wave_frequency`` again, or they change
    ///     in SI. So does a damping that followed from ``restitution``.
    ///
    /// Raises
    /// ------
    /// ConfigurationError
    ///     Where a key is unknown or a value not allowed.
    ///
    /// Examples
    /// --------
    /// >>> import peristalsis
    /// >>> configuration = peristalsis.Configuration("frictionless", seed=1)
    /// >>> configuration.replace(width=2.5, seed=2)["run.seed"]
    /// 2
    #[pyo3(signature = (overrides=None, **keywords))]
    fn replace(
        &self,
        py: Python<'_>,
        overrides: Option<&Bound<'_, PyAny>>,
        keywords: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<Self> {
        let text = self.inner.to_toml();
        Self::new(py, None, overrides, Some(&text), "configuration", keywords)
    }

    fn __getitem__<'py>(
        &self,
        py: Python<'py>,
        key: &Bound<'py, PyAny>,
    ) -> PyResult<Bound<'py, PyAny>> {
        match self.value_of(key) {
            Some(value) => Ok(pythonize(py, &value)?),
            None => {
                let module = py.import("peristalsis._keywords")?;
                let reason = module.call_method1("missing", (key, self.keys()))?;
                Err(PyKeyError::new_err(reason.unbind()))
            }
        }
    }

    fn __contains__(&self, key: &Bound<'_, PyAny>) -> bool {
        self.value_of(key).is_some()
    }

    fn __len__(&self) -> usize {
        self.entries().len()
    }

    fn __iter__<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyIterator>> {
        self.keys().into_pyobject(py)?.try_iter()
    }

    /// The dotted keys.
    ///
    /// Returns
    /// -------
    /// list of str
    ///
    /// Examples
    /// --------
    /// >>> import peristalsis
    /// >>> "tube.waves" in peristalsis.Configuration("frictionless").keys()
    /// True
    fn keys(&self) -> Vec<String> {
        self.entries().into_iter().map(|(key, _)| key).collect()
    }

    /// The resolved values, in the order of `keys`.
    ///
    /// Returns
    /// -------
    /// list
    ///     Numbers, texts, truth values and lists.
    ///
    /// Examples
    /// --------
    /// >>> import peristalsis
    /// >>> "linear" in peristalsis.Configuration("frictionless").values()
    /// True
    fn values<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyAny>>> {
        let entries = self.entries().into_iter();
        entries
            .map(|(_, value)| Ok(pythonize(py, &value)?))
            .collect()
    }

    /// The dotted keys with their values.
    ///
    /// Returns
    /// -------
    /// list of (str, value)
    ///
    /// Examples
    /// --------
    /// >>> import peristalsis
    /// >>> dict(peristalsis.Configuration("frictionless").items())["contact.law"]
    /// 'linear'
    fn items<'py>(&self, py: Python<'py>) -> PyResult<Vec<(String, Bound<'py, PyAny>)>> {
        let entries = self.entries().into_iter();
        entries
            .map(|(key, value)| Ok((key, pythonize(py, &value)?)))
            .collect()
    }

    /// The value of a key, or something else where there is no such key.
    ///
    /// Parameters
    /// ----------
    /// key : str
    ///     A dotted key, or the name of a table.
    /// default : object, optional
    ///     The answer without such a key.
    ///
    /// Returns
    /// -------
    /// object
    ///     The value.
    ///
    /// Examples
    /// --------
    /// >>> import peristalsis
    /// >>> peristalsis.Configuration("frictionless").get("drive.force_amplitude", 0.0)
    /// 0.0
    #[pyo3(signature = (key, default=None))]
    fn get<'py>(
        &self,
        py: Python<'py>,
        key: &Bound<'py, PyAny>,
        default: Option<Bound<'py, PyAny>>,
    ) -> PyResult<Option<Bound<'py, PyAny>>> {
        match self.value_of(key) {
            Some(value) => Ok(Some(pythonize(py, &value)?)),
            None => Ok(default),
        }
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        helped(slf, "configuration_reduced")
    }

    fn __str__(&self) -> String {
        self.to_toml()
    }

    fn __repr__<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        helped(slf, "configuration_text")
    }

    fn _repr_html_<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        helped(slf, "configuration_html")
    }

    /// Number of grains N.
    ///
    /// Examples
    /// --------
    /// >>> import peristalsis
    /// >>> peristalsis.Configuration("frictionless", number=40).grains
    /// 40
    #[getter]
    fn grains(&self) -> u64 {
        self.inner.grains.number
    }

    /// Waves in the tube.
    ///
    /// Examples
    /// --------
    /// >>> import peristalsis
    /// >>> peristalsis.Configuration("frictionless", waves=2).waves
    /// 2
    #[getter]
    fn waves(&self) -> u32 {
        self.inner.tube.waves
    }

    /// Seed of the random numbers.
    ///
    /// Examples
    /// --------
    /// >>> import peristalsis
    /// >>> peristalsis.Configuration("frictionless", seed=7).seed
    /// 7
    #[getter]
    fn seed(&self) -> u64 {
        self.inner.run.seed
    }

    /// Volume fraction of a straight tube, rho = N d_i^3/(6 a^2 L), d_i^3 averaged.
    ///
    /// Examples
    /// --------
    /// >>> import peristalsis
    /// >>> round(peristalsis.Configuration("frictionless", volume_fraction=0.3).volume_fraction, 2)
    /// 0.3
    #[getter]
    fn volume_fraction(&self) -> f64 {
        self.inner.volume_fraction()
    }

    /// Steps of the configured run.
    ///
    /// Examples
    /// --------
    /// >>> import peristalsis
    /// >>> configuration = peristalsis.Configuration("frictionless", periods=3, strain_rate=0.1)
    /// >>> configuration.steps == round(3 / 0.1 / configuration.time_step)
    /// True
    #[getter]
    fn steps(&self) -> u64 {
        self.inner.run.steps()
    }

    /// Length of a step [t].
    ///
    /// Examples
    /// --------
    /// >>> import peristalsis
    /// >>> peristalsis.Configuration("frictionless", time_step=0.01).time_step
    /// 0.01
    #[getter]
    fn time_step(&self) -> f64 {
        self.inner.run.time_step
    }

    /// Length L of the tube [d].
    ///
    /// Examples
    /// --------
    /// >>> import peristalsis
    /// >>> configuration = peristalsis.Configuration("frictionless", waves=2)
    /// >>> configuration.length == 2 * configuration["tube.wavelength"]
    /// True
    #[getter]
    fn length(&self) -> f64 {
        self.inner.tube.length()
    }

    /// What looks doubtful, each with the key to change: all that can be known before the grains are packed.
    ///
    /// `check` tries the run for a moment and lists what that has seen as well.
    ///
    /// Examples
    /// --------
    /// >>> import peristalsis
    /// >>> [warning.key for warning in peristalsis.Configuration("frictionless", time_step=0.3).warnings]
    /// ['run.time_step']
    #[getter]
    fn warnings<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        let named = py
            .import("peristalsis._warnings")?
            .getattr("KeyedWarning")?;
        let warnings = peristalsis_run::warnings(&self.inner).into_iter();
        let warnings = warnings.map(|it| named.call1((it.key, it.message)));
        PyTuple::new(py, warnings.collect::<PyResult<Vec<_>>>()?)
    }

    /// What would run, how long it would take, and what looks doubtful: as ``peristalsis check --json``.
    ///
    /// It packs the grains and tries the run for a second.
    ///
    /// Returns
    /// -------
    /// dict
    ///     Among others ``expected_seconds`` and ``packing_seconds`` on this machine, ``memory_bytes``, ``restitution``,
    ///     ``contact_time`` [t], and ``warnings``: a list of dictionaries with ``key`` and ``message``, those of `warnings`
    ///     and those of the trial, such as grains that overlap or leave the tube.
    ///
    /// Raises
    /// ------
    /// DoesNotFitError
    ///     Where the tube does not hold the grains.
    ///
    /// Examples
    /// --------
    /// >>> import peristalsis
    /// >>> report = peristalsis.Configuration("frictionless", waves=2, width=1.4, strain_rate=0.2).check()
    /// >>> report["grains"], [warning["key"] for warning in report["warnings"]]
    /// (41, ['tube.rings_per_wave', 'drive.strain_rate', 'tube.rings_per_wave'])
    fn check<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let configuration = self.inner.clone();
        let estimate = heard(py, move || peristalsis_run::estimate(&configuration, None))?;
        Ok(pythonize(py, &estimate.map_err(of_run)?)?)
    }
}

/// Names of the presets.
///
/// Returns
/// -------
/// list of str
///     What `Simulation.preset` takes.
///
/// Examples
/// --------
/// >>> import peristalsis
/// >>> peristalsis.presets()
/// ['frictionless', 'frictionless-source', 'frictionless-fine', 'frictional', 'sand-pump', 'soft-robot', 'silo', 'oesophagus']
#[pyfunction]
pub(crate) fn presets() -> Vec<&'static str> {
    preset_names()
}
