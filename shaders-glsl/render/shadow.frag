// Writes only depth. Alpha cuts out holes, so that leaves cast the shadows of leaves.
#include "include/material.glsl"

void main() {
#ifdef CUTOUT
    if (cut_out(material_diffuse().a)) {
        discard;
    }
#endif
}
