//! Cohesion: its forces and energies in and beyond contact, against forms that the law does not use.

mod common;

use common::{Collision, JKR, JKR_FORCE, LINEAR, PULL, hertz, smooth};
use core::f64::consts::PI;
use glam::DVec3;
use peristalsis_physics::contact::{
    Cohesion, Contact, ContactForce, ContactLaw, ContactModel, DissipationForm, General,
    GeneralHistory, Normal, PullOff, TangentialLaw, reduced_radius,
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
    for (normal, cohesion) in [
        (HERTZ, JKR),
        (HERTZ, JKR_FORCE),
        (HERTZ, PULL),
        (Normal::Linear(LINEAR), PULL),
    ] {
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

/// Where a neck breaks: the radius, its overlap and force, and the work that led there from touch, along the branch of
/// Johnson, Kendall and Roberts.
fn breaking(pull_off: PullOff, work_of_adhesion: f64) -> (f64, f64, f64) {
    let reduced = reduced_radius(1.0, 0.6);
    let modulus = 1.0 / 1.5;
    // d xi/da = 0 (there the gap is largest), and df/da = 0.
    let least = (PI * work_of_adhesion * reduced * reduced / (8.0 * modulus)).cbrt();
    let radius = match pull_off {
        PullOff::Displacement => least,
        PullOff::Force => least * 9.0_f64.cbrt(),
    };
    // xi = 0
    let touch = least * 16.0_f64.cbrt();
    let steps = 4000;
    let at = |step: i32| {
        jkr(
            touch + (radius - touch) * f64::from(step) / f64::from(steps),
            work_of_adhesion,
        )
    };
    let work: f64 = (0..steps)
        .map(|step| (at(step), at(step + 1)))
        .map(|(one, other)| 0.5 * (one.1 + other.1) * (other.0 - one.0))
        .sum();
    let (overlap, force) = at(steps);
    (overlap, force, work)
}

/// The gap, the force and the energy of breaking, of both ways to pull.
#[test]
fn a_neck_breaks_where_its_gap_or_its_pull_is_largest() {
    let reduced = reduced_radius(1.0, 0.6);
    let work = 2.0 * JKR.surface_energy;
    let most = 3.0 * PI * JKR.surface_energy * reduced;
    for (cohesion, part, coefficient) in [(JKR, 5.0 / 9.0, 7.09), (JKR_FORCE, 1.0, 3.50)] {
        let law = law(HERTZ, cohesion);
        let (overlap, force, energy) = breaking(cohesion.pull_off, work);
        assert!((force / most + part).abs() < 1e-12, "{force} {most}");
        let (_, mut history) = at(&law, 0.01);
        let contact =
            |overlap: f64| Contact::new((1.0, 0.6), (0.8 - overlap) * DVec3::X, DVec3::ZERO);
        assert!(law.acts(&contact(0.999_999 * overlap), &history));
        assert!(!law.acts(&contact(1.000_001 * overlap), &history));
        let last = law.force(&contact(0.999_999 * overlap), &mut history, 0.0);
        // The slope of the force is infinite where the gap is largest.
        assert!(
            (last.force.x / force - 1.0).abs() < 5e-3,
            "{last:?} {force}"
        );
        let bond = law.tangential.bond(&history);
        assert!((bond / energy - 1.0).abs() < 1e-6, "{bond} {energy}");
        let closed = coefficient * (work.powi(5) * reduced.powi(4) * 1.5 * 1.5).cbrt();
        assert!((bond / closed - 1.0).abs() < 1e-3, "{bond} {closed}");
    }
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
    for jkr in [JKR, JKR_FORCE] {
        let (_, _, bond) = breaking(jkr.pull_off, 2.0 * jkr.surface_energy);
        // Of spheres of diameter 1; the bond goes with R^(4/3).
        let bond = bond * (0.25 / reduced_radius(1.0, 0.6)).powf(4.0 / 3.0);
        // m_ij v^2/2 with m_ij = 1/2.
        let sticking = (4.0 * bond).sqrt();
        assert!(!restitution(jkr, 0.97 * sticking).0);
        let (parted, lost) = restitution(jkr, 1.1 * sticking);
        assert!(parted && (lost / bond - 1.0).abs() < 0.02, "{lost} {bond}");
    }
}
