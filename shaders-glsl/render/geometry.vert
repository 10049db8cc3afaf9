// Scene triangles, with positions relative to the eye. With STEREO each triangle is drawn for both eyes: by two views,
// or by two instances side by side.
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec2 uv;

#ifdef STEREO
uniform vec3 eyes[2];
uniform mat4 eyes_to_clip[2];
#ifdef MULTIVIEW
layout(num_views = 2) in;
#define VIEW int(gl_ViewID_OVR)
#else
#define VIEW gl_InstanceID
#endif
// A choice between two instead of an index: with an index, Mali and Adreno load the uniforms from memory.
#define OF_VIEW(uniforms) (VIEW == 0 ? uniforms[0] : uniforms[1])
#define EYE OF_VIEW(eyes)
#define EYE_TO_CLIP OF_VIEW(eyes_to_clip)
#else
uniform vec3 eye;
uniform mat4 eye_to_clip;  // from the position relative to the eye
#define EYE eye
#define EYE_TO_CLIP eye_to_clip
#endif

#ifdef CLIP_DISTANCE
uniform vec4 seams[2];  // the plane of each eye's clip volume that lies at the seam
out float gl_ClipDistance[1];
#endif
#ifdef SEAM_DISCARD
flat out int v_view;
#endif
#ifdef STEREO
out vec3 v_from_first;  // relative to the first eye
#endif

out vec3 v_position;
out vec3 v_normal;
out vec2 v_uv;

void main() {
    v_position = position - EYE;
    v_normal = normal;
    v_uv = uv;
#ifdef STEREO
    v_from_first = position - eyes[0];
#endif
    gl_Position = EYE_TO_CLIP * vec4(v_position, 1.0);
#ifdef CLIP_DISTANCE
    gl_ClipDistance[0] = dot(OF_VIEW(seams), vec4(v_position, 1.0));
#endif
#ifdef SEAM_DISCARD
    v_view = VIEW;
#endif
}
