//! The passes on another graphics interface as one table of cases: each is a picture, where it lies in its images, and
//! what OpenGL draws of it.

use std::fmt::Debug;

pub use ash::vk;
use rand::{Rng, SeedableRng};

use crate::against_opengl::{
    Gl, Picture, RANDOM_RANGE, assert_equal, eyes, gl_srgb, motion_warps, picture, pose_warps, random_cases,
    warps,
};
use crate::harness::largest;
use crate::posed;
use yoro::eyes::{DepthConvention, DepthRange, Eye, GuardBand, MotionWarp, PoseWarp, Warp};
use yoro::synthesis::SourceMapEntry;
use yoro::synthesis::backend::WarpKind;

/// Where a picture lies in its images, and what these are. Formats have Vulkan's names.
#[derive(Clone, Copy, Debug)]
pub struct Setup {
    pub color: vk::Format,
    pub depth: vk::Format,
    pub target: vk::Format,
    pub target_depth: Option<vk::Format>,
    /// Margins before the upper left and after the lower right corners.
    pub source_margins: [[u32; 2]; 2],
    pub target_margins: [[u32; 2]; 2],
    /// The layer that is used. It is the last one of its images.
    pub source_layer: u32,
    pub target_layer: u32,
    /// How the images are used before and after, as a device numbers it: 0 to 3.
    pub uses: usize,
    /// True if the pipeline is shared with cases of other sizes.
    pub shared: bool,
}

impl Setup {
    pub const PLAIN: Setup = Setup {
        color: vk::Format::R8G8B8A8_UNORM,
        depth: vk::Format::R32_SFLOAT,
        target: vk::Format::R8G8B8A8_UNORM,
        target_depth: None,
        source_margins: [[0; 2]; 2],
        target_margins: [[0; 2]; 2],
        source_layer: 0,
        target_layer: 0,
        uses: 0,
        shared: false,
    };
    const WITH_DEPTH: Setup = Setup { target_depth: Some(vk::Format::D32_SFLOAT), ..Setup::PLAIN };

    /// Returns the corner of the source and that of the target in their images.
    pub fn origins(&self) -> [[u32; 2]; 2] {
        [self.source_margins[0], self.target_margins[0]]
    }

    /// Returns the sizes of the images of source and target.
    pub fn image_sizes(&self, warp: &impl WarpKind) -> [[u32; 2]; 2] {
        let [source, target] = warp.sizes();
        let sum = |[a, b]: [[u32; 2]; 2], size: [u32; 2]| [0, 1].map(|i| a[i] + size[i] + b[i]);
        [sum(self.source_margins, source), sum(self.target_margins, target)]
    }
}

/// A picture, and what must be drawn of it.
pub struct Case<W> {
    setup: Setup,
    picture: Picture<W>,
    rgba: Vec<u8>,
    depth: Option<Expected>,
}

/// The expected depth.
struct Expected {
    values: Vec<f32>,
    tolerance: f32,
    /// How many pixels may differ by more, whose positions lie within rounding of a decision.
    exceptions: usize,
}

/// What a rendered or synthesized image is for.
#[derive(Clone, Copy, Debug)]
pub enum Role {
    Color,
    Depth,
    Target,
    TargetDepth,
}

/// The images of a synthesis.
pub struct Images<I> {
    pub color: I,
    pub depth: I,
    pub target: I,
    pub target_depth: Option<I>,
}

/// A device whose passes are compared with OpenGL's.
pub trait Device {
    type Image;
    type Pipeline<W: WarpKind>;

    fn name(&self) -> String;
    /// True if images of this format can be used.
    fn has(&self, format: vk::Format) -> bool;
    /// True if a layer of an array can be a source.
    fn samples_layers(&self) -> bool;
    fn image(&self, format: vk::Format, size: [u32; 2], layers: u32) -> Self::Image;
    /// Fills a layer, with rows from the bottom, and leaves it as a synthesis finds it.
    fn upload_rgba8(&self, image: &Self::Image, layer: u32, rgba: &[u8], role: Role, setup: &Setup);
    fn upload_depth(&self, image: &Self::Image, layer: u32, depth: &[f32], role: Role, setup: &Setup);
    /// Reads a layer of a target, before or after a synthesis.
    fn read_rgba8(&self, image: &Self::Image, layer: u32, before: Option<&Setup>) -> Vec<u8>;
    fn read_depth(&self, image: &Self::Image, layer: u32, before: Option<&Setup>) -> Vec<f32>;
    /// Makes a pipeline for sources and targets of up to these sizes.
    fn pipeline<W: WarpKind>(&self, setup: &Setup, sizes: [[u32; 2]; 2]) -> Self::Pipeline<W>;
    fn draw<W: WarpKind>(
        &self,
        pipeline: &mut Self::Pipeline<W>,
        setup: &Setup,
        images: &Images<Self::Image>,
        warp: &W,
    );
}

/// Draws all cases on a device, and compares them with what OpenGL has drawn.
pub fn check<D: Device, W: WarpKind + Debug>(device: &D, cases: &[Case<W>]) {
    let of = |case: &Case<W>| case.picture.warp;
    let sizes = largest(&cases.iter().filter(|case| case.setup.shared).map(of).collect::<Vec<_>>());
    let mut shared = None;
    for Case { setup, picture, rgba, depth } in cases {
        let mut setup = *setup;
        if !device.samples_layers() {
            setup.source_layer = 0;
            // Depth is sampled to read it back.
            setup.target_layer *= u32::from(setup.target_depth.is_none());
        }
        let formats = [Some(setup.depth), setup.target_depth];
        if let Some(missing) = formats.into_iter().flatten().find(|format| !device.has(*format)) {
            println!("SKIPPED: {} has no {missing:?}", device.name());
            continue;
        }
        let mut own;
        let pipeline = match setup.shared {
            true => shared.get_or_insert_with(|| device.pipeline::<W>(&setup, sizes)),
            false => {
                own = device.pipeline::<W>(&setup, picture.warp.sizes());
                &mut own
            }
        };
        let got = synthesize(device, pipeline, &setup, picture);
        let what = format!("{}, {:?}, {setup:?}", device.name(), picture.warp);
        // Formats with ten bits have only two of alpha.
        let has_alpha = |format| format != vk::Format::A2B10G10R10_UNORM_PACK32;
        let channels = if has_alpha(setup.color) && has_alpha(setup.target) { 4 } else { 3 };
        assert_equal(&got.0, rgba, channels, &what);
        if let (Some(got), Some(Expected { values, tolerance, exceptions })) = (got.1, depth) {
            let is_near = |a: f32, b: f32| (a - b).abs() <= *tolerance;
            let different = got.iter().zip(values).filter(|(a, b)| !is_near(**a, **b)).count();
            assert!(different <= *exceptions, "{what}: depth of {different} of {} pixels differs", got.len());
        }
    }
}

/// Synthesizes a picture in images that hold other data around it, which must not be read, and must stay. Returns colour
/// and depth.
pub fn synthesize<D: Device, W: WarpKind>(
    device: &D,
    pipeline: &mut D::Pipeline<W>,
    setup: &Setup,
    picture: &Picture<W>,
) -> (Vec<u8>, Option<Vec<f32>>) {
    let warp = &picture.warp;
    let [source_image, target_image] = setup.image_sizes(warp);
    let [source_origin, target_origin] = setup.origins();
    let [width, target_width] = warp.sizes().map(|size| size[0] as usize);
    let mut rng = rand_pcg::Pcg32::seed_from_u64(99);
    let pixels = |size: [u32; 2]| 0..size[0] * size[1];
    let mut junk = |size| -> (Vec<u8>, Vec<f32>) {
        let rgba = pixels(size).flat_map(|_| rng.random::<[u8; 4]>()).collect();
        (rgba, pixels(size).map(|_| rng.random_range(0.0..=1.0)).collect())
    };
    let ((rgba, depth), (target_rgba, target_depth)) = (junk(source_image), junk(target_image));
    let images = Images {
        color: device.image(setup.color, source_image, setup.source_layer + 1),
        depth: device.image(setup.depth, source_image, setup.source_layer + 1),
        target: device.image(setup.target, target_image, setup.target_layer + 1),
        target_depth: setup
            .target_depth
            .map(|format| device.image(format, target_image, setup.target_layer + 1)),
    };
    for layer in 0..=setup.source_layer {
        let (mut rgba, mut depth) = (rgba.clone(), depth.clone());
        if layer == setup.source_layer {
            rgba = pasted(rgba, source_image, source_origin, &picture.rgba, width);
            depth = pasted(depth, source_image, source_origin, &picture.depth, width);
        }
        device.upload_rgba8(&images.color, layer, &rgba, Role::Color, setup);
        device.upload_depth(&images.depth, layer, &depth, Role::Depth, setup);
    }
    for layer in 0..=setup.target_layer {
        device.upload_rgba8(&images.target, layer, &target_rgba, Role::Target, setup);
        let of_depth = images.target_depth.iter();
        of_depth.for_each(|i| device.upload_depth(i, layer, &target_depth, Role::TargetDepth, setup));
    }
    // Read back, after conversions between formats.
    let layer = setup.target_layer;
    let before = device.read_rgba8(&images.target, layer, Some(setup));
    let depth_before = images.target_depth.as_ref().map(|i| device.read_depth(i, layer, Some(setup)));
    device.draw(pipeline, setup, &images, warp);
    let after = device.read_rgba8(&images.target, layer, None);
    let rgba = cut(&after, target_image, target_origin, warp.sizes()[1], 4);
    let outside = pasted(before, target_image, target_origin, &rgba, target_width);
    assert!(outside == after, "pixels outside of the target's rectangle have changed: {setup:?}");
    let depth = images.target_depth.as_ref().zip(depth_before).map(|(image, before)| {
        let after = device.read_depth(image, layer, None);
        let depth = cut(&after, target_image, target_origin, warp.sizes()[1], 1);
        let outside = pasted(before, target_image, target_origin, &depth, target_width);
        assert!(outside == after, "depth outside of the target's rectangle has changed: {setup:?}");
        depth
    });
    (rgba, depth)
}

/// Returns a rectangle of an image, at a place counted from the top. All rows run from the bottom.
pub fn cut<T: Copy>(all: &[T], image: [u32; 2], origin: [u32; 2], size: [u32; 2], channels: usize) -> Vec<T> {
    let [w, h] = image.map(|n| n as usize);
    let bottom = h - (origin[1] + size[1]) as usize;
    let row =
        |y: usize| &all[((bottom + y) * w + origin[0] as usize) * channels..][..size[0] as usize * channels];
    (0..size[1] as usize).flat_map(row).copied().collect()
}

/// Returns `all` with a rectangle of it replaced; places are counted as in [`cut`].
fn pasted<T: Copy>(mut all: Vec<T>, image: [u32; 2], origin: [u32; 2], part: &[T], width: usize) -> Vec<T> {
    let [w, h] = image.map(|n| n as usize);
    let channels = all.len() / (w * h);
    let rows = part.chunks_exact(width * channels);
    let bottom = h - origin[1] as usize - rows.len();
    for (y, row) in rows.enumerate() {
        all[((bottom + y) * w + origin[0] as usize) * channels..][..row.len()].copy_from_slice(row);
    }
    all
}

/// Parts of larger images and layers of arrays, in all uses, with one pipeline for all sizes.
fn parts() -> [Setup; 4] {
    let setup = Setup { depth: vk::Format::D32_SFLOAT, target_layer: 1, shared: true, ..Setup::PLAIN };
    [
        Setup { source_layer: 1, source_margins: [[5, 3], [2, 7]], ..setup },
        Setup { target_margins: [[4, 9], [1, 2]], uses: 1, ..setup },
        Setup { source_margins: [[0, 2], [3, 0]], target_margins: [[1, 0], [0, 5]], uses: 2, ..setup },
        Setup { source_margins: [[1, 1], [1, 1]], target_layer: 0, uses: 3, ..setup },
    ]
}

/// Returns the cases of parallel eyes: both eyes in all depth ranges, parts and layers, all formats, linear light, and
/// sizes, rectangles and laws at random.
pub fn gather_cases(gl: &Gl) -> Vec<Case<Warp>> {
    let of = |setup, picture: Picture| Case { setup, rgba: gl.run(&picture).rgba, picture, depth: None };
    let mut cases = Vec::new();
    for ((warp, range), seed) in warps().iter().zip(0..) {
        cases.push(of(Setup::PLAIN, picture(warp, *range, seed)));
        cases.push(of(parts()[seed as usize % 4], picture(warp, *range, 50 + seed)));
    }
    for (case, seed) in random_cases().into_iter().zip(3..) {
        let setup = Setup {
            source_margins: case.source_margins,
            target_margins: case.target_margins,
            source_layer: case.source_layer,
            target_layer: case.target_layer,
            shared: true,
            ..Setup::PLAIN
        };
        cases.push(of(setup, picture(&case.warp, RANDOM_RANGE, seed)));
    }
    let (warp, range) = warps()[2];
    let srgb = vk::Format::R8G8B8A8_SRGB;
    let mut linear = of(Setup { color: srgb, target: srgb, ..Setup::PLAIN }, picture(&warp, range, 80));
    let rgba = gl_srgb(gl.headless.gl(), &linear.picture);
    assert_ne!(rgba, linear.rgba, "linear light makes a difference");
    linear.rgba = rgba;
    cases.push(linear);
    cases.extend(format_cases(gl));
    cases
}

fn format_cases(gl: &Gl) -> impl Iterator<Item = Case<Warp>> {
    let color = [
        vk::Format::R8G8B8A8_UNORM,
        vk::Format::A2B10G10R10_UNORM_PACK32,
        vk::Format::R16G16B16A16_SFLOAT,
        vk::Format::B8G8R8A8_UNORM,
    ];
    let depth = [
        vk::Format::D16_UNORM,
        vk::Format::X8_D24_UNORM_PACK32,
        vk::Format::D24_UNORM_S8_UINT,
        vk::Format::D32_SFLOAT,
        vk::Format::D32_SFLOAT_S8_UINT,
    ];
    let range = DepthRange { near: 0.3, far: 100.0, convention: DepthConvention::Reversed };
    let warp = eyes([150, 41], Eye::Left, range).synthesis_views(GuardBand::Pixels(9)).unwrap().warp;
    let sources = [&depth[..], &[vk::Format::R16_UNORM, vk::Format::R32_SFLOAT]].concat();
    sources.into_iter().enumerate().map(move |(i, format)| {
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
        let want = gl.run(&picture);
        let values = expected_depth(&picture, &want.source_map);
        // A law tells depth to a sixteenth of a pixel of displacement.
        let tolerance = (1.0 / 16.0 / warp.law.scale.abs()) as f32;
        let depth = Some(Expected { values, tolerance, exceptions: 0 });
        Case { setup, rgba: want.rgba, picture, depth }
    })
}

/// Returns the expected depth of a target, from the columns that OpenGL has written.
fn expected_depth(picture: &Picture, source_map: &[u32]) -> Vec<f32> {
    let warp = &picture.warp;
    let [width, height] = warp.source_size.map(|n| n as i32);
    let entries = source_map.iter().enumerate().map(|(i, entry)| {
        let (x, y) = (i as u32 % warp.target_size[0], i as u32 / warp.target_size[0]);
        let column = SourceMapEntry::decode(*entry, x, warp).column;
        let row = (y as i32 - warp.row_offset).clamp(0, height - 1);
        let at = |column: f32| picture.depth[(row * width + (column as i32).clamp(0, width - 1)) as usize];
        let t = column.fract();
        at(column.floor()) * (1.0 - t) + at(column.floor() + 1.0) * t
    });
    entries.collect()
}

fn posed_case<W>(setup: Setup, picture: Picture<W>, want: posed::Image) -> Case<W> {
    let exceptions = want.depth.len() / 4000;
    let depth = Some(Expected { values: want.depth, tolerance: 4e-5, exceptions });
    Case { setup, picture, rgba: want.rgba, depth }
}

/// Returns the cases of views at any pose: whole images, parts of larger ones and layers of arrays.
pub fn any_view_cases(gl: &Gl) -> Vec<Case<PoseWarp>> {
    let of_parts = parts().map(|setup| Setup { target_depth: Some(vk::Format::D16_UNORM), ..setup });
    let setups = [Setup::WITH_DEPTH, of_parts[0], of_parts[2]];
    let numbered = pose_warps().into_iter().zip(0..);
    let cases = numbered.flat_map(|((warp, range), seed)| {
        setups.map(|setup| {
            let picture = picture(&warp, range, seed);
            let want = gl.any_view(&picture);
            posed_case(setup, picture, want)
        })
    });
    cases.collect()
}

/// Returns the cases of motion vectors.
pub fn motion_cases(gl: &Gl) -> Vec<Case<MotionWarp>> {
    let numbered = motion_warps().into_iter().zip(90..);
    let cases = numbered.map(|((warp, range), seed)| {
        let picture = picture(&warp, range, seed);
        let want = gl.motion(&picture);
        posed_case(Setup::WITH_DEPTH, picture, want)
    });
    cases.collect()
}
