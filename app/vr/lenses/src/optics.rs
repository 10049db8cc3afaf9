//! Lens optics: distortion, what each eye sees of the screen, and the mesh that undoes the distortion.
//!
//! The formulas are those of the Cardboard SDK, so that every viewer looks as its maker tuned it. Lengths beyond the
//! lens are tangents of the viewing angle.

use glam::Vec2;

use crate::params::{VerticalAlignment, ViewerParams};
use yoro::eyes::{Eye, Frustum};

/// Number of rows and of columns of the mesh's vertices.
pub(crate) const MESH_RESOLUTION: usize = 40;
/// Distance from the tray to the lower edge of the screen, in metres: the phone's border.
const BORDER: f32 = 0.003;
/// Width and height of a phone's screen in metres, for devices that do not report their own.
const FALLBACK_SCREEN: [f32; 2] = [0.110, 0.062];

/// The radial distortion of a lens. A point of the screen at radius `r` (tangent, without the lens) is seen at
/// `r (1 + k1 r^2 + k2 r^4 + ...)`.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Distortion {
    coefficients: Vec<f32>,
}

impl Distortion {
    /// Creates it from the coefficients k1, k2, ...
    pub fn new(coefficients: &[f32]) -> Distortion {
        Distortion { coefficients: coefficients.to_vec() }
    }

    /// Returns the radius at which a point at radius `r` of the screen is seen.
    pub fn distort(&self, r: f32) -> f32 {
        let square = r * r;
        let factor = self.coefficients.iter().rev().fold(0.0, |sum, k| (sum + k) * square);
        r * (1.0 + factor)
    }

    /// Returns the radius of the screen that is seen at `r`, by the secant method to 1e-4, as in the reference.
    pub fn undistort(&self, r: f32) -> f32 {
        if r <= 0.0 {
            return 0.0;
        }
        let (mut r0, mut r1) = (r / 2.0, r / 3.0);
        let mut error0 = r - self.distort(r0);
        // Polynomials that are not monotonic have no inverse everywhere, hence the limit.
        for _ in 0..32 {
            if (r1 - r0).abs() <= 1e-4 {
                break;
            }
            let error1 = r - self.distort(r1);
            if error1 == error0 {
                break;
            }
            let r2 = r1 - error1 * (r1 - r0) / (error1 - error0);
            (r0, r1, error0) = (r1, r2, error1);
        }
        if r1.is_finite() { r1.clamp(0.0, r.max(1.0)) } else { r }
    }

    fn undistort_point(&self, point: Vec2) -> Vec2 {
        let r = point.length();
        if r < 1e-9 { point } else { point * (self.undistort(r) / r) }
    }
}

/// The rotation of the screen's content relative to the device's own upright position.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Rotation {
    /// The device is upright.
    Portrait,
    /// The device's top points left, as viewers hold phones.
    #[default]
    LandscapeLeft,
    /// The device's top points right.
    LandscapeRight,
}

/// The screen behind the lenses.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Screen {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Pixels per inch along both axes, as the device reports them; implausible and non-finite values mean unknown.
    pub dpi: [f32; 2],
    /// The rotation of the content, which relates the sensors' axes to the screen's.
    pub rotation: Rotation,
}

impl Screen {
    /// Returns the width and height in metres, or those of a typical phone if `dpi` is implausible.
    pub fn metres(&self) -> [f32; 2] {
        let metres = [0, 1].map(|i| self.size[i] as f32 / self.dpi[i] * 0.0254);
        // Phones and tablets are well inside this range; some devices report 0, or 160 for everything.
        let plausible = |m: f32| m.is_finite() && (0.03..0.4).contains(&m);
        if metres.into_iter().all(plausible) { metres } else { FALLBACK_SCREEN }
    }
}

/// One vertex of the mesh: 16 bytes, uploaded as is.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub(crate) struct MeshVertex {
    /// Position on the screen, in clip coordinates of the whole screen.
    pub position: Vec2,
    /// Position in the eye's image, from its lower left corner.
    pub uv: Vec2,
}

/// A viewer with a screen in it.
#[derive(Clone, Debug, PartialEq)]
pub struct Optics {
    params: ViewerParams,
    distortion: Distortion,
    screen: [f32; 2],
}

impl Optics {
    /// Combines a viewer with a screen of the given size in metres.
    pub fn new(params: &ViewerParams, screen_metres: [f32; 2]) -> Optics {
        Optics {
            params: params.clone(),
            distortion: Distortion::new(&params.distortion),
            screen: screen_metres,
        }
    }

    /// Returns the viewer's parameters.
    pub fn params(&self) -> &ViewerParams {
        &self.params
    }

    /// Returns the width and height of the screen in metres.
    pub fn screen(&self) -> [f32; 2] {
        self.screen
    }

    /// Returns the height of the lenses' centres above the screen's lower edge, in metres.
    fn lens_height(&self) -> f32 {
        let from_tray = self.params.tray_to_lens - BORDER;
        match self.params.alignment {
            VerticalAlignment::Bottom => from_tray,
            VerticalAlignment::Center => self.screen[1] / 2.0,
            VerticalAlignment::Top => self.screen[1] - from_tray,
        }
    }

    /// Returns the centre of an eye's lens on the screen, in metres from the lower left corner.
    pub fn lens_center(&self, eye: Eye) -> Vec2 {
        let x = (self.screen[0] + eye.side() * self.params.inter_lens) / 2.0;
        Vec2::new(x, self.lens_height())
    }

    /// Returns the half-angles of an eye in radians: left, right, bottom, top. They cover what the lens shows of the
    /// screen, but not more than the viewer allows.
    pub fn half_angles(&self, eye: Eye) -> [f32; 4] {
        let [width, height] = self.screen;
        let bottom = self.lens_height();
        let edges =
            [(width - self.params.inter_lens) / 2.0, self.params.inter_lens / 2.0, bottom, height - bottom];
        let mut angles = [0.0; 4];
        for (i, edge) in edges.into_iter().enumerate() {
            let seen = self.distortion.distort(edge / self.params.screen_to_lens).atan();
            // A lens beyond the edge of the screen would leave no frustum.
            angles[i] = seen.min(self.params.fov_degrees[i].to_radians()).max(0.01);
        }
        let [outer, inner, bottom, top] = angles;
        match eye {
            Eye::Left => [outer, inner, bottom, top],
            Eye::Right => [inner, outer, bottom, top],
        }
    }

    /// Returns the frustum of an eye.
    pub fn frustum(&self, eye: Eye) -> Frustum {
        let [left, right, bottom, top] = self.half_angles(eye);
        Frustum::from_fov(-left, right, top, -bottom)
    }

    /// Returns the size of an eye's image, in pixels, at which its pixels match the screen's at the lens's centre.
    pub fn full_size(&self, screen_pixels: [u32; 2]) -> [f32; 2] {
        let frustum = self.frustum(Eye::Left);
        let per_tangent =
            [0, 1].map(|i| screen_pixels[i] as f32 / self.screen[i] * self.params.screen_to_lens);
        [frustum.width() * per_tangent[0], frustum.height() * per_tangent[1]]
    }

    /// Returns the mesh of an eye: [`MESH_RESOLUTION`] squared vertices, row by row from the lower left corner.
    pub(crate) fn mesh(&self, eye: Eye) -> Vec<MeshVertex> {
        let frustum = self.frustum(eye);
        let lens = self.params.screen_to_lens;
        let center = self.lens_center(eye) / lens;
        let screen = Vec2::from(self.screen) / lens;
        let step = 1.0 / (MESH_RESOLUTION - 1) as f32;
        let indices = (0..MESH_RESOLUTION).flat_map(|row| (0..MESH_RESOLUTION).map(move |col| (row, col)));
        let vertex = |(row, col): (usize, usize)| {
            let uv = Vec2::new(col as f32, row as f32) * step;
            let seen =
                Vec2::new(frustum.left, frustum.bottom) + uv * Vec2::new(frustum.width(), frustum.height());
            let on_screen = (self.distortion.undistort_point(seen) + center) / screen;
            MeshVertex { position: on_screen * 2.0 - 1.0, uv }
        };
        indices.map(vertex).collect()
    }
}

/// Returns the mesh's triangles as one strip that goes back and forth; each turn repeats a vertex.
pub(crate) fn mesh_strip() -> Vec<u32> {
    let n = MESH_RESOLUTION as u32;
    let mut strip = Vec::with_capacity(3158);
    for row in 0..n - 1 {
        strip.extend(strip.last().copied());
        for i in 0..n {
            let col = if row % 2 == 0 { i } else { n - 1 - i };
            strip.extend([row * n + col, (row + 1) * n + col]);
        }
    }
    strip
}

#[cfg(test)]
mod tests {
    use super::*;

    fn close(a: f32, b: f32, tolerance: f32) {
        assert!((a - b).abs() <= tolerance, "{a} is not {b}");
    }

    fn v1_phone() -> Optics {
        Optics::new(&ViewerParams::v1(), [0.110, 0.062])
    }

    #[test]
    fn distortion_of_the_built_in_viewers() {
        let v1 = Distortion::new(&ViewerParams::v1().distortion);
        let v2 = Distortion::new(&ViewerParams::v2().distortion);
        let radii = [0.25, 0.5, 0.75, 1.0];
        for (r, seen) in radii.into_iter().zip([0.257043, 0.56, 0.973066, 1.597]) {
            close(v1.distort(r), seen, 1e-6);
        }
        for (r, seen) in radii.into_iter().zip([0.255850, 0.559688, 1.023955, 1.89]) {
            close(v2.distort(r), seen, 1e-6);
        }
        close(v1.undistort(1.0), 0.76338, 1e-4);
        close(v1.undistort(0.5), 0.45532, 1e-4);
        close(v2.undistort(1.0), 0.74007, 1e-4);
        assert_eq!(v1.undistort(0.0), 0.0);
    }

    #[test]
    fn the_left_eye_sees_the_references_frustum_through_v1() {
        let angles = v1_phone().half_angles(Eye::Left).map(f32::to_degrees);
        for (angle, expected) in angles.into_iter().zip([34.9882, 40.0, 40.0, 40.0]) {
            close(angle, expected, 1e-3);
        }
        let [left, right, ..] = v1_phone().half_angles(Eye::Right).map(f32::to_degrees);
        close(left, 40.0, 1e-3);
        close(right, 34.9882, 1e-3);
    }

    #[test]
    fn mesh_of_the_left_eye_of_v1() {
        let mesh = v1_phone().mesh(Eye::Left);
        assert_eq!(mesh.len(), 1600);
        for (i, x, y) in [
            (0, -0.94030, -0.80760),
            (39, -0.08725, -0.78068),
            (820, -0.47749, 0.06130),
            (1599, -0.08725, 0.84520),
        ] {
            close(mesh[i].position.x, x, 2e-4);
            close(mesh[i].position.y, y, 2e-4);
        }
        assert_eq!((mesh[0].uv, mesh[1599].uv), (Vec2::ZERO, Vec2::ONE));
    }

    #[test]
    fn the_right_eye_mirrors_the_left() {
        let optics = v1_phone();
        let (left, right) = (optics.mesh(Eye::Left), optics.mesh(Eye::Right));
        for row in 0..MESH_RESOLUTION {
            for col in 0..MESH_RESOLUTION {
                let a = left[row * MESH_RESOLUTION + col].position;
                let b = right[row * MESH_RESOLUTION + MESH_RESOLUTION - 1 - col].position;
                close(a.x, -b.x, 1e-5);
                close(a.y, b.y, 1e-5);
            }
        }
    }

    #[test]
    fn the_mesh_is_one_strip() {
        let strip = mesh_strip();
        assert_eq!(strip.len(), 2 * 39 * 40 + 38);
        assert_eq!(strip[..4], [0, 40, 1, 41]);
        assert_eq!(strip[79..84], [79, 79, 79, 119, 78]);
        assert_eq!(strip.last(), Some(&1599));
    }

    #[test]
    fn alignment_of_the_screen() {
        let mut params = ViewerParams::v1();
        let screen = [0.2, 0.1];
        close(Optics::new(&params, screen).lens_center(Eye::Left).y, 0.032, 1e-6);
        params.alignment = VerticalAlignment::Top;
        close(Optics::new(&params, screen).lens_center(Eye::Left).y, 0.068, 1e-6);
        params.alignment = VerticalAlignment::Center;
        let center = Optics::new(&params, screen).lens_center(Eye::Right);
        close(center.x, 0.13, 1e-6);
        close(center.y, 0.05, 1e-6);
    }

    #[test]
    fn an_unknown_screen_counts_as_a_usual_phone() {
        let screen = |dpi| Screen { size: [1920, 1080], dpi: [dpi; 2], rotation: Rotation::default() };
        close(screen(440.0).metres()[0], 0.110836, 1e-5);
        for dpi in [0.0, f32::NAN, -3.0, 20.0, f32::INFINITY] {
            assert_eq!(screen(dpi).metres(), FALLBACK_SCREEN);
        }
    }

    proptest::proptest! {
        #[test]
        fn undistort_is_finite_for_every_polynomial(k1 in -2f32..2.0, k2 in -2f32..2.0, r in 0f32..4.0) {
            let inverse = Distortion::new(&[k1, k2]).undistort(r);
            proptest::prop_assert!(inverse.is_finite() && inverse >= 0.0);
        }
    }
}
