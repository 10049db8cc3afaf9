// Transparent surfaces over display-referred colour, tested against the depth buffer.
#include "include/surface.glsl"

uniform float exposure;

layout(location = 0) out vec4 out_color;
#include "include/carried.glsl"
#include "include/seam.glsl"

void main() {
    vec4 color = material_diffuse();
    DISCARD_BEYOND_SEAM
#ifdef UNLIT
    out_color = vec4(srgb_encode(color.rgb), color.a);
#else
    vec3 c = aerial(shade(material_surface(color.rgb), v_position), length(v_position));
    out_color = vec4(tonemap(exposure * c), color.a);
#endif
    CARRY_NOTHING
}
