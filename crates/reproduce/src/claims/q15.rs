//! Q15: whether a silo discharges as Beverloo's law says.

use peristalsis_analysis::{LineFit, chi_squared_tail, fit_line_to_scatter, power_exponent};

use super::prelude::*;

const PROSE: Prose = Prose::new(include_str!("q15.md"));

/// Against the outlet, wide and small, against the filling, against the feed.
const STUDIES: &[&str] = &["silo", "silo-arches", "silo-head", "silo-feed"];

pub(super) const CLAIM: Claim =
    Claim::new("Q15", PROSE, STUDIES, examine).varying("outlet", Q15_NEEDED);

/// Beverloo's exponent.
const EXPONENT: f64 = 2.5;
/// Diameter of a wall sphere, by which the clear outlet is narrower than w \[d\].
const WALL_SPHERE: f64 = 1.0;
/// Outlets from 4 d on, to which the law is fitted: none of them is blocked for long \[d\].
const OPEN: f64 = 3.9;
/// The outlet plane lies so far below the middle of the narrowest place of the studies' silo \[d\].
const BELOW: f64 = 1.0;
/// Part of a run over an outlet that is late: `observe.late_fraction` of both studies.
const LATE: f64 = 0.5;

/// The runs at one value of what a study varies.
struct Point {
    /// The value.
    at: f64,
    /// Late mass discharged per time, of the runs that still flow.
    rate: Uncertain,
    /// Late mass in the tube.
    hold_up: Uncertain,
    /// Runs whose outlet lets nothing through at the end, and all.
    blocked: (usize, usize),
    /// Mass that all of them discharged before their late part, in which an arch is not seen \[m\].
    discharged: f64,
}

impl Point {
    fn all_of(rows: Vec<Row<'_>>, at: impl Fn(&Row<'_>) -> f64) -> Vec<Self> {
        let groups = grouped(rows, at).into_iter();
        let of = |(at, rows): (f64, Vec<Row<'_>>)| {
            let flows = |row: &Row<'_>| row.number("discharge_rate") > 0.0;
            let flowing: Vec<Row<'_>> = rows.iter().copied().filter(flows).collect();
            let early = |row: &Row<'_>| {
                row.number("discharged") - LATE * row.time() * row.number("discharge_rate")
            };
            Self {
                at,
                rate: mean(&flowing, "discharge_rate").unwrap_or(Uncertain::normal(0.0, 0.0)),
                hold_up: mean(&rows, "hold_up").unwrap_or(Uncertain::normal(f64::NAN, f64::NAN)),
                blocked: (rows.len() - flowing.len(), rows.len()),
                discharged: rows.iter().map(early).sum(),
            }
        };
        groups.map(of).collect()
    }

    /// The rate with the value, for a figure.
    fn rate(&self) -> (f64, Uncertain) {
        (self.at, self.rate)
    }

    fn blocked(&self) -> String {
        format!("{}/{}", self.blocked.0, self.blocked.1)
    }

    /// Mean mass between two arches, M \[m\]: the likeliest of an exponential distribution of which the runs that flow on in
    /// their late part are censored where it begins, the mass of all runs until then over the arches; its error is M over the
    /// root of their number. `None` without one.
    fn mean_mass(&self) -> Option<Uncertain> {
        let arches = self.blocked.0 as f64;
        let mass = self.discharged / arches;
        (arches > 0.0).then(|| Uncertain::normal(mass, mass / arches.sqrt()))
    }

    /// The mean mass in words; of outlets without an arch what it exceeds at a chance of e^{-3}, 5 %.
    fn in_words(&self) -> String {
        match self.mean_mass() {
            Some(mass) => mass.to_string(),
            None => format!("> {}", number(self.discharged / 3.0, 0)),
        }
    }
}

/// Beverloo's law W = C (D - k)^n, fitted to some outlets.
struct Beverloo {
    /// k with n = 5/2.
    offset: Uncertain,
    /// C with n = 5/2.
    constant: f64,
    /// n, with k free as well.
    exponent: Uncertain,
}

impl Beverloo {
    fn fitted(points: &[&Point]) -> Option<Self> {
        let (outlet, rate): (Vec<f64>, Vec<Uncertain>) = points.iter().map(|it| it.rate()).unzip();
        // W^(2/5) is a line in D that is 0 at k.
        let root = |rate: &Uncertain| rate.value.powf(1.0 / EXPONENT);
        let roots: Vec<f64> = rate.iter().map(root).collect();
        let relative = |rate: &Uncertain| root(rate) * rate.error / (EXPONENT * rate.value);
        let errors: Vec<f64> = rate.iter().map(relative).collect();
        let line = fit_line_to_scatter(&outlet, &roots, &errors).ok()?.line;
        let (slope, offset) = (line.slope.value, -line.intercept.value / line.slope.value);
        let variance = line.intercept.error.powi(2)
            + 2.0 * offset * line.covariance
            + (offset * line.slope.error).powi(2);
        Some(Self {
            offset: Uncertain::normal(offset, variance.max(0.0).sqrt() / slope),
            constant: slope.powf(EXPONENT),
            exponent: Self::exponent(&outlet, &rate)?,
        })
    }

    /// n and its error where k is free: the exponents of all k whose chi^2 is by one at most above the least, in units of
    /// chi^2 a degree of freedom.
    fn exponent(outlet: &[f64], rate: &[Uncertain]) -> Option<Uncertain> {
        let least = outlet.iter().copied().fold(f64::INFINITY, f64::min);
        let values: Vec<f64> = rate.iter().map(|rate| rate.value).collect();
        let errors: Vec<f64> = rate.iter().map(|rate| rate.error).collect();
        let fits = spaced(0.0, least - 0.1, OFFSETS)
            .into_iter()
            .filter_map(|offset| {
                let beyond: Vec<f64> = outlet.iter().map(|outlet| outlet - offset).collect();
                power_exponent(&beyond, &values, &errors).ok()
            });
        let fits: Vec<LineFit> = fits.collect();
        let by_chi =
            |one: &&LineFit, other: &&LineFit| one.chi_squared.total_cmp(&other.chi_squared);
        let best = fits.iter().min_by(by_chi)?;
        let unit =
            (best.chi_squared / best.degrees_of_freedom.saturating_sub(1).max(1) as f64).max(1.0);
        let near = fits
            .iter()
            .filter(|fit| fit.chi_squared <= best.chi_squared + unit);
        let (from, to) = ends(near.map(|fit| fit.slope.value))?;
        let own = best.slope.error * best.scale_factor();
        Some(Uncertain::normal(
            best.slope.value,
            own.max(0.5 * (to - from)),
        ))
    }

    fn rate(&self, outlet: f64) -> f64 {
        self.constant * (outlet - self.offset.value).max(0.0).powf(EXPONENT)
    }
}

/// Values of k that are tried.
const OFFSETS: usize = 400;

fn examine(evidence: &Evidence) -> Result<Finding> {
    let [outlets, small, heads, feeds] = [0, 1, 2, 3].map(|place| evidence.study(STUDIES[place]));
    let outlet = |row: &Row<'_>| row.width() - WALL_SPHERE;
    let mut rows = outlets?.rows();
    rows.extend(small?.rows());
    let statistics = behind(&rows, Row::width);
    let outlets = Point::all_of(rows, outlet);
    let small = || outlets.iter().filter(|it| it.at < OPEN);
    let head_rows = heads?.rows();
    // The clear diameter of the tube above the hopper.
    let bore = head_rows
        .first()
        .map_or(f64::NAN, |row| 2.0 * row.radius() - WALL_SPHERE);
    let heads = Point::all_of(head_rows, |row| row.number("inlet.head") - BELOW);
    let feeds = Point::all_of(feeds?.rows(), |row| row.number("inlet.feed_rate"));
    let open: Vec<&Point> = outlets
        .iter()
        .filter(|it| it.at > OPEN && it.rate.value > 0.0)
        .collect();
    let Some(law) = Beverloo::fitted(&open) else {
        return Ok(PROSE.nothing(statistics));
    };
    let mut draft = Draft::of(PROSE);
    draft.compared("exponent", &[], law.exponent, EXPONENT);
    draft.quantity("offset", &[], law.offset);
    draft.table(
        "outlets",
        &[],
        outlets.iter().map(|point| {
            let ratio = point.rate.value / law.rate(point.at);
            let told = (point.rate.value > 0.0 && law.rate(point.at) > 0.0).then_some(ratio);
            vec![
                number(point.at, 2),
                point.rate.to_string(),
                cell_of(told, |it| number(it, 2)),
                point.blocked(),
            ]
        }),
    );
    let row = |point: &Point| {
        vec![
            number(point.at, 1),
            point.rate.to_string(),
            point.hold_up.to_string(),
        ]
    };
    draft.table("heads", &[], heads.iter().map(row));
    draft.table("feeds", &[], feeds.iter().map(row));
    draft.table(
        "arches",
        &[],
        small().map(|it| vec![number(it.at, 2), it.blocked(), it.in_words()]),
    );
    for it in small() {
        let outlet = number(it.at, 2);
        draft.quantity("mass", values!(outlet), it.mean_mass());
    }
    // Of the outlets without an arch the smallest says most.
    let told = 1 + small().take_while(|it| it.blocked.0 > 0).count();
    let masses = small().take(told).map(|it| {
        let outlet = number(it.at, 2);
        PROSE.text("mass", values!(mass = it.in_words(), outlet))
    });
    let masses = masses.collect::<Vec<_>>().join(", ");
    let arches = match small().any(|it| it.blocked.0 > 0) {
        true => PROSE.text("arches", values!(masses)),
        false => PROSE.text("no arches", &[]),
    };
    let head = fillings(&heads, bore);
    let feed = change(&feeds);
    let charts = [
        outlet_panel(&outlets, &law),
        rate_panel("filling above the outlet, *H*/*d*", &heads),
        feed_panel(&feeds),
    ];
    draft.chart("rates", &[], grid(3, charts).legend(LegendPlace::Below))?;
    let parts = [Some(arches), head, feed].into_iter().flatten();
    let rest = parts.collect::<Vec<_>>().join(" ");
    let summary = PROSE.text(
        "summary",
        values!(
            exponent = law.exponent.to_string(),
            offset = law.offset.to_string(),
            rest
        ),
    );
    Ok(draft.concluded(Verdict::Answered, summary, statistics))
}

/// How the rate depends on the filling: by how much it varies above one bore, and what the lowest filling discharges.
fn fillings(heads: &[Point], bore: f64) -> Option<String> {
    let (low, full) = (heads.first()?, heads.last()?);
    let high: Vec<Uncertain> = heads
        .iter()
        .filter(|point| point.at >= bore)
        .map(|point| point.rate)
        .collect();
    let mean = weighted_mean(&high)?.value;
    let chi_squared: f64 = high
        .iter()
        .map(|rate| rate.deviations_from(mean).powi(2))
        .sum();
    let free = high.len().checked_sub(1).filter(|free| *free > 0)?;
    let off_mean = high.iter().map(|rate| (rate.value - mean).abs());
    let farthest = off_mean.fold(0.0, f64::max);
    let less = full.rate - low.rate;
    let part = 100.0 / full.rate.value;
    let outcome = match chi_squared_tail(chi_squared, free) > BY_CHANCE {
        true => PROSE.text("agree", &[]),
        false => PROSE.text("differ", &[]),
    };
    Some(PROSE.text(
        "head",
        values!(
            outcome,
            bore = number(bore, 0),
            full = number(full.at, 0),
            spread = number(100.0 * farthest / mean, 0),
            chi = number(chi_squared, 1),
            free,
            low = number(low.at, 0),
            less = number(part * less.value, 0),
            error = number(part * less.error, 0)
        ),
    ))
}

/// What happens where the silo no longer takes all that is fed.
fn change(feeds: &[Point]) -> Option<String> {
    let takes = |point: &&Point| point.rate.interval_95.contains(point.at);
    let dilute = feeds.iter().take_while(takes).last()?;
    let dense = feeds.iter().find(|point| point.at > dilute.at)?;
    let [before, after] = [dilute, dense].map(|point| point.rate.to_string());
    let [thin, thick] = [dilute, dense].map(|point| number(point.hold_up.value, 0));
    let fall = dilute.rate - dense.rate;
    let drop = if fall.is_above(0.0) {
        "a drop"
    } else {
        "no drop"
    };
    Some(PROSE.text(
        "change",
        values!(
            feed = number(dilute.at, 1),
            next = number(dense.at, 1),
            before,
            after,
            thin,
            thick,
            drop
        ),
    ))
}

/// Name of the axis of the discharge.
const DISCHARGE: &str = "discharge, *W* *t*/*m*";

fn outlet_panel(outlets: &[Point], law: &Beverloo) -> ChartPanel {
    let flows = outlets.iter().filter(|point| point.rate.value > 0.0);
    let (least, most) = ends(outlets.iter().map(|point| point.at)).unwrap_or((0.0, 1.0));
    let x = spaced(least.max(law.offset.value), most, 100);
    let y: Vec<f64> = x.iter().map(|outlet| law.rate(*outlet)).collect();
    ChartPanel::new("clear outlet, *D*/*d*", DISCHARGE)
        .with(Curve::new("Beverloo, exponent 5/2", &x, &y).tint(Tint::Black))
        .with_all(points("measured", flows.map(Point::rate)).map(|it| it.series(0)))
}

fn rate_panel(x: &str, all: &[Point]) -> ChartPanel {
    ChartPanel::new(x, DISCHARGE)
        .y_range(0.0..)
        .with_all(points("measured", all.iter().map(Point::rate)).map(|it| it.series(0)))
}

fn feed_panel(feeds: &[Point]) -> ChartPanel {
    let most = feeds.iter().map(|point| point.at).fold(0.0, f64::max);
    let fed = [0.0, most];
    rate_panel("feed, grains per *t*", feeds).with(
        Curve::new("all that is fed", &fed, &fed)
            .tint(Tint::Grey)
            .pattern(Pattern::Dashed),
    )
}
