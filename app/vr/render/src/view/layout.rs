//! Images that hold one view, or both eyes at once.

use glam::{Mat4, Vec4};

use yoro::eyes::Eye;

/// Which views an image holds, and how they are drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Layout {
    /// One view.
    #[default]
    Single,
    /// Both eyes side by side, left first, each triangle drawn twice by instancing.
    DoubleWide(Seam),
    /// Both eyes in the layers of array textures, by GL_OVR_multiview2.
    Layered,
}

/// How an eye's triangles are kept out of the other half of a double-wide target.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Seam {
    /// `gl_ClipDistance`.
    ClipDistance,
    /// `discard`, for drivers without clip distances. Costs early depth tests.
    Discard,
}

impl Layout {
    /// Returns the defines of `render/geometry.vert` and `render/forward.frag`.
    pub fn defines(self) -> &'static [&'static str] {
        match self {
            Layout::Single => &[],
            Layout::DoubleWide(Seam::ClipDistance) => &["STEREO", "CLIP_DISTANCE"],
            Layout::DoubleWide(Seam::Discard) => &["STEREO", "SEAM_DISCARD"],
            Layout::Layered => &["STEREO", "MULTIVIEW"],
        }
    }

    /// Returns the number of instances in each draw call.
    pub fn instances(self) -> usize {
        match self {
            Layout::DoubleWide(_) => 2,
            Layout::Single | Layout::Layered => 1,
        }
    }

    /// Returns the number of columns from the left edge of one eye's image to that of the next. It is even, so that
    /// derivatives are taken over the same 2x2 pixels as in a single view.
    fn stride(width: u32) -> u32 {
        width.next_multiple_of(2)
    }

    /// Returns the size of the textures for views of `size` pixels.
    pub fn texture_size(self, size: [u32; 2]) -> [u32; 2] {
        match self {
            Layout::DoubleWide(_) => [2 * Layout::stride(size[0]), size[1]],
            Layout::Single | Layout::Layered => size,
        }
    }

    /// Returns the lower left corner of an eye's image of `size` pixels.
    pub fn origin(self, size: [u32; 2], eye: Eye) -> [u32; 2] {
        match self {
            Layout::DoubleWide(_) => [Layout::stride(size[0]) * eye.index() as u32, 0],
            Layout::Single | Layout::Layered => [0, 0],
        }
    }

    /// Returns the transform from an eye's clip space to its place in the texture.
    pub fn placement(self, size: [u32; 2], eye: Eye) -> Mat4 {
        let (whole, width) = (self.texture_size(size)[0] as f32, size[0] as f32);
        let left = self.origin(size, eye)[0] as f32;
        let mut placement = Mat4::IDENTITY;
        placement.x_axis.x = width / whole;
        placement.w_axis.x = (2.0 * left + width) / whole - 1.0;
        placement
    }

    /// Returns the plane of an eye's clip volume at the seam, in the space that `eye_to_clip` transforms from.
    pub fn seam_plane(eye_to_clip: &Mat4, eye: Eye) -> Vec4 {
        let rows = eye_to_clip.transpose();
        match eye {
            Eye::Left => rows.w_axis - rows.x_axis,
            Eye::Right => rows.w_axis + rows.x_axis,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_double_wide_layout_puts_the_eyes_side_by_side() {
        let layout = Layout::DoubleWide(Seam::Discard);
        for size in [[64, 32], [17, 5]] {
            let whole = layout.texture_size(size)[0] as f32;
            for eye in Eye::BOTH {
                let place = layout.placement(size, eye);
                let left = layout.origin(size, eye)[0] as f32;
                for (x, pixel) in [(-1.0, left), (1.0, left + size[0] as f32)] {
                    let clip = place * Vec4::new(3.0 * x, 1.0, 2.0, 3.0);
                    assert!(((clip.x / clip.w + 1.0) * 0.5 * whole - pixel).abs() < 1e-4);
                    assert_eq!([clip.y, clip.z, clip.w], [1.0, 2.0, 3.0]);
                }
            }
        }
    }
}
