//! Tables as Arrow, by its PyCapsule interface.

use std::collections::HashMap;
use std::sync::Arc;

use arrow_array::ffi::FFI_ArrowSchema;
use arrow_array::ffi_stream::FFI_ArrowArrayStream;
use arrow_array::{
    Array, ArrayRef, BooleanArray, Float64Array, Int64Array, RecordBatch, RecordBatchIterator,
    StringArray,
};
use arrow_schema::{Field, Schema};
use numpy::{Element, PyArray1, PyArrayMethods, PyReadonlyArray1};
use peristalsis_formats::{Column, FormatError, Values};
use pyo3::exceptions::{PyKeyError, PyRuntimeError, PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{IntoPyDict, PyCapsule, PyDict, PyIterator};

use crate::helped;

/// Columns of equal length with their units; it does not change.
///
/// As a data frame does, it iterates over the names of its columns and is as long as it has rows; ``dict(table)`` is a
/// dictionary of arrays. ``pandas.DataFrame(table)`` works with any pandas from 2 on (of a table without rows it makes a frame
/// without columns; `to_pandas` keeps them), and by Arrow's PyCapsule interface ``pyarrow.table(table)``,
/// ``polars.DataFrame(table)`` and DuckDB take it without a copy. It can be pickled and compared. A number that is missing
/// is NaN in NumPy and pandas, null in Arrow and polars.
///
/// Examples
/// --------
/// >>> import peristalsis
/// >>> sim = peristalsis.Simulation.preset("frictionless", waves=2, seed=1)
/// >>> sim.run(periods=2)
/// >>> table = sim.timeseries()
/// >>> len(table), "flow_rate" in table, table.units["flow_rate"]
/// (40, True, '1/t')
/// >>> table["time"].shape
/// (40,)
#[pyclass(frozen, eq, module = "peristalsis._core")]
#[derive(PartialEq)]
pub(crate) struct Table {
    batch: RecordBatch,
}

/// A column from Python: name, unit, description, values.
type Given<'py> = (String, String, String, Bound<'py, PyAny>);

impl Table {
    /// A table of ours; a missing number (NaN) becomes a null, as in Parquet.
    pub(crate) fn new(table: &peristalsis_formats::Table) -> PyResult<Self> {
        let (fields, columns): (Vec<Field>, Vec<ArrayRef>) = table
            .columns()
            .iter()
            .map(|column| {
                let values = array(&column.values);
                let about = HashMap::from([
                    ("unit".to_owned(), column.unit.clone()),
                    ("description".to_owned(), column.description.clone()),
                ]);
                let field = Field::new(&column.name, values.data_type().clone(), true);
                (field.with_metadata(about), values)
            })
            .unzip();
        let about: HashMap<String, String> = table.metadata().clone().into_iter().collect();
        let schema = Schema::new(fields).with_metadata(about);
        let batch = RecordBatch::try_new(Arc::new(schema), columns).map_err(failed)?;
        Ok(Self { batch })
    }

    /// The same of a table that was just made.
    pub(crate) fn made(table: Result<peristalsis_formats::Table, FormatError>) -> PyResult<Self> {
        Self::new(&table.map_err(failed)?)
    }
}

fn array(values: &Values) -> ArrayRef {
    match values {
        Values::Real(values) => {
            let is_missing = values.iter().any(|value| value.is_nan());
            let present = || values.iter().map(|value| !value.is_nan()).collect();
            let present = is_missing.then(present);
            Arc::new(Float64Array::new(values.clone().into(), present))
        }
        Values::Integer(values) => Arc::new(Int64Array::from(values.clone())),
        Values::Text(values) => Arc::new(StringArray::from(values.clone())),
        Values::Boolean(values) => Arc::new(BooleanArray::from(values.clone())),
    }
}

/// Values of a column from an array of NumPy, or from a list of texts.
fn values(name: &str, given: &Bound<'_, PyAny>) -> PyResult<Values> {
    let kinds = "an array of float64, int64 or bool, or a list of texts";
    let helpers = given.py().import("peristalsis._given")?;
    helpers.call_method1("unmasked", (format!("column {name}"), given))?;
    if let Ok(reals) = given.extract::<PyReadonlyArray1<'_, f64>>() {
        return Ok(Values::Real(reals.as_slice()?.to_vec()));
    }
    if let Ok(integers) = given.extract::<PyReadonlyArray1<'_, i64>>() {
        return Ok(Values::Integer(integers.as_slice()?.to_vec()));
    }
    if let Ok(truths) = given.extract::<PyReadonlyArray1<'_, bool>>() {
        return Ok(Values::Boolean(truths.as_slice()?.to_vec()));
    }
    let texts = given.extract().map(Values::Text);
    texts.map_err(|_| PyTypeError::new_err(format!("column {name} must be {kinds}")))
}

fn failed(error: impl std::fmt::Display) -> PyErr {
    PyRuntimeError::new_err(error.to_string())
}

#[pymethods]
impl Table {
    /// A table from its columns (name, unit, description, values), as a pickle holds them.
    #[new]
    #[pyo3(signature = (columns, metadata=None))]
    fn from_columns(
        columns: Vec<Given<'_>>,
        metadata: Option<HashMap<String, String>>,
    ) -> PyResult<Self> {
        let columns = columns.into_iter().map(|(name, unit, description, given)| {
            let values = values(&name, &given)?;
            Ok(Column {
                name,
                unit,
                description,
                values,
            })
        });
        let columns = columns.collect::<PyResult<Vec<_>>>()?;
        let mut table = peristalsis_formats::Table::builder().columns(columns);
        for (key, value) in metadata.unwrap_or_default() {
            table = table.metadata(key, value);
        }
        let table = table.build();
        Self::new(&table.map_err(|error| PyValueError::new_err(error.to_string()))?)
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        helped(slf, "reduced")
    }

    /// The table as a stream of record batches (one), without a copy.
    #[pyo3(signature = (requested_schema=None))]
    fn __arrow_c_stream__<'py>(
        &self,
        py: Python<'py>,
        requested_schema: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyCapsule>> {
        // A producer need not follow the request; the consumer casts.
        let _ = requested_schema;
        let batches = RecordBatchIterator::new([Ok(self.batch.clone())], self.batch.schema());
        let stream = FFI_ArrowArrayStream::new(Box::new(batches));
        PyCapsule::new_with_value(py, stream, c"arrow_array_stream")
    }

    /// Names and kinds of the columns.
    fn __arrow_c_schema__<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyCapsule>> {
        let schema = FFI_ArrowSchema::try_from(self.batch.schema().as_ref()).map_err(failed)?;
        PyCapsule::new_with_value(py, schema, c"arrow_schema")
    }

    fn __len__(&self) -> usize {
        self.batch.num_rows()
    }

    fn __contains__(&self, name: &Bound<'_, PyAny>) -> bool {
        let name = name.extract::<String>();
        name.is_ok_and(|name| self.batch.column_by_name(&name).is_some())
    }

    /// Names of the columns.
    fn __iter__<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyIterator>> {
        self.column_names().into_pyobject(py)?.try_iter()
    }

    /// Rows as objects, which is how ``pandas.DataFrame(table)`` takes them; `to_pandas` is faster.
    #[pyo3(signature = (dtype=None, copy=None))]
    fn __array__<'py>(
        slf: &Bound<'py, Self>,
        dtype: Option<&Bound<'py, PyAny>>,
        copy: Option<bool>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let _ = (dtype, copy);
        helped(slf, "rows")
    }

    /// Names of the columns, as `column_names`.
    ///
    /// Returns
    /// -------
    /// list of str
    ///
    /// Examples
    /// --------
    /// >>> import peristalsis
    /// >>> peristalsis.Simulation.preset("frictionless", waves=2).timeseries().keys()[:2]
    /// ['time', 'period']
    fn keys(&self) -> Vec<String> {
        self.column_names()
    }

    /// The columns.
    ///
    /// Returns
    /// -------
    /// list of ndarray or list of str
    ///     Each of shape (rows,).
    ///
    /// Examples
    /// --------
    /// >>> import peristalsis
    /// >>> table = peristalsis.Simulation.preset("frictionless", waves=2).timeseries()
    /// >>> len(table.values()) == len(table.keys())
    /// True
    fn values<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyAny>>> {
        let names = self.column_names();
        names.iter().map(|name| self.column(py, name)).collect()
    }

    /// The columns with their names.
    ///
    /// Returns
    /// -------
    /// list of (str, ndarray or list of str)
    ///
    /// Examples
    /// --------
    /// >>> import peristalsis
    /// >>> table = peristalsis.Simulation.preset("frictionless", waves=2).timeseries()
    /// >>> [name for name, column in table.items()] == table.keys()
    /// True
    fn items<'py>(&self, py: Python<'py>) -> PyResult<Vec<(String, Bound<'py, PyAny>)>> {
        let names = self.column_names().into_iter();
        let items = names.map(|name| self.column(py, &name).map(|column| (name, column)));
        items.collect()
    }

    /// The columns as a dictionary, as ``dict(table)`` gives it.
    ///
    /// Returns
    /// -------
    /// dict of str to ndarray or list of str
    ///     New arrays of shape (rows,), in the order of the columns.
    ///
    /// Examples
    /// --------
    /// >>> import peristalsis
    /// >>> table = peristalsis.Simulation.preset("frictionless", waves=2).timeseries()
    /// >>> table.to_dict()["time"].dtype
    /// dtype('float64')
    fn to_dict<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        self.items(py)?.into_py_dict(py)
    }

    /// The table as a frame of pandas, of any version from 2 on.
    ///
    /// Returns
    /// -------
    /// pandas.DataFrame
    ///     Its ``attrs`` hold the dictionaries ``units``, ``descriptions`` and ``metadata``.
    ///
    /// Raises
    /// ------
    /// ImportError
    ///     Where pandas is not installed.
    ///
    /// Examples
    /// --------
    /// >>> import peristalsis
    /// >>> frame = peristalsis.Simulation.preset("frictionless", waves=2).timeseries().to_pandas()
    /// >>> frame.attrs["units"]["time"]
    /// 't'
    fn to_pandas<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        helped(slf, "to_pandas")
    }

    /// The table as a frame of polars, without a copy.
    ///
    /// Returns
    /// -------
    /// polars.DataFrame
    ///     A frame of polars has no place for units: they stay in `units`.
    ///
    /// Raises
    /// ------
    /// ImportError
    ///     Where polars is not installed.
    ///
    /// Examples
    /// --------
    /// >>> import peristalsis
    /// >>> table = peristalsis.Simulation.preset("frictionless", waves=2).timeseries()
    /// >>> table.to_polars().columns == table.column_names
    /// True
    fn to_polars<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        helped(slf, "to_polars")
    }

    /// The table as a data set of xarray.
    ///
    /// Returns
    /// -------
    /// xarray.Dataset
    ///     One variable a column, with its unit and meaning as ``attrs["units"]`` and ``attrs["long_name"]``, which
    ///     xarray writes at axes. Its dimension is the first column where that rises from row to row, such as the time,
    ///     otherwise ``row``.
    ///
    /// Raises
    /// ------
    /// ImportError
    ///     Where xarray is not installed.
    ///
    /// Examples
    /// --------
    /// >>> import peristalsis
    /// >>> sim = peristalsis.Simulation.preset("frictionless", waves=2)
    /// >>> sim.run(periods=1)
    /// >>> data = sim.timeseries().to_xarray()
    /// >>> list(data.dims), data["flow_rate"].attrs["units"]
    /// (['time'], '1/t')
    fn to_xarray<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        helped(slf, "to_xarray")
    }

    /// A column as a new NumPy array (numbers; NaN where one is missing) or list.
    fn __getitem__<'py>(
        &self,
        py: Python<'py>,
        name: &Bound<'py, PyAny>,
    ) -> PyResult<Bound<'py, PyAny>> {
        match name.extract::<String>() {
            Ok(name) => self.column(py, &name),
            Err(_) => Err(self.no_column(&name.repr()?.to_string_lossy())),
        }
    }

    /// Names of the columns.
    ///
    /// Examples
    /// --------
    /// >>> import peristalsis
    /// >>> peristalsis.Simulation.preset("frictionless", waves=2).timeseries().column_names[0]
    /// 'time'
    #[getter]
    fn column_names(&self) -> Vec<String> {
        let schema = self.batch.schema();
        let fields = schema.fields().iter();
        fields.map(|field| field.name().clone()).collect()
    }

    /// Unit of each column in m, d, t; "1" for a pure number, empty for words.
    ///
    /// Examples
    /// --------
    /// >>> import peristalsis
    /// >>> peristalsis.Simulation.preset("frictionless", waves=2).timeseries().units["flow_rate_ratio"]
    /// '1'
    #[getter]
    fn units<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        self.about(py, "unit")
    }

    /// Meaning of each column.
    ///
    /// Examples
    /// --------
    /// >>> import peristalsis
    /// >>> table = peristalsis.Simulation.preset("frictionless", waves=2).timeseries()
    /// >>> sorted(table.descriptions) == sorted(table.column_names)
    /// True
    #[getter]
    fn descriptions<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        self.about(py, "description")
    }

    /// Version, revision and configuration that the table comes from.
    ///
    /// Examples
    /// --------
    /// >>> import peristalsis
    /// >>> table = peristalsis.Simulation.preset("frictionless", waves=2).timeseries()
    /// >>> "[drive]" in table.metadata["peristalsis.configuration"]
    /// True
    #[getter]
    fn metadata(&self) -> HashMap<String, String> {
        self.batch.schema().metadata().clone().into()
    }

    fn __repr__<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        helped(slf, "text")
    }

    fn _repr_html_<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        helped(slf, "html_text")
    }
}

impl Table {
    fn no_column(&self, name: &str) -> PyErr {
        let known = self.column_names().join(", ");
        PyKeyError::new_err(format!("there is no column {name}; there are {known}"))
    }

    fn column<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyAny>> {
        let column = self.batch.column_by_name(name);
        let column = column.ok_or_else(|| self.no_column(&format!("{name:?}")))?;
        let column = column.as_any();
        if let Some(reals) = column.downcast_ref::<Float64Array>() {
            return Ok(PyArray1::from_slice(py, reals.values()).into_any());
        }
        if let Some(integers) = column.downcast_ref::<Int64Array>() {
            return Ok(PyArray1::from_slice(py, integers.values()).into_any());
        }
        if let Some(truths) = column.downcast_ref::<BooleanArray>() {
            let truths: Vec<bool> = truths.values().iter().collect();
            return Ok(PyArray1::from_vec(py, truths).into_any());
        }
        let texts: Vec<Option<String>> = column
            .downcast_ref::<StringArray>()
            .map(|texts| texts.iter().map(|text| text.map(str::to_owned)).collect())
            .unwrap_or_default();
        Ok(texts.into_pyobject(py)?.into_any())
    }

    fn about<'py>(&self, py: Python<'py>, what: &str) -> PyResult<Bound<'py, PyDict>> {
        let schema = self.batch.schema();
        let fields = schema.fields().iter();
        let about = fields.map(|field| (field.name(), field.metadata().get(what)));
        about.into_py_dict(py)
    }
}

/// Numbers as a new array of NumPy that cannot be written to.
pub(crate) fn read_only<T: Element>(py: Python<'_>, values: Vec<T>) -> Bound<'_, PyArray1<T>> {
    let array = PyArray1::from_vec(py, values);
    array.readwrite().make_nonwriteable();
    array
}
