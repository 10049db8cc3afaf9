// What a user's TypeScript says. Only the compiler reads it.

import { PerspectiveCamera, Scene, Vector3, WebGLRenderer, type DepthTexture, type Texture } from 'three';
import { StereoSynthesis, type Choice, type Way } from 'yoro-three';

const renderer = new WebGLRenderer();
const stereo = new StereoSynthesis(renderer, { mode: 'auto', dominantEye: 'left', samples: 4 });
const scene = new Scene(), camera = new PerspectiveCamera();
stereo.bothEyes = 1 << 5;
stereo.foveation = 'medium';
stereo.holes = 'rendered';
stereo.gaze = new Vector3(0, 0, -1);
stereo.stereoCamera.eyeSep = 0.06;
renderer.setAnimationLoop(() => stereo.render(scene, camera));
const way: Way | null = stereo.way;
const { costs, reason }: Choice = stereo.choice;
const undo: () => void = stereo.install();

declare const color: Texture, depth: DepthTexture;
const eyes = stereo.eyes(camera);
const view = stereo.view(eyes);
if (view) renderer.render(scene, view.camera);
const drawn: boolean = stereo.synthesize({ color, depth, samples: 4 }, eyes, null);
console.log(way, costs?.rendered, costs?.filled, reason, drawn, stereo.trouble?.length, undo);

// @ts-expect-error A way that does not exist.
stereo.mode = 'both';
// @ts-expect-error What is read only.
stereo.way = 'rendered';
