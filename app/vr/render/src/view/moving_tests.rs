//! Scenes that move.

use glam::{Quat, Vec3};

use super::tests::{open, scene, settings, view};
use super::*;
use crate::PreparedScene;
use crate::fixture::quad;
use yoro::eyes::DepthConvention;
use yoro_assets::motion::{Carrier, MovingLight, MovingMesh, Node, Track};
use yoro_assets::{Motion, Scene, ShadingStyle};
use yoro_test_support::record::{RecordedPass, Recorder};

fn track(values: &[f32]) -> Option<Track> {
    Some(Track { times: vec![0.0, 2.0], values: values.to_vec(), ..Track::default() })
}

/// Metres per second of the cube.
pub const CUBE_VELOCITY: Vec3 = Vec3::new(-0.1, 0.15, -2.0);
/// Radians per second of the fence, about Y, until its rotation slows down.
pub const FENCE_TURN: f64 = 0.15;

/// The small scene, in which a cube comes from behind the eye, the fence turns, a pane of glass rises and a lamp
/// passes.
pub fn moving() -> Scene {
    let mut scene = scene(ShadingStyle::Realistic);
    let glass = scene.model.vertices.len();
    quad(&mut scene.model, 5, Vec3::new(-0.2, 0.3, -1.2), Vec3::X * 0.6, Vec3::Y * 0.4);
    let (cube, fence) = (4..28, glass - 4..glass);
    let moves = |values: &[f32]| Node { moves: track(values), ..Node::default() };
    let turn = Quat::from_rotation_y(0.3).to_array();
    let turns = track(&[[0.0, 0.0, 0.0, 1.0], turn].concat());
    let nodes = vec![
        moves(&[0.0, 0.0, 3.5, -0.2, 0.3, -0.5]),
        Node { turns, ..Node::default() },
        moves(&[0.0, 0.0, 0.0, 0.0, 0.5, 0.0]),
    ];
    let mesh = |node, vertices: std::ops::Range<usize>| MovingMesh {
        rest: scene.model.vertices[vertices.clone()].to_vec(),
        vertices,
        carrier: Carrier::Node(node),
        morph: None,
    };
    let meshes = vec![mesh(0, cube), mesh(1, fence), mesh(2, glass..glass + 4)];
    let lights = vec![MovingLight { light: 1, node: 2, position: Vec3::new(0.0, 0.5, -1.0) }];
    scene.motion = Motion { loops: vec![2.5], nodes, meshes, lights, sun: None };
    let start = scene.at(0.0);
    Scene { model: start.model, lights: start.lights, ..scene }
}

fn picture(gl: &std::rc::Rc<yoro_gl::Context>, prepared: &mut PreparedScene) -> Vec<u8> {
    let view = view(DepthConvention::Reversed);
    let PreparedScene { scene, renderer } = prepared;
    let mut targets = ViewTargets::default();
    let picture =
        renderer.render_all(&mut targets, scene, &view).unwrap().color.read_rgba8(0, [0, 0], view.size);
    assert_eq!(gl.take_errors(), None);
    picture
}

/// What has moved must look as if it had been there from the start: surfaces, shadows, light, glass, and what comes
/// into view.
#[test]
fn a_scene_that_moved_is_the_scene_as_it_stands() {
    let head = open();
    let gl = head.gl();
    for msaa in [1, 4] {
        let settings = RenderSettings { msaa, ..settings() };
        let mut moved = PreparedScene::new(gl, moving(), &settings).unwrap();
        let mut pictures = Vec::new();
        // Includes steps backwards and to the start, and more steps than there are buffers.
        for seconds in [0.0, 1.3, 0.4, 2.4, 1.9, 0.0, 1.3] {
            moved.set_time(seconds).unwrap();
            let picture_moved = picture(gl, &mut moved);
            let still = moving().at(seconds);
            let mut still = PreparedScene::new(gl, still, &settings).unwrap();
            assert!(
                !still.scene.moves() && picture_moved == picture(gl, &mut still),
                "{msaa} samples at {seconds}"
            );
            pictures.push(picture_moved);
        }
        assert!(pictures[0] != pictures[1] && pictures[1] != pictures[2] && pictures[1] == pictures[6]);
    }
}

#[test]
fn scenes_that_stand_still_cost_nothing() {
    let head = open();
    let gl = head.gl();
    let recorder = Recorder::new(gl);
    let frame = |prepared: &mut PreparedScene, seconds: f64| -> [Vec<RecordedPass>; 2] {
        recorder.start();
        prepared.set_time(seconds).unwrap();
        let moving = recorder.take();
        recorder.start();
        picture(gl, prepared);
        [moving, recorder.take()]
    };
    let draws = |passes: &[RecordedPass]| passes.iter().map(|pass| pass.draws.len()).sum::<usize>();
    let mut still = PreparedScene::new(gl, scene(ShadingStyle::Realistic), &settings()).unwrap();
    let [first, second] = [0.0, 1.5].map(|seconds| frame(&mut still, seconds));
    assert!(first[0].is_empty() && first == second && draws(&first[1]) > 3);
    // A moving scene draws its shadow map whenever it has moved, and nothing else in addition.
    let mut moved = PreparedScene::new(gl, moving(), &settings()).unwrap();
    let shadow = |passes: &[RecordedPass]| passes.iter().all(|pass| pass.declaration.name == "shadow");
    let [start, again, later] = [0.0, 0.0, 1.5].map(|seconds| frame(&mut moved, seconds));
    assert!(start[0].is_empty() && again[0].is_empty());
    assert!(draws(&later[0]) > 1 && shadow(&later[0]) && !shadow(&later[1]));
}
