//! Charts of ensembles, from made-up data.

use std::error::Error;

use peristalsis_figures::chart::{
    Band, Bars, ChartFigure, ChartPanel, Corner, LegendPlace, Line, Marker, Note, Pattern, Points,
    Reference, Tint, Window,
};
use peristalsis_figures::{
    ColourScale, Drawing, Palette, Quantity, Scale, SpaceTimeFigure, Units, Width,
};

use crate::Noise;

type Drawn = Result<Drawing, Box<dyn Error>>;

const LINEAR: Units = Units::Linear;

/// Equally spaced numbers from end to end.
fn spaced(from: f64, to: f64, count: usize) -> Vec<f64> {
    (0..count)
        .map(|index| from + (to - from) * index as f64 / (count - 1) as f64)
        .collect()
}

fn map(values: &[f64], of: impl Fn(f64) -> f64) -> Vec<f64> {
    values.iter().map(|&value| of(value)).collect()
}

fn label(quantity: Quantity) -> String {
    quantity.label(LINEAR)
}

/// Every chart by its name.
pub(crate) fn all() -> Result<Vec<(String, Drawing)>, Box<dyn Error>> {
    let mut drawings = Vec::new();
    for (suffix, width) in [("", Width::SingleColumn), ("_wide", Width::DoubleColumn)] {
        let mut add =
            |name: &str, drawing: Drawing| drawings.push((format!("{name}{suffix}"), drawing));
        add("chart_flow", flow(width)?);
        add("chart_times", times(width)?);
        add("chart_collapse", collapse(width)?);
        add("chart_jump", jump(width)?);
        add("chart_critical", critical(width)?);
        add("chart_panels", panels(width)?);
        add("chart_grid", grid(width)?);
        add("chart_hysteresis", hysteresis(width)?);
        add("chart_histogram", histogram(width)?);
        add("chart_survival", survival(width)?);
        add("space_time", space_time(width)?);
        add("space_time_signed", signed_space_time(width)?);
    }
    Ok(drawings)
}

/// J/Jmax against time for several widths, with colours by the width.
fn flow(width: Width) -> Drawn {
    let mut noise = Noise(21);
    let time = spaced(0.5, 119.5, 120);
    let lines = [(2.5, 7.0), (2.6, 18.0), (2.7, 66.0), (2.82, f64::INFINITY)].map(|(w, onset)| {
        let ratio: Vec<f64> = time
            .iter()
            .map(|&time| {
                let jammed = 1.0 / (1.0 + libm::exp(-(time - onset) / 1.5));
                0.22 + 0.1 * (2.82 - w)
                    + (0.74 - 0.1 * (2.82 - w)) * jammed
                    + 0.03 * (1.2 - jammed) * noise.next()
            })
            .collect();
        Line::new("", &time, &ratio).tint(Tint::Value(w))
    });
    let panel = ChartPanel::new(&label(Quantity::Period), &label(Quantity::FlowRateRatio))
        .x_range(0.0..=120.0)
        .y_range(0.0..=1.1)
        .with(Reference::horizontal(0.5).label("threshold"))
        .with_all(lines);
    let scale = ColourScale::new("width of the bottleneck, *w*/*d*", 2.5, 2.82);
    Ok(ChartFigure::new(panel)
        .title("from rest, *ε\u{307}* = 0.1, *ρ* = 0.15")
        .description(
            "Four runs; the narrower the bottleneck, the earlier the flow jumps to nearly 1.",
        )
        .colour_scale(scale)
        .width(width)
        .draw()?)
}

/// Width, transition time, its errors, and whether it was not seen, at one strain rate.
fn transition_times(rate: f64) -> (Vec<f64>, Vec<f64>, Vec<f64>, Vec<bool>) {
    let critical = 2.9 - 1.1 * rate;
    let widths = spaced(critical - 0.35, critical + 0.06, 9);
    let mut noise = Noise((1e4 * rate) as u64);
    let times: Vec<f64> = widths
        .iter()
        .map(|&width| {
            let distance = critical - width;
            let time = 2.2 / rate / distance.max(0.01) * (1.0 + 0.12 * noise.next());
            time.min(120.0 / rate)
        })
        .collect();
    let limits: Vec<bool> = widths
        .iter()
        .map(|&width| width > critical - 0.01)
        .collect();
    let errors = times
        .iter()
        .zip(&limits)
        .map(|(time, &limit)| if limit { f64::NAN } else { 0.16 * time })
        .collect();
    (widths, times, errors, limits)
}

/// Transition times with censored ones, fitted laws and critical widths.
fn times(width: Width) -> Drawn {
    let mut panel = ChartPanel::new(&label(Quantity::Width), &label(Quantity::TransitionTime))
        .y_scale(Scale::Logarithmic);
    for (series, rate) in [0.025, 0.05, 0.1].into_iter().enumerate() {
        let (widths, times, errors, limits) = transition_times(rate);
        let above: Vec<f64> = map(&errors, |error| 1.5 * error);
        let critical = 2.9 - 1.1 * rate;
        let fine = spaced(critical - 0.4, critical - 0.012, 200);
        let fit = map(&fine, |width| 2.2 / rate / (critical - width));
        let mut points = Points::new(&format!("*ε\u{307}* = {rate}"), &widths, &times)
            .asymmetric_y_errors(&errors, &above)
            .lower_limits(&limits)
            .series(series);
        if series == 2 {
            points = points.limit_name("not seen");
        }
        panel = panel
            .with(points)
            .with(Line::new("", &fine, &fit).series(series).weight(0.8));
    }
    panel = panel.with(
        Reference::vertical(2.9)
            .label("*w*_{max}")
            .pattern(Pattern::Dashed),
    );
    Ok(ChartFigure::new(panel).width(width).draw()?)
}

/// Scaled transition times of three strain rates on one curve.
fn collapse(width: Width) -> Drawn {
    let mut panel = ChartPanel::new("(*w*_{c} − *w*)/*ε\u{307}*^{3/2}", "*τε\u{307}*^{7/2}")
        .x_scale(Scale::Logarithmic)
        .y_scale(Scale::Logarithmic);
    let mut noise = Noise(4);
    for (rate, marker) in [
        (0.025, Marker::Circle),
        (0.05, Marker::Square),
        (0.1, Marker::Triangle),
    ] {
        let scaled = map(&spaced(-1.2, 1.4, 9), |power| {
            libm::pow(10.0, power) * (1.0 + 0.08 * noise.0.count_ones() as f64 / 64.0)
        });
        let times: Vec<f64> = scaled
            .iter()
            .map(|x| 0.02 / (x + 0.1 * x * x) * (1.0 + 0.15 * noise.next()))
            .collect();
        let errors = map(&times, |time| 0.2 * time);
        let x_errors = map(&scaled, |x| 0.12 * x);
        panel = panel.with(
            Points::new(&format!("*ε\u{307}* = {rate}"), &scaled, &times)
                .y_errors(&errors)
                .x_errors(&x_errors)
                .marker(marker)
                .tint(Tint::Value(rate)),
        );
    }
    let x = map(&spaced(-1.4, 1.6, 50), |power| libm::pow(10.0, power));
    let slope = map(&x, |x| 0.02 / x);
    panel = panel.with(
        Line::new("*f*(*x*) ~ *x*^{−1}", &x, &slope)
            .tint(Tint::Black)
            .pattern(Pattern::Dashed)
            .weight(0.8),
    );
    let scale = ColourScale::new("strain rate, *ε\u{307}*", 0.02, 0.125).logarithmic();
    Ok(ChartFigure::new(panel)
        .colour_scale(scale)
        .width(width)
        .draw()?)
}

fn newtonian(width: f64, radius: f64) -> f64 {
    let phi = (1.0 - width / (2.0 * radius)).max(0.0);
    let square = phi * phi;
    square * (16.0 - square) / (2.0 * (2.0 + 3.0 * square)) / (1.0 + square / 2.0)
}

/// Stationary flow rates with their jump, and the Newtonian fluid for comparison.
fn jump(width: Width) -> Drawn {
    let mut panel = ChartPanel::new(&label(Quantity::Width), &label(Quantity::FlowRateRatio))
        .y_range(0.0..=1.08);
    let mut noise = Noise(8);
    for (series, (rate, critical)) in [(0.025, 2.76), (0.05, 2.83), (0.1, 2.63)]
        .into_iter()
        .enumerate()
    {
        let widths = spaced(2.3, 3.0, 15);
        let ratios: Vec<f64> = widths
            .iter()
            .map(|&w| {
                let scatter = 0.012 * noise.next();
                if w < critical {
                    0.99 - 0.05 * (w - 2.3) + scatter
                } else {
                    0.24 - 0.25 * (w - critical) + scatter
                }
            })
            .collect();
        let errors = map(&ratios, |ratio| if ratio > 0.5 { 0.008 } else { 0.03 });
        panel = panel.with(
            Points::new(&format!("*ε\u{307}* = {rate}"), &widths, &ratios)
                .y_errors(&errors)
                .series(series)
                .joined(),
        );
    }
    let fine = spaced(2.3, 3.0, 60);
    panel = panel
        .with(
            Line::new("Newtonian fluid", &fine, &map(&fine, |w| newtonian(w, 1.5)))
                .tint(Tint::Black)
                .pattern(Pattern::Dashed),
        )
        .with(
            Line::new(
                "the same, clear bore",
                &fine,
                &map(&fine, |w| newtonian(w - 1.0, 1.0)),
            )
            .tint(Tint::Grey)
            .pattern(Pattern::Dashed),
        );
    Ok(ChartFigure::new(panel).width(width).draw()?)
}

/// Critical widths with a straight line and its band.
fn critical(width: Width) -> Drawn {
    let rates = [0.02, 0.035, 0.05, 0.075, 0.1, 0.125];
    let widths = [2.925, 2.87, 2.83, 2.735, 2.63, 2.54];
    let fine = spaced(0.0, 0.14, 30);
    let line = map(&fine, |rate| 3.01 - 3.75 * rate);
    let reach = |rate: f64| 0.012 + 0.35 * (rate - 0.07) * (rate - 0.07) / 0.07;
    let lower: Vec<f64> = fine
        .iter()
        .zip(&line)
        .map(|(&rate, y)| y - reach(rate))
        .collect();
    let upper: Vec<f64> = fine
        .iter()
        .zip(&line)
        .map(|(&rate, y)| y + reach(rate))
        .collect();
    let panel = ChartPanel::new(
        &label(Quantity::StrainRate),
        &label(Quantity::CriticalWidth),
    )
    .x_range(0.0..=0.14)
    .with(Points::new("this work", &rates, &widths).y_errors(&[0.02; 6]))
    .with(Line::new("−3.75(12) *ε\u{307}* + 3.01(1), 95 %", &fine, &line).series(1))
    .with(
        Band::new(
            "−3.75(12) *ε\u{307}* + 3.01(1), 95 %",
            &fine,
            &lower,
            &upper,
        )
        .series(1),
    )
    .with(Note::at(0.021, 2.6, "*w*_{max} = 3.01(1) *d*").tint(Tint::Vermillion));
    Ok(ChartFigure::new(panel).width(width).draw()?)
}

/// Three panels beside each other with one vertical axis.
fn panels(width: Width) -> Drawn {
    let time = spaced(0.0, 400.0, 9000);
    let mut noise = Noise(77);
    let panels = [(0.15, 180.0), (0.3, 60.0), (0.6, f64::INFINITY)].map(|(density, onset)| {
        let ratio: Vec<f64> = time
            .iter()
            .map(|&time| {
                0.3 - 0.2 * density
                    + 0.65 / (1.0 + libm::exp(-(time - onset) / 4.0))
                    + 0.08 * noise.next()
            })
            .collect();
        ChartPanel::new(&label(Quantity::Period), &label(Quantity::FlowRateRatio))
            .title(&format!("*ρ* = {density}"))
            .x_range(0.0..=400.0)
            .with(Line::new("", &time, &ratio).weight(0.5))
            .with(
                Reference::horizontal(1.0)
                    .tint(Tint::Grey)
                    .pattern(Pattern::Solid),
            )
    });
    Ok(ChartFigure::grid(3, panels).share_y().width(width).draw()?)
}

/// Four small panels with both axes shared, on which ticks are hardest.
fn grid(width: Width) -> Drawn {
    let x = spaced(0.0, 1.0, 80);
    let panels = [0.4, 0.9, 0.2, 0.6].map(|height| {
        let y = map(&x, |x| height * libm::sin(std::f64::consts::TAU * x) * 0.3);
        let heavy = map(&x, |x| {
            height * libm::sin(std::f64::consts::TAU * x) * 0.3 + 0.002
        });
        ChartPanel::new(&label(Quantity::Phase), "*v_z*/*c*")
            .x_range(0.0..=1.0)
            .with(Line::new("reference kernel", &x, &y).series(5).weight(2.2))
            .with(
                Line::new("fast kernel", &x, &heavy)
                    .tint(Tint::Black)
                    .pattern(Pattern::Dashed)
                    .weight(0.8),
            )
            .with(Note::corner(Corner::BottomLeft, &format!("*A* = {height}")))
    });
    Ok(ChartFigure::grid(2, panels)
        .share_x()
        .share_y()
        .panel_height(22.0)
        .legend(LegendPlace::Below)
        .width(width)
        .draw()?)
}

/// Both branches of a hysteresis, with the window between their ends.
fn hysteresis(width: Width) -> Drawn {
    let widths = spaced(2.5, 3.0, 11);
    let branch = |end: f64| {
        map(&widths, |w| {
            if w < end + 1e-9 {
                0.985 - 0.08 * (w - 2.5)
            } else {
                0.2 - 0.2 * (w - 2.7)
            }
        })
    };
    let errors = [0.03; 11];
    let panel = ChartPanel::new(&label(Quantity::Width), &label(Quantity::FlowRateRatio))
        .y_range(0.0..=1.1)
        .with(Window::new("hysteresis", 2.7, 2.9))
        .with(
            Points::new("from rest", &widths, &branch(2.7))
                .y_errors(&errors)
                .joined(),
        )
        .with(
            Points::new("from jammed", &widths, &branch(2.9))
                .y_errors(&errors)
                .open()
                .joined(),
        )
        .with(Reference::vertical(2.7).label("*w*_{c} = 2.70(2) *d*"))
        .with(Reference::vertical(2.9).label("*w*′_{c} = 2.90(2) *d*"));
    Ok(ChartFigure::new(panel).width(width).draw()?)
}

/// A histogram with two peaks, the mixture fitted to it, and another histogram as an outline.
fn histogram(width: Width) -> Drawn {
    let edges = spaced(0.0, 1.1, 34);
    let peak = |x: f64, middle: f64, spread: f64| {
        let distance = (x - middle) / spread;
        libm::exp(-0.5 * distance * distance) / (spread * 2.5066)
    };
    let density =
        |x: f64, share: f64| (1.0 - share) * peak(x, 0.24, 0.07) + share * peak(x, 0.95, 0.04);
    let mut noise = Noise(31);
    let mut heights = |share: f64| -> Vec<f64> {
        edges
            .windows(2)
            .map(|pair| {
                (density(0.5 * (pair[0] + pair[1]), share) * (1.0 + 0.2 * noise.next())).max(0.0)
            })
            .collect()
    };
    let (narrow, wide) = (heights(0.55), heights(0.2));
    let fine = spaced(0.0, 1.1, 200);
    let fit = map(&fine, |x| density(x, 0.55));
    let panel = ChartPanel::new(&label(Quantity::FlowRateRatio), "probability density")
        .x_range(0.0..=1.1)
        .with(Bars::new("*w* = 2.76 *d*", &edges, &narrow).series(5))
        .with(
            Bars::new("*w* = 2.80 *d*", &edges, &wide)
                .outlined()
                .series(1),
        )
        .with(Line::new("two peaks, fitted", &fine, &fit).tint(Tint::Black));
    Ok(ChartFigure::new(panel).width(width).draw()?)
}

/// Survival of the unjammed flow with its band.
fn survival(width: Width) -> Drawn {
    let mut panel = ChartPanel::new(&label(Quantity::Period), &label(Quantity::Survival))
        .x_range(0.0..)
        .y_range(0.0..=1.05);
    for (series, (w, lifetime)) in [(2.7, 35.0), (2.74, 90.0)].into_iter().enumerate() {
        let times: Vec<f64> = (0..=16)
            .map(|index| {
                let share = f64::from(index) / 18.0;
                -lifetime * libm::log(1.0 - share)
            })
            .chain([250.0])
            .collect();
        let alive: Vec<f64> = (0..18_i32)
            .map(|index| 1.0 - f64::from(index.min(16)) / 18.0)
            .collect();
        let reach = |s: f64| 1.2 * (s * (1.0 - s) / 18.0).sqrt();
        let lower = map(&alive, |s| (s - reach(s)).max(0.0));
        let upper = map(&alive, |s| (s + reach(s)).min(1.0));
        let name = format!("*w* = {w} *d*");
        let smooth = spaced(0.0, 250.0, 100);
        let law = map(&smooth, |time| libm::exp(-time / lifetime));
        panel = panel
            .with(
                Band::new(&name, &times, &lower, &upper)
                    .stepped()
                    .series(series),
            )
            .with(Line::new(&name, &times, &alive).stepped().series(series))
            .with(
                Line::new("", &smooth, &law)
                    .series(series)
                    .pattern(Pattern::DashDotted)
                    .weight(0.6),
            );
    }
    Ok(ChartFigure::new(panel).width(width).draw()?)
}

/// Flow rate of each wave against time, some of it missing.
fn space_time(width: Width) -> Drawn {
    let (rows, columns) = (10, 220);
    let mut noise = Noise(17);
    let values: Vec<f64> = (0..rows)
        .flat_map(|row| (0..columns).map(move |column| (row as f64, column as f64)))
        .map(|(row, column)| {
            let onset = 70.0 + 9.0 * (row - 4.0).abs();
            let value =
                0.2 + 0.75 / (1.0 + libm::exp(-(column - onset) / 3.0)) + 0.06 * noise.next();
            if (150.0..156.0).contains(&column) && row > 6.0 {
                f64::NAN
            } else {
                value
            }
        })
        .collect();
    Ok(SpaceTimeFigure {
        title: "*w* = 2.7 *d*, *ε\u{307}* = 0.1",
        values: &values,
        rows,
        x_range: (0.0, columns as f64),
        y_range: (0.5, rows as f64 + 0.5),
        value_label: "flow rate, *J*/*J*_{max}",
        value_range: Some((0.0, 1.0)),
        width,
        ..SpaceTimeFigure::default()
    }
    .draw()?)
}

/// A signed field, far more columns than the page shows.
fn signed_space_time(width: Width) -> Drawn {
    let (rows, columns) = (60, 4000);
    let values: Vec<f64> = (0..rows * columns)
        .map(|index| {
            let (row, column) = ((index / columns) as f64, (index % columns) as f64);
            0.8 * libm::sin(row / 6.0 + column / 230.0) * libm::exp(-column / 3000.0)
        })
        .collect();
    Ok(SpaceTimeFigure {
        values: &values,
        rows,
        x_range: (0.0, 40.0),
        y_range: (0.0, 4.0),
        y_label: "position, *z*/*λ*",
        value_label: "axial velocity, *v_z*/*c*",
        palette: Palette::Diverging,
        width,
        ..SpaceTimeFigure::default()
    }
    .draw()?)
}
