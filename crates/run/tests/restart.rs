//! Stopped anywhere and gone on with, a run gives the same bits as in one go, for every kind of model.

#![allow(clippy::unwrap_used, reason = "what is missing fails the test")]

mod common;

use common::finish;
use peristalsis_run::{
    Run, RunError, RunFolder, Status, Summary, profile_table, snapshot_table, timeseries_table,
    waves_table,
};

const STRAIN: &str = "grains.number=30 tube.waves=2 run.periods=2 drive.width=2.3";
const STRESS: &str = "grains.number=200 run.periods=0.3 initial.state=jammed";
const FRICTION: &str = "contact.static_friction=0.5 contact.kinetic_friction=0.4";
const NO_FRICTION: &str = "contact.static_friction=0 contact.kinetic_friction=0";

/// Preset and settings of one model each.
fn models() -> Vec<(&'static str, String)> {
    // The preset as it is: equal frictionless grains, in the kernel made for them; and pumped against a pressure.
    let against = "drive.body_force=-0.003 drive.waveform=roller";
    let mut models = vec![
        ("frictionless", STRAIN.to_owned()),
        ("frictionless", format!("{STRAIN} {against}")),
        ("frictional", format!("{STRESS} {against}")),
    ];
    // Through open ends, with and without friction.
    let open = "tube.ends=open inlet.waiting=4 inlet.velocity=0.1 drive.body_force=0.002";
    for friction in ["", FRICTION] {
        models.push(("frictionless", format!("{STRAIN} {open} {friction}")));
    }
    let sizes = "grains.diameter_min=0.8 grains.diameter_max=1";
    for integrator in ["run.integrator=verlet", "run.integrator=adams_bashforth"] {
        for law in ["contact.law=linear", "contact.law=hertz"] {
            for friction in [FRICTION, NO_FRICTION] {
                for (preset, base) in [("frictionless", STRAIN), ("frictional", STRESS)] {
                    let settings = format!("{base} {friction} {integrator} {law} {sizes}");
                    models.push((preset, settings));
                }
            }
        }
    }
    models
}

#[test]
fn a_state_goes_on_to_the_same_bits() {
    for (preset, settings) in models() {
        let configuration = common::configuration(preset, &settings);
        let whole = finish(Run::new(configuration.clone()).unwrap());
        let mut parts = Run::new(configuration.clone()).unwrap();
        let samples = configuration.run.samples;
        // Before the first sample, after the first, and in the middle of a period.
        for stop in [0, 1, samples / 2 + 1] {
            while parts.progress().samples < stop {
                parts.advance().unwrap();
            }
            parts = Run::from_snapshot(&parts.to_snapshot().unwrap()).unwrap();
        }
        let parts = finish(parts);
        let tables = |run: &Run| {
            [timeseries_table, profile_table, waves_table, snapshot_table]
                .map(|table| table(run).unwrap())
        };
        // Tables compare by bits, so that one NaN equals another.
        assert!(tables(&whole) == tables(&parts), "{preset} {settings}");
        assert_eq!(
            whole.simulation().bodies(),
            parts.simulation().bodies(),
            "{preset} {settings}"
        );
        assert_eq!(
            whole.recorder().dispersion(),
            parts.recorder().dispersion(),
            "{preset} {settings}"
        );
        assert_eq!(whole.simulation().ends(), parts.simulation().ends());
        assert!(whole.simulation().step() > 300);
    }
}

#[test]
fn a_folder_goes_on_to_the_same_bits() {
    let frictional = format!("{STRESS} {FRICTION}");
    for (preset, settings) in [
        ("frictional", frictional.as_str()),
        ("frictionless", STRAIN),
    ] {
        let configuration = common::configuration(preset, settings);
        let place = tempfile::tempdir().unwrap();
        let (through, stopped) = (place.path().join("through"), place.path().join("stopped"));

        let folder = RunFolder::create(&through, &configuration).unwrap();
        let run = finish(Run::new(configuration.clone()).unwrap());
        let summary = Summary::of(&run, Status::Complete, None);
        folder.finish(&run, &summary).unwrap();

        let folder = RunFolder::create(&stopped, &configuration).unwrap();
        let mut run = Run::new(configuration).unwrap();
        for _ in 0..3 {
            run.advance().unwrap();
        }
        let summary = Summary::of(&run, Status::Interrupted, None);
        folder.finish(&run, &summary).unwrap();
        drop(run);
        let (folder, run) = RunFolder::open(&stopped).unwrap();
        assert_eq!(run.progress().samples, 3);
        let run = finish(run);
        // Killed here, its results would still be those of the interruption.
        folder.save_state(&run).unwrap();
        assert!(!folder.has_final_results_of(&run));
        let summary = Summary::of(&run, Status::Complete, None);
        folder.finish(&run, &summary).unwrap();
        assert!(folder.has_final_results_of(&run));

        for name in ["timeseries.parquet", "profile.parquet", "waves.parquet"] {
            let [one, other] =
                [&through, &stopped].map(|folder| std::fs::read(folder.join(name)).unwrap());
            assert!(one == other, "{name} differs");
        }
    }
}

/// A run that is stopped after every few steps, saved, and gone on with from the file, against the same run in one go;
/// answers how often it was gone on with.
fn in_pieces(preset: &str, settings: &str, steps: u64) -> u32 {
    let configuration = common::configuration(preset, settings);
    let whole = finish(Run::new(configuration.clone()).unwrap());
    let place = tempfile::tempdir().unwrap();
    let path = place.path().join("run");
    let folder = RunFolder::create(&path, &configuration).unwrap();
    let mut run = Run::new(configuration).unwrap();
    let mut pieces = 0;
    loop {
        run.advance_at_most(steps).unwrap();
        if run.is_complete() {
            break;
        }
        folder.save_state(&run).unwrap();
        run = RunFolder::open(&path).unwrap().1;
        pieces += 1;
    }
    for table in [timeseries_table, profile_table, waves_table, snapshot_table] {
        assert!(table(&run).unwrap() == table(&whole).unwrap(), "{preset}");
    }
    pieces
}

#[test]
fn a_run_of_many_short_pieces_is_the_run_in_one_go() {
    let frictional = format!("{STRESS} {FRICTION}");
    assert!(in_pieces("frictionless", STRAIN, 7) > 50);
    assert!(in_pieces("frictional", &frictional, 17) > 50);
    // So many periods that the record merges its oldest samples.
    let long = "grains.number=5 tube.waves=1 run.periods=140 observe.samples_per_period=2";
    assert!(in_pieces("frictionless", long, 1000) > 250);
}

#[test]
#[ignore = "half a minute: two runs of more than a thousand pieces"]
fn a_run_of_a_thousand_short_pieces_is_the_run_in_one_go() {
    let strain = format!("{STRAIN} run.periods=20");
    assert!(in_pieces("frictionless", &strain, 7) > 1000);
    let frictional = format!("{STRESS} {FRICTION} run.periods=1");
    assert!(in_pieces("frictional", &frictional, 4) > 1000);
}

/// One kind of checkpoint for the command line and Python.
#[test]
fn a_snapshot_is_the_checkpoint_of_a_folder_and_goes_on_under_other_lengths_of_the_same_physics() {
    let configuration = common::configuration("frictionless", STRAIN);
    let place = tempfile::tempdir().unwrap();
    let folder = RunFolder::create(&place.path().join("run"), &configuration).unwrap();
    let mut run = Run::new(configuration).unwrap();
    run.advance().unwrap();
    folder.save_state(&run).unwrap();
    let bytes = std::fs::read(folder.path().join("state.checkpoint")).unwrap();
    assert!(bytes == run.to_snapshot().unwrap());

    let lasting = |periods: &str| {
        let settings = STRAIN.replace("run.periods=2", &format!("run.periods={periods}"));
        common::configuration("frictionless", &settings)
    };
    let longer = Run::from_snapshot(&bytes).unwrap().under(lasting("3"));
    let whole = finish(Run::new(lasting("3")).unwrap());
    let longer = finish(longer.unwrap());
    assert_eq!(longer.recorder(), whole.recorder());
    assert_eq!(
        longer.configuration().to_toml(),
        whole.configuration().to_toml()
    );
    assert_eq!(
        longer.simulation().snapshot(),
        whole.simulation().snapshot()
    );
    let refused = finish(run).under(lasting("1")).unwrap_err();
    assert!(matches!(refused, RunError::TooShort { .. }), "{refused}");
    let other = common::configuration("frictionless", &format!("{STRAIN} run.seed=9"));
    let refused = Run::from_snapshot(&bytes)
        .unwrap()
        .under(other)
        .unwrap_err();
    assert!(refused.to_string().contains("other physics"), "{refused}");
}

/// The series of a run longer than is kept is that of one that is looked at half as often, before and after a stop.
#[test]
fn a_very_long_run_keeps_a_series_of_bounded_length() {
    let tube = "tube.waves=1 tube.radius=2 tube.wavelength=10 tube.spheres_per_ring=8 tube.rings_per_wave=8";
    let settings = format!(
        "{tube} grains.number=2 drive.strain_rate=0.1 drive.width=3.6 run.periods=1400 observe.profile_bins=10"
    );
    let run = |samples: u32| {
        let settings = format!("{settings} observe.samples_per_period={samples}");
        Run::new(common::configuration("frictionless", &settings)).unwrap()
    };
    let mut long = run(200);
    let rare = finish(run(100));
    while long.progress().period < 1390.0 {
        long.advance().unwrap();
    }
    let state = long.to_snapshot().unwrap();
    let parts = finish(Run::from_snapshot(&state).unwrap());
    let long = finish(long);
    // As words, since some numbers are NaN.
    let words = |run: &Run| format!("{:?}", run.recorder());
    assert!(words(&long) == words(&parts));

    let (recorder, rarer) = (long.recorder(), rare.recorder());
    assert_eq!((recorder.taken(), recorder.intervals()), (280_000, 2));
    assert_eq!((rarer.taken(), rarer.intervals()), (140_000, 1));
    assert_eq!(recorder.samples().len(), rarer.samples().len());
    for (one, other) in recorder.samples().iter().zip(rarer.samples()) {
        assert_eq!(one.period, other.period);
        assert_eq!(one.kinetic_energy, other.kinetic_energy);
        assert!((one.flow_rate - other.flow_rate).abs() < 1e-12);
        assert!((one.wall_power - other.wall_power).abs() < 1e-12);
    }
    let summaries = [&long, &rare].map(|run| Summary::of(run, Status::Complete, None));
    assert_eq!(summaries[0].escaped_most, summaries[1].escaped_most);
    let ratios = summaries.map(|summary| summary.flow_rate_ratio.0);
    assert!((ratios[0] - ratios[1]).abs() < 1e-9, "{ratios:?}");
}
