//! `yoro serve`: streams a scene that is rendered here, or a video, to a browser.

mod access;
mod client;
mod lan;
mod session;
mod source;
mod web_server;
mod web_socket;

use std::io::{self, IsTerminal as _, Write as _};
use std::net::{IpAddr, Ipv4Addr, SocketAddr, TcpListener};
use std::path::{Path, PathBuf};
use std::rc::Rc;
use std::sync::Arc;
use std::thread;
use std::time::Instant;

use anyhow::{Context as _, anyhow, ensure};
use tokio::runtime;

use self::access::Access;
use self::client::Lobby;
use self::lan::Lan;
use self::session::{Limits, Server};
use self::source::{Source, Video};
use self::web_server::WebServer;
use crate::cli::Subcommand;
use crate::cli::args::{self, GlArgs};
use crate::cli::eyes;
use crate::cli::settings::{Renderer, SettingOptions};
use yoro_gl::Context;
use yoro_media::video::LiveEncoder;
use yoro_render::PreparedScene;
use yoro_stream::{FrameRenderer, FromServer, Mode, Token};

/// Stream a scene, rendered on this machine, or an RGBD video to a browser that shows both eyes at the head's newest
/// pose
#[derive(clap::Args, Clone, Debug)]
pub struct ServeArgs {
    /// A built-in scene (see `yoro scenes`), an OBJ, glTF or GLB file, or an RGBD video (MP4), which is played over and
    /// over
    scene: String,
    /// Number of the scene's viewpoint, from 0
    #[arg(long, default_value_t = 0, value_parser = args::whole::<usize>(0..=usize::MAX), value_name = "N")]
    pose: usize,
    /// What is sent
    #[arg(long, value_enum, default_value = "depth")]
    mode: ModeArg,
    /// H.264's quantizer, 12 (best) to 44; it grows where the connection is too slow
    #[arg(long, default_value_t = 24, value_name = "QP", value_parser = args::whole::<u8>(12..=44))]
    quantizer: u8,
    /// The largest number of frames per second
    #[arg(long, default_value_t = 60, value_name = "HZ", value_parser = args::whole::<u16>(1..=240))]
    frame_rate: u16,
    /// The largest length of an eye's longer side in pixels
    #[arg(long, default_value_t = 1024, value_name = "N", value_parser = args::whole::<u16>(64..=1400))]
    max_size: u16,
    /// Serve to the local network by https, at this address of this machine [default: the one by which it reaches
    /// others]
    #[arg(long, value_name = "ADDRESS", num_args = 0..=1, require_equals = true, value_parser = address)]
    #[expect(clippy::option_option, reason = "clap's form of an option whose value may be left out")]
    lan: Option<Option<IpAddr>>,
    /// The port; 0 for a free one
    #[arg(long, default_value_t = 8080, value_parser = args::whole::<u16>(0..=u16::MAX), value_name = "N")]
    port: u16,
    /// The folder of the built page [default: the one beside the program's]
    #[arg(long, value_name = "FOLDER")]
    page: Option<PathBuf>,
    #[command(flatten)]
    renderer: SettingOptions<Renderer>,
    #[command(flatten)]
    gl: GlArgs,
}

#[derive(Clone, Copy, Debug, PartialEq, clap::ValueEnum)]
enum ModeArg {
    /// One eye and its depth, from which both eyes are made
    Depth,
    /// Both eyes, corrected by rotation alone
    Eyes,
}

impl Subcommand for ServeArgs {
    fn run(&self) -> anyhow::Result<()> {
        let folder = match &self.page {
            Some(folder) => folder.clone(),
            None => std::env::current_exe()?.ancestors().nth(2).unwrap_or("".as_ref()).join("web"),
        };
        ensure!(
            folder.join("index.html").is_file(),
            "{} has no page: run cargo xtask web, or name its folder with --page",
            folder.display()
        );
        let encoder = LiveEncoder::new(self.frame_rate.into())?;
        let lan = self.lan.map(Lan::new).transpose()?;
        // The context is declared first, so that it is dropped after everything created in it.
        let headless;
        let (source, welcome) = if is_video(&self.scene) {
            ensure!(self.mode == ModeArg::Depth, "a video has the depth of one eye: leave --mode out");
            let (video, welcome) = Video::open(self.scene.as_ref())?;
            (Source::Video(Box::new(video)), welcome)
        } else {
            headless = self.gl.open()?;
            scene(self, headless.gl())?
        };
        let mut server = Server {
            source,
            encoder,
            start: Instant::now(),
            limits: Limits {
                quantizer: self.quantizer,
                frame_rate: self.frame_rate.into(),
                size: self.max_size,
            },
        };
        let address = lan.as_ref().map_or(Ipv4Addr::LOCALHOST.into(), |lan| lan.address);
        let place = SocketAddr::new(address, self.port);
        let listener = TcpListener::bind(place).map_err(|error| refusal(place, &error))?;
        let port = listener.local_addr()?.port();
        let token = random_token()?;
        let (scheme, hosts) = match &lan {
            Some(lan) => ("https", vec![SocketAddr::new(lan.address, port).to_string()]),
            // The link has the address, since what listens at another address of the name localhost, such as ::1, would
            // get the token. The name is for cables, which end there.
            None => ("http", ["127.0.0.1", "localhost"].map(|name| format!("{name}:{port}")).to_vec()),
        };
        let hosts: Vec<String> = hosts.iter().map(|host| access::host(scheme, host).to_owned()).collect();
        let token_text = format!("{:032x}", u128::from_be_bytes(token));
        let link = format!("{scheme}://{}/#stream={token_text}&display=side-by-side", hosts[0]);
        announce(&link, port, lan.as_ref())?;
        let access = Access { token, scheme, hosts };
        let (lobby, clients) = Lobby::new(access, &welcome);
        let tls = lan.map(|lan| lan.tls.into());
        connect(listener, WebServer { lobby, folder, tls })?;
        server.serve(&clients)
    }
}

/// Serves all connections on a thread of their own.
fn connect(listener: TcpListener, server: WebServer) -> anyhow::Result<()> {
    let runtime = runtime::Builder::new_current_thread().enable_all().build()?;
    let inside = runtime.enter();
    listener.set_nonblocking(true)?;
    let listener = tokio::net::TcpListener::from_std(listener)?;
    drop(inside);
    thread::spawn(move || runtime.block_on(Arc::new(server).accept(listener)));
    Ok(())
}

/// Returns the sentence for an address that cannot be listened on.
fn refusal(place: SocketAddr, error: &io::Error) -> anyhow::Error {
    match error.kind() {
        io::ErrorKind::AddrNotAvailable => {
            anyhow!("{} is not an address of this machine: name one that is with --lan=ADDRESS", place.ip())
        }
        io::ErrorKind::PermissionDenied => {
            anyhow!("port {} needs more rights: name one above 1023 with --port", place.port())
        }
        io::ErrorKind::AddrInUse => anyhow!("{place} is in use: name another port with --port"),
        _ => anyhow!("{place} cannot be served ({error}): name another port with --port"),
    }
}

fn random_token() -> anyhow::Result<Token> {
    let mut token = Token::default();
    std::fs::File::open("/dev/urandom")
        .and_then(|mut random| io::Read::read_exact(&mut random, &mut token))
        .context("/dev/urandom gives no random numbers")?;
    Ok(token)
}

/// Parses an address of this machine.
fn address(text: &str) -> Result<IpAddr, String> {
    text.parse().map_err(|_| "give an address of this machine, such as 192.168.1.20".into())
}

/// True if the name is that of a video file.
fn is_video(name: &str) -> bool {
    let extension = Path::new(name).extension();
    extension.is_some_and(|extension| {
        ["mp4", "m4v", "mov"].iter().any(|video| extension.eq_ignore_ascii_case(video))
    })
}

/// Prepares a scene. Returns it with the first message to a page that shows it.
fn scene(args: &ServeArgs, gl: &Rc<Context>) -> anyhow::Result<(Source, FromServer<'static>)> {
    let mode = match args.mode {
        ModeArg::Depth => Mode::Depth,
        ModeArg::Eyes => Mode::Eyes,
    };
    let settings = args.renderer.render_settings();
    let scene = yoro_scenes::load(&args.scene, yoro_scenes::DEFAULT_SEED, None)?;
    let home = eyes::scene_pose(&scene, args.pose)?;
    let prepared = Box::new(PreparedScene::new(gl, scene, &settings)?);
    let renderer = Box::new(FrameRenderer::new(gl, mode)?);
    Ok((Source::Scene { prepared, renderer }, FromServer::Welcome(home)))
}

/// Prints where the stream can be seen.
fn announce(link: &str, port: u16, lan: Option<&Lan>) -> anyhow::Result<()> {
    println!("open {link}");
    match lan {
        Some(lan) => {
            if io::stdout().is_terminal() {
                print!("{}", lan::code(link)?);
            }
            println!(
                "a browser that has not been here warns that it does not know the certificate, with SHA-256\n{}\n\
                 docs/streaming.md says what to do then, and what it protects from",
                lan.fingerprint
            );
        }
        None => println!(
            "on a phone by cable: adb reverse tcp:{port} tcp:{port}, then the same address there; by Wi-Fi: --lan"
        ),
    }
    println!("it is served until Ctrl-C");
    Ok(io::stdout().flush()?)
}
