#[versions]
whole = "";
levels = "#define LEVELS";

#[vertex]
#include "triangle.glslinc"

#[fragment]
#version 450
#VERSION_DEFINES
// Puts an eye's colour and depth into the buffers that Godot renders into. With LEVELS, the eye is composed of a wide
// level and of an inset, which shows where it knows better.
layout(set = 0, binding = 0) uniform sampler2D depth_map;
layout(set = 0, binding = 1) uniform sampler2D color_map;
layout(set = 0, binding = 2) uniform usampler2D source_map;
#ifdef LEVELS
layout(set = 0, binding = 3) uniform sampler2D inset_depth_map;
layout(set = 0, binding = 4) uniform sampler2D inset_color_map;
layout(set = 0, binding = 5) uniform usampler2D inset_source_map;
#endif
layout(push_constant, std430) uniform Place {
    // The eye's pixels per pixel of the target.
    vec2 pitch;
    // YoroCamera3D.DebugView
    float debug_view;
    float disparity;
    // The eye's corner in its image.
    vec2 corner;
#ifdef LEVELS
    // The inset's corners in the eye's pixels, and the eye's corner in the inset's image.
    vec2 inset_low;
    vec2 inset_high;
    vec2 inset_corner;
    // Where in the inset's source a pixel comes from, of its width: X times the column, Y, and Z times its depth.
    vec3 source_column;
    // The wide level's pixels per pixel of the eye, and how far a surface at depth 1 moves between the eyes in those.
    float wide_scale;
    float wide_disparity;
#endif
};
layout(location = 0) out vec4 color;

const float HOLES = 1.0;
const float DISPARITY = 2.0;

ivec2 texel_at(vec2 at, sampler2D depths) {
    return clamp(ivec2(at), ivec2(0), textureSize(depths, 0) - 1);
}

float depth_at(vec2 at, sampler2D depths) {
    return texelFetch(depths, texel_at(at, depths), 0).r;
}

void put(vec2 at, float depth, sampler2D colors, uint source) {
    color = texture(colors, at / vec2(textureSize(colors, 0)));
    if (debug_view == HOLES && (source & 0x80000000u) != 0u) {
        color.rgb = vec3(1.0, 0.0, 1.0);
    } else if (debug_view == DISPARITY) {
        color.rgb = vec3(abs(disparity * depth));
    }
    gl_FragDepth = depth;
}

#ifdef LEVELS
// The depth between the pixels of the wide level: that of a plane where it is one, so that what lies on surfaces stays
// visible there.
float wide_depth(vec2 at) {
    vec2 low = at - 0.5;
    vec2 part = fract(low);
    vec4 d = vec4(depth_at(low, depth_map), depth_at(low + vec2(1.0, 0.0), depth_map),
                  depth_at(low + vec2(0.0, 1.0), depth_map), depth_at(low + 1.0, depth_map));
    float nearest = max(max(d.x, d.y), max(d.z, d.w));
    float farthest = min(min(d.x, d.y), min(d.z, d.w));
    vec2 rows = mix(d.xz, d.yw, part.x);
    return wide_disparity * (nearest - farthest) < 1.0 ? mix(rows.x, rows.y, part.y) : depth_at(at, depth_map);
}
#endif

void main() {
    vec2 eye = gl_FragCoord.xy * pitch;
#ifdef LEVELS
    if (all(greaterThan(eye, inset_low)) && all(lessThan(eye, inset_high))) {
        vec2 at = inset_corner + eye;
        float depth = depth_at(at, inset_depth_map);
        // A surface that comes from beyond the inset's source is a hole at its border.
        float column = source_column.x * at.x + source_column.y + source_column.z * depth;
        if (column == clamp(column, 0.0, 1.0)) {
            put(at, depth, inset_color_map, texelFetch(inset_source_map, texel_at(at, inset_depth_map), 0).r);
            return;
        }
    }
    vec2 at = corner + eye * wide_scale;
    float depth = wide_depth(at);
#else
    vec2 at = corner + eye;
    float depth = depth_at(at, depth_map);
#endif
    put(at, depth, color_map, texelFetch(source_map, texel_at(at, depth_map), 0).r);
}
