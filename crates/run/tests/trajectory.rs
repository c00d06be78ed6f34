//! Trajectories of runs: they show the simulation as it is, change nothing of it, and go on after a kill as if there had
//! been none.

#![allow(clippy::unwrap_used, reason = "what is missing fails the test")]

mod common;

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use peristalsis_run::{
    Configuration, Run, RunError, RunFolder, Span, Trajectory, TrajectoryFormat, TrajectoryPlan,
    TrajectoryRequest, Window, estimate, timeseries_table,
};

const STRAIN: &str = "grains.number=30 tube.waves=2 run.periods=1 drive.width=2.3";
const STRESS: &str = "grains.number=200 run.periods=0.2 initial.state=jammed";
const MODELS: [(&str, &str); 2] = [("frictionless", STRAIN), ("frictional", STRESS)];

fn request(every: &str, window: &str) -> TrajectoryRequest {
    TrajectoryRequest {
        formats: TrajectoryFormat::ALL.to_vec(),
        every: Some(every.parse().unwrap()),
        window: window.parse().unwrap(),
    }
}

fn plan(request: &TrajectoryRequest, configuration: &Configuration) -> TrajectoryPlan {
    TrajectoryPlan::new(request, configuration, 0, configuration.run.steps()).unwrap()
}

/// Goes on to the end, or until so many samples are taken.
fn go_on(run: &mut Run, trajectory: &mut Trajectory, samples: usize) {
    while !run.is_complete() && run.recorder().samples().len() < samples {
        let most = trajectory.steps_to_next(run).unwrap_or(u64::MAX);
        run.advance_at_most(most).unwrap();
        trajectory.observe(run).unwrap();
    }
}

/// Every file of a trajectory with its bytes.
fn contents(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut found = BTreeMap::new();
    for part in [folder.to_owned(), folder.join("trajectory")] {
        for entry in fs::read_dir(part).unwrap() {
            let path = entry.unwrap().path();
            let name = path
                .strip_prefix(folder)
                .unwrap()
                .to_string_lossy()
                .into_owned();
            if path.is_file() && (name.contains("trajectory") || name.contains("contacts")) {
                found.insert(name, fs::read(path).unwrap());
            }
        }
    }
    found
}

/// The frames of a LAMMPS dump: step, and the numbers of each sphere.
fn read_lammps(folder: &Path) -> Vec<(u64, Vec<Vec<f64>>)> {
    let text = fs::read_to_string(folder.join("trajectory.lammpstrj")).unwrap();
    let frames = text.split("ITEM: TIMESTEP\n").skip(1);
    frames
        .map(|frame| {
            let lines: Vec<&str> = frame.lines().collect();
            let spheres = lines[8..].iter();
            let numbers = |line: &&str| line.split(' ').map(|word| word.parse().unwrap()).collect();
            (lines[0].parse().unwrap(), spheres.map(numbers).collect())
        })
        .collect()
}

#[test]
fn the_end_of_a_run_has_a_frame_where_the_interval_is_no_whole_number_of_steps() {
    let (preset, settings) = MODELS[0];
    let configuration = common::configuration(preset, settings);
    let steps = configuration.drive.period().unwrap() / configuration.run.time_step;
    // A quarter of a step less than a whole number, and so many that rounding up would come to more than the run.
    let every = format!("{}", (10.0 - 0.25) / steps);
    let plan = plan(&request(&every, ":"), &configuration);
    assert_eq!(plan.interval(), 9);
    assert_eq!(plan.frames(), configuration.run.steps() / 9 + 1);
}

#[test]
fn frames_show_the_simulation_as_it_is_and_change_nothing_of_it() {
    for (preset, settings) in MODELS {
        let configuration = common::configuration(preset, settings);
        let place = tempfile::tempdir().unwrap();
        // Frames between samples: the run is advanced in other pieces.
        let every = "0.017";
        let plan = plan(&request(every, ":"), &configuration);
        assert_ne!(configuration.run.steps_per_sample % plan.interval(), 0);
        let mut run = Run::new(configuration.clone()).unwrap();
        let mut trajectory = Trajectory::begin(place.path(), plan.clone(), &mut run).unwrap();
        go_on(&mut run, &mut trajectory, usize::MAX);

        let plain = Run::new(configuration.clone()).unwrap();
        let frames = read_lammps(place.path());
        assert_eq!(frames.len() as u64, plan.frames());
        assert!(frames.len() > 10);
        let mut simulation = plain.simulation().clone();
        for (step, spheres) in frames {
            simulation.advance(step - simulation.step()).unwrap();
            let bodies = simulation.bodies();
            let moving = (0..bodies.number()).map(|body| bodies.sphere(body));
            let expected = moving.chain(simulation.wall().prescribed_spheres());
            for (index, (numbers, sphere)) in spheres.iter().zip(expected).enumerate() {
                let kind = 1.0 + f64::from(u8::from(index >= bodies.grains));
                assert_eq!(numbers[..3], [index as f64 + 1.0, kind, sphere.diameter]);
                let position = sphere.position.to_array();
                assert_eq!(numbers[3..6], position, "{preset} step {step}");
                assert_eq!(numbers[6..9], sphere.velocity.to_array());
                if preset == "frictional" {
                    assert_eq!(numbers[9..], bodies.angular_velocity[index].to_array());
                }
            }
            let wall_spheres = configuration.tube.wall_spheres() as usize;
            assert_eq!(spheres.len(), bodies.grains + wall_spheres);
        }

        let plain = common::finish(plain);
        assert_eq!(plain.simulation().bodies(), run.simulation().bodies());
        assert!(timeseries_table(&plain).unwrap() == timeseries_table(&run).unwrap());
    }
}

#[test]
fn killed_anywhere_and_gone_on_with_a_trajectory_is_the_same() {
    for (preset, settings) in MODELS {
        let configuration = common::configuration(preset, settings);
        let place = tempfile::tempdir().unwrap();
        let (through, stopped) = (place.path().join("through"), place.path().join("stopped"));
        let request = request("0.017", ":");
        let begin = |path: &Path| {
            let folder = RunFolder::create(path, &configuration).unwrap();
            let mut run = Run::new(configuration.clone()).unwrap();
            let plan = plan(&request, &configuration);
            let trajectory = Trajectory::begin(path, plan, &mut run).unwrap();
            (folder, run, trajectory)
        };
        let (_, mut run, mut trajectory) = begin(&through);
        go_on(&mut run, &mut trajectory, usize::MAX);

        let (folder, mut run, mut trajectory) = begin(&stopped);
        go_on(&mut run, &mut trajectory, 2);
        trajectory.synchronize().unwrap();
        folder.save_state(&run).unwrap();
        // Frames that the state knows nothing of, and then the kill.
        let frames_then = trajectory.report().frames;
        go_on(&mut run, &mut trajectory, 4);
        assert!(trajectory.report().frames > frames_then);
        drop((run, trajectory));
        let (_, mut run) = RunFolder::open(&stopped).unwrap();
        let mut trajectory = Trajectory::resume(&stopped, &mut run).unwrap().unwrap();
        assert_eq!(trajectory.report().frames, frames_then);
        go_on(&mut run, &mut trajectory, usize::MAX);
        let (one, other) = (contents(&through), contents(&stopped));
        assert!(one.len() > 20 && one.keys().eq(other.keys()));
        for (name, bytes) in one {
            assert!(bytes == other[&name], "{preset}: {name} differs");
        }
    }
}

#[test]
fn a_frame_that_did_not_fit_is_filled_in_and_other_gaps_are_refused() {
    let configuration = common::configuration("frictionless", STRAIN);
    let place = tempfile::tempdir().unwrap();
    let mut run = Run::new(configuration.clone()).unwrap();
    let plan = plan(&request("0.02", ":"), &configuration);
    let mut trajectory = Trajectory::begin(place.path(), plan.clone(), &mut run).unwrap();
    // Up to a frame between two samples, where the disk would be full for one of the files.
    for _ in 0..8 {
        run.advance_at_most(trajectory.steps_to_next(&run).unwrap())
            .unwrap();
        trajectory.observe(&run).unwrap();
    }
    drop(trajectory);
    let step = run.simulation().step();
    assert_ne!(step % configuration.run.steps_per_sample, 0);
    let whole = contents(place.path());
    drop(
        TrajectoryFormat::Gsd
            .resume(place.path(), step - 1)
            .unwrap(),
    );
    assert!(contents(place.path()) != whole);
    let trajectory = Trajectory::resume(place.path(), &mut run).unwrap();
    assert!(trajectory.is_some());
    assert!(contents(place.path()) == whole);

    drop(
        TrajectoryFormat::Lammps
            .resume(place.path(), step - 1 - plan.interval())
            .unwrap(),
    );
    let error = Trajectory::resume(place.path(), &mut run).unwrap_err();
    let message = error.to_string();
    assert!(
        message.contains("trajectory.lammpstrj") && message.contains("holds"),
        "{message}"
    );
    assert!(matches!(
        Trajectory::begin(place.path(), plan, &mut run),
        Err(RunError::HoldsAnotherRun { .. })
    ));
    let empty = tempfile::tempdir().unwrap();
    assert!(
        Trajectory::resume(empty.path(), &mut run)
            .unwrap()
            .is_none()
    );
}

#[test]
fn grains_turn_as_their_angular_velocity_says_and_no_further() {
    let configuration = common::configuration("frictional", STRESS);
    let turned = |most: u64| {
        let mut run = Run::new(configuration.clone()).unwrap();
        run.follow_orientations();
        let mut paths = vec![0.0; 200];
        while !run.is_complete() {
            let before = run.simulation().time();
            run.advance_at_most(most).unwrap();
            let bodies = run.simulation().bodies();
            let elapsed = run.simulation().time() - before;
            for (path, omega) in paths.iter_mut().zip(&bodies.angular_velocity) {
                *path += omega.length() * elapsed;
            }
        }
        (run.orientations().unwrap().quaternions().to_vec(), paths)
    };
    let ((finest, paths), (usual, _)) = (turned(1), turned(u64::MAX));
    let mut most = 0.0_f64;
    for ((one, other), path) in finest.iter().zip(&usual).zip(paths) {
        let norm: f64 = one.iter().map(|part| part * part).sum();
        assert!((norm - 1.0).abs() < 1e-12);
        let cos: f64 = one.iter().zip(other).map(|(a, b)| a * b).sum();
        assert!(cos.abs() > 1.0 - 1e-5, "{one:?} {other:?}");
        let angle = angle_of(one[0]);
        assert!(angle <= 1.02 * path + 1e-6, "{angle} {path}");
        most = most.max(angle);
    }
    assert!(most > 0.3, "{most}");

    let mut smooth = Run::new(common::configuration("frictionless", STRAIN)).unwrap();
    smooth.follow_orientations();
    assert!(smooth.orientations().is_none());
}

/// Angle of a rotation whose quaternion has this real part.
fn angle_of(real: f64) -> f64 {
    2.0 * real.abs().min(1.0).acos()
}

#[test]
fn spans_and_windows_say_what_they_mean() {
    assert_eq!("0.1".parse(), Ok(Span::Periods(0.1)));
    assert_eq!(" 2.5t".parse(), Ok(Span::Time(2.5)));
    for wrong in ["", "t", "-1", "nan", "inf", "1e400", "2 s", "1:2"] {
        assert!(
            wrong.parse::<Span>().unwrap_err().contains("2.5t"),
            "{wrong}"
        );
    }
    let window = |from, to| Window { from, to };
    assert_eq!(
        "1:2t".parse(),
        Ok(window(Some(Span::Periods(1.0)), Some(Span::Time(2.0))))
    );
    assert_eq!(":".parse(), Ok(window(None, None)));
    for wrong in ["", "3", "a:b", "1:2:3", "1:-2"] {
        assert!(wrong.parse::<Window>().is_err(), "{wrong}");
    }
}

#[test]
fn plans_take_whole_steps_within_the_run() {
    let configuration = common::configuration("frictionless", "run.periods=4");
    let per_period = configuration.run.steps() / 4;
    let frames = |every: &str, window: &str| plan(&request(every, window), &configuration).frames();
    assert_eq!(frames("0.1", ":"), 41);
    assert_eq!(frames("0.1", "1:2"), 11);
    assert_eq!(frames("0.1", "1:2000"), 31);
    assert_eq!(frames("9", ":"), 1);
    assert_eq!(frames("0.05t", ":"), configuration.run.steps() + 1);
    let default = TrajectoryRequest {
        every: None,
        ..request("1", ":")
    };
    assert_eq!(plan(&default, &configuration).frames(), 41);
    // One that begins later keeps to the same steps.
    let later = TrajectoryPlan::new(
        &request("0.1", ":"),
        &configuration,
        per_period + 1,
        4 * per_period,
    );
    assert_eq!(later.unwrap().frames(), 30);

    let refused = |every: &str, window: &str, configuration: &Configuration| {
        let request = request(every, window);
        let steps = configuration.run.steps();
        TrajectoryPlan::new(&request, configuration, 0, steps)
            .unwrap_err()
            .to_string()
    };
    assert!(refused("0", ":", &configuration).contains("step"));
    assert!(refused("1e-9", ":", &configuration).contains("step of 0.05"));
    assert!(refused("0.1", "5:6", &configuration).contains("no frame lies there"));
    assert!(refused("0.1", "3:2", &configuration).contains("window"));
    let settings = "drive.strain_rate=0 run.duration=50";
    let fixed = common::configuration("frictionless", settings);
    assert!(refused("0.1", ":", &fixed).contains("stands still"));
    assert_eq!(plan(&request("5t", ":"), &fixed).frames(), 11);
    assert_eq!(plan(&default, &fixed).frames(), 101);
}

#[test]
fn the_size_of_a_trajectory_is_estimated() {
    for (preset, settings) in MODELS {
        let configuration = common::configuration(preset, settings);
        let request = request("0.02", ":");
        let estimate = estimate(&configuration, Some(&request))
            .unwrap()
            .trajectory
            .unwrap();
        let place = tempfile::tempdir().unwrap();
        let mut run = Run::new(configuration.clone()).unwrap();
        let plan = plan(&request, &configuration);
        let mut trajectory = Trajectory::begin(place.path(), plan, &mut run).unwrap();
        go_on(&mut run, &mut trajectory, usize::MAX);
        let report = trajectory.report();
        assert_eq!(
            (report.frames, report.interval_steps),
            (estimate.frames, estimate.interval_steps)
        );
        let foretold: u64 = estimate.bytes.iter().map(|(_, bytes)| bytes).sum();
        let ratio = report.bytes as f64 / foretold as f64;
        assert!((ratio - 1.0).abs() < 0.15, "{preset}: {ratio}");
        let gsd = fs::metadata(place.path().join("trajectory.gsd"))
            .unwrap()
            .len() as f64;
        let (_, expected) = estimate.bytes[0];
        assert!(
            (gsd / expected as f64 - 1.0).abs() < 0.05,
            "{preset}: {gsd} {expected}"
        );
    }
}
