//! Stereo cameras: the view that they render, and the cameras that belong to them.

use bevy::camera::visibility::{RenderLayers, VisibilitySystems};
use bevy::camera::{CameraMainTextureUsages, CameraUpdateSystems, ClearColorConfig, RenderTarget};
use bevy::ecs::query::QueryData;
use bevy::ecs::system::SystemParam;
use bevy::light::SimulationLightSystems;
use bevy::pbr::update_previous_view_data;
use bevy::prelude::*;
use bevy::render::camera::NormalizedRenderTargetExt;
use bevy::render::render_resource::{TextureFormat, TextureUsages};
use bevy::render::texture::ManualTextureViews;
use bevy::window::PrimaryWindow;
use yoro_wgpu::yoro::eyes::{
    self, DepthConvention, DepthRange, EyeOptions, EyePair, GuardBand, Pose, View, Warp,
};

use crate::StereoMode;
use crate::plan::{Plan, Rendering};
use crate::projection::EyeProjection;
use crate::shared::{OtherCamera, ShareSystems};

/// The orders of the cameras that belong to a stereo camera, relative to its own order.
const OTHER_EYE_ORDER: isize = 1;
const SCREEN_ORDER: isize = 2;

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
#[require(Camera3d, Eyes)]
pub struct StereoCamera {
    /// How the other eye is produced.
    pub mode: StereoMode,
    /// The eye that is rendered.
    pub dominant: Eye,
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
    /// Synthesizes opaque surfaces, renders the right eye, and uses an IPD of 63 mm, the field of view and planes of
    /// Bevy's perspective projection, and a guard band for objects at 1 m or farther.
    fn default() -> StereoCamera {
        let PerspectiveProjection { fov, near, far, .. } = PerspectiveProjection::default();
        StereoCamera {
            mode: StereoMode::default(),
            dominant: Eye::default(),
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
    /// The image that the camera renders the widened view to.
    pub(crate) source: Handle<Image>,
    /// The image that the other eye's camera renders to.
    pub(crate) other: Handle<Image>,
    /// The camera that shows both eyes.
    screen: Option<Entity>,
    /// The camera's original render target, and its size in pixels as the screen knows it.
    output: Option<RenderTarget>,
    size: UVec2,
    /// The head's transform in the world.
    head: Option<GlobalTransform>,
    /// The reason why both eyes are rendered although one should be synthesized.
    reason: Option<String>,
}

impl Eyes {
    /// True if this target is the image for the widened view.
    fn renders_to(&self, target: &RenderTarget) -> bool {
        matches!(target, RenderTarget::Image(to) if to.handle == self.source)
    }
}

/// Everything that requires new images, projections or cameras when it changes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Arrangement {
    pub(crate) plan: Plan,
    /// The samples of the other eye's camera if both eyes are rendered.
    msaa: Msaa,
    format: TextureFormat,
    /// The views of the two eyes, without their poses.
    views: [View; 2],
    far: f32,
}

/// The views of the two eyes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Views {
    /// The view that the camera renders: the dominant eye's, widened unless both eyes are rendered.
    pub(crate) source: View,
    /// The view of the other eye.
    pub(crate) target: View,
    /// Upper left corner, in pixels, of the dominant eye's own image in the source.
    pub(crate) crop: [u32; 2],
    pub(crate) dominant: eyes::Eye,
    /// `None` if both eyes are rendered.
    pub(crate) warp: Option<Warp>,
}

impl Views {
    /// Returns the views if both eyes are rendered.
    pub(crate) fn rendered(pair: &EyePair) -> Views {
        let dominant = pair.dominant;
        let (source, target) = (pair.view(dominant), pair.view(dominant.other()));
        Views { source, target, crop: [0, 0], dominant, warp: None }
    }

    /// Returns the views for a plan.
    ///
    /// # Errors
    /// The reason why the other eye cannot be synthesized from these eyes.
    pub(crate) fn new(pair: &EyePair, plan: Plan, guard: GuardBand) -> Result<Views, eyes::EyesError> {
        if plan == Plan::Rendered {
            return Ok(Views::rendered(pair));
        }
        let dominant = pair.dominant;
        let views = pair.synthesis_views(guard)?;
        let crop = views.dominant_crop_from_top();
        Ok(Views { source: views.source, target: views.target, crop, dominant, warp: Some(views.warp) })
    }
}

/// The stereo camera whose eyes are shown, on the camera that shows them.
#[derive(Component, Clone, Copy)]
pub(crate) struct Screen(pub(crate) Entity);

pub(crate) fn build(app: &mut App) {
    app.register_type::<StereoCamera>()
        .add_systems(PreUpdate, (forget_removed_cameras, back_to_head.after(update_previous_view_data)))
        .configure_sets(PostUpdate, ShareSystems.before(CameraUpdateSystems))
        .add_systems(PostUpdate, update_cameras.before(ShareSystems))
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
    other: Option<&'static OtherCamera>,
}

/// The eyes that a camera should show.
pub(crate) struct EyesRequest<'a> {
    pub(crate) mode: StereoMode,
    pub(crate) pair: &'a EyePair,
    pub(crate) guard_distance: f32,
    pub(crate) far: f32,
    /// Format of the images that the cameras render to.
    pub(crate) format: TextureFormat,
    /// True if the other eye's camera needs an image to render to, and a projection.
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
}

fn update_cameras(
    mut commands: Commands,
    targets: Targets,
    mut images: ResMut<Assets<Image>>,
    mut cameras: Query<(&StereoCamera, StereoCameraParts)>,
    mut others: Query<&mut Camera, Without<StereoCamera>>,
) {
    for (stereo, mut parts) in &mut cameras {
        if parts.eyes.arrangement.is_none() || !parts.eyes.renders_to(&parts.target) {
            show_eyes(&mut commands, &mut parts);
        }
        let beside =
            [(parts.eyes.screen, SCREEN_ORDER), (parts.other.map(|other| other.entity), OTHER_EYE_ORDER)];
        for (entity, offset) in beside {
            if let Some(mut camera) = entity.and_then(|entity| others.get_mut(entity).ok()) {
                follow(&mut camera, &parts.camera, offset);
            }
        }
        let Some((size, format)) =
            parts.eyes.output.as_ref().and_then(|output| targets.info(output, &images))
        else {
            continue;
        };
        if size.x < 2 || size.y < 1 {
            continue;
        }
        let pair = stereo.pair([size.x / 2, size.y]);
        let (mode, guard_distance, far) = (stereo.mode, stereo.guard_distance, stereo.far);
        let request = EyesRequest { mode, pair: &pair, guard_distance, far, format, images: true };
        parts.arrange(&mut commands, &mut images, &request);
        if let Some(screen) = parts.eyes.screen.filter(|_| parts.eyes.size != size) {
            parts.eyes.size = size;
            // Bevy re-reads a camera's target when its projection changes.
            let projection = Projection::Orthographic(OrthographicProjection::default_2d());
            commands.entity(screen).try_insert(projection);
        }
    }
}

/// Copies `is_active`, and `order` plus an offset, from a stereo camera. Also copies `clear_color` to the other eye's
/// camera.
fn follow(camera: &mut Mut<Camera>, stereo: &Camera, offset: isize) {
    if camera.is_active != stereo.is_active || camera.order != stereo.order + offset {
        (camera.is_active, camera.order) = (stereo.is_active, stereo.order + offset);
    }
    // The screen's camera clears what lies outside the eyes.
    if offset == OTHER_EYE_ORDER && !same_clear_color(camera.clear_color, stereo.clear_color) {
        camera.clear_color = stereo.clear_color;
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
        Screen(parts.entity),
        ChildOf(parts.entity),
    ));
    parts.eyes.screen = Some(screen.id());
}

impl StereoCameraPartsItem<'_, '_> {
    /// Prepares the images, the projections and the other eye's camera for a request. Returns that camera if it is new.
    pub(crate) fn arrange(
        &mut self,
        commands: &mut Commands,
        images: &mut Assets<Image>,
        request: &EyesRequest,
    ) -> Option<Entity> {
        let guard = guard_band(request.guard_distance);
        let tried = self.rendering.plan(request.mode).map_err(String::from).and_then(|plan| {
            let views = Views::new(request.pair, plan, guard).map_err(|error| error.to_string())?;
            Ok((plan, views))
        });
        let (plan, views, reason) = match tried {
            Ok((plan, views)) => (plan, views, None),
            Err(reason) => (Plan::Rendered, Views::rendered(request.pair), Some(reason)),
        };
        if reason != self.eyes.reason {
            if let Some(reason) = &reason {
                warn!("both eyes of {} are rendered: {reason}", self.entity);
            }
            self.eyes.reason = reason;
        }
        self.eyes.views = Some(views);
        let still = |view: View| View { pose: Pose::IDENTITY, ..view };
        let arrangement = Arrangement {
            plan,
            msaa: self.rendering.msaa(),
            format: request.format,
            views: [views.source, views.target].map(still),
            far: request.far,
        };
        let usages = TextureUsages::from(self.camera_3d.depth_texture_usages);
        if !usages.contains(TextureUsages::TEXTURE_BINDING) {
            self.camera_3d.depth_texture_usages = (usages | TextureUsages::TEXTURE_BINDING).into();
        }
        if self.eyes.arrangement == Some(arrangement) {
            return None;
        }
        self.eyes.arrangement = Some(arrangement);

        let mut image = |view: &View| {
            let [width, height] = view.size;
            let mut image = Image::new_target_texture(width, height, request.format, None);
            image.texture_descriptor.usage |= TextureUsages::COPY_SRC;
            image.data = None;
            image.copy_on_resize = false;
            images.add(image)
        };
        self.eyes.source = image(&views.source);
        *self.target = RenderTarget::Image(self.eyes.source.clone().into());
        *self.projection = Projection::custom(EyeProjection::new(&views.source, request.far));

        let rendered = plan == Plan::Rendered;
        let kept = self.other.filter(|other| plan.has_other_camera() && other.rendered == rendered);
        if let (Some(other), None) = (self.other, kept) {
            commands.entity(other.entity).try_despawn();
            commands.entity(self.entity).remove::<OtherCamera>();
        }
        self.eyes.other = Handle::default();
        if !plan.has_other_camera() {
            return None;
        }
        let own = (
            Camera {
                order: self.camera.order + OTHER_EYE_ORDER,
                clear_color: self.camera.clear_color,
                is_active: self.camera.is_active,
                ..default()
            },
            if rendered { self.rendering.msaa() } else { Msaa::Off },
        );
        let new = kept.is_none().then(|| {
            let entity = commands.spawn((Camera3d::default(), ChildOf(self.entity))).id();
            commands.entity(self.entity).insert(OtherCamera { entity, rendered });
            entity
        });
        let entity = new.or(kept.map(|other| other.entity))?;
        commands.entity(entity).try_insert(own);
        if request.images {
            self.eyes.other = image(&views.target);
            let target = RenderTarget::Image(self.eyes.other.clone().into());
            let projection = Projection::custom(EyeProjection::new(&views.target, request.far));
            commands.entity(entity).try_insert((target, projection));
        }
        new
    }
}

/// Moves the cameras from the head to the eyes. Only `GlobalTransform` changes; `Transform` remains the head's.
fn to_eyes(
    mut cameras: Query<(&mut Eyes, &mut GlobalTransform, Option<&OtherCamera>), With<StereoCamera>>,
    mut others: Query<&mut GlobalTransform, Without<StereoCamera>>,
) {
    for (mut eyes, mut transform, other) in &mut cameras {
        let Some(views) = eyes.views else { continue };
        let head = *transform;
        eyes.head = Some(head);
        *transform = head.mul_transform(bevy_transform(&views.source.pose));
        if let Some(mut other) = other.and_then(|other| others.get_mut(other.entity).ok()) {
            *other = head.mul_transform(bevy_transform(&views.target.pose));
        }
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

/// Forgets cameras that were removed by other code.
fn forget_removed_cameras(
    mut commands: Commands,
    mut stereo: Query<(Entity, &mut Eyes, Option<&OtherCamera>)>,
    cameras: Query<(), With<Camera>>,
) {
    for (entity, mut eyes, other) in &mut stereo {
        if other.is_some_and(|other| !cameras.contains(other.entity)) {
            commands.entity(entity).remove::<OtherCamera>();
            eyes.arrangement = None;
        }
        if eyes.screen.is_some_and(|screen| !cameras.contains(screen)) {
            eyes.screen = None;
            eyes.arrangement = None;
        }
    }
}

/// Restores the single camera.
fn restore_camera(
    removed: On<Remove, StereoCamera>,
    mut commands: Commands,
    cameras: Query<
        (&StereoCamera, &Eyes, &GlobalTransform, &RenderTarget, Option<&OtherCamera>),
        With<Camera>,
    >,
) {
    let Ok((stereo, eyes, transform, target, other)) = cameras.get(removed.entity) else { return };
    for entity in [eyes.screen, other.map(|other| other.entity)].into_iter().flatten() {
        commands.entity(entity).try_despawn();
    }
    let mut camera = commands.entity(removed.entity);
    if let (Some(output), true) = (&eyes.output, eyes.renders_to(target)) {
        let projection =
            PerspectiveProjection { fov: stereo.fov_y, near: stereo.near, far: stereo.far, ..default() };
        let head = eyes.head.unwrap_or(*transform);
        camera.try_insert((output.clone(), Projection::Perspective(projection), head));
    }
    camera.try_remove::<(Eyes, OtherCamera)>();
}
