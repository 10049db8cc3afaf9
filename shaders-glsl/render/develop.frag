// What comes after the samples of a pixel are averaged: bloom and ink outlines, in scene-referred colour, to which the
// tone curve leads back. Writes display-referred sRGB with luma in alpha.
#include "include/color.glsl"
#include "include/view.glsl"

uniform sampler2D source;
#ifdef BLOOM
uniform sampler2D bloom;
uniform float bloom_strength;  // times the exposure
#endif
#ifdef INK
#if SAMPLES > 1
uniform highp sampler2DMS depth_map;
uniform highp sampler2DMS color_map;  // material in alpha
int ink_sample;
#define INK_DEPTH(p) texelFetch(depth_map, p, ink_sample).x
#define INK_MATERIAL(p) texelFetch(color_map, p, ink_sample).a
#else
uniform sampler2D depth_map;
#define INK_DEPTH(p) texelFetch(depth_map, p, 0).x
#define INK_MATERIAL(p) texelFetch(source, p, 0).a
#endif
#include "include/ink.glsl"

// The share of the pixel that is ink: each sample looks at the same one of its neighbours.
float ink_share(ivec2 p) {
    ivec2 last = textureSize(source, 0) - 1;
#if SAMPLES > 1
    float share = 0.0;
    for (ink_sample = 0; ink_sample < SAMPLES; ++ink_sample) {
        float depth = INK_DEPTH(p);
        share += depth == far_depth ? 0.0 : ink(p, last, depth, INK_MATERIAL(p));
    }
    return share / float(SAMPLES);
#else
    float depth = INK_DEPTH(p);
    return depth == far_depth ? 0.0 : ink(p, last, depth, INK_MATERIAL(p));
#endif
}
#endif

layout(location = 0) out vec4 out_color;

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    vec3 c = undo_tonemap(texelFetch(source, p, 0).rgb);
#ifdef INK
    // The ink takes some of the surface's colour, here that of the lit surface.
    c *= 1.0 - 0.95 * ink_share(p);
#endif
#ifdef BLOOM
    c += bloom_strength * texture(bloom, (vec2(p) + 0.5) / vec2(textureSize(source, 0))).rgb;
#endif
    c = tonemap(c);
    out_color = vec4(c, luma(c));
}
