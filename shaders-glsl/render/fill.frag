// The same value in all pixels that the state lets through.
uniform vec4 fill;

layout(location = 0) out vec4 out_color;

void main() {
    out_color = fill;
}
