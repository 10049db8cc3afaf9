// A triangle that covers the viewport, with depth that changes along x. What lies beyond the far plane is clipped.
uniform vec2 curtain;  // z of clip space at the left border, and its change up to the right one

void main() {
    vec2 corner = vec2(float((gl_VertexID << 1) & 2), float(gl_VertexID & 2));
    gl_Position = vec4(corner * 2.0 - 1.0, curtain.x + curtain.y * corner.x, 1.0);
}
