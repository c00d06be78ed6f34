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
use numpy::{Element, PyArray1, PyArrayMethods};
use peristalsis_formats::{FormatError, Values};
use pyo3::exceptions::{PyKeyError, PyRuntimeError};
use pyo3::prelude::*;
use pyo3::types::{IntoPyDict, PyCapsule, PyDict};

/// Columns of equal length; pandas, polars, pyarrow and DuckDB take it as it is.
#[pyclass(frozen, module = "peristalsis._core")]
pub(crate) struct Table {
    batch: RecordBatch,
}

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

fn failed(error: impl std::fmt::Display) -> PyErr {
    PyRuntimeError::new_err(error.to_string())
}

#[pymethods]
impl Table {
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

    fn __contains__(&self, name: &str) -> bool {
        self.batch.column_by_name(name).is_some()
    }

    /// A column as a new NumPy array (numbers; NaN where one is missing) or list.
    fn __getitem__<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyAny>> {
        let column = self.batch.column_by_name(name).ok_or_else(|| {
            let known = self.column_names().join(", ");
            PyKeyError::new_err(format!("there is no column {name:?}; there are {known}"))
        })?;
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

    /// Names of the columns.
    #[getter]
    fn column_names(&self) -> Vec<String> {
        let schema = self.batch.schema();
        let fields = schema.fields().iter();
        fields.map(|field| field.name().clone()).collect()
    }

    /// Unit of each column; "1" for a pure number.
    #[getter]
    fn units<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        self.about(py, "unit")
    }

    /// Meaning of each column.
    #[getter]
    fn descriptions<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        self.about(py, "description")
    }

    /// Version, revision and configuration that the table comes from.
    #[getter]
    fn metadata(&self) -> HashMap<String, String> {
        self.batch.schema().metadata().clone().into()
    }

    fn __repr__(&self) -> String {
        let (rows, names) = (self.batch.num_rows(), self.column_names().join(", "));
        format!("<peristalsis.Table: {rows} rows of {names}>")
    }
}

impl Table {
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
