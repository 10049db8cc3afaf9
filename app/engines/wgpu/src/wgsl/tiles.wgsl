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

@group(0) @binding(0) 
var depth_map_texture: texture_2d<f32>;
@group(0) @binding(5) 
var nearest_sampler: sampler;
@group(0) @binding(4) 
var<uniform> synthesis: Synthesis;
var<private> tile: vec4<u32>;
var<private> gl_FragCoord_1: vec4<f32>;

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

fn reversed_bits(bits: ptr<function, u32>) -> u32 {
    let _e1 = (*bits);
    return reverseBits(_e1);
}

fn in_place(marks: ptr<function, u32>) -> u32 {
    var local: u32;
    var param: u32;

    let _e7 = synthesis.mirrored;
    if (_e7 != 0u) {
        let _e9 = (*marks);
        let _e12 = (*marks);
        local = ((_e9 >> bitcast<u32>(16i)) | (_e12 << bitcast<u32>(16i)));
    } else {
        let _e16 = (*marks);
        param = _e16;
        let _e17 = reversed_bits((&param));
        local = _e17;
    }
    let _e18 = local;
    return _e18;
}

fn displacement(depth: ptr<function, f32>) -> f32 {
    let _e6 = synthesis.law[0u];
    let _e9 = synthesis.law[1u];
    let _e10 = (*depth);
    return (_e6 + (_e9 * _e10));
}

fn depth_gather(place: ptr<function, vec2<f32>>) -> vec4<f32> {
    var quad: vec4<f32>;

    let _e4 = (*place);
    let _e5 = textureGather(0, depth_map_texture, nearest_sampler, _e4);
    quad = _e5;
    let _e6 = quad;
    return _e6;
}

fn depth_quad(corner: ptr<function, vec2<f32>>) -> vec4<f32> {
    var last: vec2<f32>;
    var at: vec2<f32>;
    var local_1: vec2<f32>;
    var row: f32;
    var local_2: f32;
    var quad_1: vec4<f32>;
    var param_1: vec2<f32>;
    var local_3: vec4<f32>;
    var local_4: vec4<f32>;
    var local_5: vec4<f32>;
    var phi_214_: bool;
    var phi_246_: bool;

    let _e20 = synthesis.source_size;
    last = vec2<f32>((_e20 - vec2(2i)));
    if true {
        let _e24 = (*corner);
        let _e25 = last;
        local_1 = clamp(_e24, vec2<f32>(0f, 0f), max(_e25, vec2<f32>(0f, 0f)));
    } else {
        let _e28 = (*corner);
        local_1 = _e28;
    }
    let _e29 = local_1;
    at = _e29;
    let _e31 = at[1u];
    row = (_e31 + 1f);
    if true {
        let _e35 = synthesis.source_origin[1u];
        let _e37 = row;
        let _e41 = synthesis.texel[1u];
        local_2 = ((f32(_e35) + _e37) * _e41);
    } else {
        let _e43 = row;
        let _e46 = synthesis.source_size[1u];
        local_2 = (_e43 / f32(_e46));
    }
    let _e49 = local_2;
    row = _e49;
    let _e52 = synthesis.columns[0u];
    let _e54 = at[0u];
    let _e59 = synthesis.columns[1u];
    let _e61 = row;
    param_1 = vec2<f32>(((_e52 * (_e54 + 1f)) + _e59), _e61);
    let _e63 = depth_gather((&param_1));
    quad_1 = _e63;
    if true {
        let _e65 = (*corner)[0u];
        let _e67 = last[0u];
        let _e68 = (_e65 <= _e67);
        phi_214_ = _e68;
        if !(_e68) {
            let _e72 = synthesis.source_size[0u];
            phi_214_ = (_e72 == 1i);
        }
        let _e75 = phi_214_;
        if _e75 {
            let _e76 = quad_1;
            local_3 = _e76;
        } else {
            let _e78 = synthesis.mirrored;
            if (_e78 != 0u) {
                let _e80 = quad_1;
                local_4 = _e80.xxww;
            } else {
                let _e82 = quad_1;
                local_4 = _e82.yyzz;
            }
            let _e84 = local_4;
            local_3 = _e84;
        }
        let _e85 = local_3;
        quad_1 = _e85;
        let _e87 = (*corner)[1u];
        let _e89 = last[1u];
        let _e90 = (_e87 <= _e89);
        phi_246_ = _e90;
        if !(_e90) {
            let _e94 = synthesis.source_size[1u];
            phi_246_ = (_e94 == 1i);
        }
        let _e97 = phi_246_;
        if _e97 {
            let _e98 = quad_1;
            local_5 = _e98;
        } else {
            let _e99 = quad_1;
            local_5 = _e99.xyyx;
        }
        let _e101 = local_5;
        quad_1 = _e101;
    }
    let _e102 = quad_1;
    return _e102;
}

fn nearest_of(texel: ptr<function, vec4<f32>>) -> f32 {
    let _e3 = (*texel)[0u];
    return _e3;
}

fn depth_sample(place_1: ptr<function, vec2<f32>>) -> f32 {
    var param_2: vec4<f32>;

    let _e5 = (*place_1);
    let _e6 = textureSampleLevel(depth_map_texture, nearest_sampler, _e5, 0f);
    param_2 = _e6;
    let _e7 = nearest_of((&param_2));
    return _e7;
}

fn place_of(at_1: ptr<function, vec2<f32>>) -> vec2<f32> {
    var local_6: vec2<f32>;

    if true {
        let _e8 = (*at_1);
        let _e10 = synthesis.source_size;
        local_6 = clamp(_e8, vec2<f32>(0.5f, 0.5f), (vec2<f32>(_e10) - vec2(0.5f)));
    } else {
        let _e15 = (*at_1);
        local_6 = _e15;
    }
    let _e16 = local_6;
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
    var param_3: vec2<f32>;
    var param_4: vec2<f32>;
    var right: f32;
    var param_5: vec2<f32>;
    var param_6: vec2<f32>;
    var above: f32;
    var param_7: vec2<f32>;
    var param_8: vec2<f32>;
    var opposite: f32;
    var param_9: vec2<f32>;
    var param_10: vec2<f32>;
    var slope: vec2<f32>;
    var low_1: vec4<f32>;
    var high_1: vec4<f32>;
    var plane: f32;
    var lower_marks: u32;
    var marks_1: u32;
    var marked: f32;
    var begin: f32;
    var sense: f32;
    var row_1: f32;
    var before: vec2<f32>;
    var i: i32;
    var column: f32;
    var quad_2: vec4<f32>;
    var param_11: vec2<f32>;
    var depths: vec4<f32>;
    var between: vec2<f32>;
    var within: vec2<f32>;
    var second: vec4<f32>;
    var least: f32;
    var most: f32;
    var rise: vec2<f32>;
    var a: f32;
    var param_12: f32;
    var b: f32;
    var param_13: f32;
    var plane_law: vec3<f32>;
    var param_14: f32;
    var planar: bool;
    var rest: vec3<u32>;
    var local_7: vec3<u32>;
    var param_15: u32;
    var param_16: u32;
    var param_17: f32;
    var param_18: f32;
    var phi_631_: bool;

    let _e79 = (*corner_1);
    middle = (_e79 + vec2(0.5f));
    let _e82 = middle;
    param_3 = _e82;
    let _e83 = place_of((&param_3));
    param_4 = _e83;
    let _e84 = depth_sample((&param_4));
    first = _e84;
    let _e85 = middle;
    param_5 = (_e85 + vec2<f32>(16f, 0f));
    let _e87 = place_of((&param_5));
    param_6 = _e87;
    let _e88 = depth_sample((&param_6));
    right = _e88;
    let _e89 = middle;
    param_7 = (_e89 + vec2<f32>(0f, 7f));
    let _e91 = place_of((&param_7));
    param_8 = _e91;
    let _e92 = depth_sample((&param_8));
    above = _e92;
    let _e93 = middle;
    param_9 = (_e93 + vec2<f32>(16f, 7f));
    let _e95 = place_of((&param_9));
    param_10 = _e95;
    let _e96 = depth_sample((&param_10));
    opposite = _e96;
    let _e97 = right;
    let _e98 = above;
    let _e100 = first;
    slope = ((vec2<f32>(_e97, _e98) - vec2(_e100)) / vec2<f32>(16f, 7f));
    let _e106 = synthesis.law[1u];
    let _e107 = first;
    let _e108 = right;
    let _e110 = above;
    let _e112 = opposite;
    let _e117 = slope;
    slope = select(vec2<f32>(0f, 0f), _e117, vec2((abs((_e106 * (((_e107 - _e108) - _e110) + _e112))) <= 0.25f)));
    low_1 = vec4<f32>(1000000000f, 1000000000f, 1000000000f, 1000000000f);
    high_1 = vec4<f32>(-1000000000f, -1000000000f, -1000000000f, -1000000000f);
    plane = 0f;
    lower_marks = 0u;
    marks_1 = 0u;
    let _e122 = synthesis.law[1u];
    marked = (0.99f / abs(_e122));
    let _e126 = synthesis.mirrored;
    begin = select(0f, 15f, (_e126 != 0u));
    let _e130 = synthesis.mirrored;
    sense = select(1f, -1f, (_e130 != 0u));
    let _e134 = (*corner_1)[1u];
    row_1 = _e134;
    loop {
        let _e135 = row_1;
        let _e137 = (*corner_1)[1u];
        if (_e135 < (_e137 + 8f)) {
            let _e140 = row_1;
            let _e142 = (*corner_1)[1u];
            let _e145 = marks_1;
            let _e146 = lower_marks;
            lower_marks = select(_e146, _e145, (_e140 == (_e142 + 4f)));
            before = vec2<f32>(0f, 0f);
            i = 0i;
            loop {
                let _e148 = i;
                if (_e148 <= 16i) {
                    let _e150 = begin;
                    let _e151 = sense;
                    let _e152 = i;
                    column = (_e150 + (_e151 * f32(min(_e152, 15i))));
                    let _e158 = (*corner_1)[0u];
                    let _e159 = column;
                    let _e161 = row_1;
                    param_11 = vec2<f32>((_e158 + _e159), _e161);
                    let _e163 = depth_quad((&param_11));
                    quad_2 = _e163;
                    let _e164 = quad_2;
                    let _e165 = plane;
                    let _e167 = slope[0u];
                    let _e168 = column;
                    depths = (_e164 - vec4((_e165 + (_e167 * _e168))));
                    let _e173 = low_1;
                    let _e174 = depths;
                    low_1 = min(_e173, _e174);
                    let _e176 = high_1;
                    let _e177 = depths;
                    high_1 = max(_e176, _e177);
                    let _e179 = quad_2;
                    let _e181 = before;
                    between = abs((_e179.xw - _e181));
                    let _e184 = quad_2;
                    let _e186 = quad_2;
                    within = abs((_e184.yz - _e186.xw));
                    let _e190 = quad_2;
                    before = _e190.yz;
                    let _e192 = i;
                    let _e194 = i;
                    if ((_e192 > 0i) && (_e194 < 16i)) {
                        let _e197 = marks_1;
                        let _e201 = between[0u];
                        let _e203 = between[1u];
                        let _e205 = marked;
                        marks_1 = ((_e197 << bitcast<u32>(1i)) | select(0u, 1u, (max(_e201, _e203) > _e205)));
                    }
                    let _e209 = marks_1;
                    let _e213 = within[0u];
                    let _e215 = within[1u];
                    let _e217 = marked;
                    marks_1 = ((_e209 << bitcast<u32>(1i)) | select(0u, 1u, (max(_e213, _e215) > _e217)));
                    continue;
                } else {
                    break;
                }
                continuing {
                    let _e221 = i;
                    i = (_e221 + 2i);
                }
            }
            let _e224 = slope[1u];
            let _e226 = plane;
            plane = (_e226 + (2f * _e224));
            continue;
        } else {
            break;
        }
        continuing {
            let _e228 = row_1;
            row_1 = (_e228 + 2f);
        }
    }
    let _e231 = slope[0u];
    let _e233 = synthesis.mirrored;
    let _e239 = slope[1u];
    second = ((select(vec4<f32>(0f, 1f, 1f, 0f), vec4<f32>(1f, 0f, 0f, 1f), vec4((_e233 != 0u))) * _e231) + (vec4<f32>(1f, 1f, 0f, 0f) * _e239));
    let _e242 = second;
    let _e243 = low_1;
    low_1 = (_e243 - _e242);
    let _e245 = second;
    let _e246 = high_1;
    high_1 = (_e246 - _e245);
    let _e248 = low_1;
    let _e250 = low_1;
    let _e252 = min(_e248.xy, _e250.zw);
    low_1[0u] = _e252.x;
    low_1[1u] = _e252.y;
    let _e257 = high_1;
    let _e259 = high_1;
    let _e261 = max(_e257.xy, _e259.zw);
    high_1[0u] = _e261.x;
    high_1[1u] = _e261.y;
    let _e267 = low_1[0u];
    let _e269 = low_1[1u];
    least = min(_e267, _e269);
    let _e272 = high_1[0u];
    let _e274 = high_1[1u];
    most = max(_e272, _e274);
    let _e276 = slope;
    rise = (_e276 * vec2<f32>(16f, 7f));
    let _e278 = least;
    let _e280 = rise[0u];
    let _e284 = rise[1u];
    param_12 = ((_e278 + min(_e280, 0f)) + min(_e284, 0f));
    let _e287 = displacement((&param_12));
    a = _e287;
    let _e288 = most;
    let _e290 = rise[0u];
    let _e294 = rise[1u];
    param_13 = ((_e288 + max(_e290, 0f)) + max(_e294, 0f));
    let _e297 = displacement((&param_13));
    b = _e297;
    let _e298 = least;
    let _e299 = most;
    param_14 = (0.5f * (_e298 + _e299));
    let _e302 = displacement((&param_14));
    let _e305 = synthesis.law[1u];
    let _e306 = slope;
    let _e307 = (_e306 * _e305);
    plane_law = vec3<f32>(_e302, _e307.x, _e307.y);
    let _e313 = synthesis.law[1u];
    let _e315 = most;
    let _e316 = least;
    let _e319 = ((abs(_e313) * (_e315 - _e316)) <= 0.125f);
    phi_631_ = _e319;
    if _e319 {
        let _e321 = plane_law[1u];
        phi_631_ = (abs((_e321 - 0.25f)) < 0.75f);
    }
    let _e326 = phi_631_;
    planar = _e326;
    let _e327 = planar;
    if _e327 {
        let _e328 = plane_law;
        local_7 = bitcast<vec3<u32>>(_e328);
    } else {
        let _e330 = lower_marks;
        param_15 = _e330;
        let _e331 = in_place((&param_15));
        let _e333 = marks_1;
        param_16 = _e333;
        let _e334 = in_place((&param_16));
        local_7 = vec3<u32>(_e331, bitcast<u32>(9f), _e334);
    }
    let _e336 = local_7;
    rest = _e336;
    let _e337 = a;
    let _e338 = b;
    let _e340 = a;
    let _e341 = b;
    param_17 = min(_e337, _e338);
    param_18 = max(_e340, _e341);
    let _e343 = pack_interval((&param_17), (&param_18));
    let _e344 = rest;
    return vec4<u32>(_e343, _e344.x, _e344.y, _e344.z);
}

fn main_1() {
    var param_19: vec2<f32>;

    let _e5 = gl_FragCoord_1;
    param_19 = ((_e5.xy - vec2(0.5f)) * vec2<f32>(16f, 8f));
    let _e10 = plane_tile((&param_19));
    tile = _e10;
    return;
}

@fragment 
fn main(@builtin(position) gl_FragCoord: vec4<f32>) -> @location(0) vec4<u32> {
    gl_FragCoord_1 = gl_FragCoord;
    main_1();
    let _e3 = tile;
    return _e3;
}
