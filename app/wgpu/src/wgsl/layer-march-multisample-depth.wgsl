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

struct FragmentOutput {
    @location(0) member: vec4<f32>,
    @builtin(frag_depth) member_1: f32,
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
var<private> gl_FragDepth: f32 = 0f;

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
    var mask_1: vec4<f32>;

    let _e19 = (*column_2);
    param_1 = _e19;
    let _e20 = (*row_2);
    param_2 = _e20;
    let _e21 = layer_bits((&param_1), (&param_2));
    bits = _e21;
    let _e22 = bits;
    param_3 = _e22;
    let _e23 = is_full((&param_3));
    if _e23 {
        let _e24 = bits;
        param_4 = _e24;
        let _e25 = full_front((&param_4));
        return Layer(_e25, 1000000000f, false, vec4<f32>(1f, 1f, 1f, 1f));
    }
    let _e27 = bits;
    param_5 = _e27;
    let _e28 = split_displacements((&param_5));
    both = _e28;
    let _e29 = bits;
    code = (_e29 >> bitcast<u32>(28i));
    let _e32 = code;
    mask_1 = vec4<f32>(((vec4(_e32) >> bitcast<vec4<u32>>(vec4<u32>(0u, 1u, 2u, 3u))) & vec4(1u)));
    let _e40 = both[0u];
    let _e42 = both[1u];
    let _e43 = mask_1;
    return Layer(_e40, _e42, true, _e43);
}

fn source_column(x: ptr<function, i32>) -> i32 {
    var local_2: i32;

    let _e6 = synthesis.mirrored;
    if (_e6 != 0u) {
        let _e10 = synthesis.source_size[0u];
        let _e12 = (*x);
        local_2 = ((_e10 - 1i) - _e12);
    } else {
        let _e14 = (*x);
        local_2 = _e14;
    }
    let _e15 = local_2;
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

fn cover(seen: ptr<function, Seen>, share_1: ptr<function, f32>, column_4: ptr<function, f32>, reach_1: ptr<function, f32>) -> f32 {
    var taken: f32;
    var passes: bool;
    var local_3: f32;
    var local_4: f32;
    var phi_528_: bool;

    let _e10 = (*seen).rest;
    let _e11 = (*share_1);
    taken = (_e10 * _e11);
    let _e14 = (*seen).rest;
    let _e15 = (_e14 > 0.5f);
    phi_528_ = _e15;
    if _e15 {
        let _e17 = (*seen).rest;
        let _e18 = taken;
        phi_528_ = ((_e17 - _e18) <= 0.5f);
    }
    let _e22 = phi_528_;
    passes = _e22;
    let _e23 = passes;
    if _e23 {
        let _e24 = (*column_4);
        local_3 = _e24;
    } else {
        let _e26 = (*seen).column;
        local_3 = _e26;
    }
    let _e27 = local_3;
    (*seen).column = _e27;
    let _e29 = passes;
    if _e29 {
        let _e30 = (*reach_1);
        local_4 = _e30;
    } else {
        let _e32 = (*seen).reach;
        local_4 = _e32;
    }
    let _e33 = local_4;
    (*seen).reach = _e33;
    let _e35 = taken;
    let _e37 = (*seen).rest;
    (*seen).rest = (_e37 - _e35);
    let _e40 = taken;
    return _e40;
}

fn span_steps(span: ptr<function, u32>) -> f32 {
    var steps: u32;
    var local_5: f32;

    let _e5 = (*span);
    steps = (_e5 & 1023u);
    let _e7 = steps;
    if (_e7 == 1023u) {
        local_5 = 1000000000f;
    } else {
        let _e9 = steps;
        local_5 = f32(_e9);
    }
    let _e11 = local_5;
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
    var share_2: f32;
    var param_47: Seen;
    var param_48: f32;
    var param_49: f32;
    var param_50: f32;
    var share_3: f32;
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
    var local_6: vec4<f32>;
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
    var local_7: f32;
    var away: f32;
    var local_8: f32;
    var weight: f32;
    var local_9: f32;
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
    var local_10: f32;
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
    var local_11: bool;
    var behind_1: bool;
    var local_12: bool;
    var weight_1: f32;
    var local_13: f32;
    var local_14: f32;
    var local_15: f32;
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
    var phi_685_: bool;
    var phi_779_: bool;
    var phi_786_: bool;
    var phi_805_: bool;
    var phi_834_: bool;
    var phi_848_: bool;
    var phi_900_: bool;
    var phi_908_: bool;
    var phi_984_: bool;
    var phi_997_: bool;
    var phi_1013_: bool;
    var phi_1094_: bool;
    var phi_1146_: bool;
    var phi_1194_: bool;
    var phi_1244_: bool;
    var phi_1294_: bool;
    var phi_1346_: bool;
    var phi_1352_: bool;
    var phi_1404_: bool;
    var phi_1425_: bool;
    var phi_1437_: bool;
    var phi_1715_: bool;
    var phi_1777_: bool;

    let _e214 = synthesis.source_size[0u];
    last_2 = f32((_e214 - 1i));
    let _e218 = gl_FragCoord_1[1u];
    let _e220 = synthesis.first_row;
    let _e224 = synthesis.source_size[1u];
    row_5 = i32(clamp((_e218 - _e220), 0f, f32((_e224 - 1i))));
    let _e231 = synthesis.origins[0u];
    let _e233 = gl_FragCoord_1[0u];
    let _e237 = synthesis.origins[1u];
    let _e240 = synthesis.farthest;
    t = ((((_e231 * _e233) + _e237) - _e240) + 0.01f);
    let _e243 = pixel_span();
    span_1 = _e243.x;
    let _e245 = t;
    let _e246 = span_1;
    let _e251 = last_2;
    x_3 = clamp(floor(((_e245 - bitcast<f32>(_e246)) - 1.01f)), 0f, _e251);
    let _e253 = x_3;
    let _e254 = span_1;
    param_16 = _e254;
    let _e255 = span_steps((&param_16));
    let _e258 = last_2;
    limit = min(((_e253 + _e255) + 2f), _e258);
    let _e261 = synthesis.mirrored;
    sense = select(1i, -1i, (_e261 != 0u));
    let _e264 = x_3;
    param_17 = i32(_e264);
    let _e266 = source_column((&param_17));
    column_5 = _e266;
    seen_1 = Seen(1f, 0f, 0f);
    color = vec4<f32>(0f, 0f, 0f, 0f);
    let _e267 = column_5;
    param_18 = _e267;
    let _e268 = row_5;
    param_19 = _e268;
    let _e269 = layer_bits((&param_18), (&param_19));
    bits_1 = _e269;
    let _e270 = bits_1;
    param_20 = _e270;
    let _e271 = full_front((&param_20));
    front_1 = _e271;
    let _e272 = x_3;
    let _e273 = front_1;
    let _e275 = t;
    at = ((_e272 + _e273) - _e275);
    let _e277 = bits_1;
    param_21 = _e277;
    let _e278 = is_full((&param_21));
    let _e279 = at;
    plain = (_e278 && (_e279 <= 0f));
    loop {
        let _e282 = plain;
        let _e283 = x_3;
        let _e284 = limit;
        if (_e282 && (_e283 < _e284)) {
            let _e287 = column_5;
            let _e288 = sense;
            param_22 = (_e287 + _e288);
            let _e290 = row_5;
            param_23 = _e290;
            let _e291 = layer_bits((&param_22), (&param_23));
            bits_1 = _e291;
            let _e292 = bits_1;
            param_24 = _e292;
            let _e293 = full_front((&param_24));
            following = _e293;
            let _e294 = bits_1;
            param_25 = _e294;
            let _e295 = is_full((&param_25));
            phi_685_ = _e295;
            if _e295 {
                let _e296 = following;
                let _e297 = front_1;
                phi_685_ = (abs((_e296 - _e297)) < 0.5f);
            }
            let _e302 = phi_685_;
            plain = _e302;
            let _e303 = x_3;
            let _e305 = following;
            let _e307 = t;
            then = (((_e303 + 1f) + _e305) - _e307);
            let _e309 = plain;
            let _e310 = then;
            if (_e309 && (_e310 > 0f)) {
                let _e313 = at;
                let _e315 = then;
                let _e316 = at;
                g = (-(_e313) / (_e315 - _e316));
                let _e319 = x_3;
                let _e320 = g;
                let _e322 = front_1;
                let _e323 = following;
                let _e324 = g;
                let _e326 = seen_1;
                param_26 = _e326;
                param_27 = 1f;
                param_28 = (_e319 + _e320);
                param_29 = mix(_e322, _e323, _e324);
                let _e327 = cover((&param_26), (&param_27), (&param_28), (&param_29));
                let _e328 = param_26;
                seen_1 = _e328;
                let _e329 = x_3;
                limit = _e329;
            } else {
                let _e330 = plain;
                if _e330 {
                    let _e331 = x_3;
                    x_3 = (_e331 + 1f);
                    let _e333 = sense;
                    let _e334 = column_5;
                    column_5 = (_e334 + _e333);
                    let _e336 = following;
                    front_1 = _e336;
                    let _e337 = then;
                    at = _e337;
                }
            }
            continue;
        } else {
            break;
        }
    }
    let _e339 = seen_1.rest;
    if (_e339 < 0.01f) {
        let _e342 = seen_1.column;
        param_30 = _e342;
        let _e343 = row_5;
        param_31 = _e343;
        let _e344 = sharp_color_at((&param_30), (&param_31));
        color = _e344;
    }
    let _e345 = column_5;
    param_32 = _e345;
    let _e346 = row_5;
    param_33 = _e346;
    let _e347 = layer_at((&param_32), (&param_33));
    here_1 = _e347;
    edge = Edge(-1i, false, 1000000000f, 1f);
    let _e348 = edge;
    second = _e348;
    let _e349 = x_3;
    if (_e349 == 0f) {
        let _e352 = here_1.front;
        let _e353 = t;
        if (_e352 > _e353) {
            let _e355 = column_5;
            let _e357 = here_1.front;
            edge = Edge(_e355, false, _e357, 1f);
        }
        let _e360 = here_1.split;
        phi_779_ = _e360;
        if _e360 {
            let _e362 = here_1.back;
            let _e364 = edge.reach;
            phi_779_ = (_e362 < _e364);
        }
        let _e367 = phi_779_;
        phi_786_ = _e367;
        if _e367 {
            let _e369 = here_1.back;
            let _e370 = t;
            phi_786_ = (_e369 > _e370);
        }
        let _e373 = phi_786_;
        if _e373 {
            let _e374 = column_5;
            let _e376 = here_1.back;
            edge = Edge(_e374, true, _e376, 1f);
        }
    }
    on_front = false;
    on_back = false;
    let _e378 = x_3;
    let _e381 = here_1.split;
    let _e382 = ((_e378 > 0f) && _e381);
    phi_805_ = _e382;
    if _e382 {
        let _e384 = seen_1.rest;
        phi_805_ = (_e384 > 0.01f);
    }
    let _e387 = phi_805_;
    if _e387 {
        let _e388 = column_5;
        let _e389 = sense;
        param_34 = (_e388 - _e389);
        let _e391 = row_5;
        param_35 = _e391;
        let _e392 = layer_at((&param_34), (&param_35));
        before = _e392;
        let _e394 = before.front;
        let _e396 = here_1.back;
        on_front = (abs((_e394 - _e396)) < 0.5f);
        let _e401 = before.split;
        phi_834_ = _e401;
        if _e401 {
            let _e403 = before.back;
            let _e405 = here_1.back;
            phi_834_ = (abs((_e403 - _e405)) < 0.5f);
        }
        let _e410 = phi_834_;
        on_back = _e410;
    }
    loop {
        let _e411 = x_3;
        let _e412 = limit;
        let _e413 = (_e411 < _e412);
        phi_848_ = _e413;
        if _e413 {
            let _e415 = seen_1.rest;
            phi_848_ = (_e415 > 0.01f);
        }
        let _e418 = phi_848_;
        if _e418 {
            let _e420 = here_1.split;
            idle = !(_e420);
            let _e422 = x_3;
            let _e424 = here_1.front;
            let _e426 = t;
            landed = ((_e422 + _e424) - _e426);
            loop {
                let _e428 = idle;
                let _e429 = x_3;
                let _e430 = limit;
                if (_e428 && (_e429 < _e430)) {
                    let _e433 = column_5;
                    let _e434 = sense;
                    param_36 = (_e433 + _e434);
                    let _e436 = row_5;
                    param_37 = _e436;
                    let _e437 = layer_bits((&param_36), (&param_37));
                    ahead = _e437;
                    let _e438 = ahead;
                    param_38 = _e438;
                    let _e439 = full_front((&param_38));
                    following_1 = _e439;
                    let _e440 = x_3;
                    let _e442 = following_1;
                    let _e444 = t;
                    then_1 = (((_e440 + 1f) + _e442) - _e444);
                    let _e446 = ahead;
                    param_39 = _e446;
                    let _e447 = is_full((&param_39));
                    phi_900_ = _e447;
                    if _e447 {
                        let _e448 = following_1;
                        let _e450 = here_1.front;
                        phi_900_ = (abs((_e448 - _e450)) < 0.5f);
                    }
                    let _e455 = phi_900_;
                    phi_908_ = _e455;
                    if _e455 {
                        let _e456 = landed;
                        let _e458 = then_1;
                        phi_908_ = ((_e456 > 0f) || (_e458 <= 0f));
                    }
                    let _e462 = phi_908_;
                    idle = _e462;
                    let _e463 = idle;
                    if _e463 {
                        let _e464 = x_3;
                        x_3 = (_e464 + 1f);
                        let _e466 = sense;
                        let _e467 = column_5;
                        column_5 = (_e467 + _e466);
                        let _e469 = following_1;
                        here_1.front = _e469;
                        let _e471 = then_1;
                        landed = _e471;
                        on_front = false;
                        on_back = false;
                    }
                    continue;
                } else {
                    break;
                }
            }
            let _e472 = x_3;
            let _e473 = limit;
            if (_e472 >= _e473) {
                break;
            }
            let _e475 = column_5;
            let _e476 = sense;
            param_40 = (_e475 + _e476);
            let _e478 = row_5;
            param_41 = _e478;
            let _e479 = layer_at((&param_40), (&param_41));
            next_1 = _e479;
            let _e480 = x_3;
            let _e482 = here_1.front;
            let _e484 = t;
            a = ((_e480 + _e482) - _e484);
            let _e486 = x_3;
            let _e489 = next_1.front;
            let _e491 = t;
            b = (((_e486 + 1f) + _e489) - _e491);
            let _e493 = x_3;
            let _e495 = here_1.back;
            let _e497 = t;
            c = ((_e493 + _e495) - _e497);
            let _e499 = x_3;
            let _e502 = next_1.back;
            let _e504 = t;
            d = (((_e499 + 1f) + _e502) - _e504);
            let _e507 = next_1.front;
            let _e509 = here_1.front;
            front_front = (abs((_e507 - _e509)) < 0.5f);
            let _e514 = next_1.split;
            phi_984_ = _e514;
            if _e514 {
                let _e516 = next_1.back;
                let _e518 = here_1.front;
                phi_984_ = (abs((_e516 - _e518)) < 0.5f);
            }
            let _e523 = phi_984_;
            front_back = _e523;
            let _e525 = here_1.split;
            phi_997_ = _e525;
            if _e525 {
                let _e527 = next_1.front;
                let _e529 = here_1.back;
                phi_997_ = (abs((_e527 - _e529)) < 0.5f);
            }
            let _e534 = phi_997_;
            back_front = _e534;
            let _e536 = here_1.split;
            let _e538 = next_1.split;
            let _e539 = (_e536 && _e538);
            phi_1013_ = _e539;
            if _e539 {
                let _e541 = next_1.back;
                let _e543 = here_1.back;
                phi_1013_ = (abs((_e541 - _e543)) < 0.5f);
            }
            let _e548 = phi_1013_;
            back_back = _e548;
            fronts = vec2<f32>(0f, 0f);
            backs = vec2<f32>(0f, 0f);
            let _e549 = front_front;
            let _e550 = a;
            let _e553 = b;
            if ((_e549 && (_e550 <= 0f)) && (_e553 > 0f)) {
                let _e556 = a;
                let _e558 = b;
                let _e559 = a;
                g_1 = (-(_e556) / (_e558 - _e559));
                let _e562 = g_1;
                param_42 = _e562;
                let _e563 = right_of((&param_42));
                right = _e563;
                let _e565 = here_1.mask;
                param_43 = _e565;
                let _e566 = right;
                param_44 = _e566;
                let _e567 = covered((&param_43), (&param_44));
                let _e568 = right;
                let _e572 = next_1.mask;
                param_45 = _e572;
                param_46 = (vec4(1f) - _e568);
                let _e573 = covered((&param_45), (&param_46));
                shares = vec2<f32>(_e567, _e573);
                let _e576 = shares[0u];
                let _e578 = shares[1u];
                share_2 = (_e576 + _e578);
                let _e580 = x_3;
                let _e581 = g_1;
                let _e584 = here_1.front;
                let _e586 = next_1.front;
                let _e587 = g_1;
                let _e589 = seen_1;
                param_47 = _e589;
                let _e590 = share_2;
                param_48 = _e590;
                param_49 = (_e580 + _e581);
                param_50 = mix(_e584, _e586, _e587);
                let _e591 = cover((&param_47), (&param_48), (&param_49), (&param_50));
                let _e592 = param_47;
                seen_1 = _e592;
                let _e593 = shares;
                let _e595 = share_2;
                fronts = ((_e593 * _e591) / vec2(max(_e595, 0.000001f)));
            }
            let _e599 = front_front;
            let _e600 = !(_e599);
            phi_1094_ = _e600;
            if _e600 {
                let _e602 = next_1.front;
                let _e604 = here_1.front;
                let _e607 = next_1.split;
                phi_1094_ = ((_e602 > _e604) || _e607);
            }
            let _e610 = phi_1094_;
            let _e611 = back_front;
            let _e614 = b;
            let _e617 = b;
            if (((_e610 && !(_e611)) && (_e614 > 0f)) && (_e617 < 1f)) {
                let _e620 = b;
                param_51 = (1f - _e620);
                let _e622 = right_of((&param_51));
                let _e626 = next_1.mask;
                param_52 = _e626;
                param_53 = (vec4(1f) - _e622);
                let _e627 = covered((&param_52), (&param_53));
                share_3 = _e627;
                let _e628 = x_3;
                let _e630 = seen_1;
                param_54 = _e630;
                let _e631 = share_3;
                param_55 = _e631;
                param_56 = (_e628 + 1f);
                let _e633 = next_1.front;
                param_57 = _e633;
                let _e634 = cover((&param_54), (&param_55), (&param_56), (&param_57));
                let _e635 = param_54;
                seen_1 = _e635;
                let _e637 = fronts[1u];
                fronts[1u] = (_e637 + _e634);
            }
            let _e640 = front_front;
            let _e641 = !(_e640);
            phi_1146_ = _e641;
            if _e641 {
                let _e643 = next_1.front;
                let _e645 = here_1.front;
                let _e648 = here_1.split;
                phi_1146_ = ((_e643 < _e645) || _e648);
            }
            let _e651 = phi_1146_;
            let _e652 = front_back;
            let _e655 = a;
            let _e658 = a;
            if (((_e651 && !(_e652)) && (_e655 <= 0f)) && (_e658 > -1f)) {
                let _e661 = a;
                param_58 = -(_e661);
                let _e663 = right_of((&param_58));
                let _e665 = here_1.mask;
                param_59 = _e665;
                param_60 = _e663;
                let _e666 = covered((&param_59), (&param_60));
                let _e667 = seen_1;
                param_61 = _e667;
                param_62 = _e666;
                let _e668 = x_3;
                param_63 = _e668;
                let _e670 = here_1.front;
                param_64 = _e670;
                let _e671 = cover((&param_61), (&param_62), (&param_63), (&param_64));
                let _e672 = param_61;
                seen_1 = _e672;
                let _e674 = fronts[0u];
                fronts[0u] = (_e674 + _e671);
            }
            let _e677 = front_back;
            let _e678 = a;
            let _e681 = d;
            let _e683 = ((_e677 && (_e678 <= 0f)) && (_e681 > 0f));
            phi_1194_ = _e683;
            if _e683 {
                let _e685 = seen_1.rest;
                phi_1194_ = (_e685 > 0.01f);
            }
            let _e688 = phi_1194_;
            if _e688 {
                let _e689 = a;
                let _e691 = d;
                let _e692 = a;
                g_2 = (-(_e689) / (_e691 - _e692));
                let _e695 = x_3;
                let _e696 = g_2;
                let _e698 = seen_1;
                param_65 = _e698;
                param_66 = 1f;
                param_67 = (_e695 + _e696);
                let _e700 = here_1.front;
                param_68 = _e700;
                let _e701 = cover((&param_65), (&param_66), (&param_67), (&param_68));
                let _e702 = param_65;
                seen_1 = _e702;
                taken_1 = _e701;
                let _e703 = taken_1;
                let _e704 = g_2;
                let _e708 = fronts[0u];
                fronts[0u] = (_e708 + (_e703 * (1f - _e704)));
                let _e711 = taken_1;
                let _e712 = g_2;
                let _e715 = backs[1u];
                backs[1u] = (_e715 + (_e711 * _e712));
            }
            let _e718 = back_front;
            let _e719 = c;
            let _e722 = b;
            let _e724 = ((_e718 && (_e719 <= 0f)) && (_e722 > 0f));
            phi_1244_ = _e724;
            if _e724 {
                let _e726 = seen_1.rest;
                phi_1244_ = (_e726 > 0.01f);
            }
            let _e729 = phi_1244_;
            if _e729 {
                let _e730 = c;
                let _e732 = b;
                let _e733 = c;
                g_3 = (-(_e730) / (_e732 - _e733));
                let _e736 = x_3;
                let _e737 = g_3;
                let _e739 = seen_1;
                param_69 = _e739;
                param_70 = 1f;
                param_71 = (_e736 + _e737);
                let _e741 = next_1.front;
                param_72 = _e741;
                let _e742 = cover((&param_69), (&param_70), (&param_71), (&param_72));
                let _e743 = param_69;
                seen_1 = _e743;
                taken_2 = _e742;
                let _e744 = taken_2;
                let _e745 = g_3;
                let _e749 = backs[0u];
                backs[0u] = (_e749 + (_e744 * (1f - _e745)));
                let _e752 = taken_2;
                let _e753 = g_3;
                let _e756 = fronts[1u];
                fronts[1u] = (_e756 + (_e752 * _e753));
            }
            let _e759 = back_back;
            let _e760 = c;
            let _e763 = d;
            let _e765 = ((_e759 && (_e760 <= 0f)) && (_e763 > 0f));
            phi_1294_ = _e765;
            if _e765 {
                let _e767 = seen_1.rest;
                phi_1294_ = (_e767 > 0.01f);
            }
            let _e770 = phi_1294_;
            if _e770 {
                let _e771 = c;
                let _e773 = d;
                let _e774 = c;
                g_4 = (-(_e771) / (_e773 - _e774));
                let _e777 = x_3;
                let _e778 = g_4;
                let _e780 = seen_1;
                param_73 = _e780;
                param_74 = 1f;
                param_75 = (_e777 + _e778);
                let _e782 = here_1.back;
                param_76 = _e782;
                let _e783 = cover((&param_73), (&param_74), (&param_75), (&param_76));
                let _e784 = param_73;
                seen_1 = _e784;
                taken_3 = _e783;
                let _e785 = taken_3;
                let _e786 = g_4;
                let _e788 = g_4;
                let _e791 = backs;
                backs = (_e791 + (vec2<f32>((1f - _e786), _e788) * _e785));
            }
            let _e794 = here_1.split;
            let _e795 = back_front;
            let _e798 = back_back;
            ends = ((_e794 && !(_e795)) && !(_e798));
            let _e801 = ends;
            let _e802 = on_front;
            let _e805 = on_back;
            let _e807 = ((_e801 && !(_e802)) && !(_e805));
            phi_1346_ = _e807;
            if _e807 {
                let _e808 = c;
                phi_1346_ = (abs(_e808) < 1f);
            }
            let _e812 = phi_1346_;
            phi_1352_ = _e812;
            if _e812 {
                let _e814 = seen_1.rest;
                phi_1352_ = (_e814 > 0.01f);
            }
            let _e817 = phi_1352_;
            if _e817 {
                let _e818 = c;
                if (_e818 <= 0f) {
                    let _e820 = c;
                    param_77 = -(_e820);
                    let _e822 = right_of((&param_77));
                    local_6 = _e822;
                } else {
                    let _e823 = c;
                    param_78 = (1f - _e823);
                    let _e825 = right_of((&param_78));
                    local_6 = (vec4(1f) - _e825);
                }
                let _e828 = local_6;
                stripes_1 = _e828;
                let _e830 = here_1.mask;
                param_79 = (vec4(1f) - _e830);
                let _e833 = stripes_1;
                param_80 = _e833;
                let _e834 = covered((&param_79), (&param_80));
                let _e835 = seen_1;
                param_81 = _e835;
                param_82 = _e834;
                let _e836 = x_3;
                param_83 = _e836;
                let _e838 = here_1.back;
                param_84 = _e838;
                let _e839 = cover((&param_81), (&param_82), (&param_83), (&param_84));
                let _e840 = param_81;
                seen_1 = _e840;
                let _e842 = backs[0u];
                backs[0u] = (_e842 + _e839);
            }
            let _e845 = ends;
            phi_1404_ = _e845;
            if _e845 {
                let _e847 = next_1.front;
                let _e849 = here_1.back;
                phi_1404_ = (_e847 > _e849);
            }
            let _e852 = phi_1404_;
            let _e853 = c;
            at_back = (_e852 && (_e853 <= 0f));
            let _e857 = here_1.split;
            let _e859 = front_front;
            let _e862 = front_back;
            let _e864 = ((!(_e857) && !(_e859)) && !(_e862));
            phi_1425_ = _e864;
            if _e864 {
                let _e866 = next_1.front;
                let _e868 = here_1.front;
                phi_1425_ = (_e866 > _e868);
            }
            let _e871 = phi_1425_;
            let _e872 = a;
            at_front = (_e871 && (_e872 <= 0f));
            let _e875 = at_back;
            let _e876 = at_front;
            let _e877 = (_e875 || _e876);
            phi_1437_ = _e877;
            if _e877 {
                let _e879 = seen_1.rest;
                phi_1437_ = (_e879 > 0.01f);
            }
            let _e882 = phi_1437_;
            if _e882 {
                let _e883 = at_back;
                if _e883 {
                    let _e885 = here_1.back;
                    local_7 = _e885;
                } else {
                    let _e887 = here_1.front;
                    local_7 = _e887;
                }
                let _e888 = local_7;
                reach_2 = _e888;
                let _e889 = at_back;
                if _e889 {
                    let _e890 = c;
                    local_8 = -(_e890);
                } else {
                    let _e892 = a;
                    local_8 = -(_e892);
                }
                let _e894 = local_8;
                away = _e894;
                let _e895 = at_back;
                let _e896 = on_front;
                if (_e895 && !(_e896)) {
                    let _e900 = here_1.mask;
                    param_85 = _e900;
                    param_86 = vec4<f32>(1f, 1f, 1f, 1f);
                    let _e901 = covered((&param_85), (&param_86));
                    local_9 = (1f - _e901);
                } else {
                    local_9 = 1f;
                }
                let _e903 = local_9;
                weight = _e903;
                let _e904 = column_5;
                let _e905 = at_back;
                let _e906 = reach_2;
                let _e907 = weight;
                found = Edge(_e904, _e905, _e906, _e907);
                let _e909 = weight;
                let _e911 = away;
                if ((_e909 == 1f) && (_e911 < 0.5f)) {
                    let _e914 = seen_1;
                    param_87 = _e914;
                    param_88 = 1f;
                    let _e915 = x_3;
                    param_89 = _e915;
                    let _e916 = reach_2;
                    param_90 = _e916;
                    let _e917 = cover((&param_87), (&param_88), (&param_89), (&param_90));
                    let _e918 = param_87;
                    seen_1 = _e918;
                    taken_4 = _e917;
                    let _e919 = at_back;
                    let _e920 = taken_4;
                    let _e923 = backs[0u];
                    backs[0u] = (_e923 + select(0f, _e920, _e919));
                    let _e926 = at_back;
                    let _e927 = taken_4;
                    let _e930 = fronts[0u];
                    fronts[0u] = (_e930 + select(_e927, 0f, _e926));
                }
                let _e933 = reach_2;
                let _e935 = edge.reach;
                if (_e933 < _e935) {
                    let _e937 = weight;
                    if (_e937 < 1f) {
                        let _e939 = edge;
                        second = _e939;
                    }
                    let _e940 = found;
                    edge = _e940;
                } else {
                    let _e941 = reach_2;
                    let _e943 = second.reach;
                    if (_e941 < _e943) {
                        let _e945 = found;
                        second = _e945;
                    }
                }
            }
            let _e947 = fronts[0u];
            let _e949 = backs[0u];
            if (max(_e947, _e949) > 0f) {
                let _e952 = column_5;
                param_91 = _e952;
                let _e953 = row_5;
                param_92 = _e953;
                let _e955 = fronts[0u];
                param_93 = _e955;
                let _e957 = backs[0u];
                param_94 = _e957;
                let _e958 = weighted((&param_91), (&param_92), (&param_93), (&param_94));
                let _e959 = color;
                color = (_e959 + _e958);
            }
            let _e962 = fronts[1u];
            let _e964 = backs[1u];
            if (max(_e962, _e964) > 0f) {
                let _e967 = column_5;
                let _e968 = sense;
                param_95 = (_e967 + _e968);
                let _e970 = row_5;
                param_96 = _e970;
                let _e972 = fronts[1u];
                param_97 = _e972;
                let _e974 = backs[1u];
                param_98 = _e974;
                let _e975 = weighted((&param_95), (&param_96), (&param_97), (&param_98));
                let _e976 = color;
                color = (_e976 + _e975);
            }
            let _e978 = front_back;
            on_front = _e978;
            let _e979 = back_back;
            on_back = _e979;
            let _e980 = next_1;
            here_1 = _e980;
            let _e981 = sense;
            let _e982 = column_5;
            column_5 = (_e982 + _e981);
            let _e984 = x_3;
            x_3 = (_e984 + 1f);
            continue;
        } else {
            break;
        }
    }
    let _e987 = seen_1.rest;
    hole = (_e987 > 0.5f);
    let _e990 = seen_1.rest;
    if (_e990 > 0.01f) {
        let _e993 = edge.column;
        beyond = (_e993 < 0i);
        let _e995 = beyond;
        if _e995 {
            let _e996 = column_5;
            let _e998 = here_1.split;
            let _e1000 = here_1.split;
            if _e1000 {
                let _e1002 = here_1.back;
                local_10 = _e1002;
            } else {
                let _e1004 = here_1.front;
                local_10 = _e1004;
            }
            let _e1005 = local_10;
            edge = Edge(_e996, _e998, _e1005, 1f);
        }
        let _e1008 = edge.column;
        param_99 = _e1008;
        let _e1009 = source_column((&param_99));
        edge_x = f32(_e1009);
        let _e1011 = t;
        let _e1012 = edge_x;
        let _e1015 = edge.reach;
        away_1 = abs(((_e1011 - _e1012) - _e1015));
        let _e1018 = away_1;
        spread = (0.5f * clamp(_e1018, 1f, 12f));
        sum_1 = vec4<f32>(0f, 0f, 0f, 0f);
        weights = 0f;
        let _e1021 = beyond;
        let _e1022 = away_1;
        rows = select(2i, 0i, (_e1021 && (_e1022 < 0.5f)));
        let _e1026 = rows;
        i = -(_e1026);
        loop {
            let _e1028 = i;
            let _e1029 = rows;
            if (_e1028 <= _e1029) {
                let _e1031 = row_5;
                let _e1032 = i;
                let _e1034 = spread;
                let _e1041 = synthesis.source_size[1u];
                at_1 = clamp((_e1031 + i32(round((f32(_e1032) * _e1034)))), 0i, (_e1041 - 1i));
                let _e1045 = edge.column;
                param_100 = _e1045;
                let _e1046 = at_1;
                param_101 = _e1046;
                let _e1047 = layer_at((&param_100), (&param_101));
                layer_3 = _e1047;
                let _e1048 = i;
                if (_e1048 == 0i) {
                    let _e1051 = edge.back;
                    local_11 = !(_e1051);
                } else {
                    let _e1054 = layer_3.front;
                    let _e1056 = edge.reach;
                    local_11 = (_e1054 <= (_e1056 + 1f));
                }
                let _e1059 = local_11;
                front_2 = _e1059;
                let _e1060 = i;
                if (_e1060 == 0i) {
                    let _e1063 = edge.back;
                    local_12 = _e1063;
                } else {
                    let _e1064 = front_2;
                    let _e1067 = layer_3.split;
                    let _e1068 = (!(_e1064) && _e1067);
                    phi_1715_ = _e1068;
                    if _e1068 {
                        let _e1070 = layer_3.back;
                        let _e1072 = edge.reach;
                        phi_1715_ = (_e1070 <= (_e1072 + 1f));
                    }
                    let _e1076 = phi_1715_;
                    local_12 = _e1076;
                }
                let _e1077 = local_12;
                behind_1 = _e1077;
                let _e1078 = i;
                if (_e1078 == 0i) {
                    local_13 = 2f;
                } else {
                    let _e1080 = front_2;
                    if _e1080 {
                        local_14 = 1f;
                    } else {
                        let _e1081 = behind_1;
                        if _e1081 {
                            let _e1083 = layer_3.mask;
                            param_102 = _e1083;
                            param_103 = vec4<f32>(1f, 1f, 1f, 1f);
                            let _e1084 = covered((&param_102), (&param_103));
                            local_15 = (1f - _e1084);
                        } else {
                            local_15 = 0f;
                        }
                        let _e1086 = local_15;
                        local_14 = _e1086;
                    }
                    let _e1087 = local_14;
                    local_13 = _e1087;
                }
                let _e1088 = local_13;
                weight_1 = _e1088;
                let _e1089 = front_2;
                let _e1090 = weight_1;
                let _e1092 = front_2;
                let _e1093 = weight_1;
                let _e1096 = edge.column;
                param_104 = _e1096;
                let _e1097 = at_1;
                param_105 = _e1097;
                param_106 = select(0f, _e1090, _e1089);
                param_107 = select(_e1093, 0f, _e1092);
                let _e1098 = weighted((&param_104), (&param_105), (&param_106), (&param_107));
                let _e1099 = sum_1;
                sum_1 = (_e1099 + _e1098);
                let _e1101 = weight_1;
                let _e1102 = weights;
                weights = (_e1102 + _e1101);
                continue;
            } else {
                break;
            }
            continuing {
                let _e1104 = i;
                i = (_e1104 + 1i);
            }
        }
        let _e1106 = sum_1;
        let _e1107 = weights;
        fill = (_e1106 / vec4(_e1107));
        let _e1111 = second.column;
        let _e1112 = (_e1111 >= 0i);
        phi_1777_ = _e1112;
        if _e1112 {
            let _e1114 = edge.weight;
            phi_1777_ = (_e1114 < 1f);
        }
        let _e1117 = phi_1777_;
        if _e1117 {
            let _e1119 = second.back;
            one = select(vec2<f32>(1f, 0f), vec2<f32>(0f, 1f), vec2(_e1119));
            let _e1123 = second.column;
            param_108 = _e1123;
            let _e1124 = row_5;
            param_109 = _e1124;
            let _e1126 = one[0u];
            param_110 = _e1126;
            let _e1128 = one[1u];
            param_111 = _e1128;
            let _e1129 = weighted((&param_108), (&param_109), (&param_110), (&param_111));
            let _e1130 = fill;
            let _e1132 = edge.weight;
            fill = mix(_e1129, _e1130, vec4(_e1132));
        }
        let _e1135 = hole;
        let _e1136 = away_1;
        hole = (_e1135 && (_e1136 >= 0.5f));
        let _e1139 = seen_1;
        param_112 = _e1139;
        param_113 = 1f;
        let _e1140 = edge_x;
        param_114 = _e1140;
        let _e1142 = edge.reach;
        param_115 = _e1142;
        let _e1143 = cover((&param_112), (&param_113), (&param_114), (&param_115));
        let _e1144 = param_112;
        seen_1 = _e1144;
        let _e1145 = fill;
        let _e1147 = color;
        color = (_e1147 + (_e1145 * _e1143));
    }
    let _e1150 = synthesis.far_displacement;
    let _e1152 = seen_1.reach;
    let _e1156 = synthesis.law[0u];
    let _e1160 = synthesis.law[1u];
    gl_FragDepth = clamp((((_e1150 + _e1152) - _e1156) / _e1160), 0f, 1f);
    return;
}

@fragment 
fn main(@location(0) span_at: vec2<f32>, @builtin(position) gl_FragCoord: vec4<f32>) -> FragmentOutput {
    span_at_1 = span_at;
    gl_FragCoord_1 = gl_FragCoord;
    main_1();
    let _e6 = color;
    let _e7 = gl_FragDepth;
    return FragmentOutput(_e6, _e7);
}
