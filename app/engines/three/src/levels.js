// What is rendered at which density: the laws of `yoro::eyes::foveation` of the library, for three's cameras.

import { Matrix4, Vector3 } from 'three';
import { project, tangents, viewsOf } from './views.js';

/** The angle in degrees around the gaze that has all pixels, and pixels along each axis for each of an eye's beyond it. */
const LEVELS = { off: null, low: [30, 1 / 2], medium: [20, 1 / 2], high: [20, 1 / 3] };
const NAMES = Object.keys(LEVELS);
/** From this distance in metres on, the other eye's inset is complete; nearer surfaces leave holes, which show the wide level. */
const NEAREST = 0.5;

/**
 * Returns the level's name: what the user has chosen, or in a session what three asks the headset for. A choice is handed on
 * to the headset, so that whatever draws is foveated alike.
 *
 * @param {string|null} chosen
 * @param {import('three').WebXRManager|null} xr - Null outside of a session.
 */
export function levelName(chosen, xr) {
  if (chosen === null) return NAMES[Math.ceil(3 * (xr?.getFoveation() ?? 0))];
  const i = NAMES.indexOf(chosen);
  if (i < 0) throw new RangeError(`foveation is '${chosen}': set one of ${NAMES.join(', ')}, or null`);
  if (xr && xr.getFoveation() !== i / 3) xr.setFoveation(i / 3);
  return chosen;
}

const clamp = (x, low, high) => Math.max(low, Math.min(x, high));

/**
 * Returns the views of a wide level of few pixels and of an inset of all of them, each as of `viewsOf`, and how the eyes are
 * composed of them; null if all pixels are to be rendered. Sizes do not depend on the gaze.
 *
 * @param {Object[]} cameras - As of `viewsOf`.
 * @param {string} name - The level's.
 * @param {Vector3|null} gaze - Where the eyes look, as a direction in the world; null for straight ahead.
 */
export function levelsOf(cameras, rendered, name, gaze, guardBand, zeroToOne, largest, between) {
  const level = LEVELS[name];
  if (!level) return null;
  const [angle, density] = level;
  const own = cameras[rendered], other = cameras[1 - rendered];
  const { z: width, w: height } = own.viewport;
  const of = cameras.map(({ projectionMatrix }) => tangents(projectionMatrix));
  const s = of[rendered], t = of[1 - rendered];
  const pixel = [(s.right - s.left) / width, (s.up - s.down) / height];
  const { x, y, z } = gaze ? new Vector3().copy(gaze).transformDirection(between.copy(own.matrixWorld).invert()) : { x: 0, y: 0, z: -1 };
  const ahead = Math.max(-z, 1e-3);
  const reach = 2 * Math.tan(angle * Math.PI / 180);
  // Along each axis: the inset's first pixel in the rendered eye, its size, and where it begins in the other eye. It stays
  // within what both eyes see.
  const place = [[x, s.left, t.left, width], [y, s.down, t.down, height]].map(([aside, low, otherLow, pixels], i) => {
    const apart = Math.round((low - otherLow) / pixel[i]);
    const first = Math.max(0, -apart), last = Math.min(pixels, pixels - apart);
    const size = Math.min(Math.ceil(reach / pixel[i]) + 1, last - first);
    const corner = clamp(Math.round((aside / ahead - low) / pixel[i] - size / 2), first, last - size);
    return { size, corner, otherCorner: corner + apart };
  });
  const size = place.map((along) => along.size);
  const down = Math.min(s.down, t.down), up = Math.max(s.up, t.up);
  const wideSize = [width * density, (up - down) / pixel[1] * density].map((n) => Math.max(Math.ceil(n - 1e-3), 1));
  if (Math.min(...size) < 1 || wideSize[0] * wideSize[1] + size[0] * size[1] >= width * height) return null;

  const part = ({ matrixWorld, projectionMatrix }, frustum, viewport) => ({
    matrixWorld, viewport, projectionMatrix: project(new Matrix4().copy(projectionMatrix), frustum),
  });
  const wideEyes = cameras.map((eye, i) => part(eye, { ...of[i], down, up }, { x: 0, y: 0, z: wideSize[0], w: wideSize[1] }));
  const insetEyes = cameras.map((eye, i) => {
    const corner = place.map((along) => (i === rendered ? along.corner : along.otherCorner));
    const [left, low] = [of[i].left, of[i].down].map((n, axis) => n + corner[axis] * pixel[axis]);
    const frustum = { left, right: left + size[0] * pixel[0], down: low, up: low + size[1] * pixel[1] };
    return part(eye, frustum, { x: eye.viewport.x + corner[0], y: eye.viewport.y + corner[1], z: size[0], w: size[1] });
  });
  const wide = viewsOf(wideEyes, rendered, guardBand, zeroToOne, largest, between);
  const inset = viewsOf(insetEyes, rendered, NEAREST, zeroToOne, largest, between);
  if (typeof wide === 'string' || typeof inset === 'string') return null;
  wide.whole = [wideSize[0], wideSize[1] * (s.up - s.down) / (up - down)];
  inset.whole = [width, height];
  // Texture coordinates of the wide level at a pixel, and the inset's corners.
  const composition = (eye, i, shown) => {
    const { viewport: v } = eye;
    const across = shown.right - shown.left, along = shown.up - shown.down;
    const { x: left, y: low } = insetEyes[i].viewport;
    return {
      wide_place: [pixel[0] / across, pixel[1] / along, (of[i].left - shown.left - v.x * pixel[0]) / across, (of[i].down - shown.down - v.y * pixel[1]) / along],
      inset_rect: [left, low, left + size[0], low + size[1]],
      target_origin: [v.x, v.y], target_size: [width, height], wide_scale: Math.abs(wide.uniforms.law[1]),
    };
  };
  inset.own = composition(own, rendered, wide.frustum);
  inset.other = composition(other, 1 - rendered, tangents(wideEyes[1 - rendered].projectionMatrix));
  return [wide, inset];
}
