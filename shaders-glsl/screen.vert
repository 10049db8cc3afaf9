#version 310 es
// One triangle that covers the viewport, without vertex buffers.

#ifdef MULTIVIEW
layout(num_views = 2) in;
flat out int v_view;
#endif

void main() {
#ifdef VULKAN
    int id = gl_VertexIndex;
#else
    int id = gl_VertexID;
#endif
    vec2 corner = vec2(float((id << 1) & 2), float(id & 2));
    gl_Position = vec4(corner * 2.0 - 1.0, 0.0, 1.0);
#ifdef MULTIVIEW
    v_view = int(gl_ViewID_OVR);
#endif
}
