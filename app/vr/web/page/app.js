// The state that the parts of the page share.

import { defaults } from './link.js';

/**
 * @typedef {object} Source What is shown: a built-in scene, a model with its files, or a colour and a depth picture.
 * @property {string} [builtin]
 * @property {string} [main]
 * @property {{name: string, bytes: ArrayBuffer}[]} [files]
 * @property {{name: string, bytes: ArrayBuffer}} [color]
 * @property {{name: string, bytes: ArrayBuffer}} [depth]
 * @property {() => string} [options] returns the options of pictures as JSON
 */

/**
 * @typedef {object} Run What draws instead of the loop: a measurement, a viewer or a headset.
 * @property {string} name
 * @property {string} end a sentence that says how the user ends it
 * @property {() => void} stop
 * @property {boolean} [immersive] true if it shows each eye its own image
 */

/**
 * @param {string} id
 * @returns {any} the element; index.html says of which kind it is
 */
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
  /** The source on display. @type {Source | null} */
  source: null,
  /** The source that is being loaded. @type {Source | null} */
  wanted: null,
  /** The state of a stream or a video, once it has begun.
   * @type {{frames: number, there: boolean, losses: number, video?: boolean, ask: () => void, way: string, choose: (way: string) => void, stop: () => void, again: () => void} | null} */
  stream: null,
  /** The module's facts about the scene; null for pictures. */
  facts: null,
  /** The built-in scenes: `{name, title, kiloTriangles}`. */
  scenes: [],
  /** The methods: `{name, reason}`, with a reason if it cannot be used. */
  methods: [],
  /** @type {Run | null} */
  busy: null,
};
