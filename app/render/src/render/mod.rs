//! One view of a scene: colour and depth, rendered the deferred way or the forward way.
//!
//! Deferred: sun shadow map (once per scene) -> g-buffer -> ambient occlusion -> lighting -> bloom -> tone mapping. What
//! belongs to the finished image of one eye comes after synthesis: [`Fxaa`] and the transparent surfaces
//! ([`Renderer::draw_transparent`]).
//!
//! Forward, with several samples in each pixel: sun shadow map -> lit surfaces -> average of the samples -> bloom and
//! outlines. What comes after synthesis is drawn into the same samples ([`Renderer::go_on`]).

mod bloom;
mod cluster;
mod deferred;
mod depth_copy;
mod forward;
#[cfg(test)]
mod forward_tests;
mod fxaa;
mod g_buffer;
mod geometry;
mod light_tiles;
mod lighting;
mod role;
mod scene;
mod settings;
mod shadow;
mod ssao;
#[cfg(test)]
mod tests;
mod tonemap;
mod transparent;
mod uniforms;

use std::rc::Rc;

use glam::Vec3;

use cluster::Culler;
pub use cluster::Selection;
use deferred::{Deferred, DeferredTargets};
pub(crate) use deferred::{FinishTargets, LightTargets};
pub use depth_copy::DepthCopy;
use forward::{Forward, ForwardTargets, Illumination, Kept, Part};
pub use fxaa::Fxaa;
pub(crate) use g_buffer::{GBuffer, Layout, Seam};
use light_tiles::LightTiles;
pub(crate) use role::{Reprojection, Role, RoleKind};
use scene::FREE_UNIT;
pub use scene::GpuScene;
pub use settings::{MAX_POINT_LIGHTS, MSAA, RenderSettings, RendererKind};
use shadow::ShadowMap;
pub use transparent::DepthImage;
use transparent::{Onto, TransparentPass};
use uniforms::Lights;
pub(crate) use uniforms::depth_test;

use yoro::eyes::{DepthConvention, DepthRange, Eye, Frustum, View};
use yoro_gl::{Context, Destination, GlError, RenderTarget, Texture};

/// Columns of a view of which not all are needed, each `[first, end]` from the left.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Columns {
    /// Those that are drawn. In the others depth is the far plane's, and colour that of the nearest column that is drawn.
    pub drawn: [u32; 2],
    /// Those that are drawn in every frame. Ambient occlusion and bloom do not reach into them from beside, so that they
    /// do not depend on what is drawn there.
    pub always: [u32; 2],
}

/// The images of one view, up to final colour.
pub struct ViewTargets {
    images: Images,
}

enum Images {
    Deferred(Box<DeferredTargets>),
    Forward(Box<ForwardTargets>),
}

impl ViewTargets {
    /// Targets for views of `size` pixels with the given depth, for renderers of these settings.
    ///
    /// # Errors
    /// As [`RenderTarget::new`]; [`GlError::Unsupported`] when the driver has not as many samples as the settings say.
    pub fn new(
        gl: &Rc<Context>,
        size: [u32; 2],
        convention: DepthConvention,
        settings: &RenderSettings,
    ) -> Result<ViewTargets, GlError> {
        let images = match settings.renderer {
            RendererKind::Deferred => {
                Images::Deferred(Box::new(DeferredTargets::new(gl, size, convention, settings)?))
            }
            RendererKind::Forward => {
                Images::Forward(Box::new(ForwardTargets::new(gl, Layout::Single, size, settings)?))
            }
        };
        Ok(ViewTargets { images })
    }

    /// Targets for both eyes at once, of a forward renderer.
    ///
    /// # Errors
    /// As [`ViewTargets::new`].
    pub(crate) fn of_both_eyes(
        gl: &Rc<Context>,
        layout: Layout,
        settings: &RenderSettings,
    ) -> Result<ViewTargets, GlError> {
        let targets = ForwardTargets::new(gl, layout, [1, 1], settings)?;
        Ok(ViewTargets { images: Images::Forward(Box::new(targets)) })
    }

    /// Says which columns of a view [`Renderer::render`] draws; at first all of them, `None`. The images have
    /// the view's size all the same.
    pub fn set_columns(&mut self, columns: Option<Columns>) {
        match &mut self.images {
            Images::Deferred(targets) => targets.light.columns = columns,
            Images::Forward(targets) => targets.columns = columns,
        }
    }

    fn columns(&self) -> Option<Columns> {
        match &self.images {
            Images::Deferred(targets) => targets.light.columns,
            Images::Forward(targets) => targets.columns,
        }
    }

    /// Says which samples are still needed when a view is rendered, to be read or to go on drawing
    /// (as transparent objects do after synthesis); at first none are. The others never leave the tiles of a tile-based GPU, as far as its driver
    /// can help it. Means nothing to a deferred renderer.
    pub fn keep_samples(&mut self, color: bool, depth: bool) {
        if let Images::Forward(targets) = &mut self.images {
            targets.kept = Kept { color, depth };
        }
    }

    /// Says whether [`ViewTargets::depth`] is wanted when [`Renderer::render`] has rendered a view; at first it is. Where it
    /// is not, a forward renderer with several samples in each pixel does not spend anything on it. Means nothing to a
    /// deferred renderer.
    pub fn keep_depth(&mut self, depth: bool) {
        if let Images::Forward(targets) = &mut self.images {
            targets.keeps_depth = depth;
        }
    }

    /// Makes [`ViewTargets::depth`] that of each pixel's first sample, as drivers resolve it, instead of the nearest one's:
    /// for synthesis from what there is without multisample textures. Means nothing to a deferred renderer.
    pub fn set_first_sample(&mut self, first: bool) {
        if let Images::Forward(targets) = &mut self.images {
            targets.first_sample = first;
        }
    }

    /// Width and height in pixels.
    pub fn size(&self) -> [u32; 2] {
        self.color_target().size()
    }

    /// Display-referred sRGB colour with luma in alpha, filtered linearly. With several samples in each pixel, alpha is
    /// undefined where something is cut out by a texture.
    pub fn color(&self) -> &Texture {
        self.color_target().color(0)
    }

    /// The framebuffer of [`ViewTargets::color`], to read it or to draw over it.
    pub fn color_target(&self) -> &RenderTarget {
        match &self.images {
            Images::Deferred(targets) => targets.finish.color(),
            Images::Forward(targets) => targets.color(),
        }
    }

    /// Window depth in the view's convention. Deferred: 24 bits for standard, float for reversed depth. Forward: float,
    /// the nearest of each pixel's samples; that of one of them without multisample textures (OpenGL ES 3.0), and after
    /// [`Renderer::render_all`] where samples stay in tiles.
    ///
    /// # Panics
    /// When a forward renderer has not rendered anything, or, with several samples in each pixel, was told that depth is not
    /// wanted ([`ViewTargets::keep_depth`], [`Renderer::render_all`]).
    pub fn depth(&self) -> &Texture {
        match &self.images {
            Images::Deferred(targets) => targets.g_buffer.target().depth(),
            Images::Forward(targets) => targets.depth(),
        }
    }

    /// The window depth of every sample, a `TEXTURE_2D_MULTISAMPLE` of [`RenderSettings::msaa`] samples in float: of a
    /// forward renderer with more than one, where there are such textures and they are kept
    /// ([`ViewTargets::keep_samples`]). Opaque surfaces only, until transparent ones are drawn after synthesis.
    pub fn depth_samples(&self) -> Option<glow::Texture> {
        match &self.images {
            Images::Deferred(_) => None,
            Images::Forward(targets) => targets.depth_samples(),
        }
    }

    /// The colour of every sample, likewise. None where bloom or outlines are added to their average.
    pub fn color_samples(&self) -> Option<glow::Texture> {
        match &self.images {
            Images::Deferred(_) => None,
            Images::Forward(targets) => targets.color_samples(),
        }
    }
}

/// Renders views of one scene: its programs, made for the scene's style and materials, and the scene's shadow
/// map. Single views are ready after [`Renderer::new`]; what a stereo method needs besides is compiled once, with
/// its first frame of the scene or when [`crate::stereo::StereoMethod::prepare`] asks for it. Nothing is compiled
/// or allocated after that.
pub struct Renderer {
    gl: Rc<Context>,
    settings: RenderSettings,
    scene_id: u64,
    shadow: Option<ShadowMap>,
    passes: Passes,
    transparent: TransparentPass,
}

enum Passes {
    Deferred(Box<Deferred>),
    Forward(Box<Forward>),
}

/// What a renderer of one kind says to targets of the other.
fn other_kind() -> GlError {
    GlError::Unsupported(
        "these targets were made for another kind of renderer: make both with the same settings".into(),
    )
}

impl Renderer {
    /// Compiles the programs for a scene and draws its shadow map.
    ///
    /// # Errors
    /// [`GlError`] when the driver refuses a program or a target, or has not as many samples as the settings say.
    pub fn new(gl: &Rc<Context>, settings: &RenderSettings, scene: &GpuScene) -> Result<Renderer, GlError> {
        let passes = match settings.renderer {
            RendererKind::Deferred => Passes::Deferred(Box::new(Deferred::new(gl, settings, scene)?)),
            RendererKind::Forward => Passes::Forward(Box::new(Forward::new(gl, settings, scene)?)),
        };
        Renderer::with(gl, settings, scene, passes)
    }

    fn with(
        gl: &Rc<Context>,
        settings: &RenderSettings,
        scene: &GpuScene,
        passes: Passes,
    ) -> Result<Renderer, GlError> {
        let shadow = (scene.has_sun() && settings.shadow_map_size > 0)
            .then(|| ShadowMap::new(gl, scene, settings.shadow_map_size))
            .transpose()?;
        let mut renderer = Renderer {
            gl: gl.clone(),
            settings: settings.clone(),
            scene_id: scene.id,
            shadow,
            passes,
            transparent: TransparentPass::new(gl, scene, settings)?,
        };
        renderer.prepare(scene, Layout::Single, &[RoleKind::Whole])?;
        Ok(renderer)
    }

    /// The settings it was made with.
    pub fn settings(&self) -> &RenderSettings {
        &self.settings
    }

    fn belongs_to(&self, scene: &GpuScene) -> Result<(), GlError> {
        if scene.id == self.scene_id {
            return Ok(());
        }
        Err(GlError::Unsupported(format!(
            "this renderer was made for another scene than {}; make one for each scene",
            scene.name
        )))
    }

    /// Compiles what views of these kinds need; nothing is done for what is there already. A forward renderer has no
    /// roles.
    ///
    /// # Errors
    /// [`GlError::Unsupported`] for another scene than the renderer was made for; as [`yoro_gl::Program::new`].
    pub(crate) fn prepare(
        &mut self,
        scene: &GpuScene,
        layout: Layout,
        roles: &[RoleKind],
    ) -> Result<(), GlError> {
        self.belongs_to(scene)?;
        match &mut self.passes {
            Passes::Deferred(passes) => {
                if layout == Layout::Layered {
                    self.transparent.prepare_layered(scene, &self.settings)?;
                }
                passes.prepare(scene, layout, roles)
            }
            Passes::Forward(passes) => passes.prepare(scene, layout),
        }
    }

    /// Renders the opaque part of a scene: colour and depth in `targets`, which are fitted to the view. Where
    /// nothing is drawn, depth keeps its far value and colour is the sky.
    ///
    /// # Errors
    /// [`GlError::Unsupported`] for another scene than the renderer was made for, or targets of another kind; as
    /// [`RenderTarget::new`] when the targets have to change their size.
    pub fn render(
        &self,
        targets: &mut ViewTargets,
        scene: &GpuScene,
        view: &View,
        selection: Selection,
    ) -> Result<(), GlError> {
        self.belongs_to(scene)?;
        // All columns need no bound.
        let drawn =
            targets.columns().map(|columns| columns.drawn).filter(|drawn| *drawn != [0, view.size[0]]);
        let culler = culler(&drawn.map_or(*view, |drawn| of_columns(view, drawn)), selection);
        match (&self.passes, &mut targets.images) {
            (Passes::Deferred(passes), Images::Deferred(targets)) => {
                targets.fit(view)?;
                self.gl.within_columns(drawn, || {
                    passes.draw_selected(&targets.g_buffer, scene, view, &culler);
                    self.light(&targets.light, &targets.g_buffer, scene, view, Role::Whole);
                });
                self.finish(&targets.finish, &targets.light);
                Ok(())
            }
            (Passes::Forward(passes), Images::Forward(targets)) => {
                targets.fit(view.size, passes.develops(), false)?;
                self.gl.within_columns(drawn, || {
                    self.draw_forward(passes, targets, scene, &[*view], &Part::Selected(&culler));
                });
                passes.resolve(targets, view, targets.keeps_depth);
                if let Some(drawn) = drawn {
                    targets.repeat_columns(drawn)?;
                }
                passes.develop(targets, view, Eye::Left, false);
                Ok(())
            }
            _ => Err(other_kind()),
        }
    }

    /// Renders all of a scene, transparent surfaces too. With `depth` the targets have that of the opaque ones
    /// afterwards; without, a forward renderer does not spend anything on it.
    ///
    /// # Errors
    /// As [`Renderer::render`].
    pub fn render_all(
        &self,
        targets: &mut ViewTargets,
        scene: &GpuScene,
        view: &View,
        depth: bool,
    ) -> Result<(), GlError> {
        if !self.settings.is_forward() {
            self.render(targets, scene, view, Selection::All)?;
            if !scene.has_transparent() {
                return Ok(());
            }
            let to = Destination::whole(targets.color_target());
            return self.draw_transparent(&to, DepthImage::whole(targets.depth()), scene, view);
        }
        self.belongs_to(scene)?;
        let (Passes::Forward(passes), Images::Forward(targets)) = (&self.passes, &mut targets.images) else {
            return Err(other_kind());
        };
        targets.fit(view.size, passes.develops(), !passes.reads_samples())?;
        let culler = culler(view, Selection::All);
        self.draw_forward(passes, targets, scene, &[*view], &Part::Selected(&culler));
        self.draw_transparent_forward(passes, targets, scene, &[*view]);
        passes.resolve(targets, view, depth);
        passes.develop(targets, view, Eye::Left, false);
        Ok(())
    }

    /// Goes on with a view that a forward renderer has rendered, in the samples that were kept: near objects and
    /// transparent surfaces, as they come after synthesis. Colour is renewed, and with `depth` the depth.
    ///
    /// # Errors
    /// As [`Renderer::render`].
    pub(crate) fn go_on(
        &self,
        targets: &ViewTargets,
        scene: &GpuScene,
        view: &View,
        near: Option<Selection>,
        depth: bool,
    ) -> Result<(), GlError> {
        self.belongs_to(scene)?;
        let (Passes::Forward(passes), Images::Forward(targets)) = (&self.passes, &targets.images) else {
            return Err(other_kind());
        };
        self.draw_after_synthesis(passes, targets, scene, view, near);
        passes.resolve(targets, view, depth);
        passes.develop(targets, view, Eye::Left, near.is_none());
        Ok(())
    }

    /// As [`Renderer::go_on`], with an image that is not rendered: colour of 8 bits and float depth, of the view's size.
    /// The targets are those of a view that is no smaller; what they hold is gone afterwards.
    ///
    /// # Errors
    /// As [`Renderer::render`].
    pub(crate) fn go_on_with(
        &self,
        targets: &ViewTargets,
        image: &RenderTarget,
        scene: &GpuScene,
        view: &View,
        near: Option<Selection>,
        depth: bool,
    ) -> Result<(), GlError> {
        self.belongs_to(scene)?;
        let (Passes::Forward(passes), Images::Forward(targets)) = (&self.passes, &targets.images) else {
            return Err(other_kind());
        };
        self.gl.pass("load", || {
            passes.load(targets, (image.color(0), image.depth()), [0, 0], view);
            passes.soften(targets, image.depth(), [0, 0], view);
        });
        self.draw_after_synthesis(passes, targets, scene, view, near);
        passes.resolve_to(targets, image, view, depth);
        Ok(())
    }

    /// Renders, with a forward renderer, what lies in a slice (near and far plane in metres) and the sky behind it: the
    /// beginning of [`Renderer::render_near`], without bloom and outlines.
    ///
    /// # Errors
    /// As [`Renderer::render`].
    pub(crate) fn render_far(
        &self,
        targets: &mut ViewTargets,
        scene: &GpuScene,
        view: &View,
        slice: [f32; 2],
    ) -> Result<(), GlError> {
        self.belongs_to(scene)?;
        let (Passes::Forward(passes), Images::Forward(targets)) = (&self.passes, &mut targets.images) else {
            return Err(other_kind());
        };
        targets.fit(view.size, false, false)?;
        self.draw_forward(passes, targets, scene, &[*view], &Part::Slice(slice));
        passes.resolve(targets, view, true);
        Ok(())
    }

    /// Renders, with a forward renderer, what lies in a slice, over the part of another view whose lower left corner is
    /// given; and transparent surfaces over both. With `depth` the targets have that of opaque surfaces afterwards.
    ///
    /// # Errors
    /// As [`Renderer::render`].
    pub(crate) fn render_near(
        &self,
        targets: &mut ViewTargets,
        scene: &GpuScene,
        view: &View,
        slice: Option<[f32; 2]>,
        (far, crop): (&ViewTargets, [u32; 2]),
        depth: bool,
    ) -> Result<(), GlError> {
        self.belongs_to(scene)?;
        let (Passes::Forward(passes), Images::Forward(targets), Images::Forward(far)) =
            (&self.passes, &mut targets.images, &far.images)
        else {
            return Err(other_kind());
        };
        targets.fit(view.size, passes.develops(), !passes.reads_samples())?;
        let views = std::slice::from_ref(view);
        self.gl.pass("forward", || {
            passes.load(targets, (far.resolved().color(0), far.depth()), crop, view);
            if let Some(slice) = slice {
                self.illuminate(Layout::Single, scene, views, view, |light| {
                    passes.draw(targets, light, views, &Part::Slice(slice));
                });
            }
        });
        self.draw_transparent_forward(passes, targets, scene, views);
        passes.resolve(targets, view, depth);
        passes.develop(targets, view, Eye::Left, false);
        Ok(())
    }

    /// Renders both eyes at once with a forward renderer: all of the scene, side by side in targets of such a layout. With
    /// `depth` these have that of opaque surfaces afterwards. [`Renderer::develop_eye`] ends each eye.
    ///
    /// # Errors
    /// As [`Renderer::render`].
    pub(crate) fn render_both(
        &self,
        targets: &mut ViewTargets,
        scene: &GpuScene,
        views: &[View; 2],
        depth: bool,
    ) -> Result<(), GlError> {
        self.belongs_to(scene)?;
        let (Passes::Forward(passes), Images::Forward(targets)) = (&self.passes, &mut targets.images) else {
            return Err(other_kind());
        };
        let view = &views[0];
        targets.fit(view.size, passes.develops(), !passes.reads_samples())?;
        let whole = [view.depth.near, view.depth.far];
        self.draw_forward(passes, targets, scene, views, &Part::Slice(whole));
        self.draw_transparent_forward(passes, targets, scene, views);
        passes.resolve(targets, view, depth);
        Ok(())
    }

    /// The image of an eye that [`Renderer::render_both`] has rendered, with the lower left corner of the eye in it. It is
    /// there until another eye is asked for.
    ///
    /// # Errors
    /// [`GlError::Unsupported`] for targets of another kind.
    pub(crate) fn develop_eye<'a>(
        &self,
        targets: &'a ViewTargets,
        view: &View,
        eye: Eye,
    ) -> Result<(&'a RenderTarget, [u32; 2]), GlError> {
        let (Passes::Forward(passes), Images::Forward(targets)) = (&self.passes, &targets.images) else {
            return Err(other_kind());
        };
        passes.develop(targets, view, eye, false);
        Ok((targets.color(), targets.origin(view.size, eye)))
    }

    /// Whether anything opaque may be seen in a slice of a view (near and far plane in metres).
    pub(crate) fn sees_any(&self, scene: &GpuScene, view: &View, [near, far]: [f32; 2]) -> bool {
        let view = View { depth: DepthRange { near, far, ..view.depth }, ..*view };
        let culler = culler(&view, Selection::All);
        scene.opaque().any(|(_, clusters)| clusters.iter().any(|c| culler.sees(&c.bounds)))
    }

    /// Clears a g-buffer and draws one view, or both eyes, into it. Only what lies in `slice` (metres) is drawn;
    /// `mark` may mark pixels before that. The g-buffer fits the views, and its layout is prepared.
    pub(crate) fn draw(
        &self,
        g_buffer: &GBuffer,
        scene: &GpuScene,
        views: &[View],
        slice: Option<[f32; 2]>,
        mark: impl FnOnce(&RenderTarget),
    ) {
        if let Passes::Deferred(passes) = &self.passes {
            passes.draw(g_buffer, scene, views, slice, mark);
        }
    }

    /// Lights a view of a g-buffer: ambient occlusion and scene-referred colour. The targets fit the view, and its
    /// role is prepared.
    pub(crate) fn light(
        &self,
        targets: &LightTargets,
        g_buffer: &GBuffer,
        scene: &GpuScene,
        view: &View,
        role: Role,
    ) {
        if let Passes::Deferred(passes) = &self.passes {
            let (lights, shadow) = (self.lights(scene, std::slice::from_ref(view)), self.shadow.as_ref());
            passes.light(targets, g_buffer, shadow, scene, view, &lights, role);
        }
    }

    /// Bloom and tone mapping: scene-referred to display-referred colour.
    pub(crate) fn finish(&self, targets: &FinishTargets, light: &LightTargets) {
        if let Passes::Deferred(passes) = &self.passes {
            passes.finish(targets, light);
        }
    }

    /// The lights of some views, relative to the first.
    fn lights(&self, scene: &GpuScene, views: &[View]) -> Lights {
        let eye = views.first().map_or(Vec3::ZERO, |view| view.pose.position);
        // One of each for an eye; what a single view does not use repeats the first.
        let cullers: [Culler; 2] =
            std::array::from_fn(|i| culler(views.get(i).unwrap_or(&views[0]), Selection::All));
        Lights::choose(&scene.lights, eye, &cullers[..views.len()], self.settings.point_lights)
    }

    /// Empties forward targets and draws a part of the scene, and the sky behind it.
    fn draw_forward(
        &self,
        passes: &Forward,
        targets: &ForwardTargets,
        scene: &GpuScene,
        views: &[View],
        part: &Part,
    ) {
        let Some(first) = views.first() else { return };
        self.gl.pass("forward", || {
            passes.clear(targets, first);
            self.illuminate(targets.layout(), scene, views, first, |light| {
                passes.draw(targets, light, views, part);
                passes.draw_sky(targets, light, views);
            });
        });
    }

    /// Calls `draw` with what lights these views in an image of this layout, for positions relative to one of them.
    fn illuminate(
        &self,
        layout: Layout,
        scene: &GpuScene,
        views: &[View],
        from: &View,
        draw: impl FnOnce(&Illumination),
    ) {
        let lights = self.lights(scene, views);
        let eye = from.pose.position;
        draw(&Illumination {
            scene,
            shadow: self.shadow.as_ref(),
            tiles: &LightTiles::new(&lights, layout, views),
            lights: &lights.seen_from(eye),
            eye,
            exposure: self.settings.exposure,
        });
    }

    /// Draws near objects and transparent surfaces into forward targets of one view.
    fn draw_after_synthesis(
        &self,
        passes: &Forward,
        targets: &ForwardTargets,
        scene: &GpuScene,
        view: &View,
        near: Option<Selection>,
    ) {
        let views = std::slice::from_ref(view);
        if let Some(near) = near {
            let culler = culler(view, near);
            self.gl.pass("near objects", || {
                self.illuminate(Layout::Single, scene, views, view, |light| {
                    passes.draw(targets, light, views, &Part::Selected(&culler));
                });
            });
        }
        self.draw_transparent_forward(passes, targets, scene, views);
    }

    /// Draws the transparent surfaces of each view into forward targets.
    fn draw_transparent_forward(
        &self,
        passes: &Forward,
        targets: &ForwardTargets,
        scene: &GpuScene,
        views: &[View],
    ) {
        if !scene.has_transparent() {
            return;
        }
        for (view, eye) in views.iter().zip(Eye::BOTH) {
            passes.bind_eye(targets, view, eye);
            self.illuminate(targets.layout(), scene, views, view, |light| {
                let all = culler(view, Selection::All);
                self.transparent.run(Onto::Bound, scene, view, &all, |program| light.set(program));
            });
        }
    }

    /// Draws the transparent part of a scene over a finished image of `view`, whose window depth is `depth`: of a deferred
    /// renderer, or one that is synthesized from its views.
    ///
    /// # Errors
    /// [`GlError::Unsupported`] for another scene than the renderer was made for.
    pub fn draw_transparent(
        &self,
        to: &Destination,
        depth: DepthImage,
        scene: &GpuScene,
        view: &View,
    ) -> Result<(), GlError> {
        self.belongs_to(scene)?;
        let lights = self.lights(scene, std::slice::from_ref(view));
        let onto = Onto::Image(to, depth);
        self.transparent.run(onto, scene, view, &culler(view, Selection::All), |program| {
            program.set("exposure", self.settings.exposure);
            if let Some(shadow) = &self.shadow {
                shadow.set(program, FREE_UNIT + 1, view.pose.position);
            }
            lights.set(program, &scene.sky);
        });
        Ok(())
    }
}

/// The part of a view that some of its columns show, `[first, end]` from the left.
fn of_columns(view: &View, [first, end]: [u32; 2]) -> View {
    let tangent = view.frustum.width() / view.size[0] as f32;
    let left = view.frustum.left + first as f32 * tangent;
    let right = view.frustum.left + end as f32 * tangent;
    View {
        frustum: Frustum { left, right, ..view.frustum },
        size: [end.saturating_sub(first), view.size[1]],
        ..*view
    }
}

/// What a view sees of a selection.
fn culler(view: &View, selection: Selection) -> Culler {
    Culler::new(view.pose.position, &uniforms::eye_to_clip(view), selection)
}
