// The sources that the page shows: built-in scenes, models and pictures.

import { goThere } from './address.js';
import { app, element } from './app.js';
import { apply, offerOrbit, showChoices } from './choices.js';
import { changed, startLoop } from './drawing.js';
import { loading, say, sayAlso } from './messages.js';
import { sentence } from './sentence.js';

/** Cancels the work on `app.wanted`: ends the worker, and resolves its promise with null. */
let cancel = () => {};

/**
 * Loads and shows a source, from its first viewpoint. What was shown before stays until then.
 * @param {import('./app.js').Source} source
 * @param {{keepPlace?: boolean}} options true to go to the settings' viewpoint and place, not to the first viewpoint
 */
export async function showSource(source, { keepPlace = false } = {}) {
  cancel();
  app.wanted = source;
  showChoices();
  if (source.color) showPictures(source);
  else await showScene(source, keepPlace);
}

/** After a lost context, shows the source again that was shown or was being loaded. */
export function showAgain() {
  const source = app.wanted ?? app.source;
  if (source) showSource(source, { keepPlace: true });
}

/** Gives up loading. What was shown stays. */
export function stopLoading() {
  cancel();
  end();
}

/** Ends loading, with or without success. */
function end() {
  app.wanted = null;
  loading(null);
  if (app.source) app.stream?.stop();
  describe();
  try {
    apply();
  } catch (error) {
    say(sentence(error));
  }
}

function showPictures(source) {
  loading('Decoding');
  try {
    app.page.setPictures(
      source.color.name, new Uint8Array(source.color.bytes), source.depth.name, new Uint8Array(source.depth.bytes),
      source.options());
    Object.assign(app, { source, facts: null });
    app.settings.scene = null;
  } catch (error) {
    say(sentence(error));
  }
  end();
  changed();
}

/** Returns a packed scene and its warnings, or an error, or null if the work was cancelled. */
async function load(source, doing) {
  const worker = new Worker(new URL('worker.js', import.meta.url), { type: 'module' });
  const answer = await new Promise((resolve) => {
    cancel = () => resolve(null);
    worker.onmessage = ({ data }) => {
      if (data.bytes || data.error) resolve(data);
      else generating(doing, source.builtin, data);
    };
    worker.onerror = (event) => resolve({
      error: `The scene could not be made (${event.message ?? 'the worker did not start'}): reload the page, perhaps it has a new version.`,
    });
    worker.postMessage({ ...source, module: app.module });
  });
  worker.terminate();
  return answer;
}

async function showScene(source, keepPlace) {
  const doing = source.builtin ? `Generating ${source.builtin}` : `Loading ${source.main}`;
  loading(doing);
  const answer = await load(source, doing);
  // Another source is wanted by now, or the context is lost: this source is loaded again with the new context.
  if (!answer || app.wanted !== source || (answer.bytes && !app.page)) return;
  if (answer.error) {
    say(answer.error);
    end();
    return;
  }
  loading('Compiling shaders');
  // Let the browser show that message first.
  await new Promise((resolve) => requestAnimationFrame(() => setTimeout(resolve)));
  if (app.wanted !== source || !app.page) return;
  try {
    app.facts = JSON.parse(app.page.setScene(answer.bytes));
    app.source = source;
    const count = app.facts.viewpoints;
    element('viewpoint').replaceChildren(...Array.from({ length: count }, (_, i) => new Option(String(i + 1), String(i))));
    if (!keepPlace) Object.assign(app.settings, { viewpoint: 0, at: null });
    app.settings.scene = source.builtin ?? null;
    goThere();
    if (answer.warnings.length) sayAlso(answer.warnings.map((text) => `${text}.`).join(' '));
  } catch (error) {
    // The module has already dropped what was shown.
    Object.assign(app, { source: null, facts: null });
    say(sentence(error));
  }
  end();
  startLoop();
}

const counted = (count, word) => `${count} ${word}${count === 1 ? '' : 's'}`;

/** Shows the progress of a scene: first its textures, then its triangles, whose total is known. */
function generating(doing, name, { textures, triangles }) {
  const { kiloTriangles } = app.scenes.find((scene) => scene.name === name);
  const kilo = Math.round(triangles / 1000);
  if (kilo) loading(doing, Math.min(kilo / kiloTriangles, 1), `${kilo} of ${kiloTriangles} thousand triangles`);
  else loading(doing, null, counted(textures, 'texture'));
}

/** Offers the user's own source beside the built-in scenes, and says what is shown. */
function describe() {
  const { facts, source } = app;
  const name = source?.builtin ?? source?.main ?? source?.color.name;
  element('scene').querySelector('[value=own]')?.remove();
  if (source && !source.builtin) element('scene').prepend(new Option(`your own: ${name}`, 'own'));
  offerOrbit();
  element('picture-options').hidden = !source?.color;
  element('facts').textContent = facts
    ? `${name}: ${facts.triangles.toLocaleString('en')} triangles, ${facts.style}`
    : source ? `${name} with ${source.depth.name}` : '';
}
