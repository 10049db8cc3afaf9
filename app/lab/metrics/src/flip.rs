//! FLIP: the difference that a viewer sees when two images alternate.

use image::RgbImage;
use rayon::prelude::*;

use super::input::{MetricsError, check_sizes};

/// Pixels per degree of visual angle under the usual viewing conditions: a display 0.7 m wide with 3840 pixels, seen
/// from 0.7 m. FLIP's published figures use it.
pub const FLIP_PIXELS_PER_DEGREE: f64 = 67.020_643_276_582_25;

/// Returns LDR-FLIP at each pixel, row by row from the top, from 0 (equal) to 1: how large the difference appears when
/// `test` and `reference` alternate. Both images are display-referred sRGB.
///
/// Source: Andersson, Nilsson, Akenine-Möller, Oskarsson, Åström, Fairchild: "FLIP: A Difference Evaluator for
/// Alternating Images", Proceedings of the ACM on Computer Graphics and Interactive Techniques 3(2), 2020. The values
/// agree with the authors' program to 1e-4.
///
/// # Errors
/// [`MetricsError::SizesDiffer`].
pub fn flip_map(
    test: &RgbImage,
    reference: &RgbImage,
    pixels_per_degree: f64,
) -> Result<Vec<f32>, MetricsError> {
    check_sizes(test, reference)?;
    let images = [test, reference].map(Opponent::new);
    let [test, reference] = &images;
    let [seen_test, seen_reference] = [test, reference].map(|image| image.as_seen(pixels_per_degree));
    let [features_test, features_reference] =
        [test, reference].map(|image| image.features(pixels_per_degree));
    let largest = largest_color_difference();
    let mut map = vec![0.0; test.luminance.values.len()];
    map.par_iter_mut().enumerate().for_each(|(i, value)| {
        let color = color_error(hyab(seen_test[i], seen_reference[i]), largest);
        let [edge, point] = [0, 1].map(|f| (features_test[f][i] - features_reference[f][i]).abs());
        // Section 4.2: the feature error, its exponent q_f = 0.5, and the final combination.
        let feature = (edge.max(point) * std::f32::consts::FRAC_1_SQRT_2).sqrt().min(1.0);
        *value = color.powf(1.0 - feature);
    });
    Ok(map)
}

/// Returns the mean of [`flip_map`] at [`FLIP_PIXELS_PER_DEGREE`].
///
/// # Errors
/// Those of [`flip_map`].
pub fn flip(test: &RgbImage, reference: &RgbImage) -> Result<f64, MetricsError> {
    let map = flip_map(test, reference, FLIP_PIXELS_PER_DEGREE)?;
    Ok(map.iter().map(|value| f64::from(*value)).sum::<f64>() / map.len() as f64)
}

/// Linear sRGB to XYZ.
const TO_XYZ: [[f32; 3]; 3] = [
    [0.412_386_57, 0.357_591_5, 0.180_450_48],
    [0.212_636_82, 0.715_182_96, 0.072_180_2],
    [0.019_330_62, 0.119_197_16, 0.950_372_6],
];
/// XYZ to linear sRGB, the inverse.
const FROM_XYZ: [[f32; 3]; 3] = [
    [3.241_003_2, -1.537_399, -0.498_615_9],
    [-0.969_224_3, 1.875_93, 0.041_554_23],
    [0.055_639_42, -0.204_011_21, 1.057_149],
];
/// The white point D65: XYZ of linear sRGB (1, 1, 1).
const WHITE: [f32; 3] = [0.950_428_55, 1.0, 1.088_900_4];

fn multiply(matrix: &[[f32; 3]; 3], v: [f32; 3]) -> [f32; 3] {
    matrix.map(|row| row[0] * v[0] + row[1] * v[1] + row[2] * v[2])
}

/// Decodes an 8-bit value of sRGB.
fn linear(value: u8) -> f32 {
    let v = f32::from(value) / 255.0;
    if v <= 0.04045 { v / 12.92 } else { ((v + 0.055) / 1.055).powf(2.4) }
}

/// Converts XYZ relative to white to CIELAB, with Hunt's adjustment: colours lose chroma in the dark.
fn hunt_lab(xyz: [f32; 3]) -> [f32; 3] {
    const DELTA: f32 = 6.0 / 29.0;
    let f = |v: f32| {
        if v > DELTA * DELTA * DELTA { v.cbrt() } else { v / (3.0 * DELTA * DELTA) + 4.0 / 29.0 }
    };
    let [x, y, z] = xyz.map(f);
    let lightness = 116.0 * y - 16.0;
    let chroma = 0.01 * lightness;
    [lightness, chroma * 500.0 * (x - y), chroma * 200.0 * (y - z)]
}

/// Returns the HyAB distance (Abasi et al. 2020): the sum of the distances in lightness and in chroma.
fn hyab(a: [f32; 3], b: [f32; 3]) -> f32 {
    (a[0] - b[0]).abs() + (a[1] - b[1]).hypot(a[2] - b[2])
}

/// Exponent of the colour difference, section 4.1.4.
const COLOR_EXPONENT: f32 = 0.7;

/// Returns the colour difference between the extremes of the gamut, green and blue, after the exponent.
fn largest_color_difference() -> f32 {
    let lab = |rgb| {
        let xyz = multiply(&TO_XYZ, rgb);
        hunt_lab(std::array::from_fn(|i| xyz[i] / WHITE[i]))
    };
    hyab(lab([0.0, 1.0, 0.0]), lab([0.0, 0.0, 1.0])).powf(COLOR_EXPONENT)
}

/// Compresses large colour differences: those up to 0.4 of the largest take up 0.95 of the scale.
fn color_error(difference: f32, largest: f32) -> f32 {
    let (knee, height) = (0.4 * largest, 0.95);
    let difference = difference.powf(COLOR_EXPONENT);
    if difference < knee {
        difference * height / knee
    } else {
        height + (difference - knee) / (largest - knee) * (1.0 - height)
    }
}

/// An image with one number per pixel.
struct Plane {
    width: usize,
    values: Vec<f32>,
}

impl Plane {
    /// Convolves with one kernel along x and one along y, both of odd length. The border is repeated.
    fn convolved(&self, along_x: &[f32], along_y: &[f32]) -> Vec<f32> {
        let (width, height) = (self.width, self.values.len() / self.width);
        let radius = along_x.len() / 2;
        let mut rows = vec![0.0; self.values.len()];
        rows.par_chunks_mut(width).zip(self.values.par_chunks(width)).for_each_init(
            || vec![0.0; width + 2 * radius],
            |padded, (out, row)| {
                padded[..radius].fill(row[0]);
                padded[radius..radius + width].copy_from_slice(row);
                padded[radius + width..].fill(row[width - 1]);
                for (k, weight) in along_x.iter().enumerate() {
                    add_weighted(out, &padded[k..k + width], *weight);
                }
            },
        );
        let radius = along_y.len() / 2;
        let mut result = vec![0.0; self.values.len()];
        result.par_chunks_mut(width).enumerate().for_each(|(y, out)| {
            for (k, weight) in along_y.iter().enumerate() {
                let row = (y + k).saturating_sub(radius).min(height - 1);
                add_weighted(out, &rows[row * width..(row + 1) * width], *weight);
            }
        });
        result
    }
}

fn add_weighted(sum: &mut [f32], values: &[f32], weight: f32) {
    for (sum, value) in sum.iter_mut().zip(values) {
        *sum += weight * value;
    }
}

/// An image in the opponent space YCxCz, a linear form of CIELAB: luminance, red-green, blue-yellow.
struct Opponent {
    luminance: Plane,
    red_green: Plane,
    blue_yellow: Plane,
}

impl Opponent {
    fn new(image: &RgbImage) -> Opponent {
        let decoded: [f32; 256] = std::array::from_fn(|v| linear(v as u8));
        let count = image.width() as usize * image.height() as usize;
        let plane = || Plane { width: image.width() as usize, values: Vec::with_capacity(count) };
        let mut opponent = Opponent { luminance: plane(), red_green: plane(), blue_yellow: plane() };
        for rgb in image.pixels() {
            let xyz = multiply(&TO_XYZ, rgb.0.map(|v| decoded[usize::from(v)]));
            let [x, y, z]: [f32; 3] = std::array::from_fn(|i| xyz[i] / WHITE[i]);
            opponent.luminance.values.push(116.0 * y - 16.0);
            opponent.red_green.values.push(500.0 * (x - y));
            opponent.blue_yellow.values.push(200.0 * (y - z));
        }
        opponent
    }

    /// Returns the colours as they appear at the viewing distance: filtered by the eye's contrast sensitivity (section
    /// 4.1.1) and clamped to the gamut, in CIELAB with Hunt's adjustment.
    fn as_seen(&self, pixels_per_degree: f64) -> Vec<[f32; 3]> {
        // The widest gaussian determines the reach of the kernels: three standard deviations.
        let reach = 3.0 * (0.04 / (2.0 * std::f64::consts::PI.powi(2))).sqrt() * pixels_per_degree;
        let filter = |plane: &Plane, gaussians: &[(f64, f64)]| {
            let kernels: Vec<(f64, Vec<f64>)> = gaussians
                .iter()
                .map(|&(amplitude, spread)| sensitivity(amplitude, spread, reach, pixels_per_degree))
                .collect();
            // The sum of the two-dimensional kernel is the sum of the squares of the one-dimensional sums.
            let sum: f64 = kernels.iter().map(|(a, k)| a * k.iter().sum::<f64>().powi(2)).sum();
            let mut filtered = vec![0.0; plane.values.len()];
            for (amplitude, kernel) in &kernels {
                let along_y: Vec<f32> = kernel.iter().map(|k| *k as f32).collect();
                let along_x: Vec<f32> = kernel.iter().map(|k| (k * amplitude / sum) as f32).collect();
                add_weighted(&mut filtered, &plane.convolved(&along_x, &along_y), 1.0);
            }
            filtered
        };
        let luminance = filter(&self.luminance, &[(1.0, 0.0047)]);
        let red_green = filter(&self.red_green, &[(1.0, 0.0053)]);
        let blue_yellow = filter(&self.blue_yellow, &[(34.1, 0.04), (13.5, 0.025)]);
        let mut seen = vec![[0.0; 3]; luminance.len()];
        seen.par_iter_mut().enumerate().for_each(|(i, lab)| {
            let y = (luminance[i] + 16.0) / 116.0;
            let (x, z) = (y + red_green[i] / 500.0, y - blue_yellow[i] / 200.0);
            let rgb = multiply(&FROM_XYZ, [x * WHITE[0], y * WHITE[1], z * WHITE[2]]);
            let xyz = multiply(&TO_XYZ, rgb.map(|v| v.clamp(0.0, 1.0)));
            *lab = hunt_lab(std::array::from_fn(|i| xyz[i] / WHITE[i]));
        });
        seen
    }

    /// Returns how edge-like and how point-like each pixel is (section 4.2): the magnitudes of the first and second
    /// derivatives of luminance.
    fn features(&self, pixels_per_degree: f64) -> [Vec<f32>; 2] {
        /// Width of the features in degrees.
        const WIDTH: f64 = 0.082;
        let deviation = 0.5 * WIDTH * pixels_per_degree;
        let radius = (3.0 * deviation).ceil() as i32;
        let gaussian = |x: i32| (-f64::from(x * x) / (2.0 * deviation * deviation)).exp();
        let first = |x: i32| -f64::from(x) * gaussian(x);
        let second = |x: i32| (f64::from(x * x) / (deviation * deviation) - 1.0) * gaussian(x);
        let kernel = |f: &dyn Fn(i32) -> f64| balanced((-radius..=radius).map(f).collect());
        let [smooth, first, second] = [kernel(&gaussian), kernel(&first), kernel(&second)];
        let y = Plane {
            width: self.luminance.width,
            values: self.luminance.values.iter().map(|y| (y + 16.0) / 116.0).collect(),
        };
        [first, second].map(|derivative| {
            let along_x = y.convolved(&derivative, &smooth);
            let along_y = y.convolved(&smooth, &derivative);
            along_x.iter().zip(&along_y).map(|(x, y)| x.hypot(*y)).collect()
        })
    }
}

/// Returns a term of a contrast sensitivity function as a spatial gaussian: `amplitude sqrt(pi / spread) exp(-pi^2 d^2
/// / spread)` with d in degrees, split into its factor and the one-dimensional kernel.
fn sensitivity(amplitude: f64, spread: f64, reach: f64, pixels_per_degree: f64) -> (f64, Vec<f64>) {
    use std::f64::consts::PI;
    let radius = reach.ceil() as i32;
    let at = |x: i32| (-(PI * f64::from(x) / pixels_per_degree).powi(2) / spread).exp();
    (amplitude * (PI / spread).sqrt(), (-radius..=radius).map(at).collect())
}

/// Scales a kernel so that its positive weights sum to 1 and its negative ones, if any, to -1.
fn balanced(mut kernel: Vec<f64>) -> Vec<f32> {
    let positive: f64 = kernel.iter().filter(|w| **w > 0.0).sum();
    let negative: f64 = -kernel.iter().filter(|w| **w < 0.0).sum::<f64>();
    kernel.iter_mut().for_each(|w| *w /= if *w > 0.0 { positive } else { negative.max(f64::MIN_POSITIVE) });
    kernel.into_iter().map(|w| w as f32).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tests::{image, pair};

    /// The size of the test images, pixels per degree, and the results of flip-evaluator 1.7: the mean, and the map at
    /// (0, h - 1), (5, 5) and (w - 1, h / 2).
    type Reference = ((u32, u32), f64, f64, [f32; 3]);

    const FLIP_EVALUATOR_1_7: [Reference; 6] = [
        ((11, 11), FLIP_PIXELS_PER_DEGREE, 0.187_880_02, [0.406_710_48, 0.136_711_3, 0.207_070_13]),
        ((11, 11), 20.0, 0.285_912_45, [0.551_415_86, 0.334_070_4, 0.524_401_4]),
        ((37, 29), FLIP_PIXELS_PER_DEGREE, 0.126_558_68, [0.092_362_82, 0.014_455_585, 0.258_211_85]),
        ((37, 29), 20.0, 0.268_131_94, [0.133_491_02, 0.0, 0.267_160_15]),
        ((64, 48), FLIP_PIXELS_PER_DEGREE, 0.114_453_92, [0.108_250_89, 0.0, 0.127_054_45]),
        ((64, 48), 20.0, 0.259_133_49, [0.216_972_99, 0.0, 0.369_280_5]),
    ];

    #[test]
    fn agrees_with_the_authors_program() {
        for ((w, h), ppd, mean, points) in FLIP_EVALUATOR_1_7 {
            let (reference, test) = {
                let (a, b) = pair(w, h);
                (b, a)
            };
            let map = flip_map(&test, &reference, ppd).unwrap();
            let ours = map.iter().map(|v| f64::from(*v)).sum::<f64>() / map.len() as f64;
            assert!((ours - mean).abs() < 1e-4, "{w}x{h}, {ppd}: {ours} is not {mean}");
            for ((x, y), expected) in [(0, h - 1), (5, 5), (w - 1, h / 2)].into_iter().zip(points) {
                let ours = map[(y * w + x) as usize];
                assert!(
                    (ours - expected).abs() < 1e-4,
                    "{w}x{h}, {ppd} at {x}, {y}: {ours} is not {expected}"
                );
            }
        }
    }

    #[test]
    fn equal_images_have_error_0_and_black_against_white_1() {
        let a = image(40, 30, 3);
        assert_eq!(flip(&a, &a).unwrap(), 0.0);
        let white = RgbImage::from_pixel(40, 30, image::Rgb([255; 3]));
        let error = flip(&RgbImage::new(40, 30), &white).unwrap();
        assert!((0.9..=1.0).contains(&error), "{error}");
        assert!(flip(&a, &image(40, 31, 3)).is_err());
    }
}
