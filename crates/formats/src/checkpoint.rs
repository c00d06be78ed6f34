//! Checkpoints: a state of any serializable type behind a header that detects every corrupted byte.
//!
//! Layout, all numbers little-endian:
//!
//! | offset | bytes | content |
//! |---|---|---|
//! | 0 | 8 | signature `89 50 53 54 4c 0d 0a 1a`: not text, and broken by any change of line endings |
//! | 8 | 4 | version of this container |
//! | 12 | 8 | kind of the state |
//! | 20 | 4 | layout version of the state |
//! | 24 | 32 | hash of the physics that the state belongs to |
//! | 56 | 8 | length of the payload |
//! | 64 | 8 | length of the state, that is of the payload after decompression |
//! | 72 | 4 | CRC-32 of the payload |
//! | 76 | 4 | version of the physics that the state was computed with |
//! | 80 | 4 | CRC-32 of the 80 bytes above |
//! | 84 | | payload: the state in the postcard encoding, compressed to an LZ4 frame |
//!
//! Postcard stores a real as its 64 bits, so NaN payloads, -0.0 and subnormal numbers come back as they were. A CRC-32
//! detects every error within 32 neighbouring bits, and others but for one in 2^32. It guards against accidents, not
//! against forgery; a forged length cannot exhaust the memory, since no more than [`MAXIMUM_STATE_BYTES`] are unpacked.

mod stream;

use std::io::{Cursor, Read};
use std::path::Path;

use lz4_flex::frame::FrameDecoder;
use serde::Serialize;
use serde::de::DeserializeOwned;

use crate::atomic;
use crate::error::FormatError;

/// The container version that this crate writes, and the only one that it reads.
pub const FORMAT_VERSION: u32 = 1;

/// The most bytes that an encoded state may have: 1 GiB, some five million grains.
pub const MAXIMUM_STATE_BYTES: u64 = 1 << 30;

const SIGNATURE: [u8; 8] = *b"\x89PSTL\r\n\x1a";
const HEADER_BYTES: usize = 84;

/// Which state a checkpoint holds; writer and reader must name the same.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CheckpointIdentity {
    /// Kind of the state, in printable ASCII padded with spaces, such as `*b"engine  "`.
    pub kind: [u8; 8],
    /// Version of the state's own layout: raised whenever a field of its type is added, removed or moved, because the
    /// payload does not describe itself.
    pub layout_version: u32,
    /// Version of the physics: raised whenever the same configuration and seed come to other results.
    pub physics_version: u32,
    /// Hash of everything that decides how the state evolves: laws, walls, drive, integrator.
    pub physics_hash: [u8; 32],
}

impl CheckpointIdentity {
    fn require(&self, expected: &Self) -> Result<(), FormatError> {
        if self.kind != expected.kind {
            let (found, expected) = (self.kind, expected.kind);
            return Err(FormatError::CheckpointKind { found, expected });
        }
        if self.layout_version != expected.layout_version {
            let (found, readable) = (self.layout_version, expected.layout_version);
            return Err(FormatError::CheckpointLayout { found, readable });
        }
        if self.physics_version != expected.physics_version {
            let (found, computed) = (self.physics_version, expected.physics_version);
            return Err(FormatError::OtherPhysicsVersion { found, computed });
        }
        if self.physics_hash != expected.physics_hash {
            let (found, expected) = (self.physics_hash, expected.physics_hash);
            return Err(FormatError::OtherPhysics { found, expected });
        }
        Ok(())
    }
}

/// The state as bytes of a checkpoint; the same state gives the same bytes.
///
/// # Errors
/// [`FormatError::StateTooLarge`], [`FormatError::Serialize`].
pub fn encode<State: Serialize>(
    identity: &CheckpointIdentity,
    state: &State,
) -> Result<Vec<u8>, FormatError> {
    let mut bytes = Cursor::new(Vec::new());
    stream::write(identity, state, &mut bytes)
        .map_err(FormatError::io("write", Path::new("memory")))?;
    Ok(bytes.into_inner())
}

/// Hash of the physics that the state in the bytes of a checkpoint belongs to, of whatever kind it is.
///
/// # Errors
/// Those of [`decode`] about the header.
pub fn physics_hash(bytes: &[u8]) -> Result<[u8; 32], FormatError> {
    Header::from_bytes(bytes).map(|header| header.identity.physics_hash)
}

/// The state in the bytes of a checkpoint.
///
/// # Errors
/// In this order: [`FormatError::NotACheckpoint`], [`FormatError::CheckpointVersion`],
/// [`FormatError::CorruptCheckpoint`] of the header, [`FormatError::CheckpointKind`],
/// [`FormatError::CheckpointLayout`], [`FormatError::OtherPhysicsVersion`], [`FormatError::OtherPhysics`],
/// [`FormatError::TruncatedCheckpoint`], [`FormatError::CorruptCheckpoint`] of the payload.
pub fn decode<State: DeserializeOwned>(
    identity: &CheckpointIdentity,
    bytes: &[u8],
) -> Result<State, FormatError> {
    let header = Header::from_bytes(bytes)?;
    header.identity.require(identity)?;
    let plain = decompress(&header, header.payload_of(bytes)?)?;
    match postcard::take_from_bytes(&plain) {
        Ok((state, [])) => Ok(state),
        Ok((_, rest)) => {
            let number = rest.len();
            Err(corrupt(format!(
                "{number} bytes remain after the end of the state"
            )))
        }
        Err(error) => Err(corrupt(format!("the payload is not such a state: {error}"))),
    }
}

/// Writes the state to a checkpoint file, whole or not at all; piece by piece, so that it takes no memory to speak of.
///
/// # Errors
/// As [`encode`] and [`atomic::write`](fn@atomic::write).
pub fn write<State: Serialize>(
    path: &Path,
    identity: &CheckpointIdentity,
    state: &State,
) -> Result<(), FormatError> {
    atomic::write_with(path, |file| stream::write(identity, state, file))
}

#[derive(Debug)]
struct Header {
    identity: CheckpointIdentity,
    payload_bytes: u64,
    state_bytes: u64,
    payload_checksum: u32,
}

impl Header {
    fn to_bytes(&self) -> [u8; HEADER_BYTES] {
        let mut bytes = [0; HEADER_BYTES];
        bytes[0..8].copy_from_slice(&SIGNATURE);
        bytes[8..12].copy_from_slice(&FORMAT_VERSION.to_le_bytes());
        bytes[12..20].copy_from_slice(&self.identity.kind);
        bytes[20..24].copy_from_slice(&self.identity.layout_version.to_le_bytes());
        bytes[24..56].copy_from_slice(&self.identity.physics_hash);
        bytes[56..64].copy_from_slice(&self.payload_bytes.to_le_bytes());
        bytes[64..72].copy_from_slice(&self.state_bytes.to_le_bytes());
        bytes[72..76].copy_from_slice(&self.payload_checksum.to_le_bytes());
        bytes[76..80].copy_from_slice(&self.identity.physics_version.to_le_bytes());
        let checksum = crc32fast::hash(&bytes[..80]);
        bytes[80..84].copy_from_slice(&checksum.to_le_bytes());
        bytes
    }

    fn from_bytes(bytes: &[u8]) -> Result<Self, FormatError> {
        let begun = bytes.len().min(SIGNATURE.len());
        if bytes[..begun] != SIGNATURE[..begun] {
            return Err(FormatError::NotACheckpoint);
        }
        let truncated = FormatError::TruncatedCheckpoint {
            expected: HEADER_BYTES as u64,
            found: bytes.len() as u64,
        };
        // The version stands before everything that may differ between versions, the length of the header included.
        if let Some(version) = bytes.get(8..12) {
            let found = u32::from_le_bytes(field(version, 0));
            if found != FORMAT_VERSION {
                let readable = FORMAT_VERSION;
                return Err(FormatError::CheckpointVersion { found, readable });
            }
        }
        let bytes = bytes.get(..HEADER_BYTES).ok_or(truncated)?;
        if crc32fast::hash(&bytes[..80]) != u32::from_le_bytes(field(bytes, 80)) {
            return Err(corrupt("the header does not match its checksum"));
        }
        let header = Self {
            identity: CheckpointIdentity {
                kind: field(bytes, 12),
                layout_version: u32::from_le_bytes(field(bytes, 20)),
                physics_version: u32::from_le_bytes(field(bytes, 76)),
                physics_hash: field(bytes, 24),
            },
            payload_bytes: u64::from_le_bytes(field(bytes, 56)),
            state_bytes: u64::from_le_bytes(field(bytes, 64)),
            payload_checksum: u32::from_le_bytes(field(bytes, 72)),
        };
        if header.payload_bytes.max(header.state_bytes) > MAXIMUM_STATE_BYTES {
            return Err(corrupt(format!(
                "it claims a state of {} bytes in a payload of {}, beyond the limit of {MAXIMUM_STATE_BYTES}",
                header.state_bytes, header.payload_bytes
            )));
        }
        Ok(header)
    }

    fn payload_of<'a>(&self, bytes: &'a [u8]) -> Result<&'a [u8], FormatError> {
        let payload = &bytes[HEADER_BYTES..];
        let (expected, found) = (self.payload_bytes, payload.len() as u64);
        if found < expected {
            let header = HEADER_BYTES as u64;
            return Err(FormatError::TruncatedCheckpoint {
                expected: header + expected,
                found: header + found,
            });
        }
        if found > expected {
            return Err(corrupt("bytes follow the end of the payload"));
        }
        if crc32fast::hash(payload) != self.payload_checksum {
            return Err(corrupt("the payload does not match its checksum"));
        }
        Ok(payload)
    }
}

/// N bytes from an offset within the header.
fn field<const N: usize>(bytes: &[u8], offset: usize) -> [u8; N] {
    bytes[offset..offset + N]
        .try_into()
        .expect("the range is N bytes long")
}

fn corrupt(reason: impl Into<String>) -> FormatError {
    FormatError::CorruptCheckpoint(reason.into())
}

fn decompress(header: &Header, payload: &[u8]) -> Result<Vec<u8>, FormatError> {
    // Grows with what really comes out, not with what the header claims, and stops one byte past the claim.
    let mut plain = Vec::new();
    FrameDecoder::new(payload)
        .take(header.state_bytes + 1)
        .read_to_end(&mut plain)
        .map_err(|error| corrupt(format!("the payload cannot be decompressed: {error}")))?;
    if plain.len() as u64 != header.state_bytes {
        return Err(corrupt(
            "the payload does not decompress to the length in the header",
        ));
    }
    Ok(plain)
}

#[cfg(test)]
mod tests;
