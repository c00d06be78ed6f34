//! Draws every kind of figure from made-up data into a folder: `cargo run --example gallery -- FOLDER`.

mod samples;

use std::error::Error;
use std::fs;
use std::path::PathBuf;

fn main() -> Result<(), Box<dyn Error>> {
    let folder = std::env::args().nth(1);
    let folder = PathBuf::from(folder.ok_or("which folder shall the figures go to?")?);
    fs::create_dir_all(&folder)?;
    for (name, drawing) in samples::all() {
        fs::write(folder.join(format!("{name}.svg")), drawing.svg())?;
        fs::write(folder.join(format!("{name}.png")), drawing.png()?)?;
    }
    Ok(())
}
