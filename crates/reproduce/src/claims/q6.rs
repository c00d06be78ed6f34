//! Q6: the mechanism of back flow.

mod figures;

use super::prelude::*;

const PROSE: Prose = Prose::new(include_str!("q6.md"));

pub(super) const CLAIM: Claim =
    Claim::new("Q6", PROSE, &["back-flow"], examine).varying("friction", Q6_NEEDED);

/// Column of the coefficient of static friction.
const FRICTION: &str = "contact.static_friction";
/// The preset, about which one parameter at a time is varied.
const PRESET: Point = Point {
    friction: 0.5,
    tether: 0.01,
    rate: 4.01e-3,
};
/// A tether so stiff that the wall cannot follow the grains.
const PINNED: f64 = 1.0;

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
            tether: row.number("wall.keep.axial"),
            rate: row.strain_rate(),
        }
    }
}

/// What was found at one point.
struct Sampled<'a> {
    point: Point,
    rows: Vec<Row<'a>>,
    flow: Uncertain,
}

impl Sampled<'_> {
    /// A force on the grains of a wavelength, in thousandths; front and throat are parts of the whole.
    fn force(&self, column: &str) -> Option<Uncertain> {
        Some(mean(&self.rows, column)?.scaled(1e3))
    }

    /// The rest of a force, in thousandths: that of the rear, or of the belly. Its error is from the scatter of the runs:
    /// whole and part fluctuate together.
    fn rest(&self, whole: &str, part: &str) -> Option<Uncertain> {
        let rest = |row: &Row<'_>| row.number(whole) - row.number(part);
        let rest = scattered(&self.rows, rest);
        rest.value.is_finite().then(|| rest.scaled(1e3))
    }

    /// A velocity over the speed of the wave.
    fn velocity(&self, column: &str) -> Option<Uncertain> {
        mean_of(&self.rows, |row| {
            let ((velocity, error), speed) = (row.number_and_error(column), row.wave_speed());
            (velocity / speed, error / speed)
        })
    }

    /// Whether the flow is against the wave.
    fn flows_back(&self) -> bool {
        self.flow.is_below(0.0)
    }

    fn row(&self) -> Vec<String> {
        let parts = |kind: &str, part: &str| {
            let (whole, part) = (format!("wall_{kind}"), format!("{part}_{kind}"));
            let (force, rest) = (self.force(&part), self.rest(&whole, &part));
            format!("{}, {}", cell(force), cell(rest))
        };
        vec![
            number(self.point.friction, 2),
            number(self.point.tether, 3),
            number(1e3 * self.point.rate, 2),
            self.flow.to_string(),
            parts("normal_force", "front"),
            parts("tangential_force", "front"),
            parts("normal_force", "narrow"),
            parts("tangential_force", "narrow"),
            cell(self.velocity("narrow_axial_velocity")),
            cell(self.velocity("narrow_wall_velocity")),
        ]
    }
}

/// All points that were sampled.
#[derive(Default)]
struct Samples<'a> {
    steady: Vec<Sampled<'a>>,
    /// Where more than half of the runs still drift.
    drifting: Vec<Point>,
}

impl<'a> Samples<'a> {
    fn of(results: &'a StudyResults) -> Self {
        let mut samples = Self::default();
        for (point, all) in grouped(results.rows(), Point::of) {
            match stationary(&all) {
                Some((rows, flow)) => samples.steady.push(Sampled { point, rows, flow }),
                None => samples.drifting.push(point),
            }
        }
        samples
    }

    fn at(&self, point: Point) -> Option<&Sampled<'a>> {
        self.steady.iter().find(|one| one.point == point)
    }

    /// All that differ from the preset in its friction only.
    fn friction(&self) -> impl Iterator<Item = &Sampled<'a>> {
        self.along(|Point { friction, .. }| Point { friction, ..PRESET })
    }

    fn tether(&self) -> impl Iterator<Item = &Sampled<'a>> {
        self.along(|Point { tether, .. }| Point { tether, ..PRESET })
    }

    fn rate(&self, tether: f64) -> impl Iterator<Item = &Sampled<'a>> {
        self.along(move |Point { rate, .. }| Point {
            tether,
            rate,
            ..PRESET
        })
    }

    fn along(&self, expected: impl Fn(Point) -> Point) -> impl Iterator<Item = &Sampled<'a>> {
        let all = self.steady.iter();
        all.filter(move |one| one.point == expected(one.point))
    }

    /// The points that are left out.
    fn left_out(&self) -> Vec<String> {
        let point = |one: &Point| {
            let &Point {
                friction,
                tether,
                rate,
            } = one;
            PROSE.text("point", values!(friction, tether, rate))
        };
        self.drifting.iter().map(point).collect()
    }

    /// How much is behind it: strain rates, and the values of the friction.
    fn statistics(&self) -> Statistics {
        let friction: Vec<Row<'a>> = self.friction().flat_map(|one| one.rows.clone()).collect();
        let friction = behind(&friction, |row| row.number(FRICTION));
        let rates = self.rate(PRESET.tether).flat_map(|one| one.rows.clone());
        let rate = behind(&rates.collect::<Vec<_>>(), Row::strain_rate);
        Statistics {
            strain_rates: rate.widths,
            replicates: friction.replicates.min(rate.replicates),
            runs: self.steady.iter().map(|one| one.rows.len()).sum(),
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
    fn of(results: &StudyResults, one: &Sampled<'_>) -> Result<Option<Self>> {
        let Some((row, profile)) =
            first_kept(&one.rows, |row| results.product(row, files::PROFILE))?
        else {
            return Ok(None);
        };
        let (pressure, density) = (profile.reals("wall_pressure")?, profile.reals("density")?);
        let velocity = profile.reals("axial_velocity")?;
        let largest = pressure.iter().copied().fold(0.0, f64::max);
        let (mut bins, mut free, mut flux, mut all) = (0.0, 0.0, 0.0, 0.0);
        for ((pressure, density), velocity) in pressure.iter().zip(density).zip(velocity) {
            all += density;
            if *pressure < FREE_FLIGHT * largest && velocity.is_finite() {
                bins += 1.0;
                free += density;
                flux += density * velocity / row.wave_speed();
            }
        }
        Ok((bins > 0.0).then(|| Self {
            part: bins / pressure.len() as f64,
            velocity: flux / free,
            share: flux / all,
        }))
    }
}

fn examine(evidence: &Evidence) -> Result<Finding> {
    let results = evidence.study("back-flow")?;
    let samples = Samples::of(results);
    let statistics = samples.statistics();
    let Some(preset) = samples.at(PRESET) else {
        return Ok(PROSE.nothing(statistics));
    };
    let at_friction = |friction| samples.at(Point { friction, ..PRESET });
    let at_tether = |tether| samples.at(Point { tether, ..PRESET });
    let (without, pinned) = (at_friction(0.0), at_tether(PINNED));
    let summary = of_friction(preset, without) + &of_wall(preset, pinned);
    let mut draft = Draft::of(PROSE);
    let balance = balance(preset, FreeFlight::of(results, preset)?);
    draft.finding.paragraphs.splice(0..0, balance);
    let points = [
        ("flow of the preset at a small force", Some(preset)),
        ("the same without friction", without),
        ("the same with the wall pinned", pinned),
        ("the same with the wall free along the tube", at_tether(0.0)),
    ];
    for (name, sampled) in points {
        let flow = sampled.map(|one| one.flow);
        draft.quantity("flow", values!(name), flow);
    }
    let points = samples.left_out().join("; ");
    if !points.is_empty() {
        draft.weakness("drifting", values!(points));
    }
    draft.table("forces", &[], samples.steady.iter().map(Sampled::row));
    figures::causes(&mut draft, &samples)?;
    figures::balance(&mut draft, results, &samples)?;
    Ok(draft.concluded(Verdict::Answered, summary, statistics))
}

/// What friction has to do with it.
fn of_friction(preset: &Sampled<'_>, without: Option<&Sampled<'_>>) -> String {
    let (with, friction) = (preset.flow, PRESET.friction);
    match without {
        Some(one) if one.flows_back() => {
            let without = one.flow;
            PROSE.text("friction is not needed", values!(without, with, friction))
        }
        Some(one) if preset.flows_back() => {
            let without = one.flow;
            PROSE.text("friction is needed", values!(without, with, friction))
        }
        _ => PROSE.text("with friction", values!(with, friction)),
    }
}

/// What the motion of the wall has to do with it.
fn of_wall(preset: &Sampled<'_>, pinned: Option<&Sampled<'_>>) -> String {
    let Some(pinned) = pinned else {
        return String::new();
    };
    let sentence = if preset.flows_back() && pinned.flows_back() {
        let change = pinned.flow - preset.flow;
        PROSE.text("wall need not move", values!(pinned = pinned.flow, change))
    } else {
        PROSE.text("wall pinned", values!(pinned = pinned.flow))
    };
    format!(" {sentence}")
}

/// The momentum balance of the preset in words.
fn balance(preset: &Sampled<'_>, flight: Option<FreeFlight>) -> Option<String> {
    let (whole, part) = ("wall_tangential_force", "front_tangential_force");
    let (normal, tangential) = (preset.force("wall_normal_force")?, preset.force(whole)?);
    let (front, rear) = (preset.force(part)?, preset.rest(whole, part)?);
    let balance = PROSE.text("balance", values!(normal, tangential, front, rear));
    let Some(flight) = flight else {
        return Some(balance);
    };
    let (part, velocity) = (number(flight.part, 2), number(flight.velocity, 3));
    let other = number(preset.flow.value - flight.share, 3);
    let share = number(flight.share, 3);
    let flight = PROSE.text("free flight", values!(part, velocity, share, other));
    Some(format!("{balance} {flight}"))
}
