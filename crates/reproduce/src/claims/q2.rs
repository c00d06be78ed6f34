//! Q2: roughness of the wall.

use peristalsis_figures::Quantity as Axis;
use peristalsis_figures::chart::{ChartFigure, ChartPanel, Points};

use super::{MOST_ESCAPED, label};
use crate::claim::Claim;
use crate::crossing::{behind, crossing, grouped};
use crate::error::ClaimError;
use crate::evidence::Evidence;
use crate::finding::{Finding, Quantity, ReportFigure, ReportTable, Statistics, Verdict};
use crate::prose::Prose;
use crate::runs::Run;
use crate::text::{estimate, number};

const PROSE: Prose = Prose::new(include_str!("q2.md"));

pub(super) const CLAIM: Claim = Claim {
    id: "Q2",
    prose: PROSE,
    studies: &["roughness"],
    examine,
};

/// For an answer: five lattices are asked for apart.
const NEEDED: Statistics = Statistics {
    strain_rates: 2,
    widths: 7,
    replicates: 5,
    runs: 300,
};
const LEAST_LATTICES: usize = 5;

/// How deep a grain sinks between three wall spheres \[d\], all of one diameter: d − (d² − s²)^{1/2}, s the circumradius of
/// the triangle that two neighbours of a ring make with one of the next. Larger spacings than d let a grain through.
fn depth(run: &Run) -> f64 {
    let along_ring = core::f64::consts::TAU * run.radius / run.lattice.spheres_per_ring as f64;
    let between_rings = run.wavelength / run.lattice.rings_per_wave as f64;
    let circumradius =
        (0.25 * along_ring * along_ring + between_rings * between_rings) / (2.0 * between_rings);
    1.0 - (1.0 - circumradius * circumradius).max(0.0).sqrt()
}

fn examine(evidence: &Evidence) -> Result<Finding, ClaimError> {
    let runs = &evidence.study("roughness")?.runs;
    let mut strain_rates = 0;
    let mut of_lattices = Vec::new();
    let mut panel = ChartPanel::new(
        "depth of the hollows of the wall, *h*/*d*",
        &label(Axis::CriticalWidth),
    )
    .x_range(0.0..);
    let mut rows = Vec::new();
    let mut quantities = Vec::new();
    let mut ends = Vec::new();
    let mut lattices = usize::MAX;
    for (series, (rate, of_rate)) in grouped(runs, |run| run.strain_rate).into_iter().enumerate() {
        let of_rate: Vec<Run> = of_rate.into_iter().cloned().collect();
        let (mut x, mut y, mut error) = (vec![], vec![], vec![]);
        for (_, here) in grouped(&of_rate, |run| {
            (run.lattice.spheres_per_ring, run.lattice.rings_per_wave)
        }) {
            of_lattices.push(behind(&here));
            let Some(found) = crossing(&here) else {
                continue;
            };
            let near = here
                .iter()
                .filter(|run| (run.width - found.width.value).abs() < 0.1);
            let escaped = near.map(|run| run.escaped_fraction()).fold(0.0, f64::max);
            rows.push(vec![
                number(rate, 3),
                here[0].lattice.name(),
                number(depth(here[0]), 3),
                estimate(&found.width),
                number(escaped, 2),
            ]);
            quantities.push(Quantity {
                name: format!(
                    "critical width, {} lattice, strain rate {rate}",
                    here[0].lattice.name()
                ),
                symbol: "*w*_{c}".to_owned(),
                unit: "d".to_owned(),
                source: None,
                ours: Some(found.width),
                method: "half of the runs from rest jam".to_owned(),
            });
            if escaped <= MOST_ESCAPED {
                x.push(depth(here[0]));
                y.push(found.width.value);
                error.push(found.width.interval_95.length() / 2.0);
            }
        }
        lattices = lattices.min(x.len());
        if x.is_empty() {
            continue;
        }
        strain_rates += 1;
        let (smoothest, roughest) = extremes(&x, &y);
        ends.push(format!(
            "from {} *d* on the roughest to {} *d* on the smoothest wall at *ε̇* = {rate}",
            number(roughest, 3),
            number(smoothest, 3)
        ));
        panel = panel.with(
            Points::new(&format!("*ε̇* = {rate}"), &x, &y)
                .y_errors(&error)
                .series(series)
                .joined(),
        );
    }
    if ends.is_empty() {
        let nothing = Statistics::default();
        return Ok(Finding::nothing(
            "No lattice has a critical width yet.",
            nothing,
            &NEEDED,
        ));
    }
    let mut finding = Finding::new(
        if lattices >= LEAST_LATTICES {
            Verdict::Answered
        } else {
            Verdict::Open
        },
        format!("*w*_{{c}} goes {}.", ends.join(" and ")),
        Statistics {
            strain_rates,
            ..Statistics::weakest(of_lattices.into_iter())
        },
        &NEEDED,
    );
    finding.quantities = quantities;
    finding.paragraphs.push(
        "Roughness is measured by how deep a grain can sink into a hollow between three wall spheres. A finer lattice is also a \
         stiffer wall, since a grain touches more of its spheres at a time."
            .to_owned(),
    );
    finding.tables.push(ReportTable {
        caption: "Critical width from rest for several arrangements of the wall spheres (spheres a ring × rings a wavelength), \
                  and the fraction of grains outside near it."
            .to_owned(),
        head: ["*ε̇*", "lattice", "*h*/*d*", "*w*_{c}/*d*", "outside"].map(str::to_owned).to_vec(),
        rows,
    });
    finding
        .weaknesses
        .push("One threshold, 0.4, for all lattices.".to_owned());
    finding.figures.push(ReportFigure {
        name: "roughness".to_owned(),
        caption: "Critical width against the depth of the hollows of the wall. Lattices that leak are left out.".to_owned(),
        drawing: ChartFigure::new(panel)
            .description("Critical width against roughness of the wall.")
            .draw()?,
    });
    Ok(finding)
}

/// Ordinates at the least and at the largest abscissa.
fn extremes(x: &[f64], y: &[f64]) -> (f64, f64) {
    let at = |better: fn(f64, f64) -> bool| {
        let mut best = 0;
        for place in 1..x.len() {
            if better(x[place], x[best]) {
                best = place;
            }
        }
        y[best]
    };
    (at(|one, other| one < other), at(|one, other| one > other))
}
