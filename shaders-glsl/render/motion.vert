// Moving triangles, each vertex with its place in the previous frame.
layout(location = 0) in vec3 position;
layout(location = 2) in vec2 uv;
layout(location = 3) in vec3 previous_position;

uniform vec3 eye;
uniform mat4 eye_to_clip;  // of the image, from the position relative to the eye
// For each frame, the clip space in which vectors are given.
uniform mat4 to_vectors;
uniform vec3 previous_eye;
uniform mat4 previous_to_vectors;

out vec3 v_position;
out vec3 v_normal;
out vec2 v_uv;
out vec4 v_clip;
out vec4 v_previous;

void main() {
    v_position = position - eye;
    v_normal = vec3(0.0);
    v_uv = uv;
    v_clip = to_vectors * vec4(v_position, 1.0);
    v_previous = previous_to_vectors * vec4(previous_position - previous_eye, 1.0);
    gl_Position = eye_to_clip * vec4(v_position, 1.0);
}
