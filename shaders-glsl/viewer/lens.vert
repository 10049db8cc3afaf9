// A point of the screen and the directions in which the lens shows it, as the head was when the image was rendered.

uniform vec4 frustum;  // left, bottom, width, height of the eye's image in tangents
uniform mat4 turn;     // head as it is now -> head as it was
uniform vec2 dispersion;  // of red and blue, relative to green

layout(location = 0) in vec2 position;  // clip coordinates of the whole screen
layout(location = 1) in vec2 uv;        // in the eye's image, for green

out vec2 lens_uv;
out vec3 green_direction;
#ifdef CHROMATIC
out vec3 red_direction;
out vec3 blue_direction;
#endif

vec3 direction(vec2 tangent) {
    return mat3(turn) * vec3(tangent, -1.0);
}

void main() {
    vec2 tangent = frustum.xy + uv * frustum.zw;
    lens_uv = uv;
    green_direction = direction(tangent);
#ifdef CHROMATIC
    red_direction = direction(tangent * dispersion.x);
    blue_direction = direction(tangent * dispersion.y);
#endif
    gl_Position = vec4(position, 0.0, 1.0);
}
