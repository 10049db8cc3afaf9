// Scenes after those of three's own examples, with three's add-ons: what people build with it. They need no files.

import * as THREE from 'three';
import { BoxLineGeometry } from 'three/addons/geometries/BoxLineGeometry.js';
import { TeapotGeometry } from 'three/addons/geometries/TeapotGeometry.js';
import { RoomEnvironment } from 'three/addons/environments/RoomEnvironment.js';
import { RollerCoasterGeometry, RollerCoasterLiftersGeometry, RollerCoasterShadowGeometry, TreesGeometry } from 'three/addons/misc/RollerCoaster.js';
import { Reflector } from 'three/addons/objects/Reflector.js';
import { Sky } from 'three/addons/objects/Sky.js';

/** Numbers from 0 to 1, the same for the same seed. */
function randomOf(seed) {
  return () => {
    seed = (seed + 0x6d2b79f5) | 0;
    let t = Math.imul(seed ^ (seed >>> 15), 1 | seed);
    t = (t + Math.imul(t ^ (t >>> 7), 61 | t)) ^ t;
    return ((t ^ (t >>> 14)) >>> 0) / 4294967296;
  };
}

let random = Math.random;
const between = (low, high) => low + random() * (high - low);

/** A texture that a function draws. */
function drawn(size, draw) {
  const canvas = document.createElement('canvas');
  canvas.width = canvas.height = size;
  draw(canvas.getContext('2d'), size);
  const map = new THREE.CanvasTexture(canvas);
  map.colorSpace = THREE.SRGBColorSpace;
  map.anisotropy = 8;
  return map;
}

const checker = (light, dark, repeat) => {
  const map = drawn(64, (pen) => {
    pen.fillStyle = light;
    pen.fillRect(0, 0, 64, 64);
    pen.fillStyle = dark;
    pen.fillRect(0, 0, 32, 32);
    pen.fillRect(32, 32, 32, 32);
  });
  map.wrapS = map.wrapT = THREE.RepeatWrapping;
  map.repeat.set(repeat, repeat);
  return map;
};

/** A soft dot, for particles. */
const dot = () => drawn(32, (pen) => {
  const glow = pen.createRadialGradient(16, 16, 0, 16, 16, 16);
  glow.addColorStop(0, '#fff');
  glow.addColorStop(1, '#0000');
  pen.fillStyle = glow;
  pen.fillRect(0, 0, 32, 32);
});

function lightOf(renderer, scene, intensity = 1) {
  const generator = new THREE.PMREMGenerator(renderer);
  scene.environment = generator.fromScene(new RoomEnvironment(), 0.04).texture;
  scene.environmentIntensity = intensity;
  generator.dispose();
}

function room(scene) {
  scene.background = new THREE.Color(0x505050);
  const sun = new THREE.DirectionalLight(0xffffff, 3);
  sun.position.set(1, 1, 1);
  const lines = new THREE.LineSegments(new BoxLineGeometry(6, 6, 6, 10, 10, 10).translate(0, 3, 0), new THREE.LineBasicMaterial({ color: 0xbcbcbc }));
  scene.add(new THREE.HemisphereLight(0xa5a5a5, 0x898989, 3), sun, lines);
}

/** Two hundred things in a room of lines. */
function scattered(scene, geometry, turn) {
  room(scene);
  for (let i = 0; i < 200; i++) {
    const mesh = new THREE.Mesh(geometry, new THREE.MeshLambertMaterial({ color: new THREE.Color().setHSL(random(), 0.6, 0.5) }));
    mesh.position.set(between(-2, 2), between(0, 4), between(-2, 2));
    if (turn) mesh.rotation.set(between(0, 6), between(0, 6), between(0, 6));
    scene.add(mesh);
  }
  return { near: 0.1, far: 20, fov: 70, at: [0, 1.6, 3], to: [0, 1.6, 0] };
}

/** Teapots under a spotlight with shadows, in a room of emitters. */
function teapots(scene, renderer, materialOf) {
  lightOf(renderer, scene, 0.5);
  const walls = new RoomEnvironment();
  walls.position.y = -1;
  walls.scale.setScalar(0.25);
  // Its lamp is for the room's full size.
  walls.traverse((object) => {
    if (object.isLight) object.visible = false;
  });
  const sun = new THREE.SpotLight(0xffffff, 60, 0, 0.9, 0.5);
  sun.position.set(1.5, 4, 2);
  sun.target.position.z = -0.5;
  sun.castShadow = true;
  sun.shadow.mapSize.set(1024, 1024);
  const floor = new THREE.Mesh(new THREE.PlaneGeometry(6, 6).rotateX(-Math.PI / 2), new THREE.MeshStandardMaterial({ map: checker('#ddd', '#347', 12), roughness: 0.6 }));
  floor.receiveShadow = true;
  scene.add(walls, sun, sun.target, floor);
  const pot = new TeapotGeometry(0.22, 10);
  for (let i = 0; i < 9; i++) {
    const mesh = new THREE.Mesh(pot, materialOf(i));
    mesh.position.set((i % 3 - 1) * 0.8, 0.22, 0.4 - Math.floor(i / 3) * 0.8);
    mesh.rotation.y = i;
    mesh.castShadow = mesh.receiveShadow = true;
    scene.add(mesh);
  }
  return { near: 0.1, far: 30, fov: 65, at: [0.2, 1, 1.9], to: [0, 0.1, -0.4], toneMapping: THREE.AgXToneMapping, hasShadows: true };
}

const enamel = (i) => new THREE.MeshPhysicalMaterial({ color: new THREE.Color().setHSL(i / 9, 0.7, 0.5), metalness: (i % 3) / 2, roughness: 0.15 + 0.1 * i, clearcoat: 0.5 });

const SCENES = {
  cubes: (scene) => scattered(scene, new THREE.BoxGeometry(0.15, 0.15, 0.15), true),
  balls: (scene) => scattered(scene, new THREE.IcosahedronGeometry(0.08, 3), false),

  coaster(scene) {
    scene.background = new THREE.Color(0xc8d8f0);
    scene.add(new THREE.HemisphereLight(0xfff0f0, 0x60606f, 3));
    const ground = new THREE.PlaneGeometry(500, 500, 15, 15).rotateX(-Math.PI / 2);
    const points = ground.attributes.position;
    for (let i = 0; i < points.count; i++) {
      const x = points.getX(i) + between(-5, 5), z = points.getZ(i) + between(-5, 5);
      points.setXYZ(i, x, random() * Math.max(0, Math.hypot(x, z) / 5 - 25), z);
    }
    ground.computeVertexNormals();
    const hills = new THREE.Mesh(ground, new THREE.MeshLambertMaterial({ color: 0x407000 }));
    hills.updateMatrixWorld();
    const place = new THREE.Vector3(), along = new THREE.Vector3();
    const curve = {
      getPointAt(share) {
        const t = share * 2 * Math.PI;
        return place.set(Math.sin(3 * t) * Math.cos(4 * t) * 50, 2 * Math.sin(10 * t) + 2 * Math.cos(17 * t) + 5, Math.sin(t) * Math.sin(4 * t) * 50).multiplyScalar(2);
      },
      getTangentAt(share) {
        along.copy(curve.getPointAt(Math.min(1, share + 1e-4)));
        return along.sub(curve.getPointAt(Math.max(0, share - 1e-4))).normalize();
      },
    };
    const add = (geometry, material, y = 0.1) => {
      const mesh = new THREE.Mesh(geometry, material);
      mesh.position.y = y;
      scene.add(mesh);
    };
    scene.add(hills);
    add(new TreesGeometry(hills), new THREE.MeshBasicMaterial({ side: THREE.DoubleSide, vertexColors: true }), 0);
    add(new RollerCoasterGeometry(curve, 1500), new THREE.MeshPhongMaterial({ vertexColors: true }), 0);
    add(new RollerCoasterLiftersGeometry(curve, 100), new THREE.MeshPhongMaterial());
    add(new RollerCoasterShadowGeometry(curve, 500), new THREE.MeshBasicMaterial({ color: 0x305000, depthWrite: false, transparent: true }));
    const at = curve.getPointAt(0.13).clone().add(new THREE.Vector3(0, 1, 0));
    const to = at.clone().add(curve.getTangentAt(0.13));
    return { near: 0.1, far: 500, fov: 70, at: at.toArray(), to: to.toArray() };
  },

  clearcoat(scene, renderer) {
    lightOf(renderer, scene);
    scene.background = scene.environment;
    scene.backgroundBlurriness = 0.3;
    const flakes = drawn(256, (pen) => {
      for (let i = 0; i < 3000; i++) {
        pen.fillStyle = `rgb(${between(90, 166)} ${between(90, 166)} 255)`;
        pen.fillRect(between(0, 256), between(0, 256), 4, 4);
      }
    });
    flakes.colorSpace = THREE.NoColorSpace;
    flakes.wrapS = flakes.wrapT = THREE.RepeatWrapping;
    flakes.repeat.set(6, 4);
    [
      { color: 0x0000ff, metalness: 0.9, roughness: 0.5, clearcoat: 1, clearcoatRoughness: 0.1, normalMap: flakes, normalScale: new THREE.Vector2(0.15, 0.15) },
      { color: 0xffaa00, roughness: 0.4, clearcoat: 1, sheen: 1, sheenColor: new THREE.Color(0xff4488), sheenRoughness: 0.4 },
      { color: 0xffffff, roughness: 0.1, clearcoat: 1, iridescence: 1, iridescenceIOR: 1.6 },
      { color: 0xff0000, metalness: 1, roughness: 0.25, clearcoat: 1, anisotropy: 0.8 },
    ].forEach((material, i) => {
      const ball = new THREE.Mesh(new THREE.SphereGeometry(0.8, 64, 32), new THREE.MeshPhysicalMaterial(material));
      ball.position.set(i % 2 ? 1 : -1, i < 2 ? 1 : -1, i * 0.3);
      scene.add(ball);
    });
    const light = new THREE.PointLight(0xffffff, 30);
    light.position.set(2, 2, 3);
    scene.add(light);
    return { near: 0.1, far: 50, fov: 60, at: [0.4, 0.3, 4], to: [0, 0, 0], toneMapping: THREE.ACESFilmicToneMapping };
  },

  teapots: (scene, renderer) => teapots(scene, renderer, enamel),

  /** What is transparent: panes, a bubble, additive particles. */
  glass(scene, renderer) {
    const made = teapots(scene, renderer, enamel);
    const pane = new THREE.Mesh(new THREE.PlaneGeometry(0.9, 0.9), new THREE.MeshStandardMaterial({ color: 0x66ccff, transparent: true, opacity: 0.35, side: THREE.DoubleSide, roughness: 0.1 }));
    pane.position.set(-0.35, 0.7, 0.7);
    pane.rotation.y = 0.5;
    const bubble = new THREE.Mesh(new THREE.SphereGeometry(0.2, 32, 16), new THREE.MeshPhysicalMaterial({ transparent: true, opacity: 0.25, iridescence: 1, roughness: 0 }));
    bubble.position.set(0.5, 0.75, 0.6);
    scene.add(pane, bubble);
    const map = dot();
    for (let i = 0; i < 40; i++) {
      const sprite = new THREE.Sprite(new THREE.SpriteMaterial({ map, color: new THREE.Color().setHSL(i / 40, 1, 0.6), blending: THREE.AdditiveBlending, depthWrite: false }));
      sprite.position.set(between(-1, 1), between(0.3, 1.4), between(-1, 1));
      sprite.scale.setScalar(0.08);
      scene.add(sprite);
    }
    return made;
  },

  /** Transmission: three draws it with a copy of what is behind. */
  transmission: (scene, renderer) => teapots(scene, renderer, (i) => new THREE.MeshPhysicalMaterial({ transmission: 1, thickness: 0.2, roughness: 0.05, ior: 1.4, attenuationColor: new THREE.Color().setHSL(i / 9, 0.7, 0.5), attenuationDistance: 0.3 })),

  /** A mirror: it renders the scene while the scene is drawn. */
  mirror(scene, renderer) {
    const made = teapots(scene, renderer, enamel);
    const mirror = new Reflector(new THREE.PlaneGeometry(2.2, 1), { textureWidth: 512, textureHeight: 512 });
    mirror.position.set(0, 0.6, -1.6);
    scene.add(mirror);
    return made;
  },

  /** Instances, fog, a skin, cut-out leaves, several materials on one mesh. */
  street(scene) {
    scene.background = new THREE.Color(0x9fb4c8);
    scene.fog = new THREE.Fog(0x9fb4c8, 8, 60);
    const sun = new THREE.DirectionalLight(0xfff0d8, 2.5);
    sun.position.set(0.5, 1, 0.4);
    scene.add(new THREE.HemisphereLight(0xbdd0ff, 0x665544, 1.5), sun);
    scene.add(new THREE.Mesh(new THREE.PlaneGeometry(200, 200).rotateX(-Math.PI / 2), new THREE.MeshLambertMaterial({ map: checker('#8a8478', '#7a756c', 100) })));
    const windows = drawn(64, (pen) => {
      pen.fillStyle = '#b49a7e';
      pen.fillRect(0, 0, 64, 64);
      pen.fillStyle = '#354452';
      for (const x of [8, 38]) for (const y of [8, 38]) pen.fillRect(x, y, 18, 20);
    });
    const houses = new THREE.InstancedMesh(new THREE.BoxGeometry(1, 1, 1).translate(0, 0.5, 0), new THREE.MeshStandardMaterial({ map: windows, roughness: 0.9 }), 40);
    const matrix = new THREE.Matrix4();
    for (let i = 0; i < 40; i++) {
      matrix.makeScale(3, between(3, 9), 3).setPosition((i % 2 ? 1 : -1) * between(4.5, 6), 0, 2 - 4 * (i >> 1));
      houses.setMatrixAt(i, matrix);
      houses.setColorAt(i, new THREE.Color().setHSL(between(0.03, 0.12), 0.3, between(0.4, 0.8)));
    }
    scene.add(houses);
    const leaf = drawn(64, (pen) => {
      pen.fillStyle = '#5a8f3c';
      for (let i = 0; i < 60; i++) {
        pen.beginPath();
        pen.arc(between(4, 60), between(4, 60), between(2, 5), 0, 7);
        pen.fill();
      }
    });
    const leaves = new THREE.MeshLambertMaterial({ map: leaf, alphaTest: 0.5, side: THREE.DoubleSide });
    const box = new THREE.Mesh(new THREE.BoxGeometry(0.5, 0.5, 0.5), Array.from({ length: 6 }, (_, i) => new THREE.MeshStandardMaterial({ color: new THREE.Color().setHSL(i / 6, 0.6, 0.5) })));
    box.position.set(-0.6, 0.25, -1.5);
    box.rotation.y = 0.6;
    scene.add(box);
    for (let i = 0; i < 6; i++) {
      const trunk = new THREE.Mesh(new THREE.CylinderGeometry(0.06, 0.1, 1.6), new THREE.MeshLambertMaterial({ color: 0x5a4632 }));
      trunk.position.set((i % 2 ? 1 : -1) * 2, 0.8, -1 - 2 * i);
      for (let k = 0; k < 4; k++) {
        const branch = new THREE.Mesh(new THREE.PlaneGeometry(1.4, 1.2), leaves);
        branch.position.y = 1.1;
        branch.rotation.y = k * Math.PI / 4;
        trunk.add(branch);
      }
      scene.add(trunk);
    }
    // A flag on two bones.
    const cloth = new THREE.PlaneGeometry(1, 0.6, 10, 1);
    const { position } = cloth.attributes;
    const indices = [], weights = [];
    for (let i = 0; i < position.count; i++) {
      indices.push(0, 1, 0, 0);
      weights.push(0.5 - position.getX(i), 0.5 + position.getX(i), 0, 0);
    }
    cloth.setAttribute('skinIndex', new THREE.Uint16BufferAttribute(indices, 4));
    cloth.setAttribute('skinWeight', new THREE.Float32BufferAttribute(weights, 4));
    const bones = [new THREE.Bone(), new THREE.Bone()];
    bones[0].add(bones[1]);
    const flag = new THREE.SkinnedMesh(cloth, new THREE.MeshStandardMaterial({ map: checker('#d22', '#fff', 3), side: THREE.DoubleSide }));
    flag.add(bones[0]);
    flag.bind(new THREE.Skeleton(bones));
    bones[1].position.set(0, 0.15, 0.3);
    flag.position.set(0.5, 1.8, -2);
    scene.add(flag);
    return { near: 0.1, far: 120, fov: 70, at: [0, 1.6, 1.5], to: [0, 1.4, -4], toneMapping: THREE.NeutralToneMapping ?? THREE.ACESFilmicToneMapping };
  },

  /** Levels of detail under a sky, and points. */
  garden(scene) {
    const sky = new Sky();
    sky.scale.setScalar(1000);
    sky.material.uniforms.turbidity.value = 1;
    sky.material.uniforms.sunPosition.value.set(-0.8, 0.3, -0.56);
    const sun = new THREE.DirectionalLight(0xffe8c0, 3);
    sun.position.set(-0.8, 0.5, 0.3);
    scene.add(sky, sun, new THREE.HemisphereLight(0x88aaff, 0x334422, 1));
    const ground = new THREE.PlaneGeometry(60, 60, 60, 60).rotateX(-Math.PI / 2);
    const { position } = ground.attributes;
    for (let i = 0; i < position.count; i++) position.setY(i, 0.15 * Math.sin(1.3 * position.getX(i)) * Math.cos(1.1 * position.getZ(i)));
    ground.computeVertexNormals();
    scene.add(new THREE.Mesh(ground, new THREE.MeshStandardMaterial({ map: checker('#5d7a3a', '#557134', 30), roughness: 1 })));
    const levels = [32, 12, 5].map((n) => new THREE.SphereGeometry(0.4, n, n));
    for (let i = 0; i < 40; i++) {
      const shrub = new THREE.LOD();
      const material = new THREE.MeshStandardMaterial({ color: new THREE.Color().setHSL(between(0.2, 0.35), 0.5, 0.35), roughness: 0.9 });
      levels.forEach((geometry, level) => shrub.addLevel(new THREE.Mesh(geometry, material), level * 6));
      shrub.position.set(between(-6, 6), 0.3, between(-14, 0));
      scene.add(shrub);
    }
    const petals = new THREE.BufferGeometry();
    petals.setAttribute('position', new THREE.Float32BufferAttribute(Array.from({ length: 900 }, (_, i) => (i % 3 === 1 ? between(0.3, 2.5) : i % 3 ? between(-8, 1) : between(-4, 4))), 3));
    scene.add(new THREE.Points(petals, new THREE.PointsMaterial({ map: dot(), color: 0xffc0d8, size: 0.06, transparent: true, depthWrite: false })));
    return { near: 0.1, far: 2000, fov: 70, at: [0, 1.6, 3], to: [0, 1.1, -3], toneMapping: THREE.ACESFilmicToneMapping, exposure: 0.6 };
  },
};

/** The names of all scenes. */
export const names = Object.keys(SCENES);

/**
 * Builds a scene, sets the renderer to it, and returns it with a camera. The same name gives the same scene.
 *
 * @param {string} name
 * @param {THREE.WebGLRenderer} renderer
 */
export function build(name, renderer) {
  const { random: own } = Math;
  random = Math.random = randomOf(12345);
  const scene = new THREE.Scene();
  let made;
  try {
    made = SCENES[name](scene, renderer);
  } finally {
    Math.random = own;
  }
  prepare(renderer, made);
  return { scene, camera: cameraOf(made) };
}

/** Sets the renderer to what a scene needs. */
export function prepare(renderer, { toneMapping = THREE.NoToneMapping, exposure = 1, hasShadows = false }) {
  renderer.toneMapping = toneMapping;
  renderer.toneMappingExposure = exposure;
  renderer.shadowMap.enabled = hasShadows;
  renderer.shadowMap.type = THREE.PCFShadowMap;
}

export function cameraOf({ fov, near, far, at, to }) {
  const camera = new THREE.PerspectiveCamera(fov, 2, near, far);
  camera.position.fromArray(at);
  camera.lookAt(new THREE.Vector3().fromArray(to));
  return camera;
}
