// Writes the g-buffer.
#include "include/material.glsl"
#include "include/normal.glsl"

uniform float material_id;
#ifdef SEAM_DISCARD
uniform float seam;  // first column of the right eye
flat in int v_view;
#endif

layout(location = 0) out vec4 out_albedo;    // square root of linear albedo, roughness
layout(location = 1) out vec4 out_normal;    // octahedral normal, reflectance
layout(location = 2) out vec4 out_emissive;  // square root of a quarter of linear emission, material id

void main() {
    vec4 color = material_diffuse();
#ifdef SEAM_DISCARD
    if ((gl_FragCoord.x < seam) != (v_view == 0)) {
        discard;
    }
#endif
#ifdef CUTOUT
    if (cut_out(color.a)) {
        discard;
    }
#endif
    out_albedo = vec4(sqrt(color.rgb), gloss.x);
    out_normal = vec4(pack_normal(material_normal()), material_specular());
    out_emissive = vec4(sqrt(0.25 * material_emissive()), material_id);
}
