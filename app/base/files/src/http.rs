//! Serves a folder's files over HTTP, for browsers on this machine or in its network.

use std::fs::File;
use std::io::{self, BufRead as _, BufReader, Read, Write};
use std::path::{Component, Path, PathBuf};

/// The content security policy of all responses. It lets a page connect to streams of other servers, too.
pub const POLICY: &str = "default-src 'self'; connect-src 'self' https:; script-src 'self' 'wasm-unsafe-eval'; object-src 'none'; base-uri 'none'; form-action 'none'";

/// The largest length of a request's line, in bytes.
const MAX_LINE: u64 = 8 << 10;
/// The largest number of lines in a request.
const MAX_LINES: usize = 100;

/// A request without its body.
pub struct Request(Vec<String>);

impl Request {
    /// Reads a request.
    ///
    /// # Errors
    /// Fails if the connection fails, or if the request is too long.
    pub fn read(connection: impl Read) -> io::Result<Request> {
        let mut reader = BufReader::new(connection);
        let mut lines = Vec::new();
        while lines.len() < MAX_LINES {
            let mut line = String::new();
            (&mut reader).take(MAX_LINE).read_line(&mut line)?;
            match line.trim_end() {
                "" => return Ok(Request(lines)),
                line => lines.push(line.to_owned()),
            }
        }
        Err(io::ErrorKind::InvalidData.into())
    }

    /// Returns the requested target, with its query.
    pub fn target(&self) -> Option<&str> {
        self.0.first()?.split(' ').nth(1)
    }

    /// Returns the value of a header.
    pub fn header(&self, name: &str) -> Option<&str> {
        let headers = self.0.iter().skip(1).filter_map(|line| line.split_once(':'));
        headers.into_iter().find(|(key, _)| key.eq_ignore_ascii_case(name)).map(|(_, value)| value.trim())
    }

    fn method(&self) -> Option<&str> {
        self.0.first()?.split(' ').next()
    }
}

/// Answers a request for a file in a folder.
///
/// # Errors
/// Fails if the connection fails.
pub fn answer(connection: &mut impl Write, request: &Request, folder: &Path) -> io::Result<()> {
    let found = match (request.method(), request.target()) {
        (Some("GET" | "HEAD"), Some(target)) => find(folder, target),
        _ => None,
    };
    let opened = found.and_then(|path| {
        let file = File::open(&path).ok()?;
        Some((kind(&path), file.metadata().ok()?.len(), Box::new(file) as Box<dyn Read>))
    });
    let missing = b"There is no such file.\n";
    let (status, (kind, length, body)) = match opened {
        Some(file) => ("200 OK", file),
        None => {
            ("404 Not Found", ("text/plain", missing.len() as u64, Box::new(&missing[..]) as Box<dyn Read>))
        }
    };
    // Sent in one piece, and so in one packet.
    let head = format!(
        "HTTP/1.1 {status}\r\nContent-Type: {kind}\r\nContent-Length: {length}\r\nCache-Control: no-cache\r\n\
         Content-Security-Policy: {POLICY}\r\nConnection: close\r\n\r\n"
    );
    connection.write_all(head.as_bytes())?;
    if request.method() != Some("HEAD") {
        io::copy(&mut body.take(length), connection)?;
    }
    connection.flush()
}

/// Returns the file that a request's target names; `None` if it is outside of the folder.
pub fn find(folder: &Path, target: &str) -> Option<PathBuf> {
    let path = Path::new(target.split(['?', '#']).next()?.trim_start_matches('/'));
    let inside = path.components().all(|component| matches!(component, Component::Normal(_)));
    let path = folder.join(path);
    inside.then(|| if path.is_dir() { path.join("index.html") } else { path })
}

/// Returns the content type of a file. Browsers do not run scripts without one.
pub fn kind(path: &Path) -> &'static str {
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
        assert_eq!(find(at, "/").unwrap(), at.join("index.html"));
        assert_eq!(find(at, "/a/b.js?x=/../..").unwrap(), at.join("a/b.js"));
        for outside in ["/../secret", "/a/../../secret", "/./../x"] {
            assert_eq!(find(at, outside), None, "{outside}");
        }
        assert_eq!(kind(Path::new("yoro_web_bg.wasm")), "application/wasm");
    }
}
