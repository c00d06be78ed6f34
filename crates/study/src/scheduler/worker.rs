//! One thread: takes a run, advances it, seals it, takes the next.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::Ordering;
use std::time::Instant;

use peristalsis_run::{Pace, Run, RunError, Status, Summary};

use super::{IDLE, Shared, Working};
use crate::error::{Result, StudyError};
use crate::identity::Identity;
use crate::store::{Assignment, Claim, Entry, RunFiles, State, Verdict, done, not_whole};

/// State of a run that has ended, well or not, or was saved to go on later; `None` where another process has it now.
type Outcome = Option<Entry>;

/// Works until nothing is left or the process is to stop; an error stops the whole process.
pub(super) fn work(shared: &Shared<'_>, slot: usize) {
    let outcome = take_turns(shared, slot);
    let mut common = shared.common();
    shared.working()[slot] = None;
    common.active -= 1;
    shared.ended.notify_all();
    if let Err(error) = outcome {
        shared.stop.store(true, Ordering::Relaxed);
        common.error.get_or_insert(error);
    }
}

fn take_turns(shared: &Shared<'_>, slot: usize) -> Result<()> {
    while !shared.is_stopped() {
        match shared.claim()? {
            Claim::Taken(identity) => {
                shared.common().leased = 0;
                attend(shared, slot, identity)?;
            }
            Claim::Wait { leased } => {
                shared.working()[slot] = None;
                shared.common().leased = leased;
                shared.wait(IDLE);
            }
            Claim::Nothing => break,
        }
    }
    Ok(())
}

/// Works on a run that this process has the lease of, and gives the lease back.
fn attend(shared: &Shared<'_>, slot: usize, identity: Identity) -> Result<()> {
    let (assignment, point) = shared.assignment(identity);
    shared.working()[slot] = Some(Working {
        identity,
        point,
        progress: None,
    });
    let files = shared.store.run_files(identity);
    // A panic is a bug of ours, in one run: the others go on.
    let outcome = catch_unwind(AssertUnwindSafe(|| {
        carry_out(shared, slot, &files, &assignment)
    }));
    let outcome = outcome.unwrap_or_else(|panic| {
        let reason = format!("panic: {}", said(&*panic));
        give_up(shared, &files, identity, &reason)
    });
    match outcome {
        Ok(Some(entry)) => {
            shared.release(identity, Some(&entry))?;
            shared.common().entries.insert(identity, entry);
        }
        Ok(None) => shared.tell(format!("run {identity} was taken over by another process")),
        Err(error) => {
            // The error itself is what matters; a lease that cannot be given back is void once this process has ended.
            drop(shared.release(identity, None));
            return Err(error);
        }
    }
    Ok(())
}

fn carry_out(
    shared: &Shared<'_>,
    slot: usize,
    files: &RunFiles,
    assignment: &Assignment,
) -> Result<Outcome> {
    let identity = assignment.identity;
    match files.verdict(None) {
        Verdict::Done { row, stamp } => {
            files.remove_checkpoints();
            return Ok(Some(done(&row, stamp)));
        }
        Verdict::Failed(reason) => return Ok(Some(Entry::new(State::Failed, Some(reason)))),
        Verdict::Damaged(reason) => {
            shared.store.quarantine_run(identity, &reason)?;
            shared.tell(not_whole(identity, &reason));
        }
        Verdict::Nothing | Verdict::Checkpointed => {}
    }
    files.begin(assignment)?;
    let mut aside = |path: &std::path::Path, reason: &str| {
        shared.tell(format!(
            "{} of run {identity} is damaged ({reason}): moved aside",
            path.file_name().unwrap_or_default().display()
        ));
        shared.store.quarantine(path, identity, reason).map(|_| ())
    };
    let mut run = match files.resume(assignment, &mut aside, &|| shared.is_stopped()) {
        Ok(run) => run,
        // Nothing is there yet, and it begins anew.
        Err(StudyError::Run { source, .. }) if source.is_stop() => {
            return Ok(Some(Entry::new(State::Pending, None)));
        }
        Err(StudyError::Run {
            source:
                source @ (RunError::Engine(_)
                | RunError::TooManyGrains { .. }
                | RunError::NoMemory { .. }),
            ..
        }) => return give_up(shared, files, identity, &source.to_string()),
        Err(error) => return Err(error),
    };
    if run.progress().samples > 0 {
        let part = run.progress().part();
        shared.common().taken_up.insert(identity, part);
    }
    advance(shared, slot, files, assignment, &mut run)
}

fn advance(
    shared: &Shared<'_>,
    slot: usize,
    files: &RunFiles,
    assignment: &Assignment,
    run: &mut Run,
) -> Result<Outcome> {
    let identity = assignment.identity;
    let (mut saved, mut pace) = (Instant::now(), Pace::default());
    while !run.is_complete() {
        let is_stopped = shared.is_stopped();
        let runs = shared.working().iter().flatten().count();
        let free = shared.effort.workers / runs.max(1);
        // Where the system gives no more threads, those that it has go on.
        drop(run.compute_with_threads_that_pay(free));
        if is_stopped || saved.elapsed() >= shared.effort.checkpoint_interval {
            if !shared.holds(identity)? {
                return Ok(None);
            }
            files.save(run)?;
            if is_stopped {
                return Ok(Some(Entry::new(State::Checkpointed, None)));
            }
            saved = Instant::now();
        }
        if let Err(error) = pace.advance(run, u64::MAX) {
            // The last state that was whole may show why.
            if shared.holds(identity)? {
                drop(files.save(run));
            }
            return give_up(shared, files, identity, &error.to_string());
        }
        if let Some(working) = &mut shared.working()[slot] {
            working.progress = Some(run.progress());
        }
    }
    if !shared.holds(identity)? {
        return Ok(None);
    }
    let status = if run.is_settled() {
        Status::Settled
    } else {
        Status::Complete
    };
    let summary = Summary::of(run, status, None);
    files.finish(run, &summary, assignment)?;
    match files.verdict(None) {
        Verdict::Done { row, stamp } => Ok(Some(done(&row, stamp))),
        other => Err(StudyError::NotWritten {
            identity,
            reason: match other {
                Verdict::Damaged(reason) => reason,
                _ => "its seal is gone".to_owned(),
            },
        }),
    }
}

/// Keeps the error that a run ended in.
fn give_up(
    shared: &Shared<'_>,
    files: &RunFiles,
    identity: Identity,
    reason: &str,
) -> Result<Outcome> {
    if !shared.holds(identity)? {
        return Ok(None);
    }
    files.fail(reason)?;
    shared.tell(format!("run {identity} failed: {reason}"));
    Ok(Some(Entry::new(State::Failed, Some(reason.to_owned()))))
}

fn said(panic: &(dyn std::any::Any + Send)) -> &str {
    let formatted = || panic.downcast_ref::<String>().map(String::as_str);
    let plain = panic.downcast_ref::<&str>().copied();
    plain.or_else(formatted).unwrap_or("no message")
}
