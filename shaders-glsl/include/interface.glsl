// How the synthesis passes declare their inputs: as plain uniforms for OpenGL, or as blocks if UNIFORM_BLOCK is
// defined. It is the qualifier of a std140 block, such as Vulkan's push constants.

#ifdef UNIFORM_BLOCK
#define UNIFORM
#else
#define UNIFORM uniform
#endif

// Textures and blocks have bindings in the shader for Vulkan; in OpenGL they are bound by name.
#ifdef VULKAN
#define TEXTURE(n) layout(set = 0, binding = n)
#define BLOCK(n) layout(set = 0, binding = n, std140)
#define VARYING(n) layout(location = n)
// True if the source is a part of its image, or if the maps are larger than needed. Nothing outside of that part is
// read.
layout(constant_id = 0) const bool PART = false;
#else
#define TEXTURE(n)
#define BLOCK(n) layout(std140)
#define VARYING(n)
#ifdef SOURCE_PARTS
const bool PART = true;
#else
const bool PART = false;
#endif
#endif
