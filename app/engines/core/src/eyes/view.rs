//! An eye's pose, frustum and image.

use glam::{DVec3, Mat4, Quat, Vec3, Vec4};

use super::{DepthRange, EyesError};

/// A rigid pose in the world.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Pose {
    /// Position in metres.
    pub position: Vec3,
    /// Rotation from local to world axes.
    pub orientation: Quat,
}

impl Pose {
    /// The pose at the origin that looks along -Z.
    pub const IDENTITY: Pose = Pose { position: Vec3::ZERO, orientation: Quat::IDENTITY };

    /// Returns a pose at `position` that looks at `target`, with the world's Y axis as its up direction; -Z if it looks
    /// straight up or down.
    pub fn look_at(position: Vec3, target: Vec3) -> Pose {
        let forward = (target - position).try_normalize().unwrap_or(Vec3::NEG_Z);
        let up = if forward.y.abs() > 0.9999 { Vec3::NEG_Z } else { Vec3::Y };
        let right = forward.cross(up).normalize();
        let orientation = Quat::from_mat3(&glam::Mat3::from_cols(right, right.cross(forward), -forward));
        Pose { position, orientation }
    }

    /// True if the position is finite and the orientation is a rotation, within rounding.
    pub(super) fn is_valid(&self) -> bool {
        self.position.is_finite() && (self.orientation.length_squared() - 1.0).abs() < 1e-2
    }

    /// Returns the unit vector to the right.
    pub fn right(&self) -> Vec3 {
        self.orientation * Vec3::X
    }

    /// Returns the unit vector straight ahead.
    pub fn forward(&self) -> Vec3 {
        self.orientation * Vec3::NEG_Z
    }

    /// Returns the pose moved along its own axes by `offset`, in metres.
    pub fn translated_local(&self, offset: Vec3) -> Pose {
        Pose { position: self.position + self.orientation * offset, orientation: self.orientation }
    }

    /// Returns the matrix from world space to local space.
    pub fn view_matrix(&self) -> Mat4 {
        Mat4::from_rotation_translation(self.orientation, self.position).inverse()
    }
}

/// A view frustum, as the tangents of its four half-angles. `left` and `bottom` are negative if it contains its axis.
/// [`Frustum::from_fov`] converts OpenXR's angles.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Frustum {
    /// Tangent of the left edge.
    pub left: f32,
    /// Tangent of the right edge.
    pub right: f32,
    /// Tangent of the bottom edge.
    pub bottom: f32,
    /// Tangent of the top edge.
    pub top: f32,
}

impl Frustum {
    /// Returns a symmetric frustum with this vertical field of view, in radians, and aspect ratio width / height.
    pub fn symmetric(fov_y: f32, aspect: f32) -> Frustum {
        let top = (fov_y * 0.5).tan();
        let right = top * aspect;
        Frustum { left: -right, right, bottom: -top, top }
    }

    /// Returns the frustum of OpenXR's `XrFovf`: angles in radians from the axis, `left` and `down` negative if the
    /// frustum contains the axis.
    pub fn from_fov(angle_left: f32, angle_right: f32, angle_up: f32, angle_down: f32) -> Frustum {
        Frustum {
            left: angle_left.tan(),
            right: angle_right.tan(),
            bottom: angle_down.tan(),
            top: angle_up.tan(),
        }
    }

    /// Returns the width at a distance of 1.
    pub fn width(&self) -> f32 {
        self.right - self.left
    }

    /// Returns the height at a distance of 1.
    pub fn height(&self) -> f32 {
        self.top - self.bottom
    }

    pub(super) fn is_finite(&self) -> bool {
        [self.left, self.right, self.bottom, self.top].iter().all(|tangent| tangent.is_finite())
    }
}

/// A rendered image: pose, frustum, depth range and size.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// Pose of the eye.
    pub pose: Pose,
    /// Frustum, whose edges are the outer edges of the image.
    pub frustum: Frustum,
    /// Depth planes and encoding.
    pub depth: DepthRange,
    /// Width and height in pixels.
    pub size: [u32; 2],
}

impl View {
    /// Returns the matrix from local to clip space, for OpenGL's default clip volume (-w..w on each axis). The depth
    /// buffer then has the values of [`DepthRange`], in both conventions; but this volume costs reversed depth its
    /// precision far away. With glClipControl, take [`View::wgpu_projection`].
    pub fn projection(&self) -> Mat4 {
        let f = &self.frustum;
        let (c, m) = self.depth.inverse_distance_law();
        // depth = (1/z - c) / m, and z_ndc = 2 depth - 1 with z = -z_local.
        let (a, b) = ((-2.0 * c / m - 1.0) as f32, (2.0 / m) as f32);
        Mat4::from_cols(
            Vec4::new(2.0 / f.width(), 0.0, 0.0, 0.0),
            Vec4::new(0.0, 2.0 / f.height(), 0.0, 0.0),
            Vec4::new((f.right + f.left) / f.width(), (f.top + f.bottom) / f.height(), -a, -1.0),
            Vec4::new(0.0, 0.0, b, 0.0),
        )
    }

    /// Returns the matrix from local to clip space for Vulkan: y points down, depth is 0..w, and the image has row 0 at
    /// the top. The depth buffer then has the values of [`DepthRange`], in both conventions.
    pub fn vulkan_projection(&self) -> Mat4 {
        Mat4::from_diagonal(Vec4::new(1.0, -1.0, 1.0, 1.0)) * self.wgpu_projection()
    }

    /// Returns the matrix from local to clip space for wgpu, WebGPU, Metal and Direct3D: y points up, depth is 0..w,
    /// and the image has row 0 at the top. The depth buffer then has the values of [`DepthRange`], in both conventions.
    /// It serves OpenGL with `glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE)`, too, where row 0 is at the bottom.
    pub fn wgpu_projection(&self) -> Mat4 {
        let to_wgpu =
            Mat4::from_cols(Vec4::X, Vec4::Y, Vec4::new(0.0, 0.0, 0.5, 0.0), Vec4::new(0.0, 0.0, 0.5, 1.0));
        to_wgpu * self.projection()
    }

    /// Checks pose, frustum, depth planes and size.
    pub(super) fn check(&self) -> Result<(), EyesError> {
        let f = &self.frustum;
        if !self.pose.is_valid() || !f.is_finite() {
            return Err(EyesError::Invalid);
        }
        if self.size.contains(&0) {
            return Err(EyesError::NoPixels);
        }
        // Written so that NaN fails, too.
        if !(f.width() > 0.0 && f.height() > 0.0) {
            return Err(EyesError::Empty);
        }
        let range = &self.depth;
        // Projection matrices contain twice the product of the planes.
        let product = if range.far.is_finite() { range.near * range.far } else { range.near };
        let planes = range.near > 0.0 && range.near < range.far && (2.0 * product).is_finite();
        if planes { Ok(()) } else { Err(EyesError::Planes) }
    }

    /// Returns the directions of the image's four corners in local space, at distance 1 along the axis.
    pub(super) fn corners(&self) -> [DVec3; 4] {
        let f = &self.frustum;
        [[f.left, f.bottom], [f.right, f.bottom], [f.left, f.top], [f.right, f.top]]
            .map(|[x, y]| DVec3::new(x.into(), y.into(), -1.0))
    }

    /// Returns the matrix from world to clip space.
    pub fn view_projection(&self) -> Mat4 {
        self.projection() * self.pose.view_matrix()
    }
}

#[cfg(test)]
mod tests {
    use super::super::DepthConvention;
    use super::*;

    #[test]
    fn planes_are_projected_to_0_and_w_and_up_to_where_row_0_is() {
        for (convention, far, at_planes) in [
            (DepthConvention::Standard, 50.0, [0.0, 1.0]),
            (DepthConvention::Reversed, 50.0, [1.0, 0.0]),
            (DepthConvention::Reversed, f32::INFINITY, [1.0, 0.0]),
        ] {
            let view = View {
                pose: Pose::IDENTITY,
                frustum: Frustum { left: -0.5, right: 0.7, bottom: -0.8, top: 0.6 },
                depth: DepthRange { near: 0.5, far, convention },
                size: [64, 64],
            };
            let project = |z: f32, depth: f32| {
                let corner = Vec3::new(view.frustum.right * z, view.frustum.top * z, -z);
                for (projection, y) in [(view.vulkan_projection(), -1.0), (view.wgpu_projection(), 1.0)] {
                    let clip = projection * corner.extend(1.0);
                    let ndc = clip.truncate() / clip.w;
                    assert!((ndc - Vec3::new(1.0, y, depth)).length() < 1e-4, "{convention:?}: {ndc}");
                }
            };
            project(0.5, at_planes[0]);
            project(far.min(1e6), at_planes[1]);
        }
    }

    #[test]
    fn angles_have_the_signs_of_openxr() {
        let frustum = Frustum::from_fov(-0.9, 0.7, 0.6, -0.8);
        assert_eq!(frustum.left, -0.9f32.tan());
        assert_eq!(frustum.right, 0.7f32.tan());
        assert_eq!(frustum.top, 0.6f32.tan());
        assert_eq!(frustum.bottom, -0.8f32.tan());
    }
}
