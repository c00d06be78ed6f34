//! Paths that are no UTF-8, which a name of a file need not be: every command takes them.

use std::ffi::{OsStr, OsString};
use std::os::unix::ffi::OsStrExt;
use std::process::Stdio;

use crate::study::quick;
use crate::{Outcome, Place, words};

/// A name of a file with bytes that no text has.
fn odd(name: &str) -> OsString {
    let mut bytes = b"\xff\xfe ".to_vec();
    bytes.extend(name.as_bytes());
    OsStr::from_bytes(&bytes).to_owned()
}

/// Calls the program with arguments of which those that begin with `@` are odd names.
fn call(place: &Place, line: &str) -> Outcome {
    let arguments = words(line)
        .into_iter()
        .map(|argument| match argument.strip_prefix('@') {
            Some(name) => odd(name),
            None => argument.into(),
        });
    let output = place.command(arguments).output().unwrap();
    // What is no text is shown with marks in its place.
    Outcome {
        code: output.status.code(),
        stdout: String::from_utf8_lossy(&output.stdout).into_owned(),
        stderr: String::from_utf8_lossy(&output.stderr).into_owned(),
    }
}

#[test]
fn runs_pictures_and_trajectories() {
    let place = Place::new();
    let text = "preset = \"frictionless\"\ngrains.number = 20\ntube.waves = 2\nrun.periods = 1\n";
    std::fs::write(place.folder.path().join(odd("tube.toml")), text).unwrap();
    call(&place, "check @tube.toml").expect_code(0);
    call(&place, "run @tube.toml").expect_code(0);
    call(
        &place,
        "run @tube.toml --out @run --trajectory=gsd,vtp,lammps",
    )
    .expect_code(0);
    call(&place, "run --out @small SMALL").expect_code(0);
    call(&place, "run --resume @run")
        .expect_code(2)
        .says(&["it is complete"]);
    call(&place, "run @tube.toml --out @run")
        .expect_code(2)
        .says(&["holds another run"]);
    call(&place, "trajectory @small --duration 0.5").expect_code(0);
    call(&place, "render @run --width 64 --bare --out @picture.png").expect_code(0);
    call(&place, "render @run --width 64 --at 0.5").expect_code(0);
    call(&place, "render @run --out @picture")
        .expect_code(2)
        .says(&["known by this ending", "help:"]);
    for name in ["run", "picture.png"] {
        assert!(place.folder.path().join(odd(name)).exists(), "{name}");
    }
}

#[test]
fn studies() {
    let place = Place::new();
    std::fs::write(place.folder.path().join(odd("study.toml")), quick()).unwrap();
    call(&place, "study plan @study.toml").expect_code(0);
    call(&place, "study run @study.toml --store @store --workers 1").expect_code(0);
    call(&place, "study status @store")
        .expect_code(0)
        .shows(&["4 done"]);
    call(&place, "study verify @store").expect_code(0);
    call(&place, "study scan @store").expect_code(0);
    call(&place, "study export @store --out @tables --series").expect_code(0);
    call(&place, "study pack @store @runs.tar").expect_code(0);
    call(&place, "study run @study.toml --store @other --for 1ms").expect_code(0);
    call(&place, "study import @other @runs.tar").expect_code(0);
    call(&place, "study status @other")
        .expect_code(0)
        .shows(&["4 done"]);
    call(&place, "study status @nowhere")
        .expect_code(2)
        .says(&["no store of a study", "help:"]);
}

#[test]
fn reports() {
    let place = Place::new();
    call(
        &place,
        "reproduce --quick --out @report --only F2 --for 1s --workers 1",
    )
    .expect_code(0);
    let page = place.folder.path().join(odd("report")).join("report.html");
    assert!(page.is_file());
}

#[test]
fn what_is_viewed_and_where_states_are_saved() {
    let place = Place::new();
    call(&place, "run --out @run SMALL --trajectory=gsd").expect_code(0);
    for live in [None, Some("--live")] {
        let arguments = [OsString::from("view"), odd("run")];
        let mut child = place
            .command(arguments.into_iter().chain(live.map(OsString::from)))
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        let mut address = String::new();
        let stdout = child.stdout.take().unwrap();
        std::io::BufRead::read_line(&mut std::io::BufReader::new(stdout), &mut address).unwrap();
        assert!(address.starts_with("http://127.0.0.1:"), "{address}");
        child.kill().unwrap();
        child.wait().unwrap();
    }
}
