// The settings in the address's fragment. Settings with their default value are left out.

/** The defaults. Those of method, samples, holes, IPD and dominant eye are the module's. */
export const defaults = {
  scene: 'prototype', viewpoint: 0, method: '', msaa: 0, holes: '', ipd: 0,
  dominant: '', display: 'divider', divider: 50, scale: 1, at: null, stream: null,
};

const allowed = {
  msaa: ['4', '1'],
  holes: ['filled', 'rendered'],
  dominant: ['right', 'left'],
  display: ['divider', 'difference', 'side-by-side', 'cross-eyed', 'anaglyph', 'left', 'right', 'flicker'],
  scale: ['1', '0.75', '0.5'],
};

/** The largest values of numbers; the smallest is 0. That of the IPD is the module's. */
export const most = { ipd: 0, divider: 100 };

/** Takes the module's defaults and bounds, as JSON. @param {string} json */
export function learn(json) {
  const { maxIpd, ...choices } = JSON.parse(json);
  Object.assign(defaults, choices);
  most.ipd = maxIpd;
}

/** The largest coordinate of the head in metres, which is the module's limit. */
const FARTHEST = 1e6;

/** Parses a number. Returns NaN for any other text, and for the empty one. */
const number = (text) => (/^[-+]?\d+(\.\d*)?(e[-+]?\d+)?$/i.test(text) ? Number(text) : NaN);

/** Returns a place, or null. @param {string} text */
function place(text) {
  const numbers = text.split(',').map(number);
  return numbers.length === 5 && numbers.every((n) => Math.abs(n) < FARTHEST) ? numbers : null;
}

/** Returns the settings of a fragment, and a sentence for each invalid part. `known`: the names of scenes and
 * of methods. */
export function parse(fragment, known) {
  const fields = new URLSearchParams(fragment.replace(/^#/, ''));
  const settings = { ...defaults };
  const faults = [];
  const lists = { ...allowed, scene: known.scenes, method: known.methods };
  for (const [key, value] of fields) {
    if (!Object.hasOwn(defaults, key)) {
      faults.push(`The link has a setting “${key}” that this page does not know; it was left out.`);
    } else if (Object.hasOwn(most, key) ? !(number(value) >= 0 && number(value) <= most[key]) : key === 'viewpoint' && !/^\d{1,3}$/.test(value)) {
      faults.push(`The link's ${key} is “${value}”, which cannot be; it was left out.`);
    } else if (key === 'at') {
      settings.at = place(value);
      if (!settings.at) faults.push(`The link's place is “${value}”, which cannot be; it was left out.`);
    } else if (lists[key] && !lists[key].includes(value)) {
      faults.push(`The link's ${key} is “${value}”; choose one of ${lists[key].join(', ')}.`);
    } else {
      settings[key] = typeof defaults[key] === 'number' ? Number(value) : value;
    }
  }
  return { settings, faults };
}

/** Returns the fragment of settings. Without a built-in scene, it has no place either. */
export function format(settings) {
  const fields = new URLSearchParams();
  for (const [key, value] of Object.entries(settings)) {
    if (!settings.scene && ['viewpoint', 'at'].includes(key)) continue;
    if (key === 'at' && value) fields.set(key, value.map((n) => +n.toFixed(4)).join(','));
    else if (value !== null && value !== defaults[key]) fields.set(key, value);
  }
  return `#${fields}`.replaceAll('%2C', ',');
}
