//! The threads that a simulation shares its work out to.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Condvar, Mutex, PoisonError};
use std::time::{Duration, Instant};
use std::{process, thread};

use rayon::{ThreadPool, ThreadPoolBuilder, Yield};

use crate::error::EngineError;
use crate::fast::machine::{Apart, Team};
use crate::parameters::Kernel;

/// Moving spheres that a thread must have to itself to pay: some 0.1 ms of work a step, as measured with two (BENCHMARKS.md).
pub const SPHERES_OF_A_THREAD: usize = 2_000;

/// Number of threads that pay for `spheres` moving spheres on `processors` free processors; 1 for the reference kernel.
pub fn threads_that_pay(kernel: Kernel, spheres: usize, processors: usize) -> usize {
    match kernel {
        Kernel::Reference => 1,
        Kernel::Fast => (spheres / SPHERES_OF_A_THREAD).clamp(1, processors.max(1)),
    }
}

/// Processors that this process may use.
pub fn processors() -> usize {
    std::thread::available_parallelism().map_or(1, |number| number.get())
}

/// Number of this process, where there are processes.
fn this_process() -> u32 {
    if cfg!(target_family = "wasm") {
        0
    } else {
        process::id()
    }
}

/// Whether there are threads at all: where there are none, what would share work out is not compiled.
pub(crate) const THREADS_EXIST: bool = cfg!(not(target_family = "wasm"));

/// Stretches of work for each thread, at least and at most: one that is done early takes what others have not begun.
const PER_THREAD: [usize; 2] = [2, 8];
/// Spheres of a stretch where there may be more than the least: what neighbouring stretches both do is little beside it.
const SPHERES_OF_A_STRETCH: usize = 4_000;

/// During an advance a thread without work stays awake for so long: between the parts of a step that are shared out one
/// thread may prepare the next for some 0.1 ms.
const PATIENCE: Duration = Duration::from_micros(100);
/// Then it looks again at such intervals; a chain of legs waits for it as long.
const NAP: Duration = Duration::from_micros(50);
/// Awake, it looks so often for work of its team before it looks for work of rayon.
const LOOKS: usize = 16;

/// Threads, where there are to be more than one.
#[derive(Clone, Debug, Default)]
pub(crate) struct Threads(Option<Arc<Pool>>);

#[derive(Debug)]
struct Pool {
    threads: ThreadPool,
    service: Service,
}

/// What the threads of a pool serve, until this is dropped.
#[derive(Debug)]
struct Service(Arc<Served>);

#[derive(Debug)]
struct Served {
    /// Where the threads are: a fork of the process has none of them.
    process: u32,
    team: Team,
    /// How many advances go on.
    advances: AtomicUsize,
    /// Whether the pool is at its end.
    ended: Mutex<bool>,
    /// Told of each advance that begins, and of the end.
    changed: Condvar,
}

/// Work that can be cut in two: the first so many items, and the rest.
pub(crate) trait Cut: Sized + Send {
    fn cut(self, at: usize) -> (Self, Self);
}

impl Cut for () {
    fn cut(self, _: usize) -> (Self, Self) {
        ((), ())
    }
}

impl<A: Cut, B: Cut> Cut for (A, B) {
    fn cut(self, at: usize) -> (Self, Self) {
        let ((first, first_rest), (second, second_rest)) = (self.0.cut(at), self.1.cut(at));
        ((first, second), (first_rest, second_rest))
    }
}

impl<T: Send> Cut for &mut [T] {
    fn cut(self, at: usize) -> (Self, Self) {
        self.split_at_mut(at)
    }
}

impl<T: Sync> Cut for &[T] {
    fn cut(self, at: usize) -> (Self, Self) {
        self.split_at(at)
    }
}

impl Threads {
    /// So many threads.
    ///
    /// # Errors
    /// [`EngineError::Threads`] where the system gives no more.
    pub(crate) fn new(threads: usize) -> Result<Self, EngineError> {
        if threads < 2 {
            return Ok(Self::default());
        }
        if !THREADS_EXIST {
            return Err(EngineError::Threads {
                threads,
                reason: "WebAssembly has no threads".to_owned(),
            });
        }
        let service = Service(Arc::new(Served {
            process: this_process(),
            team: Team::new(threads),
            advances: AtomicUsize::new(0),
            ended: Mutex::new(false),
            changed: Condvar::new(),
        }));
        let served = Arc::clone(&service.0);
        // A thread serves from its start on. One that began to serve within other work, while it waits for the rest of that,
        // would never come back to it.
        let pool = ThreadPoolBuilder::new()
            .num_threads(threads)
            .start_handler(move |member| served.serve(member))
            .build();
        let threads = pool.map_err(|error| EngineError::Threads {
            threads,
            reason: error.to_string(),
        })?;
        Ok(Self(Some(Arc::new(Pool { threads, service }))))
    }

    pub(crate) fn number(&self) -> usize {
        let pool = self.pool();
        pool.map_or(1, |pool| pool.threads.current_num_threads())
    }

    /// Whether they are in this process, not in one that it was forked from.
    pub(crate) fn are_here(&self) -> bool {
        let pool = self.pool();
        pool.is_none_or(|pool| pool.service.0.process == this_process())
    }

    /// Which of them this one is, if any.
    fn index(&self) -> Option<usize> {
        self.pool()?.threads.current_thread_index()
    }

    fn team(&self) -> Option<&Team> {
        self.pool().map(|pool| &pool.service.0.team)
    }

    /// Into how many stretches a work on so many spheres is best cut.
    pub(crate) fn stretches(&self, spheres: usize) -> usize {
        let [least, most] = PER_THREAD;
        match self.number() {
            1 => 1,
            threads => threads * (spheres / threads / SPHERES_OF_A_STRETCH).clamp(least, most),
        }
    }

    /// Which thread one of so many stretches belongs to: each has as many as the others, side by side.
    fn owner(&self, stretch: usize, stretches: usize) -> usize {
        ((stretch + 1) * self.number() - 1) / stretches
    }

    pub(crate) fn several(&self) -> bool {
        self.pool().is_some()
    }

    fn pool(&self) -> Option<&Pool> {
        self.0.as_deref().filter(|_| THREADS_EXIST)
    }

    /// Does work that shares itself out, part after part; the threads stay awake for the parts.
    pub(crate) fn install<R: Send>(&self, work: impl FnOnce() -> R + Send) -> R {
        let Some(pool) = self.pool() else {
            return work();
        };
        let _advance = Advance::begin(&pool.service.0);
        pool.threads.install(work)
    }

    /// Does `work` with each of `stretches` and that part of `all` which belongs to it, `length` items long.
    ///
    /// The first belong to the first thread and so on: what a thread wrote in one part of a step, it mostly finds near at
    /// hand in the next.
    pub(crate) fn each<S: Send, P: Cut>(
        &self,
        stretches: &mut [S],
        all: P,
        length: &(impl Fn(&S) -> usize + Sync),
        work: &(impl Fn(&mut S, P) + Sync),
    ) {
        let none = Chains::<(), 0> {
            legs: [],
            stretch: &|()| 0,
            work: &|()| (),
        };
        self.each_beside(stretches, all, length, work, &none);
    }

    /// Does that, and the legs of the chains.
    pub(crate) fn each_beside<S: Send, P: Cut, L: Sync, const CHAINS: usize>(
        &self,
        stretches: &mut [S],
        mut all: P,
        length: &(impl Fn(&S) -> usize + Sync),
        work: &(impl Fn(&mut S, P) + Sync),
        chains: &Chains<'_, L, CHAINS>,
    ) {
        let Some(team) = self.team() else {
            for stretch in stretches {
                let (own, rest) = all.cut(length(stretch));
                all = rest;
                work(stretch, own);
            }
            chains.legs.into_iter().flatten().for_each(chains.work);
            return;
        };
        let number = stretches.len();
        let mut parts = Vec::with_capacity(number);
        for stretch in stretches {
            let (own, rest) = all.cut(length(stretch));
            all = rest;
            parts.push(Mutex::new(Some((stretch, own))));
        }
        let threads = self.number();
        // The next stretch of each thread.
        let next = (0..threads).map(|owner| Apart(AtomicUsize::new(owner * number / threads)));
        let next: Vec<_> = next.collect();
        let done = [const { AtomicUsize::new(0) }; CHAINS];
        team.call(&|| {
            let index = self.index();
            let belongs = |leg: &L| Some(self.owner((chains.stretch)(leg), number)) == index;
            let mut next_leg = [0; CHAINS];
            let thread = index.unwrap_or(0);
            for owner in (thread..threads).chain(0..thread) {
                let (Apart(next_part), end) = (&next[owner], (owner + 1) * number / threads);
                while next_part.load(Ordering::Relaxed) < end {
                    chains.go_on(&done, &mut next_leg, &belongs, false);
                    let part = next_part.fetch_add(1, Ordering::Relaxed);
                    let part = parts[..end].get(part);
                    let part = part.and_then(|part| part.lock().ok()?.take());
                    if let Some((stretch, own)) = part {
                        work(stretch, own);
                    }
                }
            }
            if chains.go_on(&done, &mut next_leg, &belongs, true) {
                // Others may wait for a leg that nobody does if this thread leaves and the call ends.
                for (legs, done) in chains.legs.iter().zip(&done) {
                    wait_for(legs.len(), done);
                }
            }
        });
        for (legs, done) in chains.legs.into_iter().zip(done) {
            legs[done.into_inner()..].iter().for_each(chains.work);
        }
    }
}

/// Chains of legs; the legs of a chain are done one after the other.
pub(crate) struct Chains<'a, L, const CHAINS: usize> {
    pub(crate) legs: [&'a [L]; CHAINS],
    /// The stretch that a leg belongs to, and so does its thread: this does the leg between its stretches or behind them. Of a
    /// thread that does not come in time the caller does it.
    pub(crate) stretch: &'a (dyn Fn(&L) -> usize + Sync),
    pub(crate) work: &'a (dyn Fn(&L) + Sync),
}

impl<L, const CHAINS: usize> Chains<'_, L, CHAINS> {
    /// Does the legs from `next` on that belong to this thread, while their turn has come; if it `waits`, all, and answers
    /// false where the turn of one does not come.
    fn go_on(
        &self,
        done: &[AtomicUsize; CHAINS],
        next: &mut [usize; CHAINS],
        belongs: &impl Fn(&L) -> bool,
        waits: bool,
    ) -> bool {
        for ((legs, done), next) in self.legs.iter().zip(done).zip(next) {
            while let Some(leg) = legs.get(*next) {
                if belongs(leg) {
                    let turn_has_come = done.load(Ordering::Acquire) >= *next;
                    if !turn_has_come && !waits {
                        break;
                    }
                    if !turn_has_come && !wait_for(*next, done) {
                        return false;
                    }
                    (self.work)(leg);
                    done.store(*next + 1, Ordering::Release);
                }
                *next += 1;
            }
        }
        true
    }
}

/// Waits until so many are done; answers that they are not where none has been for long.
fn wait_for(number: usize, done: &AtomicUsize) -> bool {
    let (mut last, mut since) = (0, Instant::now());
    loop {
        let now = done.load(Ordering::Acquire);
        if now >= number {
            return true;
        }
        if now != last {
            (last, since) = (now, Instant::now());
        } else if since.elapsed() > NAP {
            return false;
        }
        // Whose turn is far looks seldom: the fewer look, the sooner the next one sees that its turn has come. The one whose
        // turn it is may wait for a processor.
        (now..number).for_each(|_| core::hint::spin_loop());
        thread::yield_now();
    }
}

impl Served {
    /// Serves the team, and rayon, while there are advances, until the pool's end.
    fn serve(&self, member: usize) {
        let mut last = 0;
        while self.waits_for_an_advance() {
            let mut idle = None;
            while self.advances.load(Ordering::Relaxed) > 0 {
                let served = (0..LOOKS).any(|_| {
                    core::hint::spin_loop();
                    self.team.take_part(member, &mut last)
                });
                if served || rayon::yield_now() == Some(Yield::Executed) {
                    idle = None;
                } else if idle.get_or_insert_with(Instant::now).elapsed() > PATIENCE {
                    thread::sleep(NAP);
                } else {
                    // Another that waits for a processor may have work.
                    thread::yield_now();
                }
            }
        }
    }

    /// Sleeps until an advance goes on; answers false at the pool's end.
    fn waits_for_an_advance(&self) -> bool {
        let ended = self.ended.lock().unwrap_or_else(PoisonError::into_inner);
        let idle = |ended: &mut bool| !*ended && self.advances.load(Ordering::Relaxed) == 0;
        let ended = self.changed.wait_while(ended, idle);
        !*ended.unwrap_or_else(PoisonError::into_inner)
    }

    /// Does `change` so that no thread that falls asleep misses it.
    fn tell(&self, change: impl FnOnce(&mut bool)) {
        change(&mut self.ended.lock().unwrap_or_else(PoisonError::into_inner));
        self.changed.notify_all();
    }
}

impl Drop for Service {
    fn drop(&mut self) {
        // Elsewhere a thread may have held the lock as the process was forked, and hears nothing.
        if self.0.process == this_process() {
            self.0.tell(|ended| *ended = true);
        }
    }
}

/// An advance that goes on; its end, by a panic too.
struct Advance<'a>(&'a Served);

impl<'a> Advance<'a> {
    fn begin(served: &'a Served) -> Self {
        served.tell(|_| _ = served.advances.fetch_add(1, Ordering::Relaxed));
        Self(served)
    }
}

impl Drop for Advance<'_> {
    fn drop(&mut self) {
        self.0.advances.fetch_sub(1, Ordering::Relaxed);
    }
}

#[cfg(test)]
mod tests;
