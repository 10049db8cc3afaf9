//! Access control: pages that have the token are served, one at a time. Clients without it are limited in the number of
//! connections and in time.

use std::collections::HashMap;
use std::io::Write as _;
use std::net::{IpAddr, TcpListener, TcpStream};
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError, mpsc};
use std::thread;
use std::time::Duration;

use anyhow::{Context as _, anyhow, bail};
use rustls::ServerConfig;
use tungstenite::handshake::derive_accept_key;
use tungstenite::protocol::{Role, WebSocketConfig};
use tungstenite::{Message, WebSocket};

use super::connection::Connection;
use super::session::{Client, SILENCE, Transport, listen};
use yoro_files::http::{self, Request};
use yoro_stream::{FromClient, FromServer, Refusal, Token, VERSION};

/// The largest message of a client in bytes.
pub const MAX_MESSAGE_BYTES: usize = 1 << 12;
/// The time allowed for a handshake, its request and the following hello.
pub const HELLO_TIMEOUT: Duration = Duration::from_secs(10);
/// The time allowed for sending a file.
const FILE_TIMEOUT: Duration = Duration::from_secs(60);
/// The pause after a connection that could not be accepted.
const ACCEPT_PAUSE: Duration = Duration::from_millis(200);
/// The number of connections that may wait for admission, from all machines and from one. A browser opens six for the
/// files of a page.
const MAX_PENDING: [usize; 2] = [64, 16];

/// A client's WebSocket connection.
pub type Socket = WebSocket<Connection>;

/// Admits clients.
pub struct Access {
    pub token: Token,
    /// `http` or `https`.
    pub scheme: &'static str,
    /// The host names under which browsers reach this server.
    pub hosts: Vec<String>,
    /// The origin of another server whose page may also show the stream.
    pub origin: Option<String>,
    pub folder: PathBuf,
    /// The first message to an admitted client, such as the head's first pose.
    pub welcome: FromServer<'static>,
    /// The encryption of connections, if any.
    pub tls: Option<Arc<ServerConfig>>,
    busy: AtomicBool,
    pending: Arc<PendingConnections>,
}

impl Access {
    pub fn new(
        token: Token,
        (scheme, hosts): (&'static str, Vec<String>),
        origin: Option<String>,
        folder: PathBuf,
        welcome: FromServer<'static>,
        tls: Option<Arc<ServerConfig>>,
    ) -> Access {
        let (busy, pending) = (AtomicBool::new(false), Arc::default());
        Access { token, scheme, hosts, origin, folder, welcome, tls, busy, pending }
    }

    /// Accepts connections forever, and passes on the admitted clients.
    pub fn accept(self: &Arc<Self>, listener: &TcpListener, clients: &mpsc::Sender<Client>) {
        loop {
            let (socket, address) = match listener.accept() {
                Ok(accepted) => accepted,
                Err(error) => {
                    // For example, no file descriptors are left: the next attempt would fail at once, too.
                    log::warn!("a connection is not accepted: {error}");
                    thread::sleep(ACCEPT_PAUSE);
                    continue;
                }
            };
            let Some(place) = self.place(address.ip()) else {
                log::info!("{address} has too many connections");
                continue;
            };
            let (access, clients) = (self.clone(), clients.clone());
            // Each connection has a thread, since a browser keeps some connections open without requesting anything.
            thread::spawn(move || {
                if let Err(error) = access.answer(socket, &clients) {
                    log::info!("{address} is not served: {error}");
                }
                drop(place);
            });
        }
    }

    /// Returns a place among the connections that wait for admission; `None` if there are too many.
    pub fn place(&self, address: IpAddr) -> Option<Place> {
        PendingConnections::enter(&self.pending, address)
    }

    /// Answers a connection: sends a file, or admits a page of this server that has the token.
    fn answer(self: &Arc<Self>, socket: TcpStream, clients: &mpsc::Sender<Client>) -> anyhow::Result<()> {
        let connection = Connection::new(socket, self.tls.as_ref(), HELLO_TIMEOUT)?;
        let request = Request::read(connection.clone())?;
        let admitted = if request.target() == Some("/stream") {
            self.admit(&connection, &request).map(Some)
        } else {
            connection.set_deadline(FILE_TIMEOUT);
            Ok(http::answer(&mut connection.clone(), &request, &self.folder).map(|()| None)?)
        };
        let Ok(Some(seat)) = admitted else {
            connection.close();
            return admitted.map(drop);
        };
        connection.set_timeout(SILENCE);
        let (tell, heard) = mpsc::channel();
        let transport = Transport::WebSocket(Box::new(web_socket(connection.clone())));
        if clients.send(Client { heard, transport, seat }).is_ok() {
            thread::spawn(move || listen(web_socket(connection), &tell));
        }
        Ok(())
    }

    /// True if a page may connect: the requested host must be this server's, and the origin this server or the allowed
    /// one. This keeps out other sites' pages, even if their names are made to resolve to this machine.
    pub fn allows(&self, host: &str, origin: Option<&str>) -> bool {
        let is_own = || origin == Some(&format!("{}://{host}", self.scheme));
        let is_named = || origin.is_some() && origin == self.origin.as_deref();
        self.hosts.iter().any(|name| name == host) && (is_own() || is_named())
    }

    /// Admits a page that has the token.
    fn admit(self: &Arc<Self>, connection: &Connection, request: &Request) -> anyhow::Result<Seat> {
        let mut connection = connection.clone();
        let allowed = self.allows(request.header("host").unwrap_or_default(), request.header("origin"));
        let Some(key) = request.header("sec-websocket-key").filter(|_| allowed) else {
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
        let (answer, admitted) = self.answer_hello(&socket.read()?.into_data())?;
        socket.send(Message::binary(answer)).context("it has gone again")?;
        admitted
    }

    /// Returns the answer to a client's first message, and its seat if it has the token and no one else is served.
    ///
    /// # Errors
    /// If the message is not a hello.
    pub fn answer_hello(self: &Arc<Self>, bytes: &[u8]) -> anyhow::Result<(Vec<u8>, anyhow::Result<Seat>)> {
        let Some(FromClient::Hello { version, token }) = FromClient::read(bytes) else {
            bail!("it does not say hello");
        };
        // The comparison takes constant time, so that it reveals nothing about the token.
        let differs = token.iter().zip(&self.token).fold(0, |differs, (a, b)| differs | (a ^ b));
        let refusal = if version != VERSION {
            Refusal::Version
        } else if differs != 0 {
            Refusal::Token
        } else if self.busy.swap(true, Ordering::SeqCst) {
            Refusal::Busy
        } else {
            return Ok((self.welcome.to_bytes(), Ok(Seat(self.clone()))));
        };
        Ok((FromServer::Refused(refusal).to_bytes(), Err(anyhow!("{refusal:?}"))))
    }
}

/// The right to be served. When it is dropped, another client may be admitted.
pub struct Seat(Arc<Access>);

impl Drop for Seat {
    fn drop(&mut self) {
        self.0.busy.store(false, Ordering::SeqCst);
    }
}

/// Returns a WebSocket on a connection whose handshake is done.
pub fn web_socket(connection: Connection) -> Socket {
    let limits = WebSocketConfig::default()
        .max_message_size(Some(MAX_MESSAGE_BYTES))
        .max_frame_size(Some(MAX_MESSAGE_BYTES));
    WebSocket::from_raw_socket(connection, Role::Server, Some(limits))
}

/// The number of connections that wait for admission, by address, so that one machine cannot keep others from
/// connecting.
#[derive(Default)]
struct PendingConnections(Mutex<HashMap<IpAddr, usize>>);

/// A place among the waiting connections, which is freed when it is dropped.
pub struct Place(Arc<PendingConnections>, IpAddr);

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

    #[test]
    fn pages_of_this_server_and_of_the_named_origin_may_connect() {
        let hosts = vec!["10.0.0.1:80".to_owned()];
        let origin = Some("https://host".to_owned());
        let access = Access::new(
            Token::default(),
            ("https", hosts),
            origin,
            PathBuf::new(),
            FromServer::Welcome(yoro::eyes::Pose::IDENTITY),
            None,
        );
        for (host, origin, allowed) in [
            ("10.0.0.1:80", Some("https://10.0.0.1:80"), true),
            ("10.0.0.1:80", Some("https://host"), true),
            ("10.0.0.1:80", Some("http://10.0.0.1:80"), false),
            ("10.0.0.1:80", Some("https://host.example"), false),
            ("10.0.0.1:80", None, false),
            ("elsewhere", Some("https://host"), false),
            ("elsewhere", Some("https://elsewhere"), false),
        ] {
            assert_eq!(access.allows(host, origin), allowed, "{host}, {origin:?}");
        }
    }
}
