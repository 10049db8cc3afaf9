#version 310 es
// Extrapolation, pass 2: the source as its own eye would see it later. Each pixel looks for the surfaces that move into it:
// from the motions of the tiles around it, it goes back to where such a surface is now, and again by the motion that it
// finds there. The nearest one is seen. Where a surface has left, the background goes on.
//
// Fixed-point iteration for image warping: Bowles et al., Iterative Image Warping (2012).

#include "include/extrapolation.glsl"

uniform highp sampler2D color_map;
uniform highp sampler2D tile_map;

layout(location = 0) out vec4 color;

// Pixels beside the one that a surface hits.
const float HIT = 0.75;

ivec2 inside(vec2 place) {
    return ivec2(clamp(place, vec2(0.0), size - 1.0));
}

// Inverse distance, place in the source; negative if there is none.
vec3 arrival(vec2 at, vec2 guess) {
    vec2 from = at - guess;
    vec3 motion = motion_of(inside(from));
    for (int i = 0; i < 2; ++i) {
        from = stands(motion) ? from : at - motion.xy;
        motion = motion_of(inside(from));
    }
    vec2 off = from + motion.xy - at;
    bool hits = !stands(motion) && dot(off, off) <= HIT * HIT && from == clamp(from, vec2(0.0), size);
    return hits ? vec3(motion.z, from) : vec3(-1.0);
}

void main() {
    vec2 at = gl_FragCoord.xy;
    vec3 own = motion_of(ivec2(at));
    // What stands here is seen unless something comes before it.
    vec3 seen = stands(own) ? vec3(own.z, at) : vec3(-1.0);
    ivec2 last = textureSize(tile_map, 0) - 1;
    bool copied = stands(own);
    for (int i = 0; i < 9; ++i) {
        ivec2 tile = clamp(ivec2(at) / REACH + ivec2(i % 3, i / 3) - 1, ivec2(0), last);
        vec4 motions = texelFetch(tile_map, tile, 0);
        for (int j = 0; j < 2; ++j) {
            vec2 motion = j == 0 ? motions.xy : motions.zw;
            if (motion != vec2(0.0) && (j == 0 || motion != motions.xy)) {
                vec3 found = arrival(at, motion);
                copied = copied && found.x <= seen.x;
                seen = found.x > seen.x ? found : seen;
            }
        }
    }
    if (!stands(own)) {
        vec3 found = arrival(at, own.xy);
        seen = found.x > seen.x ? found : seen;
    }
    if (seen.x < 0.0) {
        // The surface has left: go back along its way to what stands beside it.
        vec2 back = -normalize(own.xy);
        vec2 from = at;
        vec3 motion = own;
        for (int i = 0; i < 2 * REACH && !stands(motion); ++i) {
            from += back;
            motion = motion_of(inside(from));
        }
        from = stands(motion) ? vec2(inside(from)) + 0.5 : at;
        seen = vec3(motion.z, from);
    }
    color = textureLod(color_map, seen.yz / size, 0.0);
    gl_FragDepth = copied ? depth_of(ivec2(at)) : clamp((seen.x - law.x) / law.y, 0.0, 1.0);
}
