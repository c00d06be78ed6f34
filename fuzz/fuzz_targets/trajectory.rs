//! No bytes make the readers of GSD trajectories panic: neither the one that gives frames, nor the one that goes on with a
//! file, nor the viewer's, which knows the run. What was gone on with has the frame that was written to it.
//!
//! The first byte of the input chooses the tube; the rest is taken as in [`peristalsis_fuzz::damaged`].
#![no_main]

use std::path::PathBuf;
use std::sync::LazyLock;

use libfuzzer_sys::fuzz_target;
use peristalsis_configuration::Configuration;
use peristalsis_formats::TrajectoryFormat;
use peristalsis_formats::trajectory::Frame;
use peristalsis_formats::trajectory::gsd::GsdReader;
use peristalsis_fuzz::{damaged, scratch, tubes};
use peristalsis_run::{FrameSource, Run};
use peristalsis_viewer::Recording;

/// Frames of the whole files.
const FRAMES: u64 = 3;
/// The last step whose frame is kept when a file is gone on with.
const STEP: u64 = 1 << 40;

/// A tube, a trajectory of it and a frame of its own.
struct Known {
    configuration: Configuration,
    file: Vec<u8>,
    frame: Frame,
}

static FOLDER: LazyLock<PathBuf> = LazyLock::new(|| scratch("trajectory"));
static KNOWN: LazyLock<Vec<Known>> = LazyLock::new(|| tubes().map(known).into());

fn known(configuration: Configuration) -> Known {
    let format = TrajectoryFormat::Gsd;
    let mut run = Run::new(configuration.clone()).expect("the grains fit");
    run.follow_orientations();
    let mut file = format.create(&FOLDER, FRAMES).expect("a file can be made");
    for _ in 0..FRAMES {
        run.advance().expect("a sound run goes on");
        let frame = FrameSource::now(&run, false);
        file.append(&frame).expect("a frame can be written");
    }
    drop(file);
    Known {
        configuration,
        file: std::fs::read(FOLDER.join(format.file_name())).expect("it has just been written"),
        frame: FrameSource::now(&run, false),
    }
}

fuzz_target!(|input: &[u8]| {
    let Some((&choice, rest)) = input.split_first() else {
        return;
    };
    let known = &KNOWN[usize::from(choice % 2)];
    let format = TrajectoryFormat::Gsd;
    let path = FOLDER.join(format.file_name());
    std::fs::write(&path, damaged(&known.file, rest)).expect("there is room for a small file");
    if let Ok(mut reader) = GsdReader::open(&path) {
        for number in 0..reader.frames().min(8) {
            match reader.frame(number) {
                Ok(frame) => assert_eq!(frame.position.len(), frame.diameter.len()),
                Err(error) => assert!(!error.to_string().is_empty()),
            }
            drop(reader.value(number, "flow_rate_ratio"));
        }
        assert!(reader.frame(reader.frames()).is_err());
    }
    if let Err(error) = Recording::open(&path, known.configuration.clone(), Vec::new()) {
        assert!(!error.to_string().is_empty());
    }
    if let Ok(mut file) = format.resume(&FOLDER, STEP) {
        let before = file.frames();
        if file.append(&known.frame).is_ok() {
            assert_eq!(file.frames(), before + 1);
        }
        drop(file);
        drop(GsdReader::open(&path));
    }
});
