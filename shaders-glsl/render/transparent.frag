// Transparent surfaces over a display-referred image: a finished one with its depth in a texture, or, with
// DEPTH_BUFFER, the one that is being rendered.
#include "include/surface.glsl"
#ifndef DEPTH_BUFFER
#include "include/g_buffer.glsl"

uniform ivec2 depth_offset;    // from a pixel of the target to its pixel in the depth map
uniform float nearer;          // +1: smaller depth is nearer, -1: larger
#endif
uniform float exposure;

layout(location = 0) out vec4 out_color;

void main() {
#ifndef DEPTH_BUFFER
    float there = G_TEXEL(depth_map, ivec2(gl_FragCoord.xy) + depth_offset).x;
    if ((gl_FragCoord.z - there) * nearer >= 0.0) {
        discard;
    }
#endif
    vec4 color = material_diffuse();
    vec3 c = aerial(shade(material_surface(color.rgb), v_position, 1.0), length(v_position));
    out_color = vec4(tonemap(exposure * c), color.a);
}
