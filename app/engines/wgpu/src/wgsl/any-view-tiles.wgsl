// Made of yoro's GLSL by `cargo xtask maintain renew`.
struct AnyView {
    source_size: vec2<i32>,
    target_origin: vec2<i32>,
    to_source_x: vec4<f32>,
    to_source_y: vec4<f32>,
    to_source_w: vec4<f32>,
    source_law: vec2<f32>,
    target_law: vec2<f32>,
    nearest: f32,
    far_depth: f32,
    source_origin: vec2<i32>,
    texel: vec2<f32>,
}

@group(0) @binding(4) 
var<uniform> synthesis: AnyView;
@group(0) @binding(0) 
var depth_map_texture: texture_2d<f32>;
var<private> gl_FragCoord_1: vec4<f32>;
var<private> tile: vec4<u32>;

fn nearest_of(texel: ptr<function, vec4<f32>>) -> f32 {
    let _e3 = (*texel)[0u];
    return _e3;
}

fn in_image(pixel: ptr<function, vec2<i32>>) -> vec2<i32> {
    var local: vec2<i32>;

    if true {
        let _e5 = synthesis.source_origin;
        let _e6 = (*pixel);
        local = (_e5 + _e6);
    } else {
        let _e8 = (*pixel);
        local = _e8;
    }
    let _e9 = local;
    return _e9;
}

fn depth_texel(column: ptr<function, i32>, row: ptr<function, i32>) -> f32 {
    var param: vec2<i32>;
    var param_1: vec4<f32>;

    let _e6 = (*column);
    let _e7 = (*row);
    param = vec2<i32>(_e6, _e7);
    let _e9 = in_image((&param));
    let _e10 = textureLoad(depth_map_texture, _e9, 0i);
    param_1 = _e10;
    let _e11 = nearest_of((&param_1));
    return _e11;
}

fn main_1() {
    var corner: vec2<i32>;
    var last: vec2<i32>;
    var least: f32;
    var most: f32;
    var y: i32;
    var x: i32;
    var pixel_1: vec2<i32>;
    var depth: f32;
    var param_2: i32;
    var param_3: i32;

    let _e23 = gl_FragCoord_1;
    corner = (vec2<i32>(_e23.xy) * vec2<i32>(16i, 8i));
    let _e28 = synthesis.source_size;
    last = (_e28 - vec2(1i));
    least = 1000000000f;
    most = -1000000000f;
    y = -1i;
    loop {
        let _e31 = y;
        if (_e31 <= 9i) {
            x = -1i;
            loop {
                let _e33 = x;
                if (_e33 <= 17i) {
                    let _e35 = corner;
                    let _e36 = x;
                    let _e37 = y;
                    let _e40 = last;
                    pixel_1 = clamp((_e35 + vec2<i32>(_e36, _e37)), vec2<i32>(0i, 0i), _e40);
                    let _e43 = pixel_1[0u];
                    param_2 = _e43;
                    let _e45 = pixel_1[1u];
                    param_3 = _e45;
                    let _e46 = depth_texel((&param_2), (&param_3));
                    depth = _e46;
                    let _e47 = least;
                    let _e48 = depth;
                    least = min(_e47, _e48);
                    let _e50 = most;
                    let _e51 = depth;
                    most = max(_e50, _e51);
                    continue;
                } else {
                    break;
                }
                continuing {
                    let _e53 = x;
                    x = (_e53 + 1i);
                }
            }
            continue;
        } else {
            break;
        }
        continuing {
            let _e55 = y;
            y = (_e55 + 1i);
        }
    }
    let _e57 = least;
    let _e59 = most;
    tile = vec4<u32>(bitcast<u32>(_e57), bitcast<u32>(_e59), 0u, 0u);
    return;
}

@fragment 
fn main(@builtin(position) gl_FragCoord: vec4<f32>) -> @location(0) vec4<u32> {
    gl_FragCoord_1 = gl_FragCoord;
    main_1();
    let _e3 = tile;
    return _e3;
}
