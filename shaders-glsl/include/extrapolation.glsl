// Where the surfaces of a source will be, from their motion vectors. app/engines/core/src/opengl/extrapolator.rs sets the
// uniforms.
#include "include/depth_map.glsl"

uniform highp sampler2D vector_map;
uniform vec2 size;          // of the source
uniform vec2 vector_scale;  // pixels of the vectors per pixel of the source
// The part of the step between the frames by which surfaces go on.
uniform float ahead;
// Inverse distance per stored depth, of the source and in the former frame: its value at 0, its slope.
uniform vec2 law;
uniform vec2 former_law;
uniform float z_scale;  // stored depth per unit of a vector's z
// From (x, y, 1, inverse distance) in the former frame's normalized device coordinates to the source's, times a factor.
uniform mat4 from_former;

// Pixels, and part of the inverse distance, by which half floats are off for surfaces that stand still.
const float STILL = 0.25;
const float STILL_INVERSE = 0.01;

// Pixels by which the surface of a pixel will have moved in the image, and its inverse distance then. Nothing for what
// stands still in the world, however the head moves.
vec3 motion_of(ivec2 pixel) {
    float depth = depth_of(pixel);
    vec3 vector = texelFetch(vector_map, ivec2((vec2(pixel) + 0.5) * vector_scale), 0).xyz;
    float inverse = law.x + law.y * depth;
    float former = former_law.x + former_law.y * (depth - z_scale * vector.z);
    vec2 here = 2.0 * (vec2(pixel) + 0.5) / size - 1.0;
    vec4 before = from_former * vec4(here - vector.xy, 1.0, former);
    before *= former > 1e-7 ? inverse / former : 1.0;
    // In a straight line through both places in space.
    vec4 after = (1.0 + ahead) * vec4(here, 1.0, inverse) - ahead * before;
    vec2 moved = 0.5 * size * (after.xy / after.z - here);
    float later = inverse / after.z;
    bool still = after.z <= 0.0
        || (dot(moved, moved) < STILL * STILL && abs(later - inverse) <= STILL_INVERSE * inverse);
    return still ? vec3(0.0, 0.0, inverse) : vec3(moved, later);
}

bool stands(vec3 motion) {
    return motion.x == 0.0 && motion.y == 0.0;
}

// Columns and rows of a tile: the farthest that a surface may move and be found everywhere.
const int REACH = 32;
