// The last step of a colour: bloom, which is scene-referred, is added to what is display-referred.
#include "include/color.glsl"
#include "include/hdr.glsl"

#ifdef BLOOM
uniform sampler2D bloom;
uniform float bloom_strength;  // times the exposure

// Returns a colour with the bloom at its place in the view, in texture coordinates; alpha is luma.
vec4 developed(vec4 color, vec2 place) {
    vec3 c = undo_tonemap(color.rgb) + bloom_strength / HDR_SCALE * textureLod(bloom, place, 0.0).rgb;
    c = tonemap(c);
    return vec4(c, luma(c));
}
#else
vec4 developed(vec4 color, vec2 place) {
    return color;
}
#endif
