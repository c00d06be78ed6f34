//! `peristalsis render`: pictures and films of the tube as it looks.

use crate::Place;

/// A finished run with frames every quarter of a period.
fn place() -> Place {
    let place = Place::new();
    place.does("run SMALL --out results --trajectory gsd --trajectory-every 0.25");
    place
}

fn bytes(place: &Place, file: &str) -> Vec<u8> {
    std::fs::read(place.path(file)).unwrap_or_else(|error| panic!("{file}: {error}"))
}

#[test]
fn a_finished_run_is_drawn_from_every_side() {
    let place = place();
    let before = place.inventory();
    place
        .does("render results --width 300")
        .shows(&["300 x ", "results/tube-side.png"]);
    let section =
        "render results --view section --position 0.25 --width 64 --bare --out section.png";
    place
        .does(section)
        .shows(&["64 x 64 pixels of t = ", "section.png"]);
    let nowhere = section.replace("0.25", "nan");
    place.refuses(&nowhere, &["there is no position NaN"]);
    for options in [
        "--format svg --colour coordination --wall glass --paper dark",
        "--at 1.3 --colour axial-displacement --out displaced.png",
        "--from start --colour pressure --range 0:0.5 --at 0.5 --out pressure.png",
    ] {
        let call = format!("render results --width 200 {options}");
        place.does(&call);
    }
    place.does("render results --view space-time");
    for file in [
        "results/tube-side.png",
        "section.png",
        "results/tube-space-time.png",
        "displaced.png",
        "pressure.png",
    ] {
        let bytes = bytes(&place, file);
        assert!(
            bytes.starts_with(b"\x89PNG") && bytes.len() > 2_000,
            "{file}"
        );
    }
    let svg = String::from_utf8(bytes(&place, "results/tube-side.svg")).unwrap();
    // A long label has several lines, each with its words.
    let words = svg.split("aria-label=\"").skip(1);
    let words: Vec<&str> = words.filter_map(|it| it.split('"').next()).collect();
    assert!(words.join(" ").contains("contacts of a grain"), "{words:?}");
    assert!(svg.contains("data:image/png;base64,"));
    for (name, content) in before {
        if content.is_some() {
            assert_eq!(place.inventory()[&name], content, "{}", name.display());
        }
    }
}

/// A picture alone counts displacements from the start of its run, not from itself.
#[test]
fn displacements_of_the_saved_state_are_those_of_the_run() {
    let place = place();
    let drawn = |range: &str| {
        let options = format!("--colour axial-displacement --range {range} --bare --width 100");
        place.does(&format!("render results {options} --out state.png"));
        bytes(&place, "state.png")
    };
    assert_ne!(drawn("-0.1:0.1"), drawn("-1000:1000"));
}

#[test]
fn a_loaded_run_is_compared_with_a_fluid_without_load() {
    let place = Place::new();
    place.does("run SMALL --out results");
    place.does("run SMALL drive.body_force=-0.0001 --out loaded");
    let says = |folder: &str| {
        let svg = bytes(&place, &format!("{folder}/flow.svg"));
        String::from_utf8(svg)
            .unwrap()
            .contains("Newtonian fluid without load")
    };
    assert_eq!(["results", "loaded"].map(says), [false, true]);
}

#[test]
fn an_empty_tube_waits_for_no_flow() {
    let place = Place::new();
    place.does("run SMALL grains.number=0 --out empty");
    place.does("render empty --width 200 --out empty.svg");
    let svg = String::from_utf8(bytes(&place, "empty.svg")).unwrap();
    assert!(svg.contains(": no grains") && !svg.contains("not yet"));
}

#[test]
fn a_picture_takes_the_place_of_no_file_of_the_run() {
    let place = place();
    let before = place.inventory();
    for file in ["state.checkpoint", "summary.json", "config.toml"] {
        place
            .call(&format!("render results --out results/{file} --format png"))
            .expect_code(2)
            .says(&[file, "would be lost", "name another file"]);
    }
    assert!(place.inventory() == before);
}

#[test]
fn films_have_a_frame_for_each_instant_wherever_it_comes_from() {
    let place = place();
    for (options, frames) in [
        ("--format gif", 17),
        ("--format gif --window 1:2", 5),
        ("--format gif --from start --window 0:1 --every 0.2", 6),
        (
            "--format gif --from state --duration 0.3 --every 0.1 --view section",
            4,
        ),
        ("--film --trajectory results/trajectory.gsd --every 1", 5),
    ] {
        let call = format!("render results --width 160 --json -q {options} --out film.gif");
        let made = place.does(&call).json();
        assert_eq!(made["frames"], frames, "{options}");
        assert_eq!(made["files"][0], "film.gif");
        let bytes = bytes(&place, "film.gif");
        assert!(bytes.starts_with(b"GIF89a"));
        // A graphic control extension stands before each picture.
        let controls = bytes.windows(3).filter(|it| **it == *b"\x21\xf9\x04");
        assert!(controls.count() >= frames, "{options}");
    }
    place
        .does("render results --width 160 --out film.apng --window 0:1")
        .says(&["100 %", "frame 5 of 5"])
        .shows(&["5 frames of 160 x ", "film.apng"]);
    let film = bytes(&place, "film.apng");
    assert!(film.starts_with(b"\x89PNG") && film.windows(4).any(|name| name == b"acTL"));
}

/// The nearest frame was drawn, and nothing said of which instant it was.
#[test]
fn the_instant_of_a_picture_is_told() {
    let place = place();
    // Frames every quarter of a period, of 20 t.
    let call = "render results --width 64 --out one.png --at 13t";
    place
        .does(call)
        .shows(&["pixels of t = 15 (0.75 periods): one.png"]);
    let made = place.does(&format!("{call} --json")).json();
    let near = |key: &str, value: f64| (made[key].as_f64().unwrap() - value).abs() < 1e-6;
    assert!(near("time", 15.0) && near("periods", 0.75), "{made}");
    let all = place.does("render results --view space-time --json").json();
    assert!(all["time"].is_null(), "{all}");
}

#[test]
fn what_cannot_be_drawn_is_refused_and_nothing_is_left() {
    let place = place();
    let before = place.inventory();
    let refused = "
render nowhere | nowhere holds no run
render results --width 3 | take 16 to 16384
render results --width 0 --film | take 16 to 16384
render results --width 99999 | take 16 to 16384
render results --colour taste | axial-velocity, speed, diameter
render results --view inside | side, section, space-time
render results --view space-time --film | take --view side
render results --film --from trajectory --colour pressure | take --from state or --from start
render results --colour angular-velocity | do not rotate
render results --place 3 | add --view section
render results --view section --place 300 | take 0 to 20 d
render results --range 1:0 | FROM less than TO
render results --out film.avi | .apng, .mp4
render results --film --format png | gif, apng
render results --film --window 30:40 | none of the 17 frames
render results --film --fps 0 | 0.1 to 120
render results --film --trajectory results/config.toml | does not begin like a GSD file
render results --film --from state --at 2 | --window
render results --window 1:2 | add --film
render results --from state --at 2 | one instant
render results --waves 0 | positive number of waves
render results --waves -1 | positive number of waves
render results --at -1 | from 0 on
render results --at -1t | from 0 on
render results --window -1:2 --film | 20:25 in periods
render results --fps -1 --film | 0.1 to 120
render results --fps 10 --out film.png | add --film
render results --fps 0 | add --film
render results --view section --wall glass | take --view side
render results --view section --waves 1 | take --view side
render results --view section --eye wave | take --view side
render results --view space-time --waves 1 | take --view side
render results --view space-time --at 1 | leave out
";
    for line in refused.trim().lines() {
        let (call, expected) = line.split_once(" | ").unwrap();
        let outcome = place.call(call).expect_code(2);
        let message = outcome.message();
        assert!(message.contains(expected), "{call}: {message}");
    }
    // Without a trajectory.
    std::fs::remove_file(place.path("results/trajectory.gsd")).unwrap();
    place.refuses(
        "render results --film --from trajectory",
        &["holds no trajectory.gsd", "--from state, --from start"],
    );
    let mut after = place.inventory();
    after.retain(|name, _| before.contains_key(name));
    assert_eq!(after.len() + 1, before.len());
    assert_eq!(place.inventory().len() + 1, before.len());
}

#[cfg(unix)]
#[test]
fn a_film_goes_through_the_ffmpeg_that_is_named_and_leaves_nothing_where_that_fails() {
    use std::os::unix::fs::PermissionsExt;
    let place = place();
    let call = "render results --width 160 --window 0:1 -q --out film.mp4";
    let with = |program: &str| {
        let mut command = place.command(call.split(' '));
        command.env("FFMPEG", program);
        crate::Outcome::of(command.output().unwrap())
    };
    with("./not-there")
        .expect_code(2)
        .says(&["`./not-there` cannot be started", "--format gif"]);
    // It keeps what it is given, under the name that comes last.
    let script = "#!/bin/sh\nfor last; do :; done\ncat > \"$last\"\n";
    let stand_in = place.write("stand-in", script);
    std::fs::set_permissions(&stand_in, std::fs::Permissions::from_mode(0o755)).unwrap();
    with("./stand-in").expect_code(0);
    let film = bytes(&place, "film.mp4");
    assert_eq!(
        film.len() % (3 * 160 * 5),
        0,
        "five frames of 160 pixels across"
    );
    std::fs::remove_file(place.path("film.mp4")).unwrap();
    place.write("stand-in", "#!/bin/sh\necho no such codec >&2\nexit 1\n");
    with("./stand-in").expect_code(1).says(&["no such codec"]);
    let left = place.inventory().into_keys();
    let films = left.filter(|name| {
        name.to_string_lossy().contains("film") || name.to_string_lossy().contains("partial")
    });
    assert_eq!(films.count(), 0);
}

#[cfg(unix)]
#[test]
fn a_film_that_is_stopped_leaves_no_file() {
    let place = place();
    let mut child =
        place.start("render results --from start --every 0.0025 --width 400 --out film.gif");
    // Once there is something beside it, frames are being made.
    let partial = || {
        let names = place.inventory().into_keys();
        names
            .filter(|name| name.to_string_lossy().ends_with(".partial"))
            .count()
    };
    while partial() == 0 {
        assert!(
            child.try_wait().unwrap().is_none(),
            "it ended before it was stopped"
        );
        std::thread::sleep(std::time::Duration::from_millis(10));
    }
    std::thread::sleep(std::time::Duration::from_millis(200));
    crate::send("INT", &child);
    crate::Outcome::of(child.wait_with_output().unwrap())
        .expect_code(130)
        .says(&["nothing is left of it"]);
    assert_eq!(partial(), 0);
    assert!(!place.path("film.gif").exists());
}

#[test]
fn grains_with_friction_are_coloured_by_their_rotation() {
    let place = Place::new();
    place.does("run SMALL --out rough contact.kinetic_friction=0.5");
    let render = "render rough --width 64 --colour angular-velocity";
    for from in ["", " --from start", " --at 1 --from start"] {
        place.does(&format!("{render}{from}"));
    }
}
