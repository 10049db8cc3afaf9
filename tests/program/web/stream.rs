//! A stream from the program to the page.

use std::io::{BufRead as _, BufReader, Read as _, Write as _};
use std::net::TcpStream;
use std::process::{Child, Command, Stdio};

use image::RgbImage;
use serde_json::json;
use yoro::eyes::{Eye, EyePair};
use yoro_context::{Backend, Headless};
use yoro_lab::metrics::{Channels, psnr};
use yoro_lab::streaming::{Mode, Receiver, Stage};
use yoro_render::{PreparedScene, RenderSettings};
use yoro_stream::{Sight, Wish};
use yoro_video::{Decoder, LiveEncoder};

use super::{GL, Page, Server, close};
use crate::browser::Browser;

const QUANTIZER: &str = "16";
/// Steps of a head, in metres to the right.
const STEP: f32 = 0.02;

/// `yoro serve`, until this is dropped.
fn serve(mode: &str) -> (Server, String) {
    let mut command = Command::new(env!("CARGO_BIN_EXE_yoro"));
    command.args(["serve", "prototype", "--port", "0", "--frame-rate", "5", "--max-size", "320"]);
    command.args(["--quantizer", QUANTIZER, "--mode", mode]);
    let mut child: Child = command.stdin(Stdio::null()).stdout(Stdio::piped()).spawn().unwrap();
    let mut lines = BufReader::new(child.stdout.take().unwrap()).lines();
    let first = lines.next().expect("it says where it is").unwrap();
    std::thread::spawn(move || lines.for_each(drop));
    let link = first.strip_prefix("open ").expect("a link").to_owned();
    let address = link.split('#').next().unwrap().to_owned();
    (Server { child, address, silent: None }, link)
}

/// Opens the link that a server prints, and waits for its pictures; none where something is missing.
fn open(mode: &str) -> Option<(Page, String)> {
    // Says what is missing.
    Server::start()?;
    let mut browser = Browser::start_with(&GL)?;
    let (server, link) = serve(mode);
    browser.allow(&server.address);
    browser.allow(&server.address.replace("http", "ws"));
    browser.resize(640, 420);
    browser.go(&link);
    let mut page = Page { browser, server };
    page.until("globalThis.yoro?.stream?.frames > 3");
    assert_eq!(page.message(), None);
    Some((page, link))
}

/// The desktop's side: a scene, and what a viewer makes of its pictures.
struct Desktop {
    prepared: PreparedScene,
    stage: Stage,
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
            stage: Stage::new(gl, mode).unwrap(),
            receiver: Receiver::new(gl).unwrap(),
            _headless: headless,
        }
    }

    /// Returns the first pose's eyes of a size, and those after a step.
    fn pairs(&self, size: [u32; 2]) -> [EyePair; 2] {
        let settings = yoro_web::Settings::default();
        let mut walker = yoro_web::Walker::new(self.prepared.scene.viewpoints[0].pose());
        let first = settings.pair(walker.pose(), size);
        walker.walk([STEP, 0.0, 0.0]);
        [first, settings.pair(walker.pose(), size)]
    }

    /// Returns what is seen of the first pair's picture at the poses of both.
    fn seen(&mut self, pairs: &[EyePair; 2]) -> [[RgbImage; 2]; 2] {
        let [first, _] = pairs;
        let sight = |eye: Eye| Sight { pose: first.poses[eye.index()], frustum: first.frusta[eye.index()] };
        let eyes = Eye::BOTH.map(sight);
        let wish = Wish { time: 0.0, eyes, dominant: first.dominant, size: first.size.map(|n| n as u16) };
        let picture = self.stage.picture(&mut self.prepared, &wish).unwrap();
        let (mut encoder, mut decoder) = (LiveEncoder::new(5.0).unwrap(), Decoder::new().unwrap());
        let mut planes = picture.planes.clone();
        // A picture that stands still becomes better for some frames.
        for _ in 0..4 {
            let (bits, _) = encoder.encode(&picture.planes, QUANTIZER.parse().unwrap(), false).unwrap();
            planes = decoder.decode(&bits).unwrap();
        }
        [0, 1].map(|i| self.receiver.eyes(&planes, &picture.content, picture.size, &pairs[i]).unwrap())
    }

    fn real(&mut self, pair: &EyePair, eye: Eye) -> RgbImage {
        let mut renderer = yoro_lab::dataset::GroupRenderer::new(
            self._headless.gl(),
            &yoro_lab::dataset::GroupOptions { anti_aliasing: true, ..Default::default() },
        )
        .unwrap();
        renderer.render_one(&mut self.prepared, &pair.view(eye)).unwrap().0
    }
}

/// Checks that the page shows what the desktop would, at the pose of the picture and a step beside it.
fn check(page: &mut Page, desktop: &mut Desktop) -> [EyePair; 2] {
    let number =
        |page: &mut Page, side: &str| page.evaluate(&format!("yoro.canvas.{side}")).as_u64().unwrap() as u32;
    let size = [number(page, "width") / 2, number(page, "height")];
    let pairs = desktop.pairs(size);
    let [still, moved] = desktop.seen(&pairs);
    for (name, step, desktop) in [("still", 0.0, still), ("moved", STEP, moved)] {
        // At once, before a picture of the new pose can come; and back again.
        page.evaluate(&format!("yoro.page.walk({step}, 0, 0); 0"));
        let here = page.eyes(size);
        page.evaluate(&format!("yoro.page.walk(-{step}, 0, 0); 0"));
        for eye in Eye::BOTH {
            close(&format!("{name}, {}", eye.name()), &here[eye.index()], &desktop[eye.index()]);
        }
    }
    pairs
}

/// Sends a first message on a new connection, and gives the answer's bytes.
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

    let token = link.split("stream=").nth(1).unwrap().split('&').next().unwrap();
    assert_eq!(knock(&mut page, &"0".repeat(32)), json!([1, 0]), "another token");
    assert_eq!(knock(&mut page, token), json!([1, 1]), "another page is served");
    for origin in ["Origin: http://elsewhere.example\r\n", ""] {
        let host = page.server.address.trim_start_matches("http://").trim_end_matches('/').to_owned();
        let mut stream = TcpStream::connect(&host).unwrap();
        let key = "Sec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==";
        write!(stream, "GET /stream HTTP/1.1\r\nHost: {host}\r\n{origin}{key}\r\n\r\n").unwrap();
        let mut answer = String::new();
        stream.read_to_string(&mut answer).unwrap();
        assert!(answer.starts_with("HTTP/1.1 403"), "{answer}");
    }

    // A page that is silent for too long is left, and comes back.
    page.evaluate("yoro.stream.frames = 0; const end = Date.now() + 4000; while (Date.now() < end); 0");
    page.until("yoro.stream.losses === 1 && yoro.stream.there && yoro.stream.frames > 2");
    assert_eq!(page.message(), None);
    page.until("document.getElementById('facts').textContent.includes('frames/s')");
    page.browser.expect_silence();

    page.server.stop();
    page.until("yoro.stream.there === false");
    assert!(page.message().unwrap().contains("lost"));
}

#[test]
fn two_eyes_are_turned_with_the_head() {
    let Some((mut page, _)) = open("eyes") else { return };
    check(&mut page, &mut Desktop::new(Mode::Eyes));
    page.browser.expect_silence();
}
