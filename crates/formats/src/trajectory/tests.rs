//! Every format: what was written is read back, a trajectory is cut back and goes on to the same bytes, a full disk and
//! damaged files are told.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use super::*;

/// Three grains and two wall spheres that move from frame to frame.
fn frame(number: u64, turning: bool) -> Frame {
    let shift = number as f64 * 0.1;
    let position = [
        [0.1, -0.2, 3.0],
        [1.0 / 3.0, 0.5, 19.999],
        [-0.7, 1e-9, 0.0],
        [2.5, 0.0, 1.0],
        [-2.5, 0.0, 2.0],
    ];
    Frame {
        step: 40 * number,
        time: 2.0 * number as f64 / 3.0,
        length: 20.0,
        width: 8.0,
        grains: 3,
        position: position.map(|[x, y, z]| [x + shift, y, z]).to_vec(),
        turns: vec![0, -1, number as i32, 0, 0],
        velocity: vec![[shift, 2.0 / 7.0, -0.5]; 5],
        diameter: vec![1.0, 0.8, 0.9, 1.0, 1.0],
        mass: vec![1.0, 0.512, 0.729, 0.0, 0.0],
        rotation: turning.then(|| Rotation {
            angular_velocity: vec![[0.1, 0.2, shift]; 3],
            orientation: vec![[0.6, 0.0, 0.8, 0.0]; 3],
        }),
        contacts: vec![
            FrameContact {
                spheres: [0, 2],
                separation: [0.8, -0.2, 0.3],
                overlap: 0.05,
                normal_force: 0.25,
                tangential_force: 0.125,
                sliding: true,
            };
            number as usize
        ],
        values: vec![
            ("period".into(), shift),
            (
                "flow_rate_ratio".into(),
                if number == 0 { f64::NAN } else { 0.5 + shift },
            ),
        ],
    }
}

fn filled(format: TrajectoryFormat, folder: &Path, frames: std::ops::Range<u64>) {
    let mut file = format.create(folder, 8).unwrap();
    for number in frames {
        file.append(&frame(number, true)).unwrap();
    }
    file.synchronize().unwrap();
}

/// Every file below a folder with its bytes.
fn contents(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut found = BTreeMap::new();
    for entry in fs::read_dir(folder).unwrap() {
        let entry = entry.unwrap();
        let name = entry.file_name().into_string().unwrap();
        if entry.path().is_dir() {
            let inner = contents(&entry.path());
            found.extend(
                inner
                    .into_iter()
                    .map(|(key, bytes)| (format!("{name}/{key}"), bytes)),
            );
        } else {
            found.insert(name, fs::read(entry.path()).unwrap());
        }
    }
    found
}

#[test]
fn cut_back_anywhere_a_trajectory_goes_on_to_the_same_bytes() {
    for format in TrajectoryFormat::ALL {
        let place = tempfile::tempdir().unwrap();
        let (through, stopped) = (place.path().join("through"), place.path().join("stopped"));
        fs::create_dir(&through).unwrap();
        fs::create_dir(&stopped).unwrap();
        filled(format, &through, 0..6);
        for kept in 0..=5_u64 {
            filled(format, &stopped, 0..5);
            // Between the steps of two frames, and before the first.
            let last = (40 * kept).saturating_sub(1);
            let mut file = match kept {
                0 => format.create(&stopped, 8).unwrap(),
                _ => format.resume(&stopped, last).unwrap(),
            };
            assert_eq!(file.frames(), kept, "{format:?}");
            for number in kept..6 {
                file.append(&frame(number, true)).unwrap();
            }
            assert_eq!(file.frames(), 6);
            file.synchronize().unwrap();
            let sizes = contents(&stopped);
            let own = sizes.iter().filter(|(name, _)| !name.ends_with(".pvd"));
            assert_eq!(
                file.bytes(),
                own.map(|(_, bytes)| bytes.len() as u64).sum::<u64>()
            );
            assert!(sizes == contents(&through), "{format:?} from {kept} frames");
        }
    }
}

#[test]
fn the_size_of_a_frame_is_foretold() {
    for format in TrajectoryFormat::ALL {
        for turning in [false, true] {
            let place = tempfile::tempdir().unwrap();
            let mut file = format.create(place.path(), 3).unwrap();
            for number in 0..3 {
                file.append(&frame(number, turning)).unwrap();
            }
            let foretold = (0..3).map(|number| format.frame_bytes(&frame(number, turning)));
            let (foretold, found) = (foretold.sum::<u64>() as f64, file.bytes() as f64);
            assert!(
                foretold > 500.0 && (found / foretold - 1.0).abs() < 0.8,
                "{found} {foretold}"
            );
        }
    }
}

/// The arrays of a GSD file, read by the published layout: (frame, name) to (type, columns, bytes).
fn read_gsd(bytes: &[u8]) -> BTreeMap<(u64, String), (u8, u32, Vec<u8>)> {
    let long = |at: usize| u64::from_le_bytes(bytes[at..at + 8].try_into().unwrap()) as usize;
    assert_eq!(long(0), 0x65df_65df_65df_65df);
    assert_eq!(&bytes[44..48], &[1, 0, 2, 0], "layout 2.1");
    assert_eq!(&bytes[40..44], &[4, 0, 1, 0], "schema 1.4");
    assert_eq!(&bytes[112..118], b"hoomd\0");
    let (index, capacity, names_at, names_units) = (long(8), long(16), long(24), long(32));
    let names: Vec<&str> = bytes[names_at..names_at + 64 * names_units]
        .split(|&byte| byte == 0)
        .map(|name| std::str::from_utf8(name).unwrap())
        .collect();
    let mut arrays = BTreeMap::new();
    let mut last = (0, 0);
    for entry in (0..capacity).map(|entry| index + 32 * entry) {
        let (frame, rows, location) = (long(entry), long(entry + 8), long(entry + 16));
        if location == 0 {
            break;
        }
        let columns = u32::from_le_bytes(bytes[entry + 24..entry + 28].try_into().unwrap());
        let name = u16::from_le_bytes(bytes[entry + 28..entry + 30].try_into().unwrap());
        assert!(
            arrays.is_empty() || (frame, name) > last,
            "sorted by frame and name"
        );
        last = (frame, name);
        let kind = bytes[entry + 30];
        let size = [0, 1, 2, 4, 8, 1, 2, 4, 8, 4, 8][usize::from(kind)];
        let data = bytes[location..location + rows * columns as usize * size].to_vec();
        arrays.insert(
            (frame as u64, names[usize::from(name)].to_owned()),
            (kind, columns, data),
        );
    }
    arrays
}

fn singles(bytes: &[u8]) -> Vec<f32> {
    let numbers = bytes.chunks_exact(4);
    numbers
        .map(|four| f32::from_le_bytes(four.try_into().unwrap()))
        .collect()
}

#[test]
fn gsd_holds_what_was_written() {
    let place = tempfile::tempdir().unwrap();
    filled(TrajectoryFormat::Gsd, place.path(), 0..4);
    let arrays = read_gsd(&fs::read(place.path().join(gsd::FILE)).unwrap());
    for number in 0..4 {
        let written = frame(number, true);
        let array = |name: &str| arrays[&(number, name.to_owned())].clone();
        let (kind, columns, step) = array("configuration/step");
        assert_eq!(
            (kind, columns, step),
            (4, 1, (40 * number).to_le_bytes().to_vec())
        );
        assert_eq!(
            singles(&array("configuration/box").2),
            [8.0, 8.0, 20.0, 0.0, 0.0, 0.0]
        );
        assert_eq!(array("particles/N").2, 5_u32.to_le_bytes());
        let (kind, columns, position) = array("particles/position");
        assert_eq!((kind, columns), (9, 3));
        let expected = written
            .position
            .iter()
            .flat_map(|&[x, y, z]| [x, y, z - 10.0]);
        assert!(
            singles(&position)
                .into_iter()
                .eq(expected.map(|value| value as f32))
        );
        let velocity = written.velocity.iter().flatten().map(|&value| value as f32);
        assert!(
            singles(&array("particles/velocity").2)
                .into_iter()
                .eq(velocity)
        );
        let image = array("particles/image").2;
        assert_eq!(image[32..36], (number as i32).to_le_bytes());
        let (_, columns, orientation) = array("particles/orientation");
        assert_eq!(columns, 4);
        let orientation = singles(&orientation);
        assert_eq!(orientation[..4], [0.6, 0.0, 0.8, 0.0]);
        assert_eq!(
            orientation[16..],
            [1.0, 0.0, 0.0, 0.0],
            "a wall sphere does not turn"
        );
        let spin = singles(&array("log/particles/angular_velocity").2);
        assert_eq!(
            spin[8..],
            [(number as f64 * 0.1) as f32, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]
        );
        let logged = [("time".into(), written.time)];
        for (name, value) in logged.iter().chain(&written.values) {
            let (kind, _, logged) = array(&format!("log/{name}"));
            assert_eq!((kind, logged), (10, value.to_le_bytes().to_vec()), "{name}");
        }
        assert_eq!(
            arrays.contains_key(&(number, "particles/diameter".into())),
            number == 0
        );
    }
    let first = |name: &str| arrays[&(0, name.to_owned())].clone();
    assert_eq!(
        singles(&first("particles/diameter").2),
        [1.0, 0.8, 0.9, 1.0, 1.0]
    );
    assert_eq!(
        singles(&first("particles/mass").2),
        [1.0, 0.512, 0.729, 0.0, 0.0]
    );
    let kinds = [0, 0, 0, 1, 1_u32].map(u32::to_le_bytes).concat();
    assert_eq!(first("particles/typeid").2, kinds);
    assert_eq!(
        first("particles/types"),
        (5, 6, b"grain\0wall\0\0".to_vec())
    );
}

#[test]
fn lammps_text_reads_back_to_the_same_bits() {
    let place = tempfile::tempdir().unwrap();
    filled(TrajectoryFormat::Lammps, place.path(), 0..3);
    let text = fs::read_to_string(place.path().join(lammps::FILE)).unwrap();
    assert!(text.starts_with("ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n"));
    let frames: Vec<&str> = text.split("ITEM: TIMESTEP\n").skip(1).collect();
    assert_eq!(frames.len(), 3);
    for (number, text) in frames.iter().enumerate() {
        let written = frame(number as u64, true);
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(lines[0].parse::<u64>().unwrap(), written.step);
        assert_eq!(
            lines[3..7],
            [
                "ITEM: BOX BOUNDS ff ff pp",
                "-4.0 4.0",
                "-4.0 4.0",
                "0.0 20.0"
            ]
        );
        assert_eq!(
            lines[7],
            "ITEM: ATOMS id type diameter x y z vx vy vz omegax omegay omegaz"
        );
        assert_eq!(lines.len(), 13);
        for sphere in 0..5 {
            let numbers: Vec<f64> = lines[8 + sphere]
                .split(' ')
                .map(|word| word.parse().unwrap())
                .collect();
            let kind = if sphere < 3 { 1.0 } else { 2.0 };
            assert_eq!(
                numbers[..3],
                [sphere as f64 + 1.0, kind, written.diameter[sphere]]
            );
            assert_eq!(numbers[3..6], written.position[sphere]);
            assert_eq!(numbers[6..9], written.velocity[sphere]);
            let spin = written
                .rotation
                .as_ref()
                .unwrap()
                .angular_velocity
                .get(sphere);
            assert_eq!(numbers[9..], *spin.unwrap_or(&[0.0; 3]));
        }
    }
}

/// An array of a VTP file: the text is XML up to the binary part, where arrays stand behind their lengths.
fn vtp_array(bytes: &[u8], name: &str) -> (String, Vec<u8>) {
    let mark = b"<AppendedData encoding=\"raw\">\n_";
    let at = bytes
        .windows(mark.len())
        .position(|window| window == mark)
        .unwrap();
    let text = std::str::from_utf8(&bytes[..at]).unwrap().to_owned() + "</VTKFile>";
    let document = roxmltree::Document::parse(&text).unwrap();
    let node = document
        .descendants()
        .find(|node| node.attribute("Name") == Some(name))
        .unwrap_or_else(|| panic!("no array {name}"));
    let start = at + mark.len() + node.attribute("offset").unwrap().parse::<usize>().unwrap();
    let length = u64::from_le_bytes(bytes[start..start + 8].try_into().unwrap()) as usize;
    let data = bytes[start + 8..start + 8 + length].to_vec();
    (node.attribute("type").unwrap().to_owned(), data)
}

fn reals(bytes: &[u8], name: &str) -> Vec<f64> {
    let (kind, data) = vtp_array(bytes, name);
    assert_eq!(kind, "Float64");
    let numbers = data.chunks_exact(8);
    numbers
        .map(|eight| f64::from_le_bytes(eight.try_into().unwrap()))
        .collect()
}

#[test]
fn vtp_holds_spheres_and_contacts_and_its_index_their_times() {
    let place = tempfile::tempdir().unwrap();
    filled(TrajectoryFormat::Vtp, place.path(), 0..3);
    for (index, kind) in [(vtp::SPHERES, "spheres"), (vtp::CONTACTS, "contacts")] {
        let text = fs::read_to_string(place.path().join(index)).unwrap();
        let document = roxmltree::Document::parse(&text).unwrap();
        let sets = document
            .descendants()
            .filter(|node| node.has_tag_name("DataSet"));
        for (number, set) in sets.enumerate() {
            let written = frame(number as u64, true);
            assert_eq!(
                set.attribute("timestep").unwrap().parse::<f64>().unwrap(),
                written.time
            );
            let file = set.attribute("file").unwrap();
            assert!(file.contains(kind));
            let bytes = fs::read(place.path().join(file)).unwrap();
            assert_eq!(reals(&bytes, "TimeValue"), [written.time]);
            assert_eq!(reals(&bytes, "period"), [written.values[0].1]);
            if kind == "spheres" {
                assert_eq!(reals(&bytes, "Points"), written.position.concat());
                assert_eq!(reals(&bytes, "velocity"), written.velocity.concat());
                assert_eq!(reals(&bytes, "diameter"), written.diameter);
                assert_eq!(reals(&bytes, "angular_velocity").len(), 15);
                assert_eq!(vtp_array(&bytes, "type").1, [0, 0, 0, 1, 1]);
            } else {
                assert_eq!(reals(&bytes, "normal_force"), vec![0.25; number]);
                assert_eq!(reals(&bytes, "tangential_force"), vec![0.125; number]);
                assert_eq!(vtp_array(&bytes, "sliding").1, vec![1; number]);
                let [x, y, z] = written.position[0];
                let line = [x, y, z, x - 0.8, y + 0.2, z - 0.3].repeat(number);
                assert_eq!(reals(&bytes, "Points"), line);
            }
        }
        assert_eq!(text.matches("<DataSet").count(), 3);
    }
}

#[test]
fn a_smooth_wall_has_no_number_among_the_spheres_of_vtp() {
    let numbers = |second: usize| {
        let mut touching = frame(1, false);
        touching.contacts[0].spheres[1] = second;
        vtp_array(&vtp::contacts(&touching), "second")
    };
    let int32 = |number: i32| ("Int32".to_owned(), number.to_le_bytes().to_vec());
    // Three grains and two wall spheres.
    assert_eq!([4, 5, 6].map(numbers), [int32(4), int32(-1), int32(-1)]);
}

#[test]
fn what_a_kill_leaves_of_a_frame_is_cut_off() {
    for format in [TrajectoryFormat::Gsd, TrajectoryFormat::Lammps] {
        let place = tempfile::tempdir().unwrap();
        filled(format, place.path(), 0..3);
        let path = place.path().join(format.file_name());
        let whole = fs::read(&path).unwrap();
        // Arrays without an entry, or lines without their end.
        fs::write(
            &path,
            [&whole[..], b"ITEM: TIMESTEP\n7\nITEM: NUMB"].concat(),
        )
        .unwrap();
        if format == TrajectoryFormat::Gsd {
            assert!(
                read_gsd(&fs::read(&path).unwrap())
                    .keys()
                    .all(|(frame, _)| *frame < 3)
            );
        }
        let file = format.resume(place.path(), u64::MAX).unwrap();
        assert_eq!(file.frames(), 3);
        drop(file);
        assert!(fs::read(&path).unwrap() == whole, "{format:?}");
    }
}

#[test]
fn another_file_is_refused_and_stays() {
    for (format, name) in [
        (TrajectoryFormat::Gsd, gsd::FILE),
        (TrajectoryFormat::Vtp, vtp::SPHERES),
        (TrajectoryFormat::Lammps, lammps::FILE),
    ] {
        let place = tempfile::tempdir().unwrap();
        let path = place.path().join(name);
        let missing = format.resume(place.path(), 7).unwrap_err();
        assert!(missing.to_string().contains(name), "{missing}");
        for other in [&b"<DataSet timestep=\"x\"/>\n"[..], &[0x5a; 400][..]] {
            fs::write(&path, other).unwrap();
            // What names no data set and is no text is refused as well, by another error.
            assert!(format.resume(place.path(), 7).is_err(), "{format:?}");
            assert_eq!(fs::read(&path).unwrap(), other, "{format:?}");
        }
    }
}

#[test]
fn a_gsd_file_that_was_damaged_is_refused_and_keeps_its_frames() {
    let place = tempfile::tempdir().unwrap();
    let path = place.path().join(gsd::FILE);
    filled(TrajectoryFormat::Gsd, place.path(), 0..4);
    let whole = fs::read(&path).unwrap();
    let long = |at: usize| u64::from_le_bytes(whole[at..at + 8].try_into().unwrap());
    // The first entry of the frame after the first, in the middle of the file.
    let entry = (256..).step_by(32).find(|&entry| long(entry) == 1).unwrap();
    let names = long(24) as usize;
    let full = [b'x'; 65_536];
    for (name, at, bytes) in [
        (
            "a place beyond the file",
            entry + 16,
            &u64::MAX.to_le_bytes()[..],
        ),
        ("a place in the header", entry + 16, &8_u64.to_le_bytes()),
        (
            "rows beyond all numbers",
            entry + 8,
            &u64::MAX.to_le_bytes(),
        ),
        ("no type", entry + 30, &[77]),
        ("no names", names, &[0; 64]),
        ("names without end", names, &full[..64 * long(32) as usize]),
    ] {
        let mut bytes_now = whole.clone();
        bytes_now[at..at + bytes.len()].copy_from_slice(bytes);
        fs::write(&path, &bytes_now).unwrap();
        let refused = TrajectoryFormat::Gsd.resume(place.path(), 1000);
        assert!(
            matches!(refused, Err(FormatError::NotATrajectory { .. })),
            "{name}: {refused:?}"
        );
        assert!(fs::read(&path).unwrap() == bytes_now, "{name}");
    }
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_is_told() {
    use super::append::Growing;
    let mut full = Growing::open(Path::new("/dev/full")).unwrap();
    let error = full.append(b"x").unwrap_err();
    assert!(
        error.to_string().contains("No space left on device"),
        "{error}"
    );
    assert_eq!(full.end(), 0);
}

#[test]
fn a_trajectory_may_become_longer_than_it_was_meant_to_be() {
    let place = tempfile::tempdir().unwrap();
    let path = place.path().join("long.gsd");
    let mut file = TrajectoryFormat::Gsd.create_at(&path, 1).unwrap();
    for number in 0..50 {
        file.append(&frame(number, true)).unwrap();
    }
    drop(file);
    let mut reader = gsd::GsdReader::open(&path).unwrap();
    assert_eq!((reader.frames(), reader.lost_frames()), (50, 0));
    for number in [0, 1, 17, 49] {
        let found = reader.frame(number).unwrap();
        assert_eq!(found.time, frame(number as u64, true).time);
    }
}

#[test]
fn one_frame_is_a_file_of_any_name() {
    let place = tempfile::tempdir().unwrap();
    for ending in ["gsd", "vtp", "lammpstrj"] {
        let path = place.path().join(format!("now.{ending}"));
        let format = TrajectoryFormat::by_ending(ending).unwrap();
        for _ in 0..2 {
            format.write(&path, &frame(3, true)).unwrap();
        }
        assert!(fs::metadata(&path).unwrap().len() > 500, "{ending}");
    }
    let mut reader = gsd::GsdReader::open(&place.path().join("now.gsd")).unwrap();
    assert_eq!(reader.frame(0).unwrap().step, frame(3, true).step);
}
