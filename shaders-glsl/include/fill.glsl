#include "include/warp.glsl"

// Colour of a disocclusion: the background next to it, from column `edge` of the source's image, of this depth, whose
// colour there is `color`; the edge lands `away` pixels from the target. `color` is also the result where `hole` is
// false: rare work stands in a loop with a dynamic count, since CPU rasterizers and wide GPUs pay for both sides of an
// if.
// Five rows, spread with the distance from the edge, so that the edge's pixels do not smear into streaks; taps that
// are nearer than the edge by more than a pixel of disparity belong to the foreground and are left out.
vec4 fill_hole(bool hole, vec4 color, float away, int edge, float depth, int row) {
    float spread = 0.5 * clamp(abs(away), 1.0, 12.0);
    vec4 sum = 2.0 * color;
    float weights = 2.0;
    // Two rows at a time: one below and one above.
    for (int i = hole ? 1 : 3; i <= 2; ++i) {
        int distance = int(round(float(i) * spread));
        ivec2 below = ivec2(edge, max(row - distance, 0));
        ivec2 above = ivec2(edge, min(row + distance, source_size.y - 1));
        vec2 depths = vec2(depth_texel(below.x, below.y), depth_texel(above.x, above.y));
        vec2 weight = vec2(lessThanEqual(law.y * (depths - depth), vec2(1.0)));
        sum += weight.x * texelFetch(color_map, in_image(below), 0)
            + weight.y * texelFetch(color_map, in_image(above), 0);
        weights += weight.x + weight.y;
    }
    return sum / weights;
}
