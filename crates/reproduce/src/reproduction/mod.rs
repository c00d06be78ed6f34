//! From claims to findings: the studies that they need, worked on one after the other, and each claim examined as soon as
//! its studies have ended.

mod import;
mod order;
mod published;
mod sample;

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use peristalsis_study::{
    Board, Effort, Ending, PlannedRun, Specification, State, Store, StudyError, work_on,
};

use crate::claim::Claim;
use crate::error::{ReproduceError, make_folder};
use crate::evidence::Evidence;
use crate::examination::{Examination, examine, experiments_named};
use crate::finding::Finding;
use crate::studies::{Size, StudyFile};
pub use import::{Import, ImportedRuns};
pub use published::{DifferingRow, PublishedRows, published_in_words};
pub use sample::{Drawn, Extent, Sample, Sampling};

/// Folder of the stores below that of the results.
pub const STORES: &str = "stores";
/// Folder, beside it, of the stores that compute runs again of which only rows were imported.
const AGAIN: &str = "again";

/// Claims with the studies that they need, each in a store of its own.
///
/// A study in either size has the same store: what one size has computed, the other need not compute again.
#[derive(Debug)]
pub struct Reproduction {
    claims: Vec<Claim>,
    works: Vec<Work>,
    again: PathBuf,
}

/// A study and where its runs are kept.
#[derive(Debug)]
struct Work {
    file: StudyFile,
    study: Specification,
    store: Result<Store, StudyError>,
}

impl Work {
    /// The part of the study whose products the claims need, with a store of its own, where the study's store has rows without
    /// them; `None` where nothing is wanting.
    fn again(&self, folder: &Path) -> Result<Option<(Specification, Store)>, StudyError> {
        let Some(store) = self
            .store
            .as_ref()
            .ok()
            .filter(|_| self.file.needs_products)
        else {
            return Ok(None);
        };
        let survey = store.survey()?;
        let is_bare =
            |identity| survey.state(identity) == State::Done && !store.holds_products(identity);
        let is_needed = |run: &PlannedRun| run.replicate == 0 && is_bare(run.identity);
        let study = self.study.part(&survey.plan, is_needed);
        if study.plan().runs().is_empty() {
            return Ok(None);
        }
        let store = Store::create(&folder.join(self.file.name), &study)?;
        Ok(Some((study, store)))
    }
}

/// What there is to tell of a reproduction in progress.
#[derive(Debug)]
pub enum Event<'a> {
    /// How far it is; several times a second.
    Progress(Stage<'a>),
    /// The studies of a claim have ended, and this is what they say.
    Examined(&'a Examination),
    /// A study could not be worked on to its end; the others go on.
    Trouble {
        /// Name of the study.
        study: &'a str,
        /// Why.
        reason: &'a str,
    },
}

/// How far a reproduction is.
#[derive(Clone, Copy, Debug)]
pub struct Stage<'a> {
    /// Name of the study that is worked on.
    pub study: &'a str,
    /// Its place, counted from 1.
    pub number: usize,
    /// How many studies there are.
    pub of: usize,
    /// How far it is itself.
    pub board: &'a Board,
    /// Part of the work of all studies, in grains times steps, that is done.
    pub fraction: f64,
    /// Time left for all studies; `None` while nothing can be said.
    pub left: Option<Duration>,
}

/// What became of a study.
#[derive(Clone, Debug)]
pub struct StudyOutcome {
    /// The study.
    pub file: StudyFile,
    /// Its title.
    pub title: String,
    /// Runs of its plan, those that refinement has added included.
    pub runs: usize,
    /// Those that are finished.
    pub done: usize,
    /// Those that failed.
    pub failed: usize,
    /// Why it could not be worked on or read, if so.
    pub failure: Option<String>,
}

impl StudyOutcome {
    /// Runs that have neither finished nor failed.
    pub fn missing(&self) -> usize {
        self.runs.saturating_sub(self.done + self.failed)
    }
}

/// What became of a reproduction.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// Why the work ended.
    pub ending: Ending,
    /// The claims in their order.
    pub examinations: Vec<Examination>,
    /// The studies in the order of the claims that need them.
    pub studies: Vec<StudyOutcome>,
    /// What has become of the published rows, of each study that has any.
    pub published: Vec<PublishedRows>,
    /// The sample of them that was drawn; `None` unless [`Reproduction::sample`] was asked for it.
    pub drawn: Option<Drawn>,
}

/// The claims of these names, in the order of `all`; every claim where no name is given. Case does not matter.
///
/// # Errors
/// [`ReproduceError::NoSuchExperiment`].
pub fn chosen(all: &[Claim], names: &[String]) -> Result<Vec<Claim>, ReproduceError> {
    experiments_named("claim", all, |claim| claim.id, names)
}

impl Reproduction {
    /// Makes or opens the stores of the studies that the claims need, in `folder/stores`; runs that are computed again go to
    /// `folder/again`.
    ///
    /// A store that cannot be opened is told of later, and costs only the claims that need it.
    ///
    /// # Errors
    /// [`ReproduceError::Folder`], [`ReproduceError::NoSuchStudy`], and [`ReproduceError::Study`] for a file that is not a valid study.
    pub fn prepare(
        folder: &Path,
        size: Size,
        claims: &[Claim],
        studies: &[StudyFile],
    ) -> Result<Self, ReproduceError> {
        let stores = folder.join(STORES);
        make_folder(folder)?;
        make_folder(&stores)?;
        let mut works: Vec<Work> = Vec::new();
        for name in claims.iter().flat_map(Claim::all_studies) {
            if works.iter().any(|work| work.file.name == name) {
                continue;
            }
            let file = studies.iter().find(|study| study.name == name);
            let file = *file.ok_or_else(|| ReproduceError::NoSuchStudy(name.to_owned()))?;
            let study = file.specification(size)?;
            let store = Store::create(&stores.join(file.name), &study);
            works.push(Work { file, study, store });
        }
        Ok(Self {
            claims: claims.to_vec(),
            works,
            again: folder.join(AGAIN),
        })
    }

    /// Whether rows of any of the studies were imported, in this call or before.
    pub fn has_published_rows(&self) -> bool {
        let surveys = self.works.iter().flat_map(|work| &work.store);
        let mut surveys = surveys.flat_map(Store::survey);
        surveys.any(|survey| {
            let mut runs = survey.plan.runs().iter();
            runs.any(|run| survey.is_imported(run.identity))
        })
    }

    /// Computes what is missing, those studies first that let a claim be examined soonest, and examines the claims.
    ///
    /// `stop` is asked often whether to stop; `watch` is told what happens. Both are called from the calling thread.
    /// Every run is saved when it stops, and claims are examined on what there is by then: nothing that fails on the way
    /// keeps the rest from being reported.
    pub fn run(
        &self,
        effort: Effort,
        stop: &dyn Fn() -> bool,
        watch: &mut dyn FnMut(Event<'_>),
    ) -> Outcome {
        let mut course = Course::of(self, watch);
        let ending = course.work(effort, stop);
        course.finish(ending)
    }

    /// Examines the claims on what there is, and computes nothing.
    pub fn examine(&self, watch: &mut dyn FnMut(Event<'_>)) -> Outcome {
        Course::of(self, watch).finish(Ending::Complete)
    }
}

/// A reproduction on its way.
struct Course<'a> {
    claims: &'a [Claim],
    again: &'a Path,
    studies: Vec<StudyCourse<'a>>,
    evidence: Evidence,
    /// Those of the claims that have been examined, each at the place of its claim.
    examinations: Vec<Option<Examination>>,
    watch: &'a mut dyn FnMut(Event<'_>),
}

/// A study on its way.
struct StudyCourse<'a> {
    work: &'a Work,
    /// The part of it that is computed again.
    again: Option<(Specification, Store)>,
    /// Why it could not be worked on or read.
    failure: Option<String>,
    /// Whether its results are in the evidence, or cannot be.
    has_ended: bool,
}

/// The work of a store and the part of it that is left, in grains times steps.
#[derive(Clone, Copy, Debug, Default)]
struct Load {
    all: f64,
    left: f64,
}

impl Load {
    fn of(store: &Store) -> Self {
        // A study that cannot be read takes no time.
        store.survey().map_or_else(
            |_| Self::default(),
            |survey| Self {
                all: survey.work(),
                left: survey.work_left(),
            },
        )
    }
}

impl StudyCourse<'_> {
    fn name(&self) -> &'static str {
        self.work.file.name
    }

    /// All of the study, then the part that is computed again.
    fn passes(&self) -> impl Iterator<Item = (&Specification, &Store)> {
        let Work { study, store, .. } = self.work;
        let again = self.again.iter().map(|(study, store)| (study, store));
        store.iter().map(move |store| (study, store)).chain(again)
    }

    fn fail(&mut self, reason: String, watch: &mut dyn FnMut(Event<'_>)) {
        // The first reason is the cause of those that follow.
        if self.failure.is_none() {
            let study = self.name();
            let reason = &*self.failure.insert(reason);
            watch(Event::Trouble { study, reason });
        }
    }

    fn outcome(self) -> StudyOutcome {
        let mut outcome = StudyOutcome {
            file: self.work.file,
            title: self.work.study.title.clone(),
            runs: 0,
            done: 0,
            failed: 0,
            failure: self.failure,
        };
        if let Ok(store) = &self.work.store
            && let Ok(survey) = store.survey()
        {
            let counts = survey.counts();
            let count = |state| counts.get(&state).copied().unwrap_or(0);
            outcome.runs = survey.plan.runs().len();
            (outcome.done, outcome.failed) = (count(State::Done), count(State::Failed));
        }
        outcome
    }
}

impl<'a> Course<'a> {
    fn of(reproduction: &'a Reproduction, watch: &'a mut dyn FnMut(Event<'_>)) -> Self {
        let course = |work: &'a Work| {
            let again = work.again(&reproduction.again);
            let mut course = StudyCourse {
                work,
                again: None,
                failure: None,
                has_ended: false,
            };
            match again {
                Ok(again) => course.again = again,
                Err(error) => course.fail(error.to_string(), watch),
            }
            course
        };
        Self {
            claims: &reproduction.claims,
            again: &reproduction.again,
            studies: reproduction.works.iter().map(course).collect(),
            evidence: Evidence::default(),
            examinations: vec![None; reproduction.claims.len()],
            watch,
        }
    }

    /// Works on the studies until all have ended or it is time to stop.
    fn work(&mut self, effort: Effort, stop: &dyn Fn() -> bool) -> Ending {
        let begin = Instant::now();
        let loads_of =
            |study: &StudyCourse<'_>| study.passes().map(|pass| Load::of(pass.1)).collect();
        let loads: Vec<Vec<Load>> = self.studies.iter().map(loads_of).collect();
        let left_of = |loads: &[Load]| loads.iter().map(|load| load.left).sum();
        let costs: Vec<f64> = loads.iter().map(|loads| left_of(loads)).collect();
        let names: Vec<&str> = self.studies.iter().map(StudyCourse::name).collect();
        let order = order::cheapest_claims_first(self.claims, &names, &costs);
        let total: f64 = loads.iter().flatten().map(|load| load.all).sum();
        let left_before: f64 = costs.iter().sum();
        for (turn, &place) in order.iter().enumerate() {
            let study = &self.studies[place];
            let mut ending = match &study.work.store {
                Ok(_) => Ok(Ending::Complete),
                Err(error) => Err(error.to_string()),
            };
            // A pass that fails leaves nothing of its study to do.
            let later_turns = order[turn + 1..].iter().map(|place| costs[*place]);
            let left_in_turns: f64 = later_turns.sum();
            for (number, (specification, store)) in study.passes().enumerate() {
                let load = loads[place][number];
                let left_in_passes: f64 = left_of(&loads[place][number + 1..]);
                let limit = effort
                    .limit
                    .map(|limit| limit.saturating_sub(begin.elapsed()));
                if load.left > 0.0 {
                    if stop() {
                        return Ending::Stopped;
                    }
                    if limit.is_some_and(|limit| limit.is_zero()) {
                        return Ending::TimeUp;
                    }
                }
                let mut show = |board: &Board| {
                    let left = left_in_turns + left_in_passes + load.all * (1.0 - board.fraction);
                    let gained = left_before - left;
                    (self.watch)(Event::Progress(Stage {
                        study: study.name(),
                        number: turn + 1,
                        of: order.len(),
                        board,
                        fraction: if total > 0.0 { 1.0 - left / total } else { 1.0 },
                        left: (gained > 0.0)
                            .then(|| begin.elapsed().mul_f64(left.max(0.0) / gained)),
                    }));
                };
                let effort = Effort { limit, ..effort };
                ending = work_on(store, specification, effort, stop, &mut show)
                    .map_err(|error| error.to_string());
                if ending != Ok(Ending::Complete) {
                    break;
                }
            }
            match ending {
                Ok(Ending::Complete) => {}
                Ok(ending) => return ending,
                Err(reason) => self.studies[place].fail(reason, self.watch),
            }
            self.end(place);
            self.examine_what_has_ended();
        }
        Ending::Complete
    }

    /// Takes the results of all studies that have not ended into the evidence, and examines the rest of the claims.
    fn finish(mut self, ending: Ending) -> Outcome {
        for place in 0..self.studies.len() {
            self.end(place);
        }
        self.examine_what_has_ended();
        let published = self.published();
        Outcome {
            ending,
            published,
            drawn: None,
            studies: self.studies.into_iter().map(StudyCourse::outcome).collect(),
            examinations: self.examinations.into_iter().flatten().collect(),
        }
    }

    /// Compares the published rows with the runs that were computed again.
    fn published(&mut self) -> Vec<PublishedRows> {
        let mut all = Vec::new();
        for study in &mut self.studies {
            // A store that cannot be opened has been told of.
            let Ok(store) = &study.work.store else {
                continue;
            };
            match PublishedRows::of(study.work, store, &self.again.join(study.name())) {
                Ok(published) if published.rows > 0 => all.push(published),
                Ok(_) => {}
                Err(error) => study.fail(error.to_string(), self.watch),
            }
        }
        all
    }

    /// Takes the results of a study into the evidence.
    fn end(&mut self, place: usize) {
        let study = &mut self.studies[place];
        if std::mem::replace(&mut study.has_ended, true) {
            return;
        }
        let outcome = match &study.work.store {
            Ok(store) => {
                let again = study.again.as_ref().map(|(_, store)| store.clone());
                let outcome = self.evidence.add(store.clone(), again);
                outcome.map_err(|error| error.to_string())
            }
            Err(error) => Err(error.to_string()),
        };
        if let Err(reason) = outcome {
            study.fail(reason, self.watch);
        }
    }

    /// Examines the claims whose studies have all ended, side by side.
    fn examine_what_has_ended(&mut self) {
        let has_ended = |name| study_of(&self.studies, name).is_some_and(|study| study.has_ended);
        let all = self.claims.iter().copied().enumerate();
        let ready = all.filter(|(place, claim)| {
            self.examinations[*place].is_none() && claim.all_studies().into_iter().all(has_ended)
        });
        examine(ready.collect(), &self.evidence, |place, outcome| {
            let examination = examination(&self.claims[place], outcome, &self.studies);
            (self.watch)(Event::Examined(&examination));
            self.examinations[place] = Some(examination);
        });
    }
}

fn study_of<'a, 'b>(studies: &'b [StudyCourse<'a>], name: &str) -> Option<&'b StudyCourse<'a>> {
    studies.iter().find(|study| study.name() == name)
}

/// What came out of a claim.
fn examination(
    claim: &Claim,
    outcome: Result<Finding, ReproduceError>,
    studies: &[StudyCourse<'_>],
) -> Examination {
    // An error of a claim follows from the failure of one of its studies, if one failed.
    let failure = |name| {
        let reason = study_of(studies, name)?.failure.as_ref()?;
        Some(format!("study {name}: {reason}"))
    };
    let outcome = outcome.map_err(|error| match error {
        ReproduceError::Panicked => error.to_string(),
        error => {
            let failed_study = claim.all_studies().into_iter().find_map(failure);
            failed_study.unwrap_or_else(|| error.to_string())
        }
    });
    Examination::new(*claim, outcome)
}
