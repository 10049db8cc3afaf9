//! Stereo cameras: the view that they render, and the cameras that belong to them.

use bevy::camera::visibility::{RenderLayers, VisibilitySystems};
use bevy::camera::{
    CameraMainTextureUsages, CameraUpdateSystems, ClearColorConfig, NormalizedRenderTarget, RenderTarget,
};
use bevy::ecs::query::QueryData;
use bevy::ecs::system::SystemParam;
use bevy::light::SimulationLightSystems;
use bevy::pbr::update_previous_view_data;
use bevy::prelude::*;
use bevy::render::camera::NormalizedRenderTargetExt;
use bevy::render::render_resource::{TextureFormat, TextureUsages};
use bevy::render::texture::ManualTextureViews;
use bevy::window::{Monitor, OnMonitor, PresentMode, PrimaryWindow};
use yoro_wgpu::yoro::choice::StereoPath;
use yoro_wgpu::yoro::eyes::{
    self, DepthConvention, DepthRange, EyeOptions, EyePair, GuardBand, Pose, StereoViews, View,
};

use crate::auto::AutoChoice;
use crate::levels::{Foveation, Views, levels};
use crate::plan::{Holes, Plan, Rendering, StereoMode};
use crate::projection::EyeProjection;
use crate::shared::{EyeCamera, EyeCameras, Role, ShareSystems};

/// The orders of the cameras that belong to a stereo camera, relative to its own order: by [`Role`], and that of the screen.
const ORDERS: [isize; 3] = [1, 1, 2];
const SCREEN_ORDER: isize = 3;

/// One of the two eyes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Reflect)]
#[reflect(Default, Debug, PartialEq, Hash, Clone)]
pub enum Eye {
    /// The left eye.
    Left,
    /// The right eye.
    #[default]
    Right,
}

impl From<Eye> for eyes::Eye {
    fn from(eye: Eye) -> eyes::Eye {
        match eye {
            Eye::Left => eyes::Eye::Left,
            Eye::Right => eyes::Eye::Right,
        }
    }
}

/// Renders stereo from this `Camera3d`, whose transform is the head's. Both eyes are written side by side to the
/// camera's render target, each to one half of its width. Distances are in the camera's unit, which is the world's
/// unless a parent is scaled.
///
/// While this component is present, the plugin controls the camera's projection and render target. To show the eyes
/// elsewhere, set the target again. Post-processing, anti-aliasing and similar settings are those of the camera. When
/// the component is removed, the camera gets its target back, and a perspective projection.
#[derive(Component, Clone, Debug, PartialEq, Reflect)]
#[reflect(Component, Default, Debug, PartialEq, Clone)]
#[require(Camera3d, Eyes, EyeCameras)]
pub struct StereoCamera {
    /// How the other eye is produced.
    pub mode: StereoMode,
    /// The eye that is rendered.
    pub dominant: Eye,
    /// What becomes of what near objects hide from the rendered eye.
    pub holes: Holes,
    /// Fewer pixels where the eyes do not look. `None` for all pixels everywhere.
    pub foveation: Option<Foveation>,
    /// Where the eyes look, as a direction in the camera's axes: it may change in every frame, and nothing is created anew.
    /// `None`, as while a tracker has lost the eyes, keeps the last direction; before the first one, it is straight ahead.
    pub gaze: Option<Dir3>,
    /// Distance between the eyes.
    pub ipd: f32,
    /// Vertical field of view of each eye in radians.
    pub fov_y: f32,
    /// Distance of the near plane, more than 0.
    pub near: f32,
    /// Distance beyond which objects are culled.
    pub far: f32,
    /// Distance of the nearest object that is not cut off at the other eye's outer border. The rendered image is
    /// widened by a guard band for it. Infinity for no guard band.
    pub guard_distance: f32,
}

impl Default for StereoCamera {
    /// Synthesizes opaque surfaces, renders the right eye with all pixels, and uses an IPD of 63 mm, the field of view and
    /// planes of Bevy's perspective projection, and a guard band for objects at 1 m or farther.
    fn default() -> StereoCamera {
        let PerspectiveProjection { fov, near, far, .. } = PerspectiveProjection::default();
        StereoCamera {
            mode: StereoMode::default(),
            dominant: Eye::default(),
            holes: Holes::default(),
            foveation: None,
            gaze: None,
            ipd: eyes::MEAN_IPD,
            fov_y: fov,
            near,
            far,
            guard_distance: 1.0,
        }
    }
}

impl StereoCamera {
    /// Returns the eyes around a head at the origin, with images of this size in pixels.
    fn pair(&self, size: [u32; 2]) -> EyePair {
        let options = EyeOptions {
            size,
            fov_y: self.fov_y,
            ipd: self.ipd,
            dominant: self.dominant.into(),
            depth: reversed(self.near),
            outer_inner: None,
        };
        options.pair(Pose::IDENTITY)
    }
}

/// Returns a depth range in Bevy's encoding: reversed, without a far plane.
pub(crate) fn reversed(near: f32) -> DepthRange {
    DepthRange { near, far: f32::INFINITY, convention: DepthConvention::Reversed }
}

/// The state of a stereo camera.
#[derive(Component, Default)]
pub(crate) struct Eyes {
    /// The current arrangement, or `None` before the first frame.
    pub(crate) arrangement: Option<Arrangement>,
    /// The views of this frame.
    pub(crate) views: Option<Views>,
    /// The images of the wide level and of the inset.
    pub(crate) images: [EyeImages; 2],
    /// The images of the other way in [`StereoMode::Auto`], if it has been rendered. Other eyes' cameras are made anew.
    spare: Option<(Arrangement, [EyeImages; 2])>,
    /// The pose among the views that the camera's `Transform` has, if it is not the head's.
    pub(crate) origin: Option<Pose>,
    far: f32,
    /// The last gaze while there is foveation. Images have other sizes without one.
    pub(crate) gaze: Option<Dir3>,
    /// The camera that shows both eyes.
    pub(crate) screen: Option<Entity>,
    /// The camera's original render target, and its size in pixels as the screen knows it.
    output: Option<RenderTarget>,
    size: UVec2,
    /// The head's transform in the world.
    head: Option<GlobalTransform>,
    /// The reasons why both eyes are rendered although one should be synthesized, why there is no inset, and why holes are
    /// filled.
    reasons: [Option<String>; 3],
}

/// The images of a level.
#[derive(Default)]
pub(crate) struct EyeImages {
    /// The image that the widened view is rendered to.
    pub(crate) source: Handle<Image>,
    /// The other eye's image, if it has one of its own.
    pub(crate) other: Option<Handle<Image>>,
}

impl Eyes {
    /// True if this target is the image for the widened view.
    fn renders_to(&self, target: &RenderTarget) -> bool {
        matches!(target, RenderTarget::Image(to) if to.handle == self.images[0].source)
    }

    /// Keeps the reasons, and logs those that are new.
    fn explain(&mut self, camera: Entity, reasons: [Option<String>; 3]) {
        let results = ["both eyes of {} are rendered", "{} has no foveation", "the holes of {} are filled"];
        for ((reason, known), result) in reasons.iter().zip(&self.reasons).zip(results) {
            if let Some(reason) = reason.as_ref().filter(|_| reason != known) {
                warn!("{}: {reason}", result.replace("{}", &camera.to_string()));
            }
        }
        self.reasons = reasons;
    }
}

/// Everything that requires new images or cameras when it changes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Arrangement {
    pub(crate) plan: Plan,
    pub(crate) holes: Holes,
    /// The samples of the cameras that are not synthesized.
    msaa: Msaa,
    format: TextureFormat,
    /// The sizes of each level's source and target.
    sizes: [Option<[[u32; 2]; 2]>; 2],
}

pub(crate) fn build(app: &mut App) {
    app.register_type::<StereoCamera>()
        .add_systems(PreUpdate, (forget_removed_cameras, back_to_head.after(update_previous_view_data)))
        .configure_sets(PostUpdate, ShareSystems.before(CameraUpdateSystems))
        .add_systems(
            PostUpdate,
            (
                update_cameras.before(ShareSystems),
                follow.in_set(ShareSystems).before(TransformSystems::Propagate),
            ),
        )
        .add_systems(
            PostUpdate,
            to_eyes
                .after(TransformSystems::Propagate)
                .before(VisibilitySystems::UpdateFrusta)
                .before(SimulationLightSystems::UpdateDirectionalLightCascades),
        )
        .add_observer(restore_camera);
}

/// The components of a stereo camera that determine its arrangement or belong to it.
#[derive(QueryData)]
#[query_data(mutable)]
pub(crate) struct StereoCameraParts {
    entity: Entity,
    pub(crate) eyes: &'static mut Eyes,
    rendering: Rendering,
    pub(crate) camera: &'static mut Camera,
    camera_3d: &'static mut Camera3d,
    target: &'static mut RenderTarget,
    projection: &'static mut Projection,
    pub(crate) cameras: &'static mut EyeCameras,
}

/// The eyes that a camera should show.
pub(crate) struct EyesRequest<'a> {
    pub(crate) mode: StereoMode,
    pub(crate) holes: Holes,
    pub(crate) pair: &'a EyePair,
    pub(crate) foveation: Option<Foveation>,
    pub(crate) gaze: Option<Dir3>,
    pub(crate) guard_distance: f32,
    pub(crate) far: f32,
    /// The display's refreshes per second; 0 if unknown, or if it sets no pace.
    pub(crate) refresh_hz: f32,
    /// Format of the images that the cameras render to.
    pub(crate) format: TextureFormat,
    /// False if the other eye's camera has a target and a projection of its own, unless there is an inset.
    pub(crate) images: bool,
}

/// Returns a guard band for everything beyond a distance.
pub(crate) fn guard_band(distance: f32) -> GuardBand {
    if distance == f32::INFINITY { GuardBand::None } else { GuardBand::Distance(distance) }
}

/// The render targets of cameras.
#[derive(SystemParam)]
struct Targets<'w, 's> {
    windows: Query<'w, 's, (Entity, &'static Window)>,
    primary: Query<'w, 's, Entity, With<PrimaryWindow>>,
    manual: Res<'w, ManualTextureViews>,
    shown: Query<'w, 's, (&'static Window, &'static OnMonitor)>,
    monitors: Query<'w, 's, &'static Monitor>,
}

impl Targets<'_, '_> {
    /// Returns the size in pixels and the format that a camera without `Hdr` renders for a target.
    fn info(&self, target: &RenderTarget, images: &Assets<Image>) -> Option<(UVec2, TextureFormat)> {
        let normalized = target.normalize(self.primary.iter().next())?;
        let info = normalized.get_render_target_info(&self.windows, images, &self.manual).ok()?;
        let format = match target {
            RenderTarget::Image(target) => {
                let image = images.get(&target.handle)?;
                let view_format = image.texture_view_descriptor.as_ref().and_then(|view| view.format);
                view_format.unwrap_or(image.texture_descriptor.format)
            }
            RenderTarget::TextureView(handle) => self.manual.get(handle)?.view_format,
            _ => TextureFormat::Rgba8UnormSrgb,
        };
        Some((info.physical_size, format))
    }

    /// Returns the refreshes per second of the display that sets the pace of a target, if they are known.
    fn refresh_hz(&self, target: &RenderTarget) -> Option<f32> {
        let target = target.normalize(self.primary.iter().next())?;
        let NormalizedRenderTarget::Window(window) = target else { return None };
        let (window, monitor) = self.shown.get(window.entity()).ok()?;
        let paced = [PresentMode::AutoVsync, PresentMode::Fifo, PresentMode::FifoRelaxed];
        let rate = self.monitors.get(monitor.0).ok()?.refresh_rate_millihertz?;
        paced.contains(&window.present_mode).then_some(rate as f32 * 1e-3)
    }
}

fn update_cameras(
    mut commands: Commands,
    targets: Targets,
    mut images: ResMut<Assets<Image>>,
    mut auto: ResMut<AutoChoice>,
    mut cameras: Query<(&StereoCamera, StereoCameraParts)>,
    mut screens: Query<&mut Camera, Without<StereoCamera>>,
) {
    for (stereo, mut parts) in &mut cameras {
        if parts.eyes.arrangement.is_none() || !parts.eyes.renders_to(&parts.target) {
            show_eyes(&mut commands, &mut parts);
        }
        if let Some(mut camera) = parts.eyes.screen.and_then(|entity| screens.get_mut(entity).ok()) {
            follow_order(&mut camera, &parts.camera, SCREEN_ORDER);
        }
        let Some(output) = &parts.eyes.output else { continue };
        let Some((size, format)) = targets.info(output, &images) else { continue };
        if size.x < 2 || size.y < 1 {
            continue;
        }
        let request = EyesRequest {
            mode: stereo.mode,
            holes: stereo.holes,
            pair: &stereo.pair([size.x / 2, size.y]),
            foveation: stereo.foveation,
            gaze: stereo.gaze,
            guard_distance: stereo.guard_distance,
            far: stereo.far,
            refresh_hz: targets.refresh_hz(output).unwrap_or_default(),
            format,
            images: true,
        };
        parts.arrange(&mut commands, &mut images, &mut auto, &request);
        if let Some(screen) = parts.eyes.screen.filter(|_| parts.eyes.size != size) {
            parts.eyes.size = size;
            // Bevy re-reads a camera's target when its projection changes.
            let projection = Projection::Orthographic(OrthographicProjection::default_2d());
            commands.entity(screen).try_insert(projection);
        }
    }
}

/// Copies `is_active`, and `order` plus an offset, from a stereo camera.
fn follow_order(camera: &mut Mut<Camera>, stereo: &Camera, offset: isize) {
    if camera.is_active != stereo.is_active || camera.order != stereo.order + offset {
        (camera.is_active, camera.order) = (stereo.is_active, stereo.order + offset);
    }
}

/// Lets the cameras that belong to a stereo camera follow its settings and its views.
fn follow(
    stereo: Query<(&Eyes, &EyeCameras, &Camera)>,
    mut cameras: Query<(&mut Camera, &mut Projection, &mut Transform), Without<Eyes>>,
) {
    for (eyes, belonging, stereo) in &stereo {
        let Some(views) = &eyes.views else { continue };
        for role in Role::ALL {
            let Some(own) = belonging.get(role) else { continue };
            let Ok((mut camera, mut projection, mut transform)) = cameras.get_mut(own.entity) else {
                continue;
            };
            follow_order(&mut camera, stereo, ORDERS[role as usize]);
            if !same_clear_color(camera.clear_color, stereo.clear_color) {
                camera.clear_color = stereo.clear_color;
            }
            if let (true, Some((view, whole))) = (own.owned, views.of(role)) {
                EyeProjection::new(view, whole.frustum, eyes.far).replace(&mut projection);
                transform.set_if_neq(between(&eyes.origin.unwrap_or(Pose::IDENTITY), &view.pose));
            }
        }
    }
}

fn same_clear_color(a: ClearColorConfig, b: ClearColorConfig) -> bool {
    match (a, b) {
        (ClearColorConfig::Custom(a), ClearColorConfig::Custom(b)) => a == b,
        (a, b) => std::mem::discriminant(&a) == std::mem::discriminant(&b),
    }
}

/// Shows both eyes in the target that the camera would render to.
fn show_eyes(commands: &mut Commands, parts: &mut StereoCameraPartsItem) {
    let output = parts.target.clone();
    parts.eyes.output = Some(output.clone());
    (parts.eyes.arrangement, parts.eyes.size) = (None, UVec2::ZERO);
    if let Some(screen) = parts.eyes.screen {
        commands.entity(screen).try_insert(output);
        return;
    }
    let usages = CameraMainTextureUsages::default().0 | TextureUsages::COPY_DST;
    let camera = Camera {
        order: parts.camera.order + SCREEN_ORDER,
        clear_color: ClearColorConfig::Custom(Color::BLACK),
        ..default()
    };
    let screen = commands.spawn((
        Camera2d,
        camera,
        CameraMainTextureUsages(usages),
        Msaa::Off,
        RenderLayers::none(),
        output,
        ChildOf(parts.entity),
    ));
    parts.eyes.screen = Some(screen.id());
}

impl StereoCameraPartsItem<'_, '_> {
    /// Prepares the images, the projection and the cameras for a request. Returns the other eye's camera if it is new, and
    /// has a target and a projection of its own.
    pub(crate) fn arrange(
        &mut self,
        commands: &mut Commands,
        images: &mut Assets<Image>,
        auto: &mut AutoChoice,
        request: &EyesRequest,
    ) -> Option<Entity> {
        let (plan, views, holes) = self.plan(auto, request);
        let source = &views.wide.source;
        (self.eyes.views, self.eyes.far) = (Some(views), request.far);
        EyeProjection::new(source, source.frustum, request.far).replace(&mut self.projection);
        let usages = TextureUsages::from(self.camera_3d.depth_texture_usages);
        if !usages.contains(TextureUsages::TEXTURE_BINDING) {
            self.camera_3d.depth_texture_usages = (usages | TextureUsages::TEXTURE_BINDING).into();
        }
        let arrangement = Arrangement {
            plan,
            holes,
            msaa: self.rendering.msaa(),
            format: request.format,
            sizes: views.sizes(),
        };
        let is_auto = request.mode == StereoMode::Auto;
        let spare = self.eyes.spare.take().filter(|_| is_auto);
        if self.eyes.arrangement == Some(arrangement) {
            self.eyes.spare = spare;
            return None;
        }
        let old = self.eyes.arrangement.replace(arrangement);
        let other_way = old.filter(|old| is_auto && old.plan != plan);
        if is_auto && other_way.is_none() {
            auto.scene_changed();
        }

        let mut image = |view: &View| {
            let [width, height] = view.size;
            let mut image = Image::new_target_texture(width, height, request.format, None);
            image.texture_descriptor.usage |= TextureUsages::COPY_SRC;
            image.data = None;
            image.copy_on_resize = false;
            images.add(image)
        };
        let inset = views.inset.map(|inset| inset.views);
        let own_image = inset.is_some() || request.images && plan.has_other_camera();
        let images = match spare {
            Some((of, images)) if of == arrangement => images,
            _ => [Some(views.wide), inset].map(|level| {
                let level = level.as_ref();
                EyeImages {
                    source: level.map(|level| image(&level.source)).unwrap_or_default(),
                    other: level.filter(|_| own_image).map(|level| image(&level.target)),
                }
            }),
        };
        let images = std::mem::replace(&mut self.eyes.images, images);
        self.eyes.spare = other_way.map(|way| (way, images));
        *self.target = RenderTarget::Image(self.eyes.images[0].source.clone().into());
        // Bevy re-reads a camera's target when its projection changes.
        self.projection.set_changed();
        let old = *self.cameras;
        *self.cameras = EyeCameras(Role::ALL.map(|role| self.camera(commands, role, &views, own_image)));
        let other = self.cameras.get(Role::Other).filter(|other| !other.owned)?;
        old.get(Role::Other).is_none_or(|old| old.entity != other.entity).then_some(other.entity)
    }

    /// Returns what is done for a request, as far as it is possible, and logs what is not.
    fn plan(&mut self, auto: &mut AutoChoice, request: &EyesRequest) -> (Plan, Views, Holes) {
        let pair = request.pair;
        self.eyes.gaze = request.foveation.and(request.gaze.or(self.eyes.gaze));
        let effect = self.rendering.whole_image_effect().filter(|_| request.foveation.is_some());
        let (levels, unfoveated) = match effect {
            Some(effect) => (StereoViews::from(*pair), Some(format!("{effect} needs the whole image"))),
            None => match levels(pair, request.foveation, self.eyes.gaze) {
                Ok(levels) => (levels, None),
                Err(error) => (StereoViews::from(*pair), Some(error.to_string())),
            },
        };
        let guard = guard_band(request.guard_distance);
        let tried = self.rendering.plan(request.mode).map_err(String::from).and_then(|plan| {
            let views = Views::new(&levels, plan, guard).map_err(|error| error.to_string())?;
            Ok((plan, views))
        });
        let ((plan, views), both) = match tried {
            Ok(made) => (made, None),
            Err(reason) => ((Plan::Rendered, Views::rendered(&levels)), Some(reason)),
        };
        let wanted = request.holes == Holes::Rendered && plan == Plan::Opaque;
        let filled = self.rendering.filled_holes().filter(|_| wanted).map(String::from);
        let holes = if wanted && filled.is_none() { Holes::Rendered } else { Holes::Filled };
        if request.mode == StereoMode::Auto && self.camera.is_active {
            auto.count(both.is_none(), request.refresh_hz);
        }
        self.eyes.explain(self.entity, [both, unfoveated, filled]);
        if request.mode == StereoMode::Auto && auto.chooser().path() == StereoPath::TwoViews {
            return (Plan::Rendered, Views::rendered(&levels), Holes::Filled);
        }
        (plan, views, holes)
    }

    /// Returns the camera for a role, if there is something to draw: the one that has it, or a new one.
    fn camera(
        &self,
        commands: &mut Commands,
        role: Role,
        views: &Views,
        own_image: bool,
    ) -> Option<EyeCamera> {
        let Arrangement { plan, holes, .. } = self.eyes.arrangement?;
        let opens = holes == Holes::Rendered && role == views.detailed();
        let opaque = plan == Plan::Rendered || role == Role::Inset || opens;
        let wanted = views.of(role).filter(|_| plan.has_other_camera() || role == Role::Inset);
        let old = self.cameras.get(role);
        let kept = old.filter(|old| wanted.is_some() && old.opaque == opaque && old.owned == own_image);
        if let (Some(old), None) = (old, kept) {
            commands.entity(old.entity).try_despawn();
        }
        let (view, whole) = wanted?;
        let camera_3d = Camera3d { depth_texture_usages: self.camera_3d.depth_texture_usages, ..default() };
        let entity =
            kept.map_or_else(|| commands.spawn((camera_3d, ChildOf(self.entity))).id(), |kept| kept.entity);
        commands.entity(entity).try_insert(if opaque { self.rendering.msaa() } else { Msaa::Off });
        if own_image {
            let [wide, inset] = &self.eyes.images;
            let image = match role {
                Role::Other => wide.other.as_ref()?,
                Role::Inset => &inset.source,
                Role::OtherInset => inset.other.as_ref()?,
            };
            let projection = Projection::custom(EyeProjection::new(view, whole.frustum, self.eyes.far));
            commands.entity(entity).try_insert((RenderTarget::Image(image.clone().into()), projection));
        }
        Some(EyeCamera { entity, opaque, owned: own_image })
    }
}

/// Moves the camera from the head to the eye. Only `GlobalTransform` changes; `Transform` remains the head's.
fn to_eyes(mut cameras: Query<(&mut Eyes, &mut GlobalTransform), With<StereoCamera>>) {
    for (mut eyes, mut transform) in &mut cameras {
        let Some(views) = eyes.views else { continue };
        let head = *transform;
        eyes.head = Some(head);
        *transform = head.mul_transform(bevy_transform(&views.wide.source.pose));
    }
}

/// Moves the cameras back, so that no other system sees them moved.
fn back_to_head(mut cameras: Query<(&mut Eyes, &mut GlobalTransform), With<StereoCamera>>) {
    for (mut eyes, mut transform) in &mut cameras {
        if let Some(head) = eyes.head.take() {
            *transform = head;
        }
    }
}

/// Returns a pose as a Bevy transform.
pub(crate) fn bevy_transform(pose: &Pose) -> Transform {
    Transform::from_translation(Vec3::from_array(pose.position.to_array()))
        .with_rotation(Quat::from_array(pose.orientation.to_array()))
}

/// Returns a pose as a transform in another pose's axes.
fn between(parent: &Pose, pose: &Pose) -> Transform {
    let back = parent.orientation.inverse();
    let position = back * (pose.position - parent.position);
    bevy_transform(&Pose { position, orientation: back * pose.orientation })
}

/// Forgets cameras that were removed by other code.
fn forget_removed_cameras(
    mut commands: Commands,
    mut stereo: Query<(&mut Eyes, &mut EyeCameras)>,
    existing: Query<(), With<Camera>>,
) {
    for (mut eyes, mut cameras) in &mut stereo {
        if !cameras.iter().all(|camera| existing.contains(camera.entity)) {
            cameras.despawn(&mut commands);
            *cameras = EyeCameras::default();
            eyes.arrangement = None;
        }
        if eyes.screen.is_some_and(|screen| !existing.contains(screen)) {
            eyes.screen = None;
            eyes.arrangement = None;
        }
    }
}

/// Restores the single camera.
fn restore_camera(
    removed: On<Remove, StereoCamera>,
    mut commands: Commands,
    cameras: Query<(&StereoCamera, &Eyes, &GlobalTransform, &RenderTarget, &EyeCameras), With<Camera>>,
) {
    let Ok((stereo, eyes, transform, target, belonging)) = cameras.get(removed.entity) else { return };
    belonging.despawn(&mut commands);
    if let Some(screen) = eyes.screen {
        commands.entity(screen).try_despawn();
    }
    let mut camera = commands.entity(removed.entity);
    if let (Some(output), true) = (&eyes.output, eyes.renders_to(target)) {
        let projection =
            PerspectiveProjection { fov: stereo.fov_y, near: stereo.near, far: stereo.far, ..default() };
        let head = eyes.head.unwrap_or(*transform);
        camera.try_insert((output.clone(), Projection::Perspective(projection), head));
    }
    camera.try_remove::<(Eyes, EyeCameras)>();
}
