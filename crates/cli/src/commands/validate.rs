//! `peristalsis validate`

use std::cell::{Cell, RefCell};
use std::process::ExitCode;
use std::time::Instant;

use peristalsis_reproduce::textbook::{CASES, Case, Validation, chosen};
use peristalsis_reproduce::{Examination, ReproduceError, Size};

use crate::arguments::ValidateArguments;
use crate::commands::{code_of, counted, print, say_if_replaced, tell};
use crate::failure::Failure;
use crate::progress::{LastLine, seconds};
use crate::stop::Stop;

pub(crate) fn validate(arguments: &ValidateArguments) -> Result<ExitCode, Failure> {
    let stop = Stop::watch()?;
    let quick = arguments.quick;
    let size = if quick { Size::Quick } else { Size::Full };
    let cases = chosen(CASES, &arguments.only)?;
    // A document without places for the results is better refused before the work than after it.
    if let Some(document) = &arguments.write {
        Validation::check_places(document, &cases)?;
    }
    let tell = |text: &str| tell(arguments.quiet, text);
    tell(&format!(
        "{}, {}, in {}",
        counted(cases.len(), "case"),
        size.name(),
        arguments.out.display()
    ));
    stop.keep_results();
    let began = Cell::new(Instant::now());
    let (ended, said) = (Cell::new(0), RefCell::new(LastLine::now(0)));
    // Asked often, and so the one to say what takes long.
    let stops = || {
        let is_silent = said.borrow().is_old();
        if let Some(case) = cases.get(ended.get()).filter(|_| is_silent) {
            said.replace(LastLine::now(0));
            let took = seconds(began.get().elapsed().as_secs_f64());
            let number = ended.get() + 1;
            let of = cases.len();
            tell(&format!(
                "case {number} of {of}, {}, for {took} so far",
                case.name
            ));
        }
        stop.requested().is_some()
    };
    let outcome = Validation::run(size, &cases, &stops, &mut |examination| {
        let took = seconds(began.get().elapsed().as_secs_f64());
        tell(&format!("{} ({took})", line(examination)));
        for failed in failures(examination) {
            tell(&format!("  {failed}"));
        }
        began.set(Instant::now());
        ended.set(ended.get() + 1);
        said.replace(LastLine::now(0));
    });
    let validation = match outcome {
        Err(ReproduceError::Stopped) => {
            tell("stopped, nothing is written");
            return Ok(ExitCode::from(stop.requested().unwrap_or(1)));
        }
        outcome => outcome?,
    };
    if !arguments.quiet {
        say_if_replaced(&arguments.out.join("validation.json"));
    }
    validation.write(&arguments.out)?;
    if let Some(document) = &arguments.write {
        validation.write_into(document, CASES)?;
    }
    if arguments.json {
        print(&validation.json())?;
    } else {
        let lines: Vec<String> = validation.examinations.iter().map(line).collect();
        print(&format!("{}\n", lines.join("\n")))?;
        print(&format!("results: {}\n", arguments.out.display()))?;
    }
    Ok(code_of(validation.passed()))
}

/// A case in one line.
fn line(examination: &Examination<Case>) -> String {
    let finding = &examination.finding;
    let passed = examination.passed();
    let verdict = if passed { "passed" } else { "failed" };
    let checks = counted(finding.checks.len(), "check");
    let orders = counted(finding.convergences.len(), "order");
    let name = &examination.experiment.name;
    format!("{name:<15} {verdict}  {checks}, {orders}")
}

/// The failed parts of a case, a line each.
fn failures(examination: &Examination<Case>) -> Vec<String> {
    let finding = &examination.finding;
    let mut failures: Vec<String> = examination.failure.iter().cloned().collect();
    for check in finding.checks.iter().filter(|check| !check.passed) {
        failures.push(format!(
            "{} ({}): {} instead of {}, a deviation of {:.1e} where {:.1e} is allowed",
            check.quantity,
            check.setting,
            check.found,
            check.expected,
            check.deviation,
            check.tolerance
        ));
    }
    for convergence in finding.convergences.iter().filter(|it| !it.passed) {
        let [least, most] = convergence.expected_order;
        let order = convergence.order.unwrap_or(f64::NAN);
        failures.push(format!(
            "{} ({}): order {order:.2}, not from {least} to {most}",
            convergence.quantity, convergence.setting
        ));
    }
    failures
}
