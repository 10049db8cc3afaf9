// Made of yoro's GLSL by `cargo xtask maintain renew`.
struct Edge {
    x: f32,
    depth: f32,
}

struct Search {
    x: f32,
    depths: vec2<f32>,
    a: f32,
    b: f32,
}

struct Surface {
    source: f32,
    depth: f32,
    hole: bool,
}

struct Beside {
    edge: f32,
    edge_depth: f32,
    rim: f32,
    rim_depth: f32,
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

@group(0) @binding(0) 
var depth_map_texture: texture_2d<f32>;
@group(0) @binding(5) 
var nearest_sampler: sampler;
@group(0) @binding(1) 
var color_map_texture: texture_2d<f32>;
@group(0) @binding(6) 
var linear_sampler: sampler;
@group(0) @binding(4) 
var<uniform> synthesis: Synthesis;
var<private> gl_FragCoord_1: vec4<f32>;
@group(0) @binding(3) 
var span_map_texture: texture_2d<u32>;
var<private> span_at_1: vec2<f32>;
@group(0) @binding(2) 
var tile_map_texture: texture_2d<u32>;
var<private> color_2: vec4<f32>;

fn nearest_of(texel: ptr<function, vec4<f32>>) -> f32 {
    let _e3 = (*texel)[0u];
    return _e3;
}

fn depth_sample(place: ptr<function, vec2<f32>>) -> f32 {
    var param: vec4<f32>;

    let _e5 = (*place);
    let _e6 = textureSampleLevel(depth_map_texture, nearest_sampler, _e5, 0f);
    param = _e6;
    let _e7 = nearest_of((&param));
    return _e7;
}

fn place_of(at: ptr<function, vec2<f32>>) -> vec2<f32> {
    var local: vec2<f32>;

    if true {
        let _e8 = (*at);
        let _e10 = synthesis.source_size;
        local = clamp(_e8, vec2<f32>(0.5f, 0.5f), (vec2<f32>(_e10) - vec2(0.5f)));
    } else {
        let _e15 = (*at);
        local = _e15;
    }
    let _e16 = local;
    (*at) = _e16;
    let _e19 = synthesis.columns[0u];
    let _e21 = (*at)[0u];
    let _e25 = synthesis.columns[1u];
    let _e29 = synthesis.source_origin[1u];
    let _e32 = (*at)[1u];
    let _e36 = synthesis.texel[1u];
    return vec2<f32>(((_e19 * _e21) + _e25), ((f32(_e29) + _e32) * _e36));
}

fn row_at(away: ptr<function, f32>) -> f32 {
    var local_1: f32;
    var param_1: vec2<f32>;

    if true {
        let _e10 = gl_FragCoord_1[1u];
        let _e12 = synthesis.first_row;
        let _e14 = (*away);
        param_1 = vec2<f32>(0.5f, ((_e10 - _e12) + _e14));
        let _e17 = place_of((&param_1));
        local_1 = _e17.y;
    } else {
        let _e21 = synthesis.rows[0u];
        let _e23 = gl_FragCoord_1[1u];
        let _e24 = (*away);
        let _e29 = synthesis.rows[1u];
        local_1 = ((_e21 * (_e23 + _e24)) + _e29);
    }
    let _e31 = local_1;
    return _e31;
}

fn column_at(x: ptr<function, f32>) -> f32 {
    var param_2: vec2<f32>;

    let _e3 = (*x);
    param_2 = vec2<f32>((_e3 + 0.5f), 0.5f);
    let _e6 = place_of((&param_2));
    return _e6.x;
}

fn ends_in_row(surface: ptr<function, Surface>) -> bool {
    var column: f32;
    var param_3: f32;
    var above: f32;
    var param_4: f32;
    var param_5: vec2<f32>;
    var below: f32;
    var param_6: f32;
    var param_7: vec2<f32>;

    let _e15 = (*surface).source;
    param_3 = floor(_e15);
    let _e17 = column_at((&param_3));
    column = _e17;
    let _e20 = synthesis.law[1u];
    let _e21 = column;
    param_4 = 1f;
    let _e22 = row_at((&param_4));
    param_5 = vec2<f32>(_e21, _e22);
    let _e24 = depth_sample((&param_5));
    above = (_e20 * _e24);
    let _e28 = synthesis.law[1u];
    let _e29 = column;
    param_6 = -1f;
    let _e30 = row_at((&param_6));
    param_7 = vec2<f32>(_e29, _e30);
    let _e32 = depth_sample((&param_7));
    below = (_e28 * _e32);
    let _e36 = synthesis.law[1u];
    let _e38 = (*surface).depth;
    let _e40 = above;
    let _e41 = below;
    return (((_e36 * _e38) - min(_e40, _e41)) > 4f);
}

fn is_outermost(x_1: ptr<function, f32>, depths: ptr<function, vec2<f32>>, shows_next: ptr<function, bool>) -> bool {
    var before: f32;
    var param_8: f32;
    var param_9: f32;
    var param_10: vec2<f32>;
    var after: f32;
    var param_11: f32;
    var param_12: f32;
    var param_13: vec2<f32>;
    var pixel: f32;
    var phi_661_: bool;
    var phi_662_: bool;

    let _e18 = (*x_1);
    param_8 = (_e18 - 1f);
    let _e20 = column_at((&param_8));
    param_9 = 0f;
    let _e21 = row_at((&param_9));
    param_10 = vec2<f32>(_e20, _e21);
    let _e23 = depth_sample((&param_10));
    before = _e23;
    let _e24 = (*x_1);
    param_11 = (_e24 + 2f);
    let _e26 = column_at((&param_11));
    param_12 = 0f;
    let _e27 = row_at((&param_12));
    param_13 = vec2<f32>(_e26, _e27);
    let _e29 = depth_sample((&param_13));
    after = _e29;
    pixel = 1f;
    let _e32 = synthesis.law[1u];
    let _e34 = (*depths)[0u];
    let _e35 = before;
    let _e38 = pixel;
    let _e39 = ((_e32 * (_e34 - _e35)) >= _e38);
    phi_662_ = _e39;
    if !(_e39) {
        let _e41 = (*shows_next);
        phi_661_ = _e41;
        if _e41 {
            let _e44 = synthesis.law[1u];
            let _e46 = (*depths)[1u];
            let _e47 = after;
            let _e50 = pixel;
            phi_661_ = ((_e44 * (_e46 - _e47)) > _e50);
        }
        let _e53 = phi_661_;
        phi_662_ = _e53;
    }
    let _e55 = phi_662_;
    return _e55;
}

fn color_sample(place_1: ptr<function, vec2<f32>>) -> vec4<f32> {
    let _e4 = (*place_1);
    let _e5 = textureSampleLevel(color_map_texture, linear_sampler, _e4, 0f);
    return _e5;
}

fn tap_beside(edge: ptr<function, Edge>, distance_: ptr<function, f32>, nearer: ptr<function, f32>) -> vec4<f32> {
    var place_2: vec2<f32>;
    var param_14: f32;
    var param_15: f32;
    var param_16: vec2<f32>;
    var param_17: vec2<f32>;

    let _e11 = (*edge).x;
    param_14 = _e11;
    let _e12 = column_at((&param_14));
    let _e13 = (*distance_);
    param_15 = _e13;
    let _e14 = row_at((&param_15));
    place_2 = vec2<f32>(_e12, _e14);
    let _e18 = synthesis.law[1u];
    let _e19 = place_2;
    param_16 = _e19;
    let _e20 = depth_sample((&param_16));
    let _e22 = (*edge).depth;
    (*nearer) = (_e18 * (_e20 - _e22));
    let _e25 = place_2;
    param_17 = _e25;
    let _e26 = color_sample((&param_17));
    return _e26;
}

fn fill_hole(edge_1: ptr<function, Edge>, color: ptr<function, vec4<f32>>, away_1: ptr<function, f32>) -> vec4<f32> {
    var spread: f32;
    var sum: vec4<f32>;
    var weights: f32;
    var i: i32;
    var distance_1: f32;
    var below_1: vec4<f32>;
    var nearer_1: vec2<f32>;
    var param_18: Edge;
    var param_19: f32;
    var param_20: f32;
    var above_1: vec4<f32>;
    var param_21: Edge;
    var param_22: f32;
    var param_23: f32;
    var weight: vec2<f32>;

    let _e28 = (*away_1);
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
            param_18 = _e43;
            param_19 = -(_e41);
            let _e44 = tap_beside((&param_18), (&param_19), (&param_20));
            let _e45 = param_20;
            nearer_1[0u] = _e45;
            below_1 = _e44;
            let _e47 = (*edge_1);
            param_21 = _e47;
            let _e48 = distance_1;
            param_22 = _e48;
            let _e49 = tap_beside((&param_21), (&param_22), (&param_23));
            let _e50 = param_23;
            nearer_1[1u] = _e50;
            above_1 = _e49;
            let _e52 = nearer_1;
            weight = select(vec2<f32>(0f, 0f), vec2<f32>(1f, 1f), (_e52 <= vec2<f32>(1f, 1f)));
            let _e56 = weight[0u];
            let _e57 = below_1;
            let _e60 = weight[1u];
            let _e61 = above_1;
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

fn depth_gather(place_3: ptr<function, vec2<f32>>) -> vec4<f32> {
    var quad: vec4<f32>;

    let _e4 = (*place_3);
    let _e5 = textureGather(0, depth_map_texture, nearest_sampler, _e4);
    quad = _e5;
    let _e6 = quad;
    return _e6;
}

fn depth_pair(x_2: ptr<function, f32>) -> vec2<f32> {
    var row: f32;
    var param_24: f32;
    var param_25: f32;
    var param_26: vec2<f32>;
    var param_27: f32;
    var param_28: vec2<f32>;
    var quad_1: vec4<f32>;
    var param_29: f32;
    var param_30: vec2<f32>;
    var local_2: vec2<f32>;

    if true {
        param_24 = 0f;
        let _e19 = row_at((&param_24));
        row = _e19;
        let _e20 = (*x_2);
        param_25 = _e20;
        let _e21 = column_at((&param_25));
        let _e22 = row;
        param_26 = vec2<f32>(_e21, _e22);
        let _e24 = depth_sample((&param_26));
        let _e25 = (*x_2);
        param_27 = (_e25 + 1f);
        let _e27 = column_at((&param_27));
        let _e28 = row;
        param_28 = vec2<f32>(_e27, _e28);
        let _e30 = depth_sample((&param_28));
        return vec2<f32>(_e24, _e30);
    }
    let _e34 = synthesis.columns[0u];
    let _e35 = (*x_2);
    let _e40 = synthesis.columns[1u];
    param_29 = 0.25f;
    let _e42 = row_at((&param_29));
    param_30 = vec2<f32>(((_e34 * (_e35 + 1.25f)) + _e40), _e42);
    let _e44 = depth_gather((&param_30));
    quad_1 = _e44;
    let _e46 = synthesis.mirrored;
    if (_e46 != 0u) {
        let _e48 = quad_1;
        local_2 = _e48.zw;
    } else {
        let _e50 = quad_1;
        local_2 = _e50.wz;
    }
    let _e52 = local_2;
    return _e52;
}

fn search_at(x_3: ptr<function, f32>, origin: ptr<function, f32>) -> Search {
    var depths_1: vec2<f32>;
    var param_31: f32;
    var shift: f32;

    let _e9 = (*x_3);
    param_31 = _e9;
    let _e10 = depth_pair((&param_31));
    depths_1 = _e10;
    let _e11 = (*x_3);
    let _e12 = (*origin);
    shift = (_e11 - _e12);
    let _e14 = (*x_3);
    let _e15 = depths_1;
    let _e16 = shift;
    let _e19 = synthesis.law[1u];
    let _e21 = depths_1[0u];
    let _e24 = shift;
    let _e28 = synthesis.law[1u];
    let _e30 = depths_1[1u];
    return Search(_e14, _e15, (_e16 + (_e19 * _e21)), ((_e24 + 1f) + (_e28 * _e30)));
}

fn lowest_bit(bits: ptr<function, u32>) -> f32 {
    let _e1 = (*bits);
    return f32(firstTrailingBit(_e1));
}

fn segment_end(x_4: ptr<function, f32>, tile_row: ptr<function, i32>, below_2: ptr<function, bool>, shift_1: ptr<function, u32>) -> f32 {
    var column_1: u32;
    var within: u32;
    var tile: vec4<u32>;
    var marks: u32;
    var local_3: u32;
    var param_32: u32;

    let _e19 = (*x_4);
    column_1 = u32(_e19);
    let _e21 = column_1;
    within = (_e21 % 16u);
    let _e23 = column_1;
    let _e26 = (*tile_row);
    let _e28 = textureLoad(tile_map_texture, vec2<i32>(bitcast<i32>((_e23 / 16u)), _e26), 0i);
    tile = _e28;
    let _e29 = (*below_2);
    if _e29 {
        let _e31 = tile[1u];
        local_3 = _e31;
    } else {
        let _e33 = tile[3u];
        local_3 = _e33;
    }
    let _e34 = local_3;
    let _e35 = (*shift_1);
    let _e36 = within;
    marks = (_e34 >> bitcast<u32>((_e35 + _e36)));
    let _e41 = tile[2u];
    let _e44 = marks;
    marks = select(0u, _e44, (_e41 == bitcast<u32>(9f)));
    let _e46 = (*x_4);
    let _e47 = marks;
    let _e48 = within;
    param_32 = (_e47 | (65536u >> bitcast<u32>(_e48)));
    let _e52 = lowest_bit((&param_32));
    return (_e46 + _e52);
}

fn meet(beside: ptr<function, Beside>, at_1: ptr<function, Search>) -> bool {
    var jump: bool;
    var torn: bool;
    var rim: bool;
    var local_4: f32;
    var local_5: f32;
    var local_6: f32;
    var farther: bool;
    var local_7: f32;
    var local_8: f32;
    var phi_693_: bool;
    var phi_694_: bool;
    var phi_695_: bool;
    var phi_742_: bool;
    var phi_775_: bool;

    let _e19 = (*at_1).b;
    jump = (_e19 > 0f);
    let _e22 = (*at_1).b;
    let _e24 = (*at_1).a;
    torn = ((_e22 - _e24) >= 2f);
    let _e28 = (*beside).rim;
    let _e29 = (_e28 < 0f);
    phi_695_ = _e29;
    if _e29 {
        let _e30 = jump;
        let _e31 = !(_e30);
        phi_694_ = _e31;
        if !(_e31) {
            let _e33 = torn;
            phi_693_ = _e33;
            if _e33 {
                let _e35 = (*at_1).b;
                phi_693_ = (_e35 < 1f);
            }
            let _e38 = phi_693_;
            phi_694_ = _e38;
        }
        let _e40 = phi_694_;
        phi_695_ = _e40;
    }
    let _e42 = phi_695_;
    rim = _e42;
    let _e43 = rim;
    if _e43 {
        let _e45 = (*at_1).x;
        let _e46 = jump;
        local_4 = (_e45 + select(0f, 1f, _e46));
    } else {
        let _e50 = (*beside).rim;
        local_4 = _e50;
    }
    let _e51 = local_4;
    (*beside).rim = _e51;
    let _e53 = rim;
    if _e53 {
        let _e54 = jump;
        if _e54 {
            let _e57 = (*at_1).depths[1u];
            local_6 = _e57;
        } else {
            let _e60 = (*at_1).depths[0u];
            local_6 = _e60;
        }
        let _e61 = local_6;
        local_5 = _e61;
    } else {
        let _e63 = (*beside).rim_depth;
        local_5 = _e63;
    }
    let _e64 = local_5;
    (*beside).rim_depth = _e64;
    let _e66 = jump;
    phi_742_ = _e66;
    if _e66 {
        let _e69 = synthesis.law[1u];
        let _e72 = (*at_1).depths[0u];
        let _e74 = (*beside).edge_depth;
        phi_742_ = ((_e69 * (_e72 - _e74)) < 0f);
    }
    let _e79 = phi_742_;
    farther = _e79;
    let _e80 = farther;
    if _e80 {
        let _e82 = (*at_1).x;
        local_7 = _e82;
    } else {
        let _e84 = (*beside).edge;
        local_7 = _e84;
    }
    let _e85 = local_7;
    (*beside).edge = _e85;
    let _e87 = farther;
    if _e87 {
        let _e90 = (*at_1).depths[0u];
        local_8 = _e90;
    } else {
        let _e92 = (*beside).edge_depth;
        local_8 = _e92;
    }
    let _e93 = local_8;
    (*beside).edge_depth = _e93;
    let _e95 = jump;
    phi_775_ = _e95;
    if _e95 {
        let _e97 = (*at_1).a;
        let _e99 = torn;
        phi_775_ = ((_e97 > -0.5f) || !(_e99));
    }
    let _e103 = phi_775_;
    return _e103;
}

fn is_event(a: ptr<function, f32>, b: ptr<function, f32>) -> bool {
    var phi_518_: bool;
    var phi_519_: bool;

    let _e4 = (*a);
    let _e5 = (_e4 <= 0f);
    phi_519_ = _e5;
    if _e5 {
        let _e6 = (*b);
        let _e7 = (_e6 > 0f);
        phi_518_ = _e7;
        if !(_e7) {
            let _e9 = (*b);
            let _e11 = (*a);
            phi_518_ = (max(_e9, -1f) < _e11);
        }
        let _e14 = phi_518_;
        phi_519_ = _e14;
    }
    let _e16 = phi_519_;
    return _e16;
}

fn march(at_2: ptr<function, Search>, end: ptr<function, f32>, origin_1: ptr<function, f32>, row_1: ptr<function, i32>, surface_1: ptr<function, Surface>) -> vec4<f32> {
    var border: f32;
    var outside: bool;
    var beside_1: Beside;
    var local_9: f32;
    var found: bool;
    var param_33: f32;
    var param_34: f32;
    var param_35: Beside;
    var param_36: Search;
    var x_5: f32;
    var a_1: f32;
    var tile_row_1: i32;
    var below_3: bool;
    var shift_2: u32;
    var crosses: bool;
    var param_37: f32;
    var param_38: i32;
    var param_39: bool;
    var param_40: u32;
    var param_41: f32;
    var param_42: f32;
    var param_43: f32;
    var param_44: f32;
    var param_45: Beside;
    var param_46: Search;
    var local_10: f32;
    var local_11: f32;
    var last: f32;
    var b_1: f32;
    var param_47: f32;
    var param_48: f32;
    var behind: bool;
    var local_12: f32;
    var local_13: f32;
    var local_14: f32;
    var local_15: f32;
    var own: bool;
    var local_16: f32;
    var t: f32;
    var local_17: f32;
    var local_18: f32;
    var away_2: f32;
    var shows_next_1: bool;
    var param_49: f32;
    var param_50: vec2<f32>;
    var param_51: bool;
    var color_1: vec4<f32>;
    var param_52: f32;
    var param_53: f32;
    var param_54: vec2<f32>;
    var param_55: Edge;
    var param_56: vec4<f32>;
    var param_57: f32;
    var coverage: f32;
    var param_58: f32;
    var param_59: f32;
    var param_60: vec2<f32>;
    var phi_828_: bool;
    var phi_838_: bool;
    var phi_908_: bool;
    var phi_918_: bool;
    var phi_928_: bool;
    var phi_1001_: bool;
    var phi_1051_: bool;
    var phi_1074_: bool;
    var phi_1125_: bool;
    var phi_1142_: bool;
    var phi_1158_: bool;
    var phi_1159_: bool;

    let _e79 = (*at_2).a;
    let _e81 = (*at_2).x;
    border = (_e79 - _e81);
    let _e84 = (*at_2).x;
    let _e86 = border;
    outside = ((_e84 <= 0f) && (_e86 > 0f));
    let _e89 = outside;
    let _e90 = border;
    let _e93 = (*end);
    (*end) = select(_e93, 0f, (_e89 && (_e90 < 0.5f)));
    let _e95 = outside;
    beside_1.edge = select(-1f, 0f, _e95);
    let _e98 = outside;
    if _e98 {
        let _e101 = (*at_2).depths[0u];
        local_9 = _e101;
    } else {
        let _e104 = synthesis.law[1u];
        local_9 = select(1000000000f, -1000000000f, (_e104 < 0f));
    }
    let _e107 = local_9;
    beside_1.edge_depth = _e107;
    beside_1.rim = -1f;
    beside_1.rim_depth = 0f;
    found = false;
    let _e112 = (*at_2).x;
    let _e113 = (_e112 >= 0f);
    phi_828_ = _e113;
    if _e113 {
        let _e115 = (*at_2).x;
        let _e116 = (*end);
        phi_828_ = (_e115 < _e116);
    }
    let _e119 = phi_828_;
    phi_838_ = _e119;
    if _e119 {
        let _e121 = (*at_2).a;
        param_33 = _e121;
        let _e123 = (*at_2).b;
        param_34 = _e123;
        let _e124 = is_event((&param_33), (&param_34));
        phi_838_ = _e124;
    }
    let _e126 = phi_838_;
    if _e126 {
        let _e127 = beside_1;
        param_35 = _e127;
        let _e128 = (*at_2);
        param_36 = _e128;
        let _e129 = meet((&param_35), (&param_36));
        let _e130 = param_35;
        beside_1 = _e130;
        found = _e129;
    }
    let _e132 = (*at_2).x;
    x_5 = max((_e132 + 1f), 0f);
    let _e136 = (*at_2).b;
    let _e137 = x_5;
    let _e139 = (*at_2).x;
    a_1 = (_e136 + ((_e137 - _e139) - 1f));
    let _e143 = (*row_1);
    tile_row_1 = (_e143 / 8i);
    let _e145 = (*row_1);
    below_3 = ((_e145 & 4i) == 0i);
    let _e148 = (*row_1);
    shift_2 = (bitcast<u32>((_e148 & 2i)) << bitcast<u32>(3i));
    crosses = false;
    loop {
        let _e153 = x_5;
        let _e154 = (*end);
        let _e156 = found;
        if ((_e153 <= _e154) && !(_e156)) {
            let _e159 = x_5;
            param_37 = _e159;
            let _e160 = tile_row_1;
            param_38 = _e160;
            let _e161 = below_3;
            param_39 = _e161;
            let _e162 = shift_2;
            param_40 = _e162;
            let _e163 = segment_end((&param_37), (&param_38), (&param_39), (&param_40));
            let _e164 = (*end);
            param_41 = min(_e163, _e164);
            let _e166 = (*origin_1);
            param_42 = _e166;
            let _e167 = search_at((&param_41), (&param_42));
            (*at_2) = _e167;
            let _e168 = a_1;
            let _e169 = (_e168 <= 0f);
            phi_908_ = _e169;
            if _e169 {
                let _e171 = (*at_2).a;
                phi_908_ = (_e171 > 0f);
            }
            let _e174 = phi_908_;
            crosses = _e174;
            let _e175 = crosses;
            found = _e175;
            let _e176 = crosses;
            let _e177 = !(_e176);
            phi_918_ = _e177;
            if _e177 {
                let _e179 = (*at_2).x;
                let _e180 = (*end);
                phi_918_ = (_e179 < _e180);
            }
            let _e183 = phi_918_;
            phi_928_ = _e183;
            if _e183 {
                let _e185 = (*at_2).a;
                param_43 = _e185;
                let _e187 = (*at_2).b;
                param_44 = _e187;
                let _e188 = is_event((&param_43), (&param_44));
                phi_928_ = _e188;
            }
            let _e190 = phi_928_;
            if _e190 {
                let _e191 = beside_1;
                param_45 = _e191;
                let _e192 = (*at_2);
                param_46 = _e192;
                let _e193 = meet((&param_45), (&param_46));
                let _e194 = param_45;
                beside_1 = _e194;
                found = _e193;
            }
            let _e195 = found;
            if _e195 {
                let _e196 = x_5;
                local_10 = _e196;
            } else {
                let _e198 = (*at_2).x;
                local_10 = (_e198 + 1f);
            }
            let _e200 = local_10;
            x_5 = _e200;
            let _e201 = found;
            if _e201 {
                let _e202 = a_1;
                local_11 = _e202;
            } else {
                let _e204 = (*at_2).b;
                local_11 = _e204;
            }
            let _e205 = local_11;
            a_1 = _e205;
            continue;
        } else {
            break;
        }
    }
    let _e207 = (*at_2).x;
    last = _e207;
    let _e209 = (*at_2).a;
    b_1 = _e209;
    loop {
        let _e210 = crosses;
        let _e211 = x_5;
        let _e212 = last;
        if (_e210 && (_e211 < _e212)) {
            let _e215 = x_5;
            let _e216 = last;
            let _e217 = x_5;
            let _e219 = a_1;
            let _e221 = a_1;
            let _e222 = b_1;
            let _e227 = x_5;
            let _e228 = last;
            param_47 = clamp(floor((_e215 + (((_e216 - _e217) * _e219) / (_e221 - _e222)))), _e227, (_e228 - 1f));
            let _e231 = (*origin_1);
            param_48 = _e231;
            let _e232 = search_at((&param_47), (&param_48));
            (*at_2) = _e232;
            let _e234 = (*at_2).a;
            let _e235 = (_e234 > 0f);
            phi_1001_ = _e235;
            if !(_e235) {
                let _e238 = (*at_2).b;
                phi_1001_ = (_e238 <= 0f);
            }
            let _e241 = phi_1001_;
            crosses = _e241;
            let _e243 = (*at_2).a;
            behind = (_e243 > 0f);
            let _e245 = behind;
            if _e245 {
                let _e246 = x_5;
                local_12 = _e246;
            } else {
                let _e248 = (*at_2).x;
                local_12 = (_e248 + 1f);
            }
            let _e250 = local_12;
            x_5 = _e250;
            let _e251 = behind;
            if _e251 {
                let _e252 = a_1;
                local_13 = _e252;
            } else {
                let _e254 = (*at_2).b;
                local_13 = _e254;
            }
            let _e255 = local_13;
            a_1 = _e255;
            let _e256 = behind;
            if _e256 {
                let _e258 = (*at_2).x;
                local_14 = _e258;
            } else {
                let _e259 = last;
                local_14 = _e259;
            }
            let _e260 = local_14;
            last = _e260;
            let _e261 = behind;
            if _e261 {
                let _e263 = (*at_2).a;
                local_15 = _e263;
            } else {
                let _e264 = b_1;
                local_15 = _e264;
            }
            let _e265 = local_15;
            b_1 = _e265;
            continue;
        } else {
            break;
        }
    }
    let _e266 = found;
    phi_1051_ = _e266;
    if !(_e266) {
        let _e269 = beside_1.edge;
        phi_1051_ = (_e269 < 0f);
    }
    let _e272 = phi_1051_;
    own = _e272;
    let _e273 = own;
    if _e273 {
        let _e275 = (*at_2).x;
        let _e276 = (*end);
        local_16 = min(_e275, _e276);
    } else {
        let _e279 = beside_1.edge;
        local_16 = _e279;
    }
    let _e280 = local_16;
    x_5 = _e280;
    let _e281 = found;
    phi_1074_ = _e281;
    if _e281 {
        let _e283 = (*at_2).b;
        let _e285 = (*at_2).a;
        phi_1074_ = ((_e283 - _e285) < 2f);
    }
    let _e289 = phi_1074_;
    if _e289 {
        let _e291 = (*at_2).a;
        let _e294 = (*at_2).b;
        let _e296 = (*at_2).a;
        local_17 = (-(_e291) / (_e294 - _e296));
    } else {
        local_17 = 0f;
    }
    let _e299 = local_17;
    t = _e299;
    let _e300 = x_5;
    let _e301 = t;
    (*surface_1).source = (_e300 + _e301);
    let _e304 = own;
    if _e304 {
        let _e307 = (*at_2).depths[0u];
        let _e310 = (*at_2).depths[1u];
        let _e311 = t;
        local_18 = mix(_e307, _e310, _e311);
    } else {
        let _e314 = beside_1.edge_depth;
        local_18 = _e314;
    }
    let _e315 = local_18;
    (*surface_1).depth = _e315;
    let _e317 = x_5;
    let _e318 = (*origin_1);
    let _e322 = synthesis.law[1u];
    let _e324 = (*surface_1).depth;
    away_2 = ((_e317 - _e318) + (_e322 * _e324));
    let _e327 = found;
    let _e328 = !(_e327);
    phi_1125_ = _e328;
    if _e328 {
        let _e329 = away_2;
        phi_1125_ = (abs(_e329) >= 0.5f);
    }
    let _e333 = phi_1125_;
    (*surface_1).hole = _e333;
    let _e336 = (*at_2).b;
    let _e338 = (*at_2).a;
    shows_next_1 = ((_e336 - _e338) < 2f);
    let _e342 = (*surface_1).hole;
    phi_1142_ = _e342;
    if !(_e342) {
        let _e345 = beside_1.rim;
        phi_1142_ = (_e345 >= 0f);
    }
    let _e348 = phi_1142_;
    phi_1159_ = _e348;
    if !(_e348) {
        let _e350 = found;
        phi_1158_ = _e350;
        if _e350 {
            let _e352 = (*at_2).x;
            param_49 = _e352;
            let _e354 = (*at_2).depths;
            param_50 = _e354;
            let _e355 = shows_next_1;
            param_51 = _e355;
            let _e356 = is_outermost((&param_49), (&param_50), (&param_51));
            phi_1158_ = _e356;
        }
        let _e358 = phi_1158_;
        phi_1159_ = _e358;
    }
    let _e360 = phi_1159_;
    if _e360 {
        discard;
    }
    let _e362 = (*surface_1).source;
    param_52 = _e362;
    let _e363 = column_at((&param_52));
    param_53 = 0f;
    let _e364 = row_at((&param_53));
    param_54 = vec2<f32>(_e363, _e364);
    let _e366 = color_sample((&param_54));
    color_1 = _e366;
    let _e368 = (*surface_1).hole;
    if _e368 {
        let _e369 = x_5;
        let _e371 = (*surface_1).depth;
        param_55 = Edge(_e369, _e371);
        let _e373 = color_1;
        param_56 = _e373;
        let _e374 = away_2;
        param_57 = _e374;
        let _e375 = fill_hole((&param_55), (&param_56), (&param_57));
        color_1 = _e375;
    }
    let _e377 = beside_1.rim;
    if (_e377 >= 0f) {
        let _e380 = beside_1.rim;
        let _e381 = (*origin_1);
        let _e385 = synthesis.law[1u];
        let _e387 = beside_1.rim_depth;
        coverage = (1f - abs(((_e380 - _e381) + (_e385 * _e387))));
        let _e392 = color_1;
        let _e394 = beside_1.rim;
        param_58 = _e394;
        let _e395 = column_at((&param_58));
        param_59 = 0f;
        let _e396 = row_at((&param_59));
        param_60 = vec2<f32>(_e395, _e396);
        let _e398 = color_sample((&param_60));
        let _e399 = coverage;
        color_1 = mix(_e392, _e398, vec4(_e399));
        let _e402 = coverage;
        if (_e402 >= 0.5f) {
            let _e405 = beside_1.rim;
            let _e407 = beside_1.rim_depth;
            (*surface_1) = Surface(_e405, _e407, false);
        }
    }
    let _e409 = color_1;
    return _e409;
}

fn source_row() -> i32 {
    let _e6 = gl_FragCoord_1[1u];
    let _e8 = synthesis.first_row;
    let _e12 = synthesis.source_size[1u];
    return i32(clamp((_e6 - _e8), 0f, f32((_e12 - 1i))));
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

fn searched(span_1: ptr<function, u32>, surface_2: ptr<function, Surface>) -> vec4<f32> {
    var origin_2: f32;
    var at_3: Search;
    var param_61: f32;
    var param_62: f32;
    var end_1: f32;
    var param_63: u32;
    var limit: f32;
    var next: f32;
    var param_64: f32;
    var param_65: f32;
    var param_66: vec2<f32>;
    var stretch: f32;
    var t_1: f32;
    var seen: vec4<f32>;
    var param_67: f32;
    var param_68: f32;
    var param_69: vec2<f32>;
    var middle: f32;
    var done: bool;
    var param_70: Search;
    var param_71: f32;
    var param_72: f32;
    var param_73: i32;
    var param_74: Surface;
    var param_75: f32;
    var param_76: vec2<f32>;
    var param_77: bool;
    var phi_1375_: bool;
    var phi_1384_: bool;
    var phi_1467_: bool;
    var phi_1480_: bool;

    let _e43 = synthesis.origins[0u];
    let _e45 = gl_FragCoord_1[0u];
    let _e49 = synthesis.origins[1u];
    origin_2 = ((_e43 * _e45) + _e49);
    let _e51 = origin_2;
    let _e53 = synthesis.farthest;
    let _e55 = (*span_1);
    param_61 = floor(((_e51 - _e53) - bitcast<f32>(_e55)));
    let _e59 = origin_2;
    param_62 = _e59;
    let _e60 = search_at((&param_61), (&param_62));
    at_3 = _e60;
    let _e62 = at_3.x;
    let _e64 = (*span_1);
    param_63 = _e64;
    let _e65 = span_steps((&param_63));
    let _e69 = synthesis.source_size[0u];
    end_1 = min((max(_e62, 0f) + _e65), f32((_e69 - 1i)));
    let _e74 = at_3.x;
    let _e76 = end_1;
    limit = min((_e74 + 2f), _e76);
    loop {
        let _e79 = at_3.x;
        let _e80 = limit;
        let _e81 = (_e79 < _e80);
        phi_1375_ = _e81;
        if _e81 {
            let _e83 = at_3.b;
            phi_1375_ = (_e83 <= 0f);
        }
        let _e86 = phi_1375_;
        phi_1384_ = _e86;
        if _e86 {
            let _e88 = at_3.b;
            let _e91 = at_3.a;
            phi_1384_ = (max(_e88, -1f) >= _e91);
        }
        let _e94 = phi_1384_;
        if _e94 {
            let _e96 = at_3.x;
            param_64 = (_e96 + 2f);
            let _e98 = column_at((&param_64));
            param_65 = 0f;
            let _e99 = row_at((&param_65));
            param_66 = vec2<f32>(_e98, _e99);
            let _e101 = depth_sample((&param_66));
            next = _e101;
            let _e104 = at_3.depths[1u];
            let _e105 = next;
            at_3.depths = vec2<f32>(_e104, _e105);
            let _e109 = at_3.b;
            at_3.a = _e109;
            let _e112 = at_3.x;
            let _e114 = origin_2;
            let _e118 = synthesis.law[1u];
            let _e119 = next;
            at_3.b = (((_e112 + 2f) - _e114) + (_e118 * _e119));
            continue;
        } else {
            break;
        }
        continuing {
            let _e124 = at_3.x;
            at_3.x = (_e124 + 1f);
        }
    }
    let _e128 = at_3.b;
    let _e130 = at_3.a;
    stretch = (_e128 - _e130);
    let _e133 = at_3.a;
    let _e135 = stretch;
    t_1 = (-(_e133) / _e135);
    let _e138 = at_3.x;
    let _e139 = t_1;
    let _e143 = at_3.depths[0u];
    let _e146 = at_3.depths[1u];
    let _e147 = t_1;
    (*surface_2) = Surface((_e138 + _e139), mix(_e143, _e146, _e147), false);
    let _e151 = (*surface_2).source;
    param_67 = _e151;
    let _e152 = column_at((&param_67));
    param_68 = 0f;
    let _e153 = row_at((&param_68));
    param_69 = vec2<f32>(_e152, _e153);
    let _e155 = color_sample((&param_69));
    seen = _e155;
    let _e158 = synthesis.source_size[0u];
    middle = (0.5f * f32((_e158 - 1i)));
    let _e163 = at_3.a;
    let _e164 = (_e163 <= 0f);
    phi_1467_ = _e164;
    if _e164 {
        let _e166 = at_3.b;
        phi_1467_ = (_e166 > 0f);
    }
    let _e169 = phi_1467_;
    let _e170 = stretch;
    let _e172 = (_e169 && (_e170 < 2f));
    phi_1480_ = _e172;
    if _e172 {
        let _e174 = (*surface_2).source;
        let _e175 = middle;
        let _e178 = middle;
        phi_1480_ = (abs((_e174 - _e175)) <= _e178);
    }
    let _e181 = phi_1480_;
    done = _e181;
    let _e182 = done;
    if !(_e182) {
        let _e184 = source_row();
        let _e185 = at_3;
        param_70 = _e185;
        let _e186 = end_1;
        param_71 = _e186;
        let _e187 = origin_2;
        param_72 = _e187;
        param_73 = _e184;
        let _e188 = march((&param_70), (&param_71), (&param_72), (&param_73), (&param_74));
        let _e189 = param_74;
        (*surface_2) = _e189;
        seen = _e188;
    } else {
        let _e191 = at_3.x;
        param_75 = _e191;
        let _e193 = at_3.depths;
        param_76 = _e193;
        param_77 = true;
        let _e194 = is_outermost((&param_75), (&param_76), (&param_77));
        if _e194 {
            discard;
        }
    }
    let _e195 = seen;
    return _e195;
}

fn sample_planar(affine: ptr<function, vec3<f32>>, surface_3: ptr<function, Surface>) -> vec4<f32> {
    var place_4: f32;
    var depths_2: vec2<f32>;
    var param_78: f32;
    var at_4: vec2<f32>;
    var param_79: f32;
    var param_80: vec2<f32>;

    let _e18 = (*affine)[0u];
    let _e20 = (*affine)[1u];
    let _e22 = gl_FragCoord_1[0u];
    let _e26 = (*affine)[2u];
    let _e28 = gl_FragCoord_1[1u];
    place_4 = ((_e18 + (_e20 * _e22)) + (_e26 * _e28));
    let _e31 = place_4;
    let _e34 = synthesis.columns[1u];
    let _e38 = synthesis.columns[0u];
    let _e43 = synthesis.source_size[0u];
    (*surface_3).source = clamp((((_e31 - _e34) / _e38) - 0.5f), 0f, f32((_e43 - 1i)));
    let _e50 = synthesis.origins[0u];
    let _e52 = gl_FragCoord_1[0u];
    let _e56 = synthesis.origins[1u];
    let _e59 = (*surface_3).source;
    let _e63 = synthesis.law[1u];
    (*surface_3).depth = ((((_e50 * _e52) + _e56) - _e59) / _e63);
    let _e68 = synthesis.law[1u];
    if (_e68 == 0f) {
        let _e71 = (*surface_3).source;
        param_78 = floor(_e71);
        let _e73 = depth_pair((&param_78));
        depths_2 = _e73;
        let _e75 = depths_2[0u];
        let _e77 = depths_2[1u];
        let _e79 = (*surface_3).source;
        (*surface_3).depth = mix(_e75, _e77, fract(_e79));
    }
    (*surface_3).hole = false;
    let _e84 = place_4;
    param_79 = 0f;
    let _e85 = row_at((&param_79));
    at_4 = vec2<f32>(_e84, _e85);
    let _e87 = at_4;
    param_80 = _e87;
    let _e88 = color_sample((&param_80));
    return _e88;
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
    var span_2: vec4<u32>;
    var surface_4: Surface;
    var param_81: vec3<f32>;
    var param_82: Surface;
    var param_83: u32;
    var param_84: Surface;
    var param_85: Surface;
    var phi_1544_: bool;

    let _e11 = pixel_span();
    span_2 = _e11;
    let _e13 = span_2[1u];
    if (_e13 != 0u) {
        let _e15 = span_2;
        param_81 = bitcast<vec3<f32>>(_e15.xyz);
        let _e18 = sample_planar((&param_81), (&param_82));
        let _e19 = param_82;
        surface_4 = _e19;
        color_2 = _e18;
    } else {
        let _e21 = span_2[0u];
        param_83 = _e21;
        let _e22 = searched((&param_83), (&param_84));
        let _e23 = param_84;
        surface_4 = _e23;
        color_2 = _e22;
    }
    let _e25 = span_2[3u];
    let _e26 = (_e25 != 0u);
    phi_1544_ = _e26;
    if _e26 {
        let _e27 = surface_4;
        param_85 = _e27;
        let _e28 = ends_in_row((&param_85));
        phi_1544_ = _e28;
    }
    let _e30 = phi_1544_;
    if _e30 {
        discard;
    }
    return;
}

@fragment 
fn main(@builtin(position) gl_FragCoord: vec4<f32>, @location(0) span_at: vec2<f32>) -> @location(0) vec4<f32> {
    gl_FragCoord_1 = gl_FragCoord;
    span_at_1 = span_at;
    main_1();
    let _e5 = color_2;
    return _e5;
}
