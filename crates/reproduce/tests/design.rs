//! The design of a pump: what its file becomes, and how good an expectation is.

#![allow(
    clippy::unwrap_used,
    reason = "a test fails where what it needs is missing"
)]

use peristalsis_configuration::{Configuration, ConfigurationError, Control, SourceFile, material};
use peristalsis_reproduce::Start;
use peristalsis_reproduce::design::{
    ALL, AT_THE_EDGE, Design, GROUPS, Point, WITHIN, configuration_text, expectation, groups,
    is_design, page, published, rounded,
};

/// The tube of a point: all but the occlusion.
fn tube(point: &Point) -> [f64; GROUPS] {
    let mut tube = point.groups;
    tube[1] = 0.0;
    tube
}

/// Each published tube is foretold by the other tubes: within one error in most cases, within two nearly always.
#[test]
fn a_published_tube_is_foretold_by_the_others() {
    assert_eq!(ALL[1].name, "occlusion");
    for start in [Start::Rest, Start::Jammed] {
        let (mut told, mut within_one, mut within_two) = (0.0, 0.0, 0.0);
        let mut left: Vec<&Point> = published().iter().filter(|it| it.start == start).collect();
        while let Some(first) = left.first().copied() {
            let is_other = |other: &&Point| tube(other) != tube(first);
            let others: Vec<Point> = published().iter().filter(is_other).cloned().collect();
            for point in left.iter().filter(|point| !is_other(point)) {
                let Some(expected) = expectation(&others, &point.groups, start) else {
                    continue;
                };
                let off = (expected.flow_rate_ratio - point.flow).abs() / expected.error;
                told += 1.0;
                within_one += f64::from(off <= 1.0);
                within_two += f64::from(off <= 2.0);
            }
            left.retain(is_other);
        }
        println!("{start:?}: {told} tubes, {within_one} within one error, {within_two} within two");
        assert!(told > 100.0, "{told}");
        assert!(
            within_one / told > 0.68,
            "{start:?}: {within_one} of {told}"
        );
        assert!(
            within_two / told > 0.95,
            "{start:?}: {within_two} of {told}"
        );
    }
}

const HOSE: &str = "[grain]\nmaterial = \"glass\"\ndiameter = 2e-3\n\n\
                    [tube]\ndiameter = 14e-3\nwavelength = 80e-3\nocclusion = 0.6\nfill = 0.3\n\n\
                    [drive]\nfrequency = 5.0\n";

fn configuration(text: &str, overrides: &[&str]) -> Result<Configuration, ConfigurationError> {
    let overrides: Vec<String> = overrides.iter().map(ToString::to_string).collect();
    let name = "tube.toml";
    let text = configuration_text(SourceFile { name, text }, &overrides)?;
    assert!(!is_design(&text));
    Configuration::from_toml("simulation.toml", &text)
}

#[test]
fn a_hose_in_si_becomes_what_computes_it() {
    assert!(is_design(HOSE));
    let hose = configuration(HOSE, &[]).unwrap();
    // 14 mm are 7 d between the surfaces of the wall's spheres, 8 d between their centres.
    assert_eq!((hose.tube.radius, hose.tube.wavelength), (4.0, 40.0));
    let Control::Strain { width } = hose.drive.control else {
        panic!("a prescribed wall")
    };
    assert!((width - (0.4 * 7.0 + 1.0)).abs() < 1e-12);
    let units = hose.units.unwrap();
    assert!((hose.drive.strain_rate / units.time() - 5.0).abs() < 1e-9);
    assert_eq!(units.density, material("glass").unwrap().density);
    // N pi d^3/6 = 0.3 pi (7 d/2)^2 (80 d).
    assert_eq!(
        hose.grains.number,
        (0.3_f64 * 1.5 * 49.0 * 80.0).round() as u64
    );
    let speed = 5.0 * 80e-3;
    let groups = groups(&hose).unwrap();
    let named = |name: &str| groups[ALL.iter().position(|group| group.name == name).unwrap()];
    for (name, value) in [
        ("bore_over_grain", 7.0),
        ("occlusion", 0.6),
        ("wavelength_over_bore", 80.0 / 14.0),
        ("fill", 0.3),
        ("spread", 0.0),
        ("friction", 0.09),
        ("weight_across", 9.81 * 14e-3 / (speed * speed)),
        ("load", 0.0),
    ] {
        assert!(
            (named(name) - value).abs() < 2e-4 * value.abs().max(1e-3),
            "{name}: {}",
            named(name)
        );
    }
    assert!((named("lost") - 0.03).abs() < 1e-6 && named("softness") < 0.0201);
    // Upright, the same weight is a load; and a back pressure is the pressure rise that it says.
    let upright = configuration(HOSE, &["tube.incline=90"]).unwrap();
    assert!((super_load(&upright) - 9.81 * 14e-3 / (speed * speed)).abs() < 1e-3);
    let pressed = configuration(HOSE, &["gravity=0", "drive.back_pressure=200"]).unwrap();
    let pressure = pressed.pressure_rise() * pressed.units.unwrap().pressure();
    assert!((pressure / 200.0 - 1.0).abs() < 1e-9, "{pressure}");
}

fn super_load(configuration: &Configuration) -> f64 {
    groups(configuration).unwrap()[GROUPS - 1]
}

/// What a design is computed with is nothing that the computation warns of: samples find the rings of the wall everywhere in
/// the wave, and steps are short enough for the contacts of the smallest grains.
#[test]
fn a_design_samples_its_wall_everywhere_and_resolves_its_contacts() {
    const LIFT: &str = "[grain]\nmaterial = \"tablet\"\ndiameter = 4e-3\n\
                        [tube]\ndiameter = 24e-3\nwavelength = 60e-3\nocclusion = 0.8\nfill = 0.4\nincline = 90\n\
                        [drive]\nfrequency = 4.0\n";
    for spread in [0.0, 0.9] {
        let found = configuration(LIFT, &[&format!("grain.spread={spread}")]).unwrap();
        assert_eq!(found.tube.rings_per_wave, 20);
        assert_eq!(found.observe.samples_per_period, 21);
        let keys = ["run.time_step", "observe.samples_per_period"];
        let warnings = peristalsis_run::warnings(&found);
        let about = |it: &&peristalsis_run::Warning| keys.contains(&it.key);
        assert_eq!(warnings.iter().find(about), None, "{spread}");
    }
}

#[test]
fn what_is_wrong_in_a_design_is_named_with_its_line() {
    // A change of the design, the key to blame with its line, and what is said of it.
    let wrong = r#"
occlusion = 0.6 -> occlusion = 1.6 | tube.occlusion | 8 | too large
diameter = 14e-3 -> diameter = 1e-3 | tube.diameter | 6 | less than a grain
diameter = 14e-3 -> diameter = 9 | tube.diameter | 6 | lengths are in metres
material = "glass" -> friction = 0.3 | grain.diameter | 3 | grain.density, grain.restitution
"glass" -> "glas" | grain.material | 2 | glas
frequency -> frequenzy | drive.frequenzy | 12 | no key
frequency -> segments = 4\nfrequency | drive.segments | 12 | belongs to
"#;
    for row in wrong.trim().lines() {
        let cells: Vec<&str> = row.split(" | ").collect();
        let [change, key, line, words] = cells[..] else {
            panic!("{row}")
        };
        let (from, to) = change.split_once(" -> ").unwrap();
        let text = HOSE.replace(from, &to.replace("\\n", "\n"));
        let error = configuration(&text, &[]).expect_err("a design that is wrong");
        let problem = &error.problems()[0];
        assert_eq!(problem.key.as_deref(), Some(key), "{error}");
        let place = problem.labels[0].line_and_column().0;
        assert_eq!(place.to_string(), line, "{error}");
        let said = error.to_string();
        assert!(
            said.contains(words) && said.contains("tube.toml:"),
            "{said}"
        );
    }
}

#[test]
fn outside_the_data_nothing_is_expected_and_within_it_the_flow_is_that_of_the_rows() {
    // A tube of the source's, in SI: without gravity, smooth, and as soft as its grains are.
    let of = |settings: &[&str]| {
        let configuration = Configuration::from_preset("frictionless-source", settings).unwrap();
        let estimate = peristalsis_run::estimate(&configuration, None).unwrap();
        Design::of(&configuration, estimate).unwrap()
    };
    let settings = [
        "drive.strain_rate=0.05",
        "units.grain_diameter=1e-3",
        "units.density=2500",
        "units.stiffness=1e3",
        "drive.width=2.5",
    ];
    let jams = of(&settings);
    assert!(jams.outside.is_empty(), "{:?}", jams.outside);
    assert_eq!(jams.expected.len(), 2);
    let rest = &jams.expected[0].expectation;
    assert!(
        rest.distance <= WITHIN && rest.flow_rate_ratio > 0.8,
        "{rest:?}"
    );
    assert!(jams.regime.starts_with("jammed"), "{}", jams.regime);
    let (rate, most) = (
        jams.expected[0].mass_flow_rate_kg_per_h,
        jams.largest_mass_flow_rate_kg_per_h,
    );
    assert!((rate.unwrap() / most.unwrap() - rest.flow_rate_ratio).abs() < 1e-12);
    let slips = of(&[&settings[..4], &["drive.width=2.97"]].concat());
    assert!(
        slips.expected[0].expectation.flow_rate_ratio < 0.3,
        "{:?}",
        slips.expected
    );
    let heavy = of(&[
        &settings[..4],
        &["drive.width=2.5", "units.acceleration=[0, -1e5, 0]"],
    ]
    .concat());
    assert!(heavy.expected.is_empty() && heavy.regime.starts_with("not known"));
    assert!(
        heavy.outside[0].contains("gravity across the tube"),
        "{:?}",
        heavy.outside
    );
    assert!(
        heavy
            .groups
            .iter()
            .any(|group| group.distance > AT_THE_EDGE)
    );
    // What no group tells of: a design's user was foretold the flow of the tube without it.
    for (key, more) in [
        ("tube.ends", &["tube.ends=open"][..]),
        ("contact.cohesion_force", &["contact.cohesion_force=0.3"]),
        ("tube.arrangement", &["tube.arrangement=aligned"]),
        (
            "contact.rolling_friction",
            &[
                "contact.static_friction=0.3",
                "contact.rolling_friction=0.3",
            ],
        ),
        ("initial.temperature", &["initial.temperature=0.01"]),
        ("initial.axial_velocity", &["initial.axial_velocity=0.5"]),
        ("drive.waveform", &["drive.waveform=bolus"]),
        (
            "drive.schedule",
            &[
                "drive.schedule={parameter=\"width\", form=\"ramp\", from=2.5, to=2.4, start=0, end=9}",
            ],
        ),
    ] {
        let unlike = of(&[&["drive.width=2.5"][..], more].concat());
        assert!(
            unlike.outside.iter().any(|it| it.starts_with(key)),
            "{key}: {:?}",
            unlike.outside
        );
        assert!(unlike.expected.is_empty(), "{key}");
    }
    let closed = of(&[&settings[..4], &["drive.width=0.9"]].concat());
    assert!(closed.regime.starts_with("closed"), "{}", closed.regime);
    let page = page(&heavy, "heavy", "all <of> it");
    assert!(page.contains("gravity across the tube") && page.contains("all &lt;of&gt; it"));
    assert_eq!(rounded(0.123_456), 0.123);
}

/// An engineer: with a little friction, or against a little pressure, grains at rest were foretold to jam, as without.
#[test]
fn tubes_with_friction_or_a_load_are_compared_with_their_like() {
    let starts = |setting: &str| {
        let settings = [
            "drive.width=2.6",
            "drive.strain_rate=0.1",
            "tube.waves=4",
            setting,
        ];
        let configuration = Configuration::from_preset("frictionless-fine", &settings).unwrap();
        let estimate = peristalsis_run::estimate(&configuration, None).unwrap();
        let design = Design::of(&configuration, estimate).unwrap();
        let starts: Vec<&str> = design.expected.iter().map(|it| it.start).collect();
        (starts, design.regime)
    };
    assert_eq!(starts("drive.body_force=0").0, ["rest", "jammed"]);
    assert!(starts("contact.static_friction=0.1").0.is_empty());
    let (loaded, regime) = starts("drive.body_force=-0.003");
    assert_eq!(loaded, ["jammed"]);
    assert!(
        regime.contains("of grains from rest no published run tells"),
        "{regime}"
    );
}
