//! Finished runs as analyses see them: one typed row each.

use peristalsis_analysis::Transition;
use peristalsis_formats::{Column, FormatError, Table, Values};
use peristalsis_run::THRESHOLDS;

/// Columns of numbers, besides the axes of the study, that are kept by their names.
const KEPT: [&str; 9] = [
    "force_amplitude",
    "number_density",
    "late_periods",
    "throat_density",
    "throat_axial_velocity",
    "throat_granular_temperature",
    "belly_density",
    "belly_axial_velocity",
    "belly_granular_temperature",
];

pub(crate) use crate::row::{Lattice, Start};
pub(crate) use crate::thresholds::MOST_DRIFT;

/// One finished run.
#[derive(Clone, Debug, PartialEq)]
pub struct Run {
    /// Identity.
    pub identity: String,
    /// Initial state.
    pub start: Start,
    /// Arrangement of the wall spheres.
    pub lattice: Lattice,
    /// w \[d\]; NaN under stress control.
    pub width: f64,
    /// c/lambda \[1/t\].
    pub strain_rate: f64,
    /// rho.
    pub volume_fraction: f64,
    /// N.
    pub grains: i64,
    /// a \[d\].
    pub radius: f64,
    /// lambda \[d\].
    pub wavelength: f64,
    /// Waves in the tube.
    pub waves: i64,
    /// Time reached \[t\].
    pub time: f64,
    /// Late mean of J/Jmax.
    pub flow_rate_ratio: f64,
    /// Its standard error.
    pub flow_rate_ratio_error: f64,
    /// Mean of the second half of the late part less that of the first; NaN where the table does not say.
    pub flow_rate_ratio_drift: f64,
    /// Grains outside at the end.
    pub escaped: i64,
    /// Transition time \[t\] at the threshold of the study; NaN where there was none.
    pub transition_time: f64,
    /// That threshold, J/Jmax.
    pub transition_threshold: f64,
    /// Transition time \[t\] at each of [`THRESHOLDS`]; NaN where there was none.
    pub transition_times: [f64; THRESHOLDS.len()],
    /// Number of the replicate.
    pub replicate: i64,
    /// Other numbers of the row by the names of their columns: the axes of the study by key, and what only some claims need.
    /// Of an axis of texts the entry is 1 under `key=text`, as in `drive.angle=current`.
    pub axes: Vec<(String, f64)>,
}

impl Run {
    /// The transition at the threshold of the study; censored at the end of the run where there was none.
    #[must_use]
    pub fn transition(&self) -> Transition {
        self.transition_of(self.transition_time)
    }

    /// The transition at another threshold, the nearest of [`THRESHOLDS`].
    #[must_use]
    pub fn transition_at(&self, threshold: f64) -> Transition {
        let place = THRESHOLDS
            .iter()
            .enumerate()
            .min_by(|(_, one), (_, other)| {
                (*one - threshold)
                    .abs()
                    .total_cmp(&(*other - threshold).abs())
            })
            .map_or(0, |(place, _)| place);
        self.transition_of(self.transition_times[place])
    }

    fn transition_of(&self, time: f64) -> Transition {
        if time.is_nan() {
            return Transition::Censored { time: self.time };
        }
        Transition::At {
            time,
            period: (time * self.strain_rate) as u64,
        }
    }

    /// Period of the wave \[t\].
    #[must_use]
    pub fn period(&self) -> f64 {
        1.0 / self.strain_rate
    }

    /// f^P; NaN under strain control.
    #[must_use]
    pub fn force(&self) -> f64 {
        self.axis("force_amplitude").unwrap_or(f64::NAN)
    }

    /// Periods that its late mean is over; 0 where the table does not say.
    #[must_use]
    pub fn late_periods(&self) -> f64 {
        self.axis("late_periods")
            .filter(|periods| periods.is_finite())
            .unwrap_or(0.0)
    }

    /// Value of an axis of the study by its key, or of a column by its name.
    #[must_use]
    pub fn axis(&self, key: &str) -> Option<f64> {
        self.axes
            .iter()
            .find(|(name, _)| name == key)
            .map(|(_, value)| *value)
    }

    /// Whether its late mean is that of a stationary flow: it drifts by less than 0.05 from the first half to the second.
    #[must_use]
    pub fn is_stationary(&self) -> bool {
        self.flow_rate_ratio_drift.is_nan() || self.flow_rate_ratio_drift.abs() <= MOST_DRIFT
    }

    /// Fraction of the grains outside at the end.
    #[must_use]
    pub fn escaped_fraction(&self) -> f64 {
        self.escaped as f64 / self.grains.max(1) as f64
    }

    /// The rows of a study's table.
    ///
    /// # Errors
    /// A column that is missing or of another kind.
    pub fn all_of(table: &Table) -> Result<Vec<Self>, FormatError> {
        if table.rows() == 0 {
            return Ok(Vec::new());
        }
        let identity = table.texts("identity")?;
        let start = table.texts("initial_state")?;
        let integers = |name| table.integers(name);
        let reals = |name| table.reals(name);
        let (spheres, rings) = (integers("spheres_per_ring")?, integers("rings_per_wave")?);
        let (width, strain_rate) = (reals("width")?, reals("strain_rate")?);
        let (volume_fraction, grains) = (reals("volume_fraction")?, integers("grains")?);
        let (radius, wavelength, waves) =
            (reals("radius")?, reals("wavelength")?, integers("waves")?);
        let time = reals("time")?;
        let (ratio, error) = (reals("flow_rate_ratio")?, reals("flow_rate_ratio_error")?);
        let drift = reals("flow_rate_ratio_drift")
            .map_or_else(|_| vec![f64::NAN; table.rows()], <[f64]>::to_vec);
        let escaped = integers("escaped")?;
        let (own_time, own_threshold) = (reals("transition_time")?, reals("transition_threshold")?);
        let replicate = integers("replicate")?;
        let ladder: Vec<&[f64]> = (1..=THRESHOLDS.len())
            .map(|place| table.reals(&format!("transition_time_{}", 10 * place)))
            .collect::<Result<_, _>>()?;
        let columns: Vec<&Column> = table
            .columns()
            .iter()
            .filter(|column| column.name.contains('.') || KEPT.contains(&column.name.as_str()))
            .collect();
        Ok((0..table.rows())
            .map(|row| Self {
                identity: identity[row].clone(),
                start: if start[row] == "jammed" {
                    Start::Jammed
                } else {
                    Start::Rest
                },
                lattice: Lattice {
                    spheres_per_ring: spheres[row],
                    rings_per_wave: rings[row],
                },
                width: width[row],
                strain_rate: strain_rate[row],
                volume_fraction: volume_fraction[row],
                grains: grains[row],
                radius: radius[row],
                wavelength: wavelength[row],
                waves: waves[row],
                time: time[row],
                flow_rate_ratio: ratio[row],
                flow_rate_ratio_error: error[row],
                flow_rate_ratio_drift: drift[row],
                escaped: escaped[row],
                transition_time: own_time[row],
                transition_threshold: own_threshold[row],
                replicate: replicate[row],
                transition_times: core::array::from_fn(|place| ladder[place][row]),
                axes: columns
                    .iter()
                    .filter_map(|column| numbered(column, row))
                    .collect(),
            })
            .collect())
    }
}

/// Name and number of a value of a column.
fn numbered(column: &Column, row: usize) -> Option<(String, f64)> {
    let name = column.name.clone();
    match &column.values {
        Values::Real(values) => Some((name, values[row])),
        Values::Integer(values) => Some((name, values[row] as f64)),
        Values::Text(values) => Some((format!("{name}={}", values[row]), 1.0)),
        Values::Boolean(_) => None,
    }
}

/// A table of these runs.
pub(crate) fn table_of(runs: &[Run]) -> Table {
    let reals = |value: &dyn Fn(&Run) -> f64| Values::Real(runs.iter().map(value).collect());
    let integers = |value: &dyn Fn(&Run) -> i64| Values::Integer(runs.iter().map(value).collect());
    let texts = |value: &dyn Fn(&Run) -> String| Values::Text(runs.iter().map(value).collect());
    let start = |run: &Run| {
        if run.start == Start::Jammed {
            "jammed"
        } else {
            "rest"
        }
        .to_owned()
    };
    let mut columns: Vec<(String, Values)> = Vec::new();
    let mut add = |name: &str, values| columns.push((name.to_owned(), values));
    add("identity", texts(&|run| run.identity.clone()));
    add("initial_state", texts(&start));
    add("width", reals(&|run| run.width));
    add("strain_rate", reals(&|run| run.strain_rate));
    add("volume_fraction", reals(&|run| run.volume_fraction));
    add("radius", reals(&|run| run.radius));
    add("wavelength", reals(&|run| run.wavelength));
    add("time", reals(&|run| run.time));
    add("flow_rate_ratio", reals(&|run| run.flow_rate_ratio));
    add(
        "flow_rate_ratio_error",
        reals(&|run| run.flow_rate_ratio_error),
    );
    add(
        "flow_rate_ratio_drift",
        reals(&|run| run.flow_rate_ratio_drift),
    );
    add("transition_time", reals(&|run| run.transition_time));
    add(
        "transition_threshold",
        reals(&|run| run.transition_threshold),
    );
    for place in 0..THRESHOLDS.len() {
        let name = format!("transition_time_{}", 10 * (place + 1));
        add(&name, reals(&|run| run.transition_times[place]));
    }
    add(
        "spheres_per_ring",
        integers(&|run| run.lattice.spheres_per_ring),
    );
    add(
        "rings_per_wave",
        integers(&|run| run.lattice.rings_per_wave),
    );
    add("grains", integers(&|run| run.grains));
    add("waves", integers(&|run| run.waves));
    add("escaped", integers(&|run| run.escaped));
    add("replicate", integers(&|run| run.replicate));
    let mut axes: Vec<&str> = runs
        .iter()
        .flat_map(|run| run.axes.iter().map(|(name, _)| name.as_str()))
        .collect();
    axes.sort_unstable();
    axes.dedup();
    for name in axes {
        match name.split_once('=') {
            Some((key, text)) => add(
                key,
                texts(&|run| run.axis(name).map_or(String::new(), |_| text.to_owned())),
            ),
            None => add(name, reals(&|run| run.axis(name).unwrap_or(f64::NAN))),
        }
    }
    columns
        .into_iter()
        .fold(Table::builder(), |table, (name, values)| {
            table.column(name, "", "", values)
        })
        .build()
        .expect("each column has a value a run")
}
