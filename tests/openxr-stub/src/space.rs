//! Spaces and poses.

use glam::{Quat, Vec3};
use openxr_sys as sys;
use sys::Handle;

use crate::instance::fill;
use crate::world::{DONE, Refusal, World, enter, forbidden};

/// A turn, then a shift: from a space to the one that it lies in.
pub type Pose = (Quat, Vec3);

pub struct Space {
    kind: Kind,
    offset: Pose,
}

enum Kind {
    Reference(sys::ReferenceSpaceType),
    /// A controller's: left or right.
    Hand(f32),
}

pub fn compose(a: Pose, b: Pose) -> Pose {
    (a.0 * b.0, a.1 + a.0 * b.1)
}

pub fn inverse(a: Pose) -> Pose {
    let turn = a.0.inverse();
    (turn, -(turn * a.1))
}

pub fn raw_pose((turn, position): Pose) -> sys::Posef {
    sys::Posef {
        orientation: sys::Quaternionf { x: turn.x, y: turn.y, z: turn.z, w: turn.w },
        position: sys::Vector3f { x: position.x, y: position.y, z: position.z },
    }
}

/// A pose of the application's.
pub fn pose(raw: &sys::Posef) -> Result<Pose, Refusal> {
    let turn = Quat::from_xyzw(raw.orientation.x, raw.orientation.y, raw.orientation.z, raw.orientation.w);
    let position = Vec3::new(raw.position.x, raw.position.y, raw.position.z);
    if !((turn.length() - 1.0).abs() < 0.01 && position.is_finite()) {
        return Err(forbidden(sys::Result::ERROR_POSE_INVALID, format!("{turn:?}, {position:?} is no pose")));
    }
    Ok((turn.normalize(), position))
}

impl World {
    /// A space in the floor's.
    pub fn space_pose(&mut self, space: sys::Space) -> Result<Pose, Refusal> {
        let head = self.head();
        let position = Vec3::from(self.script.position);
        let instance = self.current()?;
        let local = Quat::from_rotation_y(instance.local_yaw);
        let known = instance.spaces.get(&space.into_raw());
        let known = known.ok_or_else(|| forbidden(sys::Result::ERROR_HANDLE_INVALID, "not a space"))?;
        let origin = match known.kind {
            Kind::Reference(sys::ReferenceSpaceType::VIEW) => head,
            Kind::Reference(sys::ReferenceSpaceType::LOCAL) => (local, position),
            Kind::Reference(sys::ReferenceSpaceType::LOCAL_FLOOR) => (local, position.with_y(0.0)),
            Kind::Reference(_) => (Quat::IDENTITY, Vec3::ZERO),
            Kind::Hand(side) => compose(head, (Quat::IDENTITY, Vec3::new(0.2 * side, -0.3, -0.4))),
        };
        Ok(compose(origin, known.offset))
    }

    fn reference_spaces(&mut self) -> Result<Vec<sys::ReferenceSpaceType>, Refusal> {
        let floor = self.current()?.extensions.iter().any(|e| e == "XR_EXT_local_floor");
        let mut types = vec![
            sys::ReferenceSpaceType::VIEW,
            sys::ReferenceSpaceType::LOCAL,
            sys::ReferenceSpaceType::STAGE,
        ];
        if floor {
            types.push(sys::ReferenceSpaceType::LOCAL_FLOOR);
        }
        Ok(types)
    }

    fn add_space(&mut self, kind: Kind, offset: Pose) -> Result<sys::Space, Refusal> {
        let handle = self.new_handle();
        self.current()?.spaces.insert(handle, Space { kind, offset });
        Ok(sys::Space::from_raw(handle))
    }
}

pub unsafe extern "system" fn enumerate_reference_spaces(
    session: sys::Session,
    capacity: u32,
    count: *mut u32,
    out: *mut sys::ReferenceSpaceType,
) -> sys::Result {
    enter("xrEnumerateReferenceSpaces", |world| {
        world.session(session)?;
        let types = world.reference_spaces()?;
        // SAFETY: as the caller says.
        unsafe { fill(capacity, count, out, &types, |to, from| *to = *from) }
    })
}

pub unsafe extern "system" fn create_reference_space(
    session: sys::Session,
    info: *const sys::ReferenceSpaceCreateInfo,
    out: *mut sys::Space,
) -> sys::Result {
    enter("xrCreateReferenceSpace", |world| {
        world.session(session)?;
        // SAFETY: as the caller says.
        let info = unsafe { &*info };
        if !world.reference_spaces()?.contains(&info.reference_space_type) {
            return Err(forbidden(
                sys::Result::ERROR_REFERENCE_SPACE_UNSUPPORTED,
                format!("{:?} is not offered", info.reference_space_type),
            ));
        }
        let offset = pose(&info.pose_in_reference_space)?;
        let space = world.add_space(Kind::Reference(info.reference_space_type), offset)?;
        // SAFETY: as the caller says.
        unsafe { *out = space };
        DONE
    })
}

pub unsafe extern "system" fn create_action_space(
    session: sys::Session,
    info: *const sys::ActionSpaceCreateInfo,
    out: *mut sys::Space,
) -> sys::Result {
    enter("xrCreateActionSpace", |world| {
        world.session(session)?;
        // SAFETY: as the caller says.
        let info = unsafe { &*info };
        let offset = pose(&info.pose_in_action_space)?;
        let instance = world.current()?;
        instance.actions.check(info.action)?;
        let left = instance.path(info.subaction_path).is_some_and(|path| path.contains("left"));
        let space = world.add_space(Kind::Hand(if left { -1.0 } else { 1.0 }), offset)?;
        // SAFETY: as the caller says.
        unsafe { *out = space };
        DONE
    })
}

pub unsafe extern "system" fn destroy_space(space: sys::Space) -> sys::Result {
    enter("xrDestroySpace", |world| {
        // What is lost can still be destroyed, and what was destroyed with its session is gone.
        let known = world.instance.as_mut().and_then(|instance| instance.spaces.remove(&space.into_raw()));
        known.ok_or_else(|| forbidden(sys::Result::ERROR_HANDLE_INVALID, "not a space"))?;
        DONE
    })
}

pub unsafe extern "system" fn locate_space(
    space: sys::Space,
    base: sys::Space,
    time: sys::Time,
    out: *mut sys::SpaceLocation,
) -> sys::Result {
    enter("xrLocateSpace", |world| {
        world.its_session()?;
        if time.as_nanos() <= 0 {
            return Err(forbidden(sys::Result::ERROR_TIME_INVALID, "the time is not positive"));
        }
        let (space, base) = (world.space_pose(space)?, world.space_pose(base)?);
        // SAFETY: as the caller says.
        let out = unsafe { &mut *out };
        out.location_flags = sys::SpaceLocationFlags::ORIENTATION_VALID
            | sys::SpaceLocationFlags::POSITION_VALID
            | sys::SpaceLocationFlags::ORIENTATION_TRACKED
            | sys::SpaceLocationFlags::POSITION_TRACKED;
        out.pose = raw_pose(compose(inverse(base), space));
        world.success()
    })
}

pub unsafe extern "system" fn get_reference_space_bounds_rect(
    session: sys::Session,
    _: sys::ReferenceSpaceType,
    bounds: *mut sys::Extent2Df,
) -> sys::Result {
    enter("xrGetReferenceSpaceBoundsRect", |world| {
        world.session(session)?;
        // SAFETY: as the caller says.
        unsafe { *bounds = sys::Extent2Df::default() };
        Ok(sys::Result::SPACE_BOUNDS_UNAVAILABLE)
    })
}
