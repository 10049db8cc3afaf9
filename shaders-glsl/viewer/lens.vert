// A point of the screen and the direction in which the lens shows it, as the head was when the image was rendered.

uniform vec4 frustum;  // left, bottom, width, height of the eye's image in tangents
uniform mat4 turn;     // head as it is now -> head as it was

layout(location = 0) in vec2 position;  // clip coordinates of the whole screen
layout(location = 1) in vec2 uv;        // in the eye's image

out vec2 lens_uv;
out vec3 direction;

void main() {
    lens_uv = uv;
    direction = mat3(turn) * vec3(frustum.xy + uv * frustum.zw, -1.0);
    gl_Position = vec4(position, 0.0, 1.0);
}
