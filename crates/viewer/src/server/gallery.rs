//! Studies and figures that are shown together, and their open runs.

use std::path::PathBuf;
use std::sync::mpsc::Receiver;
use std::sync::{Mutex, MutexGuard, PoisonError};

use peristalsis_engine::Instructions;
use peristalsis_run::Run;
use serde::Serialize;

use super::error::ViewerError;
use super::figure::Figure;
use super::recording::Recording;
use super::recording_host::RecordingHost;
use super::run_host::RunHost;
use super::session::{Request, Session, Subscribers, refuse_all};
use super::study::{Study, StudyRun};
use crate::tube::{Labels, Saves};

/// Runs that stay open at a time.
pub(super) const OPEN: usize = 4;

/// A run: the number of its study, and its number in the study.
type Place = (usize, usize);

/// Studies, figures and open runs.
#[derive(Debug)]
pub(crate) struct Gallery {
    studies: Vec<Mutex<Study>>,
    figures: Vec<Figure>,
    saves: PathBuf,
    /// The open runs, in the order in which they were last asked for.
    open: Mutex<Vec<(Place, Session)>>,
}

/// Studies and figures, for the page of results.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(ts_rs::TS))]
pub(crate) struct List<'a> {
    studies: Vec<Listed>,
    figures: &'a [Figure],
}

/// A study in the list.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(ts_rs::TS))]
pub(crate) struct Listed {
    name: String,
    title: String,
    /// Finished runs in it.
    rows: usize,
}

/// Why a run cannot be watched.
#[derive(Debug)]
pub(crate) enum Closed {
    /// No run has this number.
    Unknown,
    /// Too many runs are watched.
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

    /// Studies and figures in JSON.
    pub(crate) fn list(&self) -> String {
        let studies = self.studies.iter().map(|study| {
            let study = held(study);
            Listed {
                name: study.name().to_owned(),
                title: study.title().to_owned(),
                rows: study.rows(),
            }
        });
        let list = List {
            studies: studies.collect(),
            figures: &self.figures,
        };
        serde_json::to_string(&list).expect("a list holds numbers and words only")
    }

    /// A study in JSON; `Some(None)` if the client has this version already, `None` if no study has this number.
    ///
    /// # Errors
    /// [`ViewerError::Study`] if its store cannot be read any more.
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

    /// Whether the run exists.
    pub(crate) fn holds(&self, place: Place) -> bool {
        self.run(place).is_some()
    }

    fn run(&self, (study, number): Place) -> Option<StudyRun> {
        held(self.studies.get(study)?).run(number)
    }

    /// The session of a run, which is opened if it was not open.
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
            let is_left = |(_, session): &(Place, Session)| !session.subscribers.are_present();
            let left = open.iter().position(is_left);
            open.remove(left.ok_or(Closed::Full)?);
        }
        let saves = self.saves.clone();
        let session =
            Session::start(move |subscribers, requests| show(run, saves, subscribers, &requests))
                .map_err(Closed::Failed)?;
        open.push((place, session.clone()));
        Ok(session)
    }
}

/// The content of a mutex, also after a panic of its holder: no change of it is left half done.
fn held<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Plays the recording of a run, or computes the run from its start.
fn show(run: StudyRun, saves: PathBuf, subscribers: Subscribers, requests: &Receiver<Request>) {
    let outcome = match &run.trajectory {
        Some(path) => {
            let recording = Recording::open(path, run.configuration.clone(), Vec::new());
            let recording = recording.map_err(|error| error.to_string());
            recording.map(|recording| {
                let host = RecordingHost {
                    recording,
                    title: run.title,
                    within: Some(run.within),
                };
                host.work(requests);
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
            RunHost::new(tube, labels, subscribers).work(requests);
        }),
    };
    if let Err(reason) = outcome {
        refuse_all(&reason, requests);
    }
}

fn begin(run: &StudyRun) -> Result<Run, String> {
    let mut tube = Run::new(run.configuration.clone()).map_err(|error| error.to_string())?;
    tube.compute_with(Instructions::widest(), 1)
        .map_err(|error| error.to_string())?;
    Ok(tube)
}
