// Marks the far field's pixels that the near field hides from both eyes, by writing the near plane's depth.
uniform sampler2D left_depth;
uniform sampler2D right_depth;
uniform ivec2 crops[2];   // pixel of the far field that belongs to each eye's lower left pixel
uniform float far_depth;  // the value that the depth buffers are cleared to

bool hides(sampler2D near_field, ivec2 p) {
    ivec2 size = textureSize(near_field, 0);
    bool outside = any(lessThan(p, ivec2(0))) || any(greaterThanEqual(p, size));
    return outside || texelFetch(near_field, clamp(p, ivec2(0), size - 1), 0).x != far_depth;
}

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    if (!(hides(left_depth, p - crops[0]) && hides(right_depth, p - crops[1]))) {
        discard;
    }
    gl_FragDepth = 1.0 - far_depth;
}
