//! `peristalsis view`: a server that says where it is, and ends when asked to.

use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;

use crate::{Place, send};

/// Views, asks for the page, and stops; answers the page.
fn page_of(place: &Place, source: &str) -> String {
    let mut child = place.start(&format!("view {source}"));
    let mut address = String::new();
    BufReader::new(child.stdout.take().unwrap())
        .read_line(&mut address)
        .unwrap();
    let (host, path) = address
        .trim()
        .strip_prefix("http://")
        .unwrap()
        .split_once('/')
        .unwrap();
    let mut stream = TcpStream::connect(host).unwrap();
    let request = format!("GET /{path} HTTP/1.1\r\nHost: {host}\r\nConnection: close\r\n\r\n");
    stream.write_all(request.as_bytes()).unwrap();
    let mut page = String::new();
    stream.read_to_string(&mut page).unwrap();
    send("INT", &child);
    assert_eq!(child.wait().unwrap().code(), Some(0));
    page
}

#[test]
fn presets_files_and_folders_are_served() {
    let place = Place::new();
    place.write("narrow.toml", "preset = \"frictionless\"\ntube.waves = 2\n");
    place.does("run narrow.toml run.periods=1 --trajectory=gsd --out done");
    place.does("trajectory done --duration=0.5");
    for source in [
        "frictionless tube.waves=2",
        "narrow.toml",
        "done",
        "done --live",
        "done --from-state",
        "done/trajectory.gsd",
        "done/from-state/trajectory.gsd",
    ] {
        let page = page_of(&place, source);
        assert!(page.starts_with("HTTP/1.1 200"), "{source}: {page}");
        assert!(page.contains("viewer.js"), "{source}: {page}");
    }
    assert!(!place.path("saved-states").exists());
}

#[test]
fn stores_tables_and_reproductions_are_served() {
    let place = Place::new();
    let study = "name = \"small\"\npreset = \"frictionless\"\n[base]\ntube.waves = 2\nrun.periods = 1\n\
        [[axes]]\nkey = \"drive.width\"\nvalues = [2.5, 2.8]\n";
    place.write("small.toml", study);
    place.does("study run small.toml --store all/stores/small");
    place.does("study export all/stores/small --out tables");
    for source in [
        "all/stores/small",
        "all",
        "tables/small.parquet",
        "tables/small.csv",
        "tables",
    ] {
        let page = page_of(&place, source);
        assert!(page.starts_with("HTTP/1.1 200"), "{source}: {page}");
        assert!(page.contains("study.js"), "{source}: {page}");
    }
    for option in ["--live", "--from-state", "--set=drive.width=2.7"] {
        let call = format!("view all/stores/small {option}");
        place.refuses(&call, &["is a study", "for a run"]);
    }
    place.write("times.csv", "time,ratio\n0.5,1\n");
    place.refuses("view times.csv", &["times", "identity"]);
    place.write("none.csv", "identity,replicate\n");
    place.refuses(
        "view none.csv",
        &["none is no table of finished runs", "it has no rows"],
    );
}

#[test]
fn what_cannot_be_viewed_is_refused() {
    let place = Place::new();
    std::fs::create_dir(place.path("empty")).unwrap();
    place.write("alone.gsd", "not beside its run");
    std::fs::create_dir(place.path("damaged")).unwrap();
    place.write("damaged/config.toml", "preset = \"frictionless\"\n");
    place.write("damaged/trajectory.gsd", "no GSD at all");
    for (source, part) in [
        ("frictionles --port=0", "frictionles"),
        ("frictionless drive.width=9", "drive.width"),
        ("frictionless --port=70000", "70000"),
        ("empty --port=0", "config.toml"),
        ("none.gsd --port=0", "none.gsd"),
        ("alone.gsd --port=0", "config.toml"),
        ("alone.gsd --live", "played, not computed"),
        ("frictionless --live", "for the folder of a run"),
        (
            "damaged/config.toml --from-state",
            "for the folder of a run",
        ),
        ("empty drive.width=2.7", "--set"),
        ("damaged --port=0", "begin like a GSD file"),
    ] {
        place.refuses(&format!("view {source}"), &[part]);
    }
}
