//! Any view, or motion vectors, of images in memory on OpenGL: upload, run, and read back colour and depth.

use std::rc::Rc;

use glam::{EulerRot, Quat, Vec3};

use yoro::eyes::{Pose, View};
use yoro::opengl::{Context, Destination, Options, Outputs, Part, Pipeline, Source};
use yoro::synthesis::backend::WarpKind;
use yoro_gl::{Filter, Format, Program, RenderTarget, ShaderSource, Texture};

/// The synthesized view: RGBA with 8 bits each, and stored depth. Rows run from the bottom, as in GL.
#[derive(Debug, PartialEq)]
pub struct Image {
    pub rgba: Vec<u8>,
    pub depth: Vec<f32>,
}

/// Synthesizes from images in memory. If `part` is given, the source is at its corner in textures of its size.
pub fn run<W: WarpKind>(gl: &Rc<Context>, rgba: &[u8], depth: &[f32], warp: &W, part: Option<Part>) -> Image {
    let [source_size, target_size] = warp.sizes();
    let size = part.map_or(source_size, |part| part.image_size);
    let texture = |format, bytes: &[u8]| {
        let texture = Texture::new(gl, size, format, Filter::Nearest).unwrap();
        texture.upload(bytes);
        texture
    };
    let color = texture(Format::Rgba8, rgba);
    let depth: Vec<u8> = depth.iter().flat_map(|depth| depth.to_ne_bytes()).collect();
    let depth = texture(Format::R32F, &depth);
    let options = Options { parts: part.is_some(), ..Options::default() };
    let outputs = Outputs { depth: true, ..Outputs::default() };
    let mut pipeline = Pipeline::<W>::new(gl, &options, outputs).unwrap();
    let formats = [(Format::Rgba8, Filter::Nearest)];
    // Not at the corner of the framebuffer, where all places would be the same.
    let size = target_size;
    let target = RenderTarget::new(gl, size.map(|n| n + 7), &formats, Some(Format::Depth32F)).unwrap();
    let place = Destination { framebuffer: Some(target.raw()), origin: [3, 5], size };
    let source = Source { part, ..Source::new(color.raw(), depth.raw()) };
    pipeline.synthesize(source, warp, &place).unwrap();
    // Depth is copied to a colour texture to read it back.
    let copy = RenderTarget::new(gl, target.size(), &[(Format::Rgba32F, Filter::Nearest)], None).unwrap();
    let program = Program::new(gl, ShaderSource::Screen("render/depth_copy.frag"), &[]).unwrap();
    copy.overwrite();
    program.bind().texture("source", 0, target.depth().raw());
    gl.draw_screen();
    let depth = copy.read_rgba32f(0, [3, 5], size).into_iter().map(|texel| texel[0]).collect();
    Image { rgba: target.read_rgba8(0, [3, 5], size), depth }
}

/// A head's motion: translation in metres, and yaw, pitch and roll in radians.
pub type Motion = (Vec3, [f32; 3]);

/// To a side, up, diagonally, forwards, backwards, turned only, and everything at once.
pub const MOTIONS: [Motion; 7] = [
    (Vec3::new(0.06, 0.0, 0.0), [0.0; 3]),
    (Vec3::new(0.0, -0.05, 0.0), [0.0; 3]),
    (Vec3::new(-0.03, 0.04, 0.0), [0.0; 3]),
    (Vec3::new(0.0, 0.0, -0.2), [0.0; 3]),
    (Vec3::new(0.01, 0.0, 0.1), [0.0; 3]),
    (Vec3::ZERO, [0.05, -0.03, 0.1]),
    (Vec3::new(0.03, -0.02, -0.06), [-0.04, 0.02, -0.05]),
];

/// Returns a view, which must not be turned, after a motion.
pub fn moved(view: &View, (way, [yaw, pitch, roll]): Motion) -> View {
    let orientation = Quat::from_euler(EulerRot::YXZ, yaw, pitch, roll);
    View { pose: Pose { position: view.pose.position + way, orientation }, ..*view }
}
