//! Renders one eye and synthesizes the other, on wgpu: the passes of [`yoro`] in the caller's command encoder.
//!
//! [`Gather`] takes colour and depth of one eye as texture views, and draws the other eye. It is the counterpart of
//! `yoro::vulkan`, and uses the same shaders. [`yoro::eyes`] computes which view to render, and the
//! [`Warp`](yoro::eyes::Warp). [`AnyView`] is used in the same way, with a [`PoseWarp`](yoro::eyes::PoseWarp), and
//! draws a view in any pose near that of the source. wgpu is part of the public API, and is re-exported as [`wgpu`].
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
mod passes;
mod pipeline;
mod shaders;
mod uniforms;

pub use wgpu;
use wgpu::{TextureFormat, TextureUsages, TextureView};
pub use yoro;
use yoro::synthesis::{Edges, Strips};

pub use pipeline::{AnyView, Gather, Pipeline};

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
    /// A texture does not have the number of samples that its role needs.
    #[error("{what} of {found} samples cannot be used; give a texture of {expected}")]
    Samples {
        /// The role of the texture.
        what: &'static str,
        /// The required number.
        expected: u32,
        /// The number of samples of the texture.
        found: u32,
    },
    /// The number of depth samples in [`Options`] is not 2 or 4.
    #[error("a source's depth of {0} samples cannot be used; give 4, or 2 where the device has that")]
    SampleCount(u32),
    /// A source has multisampled colour, which only [`Edges::Multisample`] uses.
    #[error("colour of samples is for edges of multisample textures only; leave out sample_color")]
    SampleColors,
    /// A size is zero or exceeds the device's limit.
    #[error(
        "{what} of {}x{} pixels is not between 1x1 and {}x{}; give a size in that range, or a device with larger limits",
        size[0], size[1], limit[0], limit[1]
    )]
    Size {
        /// The image that has the size.
        what: &'static str,
        /// The width and height.
        size: [u32; 2],
        /// The largest width and height.
        limit: [u32; 2],
    },
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
    /// A source has a history, but [`Options::history`] is off.
    #[error("a history is for pipelines made with one; set Options::history, or give none")]
    History,
    /// [`AnyView`] was requested with edges other than [`Edges::Hard`], or with a history.
    #[error("any view is synthesized from hard edges, without a history; choose these")]
    AnyView,
    /// A rectangle extends beyond its image.
    #[error(
        "{what} of {}x{} pixels at ({}, {}) reaches beyond its image of {}x{} pixels",
        size[0], size[1], origin[0], origin[1], image[0], image[1]
    )]
    Rectangle {
        /// The role of the rectangle.
        what: &'static str,
        /// Upper left corner.
        origin: [u32; 2],
        /// Width and height.
        size: [u32; 2],
        /// Width and height of the image.
        image: [u32; 2],
    },
    /// wgpu's OpenGL back end cannot sample something that the other back ends can.
    #[error("wgpu's OpenGL back end cannot sample {what}; take another back end, or give {instead}")]
    OpenGl {
        /// What it cannot sample.
        what: &'static str,
        /// What it can sample.
        instead: &'static str,
    },
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

/// The formats and the kind of sources that pipelines are created for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Options {
    /// Format of the targets' colour: any format that the device can render to. If the view's format differs from the
    /// texture's, this is the view's.
    pub color_format: TextureFormat,
    /// Format of the targets' depth, which is written in the source's encoding. `None` for colour only.
    pub depth_format: Option<TextureFormat>,
    /// The kind of source images; docs/library.md says which to choose.
    pub edges: Edges,
    /// Samples in each pixel of a source's depth for [`Edges::Multisample`]: 4, or 2 if the device supports that.
    pub samples: u32,
    /// True if sources may have a history ([`Source::history`]).
    pub history: bool,
}

impl Default for Options {
    /// Rgba8Unorm without depth, hard edges, no history.
    fn default() -> Options {
        Options {
            color_format: TextureFormat::Rgba8Unorm,
            depth_format: None,
            edges: Edges::Hard,
            samples: 4,
            history: false,
        }
    }
}

/// The rendered eye and its guard band. The views each show one layer and the largest mip level of 2-D textures, which
/// have the same size and the usage TEXTURE_BINDING. The size of the rendered rectangle is the warp's source size.
#[derive(Clone, Copy, Debug)]
pub struct Source<'a> {
    /// Colour in any filterable format: Rgba8Unorm or Rgba8UnormSrgb, Rgb10a2Unorm, Rgba16Float and others. All four
    /// channels are carried over. A source that is sampled as sRGB needs an sRGB target. With edges other than
    /// [`Edges::Hard`] this is the resolved image, with values between 0 and 1.
    pub color: &'a TextureView,
    /// Depth: R32Float, R16Unorm, or any depth format. If the format has stencil, the view must show the depth only
    /// ([`wgpu::TextureAspect::DepthOnly`]). For [`Edges::Multisample`] it has [`Options::samples`] samples.
    pub depth: &'a TextureView,
    /// For [`Edges::Multisample`], the texture with as many samples that the colour was resolved from, if it still
    /// exists.
    pub sample_color: Option<&'a TextureView>,
    /// Upper left corner of the rendered rectangle in the textures, in pixels.
    pub origin: [u32; 2],
    /// The history, for pipelines with [`Options::history`].
    pub history: Option<History<'a>>,
}

/// A rendered image of the synthesized eye, from this frame or earlier ones. Disocclusions are filled from it. The
/// views each show one layer and the largest mip level of 2-D textures, of the same size (any), with the usage
/// TEXTURE_BINDING.
#[derive(Clone, Copy, Debug)]
pub struct History<'a> {
    /// Colour, in any filterable format and in the encoding of the source's colour. It must show only what the source
    /// shows, and nothing that is drawn over both eyes after synthesis.
    pub color: &'a TextureView,
    /// Depth in one of the formats of [`Source::depth`], with one value per pixel and the planes and encoding of the
    /// source.
    pub depth: &'a TextureView,
    /// The views of its strips, beginning at the top, as [`Strips::new`] returns them. Their rows, which are counted
    /// from the bottom, are converted internally.
    pub strips: Strips,
}

impl<'a> Source<'a> {
    /// Returns a source that begins at the upper left corner of two textures, without multisampled colour or a history.
    pub fn new(color: &'a TextureView, depth: &'a TextureView) -> Source<'a> {
        Source { color, depth, sample_color: None, origin: [0, 0], history: None }
    }
}

/// The place for the other eye. The views each show one layer of 2-D textures, which have the same size and the usage
/// RENDER_ATTACHMENT. The size of the rectangle is the warp's target size.
#[derive(Clone, Copy, Debug)]
pub struct Target<'a> {
    /// Colour, in [`Options::color_format`].
    pub color: &'a TextureView,
    /// Depth, in [`Options::depth_format`], with all of its aspects. Stencil is unchanged.
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
