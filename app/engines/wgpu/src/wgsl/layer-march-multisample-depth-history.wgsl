// Made of yoro's GLSL by `cargo tools wgsl`.
struct Layer {
    front: f32,
    back: f32,
    split: bool,
    code: u32,
}

struct Seen {
    rest: f32,
    column: f32,
    reach: f32,
    hole: bool,
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
    var phi_488_: bool;
    var phi_503_: bool;
    var phi_632_: bool;
    var phi_711_: bool;

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
    phi_488_ = _e119;
    if _e119 {
        let _e120 = guess;
        let _e121 = size;
        phi_488_ = all((_e120 < _e121));
    }
    let _e125 = phi_488_;
    inside = _e125;
    let _e127 = seen[3u];
    let _e129 = inside;
    let _e130 = ((_e127 > 0f) && _e129);
    phi_503_ = _e130;
    if _e130 {
        let _e132 = guess[1u];
        let _e133 = rows;
        let _e136 = strip;
        phi_503_ = (i32((_e132 / _e133)) == _e136);
    }
    let _e139 = phi_503_;
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
    phi_632_ = _e238;
    if !(_e238) {
        let _e240 = before;
        let _e241 = nearness;
        phi_632_ = (_e240 > (_e241 - 1f));
    }
    let _e245 = phi_632_;
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
            phi_711_ = _e292;
            if _e292 {
                let _e295 = synthesis.law[1u];
                let _e296 = texel;
                let _e297 = textureLoad(history_depth_texture, _e296, 0i);
                let _e299 = stored;
                phi_711_ = (abs((_e295 * (_e297.x - _e299))) < 1f);
            }
            let _e305 = phi_711_;
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

fn cover(seen_1: ptr<function, Seen>, share_1: ptr<function, f32>, column_3: ptr<function, f32>, reach_1: ptr<function, f32>) -> f32 {
    var taken: f32;
    var passes: bool;
    var local_6: f32;
    var local_7: f32;
    var phi_950_: bool;

    let _e10 = (*seen_1).rest;
    let _e11 = (*share_1);
    taken = (_e10 * _e11);
    let _e14 = (*seen_1).rest;
    let _e15 = (_e14 > 0.5f);
    phi_950_ = _e15;
    if _e15 {
        let _e17 = (*seen_1).rest;
        let _e18 = taken;
        phi_950_ = ((_e17 - _e18) <= 0.5f);
    }
    let _e22 = phi_950_;
    passes = _e22;
    let _e23 = passes;
    if _e23 {
        let _e24 = (*column_3);
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

fn covered(mask: ptr<function, vec4<f32>>, stripes: ptr<function, vec4<f32>>) -> f32 {
    let _e3 = (*mask);
    let _e4 = (*stripes);
    return (0.25f * dot(_e3, _e4));
}

fn right_of(place_1: ptr<function, f32>) -> vec4<f32> {
    let _e5 = (*place_1);
    return clamp((vec4<f32>(1f, 2f, 3f, 4f) - vec4((4f * _e5))), vec4(0f), vec4(1f));
}

fn mask_of(layer_3: ptr<function, Layer>, column_4: ptr<function, i32>, row_4: ptr<function, i32>) -> vec4<f32> {
    let _e5 = (*layer_3).split;
    if !(_e5) {
        return vec4<f32>(1f, 1f, 1f, 1f);
    }
    let _e8 = (*layer_3).code;
    return vec4<f32>(((vec4(_e8) >> bitcast<vec4<u32>>(vec4<u32>(0u, 1u, 2u, 3u))) & vec4(1u)));
}

fn layer_at(column_5: ptr<function, i32>, row_5: ptr<function, i32>) -> Layer {
    var bits_1: u32;
    var param_11: i32;
    var param_12: i32;
    var both: vec2<f32>;
    var param_13: u32;
    var split: bool;
    var param_14: u32;
    var local_8: f32;
    var param_15: u32;
    var local_9: f32;

    let _e16 = (*column_5);
    param_11 = _e16;
    let _e17 = (*row_5);
    param_12 = _e17;
    let _e18 = layer_bits((&param_11), (&param_12));
    bits_1 = _e18;
    let _e19 = bits_1;
    param_13 = _e19;
    let _e20 = split_displacements((&param_13));
    both = _e20;
    let _e21 = bits_1;
    param_14 = _e21;
    let _e22 = is_full((&param_14));
    split = !(_e22);
    let _e24 = split;
    if _e24 {
        let _e26 = both[0u];
        local_8 = _e26;
    } else {
        let _e27 = bits_1;
        param_15 = _e27;
        let _e28 = full_front((&param_15));
        local_8 = _e28;
    }
    let _e29 = local_8;
    let _e30 = split;
    if _e30 {
        let _e32 = both[1u];
        local_9 = _e32;
    } else {
        local_9 = 1000000000f;
    }
    let _e33 = local_9;
    let _e34 = split;
    let _e35 = bits_1;
    return Layer(_e29, _e33, _e34, (_e35 >> bitcast<u32>(28i)));
}

fn composed(row_6: ptr<function, i32>, t: ptr<function, f32>, x_3: ptr<function, f32>, limit: ptr<function, f32>, column_6: ptr<function, i32>, seen_2: ptr<function, Seen>) -> vec4<f32> {
    var sense: i32;
    var color_sum: vec4<f32>;
    var here_1: Layer;
    var param_16: i32;
    var param_17: i32;
    var edge: Edge;
    var second: Edge;
    var beside: f32;
    var on_front: bool;
    var on_back: bool;
    var before_1: Layer;
    var param_18: i32;
    var param_19: i32;
    var next: Layer;
    var a: f32;
    var b: f32;
    var c: f32;
    var d: f32;
    var front_front: bool;
    var front_back: bool;
    var back_front: bool;
    var back_back: bool;
    var event: bool;
    var param_20: i32;
    var param_21: i32;
    var crosses: bool;
    var front_begins: bool;
    var front_ends: bool;
    var back_ends: bool;
    var here_mask: vec4<f32>;
    var param_22: Layer;
    var param_23: i32;
    var param_24: i32;
    var next_mask: vec4<f32>;
    var param_25: Layer;
    var param_26: i32;
    var param_27: i32;
    var fronts: vec2<f32>;
    var backs: vec2<f32>;
    var g: f32;
    var right: vec4<f32>;
    var param_28: f32;
    var shares: vec2<f32>;
    var param_29: vec4<f32>;
    var param_30: vec4<f32>;
    var param_31: vec4<f32>;
    var param_32: vec4<f32>;
    var share_2: f32;
    var param_33: Seen;
    var param_34: f32;
    var param_35: f32;
    var param_36: f32;
    var share_3: f32;
    var param_37: f32;
    var param_38: vec4<f32>;
    var param_39: vec4<f32>;
    var param_40: Seen;
    var param_41: f32;
    var param_42: f32;
    var param_43: f32;
    var param_44: f32;
    var param_45: vec4<f32>;
    var param_46: vec4<f32>;
    var param_47: Seen;
    var param_48: f32;
    var param_49: f32;
    var param_50: f32;
    var g_1: f32;
    var taken_1: f32;
    var param_51: Seen;
    var param_52: f32;
    var param_53: f32;
    var param_54: f32;
    var g_2: f32;
    var taken_2: f32;
    var param_55: Seen;
    var param_56: f32;
    var param_57: f32;
    var param_58: f32;
    var g_3: f32;
    var taken_3: f32;
    var param_59: Seen;
    var param_60: f32;
    var param_61: f32;
    var param_62: f32;
    var ends: bool;
    var stripes_1: vec4<f32>;
    var local_10: vec4<f32>;
    var param_63: f32;
    var param_64: f32;
    var param_65: vec4<f32>;
    var param_66: vec4<f32>;
    var param_67: Seen;
    var param_68: f32;
    var param_69: f32;
    var param_70: f32;
    var at_back: bool;
    var at_front: bool;
    var reach_2: f32;
    var local_11: f32;
    var away: f32;
    var local_12: f32;
    var weight: f32;
    var local_13: f32;
    var param_71: vec4<f32>;
    var param_72: vec4<f32>;
    var found: Edge;
    var taken_4: f32;
    var param_73: Seen;
    var param_74: f32;
    var param_75: f32;
    var param_76: f32;
    var param_77: i32;
    var param_78: i32;
    var param_79: f32;
    var param_80: f32;
    var param_81: i32;
    var param_82: i32;
    var param_83: f32;
    var param_84: f32;
    var beyond: bool;
    var local_14: f32;
    var edge_x: f32;
    var param_85: i32;
    var away_1: f32;
    var spread: f32;
    var sum: vec4<f32>;
    var weights: f32;
    var rows_1: i32;
    var i_2: i32;
    var at: i32;
    var layer_4: Layer;
    var param_86: i32;
    var param_87: i32;
    var front_2: bool;
    var local_15: bool;
    var behind_2: bool;
    var local_16: bool;
    var weight_1: f32;
    var local_17: f32;
    var local_18: f32;
    var local_19: f32;
    var param_88: Layer;
    var param_89: i32;
    var param_90: i32;
    var param_91: vec4<f32>;
    var param_92: vec4<f32>;
    var param_93: i32;
    var param_94: i32;
    var param_95: f32;
    var param_96: f32;
    var fill: vec4<f32>;
    var one: vec2<f32>;
    var param_97: i32;
    var param_98: i32;
    var param_99: f32;
    var param_100: f32;
    var depth_1: f32;
    var origin_1: f32;
    var param_101: vec2<f32>;
    var param_102: f32;
    var param_103: f32;
    var param_104: i32;
    var param_105: vec4<f32>;
    var param_106: f32;
    var param_107: Seen;
    var param_108: f32;
    var param_109: f32;
    var param_110: f32;
    var phi_1023_: bool;
    var phi_1030_: bool;
    var phi_1072_: bool;
    var phi_1086_: bool;
    var phi_1174_: bool;
    var phi_1191_: bool;
    var phi_1192_: bool;
    var phi_1211_: bool;
    var phi_1212_: bool;
    var phi_1213_: bool;
    var phi_1248_: bool;
    var phi_1249_: bool;
    var phi_1271_: bool;
    var phi_1272_: bool;
    var phi_1392_: bool;
    var phi_1443_: bool;
    var phi_1489_: bool;
    var phi_1539_: bool;
    var phi_1589_: bool;
    var phi_1641_: bool;
    var phi_1647_: bool;
    var phi_1698_: bool;
    var phi_1719_: bool;
    var phi_1731_: bool;
    var phi_2010_: bool;
    var phi_2078_: bool;
    var phi_2159_: bool;

    let _e201 = synthesis.mirrored;
    sense = select(1i, -1i, (_e201 != 0u));
    color_sum = vec4<f32>(0f, 0f, 0f, 0f);
    let _e204 = (*column_6);
    param_16 = _e204;
    let _e205 = (*row_6);
    param_17 = _e205;
    let _e206 = layer_at((&param_16), (&param_17));
    here_1 = _e206;
    edge = Edge(-1i, false, 1000000000f, 1f);
    let _e207 = edge;
    second = _e207;
    beside = 1000000000f;
    let _e208 = (*x_3);
    if (_e208 == 0f) {
        let _e211 = here_1.front;
        let _e212 = (*t);
        if (_e211 > _e212) {
            let _e214 = (*column_6);
            let _e216 = here_1.front;
            edge = Edge(_e214, false, _e216, 1f);
        }
        let _e219 = here_1.split;
        phi_1023_ = _e219;
        if _e219 {
            let _e221 = here_1.back;
            let _e223 = edge.reach;
            phi_1023_ = (_e221 < _e223);
        }
        let _e226 = phi_1023_;
        phi_1030_ = _e226;
        if _e226 {
            let _e228 = here_1.back;
            let _e229 = (*t);
            phi_1030_ = (_e228 > _e229);
        }
        let _e232 = phi_1030_;
        if _e232 {
            let _e233 = (*column_6);
            let _e235 = here_1.back;
            edge = Edge(_e233, true, _e235, 1f);
        }
    }
    on_front = false;
    on_back = false;
    let _e237 = (*x_3);
    let _e240 = here_1.split;
    if ((_e237 > 0f) && _e240) {
        let _e242 = (*column_6);
        let _e243 = sense;
        param_18 = (_e242 - _e243);
        let _e245 = (*row_6);
        param_19 = _e245;
        let _e246 = layer_at((&param_18), (&param_19));
        before_1 = _e246;
        let _e248 = before_1.front;
        let _e250 = here_1.back;
        on_front = (abs((_e248 - _e250)) < 0.5f);
        let _e255 = before_1.split;
        phi_1072_ = _e255;
        if _e255 {
            let _e257 = before_1.back;
            let _e259 = here_1.back;
            phi_1072_ = (abs((_e257 - _e259)) < 0.5f);
        }
        let _e264 = phi_1072_;
        on_back = _e264;
    }
    loop {
        let _e265 = (*x_3);
        let _e266 = (*limit);
        let _e267 = (_e265 < _e266);
        phi_1086_ = _e267;
        if _e267 {
            let _e269 = (*seen_2).rest;
            phi_1086_ = (_e269 > 0.01f);
        }
        let _e272 = phi_1086_;
        if _e272 {
            let _e273 = here_1;
            next = _e273;
            a = 0f;
            b = 0f;
            c = 0f;
            d = 0f;
            front_front = false;
            front_back = false;
            back_front = false;
            back_back = false;
            event = false;
            loop {
                let _e274 = event;
                let _e276 = (*x_3);
                let _e277 = (*limit);
                if (!(_e274) && (_e276 < _e277)) {
                    let _e280 = (*column_6);
                    let _e281 = sense;
                    param_20 = (_e280 + _e281);
                    let _e283 = (*row_6);
                    param_21 = _e283;
                    let _e284 = layer_at((&param_20), (&param_21));
                    next = _e284;
                    let _e285 = (*x_3);
                    let _e287 = here_1.front;
                    let _e289 = (*t);
                    a = ((_e285 + _e287) - _e289);
                    let _e291 = (*x_3);
                    let _e294 = next.front;
                    let _e296 = (*t);
                    b = (((_e291 + 1f) + _e294) - _e296);
                    let _e298 = (*x_3);
                    let _e300 = here_1.back;
                    let _e302 = (*t);
                    c = ((_e298 + _e300) - _e302);
                    let _e304 = (*x_3);
                    let _e307 = next.back;
                    let _e309 = (*t);
                    d = (((_e304 + 1f) + _e307) - _e309);
                    let _e312 = next.front;
                    let _e314 = here_1.front;
                    front_front = (abs((_e312 - _e314)) < 0.5f);
                    let _e319 = next.back;
                    let _e321 = here_1.front;
                    front_back = (abs((_e319 - _e321)) < 0.5f);
                    let _e326 = next.front;
                    let _e328 = here_1.back;
                    back_front = (abs((_e326 - _e328)) < 0.5f);
                    let _e333 = here_1.split;
                    phi_1174_ = _e333;
                    if _e333 {
                        let _e335 = next.back;
                        let _e337 = here_1.back;
                        phi_1174_ = (abs((_e335 - _e337)) < 0.5f);
                    }
                    let _e342 = phi_1174_;
                    back_back = _e342;
                    let _e343 = a;
                    let _e344 = (_e343 <= 0f);
                    phi_1192_ = _e344;
                    if _e344 {
                        let _e345 = front_front;
                        let _e346 = b;
                        let _e348 = (_e345 && (_e346 > 0f));
                        phi_1191_ = _e348;
                        if !(_e348) {
                            let _e350 = front_back;
                            let _e351 = d;
                            phi_1191_ = (_e350 && (_e351 > 0f));
                        }
                        let _e355 = phi_1191_;
                        phi_1192_ = _e355;
                    }
                    let _e357 = phi_1192_;
                    phi_1213_ = _e357;
                    if !(_e357) {
                        let _e359 = c;
                        let _e360 = (_e359 <= 0f);
                        phi_1212_ = _e360;
                        if _e360 {
                            let _e361 = back_front;
                            let _e362 = b;
                            let _e364 = (_e361 && (_e362 > 0f));
                            phi_1211_ = _e364;
                            if !(_e364) {
                                let _e366 = back_back;
                                let _e367 = d;
                                phi_1211_ = (_e366 && (_e367 > 0f));
                            }
                            let _e371 = phi_1211_;
                            phi_1212_ = _e371;
                        }
                        let _e373 = phi_1212_;
                        phi_1213_ = _e373;
                    }
                    let _e375 = phi_1213_;
                    crosses = _e375;
                    let _e376 = front_front;
                    let _e378 = back_front;
                    let _e381 = b;
                    let _e384 = b;
                    front_begins = (((!(_e376) && !(_e378)) && (_e381 > 0f)) && (_e384 < 1f));
                    let _e387 = front_front;
                    let _e389 = front_back;
                    let _e392 = a;
                    let _e394 = ((!(_e387) && !(_e389)) && (_e392 <= 0f));
                    phi_1249_ = _e394;
                    if _e394 {
                        let _e395 = a;
                        let _e396 = (_e395 > -1f);
                        phi_1248_ = _e396;
                        if !(_e396) {
                            let _e399 = next.front;
                            let _e401 = here_1.front;
                            phi_1248_ = (_e399 > _e401);
                        }
                        let _e404 = phi_1248_;
                        phi_1249_ = _e404;
                    }
                    let _e406 = phi_1249_;
                    front_ends = _e406;
                    let _e407 = back_front;
                    let _e409 = back_back;
                    let _e412 = c;
                    let _e414 = ((!(_e407) && !(_e409)) && (_e412 < 1f));
                    phi_1272_ = _e414;
                    if _e414 {
                        let _e415 = c;
                        let _e416 = (_e415 > -1f);
                        phi_1271_ = _e416;
                        if !(_e416) {
                            let _e419 = next.front;
                            let _e421 = here_1.back;
                            phi_1271_ = (_e419 > _e421);
                        }
                        let _e424 = phi_1271_;
                        phi_1272_ = _e424;
                    }
                    let _e426 = phi_1272_;
                    back_ends = _e426;
                    let _e427 = crosses;
                    let _e428 = front_begins;
                    let _e430 = front_ends;
                    let _e432 = back_ends;
                    event = (((_e427 || _e428) || _e430) || _e432);
                    let _e434 = event;
                    if !(_e434) {
                        let _e436 = (*x_3);
                        (*x_3) = (_e436 + 1f);
                        let _e438 = sense;
                        let _e439 = (*column_6);
                        (*column_6) = (_e439 + _e438);
                        let _e441 = next;
                        here_1 = _e441;
                        let _e442 = front_back;
                        on_front = _e442;
                        let _e443 = back_back;
                        on_back = _e443;
                    }
                    continue;
                } else {
                    break;
                }
            }
            let _e444 = event;
            if !(_e444) {
                break;
            }
            let _e446 = here_1;
            param_22 = _e446;
            let _e447 = (*column_6);
            param_23 = _e447;
            let _e448 = (*row_6);
            param_24 = _e448;
            let _e449 = mask_of((&param_22), (&param_23), (&param_24));
            here_mask = _e449;
            let _e450 = (*column_6);
            let _e451 = sense;
            let _e453 = next;
            param_25 = _e453;
            param_26 = (_e450 + _e451);
            let _e454 = (*row_6);
            param_27 = _e454;
            let _e455 = mask_of((&param_25), (&param_26), (&param_27));
            next_mask = _e455;
            fronts = vec2<f32>(0f, 0f);
            backs = vec2<f32>(0f, 0f);
            let _e456 = front_front;
            let _e457 = a;
            let _e460 = b;
            if ((_e456 && (_e457 <= 0f)) && (_e460 > 0f)) {
                let _e463 = a;
                let _e465 = b;
                let _e466 = a;
                g = (-(_e463) / (_e465 - _e466));
                let _e469 = g;
                param_28 = _e469;
                let _e470 = right_of((&param_28));
                right = _e470;
                let _e471 = here_mask;
                param_29 = _e471;
                let _e472 = right;
                param_30 = _e472;
                let _e473 = covered((&param_29), (&param_30));
                let _e474 = right;
                let _e477 = next_mask;
                param_31 = _e477;
                param_32 = (vec4(1f) - _e474);
                let _e478 = covered((&param_31), (&param_32));
                shares = vec2<f32>(_e473, _e478);
                let _e481 = shares[0u];
                let _e483 = shares[1u];
                share_2 = (_e481 + _e483);
                let _e485 = (*x_3);
                let _e486 = g;
                let _e489 = here_1.front;
                let _e491 = next.front;
                let _e492 = g;
                let _e494 = (*seen_2);
                param_33 = _e494;
                let _e495 = share_2;
                param_34 = _e495;
                param_35 = (_e485 + _e486);
                param_36 = mix(_e489, _e491, _e492);
                let _e496 = cover((&param_33), (&param_34), (&param_35), (&param_36));
                let _e497 = param_33;
                (*seen_2) = _e497;
                let _e498 = shares;
                let _e500 = share_2;
                fronts = ((_e498 * _e496) / vec2(max(_e500, 0.000001f)));
            }
            let _e504 = front_front;
            let _e505 = !(_e504);
            phi_1392_ = _e505;
            if _e505 {
                let _e507 = next.front;
                let _e509 = here_1.front;
                let _e512 = next.split;
                phi_1392_ = ((_e507 > _e509) || _e512);
            }
            let _e515 = phi_1392_;
            let _e516 = back_front;
            let _e519 = b;
            let _e522 = b;
            if (((_e515 && !(_e516)) && (_e519 > 0f)) && (_e522 < 1f)) {
                let _e525 = b;
                param_37 = (1f - _e525);
                let _e527 = right_of((&param_37));
                let _e530 = next_mask;
                param_38 = _e530;
                param_39 = (vec4(1f) - _e527);
                let _e531 = covered((&param_38), (&param_39));
                share_3 = _e531;
                let _e532 = (*x_3);
                let _e534 = (*seen_2);
                param_40 = _e534;
                let _e535 = share_3;
                param_41 = _e535;
                param_42 = (_e532 + 1f);
                let _e537 = next.front;
                param_43 = _e537;
                let _e538 = cover((&param_40), (&param_41), (&param_42), (&param_43));
                let _e539 = param_40;
                (*seen_2) = _e539;
                let _e541 = fronts[1u];
                fronts[1u] = (_e541 + _e538);
            }
            let _e544 = front_front;
            let _e545 = !(_e544);
            phi_1443_ = _e545;
            if _e545 {
                let _e547 = next.front;
                let _e549 = here_1.front;
                let _e552 = here_1.split;
                phi_1443_ = ((_e547 < _e549) || _e552);
            }
            let _e555 = phi_1443_;
            let _e556 = front_back;
            let _e559 = a;
            let _e562 = a;
            if (((_e555 && !(_e556)) && (_e559 <= 0f)) && (_e562 > -1f)) {
                let _e565 = a;
                param_44 = -(_e565);
                let _e567 = right_of((&param_44));
                let _e568 = here_mask;
                param_45 = _e568;
                param_46 = _e567;
                let _e569 = covered((&param_45), (&param_46));
                let _e570 = (*seen_2);
                param_47 = _e570;
                param_48 = _e569;
                let _e571 = (*x_3);
                param_49 = _e571;
                let _e573 = here_1.front;
                param_50 = _e573;
                let _e574 = cover((&param_47), (&param_48), (&param_49), (&param_50));
                let _e575 = param_47;
                (*seen_2) = _e575;
                let _e577 = fronts[0u];
                fronts[0u] = (_e577 + _e574);
            }
            let _e580 = front_back;
            let _e581 = a;
            let _e584 = d;
            let _e586 = ((_e580 && (_e581 <= 0f)) && (_e584 > 0f));
            phi_1489_ = _e586;
            if _e586 {
                let _e588 = (*seen_2).rest;
                phi_1489_ = (_e588 > 0.01f);
            }
            let _e591 = phi_1489_;
            if _e591 {
                let _e592 = a;
                let _e594 = d;
                let _e595 = a;
                g_1 = (-(_e592) / (_e594 - _e595));
                let _e598 = (*x_3);
                let _e599 = g_1;
                let _e601 = (*seen_2);
                param_51 = _e601;
                param_52 = 1f;
                param_53 = (_e598 + _e599);
                let _e603 = here_1.front;
                param_54 = _e603;
                let _e604 = cover((&param_51), (&param_52), (&param_53), (&param_54));
                let _e605 = param_51;
                (*seen_2) = _e605;
                taken_1 = _e604;
                let _e606 = taken_1;
                let _e607 = g_1;
                let _e611 = fronts[0u];
                fronts[0u] = (_e611 + (_e606 * (1f - _e607)));
                let _e614 = taken_1;
                let _e615 = g_1;
                let _e618 = backs[1u];
                backs[1u] = (_e618 + (_e614 * _e615));
            }
            let _e621 = back_front;
            let _e622 = c;
            let _e625 = b;
            let _e627 = ((_e621 && (_e622 <= 0f)) && (_e625 > 0f));
            phi_1539_ = _e627;
            if _e627 {
                let _e629 = (*seen_2).rest;
                phi_1539_ = (_e629 > 0.01f);
            }
            let _e632 = phi_1539_;
            if _e632 {
                let _e633 = c;
                let _e635 = b;
                let _e636 = c;
                g_2 = (-(_e633) / (_e635 - _e636));
                let _e639 = (*x_3);
                let _e640 = g_2;
                let _e642 = (*seen_2);
                param_55 = _e642;
                param_56 = 1f;
                param_57 = (_e639 + _e640);
                let _e644 = next.front;
                param_58 = _e644;
                let _e645 = cover((&param_55), (&param_56), (&param_57), (&param_58));
                let _e646 = param_55;
                (*seen_2) = _e646;
                taken_2 = _e645;
                let _e647 = taken_2;
                let _e648 = g_2;
                let _e652 = backs[0u];
                backs[0u] = (_e652 + (_e647 * (1f - _e648)));
                let _e655 = taken_2;
                let _e656 = g_2;
                let _e659 = fronts[1u];
                fronts[1u] = (_e659 + (_e655 * _e656));
            }
            let _e662 = back_back;
            let _e663 = c;
            let _e666 = d;
            let _e668 = ((_e662 && (_e663 <= 0f)) && (_e666 > 0f));
            phi_1589_ = _e668;
            if _e668 {
                let _e670 = (*seen_2).rest;
                phi_1589_ = (_e670 > 0.01f);
            }
            let _e673 = phi_1589_;
            if _e673 {
                let _e674 = c;
                let _e676 = d;
                let _e677 = c;
                g_3 = (-(_e674) / (_e676 - _e677));
                let _e680 = (*x_3);
                let _e681 = g_3;
                let _e683 = (*seen_2);
                param_59 = _e683;
                param_60 = 1f;
                param_61 = (_e680 + _e681);
                let _e685 = here_1.back;
                param_62 = _e685;
                let _e686 = cover((&param_59), (&param_60), (&param_61), (&param_62));
                let _e687 = param_59;
                (*seen_2) = _e687;
                taken_3 = _e686;
                let _e688 = taken_3;
                let _e689 = g_3;
                let _e691 = g_3;
                let _e694 = backs;
                backs = (_e694 + (vec2<f32>((1f - _e689), _e691) * _e688));
            }
            let _e697 = here_1.split;
            let _e698 = back_front;
            let _e701 = back_back;
            ends = ((_e697 && !(_e698)) && !(_e701));
            let _e704 = ends;
            let _e705 = on_front;
            let _e708 = on_back;
            let _e710 = ((_e704 && !(_e705)) && !(_e708));
            phi_1641_ = _e710;
            if _e710 {
                let _e711 = c;
                phi_1641_ = (abs(_e711) < 1f);
            }
            let _e715 = phi_1641_;
            phi_1647_ = _e715;
            if _e715 {
                let _e717 = (*seen_2).rest;
                phi_1647_ = (_e717 > 0.01f);
            }
            let _e720 = phi_1647_;
            if _e720 {
                let _e721 = c;
                if (_e721 <= 0f) {
                    let _e723 = c;
                    param_63 = -(_e723);
                    let _e725 = right_of((&param_63));
                    local_10 = _e725;
                } else {
                    let _e726 = c;
                    param_64 = (1f - _e726);
                    let _e728 = right_of((&param_64));
                    local_10 = (vec4(1f) - _e728);
                }
                let _e731 = local_10;
                stripes_1 = _e731;
                let _e732 = here_mask;
                param_65 = (vec4(1f) - _e732);
                let _e735 = stripes_1;
                param_66 = _e735;
                let _e736 = covered((&param_65), (&param_66));
                let _e737 = (*seen_2);
                param_67 = _e737;
                param_68 = _e736;
                let _e738 = (*x_3);
                param_69 = _e738;
                let _e740 = here_1.back;
                param_70 = _e740;
                let _e741 = cover((&param_67), (&param_68), (&param_69), (&param_70));
                let _e742 = param_67;
                (*seen_2) = _e742;
                let _e744 = backs[0u];
                backs[0u] = (_e744 + _e741);
            }
            let _e747 = ends;
            phi_1698_ = _e747;
            if _e747 {
                let _e749 = next.front;
                let _e751 = here_1.back;
                phi_1698_ = (_e749 > _e751);
            }
            let _e754 = phi_1698_;
            let _e755 = c;
            at_back = (_e754 && (_e755 <= 0f));
            let _e759 = here_1.split;
            let _e761 = front_front;
            let _e764 = front_back;
            let _e766 = ((!(_e759) && !(_e761)) && !(_e764));
            phi_1719_ = _e766;
            if _e766 {
                let _e768 = next.front;
                let _e770 = here_1.front;
                phi_1719_ = (_e768 > _e770);
            }
            let _e773 = phi_1719_;
            let _e774 = a;
            at_front = (_e773 && (_e774 <= 0f));
            let _e777 = at_back;
            let _e778 = at_front;
            let _e779 = (_e777 || _e778);
            phi_1731_ = _e779;
            if _e779 {
                let _e781 = (*seen_2).rest;
                phi_1731_ = (_e781 > 0.01f);
            }
            let _e784 = phi_1731_;
            if _e784 {
                let _e785 = at_back;
                if _e785 {
                    let _e787 = here_1.back;
                    local_11 = _e787;
                } else {
                    let _e789 = here_1.front;
                    local_11 = _e789;
                }
                let _e790 = local_11;
                reach_2 = _e790;
                let _e791 = at_back;
                if _e791 {
                    let _e792 = c;
                    local_12 = -(_e792);
                } else {
                    let _e794 = a;
                    local_12 = -(_e794);
                }
                let _e796 = local_12;
                away = _e796;
                let _e797 = at_back;
                let _e798 = on_front;
                if (_e797 && !(_e798)) {
                    let _e801 = here_mask;
                    param_71 = _e801;
                    param_72 = vec4<f32>(1f, 1f, 1f, 1f);
                    let _e802 = covered((&param_71), (&param_72));
                    local_13 = (1f - _e802);
                } else {
                    local_13 = 1f;
                }
                let _e804 = local_13;
                weight = _e804;
                let _e805 = (*column_6);
                let _e806 = at_back;
                let _e807 = reach_2;
                let _e808 = weight;
                found = Edge(_e805, _e806, _e807, _e808);
                let _e810 = weight;
                let _e812 = away;
                if ((_e810 == 1f) && (_e812 < 0.5f)) {
                    let _e815 = (*seen_2);
                    param_73 = _e815;
                    param_74 = 1f;
                    let _e816 = (*x_3);
                    param_75 = _e816;
                    let _e817 = reach_2;
                    param_76 = _e817;
                    let _e818 = cover((&param_73), (&param_74), (&param_75), (&param_76));
                    let _e819 = param_73;
                    (*seen_2) = _e819;
                    taken_4 = _e818;
                    let _e820 = at_back;
                    let _e821 = taken_4;
                    let _e824 = backs[0u];
                    backs[0u] = (_e824 + select(0f, _e821, _e820));
                    let _e827 = at_back;
                    let _e828 = taken_4;
                    let _e831 = fronts[0u];
                    fronts[0u] = (_e831 + select(_e828, 0f, _e827));
                }
                let _e834 = reach_2;
                let _e836 = edge.reach;
                if (_e834 < _e836) {
                    let _e838 = weight;
                    if (_e838 < 1f) {
                        let _e840 = edge;
                        second = _e840;
                    }
                    let _e841 = found;
                    edge = _e841;
                    let _e843 = next.front;
                    beside = _e843;
                } else {
                    let _e844 = reach_2;
                    let _e846 = second.reach;
                    if (_e844 < _e846) {
                        let _e848 = found;
                        second = _e848;
                    }
                }
            }
            let _e850 = fronts[0u];
            let _e852 = backs[0u];
            if (max(_e850, _e852) > 0f) {
                let _e855 = (*column_6);
                param_77 = _e855;
                let _e856 = (*row_6);
                param_78 = _e856;
                let _e858 = fronts[0u];
                param_79 = _e858;
                let _e860 = backs[0u];
                param_80 = _e860;
                let _e861 = weighted((&param_77), (&param_78), (&param_79), (&param_80));
                let _e862 = color_sum;
                color_sum = (_e862 + _e861);
            }
            let _e865 = fronts[1u];
            let _e867 = backs[1u];
            if (max(_e865, _e867) > 0f) {
                let _e870 = (*column_6);
                let _e871 = sense;
                param_81 = (_e870 + _e871);
                let _e873 = (*row_6);
                param_82 = _e873;
                let _e875 = fronts[1u];
                param_83 = _e875;
                let _e877 = backs[1u];
                param_84 = _e877;
                let _e878 = weighted((&param_81), (&param_82), (&param_83), (&param_84));
                let _e879 = color_sum;
                color_sum = (_e879 + _e878);
            }
            let _e881 = front_back;
            on_front = _e881;
            let _e882 = back_back;
            on_back = _e882;
            let _e883 = next;
            here_1 = _e883;
            let _e884 = sense;
            let _e885 = (*column_6);
            (*column_6) = (_e885 + _e884);
            let _e887 = (*x_3);
            (*x_3) = (_e887 + 1f);
            continue;
        } else {
            break;
        }
    }
    let _e890 = (*seen_2).rest;
    (*seen_2).hole = (_e890 > 0.5f);
    let _e894 = (*seen_2).rest;
    if (_e894 > 0.01f) {
        let _e897 = edge.column;
        beyond = (_e897 < 0i);
        let _e899 = beyond;
        if _e899 {
            let _e900 = (*column_6);
            let _e902 = here_1.split;
            let _e904 = here_1.split;
            if _e904 {
                let _e906 = here_1.back;
                local_14 = _e906;
            } else {
                let _e908 = here_1.front;
                local_14 = _e908;
            }
            let _e909 = local_14;
            edge = Edge(_e900, _e902, _e909, 1f);
        }
        let _e912 = edge.column;
        param_85 = _e912;
        let _e913 = source_column((&param_85));
        edge_x = f32(_e913);
        let _e915 = (*t);
        let _e916 = edge_x;
        let _e919 = edge.reach;
        away_1 = abs(((_e915 - _e916) - _e919));
        let _e922 = away_1;
        spread = (0.5f * clamp(_e922, 1f, 12f));
        sum = vec4<f32>(0f, 0f, 0f, 0f);
        weights = 0f;
        let _e925 = beyond;
        let _e926 = away_1;
        rows_1 = select(2i, 0i, (_e925 && (_e926 < 0.5f)));
        let _e930 = rows_1;
        i_2 = -(_e930);
        loop {
            let _e932 = i_2;
            let _e933 = rows_1;
            if (_e932 <= _e933) {
                let _e935 = (*row_6);
                let _e936 = i_2;
                let _e938 = spread;
                let _e945 = synthesis.source_size[1u];
                at = clamp((_e935 + i32(round((f32(_e936) * _e938)))), 0i, (_e945 - 1i));
                let _e949 = edge.column;
                param_86 = _e949;
                let _e950 = at;
                param_87 = _e950;
                let _e951 = layer_at((&param_86), (&param_87));
                layer_4 = _e951;
                let _e952 = i_2;
                if (_e952 == 0i) {
                    let _e955 = edge.back;
                    local_15 = !(_e955);
                } else {
                    let _e958 = layer_4.front;
                    let _e960 = edge.reach;
                    local_15 = (_e958 <= (_e960 + 1f));
                }
                let _e963 = local_15;
                front_2 = _e963;
                let _e964 = i_2;
                if (_e964 == 0i) {
                    let _e967 = edge.back;
                    local_16 = _e967;
                } else {
                    let _e968 = front_2;
                    let _e971 = layer_4.split;
                    let _e972 = (!(_e968) && _e971);
                    phi_2010_ = _e972;
                    if _e972 {
                        let _e974 = layer_4.back;
                        let _e976 = edge.reach;
                        phi_2010_ = (_e974 <= (_e976 + 1f));
                    }
                    let _e980 = phi_2010_;
                    local_16 = _e980;
                }
                let _e981 = local_16;
                behind_2 = _e981;
                let _e982 = i_2;
                if (_e982 == 0i) {
                    local_17 = 2f;
                } else {
                    let _e984 = front_2;
                    if _e984 {
                        local_18 = 1f;
                    } else {
                        let _e985 = behind_2;
                        if _e985 {
                            let _e986 = layer_4;
                            param_88 = _e986;
                            let _e988 = edge.column;
                            param_89 = _e988;
                            let _e989 = at;
                            param_90 = _e989;
                            let _e990 = mask_of((&param_88), (&param_89), (&param_90));
                            param_91 = _e990;
                            param_92 = vec4<f32>(1f, 1f, 1f, 1f);
                            let _e991 = covered((&param_91), (&param_92));
                            local_19 = (1f - _e991);
                        } else {
                            local_19 = 0f;
                        }
                        let _e993 = local_19;
                        local_18 = _e993;
                    }
                    let _e994 = local_18;
                    local_17 = _e994;
                }
                let _e995 = local_17;
                weight_1 = _e995;
                let _e996 = front_2;
                let _e997 = weight_1;
                let _e999 = front_2;
                let _e1000 = weight_1;
                let _e1003 = edge.column;
                param_93 = _e1003;
                let _e1004 = at;
                param_94 = _e1004;
                param_95 = select(0f, _e997, _e996);
                param_96 = select(_e1000, 0f, _e999);
                let _e1005 = weighted((&param_93), (&param_94), (&param_95), (&param_96));
                let _e1006 = sum;
                sum = (_e1006 + _e1005);
                let _e1008 = weight_1;
                let _e1009 = weights;
                weights = (_e1009 + _e1008);
                continue;
            } else {
                break;
            }
            continuing {
                let _e1011 = i_2;
                i_2 = (_e1011 + 1i);
            }
        }
        let _e1013 = sum;
        let _e1014 = weights;
        fill = (_e1013 / vec4(_e1014));
        let _e1018 = second.column;
        let _e1019 = (_e1018 >= 0i);
        phi_2078_ = _e1019;
        if _e1019 {
            let _e1021 = edge.weight;
            phi_2078_ = (_e1021 < 1f);
        }
        let _e1024 = phi_2078_;
        if _e1024 {
            let _e1026 = second.back;
            one = select(vec2<f32>(1f, 0f), vec2<f32>(0f, 1f), vec2(_e1026));
            let _e1030 = second.column;
            param_97 = _e1030;
            let _e1031 = (*row_6);
            param_98 = _e1031;
            let _e1033 = one[0u];
            param_99 = _e1033;
            let _e1035 = one[1u];
            param_100 = _e1035;
            let _e1036 = weighted((&param_97), (&param_98), (&param_99), (&param_100));
            let _e1037 = fill;
            let _e1039 = edge.weight;
            fill = mix(_e1036, _e1037, vec4(_e1039));
        }
        let _e1043 = (*seen_2).hole;
        let _e1044 = away_1;
        (*seen_2).hole = (_e1043 && (_e1044 >= 0.5f));
        let _e1049 = edge.reach;
        let _e1050 = far_nearness();
        let _e1054 = synthesis.law[1u];
        depth_1 = ((_e1049 + _e1050) / _e1054);
        let _e1058 = synthesis.origins[0u];
        let _e1060 = gl_FragCoord_1[0u];
        let _e1064 = synthesis.origins[1u];
        origin_1 = ((_e1058 * _e1060) + _e1064);
        let _e1066 = away_1;
        let _e1067 = (_e1066 >= 0.5f);
        phi_2159_ = _e1067;
        if _e1067 {
            let _e1068 = gl_FragCoord_1;
            let _e1071 = synthesis.target_origin;
            let _e1074 = beside;
            let _e1075 = far_nearness();
            param_101 = (_e1068.xy - vec2<f32>(_e1071));
            param_102 = (_e1074 + _e1075);
            let _e1077 = origin_1;
            param_103 = _e1077;
            let _e1078 = (*row_6);
            param_104 = _e1078;
            let _e1079 = fill;
            param_105 = _e1079;
            let _e1080 = depth_1;
            param_106 = _e1080;
            let _e1081 = recall((&param_101), (&param_102), (&param_103), (&param_104), (&param_105), (&param_106));
            let _e1082 = param_105;
            fill = _e1082;
            let _e1083 = param_106;
            depth_1 = _e1083;
            phi_2159_ = _e1081;
        }
        let _e1085 = phi_2159_;
        if _e1085 {
            let _e1088 = synthesis.law[1u];
            let _e1089 = depth_1;
            let _e1091 = far_nearness();
            edge.reach = ((_e1088 * _e1089) - _e1091);
        }
        let _e1094 = (*seen_2);
        param_107 = _e1094;
        param_108 = 1f;
        let _e1095 = edge_x;
        param_109 = _e1095;
        let _e1097 = edge.reach;
        param_110 = _e1097;
        let _e1098 = cover((&param_107), (&param_108), (&param_109), (&param_110));
        let _e1099 = param_107;
        (*seen_2) = _e1099;
        let _e1100 = fill;
        let _e1102 = color_sum;
        color_sum = (_e1102 + (_e1100 * _e1098));
    }
    let _e1104 = color_sum;
    return _e1104;
}

fn color_texel(x_4: ptr<function, i32>, row_7: ptr<function, i32>) -> vec4<f32> {
    var param_111: i32;
    var param_112: vec2<i32>;

    let _e6 = (*x_4);
    param_111 = _e6;
    let _e7 = source_column((&param_111));
    let _e8 = (*row_7);
    param_112 = vec2<i32>(_e7, _e8);
    let _e10 = in_image((&param_112));
    let _e11 = textureLoad(color_map_texture, _e10, 0i);
    return _e11;
}

fn sharp_color_at(x_5: ptr<function, f32>, row_8: ptr<function, i32>) -> vec4<f32> {
    var last_1: i32;
    var column_7: i32;
    var f: f32;
    var here_2: vec4<f32>;
    var param_113: i32;
    var param_114: i32;
    var next_1: vec4<f32>;
    var param_115: i32;
    var param_116: i32;
    var apart: vec4<f32>;
    var outer: vec2<f32>;
    var inner: f32;
    var sum_1: vec4<f32>;
    var param_117: i32;
    var param_118: i32;
    var param_119: i32;
    var param_120: i32;

    let _e33 = synthesis.source_size[0u];
    last_1 = (_e33 - 1i);
    let _e35 = (*x_5);
    column_7 = i32(_e35);
    let _e37 = (*x_5);
    let _e38 = column_7;
    f = (_e37 - f32(_e38));
    let _e41 = column_7;
    param_113 = _e41;
    let _e42 = (*row_8);
    param_114 = _e42;
    let _e43 = color_texel((&param_113), (&param_114));
    here_2 = _e43;
    let _e44 = column_7;
    let _e46 = last_1;
    param_115 = min((_e44 + 1i), _e46);
    let _e48 = (*row_8);
    param_116 = _e48;
    let _e49 = color_texel((&param_115), (&param_116));
    next_1 = _e49;
    let _e50 = next_1;
    let _e51 = here_2;
    apart = abs((_e50 - _e51));
    let _e55 = apart[0u];
    let _e57 = apart[1u];
    let _e59 = apart[2u];
    if (max(_e55, max(_e57, _e59)) <= 0.03137255f) {
        let _e63 = here_2;
        let _e64 = next_1;
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
    let _e88 = column_7;
    param_117 = max((_e88 - 1i), 0i);
    let _e91 = (*row_8);
    param_118 = _e91;
    let _e92 = color_texel((&param_117), (&param_118));
    let _e95 = outer[1u];
    let _e96 = column_7;
    let _e98 = last_1;
    param_119 = min((_e96 + 2i), _e98);
    let _e100 = (*row_8);
    param_120 = _e100;
    let _e101 = color_texel((&param_119), (&param_120));
    let _e104 = inner;
    let _e105 = here_2;
    let _e108 = inner;
    let _e111 = outer[0u];
    let _e114 = outer[1u];
    let _e116 = next_1;
    sum_1 = ((((_e92 * _e87) + (_e101 * _e95)) + (_e105 * _e104)) + (_e116 * (((1f - _e108) - _e111) - _e114)));
    let _e119 = sum_1;
    let _e120 = here_2;
    let _e121 = next_1;
    let _e123 = here_2;
    let _e124 = next_1;
    return clamp(_e119, min(_e120, _e121), max(_e123, _e124));
}

fn span_steps(span: ptr<function, u32>) -> f32 {
    var steps: u32;
    var local_20: f32;

    let _e5 = (*span);
    steps = (_e5 & 1023u);
    let _e7 = steps;
    if (_e7 == 1023u) {
        local_20 = 1000000000f;
    } else {
        let _e9 = steps;
        local_20 = f32(_e9);
    }
    let _e11 = local_20;
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
    var row_9: i32;
    var t_1: f32;
    var span_1: u32;
    var x_6: f32;
    var limit_1: f32;
    var param_121: u32;
    var sense_1: i32;
    var column_8: i32;
    var param_122: i32;
    var seen_3: Seen;
    var bits_2: u32;
    var param_123: i32;
    var param_124: i32;
    var front_3: f32;
    var param_125: u32;
    var at_1: f32;
    var plain: bool;
    var param_126: u32;
    var param_127: i32;
    var param_128: i32;
    var following: f32;
    var param_129: u32;
    var param_130: u32;
    var then: f32;
    var g_4: f32;
    var param_131: Seen;
    var param_132: f32;
    var param_133: f32;
    var param_134: f32;
    var param_135: f32;
    var param_136: i32;
    var param_137: i32;
    var param_138: f32;
    var param_139: f32;
    var param_140: f32;
    var param_141: i32;
    var param_142: Seen;
    var phi_2306_: bool;

    let _e55 = synthesis.source_size[0u];
    last_3 = f32((_e55 - 1i));
    let _e59 = gl_FragCoord_1[1u];
    let _e61 = synthesis.first_row;
    let _e65 = synthesis.source_size[1u];
    row_9 = i32(clamp((_e59 - _e61), 0f, f32((_e65 - 1i))));
    let _e72 = synthesis.origins[0u];
    let _e74 = gl_FragCoord_1[0u];
    let _e78 = synthesis.origins[1u];
    let _e81 = synthesis.farthest;
    t_1 = ((((_e72 * _e74) + _e78) - _e81) + 0.01f);
    let _e84 = pixel_span();
    span_1 = _e84.x;
    let _e86 = t_1;
    let _e87 = span_1;
    let _e92 = last_3;
    x_6 = clamp(floor(((_e86 - bitcast<f32>(_e87)) - 1.01f)), 0f, _e92);
    let _e94 = x_6;
    let _e95 = span_1;
    param_121 = _e95;
    let _e96 = span_steps((&param_121));
    let _e99 = last_3;
    limit_1 = min(((_e94 + _e96) + 2f), _e99);
    let _e102 = synthesis.mirrored;
    sense_1 = select(1i, -1i, (_e102 != 0u));
    let _e105 = x_6;
    param_122 = i32(_e105);
    let _e107 = source_column((&param_122));
    column_8 = _e107;
    seen_3 = Seen(1f, 0f, 0f, false);
    let _e108 = column_8;
    param_123 = _e108;
    let _e109 = row_9;
    param_124 = _e109;
    let _e110 = layer_bits((&param_123), (&param_124));
    bits_2 = _e110;
    let _e111 = bits_2;
    param_125 = _e111;
    let _e112 = full_front((&param_125));
    front_3 = _e112;
    let _e113 = x_6;
    let _e114 = front_3;
    let _e116 = t_1;
    at_1 = ((_e113 + _e114) - _e116);
    let _e118 = bits_2;
    param_126 = _e118;
    let _e119 = is_full((&param_126));
    let _e120 = at_1;
    plain = (_e119 && (_e120 <= 0f));
    loop {
        let _e123 = plain;
        let _e124 = x_6;
        let _e125 = limit_1;
        if (_e123 && (_e124 < _e125)) {
            let _e128 = column_8;
            let _e129 = sense_1;
            param_127 = (_e128 + _e129);
            let _e131 = row_9;
            param_128 = _e131;
            let _e132 = layer_bits((&param_127), (&param_128));
            bits_2 = _e132;
            let _e133 = bits_2;
            param_129 = _e133;
            let _e134 = full_front((&param_129));
            following = _e134;
            let _e135 = bits_2;
            param_130 = _e135;
            let _e136 = is_full((&param_130));
            phi_2306_ = _e136;
            if _e136 {
                let _e137 = following;
                let _e138 = front_3;
                phi_2306_ = (abs((_e137 - _e138)) < 0.5f);
            }
            let _e143 = phi_2306_;
            plain = _e143;
            let _e144 = x_6;
            let _e146 = following;
            let _e148 = t_1;
            then = (((_e144 + 1f) + _e146) - _e148);
            let _e150 = plain;
            let _e151 = then;
            if (_e150 && (_e151 > 0f)) {
                let _e154 = at_1;
                let _e156 = then;
                let _e157 = at_1;
                g_4 = (-(_e154) / (_e156 - _e157));
                let _e160 = x_6;
                let _e161 = g_4;
                let _e163 = front_3;
                let _e164 = following;
                let _e165 = g_4;
                let _e167 = seen_3;
                param_131 = _e167;
                param_132 = 1f;
                param_133 = (_e160 + _e161);
                param_134 = mix(_e163, _e164, _e165);
                let _e168 = cover((&param_131), (&param_132), (&param_133), (&param_134));
                let _e169 = param_131;
                seen_3 = _e169;
                let _e170 = x_6;
                limit_1 = _e170;
            } else {
                let _e171 = plain;
                if _e171 {
                    let _e172 = x_6;
                    x_6 = (_e172 + 1f);
                    let _e174 = sense_1;
                    let _e175 = column_8;
                    column_8 = (_e175 + _e174);
                    let _e177 = following;
                    front_3 = _e177;
                    let _e178 = then;
                    at_1 = _e178;
                }
            }
            continue;
        } else {
            break;
        }
    }
    let _e180 = seen_3.rest;
    if (_e180 < 0.01f) {
        let _e183 = seen_3.column;
        param_135 = _e183;
        let _e184 = row_9;
        param_136 = _e184;
        let _e185 = sharp_color_at((&param_135), (&param_136));
        color_1 = _e185;
    } else {
        let _e186 = row_9;
        param_137 = _e186;
        let _e187 = t_1;
        param_138 = _e187;
        let _e188 = x_6;
        param_139 = _e188;
        let _e189 = limit_1;
        param_140 = _e189;
        let _e190 = column_8;
        param_141 = _e190;
        let _e191 = seen_3;
        param_142 = _e191;
        let _e192 = composed((&param_137), (&param_138), (&param_139), (&param_140), (&param_141), (&param_142));
        let _e193 = param_142;
        seen_3 = _e193;
        color_1 = _e192;
    }
    let _e195 = synthesis.far_displacement;
    let _e197 = seen_3.reach;
    let _e201 = synthesis.law[0u];
    let _e205 = synthesis.law[1u];
    gl_FragDepth = clamp((((_e195 + _e197) - _e201) / _e205), 0f, 1f);
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
