// The sources that the page shows: built-in scenes, models and pictures.

import { goThere } from './address.js';
import { app, element } from './app.js';
import { apply } from './choices.js';
import { changed, startLoop } from './drawing.js';
import { clear, loading, say } from './messages.js';
import { sentence } from './sentence.js';

/** The worker that makes a scene, while there is one. */
let job = null;

/**
 * Loads and shows a source, from its viewpoint of the settings. The content before stays until then.
 * @param {object} source `{builtin}`, `{main, files}` or `{color, depth, options}`
 * @param {{keepPlace?: boolean}} options true to go to the settings' viewpoint and place, not to the first viewpoint
 */
export async function showSource(source, { keepPlace = false } = {}) {
  clear();
  job?.terminate();
  if (source.color) showPictures(source);
  else await showScene(source, keepPlace);
}

function showPictures(source) {
  loading('Decoding');
  try {
    app.page.setPictures(
      source.color.name, new Uint8Array(source.color.bytes), source.depth.name, new Uint8Array(source.depth.bytes),
      source.options());
    Object.assign(app, { source, facts: null });
    describe();
  } catch (error) {
    say(sentence(error));
  }
  loading(null);
  changed();
}

async function showScene(source, keepPlace) {
  const doing = source.builtin ? `Generating ${source.builtin}` : `Loading ${source.main}`;
  loading(doing);
  const worker = new Worker('worker.js', { type: 'module' });
  job = worker;
  const answer = await new Promise((resolve) => {
    worker.onmessage = ({ data }) => {
      if (data.bytes || data.error) resolve(data);
      else if (job === worker) generating(doing, source.builtin, data);
    };
    worker.onerror = (event) => resolve({ error: `The scene could not be made (${event.message ?? 'the worker did not start'}).` });
    worker.postMessage({ ...source, module: app.module });
  });
  worker.terminate();
  if (job !== worker) return;
  job = null;
  if (answer.error || !app.page) {
    loading(null);
    if (answer.error) say(answer.error);
    return;
  }
  loading('Compiling shaders');
  // Lets the browser show the line above first.
  await new Promise((resolve) => requestAnimationFrame(() => setTimeout(resolve)));
  try {
    app.facts = JSON.parse(app.page.setScene(answer.bytes));
    app.source = source;
    const count = app.facts.viewpoints;
    element('viewpoint').replaceChildren(...Array.from({ length: count }, (_, i) => new Option(i + 1, i)));
    const { settings } = app;
    if (!keepPlace) Object.assign(settings, { viewpoint: 0, at: null });
    settings.viewpoint = Math.min(settings.viewpoint, count - 1);
    settings.scene = source.builtin ?? settings.scene;
    goThere();
    describe();
    apply();
    if (answer.warnings.length) say(answer.warnings.map((text) => `${text}.`).join(' '));
  } catch (error) {
    app.facts = null;
    say(sentence(error));
  }
  loading(null);
  startLoop();
}

/** Shows a scene's progress: first the textures, then the triangles, whose final number is known. */
function generating(doing, name, { textures, triangles }) {
  const { kiloTriangles } = app.scenes.find((scene) => scene.name === name);
  const kilo = Math.round(triangles / 1000);
  if (kilo) loading(doing, Math.min(kilo / kiloTriangles, 1), `${kilo} of ${kiloTriangles} thousand triangles`);
  else loading(doing, null, `${textures} textures`);
}

function describe() {
  const { facts, source } = app;
  element('picture-options').hidden = !source.color;
  element('facts').textContent = facts
    ? `${source.builtin ?? source.main}: ${facts.triangles.toLocaleString('en')} triangles, ${facts.style}`
    : `${source.color.name} with ${source.depth.name}`;
}
