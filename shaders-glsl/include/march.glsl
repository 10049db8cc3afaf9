#include "include/tiles.glsl"
#include "include/fill.glsl"

// What a target pixel shows: the fractional source column, its depth, and whether nothing of the source is seen
// and this is the column it is filled from.
struct Surface {
    float source;
    float depth;
    bool hole;
};

// Colour and surface of a pixel. Column x lands at x - origin + law.y * depth, relative to the pixel. The search starts
// at column `x`, of depth `next`, that lands at `b`, and takes `steps` steps at most.
//
// A silhouette that crosses the pixel is blended over what lies behind. Where the row jumps over the pixel from a
// farther to a nearer surface there is a disocclusion: the farthest such jump is remembered and the hole is
// filled from its background side.
vec4 march(float origin, int row, float steps, float x, float b, float next, out Surface surface) {
    float last_column = float(source_size.x - 1);
    // Columns beyond the borders repeat them.
    b -= x;
    x = clamp(x, 0.0, last_column);
    b += x;
    float shift = x - origin;
    float limit = min(x + steps, last_column) - origin;
    // Whole columns are those of the image here, not forward ones.
    int column = source_column(int(x));
    int step = mirrored ? -1 : 1;
    // Column and depth of the hole's background. Left of everything it is the border of the image.
    bool outside = x == 0.0 && b > 0.0;
    int edge = outside ? column : -1;
    float edge_depth = outside ? next : law.y < 0.0 ? -1e9 : 1e9;
    limit = outside && b < 0.5 ? shift : limit;
    // The nearest silhouette beside the pixel.
    int rim = -1;
    float rim_depth = 0.0;

    bool found = false;
    float a = b;
    float depth = next;
    while (shift < limit && !found) {
        COUNT_TRIP(1)
        a = b;
        depth = next;
        int here = column;
        column += step;
        shift += 1.0;
        next = depth_texel(column, row);
        b = shift + law.y * next;
        bool before = a <= 0.0;
        bool jump = before && b > 0.0;
        bool torn = b - a >= MAX_STRETCH;
        found = jump && (a > -0.5 || !torn);
        bool fold = before && max(b, -1.0) < a;
        bool beside = fold || (jump && torn && b < 1.0);
        bool nearest = beside && rim < 0;
        rim = nearest ? (fold ? here : column) : rim;
        rim_depth = nearest ? (fold ? depth : next) : rim_depth;
        bool farther = jump && law.y * (depth - edge_depth) < 0.0;
        edge = farther ? here : edge;
        edge_depth = farther ? depth : edge_depth;
    }
    // Where nothing is found: the hole's edge, or the last column right of everything.
    edge_depth = found || edge < 0 ? next : edge_depth;
    column = found || edge < 0 ? column : edge;
    x = float(source_column(column));
    float t = b - a < MAX_STRETCH ? -a / (b - a) : 0.0;
    t = found ? t : 1.0;
    surface.source = x - 1.0 + t;
    surface.depth = mix(depth, edge_depth, t);
    float away = x - origin + law.y * surface.depth;
    surface.hole = !found && abs(away) >= 0.5;
    vec4 color = fill_hole(surface.hole, color_at(surface.source, row), away, column, surface.depth, row);
    // A silhouette lies anywhere between its last sample and the next one: blend by the share of the pixel that
    // it covers on average.
    if (rim >= 0) {
        x = float(source_column(rim));
        float coverage = 1.0 - abs(x - origin + law.y * rim_depth);
        color = mix(color, texelFetch(color_map, in_image(ivec2(rim, row)), 0), coverage);
        if (coverage >= 0.5) {
            surface = Surface(x, rim_depth, false);
        }
    }
    return color;
}
