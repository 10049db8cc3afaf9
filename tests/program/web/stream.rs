//! Streams from the program to the page.

use std::io::{BufRead as _, BufReader, Read, Write};
use std::net::{IpAddr, TcpListener, TcpStream, UdpSocket};
use std::path::Path;
use std::process::{Command, Stdio};
use std::sync::{Arc, mpsc};
use std::time::{Duration, Instant};

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use image::{RgbImage, imageops};
use rcgen::{KeyPair, PublicKeyData as _};
use rustls::pki_types::pem::PemObject as _;
use rustls::pki_types::{CertificateDer, ServerName};
use serde_json::json;
use tungstenite::handshake::derive_accept_key;
use tungstenite::protocol::Role;
use tungstenite::{Message, WebSocket};
use yoro::eyes::{Eye, EyePair, Frustum, Pose};
use yoro_bench::streaming::Receiver;
use yoro_context::{Backend, Headless};
use yoro_files::http::{self, Request};
use yoro_media::rgb_image;
use yoro_media::video::{LiveEncoder, Planes};
use yoro_metrics::{Channels, psnr};
use yoro_render::{PreparedScene, RenderSettings, ViewReader};
use yoro_stream::{
    Content, EyeView, FrameHeader, FrameRenderer, FromClient, FromServer, Mode, VERSION, ViewRequest,
};

use super::{GL, Page, Running, Server, difference, headset};
use crate::browser::Browser;
use crate::program::succeed;

/// So fine that a decoded picture is close to the uncoded one.
const QUANTIZER: &str = "12";
/// Length of a step of the head to the right, in metres.
const STEP: f32 = 0.02;

/// Returns the command `yoro serve`.
fn command(source: &str, frame_rate: u32, options: &[&str], home: Option<&Path>) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_yoro"));
    command.args(["serve", source, "--port", "0", "--max-size", "320", "--quantizer", QUANTIZER]);
    command.args(["--frame-rate", &frame_rate.to_string()]).args(options);
    home.map(|home| command.env("XDG_STATE_HOME", home));
    command
}

/// Runs `yoro serve` until the server is dropped. Returns the server and its link.
fn serve(frame_rate: u32, options: &[&str], home: Option<&Path>) -> (Server, String) {
    serve_source("prototype", frame_rate, options, home)
}

fn serve_source(source: &str, frame_rate: u32, options: &[&str], home: Option<&Path>) -> (Server, String) {
    let mut command = command(source, frame_rate, options, home);
    let mut child = command.stdin(Stdio::null()).stdout(Stdio::piped()).spawn().unwrap();
    let mut lines = BufReader::new(child.stdout.take().unwrap()).lines();
    let first = lines.next().expect("it says where it is").unwrap();
    std::thread::spawn(move || lines.for_each(drop));
    let link = first.strip_prefix("open ").expect("a link").to_owned();
    let address = link.split('#').next().unwrap().to_owned();
    (Server { child: Some(Running(child)), address, silent: None }, link)
}

/// Starts a server, opens its link, and waits for pictures. Returns `None` if the page or the browser is missing.
fn open(mode: &str) -> Option<(Page, String)> {
    // Prints a message if the page is missing.
    Server::start()?;
    let browser = Browser::start_with(&GL)?;
    let (server, link) = serve(5, &["--mode", mode], None);
    Some((follow(browser, server, &link), link))
}

/// Returns the token in a link.
fn token(link: &str) -> &str {
    link.split(['=', '&']).nth(1).unwrap()
}

/// Opens a server's link in a browser, and waits for pictures.
fn follow(mut browser: Browser, server: Server, link: &str) -> Page {
    browser.allow(&server.address);
    browser.allow(&server.address.replace("http", "ws"));
    browser.resize(640, 420);
    browser.go(link);
    let mut page = Page { browser, server };
    page.until("globalThis.yoro?.stream?.frames > 3");
    assert_eq!(page.message(), None);
    page
}

/// The desktop's side: a scene, and a viewer's view of its pictures.
struct Desktop {
    prepared: PreparedScene,
    renderer: FrameRenderer,
    receiver: Receiver,
    _headless: Headless,
}

impl Desktop {
    fn new(mode: Mode) -> Desktop {
        let headless = Headless::open(Backend::Egl).unwrap();
        let gl = headless.gl();
        let scene = yoro_scenes::build("prototype", yoro_scenes::DEFAULT_SEED).unwrap();
        Desktop {
            prepared: PreparedScene::new(gl, scene, &RenderSettings::default()).unwrap(),
            renderer: FrameRenderer::new(gl, mode).unwrap(),
            receiver: Receiver::new(gl).unwrap(),
            _headless: headless,
        }
    }

    /// Returns the eyes at the first pose and after a step, for this size in pixels.
    fn pairs(&self, size: [u32; 2]) -> [EyePair; 2] {
        let settings = yoro_web::Settings::default();
        let mut walker = yoro_web::Walker::new(self.prepared.scene.viewpoints[0].pose());
        let first = settings.pair(walker.pose(), size);
        walker.walk([STEP, 0.0, 0.0]);
        [first, settings.pair(walker.pose(), size)]
    }

    /// Returns how the picture of the first pair looks from the poses of both pairs.
    fn seen(&mut self, pairs: &[EyePair; 2]) -> [[RgbImage; 2]; 2] {
        let [first, _] = pairs;
        let eye_view =
            |eye: Eye| EyeView { pose: first.poses[eye.index()], frustum: first.frusta[eye.index()] };
        let eyes = Eye::BOTH.map(eye_view);
        let request =
            ViewRequest { time_ms: 0.0, eyes, dominant: first.dominant, size: first.size.map(|n| n as u16) };
        let picture = self.renderer.picture(&mut self.prepared, &request).unwrap();
        [0, 1]
            .map(|i| self.receiver.eyes(&picture.planes, &picture.content, picture.size, &pairs[i]).unwrap())
    }

    fn real(&mut self, pair: &EyePair, eye: Eye) -> RgbImage {
        let mut reader = ViewReader::new(self._headless.gl()).unwrap();
        let PreparedScene { scene, renderer } = &mut self.prepared;
        rgb_image(&reader.color(renderer, scene, &pair.view(eye)).unwrap(), pair.size)
    }
}

/// True if a decoded picture differs so little from the uncoded one. At this quantizer H.264 alone costs 1.0/255.
fn is_coded((ssim, mean): (f64, f64)) -> bool {
    ssim > 0.99 && mean < 1.5
}

/// Waits until a stream, which begins with coarse pictures, has fine ones, but not for long.
fn wait_until_fine(mut is_fine: impl FnMut() -> bool) {
    for _ in 0..100 {
        if is_fine() {
            return;
        }
        std::thread::sleep(Duration::from_millis(100));
    }
}

/// Checks that the page shows the same as the desktop, at the picture's pose and one step beside it.
fn check(page: &mut Page, desktop: &mut Desktop) -> [EyePair; 2] {
    let number =
        |page: &mut Page, side: &str| page.evaluate(&format!("yoro.canvas.{side}")).as_u64().unwrap() as u32;
    let size = [number(page, "width") / 2, number(page, "height")];
    let pairs = desktop.pairs(size);
    let [still, moved] = desktop.seen(&pairs);
    wait_until_fine(|| {
        let here = page.eyes(size);
        [0, 1].iter().all(|&eye| is_coded(difference(&here[eye], &still[eye])))
    });
    for (name, step, desktop) in [("still", 0.0, still), ("moved", STEP, moved)] {
        // Read immediately, before a picture of the new pose can arrive, then walk back.
        page.evaluate(&format!("yoro.page.walk({step}, 0, 0); 0"));
        let here = page.eyes(size);
        page.evaluate(&format!("yoro.page.walk(-{step}, 0, 0); 0"));
        for eye in Eye::BOTH {
            let found = difference(&here[eye.index()], &desktop[eye.index()]);
            assert!(is_coded(found), "{name}, {}: SSIM and mean difference {found:?}", eye.name());
        }
    }
    pairs
}

/// Requests the stream with these headers, and returns the beginning of the answer.
fn ask(mut connection: impl Read + Write, host: &str, headers: &str) -> String {
    let upgrade = "Connection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\n\
                   Sec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==";
    write!(connection, "GET /stream HTTP/1.1\r\nHost: {host}\r\n{headers}{upgrade}\r\n\r\n").unwrap();
    let mut answer = [0; 1000];
    let length = connection.read(&mut answer).unwrap();
    String::from_utf8_lossy(&answer[..length]).into_owned()
}

/// Sends a first message on a new connection, and returns the bytes of the answer.
fn knock(page: &mut Page, token: &str) -> serde_json::Value {
    page.evaluate(&format!(
        "new Promise((resolve) => {{ const s = new WebSocket(location.origin.replace('http', 'ws') + '/stream'); \
         s.binaryType = 'arraybuffer'; s.onopen = () => s.send(yoro.page.streamHello('{token}')); \
         s.onmessage = ({{ data }}) => resolve([...new Uint8Array(data)]); }})"
    ))
}

#[test]
fn a_stream_is_shown_at_the_newest_pose_to_one_page_with_the_token() {
    let Some((mut page, link)) = open("depth") else { return };
    let mut desktop = Desktop::new(Mode::Depth);
    let [pair, _] = check(&mut page, &mut desktop);

    let eyes = page.eyes(pair.size);
    let other = pair.dominant.other();
    let real = desktop.real(&pair, other);
    let of = |image| psnr(image, &real, Channels::Rgb).unwrap().0;
    let (made, same) = (of(&eyes[other.index()]), of(&eyes[pair.dominant.index()]));
    eprintln!("the other eye: {made:.2} dB, the same image to both eyes {same:.2} dB");
    assert!(made > 27.0 && made > same + 5.0, "{made} dB, same image {same} dB");

    let token = token(&link);
    assert_eq!(knock(&mut page, &"0".repeat(32)), json!([1, 0]), "another token");
    assert_eq!(knock(&mut page, token), json!([1, 1]), "another page is served");
    let host = page.server.address.trim_start_matches("http://").trim_end_matches('/').to_owned();
    for origin in ["Origin: http://elsewhere.example\r\n", ""] {
        let answer = ask(TcpStream::connect(&host).unwrap(), &host, origin);
        assert!(answer.starts_with("HTTP/1.1 403"), "{answer}");
    }

    lose(&mut page);
}

/// Loses the connection, which is restored, and then the server.
fn lose(page: &mut Page) {
    // The server drops a page that is silent for too long. The page reconnects.
    page.evaluate("yoro.stream.frames = 0; const end = Date.now() + 4000; while (Date.now() < end); 0");
    page.until("yoro.stream.losses === 1 && yoro.stream.there && yoro.stream.frames > 2");
    assert_eq!(page.message(), None);
    page.until("document.getElementById('facts').textContent.includes('corrected by 0.0 cm and 0.0°')");
    let corrected = format!(
        "yoro.page.streamCorrection(); yoro.page.walk({STEP}, 0, 0); yoro.page.turn(0.1, 0); yoro.page.draw(64, 48, 0); \
         yoro.page.turn(-0.1, 0); yoro.page.walk(-{STEP}, 0, 0); [...yoro.page.streamCorrection()].map((n) => n.toFixed(1))"
    );
    let corrected = page.evaluate(&corrected);
    // Turning the head also moves the eye, which is away from the neck's axis.
    let number = |i: usize| corrected[i].as_str().unwrap().parse::<f64>().unwrap();
    assert!((1.0..4.0).contains(&number(0)) && number(1) == 5.7, "{corrected}");

    // A hidden page disconnects, and reconnects when it is shown.
    let see = |page: &mut Page, hidden: bool| {
        page.evaluate(&format!(
            "Object.defineProperty(document, 'hidden', {{ value: {hidden}, configurable: true }}); \
             document.dispatchEvent(new Event('visibilitychange')); yoro.stream.frames = 0; 0"
        ));
    };
    see(page, true);
    page.until("yoro.stream.losses === 2 && !yoro.stream.there");
    see(page, false);
    page.until("yoro.stream.there && yoro.stream.frames > 2");
    assert_eq!(page.message(), None);
    page.browser.expect_silence();

    page.server.child = None;
    page.until("yoro.stream.there === false");
    assert!(page.message().unwrap().contains("lost"));
}

#[test]
fn two_eyes_are_turned_with_the_head() {
    let Some((mut page, _)) = open("eyes") else { return };
    check(&mut page, &mut Desktop::new(Mode::Eyes));
    page.browser.expect_silence();
}

#[test]
fn a_headset_shows_a_stream() {
    let Some(script) = headset::emulator() else { return };
    // Prints a message if the page is missing.
    let Some(_) = Server::start() else { return };
    let Some(mut browser) = Browser::start_with(&GL) else { return };
    browser.run_before_pages(&script);
    let (server, link) = serve(15, &[], None);
    let mut page = follow(browser, server, &link);
    page.browser.resize(400, 240);
    page.until("!document.getElementById('headset').disabled");
    page.evaluate("document.getElementById('headset').click()");
    // Pictures for the headset's own views have arrived.
    page.until("yoro.busy?.frames > 1");
    page.evaluate("yoro.stream.frames = 0; headset.controllers.right.updateButtonValue('thumbstick', 1); 0");
    page.until("yoro.stream.frames > 4");
    assert_eq!(page.message(), None);
    let (views, eyes) = headset::seen(&mut page);
    let real = headset::headset_pictures(&views, [eyes[0].width(), eyes[0].height()], "off");
    let of = |shown: usize, eye: usize| psnr(&eyes[shown], &real[eye], Channels::Luma).unwrap().0;
    let (left, right, same) = (of(0, 0), of(1, 1), of(1, 0));
    eprintln!("left {left:.2} dB, right {right:.2} dB, the same image to both eyes {same:.2} dB");
    assert!(
        right > 38.0 && left > 28.0 && left > same + 5.0,
        "left {left} dB, right {right} dB, same image {same} dB"
    );
    page.evaluate("document.getElementById('headset').click()");
    page.until("yoro.busy === null");
    page.until("yoro.stream.there");
    page.browser.expect_silence();
}

#[test]
fn a_video_is_streamed_whole() {
    // Prints a message if the page is missing.
    let Some(_) = Server::start() else { return };
    let Some(browser) = Browser::start_with(&GL) else { return };
    let dir = tempfile::tempdir().unwrap();
    succeed(
        dir.path(),
        "render prototype --frames 2 --size 192x128 --video v.mp4 --frame-rate 4 --quantizer 16",
    );
    let path = dir.path().join("v.mp4");
    let (server, link) = serve_source(path.to_str().unwrap(), 5, &[], None);
    let mut page = follow(browser, server, &link);
    let inner = |image: &RgbImage| imageops::crop_imm(image, 4, 4, 184, 120).to_image();
    let mut frames = Vec::new();
    let mut reader = yoro_media::video::Reader::open(&path).unwrap();
    while let Some((color, _)) = reader.read_rgbd().unwrap() {
        // The additional columns are on the left.
        frames.push(inner(&imageops::crop_imm(&color, color.width() - 192, 0, 192, 128).to_image()));
    }
    let mut best = 0.0f64;
    wait_until_fine(|| {
        let [_, right] = page.eyes([192, 128]);
        let of = |frame: &RgbImage| psnr(&inner(&right), frame, Channels::Rgb).unwrap().0;
        best = frames.iter().map(of).fold(best, f64::max);
        best > 40.0
    });
    assert!(best > 40.0, "{best} dB");
    page.browser.expect_silence();
}

#[test]
fn the_local_network_is_served_by_https_with_a_certificate_for_the_address() {
    // Prints a message if the page is missing.
    let Some(_) = Server::start() else { return };
    let home = tempfile::tempdir().unwrap();
    let (server, link) = serve(5, &["--lan=127.0.0.2"], Some(home.path()));
    let host = server.address.strip_prefix("https://").expect("https").trim_end_matches('/').to_owned();
    let port: u16 = host.strip_prefix("127.0.0.2:").expect("the address").parse().unwrap();
    assert!(
        TcpStream::connect(("127.0.0.1", port)).is_err(),
        "it listens on the address that it prints alone"
    );

    // A client that connects and sends nothing is dropped.
    let mut idle = TcpStream::connect(&host).unwrap();
    let answer = ask(TcpStream::connect(&host).unwrap(), &host, "");
    assert!(!answer.starts_with("HTTP"), "without encryption: {answer}");

    // A strict client, which trusts only this certificate.
    let pem = std::fs::read(home.path().join("yoro/serve/127.0.0.2.pem")).unwrap();
    let mut roots = rustls::RootCertStore::empty();
    roots.add(CertificateDer::from_pem_slice(&pem).unwrap()).unwrap();
    let provider = Arc::new(rustls::crypto::ring::default_provider());
    let config = rustls::ClientConfig::builder_with_provider(provider)
        .with_safe_default_protocol_versions()
        .unwrap()
        .with_root_certificates(roots)
        .with_no_client_auth();
    let config = Arc::new(config);
    let connect = |name: &'static str| {
        let name = ServerName::try_from(name).unwrap();
        let client = rustls::ClientConnection::new(config.clone(), name).unwrap();
        rustls::StreamOwned::new(client, TcpStream::connect(&host).unwrap())
    };
    let answer = ask(connect("127.0.0.2"), &host, &format!("Origin: https://{host}\r\n"));
    assert!(answer.starts_with("HTTP/1.1 101"), "{answer}");
    for origin in
        [format!("http://{host}"), format!("https://127.0.0.1:{port}"), "https://elsewhere.example".into()]
    {
        let answer = ask(connect("127.0.0.2"), &host, &format!("Origin: {origin}\r\n"));
        assert!(answer.starts_with("HTTP/1.1 403"), "{origin}: {answer}");
    }
    let other = ask(connect("127.0.0.2"), "elsewhere.example", "Origin: https://elsewhere.example\r\n");
    assert!(other.starts_with("HTTP/1.1 403"), "another name that leads here: {other}");
    let mut elsewhere = connect("127.0.0.1");
    assert!(
        elsewhere.write_all(b"GET / HTTP/1.1\r\n\r\n").is_err(),
        "the certificate is for another address"
    );

    // A browser whose user has accepted the certificate.
    let key = KeyPair::from_pem(&String::from_utf8(pem).unwrap()).unwrap();
    let spki = ring::digest::digest(&ring::digest::SHA256, &key.subject_public_key_info());
    let accepted = format!("--ignore-certificate-errors-spki-list={}", STANDARD.encode(spki));
    let options: Vec<&str> = GL.into_iter().chain([&*accepted]).collect();
    let Some(browser) = Browser::start_with(&options) else { return };
    let mut page = follow(browser, server, &link);
    assert_eq!(page.evaluate("[location.protocol, isSecureContext]"), json!(["https:", true]));
    let token = token(&link);
    assert_eq!(knock(&mut page, &"0".repeat(32)), json!([1, 0]), "another token");
    assert_eq!(knock(&mut page, token), json!([1, 1]), "another page is served");
    check(&mut page, &mut Desktop::new(Mode::Depth));

    idle.set_read_timeout(Some(Duration::from_secs(20))).unwrap();
    assert_eq!(idle.read(&mut [0]).unwrap(), 0, "it is left after ten seconds");
}

#[test]
fn without_an_address_the_one_by_which_others_are_reached_is_served() {
    // Prints a message if the page is missing.
    let Some(_) = Server::start() else { return };
    let socket = UdpSocket::bind("0.0.0.0:0").unwrap();
    let own = socket.connect("192.0.2.1:9").and_then(|()| socket.local_addr());
    let Ok(IpAddr::V4(own)) = own.map(|own| own.ip()) else {
        eprintln!("SKIPPED: this machine is in no network");
        return;
    };
    let home = tempfile::tempdir().unwrap();
    if !own.is_private() {
        let output = command("prototype", 5, &["--lan"], Some(home.path())).output().unwrap();
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(
            !output.status.success() && said.contains(&format!("{own} is open to the internet")),
            "{said}"
        );
        return;
    }
    let (server, link) = serve(5, &["--lan"], Some(home.path()));
    assert!(link.starts_with(&format!("https://{own}:")), "{link}");
    let host = server.address.strip_prefix("https://").unwrap().trim_end_matches('/');
    let answer = ask(TcpStream::connect(host).unwrap(), host, "");
    assert!(!answer.starts_with("HTTP"), "without encryption: {answer}");
}

/// What a client has said, but for requests and what it repeats.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Said {
    Hello,
    Decoded(u32),
}

/// Answers like `yoro serve`, but sends invalid H.264 after frame 1. Forwards what the client says.
fn serve_faults(listener: &TcpListener, said: &mpsc::Sender<Said>) -> Option<()> {
    let folder = Path::new(env!("CARGO_BIN_EXE_yoro")).ancestors().nth(2).unwrap().join("web");
    let mut open = Vec::new();
    for mut stream in listener.incoming().flatten() {
        let request = Request::read(&stream).ok()?;
        let Some(key) = request.header("sec-websocket-key") else {
            http::answer(&mut stream, &request, &folder).ok()?;
            continue;
        };
        let upgrade = "HTTP/1.1 101 Switching Protocols\r\nUpgrade: websocket\r\nConnection: Upgrade";
        let accept = derive_accept_key(key.as_bytes());
        write!(stream, "{upgrade}\r\nSec-WebSocket-Accept: {accept}\r\n\r\n").ok()?;
        let mut socket = WebSocket::from_raw_socket(stream, Role::Server, None);
        let eye_view = EyeView { pose: Pose::IDENTITY, frustum: Frustum::symmetric(1.0, 1.0) };
        let content = Content::Depth(eye_view, [1.0, 10.0]);
        let header = FrameHeader {
            time_ms: 0.0,
            content,
            size: [64, 64],
            render_ms: 0.0,
            encode_ms: 0.0,
            quantizer: 24,
        };
        let picture = Planes::of_gray(&image::GrayImage::new(128, 64));
        let mut encoder = LiveEncoder::new(5.0).unwrap();
        let [first, second] = [0, 1].map(|number| {
            let intra = number == 0;
            let data = &encoder.encode(&picture, 24, intra).unwrap().data;
            FromServer::Frame { number, intra, header, data }.to_bytes()
        });
        let damage = FromServer::Frame { number: 2, intra: true, header, data: &[0, 0, 0, 1, 0x65, 1, 2, 3] };
        let mut decoded = None;
        loop {
            let message = match FromClient::read(&socket.read().ok()?.into_data())? {
                FromClient::Request(_) => continue,
                FromClient::Report(report) if report.decoded == decoded => continue,
                FromClient::Report(report) => {
                    decoded = report.decoded;
                    Said::Decoded(decoded?)
                }
                FromClient::Hello { version, token } => {
                    assert_eq!((version, token), (VERSION, 1u128.to_be_bytes()));
                    Said::Hello
                }
            };
            let answers = match message {
                Said::Hello => vec![FromServer::Welcome(Pose::IDENTITY).to_bytes(), first.clone()],
                Said::Decoded(0) => vec![second.clone()],
                _ => vec![damage.to_bytes()],
            };
            said.send(message).ok()?;
            for answer in answers {
                socket.send(Message::binary(answer)).ok()?;
            }
            if message == Said::Decoded(1) {
                break;
            }
        }
        open.push(socket);
    }
    None
}

#[test]
fn a_browser_that_cannot_decode_says_so_and_stops() {
    // Prints a message if the page is missing.
    let Some(_) = Server::start() else { return };
    let Some(mut browser) = Browser::start_with(&GL) else { return };
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let address = format!("http://{}/", listener.local_addr().unwrap());
    let (tell, said) = mpsc::channel();
    std::thread::spawn(move || serve_faults(&listener, &tell));
    browser.allow(&address);
    browser.allow(&address.replace("http", "ws"));
    browser.resize(640, 420);
    browser.go(&format!("{address}#stream={:032x}", 1));
    let message = "document.getElementById('message-text').textContent";
    let start = Instant::now();
    while !browser.evaluate(message).as_str().unwrap().contains("cannot decode the H.264 (") {
        assert!(start.elapsed() < Duration::from_secs(60), "{}", browser.evaluate(message));
        std::thread::sleep(Duration::from_millis(100));
    }
    // Enough time for three reconnections.
    std::thread::sleep(Duration::from_secs(3));
    let expected = [Said::Hello, Said::Decoded(0), Said::Decoded(1)];
    assert_eq!(said.try_iter().collect::<Vec<_>>(), expected);
    browser.expect_silence();
}
