//! Q11: what the method of computing does to the numbers.

use super::prelude::*;

const PROSE: Prose = Prose::new(include_str!("q11.md"));

pub(super) const CLAIM: Claim =
    Claim::new("Q11", PROSE, &["method-fine", "method-coarse"], examine)
        .varying("width", Q11_NEEDED);

/// How a run was computed.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
struct Method {
    /// Two-step Adams-Bashforth instead of velocity Verlet.
    is_adams_bashforth: bool,
    /// Step \[t\].
    time_step: f64,
    /// Skin \[d\].
    skin: f64,
}

impl Method {
    /// The presets' method.
    const DEFAULT: Self = Self {
        is_adams_bashforth: false,
        time_step: 0.05,
        skin: 0.3,
    };

    fn of(row: &Row<'_>) -> Self {
        Self {
            is_adams_bashforth: row.text("run.integrator") == "adams_bashforth",
            time_step: row.number_or("run.time_step", Self::DEFAULT.time_step),
            skin: row.number_or("run.neighbour_skin", Self::DEFAULT.skin),
        }
    }

    fn integrator(self) -> &'static str {
        if self.is_adams_bashforth {
            "Adams-Bashforth"
        } else {
            "Verlet"
        }
    }
}

/// What came out with one method on one lattice.
struct Outcome {
    method: Method,
    critical: Uncertain,
    /// Mean J/Jmax at the narrowest and at the widest bottleneck.
    ends: [Uncertain; 2],
}

impl Outcome {
    fn of(method: Method, rows: &[Row<'_>]) -> Option<Self> {
        let critical = crossing(rows)?.width;
        let at_widths = grouped(rows.iter().copied(), Row::width);
        let mean = |(_, here): &(f64, Vec<Row<'_>>)| {
            let flow = scattered(here, Row::flow_rate_ratio);
            // A single run has no scatter.
            Uncertain::normal(flow.value, if here.len() > 1 { flow.error } else { 0.0 })
        };
        Some(Self {
            method,
            critical,
            ends: [mean(at_widths.first()?), mean(at_widths.last()?)],
        })
    }

    fn is_usual(&self) -> bool {
        self.method == Method::DEFAULT
    }

    fn shift(&self, usual: &Self) -> Uncertain {
        self.critical - usual.critical
    }

    fn row(&self, lattice: &str, usual: &Self) -> Vec<String> {
        let shift = match self.is_usual() {
            true => NONE.to_owned(),
            false => self.shift(usual).to_string(),
        };
        vec![
            lattice.to_owned(),
            self.method.integrator().to_owned(),
            self.method.time_step.to_string(),
            self.method.skin.to_string(),
            self.critical.to_string(),
            shift,
            self.ends[0].to_string(),
            self.ends[1].to_string(),
        ]
    }
}

fn examine(evidence: &Evidence) -> Result<Finding> {
    let (mut all, mut panels, mut words) = (Vec::new(), Vec::new(), Vec::new());
    let (mut draft, mut rows) = (Draft::of(PROSE), Vec::new());
    for (study, lattice) in [("method-fine", "fine"), ("method-coarse", "coarse")] {
        let groups = grouped(evidence.study(study)?.rows(), Method::of);
        all.extend(groups.iter().map(|(_, rows)| behind(rows, Row::width)));
        let outcomes: Vec<Outcome> = groups
            .iter()
            .filter_map(|(method, rows)| Outcome::of(*method, rows))
            .collect();
        let Some(usual) = outcomes.iter().find(|one| one.is_usual()) else {
            continue;
        };
        // Larger steps are told in the table only.
        let is_finer =
            |one: &&Outcome| !one.is_usual() && one.method.time_step <= usual.method.time_step;
        let most = outcomes
            .iter()
            .filter(is_finer)
            .map(|one| one.shift(usual))
            .max_by(|one, other| one.value.abs().total_cmp(&other.value.abs()))
            .unwrap_or(Uncertain::normal(0.0, 0.0));
        words.push(PROSE.text("lattice", values!(lattice, shift = most)));
        rows.extend(outcomes.iter().map(|one| one.row(lattice, usual)));
        for one in &outcomes {
            let integrator = one.method.integrator();
            let (step, skin, width) = (one.method.time_step, one.method.skin, one.critical);
            draft.quantity(
                "critical width",
                values!(lattice, integrator, step, skin),
                width,
            );
        }
        panels.push(against_step(lattice, &outcomes));
    }
    // One strain rate a lattice, whatever the number of methods.
    let statistics = Statistics::weakest_at_one_rate(all.into_iter());
    if panels.is_empty() {
        return Ok(PROSE.nothing(statistics));
    }
    let summary = PROSE.text("summary", values!(lattices = words.join("; ")));
    draft.table("methods", &[], rows);
    let chart = grid(panels.len(), panels);
    draft.chart("method", &[], chart)?;
    Ok(draft.concluded(Verdict::Answered, summary, statistics))
}

/// How far points at one step are apart.
const ASIDE: f64 = 1.015;

/// Critical width against the step, one series an integrator, at the usual skin.
fn against_step(lattice: &str, outcomes: &[Outcome]) -> ChartPanel {
    let series = [false, true].map(|is_adams_bashforth| {
        let method = Method {
            is_adams_bashforth,
            ..Method::DEFAULT
        };
        let here = outcomes.iter().filter(|Outcome { method: one, .. }| {
            one.is_adams_bashforth == is_adams_bashforth && one.skin == method.skin
        });
        // Bars of both integrators at one step stand beside each other.
        let aside = if is_adams_bashforth {
            ASIDE
        } else {
            1.0 / ASIDE
        };
        let widths = here.map(|one| (aside * one.method.time_step, one.critical));
        joined(method.integrator(), widths)
    });
    let time_step = "time step, *h* (*k*/*m*)^{1/2}";
    ChartPanel::new(time_step, &label(Axis::CriticalWidth))
        .title(&format!("{lattice} lattice"))
        .x_scale(Scale::Logarithmic)
        .with_all(numbered(series))
}
