// Settings in the address's fragment, without those that have their default.

export const defaults = {
  scene: 'prototype', viewpoint: 0, method: 'yoro', renderer: 'deferred', 'anti-aliasing': 'after', ipd: 63,
  dominant: 'right', display: 'side-by-side', scale: 1, at: null,
};

/** The anti-aliasing that each renderer has, its default first. */
export const antiAliasing = {
  deferred: ['after', 'before', 'off'],
  forward: ['msaa', 'after', 'before', 'off'],
};

const allowed = {
  renderer: Object.keys(antiAliasing),
  dominant: ['right', 'left'],
  display: ['side-by-side', 'cross-eyed', 'anaglyph', 'left', 'right', 'difference', 'flicker'],
  scale: ['1', '0.75', '0.5'],
};

/** Returns the settings of a fragment, and a sentence for each invalid part. `known`: the names of scenes, and of the
 * methods of each renderer. */
export function parse(fragment, known) {
  const fields = new URLSearchParams(fragment.replace(/^#/, ''));
  const renderer = allowed.renderer.find((name) => name === fields.get('renderer')) ?? defaults.renderer;
  const settings = { ...defaults, 'anti-aliasing': antiAliasing[renderer][0] };
  const faults = [];
  const lists = {
    ...allowed, 'anti-aliasing': antiAliasing[renderer], scene: known.scenes, method: known.methods[renderer],
  };
  for (const [key, value] of fields) {
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
  const usual = { ...defaults, 'anti-aliasing': antiAliasing[settings.renderer][0] };
  for (const [key, value] of Object.entries(settings)) {
    if (key === 'at' && value) fields.set(key, value.map((n) => +n.toFixed(4)).join(','));
    else if (value !== null && value !== usual[key]) fields.set(key, value);
  }
  return `#${fields}`.replaceAll('%2C', ',');
}
