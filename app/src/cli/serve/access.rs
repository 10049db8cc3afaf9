//! Who gets in: pages of this server that have the token, one at a time. Clients without the token are limited in the number of
//! connections and in time.

use std::collections::HashMap;
use std::io::Write as _;
use std::net::{IpAddr, TcpListener, TcpStream};
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError, mpsc};
use std::thread;
use std::time::Duration;

use anyhow::{Context as _, bail};
use rustls::ServerConfig;
use tungstenite::handshake::derive_accept_key;
use tungstenite::protocol::{Role, WebSocketConfig};
use tungstenite::{Message, WebSocket};

use super::connection::Connection;
use yoro_files::http::{self, Request};
use yoro_stream::{FromServer, FromViewer, Refusal, Token, VERSION};

/// The largest message of a viewer, in bytes.
const MAX_MESSAGE_BYTES: usize = 1 << 12;
/// The time for a handshake with its request and the hello after it.
const HELLO_TIMEOUT: Duration = Duration::from_secs(10);
/// The time for sending a file.
const FILE_TIMEOUT: Duration = Duration::from_secs(60);
/// The number of connections that may wait to be let in, of all machines and of one. A browser opens six for a page's files.
const MAX_PENDING: [usize; 2] = [64, 16];

/// A client's connection, once it speaks WebSocket.
pub type Socket = WebSocket<Connection>;

/// Admits clients.
pub struct Access {
    pub token: Token,
    /// `http` or `https`.
    pub scheme: &'static str,
    /// The names of this server, as browsers call it.
    pub hosts: Vec<String>,
    pub folder: PathBuf,
    /// The head's first pose.
    pub welcome: FromServer<'static>,
    /// How connections are encrypted, if they are.
    pub tls: Option<Arc<ServerConfig>>,
    busy: AtomicBool,
    pending: Arc<PendingConnections>,
}

impl Access {
    pub fn new(
        token: Token,
        (scheme, hosts): (&'static str, Vec<String>),
        folder: PathBuf,
        welcome: FromServer<'static>,
        tls: Option<Arc<ServerConfig>>,
    ) -> Access {
        let (busy, pending) = (AtomicBool::new(false), Arc::default());
        Access { token, scheme, hosts, folder, welcome, tls, busy, pending }
    }

    /// Accepts connections for ever, and passes on those that are let in.
    pub fn accept(self: &Arc<Self>, listener: &TcpListener, clients: &mpsc::Sender<Connection>) {
        for (socket, address) in std::iter::repeat_with(|| listener.accept()).flatten() {
            let Some(place) = PendingConnections::enter(&self.pending, address.ip()) else {
                log::info!("{address} has too many connections");
                continue;
            };
            let (access, clients) = (self.clone(), clients.clone());
            // A browser keeps some connections open without asking for anything.
            thread::spawn(move || {
                if let Err(error) = access.answer(socket, &clients) {
                    log::info!("{address} is not served: {error}");
                }
                drop(place);
            });
        }
    }

    /// The client is gone: another one may come.
    pub fn leave(&self) {
        self.busy.store(false, Ordering::SeqCst);
    }

    /// Answers a connection: with a file, or, for a page of this server with the token, by letting it in.
    fn answer(&self, socket: TcpStream, clients: &mpsc::Sender<Connection>) -> anyhow::Result<()> {
        let connection = Connection::new(socket, self.tls.as_ref(), HELLO_TIMEOUT)?;
        let request = Request::read(connection.clone())?;
        let admitted = if request.target() == Some("/stream") {
            self.admit(&connection, &request)
        } else {
            connection.set_deadline(FILE_TIMEOUT);
            Ok(http::answer(&mut connection.clone(), &request, &self.folder).map(|()| false)?)
        };
        match admitted {
            Ok(true) => {
                if clients.send(connection).is_err() {
                    self.leave();
                }
                Ok(())
            }
            other => {
                connection.close();
                other.map(drop)
            }
        }
    }

    /// Lets a page of this server in that has the token. It is the only one then, until it [leaves](Access::leave).
    fn admit(&self, connection: &Connection, request: &Request) -> anyhow::Result<bool> {
        let mut connection = connection.clone();
        let host = request.header("host").unwrap_or_default();
        // Against WebSocket hijacking by other sites and DNS rebinding: both must be ours.
        let own = self.hosts.iter().any(|name| name == host)
            && request.header("origin") == Some(&format!("{}://{host}", self.scheme));
        let key = request.header("sec-websocket-key").filter(|_| own);
        let Some(key) = key else {
            connection
                .write_all(b"HTTP/1.1 403 Forbidden\r\nContent-Length: 0\r\nConnection: close\r\n\r\n")?;
            bail!("it is another site's page");
        };
        let upgraded = format!(
            "HTTP/1.1 101 Switching Protocols\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n\
             Sec-WebSocket-Accept: {}\r\n\r\n",
            derive_accept_key(key.as_bytes())
        );
        connection.write_all(upgraded.as_bytes())?;
        let mut socket = web_socket(connection);
        let hello = FromViewer::read(&socket.read()?.into_data());
        let Some(FromViewer::Hello { version, token }) = hello else {
            bail!("it does not say hello");
        };
        // In constant time.
        let differs = token.iter().zip(&self.token).fold(0, |differs, (a, b)| differs | (a ^ b));
        let refusal = if version != VERSION {
            Some(Refusal::Version)
        } else if differs != 0 {
            Some(Refusal::Token)
        } else if self.busy.swap(true, Ordering::SeqCst) {
            Some(Refusal::Busy)
        } else {
            None
        };
        if let Some(refusal) = refusal {
            socket.send(Message::binary(FromServer::Refused(refusal).to_bytes()))?;
            bail!("{refusal:?}");
        }
        let welcomed = socket.send(Message::binary(self.welcome.to_bytes()));
        if welcomed.is_err() {
            self.leave();
        }
        welcomed.map(|()| true).context("it has gone again")
    }
}

/// Speaks WebSocket on a connection whose handshake is done.
pub fn web_socket(connection: Connection) -> Socket {
    let limits = WebSocketConfig::default()
        .max_message_size(Some(MAX_MESSAGE_BYTES))
        .max_frame_size(Some(MAX_MESSAGE_BYTES));
    WebSocket::from_raw_socket(connection, Role::Server, Some(limits))
}

/// The number of connections that have not been let in, by the address that they come from: one machine must not keep others from
/// connecting.
#[derive(Default)]
struct PendingConnections(Mutex<HashMap<IpAddr, usize>>);

/// One of these connections: it is counted until this is dropped.
struct Place(Arc<PendingConnections>, IpAddr);

impl PendingConnections {
    fn enter(pending: &Arc<PendingConnections>, address: IpAddr) -> Option<Place> {
        let mut counts = pending.0.lock().unwrap_or_else(PoisonError::into_inner);
        let [most, most_of_one] = MAX_PENDING;
        if counts.values().sum::<usize>() >= most || counts.get(&address).is_some_and(|n| *n >= most_of_one) {
            return None;
        }
        *counts.entry(address).or_default() += 1;
        Some(Place(pending.clone(), address))
    }
}

impl Drop for Place {
    fn drop(&mut self) {
        let mut counts = self.0.0.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(count) = counts.get_mut(&self.1) {
            *count -= 1;
            if *count == 0 {
                counts.remove(&self.1);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_machine_cannot_take_all_connections() {
        let pending = Arc::default();
        let enter = |last: u8| PendingConnections::enter(&pending, IpAddr::from([10, 0, 0, last]));
        let mut taken: Vec<_> = std::iter::from_fn(|| enter(1)).collect();
        assert_eq!(taken.len(), MAX_PENDING[1]);
        assert!(enter(2).is_some(), "another machine comes in");
        taken.pop();
        assert!(enter(1).is_some(), "a place is free again");
        let others: Vec<_> = (2..=200).filter_map(enter).collect();
        assert_eq!(taken.len() + others.len(), MAX_PENDING[0]);
    }
}
