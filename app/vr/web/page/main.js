// Starts the page, and keeps it going when the GPU or the address changes.

import init, { Page, builtinScenes } from './yoro_web.js';
import { goThere, keepNow, readAddress } from './address.js';
import { app, element } from './app.js';
import { apply, listenToChoices, offerMethods, step } from './choices.js';
import { changed, listenToPicture, savePicture, saveWiggle, startLoop } from './drawing.js';
import { listenToFiles, take } from './files.js';
import { offerHeadset } from './headset.js';
import { listenToKeys } from './keys.js';
import { learn, most } from './link.js';
import { offerMeasure } from './measure.js';
import { clear, loading, say } from './messages.js';
import { offerPhone } from './phone.js';
import { sentence } from './sentence.js';
import { showAgain, showSource, stopLoading } from './sources.js';
import { watchWhy } from './why.js';

const { canvas } = app;
Object.assign(app, { say, clear, changed, showSource, startLoop, step, take });
// For the console, and for tests.
globalThis.yoro = app;

/** Gets the canvas's context. Returns true if it can render. */
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

/** Copies the link, and says so on the button, where users look. */
async function share() {
  keepNow();
  const button = element('share');
  try {
    await navigator.clipboard.writeText(location.href);
    button.textContent = 'Link copied';
    setTimeout(() => { button.textContent = 'Copy link'; }, 2000);
  } catch {
    say(`The browser does not allow copying; the link is ${location.href}`);
  }
}

function followLink({ newURL }) {
  if (app.busy?.name === 'measure') {
    keepNow();
    say(app.busy.end);
    return;
  }
  clear();
  // The address may have been overwritten since it changed: settings are written to it after a short delay.
  readAddress(new URL(newURL).hash);
  if (app.settings.stream) {
    location.reload();
    return;
  }
  const here = app.wanted ?? app.source;
  if (here?.builtin !== app.settings.scene) showSource({ builtin: app.settings.scene }, { keepPlace: true });
  else if (app.page) {
    goThere();
    apply();
  }
}

function lost(event) {
  event.preventDefault();
  app.busy?.stop?.();
  app.page?.free();
  Object.assign(app, { page: null, busy: null });
  say('The GPU has lost the picture. It comes back by itself as soon as the browser gives the GPU back; if it does not, reload the page.');
}

function restored() {
  if (!attach()) return;
  clear();
  apply();
  if (app.stream) app.stream.again();
  else showAgain();
}

function fillScreen() {
  if (app.busy) return;
  if (document.fullscreenElement) document.exitFullscreen();
  else element('stage').requestFullscreen?.().catch((error) => say(`Full screen is not allowed: ${error.message}.`));
}

function listenToPage() {
  listenToChoices((name) => (name === 'own' ? stopLoading() : showSource({ builtin: name })));
  listenToPicture();
  listenToKeys({
    KeyM: () => step('method'), KeyV: () => step('display'), KeyF: fillScreen, KeyP: savePicture, KeyG: saveWiggle,
    KeyO: () => element('orbit').click(),
    KeyR: () => element('reset').click(), KeyX: () => element('error').click(), KeyZ: () => element('magnifier').click(),
    KeyT: () => element('play').click(),
  });
  element('share').addEventListener('click', share);
  element('loading-cancel').addEventListener('click', stopLoading);
  element('message-close').addEventListener('click', clear);
  element('fullscreen').addEventListener('click', fillScreen);
  element('fullscreen').hidden = !document.fullscreenEnabled;
  canvas.addEventListener('dblclick', fillScreen);
  addEventListener('hashchange', followLink);
  canvas.addEventListener('webglcontextlost', lost);
  canvas.addEventListener('webglcontextrestored', restored);
}

/** Returns the compiled module; throws a sentence. */
async function compile() {
  const response = await fetch(new URL('yoro_web_bg.wasm', import.meta.url));
  if (!response.ok) throw new Error(`The page's module is missing (${response.status}): reload the page.`);
  const streams = response.headers.get('content-type')?.startsWith('application/wasm');
  try {
    // Some hosts send another content type, which only streaming compilation rejects.
    return await (streams ? WebAssembly.compileStreaming(response) : WebAssembly.compile(await response.arrayBuffer()));
  } catch (error) {
    if (/unsafe-eval|Content.Security.Policy/i.test(error.message)) {
      throw new Error('This server’s Content-Security-Policy forbids WebAssembly: its script-src must have \'wasm-unsafe-eval\'.');
    }
    throw error;
  }
}

/** Starts the page. */
export async function start() {
  listenToPage();
  listenToFiles();
  app.module = await compile();
  await init({ module_or_path: app.module });
  learn(Page.defaultChoices());
  element('ipd').max = String(most.ipd);
  if (!attach()) return;
  app.scenes = JSON.parse(builtinScenes());
  element('scene').replaceChildren(...app.scenes.map(({ name, title, kiloTriangles }) => {
    const option = new Option(`${name} (${kiloTriangles}k)`, name);
    option.title = title;
    return option;
  }));
  app.methods = JSON.parse(app.page.methods());
  offerMethods();
  element('gpu').textContent = `${app.page.gpu}; ${app.page.glVersion}`;
  readAddress();
  apply();
  offerMeasure();
  offerPhone();
  offerHeadset();
  watchWhy();
  if (app.settings.stream) (await import('./stream.js')).follow(app.settings.stream);
  else await showSource({ builtin: app.settings.scene }, { keepPlace: true });
  app.ready = true;
  // Once loaded, the page works without a network where browsers allow that: over https and on this machine. The kept
  // files are fetched again for this, which must not delay the first picture.
  if ('serviceWorker' in navigator) navigator.serviceWorker.register('offline.js').catch(() => {});
}
