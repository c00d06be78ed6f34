//! `peristalsis study plan`

use std::process::ExitCode;

use peristalsis_study::{Specification, State, Store, StudyEstimate, study_estimate};

use super::{PlanArguments, usual_store};
use crate::commands::{print, print_json};
use crate::failure::Failure;
use crate::progress::seconds;

/// Says what a study would run.
pub(crate) fn plan(arguments: &PlanArguments) -> Result<ExitCode, Failure> {
    let study = Specification::read(&arguments.file)?;
    let plan = study.plan();
    let estimate = study_estimate(&study, plan)?;
    let store = arguments
        .store
        .clone()
        .unwrap_or_else(|| usual_store(&study.name));
    let finished = match Store::open(&store) {
        Err(_) if arguments.store.is_none() => 0,
        Err(error) => return Err(error.into()),
        Ok(store) => {
            let survey = store.survey()?;
            plan.runs()
                .iter()
                .filter(|run| survey.state(run.identity) == State::Done)
                .count()
        }
    };
    if arguments.json {
        let runs: Vec<_> = plan
            .sorted_runs()
            .iter()
            .map(|run| {
                serde_json::json!({
                    "identity": run.identity.to_string(),
                    "point": plan.point(run).in_words(),
                    "replicate": run.replicate,
                })
            })
            .collect();
        let report = serde_json::json!({
            "name": study.name,
            "title": study.title,
            "estimate": estimate,
            "finished": finished,
            "runs": runs,
        });
        print_json(&report)?;
    } else {
        print(&in_words(&study, &estimate, finished))?;
    }
    Ok(ExitCode::SUCCESS)
}

fn in_words(study: &Specification, estimate: &StudyEstimate, finished: usize) -> String {
    let mut lines = vec![format!("study             {}", study.name)];
    if !study.title.is_empty() {
        lines.push(format!("                  {}", study.title));
    }
    lines.push(format!(
        "runs              {}: {} points, {} replicates each",
        estimate.runs, estimate.points, study.replicates
    ));
    if estimate.refinement_runs > 0 {
        lines.push(format!(
            "refinement        up to {} runs more, where each change lies within one gap",
            estimate.refinement_runs
        ));
    }
    if finished > 0 {
        lines.push(format!("finished          {finished}"));
    }
    lines.push(format!(
        "steps             {:.3e} ({:.3e} of a grain)",
        estimate.steps as f64, estimate.grain_steps
    ));
    let processors = std::thread::available_parallelism().map_or(1, |number| number.get());
    let share = estimate.processor_seconds / estimate.runs.min(processors).max(1) as f64;
    lines.push(format!(
        "expected time     {} of one processor, {} of {processors}{}",
        seconds(estimate.processor_seconds),
        seconds(share),
        if study.stopping.is_some() {
            ", less where runs end early"
        } else {
            ""
        }
    ));
    lines.push(format!("disk              {}", bytes(estimate.bytes)));
    for warning in &estimate.warnings {
        lines.push(format!(
            "warning: {}: at {} of {} points, the first at {}: {}",
            warning.warning.key,
            warning.points,
            estimate.points,
            warning.first,
            warning.warning.message
        ));
    }
    lines.join("\n") + "\n"
}

/// A number of bytes in words.
fn bytes(number: f64) -> String {
    for (factor, unit) in [(1e12, "TB"), (1e9, "GB"), (1e6, "MB")] {
        if number >= factor {
            return format!("{:.1} {unit}", number / factor);
        }
    }
    format!("{:.0} kB", number / 1e3)
}
