//! Where results go: new folders, folders that are taken, folders that cannot be written to.

use std::path::Path;

use crate::Place;

const FILES: [&str; 13] = [
    "config.toml",
    "flow.png",
    "flow.svg",
    "profile.parquet",
    "profile.png",
    "profile.svg",
    "snapshot.png",
    "snapshot.svg",
    "state.checkpoint",
    "summary.json",
    "timeseries.csv",
    "timeseries.parquet",
    "waves.parquet",
];

fn names(folder: &Path) -> Vec<String> {
    let mut names: Vec<String> = std::fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    names
}

#[test]
fn nested_relative_folders_are_made_and_filled() {
    let place = Place::new();
    place.does("run SMALL --out a/b/c --csv");
    assert_eq!(names(&place.path("a/b/c")), FILES);
    let figure = std::fs::read(place.path("a/b/c/flow.png")).unwrap();
    assert!(figure.starts_with(b"\x89PNG\r\n\x1a\n"));
    let drawing = std::fs::read_to_string(place.path("a/b/c/flow.svg")).unwrap();
    assert!(drawing.contains("<svg") && drawing.trim_end().ends_with("</svg>"));
    let flow = [
        "flow rate, J/Jmax",
        "time, t/T",
        "threshold",
        "mean over a period",
        "Newtonian fluid (Shapiro et al. 1969), φ = b/a",
        "the same, clear bore, φ = b/(a − dw/2)",
    ];
    assert_labels(&place.path("a/b/c/flow.svg"), &flow);
    let profile = [
        "radius, r/d",
        "grains per length, n1 d",
        "axial velocity, vz/c",
        "temperature, Tg/mc2",
        "(d)",
    ];
    let drawing = place.path("a/b/c/profile.svg");
    assert_labels(&drawing, &profile);
    // Below each of the two columns.
    let position = "aria-label=\"position in the wave frame, (z − ct)/λ\"";
    let drawing = std::fs::read_to_string(drawing).unwrap();
    assert_eq!(drawing.matches(position).count(), 2);
}

/// A drawing bears each of these texts once.
fn assert_labels(drawing: &Path, labels: &[&str]) {
    let drawing = std::fs::read_to_string(drawing).unwrap();
    for label in labels {
        let label = format!("aria-label=\"{label}\"");
        assert_eq!(drawing.matches(&label).count(), 1, "{label}");
    }
}

#[test]
fn an_elastic_wall_has_a_figure_of_its_own() {
    let place = Place::new();
    place
        .does("run --preset frictional --out results grains.number=20 run.periods=0.05 run.seed=3");
    for name in ["wall.svg", "wall.png"] {
        assert!(place.path("results").join(name).is_file(), "{name}");
    }
    let labels = [
        "wall radius, R/d",
        "least to largest",
        "mean",
        "tube at rest",
    ];
    assert_labels(&place.path("results/wall.svg"), &labels);
}

#[test]
fn without_out_each_run_gets_a_folder_of_its_own() {
    let place = Place::new();
    place.write(
        "narrow.toml",
        "preset = \"frictionless\"\ngrains.number = 5\nrun.periods = 1\n",
    );
    for _ in 0..2 {
        place.does("run SMALL");
        place.does("run narrow.toml");
    }
    let expected = ["frictionless-1", "frictionless-2", "narrow-1", "narrow-2"];
    assert_eq!(names(&place.path("runs")), expected);
}

#[test]
fn an_empty_folder_and_a_folder_with_other_things_are_used_as_they_are() {
    let place = Place::new();
    std::fs::create_dir(place.path("results")).unwrap();
    place.write("results/notes.txt", "keep me");
    place.does("run SMALL --out results");
    assert_eq!(
        std::fs::read_to_string(place.path("results/notes.txt")).unwrap(),
        "keep me"
    );
    assert!(place.path("results/summary.json").is_file());
}

#[test]
fn a_folder_that_holds_another_run_stays_as_it_is() {
    let place = Place::new();
    place.does("run SMALL --out results");
    let before = place.inventory();
    place.refuses(
        "run SMALL --out results run.seed=2",
        &[
            "results holds another run",
            "nothing was changed",
            "--out",
            "--resume",
        ],
    );
    assert_eq!(place.inventory(), before);
    // Any one of a run's files is enough to show that there was one; it may be the user's own.
    for name in [
        "config.toml",
        "summary.json",
        "timeseries.parquet",
        "profile.parquet",
        "waves.parquet",
        "state.checkpoint",
        "flow.png",
        "snapshot.svg",
        "timeseries.csv",
    ] {
        let place = Place::new();
        std::fs::create_dir(place.path("results")).unwrap();
        place.write(&format!("results/{name}"), "of another run");
        let before = place.inventory();
        place.refuses("run SMALL --out results", &["holds another run", name]);
        assert_eq!(place.inventory(), before);
    }
}

#[test]
fn folders_that_cannot_be_made() {
    let place = Place::new();
    place.write("file", "not a folder");
    let before = place.inventory();
    let long = format!("new/{}", "x".repeat(300));
    for (folder, reason) in [
        ("file", "not a directory"),
        ("file/below", "directory"),
        ("file/far/below", "directory"),
        (long.as_str(), "name too long"),
    ] {
        let outcome = place.refuses(&format!("run SMALL --out {folder}"), &["cannot write to"]);
        let message = outcome.message().to_lowercase();
        assert!(message.contains(reason), "{message}");
        // Parents that were made on the way are taken away again.
        assert_eq!(place.inventory(), before, "{folder}");
    }
}

#[cfg(target_os = "linux")]
#[test]
fn a_file_system_that_takes_no_files() {
    let place = Place::new();
    place.refuses(
        "run SMALL --out /proc/peristalsis",
        &["cannot write to /proc/peristalsis"],
    );
    place.refuses(
        "run SMALL --out /proc/self",
        &["cannot write to /proc/self"],
    );
}

#[cfg(unix)]
#[test]
fn a_folder_without_permission_to_write() {
    use std::os::unix::fs::PermissionsExt;
    let place = Place::new();
    let folder = place.path("closed");
    std::fs::create_dir(&folder).unwrap();
    std::fs::set_permissions(&folder, std::fs::Permissions::from_mode(0o555)).unwrap();
    if std::fs::write(folder.join("probe"), "").is_ok() {
        eprintln!("skipped: this user may write anywhere");
        return;
    }
    for out in ["closed", "closed/below"] {
        let call = format!("run SMALL --out {out}");
        place.refuses(&call, &["cannot write to", "Permission denied"]);
        assert!(names(&folder).is_empty());
    }
}

#[test]
fn what_cannot_be_resumed() {
    let place = Place::new();
    place.refuses(
        "run --resume absent",
        &["absent holds no run", "config.toml", "peristalsis runs DIR"],
    );
    place.does("run SMALL --out whole");
    let before = place.inventory();
    place.refuses(
        "run --resume whole",
        &["no run that can be continued", "complete"],
    );
    assert_eq!(place.inventory(), before);
    // A table that it lacks it still gets.
    place.does("run --resume whole --csv");
    assert!(place.path("whole/timeseries.csv").is_file());

    let state = ["is the saved state", "peristalsis run --resume whole"];
    place.refuses("check whole/state.checkpoint", &state);
    place.refuses("study run whole/state.checkpoint", &state);
    let folder = [
        "the folder of a run",
        "peristalsis run --resume whole",
        "whole/config.toml",
    ];
    place.refuses("check whole", &folder);
    place.refuses("study run whole", &folder);
    for other in ["SMALL", "--preset frictional", "drive.width=2.7"] {
        let physics = [
            "goes on with the physics",
            "--periods",
            "run whole/config.toml",
        ];
        place.refuses(&format!("run --resume whole {other}"), &physics);
    }
    std::fs::rename(
        place.path("whole/state.checkpoint"),
        place.path("alone.checkpoint"),
    )
    .unwrap();
    place.refuses("view alone.checkpoint", &["run --resume alone.checkpoint"]);
    place.refuses("run --resume whole", &["state.checkpoint"]);
}

/// A header of a checkpoint with other bytes from a place on, and the checksum that belongs to it.
fn doctored(state: &[u8], at: usize, bytes: &[u8]) -> Vec<u8> {
    let mut state = state.to_vec();
    state[at..at + bytes.len()].copy_from_slice(bytes);
    let checksum = crc32fast::hash(&state[..80]);
    state[80..84].copy_from_slice(&checksum.to_le_bytes());
    state
}

#[test]
fn a_state_that_is_damaged_or_of_another_run_is_refused() {
    let place = Place::new();
    place.does("run SMALL --out results");
    // The state of another seed.
    place.does("run SMALL --out other run.seed=2");
    let state = place.path("results/state.checkpoint");
    let bytes = std::fs::read(&state).unwrap();
    let other = std::fs::read(place.path("other/state.checkpoint")).unwrap();
    let mut flipped = bytes.clone();
    flipped[bytes.len() / 2] ^= 1;
    let physics = |version: u8| doctored(&bytes, 76, &[version]);
    let cases: [(&str, &[u8], [&str; 2]); 10] = [
        (
            "half",
            &bytes[..bytes.len() / 2],
            ["cut short", "put the file back"],
        ),
        ("a header", &bytes[..40], ["cut short", "put the file back"]),
        (
            "nothing",
            b"",
            ["cut short: 0 of 84 bytes", "put the file back"],
        ),
        ("a flipped bit", &flipped, ["corrupt", "put the file back"]),
        (
            "other bytes",
            b"something else altogether",
            ["not a checkpoint", "put the file back"],
        ),
        (
            "an older container",
            &doctored(&bytes, 8, &[0]),
            ["format version 0", "the program that wrote it"],
        ),
        (
            "a newer layout",
            &doctored(&bytes, 20, &[200]),
            ["layout version 200", "the program that wrote it"],
        ),
        (
            "older physics",
            &physics(1),
            [
                "version 1 of the physics; this program computes version 2",
                "the program that wrote it",
            ],
        ),
        (
            "newer physics",
            &physics(9),
            ["version 9 of the physics", "the program that wrote it"],
        ),
        (
            "another seed",
            &other,
            ["other physics", "put back the config.toml"],
        ),
    ];
    for (name, damaged, parts) in cases {
        std::fs::write(&state, damaged).unwrap();
        let before = place.inventory();
        for command in [
            "run --resume results",
            "render results",
            "trajectory results",
        ] {
            let outcome = place.call(command);
            assert_eq!(outcome.code, Some(2), "{name}: {outcome:?}");
            outcome
                .says(&[
                    "results/state.checkpoint cannot be continued",
                    "peristalsis run results/config.toml --out DIR",
                ])
                .says(&parts);
        }
        assert_eq!(place.inventory(), before, "{name}");
    }
    // What the help says works.
    place.does("run results/config.toml --out again");
    std::fs::write(&state, bytes).unwrap();
    place.refuses("run --resume results", &["it is complete"]);
}

#[test]
fn a_run_that_was_killed_before_it_saved_a_state_can_be_begun_anew() {
    let place = Place::new();
    place.does("run SMALL --out results");
    for entry in std::fs::read_dir(place.path("results")).unwrap() {
        let path = entry.unwrap().path();
        if !path.ends_with("config.toml") {
            std::fs::remove_file(path).unwrap();
        }
    }
    place.refuses(
        "run --resume results",
        &[
            "state.checkpoint",
            "peristalsis run results/config.toml --out DIR",
        ],
    );
    place.does("run results/config.toml --out again");
}
