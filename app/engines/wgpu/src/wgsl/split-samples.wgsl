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

struct FragmentOutput {
    @location(0) member: u32,
    @location(1) member_1: vec4<f32>,
}

@group(0) @binding(7) 
var<uniform> synthesis: Synthesis;
@group(0) @binding(0) 
var sample_depths_texture: texture_multisampled_2d<f32>;
var<private> gl_FragCoord_1: vec4<f32>;
var<private> layer: u32;
@group(0) @binding(6) 
var sample_colors_texture: texture_multisampled_2d<f32>;
var<private> back_1: vec4<f32>;

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

fn sample_order() -> vec4<i32> {
    let _e5 = synthesis.mirrored;
    return select(vec4<i32>(2i, 0i, 3i, 1i), vec4<i32>(1i, 3i, 0i, 2i), vec4((_e5 != 0u)));
}

fn reach() -> f32 {
    let _e3 = synthesis.near_displacement;
    let _e5 = synthesis.far_displacement;
    return max((_e3 - _e5), 0.000001f);
}

fn pack_split(front: ptr<function, f32>, back: ptr<function, f32>, mask: ptr<function, u32>) -> u32 {
    var steps: vec2<u32>;

    let _e12 = (*front);
    let _e13 = (*back);
    let _e15 = reach();
    steps = vec2<u32>(((clamp((vec2<f32>(_e12, _e13) / vec2(_e15)), vec2(0f), vec2(1f)) * 16383f) + vec2(0.5f)));
    let _e25 = (*mask);
    let _e29 = steps[1u];
    let _e34 = steps[0u];
    return (((_e25 << bitcast<u32>(28i)) | (_e29 << bitcast<u32>(14i))) | _e34);
}

fn pack_full(front_1: ptr<function, f32>) -> u32 {
    let _e5 = (*front_1);
    let _e6 = reach();
    return (4026531840u | u32((clamp((_e5 / _e6), 0f, 1f) * 268435440f)));
}

fn smallest(v: ptr<function, vec4<f32>>) -> f32 {
    let _e6 = (*v)[0u];
    let _e8 = (*v)[1u];
    let _e11 = (*v)[2u];
    let _e13 = (*v)[3u];
    return min(min(_e6, _e8), min(_e11, _e13));
}

fn largest(v_1: ptr<function, vec4<f32>>) -> f32 {
    let _e6 = (*v_1)[0u];
    let _e8 = (*v_1)[1u];
    let _e11 = (*v_1)[2u];
    let _e13 = (*v_1)[3u];
    return max(max(_e6, _e8), max(_e11, _e13));
}

fn inside(pixel_1: ptr<function, vec2<i32>>) -> vec2<i32> {
    let _e4 = (*pixel_1);
    let _e6 = synthesis.source_size;
    return clamp(_e4, vec2<i32>(0i, 0i), (_e6 - vec2(1i)));
}

fn displacements(pixel_2: ptr<function, vec2<i32>>) -> vec4<f32> {
    var at: vec2<i32>;
    var param: vec2<i32>;
    var param_1: vec2<i32>;
    var stripes: vec4<i32>;
    var depths: vec4<f32>;

    let _e12 = (*pixel_2);
    param = _e12;
    let _e13 = inside((&param));
    param_1 = _e13;
    let _e14 = in_image((&param_1));
    at = _e14;
    let _e15 = sample_order();
    stripes = _e15;
    let _e16 = at;
    let _e18 = stripes[0u];
    let _e19 = textureLoad(sample_depths_texture, _e16, _e18);
    let _e21 = at;
    let _e23 = stripes[1u];
    let _e24 = textureLoad(sample_depths_texture, _e21, _e23);
    let _e26 = at;
    let _e28 = stripes[2u];
    let _e29 = textureLoad(sample_depths_texture, _e26, _e28);
    let _e31 = at;
    let _e33 = stripes[3u];
    let _e34 = textureLoad(sample_depths_texture, _e31, _e33);
    depths = vec4<f32>(_e19.x, _e24.x, _e29.x, _e34.x);
    let _e39 = synthesis.law[0u];
    let _e41 = synthesis.far_displacement;
    let _e45 = synthesis.law[1u];
    let _e46 = depths;
    return (vec4((_e39 - _e41)) + (_e46 * _e45));
}

fn main_1() {
    var pixel_3: vec2<i32>;
    var samples: vec4<f32>;
    var param_2: vec2<i32>;
    var nearest: f32;
    var param_3: vec4<f32>;
    var full: bool;
    var param_4: vec4<f32>;
    var in_front: vec4<f32>;
    var local_1: vec4<f32>;
    var count: f32;
    var front_2: f32;
    var second: f32;
    var param_5: vec4<f32>;
    var behind: vec4<f32>;
    var back_displacement: f32;
    var bits: u32;
    var local_2: u32;
    var param_6: f32;
    var param_7: f32;
    var param_8: f32;
    var param_9: u32;
    var share: f32;
    var sum: vec4<f32>;
    var stripes_1: vec4<i32>;
    var k: i32;
    var param_10: vec2<i32>;

    let _e41 = gl_FragCoord_1;
    pixel_3 = vec2<i32>(_e41.xy);
    let _e44 = pixel_3;
    param_2 = _e44;
    let _e45 = displacements((&param_2));
    samples = _e45;
    let _e46 = samples;
    param_3 = _e46;
    let _e47 = largest((&param_3));
    nearest = _e47;
    let _e48 = nearest;
    let _e49 = samples;
    param_4 = _e49;
    let _e50 = smallest((&param_4));
    full = ((_e48 - _e50) < 0.5f);
    let _e53 = full;
    if _e53 {
        local_1 = vec4<f32>(1f, 1f, 1f, 1f);
    } else {
        let _e54 = samples;
        let _e55 = nearest;
        local_1 = select(vec4<f32>(0f, 0f, 0f, 0f), vec4<f32>(1f, 1f, 1f, 1f), (_e54 > vec4((_e55 - 0.5f))));
    }
    let _e60 = local_1;
    in_front = _e60;
    let _e61 = in_front;
    count = dot(_e61, vec4<f32>(1f, 1f, 1f, 1f));
    let _e63 = in_front;
    let _e64 = samples;
    let _e66 = count;
    front_2 = (dot(_e63, _e64) / _e66);
    let _e68 = samples;
    let _e69 = in_front;
    param_5 = mix(_e68, vec4<f32>(-1000000000f, -1000000000f, -1000000000f, -1000000000f), _e69);
    let _e71 = largest((&param_5));
    second = _e71;
    let _e72 = in_front;
    let _e75 = samples;
    let _e76 = second;
    behind = ((vec4(1f) - _e72) * select(vec4<f32>(0f, 0f, 0f, 0f), vec4<f32>(1f, 1f, 1f, 1f), (_e75 > vec4((_e76 - 0.5f)))));
    let _e82 = behind;
    let _e83 = samples;
    let _e85 = behind;
    back_displacement = (dot(_e82, _e83) / max(dot(_e85, vec4<f32>(1f, 1f, 1f, 1f)), 1f));
    let _e89 = in_front;
    bits = u32(dot(_e89, vec4<f32>(1f, 2f, 4f, 8f)));
    let _e92 = full;
    if _e92 {
        let _e93 = front_2;
        param_6 = _e93;
        let _e94 = pack_full((&param_6));
        local_2 = _e94;
    } else {
        let _e95 = front_2;
        param_7 = _e95;
        let _e96 = back_displacement;
        param_8 = _e96;
        let _e97 = bits;
        param_9 = _e97;
        let _e98 = pack_split((&param_7), (&param_8), (&param_9));
        local_2 = _e98;
    }
    let _e99 = local_2;
    layer = _e99;
    let _e100 = count;
    share = (0.25f * _e100);
    sum = vec4<f32>(0f, 0f, 0f, 0f);
    let _e102 = sample_order();
    stripes_1 = _e102;
    let _e103 = full;
    k = select(0i, 4i, _e103);
    loop {
        let _e105 = k;
        if (_e105 < 4i) {
            let _e107 = k;
            let _e109 = in_front[_e107];
            let _e111 = pixel_3;
            param_10 = _e111;
            let _e112 = in_image((&param_10));
            let _e113 = k;
            let _e115 = stripes_1[_e113];
            let _e116 = textureLoad(sample_colors_texture, _e112, _e115);
            let _e118 = sum;
            sum = (_e118 + (_e116 * (1f - _e109)));
            continue;
        } else {
            break;
        }
        continuing {
            let _e120 = k;
            k = (_e120 + 1i);
        }
    }
    let _e122 = sum;
    let _e123 = count;
    let _e128 = (_e122 / vec4(max((4f - _e123), 1f))).xyz;
    let _e129 = share;
    back_1 = vec4<f32>(_e128.x, _e128.y, _e128.z, _e129);
    return;
}

@fragment 
fn main(@builtin(position) gl_FragCoord: vec4<f32>) -> FragmentOutput {
    gl_FragCoord_1 = gl_FragCoord;
    main_1();
    let _e4 = layer;
    let _e5 = back_1;
    return FragmentOutput(_e4, _e5);
}
