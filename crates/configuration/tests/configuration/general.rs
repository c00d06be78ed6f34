//! Rolling resistance and cohesion as they are given, and the kernel that they need.

use peristalsis_configuration::{Cohesion, Configuration, Kernel, ProblemKind};

use crate::{only_problem, preset, read, record, refuses};

const ROUGH: [&str; 2] = [
    "contact.static_friction=0.5",
    "contact.rolling_friction=0.1",
];

fn frictional(settings: &[&str]) -> Configuration {
    preset("frictional", settings)
}

#[test]
fn what_is_not_given_changes_nothing() {
    let plain = frictional(&[]);
    let none = [
        "contact.rolling_friction=0",
        "contact.cohesion_force=0",
        "contact.surface_energy=0",
        "contact.pull_off=\"displacement\"",
    ];
    assert_eq!(frictional(&none).run_hash(), plain.run_hash());
    assert_eq!(plain.run.kernel, Kernel::Fast);
    assert_eq!(plain.reference_only(), None);
    let text = plain.to_toml();
    assert!(
        !text.contains("rolling") && !text.contains("cohesion"),
        "{text}"
    );
}

#[test]
fn what_is_given_reads_back_and_takes_the_reference_kernel() {
    for settings in [
        &ROUGH[..],
        &["contact.cohesion_force=0.01", "contact.cohesion_range=0.02"],
        &["contact.surface_energy=0.001"],
        &["contact.surface_energy=0.001", "contact.pull_off=\"force\""],
    ] {
        let found = frictional(settings);
        assert!(found.contact.is_general() && found.reference_only().is_some());
        assert_eq!(found.run.kernel, Kernel::Reference);
        assert_ne!(found.physics_hash(), frictional(&[]).physics_hash());
        record(&found);
    }
    let rolling = frictional(&ROUGH).contact.rolling.unwrap();
    assert_eq!(
        (rolling.rolling_friction, rolling.rolling_stiffness),
        (0.1, 1.0)
    );
}

#[test]
fn what_no_law_has_is_refused_at_its_key() {
    refuses(
        "
frictionless | contact.rolling_friction=0.1 | contact.rolling_friction | Inconsistent
frictionless | contact.surface_energy=0.1 | contact.surface_energy | Inconsistent
frictional | contact.cohesion_range=0.1 | contact.cohesion_range | Inconsistent
frictional | contact.cohesion_force=0.1; contact.pull_off=force | contact.pull_off | Inconsistent
frictional | contact.cohesion_force=0.1; contact.surface_energy=0.1 | contact.surface_energy | Inconsistent
frictional | contact.surface_energy=1e-200 | contact.surface_energy | OutOfRange
frictional | contact.surface_energy=0.001; run.kernel=fast | run.kernel | Inconsistent | the reference kernel alone computes cohesion
frictional | units.surface_energy=0.05 | units.surface_energy | Missing
frictional | grains.diameter_spread=0.2 | grains.diameter_spread | Conflict
",
    );
}

/// Beads of 1 mm with 1 kg/m^3 pi/6 d^3 of mass: N and J/m^2 by hand.
#[test]
fn cohesion_in_si() {
    let units = [
        "units.grain_diameter=1e-3",
        "units.density=2500",
        "units.young_modulus=1e6",
    ];
    let with = |key: &str| frictional(&[&units[..], &[key]].concat());
    // The unit of force is Y d^2 = 1 N, of surface energy Y d = 1000 J/m^2.
    let cohesion = |found: Configuration| found.contact.cohesion.unwrap();
    let Cohesion { cohesion_force, .. } = cohesion(with("units.cohesion_force=1e-4"));
    assert!((cohesion_force - 1e-4).abs() < 1e-16, "{cohesion_force}");
    let Cohesion { surface_energy, .. } = cohesion(with("units.surface_energy=0.05"));
    assert!((surface_energy - 5e-5).abs() < 1e-16, "{surface_energy}");
}

#[test]
fn sizes_of_every_form_read_back() {
    let bounds = ["grains.diameter_min=0.5", "grains.diameter_max=1"];
    for (settings, mean) in [
        (
            &["grains.sizes=\"lognormal\"", "grains.diameter_spread=0.2"][..],
            0.7165,
        ),
        (
            &["grains.sizes=\"two\"", "grains.large_fraction=0.25"],
            0.625,
        ),
        (
            &["grains.sizes=\"two\"", "grains.large_volume_fraction=0.5"],
            0.5 + 0.5 / 9.0,
        ),
        (
            &[
                "grains.sizes=\"table\"",
                "grains.diameters=[0.6, 0.8]",
                "grains.fractions=[3, 1]",
            ],
            0.65,
        ),
    ] {
        let found = frictional(&[&bounds[..], settings].concat());
        record(&found);
        let sizes = found.grains.distribution();
        assert!(
            (sizes.mean(1) - mean).abs() < 2e-3,
            "{settings:?}: {}",
            sizes.mean(1)
        );
    }
    let table = [
        "grains.sizes=\"table\"",
        "grains.diameters=[0.6, 0.8]",
        "grains.fractions=[3, 1]",
    ];
    let grains = frictional(&table).grains;
    assert_eq!([grains.diameter_min, grains.diameter_max], [0.6, 0.8]);
}

#[test]
fn sizes_that_are_not_whole_are_refused() {
    refuses(
        "
frictional | grains.diameter_min=0.5; grains.diameter_max=1; grains.sizes=lognormal | grains.sizes | Inconsistent
frictional | grains.diameter_min=0.5; grains.diameter_max=1; grains.sizes=two | grains.sizes | Inconsistent
frictional | grains.diameter_min=1; grains.diameter_max=1; grains.sizes=two; grains.large_fraction=0.1 | grains.sizes | Inconsistent
frictional | grains.diameter_min=0.5; grains.diameter_max=1; grains.sizes=table; grains.diameters=[0.6] | grains.sizes | Inconsistent
frictional | grains.diameter_min=0.5; grains.diameter_max=1; grains.sizes=lognormal; grains.diameter_spread=0.2; grains.diameter_median=2 | grains.diameter_median | Inconsistent
",
    );
    let file = std::env::temp_dir().join(format!("peristalsis-sizes-{}.csv", std::process::id()));
    let name = format!("grains.file={:?}", file.to_str().unwrap());
    for (line, key) in [
        ("-1, 0.5", "diameters"),
        ("0, 0.5", "diameters"),
        ("2, -0.5", "fractions"),
    ] {
        std::fs::write(&file, format!("diameter,fraction\n1,0.5\n{line}\n")).unwrap();
        let settings = ["grains.sizes=\"table\"", &name];
        let problem = only_problem(read(None, Some("frictional"), &settings));
        assert_eq!(problem.kind, ProblemKind::OutOfRange, "{problem}");
        assert!(
            problem.message.contains(&format!("grains.{key}[1]")),
            "{problem}"
        );
        assert_eq!(problem.labels[0].line_and_column().0, 3, "{problem}");
    }
    std::fs::remove_file(&file).unwrap();
}
