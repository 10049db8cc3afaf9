// Inputs of the passes for any view. app/core/src/synthesis/uniforms.rs fills the block; docs/library.md has the table of offsets.

#include "include/interface.glsl"

#ifdef UNIFORM_BLOCK
UNIFORM_BLOCK uniform AnyView {
#endif
UNIFORM ivec2 source_size;
// Corner of the target in its framebuffer, on the side of row 0.
UNIFORM ivec2 target_origin;
// A target pixel (x, y) whose surface has the inverse distance k from the target's eye lies in the source at the homogeneous
// pixel whose components are the scalar products of these with (x, y, 1, k): the rows of the homography of the rotation, and
// the epipole.
UNIFORM vec4 to_source_x;
UNIFORM vec4 to_source_y;
UNIFORM vec4 to_source_w;
// Inverse distance from stored depth, `law.x + law.y * depth`: of the source, and of the target.
UNIFORM vec2 source_law;
UNIFORM vec2 target_law;
// Stored depth of the nearest surface that can be seen, and of the far plane.
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
