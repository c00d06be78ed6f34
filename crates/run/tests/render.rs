//! Pictures of runs: what is red flows along the wave, what is blue against it, and the wall stands around.

#![allow(
    clippy::unwrap_used,
    reason = "a test fails where what it needs is missing"
)]

mod common;

use peristalsis_run::{Aspect, Picture, Run, picture};

/// Pixels of the side view that are clearly red, and clearly blue.
fn colours(picture: &Picture) -> (usize, usize) {
    let (mut red, mut blue) = (0, 0);
    for row in 0..picture.height() {
        for column in 0..picture.width() {
            let [r, _, b] = picture.pixel(column, row).map(i32::from);
            red += usize::from(r > b + 60);
            blue += usize::from(b > r + 60);
        }
    }
    (red, blue)
}

#[test]
fn jammed_grains_are_red_whichever_way_the_wave_runs() {
    for direction in ["forward", "backward"] {
        let direction = format!("drive.direction={direction}");
        let settings = [
            &*direction,
            "initial.state=jammed",
            "tube.waves=2",
            "grains.number=60",
        ];
        let run = Run::new(common::configuration("frictionless", &settings)).unwrap();
        let side = picture(&run, Aspect::Side, 400).unwrap();
        let (red, blue) = colours(&side);
        assert!(red > 2_000 && blue == 0, "{red} red and {blue} blue pixels");
        // White beside the tube, and the wall at the middle of its upper edge.
        assert_eq!(side.pixel(0, 0), [255; 3]);
        let wall = (0..side.height()).map(|row| side.pixel(200, row));
        let first = wall.into_iter().find(|pixel| pixel[0] < 230).unwrap();
        assert!(
            first.iter().max().unwrap() - first.iter().min().unwrap() < 40,
            "{first:?}"
        );
    }
}

#[test]
fn grains_that_flow_against_the_wave_are_blue() {
    let settings = [
        "initial.state=jammed",
        "initial.axial_velocity=-0.05",
        "grains.number=300",
    ];
    let run = Run::new(common::configuration("frictional", &settings)).unwrap();
    let (red, blue) = colours(&picture(&run, Aspect::Side, 400).unwrap());
    assert!(blue > 500 && red == 0, "{red} red and {blue} blue pixels");
    let section = picture(&run, Aspect::Section, 120).unwrap();
    assert_eq!((section.width(), section.height()), (120, 120));
}

#[test]
fn a_static_wave_has_no_speed_to_compare_with_and_no_grains_are_no_failure() {
    let settings = ["drive.strain_rate=0", "run.duration=5", "grains.number=0"];
    let run = Run::new(common::configuration("frictionless", &settings)).unwrap();
    let side = picture(&run, Aspect::Side, 200).unwrap();
    assert_eq!(colours(&side), (0, 0));
    assert!(
        picture(&run, Aspect::Side, 0)
            .unwrap_err()
            .to_string()
            .contains("pixels")
    );
}
