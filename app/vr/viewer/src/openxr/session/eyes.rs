//! The eyes of a frame: as the runtime locates them, and as the viewer's method needs them.

use glam::{Quat, Vec3};
use openxr as xr;

use super::state::Session;
use crate::openxr::error::{XrError, call};
use crate::viewer::Viewer;
use yoro::eyes::{
    DepthRange, EyePair, EyesError, Foveation, Frustum, GuardBand, Pose, StereoViews, ViewLayer,
};
use yoro_render::stereo;
use yoro_settings::Settings;

/// The largest magnitude of a field of view's angles that is accepted, in radians.
const WIDEST: f32 = 1.55;
/// A shorter quaternion has no meaningful direction: it consists of rounding errors.
const SHORTEST: f32 = 1e-3;
/// Canted eyes are rendered parallel only if their frusta grow by at most this factor on either axis.
const MAX_GROWTH: f32 = 1.5;

impl Session {
    /// Returns the eyes as the runtime predicts them, with their insets if it shows insets; `None` while their poses are
    /// unknown. `sizes` are those of the eyes' images and of the insets'.
    pub(super) fn locate(
        &self,
        settings: &Settings,
        time: xr::Time,
        sizes: [[u32; 2]; 2],
    ) -> Result<Option<StereoViews>, XrError> {
        let (flags, views) =
            call("xrLocateViews", self.session.locate_views(self.views, time, &self.spaces.ahead))?;
        if !flags.contains(xr::ViewStateFlags::ORIENTATION_VALID | xr::ViewStateFlags::POSITION_VALID) {
            return Ok(None);
        }
        let (eyes, insets) = match (views.as_slice(), self.inset.is_some()) {
            ([left, right], false) => ([left, right], None),
            ([one], false) => ([one, one], None),
            ([left, right, left_inset, right_inset], true) => {
                ([left, right], Some([left_inset, right_inset]))
            }
            _ => return Err(XrError::InvalidRuntimeData(format!("locates {} views", views.len()))),
        };
        // An invalid pose counts as unknown, whatever the flags say. The insets have the poses of their eyes.
        let [Some(left), Some(right)] = eyes.map(|view| to_pose(&view.pose)) else { return Ok(None) };
        let pair = |views: [&xr::View; 2], size| {
            let mut frusta = [Frustum { left: 0.0, right: 0.0, bottom: 0.0, top: 0.0 }; 2];
            for (frustum, view) in frusta.iter_mut().zip(views) {
                *frustum = to_frustum(&view.fov).ok_or_else(|| {
                    XrError::InvalidRuntimeData(format!("gives an eye the field of view {:?}", view.fov))
                })?;
            }
            let (poses, dominant) = ([left, right], settings.dominant);
            Ok::<_, XrError>(EyePair { poses, frusta, depth: DepthRange::PAPER, size, dominant })
        };
        let wide = pair(eyes, sizes[0])?;
        let inset = insets.map(|insets| pair(insets, sizes[1])).transpose()?;
        Ok(Some(with_inset(wide, inset, settings)))
    }

    /// Returns eyes that the viewer's method can use, close to those of the runtime. An inset keeps the poses of its eye.
    pub(super) fn align(&mut self, viewer: &Viewer, native: StereoViews) -> StereoViews {
        let method = viewer.method().first();
        let reason = native.layers().find_map(|layer| stereo::alignment_error(method, &layer.eyes));
        let aligned = |pair: &EyePair| match reason {
            Some(EyesError::Density { .. } | EyesError::Rows { .. }) => Some(pair.row_aligned()),
            Some(EyesError::Canted { .. } | EyesError::OffAxis { .. }) => pair.rectified(),
            _ => None,
        };
        let is_good = |eyes: &EyePair, native: &EyePair| {
            growth(eyes, native) <= MAX_GROWTH && eyes.synthesis_views(GuardBand::None).is_ok()
        };
        // All levels or none: those of an eye have one pose.
        let aligned = |layer: &ViewLayer| aligned(&layer.eyes).filter(|eyes| is_good(eyes, &layer.eyes));
        let aligned = aligned(&native.wide).and_then(|wide| {
            let inset = match &native.inset {
                Some(inset) => Some(aligned(inset)?),
                None => None,
            };
            Some(with_inset(wide, inset, viewer.settings()))
        });
        let kind = std::mem::discriminant::<EyesError>;
        if reason.as_ref().map(kind) != self.realigned.as_ref().map(kind) {
            if let (Some(eyes), Some(reason)) = (&aligned, &reason) {
                let more = (growth(&eyes.wide.eyes, &native.wide.eyes) - 1.0) * 100.0;
                log::info!(
                    "{}: both eyes are rendered parallel and alike, in frusta up to {more:.0} % wider, and the compositor turns them back",
                    match reason {
                        EyesError::Canted { degrees } =>
                            format!("the eyes are canted by {degrees:.1} degrees"),
                        EyesError::OffAxis { off_axis } =>
                            format!("the eyes are {off_axis:.4} m off one line"),
                        EyesError::Rows { .. } => "the rows of the eyes do not align".into(),
                        _ => "the frusta of the eyes differ in size".into(),
                    }
                );
            }
            self.realigned = reason;
        }
        aligned.unwrap_or(native)
    }
}

/// Returns what eyes see whose insets, if there are any, a runtime shows.
fn with_inset(wide: EyePair, inset: Option<EyePair>, settings: &Settings) -> StereoViews {
    let foveation = settings.foveation.unwrap_or_default().foveation().unwrap_or(Foveation::MEDIUM);
    let inset = inset.map(|eyes| ViewLayer { eyes, nearest: Some(foveation.nearest) });
    StereoViews { inset, ..wide.into() }
}

/// Returns the largest factor by which a side of an eye's frustum has grown.
fn growth(eyes: &EyePair, native: &EyePair) -> f32 {
    let of = |eye: usize, size: fn(&Frustum) -> f32| size(&eyes.frusta[eye]) / size(&native.frusta[eye]);
    [of(0, Frustum::width), of(1, Frustum::width), of(0, Frustum::height), of(1, Frustum::height)]
        .into_iter()
        .fold(1.0, f32::max)
}

/// Converts a pose of OpenXR; `None` if its numbers are not a pose. The specification allows a runtime to deviate from
/// unit length by one percent, and some deviate more, so the quaternion is normalised.
pub fn to_pose(pose: &xr::Posef) -> Option<Pose> {
    let (p, q) = (pose.position, pose.orientation);
    let (position, orientation) = (Vec3::new(p.x, p.y, p.z), Quat::from_xyzw(q.x, q.y, q.z, q.w));
    let length = orientation.length();
    let is_pose = position.is_finite() && length.is_finite() && length > SHORTEST;
    is_pose.then(|| Pose { position, orientation: orientation / length })
}

/// Converts a pose to OpenXR.
pub(super) fn from_pose(pose: &Pose) -> xr::Posef {
    let (p, q) = (pose.position, pose.orientation);
    xr::Posef {
        position: xr::Vector3f { x: p.x, y: p.y, z: p.z },
        orientation: xr::Quaternionf { x: q.x, y: q.y, z: q.z, w: q.w },
    }
}

/// Converts a field of view; `None` if no image can have it.
fn to_frustum(fov: &xr::Fovf) -> Option<Frustum> {
    let angles = [fov.angle_left, fov.angle_right, fov.angle_down, fov.angle_up];
    let fits = angles.iter().all(|angle| angle.abs() < WIDEST);
    let frustum = Frustum::from_fov(fov.angle_left, fov.angle_right, fov.angle_up, fov.angle_down);
    (fits && frustum.width() > 0.0 && frustum.height() > 0.0).then_some(frustum)
}

/// Converts a frustum to a field of view.
pub(super) fn from_frustum(frustum: &Frustum) -> xr::Fovf {
    xr::Fovf {
        angle_left: frustum.left.atan(),
        angle_right: frustum.right.atan(),
        angle_up: frustum.top.atan(),
        angle_down: frustum.bottom.atan(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quaternions_are_normalised_or_refused() {
        let pose = |w: f32, x: f32| xr::Posef {
            orientation: xr::Quaternionf { w, x: 0.0, y: 0.0, z: 0.0 },
            position: xr::Vector3f { x, y: 1.6, z: 0.0 },
        };
        for w in [0.9, 1.0, 1.02, -3.0] {
            let orientation = to_pose(&pose(w, 0.0)).unwrap().orientation;
            assert!(orientation.is_normalized() && orientation.angle_between(Quat::IDENTITY) < 1e-3, "{w}");
        }
        for none in [pose(0.0, 0.0), pose(f32::NAN, 0.0), pose(f32::INFINITY, 0.0), pose(1.0, f32::NAN)] {
            assert_eq!(to_pose(&none), None, "{none:?}");
        }
    }

    #[test]
    fn impossible_fields_of_view_are_refused() {
        let fov = xr::Fovf { angle_left: -0.9, angle_right: 0.7, angle_up: 0.8, angle_down: -0.6 };
        let frustum = to_frustum(&fov).unwrap();
        assert!((frustum.left + 0.9f32.tan()).abs() < 1e-6 && frustum.bottom < 0.0);
        let back = from_frustum(&frustum);
        assert!((back.angle_left - fov.angle_left).abs() < 1e-6 && (back.angle_up - 0.8).abs() < 1e-6);
        for wrong in [
            xr::Fovf { angle_left: 0.8, ..fov },
            xr::Fovf { angle_up: -0.7, ..fov },
            xr::Fovf { angle_right: f32::NAN, ..fov },
            xr::Fovf { angle_right: 1.6, ..fov },
            xr::Fovf::default(),
        ] {
            assert_eq!(to_frustum(&wrong), None, "{wrong:?}");
        }
    }
}
