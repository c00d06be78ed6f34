//! Flow and wall along the wave at rest.

use peristalsis_figures::chart::{Band, ChartFigure, ChartPanel, LegendPlace, Line, Pattern, Tint};
use peristalsis_figures::{Drawing, FigureError, Quantity, Width};
use peristalsis_observe::ProfileBin;

use super::{HEIGHT, guide, label, title};
use crate::run::Run;
use crate::scene::units;
use crate::summary::late_wave_speed;
use crate::tables::late_profile;

/// Height of a panel in millimetres: a name in words stands beside it.
const PANEL_HEIGHT: f64 = 28.0;
/// Name of the granular temperature.
const TEMPERATURE: &str = "temperature, *T*_{g}/*mc*^{2}";
/// How far a picture of the tube reaches, in its largest radius.
const REACH: f64 = 1.12;

/// A value with its error.
type Value = (f64, f64);

/// The late profile over one wavelength, its last bin also before the first and its first after the last.
fn closed_profile(run: &Run) -> Vec<ProfileBin> {
    let mut bins = late_profile(run);
    if let (Some(&first), Some(&last)) = (bins.first(), bins.last()) {
        let moved = |bin: ProfileBin, by: f64| ProfileBin {
            position: bin.position + by,
            ..bin
        };
        bins.insert(0, moved(last, -1.0));
        bins.push(moved(first, 1.0));
    }
    bins
}

fn column(bins: &[ProfileBin], value: impl Fn(&ProfileBin) -> f64) -> Vec<f64> {
    bins.iter().map(value).collect()
}

fn panel(label_of_value: &str) -> ChartPanel {
    ChartPanel::new(&label(Quantity::Position), label_of_value).x_range(0.0..=1.0)
}

/// Profiles along the wave at rest: the tube, density, axial velocity and granular temperature, and stress on the wall where
/// it is known.
pub(super) fn profile(run: &Run) -> Result<Drawing, FigureError> {
    let configuration = run.configuration();
    let bins = closed_profile(run);
    let speed = late_wave_speed(run);
    let unit = units(configuration).per_pressure();
    let curve = |label: &str, tint: Tint, of: fn(&ProfileBin) -> Value| {
        with_curve(panel(label), tint, &bins, of)
    };
    let mut panels = vec![
        tube(&bins, 0.5 * run.simulation().wall().sphere_diameter()),
        curve("grains per length, *n*_{1} *d*", Tint::Blue, |bin| {
            bin.density
        })
        .y_range(0.0..),
    ];
    if speed > 0.0 {
        panels.extend([velocity(&bins, speed), temperature(&bins, speed)]);
    }
    if bins.iter().any(|bin| bin.wall_pressure.0.is_finite()) {
        let pressure = format!("pressure, *p*{unit}");
        let shear = format!("shear, *σ*{unit}");
        panels.push(curve(&pressure, Tint::Orange, |bin| bin.wall_pressure).y_range(0.0..));
        panels.push(curve(&shear, Tint::Green, |bin| bin.wall_shear).with(guide(0.0)));
    }
    ChartFigure::grid(2, panels)
        .title(&title(configuration))
        .description(
            "Tube, density, velocity, temperature and stress on the wall in the wave frame.",
        )
        .width(Width::DoubleColumn)
        .panel_height(PANEL_HEIGHT)
        .share_x()
        .draw()
}

/// The granular temperature over the mass of a grain and the square of a speed.
fn temperature(bins: &[ProfileBin], speed: f64) -> ChartPanel {
    let unit = speed * speed;
    let of = |bin: &ProfileBin| (bin.temperature.0 / unit, bin.temperature.1 / unit);
    with_curve(panel(TEMPERATURE), Tint::Purple, bins, of).y_range(0.0..)
}

/// Adds the curve of a value of each bin with the band of its error.
fn with_curve(
    panel: ChartPanel,
    tint: Tint,
    bins: &[ProfileBin],
    of: impl Fn(&ProfileBin) -> Value,
) -> ChartPanel {
    let x = column(bins, |bin| bin.position);
    let bound = |side: f64| {
        column(bins, |bin| {
            let (value, error) = of(bin);
            value + if error.is_finite() { side * error } else { 0.0 }
        })
    };
    panel
        .with(Band::new("", &x, &bound(-1.0), &bound(1.0)).tint(tint))
        .with(Line::new("", &x, &bound(0.0)).tint(tint))
}

/// The tube in section: its clear bore white, the wall spheres grey from a thickness inside of their centres on, which lie on
/// two lines.
fn tube(bins: &[ProfileBin], thickness: f64) -> ChartPanel {
    let x = column(bins, |bin| bin.position);
    let end = REACH * bins.iter().map(|bin| bin.radius).fold(0.0, f64::max);
    let mut panel = panel("radius, *r*/*d*")
        .y_range(-end..=end)
        .with(guide(0.0));
    for side in [1.0, -1.0] {
        let wall = column(bins, |bin| side * bin.radius);
        let surface = column(bins, |bin| side * (bin.radius - thickness).max(0.0));
        let outside = vec![side * end; x.len()];
        panel = panel
            .with(Band::new("", &x, &surface, &outside).tint(Tint::Grey))
            .with(Line::new("", &x, &wall).tint(Tint::Black));
    }
    panel
}

/// The axial velocity over a speed: red along the wave, blue against it, the area to nought faint in the same colour.
fn velocity(bins: &[ProfileBin], speed: f64) -> ChartPanel {
    let mut bins = bins.to_vec();
    for index in (1..bins.len()).rev() {
        let (before, after) = (bins[index - 1], bins[index]);
        let (from, to) = (before.axial_velocity, after.axial_velocity);
        // The curve changes its colour where it crosses nought, between two bins.
        if from.0 * to.0 < 0.0 {
            let between = |one: f64, other: f64| one + from.0 / (from.0 - to.0) * (other - one);
            let crossing = ProfileBin {
                position: between(before.position, after.position),
                axial_velocity: (0.0, between(from.1, to.1)),
                ..after
            };
            bins.insert(index, crossing);
        }
    }
    let x = column(&bins, |bin| bin.position);
    let rest = vec![0.0; x.len()];
    let mut panel = panel(&label(Quantity::AxialVelocity)).with(guide(0.0));
    for (side, tint) in [(1.0, Tint::Along), (-1.0, Tint::Against)] {
        let on_side = |bin: &ProfileBin| {
            let (value, error) = bin.axial_velocity;
            let value = if side * value >= 0.0 { value } else { f64::NAN };
            (value / speed, error / speed)
        };
        let values = column(&bins, |bin| on_side(bin).0);
        if values.iter().any(|value| value.is_finite()) {
            let area = Band::new("", &x, &rest, &values).tint(tint);
            panel = with_curve(panel.with(area), tint, &bins, on_side);
        }
    }
    panel
}

/// Radius of the wall against the phase: its mean, and the band between its least and its largest value.
pub(super) fn wall(run: &Run) -> Result<Drawing, FigureError> {
    let configuration = run.configuration();
    let bins = closed_profile(run);
    let x = column(&bins, |bin| bin.position);
    let mean = column(&bins, |bin| bin.radius);
    let least = column(&bins, |bin| bin.least_radius);
    let largest = column(&bins, |bin| bin.largest_radius);
    let rest = [configuration.tube.radius; 2];
    let rest = Line::new("tube at rest", &[0.0, 1.0], &rest).tint(Tint::Grey);
    let panel = panel("wall radius, *R*/*d*")
        .with(Line::new("mean", &x, &mean).tint(Tint::Blue).weight(1.1))
        .with(Band::new("least to largest", &x, &least, &largest).tint(Tint::Blue))
        .with(rest.pattern(Pattern::Dashed));
    ChartFigure::new(panel)
        .title(&title(configuration))
        .description("Radius of the wall against the phase of the wave.")
        .panel_height(HEIGHT)
        .legend(LegendPlace::Below)
        .draw()
}

#[cfg(test)]
mod tests {
    use peristalsis_configuration::Configuration;

    use super::*;

    /// A pump engineer: a profile was told over the speed of a strain rate that the schedule had left.
    #[test]
    fn the_late_speed_of_a_wave_is_that_of_its_schedule() {
        for (schedule, expected) in [
            ("", 0.1),
            (
                "{form='steps',parameter='strain_rate',at=[0],values=[0.04]}",
                0.4,
            ),
            (
                "{form='steps',parameter='strain_rate',at=[2],values=[0.0]}",
                0.0,
            ),
        ] {
            let course = format!("drive.schedule={schedule}");
            let mut settings = vec!["grains.number=5", "tube.waves=1", "drive.strain_rate=0.01"];
            settings.extend(["run.periods=4", "observe.late_fraction=0.5"]);
            if !schedule.is_empty() {
                settings.push(&course);
            }
            let configuration = Configuration::from_preset("frictionless", &settings).unwrap();
            let mut run = Run::new(configuration).unwrap();
            while !run.is_complete() {
                run.advance().unwrap();
            }
            let speed = late_wave_speed(&run);
            assert!((speed - expected).abs() < 1e-12, "{schedule}: {speed}");
        }
    }

    /// T_g had no unit.
    #[test]
    fn the_temperature_is_in_units_of_the_wave() {
        let bin = |position: f64| ProfileBin {
            position,
            temperature: (8.0, 0.4),
            ..ProfileBin::default()
        };
        let bins = [bin(0.25), bin(0.75)];
        let of = |bin: &ProfileBin| (bin.temperature.0 / 4.0, bin.temperature.1 / 4.0);
        let expected = with_curve(panel(TEMPERATURE), Tint::Purple, &bins, of);
        assert_eq!(temperature(&bins, 2.0), expected.y_range(0.0..));
    }

    #[test]
    fn a_velocity_changes_its_colour_at_nought_and_an_unknown_error_has_no_band() {
        let none = f64::NAN;
        let bins = [
            (0.0, 2.0, 0.2),
            (1.0, 6.0, none),
            (2.0, -2.0, 0.5),
            (3.0, -4.0, 0.0),
        ];
        let bins = bins.map(|(position, value, error)| ProfileBin {
            position,
            axial_velocity: (value, error),
            ..ProfileBin::default()
        });
        let x = [0.0, 1.0, 1.75, 2.0, 3.0];
        let along = [1.0, 3.0, 0.0, none, none].map(|value| [value; 3]);
        let against = [none, none, 0.0, -1.0, -2.0].map(|value| [value; 3]);
        let mut sides = [(Tint::Along, along), (Tint::Against, against)];
        (sides[0].1[0], sides[1].1[3]) = ([0.9, 1.0, 1.1], [-1.25, -1.0, -0.75]);
        let mut expected = panel(&label(Quantity::AxialVelocity)).with(guide(0.0));
        for (tint, values) in sides {
            let [lower, value, upper] = [0, 1, 2].map(|bound| values.map(|row| row[bound]));
            expected = expected
                .with(Band::new("", &x, &[0.0; 5], &value).tint(tint))
                .with(Band::new("", &x, &lower, &upper).tint(tint))
                .with(Line::new("", &x, &value).tint(tint));
        }
        // In words, for a gap is not equal to itself.
        assert_eq!(
            format!("{:?}", velocity(&bins, 2.0)),
            format!("{expected:?}")
        );
    }
}
