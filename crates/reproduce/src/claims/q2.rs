//! Q2: roughness of the wall.

use super::prelude::*;

const PROSE: Prose = Prose::new(include_str!("q2.md"));

pub(super) const CLAIM: Claim = Claim::new("Q2", PROSE, &["roughness"], examine);

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
        let near = |row: &&Row<'_>| (row.width() - critical.value).abs() < ESCAPED_WITHIN;
        Some(Self {
            lattice,
            strain_rate,
            depth: depth(&rows[0]),
            critical,
            escaped: rows
                .iter()
                .filter(near)
                .map(Row::escaped_fraction)
                .fold(0.0, f64::max),
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
        let widths = tight.iter().map(|wall| (wall.depth, bar(&wall.critical)));
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
        return Ok(PROSE.nothing(Statistics::default(), &Q2_NEEDED));
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
    draft.table("lattices", &[], walls.iter().map(Wall::row));
    draft.chart("roughness", &[], ChartFigure::new(panel))?;
    Ok(draft.concluded(verdict, summary, statistics, &Q2_NEEDED))
}
