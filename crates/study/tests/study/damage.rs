//! Damaged files: found, moved aside, computed again to the same bytes. And files of which only the
//! time has changed: left alone.

use std::fs;
use std::path::PathBuf;
use std::time::{Duration, SystemTime};

use peristalsis_study::{State, Store, work_on};

use crate::{Place, SMALL, TWO_WORKERS, entries, flip, seal_times};

#[test]
fn a_bit_that_flipped_in_any_product_is_found_and_computed_again() {
    let place = Place::new(&SMALL.replace("[[axes]]", "[record]\nwaves = true\n[[axes]]"));
    place.complete();
    let tables = place.tables();
    let products = [
        "timeseries.parquet",
        "waves.parquet",
        "summary.json",
        "row.csv",
        "config.toml",
        "done.json",
    ];
    let folders = place.run_folders();
    assert_eq!(folders.len(), products.len());
    for (index, (folder, product)) in folders.iter().zip(products).enumerate() {
        flip(&folder.join(product), index as f64 / 5.0);
    }
    let found = place.store().scan().unwrap();
    assert_eq!((found.whole, found.quarantined.len()), (0, 6), "{found:?}");
    for ((identity, reason), (folder, product)) in
        found.quarantined.iter().zip(folders.iter().zip(products))
    {
        assert!(folder.ends_with(identity.to_string()));
        assert!(reason.contains(product), "{product}: {reason}");
        assert!(!folder.exists());
        // Moved aside, with the reason, and not deleted.
        let aside = &place.store().quarantines(*identity)[0];
        assert!(aside.join(product).exists());
        let kept = fs::read_to_string(aside.join("reason.txt")).unwrap();
        assert_eq!(kept.trim(), reason);
        let survey = place.store().survey().unwrap();
        assert_eq!(survey.state(*identity), State::Quarantined);
    }
    place.complete();
    assert_eq!(place.tables(), tables);
    assert_eq!(place.store().scan().unwrap().whole, 6);
}

#[test]
fn a_snapshot_is_kept_where_it_is_asked_for_and_guarded_like_the_rest() {
    let place = Place::new(&SMALL.replace("[[axes]]", "[record]\nsnapshot = true\n[[axes]]"));
    place.complete();
    for folder in place.run_folders() {
        let table = peristalsis_formats::parquet::read(&folder.join("snapshot.parquet")).unwrap();
        // The wall is prescribed: grains only.
        assert_eq!(table.rows(), 20);
        assert!(table.booleans("grain").unwrap().iter().all(|grain| *grain));
    }
    flip(&place.run_folders()[0].join("snapshot.parquet"), 0.5);
    assert_eq!(place.store().scan().unwrap().quarantined.len(), 1);
    let without = Place::new(SMALL);
    without.complete();
    assert!(!without.run_folders()[0].join("snapshot.parquet").exists());
}

#[test]
fn damage_is_found_when_work_goes_on_and_when_tables_are_written() {
    let place = Place::new(SMALL);
    place.complete();
    let tables = place.tables();
    flip(&place.run_folders()[2].join("timeseries.parquet"), 0.5);
    fs::remove_file(place.run_folders()[3].join("row.csv")).unwrap();
    fs::remove_dir_all(&place.run_folders()[4]).unwrap();
    let news = place.complete();
    assert_eq!(news.len(), 3, "{news:?}");
    assert_eq!(place.tables(), tables);

    let folder = &place.run_folders()[1];
    flip(&folder.join("profile.parquet"), 0.7);
    let exported = place.store().export(&place.path("partial"), false).unwrap();
    assert_eq!((exported.rows, exported.missing), (5, 1));
    assert!(folder.ends_with(exported.quarantined[0].0.to_string()));
    place.complete();
    assert_eq!(place.tables(), tables);

    // Without its seal a run is not finished: its files stay, and an archive does without it.
    let folder = &place.run_folders()[0];
    fs::remove_file(folder.join("done.json")).unwrap();
    let packed = place.store().pack(&place.path("runs.tar")).unwrap();
    assert_eq!((packed.runs, packed.refused.len()), (5, 1));
    let exported = place.store().export(&place.path("partial"), false).unwrap();
    let [(_, reason)] = &exported.quarantined[..] else {
        panic!("{:?}", exported.quarantined);
    };
    assert!(reason.contains("done.json"), "{reason}");
    assert!(folder.join("row.csv").is_file());
    place.complete();
    assert_eq!(place.tables(), tables);
}

#[test]
fn a_file_whose_time_changed_is_as_good_as_before() {
    let place = Place::new(SMALL);
    place.complete();
    let time = SystemTime::now() - Duration::from_secs(1_000_000);
    for path in place.run_files() {
        let file = fs::File::options().write(true).open(path).unwrap();
        file.set_modified(time).unwrap();
    }
    assert_eq!(place.complete(), Vec::<String>::new());
    for path in place.run_files() {
        assert_eq!(path.metadata().unwrap().modified().unwrap(), time);
    }
}

#[test]
fn the_index_is_made_again_whatever_became_of_it() {
    let place = Place::new(SMALL);
    place.complete();
    let tables = place.tables();
    let index = place.path("store/index.sqlite");
    let before = seal_times(&place.run_folders());
    let whole = fs::read(&index).unwrap();
    let text = "this is no database, and it is long enough not to be taken for an empty one";
    let damages: [&dyn Fn(); 4] = [
        &|| fs::remove_file(&index).unwrap(),
        &|| fs::write(&index, text).unwrap(),
        &|| fs::write(&index, &whole[..whole.len() / 2]).unwrap(),
        &|| {
            let mut bytes = whole.clone();
            for byte in &mut bytes[4096..5000] {
                *byte ^= 0xff;
            }
            fs::write(&index, bytes).unwrap();
        },
    ];
    for damage in damages {
        damage();
        assert_eq!(place.complete(), Vec::<String>::new());
        assert_eq!(place.tables(), tables);
        assert_eq!(seal_times(&place.run_folders()), before);
    }
    let found = place.store().scan().unwrap();
    assert_eq!((found.whole, found.quarantined.len()), (6, 0));
}

/// Works on a long run until it has both generations of its checkpoint.
fn stopped_half_way(place: &Place) -> PathBuf {
    let has_both = |folder: &PathBuf| folder.join("state.checkpoint.1").exists();
    place.work_until(|_| {
        place.path("store/runs").exists() && place.run_folders().iter().any(has_both)
    });
    place.run_folders().into_iter().find(has_both).unwrap()
}

#[test]
fn damaged_checkpoints_fall_back_to_the_older_one_and_then_to_the_start() {
    let text = SMALL
        .replace("run.periods = 12", "run.periods = 350")
        .replace("replicates = 3", "replicates = 1");
    let through = Place::new(&text);
    through.complete();
    for damaged in 1..=2 {
        let place = Place::new(&text);
        let folder = stopped_half_way(&place);
        for name in &["state.checkpoint", "state.checkpoint.1"][..damaged] {
            flip(&folder.join(name), 0.6);
        }
        let news = place.complete();
        assert_eq!(news.len(), damaged, "{news:?}");
        assert!(news[0].contains("state.checkpoint"), "{news:?}");
        assert_eq!(place.tables(), through.tables());
        let identity = folder.file_name().unwrap().to_str().unwrap();
        let identity = identity.parse().unwrap();
        assert_eq!(place.store().quarantines(identity).len(), damaged);
    }
}

#[test]
fn a_run_that_fails_is_kept_with_its_reason_and_can_be_tried_again() {
    // Three of the runs diverge: a step far beyond what the contacts bear.
    let text = SMALL
        .replace(
            "key = \"drive.width\"\nvalues = [2.5, 2.8]",
            "key = \"run.time_step\"\nvalues = [0.05, 5.0]",
        )
        .replace(
            "run.periods = 12",
            "run.periods = 12\ncontact.normal_stiffness = 50.0\ncontact.normal_damping = 0.0",
        );
    let place = Place::new(&text);
    let news = place.complete();
    let survey = place.store().survey().unwrap();
    assert_eq!(survey.counts()[&State::Done], 3);
    assert_eq!(survey.counts()[&State::Failed], 3, "{news:?}");
    assert_eq!(news.len(), 3, "{news:?}");
    let failed: Vec<_> = survey
        .plan
        .runs()
        .iter()
        .filter(|run| survey.state(run.identity) == State::Failed)
        .collect();
    for run in &failed {
        let reason = survey.entries[&run.identity].reason.clone().unwrap();
        assert!(reason.contains("diverged at step"), "{reason}");
        let folder = place.store().run_folder(run.identity);
        assert!(folder.join("failed.json").exists());
    }
    // It is in a table of its own, and survives the loss of the index.
    let exported = place.store().export(&place.path("out"), false).unwrap();
    assert_eq!((exported.rows, exported.missing), (3, 3));
    let table = fs::read_to_string(place.path("out/small-failed.csv")).unwrap();
    assert_eq!(table.lines().count(), 1 + 3, "{table}");
    fs::remove_file(place.path("store/index.sqlite")).unwrap();
    assert_eq!(place.store().survey().unwrap().counts()[&State::Failed], 3);
    assert_eq!(place.complete(), Vec::<String>::new());

    assert!(place.store().retry(failed[0].identity).unwrap());
    let survey = place.store().survey().unwrap();
    assert_eq!(survey.state(failed[0].identity), State::Quarantined);
    assert!(!place.store().retry(failed[0].identity).unwrap());
    // The same physics comes to the same end.
    assert_eq!(place.complete().len(), 1);
    assert_eq!(place.store().survey().unwrap().counts()[&State::Failed], 3);
}

#[test]
fn a_store_is_that_of_one_study_and_of_nothing_else() {
    let place = Place::new(SMALL);
    place.store();
    let other = crate::study(&SMALL.replace("\"small\"", "\"other\""));
    let refused = Store::create(&place.path("store"), &other).unwrap_err();
    let message = refused.to_string();
    assert!(message.contains("`small`, not `other`"), "{message}");
    fs::create_dir(place.path("full")).unwrap();
    fs::write(place.path("full/notes.txt"), "mine").unwrap();
    assert!(Store::create(&place.path("full"), &other).is_err());
    assert_eq!(entries(&place.path("full")).len(), 1);
    assert!(Store::open(&place.path("full")).is_err());
    assert!(Store::open(&place.path("missing")).is_err());
}

#[cfg(unix)]
#[test]
fn a_folder_that_cannot_be_written_ends_the_work_with_its_name() {
    use std::os::unix::fs::PermissionsExt;
    let place = Place::new(SMALL);
    let store = place.store();
    let runs = place.path("store/runs");
    fs::set_permissions(&runs, fs::Permissions::from_mode(0o555)).unwrap();
    // The superuser may write anywhere.
    if fs::create_dir(runs.join("probe")).is_err() {
        let error = work_on(&store, &place.study, TWO_WORKERS, &|| false, &mut |_| {}).unwrap_err();
        assert!(error.to_string().contains("runs"), "{error}");
        assert!(store.survey().unwrap().leases.is_empty());
    }
    fs::set_permissions(&runs, fs::Permissions::from_mode(0o755)).unwrap();
}

#[test]
fn a_damaged_copy_of_the_study_file_is_replaced_by_the_file_itself() {
    let place = Place::new(SMALL);
    place.complete();
    let tables = place.tables();
    fs::write(place.path("store/study.toml"), "name = ").unwrap();
    assert!(place.store().specification().is_ok());
    assert!(place.path("store/study.toml.damaged-1").exists());
    assert_eq!(place.complete(), Vec::<String>::new());
    assert_eq!(place.tables(), tables);
}
