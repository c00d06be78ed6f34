//! Parquet: a [`Table`] with its units, descriptions and metadata, exact to the bit.
//!
//! Unit and description of a column are its Arrow field metadata `unit` and `description`; the metadata of the table are
//! the key/value metadata of the file and of its Arrow schema. A missing real is null.
//!
//! Between the opening `PAR1` and the first column, where every reader skips it, a file of this crate carries a *seal*:
//! twelve bytes of signature and the CRC-32 of all other bytes of the file. A file that changed on disk is thus an error
//! and never a result, and it is refused before the Parquet library, which panics on some damaged files, gets to see it.
//! A file without a seal, from another program, is read unchecked: if it makes the library panic, that is caught and
//! returned as an error (the panic hook still runs), but its false lengths may demand much memory.

use std::fs;
use std::ops::Range;
use std::panic;
use std::path::Path;
use std::sync::Arc;

use ::parquet::arrow::ArrowWriter;
use ::parquet::arrow::arrow_reader::ParquetRecordBatchReaderBuilder;
use ::parquet::basic::Compression;
use ::parquet::errors::ParquetError;
use ::parquet::file::metadata::KeyValue;
use ::parquet::file::properties::WriterProperties;
use ::parquet::schema::types::ColumnPath;
use arrow_array::{
    Array, ArrayRef, BooleanArray, Float64Array, Int64Array, LargeStringArray, RecordBatch,
    StringArray,
};
use arrow_schema::{DataType, Field, Schema};
use bytes::Bytes;

use crate::atomic;
use crate::error::FormatError;
use crate::table::{Column, Table, ValueKind, Values, is_reserved};

const UNIT_KEY: &str = "unit";
const DESCRIPTION_KEY: &str = "description";
/// What stands in bytes 4 to 16 of a sealed file; the checksum follows in bytes 16 to 20.
const SEAL_SIGNATURE: [u8; 12] = *b"\x89peristalsis";
const SEAL_SIGNATURE_RANGE: Range<usize> = 4..16;
const SEAL_CHECKSUM_RANGE: Range<usize> = 16..20;

/// The table as the bytes of a Parquet file; the same table gives the same bytes.
///
/// # Errors
/// [`FormatError::Parquet`].
pub fn encode(table: &Table) -> Result<Vec<u8>, FormatError> {
    // Arrow readers take the metadata from the schema, all others from the key/value pairs of the file: hence in both.
    let fields: Vec<Field> = table.columns().iter().map(field_of).collect();
    let schema = Arc::new(Schema::new(fields).with_metadata(table.metadata().clone()));
    let arrays = table
        .columns()
        .iter()
        .map(|column| array_of(&column.values))
        .collect();
    let batch = RecordBatch::try_new(Arc::clone(&schema), arrays).map_err(ParquetError::from)?;
    let mut writer = ArrowWriter::try_new(Vec::new(), schema, Some(properties_of(table)))?;
    writer
        .write_all(&SEAL_SIGNATURE)
        .map_err(ParquetError::from)?;
    writer
        .write_all(&[0; SEAL_CHECKSUM_RANGE.end - SEAL_CHECKSUM_RANGE.start])
        .map_err(ParquetError::from)?;
    writer.write(&batch)?;
    let mut bytes = writer.into_inner()?;
    let checksum = checksum_of(&bytes).to_le_bytes();
    bytes[SEAL_CHECKSUM_RANGE].copy_from_slice(&checksum);
    Ok(bytes)
}

/// The table in the bytes of a Parquet file.
///
/// Columns of 64-bit reals and integers, booleans and text are read; only reals may have nulls.
///
/// # Errors
/// [`FormatError::CorruptParquet`], [`FormatError::Parquet`], [`FormatError::UnsupportedParquet`].
pub fn decode(bytes: Vec<u8>) -> Result<Table, FormatError> {
    if bytes.get(SEAL_SIGNATURE_RANGE) == Some(&SEAL_SIGNATURE) {
        let unbroken = bytes
            .get(SEAL_CHECKSUM_RANGE)
            .is_some_and(|seal| seal == checksum_of(&bytes).to_le_bytes());
        if !unbroken {
            let reason = "it is cut short or changed, by its checksum".into();
            return Err(FormatError::CorruptParquet { reason });
        }
    }
    panic::catch_unwind(|| decode_unchecked(bytes)).unwrap_or_else(|_| {
        Err(FormatError::CorruptParquet {
            reason: "its structure contradicts itself".into(),
        })
    })
}

fn decode_unchecked(bytes: Vec<u8>) -> Result<Table, FormatError> {
    let builder = ParquetRecordBatchReaderBuilder::try_new(Bytes::from(bytes))?;
    let entries = builder
        .metadata()
        .file_metadata()
        .key_value_metadata()
        .cloned()
        .unwrap_or_default();
    let mut columns = builder
        .schema()
        .fields()
        .iter()
        .map(|field| column_of(field))
        .collect::<Result<Vec<_>, _>>()?;
    for batch in builder.build()? {
        let batch = batch.map_err(ParquetError::from)?;
        for (column, array) in columns.iter_mut().zip(batch.columns()) {
            extend(column, array)?;
        }
    }
    let mut table = Table::builder().columns(columns);
    for KeyValue { key, value } in entries {
        if !is_reserved(&key) {
            table = table.metadata(key, value.unwrap_or_default());
        }
    }
    table.build()
}

/// Writes the table to a Parquet file, whole or not at all.
///
/// # Errors
/// As [`encode`] and [`atomic::write`](fn@atomic::write).
pub fn write(path: &Path, table: &Table) -> Result<(), FormatError> {
    atomic::write(path, &encode(table)?)
}

/// Reads the table from a Parquet file; see [`decode`].
///
/// # Errors
/// As [`decode`], and [`FormatError::Io`].
pub fn read(path: &Path) -> Result<Table, FormatError> {
    decode(fs::read(path).map_err(FormatError::io("read", path))?)
}

fn field_of(column: &Column) -> Field {
    let (data_type, nullable) = match column.values.kind() {
        ValueKind::Real => (DataType::Float64, true),
        ValueKind::Integer => (DataType::Int64, false),
        ValueKind::Text => (DataType::Utf8, false),
        ValueKind::Boolean => (DataType::Boolean, false),
    };
    let metadata = [
        (UNIT_KEY, column.unit.as_str()),
        (DESCRIPTION_KEY, column.description.as_str()),
    ];
    Field::new(&column.name, data_type, nullable).with_metadata(metadata)
}

fn array_of(values: &Values) -> ArrayRef {
    match values {
        Values::Real(values) => Arc::new(
            values
                .iter()
                .map(|value| (!value.is_nan()).then_some(*value))
                .collect::<Float64Array>(),
        ),
        Values::Integer(values) => Arc::new(Int64Array::from(values.clone())),
        Values::Text(values) => Arc::new(StringArray::from_iter_values(values)),
        Values::Boolean(values) => Arc::new(BooleanArray::from(values.clone())),
    }
}

fn properties_of(table: &Table) -> WriterProperties {
    let entries = table
        .metadata()
        .iter()
        .map(|(key, value)| KeyValue::new(key.clone(), value.clone()));
    let mut properties = WriterProperties::builder()
        .set_compression(Compression::SNAPPY)
        .set_key_value_metadata(Some(entries.collect()));
    for column in table.columns() {
        // Measured reals hardly repeat: a dictionary of them would be larger than the values.
        if column.values.kind() == ValueKind::Real {
            properties = properties
                .set_column_dictionary_enabled(ColumnPath::from(column.name.as_str()), false);
        }
    }
    properties.build()
}

/// The CRC-32 of the bytes of a file before and after the checksum in its seal.
fn checksum_of(bytes: &[u8]) -> u32 {
    let mut hasher = crc32fast::Hasher::new();
    hasher.update(&bytes[..SEAL_CHECKSUM_RANGE.start]);
    hasher.update(&bytes[SEAL_CHECKSUM_RANGE.end..]);
    hasher.finalize()
}

/// A column without rows, for a field of the file.
fn column_of(field: &Field) -> Result<Column, FormatError> {
    let kind = match field.data_type() {
        DataType::Float64 => ValueKind::Real,
        DataType::Int64 => ValueKind::Integer,
        DataType::Utf8 | DataType::LargeUtf8 => ValueKind::Text,
        DataType::Boolean => ValueKind::Boolean,
        other => {
            return Err(unsupported(
                field.name(),
                format!("the type {other} is not supported"),
            ));
        }
    };
    let text = |key| field.metadata().get(key).cloned().unwrap_or_default();
    Ok(Column {
        name: field.name().clone(),
        unit: text(UNIT_KEY),
        description: text(DESCRIPTION_KEY),
        values: Values::empty(kind),
    })
}

fn extend(column: &mut Column, array: &ArrayRef) -> Result<(), FormatError> {
    if array.null_count() > 0 && column.values.kind() != ValueKind::Real {
        return Err(unsupported(
            &column.name,
            format!(
                "a missing value in a column of {} values",
                column.values.kind()
            ),
        ));
    }
    let array = array.as_any();
    let done = match &mut column.values {
        Values::Real(values) => array
            .downcast_ref::<Float64Array>()
            .map(|array| values.extend(array.iter().map(|value| value.unwrap_or(f64::NAN)))),
        Values::Integer(values) => array
            .downcast_ref::<Int64Array>()
            .map(|array| values.extend_from_slice(array.values())),
        Values::Text(values) => array
            .downcast_ref::<StringArray>()
            .map(|array| values.extend(array.iter().flatten().map(str::to_owned)))
            .or_else(|| {
                array
                    .downcast_ref::<LargeStringArray>()
                    .map(|array| values.extend(array.iter().flatten().map(str::to_owned)))
            }),
        Values::Boolean(values) => array
            .downcast_ref::<BooleanArray>()
            .map(|array| values.extend(array.iter().flatten())),
    };
    done.ok_or_else(|| {
        unsupported(
            &column.name,
            "its values are not of the type in the schema".into(),
        )
    })
}

fn unsupported(name: &str, reason: String) -> FormatError {
    FormatError::UnsupportedParquet {
        name: name.to_owned(),
        reason,
    }
}

#[cfg(test)]
mod tests;
