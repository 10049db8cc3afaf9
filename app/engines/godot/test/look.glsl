#[vertex]
#include "res://addons/yoro/shaders/triangle.glslinc"

#[fragment]
#version 450
// Copies a picture; the Mobile renderer halves what it stores.
layout(set = 0, binding = 0) uniform sampler2D color_map;
layout(push_constant, std430) uniform Factor {
    float factor;
};
layout(location = 0) out vec4 color;

void main() {
    color = factor * texelFetch(color_map, ivec2(gl_FragCoord.xy), 0);
}
