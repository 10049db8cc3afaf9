//! The pictures of the passes on wgpu equal those of the OpenGL passes, both on wgpu's Vulkan and on its OpenGL.

mod any_view;
mod harness;
mod levels;
mod nearest;

use rand::{Rng, SeedableRng};

use against_opengl::{
    Gl, Picture, RANDOM_RANGE, assert_equal, cut, expected_depth, eyes, gl_srgb, pasted, picture,
    random_cases, warps,
};
use harness::{Gpu, depth_of, one_layer, with_gpus};
use yoro::eyes::{DepthConvention, DepthRange, DisparityMap, Eye, GuardBand, Warp};
use yoro::synthesis::backend::WarpKind;
use yoro_test_support::against_opengl;
use yoro_wgpu::wgpu::{Backends, TextureAspect, TextureFormat, TextureUsages};
use yoro_wgpu::{Gather, Options, Pipeline, Source, Target, WgpuError};

/// The parameters of a synthesis.
#[derive(Clone, Copy, Debug)]
struct Setup {
    color: TextureFormat,
    depth: TextureFormat,
    /// Formats of the target.
    target: TextureFormat,
    target_depth: Option<TextureFormat>,
    /// The space beyond the rectangle at its upper left and at its lower right corner, in pixels.
    source_margins: [[u32; 2]; 2],
    target_margins: [[u32; 2]; 2],
    /// The layer that is used. It is the last layer of its texture.
    source_layer: u32,
    target_layer: u32,
}

impl Setup {
    const PLAIN: Setup = Setup {
        color: TextureFormat::Rgba8Unorm,
        depth: TextureFormat::R32Float,
        target: TextureFormat::Rgba8Unorm,
        target_depth: None,
        source_margins: [[0; 2]; 2],
        target_margins: [[0; 2]; 2],
        source_layer: 0,
        target_layer: 0,
    };

    fn options(&self) -> Options {
        Options { color_format: self.target, depth_format: self.target_depth }
    }

    /// Returns this setup, reduced to what the device supports.
    fn on(&self, gpu: &Gpu) -> Setup {
        Setup { source_layer: if gpu.is_opengl() { 0 } else { self.source_layer }, ..*self }
    }

    fn gather(&self, gpu: &Gpu) -> Gather {
        Gather::new(&gpu.device, &self.options()).unwrap()
    }
}

struct Synthesized {
    rgba: Vec<u8>,
    depth: Option<Vec<f32>>,
}

/// Synthesizes a picture inside textures that hold something else around it.
fn synthesize<W: WarpKind>(
    gpu: &Gpu,
    pipeline: &mut Pipeline<W>,
    setup: &Setup,
    picture: &Picture<W>,
) -> Synthesized {
    let warp = &picture.warp;
    let [source_size, target_size] = warp.sizes();
    let sum = |[a, b]: [[u32; 2]; 2], size: [u32; 2]| [0, 1].map(|i| a[i] + size[i] + b[i]);
    let source_image = sum(setup.source_margins, source_size);
    let target_image = sum(setup.target_margins, target_size);
    let pixels = |size: [u32; 2]| size[0] as usize * size[1] as usize;
    let [source_origin, target_origin] = [setup.source_margins[0], setup.target_margins[0]];
    let width = source_size[0] as usize;

    let [source_layers, target_layers] = [setup.source_layer + 1, setup.target_layer + 1];
    let color = gpu.texture(setup.color, source_image, source_layers);
    let depth = gpu.texture(setup.depth, source_image, source_layers);
    // Random near and far values, which would show if they were used.
    let mut rng = rand_pcg::Pcg32::seed_from_u64(99);
    let junk: Vec<u8> = (0..pixels(source_image) * 4).map(|_| rng.random()).collect();
    let junk_depth: Vec<f32> = (0..pixels(source_image)).map(|_| rng.random_range(0.0..=1.0)).collect();
    for layer in 0..source_layers {
        let (mut rgba, mut values) = (junk.clone(), junk_depth.clone());
        if layer == setup.source_layer {
            rgba = pasted(rgba, source_image, source_origin, &picture.rgba, width);
            values = pasted(values, source_image, source_origin, &picture.depth, width);
        }
        gpu.upload_rgba8(&color, layer, &rgba);
        gpu.upload_depth(&depth, layer, &values);
    }
    let target = gpu.texture(setup.target, target_image, target_layers);
    let before: Vec<u8> = (0..pixels(target_image) * 4).map(|_| rng.random()).collect();
    (0..target_layers).for_each(|layer| gpu.upload_rgba8(&target, layer, &before));
    // Reads the texture back, so that later comparisons include any conversions.
    let before = gpu.read_rgba8(&target, setup.target_layer);
    let target_depth = setup.target_depth.map(|format| gpu.texture(format, target_image, target_layers));
    let junk_depth: Vec<f32> = (0..pixels(target_image)).map(|_| rng.random_range(0.0..=1.0)).collect();
    let depth_before = target_depth.as_ref().map(|depth| {
        gpu.upload_depth(depth, setup.target_layer, &junk_depth);
        gpu.read_depth(depth, setup.target_layer)
    });

    let drawn = |texture| one_layer(texture, setup.target_layer, TextureAspect::All);
    let (color, depth) =
        (one_layer(&color, setup.source_layer, TextureAspect::All), depth_of(&depth, setup.source_layer));
    let (target_view, depth_view) = (drawn(&target), target_depth.as_ref().map(drawn));
    let source = Source { origin: source_origin, ..Source::new(&color, &depth) };
    let target_of = Target { color: &target_view, depth: depth_view.as_ref(), origin: target_origin };
    gpu.run(|encoder| pipeline.record(&gpu.device, &gpu.queue, encoder, &source, warp, &target_of)).unwrap();

    let after = gpu.read_rgba8(&target, setup.target_layer);
    let rgba = cut(&after, target_image, target_origin, target_size, 4);
    let width = target_size[0] as usize;
    let outside = pasted(before, target_image, target_origin, &rgba, width);
    assert!(outside == after, "pixels outside of the target's rectangle have changed: {setup:?}");
    let depth = target_depth.zip(depth_before).map(|(depth, before)| {
        let after = gpu.read_depth(&depth, setup.target_layer);
        let values = cut(&after, target_image, target_origin, target_size, 1);
        let outside = pasted(before, target_image, target_origin, &values, width);
        assert!(outside == after, "depth outside of the target's rectangle has changed: {setup:?}");
        values
    });
    Synthesized { rgba, depth }
}

/// Returns pictures for warps, with seeds from `first`, and what OpenGL draws.
fn on_opengl(gl: &Gl, warps: &[(Warp, DepthRange)], first: u64) -> Vec<(Picture, Vec<u8>)> {
    let numbered = warps.iter().zip(first..);
    let pictures = numbered.map(|((warp, range), seed)| picture(warp, *range, seed));
    pictures
        .map(|picture| (gl.run(&picture).rgba, picture))
        .map(|(wanted, picture)| (picture, wanted))
        .collect()
}

#[test]
fn pictures_equal_those_of_opengl() {
    let pictures = on_opengl(&Gl::open(), &warps(), 0);
    with_gpus(|gpu| {
        let mut gather = Setup::PLAIN.gather(gpu);
        for (picture, wanted) in &pictures {
            let got = synthesize(gpu, &mut gather, &Setup::PLAIN, picture);
            let what = format!("{}, {:?}", gpu.name, picture.warp);
            assert_equal(&got.rgba, wanted, 4, &what);
        }
    });
}

/// Parts of larger textures and layers of arrays, with one pipeline for several sizes.
#[test]
fn parts_and_layers_are_found() {
    let pictures = on_opengl(&Gl::open(), &warps(), 50);
    let setup = Setup { depth: TextureFormat::Depth32Float, ..Setup::PLAIN };
    let setups = [
        Setup { source_layer: 1, source_margins: [[5, 3], [2, 7]], target_layer: 1, ..setup },
        Setup { target_margins: [[4, 9], [1, 2]], target_layer: 1, ..setup },
        Setup { source_margins: [[0, 2], [3, 0]], target_margins: [[1, 0], [0, 5]], ..setup },
        Setup { source_margins: [[1, 1], [1, 1]], ..setup },
    ];
    with_gpus(|gpu| {
        let mut gather = setup.gather(gpu);
        for ((picture, wanted), setup) in pictures.iter().zip(setups.iter().cycle()) {
            let setup = setup.on(gpu);
            let got = synthesize(gpu, &mut gather, &setup, picture);
            let what = format!("{}, {:?}, {setup:?}", gpu.name, picture.warp);
            assert_equal(&got.rgba, wanted, 4, &what);
        }
    });
}

#[test]
fn every_format_is_taken() {
    let color = [
        TextureFormat::Rgba8Unorm,
        TextureFormat::Rgb10a2Unorm,
        TextureFormat::Rgba16Float,
        TextureFormat::Bgra8Unorm,
    ];
    let depth = [
        TextureFormat::Depth16Unorm,
        TextureFormat::Depth24Plus,
        TextureFormat::Depth24PlusStencil8,
        TextureFormat::Depth32Float,
        TextureFormat::Depth32FloatStencil8,
    ];
    let sources = [&depth[..], &[TextureFormat::R16Unorm, TextureFormat::R32Float]].concat();
    let range = DepthRange { near: 0.3, far: 100.0, convention: DepthConvention::Reversed };
    let warp = eyes([150, 41], Eye::Left, range).synthesis_views(GuardBand::Pixels(9)).unwrap().warp;
    let gl = Gl::open();
    let exact = picture(&warp, range, 70);
    let mut rounded = picture(&warp, range, 70);
    rounded.depth.iter_mut().for_each(|depth| *depth = (*depth * 65535.0).round() / 65535.0);
    let [exact, rounded] = [exact, rounded].map(|picture| (gl.run(&picture), picture));
    drop(gl);
    with_gpus(|gpu| {
        for (i, format) in sources.iter().copied().enumerate() {
            let target_depth = depth[(i + 1) % depth.len()];
            if let Some(missing) = [format, target_depth].into_iter().find(|format| !gpu.has(*format)) {
                println!("SKIPPED: {} has no {missing:?}", gpu.name);
                continue;
            }
            let (wanted, picture) = match format {
                TextureFormat::Depth16Unorm | TextureFormat::R16Unorm => &rounded,
                _ => &exact,
            };
            let setup = Setup {
                color: color[i % color.len()],
                depth: format,
                target: color[(i + 1) % color.len()],
                target_depth: Some(target_depth),
                source_margins: [[2, 2], [0, 0]],
                target_margins: [[0, 1], [1, 0]],
                ..Setup::PLAIN
            };
            let mut gather = setup.gather(gpu);
            let got = synthesize(gpu, &mut gather, &setup, picture);
            // Ten-bit formats have two bits of alpha.
            assert_equal(&got.rgba, &wanted.rgba, 3, &format!("{}, {setup:?}", gpu.name));
            let expected = expected_depth(picture, &wanted.source_map);
            let depth = got.depth.unwrap();
            let error = depth.iter().zip(&expected).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
            // A law tells depth to a sixteenth of a pixel of displacement.
            let pixels = f64::from(error) * warp.law.scale.abs();
            assert!(pixels < 1.0 / 16.0, "{}, {setup:?}: depth differs by {pixels} pixels", gpu.name);
        }
    });
}

/// sRGB is decoded, filtered and encoded by wgpu as by OpenGL.
#[test]
fn srgb_is_filtered_in_linear_light() {
    let (warp, range) = warps()[2];
    let picture = picture(&warp, range, 80);
    let gl = Gl::open();
    let (want, plain) = (gl_srgb(gl.headless.gl(), &picture), gl.run(&picture).rgba);
    drop(gl);
    assert_ne!(want, plain, "linear light makes a difference");
    with_gpus(|gpu| {
        let srgb = TextureFormat::Rgba8UnormSrgb;
        let setup = Setup { color: srgb, target: srgb, ..Setup::PLAIN };
        let got = synthesize(gpu, &mut setup.gather(gpu), &setup, &picture);
        assert_equal(&got.rgba, &want, 4, &gpu.name);
    });
}

/// Random sizes, rectangles, eyes and laws, with displacements of up to 300 pixels, for which the search skips tiles.
#[test]
fn sizes_and_rectangles_at_random() {
    let cases = random_cases();
    let warps: Vec<_> = cases.iter().map(|case| (case.warp, RANDOM_RANGE)).collect();
    let pictures = on_opengl(&Gl::open(), &warps, 3);
    with_gpus(|gpu| {
        let mut gather = Setup::PLAIN.gather(gpu);
        for ((picture, wanted), case) in pictures.iter().zip(&cases) {
            let setup = Setup {
                source_margins: case.source_margins,
                target_margins: case.target_margins,
                source_layer: case.source_layer,
                target_layer: case.target_layer,
                ..Setup::PLAIN
            };
            let got = synthesize(gpu, &mut gather, &setup.on(gpu), picture);
            let what = format!("{}, {case:?}", gpu.name);
            assert_equal(&got.rgba, wanted, 4, &what);
        }
    });
}

/// Calls of one submission do not share their uniforms, although they share the intermediate buffers.
#[test]
fn calls_of_one_submission_do_not_disturb_each_other() {
    let (near, range) = warps()[2];
    let far = Warp { law: DisparityMap { scale: 0.25 * near.law.scale, ..near.law }, ..near };
    let pictures = on_opengl(&Gl::open(), &[(near, range), (far, range)], 5);
    with_gpus(|gpu| {
        let mut gather = Setup::PLAIN.gather(gpu);
        let made = [0, 1].map(|number| {
            let picture = &pictures[number].0;
            let color = gpu.texture(Setup::PLAIN.color, picture.warp.source_size, 1);
            let depth = gpu.texture(Setup::PLAIN.depth, picture.warp.source_size, 1);
            let target = gpu.texture(Setup::PLAIN.target, picture.warp.target_size, 1);
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
                let warp = &pictures[source].0.warp;
                gather.record(&gpu.device, &gpu.queue, encoder, &source_of, warp, &target_of).unwrap();
            }
        });
        for (target, source) in [(0, 1), (1, 0)] {
            let got = gpu.read_rgba8(&made[target][2], 0);
            assert_equal(&got, &pictures[source].1, 4, &gpu.name);
        }
    });
}

/// A caller's mistake returns one error, and nothing is recorded.
#[test]
fn mistakes_are_refused() {
    with_gpus(|gpu| {
        let (warp, _) = warps()[0];
        let plain = Setup::PLAIN.options();
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
    let mut gather = Setup::PLAIN.gather(&gpu);
    let texture = |format, size| one_layer(&gpu.texture(format, size, 1), 0, TextureAspect::All);
    let [color, depth] =
        [Setup::PLAIN.color, Setup::PLAIN.depth].map(|format| texture(format, warp.source_size));
    let into = texture(Setup::PLAIN.target, warp.target_size);
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    gpu.device.destroy();
    let (source, target) = (Source::new(&color, &depth), Target::new(&into));
    let lost = gather.record(&gpu.device, &gpu.queue, &mut encoder, &source, &warp, &target);
    assert_eq!(lost, Err(WgpuError::DeviceLost));
}
