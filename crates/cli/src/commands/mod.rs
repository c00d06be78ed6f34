//! One file a command.

pub(crate) mod check;
pub(crate) mod completions;
pub(crate) mod newtonian;
pub(crate) mod presets;
pub(crate) mod render;
pub(crate) mod reproduce;
pub(crate) mod run;
pub(crate) mod schema;
pub(crate) mod study;
pub(crate) mod trajectory;
pub(crate) mod validate;
pub(crate) mod view;

use std::io::Write;

use crate::failure::Failure;

/// Prints a line on standard error; where nobody reads it, it is lost, which no run should end for.
pub(crate) fn say(text: &str) {
    drop(writeln!(std::io::stderr().lock(), "{text}"));
}

/// Prints on standard output; a reader that has gone away is no failure.
fn print(text: &str) -> Result<(), Failure> {
    let mut output = std::io::stdout().lock();
    match output
        .write_all(text.as_bytes())
        .and_then(|()| output.flush())
    {
        Err(error) if error.kind() != std::io::ErrorKind::BrokenPipe => Err(Failure::Output(error)),
        _ => Ok(()),
    }
}
