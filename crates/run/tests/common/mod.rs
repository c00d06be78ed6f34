//! Runs by preset and settings, for the tests of what must be seen.

#![allow(dead_code, reason = "each test takes what it needs")]

use peristalsis_engine::Kernel;
use peristalsis_run::{Configuration, Run, Status, Summary};

/// The configuration of a preset with settings over it.
pub(crate) fn configuration(preset: &str, settings: &[&str]) -> Configuration {
    Configuration::from_preset(preset, settings)
        .unwrap_or_else(|error| panic!("{settings:?}: {error}"))
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

/// Runs to the end on a kernel.
pub(crate) fn run(kernel: Kernel, preset: &str, settings: &[&str], seed: u64) -> Outcome {
    let more = [
        format!("run.kernel={}", name(kernel)),
        format!("run.seed={seed}"),
    ];
    let more = more.each_ref().map(String::as_str);
    let mut run = Run::new(configuration(preset, &[settings, &more].concat()))
        .expect("the grains of each case fit");
    assert_eq!(run.simulation().parameters().kernel, kernel);
    while !run.is_complete() {
        run.advance().expect("no case diverges");
    }
    Outcome {
        averages: run.recorder().averages().to_vec(),
        summary: Summary::of(&run, Status::Complete, None),
    }
}

/// Mean of the averages of periods `from` to `to`, counted from 1, both included.
pub(crate) fn mean(averages: &[f64], from: usize, to: usize) -> f64 {
    averages[from - 1..to].iter().sum::<f64>() / (to + 1 - from) as f64
}
