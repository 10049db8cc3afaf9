#include "include/span.glsl"
#include "include/planes.glsl"

// The search of a fragment over segments: from each marked pair of columns to the next (include/planes.glsl), or to the
// next tile. Within a segment columns land in order, each less than MAX_STRETCH after the one before. Columns beyond the
// borders repeat them.

TEXTURE(2) uniform highp usampler2D tile_map;

// The surface that a target pixel shows: fractional source column and depth. For a hole they are those of the column
// from which it is filled.
struct Surface {
    float source;
    float depth;
    bool hole;
};

// The background next to a hole: its forward column and depth.
struct Edge {
    float x;
    float depth;
};

// The sample as many rows above the edge.
vec4 tap_beside(Edge edge, float distance, out float nearer) {
    vec2 place = vec2(column_at(edge.x), row_at(distance));
    nearer = law.y * (depth_sample(place) - edge.depth);
    return color_sample(place);
}

#include "include/fill.glsl"

// State of the search: forward column x, the depths of columns x and x + 1, and where they land relative to the pixel.
struct Search {
    float x;
    vec2 depths;
    float a;
    float b;
};

// Depths of forward columns x and x + 1 of the fragment's row.
vec2 depth_pair(float x) {
    if (PART) {
        float row = row_at(0.0);
        return vec2(depth_sample(vec2(column_at(x), row)), depth_sample(vec2(column_at(x + 1.0), row)));
    }
    // A gather at a quarter of a column past the middle of x takes columns x and x + 1; at a quarter of a row past the
    // row's middle, it takes this row and the one above.
    vec4 quad = depth_gather(vec2(columns.x * (x + 1.25) + columns.y, row_at(0.25)));
    return mirrored ? quad.zw : quad.wz;
}

Search search_at(float x, float origin) {
    vec2 depths = depth_pair(x);
    float shift = x - origin;
    return Search(x, depths, shift + law.y * depths.x, shift + 1.0 + law.y * depths.y);
}

// True if the pair of columns that land at a and b crosses the pixel, or has a silhouette within a pixel left of it.
bool is_event(float a, float b) {
    return a <= 0.0 && (b > 0.0 || max(b, -1.0) < a);
}

// Returns the end of the segment that begins at forward column x: the first column of a marked pair, or the end of the
// tile. `below` and `shift` say where the row's marks are in its tile.
float segment_end(float x, int tile_row, bool below, uint shift) {
    uint column = uint(x);
    uint within = column % uint(TILE.x);
    uvec4 tile = texelFetch(tile_map, ivec2(column / uint(TILE.x), tile_row), 0);
    uint marks = (below ? tile.y : tile.w) >> (shift + within);
    marks = tile.z == floatBitsToUint(NO_PLANE) ? marks : 0u;
    return x + lowest_bit(marks | 0x10000u >> within);
}

#ifdef OPEN_HOLES
// True if the row above or below is farther than the surface that a pixel shows. The outermost pixel of a surface shows
// something of what lies beside it in the source, and not of what lies there for this eye.
bool ends_in_row(Surface surface) {
    float column = column_at(floor(surface.source));
    float above = law.y * depth_sample(vec2(column, row_at(1.0)));
    float below = law.y * depth_sample(vec2(column, row_at(-1.0)));
    return law.y * surface.depth - min(above, below) > ROW_GAP;
}

// True if the surface that a pixel shows ends at column x, or at the next one if the pixel shows that, too: the
// column's neighbour is farther by more than a pixel of displacement.
bool is_outermost(float x, vec2 depths, bool shows_next) {
    float before = depth_sample(vec2(column_at(x - 1.0), row_at(0.0)));
    float after = depth_sample(vec2(column_at(x + 2.0), row_at(0.0)));
    float pixel = MAX_STRETCH - 1.0;
    return law.y * (depths.x - before) >= pixel || (shows_next && law.y * (depths.y - after) > pixel);
}
#endif

// What a search has found so far beside the pixel.
struct Beside {
    // Column and depth of the hole's background; the column is negative if there is none.
    float edge;
    float edge_depth;
    // Column and depth of the nearest silhouette; the column is negative if there is none.
    float rim;
    float rim_depth;
};

// Takes an event into account. Returns true if the pair of columns is the visible surface.
bool meet(inout Beside beside, Search at) {
    bool jump = at.b > 0.0;
    bool torn = at.b - at.a >= MAX_STRETCH;
    bool rim = beside.rim < 0.0 && (!jump || (torn && at.b < 1.0));
    beside.rim = rim ? at.x + (jump ? 1.0 : 0.0) : beside.rim;
    beside.rim_depth = rim ? (jump ? at.depths.y : at.depths.x) : beside.rim_depth;
    bool farther = jump && law.y * (at.depths.x - beside.edge_depth) < 0.0;
    beside.edge = farther ? at.x : beside.edge;
    beside.edge_depth = farther ? at.depths.x : beside.edge_depth;
    return jump && (at.a > -0.5 || !torn);
}

// Returns the colour and the surface of a pixel. The search continues where the first steps have ended.
//
// A silhouette that crosses the pixel is blended over what lies behind it. Where the row jumps over the pixel from a
// farther to a nearer surface, there is a disocclusion: the farthest such jump is remembered, and the hole is filled
// from its background side.
vec4 march(Search at, float end, float origin, int row, out Surface surface) {
    // Left of all surfaces, the border of the image is the background.
    float border = at.a - at.x;
    bool outside = at.x <= 0.0 && border > 0.0;
    end = outside && border < 0.5 ? 0.0 : end;
    Beside beside;
    beside.edge = outside ? 0.0 : -1.0;
    beside.edge_depth = outside ? at.depths.x : law.y < 0.0 ? -1e9 : 1e9;
    beside.rim = -1.0;
    beside.rim_depth = 0.0;
    bool found = false;
    if (at.x >= 0.0 && at.x < end && is_event(at.a, at.b)) {
        found = meet(beside, at);
    }
    // The segment's first column, and where it lands.
    float x = max(at.x + 1.0, 0.0);
    float a = at.b + (x - at.x - 1.0);
    int tile_row = row / TILE.y;
    bool below = (row & 4) == 0;
    uint shift = uint(row & 2) << 3;
    bool crosses = false;
    while (x <= end && !found) {
        at = search_at(min(segment_end(x, tile_row, below, shift), end), origin);
        crosses = a <= 0.0 && at.a > 0.0;
        found = crosses;
        if (!crosses && at.x < end && is_event(at.a, at.b)) {
            found = meet(beside, at);
        }
        // Continue after the pair.
        x = found ? x : at.x + 1.0;
        a = found ? a : at.b;
    }
    // Find the pair of the segment's columns that crosses the pixel.
    float last = at.x;
    float b = at.a;
    while (crosses && x < last) {
        at = search_at(clamp(floor(x + (last - x) * a / (a - b)), x, last - 1.0), origin);
        crosses = at.a > 0.0 || at.b <= 0.0;
        bool behind = at.a > 0.0;
        x = behind ? x : at.x + 1.0;
        a = behind ? a : at.b;
        last = behind ? at.x : last;
        b = behind ? at.a : b;
    }
    // If nothing is found, take the hole's edge, or the last column if the pixel is right of all surfaces.
    bool own = found || beside.edge < 0.0;
    x = own ? min(at.x, end) : beside.edge;
    float t = found && at.b - at.a < MAX_STRETCH ? -at.a / (at.b - at.a) : 0.0;
    surface.source = x + t;
    surface.depth = own ? mix(at.depths.x, at.depths.y, t) : beside.edge_depth;
    float away = x - origin + law.y * surface.depth;
    surface.hole = !found && abs(away) >= 0.5;
#ifdef OPEN_HOLES
    bool shows_next = at.b - at.a < MAX_STRETCH;
    if (surface.hole || beside.rim >= 0.0 || (found && is_outermost(at.x, at.depths, shows_next))) {
        discard;
    }
#endif
    vec4 color = color_sample(vec2(column_at(surface.source), row_at(0.0)));
    if (surface.hole) {
        color = fill_hole(Edge(x, surface.depth), color, away);
    }
    // A silhouette lies anywhere between its last sample and the next one, so blend by the share of the pixel that it
    // covers on average.
    if (beside.rim >= 0.0) {
        float coverage = 1.0 - abs(beside.rim - origin + law.y * beside.rim_depth);
        color = mix(color, color_sample(vec2(column_at(beside.rim), row_at(0.0))), coverage);
        if (coverage >= 0.5) {
            surface = Surface(beside.rim, beside.rim_depth, false);
        }
    }
    return color;
}
