//! H.264 encoding by an ffmpeg process, which can use the encoders of graphics cards. Pictures go in as a live Matroska
//! file, whose timestamps mark intra frames, and come out as FLV, whose packets contain their lengths.

use std::io::{BufWriter, Read, Write};
use std::process::{Child, ChildStdin, Command, Stdio};
use std::sync::mpsc::{self, Receiver, Sender};
use std::time::Duration;
use std::{fs, thread};

use shiguredo_mp4::Decode;
use shiguredo_mp4::bitstream::h264::length_prefixed_to_annexb;
use shiguredo_mp4::boxes::AvccBox;

use super::index::{length_size, parameters};
use super::{LivePicture, Planes, VideoError};

/// The longest time that an encoder may take for a picture; for the first one, a graphics card has to start.
const TIMEOUT: Duration = Duration::from_secs(5);
/// Milliseconds between pictures in the timestamps for ffmpeg. Real times do not matter to an encoder with a constant
/// quantizer.
const STEP: u64 = 1000;
/// Milliseconds added to an intra frame's timestamp, by which `-force_key_frames` recognizes it.
const INTRA: u64 = 500;

/// One of ffmpeg's encoders.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FfmpegEncoder {
    /// NVIDIA's graphics cards.
    Nvenc,
    /// Intel's and AMD's graphics cards on Linux.
    Vaapi,
    /// x264 on the CPU.
    X264,
}

impl FfmpegEncoder {
    /// Returns ffmpeg's name for the encoder.
    pub fn name(self) -> &'static str {
        match self {
            FfmpegEncoder::Nvenc => "h264_nvenc",
            FfmpegEncoder::Vaapi => "h264_vaapi",
            FfmpegEncoder::X264 => "libx264",
        }
    }

    /// Returns the encoder's options: one picture out for each picture in, no B-frames, constrained baseline.
    fn options(self) -> &'static [&'static str] {
        match self {
            FfmpegEncoder::Nvenc => &[
                "-preset",
                "p1",
                "-tune",
                "ull",
                "-rc",
                "constqp",
                "-forced-idr",
                "1",
                "-delay",
                "0",
                "-zerolatency",
                "1",
            ],
            FfmpegEncoder::Vaapi => &["-vf", "format=nv12,hwupload", "-rc_mode", "CQP", "-async_depth", "1"],
            FfmpegEncoder::X264 => &["-preset", "ultrafast", "-tune", "zerolatency"],
        }
    }
}

/// A running ffmpeg process that encodes pictures of one size at one quantizer.
pub struct Ffmpeg {
    child: Child,
    pictures: BufWriter<ChildStdin>,
    encoded: Receiver<(Vec<u8>, bool)>,
    quantizer: u8,
    size: [usize; 2],
    count: u64,
}

impl Ffmpeg {
    /// Starts ffmpeg for pictures of `size` at `quantizer`.
    ///
    /// # Errors
    /// [`VideoError::Codec`] if ffmpeg is not installed. Other problems are found at the first picture.
    pub fn start(encoder: FfmpegEncoder, size: [usize; 2], quantizer: u8) -> Result<Ffmpeg, VideoError> {
        let mut command = Command::new("ffmpeg");
        command.args(["-hide_banner", "-loglevel", "error"]);
        if encoder == FfmpegEncoder::Vaapi {
            command.args(["-vaapi_device", &render_node()]);
        }
        // Otherwise ffmpeg would analyse several pictures before it encodes the first one.
        command.args(["-probesize", "32", "-analyzeduration", "1", "-fpsprobesize", "0"]);
        command.args(["-f", "matroska", "-i", "-", "-fps_mode", "passthrough"]);
        command
            .args(["-force_key_frames", "expr:gt(mod(t,1),0.25)", "-c:v", encoder.name()])
            .args(encoder.options());
        let profile = if encoder == FfmpegEncoder::Vaapi { "constrained_baseline" } else { "baseline" };
        command.args([
            "-qp",
            &quantizer.to_string(),
            "-profile:v",
            profile,
            "-level",
            "5.1",
            "-bf",
            "0",
            "-g",
            "1000000",
        ]);
        command.args(["-color_range", "pc", "-colorspace", "smpte170m"]);
        command.args(["-f", "flv", "-flvflags", "no_duration_filesize", "-flush_packets", "1", "-"]);
        command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
        let mut child = command
            .spawn()
            .map_err(|error| VideoError::Codec(format!("ffmpeg cannot be started ({error})")))?;
        let (pictures, out) =
            (child.stdin.take().expect("it is piped"), child.stdout.take().expect("it is piped"));
        let (send, encoded) = mpsc::channel();
        thread::spawn(move || read(out, &send));
        let mut ffmpeg =
            Ffmpeg { child, pictures: BufWriter::new(pictures), encoded, quantizer, size, count: 0 };
        if ffmpeg.pictures.write_all(&header(size)).is_err() {
            return Err(ffmpeg.failure());
        }
        Ok(ffmpeg)
    }

    /// True if this process encodes pictures of `size` at `quantizer` or up to three steps coarser. ffmpeg cannot
    /// change the quantizer of a running encoder, and restarting it takes tenths of a second.
    pub fn suits(&self, size: [usize; 2], quantizer: u8) -> bool {
        self.size == size && (self.quantizer.saturating_sub(3)..=self.quantizer).contains(&quantizer)
    }

    /// Encodes the next picture; it is an intra frame if `intra` is set, or if it is the first one.
    ///
    /// # Errors
    /// [`VideoError::Codec`] with ffmpeg's message.
    pub fn encode(&mut self, picture: &Planes, intra: bool) -> Result<LivePicture, VideoError> {
        let time = self.count * STEP + if intra { INTRA } else { 0 };
        self.count += 1;
        if self.write(picture, time).is_err() {
            return Err(self.failure());
        }
        match self.encoded.recv_timeout(TIMEOUT) {
            Ok((data, is_intra)) => Ok(LivePicture { data, is_intra, quantizer: self.quantizer }),
            Err(_) => Err(self.failure()),
        }
    }

    fn write(&mut self, picture: &Planes, time: u64) -> std::io::Result<()> {
        let length: usize = picture.planes.iter().map(Vec::len).sum();
        // Track 1, at the cluster's time, a key frame.
        let block = [&id(0xA3)[..], &size_of(4 + length as u64), &[0x81, 0, 0, 0x80]].concat();
        let time = number(0xE7, time);
        self.pictures.write_all(&id(0x1F43_B675))?;
        self.pictures.write_all(&size_of((time.len() + block.len() + length) as u64))?;
        self.pictures.write_all(&time)?;
        self.pictures.write_all(&block)?;
        for plane in &picture.planes {
            self.pictures.write_all(plane)?;
        }
        self.pictures.flush()
    }

    /// Kills the process and returns its error message.
    fn failure(&mut self) -> VideoError {
        let _ = self.child.kill();
        let mut said = String::new();
        if let Some(mut stderr) = self.child.stderr.take() {
            let _ = stderr.read_to_string(&mut said);
        }
        let said = said.lines().next().unwrap_or("it gives no picture");
        VideoError::Codec(format!("ffmpeg: {said}"))
    }
}

impl Drop for Ffmpeg {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// Returns the first graphics card's device.
fn render_node() -> String {
    let mut nodes: Vec<_> =
        fs::read_dir("/dev/dri").into_iter().flatten().flatten().map(|entry| entry.path()).collect();
    nodes.sort();
    let node = nodes.into_iter().find(|path| path.to_string_lossy().contains("renderD"));
    node.map_or("/dev/dri/renderD128".into(), |path| path.to_string_lossy().into_owned())
}

/// Returns an element's identifier in Matroska's encoding, without leading zeros.
fn id(id: u32) -> Vec<u8> {
    id.to_be_bytes().into_iter().skip_while(|byte| *byte == 0).collect()
}

/// Returns an element's length in eight bytes.
fn size_of(length: u64) -> [u8; 8] {
    (length | 1 << 56).to_be_bytes()
}

fn element(name: u32, content: &[u8]) -> Vec<u8> {
    [&id(name)[..], &size_of(content.len() as u64), content].concat()
}

fn number(name: u32, value: u64) -> Vec<u8> {
    element(name, &value.to_be_bytes())
}

/// Returns the header of a live Matroska file (RFC 9559): uncompressed, 4:2:0, full range, times in milliseconds.
fn header([width, height]: [usize; 2]) -> Vec<u8> {
    let file_type = [element(0x4282, b"matroska"), number(0x4287, 4), number(0x4285, 2)].concat();
    let colour = [number(0x55B9, 2), number(0x55B1, 6)].concat();
    let video = [
        number(0xB0, width as u64),
        number(0xBA, height as u64),
        element(0x2E_B524, b"I420"),
        element(0x55B0, &colour),
    ];
    let track = [
        number(0xD7, 1),
        number(0x73C5, 1),
        number(0x83, 1),
        element(0x86, b"V_UNCOMPRESSED"),
        element(0xE0, &video.concat()),
    ];
    let mut bytes = element(0x1A45_DFA3, &file_type);
    // The segment has an unknown length.
    bytes.extend([&id(0x1853_8067)[..], &[1, 255, 255, 255, 255, 255, 255, 255]].concat());
    bytes.extend(element(0x1549_A966, &number(0x2A_D7B1, 1_000_000)));
    bytes.extend(element(0x1654_AE6B, &element(0xAE, &track.concat())));
    bytes
}

/// Passes on the pictures of an FLV stream in the format of Annex B, until it ends or is damaged.
fn read(mut flv: impl Read, encoded: &Sender<(Vec<u8>, bool)>) {
    let mut start = [0; 13];
    if flv.read_exact(&mut start).is_err() {
        return;
    }
    let mut avcc: Option<AvccBox> = None;
    while let Some(tag) = tag(&mut flv) {
        // Video tag: frame type and codec, packet type, three bytes of time offset, data.
        let (Some(kind), Some(packet), Some(data)) = (tag.first(), tag.get(1), tag.get(5..)) else {
            continue;
        };
        match (packet, &avcc) {
            (0, _) => {
                let bytes = [&(data.len() as u32 + 8).to_be_bytes()[..], b"avcC", data].concat();
                avcc = AvccBox::decode(&bytes).ok().map(|(avcc, _)| avcc);
            }
            (1, Some(avcc)) => {
                let is_intra = kind >> 4 == 1;
                let Ok(picture) = length_prefixed_to_annexb(data, length_size(avcc)) else { return };
                // Some encoders put the parameter sets only into the file's header.
                let sets = if is_intra { parameters(avcc) } else { Vec::new() };
                if encoded.send(([sets, picture].concat(), is_intra)).is_err() {
                    return;
                }
            }
            _ => {}
        }
    }
}

/// Returns the content of the next tag if it is a video tag, and otherwise an empty vector. Returns `None` at the end.
fn tag(flv: &mut impl Read) -> Option<Vec<u8>> {
    let mut head = [0; 11];
    flv.read_exact(&mut head).ok()?;
    let length = u32::from_be_bytes([0, head[1], head[2], head[3]]);
    // The tag is followed by its length once more.
    let mut content = vec![0; length as usize + 4];
    flv.read_exact(&mut content).ok()?;
    content.truncate(length as usize);
    Some(if head[0] == 9 { content } else { Vec::new() })
}
