// Copies an image and its depth, to draw more over it.
uniform sampler2D color_map;
uniform sampler2D depth_map;
uniform ivec2 offset;  // from a pixel of the target to its pixel in the maps

layout(location = 0) out vec4 out_color;

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy) + offset;
    out_color = texelFetch(color_map, p, 0);
    gl_FragDepth = texelFetch(depth_map, p, 0).x;
}
