//! Studies, figures and reproduction.

#[cfg(unix)]
use crate::limits::with_small_files;
use crate::study::{finished, quick};
use crate::{Outcome, Place};

/// A study printed "transition at ... ± 0.025" for the values between which most runs change.
#[test]
fn a_bracket_is_told_as_one() {
    let place = Place::new();
    let study = quick()
        .replace("values = [2.4, 2.9]", "values = [1.2, 2.9]")
        .replace(
            "run.periods = 4",
            "run.periods = 4\nobserve.transition_threshold = 0.9",
        );
    place.write("study.toml", study);
    place.does("study run study.toml --store kept --quiet");
    let said = place.does("study status kept").stdout;
    assert!(
        !said.contains('±') && !said.contains("transition at"),
        "{said}"
    );
}

/// A missing or junk file was answered with code 1 and "mend the disk", and not named.
#[test]
fn files_that_cannot_be_imported_are_named_as_bad_input() {
    let place = finished();
    place.write("junk.csv", "no rows\n1\n");
    place.write("header.csv", "no rows\n");
    place.write("junk.parquet", "junk");
    place.write("junk.tar", "junk");
    for name in [
        "junk.csv",
        "header.csv",
        "junk.parquet",
        "junk.tar",
        "none.csv",
        "none.tar",
    ] {
        let said = place.refuses(&format!("study import store {name}"), &[name]);
        assert!(!said.message().contains("mend"), "{}", said.message());
    }
}

/// `nan` was taken, in study files and in tables of finished runs.
#[test]
fn values_that_are_no_numbers_are_refused_with_their_place() {
    let place = finished();
    for value in ["nan", "-inf"] {
        let text = quick().replace("2.9]", &format!("\n{value}]"));
        place.write("wrong.toml", &text);
        let line = text.lines().position(|line| line.contains(value)).unwrap();
        let at = format!("wrong.toml:{}:1", line + 1);
        place.refuses("study plan wrong.toml", &[&at, "is not a finite number"]);
    }
    place.does("study export store --out tables");
    let table = std::fs::read_dir(place.path("tables")).unwrap();
    let mut paths = table.map(|entry| entry.unwrap().path());
    let is_rows = |path: &std::path::PathBuf| {
        let name = path.file_name().unwrap().to_string_lossy();
        name.ends_with(".csv") && !name.contains("timing")
    };
    let text = std::fs::read_to_string(paths.find(is_rows).unwrap()).unwrap();
    let mut lines = text.lines().map(str::to_owned).collect::<Vec<_>>();
    let header = lines.iter().position(|line| line.contains(",identity,"));
    let header = header.unwrap();
    let names: Vec<&str> = text.lines().nth(header).unwrap().split(',').collect();
    for (name, value) in [
        ("time", "nan"),
        ("flow_rate_ratio", "inf"),
        ("watched", "-3"),
        ("watched", "5000000"),
    ] {
        let column = names.iter().position(|it| *it == name).unwrap();
        let before = lines[header + 1].clone();
        let mut cells: Vec<&str> = before.split(',').collect();
        cells[column] = value;
        lines[header + 1] = cells.join(",");
        place.write("edited.csv", lines.join("\n") + "\n");
        let import = "study import other edited.csv --study study.toml";
        place.refuses(
            import,
            &[
                "edited.csv",
                &format!("has the {name} {}", value.replace("nan", "NaN")),
            ],
        );
        lines[header + 1] = before;
    }
}

/// Archives, tables and pictures were overwritten without a word.
#[test]
fn what_is_replaced_is_said() {
    let place = finished();
    for line in [
        "study pack store all.tar",
        "study export store --out tables",
    ] {
        let said = place.does(line).message();
        assert!(!said.contains("replaces"), "{said}");
        place.does(line).says(&["replaces"]);
    }
    place.does("run SMALL --out r --quiet");
    place.does("render r --out r.png --width 200 --quiet");
    let line = "render r --out r.png --width 200 --quiet";
    place.does(line).says(&["replaces r.png"]);
    let validate = "validate --quick --only chain --out checked";
    let submit = "study submit study.toml --slurm --tasks 1 --time 1h";
    for (line, replaced) in [
        (validate, "checked/validation.json"),
        (
            "reproduce --quick --only F3 --for 1s --out report",
            "report/report.html",
        ),
        (submit, "tested.sbatch"),
    ] {
        let said = place.call(line).message();
        assert!(!said.contains("replaces"), "{said}");
        place.call(line).says(&["replaces", replaced]);
    }
    for line in [
        "study pack",
        "study export",
        "study submit",
        "render",
        "validate",
        "reproduce",
    ] {
        let help = place.does(&format!("{line} --help")).stdout;
        assert!(help.contains("replaced"), "{line}: {help}");
    }
}

/// The last frame was drawn for an instant beyond the end; a film was written under the name of a
/// picture.
#[test]
fn pictures_that_cannot_be_had_are_refused() {
    let place = Place::new();
    place.does("run SMALL --out r --trajectory gsd --trajectory-every 1 --quiet");
    let parts = ["no frame of", "300 periods"];
    place.refuses(
        "render r --from trajectory --at 300 --width 200 --out p.png",
        &parts,
    );
    place.does("render r --from trajectory --at 4 --width 200 --out p.png --quiet");
    place.refuses(
        "render r --format gif --out q.png",
        &["--format gif contradicts", "q.png"],
    );
}

/// A missing ffmpeg was told after the work, by then of 7 s.
#[test]
fn a_missing_ffmpeg_is_told_before_any_work() {
    let place = Place::new();
    place.does("run SMALL --out r --quiet");
    let mut command = place.command(crate::words("render r --from start --film --format mp4"));
    let output = command.env("FFMPEG", "no-such-program").output().unwrap();
    let said = crate::Outcome::of(output)
        .expect_code(2)
        .says(&["no-such-program"]);
    assert!(!said.message().contains("frame 1"), "{}", said.message());
}

/// The report named no authors, and its "Again" line left out `--only`.
#[test]
fn a_report_names_its_source_and_how_to_make_it_again() {
    let place = Place::new();
    place.call("reproduce --quick --only F3 --for 1s --out report --quiet");
    let page = std::fs::read_to_string(place.path("report/report.html")).unwrap();
    for part in [
        "Yoshioka",
        "Hayakawa",
        "10.1103/PhysRevE.85.031302",
        "reproduce --quick --only F3",
    ] {
        assert!(page.contains(part), "{part}");
    }
}

/// A student: an axis over presets was taken and did nothing, so did one over a width that a schedule leads, and single keys
/// of a schedule could not be varied.
#[test]
fn axes_change_what_they_name() {
    let place = Place::new();
    let schedule = "drive.schedule = { form = \"ramp\", parameter = \"width\", from = 2.9, to = 2.4, end = 1 }\n";
    let study = |base: &str, key: &str, values: &str| {
        format!(
            "name = \"axes\"\npreset = \"frictionless\"\n[base]\ntube.waves = 2\nrun.periods = 2\n{base}\
             [[axes]]\nkey = \"{key}\"\nvalues = {values}\n"
        )
    };
    place.write("preset.toml", study("", "preset", "[\"frictional\"]"));
    place.refuses(
        "study plan preset.toml",
        &["preset cannot be an axis", "preset.toml:7"],
    );
    place.write("led.toml", study(schedule, "drive.width", "[2.5, 2.6]"));
    place.refuses(
        "study plan led.toml",
        &["are the same run", "led.toml:9", "drive.schedule leads"],
    );
    place.write(
        "to.toml",
        study(schedule, "drive.schedule.to", "[2.5, 2.6]"),
    );
    place.does("study plan to.toml").shows(&["2 points"]);
}

/// A student: imported rows were left out of an archive, and a lost run of a check, without a word.
#[test]
fn what_a_store_lacks_is_told() {
    let place = finished();
    place.does("study export store --out tables");
    place.does("study import rows tables/tested.csv --study study.toml");
    place
        .does("study pack rows rows.tar")
        .says(&["left out", "4 finished runs"]);
    let runs = std::fs::read_dir(place.path("store/runs")).unwrap();
    let lost = runs.map(|entry| entry.unwrap().path()).next().unwrap();
    std::fs::remove_dir_all(lost).unwrap();
    place
        .call("study verify store")
        .expect_code(1)
        .shows(&["3 finished runs", "its seal, done.json, is gone"]);
    place.write("empty.tar", "");
    place.refuses("study import store empty.tar", &["it is empty"]);
    place.refuses(
        "study run store",
        &["is a store", "study run store/study.toml --store store"],
    );
}

/// A student: a run whose files had changed was not in the archive, and nobody said so.
#[test]
fn what_an_archive_lacks_is_told() {
    let place = finished();
    let runs = std::fs::read_dir(place.path("store/runs")).unwrap();
    let changed = runs.map(|entry| entry.unwrap().path()).next().unwrap();
    std::fs::write(changed.join("summary.json"), "{}").unwrap();
    place
        .call("study pack store all.tar")
        .expect_code(1)
        .shows(&["3 finished runs in all.tar"])
        .says(&["is left out", "summary.json", "study verify"]);
}

/// A full disk while tables are exported, which SIGXFSZ would end.
#[cfg(unix)]
#[test]
fn a_full_disk_is_an_error_of_an_export() {
    let place = finished();
    let said = with_small_files(&place, 0, "study export store --out tables");
    said.expect_code(1).says(&["tables", "File too large"]);
    let tables = std::fs::read_dir(place.path("tables"));
    assert_eq!(tables.map_or(0, Iterator::count), 0);
}

/// Commands to copy hold for a folder with a space in its name.
#[test]
fn folders_in_commands_to_copy_are_quoted() {
    let place = Place::new();
    place.does("run SMALL --out kept --quiet");
    std::fs::rename(place.path("kept"), place.path("the run")).unwrap();
    let mut command = place.command(["run", "--resume", "the run"]);
    let said = Outcome::of(command.output().unwrap());
    said.expect_code(2)
        .says(&["peristalsis figures 'the run'", "--resume 'the run'"]);
}
