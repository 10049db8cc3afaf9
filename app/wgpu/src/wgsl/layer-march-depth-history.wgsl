// Made of yoro's GLSL by `cargo tools wgsl`.
struct Layer {
    front: f32,
    back: f32,
    split: bool,
    mask: vec4<f32>,
}

struct Seen {
    rest: f32,
    column: f32,
    reach: f32,
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

struct History {
    to_history: array<mat4x4<f32>, 8>,
    history_strips: i32,
}

struct Edge {
    column: i32,
    back: bool,
    reach: f32,
    weight: f32,
}

struct FragmentOutput {
    @location(0) member: vec4<f32>,
    @builtin(frag_depth) member_1: f32,
}

@group(0) @binding(7) 
var<uniform> synthesis: Synthesis;
@group(0) @binding(1) 
var color_map_texture: texture_2d<f32>;
@group(0) @binding(9) 
var linear_sampler: sampler;
@group(0) @binding(3) 
var span_map_texture: texture_2d<u32>;
var<private> span_at_1: vec2<f32>;
@group(0) @binding(4) 
var layer_map_texture: texture_2d<u32>;
@group(0) @binding(5) 
var back_map_texture: texture_2d<f32>;
@group(0) @binding(10) 
var history_depth_texture: texture_2d<f32>;
@group(0) @binding(12) 
var<uniform> history: History;
@group(0) @binding(11) 
var history_color_texture: texture_2d<f32>;
var<private> gl_FragCoord_1: vec4<f32>;
var<private> color_1: vec4<f32>;
var<private> gl_FragDepth: f32 = 0f;

fn reach() -> f32 {
    let _e3 = synthesis.near_displacement;
    let _e5 = synthesis.far_displacement;
    return max((_e3 - _e5), 0.000001f);
}

fn split_displacements(layer: ptr<function, u32>) -> vec2<f32> {
    let _e4 = (*layer);
    let _e5 = (*layer);
    let _e12 = reach();
    return (vec2<f32>((vec2<u32>(_e4, (_e5 >> bitcast<u32>(14i))) & vec2(16383u))) * (_e12 / 16383f));
}

fn full_front(layer_1: ptr<function, u32>) -> f32 {
    let _e3 = (*layer_1);
    let _e6 = reach();
    return (f32((_e3 & 268435455u)) * (_e6 / 268435440f));
}

fn is_full(layer_2: ptr<function, u32>) -> bool {
    let _e3 = (*layer_2);
    return ((_e3 >> bitcast<u32>(28i)) == 15u);
}

fn far_nearness() -> f32 {
    let _e3 = synthesis.far_displacement;
    let _e6 = synthesis.law[0u];
    return (_e3 - _e6);
}

fn layer_bits(column: ptr<function, i32>, row: ptr<function, i32>) -> u32 {
    let _e4 = (*column);
    let _e5 = (*row);
    let _e7 = textureLoad(layer_map_texture, vec2<i32>(_e4, _e5), 0i);
    return _e7.x;
}

fn source_column(x: ptr<function, i32>) -> i32 {
    var local: i32;

    let _e6 = synthesis.mirrored;
    if (_e6 != 0u) {
        let _e10 = synthesis.source_size[0u];
        let _e12 = (*x);
        local = ((_e10 - 1i) - _e12);
    } else {
        let _e14 = (*x);
        local = _e14;
    }
    let _e15 = local;
    return _e15;
}

fn nearness_at(x_1: ptr<function, i32>, row_1: ptr<function, i32>) -> f32 {
    var bits: u32;
    var param: i32;
    var param_1: i32;
    var param_2: i32;
    var param_3: u32;
    var local_1: f32;
    var param_4: u32;
    var param_5: u32;

    let _e10 = (*x_1);
    param = _e10;
    let _e11 = source_column((&param));
    param_1 = _e11;
    let _e12 = (*row_1);
    param_2 = _e12;
    let _e13 = layer_bits((&param_1), (&param_2));
    bits = _e13;
    let _e14 = far_nearness();
    let _e15 = bits;
    param_3 = _e15;
    let _e16 = is_full((&param_3));
    if _e16 {
        let _e17 = bits;
        param_4 = _e17;
        let _e18 = full_front((&param_4));
        local_1 = _e18;
    } else {
        let _e19 = bits;
        param_5 = _e19;
        let _e20 = split_displacements((&param_5));
        local_1 = _e20.x;
    }
    let _e22 = local_1;
    return (_e14 + _e22);
}

fn recall(pixel: ptr<function, vec2<f32>>, front: ptr<function, f32>, origin: ptr<function, f32>, row_2: ptr<function, i32>, color: ptr<function, vec4<f32>>, depth: ptr<function, f32>) -> bool {
    var size: vec2<f32>;
    var scale: vec2<f32>;
    var rows: f32;
    var guess: vec2<f32>;
    var i: i32;
    var strip: i32;
    var seen: vec4<f32>;
    var local_2: vec2<f32>;
    var inside: bool;
    var stored: f32;
    var along: vec4<f32>;
    var farther: f32;
    var place: vec2<f32>;
    var here: f32;
    var nearness: f32;
    var last: f32;
    var column_1: f32;
    var outside: bool;
    var x_2: i32;
    var before: f32;
    var param_6: i32;
    var param_7: i32;
    var param_8: i32;
    var param_9: i32;
    var same: bool;
    var behind: bool;
    var hidden: bool;
    var least: vec2<f32>;
    var most: vec2<f32>;
    var corner: vec2<i32>;
    var whole: bool;
    var i_1: i32;
    var texel: vec2<i32>;
    var local_3: vec2<f32>;
    var phi_495_: bool;
    var phi_510_: bool;
    var phi_638_: bool;
    var phi_717_: bool;

    let _e60 = textureDimensions(history_depth_texture, 0i);
    size = vec2<f32>(vec2<i32>(_e60));
    let _e63 = size;
    let _e65 = synthesis.target_size;
    scale = (_e63 / vec2<f32>(_e65));
    let _e69 = size[1u];
    let _e72 = history.history_strips;
    let _e76 = history.history_strips;
    rows = f32((((i32(_e69) + _e72) - 1i) / _e76));
    let _e79 = (*pixel);
    let _e80 = scale;
    guess = (_e79 * _e80);
    i = 0i;
    loop {
        let _e82 = i;
        if (_e82 < 2i) {
            let _e85 = guess[1u];
            let _e86 = rows;
            let _e89 = history.history_strips;
            strip = i32(clamp((_e85 / _e86), 0f, f32((_e89 - 1i))));
            let _e94 = strip;
            let _e97 = history.to_history[_e94];
            let _e98 = (*pixel);
            let _e99 = (*depth);
            seen = (_e97 * vec4<f32>(_e98.x, _e98.y, _e99, 1f));
            let _e105 = seen[3u];
            if (_e105 > 0f) {
                let _e107 = seen;
                let _e110 = seen[3u];
                local_2 = (_e107.xy / vec2(_e110));
            } else {
                let _e113 = guess;
                local_2 = _e113;
            }
            let _e114 = local_2;
            guess = _e114;
            continue;
        } else {
            break;
        }
        continuing {
            let _e115 = i;
            i = (_e115 + 1i);
        }
    }
    let _e117 = guess;
    let _e119 = all((_e117 >= vec2<f32>(0f, 0f)));
    phi_495_ = _e119;
    if _e119 {
        let _e120 = guess;
        let _e121 = size;
        phi_495_ = all((_e120 < _e121));
    }
    let _e125 = phi_495_;
    inside = _e125;
    let _e127 = seen[3u];
    let _e129 = inside;
    let _e130 = ((_e127 > 0f) && _e129);
    phi_510_ = _e130;
    if _e130 {
        let _e132 = guess[1u];
        let _e133 = rows;
        let _e136 = strip;
        phi_510_ = (i32((_e132 / _e133)) == _e136);
    }
    let _e139 = phi_510_;
    if !(_e139) {
        return false;
    }
    let _e141 = guess;
    let _e143 = textureLoad(history_depth_texture, vec2<i32>(_e141), 0i);
    stored = _e143.x;
    let _e145 = strip;
    let _e149 = history.to_history[_e145][2];
    along = _e149;
    let _e150 = stored;
    let _e152 = seen[3u];
    let _e155 = seen[2u];
    let _e158 = along[2u];
    let _e159 = stored;
    let _e161 = along[3u];
    farther = (((_e150 * _e152) - _e155) / (_e158 - (_e159 * _e161)));
    let _e165 = farther;
    let _e166 = along;
    let _e168 = seen;
    seen = (_e168 + (_e166 * _e165));
    let _e170 = seen;
    let _e173 = seen[3u];
    place = (_e170.xy / vec2(_e173));
    let _e176 = (*depth);
    let _e177 = farther;
    here = (_e176 + _e177);
    let _e181 = synthesis.law[1u];
    let _e182 = here;
    nearness = (_e181 * _e182);
    let _e186 = synthesis.source_size[0u];
    last = f32((_e186 - 1i));
    let _e189 = (*origin);
    let _e190 = nearness;
    column_1 = floor((_e189 - _e190));
    let _e193 = column_1;
    let _e195 = column_1;
    let _e196 = last;
    outside = !(((_e193 >= 0f) && (_e195 < _e196)));
    let _e200 = column_1;
    let _e201 = last;
    x_2 = i32(clamp(_e200, 0f, max((_e201 - 1f), 0f)));
    let _e206 = x_2;
    param_6 = _e206;
    let _e207 = (*row_2);
    param_7 = _e207;
    let _e208 = nearness_at((&param_6), (&param_7));
    let _e209 = x_2;
    let _e213 = synthesis.source_size[0u];
    param_8 = min((_e209 + 1i), (_e213 - 1i));
    let _e216 = (*row_2);
    param_9 = _e216;
    let _e217 = nearness_at((&param_8), (&param_9));
    before = max(_e208, _e217);
    let _e219 = place;
    let _e220 = guess;
    let _e222 = scale;
    same = (length(((_e219 - _e220) / _e222)) < 1f);
    let _e226 = nearness;
    let _e227 = (*front);
    let _e228 = (*front);
    let _e231 = synthesis.law[1u];
    let _e232 = (*depth);
    behind = (_e226 <= (_e227 - (0.25f * (_e228 - (_e231 * _e232)))));
    let _e238 = outside;
    phi_638_ = _e238;
    if !(_e238) {
        let _e240 = before;
        let _e241 = nearness;
        phi_638_ = (_e240 > (_e241 - 1f));
    }
    let _e245 = phi_638_;
    hidden = _e245;
    let _e246 = same;
    let _e247 = behind;
    let _e249 = hidden;
    if !(((_e246 && _e247) && _e249)) {
        return false;
    }
    let _e252 = strip;
    let _e254 = rows;
    least = vec2<f32>(0.5f, ((f32(_e252) * _e254) + 0.5f));
    let _e259 = size[0u];
    let _e260 = strip;
    let _e263 = rows;
    let _e266 = size[1u];
    most = (vec2<f32>(_e259, min((f32((_e260 + 1i)) * _e263), _e266)) - vec2(0.5f));
    let _e271 = place;
    let _e272 = least;
    let _e273 = most;
    place = clamp(_e271, _e272, _e273);
    let _e275 = place;
    corner = vec2<i32>((_e275 - vec2(0.5f)));
    whole = true;
    i_1 = 0i;
    loop {
        let _e279 = i_1;
        if (_e279 < 4i) {
            let _e281 = corner;
            let _e282 = i_1;
            let _e284 = i_1;
            let _e289 = most;
            texel = min((_e281 + vec2<i32>((_e282 & 1i), (_e284 >> bitcast<u32>(1i)))), vec2<i32>(_e289));
            let _e292 = whole;
            phi_717_ = _e292;
            if _e292 {
                let _e295 = synthesis.law[1u];
                let _e296 = texel;
                let _e297 = textureLoad(history_depth_texture, _e296, 0i);
                let _e299 = stored;
                phi_717_ = (abs((_e295 * (_e297.x - _e299))) < 1f);
            }
            let _e305 = phi_717_;
            whole = _e305;
            continue;
        } else {
            break;
        }
        continuing {
            let _e306 = i_1;
            i_1 = (_e306 + 1i);
        }
    }
    let _e308 = whole;
    if _e308 {
        let _e309 = place;
        local_3 = _e309;
    } else {
        let _e310 = guess;
        local_3 = (floor(_e310) + vec2(0.5f));
    }
    let _e314 = local_3;
    let _e315 = size;
    let _e317 = textureSampleLevel(history_color_texture, linear_sampler, (_e314 / _e315), 0f);
    (*color) = _e317;
    let _e318 = here;
    (*depth) = _e318;
    return true;
}

fn in_image(pixel_1: ptr<function, vec2<i32>>) -> vec2<i32> {
    var local_4: vec2<i32>;

    if true {
        let _e5 = synthesis.source_origin;
        let _e6 = (*pixel_1);
        local_4 = (_e5 + _e6);
    } else {
        let _e8 = (*pixel_1);
        local_4 = _e8;
    }
    let _e9 = local_4;
    return _e9;
}

fn weighted(column_2: ptr<function, i32>, row_3: ptr<function, i32>, of_front: ptr<function, f32>, of_back: ptr<function, f32>) -> vec4<f32> {
    var mixture: vec4<f32>;
    var param_10: vec2<i32>;
    var behind_1: vec4<f32>;
    var share: f32;
    var front_1: vec4<f32>;
    var local_5: vec4<f32>;

    let _e17 = (*column_2);
    let _e18 = (*row_3);
    param_10 = vec2<i32>(_e17, _e18);
    let _e20 = in_image((&param_10));
    let _e21 = textureLoad(color_map_texture, _e20, 0i);
    mixture = _e21;
    let _e22 = (*column_2);
    let _e23 = (*row_3);
    let _e25 = textureLoad(back_map_texture, vec2<i32>(_e22, _e23), 0i);
    behind_1 = _e25;
    let _e27 = behind_1[3u];
    share = _e27;
    let _e29 = mixture[3u];
    behind_1[3u] = _e29;
    let _e31 = share;
    if (_e31 < 1f) {
        let _e33 = mixture;
        let _e34 = share;
        let _e36 = behind_1;
        let _e39 = share;
        local_5 = clamp(((_e33 - (_e36 * (1f - _e34))) / vec4(max(_e39, 0.01f))), vec4(0f), vec4(1f));
    } else {
        let _e46 = mixture;
        local_5 = _e46;
    }
    let _e47 = local_5;
    front_1 = _e47;
    let _e48 = (*of_front);
    let _e49 = front_1;
    let _e51 = (*of_back);
    let _e52 = behind_1;
    return ((_e49 * _e48) + (_e52 * _e51));
}

fn covered(mask: ptr<function, vec4<f32>>, stripes: ptr<function, vec4<f32>>) -> f32 {
    let _e3 = (*mask);
    let _e4 = (*stripes);
    return (0.25f * dot(_e3, _e4));
}

fn right_of(place_1: ptr<function, f32>) -> vec4<f32> {
    let _e5 = (*place_1);
    return clamp((vec4<f32>(1f, 2f, 3f, 4f) - vec4((4f * _e5))), vec4(0f), vec4(1f));
}

fn layer_at(column_3: ptr<function, i32>, row_4: ptr<function, i32>) -> Layer {
    var bits_1: u32;
    var param_11: i32;
    var param_12: i32;
    var param_13: u32;
    var param_14: u32;
    var both: vec2<f32>;
    var param_15: u32;
    var code: u32;
    var share_1: f32;
    var mask_1: vec4<f32>;
    var local_6: vec4<f32>;
    var local_7: vec4<f32>;

    let _e29 = (*column_3);
    param_11 = _e29;
    let _e30 = (*row_4);
    param_12 = _e30;
    let _e31 = layer_bits((&param_11), (&param_12));
    bits_1 = _e31;
    let _e32 = bits_1;
    param_13 = _e32;
    let _e33 = is_full((&param_13));
    if _e33 {
        let _e34 = bits_1;
        param_14 = _e34;
        let _e35 = full_front((&param_14));
        return Layer(_e35, 1000000000f, false, vec4<f32>(1f, 1f, 1f, 1f));
    }
    let _e37 = bits_1;
    param_15 = _e37;
    let _e38 = split_displacements((&param_15));
    both = _e38;
    let _e39 = bits_1;
    code = (_e39 >> bitcast<u32>(28i));
    let _e42 = (*column_3);
    let _e43 = (*row_4);
    let _e45 = textureLoad(back_map_texture, vec2<i32>(_e42, _e43), 0i);
    share_1 = _e45.w;
    let _e47 = code;
    if (_e47 == 1u) {
        let _e49 = share_1;
        local_6 = clamp((vec4((4f * _e49)) - vec4<f32>(0f, 1f, 2f, 3f)), vec4(0f), vec4(1f));
    } else {
        let _e56 = code;
        if (_e56 == 2u) {
            let _e58 = share_1;
            local_7 = clamp((vec4((4f * _e58)) - vec4<f32>(3f, 2f, 1f, 0f)), vec4(0f), vec4(1f));
        } else {
            let _e65 = share_1;
            local_7 = vec4(_e65);
        }
        let _e67 = local_7;
        local_6 = _e67;
    }
    let _e68 = local_6;
    mask_1 = _e68;
    let _e70 = both[0u];
    let _e72 = both[1u];
    let _e73 = mask_1;
    return Layer(_e70, _e72, true, _e73);
}

fn color_texel(x_3: ptr<function, i32>, row_5: ptr<function, i32>) -> vec4<f32> {
    var param_16: i32;
    var param_17: vec2<i32>;

    let _e6 = (*x_3);
    param_16 = _e6;
    let _e7 = source_column((&param_16));
    let _e8 = (*row_5);
    param_17 = vec2<i32>(_e7, _e8);
    let _e10 = in_image((&param_17));
    let _e11 = textureLoad(color_map_texture, _e10, 0i);
    return _e11;
}

fn sharp_color_at(x_4: ptr<function, f32>, row_6: ptr<function, i32>) -> vec4<f32> {
    var last_1: i32;
    var column_4: i32;
    var f: f32;
    var here_1: vec4<f32>;
    var param_18: i32;
    var param_19: i32;
    var next: vec4<f32>;
    var param_20: i32;
    var param_21: i32;
    var apart: vec4<f32>;
    var outer: vec2<f32>;
    var inner: f32;
    var sum: vec4<f32>;
    var param_22: i32;
    var param_23: i32;
    var param_24: i32;
    var param_25: i32;

    let _e33 = synthesis.source_size[0u];
    last_1 = (_e33 - 1i);
    let _e35 = (*x_4);
    column_4 = i32(_e35);
    let _e37 = (*x_4);
    let _e38 = column_4;
    f = (_e37 - f32(_e38));
    let _e41 = column_4;
    param_18 = _e41;
    let _e42 = (*row_6);
    param_19 = _e42;
    let _e43 = color_texel((&param_18), (&param_19));
    here_1 = _e43;
    let _e44 = column_4;
    let _e46 = last_1;
    param_20 = min((_e44 + 1i), _e46);
    let _e48 = (*row_6);
    param_21 = _e48;
    let _e49 = color_texel((&param_20), (&param_21));
    next = _e49;
    let _e50 = next;
    let _e51 = here_1;
    apart = abs((_e50 - _e51));
    let _e55 = apart[0u];
    let _e57 = apart[1u];
    let _e59 = apart[2u];
    if (max(_e55, max(_e57, _e59)) <= 0.03137255f) {
        let _e63 = here_1;
        let _e64 = next;
        let _e65 = f;
        return mix(_e63, _e64, vec4(_e65));
    }
    let _e68 = f;
    let _e70 = f;
    let _e73 = f;
    let _e75 = f;
    outer = (vec2<f32>((1f - _e73), _e75) * ((-0.75f * _e68) * (1f - _e70)));
    let _e78 = f;
    let _e81 = f;
    let _e83 = f;
    inner = (((((1.25f * _e78) - 2.25f) * _e81) * _e83) + 1f);
    let _e87 = outer[0u];
    let _e88 = column_4;
    param_22 = max((_e88 - 1i), 0i);
    let _e91 = (*row_6);
    param_23 = _e91;
    let _e92 = color_texel((&param_22), (&param_23));
    let _e95 = outer[1u];
    let _e96 = column_4;
    let _e98 = last_1;
    param_24 = min((_e96 + 2i), _e98);
    let _e100 = (*row_6);
    param_25 = _e100;
    let _e101 = color_texel((&param_24), (&param_25));
    let _e104 = inner;
    let _e105 = here_1;
    let _e108 = inner;
    let _e111 = outer[0u];
    let _e114 = outer[1u];
    let _e116 = next;
    sum = ((((_e92 * _e87) + (_e101 * _e95)) + (_e105 * _e104)) + (_e116 * (((1f - _e108) - _e111) - _e114)));
    let _e119 = sum;
    let _e120 = here_1;
    let _e121 = next;
    let _e123 = here_1;
    let _e124 = next;
    return clamp(_e119, min(_e120, _e121), max(_e123, _e124));
}

fn cover(seen_1: ptr<function, Seen>, share_2: ptr<function, f32>, column_5: ptr<function, f32>, reach_1: ptr<function, f32>) -> f32 {
    var taken: f32;
    var passes: bool;
    var local_8: f32;
    var local_9: f32;
    var phi_952_: bool;

    let _e10 = (*seen_1).rest;
    let _e11 = (*share_2);
    taken = (_e10 * _e11);
    let _e14 = (*seen_1).rest;
    let _e15 = (_e14 > 0.5f);
    phi_952_ = _e15;
    if _e15 {
        let _e17 = (*seen_1).rest;
        let _e18 = taken;
        phi_952_ = ((_e17 - _e18) <= 0.5f);
    }
    let _e22 = phi_952_;
    passes = _e22;
    let _e23 = passes;
    if _e23 {
        let _e24 = (*column_5);
        local_8 = _e24;
    } else {
        let _e26 = (*seen_1).column;
        local_8 = _e26;
    }
    let _e27 = local_8;
    (*seen_1).column = _e27;
    let _e29 = passes;
    if _e29 {
        let _e30 = (*reach_1);
        local_9 = _e30;
    } else {
        let _e32 = (*seen_1).reach;
        local_9 = _e32;
    }
    let _e33 = local_9;
    (*seen_1).reach = _e33;
    let _e35 = taken;
    let _e37 = (*seen_1).rest;
    (*seen_1).rest = (_e37 - _e35);
    let _e40 = taken;
    return _e40;
}

fn span_steps(span: ptr<function, u32>) -> f32 {
    var steps: u32;
    var local_10: f32;

    let _e5 = (*span);
    steps = (_e5 & 1023u);
    let _e7 = steps;
    if (_e7 == 1023u) {
        local_10 = 1000000000f;
    } else {
        let _e9 = steps;
        local_10 = f32(_e9);
    }
    let _e11 = local_10;
    return _e11;
}

fn pixel_span() -> vec4<u32> {
    var last_2: vec2<i32>;

    if true {
        let _e14 = synthesis.target_size[0u];
        let _e17 = synthesis.source_size[1u];
        last_2 = ((vec2<i32>(_e14, _e17) - vec2(1i)) / vec2<i32>(16i, 8i));
        let _e22 = span_at_1;
        let _e24 = last_2;
        let _e26 = textureLoad(span_map_texture, clamp(vec2<i32>(_e22), vec2<i32>(0i, 0i), _e24), 0i);
        return _e26;
    }
    return vec4<u32>(0u, 0u, 0u, 0u);
}

fn main_1() {
    var last_3: f32;
    var row_7: i32;
    var t: f32;
    var span_1: u32;
    var x_5: f32;
    var limit: f32;
    var param_26: u32;
    var sense: i32;
    var column_6: i32;
    var param_27: i32;
    var seen_2: Seen;
    var bits_2: u32;
    var param_28: i32;
    var param_29: i32;
    var front_2: f32;
    var param_30: u32;
    var at: f32;
    var plain: bool;
    var param_31: u32;
    var param_32: i32;
    var param_33: i32;
    var following: f32;
    var param_34: u32;
    var param_35: u32;
    var then: f32;
    var g: f32;
    var param_36: Seen;
    var param_37: f32;
    var param_38: f32;
    var param_39: f32;
    var param_40: f32;
    var param_41: i32;
    var here_2: Layer;
    var param_42: i32;
    var param_43: i32;
    var edge: Edge;
    var second: Edge;
    var beside: f32;
    var on_front: bool;
    var on_back: bool;
    var before_1: Layer;
    var param_44: i32;
    var param_45: i32;
    var idle: bool;
    var landed: f32;
    var ahead: u32;
    var param_46: i32;
    var param_47: i32;
    var following_1: f32;
    var param_48: u32;
    var then_1: f32;
    var param_49: u32;
    var next_1: Layer;
    var param_50: i32;
    var param_51: i32;
    var a: f32;
    var b: f32;
    var c: f32;
    var d: f32;
    var front_front: bool;
    var front_back: bool;
    var back_front: bool;
    var back_back: bool;
    var fronts: vec2<f32>;
    var backs: vec2<f32>;
    var g_1: f32;
    var right: vec4<f32>;
    var param_52: f32;
    var shares: vec2<f32>;
    var param_53: vec4<f32>;
    var param_54: vec4<f32>;
    var param_55: vec4<f32>;
    var param_56: vec4<f32>;
    var share_3: f32;
    var param_57: Seen;
    var param_58: f32;
    var param_59: f32;
    var param_60: f32;
    var share_4: f32;
    var param_61: f32;
    var param_62: vec4<f32>;
    var param_63: vec4<f32>;
    var param_64: Seen;
    var param_65: f32;
    var param_66: f32;
    var param_67: f32;
    var param_68: f32;
    var param_69: vec4<f32>;
    var param_70: vec4<f32>;
    var param_71: Seen;
    var param_72: f32;
    var param_73: f32;
    var param_74: f32;
    var g_2: f32;
    var taken_1: f32;
    var param_75: Seen;
    var param_76: f32;
    var param_77: f32;
    var param_78: f32;
    var g_3: f32;
    var taken_2: f32;
    var param_79: Seen;
    var param_80: f32;
    var param_81: f32;
    var param_82: f32;
    var g_4: f32;
    var taken_3: f32;
    var param_83: Seen;
    var param_84: f32;
    var param_85: f32;
    var param_86: f32;
    var ends: bool;
    var stripes_1: vec4<f32>;
    var local_11: vec4<f32>;
    var param_87: f32;
    var param_88: f32;
    var param_89: vec4<f32>;
    var param_90: vec4<f32>;
    var param_91: Seen;
    var param_92: f32;
    var param_93: f32;
    var param_94: f32;
    var at_back: bool;
    var at_front: bool;
    var reach_2: f32;
    var local_12: f32;
    var away: f32;
    var local_13: f32;
    var weight: f32;
    var local_14: f32;
    var param_95: vec4<f32>;
    var param_96: vec4<f32>;
    var found: Edge;
    var taken_4: f32;
    var param_97: Seen;
    var param_98: f32;
    var param_99: f32;
    var param_100: f32;
    var param_101: i32;
    var param_102: i32;
    var param_103: f32;
    var param_104: f32;
    var param_105: i32;
    var param_106: i32;
    var param_107: f32;
    var param_108: f32;
    var hole: bool;
    var beyond: bool;
    var local_15: f32;
    var edge_x: f32;
    var param_109: i32;
    var away_1: f32;
    var spread: f32;
    var sum_1: vec4<f32>;
    var weights: f32;
    var rows_1: i32;
    var i_2: i32;
    var at_1: i32;
    var layer_3: Layer;
    var param_110: i32;
    var param_111: i32;
    var front_3: bool;
    var local_16: bool;
    var behind_2: bool;
    var local_17: bool;
    var weight_1: f32;
    var local_18: f32;
    var local_19: f32;
    var local_20: f32;
    var param_112: vec4<f32>;
    var param_113: vec4<f32>;
    var param_114: i32;
    var param_115: i32;
    var param_116: f32;
    var param_117: f32;
    var fill: vec4<f32>;
    var one: vec2<f32>;
    var param_118: i32;
    var param_119: i32;
    var param_120: f32;
    var param_121: f32;
    var depth_1: f32;
    var origin_1: f32;
    var param_122: vec2<f32>;
    var param_123: f32;
    var param_124: f32;
    var param_125: i32;
    var param_126: vec4<f32>;
    var param_127: f32;
    var param_128: Seen;
    var param_129: f32;
    var param_130: f32;
    var param_131: f32;
    var phi_1109_: bool;
    var phi_1204_: bool;
    var phi_1211_: bool;
    var phi_1230_: bool;
    var phi_1259_: bool;
    var phi_1273_: bool;
    var phi_1325_: bool;
    var phi_1333_: bool;
    var phi_1409_: bool;
    var phi_1422_: bool;
    var phi_1438_: bool;
    var phi_1518_: bool;
    var phi_1570_: bool;
    var phi_1618_: bool;
    var phi_1668_: bool;
    var phi_1718_: bool;
    var phi_1770_: bool;
    var phi_1776_: bool;
    var phi_1828_: bool;
    var phi_1849_: bool;
    var phi_1861_: bool;
    var phi_2141_: bool;
    var phi_2203_: bool;
    var phi_2278_: bool;

    let _e224 = synthesis.source_size[0u];
    last_3 = f32((_e224 - 1i));
    let _e228 = gl_FragCoord_1[1u];
    let _e230 = synthesis.first_row;
    let _e234 = synthesis.source_size[1u];
    row_7 = i32(clamp((_e228 - _e230), 0f, f32((_e234 - 1i))));
    let _e241 = synthesis.origins[0u];
    let _e243 = gl_FragCoord_1[0u];
    let _e247 = synthesis.origins[1u];
    let _e250 = synthesis.farthest;
    t = ((((_e241 * _e243) + _e247) - _e250) + 0.01f);
    let _e253 = pixel_span();
    span_1 = _e253.x;
    let _e255 = t;
    let _e256 = span_1;
    let _e261 = last_3;
    x_5 = clamp(floor(((_e255 - bitcast<f32>(_e256)) - 1.01f)), 0f, _e261);
    let _e263 = x_5;
    let _e264 = span_1;
    param_26 = _e264;
    let _e265 = span_steps((&param_26));
    let _e268 = last_3;
    limit = min(((_e263 + _e265) + 2f), _e268);
    let _e271 = synthesis.mirrored;
    sense = select(1i, -1i, (_e271 != 0u));
    let _e274 = x_5;
    param_27 = i32(_e274);
    let _e276 = source_column((&param_27));
    column_6 = _e276;
    seen_2 = Seen(1f, 0f, 0f);
    color_1 = vec4<f32>(0f, 0f, 0f, 0f);
    let _e277 = column_6;
    param_28 = _e277;
    let _e278 = row_7;
    param_29 = _e278;
    let _e279 = layer_bits((&param_28), (&param_29));
    bits_2 = _e279;
    let _e280 = bits_2;
    param_30 = _e280;
    let _e281 = full_front((&param_30));
    front_2 = _e281;
    let _e282 = x_5;
    let _e283 = front_2;
    let _e285 = t;
    at = ((_e282 + _e283) - _e285);
    let _e287 = bits_2;
    param_31 = _e287;
    let _e288 = is_full((&param_31));
    let _e289 = at;
    plain = (_e288 && (_e289 <= 0f));
    loop {
        let _e292 = plain;
        let _e293 = x_5;
        let _e294 = limit;
        if (_e292 && (_e293 < _e294)) {
            let _e297 = column_6;
            let _e298 = sense;
            param_32 = (_e297 + _e298);
            let _e300 = row_7;
            param_33 = _e300;
            let _e301 = layer_bits((&param_32), (&param_33));
            bits_2 = _e301;
            let _e302 = bits_2;
            param_34 = _e302;
            let _e303 = full_front((&param_34));
            following = _e303;
            let _e304 = bits_2;
            param_35 = _e304;
            let _e305 = is_full((&param_35));
            phi_1109_ = _e305;
            if _e305 {
                let _e306 = following;
                let _e307 = front_2;
                phi_1109_ = (abs((_e306 - _e307)) < 0.5f);
            }
            let _e312 = phi_1109_;
            plain = _e312;
            let _e313 = x_5;
            let _e315 = following;
            let _e317 = t;
            then = (((_e313 + 1f) + _e315) - _e317);
            let _e319 = plain;
            let _e320 = then;
            if (_e319 && (_e320 > 0f)) {
                let _e323 = at;
                let _e325 = then;
                let _e326 = at;
                g = (-(_e323) / (_e325 - _e326));
                let _e329 = x_5;
                let _e330 = g;
                let _e332 = front_2;
                let _e333 = following;
                let _e334 = g;
                let _e336 = seen_2;
                param_36 = _e336;
                param_37 = 1f;
                param_38 = (_e329 + _e330);
                param_39 = mix(_e332, _e333, _e334);
                let _e337 = cover((&param_36), (&param_37), (&param_38), (&param_39));
                let _e338 = param_36;
                seen_2 = _e338;
                let _e339 = x_5;
                limit = _e339;
            } else {
                let _e340 = plain;
                if _e340 {
                    let _e341 = x_5;
                    x_5 = (_e341 + 1f);
                    let _e343 = sense;
                    let _e344 = column_6;
                    column_6 = (_e344 + _e343);
                    let _e346 = following;
                    front_2 = _e346;
                    let _e347 = then;
                    at = _e347;
                }
            }
            continue;
        } else {
            break;
        }
    }
    let _e349 = seen_2.rest;
    if (_e349 < 0.01f) {
        let _e352 = seen_2.column;
        param_40 = _e352;
        let _e353 = row_7;
        param_41 = _e353;
        let _e354 = sharp_color_at((&param_40), (&param_41));
        color_1 = _e354;
    }
    let _e355 = column_6;
    param_42 = _e355;
    let _e356 = row_7;
    param_43 = _e356;
    let _e357 = layer_at((&param_42), (&param_43));
    here_2 = _e357;
    edge = Edge(-1i, false, 1000000000f, 1f);
    let _e358 = edge;
    second = _e358;
    beside = 1000000000f;
    let _e359 = x_5;
    if (_e359 == 0f) {
        let _e362 = here_2.front;
        let _e363 = t;
        if (_e362 > _e363) {
            let _e365 = column_6;
            let _e367 = here_2.front;
            edge = Edge(_e365, false, _e367, 1f);
        }
        let _e370 = here_2.split;
        phi_1204_ = _e370;
        if _e370 {
            let _e372 = here_2.back;
            let _e374 = edge.reach;
            phi_1204_ = (_e372 < _e374);
        }
        let _e377 = phi_1204_;
        phi_1211_ = _e377;
        if _e377 {
            let _e379 = here_2.back;
            let _e380 = t;
            phi_1211_ = (_e379 > _e380);
        }
        let _e383 = phi_1211_;
        if _e383 {
            let _e384 = column_6;
            let _e386 = here_2.back;
            edge = Edge(_e384, true, _e386, 1f);
        }
    }
    on_front = false;
    on_back = false;
    let _e388 = x_5;
    let _e391 = here_2.split;
    let _e392 = ((_e388 > 0f) && _e391);
    phi_1230_ = _e392;
    if _e392 {
        let _e394 = seen_2.rest;
        phi_1230_ = (_e394 > 0.01f);
    }
    let _e397 = phi_1230_;
    if _e397 {
        let _e398 = column_6;
        let _e399 = sense;
        param_44 = (_e398 - _e399);
        let _e401 = row_7;
        param_45 = _e401;
        let _e402 = layer_at((&param_44), (&param_45));
        before_1 = _e402;
        let _e404 = before_1.front;
        let _e406 = here_2.back;
        on_front = (abs((_e404 - _e406)) < 0.5f);
        let _e411 = before_1.split;
        phi_1259_ = _e411;
        if _e411 {
            let _e413 = before_1.back;
            let _e415 = here_2.back;
            phi_1259_ = (abs((_e413 - _e415)) < 0.5f);
        }
        let _e420 = phi_1259_;
        on_back = _e420;
    }
    loop {
        let _e421 = x_5;
        let _e422 = limit;
        let _e423 = (_e421 < _e422);
        phi_1273_ = _e423;
        if _e423 {
            let _e425 = seen_2.rest;
            phi_1273_ = (_e425 > 0.01f);
        }
        let _e428 = phi_1273_;
        if _e428 {
            let _e430 = here_2.split;
            idle = !(_e430);
            let _e432 = x_5;
            let _e434 = here_2.front;
            let _e436 = t;
            landed = ((_e432 + _e434) - _e436);
            loop {
                let _e438 = idle;
                let _e439 = x_5;
                let _e440 = limit;
                if (_e438 && (_e439 < _e440)) {
                    let _e443 = column_6;
                    let _e444 = sense;
                    param_46 = (_e443 + _e444);
                    let _e446 = row_7;
                    param_47 = _e446;
                    let _e447 = layer_bits((&param_46), (&param_47));
                    ahead = _e447;
                    let _e448 = ahead;
                    param_48 = _e448;
                    let _e449 = full_front((&param_48));
                    following_1 = _e449;
                    let _e450 = x_5;
                    let _e452 = following_1;
                    let _e454 = t;
                    then_1 = (((_e450 + 1f) + _e452) - _e454);
                    let _e456 = ahead;
                    param_49 = _e456;
                    let _e457 = is_full((&param_49));
                    phi_1325_ = _e457;
                    if _e457 {
                        let _e458 = following_1;
                        let _e460 = here_2.front;
                        phi_1325_ = (abs((_e458 - _e460)) < 0.5f);
                    }
                    let _e465 = phi_1325_;
                    phi_1333_ = _e465;
                    if _e465 {
                        let _e466 = landed;
                        let _e468 = then_1;
                        phi_1333_ = ((_e466 > 0f) || (_e468 <= 0f));
                    }
                    let _e472 = phi_1333_;
                    idle = _e472;
                    let _e473 = idle;
                    if _e473 {
                        let _e474 = x_5;
                        x_5 = (_e474 + 1f);
                        let _e476 = sense;
                        let _e477 = column_6;
                        column_6 = (_e477 + _e476);
                        let _e479 = following_1;
                        here_2.front = _e479;
                        let _e481 = then_1;
                        landed = _e481;
                        on_front = false;
                        on_back = false;
                    }
                    continue;
                } else {
                    break;
                }
            }
            let _e482 = x_5;
            let _e483 = limit;
            if (_e482 >= _e483) {
                break;
            }
            let _e485 = column_6;
            let _e486 = sense;
            param_50 = (_e485 + _e486);
            let _e488 = row_7;
            param_51 = _e488;
            let _e489 = layer_at((&param_50), (&param_51));
            next_1 = _e489;
            let _e490 = x_5;
            let _e492 = here_2.front;
            let _e494 = t;
            a = ((_e490 + _e492) - _e494);
            let _e496 = x_5;
            let _e499 = next_1.front;
            let _e501 = t;
            b = (((_e496 + 1f) + _e499) - _e501);
            let _e503 = x_5;
            let _e505 = here_2.back;
            let _e507 = t;
            c = ((_e503 + _e505) - _e507);
            let _e509 = x_5;
            let _e512 = next_1.back;
            let _e514 = t;
            d = (((_e509 + 1f) + _e512) - _e514);
            let _e517 = next_1.front;
            let _e519 = here_2.front;
            front_front = (abs((_e517 - _e519)) < 0.5f);
            let _e524 = next_1.split;
            phi_1409_ = _e524;
            if _e524 {
                let _e526 = next_1.back;
                let _e528 = here_2.front;
                phi_1409_ = (abs((_e526 - _e528)) < 0.5f);
            }
            let _e533 = phi_1409_;
            front_back = _e533;
            let _e535 = here_2.split;
            phi_1422_ = _e535;
            if _e535 {
                let _e537 = next_1.front;
                let _e539 = here_2.back;
                phi_1422_ = (abs((_e537 - _e539)) < 0.5f);
            }
            let _e544 = phi_1422_;
            back_front = _e544;
            let _e546 = here_2.split;
            let _e548 = next_1.split;
            let _e549 = (_e546 && _e548);
            phi_1438_ = _e549;
            if _e549 {
                let _e551 = next_1.back;
                let _e553 = here_2.back;
                phi_1438_ = (abs((_e551 - _e553)) < 0.5f);
            }
            let _e558 = phi_1438_;
            back_back = _e558;
            fronts = vec2<f32>(0f, 0f);
            backs = vec2<f32>(0f, 0f);
            let _e559 = front_front;
            let _e560 = a;
            let _e563 = b;
            if ((_e559 && (_e560 <= 0f)) && (_e563 > 0f)) {
                let _e566 = a;
                let _e568 = b;
                let _e569 = a;
                g_1 = (-(_e566) / (_e568 - _e569));
                let _e572 = g_1;
                param_52 = _e572;
                let _e573 = right_of((&param_52));
                right = _e573;
                let _e575 = here_2.mask;
                param_53 = _e575;
                let _e576 = right;
                param_54 = _e576;
                let _e577 = covered((&param_53), (&param_54));
                let _e578 = right;
                let _e582 = next_1.mask;
                param_55 = _e582;
                param_56 = (vec4(1f) - _e578);
                let _e583 = covered((&param_55), (&param_56));
                shares = vec2<f32>(_e577, _e583);
                let _e586 = shares[0u];
                let _e588 = shares[1u];
                share_3 = (_e586 + _e588);
                let _e590 = x_5;
                let _e591 = g_1;
                let _e594 = here_2.front;
                let _e596 = next_1.front;
                let _e597 = g_1;
                let _e599 = seen_2;
                param_57 = _e599;
                let _e600 = share_3;
                param_58 = _e600;
                param_59 = (_e590 + _e591);
                param_60 = mix(_e594, _e596, _e597);
                let _e601 = cover((&param_57), (&param_58), (&param_59), (&param_60));
                let _e602 = param_57;
                seen_2 = _e602;
                let _e603 = shares;
                let _e605 = share_3;
                fronts = ((_e603 * _e601) / vec2(max(_e605, 0.000001f)));
            }
            let _e609 = front_front;
            let _e610 = !(_e609);
            phi_1518_ = _e610;
            if _e610 {
                let _e612 = next_1.front;
                let _e614 = here_2.front;
                let _e617 = next_1.split;
                phi_1518_ = ((_e612 > _e614) || _e617);
            }
            let _e620 = phi_1518_;
            let _e621 = back_front;
            let _e624 = b;
            let _e627 = b;
            if (((_e620 && !(_e621)) && (_e624 > 0f)) && (_e627 < 1f)) {
                let _e630 = b;
                param_61 = (1f - _e630);
                let _e632 = right_of((&param_61));
                let _e636 = next_1.mask;
                param_62 = _e636;
                param_63 = (vec4(1f) - _e632);
                let _e637 = covered((&param_62), (&param_63));
                share_4 = _e637;
                let _e638 = x_5;
                let _e640 = seen_2;
                param_64 = _e640;
                let _e641 = share_4;
                param_65 = _e641;
                param_66 = (_e638 + 1f);
                let _e643 = next_1.front;
                param_67 = _e643;
                let _e644 = cover((&param_64), (&param_65), (&param_66), (&param_67));
                let _e645 = param_64;
                seen_2 = _e645;
                let _e647 = fronts[1u];
                fronts[1u] = (_e647 + _e644);
            }
            let _e650 = front_front;
            let _e651 = !(_e650);
            phi_1570_ = _e651;
            if _e651 {
                let _e653 = next_1.front;
                let _e655 = here_2.front;
                let _e658 = here_2.split;
                phi_1570_ = ((_e653 < _e655) || _e658);
            }
            let _e661 = phi_1570_;
            let _e662 = front_back;
            let _e665 = a;
            let _e668 = a;
            if (((_e661 && !(_e662)) && (_e665 <= 0f)) && (_e668 > -1f)) {
                let _e671 = a;
                param_68 = -(_e671);
                let _e673 = right_of((&param_68));
                let _e675 = here_2.mask;
                param_69 = _e675;
                param_70 = _e673;
                let _e676 = covered((&param_69), (&param_70));
                let _e677 = seen_2;
                param_71 = _e677;
                param_72 = _e676;
                let _e678 = x_5;
                param_73 = _e678;
                let _e680 = here_2.front;
                param_74 = _e680;
                let _e681 = cover((&param_71), (&param_72), (&param_73), (&param_74));
                let _e682 = param_71;
                seen_2 = _e682;
                let _e684 = fronts[0u];
                fronts[0u] = (_e684 + _e681);
            }
            let _e687 = front_back;
            let _e688 = a;
            let _e691 = d;
            let _e693 = ((_e687 && (_e688 <= 0f)) && (_e691 > 0f));
            phi_1618_ = _e693;
            if _e693 {
                let _e695 = seen_2.rest;
                phi_1618_ = (_e695 > 0.01f);
            }
            let _e698 = phi_1618_;
            if _e698 {
                let _e699 = a;
                let _e701 = d;
                let _e702 = a;
                g_2 = (-(_e699) / (_e701 - _e702));
                let _e705 = x_5;
                let _e706 = g_2;
                let _e708 = seen_2;
                param_75 = _e708;
                param_76 = 1f;
                param_77 = (_e705 + _e706);
                let _e710 = here_2.front;
                param_78 = _e710;
                let _e711 = cover((&param_75), (&param_76), (&param_77), (&param_78));
                let _e712 = param_75;
                seen_2 = _e712;
                taken_1 = _e711;
                let _e713 = taken_1;
                let _e714 = g_2;
                let _e718 = fronts[0u];
                fronts[0u] = (_e718 + (_e713 * (1f - _e714)));
                let _e721 = taken_1;
                let _e722 = g_2;
                let _e725 = backs[1u];
                backs[1u] = (_e725 + (_e721 * _e722));
            }
            let _e728 = back_front;
            let _e729 = c;
            let _e732 = b;
            let _e734 = ((_e728 && (_e729 <= 0f)) && (_e732 > 0f));
            phi_1668_ = _e734;
            if _e734 {
                let _e736 = seen_2.rest;
                phi_1668_ = (_e736 > 0.01f);
            }
            let _e739 = phi_1668_;
            if _e739 {
                let _e740 = c;
                let _e742 = b;
                let _e743 = c;
                g_3 = (-(_e740) / (_e742 - _e743));
                let _e746 = x_5;
                let _e747 = g_3;
                let _e749 = seen_2;
                param_79 = _e749;
                param_80 = 1f;
                param_81 = (_e746 + _e747);
                let _e751 = next_1.front;
                param_82 = _e751;
                let _e752 = cover((&param_79), (&param_80), (&param_81), (&param_82));
                let _e753 = param_79;
                seen_2 = _e753;
                taken_2 = _e752;
                let _e754 = taken_2;
                let _e755 = g_3;
                let _e759 = backs[0u];
                backs[0u] = (_e759 + (_e754 * (1f - _e755)));
                let _e762 = taken_2;
                let _e763 = g_3;
                let _e766 = fronts[1u];
                fronts[1u] = (_e766 + (_e762 * _e763));
            }
            let _e769 = back_back;
            let _e770 = c;
            let _e773 = d;
            let _e775 = ((_e769 && (_e770 <= 0f)) && (_e773 > 0f));
            phi_1718_ = _e775;
            if _e775 {
                let _e777 = seen_2.rest;
                phi_1718_ = (_e777 > 0.01f);
            }
            let _e780 = phi_1718_;
            if _e780 {
                let _e781 = c;
                let _e783 = d;
                let _e784 = c;
                g_4 = (-(_e781) / (_e783 - _e784));
                let _e787 = x_5;
                let _e788 = g_4;
                let _e790 = seen_2;
                param_83 = _e790;
                param_84 = 1f;
                param_85 = (_e787 + _e788);
                let _e792 = here_2.back;
                param_86 = _e792;
                let _e793 = cover((&param_83), (&param_84), (&param_85), (&param_86));
                let _e794 = param_83;
                seen_2 = _e794;
                taken_3 = _e793;
                let _e795 = taken_3;
                let _e796 = g_4;
                let _e798 = g_4;
                let _e801 = backs;
                backs = (_e801 + (vec2<f32>((1f - _e796), _e798) * _e795));
            }
            let _e804 = here_2.split;
            let _e805 = back_front;
            let _e808 = back_back;
            ends = ((_e804 && !(_e805)) && !(_e808));
            let _e811 = ends;
            let _e812 = on_front;
            let _e815 = on_back;
            let _e817 = ((_e811 && !(_e812)) && !(_e815));
            phi_1770_ = _e817;
            if _e817 {
                let _e818 = c;
                phi_1770_ = (abs(_e818) < 1f);
            }
            let _e822 = phi_1770_;
            phi_1776_ = _e822;
            if _e822 {
                let _e824 = seen_2.rest;
                phi_1776_ = (_e824 > 0.01f);
            }
            let _e827 = phi_1776_;
            if _e827 {
                let _e828 = c;
                if (_e828 <= 0f) {
                    let _e830 = c;
                    param_87 = -(_e830);
                    let _e832 = right_of((&param_87));
                    local_11 = _e832;
                } else {
                    let _e833 = c;
                    param_88 = (1f - _e833);
                    let _e835 = right_of((&param_88));
                    local_11 = (vec4(1f) - _e835);
                }
                let _e838 = local_11;
                stripes_1 = _e838;
                let _e840 = here_2.mask;
                param_89 = (vec4(1f) - _e840);
                let _e843 = stripes_1;
                param_90 = _e843;
                let _e844 = covered((&param_89), (&param_90));
                let _e845 = seen_2;
                param_91 = _e845;
                param_92 = _e844;
                let _e846 = x_5;
                param_93 = _e846;
                let _e848 = here_2.back;
                param_94 = _e848;
                let _e849 = cover((&param_91), (&param_92), (&param_93), (&param_94));
                let _e850 = param_91;
                seen_2 = _e850;
                let _e852 = backs[0u];
                backs[0u] = (_e852 + _e849);
            }
            let _e855 = ends;
            phi_1828_ = _e855;
            if _e855 {
                let _e857 = next_1.front;
                let _e859 = here_2.back;
                phi_1828_ = (_e857 > _e859);
            }
            let _e862 = phi_1828_;
            let _e863 = c;
            at_back = (_e862 && (_e863 <= 0f));
            let _e867 = here_2.split;
            let _e869 = front_front;
            let _e872 = front_back;
            let _e874 = ((!(_e867) && !(_e869)) && !(_e872));
            phi_1849_ = _e874;
            if _e874 {
                let _e876 = next_1.front;
                let _e878 = here_2.front;
                phi_1849_ = (_e876 > _e878);
            }
            let _e881 = phi_1849_;
            let _e882 = a;
            at_front = (_e881 && (_e882 <= 0f));
            let _e885 = at_back;
            let _e886 = at_front;
            let _e887 = (_e885 || _e886);
            phi_1861_ = _e887;
            if _e887 {
                let _e889 = seen_2.rest;
                phi_1861_ = (_e889 > 0.01f);
            }
            let _e892 = phi_1861_;
            if _e892 {
                let _e893 = at_back;
                if _e893 {
                    let _e895 = here_2.back;
                    local_12 = _e895;
                } else {
                    let _e897 = here_2.front;
                    local_12 = _e897;
                }
                let _e898 = local_12;
                reach_2 = _e898;
                let _e899 = at_back;
                if _e899 {
                    let _e900 = c;
                    local_13 = -(_e900);
                } else {
                    let _e902 = a;
                    local_13 = -(_e902);
                }
                let _e904 = local_13;
                away = _e904;
                let _e905 = at_back;
                let _e906 = on_front;
                if (_e905 && !(_e906)) {
                    let _e910 = here_2.mask;
                    param_95 = _e910;
                    param_96 = vec4<f32>(1f, 1f, 1f, 1f);
                    let _e911 = covered((&param_95), (&param_96));
                    local_14 = (1f - _e911);
                } else {
                    local_14 = 1f;
                }
                let _e913 = local_14;
                weight = _e913;
                let _e914 = column_6;
                let _e915 = at_back;
                let _e916 = reach_2;
                let _e917 = weight;
                found = Edge(_e914, _e915, _e916, _e917);
                let _e919 = weight;
                let _e921 = away;
                if ((_e919 == 1f) && (_e921 < 0.5f)) {
                    let _e924 = seen_2;
                    param_97 = _e924;
                    param_98 = 1f;
                    let _e925 = x_5;
                    param_99 = _e925;
                    let _e926 = reach_2;
                    param_100 = _e926;
                    let _e927 = cover((&param_97), (&param_98), (&param_99), (&param_100));
                    let _e928 = param_97;
                    seen_2 = _e928;
                    taken_4 = _e927;
                    let _e929 = at_back;
                    let _e930 = taken_4;
                    let _e933 = backs[0u];
                    backs[0u] = (_e933 + select(0f, _e930, _e929));
                    let _e936 = at_back;
                    let _e937 = taken_4;
                    let _e940 = fronts[0u];
                    fronts[0u] = (_e940 + select(_e937, 0f, _e936));
                }
                let _e943 = reach_2;
                let _e945 = edge.reach;
                if (_e943 < _e945) {
                    let _e947 = weight;
                    if (_e947 < 1f) {
                        let _e949 = edge;
                        second = _e949;
                    }
                    let _e950 = found;
                    edge = _e950;
                    let _e952 = next_1.front;
                    beside = _e952;
                } else {
                    let _e953 = reach_2;
                    let _e955 = second.reach;
                    if (_e953 < _e955) {
                        let _e957 = found;
                        second = _e957;
                    }
                }
            }
            let _e959 = fronts[0u];
            let _e961 = backs[0u];
            if (max(_e959, _e961) > 0f) {
                let _e964 = column_6;
                param_101 = _e964;
                let _e965 = row_7;
                param_102 = _e965;
                let _e967 = fronts[0u];
                param_103 = _e967;
                let _e969 = backs[0u];
                param_104 = _e969;
                let _e970 = weighted((&param_101), (&param_102), (&param_103), (&param_104));
                let _e971 = color_1;
                color_1 = (_e971 + _e970);
            }
            let _e974 = fronts[1u];
            let _e976 = backs[1u];
            if (max(_e974, _e976) > 0f) {
                let _e979 = column_6;
                let _e980 = sense;
                param_105 = (_e979 + _e980);
                let _e982 = row_7;
                param_106 = _e982;
                let _e984 = fronts[1u];
                param_107 = _e984;
                let _e986 = backs[1u];
                param_108 = _e986;
                let _e987 = weighted((&param_105), (&param_106), (&param_107), (&param_108));
                let _e988 = color_1;
                color_1 = (_e988 + _e987);
            }
            let _e990 = front_back;
            on_front = _e990;
            let _e991 = back_back;
            on_back = _e991;
            let _e992 = next_1;
            here_2 = _e992;
            let _e993 = sense;
            let _e994 = column_6;
            column_6 = (_e994 + _e993);
            let _e996 = x_5;
            x_5 = (_e996 + 1f);
            continue;
        } else {
            break;
        }
    }
    let _e999 = seen_2.rest;
    hole = (_e999 > 0.5f);
    let _e1002 = seen_2.rest;
    if (_e1002 > 0.01f) {
        let _e1005 = edge.column;
        beyond = (_e1005 < 0i);
        let _e1007 = beyond;
        if _e1007 {
            let _e1008 = column_6;
            let _e1010 = here_2.split;
            let _e1012 = here_2.split;
            if _e1012 {
                let _e1014 = here_2.back;
                local_15 = _e1014;
            } else {
                let _e1016 = here_2.front;
                local_15 = _e1016;
            }
            let _e1017 = local_15;
            edge = Edge(_e1008, _e1010, _e1017, 1f);
        }
        let _e1020 = edge.column;
        param_109 = _e1020;
        let _e1021 = source_column((&param_109));
        edge_x = f32(_e1021);
        let _e1023 = t;
        let _e1024 = edge_x;
        let _e1027 = edge.reach;
        away_1 = abs(((_e1023 - _e1024) - _e1027));
        let _e1030 = away_1;
        spread = (0.5f * clamp(_e1030, 1f, 12f));
        sum_1 = vec4<f32>(0f, 0f, 0f, 0f);
        weights = 0f;
        let _e1033 = beyond;
        let _e1034 = away_1;
        rows_1 = select(2i, 0i, (_e1033 && (_e1034 < 0.5f)));
        let _e1038 = rows_1;
        i_2 = -(_e1038);
        loop {
            let _e1040 = i_2;
            let _e1041 = rows_1;
            if (_e1040 <= _e1041) {
                let _e1043 = row_7;
                let _e1044 = i_2;
                let _e1046 = spread;
                let _e1053 = synthesis.source_size[1u];
                at_1 = clamp((_e1043 + i32(round((f32(_e1044) * _e1046)))), 0i, (_e1053 - 1i));
                let _e1057 = edge.column;
                param_110 = _e1057;
                let _e1058 = at_1;
                param_111 = _e1058;
                let _e1059 = layer_at((&param_110), (&param_111));
                layer_3 = _e1059;
                let _e1060 = i_2;
                if (_e1060 == 0i) {
                    let _e1063 = edge.back;
                    local_16 = !(_e1063);
                } else {
                    let _e1066 = layer_3.front;
                    let _e1068 = edge.reach;
                    local_16 = (_e1066 <= (_e1068 + 1f));
                }
                let _e1071 = local_16;
                front_3 = _e1071;
                let _e1072 = i_2;
                if (_e1072 == 0i) {
                    let _e1075 = edge.back;
                    local_17 = _e1075;
                } else {
                    let _e1076 = front_3;
                    let _e1079 = layer_3.split;
                    let _e1080 = (!(_e1076) && _e1079);
                    phi_2141_ = _e1080;
                    if _e1080 {
                        let _e1082 = layer_3.back;
                        let _e1084 = edge.reach;
                        phi_2141_ = (_e1082 <= (_e1084 + 1f));
                    }
                    let _e1088 = phi_2141_;
                    local_17 = _e1088;
                }
                let _e1089 = local_17;
                behind_2 = _e1089;
                let _e1090 = i_2;
                if (_e1090 == 0i) {
                    local_18 = 2f;
                } else {
                    let _e1092 = front_3;
                    if _e1092 {
                        local_19 = 1f;
                    } else {
                        let _e1093 = behind_2;
                        if _e1093 {
                            let _e1095 = layer_3.mask;
                            param_112 = _e1095;
                            param_113 = vec4<f32>(1f, 1f, 1f, 1f);
                            let _e1096 = covered((&param_112), (&param_113));
                            local_20 = (1f - _e1096);
                        } else {
                            local_20 = 0f;
                        }
                        let _e1098 = local_20;
                        local_19 = _e1098;
                    }
                    let _e1099 = local_19;
                    local_18 = _e1099;
                }
                let _e1100 = local_18;
                weight_1 = _e1100;
                let _e1101 = front_3;
                let _e1102 = weight_1;
                let _e1104 = front_3;
                let _e1105 = weight_1;
                let _e1108 = edge.column;
                param_114 = _e1108;
                let _e1109 = at_1;
                param_115 = _e1109;
                param_116 = select(0f, _e1102, _e1101);
                param_117 = select(_e1105, 0f, _e1104);
                let _e1110 = weighted((&param_114), (&param_115), (&param_116), (&param_117));
                let _e1111 = sum_1;
                sum_1 = (_e1111 + _e1110);
                let _e1113 = weight_1;
                let _e1114 = weights;
                weights = (_e1114 + _e1113);
                continue;
            } else {
                break;
            }
            continuing {
                let _e1116 = i_2;
                i_2 = (_e1116 + 1i);
            }
        }
        let _e1118 = sum_1;
        let _e1119 = weights;
        fill = (_e1118 / vec4(_e1119));
        let _e1123 = second.column;
        let _e1124 = (_e1123 >= 0i);
        phi_2203_ = _e1124;
        if _e1124 {
            let _e1126 = edge.weight;
            phi_2203_ = (_e1126 < 1f);
        }
        let _e1129 = phi_2203_;
        if _e1129 {
            let _e1131 = second.back;
            one = select(vec2<f32>(1f, 0f), vec2<f32>(0f, 1f), vec2(_e1131));
            let _e1135 = second.column;
            param_118 = _e1135;
            let _e1136 = row_7;
            param_119 = _e1136;
            let _e1138 = one[0u];
            param_120 = _e1138;
            let _e1140 = one[1u];
            param_121 = _e1140;
            let _e1141 = weighted((&param_118), (&param_119), (&param_120), (&param_121));
            let _e1142 = fill;
            let _e1144 = edge.weight;
            fill = mix(_e1141, _e1142, vec4(_e1144));
        }
        let _e1147 = hole;
        let _e1148 = away_1;
        hole = (_e1147 && (_e1148 >= 0.5f));
        let _e1152 = edge.reach;
        let _e1153 = far_nearness();
        let _e1157 = synthesis.law[1u];
        depth_1 = ((_e1152 + _e1153) / _e1157);
        let _e1161 = synthesis.origins[0u];
        let _e1163 = gl_FragCoord_1[0u];
        let _e1167 = synthesis.origins[1u];
        origin_1 = ((_e1161 * _e1163) + _e1167);
        let _e1169 = away_1;
        let _e1170 = (_e1169 >= 0.5f);
        phi_2278_ = _e1170;
        if _e1170 {
            let _e1171 = gl_FragCoord_1;
            let _e1174 = synthesis.target_origin;
            let _e1177 = beside;
            let _e1178 = far_nearness();
            param_122 = (_e1171.xy - vec2<f32>(_e1174));
            param_123 = (_e1177 + _e1178);
            let _e1180 = origin_1;
            param_124 = _e1180;
            let _e1181 = row_7;
            param_125 = _e1181;
            let _e1182 = fill;
            param_126 = _e1182;
            let _e1183 = depth_1;
            param_127 = _e1183;
            let _e1184 = recall((&param_122), (&param_123), (&param_124), (&param_125), (&param_126), (&param_127));
            let _e1185 = param_126;
            fill = _e1185;
            let _e1186 = param_127;
            depth_1 = _e1186;
            phi_2278_ = _e1184;
        }
        let _e1188 = phi_2278_;
        if _e1188 {
            let _e1191 = synthesis.law[1u];
            let _e1192 = depth_1;
            let _e1194 = far_nearness();
            edge.reach = ((_e1191 * _e1192) - _e1194);
        }
        let _e1197 = seen_2;
        param_128 = _e1197;
        param_129 = 1f;
        let _e1198 = edge_x;
        param_130 = _e1198;
        let _e1200 = edge.reach;
        param_131 = _e1200;
        let _e1201 = cover((&param_128), (&param_129), (&param_130), (&param_131));
        let _e1202 = param_128;
        seen_2 = _e1202;
        let _e1203 = fill;
        let _e1205 = color_1;
        color_1 = (_e1205 + (_e1203 * _e1201));
    }
    let _e1208 = synthesis.far_displacement;
    let _e1210 = seen_2.reach;
    let _e1214 = synthesis.law[0u];
    let _e1218 = synthesis.law[1u];
    gl_FragDepth = clamp((((_e1208 + _e1210) - _e1214) / _e1218), 0f, 1f);
    return;
}

@fragment 
fn main(@location(0) span_at: vec2<f32>, @builtin(position) gl_FragCoord: vec4<f32>) -> FragmentOutput {
    span_at_1 = span_at;
    gl_FragCoord_1 = gl_FragCoord;
    main_1();
    let _e6 = color_1;
    let _e7 = gl_FragDepth;
    return FragmentOutput(_e6, _e7);
}
