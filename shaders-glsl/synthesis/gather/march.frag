#version 310 es
// Gather, pass 3: for each target pixel, walk along the source row from the nearest candidate outwards, past the tiles
// that do not land in the pixel.
//
// The first place where the displaced row crosses the pixel is the visible surface, and its fractional column is
// fetched with linear filtering. Where the previous pass has found a law, the column is affine in the pixel. Nearly
// every other pixel ends within a few cheap steps here, and only those beside silhouettes continue in
// include/segments.glsl.

#include "include/segments.glsl"
#ifdef BLOOM
#include "include/bloom.glsl"
uniform vec4 bloom_place;  // from texture coordinates of the source to those of its bloom: scale, offset

vec4 with_source_bloom(vec4 color, vec2 at) {
    return with_bloom(color, at * bloom_place.xy + bloom_place.zw);
}
#endif

layout(location = 0) out vec4 color;
#ifdef SOURCE_MAP
layout(location = 1) out uint source_entry;
#endif

int source_row() {
    return int(clamp(gl_FragCoord.y - first_row, 0.0, float(source_size.y - 1)));
}

// The maximum number of steps before the search over segments: as many as a wave should wait for.
const float FIRST_STEPS = 2.0;

// Colour and surface of a pixel whose tile has a law.
vec4 sample_planar(vec3 affine, out Surface surface) {
    float place = affine.x + affine.y * gl_FragCoord.x + affine.z * gl_FragCoord.y;
#if defined(WRITE_DEPTH) || defined(SOURCE_MAP) || defined(MOTION) || defined(OPEN_HOLES)
    surface.source = clamp((place - columns.y) / columns.x - 0.5, 0.0, float(source_size.x - 1));
    // The surface's own displacement tells its depth, so that none is read, unless nothing is displaced.
    surface.depth = (origins.x * gl_FragCoord.x + origins.y - surface.source) / law.y;
    if (law.y == 0.0) {
        vec2 depths = depth_pair(floor(surface.source));
        surface.depth = mix(depths.x, depths.y, fract(surface.source));
    }
    surface.hole = false;
#endif
    vec2 at = vec2(place, row_at(0.0));
#ifdef BLOOM
    return with_source_bloom(color_sample(at), at);
#else
    return color_sample(at);
#endif
}

// Colour and surface of any other pixel.
vec4 searched(uint span, out Surface surface) {
    float origin = origins.x * gl_FragCoord.x + origins.y;
    Search at = search_at(floor(origin - farthest - uintBitsToFloat(span)), origin);
    float end = min(max(at.x, 0.0) + span_steps(span), float(source_size.x - 1));
    float limit = min(at.x + FIRST_STEPS, end);
    // Continue to the first pair that crosses the pixel, or has a silhouette within a pixel of it.
    for (; at.x < limit && at.b <= 0.0 && max(at.b, -1.0) >= at.a; at.x += 1.0) {
        float next = depth_sample(vec2(column_at(at.x + 2.0), row_at(0.0)));
        at.depths = vec2(at.depths.y, next);
        at.a = at.b;
        at.b = at.x + 2.0 - origin + law.y * next;
    }
    float stretch = at.b - at.a;
    float t = -at.a / stretch;
    surface = Surface(at.x + t, mix(at.depths.x, at.depths.y, t), false);
    vec4 seen = color_sample(vec2(column_at(surface.source), row_at(0.0)));
    float middle = 0.5 * float(source_size.x - 1);
    bool done = at.a <= 0.0 && at.b > 0.0 && stretch < MAX_STRETCH && abs(surface.source - middle) <= middle;
    if (!done) {
        seen = march(at, end, origin, source_row(), surface);
    }
#ifdef OPEN_HOLES
    else if (is_outermost(at.x, at.depths, true)) {
        discard;
    }
#endif
#ifdef BLOOM
    seen = with_source_bloom(seen, vec2(column_at(surface.source), row_at(0.0)));
#endif
    return seen;
}

void main() {
    uvec4 span = pixel_span();
    Surface surface;
    if (span.y != 0u) {
        color = sample_planar(uintBitsToFloat(span.xyz), surface);
    } else {
        color = searched(span.x, surface);
    }
#ifdef OPEN_HOLES
    if (span.w != 0u && ends_in_row(surface)) {
        discard;
    }
#endif
#ifdef MOTION
    // Silhouettes are not blended: a mean of two motions is nobody's. A hole has the vector of the background that fills it.
    vec4 vector = color_sample(vec2(column_at(surface.source), row_at(0.0)));
    vec2 scale = mix(vec2(1.0), vec2(source_size) / vec2(target_size), motion.w);
    color = vec4(scale * vector.xy, vector.zw);
    color.x += motion.x * vector.z + motion.y * surface.depth + motion.z;
#endif
#ifdef WRITE_DEPTH
    gl_FragDepth = surface.depth;
#endif
#ifdef SOURCE_MAP
    source_entry = uint(surface.source * FIXED + 0.5) | (surface.hole ? HOLE : 0u);
#endif
}
