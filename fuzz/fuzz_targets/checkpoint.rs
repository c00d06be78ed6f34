//! No bytes make the reader of checkpoints panic, and a state that it accepts can be gone on with: it runs to its next
//! sample, or says that it diverged, and is written and read again.
//!
//! The first byte of the input chooses the tube and whether the rest is the file, or the state within a file whose
//! checksums are right. The rest is taken as in [`peristalsis_fuzz::damaged`].
#![no_main]

use std::io::{Read, Write};
use std::sync::LazyLock;

use libfuzzer_sys::fuzz_target;
use lz4_flex::frame::{FrameDecoder, FrameEncoder};
use peristalsis_configuration::Configuration;
use peristalsis_fuzz::{damaged, scratch, tubes};
use peristalsis_run::{Run, Summary, profile_table, timeseries_table, waves_table};

/// Bytes of the header of a checkpoint.
const HEADER: usize = 84;

/// A tube, the checkpoint of a run of it that has begun, and the state within.
struct Known {
    configuration: Configuration,
    file: Vec<u8>,
    state: Vec<u8>,
}

static KNOWN: LazyLock<Vec<Known>> = LazyLock::new(|| tubes().map(known).into());

fn known(configuration: Configuration) -> Known {
    let mut run = Run::new(configuration.clone()).expect("the grains fit");
    for _ in 0..3 {
        run.advance().expect("a sound run goes on");
    }
    let folder = scratch("checkpoint");
    let path = folder.join("state.checkpoint");
    run.write_checkpoint(&path).expect("the state can be written");
    let file = std::fs::read(&path).expect("it has just been written");
    std::fs::remove_dir_all(folder).expect("the folder is ours");
    let mut state = Vec::new();
    FrameDecoder::new(&file[HEADER..])
        .read_to_end(&mut state)
        .expect("the payload is an LZ4 frame");
    Known {
        configuration,
        file,
        state,
    }
}

/// The file of a state that need not be one, its checksums right.
fn sealed(header: &[u8], state: &[u8]) -> Vec<u8> {
    let mut encoder = FrameEncoder::new(Vec::new());
    encoder.write_all(state).expect("memory takes everything");
    let payload = encoder.finish().expect("memory takes everything");
    let mut bytes = header[..56].to_vec();
    bytes.extend((payload.len() as u64).to_le_bytes());
    bytes.extend((state.len() as u64).to_le_bytes());
    bytes.extend(crc32fast::hash(&payload).to_le_bytes());
    bytes.extend(&header[76..80]);
    bytes.extend(crc32fast::hash(&bytes).to_le_bytes());
    bytes.extend(payload);
    bytes
}

fuzz_target!(|input: &[u8]| {
    let Some((&choice, rest)) = input.split_first() else {
        return;
    };
    let known = &KNOWN[usize::from(choice % 2)];
    let bytes = if choice / 2 % 2 == 0 {
        sealed(&known.file, &damaged(&known.state, rest))
    } else {
        damaged(&known.file, rest)
    };
    let read = Run::from_snapshot(&bytes);
    let mut run = match read.and_then(|run| run.under(known.configuration.clone())) {
        Ok(run) => run,
        Err(error) => {
            assert!(!error.to_string().is_empty());
            return;
        }
    };
    if run.advance().is_ok() {
        let snapshot = run.to_snapshot().expect("a small state can be written");
        drop(Run::from_snapshot(&snapshot));
    }
    drop(Summary::of(&run, peristalsis_run::Status::Interrupted, None).to_json());
    drop((timeseries_table(&run), profile_table(&run), waves_table(&run)));
});
