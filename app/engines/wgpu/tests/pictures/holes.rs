//! Open holes: what is marked, by depth or by stencil, and that all other pixels are as if holes were filled.

use yoro::eyes::Warp;
use yoro::synthesis::{HoleMark, Holes};
use yoro_wgpu::wgpu::{TextureAspect, TextureFormat};
use yoro_wgpu::{AnyView, Gather, Options, Source, Target, WgpuError};

use crate::against_opengl::{Picture, picture, warps};
use crate::harness::{Gpu, depth_of, one_layer, with_gpus};

/// Colours and depths of the other eye.
fn draw(
    gpu: &Gpu,
    warp: &Warp,
    picture: &Picture,
    format: TextureFormat,
    holes: Holes,
) -> (Vec<u8>, Vec<f32>) {
    let color = gpu.texture(TextureFormat::Rgba8Unorm, warp.source_size, 1);
    let depth = gpu.texture(TextureFormat::R32Float, warp.source_size, 1);
    gpu.upload_rgba8(&color, 0, &picture.rgba);
    gpu.upload_depth(&depth, 0, &picture.depth);
    let target = gpu.texture(TextureFormat::Rgba8Unorm, warp.target_size, 1);
    let target_depth = gpu.texture(format, warp.target_size, 1);
    let options = Options { depth_format: Some(format), holes, ..Options::default() };
    let mut gather = Gather::new(&gpu.device, &options).unwrap();
    let views = [&color, &target, &target_depth].map(|texture| one_layer(texture, 0, TextureAspect::All));
    let depth = depth_of(&depth, 0);
    let [color, to, to_depth] = &views;
    let to = Target { depth: Some(to_depth), ..Target::new(to) };
    gpu.run(|encoder| {
        gather.record(&gpu.device, &gpu.queue, encoder, &Source::new(color, &depth), warp, &to).unwrap();
    });
    (gpu.read_rgba8(&target, 0), gpu.read_depth(&target_depth, 0))
}

#[test]
fn open_pixels_are_told_from_others() {
    let cases: Vec<_> = warps().into_iter().enumerate().collect();
    with_gpus(|gpu| {
        let mut sum = 0;
        for (i, (warp, range)) in &cases {
            let picture = picture(warp, *range, *i as u64);
            let float = TextureFormat::Depth32Float;
            let (rgba, depth) = draw(gpu, warp, &picture, float, Holes::Filled);
            let (open_rgba, marks) = draw(gpu, warp, &picture, float, Holes::Open(HoleMark::Depth));
            let [nearest, farthest] = warp.convention.planes();
            let is_open = |mark: f32| {
                assert!(mark == nearest || mark == farthest, "{}: {mark}", gpu.name);
                mark == farthest
            };
            let all = marks.len();
            let open: Vec<bool> = marks.into_iter().map(is_open).collect();
            let count = open.iter().filter(|open| **open).count();
            sum += count;
            let same = |at: usize| rgba[4 * at..4 * at + 4] == open_rgba[4 * at..4 * at + 4];
            assert!((0..all).all(|at| open[at] || same(at)), "{}, case {i}", gpu.name);
            let stencil = TextureFormat::Depth32FloatStencil8;
            if gpu.has(stencil) {
                let (_, by_stencil) = draw(gpu, warp, &picture, stencil, Holes::Open(HoleMark::Stencil));
                let wanted = |at: usize| if open[at] { farthest } else { depth[at] };
                assert!((0..all).all(|at| by_stencil[at] == wanted(at)), "{}, case {i}", gpu.name);
            }
        }
        assert!(sum > 1500, "{}: {sum} are open", gpu.name);
    });
}

#[test]
fn what_cannot_be_left_open_is_refused() {
    with_gpus(|gpu| {
        let of =
            |depth_format, mark| Options { depth_format, holes: Holes::Open(mark), ..Options::default() };
        let depth = Some(TextureFormat::Depth32Float);
        let errors = [
            AnyView::new(&gpu.device, &of(depth, HoleMark::Depth)).err(),
            Gather::new(&gpu.device, &of(depth, HoleMark::Stencil)).err(),
            Gather::new(&gpu.device, &of(None, HoleMark::Depth)).err(),
        ];
        assert!(errors.iter().all(|error| matches!(error, Some(WgpuError::Holes(_)))), "{errors:?}");
    });
}
