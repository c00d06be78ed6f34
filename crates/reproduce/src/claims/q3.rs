//! Q3: softness or geometry.

use super::prelude::*;

const PROSE: Prose = Prose::new(include_str!("q3.md"));
const STUDIES: &[&str] = &["restitution", "softness", "wavelength", "radius"];

pub(super) const CLAIM: Claim =
    Claim::new("Q3", PROSE, STUDIES, examine).varying("width", Q3_NEEDED);

/// One parameter that is varied, in a study of its name.
struct Varied {
    name: &'static str,
    axis: &'static str,
    scale: Scale,
    value: fn(&Row<'_>) -> f64,
    /// Names of its series and what belongs to them.
    series: &'static [Series],
}

type Series = (&'static str, fn(&Critical) -> bool);

const ALL: &[Series] = &[("", |_| true)];
/// What is kept as the wavelength varies.
const AT_FIXED: &[Series] = &[
    ("*c* = 1", |one| (one.wave_speed - 1.0).abs() < 1e-6),
    ("*ε̇* = 0.1", |one| (one.strain_rate - 0.1).abs() < 1e-6),
];

const VARIED: [Varied; 4] = [
    Varied {
        name: "restitution",
        axis: "restitution, *e*",
        scale: Scale::Linear,
        value: |row| row.restitution(),
        series: ALL,
    },
    Varied {
        name: "softness",
        axis: "softness, *c*(*m*/*k*)^{1/2}/*d*",
        scale: Scale::Logarithmic,
        value: softness,
        series: ALL,
    },
    Varied {
        name: "wavelength",
        axis: "wavelength, *λ*/*a*",
        scale: Scale::Logarithmic,
        value: |row| row.wavelength() / row.radius(),
        series: AT_FIXED,
    },
    Varied {
        name: "radius",
        axis: "radius, *a*/*d*",
        scale: Scale::Logarithmic,
        value: |row| row.radius(),
        series: ALL,
    },
];

fn softness(row: &Row<'_>) -> f64 {
    row.wave_speed() / row.stiffness().sqrt()
}

/// A critical width with what belongs to it.
struct Critical {
    value: f64,
    wave_speed: f64,
    strain_rate: f64,
    radius: f64,
    crossing: Crossing,
    /// Fraction of the grains outside the tube at widths next to it.
    escaped: f64,
}

impl Critical {
    fn of(value: f64, rows: &[Row<'_>]) -> Option<Self> {
        let crossing = Crossing::of(rows)?;
        Some(Self {
            value,
            strain_rate: rows[0].strain_rate(),
            wave_speed: rows[0].wave_speed(),
            radius: rows[0].radius(),
            escaped: leak(rows, Some(crossing.width.value)),
            crossing,
        })
    }

    /// A width over 2 a.
    fn part(&self, width: Uncertain) -> Uncertain {
        width.scaled(0.5 / self.radius)
    }

    /// w_c/(2 a).
    fn fraction(&self) -> Uncertain {
        self.part(self.crossing.width)
    }

    /// Whether it counts: the tube holds its grains, and the threshold hardly matters.
    fn counts(&self) -> bool {
        self.escaped <= MOST_ESCAPED && self.crossing.is_sharp()
    }

    fn row(&self, varied: &Varied) -> Vec<String> {
        vec![
            varied.name.to_owned(),
            number(self.value, 3),
            number(self.wave_speed, 2),
            number(self.strain_rate, 4),
            self.crossing.width.to_string(),
            number(self.fraction().value, 3),
            cell_of(self.crossing.higher, |width| {
                number(self.part(width).value, 3)
            }),
            number(self.escaped, 3),
        ]
    }

    /// The parameter and w_c/(2 a).
    fn point(&self) -> (f64, Uncertain) {
        (self.value, self.fraction())
    }
}

fn examine(evidence: &Evidence) -> Result<Finding> {
    let mut all = Vec::new();
    let mut found: Vec<(&Varied, Vec<Critical>)> = Vec::new();
    for varied in &VARIED {
        let rows = evidence.study(varied.name)?.rows();
        let mut of = Vec::new();
        for ((value, _), rows) in grouped(rows, |row| ((varied.value)(row), row.strain_rate())) {
            all.push(behind(&rows, Row::width));
            of.extend(Critical::of(value, &rows));
        }
        if !of.is_empty() {
            found.push((varied, of));
        }
    }
    if found.is_empty() {
        return Ok(PROSE.nothing(Statistics::default()));
    }
    let spans = found.iter().flat_map(|(varied, of)| {
        let series = varied.series.iter();
        series.filter_map(|(name, belongs)| {
            let of = of.iter().filter(|one| belongs(one) && one.counts());
            let at = if name.is_empty() { "" } else { " at " };
            Some(format!("{} with {}{at}{name}", span(of)?, varied.name))
        })
    });
    let spans: Vec<String> = spans.collect();
    let is_known = !spans.is_empty();
    let statistics = Statistics::weakest_at_one_rate(all.into_iter());
    let summary = match is_known {
        true => PROSE.text("summary", values!(spans = spans.join(", "))),
        false => PROSE.text("none counts", &[]),
    };
    let mut draft = Draft::of(PROSE);
    let each = || {
        found
            .iter()
            .flat_map(|(varied, of)| of.iter().map(move |one| (varied, one)))
    };
    let rows = each().map(|(varied, one)| one.row(varied));
    draft.table("critical widths", &[], rows);
    for (varied, one) in each().filter(|(_, one)| one.counts()) {
        let (varied, width) = (varied.name, one.crossing.width);
        let (value, speed) = (number(one.value, 3), number(one.wave_speed, 2));
        draft.quantity("critical width", values!(varied, value, speed), width);
    }
    let panels = found.iter().map(|(varied, of)| against(varied, of));
    let chart = grid(2, panels).legend(LegendPlace::Below);
    draft.chart("softness-or-geometry", &[], chart)?;
    let verdict = Verdict::answered_if(is_known);
    Ok(draft.concluded(verdict, summary, statistics))
}

/// The largest less the smallest w_c/(2 a); `None` of fewer than two.
fn span<'a>(of: impl Iterator<Item = &'a Critical>) -> Option<Uncertain> {
    let mut fractions: Vec<Uncertain> = of.map(Critical::fraction).collect();
    fractions.sort_by(|one, other| one.value.total_cmp(&other.value));
    let [least, .., largest] = &*fractions else {
        return None;
    };
    Some(*largest - *least)
}

fn against(varied: &Varied, found: &[Critical]) -> ChartPanel {
    let series = varied.series.iter().enumerate();
    let series = series.map(|(place, (name, belongs))| {
        let of = found.iter().filter(|one| belongs(one) && one.counts());
        let points = joined(name, of.map(Critical::point))?;
        Some(if place == 1 { points.open() } else { points })
    });
    let others = found.iter().filter(|one| !one.counts());
    let others = points(
        "leaks, or depends on the threshold",
        others.map(Critical::point),
    );
    ChartPanel::new(varied.axis, "critical width, *w*_{c}/(2*a*)")
        .x_scale(varied.scale)
        .with_all(numbered(series))
        .with_all(others.map(|points| points.series(2).open().tint(Tint::Grey)))
}
