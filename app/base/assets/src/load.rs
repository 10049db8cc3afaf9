//! Loads scenes from files: the model, by its extension, and the files beside it.

use std::collections::BTreeMap;
use std::io::Read;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::defaults;
use super::error::{SceneError, file_size};
use super::gltf::load_gltf;
use super::model::{Alpha, PointLight, ShadingStyle, Sky, Viewpoint};
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
    pub alpha: AlphaNotes,
    /// Drawn from both sides.
    pub double_sided: bool,
}

/// [`Alpha`] in a file: `"opaque"`, `{"cutout": 0.5}` or `{"blend": 0.3}`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum AlphaNotes {
    /// Ignored.
    Opaque,
    /// Discarded below the cut-off.
    Cutout(f32),
    /// Blended with this opacity.
    Blend(f32),
}

impl From<Alpha> for AlphaNotes {
    fn from(alpha: Alpha) -> AlphaNotes {
        match alpha {
            Alpha::Opaque => AlphaNotes::Opaque,
            Alpha::Cutout(c) => AlphaNotes::Cutout(c),
            Alpha::Blend(o) => AlphaNotes::Blend(o),
        }
    }
}

impl From<AlphaNotes> for Alpha {
    fn from(alpha: AlphaNotes) -> Alpha {
        match alpha {
            AlphaNotes::Opaque => Alpha::Opaque,
            AlphaNotes::Cutout(c) => Alpha::Cutout(c),
            AlphaNotes::Blend(o) => Alpha::Blend(o),
        }
    }
}

/// Loads a scene from an `.obj`, `.gltf` or `.glb` file.
///
/// Viewpoints come from `NAME.camera.json` or `camera.json` beside the file (an array of [`Viewpoint`]), light and
/// style from `NAME.scene.json` or `scene.json` ([`SceneNotes`]). Without these files, a glTF file's own cameras and
/// lights are used. Anything still missing is generated: at least 8 viewpoints around the model or through it at eye
/// height, point lights for glowing surfaces, and a sky, or lamps where no sky is visible.
///
/// # Errors
/// [`SceneError`], one sentence for the user.
pub fn load(path: &Path) -> Result<Scene, SceneError> {
    file_size(path)?;
    let extension = path.extension().unwrap_or_default().to_string_lossy().to_lowercase();
    let (mut model, mut cameras, mut sky, mut lights, mut motion) = match extension.as_str() {
        "obj" => (load_obj(path)?, Vec::new(), None, None, Motion::default()),
        "gltf" | "glb" => {
            let file = load_gltf(path)?;
            (file.model, file.cameras, file.sky, file.lights, file.motion)
        }
        _ => return Err(SceneError::UnknownFormat { path: path.into() }),
    };
    let mut style = ShadingStyle::default();
    if let Some((file, notes)) = sidecar::<SceneNotes>(path, "scene.json")? {
        check_notes(&file, &notes)?;
        let scale = notes.scale.unwrap_or(1.0);
        model.vertices.iter_mut().for_each(|v| v.position *= scale);
        lights.iter_mut().flatten().for_each(|light| light.position *= scale);
        motion.enlarge(scale);
        cameras
            .iter_mut()
            .for_each(|v| *v = Viewpoint { position: v.position * scale, target: v.target * scale });
        for m in &mut model.materials {
            if let Some(n) = notes.materials.get(&m.name) {
                (m.alpha, m.double_sided) = (n.alpha.into(), n.double_sided);
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
        camera_path::check(&viewpoints).map_err(|what| SceneError::Sidecar { path: file, what })?;
        cameras = viewpoints;
    }
    let bounds = model.bounds();
    let extent = (bounds.max - bounds.min).max_element();
    if !(1e-3..1e6).contains(&extent) || bounds.center().length() > camera_path::FARTHEST {
        return Err(SceneError::unusable(
            path,
            format!(
                "it is {extent} m large, {} m away from the origin: write {{\"scale\": ...}} into a scene.json beside it, in metres per unit",
                bounds.center().length()
            ),
        ));
    }
    if extent > 1000.0 {
        log::warn!(
            "{} is {extent:.0} m large, a unit being a metre: if its unit is the centimetre, write {{\"scale\": 0.01}} into a scene.json beside it",
            path.display()
        );
    }
    if cameras.is_empty() || sky.is_none() || lights.is_none() {
        let rays = Rays::new(&model);
        if cameras.is_empty() {
            let (made, how) = defaults::viewpoints(&model, &rays);
            log::info!("{}: no camera.json, so {} viewpoints are made up: {how}", path.display(), made.len());
            cameras = made;
        }
        let (default_sky, default_lights) = defaults::light(&model, &rays, &cameras);
        // A file with lamps but no sky is lit by its lamps alone.
        sky = sky.or(Some(default_sky));
        lights = lights.or(Some(default_lights));
    }
    Ok(Scene {
        name: path.file_stem().unwrap_or_default().to_string_lossy().into_owned(),
        model,
        style,
        sky: sky.unwrap_or_default(),
        lights: lights.unwrap_or_default(),
        viewpoints: cameras,
        motion,
    })
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
        .map_err(|source| SceneError::Read { path: file.clone(), source })?;
    match serde_json::from_slice(&bytes) {
        Ok(value) => Ok(Some((file, value))),
        Err(e) => Err(SceneError::Sidecar { path: file, what: e.to_string() }),
    }
}

fn check_notes(file: &Path, notes: &SceneNotes) -> Result<(), SceneError> {
    let fault = |what: &str| Err(SceneError::Sidecar { path: file.into(), what: what.into() });
    if !notes.scale.is_none_or(|s| s.is_finite() && s > 0.0) {
        return fault("the scale must be greater than 0");
    }
    if let Some(s) = &notes.sky {
        let colours = [s.sun_color, s.zenith, s.horizon, s.ground];
        if colours.iter().any(|c| !c.is_finite() || c.min_element() < 0.0) {
            return fault("the colours of the sky must be 0 or more");
        }
        if !s.sun_direction.is_normalized() {
            return fault("sun_direction must have the length 1");
        }
    }
    let usable = |l: &PointLight| {
        l.position.is_finite() && l.color.is_finite() && l.color.min_element() >= 0.0 && l.range > 0.0
    };
    if !notes.lights.iter().flatten().all(usable) {
        return fault("lights need finite positions, colours of 0 or more and a range greater than 0");
    }
    let within = |m: &MaterialNotes| match m.alpha {
        AlphaNotes::Opaque => true,
        AlphaNotes::Cutout(a) | AlphaNotes::Blend(a) => (0.0..=1.0).contains(&a),
    };
    if !notes.materials.values().all(within) {
        return fault("cut-offs and opacities lie between 0 and 1");
    }
    Ok(())
}
