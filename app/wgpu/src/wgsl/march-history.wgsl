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
    front: f32,
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

struct History {
    to_history: array<mat4x4<f32>, 8>,
    history_strips: i32,
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
@group(0) @binding(10) 
var history_depth_texture: texture_2d<f32>;
@group(0) @binding(12) 
var<uniform> history: History;
@group(0) @binding(11) 
var history_color_texture: texture_2d<f32>;
var<private> gl_FragCoord_1: vec4<f32>;
var<private> color_3: vec4<f32>;

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

fn depth_at(x_2: ptr<function, i32>, row_2: ptr<function, i32>) -> f32 {
    var param_8: i32;
    var param_9: i32;
    var param_10: i32;

    let _e5 = (*x_2);
    param_8 = _e5;
    let _e6 = source_column((&param_8));
    param_9 = _e6;
    let _e7 = (*row_2);
    param_10 = _e7;
    let _e8 = depth_texel((&param_9), (&param_10));
    return _e8;
}

fn nearness_at(x_3: ptr<function, i32>, row_3: ptr<function, i32>) -> f32 {
    var param_11: i32;
    var param_12: i32;

    let _e8 = synthesis.law[1u];
    let _e9 = (*x_3);
    param_11 = _e9;
    let _e10 = (*row_3);
    param_12 = _e10;
    let _e11 = depth_at((&param_11), (&param_12));
    return (_e8 * _e11);
}

fn recall(pixel_1: ptr<function, vec2<f32>>, front: ptr<function, f32>, origin: ptr<function, f32>, row_4: ptr<function, i32>, color_1: ptr<function, vec4<f32>>, depth_1: ptr<function, f32>) -> bool {
    var size: vec2<f32>;
    var scale: vec2<f32>;
    var rows: f32;
    var guess: vec2<f32>;
    var i_1: i32;
    var strip: i32;
    var seen: vec4<f32>;
    var local_2: vec2<f32>;
    var inside: bool;
    var stored: f32;
    var along: vec4<f32>;
    var farther: f32;
    var place: vec2<f32>;
    var here: f32;
    var nearness: f32;
    var last: f32;
    var column_1: f32;
    var outside: bool;
    var x_4: i32;
    var before: f32;
    var param_13: i32;
    var param_14: i32;
    var param_15: i32;
    var param_16: i32;
    var same: bool;
    var behind: bool;
    var hidden: bool;
    var least: vec2<f32>;
    var most: vec2<f32>;
    var corner: vec2<i32>;
    var whole: bool;
    var i_2: i32;
    var texel: vec2<i32>;
    var local_3: vec2<f32>;
    var phi_501_: bool;
    var phi_516_: bool;
    var phi_646_: bool;
    var phi_724_: bool;

    let _e60 = textureDimensions(history_depth_texture, 0i);
    size = vec2<f32>(vec2<i32>(_e60));
    let _e63 = size;
    let _e65 = synthesis.target_size;
    scale = (_e63 / vec2<f32>(_e65));
    let _e69 = size[1u];
    let _e72 = history.history_strips;
    let _e76 = history.history_strips;
    rows = f32((((i32(_e69) + _e72) - 1i) / _e76));
    let _e79 = (*pixel_1);
    let _e80 = scale;
    guess = (_e79 * _e80);
    i_1 = 0i;
    loop {
        let _e82 = i_1;
        if (_e82 < 2i) {
            let _e85 = guess[1u];
            let _e86 = rows;
            let _e89 = history.history_strips;
            strip = i32(clamp((_e85 / _e86), 0f, f32((_e89 - 1i))));
            let _e94 = strip;
            let _e97 = history.to_history[_e94];
            let _e98 = (*pixel_1);
            let _e99 = (*depth_1);
            seen = (_e97 * vec4<f32>(_e98.x, _e98.y, _e99, 1f));
            let _e105 = seen[3u];
            if (_e105 > 0f) {
                let _e107 = seen;
                let _e110 = seen[3u];
                local_2 = (_e107.xy / vec2(_e110));
            } else {
                let _e113 = guess;
                local_2 = _e113;
            }
            let _e114 = local_2;
            guess = _e114;
            continue;
        } else {
            break;
        }
        continuing {
            let _e115 = i_1;
            i_1 = (_e115 + 1i);
        }
    }
    let _e117 = guess;
    let _e119 = all((_e117 >= vec2<f32>(0f, 0f)));
    phi_501_ = _e119;
    if _e119 {
        let _e120 = guess;
        let _e121 = size;
        phi_501_ = all((_e120 < _e121));
    }
    let _e125 = phi_501_;
    inside = _e125;
    let _e127 = seen[3u];
    let _e129 = inside;
    let _e130 = ((_e127 > 0f) && _e129);
    phi_516_ = _e130;
    if _e130 {
        let _e132 = guess[1u];
        let _e133 = rows;
        let _e136 = strip;
        phi_516_ = (i32((_e132 / _e133)) == _e136);
    }
    let _e139 = phi_516_;
    if !(_e139) {
        return false;
    }
    let _e141 = guess;
    let _e143 = textureLoad(history_depth_texture, vec2<i32>(_e141), 0i);
    stored = _e143.x;
    let _e145 = strip;
    let _e149 = history.to_history[_e145][2];
    along = _e149;
    let _e150 = stored;
    let _e152 = seen[3u];
    let _e155 = seen[2u];
    let _e158 = along[2u];
    let _e159 = stored;
    let _e161 = along[3u];
    farther = (((_e150 * _e152) - _e155) / (_e158 - (_e159 * _e161)));
    let _e165 = farther;
    let _e166 = along;
    let _e168 = seen;
    seen = (_e168 + (_e166 * _e165));
    let _e170 = seen;
    let _e173 = seen[3u];
    place = (_e170.xy / vec2(_e173));
    let _e176 = (*depth_1);
    let _e177 = farther;
    here = (_e176 + _e177);
    let _e181 = synthesis.law[1u];
    let _e182 = here;
    nearness = (_e181 * _e182);
    let _e186 = synthesis.source_size[0u];
    last = f32((_e186 - 1i));
    let _e189 = (*origin);
    let _e190 = nearness;
    column_1 = floor((_e189 - _e190));
    let _e193 = column_1;
    let _e195 = column_1;
    let _e196 = last;
    outside = !(((_e193 >= 0f) && (_e195 < _e196)));
    let _e200 = column_1;
    let _e201 = last;
    x_4 = i32(clamp(_e200, 0f, max((_e201 - 1f), 0f)));
    let _e206 = x_4;
    param_13 = _e206;
    let _e207 = (*row_4);
    param_14 = _e207;
    let _e208 = nearness_at((&param_13), (&param_14));
    let _e209 = x_4;
    let _e213 = synthesis.source_size[0u];
    param_15 = min((_e209 + 1i), (_e213 - 1i));
    let _e216 = (*row_4);
    param_16 = _e216;
    let _e217 = nearness_at((&param_15), (&param_16));
    before = max(_e208, _e217);
    let _e219 = place;
    let _e220 = guess;
    let _e222 = scale;
    same = (length(((_e219 - _e220) / _e222)) < 1f);
    let _e226 = nearness;
    let _e227 = (*front);
    let _e228 = (*front);
    let _e231 = synthesis.law[1u];
    let _e232 = (*depth_1);
    behind = (_e226 <= (_e227 - (0.25f * (_e228 - (_e231 * _e232)))));
    let _e238 = outside;
    phi_646_ = _e238;
    if !(_e238) {
        let _e240 = before;
        let _e241 = nearness;
        phi_646_ = (_e240 > (_e241 - 1f));
    }
    let _e245 = phi_646_;
    hidden = _e245;
    let _e246 = same;
    let _e247 = behind;
    let _e249 = hidden;
    if !(((_e246 && _e247) && _e249)) {
        return false;
    }
    let _e252 = strip;
    let _e254 = rows;
    least = vec2<f32>(0.5f, ((f32(_e252) * _e254) + 0.5f));
    let _e259 = size[0u];
    let _e260 = strip;
    let _e263 = rows;
    let _e266 = size[1u];
    most = (vec2<f32>(_e259, min((f32((_e260 + 1i)) * _e263), _e266)) - vec2(0.5f));
    let _e271 = place;
    let _e272 = least;
    let _e273 = most;
    place = clamp(_e271, _e272, _e273);
    let _e275 = place;
    corner = vec2<i32>((_e275 - vec2(0.5f)));
    whole = true;
    i_2 = 0i;
    loop {
        let _e279 = i_2;
        if (_e279 < 4i) {
            let _e281 = corner;
            let _e282 = i_2;
            let _e284 = i_2;
            let _e289 = most;
            texel = min((_e281 + vec2<i32>((_e282 & 1i), (_e284 >> bitcast<u32>(1i)))), vec2<i32>(_e289));
            let _e292 = whole;
            phi_724_ = _e292;
            if _e292 {
                let _e295 = synthesis.law[1u];
                let _e296 = texel;
                let _e297 = textureLoad(history_depth_texture, _e296, 0i);
                let _e299 = stored;
                phi_724_ = (abs((_e295 * (_e297.x - _e299))) < 1f);
            }
            let _e305 = phi_724_;
            whole = _e305;
            continue;
        } else {
            break;
        }
        continuing {
            let _e306 = i_2;
            i_2 = (_e306 + 1i);
        }
    }
    let _e308 = whole;
    if _e308 {
        let _e309 = place;
        local_3 = _e309;
    } else {
        let _e310 = guess;
        local_3 = (floor(_e310) + vec2(0.5f));
    }
    let _e314 = local_3;
    let _e315 = size;
    let _e317 = textureSampleLevel(history_color_texture, linear_sampler, (_e314 / _e315), 0f);
    (*color_1) = _e317;
    let _e318 = here;
    (*depth_1) = _e318;
    return true;
}

fn color_at(x_5: ptr<function, f32>, row_5: ptr<function, i32>) -> vec4<f32> {
    var column_2: f32;
    var local_4: f32;
    var at: vec2<f32>;
    var local_5: vec2<f32>;

    let _e15 = synthesis.mirrored;
    if (_e15 != 0u) {
        let _e19 = synthesis.source_size[0u];
        let _e22 = (*x_5);
        local_4 = (f32((_e19 - 1i)) - _e22);
    } else {
        let _e24 = (*x_5);
        local_4 = _e24;
    }
    let _e25 = local_4;
    column_2 = _e25;
    let _e26 = column_2;
    let _e27 = (*row_5);
    at = (vec2<f32>(_e26, f32(_e27)) + vec2(0.5f));
    if true {
        let _e33 = synthesis.source_origin;
        let _e35 = at;
        let _e38 = synthesis.texel;
        local_5 = ((vec2<f32>(_e33) + _e35) * _e38);
    } else {
        let _e40 = at;
        let _e42 = synthesis.source_size;
        local_5 = (_e40 / vec2<f32>(_e42));
    }
    let _e45 = local_5;
    at = _e45;
    let _e46 = at;
    let _e47 = textureSampleLevel(color_map_texture, linear_sampler, _e46, 0f);
    return _e47;
}

fn walk(at_1: ptr<function, Search>, end: ptr<function, f32>, origin_1: ptr<function, f32>, row_6: ptr<function, i32>) {
    var limit: f32;
    var step_: i32;
    var here_1: i32;
    var param_17: i32;
    var param_18: i32;
    var before_1: bool;
    var jump: bool;
    var torn: bool;
    var fold: bool;
    var beside: bool;
    var nearest: bool;
    var local_6: i32;
    var local_7: i32;
    var local_8: f32;
    var local_9: f32;
    var farther_1: bool;
    var local_10: i32;
    var local_11: f32;
    var local_12: f32;
    var phi_774_: bool;
    var phi_821_: bool;
    var phi_839_: bool;
    var phi_852_: bool;
    var phi_866_: bool;
    var phi_867_: bool;
    var phi_876_: bool;
    var phi_928_: bool;

    let _e35 = (*end);
    let _e36 = (*origin_1);
    limit = ((_e35 - _e36) - 0.5f);
    let _e40 = synthesis.mirrored;
    step_ = select(1i, -1i, (_e40 != 0u));
    loop {
        let _e44 = (*at_1).shift;
        let _e45 = limit;
        let _e46 = (_e44 < _e45);
        phi_774_ = _e46;
        if _e46 {
            let _e48 = (*at_1).found;
            phi_774_ = !(_e48);
        }
        let _e51 = phi_774_;
        if _e51 {
            let _e53 = (*at_1).b;
            (*at_1).a = _e53;
            let _e56 = (*at_1).next;
            (*at_1).depth = _e56;
            let _e59 = (*at_1).column;
            here_1 = _e59;
            let _e60 = step_;
            let _e62 = (*at_1).column;
            (*at_1).column = (_e62 + _e60);
            let _e66 = (*at_1).shift;
            (*at_1).shift = (_e66 + 1f);
            let _e70 = (*at_1).column;
            param_17 = _e70;
            let _e71 = (*row_6);
            param_18 = _e71;
            let _e72 = depth_texel((&param_17), (&param_18));
            (*at_1).next = _e72;
            let _e75 = (*at_1).shift;
            let _e78 = synthesis.law[1u];
            let _e80 = (*at_1).next;
            (*at_1).b = (_e75 + (_e78 * _e80));
            let _e85 = (*at_1).a;
            before_1 = (_e85 <= 0f);
            let _e87 = before_1;
            phi_821_ = _e87;
            if _e87 {
                let _e89 = (*at_1).b;
                phi_821_ = (_e89 > 0f);
            }
            let _e92 = phi_821_;
            jump = _e92;
            let _e94 = (*at_1).b;
            let _e96 = (*at_1).a;
            torn = ((_e94 - _e96) >= 2f);
            let _e99 = jump;
            phi_839_ = _e99;
            if _e99 {
                let _e101 = (*at_1).a;
                let _e103 = torn;
                phi_839_ = ((_e101 > -0.5f) || !(_e103));
            }
            let _e107 = phi_839_;
            (*at_1).found = _e107;
            let _e109 = before_1;
            phi_852_ = _e109;
            if _e109 {
                let _e111 = (*at_1).b;
                let _e114 = (*at_1).a;
                phi_852_ = (max(_e111, -1f) < _e114);
            }
            let _e117 = phi_852_;
            fold = _e117;
            let _e118 = fold;
            phi_867_ = _e118;
            if !(_e118) {
                let _e120 = jump;
                let _e121 = torn;
                let _e122 = (_e120 && _e121);
                phi_866_ = _e122;
                if _e122 {
                    let _e124 = (*at_1).b;
                    phi_866_ = (_e124 < 1f);
                }
                let _e127 = phi_866_;
                phi_867_ = _e127;
            }
            let _e129 = phi_867_;
            beside = _e129;
            let _e130 = beside;
            phi_876_ = _e130;
            if _e130 {
                let _e132 = (*at_1).rim;
                phi_876_ = (_e132 < 0i);
            }
            let _e135 = phi_876_;
            nearest = _e135;
            let _e136 = nearest;
            if _e136 {
                let _e137 = fold;
                if _e137 {
                    let _e138 = here_1;
                    local_7 = _e138;
                } else {
                    let _e140 = (*at_1).column;
                    local_7 = _e140;
                }
                let _e141 = local_7;
                local_6 = _e141;
            } else {
                let _e143 = (*at_1).rim;
                local_6 = _e143;
            }
            let _e144 = local_6;
            (*at_1).rim = _e144;
            let _e146 = nearest;
            if _e146 {
                let _e147 = fold;
                if _e147 {
                    let _e149 = (*at_1).depth;
                    local_9 = _e149;
                } else {
                    let _e151 = (*at_1).next;
                    local_9 = _e151;
                }
                let _e152 = local_9;
                local_8 = _e152;
            } else {
                let _e154 = (*at_1).rim_depth;
                local_8 = _e154;
            }
            let _e155 = local_8;
            (*at_1).rim_depth = _e155;
            let _e157 = jump;
            phi_928_ = _e157;
            if _e157 {
                let _e160 = synthesis.law[1u];
                let _e162 = (*at_1).depth;
                let _e164 = (*at_1).edge_depth;
                phi_928_ = ((_e160 * (_e162 - _e164)) < 0f);
            }
            let _e169 = phi_928_;
            farther_1 = _e169;
            let _e170 = farther_1;
            if _e170 {
                let _e171 = here_1;
                local_10 = _e171;
            } else {
                let _e173 = (*at_1).edge;
                local_10 = _e173;
            }
            let _e174 = local_10;
            (*at_1).edge = _e174;
            let _e176 = farther_1;
            if _e176 {
                let _e178 = (*at_1).depth;
                local_11 = _e178;
            } else {
                let _e180 = (*at_1).edge_depth;
                local_11 = _e180;
            }
            let _e181 = local_11;
            (*at_1).edge_depth = _e181;
            let _e183 = farther_1;
            if _e183 {
                let _e186 = synthesis.law[1u];
                let _e188 = (*at_1).next;
                local_12 = (_e186 * _e188);
            } else {
                let _e191 = (*at_1).front;
                local_12 = _e191;
            }
            let _e192 = local_12;
            (*at_1).front = _e192;
            continue;
        } else {
            break;
        }
    }
    return;
}

fn march(origin_2: ptr<function, f32>, row_7: ptr<function, i32>, steps: ptr<function, f32>, x_6: ptr<function, f32>, b: ptr<function, f32>, next: ptr<function, f32>, surface: ptr<function, Surface>) -> vec4<f32> {
    var last_column: f32;
    var outside_1: bool;
    var end_1: f32;
    var local_13: f32;
    var column_3: i32;
    var param_19: i32;
    var edge_1: i32;
    var edge_depth: f32;
    var local_14: f32;
    var at_2: Search;
    var param_20: Search;
    var param_21: f32;
    var param_22: f32;
    var param_23: i32;
    var own: bool;
    var local_15: i32;
    var param_24: i32;
    var t: f32;
    var local_16: f32;
    var local_17: f32;
    var away_1: f32;
    var color_2: vec4<f32>;
    var param_25: f32;
    var param_26: i32;
    var unknown: bool;
    var i_3: i32;
    var param_27: vec2<f32>;
    var param_28: f32;
    var param_29: f32;
    var param_30: i32;
    var param_31: vec4<f32>;
    var param_32: f32;
    var param_33: bool;
    var param_34: vec4<f32>;
    var param_35: f32;
    var param_36: f32;
    var param_37: f32;
    var param_38: i32;
    var param_39: i32;
    var coverage: f32;
    var param_40: vec2<i32>;
    var phi_1055_: bool;
    var phi_1133_: bool;

    let _e65 = synthesis.source_size[0u];
    last_column = f32((_e65 - 1i));
    let _e68 = (*x_6);
    let _e69 = (*b);
    (*b) = (_e69 - _e68);
    let _e71 = (*x_6);
    let _e72 = last_column;
    (*x_6) = clamp(_e71, 0f, _e72);
    let _e74 = (*x_6);
    let _e75 = (*b);
    (*b) = (_e75 + _e74);
    let _e77 = (*x_6);
    let _e79 = (*b);
    outside_1 = ((_e77 == 0f) && (_e79 > 0f));
    let _e82 = outside_1;
    let _e83 = (*b);
    if (_e82 && (_e83 < 0.5f)) {
        let _e86 = (*x_6);
        local_13 = _e86;
    } else {
        let _e87 = (*x_6);
        let _e88 = (*steps);
        let _e90 = last_column;
        local_13 = min((_e87 + _e88), _e90);
    }
    let _e92 = local_13;
    end_1 = _e92;
    let _e93 = (*x_6);
    param_19 = i32(_e93);
    let _e95 = source_column((&param_19));
    column_3 = _e95;
    let _e96 = outside_1;
    let _e97 = column_3;
    edge_1 = select(-1i, _e97, _e96);
    let _e99 = outside_1;
    if _e99 {
        let _e100 = (*next);
        local_14 = _e100;
    } else {
        let _e103 = synthesis.law[1u];
        local_14 = select(1000000000f, -1000000000f, (_e103 < 0f));
    }
    let _e106 = local_14;
    edge_depth = _e106;
    let _e107 = column_3;
    let _e108 = (*x_6);
    let _e109 = (*origin_2);
    let _e111 = (*b);
    let _e112 = (*b);
    let _e113 = (*next);
    let _e114 = (*next);
    let _e115 = edge_1;
    let _e116 = edge_depth;
    at_2 = Search(_e107, (_e108 - _e109), _e111, _e112, _e113, _e114, false, _e115, _e116, 1000000000f, -1i, 0f);
    let _e118 = at_2;
    param_20 = _e118;
    let _e119 = end_1;
    param_21 = _e119;
    let _e120 = (*origin_2);
    param_22 = _e120;
    let _e121 = (*row_7);
    param_23 = _e121;
    walk((&param_20), (&param_21), (&param_22), (&param_23));
    let _e122 = param_20;
    at_2 = _e122;
    let _e124 = at_2.found;
    phi_1055_ = _e124;
    if !(_e124) {
        let _e127 = at_2.edge;
        phi_1055_ = (_e127 < 0i);
    }
    let _e130 = phi_1055_;
    own = _e130;
    let _e131 = own;
    if _e131 {
        let _e133 = at_2.column;
        local_15 = _e133;
    } else {
        let _e135 = at_2.edge;
        local_15 = _e135;
    }
    let _e136 = local_15;
    column_3 = _e136;
    let _e137 = column_3;
    param_24 = _e137;
    let _e138 = source_column((&param_24));
    (*x_6) = f32(_e138);
    let _e141 = at_2.b;
    let _e143 = at_2.a;
    if ((_e141 - _e143) < 2f) {
        let _e147 = at_2.a;
        let _e150 = at_2.b;
        let _e152 = at_2.a;
        local_16 = (-(_e147) / (_e150 - _e152));
    } else {
        local_16 = 0f;
    }
    let _e155 = local_16;
    t = _e155;
    let _e157 = at_2.found;
    let _e158 = t;
    t = select(1f, _e158, _e157);
    let _e160 = (*x_6);
    let _e162 = t;
    (*surface).source = ((_e160 - 1f) + _e162);
    let _e166 = at_2.depth;
    let _e167 = own;
    if _e167 {
        let _e169 = at_2.next;
        local_17 = _e169;
    } else {
        let _e171 = at_2.edge_depth;
        local_17 = _e171;
    }
    let _e172 = local_17;
    let _e173 = t;
    (*surface).depth = mix(_e166, _e172, _e173);
    let _e176 = (*x_6);
    let _e177 = (*origin_2);
    let _e181 = synthesis.law[1u];
    let _e183 = (*surface).depth;
    away_1 = ((_e176 - _e177) + (_e181 * _e183));
    let _e187 = at_2.found;
    let _e188 = !(_e187);
    phi_1133_ = _e188;
    if _e188 {
        let _e189 = away_1;
        phi_1133_ = (abs(_e189) >= 0.5f);
    }
    let _e193 = phi_1133_;
    (*surface).hole = _e193;
    let _e196 = (*surface).source;
    param_25 = _e196;
    let _e197 = (*row_7);
    param_26 = _e197;
    let _e198 = color_at((&param_25), (&param_26));
    color_2 = _e198;
    let _e200 = (*surface).hole;
    unknown = _e200;
    let _e202 = (*surface).hole;
    i_3 = select(1i, 0i, _e202);
    loop {
        let _e204 = i_3;
        if (_e204 < 1i) {
            let _e206 = gl_FragCoord_1;
            let _e209 = synthesis.target_origin;
            param_27 = (_e206.xy - vec2<f32>(_e209));
            let _e213 = at_2.front;
            param_28 = _e213;
            let _e214 = (*origin_2);
            param_29 = _e214;
            let _e215 = (*row_7);
            param_30 = _e215;
            let _e216 = color_2;
            param_31 = _e216;
            let _e218 = (*surface).depth;
            param_32 = _e218;
            let _e219 = recall((&param_27), (&param_28), (&param_29), (&param_30), (&param_31), (&param_32));
            let _e220 = param_31;
            color_2 = _e220;
            let _e221 = param_32;
            (*surface).depth = _e221;
            unknown = !(_e219);
            continue;
        } else {
            break;
        }
        continuing {
            let _e224 = i_3;
            i_3 = (_e224 + 1i);
        }
    }
    let _e226 = unknown;
    param_33 = _e226;
    let _e227 = color_2;
    param_34 = _e227;
    let _e228 = away_1;
    param_35 = _e228;
    let _e229 = (*x_6);
    param_36 = _e229;
    let _e231 = (*surface).depth;
    param_37 = _e231;
    let _e232 = (*row_7);
    param_38 = _e232;
    let _e233 = fill_hole((&param_33), (&param_34), (&param_35), (&param_36), (&param_37), (&param_38));
    color_2 = _e233;
    let _e235 = at_2.rim;
    if (_e235 >= 0i) {
        let _e238 = at_2.rim;
        param_39 = _e238;
        let _e239 = source_column((&param_39));
        (*x_6) = f32(_e239);
        let _e241 = (*x_6);
        let _e242 = (*origin_2);
        let _e246 = synthesis.law[1u];
        let _e248 = at_2.rim_depth;
        coverage = (1f - abs(((_e241 - _e242) + (_e246 * _e248))));
        let _e253 = color_2;
        let _e255 = at_2.rim;
        let _e256 = (*row_7);
        param_40 = vec2<i32>(_e255, _e256);
        let _e258 = in_image((&param_40));
        let _e259 = textureLoad(color_map_texture, _e258, 0i);
        let _e260 = coverage;
        color_2 = mix(_e253, _e259, vec4(_e260));
        let _e263 = coverage;
        if (_e263 >= 0.5f) {
            let _e265 = (*x_6);
            let _e267 = at_2.rim_depth;
            (*surface) = Surface(_e265, _e267, false);
        }
    }
    let _e269 = color_2;
    return _e269;
}

fn span_steps(span: ptr<function, u32>) -> f32 {
    var steps_1: u32;
    var local_18: f32;

    let _e5 = (*span);
    steps_1 = (_e5 & 1023u);
    let _e7 = steps_1;
    if (_e7 == 1023u) {
        local_18 = 1000000000f;
    } else {
        let _e9 = steps_1;
        local_18 = f32(_e9);
    }
    let _e11 = local_18;
    return _e11;
}

fn source_row() -> i32 {
    let _e6 = gl_FragCoord_1[1u];
    let _e8 = synthesis.first_row;
    let _e12 = synthesis.source_size[1u];
    return i32(clamp((_e6 - _e8), 0f, f32((_e12 - 1i))));
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
    var span_1: vec4<u32>;
    var origin_3: f32;
    var x_7: f32;
    var row_8: i32;
    var depth_2: f32;
    var param_41: i32;
    var param_42: i32;
    var param_43: u32;
    var surface_1: Surface;
    var param_44: f32;
    var param_45: i32;
    var param_46: f32;
    var param_47: f32;
    var param_48: f32;
    var param_49: f32;
    var param_50: Surface;

    let _e23 = pixel_span();
    span_1 = _e23;
    let _e26 = synthesis.origins[0u];
    let _e28 = gl_FragCoord_1[0u];
    let _e32 = synthesis.origins[1u];
    origin_3 = ((_e26 * _e28) + _e32);
    let _e34 = origin_3;
    let _e36 = synthesis.farthest;
    let _e39 = span_1[0u];
    x_7 = floor(((_e34 - _e36) - bitcast<f32>(_e39)));
    let _e43 = source_row();
    row_8 = _e43;
    let _e44 = x_7;
    let _e47 = synthesis.source_size[0u];
    param_41 = i32(clamp(_e44, 0f, f32((_e47 - 1i))));
    let _e52 = row_8;
    param_42 = _e52;
    let _e53 = depth_at((&param_41), (&param_42));
    depth_2 = _e53;
    let _e55 = span_1[0u];
    param_43 = _e55;
    let _e56 = span_steps((&param_43));
    let _e57 = x_7;
    let _e58 = origin_3;
    let _e62 = synthesis.law[1u];
    let _e63 = depth_2;
    let _e66 = origin_3;
    param_44 = _e66;
    let _e67 = row_8;
    param_45 = _e67;
    param_46 = _e56;
    let _e68 = x_7;
    param_47 = _e68;
    param_48 = ((_e57 - _e58) + (_e62 * _e63));
    let _e69 = depth_2;
    param_49 = _e69;
    let _e70 = march((&param_44), (&param_45), (&param_46), (&param_47), (&param_48), (&param_49), (&param_50));
    let _e71 = param_50;
    surface_1 = _e71;
    color_3 = _e70;
    return;
}

@fragment 
fn main(@location(0) span_at: vec2<f32>, @builtin(position) gl_FragCoord: vec4<f32>) -> @location(0) vec4<f32> {
    span_at_1 = span_at;
    gl_FragCoord_1 = gl_FragCoord;
    main_1();
    let _e5 = color_3;
    return _e5;
}
