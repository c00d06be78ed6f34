//! The figures of a run: charts of its measurements, and the tube from the side.

mod discharge;
mod profile;
mod snapshot;

use peristalsis_analysis::number::{decimal, plain, rounded, with_error};
use peristalsis_configuration::{
    Arrangement, Configuration, Control, InitialState, ScheduledParameter, WaveDirection,
    WaveformName, word,
};
use peristalsis_figures::chart::{
    Band, ChartFigure, ChartLayer, ChartPanel, Field, LegendPlace, Line, Pattern, Points,
    Reference, TITLE_SEPARATOR, Tint,
};
use peristalsis_figures::{
    ColourScale, Drawing, FigureError, Palette, Quantity, Scale, Units, Width,
};
use peristalsis_observe::Sample;

use crate::error::RunError;
use crate::run::Run;
use crate::scene::{refused, units};
use crate::summary::Summary;
use crate::tables::late_profile;

use self::discharge::discharge;
use self::profile::{profile, wall};
use self::snapshot::snapshot;
pub use self::snapshot::snapshot_stack;

/// Periods up to which the mean over each has its own mark.
const MARKED_PERIODS: usize = 60;
/// Periods from which the axis of time ends at a whole one, though the last sample may fall a little short.
const MANY_PERIODS: f64 = 5.0;
/// How far beyond a whole period, by rounding, the last sample may fall.
const WHOLE: f64 = 1e-6;
/// Heights of panels in millimetres: against one quantity, of two below each other, and of space and time.
const HEIGHT: f64 = 42.0;
const LOW_HEIGHT: f64 = 30.0;
const SPACE_TIME_HEIGHT: f64 = 50.0;

/// Places in time at which the course of a driven parameter is drawn.
const PLACES: u32 = 1000;

/// The names of all figures.
pub(crate) const NAMES: [&str; 5] = ["discharge", "flow", "profile", "snapshot", "wall"];

/// All figures of a run, by name. A static wave has no periods and no flow figure; without grains there is nothing to
/// draw.
pub(crate) fn draw_all(
    run: &Run,
    summary: &Summary,
) -> Result<Vec<(&'static str, Drawing)>, RunError> {
    let configuration = run.configuration();
    let mut drawings = Vec::new();
    let mut add = |name: &'static str, drawing: Result<Drawing, FigureError>| {
        drawings.push((name, drawing.map_err(RunError::of_figure(name))?));
        Ok::<_, RunError>(())
    };
    let samples = run.recorder().samples();
    if let Some(of_outlet) = summary.discharge.filter(|_| !samples.is_empty()) {
        add(
            "discharge",
            discharge(run, &of_outlet, summary.late_part(samples.len())),
        )?;
    }
    if samples.iter().any(|it| it.flow_rate_ratio.is_finite()) {
        add("flow", flow(run, summary))?;
        let bins = late_profile(run);
        // The late part may have no grain left inside.
        if bins.iter().any(|it| it.axial_velocity.0.is_finite()) {
            add("profile", profile(run))?;
        }
    }
    if configuration.grains.number > 0 {
        add("snapshot", snapshot(run))?;
    }
    let is_elastic = matches!(configuration.drive.control, Control::Stress { .. });
    if is_elastic && !samples.is_empty() {
        add("wall", wall(run))?;
    }
    Ok(drawings)
}

/// The parameters of a run as the title of its figures has them, in the markup of [`letters`](peristalsis_figures::letters).
pub fn title(configuration: &Configuration) -> String {
    let value = |parameter, constant| scheduled_value(configuration, parameter, constant);
    let (control, density) = match configuration.drive.control {
        Control::Strain { width } => {
            let width = value(ScheduledParameter::Width, width);
            // Not all grains are in an open tube.
            let is_known = configuration.tube.ends.is_periodic();
            let density = is_known.then(|| format!("*ρ* = {:.3}", configuration.volume_fraction()));
            (format!("*w* = {width} *d*"), density)
        }
        Control::Stress {
            force_amplitude, ..
        } => {
            let force = value(ScheduledParameter::ForceAmplitude, force_amplitude);
            let density = format!("*n* = {:.3}", configuration.number_density());
            let unit = units(configuration).force();
            (format!("*f*^{{P}} = {force} {unit}"), Some(density))
        }
    };
    let rate = value(
        ScheduledParameter::StrainRate,
        configuration.drive.strain_rate,
    );
    // In an open tube those that have left wait until they are put in again.
    let waits = configuration.inlet.is_some();
    let wait = if waits { " with those that wait" } else { "" };
    let rate = format!("*ε\u{307}* = {rate} {}", units(configuration).rate());
    let number = format!("*N* = {}{wait}", configuration.grains.number);
    let usual = [Some(control), Some(rate), density, Some(number)];
    let all: Vec<String> = usual
        .into_iter()
        .flatten()
        .chain(particular(configuration))
        .collect();
    all.join(TITLE_SEPARATOR)
}

/// Settings of a run that few have: those that differ from the words and numbers below, and its body force.
fn particular(configuration: &Configuration) -> impl Iterator<Item = String> {
    let drive = &configuration.drive;
    let usual_friction = match drive.control {
        Control::Strain { .. } => 0.0,
        Control::Stress { .. } => 0.5,
    };
    let choices = [
        ("wave", word(drive.waveform), word(WaveformName::Sine)),
        (
            "direction",
            word(drive.direction),
            word(WaveDirection::Forward),
        ),
        (
            "start",
            word(configuration.initial.state),
            word(InitialState::Rest),
        ),
        (
            "wall",
            word(configuration.tube.arrangement),
            word(Arrangement::Staggered),
        ),
    ];
    let choices = choices
        .into_iter()
        .filter(|(_, chosen, usual)| chosen != usual);
    let choices = choices.map(|(name, chosen, _)| format!("{name}: {chosen}"));
    let friction = configuration.contact.friction;
    let friction = friction.map_or(0.0, |law| law.static_friction);
    let friction = (friction != usual_friction).then(|| format!("*μ*_{{s}} = {}", short(friction)));
    choices.chain(friction).chain(body_force(configuration))
}

/// Force over mass on the grains: along the wave if it has no other part, else the vector whose z component it is.
fn body_force(configuration: &Configuration) -> Option<String> {
    let [x, y, _] = configuration.body.gravity;
    let along = configuration.axial_body_force();
    let force = match (x, y) {
        (0.0, 0.0) => short(along),
        _ => {
            let z = configuration.heading() * along;
            format!("({}, {}, {})", short(x), short(y), short(z))
        }
    };
    let unit = units(configuration).acceleration();
    configuration
        .has_body_force()
        .then(|| format!("*g* = {} {unit}", force.replace('-', "−")))
}

/// A drive parameter as a title shows it: its value, or the extent of its schedule.
fn scheduled_value(
    configuration: &Configuration,
    parameter: ScheduledParameter,
    constant: f64,
) -> String {
    match configuration.drive.schedule(parameter) {
        Some(schedule) => {
            let periods = configuration.run.periods.unwrap_or(f64::INFINITY);
            match schedule.extent(periods) {
                [first, last] if first == last => short(first),
                extent => extent.map(short).join(" to "),
            }
        }
        None => short(constant),
    }
}

/// A number as it was given, with up to six digits; what SI has made of one, with three.
fn short(value: f64) -> String {
    let given = rounded(value, 6);
    let shown = if given == value {
        given
    } else {
        rounded(value, 3)
    };
    // One zero, not two.
    (shown + 0.0).to_string()
}

/// J/Jmax in time, as a pair of t/T and J/Jmax for each sample, and for the average over each period; T is the period of
/// `drive.strain_rate`. Each stands at the middle of what it is the mean over.
pub fn flow_in_time(run: &Run) -> [(Vec<f64>, Vec<f64>); 2] {
    let (recorder, rate) = (run.recorder(), run.configuration().drive.strain_rate);
    let samples = recorder.samples();
    // A sample is the mean over the interval that ends with it, an average that over so many intervals.
    let middles = |count: usize, intervals: f64| -> Vec<f64> {
        let end = |k: usize| clock(samples, (k as f64 * intervals).ceil() as usize, rate);
        (0..count).map(|k| 0.5 * (end(k) + end(k + 1))).collect()
    };
    let ratio: Vec<f64> = samples.iter().map(|it| it.flow_rate_ratio).collect();
    let averages = recorder.averages().to_vec();
    [
        (middles(samples.len(), 1.0), ratio),
        (
            middles(averages.len(), recorder.samples_of_average()),
            averages,
        ),
    ]
}

/// t/T at the end of so many samples.
fn clock(samples: &[Sample], number: usize, strain_rate: f64) -> f64 {
    let last = number.min(samples.len()).checked_sub(1);
    last.map_or(0.0, |last| samples[last].time * strain_rate)
}

fn flow(run: &Run, summary: &Summary) -> Result<Drawing, FigureError> {
    let configuration = run.configuration();
    let samples = run.recorder().samples();
    let end = |number: usize| clock(samples, number, configuration.drive.strain_rate);
    let [(time, ratio), (periods, averages)] = flow_in_time(run);
    let measured = end(samples.len());
    let mut last = measured;
    if last >= MANY_PERIODS {
        last = (last - WHOLE).ceil();
    }
    let samples_line = Line::new("samples", &time, &ratio).tint(Tint::Sky);
    let mut panel = ChartPanel::new(&label(Quantity::Period), &label(Quantity::FlowRateRatio))
        .x_range(0.0..=last)
        .with_all([guide(0.0), guide(1.0)])
        .with(samples_line.weight(0.6));
    if let [_] = samples {
        // One sample is no line.
        let mark = Points::new("samples", &time, &ratio).tint(Tint::Sky);
        panel = panel.with(mark.series(0));
    }
    if averages.iter().any(|average| average.is_finite()) {
        let name = "mean over a period";
        let line = Line::new(name, &periods, &averages).tint(Tint::Blue);
        panel = panel.with(line.weight(1.1));
        if averages.len() <= MARKED_PERIODS {
            let marks = Points::new(name, &periods, &averages).tint(Tint::Blue);
            panel = panel.with(marks.series(0));
        }
    }
    let threshold = configuration.observe.transition_threshold;
    let level = Line::new("threshold", &[0.0, last], &[threshold; 2]).tint(Tint::Black);
    panel = panel.with(level.pattern(Pattern::Dotted).weight(0.7));
    let late_mean = late_mean(
        summary.flow_rate_ratio,
        summary.late_part(samples.len()),
        measured,
    );
    panel = panel.with_all(late_mean.into_iter().flatten());
    panel = panel.with_all(newtonian_fluid(summary, last));
    if let Some(time) = summary.transition_time {
        let passed = samples.partition_point(|sample| sample.time <= time);
        let start = passed.checked_sub(1).map_or(0.0, |it| samples[it].time);
        let (before, after) = (end(passed), end((passed + 1).min(samples.len())));
        let period = before + (after - before) * (time - start) / samples[0].time;
        let unit = units(configuration).time();
        let words = format!("*τ* = {} {unit} = {} *T*", plain(time), decimal(period, 1));
        let transition = Reference::vertical(period).label(&words);
        panel = panel.with(transition.tint(Tint::Vermillion).pattern(Pattern::Solid));
    }
    let driven = driven(configuration, last);
    let height = if driven.is_empty() {
        HEIGHT
    } else {
        LOW_HEIGHT
    };
    ChartFigure::grid(1, [panel].into_iter().chain(driven))
        .title(&title(configuration))
        .description("Flow rate against time in periods of the wave.")
        .panel_height(height)
        .share_x()
        .legend(LegendPlace::Below)
        .draw()
}

/// What the drive does up to a last period: a panel for each parameter that a schedule changes.
fn driven(configuration: &Configuration, last: f64) -> Vec<ChartPanel> {
    let parameters = [
        (ScheduledParameter::Width, Quantity::Width),
        (ScheduledParameter::ForceAmplitude, Quantity::ForceAmplitude),
        (ScheduledParameter::StrainRate, Quantity::StrainRate),
    ];
    let course = |(parameter, quantity): (ScheduledParameter, Quantity)| {
        let schedule = configuration.drive.schedule(parameter)?;
        let place = |number: u32| last * f64::from(number) / f64::from(PLACES);
        let time: Vec<f64> = (0..=PLACES).map(place).collect();
        let value: Vec<f64> = time.iter().map(|time| schedule.value(*time)).collect();
        let name = quantity.label(units(configuration));
        let panel = ChartPanel::new(&label(Quantity::Period), &name).x_range(0.0..=last);
        Some(panel.with(Line::new("", &time, &value).tint(Tint::Black)))
    };
    parameters.into_iter().filter_map(course).collect()
}

/// A thin line from side to side at a value.
fn guide(value: f64) -> Reference {
    let line = Reference::horizontal(value);
    line.tint(Tint::Grey).pattern(Pattern::Solid)
}

/// The mean over the last part of a run of so many periods, and the band of its error; nothing where either is unknown.
fn late_mean((mean, error): (f64, f64), part: f64, last: f64) -> Option<[ChartLayer; 2]> {
    if !(mean.is_finite() && error.is_finite()) {
        return None;
    }
    let name = format!("late mean {}", with_error(mean, error));
    let late = [(1.0 - part) * last, last];
    let line = Line::new(&name, &late, &[mean; 2]).tint(Tint::Orange);
    let band = Band::new(&name, &late, &[mean - error; 2], &[mean + error; 2]);
    Some([line.into(), band.tint(Tint::Orange).into()])
}

/// Flow of a Newtonian fluid in this tube, up to a last period.
fn newtonian_fluid(summary: &Summary, last: f64) -> Vec<Line> {
    let level = |ratio: Option<f64>, name: &str, pattern: Pattern| {
        let line = Line::new(name, &[0.0, last], &[ratio?; 2]);
        Some(line.tint(Tint::Green).pattern(pattern))
    };
    let (bore, clear_bore) = summary.newtonian.unzip();
    // The load of a fluid counts against its viscosity, which grains do not have.
    let load = summary.pumping.as_ref().map_or("", |_| " without load");
    let name = format!("Newtonian fluid{load} (Shapiro et al. 1969), *φ* = *b*/*a*");
    let in_bore = level(bore, &name, Pattern::Dashed);
    let name = "the same, clear bore, *φ* = *b*/(*a* − *d*_{w}/2)";
    let in_clear_bore = level(clear_bore.flatten(), name, Pattern::DashDotted);
    in_bore.into_iter().chain(in_clear_bore).collect()
}

fn label(quantity: Quantity) -> String {
    // None of these has a unit that depends on the law of contact.
    quantity.label(Units::Linear)
}

/// The space-time diagram of a run: J/Jmax of the grains of each wave, period by period.
///
/// # Errors
/// [`RunError::Picture`] where no period has been measured whole; [`RunError::Figure`] where there is nothing to draw.
pub fn space_time(run: &Run) -> Result<Drawing, RunError> {
    let flows = run.recorder().waves();
    let waves = run.configuration().tube.waves as usize;
    let last = flows.last().filter(|last| last.period > 0.0);
    let (Some(first), Some(last)) = (flows.first(), last) else {
        return Err(refused(
            "the run has measured no whole period of its wave yet",
            "let it run for a period at least, with a wave that moves",
        ));
    };
    let value = |(wave, period): (usize, usize)| flows[period * waves + wave].flow_rate_ratio;
    let periods = flows.len() / waves.max(1);
    let values: Vec<f64> = (0..waves)
        .flat_map(|wave| (0..periods).map(move |period| (wave, period)))
        .map(value)
        .collect();
    // In periods of drive.strain_rate, as in the figure of the flow: columns last equally long, also where a schedule changes
    // how far the wave runs in them.
    let before_last = &flows[flows.len() - 1 - waves.min(flows.len() - 1)];
    let step = first.time.max(last.time - before_last.time);
    let x = [(first.time - step).max(0.0), last.time];
    let [start, end] = x.map(|time| time * run.configuration().drive.strain_rate);
    // The cell of a wave lies about its number, from 0 as in the table of waves.
    let field = Field::new(&values, waves, (start, end), (-0.5, waves as f64 - 0.5));
    let panel = ChartPanel::new(&label(Quantity::Period), &label(Quantity::Wave))
        .y_scale(Scale::Counting)
        .with(field);
    ChartFigure::new(panel)
        .title(&title(run.configuration()))
        .description("Flow rate of each wave against time.")
        .colour_scale(ColourScale::new("*J*/*J*_{max}", -1.0, 1.0).palette(Palette::Diverging))
        .panel_height(SPACE_TIME_HEIGHT)
        .width(Width::DoubleColumn)
        .draw()
        .map_err(RunError::of_figure("space-time"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_in_a_title_are_as_short_as_they_can_be() {
        let numbers = [
            0.05,
            9.617_819_417_918_985e-4,
            -1.814_898_7e-4,
            2.84375,
            0.0,
            -0.0,
        ];
        let texts = ["0.05", "0.000962", "-0.000181", "2.84375", "0", "0"];
        assert_eq!(numbers.map(short), texts);
    }

    #[test]
    fn a_late_mean_with_a_known_error_covers_the_last_part() {
        let (late, name) = ([75.0, 100.0], "late mean 0.90 ± 0.05");
        let line = Line::new(name, &late, &[0.9; 2]).tint(Tint::Orange);
        let band = Band::new(name, &late, &[0.9 - 0.05; 2], &[0.9 + 0.05; 2]);
        let expected = [line.into(), band.tint(Tint::Orange).into()];
        assert_eq!(late_mean((0.9, 0.05), 0.25, 100.0), Some(expected));
        assert_eq!(late_mean((0.9, f64::NAN), 0.25, 100.0), None);
    }
}
