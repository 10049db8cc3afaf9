// The options of a colour and a depth picture, and how they are guessed.

import { element } from './app.js';

const keys = [
  'source', 'encoding', 'near', 'far', 'metres-at-white', 'disparity-offset', 'disparity-scale', 'gamma', 'fov-y-degrees',
];
/** The fields that only some encodings need. */
const needed = {
  near: ['standard-z', 'reversed-z'], far: ['standard-z', 'reversed-z'], 'metres-at-white': ['metres'],
  'disparity-offset': ['disparity'], 'disparity-scale': ['disparity'], 'fov-y-degrees': ['standard-z', 'reversed-z', 'metres'],
};
/** The largest guessed disparity, as a share of the picture's width. It is comfortable on a screen. */
const DISPARITY = 0.03;
/** The depth of white in metres: 16-bit pictures of depth cameras hold millimetres. */
const METRES_AT_WHITE = 65.535;

/** Returns the options as JSON. */
export function options() {
  const entries = keys.map((key) => {
    const input = element(`picture-${key}`);
    return [key, input.type === 'number' ? input.valueAsNumber : input.value];
  });
  // A hidden field may be empty.
  return JSON.stringify(Object.fromEntries(entries.filter(([, value]) => !Number.isNaN(value))));
}

/** Shows the fields that the encoding needs. */
export function showFields() {
  for (const [key, encodings] of Object.entries(needed)) {
    const input = element(`picture-${key}`);
    input.labels[0].hidden = !encodings.includes(element('picture-encoding').value);
    input.disabled = input.labels[0].hidden;
  }
}

/** Throws a sentence about the first field that is empty or out of range. */
export function checkOptions() {
  const wrong = element('picture-options').querySelector(':invalid:not(:disabled)');
  if (wrong) throw new Error(`${wrong.labels[0].firstChild.textContent.trim()}: ${wrong.validationMessage}`);
}

/** Sets the values of fields. @param {Record<string, string | number>} values */
export function fill(values) {
  for (const [key, value] of Object.entries(values)) element(`picture-${key}`).value = String(value);
  showFields();
}

/** Returns the mean of red in a picture's upper and lower quarter, and the picture's width. */
async function sample(bytes) {
  const bitmap = await createImageBitmap(new Blob([bytes]));
  const side = 32;
  const paint = new OffscreenCanvas(side, side).getContext('2d');
  paint.drawImage(bitmap, 0, 0, side, side);
  const { data } = paint.getImageData(0, 0, side, side);
  const mean = (from, rows) => {
    let sum = 0;
    for (let i = from * side; i < (from + rows) * side; i++) sum += data[4 * i];
    return sum / (rows * side);
  };
  return { width: bitmap.width, top: mean(0, side / 4), bottom: mean((side * 3) / 4, side / 4) };
}

/**
 * Guesses the encoding of a depth picture from its file: EXR holds metres, 16-bit PNG the millimetres of a depth
 * camera. In pictures of 8 bits, the bottom is assumed to be nearer than the top: a brighter bottom means disparity, as
 * estimated by networks for depth.
 * @param {{name: string, bytes: ArrayBuffer}} depth
 * @returns {Promise<Record<string, string | number>>} values for the fields
 */
export async function guess({ name, bytes }) {
  if (/\.exr$/i.test(name)) return { encoding: 'metres' };
  const start = new Uint8Array(bytes, 0, Math.min(bytes.byteLength, 25));
  const bits = start[0] === 0x89 && start.length > 24 ? start[24] : 8;
  if (bits === 16 && !/disp/i.test(name)) return { encoding: 'metres', 'metres-at-white': METRES_AT_WHITE };
  // Browsers do not decode all formats. The module says what is wrong with a damaged file.
  const seen = await sample(bytes).catch(() => null);
  if (!seen || (seen.top >= seen.bottom && !/disp/i.test(name))) return { encoding: 'standard-z' };
  return { encoding: 'disparity', 'disparity-offset': 0, 'disparity-scale': Math.max(1, Math.round(seen.width * DISPARITY)) };
}
