//! A viewer that serves a small tube, and a client of it.

use std::io::{Read, Write};
use std::net::TcpStream;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::JoinHandle;
use std::time::Duration;

use peristalsis_configuration::Configuration;
use peristalsis_run::Run;
use peristalsis_viewer::{Options, Viewer};
use serde_json::Value;
use tokio_tungstenite::tungstenite::client::IntoClientRequest;
use tokio_tungstenite::tungstenite::http::{Request, Response};
use tokio_tungstenite::tungstenite::{Error, Message, WebSocket, client};

/// Longest time that anything may take.
const LONG: Duration = Duration::from_secs(30);

/// A preset with settings over it.
pub(crate) fn configuration(preset: &str, settings: &[&str]) -> Configuration {
    Configuration::from_preset(preset, settings).unwrap()
}

/// A viewer in a thread of its own; stopped when dropped.
pub(crate) struct Served {
    pub(crate) port: u16,
    /// "/TOKEN/"
    pub(crate) base: String,
    pub(crate) saves: PathBuf,
    stop: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
    _folder: tempfile::TempDir,
}

impl Served {
    pub(crate) fn new(preset: &str, settings: &[&str]) -> Self {
        Self::of(Run::new(configuration(preset, settings)).unwrap())
    }

    /// Goes on with a run.
    pub(crate) fn of(run: Run) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let options = Options {
            port: 0,
            title: "tube".to_owned(),
            saves: folder.path().join("saves"),
            record: Vec::new(),
        };
        let viewer = Viewer::open(run, options).unwrap();
        Self::serve(viewer, folder)
    }

    /// Serves what was opened; the folder lives as long.
    pub(crate) fn serve(viewer: Viewer, folder: tempfile::TempDir) -> Self {
        let address = viewer.address();
        let (host, base) = address
            .strip_prefix("http://")
            .unwrap()
            .split_once('/')
            .unwrap();
        let port = host.strip_prefix("127.0.0.1:").unwrap().parse().unwrap();
        let base = format!("/{base}");
        let stop = Arc::new(AtomicBool::new(false));
        let stopped = Arc::clone(&stop);
        let thread = std::thread::spawn(move || {
            viewer.serve(|| stopped.load(Ordering::Relaxed));
        });
        Self {
            port,
            base,
            saves: folder.path().join("saves"),
            stop,
            thread: Some(thread),
            _folder: folder,
        }
    }

    /// A small frictionless tube.
    pub(crate) fn small() -> Self {
        Self::new("frictionless", &["tube.waves=2", "drive.width=2.6"])
    }

    pub(crate) fn connect(&self) -> TcpStream {
        let stream = TcpStream::connect(("127.0.0.1", self.port)).unwrap();
        stream.set_read_timeout(Some(LONG)).unwrap();
        stream
    }

    /// The whole answer to a request with exactly these lines after the first.
    pub(crate) fn get(&self, path: &str, lines: &[&str]) -> String {
        let mut stream = self.connect();
        let lines: String = lines.iter().map(|line| format!("{line}\r\n")).collect();
        let request = format!("GET {path} HTTP/1.1\r\n{lines}Connection: close\r\n\r\n");
        stream.write_all(request.as_bytes()).unwrap();
        let mut answer = Vec::new();
        stream.read_to_end(&mut answer).unwrap();
        String::from_utf8_lossy(&answer).into_owned()
    }

    pub(crate) fn host(&self) -> String {
        format!("Host: 127.0.0.1:{}", self.port)
    }

    /// Asks for the WebSocket as a page of this origin would.
    pub(crate) fn upgrade(&self, path: &str, origin: Option<&str>) -> Result<Client, u16> {
        let mut request: Request<()> = format!("ws://127.0.0.1:{}{path}", self.port)
            .into_client_request()
            .unwrap();
        if let Some(origin) = origin {
            request
                .headers_mut()
                .insert("Origin", origin.parse().unwrap());
        }
        match client(request, self.connect()) {
            Ok((socket, _)) => Ok(Client { socket }),
            Err(error) => match error {
                tokio_tungstenite::tungstenite::HandshakeError::Failure(Error::Http(response)) => {
                    Err(status(&response))
                }
                other => panic!("{other}"),
            },
        }
    }

    /// A client that has been welcomed.
    pub(crate) fn client(&self) -> (Client, Value) {
        let mut client = self.upgrade(&format!("{}live", self.base), None).unwrap();
        let welcome = client.notice();
        assert_eq!(welcome["type"], "welcome", "{welcome}");
        (client, welcome)
    }
}

fn status<T>(response: &Response<T>) -> u16 {
    response.status().as_u16()
}

impl Drop for Served {
    fn drop(&mut self) {
        self.stop.store(true, Ordering::Relaxed);
        if let Some(thread) = self.thread.take() {
            thread.join().unwrap();
        }
    }
}

/// One end of a WebSocket.
pub(crate) struct Client {
    socket: WebSocket<TcpStream>,
}

/// A frame taken apart.
#[derive(Debug)]
pub(crate) struct Frame {
    pub(crate) head: Value,
    pub(crate) numbers: Vec<f32>,
}

impl Client {
    pub(crate) fn send(&mut self, text: &str) {
        self.socket.send(Message::text(text)).unwrap();
    }

    pub(crate) fn send_message(&mut self, message: Message) {
        // The server may have closed already.
        drop(self.socket.send(message));
    }

    /// The next message; `None` where there will be no more.
    pub(crate) fn next(&mut self) -> Option<Message> {
        match self.socket.read() {
            Ok(Message::Close(_)) => None,
            Ok(message) => Some(message),
            Err(Error::Io(error)) if error.kind() == std::io::ErrorKind::WouldBlock => {
                panic!("the server says nothing")
            }
            Err(_) => None,
        }
    }

    /// The next message in words.
    pub(crate) fn notice(&mut self) -> Value {
        loop {
            if let Message::Text(text) = self.next().expect("the server goes on") {
                return serde_json::from_str(&text).unwrap();
            }
        }
    }

    /// The next frame.
    pub(crate) fn frame(&mut self) -> Frame {
        loop {
            if let Message::Binary(bytes) = self.next().expect("the server goes on") {
                return decode(&bytes);
            }
        }
    }

    /// The first frame that is as wanted.
    pub(crate) fn frame_with(&mut self, wanted: impl Fn(&Value) -> bool) -> Frame {
        for _ in 0..2000 {
            let frame = self.frame();
            if wanted(&frame.head) {
                return frame;
            }
        }
        panic!("no such frame comes")
    }
}

fn decode(bytes: &[u8]) -> Frame {
    let length = u32::from_le_bytes(bytes[..4].try_into().unwrap()) as usize;
    assert_eq!(length % 4, 0);
    let head: Value = serde_json::from_slice(&bytes[4..4 + length]).unwrap();
    let numbers = bytes[4 + length..]
        .chunks_exact(4)
        .map(|four| f32::from_le_bytes(four.try_into().unwrap()))
        .collect();
    Frame { head, numbers }
}

/// Whether a file is there.
pub(crate) fn holds(folder: &Path, name: &str) -> bool {
    folder.join(name).is_file()
}
