//! A recording that is played: frames by number, and what is no recording of its run.

use std::path::{Path, PathBuf};

use peristalsis_run::{
    Configuration, Run, Span, Trajectory, TrajectoryFormat, TrajectoryPlan, TrajectoryRequest,
    Window,
};
use peristalsis_viewer::{Recording, Viewer, ViewerError};

use crate::client::{Client, Frame, Served, configuration};

/// Two periods and their frames, four a period.
struct Recorded {
    folder: tempfile::TempDir,
    configuration: Configuration,
    run: Run,
}

impl Recorded {
    fn new(preset: &str, settings: &[&str]) -> Self {
        let configuration = configuration(preset, settings);
        let folder = tempfile::tempdir().unwrap();
        let mut run = Run::new(configuration.clone()).unwrap();
        let request = TrajectoryRequest {
            formats: vec![TrajectoryFormat::Gsd],
            every: Some(Span::Periods(0.25)),
            window: Window::default(),
        };
        let two = Span::Periods(2.0);
        let plan = TrajectoryPlan::onward(&request, &configuration, 0, two).unwrap();
        let mut frames = Trajectory::begin(folder.path(), plan, &mut run).unwrap();
        while let Some(steps) = frames.steps_to_next(&run) {
            run.advance_at_most(steps).unwrap();
            frames.observe(&run).unwrap();
        }
        frames.synchronize().unwrap();
        Self {
            folder,
            configuration,
            run,
        }
    }

    fn small() -> Self {
        Self::new("frictionless", &["tube.waves=2", "drive.width=2.6"])
    }

    fn path(&self) -> PathBuf {
        self.folder.path().join("trajectory.gsd")
    }

    fn open(&self, path: &Path) -> Result<Recording, ViewerError> {
        let samples = self.run.recorder().samples().to_vec();
        Recording::open(path, self.configuration.clone(), samples)
    }

    fn serve(self) -> Served {
        let recording = self.open(&self.path()).unwrap();
        let viewer = Viewer::play(recording, "tube".to_owned(), 0).unwrap();
        Served::serve(viewer, self.folder)
    }
}

/// Asks for a frame, which is the next to come.
fn frame(client: &mut Client, number: usize) -> Frame {
    client.send(&format!(r#"{{"type":"frame","number":{number}}}"#));
    client.frame_with(|head| head["number"] == number)
}

/// Asks for a frame that cannot be had.
fn missing(client: &mut Client, number: u64) -> String {
    client.send(&format!(r#"{{"type":"frame","number":{number}}}"#));
    let notice = client.notice();
    assert_eq!(notice["type"], "missing", "{notice}");
    assert_eq!(notice["number"], number);
    notice["message"].as_str().unwrap().to_owned()
}

#[test]
fn frames_come_in_any_order_as_they_were_computed() {
    for (preset, settings) in [
        ("frictionless", ["tube.waves=2", "drive.width=2.6"]),
        (
            "frictional",
            ["tube.waves=2", "drive.force_amplitude=0.003"],
        ),
    ] {
        let recorded = Recorded::new(preset, &settings);
        let mut run = Run::new(recorded.configuration.clone()).unwrap();
        let samples = recorded.run.recorder().samples().to_vec();
        let served = recorded.serve();
        let (mut client, welcome) = served.client();
        let clocks = welcome["recorded"]["clocks"].as_array().unwrap();
        assert_eq!(clocks.len(), 9, "{clocks:?}");
        assert!((clocks[5].as_f64().unwrap() - 1.25).abs() < 1e-3);
        assert_eq!(welcome["recorded"]["lost_frames"], 0);
        let rows = welcome["rows"].as_array().unwrap();
        assert_eq!(rows.len(), samples.len());
        let last = samples.last().unwrap();
        assert_eq!(
            rows[rows.len() - 1]["flow_rate_ratio"],
            last.flow_rate_ratio
        );
        let mut frames = [5, 0, 8, 5].map(|number| frame(&mut client, number));
        let step = |frame: &Frame| frame.head["step"].as_u64().unwrap();
        frames.sort_by_key(step);
        for frame in frames {
            while run.simulation().step() < step(&frame) {
                let ahead = step(&frame) - run.simulation().step();
                run.advance_at_most(ahead).unwrap();
            }
            let bodies = run.simulation().bodies();
            assert_eq!(frame.head["grains"], bodies.grains);
            let length = welcome["length"].as_f64().unwrap();
            let near = |sent: &[f32], vectors: &[[f64; 3]]| {
                let pairs = sent.chunks_exact(3).zip(vectors);
                assert_eq!(sent.len(), 3 * vectors.len());
                for (sent, vector) in pairs {
                    for (&sent, value) in sent.iter().zip(vector) {
                        let apart = (f64::from(sent) - value).abs();
                        assert!(apart.min(length - apart) < 1e-4, "{sent} for {value}");
                    }
                }
            };
            let n = bodies.grains;
            near(&frame.numbers[..3 * n], &arrays(&bodies.position[..n]));
            near(&frame.numbers[3 * n..6 * n], &arrays(&bodies.velocity[..n]));
            let turning = usize::from(preset == "frictional");
            let wall = &frame.numbers[(7 + 3 * turning) * n..];
            if turning == 1 {
                near(wall, &arrays(&bodies.position[n..]));
                assert_eq!(frame.head["wall_spheres"], bodies.position.len() - n);
            } else {
                // R = 1.5 + 0.2 sin(2 pi (z/lambda + t/T)), 14 rings per wave, running towards -z.
                assert_eq!(wall.len(), 14);
                let phase = frame.head["period"].as_f64().unwrap();
                for (ring, &radius) in wall.iter().enumerate() {
                    let angle = std::f64::consts::TAU * (ring as f64 / 14.0 + phase);
                    let expected = 1.5 + 0.2 * angle.sin();
                    assert!(
                        (f64::from(radius) - expected).abs() < 1e-5,
                        "ring {ring}: {radius} for {expected}"
                    );
                }
            }
            // The first frame is before the first sample, and has none.
            let sample = &frame.head["sample"]["flow_rate_ratio"];
            assert_eq!(sample.is_number(), step(&frame) > 0, "{sample}");
        }
    }
}

/// Vectors as arrays, whatever their type.
fn arrays<Vector: Copy + Into<[f64; 3]>>(vectors: &[Vector]) -> Vec<[f64; 3]> {
    vectors.iter().map(|&vector| vector.into()).collect()
}

#[test]
fn frames_that_are_not_there_are_told_to_who_asked() {
    let served = Recorded::small().serve();
    let (mut client, _) = served.client();
    for number in [9, 1_000_000, u64::MAX] {
        let message = missing(&mut client, number);
        assert!(message.contains("it holds 9"), "{message}");
    }
    assert_eq!(frame(&mut client, 8).head["number"], 8);
    for number in ["-1", "0.5", "\"0\"", "\"../config.toml\"", "null"] {
        let (mut client, _) = served.client();
        client.send(&format!(r#"{{"type":"frame","number":{number}}}"#));
        assert_eq!(client.notice()["type"], "problem", "{number}");
        while let Some(message) = client.next() {
            assert!(message.is_binary(), "{number}: {message}");
        }
    }
}

#[test]
fn a_recording_is_not_driven_and_a_run_has_no_recorded_frames() {
    let served = Recorded::small().serve();
    let (mut client, _) = served.client();
    for command in [
        r#"{"type":"play","playing":true}"#,
        r#"{"type":"steer","parameter":"width","value":2.7}"#,
        r#"{"type":"save"}"#,
    ] {
        client.send(command);
        let notice = client.notice();
        assert_eq!(notice["type"], "problem", "{notice}");
        assert!(notice["message"].as_str().unwrap().contains("--live"));
    }
    assert!(!served.saves.exists());
    assert_eq!(frame(&mut client, 1).head["number"], 1);

    let served = Served::small();
    let (mut client, welcome) = served.client();
    assert!(welcome["recorded"].is_null());
    assert!(client.frame().head["number"].is_null());
    assert!(missing(&mut client, 0).contains("computed"));
}

#[test]
fn without_samples_the_flow_rate_is_what_the_trajectory_logged() {
    let recorded = Recorded::small();
    let recording =
        Recording::open(&recorded.path(), recorded.configuration.clone(), Vec::new()).unwrap();
    let ratio = recorded.run.recorder().samples().last().unwrap();
    let viewer = Viewer::play(recording, "tube".to_owned(), 0).unwrap();
    let served = Served::serve(viewer, recorded.folder);
    let (_, welcome) = served.client();
    let rows = welcome["rows"].as_array().unwrap();
    assert_eq!(rows.len(), 9);
    assert!(rows[0]["flow_rate_ratio"].is_null() && rows[0]["bottleneck"].is_null());
    assert_eq!(rows[8]["flow_rate_ratio"], ratio.flow_rate_ratio);
    assert_eq!(rows[8]["amplitude"], 2.6);
}

#[test]
fn what_is_no_trajectory_of_the_run_is_refused() {
    let recorded = Recorded::small();
    let other = configuration("frictionless", &["tube.waves=3", "drive.width=2.6"]);
    let refused = Recording::open(&recorded.path(), other, Vec::new()).unwrap_err();
    assert!(
        matches!(refused, ViewerError::ForeignTrajectory { .. }),
        "{refused}"
    );
    assert!(refused.to_string().contains("30 d with"), "{refused}");
    let text = recorded.folder.path().join("text.gsd");
    std::fs::write(&text, "ITEM: TIMESTEP\n0\n").unwrap();
    for path in [text, recorded.folder.path().join("none.gsd")] {
        let refused = recorded.open(&path).unwrap_err();
        assert!(matches!(refused, ViewerError::Trajectory(_)), "{refused}");
    }
}

#[test]
fn a_trajectory_that_is_cut_short_plays_as_far_as_it_goes() {
    let recorded = Recorded::small();
    let path = recorded.path();
    let bytes = std::fs::read(&path).unwrap();
    std::fs::write(&path, &bytes[..bytes.len() - 8]).unwrap();
    let recording = recorded.open(&path).unwrap();
    assert_eq!((recording.frames(), recording.lost_frames()), (8, 1));
    let folder = recorded.folder;
    let viewer = Viewer::play(recording, "tube".to_owned(), 0).unwrap();
    let served = Served::serve(viewer, folder);
    let (mut client, welcome) = served.client();
    assert_eq!(welcome["recorded"]["lost_frames"], 1);
    assert_eq!(frame(&mut client, 7).head["number"], 7);
    // Cut once more under the viewer's hands.
    std::fs::write(&path, &bytes[..bytes.len() / 2]).unwrap();
    let message = missing(&mut client, 7);
    assert!(message.contains("trajectory.gsd"), "{message}");
    assert_eq!(frame(&mut client, 0).head["number"], 0);
}

/// The warnings of a played recording were empty.
#[test]
fn a_recording_has_the_warnings_of_its_run() {
    let settings = [
        "tube.waves=2",
        "drive.width=2.6",
        "observe.transition_threshold=1.2",
    ];
    let recorded = Recorded::new("frictionless", &settings);
    let keys = |recording: Recording| {
        let viewer = Viewer::play(recording, "tube".to_owned(), 0).unwrap();
        let served = Served::serve(viewer, tempfile::tempdir().unwrap());
        let (mut client, _) = served.client();
        let warnings = frame(&mut client, 3).head["warnings"].clone();
        let warnings = warnings.as_array().unwrap().iter();
        let keys = warnings.map(|it| it["key"].as_str().unwrap().to_owned());
        keys.collect::<Vec<_>>()
    };
    let recording = recorded.open(&recorded.path()).unwrap();
    assert_eq!(keys(recording), ["observe.transition_threshold"]);
    let recording = recorded.open(&recorded.path()).unwrap();
    let whole = recorded.run.warnings();
    let expected: Vec<_> = whole.iter().map(|it| it.key.to_owned()).collect();
    assert_eq!(keys(recording.with_warnings(whole)), expected);
}

#[test]
fn recorded_grains_that_wait_outside_are_nowhere() {
    let settings = ["tube.waves=4", "tube.ends=open", "inlet.waiting=20"];
    let recorded = Recorded::new("frictionless", &settings);
    let ends = recorded.run.simulation().ends().unwrap();
    let grains = recorded.run.simulation().bodies().grains;
    let waits: Vec<bool> = (0..grains).map(|grain| ends.waits(grain)).collect();
    assert!(waits.contains(&true) && waits.contains(&false));
    let served = recorded.serve();
    let (mut client, _) = served.client();
    let last = frame(&mut client, 8);
    let centres = last.numbers[..3 * grains].chunks(3);
    let nowhere: Vec<bool> = centres.map(|centre| centre[0].is_nan()).collect();
    assert_eq!(nowhere, waits);
}
