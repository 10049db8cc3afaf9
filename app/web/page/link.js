// Settings in the address's fragment: what is as by default is left out.

export const defaults = {
  scene: 'prototype', viewpoint: 0, method: 'yoro', 'anti-aliasing': 'after', ipd: 63, dominant: 'right',
  display: 'side-by-side', scale: 1, at: null,
};

const allowed = {
  'anti-aliasing': ['after', 'before', 'off'],
  dominant: ['right', 'left'],
  display: ['side-by-side', 'cross-eyed', 'anaglyph', 'left', 'right', 'difference', 'flicker'],
  scale: ['1', '0.75', '0.5'],
};

/** The settings of a fragment, and a sentence for each part that is none. `known`: names of scenes and methods. */
export function parse(fragment, known) {
  const settings = { ...defaults };
  const faults = [];
  const lists = { ...allowed, ...known };
  for (const [key, value] of new URLSearchParams(fragment.replace(/^#/, ''))) {
    const number = Number(value);
    if (!(key in defaults)) {
      faults.push(`The link has a setting “${key}” that this page does not know; it was left out.`);
    } else if (key === 'ipd' ? !(value !== '' && number >= 0 && number <= 80) : key === 'viewpoint' && !/^\d{1,3}$/.test(value)) {
      faults.push(`The link's ${key} is “${value}”, which cannot be; it was left out.`);
    } else if (key === 'at') {
      const place = value.split(',').map(Number);
      if (place.length === 5 && place.every(Number.isFinite)) settings.at = place;
      else faults.push('The link’s place cannot be understood; it was left out.');
    } else if (lists[key] && !lists[key].includes(value)) {
      faults.push(`The link's ${key} is “${value}”; choose one of ${lists[key].join(', ')}.`);
    } else {
      settings[key] = typeof defaults[key] === 'number' ? number : value;
    }
  }
  return { settings, faults };
}

/** The fragment of settings. */
export function format(settings) {
  const fields = new URLSearchParams();
  for (const [key, value] of Object.entries(settings)) {
    if (key === 'at' && value) fields.set(key, value.map((n) => +n.toFixed(4)).join(','));
    else if (value !== null && value !== defaults[key]) fields.set(key, value);
  }
  return `#${fields}`.replaceAll('%2C', ',');
}
