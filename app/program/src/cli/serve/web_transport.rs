//! WebTransport over QUIC: a stream for each frame to the client, and datagrams for the client's messages.

use std::net::UdpSocket;
use std::sync::{Arc, mpsc};
use std::thread;
use std::time::Instant;

use anyhow::{Context as _, bail};
use tokio::io::AsyncReadExt as _;
use tokio::runtime::{Builder, Handle};
use tokio::sync::watch;
use tokio::time::timeout;
use wtransport::config::QuicTransportConfig;
use wtransport::endpoint::IncomingSession;
use wtransport::endpoint::endpoint_side::Server;
use wtransport::{Connection, Endpoint, ServerConfig, VarInt};

use super::access::{Access, HELLO_TIMEOUT, MAX_MESSAGE_BYTES, Seat};
use super::session::{Client, SILENCE, Transport};
use yoro_stream::FromClient;

/// Accepts clients on a socket forever, and passes on those that are admitted.
///
/// # Errors
/// If the system refuses.
pub fn accept(
    access: Arc<Access>,
    socket: UdpSocket,
    tls: rustls::ServerConfig,
    clients: mpsc::Sender<Client>,
) -> anyhow::Result<()> {
    let runtime = Builder::new_current_thread().enable_all().build()?;
    // Clients that are not admitted yet must not fill up the memory.
    let mut limits = QuicTransportConfig::default();
    limits
        .max_concurrent_bidi_streams(4u8.into())
        .max_concurrent_uni_streams(8u8.into())
        .stream_receive_window((MAX_MESSAGE_BYTES as u32).into())
        .receive_window((16 * MAX_MESSAGE_BYTES as u32).into())
        .datagram_receive_buffer_size(Some(16 * MAX_MESSAGE_BYTES))
        .max_idle_timeout(Some(SILENCE.try_into()?));
    let config =
        ServerConfig::builder().with_bind_socket(socket).with_custom_tls_and_transport(tls, limits).build();
    let endpoint = {
        let _inside = runtime.enter();
        Endpoint::server(config)?
    };
    thread::spawn(move || runtime.block_on(answer_all(&endpoint, &access, &clients)));
    Ok(())
}

async fn answer_all(endpoint: &Endpoint<Server>, access: &Arc<Access>, clients: &mpsc::Sender<Client>) {
    loop {
        let incoming = endpoint.accept().await;
        let address = incoming.remote_address();
        if !incoming.remote_address_validated() {
            // A forged sender address must not occupy a place.
            incoming.retry();
            continue;
        }
        let Some(place) = access.place(address.ip()) else {
            log::info!("{address} has too many connections");
            incoming.refuse();
            continue;
        };
        let (access, clients) = (access.clone(), clients.clone());
        tokio::spawn(async move {
            let admitted = timeout(HELLO_TIMEOUT, admit(incoming, &access)).await;
            drop(place);
            match admitted.map_err(anyhow::Error::from).flatten() {
                Ok((connection, seat)) => {
                    let (tell, heard) = mpsc::channel();
                    let frames = Frames::new(connection.clone());
                    // If there is no receiver, the program is about to end.
                    let _ = clients.send(Client { heard, transport: Transport::WebTransport(frames), seat });
                    listen(&connection, &tell).await;
                }
                Err(error) => log::info!("{address} is not served: {error}"),
            }
        });
    }
}

/// Admits a client if [`Access`] allows it. Its hello and the answer have a stream of their own.
async fn admit(incoming: IncomingSession, access: &Arc<Access>) -> anyhow::Result<(Connection, Seat)> {
    let request = incoming.await?;
    if request.path() != "/stream" || !access.allows(request.authority(), request.origin()) {
        request.forbidden().await;
        bail!("it is another site's page");
    }
    let connection = request.accept().await?;
    let (mut answers, hello) = connection.accept_bi().await?;
    let mut bytes = Vec::new();
    hello.take(MAX_MESSAGE_BYTES as u64).read_to_end(&mut bytes).await?;
    let (answer, seat) = access.answer_hello(&bytes)?;
    answers.write_all(&answer).await?;
    answers.finish().await?;
    Ok((connection, seat?))
}

/// Passes on a client's messages with their times of arrival, until it is silent or lost, or sends anything else.
async fn listen(connection: &Connection, heard: &mpsc::Sender<(FromClient, Instant)>) {
    while let Ok(Ok(datagram)) = timeout(SILENCE, connection.receive_datagram()).await {
        let Some(message) = FromClient::read(&datagram) else { break };
        if heard.send((message, Instant::now())).is_err() {
            break;
        }
    }
    connection.close(VarInt::from_u32(0), b"");
}

/// Sends frames to a client.
pub struct Frames {
    runtime: Handle,
    connection: Connection,
    /// The number of the oldest frame that is still needed.
    oldest: watch::Sender<u32>,
}

impl Frames {
    /// Creates a sender on a connection, using the runtime in which this is called.
    fn new(connection: Connection) -> Frames {
        Frames { runtime: Handle::current(), connection, oldest: watch::Sender::new(0) }
    }

    /// Sends a frame on a stream of its own.
    pub fn send(&self, number: u32, bytes: Vec<u8>) {
        let (connection, oldest) = (self.connection.clone(), self.oldest.subscribe());
        self.runtime.spawn(async move {
            if let Err(error) = send(&connection, number, &bytes, oldest).await {
                log::debug!("frame {number} is not sent: {error}");
            }
        });
    }

    /// Stops sending the frames before this one.
    pub fn give_up(&self, number: u32) {
        self.oldest.send_replace(number);
    }

    /// Closes the connection.
    pub fn close(&self) {
        self.connection.close(VarInt::from_u32(0), b"");
    }
}

/// Sends a frame, unless it is given up before it has arrived completely.
async fn send(
    connection: &Connection,
    number: u32,
    bytes: &[u8],
    mut oldest: watch::Receiver<u32>,
) -> anyhow::Result<()> {
    let mut stream = connection.open_uni().await?.await?;
    // Earlier frames have priority, because this one refers to them.
    stream.set_priority(i32::MAX - (number % (1 << 30)) as i32);
    let sending = async {
        stream.write_all(bytes).await?;
        stream.finish().await
    };
    tokio::select! {
        sent = sending => sent.context("the client is gone"),
        _ = oldest.wait_for(|oldest| *oldest > number) => Ok(stream.reset(VarInt::from_u32(0))?),
    }
}
