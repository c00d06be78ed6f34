//! From claims to findings: the studies that they need, worked on one after the other, and each claim examined as soon as
//! its studies have ended.

mod import;
mod order;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use peristalsis_study::{Board, Effort, Ending, Specification, State, Store, StudyError, work_on};

use crate::claim::Claim;
use crate::error::{ClaimError, make_folder};
use crate::evidence::Evidence;
use crate::examination::{Examination, experiments_named, without_panic};
use crate::studies::{Products, Size, StudyFile};
pub use import::{Import, ImportedRuns};

/// Folder of the stores below that of the results.
const STORES: &str = "stores";
/// Suffix of the store that computes runs again of which only rows were imported.
const AGAIN: &str = "-again";

/// Claims with the studies that they need, each in a store of its own.
///
/// A study in either size has the same store: what one size has computed, the other need not compute again.
#[derive(Debug)]
pub struct Reproduction {
    size: Size,
    claims: Vec<Claim>,
    works: Vec<Work>,
    stores: PathBuf,
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
    fn again(&self, stores: &Path) -> Result<Option<(Specification, Store)>, StudyError> {
        let replicates = match self.file.products {
            Products::NotNeeded => return Ok(None),
            Products::OfFirst => 1,
            Products::OfAll => self.study.replicates,
        };
        let Ok(store) = &self.store else {
            return Ok(None);
        };
        let survey = store.survey()?;
        let is_bare =
            |identity| survey.state(identity) == State::Done && !store.holds_products(identity);
        let mut needed = survey
            .plan
            .runs()
            .iter()
            .filter(|run| run.replicate < replicates);
        if !needed.any(|run| is_bare(run.identity)) {
            return Ok(None);
        }
        let study = self.study.with_replicates(replicates)?;
        let store = Store::create(&stores.join(format!("{}{AGAIN}", self.file.name)), &study)?;
        Ok(Some((study, store)))
    }
}

/// One go at a study: all of it, or the part that is computed again.
struct Pass<'a> {
    study: &'a Specification,
    store: &'a Store,
    load: Load,
}

impl<'a> Pass<'a> {
    fn of(study: &'a Specification, store: &'a Store) -> Self {
        // A study that cannot be read takes no time.
        let load = store.survey().map_or_else(
            |_| Load::default(),
            |survey| Load {
                all: survey.work(),
                left: survey.work_left(),
            },
        );
        Self { study, store, load }
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
    #[must_use]
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
}

/// The claims of these names, in the order of `all`; every claim where no name is given. Case does not matter.
///
/// # Errors
/// [`ClaimError::NoSuchExperiment`].
pub fn chosen(all: &[Claim], names: &[String]) -> Result<Vec<Claim>, ClaimError> {
    experiments_named("claim", all, |claim| claim.id, names)
}

impl Reproduction {
    /// Makes or opens the stores of the studies that the claims need, in `folder/stores`.
    ///
    /// A store that cannot be opened is told of later, and costs only the claims that need it.
    ///
    /// # Errors
    /// [`ClaimError::Folder`], [`ClaimError::NoSuchStudy`], and [`ClaimError::Study`] for a file that is not a valid study.
    pub fn prepare(
        folder: &Path,
        size: Size,
        claims: &[Claim],
        studies: &[StudyFile],
    ) -> Result<Self, ClaimError> {
        let stores = folder.join(STORES);
        make_folder(folder)?;
        make_folder(&stores)?;
        let mut works: Vec<Work> = Vec::new();
        for name in claims.iter().flat_map(|claim| claim.studies) {
            if works.iter().any(|work| work.file.name == *name) {
                continue;
            }
            let file = studies
                .iter()
                .find(|study| study.name == *name)
                .ok_or_else(|| ClaimError::NoSuchStudy((*name).to_owned()))?;
            let study = Specification::from_toml(file.path, file.text(size), |name| {
                Err(StudyError::Read {
                    path: name.into(),
                    source: std::io::Error::other("a study of the claims builds on a preset"),
                })
            })?;
            let store = Store::create(&stores.join(file.name), &study);
            works.push(Work {
                file: *file,
                study,
                store,
            });
        }
        Ok(Self {
            size,
            claims: claims.to_vec(),
            works,
            stores,
        })
    }

    /// The size of the designs.
    #[must_use]
    pub fn size(&self) -> Size {
        self.size
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
        let mut course = Course::of(self);
        let ending = course.work(effort, stop, watch);
        course.finish(ending, watch)
    }
}

/// A reproduction on its way.
struct Course<'a> {
    reproduction: &'a Reproduction,
    /// Stores of what is computed again, by the name of the study.
    again: BTreeMap<&'static str, Store>,
    /// Why a study could not be worked on or read, by name.
    failures: BTreeMap<&'static str, String>,
    /// Studies whose results are in the evidence, or cannot be.
    ended: Vec<&'static str>,
    evidence: Evidence,
    examinations: BTreeMap<&'static str, Examination>,
}

/// Work and the part of it that is left, in grains times steps.
#[derive(Clone, Copy, Debug, Default)]
struct Load {
    all: f64,
    left: f64,
}

impl<'a> Course<'a> {
    fn of(reproduction: &'a Reproduction) -> Self {
        Self {
            reproduction,
            again: BTreeMap::new(),
            failures: BTreeMap::new(),
            ended: Vec::new(),
            evidence: Evidence::default(),
            examinations: BTreeMap::new(),
        }
    }

    /// Finds which studies are computed again in part.
    fn look_for_bare_rows(
        &mut self,
        watch: &mut dyn FnMut(Event<'_>),
    ) -> Vec<Option<(Specification, Store)>> {
        let reproduction = self.reproduction;
        let mut found = Vec::new();
        for work in &reproduction.works {
            let again = work.again(&reproduction.stores).unwrap_or_else(|error| {
                self.fail(work.file.name, error.to_string(), watch);
                None
            });
            if let Some((_, store)) = &again {
                self.again.insert(work.file.name, store.clone());
            }
            found.push(again);
        }
        found
    }

    /// Works on the studies until all have ended or it is time to stop.
    fn work(
        &mut self,
        effort: Effort,
        stop: &dyn Fn() -> bool,
        watch: &mut dyn FnMut(Event<'_>),
    ) -> Ending {
        let begin = Instant::now();
        let works = &self.reproduction.works;
        let again = self.look_for_bare_rows(watch);
        let passes: Vec<Vec<Pass<'_>>> = works
            .iter()
            .zip(&again)
            .map(|(work, again)| {
                let whole = work.store.as_ref().ok().map(|store| (&work.study, store));
                let part = again.as_ref().map(|(study, store)| (study, store));
                let both = whole.into_iter().chain(part);
                both.map(|(study, store)| Pass::of(study, store)).collect()
            })
            .collect();
        let sum = |of: fn(&Load) -> f64, passes: &[Pass<'_>]| -> f64 {
            passes.iter().map(|pass| of(&pass.load)).sum()
        };
        let left = |passes: &[Pass<'_>]| sum(|load| load.left, passes);
        let costs: Vec<f64> = passes.iter().map(|passes| left(passes)).collect();
        let names: Vec<&str> = works.iter().map(|work| work.file.name).collect();
        let order = order::cheapest_claims_first(&self.reproduction.claims, &names, &costs);
        let total: f64 = passes
            .iter()
            .map(|passes| sum(|load| load.all, passes))
            .sum();
        let left_before: f64 = costs.iter().sum();
        for (turn, &place) in order.iter().enumerate() {
            let work = &works[place];
            let others_left: f64 = order[turn + 1..].iter().map(|place| costs[*place]).sum();
            let mut ending = match &work.store {
                Ok(_) => Ok(Ending::Complete),
                Err(error) => Err(error.to_string()),
            };
            for (number, pass) in passes[place].iter().enumerate() {
                let limit = effort
                    .limit
                    .map(|limit| limit.saturating_sub(begin.elapsed()));
                if pass.load.left > 0.0 {
                    if stop() {
                        return Ending::Stopped;
                    }
                    if limit.is_some_and(|limit| limit.is_zero()) {
                        return Ending::TimeUp;
                    }
                }
                let later_left = others_left + left(&passes[place][number + 1..]);
                let mut show = |board: &Board| {
                    let left = later_left + pass.load.all * (1.0 - board.fraction);
                    let gained = left_before - left;
                    watch(Event::Progress(Stage {
                        study: work.file.name,
                        number: turn + 1,
                        of: order.len(),
                        board,
                        fraction: if total > 0.0 { 1.0 - left / total } else { 1.0 },
                        left: (gained > 0.0)
                            .then(|| begin.elapsed().mul_f64(left.max(0.0) / gained)),
                    }));
                };
                let effort = Effort { limit, ..effort };
                ending = work_on(pass.store, pass.study, effort, stop, &mut show)
                    .map_err(|error| error.to_string());
                if ending != Ok(Ending::Complete) {
                    break;
                }
            }
            match ending {
                Ok(Ending::Complete) => {}
                Ok(ending) => return ending,
                Err(reason) => self.fail(work.file.name, reason, watch),
            }
            self.end(place, watch);
            self.examine_what_has_ended(watch);
        }
        Ending::Complete
    }

    /// Takes the results of all studies that have not ended into the evidence, and examines the rest of the claims.
    fn finish(mut self, ending: Ending, watch: &mut dyn FnMut(Event<'_>)) -> Outcome {
        for place in 0..self.reproduction.works.len() {
            if !self
                .ended
                .contains(&self.reproduction.works[place].file.name)
            {
                self.end(place, watch);
            }
        }
        self.examine_what_has_ended(watch);
        Outcome {
            ending,
            studies: self
                .reproduction
                .works
                .iter()
                .map(|work| self.outcome_of(work))
                .collect(),
            examinations: self
                .reproduction
                .claims
                .iter()
                .filter_map(|claim| self.examinations.remove(claim.id))
                .collect(),
        }
    }

    /// Takes the results of a study into the evidence.
    fn end(&mut self, place: usize, watch: &mut dyn FnMut(Event<'_>)) {
        let work = &self.reproduction.works[place];
        self.ended.push(work.file.name);
        let outcome = match &work.store {
            Ok(store) => self
                .evidence
                .add(store.clone(), self.again.get(work.file.name).cloned())
                .map_err(|error| error.to_string()),
            Err(error) => Err(error.to_string()),
        };
        if let Err(reason) = outcome {
            self.fail(work.file.name, reason, watch);
        }
    }

    fn fail(&mut self, study: &'static str, reason: String, watch: &mut dyn FnMut(Event<'_>)) {
        // The first reason is the cause of those that follow.
        if !self.failures.contains_key(study) {
            let reason = &*self.failures.entry(study).or_insert(reason);
            watch(Event::Trouble { study, reason });
        }
    }

    /// Examines the claims whose studies have all ended.
    fn examine_what_has_ended(&mut self, watch: &mut dyn FnMut(Event<'_>)) {
        for claim in &self.reproduction.claims {
            let is_ready = claim.studies.iter().all(|name| self.ended.contains(name));
            if is_ready && !self.examinations.contains_key(claim.id) {
                let examination = self.examine(claim);
                watch(Event::Examined(&examination));
                self.examinations.insert(claim.id, examination);
            }
        }
    }

    fn examine(&self, claim: &Claim) -> Examination {
        let outcome = without_panic(|| (claim.examine)(&self.evidence));
        // An error of a claim follows from the failure of one of its studies, if one failed.
        let failed_study = || {
            let failure = |name| Some(format!("study {name}: {}", self.failures.get(name)?));
            claim.studies.iter().copied().find_map(failure)
        };
        let outcome = outcome.map_err(|error| match error {
            ClaimError::Panicked => error.to_string(),
            error => failed_study().unwrap_or_else(|| error.to_string()),
        });
        Examination::new(*claim, outcome)
    }

    fn outcome_of(&self, work: &Work) -> StudyOutcome {
        let survey = work
            .store
            .as_ref()
            .ok()
            .and_then(|store| store.survey().ok());
        let (mut runs, mut done, mut failed) = (0, 0, 0);
        if let Some(survey) = survey {
            let counts = survey.counts();
            let count = |state: &str| counts.get(state).copied().unwrap_or(0);
            (runs, done, failed) = (survey.plan.runs().len(), count("done"), count("failed"));
        }
        StudyOutcome {
            file: work.file,
            title: work.study.title.clone(),
            runs,
            done,
            failed,
            failure: self.failures.get(work.file.name).cloned(),
        }
    }
}
