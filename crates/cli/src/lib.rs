//! `peristalsis`: grains in a peristaltic tube, from the command line; as a library, for the program and for Python's.
//!
//! Parses, calls, reports: this is the only crate that prints or exits. Results go to standard output, everything else
//! to standard error. Exit codes: 0 done, 1 failed or diverged, 2 bad input, 3 a run computed again differs from its published row, 129,
//! 130, 138 and 143 stopped by a signal.

#![forbid(unsafe_code)]

mod arguments;
pub mod choice;
mod commands;
mod failure;
mod progress;
mod sources;
mod stop;

pub use sources::not_of_one_run;

use std::ffi::OsString;
use std::process::ExitCode;

use clap::Parser;

use arguments::{Arguments, Command};

/// Does what a command line asks for, its first word the program's name, and answers the exit code. Words that cannot be,
/// and those that ask for help, end the process.
pub fn run(words: impl IntoIterator<Item = OsString>) -> ExitCode {
    let arguments = Arguments::parse_from(words);
    let outcome = stop::outlive_limits_of_files().and_then(|()| match arguments.command {
        Command::Run(arguments) => commands::run::run(&arguments),
        Command::Runs(arguments) => commands::runs::runs(&arguments),
        Command::Figures(arguments) => commands::figures::figures(&arguments),
        Command::Check(arguments) => commands::check::check(&arguments),
        Command::Design(arguments) => commands::design::design(&arguments),
        Command::Trajectory(arguments) => commands::trajectory::trajectory(&arguments),
        Command::Render(arguments) => commands::render::render(&arguments),
        Command::View(arguments) => commands::view::view(&arguments),
        Command::Presets(arguments) => commands::presets::presets(&arguments),
        Command::Schema(arguments) => commands::schema::schema(arguments),
        Command::Newtonian(arguments) => commands::newtonian::newtonian(&arguments),
        Command::Reproduce(arguments) => commands::reproduce::reproduce(&arguments),
        Command::Validate(arguments) => commands::validate::validate(&arguments),
        Command::Study(command) => commands::study::study(&command),
        Command::Completions(arguments) => commands::completions::completions(&arguments),
    });
    match outcome {
        Ok(code) => code,
        Err(failure) => failure.report(),
    }
}
