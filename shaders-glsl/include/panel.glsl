// A panel of text: white letters on translucent black.

uniform sampler2D panel;  // coverage by letters
uniform float used;       // part of the texture, from the top, that the panel fills

// Colour at a place in the panel, from 0 to 1.
vec4 panel_color(vec2 place) {
    float letters = textureLod(panel, vec2(place.x, 1.0 - used + used * place.y), 0.0).r;
    return vec4(vec3(letters), mix(0.55, 1.0, letters));
}
