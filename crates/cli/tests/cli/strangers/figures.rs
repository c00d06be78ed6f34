//! Figures of runs and of claims.

use crate::Place;

/// One sample was a line of one point, which cannot be seen.
#[test]
fn one_sample_is_seen_in_the_figure_of_the_flow() {
    let place = Place::new();
    let colour = |periods: &str| {
        place.does(&format!(
            "run SMALL run.periods={periods} --out p{periods} --quiet"
        ));
        let svg = std::fs::read_to_string(place.path(&format!("p{periods}/flow.svg"))).unwrap();
        // The marks of a series are filled, its line is not.
        svg.matches("fill=\"#56b4e9\"").count()
    };
    assert!(colour("0.05") > 0 && colour("0.1") == 0);
}

/// T_g had no unit, and tau meant the shear on the wall beside the time of the transition.
#[test]
fn a_profile_names_its_units_and_no_symbol_twice() {
    let place = Place::new();
    let settings = "grains.number=20 tube.waves=2 run.periods=0.1 observe.late_fraction=1";
    place.does(&format!(
        "run --preset frictional {settings} --out r --quiet"
    ));
    let svg = std::fs::read_to_string(place.path("r/profile.svg")).unwrap();
    for label in ["temperature, Tg/mc2", "pressure, p/Y", "shear, σ/Y"] {
        assert!(svg.contains(&format!("aria-label=\"{label}\"")), "{label}");
    }
    assert!(!svg.contains("τ"));
}

/// Folders that the report speaks of were not there.
#[test]
fn a_report_has_the_folders_that_it_promises() {
    let place = Place::new();
    place.does("reproduce --quick --only F3 --for 1s --out report --quiet");
    for folder in ["figures", "tables"] {
        assert!(place.path("report").join(folder).is_dir(), "{folder}");
    }
}
