## Finds transparent things, and which of them, and of the lights, are on the layers that Godot draws for both eyes.
@tool
class_name YoroMarks
extends RefCounted

## The layer for things that Godot draws for both eyes, if the user has chosen none.
const LAYER := 1 << 19

## The number of layers for things.
const _LAYERS := 20
## The properties by which lights, probes, decals, particles and cameras choose things, according to their layers.
const _MASKS: PackedStringArray = ["cull_mask", "light_cull_mask", "shadow_caster_mask", "reflection_mask", "heightfield_mask", "bake_mask"]
## What fades in or out beyond this distance, in metres, counts as opaque: it moves by less than 3 of 1000 pixels.
const _FAR := 20.0


## A property that is to be set.
class Change:
	var node: Node3D
	var property: StringName
	var value: int

	func _init(of: Node3D, name: StringName, wanted: int) -> void:
		node = of
		property = name
		value = wanted


## Returns sentences about what will look wrong in a scene. [param seen] are the layers that the camera shows.
static func warnings(scene: Node, layers: int, seen: int) -> PackedStringArray:
	var sentences := PackedStringArray()
	if scene == null:
		return sentences
	var marked := drawn(scene, layers)
	var dark := lights(scene).filter(func(light: VisualInstance3D) -> bool: return light.layers & seen != 0 and light.layers & layers == 0)
	if not marked.is_empty() and not dark.is_empty():
		sentences.append("Lights, probes and decals that are not on the stereo layers are missing from things there, and the sky is made anew in each frame: %d, %s first." % [dark.size(), dark[0].name])
	var moved := transparent(scene).filter(func(thing: VisualInstance3D) -> bool: return thing.layers & seen != 0 and thing.layers & layers == 0)
	if not moved.is_empty():
		sentences.append("Transparent things that are not on the stereo layers move with what lies behind them: %d, %s first." % [moved.size(), moved[0].name])
	var solid := marked.filter(func(thing: GeometryInstance3D) -> bool:
		return thing.cast_shadow != GeometryInstance3D.SHADOW_CASTING_SETTING_OFF and not _is_transparent(thing))
	if not solid.is_empty() and lights(scene).any(func(light: VisualInstance3D) -> bool: return light is Light3D and light.shadow_enabled):
		sentences.append("Opaque things on the stereo layers cast no shadow on others, and receive none: %d, %s first. See the README." % [solid.size(), solid[0].name])
	return sentences


## Returns what to set so that Godot draws transparent things for both eyes, with their lights. The first stereo layer is
## [constant LAYER] if the user has chosen none. Masks select all things that they selected before, and no others: things
## that a mask tells apart get different layers.
static func changes(scene: Node, camera: YoroCamera3D) -> Array[Change]:
	var masks := _masks(scene)
	var stereo := camera.stereo_layers if camera.stereo_layers != 0 else LAYER
	var taken := 0
	for thing in drawn(scene, ~0):
		taken |= thing.layers
	var made: Array[Change] = []
	for thing in transparent(scene):
		if thing.layers & camera.cull_mask == 0 or thing.layers & ~stereo == 0:
			continue
		var layer := _layer_like(thing.layers, masks, stereo, taken)
		# Without a layer that is free, the thing remains as it is, and the warning about it, too.
		if layer == 0:
			continue
		for mask in masks:
			mask.value = mask.value | layer if mask.value & thing.layers != 0 else mask.value & ~layer
		stereo |= layer
		taken |= layer
		made.append(Change.new(thing, &"layers", layer))
	made.append_array(masks.filter(func(mask: Change) -> bool: return mask.value != mask.node.get(mask.property)))
	for light in lights(scene):
		if light.layers & camera.cull_mask != 0:
			made.append(Change.new(light, &"layers", light.layers | stereo))
	made.append(Change.new(camera, &"stereo_layers", stereo))
	return made


## Returns a stereo layer that all masks treat like [param layers], or one that nothing is on, or 0.
static func _layer_like(layers: int, masks: Array[Change], stereo: int, taken: int) -> int:
	var free := 0
	for i in range(_LAYERS - 1, -1, -1):
		var layer := 1 << i
		if taken & layer == 0:
			# The user's own choice comes first.
			if free == 0 or (stereo & layer != 0 and stereo & free == 0):
				free = layer
		elif stereo & layer != 0 and masks.all(func(mask: Change) -> bool: return (mask.value & layer != 0) == (mask.value & layers != 0)):
			return layer
	return free


static func _masks(scene: Node) -> Array[Change]:
	var masks: Array[Change] = []
	for node: Node in [scene] + scene.find_children("*", "Node3D", true, false):
		for property in _MASKS:
			if node is Node3D and property in node:
				masks.append(Change.new(node, property, node.get(property)))
	return masks


## Returns all things of a scene that are on [param layers].
static func drawn(scene: Node, layers: int) -> Array[VisualInstance3D]:
	return _all(scene, func(node: VisualInstance3D) -> bool: return node is GeometryInstance3D and node.layers & layers != 0)


## Returns everything in a scene that changes how things near it look.
static func lights(scene: Node) -> Array[VisualInstance3D]:
	return _all(scene, func(node: VisualInstance3D) -> bool:
		return node is Light3D or node is ReflectionProbe or node is Decal or node is VoxelGI or node is LightmapGI)


## Returns all transparent things of a scene.
static func transparent(scene: Node) -> Array[VisualInstance3D]:
	return _all(scene, func(node: VisualInstance3D) -> bool: return node is GeometryInstance3D and _is_transparent(node))


## True if a material is drawn after opaque ones. For shaders this is a guess from their code.
static func is_transparent_material(material: Material) -> bool:
	if material == null:
		return false
	if is_transparent_material(material.next_pass):
		return true
	if material is BaseMaterial3D:
		var clipped: bool = material.transparency in [BaseMaterial3D.TRANSPARENCY_ALPHA_SCISSOR, BaseMaterial3D.TRANSPARENCY_ALPHA_HASH]
		return ((material.transparency != BaseMaterial3D.TRANSPARENCY_DISABLED
				and not (clipped and material.alpha_antialiasing_mode == BaseMaterial3D.ALPHA_ANTIALIASING_OFF))
				or material.blend_mode != BaseMaterial3D.BLEND_MODE_MIX or material.refraction_enabled or material.proximity_fade_enabled
				or material.distance_fade_mode == BaseMaterial3D.DISTANCE_FADE_PIXEL_ALPHA
				or material.no_depth_test or material.depth_test != BaseMaterial3D.DEPTH_TEST_DEFAULT
				or material.depth_draw_mode == BaseMaterial3D.DEPTH_DRAW_DISABLED
				or material.stencil_mode in [BaseMaterial3D.STENCIL_MODE_OUTLINE, BaseMaterial3D.STENCIL_MODE_XRAY])
	if material is ShaderMaterial and material.shader != null:
		return _is_transparent_code(_code(material.shader.code, material.shader.resource_path, {}))
	return false


static func _is_transparent_code(code: String) -> bool:
	var has := func(pattern: String) -> bool: return RegEx.create_from_string("\\b(%s)\\b" % pattern).search(code) != null
	var clipped: bool = has.call("ALPHA_SCISSOR_THRESHOLD|ALPHA_HASH_SCALE") and not has.call("ALPHA_ANTIALIASING_EDGE")
	return ((has.call("ALPHA") and not clipped)
			or has.call("blend_(add|sub|mul|premul_alpha)|hint_(screen|depth|normal_roughness)_texture|depth_(draw_never|test_disabled|test_inverted)"))


## Returns a shader's code without comments and with the files that it includes. [param known] are those included before.
static func _code(code: String, path: String, known: Dictionary) -> String:
	# Strings stay, since paths look like comments.
	var bare := RegEx.create_from_string("(?s)(\"[^\"\\n]*\")|//[^\\n]*|/\\*.*?\\*/").sub(code, "$1", true)
	for found in RegEx.create_from_string("#include\\s+\"([^\"]+)\"").search_all(bare):
		var name := found.get_string(1)
		var file := name if name.contains("://") else path.get_base_dir().path_join(name)
		if known.has(file) or not ResourceLoader.exists(file):
			continue
		known[file] = true
		var included := load(file) as ShaderInclude
		if included != null:
			bare += _code(included.code, file, known)
	return bare


static func _is_transparent(thing: GeometryInstance3D) -> bool:
	if thing.transparency > 0.0 or _fades(thing) or is_transparent_material(thing.material_overlay):
		return true
	if thing.material_override != null:
		return is_transparent_material(thing.material_override)
	if thing is MeshInstance3D:
		for i in thing.get_surface_override_material_count():
			if is_transparent_material(thing.get_active_material(i)):
				return true
		return false
	if thing is SpriteBase3D or thing is Label3D:
		var blends: bool = thing.alpha_cut in [SpriteBase3D.ALPHA_CUT_DISABLED, SpriteBase3D.ALPHA_CUT_OPAQUE_PREPASS]
		return (blends and (thing is Label3D or thing.transparent)) or thing.no_depth_test
	if thing is CSGShape3D:
		return thing.is_root_shape() and _is_transparent_shape(thing)
	var meshes: Array[Mesh] = []
	if thing is GPUParticles3D:
		for i in thing.draw_passes:
			meshes.append(thing.get_draw_pass_mesh(i))
	elif thing is CPUParticles3D:
		meshes.append(thing.mesh)
	elif thing is MultiMeshInstance3D and thing.multimesh != null:
		meshes.append(thing.multimesh.mesh)
	for mesh in meshes:
		for i in mesh.get_surface_count() if mesh != null else 0:
			if is_transparent_material(mesh.surface_get_material(i)):
				return true
	return false


## True for a shape of which a part is transparent. All are drawn as one thing, on the root's layers.
static func _is_transparent_shape(shape: CSGShape3D) -> bool:
	if &"material" in shape and is_transparent_material(shape.get(&"material")):
		return true
	return shape.get_children().any(func(child: Node) -> bool: return child is CSGShape3D and _is_transparent_shape(child))


## True if a thing fades in or out, near enough to matter, at the limits of its visibility range or of its parent's.
static func _fades(thing: GeometryInstance3D) -> bool:
	var parent := thing.get_node_or_null(thing.visibility_parent) as GeometryInstance3D
	return ((thing.visibility_range_fade_mode == GeometryInstance3D.VISIBILITY_RANGE_FADE_SELF and _fades_near(thing))
			or (parent != null and parent.visibility_range_fade_mode == GeometryInstance3D.VISIBILITY_RANGE_FADE_DEPENDENCIES
			and _fades_near(parent)))


static func _fades_near(thing: GeometryInstance3D) -> bool:
	var begin := thing.visibility_range_begin
	var end := thing.visibility_range_end
	return ((begin > 0.0 and thing.visibility_range_begin_margin > 0.0 and begin - thing.visibility_range_begin_margin < _FAR)
			or (end > 0.0 and thing.visibility_range_end_margin > 0.0 and end - thing.visibility_range_end_margin < _FAR))


static func _all(node: Node, wanted: Callable) -> Array[VisualInstance3D]:
	var found: Array[VisualInstance3D] = []
	if node is VisualInstance3D and wanted.call(node):
		found.append(node)
	for child in node.get_children():
		found.append_array(_all(child, wanted))
	return found
