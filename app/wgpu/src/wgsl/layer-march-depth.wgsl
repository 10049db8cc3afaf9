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
@group(0) @binding(9) 
var linear_sampler: sampler;
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

fn color_at(x: ptr<function, f32>, row_3: ptr<function, i32>) -> vec4<f32> {
    var column_3: f32;
    var local_4: f32;
    var at: vec2<f32>;
    var local_5: vec2<f32>;

    let _e15 = synthesis.mirrored;
    if (_e15 != 0u) {
        let _e19 = synthesis.source_size[0u];
        let _e22 = (*x);
        local_4 = (f32((_e19 - 1i)) - _e22);
    } else {
        let _e24 = (*x);
        local_4 = _e24;
    }
    let _e25 = local_4;
    column_3 = _e25;
    let _e26 = column_3;
    let _e27 = (*row_3);
    at = (vec2<f32>(_e26, f32(_e27)) + vec2(0.5f));
    if true {
        let _e33 = synthesis.source_origin;
        let _e35 = at;
        let _e38 = synthesis.texel;
        local_5 = ((vec2<f32>(_e33) + _e35) * _e38);
    } else {
        let _e40 = at;
        let _e42 = synthesis.source_size;
        local_5 = (_e40 / vec2<f32>(_e42));
    }
    let _e45 = local_5;
    at = _e45;
    let _e46 = at;
    let _e47 = textureSampleLevel(color_map_texture, linear_sampler, _e46, 0f);
    return _e47;
}

fn cover(seen: ptr<function, Seen>, share_2: ptr<function, f32>, column_4: ptr<function, f32>, reach_1: ptr<function, f32>) -> f32 {
    var taken: f32;
    var passes: bool;
    var local_6: f32;
    var local_7: f32;
    var phi_472_: bool;

    let _e10 = (*seen).rest;
    let _e11 = (*share_2);
    taken = (_e10 * _e11);
    let _e14 = (*seen).rest;
    let _e15 = (_e14 > 0.5f);
    phi_472_ = _e15;
    if _e15 {
        let _e17 = (*seen).rest;
        let _e18 = taken;
        phi_472_ = ((_e17 - _e18) <= 0.5f);
    }
    let _e22 = phi_472_;
    passes = _e22;
    let _e23 = passes;
    if _e23 {
        let _e24 = (*column_4);
        local_6 = _e24;
    } else {
        let _e26 = (*seen).column;
        local_6 = _e26;
    }
    let _e27 = local_6;
    (*seen).column = _e27;
    let _e29 = passes;
    if _e29 {
        let _e30 = (*reach_1);
        local_7 = _e30;
    } else {
        let _e32 = (*seen).reach;
        local_7 = _e32;
    }
    let _e33 = local_7;
    (*seen).reach = _e33;
    let _e35 = taken;
    let _e37 = (*seen).rest;
    (*seen).rest = (_e37 - _e35);
    let _e40 = taken;
    return _e40;
}

fn source_column(x_1: ptr<function, i32>) -> i32 {
    var local_8: i32;

    let _e6 = synthesis.mirrored;
    if (_e6 != 0u) {
        let _e10 = synthesis.source_size[0u];
        let _e12 = (*x_1);
        local_8 = ((_e10 - 1i) - _e12);
    } else {
        let _e14 = (*x_1);
        local_8 = _e14;
    }
    let _e15 = local_8;
    return _e15;
}

fn span_steps(span: ptr<function, u32>) -> f32 {
    var steps: u32;
    var local_9: f32;

    let _e5 = (*span);
    steps = (_e5 & 1023u);
    let _e7 = steps;
    if (_e7 == 1023u) {
        local_9 = 1000000000f;
    } else {
        let _e9 = steps;
        local_9 = f32(_e9);
    }
    let _e11 = local_9;
    return _e11;
}

fn pixel_span() -> vec4<u32> {
    var last: vec2<i32>;

    if true {
        let _e14 = synthesis.target_size[0u];
        let _e17 = synthesis.source_size[1u];
        last = ((vec2<i32>(_e14, _e17) - vec2(1i)) / vec2<i32>(16i, 8i));
        let _e22 = span_at_1;
        let _e24 = last;
        let _e26 = textureLoad(span_map_texture, clamp(vec2<i32>(_e22), vec2<i32>(0i, 0i), _e24), 0i);
        return _e26;
    }
    return vec4<u32>(0u, 0u, 0u, 0u);
}

fn main_1() {
    var last_1: f32;
    var row_4: i32;
    var t: f32;
    var span_1: u32;
    var x_2: f32;
    var limit: f32;
    var param_6: u32;
    var sense: i32;
    var column_5: i32;
    var param_7: i32;
    var seen_1: Seen;
    var bits_1: u32;
    var param_8: i32;
    var param_9: i32;
    var front_1: f32;
    var param_10: u32;
    var at_1: f32;
    var plain: bool;
    var param_11: u32;
    var param_12: i32;
    var param_13: i32;
    var following: f32;
    var param_14: u32;
    var param_15: u32;
    var then: f32;
    var g: f32;
    var param_16: Seen;
    var param_17: f32;
    var param_18: f32;
    var param_19: f32;
    var param_20: f32;
    var param_21: i32;
    var here: Layer;
    var param_22: i32;
    var param_23: i32;
    var edge: Edge;
    var second: Edge;
    var on_front: bool;
    var on_back: bool;
    var before: Layer;
    var param_24: i32;
    var param_25: i32;
    var idle: bool;
    var landed: f32;
    var ahead: u32;
    var param_26: i32;
    var param_27: i32;
    var following_1: f32;
    var param_28: u32;
    var then_1: f32;
    var param_29: u32;
    var next: Layer;
    var param_30: i32;
    var param_31: i32;
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
    var param_32: f32;
    var shares: vec2<f32>;
    var param_33: vec4<f32>;
    var param_34: vec4<f32>;
    var param_35: vec4<f32>;
    var param_36: vec4<f32>;
    var share_3: f32;
    var param_37: Seen;
    var param_38: f32;
    var param_39: f32;
    var param_40: f32;
    var share_4: f32;
    var param_41: f32;
    var param_42: vec4<f32>;
    var param_43: vec4<f32>;
    var param_44: Seen;
    var param_45: f32;
    var param_46: f32;
    var param_47: f32;
    var param_48: f32;
    var param_49: vec4<f32>;
    var param_50: vec4<f32>;
    var param_51: Seen;
    var param_52: f32;
    var param_53: f32;
    var param_54: f32;
    var g_2: f32;
    var taken_1: f32;
    var param_55: Seen;
    var param_56: f32;
    var param_57: f32;
    var param_58: f32;
    var g_3: f32;
    var taken_2: f32;
    var param_59: Seen;
    var param_60: f32;
    var param_61: f32;
    var param_62: f32;
    var g_4: f32;
    var taken_3: f32;
    var param_63: Seen;
    var param_64: f32;
    var param_65: f32;
    var param_66: f32;
    var ends: bool;
    var stripes_1: vec4<f32>;
    var local_10: vec4<f32>;
    var param_67: f32;
    var param_68: f32;
    var param_69: vec4<f32>;
    var param_70: vec4<f32>;
    var param_71: Seen;
    var param_72: f32;
    var param_73: f32;
    var param_74: f32;
    var at_back: bool;
    var at_front: bool;
    var reach_2: f32;
    var local_11: f32;
    var away: f32;
    var local_12: f32;
    var weight: f32;
    var local_13: f32;
    var param_75: vec4<f32>;
    var param_76: vec4<f32>;
    var found: Edge;
    var taken_4: f32;
    var param_77: Seen;
    var param_78: f32;
    var param_79: f32;
    var param_80: f32;
    var param_81: i32;
    var param_82: i32;
    var param_83: f32;
    var param_84: f32;
    var param_85: i32;
    var param_86: i32;
    var param_87: f32;
    var param_88: f32;
    var hole: bool;
    var beyond: bool;
    var local_14: f32;
    var edge_x: f32;
    var param_89: i32;
    var away_1: f32;
    var spread: f32;
    var sum: vec4<f32>;
    var weights: f32;
    var rows: i32;
    var i: i32;
    var at_2: i32;
    var layer_3: Layer;
    var param_90: i32;
    var param_91: i32;
    var front_2: bool;
    var local_15: bool;
    var behind_1: bool;
    var local_16: bool;
    var weight_1: f32;
    var local_17: f32;
    var local_18: f32;
    var local_19: f32;
    var param_92: vec4<f32>;
    var param_93: vec4<f32>;
    var param_94: i32;
    var param_95: i32;
    var param_96: f32;
    var param_97: f32;
    var fill: vec4<f32>;
    var one: vec2<f32>;
    var param_98: i32;
    var param_99: i32;
    var param_100: f32;
    var param_101: f32;
    var param_102: Seen;
    var param_103: f32;
    var param_104: f32;
    var param_105: f32;
    var phi_630_: bool;
    var phi_720_: bool;
    var phi_727_: bool;
    var phi_746_: bool;
    var phi_775_: bool;
    var phi_789_: bool;
    var phi_841_: bool;
    var phi_849_: bool;
    var phi_925_: bool;
    var phi_938_: bool;
    var phi_954_: bool;
    var phi_1035_: bool;
    var phi_1087_: bool;
    var phi_1135_: bool;
    var phi_1185_: bool;
    var phi_1235_: bool;
    var phi_1287_: bool;
    var phi_1293_: bool;
    var phi_1345_: bool;
    var phi_1366_: bool;
    var phi_1378_: bool;
    var phi_1656_: bool;
    var phi_1718_: bool;

    let _e214 = synthesis.source_size[0u];
    last_1 = f32((_e214 - 1i));
    let _e218 = gl_FragCoord_1[1u];
    let _e220 = synthesis.first_row;
    let _e224 = synthesis.source_size[1u];
    row_4 = i32(clamp((_e218 - _e220), 0f, f32((_e224 - 1i))));
    let _e231 = synthesis.origins[0u];
    let _e233 = gl_FragCoord_1[0u];
    let _e237 = synthesis.origins[1u];
    let _e240 = synthesis.farthest;
    t = ((((_e231 * _e233) + _e237) - _e240) + 0.01f);
    let _e243 = pixel_span();
    span_1 = _e243.x;
    let _e245 = t;
    let _e246 = span_1;
    let _e251 = last_1;
    x_2 = clamp(floor(((_e245 - bitcast<f32>(_e246)) - 1.01f)), 0f, _e251);
    let _e253 = x_2;
    let _e254 = span_1;
    param_6 = _e254;
    let _e255 = span_steps((&param_6));
    let _e258 = last_1;
    limit = min(((_e253 + _e255) + 2f), _e258);
    let _e261 = synthesis.mirrored;
    sense = select(1i, -1i, (_e261 != 0u));
    let _e264 = x_2;
    param_7 = i32(_e264);
    let _e266 = source_column((&param_7));
    column_5 = _e266;
    seen_1 = Seen(1f, 0f, 0f);
    color = vec4<f32>(0f, 0f, 0f, 0f);
    let _e267 = column_5;
    param_8 = _e267;
    let _e268 = row_4;
    param_9 = _e268;
    let _e269 = layer_bits((&param_8), (&param_9));
    bits_1 = _e269;
    let _e270 = bits_1;
    param_10 = _e270;
    let _e271 = full_front((&param_10));
    front_1 = _e271;
    let _e272 = x_2;
    let _e273 = front_1;
    let _e275 = t;
    at_1 = ((_e272 + _e273) - _e275);
    let _e277 = bits_1;
    param_11 = _e277;
    let _e278 = is_full((&param_11));
    let _e279 = at_1;
    plain = (_e278 && (_e279 <= 0f));
    loop {
        let _e282 = plain;
        let _e283 = x_2;
        let _e284 = limit;
        if (_e282 && (_e283 < _e284)) {
            let _e287 = column_5;
            let _e288 = sense;
            param_12 = (_e287 + _e288);
            let _e290 = row_4;
            param_13 = _e290;
            let _e291 = layer_bits((&param_12), (&param_13));
            bits_1 = _e291;
            let _e292 = bits_1;
            param_14 = _e292;
            let _e293 = full_front((&param_14));
            following = _e293;
            let _e294 = bits_1;
            param_15 = _e294;
            let _e295 = is_full((&param_15));
            phi_630_ = _e295;
            if _e295 {
                let _e296 = following;
                let _e297 = front_1;
                phi_630_ = (abs((_e296 - _e297)) < 0.5f);
            }
            let _e302 = phi_630_;
            plain = _e302;
            let _e303 = x_2;
            let _e305 = following;
            let _e307 = t;
            then = (((_e303 + 1f) + _e305) - _e307);
            let _e309 = plain;
            let _e310 = then;
            if (_e309 && (_e310 > 0f)) {
                let _e313 = at_1;
                let _e315 = then;
                let _e316 = at_1;
                g = (-(_e313) / (_e315 - _e316));
                let _e319 = x_2;
                let _e320 = g;
                let _e322 = front_1;
                let _e323 = following;
                let _e324 = g;
                let _e326 = seen_1;
                param_16 = _e326;
                param_17 = 1f;
                param_18 = (_e319 + _e320);
                param_19 = mix(_e322, _e323, _e324);
                let _e327 = cover((&param_16), (&param_17), (&param_18), (&param_19));
                let _e328 = param_16;
                seen_1 = _e328;
                let _e329 = x_2;
                let _e330 = g;
                param_20 = (_e329 + _e330);
                let _e332 = row_4;
                param_21 = _e332;
                let _e333 = color_at((&param_20), (&param_21));
                color = _e333;
                let _e334 = x_2;
                limit = _e334;
            } else {
                let _e335 = plain;
                if _e335 {
                    let _e336 = x_2;
                    x_2 = (_e336 + 1f);
                    let _e338 = sense;
                    let _e339 = column_5;
                    column_5 = (_e339 + _e338);
                    let _e341 = following;
                    front_1 = _e341;
                    let _e342 = then;
                    at_1 = _e342;
                }
            }
            continue;
        } else {
            break;
        }
    }
    let _e343 = column_5;
    param_22 = _e343;
    let _e344 = row_4;
    param_23 = _e344;
    let _e345 = layer_at((&param_22), (&param_23));
    here = _e345;
    edge = Edge(-1i, false, 1000000000f, 1f);
    let _e346 = edge;
    second = _e346;
    let _e347 = x_2;
    if (_e347 == 0f) {
        let _e350 = here.front;
        let _e351 = t;
        if (_e350 > _e351) {
            let _e353 = column_5;
            let _e355 = here.front;
            edge = Edge(_e353, false, _e355, 1f);
        }
        let _e358 = here.split;
        phi_720_ = _e358;
        if _e358 {
            let _e360 = here.back;
            let _e362 = edge.reach;
            phi_720_ = (_e360 < _e362);
        }
        let _e365 = phi_720_;
        phi_727_ = _e365;
        if _e365 {
            let _e367 = here.back;
            let _e368 = t;
            phi_727_ = (_e367 > _e368);
        }
        let _e371 = phi_727_;
        if _e371 {
            let _e372 = column_5;
            let _e374 = here.back;
            edge = Edge(_e372, true, _e374, 1f);
        }
    }
    on_front = false;
    on_back = false;
    let _e376 = x_2;
    let _e379 = here.split;
    let _e380 = ((_e376 > 0f) && _e379);
    phi_746_ = _e380;
    if _e380 {
        let _e382 = seen_1.rest;
        phi_746_ = (_e382 > 0.01f);
    }
    let _e385 = phi_746_;
    if _e385 {
        let _e386 = column_5;
        let _e387 = sense;
        param_24 = (_e386 - _e387);
        let _e389 = row_4;
        param_25 = _e389;
        let _e390 = layer_at((&param_24), (&param_25));
        before = _e390;
        let _e392 = before.front;
        let _e394 = here.back;
        on_front = (abs((_e392 - _e394)) < 0.5f);
        let _e399 = before.split;
        phi_775_ = _e399;
        if _e399 {
            let _e401 = before.back;
            let _e403 = here.back;
            phi_775_ = (abs((_e401 - _e403)) < 0.5f);
        }
        let _e408 = phi_775_;
        on_back = _e408;
    }
    loop {
        let _e409 = x_2;
        let _e410 = limit;
        let _e411 = (_e409 < _e410);
        phi_789_ = _e411;
        if _e411 {
            let _e413 = seen_1.rest;
            phi_789_ = (_e413 > 0.01f);
        }
        let _e416 = phi_789_;
        if _e416 {
            let _e418 = here.split;
            idle = !(_e418);
            let _e420 = x_2;
            let _e422 = here.front;
            let _e424 = t;
            landed = ((_e420 + _e422) - _e424);
            loop {
                let _e426 = idle;
                let _e427 = x_2;
                let _e428 = limit;
                if (_e426 && (_e427 < _e428)) {
                    let _e431 = column_5;
                    let _e432 = sense;
                    param_26 = (_e431 + _e432);
                    let _e434 = row_4;
                    param_27 = _e434;
                    let _e435 = layer_bits((&param_26), (&param_27));
                    ahead = _e435;
                    let _e436 = ahead;
                    param_28 = _e436;
                    let _e437 = full_front((&param_28));
                    following_1 = _e437;
                    let _e438 = x_2;
                    let _e440 = following_1;
                    let _e442 = t;
                    then_1 = (((_e438 + 1f) + _e440) - _e442);
                    let _e444 = ahead;
                    param_29 = _e444;
                    let _e445 = is_full((&param_29));
                    phi_841_ = _e445;
                    if _e445 {
                        let _e446 = following_1;
                        let _e448 = here.front;
                        phi_841_ = (abs((_e446 - _e448)) < 0.5f);
                    }
                    let _e453 = phi_841_;
                    phi_849_ = _e453;
                    if _e453 {
                        let _e454 = landed;
                        let _e456 = then_1;
                        phi_849_ = ((_e454 > 0f) || (_e456 <= 0f));
                    }
                    let _e460 = phi_849_;
                    idle = _e460;
                    let _e461 = idle;
                    if _e461 {
                        let _e462 = x_2;
                        x_2 = (_e462 + 1f);
                        let _e464 = sense;
                        let _e465 = column_5;
                        column_5 = (_e465 + _e464);
                        let _e467 = following_1;
                        here.front = _e467;
                        let _e469 = then_1;
                        landed = _e469;
                        on_front = false;
                        on_back = false;
                    }
                    continue;
                } else {
                    break;
                }
            }
            let _e470 = x_2;
            let _e471 = limit;
            if (_e470 >= _e471) {
                break;
            }
            let _e473 = column_5;
            let _e474 = sense;
            param_30 = (_e473 + _e474);
            let _e476 = row_4;
            param_31 = _e476;
            let _e477 = layer_at((&param_30), (&param_31));
            next = _e477;
            let _e478 = x_2;
            let _e480 = here.front;
            let _e482 = t;
            a = ((_e478 + _e480) - _e482);
            let _e484 = x_2;
            let _e487 = next.front;
            let _e489 = t;
            b = (((_e484 + 1f) + _e487) - _e489);
            let _e491 = x_2;
            let _e493 = here.back;
            let _e495 = t;
            c = ((_e491 + _e493) - _e495);
            let _e497 = x_2;
            let _e500 = next.back;
            let _e502 = t;
            d = (((_e497 + 1f) + _e500) - _e502);
            let _e505 = next.front;
            let _e507 = here.front;
            front_front = (abs((_e505 - _e507)) < 0.5f);
            let _e512 = next.split;
            phi_925_ = _e512;
            if _e512 {
                let _e514 = next.back;
                let _e516 = here.front;
                phi_925_ = (abs((_e514 - _e516)) < 0.5f);
            }
            let _e521 = phi_925_;
            front_back = _e521;
            let _e523 = here.split;
            phi_938_ = _e523;
            if _e523 {
                let _e525 = next.front;
                let _e527 = here.back;
                phi_938_ = (abs((_e525 - _e527)) < 0.5f);
            }
            let _e532 = phi_938_;
            back_front = _e532;
            let _e534 = here.split;
            let _e536 = next.split;
            let _e537 = (_e534 && _e536);
            phi_954_ = _e537;
            if _e537 {
                let _e539 = next.back;
                let _e541 = here.back;
                phi_954_ = (abs((_e539 - _e541)) < 0.5f);
            }
            let _e546 = phi_954_;
            back_back = _e546;
            fronts = vec2<f32>(0f, 0f);
            backs = vec2<f32>(0f, 0f);
            let _e547 = front_front;
            let _e548 = a;
            let _e551 = b;
            if ((_e547 && (_e548 <= 0f)) && (_e551 > 0f)) {
                let _e554 = a;
                let _e556 = b;
                let _e557 = a;
                g_1 = (-(_e554) / (_e556 - _e557));
                let _e560 = g_1;
                param_32 = _e560;
                let _e561 = right_of((&param_32));
                right = _e561;
                let _e563 = here.mask;
                param_33 = _e563;
                let _e564 = right;
                param_34 = _e564;
                let _e565 = covered((&param_33), (&param_34));
                let _e566 = right;
                let _e570 = next.mask;
                param_35 = _e570;
                param_36 = (vec4(1f) - _e566);
                let _e571 = covered((&param_35), (&param_36));
                shares = vec2<f32>(_e565, _e571);
                let _e574 = shares[0u];
                let _e576 = shares[1u];
                share_3 = (_e574 + _e576);
                let _e578 = x_2;
                let _e579 = g_1;
                let _e582 = here.front;
                let _e584 = next.front;
                let _e585 = g_1;
                let _e587 = seen_1;
                param_37 = _e587;
                let _e588 = share_3;
                param_38 = _e588;
                param_39 = (_e578 + _e579);
                param_40 = mix(_e582, _e584, _e585);
                let _e589 = cover((&param_37), (&param_38), (&param_39), (&param_40));
                let _e590 = param_37;
                seen_1 = _e590;
                let _e591 = shares;
                let _e593 = share_3;
                fronts = ((_e591 * _e589) / vec2(max(_e593, 0.000001f)));
            }
            let _e597 = front_front;
            let _e598 = !(_e597);
            phi_1035_ = _e598;
            if _e598 {
                let _e600 = next.front;
                let _e602 = here.front;
                let _e605 = next.split;
                phi_1035_ = ((_e600 > _e602) || _e605);
            }
            let _e608 = phi_1035_;
            let _e609 = back_front;
            let _e612 = b;
            let _e615 = b;
            if (((_e608 && !(_e609)) && (_e612 > 0f)) && (_e615 < 1f)) {
                let _e618 = b;
                param_41 = (1f - _e618);
                let _e620 = right_of((&param_41));
                let _e624 = next.mask;
                param_42 = _e624;
                param_43 = (vec4(1f) - _e620);
                let _e625 = covered((&param_42), (&param_43));
                share_4 = _e625;
                let _e626 = x_2;
                let _e628 = seen_1;
                param_44 = _e628;
                let _e629 = share_4;
                param_45 = _e629;
                param_46 = (_e626 + 1f);
                let _e631 = next.front;
                param_47 = _e631;
                let _e632 = cover((&param_44), (&param_45), (&param_46), (&param_47));
                let _e633 = param_44;
                seen_1 = _e633;
                let _e635 = fronts[1u];
                fronts[1u] = (_e635 + _e632);
            }
            let _e638 = front_front;
            let _e639 = !(_e638);
            phi_1087_ = _e639;
            if _e639 {
                let _e641 = next.front;
                let _e643 = here.front;
                let _e646 = here.split;
                phi_1087_ = ((_e641 < _e643) || _e646);
            }
            let _e649 = phi_1087_;
            let _e650 = front_back;
            let _e653 = a;
            let _e656 = a;
            if (((_e649 && !(_e650)) && (_e653 <= 0f)) && (_e656 > -1f)) {
                let _e659 = a;
                param_48 = -(_e659);
                let _e661 = right_of((&param_48));
                let _e663 = here.mask;
                param_49 = _e663;
                param_50 = _e661;
                let _e664 = covered((&param_49), (&param_50));
                let _e665 = seen_1;
                param_51 = _e665;
                param_52 = _e664;
                let _e666 = x_2;
                param_53 = _e666;
                let _e668 = here.front;
                param_54 = _e668;
                let _e669 = cover((&param_51), (&param_52), (&param_53), (&param_54));
                let _e670 = param_51;
                seen_1 = _e670;
                let _e672 = fronts[0u];
                fronts[0u] = (_e672 + _e669);
            }
            let _e675 = front_back;
            let _e676 = a;
            let _e679 = d;
            let _e681 = ((_e675 && (_e676 <= 0f)) && (_e679 > 0f));
            phi_1135_ = _e681;
            if _e681 {
                let _e683 = seen_1.rest;
                phi_1135_ = (_e683 > 0.01f);
            }
            let _e686 = phi_1135_;
            if _e686 {
                let _e687 = a;
                let _e689 = d;
                let _e690 = a;
                g_2 = (-(_e687) / (_e689 - _e690));
                let _e693 = x_2;
                let _e694 = g_2;
                let _e696 = seen_1;
                param_55 = _e696;
                param_56 = 1f;
                param_57 = (_e693 + _e694);
                let _e698 = here.front;
                param_58 = _e698;
                let _e699 = cover((&param_55), (&param_56), (&param_57), (&param_58));
                let _e700 = param_55;
                seen_1 = _e700;
                taken_1 = _e699;
                let _e701 = taken_1;
                let _e702 = g_2;
                let _e706 = fronts[0u];
                fronts[0u] = (_e706 + (_e701 * (1f - _e702)));
                let _e709 = taken_1;
                let _e710 = g_2;
                let _e713 = backs[1u];
                backs[1u] = (_e713 + (_e709 * _e710));
            }
            let _e716 = back_front;
            let _e717 = c;
            let _e720 = b;
            let _e722 = ((_e716 && (_e717 <= 0f)) && (_e720 > 0f));
            phi_1185_ = _e722;
            if _e722 {
                let _e724 = seen_1.rest;
                phi_1185_ = (_e724 > 0.01f);
            }
            let _e727 = phi_1185_;
            if _e727 {
                let _e728 = c;
                let _e730 = b;
                let _e731 = c;
                g_3 = (-(_e728) / (_e730 - _e731));
                let _e734 = x_2;
                let _e735 = g_3;
                let _e737 = seen_1;
                param_59 = _e737;
                param_60 = 1f;
                param_61 = (_e734 + _e735);
                let _e739 = next.front;
                param_62 = _e739;
                let _e740 = cover((&param_59), (&param_60), (&param_61), (&param_62));
                let _e741 = param_59;
                seen_1 = _e741;
                taken_2 = _e740;
                let _e742 = taken_2;
                let _e743 = g_3;
                let _e747 = backs[0u];
                backs[0u] = (_e747 + (_e742 * (1f - _e743)));
                let _e750 = taken_2;
                let _e751 = g_3;
                let _e754 = fronts[1u];
                fronts[1u] = (_e754 + (_e750 * _e751));
            }
            let _e757 = back_back;
            let _e758 = c;
            let _e761 = d;
            let _e763 = ((_e757 && (_e758 <= 0f)) && (_e761 > 0f));
            phi_1235_ = _e763;
            if _e763 {
                let _e765 = seen_1.rest;
                phi_1235_ = (_e765 > 0.01f);
            }
            let _e768 = phi_1235_;
            if _e768 {
                let _e769 = c;
                let _e771 = d;
                let _e772 = c;
                g_4 = (-(_e769) / (_e771 - _e772));
                let _e775 = x_2;
                let _e776 = g_4;
                let _e778 = seen_1;
                param_63 = _e778;
                param_64 = 1f;
                param_65 = (_e775 + _e776);
                let _e780 = here.back;
                param_66 = _e780;
                let _e781 = cover((&param_63), (&param_64), (&param_65), (&param_66));
                let _e782 = param_63;
                seen_1 = _e782;
                taken_3 = _e781;
                let _e783 = taken_3;
                let _e784 = g_4;
                let _e786 = g_4;
                let _e789 = backs;
                backs = (_e789 + (vec2<f32>((1f - _e784), _e786) * _e783));
            }
            let _e792 = here.split;
            let _e793 = back_front;
            let _e796 = back_back;
            ends = ((_e792 && !(_e793)) && !(_e796));
            let _e799 = ends;
            let _e800 = on_front;
            let _e803 = on_back;
            let _e805 = ((_e799 && !(_e800)) && !(_e803));
            phi_1287_ = _e805;
            if _e805 {
                let _e806 = c;
                phi_1287_ = (abs(_e806) < 1f);
            }
            let _e810 = phi_1287_;
            phi_1293_ = _e810;
            if _e810 {
                let _e812 = seen_1.rest;
                phi_1293_ = (_e812 > 0.01f);
            }
            let _e815 = phi_1293_;
            if _e815 {
                let _e816 = c;
                if (_e816 <= 0f) {
                    let _e818 = c;
                    param_67 = -(_e818);
                    let _e820 = right_of((&param_67));
                    local_10 = _e820;
                } else {
                    let _e821 = c;
                    param_68 = (1f - _e821);
                    let _e823 = right_of((&param_68));
                    local_10 = (vec4(1f) - _e823);
                }
                let _e826 = local_10;
                stripes_1 = _e826;
                let _e828 = here.mask;
                param_69 = (vec4(1f) - _e828);
                let _e831 = stripes_1;
                param_70 = _e831;
                let _e832 = covered((&param_69), (&param_70));
                let _e833 = seen_1;
                param_71 = _e833;
                param_72 = _e832;
                let _e834 = x_2;
                param_73 = _e834;
                let _e836 = here.back;
                param_74 = _e836;
                let _e837 = cover((&param_71), (&param_72), (&param_73), (&param_74));
                let _e838 = param_71;
                seen_1 = _e838;
                let _e840 = backs[0u];
                backs[0u] = (_e840 + _e837);
            }
            let _e843 = ends;
            phi_1345_ = _e843;
            if _e843 {
                let _e845 = next.front;
                let _e847 = here.back;
                phi_1345_ = (_e845 > _e847);
            }
            let _e850 = phi_1345_;
            let _e851 = c;
            at_back = (_e850 && (_e851 <= 0f));
            let _e855 = here.split;
            let _e857 = front_front;
            let _e860 = front_back;
            let _e862 = ((!(_e855) && !(_e857)) && !(_e860));
            phi_1366_ = _e862;
            if _e862 {
                let _e864 = next.front;
                let _e866 = here.front;
                phi_1366_ = (_e864 > _e866);
            }
            let _e869 = phi_1366_;
            let _e870 = a;
            at_front = (_e869 && (_e870 <= 0f));
            let _e873 = at_back;
            let _e874 = at_front;
            let _e875 = (_e873 || _e874);
            phi_1378_ = _e875;
            if _e875 {
                let _e877 = seen_1.rest;
                phi_1378_ = (_e877 > 0.01f);
            }
            let _e880 = phi_1378_;
            if _e880 {
                let _e881 = at_back;
                if _e881 {
                    let _e883 = here.back;
                    local_11 = _e883;
                } else {
                    let _e885 = here.front;
                    local_11 = _e885;
                }
                let _e886 = local_11;
                reach_2 = _e886;
                let _e887 = at_back;
                if _e887 {
                    let _e888 = c;
                    local_12 = -(_e888);
                } else {
                    let _e890 = a;
                    local_12 = -(_e890);
                }
                let _e892 = local_12;
                away = _e892;
                let _e893 = at_back;
                let _e894 = on_front;
                if (_e893 && !(_e894)) {
                    let _e898 = here.mask;
                    param_75 = _e898;
                    param_76 = vec4<f32>(1f, 1f, 1f, 1f);
                    let _e899 = covered((&param_75), (&param_76));
                    local_13 = (1f - _e899);
                } else {
                    local_13 = 1f;
                }
                let _e901 = local_13;
                weight = _e901;
                let _e902 = column_5;
                let _e903 = at_back;
                let _e904 = reach_2;
                let _e905 = weight;
                found = Edge(_e902, _e903, _e904, _e905);
                let _e907 = weight;
                let _e909 = away;
                if ((_e907 == 1f) && (_e909 < 0.5f)) {
                    let _e912 = seen_1;
                    param_77 = _e912;
                    param_78 = 1f;
                    let _e913 = x_2;
                    param_79 = _e913;
                    let _e914 = reach_2;
                    param_80 = _e914;
                    let _e915 = cover((&param_77), (&param_78), (&param_79), (&param_80));
                    let _e916 = param_77;
                    seen_1 = _e916;
                    taken_4 = _e915;
                    let _e917 = at_back;
                    let _e918 = taken_4;
                    let _e921 = backs[0u];
                    backs[0u] = (_e921 + select(0f, _e918, _e917));
                    let _e924 = at_back;
                    let _e925 = taken_4;
                    let _e928 = fronts[0u];
                    fronts[0u] = (_e928 + select(_e925, 0f, _e924));
                }
                let _e931 = reach_2;
                let _e933 = edge.reach;
                if (_e931 < _e933) {
                    let _e935 = weight;
                    if (_e935 < 1f) {
                        let _e937 = edge;
                        second = _e937;
                    }
                    let _e938 = found;
                    edge = _e938;
                } else {
                    let _e939 = reach_2;
                    let _e941 = second.reach;
                    if (_e939 < _e941) {
                        let _e943 = found;
                        second = _e943;
                    }
                }
            }
            let _e945 = fronts[0u];
            let _e947 = backs[0u];
            if (max(_e945, _e947) > 0f) {
                let _e950 = column_5;
                param_81 = _e950;
                let _e951 = row_4;
                param_82 = _e951;
                let _e953 = fronts[0u];
                param_83 = _e953;
                let _e955 = backs[0u];
                param_84 = _e955;
                let _e956 = weighted((&param_81), (&param_82), (&param_83), (&param_84));
                let _e957 = color;
                color = (_e957 + _e956);
            }
            let _e960 = fronts[1u];
            let _e962 = backs[1u];
            if (max(_e960, _e962) > 0f) {
                let _e965 = column_5;
                let _e966 = sense;
                param_85 = (_e965 + _e966);
                let _e968 = row_4;
                param_86 = _e968;
                let _e970 = fronts[1u];
                param_87 = _e970;
                let _e972 = backs[1u];
                param_88 = _e972;
                let _e973 = weighted((&param_85), (&param_86), (&param_87), (&param_88));
                let _e974 = color;
                color = (_e974 + _e973);
            }
            let _e976 = front_back;
            on_front = _e976;
            let _e977 = back_back;
            on_back = _e977;
            let _e978 = next;
            here = _e978;
            let _e979 = sense;
            let _e980 = column_5;
            column_5 = (_e980 + _e979);
            let _e982 = x_2;
            x_2 = (_e982 + 1f);
            continue;
        } else {
            break;
        }
    }
    let _e985 = seen_1.rest;
    hole = (_e985 > 0.5f);
    let _e988 = seen_1.rest;
    if (_e988 > 0.01f) {
        let _e991 = edge.column;
        beyond = (_e991 < 0i);
        let _e993 = beyond;
        if _e993 {
            let _e994 = column_5;
            let _e996 = here.split;
            let _e998 = here.split;
            if _e998 {
                let _e1000 = here.back;
                local_14 = _e1000;
            } else {
                let _e1002 = here.front;
                local_14 = _e1002;
            }
            let _e1003 = local_14;
            edge = Edge(_e994, _e996, _e1003, 1f);
        }
        let _e1006 = edge.column;
        param_89 = _e1006;
        let _e1007 = source_column((&param_89));
        edge_x = f32(_e1007);
        let _e1009 = t;
        let _e1010 = edge_x;
        let _e1013 = edge.reach;
        away_1 = abs(((_e1009 - _e1010) - _e1013));
        let _e1016 = away_1;
        spread = (0.5f * clamp(_e1016, 1f, 12f));
        sum = vec4<f32>(0f, 0f, 0f, 0f);
        weights = 0f;
        let _e1019 = beyond;
        let _e1020 = away_1;
        rows = select(2i, 0i, (_e1019 && (_e1020 < 0.5f)));
        let _e1024 = rows;
        i = -(_e1024);
        loop {
            let _e1026 = i;
            let _e1027 = rows;
            if (_e1026 <= _e1027) {
                let _e1029 = row_4;
                let _e1030 = i;
                let _e1032 = spread;
                let _e1039 = synthesis.source_size[1u];
                at_2 = clamp((_e1029 + i32(round((f32(_e1030) * _e1032)))), 0i, (_e1039 - 1i));
                let _e1043 = edge.column;
                param_90 = _e1043;
                let _e1044 = at_2;
                param_91 = _e1044;
                let _e1045 = layer_at((&param_90), (&param_91));
                layer_3 = _e1045;
                let _e1046 = i;
                if (_e1046 == 0i) {
                    let _e1049 = edge.back;
                    local_15 = !(_e1049);
                } else {
                    let _e1052 = layer_3.front;
                    let _e1054 = edge.reach;
                    local_15 = (_e1052 <= (_e1054 + 1f));
                }
                let _e1057 = local_15;
                front_2 = _e1057;
                let _e1058 = i;
                if (_e1058 == 0i) {
                    let _e1061 = edge.back;
                    local_16 = _e1061;
                } else {
                    let _e1062 = front_2;
                    let _e1065 = layer_3.split;
                    let _e1066 = (!(_e1062) && _e1065);
                    phi_1656_ = _e1066;
                    if _e1066 {
                        let _e1068 = layer_3.back;
                        let _e1070 = edge.reach;
                        phi_1656_ = (_e1068 <= (_e1070 + 1f));
                    }
                    let _e1074 = phi_1656_;
                    local_16 = _e1074;
                }
                let _e1075 = local_16;
                behind_1 = _e1075;
                let _e1076 = i;
                if (_e1076 == 0i) {
                    local_17 = 2f;
                } else {
                    let _e1078 = front_2;
                    if _e1078 {
                        local_18 = 1f;
                    } else {
                        let _e1079 = behind_1;
                        if _e1079 {
                            let _e1081 = layer_3.mask;
                            param_92 = _e1081;
                            param_93 = vec4<f32>(1f, 1f, 1f, 1f);
                            let _e1082 = covered((&param_92), (&param_93));
                            local_19 = (1f - _e1082);
                        } else {
                            local_19 = 0f;
                        }
                        let _e1084 = local_19;
                        local_18 = _e1084;
                    }
                    let _e1085 = local_18;
                    local_17 = _e1085;
                }
                let _e1086 = local_17;
                weight_1 = _e1086;
                let _e1087 = front_2;
                let _e1088 = weight_1;
                let _e1090 = front_2;
                let _e1091 = weight_1;
                let _e1094 = edge.column;
                param_94 = _e1094;
                let _e1095 = at_2;
                param_95 = _e1095;
                param_96 = select(0f, _e1088, _e1087);
                param_97 = select(_e1091, 0f, _e1090);
                let _e1096 = weighted((&param_94), (&param_95), (&param_96), (&param_97));
                let _e1097 = sum;
                sum = (_e1097 + _e1096);
                let _e1099 = weight_1;
                let _e1100 = weights;
                weights = (_e1100 + _e1099);
                continue;
            } else {
                break;
            }
            continuing {
                let _e1102 = i;
                i = (_e1102 + 1i);
            }
        }
        let _e1104 = sum;
        let _e1105 = weights;
        fill = (_e1104 / vec4(_e1105));
        let _e1109 = second.column;
        let _e1110 = (_e1109 >= 0i);
        phi_1718_ = _e1110;
        if _e1110 {
            let _e1112 = edge.weight;
            phi_1718_ = (_e1112 < 1f);
        }
        let _e1115 = phi_1718_;
        if _e1115 {
            let _e1117 = second.back;
            one = select(vec2<f32>(1f, 0f), vec2<f32>(0f, 1f), vec2(_e1117));
            let _e1121 = second.column;
            param_98 = _e1121;
            let _e1122 = row_4;
            param_99 = _e1122;
            let _e1124 = one[0u];
            param_100 = _e1124;
            let _e1126 = one[1u];
            param_101 = _e1126;
            let _e1127 = weighted((&param_98), (&param_99), (&param_100), (&param_101));
            let _e1128 = fill;
            let _e1130 = edge.weight;
            fill = mix(_e1127, _e1128, vec4(_e1130));
        }
        let _e1133 = hole;
        let _e1134 = away_1;
        hole = (_e1133 && (_e1134 >= 0.5f));
        let _e1137 = seen_1;
        param_102 = _e1137;
        param_103 = 1f;
        let _e1138 = edge_x;
        param_104 = _e1138;
        let _e1140 = edge.reach;
        param_105 = _e1140;
        let _e1141 = cover((&param_102), (&param_103), (&param_104), (&param_105));
        let _e1142 = param_102;
        seen_1 = _e1142;
        let _e1143 = fill;
        let _e1145 = color;
        color = (_e1145 + (_e1143 * _e1141));
    }
    let _e1148 = synthesis.far_displacement;
    let _e1150 = seen_1.reach;
    let _e1154 = synthesis.law[0u];
    let _e1158 = synthesis.law[1u];
    gl_FragDepth = clamp((((_e1148 + _e1150) - _e1154) / _e1158), 0f, 1f);
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
