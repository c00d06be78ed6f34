//! Grains of a material by name.

use peristalsis_configuration::{MATERIALS, ProblemKind, material};

use crate::{NO_OVERRIDES, only_problem, preset, read, record, refuses, schema_errors};

const BEADS: [&str; 3] = [
    "units.material=glass",
    "units.grain_diameter=1e-3",
    "units.stiffness=1e3",
];

#[test]
fn a_material_stands_for_density_friction_and_restitution() {
    let beads = preset("frictionless", &BEADS);
    let glass = material("glass").unwrap();
    assert_eq!(beads.units.unwrap().density, glass.density);
    let friction = beads.contact.friction.expect("glass rubs");
    assert_eq!(
        [friction.static_friction, friction.kinetic_friction],
        [glass.friction; 2]
    );
    let same = preset(
        "frictionless",
        &[
            "units.density=2500",
            BEADS[1],
            BEADS[2],
            "contact.restitution=0.97",
            "contact.static_friction=0.09",
        ],
    );
    assert_eq!(beads, same);
    assert_eq!(beads.physics_hash(), same.physics_hash());
    record(&beads);
}

#[test]
fn what_is_given_beside_a_material_or_above_it_holds() {
    let text = "preset = \"frictionless\"\nunits = { material = \"steel\", grain_diameter = 1e-3, stiffness = 1e3 }\n\
                contact.static_friction = 0.4\ncontact.normal_damping = 0.01\n";
    assert!(schema_errors(text).is_empty());
    let beside = read(Some(text), None, NO_OVERRIDES).unwrap();
    assert_eq!(beside.contact.friction.unwrap().static_friction, 0.4);
    assert!(beside.to_toml().contains("normal_damping = 0.01"));
    // A layer above names another: what the file said of the material goes.
    let sand = read(Some(text), None, &["units.material=sand"]).unwrap();
    let restitution = read(Some(text), None, &["contact.restitution=0.7"]).unwrap();
    assert_eq!(sand.contact.friction.unwrap().static_friction, 0.5);
    assert_eq!(sand.contact.normal, restitution.contact.normal);
    assert_eq!(sand.units.unwrap().density, 2650.0);
    let smooth = read(
        Some(text),
        None,
        &["contact.static_friction=0", "contact.kinetic_friction=0"],
    );
    assert_eq!(smooth.unwrap().contact.friction, None);
}

#[test]
fn the_modulus_of_a_material_is_that_of_hertz_contacts() {
    let spheres = ["units.material=pmma", "units.grain_diameter=2e-3"];
    let hard = preset("frictional", &spheres);
    assert_eq!(hard.units.unwrap().elasticity.value(), 3e9);
    assert!(hard.to_toml().contains("poisson_ratio = 0.37"));
    // Grains are computed softer than they are, and stay so when the material changes.
    let text = "preset = \"frictional\"\nunits.grain_diameter = 2e-3\nunits.density = 1000.0\nunits.young_modulus = 1e6\n";
    let soft = read(Some(text), None, &spheres[..1]).unwrap();
    assert_eq!(soft.units.unwrap().elasticity.value(), 1e6);
    assert_eq!(soft.units.unwrap().density, 1190.0);
}

#[test]
fn materials_that_cannot_be() {
    refuses("frictionless | units.material=glas | units.material | WrongType | glass");
    let text = "preset = \"frictionless\"\n[units]\nmaterial = \"glass\"\n";
    let alone = only_problem(read(Some(text), None, NO_OVERRIDES));
    assert_eq!(alone.kind, ProblemKind::Missing);
    assert_eq!(alone.labels[0].line_and_column().0, 3);
    assert!(
        alone
            .message
            .contains("units.grain_diameter and units.stiffness"),
        "{alone:?}"
    );
    for material in MATERIALS {
        assert!(material.source.len() > 20 && (0.0..1.0).contains(&material.friction));
    }
}
