//! Tests animated glTF files against positions computed by hand in f64.

use std::fs;

use base64::Engine as _;
use glam::{DVec3, Vec3};
use proptest::prelude::*;

use super::*;

/// A glTF file with one buffer.
#[derive(Default)]
struct File {
    data: Vec<u8>,
    accessors: Vec<String>,
    views: Vec<String>,
}

impl File {
    /// Adds an accessor of floats, and returns its index.
    fn floats(&mut self, kind: &str, values: &[f32]) -> usize {
        let bytes = values.iter().flat_map(|v| v.to_le_bytes()).collect();
        self.put(kind, 5126, values.len(), bytes)
    }

    /// Adds an accessor of bytes.
    fn bytes(&mut self, kind: &str, values: &[u8]) -> usize {
        self.put(kind, 5121, values.len(), values.to_vec())
    }

    fn put(&mut self, kind: &str, component: u32, numbers: usize, bytes: Vec<u8>) -> usize {
        let width = match kind {
            "SCALAR" => 1,
            "VEC3" => 3,
            "MAT4" => 16,
            _ => 4,
        };
        self.views.push(format!(
            r#"{{"buffer": 0, "byteOffset": {}, "byteLength": {}}}"#,
            self.data.len(),
            bytes.len()
        ));
        self.accessors.push(format!(
            r#"{{"bufferView": {}, "componentType": {component}, "count": {}, "type": "{kind}"}}"#,
            self.views.len() - 1,
            numbers / width
        ));
        self.data.extend(bytes);
        self.accessors.len() - 1
    }

    /// Returns the text of a file with `more` keys: nodes, meshes, skins, animations.
    fn text(&self, more: &str) -> String {
        format!(
            r#"{{"asset": {{"version": "2.0"}}, "accessors": [{}], "bufferViews": [{}],
            "buffers": [{{"byteLength": {}, "uri": "data:application/octet-stream;base64,{}"}}], {more}}}"#,
            self.accessors.join(", "),
            self.views.join(", "),
            self.data.len(),
            base64::engine::general_purpose::STANDARD.encode(&self.data)
        )
    }
}

fn try_load(text: &str, notes: Option<&str>) -> Result<Scene, SceneError> {
    let folder = tempfile::tempdir().unwrap();
    if let Some(notes) = notes {
        fs::write(folder.path().join("scene.json"), notes).unwrap();
    }
    let path = folder.path().join("m.gltf");
    fs::write(&path, text).unwrap();
    load(&path)
}

fn loaded(text: &str) -> Scene {
    try_load(text, None).unwrap()
}

/// The corners of a triangle, identified by their order.
const CORNERS: [[f32; 3]; 3] = [[1.0, 0.0, 0.0], [3.0, 0.5, 0.0], [1.5, 2.0, -0.5]];

fn triangle(file: &mut File) -> usize {
    file.floats("VEC3", CORNERS.as_flattened())
}

/// Returns the triangle's corners in a scene's model, in the file's order.
fn corners(scene: &Scene) -> [Vec3; 3] {
    assert_eq!(scene.model.triangle_count(), 1);
    [0, 1, 2].map(|k| scene.model.vertices[scene.model.indices[k] as usize].position)
}

#[track_caller]
fn assert_near(found: [Vec3; 3], expected: [DVec3; 3], what: f64) {
    for (found, expected) in found.into_iter().zip(expected) {
        assert!(
            found.as_dvec3().distance(expected) < 2e-6 * (1.0 + expected.length()),
            "{found} {expected} at {what}"
        );
    }
}

fn dvec(v: [f32; 3]) -> DVec3 {
    DVec3::from(v.map(f64::from))
}

/// Rotates by degrees about Y.
fn turned(p: DVec3, degrees: f64) -> DVec3 {
    let (sin, cos) = degrees.to_radians().sin_cos();
    DVec3::new(cos * p.x + sin * p.z, p.y, cos * p.z - sin * p.x)
}

/// Returns the quaternion of a rotation by degrees about Y.
fn about_y(degrees: f64) -> [f32; 4] {
    let (sin, cos) = (0.5 * degrees.to_radians()).sin_cos();
    [0.0, sin as f32, 0.0, cos as f32]
}

/// A parent that turns by 150 degrees in two seconds, starting at 0.5 s, and then keeps its rotation with the sign
/// reversed; and a child that moves along a spline and grows in steps.
fn nodes() -> String {
    let mut file = File::default();
    let mesh = triangle(&mut file);
    let turn_times = file.floats("SCALAR", &[0.5, 2.5, 4.0]);
    // The same rotation as the second one with the opposite sign: the short way between them is no motion.
    let back = about_y(150.0).map(|x| -x);
    let turns = file.floats("VEC4", [about_y(0.0), about_y(150.0), back].as_flattened());
    let times = file.floats("SCALAR", &[0.0, 1.0, 3.0]);
    let spline = [
        [9., 9., 9.],
        [0., 0., 0.],
        [1., 0., 0.],
        [0., 2., 0.],
        [2., 1., 0.],
        [0., -1., 3.],
        [1., 1., 1.],
        [4., 4., 4.],
        [9., 9., 9.],
    ];
    let spline = file.floats("VEC3", spline.as_flattened());
    let steps = file.floats("VEC3", [[1.0f32; 3], [2.0, 1.0, 1.0], [0.5; 3]].as_flattened());
    file.text(&format!(
        r#""scenes": [{{"nodes": [0]}}], "meshes": [{{"primitives": [{{"attributes": {{"POSITION": {mesh}}}}}]}}],
        "nodes": [{{"translation": [10, 0, 0], "children": [2]}}, {{"mesh": 0}}, {{"rotation": [0, 0, 0, 1], "children": [1]}}],
        "animations": [{{"channels": [
            {{"sampler": 0, "target": {{"node": 2, "path": "rotation"}}}},
            {{"sampler": 1, "target": {{"node": 1, "path": "translation"}}}},
            {{"sampler": 2, "target": {{"node": 1, "path": "scale"}}}}],
          "samplers": [{{"input": {turn_times}, "output": {turns}}},
            {{"input": {times}, "output": {spline}, "interpolation": "CUBICSPLINE"}},
            {{"input": {times}, "output": {steps}, "interpolation": "STEP"}}]}}]"#
    ))
}

#[test]
fn nodes_move_by_their_keys_and_start_over() {
    let scene = loaded(&nodes());
    assert_eq!(scene.motion.loops, [4.0]);
    let expected = |time: f64| {
        let t = time.rem_euclid(4.0);
        let turn = 150.0 * ((t - 0.5) / 2.0).clamp(0.0, 1.0);
        let spline = |p: [f64; 3], out: [f64; 3], to: [f64; 3], into: [f64; 3], u: f64, length: f64| {
            let h = [
                2.0 * u.powi(3) - 3.0 * u.powi(2) + 1.0,
                u.powi(3) - 2.0 * u.powi(2) + u,
                -2.0 * u.powi(3) + 3.0 * u.powi(2),
                u.powi(3) - u.powi(2),
            ];
            DVec3::from(p) * h[0]
                + DVec3::from(out) * length * h[1]
                + DVec3::from(to) * h[2]
                + DVec3::from(into) * length * h[3]
        };
        let moved = match t {
            t if t < 1.0 => spline([0., 0., 0.], [1., 0., 0.], [2., 1., 0.], [0., 2., 0.], t, 1.0),
            t if t < 3.0 => {
                spline([2., 1., 0.], [0., -1., 3.], [4., 4., 4.], [1., 1., 1.], (t - 1.0) / 2.0, 2.0)
            }
            _ => DVec3::splat(4.0),
        };
        let scale = match t {
            t if t < 1.0 => DVec3::ONE,
            t if t < 3.0 => DVec3::new(2.0, 1.0, 1.0),
            _ => DVec3::splat(0.5),
        };
        CORNERS.map(|p| turned(dvec(p) * scale + moved, turn) + DVec3::X * 10.0)
    };
    for time in [0.0, 0.25, 0.5, 0.9, 1.0, 1.7, 2.5, 2.9, 3.5, 3.999, 4.0, 5.7, 4e6 + 0.75, -0.5] {
        assert_near(corners(&scene.at(time)), expected(time), time);
    }
    // The model is the scene at time 0, and times may come in any order.
    assert_eq!(scene.model, scene.at(0.0).model);
    let mut moment = scene.motion.start();
    scene.motion.at(3.3, &mut moment);
    scene.motion.at(1.7, &mut moment);
    assert_eq!(moment.vertices, scene.at(1.7).model.vertices);
    let bounds = moment.vertices.iter().fold(Bounds::EMPTY, |b, v| b.including(v.position));
    assert_eq!(moment.bounds, [bounds]);
    let all = scene.motion.bounds();
    for time in 0..32 {
        assert!(
            scene.at(f64::from(time) / 8.0).model.vertices.iter().all(|v| all.distance(v.position) == 0.0)
        );
    }
    // Normals turn with the surface.
    let face = |scene: &Scene| {
        let [a, b, c] = corners(scene);
        (b - a).cross(c - a).normalize()
    };
    for time in [0.3, 1.7, 2.2, 3.7] {
        let scene = scene.at(time);
        assert!(scene.model.vertices[0].normal.distance(face(&scene)) < 1e-5, "at {time}");
    }
}

/// A triangle on two joints, the second of which bends by 90 degrees in a second and rises by 1 m.
fn bent(weights: [[f32; 4]; 3], joints: [[u8; 4]; 3], more: impl FnOnce(&mut File) -> String) -> String {
    let mut file = File::default();
    let mesh = triangle(&mut file);
    let joints = file.bytes("VEC4", joints.as_flattened());
    let weights = file.floats("VEC4", weights.as_flattened());
    let moved = |x: f32| [1., 0., 0., 0., 0., 1., 0., 0., 0., 0., 1., 0., -x, 0., 0., 1.];
    let bind = file.floats("MAT4", [moved(0.0), moved(2.0)].as_flattened());
    let times = file.floats("SCALAR", &[0.0, 1.0]);
    let turns = file.floats("VEC4", [about_y(0.0), about_y(90.0)].as_flattened());
    let moves = file.floats("VEC3", &[2.0, 0.0, 0.0, 2.0, 1.0, 0.0]);
    let attributes = more(&mut file);
    file.text(&format!(
        r#""scenes": [{{"nodes": [0, 1]}}], "skins": [{{"joints": [1, 2], "inverseBindMatrices": {bind}}}],
        "nodes": [{{"mesh": 0, "skin": 0, "translation": [0, 50, 0]}}, {{"children": [2], "translation": [0, 0, 5]}}, {{"translation": [2, 0, 0]}}],
        "meshes": [{{"primitives": [{{"attributes": {{"POSITION": {mesh}, "JOINTS_0": {joints}, "WEIGHTS_0": {weights}{attributes}}}}}]}}],
        "animations": [{{"channels": [{{"sampler": 0, "target": {{"node": 2, "path": "rotation"}}}},
            {{"sampler": 1, "target": {{"node": 2, "path": "translation"}}}}],
          "samplers": [{{"input": {times}, "output": {turns}}}, {{"input": {times}, "output": {moves}}}]}}]"#
    ))
}

const WEIGHTS: [[f32; 4]; 3] = [[1.0, 0.0, 0.0, 0.0], [0.0, 3.0, 0.0, 0.0], [0.25, 0.75, 0.0, 0.0]];

#[test]
fn skins_follow_their_joints_and_not_their_node() {
    let expected = |time: f64| {
        let share = [0.0, 1.0, 0.75];
        std::array::from_fn(|i| {
            let p = dvec(CORNERS[i]);
            let bent = turned(p - DVec3::X * 2.0, 90.0 * time) + DVec3::new(2.0, time, 0.0);
            p.lerp(bent, share[i]) + DVec3::Z * 5.0
        })
    };
    let scene = loaded(&bent(WEIGHTS, [[0, 1, 0, 0]; 3], |_| String::new()));
    for time in [0.0, 0.2, 0.5, 0.99] {
        assert_near(corners(&scene.at(time)), expected(time), time);
    }
    // Colours split the file's vertices; the vertices keep their joints.
    let painted = bent(WEIGHTS, [[0, 1, 0, 0]; 3], |file| {
        let colors =
            file.floats("VEC4", [[1.0f32, 0.0, 0.0, 1.0], [0.0, 1.0, 0.0, 1.0], [1.0; 4]].as_flattened());
        format!(", \"COLOR_0\": {colors}")
    });
    assert_near(corners(&loaded(&painted).at(0.5)), expected(0.5), 0.5);
    // A skin whose joints do not move stays in their pose.
    let text = bent(WEIGHTS, [[0, 1, 0, 0]; 3], |_| String::new());
    let (start, end) = (text.find("\"animations\"").unwrap(), text.rfind('}').unwrap());
    let still = loaded(&format!("{}\"extras\": 0{}", &text[..start], &text[end..]));
    assert!(still.motion.is_still());
    assert_near(corners(&still), expected(0.0), 0.0);
}

/// Two shapes, whose weights go from (1, 0) to (0, 2) in two seconds.
fn morphing() -> String {
    let mut file = File::default();
    let mesh = triangle(&mut file);
    let up = file.floats("VEC3", &[0., 1., 0., 0., 0., 0., 0., 0., 0.]);
    let aside = file.floats("VEC3", &[0., 0., 0., 0., 0., 0., 0.5, 0., 0.]);
    let normal = file.floats("VEC3", &[0.0, 0.0, 1.0].repeat(3));
    let tilt = file.floats("VEC3", &[0.5, 0.0, 0.0].repeat(3));
    let times = file.floats("SCALAR", &[0.0, 2.0]);
    let weights = file.floats("SCALAR", &[1.0, 0.0, 0.0, 2.0]);
    file.text(&format!(
        r#""scenes": [{{"nodes": [0]}}], "nodes": [{{"mesh": 0, "translation": [0, 0, -1]}}],
        "meshes": [{{"weights": [0, 1], "primitives": [{{"attributes": {{"POSITION": {mesh}, "NORMAL": {normal}}},
            "targets": [{{"POSITION": {up}}}, {{"POSITION": {aside}, "NORMAL": {tilt}}}]}}]}}],
        "animations": [{{"channels": [{{"sampler": 0, "target": {{"node": 0, "path": "weights"}}}}],
          "samplers": [{{"input": {times}, "output": {weights}}}]}}]"#
    ))
}

#[test]
fn shapes_blend_by_their_weights() {
    let scene = loaded(&morphing());
    for time in [0.0, 0.5, 1.3, 1.99] {
        let weights = [1.0 - time / 2.0, time];
        let mut expected = CORNERS.map(|p| dvec(p) - DVec3::Z);
        expected[0].y += weights[0];
        expected[2].x += 0.5 * weights[1];
        let scene = scene.at(time);
        assert_near(corners(&scene), expected, time);
        let normal = DVec3::new(0.5 * weights[1], 0.0, 1.0).normalize();
        assert!(
            scene.model.vertices.iter().all(|v| v.normal.as_dvec3().distance(normal) < 1e-6),
            "at {time}"
        );
    }
    // Without an animation, the mesh's own weights are used.
    let text = morphing();
    let (start, end) = (text.find("\"animations\"").unwrap(), text.rfind('}').unwrap());
    let still = loaded(&format!("{}\"extras\": 0{}", &text[..start], &text[end..]));
    assert!(still.motion.is_still());
    let mut expected = CORNERS.map(|p| dvec(p) - DVec3::Z);
    expected[2].x += 0.5;
    assert_near(corners(&still), expected, 0.0);
}

/// A lamp and a sun that move, and a triangle that does not.
fn lit() -> String {
    let mut file = File::default();
    let mesh = triangle(&mut file);
    let times = file.floats("SCALAR", &[0.0, 1.0]);
    let moves = file.floats("VEC3", &[0.0, 2.0, 0.0, 4.0, 2.0, 0.0]);
    let turns = file.floats("VEC4", [about_y(0.0), about_y(90.0)].as_flattened());
    file.text(&format!(
        r#""scenes": [{{"nodes": [0, 1, 2, 3]}}], "extensionsUsed": ["KHR_lights_punctual"],
        "extensions": {{"KHR_lights_punctual": {{"lights": [{{"type": "point", "intensity": 1}}, {{"type": "point", "intensity": 9}}, {{"type": "directional"}}]}}}},
        "meshes": [{{"primitives": [{{"attributes": {{"POSITION": {mesh}}}}}]}}],
        "nodes": [{{"mesh": 0}}, {{"extensions": {{"KHR_lights_punctual": {{"light": 0}}}}}},
            {{"translation": [0, 9, 0], "extensions": {{"KHR_lights_punctual": {{"light": 1}}}}}}, {{"extensions": {{"KHR_lights_punctual": {{"light": 2}}}}}}],
        "animations": [{{"channels": [{{"sampler": 0, "target": {{"node": 1, "path": "translation"}}}}], "samplers": [{{"input": {times}, "output": {moves}}}]}},
            {{"channels": [{{"sampler": 0, "target": {{"node": 3, "path": "rotation"}}}}], "samplers": [{{"input": {times}, "output": {turns}}}]}}]"#
    ))
}

#[test]
fn lights_move_unless_the_notes_state_others() {
    let scene = loaded(&lit());
    let later = scene.at(0.5);
    assert!(scene.motion.meshes.is_empty() && later.model == scene.model);
    // The brighter lamp comes first.
    assert_eq!(
        later.lights.iter().map(|l| l.position).collect::<Vec<_>>(),
        [Vec3::Y * 9.0, Vec3::new(2.0, 2.0, 0.0)]
    );
    assert!(scene.sky.sun_direction.distance(Vec3::Z) < 1e-6);
    let (sin, cos) = 45f32.to_radians().sin_cos();
    assert!(later.sky.sun_direction.distance(Vec3::new(sin, 0.0, cos)) < 1e-6);
    let scaled = try_load(&lit(), Some(r#"{"scale": 0.5}"#)).unwrap();
    assert_eq!(scaled.lights.iter().map(|l| l.position.y).collect::<Vec<_>>(), [4.5, 1.0]);
    assert_eq!(scaled.at(0.5).lights[1].position, Vec3::new(1.0, 1.0, 0.0));
    let still = try_load(
        &lit(),
        Some(
            r#"{"lights": [], "sky": {"sun_direction": [0, 1, 0], "sun_color": [1, 1, 1], "zenith": [1, 1, 1], "horizon": [1, 1, 1], "ground": [1, 1, 1]}}"#,
        ),
    );
    assert!(still.unwrap().motion.is_still());
}

#[test]
fn a_scale_in_the_notes_scales_what_moves() {
    let (scene, large) = (loaded(&nodes()), try_load(&nodes(), Some(r#"{"scale": 3}"#)).unwrap());
    for time in [0.0, 1.7] {
        for (a, b) in corners(&scene.at(time)).into_iter().zip(corners(&large.at(time))) {
            assert!((a * 3.0).distance(b) < 1e-4);
        }
    }
}

#[test]
fn of_animations_of_one_node_the_first_plays() {
    let text = nodes();
    let at = text.find("\"animations\": [").unwrap() + "\"animations\": [".len();
    // The first animation turns node 2 in its own loop. The second is the earlier one, which also moves node 2.
    let first = r#"{"channels": [{"sampler": 0, "target": {"node": 2, "path": "rotation"}}], "samplers": [{"input": 3, "output": 2}]}, "#;
    let refused = try_load(&format!("{}{first}{}", &text[..at], &text[at..]), None).unwrap();
    assert_eq!(refused.motion.loops, [3.0]);
    // An animation of another property plays beside it.
    let first = r#"{"channels": [{"sampler": 0, "target": {"node": 2, "path": "translation"}}], "samplers": [{"input": 3, "output": 5}]}, "#;
    let both = loaded(&format!("{}{first}{}", &text[..at], &text[at..]));
    assert_eq!(both.motion.loops, [3.0, 4.0]);
    let apart = corners(&both.at(1.0))[0] - corners(&loaded(&text).at(1.0))[0];
    // The second of the scales in the first animation, used as translations: its key is at 1 s.
    assert!(apart.distance(Vec3::new(2.0, 1.0, 1.0)) < 1e-5, "{apart}");
}

#[test]
fn damaged_animations_are_refused_in_a_sentence() {
    let good = nodes();
    let skin = bent(WEIGHTS, [[0, 1, 0, 0]; 3], |_| String::new());
    for (text, from, to, words) in [
        (&good, "\"node\": 2, \"path\"", "\"node\": 7, \"path\"", "moves a node that does not exist"),
        (&good, "\"path\": \"rotation\"", "\"path\": \"colour\"", "unknown path"),
        (&good, "\"STEP\"", "\"JUMP\"", "interpolation"),
        (&good, "\"path\": \"scale\"", "\"path\": \"weights\"", "which has no morph targets"),
        (&good, "\"input\": 1, \"output\": 2", "\"input\": 1, \"output\": 5", "has the wrong type"),
        (&good, "\"CUBICSPLINE\"", "\"LINEAR\"", "has 27 numbers for 3 keys of 3 each"),
        (&skin, "\"joints\": [1, 2]", "\"joints\": [1, 2, 1]", "has 2 matrices for 3 joints"),
        (&skin, "{\"nodes\": [0, 1]}", "{\"nodes\": [0]}", "joint 1 of skin 0 is not in the scene"),
        (&skin, "\"WEIGHTS_0\": 2", "\"WEIGHTS_0\": 5", "has 2 elements for 3 vertices"),
    ] {
        assert!(text.contains(from), "{from}");
        let message = try_load(&text.replacen(from, to, 1), None).expect_err(words).to_string();
        assert!(message.contains(words) && message.contains("m.gltf"), "{message}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn damaged_motion_never_panics(which in 0usize..3, cuts in proptest::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..4)) {
        let text = [nodes, morphing, || bent(WEIGHTS, [[0, 1, 0, 0]; 3], |_| String::new())][which]();
        let mut text = text.into_bytes();
        for (at, byte) in cuts {
            let at = at.index(text.len());
            // Digits become other digits, so that most of the text stays readable.
            text[at] = if text[at].is_ascii_digit() { b'0' + byte % 10 } else { byte % 128 };
        }
        if let Ok(scene) = try_load(&String::from_utf8_lossy(&text), None) {
            scene.at(0.7);
        }
    }
}
