// Two functions on the bits of integers, written out where GLSL lacks them.

#include "include/version.glsl"

uint reversed_bits(uint bits) {
#ifdef WITHOUT_ES_310
    bits = bits >> 16 | bits << 16;
    bits = (bits & 0xff00ff00u) >> 8 | (bits & 0x00ff00ffu) << 8;
    bits = (bits & 0xf0f0f0f0u) >> 4 | (bits & 0x0f0f0f0fu) << 4;
    bits = (bits & 0xccccccccu) >> 2 | (bits & 0x33333333u) << 2;
    return (bits & 0xaaaaaaaau) >> 1 | (bits & 0x55555555u) << 1;
#else
    return bitfieldReverse(bits);
#endif
}

// The index of the lowest bit that is set. At least one must be. It is a float, since naga takes the result of findLSB for
// unsigned, and refuses to return it.
float lowest_bit(uint bits) {
#ifdef WITHOUT_ES_310
    // A power of two, whose logarithm is the float's exponent.
    float power = float(bits & (~bits + 1u));
    return float(floatBitsToUint(power) >> 23) - 127.0;
#else
    return float(findLSB(bits));
#endif
}
