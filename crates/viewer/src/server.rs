//! The server: the page, and a WebSocket for frames and commands.

use std::net::Ipv4Addr;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, SyncSender, TrySendError, sync_channel};
use std::time::Duration;

use axum::Router;
use axum::extract::ws::{CloseFrame, Message, WebSocket, WebSocketUpgrade, close_code};
use axum::extract::{Path, Request, State};
use axum::http::{HeaderMap, HeaderValue, StatusCode, header};
use axum::middleware::{self, Next};
use axum::response::{IntoResponse, Response};
use axum::routing::get;
use futures_util::{SinkExt, StreamExt};
use hyper::server::conn::http1;
use hyper_util::rt::{TokioIo, TokioTimer};
use hyper_util::service::TowerToHyperService;
use peristalsis_observe::Sample;
use peristalsis_run::Run;
use tokio::net::TcpListener;
use tokio::runtime::Runtime;
use tokio::sync::{Semaphore, broadcast, oneshot, watch};

use crate::ViewerError;
use crate::assets::asset;
use crate::guard::{Token, is_loopback, is_own};
use crate::message::{Command, Notice};
use crate::player::Player;
use crate::recording::Recording;
use crate::tube::{self, Labels, Tube, Voices};

/// Connections at a time that have not become a client's; more wait.
const CONNECTIONS: usize = 64;
/// Time that a connection may take to say what it wants.
const PATIENCE: Duration = Duration::from_secs(5);
/// Bytes of a request's head, at most.
const HEAD_BYTES: usize = 16 * 1024;
/// Clients at a time.
const CLIENTS: usize = 8;
/// Bytes of a message from a client, at most.
const MESSAGE_BYTES: usize = 4096;
/// Requests that wait for the run, at most.
const WAITING: usize = 64;
/// Time after which a request that found no place is tried again.
const FULL: Duration = Duration::from_millis(2);
/// Notices that a slow client may lag behind.
const NOTICES: usize = 64;
/// Time from one look at whether to stop to the next.
const LOOK: Duration = Duration::from_millis(50);
/// Time that a client may take for a frame before it is left alone.
const SLOW: Duration = Duration::from_secs(30);

/// What the page may load: itself, and nothing else.
const CONTENT_SECURITY_POLICY: &str = "default-src 'none'; script-src 'self'; style-src 'self'; \
     connect-src 'self'; img-src 'self' data: blob:; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

/// How to serve a run.
#[derive(Clone, Debug)]
pub struct Options {
    /// Port on loopback; 0 takes a free one.
    pub port: u16,
    /// What the run is called; the names of saved states begin with it.
    pub title: String,
    /// Folder in which states are saved.
    pub saves: PathBuf,
    /// The time series of the same run from before, if it has been computed.
    pub record: Vec<Sample>,
}

/// A viewer that listens.
#[derive(Debug)]
pub struct Viewer {
    runtime: Runtime,
    listener: TcpListener,
    port: u16,
    token: String,
    router: Router,
}

/// What every request needs.
#[derive(Clone)]
struct Shared {
    token: Arc<Token>,
    requests: SyncSender<tube::Request>,
    voices: Voices,
    clients: Arc<Semaphore>,
}

impl Viewer {
    /// Listens on loopback and puts the run into a thread of its own, at rest.
    ///
    /// # Errors
    /// [`ViewerError`] where the system gives no port, thread or random number.
    pub fn open(run: Run, options: Options) -> Result<Self, ViewerError> {
        let labels = Labels {
            title: options.title,
            saves: options.saves,
            record: options.record,
        };
        Self::listen(options.port, |voices, requests| {
            Tube::new(run, labels, voices).work(&requests);
        })
    }

    /// Listens on loopback and gives the frames of a recording to whoever asks. Port 0 takes a free one.
    ///
    /// # Errors
    /// As [`Viewer::open`].
    pub fn play(recording: Recording, title: String, port: u16) -> Result<Self, ViewerError> {
        Self::listen(port, |voices, requests| {
            let player = Player {
                recording,
                title,
                voices,
            };
            player.work(&requests);
        })
    }

    /// Listens, with `work` in a thread of its own.
    fn listen(
        port: u16,
        work: impl FnOnce(Voices, Receiver<tube::Request>) + Send + 'static,
    ) -> Result<Self, ViewerError> {
        let refused = |source| ViewerError::Listen { port, source };
        let runtime = tokio::runtime::Builder::new_multi_thread()
            .worker_threads(1)
            .enable_all()
            .build()
            .map_err(ViewerError::Thread)?;
        let listener = runtime
            .block_on(TcpListener::bind((Ipv4Addr::LOCALHOST, port)))
            .map_err(refused)?;
        let port = listener.local_addr().map_err(refused)?.port();
        let token = Token::random()?;
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
        let shared = Shared {
            token: Arc::new(token.clone()),
            requests,
            voices,
            clients: Arc::new(Semaphore::new(CLIENTS)),
        };
        Ok(Self {
            runtime,
            listener,
            port,
            token: token.as_str().to_owned(),
            router: router(shared),
        })
    }

    /// The address to open in a browser; whoever knows it can drive the run.
    #[must_use]
    pub fn address(&self) -> String {
        format!("http://127.0.0.1:{}/{}/", self.port, self.token)
    }

    /// Serves until `stop` says so.
    pub fn serve(self, stop: impl Fn() -> bool) {
        let Self {
            runtime,
            listener,
            router,
            ..
        } = self;
        runtime.block_on(async {
            let stopped = async {
                while !stop() {
                    tokio::time::sleep(LOOK).await;
                }
            };
            tokio::select! {
                () = accept_all(listener, router) => {}
                () = stopped => {}
            }
        });
        runtime.shutdown_background();
    }
}

/// Takes connections, each of which has a place among [`CONNECTIONS`] until it ends or becomes a client's.
async fn accept_all(listener: TcpListener, router: Router) {
    let places = Arc::new(Semaphore::new(CONNECTIONS));
    while let Ok(place) = Arc::clone(&places).acquire_owned().await {
        let Ok((stream, _)) = listener.accept().await else {
            // The connection is gone already, or there are too many open files: both pass.
            tokio::time::sleep(LOOK).await;
            continue;
        };
        let service = TowerToHyperService::new(router.clone());
        tokio::spawn(async move {
            let connection = http1::Builder::new()
                .timer(TokioTimer::new())
                .header_read_timeout(PATIENCE)
                .max_buf_size(HEAD_BYTES)
                .serve_connection(TokioIo::new(stream), service)
                .with_upgrades();
            // Who breaks off, or talks no HTTP, has been answered as far as there is an answer.
            drop(connection.await);
            drop(place);
        });
    }
}

fn router(shared: Shared) -> Router {
    Router::new()
        .route("/{token}/", get(page))
        .route("/{token}/live", get(live))
        .route("/{token}/{name}", get(file))
        .layer(middleware::from_fn(guard))
        .with_state(shared)
}

/// Whether a request names this machine, and comes from its page or from none; it may say either only once.
fn is_known(headers: &HeaderMap) -> bool {
    let text = |name| {
        let mut values = headers.get_all(name).iter();
        let value: Option<&HeaderValue> = values.next();
        match values.next() {
            None => value.map(|value| value.to_str().unwrap_or("?")),
            Some(_) => Some("?"),
        }
    };
    let host = text(header::HOST);
    is_loopback(host) && is_own(text(header::ORIGIN), host.unwrap_or_default())
}

/// Refuses who comes from elsewhere, and lets no answer be used elsewhere.
async fn guard(request: Request, next: Next) -> Response {
    let mut response = if is_known(request.headers()) {
        next.run(request).await
    } else {
        StatusCode::FORBIDDEN.into_response()
    };
    for (name, value) in [
        ("content-security-policy", CONTENT_SECURITY_POLICY),
        ("referrer-policy", "no-referrer"),
        ("x-content-type-options", "nosniff"),
        ("cache-control", "no-store"),
        ("cross-origin-resource-policy", "same-origin"),
        ("cross-origin-opener-policy", "same-origin"),
    ] {
        let value = HeaderValue::from_static(value);
        response.headers_mut().insert(name, value);
    }
    response
}

async fn page(State(shared): State<Shared>, Path(token): Path<String>) -> Response {
    serve_asset(&shared, &token, "")
}

async fn file(
    State(shared): State<Shared>,
    Path((token, name)): Path<(String, String)>,
) -> Response {
    serve_asset(&shared, &token, &name)
}

/// What is not there and what is not for everyone look the same.
fn serve_asset(shared: &Shared, token: &str, name: &str) -> Response {
    match asset(name) {
        Some(asset) if shared.token.is(token) => {
            ([(header::CONTENT_TYPE, asset.content_type)], asset.bytes).into_response()
        }
        _ => StatusCode::NOT_FOUND.into_response(),
    }
}

async fn live(
    State(shared): State<Shared>,
    Path(token): Path<String>,
    upgrade: Result<WebSocketUpgrade, axum::extract::ws::rejection::WebSocketUpgradeRejection>,
) -> Response {
    if !shared.token.is(&token) {
        return StatusCode::NOT_FOUND.into_response();
    }
    let upgrade = match upgrade {
        Ok(upgrade) => upgrade,
        Err(rejection) => return rejection.into_response(),
    };
    let Ok(place) = Arc::clone(&shared.clients).try_acquire_owned() else {
        let wait = [(header::RETRY_AFTER, "5")];
        return (StatusCode::SERVICE_UNAVAILABLE, wait).into_response();
    };
    upgrade
        .max_message_size(MESSAGE_BYTES)
        .max_frame_size(MESSAGE_BYTES)
        .on_upgrade(async move |socket| {
            attend(socket, shared).await;
            drop(place);
        })
}

/// Serves one client until either side has had enough.
async fn attend(socket: WebSocket, shared: Shared) {
    let (mut to, mut from) = socket.split();
    let mut frames = shared.voices.frames.subscribe();
    let mut notices = shared.voices.notices.subscribe();
    let Some(welcome) = welcome(&shared).await else {
        return;
    };
    if to.send(Message::Text(welcome.into())).await.is_err() {
        return;
    }
    frames.mark_changed();
    loop {
        let message = tokio::select! {
            received = from.next() => match received {
                Some(Ok(Message::Text(text))) => match ask(&shared, &text).await {
                    Ok(None) => continue,
                    Ok(Some(answer)) => answer,
                    Err(reason) => {
                        let message = reason.clone();
                        let notice = Notice::Problem { message }.to_json();
                        drop(to.send(Message::Text(notice.into())).await);
                        farewell(close_code::POLICY, &reason)
                    }
                },
                Some(Ok(Message::Ping(_) | Message::Pong(_))) => continue,
                Some(Ok(Message::Binary(_))) => farewell(close_code::UNSUPPORTED, "commands are text"),
                // Gone, or no WebSocket any more.
                Some(Ok(Message::Close(_)) | Err(_)) | None => return,
            },
            changed = frames.changed() => {
                if changed.is_err() {
                    return;
                }
                let frame = Arc::clone(&frames.borrow_and_update());
                // Nothing was computed yet, or nothing is: a recording.
                if frame.is_empty() {
                    continue;
                }
                Message::Binary(frame.to_vec().into())
            }
            notice = notices.recv() => match notice {
                Ok(text) => Message::Text(text.into()),
                Err(broadcast::error::RecvError::Lagged(_)) => continue,
                Err(broadcast::error::RecvError::Closed) => return,
            },
        };
        let last = matches!(message, Message::Close(_));
        let sent = tokio::time::timeout(SLOW, to.send(message)).await;
        if last || !matches!(sent, Ok(Ok(()))) {
            return;
        }
    }
}

async fn welcome(shared: &Shared) -> Option<String> {
    let (reply, answer) = oneshot::channel();
    request(shared, tube::Request::Welcome(reply)).await?;
    answer.await.ok()
}

/// Passes a message on to the run, with the answer that is for this client alone; else the reason to close the
/// connection.
async fn ask(shared: &Shared, text: &str) -> Result<Option<Message>, String> {
    let ended = || "the run has ended".to_owned();
    match Command::read(text).map_err(|reason| format!("not a command: {reason}"))? {
        Command::Frame { number } => {
            let (reply, answer) = oneshot::channel();
            let asked = request(shared, tube::Request::Frame(number, reply)).await;
            asked.ok_or_else(ended)?;
            Ok(Some(match answer.await.map_err(|_| ended())? {
                Ok(frame) => Message::Binary(frame.into()),
                Err(message) => {
                    let notice = Notice::Missing { number, message };
                    Message::Text(notice.to_json().into())
                }
            }))
        }
        command => {
            let asked = request(shared, tube::Request::Command(command)).await;
            asked.ok_or_else(ended)?;
            Ok(None)
        }
    }
}

/// Waits for a place among the requests: who sends too many waits for the run, and nobody's are lost.
async fn request(shared: &Shared, mut request: tube::Request) -> Option<()> {
    loop {
        request = match shared.requests.try_send(request) {
            Ok(()) => return Some(()),
            Err(TrySendError::Full(request)) => request,
            Err(TrySendError::Disconnected(_)) => return None,
        };
        tokio::time::sleep(FULL).await;
    }
}

fn farewell(code: u16, reason: &str) -> Message {
    // A close frame holds 123 bytes of reason at most.
    let mut end = reason.len().min(120);
    while !reason.is_char_boundary(end) {
        end -= 1;
    }
    Message::Close(Some(CloseFrame {
        code,
        reason: reason[..end].to_owned().into(),
    }))
}
