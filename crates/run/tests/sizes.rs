//! Runs of grains of many sizes: packed, read from a file, and waiting outside.

mod common;

use common::configuration;
use glam::DVec3;
use peristalsis_run::{Configuration, PlacedGrains, Run};

const SIZES: [&str; 3] = [
    "grains.sizes=lognormal grains.diameter_spread=0.2",
    "grains.sizes=two grains.large_fraction=0.25",
    "grains.sizes=uniform",
];
const BOUNDS: &str = "tube.waves=2 grains.diameter_min=0.7 grains.diameter_max=1.1 drive.width=3.0";

fn diameters(run: &Run) -> &[f64] {
    let bodies = run.simulation().bodies();
    &bodies.diameter[..bodies.grains]
}

#[test]
fn every_distribution_is_packed() {
    for sizes in SIZES {
        let run = Run::new(configuration("frictionless", &format!("{BOUNDS} {sizes}"))).unwrap();
        let found = diameters(&run);
        assert!(found.iter().all(|it| (0.7..=1.1).contains(it)), "{sizes}");
        let distribution = run.configuration().grains.distribution();
        let mean = found.iter().sum::<f64>() / found.len() as f64;
        let scatter = 0.2 / (found.len() as f64).sqrt();
        assert!(
            (mean - distribution.mean(1)).abs() < 3.0 * scatter,
            "{sizes}: {mean}"
        );
        let [least, largest] = [f64::min, f64::max].map(|of| found.iter().copied().fold(1.0, of));
        assert!(largest - least > 0.2, "{sizes}: {least} to {largest}");
    }
}

#[test]
fn a_table_of_sizes_is_packed_from_its_file() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(
        folder.path().join("sizes.csv"),
        "diameter,fraction\n0.7,3\n1.0,1\n",
    )
    .unwrap();
    let text = "preset = \"frictionless\"\ntube.waves = 4\n[grains]\nsizes = \"table\"\nfile = \"sizes.csv\"\n\
                volume_fraction = 0.15\n";
    let path = folder.path().join("tube.toml");
    std::fs::write(&path, text).unwrap();
    let read = Configuration::from_toml(path.to_str().unwrap(), text).unwrap();
    let run = Run::new(read).unwrap();
    let found = diameters(&run);
    let large = found.iter().filter(|it| **it == 1.0).count();
    let small = found.iter().filter(|it| **it == 0.7).count();
    assert_eq!(small + large, found.len());
    // A quarter within three errors.
    let number = found.len() as f64;
    assert!(
        (large as f64 - 0.25 * number).abs() < 3.0 * (0.1875 * number).sqrt(),
        "{large} of {number}"
    );
}

/// Those that wait behind placed grains are those that wait behind packed ones.
#[test]
fn waiting_grains_of_a_placed_start_have_sizes_of_their_distribution() {
    let open = "tube.ends=open inlet.waiting=40 drive.body_force=0.002 grains.number=41";
    for sizes in SIZES {
        let words = format!("{BOUNDS} {sizes} {open}");
        let packed = Run::new(configuration("frictionless", &words)).unwrap();
        let grains = PlacedGrains {
            positions: vec![DVec3::new(0.0, 0.0, 5.0)],
            velocities: vec![DVec3::ZERO],
            diameters: vec![1.0],
        };
        let words = format!("{words} initial.state=placed");
        let placed = Run::placed(configuration("frictionless", &words), grains).unwrap();
        assert_eq!(diameters(&placed)[0], 1.0);
        assert_eq!(diameters(&placed)[1..], diameters(&packed)[1..], "{sizes}");
        let first = diameters(&placed)[1];
        assert!(
            diameters(&placed)[2..].iter().any(|it| *it != first),
            "{sizes}"
        );
    }
}
