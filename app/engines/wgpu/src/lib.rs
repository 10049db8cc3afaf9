//! Renders one eye and synthesizes the other, on wgpu: the passes of [`yoro`] in the caller's command encoder.
//!
//! [`Gather`] reads the colour and depth of one eye from texture views, and draws the other eye. It is the counterpart of
//! `yoro::vulkan`, and runs the same shaders. [`yoro::eyes`] computes the view to render and the
//! [`Warp`](yoro::eyes::Warp). [`AnyView`] draws a view in any pose near the source's from a
//! [`PoseWarp`](yoro::eyes::PoseWarp), [`Motion`] makes the other eye's motion vectors, and a [`Composer`] combines the
//! layers of a foveated view into the eye that is shown. wgpu is part of the public API, and is re-exported as [`wgpu`].
//!
//! Images have wgpu's own orientation, with row 0 at the top. Pass the warp as
//! [`EyePair::synthesis_views`](yoro::eyes::EyePair::synthesis_views) returns it: its rows, which are counted from the
//! bottom, are converted internally.
//! [`SynthesisViews::dominant_crop_from_top`](yoro::eyes::SynthesisViews::dominant_crop_from_top) is the position of
//! the dominant eye's own image in the source.
//!
//! ```no_run
//! use yoro::eyes::SynthesisViews;
//! use yoro_wgpu::{Gather, Options, Source, Target, wgpu};
//!
//! # fn example(
//! #     device: &wgpu::Device, queue: &wgpu::Queue, encoder: &mut wgpu::CommandEncoder, views: &SynthesisViews,
//! #     [color, depth, target]: [&wgpu::TextureView; 3],
//! # ) -> Result<(), yoro_wgpu::WgpuError> {
//! // Once: pipelines for the target's format.
//! let options = Options { color_format: wgpu::TextureFormat::Rgba8UnormSrgb, ..Options::default() };
//! let mut gather = Gather::new(device, &options)?;
//! // Each frame, outside of passes:
//! let (source, target) = (Source::new(color, depth), Target::new(target));
//! gather.record(device, queue, encoder, &source, &views.warp, &target)?;
//! # Ok(())
//! # }
//! ```

#![forbid(unsafe_code)]

mod buffers;
mod checks;
mod composer;
mod nearest;
mod passes;
mod pipeline;
mod shaders;
mod uniforms;

pub use wgpu;
use wgpu::{TextureFormat, TextureUsages, TextureView};
pub use yoro;
use yoro::synthesis::{ArgumentError, Holes};

pub use composer::{Composer, InsetImage, LevelImage, LevelImages};
pub use nearest::NearestDepth;
pub use pipeline::{AnyView, Gather, Motion, Pipeline};

/// The errors of creating a pipeline and of recording.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum WgpuError {
    /// The device cannot use this format in this role.
    #[error(
        "the wgpu device cannot use {format:?} as {role}; choose another format, or enable the feature for it"
    )]
    Format {
        /// The format.
        format: TextureFormat,
        /// The role of the texture.
        role: &'static str,
    },
    /// A target's colour does not have the format of [`Options`].
    #[error(
        "a target of {found:?} does not fit pipelines that were made for {expected:?}; give a target of that format, or make pipelines for the other"
    )]
    OtherFormat {
        /// The format of [`Options`].
        expected: TextureFormat,
        /// The format of the target's texture.
        found: TextureFormat,
    },
    /// A target's depth does not have the format of [`Options`].
    #[error(
        "a target with {} does not fit pipelines that were made for {}; give a target like that, or make pipelines for the other",
        depth_of(.found), depth_of(.expected)
    )]
    OtherDepth {
        /// The format of [`Options`].
        expected: Option<TextureFormat>,
        /// The format of the target's texture.
        found: Option<TextureFormat>,
    },
    /// A texture was made without a usage that its role needs.
    #[error("{what} needs a texture with the usage {usage:?}; add it where the texture is created")]
    Usage {
        /// The role of the texture.
        what: &'static str,
        /// The usage that is missing.
        usage: TextureUsages,
    },
    /// A texture has several samples.
    #[error(
        "{what} of {found} samples cannot be used; give a texture of 1: resolved colour, and each pixel's nearest depth"
    )]
    Samples {
        /// The role of the texture.
        what: &'static str,
        /// The number of samples of the texture.
        found: u32,
    },
    /// The options or the target do not go with [`Options::holes`].
    #[error("holes cannot be left open here: {0}")]
    Holes(&'static str),
    /// A size or a rectangle does not fit the textures or the device.
    #[error(transparent)]
    Argument(#[from] ArgumentError),
    /// The textures of a source, or of a target, have different sizes.
    #[error(
        "{what} of {}x{} pixels does not go with colour of {}x{} pixels; give textures of one size",
        size[0], size[1], color[0], color[1]
    )]
    Sizes {
        /// The role of the other texture.
        what: &'static str,
        /// The width and height of the other texture.
        size: [u32; 2],
        /// The width and height of the colour texture.
        color: [u32; 2],
    },
    /// wgpu's OpenGL back end cannot sample a layer of a texture array, as the other back ends can.
    #[error(
        "wgpu's OpenGL back end cannot sample a layer of a texture array; take another back end, or give a texture of one layer"
    )]
    LayerOnOpenGl,
    /// wgpu refused to create a pipeline or a texture.
    #[error("wgpu cannot make the pipelines or buffers of synthesis: {0}")]
    Refused(String),
    /// The device is lost, or has no memory left even for a few bytes. Create it and all of its objects again.
    #[error("the wgpu device is lost or out of memory; create it and all of its objects again")]
    DeviceLost,
}

fn depth_of(format: &Option<TextureFormat>) -> String {
    format.map_or("no depth".into(), |format| format!("depth of {format:?}"))
}

/// The formats that pipelines are created for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Options {
    /// Format of the targets' colour: any format that the device can render to. If the view's format differs from the
    /// texture's, this is the view's.
    pub color_format: TextureFormat,
    /// Format of the targets' depth, which is written in the source's encoding. `None` for colour only.
    pub depth_format: Option<TextureFormat>,
    /// What becomes of holes, which only a [`Gather`] can leave open, and only in targets that are whole textures. With
    /// [`HoleMark::Depth`](yoro::synthesis::HoleMark::Depth), the depth format is that of the mark, and depth is no output.
    pub holes: Holes,
}

impl Default for Options {
    /// Rgba8Unorm without depth.
    fn default() -> Options {
        Options { color_format: TextureFormat::Rgba8Unorm, depth_format: None, holes: Holes::Filled }
    }
}

/// The rendered eye and its guard band. The views each show one layer and the largest mip level of 2-D textures, which
/// have the same size and the usage TEXTURE_BINDING. The size of the rendered rectangle is the warp's source size.
///
/// Every pixel counts as one surface. Of a multisampled image, give colour resolved from the samples, and the depth of
/// each pixel's nearest sample ([`NearestDepth`]). Averaged depth belongs to no surface and causes halos at all edges.
#[derive(Clone, Copy, Debug)]
pub struct Source<'a> {
    /// Colour in any filterable format: Rgba8Unorm or Rgba8UnormSrgb, Rgb10a2Unorm, Rgba16Float and others. All four
    /// channels are carried over. A source that is sampled as sRGB needs an sRGB target.
    pub color: &'a TextureView,
    /// Depth: R32Float, R16Unorm, or any depth format. If the format has stencil, the view must show the depth only
    /// ([`wgpu::TextureAspect::DepthOnly`]).
    pub depth: &'a TextureView,
    /// Upper left corner of the rendered rectangle in the textures, in pixels.
    pub origin: [u32; 2],
}

impl<'a> Source<'a> {
    /// Returns a source that begins at the upper left corner of two textures.
    pub fn new(color: &'a TextureView, depth: &'a TextureView) -> Source<'a> {
        Source { color, depth, origin: [0, 0] }
    }
}

/// The place for the other eye. The views each show one layer of 2-D textures, which have the same size and the usage
/// RENDER_ATTACHMENT. The size of the rectangle is the warp's target size.
#[derive(Clone, Copy, Debug)]
pub struct Target<'a> {
    /// Colour, in [`Options::color_format`].
    pub color: &'a TextureView,
    /// Depth, in [`Options::depth_format`], with all of its aspects. Stencil is unchanged, unless holes are left open.
    pub depth: Option<&'a TextureView>,
    /// Upper left corner of the rectangle to write in the textures, in pixels. Pixels outside it are unchanged.
    pub origin: [u32; 2],
}

impl<'a> Target<'a> {
    /// Returns a target that begins at the upper left corner of a texture, without depth.
    pub fn new(color: &'a TextureView) -> Target<'a> {
        Target { color, depth: None, origin: [0, 0] }
    }
}

/// Compiles the README's code with the documentation tests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
