//! What strangers met who tried the program: each row of their reports as a test. The rows on the Python package are in
//! `crates/python/tests/strangers`.

mod beginning;
mod figures;
mod going_on;
mod runs;
mod settings;
mod studies;
