//! A client of `yoro serve`: a thread with the connection and the decoder.

use std::fmt;
#[cfg(target_os = "android")]
use std::sync::Arc;
#[cfg(target_os = "android")]
use yoro_viewer::StreamExchange;

use yoro_stream::FromClient;

/// The part of the address printed by `yoro serve` that precedes the token.
const MARK: &str = "#stream=";
/// Names of this machine, which lead to the other end of the cable through `adb reverse`.
const OWN_NAMES: [&str; 2] = ["localhost", "127.0.0.1"];
const BY_CABLE: &str = "yoro takes a stream by cable only: start yoro serve without --lan, run adb reverse tcp:8080 tcp:8080, \
    and share the address that it prints.";

/// Where a stream is served, and the message that admits a client.
#[derive(Clone, Debug, PartialEq)]
pub struct Address {
    /// The server's own name, with the port.
    host: String,
    port: u16,
    hello: FromClient,
}

impl fmt::Display for Address {
    /// Writes the address without the token, which must not get into the log.
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(&self.host)
    }
}

/// Finds the address of a stream among the words of a text.
///
/// # Errors
/// A sentence with the remedy, for a stream that this application cannot show.
pub fn find(text: &str) -> Option<Result<Address, String>> {
    let word = text.split_whitespace().find(|word| word.contains(MARK))?;
    let (place, token) = word.split_once(MARK)?;
    let token = token.split('&').next()?.trim_end_matches(|c: char| !c.is_ascii_hexdigit());
    let address = || {
        // Without the cable, others could read the token and the picture.
        let host = place.split_once("http://").ok_or(BY_CABLE)?.1.trim_end_matches('/');
        let (name, port) = host.split_once(':').unwrap_or((host, "80"));
        let port = port.parse().ok().filter(|_| OWN_NAMES.contains(&name)).ok_or(BY_CABLE)?;
        let hello = FromClient::hello(token)
            .ok_or("The address of the stream is not whole: share the one that yoro serve prints.")?;
        Ok(Address { host: host.to_owned(), port, hello })
    };
    Some(address().map_err(|sentence: &str| sentence.to_owned()))
}

/// How a decoder's buffer stores a picture, in bytes and rows; 0 if the decoder does not say.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Layout {
    /// `COLOR_Format*` of MediaCodecInfo.
    pub color: i32,
    /// Bytes from one row of luma to the next.
    pub stride: usize,
    /// Rows from the first row of luma to the first row of chroma.
    pub rows: usize,
}

/// `COLOR_FormatYUV420Planar`: three planes.
const PLANAR: i32 = 19;
/// `COLOR_FormatYUV420SemiPlanar`, and Qualcomm's: the samples of both chroma planes alternate.
const SEMI_PLANAR: [i32; 2] = [21, 0x7fa3_0c00];

impl Layout {
    /// Copies a picture of this size, both even, into three planes, one after another and tightly packed.
    ///
    /// # Errors
    /// A sentence for an unknown format or a buffer that is too short.
    pub fn pack(&self, buffer: &[u8], [width, height]: [usize; 2], to: &mut Vec<u8>) -> Result<(), String> {
        let (stride, rows) = (self.stride.max(width), self.rows.max(height));
        if self.color != PLANAR && !SEMI_PLANAR.contains(&self.color) {
            return Err(format!(
                "This device decodes video in the format {:#x}, which yoro does not know.",
                self.color
            ));
        }
        to.clear();
        let mut copy = |start: usize, stride: usize, [width, height]: [usize; 2], step: usize| {
            for row in 0..height {
                let line = buffer.get(start + row * stride..)?.get(..(width - 1) * step + 1)?;
                if step == 1 {
                    to.extend_from_slice(line);
                } else {
                    to.extend(line.iter().step_by(step));
                }
            }
            Some(())
        };
        let (chroma, half) = (stride * rows, [width / 2, height / 2]);
        let mut copy_all = || {
            copy(0, stride, [width, height], 1)?;
            if self.color == PLANAR {
                let stride = stride.div_ceil(2);
                copy(chroma, stride, half, 1)?;
                copy(chroma + stride * rows.div_ceil(2), stride, half, 1)
            } else {
                copy(chroma, stride, half, 2)?;
                copy(chroma + 1, stride, half, 2)
            }
        };
        copy_all().ok_or_else(|| "A decoded picture is smaller than it should be.".into())
    }
}

/// Follows a stream until the returned value has no other owner.
#[cfg(target_os = "android")]
pub fn follow(address: Address) -> Arc<StreamExchange> {
    let exchange = Arc::<StreamExchange>::default();
    let to = exchange.clone();
    let thread = std::thread::Builder::new().name("yoro-stream".into());
    if let Err(error) = thread.spawn(move || client::run(&address, &to)) {
        exchange.say(&format!("There is no thread for the stream ({error})."));
    }
    exchange
}

#[cfg(target_os = "android")]
mod client {
    use std::collections::VecDeque;
    use std::io::{self, ErrorKind, Read as _, Write as _};
    use std::net::{Ipv4Addr, TcpStream};
    use std::sync::Arc;
    use std::thread;
    use std::time::{Duration, Instant};

    use tungstenite::protocol::Role;
    use tungstenite::{Message, WebSocket};
    use yoro_stream::{FrameHeader, FromClient, FromServer, Refusal};
    use yoro_viewer::StreamExchange;

    use super::Address;
    use crate::decoder::Decoder;

    /// The longest wait for data before other work is done.
    const TICK: Duration = Duration::from_millis(4);
    /// The longest wait for the server's answer.
    const ANSWER_TIMEOUT: Duration = Duration::from_secs(3);
    /// The wait before a lost connection is retried.
    const RETRY_DELAY: Duration = Duration::from_secs(1);
    /// If no frame is drawn for this long, the connection ends, so that another client can use the stream.
    const IDLE_TIMEOUT: Duration = Duration::from_secs(1);
    /// The longest answer to the WebSocket upgrade, in bytes.
    const MAX_ANSWER_BYTES: usize = 4096;
    /// If the decoder fails before this many pictures, the connection is not retried.
    const TRUSTED_AFTER: u32 = 30;

    /// Why a connection has ended.
    enum End {
        /// No frames are being drawn.
        Unseen,
        /// The connection is to be retried.
        Again(String),
        /// Retrying would end in the same way.
        ForGood(String),
    }

    impl From<tungstenite::Error> for End {
        fn from(error: tungstenite::Error) -> End {
            log::info!("stream: {error}");
            End::Again("The connection to the server is lost; it is tried again each second.".into())
        }
    }

    /// Keeps a connection while frames are drawn.
    pub fn run(address: &Address, exchange: &Arc<StreamExchange>) {
        let mut said = String::new();
        while is_wanted(exchange) {
            if exchange.take_request(IDLE_TIMEOUT).is_none() {
                continue;
            }
            let end = connect(address).and_then(|socket| follow(socket, exchange));
            let (sentence, is_over) = match end {
                Ok(()) | Err(End::Unseen) => continue,
                Err(End::Again(sentence)) => (sentence, false),
                Err(End::ForGood(sentence)) => (sentence, true),
            };
            if sentence != said {
                log::warn!("stream: {sentence}");
            }
            exchange.say(&sentence);
            said = sentence;
            if is_over {
                return;
            }
            thread::sleep(RETRY_DELAY);
        }
    }

    fn is_wanted(exchange: &Arc<StreamExchange>) -> bool {
        Arc::strong_count(exchange) > 1
    }

    type Socket = WebSocket<TcpStream>;

    /// Connects and sends the hello.
    fn connect(address: &Address) -> Result<Socket, End> {
        let Address { host, port, hello } = address;
        let unanswered = |error: &dyn std::fmt::Display| {
            log::info!("stream: {error}");
            End::Again(format!(
                "The server does not answer; it is tried again each second. Does yoro serve run, and adb reverse tcp:{port} \
                 tcp:{port}?"
            ))
        };
        let tcp = TcpStream::connect((Ipv4Addr::LOCALHOST, *port)).map_err(|error| unanswered(&error))?;
        let timeouts =
            tcp.set_read_timeout(Some(ANSWER_TIMEOUT)).and(tcp.set_write_timeout(Some(ANSWER_TIMEOUT)));
        timeouts.and(tcp.set_nodelay(true)).map_err(tungstenite::Error::Io)?;
        upgrade(&tcp, host).map_err(|error| unanswered(&error))?;
        let mut socket = WebSocket::from_raw_socket(tcp, Role::Client, None);
        socket.send(Message::binary(hello.to_bytes()))?;
        Ok(socket)
    }

    /// Requests the upgrade to WebSocket. The key only protects against caches on the way, of which there are none.
    fn upgrade(mut tcp: &TcpStream, host: &str) -> io::Result<()> {
        let request = format!(
            "GET /stream HTTP/1.1\r\nHost: {host}\r\nOrigin: http://{host}\r\nUpgrade: websocket\r\n\
             Connection: Upgrade\r\nSec-WebSocket-Version: 13\r\nSec-WebSocket-Key: eW9ybyB5b3JvIHlvcm8geQ==\r\n\r\n"
        );
        tcp.write_all(request.as_bytes())?;
        let mut answer = Vec::new();
        while !answer.ends_with(b"\r\n\r\n") && answer.len() < MAX_ANSWER_BYTES {
            let mut byte = [0];
            tcp.read_exact(&mut byte)?;
            answer.extend(byte);
        }
        if answer.starts_with(b"HTTP/1.1 101 ") {
            Ok(())
        } else {
            Err(io::Error::other("it does not speak WebSocket"))
        }
    }

    /// Receives frames and requests more.
    fn follow(mut socket: Socket, exchange: &Arc<StreamExchange>) -> Result<(), End> {
        match FromServer::read(&socket.read()?.into_data()) {
            Some(FromServer::Welcome(home)) => exchange.welcome(home),
            Some(FromServer::Video(..)) => {
                return Err(End::ForGood("The server plays a video: open its address in a browser.".into()));
            }
            Some(FromServer::Refused(Refusal::Busy)) => return Err(End::Again(Refusal::Busy.to_string())),
            Some(FromServer::Refused(refusal)) => return Err(End::ForGood(refusal.to_string())),
            _ => return Err(End::ForGood(Refusal::Version.to_string())),
        }
        log::info!("stream: connected");
        socket.get_ref().set_read_timeout(Some(TICK)).map_err(tungstenite::Error::Io)?;
        let (mut pictures, mut asked) = (Pictures::default(), Instant::now());
        loop {
            match socket.read() {
                Ok(Message::Binary(bytes)) => {
                    if let Some(FromServer::Frame { number, intra, header, data }) = FromServer::read(&bytes)
                    {
                        pictures.decode(number, intra, header, data)?;
                    }
                }
                Err(tungstenite::Error::Io(error))
                    if matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::TimedOut) => {}
                other => drop(other?),
            }
            while let Some((number, header)) = pictures.next()? {
                exchange.put(header, &mut pictures.planes);
                socket.send(Message::binary(FromClient::Decoded(number).to_bytes()))?;
            }
            if let Some(request) = exchange.take_request(Duration::ZERO) {
                socket.send(Message::binary(FromClient::Request(request).to_bytes()))?;
                asked = Instant::now();
            } else if asked.elapsed() > IDLE_TIMEOUT || !is_wanted(exchange) {
                return Err(End::Unseen);
            }
        }
    }

    /// The pictures of a connection.
    #[derive(Default)]
    struct Pictures {
        decoder: Option<Decoder>,
        /// The frames that are being decoded.
        headers: VecDeque<(u32, FrameHeader)>,
        planes: Vec<u8>,
        count: u32,
    }

    impl Pictures {
        /// Passes a frame to the decoder, which is started for the first frame and for each new size.
        fn decode(&mut self, number: u32, intra: bool, header: FrameHeader, data: &[u8]) -> Result<(), End> {
            let [column, rows] = header.size.map(|n| usize::from(n).next_multiple_of(2));
            let size = [header.content.parts() as usize * column, rows];
            if self.decoder.as_ref().is_none_or(|decoder| decoder.size() != size) {
                if !intra {
                    return Ok(());
                }
                self.headers.clear();
                self.decoder = None;
                self.decoder = Some(Decoder::new(size).map_err(|reason| self.failed(&reason))?);
            }
            let decoder = self.decoder.as_mut().expect("it has just been made");
            self.headers.push_back((number, header));
            decoder.decode(number, data).map_err(|reason| self.failed(&reason))
        }

        /// Returns the next decoded frame; its picture is in `planes`.
        fn next(&mut self) -> Result<Option<(u32, FrameHeader)>, End> {
            let Some(decoder) = &mut self.decoder else { return Ok(None) };
            let decoded = decoder.next(&mut self.planes).map_err(|reason| self.failed(&reason))?;
            let Some(number) = decoded else { return Ok(None) };
            self.count += 1;
            let at = self.headers.iter().position(|(other, _)| *other == number);
            Ok(at.and_then(|at| self.headers.drain(..=at).next_back()))
        }

        fn failed(&self, reason: &str) -> End {
            let sentence = format!("The stream cannot be decoded: {reason}");
            if self.count < TRUSTED_AFTER { End::ForGood(sentence) } else { End::Again(sentence) }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TOKEN: &str = "00112233445566778899aabbccddeeff";

    #[test]
    fn a_stream_is_found_among_words_and_taken_by_cable_only() {
        let hello = FromClient::hello(TOKEN).unwrap();
        for (text, host, port) in [
            (
                format!("open http://localhost:8080/#stream={TOKEN}&display=side-by-side"),
                "localhost:8080",
                8080,
            ),
            (format!("(http://127.0.0.1:99/#stream={TOKEN})."), "127.0.0.1:99", 99),
        ] {
            assert_eq!(find(&text), Some(Ok(Address { host: host.into(), port, hello })));
        }
        assert_eq!(find("https://google.com/cardboard/cfg?p=abc"), None);
        let mistake = |text: &str| find(text).unwrap().unwrap_err();
        assert!(mistake(&format!("https://192.168.1.7:8080/#stream={TOKEN}")).contains("by cable only"));
        assert!(mistake(&format!("http://192.168.1.7:8080/#stream={TOKEN}")).contains("by cable only"));
        assert!(mistake("http://localhost:8080/#stream=0011").contains("not whole"));
    }

    #[test]
    fn a_decoders_picture_is_packed_whatever_its_layout() {
        let size = [6, 4];
        let expected: Vec<u8> = (0..36).collect();
        let (luma, rest) = expected.split_at(24);
        let (blue, red) = rest.split_at(6);
        let (stride, rows) = (10, 6);
        let mut planar = vec![99; stride * rows * 3 / 2];
        let mut mixed = planar.clone();
        for (i, byte) in luma.iter().enumerate() {
            (planar[i / 6 * stride + i % 6], mixed[i / 6 * stride + i % 6]) = (*byte, *byte);
        }
        for (i, (blue, red)) in blue.iter().zip(red).enumerate() {
            let (row, column) = (i / 3, i % 3);
            planar[stride * rows + row * 5 + column] = *blue;
            planar[stride * rows + (3 + row) * 5 + column] = *red;
            mixed[stride * rows + row * stride + 2 * column] = *blue;
            mixed[stride * rows + row * stride + 2 * column + 1] = *red;
        }
        let mut packed = Vec::new();
        for (color, buffer) in [(PLANAR, &planar), (SEMI_PLANAR[0], &mixed), (SEMI_PLANAR[1], &mixed)] {
            let layout = Layout { color, stride, rows };
            assert_eq!(layout.pack(buffer, size, &mut packed), Ok(()));
            assert_eq!(packed, expected);
            assert!(layout.pack(&buffer[..70], size, &mut packed).is_err());
        }
        let tight = Layout { color: PLANAR, ..Layout::default() };
        assert_eq!((tight.pack(&expected, size, &mut packed), &packed), (Ok(()), &expected));
        assert!(Layout { color: 6, ..tight }.pack(&expected, size, &mut packed).is_err());
    }
}
