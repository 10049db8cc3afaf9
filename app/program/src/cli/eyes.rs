//! Options of the eyes, shared by `render`, `run` and `dataset`.

use std::path::{Path, PathBuf};

use anyhow::ensure;
use glam::Vec3;

use crate::cli::args::{parse_far, parse_fov, parse_positive};
use yoro::eyes::{
    DepthConvention, DepthRange, Eye, EyeOptions, EyePair, GuardBand, Pose, full_overlap_distance,
    minimum_object_distance,
};
use yoro_assets::path::FARTHEST;
use yoro_assets::{Scene, Viewpoint};
use yoro_scenes::BUILTINS;
use yoro_settings::Ipd;

/// The eyes and what they see of the world.
#[derive(clap::Args, Clone, Debug)]
pub struct EyeArgs {
    /// Size of each eye's image in pixels
    #[arg(long, default_value = "1024x1024", value_parser = parse_size, value_name = "WxH")]
    pub size: [u32; 2],
    /// Vertical field of view in degrees
    #[arg(long = "fov-y-degrees", default_value = "60", value_parser = parse_fov, allow_negative_numbers = true)]
    pub fov_y: f32,
    /// Distance between the eyes in metres
    #[arg(long, default_value_t = Ipd::DEFAULT, allow_negative_numbers = true)]
    pub ipd: Ipd,
    /// The eye that is rendered
    #[arg(long, value_parser = parse_eye, default_value = "right")]
    pub dominant: Eye,
    /// Near plane in metres
    #[arg(long, default_value_t = DepthRange::PAPER.near, value_parser = parse_positive, allow_negative_numbers = true)]
    pub near: f32,
    /// Far plane in metres; `inf` for none
    #[arg(long, default_value_t = DepthRange::PAPER.far, value_parser = parse_far, allow_negative_numbers = true)]
    pub far: f32,
    /// Reversed depth, 1 near to 0 far, in float
    #[arg(long)]
    pub reversed_z: bool,
    /// Outer and inner half-angles of asymmetric frusta in degrees, such as 52,42; instead of the width that
    /// follows from --fov-y-degrees
    #[arg(long, value_parser = parse_half_angles, value_name = "OUTER,INNER")]
    pub half_angles_degrees: Option<[f32; 2]>,
}

impl EyeArgs {
    /// Returns the options in the library's form.
    pub fn options(&self) -> EyeOptions {
        let convention = if self.reversed_z { DepthConvention::Reversed } else { DepthConvention::Standard };
        EyeOptions {
            size: self.size,
            fov_y: self.fov_y,
            ipd: self.ipd.metres(),
            dominant: self.dominant,
            depth: DepthRange { near: self.near, far: self.far, convention },
            outer_inner: self.half_angles_degrees.map(|angles| angles.map(f32::to_radians)),
        }
    }

    /// Returns the two eyes of a head at this pose.
    pub fn pair(&self, head: Pose) -> EyePair {
        self.options().pair(head)
    }

    /// Refuses a near plane that is not in front of the far plane.
    pub fn check(&self) -> anyhow::Result<()> {
        ensure!(self.near < self.far, "--near {} must be less than --far {}", self.near, self.far);
        Ok(())
    }

    /// Returns a line that says how near objects may come.
    pub fn distances(&self, guard: GuardBand) -> String {
        let frustum = self.pair(Pose::IDENTITY).frusta[self.dominant.index()];
        let fov_x = frustum.right.atan() - frustum.left.atan();
        let guard = match guard {
            GuardBand::None => "no guard band".to_owned(),
            GuardBand::Distance(z) => format!("guard band complete from {z} m"),
            GuardBand::Pixels(n) => format!("guard band of {n} pixels"),
        };
        format!(
            "minimum object distance {:.3} m (IPD/2 cot(fov/2)), disparity of half the image at {:.3} m, {guard}",
            minimum_object_distance(self.ipd.metres(), fov_x),
            full_overlap_distance(self.ipd.metres(), fov_x)
        )
    }
}

/// Returns the head's pose at one of the scene's viewpoints, counted from 0.
pub fn scene_pose(scene: &Scene, pose: usize) -> anyhow::Result<Pose> {
    let count = scene.viewpoints.len();
    ensure!(pose < count, "--pose {pose} does not exist: {} has poses 0 to {}", scene.name, count - 1);
    Ok(scene.viewpoints[pose].pose())
}

/// Returns the viewpoint that `--position` and `--target` describe.
pub fn viewpoint(position: Option<Vec3>, target: Option<Vec3>) -> Option<Viewpoint> {
    let position = position?;
    Some(Viewpoint { position, target: target.unwrap_or(position + Vec3::NEG_Z) })
}

/// Returns the name for the pictures of a built-in scene or a file.
pub fn stem(scene: &str) -> String {
    let is_builtin = BUILTINS.iter().any(|builtin| builtin.name == scene);
    let stem = Path::new(scene).file_stem().unwrap_or_default();
    if is_builtin { scene.to_owned() } else { stem.to_string_lossy().into_owned() }
}

/// Returns the path of a scene's picture.
pub fn picture_path(folder: &Path, stem: &str, kind: &str) -> PathBuf {
    folder.join(format!("{stem}.{kind}.png"))
}

/// Parses `x,y,z` in metres.
pub fn parse_point(text: &str) -> Result<Vec3, String> {
    let numbers: Vec<f32> = text.split(',').filter_map(|n| n.trim().parse().ok()).collect();
    match *numbers.as_slice() {
        [x, y, z] if Vec3::new(x, y, z).length() <= FARTHEST => Ok(Vec3::new(x, y, z)),
        [_, _, _] => Err(format!("give a place up to {FARTHEST} m from the origin")),
        _ => Err("give three numbers in metres, such as 1.5,1.6,-2".into()),
    }
}

/// Parses `WxH`, or one number for both, in pixels.
pub fn parse_size(text: &str) -> Result<[u32; 2], String> {
    let number = |t: &str| t.parse::<u32>().ok().filter(|n| (16..=4096).contains(n));
    let (w, h) = text.split_once('x').unwrap_or((text, text));
    number(w)
        .zip(number(h))
        .map(|(w, h)| [w, h])
        .ok_or_else(|| "give pixels from 16 to 4096, such as 1024x1024".into())
}

/// Parses `left` or `right`.
pub fn parse_eye(text: &str) -> Result<Eye, String> {
    Eye::BOTH.into_iter().find(|eye| eye.name() == text).ok_or_else(|| "give left or right".into())
}

fn parse_half_angles(text: &str) -> Result<[f32; 2], String> {
    let parse = |t: &str| t.trim().parse::<f32>().ok().filter(|d| (1.0..=85.0).contains(d));
    text.split_once(',')
        .and_then(|(a, b)| parse(a).zip(parse(b)))
        .map(|(a, b)| [a, b])
        .ok_or_else(|| "give two angles from 1 to 85 degrees, outwards and inwards, such as 52,42".into())
}
