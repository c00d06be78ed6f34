//! The spheres as a table: with the wave running towards larger places, whichever way it runs in the engine.

mod common;

use peristalsis_run::{Run, snapshot_table};

#[test]
fn spheres_are_turned_along_the_wave() {
    for (preset, settings) in [
        ("frictionless", "grains.number=30 run.periods=0.5"),
        ("frictional", "grains.number=100 run.periods=0.1"),
        (
            "frictional",
            "grains.number=100 run.periods=0.1 drive.direction=backward",
        ),
    ] {
        let run = common::finish(Run::new(common::configuration(preset, settings)).unwrap());
        let table = snapshot_table(&run).unwrap();
        let simulation = run.simulation();
        let bodies = simulation.bodies();
        let (heading, length) = (simulation.wall().heading(), simulation.wall().length());
        let is_elastic = preset == "frictional";
        assert_eq!(
            heading > 0.0,
            is_elastic && !settings.contains("backward"),
            "{settings}"
        );
        let spheres = if is_elastic {
            bodies.number()
        } else {
            bodies.grains
        };
        assert_eq!(table.rows(), spheres);
        let column = |name: &str| table.reals(name).unwrap();
        let grain = table.booleans("grain").unwrap();
        assert_eq!(grain.len(), spheres);
        for (sphere, &is_grain) in grain.iter().enumerate() {
            assert_eq!(is_grain, sphere < bodies.grains);
            let position = bodies.position[sphere];
            let along = if heading > 0.0 {
                position.z
            } else {
                length - position.z
            };
            assert_eq!(column("along")[sphere], along);
            assert_eq!(
                column("across")[sphere].hypot(column("depth")[sphere]),
                position.y.hypot(position.x)
            );
            assert_eq!(column("diameter")[sphere], bodies.diameter[sphere]);
            assert_eq!(
                column("axial_velocity")[sphere],
                heading * bodies.velocity[sphere].z
            );
        }
    }
}
