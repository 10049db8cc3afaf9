//! Pictures of the Vulkan passes equal those of the OpenGL passes, under the validation layer.

mod failures;
mod holes;
mod levels;
#[path = "../synthesis/reference.rs"]
#[expect(dead_code, reason = "the colours of filled holes are OpenGL's")]
mod reference;
mod resolved;

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;

use against_opengl::{Gl, assert_equal, picture, warps};
use harness::{Gpu, Image, READ, Rendering, WRITTEN, is_copied, with_gpu};
use table::{Device, Images, Role, Setup};
use yoro::eyes::Warp;
use yoro::synthesis::ArgumentError;
use yoro::synthesis::backend::WarpKind;
use yoro::vulkan::ash::vk;
use yoro::vulkan::{
    AnyView, Frame, Gather, ImageState, Options, Pipeline, SourceImages, TargetImages, Use, Uses, VulkanError,
};
use yoro_test_support::{against_opengl, harness, table};

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

/// Returns the options of a pipeline for sources and targets of up to these sizes.
fn options(setup: &Setup, [max_source_size, max_target_size]: [[u32; 2]; 2]) -> Options {
    Options {
        color_format: setup.target,
        depth_format: setup.target_depth,
        max_source_size,
        max_target_size,
        ..Options::default()
    }
}

/// Returns how a setup uses an image before and after the synthesis.
fn uses(role: Role, setup: &Setup) -> [ImageState; 2] {
    let general = ImageState { layout: vk::ImageLayout::GENERAL, ..ImageState::SAMPLED };
    let read_only = vk::ImageLayout::DEPTH_STENCIL_READ_ONLY_OPTIMAL;
    let read_only = ImageState { layout: read_only, ..ImageState::SAMPLED };
    match (role, setup.uses) {
        (Role::Color, 2) => [ImageState::SAMPLED; 2],
        (Role::Color, 3) => [general, ImageState::COLOR_ATTACHMENT],
        (Role::Depth, 2) => [read_only; 2],
        (Role::Depth, 3) => [general, ImageState::DEPTH_ATTACHMENT],
        (Role::Color | Role::Depth, _) => [WRITTEN, ImageState::SAMPLED],
        (Role::Target, 1) => [ImageState::COLOR_ATTACHMENT, READ],
        (Role::Target | Role::TargetDepth, _) => [WRITTEN, READ],
    }
}

/// The device of the table.
struct OnVulkan<'a>(&'a Gpu);

impl<'a> Device for OnVulkan<'a> {
    type Image = Image<'a>;
    type Pipeline<W: WarpKind> = Pipeline<W>;

    fn name(&self) -> String {
        self.0.name()
    }

    fn has(&self, format: vk::Format) -> bool {
        is_copied(format) && self.0.has(format, vk::FormatFeatureFlags::SAMPLED_IMAGE)
    }

    fn samples_layers(&self) -> bool {
        true
    }

    fn image(&self, format: vk::Format, size: [u32; 2], layers: u32) -> Image<'a> {
        self.0.image(format, size, layers)
    }

    fn upload_rgba8(&self, image: &Image<'a>, layer: u32, rgba: &[u8], role: Role, setup: &Setup) {
        image.upload_rgba8(layer, rgba, uses(role, setup)[0]);
    }

    fn upload_depth(&self, image: &Image<'a>, layer: u32, depth: &[f32], role: Role, setup: &Setup) {
        image.upload_depth(layer, depth, uses(role, setup)[0]);
    }

    fn read_rgba8(&self, image: &Image<'a>, layer: u32, before: Option<&Setup>) -> Vec<u8> {
        image.read_rgba8(layer, before.map_or(READ, |setup| uses(Role::Target, setup)[0]))
    }

    fn read_depth(&self, image: &Image<'a>, layer: u32, before: Option<&Setup>) -> Vec<f32> {
        image.read_depth(layer, before.map_or(READ, |setup| uses(Role::TargetDepth, setup)[0]))
    }

    fn pipeline<W: WarpKind>(&self, setup: &Setup, sizes: [[u32; 2]; 2]) -> Pipeline<W> {
        // SAFETY: the device outlives the pipeline, and all commands are executed before it is dropped.
        unsafe { Pipeline::new(&self.0.host(), &options(setup, sizes)).unwrap() }
    }

    fn draw<W: WarpKind>(
        &self,
        pipeline: &mut Pipeline<W>,
        setup: &Setup,
        images: &Images<Image<'a>>,
        warp: &W,
    ) {
        let image = |image: &Image, layer, role| {
            let [before, after] = uses(role, setup);
            image.layer(layer, before, after)
        };
        let [source_size, target_size] = setup.image_sizes(warp);
        let [source_origin, target_origin] = setup.origins();
        // SAFETY: the images live until all commands have been executed, and are in the given states.
        unsafe {
            let color = image(&images.color, setup.source_layer, Role::Color);
            let depth = image(&images.depth, setup.source_layer, Role::Depth);
            let source = pipeline.register_source(&SourceImages::new(color, depth, source_size)).unwrap();
            let depth = images.target_depth.as_ref();
            let target = TargetImages {
                color: image(&images.target, setup.target_layer, Role::Target),
                depth: depth.map(|depth| image(depth, setup.target_layer, Role::TargetDepth)),
                size: target_size,
            };
            let target = pipeline.register_target(&target).unwrap();
            let frame = Frame { source_origin, target_origin, ..Frame::new(source, target) };
            self.0.run(|commands| pipeline.record(commands, &frame, warp).unwrap());
            pipeline.release_source(source);
            pipeline.release_target(target);
        }
        // The validation layer checks that the layout is the requested one.
        for (image, role) in [(&images.color, Role::Color), (&images.depth, Role::Depth)] {
            self.0.run(|commands| image.barrier(commands, setup.source_layer, uses(role, setup)[1], READ));
        }
    }
}

#[test]
fn pictures_are_those_of_opengl() {
    let gl = Gl::open();
    let (gather, any_view, motion) =
        (table::gather_cases(&gl), table::any_view_cases(&gl), table::motion_cases(&gl));
    for rendering in Rendering::ALL {
        with_gpu(rendering, |gpu| {
            table::check(&OnVulkan(gpu), &gather);
            table::check(&OnVulkan(gpu), &any_view);
            table::check(&OnVulkan(gpu), &motion);
        });
    }
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
            let options = Options { timed_frames: 2, ..options(&Setup::PLAIN, warp.sizes()) };
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
            let mut gather = Gather::new(&gpu.host(), &options(&Setup::PLAIN, warp.sizes())).unwrap();
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
        let options = options(&setup, warp.sizes());
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
            let options = Options { timed_frames, ..options(&Setup::PLAIN, warp.sizes()) };
            // SAFETY: the device outlives the pipeline, and all commands are executed before it is dropped.
            unsafe {
                let mut gather = Gather::new(&gpu.host(), &options).unwrap();
                for frame in 0..7 {
                    let times = gather.pass_times().unwrap();
                    assert_eq!(times.is_some(), timed_frames > 0 && frame >= timed_frames, "frame {frame}");
                    assert!(times.is_none_or(|times| !times.march.is_zero()), "{times:?}");
                    table::synthesize(&OnVulkan(gpu), &mut gather, &Setup::PLAIN, &picture);
                }
            }
        }
    });
}
