// The sky where no surface was drawn: display-referred, with luma in alpha. It is drawn at the far plane's depth.
#include "include/shade.glsl"

uniform vec2 view_origin;   // lower left corner of the view in the target
uniform vec2 pixel_extent;  // 1 / size of the view in pixels
uniform float exposure;
// Of each view, in world axes at distance 1: the ray through the lower left corner, from the left edge to the right, from
// the bottom edge to the top.
#ifdef MULTIVIEW
uniform mat3 rays[2];
flat in int v_view;
#define RAYS rays[v_view]
#else
uniform mat3 rays[1];
#define RAYS rays[0]
#endif

layout(location = 0) out vec4 out_color;
#include "include/carried.glsl"
#include "include/hole_bloom.glsl"

void main() {
    vec3 ray = RAYS * vec3(1.0, (gl_FragCoord.xy - view_origin) * pixel_extent);
    vec3 c = with_view_bloom(tonemap(exposure * background(normalize(ray))), gl_FragCoord.z);
    out_color = vec4(c, luma(c));
    CARRY_DEPTH(0.0)
}
