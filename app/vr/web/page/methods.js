// The methods in words.

import { app } from './app.js';

/** A sentence for each method. */
export const explanations = {
  auto: 'Two renders and yoro take turns here for a second; the cheaper one goes on. The divider compares both.',
  conventional: 'Renders both eyes, one after the other: the baseline of every comparison.',
  instanced: 'Renders both eyes in one set of draw calls: less work for the processor, as many pixels.',
  multiview: 'Renders both eyes in one set of draw calls, by the GPU’s own extension: less work for the processor, as many pixels.',
  hybrid: 'Renders what is near for both eyes, and what is far once.',
  'shading-reprojection': 'Draws the geometry of both eyes, and lights of the second only what the first does not see.',
  mono: 'Shows the picture of one eye to both, without depth: nothing is cheaper.',
  yoro: 'Renders one eye, and synthesizes the other from its colour and depth.',
};

/** Returns the method in use. For `auto`, adds the reason as in the viewer's log line: `auto:yoro 6.1/8.9ms`. */
export function inUse() {
  const { methodInUse, reason } = app.page;
  return reason ? `auto:${methodInUse} ${reason}` : methodInUse;
}

/** How each method makes the eye that it does not simply render. */
const other = {
  hybrid: 'near rendered, far copied', 'shading-reprojection': 'shading copied', mono: 'a copy', yoro: 'synthesized',
};

/**
 * Returns how an eye is made, in a word or two.
 * @param {string} method
 * @param {boolean} dominant
 */
export function making(method, dominant) {
  return (!dominant && other[method]) || 'rendered';
}
