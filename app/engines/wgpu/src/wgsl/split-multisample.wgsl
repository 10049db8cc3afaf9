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

struct FragmentOutput {
    @location(0) member: u32,
    @location(1) member_1: vec4<f32>,
}

@group(0) @binding(7) 
var<uniform> synthesis: Synthesis;
@group(0) @binding(1) 
var color_map_texture: texture_2d<f32>;
@group(0) @binding(0) 
var sample_depths_texture: texture_multisampled_2d<f32>;
var<private> gl_FragCoord_1: vec4<f32>;
var<private> layer: u32;
var<private> back_1: vec4<f32>;

fn shared_back(color: ptr<function, vec4<f32>>, front_color: ptr<function, vec4<f32>>, back_color: ptr<function, vec4<f32>>, share: ptr<function, f32>) -> vec4<f32> {
    var residual: vec4<f32>;
    var rest: f32;

    let _e8 = (*color);
    let _e9 = (*share);
    let _e10 = (*front_color);
    let _e13 = (*share);
    let _e15 = (*back_color);
    residual = ((_e8 - (_e10 * _e9)) - (_e15 * (1f - _e13)));
    let _e18 = (*share);
    rest = (1f - _e18);
    let _e20 = (*back_color);
    let _e21 = residual;
    let _e22 = rest;
    let _e24 = (*share);
    let _e25 = (*share);
    let _e27 = rest;
    let _e28 = rest;
    return clamp((_e20 + ((_e21 * _e22) / vec4(((_e24 * _e25) + (_e27 * _e28))))), vec4(0f), vec4(1f));
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

fn inside(pixel_1: ptr<function, vec2<i32>>) -> vec2<i32> {
    let _e4 = (*pixel_1);
    let _e6 = synthesis.source_size;
    return clamp(_e4, vec2<i32>(0i, 0i), (_e6 - vec2(1i)));
}

fn color_of(pixel_2: ptr<function, vec2<i32>>) -> vec4<f32> {
    var param: vec2<i32>;
    var param_1: vec2<i32>;

    let _e5 = (*pixel_2);
    param = _e5;
    let _e6 = inside((&param));
    param_1 = _e6;
    let _e7 = in_image((&param_1));
    let _e8 = textureLoad(color_map_texture, _e7, 0i);
    return _e8;
}

fn reach() -> f32 {
    let _e3 = synthesis.near_displacement;
    let _e5 = synthesis.far_displacement;
    return max((_e3 - _e5), 0.000001f);
}

fn pack_split(front: ptr<function, f32>, back: ptr<function, f32>, mask: ptr<function, u32>) -> u32 {
    var steps: vec2<u32>;

    let _e12 = (*front);
    let _e13 = (*back);
    let _e15 = reach();
    steps = vec2<u32>(((clamp((vec2<f32>(_e12, _e13) / vec2(_e15)), vec2(0f), vec2(1f)) * 16383f) + vec2(0.5f)));
    let _e25 = (*mask);
    let _e29 = steps[1u];
    let _e34 = steps[0u];
    return (((_e25 << bitcast<u32>(28i)) | (_e29 << bitcast<u32>(14i))) | _e34);
}

fn pack_full(front_1: ptr<function, f32>) -> u32 {
    let _e5 = (*front_1);
    let _e6 = reach();
    return (4026531840u | u32((clamp((_e5 / _e6), 0f, 1f) * 268435440f)));
}

fn smallest(v: ptr<function, vec4<f32>>) -> f32 {
    let _e6 = (*v)[0u];
    let _e8 = (*v)[1u];
    let _e11 = (*v)[2u];
    let _e13 = (*v)[3u];
    return min(min(_e6, _e8), min(_e11, _e13));
}

fn largest(v_1: ptr<function, vec4<f32>>) -> f32 {
    let _e6 = (*v_1)[0u];
    let _e8 = (*v_1)[1u];
    let _e11 = (*v_1)[2u];
    let _e13 = (*v_1)[3u];
    return max(max(_e6, _e8), max(_e11, _e13));
}

fn sample_order() -> vec4<i32> {
    let _e5 = synthesis.mirrored;
    return select(vec4<i32>(2i, 0i, 3i, 1i), vec4<i32>(1i, 3i, 0i, 2i), vec4((_e5 != 0u)));
}

fn displacements(pixel_3: ptr<function, vec2<i32>>) -> vec4<f32> {
    var at: vec2<i32>;
    var param_2: vec2<i32>;
    var param_3: vec2<i32>;
    var stripes: vec4<i32>;
    var depths: vec4<f32>;

    let _e12 = (*pixel_3);
    param_2 = _e12;
    let _e13 = inside((&param_2));
    param_3 = _e13;
    let _e14 = in_image((&param_3));
    at = _e14;
    let _e15 = sample_order();
    stripes = _e15;
    let _e16 = at;
    let _e18 = stripes[0u];
    let _e19 = textureLoad(sample_depths_texture, _e16, _e18);
    let _e21 = at;
    let _e23 = stripes[1u];
    let _e24 = textureLoad(sample_depths_texture, _e21, _e23);
    let _e26 = at;
    let _e28 = stripes[2u];
    let _e29 = textureLoad(sample_depths_texture, _e26, _e28);
    let _e31 = at;
    let _e33 = stripes[3u];
    let _e34 = textureLoad(sample_depths_texture, _e31, _e33);
    depths = vec4<f32>(_e19.x, _e24.x, _e29.x, _e34.x);
    let _e39 = synthesis.law[0u];
    let _e41 = synthesis.far_displacement;
    let _e45 = synthesis.law[1u];
    let _e46 = depths;
    return (vec4((_e39 - _e41)) + (_e46 * _e45));
}

fn main_1() {
    var pixel_4: vec2<i32>;
    var samples: vec4<f32>;
    var param_4: vec2<i32>;
    var nearest: f32;
    var param_5: vec4<f32>;
    var full: bool;
    var param_6: vec4<f32>;
    var in_front: vec4<f32>;
    var local_1: vec4<f32>;
    var count: f32;
    var front_2: f32;
    var second: f32;
    var param_7: vec4<f32>;
    var behind: vec4<f32>;
    var back_displacement: f32;
    var bits: u32;
    var local_2: u32;
    var param_8: f32;
    var param_9: f32;
    var param_10: f32;
    var param_11: u32;
    var share_1: f32;
    var color_1: vec4<f32>;
    var param_12: vec2<i32>;
    var front_sum: vec4<f32>;
    var back_sum: vec4<f32>;
    var front_weight: f32;
    var back_weight: f32;
    var least: vec4<f32>;
    var most: vec4<f32>;
    var i: i32;
    var other: vec4<f32>;
    var indexable: array<vec2<i32>, 8>;
    var param_13: vec2<i32>;
    var middle: f32;
    var weight: f32;
    var param_14: vec4<f32>;
    var param_15: vec4<f32>;
    var tap: vec4<f32>;
    var indexable_1: array<vec2<i32>, 8>;
    var param_16: vec2<i32>;
    var of_front: f32;
    var of_back: f32;
    var front_color_1: vec4<f32>;
    var back_color_1: vec4<f32>;
    var param_17: vec4<f32>;
    var param_18: vec4<f32>;
    var param_19: vec4<f32>;
    var param_20: f32;

    let _e67 = gl_FragCoord_1;
    pixel_4 = vec2<i32>(_e67.xy);
    let _e70 = pixel_4;
    param_4 = _e70;
    let _e71 = displacements((&param_4));
    samples = _e71;
    let _e72 = samples;
    param_5 = _e72;
    let _e73 = largest((&param_5));
    nearest = _e73;
    let _e74 = nearest;
    let _e75 = samples;
    param_6 = _e75;
    let _e76 = smallest((&param_6));
    full = ((_e74 - _e76) < 0.5f);
    let _e79 = full;
    if _e79 {
        local_1 = vec4<f32>(1f, 1f, 1f, 1f);
    } else {
        let _e80 = samples;
        let _e81 = nearest;
        local_1 = select(vec4<f32>(0f, 0f, 0f, 0f), vec4<f32>(1f, 1f, 1f, 1f), (_e80 > vec4((_e81 - 0.5f))));
    }
    let _e86 = local_1;
    in_front = _e86;
    let _e87 = in_front;
    count = dot(_e87, vec4<f32>(1f, 1f, 1f, 1f));
    let _e89 = in_front;
    let _e90 = samples;
    let _e92 = count;
    front_2 = (dot(_e89, _e90) / _e92);
    let _e94 = samples;
    let _e95 = in_front;
    param_7 = mix(_e94, vec4<f32>(-1000000000f, -1000000000f, -1000000000f, -1000000000f), _e95);
    let _e97 = largest((&param_7));
    second = _e97;
    let _e98 = in_front;
    let _e101 = samples;
    let _e102 = second;
    behind = ((vec4(1f) - _e98) * select(vec4<f32>(0f, 0f, 0f, 0f), vec4<f32>(1f, 1f, 1f, 1f), (_e101 > vec4((_e102 - 0.5f)))));
    let _e108 = behind;
    let _e109 = samples;
    let _e111 = behind;
    back_displacement = (dot(_e108, _e109) / max(dot(_e111, vec4<f32>(1f, 1f, 1f, 1f)), 1f));
    let _e115 = in_front;
    bits = u32(dot(_e115, vec4<f32>(1f, 2f, 4f, 8f)));
    let _e118 = full;
    if _e118 {
        let _e119 = front_2;
        param_8 = _e119;
        let _e120 = pack_full((&param_8));
        local_2 = _e120;
    } else {
        let _e121 = front_2;
        param_9 = _e121;
        let _e122 = back_displacement;
        param_10 = _e122;
        let _e123 = bits;
        param_11 = _e123;
        let _e124 = pack_split((&param_9), (&param_10), (&param_11));
        local_2 = _e124;
    }
    let _e125 = local_2;
    layer = _e125;
    let _e126 = count;
    share_1 = (0.25f * _e126);
    let _e128 = pixel_4;
    param_12 = _e128;
    let _e129 = color_of((&param_12));
    color_1 = _e129;
    front_sum = vec4<f32>(0f, 0f, 0f, 0f);
    back_sum = vec4<f32>(0f, 0f, 0f, 0f);
    front_weight = 0f;
    back_weight = 0f;
    least = vec4<f32>(1f, 1f, 1f, 1f);
    most = vec4<f32>(0f, 0f, 0f, 0f);
    let _e130 = full;
    i = select(0i, 8i, _e130);
    loop {
        let _e132 = i;
        if (_e132 < 8i) {
            let _e134 = pixel_4;
            let _e135 = i;
            indexable = array<vec2<i32>, 8>(vec2<i32>(-1i, 0i), vec2<i32>(1i, 0i), vec2<i32>(0i, -1i), vec2<i32>(0i, 1i), vec2<i32>(-1i, -1i), vec2<i32>(1i, -1i), vec2<i32>(-1i, 1i), vec2<i32>(1i, 1i));
            let _e137 = indexable[_e135];
            param_13 = (_e134 + _e137);
            let _e139 = displacements((&param_13));
            other = _e139;
            let _e140 = other;
            middle = dot(_e140, vec4<f32>(0.25f, 0.25f, 0.25f, 0.25f));
            let _e142 = i;
            weight = select(1f, 2f, (_e142 < 4i));
            let _e145 = other;
            param_14 = _e145;
            let _e146 = largest((&param_14));
            let _e147 = other;
            param_15 = _e147;
            let _e148 = smallest((&param_15));
            let _e151 = weight;
            weight = select(0f, _e151, ((_e146 - _e148) < 0.5f));
            let _e153 = pixel_4;
            let _e154 = i;
            indexable_1 = array<vec2<i32>, 8>(vec2<i32>(-1i, 0i), vec2<i32>(1i, 0i), vec2<i32>(0i, -1i), vec2<i32>(0i, 1i), vec2<i32>(-1i, -1i), vec2<i32>(1i, -1i), vec2<i32>(-1i, 1i), vec2<i32>(1i, 1i));
            let _e156 = indexable_1[_e154];
            param_16 = (_e153 + _e156);
            let _e158 = color_of((&param_16));
            tap = _e158;
            let _e159 = middle;
            let _e160 = front_2;
            let _e164 = weight;
            of_front = select(0f, _e164, (abs((_e159 - _e160)) < 0.5f));
            let _e166 = middle;
            let _e167 = back_displacement;
            let _e171 = weight;
            of_back = select(0f, _e171, (abs((_e166 - _e167)) < 0.5f));
            let _e173 = of_front;
            let _e174 = tap;
            let _e176 = front_sum;
            front_sum = (_e176 + (_e174 * _e173));
            let _e178 = of_back;
            let _e179 = tap;
            let _e181 = back_sum;
            back_sum = (_e181 + (_e179 * _e178));
            let _e183 = of_front;
            let _e184 = front_weight;
            front_weight = (_e184 + _e183);
            let _e186 = of_back;
            let _e187 = back_weight;
            back_weight = (_e187 + _e186);
            let _e189 = of_back;
            if (_e189 > 0f) {
                let _e191 = least;
                let _e192 = tap;
                least = min(_e191, _e192);
                let _e194 = most;
                let _e195 = tap;
                most = max(_e194, _e195);
            }
            continue;
        } else {
            break;
        }
        continuing {
            let _e197 = i;
            i = (_e197 + 1i);
        }
    }
    let _e199 = front_sum;
    let _e200 = front_weight;
    front_color_1 = (_e199 / vec4(max(_e200, 1f)));
    let _e204 = back_sum;
    let _e205 = back_weight;
    back_color_1 = (_e204 / vec4(max(_e205, 1f)));
    let _e209 = front_weight;
    let _e211 = back_weight;
    if ((_e209 > 0f) && (_e211 > 0f)) {
        let _e214 = color_1;
        param_17 = _e214;
        let _e215 = front_color_1;
        param_18 = _e215;
        let _e216 = back_color_1;
        param_19 = _e216;
        let _e217 = share_1;
        param_20 = _e217;
        let _e218 = shared_back((&param_17), (&param_18), (&param_19), (&param_20));
        let _e219 = least;
        let _e220 = most;
        back_color_1 = clamp(_e218, _e219, _e220);
    } else {
        let _e222 = front_weight;
        let _e224 = full;
        if ((_e222 > 0f) && !(_e224)) {
            let _e227 = color_1;
            let _e228 = share_1;
            let _e229 = front_color_1;
            let _e232 = share_1;
            back_color_1 = clamp(((_e227 - (_e229 * _e228)) / vec4((1f - _e232))), vec4(0f), vec4(1f));
        } else {
            let _e239 = back_weight;
            if (_e239 == 0f) {
                let _e241 = color_1;
                back_color_1 = _e241;
            }
        }
    }
    let _e242 = back_color_1;
    let _e243 = _e242.xyz;
    let _e244 = share_1;
    back_1 = vec4<f32>(_e243.x, _e243.y, _e243.z, _e244);
    return;
}

@fragment 
fn main(@builtin(position) gl_FragCoord: vec4<f32>) -> FragmentOutput {
    gl_FragCoord_1 = gl_FragCoord;
    main_1();
    let _e4 = layer;
    let _e5 = back_1;
    return FragmentOutput(_e4, _e5);
}
