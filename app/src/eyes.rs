//! Which eye is where: poses, frusta, depth ranges, and the law that moves a pixel from one eye to the other.
//!
//! Units are metres and radians; pixels have their centre at +0.5. The world is right-handed with Y up,
//! and an eye looks along its own -Z with X to the right.

use std::fmt::{self, Display};
use std::str::FromStr;

use glam::{Mat4, Quat, Vec3, Vec4};

/// One of the two eyes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Eye {
    /// The left eye.
    Left,
    /// The right eye.
    Right,
}

impl Eye {
    /// Both eyes, left first.
    pub const BOTH: [Eye; 2] = [Eye::Left, Eye::Right];

    /// The other eye.
    pub fn other(self) -> Eye {
        match self {
            Eye::Left => Eye::Right,
            Eye::Right => Eye::Left,
        }
    }

    /// 0 for left, 1 for right: the layer of the eye in every two-element array.
    pub fn index(self) -> usize {
        self as usize
    }

    /// -1 for left, +1 for right: the side of the head along its X axis.
    pub fn side(self) -> f32 {
        match self {
            Eye::Left => -1.0,
            Eye::Right => 1.0,
        }
    }

    /// `left` or `right`.
    pub fn name(self) -> &'static str {
        match self {
            Eye::Left => "left",
            Eye::Right => "right",
        }
    }
}

/// A rigid pose in the world.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Pose {
    /// Position in metres.
    pub position: Vec3,
    /// Rotation from the local axes to the world's.
    pub orientation: Quat,
}

impl Pose {
    /// At the origin, looking along -Z.
    pub const IDENTITY: Pose = Pose { position: Vec3::ZERO, orientation: Quat::IDENTITY };

    /// A pose at `position` that looks at `target` with the world's Y up. Looking straight up or down
    /// takes -Z as the up direction.
    pub fn look_at(position: Vec3, target: Vec3) -> Pose {
        let forward = (target - position).try_normalize().unwrap_or(Vec3::NEG_Z);
        let up = if forward.y.abs() > 0.9999 { Vec3::NEG_Z } else { Vec3::Y };
        let right = forward.cross(up).normalize();
        let orientation = Quat::from_mat3(&glam::Mat3::from_cols(right, right.cross(forward), -forward));
        Pose { position, orientation }
    }

    /// The unit vector to the right.
    pub fn right(&self) -> Vec3 {
        self.orientation * Vec3::X
    }

    /// The unit vector straight ahead.
    pub fn forward(&self) -> Vec3 {
        self.orientation * Vec3::NEG_Z
    }

    /// The same pose moved along its own axes by `offset` metres.
    pub fn translated_local(&self, offset: Vec3) -> Pose {
        Pose { position: self.position + self.orientation * offset, orientation: self.orientation }
    }

    /// World to local.
    pub fn view_matrix(&self) -> Mat4 {
        Mat4::from_rotation_translation(self.orientation, self.position).inverse()
    }
}

/// A view frustum by the tangents of its four half-angles; `left` and `bottom` are negative for a frustum
/// that contains its axis. The convention of OpenXR's `XrFovf`, with tangents for angles.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
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
    /// A symmetric frustum from the vertical field of view (radians) and the aspect ratio width / height.
    pub fn symmetric(fov_y: f32, aspect: f32) -> Frustum {
        let top = (fov_y * 0.5).tan();
        let right = top * aspect;
        Frustum { left: -right, right, bottom: -top, top }
    }

    /// A frustum from its four half-angles in radians, all positive outwards.
    pub fn from_angles(left: f32, right: f32, bottom: f32, top: f32) -> Frustum {
        Frustum { left: -left.tan(), right: right.tan(), bottom: -bottom.tan(), top: top.tan() }
    }

    /// Width at distance 1.
    pub fn width(&self) -> f32 {
        self.right - self.left
    }

    /// Height at distance 1.
    pub fn height(&self) -> f32 {
        self.top - self.bottom
    }
}

/// What the values in a depth buffer mean.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum DepthConvention {
    /// 0 at the near plane, 1 at the far plane; tested with LESS.
    Standard,
    /// 1 at the near plane, 0 at the far plane; tested with GREATER.
    Reversed,
}

/// Near and far plane (metres, along the viewing axis) and the encoding of depth between them.
/// `far` may be infinite.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct DepthRange {
    /// Distance of the near plane in metres.
    pub near: f32,
    /// Distance of the far plane in metres, possibly infinite.
    pub far: f32,
    /// Meaning of the stored value.
    pub convention: DepthConvention,
}

impl DepthRange {
    /// Unity's default planes, which the paper uses (0.3 m and 1000 m), in standard depth.
    pub const PAPER: DepthRange =
        DepthRange { near: 0.3, far: 1000.0, convention: DepthConvention::Standard };

    /// `(c, m)` of the affine law `1 / z = c + m * depth`, z in metres.
    pub fn inverse_distance_law(&self) -> (f64, f64) {
        let (near, far) = (1.0 / self.near as f64, 1.0 / self.far as f64);
        match self.convention {
            DepthConvention::Standard => (near, far - near),
            DepthConvention::Reversed => (far, near - far),
        }
    }

    /// Distance along the axis in metres of a stored depth value.
    pub fn distance(&self, depth: f32) -> f32 {
        let (c, m) = self.inverse_distance_law();
        (1.0 / (c + m * depth as f64)) as f32
    }

    /// Stored depth value of a distance along the axis in metres.
    pub fn depth(&self, distance: f32) -> f32 {
        let (c, m) = self.inverse_distance_law();
        ((1.0 / distance as f64 - c) / m) as f32
    }

    /// The stored value of the far plane, with which the depth buffer is cleared.
    pub fn clear_value(&self) -> f32 {
        match self.convention {
            DepthConvention::Standard => 1.0,
            DepthConvention::Reversed => 0.0,
        }
    }
}

/// Everything that defines one rendered image: pose, frustum, depth range and size.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// Pose of the eye.
    pub pose: Pose,
    /// Frustum; its edges are the outer edges of the image.
    pub frustum: Frustum,
    /// Depth planes and encoding.
    pub depth: DepthRange,
    /// Width and height in pixels.
    pub size: [u32; 2],
}

impl View {
    /// Local to clip space, for OpenGL's default clip volume (-w..w on each axis): a depth buffer then holds
    /// what [`DepthRange`] says, in both conventions.
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

    /// World to clip space.
    pub fn view_projection(&self) -> Mat4 {
        self.projection() * self.pose.view_matrix()
    }
}

/// The largest interpupillary distance that is accepted, in metres.
pub const MAX_IPD: f32 = 0.08;

/// Why a pair of eyes cannot be synthesized from one.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum EyesError {
    /// The eyes are rotated against each other.
    #[error(
        "the eyes are canted by {degrees:.2} degrees against each other; synthesis moves pixels along rows only: render both eyes, or give both the same orientation"
    )]
    Canted {
        /// Angle between the two viewing directions.
        degrees: f32,
    },
    /// The eyes are displaced along more than their X axis.
    #[error(
        "the eyes are displaced by {off_axis:.4} m off their common X axis; synthesis moves pixels along rows only: place both eyes on one horizontal line"
    )]
    OffAxis {
        /// Displacement in metres perpendicular to the X axis.
        off_axis: f32,
    },
    /// The left eye is right of the right eye, or the distance is beyond [`MAX_IPD`].
    #[error(
        "the interpupillary distance is {ipd:.4} m; it must be between 0 and 0.08 m, left eye on the left"
    )]
    Ipd {
        /// The distance found, in metres.
        ipd: f32,
    },
    /// The two frusta have different tangents per pixel.
    #[error(
        "the eyes have different pixel densities ({left:.6} and {right:.6} tangents per pixel on one axis); give both the same size and frusta of the same width and height"
    )]
    Density {
        /// Tangent per pixel of the left eye.
        left: f32,
        /// Tangent per pixel of the right eye.
        right: f32,
    },
    /// A frustum without area, or depth planes out of order.
    #[error(
        "the frustum is empty or the depth planes are out of order: need left < right, bottom < top and 0 < near < far"
    )]
    Empty,
}

/// How much wider than its eye the dominant view is rendered, so that the other eye finds its outer border.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum GuardBand {
    /// No guard band: as in the paper; the outer border of the other eye is a hole.
    None,
    /// As many pixels as it takes for surfaces at this distance (metres) or farther.
    Distance(f32),
    /// A number of pixels.
    Pixels(u32),
}

/// A text that is no [`GuardBand`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("give none, pixels such as 40px, or metres such as 1.0")]
pub struct ParseGuardBandError;

/// `none`, up to 1024 pixels (`40px`), or 0.05 to 1000 metres (`1.0`).
impl FromStr for GuardBand {
    type Err = ParseGuardBandError;

    fn from_str(text: &str) -> Result<GuardBand, ParseGuardBandError> {
        match (text, text.strip_suffix("px")) {
            ("none", _) => Some(GuardBand::None),
            (_, Some(pixels)) => pixels.parse().ok().filter(|n| *n <= 1024).map(GuardBand::Pixels),
            (metres, None) => {
                metres.parse().ok().filter(|z| (0.05..=1000.0).contains(z)).map(GuardBand::Distance)
            }
        }
        .ok_or(ParseGuardBandError)
    }
}

/// As [`FromStr`] reads it.
impl Display for GuardBand {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            GuardBand::None => f.write_str("none"),
            GuardBand::Pixels(n) => write!(f, "{n}px"),
            GuardBand::Distance(z) => write!(f, "{z}"),
        }
    }
}

/// The two eyes of one frame.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct EyePair {
    /// Pose of each eye in the world, indexed by [`Eye::index`].
    pub poses: [Pose; 2],
    /// Frustum of each eye.
    pub frusta: [Frustum; 2],
    /// Depth planes and encoding, the same for both.
    pub depth: DepthRange,
    /// Size in pixels of each eye's image.
    pub size: [u32; 2],
    /// The eye that is rendered.
    pub dominant: Eye,
}

impl EyePair {
    /// Parallel eyes around a head pose, with one frustum for both.
    pub fn parallel(
        head: Pose,
        frustum: Frustum,
        ipd: f32,
        depth: DepthRange,
        size: [u32; 2],
        dominant: Eye,
    ) -> EyePair {
        let poses = Eye::BOTH.map(|eye| head.translated_local(Vec3::X * (eye.side() * ipd * 0.5)));
        EyePair { poses, frusta: [frustum; 2], depth, size, dominant }
    }

    /// The image of one eye.
    pub fn view(&self, eye: Eye) -> View {
        View {
            pose: self.poses[eye.index()],
            frustum: self.frusta[eye.index()],
            depth: self.depth,
            size: self.size,
        }
    }

    /// The point halfway between the eyes.
    pub fn middle(&self) -> Vec3 {
        (self.poses[0].position + self.poses[1].position) * 0.5
    }

    /// Distance between the eyes in metres along their X axis.
    pub fn ipd(&self) -> f32 {
        (self.poses[1].position - self.poses[0].position).dot(self.poses[0].right())
    }

    /// The same eyes with frusta of one width and one height, over the same rows: each grows around its own as far
    /// as it takes.
    pub fn evened(&self) -> EyePair {
        let [l, r] = self.frusta;
        let width = l.width().max(r.width());
        let (bottom, top) = (l.bottom.min(r.bottom), l.top.max(r.top));
        let grown = |f: Frustum| {
            let more = (width - f.width()) / 2.0;
            Frustum { left: f.left - more, right: f.right + more, bottom, top }
        };
        EyePair { frusta: self.frusta.map(grown), ..*self }
    }

    /// Eyes at the same places that look in one direction, at right angles to the line between them, with frusta
    /// that contain those of these eyes. An image that is rendered so holds what a canted eye sees, turned about the
    /// eye's own centre: whoever shows it can turn it back, exactly. Not for eyes that see further than 80 degrees
    /// from that direction.
    pub fn parallelized(&self) -> Option<EyePair> {
        let between = self.poses[1].position - self.poses[0].position;
        let x = between.try_normalize().unwrap_or(self.poses[0].right());
        let ahead = self.poses[0].forward() + self.poses[1].forward();
        let z = -(ahead - x * ahead.dot(x)).try_normalize()?;
        let orientation = Quat::from_mat3(&glam::Mat3::from_cols(x, z.cross(x), z));
        let mut eyes = *self;
        for (pose, frustum) in eyes.poses.iter_mut().zip(&mut eyes.frusta) {
            let turn = orientation.inverse() * pose.orientation;
            let corners = [
                (frustum.left, frustum.bottom),
                (frustum.right, frustum.bottom),
                (frustum.left, frustum.top),
                (frustum.right, frustum.top),
            ];
            let mut seen = Frustum { left: f32::MAX, right: f32::MIN, bottom: f32::MAX, top: f32::MIN };
            for (x, y) in corners {
                let direction = (turn * Vec3::new(x, y, -1.0)).normalize();
                if -direction.z < 80f32.to_radians().cos() {
                    return None;
                }
                let tangent = direction.truncate() / -direction.z;
                seen.left = seen.left.min(tangent.x);
                seen.right = seen.right.max(tangent.x);
                seen.bottom = seen.bottom.min(tangent.y);
                seen.top = seen.top.max(tangent.y);
            }
            (pose.orientation, *frustum) = (orientation, seen);
        }
        Some(eyes.evened())
    }

    /// Focal length in pixels along X: pixels per unit tangent.
    pub fn focal_length_pixels(&self) -> f32 {
        self.size[0] as f32 / self.frusta[self.dominant.index()].width()
    }

    /// What to render, and how its pixels move to the other eye.
    ///
    /// The source view is the dominant eye's frustum, widened (by whole pixels, so that the dominant eye's
    /// own image is a crop of it) to the union of both frusta and by the guard band.
    ///
    /// # Errors
    /// [`EyesError`] for eyes whose pixels do not move along rows only.
    pub fn synthesis(&self, guard: GuardBand) -> Result<SynthesisViews, EyesError> {
        let target_eye = self.dominant.other();
        let (s, t) = (self.view(self.dominant), self.view(target_eye));
        let range = &self.depth;
        let ordered = |f: &Frustum| f.width() > 0.0 && f.height() > 0.0;
        if !ordered(&s.frustum)
            || !ordered(&t.frustum)
            || range.near <= 0.0
            || range.near >= range.far
            || self.size.contains(&0)
        {
            return Err(EyesError::Empty);
        }
        let angle = s.pose.orientation.angle_between(t.pose.orientation);
        // A tenth of a pixel at 2000 pixels and 90 degrees is 1e-4 rad; f32 acos alone is good to 5e-4.
        let direction =
            (s.pose.forward() - t.pose.forward()).length().max((s.pose.right() - t.pose.right()).length());
        if direction > 1e-4 {
            return Err(EyesError::Canted { degrees: angle.to_degrees() });
        }
        let ipd = self.ipd();
        let between = self.poses[1].position - self.poses[0].position;
        let off_axis = (between - s.pose.right() * ipd).length();
        if off_axis > 1e-4 {
            return Err(EyesError::OffAxis { off_axis });
        }
        if !(-1e-6..=MAX_IPD + 1e-6).contains(&ipd) {
            return Err(EyesError::Ipd { ipd });
        }
        let density = |f: &Frustum| [f.width() / self.size[0] as f32, f.height() / self.size[1] as f32];
        let (ds, dt) = (density(&s.frustum), density(&t.frustum));
        for axis in 0..2 {
            // The error adds up over the image: allow a twentieth of a pixel in all.
            if ((ds[axis] / dt[axis] - 1.0).abs() * self.size[axis] as f32) > 0.05 {
                return Err(EyesError::Density {
                    left: density(&self.frusta[0])[axis],
                    right: density(&self.frusta[1])[axis],
                });
            }
        }
        let pixels = |tangents: f32, axis: usize| (tangents / ds[axis] - 1e-3).ceil().max(0.0) as u32;
        let f_px = 1.0 / ds[0];
        let guard = match guard {
            GuardBand::None => 0,
            GuardBand::Pixels(n) => n,
            GuardBand::Distance(z) => (f_px * ipd.max(0.0) / z - 1e-3).ceil().max(0.0) as u32,
        };
        // In the left eye's image surfaces lie further right than in the right eye's, so its left border shows
        // what the right eye has beyond its own left border.
        let (guard_left, guard_right) = match target_eye {
            Eye::Left => (guard, 0),
            Eye::Right => (0, guard),
        };
        let left = pixels(s.frustum.left - t.frustum.left, 0) + guard_left;
        let right = pixels(t.frustum.right - s.frustum.right, 0) + guard_right;
        let bottom = pixels(s.frustum.bottom - t.frustum.bottom, 1);
        let top = pixels(t.frustum.top - s.frustum.top, 1);
        let frustum = Frustum {
            left: s.frustum.left - left as f32 * ds[0],
            right: s.frustum.right + right as f32 * ds[0],
            bottom: s.frustum.bottom - bottom as f32 * ds[1],
            top: s.frustum.top + top as f32 * ds[1],
        };
        let source = View { frustum, size: [self.size[0] + left + right, self.size[1] + bottom + top], ..s };
        // x_t = (tan_t - left_t) f, tan_t = tan_s + side * IPD / z, x_s = (tan_s - left_s) f.
        let (c, m) = range.inverse_distance_law();
        let shift = (-target_eye.side() * ipd * f_px) as f64;
        let law = DisparityLaw {
            offset: (frustum.left as f64 - t.frustum.left as f64) * f_px as f64 + shift * c,
            scale: shift * m,
        };
        let row = ((frustum.bottom - t.frustum.bottom) / ds[1]) as f64;
        if (row - row.round()).abs() > 0.05 {
            return Err(EyesError::Density { left: self.frusta[0].bottom, right: self.frusta[1].bottom });
        }
        let warp = Warp {
            source_size: source.size,
            target_size: self.size,
            law,
            row_offset: row.round() as i32,
            target_eye,
            convention: range.convention,
        };
        Ok(SynthesisViews { source, target: t, dominant_crop: [left, bottom], warp })
    }
}

/// Result of [`EyePair::synthesis`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SynthesisViews {
    /// The view to render: the dominant eye, widened.
    pub source: View,
    /// The view that is synthesized.
    pub target: View,
    /// Lower left corner, in pixels of the source image, of the dominant eye's own image.
    pub dominant_crop: [u32; 2],
    /// How the source's pixels move.
    pub warp: Warp,
}

/// The affine form of the paper's Eq. 5 for parallel eyes: `x_target = x_source + offset + scale * depth`, in
/// pixels, for the value stored in the depth buffer. The same for pixel indices and for pixel centres.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct DisparityLaw {
    /// Pixels at depth 0.
    pub offset: f64,
    /// Pixels per unit of depth.
    pub scale: f64,
}

impl DisparityLaw {
    /// Displacement in pixels of a stored depth value.
    pub fn displacement(&self, depth: f64) -> f64 {
        self.offset + self.scale * depth
    }
}

/// All that synthesis has to know about the eyes: sizes, the law of displacement, and what "nearer" means.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Warp {
    /// Size of the rendered colour and depth in pixels.
    pub source_size: [u32; 2],
    /// Size of the synthesized image in pixels.
    pub target_size: [u32; 2],
    /// Displacement along x.
    pub law: DisparityLaw,
    /// `y_target = y_source + row_offset`, rows counted from the bottom.
    pub row_offset: i32,
    /// The eye that is synthesized: nearer pixels move to the right for the left eye, to the left for the right.
    pub target_eye: Eye,
    /// Whether smaller or larger depth is nearer.
    pub convention: DepthConvention,
}

/// The paper's minimum object distance `D = IPD / 2 * cot(fov / 2)` in metres (section "Impact of Object
/// Distance"), fov in radians. With IPD 75 mm and 60 degrees it gives 0.065 m, not the 0.129 m that the text
/// states; that value is [`full_overlap_distance`].
pub fn minimum_object_distance(ipd: f32, fov: f32) -> f32 {
    0.5 * ipd / (0.5 * fov).tan()
}

/// `IPD * cot(fov / 2)` in metres: 0.130 m for IPD 75 mm and 60 degrees, the paper's stated 0.129 m. At this
/// distance the disparity is half the image's width.
pub fn full_overlap_distance(ipd: f32, fov: f32) -> f32 {
    ipd / (0.5 * fov).tan()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pair(dominant: Eye) -> EyePair {
        let head = Pose::look_at(Vec3::new(0.3, 1.6, -2.0), Vec3::new(-1.0, 1.2, -9.0));
        EyePair::parallel(head, Frustum::symmetric(1.2, 1.0), 0.063, DepthRange::PAPER, [512, 512], dominant)
    }

    /// Projects a world point into a view, in pixels and stored depth.
    fn project(view: &View, p: Vec3) -> [f64; 3] {
        let clip = (view.view_projection() * p.extend(1.0)).as_dvec4();
        let ndc = clip / clip.w;
        [
            (ndc.x * 0.5 + 0.5) * view.size[0] as f64,
            (ndc.y * 0.5 + 0.5) * view.size[1] as f64,
            ndc.z * 0.5 + 0.5,
        ]
    }

    fn law_agrees_with_matrices(pair: &EyePair, guard: GuardBand) {
        let views = pair.synthesis(guard).unwrap();
        for (i, z) in [0.5f32, 0.9, 2.0, 7.0, 30.0, 500.0].into_iter().enumerate() {
            let local = Vec3::new((i as f32 * 0.13 - 0.3) * z, (0.2 - i as f32 * 0.09) * z, -z);
            let p = pair.poses[0].position + pair.poses[0].orientation * local;
            let (s, t) = (project(&views.source, p), project(&views.target, p));
            let x = s[0] + views.warp.law.displacement(s[2]);
            assert!((x - t[0]).abs() < 0.02, "z {z}: {x} against {}", t[0]);
            assert!((s[1] + views.warp.row_offset as f64 - t[1]).abs() < 0.02);
            assert!((s[2] - t[2]).abs() < 1e-5, "depth is the same in both eyes");
        }
    }

    #[test]
    fn the_law_is_what_the_matrices_do() {
        for dominant in Eye::BOTH {
            for convention in [DepthConvention::Standard, DepthConvention::Reversed] {
                let mut p = pair(dominant);
                p.depth.convention = convention;
                law_agrees_with_matrices(&p, GuardBand::None);
                law_agrees_with_matrices(&p, GuardBand::Distance(0.5));
                p.frusta[0] = Frustum::from_angles(0.9, 0.7, 0.8, 0.75);
                p.frusta[1] = Frustum::from_angles(0.7, 0.9, 0.8, 0.75);
                law_agrees_with_matrices(&p, GuardBand::Distance(0.5));
            }
        }
    }

    #[test]
    fn the_dominant_image_is_a_crop_and_the_union_covers_both() {
        let mut p = pair(Eye::Right);
        p.frusta[0] = Frustum::from_angles(0.9, 0.7, 0.8, 0.75);
        p.frusta[1] = Frustum::from_angles(0.7, 0.9, 0.8, 0.75);
        let v = p.synthesis(GuardBand::Pixels(10)).unwrap();
        let d = v.source.frustum.width() / v.source.size[0] as f32;
        assert!((v.source.frustum.left + v.dominant_crop[0] as f32 * d - p.frusta[1].left).abs() < 1e-5);
        assert!(v.source.frustum.left + 10.0 * d <= p.frusta[0].left + 1e-5);
        assert!(v.source.frustum.right >= p.frusta[0].right - 1e-5);
    }

    #[test]
    fn the_guard_band_reaches_its_distance() {
        for dominant in Eye::BOTH {
            let p = pair(dominant);
            let v = p.synthesis(GuardBand::Distance(0.5)).unwrap();
            let depth = p.depth.depth(0.5) as f64;
            // The outer column of the target must have its source inside the image.
            let x = match dominant.other() {
                Eye::Left => 0.0,
                Eye::Right => 511.0,
            };
            let source = x - v.warp.law.displacement(depth);
            assert!(source >= -1e-3 && source <= v.source.size[0] as f64 - 1.0 + 1e-3, "{source}");
        }
    }

    #[test]
    fn unsuitable_pairs_are_refused() {
        let mut p = pair(Eye::Left);
        p.poses[0].orientation *= Quat::from_rotation_y(0.087);
        let e = p.synthesis(GuardBand::None).unwrap_err();
        assert!(matches!(e, EyesError::Canted { degrees } if (degrees - 5.0).abs() < 0.1), "{e}");
        let mut p = pair(Eye::Left);
        p.poses[0].position.y += 0.01;
        assert!(matches!(p.synthesis(GuardBand::None), Err(EyesError::OffAxis { .. })));
        let mut p = pair(Eye::Left);
        p.poses.swap(0, 1);
        assert!(matches!(p.synthesis(GuardBand::None), Err(EyesError::Ipd { .. })));
        let mut p = pair(Eye::Left);
        p.frusta[0] = Frustum::symmetric(1.0, 1.0);
        assert!(matches!(p.synthesis(GuardBand::None), Err(EyesError::Density { .. })));
        p.depth.near = 0.0;
        assert!(matches!(p.synthesis(GuardBand::None), Err(EyesError::Empty)));
    }

    #[test]
    fn depth_round_trips() {
        for convention in [DepthConvention::Standard, DepthConvention::Reversed] {
            for far in [1000.0, f32::INFINITY] {
                let range = DepthRange { near: 0.1, far, convention };
                for z in [0.1f32, 0.5, 3.0, 80.0] {
                    assert!((range.distance(range.depth(z)) / z - 1.0).abs() < 1e-3);
                }
            }
        }
    }

    #[test]
    fn minimum_distances_are_the_papers_two_readings() {
        let fov = 60f32.to_radians();
        assert!((minimum_object_distance(0.075, fov) - 0.065).abs() < 1e-3);
        assert!((full_overlap_distance(0.075, fov) - 0.129).abs() < 2e-3);
    }

    #[test]
    fn evened_eyes_contain_the_eyes_and_can_be_synthesized() {
        let mut eyes = pair(Eye::Right);
        eyes.frusta = [Frustum::from_angles(0.9, 0.7, 0.8, 0.75), Frustum::from_angles(0.5, 0.8, 0.81, 0.7)];
        assert!(matches!(eyes.synthesis(GuardBand::None), Err(EyesError::Density { .. })));
        let even = eyes.evened();
        even.synthesis(GuardBand::None).unwrap();
        for (grown, own) in even.frusta.iter().zip(&eyes.frusta) {
            assert!(grown.left <= own.left + 1e-6 && grown.right >= own.right - 1e-6, "{grown:?}");
            assert!(grown.bottom <= own.bottom && grown.top >= own.top, "{grown:?}");
        }
    }

    #[test]
    fn canted_eyes_see_nothing_beside_their_parallel_ones() {
        let mut eyes = pair(Eye::Right);
        eyes.frusta =
            [Frustum::from_angles(0.8, 0.7, 0.75, 0.75), Frustum::from_angles(0.7, 0.8, 0.75, 0.75)];
        // Outwards by 5 degrees each, and the head askew.
        let head = Quat::from_euler(glam::EulerRot::YXZ, 0.4, -0.2, 0.1);
        for (pose, side) in eyes.poses.iter_mut().zip([1.0, -1.0]) {
            pose.position = head * Vec3::new(-side * 0.032, 0.0, 0.0);
            pose.orientation = head * Quat::from_rotation_y(side * 5f32.to_radians());
        }
        assert!(matches!(eyes.synthesis(GuardBand::None), Err(EyesError::Canted { .. })));
        let parallel = eyes.parallelized().unwrap();
        parallel.synthesis(GuardBand::None).unwrap();
        assert!(
            (parallel.ipd() - 0.064).abs() < 1e-6 && parallel.poses[0].position == eyes.poses[0].position
        );
        for eye in Eye::BOTH {
            let (own, wide) = (eyes.view(eye), parallel.view(eye));
            for (x, y) in [(0.0, 0.0), (0.0, 1.0), (1.0, 0.0), (1.0, 1.0), (0.5, 0.5)] {
                let tangent = Vec3::new(
                    own.frustum.left + x * own.frustum.width(),
                    own.frustum.bottom + y * own.frustum.height(),
                    -1.0,
                );
                let clip =
                    wide.view_projection() * (own.pose.position + own.pose.orientation * tangent).extend(1.0);
                let seen = clip.truncate() / clip.w;
                assert!(seen.x.abs() < 1.0001 && seen.y.abs() < 1.0001, "{eye:?} {seen}");
            }
        }
        // Nearly back to back.
        eyes.poses[1].orientation = Quat::from_rotation_y(-2.5);
        assert_eq!(eyes.parallelized(), None);
    }
}
