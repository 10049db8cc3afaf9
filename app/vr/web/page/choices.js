// The elements with which users choose settings.

import { keep } from './address.js';
import { app, element } from './app.js';
import { changed } from './drawing.js';
import { clear, say } from './messages.js';
import { explanations } from './methods.js';
import { sentence } from './sentence.js';

/** The settings that have an element of the same name. */
const choices = ['scene', 'viewpoint', 'method', 'msaa', 'holes', 'dominant', 'display', 'scale', 'ipd'];
const numbers = ['viewpoint', 'msaa', 'scale', 'ipd'];
/** The settings that do not apply to pictures. */
const ofScenes = ['viewpoint', 'method', 'msaa', 'holes', 'dominant'];
/** The displays that compare with a real render, which pictures lack. */
const comparing = ['divider', 'difference', 'flicker'];

/** Offers the methods. */
export function offerMethods() {
  element('method').replaceChildren(...app.methods.map(({ name, reason }) => {
    const option = new Option(reason ? `${name} (not here)` : name, name);
    option.disabled = Boolean(reason);
    option.title = reason ?? explanations[name];
    return option;
  }));
}

/** Shows the settings in the elements. */
export function showChoices() {
  const { settings, source, wanted } = app;
  for (const key of choices) element(key).value = String(settings[key]);
  const shown = wanted ?? source;
  element('scene').value = shown ? shown.builtin ?? 'own' : '';
  for (const key of ofScenes) element(key).disabled = Boolean(source?.color);
  for (const option of element('display').options) option.disabled = Boolean(source?.color) && comparing.includes(option.value);
  element('method-note').textContent = explanations[settings.method];
  element('ipd-value').textContent = `${settings.ipd} mm`;
  element('divider').value = String(settings.divider);
  element('error').checked = settings.display === 'difference';
}

/** Passes the settings to the module, and shows them in the elements. */
export function apply() {
  const { settings } = app;
  showChoices();
  if (!app.page) return;
  app.page.configure(JSON.stringify({
    method: settings.method, msaa: settings.msaa, holes: settings.holes, ipd: settings.ipd / 1000,
    dominant: settings.dominant,
    // A viewer and a headset show both eyes, whatever the screen shows.
    display: app.busy?.immersive ? 'side-by-side' : settings.display,
    foveation: app.busy?.name === 'headset' ? element('headset-foveation').value : 'off',
  }));
  keep();
  changed();
}

/**
 * Chooses the next value of a setting, for keys and controllers.
 * @param {'method' | 'viewpoint' | 'display'} what
 */
export function step(what) {
  const options = [...element(what).options].filter((option) => !option.disabled);
  const at = options.findIndex((option) => option.selected);
  const next = options[(at + 1) % options.length];
  if (!next || element(what).matches(':disabled')) return;
  element(what).value = next.value;
  element(what).dispatchEvent(new Event('change'));
}

/** Changes a setting. If the module refuses it, restores the settings and says why. */
function choose(key, value) {
  const before = { ...app.settings };
  if (!app.page) return;
  clear();
  app.settings[key] = value;
  if (key === 'viewpoint') {
    app.settings.at = null;
    app.page.goTo(value);
  }
  try {
    apply();
  } catch (error) {
    app.settings = before;
    apply();
    say(sentence(error));
  }
}

/** Offers to orbit the user's own content. Orbiting starts switched on for an object seen from outside. */
export function offerOrbit() {
  element('orbit').labels[0].hidden = !app.facts || Boolean(app.source?.builtin);
  element('orbit').checked = Boolean(app.facts?.object);
}

/**
 * Listens to the elements.
 * @param {(name: string) => void} showScene shows a built-in scene
 */
export function listenToChoices(showScene) {
  element('scene').addEventListener('change', ({ target }) => {
    clear();
    showScene(target.value);
  });
  for (const key of choices.slice(1)) {
    element(key).addEventListener(key === 'ipd' ? 'input' : 'change', ({ target }) => {
      choose(key, numbers.includes(key) ? Number(target.value) : target.value);
    });
  }
  element('error').addEventListener('change', ({ target }) => choose('display', target.checked ? 'difference' : 'divider'));
  element('divider').addEventListener('change', ({ target }) => {
    app.settings.divider = target.valueAsNumber;
    keep();
  });
  element('orbit').addEventListener('change', ({ target }) => app.page?.orbit(target.checked));
  element('reset').addEventListener('click', () => choose('viewpoint', app.settings.viewpoint));
}
