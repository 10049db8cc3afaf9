//! Values that go by a name on the command line, with a line of help for each.

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use yoro::synthesis::Edges;
use yoro_context::Backend;
use yoro_lab::bench::Suite;
use yoro_lab::inpaint::PatcherKind;
use yoro_render::RendererKind;
use yoro_render::stereo::{AntiAliasing, Method, Pipeline};
use yoro_scene::ShadingStyle;

/// A parser of the values given, by their names.
fn choice<T: Copy + Send + Sync + 'static>(
    values: impl IntoIterator<Item = T>,
    name: fn(T) -> &'static str,
    help: fn(T) -> &'static str,
) -> impl TypedValueParser<Value = T> {
    let values: Vec<T> = values.into_iter().collect();
    let possible = values.iter().map(|&v| PossibleValue::new(name(v)).help(help(v)));
    PossibleValuesParser::new(possible).try_map(move |text| {
        values.iter().copied().find(|&v| name(v) == text).ok_or("not one of the possible values")
    })
}

/// `--gl`.
pub fn backend() -> impl TypedValueParser<Value = Backend> {
    choice(Backend::ALL, Backend::name, |backend| match backend {
        Backend::Auto => "EGL, then OSMesa",
        Backend::Egl => "OpenGL ES by EGL, without a window",
        Backend::Osmesa => "Mesa's off-screen library, desktop GL on the CPU",
    })
}

/// `--pipeline`.
pub fn pipeline() -> impl TypedValueParser<Value = Pipeline> {
    let possible = Pipeline::ALL.map(|pipeline| {
        PossibleValue::new(pipeline.name()).help(match pipeline {
            Pipeline::Gather => "Fragment shaders that march along the source row",
            Pipeline::Paper => "Algorithms 1 to 3 of the paper",
        })
    });
    // A name of earlier versions, which `Pipeline::from_str` answers with the remedy.
    let former = PossibleValue::new("rowgroup").hide(true);
    PossibleValuesParser::new(possible.into_iter().chain([former])).try_map(|name| name.parse::<Pipeline>())
}

/// `--edges`, as far as there are these.
pub fn edges(values: impl IntoIterator<Item = Edges>) -> impl TypedValueParser<Value = Edges> {
    choice(values, Edges::name, |edges| match edges {
        Edges::Nearest => {
            "Anti-aliased colour, and the depth of each pixel's nearest sample: the better of the two"
        }
        Edges::Sample => "Anti-aliased colour, and the depth of each pixel's first or middle sample",
        Edges::Multisample => "Anti-aliased colour, and the depth of every sample, of the forward renderer",
        Edges::Hard => "One surface per pixel: colour that was not anti-aliased, or was filtered afterwards",
    })
}

/// `--method`.
pub fn method() -> impl TypedValueParser<Value = Method> {
    choice(Method::ALL, Method::name, |method| match method {
        Method::Conventional => "Both eyes rendered, one after the other: the ground truth",
        Method::Instanced => "Both eyes in one set of draw calls, by instancing",
        Method::Multiview => "Both eyes in one set of draw calls, by GL_OVR_multiview2",
        Method::Hybrid => {
            "The far field rendered once for both eyes, the near field for each (Fink et al. 2019)"
        }
        Method::ShadingReprojection => {
            "The dominant eye's shading reprojected to the other eye's geometry; only disocclusions are shaded"
        }
        Method::Mono => "The dominant eye's image shown to both: the lower bound",
        Method::Yoro => "The dominant eye rendered, the other synthesized",
    })
}

/// `--anti-aliasing`.
pub fn anti_aliasing() -> impl TypedValueParser<Value = AntiAliasing> {
    choice(AntiAliasing::ALL, AntiAliasing::name, |anti_aliasing| match anti_aliasing {
        AntiAliasing::After => "After synthesis, on each eye",
        AntiAliasing::Before => "Before synthesis, on the rendered eye only, as in the paper",
        AntiAliasing::Off => "Not at all",
    })
}

/// `--renderer`.
pub fn renderer() -> impl TypedValueParser<Value = RendererKind> {
    choice(RendererKind::ALL, RendererKind::name, |renderer| match renderer {
        RendererKind::Deferred => "G-buffer, ambient occlusion, edges smoothed afterwards",
        RendererKind::Forward => {
            "Surfaces lit as they are drawn, several samples in each pixel, no ambient occlusion"
        }
    })
}

/// `--style`.
pub fn style() -> impl TypedValueParser<Value = ShadingStyle> {
    choice(ShadingStyle::ALL, ShadingStyle::name, |style| match style {
        ShadingStyle::Realistic => "GGX, smooth normals",
        ShadingStyle::Cartoon => "Few bands of light, saturated, soft outline-free",
        ShadingStyle::LowPoly => "One normal per triangle",
        ShadingStyle::Voxel => {
            "One normal per face, unfiltered textures, ambient occlusion in the foreground"
        }
        ShadingStyle::Anime => "Toon ramp with a tinted shadow side, rim light and ink outlines",
    })
}

/// `--patcher`.
pub fn patcher() -> impl TypedValueParser<Value = PatcherKind> {
    choice(PatcherKind::ALL, PatcherKind::name, |kind| match kind {
        PatcherKind::Paper => "Algorithm 3 of the paper, as corrected",
        PatcherKind::Gather => "The fill of the pipeline gather: five rows of the background's edge",
        PatcherKind::Median => "Median of the valid ones of 5x5 neighbours (Noori et al.)",
        PatcherKind::Xiao => "Background filter of 29x29 pixels (Xiao et al. 2022)",
        PatcherKind::Telea => "Fast marching (Telea 2004), on the CPU",
        PatcherKind::NavierStokes => "Isophotes carried on (Bertalmio et al. 2001), on the CPU",
        PatcherKind::Neural => "A small neural network from an ONNX file, on the CPU",
    })
}

/// The suites of `yoro bench`.
pub fn suite() -> impl TypedValueParser<Value = Suite> {
    choice(Suite::ALL.iter().copied().chain([Suite::All]), Suite::name, Suite::about)
}
