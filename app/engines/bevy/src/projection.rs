//! The projection of an eye, for Bevy's cameras.

use bevy::camera::{CameraProjection, SubCameraView};
use bevy::math::{Mat4, Vec3A};
use bevy::prelude::{DetectChangesMut, Mut, Projection};
use yoro_wgpu::yoro::eyes::{Frustum, View};

/// The projection of an eye: any frustum, with reversed depth and no far plane.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct EyeProjection {
    clip_from_view: Mat4,
    /// The frustum for which cascades of shadow maps are made. Both levels of an eye have one, or their shadows differ.
    shadowed: Frustum,
    /// Distance beyond which objects are culled.
    far: f32,
}

impl EyeProjection {
    pub(crate) fn new(view: &View, shadowed: Frustum, far: f32) -> EyeProjection {
        EyeProjection { clip_from_view: clip_from_view(view), shadowed, far }
    }

    /// Replaces a camera's projection if it is another one.
    pub(crate) fn replace(self, projection: &mut Mut<Projection>) {
        let inner = projection.bypass_change_detection();
        if let Projection::Custom(custom) = inner
            && let Some(own) = custom.get_mut::<EyeProjection>()
        {
            if *own == self {
                return;
            }
            *own = self;
        } else {
            *inner = Projection::custom(self);
        }
        projection.set_changed();
    }
}

/// Returns the projection matrix of a view.
pub(crate) fn clip_from_view(view: &View) -> Mat4 {
    Mat4::from_cols_array(&view.wgpu_projection().to_cols_array())
}

impl CameraProjection for EyeProjection {
    fn get_clip_from_view(&self) -> Mat4 {
        self.clip_from_view
    }

    fn get_clip_from_view_for_sub(&self, _: &SubCameraView) -> Mat4 {
        self.clip_from_view
    }

    /// Does nothing: the frustum is the eye's, independent of the size of the image.
    fn update(&mut self, _: f32, _: f32) {}

    fn far(&self) -> f32 {
        self.far
    }

    fn get_frustum_corners(&self, z_near: f32, z_far: f32) -> [Vec3A; 8] {
        let Frustum { left, right, bottom, top } = self.shadowed;
        let sides = [(right, bottom), (right, top), (left, top), (left, bottom)];
        std::array::from_fn(|i| {
            let (z, (x, y)) = (if i < 4 { z_near } else { z_far }, sides[i % 4]);
            Vec3A::new(x * z.abs(), y * z.abs(), z)
        })
    }
}
