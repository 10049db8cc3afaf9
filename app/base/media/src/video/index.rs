//! The index of an MP4 file: where its pictures are, and what their depth means.

use std::io::{self, Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};

use shiguredo_mp4::boxes::{Avc1Box, SampleEntry};
use shiguredo_mp4::codec_string;
use shiguredo_mp4::demux::{Input, Mp4FileDemuxer};
use shiguredo_mp4::{BoxType, Encode as _, TrackKind};
#[cfg(feature = "codec")]
use shiguredo_mp4::{bitstream::h264::LengthSize, boxes::AvccBox};

use yoro_files::FileError;

use super::record3d::{self, Recording};
use super::{DEPTH_BOX, Planes, Rgbd, VideoError};

/// The index of an MP4 file with H.264 video.
pub struct Index {
    path: PathBuf,
    /// The encoded pictures in decoding order.
    pub pictures: Vec<EncodedPicture>,
    /// Pictures per second, rounded up.
    pub frame_rate: u32,
    depth: Option<Depth>,
    entry: Box<Avc1Box>,
}

/// The kind of depth that a video has.
enum Depth {
    /// Luma, as [`Rgbd::pack`] writes it.
    Luma(Rgbd),
    /// Hue, as the application Record3D writes it.
    Hue(Recording),
}

/// The location of an encoded picture in a file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EncodedPicture {
    /// Offset in bytes from the beginning of the file.
    pub offset: u64,
    /// Size in bytes.
    pub size: usize,
    /// True if the picture can be decoded without others.
    pub intra: bool,
    /// Decoding time in seconds.
    pub time: f64,
    /// How long the picture is shown, in seconds.
    pub duration: f64,
}

/// Reads a part of a file.
pub(crate) fn read_at(file: &mut (impl Read + Seek), position: u64, size: usize) -> io::Result<Vec<u8>> {
    file.seek(SeekFrom::Start(position))?;
    let mut bytes = vec![0; size];
    file.read_exact(&mut bytes)?;
    Ok(bytes)
}

impl Index {
    /// Reads the index of a file that is `length` bytes long; only the parts needed for it are read. Errors name
    /// `path`.
    ///
    /// # Errors
    /// [`VideoError::File`] if the file cannot be read, [`VideoError::Format`] if it is damaged or has no H.264 video.
    pub fn read(path: &Path, file: &mut (impl Read + Seek), length: u64) -> Result<Index, VideoError> {
        let failed = |source| VideoError::from(FileError::Read { path: path.into(), source });
        let mut demuxer = Mp4FileDemuxer::new();
        while let Some(required) = demuxer.required_input() {
            let rest = length.saturating_sub(required.position);
            let size = required.size.map_or(rest, |size| size as u64);
            if size == 0 || size > rest {
                return Err(VideoError::format(path, "it is no MP4 file, or it is cut off"));
            }
            let data = read_at(file, required.position, size as usize).map_err(failed)?;
            demuxer.handle_input(Input { position: required.position, data: &data });
        }
        let damaged = |error: &dyn std::fmt::Debug| VideoError::format(path, format!("{error:?}"));
        let mut pictures = Vec::new();
        let mut found = None;
        while let Some(sample) = demuxer.next_sample().map_err(|error| damaged(&error))? {
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
            if sample.data_offset.checked_add(sample.data_size as u64).is_none_or(|end| end > length) {
                return Err(VideoError::format(path, "it is cut off"));
            }
            pictures.push(EncodedPicture {
                offset: sample.data_offset,
                size: sample.data_size,
                intra: sample.keyframe,
                time: sample.timestamp as f64 / f64::from(ticks),
                duration: f64::from(sample.duration) / f64::from(ticks),
            });
        }
        let (entry, frame_rate) = found.ok_or_else(|| VideoError::format(path, "it has no H.264 video"))?;
        let size = [entry.visual.width, entry.visual.height].map(u32::from);
        let depth = match rgbd(path, &entry)? {
            Some(rgbd) => Some(Depth::Luma(rgbd)),
            None => {
                let recording = record3d::find(file, length, size).map_err(failed)?.transpose();
                recording.map_err(|what| VideoError::format(path, what))?.map(Depth::Hue)
            }
        };
        Ok(Index { path: path.into(), pictures, frame_rate, depth, entry })
    }

    /// Returns the meaning of the depth in the pictures.
    ///
    /// # Errors
    /// [`VideoError::NoDepth`] for an ordinary video.
    pub fn rgbd(&self) -> Result<Rgbd, VideoError> {
        match self.depth {
            Some(Depth::Luma(rgbd) | Depth::Hue(Recording { rgbd, .. })) => Ok(rgbd),
            None => Err(VideoError::NoDepth { path: self.path.clone() }),
        }
    }

    /// True if the pictures have to be [packed](Index::packed) after decoding.
    pub fn has_hues(&self) -> bool {
        matches!(self.depth, Some(Depth::Hue(_)))
    }

    /// Returns a decoded picture in the layout of [`Rgbd::pack`].
    pub fn packed(&self, picture: Planes) -> Planes {
        match &self.depth {
            Some(Depth::Hue(recording)) => recording.packed(&picture),
            _ => picture,
        }
    }

    /// Returns the codec's name in the form that browsers take: `avc1.42C01F`.
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
        // Without the length and type before it.
        Ok(bytes[8..].to_vec())
    }

    /// Returns the decoder's configuration.
    #[cfg(feature = "codec")]
    pub(crate) fn avcc(&self) -> &AvccBox {
        &self.entry.avcc_box
    }
}

/// Returns the parameter sets in the format of Annex B, which precede the first picture.
#[cfg(feature = "codec")]
pub fn parameters(avcc: &AvccBox) -> Vec<u8> {
    let sets = avcc.sps_list.iter().chain(&avcc.pps_list);
    sets.flat_map(|set| [&[0, 0, 0, 1], &set[..]].concat()).collect()
}

/// Returns the number of bytes of the length before each NAL unit of a picture.
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
