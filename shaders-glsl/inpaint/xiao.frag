#version 310 es
// One pass of the background filter of Xiao et al. 2022. It averages the valid pixels in a window of 29x29 around a
// hole's pixel that lie in the farther half of the window's range of inverse depth, with weights that fall with the
// distance. Disparity is averaged alike. Pixels without such neighbours are left to the next pass, for which this
// pass's pixels are valid.

#include "inpaint/holes.glsl"

layout(location = 1) out vec4 disparity;

const int RADIUS = 14;

void main() {
    ivec2 pixel = here();
    color = color_at(pixel.x, pixel.y);
    disparity = vec4(disparity_at(pixel.x, pixel.y));
    // The rare work is in a loop with a dynamic count; see inpaint/holes.glsl.
    bool hole = color.a < 0.5;
    ivec2 low = max(pixel - RADIUS, ivec2(0));
    ivec2 high = min(pixel + RADIUS, size - 1);
    float nearest = -1e9;
    float farthest = 1e9;
    for (int y = hole ? low.y : high.y + 1; y <= high.y; ++y) {
        for (int x = low.x; x <= high.x; ++x) {
            if (!is_hole(x, y)) {
                float d = disparity_at(x, y);
                nearest = max(nearest, d);
                farthest = min(farthest, d);
            }
        }
    }
    float limit = 0.5 * (nearest + farthest);
    vec4 sum = vec4(0.0);
    float weights = 0.0;
    for (int y = hole ? low.y : high.y + 1; y <= high.y; ++y) {
        for (int x = low.x; x <= high.x; ++x) {
            float d = disparity_at(x, y);
            if (!is_hole(x, y) && d <= limit) {
                vec2 away = vec2(x, y) - vec2(pixel);
                float weight = exp(-0.01 * dot(away, away));
                sum += weight * vec4(color_at(x, y).rgb, d);
                weights += weight;
            }
        }
    }
    if (weights > 0.0) {
        sum /= weights;
        color = vec4(sum.rgb, 1.0);
        disparity = vec4(sum.a);
    }
}
