use ::parquet::arrow::parquet_to_arrow_schema;

use super::*;

fn strings(values: &[&str]) -> Values {
    Values::Text(values.iter().map(ToString::to_string).collect())
}

fn table() -> Table {
    Table::builder()
        .column(
            "time",
            "t",
            "Time since the start.",
            Values::Real(vec![-0.0, 0.1, f64::MIN_POSITIVE / 3.0]),
        )
        .column(
            "flow.rate",
            "t^-1",
            "Along the wave.",
            Values::Real(vec![f64::NAN, f64::NEG_INFINITY, f64::MAX]),
        )
        .column(
            "contacts",
            "",
            "Pairs.",
            Values::Integer(vec![i64::MIN, 0, i64::MAX]),
        )
        .column(
            "state",
            "",
            "Where it began.",
            strings(&["", "jammed", "Über, \"x\"\n"]),
        )
        .column(
            "censored",
            "",
            "No transition seen.",
            Values::Boolean(vec![true, false, true]),
        )
        .metadata("version", "0.1.0")
        .metadata("configuration", "[grains]\nnumber = 12\n")
        .build()
        .unwrap()
}

/// The record batch as a Parquet file of another program: no checksum, another creator.
fn foreign(field: Field, array: ArrayRef) -> Vec<u8> {
    let schema = Arc::new(Schema::new(vec![field]));
    let batch = RecordBatch::try_new(Arc::clone(&schema), vec![array]).unwrap();
    let mut writer = ArrowWriter::try_new(Vec::new(), schema, None).unwrap();
    writer.write(&batch).unwrap();
    writer.into_inner().unwrap()
}

#[test]
fn a_table_comes_back_to_the_bit_and_the_bytes_are_reproducible() {
    let bytes = encode(&table()).unwrap();
    assert_eq!(bytes, encode(&table()).unwrap());
    assert_eq!(decode(bytes).unwrap(), table());
}

#[test]
fn metadata_stand_in_the_file_and_in_the_arrow_schema() {
    let builder =
        ParquetRecordBatchReaderBuilder::try_new(Bytes::from(encode(&table()).unwrap())).unwrap();
    let file = builder.metadata().file_metadata();
    let (arrow, plain): (Vec<KeyValue>, Vec<KeyValue>) = file
        .key_value_metadata()
        .cloned()
        .unwrap()
        .into_iter()
        .partition(|entry| is_reserved(&entry.key));
    assert!(plain.contains(&KeyValue::new("version".to_owned(), "0.1.0".to_owned())));
    let schema = parquet_to_arrow_schema(file.schema_descr(), Some(&arrow)).unwrap();
    assert_eq!(&schema.metadata, table().metadata());
    let field = schema.field_with_name("time").unwrap();
    assert_eq!(field.metadata()["unit"], "t");
    assert_eq!(field.metadata()["description"], "Time since the start.");
}

#[test]
fn a_table_without_rows_keeps_its_columns() {
    let empty = Table::builder()
        .column("time", "t", "Time.", Values::Real(vec![]))
        .column("state", "", "State.", strings(&[]))
        .metadata("version", "0.1.0")
        .build()
        .unwrap();
    assert_eq!(decode(encode(&empty).unwrap()).unwrap(), empty);
}

#[test]
fn more_rows_than_one_batch_or_page_holds_stay_in_order() {
    let rows = 100_000_u32;
    let reals: Vec<f64> = (0..rows)
        .map(|row| {
            if row % 7 == 0 {
                f64::NAN
            } else {
                f64::from(row).sqrt()
            }
        })
        .collect();
    let texts = (0..rows).map(|row| (row % 1000).to_string()).collect();
    let long = Table::builder()
        .column("root", "", "Root of the row.", Values::Real(reals))
        .column(
            "row",
            "",
            "Row.",
            Values::Integer((0..i64::from(rows)).collect()),
        )
        .column("text", "", "Row modulo 1000.", Values::Text(texts))
        .build()
        .unwrap();
    assert_eq!(decode(encode(&long).unwrap()).unwrap(), long);
}

#[test]
fn every_changed_byte_is_an_error_or_changes_nothing() {
    let bytes = encode(&table()).unwrap();
    for index in 0..bytes.len() {
        for flip in [0x01, 0x80, 0xff] {
            let mut changed = bytes.clone();
            changed[index] ^= flip;
            match decode(changed) {
                // Without its signature there is no seal to compare with, but the rest is sound.
                Ok(read) => assert!(
                    SEAL_SIGNATURE_RANGE.contains(&index) && read == table(),
                    "byte {index}"
                ),
                Err(FormatError::CorruptParquet { .. }) => {
                    assert!(!SEAL_SIGNATURE_RANGE.contains(&index))
                }
                Err(other) => panic!("byte {index}: {other}"),
            }
        }
    }
}

#[test]
fn every_shortened_length_is_an_error() {
    let bytes = encode(&table()).unwrap();
    for length in 0..bytes.len() {
        let error = decode(bytes[..length].to_vec()).expect_err("a shortened file");
        let sealed = length >= SEAL_SIGNATURE_RANGE.end;
        assert_eq!(
            matches!(error, FormatError::CorruptParquet { .. }),
            sealed,
            "{length} bytes: {error}"
        );
    }
}

#[test]
fn a_panic_of_the_library_becomes_an_error() {
    // The page header of the first column begins behind the seal; a damaged one is what the library is known to panic on.
    let bytes = encode(&table()).unwrap();
    let unsealed = [&bytes[..4], &[0; 12], &bytes[16..]].concat();
    let caught = (0..unsealed.len())
        .flat_map(|index| [0x01, 0x04, 0x80].map(|flip| (index, flip)))
        .filter(|&(index, flip)| {
            let mut changed = unsealed.clone();
            changed[index] ^= flip;
            matches!(decode(changed), Err(FormatError::CorruptParquet { .. }))
        });
    assert!(caught.count() > 0);
}

#[test]
fn files_of_other_programs_are_read_without_a_checksum() {
    let field = Field::new("name", DataType::LargeUtf8, true);
    let read = decode(foreign(
        field,
        Arc::new(LargeStringArray::from(vec!["a", "b"])),
    ))
    .unwrap();
    assert_eq!(read.texts("name").unwrap(), ["a", "b"]);
    assert_eq!(read.columns()[0].unit, "");
    let read = decode(foreign(
        Field::new("x", DataType::Float64, true),
        Arc::new(Float64Array::from(vec![None, Some(2.0)])),
    ))
    .unwrap();
    assert!(read.reals("x").unwrap()[0].is_nan());
}

#[test]
fn what_no_column_can_hold_is_refused_by_name() {
    let missing: ArrayRef = Arc::new(Int64Array::from(vec![Some(1), None]));
    let single: ArrayRef = Arc::new(arrow_array::Float32Array::from(vec![1.0]));
    for (data_type, array) in [(DataType::Int64, missing), (DataType::Float32, single)] {
        let refused = decode(foreign(Field::new("x", data_type, true), array));
        assert!(
            matches!(refused, Err(FormatError::UnsupportedParquet { name, .. }) if name == "x")
        );
    }
}

#[test]
fn a_file_is_written_and_read() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("series.parquet");
    write(&path, &table()).unwrap();
    assert_eq!(read(&path).unwrap(), table());
    assert!(matches!(
        read(&folder.path().join("none")),
        Err(FormatError::Io { .. })
    ));
    std::fs::write(&path, "not Parquet at all").unwrap();
    assert!(matches!(read(&path), Err(FormatError::Parquet(_))));
}
