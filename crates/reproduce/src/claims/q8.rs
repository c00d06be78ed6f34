//! Q8: is the transition of slow waves continuous?

mod figures;

use super::prelude::*;

const PROSE: Prose = Prose::new(include_str!("q8.md"));
const STUDIES: &[&str] = &["small-speed-size", "sweep-up", "sweep-down"];

pub(super) const CLAIM: Claim =
    Claim::new("Q8", PROSE, STUDIES, examine).varying("force", Q8_NEEDED);

/// Part of the runs, at their end, over which the study takes its means.
const LATE: f64 = 0.5;

/// The stationary flow against the force in a tube of one length: runs that drift are left out, of the flow and of its
/// fluctuation.
struct Size<'a> {
    rate: f64,
    waves: f64,
    branch: Branch<'a>,
    rows: Vec<Row<'a>>,
}

impl<'a> Size<'a> {
    /// The series of forces of all strain rates and lengths.
    fn all_of(rows: Vec<Row<'a>>) -> Vec<Self> {
        grouped(rows, |row| (row.strain_rate(), row.number("waves")))
            .into_iter()
            .map(|((rate, waves), rows)| Self {
                rate,
                waves,
                branch: Branch::with(rows.iter().copied(), Control::Force, stationary),
                rows,
            })
            .collect()
    }

    /// The largest rise between two neighbouring forces.
    fn rise(&self) -> Option<Step> {
        self.branch.largest_step(|height| height)
    }

    /// Variance of the period averages of J/Jmax times the waves: that of a wave if waves fluctuate by themselves.
    fn fluctuation(&self, point: &Point<'_>) -> Option<Uncertain> {
        mean_of(&point.rows, |row| {
            let variance = row.number("flow_rate_ratio_variance");
            // As of normal numbers, one for each late period.
            let periods = row.number("periods") * LATE - 1.0;
            let error = variance * (2.0 / periods).sqrt();
            (self.waves * variance, self.waves * error)
        })
    }

    /// The fluctuation at a force.
    fn fluctuation_at(&self, force: f64) -> Option<Uncertain> {
        self.fluctuation(self.branch.at(force)?)
    }

    /// The forces at which runs still drift, in thousandths.
    fn drifting(&self) -> Vec<String> {
        let forces = grouped(self.rows.iter(), |row| row.force()).into_iter();
        let drifting = forces.filter(|(force, _)| self.branch.at(*force).is_none());
        drifting.map(|(force, _)| number(1e3 * force, 2)).collect()
    }

    /// The largest rise in words.
    fn words(&self) -> Option<String> {
        let rise = self.rise()?;
        let clear = rise.rises_by(LEAST_JUMP);
        let doubt = if clear { "" } else { " (not clear)" };
        Some(format!("{}{doubt} in {} waves", rise.height, self.waves))
    }

    fn row(&self, force: Option<f64>) -> Vec<String> {
        let rise = self.rise();
        let fluctuation = force.and_then(|force| self.fluctuation_at(force));
        let thousandths = |value: f64| number(1e3 * value, 2);
        vec![
            thousandths(self.rate),
            self.waves.to_string(),
            self.branch.points.len().to_string(),
            cell(rise.map(|rise| rise.height)),
            cell_of(rise, |rise| thousandths(rise.place().value)),
            cell(fluctuation),
            cell_of(force, thousandths),
        ]
    }
}

/// The forces, in thousandths, at which sweeps at one strain rate and of one length pass from one flow to the other.
struct Loop {
    rate: f64,
    /// Length of the sweep in periods.
    periods: f64,
    up: Option<Uncertain>,
    down: Option<Uncertain>,
    /// Sweeps up and down that ended before they passed.
    censored: [usize; 2],
    /// Largest part of the grains outside.
    escaped: f64,
}

impl Loop {
    /// The loops of all sweeps, by strain rate and length.
    fn all_of(up: Vec<Row<'_>>, down: Vec<Row<'_>>) -> Vec<Self> {
        let sweep = |row: &Row<'_>| (row.strain_rate(), row.number("drive.schedule.end"));
        let down = grouped(down, sweep);
        let pairs = grouped(up, sweep).into_iter().filter_map(|(sweep, up)| {
            let (_, down) = down.iter().find(|(other, _)| *other == sweep)?;
            Some((sweep, up, down))
        });
        pairs
            .map(|((rate, periods), up, down)| Self {
                rate,
                periods,
                up: mean_of(&up, passed),
                down: mean_of(down, passed),
                escaped: largest(up.iter().chain(down), Row::escaped_fraction),
                censored: [&up, down].map(|rows| {
                    let censored = |row: &&Row<'_>| !passed(row).0.is_finite();
                    rows.iter().filter(censored).count()
                }),
            })
            .collect()
    }

    /// Width of the loop; `None` where one way did not pass.
    fn width(&self) -> Option<Uncertain> {
        Some(distance(&self.up?, &self.down?))
    }

    /// Its width in words.
    fn words(&self) -> Option<String> {
        let width = self.width()?.scaled(1e3);
        Some(format!("{width} in {} periods", self.periods))
    }

    fn row(&self) -> Vec<String> {
        let force = |force: Option<Uncertain>| cell(force.map(|force| force.scaled(1e3)));
        vec![
            number(1e3 * self.rate, 2),
            number(self.periods, 0),
            force(self.up),
            force(self.down),
            force(self.width()),
            format!("{}, {}", self.censored[0], self.censored[1]),
            number(self.escaped, 3),
        ]
    }
}

/// The force at which a sweep passed, and half of what it changes in the period over which the flow is averaged.
fn passed(row: &Row<'_>) -> (f64, f64) {
    let [from, to, end] =
        ["from", "to", "end"].map(|key| row.number(&format!("drive.schedule.{key}")));
    let progress = row.number("transition_time") * row.strain_rate() / end;
    (
        from + (to - from) * progress.clamp(0.0, 1.0),
        0.5 * (to - from).abs() / end,
    )
}

/// What was found at one strain rate.
struct AtRate<'b, 'a> {
    rate: f64,
    sizes: Vec<&'b Size<'a>>,
    /// By ascending length.
    loops: Vec<&'b Loop>,
}

impl<'b, 'a> AtRate<'b, 'a> {
    fn all_of(sizes: &'b [Size<'a>], loops: &'b [Loop]) -> Vec<Self> {
        let of_sizes = sizes.iter().map(|one| one.rate);
        let rates = of_sizes.chain(loops.iter().map(|one| one.rate));
        grouped(rates, |rate| *rate)
            .into_iter()
            .map(|(rate, _)| Self {
                rate,
                sizes: sizes.iter().filter(|one| one.rate == rate).collect(),
                loops: loops.iter().filter(|one| one.rate == rate).collect(),
            })
            .collect()
    }

    /// Whether there are as many lengths of tubes and of sweeps as an answer takes.
    fn is_complete(&self) -> bool {
        let closed = self.loops.iter().filter(|one| one.width().is_some());
        self.sizes.len() >= LEAST_LENGTHS && closed.count() >= LEAST_LENGTHS
    }

    /// The force at which tubes of all lengths are steady and fluctuate most together.
    fn fluctuating_force(&self) -> Option<f64> {
        let first = self.sizes.first()?.branch.points.iter();
        let sum = |force: f64| -> Option<f64> {
            let each = self.sizes.iter();
            each.map(|one| Some(one.fluctuation_at(force)?.value)).sum()
        };
        let known = first.filter_map(|point| Some((point.control, sum(point.control)?)));
        let largest = known.max_by(|one, other| one.1.total_cmp(&other.1));
        largest.map(|(force, _)| force)
    }

    /// What it shows.
    fn words(&self) -> String {
        let rises: Vec<String> = self.sizes.iter().filter_map(|one| one.words()).collect();
        let widths: Vec<String> = self.loops.iter().filter_map(|one| one.words()).collect();
        let rises = match &*rises.join(", ") {
            "" => PROSE.text("no rises", &[]),
            rises => PROSE.text("rises", values!(rises)),
        };
        let sweeps = match &*widths {
            [] => PROSE.text("no sweeps", &[]),
            [widths] => PROSE.text("sweeps", values!(widths)),
            [first, .., last] => {
                PROSE.text("sweeps", values!(widths = format!("{first} to {last}")))
            }
        };
        let rate = number(1e3 * self.rate, 2);
        PROSE.text("at a strain rate", values!(rate, rises, sweeps))
    }

    fn add_quantities(&self, draft: &mut Draft) {
        let rate = &self.rate;
        for one in &self.sizes {
            let height = one.rise().map(|rise| rise.height);
            draft.quantity("rise", values!(rate, waves = one.waves), height);
        }
        let sizes = self.sizes.iter();
        let force = self.fluctuating_force().unwrap_or(f64::NAN);
        let fluctuations = sizes.filter_map(|one| Some((one.waves, one.fluctuation_at(force)?)));
        let of_size = fitted_power(fluctuations);
        draft.quantity("exponent of fluctuation", values!(rate), of_size);
        let loops = self.loops.iter();
        let widths = loops.filter_map(|one| Some((one.periods, one.width()?)));
        draft.quantity("exponent of loop", values!(rate), fitted_power(widths));
    }
}

fn examine(evidence: &Evidence) -> Result<Finding> {
    let rows = |study: &str| -> Result<_> { Ok(evidence.study(study)?.rows()) };
    let sizes = Size::all_of(rows("small-speed-size")?);
    let sweeps = [rows("sweep-up")?, rows("sweep-down")?];
    let sweep = sweeps.iter().flatten().next();
    let passed = sweep.map_or(HALF, |row| row.number("transition_threshold"));
    let [up, down] = sweeps;
    let loops = Loop::all_of(up, down);
    let rates = AtRate::all_of(&sizes, &loops);
    let of_sizes = sizes.iter().map(|one| behind(&one.rows, Row::force));
    let statistics = Statistics {
        strain_rates: rates.len(),
        ..Statistics::weakest(of_sizes)
    };
    if rates.is_empty() {
        return Ok(PROSE.nothing(statistics));
    }
    let words: Vec<String> = rates.iter().map(AtRate::words).collect();
    let verdict = Verdict::answered_if(rates.iter().all(AtRate::is_complete));
    let summary = format!("{}.", words.join(". "));
    let mut draft = Draft::of(PROSE);
    for at in &rates {
        at.add_quantities(&mut draft);
    }
    if !sizes.is_empty() {
        let of_rate = |at: &AtRate<'_, '_>| {
            let force = at.fluctuating_force();
            at.sizes
                .iter()
                .map(move |one| one.row(force))
                .collect::<Vec<_>>()
        };
        draft.table("sizes", &[], rates.iter().flat_map(of_rate));
        for one in &sizes {
            let (forces, waves) = (one.drifting(), one.waves);
            if !forces.is_empty() {
                let (rate, forces) = (number(1e3 * one.rate, 2), forces.join(", "));
                draft.weakness("drifting", values!(rate, waves, forces));
            }
        }
    }
    if !loops.is_empty() {
        draft.table("loops", &[], loops.iter().map(Loop::row));
    }
    for at in &rates {
        let escaped = at.loops.iter().map(|one| one.escaped).fold(0.0, f64::max);
        if escaped > MOST_ESCAPED {
            let (part, rate) = (number(escaped, 2), number(1e3 * at.rate, 2));
            draft.weakness("leaking", values!(part, rate));
        }
    }
    draft.finding.paragraphs = PROSE.paragraphs("method", values!(passed));
    let panels = figures::panels(&rates);
    if !panels.is_empty() {
        let chart = grid(rates.len(), panels)
            .panel_height(36.0)
            .legend(LegendPlace::Below);
        draft.chart("small-speed", values!(passed), chart)?;
    }
    Ok(draft.concluded(verdict, summary, statistics))
}
