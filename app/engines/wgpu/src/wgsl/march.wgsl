// Made of yoro's GLSL by `cargo xtask maintain wgsl`.
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
@group(0) @binding(8) 
var nearest_sampler: sampler;
@group(0) @binding(1) 
var color_map_texture: texture_2d<f32>;
@group(0) @binding(9) 
var linear_sampler: sampler;
@group(0) @binding(7) 
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

fn depth_sample(place_1: ptr<function, vec2<f32>>) -> f32 {
    let _e4 = (*place_1);
    let _e5 = textureSampleLevel(depth_map_texture, nearest_sampler, _e4, 0f);
    return _e5.x;
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

fn source_column(x_1: ptr<function, i32>) -> i32 {
    var local_2: i32;

    let _e6 = synthesis.mirrored;
    if (_e6 != 0u) {
        let _e10 = synthesis.source_size[0u];
        let _e12 = (*x_1);
        local_2 = ((_e10 - 1i) - _e12);
    } else {
        let _e14 = (*x_1);
        local_2 = _e14;
    }
    let _e15 = local_2;
    return _e15;
}

fn fill_spread(away_1: ptr<function, f32>) -> f32 {
    let _e4 = (*away_1);
    return (0.5f * clamp(abs(_e4), 1f, 12f));
}

fn fill_hole(hole: ptr<function, bool>, color: ptr<function, vec4<f32>>, away_2: ptr<function, f32>, x_2: ptr<function, f32>, depth: ptr<function, f32>, row: ptr<function, i32>) -> vec4<f32> {
    var spread: f32;
    var param_2: f32;
    var sum: vec4<f32>;
    var weights: f32;
    var edge: i32;
    var param_3: i32;
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
    var below_color: vec4<f32>;
    var param_10: vec2<f32>;
    var above_color: vec4<f32>;
    var param_11: vec2<f32>;
    var weight: vec2<f32>;

    let _e36 = (*away_2);
    param_2 = _e36;
    let _e37 = fill_spread((&param_2));
    spread = _e37;
    let _e38 = (*color);
    sum = (_e38 * 2f);
    weights = 2f;
    let _e40 = (*x_2);
    param_3 = i32(_e40);
    let _e42 = source_column((&param_3));
    edge = _e42;
    let _e43 = (*hole);
    i = select(3i, 1i, _e43);
    loop {
        let _e45 = i;
        if (_e45 <= 2i) {
            let _e47 = i;
            let _e49 = spread;
            distance_ = round((f32(_e47) * _e49));
            let _e52 = (*x_2);
            param_4 = _e52;
            let _e53 = column_at((&param_4));
            let _e54 = distance_;
            param_5 = -(_e54);
            let _e56 = row_at((&param_5));
            below = vec2<f32>(_e53, _e56);
            let _e58 = (*x_2);
            param_6 = _e58;
            let _e59 = column_at((&param_6));
            let _e60 = distance_;
            param_7 = _e60;
            let _e61 = row_at((&param_7));
            above = vec2<f32>(_e59, _e61);
            let _e63 = below;
            param_8 = _e63;
            let _e64 = depth_sample((&param_8));
            let _e65 = above;
            param_9 = _e65;
            let _e66 = depth_sample((&param_9));
            depths = vec2<f32>(_e64, _e66);
            let _e68 = below;
            param_10 = _e68;
            let _e69 = color_sample((&param_10));
            below_color = _e69;
            let _e70 = above;
            param_11 = _e70;
            let _e71 = color_sample((&param_11));
            above_color = _e71;
            let _e74 = synthesis.law[1u];
            let _e75 = depths;
            let _e76 = (*depth);
            weight = select(vec2<f32>(0f, 0f), vec2<f32>(1f, 1f), (((_e75 - vec2(_e76)) * _e74) <= vec2<f32>(1f, 1f)));
            let _e83 = weight[0u];
            let _e84 = below_color;
            let _e87 = weight[1u];
            let _e88 = above_color;
            let _e91 = sum;
            sum = (_e91 + ((_e84 * _e83) + (_e88 * _e87)));
            let _e94 = weight[0u];
            let _e96 = weight[1u];
            let _e98 = weights;
            weights = (_e98 + (_e94 + _e96));
            continue;
        } else {
            break;
        }
        continuing {
            let _e100 = i;
            i = (_e100 + 1i);
        }
    }
    let _e102 = sum;
    let _e103 = weights;
    return (_e102 / vec4(_e103));
}

fn depth_pair(x_3: ptr<function, f32>) -> vec2<f32> {
    var row_1: f32;
    var param_12: f32;
    var param_13: f32;
    var param_14: vec2<f32>;
    var param_15: f32;
    var param_16: vec2<f32>;
    var quad: vec4<f32>;
    var param_17: f32;
    var local_3: vec2<f32>;

    if true {
        param_12 = 0f;
        let _e20 = row_at((&param_12));
        row_1 = _e20;
        let _e21 = (*x_3);
        param_13 = _e21;
        let _e22 = column_at((&param_13));
        let _e23 = row_1;
        param_14 = vec2<f32>(_e22, _e23);
        let _e25 = depth_sample((&param_14));
        let _e26 = (*x_3);
        param_15 = (_e26 + 1f);
        let _e28 = column_at((&param_15));
        let _e29 = row_1;
        param_16 = vec2<f32>(_e28, _e29);
        let _e31 = depth_sample((&param_16));
        return vec2<f32>(_e25, _e31);
    }
    let _e35 = synthesis.columns[0u];
    let _e36 = (*x_3);
    let _e41 = synthesis.columns[1u];
    param_17 = 0.25f;
    let _e43 = row_at((&param_17));
    let _e45 = textureGather(0, depth_map_texture, nearest_sampler, vec2<f32>(((_e35 * (_e36 + 1.25f)) + _e41), _e43));
    quad = _e45;
    let _e47 = synthesis.mirrored;
    if (_e47 != 0u) {
        let _e49 = quad;
        local_3 = _e49.zw;
    } else {
        let _e51 = quad;
        local_3 = _e51.wz;
    }
    let _e53 = local_3;
    return _e53;
}

fn search_at(x_4: ptr<function, f32>, origin: ptr<function, f32>) -> Search {
    var depths_1: vec2<f32>;
    var param_18: f32;
    var shift: f32;

    let _e9 = (*x_4);
    param_18 = _e9;
    let _e10 = depth_pair((&param_18));
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

fn segment_end(x_5: ptr<function, f32>, tile_row: ptr<function, i32>, below_1: ptr<function, bool>, shift_1: ptr<function, u32>) -> f32 {
    var column: u32;
    var within: u32;
    var tile: vec4<u32>;
    var marks: u32;
    var local_4: u32;

    let _e18 = (*x_5);
    column = u32(_e18);
    let _e20 = column;
    within = (_e20 % 16u);
    let _e22 = column;
    let _e25 = (*tile_row);
    let _e27 = textureLoad(tile_map_texture, vec2<i32>(bitcast<i32>((_e22 / 16u)), _e25), 0i);
    tile = _e27;
    let _e28 = (*below_1);
    if _e28 {
        let _e30 = tile[1u];
        local_4 = _e30;
    } else {
        let _e32 = tile[3u];
        local_4 = _e32;
    }
    let _e33 = local_4;
    let _e34 = (*shift_1);
    let _e35 = within;
    marks = (_e33 >> bitcast<u32>((_e34 + _e35)));
    let _e40 = tile[2u];
    let _e43 = marks;
    marks = select(0u, _e43, (_e40 == bitcast<u32>(9f)));
    let _e45 = (*x_5);
    let _e46 = marks;
    let _e47 = within;
    return (_e45 + f32(firstTrailingBit((_e46 | (65536u >> bitcast<u32>(_e47))))));
}

fn meet(beside: ptr<function, Beside>, at_1: ptr<function, Search>) -> bool {
    var jump: bool;
    var torn: bool;
    var rim: bool;
    var local_5: f32;
    var local_6: f32;
    var local_7: f32;
    var farther: bool;
    var local_8: f32;
    var local_9: f32;
    var phi_594_: bool;
    var phi_595_: bool;
    var phi_596_: bool;
    var phi_643_: bool;
    var phi_676_: bool;

    let _e19 = (*at_1).b;
    jump = (_e19 > 0f);
    let _e22 = (*at_1).b;
    let _e24 = (*at_1).a;
    torn = ((_e22 - _e24) >= 2f);
    let _e28 = (*beside).rim;
    let _e29 = (_e28 < 0f);
    phi_596_ = _e29;
    if _e29 {
        let _e30 = jump;
        let _e31 = !(_e30);
        phi_595_ = _e31;
        if !(_e31) {
            let _e33 = torn;
            phi_594_ = _e33;
            if _e33 {
                let _e35 = (*at_1).b;
                phi_594_ = (_e35 < 1f);
            }
            let _e38 = phi_594_;
            phi_595_ = _e38;
        }
        let _e40 = phi_595_;
        phi_596_ = _e40;
    }
    let _e42 = phi_596_;
    rim = _e42;
    let _e43 = rim;
    if _e43 {
        let _e45 = (*at_1).x;
        let _e46 = jump;
        local_5 = (_e45 + select(0f, 1f, _e46));
    } else {
        let _e50 = (*beside).rim;
        local_5 = _e50;
    }
    let _e51 = local_5;
    (*beside).rim = _e51;
    let _e53 = rim;
    if _e53 {
        let _e54 = jump;
        if _e54 {
            let _e57 = (*at_1).depths[1u];
            local_7 = _e57;
        } else {
            let _e60 = (*at_1).depths[0u];
            local_7 = _e60;
        }
        let _e61 = local_7;
        local_6 = _e61;
    } else {
        let _e63 = (*beside).rim_depth;
        local_6 = _e63;
    }
    let _e64 = local_6;
    (*beside).rim_depth = _e64;
    let _e66 = jump;
    phi_643_ = _e66;
    if _e66 {
        let _e69 = synthesis.law[1u];
        let _e72 = (*at_1).depths[0u];
        let _e74 = (*beside).edge_depth;
        phi_643_ = ((_e69 * (_e72 - _e74)) < 0f);
    }
    let _e79 = phi_643_;
    farther = _e79;
    let _e80 = farther;
    if _e80 {
        let _e82 = (*at_1).x;
        local_8 = _e82;
    } else {
        let _e84 = (*beside).edge;
        local_8 = _e84;
    }
    let _e85 = local_8;
    (*beside).edge = _e85;
    let _e87 = farther;
    if _e87 {
        let _e90 = (*at_1).depths[0u];
        local_9 = _e90;
    } else {
        let _e92 = (*beside).edge_depth;
        local_9 = _e92;
    }
    let _e93 = local_9;
    (*beside).edge_depth = _e93;
    let _e95 = jump;
    phi_676_ = _e95;
    if _e95 {
        let _e97 = (*at_1).a;
        let _e99 = torn;
        phi_676_ = ((_e97 > -0.5f) || !(_e99));
    }
    let _e103 = phi_676_;
    return _e103;
}

fn is_event(a: ptr<function, f32>, b: ptr<function, f32>) -> bool {
    var phi_507_: bool;
    var phi_508_: bool;

    let _e4 = (*a);
    let _e5 = (_e4 <= 0f);
    phi_508_ = _e5;
    if _e5 {
        let _e6 = (*b);
        let _e7 = (_e6 > 0f);
        phi_507_ = _e7;
        if !(_e7) {
            let _e9 = (*b);
            let _e11 = (*a);
            phi_507_ = (max(_e9, -1f) < _e11);
        }
        let _e14 = phi_507_;
        phi_508_ = _e14;
    }
    let _e16 = phi_508_;
    return _e16;
}

fn march(at_2: ptr<function, Search>, end: ptr<function, f32>, origin_1: ptr<function, f32>, row_2: ptr<function, i32>, surface: ptr<function, Surface>) -> vec4<f32> {
    var border: f32;
    var outside: bool;
    var beside_1: Beside;
    var local_10: f32;
    var found: bool;
    var param_19: f32;
    var param_20: f32;
    var param_21: Beside;
    var param_22: Search;
    var x_6: f32;
    var a_1: f32;
    var tile_row_1: i32;
    var below_2: bool;
    var shift_2: u32;
    var crosses: bool;
    var param_23: f32;
    var param_24: i32;
    var param_25: bool;
    var param_26: u32;
    var param_27: f32;
    var param_28: f32;
    var param_29: f32;
    var param_30: f32;
    var param_31: Beside;
    var param_32: Search;
    var local_11: f32;
    var local_12: f32;
    var last: f32;
    var b_1: f32;
    var param_33: f32;
    var param_34: f32;
    var behind: bool;
    var local_13: f32;
    var local_14: f32;
    var local_15: f32;
    var local_16: f32;
    var own: bool;
    var local_17: f32;
    var t: f32;
    var local_18: f32;
    var local_19: f32;
    var away_3: f32;
    var color_1: vec4<f32>;
    var param_35: f32;
    var param_36: f32;
    var param_37: vec2<f32>;
    var param_38: bool;
    var param_39: vec4<f32>;
    var param_40: f32;
    var param_41: f32;
    var param_42: f32;
    var param_43: i32;
    var coverage: f32;
    var param_44: f32;
    var param_45: f32;
    var param_46: vec2<f32>;
    var phi_725_: bool;
    var phi_732_: bool;
    var phi_742_: bool;
    var phi_812_: bool;
    var phi_823_: bool;
    var phi_833_: bool;
    var phi_907_: bool;
    var phi_957_: bool;
    var phi_980_: bool;
    var phi_1031_: bool;
    var phi_1047_: bool;

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
        local_10 = _e101;
    } else {
        let _e104 = synthesis.law[1u];
        local_10 = select(1000000000f, -1000000000f, (_e104 < 0f));
    }
    let _e107 = local_10;
    beside_1.edge_depth = _e107;
    beside_1.rim = -1f;
    beside_1.rim_depth = 0f;
    found = false;
    phi_725_ = true;
    if true {
        let _e112 = (*at_2).x;
        phi_725_ = (_e112 >= 0f);
    }
    let _e115 = phi_725_;
    phi_732_ = _e115;
    if _e115 {
        let _e117 = (*at_2).x;
        let _e118 = (*end);
        phi_732_ = (_e117 < _e118);
    }
    let _e121 = phi_732_;
    phi_742_ = _e121;
    if _e121 {
        let _e123 = (*at_2).a;
        param_19 = _e123;
        let _e125 = (*at_2).b;
        param_20 = _e125;
        let _e126 = is_event((&param_19), (&param_20));
        phi_742_ = _e126;
    }
    let _e128 = phi_742_;
    if _e128 {
        let _e129 = beside_1;
        param_21 = _e129;
        let _e130 = (*at_2);
        param_22 = _e130;
        let _e131 = meet((&param_21), (&param_22));
        let _e132 = param_21;
        beside_1 = _e132;
        found = _e131;
    }
    let _e134 = (*at_2).x;
    x_6 = max((_e134 + 1f), 0f);
    let _e138 = (*at_2).b;
    let _e139 = x_6;
    let _e141 = (*at_2).x;
    a_1 = (_e138 + ((_e139 - _e141) - 1f));
    let _e145 = (*row_2);
    tile_row_1 = (_e145 / 8i);
    let _e147 = (*row_2);
    below_2 = ((_e147 & 4i) == 0i);
    let _e150 = (*row_2);
    shift_2 = (bitcast<u32>((_e150 & 2i)) << bitcast<u32>(3i));
    crosses = false;
    loop {
        let _e155 = x_6;
        let _e156 = (*end);
        let _e158 = found;
        if ((_e155 <= _e156) && !(_e158)) {
            let _e161 = x_6;
            param_23 = _e161;
            let _e162 = tile_row_1;
            param_24 = _e162;
            let _e163 = below_2;
            param_25 = _e163;
            let _e164 = shift_2;
            param_26 = _e164;
            let _e165 = segment_end((&param_23), (&param_24), (&param_25), (&param_26));
            let _e166 = (*end);
            param_27 = min(_e165, _e166);
            let _e168 = (*origin_1);
            param_28 = _e168;
            let _e169 = search_at((&param_27), (&param_28));
            (*at_2) = _e169;
            let _e170 = a_1;
            let _e171 = (_e170 <= 0f);
            phi_812_ = _e171;
            if _e171 {
                let _e173 = (*at_2).a;
                phi_812_ = (_e173 > 0f);
            }
            let _e176 = phi_812_;
            crosses = _e176;
            let _e177 = crosses;
            found = _e177;
            let _e178 = crosses;
            let _e180 = (true && !(_e178));
            phi_823_ = _e180;
            if _e180 {
                let _e182 = (*at_2).x;
                let _e183 = (*end);
                phi_823_ = (_e182 < _e183);
            }
            let _e186 = phi_823_;
            phi_833_ = _e186;
            if _e186 {
                let _e188 = (*at_2).a;
                param_29 = _e188;
                let _e190 = (*at_2).b;
                param_30 = _e190;
                let _e191 = is_event((&param_29), (&param_30));
                phi_833_ = _e191;
            }
            let _e193 = phi_833_;
            if _e193 {
                let _e194 = beside_1;
                param_31 = _e194;
                let _e195 = (*at_2);
                param_32 = _e195;
                let _e196 = meet((&param_31), (&param_32));
                let _e197 = param_31;
                beside_1 = _e197;
                found = _e196;
            }
            let _e198 = found;
            if _e198 {
                let _e199 = x_6;
                local_11 = _e199;
            } else {
                let _e201 = (*at_2).x;
                local_11 = (_e201 + 1f);
            }
            let _e203 = local_11;
            x_6 = _e203;
            let _e204 = found;
            if _e204 {
                let _e205 = a_1;
                local_12 = _e205;
            } else {
                let _e207 = (*at_2).b;
                local_12 = _e207;
            }
            let _e208 = local_12;
            a_1 = _e208;
            continue;
        } else {
            break;
        }
    }
    let _e210 = (*at_2).x;
    last = _e210;
    let _e212 = (*at_2).a;
    b_1 = _e212;
    loop {
        let _e213 = crosses;
        let _e215 = x_6;
        let _e216 = last;
        if ((true && _e213) && (_e215 < _e216)) {
            let _e219 = x_6;
            let _e220 = last;
            let _e221 = x_6;
            let _e223 = a_1;
            let _e225 = a_1;
            let _e226 = b_1;
            let _e231 = x_6;
            let _e232 = last;
            param_33 = clamp(floor((_e219 + (((_e220 - _e221) * _e223) / (_e225 - _e226)))), _e231, (_e232 - 1f));
            let _e235 = (*origin_1);
            param_34 = _e235;
            let _e236 = search_at((&param_33), (&param_34));
            (*at_2) = _e236;
            let _e238 = (*at_2).a;
            let _e239 = (_e238 > 0f);
            phi_907_ = _e239;
            if !(_e239) {
                let _e242 = (*at_2).b;
                phi_907_ = (_e242 <= 0f);
            }
            let _e245 = phi_907_;
            crosses = _e245;
            let _e247 = (*at_2).a;
            behind = (_e247 > 0f);
            let _e249 = behind;
            if _e249 {
                let _e250 = x_6;
                local_13 = _e250;
            } else {
                let _e252 = (*at_2).x;
                local_13 = (_e252 + 1f);
            }
            let _e254 = local_13;
            x_6 = _e254;
            let _e255 = behind;
            if _e255 {
                let _e256 = a_1;
                local_14 = _e256;
            } else {
                let _e258 = (*at_2).b;
                local_14 = _e258;
            }
            let _e259 = local_14;
            a_1 = _e259;
            let _e260 = behind;
            if _e260 {
                let _e262 = (*at_2).x;
                local_15 = _e262;
            } else {
                let _e263 = last;
                local_15 = _e263;
            }
            let _e264 = local_15;
            last = _e264;
            let _e265 = behind;
            if _e265 {
                let _e267 = (*at_2).a;
                local_16 = _e267;
            } else {
                let _e268 = b_1;
                local_16 = _e268;
            }
            let _e269 = local_16;
            b_1 = _e269;
            continue;
        } else {
            break;
        }
    }
    let _e270 = found;
    phi_957_ = _e270;
    if !(_e270) {
        let _e273 = beside_1.edge;
        phi_957_ = (_e273 < 0f);
    }
    let _e276 = phi_957_;
    own = _e276;
    let _e277 = own;
    if _e277 {
        let _e279 = (*at_2).x;
        let _e280 = (*end);
        local_17 = min(_e279, _e280);
    } else {
        let _e283 = beside_1.edge;
        local_17 = _e283;
    }
    let _e284 = local_17;
    x_6 = _e284;
    let _e285 = found;
    phi_980_ = _e285;
    if _e285 {
        let _e287 = (*at_2).b;
        let _e289 = (*at_2).a;
        phi_980_ = ((_e287 - _e289) < 2f);
    }
    let _e293 = phi_980_;
    if _e293 {
        let _e295 = (*at_2).a;
        let _e298 = (*at_2).b;
        let _e300 = (*at_2).a;
        local_18 = (-(_e295) / (_e298 - _e300));
    } else {
        local_18 = 0f;
    }
    let _e303 = local_18;
    t = _e303;
    let _e304 = x_6;
    let _e305 = t;
    (*surface).source = (_e304 + _e305);
    let _e308 = own;
    if _e308 {
        let _e311 = (*at_2).depths[0u];
        let _e314 = (*at_2).depths[1u];
        let _e315 = t;
        local_19 = mix(_e311, _e314, _e315);
    } else {
        let _e318 = beside_1.edge_depth;
        local_19 = _e318;
    }
    let _e319 = local_19;
    (*surface).depth = _e319;
    let _e321 = x_6;
    let _e322 = (*origin_1);
    let _e326 = synthesis.law[1u];
    let _e328 = (*surface).depth;
    away_3 = ((_e321 - _e322) + (_e326 * _e328));
    let _e331 = found;
    let _e332 = !(_e331);
    phi_1031_ = _e332;
    if _e332 {
        let _e333 = away_3;
        phi_1031_ = (abs(_e333) >= 0.5f);
    }
    let _e337 = phi_1031_;
    (*surface).hole = _e337;
    let _e340 = (*surface).source;
    param_35 = _e340;
    let _e341 = column_at((&param_35));
    param_36 = 0f;
    let _e342 = row_at((&param_36));
    param_37 = vec2<f32>(_e341, _e342);
    let _e344 = color_sample((&param_37));
    color_1 = _e344;
    phi_1047_ = true;
    if true {
        let _e346 = (*surface).hole;
        phi_1047_ = _e346;
    }
    let _e348 = phi_1047_;
    if _e348 {
        param_38 = true;
        let _e349 = color_1;
        param_39 = _e349;
        let _e350 = away_3;
        param_40 = _e350;
        let _e351 = x_6;
        param_41 = _e351;
        let _e353 = (*surface).depth;
        param_42 = _e353;
        let _e354 = (*row_2);
        param_43 = _e354;
        let _e355 = fill_hole((&param_38), (&param_39), (&param_40), (&param_41), (&param_42), (&param_43));
        color_1 = _e355;
    }
    let _e357 = beside_1.rim;
    if (_e357 >= 0f) {
        let _e360 = beside_1.rim;
        let _e361 = (*origin_1);
        let _e365 = synthesis.law[1u];
        let _e367 = beside_1.rim_depth;
        coverage = (1f - abs(((_e360 - _e361) + (_e365 * _e367))));
        let _e372 = color_1;
        let _e374 = beside_1.rim;
        param_44 = _e374;
        let _e375 = column_at((&param_44));
        param_45 = 0f;
        let _e376 = row_at((&param_45));
        param_46 = vec2<f32>(_e375, _e376);
        let _e378 = color_sample((&param_46));
        let _e379 = coverage;
        color_1 = mix(_e372, _e378, vec4(_e379));
        let _e382 = coverage;
        if (_e382 >= 0.5f) {
            let _e385 = beside_1.rim;
            let _e387 = beside_1.rim_depth;
            (*surface) = Surface(_e385, _e387, false);
        }
    }
    let _e389 = color_1;
    return _e389;
}

fn source_row() -> i32 {
    let _e6 = gl_FragCoord_1[1u];
    let _e8 = synthesis.first_row;
    let _e12 = synthesis.source_size[1u];
    return i32(clamp((_e6 - _e8), 0f, f32((_e12 - 1i))));
}

fn span_steps(span: ptr<function, u32>) -> f32 {
    var steps: u32;
    var local_20: f32;

    let _e5 = (*span);
    steps = (_e5 & 1023u);
    let _e7 = steps;
    if (_e7 == 1023u) {
        local_20 = 1000000000f;
    } else {
        let _e9 = steps;
        local_20 = f32(_e9);
    }
    let _e11 = local_20;
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
    var phi_1199_: bool;
    var phi_1208_: bool;
    var phi_1291_: bool;
    var phi_1304_: bool;

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
        phi_1199_ = _e78;
        if _e78 {
            let _e80 = at_3.b;
            phi_1199_ = (_e80 <= 0f);
        }
        let _e83 = phi_1199_;
        phi_1208_ = _e83;
        if _e83 {
            let _e85 = at_3.b;
            let _e88 = at_3.a;
            phi_1208_ = (max(_e85, -1f) >= _e88);
        }
        let _e91 = phi_1208_;
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
    phi_1291_ = _e161;
    if _e161 {
        let _e163 = at_3.b;
        phi_1291_ = (_e163 > 0f);
    }
    let _e166 = phi_1291_;
    let _e167 = stretch;
    let _e169 = (_e166 && (_e167 < 2f));
    phi_1304_ = _e169;
    if _e169 {
        let _e171 = (*surface_1).source;
        let _e172 = middle;
        let _e175 = middle;
        phi_1304_ = (abs((_e171 - _e172)) <= _e175);
    }
    let _e178 = phi_1304_;
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
    var place_2: f32;
    var param_61: f32;
    var param_62: vec2<f32>;

    let _e10 = (*affine)[0u];
    let _e12 = (*affine)[1u];
    let _e14 = gl_FragCoord_1[0u];
    let _e18 = (*affine)[2u];
    let _e20 = gl_FragCoord_1[1u];
    place_2 = ((_e10 + (_e12 * _e14)) + (_e18 * _e20));
    let _e23 = place_2;
    param_61 = 0f;
    let _e24 = row_at((&param_61));
    param_62 = vec2<f32>(_e23, _e24);
    let _e26 = color_sample((&param_62));
    return _e26;
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
    var phi_1331_: bool;

    let _e10 = pixel_span();
    span_2 = _e10;
    phi_1331_ = true;
    if true {
        let _e12 = span_2[1u];
        phi_1331_ = (_e12 != 0u);
    }
    let _e15 = phi_1331_;
    if _e15 {
        let _e16 = span_2;
        param_63 = bitcast<vec3<f32>>(_e16.xyz);
        let _e19 = lawful((&param_63), (&param_64));
        let _e20 = param_64;
        surface_3 = _e20;
        color_2 = _e19;
    } else {
        if true {
            let _e22 = span_2[0u];
            param_65 = _e22;
            let _e23 = searched((&param_65), (&param_66));
            let _e24 = param_66;
            surface_3 = _e24;
            color_2 = _e23;
        } else {
            discard;
        }
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
