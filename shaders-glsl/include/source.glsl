// The rendered image: its textures, and places in it. To be included after the declarations of `source_size` and
// `source_origin`.

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

// Depth at a column from the left border of the source.
float depth_texel(int column, int row) {
    return texelFetch(depth_map, TEXEL_PLACE(in_image(ivec2(column, row))), 0).r;
}

// Depth and colour at texture coordinates.
float depth_sample(vec2 place) {
    return textureLod(depth_map, TEXTURE_PLACE(place), 0.0).r;
}

vec4 color_sample(vec2 place) {
    return textureLod(color_map, TEXTURE_PLACE(place), 0.0);
}
