//! Views in WebXR's form.

use glam::{Quat, Vec3};
use yoro::eyes::{Frustum, Pose};

/// The number of floats per view: position, orientation (x, y, z, w), projection matrix in column-major order.
pub const VIEW_FLOATS: usize = 3 + 4 + 16;

/// Returns pose and frustum of a view; `None` if floats are missing.
pub fn view(floats: &[f32]) -> Option<(Pose, Frustum)> {
    let [x, y, z, qx, qy, qz, qw, m @ ..]: &[f32; VIEW_FLOATS] = floats.first_chunk()?;
    let orientation = Quat::from_xyzw(*qx, *qy, *qz, *qw);
    // x_clip = m0 x + m8 z and w_clip = -z; at the edges, x_clip is -w_clip or w_clip.
    let frustum = Frustum {
        left: (m[8] - 1.0) / m[0],
        right: (m[8] + 1.0) / m[0],
        bottom: (m[9] - 1.0) / m[5],
        top: (m[9] + 1.0) / m[5],
    };
    Some((Pose { position: Vec3::new(*x, *y, *z), orientation }, frustum))
}

#[cfg(test)]
mod tests {
    use super::*;
    use yoro::eyes::{DepthRange, View};

    #[test]
    fn a_frustum_comes_back_from_its_matrix() {
        let frustum = Frustum { left: -1.3, right: 0.9, bottom: -1.1, top: 0.8 };
        let pose = Pose { position: Vec3::new(1.0, 2.0, 3.0), orientation: Quat::from_rotation_y(0.5) };
        let eye = View { pose, frustum, depth: DepthRange::PAPER, size: [8, 8] };
        let mut floats = pose.position.to_array().to_vec();
        floats.extend(pose.orientation.to_array());
        floats.extend(eye.projection().to_cols_array());
        let (found_pose, found) = view(&floats).unwrap();
        assert_eq!(found_pose, pose);
        for (a, b) in [
            (found.left, frustum.left),
            (found.right, frustum.right),
            (found.bottom, frustum.bottom),
            (found.top, frustum.top),
        ] {
            assert!((a - b).abs() < 1e-6, "{found:?}");
        }
        assert_eq!(view(&floats[..20]), None);
        assert_eq!(view(&[]), None);
    }
}
