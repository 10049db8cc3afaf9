//! Motion vectors (XR_EXT_frame_synthesis, XR_FB_space_warp): their checks, and the frames that are made of them.

use std::ffi::c_void;

use glam::{Quat, Vec3};
use openxr_sys as sys;
use sys::{Handle, Result as Code};
use yoro_metrics::{EyeCamera, EyePose, SubmittedEye};

use crate::frame::{Content, checked_depth, read, submitted_image};
use crate::instance::{FRAME_SYNTHESIS, SPACE_WARP};
use crate::log::{Depth, Image, Layer, Synthesis, View};
use crate::session::Frame;
use crate::space::{Pose, compose, inverse, pose};
use crate::world::{Refusal, World, forbid_if, forbidden, in_chain};

/// A frame with motion vectors.
#[derive(Clone, Debug)]
pub struct MovingFrame {
    time: sys::Time,
    views: Vec<EyeCamera>,
}

fn refuse<T>(what: impl Into<String>) -> Result<T, Refusal> {
    Err(forbidden(Code::ERROR_VALIDATION_FAILURE, what))
}

/// Checks the motion vectors in a view's chain.
///
/// # Safety
/// `next` begins a chain of structures of the types that they state.
pub unsafe fn submitted_synthesis(
    world: &mut World,
    next: *const c_void,
) -> Result<Option<Synthesis>, Refusal> {
    // SAFETY: same contract.
    let (synthesis, warp) = unsafe {
        (
            in_chain::<sys::FrameSynthesisInfoEXT>(next, sys::FrameSynthesisInfoEXT::TYPE),
            in_chain::<sys::CompositionLayerSpaceWarpInfoFB>(
                next,
                sys::CompositionLayerSpaceWarpInfoFB::TYPE,
            ),
        )
    };
    let (extension, mut info) = match (synthesis, warp) {
        (None, None) => return Ok(None),
        (Some(info), None) => (FRAME_SYNTHESIS, *info),
        (None, Some(info)) => (
            SPACE_WARP,
            sys::FrameSynthesisInfoEXT {
                ty: sys::FrameSynthesisInfoEXT::TYPE,
                next: std::ptr::null(),
                layer_flags: sys::FrameSynthesisInfoFlagsEXT::EMPTY,
                motion_vector_sub_image: info.motion_vector_sub_image,
                motion_vector_scale: sys::Vector4f { x: 1.0, y: 1.0, z: 1.0, w: 1.0 },
                motion_vector_offset: sys::Vector4f { x: 0.0, y: 0.0, z: 0.0, w: 0.0 },
                app_space_delta_pose: info.app_space_delta_pose,
                depth_sub_image: info.depth_sub_image,
                min_depth: info.min_depth,
                max_depth: info.max_depth,
                near_z: info.near_z,
                far_z: info.far_z,
            },
        ),
        (Some(_), Some(_)) => return refuse("a view has the motion vectors of two extensions"),
    };
    forbid_if(
        !world.current()?.has(extension),
        Code::ERROR_VALIDATION_FAILURE,
        format!("motion vectors without {extension}"),
    )?;
    let vectors = submitted_image(world, &info.motion_vector_sub_image, Content::Vectors)?;
    let range = [info.min_depth, info.max_depth];
    let depth = checked_depth(world, &info.depth_sub_image, range, [info.near_z, info.far_z])?;
    if depth.image.rect[2..] != vectors.rect[2..] {
        return refuse(format!("vectors in {:?} have depth in {:?}", vectors.rect, depth.image.rect));
    }
    let usage = world.swapchain(info.depth_sub_image.swapchain)?.usage;
    let wanted = sys::SwapchainUsageFlags::SAMPLED | sys::SwapchainUsageFlags::DEPTH_STENCIL_ATTACHMENT;
    if extension == SPACE_WARP && !usage.contains(wanted) {
        return refuse("the vectors' depth is not in a swapchain for sampling and as an attachment");
    }
    let moved = pose(&info.app_space_delta_pose)?;
    // The fourth components are ignored.
    let three = |v: &mut sys::Vector4f| [v.x, v.y, v.z];
    let (scale, offset) = (three(&mut info.motion_vector_scale), three(&mut info.motion_vector_offset));
    if !scale.iter().chain(&offset).all(|number| number.is_finite()) {
        return refuse(format!("scale {scale:?} and offset {offset:?} of motion vectors"));
    }
    let skip = sys::CompositionLayerSpaceWarpInfoFlagsFB::FRAME_SKIP;
    Ok(Some(Synthesis {
        is_space_warp: extension == SPACE_WARP,
        vectors,
        scale,
        offset,
        depth,
        moved: (moved.1.to_array(), moved.0.to_array()),
        is_flat: info.layer_flags.contains(sys::FrameSynthesisInfoFlagsEXT::USE_2D_MOTION_VECTOR),
        is_skipped: warp.is_some_and(|info| info.layer_flags.contains(skip)),
    }))
}

/// Refuses a layer of which only some views have motion vectors, and one that says that the application has moved its
/// space although it has not.
pub fn check_synthesis(world: &mut World, space: sys::Space, views: &[View]) -> Result<(), Refusal> {
    let with: Vec<&Synthesis> = views.iter().filter_map(|view| view.synthesis.as_ref()).collect();
    forbid_if(
        !with.is_empty() && with.len() < views.len(),
        Code::ERROR_VALIDATION_FAILURE,
        format!("{} of {} views have motion vectors", with.len(), views.len()),
    )?;
    let now = world.space_pose(space)?;
    let before = world.its_session()?.frames.space.replace(now);
    let stays = before.is_some_and(|before| is_near(before, now, 1e-4));
    for synthesis in with {
        let moved = (Quat::from_array(synthesis.moved.1), Vec3::from(synthesis.moved.0));
        forbid_if(
            stays && !is_near(moved, (Quat::IDENTITY, Vec3::ZERO), 1e-4),
            Code::ERROR_VALIDATION_FAILURE,
            format!("the space is said to have moved by {moved:?}, and has not"),
        )?;
    }
    Ok(())
}

fn is_near(a: Pose, b: Pose, tolerance: f32) -> bool {
    (a.1 - b.1).length() < tolerance && a.0.dot(b.0).abs() > 1.0 - tolerance
}

/// Remembers the views of a frame with motion vectors, and makes the frame between it and the next one, if the script
/// asks for pictures.
pub fn synthesize(world: &mut World, layers: &[Layer], frame: Frame) -> Result<(), Refusal> {
    let views = layers.iter().find_map(|layer| match layer {
        Layer::Projection { views } if views.iter().all(|view| view.synthesis.is_some()) => Some(views),
        _ => None,
    });
    let previous = world.its_session()?.frames.previous.take();
    let Some(views) = views else { return Ok(()) };
    let cameras: Vec<EyeCamera> = views.iter().filter_map(camera).collect();
    let pictures = world.script.pictures.clone().filter(|pictures| pictures.from <= frame.number);
    let skips = views.iter().flat_map(|view| &view.synthesis).any(|synthesis| synthesis.is_skipped);
    if let (Some(pictures), Some(previous), false) = (pictures, previous, skips)
        && previous.views.len() == views.len()
    {
        let interval = frame.time.as_nanos() - previous.time.as_nanos();
        let (now, later) =
            (world.head_at(frame.time.as_nanos()), world.head_at(frame.time.as_nanos() + interval / 2));
        let space = world.its_session()?.frames.space.unwrap_or((Quat::IDENTITY, Vec3::ZERO));
        let head_moves = compose(later, inverse(now));
        let in_space = compose(inverse(space), compose(head_moves, space));
        for (i, (view, previous)) in views.iter().zip(&previous.views).enumerate() {
            let Some(made) = frame_between(world, view, previous, &cameras[i], in_space) else {
                return Err(forbidden(Code::ERROR_RUNTIME_FAILURE, "motion vectors cannot be read"));
            };
            let [.., width, height] = view.image.rect.map(|n| n as u32);
            let picture = image::RgbaImage::from_raw(width, height, made).expect("four bytes a pixel");
            let picture = image::DynamicImage::from(image::imageops::flip_vertical(&picture)).into_rgb8();
            let path = pictures.folder.join(format!("between-{i}.png"));
            picture.save(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
        }
    }
    world.its_session()?.frames.previous = Some(MovingFrame { time: frame.time, views: cameras });
    Ok(())
}

/// Returns the camera of a view with motion vectors.
fn camera(view: &View) -> Option<EyeCamera> {
    let [left, right, up, down] = view.fov_degrees.map(|angle| angle.to_radians().tan());
    let near_far = view.synthesis.as_ref()?.depth.near_far;
    Some(EyeCamera {
        pose: eye_pose((Quat::from_array(view.orientation), view.position.into())),
        tangents: [left, right, down, up],
        inverse_distances: near_far.map(|metres| 1.0 / f64::from(metres)),
    })
}

fn eye_pose((orientation, position): Pose) -> EyePose {
    EyePose { position, orientation }
}

/// Returns the pose of a camera that `motion` moves.
fn moved_by(motion: Pose, camera: &EyeCamera) -> EyePose {
    eye_pose(compose(motion, (camera.pose.orientation, camera.pose.position)))
}

/// Returns a view's picture half an interval later, in which the head moves by `head_motion`.
fn frame_between(
    world: &mut World,
    view: &View,
    previous: &EyeCamera,
    camera: &EyeCamera,
    head_motion: Pose,
) -> Option<Vec<u8>> {
    let synthesis = view.synthesis.as_ref()?;
    let rgba = read(world, &view.image)?;
    let Depth { image: depth, range, .. } = &synthesis.depth;
    let texture = |world: &mut World, image: &Image| {
        world.swapchain(sys::Swapchain::from_raw(image.swapchain)).ok()?.shown()
    };
    let (of_vectors, of_depth) = (texture(world, &synthesis.vectors)?, texture(world, depth)?);
    let graphics = &mut world.its_session().ok()?.graphics;
    let vectors = graphics.read_vectors(of_vectors, synthesis.vectors.layer, synthesis.vectors.rect)?;
    let depth = graphics.read_depth(of_depth, depth.layer, depth.rect)?;
    // In OpenGL z is from -1 to 1, which XR_EXT_frame_synthesis forbids.
    let z = match () {
        () if synthesis.is_flat => 0.0,
        () if synthesis.is_space_warp => 0.5,
        () => 1.0,
    };
    let (scale, offset) = (Vec3::from(synthesis.scale), Vec3::from(synthesis.offset));
    let of_texel = |vector: Vec3| (vector * scale + offset) * Vec3::new(1.0, 1.0, z);
    let vectors: Vec<Vec3> = vectors.into_iter().map(of_texel).collect();
    let depth: Vec<f32> = depth.into_iter().map(|depth| (depth - range[0]) / (range[1] - range[0])).collect();
    let size = |image: &Image| [image.rect[2] as u32, image.rect[3] as u32];
    let moved = (Quat::from_array(synthesis.moved.1), Vec3::from(synthesis.moved.0));
    let eye = SubmittedEye {
        rgba: &rgba,
        size: size(&view.image),
        vectors: &vectors,
        depth: &depth,
        vector_size: size(&synthesis.vectors),
        camera: *camera,
        previous: in_this_space(moved, previous),
    };
    Some(eye.extrapolate(moved_by(head_motion, camera), 0.5))
}

/// Returns the previous frame's camera in this frame's space, which the application has moved: `moved` is this frame's
/// space in the previous one's. That is no motion of what is seen.
fn in_this_space(moved: Pose, previous: &EyeCamera) -> EyeCamera {
    EyeCamera { pose: moved_by(inverse(moved), previous), ..*previous }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A head that stands still in the room stands still, wherever the application moves its space.
    #[test]
    fn a_space_that_the_application_moves_does_not_move_the_head() {
        let moved = (Quat::from_rotation_y(0.4), Vec3::new(1.0, 0.0, -0.5));
        let head = (Quat::from_rotation_x(0.3), Vec3::new(0.2, 1.6, -0.1));
        let camera =
            |pose| EyeCamera { pose, tangents: [-1.0, 1.0, -1.0, 1.0], inverse_distances: [10.0, 0.02] };
        let now = camera(eye_pose(head));
        let same = in_this_space(moved, &camera(eye_pose(compose(moved, head))));
        assert!((same.pose.position - now.pose.position).length() < 1e-6, "{same:?}");
        assert!(same.pose.orientation.dot(now.pose.orientation) > 1.0 - 1e-6, "{same:?}");
    }
}
