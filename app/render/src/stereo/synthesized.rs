//! The dominant eye rendered, the other one synthesized.

use std::rc::Rc;

use super::conventional::Conventional;
use super::finish::Finish;
use super::guard_band::AutoGuardBand;
use super::method::{EyeTarget, GuardBandUse, StereoError, StereoMethod};
use super::near_field::{Composite, DepthMap, NearFraction};
use super::near_field_policy::{FrameMode, NearFieldPolicy};
use super::options::{AntiAliasing, StereoOptions};
use crate::render::{DepthImage, GpuScene, RenderSettings, Renderer, Selection, ViewTargets};
use yoro::eyes::{DepthConvention, EyePair, GuardBand, SynthesisViews};
use yoro::synthesis::{Edges, Outputs, Source, Synthesis};
use yoro_gl::{Context, Destination, Filter, Format, GlError, RenderTarget};

/// One render (with a guard band), one synthesis; near objects and mostly near frames as [`StereoOptions`] say.
pub struct Yoro {
    gl: Rc<Context>,
    options: StereoOptions,
    edges: Edges,
    targets: ViewTargets,
    /// Without and with depth of the synthesized eye; those that were asked for so far.
    synthesizers: [Option<Synthesizer>; 2],
    auto_guard_band: Option<AutoGuardBand>,
    /// The rendered eye after anti-aliasing, when that comes before synthesis.
    smooth: Option<RenderTarget>,
    before: Finish,
    after: Finish,
    near_layer: Option<NearLayer>,
    switch: Option<Switch>,
}

/// A pipeline, and what it writes: the synthesized eye before transparent objects and anti-aliasing.
struct Synthesizer {
    synthesis: Box<dyn Synthesis>,
    image: RenderTarget,
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

fn layer(gl: &Rc<Context>, depth: bool) -> Result<RenderTarget, GlError> {
    // A float depth texture can hold both conventions.
    let depth = depth.then_some(Format::Depth32F);
    RenderTarget::new(gl, [1, 1], &[(Format::Rgba8, Filter::Linear)], depth)
}

impl Synthesizer {
    fn new(
        gl: &Rc<Context>,
        options: &StereoOptions,
        edges: Edges,
        depth: bool,
    ) -> Result<Synthesizer, GlError> {
        let outputs = Outputs { depth, ..Outputs::default() };
        let synthesis = options.synthesis.create(gl, edges, outputs)?;
        Ok(Synthesizer { synthesis, image: layer(gl, depth)? })
    }
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
        let smooth = (options.anti_aliasing == AntiAliasing::Before && settings.samples() == 1)
            .then(|| RenderTarget::new(gl, [1, 1], &[(Format::Rgba8, Filter::Linear)], None));
        let layered = options.near_field.filter(|_| !settings.is_forward());
        let near_layer = layered.map(|_| -> Result<_, GlError> {
            let layers = [layer(gl, true)?, layer(gl, true)?];
            Ok(NearLayer { targets: targets()?, composite: Composite::new(gl)?, layers })
        });
        let edges = options.edges(settings, gl.capabilities())?;
        let reads_samples = edges == Edges::Multisample && gl.capabilities().multisample_textures;
        let switch = options.policy.map(|policy| -> Result<_, GlError> {
            Ok(Switch {
                policy,
                mode: FrameMode::default(),
                fraction: NearFraction::new(gl, reads_samples)?,
                conventional: Conventional::new(gl, settings, options)?.keeping_depth(),
            })
        });
        let mut source = targets()?;
        source.set_first_sample(edges == Edges::Sample);
        let auto = matches!(options.guard_band, GuardBand::Auto(_)).then(|| AutoGuardBand::new(gl));
        let mut yoro = Yoro {
            gl: gl.clone(),
            options: *options,
            edges,
            targets: source,
            synthesizers: [None, None],
            auto_guard_band: auto.transpose()?,
            smooth: smooth.transpose()?,
            before: Finish::new(gl, settings, options.anti_aliasing == AntiAliasing::Before)?,
            after: Finish::new(gl, settings, options.anti_aliasing == AntiAliasing::After)?,
            near_layer: near_layer.transpose()?,
            switch: switch.transpose()?,
        };
        yoro.make_synthesizer(options.near_field.is_some())?;
        Ok(yoro)
    }

    /// Whether something is drawn over the synthesized eye, tested against its depth.
    fn goes_on(&self, scene: &GpuScene) -> bool {
        scene.has_transparent() || self.options.near_field.is_some()
    }

    /// Makes the pipeline with or without depth, if there is none yet.
    fn make_synthesizer(&mut self, depth: bool) -> Result<(), GlError> {
        let slot = &mut self.synthesizers[usize::from(depth)];
        if slot.is_none() {
            *slot = Some(Synthesizer::new(&self.gl, &self.options, self.edges, depth)?);
        }
        Ok(())
    }

    /// The depth of every sample, if that is what is read of the rendered eye.
    fn depth_samples(&self) -> Option<glow::Texture> {
        self.targets.depth_samples().filter(|_| self.edges == Edges::Multisample)
    }

    /// Renders the dominant eye and synthesizes the other, with its depth or without. `to`: where the dominant eye is
    /// wanted.
    fn synthesize(
        &mut self,
        renderer: &mut Renderer,
        scene: &GpuScene,
        pair: &EyePair,
        views: &SynthesisViews,
        depth: bool,
        to: &EyeTarget,
    ) -> Result<(), StereoError> {
        let from = pair.middle();
        let selection = match self.options.near_field {
            Some(distance) => Selection::Farther { from, distance },
            None => Selection::All,
        };
        let goes_on = self.goes_on(scene);
        self.make_synthesizer(depth)?;
        let columns = self.auto_guard_band.as_mut().map(|auto| auto.columns(pair, views));
        self.targets.set_columns(columns);
        let multisample = self.edges == Edges::Multisample;
        self.targets.keep_samples(goes_on, goes_on || multisample);
        // With near objects, which are drawn after synthesis, another depth is handed on.
        let handed_on = to.depth.is_some() && self.options.near_field.is_none();
        self.targets.keep_depth(!multisample || self.auto_guard_band.is_some() || handed_on);
        renderer.render(&mut self.targets, scene, &views.source, selection)?;
        let mut color = self.targets.color();
        if let Some(smooth) = &mut self.smooth {
            smooth.resize(views.source.size)?;
            self.before.color(self.targets.color_target(), [0, 0], &Destination::whole(smooth));
            color = smooth.color(0);
        }
        let source = Source {
            color: color.raw(),
            depth: self.depth_samples().unwrap_or_else(|| self.targets.depth().raw()),
            samples: self.targets.color_samples(),
        };
        if let Some(Synthesizer { synthesis, image }) = &mut self.synthesizers[usize::from(depth)] {
            image.resize(pair.size)?;
            synthesis.synthesize(source, &views.warp, &Destination::whole(image))?;
        }
        if let Some(auto) = &mut self.auto_guard_band {
            auto.measure(self.targets.depth(), views);
        }
        Ok(())
    }
}

impl Yoro {
    /// Draws near objects and transparent ones into the samples of the rendered eye, then into those of the other eye,
    /// which begins as it was synthesized; ends both eyes. `depth`: as for [`Yoro::synthesize`].
    fn complete_forward(
        &mut self,
        renderer: &Renderer,
        scene: &GpuScene,
        pair: &EyePair,
        views: &SynthesisViews,
        depth: bool,
        to: &[EyeTarget; 2],
    ) -> Result<(), StereoError> {
        let Some(Synthesizer { image: other, .. }) = &self.synthesizers[usize::from(depth)] else {
            return Ok(());
        };
        let from = pair.middle();
        let near = self.options.near_field.map(|distance| Selection::Nearer { from, distance });
        let goes_on = self.goes_on(scene);
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
        let origin = views.dominant_crop;
        Finish::depth(|| DepthImage { origin, ..DepthImage::whole(self.targets.depth()) }, dominant_to);
        if goes_on {
            let depth = near_depth(other_to);
            renderer.go_on_with(&self.targets, other, scene, &views.target, near, depth)?;
        }
        self.after.color(other, [0, 0], &other_to.color);
        Finish::depth(|| DepthImage::whole(other.depth()), other_to);
        Ok(())
    }
}

impl Yoro {
    /// Composites near objects, draws transparent ones over both eyes, and ends both. `depth`: as for
    /// [`Yoro::synthesize`].
    fn complete_deferred(
        &mut self,
        renderer: &mut Renderer,
        scene: &GpuScene,
        pair: &EyePair,
        views: &SynthesisViews,
        depth: bool,
        to: &[EyeTarget; 2],
    ) -> Result<(), StereoError> {
        let Some(Synthesizer { image, .. }) = &self.synthesizers[usize::from(depth)] else { return Ok(()) };
        let mut dominant = self.smooth.as_ref().unwrap_or(self.targets.color_target());
        let mut dominant_depth = self.targets.depth();
        let mut other = image;
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
        // From here on nothing reads the guard band.
        let origins = [views.dominant_crop, [0, 0]];
        let eyes = [pair.dominant, pair.dominant.other()];
        if scene.has_transparent() {
            let images = [(dominant, dominant_depth), (other, other.depth())];
            for (((image, depth), origin), eye) in images.into_iter().zip(origins).zip(eyes) {
                // Depth is read in the shader, so only the colour of the layer may be attached.
                let onto = Destination { origin, size: pair.size, ..image.color_only() };
                let depth = DepthImage { origin, ..DepthImage::whole(depth) };
                renderer.draw_transparent(&onto, depth, scene, &pair.view(eye))?;
            }
        }
        let [dominant_to, other_to] = eyes.map(|eye| &to[eye.index()]);
        self.after.color(dominant, views.dominant_crop, &dominant_to.color);
        let cropped = DepthImage { origin: views.dominant_crop, ..DepthImage::whole(dominant_depth) };
        Finish::depth(|| cropped, dominant_to);
        self.after.color(other, [0, 0], &other_to.color);
        Finish::depth(|| DepthImage::whole(other.depth()), other_to);
        Ok(())
    }
}

impl StereoMethod for Yoro {
    fn prepare(&mut self, _renderer: &mut Renderer, scene: &GpuScene) -> Result<(), StereoError> {
        Ok(self.make_synthesizer(self.goes_on(scene))?)
    }

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
                if let Some(auto) = &mut self.auto_guard_band {
                    auto.interrupt();
                }
                switch.conventional.render_to(renderer, scene, pair, to)?;
                let depth = DepthMap::Resolved(switch.conventional.depth());
                switch.fraction.measure(depth, [0, 0], pair.size, &pair.depth, switch.policy.distance);
                return Ok(());
            }
        }
        let views = pair.synthesis(self.options.guard_band)?;
        let reads_depth = self.goes_on(scene) || to[pair.dominant.other().index()].depth.is_some();
        let dominant_to = &to[pair.dominant.index()];
        self.synthesize(renderer, scene, pair, &views, reads_depth, dominant_to)?;
        let samples = self.depth_samples();
        if let Some(switch) = &mut self.switch {
            // Of the far layer alone when near objects have their own: what they hide is not too near.
            let resolved = || DepthMap::Resolved(self.targets.depth());
            let depth = samples.map_or_else(resolved, DepthMap::Samples);
            let distance = switch.policy.distance;
            switch.fraction.measure(depth, views.dominant_crop, pair.size, &pair.depth, distance);
        }
        match renderer.settings().is_forward() {
            true => self.complete_forward(renderer, scene, pair, &views, reads_depth, to),
            false => self.complete_deferred(renderer, scene, pair, &views, reads_depth, to),
        }
    }

    fn guard_band(&self) -> Option<GuardBandUse> {
        self.auto_guard_band.as_ref()?.last()
    }
}
