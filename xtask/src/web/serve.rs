//! A server for the page's files, for this machine alone.

use std::fs;
use std::io::{self, BufRead as _, BufReader, Read as _, Write as _};
use std::net::{Ipv4Addr, TcpListener, TcpStream};
use std::path::{Component, Path, PathBuf};
use std::thread;
use std::time::Duration;

use anyhow::Context as _;

use super::site::POLICY;

/// The longest line of a request that is read, in bytes.
const MAX_LINE: u64 = 8 << 10;

/// Serves a folder until the program is ended.
///
/// # Errors
/// When the port is taken.
pub fn serve(folder: &Path, port: u16) -> anyhow::Result<()> {
    let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, port))
        .with_context(|| format!("port {port} cannot be served: name another one with --port"))?;
    let port = listener.local_addr().map_or(port, |address| address.port());
    yoro_tools::console::print(&format!(
        "serving on http://localhost:{port}/ until Ctrl-C\n\
         on a phone or headset by cable: adb reverse tcp:{port} tcp:{port}, then the same address there\n"
    ));
    for stream in listener.incoming() {
        let folder = folder.to_owned();
        // A browser keeps some connections open without asking for anything.
        thread::spawn(move || stream.and_then(|stream| answer(stream, &folder)));
    }
    Ok(())
}

fn answer(mut stream: TcpStream, folder: &Path) -> io::Result<()> {
    stream.set_read_timeout(Some(Duration::from_secs(10)))?;
    let mut reader = BufReader::new(stream.try_clone()?);
    let mut request = String::new();
    (&mut reader).take(MAX_LINE).read_line(&mut request)?;
    let mut line = String::new();
    while (&mut reader).take(MAX_LINE).read_line(&mut line)? > 2 {
        line.clear();
    }
    let mut words = request.split_whitespace();
    let found = match (words.next(), words.next()) {
        (Some("GET" | "HEAD"), Some(target)) => file(folder, target),
        _ => None,
    };
    let (status, kind, body) = match found.and_then(|path| Some((kind(&path), fs::read(path).ok()?))) {
        Some((kind, body)) => ("200 OK", kind, body),
        None => ("404 Not Found", "text/plain", b"There is no such file.\n".to_vec()),
    };
    write!(
        stream,
        "HTTP/1.1 {status}\r\nContent-Type: {kind}\r\nContent-Length: {}\r\nCache-Control: no-cache\r\n\
         Content-Security-Policy: {POLICY}\r\nConnection: close\r\n\r\n",
        body.len()
    )?;
    if !request.starts_with("HEAD") {
        stream.write_all(&body)?;
    }
    stream.flush()
}

/// Returns the file that a request's target names; none outside of the folder.
fn file(folder: &Path, target: &str) -> Option<PathBuf> {
    let path = Path::new(target.split(['?', '#']).next()?.trim_start_matches('/'));
    let inside = path.components().all(|component| matches!(component, Component::Normal(_)));
    let path = folder.join(path);
    inside.then(|| if path.is_dir() { path.join("index.html") } else { path })
}

/// The content type of a file: browsers run nothing without one.
fn kind(path: &Path) -> &'static str {
    match path.extension().and_then(|extension| extension.to_str()) {
        Some("html") => "text/html; charset=utf-8",
        Some("css") => "text/css; charset=utf-8",
        Some("js") => "text/javascript; charset=utf-8",
        Some("wasm") => "application/wasm",
        Some("svg") => "image/svg+xml",
        Some("jpg") => "image/jpeg",
        Some("webmanifest") => "application/manifest+json",
        _ => "application/octet-stream",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_outside_of_the_folder_is_served() {
        let folder = tempfile::tempdir().unwrap();
        let at = folder.path();
        assert_eq!(file(at, "/").unwrap(), at.join("index.html"));
        assert_eq!(file(at, "/a/b.js?x=/../..").unwrap(), at.join("a/b.js"));
        for outside in ["/../secret", "/a/../../secret", "/./../x"] {
            assert_eq!(file(at, outside), None, "{outside}");
        }
        assert_eq!(kind(Path::new("yoro_web_bg.wasm")), "application/wasm");
    }
}
