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
@group(0) @binding(3) 
var span_map_texture: texture_2d<u32>;
var<private> span_at_1: vec2<f32>;
@group(0) @binding(4) 
var layer_map_texture: texture_2d<u32>;
@group(0) @binding(5) 
var back_map_texture: texture_2d<f32>;
var<private> gl_FragCoord_1: vec4<f32>;
var<private> color: vec4<f32>;

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

fn weighted(column: ptr<function, i32>, row: ptr<function, i32>, of_front: ptr<function, f32>, of_back: ptr<function, f32>) -> vec4<f32> {
    var mixture: vec4<f32>;
    var param: vec2<i32>;
    var behind: vec4<f32>;
    var share: f32;
    var front: vec4<f32>;
    var local_1: vec4<f32>;

    let _e17 = (*column);
    let _e18 = (*row);
    param = vec2<i32>(_e17, _e18);
    let _e20 = in_image((&param));
    let _e21 = textureLoad(color_map_texture, _e20, 0i);
    mixture = _e21;
    let _e22 = (*column);
    let _e23 = (*row);
    let _e25 = textureLoad(back_map_texture, vec2<i32>(_e22, _e23), 0i);
    behind = _e25;
    let _e27 = behind[3u];
    share = _e27;
    let _e29 = mixture[3u];
    behind[3u] = _e29;
    let _e31 = share;
    if (_e31 < 1f) {
        let _e33 = mixture;
        let _e34 = share;
        let _e36 = behind;
        let _e39 = share;
        local_1 = clamp(((_e33 - (_e36 * (1f - _e34))) / vec4(max(_e39, 0.01f))), vec4(0f), vec4(1f));
    } else {
        let _e46 = mixture;
        local_1 = _e46;
    }
    let _e47 = local_1;
    front = _e47;
    let _e48 = (*of_front);
    let _e49 = front;
    let _e51 = (*of_back);
    let _e52 = behind;
    return ((_e49 * _e48) + (_e52 * _e51));
}

fn covered(mask: ptr<function, vec4<f32>>, stripes: ptr<function, vec4<f32>>) -> f32 {
    let _e3 = (*mask);
    let _e4 = (*stripes);
    return (0.25f * dot(_e3, _e4));
}

fn right_of(place: ptr<function, f32>) -> vec4<f32> {
    let _e5 = (*place);
    return clamp((vec4<f32>(1f, 2f, 3f, 4f) - vec4((4f * _e5))), vec4(0f), vec4(1f));
}

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

fn layer_bits(column_1: ptr<function, i32>, row_1: ptr<function, i32>) -> u32 {
    let _e4 = (*column_1);
    let _e5 = (*row_1);
    let _e7 = textureLoad(layer_map_texture, vec2<i32>(_e4, _e5), 0i);
    return _e7.x;
}

fn layer_at(column_2: ptr<function, i32>, row_2: ptr<function, i32>) -> Layer {
    var bits: u32;
    var param_1: i32;
    var param_2: i32;
    var param_3: u32;
    var param_4: u32;
    var both: vec2<f32>;
    var param_5: u32;
    var code: u32;
    var share_1: f32;
    var mask_1: vec4<f32>;
    var local_2: vec4<f32>;
    var local_3: vec4<f32>;

    let _e29 = (*column_2);
    param_1 = _e29;
    let _e30 = (*row_2);
    param_2 = _e30;
    let _e31 = layer_bits((&param_1), (&param_2));
    bits = _e31;
    let _e32 = bits;
    param_3 = _e32;
    let _e33 = is_full((&param_3));
    if _e33 {
        let _e34 = bits;
        param_4 = _e34;
        let _e35 = full_front((&param_4));
        return Layer(_e35, 1000000000f, false, vec4<f32>(1f, 1f, 1f, 1f));
    }
    let _e37 = bits;
    param_5 = _e37;
    let _e38 = split_displacements((&param_5));
    both = _e38;
    let _e39 = bits;
    code = (_e39 >> bitcast<u32>(28i));
    let _e42 = (*column_2);
    let _e43 = (*row_2);
    let _e45 = textureLoad(back_map_texture, vec2<i32>(_e42, _e43), 0i);
    share_1 = _e45.w;
    let _e47 = code;
    if (_e47 == 1u) {
        let _e49 = share_1;
        local_2 = clamp((vec4((4f * _e49)) - vec4<f32>(0f, 1f, 2f, 3f)), vec4(0f), vec4(1f));
    } else {
        let _e56 = code;
        if (_e56 == 2u) {
            let _e58 = share_1;
            local_3 = clamp((vec4((4f * _e58)) - vec4<f32>(3f, 2f, 1f, 0f)), vec4(0f), vec4(1f));
        } else {
            let _e65 = share_1;
            local_3 = vec4(_e65);
        }
        let _e67 = local_3;
        local_2 = _e67;
    }
    let _e68 = local_2;
    mask_1 = _e68;
    let _e70 = both[0u];
    let _e72 = both[1u];
    let _e73 = mask_1;
    return Layer(_e70, _e72, true, _e73);
}

fn source_column(x: ptr<function, i32>) -> i32 {
    var local_4: i32;

    let _e6 = synthesis.mirrored;
    if (_e6 != 0u) {
        let _e10 = synthesis.source_size[0u];
        let _e12 = (*x);
        local_4 = ((_e10 - 1i) - _e12);
    } else {
        let _e14 = (*x);
        local_4 = _e14;
    }
    let _e15 = local_4;
    return _e15;
}

fn color_texel(x_1: ptr<function, i32>, row_3: ptr<function, i32>) -> vec4<f32> {
    var param_6: i32;
    var param_7: vec2<i32>;

    let _e6 = (*x_1);
    param_6 = _e6;
    let _e7 = source_column((&param_6));
    let _e8 = (*row_3);
    param_7 = vec2<i32>(_e7, _e8);
    let _e10 = in_image((&param_7));
    let _e11 = textureLoad(color_map_texture, _e10, 0i);
    return _e11;
}

fn sharp_color_at(x_2: ptr<function, f32>, row_4: ptr<function, i32>) -> vec4<f32> {
    var last: i32;
    var column_3: i32;
    var f: f32;
    var here: vec4<f32>;
    var param_8: i32;
    var param_9: i32;
    var next: vec4<f32>;
    var param_10: i32;
    var param_11: i32;
    var apart: vec4<f32>;
    var outer: vec2<f32>;
    var inner: f32;
    var sum: vec4<f32>;
    var param_12: i32;
    var param_13: i32;
    var param_14: i32;
    var param_15: i32;

    let _e33 = synthesis.source_size[0u];
    last = (_e33 - 1i);
    let _e35 = (*x_2);
    column_3 = i32(_e35);
    let _e37 = (*x_2);
    let _e38 = column_3;
    f = (_e37 - f32(_e38));
    let _e41 = column_3;
    param_8 = _e41;
    let _e42 = (*row_4);
    param_9 = _e42;
    let _e43 = color_texel((&param_8), (&param_9));
    here = _e43;
    let _e44 = column_3;
    let _e46 = last;
    param_10 = min((_e44 + 1i), _e46);
    let _e48 = (*row_4);
    param_11 = _e48;
    let _e49 = color_texel((&param_10), (&param_11));
    next = _e49;
    let _e50 = next;
    let _e51 = here;
    apart = abs((_e50 - _e51));
    let _e55 = apart[0u];
    let _e57 = apart[1u];
    let _e59 = apart[2u];
    if (max(_e55, max(_e57, _e59)) <= 0.03137255f) {
        let _e63 = here;
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
    let _e88 = column_3;
    param_12 = max((_e88 - 1i), 0i);
    let _e91 = (*row_4);
    param_13 = _e91;
    let _e92 = color_texel((&param_12), (&param_13));
    let _e95 = outer[1u];
    let _e96 = column_3;
    let _e98 = last;
    param_14 = min((_e96 + 2i), _e98);
    let _e100 = (*row_4);
    param_15 = _e100;
    let _e101 = color_texel((&param_14), (&param_15));
    let _e104 = inner;
    let _e105 = here;
    let _e108 = inner;
    let _e111 = outer[0u];
    let _e114 = outer[1u];
    let _e116 = next;
    sum = ((((_e92 * _e87) + (_e101 * _e95)) + (_e105 * _e104)) + (_e116 * (((1f - _e108) - _e111) - _e114)));
    let _e119 = sum;
    let _e120 = here;
    let _e121 = next;
    let _e123 = here;
    let _e124 = next;
    return clamp(_e119, min(_e120, _e121), max(_e123, _e124));
}

fn cover(seen: ptr<function, Seen>, share_2: ptr<function, f32>, column_4: ptr<function, f32>, reach_1: ptr<function, f32>) -> f32 {
    var taken: f32;
    var passes: bool;
    var local_5: f32;
    var local_6: f32;
    var phi_563_: bool;

    let _e10 = (*seen).rest;
    let _e11 = (*share_2);
    taken = (_e10 * _e11);
    let _e14 = (*seen).rest;
    let _e15 = (_e14 > 0.5f);
    phi_563_ = _e15;
    if _e15 {
        let _e17 = (*seen).rest;
        let _e18 = taken;
        phi_563_ = ((_e17 - _e18) <= 0.5f);
    }
    let _e22 = phi_563_;
    passes = _e22;
    let _e23 = passes;
    if _e23 {
        let _e24 = (*column_4);
        local_5 = _e24;
    } else {
        let _e26 = (*seen).column;
        local_5 = _e26;
    }
    let _e27 = local_5;
    (*seen).column = _e27;
    let _e29 = passes;
    if _e29 {
        let _e30 = (*reach_1);
        local_6 = _e30;
    } else {
        let _e32 = (*seen).reach;
        local_6 = _e32;
    }
    let _e33 = local_6;
    (*seen).reach = _e33;
    let _e35 = taken;
    let _e37 = (*seen).rest;
    (*seen).rest = (_e37 - _e35);
    let _e40 = taken;
    return _e40;
}

fn span_steps(span: ptr<function, u32>) -> f32 {
    var steps: u32;
    var local_7: f32;

    let _e5 = (*span);
    steps = (_e5 & 1023u);
    let _e7 = steps;
    if (_e7 == 1023u) {
        local_7 = 1000000000f;
    } else {
        let _e9 = steps;
        local_7 = f32(_e9);
    }
    let _e11 = local_7;
    return _e11;
}

fn pixel_span() -> vec4<u32> {
    var last_1: vec2<i32>;

    if true {
        let _e14 = synthesis.target_size[0u];
        let _e17 = synthesis.source_size[1u];
        last_1 = ((vec2<i32>(_e14, _e17) - vec2(1i)) / vec2<i32>(16i, 8i));
        let _e22 = span_at_1;
        let _e24 = last_1;
        let _e26 = textureLoad(span_map_texture, clamp(vec2<i32>(_e22), vec2<i32>(0i, 0i), _e24), 0i);
        return _e26;
    }
    return vec4<u32>(0u, 0u, 0u, 0u);
}

fn main_1() {
    var last_2: f32;
    var row_5: i32;
    var t: f32;
    var span_1: u32;
    var x_3: f32;
    var limit: f32;
    var param_16: u32;
    var sense: i32;
    var column_5: i32;
    var param_17: i32;
    var seen_1: Seen;
    var bits_1: u32;
    var param_18: i32;
    var param_19: i32;
    var front_1: f32;
    var param_20: u32;
    var at: f32;
    var plain: bool;
    var param_21: u32;
    var param_22: i32;
    var param_23: i32;
    var following: f32;
    var param_24: u32;
    var param_25: u32;
    var then: f32;
    var g: f32;
    var param_26: Seen;
    var param_27: f32;
    var param_28: f32;
    var param_29: f32;
    var param_30: f32;
    var param_31: i32;
    var here_1: Layer;
    var param_32: i32;
    var param_33: i32;
    var edge: Edge;
    var second: Edge;
    var on_front: bool;
    var on_back: bool;
    var before: Layer;
    var param_34: i32;
    var param_35: i32;
    var idle: bool;
    var landed: f32;
    var ahead: u32;
    var param_36: i32;
    var param_37: i32;
    var following_1: f32;
    var param_38: u32;
    var then_1: f32;
    var param_39: u32;
    var next_1: Layer;
    var param_40: i32;
    var param_41: i32;
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
    var param_42: f32;
    var shares: vec2<f32>;
    var param_43: vec4<f32>;
    var param_44: vec4<f32>;
    var param_45: vec4<f32>;
    var param_46: vec4<f32>;
    var share_3: f32;
    var param_47: Seen;
    var param_48: f32;
    var param_49: f32;
    var param_50: f32;
    var share_4: f32;
    var param_51: f32;
    var param_52: vec4<f32>;
    var param_53: vec4<f32>;
    var param_54: Seen;
    var param_55: f32;
    var param_56: f32;
    var param_57: f32;
    var param_58: f32;
    var param_59: vec4<f32>;
    var param_60: vec4<f32>;
    var param_61: Seen;
    var param_62: f32;
    var param_63: f32;
    var param_64: f32;
    var g_2: f32;
    var taken_1: f32;
    var param_65: Seen;
    var param_66: f32;
    var param_67: f32;
    var param_68: f32;
    var g_3: f32;
    var taken_2: f32;
    var param_69: Seen;
    var param_70: f32;
    var param_71: f32;
    var param_72: f32;
    var g_4: f32;
    var taken_3: f32;
    var param_73: Seen;
    var param_74: f32;
    var param_75: f32;
    var param_76: f32;
    var ends: bool;
    var stripes_1: vec4<f32>;
    var local_8: vec4<f32>;
    var param_77: f32;
    var param_78: f32;
    var param_79: vec4<f32>;
    var param_80: vec4<f32>;
    var param_81: Seen;
    var param_82: f32;
    var param_83: f32;
    var param_84: f32;
    var at_back: bool;
    var at_front: bool;
    var reach_2: f32;
    var local_9: f32;
    var away: f32;
    var local_10: f32;
    var weight: f32;
    var local_11: f32;
    var param_85: vec4<f32>;
    var param_86: vec4<f32>;
    var found: Edge;
    var taken_4: f32;
    var param_87: Seen;
    var param_88: f32;
    var param_89: f32;
    var param_90: f32;
    var param_91: i32;
    var param_92: i32;
    var param_93: f32;
    var param_94: f32;
    var param_95: i32;
    var param_96: i32;
    var param_97: f32;
    var param_98: f32;
    var hole: bool;
    var beyond: bool;
    var local_12: f32;
    var edge_x: f32;
    var param_99: i32;
    var away_1: f32;
    var spread: f32;
    var sum_1: vec4<f32>;
    var weights: f32;
    var rows: i32;
    var i: i32;
    var at_1: i32;
    var layer_3: Layer;
    var param_100: i32;
    var param_101: i32;
    var front_2: bool;
    var local_13: bool;
    var behind_1: bool;
    var local_14: bool;
    var weight_1: f32;
    var local_15: f32;
    var local_16: f32;
    var local_17: f32;
    var param_102: vec4<f32>;
    var param_103: vec4<f32>;
    var param_104: i32;
    var param_105: i32;
    var param_106: f32;
    var param_107: f32;
    var fill: vec4<f32>;
    var one: vec2<f32>;
    var param_108: i32;
    var param_109: i32;
    var param_110: f32;
    var param_111: f32;
    var param_112: Seen;
    var param_113: f32;
    var param_114: f32;
    var param_115: f32;
    var phi_720_: bool;
    var phi_814_: bool;
    var phi_821_: bool;
    var phi_840_: bool;
    var phi_869_: bool;
    var phi_883_: bool;
    var phi_935_: bool;
    var phi_943_: bool;
    var phi_1019_: bool;
    var phi_1032_: bool;
    var phi_1048_: bool;
    var phi_1129_: bool;
    var phi_1181_: bool;
    var phi_1229_: bool;
    var phi_1279_: bool;
    var phi_1329_: bool;
    var phi_1381_: bool;
    var phi_1387_: bool;
    var phi_1439_: bool;
    var phi_1460_: bool;
    var phi_1472_: bool;
    var phi_1750_: bool;
    var phi_1812_: bool;

    let _e213 = synthesis.source_size[0u];
    last_2 = f32((_e213 - 1i));
    let _e217 = gl_FragCoord_1[1u];
    let _e219 = synthesis.first_row;
    let _e223 = synthesis.source_size[1u];
    row_5 = i32(clamp((_e217 - _e219), 0f, f32((_e223 - 1i))));
    let _e230 = synthesis.origins[0u];
    let _e232 = gl_FragCoord_1[0u];
    let _e236 = synthesis.origins[1u];
    let _e239 = synthesis.farthest;
    t = ((((_e230 * _e232) + _e236) - _e239) + 0.01f);
    let _e242 = pixel_span();
    span_1 = _e242.x;
    let _e244 = t;
    let _e245 = span_1;
    let _e250 = last_2;
    x_3 = clamp(floor(((_e244 - bitcast<f32>(_e245)) - 1.01f)), 0f, _e250);
    let _e252 = x_3;
    let _e253 = span_1;
    param_16 = _e253;
    let _e254 = span_steps((&param_16));
    let _e257 = last_2;
    limit = min(((_e252 + _e254) + 2f), _e257);
    let _e260 = synthesis.mirrored;
    sense = select(1i, -1i, (_e260 != 0u));
    let _e263 = x_3;
    param_17 = i32(_e263);
    let _e265 = source_column((&param_17));
    column_5 = _e265;
    seen_1 = Seen(1f, 0f, 0f);
    color = vec4<f32>(0f, 0f, 0f, 0f);
    let _e266 = column_5;
    param_18 = _e266;
    let _e267 = row_5;
    param_19 = _e267;
    let _e268 = layer_bits((&param_18), (&param_19));
    bits_1 = _e268;
    let _e269 = bits_1;
    param_20 = _e269;
    let _e270 = full_front((&param_20));
    front_1 = _e270;
    let _e271 = x_3;
    let _e272 = front_1;
    let _e274 = t;
    at = ((_e271 + _e272) - _e274);
    let _e276 = bits_1;
    param_21 = _e276;
    let _e277 = is_full((&param_21));
    let _e278 = at;
    plain = (_e277 && (_e278 <= 0f));
    loop {
        let _e281 = plain;
        let _e282 = x_3;
        let _e283 = limit;
        if (_e281 && (_e282 < _e283)) {
            let _e286 = column_5;
            let _e287 = sense;
            param_22 = (_e286 + _e287);
            let _e289 = row_5;
            param_23 = _e289;
            let _e290 = layer_bits((&param_22), (&param_23));
            bits_1 = _e290;
            let _e291 = bits_1;
            param_24 = _e291;
            let _e292 = full_front((&param_24));
            following = _e292;
            let _e293 = bits_1;
            param_25 = _e293;
            let _e294 = is_full((&param_25));
            phi_720_ = _e294;
            if _e294 {
                let _e295 = following;
                let _e296 = front_1;
                phi_720_ = (abs((_e295 - _e296)) < 0.5f);
            }
            let _e301 = phi_720_;
            plain = _e301;
            let _e302 = x_3;
            let _e304 = following;
            let _e306 = t;
            then = (((_e302 + 1f) + _e304) - _e306);
            let _e308 = plain;
            let _e309 = then;
            if (_e308 && (_e309 > 0f)) {
                let _e312 = at;
                let _e314 = then;
                let _e315 = at;
                g = (-(_e312) / (_e314 - _e315));
                let _e318 = x_3;
                let _e319 = g;
                let _e321 = front_1;
                let _e322 = following;
                let _e323 = g;
                let _e325 = seen_1;
                param_26 = _e325;
                param_27 = 1f;
                param_28 = (_e318 + _e319);
                param_29 = mix(_e321, _e322, _e323);
                let _e326 = cover((&param_26), (&param_27), (&param_28), (&param_29));
                let _e327 = param_26;
                seen_1 = _e327;
                let _e328 = x_3;
                limit = _e328;
            } else {
                let _e329 = plain;
                if _e329 {
                    let _e330 = x_3;
                    x_3 = (_e330 + 1f);
                    let _e332 = sense;
                    let _e333 = column_5;
                    column_5 = (_e333 + _e332);
                    let _e335 = following;
                    front_1 = _e335;
                    let _e336 = then;
                    at = _e336;
                }
            }
            continue;
        } else {
            break;
        }
    }
    let _e338 = seen_1.rest;
    if (_e338 < 0.01f) {
        let _e341 = seen_1.column;
        param_30 = _e341;
        let _e342 = row_5;
        param_31 = _e342;
        let _e343 = sharp_color_at((&param_30), (&param_31));
        color = _e343;
    }
    let _e344 = column_5;
    param_32 = _e344;
    let _e345 = row_5;
    param_33 = _e345;
    let _e346 = layer_at((&param_32), (&param_33));
    here_1 = _e346;
    edge = Edge(-1i, false, 1000000000f, 1f);
    let _e347 = edge;
    second = _e347;
    let _e348 = x_3;
    if (_e348 == 0f) {
        let _e351 = here_1.front;
        let _e352 = t;
        if (_e351 > _e352) {
            let _e354 = column_5;
            let _e356 = here_1.front;
            edge = Edge(_e354, false, _e356, 1f);
        }
        let _e359 = here_1.split;
        phi_814_ = _e359;
        if _e359 {
            let _e361 = here_1.back;
            let _e363 = edge.reach;
            phi_814_ = (_e361 < _e363);
        }
        let _e366 = phi_814_;
        phi_821_ = _e366;
        if _e366 {
            let _e368 = here_1.back;
            let _e369 = t;
            phi_821_ = (_e368 > _e369);
        }
        let _e372 = phi_821_;
        if _e372 {
            let _e373 = column_5;
            let _e375 = here_1.back;
            edge = Edge(_e373, true, _e375, 1f);
        }
    }
    on_front = false;
    on_back = false;
    let _e377 = x_3;
    let _e380 = here_1.split;
    let _e381 = ((_e377 > 0f) && _e380);
    phi_840_ = _e381;
    if _e381 {
        let _e383 = seen_1.rest;
        phi_840_ = (_e383 > 0.01f);
    }
    let _e386 = phi_840_;
    if _e386 {
        let _e387 = column_5;
        let _e388 = sense;
        param_34 = (_e387 - _e388);
        let _e390 = row_5;
        param_35 = _e390;
        let _e391 = layer_at((&param_34), (&param_35));
        before = _e391;
        let _e393 = before.front;
        let _e395 = here_1.back;
        on_front = (abs((_e393 - _e395)) < 0.5f);
        let _e400 = before.split;
        phi_869_ = _e400;
        if _e400 {
            let _e402 = before.back;
            let _e404 = here_1.back;
            phi_869_ = (abs((_e402 - _e404)) < 0.5f);
        }
        let _e409 = phi_869_;
        on_back = _e409;
    }
    loop {
        let _e410 = x_3;
        let _e411 = limit;
        let _e412 = (_e410 < _e411);
        phi_883_ = _e412;
        if _e412 {
            let _e414 = seen_1.rest;
            phi_883_ = (_e414 > 0.01f);
        }
        let _e417 = phi_883_;
        if _e417 {
            let _e419 = here_1.split;
            idle = !(_e419);
            let _e421 = x_3;
            let _e423 = here_1.front;
            let _e425 = t;
            landed = ((_e421 + _e423) - _e425);
            loop {
                let _e427 = idle;
                let _e428 = x_3;
                let _e429 = limit;
                if (_e427 && (_e428 < _e429)) {
                    let _e432 = column_5;
                    let _e433 = sense;
                    param_36 = (_e432 + _e433);
                    let _e435 = row_5;
                    param_37 = _e435;
                    let _e436 = layer_bits((&param_36), (&param_37));
                    ahead = _e436;
                    let _e437 = ahead;
                    param_38 = _e437;
                    let _e438 = full_front((&param_38));
                    following_1 = _e438;
                    let _e439 = x_3;
                    let _e441 = following_1;
                    let _e443 = t;
                    then_1 = (((_e439 + 1f) + _e441) - _e443);
                    let _e445 = ahead;
                    param_39 = _e445;
                    let _e446 = is_full((&param_39));
                    phi_935_ = _e446;
                    if _e446 {
                        let _e447 = following_1;
                        let _e449 = here_1.front;
                        phi_935_ = (abs((_e447 - _e449)) < 0.5f);
                    }
                    let _e454 = phi_935_;
                    phi_943_ = _e454;
                    if _e454 {
                        let _e455 = landed;
                        let _e457 = then_1;
                        phi_943_ = ((_e455 > 0f) || (_e457 <= 0f));
                    }
                    let _e461 = phi_943_;
                    idle = _e461;
                    let _e462 = idle;
                    if _e462 {
                        let _e463 = x_3;
                        x_3 = (_e463 + 1f);
                        let _e465 = sense;
                        let _e466 = column_5;
                        column_5 = (_e466 + _e465);
                        let _e468 = following_1;
                        here_1.front = _e468;
                        let _e470 = then_1;
                        landed = _e470;
                        on_front = false;
                        on_back = false;
                    }
                    continue;
                } else {
                    break;
                }
            }
            let _e471 = x_3;
            let _e472 = limit;
            if (_e471 >= _e472) {
                break;
            }
            let _e474 = column_5;
            let _e475 = sense;
            param_40 = (_e474 + _e475);
            let _e477 = row_5;
            param_41 = _e477;
            let _e478 = layer_at((&param_40), (&param_41));
            next_1 = _e478;
            let _e479 = x_3;
            let _e481 = here_1.front;
            let _e483 = t;
            a = ((_e479 + _e481) - _e483);
            let _e485 = x_3;
            let _e488 = next_1.front;
            let _e490 = t;
            b = (((_e485 + 1f) + _e488) - _e490);
            let _e492 = x_3;
            let _e494 = here_1.back;
            let _e496 = t;
            c = ((_e492 + _e494) - _e496);
            let _e498 = x_3;
            let _e501 = next_1.back;
            let _e503 = t;
            d = (((_e498 + 1f) + _e501) - _e503);
            let _e506 = next_1.front;
            let _e508 = here_1.front;
            front_front = (abs((_e506 - _e508)) < 0.5f);
            let _e513 = next_1.split;
            phi_1019_ = _e513;
            if _e513 {
                let _e515 = next_1.back;
                let _e517 = here_1.front;
                phi_1019_ = (abs((_e515 - _e517)) < 0.5f);
            }
            let _e522 = phi_1019_;
            front_back = _e522;
            let _e524 = here_1.split;
            phi_1032_ = _e524;
            if _e524 {
                let _e526 = next_1.front;
                let _e528 = here_1.back;
                phi_1032_ = (abs((_e526 - _e528)) < 0.5f);
            }
            let _e533 = phi_1032_;
            back_front = _e533;
            let _e535 = here_1.split;
            let _e537 = next_1.split;
            let _e538 = (_e535 && _e537);
            phi_1048_ = _e538;
            if _e538 {
                let _e540 = next_1.back;
                let _e542 = here_1.back;
                phi_1048_ = (abs((_e540 - _e542)) < 0.5f);
            }
            let _e547 = phi_1048_;
            back_back = _e547;
            fronts = vec2<f32>(0f, 0f);
            backs = vec2<f32>(0f, 0f);
            let _e548 = front_front;
            let _e549 = a;
            let _e552 = b;
            if ((_e548 && (_e549 <= 0f)) && (_e552 > 0f)) {
                let _e555 = a;
                let _e557 = b;
                let _e558 = a;
                g_1 = (-(_e555) / (_e557 - _e558));
                let _e561 = g_1;
                param_42 = _e561;
                let _e562 = right_of((&param_42));
                right = _e562;
                let _e564 = here_1.mask;
                param_43 = _e564;
                let _e565 = right;
                param_44 = _e565;
                let _e566 = covered((&param_43), (&param_44));
                let _e567 = right;
                let _e571 = next_1.mask;
                param_45 = _e571;
                param_46 = (vec4(1f) - _e567);
                let _e572 = covered((&param_45), (&param_46));
                shares = vec2<f32>(_e566, _e572);
                let _e575 = shares[0u];
                let _e577 = shares[1u];
                share_3 = (_e575 + _e577);
                let _e579 = x_3;
                let _e580 = g_1;
                let _e583 = here_1.front;
                let _e585 = next_1.front;
                let _e586 = g_1;
                let _e588 = seen_1;
                param_47 = _e588;
                let _e589 = share_3;
                param_48 = _e589;
                param_49 = (_e579 + _e580);
                param_50 = mix(_e583, _e585, _e586);
                let _e590 = cover((&param_47), (&param_48), (&param_49), (&param_50));
                let _e591 = param_47;
                seen_1 = _e591;
                let _e592 = shares;
                let _e594 = share_3;
                fronts = ((_e592 * _e590) / vec2(max(_e594, 0.000001f)));
            }
            let _e598 = front_front;
            let _e599 = !(_e598);
            phi_1129_ = _e599;
            if _e599 {
                let _e601 = next_1.front;
                let _e603 = here_1.front;
                let _e606 = next_1.split;
                phi_1129_ = ((_e601 > _e603) || _e606);
            }
            let _e609 = phi_1129_;
            let _e610 = back_front;
            let _e613 = b;
            let _e616 = b;
            if (((_e609 && !(_e610)) && (_e613 > 0f)) && (_e616 < 1f)) {
                let _e619 = b;
                param_51 = (1f - _e619);
                let _e621 = right_of((&param_51));
                let _e625 = next_1.mask;
                param_52 = _e625;
                param_53 = (vec4(1f) - _e621);
                let _e626 = covered((&param_52), (&param_53));
                share_4 = _e626;
                let _e627 = x_3;
                let _e629 = seen_1;
                param_54 = _e629;
                let _e630 = share_4;
                param_55 = _e630;
                param_56 = (_e627 + 1f);
                let _e632 = next_1.front;
                param_57 = _e632;
                let _e633 = cover((&param_54), (&param_55), (&param_56), (&param_57));
                let _e634 = param_54;
                seen_1 = _e634;
                let _e636 = fronts[1u];
                fronts[1u] = (_e636 + _e633);
            }
            let _e639 = front_front;
            let _e640 = !(_e639);
            phi_1181_ = _e640;
            if _e640 {
                let _e642 = next_1.front;
                let _e644 = here_1.front;
                let _e647 = here_1.split;
                phi_1181_ = ((_e642 < _e644) || _e647);
            }
            let _e650 = phi_1181_;
            let _e651 = front_back;
            let _e654 = a;
            let _e657 = a;
            if (((_e650 && !(_e651)) && (_e654 <= 0f)) && (_e657 > -1f)) {
                let _e660 = a;
                param_58 = -(_e660);
                let _e662 = right_of((&param_58));
                let _e664 = here_1.mask;
                param_59 = _e664;
                param_60 = _e662;
                let _e665 = covered((&param_59), (&param_60));
                let _e666 = seen_1;
                param_61 = _e666;
                param_62 = _e665;
                let _e667 = x_3;
                param_63 = _e667;
                let _e669 = here_1.front;
                param_64 = _e669;
                let _e670 = cover((&param_61), (&param_62), (&param_63), (&param_64));
                let _e671 = param_61;
                seen_1 = _e671;
                let _e673 = fronts[0u];
                fronts[0u] = (_e673 + _e670);
            }
            let _e676 = front_back;
            let _e677 = a;
            let _e680 = d;
            let _e682 = ((_e676 && (_e677 <= 0f)) && (_e680 > 0f));
            phi_1229_ = _e682;
            if _e682 {
                let _e684 = seen_1.rest;
                phi_1229_ = (_e684 > 0.01f);
            }
            let _e687 = phi_1229_;
            if _e687 {
                let _e688 = a;
                let _e690 = d;
                let _e691 = a;
                g_2 = (-(_e688) / (_e690 - _e691));
                let _e694 = x_3;
                let _e695 = g_2;
                let _e697 = seen_1;
                param_65 = _e697;
                param_66 = 1f;
                param_67 = (_e694 + _e695);
                let _e699 = here_1.front;
                param_68 = _e699;
                let _e700 = cover((&param_65), (&param_66), (&param_67), (&param_68));
                let _e701 = param_65;
                seen_1 = _e701;
                taken_1 = _e700;
                let _e702 = taken_1;
                let _e703 = g_2;
                let _e707 = fronts[0u];
                fronts[0u] = (_e707 + (_e702 * (1f - _e703)));
                let _e710 = taken_1;
                let _e711 = g_2;
                let _e714 = backs[1u];
                backs[1u] = (_e714 + (_e710 * _e711));
            }
            let _e717 = back_front;
            let _e718 = c;
            let _e721 = b;
            let _e723 = ((_e717 && (_e718 <= 0f)) && (_e721 > 0f));
            phi_1279_ = _e723;
            if _e723 {
                let _e725 = seen_1.rest;
                phi_1279_ = (_e725 > 0.01f);
            }
            let _e728 = phi_1279_;
            if _e728 {
                let _e729 = c;
                let _e731 = b;
                let _e732 = c;
                g_3 = (-(_e729) / (_e731 - _e732));
                let _e735 = x_3;
                let _e736 = g_3;
                let _e738 = seen_1;
                param_69 = _e738;
                param_70 = 1f;
                param_71 = (_e735 + _e736);
                let _e740 = next_1.front;
                param_72 = _e740;
                let _e741 = cover((&param_69), (&param_70), (&param_71), (&param_72));
                let _e742 = param_69;
                seen_1 = _e742;
                taken_2 = _e741;
                let _e743 = taken_2;
                let _e744 = g_3;
                let _e748 = backs[0u];
                backs[0u] = (_e748 + (_e743 * (1f - _e744)));
                let _e751 = taken_2;
                let _e752 = g_3;
                let _e755 = fronts[1u];
                fronts[1u] = (_e755 + (_e751 * _e752));
            }
            let _e758 = back_back;
            let _e759 = c;
            let _e762 = d;
            let _e764 = ((_e758 && (_e759 <= 0f)) && (_e762 > 0f));
            phi_1329_ = _e764;
            if _e764 {
                let _e766 = seen_1.rest;
                phi_1329_ = (_e766 > 0.01f);
            }
            let _e769 = phi_1329_;
            if _e769 {
                let _e770 = c;
                let _e772 = d;
                let _e773 = c;
                g_4 = (-(_e770) / (_e772 - _e773));
                let _e776 = x_3;
                let _e777 = g_4;
                let _e779 = seen_1;
                param_73 = _e779;
                param_74 = 1f;
                param_75 = (_e776 + _e777);
                let _e781 = here_1.back;
                param_76 = _e781;
                let _e782 = cover((&param_73), (&param_74), (&param_75), (&param_76));
                let _e783 = param_73;
                seen_1 = _e783;
                taken_3 = _e782;
                let _e784 = taken_3;
                let _e785 = g_4;
                let _e787 = g_4;
                let _e790 = backs;
                backs = (_e790 + (vec2<f32>((1f - _e785), _e787) * _e784));
            }
            let _e793 = here_1.split;
            let _e794 = back_front;
            let _e797 = back_back;
            ends = ((_e793 && !(_e794)) && !(_e797));
            let _e800 = ends;
            let _e801 = on_front;
            let _e804 = on_back;
            let _e806 = ((_e800 && !(_e801)) && !(_e804));
            phi_1381_ = _e806;
            if _e806 {
                let _e807 = c;
                phi_1381_ = (abs(_e807) < 1f);
            }
            let _e811 = phi_1381_;
            phi_1387_ = _e811;
            if _e811 {
                let _e813 = seen_1.rest;
                phi_1387_ = (_e813 > 0.01f);
            }
            let _e816 = phi_1387_;
            if _e816 {
                let _e817 = c;
                if (_e817 <= 0f) {
                    let _e819 = c;
                    param_77 = -(_e819);
                    let _e821 = right_of((&param_77));
                    local_8 = _e821;
                } else {
                    let _e822 = c;
                    param_78 = (1f - _e822);
                    let _e824 = right_of((&param_78));
                    local_8 = (vec4(1f) - _e824);
                }
                let _e827 = local_8;
                stripes_1 = _e827;
                let _e829 = here_1.mask;
                param_79 = (vec4(1f) - _e829);
                let _e832 = stripes_1;
                param_80 = _e832;
                let _e833 = covered((&param_79), (&param_80));
                let _e834 = seen_1;
                param_81 = _e834;
                param_82 = _e833;
                let _e835 = x_3;
                param_83 = _e835;
                let _e837 = here_1.back;
                param_84 = _e837;
                let _e838 = cover((&param_81), (&param_82), (&param_83), (&param_84));
                let _e839 = param_81;
                seen_1 = _e839;
                let _e841 = backs[0u];
                backs[0u] = (_e841 + _e838);
            }
            let _e844 = ends;
            phi_1439_ = _e844;
            if _e844 {
                let _e846 = next_1.front;
                let _e848 = here_1.back;
                phi_1439_ = (_e846 > _e848);
            }
            let _e851 = phi_1439_;
            let _e852 = c;
            at_back = (_e851 && (_e852 <= 0f));
            let _e856 = here_1.split;
            let _e858 = front_front;
            let _e861 = front_back;
            let _e863 = ((!(_e856) && !(_e858)) && !(_e861));
            phi_1460_ = _e863;
            if _e863 {
                let _e865 = next_1.front;
                let _e867 = here_1.front;
                phi_1460_ = (_e865 > _e867);
            }
            let _e870 = phi_1460_;
            let _e871 = a;
            at_front = (_e870 && (_e871 <= 0f));
            let _e874 = at_back;
            let _e875 = at_front;
            let _e876 = (_e874 || _e875);
            phi_1472_ = _e876;
            if _e876 {
                let _e878 = seen_1.rest;
                phi_1472_ = (_e878 > 0.01f);
            }
            let _e881 = phi_1472_;
            if _e881 {
                let _e882 = at_back;
                if _e882 {
                    let _e884 = here_1.back;
                    local_9 = _e884;
                } else {
                    let _e886 = here_1.front;
                    local_9 = _e886;
                }
                let _e887 = local_9;
                reach_2 = _e887;
                let _e888 = at_back;
                if _e888 {
                    let _e889 = c;
                    local_10 = -(_e889);
                } else {
                    let _e891 = a;
                    local_10 = -(_e891);
                }
                let _e893 = local_10;
                away = _e893;
                let _e894 = at_back;
                let _e895 = on_front;
                if (_e894 && !(_e895)) {
                    let _e899 = here_1.mask;
                    param_85 = _e899;
                    param_86 = vec4<f32>(1f, 1f, 1f, 1f);
                    let _e900 = covered((&param_85), (&param_86));
                    local_11 = (1f - _e900);
                } else {
                    local_11 = 1f;
                }
                let _e902 = local_11;
                weight = _e902;
                let _e903 = column_5;
                let _e904 = at_back;
                let _e905 = reach_2;
                let _e906 = weight;
                found = Edge(_e903, _e904, _e905, _e906);
                let _e908 = weight;
                let _e910 = away;
                if ((_e908 == 1f) && (_e910 < 0.5f)) {
                    let _e913 = seen_1;
                    param_87 = _e913;
                    param_88 = 1f;
                    let _e914 = x_3;
                    param_89 = _e914;
                    let _e915 = reach_2;
                    param_90 = _e915;
                    let _e916 = cover((&param_87), (&param_88), (&param_89), (&param_90));
                    let _e917 = param_87;
                    seen_1 = _e917;
                    taken_4 = _e916;
                    let _e918 = at_back;
                    let _e919 = taken_4;
                    let _e922 = backs[0u];
                    backs[0u] = (_e922 + select(0f, _e919, _e918));
                    let _e925 = at_back;
                    let _e926 = taken_4;
                    let _e929 = fronts[0u];
                    fronts[0u] = (_e929 + select(_e926, 0f, _e925));
                }
                let _e932 = reach_2;
                let _e934 = edge.reach;
                if (_e932 < _e934) {
                    let _e936 = weight;
                    if (_e936 < 1f) {
                        let _e938 = edge;
                        second = _e938;
                    }
                    let _e939 = found;
                    edge = _e939;
                } else {
                    let _e940 = reach_2;
                    let _e942 = second.reach;
                    if (_e940 < _e942) {
                        let _e944 = found;
                        second = _e944;
                    }
                }
            }
            let _e946 = fronts[0u];
            let _e948 = backs[0u];
            if (max(_e946, _e948) > 0f) {
                let _e951 = column_5;
                param_91 = _e951;
                let _e952 = row_5;
                param_92 = _e952;
                let _e954 = fronts[0u];
                param_93 = _e954;
                let _e956 = backs[0u];
                param_94 = _e956;
                let _e957 = weighted((&param_91), (&param_92), (&param_93), (&param_94));
                let _e958 = color;
                color = (_e958 + _e957);
            }
            let _e961 = fronts[1u];
            let _e963 = backs[1u];
            if (max(_e961, _e963) > 0f) {
                let _e966 = column_5;
                let _e967 = sense;
                param_95 = (_e966 + _e967);
                let _e969 = row_5;
                param_96 = _e969;
                let _e971 = fronts[1u];
                param_97 = _e971;
                let _e973 = backs[1u];
                param_98 = _e973;
                let _e974 = weighted((&param_95), (&param_96), (&param_97), (&param_98));
                let _e975 = color;
                color = (_e975 + _e974);
            }
            let _e977 = front_back;
            on_front = _e977;
            let _e978 = back_back;
            on_back = _e978;
            let _e979 = next_1;
            here_1 = _e979;
            let _e980 = sense;
            let _e981 = column_5;
            column_5 = (_e981 + _e980);
            let _e983 = x_3;
            x_3 = (_e983 + 1f);
            continue;
        } else {
            break;
        }
    }
    let _e986 = seen_1.rest;
    hole = (_e986 > 0.5f);
    let _e989 = seen_1.rest;
    if (_e989 > 0.01f) {
        let _e992 = edge.column;
        beyond = (_e992 < 0i);
        let _e994 = beyond;
        if _e994 {
            let _e995 = column_5;
            let _e997 = here_1.split;
            let _e999 = here_1.split;
            if _e999 {
                let _e1001 = here_1.back;
                local_12 = _e1001;
            } else {
                let _e1003 = here_1.front;
                local_12 = _e1003;
            }
            let _e1004 = local_12;
            edge = Edge(_e995, _e997, _e1004, 1f);
        }
        let _e1007 = edge.column;
        param_99 = _e1007;
        let _e1008 = source_column((&param_99));
        edge_x = f32(_e1008);
        let _e1010 = t;
        let _e1011 = edge_x;
        let _e1014 = edge.reach;
        away_1 = abs(((_e1010 - _e1011) - _e1014));
        let _e1017 = away_1;
        spread = (0.5f * clamp(_e1017, 1f, 12f));
        sum_1 = vec4<f32>(0f, 0f, 0f, 0f);
        weights = 0f;
        let _e1020 = beyond;
        let _e1021 = away_1;
        rows = select(2i, 0i, (_e1020 && (_e1021 < 0.5f)));
        let _e1025 = rows;
        i = -(_e1025);
        loop {
            let _e1027 = i;
            let _e1028 = rows;
            if (_e1027 <= _e1028) {
                let _e1030 = row_5;
                let _e1031 = i;
                let _e1033 = spread;
                let _e1040 = synthesis.source_size[1u];
                at_1 = clamp((_e1030 + i32(round((f32(_e1031) * _e1033)))), 0i, (_e1040 - 1i));
                let _e1044 = edge.column;
                param_100 = _e1044;
                let _e1045 = at_1;
                param_101 = _e1045;
                let _e1046 = layer_at((&param_100), (&param_101));
                layer_3 = _e1046;
                let _e1047 = i;
                if (_e1047 == 0i) {
                    let _e1050 = edge.back;
                    local_13 = !(_e1050);
                } else {
                    let _e1053 = layer_3.front;
                    let _e1055 = edge.reach;
                    local_13 = (_e1053 <= (_e1055 + 1f));
                }
                let _e1058 = local_13;
                front_2 = _e1058;
                let _e1059 = i;
                if (_e1059 == 0i) {
                    let _e1062 = edge.back;
                    local_14 = _e1062;
                } else {
                    let _e1063 = front_2;
                    let _e1066 = layer_3.split;
                    let _e1067 = (!(_e1063) && _e1066);
                    phi_1750_ = _e1067;
                    if _e1067 {
                        let _e1069 = layer_3.back;
                        let _e1071 = edge.reach;
                        phi_1750_ = (_e1069 <= (_e1071 + 1f));
                    }
                    let _e1075 = phi_1750_;
                    local_14 = _e1075;
                }
                let _e1076 = local_14;
                behind_1 = _e1076;
                let _e1077 = i;
                if (_e1077 == 0i) {
                    local_15 = 2f;
                } else {
                    let _e1079 = front_2;
                    if _e1079 {
                        local_16 = 1f;
                    } else {
                        let _e1080 = behind_1;
                        if _e1080 {
                            let _e1082 = layer_3.mask;
                            param_102 = _e1082;
                            param_103 = vec4<f32>(1f, 1f, 1f, 1f);
                            let _e1083 = covered((&param_102), (&param_103));
                            local_17 = (1f - _e1083);
                        } else {
                            local_17 = 0f;
                        }
                        let _e1085 = local_17;
                        local_16 = _e1085;
                    }
                    let _e1086 = local_16;
                    local_15 = _e1086;
                }
                let _e1087 = local_15;
                weight_1 = _e1087;
                let _e1088 = front_2;
                let _e1089 = weight_1;
                let _e1091 = front_2;
                let _e1092 = weight_1;
                let _e1095 = edge.column;
                param_104 = _e1095;
                let _e1096 = at_1;
                param_105 = _e1096;
                param_106 = select(0f, _e1089, _e1088);
                param_107 = select(_e1092, 0f, _e1091);
                let _e1097 = weighted((&param_104), (&param_105), (&param_106), (&param_107));
                let _e1098 = sum_1;
                sum_1 = (_e1098 + _e1097);
                let _e1100 = weight_1;
                let _e1101 = weights;
                weights = (_e1101 + _e1100);
                continue;
            } else {
                break;
            }
            continuing {
                let _e1103 = i;
                i = (_e1103 + 1i);
            }
        }
        let _e1105 = sum_1;
        let _e1106 = weights;
        fill = (_e1105 / vec4(_e1106));
        let _e1110 = second.column;
        let _e1111 = (_e1110 >= 0i);
        phi_1812_ = _e1111;
        if _e1111 {
            let _e1113 = edge.weight;
            phi_1812_ = (_e1113 < 1f);
        }
        let _e1116 = phi_1812_;
        if _e1116 {
            let _e1118 = second.back;
            one = select(vec2<f32>(1f, 0f), vec2<f32>(0f, 1f), vec2(_e1118));
            let _e1122 = second.column;
            param_108 = _e1122;
            let _e1123 = row_5;
            param_109 = _e1123;
            let _e1125 = one[0u];
            param_110 = _e1125;
            let _e1127 = one[1u];
            param_111 = _e1127;
            let _e1128 = weighted((&param_108), (&param_109), (&param_110), (&param_111));
            let _e1129 = fill;
            let _e1131 = edge.weight;
            fill = mix(_e1128, _e1129, vec4(_e1131));
        }
        let _e1134 = hole;
        let _e1135 = away_1;
        hole = (_e1134 && (_e1135 >= 0.5f));
        let _e1138 = seen_1;
        param_112 = _e1138;
        param_113 = 1f;
        let _e1139 = edge_x;
        param_114 = _e1139;
        let _e1141 = edge.reach;
        param_115 = _e1141;
        let _e1142 = cover((&param_112), (&param_113), (&param_114), (&param_115));
        let _e1143 = param_112;
        seen_1 = _e1143;
        let _e1144 = fill;
        let _e1146 = color;
        color = (_e1146 + (_e1144 * _e1142));
    }
    return;
}

@fragment 
fn main(@location(0) span_at: vec2<f32>, @builtin(position) gl_FragCoord: vec4<f32>) -> @location(0) vec4<f32> {
    span_at_1 = span_at;
    gl_FragCoord_1 = gl_FragCoord;
    main_1();
    let _e5 = color;
    return _e5;
}
