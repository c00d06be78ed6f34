//! The time and disk that a study would take.

use peristalsis_observe::{COLUMNS, PROFILE, Quantity, WAVES};
use peristalsis_run::{Warning, estimate_by, snapshot_numbers, warnings};

use crate::error::{Result, StudyError};
use crate::plan::Plan;
use crate::refinement::usual_added_points;
use crate::specification::Specification;

/// Points whose speed is measured; each takes about a second.
const TRIALS: usize = 3;
/// Bytes of a number in a Parquet file: mantissas do not compress.
const BYTES_A_NUMBER: f64 = 8.0;
/// Bytes of a run besides its tables, in blocks of the disk: configuration, row, summary, seal.
const BYTES_A_RUN: f64 = 36_000.0;

/// Seconds that a run takes besides its steps, about: its files are synchronised with the disk. Runs of next to no steps took
/// 0.01 s in memory and 0.07 s on the disk of a virtual machine.
pub const SECONDS_A_RUN: f64 = 0.05;

/// The estimate of a study.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct StudyEstimate {
    /// Points of the axes, states included.
    pub points: usize,
    /// Runs before refinement.
    pub runs: usize,
    /// Runs that refinement adds, if every change lies within one gap between points and runs differ throughout it.
    pub refinement_runs: usize,
    /// Steps of all runs before refinement, none of them ending early.
    pub steps: u64,
    /// Sum over these runs of grains times steps.
    pub grain_steps: f64,
    /// Seconds of one processor for these runs, from short trials on this machine and a usual time for the files of each.
    pub processor_seconds: f64,
    /// Bytes on disk of these runs when they are finished.
    pub bytes: f64,
    /// Warnings, with the number of points of each.
    pub warnings: Vec<StudyWarning>,
}

/// A warning of some points of a study.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct StudyWarning {
    /// Points that it is about.
    pub points: usize,
    /// The first of them, in words.
    pub first: String,
    /// The warning at the first of them.
    #[serde(flatten)]
    pub warning: Warning,
}

/// Grains times steps of a whole run, what its time is proportional to.
pub(crate) fn work(configuration: &peristalsis_run::Configuration) -> f64 {
    configuration.grains.number.max(1) as f64 * configuration.run.steps() as f64
}

/// The estimate of a study, with its speed measured by short trials of a few points.
///
/// # Errors
/// [`StudyError::Trial`] where grains do not fit.
pub fn study_estimate(study: &Specification, plan: &Plan) -> Result<StudyEstimate> {
    let points = plan.points();
    let mut trials: Vec<usize> = (0..TRIALS)
        .map(|trial| trial * (points.len() - 1) / (TRIALS - 1))
        .collect();
    trials.dedup();
    let (mut seconds, mut tried) = (0.0, 0.0);
    for trial in trials {
        let point = &points[trial];
        let configuration = &point.configuration;
        // More threads would take more of the processor than one.
        let estimate = estimate_by(1, configuration, None);
        let estimate = estimate.map_err(|source| StudyError::Trial {
            point: point.in_words(),
            source,
        })?;
        seconds += estimate.expected_seconds;
        tried += work(configuration);
    }
    let replicates = f64::from(study.replicates);
    let work_of_points = points.iter().map(|point| work(&point.configuration));
    let grain_steps = work_of_points.sum::<f64>() * replicates;
    let record = &study.record;
    let columns = record.columns.as_ref().map_or(COLUMNS.len(), Vec::len) as f64;
    let kept = |is_kept: bool, numbers: f64| if is_kept { numbers } else { 0.0 };
    let bytes: f64 = points
        .iter()
        .map(|point| {
            let configuration = &point.configuration;
            let observe = &configuration.observe;
            let samples = configuration.run.samples as f64;
            let bins = f64::from(observe.profile_bins);
            let periods = samples / f64::from(observe.samples_per_period);
            let waves = f64::from(configuration.tube.waves);
            let numbers = columns * samples
                + kept(record.profile, columns_of(PROFILE) * bins)
                + kept(record.waves, columns_of(WAVES) * periods * waves)
                + kept(record.snapshot, snapshot_numbers(configuration));
            BYTES_A_RUN + BYTES_A_NUMBER * numbers
        })
        .sum();
    let steps = points.iter().map(|point| point.configuration.run.steps());
    Ok(StudyEstimate {
        points: points.len(),
        runs: plan.runs().len(),
        refinement_runs: usual_added_points(study, plan) * study.replicates as usize,
        steps: steps.sum::<u64>() * u64::from(study.replicates),
        grain_steps,
        processor_seconds: seconds / tried * grain_steps + SECONDS_A_RUN * plan.runs().len() as f64,
        bytes: bytes * replicates,
        warnings: all_warnings(plan),
    })
}

/// Number of columns in which quantities and their errors stand.
fn columns_of<Of>(quantities: &[Quantity<Of>]) -> f64 {
    let measured = quantities.iter().filter(|quantity| quantity.is_measured());
    (quantities.len() + measured.count()) as f64
}

/// Warnings of all points, one of each kind.
fn all_warnings(plan: &Plan) -> Vec<StudyWarning> {
    let mut all: Vec<StudyWarning> = Vec::new();
    for point in plan.points() {
        for warning in warnings(&point.configuration) {
            let is_same = |other: &&mut StudyWarning| other.warning.key == warning.key;
            match all.iter_mut().find(is_same) {
                Some(other) => other.points += 1,
                None => all.push(StudyWarning {
                    points: 1,
                    first: point.in_words(),
                    warning,
                }),
            }
        }
    }
    all
}
