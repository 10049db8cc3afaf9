// Scene triangles; positions go on relative to the eye.
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec2 uv;

uniform vec3 eye;
uniform mat4 eye_to_clip;  // from the position relative to the eye

out vec3 v_position;
out vec3 v_normal;
out vec2 v_uv;

void main() {
    v_position = position - eye;
    v_normal = normal;
    v_uv = uv;
    gl_Position = eye_to_clip * vec4(v_position, 1.0);
}
