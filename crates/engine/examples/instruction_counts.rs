//! Advances one workload, for `scripts/instruction_counts.py` to have its instructions counted by callgrind.
//!
//! `instruction_counts WORKLOAD PATH` prints the grain-steps of the part that is counted, `instruction_counts --list` the
//! names of the workloads.
#![allow(clippy::print_stdout, clippy::print_stderr, reason = "a program")]

#[path = "../benches/workloads/mod.rs"]
mod workloads;

use std::process::ExitCode;

use peristalsis_engine::{EngineError, Simulation};

use workloads::{Path, Workload};

/// What is counted: callgrind is told the name of this function.
#[inline(never)]
fn counted_advance(simulation: &mut Simulation, steps: u64) -> Result<(), EngineError> {
    simulation.advance(steps)
}

fn count(workload: Workload, path: Path) -> Result<u64, EngineError> {
    let mut simulation = workload.simulation(path)?;
    counted_advance(&mut simulation, workload.steps())?;
    Ok(simulation.bodies().grains as u64 * workload.steps())
}

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    if arguments == ["--list"] {
        for workload in Workload::ALL {
            println!("{}", workload.name());
        }
        return ExitCode::SUCCESS;
    }
    let work = match arguments[..] {
        [workload, path] => Workload::ALL
            .into_iter()
            .find(|known| known.name() == workload)
            .zip(Path::ALL.into_iter().find(|known| known.name == path)),
        _ => None,
    };
    let Some((workload, path)) = work else {
        eprintln!("usage: instruction_counts --list | WORKLOAD reference|plain|avx2|avx512");
        return ExitCode::from(2);
    };
    if !path.instructions.available() {
        eprintln!("this machine has no {}", path.name);
        return ExitCode::from(3);
    }
    match count(workload, path) {
        Ok(grain_steps) => {
            println!("{grain_steps}");
            ExitCode::SUCCESS
        }
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}
