// A depth texture as a float image, to be read back.
uniform sampler2D source;

layout(location = 0) out vec4 out_depth;

void main() {
    out_depth = vec4(texelFetch(source, ivec2(gl_FragCoord.xy), 0).x);
}
