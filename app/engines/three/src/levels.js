// What is rendered at which density: the laws of `yoro::eyes::foveation` of the library, for three's cameras.

import * as THREE from 'three';
import { project, tangents, viewsOf } from './views.js';

/** The angle in degrees around the gaze that has all pixels, and pixels along each axis for each of an eye's beyond it. */
const LEVELS = { off: null, low: [30, 1 / 2], medium: [20, 1 / 2], high: [20, 1 / 3] };
const NAMES = Object.keys(LEVELS);
/** From this distance in metres on, the other eye's inset is complete; nearer surfaces leave holes, which show the wide level. */
const NEAREST = 0.5;

/**
 * Returns the level's name: what the user has chosen, or in a session what three asks the headset for. A choice is handed on
 * to the headset, so that whatever draws is foveated alike, until there is none.
 *
 * @param {string|null} chosen
 * @param {import('three').WebXRManager|null} xr - Null outside of a session.
 * @param {{ours?: number, users?: number}} kept - What was handed on, and what three asked for without it.
 */
export function levelName(chosen, xr, kept) {
  if (xr && xr.getFoveation() !== kept.ours) kept.users = xr.getFoveation();
  const level = chosen === null ? (xr && kept.users) ?? 0 : NAMES.indexOf(chosen) / 3;
  if (level < 0) throw new RangeError(`foveation is '${chosen}': set one of ${NAMES.join(', ')}, or null`);
  if (xr && xr.getFoveation() !== level) xr.setFoveation(level);
  if (xr) kept.ours = level;
  return NAMES[Math.ceil(3 * level)];
}

/** Pixels of the wide level that show beside the inset's border. */
const BORDER = 3;
/**
 * Returns the views of a wide level of few pixels and of an inset of all of them, each as of `viewsOf`, and how the eyes are
 * composed of them; null if all pixels are to be rendered. Sizes do not depend on the gaze.
 *
 * @param {Object[]} cameras - As of `viewsOf`.
 * @param {string} name - The level's.
 * @param {THREE.Vector3|null} gaze - Where the eyes look, as a direction in the world; null for straight ahead.
 */
export function levelsOf(cameras, rendered, name, gaze, guardBand, zeroToOne, largest, between) {
  const level = LEVELS[name];
  if (!level) return null;
  const [angle, density] = level;
  const own = cameras[rendered], eyes = [0, 1], axes = [0, 1];
  const shown = [own.viewport.z, own.viewport.w];
  const frusta = cameras.map(({ projectionMatrix }) => tangents(projectionMatrix));
  const lows = frusta.map((frustum) => frustum.map(([low]) => low));
  const pixel = frusta[rendered].map(([low, high], i) => (high - low) / shown[i]);
  const toEye = new THREE.Matrix4().copy(own.matrixWorld).invert();
  const { x, y, z } = gaze ? new THREE.Vector3().copy(gaze).transformDirection(toEye) : { x: 0, y: 0, z: -1 };
  // The inset's corners in both eyes. It stays within what both see.
  const corners = [[], []];
  const size = [x, y].map((aside, i) => {
    const low = lows[rendered][i];
    const apart = Math.round((low - lows[1 - rendered][i]) / pixel[i]);
    const first = Math.max(0, -apart), last = Math.min(shown[i], shown[i] - apart);
    const length = Math.min(Math.ceil(2 * Math.tan(angle * Math.PI / 180) / pixel[i]) + 1, last - first);
    const middle = (aside / Math.max(-z, 1e-3) - low) / pixel[i];
    const corner = Math.max(first, Math.min(Math.round(middle - length / 2), last - length));
    corners[rendered][i] = corner;
    corners[1 - rendered][i] = corner + apart;
    return length;
  });
  // The rows of both eyes' wide levels are the same.
  const rows = [Math.min(lows[0][1], lows[1][1]), Math.max(frusta[0][1][1], frusta[1][1][1])];
  const wideFrusta = frusta.map(([across]) => [across, rows]);
  const wideSize = wideFrusta[rendered].map(([low, high], i) => Math.max(Math.ceil((high - low) / pixel[i] * density - 1e-3), 1));
  if (Math.min(...size) < 1 || wideSize[0] * wideSize[1] + size[0] * size[1] >= shown[0] * shown[1]) return null;

  const part = (eye, frustum, x, y, [z, w]) => ({
    matrixWorld: cameras[eye].matrixWorld, viewport: { x, y, z, w }, projectionMatrix: project(new THREE.Matrix4().copy(cameras[eye].projectionMatrix), frustum),
  });
  const insets = eyes.map((eye) => axes.map((i) => [0, size[i]].map((more) => lows[eye][i] + (corners[eye][i] + more) * pixel[i])));
  const wide = viewsOf(eyes.map((eye) => part(eye, wideFrusta[eye], 0, 0, wideSize)), rendered, guardBand, zeroToOne, largest, between);
  const places = eyes.map((eye) => ['x', 'y'].map((axis, i) => cameras[eye].viewport[axis] + corners[eye][i]));
  const inset = viewsOf(eyes.map((eye) => part(eye, insets[eye], ...places[eye], size)), rendered, NEAREST, zeroToOne, largest, between);
  if (typeof wide === 'string' || typeof inset === 'string') return null;
  // Pixels of the level that the eye's image would have.
  wide.whole = frusta[rendered].map(([low, high], i) => wideSize[i] * (high - low) / (wideFrusta[rendered][i][1] - wideFrusta[rendered][i][0]));
  inset.whole = shown;
  // Texture coordinates of the wide level at a pixel, the inset's corners, and the eye's place.
  inset.eyes = eyes.map((eye) => {
    const image = eye === rendered ? wide.frustum : wideFrusta[eye];
    const { x: left, y: low } = cameras[eye].viewport;
    const scale = axes.map((i) => pixel[i] / (image[i][1] - image[i][0]));
    return {
      wide_place: [...scale, ...[left, low].map((corner, i) => scale[i] * ((lows[eye][i] - image[i][0]) / pixel[i] - corner))],
      inset_rect: [...places[eye], ...places[eye].map((corner, i) => corner + size[i])],
      target_origin: [left, low], target_size: shown, wide_scale: Math.abs(wide.uniforms.law[1]),
    };
  });
  // What lies within the inset in both eyes, and some pixels from its border, is not seen in the wide level.
  const apart = Math.abs(between.elements[12]), sphere = new THREE.Sphere();
  wide.hides = (object) => {
    const bounds = object.boundingSphere ?? object.geometry?.boundingSphere;
    if (!object.isMesh || !object.frustumCulled || !bounds) return false;
    const { center, radius } = sphere.copy(bounds).applyMatrix4(object.matrixWorld);
    const at = center.applyMatrix4(toEye).toArray();
    return insets[rendered].every((sides, i) => sides.every((tangent, k) => (
      (at[i] + at[2] * tangent) * (1 - 2 * k) + at[2] * BORDER * pixel[i] / density > (radius + apart) * Math.hypot(1, tangent)
    )));
  };
  return [wide, inset];
}
