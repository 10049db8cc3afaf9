//! Clients: how they are admitted, one at a time, and how they are spoken with.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{self, Receiver, Sender};
use std::time::{Duration, Instant};

use anyhow::Context as _;

use super::access::Access;
use super::web_socket::Frames;
use yoro_stream::{FromClient, FromServer, Refusal};

/// The largest message of a client in bytes.
pub const MAX_MESSAGE_BYTES: usize = 1 << 12;
/// The time allowed for a handshake, its request and the following hello.
pub const HELLO_TIMEOUT: Duration = Duration::from_secs(10);
/// A client that sends nothing for this long is considered gone.
pub const SILENCE: Duration = Duration::from_secs(3);

/// An admitted client.
pub struct Client {
    /// Its messages with their times of arrival, until it is gone.
    pub heard: Receiver<(FromClient, Instant)>,
    /// Where its frames go. The connection is closed when this is dropped.
    pub frames: Frames,
    /// Held while it is served. It is dropped last, when the connection is closed.
    _seat: Seat,
}

/// The right to be served. When it is dropped, another client may be admitted.
pub struct Seat(Arc<AtomicBool>);

impl Drop for Seat {
    fn drop(&mut self) {
        self.0.store(false, Ordering::SeqCst);
    }
}

/// Admits clients.
pub struct Lobby {
    pub access: Access,
    /// The first message to an admitted client, such as the head's first pose.
    welcome: Vec<u8>,
    is_taken: Arc<AtomicBool>,
    admitted: Sender<Client>,
}

impl Lobby {
    /// Returns a lobby and the clients that it admits.
    pub fn new(access: Access, welcome: &FromServer) -> (Arc<Lobby>, Receiver<Client>) {
        let (admitted, clients) = mpsc::channel();
        let is_taken = Arc::default();
        (Arc::new(Lobby { access, welcome: welcome.to_bytes(), is_taken, admitted }), clients)
    }

    /// Returns the answer to a client's first message, and the seat if it may be served and no one else is.
    ///
    /// # Errors
    /// If the message is not a hello.
    pub fn answer(&self, hello: &[u8]) -> anyhow::Result<(Vec<u8>, Result<Seat, Refusal>)> {
        let judged = self.access.judge(hello).context("it does not say hello")?;
        let seat = judged.and_then(|()| match self.is_taken.swap(true, Ordering::SeqCst) {
            true => Err(Refusal::Busy),
            false => Ok(Seat(self.is_taken.clone())),
        });
        let answer = match &seat {
            Ok(_) => self.welcome.clone(),
            Err(refusal) => FromServer::Refused(*refusal).to_bytes(),
        };
        Ok((answer, seat))
    }

    /// Passes on a client to be served. Returns where its messages go.
    pub fn admit(&self, frames: Frames, seat: Seat) -> Sender<(FromClient, Instant)> {
        let (tell, heard) = mpsc::channel();
        // If there is no receiver, the program is about to end.
        let _ = self.admitted.send(Client { heard, frames, _seat: seat });
        tell
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use yoro::eyes::Pose;
    use yoro_stream::VERSION;

    #[test]
    fn one_client_is_served_at_a_time() {
        let access = Access { token: [7; 16], scheme: "http", hosts: Vec::new() };
        let (lobby, _clients) = Lobby::new(access, &FromServer::Welcome(Pose::IDENTITY));
        let hello = FromClient::Hello { version: VERSION, token: [7; 16] }.to_bytes();
        let (answer, first) = lobby.answer(&hello).unwrap();
        assert!(first.is_ok());
        assert_eq!(FromServer::read(&answer), Some(FromServer::Welcome(Pose::IDENTITY)));
        let (answer, second) = lobby.answer(&hello).unwrap();
        assert_eq!(second.err(), Some(Refusal::Busy));
        assert_eq!(FromServer::read(&answer), Some(FromServer::Refused(Refusal::Busy)));
        drop(first);
        assert!(lobby.answer(&hello).unwrap().1.is_ok());
        assert!(lobby.answer(b"GET").is_err());
    }
}
