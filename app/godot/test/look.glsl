#[vertex]
#version 450
void main() {
    vec2 corner = vec2(float((gl_VertexIndex << 1) & 2), float(gl_VertexIndex & 2));
    gl_Position = vec4(corner * 2.0 - 1.0, 0.0, 1.0);
}

#[fragment]
#version 450
// Copies a picture; the Mobile renderer halves what it stores.
layout(set = 0, binding = 0) uniform sampler2D color_map;
layout(push_constant, std430) uniform Factor {
    float factor;
};
layout(location = 0) out vec4 color;

void main() {
    color = factor * texelFetch(color_map, ivec2(gl_FragCoord.xy), 0);
}
