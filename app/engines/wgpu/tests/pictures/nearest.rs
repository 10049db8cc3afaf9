//! The nearest depth of several samples.

use rand::{Rng, SeedableRng};

use yoro::eyes::DepthConvention;
use yoro_wgpu::NearestDepth;
use yoro_wgpu::wgpu::TextureFormat;

use crate::against_opengl::flipped;
use crate::harness::{depth_of, with_gpus};

#[test]
fn the_nearest_depth_is_that_of_the_nearest_sample() {
    const SIZE: [u32; 2] = [37, 21];
    let mut rng = rand_pcg::Pcg32::seed_from_u64(5);
    let pixels = (SIZE[0] * SIZE[1]) as usize;
    // The pictures of the four samples are stacked from the top.
    let stacked: Vec<f32> = (0..4 * pixels).map(|_| rng.random_range(0.0..=1.0)).collect();
    with_gpus(|gpu| {
        if gpu.is_opengl() {
            return;
        }
        let all = gpu.texture(TextureFormat::R32Float, [SIZE[0], 4 * SIZE[1]], 1);
        gpu.upload_depth(&all, 0, &flipped(&stacked, 4 * SIZE[1]));
        let samples = gpu.multisampled(TextureFormat::Depth32Float, SIZE);
        gpu.draw(&depth_of(&all, 0), &samples, 0);
        for convention in [DepthConvention::Standard, DepthConvention::Reversed] {
            let mut pass = NearestDepth::new(&gpu.device, convention).unwrap();
            let view = depth_of(&samples, 0);
            let nearest = gpu.run(|encoder| pass.record(&gpu.device, encoder, &view).clone());
            let into = gpu.texture(TextureFormat::R32Uint, SIZE, 1);
            gpu.draw(&nearest, &into, 0);
            let got = flipped(&gpu.read_bits(&into), SIZE[1]);
            for (i, got) in got.into_iter().enumerate() {
                let of_pixel = (0..4).map(|sample| stacked[sample * pixels + i]);
                let want = match convention {
                    DepthConvention::Standard => of_pixel.fold(f32::MAX, f32::min),
                    DepthConvention::Reversed => of_pixel.fold(f32::MIN, f32::max),
                };
                assert_eq!(got, want, "{}, {convention:?}, pixel {i}", gpu.name);
            }
        }
    });
}
