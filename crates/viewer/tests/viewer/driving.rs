//! A run that is played, driven, gone back in and saved.

use peristalsis_run::{Run, RunFolder};

use crate::client::{Served, configuration, holds};

#[test]
fn a_client_is_welcomed_and_sees_the_tube() {
    let served = Served::small();
    let (mut client, welcome) = served.client();
    assert_eq!(welcome["control"], "strain");
    assert_eq!(welcome["length"], 20.0);
    assert_eq!(welcome["heading"], -1.0);
    assert_eq!(welcome["ranges"]["width"][1], 3.0);
    assert!(welcome["ranges"]["friction"].is_null());
    let grains = welcome["grains"].as_u64().unwrap() as usize;
    let frame = client.frame();
    assert_eq!(frame.head["grains"], grains);
    assert_eq!(frame.head["playing"], false);
    assert_eq!(frame.numbers.len(), 7 * grains + 14);
    let positions = frame.numbers[..3 * grains].chunks(3);
    for place in positions {
        assert!(place[0].hypot(place[1]) < 2.0 && (0.0..20.0).contains(&place[2]));
    }
    assert!(
        frame.numbers[6 * grains..7 * grains]
            .iter()
            .all(|&d| d == 1.0)
    );
    // At t = 0: R = 1.5 + 0.2 sin(2 pi z/lambda), z = 0 and a quarter of 14 rings is between two.
    let rings = &frame.numbers[7 * grains..];
    assert!((rings[0] - 1.5).abs() < 1e-6 && rings[3] > 1.69 && rings[10] < 1.31);
}

#[test]
fn it_plays_at_the_speed_asked_for_and_stops() {
    let served = Served::small();
    let (mut client, _) = served.client();
    client.send(r#"{"type":"speed","periods_per_second":null}"#);
    client.send(r#"{"type":"play","playing":true}"#);
    let later = client.frame_with(|head| head["clock"].as_f64().unwrap() > 2.0);
    assert_eq!(later.head["playing"], true);
    let rows = later.head["rows"].as_array().unwrap();
    assert!(rows.len() >= 40, "{} rows", rows.len());
    assert!(rows[0]["flow_rate_ratio"].is_number());
    client.send(r#"{"type":"play","playing":false}"#);
    let stopped = client.frame_with(|head| head["playing"] == false);
    client.send(r#"{"type":"speed","periods_per_second":0.5}"#);
    let still = client.frame();
    assert_eq!(stopped.head["step"], still.head["step"]);
    // A sample further, at the next sample of 20 a period.
    client.send(r#"{"type":"step"}"#);
    let next = client.frame_with(|head| head["step"] != still.head["step"]);
    let steps = |head: &serde_json::Value| head["step"].as_u64().unwrap();
    assert!(steps(&next.head) - steps(&still.head) <= 20);
}

#[test]
fn sliders_change_the_tube() {
    let served = Served::new("frictional", &["tube.waves=2"]);
    let (mut client, welcome) = served.client();
    assert_eq!(welcome["control"], "stress");
    assert!(welcome["ranges"]["width"].is_null());
    for (parameter, value) in [("force_amplitude", 0.006), ("friction", 0.1)] {
        client.send(&format!(
            r#"{{"type":"steer","parameter":"{parameter}","value":{value}}}"#
        ));
    }
    client.send(r#"{"type":"steer","parameter":"width","value":2.5}"#);
    let refused = client.notice();
    assert_eq!(refused["type"], "problem", "{refused}");
    client.send(r#"{"type":"speed","periods_per_second":null}"#);
    client.send(r#"{"type":"play","playing":true}"#);
    let arrived = client.frame_with(|head| {
        let force = head["driven"]["force_amplitude"].as_f64().unwrap();
        (force - 0.006).abs() < 1e-12
    });
    assert_eq!(arrived.head["driven"]["friction"], 0.1);
    let grains = arrived.head["grains"].as_u64().unwrap() as usize;
    let wall = arrived.head["wall_spheres"].as_u64().unwrap() as usize;
    assert_eq!((wall, arrived.head["rings"].as_u64()), (1012, Some(0)));
    assert_eq!(arrived.numbers.len(), 10 * grains + 3 * wall);
}

#[test]
fn going_back_computes_the_same_again() {
    let served = Served::small();
    let (mut client, _) = served.client();
    let mut at = |clock: f64| {
        client.send(&format!(r#"{{"type":"seek","period":{clock}}}"#));
        client.frame_with(|head| (head["clock"].as_f64().unwrap() - clock).abs() < 1e-9)
    };
    let first = at(3.0);
    let further = at(5.5);
    let again = at(3.0);
    assert_ne!(first.numbers, further.numbers);
    assert_eq!(first.numbers, again.numbers);
    let epoch = |frame: &crate::client::Frame| frame.head["epoch"].as_u64().unwrap();
    assert!(epoch(&again) > epoch(&first));
}

#[test]
fn a_saved_state_goes_on_from_the_command_line() {
    let served = Served::small();
    let (mut client, _) = served.client();
    client.send(r#"{"type":"steer","parameter":"width","value":2.8}"#);
    client.send(r#"{"type":"seek","period":1.5}"#);
    let frame = client.frame_with(|head| head["clock"].as_f64().unwrap() >= 1.5);
    client.send(r#"{"type":"save"}"#);
    client.send(r#"{"type":"save"}"#);
    let saved = client.notice();
    assert_eq!(saved["type"], "saved", "{saved}");
    let path = served.saves.join("tube-1");
    assert_eq!(saved["folder"], path.display().to_string());
    assert!(
        saved["toml"]
            .as_str()
            .unwrap()
            .contains("form = \"course\"")
    );
    let second = client.notice();
    assert_eq!(
        second["folder"],
        served.saves.join("tube-2").display().to_string()
    );
    assert!(holds(&path, "config.toml") && holds(&path, "state.checkpoint"));

    let (_, mut run) = RunFolder::open(&path).unwrap();
    assert_eq!(run.simulation().step(), frame.head["step"]);
    let sent = run.simulation().bodies().position[0].to_array();
    assert_eq!(sent.map(|it| it as f32), frame.numbers[..3]);
    // What goes on there and here stays the same.
    for _ in 0..10 {
        run.advance().unwrap();
    }
    client.send(r#"{"type":"seek","period":2.0}"#);
    let onward = client.frame_with(|head| head["clock"].as_f64().unwrap() >= 2.0);
    assert_eq!(run.simulation().step(), onward.head["step"]);
    let there = run.simulation().bodies().position[0].to_array();
    assert_eq!(there.map(|it| it as f32), onward.numbers[..3]);
}

/// A viewer's user: "from the start" asked whether what came after 0.00 T may go, and went back to the state.
#[test]
fn a_viewer_of_a_saved_state_tells_the_time_of_its_start() {
    let mut run = Run::new(configuration("frictionless", &["tube.waves=2"])).unwrap();
    for _ in 0..30 {
        run.advance().unwrap();
    }
    let served = Served::of(run);
    let (mut client, welcome) = served.client();
    assert_eq!(welcome["begin"], 1.5);
    client.send(r#"{"type":"seek","period":1}"#);
    client.frame_with(|head| head["clock"] == 1.5);
}

#[test]
fn a_state_beyond_the_end_of_its_run_has_something_to_go_on_with() {
    let served = Served::new("frictionless", &["tube.waves=2", "run.periods=1"]);
    let (mut client, _) = served.client();
    client.send(r#"{"type":"seek","period":1.5}"#);
    client.frame_with(|head| head["clock"].as_f64().unwrap() >= 1.5);
    client.send(r#"{"type":"save"}"#);
    let saved = client.notice();
    assert_eq!(saved["type"], "saved", "{saved}");
    let (_, run) = RunFolder::open(&served.saves.join("tube-1")).unwrap();
    assert_eq!(run.configuration().run.periods, Some(11.5));
}

/// A viewer's user: the command beside a saved state did nothing where the wave stood and the run had ended.
#[test]
fn the_command_for_a_standing_wave_beyond_its_end_makes_it_longer() {
    let settings = ["tube.waves=2", "drive.strain_rate=0", "run.duration=1"];
    let served = Served::new("frictionless", &settings);
    let (mut client, _) = served.client();
    for (clock, ending) in [(0.5, "tube-1"), (1.5, "tube-2 --duration 4")] {
        client.send(&format!(r#"{{"type":"seek","period":{clock}}}"#));
        client.frame_with(|head| head["clock"].as_f64().unwrap() >= clock);
        client.send(r#"{"type":"save"}"#);
        let command = client.notice()["command"].to_string();
        assert!(command.trim_matches('"').ends_with(ending), "{command}");
    }
}

/// A lecturer: the slider of a width that follows a schedule was taken, and led nothing.
#[test]
fn a_slider_does_not_lead_what_a_schedule_leads_nor_a_wave_that_stands() {
    let ramp = "drive.schedule={form=\"ramp\", parameter=\"width\", from=3.0, to=2.5, end=2}";
    let served = Served::new("frictionless", &["tube.waves=2", ramp]);
    let (mut client, _) = served.client();
    client.send(r#"{"type":"seek","period":1}"#);
    client.frame_with(|head| head["clock"] == 1.0);
    let steer = r#"{"type":"steer","parameter":"width","value":2.9}"#;
    client.send(steer);
    assert!(
        client
            .notice()
            .to_string()
            .contains("drive.width still follows its schedule")
    );
    client.send(r#"{"type":"seek","period":2.5}"#);
    let free = client.frame_with(|head| head["clock"] == 2.5);
    assert_eq!(free.head["aims"]["width"], 2.5);
    client.send(steer);
    client.send(r#"{"type":"seek","period":3}"#);
    client.frame_with(|head| head["driven"]["width"] == 2.9);
    let standing = Served::new("frictionless", &["drive.strain_rate=0", "run.duration=1"]);
    let (_, welcome) = standing.client();
    assert!(welcome["ranges"]["width"].is_null());
}

/// Three drags of a slider lie between the mark and the time that is shown.
#[test]
fn going_back_steers_again_as_it_was_steered() {
    let served = Served::small();
    let (mut client, _) = served.client();
    let mut course = |commands: &[(f64, f64)], end: f64| {
        let mut shown = Vec::new();
        for &(clock, width) in commands {
            client.send(&format!(r#"{{"type":"seek","period":{clock}}}"#));
            shown.push(client.frame_with(|head| head["clock"] == clock));
            client.send(&format!(
                r#"{{"type":"steer","parameter":"width","value":{width}}}"#
            ));
        }
        client.send(&format!(r#"{{"type":"seek","period":{end}}}"#));
        shown.push(client.frame_with(|head| head["clock"] == end));
        shown
    };
    let shown = course(&[(1.0, 2.7), (2.0, 2.65), (2.5, 2.57)], 4.0);
    let there = course(&[], 3.0);
    assert_eq!(there[0].head["driven"]["width"], 2.57);
    // A second way there, and on: the same bits as at first.
    let again = course(&[], 4.0);
    assert_eq!(again[0].head["driven"]["width"], 2.57);
    assert_eq!(again[0].numbers, shown[3].numbers);
    let between = course(&[], 2.0);
    assert_eq!(between[0].head["aims"]["width"], 2.65);
}

/// Where a slider leads is said at once, also while nothing is computed.
#[test]
fn a_slider_that_is_moved_while_the_run_rests_shows_where_it_leads() {
    let served = Served::small();
    let (mut client, _) = served.client();
    client.send(r#"{"type":"steer","parameter":"width","value":2.4}"#);
    let frame = client.frame_with(|head| head["aims"]["width"] == 2.4);
    assert_eq!(frame.head["driven"]["width"], 2.6);
}

/// Only the page that saves is told.
#[test]
fn a_save_is_told_to_who_asked() {
    let served = Served::small();
    let (mut one, _) = served.client();
    let (mut other, _) = served.client();
    one.send(r#"{"type":"save"}"#);
    assert_eq!(one.notice()["type"], "saved");
    one.send(r#"{"type":"play","playing":true}"#);
    let playing = |message: &tokio_tungstenite::tungstenite::Message| {
        assert!(!message.is_text(), "{message}");
        message.is_binary()
    };
    let seen = std::iter::from_fn(|| other.next()).filter(playing).take(5);
    assert_eq!(seen.count(), 5);
}

/// Who comes later can go back as well.
#[test]
fn frames_from_before_come_after_the_welcome() {
    let served = Served::small();
    let (mut first, _) = served.client();
    first.send(r#"{"type":"speed","periods_per_second":null}"#);
    first.send(r#"{"type":"play","playing":true}"#);
    first.frame_with(|head| head["clock"].as_f64().unwrap() > 3.0);
    first.send(r#"{"type":"play","playing":false}"#);
    first.frame_with(|head| head["playing"] == false);
    let (mut later, welcome) = served.client();
    assert!(welcome["rows"].as_array().unwrap().len() >= 60);
    let seen = std::cell::RefCell::new(Vec::new());
    let newest = later.frame_with(|head| {
        seen.borrow_mut().push(head["clock"].as_f64().unwrap());
        head["past"] == false
    });
    let clocks = seen.into_inner();
    assert!(clocks.len() >= 2 && clocks[0] == 0.0, "{clocks:?}");
    assert!(clocks.is_sorted() && newest.head["clock"].as_f64().unwrap() > 3.0);
}

#[test]
fn contacts_come_where_they_are_asked_for() {
    let served = Served::small();
    let (mut client, _) = served.client();
    client.send(r#"{"type":"seek","period":2.0}"#);
    client.frame_with(|head| head["clock"] == 2.0);
    client.send(r#"{"type":"contacts","shown":true}"#);
    let frame = client.frame_with(|head| head["contacts"] != 0);
    let grains = frame.head["grains"].as_u64().unwrap() as usize;
    let six = frame.numbers[7 * grains + 14..].chunks(6);
    assert_eq!(six.len() as u64, frame.head["contacts"].as_u64().unwrap());
    for contact in six {
        let centre = &frame.numbers[3 * contact[0] as usize..][..3];
        let away = (0..3)
            .map(|k| (contact[2 + k] - centre[k]).powi(2))
            .sum::<f32>()
            .sqrt();
        // From the centre of a grain of diameter 1 to that of the next, or to the wall.
        let most = if contact[1] < 0.0 { 0.5 } else { 1.0 };
        assert!(
            away <= most + 1e-5 && away > 0.2 * most,
            "{contact:?}: {away}"
        );
    }
}

/// What a link to a state holds takes another viewer to the same bits.
#[test]
fn a_course_takes_another_run_to_the_same_state() {
    let one = Served::small();
    let (mut client, _) = one.client();
    for (clock, width) in [(0.0, 2.7), (1.0, 2.5)] {
        client.send(&format!(r#"{{"type":"seek","period":{clock}}}"#));
        client.frame_with(|head| head["clock"] == clock);
        let steer = format!(r#"{{"type":"steer","parameter":"width","value":{width}}}"#);
        client.send(&steer);
    }
    client.send(r#"{"type":"seek","period":2.0}"#);
    let there = client.frame_with(|head| head["clock"] == 2.0);
    client.send(r#"{"type":"course"}"#);
    let course = client.notice();
    let follow =
        serde_json::json!({ "type": "follow", "turns": course["turns"], "step": course["step"] });
    let other = Served::small();
    let (mut client, _) = other.client();
    client.send(&follow.to_string());
    let here = client.frame_with(|head| head["clock"] == 2.0);
    assert_eq!(here.numbers, there.numbers);
}

#[test]
fn grains_that_wait_outside_an_open_tube_are_nowhere() {
    let settings = ["grains.number=300", "inlet.waiting=120"];
    let served = Served::new("silo", &settings);
    let (mut client, welcome) = served.client();
    assert_eq!(welcome["open"], true);
    assert!(welcome["unit_period"].is_null(), "{welcome}");
    let frame = client.frame();
    let centres = frame.numbers[..900].chunks(3);
    let waiting = centres.clone().filter(|centre| centre[0].is_nan()).count();
    // Those of the inlet, and those that began in the gap between the ends.
    assert!((120..160).contains(&waiting), "{waiting} wait");
    let mut inside = centres.filter(|centre| !centre[0].is_nan());
    assert!(inside.all(|centre| centre[0].hypot(centre[1]) < 8.0));
    client.send(r#"{"type":"speed","periods_per_second":null}"#);
    client.send(r#"{"type":"play","playing":true}"#);
    let later = client.frame_with(|head| !head["sample"].is_null());
    assert!(later.head["sample"]["hold_up"].as_f64().unwrap() > 0.0);
    assert!(later.head["sample"]["discharge_rate"].is_number());
}
