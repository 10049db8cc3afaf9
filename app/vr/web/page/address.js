// The settings in the page's address.

import { app } from './app.js';
import { format, parse } from './link.js';
import { say, sayAlso } from './messages.js';

let keeping = 0;

/** Writes the settings into the address after a short delay. */
export function keep() {
  clearTimeout(keeping);
  keeping = setTimeout(keepNow, 300);
}

/** Writes the settings into the address. */
export function keepNow() {
  clearTimeout(keeping);
  history.replaceState(null, '', format(app.settings));
}

/** Writes the settings and the head's place into the address after a short delay. */
export function keepPlace() {
  app.settings.at = app.page?.place ? Array.from(app.page.place) : null;
  keep();
}

/** Reads the settings from the address or from the fragment of another link, and shows a message about its faults. */
export function readAddress(link = location.hash) {
  const here = (list) => list.filter(({ reason }) => !reason).map(({ name }) => name);
  const { settings, faults } = parse(link, { scenes: here(app.scenes), methods: here(app.methods) });
  app.settings = settings;
  if (faults.length) say(faults.join(' '));
}

/** Goes to the place in the settings, or else to their viewpoint. */
export function goThere() {
  const { settings } = app;
  const last = (app.facts?.viewpoints ?? 1) - 1;
  if (settings.viewpoint > last) {
    sayAlso(`The link's viewpoint is ${settings.viewpoint + 1}; this scene has ${last + 1}.`);
    settings.viewpoint = last;
  }
  app.page.goTo(settings.viewpoint);
  if (settings.at) app.page.putAt(new Float32Array(settings.at));
}
