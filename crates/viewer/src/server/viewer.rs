//! The server: pages, what they ask for, and a WebSocket for frames and commands.

use std::net::Ipv4Addr;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;

use axum::Router;
use axum::extract::ws::WebSocketUpgrade;
use axum::extract::ws::rejection::WebSocketUpgradeRejection;
use axum::extract::{Path, Request, State};
use axum::http::{HeaderMap, HeaderValue, StatusCode, header};
use axum::middleware::{self, Next};
use axum::response::{IntoResponse, Response};
use axum::routing::get;
use hyper::server::conn::http1;
use hyper_util::rt::{TokioIo, TokioTimer};
use hyper_util::service::TowerToHyperService;
use peristalsis_observe::Sample;
use peristalsis_run::Run;
use tokio::net::TcpListener;
use tokio::runtime::Runtime;
use tokio::sync::Semaphore;

use super::assets::asset;
use super::error::ViewerError;
use super::figure::Figure;
use super::gallery::{Closed, Gallery, OPEN};
use super::guard::{Token, is_loopback, is_own};
use super::recording::Recording;
use super::recording_host::RecordingHost;
use super::run_host::RunHost;
use super::session::Session;
use super::socket::serve_client;
use super::study::Study;
use crate::tube::{Labels, Saves};

/// Connections at a time that have not become a client's; more wait.
const CONNECTIONS: usize = 64;
/// Time within which the head of a request must come.
const PATIENCE: Duration = Duration::from_secs(5);
/// Bytes of a request's head, at most.
const HEAD_BYTES: usize = 16 * 1024;
/// Clients at a time.
const CLIENTS: usize = 8;
/// Bytes of a message from a client, at most.
const MESSAGE_BYTES: usize = 4096;
/// Time between two looks whether to stop.
const LOOK: Duration = Duration::from_millis(50);

/// The page may load its own files only.
const CONTENT_SECURITY_POLICY: &str = "default-src 'none'; script-src 'self'; style-src 'self'; \
     connect-src 'self'; img-src 'self' data: blob:; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

const JSON: &str = "application/json";

/// How to serve a run.
#[derive(Clone, Debug)]
pub struct Options {
    /// Port on loopback; 0 takes a free one.
    pub port: u16,
    /// Title of the run; the names of saved states begin with it.
    pub title: String,
    /// Folder in which states are saved.
    pub saves: PathBuf,
    /// The time series of the same run, if it was computed before.
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

/// The state that all requests share.
#[derive(Clone)]
struct Shared {
    token: Arc<Token>,
    exhibit: Exhibit,
    clients: Arc<Semaphore>,
}

/// What the viewer shows.
#[derive(Clone)]
enum Exhibit {
    /// One run, or the recording of one.
    Tube(Session),
    /// Studies with their runs.
    Gallery(Arc<Gallery>),
}

impl Viewer {
    /// Listens on loopback and puts the run into a thread of its own, at rest.
    ///
    /// # Errors
    /// [`ViewerError`] where the system gives no port, thread or random number.
    pub fn open(run: Run, options: Options) -> Result<Self, ViewerError> {
        let samples = options.record.iter();
        let labels = Labels {
            saves: Saves::Folders {
                inside: options.saves,
                stem: options.title.clone(),
            },
            title: options.title,
            record: samples.map(|it| (it.time, it.flow_rate_ratio)).collect(),
            within: None,
        };
        let session = Session::start(|subscribers, requests| {
            RunHost::new(run, labels, subscribers).work(&requests);
        })?;
        Self::listen(options.port, Exhibit::Tube(session))
    }

    /// Listens on loopback and serves the frames of a recording. Port 0 takes a free one.
    ///
    /// # Errors
    /// As [`Viewer::open`].
    pub fn play(recording: Recording, title: String, port: u16) -> Result<Self, ViewerError> {
        let session = Session::start(|_, requests| {
            let host = RecordingHost {
                recording,
                title,
                within: None,
            };
            host.work(&requests);
        })?;
        Self::listen(port, Exhibit::Tube(session))
    }

    /// Listens on loopback and shows studies, whose runs can be opened, and figures. States of runs are saved in `saves`.
    ///
    /// # Errors
    /// As [`Viewer::open`].
    pub fn exhibit(
        studies: Vec<Study>,
        figures: Vec<Figure>,
        saves: PathBuf,
        port: u16,
    ) -> Result<Self, ViewerError> {
        let gallery = Gallery::new(studies, figures, saves);
        Self::listen(port, Exhibit::Gallery(Arc::new(gallery)))
    }

    fn listen(port: u16, exhibit: Exhibit) -> Result<Self, ViewerError> {
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
        let shared = Shared {
            token: Arc::new(token.clone()),
            exhibit,
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

/// Takes at most [`CONNECTIONS`] connections at a time. A connection that ends, or becomes a client's, makes room for another.
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
            // A connection that breaks off or is not HTTP needs no further answer.
            drop(connection.await);
            drop(place);
        });
    }
}

/// A path that does not exist and a wrong token get the same answer.
fn router(shared: Shared) -> Router {
    let pages = match &shared.exhibit {
        Exhibit::Tube(_) => Router::new()
            .route("/{token}/", get(async || asset("tube.html")))
            .route("/{token}/live", get(live))
            .route("/{token}/{name}", get(file)),
        Exhibit::Gallery(gallery) => rooms(Arc::clone(gallery)),
    };
    pages
        .layer(middleware::from_fn_with_state(shared.clone(), admit))
        .layer(middleware::from_fn(guard))
        .with_state(shared)
}

/// The pages of studies and of their runs.
fn rooms(gallery: Arc<Gallery>) -> Router<Shared> {
    let [list, study, figure] = [(); 3].map(|()| Arc::clone(&gallery));
    type Numbers = (String, usize, usize);
    Router::new()
        .route("/{token}/", get(async || asset("study.html")))
        .route(
            "/{token}/list",
            get(async move || ([(header::CONTENT_TYPE, JSON)], list.list())),
        )
        .route(
            "/{token}/study/{study}",
            get(
                async move |Path((_, number)): Path<(String, usize)>, headers: HeaderMap| {
                    study_as(&study, number, &headers)
                },
            ),
        )
        .route(
            "/{token}/figure/{figure}",
            get(async move |Path((_, number)): Path<(String, usize)>| {
                let picture = figure.picture(number).ok_or(StatusCode::NOT_FOUND)?;
                Ok::<_, StatusCode>(([(header::CONTENT_TYPE, "image/svg+xml")], picture))
            }),
        )
        .route(
            "/{token}/study/{study}/run/{run}/",
            get(async move |Path((_, study, number)): Path<Numbers>| {
                if gallery.holds((study, number)) {
                    asset("tube.html")
                } else {
                    StatusCode::NOT_FOUND.into_response()
                }
            }),
        )
        .route("/{token}/study/{study}/run/{run}/live", get(live_in_study))
        .route(
            "/{token}/study/{study}/run/{run}/{name}",
            get(async |Path((_, _, _, name)): Path<(String, usize, usize, String)>| asset(&name)),
        )
        .route("/{token}/{name}", get(file))
}

/// A study, or "not modified" if the client has this version.
fn study_as(gallery: &Gallery, number: usize, headers: &HeaderMap) -> Response {
    let known = headers
        .get(header::IF_NONE_MATCH)
        .and_then(|tag| tag.to_str().ok()?.trim_matches('"').parse().ok());
    // Reading a store takes some ten milliseconds, in which the other thread goes on.
    match tokio::task::block_in_place(|| gallery.study(number, known)) {
        None => StatusCode::NOT_FOUND.into_response(),
        Some(Ok(None)) => StatusCode::NOT_MODIFIED.into_response(),
        Some(Ok(Some(study))) => ([(header::CONTENT_TYPE, JSON)], study).into_response(),
        Some(Err(error)) => (StatusCode::INTERNAL_SERVER_ERROR, error.to_string()).into_response(),
    }
}

/// Refuses requests whose path does not begin with the token.
async fn admit(State(shared): State<Shared>, request: Request, next: Next) -> Response {
    let token = request.uri().path().split('/').nth(1).unwrap_or_default();
    if shared.token.is(token) {
        next.run(request).await
    } else {
        StatusCode::NOT_FOUND.into_response()
    }
}

/// Whether a request names this machine as its host and comes from its page or from none; each header at most once.
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

/// Refuses requests from other pages, and forbids other pages to use the answers.
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

async fn file(Path((_, name)): Path<(String, String)>) -> Response {
    asset(&name)
}

/// A request for a WebSocket, or what is wrong with it.
type Upgrade = Result<WebSocketUpgrade, WebSocketUpgradeRejection>;

async fn live(State(shared): State<Shared>, upgrade: Upgrade) -> Response {
    match &shared.exhibit {
        Exhibit::Tube(session) => talk(&shared, session.clone(), upgrade),
        Exhibit::Gallery(_) => StatusCode::NOT_FOUND.into_response(),
    }
}

async fn live_in_study(
    State(shared): State<Shared>,
    Path((_, study, run)): Path<(String, usize, usize)>,
    upgrade: Upgrade,
) -> Response {
    let Exhibit::Gallery(gallery) = &shared.exhibit else {
        return StatusCode::NOT_FOUND.into_response();
    };
    match gallery.enter((study, run)) {
        Ok(session) => talk(&shared, session, upgrade),
        Err(Closed::Unknown) => StatusCode::NOT_FOUND.into_response(),
        Err(Closed::Full) => busy(&format!(
            "{OPEN} runs are open, as many as this viewer computes"
        )),
        Err(Closed::Failed(error)) => {
            (StatusCode::INTERNAL_SERVER_ERROR, error.to_string()).into_response()
        }
    }
}

/// Upgrades to a WebSocket, if there is a place for one more client.
fn talk(shared: &Shared, session: Session, upgrade: Upgrade) -> Response {
    // Before the question whether it asks for a WebSocket, so that a page can ask why it got none.
    let Ok(place) = Arc::clone(&shared.clients).try_acquire_owned() else {
        return busy(&format!(
            "{CLIENTS} pages are open, as many as this viewer serves"
        ));
    };
    let upgrade = match upgrade {
        Ok(upgrade) => upgrade,
        Err(rejection) => return rejection.into_response(),
    };
    upgrade
        .max_message_size(MESSAGE_BYTES)
        .max_frame_size(MESSAGE_BYTES)
        .on_upgrade(async move |socket| {
            serve_client(socket, session).await;
            drop(place);
        })
}

/// That as much is open as this viewer serves.
fn busy(reason: &str) -> Response {
    let wait = [(header::RETRY_AFTER, "5")];
    let reason = format!("{reason}: close one of them");
    (StatusCode::SERVICE_UNAVAILABLE, wait, reason).into_response()
}
