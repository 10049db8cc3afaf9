// Window depth of an image: a depth texture, a texture with a float channel or, with DEPTH_PAIRS, one with the reversed
// depth of two of each pixel's samples. With LAYER the texture is an array.
#ifdef LAYER
uniform highp sampler2DArray depth_map;
uniform int view_layer;
#define DEPTH_TEXEL(p) texelFetch(depth_map, ivec3(p, view_layer), 0)
#else
uniform highp sampler2D depth_map;
#define DEPTH_TEXEL(p) texelFetch(depth_map, p, 0)
#endif

float depth_of(ivec2 p) {
#ifdef DEPTH_PAIRS
    vec2 pair = DEPTH_TEXEL(p).xy;
    return max(pair.x, pair.y);
#else
    return DEPTH_TEXEL(p).x;
#endif
}
