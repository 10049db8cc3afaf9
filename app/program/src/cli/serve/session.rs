//! A client's session: the messages that it sends, and the frames that it gets. It has the thread of the GL context.

use std::sync::mpsc::{Receiver, RecvTimeoutError};
use std::time::{Duration, Instant};

use anyhow::bail;

use super::client::Client;
use super::source::Source;
use yoro_files::interrupt;
use yoro_media::video::{LiveEncoder, LivePicture};
use yoro_stream::{FrameHeader, FromClient, FromServer, RateControl, ViewRequest};

/// Renders, encodes and sends frames.
pub struct Server {
    pub source: Source,
    pub encoder: LiveEncoder,
    pub start: Instant,
    pub limits: Limits,
}

/// The limits of a stream.
pub struct Limits {
    /// The smallest quantizer.
    pub quantizer: u8,
    /// The largest frame rate in Hz.
    pub frame_rate: f32,
    /// The largest longer side of an eye in pixels.
    pub size: u16,
}

impl Server {
    /// Serves one client after the other until Ctrl-C.
    ///
    /// # Errors
    /// If there is nothing to serve any more.
    pub fn serve(&mut self, admitted: &Receiver<Client>) -> anyhow::Result<()> {
        while !interrupt::requested() {
            match admitted.recv_timeout(Duration::from_millis(100)) {
                Ok(client) => {
                    println!("a client has connected");
                    let ended = self.session(&client);
                    drop(client);
                    let reason = ended?.map_or(String::new(), |reason| format!(": {reason}"));
                    println!("the client has gone{reason}");
                }
                Err(RecvTimeoutError::Timeout) => {}
                Err(RecvTimeoutError::Disconnected) => bail!("the port is closed"),
            }
        }
        Ok(())
    }

    /// Serves a client until it is gone, or cannot be served. Returns why, unless it has gone by itself.
    ///
    /// # Errors
    /// If nobody can be served.
    fn session(&mut self, client: &Client) -> anyhow::Result<Option<String>> {
        let Client { heard, frames, .. } = client;
        let mut control = RateControl::new(self.limits.quantizer, self.limits.frame_rate);
        let mut request: Option<ViewRequest> = None;
        // The time of the last answered request.
        let mut answered: Option<f64> = None;
        let mut number = 0u32;
        let mut statistics = Statistics::new();
        loop {
            if interrupt::requested() {
                return Ok(None);
            }
            match heard.recv_timeout(Duration::from_millis(1)) {
                Ok((message, at)) => {
                    match message {
                        FromClient::Request(newest) => request = Some(newest),
                        FromClient::Report(report) => control.report(&report, at - self.start),
                        FromClient::Hello { .. } => {}
                    }
                    continue;
                }
                Err(RecvTimeoutError::Timeout) => {}
                Err(RecvTimeoutError::Disconnected) => return Ok(None),
            }
            statistics.print(&control);
            control.give_up_late(self.start.elapsed());
            let due = request
                .filter(|request| Some(request.time_ms) != answered && control.is_due(self.start.elapsed()));
            let Some(mut request) = due else { continue };
            let longest = request.size[0].max(request.size[1]);
            if longest > self.limits.size {
                let scale = f32::from(self.limits.size) / f32::from(longest);
                request.size = request.size.map(|side| ((f32::from(side) * scale) as u16).max(16));
            }
            let begun = Instant::now();
            let picture = match self.source.picture(&request, self.start.elapsed()) {
                Ok(Some(picture)) => picture,
                Ok(None) => continue,
                // A scene can be rendered from elsewhere.
                Err(error) if matches!(self.source, Source::Scene { .. }) => {
                    return Ok(Some(error.to_string()));
                }
                Err(error) => return Err(error),
            };
            answered = Some(request.time_ms);
            let rendered = begun.elapsed();
            let intra = number == 0 || picture.new_span;
            let quantizer = control.quantizer(intra);
            let encoded = match self.encoder.encode(&picture.planes, quantizer, intra) {
                Ok(encoded) => encoded,
                Err(error) => return Ok(Some(error.to_string())),
            };
            let LivePicture { data, is_intra } = encoded;
            let ms = |time: Duration| time.as_secs_f32() * 1e3;
            let header = FrameHeader {
                time_ms: request.time_ms,
                content: picture.content,
                size: picture.size,
                render_ms: ms(rendered),
                encode_ms: ms(begun.elapsed() - rendered),
                quantizer,
            };
            let frame = FromServer::Frame { number, intra: is_intra, header, data: &data };
            control.sent(number, is_intra, (quantizer, data.len()), self.start.elapsed());
            if let Err(error) = frames.send(frame.to_bytes()) {
                return Ok(Some(error.to_string()));
            }
            statistics.add(data.len(), &header);
            number = number.wrapping_add(1);
        }
    }
}

/// Statistics that are printed once a second.
struct Statistics {
    since: Instant,
    frames: u32,
    bytes: usize,
    quantizer: u8,
    render_ms: f32,
    encode_ms: f32,
}

impl Statistics {
    fn new() -> Statistics {
        let since = Instant::now();
        Statistics { since, frames: 0, bytes: 0, quantizer: 0, render_ms: 0.0, encode_ms: 0.0 }
    }

    fn add(&mut self, bytes: usize, header: &FrameHeader) {
        self.frames += 1;
        self.bytes += bytes;
        self.quantizer = header.quantizer;
        self.render_ms += header.render_ms;
        self.encode_ms += header.encode_ms;
    }

    fn print(&mut self, control: &RateControl) {
        let seconds = self.since.elapsed().as_secs_f32();
        if seconds < 1.0 {
            return;
        }
        if self.frames > 0 {
            let frames = self.frames as f32;
            println!(
                "{:.0} frames/s, {:.2} Mbit/s, quantizer {}, render {:.1} ms, encode {:.1} ms, sent and arrived {}",
                frames / seconds,
                self.bytes as f32 * 8e-6 / seconds,
                self.quantizer,
                self.render_ms / frames,
                self.encode_ms / frames,
                control.round_trip().map_or("never".into(), |time| format!("after {} ms", time.as_millis()))
            );
        }
        *self = Statistics::new();
    }
}
