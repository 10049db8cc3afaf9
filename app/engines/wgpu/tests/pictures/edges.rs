//! Anti-aliased sources give the same pictures on wgpu as on OpenGL.

use yoro::eyes::{DepthConvention, Eye, GuardBand, Warp};
use yoro::synthesis::Edges;
use yoro_context::{Backend, Headless};
use yoro_wgpu::wgpu::{TextureAspect, TextureFormat};
use yoro_wgpu::{Gather, Options, Source, Target, WgpuError};

use super::against_opengl::{Picture, expected_depth};
use super::harness::{Gpu, depth_of, one_layer, with_gpus};
use yoro_test_support::samples::{GIVEN, Samples, example, on_opengl};

/// A source, and what OpenGL draws from it: colour and the source map.
struct Wanted {
    given: (Edges, bool),
    warp: Warp,
    samples: Samples,
    rgba: Vec<u8>,
    source_map: Vec<u32>,
}

fn wanted() -> Vec<Wanted> {
    let headless = Headless::open(Backend::Egl).expect("EGL is set up by `cargo xtask setup`");
    let mut all = Vec::new();
    for (i, given) in GIVEN.into_iter().enumerate() {
        // The cases cover both eyes and both depth conventions.
        let dominant = Eye::BOTH[i % 2];
        let convention = [DepthConvention::Standard, DepthConvention::Reversed][(i + i / 2) % 2];
        let (warp, samples) = example(dominant, convention, GuardBand::Pixels(21));
        let (rgba, source_map) = on_opengl(headless.gl(), &samples, given, &warp);
        all.push(Wanted { given, warp, samples, rgba, source_map });
    }
    all
}

/// Synthesizes colour and depth.
fn on_wgpu(gpu: &Gpu, wanted: &Wanted) -> (Vec<u8>, Vec<f32>) {
    let Wanted { given: (edges, colors), warp, samples, .. } = wanted;
    let size = samples.size;
    let format = TextureFormat::Rgba8Unorm;
    let resolved = gpu.texture(format, size, 1);
    gpu.upload_rgba8(&resolved, 0, &samples.resolved());
    let color_samples = gpu.multisampled(format, size);
    let stacked = [size[0], 4 * size[1]];
    // Rows run from the bottom, so the last row comes first in the texture.
    let (mut rgba, mut depths) = (samples.rgba.clone(), samples.depth.clone());
    let depth = match edges {
        Edges::Multisample => {
            let depth_samples = gpu.multisampled(TextureFormat::Depth32Float, size);
            let colors = gpu.texture(format, stacked, 1);
            rgba.reverse();
            gpu.upload_rgba8(&colors, 0, &rgba.concat());
            gpu.draw(&depth_of(&colors, 0), &color_samples, 0);
            let floats = gpu.texture(TextureFormat::R32Float, stacked, 1);
            depths.reverse();
            gpu.upload_depth(&floats, 0, &depths.concat());
            gpu.draw(&depth_of(&floats, 0), &depth_samples, 0);
            depth_samples
        }
        _ => {
            let single = gpu.texture(TextureFormat::R32Float, size, 1);
            gpu.upload_depth(&single, 0, &samples.one_depth(*edges, warp.convention));
            single
        }
    };
    let target = gpu.texture(format, warp.target_size, 1);
    let target_depth = gpu.texture(TextureFormat::Depth32Float, warp.target_size, 1);
    let options = Options {
        color_format: format,
        depth_format: Some(TextureFormat::Depth32Float),
        edges: *edges,
        ..Options::default()
    };
    let mut gather = Gather::new(&gpu.device, &options).unwrap();
    let whole = |texture| one_layer(texture, 0, TextureAspect::All);
    let (color, depth, sample_color) = (whole(&resolved), depth_of(&depth, 0), whole(&color_samples));
    let (color_view, depth_view) = (whole(&target), whole(&target_depth));
    let source = Source { sample_color: colors.then_some(&sample_color), ..Source::new(&color, &depth) };
    let target_of = Target { depth: Some(&depth_view), ..Target::new(&color_view) };
    gpu.run(|encoder| gather.record(&gpu.device, &gpu.queue, encoder, &source, warp, &target_of)).unwrap();
    (gpu.read_rgba8(&target, 0), gpu.read_depth(&target_depth, 0))
}

#[test]
fn anti_aliased_sources_give_opengls_pictures() {
    let wanted = wanted();
    with_gpus(|gpu| {
        for wanted in &wanted {
            let Wanted { given, warp, rgba: want, .. } = wanted;
            if given.0 == Edges::Multisample && gpu.is_opengl() {
                let options = Options { edges: Edges::Multisample, ..Options::default() };
                let refused = Gather::new(&gpu.device, &options).err();
                assert!(matches!(refused, Some(WgpuError::OpenGl { .. })), "{refused:?}");
                continue;
            }
            let (got, depth) = on_wgpu(gpu, wanted);
            let what = format!("{}, {given:?}, {warp:?}", gpu.name);
            let pixels = got.chunks_exact(4).zip(want.chunks_exact(4));
            let differs = |(a, b): &(&[u8], &[u8])| a.iter().zip(*b).any(|(a, b)| a.abs_diff(*b) > 1);
            let different = pixels.filter(differs).count();
            assert!(
                different * 1000 <= got.len() / 4,
                "{what}: {different} of {} pixels differ",
                got.len() / 4
            );

            // The depth is that of the source map's column, except for pixels at silhouettes. It is not that of the
            // next column or row.
            let depths = wanted.samples.one_depth(given.0, warp.convention);
            let picture = Picture { warp: *warp, rgba: Vec::new(), depth: depths };
            let expected = expected_depth(&picture, &wanted.source_map);
            let shares = [0, 1, warp.target_size[0] as usize].map(|away| {
                let pairs = depth.iter().zip(expected.iter().cycle().skip(away));
                pairs.filter(|(a, b)| (*a - *b).abs() > 1e-3).count() as f64 / depth.len() as f64
            });
            assert!(shares[0] < 0.05 && shares[1] > 0.05 && shares[2] > 0.05, "{what}: depth {shares:?}");
        }
    });
}
