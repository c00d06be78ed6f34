//! Identities: the same where the products are the same, another where anything that determines them differs.

use std::collections::BTreeMap;

use peristalsis_study::{Identity, Plan};

use crate::{SMALL, bits, plan};

/// Identity and seed of every run, by its point in words and its replicate.
fn runs(plan: &Plan) -> BTreeMap<(String, u32), (Identity, u64)> {
    plan.runs()
        .iter()
        .map(|run| {
            let point = plan.point(run).in_words();
            let seed = plan.configuration(run).run.seed;
            ((point, run.replicate), (run.identity, seed))
        })
        .collect()
}

#[test]
fn points_and_replicates_that_are_added_change_no_other_run() {
    let before = runs(&plan(SMALL));
    let more = SMALL
        .replace("[2.5, 2.8]", "[2.9, 2.65, 2.8, 2.5]")
        .replace("replicates = 3", "replicates = 5");
    let after = runs(&plan(&more));
    assert_eq!(after.len(), 20);
    for (run, identity) in &before {
        assert_eq!(after[run], *identity, "{run:?}");
    }
    let distinct: std::collections::BTreeSet<_> = after.values().collect();
    assert_eq!(distinct.len(), 20);
}

#[test]
fn the_identity_is_that_of_the_run_and_not_of_the_study() {
    let one = runs(&plan(SMALL));
    // Another name, another way to say the same: amplitude for width, a range for a list, keys in another order.
    let other = SMALL
        .replace("\"small\"", "\"another\"")
        .replace(
            "key = \"drive.width\"\nvalues = [2.5, 2.8]",
            "key = \"drive.amplitude\"\nvalues = [0.25]",
        )
        .replace(
            "grains.number = 20\ntube.waves = 2",
            "tube.waves = 2\ngrains.number = 20",
        );
    let other = runs(&plan(&other));
    for replicate in 0..3 {
        assert_eq!(
            one[&("drive.width 2.5, from rest".to_owned(), replicate)],
            other[&("drive.amplitude 0.25, from rest".to_owned(), replicate)]
        );
    }
}

#[test]
fn whatever_determines_the_products_makes_another_run() {
    let base = runs(&plan(SMALL));
    let changes = [
        ("run.periods = 12", "run.periods = 13", true),
        (
            "run.periods = 12",
            "run.periods = 12\nobserve.samples_per_period = 10",
            true,
        ),
        (
            "run.periods = 12",
            "run.periods = 12\nobserve.transition_threshold = 0.4",
            true,
        ),
        ("grains.number = 20", "grains.number = 21", false),
        ("[[axes]]", "[stop]\nsettled_periods = 5\n[[axes]]", true),
        ("[[axes]]", "[record]\nprofile = false\n[[axes]]", true),
        ("[[axes]]", "[record]\nwaves = true\n[[axes]]", true),
        ("[[axes]]", "[record]\nsnapshot = true\n[[axes]]", true),
        ("[[axes]]", "[record]\ncolumns = [\"time\"]\n[[axes]]", true),
    ];
    for (from, to, same_seed) in changes {
        let other = runs(&plan(&SMALL.replace(from, to)));
        for (run, (identity, seed)) in &base {
            assert_ne!(other[run].0, *identity, "{to}");
            // Length and measurement leave the trajectory, and so the random numbers, as they are.
            assert_eq!(other[run].1 == *seed, same_seed, "{to}");
        }
    }
    // What is not kept unless asked for makes no other run by being said not to be.
    let without = "[record]\nwaves = false\nsnapshot = false\nprofile = true\n[[axes]]";
    assert_eq!(runs(&plan(&SMALL.replace("[[axes]]", without))), base);
    // All columns by name, in any order, are all columns.
    let all: Vec<String> = peristalsis_observe::COLUMNS
        .iter()
        .rev()
        .map(|column| format!("{:?}", column.quantity.name))
        .collect();
    let all = format!("[record]\ncolumns = [{}]\n[[axes]]", all.join(", "));
    assert_eq!(runs(&plan(&SMALL.replace("[[axes]]", &all))), base);
}

#[test]
fn an_option_that_is_absent_is_not_part_of_the_identity() {
    let base = runs(&plan(SMALL));
    let said = SMALL.replace(
        "[base]",
        "[base]\ndrive.body_force = 0.0\ndrive.waveform = \"sine\"",
    );
    assert_eq!(runs(&plan(&said)), base);
    for said in [
        "drive.body_force = -0.001",
        "drive.waveform = \"roller\"",
        "units = { grain_diameter = 1e-3, density = 2500.0, stiffness = 1.0 }",
    ] {
        let other = runs(&plan(&SMALL.replace("[base]", &format!("[base]\n{said}"))));
        for (run, (identity, _)) in &base {
            assert_ne!(other[run].0, *identity, "{said}");
        }
    }
}

#[test]
fn identities_are_what_they_were_when_this_version_of_the_physics_began() {
    let runs = runs(&plan(SMALL));
    let (identity, seed) = runs[&("drive.width 2.5, from rest".to_owned(), 0)];
    assert_eq!(identity.to_string(), "6cfe56128ac4a577ca899e20c3a2362b");
    assert_eq!(seed, 6_595_242_047_793_466_227);
}

/// If this fails, the same configuration and seed have come to other results: raise `PHYSICS_VERSION`, so that no store
/// takes runs of the old physics for those of the new, and then pin what is found here.
#[test]
fn results_are_what_the_version_of_the_physics_says() {
    let place = crate::Place::new(&SMALL.replace("replicates = 3", "replicates = 1"));
    place.complete();
    let rows = place.store().rows().unwrap();
    let bits = |name: &str| bits(rows.reals(name).unwrap());
    assert_eq!(peristalsis_study::PHYSICS_VERSION, 2);
    assert_eq!(
        bits("flow_rate_ratio_raw"),
        [4_597_303_830_775_812_752, 4_581_706_671_364_923_495]
    );
    assert_eq!(
        bits("granular_temperature"),
        [4_591_154_630_591_809_099, 4_579_387_263_405_384_545]
    );
}
