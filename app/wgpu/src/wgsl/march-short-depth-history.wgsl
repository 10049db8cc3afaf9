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

struct History {
    to_history: array<mat4x4<f32>, 8>,
    history_strips: i32,
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
@group(0) @binding(10) 
var history_depth_texture: texture_2d<f32>;
@group(0) @binding(12) 
var<uniform> history: History;
@group(0) @binding(11) 
var history_color_texture: texture_2d<f32>;
@group(0) @binding(2) 
var tile_map_texture: texture_2d<u32>;
var<private> color_3: vec4<f32>;
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

fn in_image(pixel: ptr<function, vec2<i32>>) -> vec2<i32> {
    var local_3: vec2<i32>;

    if true {
        let _e5 = synthesis.source_origin;
        let _e6 = (*pixel);
        local_3 = (_e5 + _e6);
    } else {
        let _e8 = (*pixel);
        local_3 = _e8;
    }
    let _e9 = local_3;
    return _e9;
}

fn depth_texel(column: ptr<function, i32>, row_1: ptr<function, i32>) -> f32 {
    var param_11: vec2<i32>;

    let _e5 = (*column);
    let _e6 = (*row_1);
    param_11 = vec2<i32>(_e5, _e6);
    let _e8 = in_image((&param_11));
    let _e9 = textureLoad(depth_map_texture, _e8, 0i);
    return _e9.x;
}

fn depth_at(x_3: ptr<function, i32>, row_2: ptr<function, i32>) -> f32 {
    var param_12: i32;
    var param_13: i32;
    var param_14: i32;

    let _e5 = (*x_3);
    param_12 = _e5;
    let _e6 = source_column((&param_12));
    param_13 = _e6;
    let _e7 = (*row_2);
    param_14 = _e7;
    let _e8 = depth_texel((&param_13), (&param_14));
    return _e8;
}

fn nearness_at(x_4: ptr<function, i32>, row_3: ptr<function, i32>) -> f32 {
    var param_15: i32;
    var param_16: i32;

    let _e8 = synthesis.law[1u];
    let _e9 = (*x_4);
    param_15 = _e9;
    let _e10 = (*row_3);
    param_16 = _e10;
    let _e11 = depth_at((&param_15), (&param_16));
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
    var local_4: vec2<f32>;
    var inside: bool;
    var stored: f32;
    var along: vec4<f32>;
    var farther: f32;
    var place_2: vec2<f32>;
    var here: f32;
    var nearness: f32;
    var last: f32;
    var column_1: f32;
    var outside: bool;
    var x_5: i32;
    var before: f32;
    var param_17: i32;
    var param_18: i32;
    var param_19: i32;
    var param_20: i32;
    var same: bool;
    var behind: bool;
    var hidden: bool;
    var least: vec2<f32>;
    var most: vec2<f32>;
    var corner: vec2<i32>;
    var whole: bool;
    var i_2: i32;
    var texel: vec2<i32>;
    var local_5: vec2<f32>;
    var phi_572_: bool;
    var phi_587_: bool;
    var phi_717_: bool;
    var phi_795_: bool;

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
                local_4 = (_e107.xy / vec2(_e110));
            } else {
                let _e113 = guess;
                local_4 = _e113;
            }
            let _e114 = local_4;
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
    phi_572_ = _e119;
    if _e119 {
        let _e120 = guess;
        let _e121 = size;
        phi_572_ = all((_e120 < _e121));
    }
    let _e125 = phi_572_;
    inside = _e125;
    let _e127 = seen[3u];
    let _e129 = inside;
    let _e130 = ((_e127 > 0f) && _e129);
    phi_587_ = _e130;
    if _e130 {
        let _e132 = guess[1u];
        let _e133 = rows;
        let _e136 = strip;
        phi_587_ = (i32((_e132 / _e133)) == _e136);
    }
    let _e139 = phi_587_;
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
    place_2 = (_e170.xy / vec2(_e173));
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
    x_5 = i32(clamp(_e200, 0f, max((_e201 - 1f), 0f)));
    let _e206 = x_5;
    param_17 = _e206;
    let _e207 = (*row_4);
    param_18 = _e207;
    let _e208 = nearness_at((&param_17), (&param_18));
    let _e209 = x_5;
    let _e213 = synthesis.source_size[0u];
    param_19 = min((_e209 + 1i), (_e213 - 1i));
    let _e216 = (*row_4);
    param_20 = _e216;
    let _e217 = nearness_at((&param_19), (&param_20));
    before = max(_e208, _e217);
    let _e219 = place_2;
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
    phi_717_ = _e238;
    if !(_e238) {
        let _e240 = before;
        let _e241 = nearness;
        phi_717_ = (_e240 > (_e241 - 1f));
    }
    let _e245 = phi_717_;
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
    let _e271 = place_2;
    let _e272 = least;
    let _e273 = most;
    place_2 = clamp(_e271, _e272, _e273);
    let _e275 = place_2;
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
            phi_795_ = _e292;
            if _e292 {
                let _e295 = synthesis.law[1u];
                let _e296 = texel;
                let _e297 = textureLoad(history_depth_texture, _e296, 0i);
                let _e299 = stored;
                phi_795_ = (abs((_e295 * (_e297.x - _e299))) < 1f);
            }
            let _e305 = phi_795_;
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
        let _e309 = place_2;
        local_5 = _e309;
    } else {
        let _e310 = guess;
        local_5 = (floor(_e310) + vec2(0.5f));
    }
    let _e314 = local_5;
    let _e315 = size;
    let _e317 = textureSampleLevel(history_color_texture, linear_sampler, (_e314 / _e315), 0f);
    (*color_1) = _e317;
    let _e318 = here;
    (*depth_1) = _e318;
    return true;
}

fn depth_pair(x_6: ptr<function, f32>) -> vec2<f32> {
    var row_5: f32;
    var param_21: f32;
    var param_22: f32;
    var param_23: vec2<f32>;
    var param_24: f32;
    var param_25: vec2<f32>;
    var quad: vec4<f32>;
    var param_26: f32;
    var local_6: vec2<f32>;

    if true {
        param_21 = 0f;
        let _e20 = row_at((&param_21));
        row_5 = _e20;
        let _e21 = (*x_6);
        param_22 = _e21;
        let _e22 = column_at((&param_22));
        let _e23 = row_5;
        param_23 = vec2<f32>(_e22, _e23);
        let _e25 = depth_sample((&param_23));
        let _e26 = (*x_6);
        param_24 = (_e26 + 1f);
        let _e28 = column_at((&param_24));
        let _e29 = row_5;
        param_25 = vec2<f32>(_e28, _e29);
        let _e31 = depth_sample((&param_25));
        return vec2<f32>(_e25, _e31);
    }
    let _e35 = synthesis.columns[0u];
    let _e36 = (*x_6);
    let _e41 = synthesis.columns[1u];
    param_26 = 0.25f;
    let _e43 = row_at((&param_26));
    let _e45 = textureGather(0, depth_map_texture, nearest_sampler, vec2<f32>(((_e35 * (_e36 + 1.25f)) + _e41), _e43));
    quad = _e45;
    let _e47 = synthesis.mirrored;
    if (_e47 != 0u) {
        let _e49 = quad;
        local_6 = _e49.zw;
    } else {
        let _e51 = quad;
        local_6 = _e51.wz;
    }
    let _e53 = local_6;
    return _e53;
}

fn search_at(x_7: ptr<function, f32>, origin_1: ptr<function, f32>) -> Search {
    var depths_1: vec2<f32>;
    var param_27: f32;
    var shift: f32;

    let _e9 = (*x_7);
    param_27 = _e9;
    let _e10 = depth_pair((&param_27));
    depths_1 = _e10;
    let _e11 = (*x_7);
    let _e12 = (*origin_1);
    shift = (_e11 - _e12);
    let _e14 = (*x_7);
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

fn walk(at_1: ptr<function, Search>, end: ptr<function, f32>, origin_2: ptr<function, f32>) -> bool {
    var met: vec4<bool>;
    var x_8: f32;
    var last_1: f32;
    var depths_2: vec4<f32>;
    var param_28: f32;
    var param_29: f32;
    var places: vec4<f32>;
    var param_30: vec4<f32>;
    var param_31: vec4<f32>;
    var local_7: f32;
    var local_8: f32;
    var local_9: f32;
    var param_32: f32;
    var param_33: f32;
    var phi_1023_: bool;

    met = vec4<bool>(false, false, false, false);
    let _e30 = (*at_1).x;
    x_8 = (_e30 - 4f);
    let _e33 = (*at_1).a;
    last_1 = _e33;
    loop {
        let _e34 = x_8;
        let _e36 = (*end);
        let _e37 = ((_e34 + 4f) < _e36);
        phi_1023_ = _e37;
        if _e37 {
            let _e38 = met;
            phi_1023_ = !(any(_e38));
        }
        let _e42 = phi_1023_;
        if _e42 {
            let _e43 = x_8;
            x_8 = (_e43 + 4f);
            let _e45 = x_8;
            param_28 = (_e45 + 1f);
            let _e47 = depth_pair((&param_28));
            let _e48 = x_8;
            param_29 = (_e48 + 3f);
            let _e50 = depth_pair((&param_29));
            depths_2 = vec4<f32>(_e47.x, _e47.y, _e50.x, _e50.y);
            let _e58 = synthesis.law[1u];
            let _e59 = depths_2;
            let _e61 = x_8;
            let _e62 = (*origin_2);
            places = ((_e59 * _e58) + (vec4((_e61 - _e62)) + vec4<f32>(1f, 2f, 3f, 4f)));
            let _e67 = last_1;
            let _e68 = places;
            let _e69 = _e68.xyz;
            param_30 = vec4<f32>(_e67, _e69.x, _e69.y, _e69.z);
            let _e74 = places;
            param_31 = _e74;
            let _e75 = are_events((&param_30), (&param_31));
            met = _e75;
            let _e77 = places[3u];
            last_1 = _e77;
            continue;
        } else {
            break;
        }
    }
    let _e79 = met[0u];
    if _e79 {
        local_7 = 0f;
    } else {
        let _e81 = met[1u];
        if _e81 {
            local_8 = 1f;
        } else {
            let _e83 = met[2u];
            if _e83 {
                local_9 = 2f;
            } else {
                let _e85 = met[3u];
                local_9 = select(4f, 3f, _e85);
            }
            let _e87 = local_9;
            local_8 = _e87;
        }
        let _e88 = local_8;
        local_7 = _e88;
    }
    let _e89 = local_7;
    let _e90 = x_8;
    x_8 = (_e90 + _e89);
    let _e92 = x_8;
    let _e93 = (*end);
    param_32 = min(_e92, _e93);
    let _e95 = (*origin_2);
    param_33 = _e95;
    let _e96 = search_at((&param_32), (&param_33));
    (*at_1) = _e96;
    let _e97 = met;
    let _e99 = x_8;
    let _e100 = (*end);
    return (any(_e97) && (_e99 < _e100));
}

fn next_candidate(x_9: ptr<function, f32>, end_1: ptr<function, f32>, origin_3: ptr<function, f32>, row_6: ptr<function, i32>) -> f32 {
    var lands: bool;
    var moved: u32;
    var at_2: vec2<f32>;
    var phi_872_: bool;

    lands = false;
    loop {
        let _e19 = (*x_9);
        let _e21 = (*end_1);
        let _e23 = lands;
        if (((_e19 + 16f) < _e21) && !(_e23)) {
            let _e26 = (*x_9);
            let _e28 = (*row_6);
            let _e31 = textureLoad(tile_map_texture, (vec2<i32>(i32(_e26), _e28) / vec2<i32>(16i, 8i)), 0i);
            moved = _e31.x;
            let _e33 = (*x_9);
            let _e34 = (*origin_3);
            let _e36 = moved;
            let _e39 = moved;
            at_2 = (vec2((_e33 - _e34)) + (vec2<f32>(f32((_e36 & 65535u)), f32((_e39 >> bitcast<u32>(16i)))) / vec2(16f)));
            let _e49 = at_2[0u];
            let _e50 = (_e49 <= 1f);
            phi_872_ = _e50;
            if _e50 {
                let _e52 = at_2[1u];
                phi_872_ = ((_e52 + 16f) >= -1f);
            }
            let _e56 = phi_872_;
            lands = _e56;
            let _e57 = lands;
            let _e59 = (*x_9);
            (*x_9) = (_e59 + select(16f, 0f, _e57));
            continue;
        } else {
            break;
        }
    }
    let _e61 = (*x_9);
    return _e61;
}

fn is_event(a_1: ptr<function, f32>, b_1: ptr<function, f32>) -> bool {
    var phi_974_: bool;
    var phi_975_: bool;

    let _e4 = (*a_1);
    let _e5 = (_e4 <= 0f);
    phi_975_ = _e5;
    if _e5 {
        let _e6 = (*b_1);
        let _e7 = (_e6 > 0f);
        phi_974_ = _e7;
        if !(_e7) {
            let _e9 = (*b_1);
            let _e11 = (*a_1);
            phi_974_ = (max(_e9, -1f) < _e11);
        }
        let _e14 = phi_974_;
        phi_975_ = _e14;
    }
    let _e16 = phi_975_;
    return _e16;
}

fn march(at_3: ptr<function, Search>, end_2: ptr<function, f32>, origin_4: ptr<function, f32>, row_7: ptr<function, i32>, surface: ptr<function, Surface>) -> vec4<f32> {
    var edge_1: f32;
    var edge_depth: f32;
    var front_1: f32;
    var rim: f32;
    var rim_depth: f32;
    var param_34: f32;
    var param_35: f32;
    var stop: f32;
    var found: bool;
    var met_1: bool;
    var param_36: f32;
    var param_37: f32;
    var jump: bool;
    var torn: bool;
    var beside: bool;
    var nearest: bool;
    var local_10: f32;
    var local_11: f32;
    var local_12: f32;
    var farther_1: bool;
    var local_13: f32;
    var local_14: f32;
    var local_15: f32;
    var local_16: f32;
    var param_38: f32;
    var param_39: f32;
    var param_40: f32;
    var param_41: i32;
    var param_42: f32;
    var param_43: f32;
    var param_44: Search;
    var param_45: f32;
    var param_46: f32;
    var own: bool;
    var x_10: f32;
    var local_17: f32;
    var t: f32;
    var local_18: f32;
    var local_19: f32;
    var away_2: f32;
    var color_2: vec4<f32>;
    var param_47: f32;
    var param_48: f32;
    var param_49: vec2<f32>;
    var recalled: bool;
    var param_50: vec2<f32>;
    var param_51: f32;
    var param_52: f32;
    var param_53: i32;
    var param_54: vec4<f32>;
    var param_55: f32;
    var param_56: bool;
    var param_57: vec4<f32>;
    var param_58: f32;
    var param_59: f32;
    var param_60: f32;
    var param_61: i32;
    var coverage: f32;
    var param_62: f32;
    var param_63: f32;
    var param_64: vec2<f32>;
    var phi_1190_: bool;
    var phi_1203_: bool;
    var phi_1204_: bool;
    var phi_1251_: bool;
    var phi_1306_: bool;
    var phi_1343_: bool;
    var phi_1371_: bool;
    var phi_1421_: bool;
    var phi_1461_: bool;
    var phi_1466_: bool;

    edge_1 = -1f;
    let _e84 = synthesis.law[1u];
    edge_depth = select(1000000000f, -1000000000f, (_e84 < 0f));
    front_1 = 1000000000f;
    rim = -1f;
    rim_depth = 0f;
    let _e88 = (*at_3).x;
    if (_e88 <= 0f) {
        param_34 = 0f;
        let _e90 = (*origin_4);
        param_35 = _e90;
        let _e91 = search_at((&param_34), (&param_35));
        (*at_3) = _e91;
        let _e93 = (*at_3).a;
        if (_e93 > 0f) {
            edge_1 = 0f;
            let _e97 = (*at_3).depths[0u];
            edge_depth = _e97;
            let _e99 = (*at_3).a;
            let _e101 = (*end_2);
            (*end_2) = select(_e101, 0f, (_e99 < 0.5f));
        }
    }
    let _e104 = (*at_3).x;
    stop = ((floor((_e104 / 16f)) + 4f) * 16f);
    found = false;
    let _e110 = (*at_3).a;
    param_36 = _e110;
    let _e112 = (*at_3).b;
    param_37 = _e112;
    let _e113 = is_event((&param_36), (&param_37));
    met_1 = _e113;
    loop {
        let _e115 = (*at_3).x;
        let _e116 = (*end_2);
        let _e118 = found;
        if ((_e115 < _e116) && !(_e118)) {
            let _e121 = met_1;
            if (true && _e121) {
                let _e124 = (*at_3).b;
                jump = (_e124 > 0f);
                let _e127 = (*at_3).b;
                let _e129 = (*at_3).a;
                torn = ((_e127 - _e129) >= 2f);
                let _e132 = jump;
                phi_1190_ = _e132;
                if _e132 {
                    let _e134 = (*at_3).a;
                    let _e136 = torn;
                    phi_1190_ = ((_e134 > -0.5f) || !(_e136));
                }
                let _e140 = phi_1190_;
                found = _e140;
                let _e141 = jump;
                let _e142 = !(_e141);
                phi_1204_ = _e142;
                if !(_e142) {
                    let _e144 = torn;
                    phi_1203_ = _e144;
                    if _e144 {
                        let _e146 = (*at_3).b;
                        phi_1203_ = (_e146 < 1f);
                    }
                    let _e149 = phi_1203_;
                    phi_1204_ = _e149;
                }
                let _e151 = phi_1204_;
                beside = _e151;
                let _e152 = beside;
                let _e153 = rim;
                nearest = (_e152 && (_e153 < 0f));
                let _e156 = nearest;
                if _e156 {
                    let _e158 = (*at_3).x;
                    let _e159 = jump;
                    local_10 = (_e158 + select(0f, 1f, _e159));
                } else {
                    let _e162 = rim;
                    local_10 = _e162;
                }
                let _e163 = local_10;
                rim = _e163;
                let _e164 = nearest;
                if _e164 {
                    let _e165 = jump;
                    if _e165 {
                        let _e168 = (*at_3).depths[1u];
                        local_12 = _e168;
                    } else {
                        let _e171 = (*at_3).depths[0u];
                        local_12 = _e171;
                    }
                    let _e172 = local_12;
                    local_11 = _e172;
                } else {
                    let _e173 = rim_depth;
                    local_11 = _e173;
                }
                let _e174 = local_11;
                rim_depth = _e174;
                let _e175 = jump;
                phi_1251_ = _e175;
                if _e175 {
                    let _e178 = synthesis.law[1u];
                    let _e181 = (*at_3).depths[0u];
                    let _e182 = edge_depth;
                    phi_1251_ = ((_e178 * (_e181 - _e182)) < 0f);
                }
                let _e187 = phi_1251_;
                farther_1 = _e187;
                let _e188 = farther_1;
                if _e188 {
                    let _e191 = synthesis.law[1u];
                    let _e194 = (*at_3).depths[1u];
                    local_13 = (_e191 * _e194);
                } else {
                    let _e196 = front_1;
                    local_13 = _e196;
                }
                let _e197 = local_13;
                front_1 = _e197;
                let _e198 = farther_1;
                if _e198 {
                    let _e200 = (*at_3).x;
                    local_14 = _e200;
                } else {
                    let _e201 = edge_1;
                    local_14 = _e201;
                }
                let _e202 = local_14;
                edge_1 = _e202;
                let _e203 = farther_1;
                if _e203 {
                    let _e206 = (*at_3).depths[0u];
                    local_15 = _e206;
                } else {
                    let _e207 = edge_depth;
                    local_15 = _e207;
                }
                let _e208 = local_15;
                edge_depth = _e208;
                let _e209 = found;
                let _e212 = (*at_3).x;
                (*at_3).x = (_e212 + select(1f, 0f, _e209));
                let _e215 = found;
                if _e215 {
                    let _e217 = (*at_3).a;
                    local_16 = _e217;
                } else {
                    let _e219 = (*at_3).b;
                    local_16 = _e219;
                }
                let _e220 = local_16;
                (*at_3).a = _e220;
            } else {
                phi_1306_ = true;
                if true {
                    let _e223 = (*at_3).x;
                    let _e224 = stop;
                    phi_1306_ = (_e223 >= _e224);
                }
                let _e227 = phi_1306_;
                if _e227 {
                    let _e228 = (*origin_4);
                    let _e230 = synthesis.farthest;
                    let _e232 = stop;
                    param_38 = _e232;
                    let _e233 = (*end_2);
                    param_39 = _e233;
                    param_40 = (_e228 - _e230);
                    let _e234 = (*row_7);
                    param_41 = _e234;
                    let _e235 = next_candidate((&param_38), (&param_39), (&param_40), (&param_41));
                    param_42 = _e235;
                    let _e236 = (*origin_4);
                    param_43 = _e236;
                    let _e237 = search_at((&param_42), (&param_43));
                    (*at_3) = _e237;
                    let _e239 = (*at_3).x;
                    stop = (_e239 + 16f);
                }
            }
            let _e241 = found;
            let _e242 = !(_e241);
            phi_1343_ = _e242;
            if _e242 {
                let _e243 = stop;
                let _e244 = (*end_2);
                let _e246 = (*at_3);
                param_44 = _e246;
                param_45 = min(_e243, _e244);
                let _e247 = (*origin_4);
                param_46 = _e247;
                let _e248 = walk((&param_44), (&param_45), (&param_46));
                let _e249 = param_44;
                (*at_3) = _e249;
                phi_1343_ = _e248;
            }
            let _e251 = phi_1343_;
            met_1 = _e251;
            continue;
        } else {
            break;
        }
    }
    let _e252 = found;
    let _e253 = edge_1;
    own = (_e252 || (_e253 < 0f));
    let _e256 = own;
    if _e256 {
        let _e258 = (*at_3).x;
        let _e259 = (*end_2);
        local_17 = min(_e258, _e259);
    } else {
        let _e261 = edge_1;
        local_17 = _e261;
    }
    let _e262 = local_17;
    x_10 = _e262;
    let _e263 = found;
    phi_1371_ = _e263;
    if _e263 {
        let _e265 = (*at_3).b;
        let _e267 = (*at_3).a;
        phi_1371_ = ((_e265 - _e267) < 2f);
    }
    let _e271 = phi_1371_;
    if _e271 {
        let _e273 = (*at_3).a;
        let _e276 = (*at_3).b;
        let _e278 = (*at_3).a;
        local_18 = (-(_e273) / (_e276 - _e278));
    } else {
        local_18 = 0f;
    }
    let _e281 = local_18;
    t = _e281;
    let _e282 = x_10;
    let _e283 = t;
    (*surface).source = (_e282 + _e283);
    let _e286 = own;
    if _e286 {
        let _e289 = (*at_3).depths[0u];
        let _e292 = (*at_3).depths[1u];
        let _e293 = t;
        local_19 = mix(_e289, _e292, _e293);
    } else {
        let _e295 = edge_depth;
        local_19 = _e295;
    }
    let _e296 = local_19;
    (*surface).depth = _e296;
    let _e298 = x_10;
    let _e299 = (*origin_4);
    let _e303 = synthesis.law[1u];
    let _e305 = (*surface).depth;
    away_2 = ((_e298 - _e299) + (_e303 * _e305));
    let _e308 = found;
    let _e309 = !(_e308);
    phi_1421_ = _e309;
    if _e309 {
        let _e310 = away_2;
        phi_1421_ = (abs(_e310) >= 0.5f);
    }
    let _e314 = phi_1421_;
    (*surface).hole = _e314;
    let _e317 = (*surface).source;
    param_47 = _e317;
    let _e318 = column_at((&param_47));
    param_48 = 0f;
    let _e319 = row_at((&param_48));
    param_49 = vec2<f32>(_e318, _e319);
    let _e321 = color_sample((&param_49));
    color_2 = _e321;
    let _e323 = (*surface).hole;
    phi_1461_ = _e323;
    if _e323 {
        let _e324 = gl_FragCoord_1;
        let _e327 = synthesis.target_origin;
        param_50 = (_e324.xy - vec2<f32>(_e327));
        let _e330 = front_1;
        param_51 = _e330;
        let _e331 = (*origin_4);
        param_52 = _e331;
        let _e332 = (*row_7);
        param_53 = _e332;
        let _e333 = color_2;
        param_54 = _e333;
        let _e335 = (*surface).depth;
        param_55 = _e335;
        let _e336 = recall((&param_50), (&param_51), (&param_52), (&param_53), (&param_54), (&param_55));
        let _e337 = param_54;
        color_2 = _e337;
        let _e338 = param_55;
        (*surface).depth = _e338;
        phi_1461_ = _e336;
    }
    let _e341 = phi_1461_;
    recalled = _e341;
    phi_1466_ = true;
    if true {
        let _e343 = (*surface).hole;
        phi_1466_ = _e343;
    }
    let _e345 = phi_1466_;
    let _e346 = recalled;
    if (_e345 && !(_e346)) {
        param_56 = true;
        let _e349 = color_2;
        param_57 = _e349;
        let _e350 = away_2;
        param_58 = _e350;
        let _e351 = x_10;
        param_59 = _e351;
        let _e353 = (*surface).depth;
        param_60 = _e353;
        let _e354 = (*row_7);
        param_61 = _e354;
        let _e355 = fill_hole((&param_56), (&param_57), (&param_58), (&param_59), (&param_60), (&param_61));
        color_2 = _e355;
    }
    let _e356 = rim;
    if (_e356 >= 0f) {
        let _e358 = rim;
        let _e359 = (*origin_4);
        let _e363 = synthesis.law[1u];
        let _e364 = rim_depth;
        coverage = (1f - abs(((_e358 - _e359) + (_e363 * _e364))));
        let _e369 = color_2;
        let _e370 = rim;
        param_62 = _e370;
        let _e371 = column_at((&param_62));
        param_63 = 0f;
        let _e372 = row_at((&param_63));
        param_64 = vec2<f32>(_e371, _e372);
        let _e374 = color_sample((&param_64));
        let _e375 = coverage;
        color_2 = mix(_e369, _e374, vec4(_e375));
        let _e378 = coverage;
        if (_e378 >= 0.5f) {
            let _e380 = rim;
            let _e381 = rim_depth;
            (*surface) = Surface(_e380, _e381, false);
        }
    }
    let _e383 = color_2;
    return _e383;
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
    var origin_5: f32;
    var at_4: Search;
    var param_65: f32;
    var param_66: f32;
    var end_3: f32;
    var param_67: u32;
    var limit: f32;
    var next: f32;
    var param_68: f32;
    var param_69: f32;
    var param_70: vec2<f32>;
    var stretch: f32;
    var t_1: f32;
    var seen_1: vec4<f32>;
    var param_71: f32;
    var param_72: f32;
    var param_73: vec2<f32>;
    var middle: f32;
    var done: bool;
    var param_74: Search;
    var param_75: f32;
    var param_76: f32;
    var param_77: i32;
    var param_78: Surface;
    var phi_1644_: bool;
    var phi_1653_: bool;
    var phi_1736_: bool;
    var phi_1749_: bool;

    let _e41 = synthesis.origins[0u];
    let _e43 = gl_FragCoord_1[0u];
    let _e47 = synthesis.origins[1u];
    origin_5 = ((_e41 * _e43) + _e47);
    let _e49 = origin_5;
    let _e51 = synthesis.farthest;
    let _e53 = (*span_1);
    param_65 = floor(((_e49 - _e51) - bitcast<f32>(_e53)));
    let _e57 = origin_5;
    param_66 = _e57;
    let _e58 = search_at((&param_65), (&param_66));
    at_4 = _e58;
    let _e60 = at_4.x;
    let _e62 = (*span_1);
    param_67 = _e62;
    let _e63 = span_steps((&param_67));
    let _e67 = synthesis.source_size[0u];
    end_3 = min((max(_e60, 0f) + _e63), f32((_e67 - 1i)));
    let _e72 = at_4.x;
    let _e74 = end_3;
    limit = min((_e72 + 4f), _e74);
    loop {
        let _e77 = at_4.x;
        let _e78 = limit;
        let _e79 = (_e77 < _e78);
        phi_1644_ = _e79;
        if _e79 {
            let _e81 = at_4.b;
            phi_1644_ = (_e81 <= 0f);
        }
        let _e84 = phi_1644_;
        phi_1653_ = _e84;
        if _e84 {
            let _e86 = at_4.b;
            let _e89 = at_4.a;
            phi_1653_ = (max(_e86, -1f) >= _e89);
        }
        let _e92 = phi_1653_;
        if _e92 {
            let _e94 = at_4.x;
            param_68 = (_e94 + 2f);
            let _e96 = column_at((&param_68));
            param_69 = 0f;
            let _e97 = row_at((&param_69));
            param_70 = vec2<f32>(_e96, _e97);
            let _e99 = depth_sample((&param_70));
            next = _e99;
            let _e102 = at_4.depths[1u];
            let _e103 = next;
            at_4.depths = vec2<f32>(_e102, _e103);
            let _e107 = at_4.b;
            at_4.a = _e107;
            let _e110 = at_4.x;
            let _e112 = origin_5;
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
    param_71 = _e149;
    let _e150 = column_at((&param_71));
    param_72 = 0f;
    let _e151 = row_at((&param_72));
    param_73 = vec2<f32>(_e150, _e151);
    let _e153 = color_sample((&param_73));
    seen_1 = _e153;
    let _e156 = synthesis.source_size[0u];
    middle = (0.5f * f32((_e156 - 1i)));
    let _e161 = at_4.a;
    let _e162 = (_e161 <= 0f);
    phi_1736_ = _e162;
    if _e162 {
        let _e164 = at_4.b;
        phi_1736_ = (_e164 > 0f);
    }
    let _e167 = phi_1736_;
    let _e168 = stretch;
    let _e170 = (_e167 && (_e168 < 2f));
    phi_1749_ = _e170;
    if _e170 {
        let _e172 = (*surface_1).source;
        let _e173 = middle;
        let _e176 = middle;
        phi_1749_ = (abs((_e172 - _e173)) <= _e176);
    }
    let _e179 = phi_1749_;
    done = _e179;
    let _e180 = done;
    if (true && !(_e180)) {
        let _e183 = source_row();
        let _e184 = at_4;
        param_74 = _e184;
        let _e185 = end_3;
        param_75 = _e185;
        let _e186 = origin_5;
        param_76 = _e186;
        param_77 = _e183;
        let _e187 = march((&param_74), (&param_75), (&param_76), (&param_77), (&param_78));
        let _e188 = param_78;
        (*surface_1) = _e188;
        seen_1 = _e187;
    }
    let _e189 = seen_1;
    return _e189;
}

fn lawful(affine: ptr<function, vec3<f32>>, surface_2: ptr<function, Surface>) -> vec4<f32> {
    var place_3: f32;
    var depths_3: vec2<f32>;
    var param_79: f32;
    var param_80: f32;
    var param_81: vec2<f32>;

    let _e17 = (*affine)[0u];
    let _e19 = (*affine)[1u];
    let _e21 = gl_FragCoord_1[0u];
    let _e25 = (*affine)[2u];
    let _e27 = gl_FragCoord_1[1u];
    place_3 = ((_e17 + (_e19 * _e21)) + (_e25 * _e27));
    let _e30 = place_3;
    let _e33 = synthesis.columns[1u];
    let _e37 = synthesis.columns[0u];
    let _e42 = synthesis.source_size[0u];
    (*surface_2).source = clamp((((_e30 - _e33) / _e37) - 0.5f), 0f, f32((_e42 - 1i)));
    let _e48 = (*surface_2).source;
    param_79 = floor(_e48);
    let _e50 = depth_pair((&param_79));
    depths_3 = _e50;
    let _e52 = depths_3[0u];
    let _e54 = depths_3[1u];
    let _e56 = (*surface_2).source;
    (*surface_2).depth = mix(_e52, _e54, fract(_e56));
    (*surface_2).hole = false;
    let _e61 = place_3;
    param_80 = 0f;
    let _e62 = row_at((&param_80));
    param_81 = vec2<f32>(_e61, _e62);
    let _e64 = color_sample((&param_81));
    return _e64;
}

fn pixel_span() -> vec4<u32> {
    var last_2: vec2<i32>;

    if true {
        let _e14 = synthesis.target_size[0u];
        let _e17 = synthesis.source_size[1u];
        last_2 = ((vec2<i32>(_e14, _e17) - vec2(1i)) / vec2<i32>(16i, 8i));
        let _e22 = span_at_1;
        let _e24 = last_2;
        let _e26 = textureLoad(span_map_texture, clamp(vec2<i32>(_e22), vec2<i32>(0i, 0i), _e24), 0i);
        return _e26;
    }
    return vec4<u32>(0u, 0u, 0u, 0u);
}

fn main_1() {
    var span_2: vec4<u32>;
    var surface_3: Surface;
    var param_82: vec3<f32>;
    var param_83: Surface;
    var param_84: u32;
    var param_85: Surface;
    var phi_1777_: bool;

    let _e11 = pixel_span();
    span_2 = _e11;
    phi_1777_ = true;
    if true {
        let _e13 = span_2[1u];
        phi_1777_ = (_e13 != 0u);
    }
    let _e16 = phi_1777_;
    if _e16 {
        let _e17 = span_2;
        param_82 = bitcast<vec3<f32>>(_e17.xyz);
        let _e20 = lawful((&param_82), (&param_83));
        let _e21 = param_83;
        surface_3 = _e21;
        color_3 = _e20;
    } else {
        if true {
            let _e23 = span_2[0u];
            param_84 = _e23;
            let _e24 = searched((&param_84), (&param_85));
            let _e25 = param_85;
            surface_3 = _e25;
            color_3 = _e24;
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
    let _e6 = color_3;
    let _e7 = gl_FragDepth;
    return FragmentOutput(_e6, _e7);
}
