#version 310 es
// Any view, pass 2: for each target tile, the stored depth at which the searches of its pixels start. It is that of the
// nearest step of their segments in which a source tile holds a depth of the step.
//
// The segments of the tile's pixels are walked together, from the places of the near plane to those of the far plane,
// in steps of about a tile. In each step, the pixels lie within the places of the tile's corners at both ends of the
// step.

#include "include/any_view.glsl"

TEXTURE(2) uniform highp usampler2D tile_map;

// The bits of the depth.
layout(location = 0) out uvec4 span;

const float MAX_STEPS = 64.0;

// The smallest and the largest of four.
vec2 range_of(vec4 v) {
    vec2 least = min(v.xy, v.zw);
    vec2 most = max(v.xy, v.zw);
    return vec2(min(least.x, least.y), max(most.x, most.y));
}

// True if a tile of the source within these pixels has a depth between these two.
bool holds(vec4 place, float from, float to) {
    ivec2 last = source_size - 1;
    ivec2 first = clamp(ivec2(floor(place.xz)), ivec2(0), last) / TILE;
    ivec2 end = clamp(ivec2(floor(place.yw)), ivec2(0), last) / TILE;
    bool found = false;
    for (int y = first.y; y <= end.y && !found; ++y) {
        for (int x = first.x; x <= end.x && !found; ++x) {
            uvec2 bounds = texelFetch(tile_map, ivec2(x, y), 0).rg;
            found = uintBitsToFloat(bounds.x) <= max(from, to) && uintBitsToFloat(bounds.y) >= min(from, to);
        }
    }
    return found;
}

void main() {
    // Columns and rows of the tile's corners in the target.
    vec4 x = floor(gl_FragCoord.x) * float(TILE.x) + vec4(0, TILE.x, 0, TILE.x);
    vec4 y = floor(gl_FragCoord.y) * float(TILE.y) + vec4(0, 0, TILE.y, TILE.y);
    vec4 scale = to_source_w.x * x + to_source_w.y * y + to_source_w.z;
    vec4 infinity_x = (to_source_x.x * x + to_source_x.y * y + to_source_x.z) / scale;
    vec4 infinity_y = (to_source_y.x * x + to_source_y.y * y + to_source_y.z) / scale;
    vec4 parallax_x = to_source_x.w - to_source_w.w * infinity_x;
    vec4 parallax_y = to_source_y.w - to_source_w.w * infinity_y;
    float farthest = source_law.x + source_law.y * far_depth;
    float reach = source_law.y * (nearest - far_depth);
    vec4 far_x = infinity_x + farthest * parallax_x - 0.5;
    vec4 far_y = infinity_y + farthest * parallax_y - 0.5;
    vec2 moved = max(abs(range_of(reach * parallax_x)), abs(range_of(reach * parallax_y)));
    float steps = clamp(ceil(max(moved.x, moved.y) / float(TILE.x)), 1.0, MAX_STEPS);
    // A margin of one pixel for rounding.
    const vec4 MARGIN = vec4(-1, 1, -1, 1);
    bool found = false;
    float from = 1.0;
    for (float left = steps; left > 0.0 && !found; left -= 1.0) {
        from = left / steps;
        float to = (left - 1.0) / steps;
        vec2 columns = range_of(far_x + from * reach * parallax_x);
        vec2 rows = range_of(far_y + from * reach * parallax_y);
        vec2 next_columns = range_of(far_x + to * reach * parallax_x);
        vec2 next_rows = range_of(far_y + to * reach * parallax_y);
        vec4 place = vec4(min(columns.x, next_columns.x), max(columns.y, next_columns.y), min(rows.x, next_rows.x),
            max(rows.y, next_rows.y));
        found = holds(place + MARGIN, mix(far_depth, nearest, from), mix(far_depth, nearest, to));
    }
    // If nothing is found, the searches look everywhere and find the border.
    span = uvec4(floatBitsToUint(mix(far_depth, nearest, found ? from : 1.0)), 0u, 0u, 0u);
}
