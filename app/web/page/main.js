// Starts the page, and keeps it going when the GPU or the address changes.

import init, { Page, builtinScenes } from './yoro_web.js';
import { goThere, keepNow, readAddress } from './address.js';
import { app, element } from './app.js';
import { apply, listenToChoices, step } from './choices.js';
import { changed, startLoop } from './drawing.js';
import { offerFiles } from './files.js';
import { offerHeadset } from './headset.js';
import { antiAliasing } from './link.js';
import { offerMeasure } from './measure.js';
import { clear, loading, say } from './messages.js';
import { offerPhone } from './phone.js';
import { sentence } from './sentence.js';
import { showSource } from './sources.js';

const { canvas } = app;
Object.assign(app, { say, clear, changed, showSource, startLoop, step });
// For the console, and for tests.
globalThis.yoro = app;

/** Takes the canvas's context; true if it can render. */
function attach() {
  app.gl = canvas.getContext('webgl2', {
    alpha: false, antialias: false, depth: false, stencil: false, powerPreference: 'high-performance',
  });
  if (!app.gl) {
    say('This browser has no WebGL 2: update it, allow hardware acceleration in its settings, or use another one.');
    loading(null);
    return false;
  }
  try {
    app.page = new Page(app.gl);
  } catch (error) {
    say(sentence(error));
    loading(null);
    return false;
  }
  return true;
}

function listenToPage() {
  element('share').addEventListener('click', async () => {
    keepNow();
    try {
      await navigator.clipboard.writeText(location.href);
      element('facts').textContent = 'The link is in the clipboard.';
    } catch {
      element('facts').textContent = location.href;
    }
  });
  element('fullscreen').addEventListener('click', () => {
    element('stage').requestFullscreen?.().catch((error) => say(`Full screen is not allowed: ${error.message}.`));
  });
  element('fullscreen').hidden = !document.fullscreenEnabled;
  new ResizeObserver(changed).observe(canvas);
  addEventListener('hashchange', () => {
    const before = app.settings.scene;
    readAddress();
    if (app.settings.scene !== before) showSource({ builtin: app.settings.scene }, { keepPlace: true });
    else if (app.page) {
      goThere();
      apply();
    }
  });
  canvas.addEventListener('webglcontextlost', (event) => {
    event.preventDefault();
    app.busy?.stop?.();
    app.page?.free();
    Object.assign(app, { page: null, busy: null });
    say('The GPU has lost the picture. It comes back by itself as soon as the browser gives the GPU back; if it does not, reload the page.');
  });
  canvas.addEventListener('webglcontextrestored', () => {
    if (!attach()) return;
    clear();
    apply();
    if (app.source) showSource(app.source, { keepPlace: true });
  });
}

async function start() {
  listenToChoices((name) => showSource({ builtin: name }));
  listenToPage();
  const url = new URL('yoro_web_bg.wasm', import.meta.url);
  try {
    app.module = await WebAssembly.compileStreaming(fetch(url));
    await init({ module_or_path: app.module });
  } catch (error) {
    loading(null);
    say(`The page's module could not be loaded (${error.message}): reload the page, or update the browser.`);
    return;
  }
  if (!attach()) return;
  app.scenes = JSON.parse(builtinScenes());
  element('scene').replaceChildren(...app.scenes.map(({ name, title, kiloTriangles }) => {
    const option = new Option(`${name} (${kiloTriangles}k)`, name);
    option.title = title;
    return option;
  }));
  for (const renderer of Object.keys(antiAliasing)) {
    app.methods[renderer] = JSON.parse(app.page.methods(JSON.stringify({ renderer })));
  }
  element('gpu').textContent = `${app.page.gpu}; ${app.page.glVersion}`;
  readAddress();
  const faults = element('message').hidden ? null : element('message').textContent;
  apply();
  offerMeasure(app);
  offerFiles(app);
  offerPhone(app);
  offerHeadset(app);
  await showSource({ builtin: app.settings.scene }, { keepPlace: true });
  if (faults) say(faults);
  app.ready = true;
  // Loaded once, the page works without a network, where browsers allow that: over https and on this machine. What is kept
  // for that is fetched once more, which is not to delay the first picture.
  if ('serviceWorker' in navigator) navigator.serviceWorker.register('offline.js').catch(() => {});
}

start();
