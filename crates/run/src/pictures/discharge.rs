//! The figure of the discharge of an open tube.

use peristalsis_analysis::number::with_error;
use peristalsis_figures::chart::{ChartFigure, ChartPanel, LegendPlace, Line, Pattern, Tint};
use peristalsis_figures::{Drawing, FigureError};

use super::{HEIGHT, title};
use crate::run::Run;
use crate::scene::units;
use crate::summary::Discharge;

/// Mass that has left through the outlet, and mass between the ends, against time.
pub(super) fn discharge(run: &Run, discharge: &Discharge) -> Result<Drawing, FigureError> {
    let samples = run.recorder().samples();
    let time: Vec<f64> = samples.iter().map(|it| it.time).collect();
    let discharged: Vec<f64> = samples.iter().map(|it| it.discharged).collect();
    let hold_up: Vec<f64> = samples.iter().map(|it| it.hold_up).collect();
    let last = time.last().copied().unwrap_or(1.0);
    let (rate, error) = discharge.rate;
    let begin = (1.0 - run.late_fraction()) * last;
    let line = [begin, last].map(|time| discharge.discharged + rate * (time - last));
    let name = format!("late rate {} *m*/*t*", with_error(rate, error));
    let panel = ChartPanel::new(
        &format!("time *t* / {}", units(run.configuration()).time()),
        "mass / *m*",
    )
    .x_range(0.0..=last)
    .y_range(0.0..)
    .with(Line::new("discharged", &time, &discharged).tint(Tint::Blue))
    .with(Line::new("between the ends", &time, &hold_up).tint(Tint::Green))
    .with(
        Line::new(&name, &[begin, last], &line)
            .tint(Tint::Orange)
            .pattern(Pattern::Dashed),
    );
    ChartFigure::new(panel)
        .title(&title(run.configuration()))
        .description("Mass that has left through the outlet, and mass in the tube, against time.")
        .panel_height(HEIGHT)
        .legend(LegendPlace::Below)
        .draw()
}
