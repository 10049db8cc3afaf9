// The passes around the second draw of an eye's opaque objects, which draws open pixels only. Depth is read as a number, since
// GLSL has no loads of depth textures.

@group(0) @binding(0) var synthesized_depth: texture_2d<f32>;
@group(0) @binding(1) var marks: texture_2d<u32>;

@vertex
fn screen(@builtin(vertex_index) index: u32) -> @builtin(position) vec4<f32> {
    return vec4(vec2(f32(index & 1u), f32(index >> 1u)) * 4.0 - 1.0, 0.0, 1.0);
}

fn is_open(position: vec4<f32>) -> bool {
    return textureLoad(marks, vec2<i32>(position.xy), 0).x == 0u;
}

// Opens pixels: the background's colour by the blend constant, and the farthest depth. All others are cleared to the nearest.
@fragment
fn open(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    if !is_open(position) {
        discard;
    }
    return vec4(1.0);
}

// Gives all other pixels their depth.
@fragment
fn restore(@builtin(position) position: vec4<f32>) -> @builtin(frag_depth) f32 {
    if is_open(position) {
        discard;
    }
    return textureLoad(synthesized_depth, vec2<i32>(position.xy), 0).x;
}
