//! `peristalsis study status` and `peristalsis study why`

use std::process::ExitCode;

use peristalsis_study::{Bracket, Finding, State, Store, Survey, brackets};
use serde_json::{Value, json};

use super::{StatusArguments, WhyArguments};
use crate::commands::{counted, print, print_report};
use crate::failure::Failure;

/// Runs that are named in words; more are counted.
const NAMED: usize = 10;

pub(crate) fn status(arguments: &StatusArguments) -> Result<ExitCode, Failure> {
    let store = Store::open(&arguments.store.store)?;
    let survey = store.survey()?;
    print_status(arguments.json, &store, &survey)
}

/// Prints the status, as JSON or for a person.
pub(super) fn print_status(
    as_json: bool,
    store: &Store,
    survey: &Survey,
) -> Result<ExitCode, Failure> {
    print_report(
        as_json,
        || report(store, survey),
        || in_words(store, survey),
    )
}

/// Where the flow changes its kind, of the runs that have ended.
fn estimates(survey: &Survey) -> Vec<Bracket> {
    brackets(&survey.study, &survey.plan, &|identity| {
        survey.finding(identity)
    })
}

/// The status as JSON.
fn report(store: &Store, survey: &Survey) -> Value {
    let estimates: Vec<Value> = estimates(survey)
        .iter()
        .map(|bracket| {
            json!({
                "key": bracket.key,
                "of": bracket.of,
                "lower": bracket.lower,
                "upper": bracket.upper,
                "estimate": bracket.middle(),
            })
        })
        .collect();
    let runs = survey.plan.sorted_runs().into_iter();
    let runs: Vec<Value> = runs
        .map(|run| {
            let entry = survey.entries.get(&run.identity);
            json!({
                "identity": run.identity.to_string(),
                "point": survey.plan.point(&run).in_words(),
                "replicate": run.replicate,
                "state": survey.state(run.identity),
                "reason": entry.and_then(|entry| entry.reason.as_ref()),
                "transition_time": entry.and_then(|entry| entry.transition_time),
            })
        })
        .collect();
    json!({
        "name": survey.study.name,
        "store": store.path().display().to_string(),
        "total": survey.plan.runs().len(),
        "counts": survey.counts(),
        "estimates": estimates,
        "runs": runs,
    })
}

/// The status for a person.
fn in_words(store: &Store, survey: &Survey) -> String {
    let mut text = format!("{} in {}\n", survey.study.name, store.path().display());
    let in_state = |(state, number): (State, usize)| format!("{number} {}", state.name());
    let counts: Vec<String> = survey.counts().into_iter().map(in_state).collect();
    let (runs, counts) = (counted(survey.plan.runs().len(), "run"), counts.join(", "));
    text.push_str(&format!("{runs}: {counts}"));
    let plan = survey.plan.runs().iter();
    let found: Vec<Finding> = plan
        .filter_map(|run| survey.finding(&run.identity))
        .collect();
    if !found.is_empty() {
        let is_transition = |finding: &&Finding| **finding == Finding::Transition;
        let transitions = found.iter().filter(is_transition).count();
        text.push_str(&format!("; {transitions} with a transition"));
    }
    text.push('\n');
    let others = survey.others();
    if others > 0 {
        text += &format!(
            "not part of the study as it stands: {}\n",
            counted(others, "finished run")
        );
    }
    for bracket in estimates(survey) {
        text += &format!("{}\n", estimate(&bracket));
    }
    let ended_badly: Vec<String> = survey
        .plan
        .sorted_runs()
        .iter()
        .filter_map(|run| {
            let state = survey.state(run.identity);
            let reason = survey.entries.get(&run.identity)?.reason.as_deref()?;
            matches!(state, State::Failed | State::Quarantined).then(|| {
                format!(
                    "{} {} ({}, replicate {}): {reason}\n",
                    state.name(),
                    &run.identity.to_string()[..8],
                    survey.plan.point(run).in_words(),
                    run.replicate
                )
            })
        })
        .collect();
    text.extend(ended_badly.iter().take(NAMED).map(String::as_str));
    if ended_badly.len() > NAMED {
        text.push_str(&format!("and {} more\n", ended_badly.len() - NAMED));
    }
    text
}

/// Between which values most runs change: no estimate with an error.
pub(super) fn estimate(bracket: &Bracket) -> String {
    let Bracket {
        key,
        of,
        lower,
        upper,
        has_transitions_below,
        ..
    } = bracket;
    let (with, without) = match has_transitions_below {
        true => (lower, upper),
        false => (upper, lower),
    };
    format!(
        "{of}: with {key} = {with} most runs have a transition, with {without} half of them or fewer"
    )
}

pub(crate) fn why(arguments: &WhyArguments) -> Result<ExitCode, Failure> {
    let store = Store::open(&arguments.store.store)?;
    let survey = store.survey()?;
    let identity = survey.run_beginning(&arguments.run)?;
    let mut lines = vec![format!("run         {identity}")];
    let plan = &survey.plan;
    match plan.runs().iter().find(|run| run.identity == identity) {
        Some(run) => {
            let point = plan.point(run).in_words();
            lines.push(format!("point       {point}, replicate {}", run.replicate));
            let seed = plan.configuration(run).run.seed;
            lines.push(format!("seed        {seed}"));
        }
        None => {
            lines.push("point       not part of the study as it stands".to_owned());
            if let Some(stale) = store.staleness(&survey, identity) {
                lines.push(format!("nearest     {}", stale.nearest));
                for difference in &stale.differences {
                    lines.push(format!("changed     {difference}"));
                }
            }
        }
    }
    let entry = survey.entries.get(&identity);
    let state = survey.state(identity);
    let reason = entry.and_then(|entry| entry.reason.clone());
    let meaning = match state {
        State::Pending => "nothing has been computed yet".to_owned(),
        State::Leased => survey.leases.get(&identity).cloned().unwrap_or_default(),
        State::Checkpointed => "interrupted; it goes on from its last saved state".to_owned(),
        State::Done => reason.unwrap_or_else(|| {
            "finished; its files agreed with their hashes when they were last checked".to_owned()
        }),
        State::Failed => reason.unwrap_or_default(),
        State::Quarantined => format!("{}; it will be computed again", reason.unwrap_or_default()),
    };
    lines.push(format!("state       {}: {meaning}", state.name()));
    if let Some(time) = entry.and_then(|entry| entry.transition_time) {
        lines.push(format!("transition  t = {time}"));
    }
    let folder = store.run_folder(identity);
    if folder.exists() {
        lines.push(format!("files       {}", folder.display()));
    }
    for folder in store.quarantines(identity) {
        let reason = std::fs::read_to_string(folder.join("reason.txt")).unwrap_or_default();
        let (folder, reason) = (folder.display(), reason.trim());
        lines.push(format!("moved aside {folder}: {reason}"));
    }
    print(&(lines.join("\n") + "\n"))
}
