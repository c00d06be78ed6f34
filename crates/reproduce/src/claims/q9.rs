//! Q9: pumping against a back pressure.

mod figures;

use peristalsis_analysis::Uncertain;
use peristalsis_figures::Units;
use peristalsis_physics::newtonian::NewtonianPeristalsis;

use crate::branches::bracket;
use crate::claim::Claim;
use crate::error::ClaimError;
use crate::evidence::{Evidence, StudyResults};
use crate::finding::{Finding, Quantity, ReportTable, Statistics, Verdict};
use crate::prose::Prose;
use crate::rows::{Mean, Row, behind, by, mean, mean_of};
use crate::text::{estimate, number, with_error};

const PROSE: Prose = Prose::new(include_str!("q9.md"));

pub(super) const CLAIM: Claim = Claim {
    id: "Q9",
    prose: PROSE,
    studies: &["pumping-frictionless", "pumping-frictional"],
    examine,
};

/// For an answer: eight pressures of the sine in either model, three replicates.
const NEEDED: Statistics = Statistics {
    strain_rates: 1,
    widths: 8,
    replicates: 3,
    runs: 66,
};

/// The waveforms in the order of series.
const WAVEFORMS: [&str; 3] = ["sine", "bolus", "roller"];

/// A tube that pumps.
struct Model {
    study: &'static str,
    name: &'static str,
    units: Units,
    /// The unit of pressure in markup, and what makes a number of a pressure.
    pressure_unit: &'static str,
    per_unit: &'static str,
}

const MODELS: [Model; 2] = [
    Model {
        study: "pumping-frictionless",
        name: "frictionless grains, prescribed wall",
        units: Units::Linear,
        pressure_unit: "*k*/*d*",
        per_unit: " *d*/*k*",
    },
    Model {
        study: "pumping-frictional",
        name: "frictional grains, elastic wall",
        units: Units::Hertz,
        pressure_unit: "*Y*",
        per_unit: "/*Y*",
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
    points: Vec<Working<'a>>,
}

/// A working point of a pump.
struct Working<'a> {
    /// Dp over a wavelength, in k/d or Y.
    pressure: f64,
    /// J/Jmax.
    flow: Mean,
    efficiency: Option<Mean>,
    /// Time that a grain takes through one wavelength \[periods of the wave\].
    residence: Option<Mean>,
    /// D/(c lambda).
    dispersion: Option<Mean>,
    rows: Vec<Row<'a>>,
}

impl<'a> Characteristic<'a> {
    fn of(rows: &[Row<'a>], waveform: &'static str) -> Self {
        let of_waveform: Vec<Row<'a>> = rows
            .iter()
            .filter(|row| row.text("drive.waveform") == waveform)
            .copied()
            .collect();
        let points = by(&of_waveform, |row| row.number("pressure_rise"))
            .into_iter()
            .filter_map(|(pressure, rows)| {
                let scaled = |column: &'static str, scale: fn(&Row<'_>) -> f64| {
                    mean_of(&rows, |row| {
                        let error = row.number(&format!("{column}_error"));
                        (row.number(column) * scale(row), error * scale(row))
                    })
                };
                Some(Working {
                    pressure,
                    flow: mean(&rows, "flow_rate_ratio")?,
                    efficiency: mean(&rows, "pumping_efficiency"),
                    residence: scaled("residence_time", |row| {
                        row.number("strain_rate") / row.number("waves")
                    }),
                    dispersion: scaled("axial_dispersion", |row| {
                        1.0 / (row.wave_speed() * row.number("wavelength"))
                    }),
                    rows,
                })
            })
            .collect();
        Self { waveform, points }
    }

    /// The pressure at which the flow turns round, as a bracket of two neighbouring pressures.
    fn stop(&self) -> Option<Uncertain> {
        self.points
            .windows(2)
            .find(|pair| pair[0].flow.value > 0.0 && pair[1].flow.value <= 0.0)
            .map(|pair| bracket(pair[0].pressure, pair[1].pressure))
    }

    /// The working point of the largest efficiency among those with flow along the wave.
    fn best(&self) -> Option<(&Working<'a>, Mean)> {
        self.points
            .iter()
            .filter(|point| point.flow.value > 0.0)
            .filter_map(|point| Some((point, point.efficiency?)))
            .max_by(|one, other| one.1.value.total_cmp(&other.1.value))
    }

    /// Whether the largest efficiency is at the smallest pressure rise that was tried, so that it may be larger below.
    fn best_is_at_the_edge(&self) -> bool {
        let mut loaded = self.points.iter().filter(|point| point.pressure > 0.0);
        loaded
            .next()
            .zip(self.best())
            .is_some_and(|(first, (best, _))| best.pressure <= first.pressure)
    }

    /// The working point against the largest pressure that still has flow along the wave.
    fn last(&self) -> Option<&Working<'a>> {
        self.points
            .iter()
            .take_while(|point| point.flow.value > 0.0)
            .last()
    }
}

impl<'a> Pump<'a> {
    fn of(model: &'static Model, results: &'a StudyResults) -> Option<Self> {
        let rows = results.rows();
        let characteristics: Vec<Characteristic<'a>> = WAVEFORMS
            .into_iter()
            .map(|waveform| Characteristic::of(&rows, waveform))
            .filter(|one| !one.points.is_empty())
            .collect();
        let free = characteristics
            .iter()
            .find(|one| one.waveform == "sine")?
            .points
            .first()?;
        let amplitude_ratio = mean_of(&free.rows, |row| {
            let ratio = 1.0 - row.number("bottleneck") / (2.0 * row.number("radius"));
            (ratio, 0.0)
        })?
        .value;
        Some(Self {
            model,
            results,
            characteristics,
            amplitude_ratio,
        })
    }

    fn sine(&self) -> Option<&Characteristic<'a>> {
        self.characteristics
            .iter()
            .find(|one| one.waveform == "sine")
    }

    /// What is behind the sine, which the answer rests on.
    fn statistics(&self) -> Statistics {
        let rows: Vec<Row<'a>> = self
            .sine()
            .map(|sine| sine.points.iter().flat_map(|one| one.rows.clone()))
            .into_iter()
            .flatten()
            .collect();
        behind(&rows, |row| row.number("pressure_rise"))
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
        let (point, efficiency) = self.sine()?.best()?;
        let stop = self.sine()?.stop().map_or_else(
            || "no back pressure that was tried turns the flow round".to_owned(),
            |stop| {
                format!(
                    "the flow turns round at Δ*p* = {} {}",
                    estimate(&stop),
                    self.model.pressure_unit
                )
            },
        );
        Some(format!(
            "{}: efficiency up to {} (*J*/*J*_{{max}} = {} against Δ*p* = {} {}), a Newtonian fluid at the same *b*/*a* = {} at \
             most {}; {stop}",
            self.model.name,
            with_error(efficiency.value, efficiency.error),
            with_error(point.flow.value, point.flow.error),
            number(point.pressure, 4),
            self.model.pressure_unit,
            number(self.amplitude_ratio, 2),
            number(self.newtonian_efficiency(), 3),
        ))
    }
}

fn examine(evidence: &Evidence) -> Result<Finding, ClaimError> {
    let mut pumps = Vec::new();
    for model in &MODELS {
        pumps.extend(Pump::of(model, evidence.study(model.study)?));
    }
    if pumps.is_empty() {
        return Ok(Finding::nothing(
            "No runs of the sine yet.",
            Statistics::default(),
            &NEEDED,
        ));
    }
    let words: Vec<String> = pumps.iter().filter_map(Pump::words).collect();
    let complete = pumps.len() == MODELS.len() && words.len() == pumps.len();
    let statistics = Statistics {
        strain_rates: 1,
        ..Statistics::weakest(pumps.iter().map(Pump::statistics))
    };
    let mut finding = Finding::new(
        if complete {
            Verdict::Answered
        } else {
            Verdict::Open
        },
        if words.is_empty() {
            "No run has pumped against a back pressure yet.".to_owned()
        } else {
            format!("{}.", words.join(". "))
        },
        statistics,
        &NEEDED,
    );
    for pump in &pumps {
        finding.quantities.extend(quantities(pump));
    }
    finding.tables.push(table(&pumps));
    finding.varied = "back pressure";
    finding.paragraphs.push(
        "A body force *g* on the grains, against the wave, stands for the pressure rise Δ*p* = −*N* *m* *g* *λ*/(*L*π*a*^2) over a \
         wavelength. The flow of a Newtonian fluid falls along a straight line from that without pressure to nothing, whatever its \
         viscosity (Shapiro, Jaffrin & Weinberg 1969); here its viscosity is such that it stops at the pressure that turns the \
         grains round. The efficiency is the power of the flow against the body force over that of wall or drive."
            .to_owned(),
    );
    finding.paragraphs.push(
        "Residence is the mean time through one wavelength, in periods of the wave (Little's law): 1 for grains that go with the \
         wave. All waveforms have the same bottleneck under strain control and the same force under stress control; bolus and \
         roller squeeze over half of each wavelength, and leave the rest of the tube wider."
            .to_owned(),
    );
    finding.weaknesses.push(
        "Each model at one bottleneck or force and one strain rate, begun \
         with the jammed flow: an interrupted pump may not begin again at these pressures."
            .to_owned(),
    );
    finding.weaknesses.push(
        "Frictionless grains that have lost their jam fall ever faster: such runs are no steady state, and end where a grain moves \
         too far in one step; the largest back pressures may be missing."
            .to_owned(),
    );
    let at_the_edge: Vec<&str> = pumps
        .iter()
        .filter(|pump| pump.sine().is_some_and(Characteristic::best_is_at_the_edge))
        .map(|pump| pump.model.name)
        .collect();
    if !at_the_edge.is_empty() {
        finding.weaknesses.push(format!(
            "The largest efficiency is at the smallest pressure rise that was tried, and may be larger below it: {}.",
            at_the_edge.join("; ")
        ));
    }
    finding.figures = figures::all(&pumps)?;
    Ok(finding)
}

fn quantities(pump: &Pump<'_>) -> Vec<Quantity> {
    let quantity = |name: &str, symbol: &str, unit: &str, ours: Option<Uncertain>, method: &str| {
        ours.map(|ours| Quantity {
            name: format!("{name}, {}", pump.model.name),
            symbol: symbol.to_owned(),
            unit: unit.to_owned(),
            source: None,
            ours: Some(ours),
            method: method.to_owned(),
        })
    };
    let unit = match pump.model.units {
        Units::Linear => "k/d",
        Units::Hertz => "Y",
    };
    let sine = pump.sine();
    let best = sine.and_then(Characteristic::best);
    [
        quantity(
            "largest efficiency, sine",
            "*η*",
            "",
            best.map(|(_, mean)| Uncertain::normal(mean.value, mean.error)),
            "best of the back pressures that were tried",
        ),
        quantity(
            "back pressure that turns the flow round, sine",
            "Δ*p*_{0}",
            unit,
            sine.and_then(Characteristic::stop),
            "bracket of two back pressures",
        ),
    ]
    .into_iter()
    .flatten()
    .collect()
}

fn table(pumps: &[Pump<'_>]) -> ReportTable {
    let cell = |mean: Option<Mean>| mean.map_or("–".to_owned(), |m| with_error(m.value, m.error));
    let mut rows = Vec::new();
    for pump in pumps {
        for one in &pump.characteristics {
            let Some(free) = one.points.first() else {
                continue;
            };
            let best = one.best();
            rows.push(vec![
                pump.model.name.to_owned(),
                one.waveform.to_owned(),
                cell(Some(free.flow)),
                one.stop()
                    .map_or("–".to_owned(), |pressure| estimate(&pressure)),
                cell(best.as_ref().map(|best| best.1)),
                best.as_ref()
                    .map_or("–".to_owned(), |best| number(best.0.pressure, 4)),
                cell(free.residence),
                cell(best.as_ref().and_then(|best| best.0.residence)),
                cell(free.dispersion),
                cell(best.as_ref().and_then(|best| best.0.dispersion)),
            ]);
        }
    }
    ReportTable {
        caption: "Flow without back pressure, back pressure that turns it round, largest efficiency and the back pressure of it \
                  (in *k*/*d* and *Y*), residence in periods a wavelength and axial dispersion, both without back pressure and at \
                  the largest efficiency."
            .to_owned(),
        head: [
            "pump",
            "waveform",
            "*J*/*J*_{max}",
            "Δ*p*_{0}",
            "*η*",
            "at Δ*p*",
            "residence, free",
            "at largest *η*",
            "*D*/*cλ*, free",
            "*D*/*cλ*, at largest *η*",
        ]
        .map(str::to_owned)
        .to_vec(),
        rows,
    }
}
