// How the synthesis passes declare their inputs: plain uniforms for OpenGL; blocks if UNIFORM_BLOCK is the qualifier of a std140
// block, such as Vulkan's push constants.

#ifdef UNIFORM_BLOCK
#define UNIFORM
#else
#define UNIFORM uniform
#endif

// Textures and blocks have a binding in the text for Vulkan, and are bound by name in OpenGL.
#ifdef VULKAN
#define TEXTURE(n) layout(set = 0, binding = n)
#define BLOCK(n) layout(set = 0, binding = n, std140)
#define VARYING(n) layout(location = n)
// The source is a part of its image, or the maps are larger than needed: nothing beside them is read.
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
