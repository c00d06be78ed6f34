//! S6: unjammed flow of frictional grains in the elastic tube beside that of frictionless grains in the prescribed one.

use peristalsis_analysis::Uncertain;
use peristalsis_figures::chart::{
    Band, ChartFigure, ChartPanel, LegendPlace, Line as Curve, Reference,
};
use peristalsis_figures::{Quantity as Axis, Scale, Width};
use std::ops::Range;

use super::elastic::{finding, is_frictionless, judged, label, nothing, rate_text};
use crate::branches::mean_and_error;
use crate::claim::Claim;
use crate::error::ClaimError;
use crate::evidence::{Evidence, StudyResults};
use crate::finding::{Finding, Quantity, ReportFigure, ReportTable, Verdict};
use crate::forces::{CLEAR, ForceLine, MOST_ESCAPED, together};
use crate::prose::Prose;
use crate::runs::{Run, Start};
use crate::text::{estimate, number};

const PROSE: Prose = Prose::new(include_str!("s6.md"));

pub(super) const CLAIM: Claim = Claim {
    id: "S6",
    prose: PROSE,
    studies: &["elastic-flow", "elastic-branches", "unjammed-frictionless"],
    examine,
};

/// J/Jmax below which a flow is unjammed.
const UNJAMMED: f64 = 0.2;
/// Differences of velocities, in parts of c, and of densities, in parts of the mean, count from here on.
const LEAST_DIFFERENCE: f64 = 0.05;
/// Temperatures differ from this ratio on.
const LEAST_RATIO: f64 = 2.0;

/// Name and symbol of a number, and its value in a run.
type Number = (&'static str, &'static str, fn(&Run) -> f64);

/// The numbers that are compared, each of one run, free of units.
const NUMBERS: [Number; 6] = [
    (
        "grains per length in the throat over those in the belly",
        "*n*_{1,throat}/*n*_{1,belly}",
        |run| column(run, "throat_density") / column(run, "belly_density"),
    ),
    ("axial velocity in the throat", "*v*_{throat}/*c*", |run| {
        column(run, "throat_axial_velocity") / speed(run)
    }),
    ("axial velocity in the belly", "*v*_{belly}/*c*", |run| {
        column(run, "belly_axial_velocity") / speed(run)
    }),
    (
        "temperature in the throat",
        "*T*_{throat}/*mc*^{2}",
        |run| column(run, "throat_granular_temperature") / speed(run).powi(2),
    ),
    ("temperature in the belly", "*T*_{belly}/*mc*^{2}", |run| {
        column(run, "belly_granular_temperature") / speed(run).powi(2)
    }),
    ("flow rate", "*J*/*J*_{max}", |run| run.flow_rate_ratio),
];
/// Those that decide by their difference whether two flows differ, density and velocities, and by their ratio, temperatures.
const BY_DIFFERENCE: Range<usize> = 0..3;
const BY_RATIO: Range<usize> = 3..5;

/// In what two flows differ.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Outcome {
    /// In density or velocity.
    Differ,
    /// In temperature only.
    DifferInTemperature,
    /// In none of them.
    Agree,
    /// The errors do not allow to say, or are not known.
    Unknown,
}

fn column(run: &Run, name: &str) -> f64 {
    run.axis(name).unwrap_or(f64::NAN)
}

/// c.
fn speed(run: &Run) -> f64 {
    run.strain_rate * run.wavelength
}

/// One flow: the runs of one point.
struct Flow<'a> {
    name: String,
    runs: Vec<&'a Run>,
}

impl<'a> Flow<'a> {
    /// The flow of some runs as far as they are unjammed, stationary and hold their grains; `None` without one.
    fn of(name: String, runs: impl Iterator<Item = &'a Run>) -> Option<Self> {
        let runs: Vec<&Run> = runs
            .filter(|run| run.is_stationary() && run.flow_rate_ratio < UNJAMMED)
            .filter(|run| run.escaped_fraction() <= MOST_ESCAPED)
            .filter(|run| column(run, "throat_density").is_finite())
            .collect();
        (!runs.is_empty()).then_some(Self { name, runs })
    }

    /// Mean of a number over the runs with its error; without an error from a single run.
    fn mean(&self, value: fn(&Run) -> f64) -> Uncertain {
        let values: Vec<f64> = self.runs.iter().map(|run| value(run)).collect();
        let (mean, error) = mean_and_error(&values);
        Uncertain::normal(mean, error)
    }

    /// In what it differs from another flow.
    fn beside(&self, other: &Self) -> Outcome {
        let mut known = true;
        let mut any = |numbers: Range<usize>, scale: fn(f64) -> f64, least: f64| {
            NUMBERS[numbers].iter().any(|(_, _, value)| {
                let (one, two) = (self.mean(*value), other.mean(*value));
                let difference = (scale(one.value) - scale(two.value)).abs();
                // To first order, so that that of a logarithm is the relative one.
                let scaled =
                    |mean: &Uncertain| (scale(mean.value + mean.error) - scale(mean.value)).abs();
                let error = scaled(&one).hypot(scaled(&two));
                known &= error.is_finite() && error < least;
                error.is_finite() && difference > least.max(CLEAR * error)
            })
        };
        if any(BY_DIFFERENCE, |value| value, LEAST_DIFFERENCE) {
            Outcome::Differ
        } else if any(BY_RATIO, f64::ln, LEAST_RATIO.ln()) {
            Outcome::DifferInTemperature
        } else if known {
            Outcome::Agree
        } else {
            Outcome::Unknown
        }
    }
}

fn examine(evidence: &Evidence) -> Result<Finding, ClaimError> {
    let branches = &evidence.study("elastic-branches")?.runs;
    let lines = ForceLine::all_of(branches);
    let mut frictional: Vec<Flow<'_>> = lines
        .iter()
        .flat_map(|line| {
            let forces = line.rest.points.iter().map(|point| point.force);
            forces.map(|force| (line.strain_rate, force))
        })
        .filter_map(|(rate, force)| {
            let here = branches.iter().filter(move |run| {
                run.strain_rate == rate && run.force() == force && run.start == Start::Rest
            });
            Flow::of(frictional_name(rate, force), here)
        })
        .collect();
    // The flows of the pictures began jammed; where both starts are there they count once.
    let pictures = &evidence.study("elastic-flow")?.runs;
    for run in pictures {
        let name = frictional_name(run.strain_rate, run.force());
        if frictional.iter().all(|flow| flow.name != name) {
            let here = pictures
                .iter()
                .filter(|other| other.force() == run.force() && !is_frictionless(other));
            frictional.extend(Flow::of(name, here));
        }
    }
    let reference = &evidence.study("unjammed-frictionless")?.runs;
    let frictionless: Vec<Flow<'_>> = crate::critical::strain_rates(reference.iter())
        .into_iter()
        .filter_map(|rate| {
            let here: Vec<&Run> = reference
                .iter()
                .filter(|run| run.strain_rate == rate)
                .collect();
            Flow::of(
                format!(
                    "frictionless, prescribed wall, *w* = {} *d*, *ε̇* = {}",
                    here[0].width,
                    rate_text(rate)
                ),
                here.into_iter(),
            )
        })
        .collect();
    if frictional.is_empty() || frictionless.is_empty() {
        return Ok(nothing("No unjammed flow of both models yet."));
    }
    let pairs: Vec<(&Flow<'_>, &Flow<'_>, Outcome)> = frictional
        .iter()
        .flat_map(|one| {
            frictionless
                .iter()
                .map(move |other| (one, other, one.beside(other)))
        })
        .collect();
    let number_of = |outcome| pairs.iter().filter(|pair| pair.2 == outcome).count();
    let (differ, warmer) = (
        number_of(Outcome::Differ),
        number_of(Outcome::DifferInTemperature),
    );
    let verdict = if differ + warmer == pairs.len() {
        Verdict::Reproduced
    } else if number_of(Outcome::Agree) == pairs.len() {
        Verdict::Differs
    } else {
        Verdict::Open
    };
    let mut found = finding(
        verdict,
        format!(
            "Density or velocity in throat or belly differ in {differ} of {} pairs of an unjammed flow of either model, temperature \
             only in {warmer}; {} agree.",
            pairs.len(),
            number_of(Outcome::Agree),
        ),
        together(judged(&lines).into_iter()),
    );
    for (one, other, outcome) in &pairs {
        let alike = match outcome {
            Outcome::DifferInTemperature => "differ in temperature only",
            Outcome::Agree => "agree",
            Outcome::Differ | Outcome::Unknown => continue,
        };
        found
            .weaknesses
            .push(format!("These two {alike}: {}; {}.", one.name, other.name));
    }
    // At the smallest force of the source's rate where there is one, else at the first.
    let shown = frictional
        .iter()
        .find(|flow| flow.runs[0].strain_rate == super::elastic::SOURCE_RATE)
        .unwrap_or(&frictional[0]);
    for flow in [shown].into_iter().chain(&frictionless) {
        for (name, symbol, value) in &NUMBERS[..5] {
            found.quantities.push(Quantity {
                name: format!("{name}, {}", flow.name),
                symbol: (*symbol).to_owned(),
                unit: String::new(),
                source: None,
                ours: Some(flow.mean(*value)),
                method: format!("mean over {} runs", flow.runs.len()),
            });
        }
    }
    found
        .tables
        .push(table(frictional.iter().chain(&frictionless)));
    found.paragraphs.push(
        "The tubes are alike in λ/*a* (5.7 and 6.7), in the volume fraction of the grains (0.27, those of the elastic tube weighed with \
         their diameters) and, at the smaller strain rate of the prescribed wall, in the speed of the wave over that of sound in the \
         grains, *c*(*m*/*k*)^{1/2}/*d* ≈ 0.2, with *k* the stiffness of a Hertz contact of overlap 0.1 *d*; the larger one is the \
         source's. Lengths are over the wavelength, densities over their mean, velocities over *c*, temperatures over *mc*^{2} (*m* that \
         of the largest grain). The prescribed tube is as wide as it must be for unjammed flow. Throat and belly are the fifths of the \
         wavelength about the narrowest and the widest place. The density is that along the tube, *n*_{1}, grains per length: in a \
         steady state *n*_{1}(*c* − *v*) is the same everywhere, so that it follows from the velocities."
            .to_owned(),
    );
    found.paragraphs.push(format!(
        "Two flows differ where densities (in parts of the mean) or velocities (in parts of *c*) are apart by more than \
         {LEAST_DIFFERENCE}, or temperatures by more than a factor {LEAST_RATIO}, and by more than {CLEAR} errors."
    ));
    found.weaknesses.push(
        "An elastic wall takes the amplitude that force and grains give it: the amplitudes of the two tubes cannot be matched as long as \
         both flows are to be unjammed."
            .to_owned(),
    );
    found.figures.extend(profiles(
        evidence.study("elastic-flow")?,
        evidence.study("unjammed-frictionless")?,
    )?);
    Ok(found)
}

/// What a flow of frictional grains is called.
fn frictional_name(rate: f64, force: f64) -> String {
    format!("frictional, *f*^{{P}} = {force}, *ε̇* = {}", rate_text(rate))
}

fn table<'a>(flows: impl Iterator<Item = &'a Flow<'a>>) -> ReportTable {
    let head = ["flow", "runs"]
        .into_iter()
        .chain(NUMBERS.iter().map(|(_, symbol, _)| *symbol))
        .map(str::to_owned)
        .collect();
    let rows = flows
        .map(|flow| {
            let mut row = vec![flow.name.clone(), flow.runs.len().to_string()];
            row.extend(NUMBERS.iter().map(|(_, _, value)| {
                let mean = flow.mean(*value);
                if mean.error.is_finite() {
                    estimate(&mean)
                } else {
                    number(mean.value, 4)
                }
            }));
            row
        })
        .collect();
    ReportTable {
        caption:
            "Unjammed flow (late *J*/*J*_{max} below 0.2) in the throat and in the belly, from rest where there are such runs."
                .to_owned(),
        head,
        rows,
    }
}

/// A profile about the throat: place, density over its mean, v/c, T/(m c^2), each with its error.
struct Curves {
    name: String,
    place: Vec<f64>,
    values: [Vec<f64>; 3],
    errors: [Vec<f64>; 3],
}

impl Curves {
    /// The profile of one run, the throat in the middle.
    fn of(name: String, study: &StudyResults, run: &Run) -> Result<Option<Self>, ClaimError> {
        let Some(table) = study.profile(run)? else {
            return Ok(None);
        };
        let radius = table.reals("radius")?;
        let bins = radius.len();
        let throat = (0..bins)
            .min_by(|&one, &other| radius[one].total_cmp(&radius[other]))
            .unwrap_or(0);
        let speed = speed(run);
        let density = table.reals("density")?;
        let mean = density.iter().sum::<f64>() / bins.max(1) as f64;
        let names = ["density", "axial_velocity", "granular_temperature"];
        let units = [mean, speed, speed * speed];
        let order = |k: usize| (throat + k + bins - bins / 2) % bins;
        let column = |name: &str, unit: f64| -> Result<Vec<f64>, ClaimError> {
            let values = table.reals(name)?;
            Ok((0..bins).map(|k| values[order(k)] / unit).collect())
        };
        let mut values: [Vec<f64>; 3] = Default::default();
        let mut errors: [Vec<f64>; 3] = Default::default();
        for (place, (name, unit)) in names.into_iter().zip(units).enumerate() {
            values[place] = column(name, unit)?;
            errors[place] = column(&format!("{name}_error"), unit)?;
        }
        Ok(Some(Self {
            name,
            place: (0..bins)
                .map(|k| (k as f64 - (bins / 2) as f64) / bins as f64)
                .collect(),
            values,
            errors,
        }))
    }
}

/// Profiles of one run of each flow.
fn profiles(
    elastic: &StudyResults,
    prescribed: &StudyResults,
) -> Result<Option<ReportFigure>, ClaimError> {
    let mut curves = Vec::new();
    let unjammed = |run: &&Run| run.flow_rate_ratio < UNJAMMED && !is_frictionless(run);
    let smallest = elastic
        .runs
        .iter()
        .filter(unjammed)
        .min_by(|one, other| one.force().total_cmp(&other.force()));
    if let Some(run) = smallest {
        let name = format!("frictional, *f*^{{P}} = {}", run.force());
        curves.extend(Curves::of(name, elastic, run)?);
    }
    if let Some(run) = elastic.runs.iter().find(|run| is_frictionless(run)) {
        let name = format!("frictionless, *f*^{{P}} = {}", run.force());
        curves.extend(Curves::of(name, elastic, run)?);
    }
    for rate in crate::critical::strain_rates(prescribed.runs.iter()) {
        let run = prescribed
            .runs
            .iter()
            .find(|run| run.strain_rate == rate && run.flow_rate_ratio < UNJAMMED);
        if let Some(run) = run {
            let name = format!("prescribed wall, *ε̇* = {}", rate_text(rate));
            curves.extend(Curves::of(name, prescribed, run)?);
        }
    }
    if curves.is_empty() {
        return Ok(None);
    }
    let labels = [
        "grains per length, *n*_{1}*L*/*N*".to_owned(),
        label(Axis::AxialVelocity),
        "temperature, *T*_{g}/*mc*^{2}".to_owned(),
    ];
    let panels = labels.iter().enumerate().map(|(quantity, y_label)| {
        let mut panel =
            ChartPanel::new("distance from the throat, *ζ*/*λ*", y_label).x_range(-0.5..=0.5);
        match quantity {
            1 => panel = panel.with(Reference::horizontal(0.0)),
            2 => panel = panel.y_scale(Scale::Logarithmic),
            _ => {}
        }
        for (series, curve) in curves.iter().enumerate() {
            let (value, error) = (&curve.values[quantity], &curve.errors[quantity]);
            let bound = |sign: f64| -> Vec<f64> {
                value
                    .iter()
                    .zip(error)
                    .map(|(value, error)| value + sign * error)
                    .collect()
            };
            panel = panel
                .with(Band::new("", &curve.place, &bound(-1.0), &bound(1.0)).series(series))
                .with(Curve::new(&curve.name, &curve.place, value).series(series));
        }
        panel
    });
    Ok(Some(ReportFigure {
        name: "profiles".to_owned(),
        caption: "Profiles in the wave frame about the throat, the wave running to the right: density over its mean, axial velocity in \
                  the laboratory over the wave's speed, granular temperature; one run each, bands are standard errors. Frictional and \
                  frictionless grains in the elastic tube, and the unjammed flow of frictionless grains between prescribed walls."
            .to_owned(),
        drawing: ChartFigure::grid(3, panels)
            .legend(LegendPlace::Below)
            .width(Width::DoubleColumn)
            .description("Density, velocity and temperature along the wave for frictional and frictionless grains.")
            .draw()?,
    }))
}
