// Disocclusions: r is 1 for pixels of the second eye that the dominant eye does not see. Elsewhere, g is 1 if both of
// the dominant eye's pixels around the reprojected place show the same surface, so that they may be filtered.
#include "include/reprojection.glsl"

uniform sampler2D depth_map;       // of the second eye
uniform sampler2D dominant_depth;
uniform vec2 inverse_distance;     // 1 / distance = x + y * depth
uniform float half_pixel;          // inverse distance whose disparity is half a pixel
uniform float far_depth;

layout(location = 0) out vec4 out_disocclusion;

// True if a pixel of the dominant eye shows the surface: its disparity differs by less than half a pixel, its distance
// by less than a tenth.
bool shows(ivec2 q, float depth) {
    ivec2 size = textureSize(dominant_depth, 0);
    float there = texelFetch(dominant_depth, clamp(q, ivec2(0), size - 1), 0).x;
    float difference = abs(inverse_distance.y * (there - depth));
    float limit = min(half_pixel, 0.1 * (inverse_distance.x + inverse_distance.y * depth));
    bool inside = all(greaterThanEqual(q, ivec2(0))) && all(lessThan(q, size));
    return inside && difference <= limit && there != far_depth;
}

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    float depth = texelFetch(depth_map, p, 0).x;
    float x = dominant_column(p.x, depth);
    int nearest = nearest_column(x);
    int next = x < float(nearest) ? nearest - 1 : nearest + 1;
    int row = p.y - row_offset;
    bool seen = shows(ivec2(nearest, row), depth);
    bool filtered = seen && shows(ivec2(next, row), depth);
    // The sky is the same for both eyes.
    seen = seen || depth == far_depth;
    out_disocclusion = vec4(seen ? 0.0 : 1.0, filtered ? 1.0 : 0.0, 0.0, 1.0);
}
