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

fn depth_at(x_2: ptr<function, i32>, row_2: ptr<function, i32>) -> f32 {
    var param_9: i32;
    var param_10: i32;
    var param_11: i32;

    let _e5 = (*x_2);
    param_9 = _e5;
    let _e6 = source_column((&param_9));
    param_10 = _e6;
    let _e7 = (*row_2);
    param_11 = _e7;
    let _e8 = depth_texel((&param_10), (&param_11));
    return _e8;
}

fn nearness_at(x_3: ptr<function, i32>, row_3: ptr<function, i32>) -> f32 {
    var param_12: i32;
    var param_13: i32;

    let _e8 = synthesis.law[1u];
    let _e9 = (*x_3);
    param_12 = _e9;
    let _e10 = (*row_3);
    param_13 = _e10;
    let _e11 = depth_at((&param_12), (&param_13));
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
    var param_14: i32;
    var param_15: i32;
    var param_16: i32;
    var param_17: i32;
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
    var phi_606_: bool;
    var phi_621_: bool;
    var phi_751_: bool;
    var phi_829_: bool;

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
    phi_606_ = _e119;
    if _e119 {
        let _e120 = guess;
        let _e121 = size;
        phi_606_ = all((_e120 < _e121));
    }
    let _e125 = phi_606_;
    inside = _e125;
    let _e127 = seen[3u];
    let _e129 = inside;
    let _e130 = ((_e127 > 0f) && _e129);
    phi_621_ = _e130;
    if _e130 {
        let _e132 = guess[1u];
        let _e133 = rows;
        let _e136 = strip;
        phi_621_ = (i32((_e132 / _e133)) == _e136);
    }
    let _e139 = phi_621_;
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
    param_14 = _e206;
    let _e207 = (*row_4);
    param_15 = _e207;
    let _e208 = nearness_at((&param_14), (&param_15));
    let _e209 = x_4;
    let _e213 = synthesis.source_size[0u];
    param_16 = min((_e209 + 1i), (_e213 - 1i));
    let _e216 = (*row_4);
    param_17 = _e216;
    let _e217 = nearness_at((&param_16), (&param_17));
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
    phi_751_ = _e238;
    if !(_e238) {
        let _e240 = before;
        let _e241 = nearness;
        phi_751_ = (_e240 > (_e241 - 1f));
    }
    let _e245 = phi_751_;
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
            phi_829_ = _e292;
            if _e292 {
                let _e295 = synthesis.law[1u];
                let _e296 = texel;
                let _e297 = textureLoad(history_depth_texture, _e296, 0i);
                let _e299 = stored;
                phi_829_ = (abs((_e295 * (_e297.x - _e299))) < 1f);
            }
            let _e305 = phi_829_;
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
    var phi_168_: bool;

    let _e4 = (*a_2);
    let _e5 = (_e4 <= 0f);
    phi_168_ = _e5;
    if _e5 {
        let _e6 = (*b_2);
        let _e8 = (*a_2);
        phi_168_ = (max(_e6, -1f) < _e8);
    }
    let _e11 = phi_168_;
    return _e11;
}

fn has_rim(a_3: ptr<function, f32>, b_3: ptr<function, f32>) -> bool {
    var param_18: f32;
    var param_19: f32;
    var param_20: f32;
    var param_21: f32;
    var param_22: f32;
    var param_23: f32;
    var phi_191_: bool;
    var phi_196_: bool;

    let _e9 = (*a_3);
    param_18 = _e9;
    let _e10 = (*b_3);
    param_19 = _e10;
    let _e11 = folds((&param_18), (&param_19));
    phi_196_ = _e11;
    if !(_e11) {
        let _e13 = (*a_3);
        param_20 = _e13;
        let _e14 = (*b_3);
        param_21 = _e14;
        let _e15 = jumps((&param_20), (&param_21));
        phi_191_ = _e15;
        if _e15 {
            let _e16 = (*a_3);
            param_22 = _e16;
            let _e17 = (*b_3);
            param_23 = _e17;
            let _e18 = is_torn((&param_22), (&param_23));
            phi_191_ = _e18;
        }
        let _e20 = phi_191_;
        let _e21 = (*b_3);
        phi_196_ = (_e20 && (_e21 < 1f));
    }
    let _e25 = phi_196_;
    return _e25;
}

fn is_seen(a_4: ptr<function, f32>, b_4: ptr<function, f32>) -> bool {
    var param_24: f32;
    var param_25: f32;
    var param_26: f32;
    var param_27: f32;
    var phi_155_: bool;
    var phi_156_: bool;

    let _e7 = (*a_4);
    param_24 = _e7;
    let _e8 = (*b_4);
    param_25 = _e8;
    let _e9 = jumps((&param_24), (&param_25));
    phi_156_ = _e9;
    if _e9 {
        let _e10 = (*a_4);
        let _e11 = (_e10 > -0.5f);
        phi_155_ = _e11;
        if !(_e11) {
            let _e13 = (*a_4);
            param_26 = _e13;
            let _e14 = (*b_4);
            param_27 = _e14;
            let _e15 = is_torn((&param_26), (&param_27));
            phi_155_ = !(_e15);
        }
        let _e18 = phi_155_;
        phi_156_ = _e18;
    }
    let _e20 = phi_156_;
    return _e20;
}

fn walk(at_1: ptr<function, Search>, end: ptr<function, f32>, origin_1: ptr<function, f32>, row_6: ptr<function, i32>) {
    var limit: f32;
    var step_: i32;
    var here_1: i32;
    var param_28: i32;
    var param_29: i32;
    var param_30: f32;
    var param_31: f32;
    var fold: bool;
    var param_32: f32;
    var param_33: f32;
    var nearest: bool;
    var param_34: f32;
    var param_35: f32;
    var local_6: i32;
    var local_7: i32;
    var local_8: f32;
    var local_9: f32;
    var farther_1: bool;
    var param_36: f32;
    var param_37: f32;
    var local_10: i32;
    var local_11: f32;
    var local_12: f32;
    var phi_879_: bool;
    var phi_945_: bool;
    var phi_1003_: bool;

    let _e36 = (*end);
    let _e37 = (*origin_1);
    limit = ((_e36 - _e37) - 0.5f);
    let _e41 = synthesis.mirrored;
    step_ = select(1i, -1i, (_e41 != 0u));
    loop {
        let _e45 = (*at_1).shift;
        let _e46 = limit;
        let _e47 = (_e45 < _e46);
        phi_879_ = _e47;
        if _e47 {
            let _e49 = (*at_1).found;
            phi_879_ = !(_e49);
        }
        let _e52 = phi_879_;
        if _e52 {
            let _e54 = (*at_1).b;
            (*at_1).a = _e54;
            let _e57 = (*at_1).next;
            (*at_1).depth = _e57;
            let _e60 = (*at_1).column;
            here_1 = _e60;
            let _e61 = step_;
            let _e63 = (*at_1).column;
            (*at_1).column = (_e63 + _e61);
            let _e67 = (*at_1).shift;
            (*at_1).shift = (_e67 + 1f);
            let _e71 = (*at_1).column;
            param_28 = _e71;
            let _e72 = (*row_6);
            param_29 = _e72;
            let _e73 = depth_texel((&param_28), (&param_29));
            (*at_1).next = _e73;
            let _e76 = (*at_1).shift;
            let _e79 = synthesis.law[1u];
            let _e81 = (*at_1).next;
            (*at_1).b = (_e76 + (_e79 * _e81));
            let _e86 = (*at_1).a;
            param_30 = _e86;
            let _e88 = (*at_1).b;
            param_31 = _e88;
            let _e89 = is_seen((&param_30), (&param_31));
            (*at_1).found = _e89;
            let _e92 = (*at_1).a;
            param_32 = _e92;
            let _e94 = (*at_1).b;
            param_33 = _e94;
            let _e95 = folds((&param_32), (&param_33));
            fold = _e95;
            let _e97 = (*at_1).a;
            param_34 = _e97;
            let _e99 = (*at_1).b;
            param_35 = _e99;
            let _e100 = has_rim((&param_34), (&param_35));
            phi_945_ = _e100;
            if _e100 {
                let _e102 = (*at_1).rim;
                phi_945_ = (_e102 < 0i);
            }
            let _e105 = phi_945_;
            nearest = _e105;
            let _e106 = nearest;
            if _e106 {
                let _e107 = fold;
                if _e107 {
                    let _e108 = here_1;
                    local_7 = _e108;
                } else {
                    let _e110 = (*at_1).column;
                    local_7 = _e110;
                }
                let _e111 = local_7;
                local_6 = _e111;
            } else {
                let _e113 = (*at_1).rim;
                local_6 = _e113;
            }
            let _e114 = local_6;
            (*at_1).rim = _e114;
            let _e116 = nearest;
            if _e116 {
                let _e117 = fold;
                if _e117 {
                    let _e119 = (*at_1).depth;
                    local_9 = _e119;
                } else {
                    let _e121 = (*at_1).next;
                    local_9 = _e121;
                }
                let _e122 = local_9;
                local_8 = _e122;
            } else {
                let _e124 = (*at_1).rim_depth;
                local_8 = _e124;
            }
            let _e125 = local_8;
            (*at_1).rim_depth = _e125;
            let _e128 = (*at_1).a;
            param_36 = _e128;
            let _e130 = (*at_1).b;
            param_37 = _e130;
            let _e131 = jumps((&param_36), (&param_37));
            phi_1003_ = _e131;
            if _e131 {
                let _e134 = synthesis.law[1u];
                let _e136 = (*at_1).depth;
                let _e138 = (*at_1).edge_depth;
                phi_1003_ = ((_e134 * (_e136 - _e138)) < 0f);
            }
            let _e143 = phi_1003_;
            farther_1 = _e143;
            let _e144 = farther_1;
            if _e144 {
                let _e145 = here_1;
                local_10 = _e145;
            } else {
                let _e147 = (*at_1).edge;
                local_10 = _e147;
            }
            let _e148 = local_10;
            (*at_1).edge = _e148;
            let _e150 = farther_1;
            if _e150 {
                let _e152 = (*at_1).depth;
                local_11 = _e152;
            } else {
                let _e154 = (*at_1).edge_depth;
                local_11 = _e154;
            }
            let _e155 = local_11;
            (*at_1).edge_depth = _e155;
            let _e157 = farther_1;
            if _e157 {
                let _e160 = synthesis.law[1u];
                let _e162 = (*at_1).next;
                local_12 = (_e160 * _e162);
            } else {
                let _e165 = (*at_1).front;
                local_12 = _e165;
            }
            let _e166 = local_12;
            (*at_1).front = _e166;
            continue;
        } else {
            break;
        }
    }
    return;
}

fn march(origin_2: ptr<function, f32>, row_7: ptr<function, i32>, steps: ptr<function, f32>, x_6: ptr<function, f32>, b_5: ptr<function, f32>, next: ptr<function, f32>, surface: ptr<function, Surface>) -> vec4<f32> {
    var last_column: f32;
    var outside_1: bool;
    var end_1: f32;
    var local_13: f32;
    var column_3: i32;
    var param_38: i32;
    var edge_1: i32;
    var edge_depth: f32;
    var local_14: f32;
    var at_2: Search;
    var param_39: Search;
    var param_40: f32;
    var param_41: f32;
    var param_42: i32;
    var own: bool;
    var local_15: i32;
    var param_43: i32;
    var t: f32;
    var param_44: f32;
    var param_45: f32;
    var local_16: f32;
    var local_17: f32;
    var away_2: f32;
    var color_2: vec4<f32>;
    var param_46: f32;
    var param_47: i32;
    var unknown: bool;
    var i_3: i32;
    var param_48: vec2<f32>;
    var param_49: f32;
    var param_50: f32;
    var param_51: i32;
    var param_52: vec4<f32>;
    var param_53: f32;
    var param_54: bool;
    var param_55: vec4<f32>;
    var param_56: f32;
    var param_57: f32;
    var param_58: f32;
    var param_59: i32;
    var param_60: i32;
    var coverage: f32;
    var param_61: vec2<i32>;
    var phi_1130_: bool;
    var phi_1209_: bool;

    let _e66 = synthesis.source_size[0u];
    last_column = f32((_e66 - 1i));
    let _e69 = (*x_6);
    let _e70 = (*b_5);
    (*b_5) = (_e70 - _e69);
    let _e72 = (*x_6);
    let _e73 = last_column;
    (*x_6) = clamp(_e72, 0f, _e73);
    let _e75 = (*x_6);
    let _e76 = (*b_5);
    (*b_5) = (_e76 + _e75);
    let _e78 = (*x_6);
    let _e80 = (*b_5);
    outside_1 = ((_e78 == 0f) && (_e80 > 0f));
    let _e83 = outside_1;
    let _e84 = (*b_5);
    if (_e83 && (_e84 < 0.5f)) {
        let _e87 = (*x_6);
        local_13 = _e87;
    } else {
        let _e88 = (*x_6);
        let _e89 = (*steps);
        let _e91 = last_column;
        local_13 = min((_e88 + _e89), _e91);
    }
    let _e93 = local_13;
    end_1 = _e93;
    let _e94 = (*x_6);
    param_38 = i32(_e94);
    let _e96 = source_column((&param_38));
    column_3 = _e96;
    let _e97 = outside_1;
    let _e98 = column_3;
    edge_1 = select(-1i, _e98, _e97);
    let _e100 = outside_1;
    if _e100 {
        let _e101 = (*next);
        local_14 = _e101;
    } else {
        let _e104 = synthesis.law[1u];
        local_14 = select(1000000000f, -1000000000f, (_e104 < 0f));
    }
    let _e107 = local_14;
    edge_depth = _e107;
    let _e108 = column_3;
    let _e109 = (*x_6);
    let _e110 = (*origin_2);
    let _e112 = (*b_5);
    let _e113 = (*b_5);
    let _e114 = (*next);
    let _e115 = (*next);
    let _e116 = edge_1;
    let _e117 = edge_depth;
    at_2 = Search(_e108, (_e109 - _e110), _e112, _e113, _e114, _e115, false, _e116, _e117, 1000000000f, -1i, 0f);
    let _e119 = at_2;
    param_39 = _e119;
    let _e120 = end_1;
    param_40 = _e120;
    let _e121 = (*origin_2);
    param_41 = _e121;
    let _e122 = (*row_7);
    param_42 = _e122;
    walk((&param_39), (&param_40), (&param_41), (&param_42));
    let _e123 = param_39;
    at_2 = _e123;
    let _e125 = at_2.found;
    phi_1130_ = _e125;
    if !(_e125) {
        let _e128 = at_2.edge;
        phi_1130_ = (_e128 < 0i);
    }
    let _e131 = phi_1130_;
    own = _e131;
    let _e132 = own;
    if _e132 {
        let _e134 = at_2.column;
        local_15 = _e134;
    } else {
        let _e136 = at_2.edge;
        local_15 = _e136;
    }
    let _e137 = local_15;
    column_3 = _e137;
    let _e138 = column_3;
    param_43 = _e138;
    let _e139 = source_column((&param_43));
    (*x_6) = f32(_e139);
    let _e142 = at_2.a;
    param_44 = _e142;
    let _e144 = at_2.b;
    param_45 = _e144;
    let _e145 = is_torn((&param_44), (&param_45));
    if _e145 {
        local_16 = 0f;
    } else {
        let _e147 = at_2.a;
        let _e150 = at_2.b;
        let _e152 = at_2.a;
        local_16 = (-(_e147) / (_e150 - _e152));
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
    away_2 = ((_e176 - _e177) + (_e181 * _e183));
    let _e187 = at_2.found;
    let _e188 = !(_e187);
    phi_1209_ = _e188;
    if _e188 {
        let _e189 = away_2;
        phi_1209_ = (abs(_e189) >= 0.5f);
    }
    let _e193 = phi_1209_;
    (*surface).hole = _e193;
    let _e196 = (*surface).source;
    param_46 = _e196;
    let _e197 = (*row_7);
    param_47 = _e197;
    let _e198 = color_at((&param_46), (&param_47));
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
            param_48 = (_e206.xy - vec2<f32>(_e209));
            let _e213 = at_2.front;
            param_49 = _e213;
            let _e214 = (*origin_2);
            param_50 = _e214;
            let _e215 = (*row_7);
            param_51 = _e215;
            let _e216 = color_2;
            param_52 = _e216;
            let _e218 = (*surface).depth;
            param_53 = _e218;
            let _e219 = recall((&param_48), (&param_49), (&param_50), (&param_51), (&param_52), (&param_53));
            let _e220 = param_52;
            color_2 = _e220;
            let _e221 = param_53;
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
    param_54 = _e226;
    let _e227 = color_2;
    param_55 = _e227;
    let _e228 = away_2;
    param_56 = _e228;
    let _e229 = (*x_6);
    param_57 = _e229;
    let _e231 = (*surface).depth;
    param_58 = _e231;
    let _e232 = (*row_7);
    param_59 = _e232;
    let _e233 = fill_hole((&param_54), (&param_55), (&param_56), (&param_57), (&param_58), (&param_59));
    color_2 = _e233;
    let _e235 = at_2.rim;
    if (_e235 >= 0i) {
        let _e238 = at_2.rim;
        param_60 = _e238;
        let _e239 = source_column((&param_60));
        (*x_6) = f32(_e239);
        let _e241 = (*x_6);
        let _e242 = (*origin_2);
        let _e246 = synthesis.law[1u];
        let _e248 = at_2.rim_depth;
        coverage = (1f - abs(((_e241 - _e242) + (_e246 * _e248))));
        let _e253 = color_2;
        let _e255 = at_2.rim;
        let _e256 = (*row_7);
        param_61 = vec2<i32>(_e255, _e256);
        let _e258 = in_image((&param_61));
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
    var param_62: i32;
    var param_63: i32;
    var param_64: u32;
    var surface_1: Surface;
    var param_65: f32;
    var param_66: i32;
    var param_67: f32;
    var param_68: f32;
    var param_69: f32;
    var param_70: f32;
    var param_71: Surface;

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
    param_62 = i32(clamp(_e44, 0f, f32((_e47 - 1i))));
    let _e52 = row_8;
    param_63 = _e52;
    let _e53 = depth_at((&param_62), (&param_63));
    depth_2 = _e53;
    let _e55 = span_1[0u];
    param_64 = _e55;
    let _e56 = span_steps((&param_64));
    let _e57 = x_7;
    let _e58 = origin_3;
    let _e62 = synthesis.law[1u];
    let _e63 = depth_2;
    let _e66 = origin_3;
    param_65 = _e66;
    let _e67 = row_8;
    param_66 = _e67;
    param_67 = _e56;
    let _e68 = x_7;
    param_68 = _e68;
    param_69 = ((_e57 - _e58) + (_e62 * _e63));
    let _e69 = depth_2;
    param_70 = _e69;
    let _e70 = march((&param_65), (&param_66), (&param_67), (&param_68), (&param_69), (&param_70), (&param_71));
    let _e71 = param_71;
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
