//! Uses yoro in another engine: the engine draws one eye with its own code into its own textures, and yoro writes the
//! other eye into the engine's framebuffer. It uses no scene, renderer or render target of yoro's.
//!
//! `cargo run -p yoro --example engine` writes `out/engine.png`, with the left and right eye side by side. `cargo run -p
//! yoro --example engine -- medium` renders a foveated view, of the strength `low`, `medium` or `high`.

use std::error::Error;
use std::path::Path;
use std::rc::Rc;

use glam::{Quat, Vec3};
use glow::HasContext;
use image::{Rgb, RgbImage};
use yoro::eyes::{
    DepthConvention, DepthRange, Eye, EyePair, FoveationLevel, Frustum, Gaze, GuardBand, MEAN_IPD, Pose,
    SynthesisViews, View, ViewLayer,
};
use yoro::opengl::{
    Composer, Context, Destination, Gather, GlState, InsetImage, LevelImage, LevelImages, Options, Outputs,
    Part, Source,
};
use yoro_context::{Backend, Headless};

const SIZE: [u32; 2] = [768, 768];

fn main() -> Result<(), Box<dyn Error>> {
    // This stands for the engine's window. An engine has a current context and lends yoro its entry points:
    //     yoro::opengl::Context::new(unsafe { glow::Context::from_loader_function(get_proc_address) })?
    let headless = Headless::open(Backend::Auto)?;
    let gl = headless.gl();
    let engine = Engine::new(gl.raw())?;

    // Once: all shaders are compiled here. `depth: true` also writes the other eye's depth, for transparent objects and
    // compositors.
    let outputs = Outputs { depth: true, ..Outputs::default() };
    let mut gather = Gather::new(gl, &Options::default(), outputs)?;

    // Each frame: the poses and frusta of the eyes, and the meaning of the depth buffer. With OpenXR, `poses` and
    // `frusta` come from the two views of xrLocateViews.
    let head = Pose { position: Vec3::new(0.0, 1.6, 2.0), orientation: Quat::from_rotation_y(0.15) };
    let depth = DepthRange { near: 0.1, far: f32::INFINITY, convention: DepthConvention::Reversed };
    let frustum = Frustum::symmetric(75f32.to_radians(), 1.0);
    let pair = EyePair::parallel(head, frustum, MEAN_IPD, depth, SIZE, Eye::Right);

    if let Some(name) = std::env::args().nth(1) {
        let level = FoveationLevel::ALL.into_iter().find(|level| level.name() == name);
        return foveated(gl, &engine, &pair, level.ok_or("give off, low, medium or high")?);
    }

    // For example, eyes that are not parallel give an error, as one sentence.
    let views = pair.synthesis_views(GuardBand::Distance(0.7))?;

    // The view to render is wider than the eye, by the guard band: size and frustum come from `views.source`.
    let source = engine.create_image(views.source.size)?;
    engine.draw(&views.source, &source);

    let other = engine.create_image(views.target.size)?;
    // A texture with only a GL name is `glow::NativeTexture(name)`, with the name as `NonZeroU32`.
    let textures = Source::new(source.color, source.depth);
    let target =
        Destination { framebuffer: Some(other.framebuffer), origin: [0, 0], size: views.target.size };
    gather.synthesize(textures, &views.warp, &target)?;
    // The call has changed program, vertex array, texture units 0 to 3, viewport, framebuffer and more: set your own,
    // or choose `GlState::Preserve` in `Options`. The documentation of `yoro::opengl::Pipeline` has the table.

    // The rendered eye's own image is the part of `source` that starts at `dominant_crop`.
    let right = engine.read(&source, views.dominant_crop);
    let left = engine.read(&other, [0, 0]);
    save(&left, &right, Path::new("out/engine.png"))?;

    // Do this once in every integration: a wrong sign, a flipped row or a misread depth costs more than 10 dB.
    engine.draw(&views.target, &other);
    let truth = engine.read(&other, [0, 0]);
    println!(
        "against the left eye rendered: {:.2} dB; the right eye in its place: {:.2} dB",
        psnr(&left, &truth),
        psnr(&right, &truth)
    );
    Ok(())
}

/// Writes both eyes side by side.
fn save(left: &RgbImage, right: &RgbImage, path: &Path) -> Result<(), Box<dyn Error>> {
    std::fs::create_dir_all("out")?;
    let mut both = RgbImage::new(2 * SIZE[0], SIZE[1]);
    image::imageops::replace(&mut both, left, 0, 0);
    image::imageops::replace(&mut both, right, i64::from(SIZE[0]), 0);
    both.save(path)?;
    println!("{}: left eye synthesized, right eye rendered", path.display());
    Ok(())
}

/// A level's view with the images of both eyes: the rendered one, and the synthesized one.
struct Rendered {
    layer: ViewLayer,
    views: SynthesisViews,
    source: Image,
    other: Image,
}

impl Rendered {
    /// Returns an eye's own image. Of the rendered eye it is a part of what was rendered.
    fn image(&self, eye: Eye) -> LevelImage {
        if eye != self.layer.eyes.dominant {
            return LevelImage::new(self.other.color);
        }
        let part = Part { origin: self.views.dominant_crop, image_size: self.views.source.size };
        LevelImage { color: self.source.color, part: Some(part) }
    }
}

/// Renders and synthesizes each level of a foveated view as a view of its own, and composes both eyes of them.
fn foveated(
    gl: &Rc<Context>,
    engine: &Engine,
    pair: &EyePair,
    strength: FoveationLevel,
) -> Result<(), Box<dyn Error>> {
    let composer = Composer::new(gl, GlState::Leave, false)?;
    // Each frame, with the direction of an eye tracker, if there is one: sizes stay.
    let gaze = Gaze::Axes(pair.axes());
    let levels = pair.stereo_views(strength.foveation().as_ref(), gaze)?;
    let render = |layer: ViewLayer| -> Result<Rendered, Box<dyn Error>> {
        let views = layer.synthesis_views(GuardBand::Distance(1.0))?;
        let source = engine.create_image(views.source.size)?;
        engine.draw(&views.source, &source);
        let other = engine.create_image(layer.eyes.size)?;
        // In an engine each level keeps its pipeline, whose buffers then keep their size.
        let outputs = Outputs { depth: true, ..Outputs::default() };
        let mut gather = Gather::new(gl, &Options::default(), outputs)?;
        let to = whole(&other, layer.eyes.size);
        gather.synthesize(Source::new(source.color, source.depth), &views.warp, &to)?;
        Ok(Rendered { layer, views, source, other })
    };
    let (wide, inset) = (render(levels.wide)?, levels.inset.map(render).transpose()?);
    // Transparent objects are drawn here, into each level of each eye.
    let shown = engine.create_image(SIZE)?;
    let [left, right] = Eye::BOTH.map(|eye| {
        let of_inset = |inset: &Rendered| InsetImage {
            image: inset.image(eye),
            depth: (eye != pair.dominant).then_some(inset.other.depth),
        };
        let images = LevelImages { wide: wide.image(eye), inset: inset.as_ref().map(of_inset) };
        composer.compose(&images, &levels.composition(eye), &whole(&shown, SIZE));
        engine.read(&shown, [0, 0])
    });
    save(&left, &right, &Path::new("out").join(format!("engine-{}.png", strength.name())))?;
    let pixels = |[width, height]: [u32; 2]| f64::from(width) * f64::from(height);
    let levels = [Some(&wide), inset.as_ref()].into_iter().flatten();
    let rendered: f64 = levels.map(|rendered| pixels(rendered.views.source.size)).sum();
    engine.draw(&pair.view(Eye::Left), &shown);
    println!(
        "{:.3} of two eyes' pixels rendered; against the left eye rendered with all pixels: {:.2} dB",
        rendered / (2.0 * pixels(SIZE)),
        psnr(&left, &engine.read(&shown, [0, 0]))
    );
    Ok(())
}

fn whole(image: &Image, size: [u32; 2]) -> Destination {
    Destination { framebuffer: Some(image.framebuffer), origin: [0, 0], size }
}

/// Returns the peak signal-to-noise ratio over red, green and blue, in decibels.
fn psnr(image: &RgbImage, truth: &RgbImage) -> f64 {
    let squares = image.iter().zip(truth.iter()).map(|(a, b)| f64::from(a.abs_diff(*b)).powi(2));
    10.0 * (255f64.powi(2) * truth.len() as f64 / squares.sum::<f64>()).log10()
}

/// A minimal engine: it casts rays into a tiled room with balls.
struct Engine<'a> {
    gl: &'a glow::Context,
    program: glow::Program,
    vertex_array: glow::VertexArray,
}

struct Image {
    framebuffer: glow::Framebuffer,
    color: glow::Texture,
    depth: glow::Texture,
}

impl Engine<'_> {
    fn new(gl: &glow::Context) -> Result<Engine<'_>, String> {
        // SAFETY: the context is current; all names are created here.
        unsafe {
            let program = gl.create_program()?;
            for (kind, text) in [(glow::VERTEX_SHADER, VERTEX), (glow::FRAGMENT_SHADER, FRAGMENT)] {
                let shader = gl.create_shader(kind)?;
                gl.shader_source(shader, text);
                gl.compile_shader(shader);
                if !gl.get_shader_compile_status(shader) {
                    return Err(gl.get_shader_info_log(shader));
                }
                gl.attach_shader(program, shader);
            }
            gl.link_program(program);
            if !gl.get_program_link_status(program) {
                return Err(gl.get_program_info_log(program));
            }
            Ok(Engine { gl, program, vertex_array: gl.create_vertex_array()? })
        }
    }

    fn create_image(&self, size: [u32; 2]) -> Result<Image, String> {
        // Linear for colour and nearest for depth, clamped to the edge.
        let color = self.create_texture(size, glow::RGBA8, glow::LINEAR)?;
        let depth = self.create_texture(size, glow::DEPTH_COMPONENT32F, glow::NEAREST)?;
        let gl = self.gl;
        // SAFETY: the textures are live and of one size.
        unsafe {
            let framebuffer = gl.create_framebuffer()?;
            gl.bind_framebuffer(glow::FRAMEBUFFER, Some(framebuffer));
            for (attachment, texture) in [(glow::COLOR_ATTACHMENT0, color), (glow::DEPTH_ATTACHMENT, depth)] {
                gl.framebuffer_texture_2d(glow::FRAMEBUFFER, attachment, glow::TEXTURE_2D, Some(texture), 0);
            }
            Ok(Image { framebuffer, color, depth })
        }
    }

    fn create_texture(&self, [w, h]: [u32; 2], format: u32, filter: u32) -> Result<glow::Texture, String> {
        let gl = self.gl;
        // SAFETY: the texture is new, format and parameters are valid for it.
        unsafe {
            let texture = gl.create_texture()?;
            gl.bind_texture(glow::TEXTURE_2D, Some(texture));
            gl.tex_storage_2d(glow::TEXTURE_2D, 1, format, w as i32, h as i32);
            for (name, value) in [
                (glow::TEXTURE_MIN_FILTER, filter),
                (glow::TEXTURE_MAG_FILTER, filter),
                (glow::TEXTURE_WRAP_S, glow::CLAMP_TO_EDGE),
                (glow::TEXTURE_WRAP_T, glow::CLAMP_TO_EDGE),
            ] {
                gl.tex_parameter_i32(glow::TEXTURE_2D, name, value as i32);
            }
            Ok(texture)
        }
    }

    fn draw(&self, view: &View, image: &Image) {
        let gl = self.gl;
        let world_to_clip = view.view_projection();
        let clip_to_world = world_to_clip.inverse();
        let eye = view.pose.position;
        // SAFETY: program, vertex array and framebuffer are live; the vertex array has no attributes to read.
        unsafe {
            gl.bind_framebuffer(glow::FRAMEBUFFER, Some(image.framebuffer));
            gl.viewport(0, 0, view.size[0] as i32, view.size[1] as i32);
            gl.enable(glow::DEPTH_TEST);
            gl.depth_func(glow::ALWAYS);
            gl.use_program(Some(self.program));
            let uniform = |name| gl.get_uniform_location(self.program, name);
            gl.uniform_matrix_4_f32_slice(
                uniform("world_to_clip").as_ref(),
                false,
                &world_to_clip.to_cols_array(),
            );
            gl.uniform_matrix_4_f32_slice(
                uniform("clip_to_world").as_ref(),
                false,
                &clip_to_world.to_cols_array(),
            );
            gl.uniform_3_f32(uniform("eye").as_ref(), eye.x, eye.y, eye.z);
            gl.bind_vertex_array(Some(self.vertex_array));
            gl.draw_arrays(glow::TRIANGLES, 0, 3);
        }
    }

    fn read(&self, image: &Image, [x, y]: [u32; 2]) -> RgbImage {
        let [w, h] = SIZE;
        let mut rgba = vec![0; (w * h * 4) as usize];
        // SAFETY: the buffer holds w * h RGBA8 pixels.
        unsafe {
            self.gl.bind_framebuffer(glow::FRAMEBUFFER, Some(image.framebuffer));
            let pixels = glow::PixelPackData::Slice(Some(&mut rgba));
            let [x, y, width, height] = [x, y, w, h].map(|n| n as i32);
            self.gl.read_pixels(x, y, width, height, glow::RGBA, glow::UNSIGNED_BYTE, pixels);
        }
        // GL's rows start at the bottom, a file's at the top.
        RgbImage::from_fn(w, h, |x, y| {
            let i = (((h - 1 - y) * w + x) * 4) as usize;
            Rgb([rgba[i], rgba[i + 1], rgba[i + 2]])
        })
    }
}

const VERTEX: &str = "#version 310 es
precision highp float;
out vec2 ndc;

void main() {
    ndc = vec2(float((gl_VertexID << 1) & 2), float(gl_VertexID & 2)) * 2.0 - 1.0;
    gl_Position = vec4(ndc, 0.0, 1.0);
}
";

const FRAGMENT: &str = "#version 310 es
precision highp float;
uniform mat4 world_to_clip;
uniform mat4 clip_to_world;
uniform vec3 eye;
in vec2 ndc;
layout(location = 0) out vec4 color;

const vec3 ROOM = vec3(3.0, 3.0, 5.0);
const vec3 SUN = vec3(0.36, 0.8, 0.48);

void main() {
    vec4 near = clip_to_world * vec4(ndc, 1.0, 1.0);
    vec3 ray = normalize(near.xyz / near.w - eye);

    vec3 walls = (sign(ray) * ROOM - eye) / ray;
    float t = min(walls.x, min(walls.y, walls.z));
    vec3 normal = -sign(ray) * step(walls, vec3(t));
    ivec3 tile = ivec3(floor((eye + t * ray + 0.01 * normal) * 2.0));
    vec3 albedo = ((tile.x + tile.y + tile.z) & 1) == 0 ? vec3(0.75, 0.72, 0.66) : vec3(0.32, 0.38, 0.45);

    for (int i = 0; i < 7; ++i) {
        float angle = 0.9 * float(i);
        vec3 center = vec3(1.5 * sin(angle), 1.6 + 0.9 * cos(1.7 * angle), 0.9 - 0.8 * float(i));
        float radius = 0.2 + 0.05 * float(i);
        vec3 to_eye = eye - center;
        float b = dot(to_eye, ray);
        float discriminant = b * b - dot(to_eye, to_eye) + radius * radius;
        float distance = -b - sqrt(max(discriminant, 0.0));
        if (discriminant > 0.0 && distance > 0.0 && distance < t) {
            t = distance;
            normal = (eye + t * ray - center) / radius;
            albedo = 0.5 + 0.45 * cos(float(i) + vec3(0.0, 2.1, 4.2));
            albedo *= fract(4.0 * atan(normal.z, normal.x) / 3.1416) < 0.5 ? 1.0 : 0.6;
        }
    }

    color = vec4(albedo * (0.45 + 0.55 * max(dot(normal, SUN), 0.0)), 1.0);
    vec4 clip = world_to_clip * vec4(eye + t * ray, 1.0);
    gl_FragDepth = 0.5 * clip.z / clip.w + 0.5;
}
";
