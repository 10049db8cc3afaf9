// Ink outlines and bloom, after the samples of a pixel are averaged. Writes display-referred sRGB with luma in alpha.
#include "include/color.glsl"
#include "include/view.glsl"

uniform sampler2D source;
uniform ivec2 view_origin;  // lower left corner of the view in the source
uniform ivec2 view_size;
#ifdef BLOOM
uniform sampler2D bloom;
uniform float bloom_strength;  // times the exposure
#endif
#ifdef INK
#if SAMPLES > 1
uniform highp sampler2DMS depth_map;
uniform highp sampler2DMS color_map;
int ink_sample;
#define INK_SAMPLE ink_sample
#define INK_COLOR(p) texelFetch(color_map, (p) + view_origin, INK_SAMPLE)
#else
uniform sampler2D depth_map;
#define INK_SAMPLE 0
#define INK_COLOR(p) texelFetch(source, (p) + view_origin, 0)
#endif
#define INK_DEPTH(p) texelFetch(depth_map, (p) + view_origin, INK_SAMPLE).x
#define INK_MATERIAL(p) INK_COLOR(p).a
#include "include/ink.glsl"

// A sample is compared with the same sample of its neighbours. The ink takes some of the surface's colour.
vec3 inked_sample(ivec2 p) {
    float depth = INK_DEPTH(p);
    vec4 color = INK_COLOR(p);
    return color.rgb * (depth == far_depth ? 1.0 : 1.0 - 0.82 * ink(p, view_size - 1, depth, color.a));
}
#endif

layout(location = 0) out vec4 out_color;

vec3 averaged(ivec2 p) {
#if defined(INK) && SAMPLES > 1
    vec3 sum = vec3(0.0);
    for (ink_sample = 0; ink_sample < SAMPLES; ++ink_sample) {
        sum += inked_sample(p);
    }
    return sum / float(SAMPLES);
#elif defined(INK)
    return inked_sample(p);
#else
    return texelFetch(source, p + view_origin, 0).rgb;
#endif
}

void main() {
    vec3 c = averaged(ivec2(gl_FragCoord.xy));
#ifdef BLOOM
    c = undo_tonemap(c) + bloom_strength * texture(bloom, gl_FragCoord.xy / vec2(view_size)).rgb;
    c = tonemap(c);
#endif
    out_color = vec4(c, luma(c));
}
