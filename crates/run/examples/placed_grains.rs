//! A tube whose grains are put where a file says, followed frame by frame: for comparisons with other programs
//! (`validation/lammps/`), which must begin with the same bits.
//!
//! `placed_grains PRESET FRAMES STEPS [--from FILE] [KEY=VALUE ...]` writes FRAMES + 1 frames, STEPS steps apart, to
//! standard output: nine numbers a grain (position, velocity, angular velocity) as little-endian f64, raw as the engine
//! has them. FILE has ten numbers a line and a grain: the same nine and the diameter; without it the grains stand as
//! `peristalsis run` packs them.
#![allow(clippy::print_stderr, reason = "a program")]

use std::error::Error;
use std::io::{BufWriter, Write};
use std::process::ExitCode;

use glam::DVec3;
use peristalsis_engine::{Bodies, Simulation};
use peristalsis_run::{Configuration, Run, walls};

/// Numbers of a grain in a file to start from.
const COLUMNS: usize = 10;

struct Request {
    preset: String,
    frames: u64,
    steps: u64,
    from: Option<String>,
    settings: Vec<String>,
}

impl Request {
    fn parse(arguments: impl IntoIterator<Item = String>) -> Option<Self> {
        let mut arguments = arguments.into_iter();
        let mut request = Self {
            preset: arguments.next()?,
            frames: arguments.next()?.parse().ok()?,
            steps: arguments.next()?.parse().ok()?,
            from: None,
            settings: Vec::new(),
        };
        while let Some(word) = arguments.next() {
            if word == "--from" {
                request.from = Some(arguments.next()?);
            } else {
                request.settings.push(word);
            }
        }
        Some(request)
    }

    fn simulation(&self) -> Result<Simulation, Box<dyn Error>> {
        let run = Run::new(Configuration::from_preset(&self.preset, &self.settings)?)?;
        let packed = run.simulation();
        let Some(path) = &self.from else {
            return Ok(packed.clone());
        };
        let bodies = placed(&std::fs::read_to_string(path)?)?;
        let wall = walls(run.configuration());
        Ok(Simulation::new(bodies, wall, *packed.parameters()))
    }

    fn write(&self) -> Result<(), Box<dyn Error>> {
        let mut simulation = self.simulation()?;
        let mut output = BufWriter::new(std::io::stdout().lock());
        write_frame(&mut output, simulation.bodies())?;
        for _ in 0..self.frames {
            simulation.advance(self.steps)?;
            write_frame(&mut output, simulation.bodies())?;
        }
        Ok(output.flush()?)
    }
}

/// Grains as a text has them.
fn placed(text: &str) -> Result<Bodies, Box<dyn Error>> {
    let (mut places, mut velocities, mut spins, mut diameters) = (vec![], vec![], vec![], vec![]);
    for (number, line) in text.lines().enumerate() {
        let numbers = line
            .split_whitespace()
            .map(str::parse)
            .collect::<Result<Vec<f64>, _>>()?;
        let [x, y, z, u, v, w, p, q, r, diameter] = <[f64; COLUMNS]>::try_from(numbers)
            .map_err(|_| format!("line {}: not {COLUMNS} numbers", number + 1))?;
        places.push(DVec3::new(x, y, z));
        velocities.push(DVec3::new(u, v, w));
        spins.push(DVec3::new(p, q, r));
        diameters.push(diameter);
    }
    let mut bodies = Bodies::grains_at_rest(places, diameters);
    bodies.velocity = velocities;
    bodies.angular_velocity = spins;
    Ok(bodies)
}

fn write_frame(output: &mut impl Write, bodies: &Bodies) -> std::io::Result<()> {
    for grain in 0..bodies.grains {
        for vector in [
            bodies.position[grain],
            bodies.velocity[grain],
            bodies.angular_velocity[grain],
        ] {
            for component in vector.to_array() {
                output.write_all(&component.to_le_bytes())?;
            }
        }
    }
    Ok(())
}

fn main() -> ExitCode {
    let Some(request) = Request::parse(std::env::args().skip(1)) else {
        eprintln!("usage: placed_grains PRESET FRAMES STEPS [--from FILE] [KEY=VALUE ...]");
        return ExitCode::from(2);
    };
    match request.write() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}
