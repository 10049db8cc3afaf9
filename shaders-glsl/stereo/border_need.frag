#version 310 es
// How much of the guard band the other eye sees, and would see after some motion of the head: each of 4 x 64 texels
// looks at every fourth column, in every second of a 64th of the rows, of a rendered view. Columns are counted forward
// (include/warp.glsl): those of the guard band are the first.

uniform sampler2D depth_map;
uniform bool mirrored;
uniform int guard;      // columns of the guard band
uniform int first;      // first column that is drawn
uniform int end;        // columns to look at
uniform vec2 law;       // disparity of a depth in pixels, 0 at infinity: law.x + law.y * depth
uniform vec2 motion;    // how far surfaces may move, in pixels: motion.x + motion.y * disparity

layout(location = 0) out vec4 need;

const ivec2 CELLS = ivec2(4, 64);
const int ROWS = 2;  // one of so many is looked at

void main() {
    ivec2 cell = ivec2(gl_FragCoord.xy);
    ivec2 size = textureSize(depth_map, 0);
    int top = (cell.y + 1) * size.y / CELLS.y;
    float columns = 0.0;
    float undrawn = 0.0;
    for (int row = cell.y * size.y / CELLS.y; row < top; row += ROWS) {
        for (int x = first + cell.x; x < end; x += CELLS.x) {
            float depth = texelFetch(depth_map, ivec2(mirrored ? size.x - 1 - x : x, row), 0).r;
            float disparity = law.x + law.y * depth;
            // How far out from the eye's own border; a surface of the guard band is seen if it moves in further.
            float out_by = float(guard - x);
            float reach = motion.x + motion.y * disparity;
            if (out_by - reach < disparity + 1.0) {
                columns = max(columns, min(out_by + reach, disparity + 1.0));
            }
            if (x == first && first > 0 && disparity > out_by) {
                columns = max(columns, disparity + 1.0);
                undrawn += float(ROWS) * (min(disparity, float(guard)) - out_by);
            }
        }
    }
    // One column more, so that a buffer of zeros is none of this.
    ivec2 counts = ivec2(min(ceil(vec2(columns + 1.0, undrawn)), 65535.0));
    need = vec4(counts & 255, counts >> 8).xzyw / 255.0;
}
