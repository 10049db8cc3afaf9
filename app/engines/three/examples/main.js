// A walk through ten scenes, on a canvas or in a headset, with three's own stereo for comparison.

import * as THREE from 'three';
import { VRButton } from 'three/addons/webxr/VRButton.js';
import { StereoSynthesis } from 'yoro-three';
import { build, names } from './scenes.js';

const $ = (id) => document.getElementById(id);
const renderer = new THREE.WebGLRenderer({ canvas: $('canvas'), antialias: true });
renderer.xr.enabled = true;
const stereo = new StereoSynthesis(renderer);
/** The head's place: what a headset moves, moves in it. */
const rig = new THREE.Group();
const before = new THREE.Quaternion();
let scene, camera;

function show(name) {
  ({ scene, camera } = build(name, renderer));
  rig.clear();
  rig.position.copy(camera.position);
  before.copy(camera.quaternion);
  rig.quaternion.setFromEuler(new THREE.Euler(0, new THREE.Euler().setFromQuaternion(before, 'YXZ').y, 0));
  // A headset's origin is the head where the session began.
  camera.position.set(0, 0, 0);
  camera.quaternion.copy(rig.quaternion).invert().multiply(before);
  rig.add(camera);
  scene.add(rig);
  stereo.sceneChanged();
  resize();
}

function resize() {
  if (renderer.xr.isPresenting) return;
  renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
  renderer.setSize(innerWidth, innerHeight, false);
  camera.aspect = innerWidth / innerHeight;
  camera.updateProjectionMatrix();
}

/** Times of the last frames in milliseconds: between frames, and of the page's thread. */
const times = { frame: [], script: [] };
let last = 0;
const middle = (values) => values.slice().sort((a, b) => a - b)[values.length >> 1] ?? 0;

function tell() {
  const { calls, triangles } = renderer.info.render;
  const { reason, costs } = stereo.choice;
  const of = costs ? `: ${costs.rendered.toFixed(1)} ms for two renders, ${costs.synthesized.toFixed(1)} ms with synthesis` : '';
  $('figures').textContent = [
    stereo.way === 'synthesized' ? 'one eye rendered, the other synthesized' : 'both eyes rendered',
    `${calls} draw calls, ${(triangles / 1000).toFixed(0)} k triangles`,
    `${middle(times.frame).toFixed(1)} ms between frames, ${middle(times.script).toFixed(1)} ms of the page’s thread`,
    stereo.trouble ?? (stereo.mode === 'auto' ? `${reason}${of}` : ''),
  ].join('\n');
}

function frame(now) {
  const start = performance.now();
  if (!renderer.xr.isPresenting) rig.rotation.y += 0.0005 * Math.cos(now / 3000);
  stereo.render(scene, camera);
  for (const [list, time] of [[times.frame, now - last], [times.script, performance.now() - start]]) {
    list.push(time);
    if (list.length > 60) list.shift();
  }
  if (Math.floor(now / 500) !== Math.floor(last / 500)) tell();
  last = now;
}

for (const name of names) $('scene').append(new Option(name));
$('scene').value = 'teapots';
$('scene').addEventListener('change', ({ target }) => show(target.value));
$('mode').addEventListener('change', ({ target }) => { stereo.mode = target.value; });
$('eye').addEventListener('change', ({ target }) => { stereo.dominantEye = target.value; });
$('foveation').addEventListener('change', ({ target }) => { stereo.foveation = target.value || null; });
addEventListener('resize', resize);
renderer.xr.addEventListener('sessionend', resize);
renderer.xr.setReferenceSpaceType('local');
document.body.append(VRButton.createButton(renderer));
show('teapots');
renderer.setAnimationLoop(frame);
globalThis.example = { renderer, stereo };
