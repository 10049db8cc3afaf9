## Tests the editor with a scene that does not use the add-on yet: what the yoro menu does, and what undo restores. It
## emits the signals that a user's clicks would emit. With a display, pictures of the editor are saved to `out=FOLDER`.
extends SceneTree

enum Item { REPLACE, MARK, PREVIEW }

const STEREO := YoroMarks.LAYER

var out := ""
var menu: PopupMenu


func _initialize() -> void:
	for argument in OS.get_cmdline_user_args():
		out = argument.trim_prefix("out=") if argument.begins_with("out=") else out
	await _frames(30)
	EditorInterface.open_scene_from_path("res://test/editor.tscn")
	EditorInterface.set_main_screen_editor("3D")
	await _frames(30)
	for button: MenuButton in EditorInterface.get_base_control().find_children("*", "MenuButton", true, false):
		if button.text == "yoro":
			menu = button.get_popup()
	var scene := EditorInterface.get_edited_scene_root()
	var camera: XRCamera3D = scene.get_node("XROrigin3D/Head")
	var glass: MeshInstance3D = scene.get_node("Glass")
	var box: MeshInstance3D = scene.get_node("Box")
	var lights: Array[VisualInstance3D] = [scene.get_node("Sun"), scene.get_node("Probe"), scene.get_node("Lamp"), scene.get_node("Sticker")]
	print("fact marks that are wrong: %s" % [_wrong_marks()])
	await _choose(Item.MARK)
	print("fact without a camera of ours nothing is marked: %s" % [glass.layers == 1])
	await _choose(Item.REPLACE)
	print("fact replaced %s, near %s, children %d" % [camera is YoroCamera3D, camera.near, camera.get_child_count()])
	print("fact warnings before: %d" % camera._get_configuration_warnings().size())
	var shown := ProjectSettings.get_property_list().filter(func(it: Dictionary) -> bool: return it.name.begins_with("xr/yoro/"))
	print("fact on the settings page: %s" % [shown.map(func(it: Dictionary) -> String: return it.hint_string)])
	if out != "":
		_open(camera)
	await _picture("menu")
	var masks := YoroMarks._masks(scene)
	var things := YoroMarks.drawn(scene, ~0)
	var before := _chosen(masks, things)
	await _choose(Item.MARK)
	print("fact masks choose what they chose %s, from %s to %s" % [_chosen(masks, things) == before, before.count(true), before.size()])
	var lit := lights.all(func(light: VisualInstance3D) -> bool: return light.layers == 1 | camera.stereo_layers)
	print("fact glass on its own layer %s, box as it was %s, lights on both %s" % [glass.layers == STEREO, box.layers == 1, lit])
	print("fact stereo layers %d" % camera.stereo_layers)
	print("fact warnings after: %d" % camera._get_configuration_warnings().size())
	if RenderingServer.get_rendering_device() != null:
		await _choose(Item.PREVIEW)
		await _frames(10)
		await _picture("preview")
		await _choose(Item.PREVIEW)
	var manager := EditorInterface.get_editor_undo_redo()
	var history := manager.get_history_undo_redo(manager.get_object_history_id(scene))
	history.undo()
	var unmarked := masks.all(func(mask: YoroMarks.Change) -> bool: return mask.value == mask.node.get(mask.property))
	print("fact unmarked %s" % [unmarked and camera.stereo_layers == 0 and glass.layers == 1 and lights.all(func(light: VisualInstance3D) -> bool: return light.layers == 1)])
	history.undo()
	print("fact put back %s" % [not camera is YoroCamera3D])
	print("fact done")
	quit()


## Returns for each mask and each thing whether the mask selects it.
func _chosen(masks: Array[YoroMarks.Change], things: Array[VisualInstance3D]) -> Array[bool]:
	var chosen: Array[bool] = []
	for mask in masks:
		for thing in things:
			chosen.append(mask.node.get(mask.property) & thing.layers != 0)
	return chosen


## Returns the cases in which a thing is not called what Godot makes of it: transparent things are drawn after opaque
## ones.
func _wrong_marks() -> Array[String]:
	var standard := func(set_up: Callable) -> Callable:
		return func(thing: MeshInstance3D) -> void:
			var material := StandardMaterial3D.new()
			set_up.call(material)
			thing.material_override = material
	var shader := func(code: String) -> Callable:
		return func(thing: MeshInstance3D) -> void:
			var material := ShaderMaterial.new()
			material.shader = Shader.new()
			material.shader.code = "shader_type spatial;\n" + code
			thing.material_override = material
	var ranged := func(mode: int, begin: float, margin: float) -> Callable:
		return func(thing: MeshInstance3D) -> void:
			thing.visibility_range_fade_mode = mode
			thing.visibility_range_begin = begin
			thing.visibility_range_begin_margin = margin
	var glass := StandardMaterial3D.new()
	glass.transparency = BaseMaterial3D.TRANSPARENCY_ALPHA
	var opaque := {
		plain = standard.call(func(_m: Material) -> void: pass),
		scissor = standard.call(func(m: Material) -> void: m.transparency = BaseMaterial3D.TRANSPARENCY_ALPHA_SCISSOR),
		dither = standard.call(func(m: Material) -> void: m.distance_fade_mode = BaseMaterial3D.DISTANCE_FADE_PIXEL_DITHER),
		comment = shader.call("// ALPHA\n/* hint_screen_texture */ void fragment() { ALBEDO = vec3(1.0); }"),
		clipped = shader.call("void fragment() { ALPHA = 0.5; ALPHA_SCISSOR_THRESHOLD = 0.3; }"),
		unfaded = ranged.call(GeometryInstance3D.VISIBILITY_RANGE_FADE_DISABLED, 5.0, 1.0),
		far_fade = ranged.call(GeometryInstance3D.VISIBILITY_RANGE_FADE_SELF, 80.0, 10.0),
	}
	var transparent := {
		alpha = standard.call(func(m: Material) -> void: m.transparency = BaseMaterial3D.TRANSPARENCY_ALPHA),
		smooth = standard.call(func(m: Material) -> void:
			m.transparency = BaseMaterial3D.TRANSPARENCY_ALPHA_SCISSOR
			m.alpha_antialiasing_mode = BaseMaterial3D.ALPHA_ANTIALIASING_ALPHA_TO_COVERAGE),
		next = standard.call(func(m: Material) -> void: m.next_pass = glass),
		proximity = standard.call(func(m: Material) -> void: m.proximity_fade_enabled = true),
		distance = standard.call(func(m: Material) -> void: m.distance_fade_mode = BaseMaterial3D.DISTANCE_FADE_PIXEL_ALPHA),
		no_depth = standard.call(func(m: Material) -> void: m.no_depth_test = true),
		inverted = standard.call(func(m: Material) -> void: m.depth_test = BaseMaterial3D.DEPTH_TEST_INVERTED),
		undrawn = standard.call(func(m: Material) -> void: m.depth_draw_mode = BaseMaterial3D.DEPTH_DRAW_DISABLED),
		on_top = shader.call("render_mode depth_test_disabled; void fragment() { ALBEDO = vec3(1.0); }"),
		included = shader.call("#include \"res://test/fades.gdshaderinc\"\nvoid fragment() { FADE; }"),
		near_fade = ranged.call(GeometryInstance3D.VISIBILITY_RANGE_FADE_SELF, 5.0, 1.0),
		under_overlay = func(thing: MeshInstance3D) -> void:
			thing.set_surface_override_material(0, glass)
			thing.material_overlay = StandardMaterial3D.new(),
	}
	var wrong: Array[String] = []
	for cases: Dictionary in [opaque, transparent]:
		for name: String in cases:
			var thing := MeshInstance3D.new()
			thing.mesh = BoxMesh.new()
			cases[name].call(thing)
			if YoroMarks.transparent(thing).is_empty() != (cases == opaque):
				wrong.append(name)
			thing.free()
	return wrong


func _choose(item: Item) -> void:
	menu.id_pressed.emit(item)
	await _frames(3)


func _frames(count: int) -> void:
	for i in count:
		await process_frame


## Saves a picture of the whole editor.
func _picture(name: String) -> void:
	if out != "":
		await _frames(20)
		EditorInterface.get_base_control().get_viewport().get_texture().get_image().save_png("%s/%s.png" % [out, name])


## Opens the menu, and the warning of a node in the scene tree.
func _open(node: Node) -> void:
	const WARNING := 5
	var editor: Node = EditorInterface.get_base_control().find_children("*", "SceneTreeEditor", true, false)[0]
	var tree: Tree = editor.find_children("*", "Tree", true, false)[0]
	var item := tree.get_root()
	while item.get_text(0) != node.name:
		item = item.get_next_in_tree()
	tree.button_clicked.emit(item, 0, WARNING, MOUSE_BUTTON_LEFT)
	var button: MenuButton = menu.get_parent()
	button.show_popup()
