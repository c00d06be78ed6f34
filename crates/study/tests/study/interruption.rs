//! A study that is interrupted wherever one likes, or shared by several workers, ends with the same bytes.

use std::cell::Cell;
use std::time::Duration;

use peristalsis_formats::parquet;
use peristalsis_study::{Effort, Ending, State, work_on};

use crate::{Place, SMALL, bits, entries, seal_times};

/// Six runs of a tenth of a second or two each.
fn longer() -> String {
    SMALL
        .replace("grains.number = 20", "grains.number = 60")
        .replace("tube.waves = 2", "tube.waves = 3")
        .replace("run.periods = 12", "run.periods = 60")
}

#[test]
fn stops_in_the_middle_of_runs_change_nothing() {
    let text = longer().replace("run.periods = 60", "run.periods = 120");
    let through = Place::new(&text);
    assert_eq!(through.complete(), Vec::<String>::new());
    let interrupted = Place::new(&text);
    let mut stops = 0;
    loop {
        // Whenever any run has got on since this process began.
        let begun = Cell::new(None);
        let ending = interrupted.work_until(|board| {
            let working = board.workers.iter().flatten();
            let progress = working.filter_map(|working| working.progress);
            let samples: u64 = progress.map(|progress| progress.samples).sum();
            match begun.get() {
                None => {
                    begun.set((samples > 0).then_some(samples));
                    false
                }
                Some(before) => samples != before,
            }
        });
        if ending == Ending::Complete {
            break;
        }
        stops += 1;
        assert!(stops < 200, "it never ends");
    }
    assert!(stops >= 3, "{stops} stops");
    assert_eq!(interrupted.tables(), through.tables());
    for (one, other) in interrupted.run_folders().iter().zip(through.run_folders()) {
        let mut names: Vec<_> = entries(one)
            .into_iter()
            .map(|path| path.file_name().unwrap().to_owned())
            .collect();
        names.sort();
        assert_eq!(names.len(), 8, "{names:?}");
        for name in names.iter().filter(|name| *name != "timing.json") {
            assert_eq!(
                std::fs::read(one.join(name)).unwrap(),
                std::fs::read(other.join(name)).unwrap(),
                "{name:?}"
            );
        }
    }
}

#[test]
fn one_worker_or_five_in_two_processes_of_work_come_to_the_same() {
    let one = Place::new(SMALL);
    let alone = Effort {
        workers: 1,
        checkpoint_interval: Duration::from_secs(60),
        limit: None,
    };
    work_on(&one.store(), &one.study, alone, &|| false, &mut |_| {}).unwrap();
    let several = Place::new(SMALL);
    let many = Effort {
        workers: 5,
        ..alone
    };
    std::thread::scope(|scope| {
        for _ in 0..2 {
            scope.spawn(|| {
                let store = several.store();
                let ending = work_on(&store, &several.study, many, &|| false, &mut |_| {});
                assert_eq!(ending.unwrap(), Ending::Complete);
            });
        }
    });
    assert_eq!(several.tables(), one.tables());
}

#[test]
fn a_limit_of_time_ends_the_work_with_every_run_saved() {
    let place = Place::new(&longer().replace("run.periods = 60", "run.periods = 100000"));
    let effort = Effort {
        workers: 2,
        checkpoint_interval: Duration::from_secs(60),
        limit: Some(Duration::from_millis(300)),
    };
    let ending = work_on(&place.store(), &place.study, effort, &|| false, &mut |_| {});
    assert_eq!(ending.unwrap(), Ending::TimeUp);
    let survey = place.store().survey().unwrap();
    assert_eq!(survey.counts()[&State::Checkpointed], 2);
    assert_eq!(survey.counts()[&State::Pending], 4);
    assert!(survey.leases.is_empty());
}

#[test]
fn points_that_are_added_leave_finished_runs_alone() {
    let mut place = Place::new(SMALL);
    place.complete();
    let folders = place.run_folders();
    let before = seal_times(&folders);
    place.study = crate::study(&SMALL.replace("[2.5, 2.8]", "[2.5, 2.6, 2.8]"));
    place.complete();
    assert_eq!(place.run_folders().len(), 9);
    assert_eq!(seal_times(&folders), before);
    // And the other way round: a run no longer asked for stays, and is not in the table.
    place.study = crate::study(&SMALL.replace("[2.5, 2.8]", "[2.6]"));
    place.complete();
    let survey = place.store().survey().unwrap();
    assert_eq!(survey.plan.runs().len(), 3);
    assert_eq!(survey.entries.len(), 9);
    let [csv, ..] = place.tables();
    assert_eq!(String::from_utf8(csv).unwrap().lines().count(), 1 + 3);
}

#[test]
fn a_run_that_may_settle_is_the_beginning_of_one_that_may_not() {
    let text = longer()
        .replace("values = [2.5, 2.8]", "values = [2.3, 2.9]")
        .replace("replicates = 3", "replicates = 1");
    let whole = Place::new(&text);
    whole.complete();
    let settled = Place::new(&text.replace("[[axes]]", "[stop]\nsettled_periods = 8\n[[axes]]"));
    settled.complete();
    let series = |place: &Place, run: usize| {
        let survey = place.store().survey().unwrap();
        let identity = survey.plan.runs()[run].identity;
        let folder = place.store().run_folder(identity);
        parquet::read(&folder.join("timeseries.parquet")).unwrap()
    };
    // Narrow: jams and settles. Wide: never does, and goes on to its end.
    let (short, long) = (series(&settled, 0), series(&whole, 0));
    assert_eq!(long.rows(), 60 * 20);
    assert!(short.rows() < 40 * 20, "{}", short.rows());
    for column in short.columns() {
        let name = &column.name;
        let [one, other] = [&short, &long].map(|table| &table.reals(name).unwrap()[..short.rows()]);
        assert_eq!(bits(one), bits(other), "{name}");
    }
    assert_eq!(series(&settled, 1).rows(), 60 * 20);
    let rows = settled.store().survey().unwrap();
    let of = |run: usize| &rows.entries[&rows.plan.runs()[run].identity];
    assert_eq!(of(0).state, State::Done);
    let tau = of(0).transition_time.unwrap();
    assert_eq!(of(1).transition_time, None);
    // Eight whole periods of 10 from the one in which it crosses.
    let end = short.reals("time").unwrap().last().unwrap() - tau;
    assert!((60.0..=90.0).contains(&end), "{end}");
}

/// A newcomer: of a run whose program was killed "nothing has been computed yet" was said, though it goes on from its state.
#[test]
fn a_run_that_was_killed_is_known_by_its_folder() {
    let place = Place::new(&longer());
    let store = place.store();
    let identity = store.survey().unwrap().plan.runs()[0].identity;
    let folder = store.path().join("runs").join(identity.to_string());
    std::fs::create_dir_all(&folder).unwrap();
    assert_eq!(store.survey().unwrap().state(identity), State::Pending);
    std::fs::write(folder.join("state.checkpoint"), "").unwrap();
    assert_eq!(store.survey().unwrap().state(identity), State::Checkpointed);
}
