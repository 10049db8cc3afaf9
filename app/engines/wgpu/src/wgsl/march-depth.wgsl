// Made of yoro's GLSL by `cargo tools wgsl`.
struct Search {
    column: i32,
    shift: f32,
    a: f32,
    b: f32,
    depth: f32,
    next: f32,
    found: bool,
    edge: i32,
    edge_depth: f32,
    rim: i32,
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

@group(0) @binding(7) 
var<uniform> synthesis: Synthesis;
@group(0) @binding(0) 
var depth_map_texture: texture_2d<f32>;
@group(0) @binding(1) 
var color_map_texture: texture_2d<f32>;
@group(0) @binding(9) 
var linear_sampler: sampler;
@group(0) @binding(3) 
var span_map_texture: texture_2d<u32>;
var<private> span_at_1: vec2<f32>;
var<private> gl_FragCoord_1: vec4<f32>;
var<private> color_2: vec4<f32>;
var<private> gl_FragDepth: f32 = 0f;

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

    let _e5 = (*column);
    let _e6 = (*row);
    param = vec2<i32>(_e5, _e6);
    let _e8 = in_image((&param));
    let _e9 = textureLoad(depth_map_texture, _e8, 0i);
    return _e9.x;
}

fn source_column(x: ptr<function, i32>) -> i32 {
    var local_1: i32;

    let _e6 = synthesis.mirrored;
    if (_e6 != 0u) {
        let _e10 = synthesis.source_size[0u];
        let _e12 = (*x);
        local_1 = ((_e10 - 1i) - _e12);
    } else {
        let _e14 = (*x);
        local_1 = _e14;
    }
    let _e15 = local_1;
    return _e15;
}

fn fill_spread(away: ptr<function, f32>) -> f32 {
    let _e4 = (*away);
    return (0.5f * clamp(abs(_e4), 1f, 12f));
}

fn fill_hole(hole: ptr<function, bool>, color: ptr<function, vec4<f32>>, away_1: ptr<function, f32>, x_1: ptr<function, f32>, depth: ptr<function, f32>, row_1: ptr<function, i32>) -> vec4<f32> {
    var spread: f32;
    var param_1: f32;
    var sum: vec4<f32>;
    var weights: f32;
    var edge: i32;
    var param_2: i32;
    var i: i32;
    var distance_: f32;
    var below: vec2<i32>;
    var above: vec2<i32>;
    var depths: vec2<f32>;
    var param_3: i32;
    var param_4: i32;
    var param_5: i32;
    var param_6: i32;
    var below_color: vec4<f32>;
    var param_7: vec2<i32>;
    var above_color: vec4<f32>;
    var param_8: vec2<i32>;
    var weight: vec2<f32>;

    let _e37 = (*away_1);
    param_1 = _e37;
    let _e38 = fill_spread((&param_1));
    spread = _e38;
    let _e39 = (*color);
    sum = (_e39 * 2f);
    weights = 2f;
    let _e41 = (*x_1);
    param_2 = i32(_e41);
    let _e43 = source_column((&param_2));
    edge = _e43;
    let _e44 = (*hole);
    i = select(3i, 1i, _e44);
    loop {
        let _e46 = i;
        if (_e46 <= 2i) {
            let _e48 = i;
            let _e50 = spread;
            distance_ = round((f32(_e48) * _e50));
            let _e53 = edge;
            let _e54 = (*row_1);
            let _e55 = distance_;
            below = vec2<i32>(_e53, max((_e54 - i32(_e55)), 0i));
            let _e60 = edge;
            let _e61 = (*row_1);
            let _e62 = distance_;
            let _e67 = synthesis.source_size[1u];
            above = vec2<i32>(_e60, min((_e61 + i32(_e62)), (_e67 - 1i)));
            let _e72 = below[0u];
            param_3 = _e72;
            let _e74 = below[1u];
            param_4 = _e74;
            let _e75 = depth_texel((&param_3), (&param_4));
            let _e77 = above[0u];
            param_5 = _e77;
            let _e79 = above[1u];
            param_6 = _e79;
            let _e80 = depth_texel((&param_5), (&param_6));
            depths = vec2<f32>(_e75, _e80);
            let _e82 = below;
            param_7 = _e82;
            let _e83 = in_image((&param_7));
            let _e84 = textureLoad(color_map_texture, _e83, 0i);
            below_color = _e84;
            let _e85 = above;
            param_8 = _e85;
            let _e86 = in_image((&param_8));
            let _e87 = textureLoad(color_map_texture, _e86, 0i);
            above_color = _e87;
            let _e90 = synthesis.law[1u];
            let _e91 = depths;
            let _e92 = (*depth);
            weight = select(vec2<f32>(0f, 0f), vec2<f32>(1f, 1f), (((_e91 - vec2(_e92)) * _e90) <= vec2<f32>(1f, 1f)));
            let _e99 = weight[0u];
            let _e100 = below_color;
            let _e103 = weight[1u];
            let _e104 = above_color;
            let _e107 = sum;
            sum = (_e107 + ((_e100 * _e99) + (_e104 * _e103)));
            let _e110 = weight[0u];
            let _e112 = weight[1u];
            let _e114 = weights;
            weights = (_e114 + (_e110 + _e112));
            continue;
        } else {
            break;
        }
        continuing {
            let _e116 = i;
            i = (_e116 + 1i);
        }
    }
    let _e118 = sum;
    let _e119 = weights;
    return (_e118 / vec4(_e119));
}

fn color_at(x_2: ptr<function, f32>, row_2: ptr<function, i32>) -> vec4<f32> {
    var column_1: f32;
    var local_2: f32;
    var at: vec2<f32>;
    var local_3: vec2<f32>;

    let _e15 = synthesis.mirrored;
    if (_e15 != 0u) {
        let _e19 = synthesis.source_size[0u];
        let _e22 = (*x_2);
        local_2 = (f32((_e19 - 1i)) - _e22);
    } else {
        let _e24 = (*x_2);
        local_2 = _e24;
    }
    let _e25 = local_2;
    column_1 = _e25;
    let _e26 = column_1;
    let _e27 = (*row_2);
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
    var phi_153_: bool;

    let _e4 = (*a_2);
    let _e5 = (_e4 <= 0f);
    phi_153_ = _e5;
    if _e5 {
        let _e6 = (*b_2);
        let _e8 = (*a_2);
        phi_153_ = (max(_e6, -1f) < _e8);
    }
    let _e11 = phi_153_;
    return _e11;
}

fn has_rim(a_3: ptr<function, f32>, b_3: ptr<function, f32>) -> bool {
    var param_9: f32;
    var param_10: f32;
    var param_11: f32;
    var param_12: f32;
    var param_13: f32;
    var param_14: f32;
    var phi_176_: bool;
    var phi_181_: bool;

    let _e9 = (*a_3);
    param_9 = _e9;
    let _e10 = (*b_3);
    param_10 = _e10;
    let _e11 = folds((&param_9), (&param_10));
    phi_181_ = _e11;
    if !(_e11) {
        let _e13 = (*a_3);
        param_11 = _e13;
        let _e14 = (*b_3);
        param_12 = _e14;
        let _e15 = jumps((&param_11), (&param_12));
        phi_176_ = _e15;
        if _e15 {
            let _e16 = (*a_3);
            param_13 = _e16;
            let _e17 = (*b_3);
            param_14 = _e17;
            let _e18 = is_torn((&param_13), (&param_14));
            phi_176_ = _e18;
        }
        let _e20 = phi_176_;
        let _e21 = (*b_3);
        phi_181_ = (_e20 && (_e21 < 1f));
    }
    let _e25 = phi_181_;
    return _e25;
}

fn is_seen(a_4: ptr<function, f32>, b_4: ptr<function, f32>) -> bool {
    var param_15: f32;
    var param_16: f32;
    var param_17: f32;
    var param_18: f32;
    var phi_140_: bool;
    var phi_141_: bool;

    let _e7 = (*a_4);
    param_15 = _e7;
    let _e8 = (*b_4);
    param_16 = _e8;
    let _e9 = jumps((&param_15), (&param_16));
    phi_141_ = _e9;
    if _e9 {
        let _e10 = (*a_4);
        let _e11 = (_e10 > -0.5f);
        phi_140_ = _e11;
        if !(_e11) {
            let _e13 = (*a_4);
            param_17 = _e13;
            let _e14 = (*b_4);
            param_18 = _e14;
            let _e15 = is_torn((&param_17), (&param_18));
            phi_140_ = !(_e15);
        }
        let _e18 = phi_140_;
        phi_141_ = _e18;
    }
    let _e20 = phi_141_;
    return _e20;
}

fn walk(at_1: ptr<function, Search>, end: ptr<function, f32>, origin: ptr<function, f32>, row_3: ptr<function, i32>) {
    var limit: f32;
    var step_: i32;
    var here: i32;
    var param_19: i32;
    var param_20: i32;
    var param_21: f32;
    var param_22: f32;
    var fold: bool;
    var param_23: f32;
    var param_24: f32;
    var nearest: bool;
    var param_25: f32;
    var param_26: f32;
    var local_4: i32;
    var local_5: i32;
    var local_6: f32;
    var local_7: f32;
    var farther: bool;
    var param_27: f32;
    var param_28: f32;
    var local_8: i32;
    var local_9: f32;
    var phi_515_: bool;
    var phi_582_: bool;
    var phi_640_: bool;

    let _e35 = (*end);
    let _e36 = (*origin);
    limit = ((_e35 - _e36) - 0.5f);
    let _e40 = synthesis.mirrored;
    step_ = select(1i, -1i, (_e40 != 0u));
    loop {
        let _e44 = (*at_1).shift;
        let _e45 = limit;
        let _e46 = (_e44 < _e45);
        phi_515_ = _e46;
        if _e46 {
            let _e48 = (*at_1).found;
            phi_515_ = !(_e48);
        }
        let _e51 = phi_515_;
        if _e51 {
            let _e53 = (*at_1).b;
            (*at_1).a = _e53;
            let _e56 = (*at_1).next;
            (*at_1).depth = _e56;
            let _e59 = (*at_1).column;
            here = _e59;
            let _e60 = step_;
            let _e62 = (*at_1).column;
            (*at_1).column = (_e62 + _e60);
            let _e66 = (*at_1).shift;
            (*at_1).shift = (_e66 + 1f);
            let _e70 = (*at_1).column;
            param_19 = _e70;
            let _e71 = (*row_3);
            param_20 = _e71;
            let _e72 = depth_texel((&param_19), (&param_20));
            (*at_1).next = _e72;
            let _e75 = (*at_1).shift;
            let _e78 = synthesis.law[1u];
            let _e80 = (*at_1).next;
            (*at_1).b = (_e75 + (_e78 * _e80));
            let _e85 = (*at_1).a;
            param_21 = _e85;
            let _e87 = (*at_1).b;
            param_22 = _e87;
            let _e88 = is_seen((&param_21), (&param_22));
            (*at_1).found = _e88;
            let _e91 = (*at_1).a;
            param_23 = _e91;
            let _e93 = (*at_1).b;
            param_24 = _e93;
            let _e94 = folds((&param_23), (&param_24));
            fold = _e94;
            let _e96 = (*at_1).a;
            param_25 = _e96;
            let _e98 = (*at_1).b;
            param_26 = _e98;
            let _e99 = has_rim((&param_25), (&param_26));
            phi_582_ = _e99;
            if _e99 {
                let _e101 = (*at_1).rim;
                phi_582_ = (_e101 < 0i);
            }
            let _e104 = phi_582_;
            nearest = _e104;
            let _e105 = nearest;
            if _e105 {
                let _e106 = fold;
                if _e106 {
                    let _e107 = here;
                    local_5 = _e107;
                } else {
                    let _e109 = (*at_1).column;
                    local_5 = _e109;
                }
                let _e110 = local_5;
                local_4 = _e110;
            } else {
                let _e112 = (*at_1).rim;
                local_4 = _e112;
            }
            let _e113 = local_4;
            (*at_1).rim = _e113;
            let _e115 = nearest;
            if _e115 {
                let _e116 = fold;
                if _e116 {
                    let _e118 = (*at_1).depth;
                    local_7 = _e118;
                } else {
                    let _e120 = (*at_1).next;
                    local_7 = _e120;
                }
                let _e121 = local_7;
                local_6 = _e121;
            } else {
                let _e123 = (*at_1).rim_depth;
                local_6 = _e123;
            }
            let _e124 = local_6;
            (*at_1).rim_depth = _e124;
            let _e127 = (*at_1).a;
            param_27 = _e127;
            let _e129 = (*at_1).b;
            param_28 = _e129;
            let _e130 = jumps((&param_27), (&param_28));
            phi_640_ = _e130;
            if _e130 {
                let _e133 = synthesis.law[1u];
                let _e135 = (*at_1).depth;
                let _e137 = (*at_1).edge_depth;
                phi_640_ = ((_e133 * (_e135 - _e137)) < 0f);
            }
            let _e142 = phi_640_;
            farther = _e142;
            let _e143 = farther;
            if _e143 {
                let _e144 = here;
                local_8 = _e144;
            } else {
                let _e146 = (*at_1).edge;
                local_8 = _e146;
            }
            let _e147 = local_8;
            (*at_1).edge = _e147;
            let _e149 = farther;
            if _e149 {
                let _e151 = (*at_1).depth;
                local_9 = _e151;
            } else {
                let _e153 = (*at_1).edge_depth;
                local_9 = _e153;
            }
            let _e154 = local_9;
            (*at_1).edge_depth = _e154;
            continue;
        } else {
            break;
        }
    }
    return;
}

fn march(origin_1: ptr<function, f32>, row_4: ptr<function, i32>, steps: ptr<function, f32>, x_3: ptr<function, f32>, b_5: ptr<function, f32>, next: ptr<function, f32>, surface: ptr<function, Surface>) -> vec4<f32> {
    var last_column: f32;
    var outside: bool;
    var end_1: f32;
    var local_10: f32;
    var column_2: i32;
    var param_29: i32;
    var edge_1: i32;
    var edge_depth: f32;
    var local_11: f32;
    var at_2: Search;
    var param_30: Search;
    var param_31: f32;
    var param_32: f32;
    var param_33: i32;
    var own: bool;
    var local_12: i32;
    var param_34: i32;
    var t: f32;
    var param_35: f32;
    var param_36: f32;
    var local_13: f32;
    var local_14: f32;
    var away_2: f32;
    var color_1: vec4<f32>;
    var param_37: f32;
    var param_38: i32;
    var param_39: bool;
    var param_40: vec4<f32>;
    var param_41: f32;
    var param_42: f32;
    var param_43: f32;
    var param_44: i32;
    var param_45: i32;
    var coverage: f32;
    var param_46: vec2<i32>;
    var phi_753_: bool;
    var phi_832_: bool;

    let _e57 = synthesis.source_size[0u];
    last_column = f32((_e57 - 1i));
    let _e60 = (*x_3);
    let _e61 = (*b_5);
    (*b_5) = (_e61 - _e60);
    let _e63 = (*x_3);
    let _e64 = last_column;
    (*x_3) = clamp(_e63, 0f, _e64);
    let _e66 = (*x_3);
    let _e67 = (*b_5);
    (*b_5) = (_e67 + _e66);
    let _e69 = (*x_3);
    let _e71 = (*b_5);
    outside = ((_e69 == 0f) && (_e71 > 0f));
    let _e74 = outside;
    let _e75 = (*b_5);
    if (_e74 && (_e75 < 0.5f)) {
        let _e78 = (*x_3);
        local_10 = _e78;
    } else {
        let _e79 = (*x_3);
        let _e80 = (*steps);
        let _e82 = last_column;
        local_10 = min((_e79 + _e80), _e82);
    }
    let _e84 = local_10;
    end_1 = _e84;
    let _e85 = (*x_3);
    param_29 = i32(_e85);
    let _e87 = source_column((&param_29));
    column_2 = _e87;
    let _e88 = outside;
    let _e89 = column_2;
    edge_1 = select(-1i, _e89, _e88);
    let _e91 = outside;
    if _e91 {
        let _e92 = (*next);
        local_11 = _e92;
    } else {
        let _e95 = synthesis.law[1u];
        local_11 = select(1000000000f, -1000000000f, (_e95 < 0f));
    }
    let _e98 = local_11;
    edge_depth = _e98;
    let _e99 = column_2;
    let _e100 = (*x_3);
    let _e101 = (*origin_1);
    let _e103 = (*b_5);
    let _e104 = (*b_5);
    let _e105 = (*next);
    let _e106 = (*next);
    let _e107 = edge_1;
    let _e108 = edge_depth;
    at_2 = Search(_e99, (_e100 - _e101), _e103, _e104, _e105, _e106, false, _e107, _e108, -1i, 0f);
    let _e110 = at_2;
    param_30 = _e110;
    let _e111 = end_1;
    param_31 = _e111;
    let _e112 = (*origin_1);
    param_32 = _e112;
    let _e113 = (*row_4);
    param_33 = _e113;
    walk((&param_30), (&param_31), (&param_32), (&param_33));
    let _e114 = param_30;
    at_2 = _e114;
    let _e116 = at_2.found;
    phi_753_ = _e116;
    if !(_e116) {
        let _e119 = at_2.edge;
        phi_753_ = (_e119 < 0i);
    }
    let _e122 = phi_753_;
    own = _e122;
    let _e123 = own;
    if _e123 {
        let _e125 = at_2.column;
        local_12 = _e125;
    } else {
        let _e127 = at_2.edge;
        local_12 = _e127;
    }
    let _e128 = local_12;
    column_2 = _e128;
    let _e129 = column_2;
    param_34 = _e129;
    let _e130 = source_column((&param_34));
    (*x_3) = f32(_e130);
    let _e133 = at_2.a;
    param_35 = _e133;
    let _e135 = at_2.b;
    param_36 = _e135;
    let _e136 = is_torn((&param_35), (&param_36));
    if _e136 {
        local_13 = 0f;
    } else {
        let _e138 = at_2.a;
        let _e141 = at_2.b;
        let _e143 = at_2.a;
        local_13 = (-(_e138) / (_e141 - _e143));
    }
    let _e146 = local_13;
    t = _e146;
    let _e148 = at_2.found;
    let _e149 = t;
    t = select(1f, _e149, _e148);
    let _e151 = (*x_3);
    let _e153 = t;
    (*surface).source = ((_e151 - 1f) + _e153);
    let _e157 = at_2.depth;
    let _e158 = own;
    if _e158 {
        let _e160 = at_2.next;
        local_14 = _e160;
    } else {
        let _e162 = at_2.edge_depth;
        local_14 = _e162;
    }
    let _e163 = local_14;
    let _e164 = t;
    (*surface).depth = mix(_e157, _e163, _e164);
    let _e167 = (*x_3);
    let _e168 = (*origin_1);
    let _e172 = synthesis.law[1u];
    let _e174 = (*surface).depth;
    away_2 = ((_e167 - _e168) + (_e172 * _e174));
    let _e178 = at_2.found;
    let _e179 = !(_e178);
    phi_832_ = _e179;
    if _e179 {
        let _e180 = away_2;
        phi_832_ = (abs(_e180) >= 0.5f);
    }
    let _e184 = phi_832_;
    (*surface).hole = _e184;
    let _e187 = (*surface).source;
    param_37 = _e187;
    let _e188 = (*row_4);
    param_38 = _e188;
    let _e189 = color_at((&param_37), (&param_38));
    let _e191 = (*surface).hole;
    param_39 = _e191;
    param_40 = _e189;
    let _e192 = away_2;
    param_41 = _e192;
    let _e193 = (*x_3);
    param_42 = _e193;
    let _e195 = (*surface).depth;
    param_43 = _e195;
    let _e196 = (*row_4);
    param_44 = _e196;
    let _e197 = fill_hole((&param_39), (&param_40), (&param_41), (&param_42), (&param_43), (&param_44));
    color_1 = _e197;
    let _e199 = at_2.rim;
    if (_e199 >= 0i) {
        let _e202 = at_2.rim;
        param_45 = _e202;
        let _e203 = source_column((&param_45));
        (*x_3) = f32(_e203);
        let _e205 = (*x_3);
        let _e206 = (*origin_1);
        let _e210 = synthesis.law[1u];
        let _e212 = at_2.rim_depth;
        coverage = (1f - abs(((_e205 - _e206) + (_e210 * _e212))));
        let _e217 = color_1;
        let _e219 = at_2.rim;
        let _e220 = (*row_4);
        param_46 = vec2<i32>(_e219, _e220);
        let _e222 = in_image((&param_46));
        let _e223 = textureLoad(color_map_texture, _e222, 0i);
        let _e224 = coverage;
        color_1 = mix(_e217, _e223, vec4(_e224));
        let _e227 = coverage;
        if (_e227 >= 0.5f) {
            let _e229 = (*x_3);
            let _e231 = at_2.rim_depth;
            (*surface) = Surface(_e229, _e231, false);
        }
    }
    let _e233 = color_1;
    return _e233;
}

fn span_steps(span: ptr<function, u32>) -> f32 {
    var steps_1: u32;
    var local_15: f32;

    let _e5 = (*span);
    steps_1 = (_e5 & 1023u);
    let _e7 = steps_1;
    if (_e7 == 1023u) {
        local_15 = 1000000000f;
    } else {
        let _e9 = steps_1;
        local_15 = f32(_e9);
    }
    let _e11 = local_15;
    return _e11;
}

fn depth_at(x_4: ptr<function, i32>, row_5: ptr<function, i32>) -> f32 {
    var param_47: i32;
    var param_48: i32;
    var param_49: i32;

    let _e5 = (*x_4);
    param_47 = _e5;
    let _e6 = source_column((&param_47));
    param_48 = _e6;
    let _e7 = (*row_5);
    param_49 = _e7;
    let _e8 = depth_texel((&param_48), (&param_49));
    return _e8;
}

fn source_row() -> i32 {
    let _e6 = gl_FragCoord_1[1u];
    let _e8 = synthesis.first_row;
    let _e12 = synthesis.source_size[1u];
    return i32(clamp((_e6 - _e8), 0f, f32((_e12 - 1i))));
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
    var span_1: vec4<u32>;
    var origin_2: f32;
    var x_5: f32;
    var row_6: i32;
    var depth_1: f32;
    var param_50: i32;
    var param_51: i32;
    var param_52: u32;
    var surface_1: Surface;
    var param_53: f32;
    var param_54: i32;
    var param_55: f32;
    var param_56: f32;
    var param_57: f32;
    var param_58: f32;
    var param_59: Surface;

    let _e24 = pixel_span();
    span_1 = _e24;
    let _e27 = synthesis.origins[0u];
    let _e29 = gl_FragCoord_1[0u];
    let _e33 = synthesis.origins[1u];
    origin_2 = ((_e27 * _e29) + _e33);
    let _e35 = origin_2;
    let _e37 = synthesis.farthest;
    let _e40 = span_1[0u];
    x_5 = floor(((_e35 - _e37) - bitcast<f32>(_e40)));
    let _e44 = source_row();
    row_6 = _e44;
    let _e45 = x_5;
    let _e48 = synthesis.source_size[0u];
    param_50 = i32(clamp(_e45, 0f, f32((_e48 - 1i))));
    let _e53 = row_6;
    param_51 = _e53;
    let _e54 = depth_at((&param_50), (&param_51));
    depth_1 = _e54;
    let _e56 = span_1[0u];
    param_52 = _e56;
    let _e57 = span_steps((&param_52));
    let _e58 = x_5;
    let _e59 = origin_2;
    let _e63 = synthesis.law[1u];
    let _e64 = depth_1;
    let _e67 = origin_2;
    param_53 = _e67;
    let _e68 = row_6;
    param_54 = _e68;
    param_55 = _e57;
    let _e69 = x_5;
    param_56 = _e69;
    param_57 = ((_e58 - _e59) + (_e63 * _e64));
    let _e70 = depth_1;
    param_58 = _e70;
    let _e71 = march((&param_53), (&param_54), (&param_55), (&param_56), (&param_57), (&param_58), (&param_59));
    let _e72 = param_59;
    surface_1 = _e72;
    color_2 = _e71;
    let _e74 = surface_1.depth;
    gl_FragDepth = _e74;
    return;
}

@fragment 
fn main(@location(0) span_at: vec2<f32>, @builtin(position) gl_FragCoord: vec4<f32>) -> FragmentOutput {
    span_at_1 = span_at;
    gl_FragCoord_1 = gl_FragCoord;
    main_1();
    let _e6 = color_2;
    let _e7 = gl_FragDepth;
    return FragmentOutput(_e6, _e7);
}
