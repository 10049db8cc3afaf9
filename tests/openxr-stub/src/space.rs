//! Spaces and poses.

use glam::{Quat, Vec3};
use openxr_sys as sys;
use sys::{Handle, Result as Code};

use crate::script::Aim;
use crate::world::{Answer, DONE, Refusal, World, forbid_if, found};

/// A rotation followed by a translation, from a space to its parent.
pub type Pose = (Quat, Vec3);

pub struct Space {
    kind: Kind,
    offset: Pose,
}

enum Kind {
    Reference(sys::ReferenceSpaceType),
    /// The space of a controller. True for the left hand.
    Hand(bool),
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

/// Checks and converts a pose that the application passes.
pub fn pose(raw: &sys::Posef) -> Result<Pose, Refusal> {
    let turn = Quat::from_xyzw(raw.orientation.x, raw.orientation.y, raw.orientation.z, raw.orientation.w);
    let position = Vec3::new(raw.position.x, raw.position.y, raw.position.z);
    forbid_if(
        !((turn.length() - 1.0).abs() < 0.01 && position.is_finite()),
        Code::ERROR_POSE_INVALID,
        format!("{turn:?}, {position:?} is no pose"),
    )?;
    Ok((turn.normalize(), position))
}

impl World {
    /// Returns the pose of a space in the space of the floor.
    pub fn space_pose(&mut self, space: sys::Space) -> Result<Pose, Refusal> {
        let head = self.head();
        let position = Vec3::from(self.script.position);
        let turn = self.aim(space).map_or(Quat::IDENTITY, |aim| {
            Quat::from_rotation_y(aim.yaw_degrees.to_radians())
                * Quat::from_rotation_x(aim.pitch_degrees.to_radians())
        });
        let instance = self.current()?;
        let local = Quat::from_rotation_y(instance.local_yaw);
        let known = instance.spaces.get(&space.into_raw());
        let known = found(known, "not a space")?;
        let origin = match known.kind {
            Kind::Reference(sys::ReferenceSpaceType::VIEW) => head,
            Kind::Reference(sys::ReferenceSpaceType::LOCAL) => (local, position),
            Kind::Reference(sys::ReferenceSpaceType::LOCAL_FLOOR) => (local, position.with_y(0.0)),
            Kind::Reference(_) => (Quat::IDENTITY, Vec3::ZERO),
            Kind::Hand(is_left) => {
                let side = if is_left { -0.2 } else { 0.2 };
                compose(head, (turn, Vec3::new(side, -0.3, -0.2)))
            }
        };
        Ok(compose(origin, known.offset))
    }

    fn is_hand(&self, space: sys::Space) -> bool {
        let known = self.instance.as_ref().and_then(|instance| instance.spaces.get(&space.into_raw()));
        known.is_some_and(|space| matches!(space.kind, Kind::Hand(_)))
    }

    /// Returns the aim ray of a controller's space, or `None` for other spaces and for hands that are not tracked.
    fn aim(&self, space: sys::Space) -> Option<&Aim> {
        match self.instance.as_ref()?.spaces.get(&space.into_raw())?.kind {
            Kind::Hand(is_left) => self.script.aim(is_left, self.frame()),
            Kind::Reference(_) => None,
        }
    }

    fn reference_spaces(&mut self) -> Result<Vec<sys::ReferenceSpaceType>, Refusal> {
        let floor = self.current()?.has("XR_EXT_local_floor");
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

pub fn create_reference_space(
    world: &mut World,
    session: sys::Session,
    info: &sys::ReferenceSpaceCreateInfo,
    out: &mut sys::Space,
) -> Answer {
    world.session(session)?;
    forbid_if(
        !world.reference_spaces()?.contains(&info.reference_space_type),
        Code::ERROR_REFERENCE_SPACE_UNSUPPORTED,
        format!("{:?} is not offered", info.reference_space_type),
    )?;
    let offset = pose(&info.pose_in_reference_space)?;
    let space = world.add_space(Kind::Reference(info.reference_space_type), offset)?;
    *out = space;
    DONE
}

pub fn create_action_space(
    world: &mut World,
    session: sys::Session,
    info: &sys::ActionSpaceCreateInfo,
    out: &mut sys::Space,
) -> Answer {
    world.session(session)?;
    let offset = pose(&info.pose_in_action_space)?;
    let instance = world.current()?;
    instance.actions.check(info.action)?;
    let left = instance.path(info.subaction_path).is_some_and(|path| path.contains("left"));
    let space = world.add_space(Kind::Hand(left), offset)?;
    *out = space;
    DONE
}

pub fn destroy_space(world: &mut World, space: sys::Space) -> Answer {
    // Spaces of a lost session can still be destroyed, but not those that were destroyed with their session.
    let known = world.instance.as_mut().and_then(|instance| instance.spaces.remove(&space.into_raw()));
    found(known, "not a space")?;
    DONE
}

pub fn locate_space(
    world: &mut World,
    space: sys::Space,
    base: sys::Space,
    time: sys::Time,
    out: &mut sys::SpaceLocation,
) -> Answer {
    world.its_session()?;
    forbid_if(time.as_nanos() <= 0, Code::ERROR_TIME_INVALID, "the time is not positive")?;
    let is_lost = world.is_hand(space) && world.aim(space).is_none();
    let (space, base) = (world.space_pose(space)?, world.space_pose(base)?);
    out.location_flags = sys::SpaceLocationFlags::ORIENTATION_VALID
        | sys::SpaceLocationFlags::POSITION_VALID
        | sys::SpaceLocationFlags::ORIENTATION_TRACKED
        | sys::SpaceLocationFlags::POSITION_TRACKED;
    out.pose = raw_pose(compose(inverse(base), space));
    if is_lost {
        out.location_flags = sys::SpaceLocationFlags::EMPTY;
    }
    world.success()
}
