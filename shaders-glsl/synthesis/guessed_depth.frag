#version 310 es
// A guess at each pixel's nearest depth, for anti-aliased images whose depth is that of one sample: all that OpenGL ES
// 3.0 and WebGL 2 resolve. Where a neighbour is nearer and the pixel's colour shows a part of it, the pixel takes the
// neighbour's depth.

#include "include/uniforms.glsl"
#include "include/source.glsl"

// A neighbour is nearer if its surface moves farther between the eyes by more than this, in pixels.
const float NEARER = 0.5;
// The smallest share of the nearer surface in a pixel that counts. Smaller ones cannot be told from shading.
const float SHARE = 0.15;
const ivec2 BESIDE[4] = ivec2[4](ivec2(-1, 0), ivec2(1, 0), ivec2(0, -1), ivec2(0, 1));

// A place in the image. Beyond the source, its border is repeated.
ivec2 place(ivec2 pixel) {
    ivec2 first = PART ? source_origin : ivec2(0);
    return clamp(pixel, first, first + source_size - 1);
}

// Pixels by which the surface moves between the eyes.
float moves(ivec2 pixel) {
    return law.y * texelFetch(depth_map, TEXEL_PLACE(place(pixel)), 0).r;
}

vec3 shown(ivec2 pixel) {
    return texelFetch(color_map, TEXEL_PLACE(place(pixel)), 0).rgb;
}

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    float behind = moves(pixel) + NEARER;
    float nearest = behind;
    ivec2 to = ivec2(0);
    for (int i = 0; i < 4; ++i) {
        float beside = moves(pixel + BESIDE[i]);
        to = beside > nearest ? BESIDE[i] : to;
        nearest = max(nearest, beside);
    }
    gl_FragDepth = texelFetch(depth_map, TEXEL_PLACE(place(pixel)), 0).r;
    if (to != ivec2(0)) {
        // The neighbour itself may be blended, the pixel beyond it is less likely to be. The pixel on the other side
        // shows what lies behind, unless it is nearer, too.
        vec3 front = shown(pixel + (moves(pixel + 2 * to) > behind ? 2 : 1) * to);
        vec3 here = shown(pixel);
        vec3 back = moves(pixel - to) > behind ? here : shown(pixel - to);
        vec3 contrast = front - back;
        if (dot(here - back, contrast) > SHARE * max(dot(contrast, contrast), 1e-4)) {
            gl_FragDepth = texelFetch(depth_map, TEXEL_PLACE(place(pixel + to)), 0).r;
        }
    }
}
