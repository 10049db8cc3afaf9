//! Shader programs from the files of [`yoro_shaders`].

use std::collections::HashMap;
use std::rc::Rc;

use glam::{IVec2, IVec3, IVec4, Mat3, Mat4, Vec2, Vec3, Vec4};
use glow::HasContext;
use yoro_shaders::{Assembled, MissingFile};

use crate::{Context, GlApi, GlError, Texture};

/// The shader files of a program.
#[derive(Clone, Copy, Debug)]
pub enum ShaderSource<'a> {
    /// Vertex and fragment shader.
    Raster {
        /// Vertex shader file.
        vertex: &'a str,
        /// Fragment shader file.
        fragment: &'a str,
    },
    /// `screen.vert` and a fragment shader.
    Screen(&'a str),
    /// Compute shader file.
    Compute(&'a str),
}

/// The files and defines that a program was compiled from.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct ProgramRecipe {
    /// The file of each stage, as [`yoro_shaders::files`] names it: vertex and fragment shader, or a compute shader.
    pub files: Vec<String>,
    /// Names and values of the preprocessor macros, in order of definition.
    pub defines: Vec<(String, String)>,
}

/// Returns a file's text, for the GLSL ES version that the context compiles, at most 3.10.
fn assemble(gl: &Context, path: &str, defines: &[(&str, String)]) -> Result<Assembled, GlError> {
    let version = match gl.capabilities().api {
        GlApi::Es if !gl.capabilities().compute => "300 es",
        _ => "310 es",
    };
    yoro_shaders::assemble(path, version, defines).map_err(|MissingFile(file)| GlError::MissingShader(file))
}

/// A linked program with its uniforms.
pub struct Program {
    gl: Rc<Context>,
    raw: glow::Program,
    recipe: Rc<ProgramRecipe>,
    uniforms: HashMap<String, glow::UniformLocation>,
}

impl Program {
    /// Compiles and links a program.
    ///
    /// # Errors
    /// [`GlError::Shader`] with file, line and the driver's log; [`GlError::MissingShader`]; [`GlError::Unsupported`]
    /// for a compute shader without OpenGL ES 3.1.
    pub fn new(
        gl: &Rc<Context>,
        source: ShaderSource,
        defines: &[(&str, String)],
    ) -> Result<Program, GlError> {
        let stages: Vec<(u32, &'static str, &str)> = match source {
            ShaderSource::Raster { vertex, fragment } => vec![
                (glow::VERTEX_SHADER, "vertex shader", vertex),
                (glow::FRAGMENT_SHADER, "fragment shader", fragment),
            ],
            ShaderSource::Screen(fragment) => vec![
                (glow::VERTEX_SHADER, "vertex shader", "screen.vert"),
                (glow::FRAGMENT_SHADER, "fragment shader", fragment),
            ],
            ShaderSource::Compute(file) => vec![(glow::COMPUTE_SHADER, "compute shader", file)],
        };
        if matches!(source, ShaderSource::Compute(_)) && !gl.capabilities().compute {
            return Err(GlError::Unsupported(format!(
                "{} has no compute shaders (OpenGL ES 3.1); choose the pipeline gather",
                gl.capabilities().renderer
            )));
        }
        let raw_gl = gl.raw();
        let object = |reason| GlError::Object { what: "a shader".into(), reason };
        let mut shaders = Vec::new();
        let mut last_file = "";
        let recipe = ProgramRecipe {
            files: stages.iter().map(|(_, _, file)| (*file).to_owned()).collect(),
            defines: defines.iter().map(|(name, value)| ((*name).to_owned(), value.clone())).collect(),
        };
        // SAFETY: shaders and program are created here and deleted after their last use.
        unsafe {
            let raw = raw_gl.create_program().map_err(object)?;
            gl.count(1);
            let recipe = Rc::new(recipe);
            let mut program =
                Program { gl: gl.clone(), raw, recipe: recipe.clone(), uniforms: HashMap::new() };
            for (kind, stage, file) in stages {
                last_file = file;
                let assembled = assemble(gl, file, defines)?;
                let shader = raw_gl.create_shader(kind).map_err(object)?;
                raw_gl.shader_source(shader, &assembled.text);
                raw_gl.compile_shader(shader);
                raw_gl.attach_shader(raw, shader);
                shaders.push(shader);
                if !raw_gl.get_shader_compile_status(shader) {
                    let log = assembled.name_files(&raw_gl.get_shader_info_log(shader));
                    shaders.iter().for_each(|&s| raw_gl.delete_shader(s));
                    return Err(GlError::Shader { stage, file: file.to_owned(), log });
                }
            }
            raw_gl.link_program(raw);
            shaders.iter().for_each(|&s| raw_gl.delete_shader(s));
            if !raw_gl.get_program_link_status(raw) {
                let log = raw_gl.get_program_info_log(raw);
                return Err(GlError::Shader { stage: "program", file: last_file.to_owned(), log });
            }
            gl.observe(|observed| observed.observer.program_made(&recipe));
            for i in 0..raw_gl.get_program_parameter_i32(raw, glow::ACTIVE_UNIFORMS) as u32 {
                if let Some(uniform) = raw_gl.get_active_uniform(raw, i)
                    && let Some(location) = raw_gl.get_uniform_location(raw, &uniform.name)
                {
                    let name = uniform.name.trim_end_matches("[0]").to_owned();
                    program.uniforms.insert(name, location);
                }
            }
            Ok(program)
        }
    }

    /// Makes the program current and returns it.
    pub fn bind(&self) -> &Program {
        // SAFETY: the program is linked.
        unsafe { self.gl.raw().use_program(Some(self.raw)) };
        self.gl.observe(|observed| observed.program = Some(self.recipe.clone()));
        self
    }

    /// Sets a uniform by name. The program must be current. Names that the program does not have are ignored, since
    /// variants of one shader use different uniforms. Names of arrays have no brackets.
    pub fn set(&self, name: &str, value: impl UniformValue) -> &Program {
        if let Some(location) = self.uniforms.get(name) {
            // SAFETY: the location belongs to this program, which the caller has bound.
            unsafe { value.set(self.gl.raw(), location) };
        }
        self
    }

    /// Binds a 2-D texture to a unit and points a sampler at the unit.
    pub fn texture(&self, name: &str, unit: u32, texture: glow::Texture) -> &Program {
        super::texture::bind_texture(&self.gl, unit, glow::TEXTURE_2D, texture);
        self.set(name, unit as i32)
    }

    /// Binds an array texture to a unit and points a sampler at the unit.
    pub fn texture_array(&self, name: &str, unit: u32, texture: glow::Texture) -> &Program {
        super::texture::bind_texture(&self.gl, unit, glow::TEXTURE_2D_ARRAY, texture);
        self.set(name, unit as i32)
    }

    /// Binds a multisample texture to a unit and points a sampler at the unit.
    pub fn texture_multisample(&self, name: &str, unit: u32, texture: glow::Texture) -> &Program {
        super::texture::bind_texture(&self.gl, unit, glow::TEXTURE_2D_MULTISAMPLE, texture);
        self.set(name, unit as i32)
    }

    /// Binds a texture of this library, 2-D or an array, to a unit and points a sampler at the unit.
    pub fn texture_of(&self, name: &str, unit: u32, texture: &Texture) -> &Program {
        texture.bind(unit);
        self.set(name, unit as i32)
    }
}

impl Drop for Program {
    fn drop(&mut self) {
        // SAFETY: created in `new`, deleted once.
        unsafe {
            let gl = self.gl.raw();
            // If the program were current, it would live on and stay current in the host. Browsers have no other host,
            // and glow panics there if no program is current.
            let own = Some(self.raw);
            if cfg!(not(target_arch = "wasm32")) && gl.get_parameter_program(glow::CURRENT_PROGRAM) == own {
                gl.use_program(None);
            }
            gl.delete_program(self.raw);
        }
        self.gl.count(-1);
    }
}

/// A value of a uniform.
pub trait UniformValue {
    /// Uploads the value.
    ///
    /// # Safety
    /// The location must belong to the current program.
    unsafe fn set(self, gl: &glow::Context, location: &glow::UniformLocation);
}

macro_rules! uniform {
    ($ty:ty, |$gl:ident, $location:ident, $v:ident| $body:expr) => {
        impl UniformValue for $ty {
            unsafe fn set(self, $gl: &glow::Context, $location: &glow::UniformLocation) {
                let $v = self;
                // SAFETY: the location belongs to the current program.
                unsafe { $body }
            }
        }
    };
}

uniform!(f32, |gl, l, v| gl.uniform_1_f32(Some(l), v));
uniform!(i32, |gl, l, v| gl.uniform_1_i32(Some(l), v));
uniform!(u32, |gl, l, v| gl.uniform_1_u32(Some(l), v));
uniform!(bool, |gl, l, v| gl.uniform_1_i32(Some(l), v as i32));
uniform!(IVec2, |gl, l, v| gl.uniform_2_i32(Some(l), v.x, v.y));
uniform!(IVec3, |gl, l, v| gl.uniform_3_i32(Some(l), v.x, v.y, v.z));
uniform!(IVec4, |gl, l, v| gl.uniform_4_i32(Some(l), v.x, v.y, v.z, v.w));
uniform!(Vec2, |gl, l, v| gl.uniform_2_f32(Some(l), v.x, v.y));
uniform!(Vec3, |gl, l, v| gl.uniform_3_f32(Some(l), v.x, v.y, v.z));
uniform!(Vec4, |gl, l, v| gl.uniform_4_f32(Some(l), v.x, v.y, v.z, v.w));
uniform!(Mat3, |gl, l, v| gl.uniform_matrix_3_f32_slice(Some(l), false, v.as_ref()));
uniform!(Mat4, |gl, l, v| gl.uniform_matrix_4_f32_slice(Some(l), false, v.as_ref()));
uniform!(&[IVec4], |gl, l, v| gl.uniform_4_i32_slice(Some(l), bytemuck::cast_slice(v)));
uniform!(&[IVec2], |gl, l, v| gl.uniform_2_i32_slice(Some(l), bytemuck::cast_slice(v)));
uniform!(&[Vec3], |gl, l, v| gl.uniform_3_f32_slice(Some(l), bytemuck::cast_slice(v)));
uniform!(&[Vec4], |gl, l, v| gl.uniform_4_f32_slice(Some(l), bytemuck::cast_slice(v)));
uniform!(&[Mat3], |gl, l, v| gl.uniform_matrix_3_f32_slice(Some(l), false, bytemuck::cast_slice(v)));
uniform!(&[Mat4], |gl, l, v| gl.uniform_matrix_4_f32_slice(Some(l), false, bytemuck::cast_slice(v)));
uniform!(&[f32], |gl, l, v| gl.uniform_1_f32_slice(Some(l), v));
