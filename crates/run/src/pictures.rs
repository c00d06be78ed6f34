//! The figures of a run.

use peristalsis_configuration::{Configuration, Control, ScheduledParameter, Waveform};
use peristalsis_figures::{
    Drawing, FigureError, FlowFigure, LateMean, NewtonianReference, Palette, Profile,
    ProfileFigure, Scale, Series, SnapshotFigure, SnapshotGrain, SnapshotSphere, SnapshotStack,
    SnapshotWall, SpaceTimeFigure, Transition, WallFigure, Width,
};
use peristalsis_observe::TubeShape;

use crate::error::RunError;
use crate::portrait::{pressure_unit, time_unit};
use crate::run::Run;
use crate::spheres::{SeenSphere, seen_spheres};
use crate::summary::Summary;
use crate::tables::late_profile;

/// Length of tube that a snapshot shows at most, in wavelengths.
const SNAPSHOT_WAVES: u32 = 4;
/// How far from the axis a snapshot shows spheres, in radii of the tube.
const SNAPSHOT_RADII: f64 = 2.5;

/// All figures of a run, by name. A static wave has no periods and no flow figure; without grains there is nothing to
/// draw.
pub(crate) fn draw_all(
    run: &Run,
    summary: &Summary,
) -> Result<Vec<(&'static str, Drawing)>, RunError> {
    let configuration = run.configuration();
    let mut drawings = Vec::new();
    let mut add = |name: &'static str, drawing: Result<Drawing, FigureError>| {
        drawing
            .map(|drawing| drawings.push((name, drawing)))
            .map_err(|source| RunError::Figure {
                figure: name,
                source,
            })
    };
    let has_ratios = run
        .recorder()
        .samples()
        .iter()
        .any(|sample| sample.flow_rate_ratio.is_finite());
    if has_ratios {
        add("flow", flow(run, summary))?;
    }
    // The late part may have no grain left inside.
    if has_ratios
        && late_profile(run)
            .iter()
            .any(|bin| bin.axial_velocity.0.is_finite())
    {
        add("profile", profile(run))?;
    }
    if configuration.grains.number > 0 {
        add("snapshot", snapshot(run))?;
    }
    if matches!(configuration.drive.control, Control::Stress { .. })
        && !run.recorder().samples().is_empty()
    {
        add("wall", wall(run))?;
    }
    Ok(drawings)
}

/// The parameters of a run in one line of markup.
fn title(configuration: &Configuration) -> String {
    let value = |parameter, constant| scheduled_value(configuration, parameter, constant);
    let (control, density) = match configuration.drive.control {
        Control::Strain { width } => (
            format!("*w* = {} *d*", value(ScheduledParameter::Width, width)),
            format!("*ρ* = {:.3}", configuration.volume_fraction()),
        ),
        Control::Stress {
            force_amplitude, ..
        } => (
            format!(
                "*f*^{{P}} = {} *Yd*^{{2}}",
                value(ScheduledParameter::ForceAmplitude, force_amplitude)
            ),
            format!("*n* = {:.3}", configuration.number_density()),
        ),
    };
    format!(
        "{control},  *ε\u{307}* = {},  {density},  {}",
        value(
            ScheduledParameter::StrainRate,
            configuration.drive.strain_rate
        ),
        particular(configuration)
            .unwrap_or_else(|| format!("*N* = {}", configuration.grains.number))
    )
}

/// What sets a run apart from most: its waveform, its body force.
fn particular(configuration: &Configuration) -> Option<String> {
    let waveform = match configuration.drive.waveform {
        Waveform::Sine => None,
        Waveform::Bolus => Some("bolus".to_owned()),
        Waveform::Roller => Some("roller".to_owned()),
    };
    let force = configuration.drive.body_force;
    let force = (force != 0.0).then(|| format!("*g* = {force}").replace('-', "−"));
    let words: Vec<String> = waveform.into_iter().chain(force).collect();
    (!words.is_empty()).then(|| words.join(",  "))
}

/// A drive parameter as a title shows it: its value, or the first and the last of its schedule.
fn scheduled_value(
    configuration: &Configuration,
    parameter: ScheduledParameter,
    constant: f64,
) -> String {
    match configuration.drive.schedule(parameter) {
        Some(schedule) => {
            let last = configuration.run.periods.unwrap_or(f64::INFINITY);
            format!("{} to {}", schedule.value(0.0), schedule.value(last))
        }
        None => constant.to_string(),
    }
}

fn flow(run: &Run, summary: &Summary) -> Result<Drawing, FigureError> {
    let configuration = run.configuration();
    let recorder = run.recorder();
    let samples = recorder.samples();
    // A sample is the mean over the interval that ends with it, an average that over so many intervals.
    let end = |index: usize| {
        if index == 0 {
            0.0
        } else {
            samples[index - 1].period
        }
    };
    let period: Vec<f64> = (0..samples.len())
        .map(|k| 0.5 * (end(k) + end(k + 1)))
        .collect();
    let ratio: Vec<f64> = samples
        .iter()
        .map(|sample| sample.flow_rate_ratio)
        .collect();
    let per_period = configuration.observe.samples_per_period as usize;
    let middles: Vec<f64> = (0..recorder.averages().len())
        .map(|k| 0.5 * (end(k * per_period) + end((k + 1) * per_period)))
        .collect();
    let cycles_at = |time: f64| {
        let passed = samples.partition_point(|sample| sample.time <= time);
        let (before, after) = (end(passed), end((passed + 1).min(samples.len())));
        let start = if passed == 0 {
            0.0
        } else {
            samples[passed - 1].time
        };
        let interval = samples[0].time;
        before + (after - before) * (time - start) / interval
    };
    let title = title(configuration);
    FlowFigure {
        title: &title,
        samples: Series {
            x: &period,
            y: &ratio,
        },
        averages: recorder
            .averages()
            .iter()
            .any(|average| average.is_finite())
            .then_some(Series {
                x: &middles,
                y: recorder.averages(),
            }),
        threshold: Some(configuration.observe.transition_threshold),
        transition: summary.transition_time.map(|time| Transition {
            period: cycles_at(time),
            time,
            unit: time_unit(configuration),
        }),
        newtonian: summary
            .newtonian_flow_rate_ratio
            .map(|ratio| NewtonianReference {
                ratio,
                clear_bore: summary.newtonian_flow_rate_ratio_clear_bore,
            }),
        late_mean: (summary.flow_rate_ratio.is_finite()
            && summary.flow_rate_ratio_error.is_finite())
        .then_some(LateMean {
            mean: summary.flow_rate_ratio,
            error: summary.flow_rate_ratio_error,
        }),
        width: Width::SingleColumn,
    }
    .draw()
}

fn profile(run: &Run) -> Result<Drawing, FigureError> {
    let configuration = run.configuration();
    let bins = late_profile(run);
    let speed = configuration.wave_speed();
    let column = |value: &dyn Fn(&peristalsis_observe::ProfileBin) -> f64| -> Vec<f64> {
        bins.iter().map(value).collect()
    };
    let position = column(&|bin| bin.position);
    let radius = column(&|bin| bin.radius);
    let density = (column(&|bin| bin.density.0), column(&|bin| bin.density.1));
    let velocity = (
        column(&|bin| bin.axial_velocity.0 / speed),
        column(&|bin| bin.axial_velocity.1 / speed),
    );
    let temperature = (
        column(&|bin| bin.temperature.0),
        column(&|bin| bin.temperature.1),
    );
    let pressure = (
        column(&|bin| bin.wall_pressure.0),
        column(&|bin| bin.wall_pressure.1),
    );
    let shear = (
        column(&|bin| bin.wall_shear.0),
        column(&|bin| bin.wall_shear.1),
    );
    let is_known = pressure.0.iter().any(|value| value.is_finite());
    let title = title(configuration);
    let unit = pressure_unit(configuration);
    let (pressure_label, shear_label) = (format!("*p*{unit}"), format!("*τ*{unit}"));
    let panel = |value, error, label| Profile {
        position: &position,
        value,
        error,
        label,
    };
    ProfileFigure {
        title: &title,
        wall_radius: panel(&radius, None, "*r*/*d*"),
        density: panel(&density.0, Some(&density.1), "*n*_{1} *d*"),
        axial_velocity: panel(&velocity.0, Some(&velocity.1), "*v_z*/*c*"),
        temperature: panel(&temperature.0, Some(&temperature.1), "*T*_{g}"),
        temperature_scale: Scale::Linear,
        wall_pressure: is_known.then(|| panel(&pressure.0, Some(&pressure.1), &pressure_label)),
        wall_shear: is_known.then(|| panel(&shear.0, Some(&shear.1), &shear_label)),
        width: Width::SingleColumn,
    }
    .draw()
}

fn wall(run: &Run) -> Result<Drawing, FigureError> {
    let configuration = run.configuration();
    let bins = late_profile(run);
    let column = |value: fn(&peristalsis_observe::ProfileBin) -> f64| -> Vec<f64> {
        bins.iter().map(value).collect()
    };
    let title = title(configuration);
    WallFigure {
        title: &title,
        phase: &column(|bin| bin.position),
        mean: &column(|bin| bin.radius),
        least: &column(|bin| bin.least_radius),
        largest: &column(|bin| bin.largest_radius),
        reference: Some(configuration.tube.radius),
        length_unit: "*d*",
        width: Width::SingleColumn,
    }
    .draw()
}

/// The space-time diagram of a run: J/Jmax of the grains of each wave, period by period.
///
/// # Errors
/// [`RunError::Picture`] where no period has been measured whole; [`RunError::Figure`] where there is nothing to draw.
pub fn space_time(run: &Run) -> Result<Drawing, RunError> {
    let flows = run.recorder().waves();
    let waves = run.configuration().tube.waves as usize;
    let (Some(first), Some(last)) = (flows.first(), flows.last()) else {
        return Err(RunError::Picture {
            reason: "the run has measured no whole period of its wave yet".to_owned(),
            help: "let it run for a period at least, with a wave that moves".to_owned(),
        });
    };
    let value = |(wave, period): (usize, usize)| flows[period * waves + wave].flow_rate_ratio;
    let periods = flows.len() / waves.max(1);
    let values: Vec<f64> = (0..waves)
        .flat_map(|wave| (0..periods).map(move |period| (wave, period)))
        .map(value)
        .collect();
    let step = first
        .period
        .max(last.period - flows[flows.len() - 1 - waves.min(flows.len() - 1)].period);
    SpaceTimeFigure {
        title: &title(run.configuration()),
        values: &values,
        rows: waves,
        x_range: ((first.period - step).max(0.0), last.period),
        y_range: (0.0, waves as f64),
        value_label: "*J*/*J*_{max}",
        value_range: Some((-1.0, 1.0)),
        palette: Palette::Diverging,
        width: Width::DoubleColumn,
        ..SpaceTimeFigure::default()
    }
    .draw()
    .map_err(|source| RunError::Figure {
        figure: "space-time",
        source,
    })
}

fn snapshot(run: &Run) -> Result<Drawing, FigureError> {
    Scene::of(run).figure().draw()
}

/// The final states of several runs above each other, each with a label in markup: one scale, one bar of colours.
///
/// # Errors
/// If a figure cannot be drawn, for instance without a run.
pub fn snapshot_stack(runs: &[(&str, &Run)]) -> Result<Drawing, FigureError> {
    let scenes: Vec<Scene> = runs.iter().map(|(_, run)| Scene::of(run)).collect();
    let snapshots: Vec<(&str, SnapshotFigure<'_>)> = runs
        .iter()
        .zip(&scenes)
        .map(|((label, _), scene)| (*label, scene.figure()))
        .collect();
    SnapshotStack {
        title: "",
        snapshots: &snapshots,
        width: Width::DoubleColumn,
    }
    .draw()
}

/// What a snapshot shows of a run.
struct Scene {
    title: String,
    grains: Vec<SnapshotGrain>,
    /// Where the wall is, place by place.
    outline: (Vec<f64>, Vec<f64>),
    /// The spheres of an elastic wall.
    spheres: Vec<SnapshotSphere>,
    length: f64,
    tube: f64,
    wavelength: f64,
}

impl Scene {
    fn figure(&self) -> SnapshotFigure<'_> {
        SnapshotFigure {
            title: &self.title,
            grains: &self.grains,
            wall: if self.spheres.is_empty() {
                SnapshotWall::Outline(Series {
                    x: &self.outline.0,
                    y: &self.outline.1,
                })
            } else {
                SnapshotWall::Spheres(&self.spheres)
            },
            start: 0.0,
            length: self.length,
            period: Some(self.tube),
            wavelength: Some(self.wavelength),
            velocity_limit: 1.0,
            length_unit: "*d*",
            width: Width::DoubleColumn,
        }
    }

    fn of(run: &Run) -> Self {
        let configuration = run.configuration();
        let simulation = run.simulation();
        let tube = simulation.wall().lattice().length();
        let heading = simulation.wall().heading();
        let speed = configuration.wave_speed();
        // Drawn with the wave running to the right.
        let along = |z: f64| if heading > 0.0 { z } else { tube - z };
        let length =
            configuration.tube.wavelength * f64::from(configuration.tube.waves.min(SNAPSHOT_WAVES));
        // A grain that has flown off must not stretch the picture, and those beyond its ends are many.
        let shows = |seen: &SeenSphere| {
            let sphere = seen.sphere;
            let (place, margin) = (sphere.along, sphere.diameter);
            sphere.across.hypot(sphere.depth) < SNAPSHOT_RADII * configuration.tube.radius
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
        let points = 400;
        let shape = TubeShape::of(simulation);
        let outline: (Vec<f64>, Vec<f64>) = (0..=points)
            .map(|point| {
                let place = length * f64::from(point) / f64::from(points);
                (place, shape.radius(along(place).rem_euclid(tube)))
            })
            .unzip();
        let title = format!(
            "{},  *t*/*T* = {:.2}",
            title(configuration),
            simulation.wall().cycles()
        );
        Self {
            title,
            grains,
            outline,
            spheres,
            length,
            tube,
            wavelength: configuration.tube.wavelength,
        }
    }
}
