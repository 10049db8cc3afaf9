// The elements with which people choose settings.

import { keep } from './address.js';
import { app, element } from './app.js';
import { changed } from './drawing.js';
import { antiAliasing } from './link.js';
import { clear, say } from './messages.js';
import { sentence } from './sentence.js';

/** The settings that have an element of their name. */
const choices = [
  'scene', 'viewpoint', 'method', 'renderer', 'anti-aliasing', 'dominant', 'display', 'scale', 'ipd',
];
const numbers = ['viewpoint', 'scale', 'ipd'];
let offered = null;

/** Offers the methods and the anti-aliasing of a renderer. */
function offerRenderer(renderer) {
  offered = renderer;
  element('method').replaceChildren(...app.methods[renderer].map(({ name, reason }) => {
    const option = new Option(reason ? `${name} (not here)` : name, name);
    option.disabled = Boolean(reason);
    option.title = reason ?? '';
    return option;
  }));
  for (const option of element('anti-aliasing').options) option.disabled = !antiAliasing[renderer].includes(option.value);
}

/** Gives the module the settings, and the elements their values. */
export function apply() {
  const { settings } = app;
  if (offered !== settings.renderer) offerRenderer(settings.renderer);
  for (const key of choices) element(key).value = String(settings[key]);
  element('ipd-value').textContent = settings.ipd;
  if (!app.page) return;
  const smoothing = settings['anti-aliasing'];
  app.page.configure(JSON.stringify({
    method: settings.method, renderer: settings.renderer, ipd: settings.ipd / 1000, dominant: settings.dominant,
    display: settings.display,
    ...(smoothing === 'msaa' ? { msaa: 4 } : { 'anti-aliasing': smoothing, msaa: 1 }),
  }));
  keep();
  changed();
}

/**
 * Chooses the next method or viewpoint, for controllers.
 * @param {'method' | 'viewpoint'} what
 */
export function step(what) {
  const options = [...element(what).options].filter((option) => !option.disabled);
  const at = options.findIndex((option) => option.selected);
  const next = options[(at + 1) % options.length];
  if (!next) return;
  element(what).value = next.value;
  element(what).dispatchEvent(new Event('change'));
}

/**
 * Listens to the elements.
 * @param {(name: string) => void} showScene shows a built-in scene
 */
export function listenToChoices(showScene) {
  for (const key of choices) {
    element(key).addEventListener(key === 'ipd' ? 'input' : 'change', ({ target }) => {
      const before = { ...app.settings };
      const value = numbers.includes(key) ? Number(target.value) : target.value;
      if (!app.page) return;
      clear();
      if (key === 'scene') {
        showScene(value);
        return;
      }
      app.settings[key] = value;
      if (key === 'renderer') [app.settings['anti-aliasing']] = antiAliasing[value];
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
    });
  }
}
