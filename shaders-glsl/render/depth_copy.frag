// A view's depth as a float image, to be read back.
#include "include/depth_map.glsl"

layout(location = 0) out vec4 out_depth;

void main() {
    out_depth = vec4(depth_of(ivec2(gl_FragCoord.xy)));
}
