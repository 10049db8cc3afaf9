// What the tests call in a browser, as `check`.

import * as THREE from 'three';
import { StereoEffect } from 'three/addons/effects/StereoEffect.js';
import { EffectComposer } from 'three/addons/postprocessing/EffectComposer.js';
import { RenderPass } from 'three/addons/postprocessing/RenderPass.js';
import { ShaderPass } from 'three/addons/postprocessing/ShaderPass.js';
import { LineMaterial } from 'three/addons/lines/LineMaterial.js';
import { LineSegments2 } from 'three/addons/lines/LineSegments2.js';
import { LineSegmentsGeometry } from 'three/addons/lines/LineSegmentsGeometry.js';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';
import { RoomEnvironment } from 'three/addons/environments/RoomEnvironment.js';
import { StereoSynthesis } from 'yoro-three';
import { build, names } from '../examples/scenes.js';
import { createChooser } from '../src/choice.js';
import { levelName } from '../src/levels.js';
import { viewsOf } from '../src/views.js';
import { psnr, ssim } from './metrics.js';

const round = (x, digits = 2) => Math.round(x * 10 ** digits) / 10 ** digits;
/** A page may have few contexts: renderers are kept by their options. */
const renderers = new Map();

function rendererOf(width, height, { isHalf = false, ...options } = {}) {
  const key = JSON.stringify([options, isHalf]);
  if (!renderers.has(key)) {
    renderers.set(key, new THREE.WebGLRenderer({ preserveDrawingBuffer: true, ...options, ...(isHalf && { outputBufferType: THREE.HalfFloatType }) }));
  }
  const renderer = renderers.get(key);
  renderer.setPixelRatio(1);
  renderer.setSize(width, height, false);
  renderer.setClearColor(0x000000, options.alpha ? 0 : 1);
  renderer.autoClear = true;
  return renderer;
}

/** Begins to read a rectangle of a framebuffer, and returns a promise of it, the top row first. */
async function read(gl, framebuffer, x, y, width, height) {
  const bytes = new Uint8Array(4 * width * height);
  const bound = gl.getParameter(gl.FRAMEBUFFER_BINDING);
  const buffer = gl.createBuffer();
  gl.bindFramebuffer(gl.FRAMEBUFFER, framebuffer);
  gl.bindBuffer(gl.PIXEL_PACK_BUFFER, buffer);
  gl.bufferData(gl.PIXEL_PACK_BUFFER, bytes.length, gl.STREAM_READ);
  gl.readPixels(x, y, width, height, gl.RGBA, gl.UNSIGNED_BYTE, 0);
  gl.bindBuffer(gl.PIXEL_PACK_BUFFER, null);
  gl.bindFramebuffer(gl.FRAMEBUFFER, bound);
  const sync = gl.fenceSync(gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
  gl.flush();
  while (gl.getSyncParameter(sync, gl.SYNC_STATUS) !== gl.SIGNALED) await nextTask();
  gl.bindBuffer(gl.PIXEL_PACK_BUFFER, buffer);
  gl.getBufferSubData(gl.PIXEL_PACK_BUFFER, 0, bytes);
  gl.bindBuffer(gl.PIXEL_PACK_BUFFER, null);
  gl.deleteBuffer(buffer);
  const image = new ImageData(width, height);
  for (let row = 0; row < height; row++) image.data.set(bytes.subarray(4 * width * (height - 1 - row), 4 * width * (height - row)), 4 * width * row);
  return image;
}

const nextTask = () => new Promise((done) => { setTimeout(done); });

/** Both eyes on the canvas. */
const halves = (renderer) => {
  const { width, height } = renderer.domElement;
  return Promise.all([0, width / 2].map((x) => read(renderer.getContext(), null, x, 0, width / 2, height)));
};

/** What each eye's picture is like, in dB and SSIM: the rendered eye, the other one, and the same image to both; and the
 * share of pixels whose opacity differs. */
function likeness(ours, truth, rendered) {
  const other = 1 - rendered;
  return {
    own: round(psnr(ours[rendered], truth[rendered])),
    psnr: round(psnr(ours[other], truth[other])), ssim: round(ssim(ours[other], truth[other]), 3),
    same: round(psnr(truth[rendered], truth[other])), opacity: round(opacity(ours[other], truth[other]), 3),
  };
}

function opacity(a, b) {
  let count = 0;
  for (let i = 3; i < a.data.length; i += 4) count += Number(Math.abs(a.data[i] - b.data[i]) > 64);
  return count / (a.data.length / 4);
}

/** A picture of pictures side by side, as base64 of a PNG. */
function png(images) {
  const canvas = document.createElement('canvas');
  canvas.width = images.reduce((sum, { width }) => sum + width, 0);
  canvas.height = images[0].height;
  const pen = canvas.getContext('2d');
  let x = 0;
  for (const image of images) {
    for (let i = 3; i < image.data.length; i += 4) image.data[i] = 255;
    pen.putImageData(image, x, 0);
    x += image.width;
  }
  return canvas.toDataURL('image/png').split(',')[1];
}

function difference(a, b) {
  const image = new ImageData(a.width, a.height);
  image.data.forEach((_, i) => {
    image.data[i] = Math.abs(a.data[i] - b.data[i]) * 4;
  });
  return image;
}

/** Draws, and returns both eyes and the number of draw calls. */
async function drawn(renderer, draw) {
  const { info } = renderer;
  info.autoReset = false;
  info.reset();
  draw();
  const { calls } = info.render;
  info.autoReset = true;
  return { truth: await halves(renderer), calls };
}

/** Three's own two eyes of a frame. */
function truthOf(renderer, scene, camera, stereo) {
  return drawn(renderer, () => {
    const { mode } = stereo;
    stereo.mode = 'rendered';
    stereo.render(scene, camera);
    stereo.mode = mode;
  });
}

/** The uniforms of eyes, given as matrices and viewports. */
function views(cases) {
  return cases.map(({ poses, projections, viewports, rendered, guardBand, reversed }) => {
    const cameras = poses.map((pose, i) => ({
      matrixWorld: new THREE.Matrix4().fromArray(pose), projectionMatrix: new THREE.Matrix4().fromArray(projections[i]),
      viewport: new THREE.Vector4(...viewports[i]),
    }));
    return viewsOf(cameras, rendered, guardBand, reversed, 8192, new THREE.Matrix4());
  });
}

/** Compares a scene on a canvas with three's own `StereoEffect`. */
async function compare({ scene: name, size = 256, pixelRatio = 1, options = {}, renderer: attributes = {}, tweak, picture = false, effect = true, frames = Number(THREE.REVISION) > 170 ? 1 : 8 }) {
  const renderer = rendererOf(2 * size, size, attributes);
  renderer.setPixelRatio(pixelRatio);
  renderer.setSize(2 * size / pixelRatio, size / pixelRatio, false);
  const { scene, camera } = typeof name === 'string' ? await build(name, renderer) : name;
  tweak?.(scene, camera);
  const stereo = new StereoSynthesis(renderer, { mode: 'synthesized', ...options });
  const { truth, calls: callsOwn } = await (effect
    ? drawn(renderer, () => new StereoEffect(renderer).render(scene, camera))
    : truthOf(renderer, scene, camera, stereo));
  for (let i = 0; i < frames; i++) {
    stereo.render(scene, camera);
    await nextTask();
  }
  const { calls } = renderer.info.render;
  const ours = await halves(renderer);
  const rendered = options.dominantEye === 'left' ? 0 : 1;
  const result = { scene: name.scene ? 'own' : name, ...likeness(ours, truth, rendered), calls, callsOwn, trouble: stereo.trouble, way: stereo.way, error: renderer.getContext().getError() };
  if (picture) result.png = png([ours[0], ours[1], truth[1 - rendered], difference(ours[1 - rendered], truth[1 - rendered])]);
  stereo.dispose();
  return result;
}

/** In an emulated session: three's own two eyes, then ours, of the same pose. */
async function session({ scene: name, options = {}, renderer: attributes = {}, tweak, picture = false, hands = false }) {
  const renderer = rendererOf(512, 256, attributes);
  const { xr } = renderer;
  xr.enabled = true;
  xr.setReferenceSpaceType('local');
  const { scene, camera } = build(name, renderer);
  // The scene's camera is the origin of the session's space.
  const rig = new THREE.Group();
  rig.position.copy(camera.position);
  rig.quaternion.copy(camera.quaternion);
  camera.position.set(0, 0, 0);
  camera.quaternion.identity();
  rig.add(camera);
  scene.add(rig);
  headset.position.set(0, 1.6, 0);
  const stereo = new StereoSynthesis(renderer, { mode: 'synthesized', ...options });
  if (hands) addHands(rig, stereo);
  tweak?.(scene, camera, stereo, renderer);
  const state = () => JSON.stringify([xr.enabled, renderer.autoClear, renderer.info.autoReset, renderer.shadowMap.autoUpdate, renderer.getRenderTarget()?.id, scene.children.length, scene.matrixWorldAutoUpdate]);
  const current = await navigator.xr.requestSession('immersive-vr', { optionalFeatures: ['local'] });
  await xr.setSession(current);
  const shots = {}, calls = {}, states = new Set();
  let cameras;
  const ways = ['rendered', 'rendered', 'synthesized', 'synthesized'];
  await new Promise((done, fail) => {
    renderer.setAnimationLoop(() => {
      try {
        const way = ways.shift();
        states.add(state());
        // Three's own two eyes, without us; then ours.
        if (way === 'rendered') renderer.render(scene, camera);
        else stereo.render(scene, camera);
        states.add(state());
        ({ cameras } = xr.getCamera());
        calls[way] = renderer.info.render.calls;
        const framebuffer = globalThis.layerFramebuffer ?? renderer.properties.get(renderer.getRenderTarget()).__webglFramebuffer;
        shots[way] = cameras.map(({ viewport: v }) => read(renderer.getContext(), framebuffer, v.x, v.y, v.z, v.w));
        if (ways.length === 0) done(renderer.setAnimationLoop(null));
      } catch (error) {
        fail(error);
      }
    });
  });
  const [truth, ours] = [await Promise.all(shots.rendered), await Promise.all(shots.synthesized)];
  const rendered = options.dominantEye === 'left' ? 0 : 1;
  const layer = xr.getBaseLayer().constructor.name;
  const gaze = new THREE.Vector3(0, 0, -1).transformDirection(cameras[0].matrixWorld);
  const result = { scene: name, layer, foveation: xr.getFoveation(), ...likeness(ours, truth, rendered), calls: calls.synthesized, callsOwn: calls.rendered, trouble: stereo.trouble, way: stereo.way, states: states.size, error: renderer.getContext().getError(), skew: round(cameras[1].projectionMatrix.elements[8]) };
  if (ours[0].width === ours[0].height) result.centre = psnrOf(ours[1 - rendered], truth[1 - rendered], around(cameras[1 - rendered], 20, gaze, ours[0].width), true);
  if (picture) result.png = png([...ours, ...truth, difference(ours[1 - rendered], truth[1 - rendered])]);
  await current.end();
  // Afterwards, the canvas shows both eyes again.
  renderer.setSize(512, 256, false);
  xr.enabled = true;
  camera.aspect = 2;
  camera.updateProjectionMatrix();
  stereo.render(scene, camera);
  const after = await halves(renderer);
  const { truth: onCanvas } = await truthOf(renderer, scene, camera, stereo);
  result.after = round(psnr(after[1 - rendered], onCanvas[1 - rendered]));
  xr.enabled = false;
  stereo.dispose();
  return result;
}

/** What is near, drawn for both eyes, and what one eye alone sees. */
function addHands(rig, stereo) {
  const hand = new THREE.Mesh(new THREE.TorusKnotGeometry(0.05, 0.02), new THREE.MeshNormalMaterial());
  hand.position.set(0.05, -0.05, -0.3);
  hand.layers.enable(5);
  stereo.bothEyes = 1 << 5;
  rig.add(hand);
  for (const eye of [1, 2]) {
    const mark = new THREE.Mesh(new THREE.BoxGeometry(0.1, 0.1, 0.1), new THREE.MeshBasicMaterial({ color: eye === 1 ? 0xff0000 : 0x0000ff }));
    mark.position.set(-0.4 + 0.3 * eye, 0.35, -1.2);
    mark.layers.set(eye);
    rig.add(mark);
  }
}

/** Controllers as makers of headsets ship them: textured glTF, whose models nobody here has made. */
async function controllers(renderer) {
  const scene = new THREE.Scene();
  scene.background = new THREE.Color(0x8899aa);
  scene.environment = new THREE.PMREMGenerator(renderer).fromScene(new RoomEnvironment(), 0.04).texture;
  const loader = new GLTFLoader();
  const makers = ['meta-quest-touch-plus', 'oculus-touch-v3', 'pico-4', 'hp-mixed-reality'];
  const models = await Promise.all(makers.map((maker) => loader.loadAsync(`/modules/@webxr-input-profiles/assets/dist/profiles/${maker}/left.glb`)));
  models.forEach((model, i) => {
    model.scene.position.set((i - 1.5) * 0.2, -0.02, -0.5 - 0.12 * i);
    model.scene.rotation.set(-0.6, i, 0);
    scene.add(model.scene);
  });
  return { scene, camera: new THREE.PerspectiveCamera(50, 2, 0.05, 100) };
}

/** Wide lines, whose material asks the renderer for its viewport, on a canvas of more pixels than it counts. */
async function lines({ deep = false, ...more } = {}) {
  const scene = new THREE.Scene();
  scene.background = new THREE.Color(0x8899aa);
  const geometry = new LineSegmentsGeometry();
  const points = [];
  for (let i = 0; i < 40; i++) {
    const a = 2.4 * i, z = -1 - 0.1 * i;
    points.push(Math.cos(a) * 1.2, 1.6 + Math.sin(a), z, Math.cos(a + 2) * 1.2, 1.6 + Math.sin(a + 2), z - 0.4);
  }
  geometry.setPositions(points);
  const material = new LineMaterial({ color: 0xcc2200, linewidth: 4, dashed: false });
  const wide = new LineSegments2(geometry, material);
  if (deep) {
    // As code that asks while it is drawn for the pixels of a canvas.
    const size = new THREE.Vector2();
    wide.onBeforeRender = (renderer) => material.resolution.copy(renderer.getDrawingBufferSize(size));
  }
  wide.frustumCulled = false;
  scene.add(wide);
  const camera = new THREE.PerspectiveCamera(70, 2, 0.1, 50);
  camera.position.set(0, 1.6, 0.5);
  return compare({ scene: { scene, camera }, renderer: { antialias: true }, pixelRatio: 2, ...more });
}

/** Squares of many colours, moved to the right by some pixels. */
function squares(shift) {
  const canvas = document.createElement('canvas');
  [canvas.width, canvas.height] = [256, 128];
  const pen = canvas.getContext('2d');
  pen.fillStyle = '#cde';
  pen.fillRect(0, 0, 256, 128);
  for (let i = 0; i < 16; i++) {
    for (let k = 0; k < 8; k++) {
      pen.fillStyle = `hsl(${i * 22} 60% ${60 + 5 * (k % 4)}%)`;
      pen.fillRect(i * 16 + shift, k * 16, 14, 14);
    }
  }
  const map = new THREE.CanvasTexture(canvas);
  map.colorSpace = THREE.SRGBColorSpace;
  return map;
}

/** Spheres around everything, and boxes in front of things, for the left eye alone and for the right one alone. */
function addPanorama(scene) {
  for (const eye of [1, 2]) {
    const sphere = new THREE.Mesh(new THREE.SphereGeometry(15, 40, 20).scale(-1, 1, 1), new THREE.MeshBasicMaterial({ map: squares(3 * eye) }));
    sphere.position.y = 1.6;
    const box = new THREE.Mesh(new THREE.BoxGeometry(0.3, 0.3, 0.3), new THREE.MeshNormalMaterial());
    box.position.set(eye * 0.4 - 0.6, 2, 1.2);
    for (const each of [sphere, box]) {
      each.layers.set(eye);
      scene.add(each);
    }
  }
}

/** What lies behind everything and differs between the eyes: a panorama for each, and a picture that fills the view. */
async function behind() {
  const attributes = { antialias: true };
  const look = (name, tweak, more) => compare({ scene: name, renderer: attributes, tweak, ...more });
  const filled = (scene) => { scene.background = squares(0); };
  return {
    panorama: await look('cubes', (scene) => {
      scene.background = new THREE.Color(0xff0000);
      addPanorama(scene);
    }, { effect: false }),
    // Linear colour until the last pass.
    half: await look('street', addPanorama, { effect: false, renderer: { antialias: true, isHalf: true } }),
    filled: await look('cubes', filled),
  };
}

/** A picture enlarged between the middles of its pixels. */
function enlarged(image, size) {
  const { width, height, data } = image;
  const out = new ImageData(size, size);
  const along = (i, n) => {
    const at = Math.max(0, Math.min(n - 1, (i + 0.5) * n / size - 0.5)), low = Math.min(Math.floor(at), n - 2);
    return [low, at - low];
  };
  for (let row = 0; row < size; row++) {
    const [y, v] = along(row, height);
    for (let column = 0; column < size; column++) {
      const [x, u] = along(column, width);
      for (let c = 0; c < 4; c++) {
        const at = (i, k) => data[4 * ((y + k) * width + x + i) + c];
        out.data[4 * (row * size + column) + c] = (1 - v) * ((1 - u) * at(0, 0) + u * at(1, 0)) + v * ((1 - u) * at(0, 1) + u * at(1, 1));
      }
    }
  }
  return out;
}

/** The rectangle of an eye's picture within an angle of a direction: columns, and rows from the top. */
function around(eye, degrees, gaze, size) {
  const e = eye.projectionMatrix.elements;
  const { x, y, z } = gaze.clone().transformDirection(eye.matrixWorldInverse);
  const reach = Math.tan(degrees * Math.PI / 180);
  const pixel = (tangent, scale, offset) => (scale * tangent - offset + 1) / 2 * size;
  const [left, right] = [-reach, reach].map((more) => pixel(x / -z + more, e[0], e[8]));
  const [down, up] = [-reach, reach].map((more) => pixel(y / -z + more, e[5], e[9]));
  return { left, right, top: size - up, bottom: size - down };
}

/** PSNR of the pixels inside a rectangle, or outside; `margin` pixels beside its border do not count. */
function psnrOf(a, b, { left, right, top, bottom }, isInside, margin = 3) {
  const pick = ({ data, width, height }) => {
    const kept = [];
    for (let row = 0; row < height; row++) {
      for (let column = 0; column < width; column++) {
        const within = Math.min(column - left, right - column, row - top, bottom - row);
        if (isInside ? within > margin : within < -margin) kept.push(...data.subarray(4 * (row * width + column), 4 * (row * width + column) + 4));
      }
    }
    return { data: kept };
  };
  return round(psnr(pick(a), pick(b)));
}

/** A foveated picture: the fovea beside the one without levels, the periphery beside two renders of the same levels. The
 * gaze turns by degrees to the right and up. */
async function levels({ scene: name, foveation = 'medium', size = 256, gazes = [[0, 0]], options = {}, attributes = { antialias: true }, picture = false, tweak }) {
  const [degrees, density] = { low: [30, 1 / 2], medium: [20, 1 / 2], high: [20, 1 / 3] }[foveation];
  const renderer = rendererOf(2 * size, size, attributes);
  const { scene, camera } = build(name, renderer);
  tweak?.(scene, camera);
  const { truth, calls: callsOwn } = await drawn(renderer, () => new StereoEffect(renderer).render(scene, camera));
  const coarseSize = Math.ceil(size * density);
  renderer.setSize(2 * coarseSize, coarseSize, false);
  const coarse = (await drawn(renderer, () => new StereoEffect(renderer).render(scene, camera))).truth.map((image) => enlarged(image, size));
  renderer.setSize(2 * size, size, false);
  const stereo = new StereoSynthesis(renderer, { mode: 'synthesized', ...options });
  const rendered = stereo.dominantEye === 'left' ? 0 : 1, other = 1 - rendered;
  stereo.render(scene, camera);
  stereo.render(scene, camera);
  const full = await halves(renderer), callsFull = renderer.info.render.calls;
  stereo.foveation = foveation;
  // Draw calls of both sources, without what is drawn for each eye.
  const { render } = renderer;
  let sources = 0;
  renderer.render = (what, eye) => {
    const before = renderer.info.render.calls;
    render.call(renderer, what, eye);
    if (what === scene && !eye.isArrayCamera) sources += renderer.info.render.calls - before;
  };
  const results = [];
  for (const [right, up] of gazes) {
    const turn = new THREE.Euler(up * Math.PI / 180, -right * Math.PI / 180, 0, 'YXZ');
    const gaze = new THREE.Vector3(0, 0, -1).applyEuler(turn).transformDirection(camera.matrixWorld);
    stereo.gaze = right === 0 && up === 0 ? null : gaze;
    sources = 0;
    stereo.render(scene, camera);
    const { calls } = renderer.info.render;
    const ours = await halves(renderer);
    const [fovea, ownFovea] = [other, rendered].map((eye) => around(stereo.eyes(camera).cameras[eye], degrees, gaze, size));
    const result = {
      scene: name, way: stereo.way, trouble: stereo.trouble, calls, sources, callsFull, callsOwn,
      fovea: psnrOf(ours[other], truth[other], fovea, true), foveaFull: psnrOf(full[other], truth[other], fovea, true),
      ownFovea: psnrOf(ours[rendered], full[rendered], ownFovea, true),
      periphery: psnrOf(ours[other], coarse[other], fovea, false), ownPeriphery: psnrOf(ours[rendered], coarse[rendered], ownFovea, false),
      peripheryFull: psnrOf(full[other], truth[other], fovea, false), same: psnrOf(coarse[rendered], coarse[other], fovea, false),
      memory: JSON.stringify([renderer.info.memory, renderer.info.programs.length]), error: renderer.getContext().getError(),
    };
    if (picture) result.png = png([...ours, truth[other], coarse[other]]);
    results.push(result);
  }
  renderer.render = render;
  stereo.dispose();
  return results;
}

/** Holes that are filled beside those that are rendered: what the pictures are like, in dB; the share of pixels that differ in
 * percent, and the share of these that are not as in three's own second eye; whether the rendered eye is the same; draw calls. */
async function holes({ scene: name, size = 256, options = {}, attributes = { antialias: true }, tweak, frames = 1, picture = false }) {
  const renderer = rendererOf(2 * size, size, attributes);
  const { scene, camera } = build(name, renderer);
  tweak?.(scene, camera);
  const stereo = new StereoSynthesis(renderer, { mode: 'synthesized', ...options });
  const { truth, calls: callsOwn } = await truthOf(renderer, scene, camera, stereo);
  const other = stereo.dominantEye === 'left' ? 1 : 0;
  const masks = () => {
    const all = [];
    scene.traverse(({ layers }) => all.push(layers.mask));
    return all.join();
  };
  const before = masks();
  const look = async (holes) => {
    stereo.holes = holes;
    for (let i = 0; i < frames; i++) {
      stereo.render(scene, camera);
      await nextTask();
    }
    return [await halves(renderer), renderer.info.render.calls];
  };
  const [filled] = await look('filled'), [rendered, calls] = await look('rendered'), [again, callsFilled] = await look('filled');
  let changed = 0, wrong = 0;
  const [a, b, c] = [filled, rendered, truth].map((eyes) => eyes[other].data);
  const differs = (x, y, i, limit) => [0, 1, 2].some((k) => Math.abs(x[i + k] - y[i + k]) > limit);
  for (let i = 0; i < a.length; i += 4) {
    if (!differs(a, b, i, 0)) continue;
    changed++;
    if (differs(b, c, i, 3)) wrong++;
  }
  const like = (eyes) => round(psnr(eyes[other], truth[other]));
  const result = {
    scene: name, filled: like(filled), rendered: like(rendered), changed: round(400 * changed / a.length), wrong: round(100 * wrong / Math.max(changed, 1)),
    own: psnr(filled[1 - other], rendered[1 - other]), again: psnr(filled[other], again[other]), calls, callsFilled, callsOwn,
    way: stereo.way, trouble: stereo.trouble, restored: masks() === before, error: renderer.getContext().getError(),
  };
  if (picture) result.png = png([filled[other], rendered[other], truth[other], difference(rendered[other], truth[other])]);
  stereo.dispose();
  return result;
}

/** Why three's own stereo is shown, and whether it is shown. */
async function fallbacks() {
  const results = {};
  const look = async (name, attributes, change, of = 'cubes', prepare = () => {}) => {
    const renderer = rendererOf(128, 64, attributes);
    const { scene, camera } = build(of, renderer);
    prepare(scene);
    const stereo = new StereoSynthesis(renderer, { mode: 'synthesized' });
    const { truth } = await truthOf(renderer, scene, camera, stereo);
    const undo = change?.({ renderer, camera, stereo });
    renderer.clear();
    stereo.render(scene, camera);
    const ours = await halves(renderer);
    undo?.();
    results[name] = [stereo.trouble, stereo.way, Math.min(psnr(ours[0], truth[0]), psnr(ours[1], truth[1])) === 99];
    stereo.dispose();
  };
  await look('logarithmic', { logarithmicDepthBuffer: true });
  await look('autoClear', {}, ({ renderer }) => {
    renderer.autoClear = false;
    return () => {
      renderer.autoClear = true;
    };
  });
  await look('lists', {}, ({ renderer }) => {
    const { renderLists } = renderer;
    renderer.renderLists = undefined;
    return () => {
      renderer.renderLists = renderLists;
    };
  });
  await look('transmission', {}, null, 'transmission', addPanorama);
  const renderer = rendererOf(128, 64, {});
  const { scene } = build('cubes', renderer);
  const stereo = new StereoSynthesis(renderer, { mode: 'synthesized' });
  const flat = new THREE.OrthographicCamera(-2, 2, 1, -1, 0.1, 20);
  flat.position.set(0, 1.6, 3);
  stereo.render(scene, flat);
  results.orthographic = [stereo.trouble, stereo.way];
  stereo.dispose();
  return results;
}

/** The level while one is chosen, and before and after, and what the headset is asked for. */
function foveations() {
  let value = 0.5;
  const xr = { getFoveation: () => value, setFoveation(other) { value = other; } }, kept = {};
  const look = (chosen) => [levelName(chosen, xr, kept), value];
  const results = [null, 'low', 'high', null].map(look);
  value = 1;
  return [...results, look('off'), [levelName(null, null, kept), value], look(null)];
}

async function scenes(chosen, more) {
  const results = [];
  for (const scene of chosen ?? names) results.push(await compare({ scene, ...more }));
  return results;
}

/** What frames leave as it was, that nothing grows, and that everything is freed. */
async function state() {
  const renderer = rendererOf(128, 64, {});
  const { scene, camera } = build('glass', renderer);
  const memory = () => ({ ...renderer.info.memory, programs: renderer.info.programs.length });
  renderer.render(scene, camera);
  const settings = () => JSON.stringify([
    renderer.getRenderTarget()?.texture.uuid, renderer.getActiveCubeFace(), renderer.autoClear, renderer.xr.enabled, renderer.info.autoReset, renderer.shadowMap.autoUpdate,
    renderer.toneMapping, renderer.outputColorSpace, scene.background, scene.children.length, scene.matrixWorldAutoUpdate,
    camera.layers.mask, camera.projectionMatrix.elements, renderer.getViewport(new THREE.Vector4()).toArray(),
    renderer.getCurrentViewport(new THREE.Vector4()).toArray(), renderer.getSize(new THREE.Vector2()).toArray(),
  ]);
  const before = settings(), own = await halves(renderer);
  // Materials have programs of their own for targets.
  const target = new THREE.WebGLCubeRenderTarget(128);
  renderer.setRenderTarget(target, 3);
  renderer.render(scene, camera);
  renderer.setRenderTarget(null);
  target.dispose();
  const begin = memory();
  const stereo = new StereoSynthesis(renderer, { samples: 4 });
  const frames = async (count) => {
    for (let i = 0; i < count; i++) {
      stereo.render(scene, camera);
      await nextTask();
    }
    return memory();
  };
  stereo.mode = 'synthesized';
  const few = await frames(3), many = await frames(4);
  renderer.setSize(192, 96, false);
  await frames(1);
  const larger = renderer.info.render.frame > 0 && stereo.way;
  renderer.setSize(128, 64, false);
  const back = await frames(2);
  // On every way out: drawn by three itself, with an error, into a target with a viewport of its own.
  const differing = [];
  const same = (name, was) => {
    if (settings() !== was) differing.push(`${name}: ${settings()}, not ${was}`);
  };
  same('frames', before);
  for (const mode of ['rendered', 'synthesized']) {
    stereo.mode = mode;
    stereo.render(scene, camera);
    same(mode, before);
    const thrower = new THREE.Mesh(new THREE.BoxGeometry(), new THREE.MeshBasicMaterial());
    thrower.frustumCulled = false;
    thrower.onBeforeRender = () => { throw new Error('of the user'); };
    scene.add(thrower);
    const full = settings();
    let thrown = '';
    try {
      stereo.render(scene, camera);
    } catch ({ message }) {
      thrown = message;
    }
    if (thrown !== 'of the user') differing.push(`no error: ${thrown}`);
    same(`${mode}, error`, full);
    scene.remove(thrower);
    thrower.geometry.dispose();
    thrower.material.dispose();
    renderer.setRenderTarget(target, 3);
    renderer.setViewport(0, 0, 100, 60);
    const inTarget = settings();
    stereo.render(scene, camera);
    same(`${mode}, target`, inTarget);
    renderer.setRenderTarget(null);
    renderer.setViewport(0, 0, 128, 64);
    target.dispose();
  }
  stereo.dispose();
  const end = memory();
  renderer.render(scene, camera);
  const again = await halves(renderer);
  return { differing, picture: psnr(own[0], again[0]), begin, few, many, larger, back, end, error: renderer.getContext().getError() };
}

/** The picture after the context was lost and restored. */
async function lost() {
  const renderer = new THREE.WebGLRenderer({ preserveDrawingBuffer: true });
  renderer.setSize(128, 64, false);
  const { scene, camera } = build('cubes', renderer);
  const stereo = new StereoSynthesis(renderer, { mode: 'synthesized' });
  stereo.render(scene, camera);
  const before = await halves(renderer);
  const events = ['webglcontextlost', 'webglcontextrestored'].map((name) => new Promise((done) => { renderer.domElement.addEventListener(name, done); }));
  const { warn, log } = console;
  // Three says that the context is lost and restored.
  console.warn = console.log = () => {};
  const extension = renderer.getContext().getExtension('WEBGL_lose_context');
  extension.loseContext();
  await events[0];
  stereo.render(scene, camera);
  await nextTask();
  extension.restoreContext();
  await events[1];
  await nextTask();
  stereo.render(scene, camera);
  stereo.render(scene, camera);
  const after = await halves(renderer);
  Object.assign(console, { warn, log });
  const result = [0, 1].map((eye) => psnr(before[eye], after[eye]));
  // Three itself complains about objects of the former context if the renderer is disposed of.
  stereo.dispose();
  return result;
}

/** Whether much that is near has both eyes rendered, and less of it has one synthesized again. */
async function near() {
  const renderer = rendererOf(128, 64, {});
  const { scene, camera } = build('cubes', renderer);
  const wall = new THREE.Mesh(new THREE.PlaneGeometry(3, 3), new THREE.MeshBasicMaterial({ color: 0x336699 }));
  camera.add(wall);
  scene.add(camera);
  const stereo = new StereoSynthesis(renderer);
  const until = async (distance, way) => {
    wall.position.z = -distance;
    for (let i = 0; i < 400 && (i === 0 || stereo.way !== way); i++) {
      stereo.render(scene, camera);
      // What is cheaper does not matter here.
      stereo.sceneChanged();
      // No frame begins before the GPU has ended the one before.
      await read(renderer.getContext(), null, 0, 0, 1, 1);
    }
    return stereo.way;
  };
  const result = [await until(2, 'synthesized'), await until(0.25, 'rendered'), await until(2, 'synthesized')];
  stereo.dispose();
  return result;
}

/** Both eyes from an image that an EffectComposer made, beside both eyes through composers of their own. */
async function composed() {
  const size = 256;
  const renderer = rendererOf(2 * size, size, {});
  const { scene, camera } = build('teapots', renderer);
  const stereo = new StereoSynthesis(renderer);
  // Inverts colours, and darkens.
  const effect = { uniforms: { tDiffuse: { value: null } }, vertexShader: 'varying vec2 at; void main() { at = uv; gl_Position = vec4(position.xy, 0.0, 1.0); }', fragmentShader: 'uniform sampler2D tDiffuse; varying vec2 at; void main() { gl_FragColor = vec4(0.8 - 0.7 * texture2D(tDiffuse, at).rgb, 1.0); }' };
  const compose = (eye, width, height) => {
    const target = new THREE.WebGLRenderTarget(width, height, { type: THREE.HalfFloatType, depthTexture: new THREE.DepthTexture(width, height) });
    const composer = new EffectComposer(renderer, target);
    composer.renderToScreen = false;
    for (const pass of [new RenderPass(scene, eye), new ShaderPass(effect)]) composer.addPass(pass);
    composer.render();
    return composer;
  };
  camera.updateMatrixWorld();
  const eyes = stereo.eyes(camera);
  const truth = [];
  for (const eye of eyes.cameras) truth.push(await read(renderer.getContext(), ...framebufferOf(renderer, compose(eye, size, size)), 0, 0, size, size));
  const { camera: seen, width, height } = stereo.view(eyes);
  const composer = compose(seen, width, height);
  const isDrawn = stereo.synthesize({ color: composer.readBuffer.texture, depth: composer.renderTarget2.depthTexture }, eyes);
  const ours = await halves(renderer);
  const result = { isDrawn, ...likeness(ours, truth, 1), error: renderer.getContext().getError(), png: png([...ours, ...truth]) };
  stereo.dispose();
  return result;
}

/** Copies a composer's result into a target of bytes, and returns its framebuffer. */
function framebufferOf(renderer, { readBuffer }) {
  const target = new THREE.WebGLRenderTarget(readBuffer.width, readBuffer.height);
  const plane = new THREE.Mesh(new THREE.PlaneGeometry(2, 2), new THREE.MeshBasicMaterial({ map: readBuffer.texture, toneMapped: false }));
  renderer.setRenderTarget(target);
  renderer.render(plane, new THREE.OrthographicCamera(-1, 1, 1, -1, -1, 1));
  renderer.setRenderTarget(null);
  return [renderer.properties.get(target).__webglFramebuffer];
}

/** The chooser on a device in virtual time: which way it takes, how often it changes, and how often it measures. */
function choose({ gpu, cpu = [1, 1, 1], ways = ['rendered', 'synthesized'], isRanked = false, late = 4, refresh = 60, timed = true, seconds = 10, noise = 0 }) {
  const chooser = createChooser();
  chooser.sceneChanged(ways, isRanked);
  let now = 5000, changes = 0, seed = 7, dear = 0, last = chooser.way, since = now, shortest = Infinity;
  const pending = [];
  const random = () => {
    seed = Math.imul(seed, 1103515245) + 12345 & 0x7fffffff;
    return seed / 0x7fffffff * 2 - 1;
  };
  for (let end = now + 1000 * seconds; now < end;) {
    const { way } = chooser;
    const i = ways.indexOf(way);
    if (way !== last) {
      shortest = Math.min(shortest, now - since);
      [last, since] = [way, now];
    }
    const ms = gpu[i] * (1 + noise * random());
    const busy = Math.max(ms, cpu[i]);
    now += refresh > 0 ? Math.ceil(busy * refresh / 1000) * 1000 / refresh : busy;
    pending.push(ms);
    const before = chooser.choice.way;
    chooser.endFrame(now, refresh, way, timed && pending.length > late ? [late, pending.shift()] : null);
    changes += Number(chooser.choice.way !== before);
    dear += Number(way !== chooser.choice.way);
  }
  return { ...chooser.choice, changes, dear, shortest };
}

/** Frames of all ways without reading anything back: the console must stay silent. */
async function quiet() {
  const renderer = new THREE.WebGLRenderer({ antialias: true });
  renderer.setSize(128, 64, false);
  const { scene, camera } = build('glass', renderer);
  const stereo = new StereoSynthesis(renderer);
  for (const mode of ['auto', 'synthesized', 'rendered']) {
    stereo.mode = mode;
    for (let i = 0; i < 4; i++) {
      stereo.render(scene, camera);
      await new Promise((done) => { requestAnimationFrame(done); });
    }
  }
  stereo.dispose();
  renderer.dispose();
  return renderer.getContext().getError();
}

/** What a render target gets, what is overridden, and what hooks of three's are replaced by. */
async function special() {
  const results = {};
  const look = async (name, more) => {
    results[name] = await compare({ scene: 'garden', size: 128, effect: false, ...more });
  };
  if (Number(THREE.REVISION) > 180) {
    await look('reversed', { renderer: { reversedDepthBuffer: true } });
    await look('half', { renderer: { isHalf: true } });
  }
  await look('stencil and left', { renderer: { stencil: true }, options: { dominantEye: 'left' } });
  await look('overridden', { tweak: (scene) => {
    scene.overrideMaterial = new THREE.MeshNormalMaterial();
    // This material leaves the size of points undefined.
    scene.remove(scene.children.find(({ isPoints }) => isPoints));
  } });
  await look('transparent canvas', { renderer: { alpha: true, antialias: true }, tweak: (scene) => {
    scene.remove(scene.children.find(({ material }) => material?.uniforms?.turbidity));
  } });
  // Without encoded colour in targets of ours, it stays linear until the last pass.
  Object.defineProperty(THREE.WebGLRenderTarget.prototype, 'isXRRenderTarget', { get: () => false, set() {}, configurable: true });
  await look('linear', { frames: 8 });
  delete THREE.WebGLRenderTarget.prototype.isXRRenderTarget;
  return results;
}

globalThis.check = { behind, foveations, holes, levels, controllers, lines, fallbacks, state, lost, near, composed, choose, quiet, special, views, compare, scenes, session, THREE, StereoSynthesis, rendererOf, build, halves, png, psnr, names };
globalThis.ready = true;
