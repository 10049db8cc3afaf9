#version 310 es
// The fill of the gather pipeline (include/fill.glsl) on a reprojected image: five rows of the hole's farther end,
// spread with the distance from it; taps that are nearer than it by more than a pixel of disparity are left out.

#include "inpaint/holes.glsl"

void main() {
    ivec2 pixel = here();
    color = color_at(pixel.x, pixel.y);
    // The rare work is in a loop with a dynamic count; see inpaint/holes.glsl.
    for (int once = color.a < 0.5 ? 0 : 1; once < 1; ++once) {
        int left = pixel.x;
        while (left >= 0 && is_hole(left, pixel.y)) {
            --left;
        }
        int right = pixel.x;
        while (right < size.x && is_hole(right, pixel.y)) {
            ++right;
        }
        int edge = left;
        if (left < 0 || (right < size.x && disparity_at(right, pixel.y) < disparity_at(left, pixel.y))) {
            edge = right;
        }
        // A row without any valid pixel stays as it is.
        if (!inside(edge, pixel.y)) {
            continue;
        }
        float background = disparity_at(edge, pixel.y);
        float spread = 0.5 * clamp(float(abs(pixel.x - edge)), 1.0, 12.0);
        vec4 sum = 2.0 * color_at(edge, pixel.y);
        float weights = 2.0;
        for (int i = 0; i < 4; ++i) {
            int j = i < 2 ? i - 2 : i - 1;
            int y = clamp(pixel.y + int(floor(float(j) * spread + 0.5)), 0, size.y - 1);
            float weight = is_hole(edge, y) || disparity_at(edge, y) > background + 1.0 ? 0.0 : 1.0;
            sum += weight * color_at(edge, y);
            weights += weight;
        }
        color = sum / weights;
    }
}
