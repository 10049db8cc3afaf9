#include "include/tiles.glsl"
#include "include/bits.glsl"

// Tiles whose displacements lie on a plane. Depth-buffer values are affine on a plane, and so are displacements.
//
// A tile of the tile map holds its interval and, as floats, the displacement of its first pixel and the changes of
// displacement from one forward column and from one row to the next. If its pixels are not on one plane, the second
// float is NO_PLANE, and the other two are marks: 16 bits for every two rows. Bit i is set if, in one of the rows,
// columns i and i + 1 land on one another, or tear, within rounding.

// Largest distance in pixels of a displacement from its tile's plane.
const float PLANAR = 1.0 / 16.0;
const float NO_PLANE = 9.0;
// Two neighbours whose displacements differ by more than this, in pixels, are marked.
const float MARKED = 0.99;

// Converts marks of four rows, collected in the order of the image's columns with the first ones in the highest bits,
// to a bit for each forward column, with the first ones in the lowest bits.
uint in_place(uint marks) {
    return mirrored ? marks >> 16 | marks << 16 : reversed_bits(marks);
}

// Returns the tile at this forward column and row, including the column after it.
uvec4 plane_tile(vec2 corner) {
    const vec2 LAST = vec2(TILE.x, TILE.y - 1);
    vec2 middle = corner + 0.5;
    float first = depth_sample(place_of(middle));
    float right = depth_sample(place_of(middle + vec2(LAST.x, 0.0)));
    float above = depth_sample(place_of(middle + vec2(0.0, LAST.y)));
    float opposite = depth_sample(place_of(middle + LAST));
    vec2 slope = (vec2(right, above) - first) / LAST;
    // If the corners are not on one plane, the interval is that of depth itself, which is tighter.
    slope = abs(law.y * (first - right - above + opposite)) <= 4.0 * PLANAR ? slope : vec2(0.0);
    // Smallest and largest depth relative to the plane through the first pixel. Each fetch takes 2 x 2 texels and each
    // pass two rows, in the order of the image's columns. The last pair of columns overlaps the one before.
    vec4 low = vec4(1e9);
    vec4 high = vec4(-1e9);
    float plane = 0.0;
    // A bit for each pair of neighbours in two rows. `lower_marks` gets those of the first four rows, `marks` ends with
    // those of the last four.
    uint lower_marks = 0u;
    uint marks = 0u;
    float marked = MARKED / abs(law.y);
    float begin = mirrored ? LAST.x - 1.0 : 0.0;
    float sense = mirrored ? -1.0 : 1.0;
    // A loop that no compiler unrolls: all fetches in flight at once would take most of the registers.
    for (float row = corner.y; row < corner.y + float(TILE.y); row += 2.0) {
        lower_marks = row == corner.y + 4.0 ? marks : lower_marks;
        vec2 before = vec2(0.0);
        for (int i = 0; i <= TILE.x; i += 2) {
            float column = begin + sense * float(min(i, TILE.x - 1));
            vec4 quad = depth_quad(vec2(corner.x + column, row));
            vec4 depths = quad - (plane + slope.x * column);
            low = min(low, depths);
            high = max(high, depths);
            vec2 between = abs(quad.xw - before);
            vec2 within = abs(quad.yz - quad.xw);
            before = quad.yz;
            if (i > 0 && i < TILE.x) {
                marks = marks << 1 | uint(max(between.x, between.y) > marked);
            }
            marks = marks << 1 | uint(max(within.x, within.y) > marked);
        }
        plane += 2.0 * slope.y;
    }
    // What the plane adds at the second column and row of each fetch. Forward columns may run against the texture's.
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
    // A surface whose columns land less than half a pixel apart, or MAX_STRETCH or more, is left to the search.
    bool planar = abs(law.y) * (most - least) <= 2.0 * PLANAR && abs(plane_law.y - 0.25) < 0.75;
    uvec3 rest = planar ? floatBitsToUint(plane_law) : uvec3(in_place(lower_marks), floatBitsToUint(NO_PLANE), in_place(marks));
    return uvec4(pack_interval(min(a, b), max(a, b)), rest);
}
