//! Open ends: no grain is lost or counted twice, energy is accounted for, and bits depend on nothing but the step.

#![expect(clippy::unwrap_used, reason = "a test may")]

mod common;

use common::*;
use peristalsis_engine::{OpenEnds, Passages};
use peristalsis_physics::ends::{Inlet, STEPS_PER_LOOK};

const GRAINS: usize = 150;
const WAITING: usize = 40;

/// A tube of one wave, its bottleneck halfway.
fn tube(heading: f64, strain_rate: f64) -> Wall {
    prescribed(lattice(26, 24, 1, 24.0), 3.8, heading, 0.8, strain_rate)
}

fn inlet() -> Inlet {
    Inlet {
        head: 18.0,
        length: 3.0,
        feed_rate: None,
        velocity: 0.02,
        waiting: WAITING as u64,
    }
}

/// Grains that fall through an open tube.
fn falling(
    heading: f64,
    inlet: Inlet,
    friction: Option<CundallStrack>,
    kernel: Kernel,
) -> Simulation {
    fed(heading, inlet, friction, kernel, 1)
}

/// The same, fed at every so many looks.
fn fed(
    heading: f64,
    inlet: Inlet,
    friction: Option<CundallStrack>,
    kernel: Kernel,
    looks_per_feeding: u64,
) -> Simulation {
    let wall = tube(heading, 0.0);
    let bodies = packed(GRAINS, 0.8, &wall, LINEAR, 3);
    let parameters = Parameters {
        kernel,
        body_force: DVec3::new(0.0, -2e-4, 1e-3 * heading),
        ..parameters(LINEAR, friction, Integrator::Verlet, 0.1)
    };
    let ends = OpenEnds {
        heading,
        inlet,
        seed: 5,
        looks_per_feeding,
    };
    Simulation::new(bodies, wall, parameters)
        .open(ends, &[0.9; WAITING])
        .unwrap()
}

/// Grains in the tube: those that do not wait.
fn inside(simulation: &Simulation) -> usize {
    simulation.bodies().grains - simulation.ends().unwrap().waiting()
}

/// Distance from the inlet towards the outlet.
fn along(simulation: &Simulation, grain: usize, heading: f64) -> f64 {
    let z = simulation.bodies().unfolded(grain, 24.0);
    if heading > 0.0 { z } else { 24.0 - z }
}

#[test]
fn every_grain_is_counted_once_and_energy_is_accounted_for() {
    for heading in [1.0, -1.0] {
        for (friction, kernel) in [
            (None, Kernel::Fast),
            (Some(FRICTION), Kernel::Fast),
            (Some(FRICTION), Kernel::Reference),
        ] {
            let mut simulation = falling(heading, inlet(), friction, kernel);
            let began = inside(&simulation);
            assert!((60..=GRAINS).contains(&began), "{began}");
            let mass = |simulation: &Simulation| -> f64 {
                let ends = simulation.ends().unwrap();
                let present = (0..GRAINS + WAITING).filter(|&grain| !ends.waits(grain));
                present.map(|grain| simulation.bodies().mass[grain]).sum()
            };
            let began_with = mass(&simulation);
            for _ in 0..30 {
                simulation.advance(200).unwrap();
                let Passages {
                    discharged,
                    returned,
                    leaked,
                    fed,
                    ..
                } = *simulation.ends().unwrap().passages();
                let gone = discharged.grains + returned.grains + leaked.grains;
                assert_eq!(inside(&simulation) as u64 + gone, began as u64 + fed.grains);
                let gone = discharged.mass + returned.mass + leaked.mass;
                let missing = mass(&simulation) + gone - began_with - fed.mass;
                assert!(missing.abs() < 1e-9, "{missing}");
                // Nobody is in the gap, and those who wait touch nobody.
                let ends = simulation.ends().unwrap();
                for grain in 0..GRAINS + WAITING {
                    let place = along(&simulation, grain, heading);
                    assert!(ends.waits(grain) || (0.0..=simulation.length()).contains(&place));
                }
                for touching in simulation.touching() {
                    assert!(!ends.waits(touching.first));
                }
            }
            let passages = simulation.ends().unwrap().passages();
            assert!(passages.discharged.grains > 100, "{passages:?}");
            assert_eq!((passages.returned.grains, passages.leaked.grains), (0, 0));
            let times = simulation.ends().unwrap().transit_times();
            assert!(times.number() > 0 && times.number() <= passages.discharged.grains);
            assert!(
                simulation.energy_residual() < 2e-3,
                "{}",
                simulation.energy_residual()
            );
        }
    }
}

/// Bits of all that a run leaves.
fn bits(simulation: &Simulation) -> String {
    format!("{:?}", simulation.snapshot())
}

#[test]
fn bits_do_not_depend_on_division_stops_or_threads() {
    for (friction, kernel) in [
        (None, Kernel::Fast),
        (Some(FRICTION), Kernel::Fast),
        (Some(FRICTION), Kernel::Reference),
    ] {
        let mut whole = falling(-1.0, inlet(), friction, kernel);
        let mut parts = whole.clone();
        whole.advance(2000).unwrap();
        parts.compute_with(Instructions::widest(), 3).unwrap();
        let mut left = 2000;
        for steps in [1, 7, 19, 20, 33, 140].into_iter().cycle() {
            let steps = left.min(steps);
            parts.advance(steps).unwrap();
            left -= steps;
            if left == 0 {
                break;
            }
            if left < 900 {
                let (wall, parameters) = (tube(-1.0, 0.0), *parts.parameters());
                parts = Simulation::restore(parts.snapshot(), wall, parameters).unwrap();
            }
        }
        assert!(whole.ends().unwrap().passages().discharged.grains > 20);
        assert_eq!(bits(&whole), bits(&parts));
    }
}

#[test]
fn a_feed_rate_is_kept_and_who_runs_dry_is_told() {
    let fed = Inlet {
        feed_rate: Some(0.05),
        ..inlet()
    };
    let mut simulation = falling(-1.0, fed, None, Kernel::Fast);
    simulation.advance(6000).unwrap();
    let passages = *simulation.ends().unwrap().passages();
    assert_eq!((passages.fed.grains, passages.starved), (30, 0));
    // As many as there is place for are more than there are.
    let mut simulation = falling(
        -1.0,
        Inlet {
            length: 18.0,
            ..inlet()
        },
        None,
        Kernel::Fast,
    );
    simulation.advance(200).unwrap();
    let ends = simulation.ends().unwrap();
    assert!(ends.waiting() == 0 && ends.passages().starved > 0);
}

#[test]
fn an_inlet_without_a_feed_rate_fills_up_at_its_own_looks_alone() {
    let put_in = |inlet: Inlet, looks: u64| {
        let mut simulation = fed(1.0, inlet, None, Kernel::Fast, looks);
        let mut at = Vec::new();
        for look in 1..=12 {
            let before = simulation.ends().unwrap().passages().fed.grains;
            simulation.advance(STEPS_PER_LOOK).unwrap();
            if simulation.ends().unwrap().passages().fed.grains > before {
                at.push(look);
            }
        }
        at
    };
    let third = put_in(inlet(), 3);
    assert!(
        !third.is_empty() && third.iter().all(|look| look % 3 == 0),
        "{third:?}"
    );
    let steady = Inlet {
        feed_rate: Some(2.0),
        ..inlet()
    };
    assert!(put_in(steady, 3).iter().any(|look| look % 3 != 0));
}

#[test]
fn grains_that_wait_do_no_work_and_go_nowhere() {
    let shut = Inlet {
        feed_rate: Some(0.0),
        ..inlet()
    };
    let opened = |more: &[f64]| {
        let wall = tube(1.0, 0.0);
        let bodies = packed(GRAINS, 0.8, &wall, LINEAR, 3);
        let parameters = Parameters {
            body_force: DVec3::new(0.0, -2e-3, 1e-2),
            ..parameters(LINEAR, Some(FRICTION), Integrator::Verlet, 0.1)
        };
        let ends = OpenEnds {
            heading: 1.0,
            inlet: shut,
            seed: 5,
            looks_per_feeding: 1,
        };
        let closed = Simulation::new(bodies, wall, parameters);
        closed.open(ends, more).unwrap()
    };
    let (mut few, mut many) = (opened(&[]), opened(&[0.9; WAITING]));
    // The last of these lies between two looks.
    for steps in [20, 200, 33] {
        few.advance(steps).unwrap();
        many.advance(steps).unwrap();
        let waits = |grain: &usize| !many.is_present(*grain);
        assert!((GRAINS..GRAINS + WAITING).all(|grain| waits(&grain)));
        assert_eq!(many.ledger(), few.ledger());
        assert_eq!(many.energy(), few.energy());
        for grain in (0..GRAINS).filter(waits) {
            assert_eq!(many.travelled(grain), few.travelled(grain));
        }
        for grain in GRAINS..GRAINS + WAITING {
            // Where it was put at the start.
            assert!(many.travelled(grain).abs() < 1e-9, "{grain}");
        }
    }
    assert!(few.ledger().body_work > 0.0 && few.energy_residual() < 2e-3);
}

/// The wave carries grains towards the outlet, and those that it throws back through the inlet count by themselves.
#[test]
fn a_wave_pumps_through_an_open_tube() {
    let wall = tube(1.0, 0.005);
    let bodies = packed(GRAINS, 0.8, &wall, LINEAR, 3);
    let parameters = Parameters {
        body_force: DVec3::new(0.0, -5e-4, -2e-4),
        ..parameters(LINEAR, Some(FRICTION), Integrator::AdamsBashforth, 0.05)
    };
    let ends = OpenEnds {
        heading: 1.0,
        inlet: inlet(),
        seed: 5,
        looks_per_feeding: 1,
    };
    let closed = Simulation::new(bodies, wall, parameters);
    let mut simulation = closed.open(ends, &[]).unwrap();
    let began = inside(&simulation) as u64;
    simulation.advance(24_000).unwrap();
    let passages = *simulation.ends().unwrap().passages();
    assert!(
        passages.discharged.grains > 0 && passages.fed.grains > 0,
        "{passages:?}"
    );
    let gone = passages.discharged.grains + passages.returned.grains;
    assert_eq!(
        inside(&simulation) as u64 + gone,
        began + passages.fed.grains
    );
    assert!(
        simulation.energy_residual() < 5e-3,
        "{}",
        simulation.energy_residual()
    );
}
