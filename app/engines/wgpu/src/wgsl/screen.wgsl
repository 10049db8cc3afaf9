// Made of yoro's GLSL by `cargo xtask maintain renew`.
struct gl_PerVertex {
    @builtin(position) gl_Position: vec4<f32>,
    gl_PointSize: f32,
    gl_ClipDistance: array<f32, 1>,
    gl_CullDistance: array<f32, 1>,
}

var<private> gl_VertexIndex_1: i32;
var<private> unnamed: gl_PerVertex = gl_PerVertex(vec4<f32>(0f, 0f, 0f, 1f), 1f, array<f32, 1>(), array<f32, 1>());

fn main_1() {
    var id: i32;
    var corner: vec2<f32>;

    let _e9 = gl_VertexIndex_1;
    id = _e9;
    let _e10 = id;
    let _e15 = id;
    corner = vec2<f32>(f32(((_e10 << bitcast<u32>(1i)) & 2i)), f32((_e15 & 2i)));
    let _e19 = corner;
    let _e22 = ((_e19 * 2f) - vec2(1f));
    unnamed.gl_Position = vec4<f32>(_e22.x, _e22.y, 0f, 1f);
    return;
}

@vertex 
fn main(@builtin(vertex_index) gl_VertexIndex: u32) -> @builtin(position) vec4<f32> {
    gl_VertexIndex_1 = i32(gl_VertexIndex);
    main_1();
    let _e6 = unnamed.gl_Position.y;
    unnamed.gl_Position.y = -(_e6);
    let _e8 = unnamed.gl_Position;
    return _e8;
}
