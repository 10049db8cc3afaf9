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

fn fill_hole(hole: ptr<function, bool>, color: ptr<function, vec4<f32>>, away: ptr<function, f32>, x_1: ptr<function, f32>, depth: ptr<function, f32>, row_1: ptr<function, i32>) -> vec4<f32> {
    var spread: f32;
    var sum: vec4<f32>;
    var weights: f32;
    var edge: i32;
    var param_1: i32;
    var i: i32;
    var distance_: f32;
    var below: vec2<i32>;
    var above: vec2<i32>;
    var depths: vec2<f32>;
    var param_2: i32;
    var param_3: i32;
    var param_4: i32;
    var param_5: i32;
    var below_color: vec4<f32>;
    var param_6: vec2<i32>;
    var above_color: vec4<f32>;
    var param_7: vec2<i32>;
    var weight: vec2<f32>;

    let _e39 = (*away);
    spread = (0.5f * clamp(abs(_e39), 1f, 12f));
    let _e43 = (*color);
    sum = (_e43 * 2f);
    weights = 2f;
    let _e45 = (*x_1);
    param_1 = i32(_e45);
    let _e47 = source_column((&param_1));
    edge = _e47;
    let _e48 = (*hole);
    i = select(3i, 1i, _e48);
    loop {
        let _e50 = i;
        if (_e50 <= 2i) {
            let _e52 = i;
            let _e54 = spread;
            distance_ = round((f32(_e52) * _e54));
            let _e57 = edge;
            let _e58 = (*row_1);
            let _e59 = distance_;
            below = vec2<i32>(_e57, max((_e58 - i32(_e59)), 0i));
            let _e64 = edge;
            let _e65 = (*row_1);
            let _e66 = distance_;
            let _e71 = synthesis.source_size[1u];
            above = vec2<i32>(_e64, min((_e65 + i32(_e66)), (_e71 - 1i)));
            let _e76 = below[0u];
            param_2 = _e76;
            let _e78 = below[1u];
            param_3 = _e78;
            let _e79 = depth_texel((&param_2), (&param_3));
            let _e81 = above[0u];
            param_4 = _e81;
            let _e83 = above[1u];
            param_5 = _e83;
            let _e84 = depth_texel((&param_4), (&param_5));
            depths = vec2<f32>(_e79, _e84);
            let _e86 = below;
            param_6 = _e86;
            let _e87 = in_image((&param_6));
            let _e88 = textureLoad(color_map_texture, _e87, 0i);
            below_color = _e88;
            let _e89 = above;
            param_7 = _e89;
            let _e90 = in_image((&param_7));
            let _e91 = textureLoad(color_map_texture, _e90, 0i);
            above_color = _e91;
            let _e94 = synthesis.law[1u];
            let _e95 = depths;
            let _e96 = (*depth);
            weight = select(vec2<f32>(0f, 0f), vec2<f32>(1f, 1f), (((_e95 - vec2(_e96)) * _e94) <= vec2<f32>(1f, 1f)));
            let _e103 = weight[0u];
            let _e104 = below_color;
            let _e107 = weight[1u];
            let _e108 = above_color;
            let _e111 = sum;
            sum = (_e111 + ((_e104 * _e103) + (_e108 * _e107)));
            let _e114 = weight[0u];
            let _e116 = weight[1u];
            let _e118 = weights;
            weights = (_e118 + (_e114 + _e116));
            continue;
        } else {
            break;
        }
        continuing {
            let _e120 = i;
            i = (_e120 + 1i);
        }
    }
    let _e122 = sum;
    let _e123 = weights;
    return (_e122 / vec4(_e123));
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

fn walk(at_1: ptr<function, Search>, end: ptr<function, f32>, origin: ptr<function, f32>, row_3: ptr<function, i32>) {
    var limit: f32;
    var step_: i32;
    var here: i32;
    var param_8: i32;
    var param_9: i32;
    var before: bool;
    var jump: bool;
    var torn: bool;
    var fold: bool;
    var beside: bool;
    var nearest: bool;
    var local_4: i32;
    var local_5: i32;
    var local_6: f32;
    var local_7: f32;
    var farther: bool;
    var local_8: i32;
    var local_9: f32;
    var phi_410_: bool;
    var phi_458_: bool;
    var phi_476_: bool;
    var phi_489_: bool;
    var phi_503_: bool;
    var phi_504_: bool;
    var phi_513_: bool;
    var phi_565_: bool;

    let _e34 = (*end);
    let _e35 = (*origin);
    limit = ((_e34 - _e35) - 0.5f);
    let _e39 = synthesis.mirrored;
    step_ = select(1i, -1i, (_e39 != 0u));
    loop {
        let _e43 = (*at_1).shift;
        let _e44 = limit;
        let _e45 = (_e43 < _e44);
        phi_410_ = _e45;
        if _e45 {
            let _e47 = (*at_1).found;
            phi_410_ = !(_e47);
        }
        let _e50 = phi_410_;
        if _e50 {
            let _e52 = (*at_1).b;
            (*at_1).a = _e52;
            let _e55 = (*at_1).next;
            (*at_1).depth = _e55;
            let _e58 = (*at_1).column;
            here = _e58;
            let _e59 = step_;
            let _e61 = (*at_1).column;
            (*at_1).column = (_e61 + _e59);
            let _e65 = (*at_1).shift;
            (*at_1).shift = (_e65 + 1f);
            let _e69 = (*at_1).column;
            param_8 = _e69;
            let _e70 = (*row_3);
            param_9 = _e70;
            let _e71 = depth_texel((&param_8), (&param_9));
            (*at_1).next = _e71;
            let _e74 = (*at_1).shift;
            let _e77 = synthesis.law[1u];
            let _e79 = (*at_1).next;
            (*at_1).b = (_e74 + (_e77 * _e79));
            let _e84 = (*at_1).a;
            before = (_e84 <= 0f);
            let _e86 = before;
            phi_458_ = _e86;
            if _e86 {
                let _e88 = (*at_1).b;
                phi_458_ = (_e88 > 0f);
            }
            let _e91 = phi_458_;
            jump = _e91;
            let _e93 = (*at_1).b;
            let _e95 = (*at_1).a;
            torn = ((_e93 - _e95) >= 2f);
            let _e98 = jump;
            phi_476_ = _e98;
            if _e98 {
                let _e100 = (*at_1).a;
                let _e102 = torn;
                phi_476_ = ((_e100 > -0.5f) || !(_e102));
            }
            let _e106 = phi_476_;
            (*at_1).found = _e106;
            let _e108 = before;
            phi_489_ = _e108;
            if _e108 {
                let _e110 = (*at_1).b;
                let _e113 = (*at_1).a;
                phi_489_ = (max(_e110, -1f) < _e113);
            }
            let _e116 = phi_489_;
            fold = _e116;
            let _e117 = fold;
            phi_504_ = _e117;
            if !(_e117) {
                let _e119 = jump;
                let _e120 = torn;
                let _e121 = (_e119 && _e120);
                phi_503_ = _e121;
                if _e121 {
                    let _e123 = (*at_1).b;
                    phi_503_ = (_e123 < 1f);
                }
                let _e126 = phi_503_;
                phi_504_ = _e126;
            }
            let _e128 = phi_504_;
            beside = _e128;
            let _e129 = beside;
            phi_513_ = _e129;
            if _e129 {
                let _e131 = (*at_1).rim;
                phi_513_ = (_e131 < 0i);
            }
            let _e134 = phi_513_;
            nearest = _e134;
            let _e135 = nearest;
            if _e135 {
                let _e136 = fold;
                if _e136 {
                    let _e137 = here;
                    local_5 = _e137;
                } else {
                    let _e139 = (*at_1).column;
                    local_5 = _e139;
                }
                let _e140 = local_5;
                local_4 = _e140;
            } else {
                let _e142 = (*at_1).rim;
                local_4 = _e142;
            }
            let _e143 = local_4;
            (*at_1).rim = _e143;
            let _e145 = nearest;
            if _e145 {
                let _e146 = fold;
                if _e146 {
                    let _e148 = (*at_1).depth;
                    local_7 = _e148;
                } else {
                    let _e150 = (*at_1).next;
                    local_7 = _e150;
                }
                let _e151 = local_7;
                local_6 = _e151;
            } else {
                let _e153 = (*at_1).rim_depth;
                local_6 = _e153;
            }
            let _e154 = local_6;
            (*at_1).rim_depth = _e154;
            let _e156 = jump;
            phi_565_ = _e156;
            if _e156 {
                let _e159 = synthesis.law[1u];
                let _e161 = (*at_1).depth;
                let _e163 = (*at_1).edge_depth;
                phi_565_ = ((_e159 * (_e161 - _e163)) < 0f);
            }
            let _e168 = phi_565_;
            farther = _e168;
            let _e169 = farther;
            if _e169 {
                let _e170 = here;
                local_8 = _e170;
            } else {
                let _e172 = (*at_1).edge;
                local_8 = _e172;
            }
            let _e173 = local_8;
            (*at_1).edge = _e173;
            let _e175 = farther;
            if _e175 {
                let _e177 = (*at_1).depth;
                local_9 = _e177;
            } else {
                let _e179 = (*at_1).edge_depth;
                local_9 = _e179;
            }
            let _e180 = local_9;
            (*at_1).edge_depth = _e180;
            continue;
        } else {
            break;
        }
    }
    return;
}

fn march(origin_1: ptr<function, f32>, row_4: ptr<function, i32>, steps: ptr<function, f32>, x_3: ptr<function, f32>, b: ptr<function, f32>, next: ptr<function, f32>, surface: ptr<function, Surface>) -> vec4<f32> {
    var last_column: f32;
    var outside: bool;
    var end_1: f32;
    var local_10: f32;
    var column_2: i32;
    var param_10: i32;
    var edge_1: i32;
    var edge_depth: f32;
    var local_11: f32;
    var at_2: Search;
    var param_11: Search;
    var param_12: f32;
    var param_13: f32;
    var param_14: i32;
    var own: bool;
    var local_12: i32;
    var param_15: i32;
    var t: f32;
    var local_13: f32;
    var local_14: f32;
    var away_1: f32;
    var color_1: vec4<f32>;
    var param_16: f32;
    var param_17: i32;
    var param_18: bool;
    var param_19: vec4<f32>;
    var param_20: f32;
    var param_21: f32;
    var param_22: f32;
    var param_23: i32;
    var param_24: i32;
    var coverage: f32;
    var param_25: vec2<i32>;
    var phi_678_: bool;
    var phi_756_: bool;

    let _e56 = synthesis.source_size[0u];
    last_column = f32((_e56 - 1i));
    let _e59 = (*x_3);
    let _e60 = (*b);
    (*b) = (_e60 - _e59);
    let _e62 = (*x_3);
    let _e63 = last_column;
    (*x_3) = clamp(_e62, 0f, _e63);
    let _e65 = (*x_3);
    let _e66 = (*b);
    (*b) = (_e66 + _e65);
    let _e68 = (*x_3);
    let _e70 = (*b);
    outside = ((_e68 == 0f) && (_e70 > 0f));
    let _e73 = outside;
    let _e74 = (*b);
    if (_e73 && (_e74 < 0.5f)) {
        let _e77 = (*x_3);
        local_10 = _e77;
    } else {
        let _e78 = (*x_3);
        let _e79 = (*steps);
        let _e81 = last_column;
        local_10 = min((_e78 + _e79), _e81);
    }
    let _e83 = local_10;
    end_1 = _e83;
    let _e84 = (*x_3);
    param_10 = i32(_e84);
    let _e86 = source_column((&param_10));
    column_2 = _e86;
    let _e87 = outside;
    let _e88 = column_2;
    edge_1 = select(-1i, _e88, _e87);
    let _e90 = outside;
    if _e90 {
        let _e91 = (*next);
        local_11 = _e91;
    } else {
        let _e94 = synthesis.law[1u];
        local_11 = select(1000000000f, -1000000000f, (_e94 < 0f));
    }
    let _e97 = local_11;
    edge_depth = _e97;
    let _e98 = column_2;
    let _e99 = (*x_3);
    let _e100 = (*origin_1);
    let _e102 = (*b);
    let _e103 = (*b);
    let _e104 = (*next);
    let _e105 = (*next);
    let _e106 = edge_1;
    let _e107 = edge_depth;
    at_2 = Search(_e98, (_e99 - _e100), _e102, _e103, _e104, _e105, false, _e106, _e107, -1i, 0f);
    let _e109 = at_2;
    param_11 = _e109;
    let _e110 = end_1;
    param_12 = _e110;
    let _e111 = (*origin_1);
    param_13 = _e111;
    let _e112 = (*row_4);
    param_14 = _e112;
    walk((&param_11), (&param_12), (&param_13), (&param_14));
    let _e113 = param_11;
    at_2 = _e113;
    let _e115 = at_2.found;
    phi_678_ = _e115;
    if !(_e115) {
        let _e118 = at_2.edge;
        phi_678_ = (_e118 < 0i);
    }
    let _e121 = phi_678_;
    own = _e121;
    let _e122 = own;
    if _e122 {
        let _e124 = at_2.column;
        local_12 = _e124;
    } else {
        let _e126 = at_2.edge;
        local_12 = _e126;
    }
    let _e127 = local_12;
    column_2 = _e127;
    let _e128 = column_2;
    param_15 = _e128;
    let _e129 = source_column((&param_15));
    (*x_3) = f32(_e129);
    let _e132 = at_2.b;
    let _e134 = at_2.a;
    if ((_e132 - _e134) < 2f) {
        let _e138 = at_2.a;
        let _e141 = at_2.b;
        let _e143 = at_2.a;
        local_13 = (-(_e138) / (_e141 - _e143));
    } else {
        local_13 = 0f;
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
    away_1 = ((_e167 - _e168) + (_e172 * _e174));
    let _e178 = at_2.found;
    let _e179 = !(_e178);
    phi_756_ = _e179;
    if _e179 {
        let _e180 = away_1;
        phi_756_ = (abs(_e180) >= 0.5f);
    }
    let _e184 = phi_756_;
    (*surface).hole = _e184;
    let _e187 = (*surface).source;
    param_16 = _e187;
    let _e188 = (*row_4);
    param_17 = _e188;
    let _e189 = color_at((&param_16), (&param_17));
    let _e191 = (*surface).hole;
    param_18 = _e191;
    param_19 = _e189;
    let _e192 = away_1;
    param_20 = _e192;
    let _e193 = (*x_3);
    param_21 = _e193;
    let _e195 = (*surface).depth;
    param_22 = _e195;
    let _e196 = (*row_4);
    param_23 = _e196;
    let _e197 = fill_hole((&param_18), (&param_19), (&param_20), (&param_21), (&param_22), (&param_23));
    color_1 = _e197;
    let _e199 = at_2.rim;
    if (_e199 >= 0i) {
        let _e202 = at_2.rim;
        param_24 = _e202;
        let _e203 = source_column((&param_24));
        (*x_3) = f32(_e203);
        let _e205 = (*x_3);
        let _e206 = (*origin_1);
        let _e210 = synthesis.law[1u];
        let _e212 = at_2.rim_depth;
        coverage = (1f - abs(((_e205 - _e206) + (_e210 * _e212))));
        let _e217 = color_1;
        let _e219 = at_2.rim;
        let _e220 = (*row_4);
        param_25 = vec2<i32>(_e219, _e220);
        let _e222 = in_image((&param_25));
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
    var param_26: i32;
    var param_27: i32;
    var param_28: i32;

    let _e5 = (*x_4);
    param_26 = _e5;
    let _e6 = source_column((&param_26));
    param_27 = _e6;
    let _e7 = (*row_5);
    param_28 = _e7;
    let _e8 = depth_texel((&param_27), (&param_28));
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
    var param_29: i32;
    var param_30: i32;
    var param_31: u32;
    var surface_1: Surface;
    var param_32: f32;
    var param_33: i32;
    var param_34: f32;
    var param_35: f32;
    var param_36: f32;
    var param_37: f32;
    var param_38: Surface;

    let _e23 = pixel_span();
    span_1 = _e23;
    let _e26 = synthesis.origins[0u];
    let _e28 = gl_FragCoord_1[0u];
    let _e32 = synthesis.origins[1u];
    origin_2 = ((_e26 * _e28) + _e32);
    let _e34 = origin_2;
    let _e36 = synthesis.farthest;
    let _e39 = span_1[0u];
    x_5 = floor(((_e34 - _e36) - bitcast<f32>(_e39)));
    let _e43 = source_row();
    row_6 = _e43;
    let _e44 = x_5;
    let _e47 = synthesis.source_size[0u];
    param_29 = i32(clamp(_e44, 0f, f32((_e47 - 1i))));
    let _e52 = row_6;
    param_30 = _e52;
    let _e53 = depth_at((&param_29), (&param_30));
    depth_1 = _e53;
    let _e55 = span_1[0u];
    param_31 = _e55;
    let _e56 = span_steps((&param_31));
    let _e57 = x_5;
    let _e58 = origin_2;
    let _e62 = synthesis.law[1u];
    let _e63 = depth_1;
    let _e66 = origin_2;
    param_32 = _e66;
    let _e67 = row_6;
    param_33 = _e67;
    param_34 = _e56;
    let _e68 = x_5;
    param_35 = _e68;
    param_36 = ((_e57 - _e58) + (_e62 * _e63));
    let _e69 = depth_1;
    param_37 = _e69;
    let _e70 = march((&param_32), (&param_33), (&param_34), (&param_35), (&param_36), (&param_37), (&param_38));
    let _e71 = param_38;
    surface_1 = _e71;
    color_2 = _e70;
    return;
}

@fragment 
fn main(@location(0) span_at: vec2<f32>, @builtin(position) gl_FragCoord: vec4<f32>) -> @location(0) vec4<f32> {
    span_at_1 = span_at;
    gl_FragCoord_1 = gl_FragCoord;
    main_1();
    let _e5 = color_2;
    return _e5;
}
