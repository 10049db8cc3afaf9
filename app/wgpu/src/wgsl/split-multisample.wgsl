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

    let _e65 = gl_FragCoord_1;
    pixel_4 = vec2<i32>(_e65.xy);
    let _e68 = pixel_4;
    param_4 = _e68;
    let _e69 = displacements((&param_4));
    samples = _e69;
    let _e70 = samples;
    param_5 = _e70;
    let _e71 = largest((&param_5));
    nearest = _e71;
    let _e72 = nearest;
    let _e73 = samples;
    param_6 = _e73;
    let _e74 = smallest((&param_6));
    full = ((_e72 - _e74) < 0.5f);
    let _e77 = full;
    if _e77 {
        local_1 = vec4<f32>(1f, 1f, 1f, 1f);
    } else {
        let _e78 = samples;
        let _e79 = nearest;
        local_1 = select(vec4<f32>(0f, 0f, 0f, 0f), vec4<f32>(1f, 1f, 1f, 1f), (_e78 > vec4((_e79 - 0.5f))));
    }
    let _e84 = local_1;
    in_front = _e84;
    let _e85 = in_front;
    count = dot(_e85, vec4<f32>(1f, 1f, 1f, 1f));
    let _e87 = in_front;
    let _e88 = samples;
    let _e90 = count;
    front_2 = (dot(_e87, _e88) / _e90);
    let _e92 = samples;
    let _e93 = in_front;
    param_7 = mix(_e92, vec4<f32>(-1000000000f, -1000000000f, -1000000000f, -1000000000f), _e93);
    let _e95 = largest((&param_7));
    second = _e95;
    let _e96 = in_front;
    let _e99 = samples;
    let _e100 = second;
    behind = ((vec4(1f) - _e96) * select(vec4<f32>(0f, 0f, 0f, 0f), vec4<f32>(1f, 1f, 1f, 1f), (_e99 > vec4((_e100 - 0.5f)))));
    let _e106 = behind;
    let _e107 = samples;
    let _e109 = behind;
    back_displacement = (dot(_e106, _e107) / max(dot(_e109, vec4<f32>(1f, 1f, 1f, 1f)), 1f));
    let _e113 = in_front;
    bits = u32(dot(_e113, vec4<f32>(1f, 2f, 4f, 8f)));
    let _e116 = full;
    if _e116 {
        let _e117 = front_2;
        param_8 = _e117;
        let _e118 = pack_full((&param_8));
        local_2 = _e118;
    } else {
        let _e119 = front_2;
        param_9 = _e119;
        let _e120 = back_displacement;
        param_10 = _e120;
        let _e121 = bits;
        param_11 = _e121;
        let _e122 = pack_split((&param_9), (&param_10), (&param_11));
        local_2 = _e122;
    }
    let _e123 = local_2;
    layer = _e123;
    let _e124 = count;
    share_1 = (0.25f * _e124);
    let _e126 = pixel_4;
    param_12 = _e126;
    let _e127 = color_of((&param_12));
    color_1 = _e127;
    front_sum = vec4<f32>(0f, 0f, 0f, 0f);
    back_sum = vec4<f32>(0f, 0f, 0f, 0f);
    front_weight = 0f;
    back_weight = 0f;
    let _e128 = full;
    i = select(0i, 8i, _e128);
    loop {
        let _e130 = i;
        if (_e130 < 8i) {
            let _e132 = pixel_4;
            let _e133 = i;
            indexable = array<vec2<i32>, 8>(vec2<i32>(-1i, 0i), vec2<i32>(1i, 0i), vec2<i32>(0i, -1i), vec2<i32>(0i, 1i), vec2<i32>(-1i, -1i), vec2<i32>(1i, -1i), vec2<i32>(-1i, 1i), vec2<i32>(1i, 1i));
            let _e135 = indexable[_e133];
            param_13 = (_e132 + _e135);
            let _e137 = displacements((&param_13));
            other = _e137;
            let _e138 = other;
            middle = dot(_e138, vec4<f32>(0.25f, 0.25f, 0.25f, 0.25f));
            let _e140 = i;
            weight = select(1f, 2f, (_e140 < 4i));
            let _e143 = other;
            param_14 = _e143;
            let _e144 = largest((&param_14));
            let _e145 = other;
            param_15 = _e145;
            let _e146 = smallest((&param_15));
            let _e149 = weight;
            weight = select(0f, _e149, ((_e144 - _e146) < 0.5f));
            let _e151 = pixel_4;
            let _e152 = i;
            indexable_1 = array<vec2<i32>, 8>(vec2<i32>(-1i, 0i), vec2<i32>(1i, 0i), vec2<i32>(0i, -1i), vec2<i32>(0i, 1i), vec2<i32>(-1i, -1i), vec2<i32>(1i, -1i), vec2<i32>(-1i, 1i), vec2<i32>(1i, 1i));
            let _e154 = indexable_1[_e152];
            param_16 = (_e151 + _e154);
            let _e156 = color_of((&param_16));
            tap = _e156;
            let _e157 = middle;
            let _e158 = front_2;
            let _e162 = weight;
            of_front = select(0f, _e162, (abs((_e157 - _e158)) < 0.5f));
            let _e164 = middle;
            let _e165 = back_displacement;
            let _e169 = weight;
            of_back = select(0f, _e169, (abs((_e164 - _e165)) < 0.5f));
            let _e171 = of_front;
            let _e172 = tap;
            let _e174 = front_sum;
            front_sum = (_e174 + (_e172 * _e171));
            let _e176 = of_back;
            let _e177 = tap;
            let _e179 = back_sum;
            back_sum = (_e179 + (_e177 * _e176));
            let _e181 = of_front;
            let _e182 = front_weight;
            front_weight = (_e182 + _e181);
            let _e184 = of_back;
            let _e185 = back_weight;
            back_weight = (_e185 + _e184);
            continue;
        } else {
            break;
        }
        continuing {
            let _e187 = i;
            i = (_e187 + 1i);
        }
    }
    let _e189 = front_sum;
    let _e190 = front_weight;
    front_color_1 = (_e189 / vec4(max(_e190, 1f)));
    let _e194 = back_sum;
    let _e195 = back_weight;
    back_color_1 = (_e194 / vec4(max(_e195, 1f)));
    let _e199 = front_weight;
    let _e201 = back_weight;
    if ((_e199 > 0f) && (_e201 > 0f)) {
        let _e204 = color_1;
        param_17 = _e204;
        let _e205 = front_color_1;
        param_18 = _e205;
        let _e206 = back_color_1;
        param_19 = _e206;
        let _e207 = share_1;
        param_20 = _e207;
        let _e208 = shared_back((&param_17), (&param_18), (&param_19), (&param_20));
        back_color_1 = _e208;
    } else {
        let _e209 = front_weight;
        let _e211 = full;
        if ((_e209 > 0f) && !(_e211)) {
            let _e214 = color_1;
            let _e215 = share_1;
            let _e216 = front_color_1;
            let _e219 = share_1;
            back_color_1 = clamp(((_e214 - (_e216 * _e215)) / vec4((1f - _e219))), vec4(0f), vec4(1f));
        } else {
            let _e226 = back_weight;
            if (_e226 == 0f) {
                let _e228 = color_1;
                back_color_1 = _e228;
            }
        }
    }
    let _e229 = back_color_1;
    let _e230 = _e229.xyz;
    let _e231 = share_1;
    back_1 = vec4<f32>(_e230.x, _e230.y, _e230.z, _e231);
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
