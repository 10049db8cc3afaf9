// Depth that is carried through the average of a pixel's samples. With CARRIED a second colour holds it in each sample;
// render/keep_sample.frag then clears all samples but one in each of its channels, so that the average is that sample's
// depth. Depth must be reversed: what is not drawn is 0.
#ifdef CARRIED
layout(location = 1) out vec4 out_depth;
#define CARRY_DEPTH(depth) out_depth = vec4(float(CARRIED) * clamp(depth, 0.0, 1.0));
// Leaves what blended surfaces cover as it is.
#define CARRY_NOTHING out_depth = vec4(0.0);
#else
#define CARRY_DEPTH(depth)
#define CARRY_NOTHING
#endif
