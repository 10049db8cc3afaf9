//! Who gets in: pages of this server that have the token, one at a time. Clients without the token are limited in the
//! number of connections and in time.

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

/// The largest message of a client, in bytes.
pub const MAX_MESSAGE_BYTES: usize = 1 << 12;
/// The time for a handshake with its request and the hello after it.
pub const HELLO_TIMEOUT: Duration = Duration::from_secs(10);
/// The time for sending a file.
const FILE_TIMEOUT: Duration = Duration::from_secs(60);
/// The number of connections that may wait to be let in, of all machines and of one. A browser opens six for a page's
/// files.
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
    /// The origin of another server's page that may show the stream, too.
    pub origin: Option<String>,
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
        origin: Option<String>,
        folder: PathBuf,
        welcome: FromServer<'static>,
        tls: Option<Arc<ServerConfig>>,
    ) -> Access {
        let (busy, pending) = (AtomicBool::new(false), Arc::default());
        Access { token, scheme, hosts, origin, folder, welcome, tls, busy, pending }
    }

    /// Accepts connections for ever, and passes on those that are let in.
    pub fn accept(self: &Arc<Self>, listener: &TcpListener, clients: &mpsc::Sender<Client>) {
        for (socket, address) in std::iter::repeat_with(|| listener.accept()).flatten() {
            let Some(place) = self.place(address.ip()) else {
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

    /// Returns a place among the connections that wait to be let in; none where there are too many.
    pub fn place(&self, address: IpAddr) -> Option<Place> {
        PendingConnections::enter(&self.pending, address)
    }

    /// Answers a connection: with a file, or, for a page of this server with the token, by letting it in.
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

    /// True if a page may connect: against other sites' pages and names that are made to lead here, the host that it
    /// asks for must be this one, and its origin, too, or the one that was named.
    pub fn allows(&self, host: &str, origin: Option<&str>) -> bool {
        let is_own = || origin == Some(&format!("{}://{host}", self.scheme));
        let is_named = || origin.is_some() && origin == self.origin.as_deref();
        self.hosts.iter().any(|name| name == host) && (is_own() || is_named())
    }

    /// Lets a page in that has the token.
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

    /// Returns the answer to a first message, and, for one with the token while nobody else is served, the seat that
    /// lets its sender in.
    ///
    /// # Errors
    /// When it is no hello.
    pub fn answer_hello(self: &Arc<Self>, bytes: &[u8]) -> anyhow::Result<(Vec<u8>, anyhow::Result<Seat>)> {
        let Some(FromClient::Hello { version, token }) = FromClient::read(bytes) else {
            bail!("it does not say hello");
        };
        // In constant time.
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

/// The right to be served: when it is dropped, another client may come.
pub struct Seat(Arc<Access>);

impl Drop for Seat {
    fn drop(&mut self) {
        self.0.busy.store(false, Ordering::SeqCst);
    }
}

/// Speaks WebSocket on a connection whose handshake is done.
pub fn web_socket(connection: Connection) -> Socket {
    let limits = WebSocketConfig::default()
        .max_message_size(Some(MAX_MESSAGE_BYTES))
        .max_frame_size(Some(MAX_MESSAGE_BYTES));
    WebSocket::from_raw_socket(connection, Role::Server, Some(limits))
}

/// The number of connections that have not been let in, by the address that they come from: one machine must not keep
/// others from connecting.
#[derive(Default)]
struct PendingConnections(Mutex<HashMap<IpAddr, usize>>);

/// One of these connections: it is counted until this is dropped.
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
