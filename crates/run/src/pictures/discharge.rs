//! The figure of the discharge of an open tube.

use peristalsis_analysis::number::with_error;
use peristalsis_figures::chart::{ChartFigure, ChartPanel, LegendPlace, Line, Pattern, Tint};
use peristalsis_figures::{Drawing, FigureError};

use super::title;
use crate::run::Run;
use crate::scene::units;
use crate::summary::Discharge;

/// Height of a panel in millimetres.
const PANEL_HEIGHT: f64 = 28.0;

/// Mass that has left through the outlet, and below it mass between the ends, against time; the rate of the last part.
pub(super) fn discharge(
    run: &Run,
    discharge: &Discharge,
    late_part: f64,
) -> Result<Drawing, FigureError> {
    let samples = run.recorder().samples();
    let time: Vec<f64> = samples.iter().map(|it| it.time).collect();
    let discharged: Vec<f64> = samples.iter().map(|it| it.discharged).collect();
    let hold_up: Vec<f64> = samples.iter().map(|it| it.hold_up).collect();
    let last = time.last().copied().unwrap_or(1.0);
    let (rate, error) = discharge.rate;
    let begin = (1.0 - late_part) * last;
    let line = [begin, last].map(|time| discharge.discharged + rate * (time - last));
    let unit = units(run.configuration()).time();
    let name = format!("late rate {} *m*/{unit}", with_error(rate, error));
    let panel =
        |label: &str| ChartPanel::new(&format!("time, *t*/{unit}"), label).x_range(0.0..=last);
    let late_rate = Line::new(&name, &[begin, last], &line).tint(Tint::Orange);
    let panels = [
        panel("discharged, *M*/*m*")
            .y_range(0.0..)
            .with(Line::new("", &time, &discharged).tint(Tint::Blue))
            .with(late_rate.pattern(Pattern::Dashed)),
        panel("hold-up, *H*/*m*").with(Line::new("", &time, &hold_up).tint(Tint::Green)),
    ];
    ChartFigure::grid(1, panels)
        .title(&title(run.configuration()))
        .description("Mass that has left through the outlet, and mass in the tube, against time.")
        .panel_height(PANEL_HEIGHT)
        .share_x()
        .legend(LegendPlace::Below)
        .draw()
}
