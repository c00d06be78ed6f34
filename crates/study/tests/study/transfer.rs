//! Finished runs from one store to another: by tables of rows, and by archives of all their files.

use std::fs;
use std::path::PathBuf;

use peristalsis_study::{Store, StudyError};

use crate::{Place, SMALL, entries, flip, study};

#[test]
fn imported_rows_are_finished_runs_and_the_table_is_the_same() {
    let first = Place::new(SMALL);
    first.complete();
    let tables = first.tables();
    assert_eq!(
        peristalsis_formats::parquet::encode(&first.store().rows().unwrap()).unwrap(),
        tables[1]
    );
    for ending in ["csv", "parquet"] {
        let second = Place::new(SMALL);
        let table = first.path(&format!("tables/small.{ending}"));
        assert_eq!(second.store().import_table(&table).unwrap().taken, 6);
        // Again, to no effect.
        let again = second.store().import_table(&table).unwrap();
        assert_eq!((again.taken, again.different), (0, 0));
        assert_eq!(second.complete(), Vec::<String>::new());
        assert!(second.run_folders().is_empty());
        let out = second.path("out");
        second.store().export(&out, true).unwrap();
        assert_eq!(fs::read(out.join("small.csv")).unwrap(), tables[0]);
        assert_eq!(fs::read(out.join("small.parquet")).unwrap(), tables[1]);
        // The files are the truth here as well.
        fs::remove_file(second.path("store/index.sqlite")).unwrap();
        assert_eq!(second.store().scan().unwrap().imported, 6);
        second.store().export(&out, false).unwrap();
        assert_eq!(fs::read(out.join("small.csv")).unwrap(), tables[0]);
    }
}

#[test]
fn rows_say_flow_pressure_and_power_in_si_where_units_are_given() {
    let names = ["mass_flow_rate_si", "wall_power_si", "wall_pressure_si"];
    let plain = Place::new(SMALL);
    plain.complete();
    let rows = plain.store().rows().unwrap();
    for name in names {
        assert!(rows.reals(name).unwrap().iter().all(|value| value.is_nan()));
    }
    let units = "[base.units]\ngrain_diameter = 1e-3\ndensity = 2500\nstiffness = 50\n[[axes]]";
    let place = Place::new(&SMALL.replace("[[axes]]", units));
    place.complete();
    let rows = place.store().rows().unwrap();
    // m = pi rho d^3/6, t = (m/k)^(1/2), power in m d^2/t^3 and pressure in m/(d t^2).
    let mass = std::f64::consts::PI / 6.0 * 2500.0 * 1e-9;
    let time = (mass / 50.0_f64).sqrt();
    for (name, plain, unit) in [
        ("mass_flow_rate_si", "flow_rate", mass / time),
        ("wall_power_si", "wall_power", mass * 1e-6 / time.powi(3)),
        (
            "wall_pressure_si",
            "wall_pressure",
            mass / (1e-3 * time * time),
        ),
    ] {
        let (found, plain) = (rows.reals(name).unwrap(), rows.reals(plain).unwrap());
        for (found, plain) in found.iter().zip(plain) {
            assert!(
                (found / (plain * unit) - 1.0).abs() < 1e-9,
                "{name}: {found}"
            );
        }
    }
}

#[test]
fn a_row_that_contradicts_its_run_is_refused_with_its_table() {
    let first = Place::new(SMALL);
    first.complete();
    first.tables();
    let text = fs::read_to_string(first.path("tables/small.csv")).unwrap();
    let head = text.lines().find(|line| line.contains("identity")).unwrap();
    let is_row = |line: &str| line != head && !line.starts_with('#');
    let edited = |line: &str, column: &str, value: &str| {
        let place = head.split(',').position(|name| name == column).unwrap();
        let mut cells: Vec<&str> = line.split(',').collect();
        cells[place] = value;
        cells.join(",")
    };
    let second = Place::new(SMALL);
    let refuses = |lines: Vec<String>, column: &str| {
        let table = first.path("tables/edited.csv");
        fs::write(&table, lines.join("\n") + "\n").unwrap();
        let error = second.store().import_table(&table).unwrap_err();
        assert!(
            matches!(&error, StudyError::NotRows { reason, .. } if reason.contains(column)),
            "{column}: {error}"
        );
        assert_eq!(second.store().rows().unwrap().rows(), 0);
    };
    for (column, value) in [
        ("strain_rate", "0.07"),
        ("replicate", "9"),
        ("status", "\"done\""),
    ] {
        let lines = text.lines().map(|line| match is_row(line) {
            true => edited(line, column, value),
            false => line.to_owned(),
        });
        refuses(lines.collect(), column);
    }
    // One run twice: with other numbers, and the same again.
    let last = text.lines().last().unwrap();
    let mut twice: Vec<String> = text.lines().map(str::to_owned).collect();
    twice.push(edited(last, "flow_rate_ratio", "0.5"));
    refuses(twice.clone(), "flow_rate_ratio");
    *twice.last_mut().unwrap() = last.to_owned();
    let table = first.path("tables/twice.csv");
    fs::write(&table, twice.join("\n") + "\n").unwrap();
    assert_eq!(second.store().import_table(&table).unwrap().taken, 6);
    assert_eq!(second.store().rows().unwrap().rows(), 6);
}

#[test]
fn a_study_goes_on_from_the_rows_that_it_is_given() {
    let whole = Place::new(SMALL);
    whole.complete();
    let tables = whole.tables();
    let part = Place::new(&SMALL.replace("replicates = 3", "replicates = 2"));
    part.complete();
    part.tables();
    let second = Place::new(SMALL);
    let table = part.path("tables/small.csv");
    assert_eq!(second.store().import_table(&table).unwrap().taken, 4);
    second.complete();
    assert_eq!(second.run_folders().len(), 2);
    let out = second.path("out");
    second.store().export(&out, false).unwrap();
    assert_eq!(fs::read(out.join("small.csv")).unwrap(), tables[0]);
    // A run computed here is not replaced by one imported later.
    let all = whole.path("tables/small.csv");
    second.store().import_table(&all).unwrap();
    let found = second.store().scan().unwrap();
    assert_eq!((found.whole, found.imported), (2, 4));
}

/// A study that is complete, its table, and a second place whose store took all of its rows.
fn imported() -> (Place, PathBuf, Place) {
    let first = Place::new(SMALL);
    first.complete();
    first.tables();
    let second = Place::new(SMALL);
    let table = first.path("tables/small.csv");
    second.store().import_table(&table).unwrap();
    (first, table, second)
}

/// A pump engineer: a table whose numbers had been changed was said to be taken, and `study scan` put some of them into the
/// store.
#[test]
fn rows_of_finished_runs_are_not_taken_even_when_the_index_is_made_anew() {
    let (_first, table, second) = imported();
    let text = fs::read_to_string(&table).unwrap();
    let (head, last) = text.trim_end().rsplit_once('\n').unwrap();
    let names = text.lines().find(|line| line.contains("identity")).unwrap();
    let column = names.split(',').position(|name| name == "flow_rate_ratio");
    // The copies of tables are called by their hashes: of so many one comes after that of the first.
    for digit in 0..8 {
        let mut cells: Vec<String> = last.split(',').map(str::to_owned).collect();
        cells[column.unwrap()] = format!("0.{digit}5");
        let changed = second.path("changed.csv");
        fs::write(&changed, format!("{head}\n{}\n", cells.join(","))).unwrap();
        let found = second.store().import_table(&changed).unwrap();
        assert_eq!((found.runs, found.taken, found.different), (6, 0, 1));
    }
    assert_eq!(second.store().scan().unwrap().imported, 6);
    let out = second.path("out");
    second.store().export(&out, false).unwrap();
    assert_eq!(fs::read_to_string(out.join("small.csv")).unwrap(), text);
}

#[test]
fn an_imported_copy_that_was_damaged_is_not_believed() {
    let (first, _, second) = imported();
    let copy = entries(&second.path("store/imported")).remove(0);
    flip(&copy, 0.9);
    let found = second.store().scan().unwrap();
    assert_eq!(found.imported, 0);
    let lost: Vec<usize> = found.lost_tables.into_values().collect();
    assert_eq!(lost, [6]);
    assert!(!copy.exists());
    second.complete();
    assert_eq!(second.tables(), first.tables());
}

/// In a notebook an edited study answered with the runs of the one before.
#[test]
fn a_store_answers_for_the_study_that_is_asked_about() {
    let first = Place::new(SMALL);
    first.complete();
    let other = study(&SMALL.replace("[2.5, 2.8]", "[2.8, 2.9]"));
    let path = first.path("store");
    let widths = |store: &Store| store.rows().unwrap().reals("width").unwrap().to_vec();
    let asked = Store::open_for(&path, &other).unwrap();
    assert_eq!(widths(&asked), [2.8; 3]);
    assert_eq!(
        widths(&Store::open(&path).unwrap()),
        [2.5, 2.5, 2.5, 2.8, 2.8, 2.8]
    );
    // Another process makes the store that of a smaller study: whoever works on the larger one is told of that.
    let larger = first.store();
    Store::create(&path, &other).unwrap();
    assert_eq!(widths(&larger), [2.5, 2.5, 2.5, 2.8, 2.8, 2.8]);
    let stranger = study(&SMALL.replace("\"small\"", "\"other\""));
    let error = Store::open_for(&path, &stranger).unwrap_err();
    assert!(matches!(error, StudyError::OtherStudy { .. }), "{error}");
    let error = Store::open_for(&first.path("none"), &other).unwrap_err();
    assert!(matches!(error, StudyError::NoStore { .. }), "{error}");
}

#[test]
fn tables_of_an_older_export_go_where_they_would_contradict() {
    let place = Place::new(SMALL);
    place.complete();
    let out = place.path("tables");
    let exported = place.store().export(&out, true).unwrap();
    assert_eq!((exported.failed, exported.without_series), (0, 0));
    fs::write(out.join("small-failed.csv"), "identity\n").unwrap();
    let exported = place.store().export(&out, false).unwrap();
    let older = ["small-failed.csv", "small-series.parquet"].map(|name| out.join(name));
    assert_eq!(exported.removed, older);
    assert!(older.iter().all(|path| !path.exists()));
    assert_eq!(exported.replaced, exported.files);
    // Imported rows have no series.
    let (_first, _, second) = imported();
    let exported = second.store().export(&second.path("tables"), true).unwrap();
    assert_eq!((exported.rows, exported.without_series), (6, 6));
}

#[test]
fn what_holds_no_rows_is_refused() {
    let place = Place::new(SMALL);
    let store = place.store();
    for (name, text) in [
        ("other.csv", "a,b\n1,2\n"),
        ("ids.csv", "identity\n\"nobody\"\n"),
        (
            "part.csv",
            "identity,replicate\n\"0123456789abcdef0123456789abcdef\",1\n",
        ),
    ] {
        fs::write(place.path(name), text).unwrap();
        let error = store.import_table(&place.path(name)).unwrap_err();
        assert!(matches!(error, StudyError::NotRows { .. }), "{error}");
    }
    assert!(store.import_table(&place.path("missing.csv")).is_err());
    fs::write(place.path("x.tar"), vec![7_u8; 2048]).unwrap();
    assert!(store.import_archive(&place.path("x.tar")).is_err());
    assert_eq!(store.survey().unwrap().entries.len(), 0);
    // Nothing half unpacked stays.
    assert!(
        entries(store.path())
            .iter()
            .all(|path| !path.to_string_lossy().contains(".import"))
    );
}

#[test]
fn archives_hold_whole_runs_and_are_the_same_bytes_for_the_same_runs() {
    let first = Place::new(SMALL);
    first.complete();
    let tables = first.tables();
    let archive = first.path("runs.tar");
    assert_eq!(first.store().pack(&archive).unwrap().runs, 6);
    let bytes = fs::read(&archive).unwrap();
    first.store().pack(&archive).unwrap();
    assert_eq!(fs::read(&archive).unwrap(), bytes);

    let second = Place::new(SMALL);
    let taken = second.store().import_archive(&archive).unwrap();
    assert_eq!((taken.runs, taken.taken), (6, 6));
    assert_eq!(second.tables(), tables);
    let again = second.store().import_archive(&archive).unwrap();
    assert_eq!((again.runs, again.taken), (6, 0));
    assert_eq!(second.store().scan().unwrap().whole, 6);

    // A run that was damaged in the archive is left out, and computed.
    let row = b"\"rest\",\"complete\"";
    let place = bytes
        .windows(row.len())
        .position(|window| window == row)
        .unwrap();
    let mut damaged = bytes;
    damaged[place + 1] ^= 1;
    fs::write(&archive, damaged).unwrap();
    let third = Place::new(SMALL);
    let taken = third.store().import_archive(&archive).unwrap();
    assert_eq!((taken.runs, taken.taken), (6, 5));
    let [(_, reason)] = &taken.refused[..] else {
        panic!("{taken:?}");
    };
    assert!(reason.contains("row.csv"), "{reason}");
    third.complete();
    assert_eq!(third.tables(), tables);
}

#[test]
fn an_archive_cannot_write_outside_of_the_runs() {
    let place = Place::new(SMALL);
    let path = place.path("evil.tar");
    let mut builder = tar::Builder::new(fs::File::create(&path).unwrap());
    let mut header = tar::Header::new_gnu();
    header.set_size(4);
    header.set_mode(0o644);
    builder
        .append_data(&mut header, "study.toml", &b"evil"[..])
        .unwrap();
    builder.finish().unwrap();
    let error = place.store().import_archive(&path).unwrap_err();
    assert!(error.to_string().contains("study.toml"), "{error}");
    let store = Store::open(&place.path("store")).unwrap();
    assert!(store.specification().is_ok());
}
