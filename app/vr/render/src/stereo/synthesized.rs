//! Renders the dominant eye and synthesizes the other.

use std::rc::Rc;

use super::conventional::Conventional;
use super::finish::Finish;
use super::frame::{Frame, FrameMethod, Setup};
use super::guard_band::AutoGuardBand;
use super::kinds::StereoRenderer;
use super::method::{GuardBandUse, StereoError};
use super::near_field_policy::{FrameMode, NearFieldPolicy};
use super::near_fraction::NearFraction;
use super::options::{AntiAliasing, PipelineOptions, StereoOptions};
use super::overlay::{EyeSource, Overlay, OverlaySurfaces, SmoothedEye};
use super::pipeline::Synthesis;
use crate::render::{DrawRequest, GpuScene, Selection, ViewImages};
use yoro::eyes::{GuardBand, SynthesisViews};
use yoro::opengl::{Outputs, Source};
use yoro_gl::{Context, Destination, Filter, Format, GlError, RenderTarget};

/// One render with a guard band and one synthesis. [`StereoOptions`] decide about near objects and near frames.
pub struct Synthesized<R: StereoRenderer> {
    options: StereoOptions,
    targets: R::Targets,
    synthesizers: Synthesizers,
    auto_guard_band: Option<AutoGuardBand>,
    /// Anti-aliasing before synthesis, if the options ask for that.
    smooth: Option<SmoothedEye>,
    overlay: R::Overlay,
    finish: Finish,
    switch: Option<Switch<R>>,
}

/// Pipelines without and with depth of the synthesized eye, each made when first needed.
struct Synthesizers {
    gl: Rc<Context>,
    options: PipelineOptions,
    made: [Option<Synthesizer>; 2],
}

/// A pipeline, and the image it writes: the synthesized eye before transparent objects and anti-aliasing.
struct Synthesizer {
    synthesis: Box<dyn Synthesis>,
    image: RenderTarget,
}

/// The automatic switch to two renders.
struct Switch<R: StereoRenderer> {
    policy: NearFieldPolicy,
    mode: FrameMode,
    fraction: NearFraction,
    conventional: Conventional<R>,
}

impl Synthesizers {
    /// Returns the pipeline with or without depth, and makes it on the first call.
    fn get(&mut self, depth: bool) -> Result<&mut Synthesizer, GlError> {
        let slot = &mut self.made[usize::from(depth)];
        if let Some(made) = slot {
            return Ok(made);
        }
        let outputs = Outputs { depth, ..Outputs::default() };
        // A float depth texture can hold both conventions.
        let format = depth.then_some(Format::Depth32F);
        let image = RenderTarget::new(&self.gl, [1, 1], &[(Format::Rgba8, Filter::Linear)], format)?;
        let synthesis = self.options.create(&self.gl, outputs)?;
        Ok(slot.insert(Synthesizer { synthesis, image }))
    }
}

impl<R: StereoRenderer> Synthesized<R> {
    /// Compiles the pipeline and makes the targets.
    pub(super) fn new(setup: &Setup) -> Result<Synthesized<R>, GlError> {
        let Setup { gl, settings, options } = *setup;
        let switch = options.policy.map(|policy| -> Result<_, GlError> {
            Ok(Switch {
                policy,
                mode: FrameMode::default(),
                fraction: NearFraction::new(gl)?,
                conventional: Conventional::new(setup)?,
            })
        });
        let has_near = options.near_field.is_some();
        let is_smooth = options.anti_aliasing == AntiAliasing::Before && settings.samples() == 1;
        let is_auto = matches!(options.guard_band, GuardBand::Auto(_));
        let mut synthesizers =
            Synthesizers { gl: gl.clone(), options: options.synthesis, made: [None, None] };
        synthesizers.get(has_near)?;
        Ok(Synthesized {
            options: *options,
            targets: R::targets(gl, settings)?,
            synthesizers,
            auto_guard_band: is_auto.then(|| AutoGuardBand::new(gl)).transpose()?,
            smooth: is_smooth.then(|| SmoothedEye::new(gl)).transpose()?,
            overlay: R::Overlay::new(setup)?,
            finish: Finish::smoothing(setup, options.anti_aliasing == AntiAliasing::After)?,
            switch: switch.transpose()?,
        })
    }

    /// Renders both eyes if the last frames were mostly too near. Returns true if it did.
    fn render_both(&mut self, frame: &Frame<R>) -> Result<bool, StereoError> {
        let Some(Switch { policy, mode, fraction, conventional }) = &mut self.switch else {
            return Ok(false);
        };
        if let Some(fraction) = fraction.take() {
            *mode = policy.next(*mode, fraction);
        }
        if *mode != FrameMode::BothRendered {
            return Ok(false);
        }
        if let Some(auto) = &mut self.auto_guard_band {
            auto.interrupt();
        }
        let pair = frame.pair;
        conventional.render_eyes(
            frame,
            |eye| eye == pair.dominant,
            |eye, targets| {
                if eye == pair.dominant {
                    fraction.measure(targets.depth(), [0, 0], pair.size, &pair.depth, policy.distance);
                }
            },
        )?;
        Ok(true)
    }

    /// Returns the objects that are synthesized.
    fn selection(&self, frame: &Frame<R>) -> Selection {
        let from = frame.pair.middle();
        self.options.near_field.map_or(Selection::All, |distance| Selection::Farther { from, distance })
    }

    /// Renders the dominant eye without near objects, in the columns that are needed.
    fn render_dominant(
        &mut self,
        frame: &Frame<R>,
        views: &SynthesisViews,
        over: &OverlaySurfaces,
    ) -> Result<(), GlError> {
        let request = DrawRequest {
            selection: self.selection(frame),
            columns: self.auto_guard_band.as_mut().map(|auto| auto.columns(frame.pair, views, frame.scene)),
            keeps_samples: over.is_any(),
        };
        frame.renderer.render(&mut self.targets, frame.scene, &views.source, &request)?;
        if let Some(smooth) = &mut self.smooth {
            smooth.image.resize(views.source.size)?;
            smooth.run(self.targets.color());
        }
        Ok(())
    }

    /// Starts the measurements that later frames depend on: how wide the guard band must be, and how much of the view
    /// is near.
    fn measure(&mut self, frame: &Frame<R>, views: &SynthesisViews) {
        if let Some(auto) = &mut self.auto_guard_band {
            auto.measure(self.targets.depth(), views);
        }
        if let Some(switch) = &mut self.switch {
            // If near objects have their own layer, this is the far one: surfaces behind them are not too near.
            let (pair, distance) = (frame.pair, switch.policy.distance);
            switch.fraction.measure(
                self.targets.depth(),
                views.dominant_crop,
                pair.size,
                &pair.depth,
                distance,
            );
        }
    }
}

impl<R: StereoRenderer> FrameMethod for Synthesized<R> {
    type Renderer = R;

    fn compile(&mut self, _renderer: &mut R, scene: &GpuScene) -> Result<(), GlError> {
        let depth = scene.has_transparent() || self.options.near_field.is_some();
        self.synthesizers.get(depth)?;
        Ok(())
    }

    fn render_frame(&mut self, frame: &Frame<R>) -> Result<(), StereoError> {
        let pair = frame.pair;
        let [dominant, other] = [pair.dominant, pair.dominant.other()];
        let views = pair.synthesis_views(self.options.guard_band)?;
        if self.render_both(frame)? {
            return Ok(());
        }
        let from = pair.middle();
        let near = self.options.near_field.map(|distance| Selection::Nearer { from, distance });
        let transparent = [&views.source, &views.target].iter().any(|v| frame.scene.is_transparent_in(v));
        let over = OverlaySurfaces { near, transparent };
        self.render_dominant(frame, &views, &over)?;
        let color = self.smooth.as_ref().map_or(self.targets.color(), |smooth| &smooth.image);
        let source = Source::new(color.color(0).raw(), self.targets.depth().raw());
        // Depends on the scene, not on the view: glass that comes into view then changes neither program nor targets.
        let has_glass = frame.scene.has_transparent();
        let reads_depth = over.is_any() || frame.wants_depth(other);
        // An eye that is complete after synthesis is not copied.
        let is_complete = !reads_depth && self.finish.is_copy();
        let Synthesizer { synthesis, image } = self.synthesizers.get(reads_depth || has_glass)?;
        if !is_complete || has_glass {
            image.resize(pair.size)?;
        }
        let to = if is_complete { frame.to(other).color } else { Destination::whole(image) };
        synthesis.synthesize(source, &views.warp, &to)?;
        self.measure(frame, &views);
        let image = &self.synthesizers.get(reads_depth || has_glass)?.image;
        let eyes = [EyeSource::Rendered(self.smooth.as_ref()), EyeSource::Synthesized(image)];
        let unfinished = if is_complete { 1 } else { 2 };
        for (eye, source) in [dominant, other].into_iter().zip(eyes).take(unfinished) {
            let drawn = self.overlay.draw(frame, &views, &over, &self.targets, source)?;
            self.finish.run(&drawn, frame.to(eye));
        }
        Ok(())
    }

    fn guard_band_use(&self) -> Option<GuardBandUse> {
        self.auto_guard_band.as_ref()?.last()
    }

    fn has_rendered_both(&self) -> bool {
        self.switch.as_ref().is_some_and(|switch| switch.mode == FrameMode::BothRendered)
    }
}
