//! The page in a real browser, which renders with the same rasterizer as the other tests.

mod files;
mod headset;
mod measure;
mod methods;
mod stream;
pub mod video;
mod visit;
mod visitor;

use std::env;
use std::io::{BufRead as _, BufReader};
use std::net::{Ipv4Addr, TcpListener};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use image::RgbImage;
use serde_json::{Value, json};
use xtask::maintain::monado::Running;
use yoro_media::rgb_image;
use yoro_metrics::{Channels, Quality};

use crate::browser::Browser;

/// WebGL on Mesa, like the pictures of the desktop.
const GL: [&str; 3] = ["--use-gl=angle", "--use-angle=gl-egl", "--ignore-gpu-blocklist"];

/// A server for the page's files on this machine, which is ended when this is dropped.
struct Server {
    child: Option<Running>,
    address: String,
    /// The listener that replaces the server after [`Server::fall_silent`].
    silent: Option<TcpListener>,
}

impl Server {
    /// Serves the page that `cargo xtask test` has built. Returns `None` if there is none; the test should then end.
    fn start() -> Option<Server> {
        let Some(xtask) = env::var_os("YORO_TEST_WEB") else {
            let without = env::var_os("YORO_TEST_WITHOUT_WEB").is_some();
            assert!(without, "run `cargo xtask test web::`, or set YORO_TEST_WITHOUT_WEB=1");
            eprintln!("LEFT OUT: the page was not built");
            return None;
        };
        let mut command = Command::new(xtask);
        command.args(["web", "--serve", "--as-built", "--port", "0"]);
        let mut child = command.stdin(Stdio::null()).stdout(Stdio::piped()).spawn().unwrap();
        let lines = BufReader::new(child.stdout.take().unwrap()).lines();
        let address = lines.map_while(Result::ok).find_map(|line| {
            line.split_whitespace().find(|word| word.starts_with("http://")).map(str::to_owned)
        });
        let address = address.expect("the server says where it is");
        Some(Server { child: Some(Running(child)), address, silent: None })
    }

    /// Ends the server. Its port continues to accept connections, but never answers.
    fn fall_silent(&mut self) {
        self.child = None;
        let port = self.address.rsplit(':').next().unwrap().trim_end_matches('/');
        self.silent = Some(TcpListener::bind((Ipv4Addr::LOCALHOST, port.parse().unwrap())).unwrap());
    }
}

/// A browser that shows the page.
struct Page {
    browser: Browser,
    server: Server,
}

impl Page {
    /// Opens the page with a fragment, and waits for its first picture. `before` is run before the page's own scripts.
    /// Returns `None` if the page or the browser is missing.
    fn open(fragment: &str, before: Option<&str>) -> Option<Page> {
        Page::open_with(&GL, fragment, before)
    }

    /// Opens the page like [`Page::open`], in a browser with these options.
    fn open_with(gl: &[&str], fragment: &str, before: Option<&str>) -> Option<Page> {
        let server = Server::start()?;
        let mut browser = Browser::start_with(gl)?;
        browser.allow(&server.address);
        if let Some(script) = before {
            browser.run_before_pages(script);
        }
        browser.show(1000, "light");
        let mut page = Page { browser, server };
        page.go(fragment);
        Some(page)
    }

    fn go(&mut self, fragment: &str) {
        self.browser.go(&format!("{}{fragment}", self.server.address));
        self.until("globalThis.yoro?.ready === true");
    }

    #[track_caller]
    fn evaluate(&mut self, expression: &str) -> Value {
        self.browser.evaluate(expression)
    }

    #[track_caller]
    fn until(&mut self, condition: &str) {
        let start = Instant::now();
        while self.evaluate(condition) != json!(true) {
            let message = "document.getElementById('message')?.textContent";
            assert!(start.elapsed() < Duration::from_secs(90), "{condition}: {}", self.evaluate(message));
            std::thread::sleep(Duration::from_millis(100));
        }
    }

    /// Returns the page's message, if it shows one.
    fn message(&mut self) -> Option<String> {
        let said = "document.getElementById('message').hidden ? null : document.getElementById('message-text').textContent";
        self.evaluate(said).as_str().map(str::to_owned)
    }

    /// Opens a fragment, loses the context before the first scene is there, and restores it after the worker's end.
    fn go_and_lose(&mut self, address: &str) {
        self.browser.go(&format!("{}{address}", self.server.address));
        self.until("Boolean(globalThis.yoro?.page)");
        self.evaluate("yoro.lose = yoro.gl.getExtension('WEBGL_lose_context'); yoro.lose.loseContext(); 0");
        self.until("yoro.ready === true");
        assert_eq!(self.evaluate("yoro.source"), Value::Null, "the context was lost in time");
        self.evaluate("yoro.lose.restoreContext(); 0");
        self.until("yoro.facts !== null && document.getElementById('loading').hidden");
    }

    fn choose(&mut self, id: &str, value: &str) {
        let element = format!("document.getElementById('{id}')");
        self.evaluate(&format!(
            "{element}.value = '{value}'; {element}.dispatchEvent(new Event('change')); 0"
        ));
    }

    /// Draws both eyes with this size each, and reads them at once, before the page draws for its canvas.
    fn eyes(&mut self, size: [u32; 2]) -> [RgbImage; 2] {
        let read = format!(
            "(() => {{ {}; return [0, 1].map((eye) => {{ let s = ''; \
             for (const byte of yoro.page.readEye(eye)) s += String.fromCharCode(byte); return btoa(s); }}); }})()",
            draw(size)
        );
        let texts = self.evaluate(&read);
        [0, 1].map(|eye| rgb_image(&STANDARD.decode(texts[eye].as_str().unwrap()).unwrap(), size))
    }

    /// Drops files with these names and contents on the page.
    fn drop_files(&mut self, files: &[(&str, Vec<u8>)]) {
        let entries: Vec<_> =
            files.iter().map(|(name, bytes)| json!([name, STANDARD.encode(bytes)])).collect();
        let list = Value::from(entries);
        self.evaluate(&format!(
            "(async () => {{ const t = new DataTransfer(); for (const [name, text] of {list}) {{ \
             const b = Uint8Array.from(atob(text), (c) => c.charCodeAt(0)); t.items.add(new File([b], name)); }} \
             const e = document.getElementById('files'); e.files = t.files; yoro.taken = false; \
             await yoro.take([...e.files].map((file) => ({{ name: file.name, file }}))); }})()"
        ));
    }
}

/// Returns the expression that draws with this size per eye, which is half of the canvas's width and all of its height.
fn draw(size: [u32; 2]) -> String {
    format!("yoro.page.draw({}, {}, false)", 2 * size[0], size[1])
}

/// Returns the expression that selects a display, draws, and sums up the canvas's values.
fn sum(display: &str) -> String {
    format!(
        "(() => {{ const e = document.getElementById('display'); e.value = '{display}'; \
         e.dispatchEvent(new Event('change')); yoro.page.draw(64, 48, false); \
         const bytes = new Uint8Array(64 * 48 * 4), {{ gl }} = yoro; \
         gl.readPixels(0, 0, 64, 48, gl.RGBA, gl.UNSIGNED_BYTE, bytes); \
         return bytes.reduce((sum, byte, i) => sum + (i % 4 === 3 ? 0 : byte), 0); }})()"
    )
}

/// Returns the SSIM of two pictures, and the mean difference of their values in 1/255.
fn difference(here: &RgbImage, desktop: &RgbImage) -> (f64, f64) {
    let quality = Quality::of(here, desktop, Channels::Rgb).unwrap();
    let pairs = here.as_raw().iter().zip(desktop.as_raw());
    let sum: u64 = pairs.map(|(a, b)| u64::from(a.abs_diff(*b))).sum();
    (quality.ssim_gaussian, sum as f64 / here.as_raw().len() as f64)
}

fn close(name: &str, here: &RgbImage, desktop: &RgbImage) {
    let (ssim, mean) = difference(here, desktop);
    assert!(ssim >= 0.99 && mean < 1.0, "{name}: SSIM {ssim}, {mean}/255");
}
