//! A run or a recording in a thread of its own, and how to speak to it.

use std::sync::Arc;
use std::sync::mpsc::{Receiver, SyncSender, TrySendError, sync_channel};
use std::time::Duration;

use tokio::sync::{broadcast, oneshot, watch};

use crate::ViewerError;
use crate::message::{Command, problem};

/// Requests that wait for the run, at most.
const WAITING: usize = 64;
/// Time after which a request that found no place is tried again.
const FULL: Duration = Duration::from_millis(2);
/// Notices that a slow client may lag behind.
const NOTICES: usize = 64;

/// What the thread is asked.
#[derive(Debug)]
pub(crate) enum Request {
    /// To do something.
    Command(Command),
    /// What a new client must know first.
    Welcome(oneshot::Sender<String>),
    /// A frame of a recording; else why it cannot be had.
    Frame(usize, oneshot::Sender<Result<Vec<u8>, String>>),
}

/// What clients listen to.
#[derive(Clone, Debug)]
pub(crate) struct Voices {
    pub(crate) frames: watch::Sender<Arc<Vec<u8>>>,
    pub(crate) notices: broadcast::Sender<String>,
}

impl Voices {
    /// Tells everyone; with nobody there, nobody is told.
    pub(crate) fn say(&self, notice: String) {
        drop(self.notices.send(notice));
    }

    /// Whether anybody looks on.
    pub(crate) fn are_heard(&self) -> bool {
        self.frames.receiver_count() > 0
    }
}

/// Both ends of the talk with a thread, which ends when the last of them is gone.
#[derive(Clone, Debug)]
pub(crate) struct Session {
    requests: SyncSender<Request>,
    pub(crate) voices: Voices,
}

impl Session {
    /// Puts `work` into a thread.
    ///
    /// # Errors
    /// [`ViewerError::Thread`].
    pub(crate) fn start(
        work: impl FnOnce(Voices, Receiver<Request>) + Send + 'static,
    ) -> Result<Self, ViewerError> {
        let (requests, received) = sync_channel(WAITING);
        let voices = Voices {
            frames: watch::Sender::new(Arc::new(Vec::new())),
            notices: broadcast::Sender::new(NOTICES),
        };
        let own = voices.clone();
        std::thread::Builder::new()
            .name("tube".to_owned())
            .spawn(move || work(own, received))
            .map_err(ViewerError::Thread)?;
        Ok(Self { requests, voices })
    }

    /// Waits for a place among the requests: who sends too many waits for the run, and nobody's are lost. `None` where the
    /// thread has ended.
    pub(crate) async fn request(&self, mut request: Request) -> Option<()> {
        loop {
            request = match self.requests.try_send(request) {
                Ok(()) => return Some(()),
                Err(TrySendError::Full(request)) => request,
                Err(TrySendError::Disconnected(_)) => return None,
            };
            tokio::time::sleep(FULL).await;
        }
    }
}

/// Says to whoever asks why there is nothing to see.
pub(crate) fn apologize(reason: &str, requests: &Receiver<Request>) {
    while let Ok(request) = requests.recv() {
        match request {
            Request::Welcome(reply) => drop(reply.send(problem(reason))),
            Request::Frame(_, reply) => drop(reply.send(Err(reason.to_owned()))),
            Request::Command(_) => {}
        }
    }
}
