// Pixels of one texture into another one of any format that is rendered to.

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
