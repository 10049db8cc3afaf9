// Made of yoro's GLSL by `cargo xtask maintain renew`.
struct AnyView {
    source_size: vec2<i32>,
    target_origin: vec2<i32>,
    to_source_x: vec4<f32>,
    to_source_y: vec4<f32>,
    to_source_w: vec4<f32>,
    source_law: vec2<f32>,
    target_law: vec2<f32>,
    nearest: f32,
    far_depth: f32,
    source_origin: vec2<i32>,
    texel: vec2<f32>,
}

@group(0) @binding(4) 
var<uniform> synthesis: AnyView;
@group(0) @binding(2) 
var tile_map_texture: texture_2d<u32>;
var<private> gl_FragCoord_1: vec4<f32>;
var<private> span: vec4<u32>;

fn holds(place: ptr<function, vec4<f32>>, from_: ptr<function, f32>, to: ptr<function, f32>) -> bool {
    var last: vec2<i32>;
    var first: vec2<i32>;
    var end: vec2<i32>;
    var found: bool;
    var y: i32;
    var x: i32;
    var bounds: vec2<u32>;
    var phi_156_: bool;

    let _e20 = synthesis.source_size;
    last = (_e20 - vec2(1i));
    let _e23 = (*place);
    let _e27 = last;
    first = (clamp(vec2<i32>(floor(_e23.xz)), vec2<i32>(0i, 0i), _e27) / vec2<i32>(16i, 8i));
    let _e30 = (*place);
    let _e34 = last;
    end = (clamp(vec2<i32>(floor(_e30.yw)), vec2<i32>(0i, 0i), _e34) / vec2<i32>(16i, 8i));
    found = false;
    let _e38 = first[1u];
    y = _e38;
    loop {
        let _e39 = y;
        let _e41 = end[1u];
        let _e43 = found;
        if ((_e39 <= _e41) && !(_e43)) {
            let _e47 = first[0u];
            x = _e47;
            loop {
                let _e48 = x;
                let _e50 = end[0u];
                let _e52 = found;
                if ((_e48 <= _e50) && !(_e52)) {
                    let _e55 = x;
                    let _e56 = y;
                    let _e58 = textureLoad(tile_map_texture, vec2<i32>(_e55, _e56), 0i);
                    bounds = _e58.xy;
                    let _e61 = bounds[0u];
                    let _e63 = (*from_);
                    let _e64 = (*to);
                    let _e66 = (bitcast<f32>(_e61) <= max(_e63, _e64));
                    phi_156_ = _e66;
                    if _e66 {
                        let _e68 = bounds[1u];
                        let _e70 = (*from_);
                        let _e71 = (*to);
                        phi_156_ = (bitcast<f32>(_e68) >= min(_e70, _e71));
                    }
                    let _e75 = phi_156_;
                    found = _e75;
                    continue;
                } else {
                    break;
                }
                continuing {
                    let _e76 = x;
                    x = (_e76 + 1i);
                }
            }
            continue;
        } else {
            break;
        }
        continuing {
            let _e78 = y;
            y = (_e78 + 1i);
        }
    }
    let _e80 = found;
    return _e80;
}

fn range_of(v: ptr<function, vec4<f32>>) -> vec2<f32> {
    var least: vec2<f32>;
    var most: vec2<f32>;

    let _e5 = (*v);
    let _e7 = (*v);
    least = min(_e5.xy, _e7.zw);
    let _e10 = (*v);
    let _e12 = (*v);
    most = max(_e10.xy, _e12.zw);
    let _e16 = least[0u];
    let _e18 = least[1u];
    let _e21 = most[0u];
    let _e23 = most[1u];
    return vec2<f32>(min(_e16, _e18), max(_e21, _e23));
}

fn main_1() {
    var x_1: vec4<f32>;
    var y_1: vec4<f32>;
    var scale: vec4<f32>;
    var infinity_x: vec4<f32>;
    var infinity_y: vec4<f32>;
    var parallax_x: vec4<f32>;
    var parallax_y: vec4<f32>;
    var farthest: f32;
    var reach: f32;
    var far_x: vec4<f32>;
    var far_y: vec4<f32>;
    var moved: vec2<f32>;
    var param: vec4<f32>;
    var param_1: vec4<f32>;
    var steps: f32;
    var found_1: bool;
    var from_1: f32;
    var left: f32;
    var to_1: f32;
    var columns: vec2<f32>;
    var param_2: vec4<f32>;
    var rows: vec2<f32>;
    var param_3: vec4<f32>;
    var next_columns: vec2<f32>;
    var param_4: vec4<f32>;
    var next_rows: vec2<f32>;
    var param_5: vec4<f32>;
    var place_1: vec4<f32>;
    var param_6: vec4<f32>;
    var param_7: f32;
    var param_8: f32;

    let _e49 = gl_FragCoord_1[0u];
    x_1 = (vec4((floor(_e49) * 16f)) + vec4<f32>(0f, 16f, 0f, 16f));
    let _e55 = gl_FragCoord_1[1u];
    y_1 = (vec4((floor(_e55) * 8f)) + vec4<f32>(0f, 0f, 8f, 8f));
    let _e62 = synthesis.to_source_w[0u];
    let _e63 = x_1;
    let _e67 = synthesis.to_source_w[1u];
    let _e68 = y_1;
    let _e73 = synthesis.to_source_w[2u];
    scale = (((_e63 * _e62) + (_e68 * _e67)) + vec4(_e73));
    let _e78 = synthesis.to_source_x[0u];
    let _e79 = x_1;
    let _e83 = synthesis.to_source_x[1u];
    let _e84 = y_1;
    let _e89 = synthesis.to_source_x[2u];
    let _e92 = scale;
    infinity_x = ((((_e79 * _e78) + (_e84 * _e83)) + vec4(_e89)) / _e92);
    let _e96 = synthesis.to_source_y[0u];
    let _e97 = x_1;
    let _e101 = synthesis.to_source_y[1u];
    let _e102 = y_1;
    let _e107 = synthesis.to_source_y[2u];
    let _e110 = scale;
    infinity_y = ((((_e97 * _e96) + (_e102 * _e101)) + vec4(_e107)) / _e110);
    let _e114 = synthesis.to_source_x[3u];
    let _e117 = synthesis.to_source_w[3u];
    let _e118 = infinity_x;
    parallax_x = (vec4(_e114) - (_e118 * _e117));
    let _e124 = synthesis.to_source_y[3u];
    let _e127 = synthesis.to_source_w[3u];
    let _e128 = infinity_y;
    parallax_y = (vec4(_e124) - (_e128 * _e127));
    let _e134 = synthesis.source_law[0u];
    let _e137 = synthesis.source_law[1u];
    let _e139 = synthesis.far_depth;
    farthest = (_e134 + (_e137 * _e139));
    let _e144 = synthesis.source_law[1u];
    let _e146 = synthesis.nearest;
    let _e148 = synthesis.far_depth;
    reach = (_e144 * (_e146 - _e148));
    let _e151 = infinity_x;
    let _e152 = farthest;
    let _e153 = parallax_x;
    far_x = ((_e151 + (_e153 * _e152)) - vec4(0.5f));
    let _e158 = infinity_y;
    let _e159 = farthest;
    let _e160 = parallax_y;
    far_y = ((_e158 + (_e160 * _e159)) - vec4(0.5f));
    let _e165 = reach;
    let _e166 = parallax_x;
    param = (_e166 * _e165);
    let _e168 = range_of((&param));
    let _e170 = reach;
    let _e171 = parallax_y;
    param_1 = (_e171 * _e170);
    let _e173 = range_of((&param_1));
    moved = max(abs(_e168), abs(_e173));
    let _e177 = moved[0u];
    let _e179 = moved[1u];
    steps = clamp(ceil((max(_e177, _e179) / 16f)), 1f, 64f);
    found_1 = false;
    from_1 = 1f;
    let _e184 = steps;
    left = _e184;
    loop {
        let _e185 = left;
        let _e187 = found_1;
        if ((_e185 > 0f) && !(_e187)) {
            let _e190 = left;
            let _e191 = steps;
            from_1 = (_e190 / _e191);
            let _e193 = left;
            let _e195 = steps;
            to_1 = ((_e193 - 1f) / _e195);
            let _e197 = far_x;
            let _e198 = from_1;
            let _e199 = reach;
            let _e201 = parallax_x;
            param_2 = (_e197 + (_e201 * (_e198 * _e199)));
            let _e204 = range_of((&param_2));
            columns = _e204;
            let _e205 = far_y;
            let _e206 = from_1;
            let _e207 = reach;
            let _e209 = parallax_y;
            param_3 = (_e205 + (_e209 * (_e206 * _e207)));
            let _e212 = range_of((&param_3));
            rows = _e212;
            let _e213 = far_x;
            let _e214 = to_1;
            let _e215 = reach;
            let _e217 = parallax_x;
            param_4 = (_e213 + (_e217 * (_e214 * _e215)));
            let _e220 = range_of((&param_4));
            next_columns = _e220;
            let _e221 = far_y;
            let _e222 = to_1;
            let _e223 = reach;
            let _e225 = parallax_y;
            param_5 = (_e221 + (_e225 * (_e222 * _e223)));
            let _e228 = range_of((&param_5));
            next_rows = _e228;
            let _e230 = columns[0u];
            let _e232 = next_columns[0u];
            let _e235 = columns[1u];
            let _e237 = next_columns[1u];
            let _e240 = rows[0u];
            let _e242 = next_rows[0u];
            let _e245 = rows[1u];
            let _e247 = next_rows[1u];
            place_1 = vec4<f32>(min(_e230, _e232), max(_e235, _e237), min(_e240, _e242), max(_e245, _e247));
            let _e250 = place_1;
            let _e253 = synthesis.far_depth;
            let _e255 = synthesis.nearest;
            let _e256 = from_1;
            let _e259 = synthesis.far_depth;
            let _e261 = synthesis.nearest;
            let _e262 = to_1;
            param_6 = (_e250 + vec4<f32>(-1f, 1f, -1f, 1f));
            param_7 = mix(_e253, _e255, _e256);
            param_8 = mix(_e259, _e261, _e262);
            let _e264 = holds((&param_6), (&param_7), (&param_8));
            found_1 = _e264;
            continue;
        } else {
            break;
        }
        continuing {
            let _e265 = left;
            left = (_e265 - 1f);
        }
    }
    let _e268 = synthesis.far_depth;
    let _e270 = synthesis.nearest;
    let _e271 = found_1;
    let _e272 = from_1;
    span = vec4<u32>(bitcast<u32>(mix(_e268, _e270, select(1f, _e272, _e271))), 0u, 0u, 0u);
    return;
}

@fragment 
fn main(@builtin(position) gl_FragCoord: vec4<f32>) -> @location(0) vec4<u32> {
    gl_FragCoord_1 = gl_FragCoord;
    main_1();
    let _e3 = span;
    return _e3;
}
