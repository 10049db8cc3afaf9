//! Mip levels of pictures that cut holes.
//!
//! Averaging alpha makes leaves vanish with distance. Here the alpha of each level is scaled up until about as much of it
//! is above the cut-off as of the picture itself (Castaño 2010, "Computing Alpha Mipmaps"). Where alpha is a ramp, that
//! is so without scaling, and the cut stays where it is.

use std::collections::HashMap;

use yoro_assets::{Alpha, Model, TextureImage};

/// The share of a picture's coverage that its levels keep. Less than all of it, since lines get thinner and thicker
/// where cuts through ramps must stay.
const KEPT: f64 = 0.9;
/// Largest factor of alpha.
const MAX_SCALE: f32 = 4.0;
/// Levels with fewer texels are interpolated for counting, at this many places along each edge of a texel.
const INTERPOLATED_BELOW: usize = 1 << 14;
const PLACES: u32 = 4;

/// Gives each cut-off of a picture a picture of its own, and returns the cut-off of each picture, if it has one.
pub(super) fn split(model: &mut Model) -> Vec<Option<f32>> {
    let mut cutoffs: Vec<Option<f32>> = vec![None; model.textures.len()];
    // The first use of a picture keeps it.
    let mut taken: HashMap<usize, Vec<(Option<u32>, usize)>> = HashMap::new();
    for material in &mut model.materials {
        let cutoff = match material.alpha {
            Alpha::Cutout(cutoff) => Some(cutoff),
            Alpha::Opaque | Alpha::Blend(_) => None,
        };
        let maps = [&mut material.diffuse_map, &mut material.specular_map, &mut material.emissive_map];
        for (i, map) in maps.into_iter().enumerate() {
            let Some(index) = *map else { continue };
            let cutoff = cutoff.filter(|_| i == 0);
            let copies = taken.entry(index).or_default();
            let known = copies.iter().find(|(of, _)| *of == cutoff.map(f32::to_bits)).map(|(_, copy)| *copy);
            let copy = known.unwrap_or_else(|| {
                let copy = if copies.is_empty() { index } else { model.textures.len() };
                if copy != index {
                    let image: TextureImage = model.textures[index].clone();
                    model.textures.push(image);
                    cutoffs.push(None);
                }
                cutoffs[copy] = cutoff;
                copies.push((cutoff.map(f32::to_bits), copy));
                copy
            });
            *map = Some(copy);
        }
    }
    cutoffs
}

/// Returns the mip levels of a picture from level 1 on, in 8-bit RGBA, with alpha for a cut-off.
pub(super) fn levels(rgba: Vec<u8>, size: [u32; 2], srgb: bool, cutoff: f32) -> Vec<Vec<u8>> {
    let wanted = Histogram::of(&rgba, size).share_from(threshold(cutoff));
    let mut levels = Vec::new();
    let (mut above, mut size) = (rgba, size);
    while size != [1, 1] {
        (above, size) = halved(&above, size, srgb);
        let mut level = above.clone();
        let scale = Histogram::of(&above, size).scale_for(wanted, cutoff);
        level
            .iter_mut()
            .skip(3)
            .step_by(4)
            .for_each(|a| *a = (f32::from(*a) * scale).round().min(255.0) as u8);
        levels.push(level);
    }
    levels
}

/// Returns the smallest 8-bit alpha that is not below the cut-off.
fn threshold(cutoff: f32) -> usize {
    (cutoff * 255.0 - 1e-3).ceil().clamp(0.0, 255.0) as usize
}

/// Returns the means of blocks of 2 x 2 texels, of colours in linear light.
fn halved(rgba: &[u8], [w, h]: [u32; 2], srgb: bool) -> (Vec<u8>, [u32; 2]) {
    let to_linear: Vec<f32> = (0..256u32)
        .map(|c| c as f32 / 255.0)
        .map(|c| match c {
            _ if !srgb => c,
            _ if c <= 0.04045 => c / 12.92,
            _ => ((c + 0.055) / 1.055).powf(2.4),
        })
        .collect();
    // The inverse by search in the table, since a power for each channel takes longer than all else.
    let encoded = |x: f32| {
        let above = to_linear.partition_point(|l| *l < x).clamp(1, 255);
        if x - to_linear[above - 1] < to_linear[above] - x { above as u8 - 1 } else { above as u8 }
    };
    let size = [w, h].map(|n| (n / 2).max(1));
    let mut out = Vec::with_capacity(size[0] as usize * size[1] as usize * 4);
    for (x, y) in (0..size[1]).flat_map(|y| (0..size[0]).map(move |x| (x, y))) {
        let texel = |i: u32| {
            let (x, y) = ((2 * x + i % 2).min(w - 1), (2 * y + i / 2).min(h - 1));
            &rgba[(y as usize * w as usize + x as usize) * 4..][..4]
        };
        let texels = [0, 1, 2, 3].map(texel);
        for c in 0..3 {
            out.push(encoded(texels.iter().map(|t| to_linear[usize::from(t[c])]).sum::<f32>() / 4.0));
        }
        out.push((texels.iter().map(|t| u32::from(t[3])).sum::<u32>() as f32 / 4.0).round() as u8);
    }
    (out, size)
}

/// How often each alpha occurs.
struct Histogram {
    counts: [u64; 256],
    total: u64,
}

impl Histogram {
    fn of(rgba: &[u8], [w, h]: [u32; 2]) -> Histogram {
        let mut counts = [0; 256];
        if w as usize * h as usize >= INTERPOLATED_BELOW {
            rgba.iter().skip(3).step_by(4).for_each(|a| counts[usize::from(*a)] += 1);
        } else {
            let alpha =
                |x: u32, y: u32| f32::from(rgba[((y % h) as usize * w as usize + (x % w) as usize) * 4 + 3]);
            let cell = |i: u32| (i / PLACES, (i % PLACES) as f32 / PLACES as f32 + 0.5 / PLACES as f32);
            for (i, j) in (0..h * PLACES).flat_map(|j| (0..w * PLACES).map(move |i| (i, j))) {
                let ((x, u), (y, v)) = (cell(i), cell(j));
                let row = |y: u32| alpha(x, y) + (alpha(x + 1, y) - alpha(x, y)) * u;
                counts[(row(y) + (row(y + 1) - row(y)) * v).round() as usize] += 1;
            }
        }
        Histogram { total: counts.iter().sum(), counts }
    }

    /// Returns the share of values that are not below a threshold.
    fn share_from(&self, threshold: usize) -> f64 {
        self.counts[threshold..].iter().sum::<u64>() as f64 / self.total.max(1) as f64
    }

    /// Returns the factor, 1 or more, after which at least [`KEPT`] of a share of the values is not below the cut-off.
    fn scale_for(&self, share: f64, cutoff: f32) -> f32 {
        let unscaled = threshold(cutoff);
        let wanted = share * KEPT;
        let least = ((cutoff * 255.0 / MAX_SCALE) as usize).max(1);
        let error = |threshold: usize| (self.share_from(threshold) - share).abs();
        match (least..=unscaled).rev().find(|&t| self.share_from(t) >= wanted) {
            // Values that are all alike go from nothing to everything.
            Some(best) if error(best) < error(unscaled) => cutoff * 255.0 / best as f32,
            _ => 1.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use yoro_assets::Material;

    fn picture(size: u32, alpha: impl Fn(u32, u32) -> u8) -> Vec<u8> {
        (0..size * size).flat_map(|i| [200, 100, 50, alpha(i % size, i / size)]).collect()
    }

    /// Returns the share of each level that is drawn, and where a row is cut: the first column that is drawn, 0 to 1.
    fn drawn(rgba: Vec<u8>, size: u32, cutoff: f32) -> Vec<f64> {
        let levels = levels(rgba, [size; 2], true, cutoff);
        (1..)
            .zip(&levels)
            .map(|(level, rgba)| {
                let edge = (size >> level).max(1);
                assert_eq!(rgba.len(), (edge * edge * 4) as usize);
                assert_eq!(rgba[..3], [200, 100, 50]);
                Histogram::of(rgba, [edge; 2]).share_from(threshold(cutoff))
            })
            .collect()
    }

    #[test]
    fn as_much_is_left_at_every_level() {
        // Leaves that cover a quarter of the picture, of whose averages nothing is above the cut-off.
        let leaf = |x: u32, y: u32| {
            (x.wrapping_mul(0x9e37_79b9) ^ y.wrapping_mul(0x85eb_ca6b)).wrapping_mul(0xc2b2_ae35) >> 30
        };
        let leaves = picture(256, |x, y| if leaf(x, y) == 0 { 255 } else { 0 });
        // The next level has 64 texels, too few to tell.
        for (level, share) in drawn(leaves, 256, 0.5).into_iter().enumerate().take(4) {
            assert!((share - 0.25).abs() < 0.05, "level {level}: {share}");
        }
        // A ramp is cut where it is cut without minification.
        for cutoff in [0.25, 0.5, 0.75] {
            let ramp = picture(256, |x, _| x as u8);
            for (level, share) in drawn(ramp, 256, cutoff).into_iter().enumerate().take(5) {
                assert!((share - 1.0 + f64::from(cutoff)).abs() < 0.04, "{cutoff} level {level}: {share}");
            }
        }
    }

    #[test]
    fn pictures_are_split_by_cutoff() {
        let material = |map, alpha| Material { diffuse_map: Some(map), alpha, ..Material::default() };
        let image =
            TextureImage { name: "a".into(), size: [1, 1], rgba: vec![0; 4], srgb: true, nearest: false };
        let mut model = Model {
            textures: vec![image.clone(), image],
            materials: vec![
                material(0, Alpha::Cutout(0.5)),
                material(0, Alpha::Opaque),
                Material { emissive_map: Some(0), ..material(0, Alpha::Cutout(0.5)) },
                material(1, Alpha::Blend(0.5)),
                material(0, Alpha::Cutout(0.25)),
            ],
            ..Model::default()
        };
        assert_eq!(split(&mut model), [Some(0.5), None, None, Some(0.25)]);
        let maps: Vec<_> = model.materials.iter().map(|m| m.diffuse_map.unwrap()).collect();
        assert_eq!(
            (maps, model.materials[2].emissive_map, model.textures.len()),
            (vec![0, 2, 0, 1, 3], Some(2), 4)
        );
    }
}
