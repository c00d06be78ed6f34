//! Studies and figures that are looked at together, and the runs of them that were opened.

use std::path::PathBuf;
use std::sync::mpsc::Receiver;
use std::sync::{Mutex, MutexGuard, PoisonError};

use peristalsis_engine::Instructions;
use peristalsis_run::Run;
use serde_json::{Value, json};

use crate::ViewerError;
use crate::figure::Figure;
use crate::keeper::Keeper;
use crate::player::Player;
use crate::recording::Recording;
use crate::session::{Request, Session, Voices, apologize};
use crate::study::{Study, StudyRun};
use crate::tube::{Labels, Saves};

/// Runs that stay open at a time.
const OPEN: usize = 4;

/// Which run: the number of its study, and its own in it.
type Place = (usize, usize);

/// What there is to look at.
#[derive(Debug)]
pub(crate) struct Gallery {
    studies: Vec<Mutex<Study>>,
    figures: Vec<Figure>,
    saves: PathBuf,
    /// The runs that are open, the one that was asked for last at the end.
    open: Mutex<Vec<(Place, Session)>>,
}

/// Why a run cannot be watched.
#[derive(Debug)]
pub(crate) enum Closed {
    /// There is no such run.
    Unknown,
    /// Too many are watched.
    Full,
    /// The system gives no thread.
    Failed(ViewerError),
}

impl Gallery {
    pub(crate) fn new(studies: Vec<Study>, figures: Vec<Figure>, saves: PathBuf) -> Self {
        Self {
            studies: studies.into_iter().map(Mutex::new).collect(),
            figures,
            saves,
            open: Mutex::default(),
        }
    }

    /// What there is, in JSON.
    pub(crate) fn list(&self) -> Value {
        let studies = self.studies.iter().map(|study| {
            let study = held(study);
            json!({ "name": study.name(), "title": study.title(), "rows": study.rows() })
        });
        json!({ "studies": studies.collect::<Vec<Value>>(), "figures": self.figures })
    }

    /// All of a study in JSON; `Some(None)` where the client has it in this version already, `None` where there is no such
    /// study.
    ///
    /// # Errors
    /// Where its store cannot be read any more.
    pub(crate) fn study(
        &self,
        number: usize,
        known: Option<u64>,
    ) -> Option<Result<Option<Vec<u8>>, ViewerError>> {
        let mut study = held(self.studies.get(number)?);
        if let Err(error) = study.refresh() {
            return Some(Err(error));
        }
        Some(Ok((known != Some(study.version())).then(|| {
            serde_json::to_vec(&study.shown()).expect("a study holds numbers and words only")
        })))
    }

    /// The picture of a figure.
    pub(crate) fn picture(&self, number: usize) -> Option<Vec<u8>> {
        self.figures.get(number)?.picture().ok()
    }

    /// Whether there is such a run.
    pub(crate) fn holds(&self, place: Place) -> bool {
        self.run(place).is_some()
    }

    fn run(&self, (study, number): Place) -> Option<StudyRun> {
        held(self.studies.get(study)?).run(number)
    }

    /// A run, begun where it was not open.
    ///
    /// # Errors
    /// [`Closed`].
    pub(crate) fn enter(&self, place: Place) -> Result<Session, Closed> {
        let mut open = held(&self.open);
        if let Some(index) = open.iter().position(|(it, _)| *it == place) {
            let entered = open.remove(index);
            let session = entered.1.clone();
            open.push(entered);
            return Ok(session);
        }
        let run = self.run(place).ok_or(Closed::Unknown)?;
        if open.len() >= OPEN {
            let left = open
                .iter()
                .position(|(_, session)| !session.voices.are_heard());
            open.remove(left.ok_or(Closed::Full)?);
        }
        let saves = self.saves.clone();
        let session = Session::start(move |voices, requests| show(run, saves, voices, &requests))
            .map_err(Closed::Failed)?;
        open.push((place, session.clone()));
        Ok(session)
    }
}

/// What a mutex holds: whoever panicked with it left it whole, for nothing is changed by halves.
fn held<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Plays the recording of a run, or computes the run from its start.
fn show(run: StudyRun, saves: PathBuf, voices: Voices, requests: &Receiver<Request>) {
    let outcome = match &run.trajectory {
        Some(path) => {
            let recording = Recording::open(path, run.configuration.clone(), Vec::new());
            recording
                .map_err(|error| error.to_string())
                .map(|recording| {
                    Player {
                        recording,
                        title: run.title,
                        within: Some(run.within),
                        voices,
                    }
                    .work(requests);
                })
        }
        None => begin(&run).map(|tube| {
            let labels = Labels {
                title: run.title,
                saves: Saves::Folders {
                    inside: saves,
                    stem: run.stem,
                },
                record: run.record,
                within: Some(run.within),
            };
            Keeper::new(tube, labels, voices).work(requests);
        }),
    };
    if let Err(reason) = outcome {
        apologize(&reason, requests);
    }
}

fn begin(run: &StudyRun) -> Result<Run, String> {
    let mut tube = Run::new(run.configuration.clone()).map_err(|error| error.to_string())?;
    tube.compute_with(Instructions::widest(), 1)
        .map_err(|error| error.to_string())?;
    Ok(tube)
}
