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
var<private> color: vec4<f32>;

fn nearest_of(texel: ptr<function, vec4<f32>>) -> f32 {
    let _e3 = (*texel)[0u];
    return _e3;
}

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

fn depth_texel(column: ptr<function, i32>, row: ptr<function, i32>) -> f32 {
    var param: vec2<i32>;
    var param_1: vec4<f32>;

    let _e6 = (*column);
    let _e7 = (*row);
    param = vec2<i32>(_e6, _e7);
    let _e9 = in_image((&param));
    let _e10 = textureLoad(depth_map_texture, _e9, 0i);
    param_1 = _e10;
    let _e11 = nearest_of((&param_1));
    return _e11;
}

fn pixel_of(line: ptr<function, Segment>, index: ptr<function, f32>, beside: ptr<function, f32>) -> vec2<i32> {
    var local_1: vec2<f32>;

    let _e5 = (*line).steep;
    if _e5 {
        let _e6 = (*beside);
        let _e7 = (*index);
        local_1 = vec2<f32>(_e6, _e7);
    } else {
        let _e9 = (*index);
        let _e10 = (*beside);
        local_1 = vec2<f32>(_e9, _e10);
    }
    let _e12 = local_1;
    return vec2<i32>(_e12);
}

fn depth_of(line_1: ptr<function, Segment>, index_1: ptr<function, f32>, beside_1: ptr<function, f32>) -> f32 {
    var pixel_1: vec2<i32>;
    var param_2: Segment;
    var param_3: f32;
    var param_4: f32;
    var param_5: i32;
    var param_6: i32;

    let _e11 = (*line_1);
    param_2 = _e11;
    let _e12 = (*index_1);
    param_3 = _e12;
    let _e13 = (*beside_1);
    param_4 = _e13;
    let _e14 = pixel_of((&param_2), (&param_3), (&param_4));
    pixel_1 = _e14;
    let _e16 = pixel_1[0u];
    param_5 = _e16;
    let _e18 = pixel_1[1u];
    param_6 = _e18;
    let _e19 = depth_texel((&param_5), (&param_6));
    return _e19;
}

fn color_sample(place: ptr<function, vec2<f32>>) -> vec4<f32> {
    let _e4 = (*place);
    let _e5 = textureSampleLevel(color_map_texture, linear_sampler, _e4, 0f);
    return _e5;
}

fn color_of(line_2: ptr<function, Segment>, at: ptr<function, Sample>) -> vec4<f32> {
    var index_2: vec2<f32>;
    var local_2: vec2<f32>;
    var param_7: vec2<f32>;

    let _e8 = (*line_2).steep;
    if _e8 {
        let _e10 = (*at).beside;
        let _e12 = (*at).index;
        local_2 = vec2<f32>(_e10, _e12);
    } else {
        let _e15 = (*at).index;
        let _e17 = (*at).beside;
        local_2 = vec2<f32>(_e15, _e17);
    }
    let _e19 = local_2;
    index_2 = _e19;
    let _e21 = synthesis.source_origin;
    let _e23 = index_2;
    let _e28 = synthesis.texel;
    param_7 = (((vec2<f32>(_e21) + _e23) + vec2(0.5f)) * _e28);
    let _e30 = color_sample((&param_7));
    return _e30;
}

fn fill_spread(away: ptr<function, f32>) -> f32 {
    let _e4 = (*away);
    return (0.5f * clamp(abs(_e4), 1f, 12f));
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

fn fill_beside(line_4: ptr<function, Segment>, edge: ptr<function, Sample>, away_1: ptr<function, f32>) -> vec4<f32> {
    var last_1: f32;
    var param_8: Segment;
    var spread: f32;
    var param_9: f32;
    var sum: vec4<f32>;
    var param_10: Segment;
    var param_11: Sample;
    var weights: f32;
    var i: i32;
    var beside_2: f32;
    var tap: Sample;
    var param_12: Segment;
    var param_13: f32;
    var param_14: f32;
    var weight: f32;
    var param_15: Segment;
    var param_16: Sample;
    var phi_680_: bool;

    let _e29 = (*line_4);
    param_8 = _e29;
    let _e30 = last_indices((&param_8));
    last_1 = _e30.y;
    let _e32 = (*away_1);
    param_9 = _e32;
    let _e33 = fill_spread((&param_9));
    spread = _e33;
    let _e34 = (*line_4);
    param_10 = _e34;
    let _e35 = (*edge);
    param_11 = _e35;
    let _e36 = color_of((&param_10), (&param_11));
    sum = (_e36 * 2f);
    weights = 2f;
    let _e38 = (*away_1);
    i = select(3i, -2i, (abs(_e38) >= 0.5f));
    loop {
        let _e42 = i;
        if (_e42 <= 2i) {
            let _e45 = (*edge).beside;
            let _e48 = i;
            let _e50 = spread;
            let _e54 = last_1;
            beside_2 = clamp((floor((_e45 + 0.5f)) + round((f32(_e48) * _e50))), 0f, _e54);
            let _e57 = (*edge).index;
            let _e58 = beside_2;
            let _e59 = (*line_4);
            param_12 = _e59;
            let _e61 = (*edge).index;
            param_13 = _e61;
            let _e62 = beside_2;
            param_14 = _e62;
            let _e63 = depth_of((&param_12), (&param_13), (&param_14));
            tap = Sample(_e57, _e58, _e63);
            let _e65 = i;
            let _e66 = (_e65 != 0i);
            phi_680_ = _e66;
            if _e66 {
                let _e68 = (*line_4).law;
                let _e70 = tap.depth;
                let _e72 = (*edge).depth;
                phi_680_ = ((_e68 * (_e70 - _e72)) <= 1f);
            }
            let _e77 = phi_680_;
            weight = select(0f, 1f, _e77);
            let _e79 = weight;
            let _e80 = (*line_4);
            param_15 = _e80;
            let _e81 = tap;
            param_16 = _e81;
            let _e82 = color_of((&param_15), (&param_16));
            let _e84 = sum;
            sum = (_e84 + (_e82 * _e79));
            let _e86 = weight;
            let _e87 = weights;
            weights = (_e87 + _e86);
            continue;
        } else {
            break;
        }
        continuing {
            let _e89 = i;
            i = (_e89 + 1i);
        }
    }
    let _e91 = sum;
    let _e92 = weights;
    return (_e91 / vec4(_e92));
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
    var phi_164_: bool;

    let _e4 = (*a_2);
    let _e5 = (_e4 <= 0f);
    phi_164_ = _e5;
    if _e5 {
        let _e6 = (*b_2);
        let _e8 = (*a_2);
        phi_164_ = (max(_e6, -1f) < _e8);
    }
    let _e11 = phi_164_;
    return _e11;
}

fn has_rim(a_3: ptr<function, f32>, b_3: ptr<function, f32>) -> bool {
    var param_17: f32;
    var param_18: f32;
    var param_19: f32;
    var param_20: f32;
    var param_21: f32;
    var param_22: f32;
    var phi_187_: bool;
    var phi_192_: bool;

    let _e9 = (*a_3);
    param_17 = _e9;
    let _e10 = (*b_3);
    param_18 = _e10;
    let _e11 = folds((&param_17), (&param_18));
    phi_192_ = _e11;
    if !(_e11) {
        let _e13 = (*a_3);
        param_19 = _e13;
        let _e14 = (*b_3);
        param_20 = _e14;
        let _e15 = jumps((&param_19), (&param_20));
        phi_187_ = _e15;
        if _e15 {
            let _e16 = (*a_3);
            param_21 = _e16;
            let _e17 = (*b_3);
            param_22 = _e17;
            let _e18 = is_torn((&param_21), (&param_22));
            phi_187_ = _e18;
        }
        let _e20 = phi_187_;
        let _e21 = (*b_3);
        phi_192_ = (_e20 && (_e21 < 1f));
    }
    let _e25 = phi_192_;
    return _e25;
}

fn is_seen(a_4: ptr<function, f32>, b_4: ptr<function, f32>) -> bool {
    var param_23: f32;
    var param_24: f32;
    var param_25: f32;
    var param_26: f32;
    var phi_151_: bool;
    var phi_152_: bool;

    let _e7 = (*a_4);
    param_23 = _e7;
    let _e8 = (*b_4);
    param_24 = _e8;
    let _e9 = jumps((&param_23), (&param_24));
    phi_152_ = _e9;
    if _e9 {
        let _e10 = (*a_4);
        let _e11 = (_e10 > -0.5f);
        phi_151_ = _e11;
        if !(_e11) {
            let _e13 = (*a_4);
            param_25 = _e13;
            let _e14 = (*b_4);
            param_26 = _e14;
            let _e15 = is_torn((&param_25), (&param_26));
            phi_151_ = !(_e15);
        }
        let _e18 = phi_151_;
        phi_152_ = _e18;
    }
    let _e20 = phi_152_;
    return _e20;
}

fn landing(line_5: ptr<function, Segment>, index_3: ptr<function, f32>, depth: ptr<function, f32>) -> f32 {
    let _e5 = (*line_5).sense;
    let _e6 = (*index_3);
    let _e8 = (*line_5).far;
    let _e12 = (*line_5).law;
    let _e13 = (*depth);
    let _e15 = synthesis.far_depth;
    return ((_e5 * (_e6 - _e8)) + (_e12 * (_e13 - _e15)));
}

fn lands(line_6: ptr<function, Segment>, index_4: ptr<function, f32>, beside_3: ptr<function, f32>, steps: ptr<function, f32>) -> bool {
    var bounds: vec2<u32>;
    var param_27: Segment;
    var param_28: f32;
    var param_29: f32;
    var ends: vec2<f32>;
    var param_30: Segment;
    var param_31: f32;
    var param_32: f32;
    var param_33: Segment;
    var param_34: f32;
    var param_35: f32;
    var phi_607_: bool;

    let _e22 = (*beside_3);
    let _e24 = (*line_6);
    param_27 = _e24;
    let _e25 = (*index_4);
    param_28 = _e25;
    param_29 = floor(_e22);
    let _e26 = pixel_of((&param_27), (&param_28), (&param_29));
    let _e28 = textureLoad(tile_map_texture, (_e26 / vec2<i32>(16i, 8i)), 0i);
    bounds = _e28.xy;
    let _e31 = bounds[0u];
    let _e33 = (*line_6);
    param_30 = _e33;
    let _e34 = (*index_4);
    param_31 = _e34;
    param_32 = bitcast<f32>(_e31);
    let _e35 = landing((&param_30), (&param_31), (&param_32));
    let _e37 = bounds[1u];
    let _e39 = (*line_6);
    param_33 = _e39;
    let _e40 = (*index_4);
    param_34 = _e40;
    param_35 = bitcast<f32>(_e37);
    let _e41 = landing((&param_33), (&param_34), (&param_35));
    ends = vec2<f32>(_e35, _e41);
    let _e44 = ends[0u];
    let _e46 = ends[1u];
    let _e48 = (min(_e44, _e46) <= 1f);
    phi_607_ = _e48;
    if _e48 {
        let _e50 = ends[0u];
        let _e52 = ends[1u];
        let _e54 = (*steps);
        phi_607_ = ((max(_e50, _e52) + _e54) >= -1f);
    }
    let _e58 = phi_607_;
    return _e58;
}

fn steps_in_tile(line_7: ptr<function, Segment>, index_5: ptr<function, f32>, beside_4: ptr<function, f32>) -> f32 {
    var tile: vec2<f32>;
    var in_tile: vec2<f32>;
    var along: f32;
    var local_4: f32;
    var drift: f32;
    var room: f32;
    var local_5: f32;
    var local_6: f32;

    let _e18 = (*line_7).steep;
    tile = select(vec2<f32>(16f, 8f), vec2<f32>(8f, 16f), vec2(_e18));
    let _e21 = (*index_5);
    let _e22 = (*beside_4);
    let _e24 = vec2<f32>(_e21, floor(_e22));
    let _e25 = tile;
    in_tile = (_e24 - (floor((_e24 / _e25)) * _e25));
    let _e31 = (*line_7).sense;
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
    let _e43 = (*line_7).sense;
    let _e45 = (*line_7).slope;
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

fn beside_at(line_8: ptr<function, Segment>, index_6: ptr<function, f32>) -> f32 {
    let _e3 = (*line_8).far_beside;
    let _e5 = (*line_8).slope;
    let _e6 = (*index_6);
    let _e8 = (*line_8).far;
    return (_e3 + (_e5 * (_e6 - _e8)));
}

fn sample_at(line_9: ptr<function, Segment>, index_7: ptr<function, f32>) -> Sample {
    var last_2: f32;
    var param_36: Segment;
    var beside_5: f32;
    var param_37: Segment;
    var param_38: f32;
    var low: f32;
    var here: f32;
    var param_39: Segment;
    var param_40: f32;
    var param_41: f32;
    var next: f32;
    var param_42: Segment;
    var param_43: f32;
    var param_44: f32;
    var t: f32;
    var whole: bool;
    var upper: bool;
    var local_7: f32;
    var local_8: f32;

    let _e24 = (*line_9);
    param_36 = _e24;
    let _e25 = last_indices((&param_36));
    last_2 = _e25.y;
    let _e27 = (*line_9);
    param_37 = _e27;
    let _e28 = (*index_7);
    param_38 = _e28;
    let _e29 = beside_at((&param_37), (&param_38));
    let _e30 = last_2;
    beside_5 = clamp(_e29, 0f, _e30);
    let _e32 = beside_5;
    low = floor(_e32);
    let _e34 = (*line_9);
    param_39 = _e34;
    let _e35 = (*index_7);
    param_40 = _e35;
    let _e36 = low;
    param_41 = _e36;
    let _e37 = depth_of((&param_39), (&param_40), (&param_41));
    here = _e37;
    let _e38 = low;
    let _e40 = last_2;
    let _e42 = (*line_9);
    param_42 = _e42;
    let _e43 = (*index_7);
    param_43 = _e43;
    param_44 = min((_e38 + 1f), _e40);
    let _e44 = depth_of((&param_42), (&param_43), (&param_44));
    next = _e44;
    let _e45 = beside_5;
    let _e46 = low;
    t = (_e45 - _e46);
    let _e49 = (*line_9).law;
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
    var line_10: Segment;
    var reach: f32;
    var local_9: f32;
    var tile_1: vec2<i32>;
    var last_3: vec2<f32>;
    var param_45: Segment;
    var middle: f32;
    var first: f32;
    var end: f32;
    var left: f32;
    var index_8: f32;
    var depth_1: f32;
    var param_46: Segment;
    var param_47: f32;
    var b_5: f32;
    var param_48: Segment;
    var param_49: f32;
    var param_50: f32;
    var a_5: f32;
    var found: bool;
    var outside: bool;
    var local_10: f32;
    var edge_1: f32;
    var edge_depth: f32;
    var rim: f32;
    var beside_6: f32;
    var param_51: Segment;
    var param_52: f32;
    var steps_1: f32;
    var param_53: Segment;
    var param_54: f32;
    var param_55: f32;
    var walked: bool;
    var param_56: Segment;
    var param_57: f32;
    var param_58: f32;
    var param_59: f32;
    var param_60: Segment;
    var param_61: f32;
    var param_62: Segment;
    var param_63: f32;
    var param_64: f32;
    var before: f32;
    var param_65: Segment;
    var param_66: f32;
    var param_67: Segment;
    var param_68: f32;
    var param_69: f32;
    var param_70: f32;
    var param_71: f32;
    var param_72: f32;
    var param_73: f32;
    var local_11: f32;
    var param_74: f32;
    var param_75: f32;
    var local_12: f32;
    var param_76: f32;
    var param_77: f32;
    var here_1: Sample;
    var param_78: Segment;
    var param_79: f32;
    var before_1: Sample;
    var param_80: Segment;
    var param_81: f32;
    var t_1: f32;
    var param_82: f32;
    var param_83: f32;
    var local_13: f32;
    var param_84: Segment;
    var param_85: Sample;
    var param_86: Segment;
    var param_87: Sample;
    var param_88: Segment;
    var param_89: f32;
    var param_90: f32;
    var param_91: Segment;
    var param_92: Sample;
    var param_93: f32;
    var silhouette: Sample;
    var param_94: Segment;
    var param_95: f32;
    var coverage: f32;
    var param_96: Segment;
    var param_97: f32;
    var param_98: f32;
    var param_99: Segment;
    var param_100: Sample;
    var local_14: f32;
    var phi_932_: bool;
    var phi_1057_: bool;
    var phi_1097_: bool;
    var phi_1098_: bool;

    let _e110 = gl_FragCoord_1;
    let _e113 = synthesis.target_origin;
    let _e115 = (_e110.xy - vec2<f32>(_e113));
    pixel_2 = vec3<f32>(_e115.x, _e115.y, 1f);
    let _e120 = synthesis.to_source_x;
    let _e122 = pixel_2;
    let _e125 = synthesis.to_source_y;
    let _e127 = pixel_2;
    let _e130 = synthesis.to_source_w;
    let _e132 = pixel_2;
    ray = vec3<f32>(dot(_e120.xyz, _e122), dot(_e125.xyz, _e127), dot(_e130.xyz, _e132));
    let _e135 = ray;
    let _e138 = ray[2u];
    infinity = (_e135.xy / vec2(_e138));
    let _e143 = synthesis.to_source_x[3u];
    let _e146 = synthesis.to_source_y[3u];
    let _e150 = synthesis.to_source_w[3u];
    let _e151 = infinity;
    parallax = (vec2<f32>(_e143, _e146) - (_e151 * _e150));
    let _e154 = infinity;
    let _e157 = synthesis.source_law[0u];
    let _e160 = synthesis.source_law[1u];
    let _e162 = synthesis.far_depth;
    let _e165 = parallax;
    far = ((_e154 + (_e165 * (_e157 + (_e160 * _e162)))) - vec2(0.5f));
    let _e172 = synthesis.source_law[1u];
    let _e173 = parallax;
    moved = (_e173 * _e172);
    let _e176 = moved[1u];
    let _e179 = moved[0u];
    line_10.steep = (abs(_e176) > abs(_e179));
    let _e184 = line_10.steep;
    if _e184 {
        let _e185 = far;
        far = _e185.yx;
        let _e187 = moved;
        moved = _e187.yx;
    }
    let _e190 = moved[0u];
    let _e192 = synthesis.nearest;
    let _e194 = synthesis.far_depth;
    reach = (_e190 * (_e192 - _e194));
    let _e197 = reach;
    line_10.sense = select(1f, -1f, (_e197 > 0f));
    let _e202 = far[0u];
    line_10.far = _e202;
    let _e205 = far[1u];
    line_10.far_beside = _e205;
    let _e208 = moved[0u];
    if (_e208 == 0f) {
        local_9 = 0f;
    } else {
        let _e211 = moved[1u];
        let _e213 = moved[0u];
        local_9 = (_e211 / _e213);
    }
    let _e215 = local_9;
    line_10.slope = _e215;
    let _e218 = line_10.sense;
    let _e221 = moved[0u];
    line_10.law = (-(_e218) * _e221);
    let _e224 = pixel_2;
    tile_1 = (vec2<i32>(_e224.xy) / vec2<i32>(16i, 8i));
    let _e229 = moved[0u];
    let _e230 = tile_1;
    let _e231 = textureLoad(span_map_texture, _e230, 0i);
    let _e235 = synthesis.far_depth;
    reach = (_e229 * (bitcast<f32>(_e231.x) - _e235));
    let _e238 = line_10;
    param_45 = _e238;
    let _e239 = last_indices((&param_45));
    last_3 = _e239;
    let _e241 = line_10.sense;
    let _e243 = line_10.far;
    middle = (_e241 * _e243);
    let _e246 = line_10.sense;
    let _e247 = middle;
    let _e248 = reach;
    let _e255 = last_3[0u];
    first = clamp((_e246 * floor(((_e247 - abs(_e248)) - 0.01f))), 0f, _e255);
    let _e258 = line_10.sense;
    let _e259 = middle;
    let _e265 = last_3[0u];
    end = clamp((_e258 * (floor((_e259 + 0.01f)) + 1f)), 0f, _e265);
    let _e268 = line_10.sense;
    let _e269 = end;
    let _e270 = first;
    left = (_e268 * (_e269 - _e270));
    let _e273 = first;
    index_8 = _e273;
    let _e274 = line_10;
    param_46 = _e274;
    let _e275 = first;
    param_47 = _e275;
    let _e276 = sample_at((&param_46), (&param_47));
    depth_1 = _e276.depth;
    let _e278 = line_10;
    param_48 = _e278;
    let _e279 = first;
    param_49 = _e279;
    let _e280 = depth_1;
    param_50 = _e280;
    let _e281 = landing((&param_48), (&param_49), (&param_50));
    b_5 = _e281;
    let _e282 = b_5;
    a_5 = _e282;
    found = false;
    let _e283 = b_5;
    let _e284 = (_e283 > 0f);
    phi_932_ = _e284;
    if _e284 {
        let _e285 = first;
        let _e287 = line_10.sense;
        if (_e287 > 0f) {
            local_10 = 0f;
        } else {
            let _e290 = last_3[0u];
            local_10 = _e290;
        }
        let _e291 = local_10;
        phi_932_ = (_e285 == _e291);
    }
    let _e294 = phi_932_;
    outside = _e294;
    let _e295 = outside;
    let _e296 = first;
    edge_1 = select(-1f, _e296, _e295);
    let _e298 = depth_1;
    edge_depth = _e298;
    let _e299 = outside;
    let _e300 = b_5;
    let _e303 = left;
    left = select(_e303, 0f, (_e299 && (_e300 < 0.5f)));
    rim = -1f;
    loop {
        let _e305 = left;
        let _e307 = found;
        if ((_e305 > 0f) && !(_e307)) {
            let _e310 = line_10;
            param_51 = _e310;
            let _e311 = index_8;
            param_52 = _e311;
            let _e312 = beside_at((&param_51), (&param_52));
            let _e314 = last_3[1u];
            beside_6 = clamp(_e312, 0f, _e314);
            let _e316 = line_10;
            param_53 = _e316;
            let _e317 = index_8;
            param_54 = _e317;
            let _e318 = beside_6;
            param_55 = _e318;
            let _e319 = steps_in_tile((&param_53), (&param_54), (&param_55));
            let _e320 = left;
            steps_1 = min(_e319, _e320);
            let _e322 = line_10;
            param_56 = _e322;
            let _e323 = index_8;
            param_57 = _e323;
            let _e324 = beside_6;
            param_58 = _e324;
            let _e325 = steps_1;
            param_59 = _e325;
            let _e326 = lands((&param_56), (&param_57), (&param_58), (&param_59));
            walked = _e326;
            let _e327 = steps_1;
            let _e328 = left;
            left = (_e328 - _e327);
            let _e330 = walked;
            if !(_e330) {
                let _e333 = line_10.sense;
                let _e334 = steps_1;
                let _e336 = index_8;
                index_8 = (_e336 + (_e333 * _e334));
                let _e338 = line_10;
                param_60 = _e338;
                let _e339 = index_8;
                param_61 = _e339;
                let _e340 = sample_at((&param_60), (&param_61));
                depth_1 = _e340.depth;
                let _e342 = line_10;
                param_62 = _e342;
                let _e343 = index_8;
                param_63 = _e343;
                let _e344 = depth_1;
                param_64 = _e344;
                let _e345 = landing((&param_62), (&param_63), (&param_64));
                b_5 = _e345;
            }
            loop {
                let _e346 = walked;
                let _e347 = steps_1;
                let _e350 = found;
                if ((_e346 && (_e347 > 0f)) && !(_e350)) {
                    let _e353 = b_5;
                    a_5 = _e353;
                    let _e354 = depth_1;
                    before = _e354;
                    let _e356 = line_10.sense;
                    let _e357 = index_8;
                    index_8 = (_e357 + _e356);
                    let _e359 = line_10;
                    param_65 = _e359;
                    let _e360 = index_8;
                    param_66 = _e360;
                    let _e361 = sample_at((&param_65), (&param_66));
                    depth_1 = _e361.depth;
                    let _e363 = line_10;
                    param_67 = _e363;
                    let _e364 = index_8;
                    param_68 = _e364;
                    let _e365 = depth_1;
                    param_69 = _e365;
                    let _e366 = landing((&param_67), (&param_68), (&param_69));
                    b_5 = _e366;
                    let _e367 = a_5;
                    param_70 = _e367;
                    let _e368 = b_5;
                    param_71 = _e368;
                    let _e369 = is_seen((&param_70), (&param_71));
                    found = _e369;
                    let _e370 = rim;
                    let _e371 = (_e370 < 0f);
                    phi_1057_ = _e371;
                    if _e371 {
                        let _e372 = a_5;
                        param_72 = _e372;
                        let _e373 = b_5;
                        param_73 = _e373;
                        let _e374 = has_rim((&param_72), (&param_73));
                        phi_1057_ = _e374;
                    }
                    let _e376 = phi_1057_;
                    if _e376 {
                        let _e377 = index_8;
                        let _e378 = a_5;
                        param_74 = _e378;
                        let _e379 = b_5;
                        param_75 = _e379;
                        let _e380 = folds((&param_74), (&param_75));
                        if _e380 {
                            let _e382 = line_10.sense;
                            local_12 = _e382;
                        } else {
                            local_12 = 0f;
                        }
                        let _e383 = local_12;
                        local_11 = (_e377 - _e383);
                    } else {
                        let _e385 = rim;
                        local_11 = _e385;
                    }
                    let _e386 = local_11;
                    rim = _e386;
                    let _e387 = a_5;
                    param_76 = _e387;
                    let _e388 = b_5;
                    param_77 = _e388;
                    let _e389 = jumps((&param_76), (&param_77));
                    phi_1098_ = _e389;
                    if _e389 {
                        let _e390 = edge_1;
                        let _e391 = (_e390 < 0f);
                        phi_1097_ = _e391;
                        if !(_e391) {
                            let _e394 = line_10.law;
                            let _e395 = before;
                            let _e396 = edge_depth;
                            phi_1097_ = ((_e394 * (_e395 - _e396)) < 0f);
                        }
                        let _e401 = phi_1097_;
                        phi_1098_ = _e401;
                    }
                    let _e403 = phi_1098_;
                    if _e403 {
                        let _e404 = index_8;
                        let _e406 = line_10.sense;
                        edge_1 = (_e404 - _e406);
                        let _e408 = before;
                        edge_depth = _e408;
                    }
                    continue;
                } else {
                    break;
                }
                continuing {
                    let _e409 = steps_1;
                    steps_1 = (_e409 - 1f);
                }
            }
            continue;
        } else {
            break;
        }
    }
    let _e411 = found;
    let _e412 = edge_1;
    let _e415 = index_8;
    let _e416 = edge_1;
    let _e418 = line_10;
    param_78 = _e418;
    param_79 = select(_e416, _e415, (_e411 || (_e412 < 0f)));
    let _e419 = sample_at((&param_78), (&param_79));
    here_1 = _e419;
    let _e420 = found;
    if _e420 {
        let _e421 = index_8;
        let _e423 = line_10.sense;
        let _e425 = line_10;
        param_80 = _e425;
        param_81 = (_e421 - _e423);
        let _e426 = sample_at((&param_80), (&param_81));
        before_1 = _e426;
        let _e427 = a_5;
        param_82 = _e427;
        let _e428 = b_5;
        param_83 = _e428;
        let _e429 = is_torn((&param_82), (&param_83));
        if _e429 {
            local_13 = 0f;
        } else {
            let _e430 = a_5;
            let _e432 = b_5;
            let _e433 = a_5;
            local_13 = (-(_e430) / (_e432 - _e433));
        }
        let _e436 = local_13;
        t_1 = _e436;
        let _e438 = before_1.depth;
        let _e440 = here_1.depth;
        let _e441 = t_1;
        depth_1 = mix(_e438, _e440, _e441);
        let _e443 = line_10;
        param_84 = _e443;
        let _e444 = before_1;
        param_85 = _e444;
        let _e445 = color_of((&param_84), (&param_85));
        let _e446 = line_10;
        param_86 = _e446;
        let _e447 = here_1;
        param_87 = _e447;
        let _e448 = color_of((&param_86), (&param_87));
        let _e449 = t_1;
        color = mix(_e445, _e448, vec4(_e449));
    } else {
        let _e453 = here_1.depth;
        depth_1 = _e453;
        let _e454 = line_10;
        param_88 = _e454;
        let _e456 = here_1.index;
        param_89 = _e456;
        let _e457 = depth_1;
        param_90 = _e457;
        let _e458 = landing((&param_88), (&param_89), (&param_90));
        let _e459 = line_10;
        param_91 = _e459;
        let _e460 = here_1;
        param_92 = _e460;
        param_93 = _e458;
        let _e461 = fill_beside((&param_91), (&param_92), (&param_93));
        color = _e461;
    }
    let _e462 = rim;
    if (_e462 >= 0f) {
        let _e464 = line_10;
        param_94 = _e464;
        let _e465 = rim;
        param_95 = _e465;
        let _e466 = sample_at((&param_94), (&param_95));
        silhouette = _e466;
        let _e467 = line_10;
        param_96 = _e467;
        let _e468 = rim;
        param_97 = _e468;
        let _e470 = silhouette.depth;
        param_98 = _e470;
        let _e471 = landing((&param_96), (&param_97), (&param_98));
        coverage = (1f - abs(_e471));
        let _e474 = color;
        let _e475 = line_10;
        param_99 = _e475;
        let _e476 = silhouette;
        param_100 = _e476;
        let _e477 = color_of((&param_99), (&param_100));
        let _e478 = coverage;
        color = mix(_e474, _e477, vec4(_e478));
        let _e481 = coverage;
        if (_e481 >= 0.5f) {
            let _e484 = silhouette.depth;
            local_14 = _e484;
        } else {
            let _e485 = depth_1;
            local_14 = _e485;
        }
        let _e486 = local_14;
        depth_1 = _e486;
    }
    return;
}

@fragment 
fn main(@builtin(position) gl_FragCoord: vec4<f32>) -> @location(0) vec4<f32> {
    gl_FragCoord_1 = gl_FragCoord;
    main_1();
    let _e3 = color;
    return _e3;
}
