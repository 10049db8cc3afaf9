//! Loads scenes from files: the model, by its extension, and the files beside it.

use std::collections::BTreeMap;
use std::io::Read;
use std::path::{Path, PathBuf};

use glam::{DVec3, Vec3};
use serde::{Deserialize, Serialize};

use super::defaults;
use super::error::{SceneError, file_size};
use super::gltf::load_gltf;
use super::model::{Alpha, Model, PointLight, ShadingStyle, Sky, Viewpoint};
use super::motion::Motion;
use super::obj::load_obj;
use super::path as camera_path;
use super::rays::Rays;
use super::scene::Scene;

/// Maximum size of `camera.json` or `scene.json` in bytes.
const MAX_SIDECAR: u64 = 16 << 20;

/// The properties that OBJ lacks: the format of `NAME.scene.json` or `scene.json` beside a model. Every key is
/// optional; unknown keys are refused.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct SceneNotes {
    /// Metres per unit of the file, 1 by default; 0.01 for a model in centimetres.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub scale: Option<f32>,
    /// Shading style.
    pub style: ShadingStyle,
    /// Sun and sky.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sky: Option<Sky>,
    /// Point lights; an empty list for none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub lights: Option<Vec<PointLight>>,
    /// Properties of materials by their name.
    pub materials: BTreeMap<String, MaterialNotes>,
    /// Names of textures that are not filtered when magnified.
    pub nearest: Vec<String>,
}

/// The properties of a material that MTL lacks.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MaterialNotes {
    /// How the diffuse map's alpha is used.
    pub alpha: Alpha,
    /// Drawn from both sides.
    pub double_sided: bool,
    /// Shown in its own colour, whatever the light.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub unlit: bool,
}

/// The contents of a model file.
#[derive(Default)]
pub(super) struct Loaded {
    /// Triangles, materials and pictures.
    pub model: Model,
    /// The file's cameras.
    pub cameras: Vec<Viewpoint>,
    /// Its first directional light, as the sun.
    pub sky: Option<Sky>,
    /// Its point and spot lights, without their cones.
    pub lights: Option<Vec<PointLight>>,
    /// What moves. Everything else is in its state at time 0.
    pub motion: Motion,
    /// What was subtracted from all positions, in the file's units: not zero if the model is far from its origin.
    pub subtracted: DVec3,
}

impl Loaded {
    fn shift(&mut self, by: Vec3) {
        self.model.vertices.iter_mut().for_each(|v| v.position += by);
        self.lights.iter_mut().flatten().for_each(|light| light.position += by);
        self.motion.shift(by);
        self.cameras
            .iter_mut()
            .for_each(|v| *v = Viewpoint { position: v.position + by, target: v.target + by });
    }

    fn enlarge(&mut self, scale: f32) {
        self.model.vertices.iter_mut().for_each(|v| v.position *= scale);
        self.lights.iter_mut().flatten().for_each(|light| light.position *= scale);
        self.motion.enlarge(scale);
        self.cameras
            .iter_mut()
            .for_each(|v| *v = Viewpoint { position: v.position * scale, target: v.target * scale });
        self.subtracted *= f64::from(scale);
    }

    /// Moves a model to the origin if f32 has no places for its details where it is; otherwise leaves it there.
    fn bring_near(&mut self, path: &Path) {
        let bounds = self.model.bounds();
        let (center, extent) = (bounds.center(), (bounds.max - bounds.min).max_element());
        let place = self.subtracted + center.as_dvec3();
        if place.length() <= FARTHEST_CENTER.min(FARTHEST_EXTENTS * f64::from(extent)) {
            let back = std::mem::take(&mut self.subtracted).as_vec3();
            if back != Vec3::ZERO {
                self.shift(back);
            }
            return;
        }
        let rest = if center.length() > extent { center.round() } else { Vec3::ZERO };
        self.shift(-rest);
        let DVec3 { x, y, z } = self.subtracted + rest.as_dvec3();
        log::warn!(
            "{} is {} m away from the origin, so {x}, {y}, {z} was subtracted from its positions: viewpoints and lights count from there",
            path.display(),
            metres(place.length())
        );
    }
}

/// Distance from the origin, in metres and in extents of a model, beyond which the model is moved to the origin.
const FARTHEST_CENTER: f64 = camera_path::FARTHEST as f64;
const FARTHEST_EXTENTS: f64 = 1e4;

/// Extent in metres from which a model is taken for one in another unit, unless its scale is stated.
const LARGE: f32 = 50.0;

/// Returns a length that a person can read.
fn metres(length: f64) -> String {
    match length {
        _ if !(1e-3..1e7).contains(&length) => format!("{length:.1e}"),
        _ if length < 10.0 => format!("{length:.3}"),
        _ => format!("{length:.0}"),
    }
}

/// Loads a scene from an `.obj`, `.gltf` or `.glb` file.
///
/// Viewpoints come from `NAME.camera.json` or `camera.json` beside the file (an array of [`Viewpoint`]), light and
/// style from `NAME.scene.json` or `scene.json` ([`SceneNotes`]). Without these files, a glTF file's own cameras and
/// lights are used. Anything still missing is generated: at least 8 viewpoints around the model or through it at eye
/// height, and a sky, or even light where no sky is visible. A model farther from the origin than f32 can tell its
/// details is moved there, with a warning that says by how much.
///
/// # Errors
/// [`SceneError`], one sentence for the user.
pub fn load(path: &Path) -> Result<Scene, SceneError> {
    load_animated(path, None)
}

/// Like [`load`], but of a glTF file's animations plays only the one with this name or number, if one is given.
///
/// # Errors
/// As [`load`], and if the file has no such animation.
pub fn load_animated(path: &Path, animation: Option<&str>) -> Result<Scene, SceneError> {
    file_size(path)?;
    let extension = path.extension().unwrap_or_default().to_string_lossy().to_lowercase();
    let mut file = match (extension.as_str(), animation) {
        ("obj", None) => {
            let (model, subtracted) = load_obj(path)?;
            Loaded { model, subtracted, ..Loaded::default() }
        }
        ("obj", Some(animation)) => {
            let what = format!("it has no animation {animation}: OBJ files have none, glTF files may");
            return Err(SceneError::unusable(path, what));
        }
        ("gltf" | "glb", _) => load_gltf(path, animation)?,
        _ => {
            let path = path.display();
            return Err(SceneError(format!(
                "{path} is not a scene that can be read: convert it to .obj, .gltf or .glb"
            )));
        }
    };
    let notes = sidecar::<SceneNotes>(path, "scene.json")?;
    let scale =
        notes.as_ref().map_or(Ok(None), |(file, notes)| check_notes(file, notes).map(|()| notes.scale))?;
    if let Some(scale) = scale {
        file.enlarge(scale);
    }
    check_extent(path, &file.model, scale.is_some())?;
    file.bring_near(path);
    let Loaded { mut model, mut cameras, mut sky, mut lights, mut motion, .. } = file;
    let mut style = ShadingStyle::default();
    if let Some((_, notes)) = notes {
        for m in &mut model.materials {
            if let Some(n) = notes.materials.get(&m.name) {
                (m.alpha, m.double_sided, m.unlit) = (n.alpha, n.double_sided, n.unlit);
            }
        }
        model.textures.iter_mut().filter(|t| notes.nearest.contains(&t.name)).for_each(|t| t.nearest = true);
        style = notes.style;
        // Lights from the sidecar file do not move.
        if notes.sky.is_some() {
            motion.sun = None;
        }
        if notes.lights.is_some() {
            motion.lights.clear();
        }
        sky = notes.sky.or(sky);
        lights = notes.lights.or(lights);
    }
    if let Some((file, viewpoints)) = sidecar::<Vec<Viewpoint>>(path, "camera.json")? {
        camera_path::check(&viewpoints).map_err(|what| SceneError::sidecar(&file, what))?;
        cameras = viewpoints;
    }
    let has_made_up_viewpoints = cameras.is_empty();
    if cameras.is_empty() || sky.is_none() {
        let rays = Rays::new(&model);
        if cameras.is_empty() {
            let (made, how) = defaults::viewpoints(&model, &rays);
            log::info!("{}: {} viewpoints are made up: {how}", path.display(), made.len());
            cameras = made;
        }
        sky = sky.or_else(|| Some(defaults::sky(&model, &rays, &cameras)));
    }
    Ok(Scene {
        name: path.file_stem().unwrap_or_default().to_string_lossy().into_owned(),
        model,
        style,
        sky: sky.unwrap_or_default(),
        lights: lights.unwrap_or_default(),
        viewpoints: cameras,
        has_made_up_viewpoints,
        motion,
    })
}

/// Refuses a model that is too small or large, and warns about one that is so large that its unit is probably not the
/// metre.
fn check_extent(path: &Path, model: &Model, is_scaled: bool) -> Result<(), SceneError> {
    let bounds = model.bounds();
    let extent = (bounds.max - bounds.min).max_element();
    let large = metres(extent.into());
    if !(1e-3..1e6).contains(&extent) {
        let what = format!(
            "it is {large} m large: write {{\"scale\": ...}} into a scene.json beside it, in metres per unit"
        );
        return Err(SceneError::unusable(path, what));
    }
    if extent > LARGE && !is_scaled {
        log::warn!(
            "{} is {large} m large, a unit being a metre: if its unit is the centimetre, write {{\"scale\": 0.01}} into a scene.json beside it, otherwise {{\"scale\": 1}}",
            path.display()
        );
    }
    Ok(())
}

/// Returns `NAME.suffix` beside a file, or else `suffix`; `None` if neither exists.
pub fn sidecar_file(path: &Path, suffix: &str) -> Option<PathBuf> {
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    let candidates = [path.with_file_name(format!("{stem}.{suffix}")), path.with_file_name(suffix)];
    candidates.into_iter().find(|c| yoro_files::is_file(c))
}

/// Reads the [`sidecar_file`]; `None` if there is none.
fn sidecar<T: serde::de::DeserializeOwned>(
    path: &Path,
    suffix: &str,
) -> Result<Option<(PathBuf, T)>, SceneError> {
    let Some(file) = sidecar_file(path, suffix) else { return Ok(None) };
    let mut bytes = Vec::new();
    yoro_files::open(&file)
        .and_then(|f| f.take(MAX_SIDECAR).read_to_end(&mut bytes))
        .map_err(SceneError::read(&file))?;
    match serde_json::from_slice(&bytes) {
        Ok(value) => Ok(Some((file, value))),
        Err(e) => Err(SceneError::sidecar(&file, e)),
    }
}

fn check_notes(file: &Path, notes: &SceneNotes) -> Result<(), SceneError> {
    let fault = |what: &str| Err(SceneError::sidecar(file, what));
    if !notes.scale.is_none_or(|s| s.is_finite() && s > 0.0) {
        return fault("the scale must be greater than 0");
    }
    if notes.sky.is_some_and(|sky| !sky.sun_direction.is_normalized()) {
        return fault("sun_direction must have the length 1");
    }
    let usable = |l: &PointLight| {
        l.position.is_finite() && l.color.is_finite() && l.color.min_element() >= 0.0 && l.range > 0.0
    };
    if !notes.lights.iter().flatten().all(usable) {
        return fault("lights need finite positions, colours of 0 or more and a range greater than 0");
    }
    Ok(())
}
