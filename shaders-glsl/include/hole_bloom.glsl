// The bloom of a surface in a hole of the synthesized eye: the rendered view's, where the surface lies there.
#include "include/bloom.glsl"

#ifdef BLOOM
// The fragment's column minus that in what the bloom covers is x + y * depth, its row minus that there z.
uniform vec4 to_bloom;
uniform vec2 bloom_texel;  // 1 / size of what the bloom covers

vec3 with_view_bloom(vec3 c, float depth) {
    vec2 moved = vec2(to_bloom.x + to_bloom.y * depth, to_bloom.z);
    return with_bloom(vec4(c, 0.0), (gl_FragCoord.xy - moved) * bloom_texel).rgb;
}
#else
#define with_view_bloom(c, depth) (c)
#endif
