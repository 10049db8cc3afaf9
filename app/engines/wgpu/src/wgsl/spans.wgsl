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

var<private> gl_FragCoord_1: vec4<f32>;
@group(0) @binding(7) 
var<uniform> synthesis: Synthesis;
@group(0) @binding(2) 
var tile_map_texture: texture_2d<u32>;
var<private> span: vec4<u32>;

fn pack_span(reach: ptr<function, f32>, columns: ptr<function, f32>) -> u32 {
    let _e4 = (*reach);
    let _e8 = (*columns);
    return (((bitcast<u32>(_e4) + 1023u) & 4294966272u) | min(u32(_e8), 1023u));
}

fn main_1() {
    var tile: vec2<i32>;
    var first: f32;
    var last: f32;
    var tiles: i32;
    var from_: i32;
    var to: i32;
    var least: i32;
    var most: i32;
    var low: i32;
    var high: i32;
    var left: i32;
    var right: i32;
    var s: i32;
    var moved: u32;
    var lowest: i32;
    var highest: i32;
    var search: u32;
    var param: f32;
    var param_1: f32;

    let _e36 = gl_FragCoord_1;
    tile = vec2<i32>(_e36.xy);
    let _e40 = tile[0u];
    first = f32((_e40 * 16i));
    let _e43 = first;
    last = (_e43 + 15f);
    let _e47 = synthesis.source_size[0u];
    tiles = (((_e47 + 16i) - 1i) / 16i);
    let _e51 = first;
    let _e53 = synthesis.near_displacement;
    let _e60 = tiles;
    from_ = clamp((i32(floor((((_e51 - _e53) - 1f) / 16f))) - 1i), 0i, (_e60 - 1i));
    let _e63 = last;
    let _e65 = synthesis.far_displacement;
    let _e71 = tiles;
    to = clamp(i32(floor((((_e63 - _e65) + 1f) / 16f))), 0i, (_e71 - 1i));
    let _e74 = first;
    let _e77 = synthesis.far_displacement;
    let _e79 = from_;
    least = i32(floor(((((_e74 - 1f) - _e77) - f32(((_e79 + 1i) * 16i))) * 16f)));
    let _e87 = last;
    let _e90 = synthesis.far_displacement;
    let _e92 = from_;
    most = i32(ceil(((((_e87 + 1f) - _e90) - f32((_e92 * 16i))) * 16f)));
    low = 65535i;
    high = 0i;
    let _e99 = tiles;
    left = _e99;
    right = 0i;
    let _e100 = from_;
    s = _e100;
    loop {
        let _e101 = s;
        let _e102 = to;
        if (_e101 <= _e102) {
            let _e104 = s;
            let _e106 = tile[1u];
            let _e108 = textureLoad(tile_map_texture, vec2<i32>(_e104, _e106), 0i);
            moved = _e108.x;
            let _e110 = moved;
            let _e113 = least;
            lowest = max(bitcast<i32>((_e110 & 65535u)), _e113);
            let _e115 = moved;
            let _e119 = most;
            highest = min(bitcast<i32>((_e115 >> bitcast<u32>(16i))), _e119);
            let _e121 = lowest;
            let _e122 = highest;
            if (_e121 <= _e122) {
                let _e124 = low;
                let _e125 = lowest;
                low = min(_e124, _e125);
                let _e127 = high;
                let _e128 = highest;
                high = max(_e127, _e128);
                let _e130 = left;
                let _e131 = s;
                left = min(_e130, _e131);
                let _e133 = s;
                right = _e133;
            }
            let _e134 = least;
            least = (_e134 - 256i);
            let _e136 = most;
            most = (_e136 - 256i);
            continue;
        } else {
            break;
        }
        continuing {
            let _e138 = s;
            s = (_e138 + 1i);
        }
    }
    let _e140 = high;
    let _e141 = low;
    if (_e140 < _e141) {
        let _e144 = tile[0u];
        let _e149 = synthesis.target_size[0u];
        let _e151 = select(0i, 65535i, (((2i * _e144) * 16i) < _e149));
        high = _e151;
        low = _e151;
    }
    let _e152 = high;
    let _e155 = high;
    let _e156 = low;
    param = (f32(_e152) / 16f);
    param_1 = (ceil((f32((_e155 - _e156)) / 16f)) + 2f);
    let _e162 = pack_span((&param), (&param_1));
    search = _e162;
    let _e163 = search;
    span = vec4<u32>(_e163, 0u, 0u, 0u);
    return;
}

@fragment 
fn main(@builtin(position) gl_FragCoord: vec4<f32>) -> @location(0) vec4<u32> {
    gl_FragCoord_1 = gl_FragCoord;
    main_1();
    let _e3 = span;
    return _e3;
}
