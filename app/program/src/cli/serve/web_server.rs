//! HTTP, encrypted or not: the page's files, and the way to its WebSocket. Connections have little time.

use std::convert::Infallible;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;

use futures_util::stream;
use http_body_util::combinators::UnsyncBoxBody;
use http_body_util::{BodyExt as _, Full, StreamBody};
use hyper::body::{Bytes, Frame, Incoming};
use hyper::header::{self, HeaderMap, HeaderName, HeaderValue};
use hyper::server::conn::http1;
use hyper::service::service_fn;
use hyper::{Method, Request, Response, StatusCode};
use hyper_util::rt::{TokioIo, TokioTimer};
use tokio::fs::File;
use tokio::io::{AsyncRead, AsyncReadExt as _, AsyncWrite};
use tokio::net::{TcpListener, TcpStream};
use tokio::time::{Instant, sleep, timeout_at};
use tokio_rustls::TlsAcceptor;

use super::client::{HELLO_TIMEOUT, Lobby};
use super::web_socket;
use yoro_files::http;

/// The time allowed for sending a file.
const FILE_TIMEOUT: Duration = Duration::from_secs(60);
/// The pause after a connection that could not be accepted.
const ACCEPT_PAUSE: Duration = Duration::from_millis(200);
/// The largest size of a request's headers in bytes.
const MAX_HEADERS: usize = 64 << 10;
/// The size of the pieces in which a file is sent, in bytes.
const PIECE: usize = 64 << 10;

type Body = UnsyncBoxBody<Bytes, io::Error>;

/// Serves a page, and the stream to it.
pub struct WebServer {
    pub lobby: Arc<Lobby>,
    /// The folder of the page's files.
    pub folder: PathBuf,
    /// The encryption of connections, if any.
    pub tls: Option<TlsAcceptor>,
}

impl WebServer {
    /// Accepts connections forever.
    pub async fn accept(self: Arc<Self>, listener: TcpListener) {
        loop {
            let (socket, address) = match listener.accept().await {
                Ok(accepted) => accepted,
                Err(error) => {
                    // For example, no file descriptors are left: the next attempt would fail at once, too.
                    log::warn!("a connection is not accepted: {error}");
                    sleep(ACCEPT_PAUSE).await;
                    continue;
                }
            };
            let server = self.clone();
            tokio::spawn(async move {
                if let Err(error) = server.connect(socket).await {
                    log::info!("{address} is not served: {error}");
                }
            });
        }
    }

    async fn connect(self: Arc<Self>, socket: TcpStream) -> anyhow::Result<()> {
        let deadline = Instant::now() + HELLO_TIMEOUT;
        socket.set_nodelay(true)?;
        match self.tls.clone() {
            Some(tls) => {
                let encrypted = timeout_at(deadline, tls.accept(socket)).await??;
                self.serve(encrypted, deadline).await
            }
            None => self.serve(socket, deadline).await,
        }
    }

    /// Answers one request, which must arrive before the deadline.
    async fn serve(
        self: Arc<Self>,
        connection: impl AsyncRead + AsyncWrite + Unpin + Send + 'static,
        deadline: Instant,
    ) -> anyhow::Result<()> {
        let service = service_fn(move |request| {
            let server = self.clone();
            async move { Ok::<_, Infallible>(server.answer(request, deadline).await) }
        });
        let serving = http1::Builder::new()
            .timer(TokioTimer::new())
            .header_read_timeout(deadline.saturating_duration_since(Instant::now()))
            .keep_alive(false)
            .max_buf_size(MAX_HEADERS)
            .serve_connection(TokioIo::new(connection), service)
            .with_upgrades();
        Ok(timeout_at(deadline + FILE_TIMEOUT, serving).await??)
    }

    async fn answer(&self, request: Request<Incoming>, deadline: Instant) -> Response<Body> {
        if request.uri() != "/stream" {
            return file(&self.folder, &request).await;
        }
        let headers = request.headers();
        let host = only(headers, &header::HOST).unwrap_or_default();
        if !self.lobby.access.allows(host, only(headers, &header::ORIGIN)) {
            log::info!("another site's page is not served");
            return say(StatusCode::FORBIDDEN, "");
        }
        let body = || text("");
        web_socket::accept(request, body, self.lobby.clone(), deadline)
            .unwrap_or_else(|error| say(StatusCode::BAD_REQUEST, &format!("{error}\n")))
    }
}

/// Returns the value of a header that is there once.
fn only<'a>(headers: &'a HeaderMap, name: &HeaderName) -> Option<&'a str> {
    let mut values = headers.get_all(name).iter();
    values.next().filter(|_| values.next().is_none())?.to_str().ok()
}

fn text(text: &str) -> Body {
    Full::new(Bytes::copy_from_slice(text.as_bytes())).map_err(|never| match never {}).boxed_unsync()
}

fn say(status: StatusCode, sentence: &str) -> Response<Body> {
    let mut response = Response::new(text(sentence));
    *response.status_mut() = status;
    response.headers_mut().insert(header::CONTENT_TYPE, HeaderValue::from_static("text/plain"));
    response
}

/// Answers a request for a file in a folder.
async fn file(folder: &Path, request: &Request<Incoming>) -> Response<Body> {
    let path = match *request.method() {
        Method::GET | Method::HEAD => http::find(folder, request.uri().path()),
        _ => None,
    };
    let opened = async {
        let path = path?;
        let file = File::open(&path).await.ok()?;
        let length = file.metadata().await.ok().filter(std::fs::Metadata::is_file)?.len();
        Some((path, file, length))
    };
    let Some((path, file, length)) = opened.await else {
        return say(StatusCode::NOT_FOUND, "There is no such file.\n");
    };
    let pieces = stream::try_unfold(file.take(length), |mut file| async {
        let mut piece = Vec::with_capacity(PIECE);
        let read = file.read_buf(&mut piece).await?;
        Ok((read > 0).then(|| (Frame::data(piece.into()), file)))
    });
    let mut response = Response::new(StreamBody::new(pieces).boxed_unsync());
    let headers = response.headers_mut();
    headers.insert(header::CONTENT_TYPE, HeaderValue::from_static(http::kind(&path)));
    headers.insert(header::CONTENT_LENGTH, length.into());
    headers.insert(header::CACHE_CONTROL, HeaderValue::from_static("no-cache"));
    let policy = format!("{}; frame-ancestors 'none'", http::POLICY);
    if let Ok(policy) = policy.try_into() {
        headers.insert(header::CONTENT_SECURITY_POLICY, policy);
    }
    headers.insert(header::X_CONTENT_TYPE_OPTIONS, HeaderValue::from_static("nosniff"));
    headers.insert(header::REFERRER_POLICY, HeaderValue::from_static("no-referrer"));
    response
}
