//! Charts as documents: what is refused, what the SVG holds, and the same bytes each time.

use std::collections::HashSet;

use peristalsis_figures::chart::{
    Band, Bars, ChartFigure, ChartLayer, ChartPanel, Corner, Line, Note, Points, Reference, Tint,
    Window,
};
use peristalsis_figures::{
    ColourScale, Drawing, FigureError, Quantity, Scale, SnapshotFigure, SnapshotGrain,
    SnapshotSphere, SnapshotStack, SpaceTimeFigure, Units, Width,
};

fn chart() -> Drawing {
    let x: Vec<f64> = (1..=40).map(f64::from).collect();
    let y: Vec<f64> = x.iter().map(|x| 100.0 / x).collect();
    let errors: Vec<f64> = y.iter().map(|y| 0.1 * y).collect();
    let limits: Vec<bool> = x.iter().map(|x| *x > 38.0).collect();
    let low: Vec<f64> = y.iter().map(|y| 0.8 * y).collect();
    let panel = ChartPanel::new(
        &Quantity::Width.label(Units::Linear),
        &Quantity::TransitionTime.label(Units::Hertz),
    )
    .x_scale(Scale::Logarithmic)
    .y_scale(Scale::Logarithmic)
    .with(Window::new("window", 10.0, 20.0))
    .with(Band::new("fit", &x, &low, &y).series(0))
    .with(Line::new("fit", &x, &y).series(0))
    .with(
        Points::new("*ε\u{307}* = 0.1", &x, &y)
            .y_errors(&errors)
            .lower_limits(&limits)
            .limit_name("not seen")
            .tint(Tint::Value(0.1)),
    )
    .with(Reference::vertical(30.0).label("*w*_{c}"))
    .with(Note::corner(Corner::BottomLeft, "a note"));
    ChartFigure::new(panel)
        .title("a chart")
        .description("Points on a line that falls.")
        .colour_scale(ColourScale::new("strain rate", 0.05, 0.2).logarithmic())
        .width(Width::DoubleColumn)
        .draw()
        .expect("a valid figure")
}

fn space_time() -> Drawing {
    let values: Vec<f64> = (0..3000)
        .map(|index| {
            if index == 7 {
                f64::NAN
            } else {
                f64::from(index % 50)
            }
        })
        .collect();
    let figure = SpaceTimeFigure {
        values: &values,
        rows: 10,
        value_label: "flow rate",
        ..SpaceTimeFigure::default()
    };
    figure.draw().expect("a valid figure")
}

fn snapshot(grains: &[SnapshotGrain]) -> SnapshotFigure<'_> {
    SnapshotFigure {
        grains,
        length: 20.0,
        period: Some(100.0),
        wavelength: Some(10.0),
        ..SnapshotFigure::default()
    }
}

fn grains() -> Vec<SnapshotGrain> {
    (0..20)
        .map(|index| SnapshotGrain {
            sphere: SnapshotSphere {
                along: f64::from(index),
                diameter: 1.0,
                ..SnapshotSphere::default()
            },
            axial_velocity: 0.5,
        })
        .collect()
}

fn labels(svg: &str) -> Vec<String> {
    let document = roxmltree::Document::parse(svg).expect("well-formed");
    let texts = document
        .descendants()
        .filter_map(|node| node.attribute("aria-label"));
    texts.map(str::to_owned).collect()
}

#[test]
fn a_chart_bears_everything_that_it_was_given() {
    let svg = chart().svg();
    let found = labels(&svg);
    for label in [
        "width of the bottleneck, w/d",
        "transition time, τ/t*",
        "fit",
        "ε\u{307} = 0.1",
        "not seen",
        "wc",
        "a note",
        "window",
        "strain rate",
        "a chart",
    ] {
        assert_eq!(
            found.iter().filter(|found| *found == label).count(),
            1,
            "`{label}` in {found:?}"
        );
    }
    let document = roxmltree::Document::parse(&svg).unwrap();
    let text_of = |name: &str| {
        document
            .descendants()
            .find(|node| node.tag_name().name() == name)
            .and_then(|node| node.text())
    };
    assert_eq!(text_of("title"), Some("a chart"));
    assert_eq!(text_of("desc"), Some("Points on a line that falls."));
}

#[test]
fn figures_with_prefixes_share_no_identity_and_keep_their_references() {
    let identities = |svg: &str| -> HashSet<String> {
        let document = roxmltree::Document::parse(svg).unwrap();
        let defined: HashSet<String> = document
            .descendants()
            .filter_map(|node| node.attribute("id").map(str::to_owned))
            .collect();
        for node in document.descendants() {
            let fill = node
                .attribute("fill")
                .and_then(|fill| fill.strip_prefix("url(#")?.strip_suffix(')'));
            let link = node
                .attribute("href")
                .and_then(|href| href.strip_prefix('#'));
            for reference in link.into_iter().chain(fill) {
                assert!(defined.contains(reference), "{reference}");
            }
        }
        defined
    };
    let grains = grains();
    let drawing = || snapshot(&grains).draw().unwrap();
    let one = identities(&drawing().with_prefix("figure 1-").svg());
    let other = identities(&drawing().with_prefix("figure2-").svg());
    assert!(one.len() > 5 && one.is_disjoint(&other));
    assert!(one.iter().all(|name| name.starts_with("figure-1-")));
}

#[test]
fn the_same_input_gives_the_same_bytes() {
    for draw in [chart, space_time] {
        assert_eq!(draw().svg(), draw().svg());
        assert_eq!(draw().png().unwrap(), draw().png().unwrap());
    }
}

#[test]
fn a_field_is_embedded_as_a_picture() {
    let svg = space_time().svg();
    let document = roxmltree::Document::parse(&svg).unwrap();
    let pictures: Vec<&str> = document
        .descendants()
        .filter(|node| node.tag_name().name() == "image")
        .filter_map(|node| node.attribute("href"))
        .collect();
    assert_eq!(pictures.len(), 2, "field and colour bar");
    assert!(
        pictures
            .iter()
            .all(|href| href.starts_with("data:image/png;base64,"))
    );
    assert!(svg.len() < 60_000, "{} bytes", svg.len());
}

#[test]
fn a_missing_cell_is_grey_on_the_page() {
    let figure = SpaceTimeFigure {
        values: &[0.0, f64::NAN, 1.0, 0.5],
        rows: 2,
        ..SpaceTimeFigure::default()
    };
    let bytes = figure.draw().unwrap().png().unwrap();
    let mut reader = png::Decoder::new(std::io::Cursor::new(&bytes))
        .read_info()
        .unwrap();
    let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
    reader.next_frame(&mut pixels).unwrap();
    let grey = pixels
        .chunks_exact(3)
        .filter(|pixel| **pixel == [190; 3])
        .count();
    let share = grey as f64 / (pixels.len() / 3) as f64;
    assert!(
        (0.1..0.25).contains(&share),
        "a quarter of the frame: {share}"
    );
}

#[test]
fn many_points_make_a_file_of_reasonable_size() {
    let x: Vec<f64> = (0..10_000).map(f64::from).collect();
    let y: Vec<f64> = x.iter().map(|x| libm::sin(x / 300.0)).collect();
    let draw = |layer: ChartLayer| {
        ChartFigure::new(ChartPanel::new("x", "y").with(layer))
            .draw()
            .unwrap()
            .svg()
            .len()
    };
    let points = draw(Points::new("", &x, &y).into());
    let line = draw(Line::new("", &x, &y).into());
    assert!(points < 900_000 && points > 200_000, "{points}");
    assert!(line < 60_000, "{line}");
}

#[test]
fn a_part_of_the_tube_says_how_much_it_is() {
    let grains = grains();
    let part = labels(&snapshot(&grains).draw().unwrap().svg());
    assert!(
        part.contains(&"z/d  (2 of 10 waves shown)".to_owned()),
        "{part:?}"
    );
    let whole = SnapshotFigure {
        period: Some(20.0),
        ..snapshot(&grains)
    };
    assert!(labels(&whole.draw().unwrap().svg()).contains(&"z/d".to_owned()));
    let unknown = SnapshotFigure {
        wavelength: None,
        ..snapshot(&grains)
    };
    assert!(
        labels(&unknown.draw().unwrap().svg()).contains(&"z/d  (20 of 100 d shown)".to_owned())
    );
}

#[test]
fn stacked_snapshots_share_scale_and_colours() {
    let grains = grains();
    let part = snapshot(&grains);
    let fast = SnapshotFigure {
        velocity_limit: 2.0,
        wavelength: None,
        ..part
    };
    let figure = SnapshotStack {
        title: "stack",
        snapshots: &[("unjammed", part), ("jammed", fast)],
        width: Width::SingleColumn,
    };
    let svg = figure.draw().unwrap().svg();
    let found = labels(&svg);
    for label in [
        "unjammed  (2 of 10 waves shown)",
        "jammed  (20 of 100 d shown)",
        "z/d",
        "along the wave, vz/c",
        "−2",
    ] {
        assert_eq!(
            found.iter().filter(|found| *found == label).count(),
            1,
            "{label}: {found:?}"
        );
    }
    let document = roxmltree::Document::parse(&svg).unwrap();
    let radii: HashSet<&str> = document
        .descendants()
        .filter_map(|node| {
            node.attribute("r")
                .filter(|_| node.tag_name().name() == "circle")
        })
        .collect();
    assert_eq!(radii.len(), 1);
    assert!(matches!(
        SnapshotStack::default().draw(),
        Err(FigureError::EmptySeries { .. })
    ));
}

fn refused(panel: ChartPanel) -> FigureError {
    ChartFigure::new(panel).draw().expect_err("not drawable")
}

#[test]
fn what_cannot_be_drawn_is_refused_by_name() {
    let panel = || ChartPanel::new("x", "y");
    let logarithmic = || panel().y_scale(Scale::Logarithmic);
    let (x, y) = ([1.0, 2.0], [3.0, 0.0]);

    let error = refused(logarithmic().with(Points::new("*τ* of runs", &x, &y)));
    assert_eq!(
        error.to_string(),
        "row 1 of the series `τ of runs` is 0 on the logarithmic y axis; it must be positive"
    );
    let error = refused(
        panel()
            .x_scale(Scale::Logarithmic)
            .with(Line::new("", &[-1.0, 1.0], &x)),
    );
    assert!(matches!(
        error,
        FigureError::NotPositiveOnLogarithm { row: 0, axis: "x", ref series, .. } if series == "line"
    ));
    let error = refused(panel().with(Points::new("a", &x, &[1.0])));
    assert!(matches!(
        error,
        FigureError::LayerLengths {
            column: "y",
            expected: 2,
            found: 1,
            ..
        }
    ));
    let error = refused(panel().with(Points::new("a", &x, &y).y_errors(&[1.0])));
    assert!(matches!(
        error,
        FigureError::LayerLengths {
            column: "errors of y",
            ..
        }
    ));
    let error = refused(panel().with(Points::new("a", &x, &y).lower_limits(&[true])));
    assert!(matches!(
        error,
        FigureError::LayerLengths {
            column: "lower limits",
            ..
        }
    ));
    let error = refused(panel().with(Bars::new("a", &x, &y)));
    assert!(matches!(
        error,
        FigureError::LayerLengths {
            column: "edges",
            expected: 3,
            ..
        }
    ));
    let error = refused(panel().with(Line::new("a", &[f64::NAN], &[1.0])));
    assert!(matches!(error, FigureError::EmptyLayer { length: 1, .. }));
    let error = refused(panel().with(Line::new("a", &x, &y).tint(Tint::Value(1.0))));
    assert!(matches!(error, FigureError::NoColourScale { .. }));
    let error = refused(logarithmic().y_range(0.0..).with(Line::new("a", &x, &x)));
    assert!(matches!(error, FigureError::AxisRange { axis: "y", .. }));
    assert!(matches!(refused(panel()), FigureError::AxisRange { .. }));
    let mixed = [
        panel().with(Line::new("", &x, &x)),
        logarithmic().with(Line::new("", &x, &x)),
    ];
    assert!(matches!(
        ChartFigure::grid(2, mixed).share_y().draw(),
        Err(FigureError::SharedScale { axis: "y" })
    ));
    assert!(matches!(
        ChartFigure::grid(2, []).draw(),
        Err(FigureError::EmptyLayer { .. })
    ));
    let height = ChartFigure::new(panel().with(Line::new("", &x, &x))).panel_height(0.0);
    assert!(matches!(
        height.draw(),
        Err(FigureError::NotPositive { .. })
    ));
}

#[test]
fn no_number_of_a_gap_reaches_the_page() {
    let panel = ChartPanel::new("x", "y").with_all([
        ChartLayer::from(Line::new(
            "",
            &[0.0, f64::NAN, 2.0, 3.0],
            &[0.0, 1.0, f64::INFINITY, 3.0],
        )),
        Points::new("", &[0.0, 1.0], &[f64::NEG_INFINITY, 1.0])
            .y_errors(&[1.0, f64::INFINITY])
            .into(),
        Band::new(
            "",
            &[0.0, 1.0, 2.0],
            &[0.0, f64::NAN, 0.0],
            &[1.0, 1.0, 1.0],
        )
        .into(),
        Bars::new("", &[0.0, 1.0, 2.0], &[1.0, f64::NAN]).into(),
    ]);
    let svg = ChartFigure::new(panel).draw().unwrap().svg();
    assert!(
        !svg.contains("NaN") && !svg.contains("inf\""),
        "a number that is none"
    );
    assert!(svg.matches("class=\"lines\"").count() == 1);
}
