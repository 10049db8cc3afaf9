//! Checks of what the caller passes against what the device and the pipelines can use.

use wgpu::{
    Backend, Device, Features, TextureFormat, TextureFormatFeatureFlags, TextureFormatFeatures,
    TextureSampleType, TextureUsages, TextureView,
};
use yoro::synthesis::backend::{check_rectangle, check_size};
use yoro::synthesis::{HoleMark, Holes};

use crate::{Options, Source, Target, WgpuError};

/// The abilities of the device and the options of the pipelines.
pub(crate) struct Checks {
    pub(crate) options: Options,
    features: Features,
    /// Largest width and height of a texture.
    limit: [u32; 2],
    /// True for wgpu's OpenGL back end. It has no texture views, so it cannot sample a single layer of an array.
    opengl: bool,
}

impl Checks {
    /// Checks that the device supports what the options request.
    pub(crate) fn new(device: &Device, options: &Options) -> Result<Checks, WgpuError> {
        let checks = Checks {
            options: *options,
            features: device.features(),
            limit: [device.limits().max_texture_dimension_2d; 2],
            opengl: device.adapter_info().backend == Backend::Gl,
        };
        let drawn = |features: TextureFormatFeatures| {
            features.allowed_usages.contains(TextureUsages::RENDER_ATTACHMENT)
        };
        let (color, role) = (options.color_format, "a target's colour");
        let is_float = matches!(color.sample_type(None, None), Some(TextureSampleType::Float { .. }));
        if !is_float || color.is_depth_stencil_format() {
            return Err(WgpuError::Format { format: color, role });
        }
        checks.format(color, role, drawn)?;
        if let Some(format) = options.depth_format {
            let role = "a target's depth";
            if !format.has_depth_aspect() {
                return Err(WgpuError::Format { format, role });
            }
            checks.format(format, role, drawn)?;
        }
        checks.holes()?;
        Ok(checks)
    }

    /// Checks that open holes can be marked.
    fn holes(&self) -> Result<(), WgpuError> {
        let refuse = |what| Err(WgpuError::Holes(what));
        match (self.options.holes, self.options.depth_format) {
            (Holes::Open(_), None) => refuse("there is no depth for the mark; give a depth format"),
            (Holes::Open(HoleMark::Stencil), Some(format)) if !format.has_stencil_aspect() => {
                refuse("the depth format has no stencil for the mark; choose Depth24PlusStencil8")
            }
            _ => Ok(()),
        }
    }

    /// Checks a format against what all devices with these features support. With adapter-specific features only the
    /// adapter knows, and wgpu reports what is wrong.
    fn format(
        &self,
        format: TextureFormat,
        role: &'static str,
        fits: impl Fn(TextureFormatFeatures) -> bool,
    ) -> Result<(), WgpuError> {
        let enabled = self.features.contains(format.required_features());
        let own = self.features.contains(Features::TEXTURE_ADAPTER_SPECIFIC_FORMAT_FEATURES);
        if enabled && (own || fits(format.guaranteed_format_features(self.features))) {
            Ok(())
        } else {
            Err(WgpuError::Format { format, role })
        }
    }

    /// Checks the arguments of one call.
    pub(crate) fn frame(
        &self,
        source: &Source,
        [source_size, target_size]: [[u32; 2]; 2],
        target: &Target,
    ) -> Result<(), WgpuError> {
        check_size("a source", source_size, self.limit)?;
        check_size("a target", target_size, self.limit)?;
        self.source(source)?;
        self.target(target)?;
        check_rectangle("a source", source.origin, source_size, size(source.color))?;
        check_rectangle("a target", target.origin, target_size, size(target.color))?;
        if self.options.holes.is_open() && target_size != size(target.color) {
            let what = "the target is a part of its textures; give textures of the target's size";
            return Err(WgpuError::Holes(what));
        }
        Ok(())
    }

    /// Checks a colour that is filtered, and a depth of the same size.
    fn source(&self, source: &Source) -> Result<(), WgpuError> {
        self.color(source.color, "a source's colour")?;
        self.depth(source.depth, "a source's depth", source.color)
    }

    /// Checks a colour that is filtered.
    pub(crate) fn color(&self, color: &TextureView, role: &'static str) -> Result<(), WgpuError> {
        let filtered =
            |features: TextureFormatFeatures| features.flags.contains(TextureFormatFeatureFlags::FILTERABLE);
        self.format(color.texture().format(), role, filtered)?;
        self.sampled(color, role, color)
    }

    /// Checks a depth of the size of a colour.
    pub(crate) fn depth(
        &self,
        depth: &TextureView,
        role: &'static str,
        color: &TextureView,
    ) -> Result<(), WgpuError> {
        let format = depth.texture().format();
        let is_float =
            matches!(format, TextureFormat::R32Float | TextureFormat::R16Unorm | TextureFormat::R16Float);
        if !is_float && !format.has_depth_aspect() {
            return Err(WgpuError::Format { format, role });
        }
        self.sampled(depth, role, color)
    }

    fn sampled(&self, view: &TextureView, role: &'static str, color: &TextureView) -> Result<(), WgpuError> {
        check_texture(role, view, TextureUsages::TEXTURE_BINDING, color)?;
        if self.opengl && view.texture().depth_or_array_layers() > 1 {
            return Err(WgpuError::LayerOnOpenGl);
        }
        Ok(())
    }

    pub(crate) fn target(&self, target: &Target) -> Result<(), WgpuError> {
        let format = |view: &TextureView| view.texture().format();
        // A view may be sRGB although its texture is not. Only wgpu knows the format of a view.
        let (expected, found) = (self.options.color_format, format(target.color));
        if expected.remove_srgb_suffix() != found.remove_srgb_suffix() {
            return Err(WgpuError::OtherFormat { expected, found });
        }
        let (expected, found) = (self.options.depth_format, target.depth.map(format));
        if expected != found {
            return Err(WgpuError::OtherDepth { expected, found });
        }
        let textures = [("a target's colour", Some(target.color)), ("a target's depth", target.depth)];
        for (what, view) in textures {
            let Some(view) = view else { continue };
            check_texture(what, view, TextureUsages::RENDER_ATTACHMENT, target.color)?;
        }
        Ok(())
    }
}

fn check_texture(
    what: &'static str,
    view: &TextureView,
    usage: TextureUsages,
    color: &TextureView,
) -> Result<(), WgpuError> {
    let (texture, of_color) = (view.texture(), size(color));
    if !texture.usage().contains(usage) {
        return Err(WgpuError::Usage { what, usage });
    }
    if texture.sample_count() != 1 {
        return Err(WgpuError::Samples { what, found: texture.sample_count() });
    }
    if size(view) != of_color {
        return Err(WgpuError::Sizes { what, size: size(view), color: of_color });
    }
    Ok(())
}

/// Returns the width and height of a view's texture.
pub(crate) fn size(view: &TextureView) -> [u32; 2] {
    [view.texture().width(), view.texture().height()]
}

/// Creates objects, and returns the first error that wgpu reports about them. In browsers errors arrive later, at the
/// device's handler of uncaptured errors.
pub(crate) fn made<T>(device: &Device, make: impl FnOnce() -> T) -> Result<T, WgpuError> {
    if cfg!(target_arch = "wasm32") {
        return Ok(make());
    }
    let filters =
        [wgpu::ErrorFilter::Internal, wgpu::ErrorFilter::OutOfMemory, wgpu::ErrorFilter::Validation];
    let mut scopes = filters.map(|filter| Some(device.push_error_scope(filter)));
    let objects = make();
    let mut first = None;
    // The innermost scope must be popped first.
    for scope in scopes.iter_mut().rev().filter_map(Option::take) {
        let mut popped = std::pin::pin!(scope.pop());
        let mut context = std::task::Context::from_waker(std::task::Waker::noop());
        if let std::task::Poll::Ready(Some(error)) = popped.as_mut().poll(&mut context) {
            first = first.or(Some(error));
        }
    }
    match first {
        Some(error) => {
            Err(WgpuError::Refused(error.to_string().split_whitespace().collect::<Vec<_>>().join(" ")))
        }
        None => Ok(objects),
    }
}
