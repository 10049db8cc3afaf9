// Of each pixel's samples the nearest depth.
uniform highp sampler2DMS depth_map;
uniform float nearer;  // +1: smaller depth is nearer, -1: larger

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    float nearest = nearer * texelFetch(depth_map, p, 0).x;
    for (int i = 1; i < SAMPLES; ++i) {
        nearest = min(nearest, nearer * texelFetch(depth_map, p, i).x);
    }
    gl_FragDepth = nearer * nearest;
}
