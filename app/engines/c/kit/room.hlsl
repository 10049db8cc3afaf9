// The scene of the samples on Direct3D, the same as in example.c: a tiled room with balls, one ray per pixel.

cbuffer Eye : register(b0) {
    // Tangents: left, right, up, down.
    float4 frustum;
    // Its place, and the distance of the near plane.
    float4 eye;
};

struct Corner {
    float4 position : SV_Position;
    float2 ahead : TEXCOORD0;
};

Corner room_vertex(uint id : SV_VertexID) {
    float2 corner = float2((id << 1) & 2, id & 2);
    Corner made;
    made.position = float4(corner * 2.0 - 1.0, 0.0, 1.0);
    made.ahead = frustum.xw + corner * (frustum.yz - frustum.xw);
    return made;
}

struct Seen {
    float4 color : SV_Target0;
    float depth : SV_Depth;
};

Seen room_pixel(Corner corner) {
    float3 ray = normalize(float3(corner.ahead, -1.0));
    float3 walls = (sign(ray) * float3(3.0, 3.0, 5.0) - eye.xyz) / ray;
    float t = min(walls.x, min(walls.y, walls.z));
    float3 normal = -sign(ray) * step(walls, float3(t, t, t));
    int3 tile = int3(floor((eye.xyz + t * ray + 0.01 * normal) * 2.0));
    float3 albedo = ((tile.x + tile.y + tile.z) & 1) == 0 ? float3(0.75, 0.72, 0.66) : float3(0.32, 0.38, 0.45);
    for (int i = 0; i < 7; ++i) {
        float n = float(i);
        float3 center = float3(1.5 * sin(0.9 * n), 1.6 + 0.9 * cos(1.53 * n), 0.9 - 0.8 * n);
        float3 to_eye = eye.xyz - center;
        float radius = 0.2 + 0.05 * n;
        float b = dot(to_eye, ray);
        float d = b * b - dot(to_eye, to_eye) + radius * radius;
        float hit = -b - sqrt(max(d, 0.0));
        if (d > 0.0 && hit > 0.0 && hit < t) {
            t = hit;
            normal = (eye.xyz + t * ray - center) / radius;
            albedo = 0.5 + 0.45 * cos(n + float3(0.0, 2.1, 4.2));
            albedo *= frac(4.0 * atan2(normal.z, normal.x) / 3.1416) < 0.5 ? 1.0 : 0.6;
        }
    }
    Seen seen;
    seen.color = float4(albedo * (0.45 + 0.55 * max(dot(normal, float3(0.36, 0.8, 0.48)), 0.0)), 1.0);
    // Reversed, without a far plane.
    seen.depth = eye.w / (t * -ray.z);
    return seen;
}
