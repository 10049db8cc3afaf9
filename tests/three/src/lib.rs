//! The package for three.js: its shaders, and its pages opened in a browser.

pub mod shaders;

use std::env;
use std::fs;
use std::io::{self, Write as _};
use std::net::{Ipv4Addr, TcpListener, TcpStream};
use std::path::{Path, PathBuf};
use std::thread;

use yoro_files::http::{self, Request};
use yoro_test_support::browser::Browser;

/// WebGL without a GPU.
const GL: [&str; 4] =
    ["--disable-gpu", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"];

/// Returns the folder of the package.
pub fn package() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../app/engines/three")
}

/// Returns the folder of the npm packages that tests need, or `None` if they are to be skipped.
///
/// # Panics
/// If it is not known whether they are here.
pub fn modules() -> Option<PathBuf> {
    let modules = env::var_os("YORO_TEST_THREE").map(PathBuf::from);
    if modules.is_none() {
        let without = env::var_os("YORO_TEST_WITHOUT_THREE").is_some();
        assert!(
            without,
            "run `cargo xtask test --package yoro-three-tests`, or set YORO_TEST_WITHOUT_THREE=1"
        );
        eprintln!("LEFT OUT: three.js cannot be had here");
    }
    modules
}

/// Returns the script of the emulated headset, or `None` if it is to be skipped.
///
/// # Panics
/// If it is not known whether it is here.
pub fn emulator() -> Option<PathBuf> {
    let script = env::var_os("YORO_TEST_WEBXR").map(PathBuf::from);
    let without = env::var_os("YORO_TEST_WITHOUT_WEBXR").is_some();
    assert!(script.is_some() || without, "set YORO_TEST_WEBXR, or YORO_TEST_WITHOUT_WEBXR=1");
    script
}

/// Opens a page of the package's folder, once its scripts have set `ready`. The npm packages are its folder `modules`,
/// `made` is its folder `made`. `before` runs before the page's scripts. Returns `None` without a browser.
pub fn open(modules: &Path, made: &Path, page: &str, before: &str) -> Option<Browser> {
    let mut browser = Browser::start_with(&GL)?;
    let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, 0)).expect("a free port");
    let address = format!("http://localhost:{}", listener.local_addr().expect("an address").port());
    let folders = [("/modules/", modules.to_owned()), ("/made/", made.to_owned()), ("/", package())];
    thread::spawn(move || {
        for stream in listener.incoming().map_while(Result::ok) {
            let folders = folders.clone();
            // In a thread, since browsers keep some connections open without sending a request.
            thread::spawn(move || answer(stream, &folders));
        }
    });
    browser.allow(&address);
    if !before.is_empty() {
        browser.run_before_pages(before);
    }
    browser.go(&format!("{address}{page}"));
    browser.evaluate("new Promise((done) => { (function look() { globalThis.ready ? done() : setTimeout(look, 20); })(); })");
    Some(browser)
}

/// Answers without a content security policy, which would forbid an import map in the page.
fn answer(mut stream: TcpStream, folders: &[(&str, PathBuf)]) -> io::Result<()> {
    let request = Request::read(&stream)?;
    let target = request.target().unwrap_or_default();
    let inside = folders.iter().find_map(|(start, folder)| Some((folder, target.strip_prefix(start)?)));
    let file = inside.and_then(|(folder, rest)| http::find(folder, rest));
    let content = file.as_ref().and_then(|file| fs::read(file).ok());
    let status = if content.is_some() { "200 OK" } else { "404 Not Found" };
    let kind = file.as_deref().map_or("text/plain", http::kind);
    let body = content.unwrap_or_default();
    let head = format!(
        "HTTP/1.1 {status}\r\nContent-Type: {kind}\r\nContent-Length: {}\r\nConnection: close\r\n\r\n",
        body.len()
    );
    stream.write_all(&[head.into_bytes(), body].concat())?;
    stream.flush()
}
