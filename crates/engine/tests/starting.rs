//! How simulations begin, and how they fail: packing, seeds, few grains, divergence.

use peristalsis_engine::initial::LARGEST_MEAN_OVERLAP;

mod common;

use common::*;

fn packing(number: usize, state: InitialState, seed: u64) -> Packing {
    Packing {
        number,
        sizes: Sizes::Uniform([0.8, 1.0]),
        state,
        axial_velocity: 0.0,
        temperature: 0.0,
        seed,
    }
}

fn number(volume_fraction: f64, length: f64) -> usize {
    (volume_fraction * 6.0 * 1.5 * 1.5 * length).round() as usize
}

/// Mean and largest overlap of all contacts, by looking at all pairs.
fn overlaps(bodies: &Bodies, wall: &Wall) -> (f64, f64) {
    let parameters = parameters(LINEAR, None, Integrator::Verlet, 0.05);
    let simulation = Simulation::new(bodies.clone(), wall.clone(), parameters);
    let tally = simulation.tally();
    let contacts = (tally.grain_contacts + tally.wall_contacts).max(1);
    (tally.total_overlap / contacts as f64, tally.largest_overlap)
}

#[test]
fn packed_grains_stand_inside_at_rest() {
    let strain = strained(coarse(2), -1.0, 2.6, 0.05);
    let stress = elastic(elastic_parameters());
    for (name, wall, number, inside) in [
        ("dilute", &strain, 12, 0.0),
        ("dense", &strain, number(0.45, 20.0), 0.2),
        ("elastic", &stress, 330, 0.2),
    ] {
        for normal in [LINEAR, HERTZ] {
            let (bodies, report) =
                pack(&packing(number, InitialState::Rest, 1), wall, normal).unwrap();
            assert_eq!(bodies.grains, number);
            let spheres = if name == "elastic" {
                elastic_parameters().lattice.spheres()
            } else {
                0
            };
            assert_eq!(bodies.number(), number + spheres);
            let length = wall.length();
            for grain in 0..number {
                let (place, diameter) = (bodies.position[grain], bodies.diameter[grain]);
                assert!((0.0..length).contains(&place.z), "{name}: {place}");
                assert!((0.8..1.0).contains(&diameter));
                assert!((bodies.mass[grain] - diameter.powi(3)).abs() < 1e-15);
                assert!((bodies.inertia[grain] - 0.1 * diameter.powi(5)).abs() < 1e-15);
                let wave = wall.wave().map(|wave| wave.radius(place.z, wall.cycles()));
                let radius = wave.unwrap_or(wall.mean_radius());
                let from_axis = (place.x * place.x + place.y * place.y).sqrt();
                assert!(
                    from_axis < radius - 0.5 * (diameter + 1.0) + inside + 0.05,
                    "{name}: {from_axis} {radius}"
                );
            }
            assert!(
                bodies
                    .velocity
                    .iter()
                    .all(|velocity| *velocity == DVec3::ZERO)
            );
            let (mean, largest) = overlaps(&bodies, wall);
            println!("{name}: {report:?}");
            assert!(
                (report.mean_overlap - mean).abs() < 1e-3
                    && (report.largest_overlap - largest).abs() < 1e-3
            );
            assert_eq!(report.inserted == number, report.iterations == 0);
            if name == "dilute" {
                assert_eq!((report.inserted, mean), (number, 0.0));
            } else {
                assert!(report.inserted < number && mean < 0.2, "{name}: {report:?}");
                assert!(report.stored_energy > 0.0);
            }
        }
    }
}

#[test]
fn a_hot_start_has_its_temperature_and_stands_as_a_cold_one() {
    let wall = strained(coarse(20), -1.0, 2.6, 0.05);
    let cold = packing(1_500, InitialState::Rest, 1);
    let hot = Packing {
        axial_velocity: 0.3,
        temperature: 0.01,
        ..cold.clone()
    };
    let [(cold, _), (hot, _)] = [cold, hot].map(|packing| pack(&packing, &wall, LINEAR).unwrap());
    assert_eq!(cold.position, hot.position);
    let grains = hot.grains as f64;
    let mean = hot.velocity[..hot.grains].iter().sum::<DVec3>() / grains;
    let of_grain = |i: usize| hot.mass[i] * (hot.velocity[i] - mean).abs().powf(2.0) / grains;
    let temperature = (0..hot.grains).map(of_grain).sum::<DVec3>();
    // A variance from N normal numbers has the relative error (2/N)^(1/2), 0.037 here; four of them.
    for component in temperature.to_array() {
        assert!((component / 0.01 - 1.0).abs() < 0.15, "{temperature}");
    }
    assert!((mean - DVec3::new(0.0, 0.0, 0.3)).length() < 0.02, "{mean}");
}

#[test]
fn a_jammed_start_fills_the_bellies_and_moves_with_the_wave() {
    let wall = strained(coarse(2), -1.0, 2.4, 0.05);
    let jammed = Packing {
        axial_velocity: -0.5,
        ..packing(number(0.15, 20.0), InitialState::Jammed, 1)
    };
    let (bodies, _) = pack(&jammed, &wall, LINEAR).unwrap();
    let wave = wall.wave().expect("a prescribed wall");
    let wide = bodies
        .position
        .iter()
        .filter(|place| wave.radius(place.z, 0.0) > 1.4)
        .count();
    assert!(
        wide as f64 > 0.95 * bodies.grains as f64,
        "{wide} of {}",
        bodies.grains
    );
    assert!(
        bodies
            .velocity
            .iter()
            .all(|velocity| *velocity == DVec3::new(0.0, 0.0, -0.5))
    );
    // In both bellies.
    let first = bodies
        .position
        .iter()
        .filter(|place| place.z < 10.0)
        .count();
    assert!(first > bodies.grains / 4 && first < 3 * bodies.grains / 4);
}

/// A tube squeezed once a wavelength: half way between the throats, both ways round.
#[test]
fn a_jammed_start_fills_the_straight_parts_of_a_squeezed_tube() {
    for waveform in [Waveform::Bolus, Waveform::Roller] {
        for heading in [1.0, -1.0] {
            let (amplitude, frequency) = (Schedule::constant(0.4), Schedule::constant(0.1));
            let wall = waving(coarse(2), 1.5, waveform, heading, amplitude, frequency);
            let jammed = packing(number(0.1, 20.0), InitialState::Jammed, 1);
            let (bodies, _) = pack(&jammed, &wall, LINEAR).unwrap();
            for position in &bodies.position {
                // The throat is at phase 3/4, the wave -heading z/lambda.
                let phase = (-heading * position.z / 10.0).rem_euclid(1.0);
                assert!(
                    (0.0..0.55).contains(&phase) || phase > 0.95,
                    "{waveform:?}: {phase}"
                );
            }
        }
    }
}

#[test]
fn a_seed_decides_every_bit() {
    for wall in [
        strained(coarse(2), -1.0, 2.6, 0.05),
        elastic(elastic_parameters()),
    ] {
        for (state, number) in [(InitialState::Rest, 130), (InitialState::Jammed, 60)] {
            let of_seed = |seed: u64| {
                pack(&packing(number, state, seed), &wall, LINEAR)
                    .unwrap()
                    .0
            };
            let (one, same, other) = (of_seed(1), of_seed(1), of_seed(2));
            assert_eq!(one, same);
            assert!(one.position[..number] != other.position[..number]);
            assert!(one.diameter[..number] != other.diameter[..number]);
            let run = |bodies: &Bodies| {
                let parameters = parameters(LINEAR, Some(FRICTION), Integrator::Verlet, 0.05);
                bits(&advanced(bodies, &wall, parameters, 50))
            };
            assert_eq!(run(&one), run(&same));
            assert_ne!(run(&one), run(&other));
        }
    }
}

#[test]
fn too_many_grains_do_not_fit() {
    let wall = strained(coarse(1), -1.0, 2.6, 0.05);
    for normal in [LINEAR, HERTZ] {
        // As many as the source has at its fullest, volume fraction 0.6, do fit, and all stand inside.
        assert!(
            pack(
                &packing(number(0.6, 10.0), InitialState::Rest, 1),
                &wall,
                normal
            )
            .is_ok()
        );
        let refused = pack(&packing(1_000, InitialState::Rest, 1), &wall, normal).unwrap_err();
        println!("{refused}");
        let EngineError::DoesNotFit {
            grains,
            limit,
            outside,
            ..
        } = refused
        else {
            panic!("{refused}");
        };
        // The wall is soft: what is too much leaves through it, the rest overlaps by some 0.2 d.
        assert!(grains == 1_000 && outside > 100, "{outside}");
        assert!((limit / LARGEST_MEAN_OVERLAP - 1.0).abs() < 0.05);
    }
}

/// Nothing, or next to nothing, is a simulation as well.
#[test]
fn few_grains_are_enough() {
    for wall in [
        strained(coarse(1), -1.0, 2.6, 0.1),
        elastic(elastic_parameters()),
    ] {
        for number in [0, 1, 2] {
            for friction in [None, Some(FRICTION)] {
                for integrator in INTEGRATORS {
                    let bodies = packed(number, 1.0, &wall, LINEAR, 1);
                    let mut simulation = Simulation::new(
                        bodies,
                        wall.clone(),
                        parameters(LINEAR, friction, integrator, 0.05),
                    );
                    simulation.advance(400).unwrap();
                    assert_eq!(
                        (simulation.step(), simulation.bodies().grains),
                        (400, number)
                    );
                    assert!(simulation.energy().is_finite() && simulation.energy_residual() < 1e-2);
                    let snapshot = simulation.snapshot();
                    let again = Simulation::restore(
                        snapshot.clone(),
                        wall.clone(),
                        *simulation.parameters(),
                    )
                    .unwrap();
                    assert_eq!(again.snapshot(), snapshot);
                }
            }
        }
    }
}

/// A time step far beyond the contact time, stiff grains: the run stops and says where.
#[test]
fn an_absurd_time_step_stops_with_step_and_grain() {
    for integrator in INTEGRATORS {
        let normal = Normal::Linear(linear(1e6, 0.0));
        let bodies = grains(&[
            (DVec3::new(3.0, 0.0, 5.0), DVec3::ZERO),
            (DVec3::new(0.0, 0.0, 5.0), DVec3::new(0.0, 0.0, 0.3)),
            (DVec3::new(0.0, 0.0, 6.1), DVec3::ZERO),
        ]);
        let parameters = parameters(normal, None, integrator, 0.5);
        let mut simulation = Simulation::new(bodies, wide(20.0), parameters);
        let stopped = simulation.advance(1_000).unwrap_err();
        println!("{stopped}");
        let EngineError::Diverged {
            step,
            time,
            grain,
            displacement,
            limit,
            ..
        } = stopped.clone()
        else {
            panic!("{stopped}");
        };
        // They touch at the end of the first step and fly apart: in the second, or, where the force of a step's end moves
        // grains only one step later, in the third.
        assert_eq!((step, grain), (simulation.step(), 1));
        assert_eq!(
            step,
            if integrator == Integrator::Verlet {
                2
            } else {
                3
            }
        );
        assert!((time - 0.5 * step as f64).abs() < 1e-12);
        assert!(displacement > limit && limit == 0.5);
        assert!(
            stopped.to_string().contains(&format!("step {step} "))
                && stopped.to_string().contains("grain 1")
        );
    }
}

#[test]
fn lost_numbers_are_found() {
    for integrator in INTEGRATORS {
        for lost in [f64::NAN, f64::INFINITY] {
            let mut bodies = grains(&[
                (DVec3::new(0.0, 0.0, 5.0), DVec3::ZERO),
                (DVec3::new(0.0, 0.0, 6.1), DVec3::ZERO),
            ]);
            bodies.velocity[1].x = lost;
            let mut simulation = Simulation::new(
                bodies,
                wide(20.0),
                parameters(LINEAR, None, integrator, 0.05),
            );
            let stopped = simulation.advance(10).unwrap_err();
            assert!(
                matches!(
                    stopped,
                    EngineError::Diverged {
                        step: 1,
                        grain: 1,
                        outside: false,
                        ..
                    }
                ),
                "{stopped}"
            );
        }
    }
}

#[test]
fn a_grain_that_had_left_the_tube_is_said_to_have_left_it() {
    for (x, outside) in [(0.0, false), (25.0, true)] {
        let fast = (DVec3::new(x, 0.0, 5.0), DVec3::new(0.0, 0.0, 100.0));
        let parameters = parameters(LINEAR, None, Integrator::Verlet, 0.05);
        let mut simulation = Simulation::new(grains(&[fast]), wide(20.0), parameters);
        let said = simulation.advance(1).unwrap_err().to_string();
        assert_eq!(
            said.contains("grain 0, outside the tube, moved"),
            outside,
            "{said}"
        );
    }
}
