//! Parsers of named values on the command line, with a line of help for each value.

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use yoro_assets::ShadingStyle;
use yoro_bench::inpaint::PatcherKind;
use yoro_context::Backend;

/// Returns a parser that accepts these values by their names.
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

/// Parses `--gl`.
pub fn backend() -> impl TypedValueParser<Value = Backend> {
    choice(Backend::ALL, Backend::name, |backend| match backend {
        Backend::Auto => "EGL, then OSMesa",
        Backend::Egl => "OpenGL ES by EGL, without a window",
        Backend::Osmesa => "Mesa's off-screen library, desktop GL on the CPU",
    })
}

/// Parses `--style`.
pub fn style() -> impl TypedValueParser<Value = ShadingStyle> {
    choice(ShadingStyle::ALL, ShadingStyle::name, |style| match style {
        ShadingStyle::Realistic => "GGX, smooth normals",
        ShadingStyle::Cartoon => "Few bands of light, saturated colours, no outlines",
        ShadingStyle::LowPoly => "One normal per triangle",
        ShadingStyle::Voxel => {
            "One normal per face, unfiltered textures, ambient occlusion in the foreground"
        }
        ShadingStyle::Anime => "Toon ramp with a tinted shadow side, rim light and ink outlines",
    })
}

/// Parses `--patcher`.
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
