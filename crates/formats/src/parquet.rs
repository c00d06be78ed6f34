//! Parquet: a [`Table`] with its units, descriptions and metadata, exact to the bit.
//!
//! The metadata of the table are the key/value metadata of the file. Under the key `peristalsis.columns` they also hold
//! units and descriptions, as a JSON object by the names of the columns: `{"time": {"unit": "t", "description": ".."}}`.
//! A missing real is null.
//!
//! Between the opening `PAR1` and the first column, where every reader skips it, a file of this crate carries a *seal*:
//! twelve bytes of signature and the CRC-32 of all other bytes of the file. A file that changed on disk is thus an error
//! and never a result, and it is refused before the Parquet library, which panics on some damaged files, gets to see it.
//! A file without a seal, from another program, is read unchecked: if it makes the library panic, that is caught and
//! returned as an error (the panic hook still runs), but its false lengths may demand much memory.

use std::collections::BTreeMap;
use std::fs;
use std::ops::Range;
use std::panic;
use std::path::Path;
use std::sync::Arc;

use ::parquet::basic::{
    Compression, ConvertedType, IntType, LogicalType, Repetition, Type as PhysicalType,
};
use ::parquet::column::reader::{ColumnReader, ColumnReaderImpl};
use ::parquet::column::writer::ColumnWriter;
use ::parquet::data_type::{ByteArray, DataType};
use ::parquet::errors::ParquetError;
use ::parquet::file::metadata::KeyValue;
use ::parquet::file::properties::WriterProperties;
use ::parquet::file::reader::{FileReader, SerializedFileReader};
use ::parquet::file::writer::SerializedFileWriter;
use ::parquet::schema::printer::print_schema;
use ::parquet::schema::types::{ColumnPath, Type};
use bytes::Bytes;
use serde::{Deserialize, Serialize};

use crate::atomic;
use crate::error::FormatError;
use crate::table::{COLUMNS_KEY, Column, Table, Values, is_reserved};
use crate::value_kind::ValueKind;

/// Bytes 4 to 16 of a sealed file; the checksum follows in bytes 16 to 20.
const SEAL_SIGNATURE: [u8; 12] = *b"\x89peristalsis";
const SEAL_SIGNATURE_RANGE: Range<usize> = 4..16;
const SEAL_CHECKSUM_RANGE: Range<usize> = 16..20;
/// A row group is what a reader has to hold at once, and what several readers can share out among themselves.
const MAXIMUM_ROWS_OF_GROUP: usize = 1 << 20;
const ROWS_READ_AT_ONCE: usize = 8192;

/// What the file says about a column besides name and type.
#[derive(Default, Serialize, Deserialize)]
#[serde(default)]
struct Meaning {
    unit: String,
    description: String,
}

/// The table as the bytes of a Parquet file; the same table gives the same bytes.
///
/// # Errors
/// [`FormatError::Parquet`].
pub fn encode(table: &Table) -> Result<Vec<u8>, FormatError> {
    let schema = Arc::new(schema_of(table)?);
    let mut writer = SerializedFileWriter::new(Vec::new(), schema, Arc::new(properties_of(table)))?;
    // The checksum's place: it is known at the end.
    let seal = [&SEAL_SIGNATURE[..], &[0; 4]].concat();
    writer.write_all(&seal).map_err(ParquetError::from)?;
    for start in (0..table.rows()).step_by(MAXIMUM_ROWS_OF_GROUP) {
        let rows = start..table.rows().min(start + MAXIMUM_ROWS_OF_GROUP);
        let mut group = writer.next_row_group()?;
        for column in table.columns() {
            let mut chunk = group
                .next_column()?
                .expect("the schema has a field for every column");
            write_rows(chunk.untyped(), &column.values, rows.clone())?;
            chunk.close()?;
        }
        group.close()?;
    }
    let mut bytes = writer.into_inner()?;
    let checksum = checksum_of(&bytes).to_le_bytes();
    bytes[SEAL_CHECKSUM_RANGE].copy_from_slice(&checksum);
    Ok(bytes)
}

/// The table in the bytes of a Parquet file.
///
/// Columns of 64-bit reals and integers, booleans and text are read, none of them nested; only reals may have nulls.
///
/// # Errors
/// [`FormatError::CorruptParquet`], [`FormatError::Parquet`], [`FormatError::UnsupportedParquet`].
pub fn decode(bytes: Vec<u8>) -> Result<Table, FormatError> {
    if bytes.get(SEAL_SIGNATURE_RANGE) == Some(&SEAL_SIGNATURE) {
        let unbroken = bytes
            .get(SEAL_CHECKSUM_RANGE)
            .is_some_and(|seal| seal == checksum_of(&bytes).to_le_bytes());
        if !unbroken {
            return Err(corrupt("it is cut short or changed, by its checksum"));
        }
    }
    panic::catch_unwind(|| decode_unchecked(bytes))
        .unwrap_or_else(|_| Err(corrupt("its structure contradicts itself")))
}

fn decode_unchecked(bytes: Vec<u8>) -> Result<Table, FormatError> {
    let reader = SerializedFileReader::new(Bytes::from(bytes))?;
    let file = reader.metadata().file_metadata();
    let entries = file.key_value_metadata().cloned().unwrap_or_default();
    let mut meanings = meanings_in(&entries)?;
    let mut columns = Vec::new();
    for field in file.schema().get_fields() {
        let meaning = meanings.remove(field.name()).unwrap_or_default();
        columns.push(column_of(field, meaning)?);
    }
    for group in 0..reader.num_row_groups() {
        let group = reader.get_row_group(group)?;
        // No field is nested, so the columns of the file are the fields of its schema.
        for (index, column) in columns.iter_mut().enumerate() {
            read_rows(group.get_column_reader(index)?, column)?;
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

fn schema_of(table: &Table) -> Result<Type, ParquetError> {
    let columns = table.columns().iter();
    let fields = columns.map(|column| field_of(column).map(Arc::new));
    let fields = fields.collect::<Result<_, _>>()?;
    Type::group_type_builder("schema")
        .with_fields(fields)
        .build()
}

fn field_of(column: &Column) -> Result<Type, ParquetError> {
    let (physical, logical, repetition) = match column.values.kind() {
        ValueKind::Real => (PhysicalType::DOUBLE, None, Repetition::OPTIONAL),
        ValueKind::Integer => (PhysicalType::INT64, None, Repetition::REQUIRED),
        ValueKind::Text => {
            let text = Some(LogicalType::String);
            (PhysicalType::BYTE_ARRAY, text, Repetition::REQUIRED)
        }
        ValueKind::Boolean => (PhysicalType::BOOLEAN, None, Repetition::REQUIRED),
    };
    Type::primitive_type_builder(&column.name, physical)
        .with_logical_type(logical)
        .with_repetition(repetition)
        .build()
}

fn write_rows(
    chunk: &mut ColumnWriter<'_>,
    values: &Values,
    rows: Range<usize>,
) -> Result<(), ParquetError> {
    match (values, chunk) {
        (Values::Real(values), ColumnWriter::DoubleColumnWriter(chunk)) => {
            let values = &values[rows];
            // The level of a row is 1 if its value is there, which then stands among the present ones, and 0 if not.
            let is_there = |value: &f64| !value.is_nan();
            let levels: Vec<i16> = values.iter().map(|value| is_there(value).into()).collect();
            let present: Vec<f64> = values.iter().copied().filter(is_there).collect();
            chunk.write_batch(&present, Some(&levels), None)
        }
        (Values::Integer(values), ColumnWriter::Int64ColumnWriter(chunk)) => {
            chunk.write_batch(&values[rows], None, None)
        }
        (Values::Text(values), ColumnWriter::ByteArrayColumnWriter(chunk)) => {
            let values = values[rows].iter().map(|value| value.as_str().into());
            chunk.write_batch(&values.collect::<Vec<ByteArray>>(), None, None)
        }
        (Values::Boolean(values), ColumnWriter::BoolColumnWriter(chunk)) => {
            chunk.write_batch(&values[rows], None, None)
        }
        _ => unreachable!("the schema is made of the kinds of these values"),
    }?;
    Ok(())
}

fn properties_of(table: &Table) -> WriterProperties {
    let entries = table.metadata().iter();
    let entries = entries.map(|(key, value)| KeyValue::new(key.clone(), value.clone()));
    let entries = entries.chain([KeyValue::new(COLUMNS_KEY.to_owned(), meanings_of(table))]);
    let mut properties = WriterProperties::builder()
        .set_compression(Compression::SNAPPY)
        .set_key_value_metadata(Some(entries.collect()));
    for column in table.columns() {
        // Measured reals hardly repeat: a dictionary of them would be larger than the values.
        if column.values.kind() == ValueKind::Real {
            let path = ColumnPath::from(column.name.as_str());
            properties = properties.set_column_dictionary_enabled(path, false);
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

fn meanings_of(table: &Table) -> String {
    let mut meanings = BTreeMap::new();
    for column in table.columns() {
        let (unit, description) = (column.unit.clone(), column.description.clone());
        meanings.insert(&column.name, Meaning { unit, description });
    }
    serde_json::to_string(&meanings).expect("text by text is always JSON")
}

fn meanings_in(entries: &[KeyValue]) -> Result<BTreeMap<String, Meaning>, FormatError> {
    entries
        .iter()
        .find(|entry| entry.key == COLUMNS_KEY)
        .and_then(|entry| entry.value.as_deref())
        .map_or(Ok(BTreeMap::new()), serde_json::from_str)
        .map_err(|error| {
            let reason = format!("its metadata `{COLUMNS_KEY}` do not describe columns: {error}");
            FormatError::CorruptParquet(reason)
        })
}

/// A column without rows, for a field of the file.
fn column_of(field: &Type, meaning: Meaning) -> Result<Column, FormatError> {
    let kind = kind_of(field).ok_or_else(|| {
        let mut declaration = Vec::new();
        print_schema(&mut declaration, field);
        let declaration = String::from_utf8_lossy(&declaration);
        let words: Vec<&str> = declaration.split_whitespace().collect();
        let reason = format!("the type in `{}` is not supported", words.join(" "));
        unsupported(field.name(), reason)
    })?;
    Ok(Column {
        name: field.name().to_owned(),
        unit: meaning.unit,
        description: meaning.description,
        values: Values::empty(kind),
    })
}

/// The kind that holds every value of the field, if there is one.
fn kind_of(field: &Type) -> Option<ValueKind> {
    let information = field.get_basic_info();
    if !field.is_primitive() || information.repetition() == Repetition::REPEATED {
        return None;
    }
    let annotation = (information.logical_type_ref(), information.converted_type());
    // Programs from before the logical types annotate with the converted type alone.
    match (field.get_physical_type(), annotation) {
        (PhysicalType::DOUBLE, (None, ConvertedType::NONE)) => Some(ValueKind::Real),
        (
            PhysicalType::INT64,
            (None, ConvertedType::NONE | ConvertedType::INT_64)
            | (
                Some(LogicalType::Integer(IntType {
                    bit_width: 64,
                    is_signed: true,
                })),
                _,
            ),
        ) => Some(ValueKind::Integer),
        (
            PhysicalType::BYTE_ARRAY,
            (None, ConvertedType::UTF8 | ConvertedType::JSON)
            | (Some(LogicalType::String | LogicalType::Json), _),
        ) => Some(ValueKind::Text),
        (PhysicalType::BOOLEAN, (None, ConvertedType::NONE)) => Some(ValueKind::Boolean),
        _ => None,
    }
}

/// Adds the values of one row group to its column.
fn read_rows(chunk: ColumnReader, column: &mut Column) -> Result<(), FormatError> {
    let (name, kind) = (&column.name, column.values.kind());
    let missing = || {
        let reason = format!("a missing value in a column of {kind} values");
        unsupported(name, reason)
    };
    match (&mut column.values, chunk) {
        (Values::Real(values), ColumnReader::DoubleColumnReader(chunk)) => {
            read_values(chunk, values, |value| Ok(value.unwrap_or(f64::NAN)))
        }
        (Values::Integer(values), ColumnReader::Int64ColumnReader(chunk)) => {
            read_values(chunk, values, |value| value.ok_or_else(missing))
        }
        (Values::Text(values), ColumnReader::ByteArrayColumnReader(chunk)) => {
            read_values(chunk, values, |value| {
                Ok(value.ok_or_else(missing)?.as_utf8()?.to_owned())
            })
        }
        (Values::Boolean(values), ColumnReader::BoolColumnReader(chunk)) => {
            read_values(chunk, values, |value| value.ok_or_else(missing))
        }
        _ => {
            let reason = "its values are not of the type in the schema";
            Err(unsupported(name, reason.to_owned()))
        }
    }
}

/// Adds the value of every row in order, each made of the one in the file, which may be missing.
fn read_values<T: DataType, V>(
    mut chunk: ColumnReaderImpl<T>,
    values: &mut Vec<V>,
    value: impl Fn(Option<T::T>) -> Result<V, FormatError>,
) -> Result<(), FormatError> {
    let (mut present, mut levels) = (Vec::new(), Vec::new());
    loop {
        let places = Some(&mut levels);
        let (rows, ..) = chunk.read_records(ROWS_READ_AT_ONCE, places, None, &mut present)?;
        if rows == 0 {
            return Ok(());
        }
        let mut present = present.drain(..);
        for row in 0..rows {
            // A required column has no levels.
            let is_missing = levels.get(row) == Some(&0);
            values.push(value(if is_missing { None } else { present.next() })?);
        }
        levels.clear();
    }
}

fn corrupt(reason: &str) -> FormatError {
    FormatError::CorruptParquet(reason.to_owned())
}

fn unsupported(name: &str, reason: String) -> FormatError {
    FormatError::UnsupportedParquet {
        name: name.to_owned(),
        reason,
    }
}

#[cfg(test)]
mod tests;
