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

fn color_at(x: ptr<function, f32>, row_3: ptr<function, i32>) -> vec4<f32> {
    var column_3: f32;
    var local_2: f32;
    var at: vec2<f32>;
    var local_3: vec2<f32>;

    let _e15 = synthesis.mirrored;
    if (_e15 != 0u) {
        let _e19 = synthesis.source_size[0u];
        let _e22 = (*x);
        local_2 = (f32((_e19 - 1i)) - _e22);
    } else {
        let _e24 = (*x);
        local_2 = _e24;
    }
    let _e25 = local_2;
    column_3 = _e25;
    let _e26 = column_3;
    let _e27 = (*row_3);
    at = (vec2<f32>(_e26, f32(_e27)) + vec2(0.5f));
    if true {
        let _e33 = synthesis.source_origin;
        let _e35 = at;
        let _e38 = synthesis.texel;
        local_3 = ((vec2<f32>(_e33) + _e35) * _e38);
    } else {
        let _e40 = at;
        let _e42 = synthesis.source_size;
        local_3 = (_e40 / vec2<f32>(_e42));
    }
    let _e45 = local_3;
    at = _e45;
    let _e46 = at;
    let _e47 = textureSampleLevel(color_map_texture, linear_sampler, _e46, 0f);
    return _e47;
}

fn cover(seen: ptr<function, Seen>, share_1: ptr<function, f32>, column_4: ptr<function, f32>, reach_1: ptr<function, f32>) -> f32 {
    var taken: f32;
    var passes: bool;
    var local_4: f32;
    var local_5: f32;
    var phi_437_: bool;

    let _e10 = (*seen).rest;
    let _e11 = (*share_1);
    taken = (_e10 * _e11);
    let _e14 = (*seen).rest;
    let _e15 = (_e14 > 0.5f);
    phi_437_ = _e15;
    if _e15 {
        let _e17 = (*seen).rest;
        let _e18 = taken;
        phi_437_ = ((_e17 - _e18) <= 0.5f);
    }
    let _e22 = phi_437_;
    passes = _e22;
    let _e23 = passes;
    if _e23 {
        let _e24 = (*column_4);
        local_4 = _e24;
    } else {
        let _e26 = (*seen).column;
        local_4 = _e26;
    }
    let _e27 = local_4;
    (*seen).column = _e27;
    let _e29 = passes;
    if _e29 {
        let _e30 = (*reach_1);
        local_5 = _e30;
    } else {
        let _e32 = (*seen).reach;
        local_5 = _e32;
    }
    let _e33 = local_5;
    (*seen).reach = _e33;
    let _e35 = taken;
    let _e37 = (*seen).rest;
    (*seen).rest = (_e37 - _e35);
    let _e40 = taken;
    return _e40;
}

fn source_column(x_1: ptr<function, i32>) -> i32 {
    var local_6: i32;

    let _e6 = synthesis.mirrored;
    if (_e6 != 0u) {
        let _e10 = synthesis.source_size[0u];
        let _e12 = (*x_1);
        local_6 = ((_e10 - 1i) - _e12);
    } else {
        let _e14 = (*x_1);
        local_6 = _e14;
    }
    let _e15 = local_6;
    return _e15;
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
    var share_2: f32;
    var param_37: Seen;
    var param_38: f32;
    var param_39: f32;
    var param_40: f32;
    var share_3: f32;
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
    var local_8: vec4<f32>;
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
    var local_9: f32;
    var away: f32;
    var local_10: f32;
    var weight: f32;
    var local_11: f32;
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
    var local_12: f32;
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
    var local_13: bool;
    var behind_1: bool;
    var local_14: bool;
    var weight_1: f32;
    var local_15: f32;
    var local_16: f32;
    var local_17: f32;
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
    var phi_595_: bool;
    var phi_685_: bool;
    var phi_692_: bool;
    var phi_711_: bool;
    var phi_740_: bool;
    var phi_754_: bool;
    var phi_806_: bool;
    var phi_814_: bool;
    var phi_890_: bool;
    var phi_903_: bool;
    var phi_919_: bool;
    var phi_1000_: bool;
    var phi_1052_: bool;
    var phi_1100_: bool;
    var phi_1150_: bool;
    var phi_1200_: bool;
    var phi_1252_: bool;
    var phi_1258_: bool;
    var phi_1310_: bool;
    var phi_1331_: bool;
    var phi_1343_: bool;
    var phi_1621_: bool;
    var phi_1683_: bool;

    let _e213 = synthesis.source_size[0u];
    last_1 = f32((_e213 - 1i));
    let _e217 = gl_FragCoord_1[1u];
    let _e219 = synthesis.first_row;
    let _e223 = synthesis.source_size[1u];
    row_4 = i32(clamp((_e217 - _e219), 0f, f32((_e223 - 1i))));
    let _e230 = synthesis.origins[0u];
    let _e232 = gl_FragCoord_1[0u];
    let _e236 = synthesis.origins[1u];
    let _e239 = synthesis.farthest;
    t = ((((_e230 * _e232) + _e236) - _e239) + 0.01f);
    let _e242 = pixel_span();
    span_1 = _e242.x;
    let _e244 = t;
    let _e245 = span_1;
    let _e250 = last_1;
    x_2 = clamp(floor(((_e244 - bitcast<f32>(_e245)) - 1.01f)), 0f, _e250);
    let _e252 = x_2;
    let _e253 = span_1;
    param_6 = _e253;
    let _e254 = span_steps((&param_6));
    let _e257 = last_1;
    limit = min(((_e252 + _e254) + 2f), _e257);
    let _e260 = synthesis.mirrored;
    sense = select(1i, -1i, (_e260 != 0u));
    let _e263 = x_2;
    param_7 = i32(_e263);
    let _e265 = source_column((&param_7));
    column_5 = _e265;
    seen_1 = Seen(1f, 0f, 0f);
    color = vec4<f32>(0f, 0f, 0f, 0f);
    let _e266 = column_5;
    param_8 = _e266;
    let _e267 = row_4;
    param_9 = _e267;
    let _e268 = layer_bits((&param_8), (&param_9));
    bits_1 = _e268;
    let _e269 = bits_1;
    param_10 = _e269;
    let _e270 = full_front((&param_10));
    front_1 = _e270;
    let _e271 = x_2;
    let _e272 = front_1;
    let _e274 = t;
    at_1 = ((_e271 + _e272) - _e274);
    let _e276 = bits_1;
    param_11 = _e276;
    let _e277 = is_full((&param_11));
    let _e278 = at_1;
    plain = (_e277 && (_e278 <= 0f));
    loop {
        let _e281 = plain;
        let _e282 = x_2;
        let _e283 = limit;
        if (_e281 && (_e282 < _e283)) {
            let _e286 = column_5;
            let _e287 = sense;
            param_12 = (_e286 + _e287);
            let _e289 = row_4;
            param_13 = _e289;
            let _e290 = layer_bits((&param_12), (&param_13));
            bits_1 = _e290;
            let _e291 = bits_1;
            param_14 = _e291;
            let _e292 = full_front((&param_14));
            following = _e292;
            let _e293 = bits_1;
            param_15 = _e293;
            let _e294 = is_full((&param_15));
            phi_595_ = _e294;
            if _e294 {
                let _e295 = following;
                let _e296 = front_1;
                phi_595_ = (abs((_e295 - _e296)) < 0.5f);
            }
            let _e301 = phi_595_;
            plain = _e301;
            let _e302 = x_2;
            let _e304 = following;
            let _e306 = t;
            then = (((_e302 + 1f) + _e304) - _e306);
            let _e308 = plain;
            let _e309 = then;
            if (_e308 && (_e309 > 0f)) {
                let _e312 = at_1;
                let _e314 = then;
                let _e315 = at_1;
                g = (-(_e312) / (_e314 - _e315));
                let _e318 = x_2;
                let _e319 = g;
                let _e321 = front_1;
                let _e322 = following;
                let _e323 = g;
                let _e325 = seen_1;
                param_16 = _e325;
                param_17 = 1f;
                param_18 = (_e318 + _e319);
                param_19 = mix(_e321, _e322, _e323);
                let _e326 = cover((&param_16), (&param_17), (&param_18), (&param_19));
                let _e327 = param_16;
                seen_1 = _e327;
                let _e328 = x_2;
                let _e329 = g;
                param_20 = (_e328 + _e329);
                let _e331 = row_4;
                param_21 = _e331;
                let _e332 = color_at((&param_20), (&param_21));
                color = _e332;
                let _e333 = x_2;
                limit = _e333;
            } else {
                let _e334 = plain;
                if _e334 {
                    let _e335 = x_2;
                    x_2 = (_e335 + 1f);
                    let _e337 = sense;
                    let _e338 = column_5;
                    column_5 = (_e338 + _e337);
                    let _e340 = following;
                    front_1 = _e340;
                    let _e341 = then;
                    at_1 = _e341;
                }
            }
            continue;
        } else {
            break;
        }
    }
    let _e342 = column_5;
    param_22 = _e342;
    let _e343 = row_4;
    param_23 = _e343;
    let _e344 = layer_at((&param_22), (&param_23));
    here = _e344;
    edge = Edge(-1i, false, 1000000000f, 1f);
    let _e345 = edge;
    second = _e345;
    let _e346 = x_2;
    if (_e346 == 0f) {
        let _e349 = here.front;
        let _e350 = t;
        if (_e349 > _e350) {
            let _e352 = column_5;
            let _e354 = here.front;
            edge = Edge(_e352, false, _e354, 1f);
        }
        let _e357 = here.split;
        phi_685_ = _e357;
        if _e357 {
            let _e359 = here.back;
            let _e361 = edge.reach;
            phi_685_ = (_e359 < _e361);
        }
        let _e364 = phi_685_;
        phi_692_ = _e364;
        if _e364 {
            let _e366 = here.back;
            let _e367 = t;
            phi_692_ = (_e366 > _e367);
        }
        let _e370 = phi_692_;
        if _e370 {
            let _e371 = column_5;
            let _e373 = here.back;
            edge = Edge(_e371, true, _e373, 1f);
        }
    }
    on_front = false;
    on_back = false;
    let _e375 = x_2;
    let _e378 = here.split;
    let _e379 = ((_e375 > 0f) && _e378);
    phi_711_ = _e379;
    if _e379 {
        let _e381 = seen_1.rest;
        phi_711_ = (_e381 > 0.01f);
    }
    let _e384 = phi_711_;
    if _e384 {
        let _e385 = column_5;
        let _e386 = sense;
        param_24 = (_e385 - _e386);
        let _e388 = row_4;
        param_25 = _e388;
        let _e389 = layer_at((&param_24), (&param_25));
        before = _e389;
        let _e391 = before.front;
        let _e393 = here.back;
        on_front = (abs((_e391 - _e393)) < 0.5f);
        let _e398 = before.split;
        phi_740_ = _e398;
        if _e398 {
            let _e400 = before.back;
            let _e402 = here.back;
            phi_740_ = (abs((_e400 - _e402)) < 0.5f);
        }
        let _e407 = phi_740_;
        on_back = _e407;
    }
    loop {
        let _e408 = x_2;
        let _e409 = limit;
        let _e410 = (_e408 < _e409);
        phi_754_ = _e410;
        if _e410 {
            let _e412 = seen_1.rest;
            phi_754_ = (_e412 > 0.01f);
        }
        let _e415 = phi_754_;
        if _e415 {
            let _e417 = here.split;
            idle = !(_e417);
            let _e419 = x_2;
            let _e421 = here.front;
            let _e423 = t;
            landed = ((_e419 + _e421) - _e423);
            loop {
                let _e425 = idle;
                let _e426 = x_2;
                let _e427 = limit;
                if (_e425 && (_e426 < _e427)) {
                    let _e430 = column_5;
                    let _e431 = sense;
                    param_26 = (_e430 + _e431);
                    let _e433 = row_4;
                    param_27 = _e433;
                    let _e434 = layer_bits((&param_26), (&param_27));
                    ahead = _e434;
                    let _e435 = ahead;
                    param_28 = _e435;
                    let _e436 = full_front((&param_28));
                    following_1 = _e436;
                    let _e437 = x_2;
                    let _e439 = following_1;
                    let _e441 = t;
                    then_1 = (((_e437 + 1f) + _e439) - _e441);
                    let _e443 = ahead;
                    param_29 = _e443;
                    let _e444 = is_full((&param_29));
                    phi_806_ = _e444;
                    if _e444 {
                        let _e445 = following_1;
                        let _e447 = here.front;
                        phi_806_ = (abs((_e445 - _e447)) < 0.5f);
                    }
                    let _e452 = phi_806_;
                    phi_814_ = _e452;
                    if _e452 {
                        let _e453 = landed;
                        let _e455 = then_1;
                        phi_814_ = ((_e453 > 0f) || (_e455 <= 0f));
                    }
                    let _e459 = phi_814_;
                    idle = _e459;
                    let _e460 = idle;
                    if _e460 {
                        let _e461 = x_2;
                        x_2 = (_e461 + 1f);
                        let _e463 = sense;
                        let _e464 = column_5;
                        column_5 = (_e464 + _e463);
                        let _e466 = following_1;
                        here.front = _e466;
                        let _e468 = then_1;
                        landed = _e468;
                        on_front = false;
                        on_back = false;
                    }
                    continue;
                } else {
                    break;
                }
            }
            let _e469 = x_2;
            let _e470 = limit;
            if (_e469 >= _e470) {
                break;
            }
            let _e472 = column_5;
            let _e473 = sense;
            param_30 = (_e472 + _e473);
            let _e475 = row_4;
            param_31 = _e475;
            let _e476 = layer_at((&param_30), (&param_31));
            next = _e476;
            let _e477 = x_2;
            let _e479 = here.front;
            let _e481 = t;
            a = ((_e477 + _e479) - _e481);
            let _e483 = x_2;
            let _e486 = next.front;
            let _e488 = t;
            b = (((_e483 + 1f) + _e486) - _e488);
            let _e490 = x_2;
            let _e492 = here.back;
            let _e494 = t;
            c = ((_e490 + _e492) - _e494);
            let _e496 = x_2;
            let _e499 = next.back;
            let _e501 = t;
            d = (((_e496 + 1f) + _e499) - _e501);
            let _e504 = next.front;
            let _e506 = here.front;
            front_front = (abs((_e504 - _e506)) < 0.5f);
            let _e511 = next.split;
            phi_890_ = _e511;
            if _e511 {
                let _e513 = next.back;
                let _e515 = here.front;
                phi_890_ = (abs((_e513 - _e515)) < 0.5f);
            }
            let _e520 = phi_890_;
            front_back = _e520;
            let _e522 = here.split;
            phi_903_ = _e522;
            if _e522 {
                let _e524 = next.front;
                let _e526 = here.back;
                phi_903_ = (abs((_e524 - _e526)) < 0.5f);
            }
            let _e531 = phi_903_;
            back_front = _e531;
            let _e533 = here.split;
            let _e535 = next.split;
            let _e536 = (_e533 && _e535);
            phi_919_ = _e536;
            if _e536 {
                let _e538 = next.back;
                let _e540 = here.back;
                phi_919_ = (abs((_e538 - _e540)) < 0.5f);
            }
            let _e545 = phi_919_;
            back_back = _e545;
            fronts = vec2<f32>(0f, 0f);
            backs = vec2<f32>(0f, 0f);
            let _e546 = front_front;
            let _e547 = a;
            let _e550 = b;
            if ((_e546 && (_e547 <= 0f)) && (_e550 > 0f)) {
                let _e553 = a;
                let _e555 = b;
                let _e556 = a;
                g_1 = (-(_e553) / (_e555 - _e556));
                let _e559 = g_1;
                param_32 = _e559;
                let _e560 = right_of((&param_32));
                right = _e560;
                let _e562 = here.mask;
                param_33 = _e562;
                let _e563 = right;
                param_34 = _e563;
                let _e564 = covered((&param_33), (&param_34));
                let _e565 = right;
                let _e569 = next.mask;
                param_35 = _e569;
                param_36 = (vec4(1f) - _e565);
                let _e570 = covered((&param_35), (&param_36));
                shares = vec2<f32>(_e564, _e570);
                let _e573 = shares[0u];
                let _e575 = shares[1u];
                share_2 = (_e573 + _e575);
                let _e577 = x_2;
                let _e578 = g_1;
                let _e581 = here.front;
                let _e583 = next.front;
                let _e584 = g_1;
                let _e586 = seen_1;
                param_37 = _e586;
                let _e587 = share_2;
                param_38 = _e587;
                param_39 = (_e577 + _e578);
                param_40 = mix(_e581, _e583, _e584);
                let _e588 = cover((&param_37), (&param_38), (&param_39), (&param_40));
                let _e589 = param_37;
                seen_1 = _e589;
                let _e590 = shares;
                let _e592 = share_2;
                fronts = ((_e590 * _e588) / vec2(max(_e592, 0.000001f)));
            }
            let _e596 = front_front;
            let _e597 = !(_e596);
            phi_1000_ = _e597;
            if _e597 {
                let _e599 = next.front;
                let _e601 = here.front;
                let _e604 = next.split;
                phi_1000_ = ((_e599 > _e601) || _e604);
            }
            let _e607 = phi_1000_;
            let _e608 = back_front;
            let _e611 = b;
            let _e614 = b;
            if (((_e607 && !(_e608)) && (_e611 > 0f)) && (_e614 < 1f)) {
                let _e617 = b;
                param_41 = (1f - _e617);
                let _e619 = right_of((&param_41));
                let _e623 = next.mask;
                param_42 = _e623;
                param_43 = (vec4(1f) - _e619);
                let _e624 = covered((&param_42), (&param_43));
                share_3 = _e624;
                let _e625 = x_2;
                let _e627 = seen_1;
                param_44 = _e627;
                let _e628 = share_3;
                param_45 = _e628;
                param_46 = (_e625 + 1f);
                let _e630 = next.front;
                param_47 = _e630;
                let _e631 = cover((&param_44), (&param_45), (&param_46), (&param_47));
                let _e632 = param_44;
                seen_1 = _e632;
                let _e634 = fronts[1u];
                fronts[1u] = (_e634 + _e631);
            }
            let _e637 = front_front;
            let _e638 = !(_e637);
            phi_1052_ = _e638;
            if _e638 {
                let _e640 = next.front;
                let _e642 = here.front;
                let _e645 = here.split;
                phi_1052_ = ((_e640 < _e642) || _e645);
            }
            let _e648 = phi_1052_;
            let _e649 = front_back;
            let _e652 = a;
            let _e655 = a;
            if (((_e648 && !(_e649)) && (_e652 <= 0f)) && (_e655 > -1f)) {
                let _e658 = a;
                param_48 = -(_e658);
                let _e660 = right_of((&param_48));
                let _e662 = here.mask;
                param_49 = _e662;
                param_50 = _e660;
                let _e663 = covered((&param_49), (&param_50));
                let _e664 = seen_1;
                param_51 = _e664;
                param_52 = _e663;
                let _e665 = x_2;
                param_53 = _e665;
                let _e667 = here.front;
                param_54 = _e667;
                let _e668 = cover((&param_51), (&param_52), (&param_53), (&param_54));
                let _e669 = param_51;
                seen_1 = _e669;
                let _e671 = fronts[0u];
                fronts[0u] = (_e671 + _e668);
            }
            let _e674 = front_back;
            let _e675 = a;
            let _e678 = d;
            let _e680 = ((_e674 && (_e675 <= 0f)) && (_e678 > 0f));
            phi_1100_ = _e680;
            if _e680 {
                let _e682 = seen_1.rest;
                phi_1100_ = (_e682 > 0.01f);
            }
            let _e685 = phi_1100_;
            if _e685 {
                let _e686 = a;
                let _e688 = d;
                let _e689 = a;
                g_2 = (-(_e686) / (_e688 - _e689));
                let _e692 = x_2;
                let _e693 = g_2;
                let _e695 = seen_1;
                param_55 = _e695;
                param_56 = 1f;
                param_57 = (_e692 + _e693);
                let _e697 = here.front;
                param_58 = _e697;
                let _e698 = cover((&param_55), (&param_56), (&param_57), (&param_58));
                let _e699 = param_55;
                seen_1 = _e699;
                taken_1 = _e698;
                let _e700 = taken_1;
                let _e701 = g_2;
                let _e705 = fronts[0u];
                fronts[0u] = (_e705 + (_e700 * (1f - _e701)));
                let _e708 = taken_1;
                let _e709 = g_2;
                let _e712 = backs[1u];
                backs[1u] = (_e712 + (_e708 * _e709));
            }
            let _e715 = back_front;
            let _e716 = c;
            let _e719 = b;
            let _e721 = ((_e715 && (_e716 <= 0f)) && (_e719 > 0f));
            phi_1150_ = _e721;
            if _e721 {
                let _e723 = seen_1.rest;
                phi_1150_ = (_e723 > 0.01f);
            }
            let _e726 = phi_1150_;
            if _e726 {
                let _e727 = c;
                let _e729 = b;
                let _e730 = c;
                g_3 = (-(_e727) / (_e729 - _e730));
                let _e733 = x_2;
                let _e734 = g_3;
                let _e736 = seen_1;
                param_59 = _e736;
                param_60 = 1f;
                param_61 = (_e733 + _e734);
                let _e738 = next.front;
                param_62 = _e738;
                let _e739 = cover((&param_59), (&param_60), (&param_61), (&param_62));
                let _e740 = param_59;
                seen_1 = _e740;
                taken_2 = _e739;
                let _e741 = taken_2;
                let _e742 = g_3;
                let _e746 = backs[0u];
                backs[0u] = (_e746 + (_e741 * (1f - _e742)));
                let _e749 = taken_2;
                let _e750 = g_3;
                let _e753 = fronts[1u];
                fronts[1u] = (_e753 + (_e749 * _e750));
            }
            let _e756 = back_back;
            let _e757 = c;
            let _e760 = d;
            let _e762 = ((_e756 && (_e757 <= 0f)) && (_e760 > 0f));
            phi_1200_ = _e762;
            if _e762 {
                let _e764 = seen_1.rest;
                phi_1200_ = (_e764 > 0.01f);
            }
            let _e767 = phi_1200_;
            if _e767 {
                let _e768 = c;
                let _e770 = d;
                let _e771 = c;
                g_4 = (-(_e768) / (_e770 - _e771));
                let _e774 = x_2;
                let _e775 = g_4;
                let _e777 = seen_1;
                param_63 = _e777;
                param_64 = 1f;
                param_65 = (_e774 + _e775);
                let _e779 = here.back;
                param_66 = _e779;
                let _e780 = cover((&param_63), (&param_64), (&param_65), (&param_66));
                let _e781 = param_63;
                seen_1 = _e781;
                taken_3 = _e780;
                let _e782 = taken_3;
                let _e783 = g_4;
                let _e785 = g_4;
                let _e788 = backs;
                backs = (_e788 + (vec2<f32>((1f - _e783), _e785) * _e782));
            }
            let _e791 = here.split;
            let _e792 = back_front;
            let _e795 = back_back;
            ends = ((_e791 && !(_e792)) && !(_e795));
            let _e798 = ends;
            let _e799 = on_front;
            let _e802 = on_back;
            let _e804 = ((_e798 && !(_e799)) && !(_e802));
            phi_1252_ = _e804;
            if _e804 {
                let _e805 = c;
                phi_1252_ = (abs(_e805) < 1f);
            }
            let _e809 = phi_1252_;
            phi_1258_ = _e809;
            if _e809 {
                let _e811 = seen_1.rest;
                phi_1258_ = (_e811 > 0.01f);
            }
            let _e814 = phi_1258_;
            if _e814 {
                let _e815 = c;
                if (_e815 <= 0f) {
                    let _e817 = c;
                    param_67 = -(_e817);
                    let _e819 = right_of((&param_67));
                    local_8 = _e819;
                } else {
                    let _e820 = c;
                    param_68 = (1f - _e820);
                    let _e822 = right_of((&param_68));
                    local_8 = (vec4(1f) - _e822);
                }
                let _e825 = local_8;
                stripes_1 = _e825;
                let _e827 = here.mask;
                param_69 = (vec4(1f) - _e827);
                let _e830 = stripes_1;
                param_70 = _e830;
                let _e831 = covered((&param_69), (&param_70));
                let _e832 = seen_1;
                param_71 = _e832;
                param_72 = _e831;
                let _e833 = x_2;
                param_73 = _e833;
                let _e835 = here.back;
                param_74 = _e835;
                let _e836 = cover((&param_71), (&param_72), (&param_73), (&param_74));
                let _e837 = param_71;
                seen_1 = _e837;
                let _e839 = backs[0u];
                backs[0u] = (_e839 + _e836);
            }
            let _e842 = ends;
            phi_1310_ = _e842;
            if _e842 {
                let _e844 = next.front;
                let _e846 = here.back;
                phi_1310_ = (_e844 > _e846);
            }
            let _e849 = phi_1310_;
            let _e850 = c;
            at_back = (_e849 && (_e850 <= 0f));
            let _e854 = here.split;
            let _e856 = front_front;
            let _e859 = front_back;
            let _e861 = ((!(_e854) && !(_e856)) && !(_e859));
            phi_1331_ = _e861;
            if _e861 {
                let _e863 = next.front;
                let _e865 = here.front;
                phi_1331_ = (_e863 > _e865);
            }
            let _e868 = phi_1331_;
            let _e869 = a;
            at_front = (_e868 && (_e869 <= 0f));
            let _e872 = at_back;
            let _e873 = at_front;
            let _e874 = (_e872 || _e873);
            phi_1343_ = _e874;
            if _e874 {
                let _e876 = seen_1.rest;
                phi_1343_ = (_e876 > 0.01f);
            }
            let _e879 = phi_1343_;
            if _e879 {
                let _e880 = at_back;
                if _e880 {
                    let _e882 = here.back;
                    local_9 = _e882;
                } else {
                    let _e884 = here.front;
                    local_9 = _e884;
                }
                let _e885 = local_9;
                reach_2 = _e885;
                let _e886 = at_back;
                if _e886 {
                    let _e887 = c;
                    local_10 = -(_e887);
                } else {
                    let _e889 = a;
                    local_10 = -(_e889);
                }
                let _e891 = local_10;
                away = _e891;
                let _e892 = at_back;
                let _e893 = on_front;
                if (_e892 && !(_e893)) {
                    let _e897 = here.mask;
                    param_75 = _e897;
                    param_76 = vec4<f32>(1f, 1f, 1f, 1f);
                    let _e898 = covered((&param_75), (&param_76));
                    local_11 = (1f - _e898);
                } else {
                    local_11 = 1f;
                }
                let _e900 = local_11;
                weight = _e900;
                let _e901 = column_5;
                let _e902 = at_back;
                let _e903 = reach_2;
                let _e904 = weight;
                found = Edge(_e901, _e902, _e903, _e904);
                let _e906 = weight;
                let _e908 = away;
                if ((_e906 == 1f) && (_e908 < 0.5f)) {
                    let _e911 = seen_1;
                    param_77 = _e911;
                    param_78 = 1f;
                    let _e912 = x_2;
                    param_79 = _e912;
                    let _e913 = reach_2;
                    param_80 = _e913;
                    let _e914 = cover((&param_77), (&param_78), (&param_79), (&param_80));
                    let _e915 = param_77;
                    seen_1 = _e915;
                    taken_4 = _e914;
                    let _e916 = at_back;
                    let _e917 = taken_4;
                    let _e920 = backs[0u];
                    backs[0u] = (_e920 + select(0f, _e917, _e916));
                    let _e923 = at_back;
                    let _e924 = taken_4;
                    let _e927 = fronts[0u];
                    fronts[0u] = (_e927 + select(_e924, 0f, _e923));
                }
                let _e930 = reach_2;
                let _e932 = edge.reach;
                if (_e930 < _e932) {
                    let _e934 = weight;
                    if (_e934 < 1f) {
                        let _e936 = edge;
                        second = _e936;
                    }
                    let _e937 = found;
                    edge = _e937;
                } else {
                    let _e938 = reach_2;
                    let _e940 = second.reach;
                    if (_e938 < _e940) {
                        let _e942 = found;
                        second = _e942;
                    }
                }
            }
            let _e944 = fronts[0u];
            let _e946 = backs[0u];
            if (max(_e944, _e946) > 0f) {
                let _e949 = column_5;
                param_81 = _e949;
                let _e950 = row_4;
                param_82 = _e950;
                let _e952 = fronts[0u];
                param_83 = _e952;
                let _e954 = backs[0u];
                param_84 = _e954;
                let _e955 = weighted((&param_81), (&param_82), (&param_83), (&param_84));
                let _e956 = color;
                color = (_e956 + _e955);
            }
            let _e959 = fronts[1u];
            let _e961 = backs[1u];
            if (max(_e959, _e961) > 0f) {
                let _e964 = column_5;
                let _e965 = sense;
                param_85 = (_e964 + _e965);
                let _e967 = row_4;
                param_86 = _e967;
                let _e969 = fronts[1u];
                param_87 = _e969;
                let _e971 = backs[1u];
                param_88 = _e971;
                let _e972 = weighted((&param_85), (&param_86), (&param_87), (&param_88));
                let _e973 = color;
                color = (_e973 + _e972);
            }
            let _e975 = front_back;
            on_front = _e975;
            let _e976 = back_back;
            on_back = _e976;
            let _e977 = next;
            here = _e977;
            let _e978 = sense;
            let _e979 = column_5;
            column_5 = (_e979 + _e978);
            let _e981 = x_2;
            x_2 = (_e981 + 1f);
            continue;
        } else {
            break;
        }
    }
    let _e984 = seen_1.rest;
    hole = (_e984 > 0.5f);
    let _e987 = seen_1.rest;
    if (_e987 > 0.01f) {
        let _e990 = edge.column;
        beyond = (_e990 < 0i);
        let _e992 = beyond;
        if _e992 {
            let _e993 = column_5;
            let _e995 = here.split;
            let _e997 = here.split;
            if _e997 {
                let _e999 = here.back;
                local_12 = _e999;
            } else {
                let _e1001 = here.front;
                local_12 = _e1001;
            }
            let _e1002 = local_12;
            edge = Edge(_e993, _e995, _e1002, 1f);
        }
        let _e1005 = edge.column;
        param_89 = _e1005;
        let _e1006 = source_column((&param_89));
        edge_x = f32(_e1006);
        let _e1008 = t;
        let _e1009 = edge_x;
        let _e1012 = edge.reach;
        away_1 = abs(((_e1008 - _e1009) - _e1012));
        let _e1015 = away_1;
        spread = (0.5f * clamp(_e1015, 1f, 12f));
        sum = vec4<f32>(0f, 0f, 0f, 0f);
        weights = 0f;
        let _e1018 = beyond;
        let _e1019 = away_1;
        rows = select(2i, 0i, (_e1018 && (_e1019 < 0.5f)));
        let _e1023 = rows;
        i = -(_e1023);
        loop {
            let _e1025 = i;
            let _e1026 = rows;
            if (_e1025 <= _e1026) {
                let _e1028 = row_4;
                let _e1029 = i;
                let _e1031 = spread;
                let _e1038 = synthesis.source_size[1u];
                at_2 = clamp((_e1028 + i32(round((f32(_e1029) * _e1031)))), 0i, (_e1038 - 1i));
                let _e1042 = edge.column;
                param_90 = _e1042;
                let _e1043 = at_2;
                param_91 = _e1043;
                let _e1044 = layer_at((&param_90), (&param_91));
                layer_3 = _e1044;
                let _e1045 = i;
                if (_e1045 == 0i) {
                    let _e1048 = edge.back;
                    local_13 = !(_e1048);
                } else {
                    let _e1051 = layer_3.front;
                    let _e1053 = edge.reach;
                    local_13 = (_e1051 <= (_e1053 + 1f));
                }
                let _e1056 = local_13;
                front_2 = _e1056;
                let _e1057 = i;
                if (_e1057 == 0i) {
                    let _e1060 = edge.back;
                    local_14 = _e1060;
                } else {
                    let _e1061 = front_2;
                    let _e1064 = layer_3.split;
                    let _e1065 = (!(_e1061) && _e1064);
                    phi_1621_ = _e1065;
                    if _e1065 {
                        let _e1067 = layer_3.back;
                        let _e1069 = edge.reach;
                        phi_1621_ = (_e1067 <= (_e1069 + 1f));
                    }
                    let _e1073 = phi_1621_;
                    local_14 = _e1073;
                }
                let _e1074 = local_14;
                behind_1 = _e1074;
                let _e1075 = i;
                if (_e1075 == 0i) {
                    local_15 = 2f;
                } else {
                    let _e1077 = front_2;
                    if _e1077 {
                        local_16 = 1f;
                    } else {
                        let _e1078 = behind_1;
                        if _e1078 {
                            let _e1080 = layer_3.mask;
                            param_92 = _e1080;
                            param_93 = vec4<f32>(1f, 1f, 1f, 1f);
                            let _e1081 = covered((&param_92), (&param_93));
                            local_17 = (1f - _e1081);
                        } else {
                            local_17 = 0f;
                        }
                        let _e1083 = local_17;
                        local_16 = _e1083;
                    }
                    let _e1084 = local_16;
                    local_15 = _e1084;
                }
                let _e1085 = local_15;
                weight_1 = _e1085;
                let _e1086 = front_2;
                let _e1087 = weight_1;
                let _e1089 = front_2;
                let _e1090 = weight_1;
                let _e1093 = edge.column;
                param_94 = _e1093;
                let _e1094 = at_2;
                param_95 = _e1094;
                param_96 = select(0f, _e1087, _e1086);
                param_97 = select(_e1090, 0f, _e1089);
                let _e1095 = weighted((&param_94), (&param_95), (&param_96), (&param_97));
                let _e1096 = sum;
                sum = (_e1096 + _e1095);
                let _e1098 = weight_1;
                let _e1099 = weights;
                weights = (_e1099 + _e1098);
                continue;
            } else {
                break;
            }
            continuing {
                let _e1101 = i;
                i = (_e1101 + 1i);
            }
        }
        let _e1103 = sum;
        let _e1104 = weights;
        fill = (_e1103 / vec4(_e1104));
        let _e1108 = second.column;
        let _e1109 = (_e1108 >= 0i);
        phi_1683_ = _e1109;
        if _e1109 {
            let _e1111 = edge.weight;
            phi_1683_ = (_e1111 < 1f);
        }
        let _e1114 = phi_1683_;
        if _e1114 {
            let _e1116 = second.back;
            one = select(vec2<f32>(1f, 0f), vec2<f32>(0f, 1f), vec2(_e1116));
            let _e1120 = second.column;
            param_98 = _e1120;
            let _e1121 = row_4;
            param_99 = _e1121;
            let _e1123 = one[0u];
            param_100 = _e1123;
            let _e1125 = one[1u];
            param_101 = _e1125;
            let _e1126 = weighted((&param_98), (&param_99), (&param_100), (&param_101));
            let _e1127 = fill;
            let _e1129 = edge.weight;
            fill = mix(_e1126, _e1127, vec4(_e1129));
        }
        let _e1132 = hole;
        let _e1133 = away_1;
        hole = (_e1132 && (_e1133 >= 0.5f));
        let _e1136 = seen_1;
        param_102 = _e1136;
        param_103 = 1f;
        let _e1137 = edge_x;
        param_104 = _e1137;
        let _e1139 = edge.reach;
        param_105 = _e1139;
        let _e1140 = cover((&param_102), (&param_103), (&param_104), (&param_105));
        let _e1141 = param_102;
        seen_1 = _e1141;
        let _e1142 = fill;
        let _e1144 = color;
        color = (_e1144 + (_e1142 * _e1140));
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
