//! What is written around a picture.

use peristalsis_analysis::number::decimal;
use peristalsis_figures::{PlaceMark, ScaleBar, Units};
use peristalsis_formats::Frame;

use super::{Aspect, MARGIN, PictureScene, Place};

/// Wavelengths that the wave has run.
pub(super) fn cycles(frame: &Frame) -> f64 {
    frame.value("period").unwrap_or(0.0)
}

/// An instant in markup: in periods of the drive, or in units of time where the wave stands still.
pub(crate) fn instant(time: f64, period: Option<f64>, units: Units) -> String {
    match period {
        Some(period) => format!("*t*/*T* = {:.2}", time / period),
        None => format!("*t* = {time:.1} {}", units.time()),
    }
}

/// Lengths that a scale shows \[d\]: the largest that is a modest part of the picture.
const SCALES: [f64; 9] = [0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0];
/// Largest part of the picture that a scale takes.
const SCALE_PART: f64 = 0.26;

/// What is written around the picture of an instant.
pub(super) struct Caption {
    pub(super) title: String,
    pub(super) notes: Vec<String>,
    /// `None` where no picture of the run has any.
    pub(super) marks: Option<Vec<PlaceMark>>,
    pub(super) scale_bar: ScaleBar,
}

impl Caption {
    pub(super) fn of(scene: &PictureScene, frame: &Frame) -> Self {
        let moves_ever = scene.period.is_some();
        let is_moving = scene.wall.frequency(frame.time) != 0.0;
        let (place, across) = match scene.look.aspect {
            Aspect::Side => {
                let words = match (moves_ever, is_moving) {
                    (false, _) => "",
                    (true, false) => "wave stands",
                    (true, true) => "wave →",
                };
                (words.to_owned(), scene.shown + 2.0 * MARGIN)
            }
            Aspect::Section(place) => {
                let words = match place {
                    Place::At(z) => format!("*z* = {z:.1} *d*"),
                    Place::Position(position) => format!("(*z* \u{2212} *ct*)/*λ* = {position:.2}"),
                };
                (words, 2.0 * (scene.radius + MARGIN))
            }
        };
        // Gravity across the tube points down in every picture, and the wave runs to the right in one from the side.
        let across_tube = scene.down.map(|_| "*g* ↓".to_owned());
        let along_tube = match (scene.look.aspect, scene.along) {
            (Aspect::Side, along) if along > 0.0 => Some("*g* →".to_owned()),
            (Aspect::Side, along) if along < 0.0 => Some("*g* ←".to_owned()),
            _ => None,
        };
        let words = [place].into_iter().chain(across_tube).chain(along_tube);
        let words: Vec<String> = words.filter(|words| !words.is_empty()).collect();
        let place = words.join(",   ");
        let instant = instant(frame.time, scene.period, scene.units);
        let mut notes = vec![instant, place];
        // All frames of a film have one layout, also where the wave pauses.
        if moves_ever {
            let flow = match frame.value("flow_rate_ratio") {
                Some(ratio) if ratio.is_finite() => format!(" = {}", decimal(ratio, 2)),
                _ if frame.grains == 0 => ": no grains".to_owned(),
                _ if !is_moving => ": none".to_owned(),
                _ => ": not yet".to_owned(),
            };
            notes.push(format!("*J*/*J*_{{max}}{flow}"));
        }
        let has_marks = moves_ever && scene.look.aspect == Aspect::Side;
        let marks = has_marks.then(|| self::marks(scene, frame));
        let lengths = SCALES.into_iter().filter(|it| *it <= SCALE_PART * across);
        let length = lengths.fold(SCALES[0], f64::max);
        Self {
            title: format!(
                "The tube at {}, {:.0} d long, {} grains",
                notes[0].replace('*', ""),
                scene.wall.length(),
                frame.grains
            ),
            notes,
            marks,
            scale_bar: ScaleBar {
                length: length / across,
                label: format!("{length} *d*"),
            },
        }
    }
}

/// Bellies and throats of the wave from the left.
fn marks(scene: &PictureScene, frame: &Frame) -> Vec<PlaceMark> {
    let wavelength = scene.wall.wavelength();
    let heading = scene.wall.heading();
    let mut marks = Vec::new();
    let places = [
        (scene.wall.throat(), "throat"),
        (scene.wall.belly(), "belly"),
    ];
    for (position, label) in places {
        // z of the picture, along the wave, is lambda (position + cycles) + a whole number of lambda - shift.
        let along = wavelength * (position + cycles(frame)) - heading * scene.shift(cycles(frame));
        let from_left = along + if heading < 0.0 { scene.shown } else { 0.0 };
        let mut along = from_left.rem_euclid(wavelength);
        while along <= scene.shown {
            let place = (along + MARGIN) / (scene.shown + 2.0 * MARGIN);
            marks.push(PlaceMark { place, label });
            along += wavelength;
        }
    }
    marks.sort_by(|one, other| one.place.total_cmp(&other.place));
    marks
}
