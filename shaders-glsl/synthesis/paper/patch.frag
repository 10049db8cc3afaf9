#version 310 es
// Algorithm 3, as corrected: the colour of valid pixels comes from where the ImBuffer says; disocclusions are
// filled by a kernel that starts at the hole's background edge and walks away from it, with weights that halve.

#include "include/imbuffer.glsl"

uniform highp usampler2D imbuffer;
uniform int kernel_height;

layout(location = 0) out vec4 color;
#ifdef SOURCE_MAP
layout(location = 1) out uint source_entry;
#endif

// The kernel's weights fall by half or more a step: more columns than this add less than 1/1000.
const int MAX_KERNEL_WIDTH = 10;

uint entry_at(int x, int row) {
    return texelFetch(imbuffer, ivec2(x, row), 0).r;
}

// Displacement of a valid entry in ImBuffer pixels.
float entry_displacement(uint entry, int x) {
    return float(x) - entry_source(entry);
}

void main() {
    ivec2 pixel = target_pixel();
    vec2 position = (vec2(pixel) + 0.5) / imbuffer_scale;
    ivec2 cell = min(ivec2(position), imbuffer_target_size - 1);
    int row = pixel.y;
    uint entry = entry_at(cell.x, cell.y);
    float last_column = float(source_size.x - 1);
    float source;

    bool valid = is_valid(entry);
    float moved = entry_displacement(entry, cell.x);
#ifdef LINEAR
    // Between two entries of one surface the displacement is linear; across an edge it is not. (At full
    // resolution there is nothing to interpolate, and LINEAR is not defined.)
    float fraction = position.x - 0.5 - float(cell.x);
    int neighbour = clamp(cell.x + (fraction < 0.0 ? -1 : 1), 0, imbuffer_target_size.x - 1);
    uint other = entry_at(neighbour, cell.y);
    float other_moved = entry_displacement(other, neighbour);
    if (is_valid(other) && abs(other_moved - moved) < 0.5) {
        moved = mix(moved, other_moved, abs(fraction));
    }
#endif
    source = float(pixel.x) - moved * imbuffer_scale.x;

    int left = disocclusion_left(entry);
    int width = disocclusion_width(entry);
    int right = left + width;
    // The background is left of a disocclusion, unless the hole reaches the image's border.
    int edge = left >= 0 ? left : min(right, imbuffer_target_size.x - 1);
    if (!valid) {
        uint edge_entry = entry_at(edge, cell.y);
        float edge_source = is_valid(edge_entry) ? entry_source(edge_entry) : float(edge);
        source = (edge_source + 0.5) * imbuffer_scale.x - 0.5;
    }
    source = clamp(source, 0.0, last_column);
    color = color_at(source, row);

    if (!valid) {
        int direction = left >= 0 ? -1 : 1;
        float foreground = 1e9;
        if (left >= 0 && right < imbuffer_target_size.x) {
            uint right_entry = entry_at(right, cell.y);
            foreground = is_valid(right_entry) ? entry_displacement(right_entry, right) : foreground;
        }
        float base = 0.5 + 0.3 * clamp((position.x - float(edge)) / float(width), 0.0, 1.0);
        vec4 sum = vec4(0.0);
        float remaining = 1.0;
        int columns = min(width, MAX_KERNEL_WIDTH);
        for (int j = 0; j < columns && remaining > 0.001; ++j) {
            for (int k = 0; k < kernel_height; ++k) {
                // Rows in the order 0, -1, +1, -2, ...
                int offset = (k & 1) == 1 ? -(k + 1) / 2 : k / 2;
                int tap_x = edge + direction * j;
                int tap_row = clamp(row + offset, 0, source_size.y - 1);
                int tap_y = min(int((float(tap_row) + 0.5) / imbuffer_scale.y), imbuffer_target_size.y - 1);
                if (tap_x < 0 || tap_x >= imbuffer_target_size.x) {
                    continue;
                }
                uint tap = entry_at(tap_x, tap_y);
                if (!is_valid(tap) || entry_displacement(tap, tap_x) > foreground) {
                    continue;
                }
                float weight = base * remaining;
                float tap_source = (entry_source(tap) + 0.5) * imbuffer_scale.x - 0.5;
                sum += weight * color_at(clamp(tap_source, 0.0, last_column), tap_row);
                remaining -= weight;
            }
        }
        color = remaining < 1.0 ? sum / (1.0 - remaining) : color;
    }
#ifdef WRITE_DEPTH
    gl_FragDepth = depth_at(int(source + 0.5), row);
#endif
#ifdef SOURCE_MAP
    source_entry = uint(source * FIXED + 0.5) | (valid ? 0u : HOLE);
#endif
}
