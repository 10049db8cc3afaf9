#include "include/warp.glsl"

// Colour of a disocclusion at forward target column `x`: the background next to it, from source column `edge`
// with its displacement.
// Five rows, spread with the distance from the edge, so that the edge's pixels do not smear into streaks; taps
// that are nearer than the edge by more than a pixel of disparity belong to the foreground and are left out.
// `color` is the colour at the edge, and the result where `hole` is false: rare work stands in a loop with a
// dynamic count, since CPU rasterizers and wide GPUs pay for both sides of an if.
vec4 fill_hole(bool hole, vec4 color, float x, int edge, float background, int row) {
    float spread = 0.5 * clamp(abs(x - float(edge) - background), 1.0, 12.0);
    vec4 sum = 2.0 * color;
    float weights = 2.0;
    for (int i = hole ? 0 : 4; i < 4; ++i) {
        int j = i < 2 ? i - 2 : i - 1;
        int tap_row = clamp(row + int(round(float(j) * spread)), 0, source_size.y - 1);
        float weight = displacement_at(edge, tap_row) > background + 1.0 ? 0.0 : 1.0;
        sum += weight * color_texel(edge, tap_row);
        weights += weight;
    }
    return sum / weights;
}
