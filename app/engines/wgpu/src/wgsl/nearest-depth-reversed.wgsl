// Made of yoro's GLSL by `cargo xtask maintain renew`.
var<private> gl_FragCoord_1: vec4<f32>;
@group(0) @binding(0) 
var sample_depths_texture: texture_multisampled_2d<f32>;
var<private> gl_FragDepth: f32 = 0f;

fn main_1() {
    var pixel: vec2<i32>;
    var nearest: f32;
    var i: i32;
    var depth: f32;

    let _e9 = gl_FragCoord_1;
    pixel = vec2<i32>(_e9.xy);
    let _e12 = pixel;
    let _e13 = textureLoad(sample_depths_texture, _e12, 0i);
    nearest = _e13.x;
    i = 1i;
    loop {
        let _e15 = i;
        let _e16 = textureNumSamples(sample_depths_texture);
        if (_e15 < i32(_e16)) {
            let _e19 = pixel;
            let _e20 = i;
            let _e21 = textureLoad(sample_depths_texture, _e19, _e20);
            depth = _e21.x;
            let _e23 = nearest;
            let _e24 = depth;
            nearest = max(_e23, _e24);
            continue;
        } else {
            break;
        }
        continuing {
            let _e26 = i;
            i = (_e26 + 1i);
        }
    }
    let _e28 = nearest;
    gl_FragDepth = _e28;
    return;
}

@fragment 
fn main(@builtin(position) gl_FragCoord: vec4<f32>) -> @builtin(frag_depth) f32 {
    gl_FragCoord_1 = gl_FragCoord;
    main_1();
    let _e3 = gl_FragDepth;
    return _e3;
}
