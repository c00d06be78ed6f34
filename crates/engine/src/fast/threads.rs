//! The threads that a simulation shares its work out to.

use std::sync::Arc;

use rayon::ThreadPool;

use crate::error::EngineError;
use crate::parameters::Kernel;

/// Moving spheres that a thread must have to itself to pay: some ms of work a step, as measured with two (BENCHMARKS.md).
const SPHERES_OF_A_THREAD: usize = 20_000;

/// How many threads pay for so many moving spheres where so many processors are free; the reference kernel has one.
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

/// Threads, where there are to be more than one.
#[derive(Clone, Debug, Default)]
pub(crate) struct Threads(Option<Arc<ThreadPool>>);

/// Work that can be cut in two: the first so many items, and the rest.
pub(crate) trait Cut: Sized + Send {
    fn cut(self, at: usize) -> (Self, Self);
}

impl Cut for () {
    fn cut(self, _: usize) -> (Self, Self) {
        ((), ())
    }
}

impl Threads {
    /// So many threads.
    ///
    /// # Errors
    /// [`EngineError::Threads`] where the system gives no more.
    pub(crate) fn new(threads: usize) -> Result<Self, EngineError> {
        let pool = (threads > 1)
            .then(|| rayon::ThreadPoolBuilder::new().num_threads(threads).build())
            .transpose()
            .map_err(|error| EngineError::Threads {
                threads,
                reason: error.to_string(),
            })?;
        Ok(Self(pool.map(Arc::new)))
    }

    pub(crate) fn number(&self) -> usize {
        self.0.as_ref().map_or(1, |pool| pool.current_num_threads())
    }

    /// Never where there are no threads, so that what would share work out is not compiled there.
    pub(crate) fn several(&self) -> bool {
        cfg!(not(target_family = "wasm")) && self.0.is_some()
    }

    /// Does work that shares itself out.
    pub(crate) fn install<R: Send>(&self, work: impl FnOnce() -> R + Send) -> R {
        match &self.0 {
            Some(pool) => pool.install(work),
            None => work(),
        }
    }

    /// Does two pieces of work, side by side where there are threads.
    pub(crate) fn join<A: Send, B: Send>(
        &self,
        one: impl FnOnce() -> A + Send,
        other: impl FnOnce() -> B + Send,
    ) -> (A, B) {
        match self.several() {
            true => rayon::join(one, other),
            false => (one(), other()),
        }
    }

    /// Does `work` with each of `stretches` and that part of `all`, `length` items long, which belongs to it.
    pub(crate) fn each<S: Send, P: Cut>(
        &self,
        stretches: &mut [S],
        all: P,
        length: &(impl Fn(&S) -> usize + Sync),
        work: &(impl Fn(&mut S, P) + Sync),
    ) {
        match stretches {
            [] => {}
            [one] => work(one, all),
            _ => {
                // One thread goes through them in their order.
                let middle = if self.several() {
                    stretches.len() / 2
                } else {
                    1
                };
                let (left, right) = stretches.split_at_mut(middle);
                let (of_left, of_right) = all.cut(left.iter().map(length).sum());
                self.join(
                    || self.each(left, of_left, length, work),
                    || self.each(right, of_right, length, work),
                );
            }
        }
    }
}
