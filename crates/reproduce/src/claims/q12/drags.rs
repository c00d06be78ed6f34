//! Both drags measured apart: what the waves of a smooth elastic wall give, and what the wall of a straight tube takes.

use peristalsis_run::THRESHOLDS;

use crate::claims::prelude::*;

/// The studies of both, and the one that has w_c of the same tubes.
pub(super) const WAVES: &str = "drag-of-the-waves";
pub(super) const WALL: &str = "drag-of-the-wall";
const CRITICAL: &str = "roughness";
/// Part of a run that its late mean covers.
const LATE: f64 = 0.25;

/// Both drags in one tube at one strain rate, the wall's at one temperature.
pub(super) struct Drags {
    strain_rate: f64,
    wall: String,
    /// Granular temperature with which the grains begin to coast \[m d^2/t^2\].
    pub(super) temperature: f64,
    /// Rate at which grains that coast in the straight tube lose their speed.
    taken: Uncertain,
    /// Rates at which the waves give theirs to grains at rest, by ascending width.
    given: Vec<(f64, Uncertain)>,
    /// 2 a, and w_c as it was measured.
    diameter: f64,
    critical: Option<Uncertain>,
}

/// −ln(1 − V/c)/t where V first is a tenth of c, V/c being J/Jmax.
fn given(row: &Row<'_>) -> f64 {
    let reached = THRESHOLDS[0];
    let time = row.transition_at(reached).observed();
    time.map_or(f64::NAN, |time| -(1.0 - reached).ln() / time)
}

/// −ln(V/V_0)/t, V the late mean and t the middle of its time.
fn taken(row: &Row<'_>) -> f64 {
    let start = row.number("initial.axial_velocity") / row.wave_speed();
    -(row.flow_rate_ratio() / start).ln() / (row.time() * (1.0 - LATE / 2.0))
}

impl Drags {
    /// In all tubes that have both.
    pub(super) fn all(evidence: &Evidence) -> Result<Vec<Self>> {
        let critical = evidence.study(CRITICAL)?.rows();
        let waves = by_strain_rate(evidence.study(WAVES)?.rows());
        let coasting = evidence.study(WALL)?.rows();
        let key = |row: &Row<'_>| {
            let temperature = row.number("initial.temperature");
            (temperature, row.strain_rate(), row.lattice())
        };
        let tubes = grouped(coasting, key);
        let of = |(of, rows): ((f64, f64, Lattice), Vec<Row<'_>>)| {
            let (temperature, strain_rate, lattice) = of;
            let (_, waves) = waves.iter().find(|(rate, _)| *rate == strain_rate)?;
            let widths = grouped(waves.iter().copied(), Row::width).into_iter();
            let given = widths.map(|(width, rows)| (width, scattered(&rows, given)));
            let is_here =
                |row: &&Row<'_>| row.strain_rate() == strain_rate && row.lattice() == lattice;
            let here: Vec<Row<'_>> = critical.iter().filter(is_here).copied().collect();
            let critical = crossing(&here).map(|found| found.width);
            if leak(&here, critical.map(|width| width.value)) > MOST_ESCAPED {
                return None;
            }
            Some(Self {
                strain_rate,
                wall: wall_name(lattice, STAGGERED),
                temperature,
                taken: scattered(&rows, taken),
                given: given.filter(|(_, rate)| rate.value.is_finite()).collect(),
                diameter: 2.0 * rows[0].radius(),
                critical,
            })
        };
        Ok(tubes.into_iter().filter_map(of).collect())
    }

    /// The width at which both rates are equal, between two widths on a straight line of logarithms; else the end beyond
    /// which it lies, and whether that is the widest.
    fn balance(&self) -> core::result::Result<f64, (f64, bool)> {
        let [first, .., last] = &*self.given else {
            return Err((f64::NAN, true));
        };
        if self.taken.value <= last.1.value {
            return Err((last.0, true));
        }
        let pairs = self.given.windows(2);
        let place = |pair: &[(f64, Uncertain)]| {
            let [ln_from, ln_to, wanted] =
                [pair[0].1.value, pair[1].1.value, self.taken.value].map(f64::ln);
            let part = (wanted - ln_from) / (ln_to - ln_from);
            (0.0..=1.0)
                .contains(&part)
                .then(|| pair[0].0 + part * (pair[1].0 - pair[0].0))
        };
        pairs.filter_map(place).next_back().ok_or((first.0, false))
    }

    /// Whether both rates are equal at w_c, by the rule of the predictions; `None` without a w_c.
    pub(super) fn explains(&self) -> Option<bool> {
        let measured = self.diameter - self.critical?.value;
        let near =
            |width: f64| ((self.diameter - width) / measured - 1.0).abs() <= PREDICTED_WITHIN;
        Some(self.balance().is_ok_and(near))
    }

    pub(super) fn row(&self) -> Vec<String> {
        let balance = match self.balance() {
            Ok(width) => number(width, 2),
            Err((end, widest)) => format!("{} {}", if widest { ">" } else { "<" }, number(end, 2)),
        };
        let in_thousandths = |one: Uncertain| with_error(1e3 * one.value, 1e3 * one.error);
        vec![
            self.wall.clone(),
            self.strain_rate.to_string(),
            number(self.temperature, 3),
            in_thousandths(self.taken),
            balance,
            cell(self.critical),
        ]
    }
}
