//! Q6: the mechanism of back flow.

mod figures;

use peristalsis_analysis::Uncertain;

use crate::claim::Claim;
use crate::error::ClaimError;
use crate::evidence::{Evidence, StudyResults};
use crate::finding::{Finding, Quantity, ReportTable, Statistics, Verdict};
use crate::prose::Prose;
use crate::rows::{Mean, Row, behind, by, mean, mean_of};
use crate::text::{number, with_error};

const PROSE: Prose = Prose::new(include_str!("q6.md"));

pub(super) const CLAIM: Claim = Claim {
    id: "Q6",
    prose: PROSE,
    studies: &["back-flow"],
    examine,
};

/// For an answer: six values of the friction, three replicates.
const NEEDED: Statistics = Statistics {
    strain_rates: 4,
    widths: 6,
    replicates: 3,
    runs: 60,
};

/// Names of the axes.
const FRICTION: &str = "contact.static_friction";
const TETHER: &str = "wall.keep.axial";
const RATE: &str = "strain_rate";
/// The preset, about which one parameter at a time is varied.
const PRESET: Point = Point {
    friction: 0.5,
    tether: 0.01,
    rate: 4.01e-3,
};
/// A tether so stiff that the wall cannot follow the grains.
const PINNED: f64 = 1.0;
/// Pressure on the wall, as a fraction of its largest, below which grains fly freely.
const FREE: f64 = 0.01;
/// Errors by which a number must differ from 0 to have a sign.
const CLEAR: f64 = 2.0;

/// What is varied.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
struct Point {
    friction: f64,
    tether: f64,
    rate: f64,
}

impl Point {
    fn of(row: &Row<'_>) -> Self {
        Self {
            friction: row.number(FRICTION),
            tether: row.number(TETHER),
            rate: row.number(RATE),
        }
    }
}

/// What was found at one point.
struct Sampled<'a> {
    point: Point,
    rows: Vec<Row<'a>>,
    flow: Mean,
}

impl Sampled<'_> {
    /// A force on the grains of a wavelength; front and throat are parts of the whole.
    fn force(&self, column: &str) -> Option<Mean> {
        mean(&self.rows, column)
    }

    /// The rest of a force: that of the rear, or of the bulge.
    fn rest(&self, whole: &str, part: &str) -> Option<Mean> {
        mean_of(&self.rows, |row| {
            let error = |column: &str| row.number(&format!("{column}_error"));
            (
                row.number(whole) - row.number(part),
                error(whole).hypot(error(part)),
            )
        })
    }

    /// A velocity over that of the wave.
    fn velocity(&self, column: &str) -> Option<Mean> {
        mean_of(&self.rows, |row| {
            let error = row.number(&format!("{column}_error"));
            (
                row.number(column) / row.wave_speed(),
                error / row.wave_speed(),
            )
        })
    }
}

/// All points that were sampled.
struct Samples<'a> {
    all: Vec<Sampled<'a>>,
}

impl<'a> Samples<'a> {
    fn of(results: &'a StudyResults) -> Self {
        let all = by(&results.rows(), Point::of)
            .into_iter()
            .filter_map(|(point, rows)| {
                let flow = mean(&rows, "flow_rate_ratio")?;
                Some(Sampled { point, rows, flow })
            })
            .collect();
        Self { all }
    }

    fn at(&self, point: Point) -> Option<&Sampled<'a>> {
        self.all.iter().find(|one| one.point == point)
    }

    fn friction(&self) -> Vec<&Sampled<'a>> {
        self.along(|point| point.tether == PRESET.tether && point.rate == PRESET.rate)
    }

    fn tether(&self) -> Vec<&Sampled<'a>> {
        self.along(|point| point.friction == PRESET.friction && point.rate == PRESET.rate)
    }

    fn rate(&self, tether: f64) -> Vec<&Sampled<'a>> {
        self.along(|point| point.friction == PRESET.friction && point.tether == tether)
    }

    fn along(&self, belongs: impl Fn(&Point) -> bool) -> Vec<&Sampled<'a>> {
        self.all.iter().filter(|one| belongs(&one.point)).collect()
    }

    /// How much is behind it: strain rates, and the values of the friction.
    fn statistics(&self) -> Statistics {
        let rows = |of: Vec<&Sampled<'a>>| -> Vec<Row<'a>> {
            of.iter().flat_map(|one| one.rows.clone()).collect()
        };
        let friction = behind(&rows(self.friction()), |row| row.number(FRICTION));
        let rate = behind(&rows(self.rate(PRESET.tether)), |row| row.number(RATE));
        Statistics {
            strain_rates: rate.widths,
            replicates: friction.replicates.min(rate.replicates),
            runs: self.all.iter().map(|one| one.rows.len()).sum(),
            ..friction
        }
    }
}

/// What grains do where they hardly touch the wall.
#[derive(Clone, Copy)]
struct FreeFlight {
    /// Part of the wavelength.
    part: f64,
    /// Their mean axial velocity over c.
    velocity: f64,
    /// What they contribute to J/Jmax: the rest comes from where the wall touches them.
    share: f64,
}

impl FreeFlight {
    /// Of the first run with a profile; `None` where there is none.
    fn of(results: &StudyResults, one: &Sampled<'_>) -> Result<Option<Self>, ClaimError> {
        for row in &one.rows {
            let Some(profile) = results.profile_of(row)? else {
                continue;
            };
            let [pressure, density, velocity] =
                ["wall_pressure", "density", "axial_velocity"].map(|name| profile.reals(name));
            let (pressure, density, velocity) = (pressure?, density?, velocity?);
            let largest = pressure.iter().copied().fold(0.0, f64::max);
            let (mut bins, mut free, mut flux, mut all) = (0.0, 0.0, 0.0, 0.0);
            for ((pressure, density), velocity) in pressure.iter().zip(density).zip(velocity) {
                all += density;
                if *pressure < FREE * largest && velocity.is_finite() {
                    bins += 1.0;
                    free += density;
                    flux += density * velocity / row.wave_speed();
                }
            }
            return Ok((bins > 0.0).then(|| Self {
                part: bins / pressure.len() as f64,
                velocity: flux / free,
                share: flux / all,
            }));
        }
        Ok(None)
    }
}

fn examine(evidence: &Evidence) -> Result<Finding, ClaimError> {
    let results = evidence.study("back-flow")?;
    let samples = Samples::of(results);
    let statistics = samples.statistics();
    let Some(preset) = samples.at(PRESET) else {
        return Ok(Finding::nothing("No runs yet.", statistics, &NEEDED));
    };
    let without = samples.at(Point {
        friction: 0.0,
        ..PRESET
    });
    let pinned = samples.at(Point {
        tether: PINNED,
        ..PRESET
    });
    let flight = FreeFlight::of(results, preset)?;
    let mut finding = Finding::new(
        Verdict::Answered,
        summary(preset, without, pinned),
        statistics,
        &NEEDED,
    );
    finding.varied = "friction";
    finding.paragraphs.extend(balance(preset, flight));
    finding.paragraphs.push(
        "In a steady state the forces of the wall on the grains add up to nothing over a wavelength: what the inclined wall gives by \
         normal forces, friction takes. The front is the part from the narrowest place to the widest one ahead, which the wave \
         closes; the rear opens behind the narrowest place. Throat is where the tube is narrower than on its mean."
            .to_owned(),
    );
    finding.weaknesses.push(
        "One force, 0.002 *Y d*^2, from rest, two waves; the wall's \
         springs and tethers are not those of the source, which gives none."
            .to_owned(),
    );
    finding.quantities = quantities(&samples, preset, without, pinned);
    finding.tables.push(table(&samples));
    finding.figures = figures::all(results, &samples)?;
    Ok(finding)
}

/// Value and error, as far as known.
fn said(mean: Option<Mean>) -> String {
    mean.map_or("–".to_owned(), |mean| with_error(mean.value, mean.error))
}

/// What friction and the motion of the wall have to do with it.
fn summary(
    preset: &Sampled<'_>,
    without: Option<&Sampled<'_>>,
    pinned: Option<&Sampled<'_>>,
) -> String {
    let back = |flow: &Mean| flow.value < -CLEAR * flow.error.max(0.0);
    let friction = match without {
        Some(without) if back(&without.flow) => format!(
            "Friction is not needed: *J*/*J*_{{max}} = {} without it and {} with *μ*_{{s}} = {}.",
            said(Some(without.flow)),
            said(Some(preset.flow)),
            PRESET.friction
        ),
        Some(without) if back(&preset.flow) => format!(
            "Friction is needed: *J*/*J*_{{max}} = {} with *μ*_{{s}} = {} and {} without.",
            said(Some(preset.flow)),
            PRESET.friction,
            said(Some(without.flow))
        ),
        _ => format!(
            "*J*/*J*_{{max}} = {} with *μ*_{{s}} = {}.",
            said(Some(preset.flow)),
            PRESET.friction
        ),
    };
    let wall = pinned.map_or(String::new(), |pinned| {
        let difference = pinned.flow.value - preset.flow.value;
        let error = pinned.flow.error.hypot(preset.flow.error);
        if back(&preset.flow) && back(&pinned.flow) {
            format!(
                " The wall need not move along the tube: pinned, {} remains, and pinning it changes *J*/*J*_{{max}} by {}.",
                said(Some(pinned.flow)),
                with_error(difference, error)
            )
        } else {
            format!(
                " With the wall pinned along the tube *J*/*J*_{{max}} = {}.",
                said(Some(pinned.flow))
            )
        }
    });
    format!("{friction}{wall}")
}

/// The momentum balance of the preset in words.
fn balance(preset: &Sampled<'_>, flight: Option<FreeFlight>) -> Option<String> {
    let thousandths = |mean: Mean| with_error(1e3 * mean.value, 1e3 * mean.error);
    let normal = preset.force("wall_normal_force")?;
    let tangential = preset.force("wall_tangential_force")?;
    let front = preset.force("front_tangential_force")?;
    let rear = preset.rest("wall_tangential_force", "front_tangential_force")?;
    let flight = flight.map_or(String::new(), |flight| {
        format!(
            " Over {} of the wavelength, behind the narrowest place, grains hardly touch the wall: there they fly at *v_z* = {} *c*, \
             which alone makes *J*/*J*_{{max}} = {}; where the wall touches them the other {} is made.",
            number(flight.part, 2),
            number(flight.velocity, 3),
            number(flight.share, 3),
            number(preset.flow.value - flight.share, 3),
        )
    });
    Some(format!(
        "At the preset (axial forces on the grains of a wavelength in 10^{{−3}} *Y d*^2, positive along the wave) normal forces give \
         {}, friction {}: {} in the front, where the wave closes the tube and pushes grains on, and {} in the rear, where they leave \
         it.{flight}",
        thousandths(normal),
        thousandths(tangential),
        thousandths(front),
        thousandths(rear),
    ))
}

fn quantities(
    samples: &Samples<'_>,
    preset: &Sampled<'_>,
    without: Option<&Sampled<'_>>,
    pinned: Option<&Sampled<'_>>,
) -> Vec<Quantity> {
    let flow = |name: &str, mean: Mean| Quantity {
        name: name.to_owned(),
        symbol: "*J*/*J*_{max}".to_owned(),
        unit: String::new(),
        source: None,
        ours: Some(Uncertain::normal(mean.value, mean.error)),
        method: "late mean over the replicates".to_owned(),
    };
    let mut quantities = vec![flow("flow of the preset at a small force", preset.flow)];
    quantities.extend(without.map(|one| flow("the same without friction", one.flow)));
    quantities.extend(pinned.map(|one| flow("the same with the wall pinned", one.flow)));
    quantities.extend(
        samples
            .at(Point {
                tether: 0.0,
                ..PRESET
            })
            .map(|one| flow("the same with the wall free along the tube", one.flow)),
    );
    quantities
}

fn table(samples: &Samples<'_>) -> ReportTable {
    let force = |mean: Option<Mean>| {
        mean.map_or("–".to_owned(), |m| {
            with_error(1e3 * m.value, 1e3 * m.error)
        })
    };
    let rows = samples
        .all
        .iter()
        .map(|one| {
            let parts =
                |whole: &str, part: &str| [one.force(part), one.rest(whole, part)].map(&force);
            let [normal_front, normal_rear] = parts("wall_normal_force", "front_normal_force");
            let [friction_front, friction_rear] =
                parts("wall_tangential_force", "front_tangential_force");
            let [normal_throat, normal_bulge] = parts("wall_normal_force", "narrow_normal_force");
            let [friction_throat, friction_bulge] =
                parts("wall_tangential_force", "narrow_tangential_force");
            vec![
                number(one.point.friction, 2),
                number(one.point.tether, 3),
                number(1e3 * one.point.rate, 2),
                said(Some(one.flow)),
                format!("{normal_front}, {normal_rear}"),
                format!("{friction_front}, {friction_rear}"),
                format!("{normal_throat}, {normal_bulge}"),
                format!("{friction_throat}, {friction_bulge}"),
                said(one.velocity("narrow_axial_velocity")),
                said(one.velocity("narrow_wall_velocity")),
            ]
        })
        .collect();
    ReportTable {
        caption: "Flow, axial forces of the wall on the grains of a wavelength (*F*/*Yd*^{2}), by normal forces and by friction, \
                  in front and rear and in throat and bulge, and mean axial velocities of grains and of wall spheres in the throat, \
                  against friction, axial tether (*Y d*) and strain rate (1/*t*^{\\*})."
            .to_owned(),
        head: [
            "*μ*_{s}",
            "tether",
            "10^{3}*ε̇*",
            "*J*/*J*_{max}",
            "10^{3}*F*, normal: front, rear",
            "10^{3}*F*, friction: front, rear",
            "10^{3}*F*, normal: throat, bulge",
            "10^{3}*F*, friction: throat, bulge",
            "grains, *v_z*/*c*",
            "wall, *v_z*/*c*",
        ]
        .map(str::to_owned)
        .to_vec(),
        rows,
    }
}
