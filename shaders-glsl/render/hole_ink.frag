// Outlines in the holes of an eye that was synthesized with outlines, of one sample in each pixel: alpha is 1 where it was
// synthesized, and the material in holes. Without INK, the rest of the eye, and its depth.
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

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    float depth = INK_DEPTH(p);
    float line = depth == far_depth ? 0.0 : ink(p, view_size - 1, depth, TEXEL(color_map, p).a);
    // The factor on what is drawn there.
    out_color = vec4(vec3(1.0 - INK_DARKNESS * line), 1.0);
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
