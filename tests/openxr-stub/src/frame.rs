//! Frames, views, and submitted layers.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};
use std::time::Duration;

use glam::{Quat, Vec3};
use openxr_sys as sys;
use sys::{Handle, Result as Code};

use crate::instance::IMAGE_LAYOUT;
use crate::log::{Depth, Entry, Image, Layer, View};
use crate::script::At;
use crate::session::{Frame, fill_depth_range, raw_fov, views_of};
use crate::space::{compose, inverse, pose, raw_pose};
use crate::synthesis::{check_synthesis, submitted_synthesis, synthesize};
use crate::world::{Answer, Array, DONE, Refusal, World, forbid_if, forbidden, given, in_chain};

/// The time of frame 0.
pub const BEGINNING_NS: i64 = 1_000_000_000;

/// The pause in each frame before the first picture, so that empty frames do not slow down the loading of a scene.
const LOADING_PAUSE: Duration = Duration::from_millis(5);
/// True until the first picture.
pub static IS_BLANK: AtomicBool = AtomicBool::new(true);

/// A function that is called before every frame.
pub static PACE: Mutex<Option<extern "C" fn()>> = Mutex::new(None);

impl World {
    fn period_ns(&self) -> i64 {
        (1e9 / f64::from(self.refresh_rate)) as i64
    }

    /// Returns the display time of the last frame that was waited for.
    pub fn time(&self) -> sys::Time {
        sys::Time::from_nanos(self.now_ns)
    }
}

/// Calls [`PACE`], or pauses while there has been no picture.
pub fn pace() {
    let pace = *PACE.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(pace) = pace {
        pace();
    } else if IS_BLANK.load(Ordering::Relaxed) {
        std::thread::sleep(LOADING_PAUSE);
    }
}

pub fn wait_frame(
    world: &mut World,
    session: sys::Session,
    _: *const sys::FrameWaitInfo,
    out: &mut sys::FrameState,
) -> Answer {
    running(world, session)?;
    world.frames += 1;
    // An application whose frames have motion vectors renders every second one.
    let periods = if world.session(session)?.frames.previous.is_some() { 2 } else { 1 };
    world.now_ns += periods * world.period_ns();
    let number = world.frame();
    world.happen(|at| matches!(at, At::Frame(n) if *n == number));
    let time = world.time();
    let period = sys::Duration::from_nanos(world.period_ns());
    let known = world.session(session)?;
    forbid_if(
        known.frames.waited.is_some(),
        Code::ERROR_CALL_ORDER_INVALID,
        "the last frame that was waited for has not begun: a real runtime would wait for ever",
    )?;
    let visible = matches!(known.state, crate::script::State::Visible | crate::script::State::Focused);
    // A session's first frame should not be rendered.
    let should_render = visible && known.frames.count > 0;
    known.frames.count += 1;
    known.frames.waited = Some(Frame { number, time, should_render });
    out.predicted_display_time = time;
    out.predicted_display_period = period;
    out.should_render = should_render.into();
    world.success()
}

pub fn begin_frame(world: &mut World, session: sys::Session, _: *const sys::FrameBeginInfo) -> Answer {
    running(world, session)?;
    let frames = &mut world.session(session)?.frames;
    let frame = frames
        .waited
        .take()
        .ok_or_else(|| forbidden(Code::ERROR_CALL_ORDER_INVALID, "no frame was waited for"))?;
    if frames.begun.replace(frame).is_some() {
        return Ok(Code::FRAME_DISCARDED);
    }
    world.success()
}

/// Refuses frames of a session that is not running.
fn running(world: &mut World, session: sys::Session) -> Result<(), Refusal> {
    forbid_if(world.session(session)?.views == 0, Code::ERROR_SESSION_NOT_RUNNING, "it is not running")
}

pub fn locate_views(
    world: &mut World,
    session: sys::Session,
    info: &sys::ViewLocateInfo,
    state: &mut sys::ViewState,
    out: Array<sys::View>,
) -> Answer {
    world.session(session)?;
    forbid_if(info.display_time.as_nanos() <= 0, Code::ERROR_TIME_INVALID, "the time is not positive")?;
    let number = views_of(world, info.view_configuration_type)?;
    out.check_types(number as usize, sys::View::TYPE)?;
    let base = world.space_pose(info.space)?;
    let frame = world.frame();
    let tracked = !world.script.untracked.contains(&frame);
    state.view_state_flags = if tracked {
        sys::ViewStateFlags::ORIENTATION_VALID
            | sys::ViewStateFlags::POSITION_VALID
            | sys::ViewStateFlags::ORIENTATION_TRACKED
            | sys::ViewStateFlags::POSITION_TRACKED
    } else {
        sys::ViewStateFlags::EMPTY
    };
    let head = compose(inverse(base), world.head_at(info.display_time.as_nanos()));
    let (ipd, length) = (world.script.ipd(frame), world.script.quaternion_length(frame));
    let views: Vec<(sys::Posef, sys::Fovf)> = (0..number as usize)
        .map(|i| {
            let eye = world.script.eyes[i % 2];
            // For the left eye, outwards means to the left.
            let side = if i % 2 == 0 { -1.0 } else { 1.0 };
            let (offset, cant) =
                if number == 1 { (0.0, 0.0) } else { (side * ipd / 2.0, -side * eye.cant_degrees) };
            let turn = glam::Quat::from_rotation_y(cant.to_radians());
            let view = compose(head, (turn, glam::Vec3::new(offset, 0.0, 0.0)));
            let inset = if i < 2 { None } else { world.script.inset(i % 2, cant.to_radians(), frame) };
            let fov = inset.map_or(eye.fov_degrees.map(f32::to_radians), |edges| edges.map(f32::atan));
            (raw_pose((view.0 * length, view.1)), raw_fov(fov))
        })
        .collect();
    out.fill(&views, |to, (pose, fov)| {
        (to.pose, to.fov) = (*pose, *fov);
        // SAFETY: the application's chain.
        unsafe { fill_depth_range(to.next) };
    })?;
    world.success()
}

pub fn end_frame(world: &mut World, session: sys::Session, info: &sys::FrameEndInfo) -> Answer {
    running(world, session)?;
    let views = world.session(session)?.views;
    let frame = world
        .session(session)?
        .frames
        .begun
        .ok_or_else(|| forbidden(Code::ERROR_CALL_ORDER_INVALID, "no frame has begun"))?;
    forbid_if(
        info.display_time != frame.time,
        Code::ERROR_TIME_INVALID,
        format!("it was predicted for {:?} and is submitted for {:?}", frame.time, info.display_time),
    )?;
    forbid_if(
        info.environment_blend_mode != sys::EnvironmentBlendMode::OPAQUE,
        Code::ERROR_ENVIRONMENT_BLEND_MODE_UNSUPPORTED,
        "only OPAQUE is offered",
    )?;
    forbid_if(
        info.layers.is_null() && info.layer_count > 0,
        Code::ERROR_LAYER_INVALID,
        "the layers are null",
    )?;
    let mut layers = Vec::new();
    for i in 0..info.layer_count as usize {
        // SAFETY: the array has that many pointers to layers.
        let layer = unsafe { *info.layers.add(i) };
        forbid_if(layer.is_null(), Code::ERROR_LAYER_INVALID, "a layer is null")?;
        // SAFETY: a layer of the type that it states.
        layers.push(unsafe { submitted(world, layer, views) }?);
    }
    world.picture(|world| is_picture(world, &layers));
    write_pictures(world, &layers, frame.number)?;
    synthesize(world, &layers, frame)?;
    world.log.write(&Entry::Frame { frame: frame.number, should_render: frame.should_render, layers });
    let unbind = world.script.unbind_context;
    let instance = world.current()?;
    let Some(known) = &mut instance.session else { return DONE };
    known.frames.begun = None;
    known.frames.ended += 1;
    known.settle(&mut instance.events);
    if unbind {
        known.graphics.unbind();
    }
    world.success()
}

/// Checks a layer, and returns its entry in the log.
///
/// # Safety
/// `layer` points to a structure of the type that it states.
pub unsafe fn submitted(
    world: &mut World,
    layer: *const sys::CompositionLayerBaseHeader,
    expected: u32,
) -> Result<Layer, Refusal> {
    // SAFETY: every layer begins with this header.
    let header = unsafe { &*layer };
    world.space_pose(header.space)?;
    match header.ty {
        sys::StructureType::COMPOSITION_LAYER_PROJECTION => {
            // SAFETY: the structure has this type.
            let projection = unsafe { &*layer.cast::<sys::CompositionLayerProjection>() };
            forbid_if(
                projection.view_count != expected,
                Code::ERROR_VALIDATION_FAILURE,
                format!("{} views instead of {expected}", projection.view_count),
            )?;
            given(projection.views.is_null(), "the views")?;
            let upside_down = is_upside_down(world, projection)?;
            let mut views = Vec::new();
            for i in 0..projection.view_count as usize {
                // SAFETY: the array has that many views.
                let mut view = submitted_view(world, unsafe { &*projection.views.add(i) })?;
                view.image.upside_down = upside_down;
                if let Some(depth) = &mut view.depth {
                    depth.image.upside_down = upside_down;
                }
                views.push(view);
            }
            if views.len() == 4 {
                check_insets(world, header.space, &views)?;
            }
            check_synthesis(world, header.space, &views)?;
            Ok(Layer::Projection { views })
        }
        sys::StructureType::COMPOSITION_LAYER_QUAD => {
            // SAFETY: the structure has this type.
            let quad = unsafe { &*layer.cast::<sys::CompositionLayerQuad>() };
            pose(&quad.pose)?;
            let image = submitted_image(world, &quad.sub_image, Content::Color)?;
            Ok(Layer::Quad { image })
        }
        other => Err(forbidden(Code::ERROR_LAYER_INVALID, format!("{other:?} is not offered"))),
    }
}

/// Refuses four views that are not the left eye, the right eye, the left eye's inset and the right eye's, and insets that
/// miss some of what the wearer looks at.
fn check_insets(world: &mut World, space: sys::Space, views: &[View]) -> Result<(), Refusal> {
    let refuse = |what: String| Err(forbidden(Code::ERROR_VALIDATION_FAILURE, what));
    let head = compose(inverse(world.space_pose(space)?), world.head());
    let [left, right] = [0, 1].map(|i| Vec3::from(views[i].position));
    if (right - left).dot(head.0 * Vec3::X) < -1e-4 {
        return refuse("view 0 is to the right of view 1".into());
    }
    for (eye, side) in [(0, -1.0), (1, 1.0)] {
        let (wide, inset) = (&views[eye], &views[eye + 2]);
        let apart = (Vec3::from(wide.position) - Vec3::from(inset.position)).length();
        let turned = Quat::from_array(wide.orientation).dot(Quat::from_array(inset.orientation));
        if apart > 1e-4 || turned.abs() < 1.0 - 1e-5 {
            return refuse(format!("view {} has another pose than view {eye}", eye + 2));
        }
        let cant = (-side * world.script.eyes[eye].cant_degrees).to_radians();
        let Some([left, right, up, down]) = world.script.inset(eye, cant, world.frame()) else { continue };
        let to_view = Quat::from_array(inset.orientation).inverse() * head.0 * Quat::from_rotation_y(cant);
        let edges = inset.fov_degrees.map(|angle| angle.to_radians().tan());
        // Images end at whole pixels.
        let pixel = 1.01 * (edges[1] - edges[0]) / inset.image.rect[2] as f32;
        let is_seen = |(x, y): (f32, f32)| {
            let ray = to_view * Vec3::new(x, y, -1.0);
            let (x, y) = (ray.x / -ray.z, ray.y / -ray.z);
            (edges[0] - pixel..edges[1] + pixel).contains(&x)
                && (edges[3] - pixel..edges[2] + pixel).contains(&y)
        };
        if ![(left, up), (left, down), (right, up), (right, down)].into_iter().all(is_seen) {
            let located = [left, right, up, down].map(|edge| edge.atan().to_degrees());
            return refuse(format!("view {}, {:?}, does not show {located:?}", eye + 2, inset.fov_degrees));
        }
    }
    Ok(())
}

/// True if a layer's chain states that its images are upside down.
fn is_upside_down(world: &mut World, layer: &sys::CompositionLayerProjection) -> Result<bool, Refusal> {
    // SAFETY: a chain of structures.
    let layout = unsafe {
        in_chain::<sys::CompositionLayerImageLayoutFB>(layer.next, sys::CompositionLayerImageLayoutFB::TYPE)
    };
    let Some(layout) = layout else { return Ok(false) };
    forbid_if(
        !world.current()?.has(IMAGE_LAYOUT),
        Code::ERROR_VALIDATION_FAILURE,
        format!("an image's layout without {IMAGE_LAYOUT}"),
    )?;
    Ok(layout.flags.contains(sys::CompositionLayerImageLayoutFlagsFB::VERTICAL_FLIP))
}

fn submitted_view(world: &mut World, view: &sys::CompositionLayerProjectionView) -> Result<View, Refusal> {
    forbid_if(
        view.ty != sys::CompositionLayerProjectionView::TYPE,
        Code::ERROR_VALIDATION_FAILURE,
        "the view's type is wrong",
    )?;
    let (orientation, position) = pose(&view.pose)?;
    let fov = [view.fov.angle_left, view.fov.angle_right, view.fov.angle_up, view.fov.angle_down];
    let [left, right, up, down] = fov;
    let limit = std::f32::consts::FRAC_PI_2;
    // Left may be greater than right, and down greater than up. The view is flipped then.
    forbid_if(
        !(left != right && down != up && fov.iter().all(|angle| angle.abs() < limit)),
        Code::ERROR_VALIDATION_FAILURE,
        format!("the frustum {fov:?} is none"),
    )?;
    let image = submitted_image(world, &view.sub_image, Content::Color)?;
    // SAFETY: a chain of structures.
    let depth = unsafe {
        in_chain::<sys::CompositionLayerDepthInfoKHR>(view.next, sys::CompositionLayerDepthInfoKHR::TYPE)
    };
    let depth = depth.map(|info| submitted_depth(world, info)).transpose()?;
    // SAFETY: the view's chain.
    let synthesis = unsafe { submitted_synthesis(world, view.next) }?;
    let degrees = fov.map(f32::to_degrees);
    Ok(View {
        position: position.to_array(),
        orientation: orientation.to_array(),
        fov_degrees: degrees,
        image,
        depth,
        synthesis,
    })
}

fn submitted_depth(world: &mut World, info: &sys::CompositionLayerDepthInfoKHR) -> Result<Depth, Refusal> {
    forbid_if(
        !world.current()?.has("XR_KHR_composition_layer_depth"),
        Code::ERROR_VALIDATION_FAILURE,
        "depth is submitted without XR_KHR_composition_layer_depth",
    )?;
    checked_depth(world, &info.sub_image, [info.min_depth, info.max_depth], [info.near_z, info.far_z])
}

/// Checks depth with its range and the distances in metres that this range stands for.
pub fn checked_depth(
    world: &mut World,
    sub_image: &sys::SwapchainSubImage,
    range: [f32; 2],
    near_far: [f32; 2],
) -> Result<Depth, Refusal> {
    let sane = range.iter().all(|depth| (0.0..=1.0).contains(depth))
        && range[0] < range[1]
        && near_far.iter().all(|z| *z > 0.0)
        && near_far[0] != near_far[1];
    forbid_if(!sane, Code::ERROR_VALIDATION_FAILURE, format!("depth {range:?} stands for {near_far:?} m"))?;
    let image = submitted_image(world, sub_image, Content::Depth)?;
    // JSON has no infinity.
    Ok(Depth { image, range, near_far: near_far.map(|z| z.min(f32::MAX)) })
}

/// What an image is submitted as.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Content {
    Color,
    Depth,
    Vectors,
}

/// Checks an image, and returns its entry in the log.
pub fn submitted_image(
    world: &mut World,
    image: &sys::SwapchainSubImage,
    content: Content,
) -> Result<Image, Refusal> {
    let ahead = world.script.acquires_ahead;
    let swapchain = world.swapchain(image.swapchain)?;
    let refuse = |what: String| Err(forbidden(Code::ERROR_VALIDATION_FAILURE, what));
    let fits = match content {
        Content::Color => !swapchain.is_depth(),
        Content::Depth => swapchain.is_depth(),
        Content::Vectors => swapchain.is_signed(),
    };
    if !fits {
        return refuse(format!("the swapchain's format {:#x} is none of {content:?}", swapchain.format));
    }
    if !ahead && !swapchain.acquired.is_empty() {
        return refuse("an image of the swapchain is still acquired".into());
    }
    forbid_if(
        swapchain.released.is_none(),
        Code::ERROR_LAYER_INVALID,
        "no image of the swapchain was released",
    )?;
    if image.image_array_index >= swapchain.layers {
        return refuse(format!("layer {} of {}", image.image_array_index, swapchain.layers));
    }
    let (offset, extent) = (image.image_rect.offset, image.image_rect.extent);
    let inside = offset.x >= 0
        && offset.y >= 0
        && extent.width > 0
        && extent.height > 0
        && offset.x + extent.width <= swapchain.size[0] as i32
        && offset.y + extent.height <= swapchain.size[1] as i32;
    forbid_if(
        !inside,
        Code::ERROR_SWAPCHAIN_RECT_INVALID,
        format!("{:?} of {:?}", image.image_rect, swapchain.size),
    )?;
    Ok(Image {
        swapchain: image.swapchain.into_raw(),
        layer: image.image_array_index,
        rect: [offset.x, offset.y, extent.width, extent.height],
        upside_down: false,
    })
}

/// True if the left view has more than one colour.
fn is_picture(world: &mut World, layers: &[Layer]) -> bool {
    let left = layers.iter().find_map(|layer| match layer {
        Layer::Projection { views } => views.first().map(|view| view.image.clone()),
        _ => None,
    });
    let pixels = left.and_then(|image| read(world, &image));
    pixels.is_some_and(|pixels| pixels.chunks_exact(4).any(|pixel| pixel != &pixels[..4]))
}

/// Returns the pixels of a submitted image, beginning with the lowest row of its view.
pub fn read(world: &mut World, image: &Image) -> Option<Vec<u8>> {
    let texture = world.swapchain(sys::Swapchain::from_raw(image.swapchain)).ok()?.shown()?;
    let mut pixels = world.its_session().ok()?.graphics.read(texture, image.layer, image.rect)?;
    if image.upside_down {
        let row = image.rect[2] as usize * 4;
        pixels = pixels.chunks_exact(row).rev().flatten().copied().collect();
    }
    Some(pixels)
}

/// Writes pictures of a frame's layers, if the script asks for them.
fn write_pictures(world: &mut World, layers: &[Layer], frame: u32) -> Result<(), Refusal> {
    let Some(pictures) = world.script.pictures.clone().filter(|p| p.from <= frame) else {
        return Ok(());
    };
    let mut quads = 0;
    for layer in layers {
        let images: Vec<(String, &Image)> = match layer {
            Layer::Projection { views } => {
                let name = |(i, view)| (format!("view-{i}"), &(view as &View).image);
                views.iter().enumerate().map(name).collect()
            }
            Layer::Quad { image } => {
                quads += 1;
                vec![(format!("quad-{}", quads - 1), image)]
            }
        };
        for (name, image) in images {
            let Some(pixels) = read(world, image) else {
                return Err(forbidden(Code::ERROR_RUNTIME_FAILURE, "the image cannot be read"));
            };
            let path = pictures.folder.join(format!("{name}.png"));
            let size = [image.rect[2] as u32, image.rect[3] as u32];
            let picture = image::RgbaImage::from_raw(size[0], size[1], pixels).expect("four bytes a pixel");
            let picture = image::imageops::flip_vertical(&picture);
            // Views are opaque whatever their alpha.
            let written = match layer {
                Layer::Quad { .. } => picture.save(&path),
                _ => image::DynamicImage::from(picture).into_rgb8().save(&path),
            };
            written.unwrap_or_else(|e| panic!("{}: {e}", path.display()));
        }
        let Layer::Projection { views } = layer else { continue };
        for (i, depth) in views.iter().enumerate().filter_map(|(i, view)| Some((i, view.depth.as_ref()?))) {
            // Some formats cannot be read.
            if let Some(depth) = read(world, &depth.image) {
                let path = pictures.folder.join(format!("depth-{i}"));
                std::fs::write(&path, depth).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
            }
        }
    }
    Ok(())
}
