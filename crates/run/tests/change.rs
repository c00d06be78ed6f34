//! Drives that change while a run is under way.

use peristalsis_configuration::{Configuration, ScheduledParameter, Sources};
use peristalsis_run::Run;

fn begin(preset: &str, overrides: &[&str]) -> Run {
    let overrides: Vec<String> = overrides.iter().map(|&text| text.to_owned()).collect();
    let configuration = Configuration::from_sources(&Sources {
        file: None,
        preset: Some(preset),
        overrides: &overrides,
    });
    let configuration = configuration.expect("a preset with known keys");
    Run::new(configuration).expect("a tube that holds its grains")
}

fn advance(run: &mut Run, samples: usize) {
    for _ in 0..samples {
        run.advance().expect("a step that is short enough");
    }
}

const NARROW: [&str; 2] = ["tube.waves=2", "drive.width=2.7"];

#[test]
fn a_changed_run_is_the_run_that_was_planned_so_and_its_ledger_stays_right() {
    for (preset, parameter, values, overrides) in [
        (
            "frictionless",
            ScheduledParameter::Width,
            [2.8, 2.6],
            &NARROW[..],
        ),
        (
            "frictionless",
            ScheduledParameter::StrainRate,
            [0.07, 0.04],
            &NARROW[..],
        ),
        (
            "frictional",
            ScheduledParameter::ForceAmplitude,
            [0.005, 0.003],
            &["tube.waves=2", "grains.number=100"][..],
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
    let (mut touched, mut left) = (
        begin("frictionless", &NARROW),
        begin("frictionless", &NARROW),
    );
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
    let mut run = begin("frictionless", &NARROW);
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
