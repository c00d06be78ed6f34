//! The record of a run reads back bit for bit; its hash knows what matters; no text makes the reader panic.

use peristalsis_configuration::{Configuration, ConfigurationError, Problem, ProblemKind};
use proptest::prelude::*;

use crate::{NO_OVERRIDES, preset, read, schema_errors};

fn words(overrides: &[&str]) -> Vec<String> {
    overrides.iter().map(ToString::to_string).collect()
}

/// Overrides that leave each preset valid: alternatives, laws, controls, schedules.
fn overrides() -> impl Strategy<Value = Vec<String>> {
    let grains = prop_oneof![
        (0_u64..5000).prop_map(|number| format!("grains.number={number}")),
        (0.01..0.6).prop_map(|fraction: f64| format!("grains.volume_fraction={fraction:?}")),
        (0.01..1.0).prop_map(|density: f64| format!("grains.number_density={density:?}")),
    ];
    let rate = prop_oneof![
        (1e-3..0.5).prop_map(|rate: f64| format!("drive.strain_rate={rate:?}")),
        (1e-2..2.0).prop_map(|speed: f64| format!("drive.wave_speed={speed:?}")),
    ];
    let length = prop_oneof![
        (0.1..99.0).prop_map(|periods: f64| format!("run.periods={periods:?}")),
        (1.0..999.0).prop_map(|duration: f64| format!("run.duration={duration:?}")),
    ];
    let drive = prop_oneof![
        (0.0..3.0).prop_map(|width: f64| words(&["drive.control=strain", &format!("drive.width={width:?}")])),
        (0.0..3.0).prop_map(|angle: f64| vec![
            "drive.control=strain".into(),
            "drive.width=2".into(),
            "tube.arrangement=file".into(),
            format!("tube.angles=[{angle:?}, -1.0]"),
            "tube.places=[0.0, 1e-9]".into(),
        ]),
        (0.0..3.0).prop_map(|width: f64| vec![
            "drive.control=strain".into(),
            "tube.arrangement=smooth".into(),
            "wall.sphere_diameter=0".into(),
            format!("drive.width={width:?}"),
        ]),
        (0.0..1.5).prop_map(|amplitude: f64| vec![
            "drive.control=strain".into(),
            "tube.arrangement=disordered".into(),
            "tube.arrangement_seed=77".into(),
            format!("drive.amplitude={amplitude:?}"),
            "drive.schedule={form='steps', parameter='amplitude', at=[0.1, 3], values=[0.3, 0.7]}".into(),
        ]),
        (0.0..0.1).prop_map(|force: f64| vec![
            "drive.control=stress".into(),
            format!("drive.force_amplitude={force:?}"),
            format!("drive.schedule=[{{form='ramp', end={:?}}}, {{form='ramp', parameter='wave_speed', to=0.1, start=0.3, end=7}}]", force + 0.1),
            "wall.keep.net_force=removed_per_ring".into(),
        ]),
    ];
    let contact = prop_oneof![
        Just(words(&[
            "contact.law=linear",
            "contact.normal_damping=0.1",
            "units.stiffness=3.21",
        ])),
        Just(words(&[
            "contact.law=hertz",
            "contact.dissipation_form=printed",
            "units.young_modulus=1.23e5",
        ])),
        Just(words(&[
            "contact.law=linear",
            "contact.static_friction=0.7",
            "contact.kinetic_friction=0.123456789",
            "units.stiffness=3.21",
        ])),
    ];
    let step = (1e-3..0.2).prop_map(|step: f64| format!("run.time_step={step:?}"));
    let rest = (0_u64..=i64::MAX as u64, -1.0..1.0).prop_map(|(seed, velocity): (u64, f64)| {
        vec![
            format!("run.seed={seed}"),
            format!("initial.axial_velocity={velocity:?}"),
            "tube.rings_per_wave=16".into(),
            "tube.radius=1.7".into(),
            format!(
                "drive.body_force={:?}",
                0.1 * velocity.trunc().max(velocity)
            ),
            "drive.waveform=bolus".into(),
            "units.grain_diameter=0.0012345".into(),
            "units.density=2654.321".into(),
        ]
    });
    (grains, rate, length, drive, contact, step, rest).prop_map(
        |(grains, rate, length, drive, contact, step, rest)| {
            let mut all = [vec![grains, rate, length, step], drive, contact, rest].concat();
            // A smooth wall has no rings.
            if all.contains(&"tube.arrangement=smooth".to_owned()) {
                all.retain(|it| !it.starts_with("tube.rings_per_wave"));
            }
            all
        },
    )
}

proptest! {
    #[test]
    fn the_record_reads_back_bit_for_bit(
        name in prop_oneof![Just("frictionless"), Just("frictional")],
        overrides in overrides(),
    ) {
        let configuration = preset(name, &overrides);
        let record = configuration.to_toml();
        let again = Configuration::from_toml("config.toml", &record)
            .unwrap_or_else(|error| panic!("{error}\n{record}"));
        prop_assert_eq!(&again, &configuration);
        prop_assert_eq!(again.to_toml(), record);
        prop_assert_eq!(again.physics_hash(), configuration.physics_hash());
        prop_assert_eq!(again.run_hash(), configuration.run_hash());
    }

    #[test]
    fn the_step_is_the_longest_that_divides_a_sample(
        rate in 1e-3..0.5_f64,
        step in 1e-3..0.5_f64,
        samples in 1_u32..50,
    ) {
        let overrides = [
            format!("drive.strain_rate={rate:?}"),
            format!("run.time_step={step:?}"),
            format!("observe.samples_per_period={samples}"),
        ];
        let run = preset("frictionless", &overrides).run;
        let interval = 1.0 / rate / f64::from(samples);
        prop_assert!(run.time_step <= step * (1.0 + 1e-8));
        prop_assert!((run.time_step * run.steps_per_sample as f64 - interval).abs() < 1e-12 * interval);
        let longer = interval / (run.steps_per_sample as f64 - 1.0);
        prop_assert!(run.steps_per_sample == 1 || longer > step);
    }

    #[test]
    fn no_text_makes_the_reader_panic(text in any::<String>(), change in any::<String>()) {
        if let Err(error) = read(Some(&text), Some("frictionless"), &[change]) {
            check_labels(&error);
        }
    }

    #[test]
    fn no_sequence_of_pieces_makes_the_reader_panic(
        pieces in prop::collection::vec(prop::sample::select(PIECES.to_vec()), 0..24),
    ) {
        let text = pieces.concat();
        if let Err(error) = Configuration::from_toml("hostile.toml", &text) {
            check_labels(&error);
        }
        if let Err(error) = read(None, Some("frictional"), &pieces) {
            check_labels(&error);
        }
    }

    #[test]
    fn reader_and_schema_agree(
        lines in prop::collection::btree_map(
            prop::sample::select(LEAVES.to_vec()),
            prop::sample::select(VALUES.to_vec()),
            0..6,
        ),
    ) {
        let text: String = lines.iter().map(|(key, value)| format!("{key} = {value}\n")).collect();
        let valid = schema_errors(&text).is_empty();
        // Keys that are needed may be missing as well: the kind of a problem tells whose it is.
        let of_the_schema = |problem: &Problem| match problem.kind {
            ProblemKind::UnknownKey | ProblemKind::WrongType | ProblemKind::OutOfRange => true,
            ProblemKind::Missing => problem.key.as_ref().is_some_and(|key| key.ends_with(".form")),
            _ => false,
        };
        // A preset alone, or with right keys, is a configuration.
        let Err(error) = Configuration::from_toml("x.toml", &text) else {
            prop_assert!(valid, "{text}");
            return Ok(());
        };
        let refused = error.problems().iter().any(of_the_schema);
        let excluded = error.problems().iter().any(|problem| problem.kind == ProblemKind::Conflict);
        prop_assert!(if valid { !refused } else { refused || excluded }, "{text}{error}");
    }
}

fn check_labels(error: &ConfigurationError) {
    assert!(!error.problems().is_empty());
    for label in error.problems().iter().flat_map(|problem| &problem.labels) {
        assert!(
            label.source_text.get(label.span.clone()).is_some(),
            "{label}"
        );
    }
    assert!(!error.to_string().is_empty());
}

/// Pieces of TOML that meet in unforeseen ways.
const PIECES: &[&str] = &[
    "[drive]\n",
    "[[drive.schedule]]\n",
    "[wall.keep]\n",
    "[drive.schedule]\n",
    "[resolved]\n",
    "drive",
    "width",
    "schedule",
    ".",
    "=",
    " = ",
    "1",
    "-1",
    "1e400",
    "nan",
    "\"\"",
    "\"ramp\"",
    "'sudden'",
    "[",
    "]",
    "{",
    "}",
    ",",
    "\n",
    "\r\n",
    "#",
    "\u{e9}",
    "\u{feff}",
    "\0",
    "true",
    "preset = \"frictionless\"\n",
    "drive.width = 1\n",
    "drive.control = \"stress\"\n",
    "drive.schedule = [1]\n",
    "drive = 3\n",
    "grains.number = 1\n",
    "contact.law = {}\n",
    "drive.schedule={form='steps',at=[1,2],values=[1,2]}\n",
    "initial.state='jammed'\n",
    "tube.waves = 0x7fffffffffffffff\n",
    "drive.strain_rate = 1e-320\n",
    "1979-05-27",
];

/// Keys, known and unknown.
const LEAVES: &[&str] = &[
    "grains.number",
    "grains.volume_fraction",
    "contact.law",
    "contact.poisson_ratio",
    "tube.radius",
    "tube.waves",
    "tube.colour",
    "drive.control",
    "drive.width",
    "drive.schedule",
    "wall.keep.balance",
    "wall.keep.radial",
    "initial.state",
    "run.seed",
    "run.integrator",
    "observe.late_fraction",
    "units.density",
    "units.wave_frequency",
    "drive.strain_rate",
    "width",
    "preset",
];

/// Values of every type; no whole number is written as a float, which JSON could not tell apart.
const VALUES: &[&str] = &[
    "0",
    "1",
    "-3",
    "7000000000",
    "0.25",
    "-0.75",
    "2.75",
    "nan",
    "true",
    "\"linear\"",
    "\"ramp\"",
    "\"strain\"",
    "\"rest\"",
    "\"verlet\"",
    "\"frictional\"",
    "\"\"",
    "[1, 2]",
    "{}",
    "{ form = \"ramp\", end = 3 }",
    "[{ form = \"steps\", at = [], values = [1] }]",
    "{ form = \"ramp\", colour = 3 }",
];

#[test]
fn deep_and_long_texts_are_survived() {
    let texts = [
        "a.".repeat(100_000) + "b = 1",
        "a = ".to_owned() + &"[".repeat(100_000),
        "a = ".to_owned() + &"{a=".repeat(100_000),
        "[".to_owned() + &"a.".repeat(100_000) + "b]",
        "x".repeat(1_000_000) + " = 1",
        "a = \"".to_owned() + &"y".repeat(1_000_000) + "\"",
    ];
    for text in &texts {
        for result in [
            read(Some(text), None, NO_OVERRIDES),
            read(None, Some("frictionless"), &[text]),
        ] {
            check_labels(&result.expect_err("no key of ours"));
        }
    }
}

#[test]
fn the_hash_is_of_what_matters() {
    let base = preset("frictionless", NO_OVERRIDES);
    let of = |overrides: &[&str]| preset("frictionless", overrides);
    let same: [&[&str]; 8] = [
        &["drive.body_force=-0.0", "drive.waveform=sine"],
        &["grains.number=203"],
        &["drive.amplitude=0.125"],
        &["drive.wave_speed=0.5"],
        &["run.duration=800.0"],
        &["tube.arrangement=staggered"],
        &["initial.axial_velocity=-0.0"],
        &["contact.sliding=literal", "run.time_step=0.0500000000001"],
    ];
    for overrides in same {
        assert_eq!(
            of(overrides).physics_hash(),
            base.physics_hash(),
            "{overrides:?}"
        );
        assert_eq!(of(overrides).run_hash(), base.run_hash(), "{overrides:?}");
    }
    let longer: [&[&str]; 3] = [
        &["run.periods=41"],
        &["observe.profile_bins=40"],
        // The same grains told in SI as well.
        &[
            "units.grain_diameter=1e-3",
            "units.density=2500",
            "units.stiffness=10",
        ],
    ];
    for overrides in longer {
        assert_eq!(
            of(overrides).physics_hash(),
            base.physics_hash(),
            "{overrides:?}"
        );
        assert_ne!(of(overrides).run_hash(), base.run_hash(), "{overrides:?}");
    }
    let other: [&[&str]; 21] = [
        &["grains.number=202"],
        &["drive.width=2.7500000000000004"],
        &["drive.strain_rate=0.1"],
        &["drive.direction=backward"],
        &["drive.waveform=roller"],
        &["drive.body_force=-1e-300"],
        &["run.seed=2"],
        &["run.time_step=0.04"],
        &["run.integrator=adams_bashforth"],
        &["run.kernel=reference"],
        &["run.neighbour_skin=0.4"],
        &["initial.state=jammed"],
        &["drive.schedule={form='ramp', end=3}"],
        &["tube.arrangement=aligned"],
        &["tube.arrangement=smooth"],
        &["tube.arrangement=random"],
        &["tube.arrangement=random", "tube.arrangement_seed=2"],
        &["tube.arrangement=disordered"],
        &[
            "tube.arrangement=file",
            "tube.angles=[0, 3]",
            "tube.places=[1, 2]",
        ],
        &[
            "tube.arrangement=file",
            "tube.angles=[0, 3]",
            "tube.places=[2, 1]",
        ],
        &[
            "contact.static_friction=0.1",
            "contact.kinetic_friction=0.1",
        ],
    ];
    let mut hashes: Vec<[u8; 32]> = other
        .iter()
        .map(|overrides| of(overrides).physics_hash())
        .collect();
    hashes.push(base.physics_hash());
    let distinct: std::collections::BTreeSet<_> = hashes.iter().collect();
    assert_eq!(distinct.len(), hashes.len());
}

#[test]
fn the_order_of_keys_and_comments_do_not_matter() {
    let one = "preset = \"frictionless\"\n[run]\nseed = 4\n[drive]\nwidth = 2.5 # narrow\n";
    let other = "drive.width = 2.5\nrun = { seed = 4 }\npreset = \"frictionless\"\n";
    let one = Configuration::from_toml("one.toml", one).unwrap();
    let other = Configuration::from_toml("other.toml", other).unwrap();
    assert_eq!(one.run_hash(), other.run_hash());
    assert_eq!(one.to_toml(), other.to_toml());
}

#[test]
fn the_record_says_what_was_resolved() {
    let record = preset("frictionless", NO_OVERRIDES).to_toml();
    let table: toml::Table = record.parse().unwrap();
    let resolved = table["resolved"].as_table().unwrap();
    assert_eq!(resolved["number"].as_integer(), Some(203));
    assert_eq!(resolved["amplitude"].as_float(), Some(0.125));
    assert_eq!(resolved["wave_speed"].as_float(), Some(0.5));
    assert_eq!(resolved["steps"].as_integer(), Some(16_000));
    assert_eq!(resolved["wall_spheres"].as_integer(), Some(1680));
    assert_eq!(resolved["physics_hash"].as_str().map(str::len), Some(64));
    assert_eq!(table["run"]["periods"].as_float(), Some(40.0));
}
