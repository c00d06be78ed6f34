//! `peristalsis`: grains in a peristaltic tube, from the command line.

#![forbid(unsafe_code)]

use std::process::ExitCode;

fn main() -> ExitCode {
    peristalsis_command::run(std::env::args_os())
}
