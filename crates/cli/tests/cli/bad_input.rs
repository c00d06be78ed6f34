//! Every kind of bad input: exit code 2, a message with key, line and what is allowed, and nothing made or changed.

use crate::{Outcome, Place};

/// A strain-controlled tube; the lines are counted below.
const STRAIN: &str = r#"[grains]
volume_fraction = 0.15
[contact]
law = "linear"
[tube]
radius = 1.5
wavelength = 10.0
waves = 3
spheres_per_ring = 12
rings_per_wave = 14
[drive]
control = "strain"
width = 2.75
strain_rate = 0.05
[run]
periods = 4
"#;

/// A stress-controlled tube with friction; the lines are counted below.
const STRESS: &str = r#"[grains]
number_density = 0.71
diameter_min = 0.8
[contact]
law = "hertz"
static_friction = 0.5
kinetic_friction = 0.4
[tube]
radius = 3.5
wavelength = 20.0
waves = 2
spheres_per_ring = 22
rings_per_wave = 23
[drive]
control = "stress"
force_amplitude = 0.004
strain_rate = 4.01e-3
[wall]
natural_length = 0.7
[wall.keep]
azimuthal = 0.1
[run]
periods = 1
"#;

/// Runs and checks a file that must be refused, and that neither leaves anything behind.
#[track_caller]
fn refused(text: &[u8], parts: &[&str]) {
    let place = Place::new();
    place.write("tube.toml", text);
    let before = place.inventory();
    for command in ["run", "check"] {
        let mut arguments = vec![command, "tube.toml"];
        if command == "run" {
            arguments.extend(["--out", "new/results"]);
        }
        let outcome = place.call(arguments).expect_code(2).says(parts);
        assert_eq!(outcome.stdout, "");
    }
    assert_eq!(place.inventory(), before);
}

/// Refused after replacing one text by another.
#[track_caller]
fn refused_with(base: &str, from: &str, to: &str, parts: &[&str]) {
    assert_eq!(base.matches(from).count(), 1, "{from:?}");
    refused(base.replacen(from, to, 1).as_bytes(), parts);
}

#[track_caller]
fn refused_override(setting: &str, parts: &[&str]) {
    let place = Place::new();
    place
        .run_small(&["--out", "results", "--set", setting])
        .expect_code(2)
        .says(parts);
    assert!(place.inventory().is_empty());
}

#[test]
fn the_files_themselves_are_right() {
    for text in [STRAIN, STRESS] {
        let place = Place::new();
        place.write("tube.toml", text);
        place.call(["check", "tube.toml"]).expect_code(0);
    }
}

#[test]
fn unknown_keys() {
    refused_with(
        STRAIN,
        "width = 2.75",
        "widht = 2.75\nwidth = 2.75",
        &[
            "tube.toml:13:1",
            "no key drive.widht",
            "did you mean drive.width?",
        ],
    );
    refused_with(
        STRAIN,
        "[run]",
        "[runs]",
        &["tube.toml:15:2", "no key runs", "run"],
    );
    refused_with(
        STRESS,
        "azimuthal = 0.1",
        "azimutal = 0.1",
        &[
            "tube.toml:21:1",
            "wall.keep.azimutal",
            "wall.keep.azimuthal",
        ],
    );
    refused_override(
        "drive.widht=2",
        &["--set drive.widht=2", "did you mean drive.width?"],
    );
}

#[test]
fn two_alternatives_in_one_file() {
    for (from, to, line, keys) in [
        (
            "volume_fraction = 0.15",
            "volume_fraction = 0.15\nnumber = 20",
            "tube.toml:2:",
            ["grains.volume_fraction", "grains.number"],
        ),
        (
            "volume_fraction = 0.15",
            "number_density = 0.2\nvolume_fraction = 0.15",
            "tube.toml:2:",
            ["grains.number_density", "grains.volume_fraction"],
        ),
        (
            "width = 2.75",
            "width = 2.75\namplitude = 0.1",
            "tube.toml:13:",
            ["drive.width", "drive.amplitude"],
        ),
        (
            "strain_rate = 0.05",
            "strain_rate = 0.05\nwave_speed = 0.5",
            "tube.toml:14:",
            ["drive.strain_rate", "drive.wave_speed"],
        ),
        (
            "periods = 4",
            "periods = 4\nduration = 80.0",
            "tube.toml:16:",
            ["run.periods", "run.duration"],
        ),
    ] {
        refused_with(
            STRAIN,
            from,
            to,
            &[
                line,
                keys[0],
                keys[1],
                "exclude one another",
                "help: keep one of",
            ],
        );
    }
}

#[test]
fn widths_and_amplitudes_beyond_the_tube() {
    refused_with(
        STRAIN,
        "width = 2.75",
        "width = 3.01",
        &["tube.toml:13:9", "drive.width = 3.01", "2 tube.radius = 3"],
    );
    refused_with(
        STRAIN,
        "width = 2.75",
        "amplitude = 1.51",
        &[
            "tube.toml:13:",
            "drive.amplitude = 1.51",
            "tube.radius = 1.5",
        ],
    );
    refused_override(
        "drive.width=3.01",
        &["--set drive.width=3.01", "2 tube.radius = 3"],
    );
}

#[test]
fn numbers_that_are_negative_zero_infinite_or_not_numbers() {
    let keys = [
        (6, "radius = 1.5", "tube.radius"),
        (7, "wavelength = 10.0", "tube.wavelength"),
        (16, "periods = 4", "run.periods"),
    ];
    for (line, entry, key) in keys {
        let name = entry.split(' ').next().unwrap();
        for value in ["-1.0", "0.0", "nan", "-nan", "inf", "-inf"] {
            let place = format!("tube.toml:{line}:");
            refused_with(
                STRAIN,
                entry,
                &format!("{name} = {value}"),
                &[&place, key, "allowed: a number above 0"],
            );
        }
    }
    for value in ["-0.15", "nan", "inf"] {
        refused_with(
            STRAIN,
            "volume_fraction = 0.15",
            &format!("volume_fraction = {value}"),
            &[
                "tube.toml:2:",
                "grains.volume_fraction",
                "allowed: a number",
            ],
        );
        refused_with(
            STRAIN,
            "strain_rate = 0.05",
            &format!("strain_rate = {value}"),
            &[
                "tube.toml:14:",
                "drive.strain_rate",
                "allowed: a number, 0 or more",
            ],
        );
    }
    refused_override("run.time_step=0", &["run.time_step", "above 0"]);
    refused_override("run.time_step=nan", &["run.time_step", "above 0"]);
    refused_override("run.neighbour_skin=-1", &["run.neighbour_skin", "above 0"]);
    refused_override(
        "observe.late_fraction=1.5",
        &["observe.late_fraction", "at most 1"],
    );
    refused_override(
        "observe.samples_per_period=0",
        &["observe.samples_per_period", "1 or more"],
    );
    refused_override("run.seed=-1", &["run.seed", "0 or more"]);
    refused_override("tube.waves=0", &["tube.waves", "1 or more"]);
    refused_override("tube.waves=2.5", &["tube.waves", "whole number"]);
}

#[test]
fn values_of_the_wrong_type_or_name() {
    refused_with(
        STRAIN,
        "law = \"linear\"",
        "law = \"linera\"",
        &["tube.toml:4:", "contact.law", "\"linear\"", "\"hertz\""],
    );
    refused_with(
        STRAIN,
        "width = 2.75",
        "width = \"wide\"",
        &["tube.toml:13:", "drive.width", "allowed: a number"],
    );
    refused_with(
        STRAIN,
        "[tube]\nradius = 1.5",
        "[tube]\nradius = [1.5]",
        &["tube.toml:6:"],
    );
    refused_override(
        "initial.state=asleep",
        &["initial.state", "\"rest\"", "\"jammed\""],
    );
    refused_override("drive.width", &["--set drive.width", "key=value"]);
}

#[test]
fn lattices_that_do_not_close() {
    refused_with(
        STRAIN,
        "rings_per_wave = 14",
        "rings_per_wave = 13",
        &[
            "tube.toml:10:",
            "tube.rings_per_wave = 13 is odd",
            "take 12 or 14",
        ],
    );
    refused_with(
        STRESS,
        "waves = 2",
        "waves = 3",
        &[
            "tube.toml:13:",
            "an odd number of rings a wave (23) in an odd number of waves (3)",
            "tube.waves = 2 or 4",
            "tube.rings_per_wave = 22 or 24",
        ],
    );
    let short = STRAIN.replace("waves = 3", "waves = 1");
    refused_with(
        &short,
        "wavelength = 10.0",
        "wavelength = 2.0",
        &[
            "tube.toml:7:",
            "tube that closes on itself",
            "longer wavelength",
        ],
    );
}

#[test]
fn grains_that_do_not_fit() {
    let parts = ["grains", "do not fit", "take fewer grains", "grains.number"];
    refused_with(STRAIN, "volume_fraction = 0.15", "number = 1500", &parts);
    refused_with(
        STRAIN,
        "volume_fraction = 0.15",
        "number = 4_000_000",
        &parts,
    );
    refused_with(
        STRAIN,
        "volume_fraction = 0.15",
        "number = 900_000_000_000",
        &["tube.toml:2:", "grains.number", "at most 1e8"],
    );
}

#[test]
fn files_that_are_not_toml_or_not_text_or_not_there() {
    refused(
        b"hello world\n",
        &["tube.toml:1:", "this is not TOML", "key = value"],
    );
    refused(
        b"[grains\nnumber = 3\n",
        &["tube.toml:1:", "this is not TOML"],
    );
    refused(
        b"[grains]\nnumber = 3\nnumber = 4\n",
        &["tube.toml:3:", "number"],
    );
    refused(b"\x89PNG\r\n\x1a\n\xff\xfe", &["tube.toml", "UTF-8"]);
    refused(
        b"",
        &[
            "tube.toml",
            "these keys are missing",
            "tube.radius",
            "preset = \"frictionless\"",
        ],
    );
    let place = Place::new();
    for command in ["run", "check"] {
        place
            .call([command, "absent.toml"])
            .expect_code(2)
            .says(&["absent.toml", "No such file"]);
        place
            .call([command, "."])
            .expect_code(2)
            .says(&["cannot read .", "TOML"]);
        place.call([command]).expect_code(2).says(&[
            "FILE",
            "--preset",
            "frictionless-fine",
            "frictional",
        ]);
    }
    assert!(place.inventory().is_empty());
}

#[test]
fn presets_and_arguments_that_do_not_exist() {
    let place = Place::new();
    place
        .call(["run", "--preset", "frictionles"])
        .expect_code(2)
        .says(&["frictionles", "did you mean frictionless?"]);
    place.call(["presets", "nothing"]).expect_code(2).says(&[
        "no preset `nothing`",
        "frictionless, frictionless-fine, frictional",
    ]);
    for arguments in [
        &["run", "--no-such-flag"][..],
        &["walk"],
        &["run", "a.toml", "b.toml"],
        &["run", "--resume", "a", "--out", "b"],
        &["presets", "frictional", "--json"],
        &[],
    ] {
        place.call(arguments).expect_code(2);
    }
    assert!(place.inventory().is_empty());
}

#[test]
fn contact_keys() {
    for (setting, allowed) in [
        ("young_modulus = 0.0", "a number above 0"),
        ("poisson_ratio = 0.51", "at most 0.5"),
        ("poisson_ratio = -1.0", "above -1"),
        ("dissipation_time = -0.1", "0 or more"),
        ("dissipation_time = nan", "0 or more"),
        (
            "dissipation_form = \"literal\"",
            "\"printed\", \"viscoelastic\"",
        ),
        ("tangential_stiffness = 0.0", "above 0"),
        ("tangential_damping = -0.1", "0 or more"),
        (
            "sliding = \"rolling\"",
            "\"spring\", \"balance\", \"literal\"",
        ),
        ("normal_stiffness = 1.0", "contact.law = \"linear\""),
    ] {
        let key = format!("contact.{}", setting.split(' ').next().unwrap());
        refused_with(
            STRESS,
            "law = \"hertz\"",
            &format!("law = \"hertz\"\n{setting}"),
            &["tube.toml:6:", &key, allowed],
        );
    }
    refused_with(
        STRESS,
        "static_friction = 0.5",
        "static_friction = -0.5",
        &["tube.toml:6:", "contact.static_friction", "0 or more"],
    );
    refused_with(
        STRESS,
        "kinetic_friction = 0.4",
        "kinetic_friction = 0.6",
        &["tube.toml:7:", "contact.kinetic_friction", "at most 0.5"],
    );
    refused_with(
        STRAIN,
        "law = \"linear\"",
        "law = \"linear\"\nyoung_modulus = 1.0",
        &[
            "tube.toml:5:",
            "contact.young_modulus",
            "contact.law = \"hertz\"",
        ],
    );
}

#[test]
fn grain_sizes() {
    refused_with(
        STRESS,
        "diameter_min = 0.8",
        "diameter_min = 1.2",
        &["tube.toml:3:", "grains.diameter_min", "give both"],
    );
    refused_with(
        STRESS,
        "diameter_min = 0.8",
        "diameter_min = -0.8",
        &["tube.toml:3:", "grains.diameter_min", "above 0"],
    );
    refused_with(
        STRESS,
        "number_density = 0.71",
        "number_density = -0.71",
        &["tube.toml:2:", "grains.number_density", "0 or more"],
    );
}

#[test]
fn wall_keys() {
    for (setting, allowed) in [
        ("sphere_mass = 0.0", "above 0"),
        ("sphere_diameter = -1.0", "above 0"),
        ("spring_stiffness = -0.018", "0 or more"),
        ("contact_range = -3.0", "0 or more"),
        ("contact_range = nan", "0 or more"),
        ("drag = -0.01", "0 or more"),
        ("spring_damping = -0.01", "0 or more"),
    ] {
        let key = format!("wall.{}", setting.split(' ').next().unwrap());
        refused_with(
            STRESS,
            "[wall]",
            &format!("[wall]\n{setting}"),
            &["tube.toml:19:", &key, allowed],
        );
    }
    refused_with(
        STRESS,
        "natural_length = 0.7",
        "natural_length = -0.7",
        &["tube.toml:19:", "wall.natural_length", "0 or more"],
    );
    for (setting, allowed) in [
        ("balance = 1", "true or false"),
        ("radial = -0.1", "0 or more"),
        ("axial = inf", "0 or more"),
        (
            "net_force = \"none\"",
            "\"free\", \"removed\", \"removed_per_ring\"",
        ),
    ] {
        let key = format!("wall.keep.{}", setting.split(' ').next().unwrap());
        refused_with(
            STRESS,
            "[wall.keep]",
            &format!("[wall.keep]\n{setting}"),
            &["tube.toml:21:", &key, allowed],
        );
    }
    refused_with(
        STRAIN,
        "[run]",
        "[wall.keep]\naxial = 0.1\n[run]",
        &["tube.toml:15:", "wall.keep", "drive.control = \"stress\""],
    );
}

#[test]
fn drive_and_integrator_keys() {
    refused_with(
        STRESS,
        "force_amplitude = 0.004",
        "force_amplitude = -0.004",
        &["tube.toml:16:", "drive.force_amplitude", "0 or more"],
    );
    refused_with(
        STRESS,
        "force_amplitude = 0.004",
        "width = 2.0",
        &["tube.toml:16:", "drive.width", "drive.control = \"strain\""],
    );
    for (setting, allowed) in [
        ("angle = \"sideways\"", "\"reference\", \"current\""),
        ("direction = \"up\"", "\"forward\", \"backward\""),
        ("waveform = \"square\"", "\"sine\""),
        ("schedule = \"steps\"", "\"sudden\", \"ramp\""),
        ("schedule = \"ramp\"", "drive.ramp_periods"),
        ("ramp_periods = 2.0", "drive.schedule = \"ramp\""),
        ("schedule = { form = \"ramp\" }", "end"),
        (
            "schedule = { form = \"ramp\", parameter = \"width\", end = 2 }",
            "drive.control = \"strain\"",
        ),
        (
            "schedule = { form = \"steps\", at = [0, 1], values = [0.1] }",
            "2 times in at, but 1 values",
        ),
        (
            "schedule = { form = \"steps\", at = [1, 0], values = [0.1, 0.2] }",
            "do not ascend",
        ),
    ] {
        refused_with(
            STRESS,
            "control = \"stress\"",
            &format!("control = \"stress\"\n{setting}"),
            &["tube.toml:16:", "drive.", allowed],
        );
    }
    refused_with(
        STRESS,
        "periods = 1",
        "periods = 1\nintegrator = \"euler\"",
        &[
            "tube.toml:24:",
            "run.integrator",
            "\"verlet\", \"adams_bashforth\"",
        ],
    );
}

#[test]
fn a_static_wave_in_periods() {
    refused_with(
        STRAIN,
        "strain_rate = 0.05",
        "strain_rate = 0.0",
        &["tube.toml:16:", "run.duration"],
    );
}

#[test]
fn several_problems_come_in_one_go() {
    let place = Place::new();
    let text = STRAIN
        .replace("width", "widht")
        .replace("radius = 1.5", "radius = -1.5");
    place.write("tube.toml", text);
    let outcome: Outcome = place.call(["check", "tube.toml"]);
    outcome
        .expect_code(2)
        .says(&["tube.toml:6:10", "tube.toml:13:1"]);
}
