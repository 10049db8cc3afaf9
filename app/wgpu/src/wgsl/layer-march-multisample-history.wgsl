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
@group(0) @binding(10) 
var history_depth_texture: texture_2d<f32>;
@group(0) @binding(12) 
var<uniform> history: History;
@group(0) @binding(11) 
var history_color_texture: texture_2d<f32>;
@group(0) @binding(5) 
var back_map_texture: texture_2d<f32>;
var<private> gl_FragCoord_1: vec4<f32>;
var<private> color_1: vec4<f32>;

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
    var phi_456_: bool;
    var phi_471_: bool;
    var phi_599_: bool;
    var phi_678_: bool;

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
    phi_456_ = _e119;
    if _e119 {
        let _e120 = guess;
        let _e121 = size;
        phi_456_ = all((_e120 < _e121));
    }
    let _e125 = phi_456_;
    inside = _e125;
    let _e127 = seen[3u];
    let _e129 = inside;
    let _e130 = ((_e127 > 0f) && _e129);
    phi_471_ = _e130;
    if _e130 {
        let _e132 = guess[1u];
        let _e133 = rows;
        let _e136 = strip;
        phi_471_ = (i32((_e132 / _e133)) == _e136);
    }
    let _e139 = phi_471_;
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
    phi_599_ = _e238;
    if !(_e238) {
        let _e240 = before;
        let _e241 = nearness;
        phi_599_ = (_e240 > (_e241 - 1f));
    }
    let _e245 = phi_599_;
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
            phi_678_ = _e292;
            if _e292 {
                let _e295 = synthesis.law[1u];
                let _e296 = texel;
                let _e297 = textureLoad(history_depth_texture, _e296, 0i);
                let _e299 = stored;
                phi_678_ = (abs((_e295 * (_e297.x - _e299))) < 1f);
            }
            let _e305 = phi_678_;
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
    var mask_1: vec4<f32>;

    let _e19 = (*column_3);
    param_11 = _e19;
    let _e20 = (*row_4);
    param_12 = _e20;
    let _e21 = layer_bits((&param_11), (&param_12));
    bits_1 = _e21;
    let _e22 = bits_1;
    param_13 = _e22;
    let _e23 = is_full((&param_13));
    if _e23 {
        let _e24 = bits_1;
        param_14 = _e24;
        let _e25 = full_front((&param_14));
        return Layer(_e25, 1000000000f, false, vec4<f32>(1f, 1f, 1f, 1f));
    }
    let _e27 = bits_1;
    param_15 = _e27;
    let _e28 = split_displacements((&param_15));
    both = _e28;
    let _e29 = bits_1;
    code = (_e29 >> bitcast<u32>(28i));
    let _e32 = code;
    mask_1 = vec4<f32>(((vec4(_e32) >> bitcast<vec4<u32>>(vec4<u32>(0u, 1u, 2u, 3u))) & vec4(1u)));
    let _e40 = both[0u];
    let _e42 = both[1u];
    let _e43 = mask_1;
    return Layer(_e40, _e42, true, _e43);
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

fn cover(seen_1: ptr<function, Seen>, share_1: ptr<function, f32>, column_5: ptr<function, f32>, reach_1: ptr<function, f32>) -> f32 {
    var taken: f32;
    var passes: bool;
    var local_6: f32;
    var local_7: f32;
    var phi_917_: bool;

    let _e10 = (*seen_1).rest;
    let _e11 = (*share_1);
    taken = (_e10 * _e11);
    let _e14 = (*seen_1).rest;
    let _e15 = (_e14 > 0.5f);
    phi_917_ = _e15;
    if _e15 {
        let _e17 = (*seen_1).rest;
        let _e18 = taken;
        phi_917_ = ((_e17 - _e18) <= 0.5f);
    }
    let _e22 = phi_917_;
    passes = _e22;
    let _e23 = passes;
    if _e23 {
        let _e24 = (*column_5);
        local_6 = _e24;
    } else {
        let _e26 = (*seen_1).column;
        local_6 = _e26;
    }
    let _e27 = local_6;
    (*seen_1).column = _e27;
    let _e29 = passes;
    if _e29 {
        let _e30 = (*reach_1);
        local_7 = _e30;
    } else {
        let _e32 = (*seen_1).reach;
        local_7 = _e32;
    }
    let _e33 = local_7;
    (*seen_1).reach = _e33;
    let _e35 = taken;
    let _e37 = (*seen_1).rest;
    (*seen_1).rest = (_e37 - _e35);
    let _e40 = taken;
    return _e40;
}

fn span_steps(span: ptr<function, u32>) -> f32 {
    var steps: u32;
    var local_8: f32;

    let _e5 = (*span);
    steps = (_e5 & 1023u);
    let _e7 = steps;
    if (_e7 == 1023u) {
        local_8 = 1000000000f;
    } else {
        let _e9 = steps;
        local_8 = f32(_e9);
    }
    let _e11 = local_8;
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
    var share_2: f32;
    var param_57: Seen;
    var param_58: f32;
    var param_59: f32;
    var param_60: f32;
    var share_3: f32;
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
    var local_9: vec4<f32>;
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
    var local_10: f32;
    var away: f32;
    var local_11: f32;
    var weight: f32;
    var local_12: f32;
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
    var local_13: f32;
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
    var local_14: bool;
    var behind_2: bool;
    var local_15: bool;
    var weight_1: f32;
    var local_16: f32;
    var local_17: f32;
    var local_18: f32;
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
    var phi_1074_: bool;
    var phi_1169_: bool;
    var phi_1176_: bool;
    var phi_1195_: bool;
    var phi_1224_: bool;
    var phi_1238_: bool;
    var phi_1290_: bool;
    var phi_1298_: bool;
    var phi_1374_: bool;
    var phi_1387_: bool;
    var phi_1403_: bool;
    var phi_1483_: bool;
    var phi_1535_: bool;
    var phi_1583_: bool;
    var phi_1633_: bool;
    var phi_1683_: bool;
    var phi_1735_: bool;
    var phi_1741_: bool;
    var phi_1793_: bool;
    var phi_1814_: bool;
    var phi_1826_: bool;
    var phi_2106_: bool;
    var phi_2168_: bool;
    var phi_2243_: bool;

    let _e223 = synthesis.source_size[0u];
    last_3 = f32((_e223 - 1i));
    let _e227 = gl_FragCoord_1[1u];
    let _e229 = synthesis.first_row;
    let _e233 = synthesis.source_size[1u];
    row_7 = i32(clamp((_e227 - _e229), 0f, f32((_e233 - 1i))));
    let _e240 = synthesis.origins[0u];
    let _e242 = gl_FragCoord_1[0u];
    let _e246 = synthesis.origins[1u];
    let _e249 = synthesis.farthest;
    t = ((((_e240 * _e242) + _e246) - _e249) + 0.01f);
    let _e252 = pixel_span();
    span_1 = _e252.x;
    let _e254 = t;
    let _e255 = span_1;
    let _e260 = last_3;
    x_5 = clamp(floor(((_e254 - bitcast<f32>(_e255)) - 1.01f)), 0f, _e260);
    let _e262 = x_5;
    let _e263 = span_1;
    param_26 = _e263;
    let _e264 = span_steps((&param_26));
    let _e267 = last_3;
    limit = min(((_e262 + _e264) + 2f), _e267);
    let _e270 = synthesis.mirrored;
    sense = select(1i, -1i, (_e270 != 0u));
    let _e273 = x_5;
    param_27 = i32(_e273);
    let _e275 = source_column((&param_27));
    column_6 = _e275;
    seen_2 = Seen(1f, 0f, 0f);
    color_1 = vec4<f32>(0f, 0f, 0f, 0f);
    let _e276 = column_6;
    param_28 = _e276;
    let _e277 = row_7;
    param_29 = _e277;
    let _e278 = layer_bits((&param_28), (&param_29));
    bits_2 = _e278;
    let _e279 = bits_2;
    param_30 = _e279;
    let _e280 = full_front((&param_30));
    front_2 = _e280;
    let _e281 = x_5;
    let _e282 = front_2;
    let _e284 = t;
    at = ((_e281 + _e282) - _e284);
    let _e286 = bits_2;
    param_31 = _e286;
    let _e287 = is_full((&param_31));
    let _e288 = at;
    plain = (_e287 && (_e288 <= 0f));
    loop {
        let _e291 = plain;
        let _e292 = x_5;
        let _e293 = limit;
        if (_e291 && (_e292 < _e293)) {
            let _e296 = column_6;
            let _e297 = sense;
            param_32 = (_e296 + _e297);
            let _e299 = row_7;
            param_33 = _e299;
            let _e300 = layer_bits((&param_32), (&param_33));
            bits_2 = _e300;
            let _e301 = bits_2;
            param_34 = _e301;
            let _e302 = full_front((&param_34));
            following = _e302;
            let _e303 = bits_2;
            param_35 = _e303;
            let _e304 = is_full((&param_35));
            phi_1074_ = _e304;
            if _e304 {
                let _e305 = following;
                let _e306 = front_2;
                phi_1074_ = (abs((_e305 - _e306)) < 0.5f);
            }
            let _e311 = phi_1074_;
            plain = _e311;
            let _e312 = x_5;
            let _e314 = following;
            let _e316 = t;
            then = (((_e312 + 1f) + _e314) - _e316);
            let _e318 = plain;
            let _e319 = then;
            if (_e318 && (_e319 > 0f)) {
                let _e322 = at;
                let _e324 = then;
                let _e325 = at;
                g = (-(_e322) / (_e324 - _e325));
                let _e328 = x_5;
                let _e329 = g;
                let _e331 = front_2;
                let _e332 = following;
                let _e333 = g;
                let _e335 = seen_2;
                param_36 = _e335;
                param_37 = 1f;
                param_38 = (_e328 + _e329);
                param_39 = mix(_e331, _e332, _e333);
                let _e336 = cover((&param_36), (&param_37), (&param_38), (&param_39));
                let _e337 = param_36;
                seen_2 = _e337;
                let _e338 = x_5;
                limit = _e338;
            } else {
                let _e339 = plain;
                if _e339 {
                    let _e340 = x_5;
                    x_5 = (_e340 + 1f);
                    let _e342 = sense;
                    let _e343 = column_6;
                    column_6 = (_e343 + _e342);
                    let _e345 = following;
                    front_2 = _e345;
                    let _e346 = then;
                    at = _e346;
                }
            }
            continue;
        } else {
            break;
        }
    }
    let _e348 = seen_2.rest;
    if (_e348 < 0.01f) {
        let _e351 = seen_2.column;
        param_40 = _e351;
        let _e352 = row_7;
        param_41 = _e352;
        let _e353 = sharp_color_at((&param_40), (&param_41));
        color_1 = _e353;
    }
    let _e354 = column_6;
    param_42 = _e354;
    let _e355 = row_7;
    param_43 = _e355;
    let _e356 = layer_at((&param_42), (&param_43));
    here_2 = _e356;
    edge = Edge(-1i, false, 1000000000f, 1f);
    let _e357 = edge;
    second = _e357;
    beside = 1000000000f;
    let _e358 = x_5;
    if (_e358 == 0f) {
        let _e361 = here_2.front;
        let _e362 = t;
        if (_e361 > _e362) {
            let _e364 = column_6;
            let _e366 = here_2.front;
            edge = Edge(_e364, false, _e366, 1f);
        }
        let _e369 = here_2.split;
        phi_1169_ = _e369;
        if _e369 {
            let _e371 = here_2.back;
            let _e373 = edge.reach;
            phi_1169_ = (_e371 < _e373);
        }
        let _e376 = phi_1169_;
        phi_1176_ = _e376;
        if _e376 {
            let _e378 = here_2.back;
            let _e379 = t;
            phi_1176_ = (_e378 > _e379);
        }
        let _e382 = phi_1176_;
        if _e382 {
            let _e383 = column_6;
            let _e385 = here_2.back;
            edge = Edge(_e383, true, _e385, 1f);
        }
    }
    on_front = false;
    on_back = false;
    let _e387 = x_5;
    let _e390 = here_2.split;
    let _e391 = ((_e387 > 0f) && _e390);
    phi_1195_ = _e391;
    if _e391 {
        let _e393 = seen_2.rest;
        phi_1195_ = (_e393 > 0.01f);
    }
    let _e396 = phi_1195_;
    if _e396 {
        let _e397 = column_6;
        let _e398 = sense;
        param_44 = (_e397 - _e398);
        let _e400 = row_7;
        param_45 = _e400;
        let _e401 = layer_at((&param_44), (&param_45));
        before_1 = _e401;
        let _e403 = before_1.front;
        let _e405 = here_2.back;
        on_front = (abs((_e403 - _e405)) < 0.5f);
        let _e410 = before_1.split;
        phi_1224_ = _e410;
        if _e410 {
            let _e412 = before_1.back;
            let _e414 = here_2.back;
            phi_1224_ = (abs((_e412 - _e414)) < 0.5f);
        }
        let _e419 = phi_1224_;
        on_back = _e419;
    }
    loop {
        let _e420 = x_5;
        let _e421 = limit;
        let _e422 = (_e420 < _e421);
        phi_1238_ = _e422;
        if _e422 {
            let _e424 = seen_2.rest;
            phi_1238_ = (_e424 > 0.01f);
        }
        let _e427 = phi_1238_;
        if _e427 {
            let _e429 = here_2.split;
            idle = !(_e429);
            let _e431 = x_5;
            let _e433 = here_2.front;
            let _e435 = t;
            landed = ((_e431 + _e433) - _e435);
            loop {
                let _e437 = idle;
                let _e438 = x_5;
                let _e439 = limit;
                if (_e437 && (_e438 < _e439)) {
                    let _e442 = column_6;
                    let _e443 = sense;
                    param_46 = (_e442 + _e443);
                    let _e445 = row_7;
                    param_47 = _e445;
                    let _e446 = layer_bits((&param_46), (&param_47));
                    ahead = _e446;
                    let _e447 = ahead;
                    param_48 = _e447;
                    let _e448 = full_front((&param_48));
                    following_1 = _e448;
                    let _e449 = x_5;
                    let _e451 = following_1;
                    let _e453 = t;
                    then_1 = (((_e449 + 1f) + _e451) - _e453);
                    let _e455 = ahead;
                    param_49 = _e455;
                    let _e456 = is_full((&param_49));
                    phi_1290_ = _e456;
                    if _e456 {
                        let _e457 = following_1;
                        let _e459 = here_2.front;
                        phi_1290_ = (abs((_e457 - _e459)) < 0.5f);
                    }
                    let _e464 = phi_1290_;
                    phi_1298_ = _e464;
                    if _e464 {
                        let _e465 = landed;
                        let _e467 = then_1;
                        phi_1298_ = ((_e465 > 0f) || (_e467 <= 0f));
                    }
                    let _e471 = phi_1298_;
                    idle = _e471;
                    let _e472 = idle;
                    if _e472 {
                        let _e473 = x_5;
                        x_5 = (_e473 + 1f);
                        let _e475 = sense;
                        let _e476 = column_6;
                        column_6 = (_e476 + _e475);
                        let _e478 = following_1;
                        here_2.front = _e478;
                        let _e480 = then_1;
                        landed = _e480;
                        on_front = false;
                        on_back = false;
                    }
                    continue;
                } else {
                    break;
                }
            }
            let _e481 = x_5;
            let _e482 = limit;
            if (_e481 >= _e482) {
                break;
            }
            let _e484 = column_6;
            let _e485 = sense;
            param_50 = (_e484 + _e485);
            let _e487 = row_7;
            param_51 = _e487;
            let _e488 = layer_at((&param_50), (&param_51));
            next_1 = _e488;
            let _e489 = x_5;
            let _e491 = here_2.front;
            let _e493 = t;
            a = ((_e489 + _e491) - _e493);
            let _e495 = x_5;
            let _e498 = next_1.front;
            let _e500 = t;
            b = (((_e495 + 1f) + _e498) - _e500);
            let _e502 = x_5;
            let _e504 = here_2.back;
            let _e506 = t;
            c = ((_e502 + _e504) - _e506);
            let _e508 = x_5;
            let _e511 = next_1.back;
            let _e513 = t;
            d = (((_e508 + 1f) + _e511) - _e513);
            let _e516 = next_1.front;
            let _e518 = here_2.front;
            front_front = (abs((_e516 - _e518)) < 0.5f);
            let _e523 = next_1.split;
            phi_1374_ = _e523;
            if _e523 {
                let _e525 = next_1.back;
                let _e527 = here_2.front;
                phi_1374_ = (abs((_e525 - _e527)) < 0.5f);
            }
            let _e532 = phi_1374_;
            front_back = _e532;
            let _e534 = here_2.split;
            phi_1387_ = _e534;
            if _e534 {
                let _e536 = next_1.front;
                let _e538 = here_2.back;
                phi_1387_ = (abs((_e536 - _e538)) < 0.5f);
            }
            let _e543 = phi_1387_;
            back_front = _e543;
            let _e545 = here_2.split;
            let _e547 = next_1.split;
            let _e548 = (_e545 && _e547);
            phi_1403_ = _e548;
            if _e548 {
                let _e550 = next_1.back;
                let _e552 = here_2.back;
                phi_1403_ = (abs((_e550 - _e552)) < 0.5f);
            }
            let _e557 = phi_1403_;
            back_back = _e557;
            fronts = vec2<f32>(0f, 0f);
            backs = vec2<f32>(0f, 0f);
            let _e558 = front_front;
            let _e559 = a;
            let _e562 = b;
            if ((_e558 && (_e559 <= 0f)) && (_e562 > 0f)) {
                let _e565 = a;
                let _e567 = b;
                let _e568 = a;
                g_1 = (-(_e565) / (_e567 - _e568));
                let _e571 = g_1;
                param_52 = _e571;
                let _e572 = right_of((&param_52));
                right = _e572;
                let _e574 = here_2.mask;
                param_53 = _e574;
                let _e575 = right;
                param_54 = _e575;
                let _e576 = covered((&param_53), (&param_54));
                let _e577 = right;
                let _e581 = next_1.mask;
                param_55 = _e581;
                param_56 = (vec4(1f) - _e577);
                let _e582 = covered((&param_55), (&param_56));
                shares = vec2<f32>(_e576, _e582);
                let _e585 = shares[0u];
                let _e587 = shares[1u];
                share_2 = (_e585 + _e587);
                let _e589 = x_5;
                let _e590 = g_1;
                let _e593 = here_2.front;
                let _e595 = next_1.front;
                let _e596 = g_1;
                let _e598 = seen_2;
                param_57 = _e598;
                let _e599 = share_2;
                param_58 = _e599;
                param_59 = (_e589 + _e590);
                param_60 = mix(_e593, _e595, _e596);
                let _e600 = cover((&param_57), (&param_58), (&param_59), (&param_60));
                let _e601 = param_57;
                seen_2 = _e601;
                let _e602 = shares;
                let _e604 = share_2;
                fronts = ((_e602 * _e600) / vec2(max(_e604, 0.000001f)));
            }
            let _e608 = front_front;
            let _e609 = !(_e608);
            phi_1483_ = _e609;
            if _e609 {
                let _e611 = next_1.front;
                let _e613 = here_2.front;
                let _e616 = next_1.split;
                phi_1483_ = ((_e611 > _e613) || _e616);
            }
            let _e619 = phi_1483_;
            let _e620 = back_front;
            let _e623 = b;
            let _e626 = b;
            if (((_e619 && !(_e620)) && (_e623 > 0f)) && (_e626 < 1f)) {
                let _e629 = b;
                param_61 = (1f - _e629);
                let _e631 = right_of((&param_61));
                let _e635 = next_1.mask;
                param_62 = _e635;
                param_63 = (vec4(1f) - _e631);
                let _e636 = covered((&param_62), (&param_63));
                share_3 = _e636;
                let _e637 = x_5;
                let _e639 = seen_2;
                param_64 = _e639;
                let _e640 = share_3;
                param_65 = _e640;
                param_66 = (_e637 + 1f);
                let _e642 = next_1.front;
                param_67 = _e642;
                let _e643 = cover((&param_64), (&param_65), (&param_66), (&param_67));
                let _e644 = param_64;
                seen_2 = _e644;
                let _e646 = fronts[1u];
                fronts[1u] = (_e646 + _e643);
            }
            let _e649 = front_front;
            let _e650 = !(_e649);
            phi_1535_ = _e650;
            if _e650 {
                let _e652 = next_1.front;
                let _e654 = here_2.front;
                let _e657 = here_2.split;
                phi_1535_ = ((_e652 < _e654) || _e657);
            }
            let _e660 = phi_1535_;
            let _e661 = front_back;
            let _e664 = a;
            let _e667 = a;
            if (((_e660 && !(_e661)) && (_e664 <= 0f)) && (_e667 > -1f)) {
                let _e670 = a;
                param_68 = -(_e670);
                let _e672 = right_of((&param_68));
                let _e674 = here_2.mask;
                param_69 = _e674;
                param_70 = _e672;
                let _e675 = covered((&param_69), (&param_70));
                let _e676 = seen_2;
                param_71 = _e676;
                param_72 = _e675;
                let _e677 = x_5;
                param_73 = _e677;
                let _e679 = here_2.front;
                param_74 = _e679;
                let _e680 = cover((&param_71), (&param_72), (&param_73), (&param_74));
                let _e681 = param_71;
                seen_2 = _e681;
                let _e683 = fronts[0u];
                fronts[0u] = (_e683 + _e680);
            }
            let _e686 = front_back;
            let _e687 = a;
            let _e690 = d;
            let _e692 = ((_e686 && (_e687 <= 0f)) && (_e690 > 0f));
            phi_1583_ = _e692;
            if _e692 {
                let _e694 = seen_2.rest;
                phi_1583_ = (_e694 > 0.01f);
            }
            let _e697 = phi_1583_;
            if _e697 {
                let _e698 = a;
                let _e700 = d;
                let _e701 = a;
                g_2 = (-(_e698) / (_e700 - _e701));
                let _e704 = x_5;
                let _e705 = g_2;
                let _e707 = seen_2;
                param_75 = _e707;
                param_76 = 1f;
                param_77 = (_e704 + _e705);
                let _e709 = here_2.front;
                param_78 = _e709;
                let _e710 = cover((&param_75), (&param_76), (&param_77), (&param_78));
                let _e711 = param_75;
                seen_2 = _e711;
                taken_1 = _e710;
                let _e712 = taken_1;
                let _e713 = g_2;
                let _e717 = fronts[0u];
                fronts[0u] = (_e717 + (_e712 * (1f - _e713)));
                let _e720 = taken_1;
                let _e721 = g_2;
                let _e724 = backs[1u];
                backs[1u] = (_e724 + (_e720 * _e721));
            }
            let _e727 = back_front;
            let _e728 = c;
            let _e731 = b;
            let _e733 = ((_e727 && (_e728 <= 0f)) && (_e731 > 0f));
            phi_1633_ = _e733;
            if _e733 {
                let _e735 = seen_2.rest;
                phi_1633_ = (_e735 > 0.01f);
            }
            let _e738 = phi_1633_;
            if _e738 {
                let _e739 = c;
                let _e741 = b;
                let _e742 = c;
                g_3 = (-(_e739) / (_e741 - _e742));
                let _e745 = x_5;
                let _e746 = g_3;
                let _e748 = seen_2;
                param_79 = _e748;
                param_80 = 1f;
                param_81 = (_e745 + _e746);
                let _e750 = next_1.front;
                param_82 = _e750;
                let _e751 = cover((&param_79), (&param_80), (&param_81), (&param_82));
                let _e752 = param_79;
                seen_2 = _e752;
                taken_2 = _e751;
                let _e753 = taken_2;
                let _e754 = g_3;
                let _e758 = backs[0u];
                backs[0u] = (_e758 + (_e753 * (1f - _e754)));
                let _e761 = taken_2;
                let _e762 = g_3;
                let _e765 = fronts[1u];
                fronts[1u] = (_e765 + (_e761 * _e762));
            }
            let _e768 = back_back;
            let _e769 = c;
            let _e772 = d;
            let _e774 = ((_e768 && (_e769 <= 0f)) && (_e772 > 0f));
            phi_1683_ = _e774;
            if _e774 {
                let _e776 = seen_2.rest;
                phi_1683_ = (_e776 > 0.01f);
            }
            let _e779 = phi_1683_;
            if _e779 {
                let _e780 = c;
                let _e782 = d;
                let _e783 = c;
                g_4 = (-(_e780) / (_e782 - _e783));
                let _e786 = x_5;
                let _e787 = g_4;
                let _e789 = seen_2;
                param_83 = _e789;
                param_84 = 1f;
                param_85 = (_e786 + _e787);
                let _e791 = here_2.back;
                param_86 = _e791;
                let _e792 = cover((&param_83), (&param_84), (&param_85), (&param_86));
                let _e793 = param_83;
                seen_2 = _e793;
                taken_3 = _e792;
                let _e794 = taken_3;
                let _e795 = g_4;
                let _e797 = g_4;
                let _e800 = backs;
                backs = (_e800 + (vec2<f32>((1f - _e795), _e797) * _e794));
            }
            let _e803 = here_2.split;
            let _e804 = back_front;
            let _e807 = back_back;
            ends = ((_e803 && !(_e804)) && !(_e807));
            let _e810 = ends;
            let _e811 = on_front;
            let _e814 = on_back;
            let _e816 = ((_e810 && !(_e811)) && !(_e814));
            phi_1735_ = _e816;
            if _e816 {
                let _e817 = c;
                phi_1735_ = (abs(_e817) < 1f);
            }
            let _e821 = phi_1735_;
            phi_1741_ = _e821;
            if _e821 {
                let _e823 = seen_2.rest;
                phi_1741_ = (_e823 > 0.01f);
            }
            let _e826 = phi_1741_;
            if _e826 {
                let _e827 = c;
                if (_e827 <= 0f) {
                    let _e829 = c;
                    param_87 = -(_e829);
                    let _e831 = right_of((&param_87));
                    local_9 = _e831;
                } else {
                    let _e832 = c;
                    param_88 = (1f - _e832);
                    let _e834 = right_of((&param_88));
                    local_9 = (vec4(1f) - _e834);
                }
                let _e837 = local_9;
                stripes_1 = _e837;
                let _e839 = here_2.mask;
                param_89 = (vec4(1f) - _e839);
                let _e842 = stripes_1;
                param_90 = _e842;
                let _e843 = covered((&param_89), (&param_90));
                let _e844 = seen_2;
                param_91 = _e844;
                param_92 = _e843;
                let _e845 = x_5;
                param_93 = _e845;
                let _e847 = here_2.back;
                param_94 = _e847;
                let _e848 = cover((&param_91), (&param_92), (&param_93), (&param_94));
                let _e849 = param_91;
                seen_2 = _e849;
                let _e851 = backs[0u];
                backs[0u] = (_e851 + _e848);
            }
            let _e854 = ends;
            phi_1793_ = _e854;
            if _e854 {
                let _e856 = next_1.front;
                let _e858 = here_2.back;
                phi_1793_ = (_e856 > _e858);
            }
            let _e861 = phi_1793_;
            let _e862 = c;
            at_back = (_e861 && (_e862 <= 0f));
            let _e866 = here_2.split;
            let _e868 = front_front;
            let _e871 = front_back;
            let _e873 = ((!(_e866) && !(_e868)) && !(_e871));
            phi_1814_ = _e873;
            if _e873 {
                let _e875 = next_1.front;
                let _e877 = here_2.front;
                phi_1814_ = (_e875 > _e877);
            }
            let _e880 = phi_1814_;
            let _e881 = a;
            at_front = (_e880 && (_e881 <= 0f));
            let _e884 = at_back;
            let _e885 = at_front;
            let _e886 = (_e884 || _e885);
            phi_1826_ = _e886;
            if _e886 {
                let _e888 = seen_2.rest;
                phi_1826_ = (_e888 > 0.01f);
            }
            let _e891 = phi_1826_;
            if _e891 {
                let _e892 = at_back;
                if _e892 {
                    let _e894 = here_2.back;
                    local_10 = _e894;
                } else {
                    let _e896 = here_2.front;
                    local_10 = _e896;
                }
                let _e897 = local_10;
                reach_2 = _e897;
                let _e898 = at_back;
                if _e898 {
                    let _e899 = c;
                    local_11 = -(_e899);
                } else {
                    let _e901 = a;
                    local_11 = -(_e901);
                }
                let _e903 = local_11;
                away = _e903;
                let _e904 = at_back;
                let _e905 = on_front;
                if (_e904 && !(_e905)) {
                    let _e909 = here_2.mask;
                    param_95 = _e909;
                    param_96 = vec4<f32>(1f, 1f, 1f, 1f);
                    let _e910 = covered((&param_95), (&param_96));
                    local_12 = (1f - _e910);
                } else {
                    local_12 = 1f;
                }
                let _e912 = local_12;
                weight = _e912;
                let _e913 = column_6;
                let _e914 = at_back;
                let _e915 = reach_2;
                let _e916 = weight;
                found = Edge(_e913, _e914, _e915, _e916);
                let _e918 = weight;
                let _e920 = away;
                if ((_e918 == 1f) && (_e920 < 0.5f)) {
                    let _e923 = seen_2;
                    param_97 = _e923;
                    param_98 = 1f;
                    let _e924 = x_5;
                    param_99 = _e924;
                    let _e925 = reach_2;
                    param_100 = _e925;
                    let _e926 = cover((&param_97), (&param_98), (&param_99), (&param_100));
                    let _e927 = param_97;
                    seen_2 = _e927;
                    taken_4 = _e926;
                    let _e928 = at_back;
                    let _e929 = taken_4;
                    let _e932 = backs[0u];
                    backs[0u] = (_e932 + select(0f, _e929, _e928));
                    let _e935 = at_back;
                    let _e936 = taken_4;
                    let _e939 = fronts[0u];
                    fronts[0u] = (_e939 + select(_e936, 0f, _e935));
                }
                let _e942 = reach_2;
                let _e944 = edge.reach;
                if (_e942 < _e944) {
                    let _e946 = weight;
                    if (_e946 < 1f) {
                        let _e948 = edge;
                        second = _e948;
                    }
                    let _e949 = found;
                    edge = _e949;
                    let _e951 = next_1.front;
                    beside = _e951;
                } else {
                    let _e952 = reach_2;
                    let _e954 = second.reach;
                    if (_e952 < _e954) {
                        let _e956 = found;
                        second = _e956;
                    }
                }
            }
            let _e958 = fronts[0u];
            let _e960 = backs[0u];
            if (max(_e958, _e960) > 0f) {
                let _e963 = column_6;
                param_101 = _e963;
                let _e964 = row_7;
                param_102 = _e964;
                let _e966 = fronts[0u];
                param_103 = _e966;
                let _e968 = backs[0u];
                param_104 = _e968;
                let _e969 = weighted((&param_101), (&param_102), (&param_103), (&param_104));
                let _e970 = color_1;
                color_1 = (_e970 + _e969);
            }
            let _e973 = fronts[1u];
            let _e975 = backs[1u];
            if (max(_e973, _e975) > 0f) {
                let _e978 = column_6;
                let _e979 = sense;
                param_105 = (_e978 + _e979);
                let _e981 = row_7;
                param_106 = _e981;
                let _e983 = fronts[1u];
                param_107 = _e983;
                let _e985 = backs[1u];
                param_108 = _e985;
                let _e986 = weighted((&param_105), (&param_106), (&param_107), (&param_108));
                let _e987 = color_1;
                color_1 = (_e987 + _e986);
            }
            let _e989 = front_back;
            on_front = _e989;
            let _e990 = back_back;
            on_back = _e990;
            let _e991 = next_1;
            here_2 = _e991;
            let _e992 = sense;
            let _e993 = column_6;
            column_6 = (_e993 + _e992);
            let _e995 = x_5;
            x_5 = (_e995 + 1f);
            continue;
        } else {
            break;
        }
    }
    let _e998 = seen_2.rest;
    hole = (_e998 > 0.5f);
    let _e1001 = seen_2.rest;
    if (_e1001 > 0.01f) {
        let _e1004 = edge.column;
        beyond = (_e1004 < 0i);
        let _e1006 = beyond;
        if _e1006 {
            let _e1007 = column_6;
            let _e1009 = here_2.split;
            let _e1011 = here_2.split;
            if _e1011 {
                let _e1013 = here_2.back;
                local_13 = _e1013;
            } else {
                let _e1015 = here_2.front;
                local_13 = _e1015;
            }
            let _e1016 = local_13;
            edge = Edge(_e1007, _e1009, _e1016, 1f);
        }
        let _e1019 = edge.column;
        param_109 = _e1019;
        let _e1020 = source_column((&param_109));
        edge_x = f32(_e1020);
        let _e1022 = t;
        let _e1023 = edge_x;
        let _e1026 = edge.reach;
        away_1 = abs(((_e1022 - _e1023) - _e1026));
        let _e1029 = away_1;
        spread = (0.5f * clamp(_e1029, 1f, 12f));
        sum_1 = vec4<f32>(0f, 0f, 0f, 0f);
        weights = 0f;
        let _e1032 = beyond;
        let _e1033 = away_1;
        rows_1 = select(2i, 0i, (_e1032 && (_e1033 < 0.5f)));
        let _e1037 = rows_1;
        i_2 = -(_e1037);
        loop {
            let _e1039 = i_2;
            let _e1040 = rows_1;
            if (_e1039 <= _e1040) {
                let _e1042 = row_7;
                let _e1043 = i_2;
                let _e1045 = spread;
                let _e1052 = synthesis.source_size[1u];
                at_1 = clamp((_e1042 + i32(round((f32(_e1043) * _e1045)))), 0i, (_e1052 - 1i));
                let _e1056 = edge.column;
                param_110 = _e1056;
                let _e1057 = at_1;
                param_111 = _e1057;
                let _e1058 = layer_at((&param_110), (&param_111));
                layer_3 = _e1058;
                let _e1059 = i_2;
                if (_e1059 == 0i) {
                    let _e1062 = edge.back;
                    local_14 = !(_e1062);
                } else {
                    let _e1065 = layer_3.front;
                    let _e1067 = edge.reach;
                    local_14 = (_e1065 <= (_e1067 + 1f));
                }
                let _e1070 = local_14;
                front_3 = _e1070;
                let _e1071 = i_2;
                if (_e1071 == 0i) {
                    let _e1074 = edge.back;
                    local_15 = _e1074;
                } else {
                    let _e1075 = front_3;
                    let _e1078 = layer_3.split;
                    let _e1079 = (!(_e1075) && _e1078);
                    phi_2106_ = _e1079;
                    if _e1079 {
                        let _e1081 = layer_3.back;
                        let _e1083 = edge.reach;
                        phi_2106_ = (_e1081 <= (_e1083 + 1f));
                    }
                    let _e1087 = phi_2106_;
                    local_15 = _e1087;
                }
                let _e1088 = local_15;
                behind_2 = _e1088;
                let _e1089 = i_2;
                if (_e1089 == 0i) {
                    local_16 = 2f;
                } else {
                    let _e1091 = front_3;
                    if _e1091 {
                        local_17 = 1f;
                    } else {
                        let _e1092 = behind_2;
                        if _e1092 {
                            let _e1094 = layer_3.mask;
                            param_112 = _e1094;
                            param_113 = vec4<f32>(1f, 1f, 1f, 1f);
                            let _e1095 = covered((&param_112), (&param_113));
                            local_18 = (1f - _e1095);
                        } else {
                            local_18 = 0f;
                        }
                        let _e1097 = local_18;
                        local_17 = _e1097;
                    }
                    let _e1098 = local_17;
                    local_16 = _e1098;
                }
                let _e1099 = local_16;
                weight_1 = _e1099;
                let _e1100 = front_3;
                let _e1101 = weight_1;
                let _e1103 = front_3;
                let _e1104 = weight_1;
                let _e1107 = edge.column;
                param_114 = _e1107;
                let _e1108 = at_1;
                param_115 = _e1108;
                param_116 = select(0f, _e1101, _e1100);
                param_117 = select(_e1104, 0f, _e1103);
                let _e1109 = weighted((&param_114), (&param_115), (&param_116), (&param_117));
                let _e1110 = sum_1;
                sum_1 = (_e1110 + _e1109);
                let _e1112 = weight_1;
                let _e1113 = weights;
                weights = (_e1113 + _e1112);
                continue;
            } else {
                break;
            }
            continuing {
                let _e1115 = i_2;
                i_2 = (_e1115 + 1i);
            }
        }
        let _e1117 = sum_1;
        let _e1118 = weights;
        fill = (_e1117 / vec4(_e1118));
        let _e1122 = second.column;
        let _e1123 = (_e1122 >= 0i);
        phi_2168_ = _e1123;
        if _e1123 {
            let _e1125 = edge.weight;
            phi_2168_ = (_e1125 < 1f);
        }
        let _e1128 = phi_2168_;
        if _e1128 {
            let _e1130 = second.back;
            one = select(vec2<f32>(1f, 0f), vec2<f32>(0f, 1f), vec2(_e1130));
            let _e1134 = second.column;
            param_118 = _e1134;
            let _e1135 = row_7;
            param_119 = _e1135;
            let _e1137 = one[0u];
            param_120 = _e1137;
            let _e1139 = one[1u];
            param_121 = _e1139;
            let _e1140 = weighted((&param_118), (&param_119), (&param_120), (&param_121));
            let _e1141 = fill;
            let _e1143 = edge.weight;
            fill = mix(_e1140, _e1141, vec4(_e1143));
        }
        let _e1146 = hole;
        let _e1147 = away_1;
        hole = (_e1146 && (_e1147 >= 0.5f));
        let _e1151 = edge.reach;
        let _e1152 = far_nearness();
        let _e1156 = synthesis.law[1u];
        depth_1 = ((_e1151 + _e1152) / _e1156);
        let _e1160 = synthesis.origins[0u];
        let _e1162 = gl_FragCoord_1[0u];
        let _e1166 = synthesis.origins[1u];
        origin_1 = ((_e1160 * _e1162) + _e1166);
        let _e1168 = away_1;
        let _e1169 = (_e1168 >= 0.5f);
        phi_2243_ = _e1169;
        if _e1169 {
            let _e1170 = gl_FragCoord_1;
            let _e1173 = synthesis.target_origin;
            let _e1176 = beside;
            let _e1177 = far_nearness();
            param_122 = (_e1170.xy - vec2<f32>(_e1173));
            param_123 = (_e1176 + _e1177);
            let _e1179 = origin_1;
            param_124 = _e1179;
            let _e1180 = row_7;
            param_125 = _e1180;
            let _e1181 = fill;
            param_126 = _e1181;
            let _e1182 = depth_1;
            param_127 = _e1182;
            let _e1183 = recall((&param_122), (&param_123), (&param_124), (&param_125), (&param_126), (&param_127));
            let _e1184 = param_126;
            fill = _e1184;
            let _e1185 = param_127;
            depth_1 = _e1185;
            phi_2243_ = _e1183;
        }
        let _e1187 = phi_2243_;
        if _e1187 {
            let _e1190 = synthesis.law[1u];
            let _e1191 = depth_1;
            let _e1193 = far_nearness();
            edge.reach = ((_e1190 * _e1191) - _e1193);
        }
        let _e1196 = seen_2;
        param_128 = _e1196;
        param_129 = 1f;
        let _e1197 = edge_x;
        param_130 = _e1197;
        let _e1199 = edge.reach;
        param_131 = _e1199;
        let _e1200 = cover((&param_128), (&param_129), (&param_130), (&param_131));
        let _e1201 = param_128;
        seen_2 = _e1201;
        let _e1202 = fill;
        let _e1204 = color_1;
        color_1 = (_e1204 + (_e1202 * _e1200));
    }
    return;
}

@fragment 
fn main(@location(0) span_at: vec2<f32>, @builtin(position) gl_FragCoord: vec4<f32>) -> @location(0) vec4<f32> {
    span_at_1 = span_at;
    gl_FragCoord_1 = gl_FragCoord;
    main_1();
    let _e5 = color_1;
    return _e5;
}
