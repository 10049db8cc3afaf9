## A room with textured things, a lamp, a glass sphere and a pane, all made by this script.
class_name DemoRoom
extends Node3D

## The layers that Godot draws for both eyes, for YoroCamera3D.stereo_layers.
const STEREO := YoroMarks.LAYER

var environment := WorldEnvironment.new()
var lamp := OmniLight3D.new()
var sun := DirectionalLight3D.new()


func _init() -> void:
	var wall := _checked(Color(0.75, 0.7, 0.6), Color(0.6, 0.55, 0.5), 16, 1)
	var wood := _checked(Color(0.5, 0.3, 0.15), Color(0.42, 0.24, 0.1), 4, 2)
	var blue := _checked(Color(0.2, 0.3, 0.7), Color(0.8, 0.8, 0.9), 8, 3)
	var red := _checked(Color(0.75, 0.15, 0.1), Color(0.9, 0.7, 0.2), 6, 4)
	var steel := _checked(Color(0.6, 0.6, 0.62), Color(0.5, 0.5, 0.55), 2, 5)
	steel.metallic = 0.8
	steel.roughness = 0.3
	# Open to the right, so that the sky is visible.
	_box(Vector3(9, 0.2, 9), Vector3(0, -0.1, -2), wood)
	_box(Vector3(9, 3, 0.2), Vector3(0, 1.5, -6), wall)
	_box(Vector3(0.2, 3, 9), Vector3(-4, 1.5, -2), wall)
	_box(Vector3(1.6, 0.06, 0.8), Vector3(0, 0.8, -1.7), wood)
	for leg in [Vector2(-0.7, -2.0), Vector2(0.7, -2.0), Vector2(-0.7, -1.4), Vector2(0.7, -1.4)]:
		_box(Vector3(0.06, 0.8, 0.06), Vector3(leg.x, 0.4, leg.y), wood)
	_sphere(0.18, Vector3(-0.4, 1.01, -1.6), red)
	_sphere(0.1, Vector3(0.0, 0.93, -1.4), steel)
	_box(Vector3(0.25, 0.4, 0.25), Vector3(0.45, 1.03, -1.75), blue).rotation.y = 0.5
	_box(Vector3(1, 2.2, 1), Vector3(-2.4, 1.1, -4), blue).rotation.y = 0.3
	_box(Vector3(0.8, 1.2, 0.8), Vector3(1.8, 0.6, -3.6), red).rotation.y = -0.4
	_sphere(0.6, Vector3(0.6, 0.6, -4.6), steel)
	for i in 5:
		_box(Vector3(0.12, 3, 0.12), Vector3(-3.2 + 1.6 * i, 1.5, -5.2), wall)
	var bulb := StandardMaterial3D.new()
	bulb.emission_enabled = true
	bulb.emission = Color(1.0, 0.8, 0.5)
	bulb.emission_energy_multiplier = 4.0
	_sphere(0.09, Vector3(-0.9, 1.7, -2.6), bulb)
	var glass := StandardMaterial3D.new()
	glass.albedo_color = Color(0.3, 0.9, 0.6, 0.35)
	glass.transparency = BaseMaterial3D.TRANSPARENCY_ALPHA
	glass.roughness = 0.1
	_box(Vector3(0.5, 0.5, 0.03), Vector3(0.4, 1.45, -1.2), glass).layers = STEREO
	_sphere(0.12, Vector3(-0.1, 1.3, -1.3), glass).layers = STEREO
	sun.rotation_degrees = Vector3(-50, -40, 0)
	sun.light_energy = 0.8
	sun.shadow_enabled = true
	sun.layers |= STEREO
	add_child(sun)
	lamp.position = Vector3(-0.9, 1.9, -2.4)
	lamp.omni_range = 6.0
	lamp.light_energy = 2.0
	lamp.light_color = Color(1.0, 0.85, 0.65)
	lamp.layers |= STEREO
	add_child(lamp)
	var sky := Sky.new()
	sky.sky_material = ProceduralSkyMaterial.new()
	environment.environment = Environment.new()
	environment.environment.sky = sky
	environment.environment.background_mode = Environment.BG_SKY
	environment.environment.tonemap_mode = Environment.TONE_MAPPER_ACES
	add_child(environment)


static func _checked(a: Color, b: Color, cells: int, grain: int) -> StandardMaterial3D:
	var image := Image.create(256, 256, true, Image.FORMAT_RGB8)
	var random := RandomNumberGenerator.new()
	random.seed = grain
	for y in 256:
		for x in 256:
			var color := a if (x * cells / 256 + y * cells / 256) % 2 == 0 else b
			image.set_pixel(x, y, color * (0.85 + 0.15 * random.randf()))
	image.generate_mipmaps()
	var material := StandardMaterial3D.new()
	material.albedo_texture = ImageTexture.create_from_image(image)
	material.roughness = 0.6
	material.uv1_triplanar = true
	material.uv1_scale = Vector3.ONE * 0.7
	material.texture_filter = BaseMaterial3D.TEXTURE_FILTER_LINEAR_WITH_MIPMAPS_ANISOTROPIC
	return material


func _box(size: Vector3, at: Vector3, material: Material) -> MeshInstance3D:
	var mesh := BoxMesh.new()
	mesh.size = size
	return _add(mesh, at, material)


func _sphere(radius: float, at: Vector3, material: Material) -> MeshInstance3D:
	var mesh := SphereMesh.new()
	mesh.radius = radius
	mesh.height = 2.0 * radius
	return _add(mesh, at, material)


func _add(mesh: Mesh, at: Vector3, material: Material) -> MeshInstance3D:
	var thing := MeshInstance3D.new()
	thing.mesh = mesh
	thing.material_override = material
	thing.position = at
	add_child(thing)
	return thing
