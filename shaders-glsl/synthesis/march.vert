#version 310 es
// The triangle of screen.vert for the last pass, with the place of each fragment's span. GPUs that fetch at an
// unchanged interpolated place do so before the fragment begins.

#include "include/uniforms.glsl"

VARYING(0) out vec2 span_at;

void main() {
#ifdef VULKAN
    int id = gl_VertexIndex;
#else
    int id = gl_VertexID;
#endif
    vec2 corner = vec2(float((id << 1) & 2), float(id & 2));
    vec2 pixel = vec2(target_origin) + corner * vec2(target_size);
    span_at = span_place.xy * pixel + span_place.zw;
    gl_Position = vec4(corner * 2.0 - 1.0, 0.0, 1.0);
}
