## An [XRCamera3D] that renders one eye, and synthesizes the other from its colour and depth.
##
## Use it instead of the [XRCamera3D] below the [XROrigin3D]. The whole scene is drawn once, or with [member foveation]
## once for each level, for [member dominant_eye], a little wider than it is shown. Godot draws only what is on [member stereo_layers] for both eyes, tested against the
## depth of each eye: transparent objects, hands, interfaces.[br][br]
## It needs one of the Vulkan renderers, Mobile or Forward+. With other renderers, and if an eye cannot be synthesized,
## it is an [XRCamera3D] like any other: [method trouble] says why.
@tool
@icon("icon.svg")
class_name YoroCamera3D
extends XRCamera3D

enum Mode {
	ONE_VIEW, ## One eye is rendered, the other one synthesized.
	BOTH_VIEWS, ## Godot renders both eyes, as without this add-on.
	SAME_IMAGE, ## The rendered eye is shown to both eyes: for comparison.
	AUTO, ## One of the first two, whichever is cheaper on this device: it is measured, and [member choice] says why.
	PROJECT, ## As the project settings say, in [i]XR > Yoro[/i].
}
enum Eye {
	LEFT, ## The left eye.
	RIGHT, ## The right eye.
}
enum DebugView {
	NONE, ## The eyes as they are.
	HOLES, ## What the rendered eye does not see, and is invented or rendered, in magenta.
	DISPARITY, ## How far surfaces move between the eyes: white is a tenth of the image's width.
	SYNTHESIZED, ## The synthesized eye's image to both eyes.
}
enum Foveation {
	PROJECT, ## As the project settings say, in [i]XR > Yoro[/i].
	OFF, ## All pixels everywhere.
	LOW, ## All pixels within 30° of the gaze, half of them along each axis beyond.
	MEDIUM, ## All pixels within 20° of the gaze, half of them along each axis beyond.
	HIGH, ## All pixels within 20° of the gaze, a third of them along each axis beyond.
}
enum Holes {
	PROJECT, ## As the project settings say, in [i]XR > Yoro[/i].
	FILLED, ## With what lies behind the nearer surface.
	RENDERED, ## Godot draws the scene there once more, for the other eye.
}
## What Godot draws with this camera.
enum _Drawn {
	ALL, ## As without this add-on.
	ALL_WATCHED, ## The same, and nearness is measured.
	STEREO_LAYERS, ## What is on the stereo layers, over the eyes that are put there.
}

## The settings of the environment that differ where both eyes are shown: sky and screen-space light come with the
## rendered eye.
const SHOWN_OVERRIDES := {
	background_mode = Environment.BG_COLOR, ssao_enabled = false, ssil_enabled = false, ssr_enabled = false, sdfgi_enabled = false,
}
## The project setting of the mode where a camera has none of its own: 0 one view, 1 both views, 3 auto.
const MODE_SETTING := "xr/yoro/mode"
## The project setting of the foveation where a camera has none of its own: 0 off, 1 low, 2 medium, 3 high.
const FOVEATION_SETTING := "xr/yoro/foveation"
## The same of the holes: 0 filled, 1 rendered.
const HOLES_SETTING := "xr/yoro/holes"
## Godot renders both eyes once this share of the view is near, and until less than [code]_SWITCH_OFF[/code] is: the
## same as yoro's NearFieldPolicy.
const _SWITCH_ON := 0.5
const _SWITCH_OFF := 0.35

## How the eyes are made. Can be changed at any time.
@export var mode := Mode.PROJECT
## The eye that is rendered; the other one is synthesized. People look more closely with one eye, mostly the right one.
@export var dominant_eye := Eye.RIGHT
## From this distance on, in metres, nothing is missing at the outer border of the synthesized eye. The nearer it is,
## the wider is the rendered image: by 4 to 14 % at 1 m. 0 means no band.
@export_range(0.0, 10.0, 0.05, "or_greater", "suffix:m") var guard_band := 1.0
## How many pixels are rendered where the eyes do not look. A wide view of fewer pixels and an inset of all of them
## are rendered and synthesized apart, then composed. What is on [member stereo_layers] has all pixels.
@export var foveation := Foveation.PROJECT
## What the synthesized eye shows where the rendered eye sees nothing. Rendered holes are what Godot itself draws; the
## scene's vertices, draw calls and shadow maps double. With [member foveation], holes of the wide view are filled.
@export var holes := Holes.PROJECT
## The distance between the eyes, as a share of the headset's: 0 shows the same image to both. In XR, things on
## [member stereo_layers] keep the headset's distance.
@export_range(0.0, 2.0, 0.01) var ipd_scale := 1.0
## Godot draws things on these layers for both eyes. Everything else is drawn once and moved; transparent things move
## with what lies behind them. Lights must be on these layers, too, or things there are dark: the editor's yoro menu
## marks both. Things on these layers cast no shadow on others, and receive none from them. If no layer is set, shadow
## maps are drawn only once, which is cheaper.
@export_flags_3d_render var stereo_layers := 0:
	set(value):
		stereo_layers = value
		update_configuration_warnings()
## Once half of the view is nearer than this, in metres, Godot renders both eyes, until less than 35 % of it is: at such
## distances, much of the other eye would be invented. 0 means never. Applies only with a headset.
@export_range(0.0, 2.0, 0.05, "or_greater", "suffix:m") var near_limit := 0.4
## Shows how the synthesis works.
@export var debug_view := DebugView.NONE
## Shows both eyes side by side when there is no headset, while this camera is the current one and its projection is a
## perspective.
@export var preview_without_headset := false

## Where the eyes look, as a direction in the world, such as that of an eye tracker; it may change in each frame. Zero,
## as while a tracker has lost the eyes, keeps the last direction from the head; before the first one, it is straight ahead.
var gaze := Vector3.ZERO
## What [constant Mode.AUTO] has measured and chosen. It measures again when the frames' cost or size changes, and after
## [method YoroChoice.renew].
var choice := YoroChoice.new()

var _source: YoroSource
var _put: YoroPut
var _nearness: YoroNearness
var _latch: YoroLatch
var _latch_viewport: SubViewport
var _preview: CanvasLayer
var _environment := YoroEnvironment.new(SHOWN_OVERRIDES)
var _compositor := Compositor.new()
var _world_effects: Array[CompositorEffect] = []
var _trouble := ""
## What was warned of last: what is measured has this trouble in some turns only.
var _warned := ""
var _drawn := _Drawn.ALL
var _shown_layers := 0
## The last gaze in the axes of the rendered eye. Images have other sizes without one.
var _last_gaze := Vector3.ZERO
## What was measured: another one is measured anew.
var _shape := []


## Returns one sentence that says why no eye is synthesized although [method way] is not [code]BOTH_VIEWS[/code], or why
## there is no preview; an empty text if neither is so.
func trouble() -> String:
	return _trouble


## Returns how the next frame is made: one of the first three modes.
func way() -> Mode:
	return (choice.way() if _asked() == Mode.AUTO else _asked()) as Mode


## Returns the environment that both eyes are drawn with.
func shown_environment() -> Environment:
	return environment if environment != null or get_world_3d() == null else get_world_3d().environment


## Returns the scene's effects that are drawn after transparent objects, and thus on both eyes, or those drawn before.
func effects(after_transparent: bool) -> Array[CompositorEffect]:
	var all := _world_effects if compositor == null else compositor.compositor_effects
	var of_kind: Array[CompositorEffect] = []
	for effect in all:
		if effect != null and (effect.effect_callback_type == CompositorEffect.EFFECT_CALLBACK_TYPE_POST_TRANSPARENT) == after_transparent:
			of_kind.append(effect)
	return of_kind


## Returns the rendered eye, with all that is made of it, or null before the first frame with a headset.
func source() -> YoroSource:
	if _preview != null:
		return preview().source
	return _source


## Returns the strength of the foveation in use: 0 off, 1 low, 2 medium, 3 high.
func foveation_strength() -> int:
	return ProjectSettings.get_setting(FOVEATION_SETTING, 0) if foveation == Foveation.PROJECT else foveation - 1


## Returns whether holes of the synthesized eye are rendered.
func renders_holes() -> bool:
	if way() == Mode.SAME_IMAGE or debug_view == DebugView.HOLES:
		return false
	return ProjectSettings.get_setting(HOLES_SETTING, 0) == 1 if holes == Holes.PROJECT else holes == Holes.RENDERED


## Returns [member gaze] in the axes of the rendered eye, which is at [param at].
func gaze_from(at: Transform3D) -> Vector3:
	if foveation_strength() == 0:
		_last_gaze = Vector3.ZERO
	elif gaze.is_finite() and gaze != Vector3.ZERO:
		_last_gaze = at.basis.inverse() * gaze
	return _last_gaze


## Returns the preview, or null if there is none.
func preview() -> YoroPreview:
	return _preview.get_child(0) if _preview != null else null


## Calls the camera's [code]_follow[/code] in each frame, after the scripts that move things, and also while the scene
## is paused, since it is still shown then.
class _Follower:
	extends Node
	var camera: YoroCamera3D

	func _init(of: YoroCamera3D) -> void:
		camera = of
		process_mode = PROCESS_MODE_ALWAYS
		process_priority = 1000

	func _process(_delta: float) -> void:
		camera._follow()


# Not _ready and _exit_tree, of which Godot calls only those of the last script, which may extend this one.
func _notification(what: int) -> void:
	if Engine.is_editor_hint():
		return
	match what:
		NOTIFICATION_READY:
			_begin()
		NOTIFICATION_EXIT_TREE:
			_show_preview(false)
			_draw_all()


func _begin() -> void:
	for node: WorldEnvironment in get_tree().root.find_children("*", "WorldEnvironment", true, false):
		if node.compositor != null:
			_world_effects = node.compositor.compositor_effects
	if RenderingServer.get_rendering_device() == null:
		_refuse("the Compatibility renderer has no effects: choose Mobile or Forward+")
		return
	add_child(_Follower.new(self), false, INTERNAL_MODE_BACK)


func _follow() -> void:
	var viewport := get_viewport()
	var interface := XRServer.primary_interface
	var in_xr := viewport.use_xr and interface != null and interface.is_initialized()
	var is_current := viewport.get_camera_3d() == self
	var to_preview := preview_without_headset and is_current and not in_xr
	var fault := YoroPreview.fault(self) if to_preview else ""
	_show_preview(to_preview and fault == "")
	if not is_current:
		# This is not a fault, so there is no warning.
		_trouble = "another camera is current"
		_draw_all()
		return
	if fault != "":
		_refuse(fault, "there is no preview")
		return
	var made := way()
	if not in_xr or made == Mode.BOTH_VIEWS:
		_refuse(preview().trouble if to_preview else "")
		if in_xr or to_preview:
			_count(made, interface.get_render_target_size() if in_xr else Vector2(preview().eyes[0].size))
		return
	if interface is OpenXRInterface and not _is_shown(interface):
		# The session is paused, so nothing is visible. Godot does not draw this camera's viewport either.
		_rest()
		return
	if _source == null:
		_make()
	_draw(interface, viewport)
	_count(made, interface.get_render_target_size())


## Returns [member mode], or that of the project.
func _asked() -> Mode:
	return ProjectSettings.get_setting(MODE_SETTING, 0) if mode == Mode.PROJECT else mode


## Counts a frame of [param pixels] that is made in the way [param made], and the last time of the GPU that is known.
func _count(made: Mode, pixels: Vector2) -> void:
	if _asked() != Mode.AUTO:
		return
	var shape := [pixels, foveation_strength(), renders_holes(), get_viewport().msaa_3d, get_viewport().scaling_3d_scale]
	if shape != _shape:
		_shape = shape
		choice.renew()
	var drawn: Array[Viewport] = [get_viewport()]
	if _preview != null:
		drawn.assign(preview().eyes)
	if made == Mode.ONE_VIEW and _trouble == "":
		drawn.append_array(source().drawn())
		if source().opens:
			drawn.append(source().beyond)
	var cost := 0.0
	for viewport in drawn:
		var id := viewport.get_viewport_rid()
		RenderingServer.viewport_set_measure_render_time(id, true)
		cost += RenderingServer.viewport_get_measured_render_time_gpu(id)
	choice.end_frame(Time.get_ticks_usec() / 1000.0, made if _trouble == "" else -1, cost)


func _is_shown(interface: OpenXRInterface) -> bool:
	if not interface.has_method(&"get_session_state"):
		return true
	return interface.get_session_state() >= OpenXRInterface.SESSION_STATE_VISIBLE


## Creates everything that is drawn before the headset's viewport.
func _make() -> void:
	_source = YoroSource.new()
	_put = YoroPut.new(_source)
	_nearness = YoroNearness.new(_source.wide.synthesis)
	_latch = YoroLatch.new()
	_latch.cameras = [_source.wide.camera.get_camera_rid(), _source.inset.camera.get_camera_rid()]
	_latch.other = _source.beyond.camera.get_camera_rid()
	_latch_viewport = SubViewport.new()
	_latch_viewport.size = Vector2i(2, 2)
	# A world of its own has nothing that would have to be culled.
	_latch_viewport.own_world_3d = true
	_latch_viewport.render_target_update_mode = SubViewport.UPDATE_ALWAYS
	var nothing := Camera3D.new()
	nothing.cull_mask = 0
	nothing.environment = Environment.new()
	nothing.compositor = Compositor.new()
	nothing.compositor.compositor_effects = [_latch]
	_latch_viewport.add_child(nothing)
	# Sibling viewports are drawn in this order, and before the viewport that contains them.
	add_child(_latch_viewport, false, Node.INTERNAL_MODE_FRONT)
	add_child(_source, false, Node.INTERNAL_MODE_FRONT)


func _draw(interface: XRInterface, viewport: Viewport) -> void:
	var pixels := Vector2i(interface.get_render_target_size() * viewport.scaling_3d_scale)
	if pixels.x < 1 or pixels.y < 1 or interface.get_view_count() < 2:
		return
	var frusta: Array = []
	var at: Array[Transform3D] = []
	for view in 2:
		frusta.append(YoroViews.tangents(interface.get_projection_for_view(view, float(pixels.x) / pixels.y, near, far)))
		at.append(interface.get_transform_for_view(view, XRServer.world_origin))
	var between := at[0].affine_inverse() * at[1]
	between.origin *= ipd_scale
	var levels := YoroLevels.of(frusta, between, near, far, dominant_eye, pixels, guard_band, foveation_strength(),
			gaze_from(at[dominant_eye]))
	if levels.trouble != "":
		_refuse(levels.trouble)
		return
	if _is_near():
		# This is not a fault, so there is no warning.
		_trouble = "most of the view is near"
		_draw_all(_Drawn.ALL_WATCHED)
		return
	_trouble = ""
	_put.debug_view = debug_view
	_put.same_image = way() == Mode.SAME_IMAGE
	_latch.interface = interface
	_latch.rendered = dominant_eye
	_latch.apart = levels.whole.apart
	_source.draw(levels, at[dominant_eye], self, viewport, effects(false))
	_draw_stereo_layers()


## True if the view is too near for the synthesis, as measured in the last frames.
func _is_near() -> bool:
	if not _watches():
		_nearness.share = 0.0
		_nearness.synthesized = true
		return false
	_nearness.depth_limit = YoroNearness.depth_at(near_limit, near, far)
	var is_near := _nearness.share >= (_SWITCH_ON if _nearness.synthesized else _SWITCH_OFF)
	if _nearness.synthesized == is_near:
		_nearness.synthesized = not is_near
	return is_near


## True if nearness is to be measured.
func _watches() -> bool:
	return near_limit > near and way() == Mode.ONE_VIEW


## Sets effects instead of the user's. To be called in each frame, since a change of [member compositor] would set that
## again.
func _set_effects(wanted: Array[CompositorEffect]) -> void:
	if _compositor.compositor_effects != wanted:
		_compositor.compositor_effects = wanted
	RenderingServer.camera_set_compositor(get_camera_rid(), _compositor.get_rid())


## Tells the renderer what this camera itself draws. Its properties do not change, since they are the user's.
func _draw_stereo_layers() -> void:
	_environment.follow(shown_environment(), cull_mask & stereo_layers != 0)
	var wanted := effects(true)
	if _watches():
		wanted.push_front(_nearness)
	wanted.push_front(_put)
	_set_effects(wanted)
	var camera := get_camera_rid()
	_show_layers(cull_mask & stereo_layers)
	RenderingServer.camera_set_environment(camera, _environment.copy.get_rid() if _environment.copy != null else RID())
	_latch_viewport.render_target_update_mode = SubViewport.UPDATE_ALWAYS
	_drawn = _Drawn.STEREO_LAYERS


## Lets Godot render both eyes, and warns of [param reason] if there is one, and of what follows from it.
func _refuse(reason: String, consequence := "Godot renders both eyes") -> void:
	if reason != "" and reason != _warned:
		_warned = reason
		push_warning("YoroCamera3D: %s, since %s." % [consequence, reason])
	_trouble = reason
	_draw_all()


## Lets Godot draw everything for both eyes.
func _draw_all(drawn := _Drawn.ALL) -> void:
	var camera := get_camera_rid()
	if _drawn == _Drawn.STEREO_LAYERS:
		_rest()
		_show_layers(cull_mask)
		RenderingServer.camera_set_environment(camera, environment.get_rid() if environment != null else RID())
	if drawn == _Drawn.ALL_WATCHED:
		var wanted: Array[CompositorEffect] = [_nearness]
		wanted.append_array(effects(false) + effects(true))
		_set_effects(wanted)
	elif drawn != _drawn:
		RenderingServer.camera_set_compositor(camera, compositor.get_rid() if compositor != null else RID())
	_drawn = drawn


## Lets the renderer's camera show these layers.
func _show_layers(layers: int) -> void:
	RenderingServer.camera_set_cull_mask(get_camera_rid(), layers)
	if layers != _shown_layers and is_inside_tree():
		YoroEye.renew_shadows(get_viewport())
	_shown_layers = layers


## Stops drawing the eye from which the other one is synthesized.
func _rest() -> void:
	if _source != null:
		_source.rest()
		_latch_viewport.render_target_update_mode = SubViewport.UPDATE_DISABLED


func _show_preview(shown: bool) -> void:
	if shown:
		# Nothing is drawn behind the preview. In each frame, since another camera's preview may have ended in this one.
		get_viewport().disable_3d = true
	if shown == (_preview != null):
		return
	if _preview != null:
		get_viewport().disable_3d = false
		_preview.queue_free()
		_preview = null
		return
	_preview = CanvasLayer.new()
	_preview.layer = -128
	var eyes := YoroPreview.new(self)
	eyes.set_anchors_preset(Control.PRESET_FULL_RECT)
	_preview.add_child(eyes)
	add_child(_preview, false, Node.INTERNAL_MODE_FRONT)


func _get_configuration_warnings() -> PackedStringArray:
	var warnings := PackedStringArray()
	if RenderingServer.get_current_rendering_method() == "gl_compatibility":
		warnings.append("The Compatibility renderer has no compositor effects: Godot renders both eyes. Choose Mobile or Forward+.")
	if ProjectSettings.get_setting("rendering/anti_aliasing/quality/use_taa", false):
		warnings.append("Temporal anti-aliasing needs motion vectors, which the synthesized eye does not have: use MSAA.")
	if ProjectSettings.get_setting("rendering/driver/threads/thread_model", 1) == 2:
		warnings.append("Rendering on a separate thread was not tried with this add-on: set Rendering > Driver > Thread Model to Safe.")
	if preview_without_headset and YoroPreview.fault(self) != "":
		warnings.append("There will be no preview, since %s." % YoroPreview.fault(self))
	for effect in effects(true):
		if effect.needs_normal_roughness or effect.needs_separate_specular or effect.needs_motion_vectors:
			warnings.append("An effect after transparent objects reads normals, specular light or motion: it gets those of things on the stereo layers only.")
			break
	if is_inside_tree() and Engine.is_editor_hint():
		warnings.append_array(YoroMarks.warnings(get_tree().edited_scene_root, stereo_layers, cull_mask))
	return warnings
