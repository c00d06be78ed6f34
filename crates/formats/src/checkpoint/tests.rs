use std::io::{self, Seek, SeekFrom, Write};

use serde::Deserialize;

use super::*;

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct State {
    step: u64,
    positions: Vec<[f64; 3]>,
    history: Vec<(u32, u32, Option<f64>)>,
    label: String,
}

const IDENTITY: CheckpointIdentity = CheckpointIdentity {
    kind: *b"engine  ",
    layout_version: 3,
    physics_version: 2,
    physics_hash: [7; 32],
};

fn state() -> State {
    State {
        step: 123_456,
        positions: (0..8)
            .map(|i| [f64::from(i) / 3.0, -f64::from(i), 1e-3])
            .collect(),
        history: vec![(0, 1, Some(0.25)), (1, 2, None)],
        label: "rest".into(),
    }
}

fn decoded(bytes: &[u8]) -> Result<State, FormatError> {
    decode(&IDENTITY, bytes)
}

/// The bytes with another header field written over, and the header checksum made to agree.
fn forged(mut bytes: Vec<u8>, offset: usize, value: &[u8]) -> Vec<u8> {
    bytes[offset..offset + value.len()].copy_from_slice(value);
    let checksum = crc32fast::hash(&bytes[..80]);
    bytes[80..84].copy_from_slice(&checksum.to_le_bytes());
    bytes
}

#[test]
fn a_state_comes_back_and_the_bytes_are_reproducible() {
    let bytes = encode(&IDENTITY, &state()).unwrap();
    assert_eq!(decoded(&bytes).unwrap(), state());
    assert_eq!(bytes, encode(&IDENTITY, &state()).unwrap());
}

#[test]
fn every_bit_pattern_of_a_real_survives() {
    let patterns = [
        0,
        (-0.0_f64).to_bits(),
        1,
        0x000f_ffff_ffff_ffff,
        f64::MAX.to_bits(),
        f64::NEG_INFINITY.to_bits(),
        0x7ff8_0000_0000_1234,
        0xfff8_dead_beef_0001,
        0x7ff0_0000_0000_0001,
    ];
    let reals: Vec<f64> = patterns.iter().map(|&bits| f64::from_bits(bits)).collect();
    let back: Vec<f64> = decode(&IDENTITY, &encode(&IDENTITY, &reals).unwrap()).unwrap();
    assert_eq!(
        back.iter().map(|value| value.to_bits()).collect::<Vec<_>>(),
        patterns
    );
}

#[test]
fn every_changed_byte_is_detected_and_named() {
    let bytes = encode(&IDENTITY, &state()).unwrap();
    for index in 0..bytes.len() {
        for flip in [0x01, 0x80, 0xff] {
            let mut changed = bytes.clone();
            changed[index] ^= flip;
            let error = decoded(&changed).expect_err("a changed byte must be noticed");
            let named = match index {
                0..8 => matches!(error, FormatError::NotACheckpoint),
                8..12 => matches!(
                    error,
                    FormatError::CheckpointVersion {
                        readable: FORMAT_VERSION,
                        ..
                    }
                ),
                _ => matches!(error, FormatError::CorruptCheckpoint { .. }),
            };
            assert!(named, "byte {index} changed by {flip:#x}: {error}");
        }
    }
}

#[test]
fn every_shortened_length_is_told_as_truncation() {
    let bytes = encode(&IDENTITY, &state()).unwrap();
    for length in 0..bytes.len() {
        let expected_total = if length < HEADER_BYTES {
            HEADER_BYTES
        } else {
            bytes.len()
        };
        match decoded(&bytes[..length]) {
            Err(FormatError::TruncatedCheckpoint { expected, found }) => {
                assert_eq!((expected, found), (expected_total as u64, length as u64));
            }
            other => panic!("{length} bytes: {other:?}"),
        }
    }
}

#[test]
fn appended_bytes_are_detected() {
    let mut bytes = encode(&IDENTITY, &state()).unwrap();
    bytes.push(0);
    assert_refused!(decoded(&bytes) => CorruptCheckpoint { .. });
}

#[test]
fn another_kind_layout_or_physics_is_refused_by_name() {
    let bytes = encode(&IDENTITY, &state()).unwrap();
    let read = |identity: CheckpointIdentity| {
        decode::<State>(&identity, &bytes).expect_err("the identity differs")
    };

    let with = |change: fn(&mut CheckpointIdentity)| {
        let mut identity = IDENTITY;
        change(&mut identity);
        read(identity)
    };
    let error = with(|identity| identity.kind = *b"wall    ");
    assert_eq!(
        error.to_string(),
        "the checkpoint holds a state of kind `engine  `, not `wall    `"
    );
    let error = Err::<(), _>(with(|identity| identity.layout_version = 4));
    assert_refused!(error => CheckpointLayout { found: 3, readable: 4 });
    for version in [0, 1, 3, 259, u32::MAX] {
        let error = read(CheckpointIdentity {
            physics_version: version,
            ..IDENTITY
        });
        assert!(matches!(
            error,
            FormatError::OtherPhysicsVersion { found: 2, computed } if computed == version
        ));
    }
    let error = with(|identity| identity.physics_hash[31] = 0xab);
    assert!(
        matches!(error, FormatError::OtherPhysics { found, .. } if found == IDENTITY.physics_hash)
    );
    assert!(error.to_string().ends_with("0707ab here"), "{error}");
}

#[test]
fn a_future_version_is_refused_even_with_another_header() {
    let mut bytes = encode(&IDENTITY, &state()).unwrap();
    bytes[8..12].copy_from_slice(&2_u32.to_le_bytes());
    bytes.truncate(40);
    assert_refused!(decoded(&bytes) => CheckpointVersion { found: 2, readable: 1 });
}

#[test]
fn forged_lengths_are_refused() {
    let bytes = encode(&IDENTITY, &state()).unwrap();
    let state_bytes = u64::from_le_bytes(field(&bytes, 64));
    for (offset, claim) in [
        (56, u64::MAX),
        (64, u64::MAX),
        (64, MAXIMUM_STATE_BYTES),
        (64, state_bytes - 1),
        (64, 0),
    ] {
        let error = decoded(&forged(bytes.clone(), offset, &claim.to_le_bytes()))
            .expect_err("a false length");
        assert!(
            matches!(error, FormatError::CorruptCheckpoint { .. }),
            "{claim} at {offset}: {error}"
        );
    }
    let more = forged(bytes.clone(), 56, &MAXIMUM_STATE_BYTES.to_le_bytes());
    assert_refused!(decoded(&more) => TruncatedCheckpoint { .. });
}

#[test]
fn a_payload_that_unpacks_to_more_than_claimed_is_stopped() {
    let mut encoder = lz4_flex::frame::FrameEncoder::new(Vec::new());
    encoder.write_all(&vec![0; 64 << 20]).unwrap();
    let payload = encoder.finish().unwrap();
    let header = Header {
        identity: IDENTITY,
        payload_bytes: payload.len() as u64,
        state_bytes: 100,
        payload_checksum: crc32fast::hash(&payload),
    };
    let plain = decompress(&header, &payload).expect_err("64 MiB are not 100 bytes");
    assert!(matches!(plain, FormatError::CorruptCheckpoint { .. }));
}

#[test]
fn a_state_of_another_type_is_an_error() {
    let shorter = encode(&IDENTITY, &1_u8).unwrap();
    assert_refused!(decoded(&shorter) => CorruptCheckpoint { .. });
    let longer = encode(&IDENTITY, &[1_u8, 2, 3]).unwrap();
    assert_refused!(decode::<u8>(&IDENTITY, &longer) => CorruptCheckpoint { .. });
    let endless = encode(&IDENTITY, &(u64::MAX, 0_u8)).unwrap();
    assert_refused!(decode::<Vec<[f64; 3]>>(&IDENTITY, &endless) => CorruptCheckpoint { .. });
}

#[test]
fn a_file_holds_the_bytes() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("state.checkpoint");
    write(&path, &IDENTITY, &state()).unwrap();
    let bytes = encode(&IDENTITY, &state()).unwrap();
    assert_eq!(std::fs::read(&path).unwrap(), bytes);
}

/// A disk with room for so many bytes.
struct Disk {
    room: usize,
}

impl Write for Disk {
    fn write(&mut self, buffer: &[u8]) -> io::Result<usize> {
        if buffer.len() > self.room {
            return Err(io::ErrorKind::StorageFull.into());
        }
        self.room -= buffer.len();
        Ok(buffer.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

impl Seek for Disk {
    fn seek(&mut self, _: SeekFrom) -> io::Result<u64> {
        Ok(0)
    }
}

#[test]
fn a_full_disk_is_called_so() {
    // Noise, so that its compressed form is as long.
    let noise: Vec<u64> = (1..400_000_u64)
        .map(|i| i.wrapping_mul(0x9e37_79b9_7f4a_7c15).rotate_left(23) | 1 << 63)
        .collect();
    let length = encode(&IDENTITY, &noise).unwrap().len();
    for room in [0, 50, 79, 10_000, 1 << 20, length - 1, length + 83] {
        match stream::write(&IDENTITY, &noise, &mut Disk { room }) {
            Err(error) => {
                assert_eq!(error.kind(), io::ErrorKind::StorageFull, "{room}");
            }
            other => panic!("with room for {room} of {length} bytes: {other:?}"),
        }
    }
    // The header is written twice.
    let room = length + HEADER_BYTES;
    stream::write(&IDENTITY, &noise, &mut Disk { room }).unwrap();
}

#[test]
fn a_state_that_is_too_large_is_refused_before_it_has_been_written() {
    struct Endless;
    impl Serialize for Endless {
        fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
            use serde::ser::SerializeTuple;
            let mut tuple = serializer.serialize_tuple(usize::MAX)?;
            let piece = String::from_utf8(vec![b' '; 1 << 24]).expect("spaces");
            loop {
                tuple.serialize_element(&piece)?;
            }
        }
    }
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("state.checkpoint");
    for outcome in [
        write(&path, &IDENTITY, &Endless),
        encode(&IDENTITY, &Endless).map(drop),
    ] {
        assert!(
            matches!(outcome, Err(FormatError::StateTooLarge { bytes, .. }) if bytes < 2 * MAXIMUM_STATE_BYTES),
            "{outcome:?}"
        );
    }
    assert!(!path.exists());
}
