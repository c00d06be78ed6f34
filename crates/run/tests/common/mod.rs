//! Runs by preset and settings, for the tests of what must be seen.

#![allow(dead_code, reason = "each test takes what it needs")]

use peristalsis_engine::Kernel;
use peristalsis_run::{Configuration, Run, Status, Summary};

/// The configuration of a preset with settings over it, the words of a line.
pub(crate) fn configuration(preset: &str, settings: &str) -> Configuration {
    let words: Vec<&str> = settings.split_whitespace().collect();
    Configuration::from_preset(preset, &words).unwrap_or_else(|error| panic!("{settings}: {error}"))
}

/// What a whole run came to.
#[derive(Debug)]
pub(crate) struct Outcome {
    /// J/Jmax averaged over each period.
    pub(crate) averages: Vec<f64>,
    /// The summary.
    pub(crate) summary: Summary,
}

/// Checks a claim on each kernel, in a thread of the kernel's name, which stands in the message of what fails.
pub(crate) fn on_both_kernels(claim: impl Fn(Kernel) + Sync) {
    let claim = &claim;
    std::thread::scope(|scope| {
        for kernel in [Kernel::Fast, Kernel::Reference] {
            std::thread::Builder::new()
                .name(format!("kernel {}", name(kernel)))
                .spawn_scoped(scope, move || claim(kernel))
                .expect("the system gives two threads");
        }
    });
}

/// The name of a kernel in a configuration.
fn name(kernel: Kernel) -> &'static str {
    match kernel {
        Kernel::Fast => "fast",
        Kernel::Reference => "reference",
    }
}

/// A run at its end.
pub(crate) fn finish(mut run: Run) -> Run {
    while !run.is_complete() {
        run.advance().expect("no case diverges");
    }
    run
}

/// Runs to the end on a kernel.
pub(crate) fn run(kernel: Kernel, preset: &str, settings: &str, seed: u64) -> Outcome {
    let settings = format!("{settings} run.kernel={} run.seed={seed}", name(kernel));
    let run = Run::new(configuration(preset, &settings)).expect("the grains of each case fit");
    assert_eq!(run.simulation().parameters().kernel, kernel);
    let run = finish(run);
    Outcome {
        averages: run.recorder().averages().to_vec(),
        summary: Summary::of(&run, Status::Complete, None),
    }
}

/// Asserts that a value lies between bounds.
#[track_caller]
pub(crate) fn within(value: f64, least: f64, most: f64) {
    assert!(
        (least..=most).contains(&value),
        "{value} is not in {least} to {most}"
    );
}

/// Mean of the averages of periods `from` to `to`, counted from 1, both included.
pub(crate) fn mean(averages: &[f64], from: usize, to: usize) -> f64 {
    averages[from - 1..to].iter().sum::<f64>() / (to + 1 - from) as f64
}
