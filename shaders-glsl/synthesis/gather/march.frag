#version 310 es
// Gather, pass 3: for each target pixel, walk along the source row from the nearest candidate outwards,
// past the tiles that do not land in the pixel.
//
// The first place where the displaced row crosses the pixel is the visible surface, and its fractional column is
// fetched with linear filtering. With SHORT_WAY nearly every pixel ends within a few cheap steps here, and only those
// beside silhouettes continue in include/march.glsl. CPU rasterizers execute both sides of an `if` and every fetch in the
// text: there all pixels take the long path.

#include "include/march.glsl"

layout(location = 0) out vec4 color;
#ifdef SOURCE_MAP
layout(location = 1) out uint source_entry;
#endif

#ifdef SHORT_WAY
// Steps of the short path: as many as a wave should wait for.
const float SHORT_STEPS = 8.0;
#endif

int source_row() {
    return int(clamp(gl_FragCoord.y - first_row, 0.0, float(source_size.y - 1)));
}

#ifdef SHORT_WAY
// Depth at the middle of a whole forward column, which may lie beyond the borders.
float depth_beyond(float x, int row) {
    return depth_at(int(clamp(x, 0.0, float(source_size.x - 1))), row);
}
#endif

void main() {
    float origin = origins.x * gl_FragCoord.x + origins.y;
    uint span = pixel_span();
    float x = floor(origin - farthest - uintBitsToFloat(span));
    Surface surface;
#ifdef SHORT_WAY
    // Where columns x and x + 1 land, relative to the pixel. Columns beyond the borders repeat them. A quarter of a
    // column past the middle of x, fetches of four texels take x and x + 1, and those of one x; a quarter of a row
    // past the row's middle, they take its row and the one above.
    // A part's borders are not those of the texture.
    vec2 at = vec2(columns.x * (x + 1.25) + columns.y, rows.x * (gl_FragCoord.y + 0.25) + rows.y);
    vec2 depths;
    if (PART) {
        depths = vec2(depth_beyond(x, source_row()), depth_beyond(x + 1.0, source_row()));
    } else {
        vec4 quad = textureGather(depth_map, at);
        depths = mirrored ? quad.zw : quad.wz;
    }
    float shift = x - origin;
    float a = shift + law.y * depths.x;
    shift += 1.0;
    float b = shift + law.y * depths.y;
    // On to the first pair that crosses the pixel, or has a silhouette within a pixel of it.
    for (float limit = x + SHORT_STEPS; x < limit && b <= 0.0 && max(b, -1.0) >= a; x += 1.0) {
        COUNT_TRIP(0)
        shift += 1.0;
        at.x += columns.x;
        float next = PART ? depth_beyond(x + 2.0, source_row()) : textureLod(depth_map, at, 0.0).r;
        depths = vec2(depths.y, next);
        a = b;
        b = shift + law.y * depths.y;
    }
    float stretch = b - a;
    float t = -a / stretch;
    surface = Surface(x + t, mix(depths.x, depths.y, t), false);
    at = vec2(columns.x * (surface.source + 0.5) + columns.y, rows.x * gl_FragCoord.y + rows.y);
    at.y = PART ? (float(source_origin.y + source_row()) + 0.5) * texel.y : at.y;
    color = textureLod(color_map, at, 0.0);
    float middle = 0.5 * float(source_size.x - 1);
    bool done = a <= 0.0 && b > 0.0 && stretch < MAX_STRETCH && abs(surface.source - middle) <= middle;
#ifdef SHORT_WAY_ALONE
    // For measuring: what every pixel runs.
    done = true;
#endif
    if (!done) {
        color = march(origin, source_row(), span_steps(span), x, a, depths.x, surface);
    }
#else
    int row = source_row();
    float depth = depth_at(int(clamp(x, 0.0, float(source_size.x - 1))), row);
    color = march(origin, row, span_steps(span), x, x - origin + law.y * depth, depth, surface);
#endif
#ifdef COUNT_TRIPS
    color = vec4(trips[0] | trips[2] << 4 | (done ? 0 : 128), trips[1], trips[3], trips[4]) / 255.0;
#endif
#ifdef WRITE_DEPTH
    gl_FragDepth = surface.depth;
#endif
#ifdef SOURCE_MAP
    source_entry = uint(surface.source * FIXED + 0.5) | (surface.hole ? HOLE : 0u);
#endif
}
