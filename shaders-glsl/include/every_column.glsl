#include "include/march.glsl"

// The search of a fragment, column by column: for CPU rasterizers and for OpenGL ES 3.0.

// State of the search. Integer columns are columns of the image here, not forward columns.
struct Search {
    int column;
    // Position of the column, and where the surfaces of the previous column and of this one land, all relative to the
    // pixel.
    float shift;
    float a;
    float b;
    // Depths of the previous column and of this one.
    float depth;
    float next;
    bool found;
    // Column and depth of the hole's background.
    int edge;
    float edge_depth;
#ifdef HISTORY
    // law.y * depth of the foreground beside the hole.
    float front;
#endif
    // The nearest silhouette beside the pixel.
    int rim;
    float rim_depth;
};

// Number of tiles that are always walked: skipping pays only where there are many.
const float FIRST_TILES = 4.0;

// Returns the first column from `x` on, where a tile begins, whose tile lands within a pixel of the target pixel, or
// else the start of the last tile before `end`. Beside the silhouettes of near surfaces, this skips hundreds of
// columns. A surface on the far plane lands on the pixel from column `origin`.
float next_candidate(float x, float end, float origin, int row) {
    bool lands = false;
    while (x + float(TILE.x) < end && !lands) {
        uint moved = texelFetch(tile_map, ivec2(int(x), row) / TILE, 0).r;
        vec2 at = x - origin + vec2(moved & 0xffffu, moved >> 16) / TILE_UNITS;
        lands = at.x <= 1.0 && at.y + float(TILE.x) >= -1.0;
        x += lands ? 0.0 : float(TILE.x);
    }
    return x;
}

// Moves the search to forward column x, where a tile begins.
void leap(inout Search at, float x, float origin, int row) {
    at.column = source_column(int(x));
    at.shift = x - origin;
    at.next = depth_texel(at.column, row);
    at.b = at.shift + law.y * at.next;
}

// Walks column by column until the surface is found, or to forward column `end`.
void walk(inout Search at, float end, float origin, int row) {
    // Halfway between two columns, since positions are rounded.
    float limit = end - origin - 0.5;
    int step = mirrored ? -1 : 1;
    while (at.shift < limit && !at.found) {
        at.a = at.b;
        at.depth = at.next;
        int here = at.column;
        at.column += step;
        at.shift += 1.0;
        at.next = depth_texel(at.column, row);
        at.b = at.shift + law.y * at.next;
        at.found = is_seen(at.a, at.b);
        bool fold = folds(at.a, at.b);
        bool nearest = has_rim(at.a, at.b) && at.rim < 0;
        at.rim = nearest ? (fold ? here : at.column) : at.rim;
        at.rim_depth = nearest ? (fold ? at.depth : at.next) : at.rim_depth;
        bool farther = jumps(at.a, at.b) && law.y * (at.depth - at.edge_depth) < 0.0;
        at.edge = farther ? here : at.edge;
        at.edge_depth = farther ? at.depth : at.edge_depth;
#ifdef HISTORY
        at.front = farther ? law.y * at.next : at.front;
#endif
    }
}

// Returns the colour and the surface of a pixel. Column x lands at x - origin + law.y * depth, relative to the pixel.
// The search starts at column `x`, which has the depth `next` and lands at `b`, and takes at most `steps` steps.
//
// A silhouette that crosses the pixel is blended over what lies behind it. Where the row jumps over the pixel from a
// farther to a nearer surface, there is a disocclusion: the farthest such jump is remembered, and the hole is filled
// from its background side.
vec4 march(float origin, int row, float steps, float x, float b, float next, out Surface surface) {
    float last_column = float(source_size.x - 1);
    // Columns beyond the borders repeat them.
    b -= x;
    x = clamp(x, 0.0, last_column);
    b += x;
    // Left of all surfaces, the border of the image is the background.
    bool outside = x == 0.0 && b > 0.0;
    float end = outside && b < 0.5 ? x : min(x + steps, last_column);
    int column = source_column(int(x));
    int edge = outside ? column : -1;
    float edge_depth = outside ? next : law.y < 0.0 ? -1e9 : 1e9;
#ifdef HISTORY
    Search at = Search(column, x - origin, b, b, next, next, false, edge, edge_depth, 1e9, -1, 0.0);
#else
    Search at = Search(column, x - origin, b, b, next, next, false, edge, edge_depth, -1, 0.0);
#endif
#ifndef TEXTURE_GATHER
    // Nearly every pixel finds its surface within the first tiles. Pixels beside silhouettes of near surfaces continue
    // tile by tile.
    float first = (floor(x / float(TILE.x)) + FIRST_TILES) * float(TILE.x);
    walk(at, min(first, end), origin, row);
    while (at.shift < end - origin - 0.5 && !at.found) {
        x = next_candidate(round(at.shift + origin), end, origin - farthest, row);
        leap(at, x, origin, row);
        walk(at, min(x + float(TILE.x), end), origin, row);
    }
#else
    // CPU rasterizers execute every fetch in the code. They are faster without those of the tiles, except in frames of
    // near surfaces.
    walk(at, end, origin, row);
#endif
    // If nothing is found, take the hole's edge, or the last column if the pixel is right of all surfaces.
    bool own = at.found || at.edge < 0;
    column = own ? at.column : at.edge;
    x = float(source_column(column));
    float t = is_torn(at.a, at.b) ? 0.0 : -at.a / (at.b - at.a);
    t = at.found ? t : 1.0;
    surface.source = x - 1.0 + t;
    surface.depth = mix(at.depth, own ? at.next : at.edge_depth, t);
    float away = x - origin + law.y * surface.depth;
    surface.hole = !at.found && abs(away) >= 0.5;
#ifdef HISTORY
    vec4 color = color_at(surface.source, row);
    bool unknown = surface.hole;
    // A loop instead of an `if`, as in `fill_hole`.
    for (int i = surface.hole ? 0 : 1; i < 1; ++i) {
        unknown = !recall(gl_FragCoord.xy - vec2(target_origin), at.front, origin, row, color, surface.depth);
    }
    color = fill_hole(unknown, color, away, x, surface.depth, row);
#else
    vec4 color = fill_hole(surface.hole, color_at(surface.source, row), away, x, surface.depth, row);
#endif
    // A silhouette lies anywhere between its last sample and the next one, so blend by the share of the pixel that it
    // covers on average.
    if (at.rim >= 0) {
        x = float(source_column(at.rim));
        float coverage = 1.0 - abs(x - origin + law.y * at.rim_depth);
        color = mix(color, texelFetch(color_map, TEXEL_PLACE(in_image(ivec2(at.rim, row))), 0), coverage);
        if (coverage >= 0.5) {
            surface = Surface(x, at.rim_depth, false);
        }
    }
    return color;
}
