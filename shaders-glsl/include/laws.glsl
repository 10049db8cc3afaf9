#include "include/planes.glsl"

// The laws of target tiles, computed from the tile map.

// The maximum number of source tiles that may land in a target tile with a law.
const int LAW_TILES = 4;

// Returns where the source tile's first column lands in the tile's first and last row, and how much the displacement
// changes from one column to the next.
vec3 landing(int source_tile, int row) {
    vec3 plane = uintBitsToFloat(texelFetch(tile_map, ivec2(source_tile, row), 0).yzw);
    float first = float(source_tile * TILE.x) + plane.x;
    return vec3(first, first + float(TILE.y - 1) * plane.z, plane.y);
}

// True if this row of tiles contains target rows beyond the source, which repeat the source's border.
bool repeats_border(int row) {
    int rows = (source_size.y + TILE.y - 1) / TILE.y;
    return (row == 0 && row_offset > 0) || (row == rows - 1 && target_size.y - row_offset > source_size.y);
}

// Returns the law of a target tile in which source tiles `left` to `right` may land: the source's texture coordinate is
// x + y * gl_FragCoord.x + z * gl_FragCoord.y. Returns 0 if no law holds within PLANAR.
//
// If all these tiles are planes, what lands is one continuous surface, since a tile's plane includes the column after
// it. The source column is affine in the pixel where their planes agree.
vec3 tile_plane(ivec2 tile, int left, int right) {
    if (left > right || right >= left + LAW_TILES || repeats_border(tile.y)) {
        return vec3(0.0);
    }
    float first = float(tile.x * TILE.x);
    float last = first + float(TILE.x - 1);
    // Source columns that land in the tile's corners: left and right in its first row, then left and right in its last
    // row.
    vec4 ends = vec2(first, last).xyxy;
    vec4 corners = vec4(0.0);
    bool planar = true;
    for (int s = left; s <= right; ++s) {
        vec3 lands = landing(s, tile.y);
        planar = planar && lands.z < NO_PLANE;
        vec4 place = float(s * TILE.x) + (ends - lands.xxyy) / (1.0 + lands.z);
        corners = mix(corners, place, s == left ? bvec4(true) : lessThanEqual(lands.xxyy, ends));
    }
    vec2 slope = vec2(corners.y - corners.x, corners.z - corners.x) / vec2(TILE.x - 1, TILE.y - 1);
    float error = abs(corners.w - corners.y - corners.z + corners.x);
    // The surface may be bent where one tile ends and the next one begins.
    for (int next = left + 1; next <= right; ++next) {
        vec2 lands = landing(next, tile.y).xy;
        vec2 off = abs(corners.xz + slope.x * (lands - first) - float(next * TILE.x));
        bvec2 inside = lessThan(abs(lands - 0.5 * (first + last)), vec2(0.5 * (last - first)));
        error = max(error, max(inside.x ? off.x : 0.0, inside.y ? off.y : 0.0));
    }
    vec4 middle = vec4(0.5 * float(source_size.x - 1));
    if (!planar || !(error <= PLANAR) || any(greaterThan(abs(corners - middle), middle))) {
        return vec3(0.0);
    }
    // The pixel's target column is origins.x * gl_FragCoord.x + origins.y + law.x, its row in the source
    // gl_FragCoord.y - first_row - 0.5.
    float column = corners.x + slope.x * (origins.y + law.x - first)
        - slope.y * (first_row + 0.5 + float(tile.y * TILE.y));
    return vec3(columns.x * (column + 0.5) + columns.y, columns.x * slope * vec2(origins.x, 1.0));
}
