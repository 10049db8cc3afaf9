// Made of yoro's GLSL by `cargo xtask maintain renew`.
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
    motion: vec4<f32>,
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
    var param: vec2<f32>;

    if true {
        let _e10 = gl_FragCoord_1[1u];
        let _e12 = synthesis.first_row;
        let _e14 = (*away);
        param = vec2<f32>(0.5f, ((_e10 - _e12) + _e14));
        let _e17 = place_of((&param));
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
    var param_1: vec2<f32>;

    let _e3 = (*x);
    param_1 = vec2<f32>((_e3 + 0.5f), 0.5f);
    let _e6 = place_of((&param_1));
    return _e6.x;
}

fn nearest_of(texel: ptr<function, vec4<f32>>) -> f32 {
    let _e3 = (*texel)[0u];
    return _e3;
}

fn depth_sample(place_1: ptr<function, vec2<f32>>) -> f32 {
    var param_2: vec4<f32>;

    let _e5 = (*place_1);
    let _e6 = textureSampleLevel(depth_map_texture, nearest_sampler, _e5, 0f);
    param_2 = _e6;
    let _e7 = nearest_of((&param_2));
    return _e7;
}

fn fill_spread(away_1: ptr<function, f32>) -> f32 {
    let _e4 = (*away_1);
    return (0.5f * clamp(abs(_e4), 1f, 12f));
}

fn fill_hole(color: ptr<function, vec4<f32>>, away_2: ptr<function, f32>, x_1: ptr<function, f32>, depth: ptr<function, f32>) -> vec4<f32> {
    var spread: f32;
    var param_3: f32;
    var sum: vec4<f32>;
    var weights: f32;
    var i: i32;
    var distance_: f32;
    var below: vec2<f32>;
    var param_4: f32;
    var param_5: f32;
    var above: vec2<f32>;
    var param_6: f32;
    var param_7: f32;
    var depths: vec2<f32>;
    var param_8: vec2<f32>;
    var param_9: vec2<f32>;
    var weight: vec2<f32>;
    var param_10: vec2<f32>;
    var param_11: vec2<f32>;

    let _e30 = (*away_2);
    param_3 = _e30;
    let _e31 = fill_spread((&param_3));
    spread = _e31;
    let _e32 = (*color);
    sum = (_e32 * 2f);
    weights = 2f;
    i = 1i;
    loop {
        let _e34 = i;
        if (_e34 <= 2i) {
            let _e36 = i;
            let _e38 = spread;
            distance_ = round((f32(_e36) * _e38));
            let _e41 = (*x_1);
            param_4 = _e41;
            let _e42 = column_at((&param_4));
            let _e43 = distance_;
            param_5 = -(_e43);
            let _e45 = row_at((&param_5));
            below = vec2<f32>(_e42, _e45);
            let _e47 = (*x_1);
            param_6 = _e47;
            let _e48 = column_at((&param_6));
            let _e49 = distance_;
            param_7 = _e49;
            let _e50 = row_at((&param_7));
            above = vec2<f32>(_e48, _e50);
            let _e52 = below;
            param_8 = _e52;
            let _e53 = depth_sample((&param_8));
            let _e54 = above;
            param_9 = _e54;
            let _e55 = depth_sample((&param_9));
            depths = vec2<f32>(_e53, _e55);
            let _e59 = synthesis.law[1u];
            let _e60 = depths;
            let _e61 = (*depth);
            weight = select(vec2<f32>(0f, 0f), vec2<f32>(1f, 1f), (((_e60 - vec2(_e61)) * _e59) <= vec2<f32>(1f, 1f)));
            let _e68 = weight[0u];
            let _e69 = below;
            param_10 = _e69;
            let _e70 = color_sample((&param_10));
            let _e73 = weight[1u];
            let _e74 = above;
            param_11 = _e74;
            let _e75 = color_sample((&param_11));
            let _e78 = sum;
            sum = (_e78 + ((_e70 * _e68) + (_e75 * _e73)));
            let _e81 = weight[0u];
            let _e83 = weight[1u];
            let _e85 = weights;
            weights = (_e85 + (_e81 + _e83));
            continue;
        } else {
            break;
        }
        continuing {
            let _e87 = i;
            i = (_e87 + 1i);
        }
    }
    let _e89 = sum;
    let _e90 = weights;
    return (_e89 / vec4(_e90));
}

fn depth_gather(place_2: ptr<function, vec2<f32>>) -> vec4<f32> {
    var quad: vec4<f32>;

    let _e4 = (*place_2);
    let _e5 = textureGather(0, depth_map_texture, nearest_sampler, _e4);
    quad = _e5;
    let _e6 = quad;
    return _e6;
}

fn depth_pair(x_2: ptr<function, f32>) -> vec2<f32> {
    var row: f32;
    var param_12: f32;
    var param_13: f32;
    var param_14: vec2<f32>;
    var param_15: f32;
    var param_16: vec2<f32>;
    var quad_1: vec4<f32>;
    var param_17: f32;
    var param_18: vec2<f32>;
    var local_2: vec2<f32>;

    if true {
        param_12 = 0f;
        let _e19 = row_at((&param_12));
        row = _e19;
        let _e20 = (*x_2);
        param_13 = _e20;
        let _e21 = column_at((&param_13));
        let _e22 = row;
        param_14 = vec2<f32>(_e21, _e22);
        let _e24 = depth_sample((&param_14));
        let _e25 = (*x_2);
        param_15 = (_e25 + 1f);
        let _e27 = column_at((&param_15));
        let _e28 = row;
        param_16 = vec2<f32>(_e27, _e28);
        let _e30 = depth_sample((&param_16));
        return vec2<f32>(_e24, _e30);
    }
    let _e34 = synthesis.columns[0u];
    let _e35 = (*x_2);
    let _e40 = synthesis.columns[1u];
    param_17 = 0.25f;
    let _e42 = row_at((&param_17));
    param_18 = vec2<f32>(((_e34 * (_e35 + 1.25f)) + _e40), _e42);
    let _e44 = depth_gather((&param_18));
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
    var param_19: f32;
    var shift: f32;

    let _e9 = (*x_3);
    param_19 = _e9;
    let _e10 = depth_pair((&param_19));
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

fn segment_end(x_4: ptr<function, f32>, tile_row: ptr<function, i32>, below_1: ptr<function, bool>, shift_1: ptr<function, u32>) -> f32 {
    var column: u32;
    var within: u32;
    var tile: vec4<u32>;
    var marks: u32;
    var local_3: u32;
    var param_20: u32;

    let _e19 = (*x_4);
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
    let _e46 = (*x_4);
    let _e47 = marks;
    let _e48 = within;
    param_20 = (_e47 | (65536u >> bitcast<u32>(_e48)));
    let _e52 = lowest_bit((&param_20));
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
    var phi_588_: bool;
    var phi_589_: bool;
    var phi_590_: bool;
    var phi_637_: bool;
    var phi_670_: bool;

    let _e19 = (*at_1).b;
    jump = (_e19 > 0f);
    let _e22 = (*at_1).b;
    let _e24 = (*at_1).a;
    torn = ((_e22 - _e24) >= 2f);
    let _e28 = (*beside).rim;
    let _e29 = (_e28 < 0f);
    phi_590_ = _e29;
    if _e29 {
        let _e30 = jump;
        let _e31 = !(_e30);
        phi_589_ = _e31;
        if !(_e31) {
            let _e33 = torn;
            phi_588_ = _e33;
            if _e33 {
                let _e35 = (*at_1).b;
                phi_588_ = (_e35 < 1f);
            }
            let _e38 = phi_588_;
            phi_589_ = _e38;
        }
        let _e40 = phi_589_;
        phi_590_ = _e40;
    }
    let _e42 = phi_590_;
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
    phi_637_ = _e66;
    if _e66 {
        let _e69 = synthesis.law[1u];
        let _e72 = (*at_1).depths[0u];
        let _e74 = (*beside).edge_depth;
        phi_637_ = ((_e69 * (_e72 - _e74)) < 0f);
    }
    let _e79 = phi_637_;
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
    phi_670_ = _e95;
    if _e95 {
        let _e97 = (*at_1).a;
        let _e99 = torn;
        phi_670_ = ((_e97 > -0.5f) || !(_e99));
    }
    let _e103 = phi_670_;
    return _e103;
}

fn is_event(a: ptr<function, f32>, b: ptr<function, f32>) -> bool {
    var phi_501_: bool;
    var phi_502_: bool;

    let _e4 = (*a);
    let _e5 = (_e4 <= 0f);
    phi_502_ = _e5;
    if _e5 {
        let _e6 = (*b);
        let _e7 = (_e6 > 0f);
        phi_501_ = _e7;
        if !(_e7) {
            let _e9 = (*b);
            let _e11 = (*a);
            phi_501_ = (max(_e9, -1f) < _e11);
        }
        let _e14 = phi_501_;
        phi_502_ = _e14;
    }
    let _e16 = phi_502_;
    return _e16;
}

fn march(at_2: ptr<function, Search>, end: ptr<function, f32>, origin_1: ptr<function, f32>, row_1: ptr<function, i32>, surface: ptr<function, Surface>) -> vec4<f32> {
    var border: f32;
    var outside: bool;
    var beside_1: Beside;
    var local_9: f32;
    var found: bool;
    var param_21: f32;
    var param_22: f32;
    var param_23: Beside;
    var param_24: Search;
    var x_5: f32;
    var a_1: f32;
    var tile_row_1: i32;
    var below_2: bool;
    var shift_2: u32;
    var crosses: bool;
    var param_25: f32;
    var param_26: i32;
    var param_27: bool;
    var param_28: u32;
    var param_29: f32;
    var param_30: f32;
    var param_31: f32;
    var param_32: f32;
    var param_33: Beside;
    var param_34: Search;
    var local_10: f32;
    var local_11: f32;
    var last: f32;
    var b_1: f32;
    var param_35: f32;
    var param_36: f32;
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
    var away_3: f32;
    var color_1: vec4<f32>;
    var param_37: f32;
    var param_38: f32;
    var param_39: vec2<f32>;
    var param_40: vec4<f32>;
    var param_41: f32;
    var param_42: f32;
    var param_43: f32;
    var coverage: f32;
    var param_44: f32;
    var param_45: f32;
    var param_46: vec2<f32>;
    var phi_719_: bool;
    var phi_726_: bool;
    var phi_736_: bool;
    var phi_806_: bool;
    var phi_817_: bool;
    var phi_827_: bool;
    var phi_901_: bool;
    var phi_951_: bool;
    var phi_974_: bool;
    var phi_1025_: bool;
    var phi_1041_: bool;

    let _e77 = (*at_2).a;
    let _e79 = (*at_2).x;
    border = (_e77 - _e79);
    let _e82 = (*at_2).x;
    let _e84 = border;
    outside = ((_e82 <= 0f) && (_e84 > 0f));
    let _e87 = outside;
    let _e88 = border;
    let _e91 = (*end);
    (*end) = select(_e91, 0f, (_e87 && (_e88 < 0.5f)));
    let _e93 = outside;
    beside_1.edge = select(-1f, 0f, _e93);
    let _e96 = outside;
    if _e96 {
        let _e99 = (*at_2).depths[0u];
        local_9 = _e99;
    } else {
        let _e102 = synthesis.law[1u];
        local_9 = select(1000000000f, -1000000000f, (_e102 < 0f));
    }
    let _e105 = local_9;
    beside_1.edge_depth = _e105;
    beside_1.rim = -1f;
    beside_1.rim_depth = 0f;
    found = false;
    phi_719_ = true;
    if true {
        let _e110 = (*at_2).x;
        phi_719_ = (_e110 >= 0f);
    }
    let _e113 = phi_719_;
    phi_726_ = _e113;
    if _e113 {
        let _e115 = (*at_2).x;
        let _e116 = (*end);
        phi_726_ = (_e115 < _e116);
    }
    let _e119 = phi_726_;
    phi_736_ = _e119;
    if _e119 {
        let _e121 = (*at_2).a;
        param_21 = _e121;
        let _e123 = (*at_2).b;
        param_22 = _e123;
        let _e124 = is_event((&param_21), (&param_22));
        phi_736_ = _e124;
    }
    let _e126 = phi_736_;
    if _e126 {
        let _e127 = beside_1;
        param_23 = _e127;
        let _e128 = (*at_2);
        param_24 = _e128;
        let _e129 = meet((&param_23), (&param_24));
        let _e130 = param_23;
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
    below_2 = ((_e145 & 4i) == 0i);
    let _e148 = (*row_1);
    shift_2 = (bitcast<u32>((_e148 & 2i)) << bitcast<u32>(3i));
    crosses = false;
    loop {
        let _e153 = x_5;
        let _e154 = (*end);
        let _e156 = found;
        if ((_e153 <= _e154) && !(_e156)) {
            let _e159 = x_5;
            param_25 = _e159;
            let _e160 = tile_row_1;
            param_26 = _e160;
            let _e161 = below_2;
            param_27 = _e161;
            let _e162 = shift_2;
            param_28 = _e162;
            let _e163 = segment_end((&param_25), (&param_26), (&param_27), (&param_28));
            let _e164 = (*end);
            param_29 = min(_e163, _e164);
            let _e166 = (*origin_1);
            param_30 = _e166;
            let _e167 = search_at((&param_29), (&param_30));
            (*at_2) = _e167;
            let _e168 = a_1;
            let _e169 = (_e168 <= 0f);
            phi_806_ = _e169;
            if _e169 {
                let _e171 = (*at_2).a;
                phi_806_ = (_e171 > 0f);
            }
            let _e174 = phi_806_;
            crosses = _e174;
            let _e175 = crosses;
            found = _e175;
            let _e176 = crosses;
            let _e178 = (true && !(_e176));
            phi_817_ = _e178;
            if _e178 {
                let _e180 = (*at_2).x;
                let _e181 = (*end);
                phi_817_ = (_e180 < _e181);
            }
            let _e184 = phi_817_;
            phi_827_ = _e184;
            if _e184 {
                let _e186 = (*at_2).a;
                param_31 = _e186;
                let _e188 = (*at_2).b;
                param_32 = _e188;
                let _e189 = is_event((&param_31), (&param_32));
                phi_827_ = _e189;
            }
            let _e191 = phi_827_;
            if _e191 {
                let _e192 = beside_1;
                param_33 = _e192;
                let _e193 = (*at_2);
                param_34 = _e193;
                let _e194 = meet((&param_33), (&param_34));
                let _e195 = param_33;
                beside_1 = _e195;
                found = _e194;
            }
            let _e196 = found;
            if _e196 {
                let _e197 = x_5;
                local_10 = _e197;
            } else {
                let _e199 = (*at_2).x;
                local_10 = (_e199 + 1f);
            }
            let _e201 = local_10;
            x_5 = _e201;
            let _e202 = found;
            if _e202 {
                let _e203 = a_1;
                local_11 = _e203;
            } else {
                let _e205 = (*at_2).b;
                local_11 = _e205;
            }
            let _e206 = local_11;
            a_1 = _e206;
            continue;
        } else {
            break;
        }
    }
    let _e208 = (*at_2).x;
    last = _e208;
    let _e210 = (*at_2).a;
    b_1 = _e210;
    loop {
        let _e211 = crosses;
        let _e213 = x_5;
        let _e214 = last;
        if ((true && _e211) && (_e213 < _e214)) {
            let _e217 = x_5;
            let _e218 = last;
            let _e219 = x_5;
            let _e221 = a_1;
            let _e223 = a_1;
            let _e224 = b_1;
            let _e229 = x_5;
            let _e230 = last;
            param_35 = clamp(floor((_e217 + (((_e218 - _e219) * _e221) / (_e223 - _e224)))), _e229, (_e230 - 1f));
            let _e233 = (*origin_1);
            param_36 = _e233;
            let _e234 = search_at((&param_35), (&param_36));
            (*at_2) = _e234;
            let _e236 = (*at_2).a;
            let _e237 = (_e236 > 0f);
            phi_901_ = _e237;
            if !(_e237) {
                let _e240 = (*at_2).b;
                phi_901_ = (_e240 <= 0f);
            }
            let _e243 = phi_901_;
            crosses = _e243;
            let _e245 = (*at_2).a;
            behind = (_e245 > 0f);
            let _e247 = behind;
            if _e247 {
                let _e248 = x_5;
                local_12 = _e248;
            } else {
                let _e250 = (*at_2).x;
                local_12 = (_e250 + 1f);
            }
            let _e252 = local_12;
            x_5 = _e252;
            let _e253 = behind;
            if _e253 {
                let _e254 = a_1;
                local_13 = _e254;
            } else {
                let _e256 = (*at_2).b;
                local_13 = _e256;
            }
            let _e257 = local_13;
            a_1 = _e257;
            let _e258 = behind;
            if _e258 {
                let _e260 = (*at_2).x;
                local_14 = _e260;
            } else {
                let _e261 = last;
                local_14 = _e261;
            }
            let _e262 = local_14;
            last = _e262;
            let _e263 = behind;
            if _e263 {
                let _e265 = (*at_2).a;
                local_15 = _e265;
            } else {
                let _e266 = b_1;
                local_15 = _e266;
            }
            let _e267 = local_15;
            b_1 = _e267;
            continue;
        } else {
            break;
        }
    }
    let _e268 = found;
    phi_951_ = _e268;
    if !(_e268) {
        let _e271 = beside_1.edge;
        phi_951_ = (_e271 < 0f);
    }
    let _e274 = phi_951_;
    own = _e274;
    let _e275 = own;
    if _e275 {
        let _e277 = (*at_2).x;
        let _e278 = (*end);
        local_16 = min(_e277, _e278);
    } else {
        let _e281 = beside_1.edge;
        local_16 = _e281;
    }
    let _e282 = local_16;
    x_5 = _e282;
    let _e283 = found;
    phi_974_ = _e283;
    if _e283 {
        let _e285 = (*at_2).b;
        let _e287 = (*at_2).a;
        phi_974_ = ((_e285 - _e287) < 2f);
    }
    let _e291 = phi_974_;
    if _e291 {
        let _e293 = (*at_2).a;
        let _e296 = (*at_2).b;
        let _e298 = (*at_2).a;
        local_17 = (-(_e293) / (_e296 - _e298));
    } else {
        local_17 = 0f;
    }
    let _e301 = local_17;
    t = _e301;
    let _e302 = x_5;
    let _e303 = t;
    (*surface).source = (_e302 + _e303);
    let _e306 = own;
    if _e306 {
        let _e309 = (*at_2).depths[0u];
        let _e312 = (*at_2).depths[1u];
        let _e313 = t;
        local_18 = mix(_e309, _e312, _e313);
    } else {
        let _e316 = beside_1.edge_depth;
        local_18 = _e316;
    }
    let _e317 = local_18;
    (*surface).depth = _e317;
    let _e319 = x_5;
    let _e320 = (*origin_1);
    let _e324 = synthesis.law[1u];
    let _e326 = (*surface).depth;
    away_3 = ((_e319 - _e320) + (_e324 * _e326));
    let _e329 = found;
    let _e330 = !(_e329);
    phi_1025_ = _e330;
    if _e330 {
        let _e331 = away_3;
        phi_1025_ = (abs(_e331) >= 0.5f);
    }
    let _e335 = phi_1025_;
    (*surface).hole = _e335;
    let _e338 = (*surface).source;
    param_37 = _e338;
    let _e339 = column_at((&param_37));
    param_38 = 0f;
    let _e340 = row_at((&param_38));
    param_39 = vec2<f32>(_e339, _e340);
    let _e342 = color_sample((&param_39));
    color_1 = _e342;
    phi_1041_ = true;
    if true {
        let _e344 = (*surface).hole;
        phi_1041_ = _e344;
    }
    let _e346 = phi_1041_;
    if _e346 {
        let _e347 = color_1;
        param_40 = _e347;
        let _e348 = away_3;
        param_41 = _e348;
        let _e349 = x_5;
        param_42 = _e349;
        let _e351 = (*surface).depth;
        param_43 = _e351;
        let _e352 = fill_hole((&param_40), (&param_41), (&param_42), (&param_43));
        color_1 = _e352;
    }
    let _e354 = beside_1.rim;
    if (_e354 >= 0f) {
        let _e357 = beside_1.rim;
        let _e358 = (*origin_1);
        let _e362 = synthesis.law[1u];
        let _e364 = beside_1.rim_depth;
        coverage = (1f - abs(((_e357 - _e358) + (_e362 * _e364))));
        let _e369 = color_1;
        let _e371 = beside_1.rim;
        param_44 = _e371;
        let _e372 = column_at((&param_44));
        param_45 = 0f;
        let _e373 = row_at((&param_45));
        param_46 = vec2<f32>(_e372, _e373);
        let _e375 = color_sample((&param_46));
        let _e376 = coverage;
        color_1 = mix(_e369, _e375, vec4(_e376));
        let _e379 = coverage;
        if (_e379 >= 0.5f) {
            let _e382 = beside_1.rim;
            let _e384 = beside_1.rim_depth;
            (*surface) = Surface(_e382, _e384, false);
        }
    }
    let _e386 = color_1;
    return _e386;
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
    var phi_1242_: bool;
    var phi_1251_: bool;
    var phi_1334_: bool;
    var phi_1347_: bool;

    let _e40 = synthesis.origins[0u];
    let _e42 = gl_FragCoord_1[0u];
    let _e46 = synthesis.origins[1u];
    origin_2 = ((_e40 * _e42) + _e46);
    let _e48 = origin_2;
    let _e50 = synthesis.farthest;
    let _e52 = (*span_1);
    param_47 = floor(((_e48 - _e50) - bitcast<f32>(_e52)));
    let _e56 = origin_2;
    param_48 = _e56;
    let _e57 = search_at((&param_47), (&param_48));
    at_3 = _e57;
    let _e59 = at_3.x;
    let _e61 = (*span_1);
    param_49 = _e61;
    let _e62 = span_steps((&param_49));
    let _e66 = synthesis.source_size[0u];
    end_1 = min((max(_e59, 0f) + _e62), f32((_e66 - 1i)));
    let _e71 = at_3.x;
    let _e73 = end_1;
    limit = min((_e71 + 2f), _e73);
    loop {
        let _e76 = at_3.x;
        let _e77 = limit;
        let _e78 = (_e76 < _e77);
        phi_1242_ = _e78;
        if _e78 {
            let _e80 = at_3.b;
            phi_1242_ = (_e80 <= 0f);
        }
        let _e83 = phi_1242_;
        phi_1251_ = _e83;
        if _e83 {
            let _e85 = at_3.b;
            let _e88 = at_3.a;
            phi_1251_ = (max(_e85, -1f) >= _e88);
        }
        let _e91 = phi_1251_;
        if _e91 {
            let _e93 = at_3.x;
            param_50 = (_e93 + 2f);
            let _e95 = column_at((&param_50));
            param_51 = 0f;
            let _e96 = row_at((&param_51));
            param_52 = vec2<f32>(_e95, _e96);
            let _e98 = depth_sample((&param_52));
            next = _e98;
            let _e101 = at_3.depths[1u];
            let _e102 = next;
            at_3.depths = vec2<f32>(_e101, _e102);
            let _e106 = at_3.b;
            at_3.a = _e106;
            let _e109 = at_3.x;
            let _e111 = origin_2;
            let _e115 = synthesis.law[1u];
            let _e116 = next;
            at_3.b = (((_e109 + 2f) - _e111) + (_e115 * _e116));
            continue;
        } else {
            break;
        }
        continuing {
            let _e121 = at_3.x;
            at_3.x = (_e121 + 1f);
        }
    }
    let _e125 = at_3.b;
    let _e127 = at_3.a;
    stretch = (_e125 - _e127);
    let _e130 = at_3.a;
    let _e132 = stretch;
    t_1 = (-(_e130) / _e132);
    let _e135 = at_3.x;
    let _e136 = t_1;
    let _e140 = at_3.depths[0u];
    let _e143 = at_3.depths[1u];
    let _e144 = t_1;
    (*surface_1) = Surface((_e135 + _e136), mix(_e140, _e143, _e144), false);
    let _e148 = (*surface_1).source;
    param_53 = _e148;
    let _e149 = column_at((&param_53));
    param_54 = 0f;
    let _e150 = row_at((&param_54));
    param_55 = vec2<f32>(_e149, _e150);
    let _e152 = color_sample((&param_55));
    seen = _e152;
    let _e155 = synthesis.source_size[0u];
    middle = (0.5f * f32((_e155 - 1i)));
    let _e160 = at_3.a;
    let _e161 = (_e160 <= 0f);
    phi_1334_ = _e161;
    if _e161 {
        let _e163 = at_3.b;
        phi_1334_ = (_e163 > 0f);
    }
    let _e166 = phi_1334_;
    let _e167 = stretch;
    let _e169 = (_e166 && (_e167 < 2f));
    phi_1347_ = _e169;
    if _e169 {
        let _e171 = (*surface_1).source;
        let _e172 = middle;
        let _e175 = middle;
        phi_1347_ = (abs((_e171 - _e172)) <= _e175);
    }
    let _e178 = phi_1347_;
    done = _e178;
    let _e179 = done;
    if (true && !(_e179)) {
        let _e182 = source_row();
        let _e183 = at_3;
        param_56 = _e183;
        let _e184 = end_1;
        param_57 = _e184;
        let _e185 = origin_2;
        param_58 = _e185;
        param_59 = _e182;
        let _e186 = march((&param_56), (&param_57), (&param_58), (&param_59), (&param_60));
        let _e187 = param_60;
        (*surface_1) = _e187;
        seen = _e186;
    }
    let _e188 = seen;
    return _e188;
}

fn lawful(affine: ptr<function, vec3<f32>>, surface_2: ptr<function, Surface>) -> vec4<f32> {
    var place_3: f32;
    var depths_2: vec2<f32>;
    var param_61: f32;
    var at_4: vec2<f32>;
    var param_62: f32;
    var param_63: vec2<f32>;

    let _e18 = (*affine)[0u];
    let _e20 = (*affine)[1u];
    let _e22 = gl_FragCoord_1[0u];
    let _e26 = (*affine)[2u];
    let _e28 = gl_FragCoord_1[1u];
    place_3 = ((_e18 + (_e20 * _e22)) + (_e26 * _e28));
    let _e31 = place_3;
    let _e34 = synthesis.columns[1u];
    let _e38 = synthesis.columns[0u];
    let _e43 = synthesis.source_size[0u];
    (*surface_2).source = clamp((((_e31 - _e34) / _e38) - 0.5f), 0f, f32((_e43 - 1i)));
    let _e50 = synthesis.origins[0u];
    let _e52 = gl_FragCoord_1[0u];
    let _e56 = synthesis.origins[1u];
    let _e59 = (*surface_2).source;
    let _e63 = synthesis.law[1u];
    (*surface_2).depth = ((((_e50 * _e52) + _e56) - _e59) / _e63);
    let _e68 = synthesis.law[1u];
    if (_e68 == 0f) {
        let _e71 = (*surface_2).source;
        param_61 = floor(_e71);
        let _e73 = depth_pair((&param_61));
        depths_2 = _e73;
        let _e75 = depths_2[0u];
        let _e77 = depths_2[1u];
        let _e79 = (*surface_2).source;
        (*surface_2).depth = mix(_e75, _e77, fract(_e79));
    }
    (*surface_2).hole = false;
    let _e84 = place_3;
    param_62 = 0f;
    let _e85 = row_at((&param_62));
    at_4 = vec2<f32>(_e84, _e85);
    let _e87 = at_4;
    param_63 = _e87;
    let _e88 = color_sample((&param_63));
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
    var surface_3: Surface;
    var param_64: vec3<f32>;
    var param_65: Surface;
    var param_66: u32;
    var param_67: Surface;
    var vector: vec4<f32>;
    var param_68: f32;
    var param_69: f32;
    var param_70: vec2<f32>;
    var scale: vec2<f32>;
    var phi_1374_: bool;

    let _e20 = pixel_span();
    span_2 = _e20;
    phi_1374_ = true;
    if true {
        let _e22 = span_2[1u];
        phi_1374_ = (_e22 != 0u);
    }
    let _e25 = phi_1374_;
    if _e25 {
        let _e26 = span_2;
        param_64 = bitcast<vec3<f32>>(_e26.xyz);
        let _e29 = lawful((&param_64), (&param_65));
        let _e30 = param_65;
        surface_3 = _e30;
        color_2 = _e29;
    } else {
        if true {
            let _e32 = span_2[0u];
            param_66 = _e32;
            let _e33 = searched((&param_66), (&param_67));
            let _e34 = param_67;
            surface_3 = _e34;
            color_2 = _e33;
        } else {
            discard;
        }
    }
    let _e36 = surface_3.source;
    param_68 = _e36;
    let _e37 = column_at((&param_68));
    param_69 = 0f;
    let _e38 = row_at((&param_69));
    param_70 = vec2<f32>(_e37, _e38);
    let _e40 = color_sample((&param_70));
    vector = _e40;
    let _e42 = synthesis.source_size;
    let _e45 = synthesis.target_size;
    let _e50 = synthesis.motion[3u];
    scale = mix(vec2<f32>(1f, 1f), (vec2<f32>(_e42) / vec2<f32>(_e45)), vec2(_e50));
    let _e53 = scale;
    let _e54 = vector;
    let _e56 = (_e53 * _e54.xy);
    let _e57 = vector;
    let _e58 = _e57.zw;
    color_2 = vec4<f32>(_e56.x, _e56.y, _e58.x, _e58.y);
    let _e66 = synthesis.motion[0u];
    let _e68 = vector[2u];
    let _e72 = synthesis.motion[1u];
    let _e74 = surface_3.depth;
    let _e79 = synthesis.motion[2u];
    let _e82 = color_2[0u];
    color_2[0u] = (_e82 + (((_e66 * _e68) + (_e72 * _e74)) + _e79));
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
