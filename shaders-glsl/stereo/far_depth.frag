// Merges the far field's depth into an eye's by the depth test.
uniform sampler2D far_field_depth;
uniform ivec2 crop;       // pixel of the far field that belongs to the eye's lower left pixel
uniform float far_depth;  // the value that the depth buffers are cleared to

void main() {
    float depth = texelFetch(far_field_depth, ivec2(gl_FragCoord.xy) + crop, 0).x;
    // The near field hides this pixel.
    if (depth == 1.0 - far_depth) {
        discard;
    }
    gl_FragDepth = depth;
}
