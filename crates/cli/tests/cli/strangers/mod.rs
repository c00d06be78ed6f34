//! What users met who tried the program. What they met in the Python package is in `crates/python/tests/strangers`.

mod beginning;
mod figures;
mod going_on;
mod runs;
mod settings;
mod studies;
