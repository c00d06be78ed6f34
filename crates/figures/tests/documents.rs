//! Every figure as a document: well-formed SVG with its labels, a PNG with a picture, and the same bytes each time.

use std::collections::HashSet;
use std::f64::consts::TAU;

use peristalsis_figures::{
    Drawing, FigureError, FlowFigure, LateMean, NewtonianReference, Profile, ProfileFigure, Scale,
    Series, SnapshotFigure, SnapshotGrain, SnapshotSphere, SnapshotWall, Transition, WallFigure,
    Width,
};

fn flow(periods: u32) -> Drawing {
    let time: Vec<f64> = (0..20 * periods)
        .map(|step| f64::from(step) / 20.0)
        .collect();
    let ratio: Vec<f64> = time
        .iter()
        .map(|time| 0.4 + 0.3 * libm::sin(TAU * 1.03 * time))
        .collect();
    let middles: Vec<f64> = (0..periods).map(|period| f64::from(period) + 0.5).collect();
    let means: Vec<f64> = middles
        .iter()
        .map(|middle| 0.4 + 0.1 * libm::sin(middle / 7.0))
        .collect();
    let figure = FlowFigure {
        title: "*w* = 2.75 *d* & <test>",
        samples: Series {
            x: &time,
            y: &ratio,
        },
        averages: Some(Series {
            x: &middles,
            y: &means,
        }),
        threshold: Some(0.5),
        transition: Some(Transition {
            period: 3.0,
            time: 60.0,
            unit: "(*m*/*k*)^{1/2}",
        }),
        newtonian: Some(NewtonianReference {
            ratio: 0.05,
            clear_bore: Some(0.11),
        }),
        late_mean: Some(LateMean {
            mean: 0.4,
            error: 0.02,
        }),
        width: Width::DoubleColumn,
    };
    figure.draw().expect("a valid figure")
}

fn profiles() -> Drawing {
    let position: Vec<f64> = (0..60).map(|bin| (f64::from(bin) + 0.5) / 60.0).collect();
    let wave: Vec<f64> = position
        .iter()
        .map(|position| libm::sin(TAU * position))
        .collect();
    let positive: Vec<f64> = wave.iter().map(|wave| 2.0 + wave).collect();
    let error = vec![0.1; 60];
    let profile = |value, label| Profile {
        position: &position,
        value,
        error: Some(&error),
        label,
    };
    let figure = ProfileFigure {
        title: "profiles",
        wall_radius: profile(&positive, "*r*/*d*"),
        density: profile(&positive, "density"),
        axial_velocity: profile(&wave, "*v_z*/*c*"),
        temperature: profile(&positive, "temperature"),
        temperature_scale: Scale::Logarithmic,
        wall_pressure: Some(profile(&positive, "*p*/*Y*")),
        wall_shear: Some(profile(&wave, "*τ*/*Y*")),
        width: Width::SingleColumn,
    };
    figure.draw().expect("a valid figure")
}

fn wall() -> Drawing {
    let phase: Vec<f64> = (0..50).map(|bin| (f64::from(bin) + 0.5) / 50.0).collect();
    let radius = |shift: f64| -> Vec<f64> {
        phase
            .iter()
            .map(|phase| 3.5 + libm::sin(TAU * phase) + shift)
            .collect()
    };
    let (mean, least, largest) = (radius(0.0), radius(-0.2), radius(0.3));
    let figure = WallFigure {
        title: "wall",
        phase: &phase,
        mean: &mean,
        least: &least,
        largest: &largest,
        reference: Some(3.5),
        length_unit: "*d*",
        width: Width::SingleColumn,
    };
    figure.draw().expect("a valid figure")
}

fn snapshot(count: u32) -> Drawing {
    let sphere = |index: u32, across: f64| SnapshotSphere {
        along: f64::from(index) * 20.0 / f64::from(count),
        across,
        depth: f64::from(index % 5) / 10.0,
        diameter: 1.0,
    };
    let grains: Vec<SnapshotGrain> = (0..count)
        .map(|index| SnapshotGrain {
            sphere: sphere(index, f64::from(index % 7) / 7.0 - 0.5),
            axial_velocity: libm::sin(f64::from(index)),
        })
        .collect();
    let wall: Vec<SnapshotSphere> = (0..count)
        .flat_map(|index| [sphere(index, 1.5), sphere(index, -1.5)])
        .collect();
    let figure = SnapshotFigure {
        title: "snapshot",
        grains: &grains,
        wall: SnapshotWall::Spheres(&wall),
        length: 20.0,
        period: Some(20.0),
        ..SnapshotFigure::default()
    };
    figure.draw().expect("a valid figure")
}

fn all() -> [(&'static str, Drawing, &'static [&'static str]); 4] {
    [
        (
            "flow",
            flow(12),
            &[
                "w = 2.75 d & <test>",
                "flow rate, J/Jmax",
                "time, t/T",
                "τ = 60.0 (m/k)1/2",
                "threshold",
                "late mean 0.400 ± 0.020",
                "Newtonian fluid (Shapiro et al. 1969), φ = b/a",
                "the same, clear bore, φ = b/(a − d/2)",
            ],
        ),
        (
            "profiles",
            profiles(),
            &[
                "r/d",
                "density",
                "vz/c",
                "temperature",
                "position in the wave frame, (z − ct)/λ",
                "(d)",
            ],
        ),
        (
            "wall",
            wall(),
            &[
                "wall radius, R/d",
                "phase, (z − ct)/λ",
                "least to largest",
                "tube at rest",
            ],
        ),
        (
            "snapshot",
            snapshot(40),
            &[
                "z/d",
                "x/d",
                "against the wave",
                "along the wave, vz/c",
                "−1",
            ],
        ),
    ]
}

#[test]
fn every_svg_is_well_formed_and_bears_its_labels() {
    for (name, drawing, labels) in all() {
        let svg = drawing.svg();
        let document =
            roxmltree::Document::parse(&svg).unwrap_or_else(|error| panic!("{name}: {error}"));
        let texts: HashSet<&str> = document
            .descendants()
            .filter_map(|node| node.attribute("aria-label"))
            .collect();
        for label in labels {
            assert!(texts.contains(label), "{name} lacks `{label}`: {texts:?}");
        }
    }
}

#[test]
fn every_reference_in_an_svg_has_its_definition() {
    for (name, drawing, _) in all() {
        let svg = drawing.svg();
        let document = roxmltree::Document::parse(&svg).unwrap();
        let identities: Vec<&str> = document
            .descendants()
            .filter_map(|node| node.attribute("id"))
            .collect();
        let defined: HashSet<&str> = identities.iter().copied().collect();
        assert_eq!(
            defined.len(),
            identities.len(),
            "{name} defines something twice"
        );
        let mut references = 0;
        for node in document.descendants() {
            let fill = node
                .attribute("fill")
                .and_then(|fill| fill.strip_prefix("url(#")?.strip_suffix(')'));
            for reference in node
                .attribute("href")
                .map(|href| &href[1..])
                .into_iter()
                .chain(fill)
            {
                assert!(defined.contains(reference), "{name}: {reference}");
                references += 1;
            }
        }
        assert!(references > 20, "{name} has text");
    }
}

#[test]
fn every_number_of_an_svg_lies_on_its_page() {
    let svg = flow(12).svg();
    let document = roxmltree::Document::parse(&svg).unwrap();
    let page: Vec<f64> = document
        .root_element()
        .attribute("viewBox")
        .unwrap()
        .split(' ')
        .map(|number| number.parse().unwrap())
        .collect();
    assert_eq!(document.root_element().attribute("width"), Some("178mm"));
    for text in document
        .descendants()
        .filter(|node| node.attribute("aria-label").is_some())
    {
        let place = text
            .attribute("transform")
            .unwrap()
            .strip_prefix("translate(")
            .unwrap();
        let place = place.split_once(')').unwrap().0.split_once(' ').unwrap();
        let (x, y): (f64, f64) = (place.0.parse().unwrap(), place.1.parse().unwrap());
        assert!(
            (0.0..page[2]).contains(&x) && (0.0..page[3]).contains(&y),
            "{x} {y}"
        );
    }
}

#[test]
fn every_png_is_a_picture_of_the_same_size_at_300_dots_per_inch() {
    for (name, drawing, _) in all() {
        let bytes = drawing.png().unwrap();
        let mut reader = png::Decoder::new(std::io::Cursor::new(&bytes))
            .read_info()
            .unwrap();
        let density = reader.info().pixel_dims.expect("a density");
        assert_eq!((density.xppu, density.yppu), (11_811, 11_811));
        let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
        let frame = reader.next_frame(&mut pixels).unwrap();
        let inches =
            [drawing.width_millimetres(), drawing.height_millimetres()].map(|length| length / 25.4);
        assert!(
            (f64::from(frame.width) - 300.0 * inches[0]).abs() < 1.0,
            "{name}"
        );
        assert!(
            (f64::from(frame.height) - 300.0 * inches[1]).abs() < 1.0,
            "{name}"
        );

        let white = pixels
            .chunks_exact(3)
            .filter(|pixel| **pixel == [255; 3])
            .count();
        let total = pixels.len() / 3;
        assert!(
            white > total / 4 && white < total - total / 50,
            "{name}: {white} of {total} are white"
        );
        let colours: HashSet<&[u8]> = pixels.chunks_exact(3).collect();
        assert!(colours.len() > 30, "{name} has {} colours", colours.len());
        let corner = &pixels[..3];
        assert_eq!(corner, [255; 3], "{name} has a white margin");
    }
}

#[test]
fn the_same_input_gives_the_same_bytes() {
    for ((name, first, _), (_, second, _)) in all().into_iter().zip(all()) {
        assert_eq!(first.svg(), second.svg(), "{name}");
        assert_eq!(first.png().unwrap(), second.png().unwrap(), "{name}");
    }
}

#[test]
fn thousands_of_periods_make_a_small_file() {
    let svg = flow(5000).svg();
    assert!(svg.len() < 300_000, "{} bytes", svg.len());
    assert!(
        svg.len() > 2 * flow(12).svg().len(),
        "the envelope must not be empty"
    );
}

#[test]
fn tables_without_rows_are_refused_by_name() {
    let nothing = FlowFigure::default().draw().unwrap_err();
    assert!(
        matches!(
            nothing,
            FigureError::EmptySeries {
                series: "flow rate",
                length: 0
            }
        ),
        "{nothing}"
    );
    assert!(matches!(
        ProfileFigure::default().draw(),
        Err(FigureError::EmptySeries { .. })
    ));
    assert!(matches!(
        WallFigure::default().draw(),
        Err(FigureError::EmptySeries { .. })
    ));
    let no_length = SnapshotFigure::default().draw().unwrap_err();
    assert!(
        matches!(no_length, FigureError::NotPositive { .. }),
        "{no_length}"
    );
}

#[test]
fn values_that_are_no_numbers_never_reach_the_page() {
    let time = [0.0, 1.0, f64::NAN, 3.0, 4.0, 5.0];
    let ratio = [0.1, f64::INFINITY, 0.3, 0.4, f64::NAN, 0.6];
    let drawing = FlowFigure {
        samples: Series {
            x: &time,
            y: &ratio,
        },
        ..FlowFigure::default()
    }
    .draw();
    let svg = drawing.unwrap().svg();
    let document = roxmltree::Document::parse(&svg).unwrap();
    for attribute in document.descendants().flat_map(|node| node.attributes()) {
        assert!(
            !attribute.value().contains("NaN") && !attribute.value().contains("inf"),
            "{attribute:?}"
        );
    }
    let samples = document
        .descendants()
        .find(|node| node.attribute("class") == Some("samples"))
        .unwrap();
    assert_eq!(
        samples
            .children()
            .filter(roxmltree::Node::is_element)
            .count(),
        3,
        "three pieces remain"
    );
}
