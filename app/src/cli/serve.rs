//! `yoro serve`: a scene rendered here, seen in a browser.

use std::io::{self, Write as _};
use std::net::{Ipv4Addr, Shutdown, TcpListener, TcpStream};
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{self, Receiver, RecvTimeoutError};
use std::thread;
use std::time::{Duration, Instant};

use anyhow::{Context as _, bail, ensure};
use tungstenite::handshake::derive_accept_key;
use tungstenite::protocol::{Role, WebSocketConfig};
use tungstenite::{Message, WebSocket};

use crate::cli::Subcommand;
use crate::cli::args::GlArgs;
use crate::cli::eyes;
use crate::cli::outputs::Files;
use crate::cli::settings::{Renderer, SettingOptions};
use yoro::eyes::Pose;
use yoro_files::http::{self, Request};
use yoro_files::interrupt;
use yoro_lab::streaming::{Mode, Stage};
use yoro_render::PreparedScene;
use yoro_stream::{Control, FrameHeader, FromServer, FromViewer, Refusal, Token, VERSION, Wish};
use yoro_video::LiveEncoder;

/// A viewer that says nothing for so long is gone.
const SILENCE: Duration = Duration::from_secs(3);
/// A message of a viewer has no more bytes.
const MOST_BYTES: usize = 1 << 12;

/// Stream a scene, rendered on this machine, to a browser that shows both eyes at the head's newest pose
#[derive(clap::Args, Clone, Debug)]
pub struct ServeArgs {
    /// A built-in scene (see `yoro scenes`), or an OBJ, glTF or GLB file
    scene: String,
    /// Number of the scene's viewpoint, from 0
    #[arg(long, default_value_t = 0, value_name = "N")]
    pose: usize,
    /// What is sent
    #[arg(long, value_enum, default_value = "depth")]
    mode: ModeArg,
    /// H.264's quantizer, 12 (best) to 44; it grows where the connection is too slow
    #[arg(long, default_value_t = 24, value_name = "QP", value_parser = clap::value_parser!(u8).range(12..=44))]
    quantizer: u8,
    /// Most frames a second
    #[arg(long, default_value_t = 60, value_name = "HZ", value_parser = clap::value_parser!(u16).range(1..=240))]
    frame_rate: u16,
    /// Most pixels of an eye's longer side
    #[arg(long, default_value_t = 1024, value_name = "N", value_parser = clap::value_parser!(u16).range(64..=1400))]
    max_size: u16,
    /// The port; 0 for a free one
    #[arg(long, default_value_t = 8080)]
    port: u16,
    /// The folder of the built page [default: the one beside the program's]
    #[arg(long, value_name = "FOLDER")]
    page: Option<PathBuf>,
    #[command(flatten)]
    renderer: SettingOptions<Renderer>,
    #[command(flatten)]
    gl: GlArgs,
}

#[derive(Clone, Copy, Debug, clap::ValueEnum)]
enum ModeArg {
    /// One eye and its depth, of which both eyes are made
    Depth,
    /// Both eyes, corrected by rotation alone
    Eyes,
}

impl Subcommand for ServeArgs {
    fn files(&self) -> anyhow::Result<Files> {
        let mut files = Files::default();
        files.read([&self.scene]);
        Ok(files)
    }

    fn run(&self) -> anyhow::Result<()> {
        run(self)
    }
}

fn run(args: &ServeArgs) -> anyhow::Result<()> {
    let settings = args.renderer.render_settings()?;
    let scene = yoro_scenes::load(&args.scene, yoro_scenes::DEFAULT_SEED, None)?;
    let home = eyes::scene_pose(&scene, args.pose)?;
    let folder = match &args.page {
        Some(folder) => folder.clone(),
        None => std::env::current_exe()?.ancestors().nth(2).unwrap_or("".as_ref()).join("web"),
    };
    ensure!(
        folder.join("index.html").is_file(),
        "{} has no page: run cargo xtask web, or name its folder with --page",
        folder.display()
    );
    let headless = args.gl.open()?;
    let mode = match args.mode {
        ModeArg::Depth => Mode::Depth,
        ModeArg::Eyes => Mode::Eyes,
    };
    let mut server = Server {
        prepared: PreparedScene::new(headless.gl(), scene, &settings)?,
        stage: Stage::new(headless.gl(), mode)?,
        encoder: LiveEncoder::new(args.frame_rate.into())?,
        start: Instant::now(),
        args: args.clone(),
    };
    let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, args.port))
        .with_context(|| format!("port {} cannot be served: name another one with --port", args.port))?;
    let port = listener.local_addr()?.port();
    let mut token = Token::default();
    std::fs::File::open("/dev/urandom")
        .and_then(|mut random| io::Read::read_exact(&mut random, &mut token))
        .context("/dev/urandom gives no random numbers")?;
    let (clients, admitted) = mpsc::channel();
    let access = Arc::new(Access {
        token,
        hosts: ["localhost", "127.0.0.1"].map(|name| format!("{name}:{port}")),
        folder,
        home,
        busy: AtomicBool::new(false),
    });
    println!(
        "open http://localhost:{port}/#stream={:032x}&display=side-by-side\n\
         on a phone by cable: adb reverse tcp:{port} tcp:{port}, then the same address there\n\
         until Ctrl-C",
        u128::from_be_bytes(token)
    );
    io::stdout().flush()?;
    let opener = access.clone();
    thread::spawn(move || {
        for stream in listener.incoming().flatten() {
            let (access, clients) = (opener.clone(), clients.clone());
            // A browser keeps some connections open without asking for anything.
            thread::spawn(move || {
                if let Err(error) = access.admit(stream, &clients) {
                    log::info!("a client is not served: {error}");
                }
            });
        }
    });
    server.serve(&admitted, &access)
}

/// Admits clients: pages of this server that have the token, one at a time.
struct Access {
    token: Token,
    /// The names of this server, as browsers call it.
    hosts: [String; 2],
    folder: PathBuf,
    /// The head's first pose.
    home: Pose,
    busy: AtomicBool,
}

impl Access {
    /// Answers a connection: with a file, or, for a page of this server with the token, by letting it in.
    fn admit(&self, stream: TcpStream, clients: &mpsc::Sender<TcpStream>) -> anyhow::Result<()> {
        let request = Request::read(&stream)?;
        if request.target() != Some("/stream") {
            return Ok(http::answer(&stream, &request, &self.folder)?);
        }
        let host = request.header("host").unwrap_or_default();
        // Any page may open a connection to here, also one whose name leads here.
        let own = self.hosts.iter().any(|name| name == host)
            && request.header("origin") == Some(&format!("http://{host}"));
        let key = request.header("sec-websocket-key").filter(|_| own);
        let Some(key) = key else {
            (&stream)
                .write_all(b"HTTP/1.1 403 Forbidden\r\nContent-Length: 0\r\nConnection: close\r\n\r\n")?;
            bail!("it is another site's page");
        };
        write!(
            &stream,
            "HTTP/1.1 101 Switching Protocols\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n\
             Sec-WebSocket-Accept: {}\r\n\r\n",
            derive_accept_key(key.as_bytes())
        )?;
        stream.set_nodelay(true)?;
        let mut socket = web_socket(stream);
        let Some(FromViewer::Hello { version, token }) = FromViewer::read(&socket.read()?.into_data()) else {
            bail!("it does not say hello");
        };
        // Takes as long wherever they differ.
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
        let welcomed = socket.send(Message::binary(FromServer::Welcome(self.home).to_bytes()));
        if welcomed.is_err() || clients.send(socket.into_inner()).is_err() {
            self.busy.store(false, Ordering::SeqCst);
        }
        Ok(welcomed?)
    }
}

/// Speaks WebSocket on a connection whose handshake is done.
fn web_socket(stream: TcpStream) -> WebSocket<TcpStream> {
    let limits =
        WebSocketConfig::default().max_message_size(Some(MOST_BYTES)).max_frame_size(Some(MOST_BYTES));
    WebSocket::from_raw_socket(stream, Role::Server, Some(limits))
}

/// Passes on what a viewer says, with the time, until it is silent, gone, or says what no viewer says: messages wait for no frame
/// that is being rendered.
fn listen(mut socket: WebSocket<TcpStream>, heard: &mpsc::Sender<(FromViewer, Instant)>) {
    while let Ok(message) = socket.read() {
        let Some(message) = FromViewer::read(&message.into_data()) else { return };
        if heard.send((message, Instant::now())).is_err() {
            return;
        }
    }
}

/// Renders, codes and sends.
struct Server {
    prepared: PreparedScene,
    stage: Stage,
    encoder: LiveEncoder,
    start: Instant,
    args: ServeArgs,
}

impl Server {
    /// Serves one viewer after the other until Ctrl-C.
    fn serve(&mut self, admitted: &Receiver<TcpStream>, access: &Access) -> anyhow::Result<()> {
        loop {
            interrupt::check()?;
            match admitted.recv_timeout(Duration::from_millis(100)) {
                Ok(socket) => {
                    println!("a viewer has come");
                    let ended = self.session(&socket);
                    // Its listener ends, too.
                    let _ = socket.shutdown(Shutdown::Both);
                    access.busy.store(false, Ordering::SeqCst);
                    interrupt::check()?;
                    println!(
                        "the viewer has gone{}",
                        ended.err().map_or(String::new(), |e| format!(": {e}"))
                    );
                }
                Err(RecvTimeoutError::Timeout) => {}
                Err(RecvTimeoutError::Disconnected) => bail!("the port is closed"),
            }
        }
    }

    /// Serves a viewer until it is gone, which is no error.
    fn session(&mut self, stream: &TcpStream) -> anyhow::Result<()> {
        let mut control = Control::new(self.args.quantizer, self.args.frame_rate.into());
        let (mut wish, mut answered, mut number): (Option<Wish>, f64, u32) = (None, f64::NAN, 0);
        let mut line = Line::new();
        stream.set_read_timeout(Some(SILENCE))?;
        stream.set_write_timeout(Some(SILENCE))?;
        let (tell, heard) = mpsc::channel();
        let listener = web_socket(stream.try_clone()?);
        thread::spawn(move || listen(listener, &tell));
        let mut socket = web_socket(stream.try_clone()?);
        loop {
            interrupt::check()?;
            match heard.recv_timeout(Duration::from_millis(1)) {
                Ok((message, at)) => {
                    match message {
                        FromViewer::Wish(newest) => wish = Some(newest),
                        FromViewer::Decoded(number) => control.decoded(number, at - self.start),
                        FromViewer::Hello { .. } => {}
                    }
                    continue;
                }
                Err(RecvTimeoutError::Timeout) => {}
                Err(RecvTimeoutError::Disconnected) => return Ok(()),
            }
            line.print(&control);
            let due = wish.filter(|wish| wish.time != answered && control.is_due(self.start.elapsed()));
            let Some(mut wish) = due else { continue };
            answered = wish.time;
            let longest = wish.size[0].max(wish.size[1]);
            if longest > self.args.max_size {
                let scale = f32::from(self.args.max_size) / f32::from(longest);
                wish.size = wish.size.map(|side| ((f32::from(side) * scale) as u16).max(16));
            }
            let begun = Instant::now();
            self.prepared.set_time(self.start.elapsed().as_secs_f64())?;
            let picture = self.stage.picture(&mut self.prepared, &wish)?;
            let rendered = begun.elapsed();
            let quantizer = control.quantizer();
            let (data, is_intra) =
                self.encoder.encode(&picture.planes, quantizer, number == 0 || picture.new_span)?;
            let ms = |time: Duration| time.as_secs_f32() * 1e3;
            let header = FrameHeader {
                time: wish.time,
                content: picture.content,
                size: picture.size,
                render_ms: ms(rendered),
                code_ms: ms(begun.elapsed() - rendered),
                quantizer,
            };
            let frame = FromServer::Frame { number, intra: is_intra, header, data: &data };
            control.sent(number, self.start.elapsed());
            socket.send(Message::binary(frame.to_bytes()))?;
            line.add(data.len(), &header);
            number = number.wrapping_add(1);
        }
    }
}

/// The line of figures, once a second.
struct Line {
    since: Instant,
    frames: u32,
    bytes: usize,
    render_ms: f32,
    code_ms: f32,
}

impl Line {
    fn new() -> Line {
        Line { since: Instant::now(), frames: 0, bytes: 0, render_ms: 0.0, code_ms: 0.0 }
    }

    fn add(&mut self, bytes: usize, header: &FrameHeader) {
        self.frames += 1;
        self.bytes += bytes;
        self.render_ms += header.render_ms;
        self.code_ms += header.code_ms;
    }

    fn print(&mut self, control: &Control) {
        let seconds = self.since.elapsed().as_secs_f32();
        if seconds < 1.0 {
            return;
        }
        if self.frames > 0 {
            let frames = self.frames as f32;
            println!(
                "{:.0} frames/s, {:.2} Mbit/s, quantizer {}, render {:.1} ms, code {:.1} ms, sent and decoded {}",
                frames / seconds,
                self.bytes as f32 * 8e-6 / seconds,
                control.quantizer(),
                self.render_ms / frames,
                self.code_ms / frames,
                control.round_trip().map_or("never".into(), |time| format!("after {} ms", time.as_millis()))
            );
        }
        *self = Line::new();
    }
}
