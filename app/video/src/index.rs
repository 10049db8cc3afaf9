use std::path::{Path, PathBuf};

use shiguredo_mp4::boxes::{Avc1Box, SampleEntry};
use shiguredo_mp4::codec_string;
use shiguredo_mp4::demux::{Input, Mp4FileDemuxer};
use shiguredo_mp4::{BoxType, Encode as _, TrackKind};
#[cfg(feature = "codec")]
use shiguredo_mp4::{bitstream::h264::LengthSize, boxes::AvccBox};

use crate::{DEPTH_BOX, Rgbd, VideoError};

/// Finds out what is in an MP4 file, from the pieces of it that are needed for that.
pub struct Indexer {
    path: PathBuf,
    length: u64,
    demuxer: Mp4FileDemuxer,
}

/// What is in an MP4 file with H.264.
pub struct Index {
    path: PathBuf,
    /// The encoded pictures, in the order in which they are decoded.
    pub pictures: Vec<EncodedPicture>,
    /// Pictures a second, rounded up.
    pub frame_rate: u32,
    pub(crate) rgbd: Option<Rgbd>,
    entry: Box<Avc1Box>,
}

/// The place of an encoded picture in a file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EncodedPicture {
    /// Bytes from the file's beginning.
    pub offset: u64,
    /// Bytes of the picture.
    pub size: usize,
    /// True if it can be decoded without others.
    pub intra: bool,
    /// The time at which it is decoded, in seconds.
    pub time: f64,
    /// How long it is shown, in seconds.
    pub duration: f64,
}

impl Indexer {
    /// Begins with a file of this length in bytes. Errors name `path`.
    pub fn new(path: &Path, length: u64) -> Indexer {
        Indexer { path: path.into(), length, demuxer: Mp4FileDemuxer::new() }
    }

    /// Returns offset and length in bytes of the piece to [take](Indexer::take) next; `None` when [`Indexer::finish`] may be called.
    ///
    /// # Errors
    /// [`VideoError::Format`] for what is no MP4 file.
    pub fn needed(&self) -> Result<Option<(u64, usize)>, VideoError> {
        let Some(required) = self.demuxer.required_input() else { return Ok(None) };
        let rest = self.length.saturating_sub(required.position);
        let size = required.size.map_or(rest, |size| size as u64);
        if size == 0 || size > rest {
            return Err(VideoError::format(&self.path, "it is no MP4 file, or it is cut off"));
        }
        Ok(Some((required.position, size as usize)))
    }

    /// Takes a piece.
    pub fn take(&mut self, position: u64, data: &[u8]) {
        self.demuxer.handle_input(Input { position, data });
    }

    /// Returns what is in the file, once nothing is needed.
    ///
    /// # Errors
    /// [`VideoError::Format`] for a damaged file, and for one without H.264.
    pub fn finish(mut self) -> Result<Index, VideoError> {
        let damaged = |error: &dyn std::fmt::Debug| VideoError::format(&self.path, format!("{error:?}"));
        let mut pictures = Vec::new();
        let mut found = None;
        while let Some(sample) = self.demuxer.next_sample().map_err(|error| damaged(&error))? {
            if sample.track.kind != TrackKind::Video {
                continue;
            }
            let ticks = sample.track.timescale.get();
            if let Some(SampleEntry::Avc1(entry)) = sample.sample_entry {
                found.get_or_insert_with(|| {
                    let rate = u64::from(ticks).div_ceil(u64::from(sample.duration.max(1))).min(1000);
                    (Box::new(entry.clone()), rate as u32)
                });
            }
            if sample.data_offset.checked_add(sample.data_size as u64).is_none_or(|end| end > self.length) {
                return Err(VideoError::format(&self.path, "it is cut off"));
            }
            pictures.push(EncodedPicture {
                offset: sample.data_offset,
                size: sample.data_size,
                intra: sample.keyframe,
                time: sample.timestamp as f64 / f64::from(ticks),
                duration: f64::from(sample.duration) / f64::from(ticks),
            });
        }
        let (entry, frame_rate) =
            found.ok_or_else(|| VideoError::format(&self.path, "it has no H.264 video"))?;
        let rgbd = rgbd(&self.path, &entry)?;
        Ok(Index { path: self.path, pictures, frame_rate, rgbd, entry })
    }
}

impl Index {
    /// Returns what the depth in the pictures means, where they have it as [`Rgbd::pack`] has it.
    ///
    /// # Errors
    /// [`VideoError::NoDepth`] for other videos.
    pub fn rgbd(&self) -> Result<Rgbd, VideoError> {
        self.rgbd.ok_or_else(|| VideoError::NoDepth { path: self.path.clone() })
    }

    /// Returns the codec's name as browsers take it: `avc1.42C01F`.
    ///
    /// # Errors
    /// [`VideoError::Format`].
    pub fn codec(&self) -> Result<String, VideoError> {
        codec_string::from_sample_entry(&SampleEntry::Avc1((*self.entry).clone()))
            .map_err(|error| VideoError::format(&self.path, format!("{error:?}")))
    }

    /// Returns the decoder's configuration: the content of the file's `avcC` box.
    ///
    /// # Errors
    /// [`VideoError::Format`].
    pub fn description(&self) -> Result<Vec<u8>, VideoError> {
        let bytes = self.entry.avcc_box.encode_to_vec();
        let bytes = bytes.map_err(|error| VideoError::format(&self.path, format!("{error:?}")))?;
        // Length and type stand before it.
        Ok(bytes[8..].to_vec())
    }

    /// Returns the width and height of the pictures in pixels.
    #[cfg(feature = "codec")]
    pub(crate) fn size(&self) -> [u32; 2] {
        [self.entry.visual.width, self.entry.visual.height].map(u32::from)
    }

    /// Returns the decoder's configuration.
    #[cfg(feature = "codec")]
    pub(crate) fn avcc(&self) -> &AvccBox {
        &self.entry.avcc_box
    }
}

/// Returns the parameter sets in the format of Annex B, which come before the first picture.
#[cfg(feature = "codec")]
pub fn parameters(avcc: &AvccBox) -> Vec<u8> {
    let sets = avcc.sps_list.iter().chain(&avcc.pps_list);
    sets.flat_map(|set| [&[0, 0, 0, 1], &set[..]].concat()).collect()
}

/// Returns how many bytes the length before each NAL unit of a picture has.
#[cfg(feature = "codec")]
pub fn length_size(avcc: &AvccBox) -> LengthSize {
    match avcc.length_size_minus_one.get() {
        0 => LengthSize::OneByte,
        1 => LengthSize::TwoBytes,
        _ => LengthSize::FourBytes,
    }
}

fn rgbd(path: &Path, entry: &Avc1Box) -> Result<Option<Rgbd>, VideoError> {
    let ours = entry.unknown_boxes.iter().find(|found| found.box_type == BoxType::Uuid(DEPTH_BOX));
    let Some(ours) = ours else { return Ok(None) };
    let rgbd: Rgbd =
        serde_json::from_slice(&ours.payload).map_err(|error| VideoError::format(path, error))?;
    match rgbd.is_valid() {
        true => Ok(Some(rgbd)),
        false => Err(VideoError::format(path, "its depth has parameters that are out of range")),
    }
}
