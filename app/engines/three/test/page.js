// What the tests call in a browser, as `check`.

import * as THREE from 'three';
import { StereoEffect } from 'three/addons/effects/StereoEffect.js';
import { StereoSynthesis } from 'yoro-three';
import { build, cameraOf, names } from '../examples/scenes.js';
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

/** What each eye's picture is like, in dB and SSIM: the rendered eye, the other one, and the same image to both. */
function likeness(ours, truth, rendered) {
  const other = 1 - rendered;
  return {
    own: round(psnr(ours[rendered], truth[rendered])),
    psnr: round(psnr(ours[other], truth[other])), ssim: round(ssim(ours[other], truth[other]), 3),
    same: round(psnr(truth[rendered], truth[other])),
  };
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

/** Three's own two eyes of a frame. */
async function truthOf(renderer, scene, camera, stereo) {
  const { info } = renderer;
  stereo.mode = 'rendered';
  info.autoReset = false;
  info.reset();
  stereo.render(scene, camera);
  const { calls } = info.render;
  info.autoReset = true;
  stereo.mode = 'synthesized';
  return { truth: await halves(renderer), calls };
}

/** The uniforms of eyes, given as matrices and viewports. */
function views(cases) {
  return cases.map(({ poses, projections, viewports, rendered, guardBand, reversed }) => {
    const cameras = poses.map((pose, i) => ({
      matrixWorld: new THREE.Matrix4().fromArray(pose), projectionMatrix: new THREE.Matrix4().fromArray(projections[i]),
      viewport: new THREE.Vector4(...viewports[i]),
    }));
    return viewsOf(cameras, rendered, guardBand, reversed, new THREE.Matrix4());
  });
}

/** Compares a scene on a canvas with three's own `StereoEffect`. */
async function compare({ scene: name, size = 256, options = {}, renderer: attributes = {}, tweak, picture = false, effect = true, frames = 2 }) {
  const renderer = rendererOf(2 * size, size, attributes);
  const { scene, camera } = typeof name === 'string' ? await build(name, renderer) : name;
  tweak?.(scene, camera);
  const stereo = new StereoSynthesis(renderer, { mode: 'synthesized', ...options });
  const { truth: own, calls: callsOwn } = await truthOf(renderer, scene, camera, stereo);
  let truth = own;
  if (effect) {
    new StereoEffect(renderer).render(scene, camera);
    truth = await halves(renderer);
  }
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
  const result = { scene: name, layer, ...likeness(ours, truth, rendered), calls: calls.synthesized, callsOwn: calls.rendered, trouble: stereo.trouble, way: stereo.way, states: states.size, error: renderer.getContext().getError(), skew: round(cameras[1].projectionMatrix.elements[8]) };
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

async function scenes(chosen, more) {
  const results = [];
  for (const scene of chosen ?? names) results.push(await compare({ scene, ...more }));
  return results;
}

globalThis.check = { views, compare, scenes, session, THREE, StereoSynthesis, rendererOf, build, cameraOf, halves, png, psnr, names };
globalThis.ready = true;
