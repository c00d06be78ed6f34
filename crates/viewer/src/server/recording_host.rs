//! The work of the thread that owns a recording: sends clients the frames that they ask for.

use std::sync::mpsc::Receiver;

use super::recording::Recording;
use super::session::Request;
use crate::message::problem;
use crate::within::Within;

/// A recording, which each client plays at its own pace.
#[derive(Debug)]
pub(crate) struct RecordingHost {
    pub(crate) recording: Recording,
    pub(crate) title: String,
    pub(crate) within: Option<Within>,
}

impl RecordingHost {
    /// Answers requests until all clients and the server are gone. A client that has left needs no answer.
    pub(crate) fn work(mut self, requests: &Receiver<Request>) {
        while let Ok(request) = requests.recv() {
            match request {
                Request::Welcome(reply) => {
                    let mut welcome = self.recording.welcome(&self.title);
                    welcome.within = self.within.clone();
                    drop(reply.send((welcome.to_json(), Vec::new())));
                }
                Request::Frame(number, reply) => {
                    let frame = self.recording.frame(number);
                    drop(reply.send(frame.map_err(|error| error.to_string())));
                }
                Request::Command(_, reply) => {
                    let message = "this is a recording, which cannot be driven; `peristalsis view --live` computes the run";
                    drop(reply.send(Some(problem(message))));
                }
            }
        }
    }
}
