//! What is written around a picture.

use peristalsis_configuration::{Configuration, NormalLaw};
use peristalsis_figures::{PlaceMark, ScaleBar};
use peristalsis_formats::Frame;

use super::{Aspect, Place, Portrait};

/// Unit of time in markup.
pub(crate) fn time_unit(configuration: &Configuration) -> &'static str {
    match configuration.contact.normal {
        NormalLaw::Linear { .. } => "(*m*/*k*)^{1/2}",
        NormalLaw::Hertz { .. } => "*t*^{\\*}",
    }
}

/// What makes a number of a pressure, in markup.
pub(crate) fn pressure_unit(configuration: &Configuration) -> &'static str {
    match configuration.contact.normal {
        NormalLaw::Linear { .. } => " *d*/*k*",
        NormalLaw::Hertz { .. } => "/*Y*",
    }
}

/// Wavelengths that the wave has run.
pub(super) fn cycles(frame: &Frame) -> f64 {
    frame.value("period").unwrap_or(0.0)
}

/// Lengths that a scale shows \[d\]: the largest that is a modest part of the picture.
const SCALES: [f64; 9] = [0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0];
/// Largest part of the picture that a scale takes.
const SCALE_PART: f64 = 0.26;

/// The words around the picture of an instant.
pub(super) struct Words {
    pub(super) title: String,
    notes: Vec<String>,
    marks: Vec<(f64, &'static str)>,
    scale: (f64, String),
}

impl Words {
    pub(super) fn of(portrait: &Portrait, frame: &Frame) -> Self {
        let is_moving = portrait.wall.frequency(frame.time) != 0.0;
        let time = if is_moving {
            format!("*t*/*T* = {:.2}", cycles(frame))
        } else {
            format!("*t* = {:.1} {}", frame.time, portrait.time_unit)
        };
        let lattice = portrait.wall.lattice();
        let (place, across) = match portrait.look.aspect {
            Aspect::Side if is_moving => {
                ("wave →".to_owned(), portrait.shown + 2.0 * super::MARGIN)
            }
            Aspect::Side => (String::new(), portrait.shown + 2.0 * super::MARGIN),
            Aspect::Section(place) => {
                let words = match place {
                    Place::At(z) => format!("*z* = {z:.1} *d*"),
                    Place::Phase(phase) => format!("phase {phase:.2}"),
                };
                (words, 2.0 * (portrait.radius + super::MARGIN))
            }
        };
        let flow = match frame.value("flow_rate_ratio") {
            Some(ratio) if ratio.is_finite() => format!("*J*/*J*_{{max}} = {}", signed(ratio)),
            _ => "*J*/*J*_{max}: not yet".to_owned(),
        };
        let notes = if is_moving {
            vec![time, place, flow]
        } else {
            vec![time, place]
        };
        let length = SCALES
            .into_iter()
            .filter(|length| *length <= SCALE_PART * across)
            .fold(SCALES[0], f64::max);
        Self {
            title: format!(
                "The tube after {:.2} periods, {:.0} d long, {} grains",
                cycles(frame),
                lattice.length(),
                frame.grains
            ),
            notes,
            marks: if is_moving {
                marks(portrait, frame)
            } else {
                Vec::new()
            },
            scale: (length / across, format!("{length} *d*")),
        }
    }

    pub(super) fn notes(&self) -> Vec<&str> {
        self.notes.iter().map(String::as_str).collect()
    }

    pub(super) fn marks(&self) -> Vec<PlaceMark<'_>> {
        let mark = |&(place, label): &(f64, &'static str)| PlaceMark { place, label };
        self.marks.iter().map(mark).collect()
    }

    pub(super) fn scale_bar(&self) -> ScaleBar<'_> {
        ScaleBar {
            length: self.scale.0,
            label: &self.scale.1,
        }
    }
}

/// A number with its sign where it is negative, in two decimals.
fn signed(value: f64) -> String {
    let text = format!("{:.2}", value.abs());
    let is_zero = text.bytes().all(|byte| matches!(byte, b'0' | b'.'));
    if value < 0.0 && !is_zero {
        format!("\u{2212}{text}")
    } else {
        text
    }
}

/// Crests and throats of the wave from the left, as parts of the picture's width.
fn marks(portrait: &Portrait, frame: &Frame) -> Vec<(f64, &'static str)> {
    if portrait.look.aspect != Aspect::Side {
        return Vec::new();
    }
    let wavelength = portrait.wall.lattice().wavelength;
    let heading = portrait.wall.heading();
    let throat = portrait.wall.throat();
    let across = portrait.shown + 2.0 * super::MARGIN;
    let mut marks = Vec::new();
    for (phase, label) in [(throat, "throat"), (throat + 0.5, "crest")] {
        // z of the picture, along the wave, is lambda (phase + cycles) + a whole number of lambda - shift.
        let along = wavelength * (phase + cycles(frame)) - heading * portrait.shift(cycles(frame));
        let from_left = along + if heading < 0.0 { portrait.shown } else { 0.0 };
        let mut place = from_left.rem_euclid(wavelength);
        while place <= portrait.shown {
            marks.push(((place + super::MARGIN) / across, label));
            place += wavelength;
        }
    }
    marks.sort_by(|one, other| one.0.total_cmp(&other.0));
    marks
}
