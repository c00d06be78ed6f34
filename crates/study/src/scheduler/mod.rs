//! One process that works on a store: several workers, each with one run at a time.
//!
//! Several processes, on several machines, may share a store: each run is leased to one of them. A lease is void when its
//! owner has died or been silent for [`LEASE_TIMEOUT`]; a worker that lost its lease abandons the run.

mod board;
mod worker;

use std::collections::HashMap;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use crate::error::{Result, StudyError};
use crate::estimate::work;
use crate::identity::Identity;
use crate::plan::{Plan, PlannedRun};
use crate::refinement::{brackets, refine};
use crate::specification::Specification;
use crate::store::{Assignment, Claim, Entry, Index, LEASE_TIMEOUT, Owner, State, Store, finding};
pub use board::{Board, Working};

/// Time between two looks of the coordinator: how late it stops and shows.
const TICK: Duration = Duration::from_millis(50);
/// Time between two heartbeats.
const HEARTBEAT: Duration = Duration::from_secs(5);
/// Time between two measurements of how far the study is.
const MEASUREMENT: Duration = Duration::from_millis(300);
/// Time after which a worker without work asks again.
const IDLE: Duration = Duration::from_millis(300);

/// How a process works on a study.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Effort {
    /// Runs at a time, a processor each; what fewer runs leave free, their threads take.
    pub workers: usize,
    /// Time between two checkpoints of a run.
    pub checkpoint_interval: Duration,
    /// Time after which to stop, every run in progress saved.
    pub limit: Option<Duration>,
}

/// Why a process ended its work.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ending {
    /// Every run of the study has ended.
    Complete,
    /// It was asked to stop.
    Stopped,
    /// Its time was up.
    TimeUp,
}

impl Ending {
    /// What the end is by now: once work is to end, the reason stays.
    pub fn now(self, stop: &dyn Fn() -> bool, begin: Instant, limit: Option<Duration>) -> Self {
        match self {
            Self::Complete if stop() => Self::Stopped,
            Self::Complete if limit.is_some_and(|limit| begin.elapsed() >= limit) => Self::TimeUp,
            decided => decided,
        }
    }
}

/// State that the threads of a process share.
struct Shared<'a> {
    store: &'a Store,
    study: &'a Specification,
    effort: Effort,
    owner: Owner,
    stop: AtomicBool,
    common: Mutex<Common>,
    /// A run or a worker has ended.
    ended: Condvar,
    /// The work of each worker; under a lock of its own, so that a run goes on while another is written into the index.
    working: Mutex<Vec<Option<Working>>>,
}

/// State behind the lock.
struct Common {
    index: Index,
    plan: Plan,
    /// What the index said last, rows apart.
    entries: HashMap<Identity, Entry>,
    news: Vec<String>,
    /// Part of each run that was there when this process took it up, where it was begun before.
    taken_up: HashMap<Identity, f64>,
    /// The first error that ended a thread.
    error: Option<StudyError>,
    /// Threads at work.
    active: usize,
    /// Runs that were leased when a thread found no other last; 0 since one was found.
    leased: usize,
}

impl Common {
    /// Reads the index again, and adds the points that refinement asks for; answers whether there are any.
    fn refresh(&mut self, study: &Specification) -> Result<bool> {
        self.entries = self.index.findings()?;
        let entries = &self.entries;
        let found = |identity: &Identity| finding(entries, identity);
        Ok(refine(study, &mut self.plan, &found))
    }
}

impl Shared<'_> {
    fn common(&self) -> MutexGuard<'_, Common> {
        // The state is whole even after a panic: each change is one assignment or one transaction.
        self.common.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The work of each worker.
    fn working(&self) -> MutexGuard<'_, Vec<Option<Working>>> {
        self.working.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn is_stopped(&self) -> bool {
        self.stop.load(Ordering::Relaxed)
    }

    /// Takes a run that is free.
    fn claim(&self) -> Result<Claim> {
        let mut common = self.common();
        loop {
            common.refresh(self.study)?;
            let order: Vec<Identity> = common.plan.runs().iter().map(|run| run.identity).collect();
            let claim = common.index.claim(&order, &self.owner, LEASE_TIMEOUT)?;
            // Another process may have ended the last run between the look and the claim: that may ask for more points.
            if claim == Claim::Nothing && common.refresh(self.study)? {
                continue;
            }
            return Ok(claim);
        }
    }

    /// Whether this process still has the lease of a run.
    fn holds(&self, identity: Identity) -> Result<bool> {
        let held = self.common().index.renew(&self.owner)?;
        Ok(held.contains(&identity))
    }

    /// Gives a lease back with what has become of the run.
    fn release(&self, identity: Identity, entry: Option<&Entry>) -> Result<bool> {
        let mut common = self.common();
        let outcome = common.index.release(identity, &self.owner, entry);
        self.ended.notify_all();
        outcome
    }

    /// Waits until a run or a worker of this process has ended, but no longer than so.
    fn wait(&self, longest: Duration) {
        drop(self.ended.wait_timeout(self.common(), longest));
    }

    fn tell(&self, news: String) {
        self.common().news.push(news);
    }

    fn assignment(&self, identity: Identity) -> (Assignment, String) {
        let common = self.common();
        let mut runs = common.plan.runs().iter();
        let run = runs.find(|run| run.identity == identity);
        let run = run.expect("what is claimed is a run of the plan");
        let assignment = Assignment::of(&common.plan, run);
        let words = common.plan.point(run).in_words();
        (assignment, format!("{words}, replicate {}", run.replicate))
    }
}

/// Works on a study until all its runs have ended, or it is asked to stop.
///
/// `stop` is asked often whether to stop; `watch` is shown how far the study is. Both are called from the calling thread.
///
/// # Errors
/// The first error of the store: a disk that is full, a file that cannot be written. All runs are saved as far as that
/// allows, and can go on.
pub fn work_on(
    store: &Store,
    study: &Specification,
    effort: Effort,
    stop: &dyn Fn() -> bool,
    watch: &mut dyn FnMut(&Board),
) -> Result<Ending> {
    let mut index = store.index()?;
    let news = store.check_changed(&mut index)?;
    let workers = effort.workers.max(1);
    let mut common = Common {
        index,
        plan: study.plan().clone(),
        entries: HashMap::new(),
        news,
        taken_up: HashMap::new(),
        error: None,
        active: workers,
        leased: 0,
    };
    common.refresh(study)?;
    let shared = Shared {
        store,
        study,
        effort,
        owner: Owner::new(),
        stop: AtomicBool::new(false),
        common: Mutex::new(common),
        ended: Condvar::new(),
        working: Mutex::new(vec![None; workers]),
    };
    let mut ending = Ending::Complete;
    std::thread::scope(|scope| {
        for slot in 0..workers {
            let shared = &shared;
            scope.spawn(move || worker::work(shared, slot));
        }
        ending = coordinate(&shared, stop, watch);
    });
    let common = shared.common.into_inner();
    let mut common = common.unwrap_or_else(PoisonError::into_inner);
    if let Some(error) = common.error.take() {
        return Err(error);
    }
    let has_ended = |run: &PlannedRun| finding(&common.entries, &run.identity).is_some();
    if common.plan.runs().iter().all(has_ended) {
        // A request to stop came when nothing was left to do.
        return Ok(Ending::Complete);
    }
    Ok(ending)
}

/// Keeps the leases, obeys and shows, until no worker is left.
fn coordinate(
    shared: &Shared<'_>,
    stop: &dyn Fn() -> bool,
    watch: &mut dyn FnMut(&Board),
) -> Ending {
    let begin = Instant::now();
    let mut ending = Ending::Complete;
    let mut heartbeat = Instant::now();
    let mut gauge = Gauge::new(&shared.common());
    loop {
        let is_last = shared.common().active == 0;
        if !is_last {
            ending = ending.now(stop, begin, shared.effort.limit);
            let is_over = ending != Ending::Complete;
            shared.stop.fetch_or(is_over, Ordering::Relaxed);
        }
        let mut common = shared.common();
        if heartbeat.elapsed() > HEARTBEAT || is_last {
            heartbeat = Instant::now();
            let renewed = common.index.renew(&shared.owner);
            let outcome = renewed.and_then(|_| common.refresh(shared.study));
            if let Err(error) = outcome {
                shared.stop.store(true, Ordering::Relaxed);
                common.error.get_or_insert(error);
            }
        }
        let working = shared.working().clone();
        gauge.look(shared.study, &mut common, working, is_last);
        drop(common);
        watch(&gauge.board);
        if is_last {
            return ending;
        }
        shared.wait(TICK);
    }
}

/// Measures how far a study is, and how fast it goes.
struct Gauge {
    begin: Instant,
    /// Part of the work that had ended when the measurement began.
    before: f64,
    /// What the estimates were made from, and they themselves.
    brackets: (usize, Vec<crate::Bracket>),
    measured: Option<Instant>,
    board: Board,
}

impl Gauge {
    fn new(common: &Common) -> Self {
        Self {
            begin: Instant::now(),
            before: fraction(common, &[]),
            brackets: (usize::MAX, Vec::new()),
            measured: None,
            board: Board::default(),
        }
    }

    /// Brings the board up to date: the workers always, the rest now and then.
    fn look(
        &mut self,
        study: &Specification,
        common: &mut Common,
        working: Vec<Option<Working>>,
        is_last: bool,
    ) {
        let is_idle = working.iter().all(Option::is_none);
        self.board.waits_for = if is_idle { common.leased } else { 0 };
        self.board.workers = working;
        self.board.news = std::mem::take(&mut common.news);
        let is_old = |last: Instant| last.elapsed() > MEASUREMENT;
        if is_last || self.measured.is_none_or(is_old) {
            self.measure(study, common);
            self.measured = Some(Instant::now());
        }
    }

    fn measure(&mut self, study: &Specification, common: &Common) {
        let runs = common.plan.runs();
        let count = |state: State| {
            let entries = runs.iter().map(|run| common.entries.get(&run.identity));
            entries
                .flatten()
                .filter(|entry| entry.state == state)
                .count()
        };
        let (done, failed) = (count(State::Done), count(State::Failed));
        if self.brackets.0 != done + failed {
            let found = |identity: &Identity| finding(&common.entries, identity);
            self.brackets = (done + failed, brackets(study, &common.plan, &found));
        }
        let fraction = fraction(common, &self.board.workers);
        let taken_up = |run: &PlannedRun| common.taken_up.get(&run.identity).copied();
        let gained = fraction - self.before - part_of_work(common, taken_up);
        let left = (gained > 0.0).then(|| self.begin.elapsed().mul_f64((1.0 - fraction) / gained));
        self.board = Board {
            total: runs.len(),
            done,
            failed,
            fraction,
            left,
            brackets: self.brackets.1.clone(),
            ..std::mem::take(&mut self.board)
        };
    }
}

/// Part of the work of a study that is done.
fn fraction(common: &Common, working: &[Option<Working>]) -> f64 {
    let part_of = |working: &Working| Some((working.identity, working.progress?.part()));
    let working = working.iter().flatten().filter_map(part_of);
    let working: HashMap<Identity, f64> = working.collect();
    part_of_work(common, |run| {
        match common.entries.get(&run.identity).map(|entry| entry.state) {
            Some(State::Done | State::Failed) => Some(1.0),
            _ => working.get(&run.identity).copied(),
        }
    })
}

/// Part of the work of a study that these parts of its runs are.
fn part_of_work(common: &Common, part: impl Fn(&PlannedRun) -> Option<f64>) -> f64 {
    let (mut all, mut parts) = (0.0, 0.0);
    for run in common.plan.runs() {
        let work = work(&common.plan.point(run).configuration);
        all += work;
        parts += work * part(run).unwrap_or(0.0);
    }
    if all > 0.0 { parts / all } else { 1.0 }
}
