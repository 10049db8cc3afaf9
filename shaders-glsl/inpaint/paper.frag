#version 310 es
// Algorithm 3, as corrected, on a reprojected image: see stereo/paper/patch.frag. There, the ImBuffer has both ends of
// the hole; here, they are found by walking.

#include "inpaint/holes.glsl"

// Rows of the kernel, `h` of Algorithm 3.
const int KERNEL_HEIGHT = 3;
// The weights at least halve with each step: columns beyond these would add less than 1/1000.
const int MAX_KERNEL_WIDTH = 10;

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
        // The background is left of a disocclusion, unless the hole reaches the image's border. A row without any valid
        // pixel stays as it is.
        bool bordered = left < 0;
        int edge = bordered ? right : left;
        int direction = bordered ? 1 : -1;
        float foreground = !bordered && right < size.x ? disparity_at(right, pixel.y) : 1e9;
        int width = right - left;
        float base = 0.5 + 0.3 * float(abs(pixel.x - edge)) / float(width);
        vec4 sum = vec4(0.0);
        float remaining = 1.0;
        int columns = min(width, MAX_KERNEL_WIDTH);
        for (int j = 0; j < columns && remaining > 0.001; ++j) {
            for (int k = 0; k < KERNEL_HEIGHT; ++k) {
                // Rows in the order 0, -1, +1.
                int x = edge + direction * j;
                int y = clamp(pixel.y + ((k & 1) == 1 ? -(k + 1) / 2 : k / 2), 0, size.y - 1);
                if (!inside(x, y) || is_hole(x, y) || disparity_at(x, y) > foreground) {
                    continue;
                }
                float weight = base * remaining;
                sum += weight * color_at(x, y);
                remaining -= weight;
            }
        }
        if (remaining < 1.0) {
            color = sum / (1.0 - remaining);
        } else if (inside(edge, pixel.y)) {
            color = color_at(edge, pixel.y);
        }
    }
}
