//! Writes a report of made-up findings into a folder, to look at: `cargo run -p peristalsis-reproduce --example specimen -- FOLDER`.

mod findings;

use std::error::Error;
use std::path::PathBuf;

fn main() -> Result<(), Box<dyn Error>> {
    let folder: PathBuf = std::env::args_os()
        .nth(1)
        .ok_or("which folder shall the report go to?")?
        .into();
    findings::specimen()?.write(&folder)?;
    Ok(())
}
