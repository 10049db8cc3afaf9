//! What is streamed: a scene, or an RGBD video.

use std::path::Path;
use std::time::Duration;

use anyhow::ensure;

use yoro_lab::streaming::{FrameRenderer, Picture};
use yoro_render::PreparedScene;
use yoro_stream::{Content, EyeView, FromServer, ViewRequest};
use yoro_video::Reader;

/// A video that is later than this goes on from there.
const LATE: Duration = Duration::from_millis(100);

/// Where pictures come from.
pub enum Source {
    /// They are rendered.
    Scene { prepared: Box<PreparedScene>, renderer: Box<FrameRenderer> },
    /// They are decoded.
    Video(Box<Video>),
}

impl Source {
    /// Returns the picture for a request at a time since the start; none if a video has no new one.
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

/// An RGBD video that is played over and over.
pub struct Video {
    reader: Reader,
    content: Content,
    /// Width and height of its eye and of the depth.
    size: [u16; 2],
    /// When the next picture is due.
    due: Duration,
}

impl Video {
    /// Opens a file. Returns with it what a page is told that shows it.
    ///
    /// # Errors
    /// For a file that is no RGBD video.
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
        Ok((Video { reader, content, size, due: Duration::ZERO }, welcome))
    }

    fn picture(&mut self, now: Duration) -> anyhow::Result<Option<Picture>> {
        if now.saturating_sub(self.due) > LATE {
            self.due = now;
        }
        let mut newest = None;
        while self.due <= now {
            if self.reader.frames() == 0 {
                self.reader.rewind()?;
            }
            let Some(planes) = self.reader.read_packed()? else { break };
            self.due += Duration::from_secs_f64(self.reader.duration().max(1e-3));
            newest = Some(planes);
        }
        let &mut Video { content, size, .. } = self;
        Ok(newest.map(|planes| Picture { planes, content, size, new_span: false }))
    }
}
