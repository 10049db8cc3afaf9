//! Waves: the pixels that a GPU shades in step.

/// Returns the columns and rows of pixels in a wave with this many lanes.
pub fn wave_size(lanes: u32) -> [u32; 2] {
    match lanes {
        128 => [16, 8],
        64 => [8, 8],
        16 => [4, 4],
        _ => [4, 2],
    }
}

/// Combines the pixels of each wave of an image of `width` columns, whose rows are complete. `include` adds a pixel to
/// its wave.
pub fn combine<P, W: Clone + Default>(
    pixels: impl ExactSizeIterator<Item = P>,
    width: u32,
    wave: [u32; 2],
    include: impl Fn(&mut W, P),
) -> Vec<W> {
    let across = width.div_ceil(wave[0]) as usize;
    let height = (pixels.len() as u32).div_ceil(width.max(1));
    let mut waves = vec![W::default(); across * height.div_ceil(wave[1]) as usize];
    for (i, pixel) in pixels.enumerate() {
        let (x, y) = (i as u32 % width, i as u32 / width);
        include(&mut waves[(y / wave[1]) as usize * across + (x / wave[0]) as usize], pixel);
    }
    waves
}
