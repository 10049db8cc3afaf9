//! Reads numbers from buffers, with every range checked.

use std::borrow::Cow;
use std::collections::{HashMap, HashSet};
use std::path::Path;

use gltf::accessor::{DataType, Dimensions};

use crate::error::{MAX_ELEMENTS, SceneError};
use crate::textures::{Source, TextureSet};

/// A file that is being read.
pub(super) struct Reader<'a> {
    pub(super) path: &'a Path,
    pub(super) buffers: Vec<Vec<u8>>,
    pub(super) textures: TextureSet,
    /// Sources of pictures by their number.
    pub(super) images: HashMap<usize, Option<Source>>,
    /// Names of pictures by their number.
    pub(super) pictures: Vec<String>,
    /// Textures in unknown formats that were warned of.
    pub(super) unknown: HashSet<usize>,
    /// The one animation that is played, by its name or number, if not all.
    pub(super) animation: Option<&'a str>,
}

impl Reader<'_> {
    pub(super) fn damaged(&self, what: String) -> SceneError {
        SceneError::unusable(self.path, format!("{what}; export the model again"))
    }

    pub(super) fn view(&self, view: &gltf::buffer::View) -> Result<&[u8], SceneError> {
        let end = view.offset().checked_add(view.length());
        let range = end.and_then(|end| self.buffers.get(view.buffer().index())?.get(view.offset()..end));
        range.ok_or_else(|| self.damaged(format!("buffer view {} reaches beyond its buffer", view.index())))
    }

    /// Returns the bytes of `count` elements from `offset` in a view, and the stride between their starts.
    fn stored(
        &self,
        accessor: &gltf::Accessor,
        view: &gltf::buffer::View,
        [offset, count, size]: [usize; 3],
    ) -> Result<(&[u8], usize), SceneError> {
        let stride = view.stride().unwrap_or(size);
        let length = count.checked_sub(1).map_or(Some(0), |n| n.checked_mul(stride)?.checked_add(size));
        let end = length.and_then(|n| n.checked_add(offset));
        let data = end.and_then(|end| self.view(view).ok()?.get(offset..end));
        match data {
            Some(data) if stride >= size => Ok((data, stride)),
            _ => Err(self.damaged(format!("accessor {} reaches beyond its buffer", accessor.index()))),
        }
    }

    /// Returns the bytes of an accessor's elements, and the stride between their starts. Without a buffer view all
    /// elements are zero; a sparse accessor replaces some of them.
    fn elements(&self, accessor: &gltf::Accessor) -> Result<(Cow<'_, [u8]>, usize), SceneError> {
        let (count, size) = (accessor.count(), accessor.size());
        let base = accessor
            .view()
            .map(|view| self.stored(accessor, &view, [accessor.offset(), count, size]))
            .transpose()?;
        if let (Some((data, stride)), None) = (base, accessor.sparse()) {
            return Ok((Cow::Borrowed(data), stride));
        }
        if count > MAX_ELEMENTS {
            return Err(SceneError::too_large(self.path, MAX_ELEMENTS, "elements in an accessor"));
        }
        let mut elements = match base {
            Some((data, stride)) => {
                (0..count).flat_map(|i| &data[i * stride..i * stride + size]).copied().collect()
            }
            None => vec![0; count * size],
        };
        let Some(sparse) = accessor.sparse() else { return Ok((elements.into(), size)) };
        let (indices, values) = (sparse.indices(), sparse.values());
        let width = indices.index_type().size();
        let (places, places_stride) =
            self.stored(accessor, &indices.view(), [indices.offset(), sparse.count(), width])?;
        let (data, stride) =
            self.stored(accessor, &values.view(), [values.offset(), sparse.count(), size])?;
        for i in 0..sparse.count() {
            let place = &places[i * places_stride..][..width];
            let place = place.iter().rev().fold(0, |place, &byte| place << 8 | usize::from(byte));
            let Some(element) = elements.chunks_exact_mut(size).nth(place) else {
                let what = format!("accessor {} replaces elements that do not exist", accessor.index());
                return Err(self.damaged(what));
            };
            element.copy_from_slice(&data[i * stride..i * stride + size]);
        }
        Ok((elements.into(), size))
    }

    /// Returns the first N components of vectors of one of the `wanted` kinds.
    pub(super) fn floats<const N: usize>(
        &self,
        accessor: &gltf::Accessor,
        wanted: &[Dimensions],
    ) -> Result<Vec<[f32; N]>, SceneError> {
        if !wanted.contains(&accessor.dimensions()) {
            return Err(self.damaged(format!("accessor {} has the wrong type", accessor.index())));
        }
        let (data, stride) = self.elements(accessor)?;
        let kind = accessor.data_type();
        let width = kind.size();
        let scale = if accessor.normalized() {
            match kind {
                DataType::I8 => 1.0 / 127.0,
                DataType::U8 => 1.0 / 255.0,
                DataType::I16 => 1.0 / 32767.0,
                DataType::U16 => 1.0 / 65535.0,
                DataType::U32 | DataType::F32 => 1.0,
            }
        } else {
            1.0
        };
        let value = |b: &[u8]| match kind {
            DataType::I8 => b[0] as i8 as f32,
            DataType::U8 => b[0] as f32,
            DataType::I16 => i16::from_le_bytes([b[0], b[1]]) as f32,
            DataType::U16 => u16::from_le_bytes([b[0], b[1]]) as f32,
            DataType::U32 => u32::from_le_bytes([b[0], b[1], b[2], b[3]]) as f32,
            DataType::F32 => f32::from_le_bytes([b[0], b[1], b[2], b[3]]),
        };
        Ok((0..accessor.count())
            .map(|i| std::array::from_fn(|k| value(&data[i * stride + k * width..]) * scale))
            .collect())
    }

    pub(super) fn indices(&self, accessor: &gltf::Accessor, vertices: usize) -> Result<Vec<u32>, SceneError> {
        let (data, stride) = self.elements(accessor)?;
        let at = |i: usize| {
            let b = &data[i * stride..];
            Some(match (accessor.dimensions(), accessor.data_type()) {
                (Dimensions::Scalar, DataType::U8) => b[0] as u32,
                (Dimensions::Scalar, DataType::U16) => u16::from_le_bytes([b[0], b[1]]) as u32,
                (Dimensions::Scalar, DataType::U32) => u32::from_le_bytes([b[0], b[1], b[2], b[3]]),
                _ => return None,
            })
        };
        let list: Option<Vec<u32>> =
            (0..accessor.count()).map(at).map(|i| i.filter(|&i| (i as usize) < vertices)).collect();
        list.ok_or_else(|| {
            self.damaged(format!("accessor {} names vertices that do not exist", accessor.index()))
        })
    }
}
