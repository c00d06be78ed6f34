//! Arbitrary and damaged bytes: every reader answers with a value or an error, and never with a panic.

use std::io::Write;

use lz4_flex::frame::FrameEncoder;
use peristalsis_formats::{
    CheckpointIdentity, FormatError, Table, Values, checkpoint, csv, parquet,
};
use proptest::collection::vec;
use proptest::option;
use proptest::prelude::*;

type State = Vec<(u64, [f64; 3], Option<String>)>;

const IDENTITY: CheckpointIdentity = CheckpointIdentity {
    kind: *b"hostile ",
    layout_version: 1,
    physics_version: 2,
    physics_hash: [1; 32],
};

/// Any bit pattern: NaN payloads, infinities, subnormal numbers.
fn real() -> impl Strategy<Value = f64> {
    any::<u64>().prop_map(f64::from_bits)
}

fn state() -> impl Strategy<Value = State> {
    vec(
        (
            any::<u64>(),
            [real(), real(), real()],
            option::of(any::<String>()),
        ),
        0..20,
    )
}

fn bits(state: &State) -> Vec<(u64, [u64; 3], Option<&str>)> {
    state
        .iter()
        .map(|(step, reals, text)| (*step, reals.map(f64::to_bits), text.as_deref()))
        .collect()
}

fn table() -> impl Strategy<Value = Table> {
    (0_usize..30).prop_flat_map(|rows| {
        let values = || {
            prop_oneof![
                vec(real(), rows).prop_map(Values::Real),
                vec(any::<i64>(), rows).prop_map(Values::Integer),
                vec(any::<String>(), rows).prop_map(Values::Text),
                vec(any::<bool>(), rows).prop_map(Values::Boolean),
            ]
        };
        let column = || (any::<String>(), any::<String>(), any::<String>(), values());
        (
            vec(column(), 1..5),
            vec((any::<String>(), any::<String>()), 0..4),
        )
            .prop_map(|(columns, metadata)| {
                let builder = columns.into_iter().enumerate().fold(
                    Table::builder(),
                    // The position makes the names distinct and none of them empty.
                    |builder, (index, (name, unit, description, values))| {
                        builder.column(format!("{name}{index}"), unit, description, values)
                    },
                );
                metadata
                    .into_iter()
                    .fold(builder, |builder, (key, value)| {
                        builder.metadata(key, value)
                    })
                    .build()
                    .expect("the columns are well formed")
            })
    })
}

/// Places (as a fraction of the length) and what is combined with the byte there by exclusive or.
fn damage() -> impl Strategy<Value = Vec<(prop::sample::Index, u8)>> {
    vec((any::<prop::sample::Index>(), 1..=u8::MAX), 1..8)
}

fn damaged(mut bytes: Vec<u8>, damage: &[(prop::sample::Index, u8)]) -> Vec<u8> {
    for (place, flip) in damage {
        let index = place.index(bytes.len());
        bytes[index] ^= flip;
    }
    bytes
}

/// A well-formed checkpoint around a payload that need not be one, by the layout in the documentation of the module.
fn sealed(payload: &[u8], state_bytes: usize) -> Vec<u8> {
    let mut bytes = b"\x89PSTL\r\n\x1a".to_vec();
    bytes.extend(checkpoint::FORMAT_VERSION.to_le_bytes());
    bytes.extend(IDENTITY.kind);
    bytes.extend(IDENTITY.layout_version.to_le_bytes());
    bytes.extend(IDENTITY.physics_hash);
    bytes.extend((payload.len() as u64).to_le_bytes());
    bytes.extend((state_bytes as u64).to_le_bytes());
    bytes.extend(crc32fast::hash(payload).to_le_bytes());
    bytes.extend(IDENTITY.physics_version.to_le_bytes());
    bytes.extend(crc32fast::hash(&bytes).to_le_bytes());
    bytes.extend(payload);
    bytes
}

proptest! {
    #[test]
    fn a_checkpoint_holds_any_state(state in state()) {
        let bytes = checkpoint::encode(&IDENTITY, &state).unwrap();
        let back: State = checkpoint::decode(&IDENTITY, &bytes).unwrap();
        prop_assert_eq!(bits(&back), bits(&state));
    }

    #[test]
    fn arbitrary_bytes_are_no_checkpoint(bytes in vec(any::<u8>(), 1..400)) {
        prop_assert!(checkpoint::decode::<State>(&IDENTITY, &bytes).is_err());
    }

    #[test]
    fn a_damaged_checkpoint_is_refused(state in state(), damage in damage()) {
        let bytes = checkpoint::encode(&IDENTITY, &state).unwrap();
        let changed = damaged(bytes.clone(), &damage);
        prop_assume!(changed != bytes);
        prop_assert!(checkpoint::decode::<State>(&IDENTITY, &changed).is_err());
    }

    #[test]
    fn an_arbitrary_payload_under_a_true_checksum_is_an_error_or_a_state(payload in vec(any::<u8>(), 0..200)) {
        // What the header promises is kept, so the bytes reach the decoder of the state.
        let mut encoder = FrameEncoder::new(Vec::new());
        encoder.write_all(&payload).unwrap();
        let compressed = encoder.finish().unwrap();
        match checkpoint::decode::<State>(&IDENTITY, &sealed(&compressed, payload.len())) {
            Ok(state) => prop_assert!(state.len() <= payload.len()),
            Err(error) => {
                let corrupt = matches!(error, FormatError::CorruptCheckpoint { .. });
                prop_assert!(corrupt, "{}", error);
            }
        }
    }

    #[test]
    fn arbitrary_bytes_under_a_true_checksum_are_no_compressed_payload(payload in vec(any::<u8>(), 0..200)) {
        let outcome = checkpoint::decode::<State>(&IDENTITY, &sealed(&payload, 100));
        let refused = matches!(outcome, Err(FormatError::CorruptCheckpoint { .. }));
        prop_assert!(refused);
    }

    #[test]
    fn csv_keeps_names_and_values(table in table()) {
        let back = csv::decode(&csv::encode(&table)).unwrap();
        prop_assert_eq!(back.rows(), table.rows());
        for (written, read) in table.columns().iter().zip(back.columns()) {
            prop_assert_eq!(&written.name, &read.name);
            // Without rows there is no field to tell the kind.
            prop_assert!(table.rows() == 0 || written.values == read.values);
        }
    }

    #[test]
    fn arbitrary_text_is_a_table_or_no_csv(text in "[\\PC\n\r\",0-9.]{0,200}") {
        if let Ok(table) = csv::decode(&text) {
            prop_assert!(!table.columns().is_empty());
        }
    }

    #[test]
    fn parquet_keeps_everything(table in table()) {
        prop_assert_eq!(parquet::decode(parquet::encode(&table).unwrap()).unwrap(), table);
    }

    #[test]
    fn arbitrary_bytes_are_no_parquet(bytes in vec(any::<u8>(), 0..400)) {
        prop_assert!(parquet::decode(bytes).is_err());
    }

    #[test]
    fn a_damaged_parquet_file_is_refused(table in table(), damage in damage()) {
        let bytes = parquet::encode(&table).unwrap();
        // The seal's own signature stands in bytes 4 to 16: a file without it is another program's.
        let mut changed = damaged(bytes.clone(), &damage);
        changed[4..16].copy_from_slice(&bytes[4..16]);
        prop_assume!(changed != bytes);
        let refused = matches!(parquet::decode(changed), Err(FormatError::CorruptParquet { .. }));
        prop_assert!(refused);
    }
}
