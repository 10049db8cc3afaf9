#version 450
// The scene of vulkan.c, the same as in gles.c: a tiled room with balls, one ray per pixel.
layout(push_constant) uniform Eye {
    mat4 projection;
    mat4 view;
};
layout(location = 0) in vec2 ndc;
layout(location = 0) out vec4 color;

void main() {
    vec3 eye = -transpose(mat3(view)) * view[3].xyz;
    vec2 ahead = (ndc + vec2(projection[2][0], projection[2][1])) / vec2(projection[0][0], projection[1][1]);
    vec3 ray = normalize(transpose(mat3(view)) * vec3(ahead, -1.0));
    vec3 walls = (sign(ray) * vec3(3.0, 3.0, 5.0) - eye) / ray;
    float t = min(walls.x, min(walls.y, walls.z));
    vec3 normal = -sign(ray) * step(walls, vec3(t));
    ivec3 tile = ivec3(floor((eye + t * ray + 0.01 * normal) * 2.0));
    vec3 albedo = ((tile.x + tile.y + tile.z) & 1) == 0 ? vec3(0.75, 0.72, 0.66) : vec3(0.32, 0.38, 0.45);
    for (int i = 0; i < 7; ++i) {
        float n = float(i);
        vec3 center = vec3(1.5 * sin(0.9 * n), 1.6 + 0.9 * cos(1.53 * n), 0.9 - 0.8 * n);
        vec3 to_eye = eye - center;
        float radius = 0.2 + 0.05 * n, b = dot(to_eye, ray);
        float d = b * b - dot(to_eye, to_eye) + radius * radius;
        float hit = -b - sqrt(max(d, 0.0));
        if (d > 0.0 && hit > 0.0 && hit < t) {
            t = hit;
            normal = (eye + t * ray - center) / radius;
            albedo = 0.5 + 0.45 * cos(n + vec3(0.0, 2.1, 4.2));
            albedo *= fract(4.0 * atan(normal.z, normal.x) / 3.1416) < 0.5 ? 1.0 : 0.6;
        }
    }
    color = vec4(albedo * (0.45 + 0.55 * max(dot(normal, vec3(0.36, 0.8, 0.48)), 0.0)), 1.0);
    vec4 clip = projection * (view * vec4(eye + t * ray, 1.0));
    gl_FragDepth = clip.z / clip.w;
}
