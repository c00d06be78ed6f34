//! `peristalsis study plan`

use std::process::ExitCode;

use peristalsis_analysis::number::bytes;
use peristalsis_engine::processors;
use peristalsis_study::{Specification, State, Store, StudyError, StudyEstimate, study_estimate};
use serde_json::json;

use super::{PlanArguments, store_path};
use crate::commands::{counted, print_report};
use crate::failure::Failure;
use crate::progress::seconds;
use crate::sources;

pub(crate) fn plan(arguments: &PlanArguments) -> Result<ExitCode, Failure> {
    let study = sources::study(&arguments.file)?;
    let plan = study.plan();
    let estimate = study_estimate(&study, plan)?;
    let path = store_path(&arguments.store, &study);
    let finished = match Store::open_for(&path, &study) {
        Err(StudyError::NoStore { .. }) if arguments.store.is_none() || !path.exists() => 0,
        Err(error) => return Err(error.into()),
        Ok(store) => {
            let survey = store.survey()?;
            let states = plan.runs().iter().map(|run| survey.state(run.identity));
            states.filter(|state| *state == State::Done).count()
        }
    };
    let report = || {
        let runs = plan.sorted_runs().into_iter().map(|run| {
            json!({
                "identity": run.identity.to_string(),
                "point": plan.point(&run).in_words(),
                "replicate": run.replicate,
            })
        });
        json!({
            "name": study.name,
            "title": study.title,
            "estimate": estimate,
            "finished": finished,
            "runs": runs.collect::<Vec<_>>(),
        })
    };
    let words = || in_words(&study, &estimate, finished);
    print_report(arguments.json, report, words)
}

fn in_words(study: &Specification, estimate: &StudyEstimate, finished: usize) -> String {
    let mut lines = vec![format!("study             {}", study.name)];
    if !study.title.is_empty() {
        lines.push(format!("                  {}", study.title));
    }
    lines.push(format!(
        "runs              {}: {}, {} each",
        estimate.runs,
        counted(estimate.points, "point"),
        counted(study.replicates, "replicate")
    ));
    if estimate.refinement_runs > 0 {
        lines.push(format!(
            "refinement        up to {} more, where each change lies within one gap",
            counted(estimate.refinement_runs, "run")
        ));
    }
    if finished > 0 {
        lines.push(format!("finished          {finished}"));
    }
    lines.push(format!(
        "steps             {:.3e} ({:.3e} grain-steps)",
        estimate.steps as f64, estimate.grain_steps
    ));
    let processors = processors();
    let share = estimate.processor_seconds / estimate.runs.min(processors).max(1) as f64;
    let less = match study.stopping {
        Some(_) => ", less where runs end early",
        None => "",
    };
    let (whole, share) = (seconds(estimate.processor_seconds), seconds(share));
    lines.push(format!(
        "expected time     {whole} of one processor, {share} of {processors}{less}"
    ));
    lines.push(format!("disk              {}", bytes(estimate.bytes)));
    for warning in &estimate.warnings {
        let (key, message) = (&warning.warning.key, &warning.warning.message);
        let place = format!(
            "{} of {}",
            warning.points,
            counted(estimate.points, "point")
        );
        let first = &warning.first;
        lines.push(format!(
            "warning: {key}: at {place}, the first at {first}: {message}"
        ));
    }
    lines.join("\n") + "\n"
}
