//! A run or a recording in a thread of its own, and how to speak to it.

use std::sync::Arc;
use std::sync::mpsc::{Receiver, SyncSender, TrySendError, sync_channel};
use std::time::Duration;

use tokio::sync::{broadcast, oneshot, watch};

use super::error::ViewerError;
use crate::message::{Command, problem};

/// Requests that wait for the run, at most.
const WAITING: usize = 64;
/// Time after which a request that found no place is tried again.
const FULL: Duration = Duration::from_millis(2);
/// Notices that a slow client may lag behind.
const NOTICES: usize = 64;

/// A request to the thread that owns a run or a recording.
#[derive(Debug)]
pub(crate) enum Request {
    /// Carry out a command; the answer is a notice to who sent it.
    Command(Command, oneshot::Sender<Option<String>>),
    /// The welcome of a new client, and frames from before.
    Welcome(oneshot::Sender<(String, Vec<Arc<Vec<u8>>>)>),
    /// A frame of a recording by its number; the error says why there is no such frame.
    Frame(usize, oneshot::Sender<Result<Vec<u8>, String>>),
}

/// The channels to the clients of a run: frames and notices.
#[derive(Clone, Debug)]
pub(crate) struct Subscribers {
    pub(crate) frames: watch::Sender<Arc<Vec<u8>>>,
    pub(crate) notices: broadcast::Sender<String>,
}

impl Subscribers {
    /// Sends a notice to all clients there are.
    pub(crate) fn notify(&self, notice: String) {
        drop(self.notices.send(notice));
    }

    /// Whether there are clients.
    pub(crate) fn are_present(&self) -> bool {
        self.frames.receiver_count() > 0
    }
}

/// The channels to and from the thread of a run or a recording. The thread ends when the last copy is dropped.
#[derive(Clone, Debug)]
pub(crate) struct Session {
    requests: SyncSender<Request>,
    pub(crate) subscribers: Subscribers,
}

impl Session {
    /// Starts `work` in a thread of its own.
    ///
    /// # Errors
    /// [`ViewerError::Thread`].
    pub(crate) fn start(
        work: impl FnOnce(Subscribers, Receiver<Request>) + Send + 'static,
    ) -> Result<Self, ViewerError> {
        let (requests, received) = sync_channel(WAITING);
        let subscribers = Subscribers {
            frames: watch::Sender::new(Arc::new(Vec::new())),
            notices: broadcast::Sender::new(NOTICES),
        };
        let own = subscribers.clone();
        std::thread::Builder::new()
            .name("tube".to_owned())
            .spawn(move || work(own, received))
            .map_err(ViewerError::Thread)?;
        Ok(Self {
            requests,
            subscribers,
        })
    }

    /// Sends a request; where too many wait already, waits for a place. `None` if the thread has ended.
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

/// Answers all requests with the reason why there is no run.
pub(crate) fn refuse_all(reason: &str, requests: &Receiver<Request>) {
    while let Ok(request) = requests.recv() {
        match request {
            Request::Welcome(reply) => drop(reply.send((problem(reason), Vec::new()))),
            Request::Frame(_, reply) => drop(reply.send(Err(reason.to_owned()))),
            Request::Command(_, reply) => drop(reply.send(None)),
        }
    }
}
