// A reprojected image with holes; app/lab/bench/src/inpaint/mod.rs, `Reprojected`.
//
// Columns are counted "forward", as in synthesis (include/warp.glsl): nearer surfaces have moved further along, so the
// background of a disocclusion is on its left.
//
// The patchers fill holes in loops with dynamic counts, not in an `if`: CPU rasterizers and wide GPUs would pay for
// both of its sides at every pixel.

// Alpha is 1 where the colour is valid and 0 in holes.
uniform sampler2D color_map;
// Disparity in pixels, larger for nearer surfaces; undefined in holes.
uniform sampler2D disparity_map;
uniform ivec2 size;
uniform bool mirrored;

layout(location = 0) out vec4 color;

ivec2 texel(int x, int y) {
    return ivec2(mirrored ? size.x - 1 - x : x, y);
}

vec4 color_at(int x, int y) {
    return texelFetch(color_map, texel(x, y), 0);
}

float disparity_at(int x, int y) {
    return texelFetch(disparity_map, texel(x, y), 0).r;
}

bool is_hole(int x, int y) {
    return color_at(x, y).a < 0.5;
}

bool inside(int x, int y) {
    return x >= 0 && x < size.x && y >= 0 && y < size.y;
}

// Forward column and row of this fragment.
ivec2 here() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    return texel(pixel.x, pixel.y);
}
