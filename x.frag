#version 310 es
#define MULTISAMPLE
#define WRITE_DEPTH
#define SOURCE_MAP
// Included before everything else, since GLSL wants its extensions before the first declaration.
#ifdef MULTIVIEW
#extension GL_OVR_multiview2 : require
#endif
#ifdef CLIP_DISTANCE
#extension GL_EXT_clip_cull_distance : require
#endif
precision highp float;
precision highp int;
precision highp sampler2D;
precision highp usampler2D;
precision highp sampler2DShadow;
precision highp sampler2DArray;
// Gather over layers, pass 4: the target pixel is a box that is laid over the displaced source row.
//
// Surfaces of neighbouring pixels that are displaced alike are linked: between their middles they cover the box by the
// stripes of their masks. Where a surface ends, its stripes fade out; a back layer is taken to go on behind its front.
// From the nearest candidate on, each adds to what the ones before leave uncovered, and what remains is a
// disocclusion, filled from its background side.

// How columns move from the rendered eye to the other one; app/core/src/eyes/warp.rs, `Warp`.
//
// All synthesis shaders count columns "forward": in the direction in which nearer surfaces lie further along in
// the target image. That is left to right when the left eye is synthesized and right to left for the right eye,
// so one code serves both. A column's displacement grows with nearness, and of all source pixels that meet at
// one target the nearest has the smallest forward column: the occlusion-compatible order.

// What the synthesis passes are given: plain uniforms for OpenGL, and where UNIFORM_BLOCK is the qualifier of a std140
// block, such as Vulkan's push constants, one block. app/core/src/synthesis/uniforms.rs fills it; docs/library.md has
// the table of offsets.

#ifdef UNIFORM_BLOCK
#define UNIFORM
UNIFORM_BLOCK uniform Synthesis {
#else
#define UNIFORM uniform
#endif
UNIFORM ivec2 source_size;
UNIFORM ivec2 target_size;
// Displacement in pixels, in forward columns: law.x + law.y * depth.
UNIFORM vec2 law;
UNIFORM bool mirrored;
// Target row minus source row.
UNIFORM int row_offset;
// Corner of the target in its framebuffer, on the side of row 0.
UNIFORM ivec2 target_origin;
// Displacement of the far plane: the smallest there is.
UNIFORM float far_displacement;
// Displacement of the near plane: bounds how far away a source tile can be.
UNIFORM float near_displacement;
// Texture coordinate of the source at forward column x (its middle is at x + 0.5): columns.x * x + columns.y.
UNIFORM vec2 columns;
// Source column that the law's offset alone takes to the pixel: origins.x * gl_FragCoord.x + origins.y.
UNIFORM vec2 origins;
// Place of the pixel's span: span_place.xy * gl_FragCoord.xy + span_place.zw, a texture coordinate, or with PART in tiles.
UNIFORM vec4 span_place;
// rows.x * gl_FragCoord.y + rows.y is the source row's texture coordinate.
UNIFORM vec2 rows;
// Middle of the source row: gl_FragCoord.y - first_row.
UNIFORM float first_row;
// Displacement of the far plane beyond the law's offset, and a hundredth of a pixel for rounding: a crossing that
// starts at the span's end must not be missed.
UNIFORM float farthest;
// With PART: the source's corner in its image, on the side of row 0, and one pixel in texture coordinates.
UNIFORM ivec2 source_origin;
UNIFORM vec2 texel;
#ifdef UNIFORM_BLOCK
};
#endif

// Textures have their places in the text for Vulkan, and are given them by name in OpenGL.
#ifdef VULKAN
#define TEXTURE(n) layout(set = 0, binding = n)
// The source is a part of its image, or the maps are larger than they need be: what lies beside is not read.
layout(constant_id = 0) const bool PART = false;
#else
#define TEXTURE(n)
const bool PART = false;
#endif

TEXTURE(0) uniform sampler2D depth_map;
TEXTURE(1) uniform sampler2D color_map;

// Source map entries: this bit marks a hole; the rest is the source column in 1/65536 pixel.
const uint HOLE = 0x80000000u;
const float FIXED = 65536.0;

// A surface that is stretched more than this is taken for two surfaces with a disocclusion between them.
const float MAX_STRETCH = 2.0;

int source_column(int x) {
    return mirrored ? source_size.x - 1 - x : x;
}

float displacement(float depth) {
    return law.x + law.y * depth;
}

// A place in the source as one in its image.
ivec2 in_image(ivec2 pixel) {
    return PART ? source_origin + pixel : pixel;
}

// Depth at a column from the left border of the source.
float depth_texel(int column, int row) {
    return texelFetch(depth_map, in_image(ivec2(column, row)), 0).r;
}

float depth_at(int x, int row) {
    return depth_texel(source_column(x), row);
}

float displacement_at(int x, int row) {
    return displacement(depth_at(x, row));
}

// Colour at a fractional forward column, linear between its two neighbours in the row.
vec4 color_at(float x, int row) {
    float column = mirrored ? float(source_size.x - 1) - x : x;
    vec2 at = vec2(column, float(row)) + 0.5;
    at = PART ? (vec2(source_origin) + at) * texel : at / vec2(source_size);
    return textureLod(color_map, at, 0.0);
}

vec4 color_texel(int x, int row) {
    return texelFetch(color_map, in_image(ivec2(source_column(x), row)), 0);
}

#ifndef COMPUTE
// Forward target column and source row of this fragment.
ivec2 target_pixel() {
    ivec2 pixel = ivec2(gl_FragCoord.xy) - target_origin;
    int column = mirrored ? target_size.x - 1 - pixel.x : pixel.x;
    return ivec2(column, clamp(pixel.y - row_offset, 0, source_size.y - 1));
}
#endif

// Tiles in forward columns and source rows. A tile holds two displacements, relative to the far plane's, in
// 1/16 pixel, in one 32-bit integer: ES renders to R32UI everywhere.

const ivec2 TILE = ivec2(16, 8);
const float TILE_UNITS = 16.0;

#ifdef TEXTURE_GATHER
// Depths of forward columns x and x + 1 in rows y and y + 1, in the order of textureGather; beyond the borders those
// of the border, or with PART those of the last two, which are in the tile or beside it.
vec4 depth_quad(vec2 corner) {
    corner = PART ? clamp(corner, vec2(0.0), vec2(max(source_size - 2, ivec2(0)))) : corner;
    float row = corner.y + 1.0;
    row = PART ? (float(source_origin.y) + row) * texel.y : row / float(source_size.y);
    return textureGather(depth_map, vec2(columns.x * (corner.x + 1.0) + columns.y, row));
}
#endif

uint pack_interval(float low, float high) {
    float lowest = clamp(floor((low - far_displacement) * TILE_UNITS), 0.0, 65534.0);
    float highest = clamp(ceil((high - far_displacement) * TILE_UNITS), 0.0, 65535.0);
    return uint(lowest) | (uint(highest) << 16);
}

// A span says where a target tile's search begins and how long it is: the largest displacement, relative to the far
// plane's, that lands in the tile, in pixels, as a float whose last bits count the columns to walk from there. They
// make it larger by less than 1/8192 of itself. A count of all ones means: as far as there are columns.
const uint SPAN_COLUMNS = 0x3ffu;

float span_steps(uint span) {
    uint steps = span & SPAN_COLUMNS;
    return steps == SPAN_COLUMNS ? 1e9 : float(steps);
}

uint pack_span(float reach, float columns) {
    return ((floatBitsToUint(reach) + SPAN_COLUMNS) & ~SPAN_COLUMNS) | min(uint(columns), SPAN_COLUMNS);
}

// What a source pixel shows: a front surface and, where that covers a part of the pixel only, the surface behind it.
// Coverage is told by stripes, the quarters of the pixel from left to right in forward columns: the four samples of a
// rotated grid lie in four different ones.
//
// One 32-bit integer per pixel. Bits 28 to 31 are FULL for a single surface, whose displacement is in bits 0 to 27;
// otherwise the front's is in bits 0 to 13, the back's in bits 14 to 27. Displacements are relative to the far plane's,
// in fractions of the distance to the near plane's. A second map has the back's colour, and the front's share in alpha;
// the front's colour follows from both and the resolved one.

const uint FULL = 15u;
// With depth of all samples the bits are the stripes that the front covers. With one depth they tell which side of the
// pixel it fills: its share is known, its place follows from the neighbours.
const uint EVENLY = 0u;
const uint FROM_LEFT = 1u;
const uint FROM_RIGHT = 2u;

const float FULL_STEPS = 268435455.0;
const float SPLIT_STEPS = 16383.0;
const vec4 STRIPES = vec4(0.0, 1.0, 2.0, 3.0);

// Displacements closer than this, in pixels, are one surface.
const float LINK = 0.5;

struct Layer {
    // Displacement, in pixels, relative to the far plane's.
    float front;
    // Of the surface behind it; not there without `split`.
    float back;
    bool split;
    // The front's coverage by stripes.
    vec4 mask;
};

uint pack_full(float front) {
    float range = near_displacement - far_displacement;
    return (FULL << 28) | uint(clamp(front / range, 0.0, 1.0) * FULL_STEPS);
}

uint pack_split(float front, float back, uint mask) {
    float range = near_displacement - far_displacement;
    uvec2 steps = uvec2(clamp(vec2(front, back) / range, 0.0, 1.0) * SPLIT_STEPS + 0.5);
    return (mask << 28) | (steps.y << 14) | steps.x;
}

bool is_full(uint layer) {
    return layer >> 28 == FULL;
}

float full_front(uint layer) {
    return float(layer & 0xfffffffu) * ((near_displacement - far_displacement) / FULL_STEPS);
}

// Front and back.
vec2 split_displacements(uint layer) {
    float step = (near_displacement - far_displacement) / SPLIT_STEPS;
    return vec2(uvec2(layer, layer >> 14) & 0x3fffu) * step;
}

TEXTURE(2) uniform highp usampler2D span_map;
TEXTURE(3) uniform highp usampler2D layer_map;
TEXTURE(4) uniform sampler2D back_map;

layout(location = 0) out vec4 color;
#ifdef SOURCE_MAP
layout(location = 1) out uint source_entry;
#endif

// The uncovered rest of a pixel below which nothing more is looked for.
const float REST = 0.01;

uint layer_bits(int column, int row) {
    return texelFetch(layer_map, ivec2(column, row), 0).r;
}

Layer layer_at(int column, int row) {
    uint bits = layer_bits(column, row);
    if (is_full(bits)) {
        return Layer(full_front(bits), 1e9, false, vec4(1.0));
    }
    vec2 both = split_displacements(bits);
    uint code = bits >> 28;
#ifdef MULTISAMPLE
    vec4 mask = vec4((uvec4(code) >> uvec4(0, 1, 2, 3)) & 1u);
#else
    float share = texelFetch(back_map, ivec2(column, row), 0).a;
    vec4 mask = code == FROM_LEFT ? clamp(4.0 * share - STRIPES, 0.0, 1.0)
        : code == FROM_RIGHT ? clamp(4.0 * share - STRIPES.wzyx, 0.0, 1.0) : vec4(share);
#endif
    return Layer(both.x, both.y, true, mask);
}

// Share of each stripe right of a place in the pixel, 0 to 1.
vec4 right_of(float place) {
    return clamp(STRIPES + 1.0 - 4.0 * place, 0.0, 1.0);
}

float covered(vec4 mask, vec4 stripes) {
    return 0.25 * dot(mask, stripes);
}

// Colour of a layer's front and back, by their weights.
vec4 weighted(int column, int row, float of_front, float of_back) {
    vec4 mixture = texelFetch(color_map, in_image(ivec2(column, row)), 0);
    vec4 behind = texelFetch(back_map, ivec2(column, row), 0);
    float share = behind.a;
    behind.a = mixture.a;
    vec4 front = share < 1.0 ? clamp((mixture - (1.0 - share) * behind) / max(share, 0.01), 0.0, 1.0) : mixture;
    return of_front * front + of_back * behind;
}

// A place where the background of a hole begins.
struct Edge {
    // Column of the source's image; negative for none.
    int column;
    bool back;
    float reach;
    // Share of the pixel that it stands for.
    float weight;
};

// What is seen: column and displacement.
struct Seen {
    float rest;
    float column;
    float reach;
};

// A surface covers a share of what is uncovered. What covers the middle of the pixel's coverage is what is seen there.
float cover(inout Seen seen, float share, float column, float reach) {
    float taken = seen.rest * share;
    bool passes = seen.rest > 0.5 && seen.rest - taken <= 0.5;
    seen.column = passes ? column : seen.column;
    seen.reach = passes ? reach : seen.reach;
    seen.rest -= taken;
    return taken;
}

void main() {
    float last = float(source_size.x - 1);
    int row = int(clamp(gl_FragCoord.y - first_row, 0.0, float(source_size.y - 1)));
    // Displacements count from the far plane's: so does the target column. A hundredth is in `farthest` for rounding.
    float t = origins.x * gl_FragCoord.x + origins.y - farthest + 0.01;
    vec2 place = span_place.xy * gl_FragCoord.xy + span_place.zw;
    uint span = textureLod(span_map, place, 0.0).r;
    float x = clamp(floor(t - uintBitsToFloat(span) - 1.01), 0.0, last);
    float limit = min(x + span_steps(span) + 2.0, last);
    int sense = mirrored ? -1 : 1;
    int column = source_column(int(x));

    Seen seen = Seen(1.0, 0.0, 0.0);
    color = vec4(0.0);
    // Nearly every pixel shows a single surface, linked all the way from where the search begins.
    uint bits = layer_bits(column, row);
    float front = full_front(bits);
    float at = x + front - t;
    bool plain = is_full(bits) && at <= 0.0;
    while (plain && x < limit) {
        bits = layer_bits(column + sense, row);
        float following = full_front(bits);
        plain = is_full(bits) && abs(following - front) < LINK;
        float then = x + 1.0 + following - t;
        if (plain && then > 0.0) {
            float g = -at / (then - at);
            cover(seen, 1.0, x + g, mix(front, following, g));
            color = color_at(x + g, row);
            limit = x;
        } else if (plain) {
            x += 1.0;
            column += sense;
            front = following;
            at = then;
        }
    }
    Layer here = layer_at(column, row);
    Edge edge = Edge(-1, false, 1e9, 1.0);
    Edge second = edge;
    // Left of everything it is the border of the image.
    if (x == 0.0) {
        if (here.front > t) {
            edge = Edge(column, false, here.front, 1.0);
        }
        if (here.split && here.back < edge.reach && here.back > t) {
            edge = Edge(column, true, here.back, 1.0);
        }
    }
    // What the pixel's back is linked to at the left: a front, or a back.
    bool on_front = false;
    bool on_back = false;
    if (x > 0.0 && here.split && seen.rest > REST) {
        Layer before = layer_at(column - sense, row);
        on_front = abs(before.front - here.back) < LINK;
        on_back = before.split && abs(before.back - here.back) < LINK;
    }
    while (x < limit && seen.rest > REST) {
        Layer next = layer_at(column + sense, row);
        // Where the four surfaces land, relative to the pixel.
        float a = x + here.front - t;
        float b = x + 1.0 + next.front - t;
        float c = x + here.back - t;
        float d = x + 1.0 + next.back - t;
        bool front_front = abs(next.front - here.front) < LINK;
        bool front_back = next.split && abs(next.back - here.front) < LINK;
        bool back_front = here.split && abs(next.front - here.back) < LINK;
        bool back_back = here.split && next.split && abs(next.back - here.back) < LINK;
        // Of the fronts and the backs of this column and the next.
        vec2 fronts = vec2(0.0);
        vec2 backs = vec2(0.0);
        if (front_front && a <= 0.0 && b > 0.0) {
            float g = -a / (b - a);
            vec4 right = right_of(g);
            vec2 shares = vec2(covered(here.mask, right), covered(next.mask, 1.0 - right));
            float share = shares.x + shares.y;
            fronts = cover(seen, share, x + g, mix(here.front, next.front, g)) * shares / max(share, 1e-6);
        }
        // A front that begins or ends here, before a farther surface.
        if (!front_front && (next.front > here.front || next.split) && !back_front && b > 0.0 && b < 1.0) {
            float share = covered(next.mask, 1.0 - right_of(1.0 - b));
            fronts.y += cover(seen, share, x + 1.0, next.front);
        }
        if (!front_front && (next.front < here.front || here.split) && !front_back && a <= 0.0 && a > -1.0) {
            fronts.x += cover(seen, covered(here.mask, right_of(-a)), x, here.front);
        }
        // What goes on behind a front covers all.
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
        // A back that no neighbour continues: its samples only.
        if (ends && !on_front && !on_back && abs(c) < 1.0 && seen.rest > REST) {
            vec4 stripes = c <= 0.0 ? right_of(-c) : 1.0 - right_of(1.0 - c);
            backs.x += cover(seen, covered(1.0 - here.mask, stripes), x, here.back);
        }
        // Disocclusion edges. A sliver of background that no neighbour continues stands for its share of the pixel
        // only; the rest of the hole is the next farthest edge's.
        bool at_back = ends && next.front > here.back && c <= 0.0;
        bool at_front = !here.split && !front_front && !front_back && next.front > here.front && a <= 0.0;
        if ((at_back || at_front) && seen.rest > REST) {
            float reach = at_back ? here.back : here.front;
            float away = at_back ? -c : -a;
            float weight = at_back && !on_front ? 1.0 - covered(here.mask, vec4(1.0)) : 1.0;
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
            } else if (reach < second.reach) {
                second = found;
            }
        }
        if (max(fronts.x, backs.x) > 0.0) {
            color += weighted(column, row, fronts.x, backs.x);
        }
        if (max(fronts.y, backs.y) > 0.0) {
            color += weighted(column + sense, row, fronts.y, backs.y);
        }
        on_front = front_back;
        on_back = back_back;
        here = next;
        column += sense;
        x += 1.0;
    }
    bool hole = seen.rest > 0.5;
    if (seen.rest > REST) {
        if (edge.column < 0) {
            // Right of everything.
            edge = Edge(column, here.split, here.split ? here.back : here.front, 1.0);
        }
        float edge_x = float(source_column(edge.column));
        float away = abs(t - edge_x - edge.reach);
        float spread = 0.5 * clamp(away, 1.0, 12.0);
        vec4 sum = vec4(0.0);
        float weights = 0.0;
        for (int i = -2; i <= 2; ++i) {
            int at = clamp(row + int(round(float(i) * spread)), 0, source_size.y - 1);
            Layer layer = layer_at(edge.column, at);
            bool front = i == 0 ? !edge.back : layer.front <= edge.reach + 1.0;
            bool behind = i == 0 ? edge.back : !front && layer.split && layer.back <= edge.reach + 1.0;
            float weight = i == 0 ? 2.0 : front ? 1.0 : behind ? 1.0 - covered(layer.mask, vec4(1.0)) : 0.0;
            sum += weighted(edge.column, at, front ? weight : 0.0, front ? 0.0 : weight);
            weights += weight;
        }
        vec4 fill = sum / weights;
        if (second.column >= 0 && edge.weight < 1.0) {
            vec2 one = second.back ? vec2(0.0, 1.0) : vec2(1.0, 0.0);
            fill = mix(weighted(second.column, row, one.x, one.y), fill, edge.weight);
        }
        hole = hole && away >= 0.5;
        color += cover(seen, 1.0, edge_x, edge.reach) * fill;
    }
#ifdef WRITE_DEPTH
    gl_FragDepth = clamp((far_displacement + seen.reach - law.x) / law.y, 0.0, 1.0);
#endif
#ifdef SOURCE_MAP
    source_entry = uint(seen.column * FIXED + 0.5) | (hole ? HOLE : 0u);
#endif
}
