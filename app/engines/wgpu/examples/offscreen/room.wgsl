// Stands in for an engine's picture: rays into a tiled room with balls, with reversed depth.

struct View {
    eye: vec3<f32>,
    near: f32,
    corner: vec2<f32>,
    pixel: vec2<f32>,
}

@group(0) @binding(0) var<uniform> view: View;

struct Seen {
    @location(0) color: vec4<f32>,
    @builtin(frag_depth) depth: f32,
}

@vertex
fn corner(@builtin(vertex_index) id: u32) -> @builtin(position) vec4<f32> {
    return vec4<f32>(f32(id & 1u) * 4.0 - 1.0, f32(id >> 1u) * 4.0 - 1.0, 0.0, 1.0);
}

@fragment
fn see(@builtin(position) at: vec4<f32>) -> Seen {
    let ray = vec3<f32>(view.corner + at.xy * view.pixel, -1.0);
    let walls = (sign(ray) * vec3<f32>(3.0, 3.0, 5.0) - view.eye) / ray;
    var nearest = min(walls.x, min(walls.y, walls.z));
    let tile = vec3<i32>(floor((view.eye + ray * nearest * 0.999) * 2.0));
    var color = vec3<f32>(0.09, 0.12, 0.17);
    if ((tile.x + tile.y + tile.z) & 1) == 0 {
        color = vec3<f32>(0.52, 0.48, 0.39);
    }
    for (var number = 0; number < 7; number++) {
        let i = f32(number);
        let angle = 0.9 * i;
        let center = vec3<f32>(1.5 * sin(angle), 1.6 + 0.9 * cos(1.7 * angle), 0.9 - 0.8 * i);
        let radius = 0.2 + 0.05 * i;
        let to_eye = view.eye - center;
        let a = dot(ray, ray);
        let b = dot(to_eye, ray);
        let discriminant = b * b - a * (dot(to_eye, to_eye) - radius * radius);
        let distance = (-b - sqrt(max(discriminant, 0.0))) / a;
        if discriminant > 0.0 && distance > 0.0 && distance < nearest {
            nearest = distance;
            let normal = (view.eye + ray * distance - center) / radius;
            let light = 0.3 + 0.7 * max(dot(normal, vec3<f32>(0.36, 0.8, 0.48)), 0.0);
            let hue = 0.5 + 0.45 * cos(vec3<f32>(0.0, 2.1, 4.2) + i);
            color = hue * hue * light;
        }
    }
    // The ray's length along the axis is 1.
    return Seen(vec4<f32>(color, 1.0), view.near / nearest);
}
