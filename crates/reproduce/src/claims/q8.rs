//! Q8: is the transition of slow waves continuous?

mod figures;
mod tables;

use peristalsis_analysis::{Uncertain, power_exponent};

use crate::claim::Claim;
use crate::error::ClaimError;
use crate::evidence::Evidence;
use crate::finding::{Finding, Quantity, Statistics, Verdict};
use crate::prose::Prose;
use crate::rows::{Mean, Row, behind, by, mean, mean_of};
use crate::runs::MOST_DRIFT;
use crate::text::{number, with_error};

const PROSE: Prose = Prose::new(include_str!("q8.md"));

pub(super) const CLAIM: Claim = Claim {
    id: "Q8",
    prose: PROSE,
    studies: &["small-speed-size", "sweep-up", "sweep-down"],
    examine,
};

/// For an answer: two strain rates, six forces in each of three lengths, two sweeps of each kind.
const NEEDED: Statistics = Statistics {
    strain_rates: 2,
    widths: 6,
    replicates: 1,
    runs: 36,
};
const LEAST_LENGTHS: usize = 3;

/// Rise between two neighbouring forces that counts, and in its errors.
const LEAST_RISE: f64 = 0.1;
const CLEAR: f64 = 4.0;
/// Threshold of J/Jmax at which a sweep passes from one flow to the other.
const PASSED: f64 = 0.5;

/// The stationary flow against the force in a tube of one length.
struct Ladder<'a> {
    rate: f64,
    waves: f64,
    points: Vec<Rung>,
    rows: Vec<Row<'a>>,
}

/// The stationary flow at one force.
#[derive(Clone, Copy)]
struct Rung {
    force: f64,
    flow: Mean,
    /// Variance of the period averages of J/Jmax times the waves: that of a wave if waves fluctuate by themselves. Of runs
    /// that no longer drift.
    fluctuation: Option<Mean>,
}

/// The steepest rise between two neighbouring forces.
struct Rise {
    force: f64,
    height: Uncertain,
}

impl<'a> Ladder<'a> {
    fn of((rate, waves): (f64, f64), rows: Vec<Row<'a>>) -> Self {
        let points = by(&rows, |row| row.number("force_amplitude"))
            .into_iter()
            .filter_map(|(force, rows)| {
                Some(Rung {
                    force,
                    flow: mean(&rows, "flow_rate_ratio")?,
                    fluctuation: mean_of(&rows, |row| {
                        let drift = row.number("flow_rate_ratio_drift");
                        if drift.abs() > MOST_DRIFT {
                            // What drifts does not fluctuate.
                            return (f64::NAN, f64::NAN);
                        }
                        let variance = row.number("flow_rate_ratio_variance");
                        // As of normal numbers, one for each late period.
                        let periods = row.number("periods") * LATE - 1.0;
                        let error = variance * (2.0 / periods).sqrt();
                        (waves * variance, waves * error)
                    }),
                })
            })
            .collect();
        Self {
            rate,
            waves,
            points,
            rows,
        }
    }

    fn rise(&self) -> Option<Rise> {
        self.points
            .windows(2)
            .map(|pair| {
                let error = pair[0]
                    .flow
                    .error
                    .max(0.0)
                    .hypot(pair[1].flow.error.max(0.0));
                let height = pair[1].flow.value - pair[0].flow.value;
                Rise {
                    force: 0.5 * (pair[0].force + pair[1].force),
                    height: Uncertain::normal(height, error),
                }
            })
            .max_by(|one, other| one.height.value.total_cmp(&other.height.value))
    }

    fn largest_fluctuation(&self) -> Option<(f64, Mean)> {
        self.points
            .iter()
            .filter_map(|one| Some((one.force, one.fluctuation?)))
            .max_by(|one, other| one.1.value.total_cmp(&other.1.value))
    }
}

/// Part of the runs, at their end, over which the study takes its means.
const LATE: f64 = 0.5;

/// The forces at which sweeps at one strain rate and of one length pass from one flow to the other.
struct Loop {
    rate: f64,
    /// Length of the sweep in periods.
    periods: f64,
    up: Option<Mean>,
    down: Option<Mean>,
    /// Sweeps up and down that ended before they passed.
    censored: [usize; 2],
}

impl Loop {
    /// Width of the loop; `None` where one way did not pass.
    fn width(&self) -> Option<Mean> {
        let (up, down) = (self.up?, self.down?);
        Some(Mean {
            value: up.value - down.value,
            error: up.error.max(0.0).hypot(down.error.max(0.0)),
            runs: up.runs.min(down.runs),
        })
    }
}

/// The force at which a sweep passed, and half of what it changes in the period over which the flow is averaged.
fn passed(row: &Row<'_>) -> (f64, f64) {
    let [from, to, end] =
        ["from", "to", "end"].map(|key| row.number(&format!("drive.schedule.{key}")));
    let progress = row.number("transition_time") * row.number("strain_rate") / end;
    (
        from + (to - from) * progress.clamp(0.0, 1.0),
        0.5 * (to - from).abs() / end,
    )
}

fn loops(up: &[Row<'_>], down: &[Row<'_>]) -> Vec<Loop> {
    let key = |row: &Row<'_>| (row.number("strain_rate"), row.number("drive.schedule.end"));
    let down = by(down, key);
    by(up, key)
        .into_iter()
        .filter_map(|(sweep, up)| {
            let down = &down.iter().find(|(other, _)| *other == sweep)?.1;
            let force = |rows: &[Row<'_>]| mean_of(rows, passed);
            let censored = |rows: &[Row<'_>]| rows.len() - force(rows).map_or(0, |mean| mean.runs);
            Some(Loop {
                rate: sweep.0,
                periods: sweep.1,
                up: force(&up),
                down: force(down),
                censored: [censored(&up), censored(down)],
            })
        })
        .collect()
}

/// Exponent of a positive quantity in another, from points with errors; `None` from fewer than three.
fn exponent(points: &[(f64, Mean)]) -> Option<Uncertain> {
    let known: Vec<&(f64, Mean)> = points
        .iter()
        .filter(|(_, mean)| mean.value > 0.0 && mean.error > 0.0)
        .collect();
    if known.len() < 3 {
        return None;
    }
    let column = |value: fn(&(f64, Mean)) -> f64| -> Vec<f64> {
        known.iter().map(|one| value(one)).collect()
    };
    let line = power_exponent(
        &column(|one| one.0),
        &column(|one| one.1.value),
        &column(|one| one.1.error),
    )
    .ok()?;
    Some(Uncertain::normal(
        line.slope.value,
        line.scale_factor() * line.slope.error,
    ))
}

fn examine(evidence: &Evidence) -> Result<Finding, ClaimError> {
    let size = evidence.study("small-speed-size")?.rows();
    let ladders: Vec<Ladder<'_>> = by(&size, |row| {
        (row.number("strain_rate"), row.number("waves"))
    })
    .into_iter()
    .map(|(key, rows)| Ladder::of(key, rows))
    .collect();
    let (up, down) = (
        evidence.study("sweep-up")?.rows(),
        evidence.study("sweep-down")?.rows(),
    );
    let loops = loops(&up, &down);
    let of_ladders = ladders.iter().map(|one| one.rate);
    let mut rates: Vec<f64> = of_ladders.chain(loops.iter().map(|one| one.rate)).collect();
    rates.sort_by(f64::total_cmp);
    rates.dedup();
    let statistics = Statistics {
        strain_rates: rates.len(),
        ..Statistics::weakest(
            ladders
                .iter()
                .map(|one| behind(&one.rows, |row| row.number("force_amplitude"))),
        )
    };
    if rates.is_empty() {
        return Ok(Finding::nothing("No runs yet.", statistics, &NEEDED));
    }
    let words: Vec<String> = rates
        .iter()
        .map(|rate| words(*rate, &ladders, &loops))
        .collect();
    let lengths = |rate: f64| ladders.iter().filter(|one| one.rate == rate).count();
    let complete = rates.iter().all(|rate| {
        lengths(*rate) >= LEAST_LENGTHS
            && loops
                .iter()
                .filter(|one| one.rate == *rate && one.width().is_some())
                .count()
                >= LEAST_LENGTHS
    });
    let mut finding = Finding::new(
        if complete {
            Verdict::Answered
        } else {
            Verdict::Open
        },
        format!("{}.", words.join(". ")),
        statistics,
        &NEEDED,
    );
    finding.varied = "force";
    finding.quantities = quantities(&rates, &ladders, &loops);
    if !ladders.is_empty() {
        finding.tables.push(tables::of_ladders(&ladders));
    }
    if !loops.is_empty() {
        finding.tables.push(tables::of_loops(&loops));
    }
    finding.paragraphs.push(
        "A discontinuous rise between two forces stays as high however long the tube is, and where both flows live side by side the \
         variance of *J*/*J*_{max} does not fall with its length; a continuous one has a largest slope, and waves that fluctuate by \
         themselves leave the product of variance and length as it is. The loop of a discontinuous transition stays open however \
         slow the sweep, up to the lifetime of the metastable flow; that of a continuous one closes."
            .to_owned(),
    );
    finding.paragraphs.push(format!(
        "A sweep passes where the line through the period averages of *J*/*J*_{{max}} crosses {PASSED} for good; its error is at least \
         half of what the force changes in a period."
    ));
    finding.weaknesses.push(
        "One run a force and length; the flow of slow waves takes many periods to \
         settle, and the late half of the run is what is averaged."
            .to_owned(),
    );
    finding
        .figures
        .extend(figures::figure(&rates, &ladders, &loops)?);
    Ok(finding)
}

/// What one strain rate shows.
fn words(rate: f64, ladders: &[Ladder<'_>], loops: &[Loop]) -> String {
    let rises: Vec<String> = ladders
        .iter()
        .filter(|one| one.rate == rate)
        .filter_map(|one| {
            let rise = one.rise()?;
            let clear = rise.height.value > LEAST_RISE.max(CLEAR * rise.height.error);
            Some(format!(
                "{}{} in {} waves",
                with_error(rise.height.value, rise.height.error),
                if clear { "" } else { " (not clear)" },
                one.waves
            ))
        })
        .collect();
    let mut here: Vec<&Loop> = loops.iter().filter(|one| one.rate == rate).collect();
    here.sort_by(|one, other| one.periods.total_cmp(&other.periods));
    let widths: Vec<String> = here
        .iter()
        .filter_map(|one| {
            let width = one.width()?;
            Some(format!(
                "{} in {} periods",
                with_error(1e3 * width.value, 1e3 * width.error),
                one.periods
            ))
        })
        .collect();
    let sweeps = if widths.is_empty() {
        "no sweep passes both ways".to_owned()
    } else {
        format!(
            "the loop of a sweep is 10^{{−3}} *Y d*^2 × ({}) wide",
            widths.join(", ")
        )
    };
    let rises = if rises.is_empty() {
        "no rise between two forces is known yet".to_owned()
    } else {
        format!(
            "the largest rise between two forces is {}",
            rises.join(", ")
        )
    };
    format!(
        "At *ε̇* = {} × 10^{{−3}}/*t*^{{\\*}} {rises}; {sweeps}",
        number(1e3 * rate, 2)
    )
}

fn quantities(rates: &[f64], ladders: &[Ladder<'_>], loops: &[Loop]) -> Vec<Quantity> {
    let mut quantities = Vec::new();
    for rate in rates {
        let of_rate = || ladders.iter().filter(|one| one.rate == *rate);
        let fluctuation: Vec<(f64, Mean)> = of_rate()
            .filter_map(|one| Some((one.waves, one.largest_fluctuation()?.1)))
            .collect();
        let widths: Vec<(f64, Mean)> = loops
            .iter()
            .filter(|one| one.rate == *rate)
            .filter_map(|one| Some((one.periods, one.width()?)))
            .collect();
        for (name, symbol, points, method) in [
            (
                "exponent of the largest (variance × waves) in the length",
                "d ln *Lχ_J*/d ln *L*",
                fluctuation,
                "0: waves fluctuate by themselves; 1: all together",
            ),
            (
                "exponent of the loop in the length of the sweep",
                "d ln Δ*f*/d ln *t*",
                widths,
                "0: a loop that stays open; below: one that closes",
            ),
        ] {
            let ours = exponent(&points);
            quantities.extend(ours.map(|ours| Quantity {
                name: format!("{name}, strain rate {rate}"),
                symbol: symbol.to_owned(),
                unit: String::new(),
                source: None,
                ours: Some(ours),
                method: method.to_owned(),
            }));
        }
        quantities.extend(of_rate().filter_map(|one| {
            Some(Quantity {
                name: format!(
                    "largest rise between two forces, strain rate {rate}, {} waves",
                    one.waves
                ),
                symbol: "Δ(*J*/*J*_{max})".to_owned(),
                unit: String::new(),
                source: None,
                ours: Some(one.rise()?.height),
                method: "from rest, neighbouring forces".to_owned(),
            })
        }));
    }
    quantities
}
