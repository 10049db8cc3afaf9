//! WebSocket over HTTP: all frames in order on one connection.

use std::pin::pin;
use std::sync::{Arc, mpsc};
use std::time::Instant;

use anyhow::{Context as _, bail};
use futures_util::{SinkExt as _, Stream, StreamExt as _};
use hyper::body::{Bytes, Incoming};
use hyper::upgrade::Upgraded;
use hyper::{Request, Response};
use hyper_util::rt::TokioIo;
use tokio::sync::mpsc as frames;
use tokio::time::{self, timeout, timeout_at};
use tokio_tungstenite::WebSocketStream;
use tokio_tungstenite::tungstenite::handshake::server::create_response_with_body;
use tokio_tungstenite::tungstenite::protocol::{Role, WebSocketConfig};
use tokio_tungstenite::tungstenite::{self, Message};

use super::client::{Lobby, MAX_MESSAGE_BYTES, SILENCE, Seat};
use yoro_stream::FromClient;

type Socket = WebSocketStream<TokioIo<Upgraded>>;

/// Answers a request for a WebSocket. The connection then has until the deadline to be admitted, and is served if it
/// is.
///
/// # Errors
/// If the request has not the headers of one for a WebSocket.
pub fn accept<B>(
    mut request: Request<Incoming>,
    body: impl FnOnce() -> B,
    lobby: Arc<Lobby>,
    deadline: time::Instant,
) -> Result<Response<B>, tungstenite::Error> {
    let response = create_response_with_body(&request, body)?;
    let upgrade = hyper::upgrade::on(&mut request);
    tokio::spawn(async move {
        let admitted = timeout_at(deadline, async { admit(upgrade.await?, &lobby).await }).await;
        match admitted.map_err(anyhow::Error::from).flatten() {
            Ok((socket, seat)) => {
                let (send, frames) = frames::channel(1);
                let heard = lobby.admit(Frames(send), seat);
                serve(socket, frames, heard).await;
            }
            Err(error) => log::info!("a client is not served: {error}"),
        }
    });
    Ok(response)
}

/// Admits a client if its first message is right.
async fn admit(upgraded: Upgraded, lobby: &Lobby) -> anyhow::Result<(Socket, Seat)> {
    let limits = WebSocketConfig::default()
        .max_message_size(Some(MAX_MESSAGE_BYTES))
        .max_frame_size(Some(MAX_MESSAGE_BYTES));
    let mut socket =
        WebSocketStream::from_raw_socket(TokioIo::new(upgraded), Role::Server, Some(limits)).await;
    let hello = next(&mut socket).await.context("it says nothing")?;
    let (answer, seat) = lobby.answer(&hello)?;
    socket.send(Message::binary(answer)).await.context("it has gone again")?;
    match seat {
        Ok(seat) => Ok((socket, seat)),
        Err(refusal) => {
            socket.close(None).await?;
            bail!("{refusal:?}")
        }
    }
}

/// Returns the client's next message; `None` if it is gone, or sends anything but messages.
async fn next(from: &mut (impl Stream<Item = tungstenite::Result<Message>> + Unpin)) -> Option<Bytes> {
    loop {
        match from.next().await?.ok()? {
            Message::Binary(bytes) => return Some(bytes),
            // The protocol allows these at any time.
            Message::Ping(_) | Message::Pong(_) => {}
            _ => return None,
        }
    }
}

/// Sends frames and passes on messages, until the client is silent or lost, or sends anything else, or until the
/// session ends.
async fn serve(
    socket: Socket,
    mut frames: frames::Receiver<Vec<u8>>,
    heard: mpsc::Sender<(FromClient, Instant)>,
) {
    let (mut to, mut from) = socket.split();
    {
        let listening = pin!(async move {
            while let Ok(Some(bytes)) = timeout(SILENCE, next(&mut from)).await {
                let Some(message) = FromClient::read(&bytes) else { break };
                if heard.send((message, Instant::now())).is_err() {
                    break;
                }
            }
        });
        let sending = pin!(async {
            while let Some(frame) = frames.recv().await {
                let sent = timeout(SILENCE, to.send(Message::binary(frame))).await;
                if !matches!(sent, Ok(Ok(()))) {
                    break;
                }
            }
        });
        tokio::select! {
            () = listening => {}
            () = sending => {}
        }
    }
    // A lost connection needs no farewell.
    let _ = timeout(SILENCE, to.close()).await;
}

/// Sends frames to a client, one after the other.
pub struct Frames(frames::Sender<Vec<u8>>);

impl Frames {
    /// Sends a frame. May wait while earlier frames are sent.
    ///
    /// # Errors
    /// If the client is gone.
    pub fn send(&self, bytes: Vec<u8>) -> anyhow::Result<()> {
        self.0.blocking_send(bytes).ok().context("it takes no frames")
    }
}
