// The settings in the page's address.

import { app } from './app.js';
import { format, parse } from './link.js';
import { say } from './messages.js';

let keeping = 0;

/** Writes the settings into the address, soon. */
export function keep() {
  clearTimeout(keeping);
  keeping = setTimeout(keepNow, 300);
}

/** Writes the settings into the address. */
export function keepNow() {
  history.replaceState(null, '', format(app.settings));
}

/** Writes the settings and the head's place into the address after a short delay. */
export function keepPlace() {
  app.settings.at = app.page.place ? Array.from(app.page.place) : null;
  keep();
}

/** Takes the settings from the address, and shows a message about its faults. */
export function readAddress() {
  const here = (list) => list.filter(({ reason }) => !reason).map(({ name }) => name);
  const { settings, faults } = parse(location.hash, {
    scenes: here(app.scenes),
    methods: Object.fromEntries(Object.entries(app.methods).map(([renderer, list]) => [renderer, here(list)])),
  });
  app.settings = settings;
  if (faults.length) say(faults.join(' '));
}

/** Goes to the viewpoint of the settings, or to the place. */
export function goThere() {
  app.page.goTo(app.settings.viewpoint);
  if (app.settings.at) app.page.putAt(new Float32Array(app.settings.at));
}
