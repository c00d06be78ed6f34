//! `peristalsis schema`

use std::process::ExitCode;

use crate::commands::print;
use crate::failure::Failure;

/// Prints the JSON schema of the configuration.
pub(crate) fn schema() -> Result<ExitCode, Failure> {
    let schema = peristalsis_configuration::schema();
    print(&format!("{schema:#}\n"))?;
    Ok(ExitCode::SUCCESS)
}
