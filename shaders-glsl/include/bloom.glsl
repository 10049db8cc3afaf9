// Bloom, which is scene-referred, is added to colours that are display-referred (include/color.glsl).
#include "include/color.glsl"

#ifdef BLOOM
uniform sampler2D bloom;
uniform float bloom_strength;

// Returns a colour with the bloom at its place, in texture coordinates; alpha is luma.
vec4 with_bloom(vec4 color, vec2 place) {
    vec3 c = undo_tonemap(color.rgb) + bloom_strength * textureLod(bloom, place, 0.0).rgb;
    c = tonemap(c);
    return vec4(c, luma(c));
}
#else
vec4 with_bloom(vec4 color, vec2 place) {
    return color;
}
#endif
