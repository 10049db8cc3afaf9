// Inputs of the passes for any view. app/engines/core/src/synthesis/uniforms.rs fills the block, and lists its
// offsets.

#include "include/interface.glsl"

#ifdef UNIFORM_BLOCK
UNIFORM_BLOCK uniform AnyView {
#endif
UNIFORM ivec2 source_size;
// Corner of the target in its framebuffer, on the side of row 0.
UNIFORM ivec2 target_origin;
// Map a target pixel (x, y), whose surface is at the inverse distance k from the target's eye, to the source: the
// components of the homogeneous source pixel are the dot products of these rows with (x, y, 1, k). The first three
// columns are the homography of the rotation, the last one is the epipole.
UNIFORM vec4 to_source_x;
UNIFORM vec4 to_source_y;
UNIFORM vec4 to_source_w;
// The laws of the source and of the target, which give inverse distance from stored depth: `law.x + law.y * depth`.
UNIFORM vec2 source_law;
UNIFORM vec2 target_law;
// Stored depth of the nearest surface that can be visible, and of the far plane.
UNIFORM float nearest;
UNIFORM float far_depth;
// The source's corner in its image, on the side of row 0, and one pixel of the image in texture coordinates.
UNIFORM ivec2 source_origin;
UNIFORM vec2 texel;
#ifdef UNIFORM_BLOCK
};
#endif

#include "include/silhouettes.glsl"
#include "include/source.glsl"
