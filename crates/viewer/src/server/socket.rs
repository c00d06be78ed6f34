//! The WebSocket beside a page: frames and notices to a client, its commands to the run.

use std::sync::Arc;
use std::time::Duration;

use axum::extract::ws::{CloseFrame, Message, WebSocket, close_code};
use futures_util::{SinkExt, StreamExt};
use tokio::sync::{broadcast, oneshot};

use super::session::{Request, Session};
use crate::message::{Command, Notice, problem};

/// Time after which a client that takes no frame is disconnected.
const SLOW: Duration = Duration::from_secs(30);

/// Serves one client until either side closes the connection.
pub(crate) async fn serve_client(socket: WebSocket, session: Session) {
    let (mut to, mut from) = socket.split();
    let mut frames = session.subscribers.frames.subscribe();
    let mut notices = session.subscribers.notices.subscribe();
    let Some((welcome, past)) = welcome(&session).await else {
        return;
    };
    let past = past.into_iter();
    let past = past.map(|frame| Message::Binary(frame.to_vec().into()));
    for message in std::iter::once(Message::Text(welcome.into())).chain(past) {
        let sent = tokio::time::timeout(SLOW, to.send(message)).await;
        if !matches!(sent, Ok(Ok(()))) {
            return;
        }
    }
    frames.mark_changed();
    loop {
        let message = tokio::select! {
            received = from.next() => match received {
                Some(Ok(Message::Text(text))) => match ask(&session, &text).await {
                    Ok(None) => continue,
                    Ok(Some(answer)) => answer,
                    Err(reason) => {
                        drop(to.send(Message::Text(problem(&reason).into())).await);
                        farewell(close_code::POLICY, &reason)
                    }
                },
                Some(Ok(Message::Ping(_) | Message::Pong(_))) => continue,
                Some(Ok(Message::Binary(_))) => farewell(close_code::UNSUPPORTED, "commands are text"),
                // The connection is closed or broken.
                Some(Ok(Message::Close(_)) | Err(_)) | None => return,
            },
            changed = frames.changed() => {
                if changed.is_err() {
                    return;
                }
                let frame = Arc::clone(&frames.borrow_and_update());
                // No frame yet, or a recording, which sends none by itself.
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

async fn welcome(session: &Session) -> Option<(String, Vec<Arc<Vec<u8>>>)> {
    let (reply, answer) = oneshot::channel();
    session.request(Request::Welcome(reply)).await?;
    answer.await.ok()
}

/// Passes a message on to the run. Answers with the message for this client, if there is one, or with the reason to close
/// the connection.
async fn ask(session: &Session, text: &str) -> Result<Option<Message>, String> {
    let ended = || "the run has ended".to_owned();
    match Command::read(text).map_err(|reason| format!("not a command: {reason}"))? {
        Command::Frame { number } => {
            let (reply, answer) = oneshot::channel();
            let asked = session.request(Request::Frame(number, reply)).await;
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
            let (reply, answer) = oneshot::channel();
            let asked = session.request(Request::Command(command, reply)).await;
            asked.ok_or_else(ended)?;
            let notice = answer.await.map_err(|_| ended())?;
            Ok(notice.map(|text| Message::Text(text.into())))
        }
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
