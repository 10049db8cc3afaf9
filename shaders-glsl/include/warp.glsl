// How columns move from the rendered eye to the other one; app/src/eyes.rs, `Warp`.
//
// All synthesis shaders count columns "forward": in the direction in which nearer surfaces lie further along in
// the target image. That is left to right when the left eye is synthesized and right to left for the right eye,
// so one code serves both. A column's displacement grows with nearness, and of all source pixels that meet at
// one target the nearest has the smallest forward column: the occlusion-compatible order.

uniform sampler2D depth_map;
uniform sampler2D color_map;
uniform ivec2 source_size;
uniform ivec2 target_size;
// Displacement in pixels, in forward columns: law.x + law.y * depth.
uniform vec2 law;
uniform bool mirrored;
// Target row minus source row.
uniform int row_offset;
// Lower left corner of the target in its framebuffer.
uniform ivec2 target_origin;

// Source map entries: this bit marks a hole; the rest is the source column in 1/65536 pixel.
const uint HOLE = 0x80000000u;
const float FIXED = 65536.0;

// A surface that is stretched more than this is taken for two surfaces with a disocclusion between them.
const float MAX_STRETCH = 2.0;

int source_column(int x) {
    return mirrored ? source_size.x - 1 - x : x;
}

float displacement(float depth) {
    return law.x + law.y * depth;
}

float depth_at(int x, int row) {
    return texelFetch(depth_map, ivec2(source_column(x), row), 0).r;
}

float displacement_at(int x, int row) {
    return displacement(depth_at(x, row));
}

// Colour at a fractional forward column, linear between its two neighbours in the row.
vec4 color_at(float x, int row) {
    float column = mirrored ? float(source_size.x - 1) - x : x;
    return textureLod(color_map, (vec2(column, float(row)) + 0.5) / vec2(source_size), 0.0);
}

vec4 color_texel(int x, int row) {
    return texelFetch(color_map, ivec2(source_column(x), row), 0);
}

#ifndef COMPUTE
// Forward target column and source row of this fragment.
ivec2 target_pixel() {
    ivec2 pixel = ivec2(gl_FragCoord.xy) - target_origin;
    int column = mirrored ? target_size.x - 1 - pixel.x : pixel.x;
    return ivec2(column, clamp(pixel.y - row_offset, 0, source_size.y - 1));
}
#endif
