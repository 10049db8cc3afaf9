// The state that the parts of the page share.

import { defaults } from './link.js';

/**
 * @typedef {object} Run Whoever draws instead of the loop: a measurement, a viewer or a headset.
 * @property {string} name
 * @property {() => void} [stop]
 */

/** @param {string} id */
export const element = (id) => document.getElementById(id);

export const app = {
  canvas: element('canvas'),
  /** @type {WebGL2RenderingContext | null} */
  gl: null,
  /** The module's [Page]; null while the context is lost. */
  page: null,
  /** @type {WebAssembly.Module | null} */
  module: null,
  settings: { ...defaults },
  /** The source on display: `{builtin}`, `{main, files}` or `{color, depth, options}`. */
  source: null,
  /** The module's facts about the scene; null for pictures. */
  facts: null,
  /** The built-in scenes: `{name, title, kiloTriangles}`. */
  scenes: [],
  /** The methods of each renderer: `{name, reason}`, with the reason where it cannot be used. */
  methods: {},
  /** @type {Run | null} */
  busy: null,
};
