// Made of yoro's GLSL by `cargo tools wgsl`.
struct Search {
    x: f32,
    depths: vec2<f32>,
    a: f32,
    b: f32,
}

struct Beside {
    edge: f32,
    edge_depth: f32,
    front: f32,
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

struct History {
    to_history: array<mat4x4<f32>, 8>,
    history_strips: i32,
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
    var param_12: vec2<i32>;

    let _e5 = (*column);
    let _e6 = (*row_1);
    param_12 = vec2<i32>(_e5, _e6);
    let _e8 = in_image((&param_12));
    let _e9 = textureLoad(depth_map_texture, _e8, 0i);
    return _e9.x;
}

fn depth_at(x_3: ptr<function, i32>, row_2: ptr<function, i32>) -> f32 {
    var param_13: i32;
    var param_14: i32;
    var param_15: i32;

    let _e5 = (*x_3);
    param_13 = _e5;
    let _e6 = source_column((&param_13));
    param_14 = _e6;
    let _e7 = (*row_2);
    param_15 = _e7;
    let _e8 = depth_texel((&param_14), (&param_15));
    return _e8;
}

fn nearness_at(x_4: ptr<function, i32>, row_3: ptr<function, i32>) -> f32 {
    var param_16: i32;
    var param_17: i32;

    let _e8 = synthesis.law[1u];
    let _e9 = (*x_4);
    param_16 = _e9;
    let _e10 = (*row_3);
    param_17 = _e10;
    let _e11 = depth_at((&param_16), (&param_17));
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
    var param_18: i32;
    var param_19: i32;
    var param_20: i32;
    var param_21: i32;
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
    var phi_575_: bool;
    var phi_590_: bool;
    var phi_720_: bool;
    var phi_798_: bool;

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
    phi_575_ = _e119;
    if _e119 {
        let _e120 = guess;
        let _e121 = size;
        phi_575_ = all((_e120 < _e121));
    }
    let _e125 = phi_575_;
    inside = _e125;
    let _e127 = seen[3u];
    let _e129 = inside;
    let _e130 = ((_e127 > 0f) && _e129);
    phi_590_ = _e130;
    if _e130 {
        let _e132 = guess[1u];
        let _e133 = rows;
        let _e136 = strip;
        phi_590_ = (i32((_e132 / _e133)) == _e136);
    }
    let _e139 = phi_590_;
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
    param_18 = _e206;
    let _e207 = (*row_4);
    param_19 = _e207;
    let _e208 = nearness_at((&param_18), (&param_19));
    let _e209 = x_5;
    let _e213 = synthesis.source_size[0u];
    param_20 = min((_e209 + 1i), (_e213 - 1i));
    let _e216 = (*row_4);
    param_21 = _e216;
    let _e217 = nearness_at((&param_20), (&param_21));
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
    phi_720_ = _e238;
    if !(_e238) {
        let _e240 = before;
        let _e241 = nearness;
        phi_720_ = (_e240 > (_e241 - 1f));
    }
    let _e245 = phi_720_;
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
            phi_798_ = _e292;
            if _e292 {
                let _e295 = synthesis.law[1u];
                let _e296 = texel;
                let _e297 = textureLoad(history_depth_texture, _e296, 0i);
                let _e299 = stored;
                phi_798_ = (abs((_e295 * (_e297.x - _e299))) < 1f);
            }
            let _e305 = phi_798_;
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
    var param_22: f32;
    var param_23: f32;
    var param_24: vec2<f32>;
    var param_25: f32;
    var param_26: vec2<f32>;
    var quad: vec4<f32>;
    var param_27: f32;
    var local_6: vec2<f32>;

    if true {
        param_22 = 0f;
        let _e20 = row_at((&param_22));
        row_5 = _e20;
        let _e21 = (*x_6);
        param_23 = _e21;
        let _e22 = column_at((&param_23));
        let _e23 = row_5;
        param_24 = vec2<f32>(_e22, _e23);
        let _e25 = depth_sample((&param_24));
        let _e26 = (*x_6);
        param_25 = (_e26 + 1f);
        let _e28 = column_at((&param_25));
        let _e29 = row_5;
        param_26 = vec2<f32>(_e28, _e29);
        let _e31 = depth_sample((&param_26));
        return vec2<f32>(_e25, _e31);
    }
    let _e35 = synthesis.columns[0u];
    let _e36 = (*x_6);
    let _e41 = synthesis.columns[1u];
    param_27 = 0.25f;
    let _e43 = row_at((&param_27));
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
    var param_28: f32;
    var shift: f32;

    let _e9 = (*x_7);
    param_28 = _e9;
    let _e10 = depth_pair((&param_28));
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

fn segment_end(x_8: ptr<function, f32>, tile_row: ptr<function, i32>, below_1: ptr<function, bool>, shift_1: ptr<function, u32>) -> f32 {
    var column_2: u32;
    var within: u32;
    var tile: vec4<u32>;
    var marks: u32;
    var local_7: u32;

    let _e18 = (*x_8);
    column_2 = u32(_e18);
    let _e20 = column_2;
    within = (_e20 % 16u);
    let _e22 = column_2;
    let _e25 = (*tile_row);
    let _e27 = textureLoad(tile_map_texture, vec2<i32>(bitcast<i32>((_e22 / 16u)), _e25), 0i);
    tile = _e27;
    let _e28 = (*below_1);
    if _e28 {
        let _e30 = tile[1u];
        local_7 = _e30;
    } else {
        let _e32 = tile[3u];
        local_7 = _e32;
    }
    let _e33 = local_7;
    let _e34 = (*shift_1);
    let _e35 = within;
    marks = (_e33 >> bitcast<u32>((_e34 + _e35)));
    let _e40 = tile[2u];
    let _e43 = marks;
    marks = select(0u, _e43, (_e40 == bitcast<u32>(9f)));
    let _e45 = (*x_8);
    let _e46 = marks;
    let _e47 = within;
    return (_e45 + f32(firstTrailingBit((_e46 | (65536u >> bitcast<u32>(_e47))))));
}

fn meet(beside: ptr<function, Beside>, at_1: ptr<function, Search>) -> bool {
    var jump: bool;
    var torn: bool;
    var rim: bool;
    var local_8: f32;
    var local_9: f32;
    var local_10: f32;
    var farther_1: bool;
    var local_11: f32;
    var local_12: f32;
    var local_13: f32;
    var phi_1002_: bool;
    var phi_1003_: bool;
    var phi_1004_: bool;
    var phi_1051_: bool;
    var phi_1098_: bool;

    let _e20 = (*at_1).b;
    jump = (_e20 > 0f);
    let _e23 = (*at_1).b;
    let _e25 = (*at_1).a;
    torn = ((_e23 - _e25) >= 2f);
    let _e29 = (*beside).rim;
    let _e30 = (_e29 < 0f);
    phi_1004_ = _e30;
    if _e30 {
        let _e31 = jump;
        let _e32 = !(_e31);
        phi_1003_ = _e32;
        if !(_e32) {
            let _e34 = torn;
            phi_1002_ = _e34;
            if _e34 {
                let _e36 = (*at_1).b;
                phi_1002_ = (_e36 < 1f);
            }
            let _e39 = phi_1002_;
            phi_1003_ = _e39;
        }
        let _e41 = phi_1003_;
        phi_1004_ = _e41;
    }
    let _e43 = phi_1004_;
    rim = _e43;
    let _e44 = rim;
    if _e44 {
        let _e46 = (*at_1).x;
        let _e47 = jump;
        local_8 = (_e46 + select(0f, 1f, _e47));
    } else {
        let _e51 = (*beside).rim;
        local_8 = _e51;
    }
    let _e52 = local_8;
    (*beside).rim = _e52;
    let _e54 = rim;
    if _e54 {
        let _e55 = jump;
        if _e55 {
            let _e58 = (*at_1).depths[1u];
            local_10 = _e58;
        } else {
            let _e61 = (*at_1).depths[0u];
            local_10 = _e61;
        }
        let _e62 = local_10;
        local_9 = _e62;
    } else {
        let _e64 = (*beside).rim_depth;
        local_9 = _e64;
    }
    let _e65 = local_9;
    (*beside).rim_depth = _e65;
    let _e67 = jump;
    phi_1051_ = _e67;
    if _e67 {
        let _e70 = synthesis.law[1u];
        let _e73 = (*at_1).depths[0u];
        let _e75 = (*beside).edge_depth;
        phi_1051_ = ((_e70 * (_e73 - _e75)) < 0f);
    }
    let _e80 = phi_1051_;
    farther_1 = _e80;
    let _e81 = farther_1;
    if _e81 {
        let _e84 = synthesis.law[1u];
        let _e87 = (*at_1).depths[1u];
        local_11 = (_e84 * _e87);
    } else {
        let _e90 = (*beside).front;
        local_11 = _e90;
    }
    let _e91 = local_11;
    (*beside).front = _e91;
    let _e93 = farther_1;
    if _e93 {
        let _e95 = (*at_1).x;
        local_12 = _e95;
    } else {
        let _e97 = (*beside).edge;
        local_12 = _e97;
    }
    let _e98 = local_12;
    (*beside).edge = _e98;
    let _e100 = farther_1;
    if _e100 {
        let _e103 = (*at_1).depths[0u];
        local_13 = _e103;
    } else {
        let _e105 = (*beside).edge_depth;
        local_13 = _e105;
    }
    let _e106 = local_13;
    (*beside).edge_depth = _e106;
    let _e108 = jump;
    phi_1098_ = _e108;
    if _e108 {
        let _e110 = (*at_1).a;
        let _e112 = torn;
        phi_1098_ = ((_e110 > -0.5f) || !(_e112));
    }
    let _e116 = phi_1098_;
    return _e116;
}

fn is_event(a: ptr<function, f32>, b: ptr<function, f32>) -> bool {
    var phi_917_: bool;
    var phi_918_: bool;

    let _e4 = (*a);
    let _e5 = (_e4 <= 0f);
    phi_918_ = _e5;
    if _e5 {
        let _e6 = (*b);
        let _e7 = (_e6 > 0f);
        phi_917_ = _e7;
        if !(_e7) {
            let _e9 = (*b);
            let _e11 = (*a);
            phi_917_ = (max(_e9, -1f) < _e11);
        }
        let _e14 = phi_917_;
        phi_918_ = _e14;
    }
    let _e16 = phi_918_;
    return _e16;
}

fn march(at_2: ptr<function, Search>, end: ptr<function, f32>, origin_2: ptr<function, f32>, row_6: ptr<function, i32>, surface: ptr<function, Surface>) -> vec4<f32> {
    var border: f32;
    var outside_1: bool;
    var beside_1: Beside;
    var local_14: f32;
    var found: bool;
    var param_29: f32;
    var param_30: f32;
    var param_31: Beside;
    var param_32: Search;
    var x_9: f32;
    var a_1: f32;
    var tile_row_1: i32;
    var below_2: bool;
    var shift_2: u32;
    var crosses: bool;
    var param_33: f32;
    var param_34: i32;
    var param_35: bool;
    var param_36: u32;
    var param_37: f32;
    var param_38: f32;
    var param_39: f32;
    var param_40: f32;
    var param_41: Beside;
    var param_42: Search;
    var local_15: f32;
    var local_16: f32;
    var last_1: f32;
    var b_1: f32;
    var param_43: f32;
    var param_44: f32;
    var behind_1: bool;
    var local_17: f32;
    var local_18: f32;
    var local_19: f32;
    var local_20: f32;
    var own: bool;
    var local_21: f32;
    var t: f32;
    var local_22: f32;
    var local_23: f32;
    var away_3: f32;
    var color_2: vec4<f32>;
    var param_45: f32;
    var param_46: f32;
    var param_47: vec2<f32>;
    var recalled: bool;
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
    var coverage: f32;
    var param_60: f32;
    var param_61: f32;
    var param_62: vec2<f32>;
    var phi_1147_: bool;
    var phi_1154_: bool;
    var phi_1164_: bool;
    var phi_1233_: bool;
    var phi_1244_: bool;
    var phi_1254_: bool;
    var phi_1328_: bool;
    var phi_1378_: bool;
    var phi_1401_: bool;
    var phi_1452_: bool;
    var phi_1493_: bool;
    var phi_1498_: bool;

    let _e87 = (*at_2).a;
    let _e89 = (*at_2).x;
    border = (_e87 - _e89);
    let _e92 = (*at_2).x;
    let _e94 = border;
    outside_1 = ((_e92 <= 0f) && (_e94 > 0f));
    let _e97 = outside_1;
    let _e98 = border;
    let _e101 = (*end);
    (*end) = select(_e101, 0f, (_e97 && (_e98 < 0.5f)));
    let _e103 = outside_1;
    beside_1.edge = select(-1f, 0f, _e103);
    let _e106 = outside_1;
    if _e106 {
        let _e109 = (*at_2).depths[0u];
        local_14 = _e109;
    } else {
        let _e112 = synthesis.law[1u];
        local_14 = select(1000000000f, -1000000000f, (_e112 < 0f));
    }
    let _e115 = local_14;
    beside_1.edge_depth = _e115;
    beside_1.front = 1000000000f;
    beside_1.rim = -1f;
    beside_1.rim_depth = 0f;
    found = false;
    phi_1147_ = true;
    if true {
        let _e121 = (*at_2).x;
        phi_1147_ = (_e121 >= 0f);
    }
    let _e124 = phi_1147_;
    phi_1154_ = _e124;
    if _e124 {
        let _e126 = (*at_2).x;
        let _e127 = (*end);
        phi_1154_ = (_e126 < _e127);
    }
    let _e130 = phi_1154_;
    phi_1164_ = _e130;
    if _e130 {
        let _e132 = (*at_2).a;
        param_29 = _e132;
        let _e134 = (*at_2).b;
        param_30 = _e134;
        let _e135 = is_event((&param_29), (&param_30));
        phi_1164_ = _e135;
    }
    let _e137 = phi_1164_;
    if _e137 {
        let _e138 = beside_1;
        param_31 = _e138;
        let _e139 = (*at_2);
        param_32 = _e139;
        let _e140 = meet((&param_31), (&param_32));
        let _e141 = param_31;
        beside_1 = _e141;
        found = _e140;
    }
    let _e143 = (*at_2).x;
    x_9 = max((_e143 + 1f), 0f);
    let _e147 = (*at_2).b;
    let _e148 = x_9;
    let _e150 = (*at_2).x;
    a_1 = (_e147 + ((_e148 - _e150) - 1f));
    let _e154 = (*row_6);
    tile_row_1 = (_e154 / 8i);
    let _e156 = (*row_6);
    below_2 = ((_e156 & 4i) == 0i);
    let _e159 = (*row_6);
    shift_2 = (bitcast<u32>((_e159 & 2i)) << bitcast<u32>(3i));
    crosses = false;
    loop {
        let _e164 = x_9;
        let _e165 = (*end);
        let _e167 = found;
        if ((_e164 <= _e165) && !(_e167)) {
            let _e170 = x_9;
            param_33 = _e170;
            let _e171 = tile_row_1;
            param_34 = _e171;
            let _e172 = below_2;
            param_35 = _e172;
            let _e173 = shift_2;
            param_36 = _e173;
            let _e174 = segment_end((&param_33), (&param_34), (&param_35), (&param_36));
            let _e175 = (*end);
            param_37 = min(_e174, _e175);
            let _e177 = (*origin_2);
            param_38 = _e177;
            let _e178 = search_at((&param_37), (&param_38));
            (*at_2) = _e178;
            let _e179 = a_1;
            let _e180 = (_e179 <= 0f);
            phi_1233_ = _e180;
            if _e180 {
                let _e182 = (*at_2).a;
                phi_1233_ = (_e182 > 0f);
            }
            let _e185 = phi_1233_;
            crosses = _e185;
            let _e186 = crosses;
            found = _e186;
            let _e187 = crosses;
            let _e189 = (true && !(_e187));
            phi_1244_ = _e189;
            if _e189 {
                let _e191 = (*at_2).x;
                let _e192 = (*end);
                phi_1244_ = (_e191 < _e192);
            }
            let _e195 = phi_1244_;
            phi_1254_ = _e195;
            if _e195 {
                let _e197 = (*at_2).a;
                param_39 = _e197;
                let _e199 = (*at_2).b;
                param_40 = _e199;
                let _e200 = is_event((&param_39), (&param_40));
                phi_1254_ = _e200;
            }
            let _e202 = phi_1254_;
            if _e202 {
                let _e203 = beside_1;
                param_41 = _e203;
                let _e204 = (*at_2);
                param_42 = _e204;
                let _e205 = meet((&param_41), (&param_42));
                let _e206 = param_41;
                beside_1 = _e206;
                found = _e205;
            }
            let _e207 = found;
            if _e207 {
                let _e208 = x_9;
                local_15 = _e208;
            } else {
                let _e210 = (*at_2).x;
                local_15 = (_e210 + 1f);
            }
            let _e212 = local_15;
            x_9 = _e212;
            let _e213 = found;
            if _e213 {
                let _e214 = a_1;
                local_16 = _e214;
            } else {
                let _e216 = (*at_2).b;
                local_16 = _e216;
            }
            let _e217 = local_16;
            a_1 = _e217;
            continue;
        } else {
            break;
        }
    }
    let _e219 = (*at_2).x;
    last_1 = _e219;
    let _e221 = (*at_2).a;
    b_1 = _e221;
    loop {
        let _e222 = crosses;
        let _e224 = x_9;
        let _e225 = last_1;
        if ((true && _e222) && (_e224 < _e225)) {
            let _e228 = x_9;
            let _e229 = last_1;
            let _e230 = x_9;
            let _e232 = a_1;
            let _e234 = a_1;
            let _e235 = b_1;
            let _e240 = x_9;
            let _e241 = last_1;
            param_43 = clamp(floor((_e228 + (((_e229 - _e230) * _e232) / (_e234 - _e235)))), _e240, (_e241 - 1f));
            let _e244 = (*origin_2);
            param_44 = _e244;
            let _e245 = search_at((&param_43), (&param_44));
            (*at_2) = _e245;
            let _e247 = (*at_2).a;
            let _e248 = (_e247 > 0f);
            phi_1328_ = _e248;
            if !(_e248) {
                let _e251 = (*at_2).b;
                phi_1328_ = (_e251 <= 0f);
            }
            let _e254 = phi_1328_;
            crosses = _e254;
            let _e256 = (*at_2).a;
            behind_1 = (_e256 > 0f);
            let _e258 = behind_1;
            if _e258 {
                let _e259 = x_9;
                local_17 = _e259;
            } else {
                let _e261 = (*at_2).x;
                local_17 = (_e261 + 1f);
            }
            let _e263 = local_17;
            x_9 = _e263;
            let _e264 = behind_1;
            if _e264 {
                let _e265 = a_1;
                local_18 = _e265;
            } else {
                let _e267 = (*at_2).b;
                local_18 = _e267;
            }
            let _e268 = local_18;
            a_1 = _e268;
            let _e269 = behind_1;
            if _e269 {
                let _e271 = (*at_2).x;
                local_19 = _e271;
            } else {
                let _e272 = last_1;
                local_19 = _e272;
            }
            let _e273 = local_19;
            last_1 = _e273;
            let _e274 = behind_1;
            if _e274 {
                let _e276 = (*at_2).a;
                local_20 = _e276;
            } else {
                let _e277 = b_1;
                local_20 = _e277;
            }
            let _e278 = local_20;
            b_1 = _e278;
            continue;
        } else {
            break;
        }
    }
    let _e279 = found;
    phi_1378_ = _e279;
    if !(_e279) {
        let _e282 = beside_1.edge;
        phi_1378_ = (_e282 < 0f);
    }
    let _e285 = phi_1378_;
    own = _e285;
    let _e286 = own;
    if _e286 {
        let _e288 = (*at_2).x;
        let _e289 = (*end);
        local_21 = min(_e288, _e289);
    } else {
        let _e292 = beside_1.edge;
        local_21 = _e292;
    }
    let _e293 = local_21;
    x_9 = _e293;
    let _e294 = found;
    phi_1401_ = _e294;
    if _e294 {
        let _e296 = (*at_2).b;
        let _e298 = (*at_2).a;
        phi_1401_ = ((_e296 - _e298) < 2f);
    }
    let _e302 = phi_1401_;
    if _e302 {
        let _e304 = (*at_2).a;
        let _e307 = (*at_2).b;
        let _e309 = (*at_2).a;
        local_22 = (-(_e304) / (_e307 - _e309));
    } else {
        local_22 = 0f;
    }
    let _e312 = local_22;
    t = _e312;
    let _e313 = x_9;
    let _e314 = t;
    (*surface).source = (_e313 + _e314);
    let _e317 = own;
    if _e317 {
        let _e320 = (*at_2).depths[0u];
        let _e323 = (*at_2).depths[1u];
        let _e324 = t;
        local_23 = mix(_e320, _e323, _e324);
    } else {
        let _e327 = beside_1.edge_depth;
        local_23 = _e327;
    }
    let _e328 = local_23;
    (*surface).depth = _e328;
    let _e330 = x_9;
    let _e331 = (*origin_2);
    let _e335 = synthesis.law[1u];
    let _e337 = (*surface).depth;
    away_3 = ((_e330 - _e331) + (_e335 * _e337));
    let _e340 = found;
    let _e341 = !(_e340);
    phi_1452_ = _e341;
    if _e341 {
        let _e342 = away_3;
        phi_1452_ = (abs(_e342) >= 0.5f);
    }
    let _e346 = phi_1452_;
    (*surface).hole = _e346;
    let _e349 = (*surface).source;
    param_45 = _e349;
    let _e350 = column_at((&param_45));
    param_46 = 0f;
    let _e351 = row_at((&param_46));
    param_47 = vec2<f32>(_e350, _e351);
    let _e353 = color_sample((&param_47));
    color_2 = _e353;
    let _e355 = (*surface).hole;
    phi_1493_ = _e355;
    if _e355 {
        let _e356 = gl_FragCoord_1;
        let _e359 = synthesis.target_origin;
        param_48 = (_e356.xy - vec2<f32>(_e359));
        let _e363 = beside_1.front;
        param_49 = _e363;
        let _e364 = (*origin_2);
        param_50 = _e364;
        let _e365 = (*row_6);
        param_51 = _e365;
        let _e366 = color_2;
        param_52 = _e366;
        let _e368 = (*surface).depth;
        param_53 = _e368;
        let _e369 = recall((&param_48), (&param_49), (&param_50), (&param_51), (&param_52), (&param_53));
        let _e370 = param_52;
        color_2 = _e370;
        let _e371 = param_53;
        (*surface).depth = _e371;
        phi_1493_ = _e369;
    }
    let _e374 = phi_1493_;
    recalled = _e374;
    phi_1498_ = true;
    if true {
        let _e376 = (*surface).hole;
        phi_1498_ = _e376;
    }
    let _e378 = phi_1498_;
    let _e379 = recalled;
    if (_e378 && !(_e379)) {
        param_54 = true;
        let _e382 = color_2;
        param_55 = _e382;
        let _e383 = away_3;
        param_56 = _e383;
        let _e384 = x_9;
        param_57 = _e384;
        let _e386 = (*surface).depth;
        param_58 = _e386;
        let _e387 = (*row_6);
        param_59 = _e387;
        let _e388 = fill_hole((&param_54), (&param_55), (&param_56), (&param_57), (&param_58), (&param_59));
        color_2 = _e388;
    }
    let _e390 = beside_1.rim;
    if (_e390 >= 0f) {
        let _e393 = beside_1.rim;
        let _e394 = (*origin_2);
        let _e398 = synthesis.law[1u];
        let _e400 = beside_1.rim_depth;
        coverage = (1f - abs(((_e393 - _e394) + (_e398 * _e400))));
        let _e405 = color_2;
        let _e407 = beside_1.rim;
        param_60 = _e407;
        let _e408 = column_at((&param_60));
        param_61 = 0f;
        let _e409 = row_at((&param_61));
        param_62 = vec2<f32>(_e408, _e409);
        let _e411 = color_sample((&param_62));
        let _e412 = coverage;
        color_2 = mix(_e405, _e411, vec4(_e412));
        let _e415 = coverage;
        if (_e415 >= 0.5f) {
            let _e418 = beside_1.rim;
            let _e420 = beside_1.rim_depth;
            (*surface) = Surface(_e418, _e420, false);
        }
    }
    let _e422 = color_2;
    return _e422;
}

fn source_row() -> i32 {
    let _e6 = gl_FragCoord_1[1u];
    let _e8 = synthesis.first_row;
    let _e12 = synthesis.source_size[1u];
    return i32(clamp((_e6 - _e8), 0f, f32((_e12 - 1i))));
}

fn span_steps(span: ptr<function, u32>) -> f32 {
    var steps: u32;
    var local_24: f32;

    let _e5 = (*span);
    steps = (_e5 & 1023u);
    let _e7 = steps;
    if (_e7 == 1023u) {
        local_24 = 1000000000f;
    } else {
        let _e9 = steps;
        local_24 = f32(_e9);
    }
    let _e11 = local_24;
    return _e11;
}

fn searched(span_1: ptr<function, u32>, surface_1: ptr<function, Surface>) -> vec4<f32> {
    var origin_3: f32;
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
    var seen_1: vec4<f32>;
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
    var phi_1653_: bool;
    var phi_1662_: bool;
    var phi_1745_: bool;
    var phi_1758_: bool;

    let _e40 = synthesis.origins[0u];
    let _e42 = gl_FragCoord_1[0u];
    let _e46 = synthesis.origins[1u];
    origin_3 = ((_e40 * _e42) + _e46);
    let _e48 = origin_3;
    let _e50 = synthesis.farthest;
    let _e52 = (*span_1);
    param_63 = floor(((_e48 - _e50) - bitcast<f32>(_e52)));
    let _e56 = origin_3;
    param_64 = _e56;
    let _e57 = search_at((&param_63), (&param_64));
    at_3 = _e57;
    let _e59 = at_3.x;
    let _e61 = (*span_1);
    param_65 = _e61;
    let _e62 = span_steps((&param_65));
    let _e66 = synthesis.source_size[0u];
    end_1 = min((max(_e59, 0f) + _e62), f32((_e66 - 1i)));
    let _e71 = at_3.x;
    let _e73 = end_1;
    limit = min((_e71 + 2f), _e73);
    loop {
        let _e76 = at_3.x;
        let _e77 = limit;
        let _e78 = (_e76 < _e77);
        phi_1653_ = _e78;
        if _e78 {
            let _e80 = at_3.b;
            phi_1653_ = (_e80 <= 0f);
        }
        let _e83 = phi_1653_;
        phi_1662_ = _e83;
        if _e83 {
            let _e85 = at_3.b;
            let _e88 = at_3.a;
            phi_1662_ = (max(_e85, -1f) >= _e88);
        }
        let _e91 = phi_1662_;
        if _e91 {
            let _e93 = at_3.x;
            param_66 = (_e93 + 2f);
            let _e95 = column_at((&param_66));
            param_67 = 0f;
            let _e96 = row_at((&param_67));
            param_68 = vec2<f32>(_e95, _e96);
            let _e98 = depth_sample((&param_68));
            next = _e98;
            let _e101 = at_3.depths[1u];
            let _e102 = next;
            at_3.depths = vec2<f32>(_e101, _e102);
            let _e106 = at_3.b;
            at_3.a = _e106;
            let _e109 = at_3.x;
            let _e111 = origin_3;
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
    param_69 = _e148;
    let _e149 = column_at((&param_69));
    param_70 = 0f;
    let _e150 = row_at((&param_70));
    param_71 = vec2<f32>(_e149, _e150);
    let _e152 = color_sample((&param_71));
    seen_1 = _e152;
    let _e155 = synthesis.source_size[0u];
    middle = (0.5f * f32((_e155 - 1i)));
    let _e160 = at_3.a;
    let _e161 = (_e160 <= 0f);
    phi_1745_ = _e161;
    if _e161 {
        let _e163 = at_3.b;
        phi_1745_ = (_e163 > 0f);
    }
    let _e166 = phi_1745_;
    let _e167 = stretch;
    let _e169 = (_e166 && (_e167 < 2f));
    phi_1758_ = _e169;
    if _e169 {
        let _e171 = (*surface_1).source;
        let _e172 = middle;
        let _e175 = middle;
        phi_1758_ = (abs((_e171 - _e172)) <= _e175);
    }
    let _e178 = phi_1758_;
    done = _e178;
    let _e179 = done;
    if (true && !(_e179)) {
        let _e182 = source_row();
        let _e183 = at_3;
        param_72 = _e183;
        let _e184 = end_1;
        param_73 = _e184;
        let _e185 = origin_3;
        param_74 = _e185;
        param_75 = _e182;
        let _e186 = march((&param_72), (&param_73), (&param_74), (&param_75), (&param_76));
        let _e187 = param_76;
        (*surface_1) = _e187;
        seen_1 = _e186;
    }
    let _e188 = seen_1;
    return _e188;
}

fn lawful(affine: ptr<function, vec3<f32>>, surface_2: ptr<function, Surface>) -> vec4<f32> {
    var place_3: f32;
    var param_77: f32;
    var param_78: vec2<f32>;

    let _e10 = (*affine)[0u];
    let _e12 = (*affine)[1u];
    let _e14 = gl_FragCoord_1[0u];
    let _e18 = (*affine)[2u];
    let _e20 = gl_FragCoord_1[1u];
    place_3 = ((_e10 + (_e12 * _e14)) + (_e18 * _e20));
    let _e23 = place_3;
    param_77 = 0f;
    let _e24 = row_at((&param_77));
    param_78 = vec2<f32>(_e23, _e24);
    let _e26 = color_sample((&param_78));
    return _e26;
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
    var param_79: vec3<f32>;
    var param_80: Surface;
    var param_81: u32;
    var param_82: Surface;
    var phi_1785_: bool;

    let _e10 = pixel_span();
    span_2 = _e10;
    phi_1785_ = true;
    if true {
        let _e12 = span_2[1u];
        phi_1785_ = (_e12 != 0u);
    }
    let _e15 = phi_1785_;
    if _e15 {
        let _e16 = span_2;
        param_79 = bitcast<vec3<f32>>(_e16.xyz);
        let _e19 = lawful((&param_79), (&param_80));
        let _e20 = param_80;
        surface_3 = _e20;
        color_3 = _e19;
    } else {
        if true {
            let _e22 = span_2[0u];
            param_81 = _e22;
            let _e23 = searched((&param_81), (&param_82));
            let _e24 = param_82;
            surface_3 = _e24;
            color_3 = _e23;
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
    let _e5 = color_3;
    return _e5;
}
