// Averages the samples of a pixel and takes their nearest depth, which is reversed or not. With INK outlines are drawn
// first, in each sample: a sample is compared with the same sample of its neighbours.
#include "include/color.glsl"

#if SAMPLES > 1
uniform highp sampler2DMS color_map;
uniform highp sampler2DMS depth_map;
#define TEXEL(map, p) texelFetch(map, (p) + view_origin, at_sample)
#elif defined(LAYER)
uniform highp sampler2DArray color_map;
uniform highp sampler2DArray depth_map;
uniform int view_layer;
#define TEXEL(map, p) texelFetch(map, ivec3((p) + view_origin, view_layer), 0)
#else
uniform highp sampler2D color_map;
uniform highp sampler2D depth_map;
#define TEXEL(map, p) texelFetch(map, (p) + view_origin, 0)
#endif
uniform float nearer;       // +1: smaller depth is nearer, -1: larger
uniform ivec2 view_origin;  // lower left corner of the view in the maps, and its size
uniform ivec2 view_size;

layout(location = 0) out vec4 out_color;
#ifdef WRITE_DEPTH
layout(location = 1) out vec4 out_depth;  // for targets with depth in a colour attachment
#endif

#if SAMPLES > 1
int at_sample = 0;
#endif
#ifdef INK
#define INK_DEPTH(p) TEXEL(depth_map, p).x
#define INK_MATERIAL(p) TEXEL(color_map, p).a
#include "include/ink.glsl"
#endif

// Colour of a sample. Ink takes some of the surface's colour; alpha is then luma. Otherwise alpha stays, since more is
// drawn over the picture, and outlines later.
vec4 sample_color(ivec2 p, float depth) {
    vec4 color = TEXEL(color_map, p);
#ifdef INK
    color.rgb *= depth == far_depth ? 1.0 : 1.0 - INK_DARKNESS * ink(p, view_size - 1, depth, color.a);
    color.a = luma(color.rgb);
#endif
    return color;
}

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy) - view_origin;
#if SAMPLES > 1
    vec4 sum = vec4(0.0);
    float nearest = 0.0;
    for (at_sample = 0; at_sample < SAMPLES; ++at_sample) {
        float depth = nearer * TEXEL(depth_map, p).x;
        nearest = at_sample == 0 ? depth : min(nearest, depth);
        sum += sample_color(p, nearer * depth);
    }
    out_color = sum / float(SAMPLES);
#else
    float nearest = nearer * TEXEL(depth_map, p).x;
    out_color = sample_color(p, nearer * nearest);
#endif
#ifdef WRITE_DEPTH
    gl_FragDepth = nearer * nearest;
    out_depth = vec4(nearer * nearest);
#endif
}
