//! Open holes: which pixels are left open, their marks, and all other pixels as if holes were filled.

use against_opengl::{picture, warps};
use harness::{Gpu, Image, READ, Rendering, with_gpu};
use yoro::eyes::Warp;
use yoro::synthesis::{HoleMark, Holes};
use yoro::vulkan::ash::vk;
use yoro::vulkan::{
    AnyView, Frame, Gather, ImageState, Motion, Options, SourceImages, TargetImages, VulkanError,
};
use yoro_test_support::{against_opengl, harness};

use super::reference::open_pixels;

/// The corner of the target in its images.
const ORIGIN: [u32; 2] = [5, 3];
const DEPTH: vk::Format = vk::Format::D32_SFLOAT_S8_UINT;

/// The target's rectangle, with rows from the bottom.
struct Drawn {
    rgba: Vec<[u8; 4]>,
    depth: Vec<f32>,
    stencil: Vec<u8>,
}

fn draw(gpu: &Gpu, warp: &Warp, picture: &against_opengl::Picture, holes: Holes) -> Drawn {
    let (sampled, drawn) = (ImageState::SAMPLED, ImageState::COLOR_ATTACHMENT);
    let size = [0, 1].map(|i| ORIGIN[i] + warp.target_size[i] + 2);
    let color = gpu.image(vk::Format::R8G8B8A8_UNORM, warp.source_size, 1);
    let depth = gpu.image(vk::Format::D32_SFLOAT, warp.source_size, 1);
    let target = gpu.image(vk::Format::R8G8B8A8_UNORM, size, 1);
    let target_depth = gpu.image(DEPTH, size, 1);
    color.upload_rgba8(0, &picture.rgba, sampled);
    depth.upload_depth(0, &picture.depth, sampled);
    let options = Options {
        depth_format: Some(DEPTH),
        holes,
        max_source_size: warp.source_size,
        max_target_size: warp.target_size,
        ..Options::default()
    };
    // SAFETY: the images live until all commands have been executed, and are in the given states.
    unsafe {
        let mut gather = Gather::new(&gpu.host(), &options).unwrap();
        let [color, depth] = [&color, &depth].map(|image| image.layer(0, sampled, sampled));
        let source = gather.register_source(&SourceImages::new(color, depth, warp.source_size)).unwrap();
        let images = TargetImages {
            color: target.layer(0, ImageState::DISCARDED, drawn),
            depth: Some(target_depth.layer(0, ImageState::DISCARDED, READ)),
            size,
        };
        let to = gather.register_target(&images).unwrap();
        let frame = Frame { target_origin: ORIGIN, ..Frame::new(source, to) };
        gpu.run(|commands| gather.record(commands, &frame, warp).unwrap());
    }
    let stencil = if holes.is_open() {
        part(&target_depth, warp, &target_depth.read_stencil(0, READ))
    } else {
        Vec::new()
    };
    let rgba = target.read_rgba8(0, drawn);
    let rgba: Vec<[u8; 4]> = rgba.chunks_exact(4).map(|c| [c[0], c[1], c[2], c[3]]).collect();
    Drawn {
        rgba: part(&target, warp, &rgba),
        depth: part(&target_depth, warp, &target_depth.read_depth(0, READ)),
        stencil,
    }
}

/// Returns the target's rectangle of an image whose rows are given from the bottom. Its corner is counted from the top.
fn part<T: Copy>(image: &Image, warp: &Warp, all: &[T]) -> Vec<T> {
    let [width, height] = image.size.map(|n| n as usize);
    let [w, h] = warp.target_size.map(|n| n as usize);
    let first = height - ORIGIN[1] as usize - h;
    all.chunks_exact(width)
        .skip(first)
        .take(h)
        .flat_map(|row| row[ORIGIN[0] as usize..][..w].to_vec())
        .collect()
}

#[test]
fn open_pixels_are_those_of_the_reference() {
    for rendering in [Rendering::RenderPasses, Rendering::Core] {
        with_gpu(rendering, |gpu| {
            let mut all = 0;
            for (i, (warp, range)) in warps().into_iter().enumerate() {
                let picture = picture(&warp, range, i as u64);
                let filled = draw(gpu, &warp, &picture, Holes::Filled);
                let open = draw(gpu, &warp, &picture, Holes::Open(HoleMark::Stencil));
                let by_depth = draw(gpu, &warp, &picture, Holes::Open(HoleMark::Depth));
                let [nearest, farthest] = warp.convention.planes();
                let want = open_pixels(&picture.depth, &warp);
                let [wt, ht] = warp.target_size.map(|n| n as usize);
                let (mut count, mut different) = (0, 0);
                for y in 0..ht {
                    for x in 0..wt {
                        let at = y * wt + x;
                        let is_open = open.stencil[at] == 0;
                        let what = format!("{rendering:?}, case {i}, pixel {x}, {y}");
                        assert_eq!(by_depth.depth[at], if is_open { farthest } else { nearest }, "{what}");
                        if is_open {
                            assert_eq!(open.depth[at], farthest, "{what}");
                        } else {
                            assert_eq!(open.stencil[at], 1, "{what}");
                            assert_eq!(
                                (open.rgba[at], open.depth[at]),
                                (filled.rgba[at], filled.depth[at]),
                                "{what}"
                            );
                            assert_eq!(by_depth.rgba[at], filled.rgba[at], "{what}");
                        }
                        count += usize::from(is_open);
                        different += usize::from(is_open != want[at]);
                    }
                }
                println!("{rendering:?}, case {i}: {count} of {} are open, {different} differ", wt * ht);
                assert!(different * 200 <= wt * ht, "case {i}: {different} of {} differ", wt * ht);
                all += count;
            }
            assert!(all > 1500, "{all} are open");
        });
    }
}

#[test]
fn what_cannot_be_left_open_is_refused() {
    with_gpu(Rendering::Core, |gpu| {
        let of =
            |depth_format, mark| Options { depth_format, holes: Holes::Open(mark), ..Options::default() };
        let stencil = of(Some(DEPTH), HoleMark::Stencil);
        // SAFETY: nothing is recorded.
        let errors = unsafe {
            [
                AnyView::new(&gpu.host(), &stencil).err(),
                Motion::new(&gpu.host(), &stencil).err(),
                Gather::new(&gpu.host(), &of(Some(vk::Format::D32_SFLOAT), HoleMark::Stencil)).err(),
                Gather::new(&gpu.host(), &of(None, HoleMark::Depth)).err(),
            ]
        };
        assert!(errors.iter().all(|error| matches!(error, Some(VulkanError::Holes(_)))), "{errors:?}");
    });
}
