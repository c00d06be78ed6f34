//! Every figure as a document: well-formed SVG with its labels, a PNG with a picture, the same bytes each time, and what is refused.

use std::collections::HashSet;

use peristalsis_figures::chart::{
    Band, Bars, ChartFigure, ChartLayer, ChartPanel, Field, Line, Points, Reference, Tint,
};
use peristalsis_figures::{ColourScale, FigureError, Scale};

#[path = "../examples/gallery/samples.rs"]
mod samples;

/// Texts that must be on a figure.
const LABELS: [(&str, &[&str]); 7] = [
    (
        "flow",
        &[
            "w = 2.75 d & <test>",
            "flow rate, J/Jmax",
            "time, t/T",
            "τ = 864 (m/k)1/2",
            "threshold",
            "samples",
            "late mean",
        ],
    ),
    ("widths", &["width of the bottleneck, w/d"]),
    ("times", &["ε\u{307} = 0.1", "not seen", "wmax"]),
    ("panels", &["(d)  A = 0.6", "a note"]),
    (
        "snapshot",
        &["z/d", "y/d", "axial velocity along the wave, vz/c"],
    ),
    (
        "snapshots",
        &["(a)  unjammed, t/T = 3", "z/d  (2 of 10 waves shown)"],
    ),
    (
        "picture",
        &["t/T = 1.5", "wave →", "belly", "throat", "5 d"],
    ),
];

fn parse(svg: &str) -> roxmltree::Document<'_> {
    roxmltree::Document::parse(svg).expect("well-formed")
}

/// No attribute but the texts themselves holds what is no number.
fn assert_all_finite(name: &str, document: &roxmltree::Document<'_>) {
    for attribute in document.descendants().flat_map(|node| node.attributes()) {
        let value = attribute.value();
        let is_free = ["aria-label", "href"].contains(&attribute.name());
        assert!(is_free || !value.contains("inf"), "{name}: {attribute:?}");
        assert!(
            attribute.name() == "href" || !value.contains("NaN"),
            "{name}: {attribute:?}"
        );
    }
    let mut texts = document.descendants().filter_map(|node| node.text());
    assert!(!texts.any(|text| text.contains("NaN")), "{name}");
}

#[test]
fn every_svg_is_well_formed_bears_its_labels_on_its_page_and_is_the_same_each_time() {
    for ((name, drawing), (_, again)) in samples::all().into_iter().zip(samples::all()) {
        let svg = drawing.svg();
        assert_eq!(svg, again.svg(), "{name}");
        assert_eq!(drawing.png().unwrap(), again.png().unwrap(), "{name}");
        let document = parse(&svg);
        let page = document.root_element().attribute("viewBox").unwrap();
        let page: Vec<f64> = page.split(' ').map(|it| it.parse().unwrap()).collect();
        let texts = document
            .descendants()
            .filter(|node| node.attribute("aria-label").is_some());
        let mut found = Vec::new();
        for text in texts {
            found.push(text.attribute("aria-label").unwrap());
            let place = text.attribute("transform").unwrap();
            let place = place.strip_prefix("translate(").unwrap();
            let place = place.split_once(')').unwrap().0.split_once(' ').unwrap();
            let (x, y): (f64, f64) = (place.0.parse().unwrap(), place.1.parse().unwrap());
            assert!(
                (0.0..page[2]).contains(&x) && (0.0..page[3]).contains(&y),
                "{name}: {x} {y}"
            );
        }
        let wanted = LABELS.iter().filter(|(figure, _)| *figure == name);
        for label in wanted.flat_map(|(_, labels)| *labels) {
            let count = found.iter().filter(|found| *found == label).count();
            // Every panel bears these.
            let is_repeated = ["a note", "y/d"].contains(label);
            assert!(count > 0, "{name} lacks `{label}`: {found:?}");
            assert_eq!(count > 1, is_repeated, "`{label}` of {name}: {found:?}");
        }
        assert_all_finite(name, &document);
    }
}

#[test]
fn references_have_definitions_and_figures_with_prefixes_share_none() {
    for (name, drawing) in samples::all() {
        let identities = |prefix: &str| -> HashSet<String> {
            let svg = drawing.svg_with_prefix(prefix);
            let document = parse(&svg);
            let nodes = || document.descendants();
            let defined: Vec<String> = nodes()
                .filter_map(|node| node.attribute("id").map(str::to_owned))
                .collect();
            let distinct: HashSet<String> = defined.iter().cloned().collect();
            assert_eq!(distinct.len(), defined.len(), "{name} defines it twice");
            let fill = |node: roxmltree::Node<'_, '_>| {
                let fill = node.attribute("fill")?.strip_prefix("url(#")?;
                fill.strip_suffix(')').map(str::to_owned)
            };
            let link = |node: roxmltree::Node<'_, '_>| {
                let link = node.attribute("href")?.strip_prefix('#')?;
                Some(link.to_owned())
            };
            let references: Vec<String> = nodes()
                .flat_map(|node| [fill(node), link(node)])
                .flatten()
                .collect();
            assert!(references.len() > 20, "{name} has text");
            for reference in references {
                assert!(distinct.contains(&reference), "{name}: {reference}");
            }
            distinct
        };
        let (one, other) = (identities("figure 1-"), identities("figure2-"));
        assert!(one.len() > 5 && one.is_disjoint(&other), "{name}");
        assert!(one.iter().all(|id| id.starts_with("figure-1-")), "{name}");
    }
}

#[test]
fn every_png_is_a_picture_of_the_size_of_the_svg() {
    for (name, drawing) in samples::all() {
        let bytes = drawing.png().unwrap();
        let mut reader = png::Decoder::new(std::io::Cursor::new(&bytes))
            .read_info()
            .unwrap();
        let density = reader.info().pixel_dims.expect("a density");
        let per_millimetre = f64::from(density.xppu) / 1000.0;
        if name != "picture" {
            assert_eq!((density.xppu, density.yppu), (11_811, 11_811), "300 dpi");
        }
        let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
        let frame = reader.next_frame(&mut pixels).unwrap();
        for (found, millimetres) in [
            (frame.width, drawing.width_millimetres()),
            (frame.height, drawing.height_millimetres()),
        ] {
            let expected = per_millimetre * millimetres;
            assert!((f64::from(found) - expected).abs() < 1.0, "{name}");
        }
        let colours: HashSet<&[u8]> = pixels.chunks_exact(3).collect();
        assert!(colours.len() > 30, "{name} has {} colours", colours.len());
        assert_eq!(&pixels[..3], [255; 3], "{name} has a white margin");
        let white = share(&pixels, [255; 3]);
        let is_area = ["space-time", "picture"].contains(&name);
        let least = if is_area { 0.05 } else { 0.25 };
        assert!((least..0.98).contains(&white), "{name}: {white} is white");
    }
}

/// Part of the pixels that have a colour.
fn share(pixels: &[u8], colour: [u8; 3]) -> f64 {
    let those = pixels.chunks_exact(3).filter(|pixel| **pixel == colour);
    3.0 * those.count() as f64 / pixels.len() as f64
}

#[test]
fn a_missing_cell_is_grey_on_the_page() {
    let field = Field::new(&[0.0, f64::NAN, 1.0, 0.5], 2, (0.0, 1.0), (0.0, 1.0));
    let figure = ChartFigure::new(ChartPanel::new("x", "y").with(field));
    let figure = figure.colour_scale(ColourScale::new("", 0.0, 1.0));
    let raster = figure.draw().unwrap().raster().unwrap();
    let grey = share(&raster.pixels, [190; 3]);
    assert!(
        (0.1..0.25).contains(&grey),
        "a quarter of the frame: {grey}"
    );
}

#[test]
fn titles_and_descriptions_are_told_to_those_who_do_not_see() {
    let all = samples::all();
    let text_of = |figure: &str, tag: &str| {
        let (_, drawing) = all.iter().find(|(name, _)| *name == figure).unwrap();
        let svg = drawing.svg();
        let document = parse(&svg);
        let node = document
            .descendants()
            .find(|it| it.has_tag_name(("http://www.w3.org/2000/svg", tag)));
        node.and_then(|node| node.text()).map(str::to_owned)
    };
    assert_eq!(text_of("flow", "title").unwrap(), "w = 2.75 d & <test>");
    assert_eq!(
        text_of("widths", "title").unwrap(),
        "flow rate, J/Jmax against time, t/T"
    );
    assert!(text_of("widths", "desc").unwrap().starts_with("Four runs;"));
    assert_eq!(text_of("flow", "desc"), None);
}

#[test]
fn many_rows_make_a_file_of_reasonable_size() {
    let x: Vec<f64> = (0..10_000).map(f64::from).collect();
    let y: Vec<f64> = x.iter().map(|x| libm::sin(x / 300.0)).collect();
    let draw = |layer: ChartLayer| {
        let figure = ChartFigure::new(ChartPanel::new("x", "y").with(layer));
        figure.draw().unwrap().svg().len()
    };
    let points = draw(Points::new("", &x, &y).into());
    let line = draw(Line::new("", &x, &y).into());
    assert!(points < 900_000 && points > 200_000, "{points}");
    assert!(line < 60_000, "{line}");
    let flow = |periods| samples::flow(periods).unwrap().svg().len();
    assert!(flow(5000) < 300_000, "{}", flow(5000));
    assert!(flow(5000) > 2 * flow(12), "the envelope must not be empty");
    let field = samples::space_time().unwrap().svg();
    let images = field.matches("href=\"data:image/png;base64,").count();
    assert_eq!(field.matches("<image").count(), 2, "field and colour bar");
    assert_eq!(images, 2);
    assert_eq!(
        parse(&samples::flow(12).unwrap().svg())
            .root_element()
            .attribute("width"),
        Some("178mm")
    );
    assert!(field.len() < 60_000, "{} bytes", field.len());
}

#[test]
fn what_cannot_be_drawn_is_refused_by_name() {
    let panel = || ChartPanel::new("x", "y");
    let logarithmic = || panel().y_scale(Scale::Logarithmic);
    let (x, y) = ([1.0, 2.0], [3.0, 0.0]);
    let points = || Points::new("*τ* of runs", &x, &y);
    let line = |values: &[f64]| panel().with(Line::new("a", &x, values));
    let refused = |figure: ChartFigure| figure.draw().expect_err("not drawable").to_string();
    let column = |column: &str, found: usize| {
        format!("the series `τ of runs` has {found} rows of its {column}; there must be 2")
    };
    let refuses = |panel: ChartPanel, reason: &str| {
        let found = refused(ChartFigure::new(panel));
        assert!(found.contains(reason), "{found}: not {reason}");
    };
    let nought =
        "row 1 of the series `τ of runs` is 0 on the logarithmic y axis; it must be positive";
    refuses(logarithmic().with(points()), nought);
    let below = panel().x_scale(Scale::Logarithmic);
    let below = below.with(Line::new("", &[-1.0, 1.0], &x));
    refuses(
        below,
        "row 0 of the series `line` is -1 on the logarithmic x axis",
    );
    let short = Points::new("*τ* of runs", &x, &[1.0]);
    refuses(panel().with(short), &column("y", 1));
    let errors = points().y_errors(&[1.0]);
    refuses(panel().with(errors), &column("errors of y", 1));
    let limits = points().lower_limits(&[true]);
    refuses(panel().with(limits), &column("lower limits", 1));
    let edges = "the series `a` has 2 rows of its edges; there must be 3";
    refuses(panel().with(Bars::new("a", &x, &y)), edges);
    refuses(line(&[f64::NAN; 2]), "no finite point to draw (2 rows)");
    let coloured = Line::new("a", &x, &y).tint(Tint::Value(1.0));
    let field = Field::new(&[1.0], 1, (0.0, 1.0), (0.0, 1.0));
    let without_scale = "is coloured by its value, but the chart has no scale";
    refuses(panel().with(coloured), &format!("`a` {without_scale}"));
    refuses(panel().with(field), &format!("`field` {without_scale}"));
    let nowhere = Reference::horizontal(f64::NAN);
    refuses(line(&x).with(nowhere), "NaN, not a finite number");
    let from_nought = logarithmic().y_range(0.0..).with(Line::new("a", &x, &x));
    refuses(from_nought, "range of the y axis is 0 to");
    let mixed = [line(&x), logarithmic().with(Line::new("", &x, &x))];
    assert!(refused(ChartFigure::grid(2, mixed).share_y()).contains("share their y axis"));
    assert!(refused(ChartFigure::grid(2, [])).contains("`chart`"));
    assert!(refused(ChartFigure::new(line(&x)).panel_height(0.0)).contains("must be positive"));
    let field = |values: &[f64]| {
        let panel = panel().with(Field::new(values, 2, (0.0, 1.0), (0.0, 1.0)));
        ChartFigure::new(panel)
            .colour_scale(ColourScale::new("", 0.0, 1.0))
            .draw()
    };
    assert!(matches!(
        field(&[1.0, 2.0, 3.0]),
        Err(FigureError::GridSize {
            rows: 2,
            found: 3,
            ..
        })
    ));
    assert!(matches!(
        field(&[f64::NAN; 4]),
        Err(FigureError::EmptySeries { .. })
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
        Band::new("", &[0.0, 1.0, 2.0], &[0.0, f64::NAN, 0.0], &[1.0; 3]).into(),
        Bars::new("", &[0.0, 1.0, 2.0], &[1.0, f64::NAN]).into(),
    ]);
    let svg = ChartFigure::new(panel).draw().unwrap().svg();
    assert_all_finite("gaps", &parse(&svg));
    assert_eq!(svg.matches("class=\"lines\"").count(), 1);
}
