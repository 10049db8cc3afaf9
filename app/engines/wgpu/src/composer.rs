//! An eye made of its levels.

use wgpu::{
    BindGroup, BindGroupDescriptor, BindGroupEntry, BindingResource, CommandEncoder, Device, FilterMode,
    Queue, Sampler, TextureFormat, TextureView,
};
use yoro::eyes::Composition;
use yoro::synthesis::backend::check_rectangle;
use yoro::synthesis::{LevelPlaces, LevelUniforms};

use crate::checks::{Checks, made, size};
use crate::passes::{self, Drawn, Pass};
use crate::pipeline::KEPT_CALLS;
use crate::uniforms::UniformRing;
use crate::{Options, Target, WgpuError};

/// The image of a level: one layer of a 2-D texture with the usage TEXTURE_BINDING, in any filterable format.
#[derive(Clone, Copy, Debug)]
pub struct LevelImage<'a> {
    /// Colour.
    pub color: &'a TextureView,
    /// Upper left corner of the level in the texture, in pixels.
    pub origin: [u32; 2],
}

impl<'a> LevelImage<'a> {
    /// Returns a level that begins at the upper left corner of its texture.
    pub fn new(color: &'a TextureView) -> LevelImage<'a> {
        LevelImage { color, origin: [0, 0] }
    }
}

/// The images of an inset.
#[derive(Clone, Copy, Debug)]
pub struct InsetImage<'a> {
    /// Colour, and its place.
    pub image: LevelImage<'a>,
    /// The depth of a synthesized inset, which shows where it has holes at its border. Its texture has the colour's size.
    pub depth: Option<&'a TextureView>,
}

/// The images of an eye's levels.
#[derive(Clone, Copy, Debug)]
pub struct LevelImages<'a> {
    /// The wide level.
    pub wide: LevelImage<'a>,
    /// The inset, for a [`Composition`] that has one.
    pub inset: Option<InsetImage<'a>>,
}

impl LevelImages<'_> {
    /// Returns the textures in the order of their bindings. Every binding needs one, even one that is not sampled.
    fn views(&self) -> [&TextureView; 3] {
        let wide = self.wide.color;
        let depth = self.inset.and_then(|inset| inset.depth);
        [depth.unwrap_or(wide), wide, self.inset.map_or(wide, |inset| inset.image.color)]
    }
}

/// A pass that makes an eye from its levels: the inset where it covers the eye and has no hole at the border of what was
/// rendered, else the wide view, bilinearly.
///
/// Up to 64 calls may be recorded before the first of them is submitted.
pub struct Composer {
    checks: Checks,
    pass: Pass,
    nearest: Sampler,
    linear: Sampler,
    uniforms: UniformRing<LevelUniforms>,
    kept: Vec<Kept>,
    calls: u64,
}

/// The bindings that were created for an eye's levels.
struct Kept {
    views: [TextureView; 3],
    group: BindGroup,
    /// The number of the last call that used them.
    used: u64,
}

impl Composer {
    /// Creates the pipeline for targets of this colour format.
    ///
    /// # Errors
    /// Those of [`Pipeline::new`](crate::Pipeline::new).
    pub fn new(device: &Device, color_format: TextureFormat) -> Result<Composer, WgpuError> {
        let checks = Checks::new(device, &Options { color_format, ..Options::default() })?;
        made(device, || Composer {
            checks,
            pass: passes::compose(device, color_format),
            nearest: passes::sampler(device, "yoro nearest", FilterMode::Nearest),
            linear: passes::sampler(device, "yoro linear", FilterMode::Linear),
            uniforms: UniformRing::new(device, "yoro levels"),
            kept: Vec::new(),
            calls: 0,
        })
    }

    /// Records the pass, outside of render passes, and overwrites a rectangle of the composition's size. The target is
    /// without depth and none of the levels' textures. Bindings are kept for the next calls with the same views, until 32
    /// calls in a row were without them.
    ///
    /// # Errors
    /// A [`WgpuError`] if the arguments do not fit, or [`WgpuError::DeviceLost`]. Nothing is recorded then.
    pub fn record(
        &mut self,
        device: &Device,
        queue: &Queue,
        encoder: &mut CommandEncoder,
        images: &LevelImages,
        composition: &Composition,
        target: &Target,
    ) -> Result<(), WgpuError> {
        let inset = composition.inset.zip(images.inset);
        let composition = Composition { inset: inset.map(|(inset, _)| inset), ..*composition };
        let images = LevelImages { inset: inset.map(|(_, images)| images), ..*images };
        self.check(&images, &composition, target)?;
        let wide_image = size(images.wide.color);
        let places = LevelPlaces {
            target: target.origin,
            wide: images.wide.origin,
            wide_image,
            inset: images.inset.map_or([0, 0], |inset| inset.image.origin),
            inset_image: images.inset.map_or([1, 1], |inset| size(inset.image.color)),
            depth: images.inset.is_some_and(|inset| inset.depth.is_some()),
        };
        let block = LevelUniforms::rows_from_top(&composition, &places);
        let uniforms = self.uniforms.write(queue, &block)?;
        self.calls += 1;
        let index = self.bound(device, &images);
        let ([x, y], [width, height]) = (target.origin, composition.size);
        let whole = size(target.color) == composition.size;
        let drawn =
            Drawn { color: target.color, depth: None, area: [x, y, width, height], whole, marks: None };
        self.pass.draw(encoder, &self.kept[index].group, uniforms, &drawn);
        Ok(())
    }

    fn check(
        &self,
        images: &LevelImages,
        composition: &Composition,
        target: &Target,
    ) -> Result<(), WgpuError> {
        self.checks.color(images.wide.color, "a wide level")?;
        let wide = size(images.wide.color);
        check_rectangle("a wide level", images.wide.origin, composition.wide.size, wide)?;
        if let Some((inset, images)) = composition.inset.zip(images.inset) {
            self.checks.color(images.image.color, "an inset")?;
            let image = size(images.image.color);
            check_rectangle("an inset", images.image.origin, inset.place.size, image)?;
            if let Some(depth) = images.depth {
                self.checks.depth(depth, "an inset's depth", images.image.color)?;
            }
        }
        self.checks.target(target)?;
        check_rectangle("an eye", target.origin, composition.size, size(target.color))?;
        Ok(())
    }

    /// Returns the index of the levels' bindings in `kept`.
    fn bound(&mut self, device: &Device, images: &LevelImages) -> usize {
        let (calls, views) = (self.calls, images.views());
        self.kept.retain(|kept| kept.used + KEPT_CALLS >= calls);
        let found = self.kept.iter().position(|kept| kept.views.each_ref() == views);
        let index = found.unwrap_or(self.kept.len());
        if found.is_none() {
            let group = self.group(device, views);
            self.kept.push(Kept { views: views.map(Clone::clone), group, used: calls });
        }
        self.kept[index].used = calls;
        index
    }

    fn group(&self, device: &Device, views: [&TextureView; 3]) -> BindGroup {
        let textures = views.map(BindingResource::TextureView);
        let [nearest, linear] = [&self.nearest, &self.linear].map(BindingResource::Sampler);
        let resources = textures.into_iter().chain([self.uniforms.binding(), nearest, linear]);
        let entries: Vec<_> = self.pass.entries(resources).collect();
        device.create_bind_group(&BindGroupDescriptor {
            label: Some(self.pass.label),
            layout: &self.pass.layout,
            entries: &entries,
        })
    }
}

impl Pass {
    /// Returns the entries of a bind group, whose resources are in the order of the bindings.
    fn entries<'a>(
        &'a self,
        resources: impl Iterator<Item = BindingResource<'a>> + 'a,
    ) -> impl Iterator<Item = BindGroupEntry<'a>> {
        self.bindings.iter().zip(resources).map(|(&binding, resource)| BindGroupEntry { binding, resource })
    }
}
