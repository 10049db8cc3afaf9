#version 310 es
// The nearness of surfaces at the border of a rendered view, on the side of its guard band. Each of 64 x 16 texels has
// the nearest surface of a few columns, in every second row of a sixteenth of the rows. Columns are counted forward
// (include/warp.glsl), so those of the guard band are the first.

#include "include/depth_map.glsl"

uniform bool mirrored;
uniform int guard;      // columns of the guard band
uniform int first;      // first column that is drawn
uniform int columns;    // to a texel
uniform vec2 law;       // disparity of a depth in pixels, 0 at the far plane: law.x + law.y * depth
uniform float beyond;   // disparity at which a surface reaches the other eye's border from column `guard`

layout(location = 0) out vec4 profile;

const int BANDS = 16;
const int ROWS = 2;  // one of so many is looked at
const float UNIT = 16.0;  // of disparity, to a pixel

void main() {
    ivec2 cell = ivec2(gl_FragCoord.xy);
    ivec2 size = textureSize(depth_map, 0);
    int begin = min(first + cell.x * columns, size.x);
    int end = min(begin + columns, size.x);
    int top = (cell.y + 1) * size.y / BANDS;
    float nearest = 0.0;
    float undrawn = 0.0;
    for (int row = cell.y * size.y / BANDS; row < top; row += ROWS) {
        for (int x = begin; x < end; ++x) {
            float depth = depth_of(ivec2(mirrored ? size.x - 1 - x : x, row));
            float disparity = law.x + law.y * depth;
            nearest = max(nearest, disparity);
            // A surface that continues beyond the outermost drawn column is seen as far as it moves into the image.
            if (x == first) {
                float seen = min(disparity - beyond, float(guard)) - float(guard - first);
                undrawn += first > 0 ? max(seen, 0.0) : 0.0;
            }
        }
    }
    // One unit more, since zero marks a buffer that was not written.
    ivec2 values = ivec2(min(ceil(vec2(nearest * UNIT + 1.0, undrawn)), 65535.0));
    profile = vec4(values & 255, values >> 8).xzyw / 255.0;
}
