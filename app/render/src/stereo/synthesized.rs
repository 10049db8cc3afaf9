//! The dominant eye rendered, the other one synthesized.

use std::rc::Rc;

use super::conventional::Conventional;
use super::finish::Finish;
use super::method::{EyeTarget, StereoError, StereoMethod};
use super::near_field::{Composite, NearFraction};
use super::options::{AntiAliasing, StereoOptions};
use crate::render::{DepthImage, GpuScene, RenderSettings, Renderer, Selection, ViewTargets};
use yoro::eyes::{DepthConvention, EyePair, SynthesisViews};
use yoro::gl::{Context, Destination, Filter, Format, GlError, RenderTarget};
use yoro::synthesis::{
    self, Edges, FrameMode, NearFieldPolicy, Outputs, Source, Synthesis, SynthesisOptions,
};

/// One render (with a guard band), one synthesis; near objects and mostly near frames as [`StereoOptions`] say.
pub struct Yoro {
    options: StereoOptions,
    edges: Edges,
    targets: ViewTargets,
    synthesis: Box<dyn Synthesis>,
    /// The synthesized eye before transparent objects and anti-aliasing: colour and depth.
    other: RenderTarget,
    /// The rendered eye after anti-aliasing, when that comes before synthesis.
    smooth: Option<RenderTarget>,
    before: Finish,
    after: Finish,
    near_layer: Option<NearLayer>,
    switch: Option<Switch>,
}

/// The hybrid near field of the deferred renderer: its own targets for the near objects, and for what they are composited
/// into.
struct NearLayer {
    targets: ViewTargets,
    composite: Composite,
    /// Dominant eye with guard band, other eye.
    layers: [RenderTarget; 2],
}

/// The automatic switch to two real renders.
struct Switch {
    policy: NearFieldPolicy,
    mode: FrameMode,
    fraction: NearFraction,
    conventional: Conventional,
}

fn layer(gl: &Rc<Context>) -> Result<RenderTarget, GlError> {
    // A float depth texture can hold both conventions.
    RenderTarget::new(gl, [1, 1], &[(Format::Rgba8, Filter::Linear)], Some(Format::Depth32F))
}

impl Yoro {
    /// Compiles the pipeline and makes the targets.
    ///
    /// # Errors
    /// [`GlError`] when the driver cannot run the pipeline.
    pub fn new(
        gl: &Rc<Context>,
        settings: &RenderSettings,
        options: &StereoOptions,
    ) -> Result<Yoro, GlError> {
        let targets = || ViewTargets::new(gl, [1, 1], DepthConvention::Standard, settings);
        let outputs = Outputs { depth: true, ..Outputs::default() };
        let smooth = (options.anti_aliasing == AntiAliasing::Before && settings.samples() == 1)
            .then(|| RenderTarget::new(gl, [1, 1], &[(Format::Rgba8, Filter::Linear)], None));
        let layered = options.near_field.filter(|_| !settings.is_forward());
        let near_layer = layered.map(|_| -> Result<_, GlError> {
            let layers = [layer(gl)?, layer(gl)?];
            Ok(NearLayer { targets: targets()?, composite: Composite::new(gl)?, layers })
        });
        let switch = options.policy.map(|policy| -> Result<_, GlError> {
            Ok(Switch {
                policy,
                mode: FrameMode::default(),
                fraction: NearFraction::new(gl)?,
                conventional: Conventional::new(gl, settings, options)?.keeping_depth(),
            })
        });
        let edges = options.edges(settings, gl.capabilities())?;
        let mut source = targets()?;
        source.set_first_sample(edges == Edges::Sample);
        let synthesis = SynthesisOptions { edges, ..options.synthesis };
        Ok(Yoro {
            options: *options,
            edges,
            targets: source,
            synthesis: synthesis::create(gl, &synthesis, outputs)?,
            other: layer(gl)?,
            smooth: smooth.transpose()?,
            before: Finish::new(gl, settings, options.anti_aliasing == AntiAliasing::Before)?,
            after: Finish::new(gl, settings, options.anti_aliasing == AntiAliasing::After)?,
            near_layer: near_layer.transpose()?,
            switch: switch.transpose()?,
        })
    }

    /// Renders the dominant eye and synthesizes the other into `self.other`.
    fn synthesize(
        &mut self,
        renderer: &mut Renderer,
        scene: &GpuScene,
        pair: &EyePair,
        views: &SynthesisViews,
    ) -> Result<(), StereoError> {
        let from = pair.middle();
        let selection = match self.options.near_field {
            Some(distance) => Selection::Farther { from, distance },
            None => Selection::All,
        };
        let goes_on = scene.has_transparent() || self.options.near_field.is_some();
        self.targets.keep_samples(goes_on, goes_on || self.edges == Edges::Multisample);
        renderer.render(&mut self.targets, scene, &views.source, selection)?;
        let mut color = self.targets.color();
        if let Some(smooth) = &mut self.smooth {
            smooth.resize(views.source.size)?;
            self.before.color(self.targets.color_target(), [0, 0], &Destination::whole(smooth));
            color = smooth.color(0);
        }
        self.other.resize(pair.size)?;
        let depth = self.targets.depth_samples().filter(|_| self.edges == Edges::Multisample);
        let source = Source {
            color: color.raw(),
            depth: depth.unwrap_or(self.targets.depth().raw()),
            samples: self.targets.color_samples(),
        };
        self.synthesis.synthesize(source, &views.warp, &Destination::whole(&self.other))?;
        Ok(())
    }
}

impl Yoro {
    /// Draws near objects and transparent ones into the samples of the rendered eye, then into those of the other eye,
    /// which begins as it was synthesized; ends both eyes.
    fn complete_forward(
        &mut self,
        renderer: &Renderer,
        scene: &GpuScene,
        pair: &EyePair,
        views: &SynthesisViews,
        to: &[EyeTarget; 2],
    ) -> Result<(), StereoError> {
        let from = pair.middle();
        let near = self.options.near_field.map(|distance| Selection::Nearer { from, distance });
        let goes_on = scene.has_transparent() || near.is_some();
        let [dominant_to, other_to] = [pair.dominant, pair.dominant.other()].map(|eye| &to[eye.index()]);
        let near_depth = |to: &EyeTarget| near.is_some() && to.depth.is_some();
        // The eye is rendered once more from here on, and smoothed again if it was before.
        if goes_on {
            renderer.go_on(&self.targets, scene, &views.source, near, near_depth(dominant_to))?;
        }
        let dominant = match &self.smooth {
            Some(smooth) => {
                if goes_on {
                    let whole = Destination::whole(smooth);
                    self.before.color(self.targets.color_target(), [0, 0], &whole);
                }
                smooth
            }
            None => self.targets.color_target(),
        };
        self.after.color(dominant, views.dominant_crop, &dominant_to.color);
        let depth = DepthImage { origin: views.dominant_crop, ..DepthImage::whole(self.targets.depth()) };
        Finish::depth(depth, dominant_to);
        if goes_on {
            let depth = near_depth(other_to);
            renderer.go_on_with(&self.targets, &self.other, scene, &views.target, near, depth)?;
        }
        self.after.color(&self.other, [0, 0], &other_to.color);
        Finish::depth(DepthImage::whole(self.other.depth()), other_to);
        Ok(())
    }
}

impl StereoMethod for Yoro {
    fn render_to(
        &mut self,
        renderer: &mut Renderer,
        scene: &GpuScene,
        pair: &EyePair,
        to: &[EyeTarget; 2],
    ) -> Result<(), StereoError> {
        if let Some(switch) = &mut self.switch {
            if let Some(fraction) = switch.fraction.take() {
                switch.mode = switch.policy.next(switch.mode, fraction);
            }
            if switch.mode == FrameMode::BothRendered {
                switch.conventional.render_to(renderer, scene, pair, to)?;
                let depth = switch.conventional.depth();
                switch.fraction.measure(depth, [0, 0], pair.size, &pair.depth, switch.policy.distance);
                return Ok(());
            }
        }
        let views = pair.synthesis(self.options.guard_band)?;
        self.synthesize(renderer, scene, pair, &views)?;
        if let Some(switch) = &mut self.switch {
            // Of the far layer alone when near objects have their own: what they hide is not too near.
            let (depth, distance) = (self.targets.depth(), switch.policy.distance);
            switch.fraction.measure(depth, views.dominant_crop, pair.size, &pair.depth, distance);
        }
        if renderer.settings().is_forward() {
            return self.complete_forward(renderer, scene, pair, &views, to);
        }
        let mut dominant = self.smooth.as_ref().unwrap_or(self.targets.color_target());
        let mut dominant_depth = self.targets.depth();
        let mut other = &self.other;
        if let (Some(near), Some(distance)) = (&mut self.near_layer, self.options.near_field) {
            let selection = Selection::Nearer { from: pair.middle(), distance };
            let far = [(dominant.color(0), dominant_depth), (other.color(0), other.depth())];
            for (i, view) in [&views.source, &views.target].into_iter().enumerate() {
                renderer.render(&mut near.targets, scene, view, selection)?;
                near.layers[i].resize(view.size)?;
                near.composite.run(far[i], &near.targets, pair.depth.convention, &near.layers[i]);
            }
            dominant = &near.layers[0];
            dominant_depth = near.layers[0].depth();
            other = &near.layers[1];
        }
        if scene.has_transparent() {
            for (image, depth, view) in
                [(dominant, dominant_depth, &views.source), (other, other.depth(), &views.target)]
            {
                // Depth is read in the shader, so only the colour of the layer may be attached.
                renderer.draw_transparent(&image.color_only(), DepthImage::whole(depth), scene, view)?;
            }
        }
        let crop = views.dominant_crop;
        let cropped = DepthImage { origin: crop, ..DepthImage::whole(dominant_depth) };
        let depth = DepthImage::whole(other.depth());
        let [dominant_to, other_to] = [pair.dominant, pair.dominant.other()].map(|eye| &to[eye.index()]);
        self.after.color(dominant, crop, &dominant_to.color);
        Finish::depth(cropped, dominant_to);
        self.after.color(other, [0, 0], &other_to.color);
        Finish::depth(depth, other_to);
        Ok(())
    }
}
