//! S6: unjammed flow of frictional grains in the elastic tube beside that of frictionless grains in the prescribed one.

mod figures;

use peristalsis_analysis::mean_and_error;

use super::elastic::*;
use super::prelude::*;

const PROSE: Prose = Prose::new(include_str!("s6.md"));
const STUDIES: &[&str] = &[
    "elastic-flow",
    "elastic-branches",
    "unjammed-frictionless",
    "matched-bottlenecks",
    "two-by-two-strain",
    "two-by-two-stress",
];

pub(super) const CLAIM: Claim = claim("S6", PROSE, STUDIES, examine);

/// Symbol of a number, and its value in a run.
type Number = (&'static str, fn(&Row<'_>) -> f64);

/// Axial velocity in the throat over c: back flow where it is negative.
const VELOCITY: Number = ("*v*_{throat}/*c*", |row| {
    row.number("throat_axial_velocity") / row.wave_speed()
});
/// What is shown of each flow, free of units.
const NUMBERS: [Number; 6] = [
    VELOCITY,
    ("*v*_{belly}/*c*", |row| {
        row.number("belly_axial_velocity") / row.wave_speed()
    }),
    ("*n*_{1,throat}/*n*_{1,belly}", |row| {
        row.number("throat_density") / row.number("belly_density")
    }),
    ("*T*_{throat}/*mc*^{2}", |row| {
        row.number("throat_granular_temperature") / row.wave_speed().powi(2)
    }),
    ("*T*_{belly}/*mc*^{2}", |row| {
        row.number("belly_granular_temperature") / row.wave_speed().powi(2)
    }),
    ("*J*/*J*_{max}", |row| row.flow_rate_ratio()),
];

/// One flow: the runs of one point.
struct Flow<'a> {
    name: String,
    rows: Vec<Row<'a>>,
}

/// Whether a run is unjammed and stationary and holds its grains.
fn counts(row: &Row<'_>) -> bool {
    row.is_stationary()
        && row.flow_rate_ratio() < UNJAMMED
        && row.escaped_fraction() <= MOST_ESCAPED
        && row.number("throat_density").is_finite()
}

impl<'a> Flow<'a> {
    /// The flow of those of some runs that count; `None` without one.
    fn of(name: String, rows: impl IntoIterator<Item = Row<'a>>) -> Option<Self> {
        let rows: Vec<Row<'a>> = rows.into_iter().filter(counts).collect();
        (!rows.is_empty()).then_some(Self { name, rows })
    }

    fn row(&self) -> Vec<String> {
        let means = NUMBERS.iter().map(|(_, value)| {
            let mean = scattered(&self.rows, value);
            if mean.error.is_finite() {
                mean.to_string()
            } else {
                number(mean.value, 4)
            }
        });
        [self.name.clone(), self.rows.len().to_string()]
            .into_iter()
            .chain(means)
            .collect()
    }
}

/// The unjammed flows of frictional grains from rest.
fn frictional<'a>(lines: &[ForceLine<'a>]) -> Vec<Flow<'a>> {
    let points = lines.iter().flat_map(|line| {
        let points = line.flow.rest.points.iter();
        points.map(move |point| (line.strain_rate, point))
    });
    let flow = |(rate, point): (f64, &Point<'a>)| {
        let name = format!("frictional, *f*^{{P}} = {}, *ε̇* = {rate}", point.control);
        Flow::of(name, point.rows.iter().copied())
    };
    points.filter_map(flow).collect()
}

/// The unjammed flows of frictionless grains between prescribed walls.
fn frictionless<'a>(rows: &[Row<'a>]) -> Vec<Flow<'a>> {
    by_strain_rate(rows.iter().copied())
        .into_iter()
        .filter_map(|(rate, here)| {
            let width = here[0].width();
            let name = format!("frictionless, prescribed wall, *w* = {width} *d*, *ε̇* = {rate}");
            Flow::of(name, here)
        })
        .collect()
}

/// The unjammed runs of both models at one strain rate and one bottleneck.
struct Matched {
    strain_rate: f64,
    /// In parts of the tube's diameter.
    bottleneck: f64,
    /// Axial velocity in the throat over c of each run, frictional and frictionless.
    velocities: [Vec<f64>; 2],
}

/// The bottleneck in parts of the tube's diameter.
fn reduced(row: &Row<'_>) -> f64 {
    row.number("bottleneck") / (2.0 * row.radius())
}

impl Matched {
    /// For each flow of frictionless grains between prescribed walls the frictional runs, at the same strain rate, whose
    /// bottleneck is that one within [`MATCHED`].
    fn all(frictional: &[Row<'_>], frictionless: &[Row<'_>]) -> Vec<Self> {
        let (_, velocity) = VELOCITY;
        let flows = grouped(frictionless.iter().copied(), |row| {
            (row.strain_rate(), row.width())
        });
        let matched = flows.into_iter().filter_map(|((strain_rate, _), here)| {
            let bottleneck = scattered(&here, reduced).value;
            let is_matched = |row: &&Row<'_>| {
                let apart = (reduced(row) - bottleneck).abs();
                row.strain_rate() == strain_rate && apart <= MATCHED
            };
            let there: Vec<f64> = frictional.iter().filter(is_matched).map(velocity).collect();
            (!there.is_empty()).then(|| Self {
                strain_rate,
                bottleneck,
                velocities: [there, here.iter().map(velocity).collect()],
            })
        });
        let mut matched: Vec<Self> = matched.collect();
        // Two bottlenecks that match one another have the same frictional runs, and count once.
        matched.dedup_by(|next, kept| {
            let apart = (next.bottleneck - kept.bottleneck).abs();
            next.strain_rate == kept.strain_rate && apart <= MATCHED
        });
        matched
    }

    /// Distance that [`WITHIN_A_MODEL`] of the pairs of runs of one model do not exceed; `None` without a pair.
    fn within(&self) -> Option<f64> {
        let pairs = self.velocities.iter().flat_map(|those| {
            let others = |place: usize| those[place + 1..].iter();
            let each = those.iter().enumerate();
            each.flat_map(move |(place, one)| others(place).map(move |other| (one - other).abs()))
        });
        let distances = ascending(pairs);
        let last = distances.len().checked_sub(1)?;
        Some(distances[(WITHIN_A_MODEL * last as f64).ceil() as usize])
    }

    /// Pairs of runs of both models in which the frictional grains are the slower by more than that, and all pairs.
    fn beyond(&self) -> Option<(usize, usize)> {
        let within = self.within()?;
        let [frictional, frictionless] = &self.velocities;
        let slower = |one: &f64| {
            frictionless
                .iter()
                .filter(|other| **other - one > within)
                .count()
        };
        let beyond = frictional.iter().map(slower).sum();
        Some((beyond, frictional.len() * frictionless.len()))
    }

    /// Whether most pairs of both models are.
    fn differs(&self) -> Option<bool> {
        let (beyond, pairs) = self.beyond()?;
        Some(2 * beyond > pairs)
    }

    /// Mean velocities of both models.
    fn means(&self) -> [Uncertain; 2] {
        self.velocities.each_ref().map(|those| {
            let (mean, error) = mean_and_error(those);
            Uncertain::normal(mean, error)
        })
    }

    fn row(&self) -> Vec<String> {
        let [frictional, frictionless] = self.means().map(|mean| mean.to_string());
        let beyond = |(beyond, pairs): (usize, usize)| format!("{beyond}/{pairs}");
        vec![
            self.strain_rate.to_string(),
            number(self.bottleneck, 3),
            frictional,
            frictionless,
            cell_of(self.within(), |within| number(within, 4)),
            cell_of(self.beyond(), beyond),
        ]
    }
}

fn examine(evidence: &Evidence) -> Result<Finding> {
    let elastic = evidence.study("elastic-flow")?;
    let prescribed = evidence.study("unjammed-frictionless")?;
    let branches = evidence.study("elastic-branches")?.rows();
    let lines = ForceLine::all_of(&branches);
    let flows = [frictional(&lines), frictionless(&prescribed.rows())];
    if flows.iter().any(Vec::is_empty) {
        return Ok(PROSE.nothing(Statistics::default()));
    }
    let mut with_friction = evidence.study("two-by-two-stress")?.rows();
    with_friction.retain(|row| !is_frictionless(row));
    with_friction.extend(branches);
    let mut without = evidence.study("two-by-two-strain")?.rows();
    without.retain(is_frictionless);
    without.extend(prescribed.rows());
    without.extend(evidence.study("matched-bottlenecks")?.rows());
    for rows in [&mut with_friction, &mut without] {
        rows.retain(counts);
    }
    let matched = Matched::all(&with_friction, &without);
    let places = matched
        .iter()
        .map(|one| (rounded(one.bottleneck), one.differs()));
    let places = Rates::of(places);
    let verdict = Verdict::of(places.hold());
    let count = places.count();
    let summary = PROSE.text("summary", values!(count));
    let mut draft = Draft::of(PROSE);
    for one in &matched {
        let (rate, bottleneck) = (one.strain_rate, rounded(one.bottleneck));
        for (grains, mean) in ["frictional", "frictionless"].iter().zip(one.means()) {
            draft.quantity("velocity", values!(grains, bottleneck, rate), mean);
        }
    }
    draft.table("matched", &[], matched.iter().map(Matched::row));
    let mut table = PROSE.table(
        "flows",
        values!(unjammed = UNJAMMED),
        flows.iter().flatten().map(Flow::row),
    );
    let symbols = NUMBERS.iter().map(|(symbol, _)| (*symbol).to_owned());
    table.head.extend(symbols);
    draft.finding.tables.push(table);
    draft.paragraph("tubes", &[]);
    let (apart, within) = (100.0 * MATCHED, 100.0 * WITHIN_A_MODEL);
    draft.paragraph("method", values!(apart, within, unjammed = UNJAMMED));
    if !matched.is_empty() {
        draft.chart("matched", &[], throats(&matched))?;
    }
    figures::profiles(&mut draft, elastic, prescribed)?;
    let statistics = together(judged(&lines));
    Ok(draft.concluded(verdict, summary, statistics))
}

/// Velocities in the throat of both models against the bottleneck, a panel for each strain rate.
fn throats(matched: &[Matched]) -> ChartFigure {
    let panels = matched.chunk_by(|one, next| one.strain_rate == next.strain_rate);
    let panels = panels.map(|here| {
        let model = |(place, name): (usize, &str)| {
            let means = here.iter().map(|one| (one.bottleneck, one.means()[place]));
            joined(name, means).map(|points| points.series(place))
        };
        let models = ["frictional", "frictionless"].into_iter().enumerate();
        let panel = ChartPanel::new("bottleneck, *w*/2*a*", "velocity, *v_z*/*c*");
        let panel = panel.title(&format!("*ε̇* = {}", here[0].strain_rate));
        panel.with_all(models.flat_map(model))
    });
    ChartFigure::grid(1, panels).share_x()
}

/// To three digits behind the point.
fn rounded(number: f64) -> f64 {
    (1000.0 * number).round() / 1000.0
}
