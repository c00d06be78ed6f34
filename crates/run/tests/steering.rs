//! A run that is driven by hand is the run of the configuration that it leaves.

mod common;

use common::{configuration, finish};
use peristalsis_configuration::ScheduledParameter;
use peristalsis_observe::Sample;
use peristalsis_run::{Configuration, Run, RunError, RunFolder, Status, Summary};

fn read_back(text: &str) -> Configuration {
    Configuration::from_toml("config.toml", text).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

fn begin(preset: &str, settings: &str) -> Run {
    Run::new(configuration(preset, settings)).expect("a tube that holds its grains")
}

fn advance(run: &mut Run, samples: usize) {
    for _ in 0..samples {
        run.advance().expect("does not diverge");
    }
}

#[test]
fn the_course_that_was_driven_can_be_run_from_the_start() {
    let settings = "tube.waves=2 drive.width=2.6 run.periods=20";
    let mut driven = Run::new(configuration("frictionless", settings)).unwrap();
    advance(&mut driven, 13);
    driven
        .drive_to(ScheduledParameter::Width, 2.9, 0.5)
        .unwrap();
    assert!(!driven.is_at_rest(ScheduledParameter::Width));
    let under_way = driven.drive_to(ScheduledParameter::Width, 2.8, 0.5);
    assert!(matches!(under_way, Err(RunError::Steering { .. })));
    advance(&mut driven, 5);
    driven
        .drive_to(ScheduledParameter::StrainRate, 0.08, 0.25)
        .unwrap();
    advance(&mut driven, 20);
    assert_eq!(driven.driven(ScheduledParameter::Width), Some(2.9));
    assert_eq!(driven.driven(ScheduledParameter::StrainRate), Some(0.08));
    driven
        .drive_to(ScheduledParameter::Width, 2.7, 0.5)
        .unwrap();
    advance(&mut driven, 30);

    let written = read_back(&driven.configuration().to_toml());
    assert_eq!(&written, driven.configuration());
    let mut again = Run::new(written).unwrap();
    advance(&mut again, 13 + 5 + 20 + 30);
    assert_eq!(
        driven.simulation().snapshot(),
        again.simulation().snapshot()
    );
    assert_eq!(driven.recorder().samples(), again.recorder().samples());
    let ratio = driven.simulation().wall().cycles();
    assert!(ratio > 3.5, "the wave went faster: {ratio}");
}

#[test]
fn a_steered_run_goes_on_from_its_checkpoint_to_the_same_bits() {
    let settings = "tube.waves=2 run.periods=3";
    let mut run = Run::new(configuration("frictional", settings)).unwrap();
    advance(&mut run, 4);
    run.drive_to(ScheduledParameter::ForceAmplitude, 0.006, 0.1)
        .unwrap();
    run.set_friction(0.1).unwrap();
    let friction = run.configuration().contact.friction.unwrap();
    assert!((friction.static_friction - 0.125).abs() < 1e-15);
    advance(&mut run, 1);

    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("saved");
    let saved = RunFolder::create(&path, run.configuration()).unwrap();
    saved.save_state(&run).unwrap();
    let (_, mut resumed) = RunFolder::open(&path).unwrap();
    advance(&mut run, 3);
    advance(&mut resumed, 3);
    assert_eq!(run.simulation().snapshot(), resumed.simulation().snapshot());
    assert!(run.simulation().energy_residual() < 1e-2);
}

#[test]
fn what_cannot_be_driven_is_refused() {
    let mut run = Run::new(configuration("frictionless", "tube.waves=2")).unwrap();
    let before = run.configuration().clone();
    for (parameter, value) in [
        (ScheduledParameter::Width, -0.1),
        (ScheduledParameter::Width, 3.1),
        (ScheduledParameter::Width, f64::NAN),
        (ScheduledParameter::StrainRate, f64::INFINITY),
        (ScheduledParameter::ForceAmplitude, 0.004),
    ] {
        assert!(
            run.drive_to(parameter, value, 0.5).is_err(),
            "{parameter:?} {value}"
        );
    }
    assert!(run.drive_to(ScheduledParameter::Width, 2.8, -0.5).is_err());
    assert!(run.set_friction(0.3).is_err());
    assert_eq!(run.configuration(), &before);
}

const NARROW: &str = "tube.waves=2 drive.width=2.7";

#[test]
fn a_changed_run_is_the_run_that_was_planned_so_and_its_ledger_stays_right() {
    for (preset, parameter, values, overrides) in [
        (
            "frictionless",
            ScheduledParameter::Width,
            [2.8, 2.6],
            NARROW,
        ),
        (
            "frictionless",
            ScheduledParameter::StrainRate,
            [0.07, 0.04],
            NARROW,
        ),
        (
            "frictional",
            ScheduledParameter::ForceAmplitude,
            [0.005, 0.003],
            "tube.waves=2 grains.number=100",
        ),
    ] {
        let mut changed = begin(preset, overrides);
        for value in values {
            advance(&mut changed, 7);
            changed.drive_to(parameter, value, 0.0).unwrap();
        }
        advance(&mut changed, 7);
        let mut planned = Run::new(changed.configuration().clone()).unwrap();
        advance(&mut planned, 21);
        assert_eq!(
            changed.simulation().snapshot().bodies,
            planned.simulation().snapshot().bodies,
            "{parameter:?}"
        );
        assert_eq!(changed.recorder(), planned.recorder(), "{parameter:?}");
        let residual = changed.simulation().energy_residual();
        assert!(residual < 0.02, "{parameter:?}: {residual}");
        let mut unchanged = begin(preset, overrides);
        advance(&mut unchanged, 21);
        assert_ne!(
            changed.simulation().snapshot().bodies,
            unchanged.simulation().snapshot().bodies
        );
    }
}

#[test]
fn the_value_that_there_is_changes_no_bit() {
    let (mut touched, mut left) = (begin("frictionless", NARROW), begin("frictionless", NARROW));
    for run in [&mut touched, &mut left] {
        advance(run, 5);
    }
    touched
        .drive_to(ScheduledParameter::Width, 2.7, 0.0)
        .unwrap();
    assert_eq!(touched.configuration(), left.configuration());
    for run in [&mut touched, &mut left] {
        advance(run, 5);
    }
    assert_eq!(
        touched.simulation().snapshot(),
        left.simulation().snapshot()
    );
}

#[test]
fn a_snapshot_goes_on_with_the_same_bits_after_a_change() {
    let mut run = begin("frictionless", NARROW);
    advance(&mut run, 5);
    run.drive_to(ScheduledParameter::Width, 2.8, 0.0).unwrap();
    let bytes = run.to_snapshot().unwrap();
    let mut other = Run::from_snapshot(&bytes).unwrap();
    for run in [&mut run, &mut other] {
        advance(run, 5);
    }
    assert_eq!(run.simulation().snapshot(), other.simulation().snapshot());
    assert_eq!(run.recorder(), other.recorder());
    let damaged = &bytes[..bytes.len() - 1];
    assert!(Run::from_snapshot(damaged).is_err());
}

/// A period shorter than a step would advance by no steps, without a word.
#[test]
fn a_wave_whose_period_is_shorter_than_a_step_is_refused_and_a_few_steps_are_warned_of() {
    let configuration = configuration("frictionless", "grains.number=5 tube.waves=2");
    let mut run = Run::new(configuration).unwrap();
    let refused = run.drive_to(ScheduledParameter::StrainRate, 50.0, 0.0);
    let said = refused.unwrap_err().to_string();
    assert!(
        said.contains("shorter than a step") && said.contains("run.time_step"),
        "{said}"
    );
    run.drive_to(ScheduledParameter::StrainRate, 2.0, 0.0)
        .unwrap();
    let is_warned = |run: &Run| run.warnings().iter().any(|it| it.key == "run.time_step");
    assert!(is_warned(&run));
    // Its own course is no schedule that the run must reach the end of.
    run.drive_to(ScheduledParameter::Width, 2.5, 100.0).unwrap();
    assert!(run.warnings().iter().all(|it| it.key != "drive.schedule"));
}

/// A period in which the wave stands still has no J/Jmax. A transition that was found before stays; else the search goes on.
#[test]
fn a_pause_does_not_end_the_search_for_a_transition() {
    let found = |pause: [f64; 2]| {
        let [stop, go] = pause;
        let words = format!(
            "tube.waves=2 grains.number=40 drive.width=2.4 run.periods=8 observe.transition_threshold=0.1 \
             drive.schedule={{form='steps',parameter='strain_rate',at=[{stop},{go}],values=[0,0.05]}}"
        );
        finish(Run::new(configuration("frictionless", &words)).unwrap())
    };
    let run = found([5.0, 6.0]);
    assert!(run.recorder().averages()[5].is_nan());
    assert!(run.recorder().transition_time().unwrap() < 20.0);
    let later = found([0.0, 2.0]).recorder().transition_time().unwrap();
    assert!((40.0..60.0).contains(&later), "{later}");
}

/// Jammed grains begin with the wave, also where its schedule begins at another speed.
#[test]
fn jammed_grains_begin_at_the_speed_of_the_wave() {
    let words = "initial.state=jammed tube.waves=2 grains.number=40 run.periods=1 \
                 drive.schedule={form='ramp',parameter='strain_rate',from=0.01,to=0.05,end=2}";
    let configuration = configuration("frictionless", words);
    assert_eq!(configuration.initial.axial_velocity, 0.1);
    for own in [0.1, 0.5] {
        let mut given = configuration.clone();
        given.initial.axial_velocity = own;
        assert_eq!(read_back(&given.to_toml()), given);
    }
    let run = finish(Run::new(configuration).unwrap());
    let first = &run.recorder().samples()[0];
    assert!(
        (0.5..1.5).contains(&first.flow_rate_ratio),
        "{}",
        first.flow_rate_ratio
    );
}

/// A wave that stops and goes on: it runs while it may, and J/Jmax counts what flowed in the pauses.
#[test]
fn a_drive_pauses_and_goes_on() {
    let steps = "drive.schedule={form=\"steps\",parameter=\"strain_rate\",at=[1,2,3],values=[0.0,RATE,0.0]}";
    for (preset, settings, rate) in [
        ("frictionless", "tube.waves=2", "0.05"),
        (
            "frictionless",
            "tube.waves=2 tube.arrangement=smooth wall.sphere_diameter=0",
            "0.05",
        ),
        (
            "frictionless",
            "tube.waves=2 drive.waveform=segments",
            "0.05",
        ),
        (
            "frictionless",
            "tube.waves=2 tube.ends=open inlet.feed_rate=0 grains.number=1",
            "0.05",
        ),
        ("frictional", "tube.waves=2", "0.001"),
    ] {
        let schedule = steps.replace("RATE", rate);
        let words = format!("{settings} {schedule} drive.strain_rate={rate} run.periods=4");
        let mut configuration = configuration(preset, &words);
        configuration.observe.late_fraction = 1.0;
        let run = finish(Run::new(configuration).unwrap());
        let samples = run.recorder().samples();
        let period = run.configuration().drive.period().unwrap();
        let since = |periods: f64| move |it: &&Sample| it.time > (periods - 1e-6) * period;
        for (periods, cycles) in [(1.0, 1.0), (2.0, 1.0), (3.0, 2.0), (4.0, 2.0)] {
            let sample = samples.iter().find(since(periods)).unwrap();
            assert!(
                (sample.period - cycles).abs() < 1e-9,
                "{words}: {}",
                sample.period
            );
        }
        // The wall does no work while it stands.
        let stands: Vec<&Sample> = samples
            .iter()
            .filter(since(1.1))
            .filter(|it| it.time < 1.99 * period)
            .collect();
        assert!(
            stands.len() > 10 && stands.iter().all(|it| it.flow_rate_ratio.is_nan()),
            "{words}"
        );
        let is_prescribed = preset == "frictionless";
        assert!(
            !is_prescribed || stands.iter().all(|it| it.wall_power == 0.0),
            "{words}"
        );
        let summary = Summary::of(&run, Status::Complete, None);
        let moved = samples.last().unwrap().axial_displacement;
        // Two wavelengths run, and nobody left the tube.
        let expected = moved / (2.0 * run.configuration().tube.wavelength);
        let (ratio, error) = summary.flow_rate_ratio;
        assert!(
            (ratio - expected).abs() < 1e-9,
            "{words}: {ratio} {expected}"
        );
        assert!(error.is_finite(), "{words}");
    }
}
