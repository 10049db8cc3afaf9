// The part of an eye's image that the lenses hide, given in tangents.

uniform vec4 frustum;  // left, bottom, width, height of the image in tangents

layout(location = 0) in vec2 position;

void main() {
    gl_Position = vec4(2.0 * (position - frustum.xy) / frustum.zw - 1.0, 0.0, 1.0);
}
