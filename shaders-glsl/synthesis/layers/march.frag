#version 310 es
// Gather over layers, pass 4: the target pixel is a box that is laid over the displaced source row.
//
// Surfaces of neighbouring pixels that are displaced alike are linked: between their middles they cover the box by the
// stripes of their masks. Where a surface ends, its stripes fade out; a back layer continues behind its front. From the
// nearest candidate on, each surface covers a part of the rest of the pixel. What remains is a disocclusion, filled
// from its background side.

#include "include/layers.glsl"
#include "include/span.glsl"
#include "include/trips.glsl"

TEXTURE(4) uniform highp usampler2D layer_map;
TEXTURE(5) uniform sampler2D back_map;

layout(location = 0) out vec4 color;
#ifdef SOURCE_MAP
layout(location = 1) out uint source_entry;
#endif

// The search ends when less than this share of the pixel is uncovered.
const float REST = 0.01;

// Slope of the cubic kernel at its first zero: `a` of Keys, "Cubic Convolution Interpolation for Digital Image
// Processing" (1981).
const float SLOPE = -0.75;
// Neighbouring colours that differ by no more than this are interpolated linearly.
const float ALIKE = 8.0 / 255.0;

uint layer_bits(int column, int row) {
    return texelFetch(layer_map, ivec2(column, row), 0).r;
}

Layer layer_at(int column, int row) {
    uint bits = layer_bits(column, row);
    vec2 both = split_displacements(bits);
    bool split = !is_full(bits);
    return Layer(split ? both.x : full_front(bits), split ? both.y : 1e9, split, bits >> 28);
}

// The front's coverage, by stripes, of the layer at this place.
vec4 mask_of(Layer layer, int column, int row) {
    if (!layer.split) {
        return vec4(1.0);
    }
#ifdef MULTISAMPLE
    return vec4((uvec4(layer.code) >> uvec4(0, 1, 2, 3)) & 1u);
#else
    float share = texelFetch(back_map, ivec2(column, row), 0).a;
    return layer.code == FROM_LEFT ? clamp(4.0 * share - STRIPES, 0.0, 1.0)
        : layer.code == FROM_RIGHT ? clamp(4.0 * share - STRIPES.wzyx, 0.0, 1.0) : vec4(share);
#endif
}

#ifdef HISTORY
// law.y * depth of the far plane.
float far_nearness() {
    return far_displacement - law.x;
}

// law.y * depth of a forward column's front.
float nearness_at(int x, int row) {
    uint bits = layer_bits(source_column(x), row);
    return far_nearness() + (is_full(bits) ? full_front(bits) : split_displacements(bits).x);
}
#include "include/history.glsl"
#endif

// The share of each stripe that is right of a place in the pixel, 0 to 1.
vec4 right_of(float place) {
    return clamp(STRIPES + 1.0 - 4.0 * place, 0.0, 1.0);
}

float covered(vec4 mask, vec4 stripes) {
    return 0.25 * dot(mask, stripes);
}

// Colour at a fractional forward column inside a surface: cubic along the row, clamped to the range of its two
// neighbours.
vec4 sharp_color_at(float x, int row) {
    int last = source_size.x - 1;
    int column = int(x);
    float f = x - float(column);
    vec4 here = color_texel(column, row);
    vec4 next = color_texel(min(column + 1, last), row);
    vec4 apart = abs(next - here);
    if (max(apart.r, max(apart.g, apart.b)) <= ALIKE) {
        return mix(here, next, f);
    }
    vec2 outer = SLOPE * f * (1.0 - f) * vec2(1.0 - f, f);
    float inner = ((SLOPE + 2.0) * f - (SLOPE + 3.0)) * f * f + 1.0;
    vec4 sum = outer.x * color_texel(max(column - 1, 0), row) + outer.y * color_texel(min(column + 2, last), row)
        + inner * here + (1.0 - inner - outer.x - outer.y) * next;
    return clamp(sum, min(here, next), max(here, next));
}

// Sum of the colours of a layer's front and back, with these weights.
vec4 weighted(int column, int row, float of_front, float of_back) {
    vec4 mixture = texelFetch(color_map, TEXEL_PLACE(in_image(ivec2(column, row))), 0);
    vec4 behind = texelFetch(back_map, ivec2(column, row), 0);
    float share = behind.a;
    behind.a = mixture.a;
    vec4 front = share < 1.0 ? clamp((mixture - (1.0 - share) * behind) / max(share, 0.01), 0.0, 1.0) : mixture;
    return of_front * front + of_back * behind;
}

// A place where the background of a hole begins.
struct Edge {
    // Column of the source's image; negative if there is none.
    int column;
    bool back;
    float reach;
    // Share of the pixel that it fills.
    float weight;
};

// The visible surface: column and displacement.
struct Seen {
    float rest;
    float column;
    float reach;
    bool hole;
};

// Covers a share of the uncovered rest with a surface, and returns the share of the pixel that it takes. The visible
// surface is the one with which the coverage from the front passes one half.
float cover(inout Seen seen, float share, float column, float reach) {
    float taken = seen.rest * share;
    bool passes = seen.rest > 0.5 && seen.rest - taken <= 0.5;
    seen.column = passes ? column : seen.column;
    seen.reach = passes ? reach : seen.reach;
    seen.rest -= taken;
    return taken;
}

// Returns the colour of a pixel beside a silhouette: what covers it from forward column `x` to `limit`, and the fill of
// what remains. `column` is `x` as a column of the source's image, `t` is the place of the pixel.
vec4 composed(int row, float t, float x, float limit, int column, inout Seen seen) {
    int sense = mirrored ? -1 : 1;
    vec4 color_sum = vec4(0.0);
    Layer here = layer_at(column, row);
    Edge edge = Edge(-1, false, 1e9, 1.0);
    Edge second = edge;
#ifdef HISTORY
    // Displacement of the foreground beside the edge.
    float beside = 1e9;
#endif
    // Left of all surfaces, the border of the image is the background.
    if (x == 0.0) {
        if (here.front > t) {
            edge = Edge(column, false, here.front, 1.0);
        }
        if (here.split && here.back < edge.reach && here.back > t) {
            edge = Edge(column, true, here.back, 1.0);
        }
    }
    // Whether the pixel's back is linked, on the left, to a front or to a back.
    bool on_front = false;
    bool on_back = false;
    if (x > 0.0 && here.split) {
        Layer before = layer_at(column - sense, row);
        on_front = abs(before.front - here.back) < LINK;
        on_back = before.split && abs(before.back - here.back) < LINK;
    }
    while (x < limit && seen.rest > REST) {
        COUNT_TRIP(1)
        // Skip pairs of columns that change nothing.
        Layer next = here;
        float a = 0.0;
        float b = 0.0;
        float c = 0.0;
        float d = 0.0;
        bool front_front = false;
        bool front_back = false;
        bool back_front = false;
        bool back_back = false;
        bool event = false;
        while (!event && x < limit) {
            COUNT_TRIP(2)
            next = layer_at(column + sense, row);
            // Where the four surfaces land, relative to the pixel.
            a = x + here.front - t;
            b = x + 1.0 + next.front - t;
            c = x + here.back - t;
            d = x + 1.0 + next.back - t;
            front_front = abs(next.front - here.front) < LINK;
            front_back = abs(next.back - here.front) < LINK;
            back_front = abs(next.front - here.back) < LINK;
            back_back = here.split && abs(next.back - here.back) < LINK;
            bool crosses = (a <= 0.0 && ((front_front && b > 0.0) || (front_back && d > 0.0)))
                || (c <= 0.0 && ((back_front && b > 0.0) || (back_back && d > 0.0)));
            // A surface that ends left of the pixel matters beyond it only beside a nearer one: that is a disocclusion.
            bool front_begins = !front_front && !back_front && b > 0.0 && b < 1.0;
            bool front_ends = !front_front && !front_back && a <= 0.0 && (a > -1.0 || next.front > here.front);
            bool back_ends = !back_front && !back_back && c < 1.0 && (c > -1.0 || next.front > here.back);
            event = crosses || front_begins || front_ends || back_ends;
            if (!event) {
                x += 1.0;
                column += sense;
                here = next;
                on_front = front_back;
                on_back = back_back;
            }
        }
        if (!event) {
            break;
        }
        vec4 here_mask = mask_of(here, column, row);
        vec4 next_mask = mask_of(next, column + sense, row);
        // Distances between the fronts and the backs of this column and the next.
        vec2 fronts = vec2(0.0);
        vec2 backs = vec2(0.0);
        if (front_front && a <= 0.0 && b > 0.0) {
            float g = -a / (b - a);
            vec4 right = right_of(g);
            vec2 shares = vec2(covered(here_mask, right), covered(next_mask, 1.0 - right));
            float share = shares.x + shares.y;
            fronts = cover(seen, share, x + g, mix(here.front, next.front, g)) * shares / max(share, 1e-6);
        }
        // A front that begins or ends here, before a farther surface.
        if (!front_front && (next.front > here.front || next.split) && !back_front && b > 0.0 && b < 1.0) {
            float share = covered(next_mask, 1.0 - right_of(1.0 - b));
            fronts.y += cover(seen, share, x + 1.0, next.front);
        }
        if (!front_front && (next.front < here.front || here.split) && !front_back && a <= 0.0 && a > -1.0) {
            fronts.x += cover(seen, covered(here_mask, right_of(-a)), x, here.front);
        }
        // A surface that continues behind a front covers all that remains.
        if (front_back && a <= 0.0 && d > 0.0 && seen.rest > REST) {
            float g = -a / (d - a);
            float taken = cover(seen, 1.0, x + g, here.front);
            fronts.x += taken * (1.0 - g);
            backs.y += taken * g;
        }
        if (back_front && c <= 0.0 && b > 0.0 && seen.rest > REST) {
            float g = -c / (b - c);
            float taken = cover(seen, 1.0, x + g, next.front);
            backs.x += taken * (1.0 - g);
            fronts.y += taken * g;
        }
        if (back_back && c <= 0.0 && d > 0.0 && seen.rest > REST) {
            float g = -c / (d - c);
            float taken = cover(seen, 1.0, x + g, here.back);
            backs += taken * vec2(1.0 - g, g);
        }
        bool ends = here.split && !back_front && !back_back;
        // A back that no neighbour continues covers only its samples.
        if (ends && !on_front && !on_back && abs(c) < 1.0 && seen.rest > REST) {
            vec4 stripes = c <= 0.0 ? right_of(-c) : 1.0 - right_of(1.0 - c);
            backs.x += cover(seen, covered(1.0 - here_mask, stripes), x, here.back);
        }
        // Disocclusion edges. A sliver of background that no neighbour continues fills only its share of the pixel; the
        // next farthest edge fills the rest of the hole.
        bool at_back = ends && next.front > here.back && c <= 0.0;
        bool at_front = !here.split && !front_front && !front_back && next.front > here.front && a <= 0.0;
        if ((at_back || at_front) && seen.rest > REST) {
            float reach = at_back ? here.back : here.front;
            float away = at_back ? -c : -a;
            float weight = at_back && !on_front ? 1.0 - covered(here_mask, vec4(1.0)) : 1.0;
            Edge found = Edge(column, at_back, reach, weight);
            if (weight == 1.0 && away < 0.5) {
                float taken = cover(seen, 1.0, x, reach);
                backs.x += at_back ? taken : 0.0;
                fronts.x += at_back ? 0.0 : taken;
            }
            if (reach < edge.reach) {
                if (weight < 1.0) {
                    second = edge;
                }
                edge = found;
#ifdef HISTORY
                beside = next.front;
#endif
            } else if (reach < second.reach) {
                second = found;
            }
        }
        if (max(fronts.x, backs.x) > 0.0) {
            color_sum += weighted(column, row, fronts.x, backs.x);
        }
        if (max(fronts.y, backs.y) > 0.0) {
            color_sum += weighted(column + sense, row, fronts.y, backs.y);
        }
        on_front = front_back;
        on_back = back_back;
        here = next;
        column += sense;
        x += 1.0;
    }
    seen.hole = seen.rest > 0.5;
    if (seen.rest > REST) {
        bool beyond = edge.column < 0;
        if (beyond) {
            // The pixel is right of all surfaces, or on the last column itself.
            edge = Edge(column, here.split, here.split ? here.back : here.front, 1.0);
        }
        float edge_x = float(source_column(edge.column));
        float away = abs(t - edge_x - edge.reach);
        float spread = 0.5 * clamp(away, 1.0, 12.0);
        vec4 sum = vec4(0.0);
        float weights = 0.0;
        int rows = beyond && away < 0.5 ? 0 : 2;
        for (int i = -rows; i <= rows; ++i) {
            COUNT_TRIP(3)
            int at = clamp(row + int(roundEven(float(i) * spread)), 0, source_size.y - 1);
            Layer layer = layer_at(edge.column, at);
            bool front = i == 0 ? !edge.back : layer.front <= edge.reach + 1.0;
            bool behind = i == 0 ? edge.back : !front && layer.split && layer.back <= edge.reach + 1.0;
            float weight = i == 0 ? 2.0 : front ? 1.0 : behind ? 1.0 - covered(mask_of(layer, edge.column, at), vec4(1.0)) : 0.0;
            sum += weighted(edge.column, at, front ? weight : 0.0, front ? 0.0 : weight);
            weights += weight;
        }
        vec4 fill = sum / weights;
        if (second.column >= 0 && edge.weight < 1.0) {
            vec2 one = second.back ? vec2(0.0, 1.0) : vec2(1.0, 0.0);
            fill = mix(weighted(second.column, row, one.x, one.y), fill, edge.weight);
        }
        seen.hole = seen.hole && away >= 0.5;
#ifdef HISTORY
        float depth = (edge.reach + far_nearness()) / law.y;
        float origin = origins.x * gl_FragCoord.x + origins.y;
        if (away >= 0.5 && recall(gl_FragCoord.xy - vec2(target_origin), beside + far_nearness(), origin, row, fill, depth)) {
            edge.reach = law.y * depth - far_nearness();
        }
#endif
        color_sum += cover(seen, 1.0, edge_x, edge.reach) * fill;
    }
    return color_sum;
}

void main() {
    float last = float(source_size.x - 1);
    int row = int(clamp(gl_FragCoord.y - first_row, 0.0, float(source_size.y - 1)));
    // Displacements and target column are relative to the far plane's displacement. `farthest` contains a hundredth of
    // a pixel for rounding.
    float t = origins.x * gl_FragCoord.x + origins.y - farthest + 0.01;
    uint span = pixel_span().x;
    float x = clamp(floor(t - uintBitsToFloat(span) - 1.01), 0.0, last);
    float limit = min(x + span_steps(span) + 2.0, last);
    int sense = mirrored ? -1 : 1;
    int column = source_column(int(x));

    Seen seen = Seen(1.0, 0.0, 0.0, false);
    // Nearly every pixel shows a single surface that is linked from the start of the search on.
    uint bits = layer_bits(column, row);
    float front = full_front(bits);
    float at = x + front - t;
    bool plain = is_full(bits) && at <= 0.0;
    while (plain && x < limit) {
        COUNT_TRIP(0)
        bits = layer_bits(column + sense, row);
        float following = full_front(bits);
        plain = is_full(bits) && abs(following - front) < LINK;
        float then = x + 1.0 + following - t;
        if (plain && then > 0.0) {
            float g = -at / (then - at);
            cover(seen, 1.0, x + g, mix(front, following, g));
            limit = x;
        } else if (plain) {
            x += 1.0;
            column += sense;
            front = following;
            at = then;
        }
    }
    if (seen.rest < REST) {
        color = sharp_color_at(seen.column, row);
    } else {
        color = composed(row, t, x, limit, column, seen);
    }
#ifdef COUNT_TRIPS
    // The columns of the first loop, the pairs of columns with an event, all pairs, and the rows of the fill, whose
    // highest bit is set if the source's pixel at this place shows two surfaces.
    bool split = !is_full(layer_bits(int(gl_FragCoord.x), row));
    color = vec4(min(ivec4(trips[0], trips[1], trips[2], trips[3] | (split ? 128 : 0)), 255)) / 255.0;
#endif
#ifdef WRITE_DEPTH
    gl_FragDepth = clamp((far_displacement + seen.reach - law.x) / law.y, 0.0, 1.0);
#endif
#ifdef SOURCE_MAP
    source_entry = uint(seen.column * FIXED + 0.5) | (seen.hole ? HOLE : 0u);
#endif
}
