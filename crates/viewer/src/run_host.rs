//! The thread that owns a run, and lets whoever asks see and drive it.

use std::sync::Arc;
use std::sync::LazyLock;
use std::sync::mpsc::{Receiver, RecvTimeoutError};
use std::time::{Duration, Instant};

use peristalsis_run::Run;

use crate::session::{Request, Voices};
use crate::tube::{FRAME, Labels, Tube};

/// A run and those who look on.
#[derive(Debug)]
pub(crate) struct Keeper {
    tube: Tube,
    voices: Voices,
}

/// Seconds since the program first asked.
fn seconds() -> f64 {
    static BEGIN: LazyLock<Instant> = LazyLock::new(Instant::now);
    BEGIN.elapsed().as_secs_f64()
}

impl Keeper {
    pub(crate) fn new(run: Run, labels: Labels, voices: Voices) -> Self {
        let tube = Tube::new(run, labels, seconds);
        Self { tube, voices }
    }

    /// Works until nobody is left who could ask for anything.
    pub(crate) fn work(mut self, requests: &Receiver<Request>) {
        let frame = Duration::from_secs_f64(FRAME);
        self.publish();
        let mut next = Instant::now();
        loop {
            let busy = self.tube.is_going() && self.voices.are_heard();
            let patience = if busy {
                next.saturating_duration_since(Instant::now())
            } else {
                frame
            };
            match requests.recv_timeout(patience) {
                Ok(request) => {
                    self.answer(request);
                    continue;
                }
                Err(RecvTimeoutError::Disconnected) => return,
                Err(RecvTimeoutError::Timeout) => {}
            }
            if busy {
                next = Instant::now() + frame;
                self.tube.advance_by_a_frame();
                self.publish();
            }
        }
    }

    /// Answers; a client that has left meanwhile needs no answer.
    fn answer(&mut self, request: Request) {
        match request {
            Request::Welcome(reply) => drop(reply.send(self.tube.welcome())),
            Request::Frame(_, reply) => {
                let reason = "this run is computed as it is watched; it has no recorded frames";
                drop(reply.send(Err(reason.to_owned())));
            }
            Request::Command(command) => {
                self.tube.take(command);
                self.publish();
            }
        }
    }

    fn publish(&mut self) {
        for notice in self.tube.notices() {
            self.voices.say(notice);
        }
        self.voices.frames.send_replace(Arc::new(self.tube.frame()));
    }
}
