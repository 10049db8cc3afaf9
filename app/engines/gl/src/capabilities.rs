//! The driver's version, limits and extensions, queried once.

use glow::HasContext;

use crate::{Format, GlError};

/// The two families of GL that run the shaders.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "lowercase"))]
pub enum GlApi {
    /// OpenGL ES.
    Es,
    /// Desktop OpenGL 4.5, or 4.3 with GL_ARB_ES3_1_compatibility.
    Desktop,
}

impl GlApi {
    /// True if a context of this version runs the shaders. A program that asks for a version gets that one from many
    /// drivers, although they have newer ones.
    fn runs_shaders(self, version: (u32, u32), has_es_3_1_compatibility: bool) -> bool {
        match self {
            GlApi::Es => version >= (3, 0),
            GlApi::Desktop => version >= (4, 5) || (version >= (4, 3) && has_es_3_1_compatibility),
        }
    }
}

/// The driver, its version and its optional features.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Capabilities {
    /// ES or desktop.
    pub api: GlApi,
    /// Version, such as (3, 1).
    pub version: (u32, u32),
    /// GL_VENDOR.
    pub vendor: String,
    /// GL_RENDERER.
    pub renderer: String,
    /// GL_VERSION.
    pub version_string: String,
    /// Compute shaders and image stores.
    pub compute: bool,
    /// Float colour buffers for HDR targets (EXT_color_buffer_float or half_float).
    pub float_render_targets: bool,
    /// KHR_debug groups.
    pub debug_groups: bool,
    /// Largest anisotropy; 1 without the extension and on a CPU rasterizer.
    pub max_anisotropy: f32,
    /// Reliable timer queries: supported, with counter bits, and not on a CPU rasterizer.
    pub timer_queries: bool,
    /// Reliable timer queries while several views are drawn at once (GL_EXT_multiview_timer_query). Without that
    /// extension, GL_OVR_multiview leaves the results undefined.
    pub multiview_timer_queries: bool,
    /// GL_OVR_multiview2 and, outside of browsers, its entry point ([`crate::Context::with_loader`]).
    pub multiview: bool,
    /// gl_ClipDistance: GL_EXT_clip_cull_distance on ES, core on the desktop.
    pub clip_distances: bool,
    /// Largest texture edge in pixels.
    pub max_texture_size: u32,
    /// Sample counts above 1 that render targets support, largest first.
    pub samples: Vec<u32>,
    /// Multisample textures, whose samples shaders read one by one: OpenGL ES 3.1 and desktop.
    pub multisample_textures: bool,
    /// Masks of the samples that are drawn: OpenGL ES 3.1 and desktop, with its entry points
    /// ([`crate::Context::with_loader`]).
    pub sample_masks: bool,
    /// Samples of colour and depth that exist only in the tiles of a tile-based GPU:
    /// GL_EXT_multisampled_render_to_texture and its second version.
    pub tile_samples: bool,
    /// Size in bytes of a compute workgroup's shared memory.
    pub max_compute_shared_memory: u32,
    /// True on CPU rasterizers (llvmpipe, softpipe, SwiftShader), where times are CPU times.
    pub software: bool,
}

/// The entry points beyond glow's that were found.
pub(crate) struct Loaded {
    pub multiview: bool,
    pub sample_masks: bool,
}

/// Returns the sample counts above 1 that both colour and depth formats support, largest first.
///
/// # Safety
/// The context is current.
unsafe fn samples(gl: &glow::Context) -> Vec<u32> {
    // WebGL guarantees four samples for all formats.
    if cfg!(target_arch = "wasm32") {
        return vec![4];
    }
    let of = |format: Format| {
        // Entries that GL does not write stay 0.
        let mut counts = [0; 16];
        let (target, format) = (glow::RENDERBUFFER, format.gl().0);
        // SAFETY: formats that can be rendered to; at most as many values are written as there is room for.
        unsafe { gl.get_internal_format_i32_slice(target, format, glow::SAMPLES, &mut counts) };
        counts
    };
    let depth = [of(Format::Depth24), of(Format::Depth32F)];
    let counts = of(Format::Rgba8).into_iter().filter(|n| *n > 1 && depth.iter().all(|d| d.contains(n)));
    counts.map(|n| n as u32).collect()
}

/// The extension for timer queries in OpenGL ES or WebGL.
const TIMER_QUERIES: &str = if cfg!(target_arch = "wasm32") {
    "GL_EXT_disjoint_timer_query_webgl2"
} else {
    "GL_EXT_disjoint_timer_query"
};

/// True if the context has the extension `name`, as in the OpenGL registry. WebGL's names lack `GL_`.
pub(crate) fn has_extension(gl: &glow::Context, name: &str) -> bool {
    let name = if cfg!(target_arch = "wasm32") { name.trim_start_matches("GL_") } else { name };
    gl.supported_extensions().contains(name)
}

/// Returns GL_RENDERER. Browsers hide the driver's name there, and give it in WEBGL_debug_renderer_info.
///
/// # Safety
/// The context is current.
unsafe fn renderer(gl: &glow::Context) -> String {
    const UNMASKED_RENDERER_WEBGL: u32 = 0x9246;
    if cfg!(target_arch = "wasm32") && has_extension(gl, "GL_WEBGL_debug_renderer_info") {
        // SAFETY: the extension defines the enum.
        let unmasked = unsafe { gl.get_parameter_string(UNMASKED_RENDERER_WEBGL) };
        if !unmasked.is_empty() {
            return unmasked;
        }
    }
    // SAFETY: a valid enum.
    unsafe { gl.get_parameter_string(glow::RENDERER) }
}

impl Capabilities {
    /// Queries the current context. `counts_time` is called only if timer queries are supported.
    pub(crate) fn query(
        gl: &glow::Context,
        loaded: Loaded,
        counts_time: impl FnOnce() -> bool,
    ) -> Result<Capabilities, GlError> {
        // SAFETY: the context is current, and each enum exists in the versions in which it is queried.
        unsafe {
            let version_string = gl.get_parameter_string(glow::VERSION);
            let version = gl.version();
            let renderer = renderer(gl);
            let has = |name: &str| has_extension(gl, name);
            let api = if version.is_embedded { GlApi::Es } else { GlApi::Desktop };
            let number = (version.major, version.minor);
            if !api.runs_shaders(number, has("GL_ARB_ES3_1_compatibility")) {
                return Err(GlError::Unsupported(format!(
                    "the GL context ({renderer}, {version_string}) is too old: ask for one of OpenGL ES 3.0 or of OpenGL 4.5 (4.3 \
                     with GL_ARB_ES3_1_compatibility), and if the driver has none, update it"
                )));
            }
            let compute = api == GlApi::Desktop || number >= (3, 1);
            let software = ["llvmpipe", "softpipe", "SwiftShader"].iter().any(|n| renderer.contains(n));
            let timer_queries = !software && (api == GlApi::Desktop || has(TIMER_QUERIES)) && counts_time();
            let limit = |name| gl.get_parameter_i32(name).max(0) as u32;
            Ok(Capabilities {
                api,
                version: number,
                vendor: gl.get_parameter_string(glow::VENDOR),
                compute,
                float_render_targets: api == GlApi::Desktop
                    || number >= (3, 2)
                    || has("GL_EXT_color_buffer_float")
                    || has("GL_EXT_color_buffer_half_float"),
                debug_groups: gl.supports_debug(),
                // llvmpipe walks the whole ellipse under a pixel, which has millions of texels where derivatives are
                // extrapolated across the horizon: one frame in a few hundred takes minutes or crashes.
                max_anisotropy: if !software
                    && (has("GL_EXT_texture_filter_anisotropic") || has("GL_ARB_texture_filter_anisotropic"))
                {
                    gl.get_parameter_f32(glow::MAX_TEXTURE_MAX_ANISOTROPY_EXT)
                } else {
                    1.0
                },
                timer_queries,
                multiview_timer_queries: timer_queries && has("GL_EXT_multiview_timer_query"),
                multiview: loaded.multiview && has("GL_OVR_multiview2"),
                clip_distances: api == GlApi::Desktop || has("GL_EXT_clip_cull_distance"),
                max_texture_size: limit(glow::MAX_TEXTURE_SIZE),
                samples: samples(gl),
                // NVIDIA's driver has the extensions without having tiles: on an H100, frames of two renders took up to a
                // quarter longer by them, and those with synthesis a quarter to nine tenths.
                tile_samples: api == GlApi::Es
                    && !renderer.contains("NVIDIA")
                    && has("GL_EXT_multisampled_render_to_texture")
                    && has("GL_EXT_multisampled_render_to_texture2"),
                sample_masks: loaded.sample_masks && (api == GlApi::Desktop || number >= (3, 1)),
                multisample_textures: api == GlApi::Desktop || number >= (3, 1),
                max_compute_shared_memory: if compute {
                    limit(glow::MAX_COMPUTE_SHARED_MEMORY_SIZE)
                } else {
                    0
                },
                software,
                renderer,
                version_string,
            })
        }
    }

    /// Takes away everything that OpenGL ES 3.0 lacks without extensions, but for the number of samples.
    pub fn limit_to_es_300(&mut self) {
        let known = self.clone();
        *self = Capabilities {
            api: GlApi::Es,
            version: (3, 0),
            compute: false,
            float_render_targets: false,
            debug_groups: false,
            max_anisotropy: 1.0,
            timer_queries: false,
            multiview_timer_queries: false,
            multiview: false,
            clip_distances: false,
            multisample_textures: false,
            sample_masks: false,
            tile_samples: false,
            max_compute_shared_memory: 0,
            ..known
        };
    }

    /// Checks that render targets support this many samples per pixel. One sample is always supported.
    ///
    /// # Errors
    /// [`GlError::Unsupported`], which lists the supported numbers.
    pub fn check_samples(&self, samples: u32) -> Result<(), GlError> {
        if samples == 1 || self.samples.contains(&samples) {
            return Ok(());
        }
        let possible: Vec<_> =
            [&1].into_iter().chain(self.samples.iter().rev()).map(u32::to_string).collect();
        Err(GlError::Unsupported(format!(
            "{} ({}) cannot render with {samples} samples a pixel: choose one of {}",
            self.renderer,
            self.version_string,
            possible.join(", ")
        )))
    }

    /// Returns one line for people: driver, version, features in use.
    pub fn summary(&self) -> String {
        let mut features = Vec::new();
        let mut feature = |on: bool, name: &str| {
            if on {
                features.push(name.to_owned());
            }
        };
        feature(self.compute, "compute");
        feature(self.float_render_targets, "float targets");
        feature(self.timer_queries, "timer queries");
        feature(self.multiview, "multiview");
        feature(self.clip_distances, "clip distances");
        feature(self.multisample_textures, "multisample textures");
        feature(self.sample_masks, "sample masks");
        feature(self.tile_samples, "samples in tiles");
        feature(self.max_anisotropy > 1.0, "anisotropic filtering");
        format!("{}, {} ({})", self.renderer, self.version_string, features.join(", "))
    }
}

#[cfg(test)]
mod tests {
    use super::GlApi::{Desktop, Es};

    #[test]
    fn a_contexts_version_decides_whether_shaders_run() {
        let contexts = [(Es, (2, 0)), (Es, (3, 0)), (Desktop, (3, 3)), (Desktop, (4, 3)), (Desktop, (4, 6))];
        let runs = |has| contexts.map(|(api, version)| api.runs_shaders(version, has));
        assert_eq!(runs(false), [false, true, false, false, true]);
        assert_eq!(runs(true), [false, true, false, true, true]);
    }
}
