//! Runs of grains that a caller puts where it wants them, and runs that go on past their end.

mod common;

use common::{configuration, finish};
use glam::DVec3;
use peristalsis_configuration::ScheduledParameter;
use peristalsis_observe::{Load, clear_volume, grain_contacts};
use peristalsis_physics::contact::NormalLaw;
use peristalsis_run::{PlacedGrains, Run, Status, Summary, contacts_table, warnings};

const TUBE: &str = "tube.waves=2 initial.state=placed";

fn placed(settings: &str, positions: &[DVec3]) -> Result<Run, String> {
    moving(settings, positions, &vec![DVec3::ZERO; positions.len()])
}

fn moving(settings: &str, positions: &[DVec3], velocities: &[DVec3]) -> Result<Run, String> {
    let number = positions.len();
    let words = format!("{TUBE} grains.number={number} {settings}");
    let grains = PlacedGrains {
        positions: positions.to_vec(),
        velocities: velocities.to_vec(),
        diameters: vec![1.0; number],
    };
    Run::placed(configuration("frictionless", &words), grains).map_err(|error| error.to_string())
}

#[test]
fn two_grains_by_hand() {
    let (one, tilted) = (DVec3::new(0.0, -0.2, 5.0), DVec3::new(0.0, 0.2, 5.7));
    let run = placed("", &[one, tilted]).unwrap();
    let simulation = run.simulation();
    let distance = (tilted - one).length();
    let stiffness = match run.configuration().contact.normal.elasticity() {
        peristalsis_configuration::Elasticity::Stiffness(stiffness) => stiffness,
        other => panic!("{other:?}"),
    };
    let contacts: Vec<_> = grain_contacts(simulation)
        .into_iter()
        .filter(|contact| !contact.is_with_wall)
        .collect();
    let [contact] = contacts[..] else {
        panic!("{contacts:?}")
    };
    let normal = (one - tilted) / distance;
    let force = stiffness * (1.0 - distance) * normal;
    assert!((contact.touching.force - force).length() < 1e-14);
    assert!((contact.point - 0.5 * (one + tilted)).length() < 1e-14);
    let load = Load::of(simulation);
    assert!((load.forces[0] - force).length() < 1e-14 && (load.forces[1] + force).length() < 1e-14);
    // sigma V = l f^T, at rest.
    let expected = (one - tilted).y * force.z / clear_volume(simulation);
    assert!((load.stress.row(1).z - expected).abs() < 1e-15);
    let pressure = load.stress.to_cols_array_2d();
    let trace: f64 = (0..3).map(|it| pressure[it][it]).sum();
    let by_hand = distance * force.length() / clear_volume(simulation);
    assert!((trace - by_hand).abs() < 1e-15 && trace > 0.0);
    assert_eq!(contacts_table(&run).unwrap().rows(), 1);
}

#[test]
fn grains_that_cannot_stand_so_are_refused() {
    let axis = |z: f64| DVec3::new(0.0, 0.0, z);
    for (positions, words) in [
        (vec![axis(1.0), axis(1.2)], "overlap by 0.8"),
        (
            vec![axis(1.0), axis(5.0), axis(1.0)],
            "grains 0 and 2 are at the same place",
        ),
        (
            vec![DVec3::new(2.5, 0.0, 1.0)],
            "grain 0 at [2.5, 0, 1] is outside the tube",
        ),
        (vec![axis(f64::NAN)], "not all of them possible"),
    ] {
        let refused = placed("", &positions).unwrap_err();
        assert!(refused.contains(words), "{refused}");
    }
    let refused = Run::new(configuration("frictionless", TUBE)).unwrap_err();
    assert!(
        refused.to_string().contains("go on from a checkpoint"),
        "{refused}"
    );
}

#[test]
fn placed_grains_go_on_from_a_checkpoint_with_the_same_bits() {
    let mut run = placed("", &[DVec3::new(0.0, 0.0, 5.0), DVec3::new(0.2, 0.6, 5.8)]).unwrap();
    run.advance().unwrap();
    let mut again = Run::from_snapshot(&run.to_snapshot().unwrap()).unwrap();
    for run in [&mut run, &mut again] {
        run.advance().unwrap();
    }
    assert_eq!(run.simulation().bodies(), again.simulation().bodies());
    assert!(run.configuration().to_toml().contains("state = \"placed\""));
}

/// Grains taken from jammed flow are jammed at t = 0, and those that coast as fast as they coast.
#[test]
fn the_search_for_a_transition_begins_with_the_velocities_of_the_grains() {
    let settings = "tube.waves=2 run.periods=5";
    let jammed = format!("{settings} initial.state=jammed");
    let jammed = Run::new(configuration("frictionless", &jammed)).unwrap();
    let bodies = jammed.simulation().bodies();
    let grains = 0..bodies.grains;
    let (positions, velocities) = (&bodies.position[grains.clone()], &bodies.velocity[grains]);
    let again = moving("run.periods=5", positions, velocities).unwrap();
    let coasting = format!("{settings} drive.width=3 initial.axial_velocity=0.3");
    let coasting = Run::new(configuration("frictionless", &coasting)).unwrap();
    let [jammed, again, coasting] = [jammed, again, coasting].map(finish);
    let averages = |run: &Run| run.recorder().averages().to_vec();
    assert_eq!(averages(&jammed), averages(&again));
    let times = jammed.recorder().transition_times();
    assert_eq!(times, again.recorder().transition_times());
    // They begin at 0.3/c = 0.6, and slow down to 0.56: no threshold is crossed that lies below.
    let ratios = averages(&coasting);
    assert!(ratios[0] < 0.6 && ratios[4] > 0.5, "{ratios:?}");
    assert_eq!(coasting.recorder().transition_times()[..5], [None; 5]);
}

/// One grain rests; one is shot through the wall, and past the outlet outside of it.
#[test]
fn what_has_leaked_closes_the_balance_of_an_open_tube() {
    let places = [DVec3::new(0.0, 0.0, 4.0), DVec3::new(1.0, 0.0, 12.0)];
    let shot = DVec3::new(4.0, 0.0, 2.0);
    let open = "tube.ends=open inlet.feed_rate=0 run.periods=1";
    let run = finish(moving(open, &places, &[DVec3::ZERO, shot]).unwrap());
    let (samples, mut before) = (run.recorder().samples(), 0.0);
    let through_ends = samples.iter().map(|it| {
        let interval = it.time - core::mem::replace(&mut before, it.time);
        interval * (it.feed_rate - it.return_rate - it.discharge_rate)
    });
    let through_ends: f64 = through_ends.sum();
    let summary = Summary::of(&run, Status::Complete, None);
    let leaked = summary.discharge.unwrap().leaked;
    assert_eq!(leaked, 1.0);
    assert_eq!(samples.last().unwrap().hold_up, 2.0 + through_ends - leaked);
    assert!(summary.to_json().contains("\"leaked\": 1.0"));
}

/// The way of a grain to the outlet counts, also that in the interval in which it leaves.
#[test]
fn the_flow_of_an_open_tube_does_not_depend_on_how_often_it_is_sampled() {
    let open = "tube.waves=2 tube.ends=open inlet.waiting=4 drive.body_force=0.01 run.periods=4";
    let moved = |samples: u32| {
        let settings = format!("{open} observe.samples_per_period={samples}");
        let run = finish(Run::new(configuration("frictionless", &settings)).unwrap());
        let samples = run.recorder().samples();
        assert!(samples.last().unwrap().discharged > 10.0);
        let rate = samples.iter().map(|it| it.flow_rate).sum::<f64>();
        rate / samples.len() as f64
    };
    let (rarely, often) = (moved(1), moved(20));
    assert!((rarely - often).abs() < 1e-9 * often, "{rarely} {often}");
}

/// A pump engineer: a feed that the inlet could not take was missed without a word.
#[test]
fn a_feed_that_finds_no_place_is_told() {
    for (rate, is_told) in [(50.0, true), (0.05, false)] {
        let open =
            "tube.waves=2 tube.ends=open inlet.waiting=30 drive.body_force=0.002 run.periods=4";
        let settings = format!("{open} drive.strain_rate=0.01 inlet.feed_rate={rate}");
        let run = finish(Run::new(configuration("frictionless", &settings)).unwrap());
        let told = run.warnings().iter().any(|it| it.key == "inlet.feed_rate");
        assert_eq!(told, is_told, "{rate}: {:?}", run.warnings());
    }
}

#[test]
fn mixing_and_segregation_do_not_depend_on_the_numbers_of_the_grains() {
    let settings = "tube.waves=2 run.periods=3 drive.width=2.6";
    let packed = Run::new(configuration("frictionless", settings)).unwrap();
    let bodies = packed.simulation().bodies();
    let mut places = bodies.position[..bodies.grains].to_vec();
    let radial = |places: &[DVec3]| {
        let still = vec![DVec3::ZERO; places.len()];
        let run = finish(moving(settings, places, &still).unwrap());
        let last = run.recorder().samples().last().unwrap();
        last.mixing.unwrap().radial
    };
    let ascending = radial(&places);
    places.reverse();
    assert_eq!(radial(&places), ascending);
}

#[test]
fn a_run_that_is_led_past_its_end_has_a_configuration_that_repeats_it() {
    let mut run = Run::new(configuration(
        "frictionless",
        "tube.waves=2 run.periods=2 drive.strain_rate=0.03",
    ))
    .unwrap();
    for width in [2.7, 2.8, 2.9] {
        for _ in 0..20 {
            run.advance().unwrap();
        }
        run.drive_to(ScheduledParameter::Width, width, 0.0).unwrap();
        let found = warnings(run.configuration());
        assert!(
            found.iter().all(|it| it.key != "drive.schedule"),
            "{found:?}"
        );
    }
    run.advance().unwrap();
    let told = run.configuration();
    assert_eq!(told.run.steps(), run.simulation().step());
    let text = told.to_toml();
    let read = peristalsis_run::Configuration::from_toml("told", &text).unwrap();
    assert_eq!(&read, told);
    let again = finish(Run::new(read).unwrap());
    assert_eq!(run.simulation().bodies(), again.simulation().bodies());
}

/// A numerical auditor: on a wall without spheres every grain that touched it was refused.
#[test]
fn grains_may_touch_a_smooth_wall_of_no_thickness() {
    let settings = "tube.waves=2 run.periods=2 tube.arrangement=smooth wall.sphere_diameter=0";
    let run = finish(Run::new(configuration("frictionless", settings)).unwrap());
    let bodies = run.simulation().bodies();
    let places = &bodies.position[..bodies.grains];
    let touching = run.simulation().touching();
    assert!(touching.iter().any(|it| it.second >= bodies.grains));
    let still = vec![DVec3::ZERO; places.len()];
    moving(settings, places, &still).unwrap();
}
