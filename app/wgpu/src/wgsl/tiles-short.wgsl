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
    var phi_187_: bool;
    var phi_219_: bool;

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
        phi_187_ = _e69;
        if !(_e69) {
            let _e73 = synthesis.source_size[0u];
            phi_187_ = (_e73 == 1i);
        }
        let _e76 = phi_187_;
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
        phi_219_ = _e91;
        if !(_e91) {
            let _e95 = synthesis.source_size[1u];
            phi_219_ = (_e95 == 1i);
        }
        let _e98 = phi_219_;
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

fn depth_sample(place: ptr<function, vec2<f32>>) -> f32 {
    let _e4 = (*place);
    let _e5 = textureSampleLevel(depth_map_texture, nearest_sampler, _e4, 0f);
    return _e5.x;
}

fn place_of(at_1: ptr<function, vec2<f32>>) -> vec2<f32> {
    var local_5: vec2<f32>;

    if true {
        let _e8 = (*at_1);
        let _e10 = synthesis.source_size;
        local_5 = clamp(_e8, vec2<f32>(0.5f, 0.5f), (vec2<f32>(_e10) - vec2(0.5f)));
    } else {
        let _e15 = (*at_1);
        local_5 = _e15;
    }
    let _e16 = local_5;
    (*at_1) = _e16;
    let _e19 = synthesis.columns[0u];
    let _e21 = (*at_1)[0u];
    let _e25 = synthesis.columns[1u];
    let _e29 = synthesis.source_origin[1u];
    let _e32 = (*at_1)[1u];
    let _e36 = synthesis.texel[1u];
    return vec2<f32>(((_e19 * _e21) + _e25), ((f32(_e29) + _e32) * _e36));
}

fn plane_tile(corner_1: ptr<function, vec2<f32>>) -> vec4<u32> {
    var middle: vec2<f32>;
    var first: f32;
    var param: vec2<f32>;
    var param_1: vec2<f32>;
    var right: f32;
    var param_2: vec2<f32>;
    var param_3: vec2<f32>;
    var above: f32;
    var param_4: vec2<f32>;
    var param_5: vec2<f32>;
    var opposite: f32;
    var param_6: vec2<f32>;
    var param_7: vec2<f32>;
    var slope: vec2<f32>;
    var low_1: vec4<f32>;
    var high_1: vec4<f32>;
    var plane: f32;
    var row_1: f32;
    var i: i32;
    var column: f32;
    var depths: vec4<f32>;
    var param_8: vec2<f32>;
    var second: vec4<f32>;
    var least: f32;
    var most: f32;
    var rise: vec2<f32>;
    var a: f32;
    var param_9: f32;
    var b: f32;
    var param_10: f32;
    var plane_law: vec3<f32>;
    var param_11: f32;
    var planar: bool;
    var param_12: f32;
    var param_13: f32;
    var phi_502_: bool;

    let _e60 = (*corner_1);
    middle = (_e60 + vec2(0.5f));
    let _e63 = middle;
    param = _e63;
    let _e64 = place_of((&param));
    param_1 = _e64;
    let _e65 = depth_sample((&param_1));
    first = _e65;
    let _e66 = middle;
    param_2 = (_e66 + vec2<f32>(16f, 0f));
    let _e68 = place_of((&param_2));
    param_3 = _e68;
    let _e69 = depth_sample((&param_3));
    right = _e69;
    let _e70 = middle;
    param_4 = (_e70 + vec2<f32>(0f, 7f));
    let _e72 = place_of((&param_4));
    param_5 = _e72;
    let _e73 = depth_sample((&param_5));
    above = _e73;
    let _e74 = middle;
    param_6 = (_e74 + vec2<f32>(16f, 7f));
    let _e76 = place_of((&param_6));
    param_7 = _e76;
    let _e77 = depth_sample((&param_7));
    opposite = _e77;
    let _e78 = right;
    let _e79 = above;
    let _e81 = first;
    slope = ((vec2<f32>(_e78, _e79) - vec2(_e81)) / vec2<f32>(16f, 7f));
    let _e87 = synthesis.law[1u];
    let _e88 = first;
    let _e89 = right;
    let _e91 = above;
    let _e93 = opposite;
    let _e98 = slope;
    slope = select(vec2<f32>(0f, 0f), _e98, vec2((abs((_e87 * (((_e88 - _e89) - _e91) + _e93))) <= 0.25f)));
    low_1 = vec4<f32>(1000000000f, 1000000000f, 1000000000f, 1000000000f);
    high_1 = vec4<f32>(-1000000000f, -1000000000f, -1000000000f, -1000000000f);
    plane = 0f;
    let _e102 = (*corner_1)[1u];
    row_1 = _e102;
    loop {
        let _e103 = row_1;
        let _e105 = (*corner_1)[1u];
        if (_e103 < (_e105 + 8f)) {
            i = 0i;
            loop {
                let _e108 = i;
                if (_e108 <= 16i) {
                    let _e110 = i;
                    column = f32(min(_e110, 15i));
                    let _e114 = (*corner_1)[0u];
                    let _e115 = column;
                    let _e117 = row_1;
                    param_8 = vec2<f32>((_e114 + _e115), _e117);
                    let _e119 = depth_quad((&param_8));
                    let _e120 = plane;
                    let _e122 = slope[0u];
                    let _e123 = column;
                    depths = (_e119 - vec4((_e120 + (_e122 * _e123))));
                    let _e128 = low_1;
                    let _e129 = depths;
                    low_1 = min(_e128, _e129);
                    let _e131 = high_1;
                    let _e132 = depths;
                    high_1 = max(_e131, _e132);
                    continue;
                } else {
                    break;
                }
                continuing {
                    let _e134 = i;
                    i = (_e134 + 2i);
                }
            }
            let _e137 = slope[1u];
            let _e139 = plane;
            plane = (_e139 + (2f * _e137));
            continue;
        } else {
            break;
        }
        continuing {
            let _e141 = row_1;
            row_1 = (_e141 + 2f);
        }
    }
    let _e144 = slope[0u];
    let _e146 = synthesis.mirrored;
    let _e152 = slope[1u];
    second = ((select(vec4<f32>(0f, 1f, 1f, 0f), vec4<f32>(1f, 0f, 0f, 1f), vec4((_e146 != 0u))) * _e144) + (vec4<f32>(1f, 1f, 0f, 0f) * _e152));
    let _e155 = second;
    let _e156 = low_1;
    low_1 = (_e156 - _e155);
    let _e158 = second;
    let _e159 = high_1;
    high_1 = (_e159 - _e158);
    let _e161 = low_1;
    let _e163 = low_1;
    let _e165 = min(_e161.xy, _e163.zw);
    low_1[0u] = _e165.x;
    low_1[1u] = _e165.y;
    let _e170 = high_1;
    let _e172 = high_1;
    let _e174 = max(_e170.xy, _e172.zw);
    high_1[0u] = _e174.x;
    high_1[1u] = _e174.y;
    let _e180 = low_1[0u];
    let _e182 = low_1[1u];
    least = min(_e180, _e182);
    let _e185 = high_1[0u];
    let _e187 = high_1[1u];
    most = max(_e185, _e187);
    let _e189 = slope;
    rise = (_e189 * vec2<f32>(16f, 7f));
    let _e191 = least;
    let _e193 = rise[0u];
    let _e197 = rise[1u];
    param_9 = ((_e191 + min(_e193, 0f)) + min(_e197, 0f));
    let _e200 = displacement((&param_9));
    a = _e200;
    let _e201 = most;
    let _e203 = rise[0u];
    let _e207 = rise[1u];
    param_10 = ((_e201 + max(_e203, 0f)) + max(_e207, 0f));
    let _e210 = displacement((&param_10));
    b = _e210;
    let _e211 = least;
    let _e212 = most;
    param_11 = (0.5f * (_e211 + _e212));
    let _e215 = displacement((&param_11));
    let _e218 = synthesis.law[1u];
    let _e219 = slope;
    let _e220 = (_e219 * _e218);
    plane_law = vec3<f32>(_e215, _e220.x, _e220.y);
    let _e226 = synthesis.law[1u];
    let _e228 = most;
    let _e229 = least;
    let _e232 = ((abs(_e226) * (_e228 - _e229)) <= 0.125f);
    phi_502_ = _e232;
    if _e232 {
        let _e234 = plane_law[1u];
        phi_502_ = (abs((_e234 - 0.25f)) < 0.75f);
    }
    let _e239 = phi_502_;
    planar = _e239;
    let _e240 = a;
    let _e241 = b;
    let _e243 = a;
    let _e244 = b;
    param_12 = min(_e240, _e241);
    param_13 = max(_e243, _e244);
    let _e246 = pack_interval((&param_12), (&param_13));
    let _e247 = planar;
    let _e248 = plane_law;
    let _e251 = bitcast<vec3<u32>>(select(vec3<f32>(9f, 9f, 9f), _e248, vec3(_e247)));
    return vec4<u32>(_e246, _e251.x, _e251.y, _e251.z);
}

fn main_1() {
    var corner_2: vec2<f32>;
    var param_14: vec2<f32>;

    let _e6 = gl_FragCoord_1;
    corner_2 = ((_e6.xy - vec2(0.5f)) * vec2<f32>(16f, 8f));
    let _e11 = corner_2;
    param_14 = _e11;
    let _e12 = plane_tile((&param_14));
    tile = _e12;
    return;
}

@fragment 
fn main(@builtin(position) gl_FragCoord: vec4<f32>) -> @location(0) vec4<u32> {
    gl_FragCoord_1 = gl_FragCoord;
    main_1();
    let _e3 = tile;
    return _e3;
}
