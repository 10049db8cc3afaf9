#version 310 es
// One pass of the median patcher (Noori et al.): each channel of a hole's pixel is the median of its valid 5x5
// neighbours (the lower of the two in the middle). Pixels without valid neighbours are left to the next pass, for which
// this pass's pixels are valid: holes close from their border inwards.

#include "inpaint/holes.glsl"

const int RADIUS = 2;

// Three channels in one integer, ten bits each: eight of the channel, and above them a guard bit that takes the borrow
// when another such integer is subtracted. Counts of neighbours fit as well.
const int ONES = 0x00100401;
const int GUARDS = ONES << 8;

int pack(vec3 channels) {
    ivec3 levels = ivec3(channels * 255.0 + 0.5);
    return levels.r | levels.g << 10 | levels.b << 20;
}

// 1 for each channel in which `a` is not less than `b`.
int no_less(int a, int b) {
    return (a + GUARDS - b) >> 8 & ONES;
}

void main() {
    // The neighbourhood is the same if the image is mirrored.
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    color = texelFetch(color_map, pixel, 0);
    ivec2 first = max(pixel - RADIUS, 0);
    ivec2 last = min(pixel + RADIUS, size - 1);
    int level = 0;
    int count = 0;
    // The median is the largest level with no more than half of the values below it. It is found two bits at a time.
    // The neighbours are fetched again each time, since an array of them would lie in memory or take most of a GPU's
    // registers. The rare work is in a loop with a dynamic count; see inpaint/holes.glsl.
    for (int bit = color.a < 0.5 ? 64 : 0; bit > 0; bit >>= 2) {
        ivec3 candidates = level + bit * ONES * ivec3(1, 2, 3);
        ivec3 above = ivec3(0);
        count = 0;
        for (int y = first.y; y <= last.y; ++y) {
            for (int x = first.x; x <= last.x; ++x) {
                vec4 neighbour = texelFetch(color_map, ivec2(x, y), 0);
                if (neighbour.a >= 0.5) {
                    int value = pack(neighbour.rgb);
                    above += ivec3(
                        no_less(value, candidates.x), no_less(value, candidates.y), no_less(value, candidates.z));
                    ++count;
                }
            }
        }
        int enough = (count - (count - 1) / 2) * ONES;
        level += bit * (no_less(above.x, enough) + no_less(above.y, enough) + no_less(above.z, enough));
    }
    if (count > 0) {
        color = vec4(vec3(ivec3(level, level >> 10, level >> 20) & 255) / 255.0, 1.0);
    }
}
