// Made of yoro's GLSL by `cargo xtask maintain renew`.
struct Levels {
    eye_place: vec4<f32>,
    wide_place: vec4<f32>,
    wide_bounds: vec4<f32>,
    inset_place: vec4<f32>,
    inset_part: vec4<f32>,
    inset_bounds: vec4<f32>,
    inset_source: vec4<f32>,
    inset_ramp: vec2<f32>,
}

@group(0) @binding(4) 
var<uniform> synthesis: Levels;
@group(0) @binding(0) 
var inset_depth_texture: texture_2d<f32>;
@group(0) @binding(5) 
var nearest_sampler: sampler;
@group(0) @binding(2) 
var inset_map_texture: texture_2d<f32>;
@group(0) @binding(6) 
var linear_sampler: sampler;
@group(0) @binding(1) 
var wide_map_texture: texture_2d<f32>;
var<private> color_1: vec4<f32>;
var<private> gl_FragCoord_1: vec4<f32>;

fn inset_share(place: ptr<function, vec2<f32>>, at: ptr<function, vec2<f32>>) -> f32 {
    var within: vec2<f32>;
    var share: f32;
    var depth: f32;
    var source: f32;
    var phi_58_: bool;

    let _e14 = (*place);
    let _e15 = (*place);
    let _e20 = synthesis.inset_ramp;
    within = (min(_e14, (vec2(1f) - _e15)) * _e20);
    let _e23 = within[0u];
    let _e25 = within[1u];
    share = clamp(min(_e23, _e25), 0f, 1f);
    let _e28 = share;
    let _e29 = (_e28 > 0f);
    phi_58_ = _e29;
    if _e29 {
        let _e32 = synthesis.inset_source[2u];
        phi_58_ = (_e32 != 0f);
    }
    let _e35 = phi_58_;
    if _e35 {
        let _e36 = (*at);
        let _e37 = textureSampleLevel(inset_depth_texture, nearest_sampler, _e36, 0f);
        depth = _e37.x;
        let _e41 = synthesis.inset_source[0u];
        let _e43 = (*place)[0u];
        let _e47 = synthesis.inset_source[1u];
        let _e51 = synthesis.inset_source[2u];
        let _e52 = depth;
        source = (((_e41 * _e43) + _e47) + (_e51 * _e52));
        let _e55 = source;
        let _e58 = share;
        share = select(0f, _e58, (abs(_e55) <= 1f));
    }
    let _e60 = share;
    return _e60;
}

fn composed(place_1: ptr<function, vec2<f32>>) -> vec4<f32> {
    var in_inset: vec2<f32>;
    var at_1: vec2<f32>;
    var share_1: f32;
    var param: vec2<f32>;
    var param_1: vec2<f32>;
    var color: vec4<f32>;
    var around: vec2<f32>;

    let _e16 = synthesis.inset_place;
    let _e18 = (*place_1);
    let _e21 = synthesis.inset_place;
    in_inset = ((_e16.xy * _e18) + _e21.zw);
    let _e25 = synthesis.inset_part;
    let _e27 = in_inset;
    let _e30 = synthesis.inset_part;
    let _e34 = synthesis.inset_bounds;
    let _e37 = synthesis.inset_bounds;
    at_1 = clamp(((_e25.xy * _e27) + _e30.zw), _e34.xy, _e37.zw);
    let _e40 = in_inset;
    param = _e40;
    let _e41 = at_1;
    param_1 = _e41;
    let _e42 = inset_share((&param), (&param_1));
    share_1 = _e42;
    color = vec4<f32>(0f, 0f, 0f, 0f);
    let _e43 = share_1;
    if (_e43 > 0f) {
        let _e45 = share_1;
        let _e46 = at_1;
        let _e47 = textureSampleLevel(inset_map_texture, linear_sampler, _e46, 0f);
        color = (_e47 * _e45);
    }
    let _e49 = share_1;
    if (_e49 < 1f) {
        let _e52 = synthesis.wide_place;
        let _e54 = (*place_1);
        let _e57 = synthesis.wide_place;
        let _e61 = synthesis.wide_bounds;
        let _e64 = synthesis.wide_bounds;
        around = clamp(((_e52.xy * _e54) + _e57.zw), _e61.xy, _e64.zw);
        let _e67 = share_1;
        let _e69 = around;
        let _e70 = textureSampleLevel(wide_map_texture, linear_sampler, _e69, 0f);
        let _e72 = color;
        color = (_e72 + (_e70 * (1f - _e67)));
    }
    let _e74 = color;
    return _e74;
}

fn main_1() {
    var param_2: vec2<f32>;

    let _e5 = synthesis.eye_place;
    let _e7 = gl_FragCoord_1;
    let _e11 = synthesis.eye_place;
    param_2 = ((_e5.xy * _e7.xy) + _e11.zw);
    let _e14 = composed((&param_2));
    color_1 = _e14;
    return;
}

@fragment 
fn main(@builtin(position) gl_FragCoord: vec4<f32>) -> @location(0) vec4<f32> {
    gl_FragCoord_1 = gl_FragCoord;
    main_1();
    let _e3 = color_1;
    return _e3;
}
