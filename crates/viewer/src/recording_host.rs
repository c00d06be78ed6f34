//! The thread that owns a recording, and gives its frames to whoever asks.

use std::sync::mpsc::Receiver;

use crate::message::problem;
use crate::recording::Recording;
use crate::session::{Request, Voices};
use crate::within::Within;

/// A recording in the hands of its viewers, each of whom plays it at their own pace.
#[derive(Debug)]
pub(crate) struct Player {
    pub(crate) recording: Recording,
    pub(crate) title: String,
    pub(crate) within: Option<Within>,
    pub(crate) voices: Voices,
}

impl Player {
    /// Answers until nobody is left who could ask for anything. A client that has left meanwhile needs no answer.
    pub(crate) fn work(mut self, requests: &Receiver<Request>) {
        while let Ok(request) = requests.recv() {
            match request {
                Request::Welcome(reply) => {
                    let mut welcome = self.recording.welcome(&self.title);
                    welcome.within = self.within.clone();
                    drop(reply.send(welcome.to_json()));
                }
                Request::Frame(number, reply) => {
                    let frame = self.recording.frame(number);
                    drop(reply.send(frame.map_err(|error| error.to_string())));
                }
                Request::Command(_) => {
                    let message = "this is a recording, which cannot be driven; `peristalsis view --live` computes the run";
                    self.voices.say(problem(message));
                }
            }
        }
    }
}
