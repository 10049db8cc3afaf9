//! The built-in scenes, generated from a seed. Eight replace the paper's (section 6), with similar styles and triangle
//! counts; [`hard_cases`] shows what synthesis finds hard.
//!
//! [`load`] takes the name of a built-in scene or the path of a file, and returns the scene. Each built-in scene has a
//! module; [`mod@build`], [`props`], [`sculpt`], [`figure`], [`paint`] and [`motion`] are their common tools. This
//! crate must never know how a scene is drawn.

use std::ops::RangeInclusive;
use std::path::Path;

use yoro_assets::{Scene, SceneError, ShadingStyle};

use build::{Progress, SceneBuilder};

mod atrium;
pub mod build;
mod conference;
pub mod figure;
pub mod hard_cases;
pub mod motion;
pub mod paint;
pub mod props;
mod prototype;
mod scifi_city;
pub mod sculpt;
mod stage;
mod street;
mod talk;
mod voxel;

/// A scene that is generated rather than loaded.
#[derive(Clone, Copy, Debug)]
pub struct Builtin {
    /// The name on the command line.
    pub name: &'static str,
    /// A one-line description.
    pub title: &'static str,
    /// The paper's scene that it replaces; empty if none.
    pub stands_for: &'static str,
    /// The shading style that the scene is made for.
    pub style: ShadingStyle,
    /// Number of triangles, in thousands, rounded; the exact number depends on the seed.
    pub kilo_triangles: u32,
    /// Generates everything except name and style, with an empty builder.
    generate: fn(seed: u64, builder: SceneBuilder) -> Scene,
}

impl Builtin {
    /// Returns the expected range of the number of triangles, for any seed.
    pub fn triangles(&self) -> RangeInclusive<usize> {
        let stated = self.kilo_triangles as usize * 1000;
        stated * 9 / 10..=stated * 11 / 10
    }
}

/// The seed of the scenes in documents and tests.
pub const DEFAULT_SEED: u64 = 1;

/// All built-in scenes.
pub const BUILTINS: &[Builtin] = &[
    Builtin {
        name: "street",
        title: "A street with a café in the late afternoon",
        stands_for: "Bistro",
        style: ShadingStyle::Realistic,
        kilo_triangles: 1239,
        generate: street::build,
    },
    Builtin {
        name: "scifi-city",
        title: "A neon street between towers at night",
        stands_for: "SciFiCity",
        style: ShadingStyle::Realistic,
        kilo_triangles: 590,
        generate: scifi_city::build,
    },
    Builtin {
        name: "atrium",
        title: "A court with columns, arches, curtains and banners",
        stands_for: "Sponza",
        style: ShadingStyle::Realistic,
        kilo_triangles: 365,
        generate: atrium::build,
    },
    Builtin {
        name: "conference",
        title: "A conference room with screens, blinds and plants",
        stands_for: "Conference",
        style: ShadingStyle::Realistic,
        kilo_triangles: 123,
        generate: conference::build,
    },
    Builtin {
        name: "voxel",
        title: "A voxel landscape with a ruined temple, a bridge, woods and a castle",
        stands_for: "LostEmpire",
        style: ShadingStyle::Voxel,
        kilo_triangles: 2834,
        generate: voxel::build,
    },
    Builtin {
        name: "prototype",
        title: "A game level of grid textures: ramps, stairs, railings, dummies",
        stands_for: "Prototype",
        style: ShadingStyle::LowPoly,
        kilo_triangles: 24,
        generate: prototype::build,
    },
    Builtin {
        name: "talk",
        title: "Two stylised figures talking across a table in a room with a garden",
        stands_for: "Chat",
        style: ShadingStyle::Cartoon,
        kilo_triangles: 117,
        generate: talk::build,
    },
    Builtin {
        name: "stage",
        title: "An anime-style singer on a concert stage at nightfall",
        stands_for: "UnityChan",
        style: ShadingStyle::Anime,
        kilo_triangles: 149,
        generate: stage::build,
    },
    Builtin {
        name: "hard-cases",
        title: "A court with a bay for each thing that synthesis finds hard",
        stands_for: "",
        style: ShadingStyle::Realistic,
        kilo_triangles: 55,
        generate: hard_cases::build,
    },
];

/// Returns the scenes that replace the paper's: those over which means are taken.
pub fn replacements() -> impl Iterator<Item = &'static Builtin> {
    BUILTINS.iter().filter(|builtin| !builtin.stands_for.is_empty())
}

/// The error for a name that no built-in scene has.
#[derive(Debug, thiserror::Error)]
#[error("There is no built-in scene \"{name}\"; choose one of {}.", names())]
pub struct UnknownScene {
    /// The requested name.
    pub name: String,
}

fn names() -> String {
    BUILTINS.iter().map(|b| b.name).collect::<Vec<_>>().join(", ")
}

/// Generates the built-in scene with this name. Equal seeds give equal scenes.
///
/// # Errors
/// [`UnknownScene`], which lists the available names.
pub fn build(name: &str, seed: u64) -> Result<Scene, UnknownScene> {
    build_with(name, seed, SceneBuilder::new())
}

/// Like [`fn@build`], but calls `watch` with the progress.
///
/// # Errors
/// As [`fn@build`].
pub fn build_watched(
    name: &str,
    seed: u64,
    watch: impl FnMut(Progress) + 'static,
) -> Result<Scene, UnknownScene> {
    build_with(name, seed, SceneBuilder::watched(watch))
}

fn build_with(name: &str, seed: u64, builder: SceneBuilder) -> Result<Scene, UnknownScene> {
    let builtin = BUILTINS.iter().find(|b| b.name == name);
    let builtin = builtin.ok_or_else(|| UnknownScene { name: name.into() })?;
    let scene = (builtin.generate)(seed, builder);
    Ok(Scene { name: name.into(), style: builtin.style, ..scene })
}

/// Errors of loading a scene.
#[derive(Debug, thiserror::Error)]
pub enum LoadError {
    /// The name is neither that of a built-in scene nor that of a file.
    #[error("{0} Or give an OBJ, glTF or GLB file.")]
    Unknown(#[from] UnknownScene),
    /// The file cannot be loaded.
    #[error(transparent)]
    File(#[from] SceneError),
    /// An animation of a built-in scene was asked for.
    #[error(
        "{0} is a built-in scene, whose motion has no names: only glTF files have animations to choose from"
    )]
    NoAnimations(String),
}

/// Loads a built-in scene by name, or a file, in the given style or its own.
pub fn load(name: &str, seed: u64, style: Option<ShadingStyle>) -> Result<Scene, LoadError> {
    load_animated(name, seed, style, None)
}

/// Like [`load`], but of a glTF file's animations plays only the one with this name or number, if one is given.
pub fn load_animated(
    name: &str,
    seed: u64,
    style: Option<ShadingStyle>,
    animation: Option<&str>,
) -> Result<Scene, LoadError> {
    let path = Path::new(name);
    let looks_like_path = path.components().count() > 1 || path.extension().is_some() || path.exists();
    let mut scene = match build(name, seed) {
        Ok(_) if animation.is_some() => return Err(LoadError::NoAnimations(name.into())),
        Ok(scene) => scene,
        Err(_) if looks_like_path => yoro_assets::load_animated(path, animation)?,
        Err(error) => return Err(error.into()),
    };
    scene.style = style.unwrap_or(scene.style);
    Ok(scene)
}

/// Checks that every name is a built-in scene's or a file's, before minutes of work fail because of it.
///
/// # Errors
/// As [`load`].
pub fn check(names: &[String], seed: u64) -> Result<(), LoadError> {
    let known = |name: &str| BUILTINS.iter().any(|b| b.name == name) || Path::new(name).exists();
    for name in names.iter().filter(|name| !known(name)) {
        load(name, seed, None)?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use std::cell::RefCell;
    use std::rc::Rc;
    use std::sync::LazyLock;

    use glam::Vec3;

    use super::*;
    use yoro_assets::{Bounds, Model};

    /// The scenes with the default seed, generated once for all tests.
    static SCENES: LazyLock<Vec<Scene>> =
        LazyLock::new(|| BUILTINS.iter().map(|b| build(b.name, DEFAULT_SEED).unwrap()).collect());

    fn each(check: impl Fn(&Builtin, &Scene)) {
        BUILTINS.iter().zip(SCENES.iter()).for_each(|(builtin, scene)| check(builtin, scene));
    }

    fn triangles(model: &Model) -> impl Iterator<Item = [yoro_assets::Vertex; 3]> + '_ {
        model.indices.chunks_exact(3).map(|t| [t[0], t[1], t[2]].map(|i| model.vertices[i as usize]))
    }

    #[test]
    fn models_are_sound() {
        each(|builtin, scene| {
            let (name, model) = (builtin.name, &scene.model);
            assert!(
                builtin.triangles().contains(&model.triangle_count()),
                "{name}: {} triangles",
                model.triangle_count()
            );
            assert!(model.indices.iter().all(|&i| (i as usize) < model.vertices.len()), "{name}");
            for v in &model.vertices {
                assert!(v.position.is_finite() && v.uv.is_finite(), "{name}: {v:?}");
                assert!((v.normal.length() - 1.0).abs() < 1e-3, "{name}: {v:?}");
            }
            let mut next = 0;
            for part in &model.parts {
                assert!(part.material < model.materials.len(), "{name}: {}", part.name);
                assert_eq!(part.indices.start, next, "{name}: parts cover the indices in order");
                assert_eq!(part.indices.len() % 3, 0, "{name}: {}", part.name);
                next = part.indices.end;
            }
            assert_eq!(next, model.indices.len(), "{name}");
        });
    }

    #[test]
    fn surfaces_face_their_normals() {
        each(|builtin, scene| {
            let model = &scene.model;
            let mut backwards = Vec::new();
            for part in model.parts.iter().filter(|p| !model.materials[p.material].double_sided) {
                if matches!(model.materials[part.material].alpha, yoro_assets::Alpha::Cutout(_)) {
                    continue;
                }
                let wrong = model.indices[part.indices.clone()]
                    .chunks_exact(3)
                    .filter(|t| {
                        let v = [t[0], t[1], t[2]].map(|i| model.vertices[i as usize]);
                        let facing = (v[1].position - v[0].position).cross(v[2].position - v[0].position);
                        facing.dot(v.iter().map(|v| v.normal).sum::<Vec3>()) < 0.0
                    })
                    .count();
                if wrong > 0 {
                    backwards.push((&part.name, &model.materials[part.material].name, wrong));
                }
            }
            assert!(backwards.is_empty(), "{}: triangles seen from behind: {backwards:?}", builtin.name);
        });
    }

    #[test]
    fn materials_and_textures_are_sound() {
        each(|builtin, scene| {
            let (name, model) = (builtin.name, &scene.model);
            let mut names: Vec<&str> = model.materials.iter().map(|m| m.name.as_str()).collect();
            names.sort_unstable();
            assert!(names.windows(2).all(|n| n[0] != n[1]), "{name}: material names {names:?}");
            let mut names: Vec<&str> = model.textures.iter().map(|t| t.name.as_str()).collect();
            names.sort_unstable();
            assert!(names.windows(2).all(|n| n[0] != n[1]), "{name}: texture names {names:?}");
            for material in &model.materials {
                let maps = [
                    (material.diffuse_map, true),
                    (material.specular_map, true),
                    (material.emissive_map, true),
                    (material.normal_map, false),
                ];
                for (map, srgb) in maps {
                    let Some(map) = map else { continue };
                    assert!(map < model.textures.len(), "{name}: {}", material.name);
                    assert_eq!(model.textures[map].srgb, srgb, "{name}: {}", material.name);
                }
            }
            let mut bytes = 0;
            for texture in &model.textures {
                let [width, height] = texture.size;
                assert_eq!(texture.rgba.len(), (width * height * 4) as usize, "{name}: {}", texture.name);
                bytes += texture.rgba.len();
            }
            assert!(bytes < 60 << 20, "{name}: {bytes} bytes of textures");
            let referenced: std::collections::HashSet<usize> = model
                .materials
                .iter()
                .flat_map(|m| [m.diffuse_map, m.specular_map, m.emissive_map, m.normal_map])
                .flatten()
                .collect();
            assert_eq!(referenced.len(), model.textures.len(), "{name}: textures that nothing uses");
        });
    }

    #[test]
    fn equal_seeds_give_equal_scenes() {
        each(|builtin, a| {
            let told = Rc::new(RefCell::new(Vec::new()));
            let heard = told.clone();
            let b = build_watched(builtin.name, DEFAULT_SEED, move |p| heard.borrow_mut().push(p)).unwrap();
            assert!(told.borrow().is_sorted_by_key(|p| (p.textures, p.triangles)), "{}", builtin.name);
            let last = *told.borrow().last().unwrap();
            assert_eq!(last.textures, b.model.textures.len(), "{}", builtin.name);
            assert!(b.model.triangle_count() - last.triangles < build::WATCHED_STEP, "{}", builtin.name);
            assert!(a.model == b.model, "{}", builtin.name);
            assert!(
                a.lights == b.lights
                    && a.sky == b.sky
                    && a.viewpoints == b.viewpoints
                    && a.motion == b.motion,
                "{}",
                builtin.name
            );
            drop(b);
            let c = build(builtin.name, DEFAULT_SEED + 1).unwrap();
            assert!(a.model != c.model, "{}: the seed changes nothing", builtin.name);
            assert!(builtin.triangles().contains(&c.model.triangle_count()), "{}", builtin.name);
        });
    }

    #[test]
    fn viewpoints_are_a_walk_in_free_space() {
        each(|builtin, scene| {
            let (name, views) = (builtin.name, &scene.viewpoints);
            assert!(views.len() >= 8, "{name}");
            for pair in views.windows(2) {
                let step = pair[0].position.distance(pair[1].position);
                assert!((0.2..=4.0).contains(&step), "{name}: a step of {step} m");
                let turn = (pair[0].target - pair[0].position)
                    .angle_between(pair[1].target - pair[1].position)
                    .to_degrees();
                assert!(turn < 50.0, "{name}: a turn of {turn} degrees");
            }
            for (i, view) in views.iter().enumerate() {
                let nearest = nearest(&scene.model, view.position);
                assert!(nearest > 0.25, "{name}: viewpoint {i} is {nearest} m from a surface");
            }
        });
    }

    /// Returns the distance in metres from a point to the nearest surface, or infinity if none is within half a metre.
    fn nearest(model: &Model, point: Vec3) -> f32 {
        triangles(model)
            .map(|t| t.map(|v| v.position))
            .filter(|t| t.iter().fold(Bounds::EMPTY, |b, &p| b.including(p)).distance(point) < 0.5)
            .map(|t| distance_to_triangle(point, t))
            .fold(f32::INFINITY, f32::min)
    }

    #[test]
    fn what_moves_starts_in_its_place_and_leaves_the_walk_free() {
        each(|builtin, scene| {
            let (name, motion) = (builtin.name, &scene.motion);
            assert_eq!(motion.is_still(), !["talk", "stage", "hard-cases"].contains(&name), "{name}");
            if motion.is_still() {
                return;
            }
            let start = scene.at(0.0);
            // Bit by bit, so that the picture is the same as that of the still scene.
            assert!(start.model == scene.model && start.lights == scene.lights, "{name}");
            assert!(
                motion.meshes.iter().all(|mesh| !mesh.vertices.is_empty()),
                "{name}: an object without triangles"
            );
            for part in &scene.model.parts {
                let vertices = &scene.model.indices[part.indices.clone()];
                let within = |mesh: &yoro_assets::motion::MovingMesh| {
                    vertices.iter().filter(|&&v| mesh.vertices.contains(&(v as usize))).count()
                };
                let moved: Vec<usize> = motion.meshes.iter().map(within).filter(|count| *count > 0).collect();
                assert!(moved.is_empty() || moved == [vertices.len()], "{name}: {} is torn", part.name);
            }
            for time in [0.4, 1.1, 2.7, 5.3] {
                let later = scene.at(time);
                let mut farthest: f32 = 0.0;
                for (a, b) in scene.model.vertices.iter().zip(&later.model.vertices) {
                    assert!(
                        b.position.is_finite() && (b.normal.length() - 1.0).abs() < 1e-3,
                        "{name}: {b:?}"
                    );
                    farthest = farthest.max(a.position.distance(b.position));
                }
                // People gesture; a paper plane circles.
                let most = if name == "hard-cases" { 1.7 } else { 0.6 };
                assert!((0.02..most).contains(&farthest), "{name}: moved {farthest} m at {time} s");
                for view in &scene.viewpoints {
                    assert!(nearest(&later.model, view.position) > 0.25, "{name}: in the way at {time} s");
                }
            }
        });
    }

    #[test]
    fn lights_are_few_and_finite() {
        each(|builtin, scene| {
            assert!(scene.lights.len() <= 24, "{}", builtin.name);
            for light in &scene.lights {
                assert!(light.range > 0.0 && light.color.min_element() >= 0.0, "{}: {light:?}", builtin.name);
            }
            assert!((scene.sky.sun_direction.length() - 1.0).abs() < 1e-3, "{}", builtin.name);
        });
    }

    #[test]
    fn an_unknown_name_lists_the_known_ones() {
        let message = build("bistro", 1).expect_err("not a name").to_string();
        assert!(message.contains("bistro"));
        assert!(BUILTINS.iter().all(|b| message.contains(b.name)), "{message}");
    }

    /// Returns the distance to the closest point on a triangle, clamped to its face, edges and corners.
    fn distance_to_triangle(p: Vec3, [a, b, c]: [Vec3; 3]) -> f32 {
        let normal = (b - a).cross(c - a);
        let over = |q: Vec3, r: Vec3| normal.cross(r - q).dot(p - q) >= 0.0;
        if normal.length_squared() > 0.0 && over(a, b) && over(b, c) && over(c, a) {
            return (p - a).dot(normal.normalize()).abs();
        }
        let to_edge = |q: Vec3, r: Vec3| {
            let edge = r - q;
            let t = ((p - q).dot(edge) / edge.length_squared().max(1e-12)).clamp(0.0, 1.0);
            p.distance(q + edge * t)
        };
        to_edge(a, b).min(to_edge(b, c)).min(to_edge(c, a))
    }

    #[test]
    fn distance_to_a_triangle() {
        let t = [Vec3::ZERO, Vec3::X, Vec3::Y];
        assert_eq!(distance_to_triangle(Vec3::new(0.25, 0.25, 2.0), t), 2.0);
        assert_eq!(distance_to_triangle(Vec3::new(0.5, -3.0, 0.0), t), 3.0);
        assert_eq!(distance_to_triangle(Vec3::new(3.0, 0.0, 0.0), t), 2.0);
    }
}
