//! Observables of states whose values are known without a simulation: free flight in a wide tube.

use glam::DVec3;
use peristalsis_engine::wall::{
    DriveAngle, ElasticNetwork, ElasticParameters, ElasticWall, PrescribedWall,
};
use peristalsis_engine::{Bodies, Integrator, OpenEnds, Parameters, Simulation, Wall};
use peristalsis_observe::columns::Scope;
use peristalsis_observe::{
    AxialDispersion, COLUMNS, Column, ContactForce, ContactForces, FaultKind, Observer, PROFILE,
    Quantity, Sample, TubeShape, View, WAVES, WaveByWave, WaveFrameProfile, WavePart, clear_volume,
    note_wall_faults,
};
use peristalsis_physics::contact::{ContactModel, LinearSpringDashpot, Normal};
use peristalsis_physics::ends::Inlet;
use peristalsis_physics::wall::{Lattice, Schedule, Waveform};

const LATTICE: Lattice = Lattice {
    spheres_per_ring: 40,
    rings_per_wave: 14,
    waves: 2,
    wavelength: 10.0,
    sphere_diameter: 1.0,
    staggered: true,
};
const STRAIN_RATE: f64 = 0.1;

fn wall(heading: f64, amplitude: f64) -> Wall {
    Wall::Prescribed(PrescribedWall::new(
        LATTICE,
        6.0,
        Waveform::Sine,
        heading,
        Schedule::constant(amplitude),
        Schedule::constant(STRAIN_RATE),
    ))
}

fn parameters() -> Parameters {
    Parameters {
        contact: ContactModel::new(
            Normal::Linear(LinearSpringDashpot {
                normal_stiffness: 1.0,
                normal_damping: 5.48e-3,
            }),
            None,
        ),
        integrator: Integrator::Verlet,
        time_step: 0.05,
        skin: 0.3,
        kernel: peristalsis_engine::Kernel::default(),
        body_force: DVec3::ZERO,
    }
}

/// Four grains far apart near the axis; each flies freely.
fn free_flight(heading: f64) -> Simulation {
    let places = [3.0, 8.0, 13.0, 0.1].map(|z| DVec3::new(0.0, 0.0, z));
    let mut bodies = Bodies::grains_at_rest(places.to_vec(), vec![1.0; 4]);
    bodies.velocity = vec![
        DVec3::new(0.0, 0.0, 0.5),
        DVec3::new(0.1, 0.0, 0.5),
        DVec3::new(-0.1, 0.0, 0.5),
        DVec3::new(0.0, 0.0, -0.1),
    ];
    Simulation::new(bodies, wall(heading, 0.5), parameters())
}

/// An elastic wall at rest.
fn elastic_wall(lattice: Lattice, mean_radius: f64) -> ElasticWall {
    ElasticWall::new(ElasticParameters {
        lattice,
        mean_radius,
        network: ElasticNetwork::default(),
        force_amplitude: Schedule::constant(0.004),
        frequency: Schedule::constant(4e-3),
        heading: 1.0,
        waveform: Waveform::Sine,
        angle: DriveAngle::Reference,
    })
}

/// What happens within the first steps of a simulation.
fn sample_after(mut simulation: Simulation, steps: u64) -> Sample {
    let mut observer = Observer::new(&simulation);
    simulation.advance(steps).expect("no sample diverges");
    sampled(&mut observer, &simulation)
}

/// Ends the interval and answers what happened in it.
fn sampled(observer: &mut Observer, simulation: &Simulation) -> Sample {
    let view = View::of(simulation);
    let before = observer.end_interval(&view);
    Sample::of(&before, observer, &view)
}

#[test]
fn the_flow_of_free_flight_is_that_of_the_velocities() {
    for heading in [1.0, -1.0] {
        // The last grain goes backward through the seam.
        let sample = sample_after(free_flight(heading), 40);
        let sum = heading * 1.4;
        assert!((sample.flow_rate - sum / 20.0).abs() < 1e-12);
        assert!((sample.flow_rate_instantaneous - sum / 20.0).abs() < 1e-12);
        // c = 1: J/Jmax is the mean velocity.
        assert!((sample.flow_rate_ratio - sum / 4.0).abs() < 1e-12);
        assert!((sample.time - 2.0).abs() < 1e-12 && (sample.period - 0.2).abs() < 1e-12);
        assert!((sample.kinetic_energy - 0.5 * (3.0 * 0.25 + 0.02 + 0.01)).abs() < 1e-12);
        // Velocities about their mean (0, 0, 0.35): squares 0.0225 * 3 + 0.02 + 0.2025, over 3 N.
        let temperature = (3.0 * 0.0225 + 0.02 + 0.2025) / 12.0;
        assert!((sample.granular_temperature - temperature).abs() < 1e-12);
        assert_eq!((sample.escaped, sample.inside), (0.0, 4.0));
        assert!((sample.bottleneck - 11.0).abs() < 1e-12);
        assert!((sample.axial_momentum - sum).abs() < 1e-12);
    }
}

#[test]
fn a_grain_outside_counts_in_the_raw_columns_only() {
    // Beyond R + d/2 at any phase, and beyond the reach of the wall.
    let mut bodies = free_flight(1.0).bodies().clone();
    bodies.position[3].x = 8.0;
    let simulation = Simulation::new(bodies, wall(1.0, 0.5), parameters());
    let sample = sample_after(simulation, 20);
    assert_eq!((sample.escaped, sample.inside), (1.0, 3.0));
    assert!((sample.flow_rate_ratio - 0.5).abs() < 1e-12);
    assert!((sample.flow_rate_ratio_raw - 0.35).abs() < 1e-12);
    assert!((sample.flow_rate - 1.5 / 20.0).abs() < 1e-12);
    assert!((sample.flow_rate_raw - 1.4 / 20.0).abs() < 1e-12);
}

#[test]
fn the_body_force_works_on_the_grains_inside() {
    for heading in [1.0, -1.0] {
        let mut bodies = free_flight(heading).bodies().clone();
        bodies.position[3].x = 8.0;
        let body_force = DVec3::new(0.0, 0.02, -0.01);
        let parameters = Parameters {
            body_force,
            ..parameters()
        };
        let simulation = Simulation::new(bodies, wall(heading, 0.5), parameters);
        let sample = sample_after(simulation, 20);
        assert_eq!(sample.escaped, 1.0);
        // After the time 1 three grains at 0.5 have fallen from rest across, and their mean axial velocity was 0.495. That
        // across of the fourth counts with its velocity at the end, twice the mean.
        let inside = 3.0 * (-0.01 * 0.495 + 0.02 * 0.01);
        assert!((sample.body_power - (inside - 0.02 * 0.01)).abs() < 1e-12);
        assert!((sample.axial_momentum - heading * 3.0 * 0.49).abs() < 1e-12);
        assert!(
            (sample.kinetic_energy - 0.5 * (3.0 * 0.49 * 0.49 + 0.02 + 0.11 * 0.11 + 4.0 * 4e-4))
                .abs()
                < 1e-12
        );
    }
}

/// Ends through which no grain comes in.
fn shut(heading: f64) -> OpenEnds {
    OpenEnds {
        heading,
        inlet: Inlet {
            head: 10.0,
            length: 3.0,
            feed_rate: Some(0.0),
            velocity: 0.0,
            waiting: 0,
        },
        seed: 1,
        looks_per_feeding: 1,
    }
}

#[test]
fn the_profile_of_an_open_tube_is_that_between_its_ends() {
    for heading in [1.0, -1.0] {
        let mut bodies = free_flight(heading).bodies().clone();
        bodies.position.iter_mut().for_each(|place| place.z += 0.1);
        let closed = Simulation::new(bodies, wall(heading, 0.5), parameters());
        let simulation = closed.open(shut(heading), &[]).unwrap();
        assert_eq!(simulation.length(), 16.0);
        let mut profile = WaveFrameProfile::new(20, 1);
        profile.add(&View::of(&simulation));
        let bins = profile.late(1.0, 10.0);
        // From 6 on in a wavelength only the first wave is in the tube. Grains: 0.2, 3.1, 8.1 and 13.1 from the inlet, or 6.9
        // and 11.9.
        let found = |from_inlet: f64| bins[(2.0 * from_inlet) as usize].density.0;
        match heading > 0.0 {
            true => assert_eq!([0.2, 3.1, 8.1].map(found), [1.0, 2.0, 2.0]),
            false => assert_eq!([1.9, 6.9, 3.1].map(found), [1.0, 2.0, 0.0]),
        }
        let grains: f64 = bins.iter().map(|bin| bin.density.0).sum();
        assert_eq!(grains, if heading > 0.0 { 5.0 } else { 3.0 });
        // Without grains nothing is known of a bin.
        for bin in &bins {
            assert_eq!(bin.temperature.0.is_finite(), bin.density.0 > 0.0);
        }
    }
}

#[test]
fn a_grain_beyond_an_end_is_in_no_profile() {
    let mut bodies = free_flight(1.0).bodies().clone();
    bodies.position[2].z = 15.9;
    let closed = Simulation::new(bodies, wall(1.0, 0.5), parameters());
    let mut simulation = closed.open(shut(1.0), &[]).unwrap();
    // Between two looks it leaves.
    simulation.advance(19).unwrap();
    assert!(simulation.is_present(2) && simulation.bodies().position[2].z > 16.0);
    let mut profile = WaveFrameProfile::new(20, 1);
    profile.add(&View::of(&simulation));
    let bins = profile.late(1.0, 10.0);
    // The three others, each in a bin of two places or of one.
    let densities = bins.iter().map(|bin| bin.density.0).filter(|it| *it > 0.0);
    let densities: Vec<f64> = densities.collect();
    assert!(
        densities.len() == 3 && densities.iter().all(|it| *it <= 2.0),
        "{densities:?}"
    );
}

#[test]
fn the_profile_holds_each_grain_once_and_its_velocity_along_the_wave() {
    for heading in [1.0, -1.0] {
        let mut simulation = free_flight(heading);
        // More blocks than are kept, so that some are merged.
        let mut profile = WaveFrameProfile::new(20, 1);
        for _ in 0..300 {
            simulation.advance(1).unwrap();
            profile.add(&View::of(&simulation));
        }
        let bins = profile.late(1.0, 10.0);
        let grains: f64 = bins.iter().map(|bin| bin.density.0 * 0.5 * 2.0).sum();
        assert!((grains - 4.0).abs() < 1e-9, "{grains}");
        let momentum: f64 = bins
            .iter()
            .filter(|bin| bin.density.0 > 0.0)
            .map(|bin| bin.density.0 * bin.axial_velocity.0)
            .sum();
        assert!((momentum * 0.5 * 2.0 - heading * 1.4).abs() < 1e-9);
        // R = a + b sin(2 pi phase), and the phase runs against the position in the wave frame.
        for bin in &bins {
            let radius = 6.0 - 0.5 * (core::f64::consts::TAU * bin.position).sin();
            assert!((bin.radius - radius).abs() < 1e-9, "{bin:?}");
        }
    }
}

/// Four periods of 20 samples and one sample: the late quarter is the last whole period and that sample.
#[test]
fn a_period_that_is_under_way_is_no_late_part_of_its_own() {
    let mut simulation = free_flight(1.0);
    let mut profile = WaveFrameProfile::new(1, 20);
    let mut number = [0.0; 2];
    for sample in 0..81 {
        simulation.advance(1).unwrap();
        profile.add(&View::of(&simulation));
        if sample == 79 {
            number[0] = profile.late(0.25, 10.0)[0].density.0;
        }
        // One look at the wall a period, in its middle.
        if sample % 20 == 10 {
            profile.add_wall_forces(&simulation);
        }
    }
    let bin = &profile.late(0.25, 10.0)[0];
    number[1] = bin.density.0;
    assert!(
        bin.wall_pressure.0.is_finite() && bin.wall_pressure.1.is_nan(),
        "{bin:?}"
    );
    assert_eq!(number, [0.2; 2]);
    let errors = profile.late(0.5, 10.0)[0].wall_pressure;
    assert_eq!(errors, (0.0, 0.0), "of the two whole periods");
    let whole = profile.late_part(0.25, WavePart::Whole);
    assert!(whole.normal_force.0.is_finite(), "{whole:?}");
}

/// A checker: of 257 periods the last 10 were taken as the last one, of 4,224 the last 30 as 128.
#[test]
fn the_late_part_of_a_long_run_is_as_long_as_it_is_asked_for() {
    let early = free_flight(1.0);
    let mut fewer = early.bodies().clone();
    let grains = fewer.grains;
    fewer.velocity[..grains].fill(DVec3::new(0.0, 0.0, 2.0));
    let late = Simulation::new(fewer, wall(1.0, 0.5), parameters());
    for (periods, number) in [
        (64, 10),
        (65, 10),
        (129, 10),
        (257, 10),
        (513, 1),
        (1000, 60),
        (4224, 30),
        (20_000, 62),
    ] {
        let mut profile = WaveFrameProfile::new(1, 1);
        for _ in 0..periods - number {
            profile.add(&View::of(&early));
        }
        let before = profile.late(1.0, 10.0)[0].axial_velocity.0;
        for _ in 0..number {
            profile.add(&View::of(&late));
        }
        let of = |wanted: u32| {
            let fraction = f64::from(wanted) / f64::from(periods);
            profile.late(fraction, 10.0)[0].axial_velocity
        };
        let (found, error) = of(number);
        assert!((found - 2.0).abs() < 1e-12 && before < 1.9, "{periods}");
        assert_eq!(error.is_nan(), number == 1, "{periods}");
        // Of a long late part the oldest block may be left out.
        let wanted = periods / 2;
        let part = f64::from(number) / f64::from(wanted);
        let expected = part * 2.0 + (1.0 - part) * before;
        assert!(
            (of(wanted).0 - expected).abs() < 0.04 * part.min(1.0 - part),
            "{periods}"
        );
        let samples = u64::from(periods);
        assert!(profile.fits(1, 1, samples) && !profile.fits(1, 1, samples + 1));
        assert!(!profile.fits(1, 2, samples) && !profile.fits(2, 1, samples));
    }
}

#[test]
fn a_wave_keeps_the_grains_that_travel_with_it_and_passes_those_at_rest() {
    for heading in [1.0, -1.0] {
        // c = 1: two grains go with the wave just ahead of its rear throat, at z = 2.5 along the wave; one rests there,
        // about to be left behind by the wave before and overtaken by this one.
        let places =
            [(3.0, 2.0), (4.0, -2.0), (2.4, 0.0)].map(|(z, x)| DVec3::new(x, 0.0, heading * z));
        let mut bodies = Bodies::grains_at_rest(places.to_vec(), vec![1.0; 3]);
        bodies.velocity[..2].fill(DVec3::new(0.0, 0.0, heading));
        let mut simulation = Simulation::new(bodies, wall(heading, 0.5), parameters());
        let mut observer = Observer::new(&simulation);
        let mut waves = WaveByWave::new(&simulation, 20);
        for _ in 0..59 {
            simulation.advance(10).unwrap();
            let view = View::of(&simulation);
            let before = observer.end_interval(&view);
            waves.add(&before, &observer, &view);
        }
        // The third period is not whole.
        let flows = waves.flows();
        assert_eq!(flows.len(), 4);
        // (period, wave, grains, sum of dz/dt).
        let expected = [
            (1.0, 0, 2.0, 2.0),
            (1.0, 1, 1.0, 0.0),
            (2.0, 0, 3.0, 2.0),
            (2.0, 1, 0.0, 0.0),
        ];
        for (flow, (period, wave, grains, sum)) in flows.iter().zip(expected) {
            assert_eq!((flow.wave, flow.grains), (wave, grains), "{flow:?}");
            assert!(
                (flow.period - period).abs() < 1e-12 && (flow.time - 10.0 * period).abs() < 1e-9
            );
            assert!((flow.flow_rate - sum / 10.0).abs() < 1e-12, "{flow:?}");
            if grains > 0.0 {
                assert!(
                    (flow.flow_rate_ratio - sum / grains).abs() < 1e-12,
                    "{flow:?}"
                );
            } else {
                assert!(flow.flow_rate_ratio.is_nan());
            }
        }
    }
}

/// Two grains press on a straight wall from within, at rest: what the profile says of the wall is what is done to them.
#[test]
fn what_the_wall_does_is_what_the_grains_feel() {
    for heading in [1.0, -1.0] {
        let places = [DVec3::new(5.4, 0.0, 3.2), DVec3::new(0.0, -5.4, 13.2)];
        let bodies = Bodies::grains_at_rest(places.to_vec(), vec![1.0; 2]);
        let simulation = Simulation::new(bodies, wall(heading, 0.0), parameters());
        let bodies = simulation.bodies();
        let mut axial = 0.0;
        let mut outward = 0.0;
        for (place, force) in bodies.position.iter().zip(&bodies.acceleration) {
            axial += heading * force.z;
            let from_axis = DVec3::new(place.x, place.y, 0.0).normalize();
            outward -= force.dot(from_axis);
        }
        assert!(axial.abs() > 1e-3 && outward > 0.1, "{axial} {outward}");
        let mut profile = WaveFrameProfile::new(10, 1);
        profile.add(&View::of(&simulation));
        profile.add_wall_forces(&simulation);
        let force = profile.late_part(1.0, WavePart::Whole);
        assert!(
            (force.normal_force.0 - 0.5 * axial).abs() < 1e-9,
            "{force:?} {axial}"
        );
        assert_eq!(force.tangential_force.0, 0.0);
        let bins = profile.late(1.0, 10.0);
        // R = 6 everywhere: a bin has the area 2 pi 6 in each of the two waves.
        let pressure: f64 = bins.iter().map(|bin| bin.wall_pressure.0).sum();
        let expected = 0.5 * outward / (core::f64::consts::TAU * 6.0);
        // The contacts' radial directions are a little apart from those of the centres.
        assert!(
            (pressure / expected - 1.0).abs() < 0.02,
            "{pressure} {expected}"
        );
        let shear: f64 = bins.iter().map(|bin| bin.wall_shear.0).sum();
        assert!((shear + 0.5 * axial / (core::f64::consts::TAU * 6.0)).abs() < 1e-9);
    }
}

/// One grain presses where the wave closes the narrow half of the tube, one where it opens the wide half.
#[test]
fn the_parts_of_a_wave_have_their_own_forces() {
    for heading in [1.0, -1.0] {
        // R = 6 - sin(2 pi position)/2 in the wave frame.
        let place = |position: f64| (heading * 10.0 * position).rem_euclid(20.0);
        let bodies = Bodies::grains_at_rest(
            vec![
                DVec3::new(4.9, 0.0, place(0.33)),
                DVec3::new(0.0, -5.7, place(0.92)),
            ],
            vec![1.0; 2],
        );
        let simulation = Simulation::new(bodies, wall(heading, 0.5), parameters());
        let axial = |grain: usize| 0.5 * heading * simulation.bodies().acceleration[grain].z;
        assert!(axial(0).abs() > 1e-3 && axial(1).abs() > 1e-3);
        let mut profile = WaveFrameProfile::new(50, 1);
        profile.add(&View::of(&simulation));
        profile.add_wall_forces(&simulation);
        for part in [WavePart::Narrow, WavePart::Front] {
            let found = profile.late_part(1.0, part);
            assert!((found.normal_force.0 - axial(0)).abs() < 1e-9, "{found:?}");
            assert_eq!(found.tangential_force.0, 0.0);
            // A prescribed wall moves in and out only.
            assert_eq!(found.wall_velocity.0, 0.0);
        }
        let all = profile.late_part(1.0, WavePart::Whole).normal_force.0;
        assert!((all - axial(0) - axial(1)).abs() < 1e-9);
    }
}

/// Free grains that drift apart ballistically, so many periods of so many steps long: the variance since an origin a time
/// s ago is 0.0675 s^2.
fn ballistic_dispersion(periods: u32, steps: u64) -> AxialDispersion {
    // Side by side, so that they never meet.
    let places = [-3.0, -1.0, 1.0, 3.0].map(|x| DVec3::new(x, 0.0, 3.0));
    let mut bodies = Bodies::grains_at_rest(places.to_vec(), vec![1.0; 4]);
    bodies.velocity[..3].fill(DVec3::new(0.0, 0.0, 0.5));
    bodies.velocity[3].z = -0.1;
    let mut simulation = Simulation::new(bodies, wall(1.0, 0.5), parameters());
    let mut observer = Observer::new(&simulation);
    let mut dispersion = AxialDispersion::new(&observer);
    for _ in 0..periods {
        simulation.advance(steps).expect("free grains");
        let view = View::of(&simulation);
        observer.end_interval(&view);
        dispersion.end_period(&observer, &view);
    }
    dispersion
}

#[test]
fn dispersion_of_a_long_run_is_seen_at_every_other_period() {
    let found = ballistic_dispersion(70_000, 1).rates_from(0.0);
    assert_eq!(found.len(), 70_000 / 2 - 1);
    // The middle of an interval of two, of periods of 0.05 t.
    for (place, found) in found.iter().enumerate() {
        let expected = 0.0675 * 0.05 * (2.0 * place as f64 + 3.0);
        assert!((found / expected - 1.0).abs() < 1e-4, "{place}: {found}");
    }
}

#[test]
fn dispersion_counts_from_an_origin_of_the_late_part() {
    // More periods, of a time unit each, than origins are kept.
    let dispersion = ballistic_dispersion(100, 20);
    let ballistic = |origin: f64, from: f64| -> Vec<f64> {
        (from as u32..100)
            .map(|period| 0.5 * 0.0675 * (2.0 * (f64::from(period) - origin) + 1.0))
            .collect()
    };
    let close = |start: f64, expected: Vec<f64>| {
        let found = dispersion.rates_from(start);
        assert_eq!(found.len(), expected.len(), "{start}");
        for (found, expected) in found.iter().zip(expected) {
            assert!(
                (found - expected).abs() < 1e-9,
                "{start}: {found} {expected}"
            );
        }
    };
    // Origins are 8 periods apart by now; the first period after each is left out.
    close(0.0, ballistic(0.0, 1.0));
    close(75.0, ballistic(80.0, 81.0));
    close(80.0, ballistic(80.0, 81.0));
    // None has two periods behind it from here on: since the last before.
    close(97.0, ballistic(96.0, 97.0));
    assert!(dispersion.rates_from(1e9).is_empty());
}

#[test]
fn displacements_count_from_the_start() {
    for heading in [1.0, -1.0] {
        let mut simulation = free_flight(heading);
        let mut observer = Observer::new(&simulation);
        let mut sample = sampled(&mut observer, &simulation);
        for _ in 0..3 {
            simulation.advance(40).unwrap();
            sample = sampled(&mut observer, &simulation);
        }
        // v_z = 0.5, 0.5, 0.5, -0.1: mean 0.35, variance 0.0675, for 6 t and through the seam.
        assert!((sample.axial_displacement - heading * 0.35 * 6.0).abs() < 1e-12);
        assert!((sample.axial_displacement_variance - 0.0675 * 36.0).abs() < 1e-12);
    }
}

#[test]
fn the_shape_of_a_prescribed_tube_is_its_wave() {
    let simulation = free_flight(-1.0);
    let shape = TubeShape::of(&simulation);
    assert!((shape.narrowest() - 5.5).abs() < 1e-12);
    assert!((shape.radius(2.5) - 6.5).abs() < 1e-12);
}

/// Every ring has the same weight in the volume, 14 of them in a wave.
#[test]
fn the_clear_volume_of_an_elastic_wall_is_that_of_its_rings() {
    let elastic = elastic_wall(LATTICE, 6.0);
    let radius = |ring: u32| 5.5 + 0.1 * f64::from(ring % 14);
    let mut bodies = Bodies::grains_at_rest(Vec::new(), Vec::new());
    for sphere in 0..elastic.lattice().spheres() {
        let place = elastic.reference(sphere);
        // In the middle of its slice.
        let ring = (place.z / 20.0 * 28.0 + 0.5) as u32;
        let wider = radius(ring) / 6.0;
        let along = (f64::from(ring) + 0.5) * 20.0 / 28.0;
        let moved = DVec3::new(wider * place.x, wider * place.y, along);
        bodies.push_wall_sphere(moved, 1.0, 0.1);
    }
    let simulation = Simulation::new(bodies, Wall::Elastic(elastic), parameters());
    let areas = (0..14).map(|ring| core::f64::consts::PI * (radius(ring) - 0.5).powi(2));
    let expected = areas.sum::<f64>() * 20.0 / 14.0;
    let found = clear_volume(&simulation);
    assert!((found / expected - 1.0).abs() < 1e-12, "{found} {expected}");
}

#[test]
fn faults_of_an_elastic_wall_are_noted_once_with_place_and_cause() {
    let lattice = Lattice {
        spheres_per_ring: 22,
        rings_per_wave: 24,
        wavelength: 20.0,
        ..LATTICE
    };
    let elastic = elastic_wall(lattice, 3.5);
    let simulation = |changed: Option<(usize, DVec3)>| {
        let mut bodies = Bodies::grains_at_rest(Vec::new(), Vec::new());
        for sphere in 0..elastic.lattice().spheres() {
            bodies.push_wall_sphere(elastic.reference(sphere), 1.0, 0.1);
        }
        if let Some((sphere, place)) = changed {
            bodies.position[sphere] = place;
        }
        Simulation::new(bodies, Wall::Elastic(elastic.clone()), parameters())
    };
    let mut faults = Vec::new();
    note_wall_faults(&simulation(None), &mut faults);
    assert!(faults.is_empty(), "{faults:?}");

    let middle = 22 * 10;
    let place = elastic.reference(middle);
    for (moved, kind, word) in [
        (
            place + DVec3::new(0.0, 0.0, 1.2),
            FaultKind::Buckled,
            "natural_length",
        ),
        (
            DVec3::new(0.1, 0.0, place.z),
            FaultKind::Collapsed,
            "balance",
        ),
        (
            DVec3::new(9.0, 0.0, place.z),
            FaultKind::BlownUp,
            "force_amplitude",
        ),
    ] {
        let mut faults = Vec::new();
        let simulation = simulation(Some((middle, moved)));
        note_wall_faults(&simulation, &mut faults);
        note_wall_faults(&simulation, &mut faults);
        assert_eq!(faults.len(), 1, "{faults:?}");
        assert_eq!((faults[0].kind, faults[0].sphere), (kind, middle as u64));
        let words = faults[0].in_words();
        assert!(
            words.contains(word) && words.contains("wall sphere 220"),
            "{words}"
        );
    }
}

#[test]
fn columns_have_distinct_names_and_all_are_explained() {
    let series = COLUMNS.iter().map(|column| heading(&column.quantity));
    let profile = PROFILE.iter().map(heading);
    let waves = WAVES.iter().map(heading);
    for table in [
        series.collect::<Vec<_>>(),
        profile.collect(),
        waves.collect(),
    ] {
        for (index, (name, unit, text)) in table.iter().enumerate() {
            assert!(!unit.is_empty() && text.len() > 3, "{name}");
            assert!(
                table[..index].iter().all(|other| other.0 != *name),
                "{name}"
            );
        }
    }
    for name in ["time", "period", "flow_rate_ratio", "escaped"] {
        let of_all = |column: &&Column| column.scope == Scope::Always;
        let mut always = COLUMNS.iter().filter(of_all);
        assert!(always.any(|column| column.quantity.name == name), "{name}");
    }
}

fn heading<Of>(quantity: &Quantity<Of>) -> (&'static str, &'static str, &'static str) {
    (quantity.name, quantity.unit, quantity.text)
}

/// Pairs of grains at rest that overlap by xi push with k xi, k = 1.
#[test]
fn forces_at_contacts_are_the_largest_and_what_99_per_cent_stay_below() {
    let pair = |number: u32| {
        let place = DVec3::new(-3.0, 0.0, 0.6 + 3.0 * f64::from(number));
        let overlap = 0.01 * f64::from(number + 1);
        [place, place + DVec3::new(1.0 - overlap, 0.0, 0.0)]
    };
    let places: Vec<DVec3> = (0..6).flat_map(pair).collect();
    let diameters = vec![1.0; places.len()];
    let bodies = Bodies::grains_at_rest(places, diameters);
    let mut simulation = Simulation::new(bodies, wall(1.0, 0.5), parameters());
    let found = ContactForce::of(&simulation);
    // Of six contacts the sixth is the first that 99 % do not exceed.
    assert!((found.largest - 0.06).abs() < 1e-12 && found.high == found.largest);

    let mut forces = ContactForces::default();
    assert!(forces.late(0.0).is_empty());
    // Periods of 500 steps: every fourth is looked at.
    for _ in 0..9 {
        simulation.advance(500).expect("soft pairs");
        forces.look(&simulation, 2000);
    }
    let times: Vec<f64> = forces.late(0.0).iter().map(|look| look.time).collect();
    assert_eq!(times.len(), 3);
    assert!((times[0] - 25.0).abs() < 1e-9 && (times[2] - 225.0).abs() < 1e-9);
    assert_eq!(forces.late(100.0).len(), 2);
    assert!(forces.late(1e9).is_empty());
    // The pairs have flown apart.
    let none = ContactForce {
        time: times[2],
        largest: 0.0,
        high: 0.0,
    };
    assert_eq!(forces.late(200.0), [none]);
}

#[test]
fn a_hundred_and_one_contacts_leave_one_above() {
    let pair = |number: u32| {
        let (ring, place) = (number % 20, number / 20);
        let angle = core::f64::consts::TAU / 20.0 * f64::from(ring);
        let centre = DVec3::new(
            4.0 * angle.cos(),
            4.0 * angle.sin(),
            0.5 + 3.0 * f64::from(place),
        );
        let overlap = if number == 7 {
            0.2
        } else {
            0.0005 * f64::from(number + 1)
        };
        let along = DVec3::new(0.0, 0.0, 1.0 - overlap);
        [centre, centre + along]
    };
    let places: Vec<DVec3> = (0..101).flat_map(pair).collect();
    let diameters = vec![1.0; places.len()];
    let bodies = Bodies::grains_at_rest(places, diameters);
    let simulation = Simulation::new(bodies, wall(1.0, 0.0), parameters());
    let found = ContactForce::of(&simulation);
    assert!((found.largest - 0.2).abs() < 1e-12, "{found:?}");
    assert!((found.high - 0.0505).abs() < 1e-12, "{found:?}");
}

/// 40 grains that do not meet, in a straight tube of length 20, the even ones with another velocity than the odd ones.
fn two_streams(even: f64, odd: f64) -> Sample {
    let grain = |number: u32| {
        let number = f64::from(number);
        DVec3::new(0.0, 0.2 * number - 4.0, 0.25 + 0.5 * number)
    };
    let mut bodies = Bodies::grains_at_rest((0..40).map(grain).collect(), vec![0.1; 40]);
    for (number, velocity) in bodies.velocity.iter_mut().enumerate() {
        velocity.z = if number % 2 == 0 { even } else { odd };
    }
    let mut simulation = Simulation::new(bodies, wall(1.0, 0.0), parameters());
    let mut observer = Observer::new(&simulation);
    simulation.advance(400).expect("free flight");
    let view = View::of(&simulation);
    let before = observer.end_interval(&view);
    observer.end_period(&view);
    Sample::of(&before, &observer, &view)
}

/// Grains that all move by L/4 stay apart; where every other one has moved by L/2 more, half of each kind has changed sides and
/// each of the four cells of 10 has as many of one as of the other: M = (N - 1)/(N - C).
#[test]
fn grains_that_move_alike_do_not_mix_and_streams_that_pass_each_other_do() {
    for (even, odd, expected) in [(0.25, 0.25, 0.0), (0.5, 0.0, 39.0 / 36.0)] {
        let found = two_streams(even, odd).mixing;
        let found = found.expect("40 grains have an index");
        assert!((found.axial - expected).abs() < 1e-12, "{found:?}");
        // None moved across the tube.
        assert!(found.radial.abs() < 1e-12, "{found:?}");
    }
}

/// Large grains outside and below, where the tube is wide.
#[test]
fn sizes_that_lie_apart_are_segregated() {
    let large = |z: f64| DVec3::new(0.0, -4.0, z);
    let small = |z: f64| DVec3::new(0.0, 1.0, z);
    // sin(2 pi z/10) is 1 at z = 2.5 and -1 at 7.5.
    let places = vec![large(2.5), large(12.5), small(7.5), small(17.5)];
    let bodies = Bodies::grains_at_rest(places, vec![1.0, 1.0, 0.5, 0.5]);
    for gravity in [DVec3::ZERO, DVec3::new(0.0, -0.001, 0.0)] {
        let parameters = Parameters {
            body_force: gravity,
            ..parameters()
        };
        let simulation = Simulation::new(bodies.clone(), wall(-1.0, 0.5), parameters);
        let found = sample_after(simulation, 0).segregation;
        let is = |found: Option<f64>, expected: f64| (found.unwrap() - expected).abs() < 1e-12;
        assert!(is(found.radial, 1.0), "{found:?}");
        assert!(is(found.belly, 1.0), "{found:?}");
        match gravity == DVec3::ZERO {
            true => assert_eq!(found.height, None),
            false => assert!(is(found.height, -1.0), "{found:?}"),
        }
    }
}
