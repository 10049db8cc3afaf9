//! Flicker: unwanted change from frame to frame.

use image::RgbImage;

use super::input::{MetricsError, check_mask, check_sizes};

/// The step of luma (out of 255) between neighbouring pixels of the ground truth that counts as an edge.
const EDGE: f32 = 24.0;

/// Unwanted change of one eye's image from one frame to the next: the root mean square, over pixels and red, green and
/// blue, of `(S1 - S0) - (T1 - T0)`, where S are the images of a method and T those of the ground truth at the same two
/// moments, in units of 1/255 of the full range.
///
/// An error that stays in place on the screen is not flicker; an error that appears, disappears or moves is. The
/// measure is dtSSD of Erofeev et al., "Perceptually Motivated Benchmark for Video Matting", BMVC 2015, applied to
/// colours. For scale, the ground truth's own change `T1 - T0` is measured in the same way ([`FlickerMeter::change`]):
/// an image that did not change while the world moves would flicker by that much.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Flicker {
    /// Over all pixels.
    pub all: f64,
    /// Over the pixels that are holes in either frame; `None` if there are none.
    pub holes: Option<f64>,
    /// Over the pixels outside of holes that are edges of the ground truth in either frame; `None` if there are none.
    pub edges: Option<f64>,
    /// Over all other pixels; `None` if there are none.
    pub rest: Option<f64>,
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Region {
    Rest,
    Edge,
    Hole,
}

/// Measures flicker between two frames against their ground truth.
pub struct FlickerMeter {
    size: (u32, u32),
    regions: Vec<Region>,
    /// The change of each sample in the ground truth.
    change: Vec<i16>,
}

impl FlickerMeter {
    /// Creates a meter from the ground truth of two consecutive frames and their holes (row by row from the top).
    ///
    /// # Errors
    /// [`MetricsError::SizesDiffer`] and [`MetricsError::MaskSize`].
    pub fn new(truth: [&RgbImage; 2], holes: [&[bool]; 2]) -> Result<FlickerMeter, MetricsError> {
        let [before, after] = truth;
        check_sizes(before, after)?;
        holes.iter().try_for_each(|holes| check_mask(before, holes))?;
        let edges = truth.map(edges);
        let region = |i: usize| {
            if holes.iter().any(|h| h[i]) {
                Region::Hole
            } else if edges.iter().any(|e| e[i]) {
                Region::Edge
            } else {
                Region::Rest
            }
        };
        let regions = (0..holes[0].len()).map(region).collect();
        Ok(FlickerMeter { size: before.dimensions(), regions, change: difference(before, after).collect() })
    }

    /// Returns the RMS change of the ground truth between the two frames, in the same unit as flicker.
    pub fn change(&self) -> Flicker {
        self.over_regions(self.change.iter().copied())
    }

    /// Returns the flicker of a method's images of the same two frames.
    ///
    /// # Errors
    /// [`MetricsError::SizesDiffer`].
    pub fn flicker(&self, eye: [&RgbImage; 2]) -> Result<Flicker, MetricsError> {
        let [before, after] = eye;
        check_sizes(before, after)?;
        if before.dimensions() != self.size {
            return Err(MetricsError::SizesDiffer { a: before.dimensions(), b: self.size });
        }
        Ok(self.over_regions(difference(before, after).zip(&self.change).map(|(eye, truth)| eye - truth)))
    }

    fn over_regions(&self, samples: impl Iterator<Item = i16>) -> Flicker {
        let (mut squares, mut counts) = ([0.0; 3], [0usize; 3]);
        for (i, sample) in samples.enumerate() {
            let region = self.regions[i / 3] as usize;
            squares[region] += f64::from(sample).powi(2);
            counts[region] += 1;
        }
        let root = |square: f64, count: usize| (square / count as f64).sqrt();
        let of = |region: Region| {
            let region = region as usize;
            (counts[region] > 0).then(|| root(squares[region], counts[region]))
        };
        Flicker {
            all: root(squares.iter().sum(), counts.iter().sum()),
            holes: of(Region::Hole),
            edges: of(Region::Edge),
            rest: of(Region::Rest),
        }
    }
}

/// Returns `after - before` of each sample.
fn difference<'a>(before: &'a RgbImage, after: &'a RgbImage) -> impl Iterator<Item = i16> + 'a {
    before.as_raw().iter().zip(after.as_raw()).map(|(before, after)| i16::from(*after) - i16::from(*before))
}

/// Returns a mask of the pixels that differ from a neighbour by [`EDGE`] or more; both sides of the step are marked.
fn edges(image: &RgbImage) -> Vec<bool> {
    let width = image.width() as usize;
    let luma: Vec<f32> = image
        .pixels()
        .map(|p| 0.299 * f32::from(p[0]) + 0.587 * f32::from(p[1]) + 0.114 * f32::from(p[2]))
        .collect();
    let mut edges = vec![false; luma.len()];
    for i in 0..luma.len() {
        let right = ((i + 1) % width != 0).then_some(i + 1);
        let below = (i + width < luma.len()).then_some(i + width);
        for neighbour in [right, below].into_iter().flatten() {
            if (luma[i] - luma[neighbour]).abs() >= EDGE {
                (edges[i], edges[neighbour]) = (true, true);
            }
        }
    }
    edges
}

#[cfg(test)]
mod tests {
    use super::*;
    use image::Rgb;

    /// A grey image with a bright column at `x`.
    fn column(x: u32) -> RgbImage {
        RgbImage::from_fn(8, 4, |px, _| Rgb([if px == x { 200 } else { 100 }; 3]))
    }

    #[test]
    fn a_perfect_eye_and_a_standing_error_do_not_flicker() {
        let (before, after) = (column(2), column(3));
        let none = [false; 32];
        let meter = FlickerMeter::new([&before, &after], [&none, &none]).unwrap();
        assert_eq!(meter.flicker([&before, &after]).unwrap().all, 0.0);
        let brighter =
            |image: &RgbImage| RgbImage::from_fn(8, 4, |x, y| Rgb(image.get_pixel(x, y).0.map(|v| v + 9)));
        assert_eq!(meter.flicker([&brighter(&before), &brighter(&after)]).unwrap().all, 0.0);
    }

    #[test]
    fn an_eye_that_stands_still_flickers_as_the_truth_changes() {
        let (before, after) = (column(2), column(3));
        let mut holes = [false; 32];
        holes[2] = true;
        let meter = FlickerMeter::new([&before, &after], [&holes, &[false; 32]]).unwrap();
        let still = meter.flicker([&before, &before]).unwrap();
        assert_eq!(still, meter.change());
        // Two of eight columns change by 100. Edges are columns 1 to 4, except one pixel that is a hole.
        assert!((still.all - (0.25f64 * 1e4).sqrt()).abs() < 1e-9);
        assert_eq!(still.holes, Some(100.0));
        assert!((still.edges.unwrap() - (7.0 / 15.0 * 1e4f64).sqrt()).abs() < 1e-9);
        assert_eq!(still.rest, Some(0.0));
    }

    #[test]
    fn an_error_that_comes_and_goes_is_counted_where_it_is() {
        let image = column(20);
        let mut spot = image.clone();
        spot.put_pixel(5, 1, Rgb([130, 100, 100]));
        let mut holes = [false; 32];
        holes[8 + 5] = true;
        let meter = FlickerMeter::new([&image, &image], [&[false; 32], &holes]).unwrap();
        let flicker = meter.flicker([&image, &spot]).unwrap();
        assert_eq!(flicker.holes, Some((900.0f64 / 3.0).sqrt()));
        assert_eq!((flicker.edges, flicker.rest), (None, Some(0.0)));
        assert_eq!(meter.change().all, 0.0);
    }

    #[test]
    fn sizes_are_checked() {
        let (a, b) = (column(1), RgbImage::new(4, 4));
        assert!(FlickerMeter::new([&a, &b], [&[false; 32]; 2]).is_err());
        assert!(FlickerMeter::new([&a, &a], [&[false; 31]; 2]).is_err());
        let meter = FlickerMeter::new([&a, &a], [&[false; 32]; 2]).unwrap();
        assert!(meter.flicker([&b, &b]).is_err());
    }
}
