//! The guessed nearest depth against its f64 reference, and against what it stands for.

use std::rc::Rc;

use super::laws::{on_every_backend, pair, scene};
use super::parts::{ORIGIN, Picture, Textures};
use super::state::read_depth;
use yoro::eyes::{DepthConvention, Eye, GuardBand, Warp};
use yoro::opengl::{Context, GuessedDepth, Options};

/// Two steps of the 24 bits in which the guess is stored: one of rounding, one of floats near 1.
const STEPS: f64 = 2.0 / ((1 << 24) - 1) as f64;

/// Returns pixels of movement for each unit of depth, so that nearer surfaces have larger products.
fn slope(warp: &Warp) -> f64 {
    let sign = if warp.convention == DepthConvention::Reversed { 1.0 } else { -1.0 };
    sign * f64::from(warp.law.scale as f32).abs()
}

/// The guess in f64. Rows run from the bottom.
fn reference(rgba: &[u8], depth: &[f32], [width, height]: [u32; 2], slope: f64) -> Vec<f32> {
    let at = |x: i32, y: i32| {
        (y.clamp(0, height as i32 - 1) * width as i32 + x.clamp(0, width as i32 - 1)) as usize
    };
    let moves = |i: usize| slope * f64::from(depth[i]);
    let color = |i: usize| [0, 1, 2].map(|c| f64::from(rgba[4 * i + c]) / 255.0);
    let guess = |i: i32| {
        let (x, y) = (i % width as i32, i / width as i32);
        let beside = |[dx, dy]: [i32; 2], steps: i32| at(x + steps * dx, y + steps * dy);
        let own = at(x, y);
        let is_nearer = |i: usize| moves(i) > moves(own) + 0.5;
        let mut nearer: Option<[i32; 2]> = None;
        for to in [[-1, 0], [1, 0], [0, -1], [0, 1]] {
            let beyond = nearer.is_none_or(|best| moves(beside(to, 1)) > moves(beside(best, 1)));
            nearer = if is_nearer(beside(to, 1)) && beyond { Some(to) } else { nearer };
        }
        let Some(to) = nearer else { return depth[own] };
        let front = color(beside(to, if is_nearer(beside(to, 2)) { 2 } else { 1 }));
        let back = color(if is_nearer(beside(to, -1)) { own } else { beside(to, -1) });
        let here = color(own);
        let contrast = [0, 1, 2].map(|c| front[c] - back[c]);
        let of = |v: [f64; 3]| (0..3).map(|c| v[c] * contrast[c]).sum::<f64>();
        let share = of([0, 1, 2].map(|c| here[c] - back[c])) / of(contrast).max(1e-4);
        if share > 0.15 { depth[beside(to, 1)] } else { depth[own] }
    };
    (0..depth.len() as i32).map(guess).collect()
}

/// Runs the pass, and returns the depth of the source's pixels.
fn guess(gl: &Rc<Context>, picture: &Picture, parts: bool) -> Vec<f32> {
    let options = Options { parts, ..Options::default() };
    let (_textures, source) = Textures::new(gl, picture, parts, false);
    let mut pass = GuessedDepth::new(gl, &options).unwrap();
    let guessed = pass.guess(source, &picture.warp).unwrap();
    let [width, height] = picture.warp.source_size;
    let [left, low] = if parts { ORIGIN } else { [0, 0] };
    let image = [left + width, low + height];
    let bits = read_depth(gl, guessed.depth, image);
    let pixels =
        (0..height).flat_map(|y| (0..width).map(move |x| ((low + y) * image[0] + left + x) as usize));
    pixels.map(|i| f32::from_bits(bits[i])).collect()
}

fn picture(size: [u32; 2], dominant: Eye, convention: DepthConvention, seed: u64) -> Picture {
    let eyes = pair(size, dominant, 0.063, convention);
    let warp = eyes.synthesis_views(GuardBand::Pixels(9)).unwrap().warp;
    let (rgba, depth) = scene(warp.source_size, eyes.depth, seed);
    Picture { warp, rgba, depth: depth.iter().flat_map(|z| z.to_ne_bytes()).collect() }
}

fn floats(bytes: &[u8]) -> Vec<f32> {
    bytes.chunks_exact(4).map(|bytes| f32::from_ne_bytes(bytes.try_into().unwrap())).collect()
}

#[test]
fn the_guessed_depth_is_its_reference() {
    on_every_backend(|gl| {
        for (seed, dominant, convention) in
            [(1, Eye::Right, DepthConvention::Standard), (2, Eye::Left, DepthConvention::Reversed)]
        {
            let picture = picture([150, 40], dominant, convention, seed);
            let depth = floats(&picture.depth);
            let want = reference(&picture.rgba, &depth, picture.warp.source_size, slope(&picture.warp));
            let changed = want.iter().zip(&depth).filter(|(a, b)| a != b).count();
            assert!(changed * 30 > want.len(), "only {changed} pixels of {} tell anything", want.len());
            for parts in [false, true] {
                let got = guess(gl, &picture, parts);
                let far = |(a, b): &(&f32, &f32)| (f64::from(**a) - f64::from(**b)).abs() > STEPS;
                let different = got.iter().zip(&want).filter(far).count();
                // Colours within rounding of a decision may differ.
                assert!(
                    different * 1000 <= got.len(),
                    "{seed}, parts {parts}: {different} of {} differ",
                    got.len()
                );
            }
        }
    });
}

/// A disc in front of a wall, anti-aliased: what is guessed from the first sample's depth is the nearest sample's.
#[test]
fn the_guessed_depth_is_that_of_the_nearest_sample() {
    const SAMPLES: [[f32; 2]; 4] = [[0.375, 0.125], [0.875, 0.375], [0.125, 0.625], [0.625, 0.875]];
    on_every_backend(|gl| {
        let mut picture = picture([120, 90], Eye::Right, DepthConvention::Standard, 3);
        let [width, height] = picture.warp.source_size;
        let range = pair([120, 90], Eye::Right, 0.063, DepthConvention::Standard).depth;
        let [near, far] = [0.8, 5.0].map(|metres| range.depth(metres));
        let covers =
            |x: u32, y: u32, [dx, dy]: [f32; 2]| (x as f32 + dx - 57.3).hypot(y as f32 + dy - 44.6) < 31.7;
        let pixels = || (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
        let covered: Vec<usize> =
            pixels().map(|(x, y)| SAMPLES.iter().filter(|sample| covers(x, y, **sample)).count()).collect();
        let first: Vec<f32> =
            pixels().map(|(x, y)| if covers(x, y, SAMPLES[0]) { near } else { far }).collect();
        let nearest: Vec<f32> = covered.iter().map(|&n| if n > 0 { near } else { far }).collect();
        let mix = |n: usize, front: usize, back: usize| ((n * front + (4 - n) * back) / 4) as u8;
        // The wall's colour changes from row to row, as shading does.
        picture.rgba = pixels()
            .zip(&covered)
            .flat_map(|((_, y), &n)| {
                [mix(n, 200, 40), mix(n, 60, 90 + (y as usize % 7)), mix(n, 30, 160), 255]
            })
            .collect();
        picture.depth = first.iter().flat_map(|depth| depth.to_ne_bytes()).collect();
        let wrong =
            |depth: &[f32]| depth.iter().zip(&nearest).filter(|(a, b)| (*a - *b).abs() > 1e-6).count();
        let guessed = guess(gl, &picture, false);
        let [before, after] = [wrong(&first), wrong(&guessed)];
        println!("{before} pixels are wrong in the first sample's depth, {after} in what is guessed");
        assert!(before > 60 && after * 10 <= before, "{before}, {after}");

        // Without anti-aliasing, nothing changes.
        picture.rgba = first
            .iter()
            .flat_map(|&z| if z == near { [200, 60, 30, 255] } else { [40, 90, 160, 255] })
            .collect();
        let kept = guess(gl, &picture, false);
        assert!(kept.iter().zip(&first).all(|(a, b)| (a - b).abs() < 1e-6));
    });
}
