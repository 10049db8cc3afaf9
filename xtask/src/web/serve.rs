//! A server for the page's files, reachable only from this machine.

use std::io;
use std::net::{Ipv4Addr, TcpListener, TcpStream};
use std::path::Path;
use std::thread;
use std::time::Duration;

use anyhow::Context as _;
use yoro_files::http::{self, Request};

/// Serves a folder until the program is ended.
pub fn serve(folder: &Path, port: u16) -> anyhow::Result<()> {
    let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, port))
        .with_context(|| format!("port {port} cannot be served: name another one with --port"))?;
    let port = listener.local_addr().map_or(port, |address| address.port());
    crate::console::print(&format!(
        "serving on http://localhost:{port}/ until Ctrl-C\n\
         on a phone or headset by cable: adb reverse tcp:{port} tcp:{port}, then the same address there\n"
    ));
    let answer = |mut stream: TcpStream, folder: &Path| {
        stream.set_read_timeout(Some(Duration::from_secs(10)))?;
        let request = Request::read(&stream)?;
        http::answer(&mut stream, &request, folder)
    };
    for stream in listener.incoming() {
        let folder = folder.to_owned();
        // In a thread, since browsers keep some connections open without sending a request.
        thread::spawn(move || -> io::Result<()> { answer(stream?, &folder) });
    }
    Ok(())
}
