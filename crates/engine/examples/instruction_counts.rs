//! Advances one workload, for `scripts/instruction_counts.py` to have its instructions counted by callgrind, and for
//! `scripts/bench_wasm.py` to time it.
//!
//! `instruction_counts WORKLOAD PATH [TIMES [THREADS]]` prints the grain-steps of the part that is counted, which is so many
//! times as long; `instruction_counts --list` the names of the workloads.
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

fn count(workload: Workload, path: Path, times: u64, threads: usize) -> Result<u64, EngineError> {
    let mut simulation = workload.simulation(path)?;
    simulation.compute_with(path.instructions, threads)?;
    let steps = workload.steps() * times;
    counted_advance(&mut simulation, steps)?;
    Ok(simulation.bodies().grains as u64 * steps)
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
    let times = arguments.get(2).map_or(Ok(1), |times| times.parse());
    let threads = arguments.get(3).map_or(Ok(1), |threads| threads.parse());
    let work = match arguments[..] {
        [workload, path] | [workload, path, _] | [workload, path, _, _] => Workload::ALL
            .into_iter()
            .find(|known| known.name() == workload)
            .zip(Path::all().find(|known| known.name == path)),
        _ => None,
    };
    let (Some((workload, path)), Ok(times), Ok(threads)) = (work, times, threads) else {
        eprintln!(
            "usage: instruction_counts --list | WORKLOAD reference|plain|avx2|... [TIMES [THREADS]]"
        );
        return ExitCode::from(2);
    };
    if !path.instructions.available() {
        eprintln!("this machine has no {}", path.name);
        return ExitCode::from(3);
    }
    match count(workload, path, times, threads) {
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
