// The rendered image: its textures, and places in it. To be included after the declarations of `source_size` and
// `source_origin`.

#include "include/version.glsl"

// Columns and rows of a tile.
const ivec2 TILE = ivec2(16, 8);

#ifdef SOURCE_LAYERS
// The source is one layer of two array textures.
uniform sampler2DArray depth_map;
uniform sampler2DArray color_map;
uniform int source_layer;
#define TEXEL_PLACE(pixel) ivec3(pixel, source_layer)
#define TEXTURE_PLACE(at) vec3(at, float(source_layer))
#else
TEXTURE(0) uniform sampler2D depth_map;
TEXTURE(1) uniform sampler2D color_map;
#define TEXEL_PLACE(pixel) (pixel)
#define TEXTURE_PLACE(at) (at)
#endif

// Converts a pixel of the source to a pixel of its image.
ivec2 in_image(ivec2 pixel) {
    return PART ? source_origin + pixel : pixel;
}

#ifdef DEPTH_PAIRS
// A texel holds the reversed depth of two of the pixel's samples.
float nearest_of(vec4 texel) {
    return max(texel.r, texel.g);
}
#else
float nearest_of(vec4 texel) {
    return texel.r;
}
#endif

// Depth at a column from the left border of the source.
float depth_texel(int column, int row) {
    return nearest_of(texelFetch(depth_map, TEXEL_PLACE(in_image(ivec2(column, row))), 0));
}

// Depth and colour at texture coordinates.
float depth_sample(vec2 place) {
    return nearest_of(textureLod(depth_map, TEXTURE_PLACE(place), 0.0));
}

vec4 color_sample(vec2 place) {
    return textureLod(color_map, TEXTURE_PLACE(place), 0.0);
}

// Depths of the four pixels around a place in texture coordinates, in the order of textureGather.
vec4 depth_gather(vec2 place) {
#ifdef WITHOUT_ES_310
    ivec2 last = textureSize(depth_map, 0).xy - 1;
    ivec2 corner = ivec2(floor(place * vec2(last + 1) - 0.5));
    ivec2 low = clamp(corner, ivec2(0), last);
    ivec2 high = clamp(corner + 1, ivec2(0), last);
    return vec4(
        nearest_of(texelFetch(depth_map, TEXEL_PLACE(ivec2(low.x, high.y)), 0)),
        nearest_of(texelFetch(depth_map, TEXEL_PLACE(high), 0)),
        nearest_of(texelFetch(depth_map, TEXEL_PLACE(ivec2(high.x, low.y)), 0)),
        nearest_of(texelFetch(depth_map, TEXEL_PLACE(low), 0)));
#else
    vec4 quad = textureGather(depth_map, TEXTURE_PLACE(place));
#ifdef DEPTH_PAIRS
    quad = max(quad, textureGather(depth_map, TEXTURE_PLACE(place), 1));
#endif
    return quad;
#endif
}
