#version 310 es
// One pass of the median patcher (Noori et al.): a hole's pixel takes, in each channel, the median of the valid ones of
// its 5x5 neighbours (the lower of the two in the middle). Pixels without any are left to the next pass, which takes
// this one's for valid: holes close from their border inwards.

#include "inpaint/holes.glsl"

const int RADIUS = 2;

void main() {
    ivec2 pixel = here();
    color = color_at(pixel.x, pixel.y);
    ivec3 values[25];
    int count = 0;
    // Rare work stands in a loop with a dynamic count; see include/fill.glsl.
    for (int y = color.a < 0.5 ? -RADIUS : RADIUS + 1; y <= RADIUS; ++y) {
        for (int x = -RADIUS; x <= RADIUS; ++x) {
            ivec2 at = pixel + ivec2(x, y);
            if (inside(at.x, at.y) && !is_hole(at.x, at.y)) {
                values[count++] = ivec3(color_at(at.x, at.y).rgb * 255.0 + 0.5);
            }
        }
    }
    // The median is the largest level that no more than half of the values lie below: found bit by bit.
    ivec3 level = ivec3(0);
    for (int bit = count > 0 ? 128 : 0; bit > 0; bit >>= 1) {
        ivec3 candidate = level + bit;
        ivec3 below = ivec3(0);
        for (int i = 0; i < count; ++i) {
            below += ivec3(lessThan(values[i], candidate));
        }
        level += bit * ivec3(lessThanEqual(below, ivec3((count - 1) / 2)));
    }
    if (count > 0) {
        color = vec4(vec3(level) / 255.0, 1.0);
    }
}
