//! What a chart draws, read off its shapes.

use super::*;
use crate::axis::Scale;
use crate::colour::Colour;
use crate::drawing::{Fill, Shape};
use crate::geometry::{Path, Point};

fn figure(panel: ChartPanel) -> Drawing {
    ChartFigure::new(panel).draw().expect("drawable")
}

fn panel() -> ChartPanel {
    ChartPanel::new("*x*", "*y*")
        .x_range(0.0..=10.0)
        .y_range(0.0..=10.0)
}

/// Two guides at 0 and 10 tell where values lie on the page.
fn ruler(drawing: &Drawing) -> impl Fn(Point) -> (f64, f64) + use<> {
    let frame = outline(drawing);
    let (left, bottom, right, top) = frame;
    move |point| {
        (
            10.0 * (point.x - left) / (right - left),
            10.0 * (bottom - point.y) / (bottom - top),
        )
    }
}

/// Left, bottom, right and top of the first frame.
fn outline(drawing: &Drawing) -> (f64, f64, f64, f64) {
    let corners = drawing.paths("axes")[1].points();
    (corners[0].x, corners[2].y, corners[1].x, corners[0].y)
}

/// Outline, places and fill of each set of marks that are discs.
fn marks(drawing: &Drawing) -> Vec<(&Path, Vec<Point>, Colour)> {
    let mark = |shape| match shape {
        &Shape::Path {
            ref path,
            fill: Some(Fill::Flat(colour)),
            ..
        } => (path, path.points(), colour),
        other => panic!("points are marks, not {other:?}"),
    };
    drawing.shapes("points").into_iter().map(mark).collect()
}

fn segments(drawing: &Drawing, name: &str) -> Vec<[Point; 2]> {
    let points = drawing.paths(name).into_iter().flat_map(Path::points);
    let points: Vec<Point> = points.collect();
    points.chunks(2).map(|ends| [ends[0], ends[1]]).collect()
}

/// Places on the page have these values, and there are no others.
fn assert_values(drawing: &Drawing, found: &[Point], expected: &[(f64, f64)]) {
    let value = ruler(drawing);
    assert_eq!(found.len(), expected.len(), "{found:?}");
    for (place, expected) in found.iter().zip(expected) {
        let found = value(*place);
        let is_close = (found.0 - expected.0).abs() < 1e-9 && (found.1 - expected.1).abs() < 1e-9;
        assert!(is_close, "{found:?}, not {expected:?}");
    }
}

#[test]
fn points_stand_at_their_values_and_gaps_are_left_out() {
    let (x, y) = ([1.0, f64::NAN, 5.0, 12.0], [2.0, 3.0, 10.0, 4.0]);
    let drawing = figure(panel().with(Points::new("a", &x, &y)));
    // Neither the gap nor the point outside.
    assert_values(&drawing, &marks(&drawing)[0].1, &[(1.0, 2.0), (5.0, 10.0)]);
}

#[test]
fn errors_reach_below_and_above() {
    let points = Points::new("a", &[4.0], &[5.0])
        .y_errors(&[3.0])
        .x_errors(&[f64::NAN]);
    let drawing = figure(panel().with(points));
    let bars = segments(&drawing, "error bars");
    assert_values(&drawing, &bars[0], &[(4.0, 2.0), (4.0, 8.0)]);
    assert_eq!(bars.len(), 3, "an unknown error has neither bar nor cap");
}

#[test]
fn errors_downwards_and_upwards_may_differ() {
    let points = Points::new("a", &[4.0], &[5.0]).y_sides(&[[3.0, f64::INFINITY]]);
    let drawing = figure(panel().with(points));
    let bars = segments(&drawing, "error bars");
    assert_values(&drawing, &bars[0], &[(4.0, 2.0), (4.0, 5.0)]);
}

#[test]
fn the_line_that_joins_points_only_hints_at_a_jump() {
    let x = [1.0, 2.0, 3.0, 4.0];
    let points = Points::new("a", &x, &x).joined().broken_at(2.5);
    let drawing = figure(panel().with(points));
    let joins = drawing
        .shapes("joins")
        .into_iter()
        .map(|shape| match shape {
            Shape::Path {
                path,
                stroke: Some(stroke),
                ..
            } => (path.points(), stroke.pattern),
            other => panic!("joins are lines, not {other:?}"),
        });
    let joins: Vec<(Vec<Point>, Pattern)> = joins.collect();
    let expected = [
        ([1.0, 2.0], Pattern::Solid),
        ([3.0, 4.0], Pattern::Solid),
        ([2.0, 3.0], Pattern::Dotted),
    ];
    assert_eq!(joins.len(), expected.len());
    for ((line, pattern), (ends, expected)) in joins.iter().zip(expected) {
        assert_values(&drawing, line, &ends.map(|end| (end, end)));
        assert_eq!(*pattern, expected);
    }
}

#[test]
fn a_value_has_one_marker_in_all_panels_and_the_legend_tells_few_of_them() {
    let of = |values: &[f64]| {
        let points = values
            .iter()
            .map(|value| Points::new("", &[1.0], &[*value]).tint(Tint::Value(*value)));
        panel().with_all(points)
    };
    let draw = |panels: [ChartPanel; 2]| {
        let scale = ColourScale::new("rate", 1.0, 20.0);
        let chart = ChartFigure::grid(2, panels).colour_scale(scale);
        chart.draw().expect("drawable")
    };
    let drawing = draw([of(&[3.0, 7.0]), of(&[7.0])]);
    let found = marks(&drawing);
    let corners: Vec<usize> = found.iter().map(|mark| mark.0.steps.len()).collect();
    assert_eq!(corners[1], corners[2], "7 is alike in both");
    assert_ne!(corners[0], corners[1]);
    let words = |drawing: &Drawing| -> Vec<String> {
        let texts = drawing.texts("legend").into_iter();
        texts.map(|(_, text)| text.to_owned()).collect()
    };
    assert_eq!(words(&drawing), ["rate:", "3", "7"]);
    assert!(drawing.shapes("colour bar").is_empty());
    let many: Vec<f64> = (1..=20).map(f64::from).collect();
    let drawing = draw([of(&many), of(&[7.0])]);
    assert!(words(&drawing).is_empty());
    assert!(!drawing.shapes("colour bar").is_empty());
}

#[test]
fn panels_in_a_column_have_one_range_where_they_are_alike() {
    let of = |y: f64| ChartPanel::new("x", "y").with(Points::new("", &[1.0, 2.0], &[0.0, y]));
    let places = |chart: ChartFigure| {
        let drawing = chart.draw().expect("drawable");
        let found = marks(&drawing);
        [0, 1].map(|panel| found[panel].1[0].y - found[panel].1[1].y)
    };
    let [first, second] = places(ChartFigure::grid(1, [of(1.0), of(10.0)]));
    assert!((first - second).abs() < 1e-9);
    let [first, second] = places(ChartFigure::grid(1, [of(1.0), of(10.0)]).alike_y());
    assert!((10.0 * first - second).abs() < 1e-9);
}

#[test]
fn a_panel_without_data_is_drawn_beside_others() {
    let note = Note::corner(Corner::TopLeft, "nothing yet");
    let empty = || ChartPanel::new("x", "y").with(note.clone());
    let full = ChartPanel::new("x", "y").with(Points::new("", &[1.0, 2.0], &[3.0, 4.0]));
    let logarithmic = empty().y_scale(Scale::Logarithmic);
    let chart = ChartFigure::grid(2, [empty(), full, logarithmic]);
    assert_eq!(marks(&chart.draw().expect("drawable")).len(), 1);
    let alike = ChartFigure::grid(1, [empty(), empty()]).alike_y();
    assert!(alike.draw().is_ok());
}

#[test]
fn an_axis_of_names_has_them_at_whole_numbers() {
    let names = ["one", "other"].map(str::to_owned);
    let panel = ChartPanel::new("x", "y").y_range(0.0..=1.0).x_names(&names);
    let drawing = figure(panel.with(Points::new("", &[1.0, 2.0], &[0.5, 0.5])));
    let texts = drawing.texts("axes").into_iter();
    let texts: Vec<&str> = texts.map(|(_, text)| text).collect();
    assert!(
        names.iter().all(|name| texts.contains(&&**name)),
        "{texts:?}"
    );
}

#[test]
fn a_lower_limit_is_open_and_has_an_arrow_upwards() {
    let points = Points::new("a", &[2.0, 4.0], &[3.0, 5.0]).lower_limits(&[false, true]);
    let drawing = figure(panel().with(points));
    let found = marks(&drawing);
    assert_eq!(found.len(), 2);
    assert!(found[0].2.opacity > found[1].2.opacity, "filled, then open");
    let shaft = segments(&drawing, "error bars")[0];
    assert_eq!(shaft[0], found[1].1[0]);
    assert!(shaft[1].y < shaft[0].y - 5.0 && shaft[1].x == shaft[0].x);
}

#[test]
fn arrows_of_lower_limits_stay_in_the_panel() {
    let points = Points::new("a", &[2.0, 4.0], &[3.0, 5.0]).lower_limits(&[false, true]);
    let panel = ChartPanel::new("x", "y").y_scale(Scale::Logarithmic);
    let drawing = figure(panel.with(points));
    let (_, _, _, top) = outline(&drawing);
    let bars = segments(&drawing, "error bars");
    assert!(bars.iter().flatten().all(|end| end.y > top));
}

#[test]
fn series_differ_in_marker_and_colour_and_a_fit_shares_its_colour() {
    let x = [1.0, 2.0];
    let drawing = figure(
        panel()
            .with(Points::new("a", &x, &x))
            .with(Points::new("b", &x, &x))
            .with(Line::new("fit of b", &x, &x).series(1)),
    );
    let [(one, _, first), (other, _, second)] = &marks(&drawing)[..] else {
        panic!("two sets of marks")
    };
    assert_ne!(one.steps.len(), other.steps.len());
    assert_ne!(first, second);
    let &Shape::Path {
        stroke: Some(stroke),
        ..
    } = drawing.shapes("lines")[0]
    else {
        panic!("a line")
    };
    assert_eq!(stroke.colour, *second);
}

#[test]
fn an_error_bar_to_nought_on_a_logarithmic_axis_reaches_the_frame() {
    let chart = ChartPanel::new("x", "y")
        .y_scale(Scale::Logarithmic)
        .y_range(0.1..=10.0)
        .with(Points::new("a", &[1.0, 2.0], &[1.0, 2.0]).y_errors(&[1.5, 0.5]));
    let drawing = figure(chart);
    let (_, bottom, ..) = outline(&drawing);
    assert!((segments(&drawing, "error bars")[0][0].y - bottom).abs() < 1e-9);
}

#[test]
fn the_legend_covers_no_curve() {
    let x: Vec<f64> = (0..=100).map(|index| f64::from(index) / 10.0).collect();
    // A curve through three corners leaves the lower right one.
    let y: Vec<f64> = x
        .iter()
        .map(|x| if *x < 2.0 { 4.9 * x } else { 9.8 })
        .collect();
    let drawing = figure(panel().with(Line::new("a curve", &x, &y)));
    let value = ruler(&drawing);
    let (across, up) = value(drawing.texts("legend")[0].0);
    // Letters rise by less than half a unit above their baseline.
    assert!(across > 2.5 && up + 0.5 < 9.8 && up > 0.0, "{across} {up}");
}

#[test]
fn a_legend_without_room_goes_below_the_figure() {
    let x: Vec<f64> = (0..=200).map(|index| f64::from(index) / 20.0).collect();
    let y: Vec<f64> = (0..=200).map(|index| f64::from(index % 2) * 10.0).collect();
    let drawing = figure(panel().with(Line::new("noise", &x, &y)));
    let (_, bottom, ..) = outline(&drawing);
    let texts = drawing.texts("legend");
    assert!(texts.iter().all(|(start, _)| start.y > bottom));
}

#[test]
fn a_band_and_a_line_of_one_name_share_an_entry() {
    let x = [0.0, 10.0];
    let drawing = figure(
        panel()
            .with(Line::new("fit", &x, &[1.0, 2.0]).series(0))
            .with(Band::new("fit", &x, &[0.5, 1.5], &[1.5, 2.5]).series(0)),
    );
    assert_eq!(drawing.texts("legend").len(), 1);
}

#[test]
fn steps_and_bars_hold_their_heights() {
    let drawing = figure(
        panel()
            .with(Line::new("", &[1.0, 4.0, 6.0], &[8.0, 3.0, 3.0]).stepped())
            .with(Bars::new("", &[0.0, 1.0, 2.0], &[2.0, 5.0])),
    );
    let steps = &drawing.paths("lines")[0].points()[1..3];
    assert_values(&drawing, steps, &[(4.0, 8.0), (4.0, 3.0)]);
    let (x, y) = (
        [0.0, 0.0, 1.0, 1.0, 2.0, 2.0],
        [0.0, 2.0, 2.0, 5.0, 5.0, 0.0],
    );
    let corners: Vec<(f64, f64)> = x.into_iter().zip(y).collect();
    assert_values(&drawing, &drawing.paths("bars")[0].points(), &corners);
}

#[test]
fn a_row_that_is_not_finite_cuts_the_curve() {
    let x = [0.0, 1.0, 2.0, f64::INFINITY, 4.0];
    let y = [1.0, f64::NAN, 3.0, 4.0, 5.0];
    let drawing = figure(panel().with(Line::new("", &x, &y)));
    let pieces = drawing.paths("lines");
    assert_eq!(pieces.len(), 3);
    for (piece, place) in pieces.iter().zip([(0.0, 1.0), (2.0, 3.0), (4.0, 5.0)]) {
        assert_values(&drawing, &piece.points(), &[place]);
    }
}

#[test]
fn a_band_runs_forth_above_and_back_below() {
    let band = Band::new("", &[1.0, 2.0], &[1.5, 2.75], &[2.5, 3.25]);
    let drawing = figure(panel().with(band));
    let corners = [(1.0, 2.5), (2.0, 3.25), (2.0, 2.75), (1.0, 1.5)];
    assert_values(&drawing, &drawing.paths("bands")[0].points(), &corners);
}

#[test]
fn panels_that_share_an_axis_have_one_range_and_one_row_of_numbers() {
    let chart = |top: f64| ChartPanel::new("x", "y").with(Line::new("", &[0.0, 1.0], &[0.0, top]));
    let numbers = |shares: bool| {
        let figure = ChartFigure::grid(2, [chart(1.0), chart(100.0)]);
        let figure = if shares { figure.share_y() } else { figure };
        let drawing = figure.draw().expect("drawable");
        let lines = drawing.paths("lines");
        let (low, high) = (lines[0].points(), lines[1].points());
        let texts = drawing.texts("axes");
        let names = texts.iter().filter(|(_, text)| *text == "y").count();
        ((low[1].y - high[1].y).abs(), names)
    };
    assert_eq!(numbers(true).1, 1);
    assert!(numbers(true).0 > 50.0);
    assert_eq!(numbers(false).1, 2);
    assert!(numbers(false).0 < 1e-9);
}

#[test]
fn a_field_fills_its_frame_from_the_lowest_row_and_what_is_missing_is_grey() {
    let scale = ColourScale::new("", 0.0, 1.0);
    let field = Field::new(&[0.0, f64::NAN, 0.5, 1.0], 2, (0.0, 4.0), (0.0, 2.0));
    let figure = ChartFigure::new(ChartPanel::new("x", "y").with(field));
    let drawing = figure.colour_scale(scale.clone()).draw().expect("drawable");
    let Shape::Image(image) = drawing.shapes("field")[0] else {
        panic!("a field is of cells")
    };
    let (left, bottom, right, top) = outline(&drawing);
    assert_eq!((image.area.left, image.area.top), (left, top));
    assert!((image.area.right() - right).abs() + (image.area.bottom() - bottom).abs() < 1e-9);
    let colours = [scale.srgb(0.5), scale.srgb(1.0), scale.srgb(0.0), [190; 3]];
    assert_eq!(
        (image.columns, &image.pixels[..]),
        (2, &colours.concat()[..])
    );
}

#[test]
fn letters_go_on_after_the_alphabet() {
    assert_eq!(
        [0, 25, 26, 27, 52].map(letter),
        ["a", "z", "aa", "ab", "ba"]
    );
}
