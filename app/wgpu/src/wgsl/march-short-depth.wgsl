// Made of yoro's GLSL by `cargo tools wgsl`.
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

@group(0) @binding(7) 
var<uniform> synthesis: Synthesis;
@group(0) @binding(0) 
var depth_map_texture: texture_2d<f32>;
@group(0) @binding(8) 
var nearest_sampler: sampler;
@group(0) @binding(1) 
var color_map_texture: texture_2d<f32>;
@group(0) @binding(9) 
var linear_sampler: sampler;
var<private> gl_FragCoord_1: vec4<f32>;
@group(0) @binding(3) 
var span_map_texture: texture_2d<u32>;
var<private> span_at_1: vec2<f32>;
@group(0) @binding(2) 
var tile_map_texture: texture_2d<u32>;
var<private> color_2: vec4<f32>;
var<private> gl_FragDepth: f32 = 0f;

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

fn fill_hole(hole: ptr<function, bool>, color: ptr<function, vec4<f32>>, away_1: ptr<function, f32>, x_2: ptr<function, f32>, depth: ptr<function, f32>, row: ptr<function, i32>) -> vec4<f32> {
    var spread: f32;
    var sum: vec4<f32>;
    var weights: f32;
    var edge: i32;
    var param_2: i32;
    var i: i32;
    var distance_: f32;
    var below: vec2<f32>;
    var param_3: f32;
    var param_4: f32;
    var above: vec2<f32>;
    var param_5: f32;
    var param_6: f32;
    var depths: vec2<f32>;
    var param_7: vec2<f32>;
    var param_8: vec2<f32>;
    var below_color: vec4<f32>;
    var param_9: vec2<f32>;
    var above_color: vec4<f32>;
    var param_10: vec2<f32>;
    var weight: vec2<f32>;

    let _e38 = (*away_1);
    spread = (0.5f * clamp(abs(_e38), 1f, 12f));
    let _e42 = (*color);
    sum = (_e42 * 2f);
    weights = 2f;
    let _e44 = (*x_2);
    param_2 = i32(_e44);
    let _e46 = source_column((&param_2));
    edge = _e46;
    let _e47 = (*hole);
    i = select(3i, 1i, _e47);
    loop {
        let _e49 = i;
        if (_e49 <= 2i) {
            let _e51 = i;
            let _e53 = spread;
            distance_ = round((f32(_e51) * _e53));
            let _e56 = (*x_2);
            param_3 = _e56;
            let _e57 = column_at((&param_3));
            let _e58 = distance_;
            param_4 = -(_e58);
            let _e60 = row_at((&param_4));
            below = vec2<f32>(_e57, _e60);
            let _e62 = (*x_2);
            param_5 = _e62;
            let _e63 = column_at((&param_5));
            let _e64 = distance_;
            param_6 = _e64;
            let _e65 = row_at((&param_6));
            above = vec2<f32>(_e63, _e65);
            let _e67 = below;
            param_7 = _e67;
            let _e68 = depth_sample((&param_7));
            let _e69 = above;
            param_8 = _e69;
            let _e70 = depth_sample((&param_8));
            depths = vec2<f32>(_e68, _e70);
            let _e72 = below;
            param_9 = _e72;
            let _e73 = color_sample((&param_9));
            below_color = _e73;
            let _e74 = above;
            param_10 = _e74;
            let _e75 = color_sample((&param_10));
            above_color = _e75;
            let _e78 = synthesis.law[1u];
            let _e79 = depths;
            let _e80 = (*depth);
            weight = select(vec2<f32>(0f, 0f), vec2<f32>(1f, 1f), (((_e79 - vec2(_e80)) * _e78) <= vec2<f32>(1f, 1f)));
            let _e87 = weight[0u];
            let _e88 = below_color;
            let _e91 = weight[1u];
            let _e92 = above_color;
            let _e95 = sum;
            sum = (_e95 + ((_e88 * _e87) + (_e92 * _e91)));
            let _e98 = weight[0u];
            let _e100 = weight[1u];
            let _e102 = weights;
            weights = (_e102 + (_e98 + _e100));
            continue;
        } else {
            break;
        }
        continuing {
            let _e104 = i;
            i = (_e104 + 1i);
        }
    }
    let _e106 = sum;
    let _e107 = weights;
    return (_e106 / vec4(_e107));
}

fn depth_pair(x_3: ptr<function, f32>) -> vec2<f32> {
    var row_1: f32;
    var param_11: f32;
    var param_12: f32;
    var param_13: vec2<f32>;
    var param_14: f32;
    var param_15: vec2<f32>;
    var quad: vec4<f32>;
    var param_16: f32;
    var local_3: vec2<f32>;

    if true {
        param_11 = 0f;
        let _e20 = row_at((&param_11));
        row_1 = _e20;
        let _e21 = (*x_3);
        param_12 = _e21;
        let _e22 = column_at((&param_12));
        let _e23 = row_1;
        param_13 = vec2<f32>(_e22, _e23);
        let _e25 = depth_sample((&param_13));
        let _e26 = (*x_3);
        param_14 = (_e26 + 1f);
        let _e28 = column_at((&param_14));
        let _e29 = row_1;
        param_15 = vec2<f32>(_e28, _e29);
        let _e31 = depth_sample((&param_15));
        return vec2<f32>(_e25, _e31);
    }
    let _e35 = synthesis.columns[0u];
    let _e36 = (*x_3);
    let _e41 = synthesis.columns[1u];
    param_16 = 0.25f;
    let _e43 = row_at((&param_16));
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
    var param_17: f32;
    var shift: f32;

    let _e9 = (*x_4);
    param_17 = _e9;
    let _e10 = depth_pair((&param_17));
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

fn are_events(a: ptr<function, vec4<f32>>, b: ptr<function, vec4<f32>>) -> vec4<bool> {
    var landed: vec4<f32>;

    let _e7 = (*b);
    let _e10 = (*b);
    landed = select(max(_e7, vec4(-1f)), vec4<f32>(-1000000000f, -1000000000f, -1000000000f, -1000000000f), (_e10 > vec4<f32>(0f, 0f, 0f, 0f)));
    let _e13 = landed;
    let _e14 = (*a);
    let _e15 = (*a);
    return (_e13 < select(_e14, vec4<f32>(-2000000000f, -2000000000f, -2000000000f, -2000000000f), (_e15 > vec4<f32>(0f, 0f, 0f, 0f))));
}

fn walk(at_1: ptr<function, Search>, end: ptr<function, f32>, origin_1: ptr<function, f32>) -> bool {
    var met: vec4<bool>;
    var x_5: f32;
    var last: f32;
    var depths_2: vec4<f32>;
    var param_18: f32;
    var param_19: f32;
    var places: vec4<f32>;
    var param_20: vec4<f32>;
    var param_21: vec4<f32>;
    var local_4: f32;
    var local_5: f32;
    var local_6: f32;
    var param_22: f32;
    var param_23: f32;
    var phi_614_: bool;

    met = vec4<bool>(false, false, false, false);
    let _e30 = (*at_1).x;
    x_5 = (_e30 - 4f);
    let _e33 = (*at_1).a;
    last = _e33;
    loop {
        let _e34 = x_5;
        let _e36 = (*end);
        let _e37 = ((_e34 + 4f) < _e36);
        phi_614_ = _e37;
        if _e37 {
            let _e38 = met;
            phi_614_ = !(any(_e38));
        }
        let _e42 = phi_614_;
        if _e42 {
            let _e43 = x_5;
            x_5 = (_e43 + 4f);
            let _e45 = x_5;
            param_18 = (_e45 + 1f);
            let _e47 = depth_pair((&param_18));
            let _e48 = x_5;
            param_19 = (_e48 + 3f);
            let _e50 = depth_pair((&param_19));
            depths_2 = vec4<f32>(_e47.x, _e47.y, _e50.x, _e50.y);
            let _e58 = synthesis.law[1u];
            let _e59 = depths_2;
            let _e61 = x_5;
            let _e62 = (*origin_1);
            places = ((_e59 * _e58) + (vec4((_e61 - _e62)) + vec4<f32>(1f, 2f, 3f, 4f)));
            let _e67 = last;
            let _e68 = places;
            let _e69 = _e68.xyz;
            param_20 = vec4<f32>(_e67, _e69.x, _e69.y, _e69.z);
            let _e74 = places;
            param_21 = _e74;
            let _e75 = are_events((&param_20), (&param_21));
            met = _e75;
            let _e77 = places[3u];
            last = _e77;
            continue;
        } else {
            break;
        }
    }
    let _e79 = met[0u];
    if _e79 {
        local_4 = 0f;
    } else {
        let _e81 = met[1u];
        if _e81 {
            local_5 = 1f;
        } else {
            let _e83 = met[2u];
            if _e83 {
                local_6 = 2f;
            } else {
                let _e85 = met[3u];
                local_6 = select(4f, 3f, _e85);
            }
            let _e87 = local_6;
            local_5 = _e87;
        }
        let _e88 = local_5;
        local_4 = _e88;
    }
    let _e89 = local_4;
    let _e90 = x_5;
    x_5 = (_e90 + _e89);
    let _e92 = x_5;
    let _e93 = (*end);
    param_22 = min(_e92, _e93);
    let _e95 = (*origin_1);
    param_23 = _e95;
    let _e96 = search_at((&param_22), (&param_23));
    (*at_1) = _e96;
    let _e97 = met;
    let _e99 = x_5;
    let _e100 = (*end);
    return (any(_e97) && (_e99 < _e100));
}

fn next_candidate(x_6: ptr<function, f32>, end_1: ptr<function, f32>, origin_2: ptr<function, f32>, row_2: ptr<function, i32>) -> f32 {
    var lands: bool;
    var moved: u32;
    var at_2: vec2<f32>;
    var phi_462_: bool;

    lands = false;
    loop {
        let _e19 = (*x_6);
        let _e21 = (*end_1);
        let _e23 = lands;
        if (((_e19 + 16f) < _e21) && !(_e23)) {
            let _e26 = (*x_6);
            let _e28 = (*row_2);
            let _e31 = textureLoad(tile_map_texture, (vec2<i32>(i32(_e26), _e28) / vec2<i32>(16i, 8i)), 0i);
            moved = _e31.x;
            let _e33 = (*x_6);
            let _e34 = (*origin_2);
            let _e36 = moved;
            let _e39 = moved;
            at_2 = (vec2((_e33 - _e34)) + (vec2<f32>(f32((_e36 & 65535u)), f32((_e39 >> bitcast<u32>(16i)))) / vec2(16f)));
            let _e49 = at_2[0u];
            let _e50 = (_e49 <= 1f);
            phi_462_ = _e50;
            if _e50 {
                let _e52 = at_2[1u];
                phi_462_ = ((_e52 + 16f) >= -1f);
            }
            let _e56 = phi_462_;
            lands = _e56;
            let _e57 = lands;
            let _e59 = (*x_6);
            (*x_6) = (_e59 + select(16f, 0f, _e57));
            continue;
        } else {
            break;
        }
    }
    let _e61 = (*x_6);
    return _e61;
}

fn is_event(a_1: ptr<function, f32>, b_1: ptr<function, f32>) -> bool {
    var phi_565_: bool;
    var phi_566_: bool;

    let _e4 = (*a_1);
    let _e5 = (_e4 <= 0f);
    phi_566_ = _e5;
    if _e5 {
        let _e6 = (*b_1);
        let _e7 = (_e6 > 0f);
        phi_565_ = _e7;
        if !(_e7) {
            let _e9 = (*b_1);
            let _e11 = (*a_1);
            phi_565_ = (max(_e9, -1f) < _e11);
        }
        let _e14 = phi_565_;
        phi_566_ = _e14;
    }
    let _e16 = phi_566_;
    return _e16;
}

fn march(at_3: ptr<function, Search>, end_2: ptr<function, f32>, origin_3: ptr<function, f32>, row_3: ptr<function, i32>, surface: ptr<function, Surface>) -> vec4<f32> {
    var edge_1: f32;
    var edge_depth: f32;
    var rim: f32;
    var rim_depth: f32;
    var param_24: f32;
    var param_25: f32;
    var stop: f32;
    var found: bool;
    var met_1: bool;
    var param_26: f32;
    var param_27: f32;
    var jump: bool;
    var torn: bool;
    var beside: bool;
    var nearest: bool;
    var local_7: f32;
    var local_8: f32;
    var local_9: f32;
    var farther: bool;
    var local_10: f32;
    var local_11: f32;
    var local_12: f32;
    var param_28: f32;
    var param_29: f32;
    var param_30: f32;
    var param_31: i32;
    var param_32: f32;
    var param_33: f32;
    var param_34: Search;
    var param_35: f32;
    var param_36: f32;
    var own: bool;
    var x_7: f32;
    var local_13: f32;
    var t: f32;
    var local_14: f32;
    var local_15: f32;
    var away_2: f32;
    var color_1: vec4<f32>;
    var param_37: f32;
    var param_38: f32;
    var param_39: vec2<f32>;
    var param_40: bool;
    var param_41: vec4<f32>;
    var param_42: f32;
    var param_43: f32;
    var param_44: f32;
    var param_45: i32;
    var coverage: f32;
    var param_46: f32;
    var param_47: f32;
    var param_48: vec2<f32>;
    var phi_782_: bool;
    var phi_795_: bool;
    var phi_796_: bool;
    var phi_843_: bool;
    var phi_886_: bool;
    var phi_923_: bool;
    var phi_951_: bool;
    var phi_1001_: bool;
    var phi_1017_: bool;

    edge_1 = -1f;
    let _e74 = synthesis.law[1u];
    edge_depth = select(1000000000f, -1000000000f, (_e74 < 0f));
    rim = -1f;
    rim_depth = 0f;
    let _e78 = (*at_3).x;
    if (_e78 <= 0f) {
        param_24 = 0f;
        let _e80 = (*origin_3);
        param_25 = _e80;
        let _e81 = search_at((&param_24), (&param_25));
        (*at_3) = _e81;
        let _e83 = (*at_3).a;
        if (_e83 > 0f) {
            edge_1 = 0f;
            let _e87 = (*at_3).depths[0u];
            edge_depth = _e87;
            let _e89 = (*at_3).a;
            let _e91 = (*end_2);
            (*end_2) = select(_e91, 0f, (_e89 < 0.5f));
        }
    }
    let _e94 = (*at_3).x;
    stop = ((floor((_e94 / 16f)) + 4f) * 16f);
    found = false;
    let _e100 = (*at_3).a;
    param_26 = _e100;
    let _e102 = (*at_3).b;
    param_27 = _e102;
    let _e103 = is_event((&param_26), (&param_27));
    met_1 = _e103;
    loop {
        let _e105 = (*at_3).x;
        let _e106 = (*end_2);
        let _e108 = found;
        if ((_e105 < _e106) && !(_e108)) {
            let _e111 = met_1;
            if (true && _e111) {
                let _e114 = (*at_3).b;
                jump = (_e114 > 0f);
                let _e117 = (*at_3).b;
                let _e119 = (*at_3).a;
                torn = ((_e117 - _e119) >= 2f);
                let _e122 = jump;
                phi_782_ = _e122;
                if _e122 {
                    let _e124 = (*at_3).a;
                    let _e126 = torn;
                    phi_782_ = ((_e124 > -0.5f) || !(_e126));
                }
                let _e130 = phi_782_;
                found = _e130;
                let _e131 = jump;
                let _e132 = !(_e131);
                phi_796_ = _e132;
                if !(_e132) {
                    let _e134 = torn;
                    phi_795_ = _e134;
                    if _e134 {
                        let _e136 = (*at_3).b;
                        phi_795_ = (_e136 < 1f);
                    }
                    let _e139 = phi_795_;
                    phi_796_ = _e139;
                }
                let _e141 = phi_796_;
                beside = _e141;
                let _e142 = beside;
                let _e143 = rim;
                nearest = (_e142 && (_e143 < 0f));
                let _e146 = nearest;
                if _e146 {
                    let _e148 = (*at_3).x;
                    let _e149 = jump;
                    local_7 = (_e148 + select(0f, 1f, _e149));
                } else {
                    let _e152 = rim;
                    local_7 = _e152;
                }
                let _e153 = local_7;
                rim = _e153;
                let _e154 = nearest;
                if _e154 {
                    let _e155 = jump;
                    if _e155 {
                        let _e158 = (*at_3).depths[1u];
                        local_9 = _e158;
                    } else {
                        let _e161 = (*at_3).depths[0u];
                        local_9 = _e161;
                    }
                    let _e162 = local_9;
                    local_8 = _e162;
                } else {
                    let _e163 = rim_depth;
                    local_8 = _e163;
                }
                let _e164 = local_8;
                rim_depth = _e164;
                let _e165 = jump;
                phi_843_ = _e165;
                if _e165 {
                    let _e168 = synthesis.law[1u];
                    let _e171 = (*at_3).depths[0u];
                    let _e172 = edge_depth;
                    phi_843_ = ((_e168 * (_e171 - _e172)) < 0f);
                }
                let _e177 = phi_843_;
                farther = _e177;
                let _e178 = farther;
                if _e178 {
                    let _e180 = (*at_3).x;
                    local_10 = _e180;
                } else {
                    let _e181 = edge_1;
                    local_10 = _e181;
                }
                let _e182 = local_10;
                edge_1 = _e182;
                let _e183 = farther;
                if _e183 {
                    let _e186 = (*at_3).depths[0u];
                    local_11 = _e186;
                } else {
                    let _e187 = edge_depth;
                    local_11 = _e187;
                }
                let _e188 = local_11;
                edge_depth = _e188;
                let _e189 = found;
                let _e192 = (*at_3).x;
                (*at_3).x = (_e192 + select(1f, 0f, _e189));
                let _e195 = found;
                if _e195 {
                    let _e197 = (*at_3).a;
                    local_12 = _e197;
                } else {
                    let _e199 = (*at_3).b;
                    local_12 = _e199;
                }
                let _e200 = local_12;
                (*at_3).a = _e200;
            } else {
                phi_886_ = true;
                if true {
                    let _e203 = (*at_3).x;
                    let _e204 = stop;
                    phi_886_ = (_e203 >= _e204);
                }
                let _e207 = phi_886_;
                if _e207 {
                    let _e208 = (*origin_3);
                    let _e210 = synthesis.farthest;
                    let _e212 = stop;
                    param_28 = _e212;
                    let _e213 = (*end_2);
                    param_29 = _e213;
                    param_30 = (_e208 - _e210);
                    let _e214 = (*row_3);
                    param_31 = _e214;
                    let _e215 = next_candidate((&param_28), (&param_29), (&param_30), (&param_31));
                    param_32 = _e215;
                    let _e216 = (*origin_3);
                    param_33 = _e216;
                    let _e217 = search_at((&param_32), (&param_33));
                    (*at_3) = _e217;
                    let _e219 = (*at_3).x;
                    stop = (_e219 + 16f);
                }
            }
            let _e221 = found;
            let _e222 = !(_e221);
            phi_923_ = _e222;
            if _e222 {
                let _e223 = stop;
                let _e224 = (*end_2);
                let _e226 = (*at_3);
                param_34 = _e226;
                param_35 = min(_e223, _e224);
                let _e227 = (*origin_3);
                param_36 = _e227;
                let _e228 = walk((&param_34), (&param_35), (&param_36));
                let _e229 = param_34;
                (*at_3) = _e229;
                phi_923_ = _e228;
            }
            let _e231 = phi_923_;
            met_1 = _e231;
            continue;
        } else {
            break;
        }
    }
    let _e232 = found;
    let _e233 = edge_1;
    own = (_e232 || (_e233 < 0f));
    let _e236 = own;
    if _e236 {
        let _e238 = (*at_3).x;
        let _e239 = (*end_2);
        local_13 = min(_e238, _e239);
    } else {
        let _e241 = edge_1;
        local_13 = _e241;
    }
    let _e242 = local_13;
    x_7 = _e242;
    let _e243 = found;
    phi_951_ = _e243;
    if _e243 {
        let _e245 = (*at_3).b;
        let _e247 = (*at_3).a;
        phi_951_ = ((_e245 - _e247) < 2f);
    }
    let _e251 = phi_951_;
    if _e251 {
        let _e253 = (*at_3).a;
        let _e256 = (*at_3).b;
        let _e258 = (*at_3).a;
        local_14 = (-(_e253) / (_e256 - _e258));
    } else {
        local_14 = 0f;
    }
    let _e261 = local_14;
    t = _e261;
    let _e262 = x_7;
    let _e263 = t;
    (*surface).source = (_e262 + _e263);
    let _e266 = own;
    if _e266 {
        let _e269 = (*at_3).depths[0u];
        let _e272 = (*at_3).depths[1u];
        let _e273 = t;
        local_15 = mix(_e269, _e272, _e273);
    } else {
        let _e275 = edge_depth;
        local_15 = _e275;
    }
    let _e276 = local_15;
    (*surface).depth = _e276;
    let _e278 = x_7;
    let _e279 = (*origin_3);
    let _e283 = synthesis.law[1u];
    let _e285 = (*surface).depth;
    away_2 = ((_e278 - _e279) + (_e283 * _e285));
    let _e288 = found;
    let _e289 = !(_e288);
    phi_1001_ = _e289;
    if _e289 {
        let _e290 = away_2;
        phi_1001_ = (abs(_e290) >= 0.5f);
    }
    let _e294 = phi_1001_;
    (*surface).hole = _e294;
    let _e297 = (*surface).source;
    param_37 = _e297;
    let _e298 = column_at((&param_37));
    param_38 = 0f;
    let _e299 = row_at((&param_38));
    param_39 = vec2<f32>(_e298, _e299);
    let _e301 = color_sample((&param_39));
    color_1 = _e301;
    phi_1017_ = true;
    if true {
        let _e303 = (*surface).hole;
        phi_1017_ = _e303;
    }
    let _e305 = phi_1017_;
    if _e305 {
        param_40 = true;
        let _e306 = color_1;
        param_41 = _e306;
        let _e307 = away_2;
        param_42 = _e307;
        let _e308 = x_7;
        param_43 = _e308;
        let _e310 = (*surface).depth;
        param_44 = _e310;
        let _e311 = (*row_3);
        param_45 = _e311;
        let _e312 = fill_hole((&param_40), (&param_41), (&param_42), (&param_43), (&param_44), (&param_45));
        color_1 = _e312;
    }
    let _e313 = rim;
    if (_e313 >= 0f) {
        let _e315 = rim;
        let _e316 = (*origin_3);
        let _e320 = synthesis.law[1u];
        let _e321 = rim_depth;
        coverage = (1f - abs(((_e315 - _e316) + (_e320 * _e321))));
        let _e326 = color_1;
        let _e327 = rim;
        param_46 = _e327;
        let _e328 = column_at((&param_46));
        param_47 = 0f;
        let _e329 = row_at((&param_47));
        param_48 = vec2<f32>(_e328, _e329);
        let _e331 = color_sample((&param_48));
        let _e332 = coverage;
        color_1 = mix(_e326, _e331, vec4(_e332));
        let _e335 = coverage;
        if (_e335 >= 0.5f) {
            let _e337 = rim;
            let _e338 = rim_depth;
            (*surface) = Surface(_e337, _e338, false);
        }
    }
    let _e340 = color_1;
    return _e340;
}

fn source_row() -> i32 {
    let _e6 = gl_FragCoord_1[1u];
    let _e8 = synthesis.first_row;
    let _e12 = synthesis.source_size[1u];
    return i32(clamp((_e6 - _e8), 0f, f32((_e12 - 1i))));
}

fn span_steps(span: ptr<function, u32>) -> f32 {
    var steps: u32;
    var local_16: f32;

    let _e5 = (*span);
    steps = (_e5 & 1023u);
    let _e7 = steps;
    if (_e7 == 1023u) {
        local_16 = 1000000000f;
    } else {
        let _e9 = steps;
        local_16 = f32(_e9);
    }
    let _e11 = local_16;
    return _e11;
}

fn searched(span_1: ptr<function, u32>, surface_1: ptr<function, Surface>) -> vec4<f32> {
    var origin_4: f32;
    var at_4: Search;
    var param_49: f32;
    var param_50: f32;
    var end_3: f32;
    var param_51: u32;
    var limit: f32;
    var next: f32;
    var param_52: f32;
    var param_53: f32;
    var param_54: vec2<f32>;
    var stretch: f32;
    var t_1: f32;
    var seen: vec4<f32>;
    var param_55: f32;
    var param_56: f32;
    var param_57: vec2<f32>;
    var middle: f32;
    var done: bool;
    var param_58: Search;
    var param_59: f32;
    var param_60: f32;
    var param_61: i32;
    var param_62: Surface;
    var phi_1192_: bool;
    var phi_1201_: bool;
    var phi_1284_: bool;
    var phi_1297_: bool;

    let _e41 = synthesis.origins[0u];
    let _e43 = gl_FragCoord_1[0u];
    let _e47 = synthesis.origins[1u];
    origin_4 = ((_e41 * _e43) + _e47);
    let _e49 = origin_4;
    let _e51 = synthesis.farthest;
    let _e53 = (*span_1);
    param_49 = floor(((_e49 - _e51) - bitcast<f32>(_e53)));
    let _e57 = origin_4;
    param_50 = _e57;
    let _e58 = search_at((&param_49), (&param_50));
    at_4 = _e58;
    let _e60 = at_4.x;
    let _e62 = (*span_1);
    param_51 = _e62;
    let _e63 = span_steps((&param_51));
    let _e67 = synthesis.source_size[0u];
    end_3 = min((max(_e60, 0f) + _e63), f32((_e67 - 1i)));
    let _e72 = at_4.x;
    let _e74 = end_3;
    limit = min((_e72 + 4f), _e74);
    loop {
        let _e77 = at_4.x;
        let _e78 = limit;
        let _e79 = (_e77 < _e78);
        phi_1192_ = _e79;
        if _e79 {
            let _e81 = at_4.b;
            phi_1192_ = (_e81 <= 0f);
        }
        let _e84 = phi_1192_;
        phi_1201_ = _e84;
        if _e84 {
            let _e86 = at_4.b;
            let _e89 = at_4.a;
            phi_1201_ = (max(_e86, -1f) >= _e89);
        }
        let _e92 = phi_1201_;
        if _e92 {
            let _e94 = at_4.x;
            param_52 = (_e94 + 2f);
            let _e96 = column_at((&param_52));
            param_53 = 0f;
            let _e97 = row_at((&param_53));
            param_54 = vec2<f32>(_e96, _e97);
            let _e99 = depth_sample((&param_54));
            next = _e99;
            let _e102 = at_4.depths[1u];
            let _e103 = next;
            at_4.depths = vec2<f32>(_e102, _e103);
            let _e107 = at_4.b;
            at_4.a = _e107;
            let _e110 = at_4.x;
            let _e112 = origin_4;
            let _e116 = synthesis.law[1u];
            let _e117 = next;
            at_4.b = (((_e110 + 2f) - _e112) + (_e116 * _e117));
            continue;
        } else {
            break;
        }
        continuing {
            let _e122 = at_4.x;
            at_4.x = (_e122 + 1f);
        }
    }
    let _e126 = at_4.b;
    let _e128 = at_4.a;
    stretch = (_e126 - _e128);
    let _e131 = at_4.a;
    let _e133 = stretch;
    t_1 = (-(_e131) / _e133);
    let _e136 = at_4.x;
    let _e137 = t_1;
    let _e141 = at_4.depths[0u];
    let _e144 = at_4.depths[1u];
    let _e145 = t_1;
    (*surface_1) = Surface((_e136 + _e137), mix(_e141, _e144, _e145), false);
    let _e149 = (*surface_1).source;
    param_55 = _e149;
    let _e150 = column_at((&param_55));
    param_56 = 0f;
    let _e151 = row_at((&param_56));
    param_57 = vec2<f32>(_e150, _e151);
    let _e153 = color_sample((&param_57));
    seen = _e153;
    let _e156 = synthesis.source_size[0u];
    middle = (0.5f * f32((_e156 - 1i)));
    let _e161 = at_4.a;
    let _e162 = (_e161 <= 0f);
    phi_1284_ = _e162;
    if _e162 {
        let _e164 = at_4.b;
        phi_1284_ = (_e164 > 0f);
    }
    let _e167 = phi_1284_;
    let _e168 = stretch;
    let _e170 = (_e167 && (_e168 < 2f));
    phi_1297_ = _e170;
    if _e170 {
        let _e172 = (*surface_1).source;
        let _e173 = middle;
        let _e176 = middle;
        phi_1297_ = (abs((_e172 - _e173)) <= _e176);
    }
    let _e179 = phi_1297_;
    done = _e179;
    let _e180 = done;
    if (true && !(_e180)) {
        let _e183 = source_row();
        let _e184 = at_4;
        param_58 = _e184;
        let _e185 = end_3;
        param_59 = _e185;
        let _e186 = origin_4;
        param_60 = _e186;
        param_61 = _e183;
        let _e187 = march((&param_58), (&param_59), (&param_60), (&param_61), (&param_62));
        let _e188 = param_62;
        (*surface_1) = _e188;
        seen = _e187;
    }
    let _e189 = seen;
    return _e189;
}

fn lawful(affine: ptr<function, vec3<f32>>, surface_2: ptr<function, Surface>) -> vec4<f32> {
    var place_2: f32;
    var depths_3: vec2<f32>;
    var param_63: f32;
    var param_64: f32;
    var param_65: vec2<f32>;

    let _e17 = (*affine)[0u];
    let _e19 = (*affine)[1u];
    let _e21 = gl_FragCoord_1[0u];
    let _e25 = (*affine)[2u];
    let _e27 = gl_FragCoord_1[1u];
    place_2 = ((_e17 + (_e19 * _e21)) + (_e25 * _e27));
    let _e30 = place_2;
    let _e33 = synthesis.columns[1u];
    let _e37 = synthesis.columns[0u];
    let _e42 = synthesis.source_size[0u];
    (*surface_2).source = clamp((((_e30 - _e33) / _e37) - 0.5f), 0f, f32((_e42 - 1i)));
    let _e48 = (*surface_2).source;
    param_63 = floor(_e48);
    let _e50 = depth_pair((&param_63));
    depths_3 = _e50;
    let _e52 = depths_3[0u];
    let _e54 = depths_3[1u];
    let _e56 = (*surface_2).source;
    (*surface_2).depth = mix(_e52, _e54, fract(_e56));
    (*surface_2).hole = false;
    let _e61 = place_2;
    param_64 = 0f;
    let _e62 = row_at((&param_64));
    param_65 = vec2<f32>(_e61, _e62);
    let _e64 = color_sample((&param_65));
    return _e64;
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
    var param_66: vec3<f32>;
    var param_67: Surface;
    var param_68: u32;
    var param_69: Surface;
    var phi_1325_: bool;

    let _e11 = pixel_span();
    span_2 = _e11;
    phi_1325_ = true;
    if true {
        let _e13 = span_2[1u];
        phi_1325_ = (_e13 != 0u);
    }
    let _e16 = phi_1325_;
    if _e16 {
        let _e17 = span_2;
        param_66 = bitcast<vec3<f32>>(_e17.xyz);
        let _e20 = lawful((&param_66), (&param_67));
        let _e21 = param_67;
        surface_3 = _e21;
        color_2 = _e20;
    } else {
        if true {
            let _e23 = span_2[0u];
            param_68 = _e23;
            let _e24 = searched((&param_68), (&param_69));
            let _e25 = param_69;
            surface_3 = _e25;
            color_2 = _e24;
        } else {
            discard;
        }
    }
    let _e27 = surface_3.depth;
    gl_FragDepth = _e27;
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
