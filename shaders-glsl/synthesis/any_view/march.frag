#version 310 es
// Any view, pass 3: the ray of each target pixel appears in the source image as a segment. The search walks along it,
// from the place that its tile's span gives to that of the far plane, and skips tiles that hold no depth of the ray.
//
// A surface at inverse distance s from the source, seen at the target pixel p, lies at the source pixel
// `q + s * (e.xy - e.z * q)`, where q is the pixel of p's ray at infinity and e the epipole in homogeneous pixels. It
// is affine in s, and so in the stored depth. The rules for surfaces and silhouettes are those of gather
// (include/segments.glsl), with samples along the segment in place of a row's columns; include/fill.glsl fills the holes
// of both.

#include "include/any_view.glsl"

TEXTURE(2) uniform highp usampler2D tile_map;
TEXTURE(3) uniform highp usampler2D span_map;

layout(location = 0) out vec4 color;

// The segment of a target pixel. Samples are one pixel apart along its longer axis; integer indices are the middles of
// pixels.
struct Segment {
    // True if the longer axis runs along a column, so that indices on it are rows.
    bool steep;
    // Direction of samples from near to far: 1 or -1.
    float sense;
    // Indices of the far plane's place on the longer axis and on the other axis.
    float far;
    float far_beside;
    // Change of the other index per step of the longer axis's index.
    float slope;
    // A sample lands at `sense * (index - far) + law * (depth - far_depth)`, in pixels relative to the target pixel.
    float law;
};

// A place on the segment. `beside` is fractional, between two neighbouring pixels, if these show one surface.
struct Sample {
    float index;
    float beside;
    float depth;
};

ivec2 pixel_of(Segment line, float index, float beside) {
    return ivec2(line.steep ? vec2(beside, index) : vec2(index, beside));
}

// The last indices on the longer and on the other axis.
vec2 last_indices(Segment line) {
    vec2 last = vec2(source_size - 1);
    return line.steep ? last.yx : last;
}

float depth_of(Segment line, float index, float beside) {
    ivec2 pixel = pixel_of(line, index, beside);
    return depth_texel(pixel.x, pixel.y);
}

vec4 color_of(Segment line, Sample at) {
    vec2 index = line.steep ? vec2(at.beside, at.index) : vec2(at.index, at.beside);
    return color_sample((vec2(source_origin) + index + 0.5) * texel);
}

float beside_at(Segment line, float index) {
    return line.far_beside + line.slope * (index - line.far);
}

float landing(Segment line, float index, float depth) {
    return line.sense * (index - line.far) + line.law * (depth - far_depth);
}

Sample sample_at(Segment line, float index) {
    float last = last_indices(line).y;
    float beside = clamp(beside_at(line, index), 0.0, last);
    float low = floor(beside);
    float here = depth_of(line, index, low);
    float next = depth_of(line, index, min(low + 1.0, last));
    float t = beside - low;
    bool whole = abs(line.law * (next - here)) < MAX_STRETCH - 1.0;
    bool upper = t >= 0.5;
    return Sample(index, whole ? beside : low + float(upper), whole ? mix(here, next, t) : upper ? next : here);
}

// Number of steps from a sample to the first one beyond its tile.
float steps_in_tile(Segment line, float index, float beside) {
    vec2 tile = line.steep ? vec2(TILE.yx) : vec2(TILE);
    vec2 in_tile = mod(vec2(index, floor(beside)), tile);
    float along = line.sense > 0.0 ? tile.x - in_tile.x : in_tile.x + 1.0;
    float drift = line.sense * line.slope;
    float room = drift > 0.0 ? tile.y - in_tile.y - fract(beside) : in_tile.y + fract(beside);
    return max(min(along, abs(drift) * along > room ? floor(room / abs(drift)) + 1.0 : along), 1.0);
}

// True if a surface of the tile may land within a pixel of the target pixel, from this sample on for some steps.
bool lands(Segment line, float index, float beside, float steps) {
    uvec2 bounds = texelFetch(tile_map, pixel_of(line, index, floor(beside)) / TILE, 0).rg;
    vec2 ends = vec2(landing(line, index, uintBitsToFloat(bounds.x)), landing(line, index, uintBitsToFloat(bounds.y)));
    return min(ends.x, ends.y) <= 1.0 && max(ends.x, ends.y) + steps >= -1.0;
}

// The background next to a hole.
struct Edge {
    Segment line;
    Sample at;
};

// The sample as many pixels to the side of the segment.
vec4 tap_beside(Edge edge, float distance, out float nearer) {
    float beside = clamp(floor(edge.at.beside + 0.5) + distance, 0.0, last_indices(edge.line).y);
    Sample tap = Sample(edge.at.index, beside, depth_of(edge.line, edge.at.index, beside));
    nearer = edge.line.law * (tap.depth - edge.at.depth);
    return color_of(edge.line, tap);
}

#include "include/fill.glsl"

// Returns the depth that the target stores for a surface with this depth in the source. `scale` is the third component
// of the ray in the source.
float target_depth(float depth, float scale) {
    float inverse = source_law.x + source_law.y * depth;
    float seen = inverse * scale / (1.0 - inverse * to_source_w.w);
    return clamp((seen - target_law.x) / target_law.y, 0.0, 1.0);
}

void main() {
    vec3 pixel = vec3(gl_FragCoord.xy - vec2(target_origin), 1.0);
    vec3 ray = vec3(dot(to_source_x.xyz, pixel), dot(to_source_y.xyz, pixel), dot(to_source_w.xyz, pixel));
    vec2 infinity = ray.xy / ray.z;
    // Pixels per unit of inverse distance.
    vec2 parallax = vec2(to_source_x.w, to_source_y.w) - to_source_w.w * infinity;
    vec2 far = infinity + (source_law.x + source_law.y * far_depth) * parallax - 0.5;
    vec2 moved = source_law.y * parallax;
    Segment line;
    line.steep = abs(moved.y) > abs(moved.x);
    if (line.steep) {
        far = far.yx;
        moved = moved.yx;
    }
    float reach = moved.x * (nearest - far_depth);
    line.sense = reach > 0.0 ? -1.0 : 1.0;
    line.far = far.x;
    line.far_beside = far.y;
    line.slope = moved.x == 0.0 ? 0.0 : moved.y / moved.x;
    line.law = -line.sense * moved.x;
    // The search goes from just before the nearest place in the tile's span to just behind the farthest one, with a
    // hundredth of a pixel for rounding. Samples beyond the borders repeat the border.
    ivec2 tile = ivec2(pixel.xy) / TILE;
    reach = moved.x * (uintBitsToFloat(texelFetch(span_map, tile, 0).r) - far_depth);
    vec2 last = last_indices(line);
    float middle = line.sense * line.far;
    float first = clamp(line.sense * floor(middle - abs(reach) - 0.01), 0.0, last.x);
    float end = clamp(line.sense * (floor(middle + 0.01) + 1.0), 0.0, last.x);
    float left = line.sense * (end - first);

    // The search keeps only indices and depths, since registers are scarce.
    float index = first;
    float depth = sample_at(line, first).depth;
    float b = landing(line, first, depth);
    float a = b;
    bool found = false;
    // Before all samples, the border of the image is the background.
    bool outside = b > 0.0 && first == (line.sense > 0.0 ? 0.0 : last.x);
    // Index of the hole's background; negative if there is none.
    float edge = outside ? first : -1.0;
    float edge_depth = depth;
    left = outside && b < 0.5 ? 0.0 : left;
    // Index of the nearest silhouette beside the pixel; negative if there is none.
    float rim = -1.0;
    while (left > 0.0 && !found) {
        float beside = clamp(beside_at(line, index), 0.0, last.y);
        float steps = min(steps_in_tile(line, index, beside), left);
        bool walked = lands(line, index, beside, steps);
        left -= steps;
        if (!walked) {
            // The tile's bounds include the first sample beyond it.
            index += line.sense * steps;
            depth = sample_at(line, index).depth;
            b = landing(line, index, depth);
        }
        for (; walked && steps > 0.0 && !found; steps -= 1.0) {
            a = b;
            float before = depth;
            index += line.sense;
            depth = sample_at(line, index).depth;
            b = landing(line, index, depth);
            found = is_seen(a, b);
            rim = rim < 0.0 && has_rim(a, b) ? index - (folds(a, b) ? line.sense : 0.0) : rim;
            if (jumps(a, b) && (edge < 0.0 || line.law * (before - edge_depth) < 0.0)) {
                edge = index - line.sense;
                edge_depth = before;
            }
        }
    }
    // If nothing is found, take the hole's edge, or the last sample if the pixel is beyond all of them.
    Sample here = sample_at(line, found || edge < 0.0 ? index : edge);
    if (found) {
        Sample before = sample_at(line, index - line.sense);
        float t = is_torn(a, b) ? 0.0 : -a / (b - a);
        depth = mix(before.depth, here.depth, t);
        color = mix(color_of(line, before), color_of(line, here), t);
    } else {
        depth = here.depth;
        color = color_of(line, here);
        float away = landing(line, here.index, depth);
        if (abs(away) >= 0.5) {
            color = fill_hole(Edge(line, here), color, away);
        }
    }
    if (rim >= 0.0) {
        Sample silhouette = sample_at(line, rim);
        float coverage = 1.0 - abs(landing(line, rim, silhouette.depth));
        color = mix(color, color_of(line, silhouette), coverage);
        depth = coverage >= 0.5 ? silhouette.depth : depth;
    }
#ifdef WRITE_DEPTH
    gl_FragDepth = target_depth(depth, ray.z);
#endif
}
