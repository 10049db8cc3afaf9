// Made of yoro's GLSL by `cargo tools wgsl`.
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
var<private> gl_FragCoord_1: vec4<f32>;
@group(0) @binding(4) 
var layer_map_texture: texture_2d<u32>;
var<private> tile: u32;

fn pack_interval(low: ptr<function, f32>, high: ptr<function, f32>) -> u32 {
    var lowest: f32;
    var highest: f32;

    let _e10 = (*low);
    let _e12 = synthesis.far_displacement;
    lowest = clamp(floor(((_e10 - _e12) * 16f)), 0f, 65534f);
    let _e17 = (*high);
    let _e19 = synthesis.far_displacement;
    highest = clamp(ceil(((_e17 - _e19) * 16f)), 0f, 65535f);
    let _e24 = lowest;
    let _e26 = highest;
    return (u32(_e24) | (u32(_e26) << bitcast<u32>(16i)));
}

fn reach() -> f32 {
    let _e3 = synthesis.near_displacement;
    let _e5 = synthesis.far_displacement;
    return max((_e3 - _e5), 0.000001f);
}

fn split_displacements(layer: ptr<function, u32>) -> vec2<f32> {
    let _e4 = (*layer);
    let _e5 = (*layer);
    let _e12 = reach();
    return (vec2<f32>((vec2<u32>(_e4, (_e5 >> bitcast<u32>(14i))) & vec2(16383u))) * (_e12 / 16383f));
}

fn full_front(layer_1: ptr<function, u32>) -> f32 {
    let _e3 = (*layer_1);
    let _e6 = reach();
    return (f32((_e3 & 268435455u)) * (_e6 / 268435440f));
}

fn is_full(layer_2: ptr<function, u32>) -> bool {
    let _e3 = (*layer_2);
    return ((_e3 >> bitcast<u32>(28i)) == 15u);
}

fn source_column(x: ptr<function, i32>) -> i32 {
    var local: i32;

    let _e6 = synthesis.mirrored;
    if (_e6 != 0u) {
        let _e10 = synthesis.source_size[0u];
        let _e12 = (*x);
        local = ((_e10 - 1i) - _e12);
    } else {
        let _e14 = (*x);
        local = _e14;
    }
    let _e15 = local;
    return _e15;
}

fn main_1() {
    var corner: vec2<i32>;
    var low_1: f32;
    var high_1: f32;
    var j: i32;
    var row: i32;
    var i: i32;
    var x_1: i32;
    var layer_3: u32;
    var param: i32;
    var both: vec2<f32>;
    var param_1: u32;
    var local_1: vec2<f32>;
    var param_2: u32;
    var param_3: u32;
    var param_4: f32;
    var param_5: f32;

    let _e29 = gl_FragCoord_1;
    corner = (vec2<i32>(_e29.xy) * vec2<i32>(16i, 8i));
    low_1 = 1000000000f;
    high_1 = 0f;
    j = 0i;
    loop {
        let _e33 = j;
        if (_e33 < 8i) {
            let _e36 = corner[1u];
            let _e37 = j;
            let _e41 = synthesis.source_size[1u];
            row = min((_e36 + _e37), (_e41 - 1i));
            i = 0i;
            loop {
                let _e44 = i;
                if (_e44 <= 16i) {
                    let _e47 = corner[0u];
                    let _e48 = i;
                    let _e52 = synthesis.source_size[0u];
                    x_1 = min((_e47 + _e48), (_e52 - 1i));
                    let _e55 = x_1;
                    param = _e55;
                    let _e56 = source_column((&param));
                    let _e57 = row;
                    let _e59 = textureLoad(layer_map_texture, vec2<i32>(_e56, _e57), 0i);
                    layer_3 = _e59.x;
                    let _e61 = layer_3;
                    param_1 = _e61;
                    let _e62 = is_full((&param_1));
                    if _e62 {
                        let _e63 = layer_3;
                        param_2 = _e63;
                        let _e64 = full_front((&param_2));
                        local_1 = vec2(_e64);
                    } else {
                        let _e66 = layer_3;
                        param_3 = _e66;
                        let _e67 = split_displacements((&param_3));
                        local_1 = _e67;
                    }
                    let _e68 = local_1;
                    both = _e68;
                    let _e69 = high_1;
                    let _e71 = both[0u];
                    high_1 = max(_e69, _e71);
                    let _e73 = low_1;
                    let _e75 = both[1u];
                    low_1 = min(_e73, _e75);
                    continue;
                } else {
                    break;
                }
                continuing {
                    let _e77 = i;
                    i = (_e77 + 1i);
                }
            }
            continue;
        } else {
            break;
        }
        continuing {
            let _e79 = j;
            j = (_e79 + 1i);
        }
    }
    let _e82 = synthesis.far_displacement;
    let _e83 = low_1;
    let _e86 = synthesis.far_displacement;
    let _e87 = high_1;
    param_4 = (_e82 + _e83);
    param_5 = (_e86 + _e87);
    let _e89 = pack_interval((&param_4), (&param_5));
    tile = _e89;
    return;
}

@fragment 
fn main(@builtin(position) gl_FragCoord: vec4<f32>) -> @location(0) u32 {
    gl_FragCoord_1 = gl_FragCoord;
    main_1();
    let _e3 = tile;
    return _e3;
}
