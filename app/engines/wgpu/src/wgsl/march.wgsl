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

fn color_sample(place: ptr<function, vec2<f32>>) -> vec4<f32> {
    let _e4 = (*place);
    let _e5 = textureSampleLevel(color_map_texture, linear_sampler, _e4, 0f);
    return _e5;
}

fn nearest_of(texel: ptr<function, vec4<f32>>) -> f32 {
    let _e3 = (*texel)[0u];
    return _e3;
}

fn depth_sample(place_1: ptr<function, vec2<f32>>) -> f32 {
    var param: vec4<f32>;

    let _e5 = (*place_1);
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

fn tap_beside(edge: ptr<function, Edge>, distance_: ptr<function, f32>, nearer: ptr<function, f32>) -> vec4<f32> {
    var place_2: vec2<f32>;
    var param_3: f32;
    var param_4: f32;
    var param_5: vec2<f32>;
    var param_6: vec2<f32>;

    let _e11 = (*edge).x;
    param_3 = _e11;
    let _e12 = column_at((&param_3));
    let _e13 = (*distance_);
    param_4 = _e13;
    let _e14 = row_at((&param_4));
    place_2 = vec2<f32>(_e12, _e14);
    let _e18 = synthesis.law[1u];
    let _e19 = place_2;
    param_5 = _e19;
    let _e20 = depth_sample((&param_5));
    let _e22 = (*edge).depth;
    (*nearer) = (_e18 * (_e20 - _e22));
    let _e25 = place_2;
    param_6 = _e25;
    let _e26 = color_sample((&param_6));
    return _e26;
}

fn fill_hole(edge_1: ptr<function, Edge>, color: ptr<function, vec4<f32>>, away_1: ptr<function, f32>) -> vec4<f32> {
    var spread: f32;
    var sum: vec4<f32>;
    var weights: f32;
    var i: i32;
    var distance_1: f32;
    var below: vec4<f32>;
    var nearer_1: vec2<f32>;
    var param_7: Edge;
    var param_8: f32;
    var param_9: f32;
    var above: vec4<f32>;
    var param_10: Edge;
    var param_11: f32;
    var param_12: f32;
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
            param_7 = _e43;
            param_8 = -(_e41);
            let _e44 = tap_beside((&param_7), (&param_8), (&param_9));
            let _e45 = param_9;
            nearer_1[0u] = _e45;
            below = _e44;
            let _e47 = (*edge_1);
            param_10 = _e47;
            let _e48 = distance_1;
            param_11 = _e48;
            let _e49 = tap_beside((&param_10), (&param_11), (&param_12));
            let _e50 = param_12;
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

fn depth_gather(place_3: ptr<function, vec2<f32>>) -> vec4<f32> {
    var quad: vec4<f32>;

    let _e4 = (*place_3);
    let _e5 = textureGather(0, depth_map_texture, nearest_sampler, _e4);
    quad = _e5;
    let _e6 = quad;
    return _e6;
}

fn depth_pair(x_1: ptr<function, f32>) -> vec2<f32> {
    var row: f32;
    var param_13: f32;
    var param_14: f32;
    var param_15: vec2<f32>;
    var param_16: f32;
    var param_17: vec2<f32>;
    var quad_1: vec4<f32>;
    var param_18: f32;
    var param_19: vec2<f32>;
    var local_2: vec2<f32>;

    if true {
        param_13 = 0f;
        let _e19 = row_at((&param_13));
        row = _e19;
        let _e20 = (*x_1);
        param_14 = _e20;
        let _e21 = column_at((&param_14));
        let _e22 = row;
        param_15 = vec2<f32>(_e21, _e22);
        let _e24 = depth_sample((&param_15));
        let _e25 = (*x_1);
        param_16 = (_e25 + 1f);
        let _e27 = column_at((&param_16));
        let _e28 = row;
        param_17 = vec2<f32>(_e27, _e28);
        let _e30 = depth_sample((&param_17));
        return vec2<f32>(_e24, _e30);
    }
    let _e34 = synthesis.columns[0u];
    let _e35 = (*x_1);
    let _e40 = synthesis.columns[1u];
    param_18 = 0.25f;
    let _e42 = row_at((&param_18));
    param_19 = vec2<f32>(((_e34 * (_e35 + 1.25f)) + _e40), _e42);
    let _e44 = depth_gather((&param_19));
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

fn search_at(x_2: ptr<function, f32>, origin: ptr<function, f32>) -> Search {
    var depths: vec2<f32>;
    var param_20: f32;
    var shift: f32;

    let _e9 = (*x_2);
    param_20 = _e9;
    let _e10 = depth_pair((&param_20));
    depths = _e10;
    let _e11 = (*x_2);
    let _e12 = (*origin);
    shift = (_e11 - _e12);
    let _e14 = (*x_2);
    let _e15 = depths;
    let _e16 = shift;
    let _e19 = synthesis.law[1u];
    let _e21 = depths[0u];
    let _e24 = shift;
    let _e28 = synthesis.law[1u];
    let _e30 = depths[1u];
    return Search(_e14, _e15, (_e16 + (_e19 * _e21)), ((_e24 + 1f) + (_e28 * _e30)));
}

fn lowest_bit(bits: ptr<function, u32>) -> f32 {
    let _e1 = (*bits);
    return f32(firstTrailingBit(_e1));
}

fn segment_end(x_3: ptr<function, f32>, tile_row: ptr<function, i32>, below_1: ptr<function, bool>, shift_1: ptr<function, u32>) -> f32 {
    var column: u32;
    var within: u32;
    var tile: vec4<u32>;
    var marks: u32;
    var local_3: u32;
    var param_21: u32;

    let _e19 = (*x_3);
    column = u32(_e19);
    let _e21 = column;
    within = (_e21 % 16u);
    let _e23 = column;
    let _e26 = (*tile_row);
    let _e28 = textureLoad(tile_map_texture, vec2<i32>(bitcast<i32>((_e23 / 16u)), _e26), 0i);
    tile = _e28;
    let _e29 = (*below_1);
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
    let _e46 = (*x_3);
    let _e47 = marks;
    let _e48 = within;
    param_21 = (_e47 | (65536u >> bitcast<u32>(_e48)));
    let _e52 = lowest_bit((&param_21));
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
    var phi_595_: bool;
    var phi_596_: bool;
    var phi_597_: bool;
    var phi_644_: bool;
    var phi_677_: bool;

    let _e19 = (*at_1).b;
    jump = (_e19 > 0f);
    let _e22 = (*at_1).b;
    let _e24 = (*at_1).a;
    torn = ((_e22 - _e24) >= 2f);
    let _e28 = (*beside).rim;
    let _e29 = (_e28 < 0f);
    phi_597_ = _e29;
    if _e29 {
        let _e30 = jump;
        let _e31 = !(_e30);
        phi_596_ = _e31;
        if !(_e31) {
            let _e33 = torn;
            phi_595_ = _e33;
            if _e33 {
                let _e35 = (*at_1).b;
                phi_595_ = (_e35 < 1f);
            }
            let _e38 = phi_595_;
            phi_596_ = _e38;
        }
        let _e40 = phi_596_;
        phi_597_ = _e40;
    }
    let _e42 = phi_597_;
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
    phi_644_ = _e66;
    if _e66 {
        let _e69 = synthesis.law[1u];
        let _e72 = (*at_1).depths[0u];
        let _e74 = (*beside).edge_depth;
        phi_644_ = ((_e69 * (_e72 - _e74)) < 0f);
    }
    let _e79 = phi_644_;
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
    phi_677_ = _e95;
    if _e95 {
        let _e97 = (*at_1).a;
        let _e99 = torn;
        phi_677_ = ((_e97 > -0.5f) || !(_e99));
    }
    let _e103 = phi_677_;
    return _e103;
}

fn is_event(a: ptr<function, f32>, b: ptr<function, f32>) -> bool {
    var phi_508_: bool;
    var phi_509_: bool;

    let _e4 = (*a);
    let _e5 = (_e4 <= 0f);
    phi_509_ = _e5;
    if _e5 {
        let _e6 = (*b);
        let _e7 = (_e6 > 0f);
        phi_508_ = _e7;
        if !(_e7) {
            let _e9 = (*b);
            let _e11 = (*a);
            phi_508_ = (max(_e9, -1f) < _e11);
        }
        let _e14 = phi_508_;
        phi_509_ = _e14;
    }
    let _e16 = phi_509_;
    return _e16;
}

fn march(at_2: ptr<function, Search>, end: ptr<function, f32>, origin_1: ptr<function, f32>, row_1: ptr<function, i32>, surface: ptr<function, Surface>) -> vec4<f32> {
    var border: f32;
    var outside: bool;
    var beside_1: Beside;
    var local_9: f32;
    var found: bool;
    var param_22: f32;
    var param_23: f32;
    var param_24: Beside;
    var param_25: Search;
    var x_4: f32;
    var a_1: f32;
    var tile_row_1: i32;
    var below_2: bool;
    var shift_2: u32;
    var crosses: bool;
    var param_26: f32;
    var param_27: i32;
    var param_28: bool;
    var param_29: u32;
    var param_30: f32;
    var param_31: f32;
    var param_32: f32;
    var param_33: f32;
    var param_34: Beside;
    var param_35: Search;
    var local_10: f32;
    var local_11: f32;
    var last: f32;
    var b_1: f32;
    var param_36: f32;
    var param_37: f32;
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
    var color_1: vec4<f32>;
    var param_38: f32;
    var param_39: f32;
    var param_40: vec2<f32>;
    var param_41: Edge;
    var param_42: vec4<f32>;
    var param_43: f32;
    var coverage: f32;
    var param_44: f32;
    var param_45: f32;
    var param_46: vec2<f32>;
    var phi_730_: bool;
    var phi_740_: bool;
    var phi_810_: bool;
    var phi_820_: bool;
    var phi_830_: bool;
    var phi_903_: bool;
    var phi_953_: bool;
    var phi_976_: bool;
    var phi_1027_: bool;

    let _e75 = (*at_2).a;
    let _e77 = (*at_2).x;
    border = (_e75 - _e77);
    let _e80 = (*at_2).x;
    let _e82 = border;
    outside = ((_e80 <= 0f) && (_e82 > 0f));
    let _e85 = outside;
    let _e86 = border;
    let _e89 = (*end);
    (*end) = select(_e89, 0f, (_e85 && (_e86 < 0.5f)));
    let _e91 = outside;
    beside_1.edge = select(-1f, 0f, _e91);
    let _e94 = outside;
    if _e94 {
        let _e97 = (*at_2).depths[0u];
        local_9 = _e97;
    } else {
        let _e100 = synthesis.law[1u];
        local_9 = select(1000000000f, -1000000000f, (_e100 < 0f));
    }
    let _e103 = local_9;
    beside_1.edge_depth = _e103;
    beside_1.rim = -1f;
    beside_1.rim_depth = 0f;
    found = false;
    let _e108 = (*at_2).x;
    let _e109 = (_e108 >= 0f);
    phi_730_ = _e109;
    if _e109 {
        let _e111 = (*at_2).x;
        let _e112 = (*end);
        phi_730_ = (_e111 < _e112);
    }
    let _e115 = phi_730_;
    phi_740_ = _e115;
    if _e115 {
        let _e117 = (*at_2).a;
        param_22 = _e117;
        let _e119 = (*at_2).b;
        param_23 = _e119;
        let _e120 = is_event((&param_22), (&param_23));
        phi_740_ = _e120;
    }
    let _e122 = phi_740_;
    if _e122 {
        let _e123 = beside_1;
        param_24 = _e123;
        let _e124 = (*at_2);
        param_25 = _e124;
        let _e125 = meet((&param_24), (&param_25));
        let _e126 = param_24;
        beside_1 = _e126;
        found = _e125;
    }
    let _e128 = (*at_2).x;
    x_4 = max((_e128 + 1f), 0f);
    let _e132 = (*at_2).b;
    let _e133 = x_4;
    let _e135 = (*at_2).x;
    a_1 = (_e132 + ((_e133 - _e135) - 1f));
    let _e139 = (*row_1);
    tile_row_1 = (_e139 / 8i);
    let _e141 = (*row_1);
    below_2 = ((_e141 & 4i) == 0i);
    let _e144 = (*row_1);
    shift_2 = (bitcast<u32>((_e144 & 2i)) << bitcast<u32>(3i));
    crosses = false;
    loop {
        let _e149 = x_4;
        let _e150 = (*end);
        let _e152 = found;
        if ((_e149 <= _e150) && !(_e152)) {
            let _e155 = x_4;
            param_26 = _e155;
            let _e156 = tile_row_1;
            param_27 = _e156;
            let _e157 = below_2;
            param_28 = _e157;
            let _e158 = shift_2;
            param_29 = _e158;
            let _e159 = segment_end((&param_26), (&param_27), (&param_28), (&param_29));
            let _e160 = (*end);
            param_30 = min(_e159, _e160);
            let _e162 = (*origin_1);
            param_31 = _e162;
            let _e163 = search_at((&param_30), (&param_31));
            (*at_2) = _e163;
            let _e164 = a_1;
            let _e165 = (_e164 <= 0f);
            phi_810_ = _e165;
            if _e165 {
                let _e167 = (*at_2).a;
                phi_810_ = (_e167 > 0f);
            }
            let _e170 = phi_810_;
            crosses = _e170;
            let _e171 = crosses;
            found = _e171;
            let _e172 = crosses;
            let _e173 = !(_e172);
            phi_820_ = _e173;
            if _e173 {
                let _e175 = (*at_2).x;
                let _e176 = (*end);
                phi_820_ = (_e175 < _e176);
            }
            let _e179 = phi_820_;
            phi_830_ = _e179;
            if _e179 {
                let _e181 = (*at_2).a;
                param_32 = _e181;
                let _e183 = (*at_2).b;
                param_33 = _e183;
                let _e184 = is_event((&param_32), (&param_33));
                phi_830_ = _e184;
            }
            let _e186 = phi_830_;
            if _e186 {
                let _e187 = beside_1;
                param_34 = _e187;
                let _e188 = (*at_2);
                param_35 = _e188;
                let _e189 = meet((&param_34), (&param_35));
                let _e190 = param_34;
                beside_1 = _e190;
                found = _e189;
            }
            let _e191 = found;
            if _e191 {
                let _e192 = x_4;
                local_10 = _e192;
            } else {
                let _e194 = (*at_2).x;
                local_10 = (_e194 + 1f);
            }
            let _e196 = local_10;
            x_4 = _e196;
            let _e197 = found;
            if _e197 {
                let _e198 = a_1;
                local_11 = _e198;
            } else {
                let _e200 = (*at_2).b;
                local_11 = _e200;
            }
            let _e201 = local_11;
            a_1 = _e201;
            continue;
        } else {
            break;
        }
    }
    let _e203 = (*at_2).x;
    last = _e203;
    let _e205 = (*at_2).a;
    b_1 = _e205;
    loop {
        let _e206 = crosses;
        let _e207 = x_4;
        let _e208 = last;
        if (_e206 && (_e207 < _e208)) {
            let _e211 = x_4;
            let _e212 = last;
            let _e213 = x_4;
            let _e215 = a_1;
            let _e217 = a_1;
            let _e218 = b_1;
            let _e223 = x_4;
            let _e224 = last;
            param_36 = clamp(floor((_e211 + (((_e212 - _e213) * _e215) / (_e217 - _e218)))), _e223, (_e224 - 1f));
            let _e227 = (*origin_1);
            param_37 = _e227;
            let _e228 = search_at((&param_36), (&param_37));
            (*at_2) = _e228;
            let _e230 = (*at_2).a;
            let _e231 = (_e230 > 0f);
            phi_903_ = _e231;
            if !(_e231) {
                let _e234 = (*at_2).b;
                phi_903_ = (_e234 <= 0f);
            }
            let _e237 = phi_903_;
            crosses = _e237;
            let _e239 = (*at_2).a;
            behind = (_e239 > 0f);
            let _e241 = behind;
            if _e241 {
                let _e242 = x_4;
                local_12 = _e242;
            } else {
                let _e244 = (*at_2).x;
                local_12 = (_e244 + 1f);
            }
            let _e246 = local_12;
            x_4 = _e246;
            let _e247 = behind;
            if _e247 {
                let _e248 = a_1;
                local_13 = _e248;
            } else {
                let _e250 = (*at_2).b;
                local_13 = _e250;
            }
            let _e251 = local_13;
            a_1 = _e251;
            let _e252 = behind;
            if _e252 {
                let _e254 = (*at_2).x;
                local_14 = _e254;
            } else {
                let _e255 = last;
                local_14 = _e255;
            }
            let _e256 = local_14;
            last = _e256;
            let _e257 = behind;
            if _e257 {
                let _e259 = (*at_2).a;
                local_15 = _e259;
            } else {
                let _e260 = b_1;
                local_15 = _e260;
            }
            let _e261 = local_15;
            b_1 = _e261;
            continue;
        } else {
            break;
        }
    }
    let _e262 = found;
    phi_953_ = _e262;
    if !(_e262) {
        let _e265 = beside_1.edge;
        phi_953_ = (_e265 < 0f);
    }
    let _e268 = phi_953_;
    own = _e268;
    let _e269 = own;
    if _e269 {
        let _e271 = (*at_2).x;
        let _e272 = (*end);
        local_16 = min(_e271, _e272);
    } else {
        let _e275 = beside_1.edge;
        local_16 = _e275;
    }
    let _e276 = local_16;
    x_4 = _e276;
    let _e277 = found;
    phi_976_ = _e277;
    if _e277 {
        let _e279 = (*at_2).b;
        let _e281 = (*at_2).a;
        phi_976_ = ((_e279 - _e281) < 2f);
    }
    let _e285 = phi_976_;
    if _e285 {
        let _e287 = (*at_2).a;
        let _e290 = (*at_2).b;
        let _e292 = (*at_2).a;
        local_17 = (-(_e287) / (_e290 - _e292));
    } else {
        local_17 = 0f;
    }
    let _e295 = local_17;
    t = _e295;
    let _e296 = x_4;
    let _e297 = t;
    (*surface).source = (_e296 + _e297);
    let _e300 = own;
    if _e300 {
        let _e303 = (*at_2).depths[0u];
        let _e306 = (*at_2).depths[1u];
        let _e307 = t;
        local_18 = mix(_e303, _e306, _e307);
    } else {
        let _e310 = beside_1.edge_depth;
        local_18 = _e310;
    }
    let _e311 = local_18;
    (*surface).depth = _e311;
    let _e313 = x_4;
    let _e314 = (*origin_1);
    let _e318 = synthesis.law[1u];
    let _e320 = (*surface).depth;
    away_2 = ((_e313 - _e314) + (_e318 * _e320));
    let _e323 = found;
    let _e324 = !(_e323);
    phi_1027_ = _e324;
    if _e324 {
        let _e325 = away_2;
        phi_1027_ = (abs(_e325) >= 0.5f);
    }
    let _e329 = phi_1027_;
    (*surface).hole = _e329;
    let _e332 = (*surface).source;
    param_38 = _e332;
    let _e333 = column_at((&param_38));
    param_39 = 0f;
    let _e334 = row_at((&param_39));
    param_40 = vec2<f32>(_e333, _e334);
    let _e336 = color_sample((&param_40));
    color_1 = _e336;
    let _e338 = (*surface).hole;
    if _e338 {
        let _e339 = x_4;
        let _e341 = (*surface).depth;
        param_41 = Edge(_e339, _e341);
        let _e343 = color_1;
        param_42 = _e343;
        let _e344 = away_2;
        param_43 = _e344;
        let _e345 = fill_hole((&param_41), (&param_42), (&param_43));
        color_1 = _e345;
    }
    let _e347 = beside_1.rim;
    if (_e347 >= 0f) {
        let _e350 = beside_1.rim;
        let _e351 = (*origin_1);
        let _e355 = synthesis.law[1u];
        let _e357 = beside_1.rim_depth;
        coverage = (1f - abs(((_e350 - _e351) + (_e355 * _e357))));
        let _e362 = color_1;
        let _e364 = beside_1.rim;
        param_44 = _e364;
        let _e365 = column_at((&param_44));
        param_45 = 0f;
        let _e366 = row_at((&param_45));
        param_46 = vec2<f32>(_e365, _e366);
        let _e368 = color_sample((&param_46));
        let _e369 = coverage;
        color_1 = mix(_e362, _e368, vec4(_e369));
        let _e372 = coverage;
        if (_e372 >= 0.5f) {
            let _e375 = beside_1.rim;
            let _e377 = beside_1.rim_depth;
            (*surface) = Surface(_e375, _e377, false);
        }
    }
    let _e379 = color_1;
    return _e379;
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
    var param_47: f32;
    var param_48: f32;
    var end_1: f32;
    var param_49: u32;
    var limit: f32;
    var next: f32;
    var param_50: f32;
    var param_51: f32;
    var param_52: vec2<f32>;
    var stretch: f32;
    var t_1: f32;
    var seen: vec4<f32>;
    var param_53: f32;
    var param_54: f32;
    var param_55: vec2<f32>;
    var middle: f32;
    var done: bool;
    var param_56: Search;
    var param_57: f32;
    var param_58: f32;
    var param_59: i32;
    var param_60: Surface;
    var phi_1191_: bool;
    var phi_1200_: bool;
    var phi_1283_: bool;
    var phi_1296_: bool;

    let _e39 = synthesis.origins[0u];
    let _e41 = gl_FragCoord_1[0u];
    let _e45 = synthesis.origins[1u];
    origin_2 = ((_e39 * _e41) + _e45);
    let _e47 = origin_2;
    let _e49 = synthesis.farthest;
    let _e51 = (*span_1);
    param_47 = floor(((_e47 - _e49) - bitcast<f32>(_e51)));
    let _e55 = origin_2;
    param_48 = _e55;
    let _e56 = search_at((&param_47), (&param_48));
    at_3 = _e56;
    let _e58 = at_3.x;
    let _e60 = (*span_1);
    param_49 = _e60;
    let _e61 = span_steps((&param_49));
    let _e65 = synthesis.source_size[0u];
    end_1 = min((max(_e58, 0f) + _e61), f32((_e65 - 1i)));
    let _e70 = at_3.x;
    let _e72 = end_1;
    limit = min((_e70 + 2f), _e72);
    loop {
        let _e75 = at_3.x;
        let _e76 = limit;
        let _e77 = (_e75 < _e76);
        phi_1191_ = _e77;
        if _e77 {
            let _e79 = at_3.b;
            phi_1191_ = (_e79 <= 0f);
        }
        let _e82 = phi_1191_;
        phi_1200_ = _e82;
        if _e82 {
            let _e84 = at_3.b;
            let _e87 = at_3.a;
            phi_1200_ = (max(_e84, -1f) >= _e87);
        }
        let _e90 = phi_1200_;
        if _e90 {
            let _e92 = at_3.x;
            param_50 = (_e92 + 2f);
            let _e94 = column_at((&param_50));
            param_51 = 0f;
            let _e95 = row_at((&param_51));
            param_52 = vec2<f32>(_e94, _e95);
            let _e97 = depth_sample((&param_52));
            next = _e97;
            let _e100 = at_3.depths[1u];
            let _e101 = next;
            at_3.depths = vec2<f32>(_e100, _e101);
            let _e105 = at_3.b;
            at_3.a = _e105;
            let _e108 = at_3.x;
            let _e110 = origin_2;
            let _e114 = synthesis.law[1u];
            let _e115 = next;
            at_3.b = (((_e108 + 2f) - _e110) + (_e114 * _e115));
            continue;
        } else {
            break;
        }
        continuing {
            let _e120 = at_3.x;
            at_3.x = (_e120 + 1f);
        }
    }
    let _e124 = at_3.b;
    let _e126 = at_3.a;
    stretch = (_e124 - _e126);
    let _e129 = at_3.a;
    let _e131 = stretch;
    t_1 = (-(_e129) / _e131);
    let _e134 = at_3.x;
    let _e135 = t_1;
    let _e139 = at_3.depths[0u];
    let _e142 = at_3.depths[1u];
    let _e143 = t_1;
    (*surface_1) = Surface((_e134 + _e135), mix(_e139, _e142, _e143), false);
    let _e147 = (*surface_1).source;
    param_53 = _e147;
    let _e148 = column_at((&param_53));
    param_54 = 0f;
    let _e149 = row_at((&param_54));
    param_55 = vec2<f32>(_e148, _e149);
    let _e151 = color_sample((&param_55));
    seen = _e151;
    let _e154 = synthesis.source_size[0u];
    middle = (0.5f * f32((_e154 - 1i)));
    let _e159 = at_3.a;
    let _e160 = (_e159 <= 0f);
    phi_1283_ = _e160;
    if _e160 {
        let _e162 = at_3.b;
        phi_1283_ = (_e162 > 0f);
    }
    let _e165 = phi_1283_;
    let _e166 = stretch;
    let _e168 = (_e165 && (_e166 < 2f));
    phi_1296_ = _e168;
    if _e168 {
        let _e170 = (*surface_1).source;
        let _e171 = middle;
        let _e174 = middle;
        phi_1296_ = (abs((_e170 - _e171)) <= _e174);
    }
    let _e177 = phi_1296_;
    done = _e177;
    let _e178 = done;
    if !(_e178) {
        let _e180 = source_row();
        let _e181 = at_3;
        param_56 = _e181;
        let _e182 = end_1;
        param_57 = _e182;
        let _e183 = origin_2;
        param_58 = _e183;
        param_59 = _e180;
        let _e184 = march((&param_56), (&param_57), (&param_58), (&param_59), (&param_60));
        let _e185 = param_60;
        (*surface_1) = _e185;
        seen = _e184;
    }
    let _e186 = seen;
    return _e186;
}

fn sample_planar(affine: ptr<function, vec3<f32>>, surface_2: ptr<function, Surface>) -> vec4<f32> {
    var place_4: f32;
    var at_4: vec2<f32>;
    var param_61: f32;
    var param_62: vec2<f32>;

    let _e11 = (*affine)[0u];
    let _e13 = (*affine)[1u];
    let _e15 = gl_FragCoord_1[0u];
    let _e19 = (*affine)[2u];
    let _e21 = gl_FragCoord_1[1u];
    place_4 = ((_e11 + (_e13 * _e15)) + (_e19 * _e21));
    let _e24 = place_4;
    param_61 = 0f;
    let _e25 = row_at((&param_61));
    at_4 = vec2<f32>(_e24, _e25);
    let _e27 = at_4;
    param_62 = _e27;
    let _e28 = color_sample((&param_62));
    return _e28;
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
    var param_63: vec3<f32>;
    var param_64: Surface;
    var param_65: u32;
    var param_66: Surface;

    let _e9 = pixel_span();
    span_2 = _e9;
    let _e11 = span_2[1u];
    if (_e11 != 0u) {
        let _e13 = span_2;
        param_63 = bitcast<vec3<f32>>(_e13.xyz);
        let _e16 = sample_planar((&param_63), (&param_64));
        let _e17 = param_64;
        surface_3 = _e17;
        color_2 = _e16;
    } else {
        let _e19 = span_2[0u];
        param_65 = _e19;
        let _e20 = searched((&param_65), (&param_66));
        let _e21 = param_66;
        surface_3 = _e21;
        color_2 = _e20;
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
