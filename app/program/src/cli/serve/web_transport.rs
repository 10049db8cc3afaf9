//! WebTransport over QUIC: a stream for each frame to the client, and datagrams for the client's messages.

use std::net::UdpSocket;
use std::sync::{Arc, mpsc};
use std::time::Instant;

use anyhow::{Context as _, bail};
use tokio::io::AsyncReadExt as _;
use tokio::runtime::Handle;
use tokio::sync::watch;
use tokio::time::timeout;
use wtransport::config::QuicTransportConfig;
use wtransport::endpoint::IncomingSession;
use wtransport::endpoint::endpoint_side::Server;
use wtransport::{Connection, Endpoint, ServerConfig, VarInt};

use super::client::{HELLO_TIMEOUT, Lobby, MAX_MESSAGE_BYTES, SILENCE, Seat, Transport};
use yoro_stream::FromClient;

/// Listens on a socket, in the runtime in which this is called.
///
/// # Errors
/// If the system refuses.
pub fn listen(socket: UdpSocket, tls: rustls::ServerConfig) -> anyhow::Result<Endpoint<Server>> {
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
    Ok(Endpoint::server(config)?)
}

/// Accepts connections forever.
pub async fn accept(endpoint: &Endpoint<Server>, lobby: &Arc<Lobby>) {
    loop {
        let incoming = endpoint.accept().await;
        let address = incoming.remote_address();
        if !incoming.remote_address_validated() {
            // A forged sender address gets no more than a packet.
            incoming.retry();
            continue;
        }
        let lobby = lobby.clone();
        tokio::spawn(async move {
            let admitted = timeout(HELLO_TIMEOUT, admit(incoming, &lobby)).await;
            match admitted.map_err(anyhow::Error::from).flatten() {
                Ok((connection, seat)) => {
                    let heard = lobby.admit(Box::new(Frames::new(connection.clone())), seat);
                    hear(&connection, &heard).await;
                }
                Err(error) => log::info!("{address} is not served: {error}"),
            }
        });
    }
}

/// Admits a client if it may connect. Its hello and the answer have a stream of their own.
async fn admit(incoming: IncomingSession, lobby: &Lobby) -> anyhow::Result<(Connection, Seat)> {
    let request = incoming.await?;
    if request.path() != "/stream" || !lobby.access.allows(request.authority(), request.origin()) {
        request.forbidden().await;
        bail!("it is another site's page");
    }
    let connection = request.accept().await?;
    let (mut answers, hello) = connection.accept_bi().await?;
    let mut bytes = Vec::new();
    hello.take(MAX_MESSAGE_BYTES as u64).read_to_end(&mut bytes).await?;
    let (answer, seat) = lobby.answer(&bytes)?;
    answers.write_all(&answer).await?;
    answers.finish().await?;
    match seat {
        Ok(seat) => Ok((connection, seat)),
        Err(refusal) => bail!("{refusal:?}"),
    }
}

/// Passes on a client's messages with their times of arrival, until it is silent or lost, or sends anything else.
async fn hear(connection: &Connection, heard: &mpsc::Sender<(FromClient, Instant)>) {
    while let Ok(Ok(datagram)) = timeout(SILENCE, connection.receive_datagram()).await {
        let Some(message) = FromClient::read(&datagram) else { break };
        if heard.send((message, Instant::now())).is_err() {
            break;
        }
    }
    connection.close(VarInt::from_u32(0), b"");
}

/// Sends frames to a client, each on a stream of its own.
struct Frames {
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
}

impl Transport for Frames {
    fn name(&self) -> &'static str {
        "WebTransport"
    }

    fn send(&self, number: u32, bytes: Vec<u8>) -> anyhow::Result<()> {
        let (connection, oldest) = (self.connection.clone(), self.oldest.subscribe());
        self.runtime.spawn(async move {
            if let Err(error) = send(&connection, number, &bytes, oldest).await {
                log::debug!("frame {number} is not sent: {error}");
            }
        });
        Ok(())
    }

    fn can_give_up(&self) -> bool {
        true
    }

    fn give_up(&self, number: u32) {
        self.oldest.send_replace(number);
    }
}

impl Drop for Frames {
    fn drop(&mut self) {
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
