// A part of a rendered view as an eye shows it, with bloom; and its depth, to draw more over it.
#include "include/bloom.glsl"
#ifdef WRITE_DEPTH
#include "include/depth_map.glsl"
#endif

#ifdef LAYER
uniform highp sampler2DArray color_map;
uniform int color_layer;
#define COLOR_TEXEL(p) texelFetch(color_map, ivec3(p, color_layer), 0)
#else
uniform sampler2D color_map;
#define COLOR_TEXEL(p) texelFetch(color_map, p, 0)
#endif
uniform ivec2 offset;        // from a pixel of the target to its pixel in the maps
uniform ivec2 bloom_origin;  // lower left corner in the maps of what the bloom covers, and its size
uniform ivec2 bloom_size;

layout(location = 0) out vec4 out_color;
#include "include/carried.glsl"

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy) + offset;
    out_color = with_bloom(COLOR_TEXEL(p), (vec2(p - bloom_origin) + 0.5) / vec2(bloom_size));
#ifdef WRITE_DEPTH
    float depth = depth_of(p);
    gl_FragDepth = depth;
    CARRY_DEPTH(depth)
#endif
}
