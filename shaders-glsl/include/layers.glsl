#include "include/tiles.glsl"

// What a source pixel shows: a front surface and, where that covers a part of the pixel only, the surface behind it.
// Coverage is told by stripes, the quarters of the pixel from left to right in forward columns: the four samples of a
// rotated grid lie in four different ones.
//
// One 32-bit integer per pixel. Bits 28 to 31 are FULL for a single surface, whose displacement is in bits 0 to 27;
// otherwise the front's is in bits 0 to 13, the back's in bits 14 to 27. Displacements are relative to the far plane's,
// in fractions of the distance to the near plane's. A second map has the back's colour, and the front's share in alpha;
// the front's colour follows from both and the resolved one.

const uint FULL = 15u;
// With depth of all samples the bits are the stripes that the front covers. With one depth they tell which side of the
// pixel it fills: its share is known, its place follows from the neighbours.
const uint EVENLY = 0u;
const uint FROM_LEFT = 1u;
const uint FROM_RIGHT = 2u;

const float FULL_STEPS = 268435455.0;
const float SPLIT_STEPS = 16383.0;
const vec4 STRIPES = vec4(0.0, 1.0, 2.0, 3.0);

// Displacements closer than this, in pixels, are one surface.
const float LINK = 0.5;

struct Layer {
    // Displacement, in pixels, relative to the far plane's.
    float front;
    // Of the surface behind it; not there without `split`.
    float back;
    bool split;
    // The front's coverage by stripes.
    vec4 mask;
};

// Displacement of the near plane relative to the far plane's: none where the eyes are in one place.
float reach() {
    return max(near_displacement - far_displacement, 1e-6);
}

uint pack_full(float front) {
    return (FULL << 28) | uint(clamp(front / reach(), 0.0, 1.0) * FULL_STEPS);
}

uint pack_split(float front, float back, uint mask) {
    uvec2 steps = uvec2(clamp(vec2(front, back) / reach(), 0.0, 1.0) * SPLIT_STEPS + 0.5);
    return (mask << 28) | (steps.y << 14) | steps.x;
}

bool is_full(uint layer) {
    return layer >> 28 == FULL;
}

float full_front(uint layer) {
    return float(layer & 0xfffffffu) * (reach() / FULL_STEPS);
}

// Front and back.
vec2 split_displacements(uint layer) {
    return vec2(uvec2(layer, layer >> 14) & 0x3fffu) * (reach() / SPLIT_STEPS);
}
