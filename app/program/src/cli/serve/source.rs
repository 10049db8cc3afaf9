//! The source of a stream: a scene, or an RGBD video.

use std::path::Path;
use std::time::Duration;

use anyhow::ensure;

use yoro_media::video::{Planes, Reader, VideoError};
use yoro_render::PreparedScene;
use yoro_stream::{Content, EyeView, FrameRenderer, FromServer, Picture, ViewRequest};

/// A video that is later than this continues from the current time, instead of catching up.
const LATE: Duration = Duration::from_millis(100);

/// The source of pictures.
pub enum Source {
    /// A scene, which is rendered.
    Scene { prepared: Box<PreparedScene>, renderer: Box<FrameRenderer> },
    /// A video, which is decoded.
    Video(Box<Video>),
}

impl Source {
    /// Returns the picture for a request at a time since the start; `None` if a video has no new picture.
    ///
    /// # Errors
    /// For eyes that cannot be rendered, and a video that cannot be read.
    pub fn picture(&mut self, request: &ViewRequest, now: Duration) -> anyhow::Result<Option<Picture>> {
        match self {
            Source::Scene { prepared, renderer } => {
                prepared.set_time(now.as_secs_f64())?;
                Ok(Some(renderer.picture(prepared, request)?))
            }
            Source::Video(video) => video.picture(now),
        }
    }
}

/// An RGBD video that is played in a loop.
pub struct Video {
    reader: Reader,
    content: Content,
    /// The width and height of its eye and of the depth.
    size: [u16; 2],
    /// The time at which the next picture is due.
    due: Duration,
    /// The pictures that have been read since the first.
    read: usize,
    /// The first damage, and whether it was logged.
    damage: Option<(VideoError, bool)>,
}

impl Video {
    /// Opens a file. Returns the video with the first message to a page that shows it.
    ///
    /// # Errors
    /// For a file that is not an RGBD video.
    pub fn open(path: &Path) -> anyhow::Result<(Video, FromServer<'static>)> {
        let reader = Reader::open(path)?;
        let rgbd = reader.rgbd()?;
        let view = rgbd.views()?.source;
        let content =
            Content::Depth(EyeView { pose: view.pose, frustum: view.frustum }, [rgbd.nearest, rgbd.farthest]);
        ensure!(
            view.size.iter().all(|side| (16..=4096).contains(side)),
            "{} cannot be streamed: an eye has {} x {} pixels, and not 16 to 4096 a side",
            path.display(),
            view.size[0],
            view.size[1]
        );
        let size = view.size.map(|n| n as u16);
        let welcome = FromServer::Video(rgbd.pair().frusta, rgbd.eye);
        let mut video = Video { reader, content, size, due: Duration::ZERO, read: 0, damage: None };
        // A video without a whole picture is refused at once.
        video.next()?;
        video.rewind()?;
        Ok((video, welcome))
    }

    /// Returns the next picture that is whole. After the last one, the first follows.
    fn next(&mut self) -> anyhow::Result<Planes> {
        loop {
            let has_more = match self.reader.read() {
                Ok(Some(planes)) => {
                    self.read += 1;
                    if let Some((error, is_logged @ false)) = &mut self.damage {
                        log::warn!("{error}; what cannot be read is left out");
                        *is_logged = true;
                    }
                    return Ok(planes);
                }
                Ok(None) => false,
                Err(error) => {
                    let has_more = self.reader.skip()?;
                    if !has_more && self.read == 0 {
                        return Err(error.into());
                    }
                    self.damage.get_or_insert((error, false));
                    has_more
                }
            };
            if !has_more {
                self.rewind()?;
            }
        }
    }

    fn rewind(&mut self) -> Result<(), VideoError> {
        self.read = 0;
        self.reader.rewind()
    }

    fn picture(&mut self, now: Duration) -> anyhow::Result<Option<Picture>> {
        if now.saturating_sub(self.due) > LATE {
            self.due = now;
        }
        let mut newest = None;
        while self.due <= now {
            let planes = self.next()?;
            self.due += Duration::from_secs_f64(self.reader.duration().max(1e-3));
            newest = Some(planes);
        }
        let &mut Video { content, size, .. } = self;
        Ok(newest.map(|planes| Picture { planes, content, size, new_span: false }))
    }
}
