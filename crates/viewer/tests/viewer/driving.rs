//! A run that is played, driven, gone back in and saved.

use peristalsis_run::RunFolder;

use crate::client::{Served, holds};

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
