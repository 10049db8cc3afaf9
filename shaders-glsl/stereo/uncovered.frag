#version 310 es
// The pixels that a rendered eye uncovers in the other one, and those of them that its history does not know. Each of
// 32 x 64 texels counts them in its part of one row. This is an estimate: it ignores nearer surfaces that may hide a
// disocclusion.

#include "include/warp.glsl"

// law.y * depth of a forward column.
float nearness_at(int x, int row) {
    return law.y * depth_at(x, row);
}

#include "include/history.glsl"

layout(location = 0) out vec4 counts;

const ivec2 GRID = ivec2(32, 64);

void main() {
    ivec2 cell = ivec2(gl_FragCoord.xy);
    int row = (2 * cell.y + 1) * source_size.y / (2 * GRID.y);
    int end = min((cell.x + 1) * source_size.x / GRID.x, source_size.x - 1);
    float y = float(row + row_offset) + 0.5;
    bool seen = y > 0.0 && y < float(target_size.y);
    vec2 pixels = vec2(0.0);
    int x = cell.x * source_size.x / GRID.x;
    for (float here = nearness_at(x, row); seen && x < end; ++x) {
        float next = nearness_at(x + 1, row);
        // The number of columns between the places where the two land.
        float width = next - here;
        float middle = floor(float(x) + law.x + here + 0.5 * (width + 1.0));
        if (width + 1.0 >= MAX_STRETCH && middle >= 0.0 && middle < float(target_size.x)) {
            float column = mirrored ? float(target_size.x - 1) - middle : middle;
            vec4 color = vec4(0.0);
            float depth = here / law.y;
            bool known = recall(vec2(column + 0.5, y), next, middle - law.x, row, color, depth);
            pixels += vec2(width, known ? 0.0 : width);
        }
        here = next;
    }
    // One more, since zero marks a buffer that was not written.
    ivec2 values = ivec2(min(ceil(pixels + vec2(1.0, 0.0)), 65535.0));
    counts = vec4(values & 255, values >> 8).xzyw / 255.0;
}
