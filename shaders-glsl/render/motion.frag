// Motion vectors of moving surfaces: the place in clip space minus that in the former frame. Alpha is the inverse distance,
// by which vectors.frag knows the surface; 0 where there is none.
#include "include/material.glsl"

in vec4 v_clip;
in vec4 v_former;

layout(location = 0) out vec4 motion;

void main() {
#ifdef CUTOUT
    if (cut_out(material_diffuse().a)) {
        discard;
    }
#endif
    // A surface that was behind the eye comes from far outside.
    vec3 former = v_former.xyz / max(v_former.w, 1e-3);
    motion = vec4(v_clip.xyz / v_clip.w - former, 1.0 / v_clip.w);
}
