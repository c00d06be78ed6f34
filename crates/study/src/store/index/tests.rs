use peristalsis_formats::FormatError;

use super::*;

const TIMEOUT: Duration = Duration::from_secs(100);

/// An index in a folder of its own, two runs, and two owners on other machines, of whom nothing is known but what they say.
struct Case {
    folder: tempfile::TempDir,
    runs: [Identity; 2],
    owners: [Owner; 2],
}

impl Case {
    fn new() -> Self {
        let owner = |token: &str| Owner {
            host: format!("machine of {token}"),
            process: 1,
            started: "1".into(),
            token: token.into(),
        };
        Self {
            folder: tempfile::tempdir().unwrap(),
            runs: ["0a", "0b"].map(|digits| digits.repeat(16).parse().unwrap()),
            owners: ["one", "other"].map(owner),
        }
    }

    fn path(&self) -> PathBuf {
        self.folder.path().join("index.sqlite")
    }

    fn index(&self) -> Index {
        Index::open(&self.path()).unwrap().0
    }

    fn claim(&self, owner: usize) -> Claim {
        let (order, owner) = (&self.runs, &self.owners[owner]);
        self.index().claim(order, owner, TIMEOUT).unwrap()
    }

    /// Lets a lease have been silent for so long.
    fn age(&self, run: usize, seconds: i64) {
        self.index()
            .connection
            .execute(
                "UPDATE leases SET heartbeat = ?1 WHERE identity = ?2",
                params![now() - seconds, self.runs[run].to_string()],
            )
            .unwrap();
    }
}

#[test]
fn a_run_is_given_to_one_owner_at_a_time_in_the_order_asked_for() {
    let case = Case::new();
    let [first, second] = case.runs;
    assert_eq!(case.claim(0), Claim::Taken(first));
    assert_eq!(case.claim(1), Claim::Taken(second));
    assert_eq!(case.claim(0), Claim::Wait { leased: 2 });
    let [one, other] = &case.owners;
    let done = Entry::new(State::Done, None);
    // Only its owner can give it back or say what has become of it.
    assert!(!case.index().release(first, other, Some(&done)).unwrap());
    assert_eq!(case.index().entry(first).unwrap(), None);
    assert!(case.index().release(first, one, Some(&done)).unwrap());
    assert_eq!(case.index().entry(first).unwrap(), Some(done.clone()));
    assert!(!case.index().release(first, one, Some(&done)).unwrap());
    assert_eq!(case.claim(0), Claim::Wait { leased: 1 });
    let saved = Entry::new(State::Checkpointed, None);
    assert!(case.index().release(second, other, Some(&saved)).unwrap());
    assert_eq!(case.claim(0), Claim::Taken(second));
    case.index()
        .release(second, one, Some(&Entry::new(State::Failed, None)))
        .unwrap();
    assert_eq!(case.claim(1), Claim::Nothing);
}

#[test]
fn a_lease_that_has_been_silent_for_too_long_is_taken_over_and_the_old_owner_learns_of_it() {
    let case = Case::new();
    let [first, second] = case.runs;
    case.claim(0);
    case.claim(0);
    case.age(0, 90);
    case.age(1, 110);
    assert_eq!(case.index().leases(TIMEOUT).unwrap().len(), 1);
    assert_eq!(case.claim(1), Claim::Taken(second));
    let [one, other] = &case.owners;
    assert_eq!(case.index().renew(one).unwrap(), [first]);
    assert_eq!(case.index().renew(other).unwrap(), [second]);
    assert!(!case.index().release(second, one, None).unwrap());
    // A heartbeat makes it hold for another while.
    case.age(0, 99);
    case.index().renew(one).unwrap();
    case.age(1, 99);
    assert_eq!(case.claim(1), Claim::Wait { leased: 2 });
}

#[test]
fn an_index_is_new_until_it_has_been_filled() {
    let case = Case::new();
    for _ in 0..2 {
        // A process that was killed before it could fill the index leaves that to the next.
        let (_, is_new) = Index::open(&case.path()).unwrap();
        assert!(is_new);
    }
    let entry = Entry {
        row: Some("a row".into()),
        transition_time: Some(0.1 + 0.2),
        stamp: Some("a stamp".into()),
        ..Entry::new(State::Done, Some("imported".into()))
    };
    case.claim(0);
    case.index()
        .replace(
            &HashMap::from([(case.runs[0], entry.clone())]),
            &HashMap::new(),
        )
        .unwrap();
    let (index, is_new) = Index::open(&case.path()).unwrap();
    assert!(!is_new);
    assert_eq!(
        index.entries().unwrap(),
        HashMap::from([(case.runs[0], entry.clone())])
    );
    let finding = index.findings().unwrap().remove(&case.runs[0]).unwrap();
    assert_eq!(finding.transition_time, entry.transition_time);
    // Leases stay.
    assert_eq!(index.leases(TIMEOUT).unwrap().len(), 1);
}

#[test]
fn an_index_of_another_layout_is_made_again() {
    let case = Case::new();
    let entry = Entry::new(State::Failed, None);
    case.index()
        .replace(&HashMap::from([(case.runs[0], entry)]), &HashMap::new())
        .unwrap();
    case.index()
        .connection
        .pragma_update(None, "user_version", LAYOUT + 1)
        .unwrap();
    let (index, is_new) = Index::open(&case.path()).unwrap();
    assert!(is_new);
    assert!(index.entries().unwrap().is_empty());
}

#[test]
fn what_others_note_while_the_files_are_looked_at_stays() {
    let case = Case::new();
    let [first, second] = case.runs;
    let [done, failed, saved] =
        [State::Done, State::Failed, State::Checkpointed].map(|state| Entry::new(state, None));
    case.index()
        .note([(first, &saved), (second, &failed)])
        .unwrap();
    let before = case.index().findings().unwrap();
    // The files of both are seen as they are now; then another process finishes the first.
    case.index().note([(first, &done)]).unwrap();
    let seen = HashMap::from([(first, saved.clone())]);
    case.index().replace(&seen, &before).unwrap();
    assert_eq!(
        case.index().entries().unwrap(),
        HashMap::from([(first, done)])
    );
}

#[test]
fn a_heartbeat_from_before_the_clock_was_set_back_holds_nothing() {
    let case = Case::new();
    let [first, _] = case.runs;
    assert_eq!(case.claim(0), Claim::Taken(first));
    // Clocks of machines differ by minutes, which is no reason to take a run away.
    case.age(0, -600);
    assert!(case.index().leases(TIMEOUT).unwrap().contains_key(&first));
    // By a day they do not: the clock was set back, and the owner may be dead for long.
    case.age(0, -86_400);
    assert!(case.index().leases(TIMEOUT).unwrap().is_empty());
    assert_eq!(case.claim(1), Claim::Taken(first));
}

#[test]
fn values_that_cannot_be_make_the_index_a_new_one() {
    for damage in [
        "UPDATE runs SET identity = 'no identity'",
        "UPDATE runs SET reason = x'ff00ff'",
        "UPDATE runs SET row = x'80'",
        "UPDATE runs SET transition_time = 'late'",
        "UPDATE leases SET process = -1",
        "UPDATE leases SET token = CAST(x'fe' AS TEXT)",
        "ALTER TABLE runs RENAME COLUMN stamp TO stump",
        "DROP TABLE runs; CREATE TABLE runs (identity TEXT PRIMARY KEY, state)",
    ] {
        let case = Case::new();
        let [first, second] = case.runs;
        let mut index = case.index();
        index
            .note([(second, &Entry::new(State::Done, None))])
            .unwrap();
        index
            .replace(&HashMap::new(), &index.findings().unwrap())
            .unwrap();
        index
            .note([(second, &Entry::new(State::Done, None))])
            .unwrap();
        drop(index);
        assert_eq!(case.claim(0), Claim::Taken(first));
        case.index().connection.execute_batch(damage).unwrap();
        let (index, is_new) = Index::open(&case.path()).unwrap();
        assert!(is_new, "{damage}");
        assert!(index.entries().unwrap().is_empty(), "{damage}");
        let aside = case.folder.path().join("index.sqlite.damaged-1");
        assert!(aside.is_file(), "{damage}");
    }
}

/// A cluster's user: a store far down was called one that this user may not write to.
#[test]
fn a_path_that_is_too_long_for_the_index_is_called_so() {
    let folder = tempfile::tempdir().unwrap();
    let deep = folder.path().join(["x".repeat(100).as_str(); 5].join("/"));
    std::fs::create_dir_all(&deep).unwrap();
    let Err(StudyError::Format(FormatError::Io { source, .. })) =
        Index::open(&deep.join("index.sqlite"))
    else {
        panic!("it was opened, or refused for something else");
    };
    assert_eq!(source.kind(), std::io::ErrorKind::InvalidFilename);
    assert!(source.to_string().contains("500 at most"), "{source}");
}
