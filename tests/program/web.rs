//! The page in a real browser, which draws with the same rasterizer as the other tests.

use std::env;
use std::io::{BufRead as _, BufReader};
use std::net::{Ipv4Addr, TcpListener};
use std::path::PathBuf;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use image::{DynamicImage, GrayImage, ImageFormat, Luma, Rgb, RgbImage};
use serde_json::{Value, json};
use yoro::eyes::{DepthRange, Eye, EyeOptions, EyePair, Frustum};
use yoro::synthesis::Edges;
use yoro_context::{Backend, Headless};
use yoro_lab::metrics::{Channels, Quality};
use yoro_lab::picture::{DepthImage, rgb_image, save_depth};
use yoro_render::stereo::{self, Method, StereoFrame, StereoOptions};
use yoro_render::{PreparedScene, RenderSettings, RendererKind};

use crate::browser::Browser;
use crate::program::succeed;

/// WebGL on Mesa, as the desktop's pictures are made.
const GL: [&str; 3] = ["--use-gl=angle", "--use-angle=gl-egl", "--ignore-gpu-blocklist"];
/// WebGL on SwiftShader, which has OVR_multiview2 as the browsers of headsets have it.
const MULTIVIEW: [&str; 3] = ["--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"];
/// Size of each eye's image that is compared.
const SIZE: [u32; 2] = [240, 160];

/// The page's files on this machine, until this is dropped.
struct Server {
    child: Child,
    address: String,
    /// What listens in its place, once it has fallen silent.
    silent: Option<TcpListener>,
}

impl Server {
    /// Serves the page that `cargo xtask test` has built; none without it, and the test is to end.
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
        Some(Server { child, address: address.expect("the server says where it is"), silent: None })
    }
}

impl Server {
    /// Ends the server; its port takes connections and answers none.
    fn fall_silent(&mut self) {
        self.stop();
        let port = self.address.rsplit(':').next().unwrap().trim_end_matches('/');
        self.silent = Some(TcpListener::bind((Ipv4Addr::LOCALHOST, port.parse().unwrap())).unwrap());
    }

    fn stop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

impl Drop for Server {
    fn drop(&mut self) {
        self.stop();
    }
}

/// Has the page's second load get the module with a type that browsers do not stream.
const WRONG_TYPE: &str = "if (location.search === '?again') {
    const ask = fetch;
    globalThis.fetch = async (...what) => {
        const answer = await ask(...what);
        return new Response(answer.body, { headers: { 'Content-Type': 'application/octet-stream' } });
    };
}";

/// A browser with the page.
struct Page {
    browser: Browser,
    server: Server,
}

impl Page {
    /// Opens the page with a fragment, at a window's width, and waits for its first picture; nothing where something is
    /// missing. `before` is run before the page's own scripts.
    fn open(fragment: &str, before: Option<&str>) -> Option<Page> {
        Page::open_with(&GL, fragment, before)
    }

    /// Opens as [`Page::open`] does, in a browser with these options.
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

    /// The page's message, if it shows one.
    fn message(&mut self) -> Option<String> {
        let said = "document.getElementById('message').hidden ? null : document.getElementById('message-text').textContent";
        self.evaluate(said).as_str().map(str::to_owned)
    }

    /// Opens a fragment, loses the context before the first scene is there, and gives it back when its worker has ended.
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

    /// Returns both eyes, drawn with this size each: at once, before the page draws for its canvas.
    fn eyes(&mut self, size: [u32; 2]) -> [RgbImage; 2] {
        let read = format!(
            "(() => {{ {}; return [0, 1].map((eye) => {{ let s = ''; \
             for (const byte of yoro.page.readEye(eye)) s += String.fromCharCode(byte); return btoa(s); }}); }})()",
            draw(size)
        );
        let texts = self.evaluate(&read);
        [0, 1].map(|eye| rgb_image(&STANDARD.decode(texts[eye].as_str().unwrap()).unwrap(), size))
    }

    /// Drops files: names and contents.
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

/// Half the width and all of the height of a canvas.
fn draw(size: [u32; 2]) -> String {
    format!("yoro.page.draw({}, {}, false)", 2 * size[0], size[1])
}

/// Chooses a display, draws, and adds up the canvas's values.
fn sum(display: &str) -> String {
    format!(
        "(() => {{ const e = document.getElementById('display'); e.value = '{display}'; \
         e.dispatchEvent(new Event('change')); yoro.page.draw(64, 48, false); \
         const bytes = new Uint8Array(64 * 48 * 4), {{ gl }} = yoro; \
         gl.readPixels(0, 0, 64, 48, gl.RGBA, gl.UNSIGNED_BYTE, bytes); \
         return bytes.reduce((sum, byte, i) => sum + (i % 4 === 3 ? 0 : byte), 0); }})()"
    )
}

fn close(name: &str, here: &RgbImage, desktop: &RgbImage) {
    let quality = Quality::of(here, desktop, Channels::Rgb).unwrap();
    let difference: u64 =
        here.as_raw().iter().zip(desktop.as_raw()).map(|(a, b)| u64::from(a.abs_diff(*b))).sum();
    let mean = difference as f64 / here.as_raw().len() as f64;
    assert!(
        quality.ssim_gaussian >= 0.99 && mean < 1.0,
        "{name}: SSIM {}, {mean}/255",
        quality.ssim_gaussian
    );
}

#[test]
fn every_method_shows_what_the_desktop_shows() {
    let Some(mut page) = Page::open("#scene=prototype&viewpoint=1&display=side-by-side", None) else {
        return;
    };
    assert_eq!(page.message(), None);
    let headless = Headless::open(Backend::Egl).unwrap();
    let gl = headless.gl();
    let mut frame = StereoFrame::new(gl, SIZE).unwrap();
    for renderer in RendererKind::ALL {
        let settings = RenderSettings { renderer, ..RenderSettings::default() };
        let scene = yoro_scenes::build("prototype", yoro_scenes::DEFAULT_SEED).unwrap();
        let mut prepared = PreparedScene::new(gl, scene, &settings).unwrap();
        let pose = prepared.scene.viewpoints[1].pose();
        let pair = EyeOptions { size: SIZE, ..EyeOptions::default() }.pair(pose);
        // WebGL has no multisample textures.
        let edges = settings.is_forward().then_some(Edges::Sample);
        let options = StereoOptions { policy: None, edges, ..StereoOptions::default() };
        page.choose("renderer", renderer.name());
        assert_eq!(page.evaluate("yoro.page.renderer"), settings.summary());
        let mut compared = 0;
        for method in Method::ALL.into_iter().filter(|method| *method != Method::Multiview) {
            let name = format!("{}, {}", renderer.name(), method.name());
            let offered = format!("!document.querySelector('#method [value={}]').disabled", method.name());
            let supported = settings.supports(method, gl.capabilities()).is_ok();
            assert_eq!(page.evaluate(&offered), json!(supported), "{name}");
            if !supported {
                continue;
            }
            let mut made = stereo::create(gl, method, &settings, &options).unwrap();
            made.render(&mut prepared.renderer, &prepared.scene, &pair, &mut frame).unwrap();
            page.choose("method", method.name());
            assert_eq!(page.message(), None, "{name}");
            let eyes = page.eyes(SIZE);
            for eye in Eye::BOTH {
                let desktop = rgb_image(&frame.eye(eye).read_rgba8(0, [0, 0], SIZE), SIZE);
                close(&format!("{name}, {}", eye.name()), &eyes[eye.index()], &desktop);
            }
            assert_eq!(page.evaluate("yoro.page.takeErrors() ?? null"), Value::Null, "{name}");
            compared += 1;
        }
        assert!(compared >= 5, "{}: {compared} methods", renderer.name());
    }
    page.browser.expect_silence();
}

#[test]
fn multiview_shows_what_two_renders_show() {
    let Some(mut page) = Page::open_with(&MULTIVIEW, "#method=multiview&display=left", None) else { return };
    if page.evaluate("yoro.gl.getExtension('OVR_multiview2') !== null") != json!(true) {
        eprintln!("SKIPPED: this Chromium has no OVR_multiview2");
        return;
    }
    assert_eq!((page.message(), page.evaluate("yoro.settings.method")), (None, json!("multiview")));
    let both = page.eyes(SIZE);
    page.choose("method", "conventional");
    let expected = page.eyes(SIZE);
    for eye in Eye::BOTH {
        close(eye.name(), &both[eye.index()], &expected[eye.index()]);
    }
    assert_eq!(page.evaluate("yoro.page.takeErrors() ?? null"), Value::Null);
    page.browser.expect_silence();
}

#[test]
fn a_link_sets_everything_and_the_page_lasts() {
    let fragment = "#viewpoint=2&method=hybrid&renderer=forward&anti-aliasing=off&ipd=70&dominant=left&display=anaglyph&scale=0.5";
    let Some(mut page) = Page::open(fragment, Some(WRONG_TYPE)) else { return };
    let shown = "['viewpoint', 'method', 'renderer', 'anti-aliasing', 'ipd', 'dominant', 'display', 'scale'].map((id) => \
                 document.getElementById(id).value).join()";
    assert_eq!(page.evaluate(shown), "2,hybrid,forward,off,70,left,anaglyph,0.5");
    assert_eq!(page.message(), None);
    page.until("performance.getEntriesByName('first-picture').length === 1");
    let first = page.evaluate("performance.getEntriesByName('first-picture')[0].startTime");
    eprintln!("first picture after {:.0} ms", first.as_f64().unwrap());
    // Walking is kept in the link.
    page.evaluate("document.getElementById('canvas').focus()");
    page.browser.hold("KeyW", Duration::from_millis(300));
    page.until("location.hash.includes('at=')");
    let fragment = page.evaluate("location.hash");
    assert!(fragment.as_str().unwrap().contains("method=hybrid"), "{fragment}");

    // Each renderer comes with its own anti-aliasing. Unsupported choices are refused, and the choice before stays.
    for (renderer, smoothing) in [("deferred", "after"), ("forward", "msaa")] {
        page.choose("renderer", renderer);
        assert_eq!(page.evaluate("yoro.settings['anti-aliasing']"), smoothing);
    }
    page.until("location.hash.includes('renderer=forward') && !location.hash.includes('anti-aliasing')");
    page.choose("renderer", "deferred");
    page.choose("method", "shading-reprojection");
    page.choose("renderer", "forward");
    assert!(page.message().unwrap().contains("g-buffer"));
    assert_eq!(page.evaluate("yoro.page.renderer"), "deferred");
    page.evaluate(&draw([64, 48]));
    assert_eq!(page.evaluate("yoro.page.takeErrors() ?? null"), Value::Null);

    // Every display draws; turned and resized, as a phone is.
    for display in
        ["side-by-side", "cross-eyed", "left", "right", "divider", "difference", "flicker", "anaglyph"]
    {
        page.choose("display", display);
        page.evaluate("yoro.page.draw(64, 48, 0.5)");
        page.until("!document.getElementById('label-left').hidden");
    }
    for (width, height) in [(390, 844), (844, 390), (320, 500), (1000, 900)] {
        page.browser.resize(width, height);
        page.until("Math.abs(yoro.canvas.width - yoro.canvas.clientWidth * 0.5) <= 1");
        // Errors are where the user looks, however long their words, and move nothing.
        let seen = "(() => { scrollTo(0, 1e6); const before = document.body.scrollHeight; yoro.say('x'.repeat(300)); \
                    const b = document.getElementById('message').getBoundingClientRect(); \
                    const moved = document.body.scrollHeight - before; \
                    return moved === 0 && b.top >= 0 && b.bottom <= innerHeight && b.height > 20; })()";
        assert_eq!(page.evaluate(seen), json!(true), "{width}x{height}");
        let wide = page.evaluate("document.documentElement.scrollWidth");
        assert!(wide.as_u64().unwrap() <= u64::from(width), "{wide} pixels wide in a window of {width}");
    }
    page.evaluate("document.getElementById('message-close').click()");
    assert_eq!(page.message(), None);

    // Elements have names, and what is not here has a reason for browsers.
    assert_eq!(page.evaluate("document.getElementById('ipd').labels[0].textContent"), "Eyes apart");
    let reason = page.evaluate("document.querySelector('#method [value=multiview]').title");
    assert!(!reason.as_str().unwrap().contains("Mesa"), "{reason}");

    // The link is copied without a loss, and followed: what was wrong before is no longer told.
    let facts = page.evaluate("document.getElementById('facts').textContent");
    assert!(facts.as_str().unwrap().contains("23,558 triangles"), "{facts}");
    page.evaluate("document.getElementById('share').click()");
    page.evaluate("location.hash = '#nonsense=1'; 0");
    page.until("document.getElementById('message-text').textContent.includes('nonsense')");
    page.evaluate("location.hash = '#display=left&scale=0.5'; 0");
    page.until("document.getElementById('message').hidden");
    assert_eq!(page.evaluate("document.getElementById('facts').textContent"), facts);

    // The page shows the progress while a scene is generated.
    let told = page.evaluate(
        "(async () => { const bar = document.getElementById('progress'), seen = []; \
         const watch = new MutationObserver(() => seen.push(bar.position)); watch.observe(bar, { attributes: true }); \
         await yoro.showSource({ builtin: 'conference' }); watch.disconnect(); return seen; })()",
    );
    let told: Vec<f64> = told.as_array().unwrap().iter().map(|part| part.as_f64().unwrap()).collect();
    let parts: Vec<f64> = told.into_iter().filter(|part| *part >= 0.0).collect();
    assert!(
        parts.len() > 5 && parts.is_sorted() && parts[0] < 0.5 && parts[parts.len() - 1] > 0.9,
        "{parts:?}"
    );
    page.evaluate("yoro.showSource({ builtin: 'prototype' })");

    // A thousand frames hold the same objects as ten.
    let frames = |count: u32| {
        format!(
            "(() => {{ for (let i = 0; i < {count}; i++) {{ yoro.page.turn(0.01, 0); yoro.page.draw(32, 24, false); }} \
                 return [...yoro.page.held]; }})()"
        )
    };
    page.choose("method", "yoro");
    for renderer in ["forward", "deferred"] {
        page.choose("renderer", renderer);
        let before = page.evaluate(&frames(10));
        for _ in 0..5 {
            assert_eq!(page.evaluate(&frames(100)), before);
        }
    }

    // The context is lost, and comes back with the scene.
    page.evaluate("yoro.lose = yoro.gl.getExtension('WEBGL_lose_context'); yoro.lose.loseContext(); 0");
    page.until("yoro.page === null");
    assert!(page.message().unwrap().contains("lost"));
    page.evaluate("yoro.lose.restoreContext(); 0");
    page.until("yoro.page !== null && document.getElementById('loading').hidden");
    assert_eq!(page.message(), None);
    page.evaluate(&draw([32, 24]));
    assert_eq!(page.evaluate("yoro.page.takeErrors() ?? null"), Value::Null);
    page.browser.expect_silence();

    // What is no viewer or no screen is marked at its field, and not entered.
    page.evaluate("Object.defineProperty(screen, 'width', { value: 844 }); Object.defineProperty(screen, 'height', { value: 390 }); 0");
    for (id, value, part) in [
        ("phone-viewer", "goo.gl/abc", "shortened"),
        ("phone-viewer", "V1", "no viewer"),
        ("phone-width", "60", "2.8 cm"),
    ] {
        let field = format!("document.getElementById('{id}')");
        let before = page.evaluate(&format!("{field}.value"));
        page.evaluate(&format!("{field}.value = '{value}'"));
        let told =
            page.evaluate(&format!("document.getElementById('phone').click(); {field}.validationMessage"));
        assert!(told.as_str().unwrap().contains(part), "{value}: {told}");
        assert_eq!((page.evaluate("yoro.busy"), page.message()), (Value::Null, None), "{value}");
        page.evaluate(&format!("{field}.value = {before}; {field}.dispatchEvent(new Event('input')); 0"));
    }

    // In a viewer: told how to hold it, turned by the sensors, and left again.
    page.evaluate("document.getElementById('phone').click()");
    page.until("yoro.busy?.name === 'phone'");
    page.browser.resize(300, 640);
    page.until("!document.getElementById('phone-upright').hidden");
    page.browser.resize(640, 300);
    page.until("yoro.canvas.width === 640 && document.getElementById('phone-upright').hidden");
    page.until("document.getElementById('message-text').textContent.includes('sensors')");
    page.evaluate("dispatchEvent(new DeviceOrientationEvent('deviceorientation', { alpha: 150, beta: 0, gamma: -90 })); yoro.clear(); 0");
    page.evaluate("document.getElementById('measure').click()");
    assert!(page.message().unwrap().contains("leave it first"));
    page.evaluate("yoro.clear(); document.getElementById('phone-leave').click()");
    page.until("yoro.busy === null && document.fullscreenElement === null");
    assert_eq!(page.message(), None);
    page.browser.expect_silence();

    // A link's invalid parts are reported, and the rest is applied, also where another scene is chosen while the first one
    // loads; a host's wrong type for the module does not matter.
    let link = "?again#scene=conference&viewpoint=1&ipd=%20&method=none&size=3&anti-aliasing=msaa&toString=1&__proto__=1&at=1e9,,0,0,0";
    page.browser.go(&format!("{}{link}", page.server.address));
    page.until("globalThis.yoro?.wanted?.builtin === 'conference'");
    let told = page.message().unwrap();
    for part in [
        "ipd is “ ”",
        "method is “none”",
        "“size”",
        "anti-aliasing is “msaa”",
        "“toString”",
        "“__proto__”",
        "place is “1e9",
    ] {
        assert!(told.contains(part), "{part}: {told}");
    }
    page.choose("scene", "prototype");
    page.until("yoro.ready === true");
    page.until("yoro.source?.builtin === 'prototype' && yoro.wanted === null");
    page.evaluate("location.hash = '#viewpoint=98&display=left'; 0");
    page.until("document.getElementById('message-text').textContent.includes('viewpoint is 99')");

    // Loaded once, it needs no network, by whatever name it is asked for; and a network that never answers is none.
    page.until("navigator.serviceWorker.controller !== null");
    page.until("caches.match(performance.getEntriesByType('resource').find(({ name }) => name.endsWith('wasm')).name).then(Boolean)");
    page.server.fall_silent();
    page.go_and_lose("index.html?offline#viewpoint=3&display=left");
    assert_eq!((page.message(), page.evaluate("yoro.settings.viewpoint")), (None, json!(3)));
}

fn png(image: impl Into<DynamicImage>) -> Vec<u8> {
    let mut bytes = std::io::Cursor::new(Vec::new());
    image.into().write_to(&mut bytes, ImageFormat::Png).unwrap();
    bytes.into_inner()
}

const ROOM: &str = "mtllib room.mtl\nv -2 0 -4\nv 2 0 -4\nv 2 3 -4\nv -2 3 -4\nv -2 0 2\nv 2 0 2\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n\
                    usemtl wall\nf 1/1 2/2 3/3 4/4\nf 5/1 6/2 2/3 1/4\n";

/// A JPEG of this size that carries a smaller depth, as phones' portrait photos do: near on the left.
fn portrait(size: [u32; 2]) -> Vec<u8> {
    let mut jpeg = std::io::Cursor::new(Vec::new());
    let color = RgbImage::from_fn(size[0], size[1], |x, y| Rgb([(x * 2) as u8, (y * 3) as u8, 90]));
    DynamicImage::from(color).write_to(&mut jpeg, ImageFormat::Jpeg).unwrap();
    let depth = STANDARD.encode(png(GrayImage::from_fn(6, 4, |x, _| Luma([(x * 40) as u8]))));
    let (first, second) = depth.split_at(depth.len() / 2);
    let xmp = |text: String| {
        let length = (text.len() + 2) as u16;
        [&[0xff, 0xe1][..], &length.to_be_bytes(), text.as_bytes()].concat()
    };
    let mut out = jpeg.get_ref()[..2].to_vec();
    let head =
        "GDepth:Format=\"RangeInverse\" GDepth:Near=\"0.5\" GDepth:Far=\"9\" GDepth:Mime=\"image/png\"";
    out.extend(xmp(format!("http://ns.adobe.com/xap/1.0/\0<rdf {head}/>")));
    // The parts of what does not fit into one segment may come in any order.
    let part = |offset: u8, text: &str| {
        let id = "0".repeat(32);
        xmp(format!("http://ns.adobe.com/xmp/extension/\0{id}\0\0\0\0\0\0\0{}{text}", char::from(offset)))
    };
    out.extend(part(9, &format!("{second}\"/>")));
    out.extend(part(0, &format!("<rdf GDepth:Data=\"{first}")));
    out.extend(&jpeg.get_ref()[2..]);
    out
}

/// A GLB of one triangle.
fn glb() -> Vec<u8> {
    let floats: Vec<u8> =
        [-1f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.5, 0.0].iter().flat_map(|f| f.to_le_bytes()).collect();
    let json = json!({
        "asset": { "version": "2.0" },
        "buffers": [{ "byteLength": floats.len() }],
        "bufferViews": [{ "buffer": 0, "byteLength": floats.len() }],
        "accessors": [{ "bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
            "min": [-1.0, 0.0, 0.0], "max": [1.0, 1.5, 0.0] }],
        "meshes": [{ "primitives": [{ "attributes": { "POSITION": 0 } }] }],
        "nodes": [{ "mesh": 0 }],
        "scenes": [{ "nodes": [0] }],
    });
    let mut json = json.to_string().into_bytes();
    json.resize(json.len().next_multiple_of(4), b' ');
    let mut out = b"glTF".to_vec();
    let word = |out: &mut Vec<u8>, n: usize| out.extend((n as u32).to_le_bytes());
    word(&mut out, 2);
    word(&mut out, 12 + 8 + json.len() + 8 + floats.len());
    word(&mut out, json.len());
    out.extend(b"JSON");
    out.extend(json);
    word(&mut out, floats.len());
    out.extend(b"BIN\0");
    out.extend(floats);
    out
}

#[test]
fn dropped_files_are_shown_or_refused() {
    let Some(mut page) = Page::open("#display=left", None) else { return };
    let dropped = "const text = new DataTransfer(); text.setData('text/plain', 'words'); \
                   dispatchEvent(new DragEvent('drop', { dataTransfer: text, cancelable: true }))";
    assert_eq!(page.evaluate(dropped), json!(false), "the browser opens nothing");
    page.until("document.getElementById('message-text').textContent.includes('no file')");
    let texture = png(RgbImage::from_fn(8, 8, |x, y| Rgb([(x * 30) as u8, (y * 30) as u8, 90])));
    let mtl = b"newmtl wall\nKd 1 1 1\nmap_Kd bricks.png\n".to_vec();
    page.drop_files(&[("room.obj", ROOM.into()), ("room.mtl", mtl), ("bricks.png", texture)]);
    assert_eq!((page.message(), page.evaluate("yoro.facts.triangles")), (None, json!(4)));
    page.evaluate(&draw([48, 32]));
    page.drop_files(&[("one.glb", glb())]);
    assert_eq!((page.message(), page.evaluate("yoro.facts.triangles")), (None, json!(1)));

    // The list of scenes says what is shown; a link cannot carry it, nor a place in it. What fails changes nothing.
    let scene = "document.getElementById('scene').value";
    assert_eq!(page.evaluate(scene), "own");
    page.evaluate("yoro.page.walk(0, 0, 1); document.getElementById('share').click(); 0");
    let link = page.evaluate("location.hash");
    assert!(!link.as_str().unwrap().contains("at=") && !link.as_str().unwrap().contains("scene="), "{link}");
    page.evaluate("yoro.showSource({ builtin: 'nowhere' })");
    assert_eq!((page.message().is_some(), page.evaluate(scene)), (true, json!("own")));

    // Pictures are as `yoro synthesize` makes them.
    let size = [96u32, 64];
    let color = RgbImage::from_fn(size[0], size[1], |x, y| {
        Rgb([(x * 2) as u8, (y * 3) as u8, if x / 8 % 2 == y / 8 % 2 { 200 } else { 40 }])
    });
    let near = |x: u32, y: u32| (30..60).contains(&x) && (20..50).contains(&y);
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    let gray = GrayImage::from_fn(size[0], size[1], |x, y| Luma([if near(x, y) { 200 } else { 20 }]));
    gray.save(path("depth.png")).unwrap();
    let metres = DepthImage::from_fn(size[0], size[1], |x, y| Luma([if near(x, y) { 0.7 } else { 4.0 }]));
    save_depth(&path("metres.exr"), &metres).unwrap();
    // A distance that 8 bits do not have.
    let tenths = DepthImage::from_fn(size[0], size[1], |x, y| Luma([if near(x, y) { 0.0713 } else { 0.4 }]));
    save_depth(&path("tenths-depth.png"), &tenths).unwrap();
    color.save(path("view.png")).unwrap();
    // Their depth is guessed: by a brighter bottom, by the kind of file, by 16 bits.
    for (depth, encoding, key, value, edges) in [
        ("depth.png", "disparity", "disparity-scale", "12", "hard"),
        ("metres.exr", "metres", "metres-at-white", "3", "hard"),
        ("tenths-depth.png", "metres", "metres-at-white", "10", "sample"),
    ] {
        let files = ["view.png", depth].map(|name| (name, std::fs::read(path(name)).unwrap()));
        page.drop_files(&files);
        assert_eq!(page.message(), None, "{depth}");
        assert_eq!(page.evaluate("yoro.source.depth.name"), depth);
        assert_eq!(page.evaluate("document.getElementById('picture-encoding').value"), encoding, "{depth}");
        page.choose("picture-edges", edges);
        page.choose("picture-encoding", encoding);
        page.evaluate(&format!(
            "document.getElementById('picture-{key}').value = {value}; \
             document.getElementById('picture-options').dispatchEvent(new Event('change')); 0"
        ));
        assert_eq!(page.message(), None, "{depth}");
        let options = format!("--depth-encoding {encoding} --{key} {value} --edges {edges}");
        succeed(
            folder.path(),
            &format!("synthesize --color view.png --depth {depth} --out left.png {options}"),
        );
        let desktop = image::open(path("left.png")).unwrap().into_rgb8();
        assert_ne!(desktop, color, "{depth}: something moves");
        close(depth, &page.eyes(size)[0], &desktop);
    }

    // What pictures have no use for cannot be chosen.
    let without = "['method', 'viewpoint', 'renderer'].every((id) => document.getElementById(id).disabled)";
    assert_eq!(page.evaluate(without), json!(true));
    for (value, part) in
        [("''", Some("Metres at white: ")), ("1e30", Some("Metres at white: ")), ("10", None)]
    {
        page.evaluate(&format!(
            "document.getElementById('picture-metres-at-white').value = {value}; \
             document.getElementById('picture-options').dispatchEvent(new Event('change')); 0"
        ));
        let told = page.message();
        assert_eq!(told.is_some(), part.is_some(), "{value}");
        assert!(told.is_none_or(|told| told.starts_with(part.unwrap())), "{value}");
    }
    let hidden = "['near', 'far', 'disparity-scale'].every((key) => document.getElementById(`picture-${key}`).labels[0].hidden)";
    assert_eq!(page.evaluate(hidden), json!(true), "fields that distances have no use for");

    // Pictures have no truth for a difference: the eye itself is shown.
    let synthesized = page.evaluate(&sum("left"));
    assert!(synthesized.as_u64().unwrap() > 0);
    assert_eq!(page.evaluate(&sum("difference")), synthesized);

    // Eleven invalid inputs: a sentence each, and the content before stays.
    type Files<'a> = &'a [(&'a str, Vec<u8>)];
    let gray = |w, h| png(GrayImage::new(w, h));
    let broken: [(Files, &str); 11] = [
        (&[("a.obj", Vec::new())], "a.obj"),
        (&[("a.obj", b"v 1 2\nf 1 2 3\n".to_vec())], "a.obj"),
        (&[("a.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n".to_vec())], "a.obj"),
        (&[("a.glb", glb()[..30].to_vec())], "a.glb"),
        (
            &[(
                "a.gltf",
                b"{\"asset\":{\"version\":\"2.0\"},\"buffers\":[{\"uri\":\"gone.bin\",\"byteLength\":9}]}"
                    .to_vec(),
            )],
            "gone.bin",
        ),
        (&[("a.gltf", b"{".to_vec())], "a.gltf"),
        (&[("a.png", gray(4, 4))], "One picture is not enough"),
        (&[("a.png", gray(4, 4)), ("b.png", gray(4, 4)), ("c.png", gray(4, 4))], "3 pictures are too many"),
        (&[("a.png", gray(4, 4)), ("a-depth.png", gray(5, 4))], "4x4"),
        (&[("a.png", b"no picture".to_vec()), ("a-depth.png", gray(4, 4))], "a.png is not a picture"),
        (&[("a.txt", b"text".to_vec())], "neither a model"),
    ];
    for (files, part) in broken {
        page.drop_files(files);
        let told = page.message().unwrap_or_default();
        assert!(told.contains(part) && told.ends_with('.'), "{part}: {told}");
        assert_eq!(page.evaluate("Boolean(yoro.source.color)"), json!(true), "{part}: the pictures stay");
    }

    // A photo that carries its depth.
    page.drop_files(&[("portrait.jpg", portrait([96, 64]))]);
    assert_eq!((page.message(), page.evaluate("yoro.source.color.name")), (None, json!("portrait.jpg")));
    let fields = "['source', 'encoding', 'near', 'far'].map((key) => document.getElementById(`picture-${key}`).value).join()";
    assert_eq!(page.evaluate(fields), "center,standard-z,0.5,9");

    // The page's own examples, and back to a scene of the list.
    page.evaluate("document.getElementById('example-pictures').click()");
    page.until("yoro.source.color?.name === 'example-color.jpg'");
    assert_eq!(
        (page.message(), page.evaluate("document.getElementById('picture-encoding').value")),
        (None, json!("standard-z"))
    );
    page.evaluate("document.getElementById('example-model').click()");
    page.until("yoro.source.main === 'example.obj'");
    assert_eq!((page.message(), page.evaluate("yoro.wanted")), (None, Value::Null));
    page.choose("scene", "prototype");
    page.until("yoro.source.builtin === 'prototype'");
    page.browser.expect_silence();

    // Opened as a file, it says what to do.
    let xtask = PathBuf::from(env::var_os("YORO_TEST_WEB").unwrap());
    page.browser.open(&xtask.ancestors().nth(2).unwrap().join("web/index.html"));
    page.until("!document.getElementById('message').hidden");
    assert!(page.message().unwrap().contains("serve its folder"));
}

#[test]
fn a_measurement_is_reported() {
    let Some(mut page) = Page::open("#display=left&renderer=forward", None) else { return };
    page.evaluate(
        "document.getElementById('measure-size').append(new Option('64x48')); \
         document.getElementById('measure-seconds').append(new Option('4', 4)); 0",
    );
    page.choose("measure-size", "64x48");
    page.choose("measure-seconds", "4");
    let places = "JSON.stringify(['own', 'phone-viewer', 'headset'].map((id) => document.getElementById(id).getBoundingClientRect()))";
    let before = page.evaluate(places);
    page.evaluate("document.getElementById('measure').click()");
    page.until("yoro.busy !== null || yoro.measured !== undefined");
    // What it depends on stays as it is, whatever is chosen or followed.
    for id in ["scene", "renderer", "anti-aliasing", "ipd", "dominant", "measure-size", "files"] {
        let locked = format!("document.getElementById('{id}').matches(':disabled')");
        assert_eq!(page.evaluate(&locked), json!(true), "{id}");
    }
    page.evaluate("location.hash = '#scene=talk&ipd=0'; 0");
    page.until("document.getElementById('message-text').textContent.includes('stop it first')");
    page.evaluate("yoro.clear()");
    page.until("yoro.busy === null");
    assert_eq!((page.message(), page.evaluate("yoro.settings.ipd")), (None, json!(63)));
    assert_eq!(page.evaluate(places), before, "the panels stay where they are");
    // A second one that is stopped loses nothing of the first.
    page.evaluate("document.getElementById('measure').click(); document.getElementById('measure').click()");
    page.until("yoro.busy === null");
    assert_eq!(page.evaluate("document.getElementById('measure-save').hidden"), json!(false));
    let table = page.evaluate("document.querySelector('#measure-result table').innerText");
    let table = table.as_str().unwrap();
    assert!(
        table.contains("yoro-gather") && table.contains("100 %") && table.contains("not told"),
        "{table}"
    );
    page.browser.expect_silence();
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("web.jsonl"), page.evaluate("yoro.measured").as_str().unwrap())
        .unwrap();
    drop(page);
    succeed(folder.path(), "report web.jsonl");
    let results = std::fs::read_to_string(folder.path().join("out/results.md")).unwrap();
    for part in ["prototype", "yoro-gather", "shading-reprojection", "multiview"] {
        assert!(results.contains(part), "{part}: {results}");
    }
    assert!(!results.contains("Image quality"), "the page measures none: {results}");
}

/// The Immersive Web Emulation Runtime's script; without it the test is to end.
fn emulator() -> Option<String> {
    let Some(path) = env::var_os("YORO_TEST_WEBXR") else {
        let without = env::var_os("YORO_TEST_WITHOUT_WEBXR").is_some();
        assert!(without, "run `cargo xtask test web::`, or set YORO_TEST_WITHOUT_WEBXR=1");
        eprintln!("LEFT OUT: the WebXR emulator could not be fetched");
        return None;
    };
    Some(std::fs::read_to_string(PathBuf::from(path)).unwrap())
}

/// A Quest 3 with eyes that see further outwards, and a framebuffer of its own, as real ones have.
const HEADSET: &str = "
    globalThis.headset = new IWER.XRDevice(IWER.metaQuest3, { stereoEnabled: true });
    headset.installRuntime({ forceInstall: true });
    const matrix = Object.getOwnPropertyDescriptor(XRView.prototype, 'projectionMatrix').get;
    Object.defineProperty(XRView.prototype, 'projectionMatrix', { get() {
        const m = Float32Array.from(matrix.call(this));
        m[8] += this.eye === 'left' ? -0.15 : 0.15;
        m[9] -= 0.125;
        return m;
    } });
    Object.defineProperty(XRWebGLLayer.prototype, 'framebuffer', { get() {
        if (!this.made) {
            const gl = this.context;
            this.made = gl.createFramebuffer();
            gl.bindFramebuffer(gl.FRAMEBUFFER, this.made);
            for (const [attachment, format] of [[gl.COLOR_ATTACHMENT0, gl.RGBA8], [gl.DEPTH_ATTACHMENT, gl.DEPTH_COMPONENT24]]) {
                const buffer = gl.createRenderbuffer();
                gl.bindRenderbuffer(gl.RENDERBUFFER, buffer);
                gl.renderbufferStorage(gl.RENDERBUFFER, format, this.framebufferWidth, this.framebufferHeight);
                gl.framebufferRenderbuffer(gl.FRAMEBUFFER, attachment, gl.RENDERBUFFER, buffer);
            }
            globalThis.layer = this;
        }
        return this.made;
    } });
    globalThis.readLayer = (eye) => {
        const { context: gl, made, framebufferWidth: width, framebufferHeight: height } = layer;
        gl.bindFramebuffer(gl.FRAMEBUFFER, made);
        const half = width / 2, bytes = new Uint8Array(half * height * 4);
        gl.readPixels(eye * half, 0, half, height, gl.RGBA, gl.UNSIGNED_BYTE, bytes);
        let text = '';
        for (const byte of bytes) text += String.fromCharCode(byte);
        return btoa(text);
    };
";

#[test]
fn a_headset_shows_both_eyes() {
    let Some(emulator) = emulator() else { return };
    let script = format!("{emulator}\n{HEADSET}");
    let Some(mut page) = Page::open("#method=conventional&display=left", Some(&script)) else { return };
    // The emulator's displays have the window's size.
    page.browser.resize(400, 240);
    page.until("!document.getElementById('headset').disabled");
    let press = |page: &mut Page, button: &str| {
        for value in [1, 0] {
            let frames = page.evaluate("yoro.busy.frames").as_u64().unwrap();
            page.evaluate(&format!("headset.controllers.right.updateButtonValue('{button}', {value}); 0"));
            page.until(&format!("yoro.busy.frames > {}", frames + 1));
        }
    };
    for visit in 0..2 {
        page.evaluate("document.getElementById('headset').click()");
        page.until("yoro.busy?.frames > 1");
        assert_eq!(page.message(), None);
        // Without the figures, which change.
        press(&mut page, "thumbstick");
        let expected = if visit == 0 { "conventional" } else { "instanced" };
        assert_eq!(page.evaluate("yoro.settings.method"), expected);
        let number = |value: &Value| value.as_f64().unwrap() as f32;
        let views: Vec<f32> =
            page.evaluate("[...yoro.busy.views]").as_array().unwrap().iter().map(number).collect();
        let size: Vec<u64> =
            page.evaluate("yoro.busy.size").as_array().unwrap().iter().map(|n| n.as_u64().unwrap()).collect();
        let size = [size[0] as u32, size[1] as u32];
        let desktop = headset_pictures(&views, size);
        for eye in Eye::BOTH {
            let read = format!("readLayer({})", eye.index());
            let bytes = STANDARD.decode(page.evaluate(&read).as_str().unwrap()).unwrap();
            let name = format!("visit {visit}, {}", eye.name());
            close(&name, &rgb_image(&bytes, size), &desktop[eye.index()]);
        }
        if visit == 0 {
            press(&mut page, "trigger");
            assert_eq!(page.evaluate("yoro.settings.method"), "instanced");
        }
        if visit == 1 {
            page.evaluate("document.getElementById('measure').click()");
            assert!(page.message().unwrap().contains("leave VR first"));
            page.evaluate("yoro.clear(); yoro.page.walk(0, 0, 1)");
        }
        page.evaluate("document.getElementById('headset').click()");
        page.until("yoro.busy === null && document.getElementById('headset').textContent === 'Enter VR'");
        assert_eq!(page.message(), None);
    }
    // The way walked is in the link.
    page.until("location.hash.includes('at=')");
    page.browser.expect_silence();
}

/// The desktop's pictures for a headset's views at the scene's first viewpoint.
fn headset_pictures(views: &[f32], size: [u32; 2]) -> [RgbImage; 2] {
    let headless = Headless::open(Backend::Egl).unwrap();
    let gl = headless.gl();
    let settings = RenderSettings::default();
    let scene = yoro_scenes::build("prototype", yoro_scenes::DEFAULT_SEED).unwrap();
    let mut prepared = PreparedScene::new(gl, scene, &settings).unwrap();
    let walker = yoro_web::Walker::new(prepared.scene.viewpoints[0].pose());
    let (left, right) = views.split_at(yoro_web::VIEW_FLOATS);
    let [left, right] = [left, right].map(|view| yoro_web::view(view).unwrap());
    let outwards = |frustum: &Frustum| frustum.left + frustum.right;
    assert!(outwards(&left.1) < -0.1 && outwards(&right.1) > 0.1, "{left:?}, {right:?}");
    let pair = EyePair {
        poses: [left.0, right.0].map(|pose| walker.locate(pose)),
        frusta: [left.1, right.1],
        depth: DepthRange { near: 0.1, ..DepthRange::PAPER },
        size,
        dominant: Eye::Right,
    };
    let options = StereoOptions { policy: None, ..StereoOptions::default() };
    let mut method = stereo::create(gl, Method::Conventional, &settings, &options).unwrap();
    let mut frame = StereoFrame::new(gl, size).unwrap();
    method.render(&mut prepared.renderer, &prepared.scene, &pair, &mut frame).unwrap();
    Eye::BOTH.map(|eye| rgb_image(&frame.eye(eye).read_rgba8(0, [0, 0], size), size))
}
