//! A rendered view a little later: against places in space, and what must stay as it is.

use std::rc::Rc;

use glam::{DMat4, DVec2, DVec3, Quat, Vec3, Vec4};

use super::laws::on_every_backend;
use yoro::eyes::{DepthConvention, DepthRange, Extrapolation, Frustum, Ndc, Pose, View};
use yoro::opengl::{Context, Extrapolator, Options, Source};
use yoro_gl::{Filter, Format, Program, RenderTarget, ShaderSource, Texture};

/// A square that moves in front of a wall, seen by a head that moves.
struct Scenery {
    now: View,
    then: View,
    /// Metres by which the square has moved.
    step: DVec3,
}

const SIZE: [u32; 2] = [200, 150];
/// The square's middle now, and half its side.
const MIDDLE: DVec3 = DVec3::new(0.1, 0.05, -1.5);
const HALF: f64 = 0.35;
/// Distance of the wall from the head's first place.
const WALL: f64 = -6.0;

impl Scenery {
    fn new(convention: DepthConvention, step: DVec3) -> Scenery {
        let depth = DepthRange { near: 0.2, far: 60.0, convention };
        let frustum = Frustum { left: -0.8, right: 0.7, bottom: -0.6, top: 0.5 };
        let now = View { pose: Pose::IDENTITY, frustum, depth, size: SIZE };
        let position = Vec3::new(-0.02, 0.01, 0.04);
        let pose = Pose { position, orientation: Quat::from_euler(glam::EulerRot::YXZ, 0.02, 0.01, 0.0) };
        let then = View { pose, ..now };
        Scenery { now, then, step }
    }

    /// Returns what a pixel's middle shows when the square has gone on by a part of its step: the place in space, and true
    /// if it is the square's.
    fn seen(&self, [x, y]: [usize; 2], ahead: f64) -> (DVec3, bool) {
        let f = &self.now.frustum;
        let at = [(x, f.left, f.width(), SIZE[0]), (y, f.bottom, f.height(), SIZE[1])]
            .map(|(i, low, extent, n)| f64::from(low) + f64::from(extent) * (i as f64 + 0.5) / f64::from(n));
        let ray = DVec3::new(at[0], at[1], -1.0);
        let middle = MIDDLE + self.step * ahead;
        let on_square = ray * -middle.z;
        let from = (on_square - middle).truncate().abs();
        if from.max_element() <= HALF { (on_square, true) } else { (ray * -WALL, false) }
    }

    fn to_clip(view: &View, ndc: Ndc) -> DMat4 {
        let projection = match ndc {
            Ndc::ZeroToOne => view.wgpu_projection(),
            Ndc::MinusOneToOne => view.projection(),
        };
        projection.as_dmat4() * view.pose.view_matrix().as_dmat4()
    }

    /// Returns colours that tell the place on a surface, in RG, and the surface, in B.
    fn color(place: DVec3, square: bool) -> [f64; 3] {
        let at = if square { (place - MIDDLE).truncate() / HALF } else { place.truncate() / 6.0 };
        let at: DVec2 = at * 0.4 + 0.5;
        [at.x, at.y, if square { 1.0 } else { 0.0 }]
    }
}

/// Colour and depth of the view, later.
struct Later {
    rgba: Vec<u8>,
    depth: Vec<f32>,
}

fn texture(gl: &Rc<Context>, format: Format, bytes: &[u8]) -> Texture {
    let texture = Texture::new(gl, SIZE, format, Filter::Nearest).unwrap();
    texture.upload(bytes);
    texture
}

fn run(gl: &Rc<Context>, rgba: &[u8], depth: &[f32], vectors: &[[f32; 4]], step: &Extrapolation) -> Later {
    let floats = |values: &[f32]| values.iter().flat_map(|n| n.to_ne_bytes()).collect::<Vec<_>>();
    let color = texture(gl, Format::Rgba8, rgba);
    let depth = texture(gl, Format::R32F, &floats(depth));
    let vectors = texture(gl, Format::Rgba32F, &floats(vectors.as_flattened()));
    let mut passes = Extrapolator::new(gl, &Options::default()).unwrap();
    let source = Source::new(color.raw(), depth.raw());
    let later = passes.extrapolate(source, (vectors.raw(), SIZE), step).unwrap();
    let copy = |file, name, texture, format| {
        let target = RenderTarget::new(gl, SIZE, &[(format, Filter::Nearest)], None).unwrap();
        let program = Program::new(gl, ShaderSource::Screen(file), &[]).unwrap();
        target.overwrite();
        let whole = Vec4::new(0.0, 0.0, SIZE[0] as f32, SIZE[1] as f32);
        program.bind().texture(name, 0, texture).set("rectangle", whole);
        gl.draw_screen();
        target
    };
    let colors = copy("viewer/show.frag", "first", later.color, Format::Rgba8);
    let depths = copy("render/depth_copy.frag", "depth_map", later.depth, Format::Rgba32F);
    Later {
        rgba: colors.read_rgba8(0, [0, 0], SIZE),
        depth: depths.read_rgba32f(0, [0, 0], SIZE).into_iter().map(|texel| texel[0]).collect(),
    }
}

/// Draws the present of a scenery, with its vectors in half floats' precision.
fn drawn(scenery: &Scenery, ndc: Ndc) -> (Vec<u8>, Vec<f32>, Vec<[f32; 4]>) {
    let [now, then] = [&scenery.now, &scenery.then].map(|view| Scenery::to_clip(view, ndc));
    let pixels = (0..SIZE[1] as usize).flat_map(|y| (0..SIZE[0] as usize).map(move |x| [x, y]));
    let (mut rgba, mut depth, mut vectors) = (Vec::new(), Vec::new(), Vec::new());
    for pixel in pixels {
        let (place, square) = scenery.seen(pixel, 0.0);
        let color = Scenery::color(place, square);
        rgba.extend(color.map(|c| (c.clamp(0.0, 1.0) * 255.0).round() as u8));
        rgba.push(255);
        depth.push(scenery.now.depth.depth(-place.z as f32));
        let before = if square { place - scenery.step } else { place };
        let vector = now.project_point3(place) - then.project_point3(before);
        let rounded = vector.to_array().map(|v| {
            let unit = 2f64.powi((v.abs().max(1e-5).log2().floor()) as i32 - 10);
            ((v / unit).round() * unit) as f32
        });
        vectors.push([rounded[0], rounded[1], rounded[2], 0.0]);
    }
    (rgba, depth, vectors)
}

/// Sideways, towards the head and away: the square is where it will be, with its own colours and depth; the wall stands,
/// also where the square was.
#[test]
fn surfaces_are_where_they_will_be() {
    on_every_backend(|gl| {
        let steps =
            [DVec3::new(0.12, -0.05, 0.0), DVec3::new(-0.06, 0.02, 0.15), DVec3::new(0.05, 0.08, -0.2)];
        for (i, step) in steps.into_iter().enumerate() {
            let convention = [DepthConvention::Reversed, DepthConvention::Standard][i % 2];
            let ndc = [Ndc::ZeroToOne, Ndc::MinusOneToOne, Ndc::ZeroToOne][i];
            let scenery = Scenery::new(convention, step);
            let (rgba, depth, vectors) = drawn(&scenery, ndc);
            let ahead = [0.5, 0.5, 1.0][i];
            let law = Extrapolation::new(&scenery.now, &scenery.then, ndc, ahead).unwrap();
            let later = run(gl, &rgba, &depth, &vectors, &law);
            let (mut wrong, mut moved) = (0, 0);
            for y in 0..SIZE[1] as usize {
                for x in 0..SIZE[0] as usize {
                    let (place, square) = scenery.seen([x, y], ahead);
                    let want =
                        Scenery::color(place - if square { step * ahead } else { DVec3::ZERO }, square);
                    let pixel = y * SIZE[0] as usize + x;
                    let got = &later.rgba[pixel * 4..][..3];
                    let was_square = scenery.seen([x, y], 0.0).1;
                    moved += usize::from(was_square != square);
                    // The wall behind the square is not known: only that it is the wall.
                    let channels = if was_square && !square { 2..3 } else { 0..3 };
                    let off = channels.map(|c| (want[c].clamp(0.0, 1.0) * 255.0 - f64::from(got[c])).abs());
                    let distance = scenery.now.depth.distance(later.depth[pixel]) / -place.z as f32;
                    wrong += usize::from(off.fold(0.0, f64::max) > 4.0 || (distance - 1.0).abs() > 0.01);
                }
            }
            // Only along the square's border.
            assert!(moved > 400 && wrong < 300, "{step}: {wrong} wrong, {moved} changed");
        }
    });
}

/// Nothing moves but the head, or no time passes: the same bits.
#[test]
fn what_stands_still_is_copied() {
    on_every_backend(|gl| {
        for (ndc, step, ahead) in [
            (Ndc::ZeroToOne, DVec3::ZERO, 1.0),
            (Ndc::MinusOneToOne, DVec3::ZERO, 0.5),
            (Ndc::ZeroToOne, DVec3::new(0.1, 0.0, 0.1), 0.0),
        ] {
            let scenery = Scenery::new(DepthConvention::Reversed, step);
            let (rgba, depth, vectors) = drawn(&scenery, ndc);
            let law = Extrapolation::new(&scenery.now, &scenery.then, ndc, ahead).unwrap();
            let later = run(gl, &rgba, &depth, &vectors, &law);
            assert!(later.rgba == rgba && later.depth == depth, "{ndc:?}, {step}, {ahead}");
        }
    });
}
