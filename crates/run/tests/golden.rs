//! The bits of runs, against those on record: every preset, law, waveform and drive, with every kernel, integrator and set
//! of instructions. A change of structure changes none of them.
//!
//! `UPDATE_EXPECT=1 cargo test -p peristalsis-run --test golden` writes the record anew. Where that is right because
//! trajectories have changed, raise `PHYSICS_VERSION`.

#![allow(clippy::unwrap_used, reason = "what is missing fails the test")]

mod common;

use std::fmt::Write;

use expect_test::expect_file;
use peristalsis_engine::Instructions;
use peristalsis_formats::{Table, csv, hexadecimal};
use peristalsis_run::{Run, profile_table, snapshot_table, timeseries_table, waves_table};
use sha2::{Digest, Sha256};

/// Name, preset and settings. All are small and short.
const CASES: &str = "
frictionless | frictionless | tube.waves=2 grains.number=60 run.periods=3
fine | frictionless-fine | tube.waves=1 grains.number=40 run.periods=2
frictional | frictional | tube.waves=2 grains.number=150 run.periods=0.2
wide | frictionless | tube.radius=4 tube.spheres_per_ring=36 drive.width=5 tube.waves=1 grains.number=300 run.periods=1
hertz under strain control | frictionless | tube.waves=1 grains.number=30 run.periods=1 contact.law=hertz contact.young_modulus=1 contact.poisson_ratio=0.5 contact.dissipation_time=0.1
friction under strain control | frictionless | tube.waves=1 grains.number=30 run.periods=1 contact.static_friction=0.5 contact.tangential_stiffness=0.5
two sizes | frictionless | tube.waves=1 grains.number=30 run.periods=1 grains.diameter_min=0.7
roller | frictionless | tube.waves=1 grains.number=30 run.periods=1 drive.waveform=roller
bolus | frictionless | tube.waves=1 grains.number=30 run.periods=1 drive.waveform=bolus
jammed | frictionless | tube.waves=1 grains.number=30 run.periods=1 initial.state=jammed
back pressure | frictionless | tube.waves=1 grains.number=30 run.periods=1 drive.body_force=-0.001 drive.direction=backward
settled under gravity | frictionless | tube.waves=1 grains.number=30 run.periods=1 body.gravity=[0.001,-0.002,0.0005] initial.state=settled
frictional grains settled under gravity | frictionless | tube.waves=1 grains.number=30 run.periods=1 body.gravity=[0,-0.002,0] initial.state=settled drive.width=1.8 contact.static_friction=0.5 contact.tangential_stiffness=0.5
segments | frictionless | tube.waves=1 grains.number=20 run.periods=1 drive.waveform=segments drive.width=2.2 drive.order=[1,3,2,4]
ramp | frictionless | tube.waves=1 grains.number=30 run.periods=2 drive.schedule={form='ramp',parameter='width',from=3.0,to=2.6,end=1.5}
frictionless grains in the elastic tube | frictional | tube.waves=2 grains.number=100 run.periods=0.1 contact.static_friction=0 contact.kinetic_friction=0 initial.state=rest
drive by the present angle | frictional | tube.waves=2 grains.number=60 run.periods=0.1 drive.angle=current wall.drag=0.01 wall.spring_damping=0.01 wall.keep.net_force=removed_per_ring contact.sliding=balance contact.dissipation_form=printed
linear law in the elastic tube | frictional | tube.waves=2 grains.number=60 run.periods=0.1 contact.law=linear contact.normal_stiffness=1 contact.normal_damping=0.1 contact.sliding=literal wall.keep.net_force=free wall.keep.radial=0.001
";

/// Columns that came after the record, by how their names begin: left out, so that it shows the others to be as they were.
const LATER: [&str; 8] = [
    "axial_mixing",
    "radial_mixing",
    "radial_segregation",
    "belly_segregation",
    "height_segregation",
    "wall_wear",
    "mean_diameter",
    "mass_flow_rate",
];

fn of_the_record(table: &Table) -> Table {
    let is_old = |name: &str| !LATER.iter().any(|it| name.starts_with(it));
    let columns = table.columns().iter().filter(|it| is_old(&it.name));
    let old = Table::builder().columns(columns.cloned());
    let metadata = table.metadata().iter();
    metadata
        .fold(old, |old, (key, value)| old.metadata(key, value))
        .build()
        .unwrap()
}

/// SHA-256 of the time series, the profile, the flow of each wave and the spheres at the end.
fn digest(preset: &str, settings: &str, instructions: Instructions) -> String {
    let mut run = Run::new(common::configuration(preset, settings)).unwrap();
    run.compute_with(instructions, 1).unwrap();
    let run = common::finish(run);
    let mut digest = Sha256::new();
    for table in [timeseries_table, profile_table, waves_table, snapshot_table] {
        digest.update(csv::encode(&of_the_record(&table(&run).unwrap())));
    }
    hexadecimal(&digest.finalize()[..8])
}

/// The cells of a line.
fn cells(line: &str) -> [&str; 3] {
    let cells: Vec<&str> = line.split(" | ").collect();
    cells.try_into().unwrap()
}

#[test]
fn runs_have_the_bits_on_record() {
    let mut found = String::new();
    for case in CASES.trim().lines() {
        let [name, preset, settings] = cells(case);
        for integrator in ["verlet", "adams_bashforth"] {
            for kernel in ["fast", "reference"] {
                let settings =
                    format!("{settings} run.integrator={integrator} run.kernel={kernel}");
                let plain = digest(preset, &settings, Instructions::Plain);
                writeln!(found, "{plain} {name}, {integrator}, {kernel}").unwrap();
                if kernel == "reference" {
                    continue;
                }
                for set in Instructions::here().filter(|&set| set != Instructions::Plain) {
                    let other = digest(preset, &settings, set);
                    assert_eq!(other, plain, "{name}, {integrator}: {set:?}");
                }
            }
        }
    }
    // The whole path, for WebAssembly knows no variables of the environment.
    expect_file![concat!(env!("CARGO_MANIFEST_DIR"), "/tests/golden.txt")].assert_eq(&found);
}
