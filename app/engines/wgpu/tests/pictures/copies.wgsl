// Copies the pixels of one texture into another one of any renderable format.

@group(0) @binding(0) var from_texture: texture_2d<f32>;

@vertex
fn screen(@builtin(vertex_index) id: u32) -> @builtin(position) vec4<f32> {
    return vec4<f32>(vec2<f32>(f32((id << 1u) & 2u), f32(id & 2u)) * 2.0 - 1.0, 0.0, 1.0);
}

@fragment
fn color(@builtin(position) at: vec4<f32>) -> @location(0) vec4<f32> {
    return textureLoad(from_texture, vec2<i32>(at.xy), 0);
}

@fragment
fn depth(@builtin(position) at: vec4<f32>) -> @builtin(frag_depth) f32 {
    return textureLoad(from_texture, vec2<i32>(at.xy), 0).r;
}

@fragment
fn bits(@builtin(position) at: vec4<f32>) -> @location(0) u32 {
    return bitcast<u32>(textureLoad(from_texture, vec2<i32>(at.xy), 0).r);
}

// The pictures of the samples are stacked, the first one at the top.
@fragment
fn sample_depth(@builtin(position) at: vec4<f32>, @builtin(sample_index) sample: u32) -> @builtin(frag_depth) f32 {
    let rows = textureDimensions(from_texture).y / 4u;
    return textureLoad(from_texture, vec2<i32>(at.xy) + vec2<i32>(0, i32(sample * rows)), 0).r;
}
