#include "include/warp.glsl"

// Disocclusions looked up in a history: an image of the synthesized eye that was really rendered, in this frame or in former ones.
// It consists of strips of equally many rows, each rendered from a pose of its own.

// Most strips of a history.
const int STRIPS = 8;

uniform sampler2D history_depth;
uniform sampler2D history_color;
uniform int history_strips;
// From a pixel of the target and its depth to a pixel of a strip and its depth, and back. Zero for strips with nothing in them.
uniform mat4 to_history[STRIPS];
uniform mat4 from_history[STRIPS];

// Rows of a strip.
int strip_rows() {
    return (textureSize(history_depth, 0).y + history_strips - 1) / history_strips;
}

// Returns the strip that shows a place of the target, or -1; and the place there.
int strip_of(vec3 target, out vec3 place) {
    vec2 size = vec2(textureSize(history_depth, 0));
    float rows = float(strip_rows());
    // That of the pixel's own row; and after a turn of the head, the one in whose rows the first shows the place.
    int strip = int(target.y / float(target_size.y) * size.y / rows);
    int found = -1;
    for (int i = 0; i < 2 && found < 0; ++i) {
        strip = clamp(strip, 0, history_strips - 1);
        vec4 seen = to_history[strip] * vec4(target, 1.0);
        place = seen.xyz / seen.w;
        int landed = int(place.y / rows);
        bool inside = seen.w > 0.0 && all(greaterThanEqual(place.xy, vec2(0.0))) && all(lessThan(place.xy, size));
        found = inside && landed == strip ? strip : -1;
        strip = landed;
    }
    return found;
}

// Looks a pixel of a disocclusion up, at the depth of its background. If its surface is there, `color` and `depth` become those
// of that surface, and the result is true. `pixel` is its middle, counted from the target's corner, `front` law.y * depth of
// the foreground beside it, `origin` as in the march.
//
// What the history shows is taken if it is behind the foreground's edge and the rendered eye does not see past it: else it is not
// what was uncovered, or it has moved since.
bool recall(vec2 pixel, float front, float origin, int row, inout vec4 color, inout float depth) {
    vec3 place;
    int strip = strip_of(vec3(pixel, depth), place);
    if (strip < 0) {
        return false;
    }
    ivec2 nearest = ivec2(place.xy);
    float seen = texelFetch(history_depth, nearest, 0).r;
    vec4 back = from_history[strip] * vec4(place.xy, seen, 1.0);
    vec3 here = back.xyz / back.w;
    float nearness = law.y * here.z;
    float last = float(source_size.x - 1);
    float column = floor(origin - nearness);
    bool outside = !(column >= 0.0 && column < last);
    int x = int(clamp(column, 0.0, max(last - 1.0, 0.0)));
    float before = max(nearness_at(x, row), nearness_at(min(x + 1, source_size.x - 1), row));
    bool same = distance(here.xy, pixel) < 1.0;
    bool behind = nearness <= front - 0.25 * (front - law.y * depth);
    bool hidden = outside || before > nearness - 1.0;
    int exact = strip_of(vec3(pixel, here.z), place);
    if (!(same && behind && hidden) || exact < 0) {
        return false;
    }
    // Filtered where all four texels show this surface.
    ivec2 size = textureSize(history_depth, 0);
    int rows = strip_rows();
    ivec2 least = ivec2(0, exact * rows);
    ivec2 most = ivec2(size.x, min((exact + 1) * rows, size.y)) - 1;
    vec2 at = clamp(place.xy, vec2(least) + 0.5, vec2(most) + 0.5);
    ivec2 corner = ivec2(at - 0.5);
    bool whole = true;
    for (int i = 0; i < 4; ++i) {
        ivec2 texel = min(corner + ivec2(i & 1, i >> 1), most);
        whole = whole && abs(law.y * (texelFetch(history_depth, texel, 0).r - seen)) < 1.0;
    }
    color = whole ? textureLod(history_color, at / vec2(size), 0.0) : texelFetch(history_color, nearest, 0);
    depth = here.z;
    return true;
}
