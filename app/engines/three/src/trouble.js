// What synthesis cannot deal with.

/**
 * Returns what about the renderer it is, in a sentence, or null.
 *
 * @param {import('three').WebGLRenderer} renderer
 * @param {import('three').Camera[]} cameras - The eyes'.
 * @param {boolean} isPresenting - True in a session.
 * @param {boolean} isLinear - True if colour stays linear until the last pass.
 * @return {string|null}
 */
export function troubleOf({ capabilities, xr, autoClear, renderLists, getContext }, cameras, isPresenting, isLinear) {
  const isReversed = capabilities.reversedDepthBuffer;
  if (cameras.length !== 2) return `there are ${cameras.length} eyes, not two`;
  if (capabilities.logarithmicDepthBuffer) return 'the depth buffer is logarithmic: create the renderer without logarithmicDepthBuffer';
  if (!renderLists?.get) return 'this version of three has no lists of what it draws';
  if (isReversed && isPresenting) return 'three has no reversed depth in headsets: create the renderer without reversedDepthBuffer';
  if (isReversed && !cameras[0].reversedDepth) return 'this version of three does not tell that depth is reversed';
  if (isPresenting && xr.hasDepthSensing?.()) return 'the session hides the scene behind real things: depth sensing';
  if (!autoClear) return 'the picture is not cleared before it is drawn: renderer.autoClear is false';
  const has = (extension) => getContext().getExtension(extension) !== null;
  if (isLinear && !has('EXT_color_buffer_float') && !has('EXT_color_buffer_half_float')) return 'this GPU cannot render to half floats, which linear colour needs';
  return null;
}
