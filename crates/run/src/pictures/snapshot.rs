//! Runs from the side.

use peristalsis_analysis::number::rounded;
use peristalsis_figures::chart::TITLE_SEPARATOR;
use peristalsis_figures::{
    Drawing, FigureError, Snapshot, SnapshotFigure, SnapshotGrain, SnapshotSphere, SnapshotWall,
    Width,
};
use peristalsis_observe::TubeShape;

use super::title;
use crate::run::Run;
use crate::scene::{instant, units};
use crate::spheres::{SeenSphere, seen_spheres};

/// Length of tube that a snapshot shows at most, in wavelengths.
const WAVES: u32 = 4;
/// Length that it shows at most, in diameters of the largest grains: the grains of a longer part are too small, or its rows
/// too many for a page.
const DIAMETERS: f64 = 1000.0;
/// How far from the axis a snapshot shows spheres, in radii of the tube.
const RADII: f64 = 2.5;
/// The same limit in lengths of the part of the tube that is shown, so that the picture of a wide tube is not too high.
const LENGTHS: f64 = 2.0;
/// Places at which a snapshot knows the radius of a prescribed wall.
const OUTLINE_POINTS: u32 = 400;

/// The final state of a run.
pub(super) fn snapshot(run: &Run) -> Result<Drawing, FigureError> {
    let configuration = run.configuration();
    let period = configuration.drive.period();
    let instant = instant(run.simulation().time(), period, units(configuration));
    let title = [title(configuration), instant].join(TITLE_SEPARATOR);
    draw(&title, &[("", run)])
}

/// The final states of several runs above each other, each with a label in markup: one scale, one bar of colours.
///
/// # Errors
/// If a figure cannot be drawn, for instance without a run.
pub fn snapshot_stack(runs: &[(&str, &Run)]) -> Result<Drawing, FigureError> {
    draw("", runs)
}

fn draw(title: &str, runs: &[(&str, &Run)]) -> Result<Drawing, FigureError> {
    let (unit, fastest) = unit_of_speed(runs);
    let views = runs.iter().map(|(_, run)| {
        let speed = fastest.unwrap_or_else(|| wave_speed(run));
        SideView::of(run, speed)
    });
    let views: Vec<SideView> = views.collect();
    let labelled = runs.iter().zip(&views);
    let snapshots: Vec<Snapshot<'_>> = labelled
        .map(|((label, _), view)| view.snapshot(label))
        .collect();
    let way = if fastest.is_some() { "tube" } else { "wave" };
    SnapshotFigure {
        title,
        snapshots: &snapshots,
        axis: axis(runs),
        velocity: &format!("axial velocity along the {way}, *v_z*/{unit}"),
        width: Width::DoubleColumn,
    }
    .draw()
}

/// Name of the axis along the tube, in markup, on which the wave runs to the right.
fn axis(runs: &[(&str, &Run)]) -> &'static str {
    let all_head = |way: f64| {
        let mut headings = runs.iter().map(|(_, run)| run.configuration().heading());
        headings.all(|heading| heading * way > 0.0)
    };
    match (all_head(1.0), all_head(-1.0)) {
        (true, _) => "*z*/*d*",
        (_, true) => "(*L* \u{2212} *z*)/*d*",
        _ => "way along the wave / *d*",
    }
}

/// Unit of velocities, in markup: the speed of the wave, or of the fastest grain where the wave stands.
fn unit_of_speed(runs: &[(&str, &Run)]) -> (String, Option<f64>) {
    let Some((_, still)) = runs.iter().find(|(_, run)| wave_speed(run) == 0.0) else {
        return ("*c*".to_owned(), None);
    };
    let fastest = runs.iter().map(|(_, run)| largest_axial_speed(run));
    let fastest = rounded(fastest.fold(0.0, f64::max), 2);
    let time = units(still.configuration()).time();
    (format!("({fastest} *d*/{time})"), Some(fastest))
}

/// Speed of the wave now \[d/t\].
fn wave_speed(run: &Run) -> f64 {
    let simulation = run.simulation();
    simulation.wall().wave_speed(simulation.time())
}

/// |v_z| of the fastest grain \[d/t\].
fn largest_axial_speed(run: &Run) -> f64 {
    let bodies = run.simulation().bodies();
    let velocities = bodies.velocity[..bodies.grains].iter();
    velocities
        .map(|velocity| velocity.z.abs())
        .fold(0.0, f64::max)
}

/// The part of a run that a snapshot shows.
struct SideView {
    grains: Vec<SnapshotGrain>,
    /// Where the wall is, place by place.
    outline: (Vec<f64>, Vec<f64>),
    /// Half a sphere of a prescribed wall.
    thickness: f64,
    /// The spheres of an elastic wall.
    spheres: Vec<SnapshotSphere>,
    length: f64,
    tube: f64,
    /// Of an open tube.
    outlet: Option<f64>,
    wavelength: f64,
}

impl SideView {
    fn snapshot<'a>(&'a self, label: &'a str) -> Snapshot<'a> {
        Snapshot {
            label,
            grains: &self.grains,
            wall: if self.spheres.is_empty() {
                SnapshotWall::Outline {
                    along: &self.outline.0,
                    radius: &self.outline.1,
                    thickness: self.thickness,
                }
            } else {
                SnapshotWall::Spheres(&self.spheres)
            },
            length: self.length,
            tube: self.tube,
            outlet: self.outlet,
            wavelength: self.wavelength,
        }
    }

    /// Velocities are told over a speed; 0 leaves them out.
    fn of(run: &Run, speed: f64) -> Self {
        let configuration = run.configuration();
        let simulation = run.simulation();
        let tube = simulation.wall().length();
        let heading = simulation.wall().heading();
        // Drawn with the wave running to the right.
        let along = |z: f64| if heading > 0.0 { z } else { tube - z };
        let length = configuration.tube.wavelength * f64::from(configuration.tube.waves.min(WAVES));
        let length = length.min(DIAMETERS * configuration.grains.diameter_max);
        let farthest = (RADII * configuration.tube.radius).min(LENGTHS * length);
        // A grain that has flown off must not stretch the picture, and those beyond its ends are many.
        let shows = |seen: &SeenSphere| {
            let sphere = seen.sphere;
            let (place, margin) = (sphere.along, sphere.diameter);
            sphere.across.hypot(sphere.depth) < farthest
                && (place < length + margin || place > tube - margin)
        };
        let (grains, wall): (Vec<SeenSphere>, Vec<SeenSphere>) = seen_spheres(run)
            .into_iter()
            .filter(shows)
            .partition(|seen| seen.is_grain);
        let grains = grains
            .into_iter()
            .map(|seen| SnapshotGrain {
                sphere: seen.sphere,
                axial_velocity: if speed > 0.0 {
                    seen.axial_velocity / speed
                } else {
                    0.0
                },
            })
            .collect();
        let spheres = wall.into_iter().map(|seen| seen.sphere).collect();
        let shape = TubeShape::of(simulation);
        let outline: (Vec<f64>, Vec<f64>) = (0..=OUTLINE_POINTS)
            .map(|point| {
                let place = length * f64::from(point) / f64::from(OUTLINE_POINTS);
                let radius = shape.radius(along(place).rem_euclid(tube));
                (place, radius.min(farthest))
            })
            .unzip();
        Self {
            grains,
            outline,
            thickness: 0.5 * simulation.wall().sphere_diameter(),
            spheres,
            length,
            tube,
            outlet: simulation.ends().map(|ends| ends.length(simulation.wall())),
            wavelength: configuration.tube.wavelength,
        }
    }
}

#[cfg(test)]
mod tests {
    use peristalsis_configuration::Configuration;

    use super::*;

    #[test]
    fn velocities_are_told_over_that_of_the_wave_or_of_the_fastest_grain() {
        let stops = "{form='steps',parameter='strain_rate',at=[0],values=[0]}";
        for (rate, schedule, told) in [
            ("0.05", "'sudden'", "*c*"),
            ("0", "'sudden'", "(0.2 *d*/"),
            ("0.05", stops, "(0.2 *d*/"),
        ] {
            let settings = [
                "grains.number=20",
                "run.duration=1",
                "body.gravity=[0, 0, -0.2]",
                &format!("drive.strain_rate={rate}"),
                &format!("drive.schedule={schedule}"),
            ];
            let configuration =
                Configuration::from_preset("frictionless", &settings.map(str::to_owned));
            let mut run = Run::new(configuration.expect("a configuration")).expect("a run");
            while !run.is_complete() {
                run.advance().expect("a step");
            }
            assert!(unit_of_speed(&[("", &run)]).0.starts_with(told));
        }
    }
}
