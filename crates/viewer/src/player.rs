//! The thread that owns a recording, and gives its frames to whoever asks.

use std::sync::mpsc::Receiver;

use crate::message::Notice;
use crate::recording::Recording;
use crate::tube::{Request, Voices};

/// A recording in the hands of its viewers, each of whom plays it at their own pace.
#[derive(Debug)]
pub(crate) struct Player {
    pub(crate) recording: Recording,
    pub(crate) title: String,
    pub(crate) voices: Voices,
}

impl Player {
    /// Answers until nobody is left who could ask for anything. A client that has left meanwhile needs no answer.
    pub(crate) fn work(mut self, requests: &Receiver<Request>) {
        while let Ok(request) = requests.recv() {
            match request {
                Request::Welcome(reply) => {
                    let welcome = self.recording.welcome(&self.title);
                    drop(reply.send(welcome.to_json()));
                }
                Request::Frame(number, reply) => {
                    let frame = self.recording.frame(number);
                    drop(reply.send(frame.map_err(|error| error.to_string())));
                }
                Request::Command(_) => self.voices.say(&Notice::Problem {
                    message: "this is a recording, which cannot be driven; `peristalsis view --live` computes the run"
                        .to_owned(),
                }),
            }
        }
    }
}
