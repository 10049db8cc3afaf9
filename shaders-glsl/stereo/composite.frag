#version 310 es
// Composites a layer of near objects with a far one: colour and depth of the nearer surface.

uniform sampler2D far_color;
uniform sampler2D far_depth;
uniform sampler2D near_color;
uniform sampler2D near_depth;
uniform bool reversed;

layout(location = 0) out vec4 color;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    float behind = texelFetch(far_depth, pixel, 0).r;
    float before = texelFetch(near_depth, pixel, 0).r;
    bool nearer = reversed ? before > behind : before < behind;
    color = nearer ? texelFetch(near_color, pixel, 0) : texelFetch(far_color, pixel, 0);
    gl_FragDepth = nearer ? before : behind;
}
