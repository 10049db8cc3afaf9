// A material at a fragment. The maps that a material lacks are not sampled: its variant says which it has.
in vec3 v_position;
in vec3 v_normal;
in vec2 v_uv;

uniform vec4 diffuse;   // linear, opacity
uniform vec3 emissive;  // linear
uniform vec3 gloss;     // roughness, reflectance, alpha cut-off
#ifdef DIFFUSE_MAP
uniform sampler2D diffuse_map;
#endif
#ifdef SPECULAR_MAP
uniform sampler2D specular_map;
#endif
#ifdef EMISSIVE_MAP
uniform sampler2D emissive_map;
#endif
#ifdef NORMAL_MAP
uniform sampler2D normal_map;
#endif

vec4 material_diffuse() {
#ifdef DIFFUSE_MAP
    return diffuse * texture(diffuse_map, v_uv);
#else
    return diffuse;
#endif
}

#ifdef CUTOUT
// Minification averages alpha, which makes leaves vanish with distance: what is left is scaled up.
bool cut_out(float alpha) {
#ifdef DIFFUSE_MAP
    vec2 texels = v_uv * vec2(textureSize(diffuse_map, 0));
    vec2 dx = dFdx(texels), dy = dFdy(texels);
    alpha *= 1.0 + 0.125 * max(0.0, log2(max(max(dot(dx, dx), dot(dy, dy)), 1.0)));
#endif
    return alpha < gloss.z;
}
#endif

vec3 material_emissive() {
#ifdef EMISSIVE_MAP
    return emissive * texture(emissive_map, v_uv).rgb;
#else
    return emissive;
#endif
}

float material_specular() {
#ifdef SPECULAR_MAP
    return gloss.y * dot(texture(specular_map, v_uv).rgb, vec3(0.3, 0.6, 0.1));
#else
    return gloss.y;
#endif
}

// The normal on the eye's side of the triangle, whichever way the file's normals point.
vec3 material_normal() {
    vec3 dx = dFdx(v_position), dy = dFdy(v_position);
    vec3 face = cross(dx, dy);
#ifdef FACE_NORMALS
    vec3 n = normalize(face);
#else
    vec3 n = normalize(v_normal);
    n = dot(n, face) < 0.0 ? -n : n;
#endif
#ifdef NORMAL_MAP
    // The tangent frame comes from how position and texture coordinates change over the screen.
    vec2 ux = dFdx(v_uv), uy = dFdy(v_uv);
    vec3 px = cross(dy, n), py = cross(n, dx);
    vec3 tangent = px * ux.x + py * uy.x;
    vec3 bitangent = px * ux.y + py * uy.y;
    float scale = inversesqrt(max(max(dot(tangent, tangent), dot(bitangent, bitangent)), 1e-20));
    vec3 m = texture(normal_map, v_uv).xyz * 2.0 - 1.0;
    n = normalize(scale * (m.x * tangent + m.y * bitangent) + m.z * n);
#endif
    return n;
}
