// Made of yoro's GLSL by `cargo tools wgsl`.
struct Split {
    mixed: bool,
    shows_back: bool,
    front: f32,
    back: f32,
}

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
@group(0) @binding(0) 
var depth_map_texture: texture_2d<f32>;
@group(0) @binding(1) 
var color_map_texture: texture_2d<f32>;
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

fn inside(pixel: ptr<function, vec2<i32>>) -> vec2<i32> {
    let _e4 = (*pixel);
    let _e6 = synthesis.source_size;
    return clamp(_e4, vec2<i32>(0i, 0i), (_e6 - vec2(1i)));
}

fn displacement(depth: ptr<function, f32>) -> f32 {
    let _e6 = synthesis.law[0u];
    let _e9 = synthesis.law[1u];
    let _e10 = (*depth);
    return (_e6 + (_e9 * _e10));
}

fn above_far(depth_1: ptr<function, f32>) -> f32 {
    var param: f32;

    let _e3 = (*depth_1);
    param = _e3;
    let _e4 = displacement((&param));
    let _e6 = synthesis.far_displacement;
    return (_e4 - _e6);
}

fn in_image(pixel_1: ptr<function, vec2<i32>>) -> vec2<i32> {
    var local: vec2<i32>;

    if true {
        let _e5 = synthesis.source_origin;
        let _e6 = (*pixel_1);
        local = (_e5 + _e6);
    } else {
        let _e8 = (*pixel_1);
        local = _e8;
    }
    let _e9 = local;
    return _e9;
}

fn depth_texel(column: ptr<function, i32>, row: ptr<function, i32>) -> f32 {
    var param_1: vec2<i32>;

    let _e5 = (*column);
    let _e6 = (*row);
    param_1 = vec2<i32>(_e5, _e6);
    let _e8 = in_image((&param_1));
    let _e9 = textureLoad(depth_map_texture, _e8, 0i);
    return _e9.x;
}

fn displacement_of(pixel_2: ptr<function, vec2<i32>>) -> f32 {
    var at: vec2<i32>;
    var param_2: vec2<i32>;
    var param_3: i32;
    var param_4: i32;
    var param_5: f32;

    let _e8 = (*pixel_2);
    param_2 = _e8;
    let _e9 = inside((&param_2));
    at = _e9;
    let _e11 = at[0u];
    param_3 = _e11;
    let _e13 = at[1u];
    param_4 = _e13;
    let _e14 = depth_texel((&param_3), (&param_4));
    param_5 = _e14;
    let _e15 = above_far((&param_5));
    return _e15;
}

fn is_pure(pixel_3: ptr<function, vec2<i32>>) -> bool {
    var here: f32;
    var param_6: vec2<i32>;
    var pure: bool;
    var i: i32;
    var there: f32;
    var indexable: array<vec2<i32>, 8>;
    var param_7: vec2<i32>;
    var phi_335_: bool;

    let _e14 = (*pixel_3);
    param_6 = _e14;
    let _e15 = displacement_of((&param_6));
    here = _e15;
    pure = true;
    i = 0i;
    loop {
        let _e16 = i;
        if (_e16 < 8i) {
            let _e18 = (*pixel_3);
            let _e19 = i;
            indexable = array<vec2<i32>, 8>(vec2<i32>(-1i, 0i), vec2<i32>(1i, 0i), vec2<i32>(0i, -1i), vec2<i32>(0i, 1i), vec2<i32>(-1i, -1i), vec2<i32>(1i, -1i), vec2<i32>(-1i, 1i), vec2<i32>(1i, 1i));
            let _e21 = indexable[_e19];
            param_7 = (_e18 + _e21);
            let _e23 = displacement_of((&param_7));
            there = _e23;
            let _e24 = pure;
            phi_335_ = _e24;
            if _e24 {
                let _e25 = there;
                let _e26 = here;
                phi_335_ = (_e25 >= (_e26 - 0.5f));
            }
            let _e30 = phi_335_;
            pure = _e30;
            continue;
        } else {
            break;
        }
        continuing {
            let _e31 = i;
            i = (_e31 + 1i);
        }
    }
    let _e33 = pure;
    return _e33;
}

fn tap_at(i_1: ptr<function, i32>) -> vec2<i32> {
    var local_1: vec2<i32>;
    var indexable_1: array<vec2<i32>, 8>;
    var indexable_2: array<vec2<i32>, 4>;

    let _e7 = (*i_1);
    if (_e7 < 8i) {
        let _e9 = (*i_1);
        indexable_1 = array<vec2<i32>, 8>(vec2<i32>(-1i, 0i), vec2<i32>(1i, 0i), vec2<i32>(0i, -1i), vec2<i32>(0i, 1i), vec2<i32>(-1i, -1i), vec2<i32>(1i, -1i), vec2<i32>(-1i, 1i), vec2<i32>(1i, 1i));
        let _e11 = indexable_1[_e9];
        local_1 = _e11;
    } else {
        let _e12 = (*i_1);
        indexable_2 = array<vec2<i32>, 4>(vec2<i32>(-2i, 0i), vec2<i32>(2i, 0i), vec2<i32>(0i, -2i), vec2<i32>(0i, 2i));
        let _e15 = indexable_2[(_e12 - 8i)];
        local_1 = _e15;
    }
    let _e16 = local_1;
    return _e16;
}

fn split_at(pixel_4: ptr<function, vec2<i32>>) -> Split {
    var here_1: f32;
    var param_8: vec2<i32>;
    var low: f32;
    var high: f32;
    var i_2: i32;
    var there_1: f32;
    var indexable_3: array<vec2<i32>, 8>;
    var param_9: vec2<i32>;
    var straight: bool;
    var local_2: f32;
    var local_3: f32;
    var front_like: bool;
    var phi_378_: bool;
    var phi_396_: bool;

    let _e20 = (*pixel_4);
    param_8 = _e20;
    let _e21 = displacement_of((&param_8));
    here_1 = _e21;
    let _e22 = here_1;
    low = _e22;
    let _e23 = here_1;
    high = _e23;
    i_2 = 0i;
    loop {
        let _e24 = i_2;
        if (_e24 < 8i) {
            let _e26 = (*pixel_4);
            let _e27 = i_2;
            indexable_3 = array<vec2<i32>, 8>(vec2<i32>(-1i, 0i), vec2<i32>(1i, 0i), vec2<i32>(0i, -1i), vec2<i32>(0i, 1i), vec2<i32>(-1i, -1i), vec2<i32>(1i, -1i), vec2<i32>(-1i, 1i), vec2<i32>(1i, 1i));
            let _e29 = indexable_3[_e27];
            param_9 = (_e26 + _e29);
            let _e31 = displacement_of((&param_9));
            there_1 = _e31;
            let _e32 = i_2;
            straight = (_e32 < 4i);
            let _e34 = straight;
            phi_378_ = _e34;
            if !(_e34) {
                let _e36 = low;
                let _e37 = here_1;
                phi_378_ = (_e36 >= (_e37 - 0.5f));
            }
            let _e41 = phi_378_;
            if _e41 {
                let _e42 = low;
                let _e43 = there_1;
                local_2 = min(_e42, _e43);
            } else {
                let _e45 = low;
                local_2 = _e45;
            }
            let _e46 = local_2;
            low = _e46;
            let _e47 = straight;
            phi_396_ = _e47;
            if !(_e47) {
                let _e49 = high;
                let _e50 = here_1;
                phi_396_ = (_e49 <= (_e50 + 0.5f));
            }
            let _e54 = phi_396_;
            if _e54 {
                let _e55 = high;
                let _e56 = there_1;
                local_3 = max(_e55, _e56);
            } else {
                let _e58 = high;
                local_3 = _e58;
            }
            let _e59 = local_3;
            high = _e59;
            continue;
        } else {
            break;
        }
        continuing {
            let _e60 = i_2;
            i_2 = (_e60 + 1i);
        }
    }
    let _e62 = low;
    let _e63 = here_1;
    front_like = (_e62 < (_e63 - 0.5f));
    let _e66 = front_like;
    let _e67 = here_1;
    let _e68 = low;
    return Split(_e66, false, _e67, _e68);
}

fn color_of(pixel_5: ptr<function, vec2<i32>>) -> vec4<f32> {
    var param_10: vec2<i32>;
    var param_11: vec2<i32>;

    let _e5 = (*pixel_5);
    param_10 = _e5;
    let _e6 = inside((&param_10));
    param_11 = _e6;
    let _e7 = in_image((&param_11));
    let _e8 = textureLoad(color_map_texture, _e7, 0i);
    return _e8;
}

fn main_1() {
    var pixel_6: vec2<i32>;
    var color_1: vec4<f32>;
    var param_12: vec2<i32>;
    var split: Split;
    var param_13: vec2<i32>;
    var front_sum: vec4<f32>;
    var back_sum: vec4<f32>;
    var front_any: vec4<f32>;
    var back_any: vec4<f32>;
    var weights: vec4<f32>;
    var i_3: i32;
    var offset: vec2<i32>;
    var param_14: i32;
    var there_2: f32;
    var param_15: vec2<i32>;
    var weight: f32;
    var of_front: f32;
    var of_back: f32;
    var tap: vec4<f32>;
    var param_16: vec2<i32>;
    var pure_1: f32;
    var param_17: vec2<i32>;
    var front_mean: vec4<f32>;
    var local_4: vec4<f32>;
    var front_color_1: vec4<f32>;
    var local_5: vec4<f32>;
    var back_color_1: vec4<f32>;
    var local_6: vec4<f32>;
    var local_7: vec4<f32>;
    var farthest: vec4<f32>;
    var distance_: f32;
    var local_8: f32;
    var i_4: i32;
    var tap_1: vec4<f32>;
    var indexable_4: array<vec2<i32>, 8>;
    var param_18: vec2<i32>;
    var apart: f32;
    var better: bool;
    var indexable_5: array<vec2<i32>, 8>;
    var param_19: vec2<i32>;
    var contrast: vec3<f32>;
    var prior: f32;
    var share_1: f32;
    var none: bool;
    var all_: bool;
    var full: bool;
    var side: u32;
    var forward: i32;
    var is_left: bool;
    var is_right: bool;
    var i_5: i32;
    var beside: Split;
    var local_9: i32;
    var param_20: vec2<i32>;
    var param_21: vec2<i32>;
    var goes_on: bool;
    var local_10: u32;
    var here_2: f32;
    var local_11: f32;
    var param_22: vec2<i32>;
    var local_12: u32;
    var param_23: f32;
    var param_24: f32;
    var param_25: f32;
    var param_26: u32;
    var param_27: vec4<f32>;
    var param_28: vec4<f32>;
    var param_29: vec4<f32>;
    var param_30: f32;
    var phi_687_: bool;
    var phi_798_: bool;
    var phi_807_: bool;
    var phi_832_: bool;

    let _e95 = gl_FragCoord_1;
    pixel_6 = vec2<i32>(_e95.xy);
    let _e98 = pixel_6;
    param_12 = _e98;
    let _e99 = color_of((&param_12));
    color_1 = _e99;
    let _e100 = pixel_6;
    param_13 = _e100;
    let _e101 = split_at((&param_13));
    split = _e101;
    front_sum = vec4<f32>(0f, 0f, 0f, 0f);
    back_sum = vec4<f32>(0f, 0f, 0f, 0f);
    front_any = vec4<f32>(0f, 0f, 0f, 0f);
    back_any = vec4<f32>(0f, 0f, 0f, 0f);
    weights = vec4<f32>(0f, 0f, 0f, 0f);
    let _e103 = split.mixed;
    i_3 = select(12i, 0i, _e103);
    loop {
        let _e105 = i_3;
        if (_e105 < 12i) {
            let _e107 = i_3;
            param_14 = _e107;
            let _e108 = tap_at((&param_14));
            offset = _e108;
            let _e109 = pixel_6;
            let _e110 = offset;
            param_15 = (_e109 + _e110);
            let _e112 = displacement_of((&param_15));
            there_2 = _e112;
            let _e114 = offset[0u];
            let _e116 = offset[0u];
            let _e119 = offset[1u];
            let _e121 = offset[1u];
            weight = (4f / f32(((_e114 * _e116) + (_e119 * _e121))));
            let _e126 = there_2;
            let _e128 = split.front;
            let _e132 = weight;
            of_front = select(0f, _e132, (abs((_e126 - _e128)) < 0.5f));
            let _e134 = there_2;
            let _e136 = split.back;
            let _e140 = weight;
            of_back = select(0f, _e140, (abs((_e134 - _e136)) < 0.5f));
            let _e142 = pixel_6;
            let _e143 = offset;
            param_16 = (_e142 + _e143);
            let _e145 = color_of((&param_16));
            tap = _e145;
            let _e146 = pixel_6;
            let _e147 = offset;
            param_17 = (_e146 + _e147);
            let _e149 = is_pure((&param_17));
            pure_1 = select(0f, 1f, _e149);
            let _e151 = pure_1;
            let _e152 = of_front;
            let _e154 = tap;
            let _e156 = front_sum;
            front_sum = (_e156 + (_e154 * (_e151 * _e152)));
            let _e158 = pure_1;
            let _e159 = of_back;
            let _e161 = tap;
            let _e163 = back_sum;
            back_sum = (_e163 + (_e161 * (_e158 * _e159)));
            let _e165 = of_front;
            let _e166 = tap;
            let _e168 = front_any;
            front_any = (_e168 + (_e166 * _e165));
            let _e170 = of_back;
            let _e171 = tap;
            let _e173 = back_any;
            back_any = (_e173 + (_e171 * _e170));
            let _e175 = pure_1;
            let _e176 = of_front;
            let _e178 = pure_1;
            let _e179 = of_back;
            let _e181 = of_front;
            let _e182 = of_back;
            let _e184 = weights;
            weights = (_e184 + vec4<f32>((_e175 * _e176), (_e178 * _e179), _e181, _e182));
            continue;
        } else {
            break;
        }
        continuing {
            let _e186 = i_3;
            i_3 = (_e186 + 1i);
        }
    }
    let _e189 = weights[2u];
    if (_e189 > 0f) {
        let _e191 = front_any;
        let _e193 = weights[2u];
        local_4 = (_e191 / vec4(_e193));
    } else {
        let _e196 = color_1;
        local_4 = _e196;
    }
    let _e197 = local_4;
    front_mean = _e197;
    let _e199 = weights[0u];
    if (_e199 > 0f) {
        let _e201 = front_sum;
        let _e203 = weights[0u];
        local_5 = (_e201 / vec4(_e203));
    } else {
        let _e206 = front_mean;
        local_5 = _e206;
    }
    let _e207 = local_5;
    front_color_1 = _e207;
    let _e209 = weights[1u];
    if (_e209 > 0f) {
        let _e211 = back_sum;
        let _e213 = weights[1u];
        local_6 = (_e211 / vec4(_e213));
    } else {
        let _e217 = weights[3u];
        if (_e217 > 0f) {
            let _e219 = back_any;
            let _e221 = weights[3u];
            local_7 = (_e219 / vec4(_e221));
        } else {
            let _e224 = color_1;
            local_7 = _e224;
        }
        let _e225 = local_7;
        local_6 = _e225;
    }
    let _e226 = local_6;
    back_color_1 = _e226;
    let _e228 = weights[0u];
    if (_e228 == 0f) {
        let _e231 = split.shows_back;
        let _e232 = front_mean;
        let _e233 = color_1;
        farthest = select(_e233, _e232, vec4(_e231));
        let _e237 = split.shows_back;
        if _e237 {
            local_8 = 0f;
        } else {
            let _e238 = color_1;
            let _e239 = back_color_1;
            let _e242 = color_1;
            let _e243 = back_color_1;
            local_8 = dot((_e238 - _e239).xyz, (_e242 - _e243).xyz);
        }
        let _e247 = local_8;
        distance_ = _e247;
        let _e249 = split.mixed;
        i_4 = select(8i, 0i, _e249);
        loop {
            let _e251 = i_4;
            if (_e251 < 8i) {
                let _e253 = pixel_6;
                let _e254 = i_4;
                indexable_4 = array<vec2<i32>, 8>(vec2<i32>(-1i, 0i), vec2<i32>(1i, 0i), vec2<i32>(0i, -1i), vec2<i32>(0i, 1i), vec2<i32>(-1i, -1i), vec2<i32>(1i, -1i), vec2<i32>(-1i, 1i), vec2<i32>(1i, 1i));
                let _e256 = indexable_4[_e254];
                param_18 = (_e253 + _e256);
                let _e258 = color_of((&param_18));
                tap_1 = _e258;
                let _e259 = tap_1;
                let _e260 = back_color_1;
                let _e263 = tap_1;
                let _e264 = back_color_1;
                apart = dot((_e259 - _e260).xyz, (_e263 - _e264).xyz);
                let _e268 = apart;
                let _e269 = distance_;
                let _e270 = (_e268 > _e269);
                phi_687_ = _e270;
                if _e270 {
                    let _e271 = pixel_6;
                    let _e272 = i_4;
                    indexable_5 = array<vec2<i32>, 8>(vec2<i32>(-1i, 0i), vec2<i32>(1i, 0i), vec2<i32>(0i, -1i), vec2<i32>(0i, 1i), vec2<i32>(-1i, -1i), vec2<i32>(1i, -1i), vec2<i32>(-1i, 1i), vec2<i32>(1i, 1i));
                    let _e274 = indexable_5[_e272];
                    param_19 = (_e271 + _e274);
                    let _e276 = displacement_of((&param_19));
                    let _e278 = split.front;
                    phi_687_ = (abs((_e276 - _e278)) < 0.5f);
                }
                let _e283 = phi_687_;
                better = _e283;
                let _e284 = better;
                let _e285 = tap_1;
                let _e286 = farthest;
                farthest = select(_e286, _e285, vec4(_e284));
                let _e289 = better;
                let _e290 = apart;
                let _e291 = distance_;
                distance_ = select(_e291, _e290, _e289);
                continue;
            } else {
                break;
            }
            continuing {
                let _e293 = i_4;
                i_4 = (_e293 + 1i);
            }
        }
        let _e295 = farthest;
        front_color_1 = _e295;
    }
    let _e296 = front_color_1;
    let _e297 = back_color_1;
    contrast = (_e296 - _e297).xyz;
    let _e301 = split.shows_back;
    prior = select(0.6f, 0.4f, _e301);
    let _e303 = color_1;
    let _e304 = back_color_1;
    let _e307 = contrast;
    let _e309 = prior;
    let _e312 = contrast;
    let _e313 = contrast;
    share_1 = clamp(((dot((_e303 - _e304).xyz, _e307) + (0.0039369473f * _e309)) / (dot(_e312, _e313) + 0.0039369473f)), 0f, 1f);
    let _e318 = share_1;
    share_1 = max(_e318, 0.125f);
    none = false;
    let _e320 = share_1;
    all_ = (_e320 > 0.95f);
    let _e323 = split.mixed;
    let _e325 = none;
    let _e327 = all_;
    full = ((!(_e323) || _e325) || _e327);
    side = 0u;
    let _e330 = synthesis.mirrored;
    forward = select(1i, -1i, (_e330 != 0u));
    is_left = false;
    is_right = false;
    let _e333 = full;
    i_5 = select(0i, 2i, _e333);
    loop {
        let _e335 = i_5;
        if (_e335 < 2i) {
            let _e337 = pixel_6;
            let _e338 = i_5;
            if (_e338 == 0i) {
                let _e340 = forward;
                local_9 = -(_e340);
            } else {
                let _e342 = forward;
                local_9 = _e342;
            }
            let _e343 = local_9;
            param_20 = (_e337 + vec2<i32>(_e343, 0i));
            let _e346 = inside((&param_20));
            param_21 = _e346;
            let _e347 = split_at((&param_21));
            beside = _e347;
            let _e349 = beside.front;
            let _e351 = split.front;
            goes_on = (abs((_e349 - _e351)) < 0.5f);
            let _e355 = is_left;
            phi_798_ = _e355;
            if !(_e355) {
                let _e357 = i_5;
                let _e359 = goes_on;
                phi_798_ = ((_e357 == 0i) && _e359);
            }
            let _e362 = phi_798_;
            is_left = _e362;
            let _e363 = is_right;
            phi_807_ = _e363;
            if !(_e363) {
                let _e365 = i_5;
                let _e367 = goes_on;
                phi_807_ = ((_e365 == 1i) && _e367);
            }
            let _e370 = phi_807_;
            is_right = _e370;
            continue;
        } else {
            break;
        }
        continuing {
            let _e371 = i_5;
            i_5 = (_e371 + 1i);
        }
    }
    let _e373 = is_left;
    let _e374 = is_right;
    if (_e373 && !(_e374)) {
        local_10 = 1u;
    } else {
        let _e377 = is_right;
        let _e378 = is_left;
        local_10 = select(0u, 2u, (_e377 && !(_e378)));
    }
    let _e382 = local_10;
    side = _e382;
    let _e383 = none;
    phi_832_ = _e383;
    if !(_e383) {
        let _e386 = split.mixed;
        phi_832_ = !(_e386);
    }
    let _e389 = phi_832_;
    if _e389 {
        let _e390 = pixel_6;
        param_22 = _e390;
        let _e391 = displacement_of((&param_22));
        local_11 = _e391;
    } else {
        let _e393 = split.front;
        local_11 = _e393;
    }
    let _e394 = local_11;
    here_2 = _e394;
    let _e395 = full;
    if _e395 {
        let _e396 = here_2;
        param_23 = _e396;
        let _e397 = pack_full((&param_23));
        local_12 = _e397;
    } else {
        let _e399 = split.front;
        param_24 = _e399;
        let _e401 = split.back;
        param_25 = _e401;
        let _e402 = side;
        param_26 = _e402;
        let _e403 = pack_split((&param_24), (&param_25), (&param_26));
        local_12 = _e403;
    }
    let _e404 = local_12;
    layer = _e404;
    let _e405 = color_1;
    param_27 = _e405;
    let _e406 = front_color_1;
    param_28 = _e406;
    let _e407 = back_color_1;
    param_29 = _e407;
    let _e408 = share_1;
    param_30 = _e408;
    let _e409 = shared_back((&param_27), (&param_28), (&param_29), (&param_30));
    let _e410 = _e409.xyz;
    let _e411 = full;
    let _e412 = share_1;
    back_1 = vec4<f32>(_e410.x, _e410.y, _e410.z, select(_e412, 1f, _e411));
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
