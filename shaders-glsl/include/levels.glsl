// An eye that is composed of two levels: a wide view, and an inset of more pixels that covers a part of it. `composed` is
// the eye's colour at a place in its image, for the composer's pass or for a pass that reads the eye anyway, such as the
// lenses'. Places are from 0 to 1. app/engines/core/src/synthesis/levels.rs fills the block.

#include "include/interface.glsl"

// Not filtered; read only if inset_source.z is not 0.
TEXTURE(0) uniform highp sampler2D inset_depth;
// Filtered linearly.
TEXTURE(1) uniform sampler2D wide_map;
TEXTURE(2) uniform sampler2D inset_map;

#ifdef UNIFORM_BLOCK
UNIFORM_BLOCK uniform Levels {
#endif
// Place in the eye's image: eye_place.xy * gl_FragCoord.xy + eye_place.zw. For the composer's pass alone.
UNIFORM vec4 eye_place;
// Texture coordinates of the wide view at a place in the eye's image: wide_place.xy * place + wide_place.zw; and the middles of its
// outermost pixels.
UNIFORM vec4 wide_place;
UNIFORM vec4 wide_bounds;
// Place in the inset at a place in the eye's image, and texture coordinates there.
UNIFORM vec4 inset_place;
UNIFORM vec4 inset_part;
UNIFORM vec4 inset_bounds;
// With the stored depth d, what the inset shows at the place x comes from inset_source.x * x + inset_source.y +
// inset_source.z * d in the rendered image, whose borders are at -1 and 1.
UNIFORM vec4 inset_source;
// How fast the inset fades in from its border: 1 / fade in places. Large for a hard seam.
UNIFORM vec2 inset_ramp;
#ifdef UNIFORM_BLOCK
};
#endif

// How much is seen of the inset at one of its places: 0 outside, and where it has a hole at the border of what was
// rendered, which the wide view fills better.
float inset_share(vec2 place, vec2 at) {
    vec2 within = min(place, 1.0 - place) * inset_ramp;
    float share = clamp(min(within.x, within.y), 0.0, 1.0);
    if (share > 0.0 && inset_source.z != 0.0) {
        float depth = textureLod(inset_depth, at, 0.0).r;
        float source = inset_source.x * place.x + inset_source.y + inset_source.z * depth;
        share = abs(source) <= 1.0 ? share : 0.0;
    }
    return share;
}

vec4 composed(vec2 place) {
    vec2 in_inset = inset_place.xy * place + inset_place.zw;
    vec2 at = clamp(inset_part.xy * in_inset + inset_part.zw, inset_bounds.xy, inset_bounds.zw);
    float share = inset_share(in_inset, at);
    vec4 color = vec4(0.0);
    if (share > 0.0) {
        color = share * textureLod(inset_map, at, 0.0);
    }
    if (share < 1.0) {
        vec2 around = clamp(wide_place.xy * place + wide_place.zw, wide_bounds.xy, wide_bounds.zw);
        color += (1.0 - share) * textureLod(wide_map, around, 0.0);
    }
    return color;
}
