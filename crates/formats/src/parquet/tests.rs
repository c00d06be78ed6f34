use ::parquet::data_type::{BoolType, ByteArrayType, DoubleType, Int64Type};
use ::parquet::schema::parser::parse_message_type;

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

/// The beginning of a Parquet file of another program: no seal, no metadata, and one column of the declared type.
fn without_rows(declaration: &str) -> SerializedFileWriter<Vec<u8>> {
    let schema = parse_message_type(&format!("message schema {{ {declaration} }}")).unwrap();
    SerializedFileWriter::new(Vec::new(), Arc::new(schema), Arc::default()).unwrap()
}

/// Such a file with values; levels, one a row, tell the missing ones (0) from the present ones (1).
fn foreign<T: DataType>(declaration: &str, values: &[T::T], levels: Option<&[i16]>) -> Vec<u8> {
    let mut writer = without_rows(declaration);
    let mut group = writer.next_row_group().unwrap();
    let mut chunk = group.next_column().unwrap().unwrap();
    chunk
        .typed::<T>()
        .write_batch(values, levels, None)
        .unwrap();
    chunk.close().unwrap();
    group.close().unwrap();
    writer.into_inner().unwrap()
}

#[test]
fn a_table_comes_back_to_the_bit_and_the_bytes_are_reproducible() {
    let bytes = encode(&table()).unwrap();
    assert_eq!(bytes, encode(&table()).unwrap());
    assert_eq!(decode(bytes).unwrap(), table());
}

#[test]
fn metadata_units_and_descriptions_stand_in_the_metadata_of_the_file() {
    let reader = SerializedFileReader::new(Bytes::from(encode(&table()).unwrap())).unwrap();
    let entries: BTreeMap<String, String> = reader
        .metadata()
        .file_metadata()
        .key_value_metadata()
        .unwrap()
        .iter()
        .map(|entry| (entry.key.clone(), entry.value.clone().unwrap()))
        .collect();
    assert_eq!(entries["version"], "0.1.0");
    assert_eq!(entries["configuration"], "[grains]\nnumber = 12\n");
    let columns: serde_json::Value = serde_json::from_str(&entries["peristalsis.columns"]).unwrap();
    assert_eq!(
        columns["flow.rate"],
        serde_json::json!({"unit": "t^-1", "description": "Along the wave."})
    );
    assert_eq!(columns.as_object().unwrap().len(), 5);
    assert_eq!(entries.len(), 3);
}

#[test]
fn every_kind_of_column_has_the_type_that_other_programs_expect() {
    let reader = SerializedFileReader::new(Bytes::from(encode(&table()).unwrap())).unwrap();
    let expected = "message schema {
        optional double time;
        optional double flow.rate;
        required int64 contacts;
        required byte_array state (string);
        required boolean censored;
    }";
    let expected = parse_message_type(expected).unwrap();
    assert_eq!(reader.metadata().file_metadata().schema(), &expected);
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
fn more_rows_than_one_page_or_group_holds_stay_in_order() {
    let rows = u32::try_from(MAXIMUM_ROWS_OF_GROUP).unwrap() + 1000;
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
        .column(
            "even",
            "",
            "Whether the row is even.",
            Values::Boolean((0..rows).map(|row| row % 2 == 0).collect()),
        )
        .build()
        .unwrap();
    let bytes = encode(&long).unwrap();
    let reader = SerializedFileReader::new(Bytes::from(bytes.clone())).unwrap();
    assert_eq!(reader.num_row_groups(), 2);
    assert_eq!(decode(bytes).unwrap(), long);
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
            matches!(
                decode(changed),
                Err(FormatError::CorruptParquet(reason)) if reason.contains("contradicts itself")
            )
        });
    assert!(caught.count() > 0);
}

#[test]
fn files_of_other_programs_are_read_without_a_seal() {
    let present = Some([1, 1].as_slice());
    for annotation in ["(string)", "(utf8)", "(json)"] {
        let file = foreign::<ByteArrayType>(
            &format!("optional byte_array x {annotation};"),
            &["a".into(), "b".into()],
            present,
        );
        let read = decode(file).unwrap();
        assert_eq!(read.texts("x").unwrap(), ["a", "b"], "{annotation}");
        assert_eq!(read.columns()[0].unit, "");
    }
    for annotation in ["", "(int_64)", "(integer(64, true))"] {
        let declaration = format!("optional int64 x {annotation};");
        let file = foreign::<Int64Type>(&declaration, &[1, i64::MIN], present);
        assert_eq!(decode(file).unwrap().integers("x").unwrap(), [1, i64::MIN]);
    }
    let file = foreign::<BoolType>("optional boolean x;", &[true, false], present);
    assert_eq!(decode(file).unwrap().booleans("x").unwrap(), [true, false]);
    let file = foreign::<DoubleType>("required double x;", &[1.5, f64::NAN], None);
    assert_eq!(
        decode(file).unwrap().columns()[0].values,
        Values::Real(vec![1.5, f64::NAN])
    );
    let file = foreign::<DoubleType>("optional double x;", &[2.0, 3.0], Some(&[0, 1, 0, 1]));
    assert_eq!(
        decode(file).unwrap().columns()[0].values,
        Values::Real(vec![f64::NAN, 2.0, f64::NAN, 3.0])
    );
}

#[test]
fn units_of_other_programs_may_be_partial_but_must_be_readable() {
    let described = |columns: &str| {
        let mut writer = without_rows("required double x;");
        let entry = KeyValue::new(COLUMNS_KEY.to_owned(), columns.to_owned());
        writer.append_key_value_metadata(entry);
        decode(writer.into_inner().unwrap())
    };
    let read = described(r#"{"x": {"unit": "d"}, "y": {}}"#).unwrap();
    let column = read.column("x").unwrap();
    assert_eq!(
        (column.unit.as_str(), column.description.as_str()),
        ("d", "")
    );
    assert!(read.metadata().is_empty());
    for unreadable in ["", r#"["d"]"#, r#"{"x": {"unit": 1}}"#] {
        let error = described(unreadable).expect_err("not the documented object");
        assert!(
            error.to_string().contains("`peristalsis.columns`"),
            "{error}"
        );
    }
}

#[test]
fn what_no_column_can_hold_is_refused_by_name() {
    let levels = Some([1, 0].as_slice());
    for missing in [
        foreign::<Int64Type>("optional int64 x;", &[1], levels),
        foreign::<BoolType>("optional boolean x;", &[true], levels),
        foreign::<ByteArrayType>("optional byte_array x (string);", &["a".into()], levels),
    ] {
        let error = decode(missing).expect_err("a missing value");
        assert!(
            matches!(&error, FormatError::UnsupportedParquet { name, .. } if name == "x"),
            "{error}"
        );
    }
    for declaration in [
        "REQUIRED FLOAT x;",
        "REQUIRED BYTE_ARRAY x;",
        "REQUIRED INT64 x (INTEGER(64,false));",
        "OPTIONAL INT64 x (TIMESTAMP(NANOS,true));",
        "REPEATED INT64 x;",
        "REQUIRED group x { REQUIRED INT64 y; }",
    ] {
        let refused = without_rows(declaration).into_inner().unwrap();
        let error = decode(refused).expect_err("a type without a kind");
        assert_eq!(
            error.to_string(),
            format!("Parquet column `x`: the type in `{declaration}` is not supported")
        );
    }
}

#[test]
fn a_file_is_written_and_read() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("series.parquet");
    write(&path, &table()).unwrap();
    assert_eq!(read(&path).unwrap(), table());
    assert_refused!(read(&folder.path().join("none")) => Io { .. });
    std::fs::write(&path, "not Parquet at all").unwrap();
    assert!(matches!(read(&path), Err(FormatError::Parquet(_))));
}
