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

fn in_image(pixel: ptr<function, vec2<i32>>) -> vec2<i32> {
    var local_1: vec2<i32>;

    if true {
        let _e5 = synthesis.source_origin;
        let _e6 = (*pixel);
        local_1 = (_e5 + _e6);
    } else {
        let _e8 = (*pixel);
        local_1 = _e8;
    }
    let _e9 = local_1;
    return _e9;
}

fn weighted(column: ptr<function, i32>, row: ptr<function, i32>, of_front: ptr<function, f32>, of_back: ptr<function, f32>) -> vec4<f32> {
    var mixture: vec4<f32>;
    var param: vec2<i32>;
    var behind: vec4<f32>;
    var share: f32;
    var front: vec4<f32>;
    var local_2: vec4<f32>;

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
        local_2 = clamp(((_e33 - (_e36 * (1f - _e34))) / vec4(max(_e39, 0.01f))), vec4(0f), vec4(1f));
    } else {
        let _e46 = mixture;
        local_2 = _e46;
    }
    let _e47 = local_2;
    front = _e47;
    let _e48 = (*of_front);
    let _e49 = front;
    let _e51 = (*of_back);
    let _e52 = behind;
    return ((_e49 * _e48) + (_e52 * _e51));
}

fn cover(seen: ptr<function, Seen>, share_1: ptr<function, f32>, column_1: ptr<function, f32>, reach: ptr<function, f32>) -> f32 {
    var taken: f32;
    var passes: bool;
    var local_3: f32;
    var local_4: f32;
    var phi_596_: bool;

    let _e10 = (*seen).rest;
    let _e11 = (*share_1);
    taken = (_e10 * _e11);
    let _e14 = (*seen).rest;
    let _e15 = (_e14 > 0.5f);
    phi_596_ = _e15;
    if _e15 {
        let _e17 = (*seen).rest;
        let _e18 = taken;
        phi_596_ = ((_e17 - _e18) <= 0.5f);
    }
    let _e22 = phi_596_;
    passes = _e22;
    let _e23 = passes;
    if _e23 {
        let _e24 = (*column_1);
        local_3 = _e24;
    } else {
        let _e26 = (*seen).column;
        local_3 = _e26;
    }
    let _e27 = local_3;
    (*seen).column = _e27;
    let _e29 = passes;
    if _e29 {
        let _e30 = (*reach);
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

fn covered(mask: ptr<function, vec4<f32>>, stripes: ptr<function, vec4<f32>>) -> f32 {
    let _e3 = (*mask);
    let _e4 = (*stripes);
    return (0.25f * dot(_e3, _e4));
}

fn right_of(place: ptr<function, f32>) -> vec4<f32> {
    let _e5 = (*place);
    return clamp((vec4<f32>(1f, 2f, 3f, 4f) - vec4((4f * _e5))), vec4(0f), vec4(1f));
}

fn mask_of(layer: ptr<function, Layer>, column_2: ptr<function, i32>, row_1: ptr<function, i32>) -> vec4<f32> {
    var share_2: f32;
    var local_5: vec4<f32>;
    var local_6: vec4<f32>;

    let _e17 = (*layer).split;
    if !(_e17) {
        return vec4<f32>(1f, 1f, 1f, 1f);
    }
    let _e19 = (*column_2);
    let _e20 = (*row_1);
    let _e22 = textureLoad(back_map_texture, vec2<i32>(_e19, _e20), 0i);
    share_2 = _e22.w;
    let _e25 = (*layer).code;
    if (_e25 == 1u) {
        let _e27 = share_2;
        local_5 = clamp((vec4((4f * _e27)) - vec4<f32>(0f, 1f, 2f, 3f)), vec4(0f), vec4(1f));
    } else {
        let _e35 = (*layer).code;
        if (_e35 == 2u) {
            let _e37 = share_2;
            local_6 = clamp((vec4((4f * _e37)) - vec4<f32>(3f, 2f, 1f, 0f)), vec4(0f), vec4(1f));
        } else {
            let _e44 = share_2;
            local_6 = vec4(_e44);
        }
        let _e46 = local_6;
        local_5 = _e46;
    }
    let _e47 = local_5;
    return _e47;
}

fn reach_1() -> f32 {
    let _e3 = synthesis.near_displacement;
    let _e5 = synthesis.far_displacement;
    return max((_e3 - _e5), 0.000001f);
}

fn full_front(layer_1: ptr<function, u32>) -> f32 {
    let _e3 = (*layer_1);
    let _e6 = reach_1();
    return (f32((_e3 & 268435455u)) * (_e6 / 268435440f));
}

fn is_full(layer_2: ptr<function, u32>) -> bool {
    let _e3 = (*layer_2);
    return ((_e3 >> bitcast<u32>(28i)) == 15u);
}

fn split_displacements(layer_3: ptr<function, u32>) -> vec2<f32> {
    let _e4 = (*layer_3);
    let _e5 = (*layer_3);
    let _e12 = reach_1();
    return (vec2<f32>((vec2<u32>(_e4, (_e5 >> bitcast<u32>(14i))) & vec2(16383u))) * (_e12 / 16383f));
}

fn layer_bits(column_3: ptr<function, i32>, row_2: ptr<function, i32>) -> u32 {
    let _e4 = (*column_3);
    let _e5 = (*row_2);
    let _e7 = textureLoad(layer_map_texture, vec2<i32>(_e4, _e5), 0i);
    return _e7.x;
}

fn layer_at(column_4: ptr<function, i32>, row_3: ptr<function, i32>) -> Layer {
    var bits: u32;
    var param_1: i32;
    var param_2: i32;
    var both: vec2<f32>;
    var param_3: u32;
    var split: bool;
    var param_4: u32;
    var local_7: f32;
    var param_5: u32;
    var local_8: f32;

    let _e16 = (*column_4);
    param_1 = _e16;
    let _e17 = (*row_3);
    param_2 = _e17;
    let _e18 = layer_bits((&param_1), (&param_2));
    bits = _e18;
    let _e19 = bits;
    param_3 = _e19;
    let _e20 = split_displacements((&param_3));
    both = _e20;
    let _e21 = bits;
    param_4 = _e21;
    let _e22 = is_full((&param_4));
    split = !(_e22);
    let _e24 = split;
    if _e24 {
        let _e26 = both[0u];
        local_7 = _e26;
    } else {
        let _e27 = bits;
        param_5 = _e27;
        let _e28 = full_front((&param_5));
        local_7 = _e28;
    }
    let _e29 = local_7;
    let _e30 = split;
    if _e30 {
        let _e32 = both[1u];
        local_8 = _e32;
    } else {
        local_8 = 1000000000f;
    }
    let _e33 = local_8;
    let _e34 = split;
    let _e35 = bits;
    return Layer(_e29, _e33, _e34, (_e35 >> bitcast<u32>(28i)));
}

fn composed(row_4: ptr<function, i32>, t: ptr<function, f32>, x_1: ptr<function, f32>, limit: ptr<function, f32>, column_5: ptr<function, i32>, seen_1: ptr<function, Seen>) -> vec4<f32> {
    var sense: i32;
    var color_sum: vec4<f32>;
    var here: Layer;
    var param_6: i32;
    var param_7: i32;
    var edge: Edge;
    var second: Edge;
    var on_front: bool;
    var on_back: bool;
    var before: Layer;
    var param_8: i32;
    var param_9: i32;
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
    var param_10: i32;
    var param_11: i32;
    var crosses: bool;
    var front_begins: bool;
    var front_ends: bool;
    var back_ends: bool;
    var here_mask: vec4<f32>;
    var param_12: Layer;
    var param_13: i32;
    var param_14: i32;
    var next_mask: vec4<f32>;
    var param_15: Layer;
    var param_16: i32;
    var param_17: i32;
    var fronts: vec2<f32>;
    var backs: vec2<f32>;
    var g: f32;
    var right: vec4<f32>;
    var param_18: f32;
    var shares: vec2<f32>;
    var param_19: vec4<f32>;
    var param_20: vec4<f32>;
    var param_21: vec4<f32>;
    var param_22: vec4<f32>;
    var share_3: f32;
    var param_23: Seen;
    var param_24: f32;
    var param_25: f32;
    var param_26: f32;
    var share_4: f32;
    var param_27: f32;
    var param_28: vec4<f32>;
    var param_29: vec4<f32>;
    var param_30: Seen;
    var param_31: f32;
    var param_32: f32;
    var param_33: f32;
    var param_34: f32;
    var param_35: vec4<f32>;
    var param_36: vec4<f32>;
    var param_37: Seen;
    var param_38: f32;
    var param_39: f32;
    var param_40: f32;
    var g_1: f32;
    var taken_1: f32;
    var param_41: Seen;
    var param_42: f32;
    var param_43: f32;
    var param_44: f32;
    var g_2: f32;
    var taken_2: f32;
    var param_45: Seen;
    var param_46: f32;
    var param_47: f32;
    var param_48: f32;
    var g_3: f32;
    var taken_3: f32;
    var param_49: Seen;
    var param_50: f32;
    var param_51: f32;
    var param_52: f32;
    var ends: bool;
    var stripes_1: vec4<f32>;
    var local_9: vec4<f32>;
    var param_53: f32;
    var param_54: f32;
    var param_55: vec4<f32>;
    var param_56: vec4<f32>;
    var param_57: Seen;
    var param_58: f32;
    var param_59: f32;
    var param_60: f32;
    var at_back: bool;
    var at_front: bool;
    var reach_2: f32;
    var local_10: f32;
    var away: f32;
    var local_11: f32;
    var weight: f32;
    var local_12: f32;
    var param_61: vec4<f32>;
    var param_62: vec4<f32>;
    var found: Edge;
    var taken_4: f32;
    var param_63: Seen;
    var param_64: f32;
    var param_65: f32;
    var param_66: f32;
    var param_67: i32;
    var param_68: i32;
    var param_69: f32;
    var param_70: f32;
    var param_71: i32;
    var param_72: i32;
    var param_73: f32;
    var param_74: f32;
    var beyond: bool;
    var local_13: f32;
    var edge_x: f32;
    var param_75: i32;
    var away_1: f32;
    var spread: f32;
    var sum: vec4<f32>;
    var weights: f32;
    var rows: i32;
    var i: i32;
    var at: i32;
    var layer_4: Layer;
    var param_76: i32;
    var param_77: i32;
    var front_1: bool;
    var local_14: bool;
    var behind_1: bool;
    var local_15: bool;
    var weight_1: f32;
    var local_16: f32;
    var local_17: f32;
    var local_18: f32;
    var param_78: Layer;
    var param_79: i32;
    var param_80: i32;
    var param_81: vec4<f32>;
    var param_82: vec4<f32>;
    var param_83: i32;
    var param_84: i32;
    var param_85: f32;
    var param_86: f32;
    var fill: vec4<f32>;
    var one: vec2<f32>;
    var param_87: i32;
    var param_88: i32;
    var param_89: f32;
    var param_90: f32;
    var param_91: Seen;
    var param_92: f32;
    var param_93: f32;
    var param_94: f32;
    var phi_669_: bool;
    var phi_676_: bool;
    var phi_718_: bool;
    var phi_732_: bool;
    var phi_820_: bool;
    var phi_837_: bool;
    var phi_838_: bool;
    var phi_857_: bool;
    var phi_858_: bool;
    var phi_859_: bool;
    var phi_894_: bool;
    var phi_895_: bool;
    var phi_917_: bool;
    var phi_918_: bool;
    var phi_1039_: bool;
    var phi_1090_: bool;
    var phi_1136_: bool;
    var phi_1186_: bool;
    var phi_1236_: bool;
    var phi_1288_: bool;
    var phi_1294_: bool;
    var phi_1345_: bool;
    var phi_1366_: bool;
    var phi_1378_: bool;
    var phi_1655_: bool;
    var phi_1723_: bool;

    let _e190 = synthesis.mirrored;
    sense = select(1i, -1i, (_e190 != 0u));
    color_sum = vec4<f32>(0f, 0f, 0f, 0f);
    let _e193 = (*column_5);
    param_6 = _e193;
    let _e194 = (*row_4);
    param_7 = _e194;
    let _e195 = layer_at((&param_6), (&param_7));
    here = _e195;
    edge = Edge(-1i, false, 1000000000f, 1f);
    let _e196 = edge;
    second = _e196;
    let _e197 = (*x_1);
    if (_e197 == 0f) {
        let _e200 = here.front;
        let _e201 = (*t);
        if (_e200 > _e201) {
            let _e203 = (*column_5);
            let _e205 = here.front;
            edge = Edge(_e203, false, _e205, 1f);
        }
        let _e208 = here.split;
        phi_669_ = _e208;
        if _e208 {
            let _e210 = here.back;
            let _e212 = edge.reach;
            phi_669_ = (_e210 < _e212);
        }
        let _e215 = phi_669_;
        phi_676_ = _e215;
        if _e215 {
            let _e217 = here.back;
            let _e218 = (*t);
            phi_676_ = (_e217 > _e218);
        }
        let _e221 = phi_676_;
        if _e221 {
            let _e222 = (*column_5);
            let _e224 = here.back;
            edge = Edge(_e222, true, _e224, 1f);
        }
    }
    on_front = false;
    on_back = false;
    let _e226 = (*x_1);
    let _e229 = here.split;
    if ((_e226 > 0f) && _e229) {
        let _e231 = (*column_5);
        let _e232 = sense;
        param_8 = (_e231 - _e232);
        let _e234 = (*row_4);
        param_9 = _e234;
        let _e235 = layer_at((&param_8), (&param_9));
        before = _e235;
        let _e237 = before.front;
        let _e239 = here.back;
        on_front = (abs((_e237 - _e239)) < 0.5f);
        let _e244 = before.split;
        phi_718_ = _e244;
        if _e244 {
            let _e246 = before.back;
            let _e248 = here.back;
            phi_718_ = (abs((_e246 - _e248)) < 0.5f);
        }
        let _e253 = phi_718_;
        on_back = _e253;
    }
    loop {
        let _e254 = (*x_1);
        let _e255 = (*limit);
        let _e256 = (_e254 < _e255);
        phi_732_ = _e256;
        if _e256 {
            let _e258 = (*seen_1).rest;
            phi_732_ = (_e258 > 0.01f);
        }
        let _e261 = phi_732_;
        if _e261 {
            let _e262 = here;
            next = _e262;
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
                let _e263 = event;
                let _e265 = (*x_1);
                let _e266 = (*limit);
                if (!(_e263) && (_e265 < _e266)) {
                    let _e269 = (*column_5);
                    let _e270 = sense;
                    param_10 = (_e269 + _e270);
                    let _e272 = (*row_4);
                    param_11 = _e272;
                    let _e273 = layer_at((&param_10), (&param_11));
                    next = _e273;
                    let _e274 = (*x_1);
                    let _e276 = here.front;
                    let _e278 = (*t);
                    a = ((_e274 + _e276) - _e278);
                    let _e280 = (*x_1);
                    let _e283 = next.front;
                    let _e285 = (*t);
                    b = (((_e280 + 1f) + _e283) - _e285);
                    let _e287 = (*x_1);
                    let _e289 = here.back;
                    let _e291 = (*t);
                    c = ((_e287 + _e289) - _e291);
                    let _e293 = (*x_1);
                    let _e296 = next.back;
                    let _e298 = (*t);
                    d = (((_e293 + 1f) + _e296) - _e298);
                    let _e301 = next.front;
                    let _e303 = here.front;
                    front_front = (abs((_e301 - _e303)) < 0.5f);
                    let _e308 = next.back;
                    let _e310 = here.front;
                    front_back = (abs((_e308 - _e310)) < 0.5f);
                    let _e315 = next.front;
                    let _e317 = here.back;
                    back_front = (abs((_e315 - _e317)) < 0.5f);
                    let _e322 = here.split;
                    phi_820_ = _e322;
                    if _e322 {
                        let _e324 = next.back;
                        let _e326 = here.back;
                        phi_820_ = (abs((_e324 - _e326)) < 0.5f);
                    }
                    let _e331 = phi_820_;
                    back_back = _e331;
                    let _e332 = a;
                    let _e333 = (_e332 <= 0f);
                    phi_838_ = _e333;
                    if _e333 {
                        let _e334 = front_front;
                        let _e335 = b;
                        let _e337 = (_e334 && (_e335 > 0f));
                        phi_837_ = _e337;
                        if !(_e337) {
                            let _e339 = front_back;
                            let _e340 = d;
                            phi_837_ = (_e339 && (_e340 > 0f));
                        }
                        let _e344 = phi_837_;
                        phi_838_ = _e344;
                    }
                    let _e346 = phi_838_;
                    phi_859_ = _e346;
                    if !(_e346) {
                        let _e348 = c;
                        let _e349 = (_e348 <= 0f);
                        phi_858_ = _e349;
                        if _e349 {
                            let _e350 = back_front;
                            let _e351 = b;
                            let _e353 = (_e350 && (_e351 > 0f));
                            phi_857_ = _e353;
                            if !(_e353) {
                                let _e355 = back_back;
                                let _e356 = d;
                                phi_857_ = (_e355 && (_e356 > 0f));
                            }
                            let _e360 = phi_857_;
                            phi_858_ = _e360;
                        }
                        let _e362 = phi_858_;
                        phi_859_ = _e362;
                    }
                    let _e364 = phi_859_;
                    crosses = _e364;
                    let _e365 = front_front;
                    let _e367 = back_front;
                    let _e370 = b;
                    let _e373 = b;
                    front_begins = (((!(_e365) && !(_e367)) && (_e370 > 0f)) && (_e373 < 1f));
                    let _e376 = front_front;
                    let _e378 = front_back;
                    let _e381 = a;
                    let _e383 = ((!(_e376) && !(_e378)) && (_e381 <= 0f));
                    phi_895_ = _e383;
                    if _e383 {
                        let _e384 = a;
                        let _e385 = (_e384 > -1f);
                        phi_894_ = _e385;
                        if !(_e385) {
                            let _e388 = next.front;
                            let _e390 = here.front;
                            phi_894_ = (_e388 > _e390);
                        }
                        let _e393 = phi_894_;
                        phi_895_ = _e393;
                    }
                    let _e395 = phi_895_;
                    front_ends = _e395;
                    let _e396 = back_front;
                    let _e398 = back_back;
                    let _e401 = c;
                    let _e403 = ((!(_e396) && !(_e398)) && (_e401 < 1f));
                    phi_918_ = _e403;
                    if _e403 {
                        let _e404 = c;
                        let _e405 = (_e404 > -1f);
                        phi_917_ = _e405;
                        if !(_e405) {
                            let _e408 = next.front;
                            let _e410 = here.back;
                            phi_917_ = (_e408 > _e410);
                        }
                        let _e413 = phi_917_;
                        phi_918_ = _e413;
                    }
                    let _e415 = phi_918_;
                    back_ends = _e415;
                    let _e416 = crosses;
                    let _e417 = front_begins;
                    let _e419 = front_ends;
                    let _e421 = back_ends;
                    event = (((_e416 || _e417) || _e419) || _e421);
                    let _e423 = event;
                    if !(_e423) {
                        let _e425 = (*x_1);
                        (*x_1) = (_e425 + 1f);
                        let _e427 = sense;
                        let _e428 = (*column_5);
                        (*column_5) = (_e428 + _e427);
                        let _e430 = next;
                        here = _e430;
                        let _e431 = front_back;
                        on_front = _e431;
                        let _e432 = back_back;
                        on_back = _e432;
                    }
                    continue;
                } else {
                    break;
                }
            }
            let _e433 = event;
            if !(_e433) {
                break;
            }
            let _e435 = here;
            param_12 = _e435;
            let _e436 = (*column_5);
            param_13 = _e436;
            let _e437 = (*row_4);
            param_14 = _e437;
            let _e438 = mask_of((&param_12), (&param_13), (&param_14));
            here_mask = _e438;
            let _e439 = (*column_5);
            let _e440 = sense;
            let _e442 = next;
            param_15 = _e442;
            param_16 = (_e439 + _e440);
            let _e443 = (*row_4);
            param_17 = _e443;
            let _e444 = mask_of((&param_15), (&param_16), (&param_17));
            next_mask = _e444;
            fronts = vec2<f32>(0f, 0f);
            backs = vec2<f32>(0f, 0f);
            let _e445 = front_front;
            let _e446 = a;
            let _e449 = b;
            if ((_e445 && (_e446 <= 0f)) && (_e449 > 0f)) {
                let _e452 = a;
                let _e454 = b;
                let _e455 = a;
                g = (-(_e452) / (_e454 - _e455));
                let _e458 = g;
                param_18 = _e458;
                let _e459 = right_of((&param_18));
                right = _e459;
                let _e460 = here_mask;
                param_19 = _e460;
                let _e461 = right;
                param_20 = _e461;
                let _e462 = covered((&param_19), (&param_20));
                let _e463 = right;
                let _e466 = next_mask;
                param_21 = _e466;
                param_22 = (vec4(1f) - _e463);
                let _e467 = covered((&param_21), (&param_22));
                shares = vec2<f32>(_e462, _e467);
                let _e470 = shares[0u];
                let _e472 = shares[1u];
                share_3 = (_e470 + _e472);
                let _e474 = (*x_1);
                let _e475 = g;
                let _e478 = here.front;
                let _e480 = next.front;
                let _e481 = g;
                let _e483 = (*seen_1);
                param_23 = _e483;
                let _e484 = share_3;
                param_24 = _e484;
                param_25 = (_e474 + _e475);
                param_26 = mix(_e478, _e480, _e481);
                let _e485 = cover((&param_23), (&param_24), (&param_25), (&param_26));
                let _e486 = param_23;
                (*seen_1) = _e486;
                let _e487 = shares;
                let _e489 = share_3;
                fronts = ((_e487 * _e485) / vec2(max(_e489, 0.000001f)));
            }
            let _e493 = front_front;
            let _e494 = !(_e493);
            phi_1039_ = _e494;
            if _e494 {
                let _e496 = next.front;
                let _e498 = here.front;
                let _e501 = next.split;
                phi_1039_ = ((_e496 > _e498) || _e501);
            }
            let _e504 = phi_1039_;
            let _e505 = back_front;
            let _e508 = b;
            let _e511 = b;
            if (((_e504 && !(_e505)) && (_e508 > 0f)) && (_e511 < 1f)) {
                let _e514 = b;
                param_27 = (1f - _e514);
                let _e516 = right_of((&param_27));
                let _e519 = next_mask;
                param_28 = _e519;
                param_29 = (vec4(1f) - _e516);
                let _e520 = covered((&param_28), (&param_29));
                share_4 = _e520;
                let _e521 = (*x_1);
                let _e523 = (*seen_1);
                param_30 = _e523;
                let _e524 = share_4;
                param_31 = _e524;
                param_32 = (_e521 + 1f);
                let _e526 = next.front;
                param_33 = _e526;
                let _e527 = cover((&param_30), (&param_31), (&param_32), (&param_33));
                let _e528 = param_30;
                (*seen_1) = _e528;
                let _e530 = fronts[1u];
                fronts[1u] = (_e530 + _e527);
            }
            let _e533 = front_front;
            let _e534 = !(_e533);
            phi_1090_ = _e534;
            if _e534 {
                let _e536 = next.front;
                let _e538 = here.front;
                let _e541 = here.split;
                phi_1090_ = ((_e536 < _e538) || _e541);
            }
            let _e544 = phi_1090_;
            let _e545 = front_back;
            let _e548 = a;
            let _e551 = a;
            if (((_e544 && !(_e545)) && (_e548 <= 0f)) && (_e551 > -1f)) {
                let _e554 = a;
                param_34 = -(_e554);
                let _e556 = right_of((&param_34));
                let _e557 = here_mask;
                param_35 = _e557;
                param_36 = _e556;
                let _e558 = covered((&param_35), (&param_36));
                let _e559 = (*seen_1);
                param_37 = _e559;
                param_38 = _e558;
                let _e560 = (*x_1);
                param_39 = _e560;
                let _e562 = here.front;
                param_40 = _e562;
                let _e563 = cover((&param_37), (&param_38), (&param_39), (&param_40));
                let _e564 = param_37;
                (*seen_1) = _e564;
                let _e566 = fronts[0u];
                fronts[0u] = (_e566 + _e563);
            }
            let _e569 = front_back;
            let _e570 = a;
            let _e573 = d;
            let _e575 = ((_e569 && (_e570 <= 0f)) && (_e573 > 0f));
            phi_1136_ = _e575;
            if _e575 {
                let _e577 = (*seen_1).rest;
                phi_1136_ = (_e577 > 0.01f);
            }
            let _e580 = phi_1136_;
            if _e580 {
                let _e581 = a;
                let _e583 = d;
                let _e584 = a;
                g_1 = (-(_e581) / (_e583 - _e584));
                let _e587 = (*x_1);
                let _e588 = g_1;
                let _e590 = (*seen_1);
                param_41 = _e590;
                param_42 = 1f;
                param_43 = (_e587 + _e588);
                let _e592 = here.front;
                param_44 = _e592;
                let _e593 = cover((&param_41), (&param_42), (&param_43), (&param_44));
                let _e594 = param_41;
                (*seen_1) = _e594;
                taken_1 = _e593;
                let _e595 = taken_1;
                let _e596 = g_1;
                let _e600 = fronts[0u];
                fronts[0u] = (_e600 + (_e595 * (1f - _e596)));
                let _e603 = taken_1;
                let _e604 = g_1;
                let _e607 = backs[1u];
                backs[1u] = (_e607 + (_e603 * _e604));
            }
            let _e610 = back_front;
            let _e611 = c;
            let _e614 = b;
            let _e616 = ((_e610 && (_e611 <= 0f)) && (_e614 > 0f));
            phi_1186_ = _e616;
            if _e616 {
                let _e618 = (*seen_1).rest;
                phi_1186_ = (_e618 > 0.01f);
            }
            let _e621 = phi_1186_;
            if _e621 {
                let _e622 = c;
                let _e624 = b;
                let _e625 = c;
                g_2 = (-(_e622) / (_e624 - _e625));
                let _e628 = (*x_1);
                let _e629 = g_2;
                let _e631 = (*seen_1);
                param_45 = _e631;
                param_46 = 1f;
                param_47 = (_e628 + _e629);
                let _e633 = next.front;
                param_48 = _e633;
                let _e634 = cover((&param_45), (&param_46), (&param_47), (&param_48));
                let _e635 = param_45;
                (*seen_1) = _e635;
                taken_2 = _e634;
                let _e636 = taken_2;
                let _e637 = g_2;
                let _e641 = backs[0u];
                backs[0u] = (_e641 + (_e636 * (1f - _e637)));
                let _e644 = taken_2;
                let _e645 = g_2;
                let _e648 = fronts[1u];
                fronts[1u] = (_e648 + (_e644 * _e645));
            }
            let _e651 = back_back;
            let _e652 = c;
            let _e655 = d;
            let _e657 = ((_e651 && (_e652 <= 0f)) && (_e655 > 0f));
            phi_1236_ = _e657;
            if _e657 {
                let _e659 = (*seen_1).rest;
                phi_1236_ = (_e659 > 0.01f);
            }
            let _e662 = phi_1236_;
            if _e662 {
                let _e663 = c;
                let _e665 = d;
                let _e666 = c;
                g_3 = (-(_e663) / (_e665 - _e666));
                let _e669 = (*x_1);
                let _e670 = g_3;
                let _e672 = (*seen_1);
                param_49 = _e672;
                param_50 = 1f;
                param_51 = (_e669 + _e670);
                let _e674 = here.back;
                param_52 = _e674;
                let _e675 = cover((&param_49), (&param_50), (&param_51), (&param_52));
                let _e676 = param_49;
                (*seen_1) = _e676;
                taken_3 = _e675;
                let _e677 = taken_3;
                let _e678 = g_3;
                let _e680 = g_3;
                let _e683 = backs;
                backs = (_e683 + (vec2<f32>((1f - _e678), _e680) * _e677));
            }
            let _e686 = here.split;
            let _e687 = back_front;
            let _e690 = back_back;
            ends = ((_e686 && !(_e687)) && !(_e690));
            let _e693 = ends;
            let _e694 = on_front;
            let _e697 = on_back;
            let _e699 = ((_e693 && !(_e694)) && !(_e697));
            phi_1288_ = _e699;
            if _e699 {
                let _e700 = c;
                phi_1288_ = (abs(_e700) < 1f);
            }
            let _e704 = phi_1288_;
            phi_1294_ = _e704;
            if _e704 {
                let _e706 = (*seen_1).rest;
                phi_1294_ = (_e706 > 0.01f);
            }
            let _e709 = phi_1294_;
            if _e709 {
                let _e710 = c;
                if (_e710 <= 0f) {
                    let _e712 = c;
                    param_53 = -(_e712);
                    let _e714 = right_of((&param_53));
                    local_9 = _e714;
                } else {
                    let _e715 = c;
                    param_54 = (1f - _e715);
                    let _e717 = right_of((&param_54));
                    local_9 = (vec4(1f) - _e717);
                }
                let _e720 = local_9;
                stripes_1 = _e720;
                let _e721 = here_mask;
                param_55 = (vec4(1f) - _e721);
                let _e724 = stripes_1;
                param_56 = _e724;
                let _e725 = covered((&param_55), (&param_56));
                let _e726 = (*seen_1);
                param_57 = _e726;
                param_58 = _e725;
                let _e727 = (*x_1);
                param_59 = _e727;
                let _e729 = here.back;
                param_60 = _e729;
                let _e730 = cover((&param_57), (&param_58), (&param_59), (&param_60));
                let _e731 = param_57;
                (*seen_1) = _e731;
                let _e733 = backs[0u];
                backs[0u] = (_e733 + _e730);
            }
            let _e736 = ends;
            phi_1345_ = _e736;
            if _e736 {
                let _e738 = next.front;
                let _e740 = here.back;
                phi_1345_ = (_e738 > _e740);
            }
            let _e743 = phi_1345_;
            let _e744 = c;
            at_back = (_e743 && (_e744 <= 0f));
            let _e748 = here.split;
            let _e750 = front_front;
            let _e753 = front_back;
            let _e755 = ((!(_e748) && !(_e750)) && !(_e753));
            phi_1366_ = _e755;
            if _e755 {
                let _e757 = next.front;
                let _e759 = here.front;
                phi_1366_ = (_e757 > _e759);
            }
            let _e762 = phi_1366_;
            let _e763 = a;
            at_front = (_e762 && (_e763 <= 0f));
            let _e766 = at_back;
            let _e767 = at_front;
            let _e768 = (_e766 || _e767);
            phi_1378_ = _e768;
            if _e768 {
                let _e770 = (*seen_1).rest;
                phi_1378_ = (_e770 > 0.01f);
            }
            let _e773 = phi_1378_;
            if _e773 {
                let _e774 = at_back;
                if _e774 {
                    let _e776 = here.back;
                    local_10 = _e776;
                } else {
                    let _e778 = here.front;
                    local_10 = _e778;
                }
                let _e779 = local_10;
                reach_2 = _e779;
                let _e780 = at_back;
                if _e780 {
                    let _e781 = c;
                    local_11 = -(_e781);
                } else {
                    let _e783 = a;
                    local_11 = -(_e783);
                }
                let _e785 = local_11;
                away = _e785;
                let _e786 = at_back;
                let _e787 = on_front;
                if (_e786 && !(_e787)) {
                    let _e790 = here_mask;
                    param_61 = _e790;
                    param_62 = vec4<f32>(1f, 1f, 1f, 1f);
                    let _e791 = covered((&param_61), (&param_62));
                    local_12 = (1f - _e791);
                } else {
                    local_12 = 1f;
                }
                let _e793 = local_12;
                weight = _e793;
                let _e794 = (*column_5);
                let _e795 = at_back;
                let _e796 = reach_2;
                let _e797 = weight;
                found = Edge(_e794, _e795, _e796, _e797);
                let _e799 = weight;
                let _e801 = away;
                if ((_e799 == 1f) && (_e801 < 0.5f)) {
                    let _e804 = (*seen_1);
                    param_63 = _e804;
                    param_64 = 1f;
                    let _e805 = (*x_1);
                    param_65 = _e805;
                    let _e806 = reach_2;
                    param_66 = _e806;
                    let _e807 = cover((&param_63), (&param_64), (&param_65), (&param_66));
                    let _e808 = param_63;
                    (*seen_1) = _e808;
                    taken_4 = _e807;
                    let _e809 = at_back;
                    let _e810 = taken_4;
                    let _e813 = backs[0u];
                    backs[0u] = (_e813 + select(0f, _e810, _e809));
                    let _e816 = at_back;
                    let _e817 = taken_4;
                    let _e820 = fronts[0u];
                    fronts[0u] = (_e820 + select(_e817, 0f, _e816));
                }
                let _e823 = reach_2;
                let _e825 = edge.reach;
                if (_e823 < _e825) {
                    let _e827 = weight;
                    if (_e827 < 1f) {
                        let _e829 = edge;
                        second = _e829;
                    }
                    let _e830 = found;
                    edge = _e830;
                } else {
                    let _e831 = reach_2;
                    let _e833 = second.reach;
                    if (_e831 < _e833) {
                        let _e835 = found;
                        second = _e835;
                    }
                }
            }
            let _e837 = fronts[0u];
            let _e839 = backs[0u];
            if (max(_e837, _e839) > 0f) {
                let _e842 = (*column_5);
                param_67 = _e842;
                let _e843 = (*row_4);
                param_68 = _e843;
                let _e845 = fronts[0u];
                param_69 = _e845;
                let _e847 = backs[0u];
                param_70 = _e847;
                let _e848 = weighted((&param_67), (&param_68), (&param_69), (&param_70));
                let _e849 = color_sum;
                color_sum = (_e849 + _e848);
            }
            let _e852 = fronts[1u];
            let _e854 = backs[1u];
            if (max(_e852, _e854) > 0f) {
                let _e857 = (*column_5);
                let _e858 = sense;
                param_71 = (_e857 + _e858);
                let _e860 = (*row_4);
                param_72 = _e860;
                let _e862 = fronts[1u];
                param_73 = _e862;
                let _e864 = backs[1u];
                param_74 = _e864;
                let _e865 = weighted((&param_71), (&param_72), (&param_73), (&param_74));
                let _e866 = color_sum;
                color_sum = (_e866 + _e865);
            }
            let _e868 = front_back;
            on_front = _e868;
            let _e869 = back_back;
            on_back = _e869;
            let _e870 = next;
            here = _e870;
            let _e871 = sense;
            let _e872 = (*column_5);
            (*column_5) = (_e872 + _e871);
            let _e874 = (*x_1);
            (*x_1) = (_e874 + 1f);
            continue;
        } else {
            break;
        }
    }
    let _e877 = (*seen_1).rest;
    (*seen_1).hole = (_e877 > 0.5f);
    let _e881 = (*seen_1).rest;
    if (_e881 > 0.01f) {
        let _e884 = edge.column;
        beyond = (_e884 < 0i);
        let _e886 = beyond;
        if _e886 {
            let _e887 = (*column_5);
            let _e889 = here.split;
            let _e891 = here.split;
            if _e891 {
                let _e893 = here.back;
                local_13 = _e893;
            } else {
                let _e895 = here.front;
                local_13 = _e895;
            }
            let _e896 = local_13;
            edge = Edge(_e887, _e889, _e896, 1f);
        }
        let _e899 = edge.column;
        param_75 = _e899;
        let _e900 = source_column((&param_75));
        edge_x = f32(_e900);
        let _e902 = (*t);
        let _e903 = edge_x;
        let _e906 = edge.reach;
        away_1 = abs(((_e902 - _e903) - _e906));
        let _e909 = away_1;
        spread = (0.5f * clamp(_e909, 1f, 12f));
        sum = vec4<f32>(0f, 0f, 0f, 0f);
        weights = 0f;
        let _e912 = beyond;
        let _e913 = away_1;
        rows = select(2i, 0i, (_e912 && (_e913 < 0.5f)));
        let _e917 = rows;
        i = -(_e917);
        loop {
            let _e919 = i;
            let _e920 = rows;
            if (_e919 <= _e920) {
                let _e922 = (*row_4);
                let _e923 = i;
                let _e925 = spread;
                let _e932 = synthesis.source_size[1u];
                at = clamp((_e922 + i32(round((f32(_e923) * _e925)))), 0i, (_e932 - 1i));
                let _e936 = edge.column;
                param_76 = _e936;
                let _e937 = at;
                param_77 = _e937;
                let _e938 = layer_at((&param_76), (&param_77));
                layer_4 = _e938;
                let _e939 = i;
                if (_e939 == 0i) {
                    let _e942 = edge.back;
                    local_14 = !(_e942);
                } else {
                    let _e945 = layer_4.front;
                    let _e947 = edge.reach;
                    local_14 = (_e945 <= (_e947 + 1f));
                }
                let _e950 = local_14;
                front_1 = _e950;
                let _e951 = i;
                if (_e951 == 0i) {
                    let _e954 = edge.back;
                    local_15 = _e954;
                } else {
                    let _e955 = front_1;
                    let _e958 = layer_4.split;
                    let _e959 = (!(_e955) && _e958);
                    phi_1655_ = _e959;
                    if _e959 {
                        let _e961 = layer_4.back;
                        let _e963 = edge.reach;
                        phi_1655_ = (_e961 <= (_e963 + 1f));
                    }
                    let _e967 = phi_1655_;
                    local_15 = _e967;
                }
                let _e968 = local_15;
                behind_1 = _e968;
                let _e969 = i;
                if (_e969 == 0i) {
                    local_16 = 2f;
                } else {
                    let _e971 = front_1;
                    if _e971 {
                        local_17 = 1f;
                    } else {
                        let _e972 = behind_1;
                        if _e972 {
                            let _e973 = layer_4;
                            param_78 = _e973;
                            let _e975 = edge.column;
                            param_79 = _e975;
                            let _e976 = at;
                            param_80 = _e976;
                            let _e977 = mask_of((&param_78), (&param_79), (&param_80));
                            param_81 = _e977;
                            param_82 = vec4<f32>(1f, 1f, 1f, 1f);
                            let _e978 = covered((&param_81), (&param_82));
                            local_18 = (1f - _e978);
                        } else {
                            local_18 = 0f;
                        }
                        let _e980 = local_18;
                        local_17 = _e980;
                    }
                    let _e981 = local_17;
                    local_16 = _e981;
                }
                let _e982 = local_16;
                weight_1 = _e982;
                let _e983 = front_1;
                let _e984 = weight_1;
                let _e986 = front_1;
                let _e987 = weight_1;
                let _e990 = edge.column;
                param_83 = _e990;
                let _e991 = at;
                param_84 = _e991;
                param_85 = select(0f, _e984, _e983);
                param_86 = select(_e987, 0f, _e986);
                let _e992 = weighted((&param_83), (&param_84), (&param_85), (&param_86));
                let _e993 = sum;
                sum = (_e993 + _e992);
                let _e995 = weight_1;
                let _e996 = weights;
                weights = (_e996 + _e995);
                continue;
            } else {
                break;
            }
            continuing {
                let _e998 = i;
                i = (_e998 + 1i);
            }
        }
        let _e1000 = sum;
        let _e1001 = weights;
        fill = (_e1000 / vec4(_e1001));
        let _e1005 = second.column;
        let _e1006 = (_e1005 >= 0i);
        phi_1723_ = _e1006;
        if _e1006 {
            let _e1008 = edge.weight;
            phi_1723_ = (_e1008 < 1f);
        }
        let _e1011 = phi_1723_;
        if _e1011 {
            let _e1013 = second.back;
            one = select(vec2<f32>(1f, 0f), vec2<f32>(0f, 1f), vec2(_e1013));
            let _e1017 = second.column;
            param_87 = _e1017;
            let _e1018 = (*row_4);
            param_88 = _e1018;
            let _e1020 = one[0u];
            param_89 = _e1020;
            let _e1022 = one[1u];
            param_90 = _e1022;
            let _e1023 = weighted((&param_87), (&param_88), (&param_89), (&param_90));
            let _e1024 = fill;
            let _e1026 = edge.weight;
            fill = mix(_e1023, _e1024, vec4(_e1026));
        }
        let _e1030 = (*seen_1).hole;
        let _e1031 = away_1;
        (*seen_1).hole = (_e1030 && (_e1031 >= 0.5f));
        let _e1035 = (*seen_1);
        param_91 = _e1035;
        param_92 = 1f;
        let _e1036 = edge_x;
        param_93 = _e1036;
        let _e1038 = edge.reach;
        param_94 = _e1038;
        let _e1039 = cover((&param_91), (&param_92), (&param_93), (&param_94));
        let _e1040 = param_91;
        (*seen_1) = _e1040;
        let _e1041 = fill;
        let _e1043 = color_sum;
        color_sum = (_e1043 + (_e1041 * _e1039));
    }
    let _e1045 = color_sum;
    return _e1045;
}

fn color_texel(x_2: ptr<function, i32>, row_5: ptr<function, i32>) -> vec4<f32> {
    var param_95: i32;
    var param_96: vec2<i32>;

    let _e6 = (*x_2);
    param_95 = _e6;
    let _e7 = source_column((&param_95));
    let _e8 = (*row_5);
    param_96 = vec2<i32>(_e7, _e8);
    let _e10 = in_image((&param_96));
    let _e11 = textureLoad(color_map_texture, _e10, 0i);
    return _e11;
}

fn sharp_color_at(x_3: ptr<function, f32>, row_6: ptr<function, i32>) -> vec4<f32> {
    var last: i32;
    var column_6: i32;
    var f: f32;
    var here_1: vec4<f32>;
    var param_97: i32;
    var param_98: i32;
    var next_1: vec4<f32>;
    var param_99: i32;
    var param_100: i32;
    var apart: vec4<f32>;
    var outer: vec2<f32>;
    var inner: f32;
    var sum_1: vec4<f32>;
    var param_101: i32;
    var param_102: i32;
    var param_103: i32;
    var param_104: i32;

    let _e33 = synthesis.source_size[0u];
    last = (_e33 - 1i);
    let _e35 = (*x_3);
    column_6 = i32(_e35);
    let _e37 = (*x_3);
    let _e38 = column_6;
    f = (_e37 - f32(_e38));
    let _e41 = column_6;
    param_97 = _e41;
    let _e42 = (*row_6);
    param_98 = _e42;
    let _e43 = color_texel((&param_97), (&param_98));
    here_1 = _e43;
    let _e44 = column_6;
    let _e46 = last;
    param_99 = min((_e44 + 1i), _e46);
    let _e48 = (*row_6);
    param_100 = _e48;
    let _e49 = color_texel((&param_99), (&param_100));
    next_1 = _e49;
    let _e50 = next_1;
    let _e51 = here_1;
    apart = abs((_e50 - _e51));
    let _e55 = apart[0u];
    let _e57 = apart[1u];
    let _e59 = apart[2u];
    if (max(_e55, max(_e57, _e59)) <= 0.03137255f) {
        let _e63 = here_1;
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
    let _e88 = column_6;
    param_101 = max((_e88 - 1i), 0i);
    let _e91 = (*row_6);
    param_102 = _e91;
    let _e92 = color_texel((&param_101), (&param_102));
    let _e95 = outer[1u];
    let _e96 = column_6;
    let _e98 = last;
    param_103 = min((_e96 + 2i), _e98);
    let _e100 = (*row_6);
    param_104 = _e100;
    let _e101 = color_texel((&param_103), (&param_104));
    let _e104 = inner;
    let _e105 = here_1;
    let _e108 = inner;
    let _e111 = outer[0u];
    let _e114 = outer[1u];
    let _e116 = next_1;
    sum_1 = ((((_e92 * _e87) + (_e101 * _e95)) + (_e105 * _e104)) + (_e116 * (((1f - _e108) - _e111) - _e114)));
    let _e119 = sum_1;
    let _e120 = here_1;
    let _e121 = next_1;
    let _e123 = here_1;
    let _e124 = next_1;
    return clamp(_e119, min(_e120, _e121), max(_e123, _e124));
}

fn span_steps(span: ptr<function, u32>) -> f32 {
    var steps: u32;
    var local_19: f32;

    let _e5 = (*span);
    steps = (_e5 & 1023u);
    let _e7 = steps;
    if (_e7 == 1023u) {
        local_19 = 1000000000f;
    } else {
        let _e9 = steps;
        local_19 = f32(_e9);
    }
    let _e11 = local_19;
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
    var row_7: i32;
    var t_1: f32;
    var span_1: u32;
    var x_4: f32;
    var limit_1: f32;
    var param_105: u32;
    var sense_1: i32;
    var column_7: i32;
    var param_106: i32;
    var seen_2: Seen;
    var bits_1: u32;
    var param_107: i32;
    var param_108: i32;
    var front_2: f32;
    var param_109: u32;
    var at_1: f32;
    var plain: bool;
    var param_110: u32;
    var param_111: i32;
    var param_112: i32;
    var following: f32;
    var param_113: u32;
    var param_114: u32;
    var then: f32;
    var g_4: f32;
    var param_115: Seen;
    var param_116: f32;
    var param_117: f32;
    var param_118: f32;
    var param_119: f32;
    var param_120: i32;
    var param_121: i32;
    var param_122: f32;
    var param_123: f32;
    var param_124: f32;
    var param_125: i32;
    var param_126: Seen;
    var phi_1898_: bool;

    let _e54 = synthesis.source_size[0u];
    last_2 = f32((_e54 - 1i));
    let _e58 = gl_FragCoord_1[1u];
    let _e60 = synthesis.first_row;
    let _e64 = synthesis.source_size[1u];
    row_7 = i32(clamp((_e58 - _e60), 0f, f32((_e64 - 1i))));
    let _e71 = synthesis.origins[0u];
    let _e73 = gl_FragCoord_1[0u];
    let _e77 = synthesis.origins[1u];
    let _e80 = synthesis.farthest;
    t_1 = ((((_e71 * _e73) + _e77) - _e80) + 0.01f);
    let _e83 = pixel_span();
    span_1 = _e83.x;
    let _e85 = t_1;
    let _e86 = span_1;
    let _e91 = last_2;
    x_4 = clamp(floor(((_e85 - bitcast<f32>(_e86)) - 1.01f)), 0f, _e91);
    let _e93 = x_4;
    let _e94 = span_1;
    param_105 = _e94;
    let _e95 = span_steps((&param_105));
    let _e98 = last_2;
    limit_1 = min(((_e93 + _e95) + 2f), _e98);
    let _e101 = synthesis.mirrored;
    sense_1 = select(1i, -1i, (_e101 != 0u));
    let _e104 = x_4;
    param_106 = i32(_e104);
    let _e106 = source_column((&param_106));
    column_7 = _e106;
    seen_2 = Seen(1f, 0f, 0f, false);
    let _e107 = column_7;
    param_107 = _e107;
    let _e108 = row_7;
    param_108 = _e108;
    let _e109 = layer_bits((&param_107), (&param_108));
    bits_1 = _e109;
    let _e110 = bits_1;
    param_109 = _e110;
    let _e111 = full_front((&param_109));
    front_2 = _e111;
    let _e112 = x_4;
    let _e113 = front_2;
    let _e115 = t_1;
    at_1 = ((_e112 + _e113) - _e115);
    let _e117 = bits_1;
    param_110 = _e117;
    let _e118 = is_full((&param_110));
    let _e119 = at_1;
    plain = (_e118 && (_e119 <= 0f));
    loop {
        let _e122 = plain;
        let _e123 = x_4;
        let _e124 = limit_1;
        if (_e122 && (_e123 < _e124)) {
            let _e127 = column_7;
            let _e128 = sense_1;
            param_111 = (_e127 + _e128);
            let _e130 = row_7;
            param_112 = _e130;
            let _e131 = layer_bits((&param_111), (&param_112));
            bits_1 = _e131;
            let _e132 = bits_1;
            param_113 = _e132;
            let _e133 = full_front((&param_113));
            following = _e133;
            let _e134 = bits_1;
            param_114 = _e134;
            let _e135 = is_full((&param_114));
            phi_1898_ = _e135;
            if _e135 {
                let _e136 = following;
                let _e137 = front_2;
                phi_1898_ = (abs((_e136 - _e137)) < 0.5f);
            }
            let _e142 = phi_1898_;
            plain = _e142;
            let _e143 = x_4;
            let _e145 = following;
            let _e147 = t_1;
            then = (((_e143 + 1f) + _e145) - _e147);
            let _e149 = plain;
            let _e150 = then;
            if (_e149 && (_e150 > 0f)) {
                let _e153 = at_1;
                let _e155 = then;
                let _e156 = at_1;
                g_4 = (-(_e153) / (_e155 - _e156));
                let _e159 = x_4;
                let _e160 = g_4;
                let _e162 = front_2;
                let _e163 = following;
                let _e164 = g_4;
                let _e166 = seen_2;
                param_115 = _e166;
                param_116 = 1f;
                param_117 = (_e159 + _e160);
                param_118 = mix(_e162, _e163, _e164);
                let _e167 = cover((&param_115), (&param_116), (&param_117), (&param_118));
                let _e168 = param_115;
                seen_2 = _e168;
                let _e169 = x_4;
                limit_1 = _e169;
            } else {
                let _e170 = plain;
                if _e170 {
                    let _e171 = x_4;
                    x_4 = (_e171 + 1f);
                    let _e173 = sense_1;
                    let _e174 = column_7;
                    column_7 = (_e174 + _e173);
                    let _e176 = following;
                    front_2 = _e176;
                    let _e177 = then;
                    at_1 = _e177;
                }
            }
            continue;
        } else {
            break;
        }
    }
    let _e179 = seen_2.rest;
    if (_e179 < 0.01f) {
        let _e182 = seen_2.column;
        param_119 = _e182;
        let _e183 = row_7;
        param_120 = _e183;
        let _e184 = sharp_color_at((&param_119), (&param_120));
        color = _e184;
    } else {
        let _e185 = row_7;
        param_121 = _e185;
        let _e186 = t_1;
        param_122 = _e186;
        let _e187 = x_4;
        param_123 = _e187;
        let _e188 = limit_1;
        param_124 = _e188;
        let _e189 = column_7;
        param_125 = _e189;
        let _e190 = seen_2;
        param_126 = _e190;
        let _e191 = composed((&param_121), (&param_122), (&param_123), (&param_124), (&param_125), (&param_126));
        let _e192 = param_126;
        seen_2 = _e192;
        color = _e191;
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
