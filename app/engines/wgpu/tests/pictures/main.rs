//! The pictures of the passes on wgpu equal those of the OpenGL passes, both on wgpu's Vulkan and on its OpenGL.

mod harness;
mod holes;
mod levels;
mod nearest;

use against_opengl::{Gl, assert_equal, picture, warps};
use harness::{Gpu, depth_of, one_layer, with_gpus};
use table::{Device, Images, Role, Setup};
use yoro::eyes::{DisparityMap, Warp};
use yoro::synthesis::backend::WarpKind;
use yoro_test_support::table::vk;
use yoro_test_support::{against_opengl, table};
use yoro_wgpu::wgpu::{Backends, Texture, TextureAspect, TextureFormat, TextureUsages};
use yoro_wgpu::{Gather, Options, Pipeline, Source, Target, WgpuError};

/// Returns wgpu's name of a format.
fn named(format: vk::Format) -> TextureFormat {
    match format {
        vk::Format::R8G8B8A8_UNORM => TextureFormat::Rgba8Unorm,
        vk::Format::R8G8B8A8_SRGB => TextureFormat::Rgba8UnormSrgb,
        vk::Format::A2B10G10R10_UNORM_PACK32 => TextureFormat::Rgb10a2Unorm,
        vk::Format::R16G16B16A16_SFLOAT => TextureFormat::Rgba16Float,
        vk::Format::B8G8R8A8_UNORM => TextureFormat::Bgra8Unorm,
        vk::Format::D16_UNORM => TextureFormat::Depth16Unorm,
        vk::Format::X8_D24_UNORM_PACK32 => TextureFormat::Depth24Plus,
        vk::Format::D24_UNORM_S8_UINT => TextureFormat::Depth24PlusStencil8,
        vk::Format::D32_SFLOAT => TextureFormat::Depth32Float,
        vk::Format::D32_SFLOAT_S8_UINT => TextureFormat::Depth32FloatStencil8,
        vk::Format::R16_UNORM => TextureFormat::R16Unorm,
        vk::Format::R32_SFLOAT => TextureFormat::R32Float,
        other => panic!("{other:?} has no name here"),
    }
}

fn options(setup: &Setup) -> Options {
    Options {
        color_format: named(setup.target),
        depth_format: setup.target_depth.map(named),
        ..Options::default()
    }
}

impl Device for &Gpu {
    type Image = Texture;
    type Pipeline<W: WarpKind> = Pipeline<W>;

    fn name(&self) -> String {
        self.name.clone()
    }

    fn has(&self, format: vk::Format) -> bool {
        (**self).has(named(format))
    }

    fn samples_layers(&self) -> bool {
        !self.is_opengl()
    }

    fn image(&self, format: vk::Format, size: [u32; 2], layers: u32) -> Texture {
        self.texture(named(format), size, layers)
    }

    fn upload_rgba8(&self, image: &Texture, layer: u32, rgba: &[u8], _: Role, _: &Setup) {
        (**self).upload_rgba8(image, layer, rgba);
    }

    fn upload_depth(&self, image: &Texture, layer: u32, depth: &[f32], _: Role, _: &Setup) {
        (**self).upload_depth(image, layer, depth);
    }

    fn read_rgba8(&self, image: &Texture, layer: u32, _: Option<&Setup>) -> Vec<u8> {
        (**self).read_rgba8(image, layer)
    }

    fn read_depth(&self, image: &Texture, layer: u32, _: Option<&Setup>) -> Vec<f32> {
        (**self).read_depth(image, layer)
    }

    fn pipeline<W: WarpKind>(&self, setup: &Setup, _: [[u32; 2]; 2]) -> Pipeline<W> {
        Pipeline::new(&self.device, &options(setup)).unwrap()
    }

    fn draw<W: WarpKind>(
        &self,
        pipeline: &mut Pipeline<W>,
        setup: &Setup,
        images: &Images<Texture>,
        warp: &W,
    ) {
        let drawn = |texture| one_layer(texture, setup.target_layer, TextureAspect::All);
        let color = one_layer(&images.color, setup.source_layer, TextureAspect::All);
        let depth = depth_of(&images.depth, setup.source_layer);
        let (target, target_depth) = (drawn(&images.target), images.target_depth.as_ref().map(drawn));
        let [source_origin, origin] = setup.origins();
        let source = Source { origin: source_origin, ..Source::new(&color, &depth) };
        let to = Target { color: &target, depth: target_depth.as_ref(), origin };
        self.run(|encoder| pipeline.record(&self.device, &self.queue, encoder, &source, warp, &to)).unwrap();
    }
}

#[test]
fn pictures_are_those_of_opengl() {
    let gl = Gl::open();
    let (gather, any_view, motion) =
        (table::gather_cases(&gl), table::any_view_cases(&gl), table::motion_cases(&gl));
    drop(gl);
    with_gpus(|gpu| {
        table::check(&gpu, &gather);
        table::check(&gpu, &any_view);
        table::check(&gpu, &motion);
    });
}

/// Calls of one submission do not share their uniforms, although they share the intermediate buffers.
#[test]
fn calls_of_one_submission_do_not_disturb_each_other() {
    let (near, range) = warps()[2];
    let far = Warp { law: DisparityMap { scale: 0.25 * near.law.scale, ..near.law }, ..near };
    let gl = Gl::open();
    let pictures = [(near, 5), (far, 6)].map(|(warp, seed)| {
        let picture = picture(&warp, range, seed);
        (gl.run(&picture).rgba, picture)
    });
    drop(gl);
    with_gpus(|gpu| {
        let mut gather = Gather::new(&gpu.device, &options(&Setup::PLAIN)).unwrap();
        let made = [0, 1].map(|number| {
            let picture = &pictures[number].1;
            let color = gpu.texture(named(Setup::PLAIN.color), picture.warp.source_size, 1);
            let depth = gpu.texture(named(Setup::PLAIN.depth), picture.warp.source_size, 1);
            let target = gpu.texture(named(Setup::PLAIN.target), picture.warp.target_size, 1);
            gpu.upload_rgba8(&color, 0, &picture.rgba);
            gpu.upload_depth(&depth, 0, &picture.depth);
            [color, depth, target]
        });
        gpu.run(|encoder| {
            // Draws the second picture over the first, and the first over the second.
            for (source, target) in [(0, 0), (1, 0), (1, 1), (0, 1)] {
                let [color, depth, _] = made[source].each_ref().map(|texture| depth_of(texture, 0));
                let into = depth_of(&made[target][2], 0);
                let (source_of, target_of) = (Source::new(&color, &depth), Target::new(&into));
                let warp = &pictures[source].1.warp;
                gather.record(&gpu.device, &gpu.queue, encoder, &source_of, warp, &target_of).unwrap();
            }
        });
        for (target, source) in [(0, 1), (1, 0)] {
            let got = gpu.read_rgba8(&made[target][2], 0);
            assert_equal(&got, &pictures[source].0, 4, &gpu.name);
        }
    });
}

/// A caller's mistake returns one error, and nothing is recorded.
#[test]
fn mistakes_are_refused() {
    with_gpus(|gpu| {
        let (warp, _) = warps()[0];
        let plain = options(&Setup::PLAIN);
        let make = |options: &Options| Gather::new(&gpu.device, options).err();
        for format in [TextureFormat::Rgba8Uint, TextureFormat::Depth32Float, TextureFormat::Rgb9e5Ufloat] {
            let options = Options { color_format: format, ..plain };
            assert!(matches!(make(&options), Some(WgpuError::Format { .. })), "{format:?}");
        }
        let options = Options { depth_format: Some(TextureFormat::Rgba8Unorm), ..plain };
        assert!(matches!(make(&options), Some(WgpuError::Format { .. })));

        let mut gather = Gather::new(&gpu.device, &plain).unwrap();
        let [w, h] = warp.source_size;
        let whole = |texture| one_layer(&texture, 0, TextureAspect::All);
        let texture = |format, size| whole(gpu.texture(format, size, 1));
        let color = texture(TextureFormat::Rgba8Unorm, [w, h]);
        let depth = texture(TextureFormat::Depth32Float, [w, h]);
        let small = texture(TextureFormat::Depth32Float, [8, 8]);
        let many = whole(gpu.multisampled(TextureFormat::Depth32Float, [w, h]));
        let unsampled = gpu.with_usage(TextureFormat::Depth32Float, [w, h], TextureUsages::COPY_SRC);
        let into = texture(TextureFormat::Rgba8Unorm, warp.target_size);
        let float = texture(TextureFormat::Rgba16Float, warp.target_size);
        let usage = TextureUsages::TEXTURE_BINDING;
        let undrawn = gpu.with_usage(TextureFormat::Rgba8Unorm, warp.target_size, usage);
        let layer = one_layer(&gpu.texture(TextureFormat::Depth32Float, [w, h], 2), 1, TextureAspect::All);
        let (source, target) = (Source::new(&color, &depth), Target::new(&into));
        let of_depth = |depth| Source { depth, ..source };
        let at = |origin| Source { origin, ..source };
        gpu.run(|encoder| {
            let mut refused = |source: Source, warp: Warp, target: Target, want: &str| {
                let result = gather.record(&gpu.device, &gpu.queue, encoder, &source, &warp, &target);
                let got = result.unwrap_err().to_string();
                assert!(got.starts_with(want) && !got.contains('\n'), "{got:?} is not {want:?}");
            };
            let cannot = "the wgpu device cannot use";
            refused(of_depth(&color), warp, target, &format!("{cannot} Rgba8Unorm as a source's depth"));
            let of_color = Source { color: &depth, ..source };
            refused(of_color, warp, target, &format!("{cannot} Depth32Float as a source's colour"));
            refused(
                of_depth(&small),
                warp,
                target,
                "a source's depth of 8x8 pixels does not go with colour of",
            );
            refused(of_depth(&unsampled), warp, target, "a source's depth needs a texture with the usage");
            refused(
                of_depth(&many),
                warp,
                target,
                "a source's depth of 4 samples cannot be used; give a texture of 1",
            );
            refused(at([1, 0]), warp, target, "a source of");
            refused(at([0, u32::MAX]), warp, target, "a source of");
            let source_size = |source_size| Warp { source_size, ..warp };
            refused(source, source_size([w + 1, h]), target, "a source of");
            refused(
                source,
                source_size([1 << 20, h]),
                target,
                "a source of 1048576x41 pixels is not between 1x1",
            );
            let none = Warp { target_size: [0, h], ..warp };
            refused(source, none, target, "a target of 0x41 pixels is not between 1x1");
            refused(source, warp, Target { origin: [0, 1], ..target }, "a target of");
            refused(source, warp, Target { color: &float, ..target }, "a target of Rgba16Float does not fit");
            refused(source, warp, Target { color: &undrawn, ..target }, "a target's colour needs a texture");
            let with_depth = Target { depth: Some(&depth), ..target };
            refused(source, warp, with_depth, "a target with depth of Depth32Float does not fit");
            if gpu.is_opengl() {
                refused(of_depth(&layer), warp, target, "wgpu's OpenGL back end cannot sample a layer");
            }
        });
    });
}

#[test]
fn a_lost_device_is_an_error() {
    if std::env::var_os("YORO_TEST_WITHOUT_VULKAN").is_some() {
        return println!("LEFT OUT: wgpu on Vulkan");
    }
    let gpu = Gpu::open(Backends::VULKAN).unwrap();
    let (warp, _) = warps()[0];
    let mut gather = Gather::new(&gpu.device, &options(&Setup::PLAIN)).unwrap();
    let texture = |format, size| one_layer(&gpu.texture(format, size, 1), 0, TextureAspect::All);
    let [color, depth] =
        [Setup::PLAIN.color, Setup::PLAIN.depth].map(|format| texture(named(format), warp.source_size));
    let into = texture(named(Setup::PLAIN.target), warp.target_size);
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    gpu.device.destroy();
    let (source, target) = (Source::new(&color, &depth), Target::new(&into));
    let lost = gather.record(&gpu.device, &gpu.queue, &mut encoder, &source, &warp, &target);
    assert_eq!(lost, Err(WgpuError::DeviceLost));
}
