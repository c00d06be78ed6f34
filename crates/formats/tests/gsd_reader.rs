//! GSD files are read back; a file cut short, damaged or of another program is refused in words.

#![allow(
    clippy::unwrap_used,
    reason = "a test fails where what it needs is missing"
)]

use std::path::{Path, PathBuf};

use peristalsis_formats::trajectory::gsd::GsdReader;
use peristalsis_formats::trajectory::{Frame, Rotation};
use peristalsis_formats::{FormatError, TrajectoryFormat};
use proptest::prelude::*;

/// Three grains and two wall spheres, in numbers that 32 bits hold.
fn frame(number: u32, turning: bool) -> Frame {
    let shift = f64::from(number) * 0.25;
    Frame {
        step: 40 * u64::from(number),
        time: 0.1 * f64::from(number),
        length: 20.0,
        width: 8.0,
        grains: 3,
        position: vec![
            [shift, -0.25, 3.0],
            [0.5, 0.5, 19.5],
            [-0.75, 0.0, 0.0],
            [2.5, 0.0, 1.0],
            [-2.5, 0.0, 2.0],
        ],
        turns: vec![0, -1, number as i32, 0, 0],
        velocity: vec![[shift, 0.125, -0.5]; 5],
        diameter: vec![1.0, 0.75, 0.875, 1.0, 1.0],
        mass: vec![1.0, 0.5, 0.75, 0.0, 0.0],
        rotation: turning.then(|| Rotation {
            angular_velocity: vec![[0.5, 0.25, shift]; 3],
            orientation: vec![[0.5, 0.5, 0.5, 0.5]; 3],
        }),
        contacts: Vec::new(),
        values: vec![
            ("period".into(), 0.1 * f64::from(number)),
            ("heading".into(), -1.0),
        ],
    }
}

fn written(folder: &Path, turning: bool, frames: u32) -> PathBuf {
    let format = TrajectoryFormat::Gsd;
    let mut file = format.create(folder, 8).unwrap();
    for number in 0..frames {
        file.append(&frame(number, turning)).unwrap();
    }
    folder.join(format.file_name())
}

fn reason(path: &Path) -> String {
    match GsdReader::open(path).and_then(|mut reader| reader.frame(0).map(drop)) {
        Err(FormatError::UnreadableTrajectory { reason, path: told }) => {
            assert_eq!(told, path);
            reason
        }
        other => panic!("expected a refusal, got {other:?}"),
    }
}

#[test]
fn frames_come_back_in_any_order() {
    for turning in [false, true] {
        let place = tempfile::tempdir().unwrap();
        let mut reader = GsdReader::open(&written(place.path(), turning, 4)).unwrap();
        assert_eq!((reader.frames(), reader.lost_frames()), (4, 0));
        for number in [3, 0, 2, 1, 1] {
            assert_eq!(reader.frame(number).unwrap(), frame(number as u32, turning));
        }
        assert_eq!(reader.value(3, "period").unwrap(), Some(0.1 * 3.0));
        assert_eq!(reader.value(3, "time").unwrap(), Some(0.1 * 3.0));
        assert_eq!(reader.value(3, "weather").unwrap(), None);
        let beyond = reader.frame(4).unwrap_err().to_string();
        assert!(
            beyond.contains("no frame 4") && beyond.contains("it holds 4"),
            "{beyond}"
        );
    }
}

#[test]
fn a_place_that_rounds_to_the_end_of_the_tube_begins_its_next_turn() {
    let place = tempfile::tempdir().unwrap();
    let mut end = frame(0, false);
    end.position[1][2] = 20.0 - 1e-9;
    let mut file = TrajectoryFormat::Gsd.create(place.path(), 1).unwrap();
    file.append(&end).unwrap();
    let path = place.path().join(TrajectoryFormat::Gsd.file_name());
    let read = GsdReader::open(&path).unwrap().frame(0).unwrap();
    assert_eq!((read.position[1][2], read.turns[1]), (0.0, 0));
}

#[test]
fn a_file_cut_anywhere_gives_its_whole_frames_or_says_so() {
    let place = tempfile::tempdir().unwrap();
    let path = written(place.path(), true, 3);
    let bytes = std::fs::read(&path).unwrap();
    let cut = place.path().join("cut.gsd");
    let mut seen = [false; 4];
    for length in (0..=bytes.len()).rev().step_by(7) {
        std::fs::write(&cut, &bytes[..length]).unwrap();
        match GsdReader::open(&cut) {
            Ok(mut reader) => {
                let whole = reader.frames();
                assert_eq!(whole as u64 + reader.lost_frames(), 3);
                seen[whole] = true;
                for number in 0..whole {
                    assert_eq!(reader.frame(number).unwrap(), frame(number as u32, true));
                }
            }
            Err(FormatError::UnreadableTrajectory { reason, .. }) => {
                seen[0] = true;
                let expected = if length < 8 {
                    "begin like"
                } else {
                    "cut short"
                };
                assert!(reason.contains(expected), "{length}: {reason}");
            }
            Err(other) => panic!("{other}"),
        }
    }
    assert_eq!(seen, [true; 4]);
}

#[test]
fn files_of_others_are_refused_in_words() {
    let place = tempfile::tempdir().unwrap();
    let path = written(place.path(), false, 2);
    let bytes = std::fs::read(&path).unwrap();
    let other = place.path().join("other.gsd");
    let changed = |at: usize, new: &[u8]| {
        let mut bytes = bytes.clone();
        bytes[at..at + new.len()].copy_from_slice(new);
        std::fs::write(&other, bytes).unwrap();
        reason(&other)
    };
    assert!(changed(0, b"ITEM: TI").contains("does not begin like a GSD file"));
    assert!(changed(46, &[3, 0]).contains("version 3"));
    assert!(changed(112, b"dirty\0").contains("`dirty`"));
    let types = bytes
        .windows(6)
        .position(|window| window == b"grain\0")
        .unwrap();
    assert!(changed(types, b"colloid").contains("its types of particles are collo"));
    assert!(matches!(
        GsdReader::open(&place.path().join("none.gsd")),
        Err(FormatError::Io { .. })
    ));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn no_damage_makes_the_reader_panic(
        changes in proptest::collection::vec((0_usize..10_000, any::<u8>()), 1..40),
    ) {
        let place = tempfile::tempdir().unwrap();
        let path = written(place.path(), true, 3);
        let mut bytes = std::fs::read(&path).unwrap();
        for (at, value) in changes {
            let at = at % bytes.len();
            bytes[at] = value;
        }
        std::fs::write(&path, bytes).unwrap();
        if let Ok(mut reader) = GsdReader::open(&path) {
            for number in 0..reader.frames() {
                drop(reader.frame(number));
            }
        }
    }
}
