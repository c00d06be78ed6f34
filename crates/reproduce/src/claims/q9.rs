//! Q9: pumping against a back pressure.

mod figures;

use peristalsis_figures::Units;
use peristalsis_physics::newtonian::NewtonianPeristalsis;

use super::prelude::*;

const PROSE: Prose = Prose::new(include_str!("q9.md"));
const STUDIES: &[&str] = &["pumping-frictionless", "pumping-frictional"];

pub(super) const CLAIM: Claim =
    Claim::new("Q9", PROSE, STUDIES, examine).varying("back pressure", Q9_NEEDED);

/// The waveforms in the order of series.
const WAVEFORMS: [&str; 3] = ["sine", "bolus", "roller"];

/// A tube that pumps.
struct Model {
    study: &'static str,
    name: &'static str,
    /// Those of its pressures.
    units: Units,
}

const MODELS: [Model; 2] = [
    Model {
        study: "pumping-frictionless",
        name: "frictionless grains, prescribed wall",
        units: Units::Linear,
    },
    Model {
        study: "pumping-frictional",
        name: "frictional grains, elastic wall",
        units: Units::Hertz,
    },
];

/// One model with what its wall can do.
struct Pump<'a> {
    model: &'static Model,
    results: &'a StudyResults,
    characteristics: Vec<Characteristic<'a>>,
    /// phi = b/a of the sine without back pressure, from the bottleneck that was measured.
    amplitude_ratio: f64,
}

/// One waveform against ascending back pressures.
struct Characteristic<'a> {
    waveform: &'static str,
    branch: Branch<'a>,
}

/// Power of the flow against the pressure over the power of the wall, both means over the runs: eta = <P>/<W>, its error
/// from the scatter of (P - eta W)/<W>.
fn efficiency(point: &Point<'_>) -> Option<Uncertain> {
    let of = |column| scattered(&point.rows, |row| row.number(column)).value;
    let (wall, useful) = (of("wall_power"), of("useful_power"));
    let ratio = useful / wall;
    let rest =
        |row: &Row<'_>| (row.number("useful_power") - ratio * row.number("wall_power")) / wall;
    let scatter = scattered(&point.rows, rest).error;
    let degrees = point.rows.len().saturating_sub(1);
    ratio
        .is_finite()
        .then(|| Uncertain::student(ratio, scatter, degrees))
}

/// Largest part of the grains outside in any of these runs.
fn outside(point: &Point<'_>) -> f64 {
    largest(&point.rows, Row::escaped_fraction)
}

/// Time that a grain takes through one wavelength, in periods of the wave.
fn residence(point: &Point<'_>) -> Option<Uncertain> {
    scaled(point, "residence_time", |row| {
        row.strain_rate() / row.number("waves")
    })
}

/// D/(c lambda).
fn dispersion(point: &Point<'_>) -> Option<Uncertain> {
    scaled(point, "axial_dispersion", |row| {
        1.0 / (row.wave_speed() * row.wavelength())
    })
}

/// Mean of a column times a scale of each run.
fn scaled(point: &Point<'_>, column: &str, scale: fn(&Row<'_>) -> f64) -> Option<Uncertain> {
    mean_of(&point.rows, |row| {
        let ((value, error), scale) = (row.number_and_error(column), scale(row));
        (value * scale, error * scale)
    })
}

impl<'a> Characteristic<'a> {
    /// `None` where no run has this waveform.
    fn of(rows: &[Row<'a>], waveform: &'static str) -> Option<Self> {
        let is_of = |row: &&Row<'_>| row.text("drive.waveform") == waveform;
        let of_waveform: Vec<Row<'a>> = rows.iter().filter(is_of).copied().collect();
        let branch = Branch::of_all(&of_waveform, Control::BackPressure);
        (!branch.points.is_empty()).then_some(Self { waveform, branch })
    }

    /// The point without back pressure, or against the smallest.
    fn free(&self) -> &Point<'a> {
        &self.branch.points[0]
    }

    /// The two neighbouring pressures between which the flow turns round.
    fn turn(&self) -> Option<Step> {
        let mut steps = self.branch.steps();
        steps.find(|step| step.flows[0] > 0.0 && step.flows[1] <= 0.0)
    }

    /// The pressure at which the flow turns round.
    fn stop(&self) -> Option<Uncertain> {
        Some(self.turn()?.place())
    }

    /// Part of the grains outside at the pressure that turned the flow round, where too many are.
    fn leak(&self) -> Option<f64> {
        let beyond = self.branch.at(self.turn()?.controls[1])?;
        Some(outside(beyond)).filter(|part| *part > MOST_ESCAPED)
    }

    /// Whether the flow at the largest efficiency still drifts in most runs.
    fn best_drifts(&self) -> bool {
        self.best().is_some_and(|(point, _)| {
            let steady = point.rows.iter().filter(|row| row.is_stationary());
            2 * steady.count() < point.rows.len()
        })
    }

    /// The point of the largest efficiency among those with flow along the wave.
    fn best(&self) -> Option<(&Point<'a>, Uncertain)> {
        let forward = self.branch.points.iter();
        forward
            .filter(|point| point.flow.value > 0.0)
            .filter_map(|point| Some((point, efficiency(point)?)))
            .max_by(|one, other| one.1.value.total_cmp(&other.1.value))
    }

    /// Whether the largest efficiency is at the smallest pressure rise that was tried, so that it may be larger below.
    fn best_is_at_the_edge(&self) -> bool {
        let mut loaded = self.branch.points.iter();
        loaded
            .find(|point| point.control > 0.0)
            .zip(self.best())
            .is_some_and(|(first, (best, _))| best.control <= first.control)
    }

    /// The point against the largest pressure that still has flow along the wave.
    fn last(&self) -> Option<&Point<'a>> {
        let points = self.branch.points.iter();
        points.take_while(|point| point.flow.value > 0.0).last()
    }

    /// The row of the table.
    fn cells(&self, model: &Model) -> Vec<String> {
        let (free, best) = (self.free(), self.best());
        vec![
            model.name.to_owned(),
            self.waveform.to_owned(),
            free.flow.to_string(),
            cell(self.stop()),
            cell(best.map(|best| best.1)),
            cell_of(best, |best| number(best.0.control, 4)),
            cell(residence(free)),
            cell(best.and_then(|best| residence(best.0))),
            cell(dispersion(free)),
            cell(best.and_then(|best| dispersion(best.0))),
        ]
    }
}

impl<'a> Pump<'a> {
    /// `None` without a run of the sine.
    fn of(model: &'static Model, results: &'a StudyResults) -> Option<Self> {
        let rows = results.rows();
        let characteristics: Vec<Characteristic<'a>> = WAVEFORMS
            .into_iter()
            .filter_map(|waveform| Characteristic::of(&rows, waveform))
            .collect();
        let sine = characteristics.iter().find(|one| one.waveform == "sine")?;
        let amplitude_ratio = mean_of(&sine.free().rows, |row| {
            (1.0 - row.number("bottleneck") / (2.0 * row.radius()), 0.0)
        })?;
        Some(Self {
            model,
            results,
            amplitude_ratio: amplitude_ratio.value,
            characteristics,
        })
    }

    /// The sine, which the answer rests on; every pump has it, as the first.
    fn sine(&self) -> &Characteristic<'a> {
        &self.characteristics[0]
    }

    fn statistics(&self) -> Statistics {
        let points = &self.sine().branch.points;
        let rows: Vec<Row<'a>> = points.iter().flat_map(|one| one.rows.clone()).collect();
        behind(&rows, |row| Control::BackPressure.of(row))
    }

    /// A Newtonian fluid in a tube of this amplitude against the fraction `load` of the pressure that stops it.
    fn newtonian(&self, load: f64) -> Option<NewtonianPeristalsis> {
        let free = NewtonianPeristalsis::free_pumping(self.amplitude_ratio)?;
        NewtonianPeristalsis::new(self.amplitude_ratio, load * free.zero_flow_pressure())
    }

    /// The largest efficiency of a Newtonian fluid in it.
    fn newtonian_efficiency(&self) -> f64 {
        (1..200)
            .filter_map(|part| self.newtonian(f64::from(part) / 200.0)?.efficiency())
            .fold(0.0, f64::max)
    }

    /// What it does, in a sentence.
    fn words(&self) -> Option<String> {
        let (point, efficiency) = self.sine().best()?;
        let unit = self.model.units.pressure();
        let stop = match self.sine().stop() {
            None => PROSE.text("no stop", &[]),
            Some(stop) => PROSE.text("stop", values!(stop, unit)),
        };
        let (name, flow) = (self.model.name, point.flow);
        let pressure = number(point.control, 4);
        let amplitude = number(self.amplitude_ratio, 2);
        let fluid = number(self.newtonian_efficiency(), 3);
        Some(PROSE.text(
            "pump",
            values!(
                name, efficiency, flow, pressure, unit, amplitude, fluid, stop
            ),
        ))
    }

    /// The rows of the table.
    fn cells(&self) -> Vec<Vec<String>> {
        let characteristics = self.characteristics.iter();
        characteristics.map(|one| one.cells(self.model)).collect()
    }
}

fn examine(evidence: &Evidence) -> Result<Finding> {
    let mut pumps = Vec::new();
    for model in &MODELS {
        pumps.extend(Pump::of(model, evidence.study(model.study)?));
    }
    if pumps.is_empty() {
        return Ok(PROSE.nothing(Statistics::default()));
    }
    let words: Vec<String> = pumps.iter().filter_map(Pump::words).collect();
    let all = pumps.len() == MODELS.len() && words.len() == pumps.len();
    let verdict = Verdict::answered_if(all);
    let summary = match &*words.join(". ") {
        "" => PROSE.text("no pump", &[]),
        words => format!("{words}."),
    };
    let statistics = Statistics::weakest_at_one_rate(pumps.iter().map(Pump::statistics));
    let mut draft = Draft::of(PROSE);
    for pump in &pumps {
        let (sine, name) = (pump.sine(), pump.model.name);
        let unit = pump.model.units.pressure().replace('*', "");
        let best = sine.best().map(|(_, efficiency)| efficiency);
        draft.quantity("efficiency", values!(model = name), best);
        draft.quantity("stop", values!(model = name, unit), sine.stop());
    }
    draft.table("pumps", &[], pumps.iter().flat_map(Pump::cells));
    let at_the_edge: Vec<&str> = pumps
        .iter()
        .filter(|pump| pump.sine().best_is_at_the_edge())
        .map(|pump| pump.model.name)
        .collect();
    if !at_the_edge.is_empty() {
        draft.weakness("at the edge", values!(pumps = at_the_edge.join("; ")));
    }
    for pump in &pumps {
        let name = pump.model.name;
        if pump.sine().best_drifts() {
            draft.weakness("drifts", values!(name));
        }
        if let Some(part) = pump.sine().leak() {
            draft.weakness("leaks", values!(name, part = number(part, 2)));
        }
    }
    draft.chart("pump-characteristic", &[], figures::characteristic(&pumps))?;
    figures::on_the_wall(&mut draft, &pumps)?;
    Ok(draft.concluded(verdict, summary, statistics))
}
