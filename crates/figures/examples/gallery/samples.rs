//! Every kind of figure from made-up data, for the gallery and for the tests of documents.

use std::f64::consts::TAU;

use peristalsis_figures::chart::{
    Band, Bars, ChartFigure, ChartPanel, Corner, Field, LegendPlace, Line, Note, Pattern, Points,
    Reference, Tint, Window,
};
use peristalsis_figures::{
    ColourScale, Drawing, FigureError, Palette, PictureFigure, PlaceMark, Quantity, Scale,
    ScaleBar, Snapshot, SnapshotFigure, SnapshotGrain, SnapshotSphere, SnapshotWall, Units, Width,
};

type Drawn = Result<Drawing, FigureError>;

/// Every figure by its name.
pub(crate) fn all() -> Vec<(&'static str, Drawing)> {
    let width = Width::SingleColumn;
    [
        ("flow", flow(120)),
        ("widths", widths()),
        ("times", times()),
        ("panels", panels()),
        ("hysteresis", hysteresis()),
        ("histogram", histogram()),
        ("survival", survival()),
        ("profile", profile()),
        ("space-time", space_time()),
        ("snapshot", snapshot(100.0, width)),
        ("snapshots", snapshots()),
        ("picture", picture()),
    ]
    .map(|(name, drawn)| (name, drawn.expect(name)))
    .into()
}

/// Numbers between -1 and 1 that look random and are always the same.
fn noise(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed;
    move || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }
}

/// Equally spaced numbers from end to end.
fn spaced(from: f64, to: f64, count: usize) -> Vec<f64> {
    let step = (to - from) / (count - 1) as f64;
    (0..count).map(|index| from + step * index as f64).collect()
}

fn map(values: &[f64], of: impl FnMut(f64) -> f64) -> Vec<f64> {
    values.iter().copied().map(of).collect()
}

/// From one level to another about a place, within a distance.
fn step(x: f64, place: f64, distance: f64) -> f64 {
    1.0 / (1.0 + libm::exp(-(x - place) / distance))
}

fn panel(x: Quantity, y: Quantity) -> ChartPanel {
    ChartPanel::new(&x.label(Units::Linear), &y.label(Units::Linear))
}

/// A run of some periods that jams after a third of its time.
pub(crate) fn flow(periods: usize) -> Drawn {
    let mut noise = noise(7);
    let end = periods as f64;
    let level = |time: f64| 0.2 + 0.76 * step(time, 0.36 * end, 0.9);
    let time = spaced(0.0, end, 20 * periods);
    let ratio = map(&time, |time| level(time) + 0.05 * noise());
    let middles = spaced(0.5, end - 0.5, periods);
    let means = map(&middles, level);
    let late = [0.75 * end, end];
    let panel = panel(Quantity::Period, Quantity::FlowRateRatio)
        .x_range(0.0..=end)
        .with(
            Line::new("samples", &time, &ratio)
                .tint(Tint::Sky)
                .weight(0.5),
        )
        .with(Line::new("mean over a period", &middles, &means).tint(Tint::Blue))
        .with(Line::new("late mean", &late, &[0.96; 2]).tint(Tint::Orange))
        .with(Band::new("late mean", &late, &[0.94; 2], &[0.98; 2]).tint(Tint::Orange))
        .with(Reference::horizontal(0.5).label("threshold"))
        .with(Reference::vertical(0.36 * end).label("*τ* = 864 (*m*/*k*)^{1/2}"));
    ChartFigure::new(panel)
        .title("*w* = 2.75 *d* & <test>")
        .legend(LegendPlace::Below)
        .width(Width::DoubleColumn)
        .draw()
}

/// Flow against time for several widths, with colours by the width.
fn widths() -> Drawn {
    let mut noise = noise(21);
    let time = spaced(0.5, 119.5, 120);
    let lines = [(2.5, 7.0), (2.6, 18.0), (2.7, 66.0), (2.82, f64::INFINITY)].map(|(w, onset)| {
        let level = |time: f64| 0.22 + 0.7 * step(time, onset, 1.5);
        let ratio = map(&time, |time| level(time) + 0.03 * noise());
        Line::new("", &time, &ratio).tint(Tint::Value(w))
    });
    let panel = panel(Quantity::Period, Quantity::FlowRateRatio)
        .y_range(0.0..=1.1)
        .with_all(lines);
    ChartFigure::new(panel)
        .description(
            "Four runs; the narrower the bottleneck, the earlier the flow jumps to nearly 1.",
        )
        .colour_scale(ColourScale::new(
            "width of the bottleneck, *w*/*d*",
            2.5,
            2.82,
        ))
        .draw()
}

/// Transition times with errors, some of them lower limits, and fitted laws.
fn times() -> Drawn {
    let mut noise = noise(4);
    let mut panel = panel(Quantity::Width, Quantity::TransitionPeriod).y_scale(Scale::Logarithmic);
    for (series, rate) in [0.025, 0.05, 0.1].into_iter().enumerate() {
        let critical = 2.9 - 1.1 * rate;
        let widths = spaced(critical - 0.35, critical + 0.06, 9);
        let law = |width: f64| 2.2 / rate / (critical - width);
        let most = 120.0 / rate;
        let is_limit = |width: &f64| *width > critical - 0.01;
        let times = map(&widths, |width| {
            if is_limit(&width) {
                most
            } else {
                law(width) * (1.0 + 0.12 * noise())
            }
        });
        let limits: Vec<bool> = widths.iter().map(is_limit).collect();
        let fine = spaced(critical - 0.4, critical - 0.02, 200);
        let points = Points::new(&format!("*ε\u{307}* = {rate}"), &widths, &times)
            .x_errors(&[0.004; 9])
            .y_errors(&map(&times, |time| 0.16 * time))
            .lower_limits(&limits)
            .series(series);
        let points = if series == 2 {
            points.limit_name("not seen")
        } else {
            points
        };
        panel = panel.with(points).with(
            Line::new("", &fine, &map(&fine, law))
                .series(series)
                .weight(0.8),
        );
    }
    let reference = Reference::vertical(2.9).label("*w*_{max}");
    ChartFigure::new(panel.with(reference.pattern(Pattern::Dashed))).draw()
}

/// Four small panels with both axes shared, on which ticks are hardest.
fn panels() -> Drawn {
    let x = spaced(0.0, 1.0, 80);
    let panels = [0.4, 0.9, 0.2, 0.6].map(|height| {
        let y = map(&x, |x| height * libm::sin(TAU * x) * 0.3);
        panel(Quantity::Position, Quantity::AxialVelocity)
            .title(&format!("*A* = {height}"))
            .x_range(0.0..=1.0)
            .with(Line::new("reference kernel", &x, &y).series(5).weight(2.2))
            .with(
                Line::new("fast kernel", &x, &y)
                    .tint(Tint::Black)
                    .weight(0.8),
            )
            .with(Note::corner(Corner::BottomLeft, "a note"))
    });
    ChartFigure::grid(2, panels)
        .share_x()
        .share_y()
        .panel_height(22.0)
        .legend(LegendPlace::Below)
        .draw()
}

/// Both branches of a hysteresis, with the window between their ends.
fn hysteresis() -> Drawn {
    let widths = spaced(2.5, 3.0, 11);
    let branch = |name, end: f64| {
        let level = |w: f64| if w < end + 1e-9 { 0.96 } else { 0.18 };
        let points = Points::new(name, &widths, &map(&widths, level)).y_errors(&[0.03; 11]);
        points.joined()
    };
    let panel = panel(Quantity::Width, Quantity::FlowRateRatio)
        .y_range(0.0..=1.1)
        .with(Window::new("hysteresis", 2.7, 2.9))
        .with(branch("from rest", 2.7))
        .with(branch("from jammed", 2.9).open())
        .with(Reference::vertical(2.7).label("*w*_{c} = 2.70(2) *d*"))
        .with(Reference::vertical(2.9).label("*w*′_{c} = 2.90(2) *d*"));
    ChartFigure::new(panel).draw()
}

/// A histogram with two peaks and the mixture fitted to it.
fn histogram() -> Drawn {
    let edges = spaced(0.0, 1.1, 34);
    let peak = |x: f64, middle: f64, spread: f64| {
        libm::exp(-0.5 * ((x - middle) / spread) * ((x - middle) / spread)) / (spread * 2.5066)
    };
    let density = |x: f64| 0.45 * peak(x, 0.24, 0.07) + 0.55 * peak(x, 0.95, 0.04);
    let mut noise = noise(31);
    let heights = map(&edges[1..], |edge| {
        density(edge - 0.017) * (1.0 + 0.2 * noise())
    });
    let fine = spaced(0.0, 1.1, 200);
    let label = Quantity::FlowRateRatio.label(Units::Linear);
    let panel = ChartPanel::new(&label, "probability density")
        .with(Bars::new("*w* = 2.76 *d*", &edges, &heights).series(5))
        .with(Line::new("two peaks, fitted", &fine, &map(&fine, density)).tint(Tint::Black));
    ChartFigure::new(panel).draw()
}

/// Survival of the unjammed flow, and a law with its band.
fn survival() -> Drawn {
    let times = map(&spaced(0.0, 0.9, 18), |share| {
        -35.0 * libm::log(1.0 - share)
    });
    let smooth = spaced(0.0, 80.0, 100);
    let law = |lifetime: f64| map(&smooth, |time| libm::exp(-time / lifetime));
    let panel = panel(Quantity::Period, Quantity::Survival)
        .x_range(0.0..)
        .with(Band::new("*w* = 2.7 *d*", &smooth, &law(30.0), &law(40.0)).series(0))
        .with(
            Line::new("*w* = 2.7 *d*", &times, &spaced(1.0, 0.1, 18))
                .series(0)
                .stepped(),
        )
        .with(
            Line::new("", &smooth, &law(35.0))
                .pattern(Pattern::DashDotted)
                .weight(0.6),
        );
    ChartFigure::new(panel).draw()
}

/// Panels below each other with one axis: tube and axial velocity.
fn profile() -> Drawn {
    let x = spaced(0.0, 1.0, 51);
    let wave = map(&x, |x| libm::cos(TAU * (x - 0.5)));
    let radius = map(&wave, |wave| 3.5 + 1.1 * wave);
    let velocity = map(&wave, |wave| (0.15 - 0.42 * wave).max(0.0));
    let (rest, top) = (vec![0.0; 51], vec![5.0; 51]);
    let position = Quantity::Position.label(Units::Linear);
    let panel = |label| ChartPanel::new(&position, label).x_range(0.0..=1.0);
    let tube = panel("*r*/*d*")
        .y_range(0.0..=5.0)
        .with(Band::new("", &x, &radius, &top).tint(Tint::Grey))
        .with(Line::new("", &x, &radius).tint(Tint::Black));
    let flow = panel("*v_z*/*c*")
        .with(Band::new("", &x, &rest, &velocity).tint(Tint::Along))
        .with(Line::new("", &x, &velocity).tint(Tint::Along));
    ChartFigure::grid(1, [tube, flow])
        .share_x()
        .panel_height(21.0)
        .draw()
}

/// Flow of each wave against time, some of it missing.
pub(crate) fn space_time() -> Drawn {
    let (rows, columns) = (10, 220);
    let mut noise = noise(17);
    let mut values = Vec::new();
    for row in 0..rows {
        let onset = 70.0 + 9.0 * (row as f64 - 4.0).abs();
        for column in 0..columns {
            let is_missing = (150..156).contains(&column) && row > 6;
            let value = 0.2 + 0.75 * step(f64::from(column), onset, 3.0) + 0.06 * noise();
            values.push(if is_missing { f64::NAN } else { value });
        }
    }
    let field = Field::new(
        &values,
        rows,
        (0.0, f64::from(columns)),
        (-0.5, rows as f64 - 0.5),
    );
    ChartFigure::new(
        panel(Quantity::Period, Quantity::Wave)
            .y_scale(Scale::Counting)
            .with(field),
    )
    .title("*w* = 2.7 *d*, *ε\u{307}* = 0.1")
    .colour_scale(ColourScale::new("flow rate, *J*/*J*_{max}", 0.0, 1.0))
    .panel_height(36.0)
    .draw()
}

/// Spheres of a made-up wall in staggered rings, and grains at random places that keep apart in it.
fn tube(length: f64) -> (Vec<SnapshotGrain>, Vec<SnapshotSphere>) {
    const RING: usize = 12;
    let radius = |along: f64| 1.9 + 0.5 * libm::sin(TAU * along / 10.0);
    let rings = (length / 0.714).round() as usize;
    let wall = (0..rings * RING).map(|index| {
        let along = (index / RING) as f64 * length / rings as f64;
        let turn = (index % RING) as f64 + 0.5 * (index / RING % 2) as f64;
        let angle = TAU * turn / RING as f64;
        SnapshotSphere {
            along,
            across: radius(along) * libm::cos(angle),
            depth: radius(along) * libm::sin(angle),
            diameter: 1.0,
        }
    });
    let mut noise = noise(5);
    let mut grains: Vec<SnapshotGrain> = Vec::new();
    for _ in 0..40_000 {
        let sphere = SnapshotSphere {
            along: (noise() + 1.0) / 2.0 * length,
            across: 2.8 * noise(),
            depth: 2.8 * noise(),
            diameter: 0.9 + 0.1 * noise(),
        };
        let bore = radius(sphere.along) - 0.9;
        let is_free = grains.iter().all(|SnapshotGrain { sphere: other, .. }| {
            let across = (sphere.across - other.across).hypot(sphere.depth - other.depth);
            across.hypot(sphere.along - other.along) > 0.75
        });
        if sphere.across.hypot(sphere.depth) < bore && is_free && grains.len() < length as usize * 2
        {
            let wave = libm::sin(TAU * sphere.along / 10.0);
            let axial_velocity = 0.2 - 0.9 * wave + 0.3 * noise();
            grains.push(SnapshotGrain {
                sphere,
                axial_velocity,
            });
        }
    }
    (grains, wall.collect())
}

/// A whole tube with its wall of spheres.
fn snapshot(length: f64, width: Width) -> Drawn {
    let (grains, wall) = tube(length);
    SnapshotFigure {
        title: "*w* = 2.75 *d*, *ε\u{307}* = 0.05, *ρ* = 0.15",
        snapshots: &[Snapshot {
            label: "",
            grains: &grains,
            wall: SnapshotWall::Spheres(&wall),
            length,
            tube: length,
            outlet: None,
            wavelength: 10.0,
        }],
        axis: "*z*/*d*",
        velocity: "axial velocity along the wave, *v_z*/*c*",
        width,
    }
    .draw()
}

/// Unjammed flow above jammed, two of ten waves of each, with a wall of two curves.
fn snapshots() -> Drawn {
    let (grains, _) = tube(20.0);
    let mut jammed = grains.clone();
    for grain in &mut jammed {
        grain.axial_velocity = 0.95 + 0.1 * grain.sphere.depth;
    }
    let along = spaced(0.0, 20.0, 200);
    let radius = map(&along, |along| 1.4 + 0.5 * libm::sin(TAU * along / 10.0));
    let snapshot = |label, grains| Snapshot {
        label,
        grains,
        wall: SnapshotWall::Outline {
            along: &along,
            radius: &radius,
            thickness: 0.5,
        },
        length: 20.0,
        tube: 100.0,
        outlet: None,
        wavelength: 10.0,
    };
    SnapshotFigure {
        title: "",
        snapshots: &[
            snapshot("(a)  unjammed, *t*/*T* = 3", &grains),
            snapshot("(b)  jammed, *t*/*T* = 40", &jammed),
        ],
        axis: "*z*/*d*",
        velocity: "axial velocity along the wave, *v_z*/*c*",
        width: Width::DoubleColumn,
    }
    .draw()
}

/// Pixels with notes, marks, a scale and colours around them.
fn picture() -> Drawn {
    let pixels: Vec<u8> = (0..800 * 120_u32)
        .flat_map(|it| [(it % 800 / 4) as u8, (it / 800) as u8, 90])
        .collect();
    let mark = |place, label| PlaceMark { place, label };
    let scale_bar = ScaleBar {
        length: 0.2,
        label: "5 *d*".to_owned(),
    };
    PictureFigure {
        title: "pixels",
        pixels: &pixels,
        columns: 800,
        notes: &["*t*/*T* = 1.5", "wave →", "*J*/*J*_{max} = 0.9"].map(str::to_owned),
        marks: Some(&[mark(0.25, "belly"), mark(0.75, "throat")]),
        scale_bar: Some(&scale_bar),
        colours: &[&ColourScale::new("*v_z*/*c*", -1.0, 1.0).palette(Palette::Diverging)],
        width: Width::DoubleColumn,
        ..PictureFigure::default()
    }
    .draw()
}
