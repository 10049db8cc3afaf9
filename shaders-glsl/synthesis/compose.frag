#version 310 es
// Composes an eye of its levels.

#include "include/levels.glsl"

layout(location = 0) out vec4 color;

void main() {
    color = composed(eye_place.xy * gl_FragCoord.xy + eye_place.zw);
}
