//! Folders of runs, kills, going on.

use serde_json::Value;

use crate::{Place, read_json};

#[test]
fn runs_that_begin_at_once_have_a_folder_each() {
    let place = Place::new();
    let run = |seed: u32| place.start(&format!("run SMALL run.seed={seed}"));
    let mut children: Vec<_> = (1..=6).map(run).collect();
    for child in &mut children {
        assert!(child.wait().unwrap().success());
    }
    let mut seeds = Vec::new();
    for number in 1..=6 {
        let folder = place.path(&format!("runs/frictionless-{number}"));
        let summary = read_json(&folder.join("summary.json"));
        let text = std::fs::read_to_string(folder.join("config.toml")).unwrap();
        let configuration: toml::Table = toml::from_str(&text).unwrap();
        let seed = summary["seed"].as_i64().unwrap();
        assert_eq!(configuration["run"]["seed"].as_integer(), Some(seed));
        seeds.push(seed);
    }
    seeds.sort_unstable();
    assert_eq!(seeds, [1, 2, 3, 4, 5, 6]);
}

#[test]
fn of_runs_that_begin_at_once_in_one_folder_one_gets_it() {
    let place = Place::new();
    let run = |seed: u32| place.start(&format!("run SMALL --out one run.seed={seed}"));
    let children: Vec<_> = (1..=5).map(run).collect();
    let codes = children.into_iter().map(|mut child| child.wait().unwrap());
    let mut codes: Vec<_> = codes.map(|status| status.code()).collect();
    codes.sort_unstable();
    assert_eq!(codes, [0, 2, 2, 2, 2].map(Some));
    place.does("figures one");
    let left = place.inventory().into_keys();
    assert!(
        !left
            .into_iter()
            .any(|name| name.to_string_lossy().contains("partial"))
    );
}

#[test]
fn a_resume_that_is_refused_changes_nothing() {
    let place = Place::new();
    place.does("run SMALL --out one --trajectory gsd");
    let frames = place.path("one/trajectory.gsd");
    let whole = std::fs::read(&frames).unwrap();
    std::fs::write(&frames, &whole[..whole.len() / 2]).unwrap();
    let kept = || {
        ["config.toml", "state.checkpoint", "summary.json"]
            .map(|name| std::fs::read(place.path("one").join(name)).unwrap())
    };
    let before = kept();
    place.refuses("run --resume one --periods 9", &["trajectory.gsd"]);
    assert!(kept() == before);
}

#[cfg(unix)]
#[test]
fn a_run_can_be_gone_on_with_from_its_first_step_after_a_kill() {
    let place = Place::new();
    let slow = "SMALL run.periods=1 run.time_step=1e-9";
    let mut child = place.start(&format!("run --out killed {slow}"));
    while !place.path("killed/state.checkpoint").is_file() {
        std::thread::sleep(std::time::Duration::from_millis(10));
    }
    child.kill().unwrap();
    child.wait().unwrap();
    place.does("figures killed");
    place.refuses(
        "run SMALL --checkpoint-every 3",
        &["--checkpoint-every", "30m"],
    );
}

#[cfg(target_os = "linux")]
#[test]
fn a_run_under_nohup_outlives_its_terminal() {
    use std::process::Stdio;
    let place = Place::new();
    let mut command = std::process::Command::new("sh");
    let line = crate::words(crate::signals::LONG).join(" ");
    let line = format!(
        "trap '' HUP; exec {} {line} --out whole",
        env!("CARGO_BIN_EXE_peristalsis")
    );
    let command = command.args(["-c", &line]).current_dir(place.path(""));
    let child = command
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn();
    let (code, said) = crate::signals::stopped_by(child.unwrap(), &["HUP"]);
    assert_eq!(code, Some(0), "{said}");
}

#[test]
fn a_table_that_a_run_left_is_renewed_when_it_goes_on() {
    let place = Place::new();
    place.does("run SMALL --csv --out on");
    place.does("run --resume on --periods 6");
    place.does("run SMALL --csv --out whole run.periods=6");
    place.assert_same(["on", "whole"], &["timeseries.csv"]);
    place.assert_same_run(["on", "whole"]);
}

#[test]
fn a_complete_run_is_lengthened_to_the_run_that_was_asked_for_at_once() {
    for (preset, settings) in [
        (
            "frictionless",
            "grains.number=20 tube.waves=2 observe.late_fraction=0.4",
        ),
        (
            "frictionless",
            "grains.number=20 tube.waves=2 drive.schedule=ramp drive.ramp_periods=3",
        ),
        (
            "frictional",
            "grains.number=20 observe.samples_per_period=40",
        ),
    ] {
        let place = Place::new();
        let unit = if preset == "frictional" { 0.05 } else { 1.0 };
        let frames = format!(
            "--trajectory gsd,vtp,lammps --trajectory-every {}",
            0.3 * unit
        );
        let run = format!("run --preset {preset} {settings} {frames}");
        let [short, long] = [2.0 * unit, 5.0 * unit];
        place.does(&format!("{run} --out on run.periods={short}"));
        place.refuses("run --resume on", &["it is complete", "--periods"]);
        let before = place.inventory();
        let less = format!("run --resume on --periods {unit}");
        place.refuses(&less, &["has done", "periods already", "in whole samples"]);
        assert_eq!(place.inventory(), before);
        place.does(&format!("run --resume on --periods {long}"));
        place.does(&format!("{run} --out whole run.periods={long}"));
        place.assert_same_run(["on", "whole"]);
        place.assert_same(
            ["on", "whole"],
            &[
                "trajectory.gsd",
                "trajectory.pvd",
                "trajectory.lammpstrj",
                "trajectory.toml",
            ],
        );
    }
}

#[test]
fn a_run_of_a_static_wave_is_lengthened_by_its_duration() {
    let place = Place::new();
    let run = "run --preset frictionless drive.strain_rate=0 grains.number=20 tube.waves=2";
    place.does(&format!("{run} --out on run.duration=10"));
    place
        .does("run --resume on --duration 30")
        .says(&["from its start"]);
    place.does(&format!("{run} --out whole run.duration=30"));
    place.assert_same(
        ["on", "whole"],
        &["config.toml", "timeseries.parquet", "snapshot.svg"],
    );
    place.refuses("run --resume on --duration 20", &["has done 30 t already"]);
}

#[test]
fn a_window_of_frames_that_a_longer_run_goes_on_with_ends_where_it_was_asked_to() {
    let place = Place::new();
    let run = "run SMALL --trajectory gsd --trajectory-window";
    place.does(&format!("{run} 1:3 --out within"));
    place.does(&format!("{run} 1:5 --out beyond"));
    for folder in ["within", "beyond"] {
        place.does(&format!("run --resume {folder} --periods 6"));
    }
    place.does(&format!("{run} 1:3 --out three run.periods=6"));
    place.does(&format!("{run} 1:5 --out five run.periods=6"));
    place.assert_same(["within", "three"], &["trajectory.gsd"]);
    place.assert_same(["beyond", "five"], &["trajectory.gsd"]);
}

#[test]
fn figures_are_drawn_again_to_the_same_bytes() {
    let place = Place::new();
    place.does("run SMALL --out one");
    let before = place.inventory();
    for name in ["flow.svg", "flow.png", "profile.png", "snapshot.svg"] {
        std::fs::remove_file(place.path("one").join(name)).unwrap();
    }
    place.does("figures one").shows(&["one/flow.svg"]);
    let content = |inventory: crate::Inventory| {
        let files = inventory.into_iter();
        files
            .map(|(name, file)| (name, file.map(|(bytes, _)| bytes)))
            .collect::<Vec<_>>()
    };
    assert!(content(place.inventory()) == content(before));
    place.refuses("figures nowhere", &["nowhere holds no run"]);
}

/// What either program saves, the other goes on with.
#[test]
fn a_state_in_a_file_goes_on_in_a_new_folder() {
    let place = Place::new();
    place.does("run SMALL --out short run.periods=2");
    std::fs::copy(
        place.path("short/state.checkpoint"),
        place.path("mine.snapshot"),
    )
    .unwrap();
    place.refuses("run --resume mine.snapshot", &["complete", "--periods"]);
    place.does("run --resume mine.snapshot --periods 4 --out on");
    place.does("run SMALL --out whole");
    place.assert_same_run(["on", "whole"]);
    place.does("run --resume mine.snapshot --periods 3");
    assert!(place.path("runs/mine-1/summary.json").is_file());
    place.does("run --resume short --periods 4 --out branch");
    place.assert_same_run(["branch", "whole"]);

    let bytes = std::fs::read(place.path("mine.snapshot")).unwrap();
    place.write("mine.snapshot", &bytes[..bytes.len() / 2]);
    place.refuses(
        "run --resume mine.snapshot",
        &["mine.snapshot", "cut short"],
    );
}

#[test]
fn runs_are_listed_with_what_came_out() {
    let place = Place::new();
    place.does("runs").shows(&["no runs below runs"]);
    place.does("run SMALL");
    place.does("run SMALL --out runs/below/other run.seed=2 run.periods=1");
    std::fs::create_dir_all(place.path("runs/broken")).unwrap();
    place.write("runs/broken/config.toml", "nothing = ");
    let shown = place.does("runs");
    shown.shows(&[
        "runs/frictionless-1",
        "4 of 4",
        "complete",
        "unreadable",
        "0.05",
    ]);
    let runs = place.does("runs --json").json();
    let runs = runs.as_array().unwrap();
    let folders: Vec<_> = runs
        .iter()
        .map(|run| run["folder"].as_str().unwrap())
        .collect();
    assert_eq!(
        folders,
        ["runs/below/other", "runs/broken", "runs/frictionless-1"]
    );
    let summary = read_json(&place.path("runs/frictionless-1/summary.json"));
    assert_eq!(runs[2]["flow_rate_ratio"], summary["flow_rate_ratio"]);
    assert_eq!(runs[2]["grains"], 20);
    assert_eq!(runs[0]["seed"], 2);
    place.refuses("runs nowhere", &["nowhere", "folders of runs"]);
    place.write("runs/frictionless-1/summary.json", "{ \"status\": ");
    let damaged = place.does("runs --json").json();
    assert_eq!(damaged[2]["status"], "unreadable");
}

/// `run --seeds` with the scatter shown.
#[test]
fn seeds_run_side_by_side_and_their_scatter_is_shown() {
    let place = Place::new();
    place.refuses(
        "run SMALL --seeds 1..3 run.seed=5",
        &["exclude one another"],
    );
    place.refuses(
        "check SMALL tube.radius=3mm",
        &["3mm is no number", "in grain diameters"],
    );
    let all = place
        .does("run SMALL --seeds 1..3 --out many --json")
        .json();
    let ratios: Vec<f64> = (1..=3)
        .map(|seed| {
            let single = place.does(&format!(
                "run SMALL --out one-{seed} --json run.seed={seed}"
            ));
            place.assert_same_run([&format!("one-{seed}"), &format!("many/seed-{seed}")]);
            single.json()["flow_rate_ratio"].as_f64().unwrap()
        })
        .collect();
    let mean = ratios.iter().sum::<f64>() / 3.0;
    let squares: f64 = ratios.iter().map(|ratio| (ratio - mean).powi(2)).sum();
    let flow = &all["flow_rate_ratio"];
    let close = |value: &Value, expected: f64| (value.as_f64().unwrap() - expected).abs() < 1e-12;
    assert!(
        close(&flow["mean"], mean) && close(&flow["standard_deviation"], (squares / 2.0).sqrt())
    );
    assert!(close(&flow["error_of_mean"], (squares / 6.0).sqrt()));
    assert_eq!(all["replicates"][1]["seed"], 2);

    place.refuses(
        "run SMALL --seeds 2,3 --out many",
        &["many/seed-2 holds another run"],
    );
    place.refuses("run SMALL --seeds 3..1", &["1..10"]);
    place.does("run SMALL --seeds 2,5").shows(&[
        "seed 5: J/Jmax = ",
        "within this run",
        "mean of 2 seeds",
        "scatter between seeds",
    ]);
    assert!(
        place
            .path("runs/frictionless-1/seed-5/summary.json")
            .is_file()
    );
    place.does("run --resume many --periods 6 --quiet");
    place.does("run SMALL --out longer run.seed=3 run.periods=6");
    place.assert_same_run(["longer", "many/seed-3"]);
}

/// What an engineer reads of replicates, where J/Jmax says nothing.
#[test]
fn seeds_and_runs_tell_the_mass_flow() {
    let place = Place::new();
    let silo = "run --preset silo run.duration=100 --seeds 1..2 --out";
    let flows = ["discharge in kg/h", "mean of 2 seeds"];
    place.does(&format!("{silo} silo")).shows(&flows);
    place.does("runs silo").shows(&["kg/h discharged"]);
    let json = place.does("runs silo --json").json();
    assert_eq!(json[0]["mass_flow_unit"], "kg/h");
    assert_eq!(json[0]["mass_flow_is"], "discharge");
    // "the tube holds ... kg" as a number.
    let summary = read_json(&place.path("silo/seed-1/summary.json"));
    let kilograms = summary["si"]["hold_up_kg"].as_f64().unwrap();
    let unit = std::f64::consts::PI / 6.0 * 2500.0 * 8e-9;
    let expected = summary["open"]["hold_up"].as_f64().unwrap() * unit;
    assert!((kilograms / expected - 1.0).abs() < 1e-12, "{kilograms}");
    assert_eq!(summary["si"]["return_rate_kg_per_s"], 0.0);
    let si = "units.grain_diameter=1e-3 units.density=2500 units.stiffness=100";
    place.does(&format!("run SMALL {si} --out pump"));
    place.does("runs pump").shows(&["mass flow", "kg/h"]);
    let summary = place.path("pump/summary.json");
    let summary: Value = serde_json::from_str(&std::fs::read_to_string(summary).unwrap()).unwrap();
    let per_second = &summary["si"]["mass_flow_rate_kg_per_s"];
    let listed = place.does("runs pump --json").json();
    let per_hour = listed[0]["mass_flow"].as_f64().unwrap();
    assert!((per_hour / 3600.0 - per_second.as_f64().unwrap()).abs() < 1e-15);
}

/// A pump engineer: a run whose width a schedule leads was listed with a width that it never had, and 7/13 periods with all
/// their digits.
#[test]
fn runs_tell_what_a_schedule_leads_and_lengths_of_few_digits() {
    let place = Place::new();
    let course = "{form='course',parameter='width',at=[0,0.2,0.5],values=[2.9,2.5,2.7]}";
    let samples = "observe.samples_per_period=13 run.periods=0.5";
    place.does(&format!(
        "run SMALL {samples} drive.schedule={course} --out led"
    ));
    let listed = place.does("runs led");
    listed.shows(&["w = 2.5 to 2.9 d", "0.538 of 0.538"]);
    let json = place.does("runs led --json").json();
    assert_eq!(json[0]["drive_value_led"], serde_json::json!([2.5, 2.9]));
    assert_eq!(json[0]["strain_rate_led"], Value::Null);
    let drawn = std::fs::read_to_string(place.path("led/flow.svg")).unwrap();
    assert!(drawn.contains("2.5 to 2.9"), "the title of its figure");
}

/// Replicates that are stopped go on, those that had not begun included.
#[cfg(unix)]
#[test]
fn seeds_that_were_stopped_go_on_to_the_same_runs() {
    let place = Place::new();
    let run = "run SMALL run.periods=500";
    let child = place.start(&format!("{run} --seeds 1..5 --out many"));
    let (code, said) = crate::signals::stopped_by(child, &["TERM", "TERM"]);
    assert_eq!(code, Some(143), "{said}");
    assert!(
        said.contains("go on with: peristalsis run --resume many"),
        "{said}"
    );
    place.does("runs many").shows(&["unfinished"]);
    place.does("run --resume many").shows(&["mean of 5 seeds"]);
    for seed in [1, 5] {
        place.does(&format!("{run} --out one-{seed} run.seed={seed}"));
        place.assert_same_run([&format!("one-{seed}"), &format!("many/seed-{seed}")]);
    }
}

#[test]
fn the_error_says_what_it_is_an_error_of_and_rounding_is_none() {
    let place = Place::new();
    place
        .does("run SMALL --out results")
        .shows(&["within this run, mean of its last 25 %"]);
    let short = place.does("run SMALL --out short run.periods=0.05").stdout;
    assert!(
        short.contains("too short for a transition: 0.050 periods"),
        "{short}"
    );
}

/// `trajectory` into a run, a damaged trajectory, threads that change nothing.
#[test]
fn what_would_write_into_a_run_or_go_on_with_a_damaged_one_is_refused() {
    let place = Place::new();
    place.does("run SMALL --out one --trajectory gsd");
    place.does("run SMALL --out other");
    let before = place.inventory();
    place.refuses("trajectory one --out one", &["one holds another run"]);
    place.refuses("trajectory one --out other", &["other holds another run"]);
    assert_eq!(place.inventory(), before);
    place.write("one/trajectory.gsd", "damaged");
    place.refuses("run --resume one --periods 6", &["trajectory.gsd"]);
    let frictional = "run --preset frictional --threads 2 grains.number=20 run.periods=0.05";
    place
        .does(&format!(
            "{frictional} --out reference run.kernel=reference"
        ))
        .says(&["--threads changes nothing here"]);
    let threads = place.does(&format!("{frictional} --out frictional"));
    assert!(!threads.stderr.contains("--threads"), "{}", threads.stderr);
    place.refuses("run SMALL --threads none", &["auto"]);
}

#[test]
fn names_that_are_given_in_the_wrong_place_are_put_right() {
    let place = Place::new();
    place.refuses("run frictionless", &["--preset frictionless"]);
    let study = "name = \"many\"\npreset = \"frictionless\"\n\n[base]\nrun.periods = 1\n";
    place.write("study.toml", study);
    place.refuses(
        "run study.toml",
        &["study.toml is a study", "study run study.toml"],
    );
    let completions = place.does("completions bash").stdout;
    for offered in [
        "frictionless frictionless-source frictionless-fine frictional",
        "F1 F2",
        "slip-to-roll",
    ] {
        assert!(completions.contains(offered), "{offered}");
    }
    let help = place.does("run --help").stdout;
    assert!(help.contains("--checkpoint-every"));
}

/// A pump engineer: a wave that stopped where rounding left 1e-16 of a wavelength had a J/Jmax of 1e14.
#[test]
fn a_wave_that_has_stopped_has_no_flow_rate_ratio() {
    let place = Place::new();
    place.write(
        "pause.toml",
        "preset = \"frictionless\"\n[tube]\nwaves = 1\n[drive]\nstrain_rate = 0.011\n\
         schedule = { form = \"steps\", parameter = \"strain_rate\", at = [2], values = [0.0] }\n\
         [observe]\nlate_fraction = 0.5\n[run]\nperiods = 4\n",
    );
    place.does("run pause.toml --out r");
    let summary = read_json(&place.path("r/summary.json"));
    for key in ["flow_rate_ratio", "flow_rate_ratio_raw", "wall_torque"] {
        assert!(summary[key].is_null(), "{key}: {}", summary[key]);
    }
    assert_eq!(summary["periods"], 2.0);
}

/// A pump engineer: a wider outlet let out no more, and nothing said that the inlet brought too little.
#[test]
fn an_inlet_that_does_not_keep_a_silo_full_is_named() {
    let place = Place::new();
    let pipe = "run --preset frictionless tube.waves=3 tube.ends=open drive.strain_rate=0 drive.width=2.9 \
                inlet.waiting=60 grains.number=80 run.duration=800 body.gravity=[0,0,-0.01]";
    let run = place.does(&format!("{pipe} --out pipe"));
    let said = run.says(&[
        "inlet.velocity: grains fill",
        "take a larger inlet.velocity",
    ]);
    assert!(said.stdout.contains("the outlet discharges"));
    let fed = place.does(&format!("{pipe} inlet.feed_rate=0.02 --out fed"));
    assert!(!fed.stderr.contains("inlet.velocity"), "{}", fed.stderr);
    // One that fills from 54 grains to 143, the last seven while 17 leave, was told that it fills no more.
    let filling = place.does(
        "run --preset frictionless tube.waves=6 tube.ends=open drive.strain_rate=0 drive.width=2.5 inlet.waiting=640 \
         grains.number=700 run.duration=400 inlet.velocity=0.5 body.gravity=[0,0,-0.003] --out filling",
    );
    assert!(
        !filling.stderr.contains("and no more"),
        "{}",
        filling.stderr
    );
    let held = read_json(&place.path("filling/summary.json"))["open"]["hold_up"]
        .as_f64()
        .unwrap();
    assert!(held > 120.0, "{held}");
}
