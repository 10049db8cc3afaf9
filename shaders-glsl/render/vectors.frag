// Motion vectors and depth of a view, from its depth, its pose and the previous one. Where a moving surface is seen, it has
// vectors of its own. Alpha is 1 there, and 0 where only the head has moved.
#include "include/depth_map.glsl"

uniform highp sampler2D moving_map;  // render/motion.frag
uniform bool moves;                  // false if no moving surface is in view
uniform ivec2 offset;                // from the target's pixels to the view's
uniform ivec2 last;                  // the view's last pixel
// From the view's pixels to those of the depth map, and the first and the last of these.
uniform vec4 to_depth;
uniform vec4 depth_range;
uniform bool reverse;  // true if the depth map has the other convention
// Inverse distance in 1 / metres: that of depth 0, and its change per unit of depth.
uniform vec2 inverse_distance;
uniform vec4 to_place;   // from the view's pixels to the normalized device coordinates of vectors
uniform mat4 to_previous;  // (these, 1, inverse distance) -> previous clip space
uniform float z_scale;   // from -1..1 to the convention of the vectors

layout(location = 0) out vec4 vector;

// A sample of a steep surface lies up to a pixel beside the place at which its vector was drawn.
const float SAME_SURFACE = 0.03;

void main() {
    vec2 pixel = gl_FragCoord.xy + vec2(offset);
    vec2 texel = clamp(floor(pixel * to_depth.xy + to_depth.zw), depth_range.xy, depth_range.zw);
    float depth = depth_of(ivec2(texel));
    depth = reverse ? 1.0 - depth : depth;
    float inverse = inverse_distance.x + inverse_distance.y * depth;
    vec3 place = vec3(pixel * to_place.xy + to_place.zw, 2.0 * depth - 1.0);
    vec4 previous = to_previous * vec4(place.xy, 1.0, inverse);
    vector = vec4(place - previous.xyz / previous.w, 0.0);
    // The nearest of a pixel's samples belongs to a moving surface that covers its middle, or that of a neighbour.
    float least = SAME_SURFACE * inverse;
    for (int i = moves ? 0 : 9; i < 9; ++i) {
        // The pixel itself is the first.
        int j = (i + 4) % 9;
        ivec2 at = clamp(ivec2(pixel) + ivec2(j % 3, j / 3) - 1, ivec2(0), last);
        vec4 moving = texelFetch(moving_map, at, 0);
        float off = moving.a > 0.0 ? abs(moving.a - inverse) : 1e9;
        if (off < least) {
            vector = vec4(moving.xyz, 1.0);
            least = i == 0 ? 0.0 : off;
        }
    }
    vector.z *= z_scale;
    gl_FragDepth = depth;
}
