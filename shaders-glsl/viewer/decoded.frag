// One part of a decoded video picture as colour, or its luma as depth, with rows from the top. The picture is BT.601 in
// full range, 4:2:0; with RGB it has been converted to red, green and blue.

uniform sampler2D picture;  // luma, or the converted picture
#ifndef RGB
uniform sampler2D blue;     // colour differences, of half the width and height
uniform sampler2D red;
#endif
uniform int first_column;   // of the part, in pixels
uniform ivec2 size;         // of the part that is shown, in pixels
uniform int framed;         // 1 to make the outermost pixels black
uniform int depth;          // 1 for luma alone

layout(location = 0) out vec4 out_color;

void main() {
    ivec2 here = ivec2(gl_FragCoord.xy);
    ivec2 at = ivec2(here.x + first_column, size.y - 1 - here.y);
#ifdef RGB
    vec3 color = texelFetch(picture, at, 0).rgb;
    float y = dot(color, vec3(0.299, 0.587, 0.114));
#else
    float y = texelFetch(picture, at, 0).r;
    vec2 difference = vec2(texelFetch(blue, at / 2, 0).r, texelFetch(red, at / 2, 0).r) - 128.0 / 255.0;
    vec3 color = y + vec3(1.402 * difference.y, -0.344136 * difference.x - 0.714136 * difference.y, 1.772 * difference.x);
#endif
    bool border = any(equal(here, ivec2(0))) || any(greaterThanEqual(here, size - 1));
    out_color = vec4(depth == 1 ? vec3(y) : framed == 1 && border ? vec3(0.0) : color, 1.0);
}
