//! Multisample textures with known samples, like those of a renderer with MSAA.

use std::rc::Rc;

use glow::HasContext as _;
use yoro::eyes::{DepthConvention, DepthRange, Eye, EyePair, Frustum, GuardBand, Pose, Warp};
use yoro::synthesis::{Edges, Layers, Outputs, Source, Synthesis as _};
use yoro_gl::{Context, Destination, Filter, Format, RenderTarget, Texture};

/// The standard pattern of four samples: positions in pixels from the pixel's upper left corner.
pub const STANDARD: [[f64; 2]; 4] = [[0.375, 0.125], [0.875, 0.375], [0.125, 0.625], [0.625, 0.875]];

/// The ways to pass the same picture: the meaning of its edges, and whether the colours of the samples are included.
pub const GIVEN: [(Edges, bool); 4] = [
    (Edges::Nearest, false),
    (Edges::Sample, false),
    (Edges::Multisample, false),
    (Edges::Multisample, true),
];

/// Colour and depth of four samples per pixel. Rows run from bottom to top, as in GL.
#[derive(Clone, Debug)]
pub struct Samples {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// RGBA of each sample.
    pub rgba: [Vec<u8>; 4],
    /// Window depth of each sample.
    pub depth: [Vec<f32>; 4],
}

impl Samples {
    /// Returns the mean display values of each pixel's samples.
    pub fn resolved(&self) -> Vec<u8> {
        let sum = |i: usize| self.rgba.iter().map(|rgba| u32::from(rgba[i])).sum::<u32>();
        (0..self.rgba[0].len()).map(|i| ((sum(i) + 2) / 4) as u8).collect()
    }

    /// Returns for each pixel the depth that `better` prefers to all others.
    pub fn chosen_depth(&self, better: impl Fn(f32, f32) -> bool) -> Vec<f32> {
        let choose = |a: f32, b: f32| if better(b, a) { b } else { a };
        (0..self.depth[0].len())
            .map(|i| self.depth.iter().map(|d| d[i]).reduce(choose).unwrap_or_default())
            .collect()
    }

    /// Returns for each pixel the depth that a source without multisampled depth has with these edges.
    pub fn one_depth(&self, edges: Edges, convention: DepthConvention) -> Vec<f32> {
        match (edges, convention) {
            (Edges::Sample, _) => self.depth[0].clone(),
            (_, DepthConvention::Standard) => self.chosen_depth(|a, b| a < b),
            (_, DepthConvention::Reversed) => self.chosen_depth(|a, b| a > b),
        }
    }
}

/// Returns a warp between eyes of 150x50 pixels, and a picture for its source.
pub fn example(dominant: Eye, convention: DepthConvention, guard: GuardBand) -> (Warp, Samples) {
    let depth = DepthRange { near: 0.3, far: 100.0, convention };
    let frustum = Frustum::symmetric(1.2, 3.0);
    let eyes = EyePair::parallel(Pose::IDENTITY, frustum, 0.063, depth, [150, 50], dominant);
    let warp = eyes.synthesis_views(guard).unwrap().warp;
    (warp, picture(warp.source_size, depth, warp.target_eye == Eye::Right))
}

/// Synthesizes one of the cases [`GIVEN`] with OpenGL. Returns RGBA and the source map.
pub fn on_opengl(
    gl: &Rc<Context>,
    samples: &Samples,
    (edges, colors): (Edges, bool),
    warp: &Warp,
) -> (Vec<u8>, Vec<u32>) {
    let formats = [(Format::Rgba8, Filter::Nearest), (Format::R32Ui, Filter::Nearest)];
    let target = RenderTarget::new(gl, warp.target_size, &formats, None).unwrap();
    let multisampled = Multisampled::new(gl, samples).unwrap();
    let single = Texture::new(gl, samples.size, Format::R32F, Filter::Nearest).unwrap();
    let source = match edges {
        Edges::Multisample => multisampled.source(colors),
        _ => {
            single.upload(bytemuck::cast_slice(&samples.one_depth(edges, warp.convention)));
            Source::new(multisampled.resolved().raw(), single.raw())
        }
    };
    let outputs = Outputs { source_map: true, ..Outputs::default() };
    let mut pipeline = Layers::new(gl, outputs, edges).unwrap();
    pipeline.synthesize(source, warp, &Destination::whole(&target)).unwrap();
    (target.read_rgba8(0, [0, 0], warp.target_size), target.read_u32(1, [0, 0], warp.target_size))
}

/// Makes a picture of slanted rectangles in front of a slanted background, with four samples per pixel.
pub fn picture(size: [u32; 2], range: DepthRange, mirrored: bool) -> Samples {
    // Left, right, bottom, top in fractions of the picture, distance in metres, colour.
    const SHAPES: [([f64; 4], f64, [u8; 3]); 5] = [
        ([0.11, 0.34, 0.13, 0.71], 0.9, [220, 60, 40]),
        ([0.41, 0.43, 0.0, 1.0], 1.3, [30, 160, 60]),
        ([0.52, 0.5268, 0.2, 0.93], 0.7, [240, 230, 90]),
        ([0.63, 0.88, 0.37, 0.81], 2.1, [60, 80, 220]),
        ([0.71, 0.79, 0.05, 0.6], 0.6, [200, 200, 210]),
    ];
    let [w, h] = size.map(f64::from);
    let seen = |x: f64, y: f64| {
        let (u, v) = (x / w, y / h);
        // The silhouettes are slanted against the rows.
        let u = u + 0.06 * (v - 0.5);
        let wave = 20.0 * (9.0 * u).sin() * (5.0 * v).cos();
        // Detail with a width of a few columns, outside of all shapes.
        let detail = if (0.09..0.91).contains(&u) { 0.0 } else { 60.0 * (1.7 * x).sin() };
        let hit = SHAPES.iter().filter(|([l, r, b, t], ..)| (*l..*r).contains(&u) && (*b..*t).contains(&v));
        let nearest = hit.min_by(|a, b| a.1.total_cmp(&b.1));
        let (z, color) = nearest
            .map_or((4.0 + 3.0 * u + v, [120, 120, 130]), |(_, z, color)| (z * (1.0 + 0.03 * u), *color));
        (range.depth(z as f32), color.map(|c: u8| (f64::from(c) + wave + detail).clamp(0.0, 255.0) as u8))
    };
    let place = |i: usize, k: usize| {
        let (column, row) = ((i % size[0] as usize) as f64, (i / size[0] as usize) as f64);
        // The pattern is relative to the upper left corner, but rows run from bottom to top.
        let x = column + STANDARD[k][0];
        (if mirrored { w - x } else { x }, row + 1.0 - STANDARD[k][1])
    };
    let count = (size[0] * size[1]) as usize;
    Samples {
        size,
        rgba: std::array::from_fn(|k| {
            (0..count)
                .flat_map(|i| {
                    let [r, g, b] = seen(place(i, k).0, place(i, k).1).1;
                    [r, g, b, 255]
                })
                .collect()
        }),
        depth: std::array::from_fn(|k| (0..count).map(|i| seen(place(i, k).0, place(i, k).1).0).collect()),
    }
}

/// [`Samples`] in multisample textures, and the resolved colour.
pub struct Multisampled {
    gl: Rc<Context>,
    color: glow::Texture,
    depth: glow::Texture,
    resolved: Texture,
}

impl Multisampled {
    /// Draws the samples, with one fragment each.
    ///
    /// # Errors
    /// Fails if the driver lacks per-sample shading (OpenGL ES 3.2).
    pub fn new(gl: &Rc<Context>, samples: &Samples) -> anyhow::Result<Multisampled> {
        let [w, h] = samples.size;
        // The four images are stacked vertically.
        let stacked = [w, 4 * h];
        let upload = |format, bytes: Vec<u8>| -> anyhow::Result<Texture> {
            let texture = Texture::new(gl, stacked, format, Filter::Nearest)?;
            texture.upload(&bytes);
            Ok(texture)
        };
        let colors = upload(Format::Rgba8, samples.rgba.concat())?;
        let depths = upload(Format::R32F, bytemuck::cast_slice(&samples.depth.concat()).to_vec())?;
        let resolved = Texture::new(gl, samples.size, Format::Rgba8, Filter::Linear)?;
        resolved.upload(&samples.resolved());
        let raw = gl.raw();
        // SAFETY: names are created here, and deleted unless they are returned.
        unsafe {
            let texture = |format: Format| -> anyhow::Result<glow::Texture> {
                let texture = raw.create_texture().map_err(anyhow::Error::msg)?;
                raw.bind_texture(glow::TEXTURE_2D_MULTISAMPLE, Some(texture));
                let (target, internal) = (glow::TEXTURE_2D_MULTISAMPLE, format.gl().0);
                raw.tex_storage_2d_multisample(target, 4, internal, w as i32, h as i32, true);
                Ok(texture)
            };
            let (color, depth) = (texture(Format::Rgba8)?, texture(Format::Depth32F)?);
            let framebuffer = raw.create_framebuffer().map_err(anyhow::Error::msg)?;
            raw.bind_framebuffer(glow::FRAMEBUFFER, Some(framebuffer));
            for (attachment, texture) in [(glow::COLOR_ATTACHMENT0, color), (glow::DEPTH_ATTACHMENT, depth)] {
                let target = glow::TEXTURE_2D_MULTISAMPLE;
                raw.framebuffer_texture_2d(glow::FRAMEBUFFER, attachment, target, Some(texture), 0);
            }
            raw.viewport(0, 0, w as i32, h as i32);
            let program = program(raw)?;
            raw.use_program(Some(program));
            colors.bind(0);
            depths.bind(1);
            for (name, unit) in [("colors", 0), ("depths", 1)] {
                raw.uniform_1_i32(raw.get_uniform_location(program, name).as_ref(), unit);
            }
            raw.uniform_1_i32(raw.get_uniform_location(program, "height").as_ref(), h as i32);
            let array = raw.create_vertex_array().map_err(anyhow::Error::msg)?;
            raw.bind_vertex_array(Some(array));
            raw.enable(glow::DEPTH_TEST);
            raw.depth_func(glow::ALWAYS);
            raw.draw_arrays(glow::TRIANGLES, 0, 3);
            raw.disable(glow::DEPTH_TEST);
            raw.bind_vertex_array(None);
            raw.delete_vertex_array(array);
            raw.delete_program(program);
            raw.bind_framebuffer(glow::FRAMEBUFFER, None);
            raw.delete_framebuffer(framebuffer);
            Ok(Multisampled { gl: gl.clone(), color, depth, resolved })
        }
    }

    /// Returns the source for [`yoro::synthesis::Edges::Multisample`].
    pub fn source(&self, with_colors: bool) -> Source {
        let samples = with_colors.then_some(self.color);
        Source { samples, ..Source::new(self.resolved.raw(), self.depth) }
    }

    /// Returns the resolved colour.
    pub fn resolved(&self) -> &Texture {
        &self.resolved
    }
}

impl Drop for Multisampled {
    fn drop(&mut self) {
        // SAFETY: created in `new`, deleted once.
        unsafe {
            self.gl.raw().delete_texture(self.color);
            self.gl.raw().delete_texture(self.depth);
        }
    }
}

unsafe fn program(gl: &glow::Context) -> anyhow::Result<glow::Program> {
    const VERTEX: &str = "void main() {
        gl_Position = vec4(float(gl_VertexID / 2) * 4.0 - 1.0, float(gl_VertexID % 2) * 4.0 - 1.0, 0.0, 1.0);
    }";
    const FRAGMENT: &str = "
        uniform sampler2D colors;
        uniform sampler2D depths;
        uniform int height;
        out vec4 color;
        void main() {
            ivec2 at = ivec2(gl_FragCoord.xy) + ivec2(0, gl_SampleID * height);
            color = texelFetch(colors, at, 0);
            gl_FragDepth = texelFetch(depths, at, 0).r;
        }";
    // SAFETY: names are created here.
    unsafe {
        let program = gl.create_program().map_err(anyhow::Error::msg)?;
        for (kind, text) in [(glow::VERTEX_SHADER, VERTEX), (glow::FRAGMENT_SHADER, FRAGMENT)] {
            let shader = gl.create_shader(kind).map_err(anyhow::Error::msg)?;
            let head =
                "#version 320 es\nprecision highp float;\nprecision highp int;\nprecision highp sampler2D;\n";
            gl.shader_source(shader, &format!("{head}{text}"));
            gl.compile_shader(shader);
            let log = gl.get_shader_info_log(shader);
            anyhow::ensure!(gl.get_shader_compile_status(shader), "{log}");
            gl.attach_shader(program, shader);
            gl.delete_shader(shader);
        }
        gl.link_program(program);
        anyhow::ensure!(gl.get_program_link_status(program), "{}", gl.get_program_info_log(program));
        Ok(program)
    }
}
