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

struct Beside {
    edge: f32,
    edge_depth: f32,
    rim: f32,
    rim_depth: f32,
}

struct Surface {
    source: f32,
    depth: f32,
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

struct FragmentOutput {
    @location(0) member: vec4<f32>,
    @builtin(frag_depth) member_1: f32,
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
var<private> gl_FragDepth: f32 = 0f;

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

fn ends_in_row(x_1: ptr<function, f32>, moved: ptr<function, f32>) -> bool {
    var column: f32;
    var param_3: f32;
    var above: f32;
    var param_4: f32;
    var param_5: vec2<f32>;
    var below: f32;
    var param_6: f32;
    var param_7: vec2<f32>;

    let _e15 = (*x_1);
    param_3 = _e15;
    let _e16 = column_at((&param_3));
    column = _e16;
    let _e19 = synthesis.law[1u];
    let _e20 = column;
    param_4 = 1f;
    let _e21 = row_at((&param_4));
    param_5 = vec2<f32>(_e20, _e21);
    let _e23 = depth_sample((&param_5));
    above = (_e19 * _e23);
    let _e27 = synthesis.law[1u];
    let _e28 = column;
    param_6 = -1f;
    let _e29 = row_at((&param_6));
    param_7 = vec2<f32>(_e28, _e29);
    let _e31 = depth_sample((&param_7));
    below = (_e27 * _e31);
    let _e33 = (*moved);
    let _e34 = above;
    let _e35 = below;
    return ((_e33 - min(_e34, _e35)) > 4f);
}

fn is_outermost(x_2: ptr<function, f32>, depths: ptr<function, vec2<f32>>, shows_next: ptr<function, bool>) -> bool {
    var before: f32;
    var param_8: f32;
    var param_9: f32;
    var param_10: vec2<f32>;
    var after: f32;
    var param_11: f32;
    var param_12: f32;
    var param_13: vec2<f32>;
    var pixel: f32;
    var param_14: f32;
    var param_15: f32;
    var phi_656_: bool;
    var phi_657_: bool;
    var phi_670_: bool;

    let _e20 = (*x_2);
    param_8 = (_e20 - 1f);
    let _e22 = column_at((&param_8));
    param_9 = 0f;
    let _e23 = row_at((&param_9));
    param_10 = vec2<f32>(_e22, _e23);
    let _e25 = depth_sample((&param_10));
    before = _e25;
    let _e26 = (*x_2);
    param_11 = (_e26 + 2f);
    let _e28 = column_at((&param_11));
    param_12 = 0f;
    let _e29 = row_at((&param_12));
    param_13 = vec2<f32>(_e28, _e29);
    let _e31 = depth_sample((&param_13));
    after = _e31;
    pixel = 1f;
    let _e34 = synthesis.law[1u];
    let _e36 = (*depths)[0u];
    let _e37 = before;
    let _e40 = pixel;
    let _e41 = ((_e34 * (_e36 - _e37)) >= _e40);
    phi_657_ = _e41;
    if !(_e41) {
        let _e43 = (*shows_next);
        phi_656_ = _e43;
        if _e43 {
            let _e46 = synthesis.law[1u];
            let _e48 = (*depths)[1u];
            let _e49 = after;
            let _e52 = pixel;
            phi_656_ = ((_e46 * (_e48 - _e49)) > _e52);
        }
        let _e55 = phi_656_;
        phi_657_ = _e55;
    }
    let _e57 = phi_657_;
    phi_670_ = _e57;
    if !(_e57) {
        let _e61 = synthesis.law[1u];
        let _e63 = (*depths)[0u];
        let _e65 = (*x_2);
        param_14 = _e65;
        param_15 = (_e61 * _e63);
        let _e66 = ends_in_row((&param_14), (&param_15));
        phi_670_ = _e66;
    }
    let _e68 = phi_670_;
    return _e68;
}

fn color_sample(place_1: ptr<function, vec2<f32>>) -> vec4<f32> {
    let _e4 = (*place_1);
    let _e5 = textureSampleLevel(color_map_texture, linear_sampler, _e4, 0f);
    return _e5;
}

fn tap_beside(edge: ptr<function, Edge>, distance_: ptr<function, f32>, nearer: ptr<function, f32>) -> vec4<f32> {
    var place_2: vec2<f32>;
    var param_16: f32;
    var param_17: f32;
    var param_18: vec2<f32>;
    var param_19: vec2<f32>;

    let _e11 = (*edge).x;
    param_16 = _e11;
    let _e12 = column_at((&param_16));
    let _e13 = (*distance_);
    param_17 = _e13;
    let _e14 = row_at((&param_17));
    place_2 = vec2<f32>(_e12, _e14);
    let _e18 = synthesis.law[1u];
    let _e19 = place_2;
    param_18 = _e19;
    let _e20 = depth_sample((&param_18));
    let _e22 = (*edge).depth;
    (*nearer) = (_e18 * (_e20 - _e22));
    let _e25 = place_2;
    param_19 = _e25;
    let _e26 = color_sample((&param_19));
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
    var param_20: Edge;
    var param_21: f32;
    var param_22: f32;
    var above_1: vec4<f32>;
    var param_23: Edge;
    var param_24: f32;
    var param_25: f32;
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
            param_20 = _e43;
            param_21 = -(_e41);
            let _e44 = tap_beside((&param_20), (&param_21), (&param_22));
            let _e45 = param_22;
            nearer_1[0u] = _e45;
            below_1 = _e44;
            let _e47 = (*edge_1);
            param_23 = _e47;
            let _e48 = distance_1;
            param_24 = _e48;
            let _e49 = tap_beside((&param_23), (&param_24), (&param_25));
            let _e50 = param_25;
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

fn depth_pair(x_3: ptr<function, f32>) -> vec2<f32> {
    var row: f32;
    var param_26: f32;
    var param_27: f32;
    var param_28: vec2<f32>;
    var param_29: f32;
    var param_30: vec2<f32>;
    var quad_1: vec4<f32>;
    var param_31: f32;
    var param_32: vec2<f32>;
    var local_2: vec2<f32>;

    if true {
        param_26 = 0f;
        let _e19 = row_at((&param_26));
        row = _e19;
        let _e20 = (*x_3);
        param_27 = _e20;
        let _e21 = column_at((&param_27));
        let _e22 = row;
        param_28 = vec2<f32>(_e21, _e22);
        let _e24 = depth_sample((&param_28));
        let _e25 = (*x_3);
        param_29 = (_e25 + 1f);
        let _e27 = column_at((&param_29));
        let _e28 = row;
        param_30 = vec2<f32>(_e27, _e28);
        let _e30 = depth_sample((&param_30));
        return vec2<f32>(_e24, _e30);
    }
    let _e34 = synthesis.columns[0u];
    let _e35 = (*x_3);
    let _e40 = synthesis.columns[1u];
    param_31 = 0.25f;
    let _e42 = row_at((&param_31));
    param_32 = vec2<f32>(((_e34 * (_e35 + 1.25f)) + _e40), _e42);
    let _e44 = depth_gather((&param_32));
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

fn search_at(x_4: ptr<function, f32>, origin: ptr<function, f32>) -> Search {
    var depths_1: vec2<f32>;
    var param_33: f32;
    var shift: f32;

    let _e9 = (*x_4);
    param_33 = _e9;
    let _e10 = depth_pair((&param_33));
    depths_1 = _e10;
    let _e11 = (*x_4);
    let _e12 = (*origin);
    shift = (_e11 - _e12);
    let _e14 = (*x_4);
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

fn segment_end(x_5: ptr<function, f32>, tile_row: ptr<function, i32>, below_2: ptr<function, bool>, shift_1: ptr<function, u32>) -> f32 {
    var column_1: u32;
    var within: u32;
    var tile: vec4<u32>;
    var marks: u32;
    var local_3: u32;
    var param_34: u32;

    let _e19 = (*x_5);
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
    let _e46 = (*x_5);
    let _e47 = marks;
    let _e48 = within;
    param_34 = (_e47 | (65536u >> bitcast<u32>(_e48)));
    let _e52 = lowest_bit((&param_34));
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
    var phi_701_: bool;
    var phi_702_: bool;
    var phi_703_: bool;
    var phi_750_: bool;
    var phi_783_: bool;

    let _e19 = (*at_1).b;
    jump = (_e19 > 0f);
    let _e22 = (*at_1).b;
    let _e24 = (*at_1).a;
    torn = ((_e22 - _e24) >= 2f);
    let _e28 = (*beside).rim;
    let _e29 = (_e28 < 0f);
    phi_703_ = _e29;
    if _e29 {
        let _e30 = jump;
        let _e31 = !(_e30);
        phi_702_ = _e31;
        if !(_e31) {
            let _e33 = torn;
            phi_701_ = _e33;
            if _e33 {
                let _e35 = (*at_1).b;
                phi_701_ = (_e35 < 1f);
            }
            let _e38 = phi_701_;
            phi_702_ = _e38;
        }
        let _e40 = phi_702_;
        phi_703_ = _e40;
    }
    let _e42 = phi_703_;
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
    phi_750_ = _e66;
    if _e66 {
        let _e69 = synthesis.law[1u];
        let _e72 = (*at_1).depths[0u];
        let _e74 = (*beside).edge_depth;
        phi_750_ = ((_e69 * (_e72 - _e74)) < 0f);
    }
    let _e79 = phi_750_;
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
    phi_783_ = _e95;
    if _e95 {
        let _e97 = (*at_1).a;
        let _e99 = torn;
        phi_783_ = ((_e97 > -0.5f) || !(_e99));
    }
    let _e103 = phi_783_;
    return _e103;
}

fn is_event(a: ptr<function, f32>, b: ptr<function, f32>) -> bool {
    var phi_519_: bool;
    var phi_520_: bool;

    let _e4 = (*a);
    let _e5 = (_e4 <= 0f);
    phi_520_ = _e5;
    if _e5 {
        let _e6 = (*b);
        let _e7 = (_e6 > 0f);
        phi_519_ = _e7;
        if !(_e7) {
            let _e9 = (*b);
            let _e11 = (*a);
            phi_519_ = (max(_e9, -1f) < _e11);
        }
        let _e14 = phi_519_;
        phi_520_ = _e14;
    }
    let _e16 = phi_520_;
    return _e16;
}

fn march(at_2: ptr<function, Search>, end: ptr<function, f32>, origin_1: ptr<function, f32>, row_1: ptr<function, i32>, surface: ptr<function, Surface>) -> vec4<f32> {
    var border: f32;
    var outside: bool;
    var beside_1: Beside;
    var local_9: f32;
    var found: bool;
    var param_35: f32;
    var param_36: f32;
    var param_37: Beside;
    var param_38: Search;
    var x_6: f32;
    var a_1: f32;
    var tile_row_1: i32;
    var below_3: bool;
    var shift_2: u32;
    var crosses: bool;
    var param_39: f32;
    var param_40: i32;
    var param_41: bool;
    var param_42: u32;
    var param_43: f32;
    var param_44: f32;
    var param_45: f32;
    var param_46: f32;
    var param_47: Beside;
    var param_48: Search;
    var local_10: f32;
    var local_11: f32;
    var last: f32;
    var b_1: f32;
    var param_49: f32;
    var param_50: f32;
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
    var param_51: f32;
    var param_52: vec2<f32>;
    var param_53: bool;
    var color_1: vec4<f32>;
    var param_54: f32;
    var param_55: f32;
    var param_56: vec2<f32>;
    var param_57: Edge;
    var param_58: vec4<f32>;
    var param_59: f32;
    var coverage: f32;
    var param_60: f32;
    var param_61: f32;
    var param_62: vec2<f32>;
    var phi_836_: bool;
    var phi_846_: bool;
    var phi_916_: bool;
    var phi_926_: bool;
    var phi_936_: bool;
    var phi_1009_: bool;
    var phi_1059_: bool;
    var phi_1082_: bool;
    var phi_1133_: bool;
    var phi_1150_: bool;
    var phi_1166_: bool;
    var phi_1167_: bool;

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
    phi_836_ = _e113;
    if _e113 {
        let _e115 = (*at_2).x;
        let _e116 = (*end);
        phi_836_ = (_e115 < _e116);
    }
    let _e119 = phi_836_;
    phi_846_ = _e119;
    if _e119 {
        let _e121 = (*at_2).a;
        param_35 = _e121;
        let _e123 = (*at_2).b;
        param_36 = _e123;
        let _e124 = is_event((&param_35), (&param_36));
        phi_846_ = _e124;
    }
    let _e126 = phi_846_;
    if _e126 {
        let _e127 = beside_1;
        param_37 = _e127;
        let _e128 = (*at_2);
        param_38 = _e128;
        let _e129 = meet((&param_37), (&param_38));
        let _e130 = param_37;
        beside_1 = _e130;
        found = _e129;
    }
    let _e132 = (*at_2).x;
    x_6 = max((_e132 + 1f), 0f);
    let _e136 = (*at_2).b;
    let _e137 = x_6;
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
        let _e153 = x_6;
        let _e154 = (*end);
        let _e156 = found;
        if ((_e153 <= _e154) && !(_e156)) {
            let _e159 = x_6;
            param_39 = _e159;
            let _e160 = tile_row_1;
            param_40 = _e160;
            let _e161 = below_3;
            param_41 = _e161;
            let _e162 = shift_2;
            param_42 = _e162;
            let _e163 = segment_end((&param_39), (&param_40), (&param_41), (&param_42));
            let _e164 = (*end);
            param_43 = min(_e163, _e164);
            let _e166 = (*origin_1);
            param_44 = _e166;
            let _e167 = search_at((&param_43), (&param_44));
            (*at_2) = _e167;
            let _e168 = a_1;
            let _e169 = (_e168 <= 0f);
            phi_916_ = _e169;
            if _e169 {
                let _e171 = (*at_2).a;
                phi_916_ = (_e171 > 0f);
            }
            let _e174 = phi_916_;
            crosses = _e174;
            let _e175 = crosses;
            found = _e175;
            let _e176 = crosses;
            let _e177 = !(_e176);
            phi_926_ = _e177;
            if _e177 {
                let _e179 = (*at_2).x;
                let _e180 = (*end);
                phi_926_ = (_e179 < _e180);
            }
            let _e183 = phi_926_;
            phi_936_ = _e183;
            if _e183 {
                let _e185 = (*at_2).a;
                param_45 = _e185;
                let _e187 = (*at_2).b;
                param_46 = _e187;
                let _e188 = is_event((&param_45), (&param_46));
                phi_936_ = _e188;
            }
            let _e190 = phi_936_;
            if _e190 {
                let _e191 = beside_1;
                param_47 = _e191;
                let _e192 = (*at_2);
                param_48 = _e192;
                let _e193 = meet((&param_47), (&param_48));
                let _e194 = param_47;
                beside_1 = _e194;
                found = _e193;
            }
            let _e195 = found;
            if _e195 {
                let _e196 = x_6;
                local_10 = _e196;
            } else {
                let _e198 = (*at_2).x;
                local_10 = (_e198 + 1f);
            }
            let _e200 = local_10;
            x_6 = _e200;
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
        let _e211 = x_6;
        let _e212 = last;
        if (_e210 && (_e211 < _e212)) {
            let _e215 = x_6;
            let _e216 = last;
            let _e217 = x_6;
            let _e219 = a_1;
            let _e221 = a_1;
            let _e222 = b_1;
            let _e227 = x_6;
            let _e228 = last;
            param_49 = clamp(floor((_e215 + (((_e216 - _e217) * _e219) / (_e221 - _e222)))), _e227, (_e228 - 1f));
            let _e231 = (*origin_1);
            param_50 = _e231;
            let _e232 = search_at((&param_49), (&param_50));
            (*at_2) = _e232;
            let _e234 = (*at_2).a;
            let _e235 = (_e234 > 0f);
            phi_1009_ = _e235;
            if !(_e235) {
                let _e238 = (*at_2).b;
                phi_1009_ = (_e238 <= 0f);
            }
            let _e241 = phi_1009_;
            crosses = _e241;
            let _e243 = (*at_2).a;
            behind = (_e243 > 0f);
            let _e245 = behind;
            if _e245 {
                let _e246 = x_6;
                local_12 = _e246;
            } else {
                let _e248 = (*at_2).x;
                local_12 = (_e248 + 1f);
            }
            let _e250 = local_12;
            x_6 = _e250;
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
    phi_1059_ = _e266;
    if !(_e266) {
        let _e269 = beside_1.edge;
        phi_1059_ = (_e269 < 0f);
    }
    let _e272 = phi_1059_;
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
    x_6 = _e280;
    let _e281 = found;
    phi_1082_ = _e281;
    if _e281 {
        let _e283 = (*at_2).b;
        let _e285 = (*at_2).a;
        phi_1082_ = ((_e283 - _e285) < 2f);
    }
    let _e289 = phi_1082_;
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
    let _e300 = x_6;
    let _e301 = t;
    (*surface).source = (_e300 + _e301);
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
    (*surface).depth = _e315;
    let _e317 = x_6;
    let _e318 = (*origin_1);
    let _e322 = synthesis.law[1u];
    let _e324 = (*surface).depth;
    away_2 = ((_e317 - _e318) + (_e322 * _e324));
    let _e327 = found;
    let _e328 = !(_e327);
    phi_1133_ = _e328;
    if _e328 {
        let _e329 = away_2;
        phi_1133_ = (abs(_e329) >= 0.5f);
    }
    let _e333 = phi_1133_;
    (*surface).hole = _e333;
    let _e336 = (*at_2).b;
    let _e338 = (*at_2).a;
    shows_next_1 = ((_e336 - _e338) < 2f);
    let _e342 = (*surface).hole;
    phi_1150_ = _e342;
    if !(_e342) {
        let _e345 = beside_1.rim;
        phi_1150_ = (_e345 >= 0f);
    }
    let _e348 = phi_1150_;
    phi_1167_ = _e348;
    if !(_e348) {
        let _e350 = found;
        phi_1166_ = _e350;
        if _e350 {
            let _e352 = (*at_2).x;
            param_51 = _e352;
            let _e354 = (*at_2).depths;
            param_52 = _e354;
            let _e355 = shows_next_1;
            param_53 = _e355;
            let _e356 = is_outermost((&param_51), (&param_52), (&param_53));
            phi_1166_ = _e356;
        }
        let _e358 = phi_1166_;
        phi_1167_ = _e358;
    }
    let _e360 = phi_1167_;
    if _e360 {
        discard;
    }
    let _e362 = (*surface).source;
    param_54 = _e362;
    let _e363 = column_at((&param_54));
    param_55 = 0f;
    let _e364 = row_at((&param_55));
    param_56 = vec2<f32>(_e363, _e364);
    let _e366 = color_sample((&param_56));
    color_1 = _e366;
    let _e368 = (*surface).hole;
    if _e368 {
        let _e369 = x_6;
        let _e371 = (*surface).depth;
        param_57 = Edge(_e369, _e371);
        let _e373 = color_1;
        param_58 = _e373;
        let _e374 = away_2;
        param_59 = _e374;
        let _e375 = fill_hole((&param_57), (&param_58), (&param_59));
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
        param_60 = _e394;
        let _e395 = column_at((&param_60));
        param_61 = 0f;
        let _e396 = row_at((&param_61));
        param_62 = vec2<f32>(_e395, _e396);
        let _e398 = color_sample((&param_62));
        let _e399 = coverage;
        color_1 = mix(_e392, _e398, vec4(_e399));
        let _e402 = coverage;
        if (_e402 >= 0.5f) {
            let _e405 = beside_1.rim;
            let _e407 = beside_1.rim_depth;
            (*surface) = Surface(_e405, _e407, false);
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

fn searched(span_1: ptr<function, u32>, surface_1: ptr<function, Surface>) -> vec4<f32> {
    var origin_2: f32;
    var at_3: Search;
    var param_63: f32;
    var param_64: f32;
    var end_1: f32;
    var param_65: u32;
    var limit: f32;
    var next: f32;
    var param_66: f32;
    var param_67: f32;
    var param_68: vec2<f32>;
    var stretch: f32;
    var t_1: f32;
    var seen: vec4<f32>;
    var param_69: f32;
    var param_70: f32;
    var param_71: vec2<f32>;
    var middle: f32;
    var done: bool;
    var param_72: Search;
    var param_73: f32;
    var param_74: f32;
    var param_75: i32;
    var param_76: Surface;
    var param_77: f32;
    var param_78: vec2<f32>;
    var param_79: bool;
    var phi_1399_: bool;
    var phi_1408_: bool;
    var phi_1491_: bool;
    var phi_1504_: bool;

    let _e43 = synthesis.origins[0u];
    let _e45 = gl_FragCoord_1[0u];
    let _e49 = synthesis.origins[1u];
    origin_2 = ((_e43 * _e45) + _e49);
    let _e51 = origin_2;
    let _e53 = synthesis.farthest;
    let _e55 = (*span_1);
    param_63 = floor(((_e51 - _e53) - bitcast<f32>(_e55)));
    let _e59 = origin_2;
    param_64 = _e59;
    let _e60 = search_at((&param_63), (&param_64));
    at_3 = _e60;
    let _e62 = at_3.x;
    let _e64 = (*span_1);
    param_65 = _e64;
    let _e65 = span_steps((&param_65));
    let _e69 = synthesis.source_size[0u];
    end_1 = min((max(_e62, 0f) + _e65), f32((_e69 - 1i)));
    let _e74 = at_3.x;
    let _e76 = end_1;
    limit = min((_e74 + 2f), _e76);
    loop {
        let _e79 = at_3.x;
        let _e80 = limit;
        let _e81 = (_e79 < _e80);
        phi_1399_ = _e81;
        if _e81 {
            let _e83 = at_3.b;
            phi_1399_ = (_e83 <= 0f);
        }
        let _e86 = phi_1399_;
        phi_1408_ = _e86;
        if _e86 {
            let _e88 = at_3.b;
            let _e91 = at_3.a;
            phi_1408_ = (max(_e88, -1f) >= _e91);
        }
        let _e94 = phi_1408_;
        if _e94 {
            let _e96 = at_3.x;
            param_66 = (_e96 + 2f);
            let _e98 = column_at((&param_66));
            param_67 = 0f;
            let _e99 = row_at((&param_67));
            param_68 = vec2<f32>(_e98, _e99);
            let _e101 = depth_sample((&param_68));
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
    (*surface_1) = Surface((_e138 + _e139), mix(_e143, _e146, _e147), false);
    let _e151 = (*surface_1).source;
    param_69 = _e151;
    let _e152 = column_at((&param_69));
    param_70 = 0f;
    let _e153 = row_at((&param_70));
    param_71 = vec2<f32>(_e152, _e153);
    let _e155 = color_sample((&param_71));
    seen = _e155;
    let _e158 = synthesis.source_size[0u];
    middle = (0.5f * f32((_e158 - 1i)));
    let _e163 = at_3.a;
    let _e164 = (_e163 <= 0f);
    phi_1491_ = _e164;
    if _e164 {
        let _e166 = at_3.b;
        phi_1491_ = (_e166 > 0f);
    }
    let _e169 = phi_1491_;
    let _e170 = stretch;
    let _e172 = (_e169 && (_e170 < 2f));
    phi_1504_ = _e172;
    if _e172 {
        let _e174 = (*surface_1).source;
        let _e175 = middle;
        let _e178 = middle;
        phi_1504_ = (abs((_e174 - _e175)) <= _e178);
    }
    let _e181 = phi_1504_;
    done = _e181;
    let _e182 = done;
    if !(_e182) {
        let _e184 = source_row();
        let _e185 = at_3;
        param_72 = _e185;
        let _e186 = end_1;
        param_73 = _e186;
        let _e187 = origin_2;
        param_74 = _e187;
        param_75 = _e184;
        let _e188 = march((&param_72), (&param_73), (&param_74), (&param_75), (&param_76));
        let _e189 = param_76;
        (*surface_1) = _e189;
        seen = _e188;
    } else {
        let _e191 = at_3.x;
        param_77 = _e191;
        let _e193 = at_3.depths;
        param_78 = _e193;
        param_79 = true;
        let _e194 = is_outermost((&param_77), (&param_78), (&param_79));
        if _e194 {
            discard;
        }
    }
    let _e195 = seen;
    return _e195;
}

fn sample_planar(affine: ptr<function, vec3<f32>>, may_end: ptr<function, bool>, surface_2: ptr<function, Surface>) -> vec4<f32> {
    var place_4: f32;
    var moved_1: f32;
    var depths_2: vec2<f32>;
    var param_80: f32;
    var param_81: f32;
    var param_82: f32;
    var at_4: vec2<f32>;
    var param_83: f32;
    var param_84: vec2<f32>;
    var phi_1329_: bool;

    let _e22 = (*affine)[0u];
    let _e24 = (*affine)[1u];
    let _e26 = gl_FragCoord_1[0u];
    let _e30 = (*affine)[2u];
    let _e32 = gl_FragCoord_1[1u];
    place_4 = ((_e22 + (_e24 * _e26)) + (_e30 * _e32));
    let _e35 = place_4;
    let _e38 = synthesis.columns[1u];
    let _e42 = synthesis.columns[0u];
    let _e47 = synthesis.source_size[0u];
    (*surface_2).source = clamp((((_e35 - _e38) / _e42) - 0.5f), 0f, f32((_e47 - 1i)));
    let _e54 = synthesis.origins[0u];
    let _e56 = gl_FragCoord_1[0u];
    let _e60 = synthesis.origins[1u];
    let _e63 = (*surface_2).source;
    moved_1 = (((_e54 * _e56) + _e60) - _e63);
    let _e65 = moved_1;
    let _e68 = synthesis.law[1u];
    (*surface_2).depth = (_e65 / _e68);
    let _e73 = synthesis.law[1u];
    if (_e73 == 0f) {
        let _e76 = (*surface_2).source;
        param_80 = floor(_e76);
        let _e78 = depth_pair((&param_80));
        depths_2 = _e78;
        let _e80 = depths_2[0u];
        let _e82 = depths_2[1u];
        let _e84 = (*surface_2).source;
        (*surface_2).depth = mix(_e80, _e82, fract(_e84));
    }
    (*surface_2).hole = false;
    let _e89 = (*may_end);
    phi_1329_ = _e89;
    if _e89 {
        let _e91 = (*surface_2).source;
        param_81 = floor(_e91);
        let _e93 = moved_1;
        param_82 = _e93;
        let _e94 = ends_in_row((&param_81), (&param_82));
        phi_1329_ = _e94;
    }
    let _e96 = phi_1329_;
    if _e96 {
        discard;
    }
    let _e97 = place_4;
    param_83 = 0f;
    let _e98 = row_at((&param_83));
    at_4 = vec2<f32>(_e97, _e98);
    let _e100 = at_4;
    param_84 = _e100;
    let _e101 = color_sample((&param_84));
    return _e101;
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
    var surface_3: Surface;
    var param_85: vec3<f32>;
    var param_86: bool;
    var param_87: Surface;
    var param_88: u32;
    var param_89: Surface;

    let _e12 = pixel_span();
    span_2 = _e12;
    let _e14 = span_2[1u];
    if (_e14 != 0u) {
        let _e16 = span_2;
        let _e20 = span_2[3u];
        param_85 = bitcast<vec3<f32>>(_e16.xyz);
        param_86 = (_e20 != 0u);
        let _e22 = sample_planar((&param_85), (&param_86), (&param_87));
        let _e23 = param_87;
        surface_3 = _e23;
        color_2 = _e22;
    } else {
        let _e25 = span_2[0u];
        param_88 = _e25;
        let _e26 = searched((&param_88), (&param_89));
        let _e27 = param_89;
        surface_3 = _e27;
        color_2 = _e26;
    }
    let _e29 = surface_3.depth;
    gl_FragDepth = _e29;
    return;
}

@fragment 
fn main(@builtin(position) gl_FragCoord: vec4<f32>, @location(0) span_at: vec2<f32>) -> FragmentOutput {
    gl_FragCoord_1 = gl_FragCoord;
    span_at_1 = span_at;
    main_1();
    let _e6 = color_2;
    let _e7 = gl_FragDepth;
    return FragmentOutput(_e6, _e7);
}
