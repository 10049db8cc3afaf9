#version 310 es
// Gather over layers, pass 1: what each pixel of the source shows, from the depth of its samples or, where there is one
// depth per pixel, from colour and depth around it.

#include "include/layers.glsl"

layout(location = 0) out uint layer;
// Colour of the back, and the front's share.
layout(location = 1) out vec4 back;

const ivec2 RING[8] = ivec2[8](
    ivec2(-1, 0), ivec2(1, 0), ivec2(0, -1), ivec2(0, 1), ivec2(-1, -1), ivec2(1, -1), ivec2(-1, 1), ivec2(1, 1));

ivec2 inside(ivec2 pixel) {
    return clamp(pixel, ivec2(0), source_size - 1);
}

vec4 color_of(ivec2 pixel) {
    return texelFetch(color_map, in_image(inside(pixel)), 0);
}

// Displacement relative to the far plane's.
float above_far(float depth) {
    return displacement(depth) - far_displacement;
}

// How far estimates of front and back are from their mixture is shared among both, so that they mix to it.
vec4 shared_back(vec4 color, vec4 front_color, vec4 back_color, float share) {
    vec4 residual = color - share * front_color - (1.0 - share) * back_color;
    float rest = 1.0 - share;
    return clamp(back_color + residual * rest / (share * share + rest * rest), 0.0, 1.0);
}

#ifdef MULTISAMPLE
uniform highp sampler2DMS sample_depths;
// Index of the samples from left to right in forward columns.
uniform ivec4 stripes;
#ifdef SAMPLE_COLORS
uniform highp sampler2DMS sample_colors;
#endif

vec4 displacements(ivec2 pixel) {
    ivec2 at = in_image(inside(pixel));
    vec4 depths = vec4(
        texelFetch(sample_depths, at, stripes.x).r, texelFetch(sample_depths, at, stripes.y).r,
        texelFetch(sample_depths, at, stripes.z).r, texelFetch(sample_depths, at, stripes.w).r);
    return law.x - far_displacement + law.y * depths;
}

float largest(vec4 v) {
    return max(max(v.x, v.y), max(v.z, v.w));
}

float smallest(vec4 v) {
    return min(min(v.x, v.y), min(v.z, v.w));
}

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 samples = displacements(pixel);
    float nearest = largest(samples);
    bool full = nearest - smallest(samples) < LINK;
    vec4 in_front = full ? vec4(1.0) : vec4(greaterThan(samples, vec4(nearest - LINK)));
    float count = dot(in_front, vec4(1.0));
    float front = dot(in_front, samples) / count;
    // Of three surfaces the nearest behind the front.
    float second = largest(mix(samples, vec4(-1e9), in_front));
    vec4 behind = (1.0 - in_front) * vec4(greaterThan(samples, vec4(second - LINK)));
    float back_displacement = dot(behind, samples) / max(dot(behind, vec4(1.0)), 1.0);
    uint bits = uint(dot(in_front, vec4(1.0, 2.0, 4.0, 8.0)));
    layer = full ? pack_full(front) : pack_split(front, back_displacement, bits);
    float share = 0.25 * count;
#ifdef SAMPLE_COLORS
    vec4 sum = vec4(0.0);
    for (int k = full ? 4 : 0; k < 4; ++k) {
        sum += (1.0 - in_front[k]) * texelFetch(sample_colors, in_image(pixel), stripes[k]);
    }
    back = vec4((sum / max(4.0 - count, 1.0)).rgb, share);
#else
    vec4 color = color_of(pixel);
    vec4 front_sum = vec4(0.0);
    vec4 back_sum = vec4(0.0);
    float front_weight = 0.0;
    float back_weight = 0.0;
    for (int i = full ? 8 : 0; i < 8; ++i) {
        vec4 other = displacements(pixel + RING[i]);
        float middle = dot(other, vec4(0.25));
        float weight = i < 4 ? 2.0 : 1.0;
        weight = largest(other) - smallest(other) < LINK ? weight : 0.0;
        vec4 tap = color_of(pixel + RING[i]);
        float of_front = abs(middle - front) < LINK ? weight : 0.0;
        float of_back = abs(middle - back_displacement) < LINK ? weight : 0.0;
        front_sum += of_front * tap;
        back_sum += of_back * tap;
        front_weight += of_front;
        back_weight += of_back;
    }
    vec4 front_color = front_sum / max(front_weight, 1.0);
    vec4 back_color = back_sum / max(back_weight, 1.0);
    if (front_weight > 0.0 && back_weight > 0.0) {
        back_color = shared_back(color, front_color, back_color, share);
    } else if (front_weight > 0.0 && !full) {
        back_color = clamp((color - share * front_color) / (1.0 - share), 0.0, 1.0);
    } else if (back_weight == 0.0) {
        back_color = color;
    }
    back = vec4(back_color.rgb, share);
#endif
}
#else
// One depth per pixel: of its nearest sample, or with FIRST_SAMPLE of sample 0, which may be either surface's.
#ifdef FIRST_SAMPLE
const float APART = 2.0;
#else
const float APART = 0.5;
#endif
// Taps of the estimates: the ring and the row's and column's next, the nearer ones counting more.
const int TAPS = 12;
const ivec2 NEXT[4] = ivec2[4](ivec2(-2, 0), ivec2(2, 0), ivec2(0, -2), ivec2(0, 2));
// A difference of colour that says little of the share, squared.
const float NOISE = 256.0 / (255.0 * 255.0);

ivec2 tap_at(int i) {
    return i < 8 ? RING[i] : NEXT[i - 8];
}

float displacement_of(ivec2 pixel) {
    ivec2 at = inside(pixel);
    return above_far(depth_texel(at.x, at.y));
}

// A single surface all around.
bool is_pure(ivec2 pixel) {
    float here = displacement_of(pixel);
    bool pure = true;
    for (int i = 0; i < 8; ++i) {
        float there = displacement_of(pixel + RING[i]);
        pure = pure && there >= here - APART;
#ifdef FIRST_SAMPLE
        pure = pure && there <= here + APART;
#endif
    }
    return pure;
}

struct Split {
    bool mixed;
    // The pixel's depth is that of the back.
    bool shows_back;
    float front;
    float back;
};

Split split_at(ivec2 pixel) {
    float here = displacement_of(pixel);
    float low = here;
    float high = here;
    // The row and the column first: a corner's surface is less likely to be in the pixel.
    for (int i = 0; i < 8; ++i) {
        float there = displacement_of(pixel + RING[i]);
        bool straight = i < 4;
        low = straight || low >= here - APART ? min(low, there) : low;
        high = straight || high <= here + APART ? max(high, there) : high;
    }
    bool front_like = low < here - APART;
#ifdef FIRST_SAMPLE
    bool back_like = high > here + APART;
    bool shows_back = back_like && !(front_like && here - low > high - here);
    return Split(front_like || back_like, shows_back, shows_back ? high : here, shows_back ? here : low);
#else
    return Split(front_like, false, here, low);
#endif
}

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 color = color_of(pixel);
    Split split = split_at(pixel);
    // Estimates from pure pixels, else from all of a surface.
    vec4 front_sum = vec4(0.0);
    vec4 back_sum = vec4(0.0);
    vec4 front_any = vec4(0.0);
    vec4 back_any = vec4(0.0);
    // Weights in the same order.
    vec4 weights = vec4(0.0);
    for (int i = split.mixed ? 0 : TAPS; i < TAPS; ++i) {
        ivec2 offset = tap_at(i);
        float there = displacement_of(pixel + offset);
        float weight = 4.0 / float(offset.x * offset.x + offset.y * offset.y);
        float of_front = abs(there - split.front) < APART ? weight : 0.0;
        float of_back = abs(there - split.back) < APART ? weight : 0.0;
        vec4 tap = color_of(pixel + offset);
        float pure = is_pure(pixel + offset) ? 1.0 : 0.0;
        front_sum += pure * of_front * tap;
        back_sum += pure * of_back * tap;
        front_any += of_front * tap;
        back_any += of_back * tap;
        weights += vec4(pure * of_front, pure * of_back, of_front, of_back);
    }
    vec4 front_mean = weights.z > 0.0 ? front_any / weights.z : color;
    vec4 front_color = weights.x > 0.0 ? front_sum / weights.x : front_mean;
    vec4 back_color = weights.y > 0.0 ? back_sum / weights.y
        : weights.w > 0.0 ? back_any / weights.w : color;
    // Without a pure pixel, the one of a surface that differs most from the other surface.
#ifdef FIRST_SAMPLE
    vec4 best = back_color;
    float most = dot((best - front_color).rgb, (best - front_color).rgb);
    for (int i = split.mixed && weights.y == 0.0 ? 0 : TAPS; i < TAPS; ++i) {
        vec4 tap = color_of(pixel + tap_at(i));
        float apart = dot((tap - front_color).rgb, (tap - front_color).rgb);
        bool better = apart > most && abs(displacement_of(pixel + tap_at(i)) - split.back) < APART;
        best = better ? tap : best;
        most = better ? apart : most;
    }
    back_color = best;
#endif
    if (weights.x == 0.0) {
        vec4 farthest = split.shows_back ? front_mean : color;
        float distance = split.shows_back ? 0.0 : dot((color - back_color).rgb, (color - back_color).rgb);
        for (int i = split.mixed ? 0 : 8; i < 8; ++i) {
            vec4 tap = color_of(pixel + RING[i]);
            float apart = dot((tap - back_color).rgb, (tap - back_color).rgb);
            bool better = apart > distance && abs(displacement_of(pixel + RING[i]) - split.front) < APART;
            farthest = better ? tap : farthest;
            distance = better ? apart : distance;
        }
        front_color = farthest;
    }
    vec3 contrast = (front_color - back_color).rgb;
    float prior = split.shows_back ? 0.4 : 0.6;
    float share = clamp(
        (dot((color - back_color).rgb, contrast) + NOISE * prior) / (dot(contrast, contrast) + NOISE), 0.0, 1.0);
#ifdef FIRST_SAMPLE
    share = split.shows_back ? min(share, 0.75) : max(share, 0.25);
    bool none = split.shows_back && share < 0.1;
    bool all = share > 0.95;
#else
    share = max(share, 0.125);
    bool none = false;
    bool all = share > 0.95;
#endif
    bool full = !split.mixed || none || all;
    // Which side of the pixel does the front fill?
    uint side = EVENLY;
    int forward = mirrored ? -1 : 1;
    bool is_left = false;
    bool is_right = false;
    for (int i = full ? 2 : 0; i < 2; ++i) {
        Split beside = split_at(inside(pixel + ivec2(i == 0 ? -forward : forward, 0)));
        bool goes_on = abs(beside.front - split.front) < APART;
        is_left = is_left || (i == 0 && goes_on);
        is_right = is_right || (i == 1 && goes_on);
    }
    side = is_left && !is_right ? FROM_LEFT : is_right && !is_left ? FROM_RIGHT : EVENLY;
    float here = none || !split.mixed ? displacement_of(pixel) : split.front;
    layer = full ? pack_full(here) : pack_split(split.front, split.back, side);
    back = vec4(shared_back(color, front_color, back_color, share).rgb, full ? 1.0 : share);
}
#endif
