#include "include/warp.glsl"

// Colour of a disocclusion at forward target column `x`: what lies around the edge of the background next to
// it, at source column `edge`. Five rows and two columns, spread with the distance from the edge; taps that are
// nearer than the edge by more than a pixel of disparity belong to the foreground and are left out.
vec4 fill_hole(float x, int edge, int row) {
    float background = displacement_at(edge, row);
    float distance = abs(x - float(edge) - background);
    float spread = 0.5 * clamp(0.5 * distance, 1.0, 6.0);
    int back = 1 + int(distance * 0.25);
    vec4 sum = vec4(0.0);
    float weights = 0.0;
    for (int j = -2; j <= 2; ++j) {
        int tap_row = clamp(row + int(round(float(j) * spread)), 0, source_size.y - 1);
        for (int i = 0; i < 2; ++i) {
            int tap = max(edge - i * back, 0);
            float weight = (j == 0 ? 2.0 : 1.0) * (i == 0 ? 2.0 : 1.0);
            weight = displacement_at(tap, tap_row) > background + 1.0 ? 0.0 : weight;
            sum += weight * color_texel(tap, tap_row);
            weights += weight;
        }
    }
    return sum / weights;
}
