//! The index of an MP4 file: where its pictures are, and what their depth means.

use std::fmt::Display;
use std::io::{self, Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};

use shiguredo_mp4::boxes::{Avc1Box, SampleEntry};
use shiguredo_mp4::codec_string;
use shiguredo_mp4::demux::{Input, Mp4FileDemuxer};
use shiguredo_mp4::{BoxType, Encode as _, TrackKind};
#[cfg(feature = "codec")]
use shiguredo_mp4::{bitstream::h264::LengthSize, boxes::AvccBox};

use yoro_files::FileError;

use super::{DEPTH_BOX, Rgbd, VideoError};

/// The index of an MP4 file with H.264 video.
pub struct Index {
    path: PathBuf,
    /// The encoded pictures in decoding order.
    pub pictures: Vec<EncodedPicture>,
    /// Pictures per second by the first one's duration, rounded up.
    pub frame_rate: u32,
    /// For how long each picture is shown, in seconds, in the order in which they are shown.
    pub durations: Vec<f64>,
    depth: Option<Rgbd>,
    entry: Box<Avc1Box>,
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
    /// The time in seconds until the next picture is decoded.
    pub duration: f64,
    /// Its number, from 0, in the order in which pictures are shown. B-frames are shown before pictures that are decoded
    /// earlier.
    pub shown: usize,
}

/// The largest box of a file that is read whole, in bytes. An index has about 20 for a picture.
const MAX_BOX: u64 = 256 << 20;
/// The most pictures that are decoded before one that is shown earlier: H.264's limit.
const MAX_HELD: usize = 16;

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
            if size > MAX_BOX {
                return Err(VideoError::format(path, format!("its index has {} MiB", size >> 20)));
            }
            let data = read_at(file, required.position, size as usize).map_err(failed)?;
            demuxer.handle_input(Input { position: required.position, data: &data });
        }
        let mut pictures = Vec::new();
        // When each is shown, in ticks.
        let mut times = Vec::new();
        let (mut found, mut bytes) = (None, 0u64);
        while let Some(sample) =
            demuxer.next_sample().map_err(|error| VideoError::format(path, plain(&error)))?
        {
            // A small index can name any number of samples at one place.
            bytes = bytes.saturating_add(sample.data_size.max(1) as u64);
            if bytes > length {
                return Err(VideoError::format(path, "its index names more bytes than it has"));
            }
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
                shown: 0,
            });
            let offset = sample.composition_time_offset.unwrap_or(0);
            times.push((i64::try_from(sample.timestamp).unwrap_or(i64::MAX).saturating_add(offset), ticks));
        }
        let (entry, frame_rate) = found.ok_or_else(|| {
            let remedy = "`ffmpeg -i OLD.mp4 -c copy NEW.mp4` makes a file of one that is fragmented or stored as avc3";
            VideoError::format(path, format!("it has no H.264 video that can be read; {remedy}"))
        })?;
        let durations = sort(&mut pictures, &times)
            .ok_or_else(|| VideoError::format(path, "its pictures are not in an order of H.264"))?;
        let depth = rgbd(path, &entry)?;
        if let Some(rgbd) = &depth {
            let (w, h) = (usize::from(entry.visual.width), usize::from(entry.visual.height));
            let [width, height] = rgbd.coded();
            if [w, h] != [width, height] {
                let what = format!("it has {w}x{h} pixels, and its depth is described for {width}x{height}");
                return Err(VideoError::format(path, what));
            }
        }
        Ok(Index { path: path.into(), pictures, frame_rate, durations, depth, entry })
    }

    /// Returns the meaning of the depth in the pictures.
    ///
    /// # Errors
    /// [`VideoError::NoDepth`] for an ordinary video.
    pub fn rgbd(&self) -> Result<Rgbd, VideoError> {
        self.depth.ok_or_else(|| VideoError::NoDepth(self.path.clone()))
    }

    /// Returns the codec's name in the form that browsers take: `avc1.42C01F`.
    ///
    /// # Errors
    /// [`VideoError::Format`].
    pub fn codec(&self) -> Result<String, VideoError> {
        codec_string::from_sample_entry(&SampleEntry::Avc1((*self.entry).clone()))
            .map_err(|error| VideoError::format(&self.path, plain(&error)))
    }

    /// Returns the decoder's configuration: the content of the file's `avcC` box.
    ///
    /// # Errors
    /// [`VideoError::Format`].
    pub fn description(&self) -> Result<Vec<u8>, VideoError> {
        let bytes = self.entry.avcc_box.encode_to_vec();
        let bytes = bytes.map_err(|error| VideoError::format(&self.path, plain(&error)))?;
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

/// Returns an error of the MP4 library without the place in its source.
pub(super) fn plain(error: &dyn Display) -> String {
    let text = error.to_string();
    text.split_once(" (at ").map_or(text.as_str(), |(what, _)| what).to_owned()
}

/// Numbers pictures, which are in decoding order, in the order of their times (in ticks, with the ticks in a second).
/// Returns for how long each is shown, in that order; `None` if more have to be held back than H.264 allows.
fn sort(pictures: &mut [EncodedPicture], times: &[(i64, u32)]) -> Option<Vec<f64>> {
    let mut order: Vec<usize> = (0..pictures.len()).collect();
    order.sort_by_key(|i| times[*i].0);
    for (shown, i) in order.iter().enumerate() {
        pictures[*i].shown = shown;
    }
    let (mut is_decoded, mut shown) = (vec![false; pictures.len()], 0);
    for (i, picture) in pictures.iter().enumerate() {
        is_decoded[picture.shown] = true;
        shown += is_decoded[shown..].iter().take_while(|is| **is).count();
        if i + 1 - shown > MAX_HELD {
            return None;
        }
    }
    let until_next = order.windows(2).map(|two| {
        let [(from, ticks), (to, _)] = [two[0], two[1]].map(|i| times[i]);
        to.saturating_sub(from) as f64 / f64::from(ticks)
    });
    Some(until_next.chain(order.last().map(|last| pictures[*last].duration)).collect())
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pictures_are_numbered_as_they_are_shown() {
        let order = |times: &[i64]| {
            let encoded =
                EncodedPicture { offset: 0, size: 1, intra: false, time: 0.0, duration: 0.5, shown: 0 };
            let mut pictures = vec![encoded; times.len()];
            let times: Vec<_> = times.iter().map(|time| (*time, 10)).collect();
            let durations = sort(&mut pictures, &times)?;
            Some((pictures.iter().map(|picture| picture.shown).collect::<Vec<_>>(), durations))
        };
        assert_eq!(order(&[]), Some((vec![], vec![])));
        assert_eq!(order(&[20, 50, 30, 40]), Some((vec![0, 3, 1, 2], vec![1.0, 1.0, 1.0, 0.5])));
        assert_eq!(order(&[0, 1, 4, 2]), Some((vec![0, 1, 3, 2], vec![0.1, 0.1, 0.2, 0.5])));
        let last_first: Vec<i64> = (1..=16).chain([0]).collect();
        assert!(order(&last_first).is_some());
        assert_eq!(order(&(1..=17).chain([0]).collect::<Vec<_>>()), None, "H.264 holds 16 back");
    }
}
