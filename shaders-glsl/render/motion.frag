// Motion vectors of moving surfaces: the place in clip space minus that in the previous frame. Alpha is the inverse distance,
// by which vectors.frag knows the surface; 0 where there is none.
#include "include/material.glsl"

in vec4 v_clip;
in vec4 v_previous;

layout(location = 0) out vec4 motion;

void main() {
#ifdef CUTOUT
    if (cut_out(material_diffuse().a)) {
        discard;
    }
#endif
    // A surface that was behind the eye comes from far outside.
    vec3 previous = v_previous.xyz / max(v_previous.w, 1e-3);
    motion = vec4(v_clip.xyz / v_clip.w - previous, 1.0 / v_clip.w);
}
