//! `yoro serve` without a browser: who may connect, what ends a session, and what it streams of videos.

use std::fs;
use std::io::{BufRead as _, BufReader, Read as _, Write as _};
use std::net::TcpStream;
use std::path::Path;
use std::process::Stdio;
use std::time::{Duration, Instant};

use image::imageops;
use tungstenite::protocol::Role;
use tungstenite::{Message, WebSocket};
use xtask::maintain::monado::Running;
use yoro::eyes::{Eye, EyePair, Frustum, Pose};
use yoro_bench::streaming::Receiver;
use yoro_context::{Backend, Headless};
use yoro_media::video::{Decoder, Index, Reader};
use yoro_metrics::{Channels, psnr};
use yoro_stream::{EyeView, FromClient, FromServer, Report, VERSION, ViewRequest};

use crate::program::{folder, run, succeed, yoro};

/// A server, which is killed when this is dropped.
struct Serving {
    _child: Running,
    /// Address and port.
    host: String,
    token: String,
}

type Socket = WebSocket<TcpStream>;

impl Serving {
    /// Serves a source from a folder, which gets an empty page.
    fn start(at: &Path, source: &str) -> Serving {
        fs::write(at.join("index.html"), "").unwrap();
        let line = format!("serve {source} --page . --port 0 --max-size 96");
        let mut server = yoro(line.split_whitespace());
        let mut child = server.current_dir(at).stdout(Stdio::piped()).stderr(Stdio::null()).spawn().unwrap();
        let mut lines = BufReader::new(child.stdout.take().unwrap()).lines();
        let first = lines.next().expect("it says where it is").unwrap();
        std::thread::spawn(move || lines.for_each(drop));
        // Who listens at ::1 must not get the token.
        let host = first.strip_prefix("open http://").unwrap().split('/').next().unwrap().to_owned();
        assert!(host.starts_with("127.0.0.1:"), "{first}");
        let token = first.split(['=', '&']).nth(1).unwrap().to_owned();
        Serving { _child: Running(child), host, token }
    }

    /// Sends a request's lines after the first, and returns the beginning of the answer.
    fn ask(&self, first: &str, headers: &str) -> String {
        let mut stream = TcpStream::connect(&self.host).unwrap();
        let _ = write!(stream, "{first} HTTP/1.1\r\n{headers}\r\n");
        let mut answer = Vec::new();
        let mut piece = [0; 1000];
        while !answer.windows(4).any(|four| four == b"\r\n\r\n") {
            match stream.read(&mut piece) {
                Ok(0) | Err(_) => break,
                Ok(length) => answer.extend(&piece[..length]),
            }
        }
        String::from_utf8_lossy(&answer).into_owned()
    }

    /// Returns the headers of a request for a WebSocket, with these instead of host and origin.
    fn upgrade(headers: &str) -> String {
        format!(
            "{headers}Connection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\n\
             Sec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\n"
        )
    }

    /// Connects with the token. Returns the first answer, too.
    fn connect(&self) -> (Socket, Vec<u8>) {
        let mut stream = TcpStream::connect(&self.host).unwrap();
        stream.set_read_timeout(Some(Duration::from_secs(20))).unwrap();
        let headers = format!("Host: {0}\r\nOrigin: http://{0}\r\n", self.host);
        write!(stream, "GET /stream HTTP/1.1\r\n{}\r\n", Serving::upgrade(&headers)).unwrap();
        let mut head = Vec::new();
        while !head.ends_with(b"\r\n\r\n") {
            let mut byte = [0];
            stream.read_exact(&mut byte).unwrap();
            head.push(byte[0]);
        }
        assert!(head.starts_with(b"HTTP/1.1 101"), "{}", String::from_utf8_lossy(&head));
        let mut socket = WebSocket::from_raw_socket(stream, Role::Client, None);
        say(&mut socket, FromClient::hello(&self.token).unwrap());
        let answer = socket.read().unwrap().into_data().to_vec();
        (socket, answer)
    }

    /// Connects once the seat of a client before is free.
    fn connect_again(&self) -> Socket {
        let start = Instant::now();
        loop {
            let (socket, answer) = self.connect();
            if !matches!(FromServer::read(&answer), Some(FromServer::Refused(_))) {
                return socket;
            }
            assert!(start.elapsed() < Duration::from_secs(20), "it stays busy");
        }
    }
}

fn say(socket: &mut Socket, message: FromClient) {
    socket.send(Message::binary(message.to_bytes())).unwrap();
}

fn request(time_ms: f64, frustum: Frustum) -> ViewRequest {
    let eye = EyeView { pose: Pose::IDENTITY, frustum };
    let mut eyes = [eye; 2];
    eyes[1].pose.position.x += 0.063;
    ViewRequest { time_ms, eyes, dominant: Eye::Right, size: [64, 64] }
}

/// Returns the bytes of the next frame.
fn next(socket: &mut Socket) -> Option<Vec<u8>> {
    loop {
        match socket.read().ok()? {
            Message::Binary(bytes) => return Some(bytes.to_vec()),
            Message::Close(_) => return None,
            _ => {}
        }
    }
}

#[test]
fn only_what_browsers_send_is_served_beside_silent_clients() {
    let dir = tempfile::tempdir().unwrap();
    let serving = Serving::start(dir.path(), "prototype");
    let host = &serving.host;
    let page = serving.ask("GET /", &format!("Host: {host}\r\n")).to_ascii_lowercase();
    for header in
        ["x-content-type-options: nosniff", "referrer-policy: no-referrer", "frame-ancestors 'none'"]
    {
        assert!(page.contains(header), "{page}");
    }
    let own = format!("Host: {host}\r\nOrigin: http://{host}\r\n");
    let evil = "Host: evil.example\r\nOrigin: http://evil.example\r\n";
    let long = format!("Cookie: c={}{own}{evil}", "a".repeat(9000));
    for (first, headers, answer) in [
        ("GET /stream", own.clone(), "101"),
        ("POST /stream", own.clone(), "400"),
        ("GET /stream", evil.to_owned(), "403"),
        ("GET /stream", format!("{own}{evil}"), "403"),
        ("GET /stream", format!("Host: {host}\r\n{own}"), "403"),
        ("GET /stream", long, "403"),
    ] {
        let said = serving.ask(first, &Serving::upgrade(&headers));
        let wanted = format!("HTTP/1.1 {answer}");
        assert!(said.starts_with(&wanted), "{first} {:.80}: {said}", headers);
    }

    let silent: Vec<_> = (0..16).map(|_| TcpStream::connect(host).unwrap()).collect();
    let (mut socket, answer) = serving.connect();
    assert!(matches!(FromServer::read(&answer), Some(FromServer::Welcome(_))));
    drop(silent);
    // Proxies may send pings at any time, with any content.
    socket.send(Message::Ping(FromClient::Report(Report::default()).to_bytes().into())).unwrap();
    say(&mut socket, FromClient::Request(request(0.0, Frustum::symmetric(1.0, 1.0))));
    assert!(next(&mut socket).is_some());
    // A client whose first confirmation is lost gets more frames, however it goes on.
    let mut report = Report::default();
    for frame in 1..4 {
        say(&mut socket, FromClient::Request(request(f64::from(frame), Frustum::symmetric(1.0, 1.0))));
        let message = next(&mut socket).expect("the stream has ended");
        let Some(FromServer::Frame { number, .. }) = FromServer::read(&message) else { panic!("no frame") };
        assert_eq!(number, frame);
        report.arrived(number, f64::from(frame));
        report.decoded = Some(number);
        say(&mut socket, FromClient::Report(report));
    }
}

#[test]
fn eyes_that_would_need_too_many_pixels_end_the_session_alone() {
    let dir = tempfile::tempdir().unwrap();
    let serving = Serving::start(dir.path(), "prototype --mode eyes");
    // 0.06 degrees wide, 61 degrees to the side.
    let narrow = Frustum { left: 1.8, right: 1.8011, bottom: -0.0006, top: 0.0006 };
    let mut socket = serving.connect_again();
    say(&mut socket, FromClient::Request(request(0.0, narrow)));
    assert_eq!(next(&mut socket), None);
    let mut socket = serving.connect_again();
    say(&mut socket, FromClient::Request(request(0.0, Frustum::symmetric(1.0, 1.0))));
    assert!(next(&mut socket).is_some());
}

#[test]
fn videos_with_asymmetric_eyes_are_streamed() {
    let at = &folder();
    succeed(
        at,
        "render prototype --frames 1 --size 64x48 --half-angles-degrees 52,42 --video wide.mp4 --quantizer 12",
    );
    succeed(
        at,
        "render prototype --frames 1 --size 64x48 --half-angles-degrees 35,47 --video narrow.mp4 --quantizer 12",
    );
    let headless = Headless::open(Backend::Egl).unwrap();
    for name in ["wide.mp4", "narrow.mp4"] {
        let serving = Serving::start(at, name);
        let (mut socket, answer) = serving.connect();
        let Some(FromServer::Video(frusta, eye)) = FromServer::read(&answer) else { panic!("{name}") };
        let mut reader = Reader::open(&at.join(name)).unwrap();
        let rgbd = reader.rgbd().unwrap();
        let (color, _) = reader.read_rgbd().unwrap().unwrap();
        let [left, _] = rgbd.views().unwrap().dominant_crop;
        let own = imageops::crop_imm(&color, left, 0, rgbd.size[0], rgbd.size[1]).to_image();
        let mut receiver = Receiver::new(headless.gl()).unwrap();
        let (mut report, mut decoder, mut best) = (Report::default(), Decoder::new().unwrap(), 0.0);
        // The first picture is coarse.
        for time in 0..12 {
            say(&mut socket, FromClient::Request(request(f64::from(time), frusta[0])));
            let message = next(&mut socket).unwrap();
            let Some(FromServer::Frame { number, header, data, .. }) = FromServer::read(&message) else {
                panic!("{name}: no frame")
            };
            report.arrived(number, f64::from(time) * 40.0);
            report.decoded = Some(number);
            say(&mut socket, FromClient::Report(report));
            let planes = decoder.decode(data).unwrap();
            let pair = EyePair { frusta, ..rgbd.pair() };
            let eyes = receiver.eyes(&planes, &header.content, header.size, &pair).unwrap();
            best = psnr(&eyes[eye.index()], &own, Channels::Luma).unwrap().0;
        }
        println!("{name}: {best:.1} dB");
        assert!(best > 26.0, "{name}: {best} dB");
    }
}

#[test]
fn a_damaged_picture_is_left_out_and_a_video_without_a_whole_one_is_refused() {
    let at = &folder();
    succeed(at, "render prototype --frames 4 --size 64x48 --frame-rate 30 --video v.mp4");
    let mut file = fs::read(at.join("v.mp4")).unwrap();
    let length = file.len() as u64;
    let index = Index::read("v.mp4".as_ref(), &mut std::io::Cursor::new(&file), length).unwrap();
    let mut damage = |picture: usize| {
        let encoded = index.pictures[picture];
        file[encoded.offset as usize..][..encoded.size].fill(0xa5);
        fs::write(at.join("v.mp4"), &file).unwrap();
    };
    damage(2);
    let serving = Serving::start(at, "v.mp4");
    let (mut socket, _) = serving.connect();
    let mut report = Report::default();
    for frame in 0..6 {
        say(&mut socket, FromClient::Request(request(f64::from(frame), Frustum::symmetric(1.0, 1.0))));
        assert!(next(&mut socket).is_some(), "frame {frame}");
        report.arrived(frame, f64::from(frame));
        report.decoded = Some(frame);
        say(&mut socket, FromClient::Report(report));
    }
    drop(serving);
    damage(0);
    run(at, "serve v.mp4 --page . --port 0").refuses(&["v.mp4 cannot be read as a video"]);
}

#[test]
fn mistakes() {
    let at = &folder();
    fs::write(at.join("index.html"), "").unwrap();
    let refuses = |options: &str, naming: &[&str]| {
        run(at, &format!("serve prototype --page . {options}")).refuses(naming);
    };
    refuses("--lan=fe80::1", &["fe80::1", "one link", "--lan=ADDRESS"]);
    refuses("--lan=8.8.8.8", &["open to the internet"]);
    assert_eq!(VERSION, 4, "older clients are told to reload");
}
