## Places the rendered eye's cameras when a frame is drawn. OpenXR locates the eyes anew after all scripts have run, so
## scripts see the poses of the last frame. This effect belongs to the camera of a tiny viewport that is drawn before
## the eye's.
@tool
class_name YoroLatch
extends CompositorEffect

var interface: XRInterface
var cameras: Array[RID] = []
var rendered := 1


func _init() -> void:
	effect_callback_type = EFFECT_CALLBACK_TYPE_PRE_OPAQUE


func _render_callback(_type: int, _data: RenderData) -> void:
	if interface != null and interface.is_initialized():
		for camera in cameras:
			RenderingServer.camera_set_transform(camera, interface.get_transform_for_view(rendered, XRServer.world_origin))
