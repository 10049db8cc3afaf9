//! Predicts which columns of a guard band the other eye will see, from the surfaces that an earlier frame showed at its
//! border and from the head's motion since then.

use glam::Vec3;

use yoro::eyes::{Eye, EyePair, Pose, SynthesisViews};
use yoro::synthesis::Uniforms;

/// Texels of a profile across the columns, as in `stereo/border_profile.frag`.
pub(super) const CELLS: usize = 64;
/// Texels of a profile down the rows.
pub(super) const BANDS: usize = 16;
/// Units per pixel in which a profile stores disparity.
const UNIT: f32 = 16.0;
/// Columns drawn beyond those that are seen, because the renderer's filters read this far to each side.
const SPARE: u32 = 4;
/// Number of recent frames of which the widest request counts.
const HOLD: usize = 8;
/// The whole band is drawn once in this many frames: only that finds near surfaces entirely outside the drawn part.
const FULL_BAND_INTERVAL: u32 = 30;
/// One row in this many is measured.
const ROWS: u32 = 2;
/// A head that moves by more than this many times the distance between the eyes is taken as placed elsewhere.
const LEAP: f32 = 2.0;
/// Lower bound of the factor by which an approach changes a surface's distance.
const APPROACH: f32 = 0.25;
/// The empty range.
const NOTHING: [f32; 2] = [f32::INFINITY, f32::NEG_INFINITY];

/// The border at which the band lies, and the geometry of motion along it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Border {
    /// Columns of the whole band.
    pub guard_columns: u32,
    /// Disparity, in pixels and 0 at the far plane, at which a surface at the band's inner end lies at the other eye's
    /// border. Measured against infinity it is 0 unless the frusta differ.
    pub beyond: f32,
    /// The rendered eye's pose.
    pose: Pose,
    /// 1 if the band is on the right, -1 if it is on the left.
    side: f32,
    /// Tangents of the border's angles, measured outwards, down and up.
    outwards: f32,
    down: f32,
    up: f32,
    /// Focal length in pixels.
    focal_length: f32,
    /// Disparity of the far plane relative to infinity, in pixels.
    far: f32,
    ipd: f32,
}

/// The motion of surfaces at the border from one frame to another, in columns outwards. A range holds the least and the
/// greatest over all rows of the border, up to a band's width outside and inside of it.
#[derive(Clone, Copy, Debug)]
struct Motion {
    /// Motion of surfaces at infinity.
    turned: [f32; 2],
    /// Additional motion for each pixel of current disparity.
    along: [f32; 2],
    /// The greatest factor by which turning changes disparity.
    turning: f32,
    /// The relative growth of disparity by approach, for each pixel of disparity.
    nearer: f32,
}

impl Border {
    pub(super) fn new(pair: &EyePair, views: &SynthesisViews) -> Border {
        let target = &views.target.frustum;
        let (side, outwards) = match views.warp.target_eye {
            Eye::Left => (-1.0, -target.left),
            Eye::Right => (1.0, target.right),
        };
        let (focal_length, ipd) = (pair.focal_length_pixels(), pair.ipd());
        Border {
            guard_columns: views.guard_columns,
            beyond: -(Uniforms::new(&views.warp, [0, 0]).far_displacement + views.guard_columns as f32),
            pose: pair.poses[pair.dominant.index()],
            side,
            outwards,
            down: target.bottom,
            up: target.top,
            focal_length,
            far: focal_length * ipd / pair.depth.far,
            ipd,
        }
    }

    /// True if both belong to the same eyes, as exactly as poses give the distance between them.
    fn is_of(&self, other: &Border) -> bool {
        let numbers = |b: &Border| [b.side, b.outwards, b.down, b.up, b.focal_length, b.far, b.ipd];
        let near = |(a, b): (f32, f32)| (a - b).abs() <= 0.01 * a.abs().max(b.abs());
        self.guard_columns == other.guard_columns && numbers(self).into_iter().zip(numbers(other)).all(near)
    }

    /// Returns the motion since this frame, or `None` if the eyes differ or the head was placed elsewhere.
    fn motion_to(&self, now: &Border) -> Option<Motion> {
        if !self.is_of(now) {
            return None;
        }
        let turn = now.pose.orientation.inverse() * self.pose.orientation;
        let moved = self.pose.orientation.inverse() * (now.pose.position - self.pose.position);
        if moved.length() > LEAP * self.ipd {
            return None;
        }
        let forward = -moved.z;
        let nearer = forward / (self.focal_length * self.ipd);
        let mut motion = Motion { turned: NOTHING, along: NOTHING, turning: 1.0, nearer };
        let most = self.guard_columns as f32;
        for column in [-most, 0.0, most] {
            let outwards = self.outwards + column / self.focal_length;
            widen(&mut motion.along, (outwards * forward - self.side * moved.x) / self.ipd);
            for height in [self.down, 0.5 * (self.down + self.up), self.up] {
                let direction = turn * Vec3::new(self.side * outwards, height, -1.0);
                let columns = self.focal_length * (self.side * direction.x / -direction.z - outwards);
                if direction.z > -APPROACH || columns.abs() > most {
                    return None;
                }
                widen(&mut motion.turned, columns);
                motion.turning = motion.turning.max(-1.0 / direction.z);
            }
        }
        Some(motion)
    }
}

fn widen(range: &mut [f32; 2], by: f32) {
    *range = [range[0].min(by), range[1].max(by)];
}

impl Motion {
    /// Returns the least and the greatest number of columns that surfaces of at most this disparity have moved.
    fn columns(&self, disparity: f32) -> [f32; 2] {
        let now = self.disparity(disparity);
        let along = self.along.map(|along| along * now);
        [self.turned[0] + along[0].min(0.0), self.turned[1] + along[1].max(0.0)]
    }

    /// Returns the current value of an earlier disparity.
    fn disparity(&self, disparity: f32) -> f32 {
        self.turning * disparity / (1.0 - self.nearer * disparity).max(APPROACH)
    }
}

/// The surfaces that a frame showed at its border.
#[derive(Clone, Debug)]
pub(super) struct Profile {
    pub border: Border,
    /// Number of the band's columns that were drawn.
    pub drawn: u32,
    /// Number of pixels that were seen but not drawn, estimated from the outermost drawn column.
    pub undrawn: u32,
    /// Columns per entry of `disparities`.
    step: u32,
    /// Disparities of the nearest surfaces relative to infinity, from the outermost drawn column inwards.
    disparities: [f32; CELLS],
}

impl Profile {
    /// Reads the texels of `stereo/border_profile.frag`. Returns `None` if they are the zeros of a driver that cannot
    /// provide them.
    pub(super) fn read(texels: &[u8], border: Border, drawn: u32, step: u32) -> Option<Profile> {
        let mut profile = Profile { border, drawn, undrawn: 0, step, disparities: [0.0; CELLS] };
        for (i, texel) in texels.chunks_exact(4).enumerate() {
            let units = u16::from_le_bytes([texel[0], texel[1]]).checked_sub(1)?;
            let disparity = &mut profile.disparities[i % CELLS];
            *disparity = disparity.max(f32::from(units) / UNIT + border.far);
            profile.undrawn += ROWS * u32::from(u16::from_le_bytes([texel[2], texel[3]]));
        }
        Some(profile)
    }

    /// Returns the number of the band's columns that are seen from `now`, or `None` if this frame cannot tell.
    fn seen(&self, now: &Border) -> Option<u32> {
        let motion = self.border.motion_to(now)?;
        let (step, drawn) = (self.step as f32, self.drawn as f32);
        let beyond = self.border.beyond + self.border.far;
        let reach = |before: f32| motion.disparity(before) - beyond + 1.0;
        let mut seen = 0f32;
        let mut edge = 0f32;
        for (i, &before) in self.disparities.iter().enumerate() {
            // The outermost column of this cell.
            let out = drawn - i as f32 * step;
            let [least, most] = motion.columns(before);
            if out - step + 1.0 + least < reach(before) {
                seen = seen.max(reach(before).min(out + most));
            }
            if 2.0 * i as f32 * step < self.border.guard_columns as f32 {
                edge = edge.max(before);
            }
        }
        // Surfaces that were not drawn are assumed to be as near as those within half a band's width of them.
        let [unknown, _] = motion.columns(edge);
        if drawn + unknown < reach(edge).min(self.border.guard_columns as f32) {
            seen = seen.max(reach(edge));
        }
        Some(seen.ceil() as u32)
    }
}

/// Decides how many columns to draw.
#[derive(Debug, Default)]
pub(super) struct Width {
    /// The numbers that the last frames asked for, in no particular order.
    asked: [u32; HOLD],
    frames: u32,
}

impl Width {
    /// Returns the number for a frame from an earlier profile: at least `least`, or all if the profile cannot tell.
    pub(super) fn next(&mut self, profile: Option<&Profile>, now: &Border, least: u32) -> u32 {
        let Some(seen) = profile.and_then(|profile| profile.seen(now)) else {
            *self = Width::default();
            return now.guard_columns;
        };
        self.asked[self.frames as usize % HOLD] = (seen + SPARE).max(least).min(now.guard_columns);
        self.frames += 1;
        if self.frames.is_multiple_of(FULL_BAND_INTERVAL) {
            return now.guard_columns;
        }
        // The band itself may have become narrower in the meantime.
        self.asked.into_iter().fold(least, u32::max).min(now.guard_columns)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Quat;
    use yoro::eyes::{DepthConvention, DepthRange, EyeOptions, Frustum, GuardBand};

    const LEAST: u32 = 14;

    /// The border of a right eye that is rendered with a band of 56 columns on its left, or of a left eye, mirrored.
    fn border(head: Pose, dominant: Eye) -> Border {
        let pair = EyeOptions { dominant, ..EyeOptions::default() }.pair(head);
        Border::new(&pair, &pair.synthesis_views(GuardBand::Distance(1.0)).unwrap())
    }

    fn at(head: Pose) -> Border {
        border(head, Eye::Right)
    }

    fn turned(degrees: f32) -> Pose {
        Pose { orientation: Quat::from_rotation_y(degrees.to_radians()), ..Pose::IDENTITY }
    }

    fn moved(x: f32, z: f32) -> Pose {
        Pose { position: Vec3::new(x, 0.0, z), ..Pose::IDENTITY }
    }

    /// A frame at rest, two columns per cell. `disparity` takes the column, outwards from the band's inner end.
    fn profile(drawn: u32, disparity: impl Fn(i32) -> f32) -> Profile {
        let disparities = std::array::from_fn(|i| disparity(drawn as i32 - 2 * i as i32));
        Profile { border: at(Pose::IDENTITY), drawn, undrawn: 0, step: 2, disparities }
    }

    /// A surface in some columns, in front of a background with a disparity of three pixels.
    fn post(columns: [i32; 2], disparity: f32) -> Profile {
        profile(56, |out| if out >= columns[0] && out <= columns[1] { disparity } else { 3.0 })
    }

    #[test]
    fn a_surface_shows_as_many_band_columns_as_its_disparity() {
        let rest = at(Pose::IDENTITY);
        assert_eq!((rest.guard_columns, (rest.beyond + rest.far).abs() < 0.01), (56, true));
        assert_eq!(profile(56, |_| 20.0).seen(&rest), Some(20));
        assert_eq!(profile(56, |_| 0.0).seen(&rest), Some(0));
        assert_eq!(post([40, 50], 30.0).seen(&rest), Some(4));
        assert_eq!(post([40, 50], 45.0).seen(&rest), Some(46));
        assert_eq!(post([40, 50], 100.0).seen(&rest), Some(50));
    }

    #[test]
    fn with_different_frusta_infinity_lies_beyond_the_border() {
        // The rendered eye sees a tenth of a tangent, 88.7 columns, further out than the other.
        let mut pair = EyeOptions::default().pair(Pose::IDENTITY);
        let shifted = |f: Frustum, by: f32| Frustum { left: f.left + by, right: f.right + by, ..f };
        pair.frusta = [shifted(pair.frusta[0], 0.05), shifted(pair.frusta[1], -0.05)];
        for (convention, far) in
            [(DepthConvention::Standard, 100.0), (DepthConvention::Reversed, f32::INFINITY)]
        {
            pair.depth = DepthRange { near: 0.1, far, convention };
            let border = Border::new(&pair, &pair.synthesis_views(GuardBand::Distance(1.0)).unwrap());
            let beyond = border.beyond + border.far;
            assert!((beyond - 0.1 * border.focal_length).abs() < 1.1, "{border:?}");
            let seen =
                |disparity: f32| Profile { border, ..profile(56, |_| disparity) }.seen(&border).unwrap();
            let near = seen(beyond + 20.0);
            assert!(seen(beyond - 2.0) == 0 && (20..=21).contains(&near), "{near}: {border:?}");
        }
    }

    #[test]
    fn a_turn_moves_surfaces_to_the_border() {
        // A turn of one degree at a border 30 degrees off the middle: 20.6 columns, and fewer at the border's ends.
        let motion = at(Pose::IDENTITY).motion_to(&at(turned(-1.0))).unwrap();
        let [least, most] = motion.turned;
        assert!((0.5 * (least + most) - 20.6).abs() < 0.4 && most - least < 4.0, "{motion:?}");
        let left = border(Pose::IDENTITY, Eye::Left).motion_to(&border(turned(1.0), Eye::Left)).unwrap();
        assert!((motion.turned[0] - left.turned[0]).abs() < 1e-2, "{left:?}");
        // Seen ten columns inside the picture, and outside of it after a turn to the other side.
        let within = post([-12, -10], 25.0);
        assert_eq!(within.seen(&at(Pose::IDENTITY)), Some(4));
        let seen = within.seen(&at(turned(-1.0))).unwrap();
        assert!((10..=15).contains(&seen), "{seen}");
        // What was outside comes in.
        let seen = post([40, 44], 30.0).seen(&at(turned(1.0))).unwrap();
        assert!((23..=28).contains(&seen), "{seen}");
        // A nod moves little, and a roll moves the border's ends.
        let nod = Pose { orientation: Quat::from_rotation_x(0.02), ..Pose::IDENTITY };
        let motion = at(Pose::IDENTITY).motion_to(&at(nod)).unwrap();
        assert!(motion.turned[0] > -8.0 && motion.turned[1] < 8.0, "{motion:?}");
        let roll = Pose { orientation: Quat::from_rotation_z(0.02), ..Pose::IDENTITY };
        let motion = at(Pose::IDENTITY).motion_to(&at(roll)).unwrap();
        assert!((motion.turned[1] - 10.2).abs() < 1.0 && (motion.turned[0] + 10.2).abs() < 1.0, "{motion:?}");
    }

    #[test]
    fn near_surfaces_move_more() {
        let rest = at(Pose::IDENTITY);
        // The head moves right by half the distance between the eyes: half a disparity to the left, which is outwards.
        let motion = rest.motion_to(&at(moved(0.0315, 0.0))).unwrap();
        let half = |motion: Motion| motion.along.map(|along| (along * 1e3).round() / 1e3);
        assert!(half(motion) == [0.5; 2] && motion.turned[1].abs() < 1e-3, "{motion:?}");
        let left = border(Pose::IDENTITY, Eye::Left).motion_to(&border(moved(0.0315, 0.0), Eye::Left));
        assert_eq!(half(left.unwrap()), [-0.5; 2]);
        // Five centimetres towards a surface at 1 m.
        let motion = rest.motion_to(&at(moved(0.0, -0.05))).unwrap();
        let disparity = rest.focal_length * 0.063;
        assert!((motion.disparity(disparity) - disparity / 0.95).abs() < 0.02, "{motion:?}");
        let direction = Vec3::new(-(30f32.to_radians().tan()), 0.0, -1.0) + Vec3::Z * 0.05;
        let columns = rest.focal_length * (direction.x / direction.z - 30f32.to_radians().tan());
        let [least, most] = motion.columns(disparity);
        assert!(least <= columns && columns <= most && most < 1.2 * columns, "{columns}: {least} {most}");
    }

    #[test]
    fn undrawn_columns_count_as_near_as_their_neighbours() {
        let rest = at(Pose::IDENTITY);
        assert_eq!(profile(14, |_| 9.0).seen(&rest), Some(10));
        assert_eq!(profile(14, |_| 40.0).seen(&rest), Some(41));
        // Far inside the picture, a surface says nothing about what is outside.
        assert_eq!(profile(14, |out| if out < -30 { 40.0 } else { 9.0 }).seen(&rest), Some(10));
        // A turn of a degree brings in twenty columns that no frame has shown.
        let turned = |disparity: f32| profile(14, |_| disparity).seen(&at(turned(1.0))).unwrap();
        assert!((10..=11).contains(&turned(9.0)) && (31..=32).contains(&turned(30.0)));
    }

    #[test]
    fn other_eyes_and_leaps_give_no_prediction() {
        let seen = |now: Border| profile(56, |_| 9.0).seen(&now);
        assert_eq!(seen(Border { focal_length: 800.0, ..at(Pose::IDENTITY) }), None);
        for far in [turned(4.0), turned(-4.0), turned(90.0), turned(180.0), moved(0.2, 0.0), moved(0.0, -1.0)]
        {
            assert_eq!(seen(at(far)), None, "{far:?}");
        }
        let up = Pose { position: Vec3::Y, ..Pose::IDENTITY };
        // Motion along the border's own direction.
        let slanting = Pose { position: Vec3::new(-0.577, 0.0, -1.0), ..Pose::IDENTITY };
        assert_eq!([up, slanting].map(|pose| seen(at(pose))), [None, None]);
        let mut width = Width::default();
        assert_eq!(width.next(None, &at(Pose::IDENTITY), LEAST), 56);
        assert_eq!(width.next(Some(&profile(56, |_| 20.0)), &at(turned(90.0)), LEAST), 56);
    }

    #[test]
    fn the_band_widens_at_once_and_narrows_later() {
        let rest = at(Pose::IDENTITY);
        let mut width = Width::default();
        let mut next = |disparity: f32| width.next(Some(&profile(56, |_| disparity)), &rest, LEAST);
        assert_eq!([20.0, 30.0, 20.0].map(&mut next), [24, 34, 34]);
        assert_eq!([(); HOLD].map(|()| next(20.0)), [34, 34, 34, 34, 34, 34, 24, 24]);
        assert_eq!(next(99.0), 56);
        // A narrower band, from an earlier frame with the same band.
        let narrow = Border { guard_columns: 40, ..rest };
        let other = Profile { border: narrow, ..profile(40, |_| 0.0) };
        assert_eq!(width.next(Some(&other), &narrow, LEAST), 40);
        let mut width = Width::default();
        let mut next = |disparity: f32| width.next(Some(&profile(56, |_| disparity)), &rest, LEAST);
        let widths = [(); 2 * FULL_BAND_INTERVAL as usize].map(|()| next(0.0));
        assert_eq!(
            widths.iter().filter(|columns| **columns == LEAST).count(),
            2 * FULL_BAND_INTERVAL as usize - 2
        );
    }

    #[test]
    fn profiles_are_read_and_zeros_are_refused() {
        let rest = at(Pose::IDENTITY);
        let mut texels = [0u8; CELLS * BANDS * 4];
        assert!(Profile::read(&texels, rest, 14, 2).is_none());
        for texel in texels.chunks_exact_mut(4) {
            texel.copy_from_slice(&[1, 0, 0, 0]);
        }
        // Forty pixels in the third cell of a band of rows, eight in the next band; a few pixels left undrawn.
        for (at, units) in [(2, 640u16), (CELLS + 2, 128)] {
            texels[at * 4..at * 4 + 2].copy_from_slice(&(units + 1).to_le_bytes());
            texels[at * 4 + 2..at * 4 + 4].copy_from_slice(&300u16.to_le_bytes());
        }
        let profile = Profile::read(&texels, rest, 14, 2).unwrap();
        assert_eq!(profile.undrawn, 2 * 300 * ROWS);
        assert_eq!(profile.disparities[1..3], [rest.far, 40.0 + rest.far]);
    }
}
