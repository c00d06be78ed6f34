//! `peristalsis render`: the tube as it looks.

use crate::Place;

#[test]
fn a_finished_run_is_drawn() {
    let place = Place::new();
    place.run_small(&["--out", "results"]).expect_code(0);
    let before = place.inventory();
    place
        .call(["render", "results", "--width", "300"])
        .expect_code(0)
        .shows(&["300 x ", "results/tube-side.png"]);
    place
        .call([
            "render",
            "results",
            "--view",
            "section",
            "--width",
            "64",
            "--out",
            "section.png",
        ])
        .expect_code(0)
        .shows(&["64 x 64 pixels: section.png"]);
    for file in ["results/tube-side.png", "section.png"] {
        let bytes = std::fs::read(place.path(file)).unwrap();
        assert!(
            bytes.starts_with(b"\x89PNG") && bytes.len() > 2_000,
            "{file}"
        );
    }
    for (name, content) in before {
        if content.is_some() {
            assert_eq!(place.inventory()[&name], content, "{}", name.display());
        }
    }
    place
        .call(["render", "nowhere"])
        .expect_code(2)
        .says(&["nowhere holds no run"]);
    place
        .call(["render", "results", "--width", "3"])
        .expect_code(2)
        .says(&["16..=16384"]);
}
