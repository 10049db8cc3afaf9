//! MP4 files: written picture by picture, and read and decoded.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::{self, BufReader, Seek, SeekFrom, Write};
use std::num::NonZeroU32;
use std::path::{Path, PathBuf};

use image::{GrayImage, RgbImage};
use shiguredo_mp4::bitstream::h264::{
    H264NalUnitType, H264SampleEntryConfig, LengthSize, annexb_to_length_prefixed,
    build_avc1_box_from_annexb, length_prefixed_to_annexb, parse_annexb_nal_units,
};
use shiguredo_mp4::boxes::{Avc1Box, SampleEntry, UnknownBox};
use shiguredo_mp4::mux::{Mp4FileMuxer, Mp4FileMuxerOptions, Sample, estimate_maximum_moov_box_size};
use shiguredo_mp4::{BoxSize, BoxType, TrackKind};
use yoro_files::{self as files, FileError};

use super::index::{length_size, parameters, plain, read_at};
use super::{DEPTH_BOX, Decoder, EncodedPicture, Encoder, Index, Planes, Rgbd, VideoError};

/// How a video is encoded.
#[derive(Clone, Debug, PartialEq)]
pub struct Format {
    /// Pictures per second. There is an intra frame, at which players can start, once a second.
    pub frame_rate: u32,
    /// H.264's quantizer (QP), [`FINEST_QUANTIZER`](super::FINEST_QUANTIZER) to 51.
    pub quantizer: u8,
    /// For how long each picture is shown, in seconds, if not always for the same time.
    pub durations: Option<Vec<f64>>,
    /// The expected number of pictures, for whose index room is reserved at the file's beginning, for fast starts.
    pub frames: usize,
    /// The meaning of the depth, for an RGBD video.
    pub rgbd: Option<Rgbd>,
}

/// Writes the pictures that `next` returns, all of one size, until it returns `None`. Returns the number of bytes of
/// the encoded pictures. The file appears only when it is complete.
///
/// # Errors
/// [`VideoError`], and the errors of `next`.
pub fn write<E: From<VideoError>>(
    path: &Path,
    format: &Format,
    next: impl FnMut() -> Result<Option<Planes>, E>,
) -> Result<u64, E> {
    let mut result = Ok(0);
    let written = files::write_with(path, |out| match fill(out, path, format, next) {
        Ok(bytes) => {
            result = Ok(bytes);
            Ok(())
        }
        Err(Stop::Io(error)) => Err(error),
        Err(Stop::Caller(error)) => {
            result = Err(error);
            Err(io::Error::other("the video was not finished"))
        }
    });
    match written {
        Ok(()) => result,
        Err(error) => Err(result.err().unwrap_or_else(|| VideoError::from(error).into())),
    }
}

/// Writes all pictures, and returns the number of bytes of the encoded pictures.
fn fill<E: From<VideoError>>(
    out: &mut (impl Write + Seek),
    path: &Path,
    format: &Format,
    mut next: impl FnMut() -> Result<Option<Planes>, E>,
) -> Result<u64, Stop<E>> {
    let mut muxer = Muxer::new::<E>(out, path, format)?;
    while let Some(picture) = next().map_err(Stop::Caller)? {
        muxer.add::<E>(&picture)?;
    }
    muxer.finish()
}

/// The reason why a file is not finished.
enum Stop<E> {
    Io(io::Error),
    Caller(E),
}

impl<E> From<io::Error> for Stop<E> {
    fn from(error: io::Error) -> Stop<E> {
        Stop::Io(error)
    }
}

impl<E: From<VideoError>> From<VideoError> for Stop<E> {
    fn from(error: VideoError) -> Stop<E> {
        Stop::Caller(error.into())
    }
}

const LENGTH_SIZE: LengthSize = LengthSize::FourBytes;

/// A file that is being written picture by picture.
struct Muxer<'a, W> {
    out: &'a mut W,
    path: &'a Path,
    format: &'a Format,
    encoder: Encoder,
    muxer: Mp4FileMuxer,
    offset: u64,
    frames: u32,
    /// When the next picture is shown: in seconds if the format has durations, and in ticks.
    time: f64,
    ticks: u64,
    /// The ticks since the last intra frame.
    since_intra: u64,
    bytes: u64,
}

/// Ticks a second for pictures that are shown for different times.
const TICKS: u32 = 90_000;

impl<'a, W: Write + Seek> Muxer<'a, W> {
    fn new<E: From<VideoError>>(
        out: &'a mut W,
        path: &'a Path,
        format: &'a Format,
    ) -> Result<Muxer<'a, W>, Stop<E>> {
        let encoder = Encoder::new(format.quantizer, format.frame_rate as f32)?;
        // The box with the depth's meaning takes less than 1 KiB.
        let room = estimate_maximum_moov_box_size(&[format.frames]) + 1024;
        let options = Mp4FileMuxerOptions { reserved_moov_box_size: room, ..Mp4FileMuxerOptions::default() };
        let muxer =
            Mp4FileMuxer::with_options(options).map_err(|error| VideoError::format(path, plain(&error)))?;
        out.write_all(muxer.initial_boxes_bytes())?;
        let offset = muxer.initial_boxes_bytes().len() as u64;
        Ok(Muxer {
            out,
            path,
            format,
            encoder,
            muxer,
            offset,
            frames: 0,
            time: 0.0,
            ticks: 0,
            since_intra: 0,
            bytes: 0,
        })
    }

    fn add<E: From<VideoError>>(&mut self, picture: &Planes) -> Result<(), Stop<E>> {
        let (timescale, duration) = self.duration();
        if self.since_intra >= u64::from(timescale) {
            self.encoder.force_intra_frame();
            self.since_intra = 0;
        }
        self.since_intra += u64::from(duration);
        let encoded = self.encoder.encode(picture)?;
        let failed = |error: &dyn std::fmt::Display| VideoError::format(self.path, plain(error));
        let units = parse_annexb_nal_units(&encoded).map_err(|error| failed(&error))?;
        let keyframe = units.iter().any(|unit| unit.nal_unit_type == H264NalUnitType::IdrSlice);
        let sample_entry = match self.frames {
            0 => Some(SampleEntry::Avc1(self.entry(&encoded)?)),
            _ => None,
        };
        let data = annexb_to_length_prefixed(&encoded, LENGTH_SIZE).map_err(|error| failed(&error))?;
        self.out.write_all(&data)?;
        let sample = Sample {
            track_kind: TrackKind::Video,
            sample_entry,
            keyframe,
            timescale: NonZeroU32::new(timescale).unwrap_or(NonZeroU32::MIN),
            duration,
            composition_time_offset: None,
            data_offset: self.offset,
            data_size: data.len(),
        };
        self.muxer.append_sample(&sample).map_err(|error| failed(&error))?;
        self.offset += data.len() as u64;
        self.bytes += data.len() as u64;
        self.frames += 1;
        Ok(())
    }

    /// Returns the ticks in a second, and the ticks for which the next picture is shown.
    fn duration(&mut self) -> (u32, u32) {
        let Some(durations) = &self.format.durations else { return (self.format.frame_rate, 1) };
        self.time += durations.get(self.frames as usize).copied().unwrap_or(0.0);
        // Rounding does not add up.
        let end = (self.time * f64::from(TICKS)).round() as u64;
        let duration = end.saturating_sub(self.ticks).clamp(1, u64::from(u32::MAX));
        self.ticks += duration;
        (TICKS, duration as u32)
    }

    /// Returns the sample entry that describes the encoded pictures and the meaning of their depth.
    fn entry(&self, encoded: &[u8]) -> Result<Avc1Box, VideoError> {
        let config = H264SampleEntryConfig { length_size: LENGTH_SIZE };
        let mut entry = build_avc1_box_from_annexb(encoded, &config)
            .map_err(|error| VideoError::format(self.path, plain(&error)))?;
        if let Some(rgbd) = &self.format.rgbd {
            let payload = serde_json::to_vec(rgbd).expect("numbers have a text");
            let box_type = BoxType::Uuid(DEPTH_BOX);
            let box_size = BoxSize::with_payload_size(box_type, payload.len() as u64);
            entry.unknown_boxes.push(UnknownBox { box_type, box_size, payload });
        }
        Ok(entry)
    }

    fn finish<E: From<VideoError>>(mut self) -> Result<u64, Stop<E>> {
        let boxes = self.muxer.finalize().map_err(|error| VideoError::format(self.path, plain(&error)))?;
        for (offset, bytes) in boxes.offset_and_bytes_pairs() {
            self.out.seek(SeekFrom::Start(offset))?;
            self.out.write_all(bytes)?;
        }
        self.out.seek(SeekFrom::End(0))?;
        Ok(self.bytes)
    }
}

/// A video file that is decoded picture by picture.
pub struct Reader {
    path: PathBuf,
    file: BufReader<File>,
    index: Index,
    /// The number of pictures that have been decoded, and of those that have been returned.
    decoded: usize,
    returned: usize,
    /// Decoded pictures that are shown after others, by their number.
    held: BTreeMap<usize, Planes>,
    /// The parameter sets in the format of Annex B, which precede the first picture.
    parameters: Vec<u8>,
    decoder: Decoder,
}

impl Reader {
    /// Opens a file and reads its index. [`Reader::read`] reads the pictures.
    ///
    /// # Errors
    /// [`VideoError::File`], and [`VideoError::Format`] for a file that is not an MP4 file or has no H.264 video.
    pub fn open(path: &Path) -> Result<Reader, VideoError> {
        if path.is_dir() {
            return Err(FileError::IsFolder(path.into()).into());
        }
        let failed = |source: io::Error| match source.kind() {
            io::ErrorKind::NotFound => FileError::Missing(path.into()),
            _ => FileError::Read { path: path.into(), source },
        };
        // To open a pipe would wait for somebody who writes.
        if std::fs::metadata(path).is_ok_and(|data| !data.is_file()) {
            return Err(VideoError::format(path, "it is a pipe or a device"));
        }
        let mut file = BufReader::new(File::open(path).map_err(failed)?);
        let length = file.get_ref().metadata().map_err(failed)?.len();
        let index = Index::read(path, &mut file, length)?;
        let (parameters, decoder) = (parameters(index.avcc()), Decoder::new()?);
        let path = path.into();
        Ok(Reader { path, file, index, decoded: 0, returned: 0, held: BTreeMap::new(), parameters, decoder })
    }

    /// Returns the number of pictures that remain to be read.
    pub fn frames(&self) -> usize {
        self.index.pictures.len() - self.returned
    }

    /// Returns the number of pictures per second by the first one's duration, rounded up.
    pub fn frame_rate(&self) -> u32 {
        self.index.frame_rate
    }

    /// Returns for how long each picture is shown, in seconds; `None` if all are shown for the same time.
    pub fn durations(&self) -> Option<Vec<f64>> {
        let all = &self.index.durations;
        let same = |two: &[f64]| (two[0] - two[1]).abs() < 1e-6;
        (!all.windows(2).all(same)).then(|| all.clone())
    }

    /// Returns the meaning of the depth in the pictures.
    ///
    /// # Errors
    /// [`VideoError::NoDepth`] for an ordinary video.
    pub fn rgbd(&self) -> Result<Rgbd, VideoError> {
        self.index.rgbd()
    }

    /// Returns colour and depth of the next picture, or `None` after the last. [`Rgbd`] describes the depth.
    ///
    /// # Errors
    /// Those of [`Reader::read`], and [`VideoError::NoDepth`] for an ordinary video.
    pub fn read_rgbd(&mut self) -> Result<Option<(RgbImage, GrayImage)>, VideoError> {
        let rgbd = self.rgbd()?;
        Ok(self.read()?.map(|picture| rgbd.unpack(&picture)))
    }

    /// Returns for how long the picture that was read last is shown, in seconds; 0 before the first.
    pub fn duration(&self) -> f64 {
        self.returned.checked_sub(1).map_or(0.0, |last| self.index.durations[last])
    }

    /// Goes back to the first picture.
    ///
    /// # Errors
    /// [`VideoError::Codec`].
    pub fn rewind(&mut self) -> Result<(), VideoError> {
        self.go_to(0, 0)
    }

    /// Goes on at the next intra frame, after a picture that cannot be read. Returns false if there is none.
    ///
    /// # Errors
    /// [`VideoError::Codec`].
    pub fn skip(&mut self) -> Result<bool, VideoError> {
        let mut rest = self.index.pictures.iter().enumerate().skip(self.decoded);
        match rest.find(|(_, picture)| picture.intra).map(|(i, picture)| (i, picture.shown)) {
            Some((decoded, returned)) => self.go_to(decoded, returned).map(|()| true),
            None => Ok(false),
        }
    }

    /// Starts a decoder at a picture in decoding order, which is shown as number `returned`.
    fn go_to(&mut self, decoded: usize, returned: usize) -> Result<(), VideoError> {
        (self.decoded, self.returned, self.held) = (decoded, returned, BTreeMap::new());
        (self.parameters, self.decoder) = (parameters(self.index.avcc()), Decoder::new()?);
        Ok(())
    }

    /// Returns the next picture in the order in which they are shown, or `None` after the last.
    ///
    /// # Errors
    /// [`VideoError::File`], and [`VideoError::Format`] for a damaged picture, or for one whose size does not match the
    /// depth's description.
    pub fn read(&mut self) -> Result<Option<Planes>, VideoError> {
        loop {
            if let Some(picture) = self.held.remove(&self.returned) {
                self.returned += 1;
                return Ok(Some(picture));
            }
            let Some(&encoded) = self.index.pictures.get(self.decoded) else { return Ok(None) };
            self.decoded += 1;
            let picture = self.decode(encoded)?;
            // After a skipped part, a picture may belong before its intra frame.
            if encoded.shown >= self.returned {
                self.held.insert(encoded.shown, picture);
            }
        }
    }

    fn decode(&mut self, EncodedPicture { offset, size, .. }: EncodedPicture) -> Result<Planes, VideoError> {
        let data = read_at(&mut self.file, offset, size)
            .map_err(|source| FileError::Read { path: self.path.clone(), source })?;
        let annex_b = length_prefixed_to_annexb(&data, length_size(self.index.avcc()))
            .map_err(|error| VideoError::format(&self.path, plain(&error)))?;
        let bytes = [std::mem::take(&mut self.parameters), annex_b].concat();
        let picture = self.decoder.decode(&bytes).map_err(|error| VideoError::format(&self.path, error))?;
        if let Ok(rgbd) = self.rgbd() {
            let ([w, h], [width, height]) = (picture.size, rgbd.coded());
            if [w, h] != [width, height] {
                let what =
                    format!("a picture has {w}x{h} pixels, and its depth is described for {width}x{height}");
                return Err(VideoError::format(&self.path, what));
            }
        }
        Ok(picture)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::video::rgbd::tests::RGBD;
    use image::Rgb;
    use std::fs;

    const FORMAT: Format =
        Format { frame_rate: 3, quantizer: 20, durations: None, frames: 7, rgbd: Some(RGBD) };

    fn picture(frame: u32) -> Planes {
        let color = RgbImage::from_fn(64, 32, |x, y| Rgb([(x * 3) as u8, (y * 5 + frame) as u8, 90]));
        RGBD.pack(&color, |x, y| 0.5 + (x + y + frame) as f32 / 10.0)
    }

    fn video(path: &Path) -> u64 {
        let mut pictures = (0..7).map(picture);
        write::<VideoError>(path, &FORMAT, || Ok(pictures.next())).unwrap()
    }

    #[test]
    fn what_was_written_is_read() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("v.mp4");
        let bytes = video(&path);
        let file = fs::read(&path).unwrap();
        assert!(bytes > 0 && bytes < file.len() as u64);
        let at = |name: &[u8]| file.windows(4).position(|four| four == name).unwrap();
        assert!(at(b"moov") < at(b"mdat"), "players need not read the end first");
        let mut reader = Reader::open(&path).unwrap();
        assert_eq!((reader.frames(), reader.frame_rate(), reader.rgbd().unwrap()), (7, 3, RGBD));
        for frame in 0..7 {
            let (read, wanted) = (reader.read().unwrap().unwrap(), picture(frame));
            let worst = read.planes[0].iter().zip(&wanted.planes[0]).map(|(a, b)| a.abs_diff(*b)).max();
            assert!(read.size == wanted.size && worst.unwrap() < 24, "frame {frame}: {worst:?}");
        }
        assert!(reader.read().unwrap().is_none());
    }

    #[test]
    fn pictures_are_shown_as_long_as_they_were() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("v.mp4");
        let durations = vec![0.1, 0.5, 0.1, 0.3, 0.2, 0.7, 0.1];
        let mut pictures = (0..7).map(picture);
        let format = Format { durations: Some(durations.clone()), ..FORMAT };
        write::<VideoError>(&path, &format, || Ok(pictures.next())).unwrap();
        let mut reader = Reader::open(&path).unwrap();
        let read = reader.durations().unwrap();
        assert!(read.iter().zip(&durations).all(|(a, b)| (a - b).abs() < 1e-4), "{read:?}");
        reader.read().unwrap();
        reader.read().unwrap();
        assert!((reader.duration() - 0.5).abs() < 1e-4);
        video(&path);
        assert_eq!(Reader::open(&path).unwrap().durations(), None, "all are shown for 1/3 s");
    }

    /// x264's pictures with B-frames, each lighter than the one before. tests/README.md says how they were made.
    #[test]
    fn b_frames_are_read_in_the_order_in_which_they_are_shown() {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/b-frames.mp4");
        let mut reader = Reader::open(&path).unwrap();
        assert!(!reader.index.pictures.is_sorted_by_key(|picture| picture.shown), "it has B-frames");
        for round in 0..2 {
            for frame in 0..8u8 {
                let luma = reader.read().unwrap().unwrap().planes[0][0];
                assert!(luma.abs_diff(20 + 25 * frame) < 3, "round {round}, frame {frame}: {luma}");
                assert!((reader.duration() - 0.1).abs() < 1e-6);
            }
            assert!(reader.read().unwrap().is_none());
            reader.rewind().unwrap();
        }
    }

    #[test]
    fn after_a_damaged_picture_the_next_intra_frame_is_read() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("v.mp4");
        video(&path);
        // At 3 pictures/s, the pictures 0, 3 and 6 are intra frames.
        let EncodedPicture { offset, size, .. } = Reader::open(&path).unwrap().index.pictures[1];
        let mut file = fs::read(&path).unwrap();
        file[offset as usize..][..size].fill(0xa5);
        fs::write(&path, &file).unwrap();
        let mut reader = Reader::open(&path).unwrap();
        let whole = reader.read().unwrap().unwrap();
        assert!(reader.read().is_err() && reader.skip().unwrap());
        assert_eq!(reader.frames(), 4);
        assert_eq!(std::iter::from_fn(|| reader.read().unwrap()).count(), 4);
        assert!(!reader.skip().unwrap(), "there is no other");
        reader.rewind().unwrap();
        assert_eq!(reader.read().unwrap().unwrap(), whole);
    }

    #[test]
    fn small_files_cannot_ask_for_much() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("v.mp4");
        video(&path);
        let whole = fs::read(&path).unwrap();
        let at = |name: &[u8; 4]| whole.windows(4).position(|four| four == name).unwrap();
        let refused = |bytes: &[u8], length: u64, what: &str| {
            fs::write(&path, bytes).unwrap();
            fs::OpenOptions::new().write(true).open(&path).unwrap().set_len(length).unwrap();
            let output = Reader::open(&path).err().unwrap().to_string();
            assert!(output.contains(what) && !output.contains("src/"), "{output}");
        };
        // The index says that it has a GiB, in a file with as much, most of it a hole.
        let mut large = whole.clone();
        large[at(b"moov") - 4..][..4].copy_from_slice(&(1u32 << 30).to_be_bytes());
        refused(&large, 2 << 30, "its index has 1024 MiB");
        // All pictures are as large as the file.
        let mut much = whole.clone();
        let sizes = at(b"stsz") + 16;
        (0..7).for_each(|i| {
            much[sizes + 4 * i..][..4].copy_from_slice(&((whole.len() - 1) as u32).to_be_bytes())
        });
        refused(&much, whole.len() as u64, "");
    }

    #[test]
    fn a_caller_who_stops_leaves_the_old_file() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("v.mp4");
        fs::write(&path, "old").unwrap();
        let stopped = write(&path, &FORMAT, || Err(VideoError::Codec("enough".into())));
        assert!(matches!(stopped, Err(VideoError::Codec(what)) if what == "enough"));
        assert_eq!(fs::read(&path).unwrap(), b"old");
    }

    /// Any byte of a file may be wrong, and it may end anywhere.
    #[test]
    fn damaged_files_are_errors() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("v.mp4");
        video(&path);
        let whole = fs::read(&path).unwrap();
        let read = |bytes: &[u8]| -> Result<usize, VideoError> {
            fs::write(&path, bytes).unwrap();
            let mut reader = Reader::open(&path)?;
            let mut frames = 0;
            while reader.read_rgbd()?.is_some() {
                frames += 1;
            }
            Ok(frames)
        };
        assert_eq!(read(&whole).unwrap(), 7);
        for length in (0..whole.len() - 1).step_by(whole.len() / 40) {
            assert!(read(&whole[..length]).is_err(), "{length} bytes");
        }
        let mut seed = 1u32;
        let mut next = || {
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (seed >> 8) as usize
        };
        for _ in 0..400 {
            let mut damaged = whole.clone();
            for _ in 0..=next() % 4 {
                let at = next() % damaged.len();
                damaged[at] = next() as u8;
            }
            // No crash and no endless loop; whatever can be read is read.
            let _ = read(&damaged);
        }
        fs::write(&path, "no video").unwrap();
        let error = Reader::open(&path).err().unwrap().to_string();
        assert!(error.contains("v.mp4 cannot be read as a video"), "{error}");
    }
}
