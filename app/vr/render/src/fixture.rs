//! Shapes shared by the tests of several modules.

use glam::{Vec2, Vec3};

use yoro_assets::{Model, Part, Vertex};

/// Appends a parallelogram whose front faces along `across x up`.
pub fn quad(model: &mut Model, material: usize, corner: Vec3, across: Vec3, up: Vec3) {
    let (first, start) = (model.vertices.len() as u32, model.indices.len());
    let normal = across.cross(up).normalize();
    for uv in [Vec2::ZERO, Vec2::X, Vec2::ONE, Vec2::Y] {
        model.vertices.push(Vertex { position: corner + across * uv.x + up * uv.y, normal, uv });
    }
    model.indices.extend([0, 1, 2, 0, 2, 3].map(|i| first + i));
    let name = format!("quad {}", model.parts.len());
    model.parts.push(Part { name, material, indices: start..model.indices.len() });
}
