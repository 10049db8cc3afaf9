// Made of yoro's GLSL by `cargo xtask maintain renew`.
struct Segment {
    steep: bool,
    sense: f32,
    far: f32,
    far_beside: f32,
    slope: f32,
    law: f32,
}

struct Sample {
    index: f32,
    beside: f32,
    depth: f32,
}

struct Edge {
    line: Segment,
    at: Sample,
}

struct AnyView {
    source_size: vec2<i32>,
    target_origin: vec2<i32>,
    to_source_x: vec4<f32>,
    to_source_y: vec4<f32>,
    to_source_w: vec4<f32>,
    source_law: vec2<f32>,
    target_law: vec2<f32>,
    nearest: f32,
    far_depth: f32,
    source_origin: vec2<i32>,
    texel: vec2<f32>,
}

struct FragmentOutput {
    @location(0) member: vec4<f32>,
    @builtin(frag_depth) member_1: f32,
}

@group(0) @binding(4) 
var<uniform> synthesis: AnyView;
@group(0) @binding(0) 
var depth_map_texture: texture_2d<f32>;
@group(0) @binding(1) 
var color_map_texture: texture_2d<f32>;
@group(0) @binding(6) 
var linear_sampler: sampler;
@group(0) @binding(2) 
var tile_map_texture: texture_2d<u32>;
var<private> gl_FragCoord_1: vec4<f32>;
@group(0) @binding(3) 
var span_map_texture: texture_2d<u32>;
var<private> color_1: vec4<f32>;
var<private> gl_FragDepth: f32 = 0f;

fn target_depth(depth: ptr<function, f32>, scale: ptr<function, f32>) -> f32 {
    var inverse: f32;
    var seen: f32;

    let _e12 = synthesis.source_law[0u];
    let _e15 = synthesis.source_law[1u];
    let _e16 = (*depth);
    inverse = (_e12 + (_e15 * _e16));
    let _e19 = inverse;
    let _e20 = (*scale);
    let _e22 = inverse;
    let _e25 = synthesis.to_source_w[3u];
    seen = ((_e19 * _e20) / (1f - (_e22 * _e25)));
    let _e29 = seen;
    let _e32 = synthesis.target_law[0u];
    let _e36 = synthesis.target_law[1u];
    return clamp(((_e29 - _e32) / _e36), 0f, 1f);
}

fn color_sample(place: ptr<function, vec2<f32>>) -> vec4<f32> {
    let _e4 = (*place);
    let _e5 = textureSampleLevel(color_map_texture, linear_sampler, _e4, 0f);
    return _e5;
}

fn color_of(line: ptr<function, Segment>, at: ptr<function, Sample>) -> vec4<f32> {
    var index: vec2<f32>;
    var local: vec2<f32>;
    var param: vec2<f32>;

    let _e8 = (*line).steep;
    if _e8 {
        let _e10 = (*at).beside;
        let _e12 = (*at).index;
        local = vec2<f32>(_e10, _e12);
    } else {
        let _e15 = (*at).index;
        let _e17 = (*at).beside;
        local = vec2<f32>(_e15, _e17);
    }
    let _e19 = local;
    index = _e19;
    let _e21 = synthesis.source_origin;
    let _e23 = index;
    let _e28 = synthesis.texel;
    param = (((vec2<f32>(_e21) + _e23) + vec2(0.5f)) * _e28);
    let _e30 = color_sample((&param));
    return _e30;
}

fn nearest_of(texel: ptr<function, vec4<f32>>) -> f32 {
    let _e3 = (*texel)[0u];
    return _e3;
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

fn depth_texel(column: ptr<function, i32>, row: ptr<function, i32>) -> f32 {
    var param_1: vec2<i32>;
    var param_2: vec4<f32>;

    let _e6 = (*column);
    let _e7 = (*row);
    param_1 = vec2<i32>(_e6, _e7);
    let _e9 = in_image((&param_1));
    let _e10 = textureLoad(depth_map_texture, _e9, 0i);
    param_2 = _e10;
    let _e11 = nearest_of((&param_2));
    return _e11;
}

fn pixel_of(line_1: ptr<function, Segment>, index_1: ptr<function, f32>, beside: ptr<function, f32>) -> vec2<i32> {
    var local_2: vec2<f32>;

    let _e5 = (*line_1).steep;
    if _e5 {
        let _e6 = (*beside);
        let _e7 = (*index_1);
        local_2 = vec2<f32>(_e6, _e7);
    } else {
        let _e9 = (*index_1);
        let _e10 = (*beside);
        local_2 = vec2<f32>(_e9, _e10);
    }
    let _e12 = local_2;
    return vec2<i32>(_e12);
}

fn depth_of(line_2: ptr<function, Segment>, index_2: ptr<function, f32>, beside_1: ptr<function, f32>) -> f32 {
    var pixel_1: vec2<i32>;
    var param_3: Segment;
    var param_4: f32;
    var param_5: f32;
    var param_6: i32;
    var param_7: i32;

    let _e11 = (*line_2);
    param_3 = _e11;
    let _e12 = (*index_2);
    param_4 = _e12;
    let _e13 = (*beside_1);
    param_5 = _e13;
    let _e14 = pixel_of((&param_3), (&param_4), (&param_5));
    pixel_1 = _e14;
    let _e16 = pixel_1[0u];
    param_6 = _e16;
    let _e18 = pixel_1[1u];
    param_7 = _e18;
    let _e19 = depth_texel((&param_6), (&param_7));
    return _e19;
}

fn last_indices(line_3: ptr<function, Segment>) -> vec2<f32> {
    var last: vec2<f32>;
    var local_3: vec2<f32>;

    let _e6 = synthesis.source_size;
    last = vec2<f32>((_e6 - vec2(1i)));
    let _e11 = (*line_3).steep;
    if _e11 {
        let _e12 = last;
        local_3 = _e12.yx;
    } else {
        let _e14 = last;
        local_3 = _e14;
    }
    let _e15 = local_3;
    return _e15;
}

fn tap_beside(edge: ptr<function, Edge>, distance_: ptr<function, f32>, nearer: ptr<function, f32>) -> vec4<f32> {
    var beside_2: f32;
    var param_8: Segment;
    var tap: Sample;
    var param_9: Segment;
    var param_10: f32;
    var param_11: f32;
    var param_12: Segment;
    var param_13: Sample;

    let _e15 = (*edge).at.beside;
    let _e18 = (*distance_);
    let _e21 = (*edge).line;
    param_8 = _e21;
    let _e22 = last_indices((&param_8));
    beside_2 = clamp((floor((_e15 + 0.5f)) + _e18), 0f, _e22.y);
    let _e27 = (*edge).at.index;
    let _e28 = beside_2;
    let _e30 = (*edge).line;
    param_9 = _e30;
    let _e33 = (*edge).at.index;
    param_10 = _e33;
    let _e34 = beside_2;
    param_11 = _e34;
    let _e35 = depth_of((&param_9), (&param_10), (&param_11));
    tap = Sample(_e27, _e28, _e35);
    let _e39 = (*edge).line.law;
    let _e41 = tap.depth;
    let _e44 = (*edge).at.depth;
    (*nearer) = (_e39 * (_e41 - _e44));
    let _e48 = (*edge).line;
    param_12 = _e48;
    let _e49 = tap;
    param_13 = _e49;
    let _e50 = color_of((&param_12), (&param_13));
    return _e50;
}

fn fill_hole(edge_1: ptr<function, Edge>, color: ptr<function, vec4<f32>>, away: ptr<function, f32>) -> vec4<f32> {
    var spread: f32;
    var sum: vec4<f32>;
    var weights: f32;
    var i: i32;
    var distance_1: f32;
    var below: vec4<f32>;
    var nearer_1: vec2<f32>;
    var param_14: Edge;
    var param_15: f32;
    var param_16: f32;
    var above: vec4<f32>;
    var param_17: Edge;
    var param_18: f32;
    var param_19: f32;
    var weight: vec2<f32>;

    let _e28 = (*away);
    spread = (0.5f * clamp(abs(_e28), 1f, 12f));
    let _e32 = (*color);
    sum = (_e32 * 2f);
    weights = 2f;
    i = 1i;
    loop {
        let _e34 = i;
        if (_e34 <= 2i) {
            let _e36 = i;
            let _e38 = spread;
            distance_1 = round((f32(_e36) * _e38));
            let _e41 = distance_1;
            let _e43 = (*edge_1);
            param_14 = _e43;
            param_15 = -(_e41);
            let _e44 = tap_beside((&param_14), (&param_15), (&param_16));
            let _e45 = param_16;
            nearer_1[0u] = _e45;
            below = _e44;
            let _e47 = (*edge_1);
            param_17 = _e47;
            let _e48 = distance_1;
            param_18 = _e48;
            let _e49 = tap_beside((&param_17), (&param_18), (&param_19));
            let _e50 = param_19;
            nearer_1[1u] = _e50;
            above = _e49;
            let _e52 = nearer_1;
            weight = select(vec2<f32>(0f, 0f), vec2<f32>(1f, 1f), (_e52 <= vec2<f32>(1f, 1f)));
            let _e56 = weight[0u];
            let _e57 = below;
            let _e60 = weight[1u];
            let _e61 = above;
            let _e64 = sum;
            sum = (_e64 + ((_e57 * _e56) + (_e61 * _e60)));
            let _e67 = weight[0u];
            let _e69 = weight[1u];
            let _e71 = weights;
            weights = (_e71 + (_e67 + _e69));
            continue;
        } else {
            break;
        }
        continuing {
            let _e73 = i;
            i = (_e73 + 1i);
        }
    }
    let _e75 = sum;
    let _e76 = weights;
    return (_e75 / vec4(_e76));
}

fn is_torn(a: ptr<function, f32>, b: ptr<function, f32>) -> bool {
    let _e3 = (*b);
    let _e4 = (*a);
    return ((_e3 - _e4) >= 2f);
}

fn jumps(a_1: ptr<function, f32>, b_1: ptr<function, f32>) -> bool {
    let _e3 = (*a_1);
    let _e5 = (*b_1);
    return ((_e3 <= 0f) && (_e5 > 0f));
}

fn folds(a_2: ptr<function, f32>, b_2: ptr<function, f32>) -> bool {
    var phi_173_: bool;

    let _e4 = (*a_2);
    let _e5 = (_e4 <= 0f);
    phi_173_ = _e5;
    if _e5 {
        let _e6 = (*b_2);
        let _e8 = (*a_2);
        phi_173_ = (max(_e6, -1f) < _e8);
    }
    let _e11 = phi_173_;
    return _e11;
}

fn has_rim(a_3: ptr<function, f32>, b_3: ptr<function, f32>) -> bool {
    var param_20: f32;
    var param_21: f32;
    var param_22: f32;
    var param_23: f32;
    var param_24: f32;
    var param_25: f32;
    var phi_196_: bool;
    var phi_201_: bool;

    let _e9 = (*a_3);
    param_20 = _e9;
    let _e10 = (*b_3);
    param_21 = _e10;
    let _e11 = folds((&param_20), (&param_21));
    phi_201_ = _e11;
    if !(_e11) {
        let _e13 = (*a_3);
        param_22 = _e13;
        let _e14 = (*b_3);
        param_23 = _e14;
        let _e15 = jumps((&param_22), (&param_23));
        phi_196_ = _e15;
        if _e15 {
            let _e16 = (*a_3);
            param_24 = _e16;
            let _e17 = (*b_3);
            param_25 = _e17;
            let _e18 = is_torn((&param_24), (&param_25));
            phi_196_ = _e18;
        }
        let _e20 = phi_196_;
        let _e21 = (*b_3);
        phi_201_ = (_e20 && (_e21 < 1f));
    }
    let _e25 = phi_201_;
    return _e25;
}

fn is_seen(a_4: ptr<function, f32>, b_4: ptr<function, f32>) -> bool {
    var param_26: f32;
    var param_27: f32;
    var param_28: f32;
    var param_29: f32;
    var phi_160_: bool;
    var phi_161_: bool;

    let _e7 = (*a_4);
    param_26 = _e7;
    let _e8 = (*b_4);
    param_27 = _e8;
    let _e9 = jumps((&param_26), (&param_27));
    phi_161_ = _e9;
    if _e9 {
        let _e10 = (*a_4);
        let _e11 = (_e10 > -0.5f);
        phi_160_ = _e11;
        if !(_e11) {
            let _e13 = (*a_4);
            param_28 = _e13;
            let _e14 = (*b_4);
            param_29 = _e14;
            let _e15 = is_torn((&param_28), (&param_29));
            phi_160_ = !(_e15);
        }
        let _e18 = phi_160_;
        phi_161_ = _e18;
    }
    let _e20 = phi_161_;
    return _e20;
}

fn landing(line_4: ptr<function, Segment>, index_3: ptr<function, f32>, depth_1: ptr<function, f32>) -> f32 {
    let _e5 = (*line_4).sense;
    let _e6 = (*index_3);
    let _e8 = (*line_4).far;
    let _e12 = (*line_4).law;
    let _e13 = (*depth_1);
    let _e15 = synthesis.far_depth;
    return ((_e5 * (_e6 - _e8)) + (_e12 * (_e13 - _e15)));
}

fn lands(line_5: ptr<function, Segment>, index_4: ptr<function, f32>, beside_3: ptr<function, f32>, steps: ptr<function, f32>) -> bool {
    var bounds: vec2<u32>;
    var param_30: Segment;
    var param_31: f32;
    var param_32: f32;
    var ends: vec2<f32>;
    var param_33: Segment;
    var param_34: f32;
    var param_35: f32;
    var param_36: Segment;
    var param_37: f32;
    var param_38: f32;
    var phi_609_: bool;

    let _e22 = (*beside_3);
    let _e24 = (*line_5);
    param_30 = _e24;
    let _e25 = (*index_4);
    param_31 = _e25;
    param_32 = floor(_e22);
    let _e26 = pixel_of((&param_30), (&param_31), (&param_32));
    let _e28 = textureLoad(tile_map_texture, (_e26 / vec2<i32>(16i, 8i)), 0i);
    bounds = _e28.xy;
    let _e31 = bounds[0u];
    let _e33 = (*line_5);
    param_33 = _e33;
    let _e34 = (*index_4);
    param_34 = _e34;
    param_35 = bitcast<f32>(_e31);
    let _e35 = landing((&param_33), (&param_34), (&param_35));
    let _e37 = bounds[1u];
    let _e39 = (*line_5);
    param_36 = _e39;
    let _e40 = (*index_4);
    param_37 = _e40;
    param_38 = bitcast<f32>(_e37);
    let _e41 = landing((&param_36), (&param_37), (&param_38));
    ends = vec2<f32>(_e35, _e41);
    let _e44 = ends[0u];
    let _e46 = ends[1u];
    let _e48 = (min(_e44, _e46) <= 1f);
    phi_609_ = _e48;
    if _e48 {
        let _e50 = ends[0u];
        let _e52 = ends[1u];
        let _e54 = (*steps);
        phi_609_ = ((max(_e50, _e52) + _e54) >= -1f);
    }
    let _e58 = phi_609_;
    return _e58;
}

fn steps_in_tile(line_6: ptr<function, Segment>, index_5: ptr<function, f32>, beside_4: ptr<function, f32>) -> f32 {
    var tile: vec2<f32>;
    var in_tile: vec2<f32>;
    var along: f32;
    var local_4: f32;
    var drift: f32;
    var room: f32;
    var local_5: f32;
    var local_6: f32;

    let _e18 = (*line_6).steep;
    tile = select(vec2<f32>(16f, 8f), vec2<f32>(8f, 16f), vec2(_e18));
    let _e21 = (*index_5);
    let _e22 = (*beside_4);
    let _e24 = vec2<f32>(_e21, floor(_e22));
    let _e25 = tile;
    in_tile = (_e24 - (floor((_e24 / _e25)) * _e25));
    let _e31 = (*line_6).sense;
    if (_e31 > 0f) {
        let _e34 = tile[0u];
        let _e36 = in_tile[0u];
        local_4 = (_e34 - _e36);
    } else {
        let _e39 = in_tile[0u];
        local_4 = (_e39 + 1f);
    }
    let _e41 = local_4;
    along = _e41;
    let _e43 = (*line_6).sense;
    let _e45 = (*line_6).slope;
    drift = (_e43 * _e45);
    let _e47 = drift;
    if (_e47 > 0f) {
        let _e50 = tile[1u];
        let _e52 = in_tile[1u];
        let _e54 = (*beside_4);
        local_5 = ((_e50 - _e52) - fract(_e54));
    } else {
        let _e58 = in_tile[1u];
        let _e59 = (*beside_4);
        local_5 = (_e58 + fract(_e59));
    }
    let _e62 = local_5;
    room = _e62;
    let _e63 = along;
    let _e64 = drift;
    let _e66 = along;
    let _e68 = room;
    if ((abs(_e64) * _e66) > _e68) {
        let _e70 = room;
        let _e71 = drift;
        local_6 = (floor((_e70 / abs(_e71))) + 1f);
    } else {
        let _e76 = along;
        local_6 = _e76;
    }
    let _e77 = local_6;
    return max(min(_e63, _e77), 1f);
}

fn beside_at(line_7: ptr<function, Segment>, index_6: ptr<function, f32>) -> f32 {
    let _e3 = (*line_7).far_beside;
    let _e5 = (*line_7).slope;
    let _e6 = (*index_6);
    let _e8 = (*line_7).far;
    return (_e3 + (_e5 * (_e6 - _e8)));
}

fn sample_at(line_8: ptr<function, Segment>, index_7: ptr<function, f32>) -> Sample {
    var last_1: f32;
    var param_39: Segment;
    var beside_5: f32;
    var param_40: Segment;
    var param_41: f32;
    var low: f32;
    var here: f32;
    var param_42: Segment;
    var param_43: f32;
    var param_44: f32;
    var next: f32;
    var param_45: Segment;
    var param_46: f32;
    var param_47: f32;
    var t: f32;
    var whole: bool;
    var upper: bool;
    var local_7: f32;
    var local_8: f32;

    let _e24 = (*line_8);
    param_39 = _e24;
    let _e25 = last_indices((&param_39));
    last_1 = _e25.y;
    let _e27 = (*line_8);
    param_40 = _e27;
    let _e28 = (*index_7);
    param_41 = _e28;
    let _e29 = beside_at((&param_40), (&param_41));
    let _e30 = last_1;
    beside_5 = clamp(_e29, 0f, _e30);
    let _e32 = beside_5;
    low = floor(_e32);
    let _e34 = (*line_8);
    param_42 = _e34;
    let _e35 = (*index_7);
    param_43 = _e35;
    let _e36 = low;
    param_44 = _e36;
    let _e37 = depth_of((&param_42), (&param_43), (&param_44));
    here = _e37;
    let _e38 = low;
    let _e40 = last_1;
    let _e42 = (*line_8);
    param_45 = _e42;
    let _e43 = (*index_7);
    param_46 = _e43;
    param_47 = min((_e38 + 1f), _e40);
    let _e44 = depth_of((&param_45), (&param_46), (&param_47));
    next = _e44;
    let _e45 = beside_5;
    let _e46 = low;
    t = (_e45 - _e46);
    let _e49 = (*line_8).law;
    let _e50 = next;
    let _e51 = here;
    whole = (abs((_e49 * (_e50 - _e51))) < 1f);
    let _e56 = t;
    upper = (_e56 >= 0.5f);
    let _e58 = (*index_7);
    let _e59 = whole;
    if _e59 {
        let _e60 = beside_5;
        local_7 = _e60;
    } else {
        let _e61 = low;
        let _e62 = upper;
        local_7 = (_e61 + select(0f, 1f, _e62));
    }
    let _e65 = local_7;
    let _e66 = whole;
    if _e66 {
        let _e67 = here;
        let _e68 = next;
        let _e69 = t;
        local_8 = mix(_e67, _e68, _e69);
    } else {
        let _e71 = upper;
        let _e72 = next;
        let _e73 = here;
        local_8 = select(_e73, _e72, _e71);
    }
    let _e75 = local_8;
    return Sample(_e58, _e65, _e75);
}

fn main_1() {
    var pixel_2: vec3<f32>;
    var ray: vec3<f32>;
    var infinity: vec2<f32>;
    var parallax: vec2<f32>;
    var far: vec2<f32>;
    var moved: vec2<f32>;
    var line_9: Segment;
    var reach: f32;
    var local_9: f32;
    var tile_1: vec2<i32>;
    var last_2: vec2<f32>;
    var param_48: Segment;
    var middle: f32;
    var first: f32;
    var end: f32;
    var left: f32;
    var index_8: f32;
    var depth_2: f32;
    var param_49: Segment;
    var param_50: f32;
    var b_5: f32;
    var param_51: Segment;
    var param_52: f32;
    var param_53: f32;
    var a_5: f32;
    var found: bool;
    var outside: bool;
    var local_10: f32;
    var edge_2: f32;
    var edge_depth: f32;
    var rim: f32;
    var beside_6: f32;
    var param_54: Segment;
    var param_55: f32;
    var steps_1: f32;
    var param_56: Segment;
    var param_57: f32;
    var param_58: f32;
    var walked: bool;
    var param_59: Segment;
    var param_60: f32;
    var param_61: f32;
    var param_62: f32;
    var param_63: Segment;
    var param_64: f32;
    var param_65: Segment;
    var param_66: f32;
    var param_67: f32;
    var before: f32;
    var param_68: Segment;
    var param_69: f32;
    var param_70: Segment;
    var param_71: f32;
    var param_72: f32;
    var param_73: f32;
    var param_74: f32;
    var param_75: f32;
    var param_76: f32;
    var local_11: f32;
    var param_77: f32;
    var param_78: f32;
    var local_12: f32;
    var param_79: f32;
    var param_80: f32;
    var here_1: Sample;
    var param_81: Segment;
    var param_82: f32;
    var before_1: Sample;
    var param_83: Segment;
    var param_84: f32;
    var t_1: f32;
    var param_85: f32;
    var param_86: f32;
    var local_13: f32;
    var param_87: Segment;
    var param_88: Sample;
    var param_89: Segment;
    var param_90: Sample;
    var param_91: Segment;
    var param_92: Sample;
    var away_1: f32;
    var param_93: Segment;
    var param_94: f32;
    var param_95: f32;
    var param_96: Edge;
    var param_97: vec4<f32>;
    var param_98: f32;
    var silhouette: Sample;
    var param_99: Segment;
    var param_100: f32;
    var coverage: f32;
    var param_101: Segment;
    var param_102: f32;
    var param_103: f32;
    var param_104: Segment;
    var param_105: Sample;
    var local_14: f32;
    var param_106: f32;
    var param_107: f32;
    var phi_990_: bool;
    var phi_1115_: bool;
    var phi_1155_: bool;
    var phi_1156_: bool;

    let _e116 = gl_FragCoord_1;
    let _e119 = synthesis.target_origin;
    let _e121 = (_e116.xy - vec2<f32>(_e119));
    pixel_2 = vec3<f32>(_e121.x, _e121.y, 1f);
    let _e126 = synthesis.to_source_x;
    let _e128 = pixel_2;
    let _e131 = synthesis.to_source_y;
    let _e133 = pixel_2;
    let _e136 = synthesis.to_source_w;
    let _e138 = pixel_2;
    ray = vec3<f32>(dot(_e126.xyz, _e128), dot(_e131.xyz, _e133), dot(_e136.xyz, _e138));
    let _e141 = ray;
    let _e144 = ray[2u];
    infinity = (_e141.xy / vec2(_e144));
    let _e149 = synthesis.to_source_x[3u];
    let _e152 = synthesis.to_source_y[3u];
    let _e156 = synthesis.to_source_w[3u];
    let _e157 = infinity;
    parallax = (vec2<f32>(_e149, _e152) - (_e157 * _e156));
    let _e160 = infinity;
    let _e163 = synthesis.source_law[0u];
    let _e166 = synthesis.source_law[1u];
    let _e168 = synthesis.far_depth;
    let _e171 = parallax;
    far = ((_e160 + (_e171 * (_e163 + (_e166 * _e168)))) - vec2(0.5f));
    let _e178 = synthesis.source_law[1u];
    let _e179 = parallax;
    moved = (_e179 * _e178);
    let _e182 = moved[1u];
    let _e185 = moved[0u];
    line_9.steep = (abs(_e182) > abs(_e185));
    let _e190 = line_9.steep;
    if _e190 {
        let _e191 = far;
        far = _e191.yx;
        let _e193 = moved;
        moved = _e193.yx;
    }
    let _e196 = moved[0u];
    let _e198 = synthesis.nearest;
    let _e200 = synthesis.far_depth;
    reach = (_e196 * (_e198 - _e200));
    let _e203 = reach;
    line_9.sense = select(1f, -1f, (_e203 > 0f));
    let _e208 = far[0u];
    line_9.far = _e208;
    let _e211 = far[1u];
    line_9.far_beside = _e211;
    let _e214 = moved[0u];
    if (_e214 == 0f) {
        local_9 = 0f;
    } else {
        let _e217 = moved[1u];
        let _e219 = moved[0u];
        local_9 = (_e217 / _e219);
    }
    let _e221 = local_9;
    line_9.slope = _e221;
    let _e224 = line_9.sense;
    let _e227 = moved[0u];
    line_9.law = (-(_e224) * _e227);
    let _e230 = pixel_2;
    tile_1 = (vec2<i32>(_e230.xy) / vec2<i32>(16i, 8i));
    let _e235 = moved[0u];
    let _e236 = tile_1;
    let _e237 = textureLoad(span_map_texture, _e236, 0i);
    let _e241 = synthesis.far_depth;
    reach = (_e235 * (bitcast<f32>(_e237.x) - _e241));
    let _e244 = line_9;
    param_48 = _e244;
    let _e245 = last_indices((&param_48));
    last_2 = _e245;
    let _e247 = line_9.sense;
    let _e249 = line_9.far;
    middle = (_e247 * _e249);
    let _e252 = line_9.sense;
    let _e253 = middle;
    let _e254 = reach;
    let _e261 = last_2[0u];
    first = clamp((_e252 * floor(((_e253 - abs(_e254)) - 0.01f))), 0f, _e261);
    let _e264 = line_9.sense;
    let _e265 = middle;
    let _e271 = last_2[0u];
    end = clamp((_e264 * (floor((_e265 + 0.01f)) + 1f)), 0f, _e271);
    let _e274 = line_9.sense;
    let _e275 = end;
    let _e276 = first;
    left = (_e274 * (_e275 - _e276));
    let _e279 = first;
    index_8 = _e279;
    let _e280 = line_9;
    param_49 = _e280;
    let _e281 = first;
    param_50 = _e281;
    let _e282 = sample_at((&param_49), (&param_50));
    depth_2 = _e282.depth;
    let _e284 = line_9;
    param_51 = _e284;
    let _e285 = first;
    param_52 = _e285;
    let _e286 = depth_2;
    param_53 = _e286;
    let _e287 = landing((&param_51), (&param_52), (&param_53));
    b_5 = _e287;
    let _e288 = b_5;
    a_5 = _e288;
    found = false;
    let _e289 = b_5;
    let _e290 = (_e289 > 0f);
    phi_990_ = _e290;
    if _e290 {
        let _e291 = first;
        let _e293 = line_9.sense;
        if (_e293 > 0f) {
            local_10 = 0f;
        } else {
            let _e296 = last_2[0u];
            local_10 = _e296;
        }
        let _e297 = local_10;
        phi_990_ = (_e291 == _e297);
    }
    let _e300 = phi_990_;
    outside = _e300;
    let _e301 = outside;
    let _e302 = first;
    edge_2 = select(-1f, _e302, _e301);
    let _e304 = depth_2;
    edge_depth = _e304;
    let _e305 = outside;
    let _e306 = b_5;
    let _e309 = left;
    left = select(_e309, 0f, (_e305 && (_e306 < 0.5f)));
    rim = -1f;
    loop {
        let _e311 = left;
        let _e313 = found;
        if ((_e311 > 0f) && !(_e313)) {
            let _e316 = line_9;
            param_54 = _e316;
            let _e317 = index_8;
            param_55 = _e317;
            let _e318 = beside_at((&param_54), (&param_55));
            let _e320 = last_2[1u];
            beside_6 = clamp(_e318, 0f, _e320);
            let _e322 = line_9;
            param_56 = _e322;
            let _e323 = index_8;
            param_57 = _e323;
            let _e324 = beside_6;
            param_58 = _e324;
            let _e325 = steps_in_tile((&param_56), (&param_57), (&param_58));
            let _e326 = left;
            steps_1 = min(_e325, _e326);
            let _e328 = line_9;
            param_59 = _e328;
            let _e329 = index_8;
            param_60 = _e329;
            let _e330 = beside_6;
            param_61 = _e330;
            let _e331 = steps_1;
            param_62 = _e331;
            let _e332 = lands((&param_59), (&param_60), (&param_61), (&param_62));
            walked = _e332;
            let _e333 = steps_1;
            let _e334 = left;
            left = (_e334 - _e333);
            let _e336 = walked;
            if !(_e336) {
                let _e339 = line_9.sense;
                let _e340 = steps_1;
                let _e342 = index_8;
                index_8 = (_e342 + (_e339 * _e340));
                let _e344 = line_9;
                param_63 = _e344;
                let _e345 = index_8;
                param_64 = _e345;
                let _e346 = sample_at((&param_63), (&param_64));
                depth_2 = _e346.depth;
                let _e348 = line_9;
                param_65 = _e348;
                let _e349 = index_8;
                param_66 = _e349;
                let _e350 = depth_2;
                param_67 = _e350;
                let _e351 = landing((&param_65), (&param_66), (&param_67));
                b_5 = _e351;
            }
            loop {
                let _e352 = walked;
                let _e353 = steps_1;
                let _e356 = found;
                if ((_e352 && (_e353 > 0f)) && !(_e356)) {
                    let _e359 = b_5;
                    a_5 = _e359;
                    let _e360 = depth_2;
                    before = _e360;
                    let _e362 = line_9.sense;
                    let _e363 = index_8;
                    index_8 = (_e363 + _e362);
                    let _e365 = line_9;
                    param_68 = _e365;
                    let _e366 = index_8;
                    param_69 = _e366;
                    let _e367 = sample_at((&param_68), (&param_69));
                    depth_2 = _e367.depth;
                    let _e369 = line_9;
                    param_70 = _e369;
                    let _e370 = index_8;
                    param_71 = _e370;
                    let _e371 = depth_2;
                    param_72 = _e371;
                    let _e372 = landing((&param_70), (&param_71), (&param_72));
                    b_5 = _e372;
                    let _e373 = a_5;
                    param_73 = _e373;
                    let _e374 = b_5;
                    param_74 = _e374;
                    let _e375 = is_seen((&param_73), (&param_74));
                    found = _e375;
                    let _e376 = rim;
                    let _e377 = (_e376 < 0f);
                    phi_1115_ = _e377;
                    if _e377 {
                        let _e378 = a_5;
                        param_75 = _e378;
                        let _e379 = b_5;
                        param_76 = _e379;
                        let _e380 = has_rim((&param_75), (&param_76));
                        phi_1115_ = _e380;
                    }
                    let _e382 = phi_1115_;
                    if _e382 {
                        let _e383 = index_8;
                        let _e384 = a_5;
                        param_77 = _e384;
                        let _e385 = b_5;
                        param_78 = _e385;
                        let _e386 = folds((&param_77), (&param_78));
                        if _e386 {
                            let _e388 = line_9.sense;
                            local_12 = _e388;
                        } else {
                            local_12 = 0f;
                        }
                        let _e389 = local_12;
                        local_11 = (_e383 - _e389);
                    } else {
                        let _e391 = rim;
                        local_11 = _e391;
                    }
                    let _e392 = local_11;
                    rim = _e392;
                    let _e393 = a_5;
                    param_79 = _e393;
                    let _e394 = b_5;
                    param_80 = _e394;
                    let _e395 = jumps((&param_79), (&param_80));
                    phi_1156_ = _e395;
                    if _e395 {
                        let _e396 = edge_2;
                        let _e397 = (_e396 < 0f);
                        phi_1155_ = _e397;
                        if !(_e397) {
                            let _e400 = line_9.law;
                            let _e401 = before;
                            let _e402 = edge_depth;
                            phi_1155_ = ((_e400 * (_e401 - _e402)) < 0f);
                        }
                        let _e407 = phi_1155_;
                        phi_1156_ = _e407;
                    }
                    let _e409 = phi_1156_;
                    if _e409 {
                        let _e410 = index_8;
                        let _e412 = line_9.sense;
                        edge_2 = (_e410 - _e412);
                        let _e414 = before;
                        edge_depth = _e414;
                    }
                    continue;
                } else {
                    break;
                }
                continuing {
                    let _e415 = steps_1;
                    steps_1 = (_e415 - 1f);
                }
            }
            continue;
        } else {
            break;
        }
    }
    let _e417 = found;
    let _e418 = edge_2;
    let _e421 = index_8;
    let _e422 = edge_2;
    let _e424 = line_9;
    param_81 = _e424;
    param_82 = select(_e422, _e421, (_e417 || (_e418 < 0f)));
    let _e425 = sample_at((&param_81), (&param_82));
    here_1 = _e425;
    let _e426 = found;
    if _e426 {
        let _e427 = index_8;
        let _e429 = line_9.sense;
        let _e431 = line_9;
        param_83 = _e431;
        param_84 = (_e427 - _e429);
        let _e432 = sample_at((&param_83), (&param_84));
        before_1 = _e432;
        let _e433 = a_5;
        param_85 = _e433;
        let _e434 = b_5;
        param_86 = _e434;
        let _e435 = is_torn((&param_85), (&param_86));
        if _e435 {
            local_13 = 0f;
        } else {
            let _e436 = a_5;
            let _e438 = b_5;
            let _e439 = a_5;
            local_13 = (-(_e436) / (_e438 - _e439));
        }
        let _e442 = local_13;
        t_1 = _e442;
        let _e444 = before_1.depth;
        let _e446 = here_1.depth;
        let _e447 = t_1;
        depth_2 = mix(_e444, _e446, _e447);
        let _e449 = line_9;
        param_87 = _e449;
        let _e450 = before_1;
        param_88 = _e450;
        let _e451 = color_of((&param_87), (&param_88));
        let _e452 = line_9;
        param_89 = _e452;
        let _e453 = here_1;
        param_90 = _e453;
        let _e454 = color_of((&param_89), (&param_90));
        let _e455 = t_1;
        color_1 = mix(_e451, _e454, vec4(_e455));
    } else {
        let _e459 = here_1.depth;
        depth_2 = _e459;
        let _e460 = line_9;
        param_91 = _e460;
        let _e461 = here_1;
        param_92 = _e461;
        let _e462 = color_of((&param_91), (&param_92));
        color_1 = _e462;
        let _e463 = line_9;
        param_93 = _e463;
        let _e465 = here_1.index;
        param_94 = _e465;
        let _e466 = depth_2;
        param_95 = _e466;
        let _e467 = landing((&param_93), (&param_94), (&param_95));
        away_1 = _e467;
        let _e468 = away_1;
        if (abs(_e468) >= 0.5f) {
            let _e471 = line_9;
            let _e472 = here_1;
            param_96 = Edge(_e471, _e472);
            let _e474 = color_1;
            param_97 = _e474;
            let _e475 = away_1;
            param_98 = _e475;
            let _e476 = fill_hole((&param_96), (&param_97), (&param_98));
            color_1 = _e476;
        }
    }
    let _e477 = rim;
    if (_e477 >= 0f) {
        let _e479 = line_9;
        param_99 = _e479;
        let _e480 = rim;
        param_100 = _e480;
        let _e481 = sample_at((&param_99), (&param_100));
        silhouette = _e481;
        let _e482 = line_9;
        param_101 = _e482;
        let _e483 = rim;
        param_102 = _e483;
        let _e485 = silhouette.depth;
        param_103 = _e485;
        let _e486 = landing((&param_101), (&param_102), (&param_103));
        coverage = (1f - abs(_e486));
        let _e489 = color_1;
        let _e490 = line_9;
        param_104 = _e490;
        let _e491 = silhouette;
        param_105 = _e491;
        let _e492 = color_of((&param_104), (&param_105));
        let _e493 = coverage;
        color_1 = mix(_e489, _e492, vec4(_e493));
        let _e496 = coverage;
        if (_e496 >= 0.5f) {
            let _e499 = silhouette.depth;
            local_14 = _e499;
        } else {
            let _e500 = depth_2;
            local_14 = _e500;
        }
        let _e501 = local_14;
        depth_2 = _e501;
    }
    let _e502 = depth_2;
    param_106 = _e502;
    let _e504 = ray[2u];
    param_107 = _e504;
    let _e505 = target_depth((&param_106), (&param_107));
    gl_FragDepth = _e505;
    return;
}

@fragment 
fn main(@builtin(position) gl_FragCoord: vec4<f32>) -> FragmentOutput {
    gl_FragCoord_1 = gl_FragCoord;
    main_1();
    let _e4 = color_1;
    let _e5 = gl_FragDepth;
    return FragmentOutput(_e4, _e5);
}
