//! The messages between client and server, and their encoding in bytes.

use std::fmt;

use serde::{Deserialize, Serialize};
use yoro::eyes::{DepthConvention, DepthRange, Eye, EyesError, Frustum, Pose, PoseWarp, View};

/// The version of the messages. Clients with another version are refused.
pub const VERSION: u16 = 4;

/// The secret that a client must send to be served: 128 random bits.
pub type Token = [u8; 16];

/// The largest magnitude of a client's time in ms: centuries.
const MAX_MS: f64 = 1e13;
/// The largest magnitude of a coordinate of a head's position, in metres; the page has the same limit.
const FARTHEST: f32 = 1e6;
/// The largest tangent of a frustum's sides: that of 80 degrees.
const STEEPEST: f32 = 5.671;
/// Valid side lengths of pictures in pixels.
const SIDES: std::ops::RangeInclusive<u16> = 16..=4096;

/// An eye's pose and frustum.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct EyeView {
    /// Pose in the world.
    pub pose: Pose,
    /// Frustum, as tangents.
    pub frustum: Frustum,
}

impl EyeView {
    /// Returns the view of `size` pixels with depth uniform in 1/z, from 1 at `nearest` to 0 at `farthest` metres.
    pub fn view(&self, size: [u16; 2], [nearest, farthest]: [f32; 2]) -> View {
        let depth = DepthRange { near: nearest, far: farthest, convention: DepthConvention::Reversed };
        View { pose: self.pose, frustum: self.frustum, depth, size: size.map(u32::from) }
    }

    fn is_valid(&self) -> bool {
        let EyeView { pose, frustum: f } = self;
        // Written so that NaN fails, too.
        let sides = [f.left, f.right, f.bottom, f.top].iter().all(|side| side.abs() <= STEEPEST);
        let place = pose.position.to_array().iter().all(|n| n.abs() <= FARTHEST);
        let turned = (pose.orientation.length_squared() - 1.0).abs() < 1e-2;
        sides && place && turned && f.width() > 1e-3 && f.height() > 1e-3
    }
}

/// What a client shows, and therefore what the server is to render for.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ViewRequest {
    /// Milliseconds of the client's clock. The frame rendered for this request returns them.
    pub time_ms: f64,
    /// Left and right eye at the newest pose of the head.
    pub eyes: [EyeView; 2],
    /// The eye to render.
    pub dominant: Eye,
    /// Width and height of each eye in pixels. The server may send fewer.
    pub size: [u16; 2],
}

/// When a frame has arrived.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Arrival {
    /// The frame's number.
    pub number: u32,
    /// The time in ms at which it was whole, by a clock of the client's that only has to run evenly.
    pub time_ms: f64,
}

/// What has become of the newest frames. A client sends it at each arrival and with each request. It repeats what it has
/// said before, so that a lost message does not matter.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Report {
    /// The frames that have arrived last, the newest first.
    pub arrivals: [Option<Arrival>; 4],
    /// The newest frame that was decoded.
    pub decoded: Option<u32>,
}

impl Report {
    /// Notes that a frame has arrived.
    pub fn arrived(&mut self, number: u32, time_ms: f64) {
        self.arrivals.rotate_right(1);
        self.arrivals[0] = Some(Arrival { number, time_ms });
    }
}

/// A message to the server.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum FromClient {
    /// The first message.
    Hello {
        /// [`VERSION`].
        version: u16,
        /// The token of the link that the server printed.
        token: Token,
    },
    /// The head has moved, or time has passed: a frame for this view is wanted.
    Request(ViewRequest),
    /// What has become of the newest frames.
    Report(Report),
}

/// What the two parts of a frame's picture show. They are side by side and of one size. Eyes are wider
/// than requested.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Content {
    /// An eye, and its depth as luma: from 255 at the first distance in metres to 0 at the second, uniform in 1/z.
    Depth(EyeView, [f32; 2]),
    /// The left eye and the right eye.
    Eyes([EyeView; 2]),
}

/// What an eye is made from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EyeSource {
    /// The index among the parts that show eyes.
    pub part: usize,
    /// The view that the part shows.
    pub view: EyeView,
    /// The nearest and the farthest distance in metres of its depth; `None` without depth.
    pub span: Option<[f32; 2]>,
}

impl Content {
    /// Returns what an eye is made from.
    pub fn source(&self, eye: Eye) -> EyeSource {
        match *self {
            Content::Depth(view, span) => EyeSource { part: 0, view, span: Some(span) },
            Content::Eyes(eyes) => EyeSource { part: eye.index(), view: eyes[eye.index()], span: None },
        }
    }

    /// Returns a view's source among the parts that show eyes, and the warp, a rotation only if there is no depth.
    ///
    /// # Errors
    /// [`EyesError`] if the view sees too little of the part.
    pub fn warp(&self, size: [u16; 2], eye: Eye, target: &View) -> Result<(usize, PoseWarp), EyesError> {
        let EyeSource { part, view, span } = self.source(eye);
        let warp = PoseWarp::new(&view.view(size, span.unwrap_or([1.0, 2.0])), target)?;
        Ok((part, if span.is_some() { warp } else { warp.rotation_only() }))
    }

    fn is_valid(&self) -> bool {
        Eye::BOTH.into_iter().all(|eye| {
            let EyeSource { view, span, .. } = self.source(eye);
            view.is_valid() && span.is_none_or(|[near, far]| 1e-4 <= near && near < far && far <= 1e6)
        })
    }
}

/// The header before a frame's H.264 data.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct FrameHeader {
    /// The [`ViewRequest::time_ms`] of the request that the frame was rendered for.
    pub time_ms: f64,
    /// What the picture shows.
    pub content: Content,
    /// Width and height of each part in pixels, without the padding to an even size.
    pub size: [u16; 2],
    /// Milliseconds that rendering took.
    pub render_ms: f32,
    /// Milliseconds that encoding took.
    pub encode_ms: f32,
    /// H.264's quantizer.
    pub quantizer: u8,
}

/// The reason why a client is not served.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Refusal {
    /// The token is wrong.
    Token,
    /// Another client is being served.
    Busy,
    /// The client has another version.
    Version,
}

impl fmt::Display for Refusal {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(match self {
            Refusal::Token => "The server has been started again: open the link that it prints now.",
            Refusal::Busy => "Another page shows the stream: close it.",
            Refusal::Version => "The server has another version of yoro: reload the page.",
        })
    }
}

/// A message to the client.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FromServer<'a> {
    /// The answer to a hello: the head's initial pose.
    Welcome(Pose),
    /// The answer to a hello, for a video: it is shown whole, with the frusta of the left and the right eye, from the
    /// origin. The [`Eye`] is the one that was rendered.
    Video([Frustum; 2], Eye),
    /// The answer to a hello that is rejected, and the last message.
    Refused(Refusal),
    /// A frame.
    Frame {
        /// Consecutive from 0.
        number: u32,
        /// True if the frame can be decoded without others.
        intra: bool,
        /// What the frame shows.
        header: FrameHeader,
        /// H.264 in the format of Annex B.
        data: &'a [u8],
    },
}

impl FromClient {
    /// Returns the first message; `None` if the token is not 32 hexadecimal digits.
    pub fn hello(token: &str) -> Option<FromClient> {
        let digits = token.len() == 32 && token.bytes().all(|digit| digit.is_ascii_hexdigit());
        let token = digits.then(|| u128::from_str_radix(token, 16).ok()).flatten()?.to_be_bytes();
        Some(FromClient::Hello { version: VERSION, token })
    }

    /// Returns the message's bytes.
    pub fn to_bytes(&self) -> Vec<u8> {
        bytes_of(self)
    }

    /// Reads a message; `None` if it is not a client's message, or if it has numbers out of range.
    pub fn read(bytes: &[u8]) -> Option<FromClient> {
        let message = exact(bytes)?;
        let valid = match &message {
            FromClient::Request(request) => {
                let sizes = request.size.iter().all(|side| SIDES.contains(side));
                request.time_ms.is_finite() && sizes && request.eyes.iter().all(EyeView::is_valid)
            }
            FromClient::Report(report) => {
                report.arrivals.iter().flatten().all(|arrival| arrival.time_ms.abs() < MAX_MS)
            }
            _ => true,
        };
        valid.then_some(message)
    }
}

// The first byte of messages to the client.
const WELCOME: u8 = 0;
const REFUSED: u8 = 1;
const FRAME: u8 = 2;
const VIDEO: u8 = 3;
/// The length of what precedes a frame's header: [`FRAME`], 1 for an intra frame, the header's length (16 bits), the
/// number (32 bits), all little-endian. The page's worker reads these without the module.
const PREFIX: usize = 8;

impl<'a> FromServer<'a> {
    /// Returns the message's bytes.
    pub fn to_bytes(&self) -> Vec<u8> {
        match self {
            FromServer::Welcome(pose) => [vec![WELCOME], bytes_of(pose)].concat(),
            FromServer::Video(frusta, eye) => [vec![VIDEO], bytes_of(&(frusta, eye))].concat(),
            FromServer::Refused(refusal) => [vec![REFUSED], bytes_of(refusal)].concat(),
            FromServer::Frame { number, intra, header, data } => {
                let header = bytes_of(header);
                let mut bytes = vec![FRAME, u8::from(*intra)];
                bytes.extend((header.len() as u16).to_le_bytes());
                bytes.extend(number.to_le_bytes());
                bytes.extend(header);
                bytes.extend(*data);
                bytes
            }
        }
    }

    /// Reads a message; `None` if it is not a server's message, or if it has numbers out of range.
    pub fn read(bytes: &'a [u8]) -> Option<FromServer<'a>> {
        match bytes.split_first()? {
            (&WELCOME, rest) => {
                let pose = exact(rest)?;
                let frustum = Frustum::symmetric(1.0, 1.0);
                EyeView { pose, frustum }.is_valid().then_some(FromServer::Welcome(pose))
            }
            (&VIDEO, rest) => {
                let (frusta, eye): ([Frustum; 2], Eye) = exact(rest)?;
                let valid = |frustum| EyeView { pose: Pose::IDENTITY, frustum }.is_valid();
                frusta.into_iter().all(valid).then_some(FromServer::Video(frusta, eye))
            }
            (&REFUSED, rest) => exact(rest).map(FromServer::Refused),
            (&FRAME, _) => {
                let (&[_, intra, low, high, number @ ..], rest) = bytes.split_first_chunk::<PREFIX>()?;
                let length = usize::from(u16::from_le_bytes([low, high]));
                let (header, data) = rest.split_at_checked(length)?;
                let header: FrameHeader = exact(header)?;
                let valid = header.content.is_valid()
                    && intra < 2
                    && header.size.iter().all(|side| SIDES.contains(side));
                let number = u32::from_le_bytes(number);
                valid.then_some(FromServer::Frame { number, intra: intra == 1, header, data })
            }
            _ => None,
        }
    }
}

fn bytes_of(value: &impl Serialize) -> Vec<u8> {
    postcard::to_allocvec(value).expect("numbers have bytes")
}

/// Reads a value that must take up all of the bytes.
fn exact<'a, T: Deserialize<'a>>(bytes: &'a [u8]) -> Option<T> {
    let (value, rest) = postcard::take_from_bytes(bytes).ok()?;
    rest.is_empty().then_some(value)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use yoro::eyes::Pose;

    const EYE: EyeView =
        EyeView { pose: Pose::IDENTITY, frustum: Frustum { left: -1.0, right: 0.9, bottom: -0.8, top: 0.7 } };
    const REQUEST: ViewRequest =
        ViewRequest { time_ms: 12.5, eyes: [EYE; 2], dominant: Eye::Right, size: [640, 480] };
    const HEADER: FrameHeader = FrameHeader {
        time_ms: 12.5,
        content: Content::Depth(EYE, [0.5, 40.0]),
        size: [700, 500],
        render_ms: 3.0,
        encode_ms: 4.0,
        quantizer: 24,
    };

    fn up() -> Vec<FromClient> {
        let hello = FromClient::Hello { version: VERSION, token: [7; 16] };
        let mut report = Report { decoded: Some(9), ..Report::default() };
        report.arrived(10, 70.5);
        vec![hello, FromClient::Request(REQUEST), FromClient::Report(report)]
    }

    fn down() -> Vec<FromServer<'static>> {
        let eyes = FrameHeader { content: Content::Eyes([EYE; 2]), ..HEADER };
        let frame =
            |header| FromServer::Frame { number: 70_000, intra: true, header, data: &[0, 0, 0, 1, 9] };
        let refused = FromServer::Refused(Refusal::Busy);
        let video = FromServer::Video([EYE.frustum; 2], Eye::Left);
        vec![FromServer::Welcome(Pose::IDENTITY), video, refused, frame(HEADER), frame(eyes)]
    }

    #[test]
    fn messages_come_back_from_their_bytes_and_from_no_fewer() {
        for message in up() {
            let bytes = message.to_bytes();
            assert_eq!(FromClient::read(&bytes), Some(message));
            assert!((0..bytes.len()).all(|length| FromClient::read(&bytes[..length]).is_none()));
            assert_eq!(FromClient::read(&[bytes, vec![0]].concat()), None, "longer than the message");
        }
        for message in down() {
            let bytes = message.to_bytes();
            assert_eq!(FromServer::read(&bytes), Some(message));
            let needed =
                if matches!(message, FromServer::Frame { .. }) { bytes.len() - 5 } else { bytes.len() };
            assert!((0..needed).all(|length| FromServer::read(&bytes[..length]).is_none()));
        }
    }

    #[test]
    fn numbers_out_of_bounds_are_refused() {
        let request = |change: fn(&mut ViewRequest)| {
            let mut request = REQUEST;
            change(&mut request);
            FromClient::read(&FromClient::Request(request).to_bytes())
        };
        assert!(request(|_| {}).is_some());
        assert_eq!(request(|request| request.time_ms = f64::NAN), None);
        assert_eq!(request(|request| request.size[1] = 0), None);
        assert_eq!(request(|request| request.size[0] = 5000), None);
        assert_eq!(request(|request| request.eyes[1].pose.position.x = f32::INFINITY), None);
        assert_eq!(request(|request| request.eyes[0].pose.orientation.w = 0.5), None);
        assert_eq!(request(|request| request.eyes[0].frustum.right = -1.0), None);
        let report = |time_ms| {
            let mut report = Report::default();
            report.arrived(1, time_ms);
            FromClient::read(&FromClient::Report(report).to_bytes())
        };
        assert!(report(1.0).is_some() && report(f64::NAN).is_none() && report(1e300).is_none());
        let frame = |header| {
            let bytes = FromServer::Frame { number: 0, intra: false, header, data: &[] }.to_bytes();
            FromServer::read(&bytes).is_some()
        };
        assert!(frame(HEADER));
        assert!(!frame(FrameHeader { content: Content::Depth(EYE, [2.0, 1.0]), ..HEADER }));
        assert!(!frame(FrameHeader { size: [0, 5], ..HEADER }));
    }

    proptest! {
        #[test]
        fn damaged_messages_are_read_without_a_panic(
            damage in proptest::collection::vec((any::<usize>(), any::<u8>()), 1..4),
        ) {
            let up = up().into_iter().map(|message| message.to_bytes());
            let messages = up.chain(down().into_iter().map(|message| message.to_bytes()));
            for mut bytes in messages {
                for (at, byte) in &damage {
                    let at = at % bytes.len();
                    bytes[at] = *byte;
                }
                if let Some(FromClient::Request(request)) = FromClient::read(&bytes) {
                    prop_assert!(request.eyes.iter().all(EyeView::is_valid));
                }
                let _ = FromServer::read(&bytes);
            }
        }
    }
}
