//! Multisample textures with known samples, as a renderer with MSAA would have left them.

use std::rc::Rc;

use glow::HasContext as _;
use yoro::synthesis::Source;
use yoro_gl::{Context, Filter, Format, Texture};

/// The standard pattern of four samples: places in the pixel, in pixels from its upper left corner.
pub const STANDARD: [[f64; 2]; 4] = [[0.375, 0.125], [0.875, 0.375], [0.125, 0.625], [0.625, 0.875]];

/// Colour and depth of four samples of each pixel. Rows run from the bottom, as in GL.
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
    /// The means of the samples' display values.
    pub fn resolved(&self) -> Vec<u8> {
        let sum = |i: usize| self.rgba.iter().map(|rgba| u32::from(rgba[i])).sum::<u32>();
        (0..self.rgba[0].len()).map(|i| ((sum(i) + 2) / 4) as u8).collect()
    }

    /// The depth of each pixel that `better` prefers to all others.
    pub fn chosen_depth(&self, better: impl Fn(f32, f32) -> bool) -> Vec<f32> {
        let choose = |a: f32, b: f32| if better(b, a) { b } else { a };
        (0..self.depth[0].len())
            .map(|i| self.depth.iter().map(|d| d[i]).reduce(choose).unwrap_or_default())
            .collect()
    }
}

/// [`Samples`] in multisample textures, with the resolved colour beside them.
pub struct Multisampled {
    gl: Rc<Context>,
    color: glow::Texture,
    depth: glow::Texture,
    resolved: Texture,
}

impl Multisampled {
    /// Draws the samples: a fragment for each.
    ///
    /// # Errors
    /// The driver has no shading by sample (OpenGL ES 3.2).
    pub fn new(gl: &Rc<Context>, samples: &Samples) -> anyhow::Result<Multisampled> {
        let [w, h] = samples.size;
        // The four images above each other.
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
        // SAFETY: names are created here, and those that are not handed over deleted.
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

    /// The source for [`yoro::synthesis::Edges::Multisample`].
    pub fn source(&self, with_colors: bool) -> Source {
        let samples = with_colors.then_some(self.color);
        Source { samples, ..Source::new(self.resolved.raw(), self.depth) }
    }

    /// The resolved colour.
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
