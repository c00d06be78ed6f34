//! `peristalsis runs`: one line per run, with what came out of it.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use peristalsis_configuration::{Configuration, HOUR, ScheduledParameter};
use peristalsis_run::{RunFolder, files};
use serde_json::{Value, json};

use super::run::{DISCHARGE, MASS_FLOW, RUNS, measured};
use crate::arguments::RunsArguments;
use crate::commands::{print, print_json, rounded};
use crate::failure::Failure;

pub(crate) fn runs(arguments: &RunsArguments) -> Result<ExitCode, Failure> {
    let mut found = Vec::new();
    for folder in &arguments.folders {
        match collect(folder, &mut found) {
            Err(error)
                if error.kind() == std::io::ErrorKind::NotFound && folder == Path::new(RUNS) => {}
            done => done.map_err(|error| {
                let reason = format!("cannot read {}: {error}", folder.display());
                Failure::usage(reason, "name folders of runs, or folders that contain them")
            })?,
        }
    }
    let runs: Vec<Value> = found.iter().map(|folder| entry(folder)).collect();
    if arguments.json {
        return print_json(&runs);
    }
    if runs.is_empty() {
        let places = arguments.folders.iter().map(|it| it.display().to_string());
        let places: Vec<String> = places.collect();
        return print(&format!("no runs below {}\n", places.join(", ")));
    }
    print(&table(&runs))
}

/// The folders of runs below a folder, itself included, by name.
fn collect(folder: &Path, found: &mut Vec<PathBuf>) -> std::io::Result<()> {
    if folder.join(files::CONFIGURATION).is_file() {
        found.push(folder.to_owned());
        return Ok(());
    }
    let mut below = Vec::new();
    for entry in std::fs::read_dir(folder)? {
        let entry = entry?;
        // Links are not followed: they may lead round in a circle.
        if entry.file_type()?.is_dir() {
            below.push(entry.path());
        }
    }
    below.sort_by_key(|path| natural(path));
    below.iter().try_for_each(|path| collect(path, found))
}

/// A name with its last number apart, so that run-10 comes after run-9.
fn natural(path: &Path) -> (String, u64) {
    let name = path.to_string_lossy().into_owned();
    let digits = name.len() - name.trim_end_matches(|it: char| it.is_ascii_digit()).len();
    let (stem, number) = name.split_at(name.len() - digits);
    (stem.to_owned(), number.parse().unwrap_or(0))
}

/// What is known of the run in a folder.
fn entry(path: &Path) -> Value {
    let folder = path.to_string_lossy();
    let configuration = match RunFolder::named(path).configuration() {
        Ok(configuration) => configuration,
        Err(error) => {
            let message = error.to_string();
            return json!({ "folder": folder, "status": "unreadable", "message": message });
        }
    };
    let summary = std::fs::read_to_string(path.join(files::SUMMARY)).ok();
    let summary: Option<Value> = match summary.map(|text| serde_json::from_str(&text)) {
        Some(Err(error)) => {
            let message = format!("{}: {error}", files::SUMMARY);
            return json!({ "folder": folder, "status": "unreadable", "message": message });
        }
        read => read.and_then(Result::ok),
    };
    let of = |key: &str| summary.as_ref().map_or(Value::Null, |all| all[key].clone());
    let warnings = of("warnings").as_array().map(Vec::len);
    let status = status(&configuration, &summary);
    // Of a run that goes on, or was killed, the state that it saved last says how far it was then.
    let time = match status.as_str() {
        UNFINISHED | "interrupted" => reached(path).map_or(of("time"), Value::from),
        _ => of("time"),
    };
    let periods = time
        .as_f64()
        .filter(|_| configuration.run.periods.is_some())
        .map(|time| time * configuration.drive.strain_rate);
    let (drive, value) = configuration.drive.control.amplitude();
    let led = |parameter: ScheduledParameter| {
        let schedule = configuration.drive.schedule(parameter)?;
        let periods = configuration.run.periods.unwrap_or(f64::INFINITY);
        Some(schedule.extent(periods))
    };
    let (mass_flow, mass_flow_error, mass_flow_unit) = mass_flow(&of("si"), &of("open"));
    json!({
        "folder": folder,
        "grains": configuration.grains.number,
        "seed": configuration.run.seed,
        "strain_rate": configuration.drive.strain_rate,
        "strain_rate_led": led(ScheduledParameter::StrainRate),
        "drive": drive,
        "drive_value": value,
        "drive_value_led": led(drive),
        // Of drive.strain_rate, unlike a summary's, which are the wavelengths that the wave has run.
        "periods_done": periods,
        "periods_asked": configuration.run.periods,
        "time": time,
        "duration_asked": configuration.run.duration,
        "status": status,
        "flow_rate_ratio": of("flow_rate_ratio"),
        "flow_rate_ratio_error": of("flow_rate_ratio_error"),
        "mass_flow": mass_flow,
        "mass_flow_error": mass_flow_error,
        "mass_flow_unit": mass_flow_unit,
        "mass_flow_is": mass_flow.map(|_| match of("open").is_object() {
            true => DISCHARGE,
            false => MASS_FLOW,
        }),
        "transition_time": of("transition_time"),
        "warnings": warnings,
    })
}

/// Mass that an open tube discharges, of another that flows along the wave, its error and their unit; missing of a periodic
/// tube without units in SI.
fn mass_flow(si: &Value, open: &Value) -> (Option<f64>, Option<f64>, Option<&'static str>) {
    let number = |table: &Value, key: &str| table[key].as_f64();
    let in_si = ["discharge_rate_kg_per_s", "mass_flow_rate_kg_per_s"].into_iter();
    let mut in_si = in_si.filter_map(|key| {
        let error = number(si, &format!("{key}_error"));
        Some((number(si, key)?, error))
    });
    if let Some((rate, error)) = in_si.next() {
        return (
            Some(HOUR * rate),
            error.map(|error| HOUR * error),
            Some("kg/h"),
        );
    }
    let rate = number(open, "discharge_rate");
    (
        rate,
        number(open, "discharge_rate_error"),
        rate.map(|_| "m/t"),
    )
}

/// The status of a run that goes on, was killed, or is to be longer than it is.
const UNFINISHED: &str = "unfinished";

/// Time of the state that a run saved last \[t\].
fn reached(path: &Path) -> Option<f64> {
    let run = RunFolder::named(path).state().ok()?;
    Some(run.simulation().time())
}

/// How a run ended; [`UNFINISHED`] where it goes on, was killed, or is to be longer than it is.
fn status(configuration: &Configuration, summary: &Option<Value>) -> String {
    let Some(summary) = summary else {
        return UNFINISHED.to_owned();
    };
    let steps = summary["steps"].as_u64().unwrap_or(0);
    match summary["status"].as_str() {
        Some("complete") if steps < configuration.run.steps() => UNFINISHED.to_owned(),
        Some(status) => status.to_owned(),
        None => "unreadable".to_owned(),
    }
}

/// The runs as a table, its columns as wide as they must be.
fn table(runs: &[Value]) -> String {
    let headings = [
        "run",
        "grains",
        "rate, 1/t",
        "width or force",
        "periods",
        "status",
        "J/Jmax within the run",
        "mass flow",
        "transition, t",
        "warnings",
    ];
    let mut rows = vec![headings.map(str::to_owned)];
    rows.extend(runs.iter().map(row));
    let widths: Vec<usize> = (0..headings.len())
        .map(|column| {
            rows.iter()
                .map(|row| row[column].chars().count())
                .max()
                .unwrap_or(0)
        })
        .collect();
    let line = |row: &[String; 10]| {
        let cells = row
            .iter()
            .zip(&widths)
            .map(|(cell, &width)| format!("{cell:width$}"));
        let cells: Vec<String> = cells.collect();
        cells.join("  ").trim_end().to_owned() + "\n"
    };
    rows.iter().map(line).collect()
}

fn row(run: &Value) -> [String; 10] {
    let folder = run["folder"].as_str().unwrap_or_default().to_owned();
    let status = run["status"].as_str().unwrap_or_default().to_owned();
    if status == "unreadable" {
        let mut row = [const { String::new() }; 10];
        (row[0], row[5]) = (folder, status);
        return row;
    }
    let number = |key: &str| run[key].as_f64();
    let plain = |key: &str| number(key).map_or("–".to_owned(), |it| it.to_string());
    let few_digits = |key: &str| number(key).map_or("–".to_owned(), rounded);
    // A constant that drive.schedule replaces says nothing of the run.
    let drive = |key: &str| match run[format!("{key}_led")].as_array() {
        Some(led) => {
            let mut led: Vec<String> = led.iter().filter_map(Value::as_f64).map(rounded).collect();
            led.dedup();
            led.join(" to ")
        }
        None => few_digits(key),
    };
    let with_error = |key: &str| {
        let error = number(&format!("{key}_error")).unwrap_or(f64::NAN);
        number(key).map(|value| measured((value, error)))
    };
    let missing = || "–".to_owned();
    let unit = run["mass_flow_unit"].as_str().unwrap_or_default();
    let what = match run["mass_flow_is"].as_str() {
        Some(DISCHARGE) => " discharged",
        _ => "",
    };
    let mass_flow =
        with_error("mass_flow").map_or_else(missing, |flow| format!("{flow} {unit}{what}"));
    // Lengths are rounded up to whole samples, and may have any number of digits.
    let in_thousandths = |key: &str| {
        number(key).map_or("–".to_owned(), |it| {
            ((1e3 * it).round() / 1e3).to_string()
        })
    };
    let done = |done: &str, asked: &str, unit: &str| {
        format!(
            "{} of {}{unit}",
            in_thousandths(done),
            in_thousandths(asked)
        )
    };
    [
        folder,
        plain("grains"),
        drive("strain_rate"),
        match run["drive"].as_str() {
            Some("width") => format!("w = {} d", drive("drive_value")),
            _ => format!("f^P = {}", drive("drive_value")),
        },
        match number("periods_asked") {
            Some(_) => done("periods_done", "periods_asked", ""),
            None => done("time", "duration_asked", " t"),
        },
        status,
        with_error("flow_rate_ratio").unwrap_or_else(missing),
        mass_flow,
        number("transition_time").map_or("–".to_owned(), |time| format!("{time:.1}")),
        plain("warnings"),
    ]
}
