// What the renderer answers while something is drawn: materials ask it for its size, to draw what is measured in pixels.

import { having } from './state.js';

/**
 * Draws both eyes. On a canvas or a target, the viewport is that of the eye which is drawn, as three's `StereoEffect` has it;
 * in a session it is three's own.
 *
 * @param {import('three').WebGLRenderer} renderer
 * @param {() => any} draw
 * @param {import('three').Vector4} [viewport] - The eye's, in pixels, if none is being drawn.
 */
export function asEyes(renderer, draw, viewport) {
  const { xr } = renderer;
  if (xr.enabled && xr.isPresenting) return draw();
  const ratio = renderer.getRenderTarget() ? 1 : renderer.getPixelRatio();
  const getViewport = (to) => (viewport ? to.copy(viewport) : renderer.getCurrentViewport(to)).divideScalar(ratio);
  return having(renderer, { getViewport }, draw);
}

/**
 * Draws a source. Its size and its viewport are to it what they are to the eye.
 *
 * @param {Object} views - From `viewsOf`.
 * @param {import('three').Vector4} eye - The viewport of the eye.
 */
export function asSource(renderer, { size, whole }, eye, draw) {
  const [x, y] = size.map((pixels, i) => pixels / whole[i]);
  const scaled = (name) => {
    const get = renderer[name];
    return (to) => get.call(renderer, to).set(Math.round(to.x * x), Math.round(to.y * y));
  };
  const getViewport = (to) => to.set(0, 0, eye.z * x, eye.w * y);
  return having(renderer, { getViewport, getSize: scaled('getSize'), getDrawingBufferSize: scaled('getDrawingBufferSize') }, draw);
}
