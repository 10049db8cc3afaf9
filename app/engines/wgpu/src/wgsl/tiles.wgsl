// Made of yoro's GLSL by `cargo tools wgsl`.
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

@group(0) @binding(7) 
var<uniform> synthesis: Synthesis;
@group(0) @binding(0) 
var depth_map_texture: texture_2d<f32>;
@group(0) @binding(8) 
var nearest_sampler: sampler;
var<private> gl_FragCoord_1: vec4<f32>;
var<private> tile: vec4<u32>;

fn pack_interval(low: ptr<function, f32>, high: ptr<function, f32>) -> u32 {
    var lowest: f32;
    var highest: f32;

    let _e10 = (*low);
    let _e12 = synthesis.far_displacement;
    lowest = clamp(floor(((_e10 - _e12) * 16f)), 0f, 65534f);
    let _e17 = (*high);
    let _e19 = synthesis.far_displacement;
    highest = clamp(ceil(((_e17 - _e19) * 16f)), 0f, 65535f);
    let _e24 = lowest;
    let _e26 = highest;
    return (u32(_e24) | (u32(_e26) << bitcast<u32>(16i)));
}

fn displacement(depth: ptr<function, f32>) -> f32 {
    let _e6 = synthesis.law[0u];
    let _e9 = synthesis.law[1u];
    let _e10 = (*depth);
    return (_e6 + (_e9 * _e10));
}

fn depth_quad(corner: ptr<function, vec2<f32>>) -> vec4<f32> {
    var last: vec2<f32>;
    var at: vec2<f32>;
    var local: vec2<f32>;
    var row: f32;
    var local_1: f32;
    var quad: vec4<f32>;
    var local_2: vec4<f32>;
    var local_3: vec4<f32>;
    var local_4: vec4<f32>;
    var phi_131_: bool;
    var phi_163_: bool;

    let _e21 = synthesis.source_size;
    last = vec2<f32>((_e21 - vec2(2i)));
    if true {
        let _e25 = (*corner);
        let _e26 = last;
        local = clamp(_e25, vec2<f32>(0f, 0f), max(_e26, vec2<f32>(0f, 0f)));
    } else {
        let _e29 = (*corner);
        local = _e29;
    }
    let _e30 = local;
    at = _e30;
    let _e32 = at[1u];
    row = (_e32 + 1f);
    if true {
        let _e36 = synthesis.source_origin[1u];
        let _e38 = row;
        let _e42 = synthesis.texel[1u];
        local_1 = ((f32(_e36) + _e38) * _e42);
    } else {
        let _e44 = row;
        let _e47 = synthesis.source_size[1u];
        local_1 = (_e44 / f32(_e47));
    }
    let _e50 = local_1;
    row = _e50;
    let _e53 = synthesis.columns[0u];
    let _e55 = at[0u];
    let _e60 = synthesis.columns[1u];
    let _e62 = row;
    let _e64 = textureGather(0, depth_map_texture, nearest_sampler, vec2<f32>(((_e53 * (_e55 + 1f)) + _e60), _e62));
    quad = _e64;
    if true {
        let _e66 = (*corner)[0u];
        let _e68 = last[0u];
        let _e69 = (_e66 <= _e68);
        phi_131_ = _e69;
        if !(_e69) {
            let _e73 = synthesis.source_size[0u];
            phi_131_ = (_e73 == 1i);
        }
        let _e76 = phi_131_;
        if _e76 {
            let _e77 = quad;
            local_2 = _e77;
        } else {
            let _e79 = synthesis.mirrored;
            if (_e79 != 0u) {
                let _e81 = quad;
                local_3 = _e81.xxww;
            } else {
                let _e83 = quad;
                local_3 = _e83.yyzz;
            }
            let _e85 = local_3;
            local_2 = _e85;
        }
        let _e86 = local_2;
        quad = _e86;
        let _e88 = (*corner)[1u];
        let _e90 = last[1u];
        let _e91 = (_e88 <= _e90);
        phi_163_ = _e91;
        if !(_e91) {
            let _e95 = synthesis.source_size[1u];
            phi_163_ = (_e95 == 1i);
        }
        let _e98 = phi_163_;
        if _e98 {
            let _e99 = quad;
            local_4 = _e99;
        } else {
            let _e100 = quad;
            local_4 = _e100.xyyx;
        }
        let _e102 = local_4;
        quad = _e102;
    }
    let _e103 = quad;
    return _e103;
}

fn main_1() {
    var corner_1: vec2<f32>;
    var least: f32;
    var most: f32;
    var low_1: vec4<f32>;
    var high_1: vec4<f32>;
    var row_1: f32;
    var i: i32;
    var depths: vec4<f32>;
    var param: vec2<f32>;
    var a: f32;
    var param_1: f32;
    var b: f32;
    var param_2: f32;
    var param_3: f32;
    var param_4: f32;

    let _e31 = gl_FragCoord_1;
    corner_1 = ((_e31.xy - vec2(0.5f)) * vec2<f32>(16f, 8f));
    least = 1000000000f;
    most = -1000000000f;
    low_1 = vec4<f32>(1000000000f, 1000000000f, 1000000000f, 1000000000f);
    high_1 = vec4<f32>(-1000000000f, -1000000000f, -1000000000f, -1000000000f);
    let _e37 = corner_1[1u];
    row_1 = _e37;
    loop {
        let _e38 = row_1;
        let _e40 = corner_1[1u];
        if (_e38 < (_e40 + 8f)) {
            i = 0i;
            loop {
                let _e43 = i;
                if (_e43 <= 16i) {
                    let _e46 = corner_1[0u];
                    let _e47 = i;
                    let _e51 = row_1;
                    param = vec2<f32>((_e46 + f32(min(_e47, 15i))), _e51);
                    let _e53 = depth_quad((&param));
                    depths = _e53;
                    let _e54 = low_1;
                    let _e55 = depths;
                    low_1 = min(_e54, _e55);
                    let _e57 = high_1;
                    let _e58 = depths;
                    high_1 = max(_e57, _e58);
                    continue;
                } else {
                    break;
                }
                continuing {
                    let _e60 = i;
                    i = (_e60 + 2i);
                }
            }
            continue;
        } else {
            break;
        }
        continuing {
            let _e62 = row_1;
            row_1 = (_e62 + 2f);
        }
    }
    let _e64 = low_1;
    let _e66 = low_1;
    let _e68 = min(_e64.xy, _e66.zw);
    low_1[0u] = _e68.x;
    low_1[1u] = _e68.y;
    let _e73 = high_1;
    let _e75 = high_1;
    let _e77 = max(_e73.xy, _e75.zw);
    high_1[0u] = _e77.x;
    high_1[1u] = _e77.y;
    let _e83 = low_1[0u];
    let _e85 = low_1[1u];
    least = min(_e83, _e85);
    let _e88 = high_1[0u];
    let _e90 = high_1[1u];
    most = max(_e88, _e90);
    let _e92 = least;
    param_1 = _e92;
    let _e93 = displacement((&param_1));
    a = _e93;
    let _e94 = most;
    param_2 = _e94;
    let _e95 = displacement((&param_2));
    b = _e95;
    let _e96 = a;
    let _e97 = b;
    let _e99 = a;
    let _e100 = b;
    param_3 = min(_e96, _e97);
    param_4 = max(_e99, _e100);
    let _e102 = pack_interval((&param_3), (&param_4));
    tile = vec4<u32>(_e102, 0u, 0u, 0u);
    return;
}

@fragment 
fn main(@builtin(position) gl_FragCoord: vec4<f32>) -> @location(0) vec4<u32> {
    gl_FragCoord_1 = gl_FragCoord;
    main_1();
    let _e3 = tile;
    return _e3;
}
