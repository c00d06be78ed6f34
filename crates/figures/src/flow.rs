//! The flow rate of one run against time.

use crate::axis::{Axis, Scale, three_digits, with_error};
use crate::colour::{BLACK, BLUE, GREEN, ORANGE, SKY, VERMILLION};
use crate::drawing::{Anchor, Dash, Drawing, Fill, Rectangle, Stroke};
use crate::envelope::envelope;
use crate::error::{FigureError, finite};
use crate::legend::{Entry, Legend};
use crate::panel::{
    BOTTOM_MARGIN, Labels, Panel, draw_title, guide, left_margin, right_margin, title_space,
};
use crate::series::{Sample, Series, extent};
use crate::style::{LEGEND_SIZE, Width};
use crate::text::Text;

/// Flow rate of one run, J/Jmax against t/T, positive along the wave.
///
/// Samples are drawn faint and averages over periods strong. The vertical range always holds 0 and 1. Rows that are
/// not finite leave gaps; thousands of periods are thinned to their envelope, which loses no extreme.
#[derive(Clone, Copy, Debug, Default)]
pub struct FlowFigure<'a> {
    /// Line above the figure with the parameters of the run, in markup; none if empty.
    pub title: &'a str,
    /// Flow rate ratio J/Jmax (y) against time in periods t/T (x), as sampled.
    pub samples: Series<'a>,
    /// Averages of the ratio over whole periods (y), at the middle of each period (x).
    pub averages: Option<Series<'a>>,
    /// Ratio whose crossing marks the transition.
    pub threshold: Option<f64>,
    /// The transition, where one was found.
    pub transition: Option<Transition<'a>>,
    /// What a Newtonian fluid would do in this tube.
    pub newtonian: Option<NewtonianReference>,
    /// Mean over the last quarter of the run.
    pub late_mean: Option<LateMean>,
    /// Width of the figure.
    pub width: Width,
}

/// The time at which the flow changes its kind.
#[derive(Clone, Copy, Debug)]
pub struct Transition<'a> {
    /// tau/T, where it is marked.
    pub period: f64,
    /// tau in the units of time of the run, as it is labelled.
    pub time: f64,
    /// Unit of time, in markup, for instance `(*m*/*k*)^{1/2}`.
    pub unit: &'a str,
}

/// Flow rate ratio of the Newtonian reference at no pressure rise (Shapiro, Jaffrin & Weinberg 1969).
#[derive(Clone, Copy, Debug)]
pub struct NewtonianReference {
    /// J/Jmax at phi = b/a.
    pub ratio: f64,
    /// J/Jmax at phi = b/(a - d/2), the clear bore.
    pub clear_bore: Option<f64>,
}

/// Mean ratio at the end of a run.
#[derive(Clone, Copy, Debug)]
pub struct LateMean {
    /// Mean of J/Jmax.
    pub mean: f64,
    /// Its standard error.
    pub error: f64,
}

/// Height of the frame as a fraction of the page's width, in one column and in two.
const FRAME_HEIGHT: [f64; 2] = [0.5, 0.32];
/// Free space above and below the data, as a fraction of their range.
const MARGIN: f64 = 0.045;
/// Columns of the envelope in a point of the page.
const COLUMNS_PER_POINT: f64 = 2.0;
/// Periods up to which each average has its own mark.
const MARKED_AVERAGES: usize = 60;
/// Periods below which the axis ends with the data.
const FEW_PERIODS: f64 = 5.0;
/// Space above the frame for the label of the transition.
const TRANSITION_SPACE: f64 = 9.5;

const SAMPLES: Stroke = Stroke::solid(SKY.faint(0.6), 0.45);
const AVERAGES: Stroke = Stroke::solid(BLUE, 1.1);
const THRESHOLD: Stroke = Stroke::solid(BLACK, 0.7).dashed(Dash::Dotted);
const TRANSITION: Stroke = Stroke::solid(VERMILLION, 0.9);
const NEWTONIAN: Stroke = Stroke::solid(GREEN, 0.9).dashed(Dash::Dashed);
const CLEAR_BORE: Stroke = Stroke::solid(GREEN.faint(0.45), 0.9).dashed(Dash::Dashed);
const LATE: Stroke = Stroke::solid(ORANGE, 0.8);

impl FlowFigure<'_> {
    /// Lays the figure out.
    ///
    /// # Errors
    /// If the samples or the averages have no finite row or columns of unequal length, or if a single value (the
    /// threshold, a reference, the transition, the late mean) is not finite.
    pub fn draw(&self) -> Result<Drawing, FigureError> {
        let samples = self.samples.pieces("flow rate")?;
        let averages = match &self.averages {
            Some(averages) => averages.pieces("flow rate averaged over periods")?,
            None => Vec::new(),
        };
        let levels = self.levels()?;
        let points = || samples.iter().chain(&averages).flatten();
        let periods = extent(
            points()
                .map(|sample| sample.x)
                .chain(self.transition.map(|transition| transition.period))
                .chain([0.0]),
        );
        let ratios = extent(
            points()
                .map(|sample| sample.y)
                .chain(levels)
                .chain([0.0, 1.0]),
        );

        let width = self.width.points();
        let x = Axis::linear(whole_periods(periods));
        let y = Axis::with_margin(Scale::Linear, ratios, MARGIN);
        let height = width * FRAME_HEIGHT[usize::from(self.width == Width::DoubleColumn)];
        let top = title_space(self.title)
            + if self.transition.is_some() {
                TRANSITION_SPACE
            } else {
                4.0
            };
        let left = left_margin(&y, height);
        let frame = Rectangle {
            left,
            top,
            width: width - left - right_margin(&x, width - left),
            height,
        };
        let legend = Legend::new(self.entries(), width - 8.0);
        let mut drawing = Drawing::new(
            width,
            frame.bottom() + BOTTOM_MARGIN + legend.height() + 3.0,
            &format!("Flow rate against time: {}", self.title),
        );
        let panel = Panel { frame, x, y };

        draw_title(&mut drawing, self.title, width);
        for level in [0.0, 1.0] {
            panel.level(&mut drawing, "guide", level, guide());
        }
        draw_lines(&mut drawing, &panel, "samples", &samples, SAMPLES);
        draw_lines(&mut drawing, &panel, "averages", &averages, AVERAGES);
        draw_marks(&mut drawing, &panel, &averages);
        self.draw_late_mean(&mut drawing, &panel, periods);
        self.draw_levels(&mut drawing, &panel);
        self.draw_transition(&mut drawing, &panel);
        panel.draw_frame(
            &mut drawing,
            &Labels {
                x: Some("time, *t*/*T*"),
                y: "flow rate, *J*/*J*_{max}",
                letter: None,
            },
        );
        legend.draw(
            &mut drawing,
            4.0,
            width - 4.0,
            frame.bottom() + BOTTOM_MARGIN,
        );
        Ok(drawing)
    }

    /// All single values on the vertical axis.
    fn levels(&self) -> Result<Vec<f64>, FigureError> {
        let mut levels = Vec::new();
        if let Some(threshold) = self.threshold {
            levels.push(finite("threshold", threshold)?);
        }
        if let Some(newtonian) = self.newtonian {
            levels.push(finite("Newtonian reference", newtonian.ratio)?);
            if let Some(clear_bore) = newtonian.clear_bore {
                levels.push(finite("Newtonian reference of the clear bore", clear_bore)?);
            }
        }
        if let Some(late) = self.late_mean {
            let (mean, error) = (
                finite("late mean", late.mean)?,
                finite("error of the late mean", late.error)?,
            );
            levels.extend([mean - error, mean + error]);
        }
        if let Some(transition) = self.transition {
            finite("transition time in periods", transition.period)?;
            finite("transition time", transition.time)?;
        }
        Ok(levels)
    }

    fn entries(&self) -> Vec<Entry> {
        let line = |stroke, meaning: &str| Entry {
            line: Some(stroke),
            meaning: meaning.to_owned(),
            ..Entry::default()
        };
        let mut entries = vec![line(Stroke::solid(SKY.faint(0.8), 0.8), "samples")];
        if self.averages.is_some() {
            entries.push(line(AVERAGES, "mean over a period"));
        }
        if self.threshold.is_some() {
            entries.push(line(THRESHOLD, "threshold"));
        }
        if let Some(late) = self.late_mean {
            let meaning = format!("late mean {}", with_error(late.mean, late.error));
            entries.push(Entry {
                line: Some(LATE),
                band: Some(ORANGE.faint(0.35)),
                meaning,
                ..Entry::default()
            });
        }
        if let Some(newtonian) = self.newtonian {
            entries.push(line(
                NEWTONIAN,
                "Newtonian fluid (Shapiro et al. 1969), *φ* = *b*/*a*",
            ));
            if newtonian.clear_bore.is_some() {
                entries.push(line(
                    CLEAR_BORE,
                    "the same, clear bore, *φ* = *b*/(*a* − *d*/2)",
                ));
            }
        }
        entries
    }

    fn draw_levels(&self, drawing: &mut Drawing, panel: &Panel) {
        if let Some(newtonian) = self.newtonian {
            if let Some(clear_bore) = newtonian.clear_bore {
                panel.level(drawing, "clear bore", clear_bore, CLEAR_BORE);
            }
            panel.level(drawing, "newtonian", newtonian.ratio, NEWTONIAN);
        }
        if let Some(threshold) = self.threshold {
            panel.level(drawing, "threshold", threshold, THRESHOLD);
        }
    }

    fn draw_late_mean(&self, drawing: &mut Drawing, panel: &Panel, (first, last): (f64, f64)) {
        let Some(late) = self.late_mean else { return };
        let start = panel.across(last - (last - first) / 4.0);
        let (top, bottom) = (
            panel.up(late.mean + late.error),
            panel.up(late.mean - late.error),
        );
        let layer = drawing.layer("late mean", Some(panel.frame));
        let area = Rectangle {
            left: start,
            top,
            width: panel.frame.right() - start,
            height: bottom - top,
        };
        layer.rectangle(area, ORANGE.faint(0.35));
        let middle = panel.up(late.mean);
        layer.segment((start, middle), (panel.frame.right(), middle), LATE);
    }

    fn draw_transition(&self, drawing: &mut Drawing, panel: &Panel) {
        let Some(transition) = self.transition else {
            return;
        };
        let place = panel.across(transition.period);
        let frame = panel.frame;
        drawing.layer("transition", Some(frame)).segment(
            (place, frame.top),
            (place, frame.bottom()),
            TRANSITION,
        );
        let label = format!(
            "*τ* = {} {}",
            three_digits(transition.time),
            transition.unit
        );
        let text = Text::fitted(label.trim_end(), LEGEND_SIZE, frame.width);
        let middle = place.clamp(
            frame.left + text.width / 2.0,
            frame.right() - text.width / 2.0,
        );
        drawing.layer("transition", None).text(
            (middle, frame.top - 2.6),
            Anchor::Middle,
            text,
            VERMILLION.towards(BLACK, 0.15),
        );
    }
}

/// A run of several periods ends its axis at a whole one, though its last sample may fall a little short.
fn whole_periods((first, last): (f64, f64)) -> (f64, f64) {
    if last - first >= FEW_PERIODS {
        (first, last.ceil())
    } else {
        (first, last)
    }
}

fn draw_lines(
    drawing: &mut Drawing,
    panel: &Panel,
    name: &'static str,
    pieces: &[Vec<Sample>],
    stroke: Stroke,
) {
    let columns = (panel.frame.width * COLUMNS_PER_POINT) as usize;
    let layer = drawing.layer(name, Some(panel.frame));
    for piece in pieces {
        let thinned = envelope(piece, panel.x.range(), columns);
        match thinned.as_slice() {
            // A lone point has no line, but it must be seen.
            [lone] => layer.circle(
                panel.place(lone.x, lone.y),
                stroke.weight,
                Fill::Flat(stroke.colour),
                None,
            ),
            line => layer.line(panel.line(line), stroke),
        }
    }
}

fn draw_marks(drawing: &mut Drawing, panel: &Panel, averages: &[Vec<Sample>]) {
    if averages.iter().map(Vec::len).sum::<usize>() > MARKED_AVERAGES {
        return;
    }
    let layer = drawing.layer("marks", Some(panel.frame));
    for average in averages.iter().flatten() {
        layer.circle(
            panel.place(average.x, average.y),
            1.5,
            Fill::Flat(BLUE),
            None,
        );
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::drawing::Shape;

    fn figure<'a>(x: &'a [f64], y: &'a [f64]) -> FlowFigure<'a> {
        FlowFigure {
            samples: Series { x, y },
            ..FlowFigure::default()
        }
    }

    #[test]
    fn the_range_holds_nought_and_one_and_back_flow() {
        let drawing = figure(&[0.0, 1.0, 2.0], &[0.3, -0.4, 0.5])
            .draw()
            .expect("drawable");
        let guides: Vec<f64> = drawing
            .shapes("guide")
            .iter()
            .map(|shape| match shape {
                Shape::Line { points, .. } => points[0].y,
                other => panic!("a guide is a line, not {other:?}"),
            })
            .collect();
        let [zero, one] = guides[..] else {
            panic!("two guides, found {guides:?}")
        };
        assert!(one < zero, "one is above nought");
        let Shape::Line { points, .. } = drawing.shapes("samples")[0] else {
            panic!("samples are a line")
        };
        let unit = zero - one;
        for (point, expected) in points.iter().zip([0.3, -0.4, 0.5]) {
            assert!(
                ((zero - point.y) / unit - expected).abs() < 1e-9,
                "{point:?}"
            );
        }
    }

    #[test]
    fn a_late_mean_covers_the_last_quarter() {
        let late_mean = Some(LateMean {
            mean: 0.9,
            error: 0.05,
        });
        let drawing = FlowFigure {
            late_mean,
            ..figure(&[0.0, 100.0], &[0.0, 0.9])
        }
        .draw()
        .expect("drawable");
        let Shape::Line {
            points: samples, ..
        } = drawing.shapes("samples")[0]
        else {
            panic!("a line")
        };
        let Shape::Line { points: late, .. } = drawing.shapes("late mean")[1] else {
            panic!("a line")
        };
        let quarter = samples[0].x + 0.75 * (samples[1].x - samples[0].x);
        assert!((late[0].x - quarter).abs() < 1e-9);
        assert!((late[0].y - samples[1].y).abs() < 1e-9);
    }

    #[test]
    fn a_value_that_is_no_number_is_named() {
        let error = FlowFigure {
            threshold: Some(f64::NAN),
            ..figure(&[0.0], &[0.0])
        }
        .draw()
        .expect_err("no threshold");
        assert!(error.to_string().contains("threshold"), "{error}");
    }
}
