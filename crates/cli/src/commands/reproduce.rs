//! `peristalsis reproduce`

use std::process::ExitCode;
use std::time::Duration;

use peristalsis_reproduce::report::{Report, plain_text};
use peristalsis_reproduce::{
    CLAIMS, Event, Examination, Import, Outcome, Reproduction, STUDIES, Size, Stage, chosen,
};
use peristalsis_study::Ending;

use super::study::progress::{StudyDisplay, overall};
use crate::arguments::ReproduceArguments;
use crate::commands::{code_of, print, say_if_replaced, tell};
use crate::failure::Failure;
use crate::stop::Stop;

/// Time between two checkpoints of a run.
const CHECKPOINT_INTERVAL: Duration = Duration::from_secs(60);

pub(crate) fn reproduce(arguments: &ReproduceArguments) -> Result<ExitCode, Failure> {
    let stop = Stop::watch()?;
    let full = arguments.full;
    let size = if full { Size::Full } else { Size::Quick };
    let claims = chosen(CLAIMS, &arguments.only)?;
    let reproduction = Reproduction::prepare(&arguments.out, size, &claims, STUDIES)?;
    let tell = |text: &str| tell(arguments.quiet, text);
    let is_default = !arguments.quick && !full;
    tell(&format!(
        "{} claim{}, {} design{}, in {}",
        claims.len(),
        if claims.len() == 1 { "" } else { "s" },
        size.name(),
        if is_default {
            " (--full has enough runs for verdicts)"
        } else {
            ""
        },
        arguments.out.display()
    ));
    if !arguments.import.is_empty() {
        tell(&imported(&reproduction.import(&arguments.import)?));
    }
    let effort = arguments.work.effort(CHECKPOINT_INTERVAL);
    stop.keep_results();
    let mut display = StudyDisplay::new(arguments.quiet);
    let outcome = reproduction.run(
        effort,
        &|| stop.requested().is_some(),
        &mut |event| match event {
            Event::Progress(stage) => {
                display.update_part(stage.board, whole(&stage), stage.fraction)
            }
            Event::Examined(examination) => display.tell(&verdict(examination)),
            Event::Trouble { study, reason } => display.tell(&format!("study {study}: {reason}")),
        },
    );
    display.finish();
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

/// Whether every claim could be examined, every study worked on, and no run failed.
fn is_well(outcome: &Outcome) -> bool {
    let mut examinations = outcome.examinations.iter();
    let mut studies = outcome.studies.iter();
    examinations.all(|examination| examination.failure.is_none())
        && studies.all(|study| study.failure.is_none() && study.failed == 0)
}

/// The result of an import, a line a study.
fn imported(import: &Import) -> String {
    let mut lines = vec![format!("{} tables of finished runs", import.tables)];
    for (path, reason) in &import.skipped {
        lines.push(format!("  {} is left out: {reason}", path.display()));
    }
    for study in &import.studies {
        let (name, found, runs) = (&study.study, study.found, study.runs);
        lines.push(format!("  {name}: {found} of {runs} runs found"));
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

/// The claims, a line each.
fn summary(report: &Report) -> String {
    let line = |examination: &Examination| {
        let claim = &examination.experiment;
        let (verdict, title) = (examination.finding.verdict.name(), claim.prose.title());
        format!("{:<4} {verdict:<11} {}\n", claim.id, plain_text(title))
    };
    report.examinations.iter().map(line).collect()
}
