// Made of yoro's GLSL by `cargo xtask maintain renew`.
struct Synthesis {
    source_size: vec2<i32>,
    target_size: vec2<i32>,
    law: vec2<f32>,
    mirrored: u32,
    row_offset: i32,
    target_origin: vec2<i32>,
    far_displacement: f32,
    near_displacement: f32,
    columns: vec2<f32>,
    origins: vec2<f32>,
    span_place: vec4<f32>,
    rows: vec2<f32>,
    first_row: f32,
    farthest: f32,
    source_origin: vec2<i32>,
    texel: vec2<f32>,
}

struct gl_PerVertex {
    @builtin(position) gl_Position: vec4<f32>,
    gl_PointSize: f32,
    gl_ClipDistance: array<f32, 1>,
    gl_CullDistance: array<f32, 1>,
}

struct VertexOutput {
    @location(0) member: vec2<f32>,
    @builtin(position) gl_Position: vec4<f32>,
}

var<private> gl_VertexIndex_1: i32;
@group(0) @binding(4) 
var<uniform> synthesis: Synthesis;
var<private> span_at: vec2<f32>;
var<private> unnamed: gl_PerVertex = gl_PerVertex(vec4<f32>(0f, 0f, 0f, 1f), 1f, array<f32, 1>(), array<f32, 1>());

fn main_1() {
    var id: i32;
    var corner: vec2<f32>;
    var pixel: vec2<f32>;

    let _e12 = gl_VertexIndex_1;
    id = _e12;
    let _e13 = id;
    let _e18 = id;
    corner = vec2<f32>(f32(((_e13 << bitcast<u32>(1i)) & 2i)), f32((_e18 & 2i)));
    let _e23 = synthesis.target_origin;
    let _e25 = corner;
    let _e27 = synthesis.target_size;
    pixel = (vec2<f32>(_e23) + (_e25 * vec2<f32>(_e27)));
    let _e32 = synthesis.span_place;
    let _e34 = pixel;
    let _e37 = synthesis.span_place;
    span_at = ((_e32.xy * _e34) + _e37.zw);
    let _e40 = corner;
    let _e43 = ((_e40 * 2f) - vec2(1f));
    unnamed.gl_Position = vec4<f32>(_e43.x, _e43.y, 0f, 1f);
    return;
}

@vertex 
fn main(@builtin(vertex_index) gl_VertexIndex: u32) -> VertexOutput {
    gl_VertexIndex_1 = i32(gl_VertexIndex);
    main_1();
    let _e7 = unnamed.gl_Position.y;
    unnamed.gl_Position.y = -(_e7);
    let _e9 = span_at;
    let _e10 = unnamed.gl_Position;
    return VertexOutput(_e9, _e10);
}
