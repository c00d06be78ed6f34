//! Cohesion: its forces and energies in and beyond contact, against forms that the law does not use.

mod common;

use common::{Collision, JKR, LINEAR, PULL, hertz, smooth};
use core::f64::consts::PI;
use glam::DVec3;
use peristalsis_physics::contact::{
    Cohesion, Contact, ContactForce, ContactLaw, ContactModel, DissipationForm, General,
    GeneralHistory, Normal, TangentialLaw, reduced_radius,
};

const HERTZ: Normal = Normal::Hertz(hertz(DissipationForm::Viscoelastic));

fn law(normal: Normal, cohesion: Cohesion) -> ContactLaw<Normal, General> {
    let model = ContactModel {
        cohesion: Some(cohesion),
        ..smooth(normal)
    };
    let tangential = General::of(&model).expect("a cohesive model is general");
    ContactLaw { normal, tangential }
}

/// Two spheres of diameters 1 and 0.6 at this overlap, at rest.
fn at(law: &ContactLaw<Normal, General>, overlap: f64) -> (ContactForce, GeneralHistory) {
    let separation = (0.8 - overlap) * DVec3::X;
    let contact = Contact::new((1.0, 0.6), separation, DVec3::ZERO);
    let mut history = GeneralHistory::default();
    (law.force(&contact, &mut history, 0.0), history)
}

/// The overlap and the force of a JKR contact of radius a, as Johnson, Kendall and Roberts have them.
fn jkr(radius: f64, work_of_adhesion: f64) -> (f64, f64) {
    let reduced = reduced_radius(1.0, 0.6);
    // Y = 1, nu = 1/2.
    let modulus = 1.0 / (2.0 * 0.75);
    let overlap =
        radius * radius / reduced - (2.0 * PI * work_of_adhesion * radius / modulus).sqrt();
    let cubed = radius * radius * radius;
    let force = 4.0 * modulus * cubed / (3.0 * reduced)
        - (8.0 * PI * work_of_adhesion * modulus * cubed).sqrt();
    (overlap, force)
}

#[test]
fn a_jkr_contact_has_the_force_of_its_radius() {
    for surface_energy in [1e-9, 1e-6, 1e-3, 0.1] {
        let law = law(
            HERTZ,
            Cohesion {
                surface_energy,
                ..JKR
            },
        );
        // From where it breaks, a^3 = pi w R^2/(8 E*), to far above.
        let reduced = reduced_radius(1.0, 0.6);
        let least = (2.0 * PI * surface_energy * reduced * reduced * 1.5 / 8.0).cbrt();
        for part in [1.001, 1.1, 1.5, 2.0, 5.0, 20.0] {
            let (overlap, force) = jkr(part * least, 2.0 * surface_energy);
            if overlap > 0.5 {
                continue;
            }
            let found = at(&law, overlap).0.force.x;
            assert!(
                (found - force).abs() < 1e-6 * force.abs() + 1e-14,
                "{surface_energy} {part}: {found} {force}"
            );
        }
    }
}

#[test]
fn the_elastic_force_is_the_slope_of_the_energy_also_across_a_gap() {
    for (normal, cohesion) in [(HERTZ, JKR), (HERTZ, PULL), (Normal::Linear(LINEAR), PULL)] {
        let law = law(normal, cohesion);
        let range = law.range(1.0);
        for part in [-0.55, -0.3, -0.01, 0.1, 1.0, 5.0] {
            let (overlap, step) = (part * range, 1e-6);
            let slope = (at(&law, overlap + step).0.energy - at(&law, overlap - step).0.energy)
                / (2.0 * step);
            let found = at(&law, overlap).0.force.x;
            assert!(
                (found - slope).abs() < 1e-8,
                "{cohesion:?} {part}: {found} {slope}"
            );
        }
        assert!(at(&law, 1e-12).0.energy.abs() <= 0.5 * PULL.pull_off(0.25) * PULL.cohesion_range);
    }
}

/// 7.09 (w^5 R^4/E*^2)^(1/3), Thornton & Ning.
#[test]
fn the_energy_of_making_and_breaking() {
    let law = law(HERTZ, JKR);
    let (_, history) = at(&law, 0.01);
    let reduced = reduced_radius(1.0, 0.6);
    let work: f64 = 2.0 * JKR.surface_energy;
    let modulus: f64 = 1.0 / 1.5;
    let expected = 7.09 * (work.powi(5) * reduced.powi(4) / (modulus * modulus)).cbrt();
    let found = law.tangential.bond(&history);
    assert!((found / expected - 1.0).abs() < 1e-3, "{found} {expected}");
}

/// A contact is made by touching alone, and then lasts across a gap.
#[test]
fn a_jkr_contact_is_made_where_spheres_touch() {
    let law = law(HERTZ, JKR);
    let contact = |overlap: f64| Contact::new((1.0, 0.6), (0.8 - overlap) * DVec3::X, DVec3::ZERO);
    let mut history = GeneralHistory::default();
    let gap = 0.4 * law.range(1.0);
    assert!(!law.acts(&contact(-gap), &history));
    assert!(law.acts(&contact(1e-9), &history));
    let touch = law.force(&contact(1e-12), &mut history, 0.0);
    let pull_off = 3.0 * PI * JKR.surface_energy * reduced_radius(1.0, 0.6);
    assert!((touch.force.x / pull_off + 8.0 / 9.0).abs() < 1e-6);
    assert!(law.acts(&contact(-gap), &history));
    assert!(!law.acts(&contact(-2.0 * law.range(1.0)), &history));
}

/// Without dissipation linear cohesion gives back what it took; JKR keeps two spheres together that meet more slowly than
/// its loss allows, and takes the same energy from all others.
#[test]
fn slow_spheres_stick_and_fast_ones_part() {
    use peristalsis_physics::contact::NormalLaw;
    let model = |cohesion| ContactModel {
        cohesion: Some(cohesion),
        ..smooth(HERTZ.undamped())
    };
    let restitution = |cohesion, speed: f64| {
        let mut spheres = Collision::oblique(model(cohesion), speed, 0.0);
        // Linear cohesion is felt before they touch.
        spheres.position[0].x = -1.0 - PULL.cohesion_range;
        let start = spheres.kinetic_energy();
        spheres.evaluate(0.0);
        for _ in 0..40_000 {
            spheres.step(1e-3);
        }
        let parted = !spheres.touches();
        (parted, start - spheres.kinetic_energy())
    };
    let (parted, lost) = restitution(PULL, 0.02);
    assert!(parted && lost.abs() < 1e-8, "{lost}");
    let law = law(HERTZ, JKR);
    let mut history = GeneralHistory::default();
    let touching = Contact::new((1.0, 1.0), DVec3::X * (1.0 - 1e-9), DVec3::ZERO);
    law.force(&touching, &mut history, 0.0);
    let bond = law.tangential.bond(&history);
    // m_ij v^2/2 with m_ij = 1/2.
    let sticking = (4.0 * bond).sqrt();
    assert!(!restitution(JKR, 0.97 * sticking).0);
    let (parted, lost) = restitution(JKR, 1.1 * sticking);
    assert!(parted && (lost / bond - 1.0).abs() < 0.02, "{lost} {bond}");
}
