//! Q2: roughness of the wall.

use peristalsis_analysis::{fit_line_to_scatter, mean_and_error};

use super::f3::AMPLITUDE;
use super::f7::SLOPE;
use super::prelude::*;

const PROSE: Prose = Prose::new(include_str!("q2.md"));

const STUDIES: &[&str] = &[
    "roughness",
    "walls",
    "walls-dense",
    "walls-drawn",
    "walls-sought",
    "wavelength",
];

pub(super) const CLAIM: Claim =
    Claim::new("Q2", PROSE, STUDIES, examine).varying("width", Q2_NEEDED);

/// How deep a grain sinks between three wall spheres \[d\], all of one diameter: d − (d² − s²)^{1/2}, s the circumradius of
/// the triangle that two neighbours of a ring make with one of the next. Larger spacings than d let a grain through.
fn depth(row: &Row<'_>) -> f64 {
    let lattice = row.lattice();
    let along_ring = core::f64::consts::TAU * row.radius() / lattice.spheres_per_ring as f64;
    let between_rings = row.wavelength() / lattice.rings_per_wave as f64;
    let circumradius =
        (0.25 * along_ring * along_ring + between_rings * between_rings) / (2.0 * between_rings);
    1.0 - (1.0 - circumradius * circumradius).max(0.0).sqrt()
}

/// One arrangement of the wall spheres at one strain rate.
struct Wall {
    lattice: Lattice,
    strain_rate: f64,
    depth: f64,
    critical: Uncertain,
    /// Largest fraction of grains outside near the critical width.
    escaped: f64,
}

impl Wall {
    fn of(strain_rate: f64, lattice: Lattice, rows: &[Row<'_>]) -> Option<Self> {
        let critical = crossing(rows)?.width;
        Some(Self {
            lattice,
            strain_rate,
            depth: depth(&rows[0]),
            escaped: leak(rows, Some(critical.value)),
            critical,
        })
    }

    fn row(&self) -> Vec<String> {
        vec![
            number(self.strain_rate, 3),
            self.lattice.name(),
            number(self.depth, 3),
            self.critical.to_string(),
            number(self.escaped, 2),
        ]
    }
}

fn examine(evidence: &Evidence) -> Result<Finding> {
    let (mut walls, mut ends, mut all) = (Vec::new(), Vec::new(), Vec::new());
    let mut lattices = usize::MAX;
    let depth_label = "depth of the hollows of the wall, *h*/*d*";
    let mut panel = ChartPanel::new(depth_label, &label(Axis::CriticalWidth)).x_range(0.0..);
    let rates = by_strain_rate(evidence.study("roughness")?.rows());
    for (series, (rate, rows)) in rates.into_iter().enumerate() {
        let groups = grouped(rows, Row::lattice);
        all.extend(groups.iter().map(|(_, rows)| behind(rows, Row::width)));
        let of_rate: Vec<Wall> = groups
            .iter()
            .filter_map(|(lattice, rows)| Wall::of(rate, *lattice, rows))
            .collect();
        let mut tight: Vec<&Wall> = of_rate
            .iter()
            .filter(|wall| wall.escaped <= MOST_ESCAPED)
            .collect();
        lattices = lattices.min(tight.len());
        let widths = tight.iter().map(|wall| (wall.depth, wall.critical));
        let drawn = joined(&format!("*ε̇* = {rate}"), widths);
        panel = panel.with_all(drawn.map(|points| points.series(series)));
        tight.sort_by(|one, other| one.depth.total_cmp(&other.depth));
        if let (Some(smoothest), Some(roughest)) = (tight.first(), tight.last()) {
            let [roughest, smoothest] =
                [roughest, smoothest].map(|wall| number(wall.critical.value, 3));
            ends.push(PROSE.text("ends", values!(roughest, smoothest, rate)));
        }
        walls.extend(of_rate);
    }
    if ends.is_empty() {
        return Ok(PROSE.nothing(Statistics::default()));
    }
    let verdict = Verdict::answered_if(lattices >= LEAST_LATTICES);
    let summary = PROSE.text("summary", values!(ends = ends.join(" and ")));
    let statistics = Statistics {
        strain_rates: ends.len(),
        ..Statistics::weakest(all.into_iter())
    };
    let mut draft = Draft::of(PROSE);
    for wall in &walls {
        let (lattice, rate) = (wall.lattice.name(), wall.strain_rate);
        draft.quantity("critical width", values!(lattice, rate), wall.critical);
    }
    let of_one_speed = |row: &Row<'_>| (row.wave_speed() - 1.0).abs() < 1e-6;
    let mut waves = evidence.study("wavelength")?.rows();
    waves.retain(of_one_speed);
    let others = evidence.rows(&["walls", "walls-dense", "walls-drawn", "walls-sought"])?;
    candidates(&mut draft, others, &waves);
    draft.table("lattices", &[], walls.iter().map(Wall::row));
    draft.chart("roughness", &[], ChartFigure::new(panel))?;
    Ok(draft.concluded(verdict, summary, statistics))
}

/// Waves in the tubes of the presets, and the volume fraction of their grains.
const WAVES: f64 = 10.0;
const FRACTION: f64 = 0.15;

/// What one arrangement of wall spheres shows over the strain rates.
struct Candidate {
    name: String,
    /// Spheres per area of the straight tube \[1/d^2\].
    density: f64,
    /// dw_c/depsdot.
    slope: Option<Uncertain>,
    /// Power of the strain rate with which tau (w_c - w) goes next to w_c.
    power: Option<Uncertain>,
    /// Largest fraction of grains outside near w_c.
    escaped: f64,
}

/// Distances from w_c, in units of epsdot^(3/2), at which tau (w_c - w) is read: where the source claims its law.
const WHERE_CLAIMED: core::ops::RangeInclusive<f64> = 0.7..=5.0;

impl Candidate {
    fn of(name: String, rows: &[Row<'_>]) -> Option<Self> {
        let first = rows.first()?;
        let (mut widths, mut amplitudes, mut escaped) = (Vec::new(), Vec::new(), 0.0_f64);
        for (rate, rows) in by_strain_rate(rows.iter().copied()) {
            let critical = crossing(&rows).map(|crossing| crossing.width);
            let outside = leak(&rows, critical.map(|width| width.value));
            escaped = escaped.max(outside);
            let Some(critical) = critical.filter(|_| outside <= MOST_ESCAPED) else {
                continue;
            };
            widths.push((rate, critical));
            let distance = |row: &Row<'_>| critical.value - row.width();
            let claimed =
                |row: &&Row<'_>| WHERE_CLAIMED.contains(&(distance(row) * rate.powf(-1.5)));
            let claimed: Vec<Row<'_>> = rows.iter().filter(claimed).copied().collect();
            // The error of w_c moves all runs together.
            let seen = claimed.iter().filter_map(|row| {
                let time = row.transition().observed()?;
                Some((time * distance(row), time * critical.error))
            });
            let (products, shifts): (Vec<f64>, Vec<f64>) = seen.unzip();
            let (amplitude, scatter) = mean_and_error(&products);
            let error = scatter.hypot(shifts.iter().sum::<f64>() / shifts.len() as f64);
            if products.len() > 1 {
                amplitudes.push((rate, Uncertain::normal(amplitude, error)));
            }
        }
        let [rate, width, error] = columns(widths, 0.0);
        let line = fit_line_to_scatter(&rate, &width, &error).ok();
        Some(Self {
            name,
            density: first.wall_density(),
            slope: line.map(|line| line.line.slope),
            power: fitted_power(amplitudes),
            escaped,
        })
    }

    fn row(&self) -> Vec<String> {
        vec![
            self.name.clone(),
            number(self.density, 2),
            cell(self.slope),
            cell(self.power),
            number(self.escaped, 3),
        ]
    }
}

/// The walls that the source could have had, side by side, and waves of one speed, of which the strain rate follows from their
/// lengths.
fn candidates(draft: &mut Draft, walls: Vec<Row<'_>>, waves: &[Row<'_>]) {
    let groups = grouped(walls, |row| {
        let of_tube = (row.number("waves"), row.volume_fraction());
        (arrangement(row), row.lattice(), of_tube)
    });
    let found = groups
        .iter()
        .filter_map(|((arrangement, lattice, (waves, fraction)), rows)| {
            let mut name = wall_name(*lattice, arrangement);
            if *waves != WAVES {
                name = PROSE.text("so long", values!(name, waves));
            }
            if *fraction != FRACTION {
                name = PROSE.text("so dense", values!(name, fraction));
            }
            Candidate::of(name, rows)
        });
    let mut found: Vec<Candidate> = found.collect();
    if found.is_empty() {
        return;
    }
    found.sort_by(|one, other| one.density.total_cmp(&other.density));
    for one in &found {
        let wall = &one.name;
        draft.compared("slope", values!(wall), one.slope, SLOPE);
        draft.compared("power", values!(wall), one.power, AMPLITUDE);
    }
    let has_slope = |one: &Candidate| one.slope.and_then(|ours| agrees(&ours, SLOPE));
    let has_power = |one: &Candidate| one.power.and_then(|ours| agrees(&ours, AMPLITUDE));
    let named = |agrees: &dyn Fn(&Candidate) -> Option<bool>| -> String {
        let those = found.iter().filter(|one| agrees(one) == Some(true));
        let names: Vec<&str> = those.map(|one| &*one.name).collect();
        match names.is_empty() {
            true => "none".to_owned(),
            false => names.join(", "),
        }
    };
    let (slopes, powers) = (named(&has_slope), named(&has_power));
    let powers_found = found.iter().filter_map(|one| one.power);
    let [least, most] =
        extremes(powers_found.map(|power| power.value)).map(|power| number(power, 1));
    draft.paragraph("candidates", values!(slopes, powers, least, most));
    let by_length = Candidate::of(PROSE.text("by length", &[]), waves);
    if let Some(one) = &by_length {
        let [slope, power] = [cell(one.slope), cell(one.power)];
        draft.paragraph("waves", values!(slope, power));
    }
    if found.iter().all(|one| has_power(one) != Some(true)) {
        draft.paragraph("unexplained", &[]);
    }
    let (told, leaking): (Vec<_>, Vec<_>) = found
        .iter()
        .partition(|one| one.slope.is_some() || one.power.is_some());
    if !leaking.is_empty() {
        let names: Vec<&str> = leaking.iter().map(|one| &*one.name).collect();
        draft.paragraph("leaking", values!(walls = names.join(", ")));
    }
    let rows = told.into_iter().chain(&by_length).map(Candidate::row);
    draft.table("candidates", &[], rows);
}
