#include "include/tiles.glsl"

// Tiles whose displacements lie on a plane. Depth-buffer values are affine on a plane, and so are displacements.
//
// A tile of the tile map holds its interval and, as floats, the displacement of its first pixel and what is added from one
// forward column and from one row to the next; NO_PLANE in place of the second if its pixels are not on one plane.

// Largest distance in pixels of a displacement from its tile's plane.
const float PLANAR = 1.0 / 16.0;
const float NO_PLANE = 9.0;

// The tile at this forward column and row, and the column after it.
uvec4 plane_tile(vec2 corner) {
    const vec2 LAST = vec2(TILE.x, TILE.y - 1);
    vec2 middle = corner + 0.5;
    float first = depth_sample(place_of(middle));
    float right = depth_sample(place_of(middle + vec2(LAST.x, 0.0)));
    float above = depth_sample(place_of(middle + vec2(0.0, LAST.y)));
    float opposite = depth_sample(place_of(middle + LAST));
    vec2 slope = (vec2(right, above) - first) / LAST;
    // Where the corners are not on one plane the interval is that of depth itself, which is tighter.
    slope = abs(law.y * (first - right - above + opposite)) <= 4.0 * PLANAR ? slope : vec2(0.0);
    // Smallest and largest depth above the plane through the first pixel. Two by two texels a fetch, two rows a pass; of the
    // pairs of columns the last overlaps the one before.
    vec4 low = vec4(1e9);
    vec4 high = vec4(-1e9);
    float plane = 0.0;
    // A loop that no compiler unrolls: all the fetches in flight at once would take most of the registers.
    for (float row = corner.y; row < corner.y + float(TILE.y); row += 2.0) {
        for (int i = 0; i <= TILE.x; i += 2) {
            float column = float(min(i, TILE.x - 1));
            vec4 depths = depth_quad(vec2(corner.x + column, row)) - (plane + slope.x * column);
            low = min(low, depths);
            high = max(high, depths);
        }
        plane += 2.0 * slope.y;
    }
    // The second column and row of each fetch; forward columns may run against the texture's.
    vec4 second = slope.x * (mirrored ? vec4(1, 0, 0, 1) : vec4(0, 1, 1, 0)) + slope.y * vec4(1, 1, 0, 0);
    low -= second;
    high -= second;
    low.xy = min(low.xy, low.zw);
    high.xy = max(high.xy, high.zw);
    float least = min(low.x, low.y);
    float most = max(high.x, high.y);
    vec2 rise = slope * LAST;
    float a = displacement(least + min(rise.x, 0.0) + min(rise.y, 0.0));
    float b = displacement(most + max(rise.x, 0.0) + max(rise.y, 0.0));
    vec3 plane_law = vec3(displacement(0.5 * (least + most)), law.y * slope);
    // A surface whose columns land less than half a pixel apart, or MAX_STRETCH and more, is left to the search.
    bool planar = abs(law.y) * (most - least) <= 2.0 * PLANAR && abs(plane_law.y - 0.25) < 0.75;
    return uvec4(pack_interval(min(a, b), max(a, b)), floatBitsToUint(planar ? plane_law : vec3(NO_PLANE)));
}
