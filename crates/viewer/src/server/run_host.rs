//! The work of the thread that owns a run: carries out the commands of clients and sends them frames.

use std::sync::Arc;
use std::sync::LazyLock;
use std::sync::mpsc::{Receiver, RecvTimeoutError};
use std::time::{Duration, Instant};

use peristalsis_run::Run;

use super::session::{Request, Subscribers};
use crate::tube::{FRAME, Labels, Tube};

/// A run and its clients.
#[derive(Debug)]
pub(crate) struct RunHost {
    tube: Tube,
    subscribers: Subscribers,
}

/// Seconds since the program first asked.
fn seconds() -> f64 {
    static BEGIN: LazyLock<Instant> = LazyLock::new(Instant::now);
    BEGIN.elapsed().as_secs_f64()
}

impl RunHost {
    pub(crate) fn new(run: Run, labels: Labels, subscribers: Subscribers) -> Self {
        let tube = Tube::new(run, labels, seconds);
        Self { tube, subscribers }
    }

    /// Works until all clients and the server are gone.
    pub(crate) fn work(mut self, requests: &Receiver<Request>) {
        let frame = Duration::from_secs_f64(FRAME);
        self.publish();
        let mut next = Instant::now();
        loop {
            let busy = self.tube.is_going() && self.subscribers.are_present();
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

    /// Answers a request; a client that has left needs no answer.
    fn answer(&mut self, request: Request) {
        match request {
            Request::Welcome(reply) => drop(reply.send(self.tube.welcome())),
            Request::Frame(_, reply) => {
                let reason = "this run is computed as it is watched; it has no recorded frames";
                drop(reply.send(Err(reason.to_owned())));
            }
            Request::Command(command) => {
                self.tube.execute(command);
                self.publish();
            }
        }
    }

    fn publish(&mut self) {
        for notice in self.tube.notices() {
            self.subscribers.notify(notice);
        }
        self.subscribers
            .frames
            .send_replace(Arc::new(self.tube.frame()));
    }
}
