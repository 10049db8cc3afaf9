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
    var phi_336_: bool;
    var phi_344_: bool;

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
            phi_336_ = _e24;
            if _e24 {
                let _e25 = there;
                let _e26 = here;
                phi_336_ = (_e25 >= (_e26 - 2f));
            }
            let _e30 = phi_336_;
            pure = _e30;
            let _e31 = pure;
            phi_344_ = _e31;
            if _e31 {
                let _e32 = there;
                let _e33 = here;
                phi_344_ = (_e32 <= (_e33 + 2f));
            }
            let _e37 = phi_344_;
            pure = _e37;
            continue;
        } else {
            break;
        }
        continuing {
            let _e38 = i;
            i = (_e38 + 1i);
        }
    }
    let _e40 = pure;
    return _e40;
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
    var back_like: bool;
    var shows_back: bool;
    var phi_387_: bool;
    var phi_405_: bool;
    var phi_441_: bool;
    var phi_443_: bool;

    let _e21 = (*pixel_4);
    param_8 = _e21;
    let _e22 = displacement_of((&param_8));
    here_1 = _e22;
    let _e23 = here_1;
    low = _e23;
    let _e24 = here_1;
    high = _e24;
    i_2 = 0i;
    loop {
        let _e25 = i_2;
        if (_e25 < 8i) {
            let _e27 = (*pixel_4);
            let _e28 = i_2;
            indexable_3 = array<vec2<i32>, 8>(vec2<i32>(-1i, 0i), vec2<i32>(1i, 0i), vec2<i32>(0i, -1i), vec2<i32>(0i, 1i), vec2<i32>(-1i, -1i), vec2<i32>(1i, -1i), vec2<i32>(-1i, 1i), vec2<i32>(1i, 1i));
            let _e30 = indexable_3[_e28];
            param_9 = (_e27 + _e30);
            let _e32 = displacement_of((&param_9));
            there_1 = _e32;
            let _e33 = i_2;
            straight = (_e33 < 4i);
            let _e35 = straight;
            phi_387_ = _e35;
            if !(_e35) {
                let _e37 = low;
                let _e38 = here_1;
                phi_387_ = (_e37 >= (_e38 - 2f));
            }
            let _e42 = phi_387_;
            if _e42 {
                let _e43 = low;
                let _e44 = there_1;
                local_2 = min(_e43, _e44);
            } else {
                let _e46 = low;
                local_2 = _e46;
            }
            let _e47 = local_2;
            low = _e47;
            let _e48 = straight;
            phi_405_ = _e48;
            if !(_e48) {
                let _e50 = high;
                let _e51 = here_1;
                phi_405_ = (_e50 <= (_e51 + 2f));
            }
            let _e55 = phi_405_;
            if _e55 {
                let _e56 = high;
                let _e57 = there_1;
                local_3 = max(_e56, _e57);
            } else {
                let _e59 = high;
                local_3 = _e59;
            }
            let _e60 = local_3;
            high = _e60;
            continue;
        } else {
            break;
        }
        continuing {
            let _e61 = i_2;
            i_2 = (_e61 + 1i);
        }
    }
    let _e63 = low;
    let _e64 = here_1;
    front_like = (_e63 < (_e64 - 2f));
    let _e67 = high;
    let _e68 = here_1;
    back_like = (_e67 > (_e68 + 2f));
    let _e71 = back_like;
    phi_443_ = _e71;
    if _e71 {
        let _e72 = front_like;
        phi_441_ = _e72;
        if _e72 {
            let _e73 = here_1;
            let _e74 = low;
            let _e76 = high;
            let _e77 = here_1;
            phi_441_ = ((_e73 - _e74) > (_e76 - _e77));
        }
        let _e81 = phi_441_;
        phi_443_ = !(_e81);
    }
    let _e84 = phi_443_;
    shows_back = _e84;
    let _e85 = front_like;
    let _e86 = back_like;
    let _e88 = shows_back;
    let _e89 = shows_back;
    let _e90 = high;
    let _e91 = here_1;
    let _e93 = shows_back;
    let _e94 = here_1;
    let _e95 = low;
    return Split((_e85 || _e86), _e88, select(_e91, _e90, _e89), select(_e95, _e94, _e93));
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
    var best: vec4<f32>;
    var most: f32;
    var i_4: i32;
    var tap_1: vec4<f32>;
    var param_18: i32;
    var param_19: vec2<i32>;
    var apart: f32;
    var better: bool;
    var param_20: i32;
    var param_21: vec2<i32>;
    var farthest: vec4<f32>;
    var distance_: f32;
    var local_8: f32;
    var i_5: i32;
    var tap_2: vec4<f32>;
    var indexable_4: array<vec2<i32>, 8>;
    var param_22: vec2<i32>;
    var apart_1: f32;
    var better_1: bool;
    var indexable_5: array<vec2<i32>, 8>;
    var param_23: vec2<i32>;
    var contrast: vec3<f32>;
    var prior: f32;
    var share_1: f32;
    var local_9: f32;
    var none: bool;
    var all_: bool;
    var full: bool;
    var side: u32;
    var forward: i32;
    var is_left: bool;
    var is_right: bool;
    var i_6: i32;
    var beside: Split;
    var local_10: i32;
    var param_24: vec2<i32>;
    var param_25: vec2<i32>;
    var goes_on: bool;
    var local_11: u32;
    var here_2: f32;
    var local_12: f32;
    var param_26: vec2<i32>;
    var local_13: u32;
    var param_27: f32;
    var param_28: f32;
    var param_29: f32;
    var param_30: u32;
    var param_31: vec4<f32>;
    var param_32: vec4<f32>;
    var param_33: vec4<f32>;
    var param_34: f32;
    var phi_667_: bool;
    var phi_712_: bool;
    var phi_804_: bool;
    var phi_932_: bool;
    var phi_941_: bool;
    var phi_966_: bool;

    let _e108 = gl_FragCoord_1;
    pixel_6 = vec2<i32>(_e108.xy);
    let _e111 = pixel_6;
    param_12 = _e111;
    let _e112 = color_of((&param_12));
    color_1 = _e112;
    let _e113 = pixel_6;
    param_13 = _e113;
    let _e114 = split_at((&param_13));
    split = _e114;
    front_sum = vec4<f32>(0f, 0f, 0f, 0f);
    back_sum = vec4<f32>(0f, 0f, 0f, 0f);
    front_any = vec4<f32>(0f, 0f, 0f, 0f);
    back_any = vec4<f32>(0f, 0f, 0f, 0f);
    weights = vec4<f32>(0f, 0f, 0f, 0f);
    let _e116 = split.mixed;
    i_3 = select(12i, 0i, _e116);
    loop {
        let _e118 = i_3;
        if (_e118 < 12i) {
            let _e120 = i_3;
            param_14 = _e120;
            let _e121 = tap_at((&param_14));
            offset = _e121;
            let _e122 = pixel_6;
            let _e123 = offset;
            param_15 = (_e122 + _e123);
            let _e125 = displacement_of((&param_15));
            there_2 = _e125;
            let _e127 = offset[0u];
            let _e129 = offset[0u];
            let _e132 = offset[1u];
            let _e134 = offset[1u];
            weight = (4f / f32(((_e127 * _e129) + (_e132 * _e134))));
            let _e139 = there_2;
            let _e141 = split.front;
            let _e145 = weight;
            of_front = select(0f, _e145, (abs((_e139 - _e141)) < 2f));
            let _e147 = there_2;
            let _e149 = split.back;
            let _e153 = weight;
            of_back = select(0f, _e153, (abs((_e147 - _e149)) < 2f));
            let _e155 = pixel_6;
            let _e156 = offset;
            param_16 = (_e155 + _e156);
            let _e158 = color_of((&param_16));
            tap = _e158;
            let _e159 = pixel_6;
            let _e160 = offset;
            param_17 = (_e159 + _e160);
            let _e162 = is_pure((&param_17));
            pure_1 = select(0f, 1f, _e162);
            let _e164 = pure_1;
            let _e165 = of_front;
            let _e167 = tap;
            let _e169 = front_sum;
            front_sum = (_e169 + (_e167 * (_e164 * _e165)));
            let _e171 = pure_1;
            let _e172 = of_back;
            let _e174 = tap;
            let _e176 = back_sum;
            back_sum = (_e176 + (_e174 * (_e171 * _e172)));
            let _e178 = of_front;
            let _e179 = tap;
            let _e181 = front_any;
            front_any = (_e181 + (_e179 * _e178));
            let _e183 = of_back;
            let _e184 = tap;
            let _e186 = back_any;
            back_any = (_e186 + (_e184 * _e183));
            let _e188 = pure_1;
            let _e189 = of_front;
            let _e191 = pure_1;
            let _e192 = of_back;
            let _e194 = of_front;
            let _e195 = of_back;
            let _e197 = weights;
            weights = (_e197 + vec4<f32>((_e188 * _e189), (_e191 * _e192), _e194, _e195));
            continue;
        } else {
            break;
        }
        continuing {
            let _e199 = i_3;
            i_3 = (_e199 + 1i);
        }
    }
    let _e202 = weights[2u];
    if (_e202 > 0f) {
        let _e204 = front_any;
        let _e206 = weights[2u];
        local_4 = (_e204 / vec4(_e206));
    } else {
        let _e209 = color_1;
        local_4 = _e209;
    }
    let _e210 = local_4;
    front_mean = _e210;
    let _e212 = weights[0u];
    if (_e212 > 0f) {
        let _e214 = front_sum;
        let _e216 = weights[0u];
        local_5 = (_e214 / vec4(_e216));
    } else {
        let _e219 = front_mean;
        local_5 = _e219;
    }
    let _e220 = local_5;
    front_color_1 = _e220;
    let _e222 = weights[1u];
    if (_e222 > 0f) {
        let _e224 = back_sum;
        let _e226 = weights[1u];
        local_6 = (_e224 / vec4(_e226));
    } else {
        let _e230 = weights[3u];
        if (_e230 > 0f) {
            let _e232 = back_any;
            let _e234 = weights[3u];
            local_7 = (_e232 / vec4(_e234));
        } else {
            let _e237 = color_1;
            local_7 = _e237;
        }
        let _e238 = local_7;
        local_6 = _e238;
    }
    let _e239 = local_6;
    back_color_1 = _e239;
    let _e240 = back_color_1;
    best = _e240;
    let _e241 = best;
    let _e242 = front_color_1;
    let _e245 = best;
    let _e246 = front_color_1;
    most = dot((_e241 - _e242).xyz, (_e245 - _e246).xyz);
    let _e251 = split.mixed;
    phi_667_ = _e251;
    if _e251 {
        let _e253 = weights[1u];
        phi_667_ = (_e253 == 0f);
    }
    let _e256 = phi_667_;
    i_4 = select(12i, 0i, _e256);
    loop {
        let _e258 = i_4;
        if (_e258 < 12i) {
            let _e260 = pixel_6;
            let _e261 = i_4;
            param_18 = _e261;
            let _e262 = tap_at((&param_18));
            param_19 = (_e260 + _e262);
            let _e264 = color_of((&param_19));
            tap_1 = _e264;
            let _e265 = tap_1;
            let _e266 = front_color_1;
            let _e269 = tap_1;
            let _e270 = front_color_1;
            apart = dot((_e265 - _e266).xyz, (_e269 - _e270).xyz);
            let _e274 = apart;
            let _e275 = most;
            let _e276 = (_e274 > _e275);
            phi_712_ = _e276;
            if _e276 {
                let _e277 = pixel_6;
                let _e278 = i_4;
                param_20 = _e278;
                let _e279 = tap_at((&param_20));
                param_21 = (_e277 + _e279);
                let _e281 = displacement_of((&param_21));
                let _e283 = split.back;
                phi_712_ = (abs((_e281 - _e283)) < 2f);
            }
            let _e288 = phi_712_;
            better = _e288;
            let _e289 = better;
            let _e290 = tap_1;
            let _e291 = best;
            best = select(_e291, _e290, vec4(_e289));
            let _e294 = better;
            let _e295 = apart;
            let _e296 = most;
            most = select(_e296, _e295, _e294);
            continue;
        } else {
            break;
        }
        continuing {
            let _e298 = i_4;
            i_4 = (_e298 + 1i);
        }
    }
    let _e300 = best;
    back_color_1 = _e300;
    let _e302 = weights[0u];
    if (_e302 == 0f) {
        let _e305 = split.shows_back;
        let _e306 = front_mean;
        let _e307 = color_1;
        farthest = select(_e307, _e306, vec4(_e305));
        let _e311 = split.shows_back;
        if _e311 {
            local_8 = 0f;
        } else {
            let _e312 = color_1;
            let _e313 = back_color_1;
            let _e316 = color_1;
            let _e317 = back_color_1;
            local_8 = dot((_e312 - _e313).xyz, (_e316 - _e317).xyz);
        }
        let _e321 = local_8;
        distance_ = _e321;
        let _e323 = split.mixed;
        i_5 = select(8i, 0i, _e323);
        loop {
            let _e325 = i_5;
            if (_e325 < 8i) {
                let _e327 = pixel_6;
                let _e328 = i_5;
                indexable_4 = array<vec2<i32>, 8>(vec2<i32>(-1i, 0i), vec2<i32>(1i, 0i), vec2<i32>(0i, -1i), vec2<i32>(0i, 1i), vec2<i32>(-1i, -1i), vec2<i32>(1i, -1i), vec2<i32>(-1i, 1i), vec2<i32>(1i, 1i));
                let _e330 = indexable_4[_e328];
                param_22 = (_e327 + _e330);
                let _e332 = color_of((&param_22));
                tap_2 = _e332;
                let _e333 = tap_2;
                let _e334 = back_color_1;
                let _e337 = tap_2;
                let _e338 = back_color_1;
                apart_1 = dot((_e333 - _e334).xyz, (_e337 - _e338).xyz);
                let _e342 = apart_1;
                let _e343 = distance_;
                let _e344 = (_e342 > _e343);
                phi_804_ = _e344;
                if _e344 {
                    let _e345 = pixel_6;
                    let _e346 = i_5;
                    indexable_5 = array<vec2<i32>, 8>(vec2<i32>(-1i, 0i), vec2<i32>(1i, 0i), vec2<i32>(0i, -1i), vec2<i32>(0i, 1i), vec2<i32>(-1i, -1i), vec2<i32>(1i, -1i), vec2<i32>(-1i, 1i), vec2<i32>(1i, 1i));
                    let _e348 = indexable_5[_e346];
                    param_23 = (_e345 + _e348);
                    let _e350 = displacement_of((&param_23));
                    let _e352 = split.front;
                    phi_804_ = (abs((_e350 - _e352)) < 2f);
                }
                let _e357 = phi_804_;
                better_1 = _e357;
                let _e358 = better_1;
                let _e359 = tap_2;
                let _e360 = farthest;
                farthest = select(_e360, _e359, vec4(_e358));
                let _e363 = better_1;
                let _e364 = apart_1;
                let _e365 = distance_;
                distance_ = select(_e365, _e364, _e363);
                continue;
            } else {
                break;
            }
            continuing {
                let _e367 = i_5;
                i_5 = (_e367 + 1i);
            }
        }
        let _e369 = farthest;
        front_color_1 = _e369;
    }
    let _e370 = front_color_1;
    let _e371 = back_color_1;
    contrast = (_e370 - _e371).xyz;
    let _e375 = split.shows_back;
    prior = select(0.6f, 0.4f, _e375);
    let _e377 = color_1;
    let _e378 = back_color_1;
    let _e381 = contrast;
    let _e383 = prior;
    let _e386 = contrast;
    let _e387 = contrast;
    share_1 = clamp(((dot((_e377 - _e378).xyz, _e381) + (0.0039369473f * _e383)) / (dot(_e386, _e387) + 0.0039369473f)), 0f, 1f);
    let _e393 = split.shows_back;
    if _e393 {
        let _e394 = share_1;
        local_9 = min(_e394, 0.75f);
    } else {
        let _e396 = share_1;
        local_9 = max(_e396, 0.25f);
    }
    let _e398 = local_9;
    share_1 = _e398;
    let _e400 = split.shows_back;
    let _e401 = share_1;
    none = (_e400 && (_e401 < 0.1f));
    let _e404 = share_1;
    all_ = (_e404 > 0.95f);
    let _e407 = split.mixed;
    let _e409 = none;
    let _e411 = all_;
    full = ((!(_e407) || _e409) || _e411);
    side = 0u;
    let _e414 = synthesis.mirrored;
    forward = select(1i, -1i, (_e414 != 0u));
    is_left = false;
    is_right = false;
    let _e417 = full;
    i_6 = select(0i, 2i, _e417);
    loop {
        let _e419 = i_6;
        if (_e419 < 2i) {
            let _e421 = pixel_6;
            let _e422 = i_6;
            if (_e422 == 0i) {
                let _e424 = forward;
                local_10 = -(_e424);
            } else {
                let _e426 = forward;
                local_10 = _e426;
            }
            let _e427 = local_10;
            param_24 = (_e421 + vec2<i32>(_e427, 0i));
            let _e430 = inside((&param_24));
            param_25 = _e430;
            let _e431 = split_at((&param_25));
            beside = _e431;
            let _e433 = beside.front;
            let _e435 = split.front;
            goes_on = (abs((_e433 - _e435)) < 2f);
            let _e439 = is_left;
            phi_932_ = _e439;
            if !(_e439) {
                let _e441 = i_6;
                let _e443 = goes_on;
                phi_932_ = ((_e441 == 0i) && _e443);
            }
            let _e446 = phi_932_;
            is_left = _e446;
            let _e447 = is_right;
            phi_941_ = _e447;
            if !(_e447) {
                let _e449 = i_6;
                let _e451 = goes_on;
                phi_941_ = ((_e449 == 1i) && _e451);
            }
            let _e454 = phi_941_;
            is_right = _e454;
            continue;
        } else {
            break;
        }
        continuing {
            let _e455 = i_6;
            i_6 = (_e455 + 1i);
        }
    }
    let _e457 = is_left;
    let _e458 = is_right;
    if (_e457 && !(_e458)) {
        local_11 = 1u;
    } else {
        let _e461 = is_right;
        let _e462 = is_left;
        local_11 = select(0u, 2u, (_e461 && !(_e462)));
    }
    let _e466 = local_11;
    side = _e466;
    let _e467 = none;
    phi_966_ = _e467;
    if !(_e467) {
        let _e470 = split.mixed;
        phi_966_ = !(_e470);
    }
    let _e473 = phi_966_;
    if _e473 {
        let _e474 = pixel_6;
        param_26 = _e474;
        let _e475 = displacement_of((&param_26));
        local_12 = _e475;
    } else {
        let _e477 = split.front;
        local_12 = _e477;
    }
    let _e478 = local_12;
    here_2 = _e478;
    let _e479 = full;
    if _e479 {
        let _e480 = here_2;
        param_27 = _e480;
        let _e481 = pack_full((&param_27));
        local_13 = _e481;
    } else {
        let _e483 = split.front;
        param_28 = _e483;
        let _e485 = split.back;
        param_29 = _e485;
        let _e486 = side;
        param_30 = _e486;
        let _e487 = pack_split((&param_28), (&param_29), (&param_30));
        local_13 = _e487;
    }
    let _e488 = local_13;
    layer = _e488;
    let _e489 = color_1;
    param_31 = _e489;
    let _e490 = front_color_1;
    param_32 = _e490;
    let _e491 = back_color_1;
    param_33 = _e491;
    let _e492 = share_1;
    param_34 = _e492;
    let _e493 = shared_back((&param_31), (&param_32), (&param_33), (&param_34));
    let _e494 = _e493.xyz;
    let _e495 = full;
    let _e496 = share_1;
    back_1 = vec4<f32>(_e494.x, _e494.y, _e494.z, select(_e496, 1f, _e495));
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
