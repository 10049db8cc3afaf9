float luma(vec3 c) {
    return dot(c, vec3(0.299, 0.587, 0.114));
}

vec3 srgb_encode(vec3 c) {
    return mix(1.055 * pow(max(c, vec3(0.0031308)), vec3(1.0 / 2.4)) - 0.055, 12.92 * c, lessThan(c, vec3(0.0031308)));
}

// Scene-referred linear to display-referred sRGB: the ACES curve as fitted by K. Narkowicz. Keeps greys near
// 0.2 where they are and rolls bright colours off.
vec3 tonemap(vec3 c) {
    c = clamp((c * (2.51 * c + 0.03)) / (c * (2.43 * c + 0.59) + 0.14), 0.0, 1.0);
    return srgb_encode(c);
}
