//! Pictures of the Vulkan passes equal those of the OpenGL passes, under the validation layer.

mod any_view;
mod failures;
mod levels;
mod resolved;

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;

use rand::{Rng, SeedableRng};

use against_opengl::{
    Gl, Picture, RANDOM_RANGE, assert_equal, cut, expected_depth, eyes, gl_srgb, pasted, picture,
    random_cases, warps,
};
use harness::{Gpu, Image, READ, Rendering, WRITTEN, largest, with_gpu};
use yoro::eyes::{DepthConvention, DepthRange, Eye, GuardBand, Warp};
use yoro::synthesis::ArgumentError;
use yoro::synthesis::backend::WarpKind;
use yoro::vulkan::ash::vk;
use yoro::vulkan::{
    AnyView, Frame, Gather, ImageState, Options, Pipeline, SourceImages, TargetImages, Use, Uses, VulkanError,
};
use yoro_test_support::{against_opengl, harness};

/// An allocator that counts this thread's allocations.
struct Counting;

thread_local! {
    static ALLOCATIONS: Cell<usize> = const { Cell::new(0) };
}

// SAFETY: all work is done by the system's allocator, which keeps the contract.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        ALLOCATIONS.set(ALLOCATIONS.get() + 1);
        // SAFETY: the arguments are passed on unchanged.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, memory: *mut u8, layout: Layout) {
        // SAFETY: the arguments are passed on unchanged.
        unsafe { System.dealloc(memory, layout) }
    }
}

#[global_allocator]
static COUNTING: Counting = Counting;

fn allocations() -> usize {
    ALLOCATIONS.get()
}

/// The parameters of a synthesis.
#[derive(Clone, Copy, Debug)]
struct Setup {
    color: vk::Format,
    depth: vk::Format,
    /// Formats of the target's colour and depth.
    target: vk::Format,
    target_depth: Option<vk::Format>,
    /// Margins before the upper left and after the lower right corners.
    source_margins: [[u32; 2]; 2],
    target_margins: [[u32; 2]; 2],
    /// Which of two layers is used.
    source_layer: u32,
    target_layer: u32,
    /// Uses of the source's images around the call.
    states: [[ImageState; 2]; 2],
    target_before: ImageState,
}

impl Setup {
    const PLAIN: Setup = Setup {
        color: vk::Format::R8G8B8A8_UNORM,
        depth: vk::Format::R32_SFLOAT,
        target: vk::Format::R8G8B8A8_UNORM,
        target_depth: None,
        source_margins: [[0; 2]; 2],
        target_margins: [[0; 2]; 2],
        source_layer: 0,
        target_layer: 0,
        states: [[WRITTEN, ImageState::SAMPLED]; 2],
        target_before: WRITTEN,
    };

    fn options(&self, warps: &[impl WarpKind]) -> Options {
        let [max_source_size, max_target_size] = largest(warps);
        Options {
            color_format: self.target,
            depth_format: self.target_depth,
            max_source_size,
            max_target_size,
            ..Options::default()
        }
    }
}

struct Result {
    rgba: Vec<u8>,
    depth: Option<Vec<f32>>,
}

/// Synthesizes a picture in images that hold other data around it.
fn synthesize<W: WarpKind>(
    gpu: &Gpu,
    pipeline: &mut Pipeline<W>,
    setup: &Setup,
    picture: &Picture<W>,
) -> Result {
    let warp = &picture.warp;
    let [source_size, target_size] = warp.sizes();
    let sum = |[a, b]: [[u32; 2]; 2], size: [u32; 2]| [0, 1].map(|i| a[i] + size[i] + b[i]);
    let source_image = sum(setup.source_margins, source_size);
    let target_image = sum(setup.target_margins, target_size);
    let pixels = |size: [u32; 2]| size[0] as usize * size[1] as usize;
    let [source_origin, target_origin] = [setup.source_margins[0], setup.target_margins[0]];
    let width = source_size[0] as usize;

    let color = gpu.image(setup.color, source_image, 2);
    let depth = gpu.image(setup.depth, source_image, 2);
    // Random depth around the source would show.
    let mut rng = rand_pcg::Pcg32::seed_from_u64(99);
    let junk: Vec<u8> = (0..pixels(source_image) * 4).map(|_| rng.random()).collect();
    let junk_depth: Vec<f32> = (0..pixels(source_image)).map(|_| rng.random_range(0.0..=1.0)).collect();
    for layer in 0..2 {
        let here = layer == setup.source_layer;
        let rgba = if here {
            pasted(junk.clone(), source_image, source_origin, &picture.rgba, width)
        } else {
            junk.clone()
        };
        color.upload_rgba8(layer, &rgba, setup.states[0][0]);
        let values = if here {
            pasted(junk_depth.clone(), source_image, source_origin, &picture.depth, width)
        } else {
            junk_depth.clone()
        };
        depth.upload_depth(layer, &values, setup.states[1][0]);
    }
    let target = gpu.image(setup.target, target_image, 2);
    let before: Vec<u8> = (0..pixels(target_image) * 4).map(|_| rng.random()).collect();
    (0..2).for_each(|layer| target.upload_rgba8(layer, &before, setup.target_before));
    // The target's old content, after conversions between formats; what is not written must stay the same.
    let before = target.read_rgba8(setup.target_layer, setup.target_before);
    let target_depth = setup.target_depth.map(|format| gpu.image(format, target_image, 2));
    let image = |image: &Image, layer, [before, after]: [ImageState; 2]| image.layer(layer, before, after);

    // SAFETY: the images live until all commands have been executed, and are in the given states.
    unsafe {
        let source_color = image(&color, setup.source_layer, setup.states[0]);
        let source_depth = image(&depth, setup.source_layer, setup.states[1]);
        let source = SourceImages::new(source_color, source_depth, source_image);
        let source = pipeline.register_source(&source).unwrap();
        let written = |depth: &Image| image(depth, setup.target_layer, [ImageState::DISCARDED, READ]);
        let images = TargetImages {
            color: image(&target, setup.target_layer, [setup.target_before, READ]),
            depth: target_depth.as_ref().map(written),
            size: target_image,
        };
        let target_id = pipeline.register_target(&images).unwrap();
        let frame = Frame { source_origin, target_origin, ..Frame::new(source, target_id) };
        gpu.run(|commands| pipeline.record(commands, &frame, warp).unwrap());
        pipeline.release_source(source);
        pipeline.release_target(target_id);
    }
    let after = target.read_rgba8(setup.target_layer, READ);
    let rgba = cut(&after, target_image, target_origin, target_size, 4);
    let width = target_size[0] as usize;
    let outside = pasted(before, target_image, target_origin, &rgba, width);
    assert!(outside == after, "pixels outside of the target's rectangle have changed: {setup:?}");
    // The validation layer checks that the layout is the requested one.
    for (image, states) in [(&color, setup.states[0]), (&depth, setup.states[1])] {
        gpu.run(|commands| image.barrier(commands, setup.source_layer, states[1], READ));
    }
    let depth = target_depth.map(|depth| {
        let all = depth.read_depth(setup.target_layer, READ);
        cut(&all, target_image, target_origin, target_size, 1)
    });
    Result { rgba, depth }
}

#[test]
fn pictures_equal_those_of_opengl() {
    let gl = Gl::open();
    for rendering in Rendering::ALL {
        with_gpu(rendering, |gpu| {
            let (warps, setup) = (warps(), Setup::PLAIN);
            let all: Vec<Warp> = warps.iter().map(|(warp, _)| *warp).collect();
            // SAFETY: the device outlives the pipeline, and all commands are executed before it is dropped.
            let mut gather = unsafe { Gather::new(&gpu.host(), &setup.options(&all)).unwrap() };
            for (i, (warp, range)) in warps.into_iter().enumerate() {
                let picture = picture(&warp, range, i as u64);
                let got = synthesize(gpu, &mut gather, &setup, &picture);
                assert_equal(&got.rgba, &gl.run(&picture).rgba, 4, &format!("{rendering:?}, {warp:?}"));
            }
        });
    }
}

/// Parts of larger images and layers of arrays, with one pipeline for several sizes, in all layouts.
#[test]
fn parts_and_layers_are_found() {
    let gl = Gl::open();
    with_gpu(Rendering::RenderPasses, |gpu| {
        let warps = warps();
        let [read_only, general] =
            [vk::ImageLayout::DEPTH_STENCIL_READ_ONLY_OPTIMAL, vk::ImageLayout::GENERAL]
                .map(|layout| ImageState { layout, ..ImageState::SAMPLED });
        let setup = Setup { depth: vk::Format::D32_SFLOAT, target_layer: 1, ..Setup::PLAIN };
        let setups = [
            Setup { source_layer: 1, source_margins: [[5, 3], [2, 7]], ..setup },
            Setup { target_margins: [[4, 9], [1, 2]], target_before: ImageState::COLOR_ATTACHMENT, ..setup },
            Setup {
                source_margins: [[0, 2], [3, 0]],
                target_margins: [[1, 0], [0, 5]],
                states: [[ImageState::SAMPLED; 2], [read_only; 2]],
                ..setup
            },
            Setup {
                source_margins: [[1, 1], [1, 1]],
                states: [[general, ImageState::COLOR_ATTACHMENT], [general, ImageState::DEPTH_ATTACHMENT]],
                ..setup
            },
        ];
        let all: Vec<Warp> = warps.iter().map(|(warp, _)| *warp).collect();
        // SAFETY: the device outlives the pipeline, and all commands are executed before it is dropped.
        let mut gather = unsafe { Gather::new(&gpu.host(), &setup.options(&all)).unwrap() };
        for (i, (warp, range)) in warps.iter().enumerate() {
            let picture = picture(warp, *range, 50 + i as u64);
            let setup = &setups[i % setups.len()];
            let got = synthesize(gpu, &mut gather, setup, &picture);
            assert_equal(&got.rgba, &gl.run(&picture).rgba, 4, &format!("{warp:?}, {setup:?}"));
        }
    });
}

#[test]
fn every_format_is_taken() {
    let gl = Gl::open();
    for rendering in [Rendering::RenderPasses, Rendering::Core] {
        with_gpu(rendering, |gpu| {
            let color = [
                vk::Format::R8G8B8A8_UNORM,
                vk::Format::A2B10G10R10_UNORM_PACK32,
                vk::Format::R16G16B16A16_SFLOAT,
                vk::Format::B8G8R8A8_UNORM,
            ];
            let depth = [
                vk::Format::D16_UNORM,
                vk::Format::D24_UNORM_S8_UINT,
                vk::Format::D32_SFLOAT,
                vk::Format::D32_SFLOAT_S8_UINT,
            ];
            let sources = [&depth[..], &[vk::Format::R16_UNORM]].concat();
            let range = DepthRange { near: 0.3, far: 100.0, convention: DepthConvention::Reversed };
            let warp = eyes([150, 41], Eye::Left, range).synthesis_views(GuardBand::Pixels(9)).unwrap().warp;
            for (i, format) in sources.into_iter().enumerate() {
                if !gpu.has(format, vk::FormatFeatureFlags::SAMPLED_IMAGE) {
                    println!("SKIPPED: {} has no {format:?}", gpu.name());
                    continue;
                }
                let mut picture = picture(&warp, range, 70);
                if matches!(format, vk::Format::D16_UNORM | vk::Format::R16_UNORM) {
                    picture.depth.iter_mut().for_each(|depth| *depth = (*depth * 65535.0).round() / 65535.0);
                }
                let setup = Setup {
                    color: color[i % color.len()],
                    depth: format,
                    target: color[(i + 1) % color.len()],
                    target_depth: Some(depth[(i + 1) % depth.len()]),
                    source_margins: [[2, 2], [0, 0]],
                    target_margins: [[0, 1], [1, 0]],
                    ..Setup::PLAIN
                };
                // SAFETY: the device outlives the pipeline, and all commands are executed before it is dropped.
                let mut gather = unsafe { Gather::new(&gpu.host(), &setup.options(&[warp])).unwrap() };
                let got = synthesize(gpu, &mut gather, &setup, &picture);
                let want = gl.run(&picture);
                // Formats with ten bits have only two of alpha.
                assert_equal(&got.rgba, &want.rgba, 3, &format!("{rendering:?}, {setup:?}"));
                let expected = expected_depth(&picture, &want.source_map);
                let error =
                    got.depth.unwrap().iter().zip(&expected).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
                // A law tells depth to a sixteenth of a pixel of displacement.
                let pixels = f64::from(error) * warp.law.scale.abs();
                assert!(pixels < 1.0 / 16.0, "{rendering:?}, {setup:?}: depth differs by {pixels} pixels");
            }
        });
    }
}

/// sRGB is decoded, filtered and encoded by Vulkan as by OpenGL.
#[test]
fn srgb_is_filtered_in_linear_light() {
    let gl = Gl::open();
    with_gpu(Rendering::Core, |gpu| {
        let (warp, range) = warps()[2];
        let picture = picture(&warp, range, 80);
        let srgb = vk::Format::R8G8B8A8_SRGB;
        let setup = Setup { color: srgb, target: srgb, ..Setup::PLAIN };
        // SAFETY: the device outlives the pipeline, and all commands are executed before it is dropped.
        let mut gather = unsafe { Gather::new(&gpu.host(), &setup.options(&[warp])).unwrap() };
        let got = synthesize(gpu, &mut gather, &setup, &picture);
        let want = gl_srgb(gl.headless.gl(), &picture);
        assert_equal(&got.rgba, &want, 4, "sRGB");
        assert_ne!(want, gl.run(&picture).rgba, "linear light makes a difference");
    });
}

/// Random sizes, rectangles, eyes and laws, with displacements of up to 300 pixels, where the search skips tiles.
#[test]
fn sizes_and_rectangles_at_random() {
    let gl = Gl::open();
    with_gpu(Rendering::Core, |gpu| {
        let limits = Options { max_source_size: [540, 70], max_target_size: [540, 70], ..Options::default() };
        // SAFETY: the device outlives the pipeline, and all commands are executed before it is dropped.
        let mut gather = unsafe { Gather::new(&gpu.host(), &limits).unwrap() };
        for (case, seed) in random_cases().into_iter().zip(3..) {
            let picture = picture(&case.warp, RANDOM_RANGE, seed);
            let setup = Setup {
                source_margins: case.source_margins,
                target_margins: case.target_margins,
                source_layer: case.source_layer,
                target_layer: case.target_layer,
                ..Setup::PLAIN
            };
            let got = synthesize(gpu, &mut gather, &setup, &picture);
            assert_equal(&got.rgba, &gl.run(&picture).rgba, 4, &format!("{case:?}"));
        }
    });
}

/// No frame overwrites what an earlier one still reads or writes (the validation layer checks this), and recording
/// allocates nothing.
#[test]
fn frames_do_not_overwrite_each_other_and_recording_allocates_nothing() {
    let gl = Gl::open();
    for rendering in [Rendering::RenderPasses, Rendering::Core] {
        with_gpu(rendering, |gpu| {
            let (warp, range) = warps()[2];
            let pictures = [1, 2].map(|seed| picture(&warp, range, seed));
            let options = Options { timed_frames: 2, ..Setup::PLAIN.options(&[warp]) };
            let (sampled, drawn) = (ImageState::SAMPLED, ImageState::COLOR_ATTACHMENT);
            // SAFETY: the images live until all commands have been executed, and are in the given states.
            unsafe {
                let mut gather = Gather::new(&gpu.host(), &options).unwrap();
                let images = pictures.each_ref().map(|picture| {
                    let color = gpu.image(Setup::PLAIN.color, warp.source_size, 1);
                    let depth = gpu.image(Setup::PLAIN.depth, warp.source_size, 1);
                    let target = gpu.image(Setup::PLAIN.target, warp.target_size, 1);
                    color.upload_rgba8(0, &picture.rgba, sampled);
                    depth.upload_depth(0, &picture.depth, sampled);
                    target.upload_rgba8(0, &vec![0; target.pixels() * 4], drawn);
                    (color, depth, target)
                });
                let ids = images.each_ref().map(|(color, depth, target)| {
                    let [color, depth] = [color, depth].map(|image| image.layer(0, sampled, sampled));
                    let source = SourceImages::new(color, depth, warp.source_size);
                    let target = TargetImages::new(target.layer(0, drawn, drawn), warp.target_size);
                    (gather.register_source(&source).unwrap(), gather.register_target(&target).unwrap())
                });
                gpu.run(|commands| {
                    let allocated = allocations();
                    // The second picture over the first one, then the first one elsewhere, and the second one again.
                    for (source, target) in [(0, 0), (1, 0), (0, 1), (1, 0)] {
                        let (source, target) = (ids[source].0, ids[target].1);
                        gather.record(commands, &Frame::new(source, target), &warp).unwrap();
                    }
                    assert_eq!(allocations(), allocated, "recording allocates");
                });
                for (target, picture) in [(0, 1), (1, 0)] {
                    let got = images[target].2.read_rgba8(0, drawn);
                    assert_equal(&got, &gl.run(&pictures[picture]).rgba, 4, "one after the other");
                }
            }
        });
    }
}

/// Images that other passes use before and after, with uses that differ from frame to frame, and empty stages, as with
/// a semaphore. The validation layer checks them.
#[test]
fn uses_differ_from_frame_to_frame() {
    let gl = Gl::open();
    with_gpu(Rendering::RenderPasses, |gpu| {
        let (warp, range) = warps()[0];
        let picture = picture(&warp, range, 7);
        let nothing = |layout| ImageState {
            layout,
            stages: vk::PipelineStageFlags::empty(),
            access: vk::AccessFlags::empty(),
        };
        let (sampled, drawn) = (ImageState::SAMPLED, ImageState::COLOR_ATTACHMENT);
        let [color, depth] =
            [Setup::PLAIN.color, Setup::PLAIN.depth].map(|format| gpu.image(format, warp.source_size, 1));
        let target = gpu.image(Setup::PLAIN.target, warp.target_size, 1);
        color.upload_rgba8(0, &picture.rgba, WRITTEN);
        depth.upload_depth(0, &picture.depth, WRITTEN);
        target.upload_rgba8(0, &vec![0; target.pixels() * 4], WRITTEN);
        // SAFETY: the images live until all commands have been executed, and are in the given states.
        unsafe {
            let mut gather = Gather::new(&gpu.host(), &Setup::PLAIN.options(&[warp])).unwrap();
            // In no frame is any of them in its registered state.
            let [color, depth] = [&color, &depth].map(|image| image.layer(0, sampled, sampled));
            let source = SourceImages::new(color, depth, warp.source_size);
            let targets = TargetImages::new(target.layer(0, drawn, drawn), warp.target_size);
            let source = gather.register_source(&source).unwrap();
            let frame = Frame::new(source, gather.register_target(&targets).unwrap());
            let free = nothing(vk::ImageLayout::GENERAL);
            let source_depth = nothing(vk::ImageLayout::TRANSFER_SRC_OPTIMAL);
            for [before, after, depth_after] in [[WRITTEN, free, source_depth], [free, READ, READ]] {
                let depth_before = if before == free { source_depth } else { before };
                let (own, of_depth) =
                    (Use { before, after }, Use { before: depth_before, after: depth_after });
                let uses =
                    Uses { source_color: own, source_depth: of_depth, target_color: own, target_depth: own };
                gpu.run(|commands| gather.record_with_uses(commands, &frame, &warp, &uses).unwrap());
            }
        }
        let got = target.read_rgba8(0, READ);
        assert_equal(&got, &gl.run(&picture).rgba, 4, "in other states");
    });
}

#[test]
fn the_memory_is_known_before() {
    with_gpu(Rendering::Core, |gpu| {
        let options =
            Options { max_source_size: [300, 200], max_target_size: [128, 190], ..Options::default() };
        // SAFETY: the device outlives the pipelines.
        let (gather, any_view) = unsafe {
            (Gather::new(&gpu.host(), &options).unwrap(), AnyView::new(&gpu.host(), &options).unwrap())
        };
        assert_eq!(options.buffer_bytes(), 16 * (19 * 25 + 8 * 25));
        assert_eq!(gather.buffer_bytes(), options.buffer_bytes());
        assert_eq!(options.any_view_buffer_bytes(), 16 * (19 * 25 + 8 * 24));
        assert_eq!(any_view.buffer_bytes(), options.any_view_buffer_bytes());
    });
}

/// A caller's mistake gives an error, and nothing is recorded.
#[test]
fn mistakes_are_refused() {
    with_gpu(Rendering::RenderPasses, |gpu| {
        let (warp, _) = warps()[0];
        let setup = Setup::PLAIN;
        let options = setup.options(&[warp]);
        // SAFETY: valid handles; whatever is created from them is dropped before the device, unused.
        unsafe {
            let make = |options: &Options| Gather::new(&gpu.host(), options).err();
            let none = Options { max_source_size: [0, 4], ..options };
            assert!(matches!(make(&none), Some(VulkanError::Argument(ArgumentError::Size { .. }))));
            let much = Options { max_target_size: [1 << 20, 4], ..options };
            assert!(matches!(make(&much), Some(VulkanError::Argument(ArgumentError::Size { .. }))));
            for format in [vk::Format::R8G8B8A8_UINT, vk::Format::D32_SFLOAT, vk::Format::UNDEFINED] {
                let format = Options { color_format: format, ..options };
                assert!(matches!(make(&format), Some(VulkanError::Format { .. })), "{format:?}");
            }
            let color = Options { depth_format: Some(vk::Format::R8G8B8A8_UNORM), ..options };
            assert!(matches!(make(&color), Some(VulkanError::Format { .. })));
            let family = Gather::new(&yoro::vulkan::Host { queue_family: 77, ..gpu.host() }, &options);
            assert_eq!(family.err(), Some(VulkanError::QueueFamily(77)));
            let dynamic =
                Gather::new(&yoro::vulkan::Host { dynamic_rendering: true, ..gpu.host() }, &options);
            assert_eq!(dynamic.err(), Some(VulkanError::DynamicRendering));

            let mut gather = Gather::new(&gpu.host(), &options).unwrap();
            let [w, h] = warp.source_size;
            let color = gpu.image(setup.color, warp.source_size, 1);
            let depth = gpu.image(setup.depth, warp.source_size, 1);
            let target = gpu.image(setup.target, warp.target_size, 1);
            let sampled = |image: &Image| image.layer(0, ImageState::SAMPLED, ImageState::SAMPLED);
            let source = SourceImages::new(sampled(&color), sampled(&depth), warp.source_size);
            let no_depth = SourceImages { depth: sampled(&color), ..source };
            let refused = gather.register_source(&no_depth).unwrap_err();
            assert!(
                refused
                    .to_string()
                    .starts_with("the Vulkan device cannot use R8G8B8A8_UNORM as a source's depth")
            );
            let two = gpu.image(vk::Format::R16G16_SFLOAT, warp.source_size, 1);
            let vectors = SourceImages { color: sampled(&two), ..source };
            let mut motion = yoro::vulkan::Motion::new(&gpu.host(), &options).unwrap();
            let refused = motion.register_source(&vectors).unwrap_err();
            assert_eq!(refused, VulkanError::Argument(ArgumentError::TwoComponents));
            let target = TargetImages::new(sampled(&target), warp.target_size);
            let with_depth = TargetImages { depth: Some(sampled(&depth)), ..target };
            assert!(matches!(gather.register_target(&with_depth), Err(VulkanError::OtherFormat { .. })));

            let source = gather.register_source(&source).unwrap();
            let target = gather.register_target(&target).unwrap();
            let frame = Frame::new(source, target);
            gpu.run(|commands| {
                let mut record = |frame, warp: Warp| gather.record(commands, &frame, &warp).unwrap_err();
                let wide = Warp { source_size: [w + 1, h], ..warp };
                assert!(matches!(record(frame, wide), VulkanError::Argument(ArgumentError::Size { .. })));
                let none = Warp { target_size: [0, h], ..warp };
                assert!(matches!(record(frame, none), VulkanError::Argument(ArgumentError::Size { .. })));
                for origin in [[1, 0], [0, 1], [u32::MAX, 0]] {
                    let error = record(Frame { source_origin: origin, ..frame }, warp);
                    assert!(
                        matches!(error, VulkanError::Argument(ArgumentError::Rectangle { .. })),
                        "{error}"
                    );
                    let error = record(Frame { target_origin: origin, ..frame }, warp);
                    assert!(
                        matches!(error, VulkanError::Argument(ArgumentError::Rectangle { .. })),
                        "{error}"
                    );
                }
                gather.release_source(source);
                assert_eq!(gather.record(commands, &frame, &warp), Err(VulkanError::NotRegistered));
            });
        }
    });
}

/// Times arrive as many frames later as the options say.
#[test]
fn passes_are_timed() {
    with_gpu(Rendering::Core, |gpu| {
        let (warp, range) = warps()[0];
        let picture = picture(&warp, range, 90);
        for timed_frames in [0, 1, 3] {
            let options = Options { timed_frames, ..Setup::PLAIN.options(&[warp]) };
            // SAFETY: the device outlives the pipeline, and all commands are executed before it is dropped.
            unsafe {
                let mut gather = Gather::new(&gpu.host(), &options).unwrap();
                for frame in 0..7 {
                    let times = gather.pass_times().unwrap();
                    assert_eq!(times.is_some(), timed_frames > 0 && frame >= timed_frames, "frame {frame}");
                    assert!(times.is_none_or(|times| !times.march.is_zero()), "{times:?}");
                    synthesize(gpu, &mut gather, &Setup::PLAIN, &picture);
                }
            }
        }
    });
}
