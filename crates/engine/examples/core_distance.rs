//! Prints how long a line of memory takes from one core to another and back, which says how well two threads on these
//! cores can share one tube. On Linux `taskset -c 0,1` before the command chooses the cores.
#![allow(clippy::print_stdout, clippy::print_stderr, reason = "a program")]

use std::process::ExitCode;
use std::sync::atomic::{AtomicU64, Ordering};
use std::thread;
use std::time::Instant;

const ROUNDS: u64 = 200_000;
const TIMES: usize = 9;

/// A number on a line of its own.
#[repr(align(128))]
struct Line(AtomicU64);

/// Waits for a number, and writes the next in its place.
fn follow(Line(line): &Line, number: u64) {
    while line.load(Ordering::Acquire) != number {
        core::hint::spin_loop();
    }
    line.store(number + 1, Ordering::Release);
}

/// Nanoseconds of a round.
fn round_trip() -> f64 {
    let line = Line(AtomicU64::new(0));
    thread::scope(|scope| {
        let other = scope.spawn(|| (0..=ROUNDS).for_each(|round| follow(&line, 2 * round + 1)));
        // The first round waits until the other has begun.
        follow(&line, 0);
        let begin = Instant::now();
        (1..=ROUNDS).for_each(|round| follow(&line, 2 * round));
        let _ = other.join();
        begin.elapsed().as_secs_f64() * 1e9 / ROUNDS as f64
    })
}

fn main() -> ExitCode {
    // A thread that waits awake would keep the only processor from the other.
    if thread::available_parallelism().is_ok_and(|processors| processors.get() < 2) {
        eprintln!("this takes two processors, and there is one");
        return ExitCode::from(3);
    }
    let mut times = [0.0; TIMES].map(|_: f64| round_trip());
    times.sort_by(f64::total_cmp);
    let (least, median, most) = (times[0], times[TIMES / 2], times[TIMES - 1]);
    println!("from core to core and back: {median:.0} ns ({least:.0} - {most:.0})");
    ExitCode::SUCCESS
}
