// lerp is not exact at 1.
float mix(float a, float b, float t) { return a * (1.0 - t) + b * t; }
float2 mix(float2 a, float2 b, float t) { return a * (1.0 - t) + b * t; }
float4 mix(float4 a, float4 b, float t) { return a * (1.0 - t) + b * t; }
float4 mix(float4 a, float4 b, bool4 t) {
    return float4(t.x ? b.x : a.x, t.y ? b.y : a.y, t.z ? b.z : a.z, t.w ? b.w : a.w);
}

float2 mod(float2 a, float2 b) { return a - b * floor(a / b); }

// reversebits, which vkd3d does not know.
uint reversed(uint bits) {
    bits = bits >> 16 | bits << 16;
    bits = (bits & 0xff00ff00u) >> 8 | (bits & 0x00ff00ffu) << 8;
    bits = (bits & 0xf0f0f0f0u) >> 4 | (bits & 0x0f0f0f0fu) << 4;
    bits = (bits & 0xccccccccu) >> 2 | (bits & 0x33333333u) << 2;
    return (bits & 0xaaaaaaaau) >> 1 | (bits & 0x55555555u) << 1;
}

int samples_of(Texture2DMS<float4> map) {
    uint2 size;
    uint samples;
    map.GetDimensions(size.x, size.y, samples);
    return int(samples);
}

// Integers cannot be sampled before Shader Model 6.7.
uint4 load_at(Texture2D<uint4> map, float2 at) {
    uint2 size;
    map.GetDimensions(size.x, size.y);
    return map.Load(int3((int2)(at * (float2)(size)), 0));
}
