//! Motion vectors through synthesis: the law in f64, and what must hold for surfaces that stand still.

use std::rc::Rc;

use glam::{DMat4, DVec3, Quat, Vec3};
use rand::{Rng, SeedableRng};

use super::OUTPUTS;
use super::laws::{on_every_backend, pair, scene as colored};
use yoro::eyes::{
    DepthConvention, DepthRange, Eye, EyePair, EyesError, Frustum, GuardBand, MotionWarp, Ndc, Pose,
    SynthesisViews, VectorSpace, VectorsOf, View, Warp,
};
use yoro::opengl::{Context, Destination, Motion, Options, Outputs, Source};
use yoro::synthesis::{SOURCE_MAP_HOLE, SourceMapEntry};
use yoro_gl::{Filter, Format, Program, RenderTarget, ShaderSource, Texture};

/// Returns a picture whose surfaces are all between the planes.
fn scene(size: [u32; 2], range: DepthRange, seed: u64) -> (Vec<u8>, Vec<f32>) {
    let (rgba, depth) = colored(size, range, seed);
    (rgba, depth.into_iter().map(|depth| depth.clamp(0.0, 1.0)).collect())
}

/// An eye's vectors and what else the passes write. Rows run from the bottom.
struct Vectors {
    vectors: Vec<[f32; 4]>,
    depth: Vec<f32>,
    map: Vec<u32>,
}

fn floats(gl: &Rc<Context>, size: [u32; 2], format: Format, values: impl Iterator<Item = f32>) -> Texture {
    let texture = Texture::new(gl, size, format, Filter::Nearest).unwrap();
    texture.upload(&values.flat_map(f32::to_ne_bytes).collect::<Vec<_>>());
    texture
}

/// Runs the pipeline on vectors in memory, at full precision unless `format` is that of half floats.
fn run(
    gl: &Rc<Context>,
    vectors: &[[f32; 4]],
    depth: &[f32],
    motion: &MotionWarp,
    format: Format,
) -> Vectors {
    let Warp { source_size, target_size, .. } = motion.warp;
    let color = floats(gl, source_size, Format::Rgba32F, vectors.iter().flatten().copied());
    let depth = floats(gl, source_size, Format::R32F, depth.iter().copied());
    let formats = [(format, Filter::Nearest), (Format::R32Ui, Filter::Nearest)];
    let target = RenderTarget::new(gl, target_size, &formats, Some(Format::Depth32F)).unwrap();
    let outputs = Outputs { depth: true, ..OUTPUTS };
    let mut passes = Motion::new(gl, &Options::default(), outputs).unwrap();
    let source = Source::new(color.raw(), depth.raw());
    passes.synthesize(source, motion, &Destination::whole(&target)).unwrap();
    let copy = RenderTarget::new(gl, target_size, &[(Format::Rgba32F, Filter::Nearest)], None).unwrap();
    let program = Program::new(gl, ShaderSource::Screen("render/depth_copy.frag"), &[]).unwrap();
    copy.overwrite();
    program.bind().texture("source", 0, target.depth().raw());
    gl.draw_screen();
    Vectors {
        vectors: target.read_rgba32f(0, [0, 0], target_size),
        depth: copy.read_rgba32f(0, [0, 0], target_size).into_iter().map(|texel| texel[0]).collect(),
        map: target.read_u32(1, [0, 0], target_size),
    }
}

const SPACES: [VectorSpace; 4] = [
    VectorSpace { ndc: Ndc::ZeroToOne, of: VectorsOf::Source },
    VectorSpace { ndc: Ndc::MinusOneToOne, of: VectorsOf::Eye },
    VectorSpace { ndc: Ndc::ZeroToOne, of: VectorsOf::Eye },
    VectorSpace { ndc: Ndc::MinusOneToOne, of: VectorsOf::Source },
];

/// A head's two frames: where it was, and where it is.
struct Frames {
    then: EyePair,
    now: EyePair,
    guard: GuardBand,
}

impl Frames {
    /// Frames with asymmetric frusta, in which everything may change: poses and, with `eyes`, distance and frusta.
    fn new(dominant: Eye, convention: DepthConvention, eyes: bool, guard: GuardBand) -> Frames {
        let depth = DepthRange { near: 0.25, far: 60.0, convention };
        let frusta = [
            Frustum { left: -1.15, right: 0.85, bottom: -0.8, top: 0.7 },
            Frustum { left: -0.85, right: 1.15, bottom: -0.8, top: 0.7 },
        ];
        let head = Pose { position: Vec3::new(0.3, 1.6, -2.0), orientation: Quat::from_rotation_y(0.2) };
        let size = [200, 150];
        let then = EyePair { frusta, ..EyePair::parallel(head, frusta[0], 0.063, depth, size, dominant) };
        let turn = Quat::from_euler(glam::EulerRot::YXZ, 0.03, -0.02, 0.01);
        let moved = Pose {
            position: head.position + Vec3::new(0.02, -0.01, -0.05),
            orientation: head.orientation * turn,
        };
        let ipd = if eyes { 0.068 } else { 0.063 };
        let mut now = EyePair { frusta, ..EyePair::parallel(moved, frusta[0], ipd, depth, size, dominant) };
        if eyes {
            // Both frusta by other ways, as those of an inset that follows a gaze, but as far apart as before.
            for (frustum, by) in now.frusta.iter_mut().zip([0.04, 0.04]) {
                (frustum.left, frustum.right) = (frustum.left + by, frustum.right + by);
            }
            now.depth.near = 0.3;
        }
        Frames { then, now, guard }
    }

    fn views(&self) -> [SynthesisViews; 2] {
        [&self.now, &self.then].map(|pair| pair.synthesis_views(self.guard).unwrap())
    }
}

/// Returns the matrix from the world to NDC, before the division.
fn to_clip(view: &View, ndc: Ndc) -> DMat4 {
    let projection = match ndc {
        Ndc::ZeroToOne => view.wgpu_projection(),
        Ndc::MinusOneToOne => view.projection(),
    };
    projection.as_dmat4() * view.pose.view_matrix().as_dmat4()
}

/// Returns the vector of a still surface that a view shows at a pixel with this depth, from depth and poses alone.
fn still_vector(now: &View, then: &View, ndc: Ndc, [x, y]: [f64; 2], depth: f64) -> DVec3 {
    let place = |size: u32, at: f64| 2.0 * (at + 0.5) / f64::from(size) - 1.0;
    let z = if ndc == Ndc::ZeroToOne { depth } else { 2.0 * depth - 1.0 };
    let here = DVec3::new(place(now.size[0], x), place(now.size[1], y), z);
    let world = to_clip(now, ndc).inverse().project_point3(here);
    here - to_clip(then, ndc).project_point3(world)
}

/// The views in whose NDC the source's vectors are given.
fn reference_views(frames: &Frames, of: VectorsOf) -> [View; 2] {
    let [now, then] = frames.views();
    match of {
        VectorsOf::Source => [now.source, then.source],
        VectorsOf::Eye => [&frames.now, &frames.then].map(|pair| pair.view(pair.dominant)),
    }
}

/// Returns vectors of the source, all of whose surfaces stand still in the world.
fn still_vectors(frames: &Frames, space: VectorSpace, depth: &[f32]) -> Vec<[f32; 4]> {
    let views = frames.views()[0];
    let crop = match space.of {
        VectorsOf::Source => [0.0; 2],
        VectorsOf::Eye => views.dominant_crop.map(f64::from),
    };
    let [now, then] = reference_views(frames, space.of);
    let width = views.source.size[0] as usize;
    let vector = |(i, depth): (usize, &f32)| {
        let at = [(i % width) as f64 - crop[0], (i / width) as f64 - crop[1]];
        still_vector(&now, &then, space.ndc, at, f64::from(*depth)).as_vec3().extend(0.5).to_array()
    };
    depth.iter().enumerate().map(vector).collect()
}

fn cases() -> impl Iterator<Item = (Frames, VectorSpace)> {
    (0..16).map(|i| {
        let space = SPACES[i % 4];
        let convention = [DepthConvention::Standard, DepthConvention::Reversed][i / 4 % 2];
        let frames = Frames::new(Eye::BOTH[i / 2 % 2], convention, i >= 8, GuardBand::Pixels(18));
        (frames, space)
    })
}

/// Random vectors: each pixel has that of its source column, where the same pipeline for colours finds it, after the law.
#[test]
fn vectors_are_those_of_the_surface_that_is_seen() {
    on_every_backend(|gl| {
        for (seed, (frames, space)) in cases().enumerate() {
            let [now, then] = frames.views();
            let motion = now.motion(&then, space).unwrap();
            let (rgba, depth) = scene(now.source.size, now.source.depth, seed as u64);
            let mut rng = rand_pcg::Pcg32::seed_from_u64(seed as u64);
            let vectors: Vec<[f32; 4]> =
                depth.iter().map(|_| std::array::from_fn(|_| rng.random_range(-0.5..0.5))).collect();
            let got = run(gl, &vectors, &depth, &motion, Format::Rgba32F);
            assert_eq!(got.map, super::subject().in_memory(gl).run(&rgba, &depth, &now.warp).source_map);
            let [width, height] = now.target.size.map(|n| n as usize);
            let mut holes = 0;
            for i in 0..width * height {
                let entry = SourceMapEntry::decode(got.map[i], (i % width) as u32, &now.warp);
                let row = (i / width) as i32 - now.warp.row_offset;
                let source_width = now.source.size[0] as usize;
                let row = &vectors[row as usize * source_width..][..source_width];
                let (low, t) = (entry.column.floor() as usize, f64::from(entry.column.fract()));
                let seen: [f64; 3] = std::array::from_fn(|c| {
                    let at = |x: usize| f64::from(row[x.min(source_width - 1)][c]);
                    at(low) * (1.0 - t) + at(low + 1) * t
                });
                let want = motion.vector(seen, f64::from(got.depth[i]));
                holes += usize::from(entry.hole);
                for c in 0..3 {
                    // Filters have 8 bits of fraction.
                    let off = (f64::from(got.vectors[i][c]) - want[c]).abs();
                    assert!(off < 6e-3, "case {seed}, pixel {i}: {:?} for {want:?}", got.vectors[i]);
                }
            }
            assert!(holes > 100, "case {seed}: {holes} holes");
        }
    });
}

/// Head motion alone: outside holes, the other eye's vectors are those of its own depth and poses, to a hundredth of a
/// pixel in half floats, whatever else changes between the frames.
#[test]
fn vectors_of_what_stands_still_follow_from_depth_and_poses() {
    on_every_backend(|gl| {
        for (n, (frames, space)) in cases().enumerate() {
            let [now, then] = frames.views();
            let own = now.own_motion(&then, space).unwrap();
            let other = now.motion(&then, space).unwrap();
            let (_, depth) = scene(now.source.size, now.source.depth, 40 + n as u64);
            let vectors = still_vectors(&frames, space, &depth);
            let eyes = [frames.now.dominant.other(), frames.now.dominant];
            for (eye, motion) in eyes.into_iter().zip([other, own]) {
                let got = run(gl, &vectors, &depth, &motion, Format::Rgba16F);
                let [now, then] = [&frames.now, &frames.then].map(|pair| pair.view(eye));
                let [width, height] = now.size.map(|n| n as usize);
                let (mut squares, mut seen) = ([0.0; 3], 0);
                for i in (0..width * height).filter(|i| got.map[*i] & SOURCE_MAP_HOLE == 0) {
                    let at = [(i % width) as f64, (i / width) as f64];
                    let want = still_vector(&now, &then, space.ndc, at, f64::from(got.depth[i]));
                    let off = (DVec3::from(std::array::from_fn(|c| f64::from(got.vectors[i][c]))) - want)
                        .to_array();
                    // The middle of a silhouette lies up to half a pixel beside the pixel's.
                    if (0..2).all(|c| off[c].abs() * 100.0 < 0.5) {
                        squares = std::array::from_fn(|c| squares[c] + off[c].powi(2));
                        seen += 1;
                    }
                }
                assert!(seen * 100 > width * height * 90, "case {n}, {eye:?}: {seen}");
                let rms = squares.map(|sum| (sum / seen as f64).sqrt() * 100.0);
                assert!(rms[0] < 0.02 && rms[1] < 0.02, "case {n}, {eye:?}: {rms:?} pixels");
                // Half floats round vectors of more than half by 1.4e-4.
                assert!(rms[2] < 0.02, "case {n}, {eye:?}: {} of z", rms[2] / 100.0);
            }
        }
    });
}

/// Nothing moves, neither head nor scene: all vectors are zero. Eyes in one place: the vectors are the source's.
#[test]
fn still_frames_and_eyes_in_one_place_change_nothing() {
    on_every_backend(|gl| {
        for (n, space) in SPACES.into_iter().enumerate() {
            let eyes = pair([96, 33], Eye::BOTH[n % 2], 0.063, DepthConvention::Standard);
            let views = eyes.synthesis_views(GuardBand::Pixels(5)).unwrap();
            let (rgba, depth) = scene(views.source.size, eyes.depth, 9);
            let motion = views.motion(&views, space).unwrap();
            let still = run(gl, &vec![[0.0; 4]; depth.len()], &depth, &motion, Format::Rgba16F);
            assert!(still.vectors.iter().flatten().all(|n| *n == 0.0), "{space:?}");

            let space = VectorSpace { of: VectorsOf::Eye, ..space };
            let eyes = EyePair { poses: [eyes.poses[0]; 2], ..eyes };
            let views = eyes.synthesis_views(GuardBand::Pixels(5)).unwrap();
            let motion = views.motion(&views, space).unwrap();
            let vectors: Vec<[f32; 4]> =
                rgba.chunks(4).map(|p| std::array::from_fn(|c| f32::from(p[c]) / 256.0 - 0.5)).collect();
            let got = run(gl, &vectors, &depth, &motion, Format::Rgba32F).vectors;
            for (y, row) in got.chunks(96).enumerate() {
                let first = y * 101 + views.dominant_crop[0] as usize;
                for (got, want) in row.iter().zip(&vectors[first..]) {
                    // Between neighbours at random, a pixel's place is off by less than 1e-4 pixels.
                    assert!((0..3).all(|c| (got[c] - want[c]).abs() < 1e-4), "{got:?} for {want:?}");
                }
            }
        }
    });
}

/// A square that moves past a still wall: what it uncovers in the other eye moves with the wall, and no vector lies between.
#[test]
fn a_hole_moves_with_its_background() {
    on_every_backend(|gl| {
        for dominant in Eye::BOTH {
            let eyes = pair([160, 40], dominant, 0.063, DepthConvention::Standard);
            let views = eyes.synthesis_views(GuardBand::None).unwrap();
            let motion = views.motion(&views, SPACES[2]).unwrap();
            let square = |i: usize| (60..100).contains(&(i % 160)) && (10..30).contains(&(i / 160));
            let pick = |i: usize, a: f32, b: f32| if square(i) { a } else { b };
            let depth: Vec<f32> = (0..160 * 40).map(|i| eyes.depth.depth(pick(i, 0.6, 8.0))).collect();
            let [near, far] = [[0.25, 0.125, 0.03125, 1.0], [-0.0625, 0.0, 0.0, 1.0]];
            let vectors: Vec<[f32; 4]> = (0..160 * 40).map(|i| if square(i) { near } else { far }).collect();
            let got = run(gl, &vectors, &depth, &motion, Format::Rgba32F);
            let carried = |v: [f32; 4]| motion.vector([v[0], v[1], v[2]].map(f64::from), 0.0)[0] as f32;
            let mut holes = 0;
            for (vector, map) in got.vectors.iter().zip(&got.map) {
                let is =
                    |v: [f32; 4]| (vector[0] - carried(v)).abs() < 1e-5 && (vector[1] - v[1]).abs() < 1e-5;
                assert!(is(near) || is(far), "{dominant:?}: {vector:?}");
                if map & SOURCE_MAP_HOLE != 0 {
                    holes += 1;
                    assert!(is(far), "{dominant:?}: {vector:?}");
                }
            }
            assert!(holes >= 20 && carried(near) != near[0], "{holes}");
        }
    });
}

#[test]
fn frames_without_a_common_law_are_refused() {
    let frames = Frames::new(Eye::Left, DepthConvention::Reversed, false, GuardBand::Pixels(18));
    let [now, then] = frames.views();
    let refused = |then: &SynthesisViews, space| match now.motion(then, space) {
        Err(EyesError::OtherFrame { what }) => what,
        other => panic!("{other:?}"),
    };
    let wider = frames.then.synthesis_views(GuardBand::Pixels(30)).unwrap();
    assert_eq!(refused(&wider, SPACES[0]), "the width of the guard band");
    assert!(now.motion(&wider, SPACES[2]).is_ok());
    let other = EyePair { dominant: Eye::Right, ..frames.then }.synthesis_views(frames.guard).unwrap();
    assert_eq!(refused(&other, SPACES[2]), "the rendered eye");
    let mut raised = frames.then;
    let row = raised.frusta[0].height() / 150.0;
    (raised.frusta[0].bottom, raised.frusta[0].top) = (-0.8 + 2.0 * row, 0.7 + 2.0 * row);
    let raised = raised.synthesis_views(frames.guard).unwrap();
    assert_eq!(refused(&raised, SPACES[2]), "the rows of one eye against the other's");
    let [x, y] = then.motion_scale();
    assert_eq!([x, y], [then.source.size[0] as f32 / 200.0, 1.0]);
    assert!(x > 1.1);
}
