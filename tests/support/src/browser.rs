//! A real browser, controlled by Chromium's DevTools protocol over a pipe.

use std::env;
use std::io::{BufRead as _, BufReader, Write as _};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdin, Command, Stdio};
use std::sync::mpsc::{Receiver, channel};
use std::time::Duration;

use serde_json::{Value, json};

/// Names under which distributions install the browser.
const PROGRAMS: [&str; 4] = ["chromium", "chromium-browser", "google-chrome", "google-chrome-stable"];

/// Timeout of an answer.
const TIMEOUT: Duration = Duration::from_secs(120);

/// A browser with one page.
pub struct Browser {
    child: Child,
    commands: ChildStdin,
    messages: Receiver<Value>,
    /// The session of the page, once it is open.
    session: Option<String>,
    last_id: u64,
    loads: usize,
    /// The addresses from which pages may load, in addition to files.
    servers: Vec<String>,
    /// Warnings, and everything that scripts have written to the console.
    console: Vec<String>,
    /// Exceptions of scripts, and files that the page could not load.
    errors: Vec<String>,
    _profile: tempfile::TempDir,
}

impl Browser {
    /// Starts the browser in `YORO_TEST_CHROMIUM`, or one in PATH. If there is none, prints a message and returns
    /// `None`; the test should then end.
    pub fn start() -> Option<Browser> {
        Browser::start_with(&["--disable-gpu"])
    }

    /// Starts the browser as [`Browser::start`] does, with these options instead of those for pages without graphics.
    pub fn start_with(options: &[&str]) -> Option<Browser> {
        let Some(program) = find() else {
            eprintln!(
                "SKIPPED: no Chromium here, so that no page was opened; install it, or set YORO_TEST_CHROMIUM"
            );
            return None;
        };
        let profile = tempfile::tempdir().unwrap();
        // Chromium reads commands from descriptor 3 and writes answers to 4.
        let mut child = Command::new("sh")
            .args(["-c", "exec \"$0\" \"$@\" 3<&0 4>&1 1>&2"])
            .arg(program)
            .args(["--headless=new", "--no-sandbox", "--no-first-run", "--remote-debugging-pipe"])
            .args(options)
            .arg(format!("--user-data-dir={}", profile.path().display()))
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .expect("the browser starts");
        let commands = child.stdin.take().unwrap();
        let mut output = BufReader::new(child.stdout.take().unwrap());
        let (sender, messages) = channel();
        std::thread::spawn(move || {
            let mut message = Vec::new();
            while output.read_until(0, &mut message).is_ok_and(|length| length > 0) {
                message.pop();
                let parsed = serde_json::from_slice(&message);
                message.clear();
                if parsed.is_ok_and(|message| sender.send(message).is_err()) {
                    break;
                }
            }
        });
        let mut browser = Browser {
            child,
            commands,
            messages,
            session: None,
            last_id: 0,
            loads: 0,
            servers: Vec::new(),
            console: Vec::new(),
            errors: Vec::new(),
            _profile: profile,
        };
        let target = browser.call("Target.createTarget", json!({ "url": "about:blank" }));
        let attach = json!({ "targetId": target["targetId"], "flatten": true });
        let session = browser.call("Target.attachToTarget", attach);
        browser.session = session["sessionId"].as_str().map(str::to_owned);
        for domain in ["Page", "Runtime", "Log", "Network"] {
            browser.call(&format!("{domain}.enable"), json!({}));
        }
        Some(browser)
    }

    /// Calls a method of the protocol, and returns its result.
    #[track_caller]
    fn call(&mut self, method: &str, parameters: Value) -> Value {
        self.last_id += 1;
        let mut message = json!({ "id": self.last_id, "method": method, "params": parameters });
        if let Some(session) = &self.session {
            message["sessionId"] = json!(session);
        }
        let mut bytes = message.to_string().into_bytes();
        bytes.push(0);
        self.commands.write_all(&bytes).expect("the browser listens");
        loop {
            let message = self.receive();
            if message["id"] == json!(self.last_id) {
                assert!(message.get("error").is_none(), "{method}: {message}");
                return message["result"].clone();
            }
        }
    }

    /// Returns the next message. Records events about errors and loading.
    fn receive(&mut self) -> Value {
        let message = self.messages.recv_timeout(TIMEOUT).expect("the browser answers");
        let parameters = &message["params"];
        match message["method"].as_str() {
            Some("Page.loadEventFired") => self.loads += 1,
            Some("Runtime.exceptionThrown") => self.errors.push(parameters["exceptionDetails"].to_string()),
            Some("Log.entryAdded") if parameters["entry"]["level"] == "error" => {
                self.errors.push(parameters["entry"].to_string());
            }
            Some("Log.entryAdded") => self.console.push(parameters["entry"].to_string()),
            Some("Runtime.consoleAPICalled") => self.console.push(parameters["args"].to_string()),
            Some("Network.requestWillBeSent") => {
                let url = parameters["request"]["url"].as_str().unwrap_or_default();
                let own = ["file://", "data:", "about:", "blob:"].iter().any(|start| url.starts_with(start))
                    || self.servers.iter().any(|server| url.starts_with(server));
                if !own {
                    self.errors.push(format!("the page asks for {url}"));
                }
            }
            _ => {}
        }
        message
    }

    /// Opens a file, and waits until everything on the page is loaded.
    pub fn open(&mut self, page: &Path) {
        self.go(&format!("file://{}", page.canonicalize().unwrap().display()));
    }

    /// Allows pages to load from an address.
    pub fn allow(&mut self, server: &str) {
        self.servers.push(server.to_owned());
    }

    /// Runs a script in each page before the page's own scripts.
    pub fn run_before_pages(&mut self, script: &str) {
        self.call("Page.addScriptToEvaluateOnNewDocument", json!({ "source": script }));
    }

    /// Opens an address, and waits until everything on the page is loaded.
    pub fn go(&mut self, url: &str) {
        let loads = self.loads;
        self.call("Page.navigate", json!({ "url": url }));
        while self.loads == loads {
            self.receive();
        }
    }

    /// Returns the value of a JavaScript expression.
    #[track_caller]
    pub fn evaluate(&mut self, expression: &str) -> Value {
        let parameters = json!({
            "expression": expression,
            "returnByValue": true,
            "awaitPromise": true,
            // Counts as a click, without which browsers refuse some calls.
            "userGesture": true,
        });
        let result = self.call("Runtime.evaluate", parameters);
        assert!(result.get("exceptionDetails").is_none(), "{expression}: {result}");
        result["result"]["value"].clone()
    }

    /// Clicks on the centre of the element that an expression returns.
    #[track_caller]
    pub fn click(&mut self, element: &str) {
        let place = self.evaluate(&format!(
            "(() => {{ const e = {element}; e.scrollIntoView({{block: 'center'}}); const b = e.getBoundingClientRect(); \
             return [b.left + b.width / 2, b.top + b.height / 2]; }})()"
        ));
        for kind in ["mousePressed", "mouseReleased"] {
            let event =
                json!({ "type": kind, "x": place[0], "y": place[1], "button": "left", "clickCount": 1 });
            self.call("Input.dispatchMouseEvent", event);
        }
    }

    /// Moves the pointer to a place in the window.
    pub fn point(&mut self, x: f64, y: f64) {
        self.call("Input.dispatchMouseEvent", json!({ "type": "mouseMoved", "x": x, "y": y }));
    }

    /// Presses and releases a key that types a character.
    pub fn press(&mut self, key: &str) {
        self.call("Input.dispatchKeyEvent", json!({ "type": "keyDown", "key": key, "text": key }));
        self.call("Input.dispatchKeyEvent", json!({ "type": "keyUp", "key": key }));
    }

    /// Holds down a key for some time. The key is given by its place on the keyboard, such as `KeyW`.
    pub fn hold(&mut self, code: &str, time: Duration) {
        self.call("Input.dispatchKeyEvent", json!({ "type": "keyDown", "code": code }));
        std::thread::sleep(time);
        self.call("Input.dispatchKeyEvent", json!({ "type": "keyUp", "code": code }));
    }

    /// Changes the window's size in pixels.
    pub fn resize(&mut self, width: u32, height: u32) {
        let size = json!({ "width": width, "height": height, "deviceScaleFactor": 1, "mobile": false });
        self.call("Emulation.setDeviceMetricsOverride", size);
    }

    /// Sets the page's width in pixels, and its colour scheme to `light` or `dark`.
    pub fn show(&mut self, width: u32, scheme: &str) {
        self.resize(width, 900);
        let features = json!([{ "name": "prefers-color-scheme", "value": scheme }]);
        self.call("Emulation.setEmulatedMedia", json!({ "features": features }));
    }

    /// Discards the messages and errors that a test has caused on purpose.
    pub fn forget(&mut self) {
        self.evaluate("0");
        self.console.clear();
        self.errors.clear();
    }

    /// Fails if a script threw an exception or something could not be loaded.
    #[track_caller]
    pub fn expect_no_error(&mut self) {
        // Pending events arrive before this answer.
        self.evaluate("0");
        assert!(self.errors.is_empty(), "{:#?}", self.errors);
    }

    /// Fails if a script threw an exception, something could not be loaded, or there is anything in the console.
    #[track_caller]
    pub fn expect_silence(&mut self) {
        self.expect_no_error();
        assert!(self.console.is_empty(), "{:#?}", self.console);
    }
}

impl Browser {
    /// Fails as [`Browser::expect_silence`] does, except for lines in the console that contain a word.
    #[track_caller]
    pub fn expect_silence_but(&mut self, word: &str) {
        self.expect_no_error();
        self.console.retain(|line| !line.contains(word));
        assert!(self.console.is_empty(), "{:#?}", self.console);
    }
}

impl Drop for Browser {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

fn find() -> Option<PathBuf> {
    if let Some(program) = env::var_os("YORO_TEST_CHROMIUM") {
        return Some(program.into());
    }
    let folders: Vec<PathBuf> = env::split_paths(&env::var_os("PATH")?).collect();
    PROGRAMS
        .iter()
        .find_map(|name| folders.iter().map(|folder| folder.join(name)).find(|path| path.is_file()))
}

/// Checks what every report must do in a browser: no script errors, nothing loaded from elsewhere, all plots present,
/// values under the pointer, series that the legend hides, tables and plots as CSV, other colours in dark mode, and no part
/// wider than a narrow window.
pub fn check_report(browser: &mut Browser, page: &Path) {
    browser.run_before_pages(
        "Object.defineProperty(navigator, 'clipboard', { value: { writeText: async text => { window.copied = text; } } })",
    );
    browser.show(1400, "light");
    browser.open(page);
    browser.expect_no_error();
    let plots =
        "[...document.querySelectorAll('.drawing > svg')].filter(s => !s.closest('details:not([open])'))";
    assert!(browser.evaluate(&format!("{plots}.length")).as_u64().unwrap() > 0, "no plot");
    let flat = format!("{plots}.filter(s => s.getBoundingClientRect().height < 50).length");
    assert_eq!(browser.evaluate(&flat), 0, "plots without height");
    check_plot(browser);

    browser.click("document.querySelector('figure .copy')");
    let plot = browser.evaluate("window.copied");
    assert!(
        plot.as_str().unwrap().starts_with("series,") && plot.as_str().unwrap().lines().count() > 1,
        "{plot}"
    );
    browser.click("document.querySelector('td').closest('table').querySelector('.copy')");
    let table = browser.evaluate("window.copied").as_str().unwrap().to_owned();
    let head = "document.querySelector('td').closest('table').querySelector('th').textContent";
    let head = browser.evaluate(head).as_str().unwrap().to_owned();
    assert!(table.starts_with(&format!("{head},")) && table.lines().count() > 1, "{table}");

    let colors = "JSON.stringify([getComputedStyle(document.body).backgroundColor, \
                  getComputedStyle(document.querySelector('.drawing svg text')).fill])";
    let light = browser.evaluate(colors);
    browser.show(400, "dark");
    let dark = browser.evaluate(colors);
    assert_ne!(light, dark, "a dark page has dark colours");
    let wide = browser.evaluate("document.documentElement.scrollWidth");
    assert!(wide.as_u64().unwrap() <= 400, "the page is {wide} pixels wide in a window of 400");
    browser.expect_no_error();
}

/// Checks that a plot shows the value under the pointer, and that its legend hides a series.
fn check_plot(browser: &mut Browser) {
    let figure = "document.querySelector('figure')";
    let shown = format!(
        "{figure}.querySelector('output').hidden ? null : {figure}.querySelector('output').textContent"
    );
    let last = format!(
        "(() => {{ const f = {figure}, p = JSON.parse(f.querySelector('script').textContent).points.at(-1); f.scrollIntoView(); \
         const s = f.querySelector('.drawing svg'), b = s.getBoundingClientRect(), k = b.width / s.viewBox.baseVal.width; \
         return [b.left + k * p.at[0], b.top + k * p.at[1], p.series, p.x]; }})()"
    );
    let place = browser.evaluate(&last);
    browser.point(place[0].as_f64().unwrap(), place[1].as_f64().unwrap());
    let value = browser.evaluate(&shown);
    let needed = format!("{:.1}", place[3].as_f64().unwrap().abs());
    let number = needed.split('.').next().unwrap();
    assert!(value.as_str().is_some_and(|text| text.contains(number)), "{value} has no {number}");
    let series = &place[2];
    browser.click(&format!("{figure}.querySelectorAll('.legend button')[{series}]"));
    let group = format!("getComputedStyle({figure}.querySelector('g[data-series=\"{series}\"]')).display");
    assert_eq!(browser.evaluate(&group), "none", "a click on the legend hides the series");
    let place = browser.evaluate(&last);
    browser.point(place[0].as_f64().unwrap(), place[1].as_f64().unwrap());
    assert_ne!(browser.evaluate(&shown), value, "what is hidden has no values");
    browser.click(&format!("{figure}.querySelectorAll('.legend button')[{series}]"));
    assert_ne!(browser.evaluate(&group), "none", "another click shows it again");
}

/// Checks the same as [`check_report`], and that all pictures load and can be switched by mouse and keyboard.
pub fn check_report_with_pictures(browser: &mut Browser, page: &Path) {
    check_report(browser, page);
    browser.show(1400, "light");
    browser.open(page);
    let broken = "[...document.images].filter(i => !i.complete || i.naturalWidth === 0).length";
    assert!(browser.evaluate("document.images.length").as_u64().unwrap() > 0, "no picture");
    assert_eq!(browser.evaluate(broken), 0, "pictures that do not load");

    let shown = "[...document.querySelectorAll('.viewer .stack')].map(s => [...s.children].map(\
                 i => getComputedStyle(i).visibility === 'visible').map(Number).join(''))[0]";
    let viewers = browser.evaluate(shown);
    let first = viewers.as_str().unwrap().to_owned();
    assert!(first.len() >= 4 && first.starts_with("10") && first.matches('1').count() == 1, "{first}");
    let caption = "document.querySelector('.viewer .caption').textContent";
    let before = browser.evaluate(caption);
    browser.click("document.querySelector('.viewer .bar button:nth-child(2)')");
    let second = browser.evaluate(shown);
    assert!(second.as_str().unwrap().starts_with("010"), "a click shows the second picture: {second}");
    assert_ne!(browser.evaluate(caption), before, "and its caption");
    browser.press("3");
    assert!(browser.evaluate(shown).as_str().unwrap().starts_with("0010"), "key 3 shows the third picture");
    browser.press("f");
    assert_eq!(browser.evaluate(shown), second, "key f goes back");
    browser.press("s");
    let other = "document.querySelector('.viewer .other')?.naturalWidth ?? 0";
    assert!(browser.evaluate(other).as_u64().unwrap() > 0, "key s shows both eyes");
    browser.expect_no_error();
}
