// Reads an eye that was synthesized with outlines, with one sample in each pixel: alpha is 1 where it was synthesized, and
// the material in holes. Depth is reversed. With INK, draws outlines in the holes; without, the rest of the eye and its depth.
uniform highp sampler2D color_map;
uniform highp sampler2D depth_map;
#define TEXEL(map, p) texelFetch(map, p, 0)

layout(location = 0) out vec4 out_color;

#ifdef INK
uniform ivec2 view_size;
#define INK_DEPTH(p) TEXEL(depth_map, p).x
// What lies beside a hole counts as the same material, since it is not known.
#define INK_MATERIAL(p) (TEXEL(color_map, p).a == 1.0 ? id : TEXEL(color_map, p).a)
#include "include/ink.glsl"

// Depths that differ by more than this factor belong to different surfaces.
const float SURFACE_GAP = 1.1;

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    // The surface in the middle of the pixel, or one in front of it that may reach into the pixel.
    ivec2 at = p;
    float depth = INK_DEPTH(p);
    for (int i = 0; i < 4; ++i) {
        ivec2 beside = clamp(p + (i < 2 ? ivec2(2 * i - 1, 0) : ivec2(0, 2 * i - 5)), ivec2(0), view_size - 1);
        float d = INK_DEPTH(beside);
        if (d > SURFACE_GAP * depth) {
            at = beside;
            depth = d;
        }
    }
    float line = depth == far_depth ? 0.0 : ink(at, view_size - 1, depth, TEXEL(color_map, at).a);
    // Multiplies the samples that are not behind this surface.
    out_color = vec4(vec3(1.0 - INK_DARKNESS * line), 1.0);
    gl_FragDepth = depth / SURFACE_GAP;
}
#else
#include "include/color.glsl"

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    vec4 color = TEXEL(color_map, p);
    if (color.a != 1.0) {
        discard;
    }
    out_color = vec4(color.rgb, luma(color.rgb));
    gl_FragDepth = TEXEL(depth_map, p).x;
}
#endif
