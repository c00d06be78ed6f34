//! Work for several cores at once, handed out to threads that wait awake.
//!
//! A member says that it is at work before it looks whether the call is still open, and whoever calls closes the call before
//! it looks who is at work. All four accesses are sequentially consistent, so one of the two sees the other: a member never
//! works for a call that has returned.

use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::atomic::{AtomicBool, AtomicPtr, AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};
use std::thread;

/// On cache lines of its own.
#[derive(Debug, Default)]
#[repr(align(128))]
pub(crate) struct Apart<T>(pub(crate) T);

/// The work of a call.
type Job<'a> = &'a (dyn Fn() + Sync);

/// Threads that may help with a call, and the call.
#[derive(Debug)]
pub(crate) struct Team {
    call: Apart<Call>,
    /// How many threads are at work as each member.
    at_work: Box<[Apart<AtomicUsize>]>,
    led: Apart<AtomicBool>,
    panic: Mutex<Option<Box<dyn Any + Send>>>,
}

#[derive(Debug, Default)]
struct Call {
    /// Counts openings and closings: odd while a call is open.
    number: AtomicUsize,
    /// Where the [`Job`] of the open call is.
    job: AtomicPtr<()>,
}

impl Team {
    pub(crate) fn new(members: usize) -> Self {
        Self {
            call: Apart::default(),
            at_work: (0..members).map(|_| Apart::default()).collect(),
            led: Apart::default(),
            panic: Mutex::default(),
        }
    }

    /// Does `job` here, and once by each member who takes part before it is done here; returns when all are done. During a
    /// call of another thread, or of this one, it is done here alone.
    ///
    /// A panic of any thread becomes one of the caller. A job must not wait for work of rayon, which a caller who waits for
    /// the job does not do.
    pub(crate) fn call(&self, job: Job<'_>) {
        if self.led.0.swap(true, Ordering::Acquire) {
            job();
            return;
        }
        let at = core::ptr::from_ref(&job).cast_mut().cast();
        self.call.0.job.store(at, Ordering::Relaxed);
        self.call.0.number.fetch_add(1, Ordering::SeqCst);
        let mut panic = None;
        let open = Open {
            team: self,
            panic: &mut panic,
        };
        job();
        drop(open);
        if let Some(panic) = panic {
            resume_unwind(panic);
        }
    }

    /// Takes part in the open call, unless its number is `last`, which becomes its number; answers whether there was one.
    pub(crate) fn take_part(&self, member: usize, last: &mut usize) -> bool {
        let number = self.call.0.number.load(Ordering::Acquire);
        if number.is_multiple_of(2) || number == *last {
            return false;
        }
        let Some(Apart(at_work)) = self.at_work.get(member) else {
            return false;
        };
        *last = number;
        at_work.fetch_add(1, Ordering::SeqCst);
        let open = self.call.0.number.load(Ordering::SeqCst) == number;
        if open {
            let job = self.call.0.job.load(Ordering::Relaxed).cast::<Job<'_>>();
            // SAFETY: `call` has stored there where its job is before it opened this call. The job lives until `call`
            // returns or unwinds, which it does, by `Open`, after the call is closed and no member is at work; this one
            // said that it is before it found the call open.
            let job = unsafe { *job };
            if let Err(panic) = catch_unwind(AssertUnwindSafe(job)) {
                *self.panic.lock().unwrap_or_else(PoisonError::into_inner) = Some(panic);
            }
        }
        at_work.fetch_sub(1, Ordering::Release);
        open
    }

    fn take_panic(&self) -> Option<Box<dyn Any + Send>> {
        let mut panic = self.panic.lock().unwrap_or_else(PoisonError::into_inner);
        panic.take()
    }
}

/// An open call; its end, by a panic too.
struct Open<'a> {
    team: &'a Team,
    /// That of a member.
    panic: &'a mut Option<Box<dyn Any + Send>>,
}

impl Drop for Open<'_> {
    fn drop(&mut self) {
        let team = self.team;
        team.call.0.number.fetch_add(1, Ordering::SeqCst);
        for Apart(at_work) in &team.at_work {
            let mut looks = 0_u32;
            while at_work.load(Ordering::SeqCst) > 0 {
                looks = looks.wrapping_add(1);
                // Where there are more threads than processors, it may wait for this one.
                match looks % 256 {
                    0 => thread::yield_now(),
                    _ => core::hint::spin_loop(),
                }
            }
        }
        *self.panic = team.take_panic();
        team.led.0.store(false, Ordering::Release);
    }
}

#[cfg(all(test, not(target_family = "wasm")))]
mod tests {
    use super::*;

    /// Calls `job` so many times, with so many members beside; answers how often each of them did it.
    fn called(times: usize, members: usize, job: &(dyn Fn() + Sync)) -> Vec<usize> {
        let team = Team::new(members);
        let goes_on = AtomicBool::new(true);
        let serve = |member: usize| {
            let (mut last, mut done) = (0, 0);
            while goes_on.load(Ordering::Relaxed) {
                done += usize::from(team.take_part(member, &mut last));
                thread::yield_now();
            }
            done
        };
        thread::scope(|scope| {
            let members: Vec<_> = (0..members)
                .map(|member| scope.spawn(move || serve(member)))
                .collect();
            let calls = || (0..times).for_each(|_| team.call(job));
            let outcome = catch_unwind(AssertUnwindSafe(calls));
            goes_on.store(false, Ordering::Relaxed);
            let done = members.into_iter().map(|member| member.join());
            let done = done
                .map(|done| done.expect("members catch panics"))
                .collect();
            if let Err(panic) = outcome {
                resume_unwind(panic);
            }
            done
        })
    }

    #[test]
    fn a_job_is_done_by_the_caller_and_at_most_once_by_each_member() {
        for members in [0, 1, 3] {
            let done = AtomicUsize::new(0);
            let of_members = called(100, members, &|| {
                done.fetch_add(1, Ordering::Relaxed);
            });
            assert!(of_members.iter().all(|&done| done <= 100));
            assert_eq!(done.into_inner(), 100 + of_members.iter().sum::<usize>());
        }
    }

    #[test]
    fn a_member_that_is_waited_for_comes() {
        let done = AtomicUsize::new(0);
        called(20, 1, &|| {
            // Both must have begun before either goes on.
            let before = done.fetch_add(1, Ordering::SeqCst);
            while done.load(Ordering::SeqCst) < before / 2 * 2 + 2 {
                thread::yield_now();
            }
        });
        assert_eq!(done.into_inner(), 40);
    }

    #[test]
    fn a_call_within_a_call_is_done_alone() {
        let team = Team::new(1);
        let done = AtomicUsize::new(0);
        team.call(&|| {
            team.call(&|| {
                done.fetch_add(1, Ordering::Relaxed);
            });
        });
        assert_eq!(done.into_inner(), 1);
    }

    #[test]
    fn panics_of_the_caller_and_of_members_come_to_the_caller() {
        let here = thread::current().id();
        for by_caller in [true, false] {
            let begun = AtomicUsize::new(0);
            let job = || {
                begun.fetch_add(1, Ordering::SeqCst);
                while begun.load(Ordering::SeqCst) < 2 {
                    thread::yield_now();
                }
                assert_ne!(thread::current().id() == here, by_caller, "as it should");
            };
            assert!(catch_unwind(AssertUnwindSafe(|| called(1, 1, &job))).is_err());
        }
    }
}
