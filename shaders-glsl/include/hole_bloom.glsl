// The bloom of a surface in a hole of the synthesized eye: the rendered view's, where the surface lies there.
#include "include/bloom.glsl"

#ifdef BLOOM
// The fragment's column minus that in the view is x + y * depth, its row minus that in the view z.
uniform vec4 to_view;
uniform vec2 view_texel;  // 1 / size of the view

vec3 with_view_bloom(vec3 c, float depth) {
    vec2 moved = vec2(to_view.x + to_view.y * depth, to_view.z);
    return with_bloom(vec4(c, 0.0), (gl_FragCoord.xy - moved) * view_texel).rgb;
}
#else
#define with_view_bloom(c, depth) (c)
#endif
