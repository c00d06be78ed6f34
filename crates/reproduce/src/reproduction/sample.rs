//! A random sample of the published rows, computed again: whoever reads a report can see that its rows are what the program
//! gives.

use std::collections::{HashMap, VecDeque};
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use peristalsis_configuration::Configuration;
use peristalsis_study::{
    Board, Effort, Ending, Identity, PlannedRun, SECONDS_A_RUN, State, Store, StudyError, Survey,
    work_on,
};
use sha2::{Digest, Sha256};

use super::{Reproduction, Work};
use crate::error::ReproduceError;

/// Grains times steps a second of one core without and with contacts that are remembered: a first guess, which the runs that
/// were computed replace.
const SPEED: [f64; 2] = [3e7, 1e7];
/// Seconds of computing that the first guess counts for.
const WEIGHT_OF_GUESS: f64 = 5.0;
/// Largest part of the time that one run may take: so that there is time for every study.
const LARGEST_PART: f64 = 0.25;
/// Time between two looks: how late it stops and shows.
const TICK: Duration = Duration::from_millis(50);

/// How many of the published rows are computed again.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Extent {
    /// This part of the rows of each study, from 0 to 1, rounded up.
    Part(f64),
    /// As many as fit into this time.
    Time(Duration),
}

impl Extent {
    /// The time, of a sample that has one.
    fn time(self) -> Option<Duration> {
        match self {
            Self::Part(_) => None,
            Self::Time(time) => Some(time),
        }
    }
}

/// A random sample of the published rows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// How large it is.
    pub extent: Extent,
    /// Seed of the draw: with the same rows and the same seed the runs of a study are drawn in the same order.
    pub seed: u64,
}

/// What was drawn.
#[derive(Clone, Debug, PartialEq)]
pub struct Drawn {
    /// The sample that was asked for.
    pub sample: Sample,
    /// Of each study, by name, how many rows could have been drawn: all, or all whose runs take no longer than a quarter of the
    /// time. Each of these was as likely as any other.
    pub within_reach: Vec<(&'static str, usize)>,
    /// Why the work ended.
    pub ending: Ending,
}

/// How far the sample is.
#[derive(Clone, Copy, Debug)]
pub struct Sampling<'a> {
    /// Runs that were computed again, those in progress, and how much of the sample is done.
    pub board: &'a Board,
    /// Studies from which a run was drawn.
    pub studies: usize,
    /// Studies that have published rows.
    pub of: usize,
}

/// A published row that may be drawn.
#[derive(Clone, Copy, Debug)]
struct Card {
    run: PlannedRun,
    /// Seconds that its run should take.
    seconds: f64,
}

/// The rows of a study in the order in which they are drawn.
struct Deck<'a> {
    work: &'a Work,
    again: PathBuf,
    survey: Survey,
    within_reach: usize,
    cards: VecDeque<Card>,
    drawn: usize,
}

impl<'a> Deck<'a> {
    /// The published rows of a study, those first whose computation was begun before; `None` where it has none.
    fn of(
        work: &'a Work,
        store: &Store,
        again: PathBuf,
        sample: Sample,
    ) -> Result<Option<Self>, ReproduceError> {
        let (survey, rows) = store.look()?;
        let rows = rows
            .texts("identity")?
            .iter()
            .zip(rows.integers("grains")?.iter().zip(rows.integers("steps")?));
        let lengths: HashMap<Identity, f64> = rows
            .filter_map(|(identity, (grains, steps))| {
                Some((identity.parse().ok()?, *grains as f64 * *steps as f64))
            })
            .collect();
        let begun = Store::open(&again).and_then(|again| again.survey()).ok();
        let state = |run: &PlannedRun| {
            let again = begun.as_ref();
            again.map_or(State::Pending, |again| again.state(run.identity))
        };
        let runs = survey.plan.runs().iter();
        let mut cards: Vec<Card> = runs
            .filter(|run| survey.is_imported(run.identity))
            .map(|run| {
                let length = lengths.get(&run.identity).copied().unwrap_or(0.0);
                let speed = speed(&survey.plan.point(run).configuration);
                Card {
                    run: *run,
                    seconds: SECONDS_A_RUN + length / speed,
                }
            })
            .collect();
        if cards.is_empty() {
            return Ok(None);
        }
        let published = cards.len();
        cards.sort_by_cached_key(|card| place(sample.seed, card.run.identity));
        match sample.extent {
            Extent::Part(part) => cards.truncate((part * cards.len() as f64).ceil() as usize),
            Extent::Time(time) => {
                let longest = LARGEST_PART * time.as_secs_f64();
                cards.retain(|card| card.seconds <= longest);
            }
        }
        let within_reach = match sample.extent {
            Extent::Part(_) => published,
            Extent::Time(_) => cards.len(),
        };
        cards.retain(|card| !matches!(state(&card.run), State::Done | State::Failed));
        cards.sort_by_key(|card| state(&card.run) != State::Checkpointed);
        Ok(Some(Self {
            work,
            again,
            survey,
            within_reach,
            cards: cards.into(),
            drawn: 0,
        }))
    }
}

/// Grains times steps a second of one core.
fn speed(configuration: &Configuration) -> f64 {
    SPEED[usize::from(configuration.remembers_contacts())]
}

/// Place of a run in the order of a draw.
fn place(seed: u64, identity: Identity) -> [u8; 32] {
    Sha256::digest(format!("peristalsis draw 1\nseed {seed}\nrun {identity}\n")).into()
}

/// What the threads share.
struct Shared<'a> {
    desk: Mutex<Desk<'a>>,
    /// A thread has ended.
    ended: Condvar,
    is_to_stop: AtomicBool,
    effort: Effort,
    sample: Sample,
    begin: Instant,
    /// When to stop.
    deadline: Option<Instant>,
}

/// What one thread at a time may look at or change.
struct Desk<'a> {
    decks: Vec<Deck<'a>>,
    board: Board,
    /// Seconds that the runs were expected to take which were computed, and those that they took.
    expected: f64,
    took: f64,
    active: usize,
    error: Option<StudyError>,
}

impl<'a> Shared<'a> {
    fn desk(&self) -> MutexGuard<'_, Desk<'a>> {
        // Each change is small, and whole even after a panic.
        self.desk.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn left(&self) -> Option<Duration> {
        let left = |deadline: Instant| deadline.saturating_duration_since(Instant::now());
        self.deadline.map(left)
    }

    /// Draws runs and computes them until there are none, or it is time to stop.
    fn work(&self, slot: usize) {
        let mut outcome = Ok(());
        while outcome.is_ok() && !self.is_to_stop.load(Ordering::Relaxed) {
            let Some((deck, card)) = self.draw() else {
                break;
            };
            outcome = self.compute(slot, deck, card);
        }
        let mut desk = self.desk();
        desk.board.workers[slot] = None;
        desk.active -= 1;
        if let Err(error) = outcome {
            self.is_to_stop.store(true, Ordering::Relaxed);
            desk.error.get_or_insert(error);
        }
        self.ended.notify_all();
    }

    /// The next run of the study from which fewest were drawn, of these the shortest. A study whose next run takes longer
    /// than there is time is done with: to pass over it would favour short runs.
    fn draw(&self) -> Option<(usize, Card)> {
        let left = self.sample.extent.time().and_then(|_| self.left());
        let mut desk = self.desk();
        let pace = (WEIGHT_OF_GUESS + desk.took) / (WEIGHT_OF_GUESS + desk.expected);
        loop {
            let decks = desk.decks.iter().enumerate();
            let next = decks
                .filter_map(|(place, deck)| Some((deck.drawn, deck.cards.front()?.seconds, place)));
            let (.., place) =
                next.min_by(|one, other| one.0.cmp(&other.0).then(one.1.total_cmp(&other.1)))?;
            let deck = &mut desk.decks[place];
            let card = deck.cards.pop_front()?;
            if left.is_some_and(|left| pace * card.seconds > left.as_secs_f64()) {
                deck.cards.clear();
                continue;
            }
            deck.drawn += 1;
            return Some((place, card));
        }
    }

    /// Computes a run in the store of the runs that are computed again.
    fn compute(&self, slot: usize, deck: usize, card: Card) -> Result<(), StudyError> {
        let (store, study) = {
            let desk = self.desk();
            let Deck { work, survey, .. } = &desk.decks[deck];
            let is_drawn = |run: &PlannedRun| run.identity == card.run.identity;
            let study = work.study.part(&survey.plan, is_drawn);
            (Store::create(&desk.decks[deck].again, &study)?, study)
        };
        let begin = Instant::now();
        let effort = Effort {
            workers: 1,
            limit: self.left(),
            ..self.effort
        };
        let stop = || self.is_to_stop.load(Ordering::Relaxed);
        let ending = work_on(&store, &study, effort, &stop, &mut |of_run| {
            let mut desk = self.desk();
            desk.board.workers[slot] = of_run.workers.first().cloned().flatten();
            desk.board.news.extend(of_run.news.iter().cloned());
        })?;
        let mut desk = self.desk();
        if ending == Ending::Complete {
            let has_failed = store.survey()?.state(card.run.identity) == State::Failed;
            desk.board.failed += usize::from(has_failed);
            desk.board.done += usize::from(!has_failed);
            desk.expected += card.seconds;
            desk.took += begin.elapsed().as_secs_f64();
        }
        Ok(())
    }

    /// Obeys and shows until no thread is left.
    fn coordinate(&self, stop: &dyn Fn() -> bool, watch: &mut dyn FnMut(Sampling<'_>)) -> Ending {
        let mut ending = Ending::Complete;
        loop {
            ending = ending.now(stop, self.begin, self.effort.limit);
            let is_over = ending != Ending::Complete;
            self.is_to_stop.fetch_or(is_over, Ordering::Relaxed);
            let mut desk = self.desk();
            let board = self.board(&mut desk);
            let (studies, of) = (desk.studies(), desk.decks.len());
            let is_last = desk.active == 0;
            drop(desk);
            watch(Sampling {
                board: &board,
                studies,
                of,
            });
            if is_last {
                return ending;
            }
            drop(self.ended.wait_timeout(self.desk(), TICK));
        }
    }

    /// What is shown just now.
    fn board(&self, desk: &mut Desk<'_>) -> Board {
        let mut board = desk.board.clone();
        desk.board.news.clear();
        let elapsed = self.begin.elapsed();
        (board.fraction, board.left) = match self.sample.extent {
            Extent::Time(time) => {
                let left = self.left();
                let part = elapsed.as_secs_f64() / time.as_secs_f64();
                (part.min(1.0), left)
            }
            Extent::Part(_) => {
                let cards = desk.decks.iter().flat_map(|deck| &deck.cards);
                let left: f64 = cards.map(|card| card.seconds).sum();
                let part = desk.expected / (desk.expected + left).max(SECONDS_A_RUN);
                let left = (part > 0.0).then(|| elapsed.mul_f64((1.0 - part) / part));
                (part, left)
            }
        };
        board
    }
}

impl Desk<'_> {
    /// Studies from which a run was drawn.
    fn studies(&self) -> usize {
        self.decks.iter().filter(|deck| deck.drawn > 0).count()
    }
}

impl Reproduction {
    /// Computes a random sample of the published rows again, which are those that were imported: beside them, so that
    /// [`Outcome::published`](super::Outcome::published) can tell whether they come out the same.
    ///
    /// Studies take turns; a run whose computation was begun before goes first. `stop` is asked often whether to stop; `watch`
    /// is shown how far the sample is. Both are called from the calling thread.
    ///
    /// # Errors
    /// Errors of the stores: a disk that is full, a file that cannot be written. A study whose store cannot be opened has no
    /// published rows.
    pub fn sample(
        &self,
        sample: Sample,
        effort: Effort,
        stop: &dyn Fn() -> bool,
        watch: &mut dyn FnMut(Sampling<'_>),
    ) -> Result<Drawn, ReproduceError> {
        let mut decks = Vec::new();
        for work in &self.works {
            if let Ok(store) = &work.store {
                decks.extend(Deck::of(
                    work,
                    store,
                    self.again.join(work.file.name),
                    sample,
                )?);
            }
        }
        let within_reach = decks
            .iter()
            .map(|deck| (deck.work.file.name, deck.within_reach));
        let within_reach = within_reach.collect();
        let workers = effort.workers.max(1);
        let total = match sample.extent {
            Extent::Part(_) => decks.iter().map(|deck| deck.cards.len()).sum(),
            Extent::Time(_) => 0,
        };
        let begin = Instant::now();
        let deadline = [sample.extent.time(), effort.limit]
            .into_iter()
            .flatten()
            .min();
        let shared = Shared {
            desk: Mutex::new(Desk {
                decks,
                board: Board {
                    total,
                    workers: vec![None; workers],
                    ..Board::default()
                },
                expected: 0.0,
                took: 0.0,
                active: workers,
                error: None,
            }),
            ended: Condvar::new(),
            is_to_stop: AtomicBool::new(false),
            effort,
            sample,
            begin,
            deadline: deadline.map(|time| begin + time),
        };
        let ending = std::thread::scope(|scope| {
            for slot in 0..workers {
                let shared = &shared;
                scope.spawn(move || shared.work(slot));
            }
            shared.coordinate(stop, watch)
        });
        let desk = shared.desk.into_inner();
        let mut desk = desk.unwrap_or_else(PoisonError::into_inner);
        match desk.error.take() {
            Some(error) => Err(error.into()),
            None => Ok(Drawn {
                sample,
                within_reach,
                ending,
            }),
        }
    }
}
