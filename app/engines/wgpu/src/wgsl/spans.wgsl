// Made of yoro's GLSL by `cargo xtask maintain renew`.
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

@group(0) @binding(2) 
var tile_map_texture: texture_2d<u32>;
@group(0) @binding(4) 
var<uniform> synthesis: Synthesis;
var<private> gl_FragCoord_1: vec4<f32>;
var<private> span: vec4<u32>;

fn landing(source_tile: ptr<function, i32>, row: ptr<function, i32>) -> vec3<f32> {
    var plane: vec3<f32>;
    var first: f32;

    let _e11 = (*source_tile);
    let _e12 = (*row);
    let _e14 = textureLoad(tile_map_texture, vec2<i32>(_e11, _e12), 0i);
    plane = bitcast<vec3<f32>>(_e14.yzw);
    let _e17 = (*source_tile);
    let _e21 = plane[0u];
    first = (f32((_e17 * 16i)) + _e21);
    let _e23 = first;
    let _e24 = first;
    let _e26 = plane[2u];
    let _e30 = plane[1u];
    return vec3<f32>(_e23, (_e24 + (7f * _e26)), _e30);
}

fn repeats_border(row_1: ptr<function, i32>) -> bool {
    var rows: i32;
    var phi_114_: bool;
    var phi_132_: bool;
    var phi_133_: bool;

    let _e9 = synthesis.source_size[1u];
    rows = (((_e9 + 8i) - 1i) / 8i);
    let _e13 = (*row_1);
    let _e14 = (_e13 == 0i);
    phi_114_ = _e14;
    if _e14 {
        let _e16 = synthesis.row_offset;
        phi_114_ = (_e16 > 0i);
    }
    let _e19 = phi_114_;
    phi_133_ = _e19;
    if !(_e19) {
        let _e21 = (*row_1);
        let _e22 = rows;
        let _e24 = (_e21 == (_e22 - 1i));
        phi_132_ = _e24;
        if _e24 {
            let _e27 = synthesis.target_size[1u];
            let _e29 = synthesis.row_offset;
            let _e33 = synthesis.source_size[1u];
            phi_132_ = ((_e27 - _e29) > _e33);
        }
        let _e36 = phi_132_;
        phi_133_ = _e36;
    }
    let _e38 = phi_133_;
    return _e38;
}

fn tile_plane(tile: ptr<function, vec2<i32>>, left: ptr<function, i32>, right: ptr<function, i32>) -> vec3<f32> {
    var param: i32;
    var first_1: f32;
    var last: f32;
    var ends: vec4<f32>;
    var corners: vec4<f32>;
    var planar: bool;
    var s: i32;
    var lands: vec3<f32>;
    var param_1: i32;
    var param_2: i32;
    var place: vec4<f32>;
    var local: vec4<bool>;
    var slope: vec2<f32>;
    var error: f32;
    var next: i32;
    var lands_1: vec2<f32>;
    var param_3: i32;
    var param_4: i32;
    var off: vec2<f32>;
    var inside: vec2<bool>;
    var local_1: f32;
    var local_2: f32;
    var middle: vec4<f32>;
    var column: f32;
    var phi_146_: bool;
    var phi_154_: bool;
    var phi_204_: bool;
    var phi_363_: bool;
    var phi_374_: bool;

    let _e47 = (*left);
    let _e48 = (*right);
    let _e49 = (_e47 > _e48);
    phi_146_ = _e49;
    if !(_e49) {
        let _e51 = (*right);
        let _e52 = (*left);
        phi_146_ = (_e51 >= (_e52 + 4i));
    }
    let _e56 = phi_146_;
    phi_154_ = _e56;
    if !(_e56) {
        let _e59 = (*tile)[1u];
        param = _e59;
        let _e60 = repeats_border((&param));
        phi_154_ = _e60;
    }
    let _e62 = phi_154_;
    if _e62 {
        return vec3<f32>(0f, 0f, 0f);
    }
    let _e64 = (*tile)[0u];
    first_1 = f32((_e64 * 16i));
    let _e67 = first_1;
    last = (_e67 + 15f);
    let _e69 = first_1;
    let _e70 = last;
    ends = vec2<f32>(_e69, _e70).xyxy;
    corners = vec4<f32>(0f, 0f, 0f, 0f);
    planar = true;
    let _e73 = (*left);
    s = _e73;
    loop {
        let _e74 = s;
        let _e75 = (*right);
        if (_e74 <= _e75) {
            let _e77 = s;
            param_1 = _e77;
            let _e79 = (*tile)[1u];
            param_2 = _e79;
            let _e80 = landing((&param_1), (&param_2));
            lands = _e80;
            let _e81 = planar;
            phi_204_ = _e81;
            if _e81 {
                let _e83 = lands[2u];
                phi_204_ = (_e83 < 9f);
            }
            let _e86 = phi_204_;
            planar = _e86;
            let _e87 = s;
            let _e90 = ends;
            let _e91 = lands;
            let _e95 = lands[2u];
            place = (vec4(f32((_e87 * 16i))) + ((_e90 - _e91.xxyy) / vec4((1f + _e95))));
            let _e101 = corners;
            let _e102 = place;
            let _e103 = s;
            let _e104 = (*left);
            if (_e103 == _e104) {
                local = vec4<bool>(true, true, true, true);
            } else {
                let _e106 = lands;
                let _e108 = ends;
                local = (_e106.xxyy <= _e108);
            }
            let _e110 = local;
            corners = select(_e101, _e102, _e110);
            continue;
        } else {
            break;
        }
        continuing {
            let _e112 = s;
            s = (_e112 + 1i);
        }
    }
    let _e115 = corners[1u];
    let _e117 = corners[0u];
    let _e120 = corners[2u];
    let _e122 = corners[0u];
    slope = (vec2<f32>((_e115 - _e117), (_e120 - _e122)) / vec2<f32>(15f, 7f));
    let _e127 = corners[3u];
    let _e129 = corners[1u];
    let _e132 = corners[2u];
    let _e135 = corners[0u];
    error = abs((((_e127 - _e129) - _e132) + _e135));
    let _e138 = (*left);
    next = (_e138 + 1i);
    loop {
        let _e140 = next;
        let _e141 = (*right);
        if (_e140 <= _e141) {
            let _e143 = next;
            param_3 = _e143;
            let _e145 = (*tile)[1u];
            param_4 = _e145;
            let _e146 = landing((&param_3), (&param_4));
            lands_1 = _e146.xy;
            let _e148 = corners;
            let _e151 = slope[0u];
            let _e152 = lands_1;
            let _e153 = first_1;
            let _e158 = next;
            off = abs(((_e148.xz + ((_e152 - vec2(_e153)) * _e151)) - vec2(f32((_e158 * 16i)))));
            let _e164 = lands_1;
            let _e165 = first_1;
            let _e166 = last;
            let _e172 = last;
            let _e173 = first_1;
            inside = (abs((_e164 - vec2((0.5f * (_e165 + _e166))))) < vec2((0.5f * (_e172 - _e173))));
            let _e178 = error;
            let _e180 = inside[0u];
            if _e180 {
                let _e182 = off[0u];
                local_1 = _e182;
            } else {
                local_1 = 0f;
            }
            let _e183 = local_1;
            let _e185 = inside[1u];
            if _e185 {
                let _e187 = off[1u];
                local_2 = _e187;
            } else {
                local_2 = 0f;
            }
            let _e188 = local_2;
            error = max(_e178, max(_e183, _e188));
            continue;
        } else {
            break;
        }
        continuing {
            let _e191 = next;
            next = (_e191 + 1i);
        }
    }
    let _e195 = synthesis.source_size[0u];
    middle = vec4((0.5f * f32((_e195 - 1i))));
    let _e200 = planar;
    let _e201 = !(_e200);
    phi_363_ = _e201;
    if !(_e201) {
        let _e203 = error;
        phi_363_ = !((_e203 <= 0.0625f));
    }
    let _e207 = phi_363_;
    phi_374_ = _e207;
    if !(_e207) {
        let _e209 = corners;
        let _e210 = middle;
        let _e213 = middle;
        phi_374_ = any((abs((_e209 - _e210)) > _e213));
    }
    let _e217 = phi_374_;
    if _e217 {
        return vec3<f32>(0f, 0f, 0f);
    }
    let _e219 = corners[0u];
    let _e221 = slope[0u];
    let _e224 = synthesis.origins[1u];
    let _e227 = synthesis.law[0u];
    let _e229 = first_1;
    let _e234 = slope[1u];
    let _e236 = synthesis.first_row;
    let _e239 = (*tile)[1u];
    column = ((_e219 + (_e221 * ((_e224 + _e227) - _e229))) - (_e234 * ((_e236 + 0.5f) + f32((_e239 * 8i)))));
    let _e247 = synthesis.columns[0u];
    let _e248 = column;
    let _e253 = synthesis.columns[1u];
    let _e257 = synthesis.columns[0u];
    let _e258 = slope;
    let _e262 = synthesis.origins[0u];
    let _e264 = ((_e258 * _e257) * vec2<f32>(_e262, 1f));
    return vec3<f32>(((_e247 * (_e248 + 0.5f)) + _e253), _e264.x, _e264.y);
}

fn pack_span(reach: ptr<function, f32>, columns: ptr<function, f32>) -> u32 {
    let _e4 = (*reach);
    let _e8 = (*columns);
    return (((bitcast<u32>(_e4) + 1023u) & 4294966272u) | min(u32(_e8), 1023u));
}

fn main_1() {
    var tile_1: vec2<i32>;
    var first_2: f32;
    var last_1: f32;
    var tiles: i32;
    var from_: i32;
    var to: i32;
    var least: i32;
    var most: i32;
    var low: i32;
    var high: i32;
    var left_1: i32;
    var right_1: i32;
    var drop: i32;
    var beside: vec2<i32>;
    var s_1: i32;
    var moved: u32;
    var own: i32;
    var lowest: i32;
    var highest: i32;
    var below: u32;
    var above: u32;
    var search: u32;
    var param_5: f32;
    var param_6: f32;
    var affine: vec3<f32>;
    var param_7: vec2<i32>;
    var param_8: i32;
    var param_9: i32;
    var rise: f32;

    let _e52 = gl_FragCoord_1;
    tile_1 = vec2<i32>(_e52.xy);
    let _e56 = tile_1[0u];
    first_2 = f32((_e56 * 16i));
    let _e59 = first_2;
    last_1 = (_e59 + 15f);
    let _e63 = synthesis.source_size[0u];
    tiles = (((_e63 + 16i) - 1i) / 16i);
    let _e67 = first_2;
    let _e69 = synthesis.near_displacement;
    let _e76 = tiles;
    from_ = clamp((i32(floor((((_e67 - _e69) - 1f) / 16f))) - 1i), 0i, (_e76 - 1i));
    let _e79 = last_1;
    let _e81 = synthesis.far_displacement;
    let _e87 = tiles;
    to = clamp(i32(floor((((_e79 - _e81) + 1f) / 16f))), 0i, (_e87 - 1i));
    let _e90 = first_2;
    let _e93 = synthesis.far_displacement;
    let _e95 = from_;
    least = i32(floor(((((_e90 - 1f) - _e93) - f32(((_e95 + 1i) * 16i))) * 16f)));
    let _e103 = last_1;
    let _e106 = synthesis.far_displacement;
    let _e108 = from_;
    most = i32(ceil(((((_e103 + 1f) - _e106) - f32((_e108 * 16i))) * 16f)));
    low = 65535i;
    high = 0i;
    let _e115 = tiles;
    left_1 = _e115;
    right_1 = 0i;
    drop = 0i;
    let _e117 = tile_1[1u];
    let _e122 = synthesis.source_size[1u];
    beside = clamp((vec2(_e117) + vec2<i32>(-1i, 1i)), vec2(0i), vec2(((_e122 - 1i) / 8i)));
    let _e128 = from_;
    s_1 = _e128;
    loop {
        let _e129 = s_1;
        let _e130 = to;
        if (_e129 <= _e130) {
            let _e132 = s_1;
            let _e134 = tile_1[1u];
            let _e136 = textureLoad(tile_map_texture, vec2<i32>(_e132, _e134), 0i);
            moved = _e136.x;
            let _e138 = moved;
            own = bitcast<i32>((_e138 & 65535u));
            let _e141 = own;
            let _e142 = least;
            lowest = max(_e141, _e142);
            let _e144 = moved;
            let _e148 = most;
            highest = min(bitcast<i32>((_e144 >> bitcast<u32>(16i))), _e148);
            let _e150 = lowest;
            let _e151 = highest;
            if (_e150 <= _e151) {
                let _e153 = low;
                let _e154 = lowest;
                low = min(_e153, _e154);
                let _e156 = high;
                let _e157 = highest;
                high = max(_e156, _e157);
                let _e159 = left_1;
                let _e160 = s_1;
                left_1 = min(_e159, _e160);
                let _e162 = s_1;
                right_1 = _e162;
                let _e163 = s_1;
                let _e165 = beside[0u];
                let _e167 = textureLoad(tile_map_texture, vec2<i32>(_e163, _e165), 0i);
                below = (_e167.x & 65535u);
                let _e170 = s_1;
                let _e172 = beside[1u];
                let _e174 = textureLoad(tile_map_texture, vec2<i32>(_e170, _e172), 0i);
                above = (_e174.x & 65535u);
                let _e177 = drop;
                let _e178 = own;
                let _e179 = below;
                let _e180 = above;
                drop = max(_e177, (_e178 - bitcast<i32>(min(_e179, _e180))));
            }
            let _e185 = least;
            least = (_e185 - 256i);
            let _e187 = most;
            most = (_e187 - 256i);
            continue;
        } else {
            break;
        }
        continuing {
            let _e189 = s_1;
            s_1 = (_e189 + 1i);
        }
    }
    let _e191 = high;
    let _e192 = low;
    if (_e191 < _e192) {
        let _e195 = tile_1[0u];
        let _e200 = synthesis.target_size[0u];
        let _e202 = select(0i, 65535i, (((2i * _e195) * 16i) < _e200));
        high = _e202;
        low = _e202;
    }
    let _e203 = high;
    let _e206 = high;
    let _e207 = low;
    param_5 = (f32(_e203) / 16f);
    param_6 = (ceil((f32((_e206 - _e207)) / 16f)) + 2f);
    let _e213 = pack_span((&param_5), (&param_6));
    search = _e213;
    let _e214 = search;
    span = vec4<u32>(_e214, 0u, 0u, 1u);
    let _e216 = tile_1;
    param_7 = _e216;
    let _e217 = left_1;
    param_8 = _e217;
    let _e218 = right_1;
    param_9 = _e218;
    let _e219 = tile_plane((&param_7), (&param_8), (&param_9));
    affine = _e219;
    let _e221 = affine[1u];
    if (_e221 != 0f) {
        let _e224 = affine[2u];
        let _e227 = synthesis.columns[0u];
        rise = (abs((_e224 / _e227)) * 8f);
        let _e231 = affine;
        let _e232 = bitcast<vec3<u32>>(_e231);
        let _e233 = drop;
        let _e235 = rise;
        span = vec4<u32>(_e232.x, _e232.y, _e232.z, select(0u, 1u, (f32(_e233) > ((_e235 + 4f) * 16f))));
    }
    return;
}

@fragment 
fn main(@builtin(position) gl_FragCoord: vec4<f32>) -> @location(0) vec4<u32> {
    gl_FragCoord_1 = gl_FragCoord;
    main_1();
    let _e3 = span;
    return _e3;
}
