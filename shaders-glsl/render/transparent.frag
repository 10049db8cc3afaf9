// Transparent surfaces over a finished, display-referred image.
#include "include/material.glsl"
#include "include/view.glsl"
#include "include/g_buffer.glsl"
#include "include/shade.glsl"

uniform ivec2 depth_offset;    // from a pixel of the target to its pixel in the depth map
uniform float nearer;          // +1: smaller depth is nearer, -1: larger
uniform float exposure;

layout(location = 0) out vec4 out_color;

void main() {
    float there = G_TEXEL(depth_map, ivec2(gl_FragCoord.xy) + depth_offset).x;
    if ((gl_FragCoord.z - there) * nearer >= 0.0) {
        discard;
    }
    vec4 color = material_diffuse();
    Surface s;
    s.albedo = color.rgb;
    s.emissive = material_emissive();
    s.normal = material_normal();
    s.roughness = gloss.x;
    s.specular = material_specular();
    vec3 c = aerial(shade(s, v_position, 1.0), length(v_position));
    out_color = vec4(tonemap(exposure * c), color.a);
}
