//! A scene that is cheap to render and uses every feature of materials.

use glam::{Vec2, Vec3};
use yoro_assets::Viewpoint;
use yoro_assets::{Alpha, Material, Model, Part, PointLight, Scene, ShadingStyle, Sky, TextureImage, Vertex};

/// Makes a texture of 2x2 texels.
fn texture(name: &str, srgb: bool, rgba: [[u8; 4]; 4]) -> TextureImage {
    TextureImage { name: name.into(), size: [2, 2], rgba: rgba.concat(), srgb, nearest: false }
}

/// Returns every combination of maps with every kind of opacity.
fn materials() -> Vec<Material> {
    let mut materials = Vec::new();
    for alpha in [Alpha::Opaque, Alpha::Cutout(0.5), Alpha::Blend(0.5)] {
        for bits in 0..16 {
            let map = |bit: usize| (bits & (1 << bit) != 0).then_some(bit);
            materials.push(Material {
                name: format!("{alpha:?} {bits}"),
                alpha,
                diffuse_map: map(0),
                specular_map: map(1),
                emissive_map: map(2),
                normal_map: map(3),
                ..Material::default()
            });
        }
    }
    materials
}

/// Makes a scene with a floor and a small square for each combination of material features, three metres away.
pub fn every_material(style: ShadingStyle) -> Scene {
    let mut model = Model {
        textures: vec![
            texture("color", true, [[200, 80, 40, 255], [40, 90, 200, 255], [90, 200, 60, 0], [255; 4]]),
            texture("shine", true, [[255; 4], [0, 0, 0, 255], [128; 4], [255; 4]]),
            texture("glow", true, [[255, 200, 100, 255], [0, 0, 0, 255], [0, 0, 0, 255], [30, 30, 90, 255]]),
            texture(
                "relief",
                false,
                [[160, 128, 240, 255], [96, 128, 240, 255], [128, 160, 240, 255], [128, 96, 240, 255]],
            ),
        ],
        materials: materials(),
        ..Model::default()
    };
    for i in 0..model.materials.len() {
        let center = Vec3::new((i % 8) as f32 - 3.5, (i / 8) as f32 - 2.5, -6.0 + 0.3 * (i % 5) as f32) * 0.5;
        square(&mut model, i, center, [Vec3::X * 0.2, Vec3::Y * 0.2]);
    }
    square(&mut model, 0, Vec3::new(0.0, -1.6, -4.0), [Vec3::X * 4.0, Vec3::NEG_Z * 4.0]);
    Scene {
        name: "every material".into(),
        model,
        style,
        sky: Sky::default(),
        lights: vec![PointLight { position: Vec3::new(0.5, 0.5, -1.0), color: Vec3::ONE, range: 5.0 }],
        viewpoints: vec![Viewpoint { position: Vec3::ZERO, target: Vec3::NEG_Z }],
        ..Scene::default()
    }
}

/// Removes all squares of [`every_material`] except those without maps and those with all maps. The floor stays. This
/// leaves six programs instead of 48.
pub fn keep_plain_and_full(scene: &mut Scene) {
    let mut index = 0..;
    scene.model.parts.retain(|_| index.next().is_some_and(|i: usize| i.is_multiple_of(16) || i % 16 == 15));
}

/// Appends a square, given by its centre and two half-axes.
fn square(model: &mut Model, material: usize, center: Vec3, [across, up]: [Vec3; 2]) {
    let (first, start) = (model.vertices.len() as u32, model.indices.len());
    for uv in [Vec2::ZERO, Vec2::X, Vec2::ONE, Vec2::Y] {
        let position = center + across * (2.0 * uv.x - 1.0) + up * (2.0 * uv.y - 1.0);
        model.vertices.push(Vertex { position, normal: across.cross(up).normalize(), uv });
    }
    model.indices.extend([0, 1, 2, 0, 2, 3].map(|i| first + i));
    model.parts.push(Part { name: format!("part {first}"), material, indices: start..model.indices.len() });
}
