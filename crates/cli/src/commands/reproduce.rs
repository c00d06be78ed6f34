//! `peristalsis reproduce`

use std::hash::{BuildHasher, RandomState};
use std::path::PathBuf;
use std::process::ExitCode;
use std::time::{Duration, Instant};

use peristalsis_reproduce::report::{Report, plain_text};
use peristalsis_reproduce::{
    CLAIMS, DifferingRow, Drawn, Event, Examination, Extent, Import, Outcome, Reproduction,
    STUDIES, Sample, Sampling, Size, Stage, chosen, published_in_words,
};
use peristalsis_study::{Effort, Ending};

use super::study::progress::{StudyDisplay, overall};
use crate::arguments::ReproduceArguments;
use crate::commands::{code_of, counted, print, say_if_replaced, tell};
use crate::failure::Failure;
use crate::progress::seconds;
use crate::stop::Stop;

/// Time between two checkpoints of a run.
const CHECKPOINT_INTERVAL: Duration = Duration::from_secs(60);
/// Time in which published rows are computed again unless it is said; then that for what rows do not hold, such as the flow in
/// time. With reading, judging and drawing it is under five minutes.
const CHECK: Extent = Extent::Time(Duration::from_secs(180));
const FIGURES: Duration = Duration::from_secs(45);
/// Where the published rows lie in a copy of the repository.
const PUBLISHED: &str = "validation/results";
/// Seeds that are drawn are below this, so that a person can type them.
const SEEDS: u64 = 1_000_000;
/// Rows that differ which are named; the report names them all.
const NAMED: usize = 10;

pub(crate) fn reproduce(arguments: &ReproduceArguments) -> Result<ExitCode, Failure> {
    let stop = Stop::watch()?;
    let size = if arguments.quick {
        Size::Quick
    } else {
        Size::Full
    };
    let claims = chosen(CLAIMS, &arguments.only)?;
    let tables = tables(arguments)?;
    let reproduction = Reproduction::prepare(&arguments.out, size, &claims, STUDIES)?;
    let tell = |text: &str| tell(arguments.quiet, text);
    tell(&format!(
        "{}, {} design, in {}",
        counted(claims.len(), "claim"),
        size.name(),
        arguments.out.display()
    ));
    if arguments.fresh && reproduction.has_published_rows() {
        return Err(Failure::usage(
            format!("{} holds published rows already", arguments.out.display()),
            "name another folder with --out, to begin from nothing there",
        ));
    }
    if !tables.is_empty() {
        let import = reproduction.import(&tables)?;
        tell(&imported(&import));
        if !arguments.computes_all() && import.studies.iter().all(|study| study.found == 0) {
            let reason = "none of these tables holds a row of a study of these claims";
            return Err(Failure::usage(reason, NO_ROWS));
        }
    }
    stop.keep_results();
    let outcome = outcome(arguments, &reproduction, &stop)?;
    let ending = outcome.ending;
    let is_well = is_well(&outcome);
    let report = Report::of(size, outcome);
    if !arguments.quiet {
        say_if_replaced(&arguments.out.join("report.html"));
    }
    let page = report.write(&arguments.out)?;
    if arguments.json {
        print(&report.json())?;
    } else {
        print(&summary(&report))?;
        print(&format!("report: {}\n", page.display()))?;
    }
    if let Some(message) = differing(&report) {
        return Err(Failure::OtherRows { message });
    }
    let again = "every run is saved; called again, it goes on";
    match ending {
        Ending::Complete => {}
        Ending::TimeUp => tell(&format!("time is up, {again}")),
        Ending::Stopped => {
            tell(&format!("stopped, {again}"));
            if let Some(code) = stop.requested() {
                return Ok(ExitCode::from(code));
            }
        }
    }
    Ok(code_of(is_well))
}

const NO_ROWS: &str = "name tables of finished runs, or folders of them, with --import (those that are published are in the \
                       folder validation/results of the repository), or compute with --quick (minutes) or --fresh (days)";

/// The tables to begin from.
fn tables(arguments: &ReproduceArguments) -> Result<Vec<PathBuf>, Failure> {
    if let Some(path) = arguments.import.iter().find(|path| !path.exists()) {
        let reason = format!("{}: no such file or folder", path.display());
        return Err(Failure::usage(reason, NO_ROWS));
    }
    if !arguments.import.is_empty() || arguments.quick || arguments.fresh {
        return Ok(arguments.import.clone());
    }
    let here = std::env::current_dir().unwrap_or_default();
    let mut folders = here.ancestors().map(|folder| folder.join(PUBLISHED));
    match folders.find(|folder| folder.is_dir()) {
        Some(folder) => Ok(vec![folder]),
        None => Err(Failure::usage(
            format!("there is no folder {PUBLISHED} with published rows here or above"),
            NO_ROWS,
        )),
    }
}

/// The sample of the published rows that is asked for, if one is.
fn sample(arguments: &ReproduceArguments) -> Option<Sample> {
    let usual = (!arguments.computes_all()).then_some(CHECK);
    let extent = arguments.check.or(usual)?;
    let seed = arguments.check_seed;
    let seed = seed.unwrap_or_else(|| RandomState::new().hash_one(()) % SEEDS);
    (extent != Extent::Part(0.0)).then_some(Sample { extent, seed })
}

/// Computes the runs that were asked for, and examines the claims.
fn outcome(
    arguments: &ReproduceArguments,
    reproduction: &Reproduction,
    stop: &Stop,
) -> Result<Outcome, Failure> {
    let begin = Instant::now();
    let effort = arguments.work.effort(CHECKPOINT_INTERVAL);
    let is_to_stop = || stop.requested().is_some();
    let mut display = StudyDisplay::new(arguments.quiet);
    let drawn = match sample(arguments) {
        None => None,
        Some(sample) => {
            display.tell(&format!(
                "a sample of the published rows is computed again, drawn with --check-seed {}",
                sample.seed
            ));
            let drawn = reproduction.sample(sample, effort, &is_to_stop, &mut |sampling| {
                let board = sampling.board;
                display.update_part(board, sampled(&sampling), board.fraction);
            })?;
            Some(drawn)
        }
    };
    let effort = Effort {
        limit: effort
            .limit
            .map(|limit| limit.saturating_sub(begin.elapsed())),
        ..effort
    };
    // What rows do not hold is computed for a while, and only where nothing else was asked for.
    let is_usual = !arguments.computes_all() && arguments.check.is_none() && effort.limit.is_none();
    let figures = Instant::now();
    let mut watch = |event: Event<'_>| match event {
        Event::Progress(stage) if is_usual => {
            let part = figures.elapsed().div_duration_f64(FIGURES).min(1.0);
            let words = format!(
                "what rows do not hold: {}, {:.0} % of the time",
                stage.study,
                100.0 * part
            );
            display.update_part(stage.board, words, part);
        }
        Event::Progress(stage) => display.update_part(stage.board, whole(&stage), stage.fraction),
        Event::Examined(examination) => display.tell(&verdict(examination)),
        Event::Trouble { study, reason } => display.tell(&format!("study {study}: {reason}")),
    };
    let mut outcome = if arguments.computes_all() {
        reproduction.run(effort, &is_to_stop, &mut watch)
    } else if is_usual {
        let limit = Some(FIGURES);
        reproduction.run(Effort { limit, ..effort }, &is_to_stop, &mut watch)
    } else {
        reproduction.examine(&mut watch)
    };
    display.finish();
    if is_usual && outcome.ending == Ending::TimeUp {
        outcome.ending = Ending::Complete;
    }
    if let Some(Drawn { ending, .. }) = &drawn
        && outcome.ending == Ending::Complete
    {
        outcome.ending = *ending;
    }
    outcome.drawn = drawn;
    Ok(outcome)
}

/// How far the sample is.
fn sampled(sampling: &Sampling<'_>) -> String {
    let Sampling { board, studies, of } = sampling;
    let mut text = format!(
        "{} published rows computed again, from {studies} of {of} studies, {:.0} % of the sample",
        board.done + board.failed,
        100.0 * board.fraction
    );
    if let Some(left) = board.left {
        text.push_str(&format!(", {} left", seconds(left.as_secs_f64())));
    }
    text
}

/// The published rows that differ from their runs computed again, in words; `None` where no row differs.
fn differing(report: &Report) -> Option<String> {
    let studies = report.published.iter();
    let rows = studies.flat_map(|study| study.differing.iter().map(|row| (study.study, row)));
    let rows: Vec<(&str, &DifferingRow)> = rows.collect();
    let number = rows.len();
    let mut text = match number {
        0 => return None,
        1 => "a run computed again differs from its published row".to_owned(),
        _ => format!("{number} runs computed again differ from their published rows"),
    };
    for (study, row) in rows.iter().take(NAMED) {
        let DifferingRow {
            identity,
            columns,
            configuration,
        } = row;
        let first = columns.first()?;
        let [published, computed] = &first.values;
        let column = &first.column;
        text.push_str(&match column.as_str() {
            "status" => format!("\n  study {study}, run {identity}: computed again it {computed}"),
            _ => format!(
                "\n  study {study}, run {identity}, {column}: {published} in the table, {computed} computed again"
            ),
        });
        if columns.len() > 1 {
            text.push_str(&format!(" (and {} columns more)", columns.len() - 1));
        }
        text.push_str(&format!(
            "\n    its configuration: {}",
            configuration.display()
        ));
    }
    if number > NAMED {
        text.push_str(&format!("\n  and {} more", number - NAMED));
    }
    Some(text)
}

/// Whether every claim could be examined, every study worked on, and no run failed.
fn is_well(outcome: &Outcome) -> bool {
    let mut examinations = outcome.examinations.iter();
    let mut studies = outcome.studies.iter();
    examinations.all(|examination| examination.failure.is_none())
        && studies.all(|study| study.failure.is_none() && study.failed == 0)
}

/// The result of an import, a line a study.
fn imported(import: &Import) -> String {
    let mut lines = vec![format!(
        "{} of finished runs",
        counted(import.tables, "table")
    )];
    for (path, reason) in &import.skipped {
        lines.push(format!("  {} is left out: {reason}", path.display()));
    }
    for study in &import.studies {
        let (name, found, runs) = (&study.study, study.found, counted(study.runs, "run"));
        lines.push(format!("  {name}: {found} of {runs} found"));
    }
    lines.join("\n")
}

/// How far everything is.
fn whole(stage: &Stage<'_>) -> String {
    let place = format!("study {} of {}, {}", stage.number, stage.of, stage.study);
    let part = format!("; {:.0} % of all work", 100.0 * stage.fraction);
    format!("{place}: {}", overall(stage.board, &part, stage.left))
}

/// A claim's verdict in one line.
fn verdict(examination: &Examination) -> String {
    let (claim, finding) = (&examination.experiment, &examination.finding);
    let failure = &examination.failure;
    let reason = match failure {
        Some(failure) => format!("could not be examined: {failure}"),
        None => plain_text(&finding.summary),
    };
    let is_thin = failure.is_none() && !examination.is_sufficient();
    let thin = if is_thin { " (thin statistics)" } else { "" };
    format!("{} {}{thin}: {reason}", claim.id, finding.verdict.name())
}

/// The claims, a line each, and the published rows.
fn summary(report: &Report) -> String {
    let line = |examination: &Examination| {
        let claim = &examination.experiment;
        let (verdict, title) = (examination.finding.verdict.name(), claim.prose.title());
        format!("{:<4} {verdict:<11} {}\n", claim.id, plain_text(title))
    };
    let mut lines: String = report.examinations.iter().map(line).collect();
    if let Some(words) = published_in_words(&report.published, report.drawn.as_ref()) {
        lines.push_str(&format!("{words}\n"));
    }
    lines
}
