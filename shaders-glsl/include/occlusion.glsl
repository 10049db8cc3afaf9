// Ambient occlusion and, to keep it on its surface when it is filtered, distance on a logarithmic scale.
float distance_code(float distance) {
    return clamp((log2(distance) + 6.0) * (1.0 / 20.0), 0.0, 1.0);
}

vec4 pack_occlusion(float occlusion, float code) {
    float high = floor(code * 255.0);
    return vec4(occlusion, high / 255.0, code * 255.0 - high, 1.0);
}

float unpack_code(vec4 texel) {
    return texel.y + texel.z * (1.0 / 255.0);
}

// Weight of a neighbour: 1 for the same distance, little beyond a few per cent of difference.
float same_surface(float a, float b) {
    float d = (a - b) * 700.0;
    return 1.0 / (1.0 + d * d);
}
