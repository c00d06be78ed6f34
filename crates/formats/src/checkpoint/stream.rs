//! Writing a checkpoint piece by piece: state, compression, checksum, file.

use std::io::{self, BufWriter, Seek, SeekFrom, Write};

use lz4_flex::frame::{BlockSize, FrameEncoder, FrameInfo};
use serde::Serialize;

use super::{CheckpointIdentity, HEADER_BYTES, Header, MAXIMUM_STATE_BYTES};
use crate::error::FormatError;

/// Passes bytes on; counts them, adds them up, and remembers why it stopped.
struct Meter<W> {
    target: W,
    bytes: u64,
    checksum: crc32fast::Hasher,
    failure: Option<io::Error>,
}

impl<W: Write> Meter<W> {
    fn new(target: W) -> Self {
        Self {
            target,
            bytes: 0,
            checksum: crc32fast::Hasher::new(),
            failure: None,
        }
    }
}

impl<W: Write> Write for Meter<W> {
    fn write(&mut self, buffer: &[u8]) -> io::Result<usize> {
        // A state that is too large is refused as soon as it is, not after it has filled the disk.
        let outcome = if self.bytes > MAXIMUM_STATE_BYTES {
            Err(io::ErrorKind::FileTooLarge.into())
        } else {
            self.target.write(buffer)
        };
        match outcome {
            Ok(count) => {
                self.bytes += count as u64;
                self.checksum.update(&buffer[..count]);
                Ok(count)
            }
            Err(error) => {
                let kind = error.kind();
                self.failure = Some(error);
                Err(kind.into())
            }
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        self.target.flush()
    }
}

/// Writes a checkpoint from the beginning of an empty target; a state that cannot be written, wherever to, is a
/// [`FormatError`] inside of the error.
pub(super) fn write<State: Serialize>(
    identity: &CheckpointIdentity,
    state: &State,
    target: &mut (impl Write + Seek),
) -> io::Result<()> {
    let mut target = BufWriter::new(target);
    // The header's place: what it says is known at the end.
    target.write_all(&[0; HEADER_BYTES])?;

    // LZ4 leaves a real state a tenth larger than stronger methods do: most of the rest are mantissas, which none
    // compresses.
    let blocks = FrameInfo::new().block_size(BlockSize::Max256KB);
    let payload = FrameEncoder::with_frame_info(blocks, Meter::new(&mut target));
    let mut plain = Meter::new(payload);
    let serialized = postcard::to_io(state, &mut plain).map(|_| ());
    let (state_bytes, failure) = (plain.bytes, plain.failure);
    let mut payload = plain.target;
    // An encoder that has failed to write is not to be asked again: it may panic.
    let finished = match serialized {
        Ok(()) => payload.try_finish(),
        Err(_) => Ok(()),
    };
    let payload = payload.get_mut();
    if state_bytes.max(payload.bytes) > MAXIMUM_STATE_BYTES {
        return Err(io::Error::other(FormatError::StateTooLarge {
            bytes: state_bytes.max(payload.bytes),
            limit: MAXIMUM_STATE_BYTES,
        }));
    }
    // What the target said comes first: all other errors follow from it.
    if let Some(error) = payload.failure.take().or(failure) {
        return Err(error);
    }
    serialized.map_err(|error| io::Error::other(FormatError::Serialize(error)))?;
    finished.map_err(io::Error::other)?;

    let header = Header {
        identity: *identity,
        payload_bytes: payload.bytes,
        state_bytes,
        payload_checksum: payload.checksum.clone().finalize(),
    };
    target.seek(SeekFrom::Start(0))?;
    target.write_all(&header.to_bytes())?;
    target.flush()
}
