//! The design of a pump: its dimensionless groups, where it lies among the published runs, what to expect of it.
//!
//! The file of a design says grain, tube and drive in SI ([`configuration_text`]). Of its configuration [`Design::of`] has the
//! [groups](groups()), compares them with those of the published runs ([`published`]), and weighs the flows of the nearest
//! ([`expectation`]). How good such an expectation is, a test says: each published tube, left out, against the others.

mod document;
mod groups;
mod page;
mod published;

use peristalsis_configuration::{Configuration, Control, HOUR, WaveformName};
use peristalsis_run::Estimate;
use serde::Serialize;

pub use document::{configuration_text, is_design, schema};
pub use groups::{ALL, GROUPS, Group, groups};
pub use page::page;
pub use published::{AT_THE_EDGE, Expectation, Point, WITHIN, expectation, published, rounded};

use crate::Start;
use crate::row::extremes;
use crate::thresholds::{FAST, SLOW, SPLIT, UNJAMMED};

/// Grains smaller than this \[m\] cohere and feel the air: Geldart's groups A and C (Powder Technol. 7, 285 (1973)).
const SMALLEST_GRAIN: f64 = 1e-4;

/// What it means that a group is near the published range.
pub const NEAR: &str = "near: outside the range, but by less than the difference up to which two tubes count as alike; \
                        treated as inside";
/// What distances from published points mean.
pub const DISTANCES: &str =
    "0 is the same tube, 1 just alike; beyond 1 errors grow, beyond 2 nothing is said";

/// A group of a design beside those of the published runs.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Compared {
    /// Its name.
    pub name: &'static str,
    /// What it is.
    pub meaning: &'static str,
    /// Its value.
    pub value: f64,
    /// The least and the largest of the published runs.
    pub published: [f64; 2],
    /// How far it is from that range, in the distance that counts as 1; 0 within.
    pub distance: f64,
}

impl Compared {
    /// Whether the value is within the published range, or next to it.
    pub fn is_inside(&self) -> bool {
        self.distance <= WITHIN
    }

    /// Where the value lies, in a word: none within the published range; `near` where it is beyond it by less than tubes
    /// that count as alike differ.
    pub fn place(&self) -> &'static str {
        match self.distance {
            0.0 => "",
            _ if self.is_inside() => "near",
            _ => "outside",
        }
    }
}

/// The flow to expect of a start.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ExpectedFlow {
    /// "rest" or "jammed".
    pub start: &'static str,
    /// J/Jmax.
    #[serde(flatten)]
    pub expectation: Expectation,
    /// The mass flow that it is \[kg/h\], where the units are known.
    pub mass_flow_rate_kg_per_h: Option<f64>,
    /// Its standard error \[kg/h\].
    pub mass_flow_rate_error_kg_per_h: Option<f64>,
}

/// What is known of a design before it is computed.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Design {
    /// The groups, in the order of [`ALL`].
    pub groups: Vec<Compared>,
    /// The kind of flow, in words.
    pub regime: String,
    /// What to expect from rest and of a jam; neither where the design lies outside the data.
    pub expected: Vec<ExpectedFlow>,
    /// What lies outside the published runs, in words.
    pub outside: Vec<String>,
    /// What a rough wall does, where the tube has one and stands for a real hose.
    pub wall: Option<&'static str>,
    /// What goes through a section if all grains go with the wave \[kg/h\].
    pub largest_mass_flow_rate_kg_per_h: Option<f64>,
    /// What would run, and what it costs.
    pub estimate: Estimate,
}

/// What is to be known of a wall of spheres.
const ROUGH: &str = "its spheres hold grains back, which a smooth hose does not: in bores of two and four grains a smooth wall carried \
                     2.7 times as much; compute the tube with tube.arrangement = \"smooth\" too";

impl Design {
    /// Whether a configuration is a design: its wall is prescribed and its wave moves.
    pub fn serves(configuration: &Configuration) -> bool {
        groups(configuration).is_some()
    }

    /// The design that a configuration is; `None` where it is none.
    pub fn of(configuration: &Configuration, estimate: Estimate) -> Option<Self> {
        let values = groups(configuration)?;
        let points = published();
        let compared: Vec<Compared> = ALL
            .iter()
            .enumerate()
            .map(|(place, group)| compare(group, values[place], points, place))
            .collect();
        let si = estimate.si.as_ref();
        let largest = si.map(|si| si.largest_mass_flow_rate_kg_per_s * HOUR);
        let mut outside = outside(configuration, &compared);
        let starts = Start::ALL.into_iter().filter(|_| outside.is_empty());
        let expected = starts.filter_map(|start| {
            let expectation = expectation(points, &values, start)?;
            let rate = |ratio: f64| largest.map(|largest| ratio * largest);
            Some(ExpectedFlow {
                start: start.name(),
                mass_flow_rate_kg_per_h: rate(expectation.flow_rate_ratio),
                mass_flow_rate_error_kg_per_h: rate(expectation.error),
                expectation,
            })
        });
        let expected: Vec<ExpectedFlow> = expected.collect();
        if outside.is_empty() && expected.is_empty() {
            outside.push("each group is within the published range or near it, but no published tube has all of them like this one".to_owned());
        }
        Some(Self {
            regime: regime(configuration, &expected),
            wall: (si.is_some() && configuration.tube.arrangement.has_spheres()).then_some(ROUGH),
            outside,
            groups: compared,
            expected,
            largest_mass_flow_rate_kg_per_h: largest,
            estimate,
        })
    }
}

fn compare(group: &Group, value: f64, points: &[Point], place: usize) -> Compared {
    let published = extremes(points.iter().map(|point| point.groups[place]));
    Compared {
        name: group.name,
        meaning: group.meaning,
        value,
        published,
        distance: group.distance(value, value.clamp(published[0], published[1])),
    }
}

/// The kind of flow, from the throat alone where no grain passes it, otherwise from the published runs.
fn regime(configuration: &Configuration, expected: &[ExpectedFlow]) -> String {
    let Control::Strain { width } = configuration.drive.control else {
        return String::new();
    };
    if configuration.drive.waveform == WaveformName::Segments {
        return "segments that close in turn: what they carry depends on their order, and on how long each stays closed; \
                compute it"
            .to_owned();
    }
    let throat = width - configuration.wall.sphere_diameter;
    if throat <= 0.0 {
        return "closed: a positive displacement pump, which carries what is between two throats; the flow is that of all \
                grains with the wave, less what is squeezed back"
            .to_owned();
    }
    if throat < configuration.grains.diameter_min {
        return "no grain passes the throat: what is between two throats is carried with the wave, but for grains that slip back \
                between the spheres of a rough wall"
            .to_owned();
    }
    let flows: Vec<&Expectation> = expected.iter().map(|it| &it.expectation).collect();
    let Some(first) = flows.first() else {
        return "not known: no published run is like it; compute it".to_owned();
    };
    let last = flows[flows.len() - 1];
    let differ = (last.flow_rate_ratio - first.flow_rate_ratio).abs();
    if differ > SPLIT && differ > first.error.hypot(last.error) {
        return "two kinds of flow, and which of them depends on how it begins: slow from rest, fast once jammed (hysteresis)"
            .to_owned();
    }
    if first.range[1] - first.range[0] > FAST && first.error > SPLIT {
        return "near the transition: the nearest published tubes either slip or jam".to_owned();
    }
    let flow = match first.flow_rate_ratio {
        flow if flow > 1.0 - UNJAMMED => "jammed: the grains are locked to the wave",
        flow if flow < UNJAMMED => "unjammed: the wave slips past the grains",
        flow if flow < SLOW => "slow: most of the wave slips past the grains",
        _ => "jammed, with grains that slip back through the throat",
    };
    match expected {
        [only] if only.start == Start::Jammed.name() => {
            format!("{flow}, once they are jammed; of grains from rest no published run tells")
        }
        _ => flow.to_owned(),
    }
}

/// What lies outside the published runs.
fn outside(configuration: &Configuration, groups: &[Compared]) -> Vec<String> {
    let far = groups.iter().filter(|group| !group.is_inside());
    let mut outside: Vec<String> = far
        .map(|group| {
            let [least, most] = group.published.map(rounded);
            let value = rounded(group.value);
            format!("{}: {value}, published {least} to {most}", group.meaning)
        })
        .collect();
    outside.extend(groups::unlike(configuration).into_iter().map(str::to_owned));
    let size = configuration
        .units
        .map(|units| units.length() * configuration.grains.diameter_min);
    if let Some(size) = size.filter(|size| *size < SMALLEST_GRAIN) {
        outside.push(format!(
            "grains of {size:.1e} m: below {SMALLEST_GRAIN:e} m they cohere, which contact.cohesion_force or surface_energy computes, and feel the air, which nothing here does"
        ));
    }
    outside
}
