//! Frames as VTK polydata, one file per frame, with an index that gives each its time.
//!
//! `trajectory.pvd` lists the spheres: points with type (0 grain, 1 wall), diameter, velocity and, where grains turn,
//! angular velocity and orientation. `contacts.pvd` lists the contacts: lines from centre to centre with normal and
//! tangential force, overlap, the numbers of the two spheres, and whether they slide. Of a contact with a smooth wall the
//! second number is -1, and the line ends on the curve R(z). A line across the seam of the tube leaves it on one side. The values of the instant are field data. See
//! <https://docs.vtk.org/en/latest/design_documents/VTKFileFormats.html>.

use std::fs::{self, File};
use std::path::{Path, PathBuf};

use super::{Frame, FrameContact, TrajectoryFile};
use crate::atomic;
use crate::error::FormatError;

/// Index of the spheres, in a run's folder.
pub(super) const SPHERES: &str = "trajectory.pvd";
/// Index of the contacts.
pub(super) const CONTACTS: &str = "contacts.pvd";
/// Folder of the frames.
pub(super) const FOLDER: &str = "trajectory";

const BEGINNING: &str = "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\" \
                         byte_order=\"LittleEndian\">\n<Collection>\n";

/// A trajectory in VTP that is being written.
#[derive(Debug, Default)]
pub(super) struct VtpTrajectory {
    folder: PathBuf,
    listed: Vec<Listed>,
    /// Frames that are on the disk for certain.
    synchronized: usize,
    bytes: u64,
}

/// A frame in the index.
#[derive(Clone, Debug, PartialEq)]
struct Listed {
    step: u64,
    time: f64,
}

/// What a file of a frame holds.
struct Content {
    index: &'static str,
    /// How names of files begin.
    name: &'static str,
    encode: fn(&Frame) -> Vec<u8>,
}

const CONTENTS: [Content; 2] = [
    Content {
        index: SPHERES,
        name: "spheres",
        encode: spheres,
    },
    Content {
        index: CONTACTS,
        name: "contacts",
        encode: contacts,
    },
];

impl Content {
    /// The file of a frame, from the folder of the index on.
    fn file(&self, step: u64) -> String {
        format!("{FOLDER}/{}-{step:012}.vtp", self.name)
    }
}

impl VtpTrajectory {
    /// An empty trajectory in a folder.
    pub(super) fn create(folder: &Path) -> Result<Self, FormatError> {
        let frames = folder.join(FOLDER);
        fs::create_dir_all(&frames).map_err(FormatError::io("create", &frames))?;
        let mut trajectory = Self {
            folder: folder.to_owned(),
            ..Self::default()
        };
        trajectory.cut(&[])?;
        Ok(trajectory)
    }

    /// A trajectory to go on with, without its frames after `step`.
    pub(super) fn resume(folder: &Path, step: u64) -> Result<Self, FormatError> {
        let path = folder.join(SPHERES);
        let text = fs::read_to_string(&path).map_err(FormatError::io("read", &path))?;
        if !text.starts_with(BEGINNING) {
            let reason = "it does not begin like an index of this program";
            return Err(FormatError::not_a_trajectory(&path, reason));
        }
        let listed = text
            .lines()
            .filter(|line| line.trim_start().starts_with("<DataSet "))
            .map(|line| {
                listed(line).ok_or_else(|| {
                    let reason = format!("its line `{}` is none of this program's", line.trim());
                    FormatError::not_a_trajectory(&path, reason)
                })
            })
            .collect::<Result<Vec<_>, _>>()?;
        let kept = listed.partition_point(|frame| frame.step <= step);
        let mut trajectory = Self {
            folder: folder.to_owned(),
            synchronized: kept,
            ..Self::default()
        };
        for file in listed[..kept].iter().flat_map(files_of) {
            let file = folder.join(file);
            let found = fs::metadata(&file).map_err(FormatError::io("read", &file))?;
            trajectory.bytes += found.len();
        }
        trajectory.cut(&listed[..kept])?;
        Ok(trajectory)
    }

    /// Lists these frames and no others, and removes the files of all others.
    fn cut(&mut self, kept: &[Listed]) -> Result<(), FormatError> {
        self.list(kept)?;
        let frames = self.folder.join(FOLDER);
        let failed = |source| FormatError::io("remove frames from", &frames)(source);
        for entry in fs::read_dir(&frames).map_err(failed)? {
            let entry = entry.map_err(failed)?;
            let step = entry.file_name().to_str().and_then(step_of);
            if step.is_some_and(|step| !kept.iter().any(|frame| frame.step == step)) {
                fs::remove_file(entry.path()).map_err(failed)?;
            }
        }
        Ok(())
    }

    /// Writes both indices.
    fn list(&mut self, frames: &[Listed]) -> Result<(), FormatError> {
        for content in &CONTENTS {
            let mut text = String::from(BEGINNING);
            for frame in frames {
                let (time, file) = (frame.time, content.file(frame.step));
                text += &format!("<DataSet timestep=\"{time:?}\" part=\"0\" file=\"{file}\"/>\n");
            }
            text.push_str("</Collection>\n</VTKFile>\n");
            atomic::replace(&self.folder.join(content.index), text.as_bytes())?;
        }
        self.listed = frames.to_vec();
        Ok(())
    }
}

impl TrajectoryFile for VtpTrajectory {
    fn append(&mut self, frame: &Frame) -> Result<(), FormatError> {
        let mut bytes = 0;
        for content in &CONTENTS {
            let encoded = (content.encode)(frame);
            atomic::replace(&self.folder.join(content.file(frame.step)), &encoded)?;
            bytes += encoded.len() as u64;
        }
        let (step, time) = (frame.step, frame.time);
        self.list(&[&self.listed[..], &[Listed { step, time }]].concat())?;
        self.bytes += bytes;
        Ok(())
    }

    fn synchronize(&mut self) -> Result<(), FormatError> {
        let files = self.listed[self.synchronized..].iter().flat_map(files_of);
        let indices = CONTENTS.iter().map(|content| content.index.to_owned());
        for name in files.chain(indices) {
            let path = self.folder.join(name);
            File::open(&path)
                .and_then(|file| file.sync_all())
                .map_err(FormatError::io("synchronize", &path))?;
        }
        atomic::synchronize(&self.folder.join(FOLDER))?;
        atomic::synchronize(&self.folder)?;
        self.synchronized = self.listed.len();
        Ok(())
    }

    fn frames(&self) -> u64 {
        self.listed.len() as u64
    }

    fn bytes(&self) -> u64 {
        self.bytes
    }
}

/// Bytes that a frame takes.
pub(super) fn frame_bytes(frame: &Frame) -> u64 {
    let bytes = CONTENTS.iter().map(|content| (content.encode)(frame).len());
    bytes.sum::<usize>() as u64
}

/// The files of a frame, from the folder of the index on.
fn files_of(frame: &Listed) -> [String; 2] {
    CONTENTS.each_ref().map(|content| content.file(frame.step))
}

/// The frame of a line of an index.
fn listed(line: &str) -> Option<Listed> {
    let attribute = |name: &str| {
        let (_, rest) = line.split_once(&format!("{name}=\""))?;
        rest.split_once('"').map(|(value, _)| value)
    };
    Some(Listed {
        time: attribute("timestep")?.parse().ok()?,
        step: step_of(attribute("file")?)?,
    })
}

/// The step in the name of a frame's file.
fn step_of(name: &str) -> Option<u64> {
    let (_, number) = name.strip_suffix(".vtp")?.rsplit_once('-')?;
    number.parse().ok()
}

/// The spheres of a frame.
pub(super) fn spheres(frame: &Frame) -> Vec<u8> {
    let number = frame.spheres();
    let mut file = Polydata::new(frame);
    file.begin_piece([("Points", number), ("Verts", number), ("Lines", 0)]);
    file.open("PointData Scalars=\"diameter\" Vectors=\"velocity\"");
    let kinds = (0..number).map(|sphere| u8::from(sphere >= frame.grains));
    file.array("UInt8", "type", 1, kinds.collect());
    file.reals("diameter", frame.diameter.iter().map(|&value| [value]));
    file.reals("velocity", frame.velocity.iter().copied());
    if let Some(rotation) = &frame.rotation {
        let still = frame.for_spheres(&rotation.angular_velocity, [0.0; 3]);
        file.reals("angular_velocity", still);
        let unturned = frame.for_spheres(&rotation.orientation, [1.0, 0.0, 0.0, 0.0]);
        file.reals("orientation", unturned);
    }
    file.close("PointData");
    file.open("Points");
    file.reals("Points", frame.position.iter().copied());
    file.close("Points");
    file.open("Verts");
    file.whole("connectivity", 0..number);
    file.whole("offsets", 1..=number);
    file.close("Verts");
    file.finish()
}

/// The contacts of a frame.
pub(super) fn contacts(frame: &Frame) -> Vec<u8> {
    let contacts = &frame.contacts;
    let number = contacts.len();
    let mut file = Polydata::new(frame);
    file.begin_piece([("Points", 2 * number), ("Verts", 0), ("Lines", number)]);
    file.open("CellData Scalars=\"normal_force\"");
    let mut reals = |name, value: fn(&FrameContact) -> f64| {
        file.reals(name, contacts.iter().map(|contact| [value(contact)]));
    };
    reals("normal_force", |it| it.normal_force);
    reals("tangential_force", |it| it.tangential_force);
    reals("overlap", |it| it.overlap);
    file.whole("first", contacts.iter().map(|it| it.spheres[0]));
    // A smooth wall is no sphere of the frame.
    let second = contacts.iter().map(|it| match it.spheres[1] {
        sphere if sphere < frame.spheres() => sphere as i32,
        _ => -1_i32,
    });
    let second = second.flat_map(i32::to_le_bytes).collect();
    file.array("Int32", "second", 1, second);
    let sliding = contacts.iter().map(|it| u8::from(it.sliding));
    file.array("UInt8", "sliding", 1, sliding.collect());
    file.close("CellData");
    file.open("Points");
    let ends = contacts.iter().flat_map(|contact| {
        let [x, y, z] = frame.position[contact.spheres[0]];
        let [dx, dy, dz] = contact.separation;
        [[x, y, z], [x - dx, y - dy, z - dz]]
    });
    file.reals("Points", ends);
    file.close("Points");
    file.open("Lines");
    file.whole("connectivity", 0..2 * number);
    file.whole("offsets", (1..=number).map(|line| 2 * line));
    file.close("Lines");
    file.finish()
}

/// A file of polydata: the arrays in binary after the text that describes them.
struct Polydata {
    text: String,
    binary: Vec<u8>,
}

impl Polydata {
    /// Begins with the values of the instant.
    fn new(frame: &Frame) -> Self {
        let mut file = Self {
            text: String::from(
                "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" \
                 header_type=\"UInt64\">\n",
            ),
            binary: Vec::new(),
        };
        file.open("PolyData");
        file.open("FieldData");
        let mut field = |name: &str, kind: &str, bytes: [u8; 8]| {
            file.describe(kind, name, "NumberOfTuples=\"1\"", &bytes);
        };
        field("TimeValue", "Float64", frame.time.to_le_bytes());
        field("step", "UInt64", frame.step.to_le_bytes());
        for (name, value) in &frame.values {
            field(name, "Float64", value.to_le_bytes());
        }
        file.close("FieldData");
        file
    }

    fn begin_piece(&mut self, numbers: [(&str, usize); 3]) {
        let numbers = numbers.map(|(name, number)| format!(" NumberOf{name}=\"{number}\""));
        self.open(&format!("Piece{}", numbers.concat()));
    }

    fn open(&mut self, element: &str) {
        self.text.push_str(&format!("<{element}>\n"));
    }

    fn close(&mut self, element: &str) {
        self.text.push_str(&format!("</{element}>\n"));
    }

    fn reals<const N: usize>(&mut self, name: &str, rows: impl Iterator<Item = [f64; N]>) {
        let bytes = rows.flatten().flat_map(f64::to_le_bytes).collect();
        self.array("Float64", name, N, bytes);
    }

    fn whole(&mut self, name: &str, values: impl Iterator<Item = usize>) {
        let bytes = values.flat_map(|value| (value as i32).to_le_bytes());
        self.array("Int32", name, 1, bytes.collect());
    }

    fn array(&mut self, kind: &str, name: &str, components: usize, bytes: Vec<u8>) {
        let extent = format!("NumberOfComponents=\"{components}\"");
        self.describe(kind, name, &extent, &bytes);
    }

    /// Binary arrays stand one after another, each behind its length.
    fn describe(&mut self, kind: &str, name: &str, extent: &str, bytes: &[u8]) {
        self.text.push_str(&format!(
            "<DataArray type=\"{kind}\" Name=\"{name}\" {extent} format=\"appended\" offset=\"{}\"/>\n",
            self.binary.len()
        ));
        self.binary.extend((bytes.len() as u64).to_le_bytes());
        self.binary.extend_from_slice(bytes);
    }

    fn finish(mut self) -> Vec<u8> {
        self.close("Piece");
        self.close("PolyData");
        self.open("AppendedData encoding=\"raw\"");
        let mut bytes = self.text.into_bytes();
        bytes.push(b'_');
        bytes.append(&mut self.binary);
        bytes.extend_from_slice(b"\n</AppendedData>\n</VTKFile>\n");
        bytes
    }
}
