//! What the claims about the stress-controlled tube share.

use peristalsis_figures::{ColourScale, Units};

use super::prelude::*;

/// Strain rate of the source's pictures.
pub(super) const SOURCE_RATE: f64 = 4.01e-3;

/// The studies with the runs of frictional grains at all strain rates and forces.
pub(super) const BRANCHES: &[&str] = &["elastic-branches", "elastic-extremes"];

/// The lines that are judged: those with points on them, stationary flows of grains that stay in the tube.
pub(super) fn judged<'b, 'a>(lines: &'b [ForceLine<'a>]) -> Vec<&'b ForceLine<'a>> {
    lines.iter().filter(|line| !line.is_empty()).collect()
}

/// Label of an axis, in the units of Hertz contacts.
pub(super) fn label(quantity: Axis) -> String {
    quantity.label(Units::Hertz)
}

/// An empty panel of the flow against the force.
pub(super) fn flow_against_force() -> ChartPanel {
    ChartPanel::new(&label(Axis::ForceAmplitude), &label(Axis::FlowRateRatio))
}

/// Colours for the strain rates of some lines, whether or not they are judged.
pub(super) fn colours_of_rates(lines: &[ForceLine<'_>]) -> ColourScale {
    let rates = lines.iter().map(|line| line.strain_rate);
    colours(&label(Axis::StrainRate), rates, (1e-3, 8e-3)).logarithmic()
}

/// Both branches of each line, filled from rest and open from jammed, coloured by the strain rate.
pub(super) fn with_branches(mut panel: ChartPanel, lines: &[&ForceLine<'_>]) -> ChartPanel {
    for line in lines {
        let points = |branch: &Branch<'_>| -> Option<Points> {
            Some(branch_points("", branch)?.tint(Tint::Value(line.strain_rate)))
        };
        panel = panel
            .with_all(points(&line.flow.rest))
            .with_all(points(&line.flow.jammed).map(Points::open));
    }
    panel.with_all([Key::filled("from rest"), Key::open("from jammed")])
}

/// A claim on forces.
pub(super) const fn claim(
    id: &'static str,
    prose: Prose,
    studies: &'static [&'static str],
    finding: fn(&Evidence) -> Result<Finding>,
) -> Claim {
    Claim::new(id, prose, studies, finding).varying("force", FOR_A_VERDICT_ON_FORCES)
}

/// Whether the grains of a run are frictionless.
pub(super) fn is_frictionless(row: &Row<'_>) -> bool {
    row.number("contact.kinetic_friction") == 0.0
}
