#include "include/march.glsl"

// The search of a fragment in steps of four columns: for GPUs. Columns beyond the borders repeat them.

// For measuring, the parts of the text to compile; everywhere else, all.
#ifndef PARTS
#define PARTS 63
#endif
const int LAW = 1;
const int SHORT = 2;
const int LONG = 4;
const int EVENTS = 8;
const int FILL = 16;
const int TILES = 32;

// How far the search is: at forward columns x and x + 1, their depths, and where they land, relative to the pixel.
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
    // A quarter of a column past the middle of x, fetches of four texels take x and x + 1; a quarter of a row past the row's
    // middle, they take its row and the one above.
    vec4 quad = textureGather(depth_map, TEXTURE_PLACE(vec2(columns.x * (x + 1.25) + columns.y, row_at(0.25))));
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

// The same of four pairs.
bvec4 are_events(vec4 a, vec4 b) {
    vec4 landed = mix(max(b, -1.0), vec4(-1e9), greaterThan(b, vec4(0.0)));
    return lessThan(landed, mix(a, vec4(-2e9), greaterThan(a, vec4(0.0))));
}

// Moves the search to the first pair with an event, or to forward column `end`. Returns true if there is an event.
bool walk(inout Search at, float end, float origin) {
    COUNT_TRIP(5)
    bvec4 met = bvec4(false);
    float x = at.x - 4.0;
    float last = at.a;
    while (x + 4.0 < end && !any(met)) {
        COUNT_TRIP(1)
        x += 4.0;
        vec4 depths = vec4(depth_pair(x + 1.0), depth_pair(x + 3.0));
        vec4 places = law.y * depths + (x - origin + vec4(1.0, 2.0, 3.0, 4.0));
        met = are_events(vec4(last, places.xyz), places);
        last = places.w;
    }
    x += met.x ? 0.0 : met.y ? 1.0 : met.z ? 2.0 : met.w ? 3.0 : 4.0;
    at = search_at(min(x, end), origin);
    return any(met) && x < end;
}

// Colour and surface of a pixel. The search is at an event, or at its end.
//
// A silhouette that crosses the pixel is blended over what lies behind. Where the row jumps over the pixel from a
// farther to a nearer surface there is a disocclusion: the farthest such jump is remembered and the hole is
// filled from its background side.
vec4 march(Search at, float end, float origin, int row, out Surface surface) {
    // Column and depth of the hole's background.
    float edge = -1.0;
    float edge_depth = law.y < 0.0 ? -1e9 : 1e9;
#ifdef HISTORY
    // law.y * depth of the foreground beside it.
    float front = 1e9;
#endif
    // The nearest silhouette beside the pixel.
    float rim = -1.0;
    float rim_depth = 0.0;
    if (at.x <= 0.0) {
        // Left of everything the border of the image is the background.
        at = search_at(0.0, origin);
        if (at.a > 0.0) {
            edge = 0.0;
            edge_depth = at.depths.x;
            end = at.a < 0.5 ? 0.0 : end;
        }
    }
    // Nearly every pixel ends within the first tiles; those beside silhouettes of near surfaces go on, tile by tile.
    float stop = (floor(at.x / float(TILE.x)) + FIRST_TILES) * float(TILE.x);
    bool found = false;
    bool met = is_event(at.a, at.b);
    while (at.x < end && !found) {
        if ((PARTS & EVENTS) != 0 && met) {
            COUNT_TRIP(3)
            bool jump = at.b > 0.0;
            bool torn = at.b - at.a >= MAX_STRETCH;
            found = jump && (at.a > -0.5 || !torn);
            bool beside = !jump || (torn && at.b < 1.0);
            bool nearest = beside && rim < 0.0;
            rim = nearest ? at.x + (jump ? 1.0 : 0.0) : rim;
            rim_depth = nearest ? (jump ? at.depths.y : at.depths.x) : rim_depth;
            bool farther = jump && law.y * (at.depths.x - edge_depth) < 0.0;
#ifdef HISTORY
            front = farther ? law.y * at.depths.y : front;
#endif
            edge = farther ? at.x : edge;
            edge_depth = farther ? at.depths.x : edge_depth;
            // Past it.
            at.x += found ? 0.0 : 1.0;
            at.a = found ? at.a : at.b;
        } else if ((PARTS & TILES) != 0 && at.x >= stop) {
            at = search_at(next_candidate(stop, end, origin - farthest, row), origin);
            stop = at.x + float(TILE.x);
        }
        met = !found && walk(at, min(stop, end), origin);
    }
    // Where nothing is found: the hole's edge, or the last column right of everything.
    bool own = found || edge < 0.0;
    float x = own ? min(at.x, end) : edge;
    float t = found && at.b - at.a < MAX_STRETCH ? -at.a / (at.b - at.a) : 0.0;
    surface.source = x + t;
    surface.depth = own ? mix(at.depths.x, at.depths.y, t) : edge_depth;
    float away = x - origin + law.y * surface.depth;
    surface.hole = !found && abs(away) >= 0.5;
    vec4 color = color_sample(vec2(column_at(surface.source), row_at(0.0)));
#ifdef HISTORY
    bool recalled = surface.hole && recall(gl_FragCoord.xy - vec2(target_origin), front, origin, row, color, surface.depth);
    if ((PARTS & FILL) != 0 && surface.hole && !recalled) {
#else
    if ((PARTS & FILL) != 0 && surface.hole) {
#endif
        color = fill_hole(true, color, away, x, surface.depth, row);
    }
    // A silhouette lies anywhere between its last sample and the next one: blend by the share of the pixel that
    // it covers on average.
    if (rim >= 0.0) {
        float coverage = 1.0 - abs(rim - origin + law.y * rim_depth);
        color = mix(color, color_sample(vec2(column_at(rim), row_at(0.0))), coverage);
        if (coverage >= 0.5) {
            surface = Surface(rim, rim_depth, false);
        }
    }
    return color;
}
