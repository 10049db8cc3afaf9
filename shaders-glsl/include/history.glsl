#include "include/warp.glsl"

// Looks up disocclusions in a history: an image of the synthesized eye that was really rendered, in this frame or in
// earlier ones. It consists of strips of equally many rows, each rendered from a pose of its own.

// The maximum number of strips in a history.
const int STRIPS = 8;

TEXTURE(10) uniform sampler2D history_depth;
TEXTURE(11) uniform sampler2D history_color;
#ifdef UNIFORM_BLOCK
BLOCK(12) uniform History {
#endif
// For each strip, maps a pixel of the target and its depth to a pixel of the strip's image and its depth. Zero for
// empty strips.
UNIFORM mat4 to_history[STRIPS];
UNIFORM int history_strips;
#ifdef UNIFORM_BLOCK
};
#endif

// Looks up a pixel of a disocclusion at the depth of its background. If the history has its surface, sets `color` and
// `depth` to that surface's and returns true. `pixel` is the middle of the pixel, counted from the target's corner,
// `front` is law.y * depth of the foreground beside the disocclusion, and `origin` is that of the march.
//
// A surface from the history is taken only if it is behind the foreground's edge and the rendered eye sees nothing
// behind it. Otherwise it is not what was uncovered, or it has moved since.
bool recall(vec2 pixel, float front, float origin, int row, inout vec4 color, inout float depth) {
    vec2 size = vec2(textureSize(history_depth, 0));
    vec2 scale = size / vec2(target_size);
    float rows = float((int(size.y) + history_strips - 1) / history_strips);
    // Begin with the strip of the pixel's own row. After a turn of the head, the place may be in the rows of another
    // strip, which is tried second.
    vec2 guess = pixel * scale;
    vec4 seen;
    int strip;
    for (int i = 0; i < 2; ++i) {
        strip = int(clamp(guess.y / rows, 0.0, float(history_strips - 1)));
        seen = to_history[strip] * vec4(pixel, depth, 1.0);
        guess = seen.w > 0.0 ? seen.xy / seen.w : guess;
    }
    bool inside = all(greaterThanEqual(guess, vec2(0.0))) && all(lessThan(guess, size));
    if (!(seen.w > 0.0 && inside && int(guess.y / rows) == strip)) {
        return false;
    }
    // The depth that is stored there, and the place at which the pixel's ray has this depth.
    float stored = texelFetch(history_depth, ivec2(guess), 0).r;
    vec4 along = to_history[strip][2];
    float farther = (stored * seen.w - seen.z) / (along.z - stored * along.w);
    seen += farther * along;
    vec2 place = seen.xy / seen.w;
    float here = depth + farther;
    float nearness = law.y * here;
    float last = float(source_size.x - 1);
    float column = floor(origin - nearness);
    bool outside = !(column >= 0.0 && column < last);
    int x = int(clamp(column, 0.0, max(last - 1.0, 0.0)));
    float before = max(nearness_at(x, row), nearness_at(min(x + 1, source_size.x - 1), row));
    bool same = length((place - guess) / scale) < 1.0;
    bool behind = nearness <= front - 0.25 * (front - law.y * depth);
    bool hidden = outside || before > nearness - 1.0;
    if (!(same && behind && hidden)) {
        return false;
    }
    // Filter only if all four texels show this surface.
    vec2 least = vec2(0.5, float(strip) * rows + 0.5);
    vec2 most = vec2(size.x, min(float(strip + 1) * rows, size.y)) - 0.5;
    place = clamp(place, least, most);
    ivec2 corner = ivec2(place - 0.5);
    bool whole = true;
    for (int i = 0; i < 4; ++i) {
        ivec2 texel = min(corner + ivec2(i & 1, i >> 1), ivec2(most));
        whole = whole && abs(law.y * (texelFetch(history_depth, texel, 0).r - stored)) < 1.0;
    }
    color = textureLod(history_color, (whole ? place : floor(guess) + 0.5) / size, 0.0);
    depth = here;
    return true;
}
