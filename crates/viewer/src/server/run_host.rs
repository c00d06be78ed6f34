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
    past: Past,
}

/// Bytes of frames that are kept for pages that come later.
const ROOM: usize = 32_000_000;
/// Frames from one that is kept to the next.
const APART: u64 = 4;

/// Frames of the run so far, for pages that come later. The older the frames, the fewer of them are kept.
#[derive(Debug, Default)]
struct Past {
    frames: Vec<(u64, Arc<Vec<u8>>)>,
    seen: u64,
    last: Option<u64>,
}

impl Past {
    fn see(&mut self, step: u64, frame: impl FnOnce() -> Vec<u8>) {
        // What came after this step was left.
        self.frames.retain(|(known, _)| *known <= step);
        if self.last == Some(step) {
            return;
        }
        self.last = Some(step);
        self.seen += 1;
        if self.seen % APART == 1 && self.frames.last().is_none_or(|(known, _)| *known < step) {
            self.frames.push((step, Arc::new(frame())));
        }
        let bytes: usize = self.frames.iter().map(|(_, frame)| frame.len()).sum();
        if bytes > ROOM {
            let half = self.frames.len() / 2;
            let mut place = 0;
            self.frames.retain(|_| {
                place += 1;
                place > half || place % 2 == 1
            });
        }
    }
}

/// Seconds since the program first asked.
fn seconds() -> f64 {
    static BEGIN: LazyLock<Instant> = LazyLock::new(Instant::now);
    BEGIN.elapsed().as_secs_f64()
}

impl RunHost {
    pub(crate) fn new(run: Run, labels: Labels, subscribers: Subscribers) -> Self {
        let tube = Tube::new(run, labels, seconds);
        Self {
            tube,
            subscribers,
            past: Past::default(),
        }
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
            Request::Welcome(reply) => {
                let past = self.past.frames.iter().map(|(_, frame)| Arc::clone(frame));
                drop(reply.send((self.tube.welcome(), past.collect())));
            }
            Request::Frame(_, reply) => {
                let reason = "this run is computed as it is watched; it has no recorded frames";
                drop(reply.send(Err(reason.to_owned())));
            }
            Request::Command(command, reply) => {
                drop(reply.send(self.tube.execute(command)));
                self.publish();
            }
        }
    }

    fn publish(&mut self) {
        for notice in self.tube.notices() {
            self.subscribers.notify(notice);
        }
        let Self { tube, past, .. } = self;
        past.see(tube.step(), || tube.frame(true));
        let frame = Arc::new(tube.frame(false));
        self.subscribers.frames.send_replace(frame);
    }
}
